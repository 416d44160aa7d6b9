//! Tests of every shape against its own definition as a set of points.
use super::*;
use core::f64::consts::TAU;
use trials::{Random, count};

/// Whether a point is over a triangle, given with its normal.
fn is_over([a, b, c]: [DVec3; 3], normal: DVec3, p: DVec3) -> bool {
    [(a, b), (b, c), (c, a)]
        .iter()
        .all(|&(from, to)| (to - from).cross(p - from).dot(normal) > 0.0)
}

/// Returns a ray that passes near the origin.
fn ray_near(n: &mut Random) -> Ray {
    let origin = n.vector(4.0);
    let direction = (n.vector(1.0) - origin).normalize();
    Ray { origin, direction }
}

/// Walks along rays in small steps and compares where being inside changes with the crossings.
fn check(numbers: &mut Random, solid: &Solid, inside: &dyn Fn(DVec3) -> bool) -> usize {
    let (ball, reach) = solid.ball().unwrap_or((DVec3::ZERO, 10.0));
    let mut seen = 0;
    for _ in 0..20 {
        let ray = ray_near(numbers);
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

#[test]
fn spheres() {
    let mut n = Random::new(1);
    let mut seen = 0;
    for _ in 0..count(30) {
        let (center, radius) = (n.vector(1.0), 0.05 + n.unit());
        let solid = Solid::new(&Shape::sphere(center, 9.0), radius).unwrap();
        seen += check(&mut n, &solid, &|p| p.distance(center) < radius);
    }
    assert!(seen > count(200));
}

#[test]
fn cylinders() {
    let mut n = Random::new(2);
    let mut seen = 0;
    for _ in 0..count(30) {
        let (base, apex, radius) = (n.vector(1.0), n.vector(1.0), 0.02 + n.unit());
        let shape = Shape::cylinder(base, apex, radius);
        let solid = Solid::new(&shape, radius).unwrap();
        let axis = (apex - base).normalize();
        let length = base.distance(apex);
        seen += check(&mut n, &solid, &|p| {
            let along = (p - base).dot(axis);
            (0.0..length).contains(&along) && (p - base - axis * along).length() < radius
        });
    }
    assert!(seen > count(200));
}

#[test]
fn tubes_thin_and_fat_short_and_closed() {
    let mut n = Random::new(3);
    let mut seen = 0;
    for case in 0..count(80) {
        let center = n.vector(0.5);
        let u = n.direction();
        let v = u.cross(n.vector(1.0)).normalize();
        let sweep = 0.1 + n.unit();
        let radius = [0.02, 0.2, 0.5, 1.5][case % 4] * (0.5 + n.unit());
        let angle = if case % 5 == 0 {
            TAU
        } else {
            0.1 + 3.0 * (1.0 + n.range(-1.0, 1.0))
        };
        let shape = Shape::arc(center, [u, v], sweep, angle, radius);
        let solid = Solid::new(&shape, radius).unwrap();
        let w = u.cross(v);
        seen += check(&mut n, &solid, &|p| {
            let d = p - center;
            let (x, y, z) = (d.dot(u), d.dot(v), d.dot(w));
            // Is p in one of the discs? The disc at angle a lies in the plane of the axis and a.
            let azimuth = libm::atan2(y, x);
            let rho = libm::hypot(x, y);
            [(azimuth, rho), (azimuth + TAU / 2.0, -rho)]
                .iter()
                .any(|(azimuth, rho)| {
                    azimuth.rem_euclid(TAU) <= angle && libm::hypot(rho - sweep, z) < radius
                })
        });
    }
    assert!(seen > count(500));
}

#[test]
fn prisms_and_slabs() {
    let mut n = Random::new(4);
    let mut seen = 0;
    for _ in 0..count(30) {
        let corners = [n.vector(2.0), n.vector(2.0), n.vector(2.0)];
        let half = 0.02 + 0.5 * n.unit();
        let solid = Solid::new(&Shape::triangle(corners, 0.0), half).unwrap();
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a).normalize();
        seen += check(&mut n, &solid, &|p| {
            is_over(corners, normal, p) && (p - a).dot(normal).abs() < half
        });
        let point = n.vector(1.0);
        let plane = Shape::plane(point, normal, 0.0);
        let solid = Solid::new(&plane, half).unwrap();
        seen += check(&mut n, &solid, &|p| (p - point).dot(normal).abs() < half);
    }
    assert!(seen > count(200));
}

#[test]
fn sheets_are_crossed_once() {
    let ray = Ray {
        origin: DVec3::new(0.2, 0.2, 5.0),
        direction: DVec3::NEG_Z,
    };
    let mut out = Vec::new();
    let corners = [DVec3::ZERO, DVec3::X, DVec3::Y];
    Solid::new(&Shape::triangle(corners, 0.0), 0.0)
        .unwrap()
        .crossings(&ray, &mut out);
    let plane = Shape::plane(DVec3::NEG_Z, DVec3::Z, 0.0);
    Solid::new(&plane, 0.0).unwrap().crossings(&ray, &mut out);
    let beside = Ray {
        origin: DVec3::new(0.7, 0.7, 5.0),
        ..ray
    };
    Solid::new(&Shape::triangle(corners, 0.0), 0.0)
        .unwrap()
        .crossings(&beside, &mut out);
    assert_eq!(out.iter().map(|c| c.t).collect::<Vec<_>>(), [5.0, 6.0]);
    assert_eq!(out[0].normal, DVec3::Z);
}

#[test]
fn a_distant_eye_sees_a_thin_tube() {
    let shape = Shape::arc(DVec3::ZERO, [DVec3::X, DVec3::Y], 1.0, TAU, 1e-3);
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

#[test]
fn shapes_without_a_surface_are_refused() {
    for radius in [0.0, -1.0, f64::NAN] {
        let center = DVec3::ZERO;
        assert!(Solid::new(&Shape::sphere(center, radius), radius).is_none());
    }
    let point = Shape::cylinder(DVec3::ONE, DVec3::ONE, 1.0);
    assert!(Solid::new(&point, 1.0).is_none());
    let line = [DVec3::ZERO, DVec3::X, DVec3::X * 2.0];
    assert!(Solid::new(&Shape::triangle(line, 0.0), 1.0).is_none());
    let nowhere = Shape::plane(DVec3::ZERO, DVec3::ZERO, 0.0);
    assert!(Solid::new(&nowhere, 0.0).is_none());
}

/// Walks along rays like [`check`], for surfaces that end: `height` is of one sign on each side of
/// the surface, and `None` where it does not reach.
fn check_sheet(
    numbers: &mut Random,
    solid: &Solid,
    height: &dyn Fn(DVec3) -> Option<f64>,
) -> usize {
    let (ball, reach) = solid.ball().unwrap();
    let mut seen = 0;
    for _ in 0..20 {
        let ray = ray_near(numbers);
        let mut crossings = Vec::new();
        solid.crossings(&ray, &mut crossings);
        let step = 5e-3;
        let mut was = height(ray.at(-12.0));
        let mut t = -12.0;
        while t < 12.0 {
            let is = height(ray.at(t + step));
            let between = crossings.iter().filter(|c| c.t > t && c.t <= t + step);
            let count = between.count();
            match (was, is) {
                (Some(a), Some(b)) => assert_eq!(
                    count % 2 == 1,
                    (a < 0.0) != (b < 0.0),
                    "{solid:?} {ray:?} {t} {crossings:?}"
                ),
                // At the border it is left open; outside there is nothing.
                (None, None) => assert_eq!(count, 0, "{solid:?} {ray:?} {t}"),
                _ => {}
            }
            was = is;
            t += step;
        }
        for c in &crossings {
            seen += 1;
            let p = ray.at(c.t);
            assert!(p.distance(ball) <= reach * (1.0 + 1e-9));
            assert!((c.normal.length() - 1.0).abs() < 1e-6, "{solid:?}");
            assert!(
                height(p).is_none_or(|h| h.abs() < 1e-9),
                "{solid:?} {ray:?}"
            );
        }
    }
    seen
}

#[test]
fn cones_blunt_and_pointed() {
    let mut n = Random::new(5);
    let mut seen = 0;
    for case in 0..count(60) {
        let (base, apex) = (n.vector(1.0), n.vector(1.0));
        let mut radii = [0.02 + n.unit(), 0.02 + n.unit()];
        match case % 4 {
            0 => radii[0] = 0.0,
            1 => radii[1] = 0.0,
            2 => radii[1] = radii[0] * (1.0 + 1e-9 * n.range(-1.0, 1.0)),
            _ => {}
        }
        let shape = Shape::cone(base, radii[0], apex, radii[1]);
        let solid = Solid::new(&shape, 0.0).unwrap();
        let axis = (apex - base).normalize();
        let length = base.distance(apex);
        seen += check(&mut n, &solid, &|p| {
            let along = (p - base).dot(axis);
            let radius = radii[0] + (radii[1] - radii[0]) * along / length;
            (0.0..length).contains(&along) && (p - base - axis * along).length() < radius
        });
    }
    assert!(seen > count(300), "{seen}");
}

#[test]
fn a_cone_of_even_width_is_a_cylinder() {
    let mut n = Random::new(6);
    for _ in 0..count(200) {
        let (base, apex, radius) = (n.vector(1.0), n.vector(1.0), 0.02 + n.unit());
        let cone = Cone::new([base, apex], [radius; 2]).unwrap();
        let cylinder = Cylinder::new(base, apex, radius).unwrap();
        let axis = (apex - base).normalize();
        // Some go along the axis, inside and outside.
        let along = Ray {
            origin: base + axis.any_orthonormal_vector() * n.range(-1.0, 1.0),
            direction: axis,
        };
        for ray in [ray_near(&mut n), ray_near(&mut n), along] {
            let (mut a, mut b) = (Vec::new(), Vec::new());
            cone.crossings(&ray, &mut a);
            cylinder.crossings(&ray, &mut b);
            assert_eq!(a.len(), b.len(), "{cone:?} {ray:?}");
            for (a, b) in a.iter().zip(&b) {
                assert!((a.t - b.t).abs() < 1e-9 && a.normal.distance(b.normal) < 1e-6);
            }
        }
    }
}

#[test]
fn rays_along_the_wall_of_a_cone() {
    // Parallel to a line of the wall, the equation is of the first degree.
    let cone = Cone::new([DVec3::ZERO, DVec3::Z], [1.0, 0.0]).unwrap();
    let direction = DVec3::new(-1.0, 0.0, 1.0).normalize();
    for (offset, count) in [(0.0, 0), (0.5, 0), (-0.5, 2), (-1.5, 2), (-2.5, 0)] {
        let ray = Ray {
            origin: DVec3::new(1.0 + offset, 0.0, 0.0) - direction * 3.0,
            direction,
        };
        let mut out = Vec::new();
        cone.crossings(&ray, &mut out);
        // On the wall itself rounding decides.
        if offset != 0.0 {
            assert_eq!(out.len(), count, "{offset} {out:?}");
        }
    }
}

#[test]
fn boxes_straight_and_sheared() {
    let mut n = Random::new(7);
    let mut seen = 0;
    for case in 0..count(40) {
        let center = n.vector(0.5);
        let axes = if case % 2 == 0 {
            [n.vector(1.0), n.vector(1.0), n.vector(1.0)]
        } else {
            [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| axis * n.range(-1.0, 1.0))
        };
        let solid = Solid::new(&Shape::cuboid(center, axes), 0.0).unwrap();
        let [x, y, z] = axes;
        let volume = x.cross(y).dot(z);
        seen += check(&mut n, &solid, &|p| {
            // Cramer's rule.
            let d = p - center;
            let s = [d.cross(y).dot(z), x.cross(d).dot(z), x.cross(y).dot(d)];
            s.iter().all(|s| (s / volume).abs() < 1.0)
        });
    }
    assert!(seen > count(200), "{seen}");
}

#[test]
fn pipes_are_open() {
    let mut n = Random::new(8);
    let mut seen = 0;
    for _ in 0..count(40) {
        let (base, apex, radius) = (n.vector(1.0), n.vector(1.0), 0.02 + n.unit());
        let solid = Solid::new(&Shape::pipe(base, apex, radius), radius).unwrap();
        let axis = (apex - base).normalize();
        let length = base.distance(apex);
        seen += check_sheet(&mut n, &solid, &|p| {
            let along = (p - base).dot(axis);
            let across = (p - base - axis * along).length();
            (0.0..=length).contains(&along).then_some(across - radius)
        });
    }
    assert!(seen > count(200), "{seen}");
    let pipe = Pipe::new(DVec3::ZERO, DVec3::Z, 1.0).unwrap();
    let through = Ray {
        origin: DVec3::new(0.5, 0.0, 5.0),
        direction: DVec3::NEG_Z,
    };
    let mut out = Vec::new();
    pipe.crossings(&through, &mut out);
    assert!(out.is_empty());
}

#[test]
fn patches_are_flat_but_lit_round() {
    let mut n = Random::new(9);
    let mut seen = 0;
    for _ in 0..count(60) {
        let corners = [n.vector(2.0), n.vector(2.0), n.vector(2.0)];
        let normals = [n.vector(1.0), n.vector(1.0), n.vector(1.0)];
        let solid = Solid::new(&Shape::patch(corners, normals), 0.0).unwrap();
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a).normalize();
        seen += check_sheet(&mut n, &solid, &|p| {
            is_over(corners, normal, p).then(|| (p - a).dot(normal))
        });
        // In the middle of an edge it is the mean of two normals. (A ray along it is never
        // edge-on.)
        let direction = (normals[0].normalize() + normals[1].normalize()).normalize();
        let ray = Ray {
            origin: a.midpoint(b) + (c - a) * 1e-9 - direction * 3.0,
            direction,
        };
        let mut out = Vec::new();
        solid.crossings(&ray, &mut out);
        assert_eq!(out.len(), 1);
        assert!(out[0].normal.cross(ray.direction).length() < 1e-6);
    }
    assert!(seen > count(100), "{seen}");
}

/// The returned normal is on the visible side of the face, for any normals at the corners.
#[test]
fn patches_near_the_outline_are_not_lit_from_within() {
    let mut n = Random::new(10);
    let mut turned = 0;
    for _ in 0..count(2000) {
        let normals = [0, 1, 2].map(|_| DVec3::Z + n.vector(0.9));
        let corners = [DVec3::NEG_ONE, DVec3::X, DVec3::Y].map(|c| c.with_z(0.0));
        let patch = Patch::new(corners, normals).unwrap();
        let ray = ray_near(&mut n);
        let mut out = Vec::new();
        patch.crossings(&ray, &mut out);
        for crossing in out {
            let seen_from_above = ray.direction.z < 0.0;
            let faces = crossing.normal.dot(ray.direction);
            assert_eq!(faces <= 0.0, seen_from_above, "{ray:?} {crossing:?}");
            turned += usize::from(faces.abs() < 1e-8);
        }
    }
    assert!(turned >= count(6), "{turned}");
}

#[test]
fn no_ray_slips_between_two_patches_that_share_an_edge() {
    let mut n = Random::new(11);
    for _ in 0..count(2000) {
        let [a, b, c, d] = [n.vector(1.0), n.vector(1.0), n.vector(1.0), n.vector(1.0)];
        let patches = [[a, b, c], [b, a, d]].map(|corners| Patch::new(corners, corners).unwrap());
        let origin = n.vector(20.0);
        let target = a.lerp(b, 0.5 + 0.45 * n.range(-1.0, 1.0));
        let ray = Ray {
            origin,
            direction: (target - origin).normalize(),
        };
        let mut out = Vec::new();
        for patch in patches {
            patch.crossings(&ray, &mut out);
        }
        // A ray edge-on from beside both may meet neither; that is not a gap.
        let normal = (b - a).cross(ray.direction);
        let beside = normal.dot(c - a) * normal.dot(d - a) > 0.0;
        assert!(beside || !out.is_empty(), "{ray:?} {patches:?}");
    }
}

#[test]
fn quadrics_of_every_kind() {
    use glam::DMat3;
    let mut n = Random::new(12);
    let mut seen = 0;
    for case in 0..count(120) {
        // Ellipsoids, hyperboloids, cones; then cylinders and paraboloids; then planes.
        let mut signs = [DVec3::ONE, DVec3::new(1.0, 1.0, -1.0)][case % 2];
        match case % 5 {
            0 => signs.x = 0.0,
            1 => signs = DVec3::new(0.0, 1.0, 0.0),
            2 => signs = DVec3::ZERO,
            _ => {}
        }
        let turn = DMat3::from_cols(n.vector(1.0), n.vector(1.0), n.vector(1.0));
        let square = turn.transpose() * DMat3::from_diagonal(signs) * turn;
        let (low, high) = (-0.3 - n.vector(1.0).abs(), 0.3 + n.vector(1.0).abs());
        let linear = n.vector(0.5);
        let constant = [0.4 * n.range(-1.0, 1.0), -0.2, 0.0][case % 3];
        let mut surface = scene::Quadric::new(square, linear, constant, low, high).unwrap();
        if case % 2 == 0 {
            surface.axes = [n.vector(1.0), n.vector(1.0), n.vector(1.0)];
        }
        let shape = Shape::Quadric(Box::new(surface));
        let solid = Solid::new(&shape, 0.0).unwrap();
        let [x, y, z] = surface.axes;
        let volume = x.cross(y).dot(z);
        seen += check_sheet(&mut n, &solid, &|p| {
            let d = p - surface.center;
            let q = DVec3::new(d.cross(y).dot(z), x.cross(d).dot(z), x.cross(y).dot(d)) / volume;
            (q.abs().max_element() <= 1.0).then(|| surface.value(q).0)
        });
    }
    assert!(seen > count(300), "{seen}");
}

#[test]
fn a_round_quadric_is_a_ball() {
    use glam::DMat3;
    let bounds = DVec3::splat(1.0);
    let ball = scene::Quadric::new(DMat3::IDENTITY, DVec3::ZERO, -0.81, -bounds, bounds).unwrap();
    let quadric = Quadric::new(&ball).unwrap();
    let sphere = Sphere::new(DVec3::ZERO, 0.9).unwrap();
    let mut n = Random::new(13);
    for case in 0..count(500) {
        let mut ray = ray_near(&mut n);
        if case % 2 == 0 {
            ray.origin -= ray.direction * 1e5;
        }
        let (mut a, mut b) = (Vec::new(), Vec::new());
        quadric.crossings(&ray, &mut a);
        sphere.crossings(&ray, &mut b);
        assert_eq!(a.len(), b.len(), "{ray:?}");
        for (a, b) in a.iter().zip(&b) {
            assert!((a.t - b.t).abs() < 1e-8 && a.normal.distance(b.normal) < 1e-8);
        }
    }
}

#[test]
fn new_shapes_without_a_surface_are_refused() {
    let cone = |apex, r, s| Cone::new([DVec3::ZERO, apex], [r, s]);
    assert!(cone(DVec3::X, 1.0, 0.0).is_some());
    assert!(cone(DVec3::ZERO, 1.0, 0.0).is_none());
    assert!(cone(DVec3::X, 0.0, 0.0).is_none());
    assert!(cone(DVec3::X, 1.0, -1.0).is_none());
    assert!(Pipe::new(DVec3::ONE, DVec3::ONE, 1.0).is_none());
    assert!(Pipe::new(DVec3::ZERO, DVec3::ONE, 0.0).is_none());
    let flat = [DVec3::X, DVec3::Y, DVec3::ONE.with_z(0.0)];
    assert!(Cuboid::new(DVec3::ZERO, flat).is_none());
    assert!(Cuboid::new(DVec3::ZERO, [DVec3::X, DVec3::Y, DVec3::ZERO]).is_none());
    let line = [DVec3::ZERO, DVec3::X, DVec3::X * 2.0];
    assert!(Patch::new(line, [DVec3::Z; 3]).is_none());
    let corners = [DVec3::ZERO, DVec3::X, DVec3::Y];
    assert!(Patch::new(corners, [DVec3::ZERO; 3]).is_some());
    for bad in [f64::NAN, f64::INFINITY] {
        let vector = DVec3::X * bad;
        assert!(cone(vector, 1.0, 1.0).is_none() && cone(DVec3::X, bad, 1.0).is_none());
        assert!(Pipe::new(vector, DVec3::ONE, 1.0).is_none());
        assert!(Cuboid::new(vector, [DVec3::X, DVec3::Y, DVec3::Z]).is_none());
        assert!(Cuboid::new(DVec3::ZERO, [vector, DVec3::Y, DVec3::Z]).is_none());
        assert!(Patch::new([vector, DVec3::Y, DVec3::Z], [DVec3::Z; 3]).is_none());
        assert!(Patch::new(corners, [vector, DVec3::Z, DVec3::Z]).is_none());
    }
}
