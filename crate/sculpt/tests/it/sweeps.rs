//! Effects of tools on a mesh.

use glam::DVec3;
use mesh::VertexId;
use sculpt::{
    Action, Choice, Clay, Constraint, Decay, Drag, Form, PathPoint, Region, RegionChange, Shape,
    Start, Sweep, Tool,
};

fn plane() -> Clay {
    Clay::of_shape(&Start::new(Shape::Plane, 20)).unwrap()
}

fn ball(radius: f64) -> Tool {
    Tool::new(Form::Sphere, DVec3::splat(radius))
}

fn run(clay: &mut Clay, sweep: &Sweep, path: &[DVec3]) {
    let mut drag = Drag::new(clay, sweep);
    for p in path {
        drag.step(clay, PathPoint::new(*p));
    }
    drag.finish(clay);
}

fn places(clay: &Clay) -> Vec<DVec3> {
    let mesh = clay.mesh();
    mesh.vertices().map(|v| mesh.position(v)).collect()
}

#[test]
fn push_drives_vertices_onto_the_tool_along_its_rays_and_leaves_the_others() {
    let mut clay = plane();
    let before = places(&clay);
    let (tool, center) = (ball(0.5), DVec3::new(0.02, 0.01, 0.3));
    run(
        &mut clay,
        &Sweep::new(Action::Push, tool.clone()),
        &[center],
    );
    let mut moved = 0;
    for (old, new) in before.iter().zip(places(&clay)) {
        if tool.gauge(*old - center) < 1.0 {
            assert!((tool.gauge(new - center) - 1.0).abs() < 1e-12);
            assert!((*old - center).cross(new - center).length() < 1e-12);
            assert!(new.z < 0.0);
            moved += 1;
        } else {
            assert_eq!(crate::random::bits(*old), crate::random::bits(new));
        }
    }
    assert!(moved > 40);
}

#[test]
fn a_vertex_in_the_centre_of_the_tool_stays() {
    let mut clay = plane();
    run(
        &mut clay,
        &Sweep::new(Action::Push, ball(0.07)),
        &[DVec3::ZERO],
    );
    assert!(places(&clay).contains(&DVec3::ZERO));
}

#[test]
fn with_any_decay_nothing_stays_inside_a_solid_tool() {
    for decay in Decay::ALL {
        for center in [DVec3::new(0.03, 0.0, 0.2), DVec3::new(0.0, 0.4, -0.1)] {
            let mut clay = plane();
            let mut sweep = Sweep::new(Action::Push, ball(0.4));
            (sweep.decay, sweep.range) = (decay, 0.7);
            run(&mut clay, &sweep, &[center]);
            let least = places(&clay)
                .iter()
                .map(|p| sweep.tool.gauge(*p - center))
                .fold(9.0, f64::min);
            assert!(least > 1.0 - 1e-12, "{decay:?}: {least}");
        }
    }
}

#[test]
fn a_fast_tool_leaves_nothing_out() {
    let mut clay = plane();
    let path = [DVec3::new(-2.0, 0.0, 0.1), DVec3::new(2.0, 0.0, 0.1)];
    run(&mut clay, &Sweep::new(Action::Push, ball(0.2)), &path);
    let lowest = places(&clay)
        .into_iter()
        .filter(|p| p.y.abs() < 1e-9 && p.x.abs() < 0.9);
    assert!(lowest.into_iter().all(|p| p.z < -0.05));
}

#[test]
fn pull_moves_touched_vertices_with_the_tool_and_neighbours_by_the_decay_along_edges() {
    for decay in Decay::ALL {
        let mut clay = plane();
        let before = places(&clay);
        let mut sweep = Sweep::new(Action::Pull, ball(0.01));
        (sweep.decay, sweep.range) = (decay, 0.55);
        run(&mut clay, &sweep, &[DVec3::ZERO, DVec3::Z * 0.25, DVec3::Z]);
        for (old, new) in before.iter().zip(places(&clay)) {
            assert_eq!([old.x, old.y], [new.x, new.y]);
            // Along a line of the grid the distance along edges is the coordinate.
            if old.y == 0.0 {
                let wanted = decay.at(old.x.abs() / 0.55);
                assert!((new.z - wanted).abs() < 1e-12, "{decay:?} {old}: {}", new.z);
            }
        }
    }
}

#[test]
fn distances_are_measured_along_edges() {
    // Across the gap of a folded strip the vertices are near, but not along edges.
    let mut soup = mesh::PolygonSoup::new(Vec::new());
    for i in 0..40 {
        let (x, z) = if i < 20 {
            (f64::from(i), 0.0)
        } else {
            (f64::from(39 - i), 0.2)
        };
        soup.positions
            .extend([DVec3::new(x, 0.0, z), DVec3::new(x, 1.0, z)]);
    }
    for i in 0..39 {
        soup.add_face(&[2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1]);
    }
    let (mut clay, repairs) = Clay::of_polygons(&soup).unwrap();
    assert!(repairs.is_none());
    let mut sweep = Sweep::new(Action::Pull, ball(0.1));
    (sweep.decay, sweep.range) = (Decay::Cone, 3.0);
    run(&mut clay, &sweep, &[DVec3::ZERO, DVec3::Z * -1.0]);
    assert_eq!(clay.mesh().position(VertexId(0)).z, -1.0);
    assert!((clay.mesh().position(VertexId(2)).z + 2.0 / 3.0).abs() < 1e-12);
    assert_eq!(clay.mesh().position(VertexId(78)).z, 0.2);
}

