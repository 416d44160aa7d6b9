//! Superquadrics, decay functions and start shapes against other definitions.

use core::f64::consts::{FRAC_PI_2, PI};
use glam::DVec3;
use sculpt::{Clay, Decay, Form, Shape, Start, Tool};
use trials::{Random, count};

/// Barr's parametric form, with angles from the equator and about the axis.
fn on_surface(tool: &Tool, north: f64, east: f64) -> DVec3 {
    fn power(x: f64, e: f64) -> f64 {
        x.signum() * libm::pow(x.abs(), e)
    }
    let [e1, e2] = tool.exponents;
    let ring = power(libm::cos(north), e1);
    let p = DVec3::new(
        ring * power(libm::cos(east), e2),
        ring * power(libm::sin(east), e2),
        power(libm::sin(north), e1),
    );
    tool.axes() * (p * tool.semi_axes)
}

#[test]
fn gauge_is_one_on_the_parametric_surface_and_grows_along_rays() {
    let mut random = Random::new(1);
    for _ in 0..count(5000) {
        let tool = crate::strokes::tool(&mut random);
        let north = random.range(-FRAC_PI_2, FRAC_PI_2);
        let p = on_surface(&tool, north, random.range(-PI, PI));
        assert!((tool.gauge(p) - 1.0).abs() < 1e-9, "{tool:?} {p}");
        let t = random.range(0.01, 3.0);
        assert!((tool.gauge(p * t) - t).abs() < 1e-9 * t.max(1.0));
        assert_eq!(
            tool.inside_outside(p * t) < 1.0,
            t < 1.0 - 1e-12 || tool.gauge(p * t) < 1.0
        );
    }
    assert_eq!(Tool::new(Form::Box, DVec3::ONE).gauge(DVec3::ZERO), 0.0);
}

#[test]
fn inside_outside_function_is_barrs() {
    let mut random = Random::new(2);
    for _ in 0..count(1000) {
        let mut tool = crate::strokes::tool(&mut random);
        tool.turn = DVec3::ZERO;
        tool.exponents = [0.3, 0.7];
        let p = random.vector(0.5);
        let q = (p / tool.semi_axes).abs();
        let [e1, e2] = tool.exponents;
        let pow = libm::pow;
        let value = pow(pow(q.x, 2.0 / e2) + pow(q.y, 2.0 / e2), e2 / e1) + pow(q.z, 2.0 / e1);
        let ours = tool.inside_outside(p);
        assert!(
            (ours - value).abs() < 1e-9 * value.max(1.0),
            "{ours} {value}"
        );
    }
}

#[test]
fn solid_is_within_its_bounds_and_drives_vertices_onto_the_surface() {
    let mut random = Random::new(3);
    for _ in 0..count(300) {
        let tool = crate::strokes::tool(&mut random);
        let (solid, axes) = (sculpt::Tool::solid(&tool), tool.axes());
        let bounds = sculpt::Solid::bounds(&solid);
        assert!(
            (axes.transpose() * axes - glam::DMat3::IDENTITY)
                .to_cols_array()
                .iter()
                .all(|x| x.abs() < 1e-12)
        );
        for _ in 0..20 {
            let p = random.vector(0.6);
            let inside = sculpt::Solid::contains(&solid, p);
            assert_eq!(inside, tool.gauge(p) < 1.0);
            if inside {
                assert!(p.cmpge(bounds.min - 1e-12).all() && p.cmple(bounds.max + 1e-12).all());
                let out = sculpt::Solid::drive_out(&solid, p).expect("a way out");
                assert!((tool.gauge(out) - 1.0).abs() < 1e-12);
                assert!(out.cross(p).length() < 1e-12, "along the ray");
            } else {
                assert_eq!(sculpt::Solid::drive_out(&solid, p), None);
            }
        }
    }
}

#[test]
fn quarter_turns_exchange_axes_exactly() {
    let mut tool = Tool::new(Form::Sphere, DVec3::new(1.0, 2.0, 3.0));
    tool.turn = DVec3::new(0.0, 0.0, 90.0);
    assert_eq!(tool.axes() * DVec3::X, DVec3::Y);
    tool.turn = DVec3::new(-90.0, 360.0, 0.0);
    assert_eq!(tool.axes() * DVec3::Z, DVec3::Y);
}

