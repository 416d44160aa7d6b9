//! Refinement, smoothing, holes, deletion and simplification.

use glam::DVec3;
use mesh::PolygonSoup;
use sculpt::{
    Action, Choice, Clay, Deletion, Drag, Form, PathPoint, Refinement, Region, RegionChange, Shape,
    Start, Sweep, Tool,
};

fn shape(shape: Shape, n: u32) -> Clay {
    Clay::of_shape(&Start::new(shape, n)).unwrap()
}

/// Chooses the faces at vertices in a ball.
fn choose(clay: &mut Clay, center: DVec3, radius: f64) -> usize {
    sweep(clay, Action::Region(Choice::Replace), center, radius);
    match clay.region() {
        Region::All => clay.mesh().face_count(),
        Region::Faces(faces) => faces.len(),
    }
}

fn sweep(clay: &mut Clay, action: Action, center: DVec3, radius: f64) {
    let tool = Tool::new(Form::Sphere, DVec3::splat(radius));
    let mut drag = Drag::new(clay, &Sweep::new(action, tool));
    drag.step(clay, PathPoint::new(center));
    drag.finish(clay);
}

fn degrees(clay: &Clay) -> Vec<usize> {
    let mesh = clay.mesh();
    mesh.faces().map(|f| mesh.face_degree(f)).collect()
}

#[test]
fn quartering_all_makes_four_of_each_triangle() {
    for how in [Refinement::Propagate, Refinement::Local] {
        let mut clay = shape(Shape::Tetrahedron, 2);
        let area = area(&clay);
        clay.refine(how).unwrap();
        clay.mesh().validate().unwrap();
        assert_eq!(clay.mesh().face_count(), 64);
        assert!(degrees(&clay).iter().all(|d| *d == 3));
        assert!((self::area(&clay) - area).abs() < 1e-12);
        assert_eq!(clay.mesh().euler_characteristic(), 2);
    }
}

fn area(clay: &Clay) -> f64 {
    let mesh = clay.mesh();
    mesh.faces()
        .map(|f| 0.5 * mesh.face_normal(f).length())
        .sum()
}

#[test]
fn propagation_keeps_triangles_and_its_absence_keeps_neighbours() {
    for radius in [0.01, 0.15, 0.4, 0.7] {
        let mut clay = shape(Shape::Plane, 8);
        let before = clay.mesh().face_count();
        let chosen = choose(&mut clay, DVec3::new(0.25, 0.0, 0.0), radius);
        let mut local = clay.clone();

        clay.refine(Refinement::Propagate).unwrap();
        clay.mesh().validate().unwrap();
        assert!(degrees(&clay).iter().all(|d| *d == 3));
        let Region::Faces(faces) = clay.region() else {
            panic!("a region")
        };
        assert_eq!(faces.len(), 4 * chosen);
        assert!(clay.mesh().face_count() > before + 3 * chosen);

        local.refine(Refinement::Local).unwrap();
        local.mesh().validate().unwrap();
        assert_eq!(local.mesh().face_count(), before + 3 * chosen);
        assert!(degrees(&local).iter().any(|d| *d > 3));
        assert!((area(&local) - 4.0).abs() < 1e-12 && (area(&clay) - 4.0).abs() < 1e-12);

        // The polygons become triangles again.
        local.change_region(RegionChange::All);
        let polygons: usize = degrees(&local)
            .iter()
            .filter(|d| **d > 3)
            .map(|d| d - 1)
            .sum();
        let faces = local.mesh().face_count();
        local.refine(Refinement::Polygons).unwrap();
        assert!(degrees(&local).iter().all(|d| *d == 3));
        assert_eq!(local.mesh().face_count(), faces + polygons);
    }
}

#[test]
fn every_face_can_get_a_centre() {
    let mut clay = shape(Shape::Box, 2);
    clay.refine(Refinement::Centers).unwrap();
    assert_eq!(clay.mesh().face_count(), 48 * 3);
}