#[test]
fn pressure_scales_and_masks_hold_back() {
    let mut clay = plane();
    let mut mask = Sweep::new(Action::Mask(1.0), ball(0.3));
    run(&mut clay, &mask, &[DVec3::X * 0.5]);
    mask.action = Action::Mask(0.5);
    run(&mut clay, &mask, &[DVec3::X * -0.5]);
    let before = places(&clay);
    let mut drag = Drag::new(&clay, &Sweep::new(Action::Pull, ball(2.0)));
    for (z, pressure) in [(0.0, 1.0), (1.0, 0.5)] {
        let position = DVec3::Z * z;
        drag.step(&mut clay, PathPoint { position, pressure });
    }
    drag.finish(&mut clay);
    for (v, old) in before.iter().enumerate() {
        let new = clay.mesh().position(VertexId(v as u32));
        match clay.mask(VertexId(v as u32)) {
            1.0 => assert_eq!(crate::random::bits(new), crate::random::bits(*old)),
            0.5 => assert_eq!(new.z, 0.25),
            _ => assert_eq!(new.z, 0.5),
        }
    }
    let counts = [0.0, 0.5, 1.0].map(|m| {
        clay.mesh()
            .vertices()
            .filter(|v| clay.mask(*v) == m)
            .count()
    });
    assert!(counts[1] == counts[2] && counts[1] > 20, "{counts:?}");
}

#[test]
fn constraints_keep_motions_along_or_across_normals() {
    for (constraint, is_up) in [(Constraint::Normal, true), (Constraint::Tangent, false)] {
        let mut clay = plane();
        let before = places(&clay);
        let mut sweep = Sweep::new(Action::Pull, ball(0.3));
        sweep.constraint = Some(constraint);
        run(&mut clay, &sweep, &[DVec3::ZERO, DVec3::new(0.1, 0.2, 0.3)]);
        let mut moved = 0;
        for (old, new) in before.iter().zip(places(&clay)) {
            let way = new - *old;
            if way != DVec3::ZERO {
                let wanted = if is_up {
                    DVec3::Z * 0.3
                } else {
                    DVec3::new(0.1, 0.2, 0.0)
                };
                assert!(way.distance(wanted) < 1e-12);
                moved += 1;
            }
        }
        assert!(moved > 10);
    }
}

#[test]
fn mirror_images_of_tools_make_mirror_images() {
    for planes in ["x", "y z", "x y z"] {
        let text = format!(
            "strokes 1\nstart sphere 8\nsymmetry {planes}\n\
             pull sphere 0.3 0.3 0.3 bell 0.8 : 0.5 0.4 0.8, 0.8 0.9 1.1\n\
             pull sphere 0.2 0.2 0.2 cusp 0.6 : 0.1 0.05 1, 0.3 0 1.6\n\
             push sphere 0.4 0.3 0.3 goo 0.3 : 0.9 0.3 0.1, 0.8 0 0\n\
             smooth sphere 0.4 0.4 0.4 : 0.5 0.4 0.8\n"
        );
        let script: sculpt::Script = text.parse().unwrap();
        let clay =
            sculpt::replay(&script, &mut |_| Err(String::new()), u64::MAX, |_, _, _| ()).unwrap();
        let all = places(&clay);
        assert!(all.iter().any(|p| p.z > 1.4));
        let mut signs = DVec3::ONE;
        for (axis, name) in ["x", "y", "z"].iter().enumerate() {
            if planes.contains(name) {
                signs[axis] = -1.0;
                let worst = all
                    .iter()
                    .map(|p| {
                        all.iter()
                            .map(|q| q.distance(*p * signs))
                            .fold(9.0, f64::min)
                    })
                    .fold(0.0, f64::max);
                assert!(worst < 1e-9, "{planes}: {worst}");
                signs[axis] = 1.0;
            }
        }
    }
}

#[test]
fn a_tool_on_its_mirror_plane_acts_once() {
    let [mirrored, single] = ["symmetry x\n", ""].map(|word| {
        let text = format!(
            "strokes 1\nstart plane 20\n{word}pull sphere 0.3 0.3 0.3 bell 0.5 : 0 0 0, 0 0 1\n"
        );
        let script: sculpt::Script = text.parse().unwrap();
        let clay = sculpt::replay(&script, &mut |_| Err(String::new()), u64::MAX, |_, _, _| ());
        places(&clay.unwrap())
    });
    assert_eq!(mirrored, single);
}

