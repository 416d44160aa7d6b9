//! Every shape against its own definition as a set of points.
use super::*;
use core::f64::consts::TAU;

/// A small deterministic generator, enough for test inputs: numbers in −1 … 1.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self) -> DVec3 {
        DVec3::new(self.next(), self.next(), self.next())
    }

    /// A ray that passes near the origin.
    fn ray(&mut self) -> Ray {
        let origin = self.vector() * 4.0;
        let direction = (self.vector() - origin).normalize();
        Ray { origin, direction }
    }
}

/// Walks along rays in small steps and compares where being inside changes with the crossings.
fn check(numbers: &mut Numbers, solid: &Solid, inside: &dyn Fn(DVec3) -> bool) -> usize {
    let (ball, reach) = solid.ball().unwrap_or((DVec3::ZERO, 10.0));
    let mut seen = 0;
    for _ in 0..20 {
        let ray = numbers.ray();
        let mut crossings = Vec::new();
        solid.crossings(&ray, &mut crossings);
        crossings.sort_by(|a, b| a.t.total_cmp(&b.t));
        seen += crossings.len();
        assert!(crossings.len() % 2 == 0, "{solid:?} {ray:?} {crossings:?}");
        let step = 5e-3;
        let mut was = inside(ray.at(-12.0));
        let mut t = -12.0;
        while t < 12.0 {
            let is = inside(ray.at(t + step));
            let between = crossings.iter().filter(|c| c.t > t && c.t <= t + step);
            // Two crossings within one step may go unseen; one may not.
            assert_eq!(
                between.count() % 2 == 1,
                is != was,
                "{solid:?} {ray:?} {t} {crossings:?}"
            );
            was = is;
            t += step;
        }
        for (i, c) in crossings.iter().enumerate() {
            let p = ray.at(c.t);
            assert!(p.distance(ball) <= reach * (1.0 + 1e-9) || solid.ball().is_none());
            assert!((c.normal.length() - 1.0).abs() < 1e-6, "{solid:?}");
            // Pairs: in against the normal, out along it.
            let facing = c.normal.dot(ray.direction);
            let proper = if i % 2 == 0 {
                facing <= 1e-9
            } else {
                facing >= -1e-9
            };
            assert!(proper, "{solid:?} {ray:?} {i} {crossings:?} {facing}");
            if facing.abs() > 0.05 {
                assert!(inside(p - c.normal * 1e-6) || !inside(p - c.normal * 1e-3));
                assert!(!inside(p + c.normal * 1e-6) || inside(p + c.normal * 1e-3));
            }
        }
    }
    seen
}

#[cfg_attr(target_arch = "wasm32", wasm_bindgen_test::wasm_bindgen_test)]
#[cfg_attr(not(target_arch = "wasm32"), test)]
fn spheres() {
    let mut n = Numbers(1);
    let mut seen = 0;
    for _ in 0..30 {
        let (center, radius) = (n.vector(), 0.05 + n.next().abs());
        let solid = Solid::new(
            &Shape::Sphere {
                center,
                radius: 9.0,
            },
            radius,
        )
        .unwrap();
        seen += check(&mut n, &solid, &|p| p.distance(center) < radius);
    }
    assert!(seen > 200);
}

#[cfg_attr(target_arch = "wasm32", wasm_bindgen_test::wasm_bindgen_test)]
#[cfg_attr(not(target_arch = "wasm32"), test)]
fn cylinders() {
    let mut n = Numbers(2);
    let mut seen = 0;
    for _ in 0..30 {
        let (base, apex, radius) = (n.vector(), n.vector(), 0.02 + n.next().abs());
        let shape = Shape::Cylinder { base, apex, radius };
        let solid = Solid::new(&shape, radius).unwrap();
        let axis = (apex - base).normalize();
        let length = base.distance(apex);
        seen += check(&mut n, &solid, &|p| {
            let along = (p - base).dot(axis);
            (0.0..length).contains(&along) && (p - base - axis * along).length() < radius
        });
    }
    assert!(seen > 200);
}

#[cfg_attr(target_arch = "wasm32", wasm_bindgen_test::wasm_bindgen_test)]
#[cfg_attr(not(target_arch = "wasm32"), test)]
fn tubes_thin_and_fat_short_and_closed() {
    let mut n = Numbers(3);
    let mut seen = 0;
    for case in 0..80 {
        let center = n.vector() * 0.5;
        let u = n.vector().normalize();
        let v = u.cross(n.vector()).normalize();
        let sweep = 0.1 + n.next().abs();
        let radius = [0.02, 0.2, 0.5, 1.5][case % 4] * (0.5 + n.next().abs());
        let angle = if case % 5 == 0 {
            TAU
        } else {
            0.1 + 3.0 * (1.0 + n.next())
        };
        let shape = Shape::Arc {
            center,
            u,
            v,
            sweep,
            angle,
            radius,
        };
        let solid = Solid::new(&shape, radius).unwrap();
        let w = u.cross(v);
        seen += check(&mut n, &solid, &|p| {
            let d = p - center;
            let (x, y, z) = (d.dot(u), d.dot(v), d.dot(w));
            // Is p in one of the discs? The disc at angle a lies in the plane of the axis and a.
            let azimuth = libm::atan2(y, x);
            let rho = libm::hypot(x, y);
            let disc = |azimuth: f64, rho: f64| {
                azimuth.rem_euclid(TAU) <= angle && libm::hypot(rho - sweep, z) < radius
            };
            disc(azimuth, rho) || disc(azimuth + TAU / 2.0, -rho)
        });
    }
    assert!(seen > 500);
}

