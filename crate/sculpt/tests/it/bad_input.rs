//! Meshes that are not what one would wish: opened and repaired, or refused in words, never a
//! crash.

use glam::DVec3;
use mesh::TriangleMesh;
use sculpt::{Action, Clay, Sculpture, Stroke};
use trials::Random;

/// Strokes of all kinds; each may be refused, none may break the mesh.
fn sculpt_at(clay: Clay, seed: u64) -> usize {
    let mut sculpture = Sculpture::new(clay);
    let first = sculpture.clay().digest();
    let mut random = Random::new(seed);
    let mut done = 0;
    for k in 0..12 {
        let stroke = match k % 6 {
            0 => Stroke::Sweep(crate::strokes::sweep(&mut random, Action::Push)),
            1 => Stroke::Sweep(crate::strokes::sweep(&mut random, Action::Pull)),
            2 => Stroke::Refine(sculpt::Refinement::Propagate),
            3 => Stroke::Sweep(crate::strokes::sweep(&mut random, Action::Smooth)),
            4 => Stroke::Fill,
            _ => Stroke::Simplify(0.5),
        };
        done += usize::from(sculpture.carry_out(stroke).is_ok());
        sculpture.clay().mesh().validate().expect("a valid mesh");
    }
    while sculpture.undo().expect("it was carried out").is_some() {}
    assert_eq!(sculpture.clay().digest(), first);
    done
}

/// Returns a tetrahedron about a place.
fn tetrahedron(mesh: &mut TriangleMesh, place: DVec3) {
    let first = mesh.positions.len() as u32;
    let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    mesh.positions.extend(corners.map(|p| p + place));
    let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    mesh.triangles
        .extend(faces.map(|f: [u32; 3]| f.map(|i| i + first)));
}

#[test]
fn self_intersecting_meshes_are_sculpted() {
    let mut mesh = TriangleMesh::default();
    for k in 0..5 {
        tetrahedron(&mut mesh, DVec3::splat(0.17 * f64::from(k)));
    }
    let (clay, _) = Clay::of_triangles(&mesh).unwrap();
    assert_eq!(clay.mesh().shells().len(), 5);
    assert!(sculpt_at(clay, 1) > 6);
}

#[test]
fn edges_of_three_faces_and_bow_ties_are_repaired() {
    // Three sheets at one edge, and two fans at one vertex.
    let positions = vec![
        DVec3::ZERO,
        DVec3::Z,
        DVec3::X,
        DVec3::Y,
        DVec3::new(-1.0, -1.0, 0.0),
        DVec3::new(0.3, 0.3, -1.0),
        DVec3::new(-0.3, 0.3, -1.0),
    ];
    let triangles = vec![[0, 1, 2], [0, 1, 3], [1, 0, 4], [0, 5, 6]];
    let (clay, repairs) = Clay::of_triangles(&TriangleMesh::new(positions, triangles)).unwrap();
    assert!(!repairs.is_none());
    clay.mesh().validate().unwrap();
    assert!(sculpt_at(clay, 2) > 4);
}

#[test]
fn faces_without_area_and_open_meshes_are_sculpted() {
    let mut positions: Vec<DVec3> = (0..4).map(|k| DVec3::new(f64::from(k), 0.0, 0.0)).collect();
    positions.push(DVec3::Y);
    // A face along a line, one that is no triangle, one twice, and a plain one.
    let triangles = vec![[0, 1, 2], [1, 1, 3], [0, 1, 4], [0, 1, 4], [2, 3, 4]];
    let (clay, _) = Clay::of_triangles(&TriangleMesh::new(positions, triangles)).unwrap();
    assert!(!clay.mesh().is_closed());
    assert!(sculpt_at(clay, 3) > 4);
}

#[test]
fn what_is_no_mesh_is_refused_in_words() {
    fn refusal(mesh: &TriangleMesh) -> String {
        Clay::of_triangles(mesh).map(drop).unwrap_err().to_string()
    }
    assert_eq!(refusal(&TriangleMesh::default()), "this mesh has no faces");
    let far = vec![DVec3::ZERO, DVec3::X * 1e10, DVec3::Y];
    assert_eq!(
        refusal(&TriangleMesh::new(far, vec![[0, 1, 2]])),
        "vertex 1 (from 0) is not within 1e9"
    );
    let none = vec![DVec3::splat(f64::NAN), DVec3::X, DVec3::Y];
    assert!(refusal(&TriangleMesh::new(none, vec![[0, 1, 2]])).contains("not within"));
    let many = vec![[0, 1, 2]; sculpt::limits::MAX_FACES + 1];
    let positions = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
    assert!(
        refusal(&TriangleMesh::new(positions, many))
            .contains("more than the 2000000 that can be sculpted")
    );
}

#[test]
fn a_file_of_a_million_faces_is_opened_and_a_stroke_of_it_is_quick() {
    let n = 708;
    let mut mesh = TriangleMesh::default();
    for y in 0..=n {
        for x in 0..=n {
            let (x, y) = (f64::from(x) / f64::from(n), f64::from(y) / f64::from(n));
            mesh.positions.push(DVec3::new(
                x,
                y,
                0.05 * libm::sin(9.0 * x) * libm::cos(7.0 * y),
            ));
        }
    }
    let at = |x: u32, y: u32| y * (n + 1) + x;
    for y in 0..n {
        for x in 0..n {
            mesh.triangles
                .push([at(x, y), at(x + 1, y), at(x + 1, y + 1)]);
            mesh.triangles
                .push([at(x, y), at(x + 1, y + 1), at(x, y + 1)]);
        }
    }
    let (clay, repairs) = Clay::of_triangles(&mesh).unwrap();
    assert!(repairs.is_none());
    assert_eq!(clay.mesh().face_count(), 1_002_528);
    let mut sculpture = Sculpture::new(clay);
    let text = "strokes 1\nstart box 1\npush sphere 0.02 0.02 0.02 bell 0.02 : 0.5 0.5 0.03\n";
    let script: sculpt::Script = text.parse().unwrap();
    let before = sculpture.clay().work();
    sculpture.carry_out(script.strokes[0].clone()).unwrap();
    // It visits what it touches, not all.
    let visited = sculpture.clay().work() - before;
    assert!((500..60_000).contains(&visited), "{visited}");
}