#[test]
fn region_follows_the_tool_and_limits_it() {
    fn count(clay: &Clay) -> usize {
        match clay.region() {
            Region::All => clay.mesh().face_count(),
            Region::Faces(faces) => faces.len(),
        }
    }
    let mut clay = plane();
    let mut choose = Sweep::new(Action::Region(Choice::Replace), ball(0.26));
    run(&mut clay, &choose, &[DVec3::X * -0.5, DVec3::X * 0.5]);
    let chosen = count(&clay);
    assert!((50..400).contains(&chosen), "{chosen}");
    choose.action = Action::Region(Choice::Remove);
    run(&mut clay, &choose, &[DVec3::X * 0.5]);
    let fewer = count(&clay);
    assert!(fewer < chosen);
    clay.change_region(RegionChange::Invert);
    assert_eq!(count(&clay), 800 - fewer);
    clay.change_region(RegionChange::Invert);
    clay.change_region(RegionChange::Grow(1));
    assert!(count(&clay) > fewer);
    clay.change_region(RegionChange::Shrink(1));
    assert!(count(&clay) >= fewer);
    let mut pull = Sweep::new(Action::Pull, ball(5.0));
    pull.only_region = true;
    run(&mut clay, &pull, &[DVec3::ZERO, DVec3::Z]);
    let lifted = places(&clay).iter().filter(|p| p.z == 1.0).count();
    assert!(lifted > 20 && lifted < 441);
    clay.change_region(RegionChange::None);
    clay.change_region(RegionChange::Grow(3));
    assert_eq!(count(&clay), 0);
}

#[test]
fn paint_and_smooth_do_what_they_say() {
    let mut clay = plane();
    assert!(clay.to_triangles().unwrap().colors.is_none());
    run(
        &mut clay,
        &Sweep::new(Action::Paint([1.0, 0.0, 0.5]), ball(0.3)),
        &[DVec3::ZERO],
    );
    let colors = clay.to_triangles().unwrap().colors.unwrap();
    let half = mesh::linear_from_srgb(128);
    assert_eq!(
        colors
            .iter()
            .filter(|c| c[0] == 1.0 && c[1] == 0.0 && (c[2] - half).abs() < 0.01)
            .count(),
        25
    );
    assert_eq!(colors.iter().filter(|c| **c == [1.0; 3]).count(), 441 - 25);

    let mut sweep = Sweep::new(Action::Pull, ball(0.01));
    sweep.range = 0.0;
    run(&mut clay, &sweep, &[DVec3::ZERO, DVec3::Z * 0.2]);
    run(
        &mut clay,
        &Sweep::new(Action::Smooth, ball(0.3)),
        &[DVec3::ZERO],
    );
    let top = places(&clay).into_iter().map(|p| p.z).fold(0.0, f64::max);
    assert!(top > 0.0 && top < 0.06, "{top}");
}

#[test]
fn a_body_of_a_model_is_a_tool() {
    use field::{Ball, Enclosure, Implicit, Jet};
    /// Ball of radius 1/2: its level is at T.
    #[derive(Debug)]
    struct Round;
    impl Implicit for Round {
        fn jet(&self, p: DVec3) -> Jet<f64> {
            Jet {
                value: field::THRESHOLD + 0.25 - p.length_squared(),
                gradient: (p * -2.0).to_array(),
            }
        }
        fn jet32(&self, _: [f32; 3]) -> Jet<f32> {
            unreachable!()
        }
        fn jet8(&self, _: [wide::f32x8; 3]) -> Jet<wide::f32x8> {
            unreachable!()
        }
        fn enclose(&self, _: Ball) -> Enclosure {
            unreachable!()
        }
        fn shares(&self, _: DVec3, _: &mut Vec<(u32, f64)>) {}
        fn support(&self) -> Option<Ball> {
            None
        }
    }
    let hand = sculpt::Body {
        function: &Round,
        bounds: mesh::Aabb {
            min: DVec3::splat(-0.5),
            max: DVec3::splat(0.5),
        },
    };
    let mut clay = plane();
    let sweep = Sweep::new(Action::Push, ball(0.5));
    let mut drag = Drag::with_solid(&clay, &sweep, Box::new(hand));
    let center = DVec3::Z * 0.3;
    drag.step(&mut clay, PathPoint::new(center));
    drag.finish(&mut clay);
    let nearest = places(&clay)
        .iter()
        .map(|p| p.distance(center))
        .fold(9.0, f64::min);
    assert!((nearest - 0.5).abs() < 1e-8, "{nearest}");
    assert!(places(&clay).iter().any(|p| p.z < -0.15));
    // A superquadric of the same shape does the same.
    let mut other = plane();
    run(&mut other, &sweep, &[center]);
    let far = places(&clay)
        .into_iter()
        .zip(places(&other))
        .map(|(a, b)| a.distance(b));
    assert!(far.fold(0.0, f64::max) < 1e-7);
}