#[test]
fn masks_and_colours_are_carried_to_new_vertices() {
    let mut clay = shape(Shape::Plane, 4);
    sweep(&mut clay, Action::Mask(1.0), DVec3::ZERO, 5.0);
    sweep(&mut clay, Action::Paint([1.0, 0.0, 0.0]), DVec3::ZERO, 5.0);
    for how in Refinement::ALL {
        clay.refine(how).unwrap();
    }
    clay.smooth_loop(1).unwrap();
    let mesh = clay.mesh();
    assert!(
        mesh.vertices()
            .all(|v| clay.mask(v) == 1.0 && clay.color(v) == [1.0, 0.0, 0.0])
    );
    // All is held, so all is flat.
    assert!(mesh.vertices().all(|v| mesh.position(v).z == 0.0));
}

/// Loop's scheme on triangles as lists, written another way: edge by edge in a map.
fn loop_of_lists(positions: &[DVec3], triangles: &[[u32; 3]]) -> Vec<DVec3> {
    use std::collections::{BTreeMap, BTreeSet};
    let mut opposite: BTreeMap<[u32; 2], Vec<u32>> = BTreeMap::new();
    let mut around: Vec<BTreeSet<u32>> = vec![BTreeSet::new(); positions.len()];
    for t in triangles {
        for k in 0..3 {
            let (a, b, c) = (t[k], t[(k + 1) % 3], t[(k + 2) % 3]);
            opposite.entry([a.min(b), a.max(b)]).or_default().push(c);
            around[a as usize].extend([b, c]);
        }
    }
    let at = |i: &u32| positions[*i as usize];
    let mut new: Vec<DVec3> = (0..positions.len())
        .map(|i| {
            let n = around[i].len() as f64;
            let inner = 3.0 / 8.0 + 2.0 / 8.0 * libm::cos(2.0 * core::f64::consts::PI / n);
            let alpha = 5.0 / 8.0 - inner * inner;
            let mean: DVec3 = around[i].iter().map(at).sum::<DVec3>() / n;
            positions[i].lerp(mean, alpha)
        })
        .collect();
    for ([a, b], c) in &opposite {
        new.push((3.0 * (at(a) + at(b)) + at(&c[0]) + at(&c[1])) / 8.0);
    }
    new
}

#[test]
fn loop_of_all_is_loops_scheme() {
    for start in [
        Start::new(Shape::Tetrahedron, 1),
        Start::new(Shape::Box, 2),
        Start::new(Shape::Sphere, 3),
    ] {
        let mut clay = Clay::of_shape(&start).unwrap();
        let lists = clay.to_triangles().unwrap();
        let mut wanted = loop_of_lists(&lists.positions, &lists.triangles);
        clay.smooth_loop(1).unwrap();
        clay.mesh().validate().unwrap();
        let mut found: Vec<DVec3> = clay
            .mesh()
            .vertices()
            .map(|v| clay.mesh().position(v))
            .collect();
        assert_eq!(found.len(), wanted.len());
        for p in &found {
            let nearest = wanted.iter().map(|q| q.distance(*p)).fold(9.0, f64::min);
            assert!(nearest < 1e-12, "{start:?}: {p} is off by {nearest}");
        }
        found.dedup();
        wanted.dedup();
        assert_eq!(found.len(), wanted.len());
    }
}

#[test]
fn loop_of_a_part_leaves_the_rest_and_makes_no_cracks() {
    let mut clay = shape(Shape::Sphere, 4);
    let faces = clay.mesh().face_count();
    let chosen = choose(&mut clay, DVec3::Z, 0.6);
    let far: Vec<_> = clay
        .mesh()
        .vertices()
        .filter(|v| clay.mesh().position(*v).z < 0.0)
        .collect();
    let before: Vec<DVec3> = far.iter().map(|v| clay.mesh().position(*v)).collect();
    clay.smooth_loop(2).unwrap();
    clay.mesh().validate().unwrap();
    assert!(clay.mesh().is_closed() && degrees(&clay).iter().all(|d| *d == 3));
    assert!(clay.mesh().face_count() > faces + 15 * chosen);
    for (v, p) in far.iter().zip(before) {
        assert_eq!(clay.mesh().position(*v), p);
    }
}