#[test]
fn polyhedron_lies_on_the_tool() {
    let mut random = Random::new(4);
    for _ in 0..count(50) {
        let tool = crate::strokes::tool(&mut random);
        let soup = tool.polyhedron(3);
        assert!(
            soup.positions
                .iter()
                .all(|p| (tool.gauge(*p) - 1.0).abs() < 1e-9)
        );
        let (clay, repairs) = Clay::of_polygons(&soup).unwrap();
        assert!(repairs.is_none() && clay.mesh().is_closed());
    }
}

#[test]
fn decays_fall_from_one_to_nothing() {
    for decay in Decay::ALL {
        assert_eq!(decay.at(0.0), 1.0);
        assert_eq!(decay.at(1.01), 0.0);
        assert_eq!(decay.at(f64::NAN), 0.0);
        let values: Vec<f64> = (0..=100).map(|i| decay.at(f64::from(i) / 100.0)).collect();
        assert!(values.is_sorted_by(|a, b| a >= b), "{decay:?}");
        let end = values[100];
        assert!(if decay == Decay::Flat {
            end == 1.0
        } else {
            end.abs() < 1e-15
        });
        assert_eq!(Decay::of_name(decay.name()), Some(decay));
    }
    assert_eq!(Decay::of_name("glue"), None);
    // Figure 1: a broad top, a bell, a cone, a sharp peak.
    for (t, order) in [(0.3, [0, 1, 3, 2]), (0.8, [0, 3, 1, 2])] {
        let heights = order.map(|i| Decay::ALL[i].at(t));
        assert!(heights.is_sorted_by(|a, b| a > b), "at {t}: {heights:?}");
    }
}

#[test]
fn start_shapes_are_manifolds_of_the_stated_size() {
    for n in 1..6_u32 {
        let m = n as usize;
        for (shape, faces) in [
            (Shape::Plane, 2 * m * m),
            (Shape::Sphere, 8 * m * m),
            (Shape::Tetrahedron, 4 * m * m),
            (Shape::Cylinder, 12 * m * m),
            (Shape::Box, 12 * m * m),
        ] {
            let clay = Clay::of_shape(&Start::new(shape, n)).unwrap();
            let mesh = clay.mesh();
            mesh.validate().unwrap();
            assert_eq!(mesh.face_count(), faces);
            let is_open = shape == Shape::Plane;
            assert_eq!(mesh.is_closed(), !is_open);
            assert_eq!(mesh.euler_characteristic(), if is_open { 1 } else { 2 });
            // Outwards, and as large as it is said to be.
            let volume: f64 = mesh
                .faces()
                .map(|f| {
                    mesh.face_normal(f)
                        .dot(mesh.position(mesh.face_vertices(f).next().unwrap()))
                })
                .sum::<f64>()
                / 6.0;
            let most = match shape {
                Shape::Plane => 0.0,
                Shape::Sphere => 4.0 / 3.0 * PI,
                Shape::Tetrahedron => 8.0 / 3.0,
                Shape::Cylinder => 2.0 * PI,
                Shape::Box => 8.0,
            };
            assert!(
                volume <= most + 1e-9 && volume >= most * 0.3,
                "{shape:?} {n}: {volume}"
            );
            if n == 5 {
                assert!(volume >= 0.9 * most, "{shape:?}: {volume} of {most}");
            }
        }
    }
}

#[test]
fn start_shapes_are_mirror_images_of_themselves() {
    for shape in [Shape::Plane, Shape::Sphere, Shape::Cylinder, Shape::Box] {
        let clay = Clay::of_shape(&Start::new(shape, 4)).unwrap();
        let mesh = clay.mesh();
        let mut faces: Vec<Vec<[u64; 3]>> = Vec::new();
        let mut mirrored: Vec<Vec<[u64; 3]>> = Vec::new();
        for f in mesh.faces() {
            for (list, sign) in [(&mut faces, 1.0), (&mut mirrored, -1.0)] {
                let place =
                    |p: DVec3| crate::random::bits(p * DVec3::new(sign, 1.0, 1.0) + DVec3::ZERO);
                let mut face: Vec<_> = mesh
                    .face_vertices(f)
                    .map(|v| place(mesh.position(v)))
                    .collect();
                face.sort_unstable();
                list.push(face);
            }
        }
        faces.sort_unstable();
        mirrored.sort_unstable();
        assert_eq!(faces, mirrored, "{shape:?}");
    }
}
