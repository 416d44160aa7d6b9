//! The same bits natively and as WebAssembly: hashes of many results, pinned.

use crate::common::Random;
use glam::{DVec3, Vec3};
use texture::sequence::{Purpose, sample};
use texture::{
    Grain, Method, Site, Solid, Surface, Target, Texture, Wave, apply, disc, fog::Fog, fractal,
    noise_jet, refraction, turbulence, uv,
};

/// FNV-1a of numbers' bytes.
struct Hash(u64);

impl Hash {
    fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    fn add(&mut self, x: f64) {
        for byte in x.to_bits().to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    fn add_all(&mut self, v: DVec3) {
        for x in v.to_array() {
            self.add(x);
        }
    }
}

tests! {
    fn noise_has_its_bits() {
        let (mut hash, mut random) = (Hash::new(), Random::new(1));
        for _ in 0..2_000 {
            let p = random.point(50.0);
            let (value, gradient) = noise_jet(p);
            hash.add(value);
            hash.add_all(gradient);
            hash.add(fractal(p, 5.5));
            hash.add(turbulence(p, 3.25));
        }
        assert_eq!(hash.0, 0xb7fa_00d8_b155_1fa1, "noise {:#018x}", hash.0);
    }

    fn solids_have_their_bits() {
        let (mut hash, mut random) = (Hash::new(), Random::new(2));
        for solid in Solid::ALL {
            for _ in 0..300 {
                let p = random.point(5.0);
                hash.add_all(DVec3::from_array(solid.pattern(p, Grain::default())));
                hash.add(solid.relief(p, Grain { turbulence: 0.6, octaves: 2.5 }));
            }
        }
        assert_eq!(hash.0, 0x84bc_956b_1c1b_cbd9, "solids {:#018x}", hash.0);
    }

    fn surfaces_have_their_bits() {
        let (mut hash, mut random) = (Hash::new(), Random::new(3));
        let layers = [
            Texture::new(Target::Pigment, Method::Solid(Solid::Marble)),
            Texture { scale: DVec3::new(9.0, 5.0, 1.0), ..Texture::new(Target::Normal, Method::Waves([Wave::Sin, Wave::Cos2])) },
            Texture::new(Target::Normal, Method::Solid(Solid::Moon)),
        ];
        for _ in 0..300 {
            let (point, normal) = (random.point(2.0), random.direction());
            for uv in [
                uv::sphere(DVec3::ZERO, point),
                uv::segment(DVec3::X, DVec3::new(-1.0, 0.3, 0.1), point),
                uv::arc(&uv::Arc { center: DVec3::ZERO, u: DVec3::X, v: DVec3::Z, sweep: 1.0, angle: 2.0 }, point),
                uv::triangle([DVec3::X, DVec3::Y, DVec3::Z], point),
                uv::plane(DVec3::ZERO, normal, point),
            ] {
                let site = Site { point, normal, uv };
                let got = apply(&layers, Surface { normal, ambient: Vec3::splat(0.1), ..Surface::default() }, &site, &[]);
                hash.add_all(got.normal);
                hash.add_all(got.diffuse.as_dvec3());
                hash.add_all(got.ambient.as_dvec3());
            }
        }
        assert_eq!(hash.0, 0x27d4_b2f0_c6e1_2ae5, "surfaces {:#018x}", hash.0);
    }

    fn shading_has_its_bits() {
        let (mut hash, mut random) = (Hash::new(), Random::new(4));
        for number in 0..500 {
            let [a, b] = sample([number % 7, number % 11], number, Purpose::Light(3));
            hash.add(a);
            hash.add(b);
            hash.add_all(disc::cosine(random.direction(), [a, b]));
            hash.add_all(disc::direction([a, b]));
            if let Some(d) = refraction::refract(random.direction(), random.direction(), 0.5 + a) {
                hash.add_all(d);
            }
            let fog = Fog { distance: 3.0, height: Some(0.1 + b) };
            hash.add(fog.passes(random.point(2.0), random.direction(), 10.0 * a));
        }
        assert_eq!(hash.0, 0xf1f9_5d7d_5a19_8eb8, "shading {:#018x}", hash.0);
    }
}