#[test]
fn averaging_flattens_without_new_vertices() {
    fn top(clay: &Clay) -> f64 {
        let mesh = clay.mesh();
        mesh.vertices()
            .map(|v| mesh.position(v).z)
            .fold(0.0, f64::max)
    }
    let mut clay = shape(Shape::Plane, 10);
    sweep(&mut clay, Action::Pull, DVec3::ZERO, 0.1);
    let tool = Tool::new(Form::Sphere, DVec3::splat(0.1));
    let mut drag = Drag::new(&clay, &Sweep::new(Action::Pull, tool));
    drag.step(&mut clay, PathPoint::new(DVec3::ZERO));
    drag.step(&mut clay, PathPoint::new(DVec3::Z));
    drag.finish(&mut clay);
    assert_eq!(top(&clay), 1.0);
    clay.average(1, 0.5).unwrap();
    assert!((top(&clay) - 0.5).abs() < 1e-12);
    clay.average(50, 1.0).unwrap();
    assert!(top(&clay) < 0.1 && clay.mesh().vertex_count() == 121);
    let corner = clay
        .mesh()
        .vertices()
        .map(|v| clay.mesh().position(v).x)
        .fold(0.0, f64::max);
    assert!(corner <= 1.0);
}

#[test]
fn holes_are_made_and_filled_and_faces_merged() {
    let mut clay = shape(Shape::Sphere, 6);
    let chosen = choose(&mut clay, DVec3::Z, 0.4);
    let faces = clay.mesh().face_count();
    let mut merged = clay.clone();

    clay.delete(Deletion::Hole).unwrap();
    clay.mesh().validate().unwrap();
    assert_eq!(clay.mesh().face_count(), faces - chosen);
    assert_eq!(
        (
            clay.mesh().boundary_loops().len(),
            clay.mesh().euler_characteristic()
        ),
        (1, 1)
    );
    let sides = clay
        .mesh()
        .loop_half_edges(clay.mesh().boundary_loops()[0])
        .count();
    clay.fill_holes().unwrap();
    clay.mesh().validate().unwrap();
    assert!(clay.mesh().is_closed());
    assert_eq!(clay.mesh().face_count(), faces - chosen + sides);

    merged.delete(Deletion::Face).unwrap();
    merged.mesh().validate().unwrap();
    assert_eq!(merged.mesh().face_count(), faces - chosen + 1);
    let Region::Faces(made) = merged.region() else {
        panic!("a region")
    };
    assert_eq!((made.len(), merged.mesh().face_degree(made[0])), (1, sides));
}

#[test]
fn what_cannot_be_deleted_is_refused_in_words_and_left_alone() {
    let mut clay = shape(Shape::Sphere, 4);
    let digest = clay.digest();
    let error = clay.delete(Deletion::Hole).unwrap_err();
    assert_eq!(
        error.to_string(),
        "nothing would be left: choose a region first"
    );
    // A belt is no disc.
    choose(&mut clay, DVec3::ZERO, 2.0);
    sweep(&mut clay, Action::Region(Choice::Remove), DVec3::Z, 0.5);
    sweep(&mut clay, Action::Region(Choice::Remove), DVec3::NEG_Z, 0.5);
    let belt = clay.digest();
    assert_ne!(belt, digest);
    assert!(
        clay.delete(Deletion::Face)
            .unwrap_err()
            .to_string()
            .contains("has a hole")
    );
    assert_eq!(clay.digest(), belt);
    let mut plane = shape(Shape::Plane, 4);
    choose(&mut plane, DVec3::X, 0.3);
    assert!(
        plane
            .delete(Deletion::Face)
            .unwrap_err()
            .to_string()
            .contains("ends with the mesh")
    );
}

#[test]
fn faces_with_a_mask_are_not_deleted() {
    let mut clay = shape(Shape::Sphere, 6);
    sweep(&mut clay, Action::Mask(1.0), DVec3::Z, 0.1);
    let chosen = choose(&mut clay, DVec3::Z, 0.6);
    let before = clay.mesh().face_count();
    clay.delete(Deletion::Hole).unwrap();
    assert_eq!(clay.mesh().face_count(), before - chosen + 4);
}