#[cfg_attr(target_arch = "wasm32", wasm_bindgen_test::wasm_bindgen_test)]
#[cfg_attr(not(target_arch = "wasm32"), test)]
fn prisms_and_slabs() {
    let mut n = Numbers(4);
    let mut seen = 0;
    for _ in 0..30 {
        let corners = [n.vector() * 2.0, n.vector() * 2.0, n.vector() * 2.0];
        let half = 0.02 + 0.5 * n.next().abs();
        let solid = Solid::new(
            &Shape::Triangle {
                corners,
                radius: 0.0,
            },
            half,
        )
        .unwrap();
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a).normalize();
        seen += check(&mut n, &solid, &|p| {
            let left = |a: DVec3, b: DVec3| (b - a).cross(p - a).dot(normal) > 0.0;
            left(a, b) && left(b, c) && left(c, a) && (p - a).dot(normal).abs() < half
        });
        let point = n.vector();
        let plane = Shape::Plane {
            point,
            normal,
            radius: 0.0,
        };
        let solid = Solid::new(&plane, half).unwrap();
        seen += check(&mut n, &solid, &|p| (p - point).dot(normal).abs() < half);
    }
    assert!(seen > 200);
}

#[cfg_attr(target_arch = "wasm32", wasm_bindgen_test::wasm_bindgen_test)]
#[cfg_attr(not(target_arch = "wasm32"), test)]
fn sheets_are_crossed_once() {
    let ray = Ray {
        origin: DVec3::new(0.2, 0.2, 5.0),
        direction: DVec3::NEG_Z,
    };
    let mut out = Vec::new();
    let corners = [DVec3::ZERO, DVec3::X, DVec3::Y];
    Solid::new(
        &Shape::Triangle {
            corners,
            radius: 0.0,
        },
        0.0,
    )
    .unwrap()
    .crossings(&ray, &mut out);
    let plane = Shape::Plane {
        point: DVec3::NEG_Z,
        normal: DVec3::Z,
        radius: 0.0,
    };
    Solid::new(&plane, 0.0).unwrap().crossings(&ray, &mut out);
    let beside = Ray {
        origin: DVec3::new(0.7, 0.7, 5.0),
        ..ray
    };
    Solid::new(
        &Shape::Triangle {
            corners,
            radius: 0.0,
        },
        0.0,
    )
    .unwrap()
    .crossings(&beside, &mut out);
    assert_eq!(out.iter().map(|c| c.t).collect::<Vec<_>>(), [5.0, 6.0]);
    assert_eq!(out[0].normal, DVec3::Z);
}

#[cfg_attr(target_arch = "wasm32", wasm_bindgen_test::wasm_bindgen_test)]
#[cfg_attr(not(target_arch = "wasm32"), test)]
fn a_distant_eye_sees_a_thin_tube() {
    let shape = Shape::Arc {
        center: DVec3::ZERO,
        u: DVec3::X,
        v: DVec3::Y,
        sweep: 1.0,
        angle: TAU,
        radius: 1e-3,
    };
    let solid = Solid::new(&shape, 1e-3).unwrap();
    let ray = Ray {
        origin: DVec3::new(1.0, 0.0, 1e5),
        direction: DVec3::NEG_Z,
    };
    let mut out = Vec::new();
    solid.crossings(&ray, &mut out);
    assert_eq!(out.len(), 2);
    for (c, z) in out.iter().zip([1e-3, -1e-3]) {
        assert!((ray.at(c.t).z - z).abs() < 1e-9, "{c:?}");
    }
}

#[cfg_attr(target_arch = "wasm32", wasm_bindgen_test::wasm_bindgen_test)]
#[cfg_attr(not(target_arch = "wasm32"), test)]
fn shapes_without_a_surface_are_refused() {
    let sphere = |r| {
        Solid::new(
            &Shape::Sphere {
                center: DVec3::ZERO,
                radius: r,
            },
            r,
        )
    };
    assert!(sphere(0.0).is_none() && sphere(-1.0).is_none() && sphere(f64::NAN).is_none());
    let point = Shape::Cylinder {
        base: DVec3::ONE,
        apex: DVec3::ONE,
        radius: 1.0,
    };
    assert!(Solid::new(&point, 1.0).is_none());
    let line = [DVec3::ZERO, DVec3::X, DVec3::X * 2.0];
    assert!(
        Solid::new(
            &Shape::Triangle {
                corners: line,
                radius: 0.0
            },
            1.0
        )
        .is_none()
    );
    let nowhere = Shape::Plane {
        point: DVec3::ZERO,
        normal: DVec3::ZERO,
        radius: 0.0,
    };
    assert!(Solid::new(&nowhere, 0.0).is_none());
}
