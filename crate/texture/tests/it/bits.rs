//! Hashes of many results, which are the same natively and as wasm.

use glam::{DVec3, Vec3};
use texture::sequence::{Purpose, sample};
use texture::{
    Grain, Method, Site, Solid, Surface, Target, Texture, Wave, apply, disc, fog::Fog, fractal,
    noise_jet, refraction, turbulence, uv,
};
use trials::Random;
use trials::bits::Hash;

#[test]
fn bits_are_the_same_on_every_platform() {
    let found = [
        ("noise", noise()),
        ("solids", solids()),
        ("surfaces", surfaces()),
        ("shading", shading()),
    ];
    let found = found.map(|(name, hash)| (String::from(name), hash));
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/bits.txt");
    trials::bits::compare(&found, include_str!("../bits.txt"), path);
}

fn noise() -> Hash {
    let (mut hash, mut random) = (Hash::default(), Random::fixed(1));
    for _ in 0..2_000 {
        let p = random.vector(50.0);
        let (value, gradient) = noise_jet(p);
        hash.numbers([value]);
        hash.numbers(gradient.to_array());
        hash.numbers([fractal(p, 5.5)]);
        hash.numbers([turbulence(p, 3.25)]);
    }
    hash
}

fn solids() -> Hash {
    let (mut hash, mut random) = (Hash::default(), Random::fixed(2));
    for solid in Solid::ALL {
        for _ in 0..300 {
            let p = random.vector(5.0);
            hash.numbers(solid.pattern(p, Grain::default()));
            hash.numbers([solid.relief(
                p,
                Grain {
                    turbulence: 0.6,
                    octaves: 2.5,
                },
            )]);
        }
    }
    hash
}

fn surfaces() -> Hash {
    let (mut hash, mut random) = (Hash::default(), Random::fixed(3));
    let layers = [
        Texture::new(Target::Pigment, Method::Solid(Solid::Marble)),
        Texture {
            scale: DVec3::new(9.0, 5.0, 1.0),
            ..Texture::new(Target::Normal, Method::Waves([Wave::Sin, Wave::Cos2]))
        },
        Texture::new(Target::Normal, Method::Solid(Solid::Moon)),
    ];
    for _ in 0..300 {
        let (point, normal) = (random.vector(2.0), random.direction());
        for uv in [
            uv::sphere(DVec3::ZERO, point),
            uv::segment(DVec3::X, DVec3::new(-1.0, 0.3, 0.1), point),
            uv::arc(
                &uv::Arc {
                    center: DVec3::ZERO,
                    u: DVec3::X,
                    v: DVec3::Z,
                    sweep: 1.0,
                    angle: 2.0,
                },
                point,
            ),
            uv::triangle([DVec3::X, DVec3::Y, DVec3::Z], point),
            uv::plane(DVec3::ZERO, normal, point),
        ] {
            let site = Site { point, normal, uv };
            let got = apply(
                &layers,
                Surface {
                    normal,
                    ambient: Vec3::splat(0.1),
                    ..Surface::default()
                },
                &site,
                &[],
            );
            hash.numbers(got.normal.to_array());
            hash.numbers(got.diffuse.as_dvec3().to_array());
            hash.numbers(got.ambient.as_dvec3().to_array());
        }
    }
    hash
}

fn shading() -> Hash {
    let (mut hash, mut random) = (Hash::default(), Random::fixed(4));
    for number in 0..500 {
        let [a, b] = sample([number % 7, number % 11], number, Purpose::Light(3));
        hash.numbers([a]);
        hash.numbers([b]);
        hash.numbers(disc::cosine(random.direction(), [a, b]).to_array());
        hash.numbers(disc::direction([a, b]).to_array());
        if let Some(d) = refraction::refract(random.direction(), random.direction(), 0.5 + a) {
            hash.numbers(d.to_array());
        }
        let fog = Fog {
            distance: 3.0,
            height: Some(0.1 + b),
        };
        hash.numbers([fog.passes(random.vector(2.0), random.direction(), 10.0 * a)]);
    }
    hash
}