#[test]
fn simplification_reduces_the_region_only() {
    let mut clay = shape(Shape::Sphere, 10);
    let faces = clay.mesh().face_count();
    let chosen = choose(&mut clay, DVec3::Z, 0.8);
    let south: Vec<_> = clay
        .mesh()
        .vertices()
        .filter(|v| clay.mesh().position(*v).z < 0.0)
        .collect();
    clay.simplify(0.5).unwrap();
    clay.mesh().validate().unwrap();
    let fewer = faces - clay.mesh().face_count();
    assert!(
        fewer >= chosen / 2 - 2 && fewer <= chosen / 2 + 2,
        "{fewer} of {chosen}"
    );
    assert!(south.iter().all(|v| clay.mesh().has_vertex(*v)));
    let round = clay
        .mesh()
        .vertices()
        .map(|v| clay.mesh().position(v).length());
    assert!(round.into_iter().all(|r| (0.95..1.02).contains(&r)));
}

#[test]
fn bad_meshes_are_repaired_or_refused_in_words() {
    fn soup(points: &[[f64; 3]], faces: &[&[u32]]) -> PolygonSoup {
        let mut soup = PolygonSoup::new(points.iter().map(|p| DVec3::from(*p)).collect());
        faces.iter().for_each(|f| soup.add_face(f));
        soup
    }
    let corners = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, 1.0, 1.0],
    ];
    // Three faces at an edge; faces that disagree; a face with a vertex twice.
    let (clay, repairs) = Clay::of_polygons(&soup(
        &corners,
        &[&[0, 1, 2], &[0, 1, 3], &[0, 1, 4], &[2, 2, 3]],
    ))
    .unwrap();
    clay.mesh().validate().unwrap();
    assert_eq!((repairs.split_edges, repairs.dropped_faces), (1, 1));
    // Faces without area, and one that cuts another, can be sculpted.
    let flat = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [2.0, 0.0, 0.0],
        [0.5, -1.0, -1.0],
        [0.5, 1.0, 1.0],
        [0.5, 1.0, -1.0],
    ];
    let (mut clay, _) = Clay::of_polygons(&soup(&flat, &[&[0, 1, 2], &[3, 4, 5]])).unwrap();
    clay.smooth_loop(3).unwrap();
    sweep(&mut clay, Action::Push, DVec3::ZERO, 1.0);
    clay.simplify(0.1).unwrap();
    clay.mesh().validate().unwrap();
    for (points, faces, words) in [
        (&corners[..], &[][..], "no faces"),
        (&corners, &[&[0, 1, 9][..]], "has vertex 9"),
        (
            &[[f64::NAN, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            &[&[0, 1, 2]],
            "not within 1e9",
        ),
        (
            &[[1e300, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            &[&[0, 1, 2]],
            "not within 1e9",
        ),
    ] {
        let error = Clay::of_polygons(&soup(points, faces))
            .unwrap_err()
            .to_string();
        assert!(error.contains(words), "{error}");
    }
}

#[test]
fn single_triangles_of_a_file_are_joined() {
    let tetrahedron = shape(Shape::Tetrahedron, 2).to_triangles().unwrap();
    let mut loose = mesh::TriangleMesh::default();
    for i in 0..tetrahedron.triangles.len() {
        loose.positions.extend(tetrahedron.corners(i));
        let n = 3 * i as u32;
        loose.triangles.push([n, n + 1, n + 2]);
    }
    loose.colors = Some(vec![[0.25; 3]; loose.positions.len()]);
    let (clay, repairs) = Clay::of_triangles(&loose).unwrap();
    assert!(repairs.is_none() && clay.mesh().is_closed());
    assert_eq!(clay.mesh().vertex_count(), 10);
    assert_eq!(clay.to_triangles().unwrap().colors.unwrap()[0], [0.25; 3]);
}

#[test]
fn a_sculpture_has_at_most_two_million_faces() {
    assert!(Start::new(Shape::Sphere, 500).check().is_ok());
    for n in [501, 100_000, u32::MAX] {
        let error = Clay::of_shape(&Start::new(Shape::Sphere, n)).unwrap_err();
        assert_eq!(error.to_string(), "this would be more than 2000000 faces");
    }
    // 720,000 faces cannot become four times as many.
    let mut clay = shape(Shape::Sphere, 300);
    let before = clay.mesh().face_count();
    for error in [
        clay.refine(Refinement::Propagate),
        clay.refine(Refinement::Centers),
        clay.smooth_loop(1),
    ] {
        assert!(error.unwrap_err().to_string().contains("at most 2000000"));
    }
    assert_eq!(clay.mesh().face_count(), before);
}
