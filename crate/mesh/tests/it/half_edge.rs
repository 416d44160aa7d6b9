//! The half-edge structure: edits by hand, a long random run, and polygons that are no manifold.

use crate::solids::{cube, sphere, torus};
use glam::DVec3;
use mesh::{EditError, FaceId, HalfEdgeId, HalfEdgeMesh, PolygonSoup, TriangleMesh, VertexId};
use trials::{Random, count};

fn cube_mesh() -> HalfEdgeMesh {
    HalfEdgeMesh::from_polygons(&cube()).unwrap()
}

/// Vertices, edges, faces.
fn counts(mesh: &HalfEdgeMesh) -> [usize; 3] {
    mesh.validate().unwrap();
    [mesh.vertex_count(), mesh.edge_count(), mesh.face_count()]
}

fn soup(positions: usize, faces: &[&[u32]]) -> PolygonSoup {
    let mut random = Random::new(9);
    let mut soup = PolygonSoup::new((0..positions).map(|_| random.vector(1.0)).collect());
    faces.iter().for_each(|f| soup.add_face(f));
    soup
}

fn edge(mesh: &HalfEdgeMesh, from: u32, to: u32) -> HalfEdgeId {
    mesh.find_half_edge(VertexId(from), VertexId(to)).unwrap()
}

#[test]
fn solids_have_their_topology() {
    let mesh = cube_mesh();
    assert_eq!(counts(&mesh), [8, 12, 6]);
    assert!(mesh.is_closed());
    assert_eq!(mesh.to_polygons(), cube());
    assert!((mesh.to_triangles().unwrap().signed_volume() - 1.0).abs() < 1e-12);

    let torus = torus(9, 7);
    let mesh = HalfEdgeMesh::from_triangles(&torus).unwrap();
    assert_eq!(counts(&mesh), [63, 189, 126]);
    assert_eq!(mesh.shells()[0].genus(), 1);
    assert_eq!(mesh.to_triangles().unwrap(), torus);

    let mut mesh = HalfEdgeMesh::from_triangles(&sphere(6)).unwrap();
    assert_eq!(mesh.euler_characteristic(), 2);
    // Two holes make a tube, one more edge between them none.
    let faces: Vec<FaceId> = mesh.faces().collect();
    assert!(
        mesh.delete_faces(&[faces[0], faces[200]])
            .unwrap()
            .is_empty()
    );
    let shell = &mesh.shells()[0];
    assert_eq!(
        (
            shell.boundary_loops,
            shell.genus(),
            shell.euler_characteristic()
        ),
        (2, 0, 0)
    );
    for h in mesh.boundary_loops() {
        mesh.fill_hole(h).unwrap();
    }
    assert!(mesh.is_closed() && mesh.euler_characteristic() == 2);
    counts(&mesh);
}

#[test]
fn ways_around_elements() {
    let mesh = cube_mesh();
    for v in mesh.vertices() {
        assert_eq!(mesh.degree(v), 3);
        assert_eq!(mesh.vertex_faces(v).count(), 3);
        for h in mesh.vertex_half_edges(v) {
            assert_eq!(mesh.origin(h), v);
            assert_eq!(mesh.previous(mesh.next(h)), h);
            assert_eq!(mesh.twin(mesh.twin(h)), h);
            // A convex right angle.
            let angle = mesh.dihedral_angle(h).unwrap();
            assert!((angle - core::f64::consts::FRAC_PI_2).abs() < 1e-12);
        }
    }
    for f in mesh.faces() {
        assert_eq!(mesh.face_degree(f), 4);
        assert!((mesh.face_normal(f).length() - 2.0).abs() < 1e-12);
        let center = mesh.loop_center(mesh.face_half_edges(f).next().unwrap());
        assert!(mesh.face_normal(f).dot(center - 0.5) > 0.0, "outwards");
    }
    // Seen from outside neighbours come clockwise.
    let around: Vec<DVec3> = mesh
        .neighbors(VertexId(0))
        .map(|v| mesh.position(v))
        .collect();
    assert!(around[0].cross(around[1]).dot(around[2]) > 0.0);
}

#[test]
fn each_edit_does_what_it_says() {
    let mut mesh = cube_mesh();
    let h = edge(&mesh, 0, 1);
    let m = mesh.split_edge(h, DVec3::new(0.5, 0.0, 0.0)).unwrap();
    assert_eq!(counts(&mesh), [9, 13, 6]);
    assert_eq!((mesh.target(h), mesh.origin(mesh.next(h))), (m, m));
    assert_eq!(mesh.target(mesh.next(h)), VertexId(1));

    // A diagonal from the new vertex to the opposite edge's.
    let a = mesh.next(h);
    let b = mesh.next(mesh.next(a));
    let f = mesh.split_face(a, b).unwrap();
    assert_eq!(counts(&mesh), [9, 14, 7]);
    assert_eq!((mesh.face(b), mesh.face(a) == Some(f)), (Some(f), false));
    assert_eq!(mesh.split_face(a, mesh.next(a)), Err(EditError::DoubleEdge));

    let v = mesh.poke_face(f, DVec3::splat(0.3)).unwrap();
    assert_eq!(mesh.degree(v), 4);
    let spoke = mesh.outgoing(v);
    mesh.collapse_edge(spoke, mesh.position(mesh.target(spoke)))
        .unwrap();
    assert!(!mesh.has_vertex(v));
    assert_eq!(mesh.split_edge(spoke, DVec3::ONE), Err(EditError::Missing));
    assert_eq!(mesh.split_edge(h, DVec3::NAN), Err(EditError::NotFinite));
    counts(&mesh);

    let mut mesh = HalfEdgeMesh::from_triangles(&torus(5, 5)).unwrap();
    let before = counts(&mesh);
    let h = mesh.edges().next().unwrap();
    let [from, to] = [mesh.origin(h), mesh.target(h)];
    mesh.flip_edge(h).unwrap();
    assert_eq!(counts(&mesh), before);
    assert_eq!(mesh.find_half_edge(from, to), None);
    let m = mesh.bisect_edge(h, DVec3::ONE).unwrap();
    assert_eq!(mesh.degree(m), 4);
    assert!(mesh.faces().all(|f| mesh.face_degree(f) == 3));
    counts(&mesh);
}

#[test]
fn edits_that_would_break_the_mesh_are_refused() {
    let tetrahedron: [&[u32]; 4] = [&[0, 2, 1], &[0, 1, 3], &[0, 3, 2], &[1, 2, 3]];
    let mut mesh = HalfEdgeMesh::from_polygons(&soup(4, &tetrahedron)).unwrap();
    let first = mesh.clone();
    let h = edge(&mesh, 0, 1);
    assert_eq!(
        mesh.collapse_edge(h, DVec3::ZERO),
        Err(EditError::DegenerateFace)
    );
    assert_eq!(mesh.flip_edge(h), Err(EditError::DoubleEdge));
    assert_eq!(mesh.close_hole(h), Err(EditError::WrongSide));
    assert_eq!(mesh.fill_hole(h), Err(EditError::WrongSide));
    assert_eq!(mesh.weld(h, mesh.twin(h)), Err(EditError::WrongSide));
    assert_eq!(
        mesh.delete_faces(&[FaceId(0), FaceId(0)]),
        Err(EditError::Missing)
    );
    assert_eq!(
        mesh.delete_faces(&[FaceId(0), FaceId(9)]),
        Err(EditError::Missing)
    );
    assert_eq!(mesh, first);

    // A single triangle.
    let mut mesh = HalfEdgeMesh::from_polygons(&soup(3, &[&[0, 1, 2]])).unwrap();
    let h = edge(&mesh, 0, 1);
    assert_eq!(
        mesh.collapse_edge(h, DVec3::ZERO),
        Err(EditError::DoubleEdge)
    );
    assert_eq!(mesh.flip_edge(h), Err(EditError::NoTriangle));
    // Two boundary vertices joined by an inner edge.
    let mut mesh = HalfEdgeMesh::from_polygons(&soup(4, &[&[0, 1, 2], &[0, 2, 3]])).unwrap();
    let h = edge(&mesh, 0, 2);
    assert_eq!(mesh.collapse_edge(h, DVec3::ZERO), Err(EditError::Pinch));
    // The waist of a triangular tube.
    let tube: [&[u32]; 6] = [
        &[0, 1, 4, 3],
        &[1, 2, 5, 4],
        &[2, 0, 3, 5],
        &[3, 4, 7, 6],
        &[4, 5, 8, 7],
        &[5, 3, 6, 8],
    ];
    let mut mesh = HalfEdgeMesh::from_polygons(&soup(9, &tube)).unwrap();
    let h = edge(&mesh, 3, 4);
    assert_eq!(
        mesh.collapse_edge(h, DVec3::ZERO),
        Err(EditError::DoubleEdge)
    );
    counts(&mesh);
}

#[test]
fn faces_are_deleted_and_touching_sheets_come_apart() {
    // Four quadrilaterals around a vertex, of which two opposite ones go.
    let grid: [&[u32]; 4] = [&[0, 1, 4, 3], &[1, 2, 5, 4], &[3, 4, 7, 6], &[4, 5, 8, 7]];
    let mut mesh = HalfEdgeMesh::from_polygons(&soup(9, &grid)).unwrap();
    let copies = mesh.delete_faces(&[FaceId(1), FaceId(2)]).unwrap();
    assert_eq!(copies.len(), 1);
    assert_eq!(copies[0].original, VertexId(4));
    assert_eq!(mesh.position(copies[0].copy), mesh.position(VertexId(4)));
    // Corners 2 and 6 are gone, the middle is twice there.
    assert_eq!(counts(&mesh), [8, 8, 2]);
    assert_eq!(mesh.shells().len(), 2);
    let all: Vec<FaceId> = mesh.faces().collect();
    mesh.delete_faces(&all).unwrap();
    assert_eq!(counts(&mesh), [0, 0, 0]);
    // Free slots are used again.
    assert_eq!(mesh.vertex_slots(), 9);
}

#[test]
fn boundaries_are_welded() {
    // Two triangles apart become a quadrilateral's halves; then nothing more fits.
    let mut mesh = HalfEdgeMesh::from_polygons(&soup(6, &[&[0, 1, 2], &[3, 4, 5]])).unwrap();
    let (a, b) = (edge(&mesh, 1, 0), edge(&mesh, 4, 3));
    mesh.weld(a, b).unwrap();
    assert_eq!(counts(&mesh), [4, 5, 2]);
    assert!(mesh.has_vertex(VertexId(0)) && !mesh.has_vertex(VertexId(4)));
    // A fan of four triangles without the last seam: the seam's two sides meet in the centre.
    let fan: [&[u32]; 4] = [&[0, 1, 2], &[0, 2, 3], &[0, 3, 4], &[0, 4, 5]];
    let mut mesh = HalfEdgeMesh::from_polygons(&soup(6, &fan)).unwrap();
    let (a, b) = (edge(&mesh, 1, 0), edge(&mesh, 0, 5));
    mesh.weld(a, b).unwrap();
    assert_eq!(counts(&mesh), [5, 8, 4]);
    assert_eq!(mesh.degree(VertexId(0)), 4);
    // Of two triangles both seams close at once: they become the two sides of one.
    let mut mesh = HalfEdgeMesh::from_polygons(&soup(4, &[&[0, 1, 2], &[0, 2, 3]])).unwrap();
    let (a, b) = (edge(&mesh, 1, 0), edge(&mesh, 0, 3));
    mesh.weld(a, b).unwrap();
    assert_eq!(counts(&mesh), [3, 3, 2]);
    // Two sides of a triangle have no place for each other.
    let mut mesh = HalfEdgeMesh::from_polygons(&soup(3, &[&[0, 1, 2]])).unwrap();
    let (a, b) = (edge(&mesh, 1, 0), edge(&mesh, 0, 2));
    assert_eq!(mesh.weld(a, b), Err(EditError::DoubleEdge));
    assert_eq!(counts(&mesh), [3, 3, 1]);
    // A hole of four edges closes in one go.
    let mut mesh = HalfEdgeMesh::from_triangles(&sphere(4)).unwrap();
    let v = mesh.vertices().find(|v| mesh.degree(*v) == 4).unwrap();
    let around: Vec<FaceId> = mesh.vertex_faces(v).collect();
    mesh.delete_faces(&around).unwrap();
    let hole = mesh.boundary_loops()[0];
    let following = mesh.next(hole);
    mesh.weld(hole, following).unwrap();
    counts(&mesh);
    assert!(mesh.is_closed() && mesh.euler_characteristic() == 2);
}

#[test]
fn polygons_that_are_no_manifold_are_refused_or_repaired() {
    let refused = |soup: &PolygonSoup| HalfEdgeMesh::from_polygons(soup).unwrap_err().to_string();
    let repaired = |soup: &PolygonSoup| {
        let built = HalfEdgeMesh::repair(soup).unwrap();
        built.mesh.validate().unwrap();
        assert_eq!(built.sources.len(), built.mesh.vertex_count());
        built
    };
    // Three triangles at an edge.
    let book = soup(5, &[&[0, 1, 2], &[1, 0, 3], &[0, 1, 4]]);
    assert!(
        refused(&book).contains("1 edges where more than two faces meet"),
        "{}",
        refused(&book)
    );
    assert_eq!(repaired(&book).mesh.face_count(), 3);
    // Two cubes with a common edge stay closed.
    let mut cubes = cube();
    let shifted: Vec<DVec3> = cubes
        .positions
        .iter()
        .map(|p| *p + DVec3::new(1.0, 1.0, 0.0))
        .collect();
    let same = |i: u32| match i {
        0 => 3,
        4 => 7,
        i => i + 8,
    };
    let more: Vec<Vec<u32>> = cube()
        .faces()
        .map(|f| f.iter().map(|i| same(*i)).collect())
        .collect();
    cubes.positions.extend(shifted);
    more.iter().for_each(|f| cubes.add_face(f));
    let built = repaired(&cubes);
    assert!(built.mesh.is_closed());
    assert_eq!(built.mesh.shells().len(), 2);
    assert_eq!(
        (built.repairs.split_edges, built.repairs.split_vertices),
        (1, 2)
    );
    // Faces with a vertex twice, or too few.
    let bad = soup(4, &[&[0, 1, 2], &[0, 1, 0], &[1, 2], &[0, 2, 3]]);
    assert!(refused(&bad).contains("2 faces with a vertex twice"));
    assert_eq!(repaired(&bad).mesh.face_count(), 2);
    // One face of a cube turned inside out.
    let mut turned = PolygonSoup::new(cube().positions);
    for (i, f) in cube().faces().enumerate() {
        let mut f = f.to_vec();
        if i == 2 {
            f.reverse();
        }
        turned.add_face(&f);
    }
    let built = repaired(&turned);
    assert_eq!(built.repairs.flipped_faces, 1);
    assert!((built.mesh.to_triangles().unwrap().signed_volume() - 1.0).abs() < 1e-12);
    // A Möbius band has no outside.
    let band = soup(6, &[&[0, 1, 3, 2], &[2, 3, 5, 4], &[4, 5, 0, 1]]);
    assert!(refused(&band).contains("edges where more than two faces meet"));
    assert!(!repaired(&band).mesh.is_closed());
    // Missing and infinite vertices.
    assert!(refused(&soup(2, &[&[0, 1, 2]])).contains("vertex 2"));
    let mut far = soup(3, &[&[0, 1, 2]]);
    far.positions[1].x = f64::INFINITY;
    assert!(refused(&far).contains("vertex 1"));
    // Nothing.
    assert_eq!(repaired(&soup(3, &[])).mesh, HalfEdgeMesh::default());
}

/// Random polygons on few vertices: about everything that can be wrong.
#[test]
fn any_polygons_are_repaired() {
    let mut random = Random::new(77);
    for _ in 0..count(3000) {
        let vertices = 3 + random.below(8);
        let mut soup = soup(vertices, &[]);
        for _ in 0..1 + random.below(20) {
            let face: Vec<u32> = (0..2 + random.below(4))
                .map(|_| random.below(vertices) as u32)
                .collect();
            soup.add_face(&face);
        }
        let built = HalfEdgeMesh::repair(&soup).unwrap();
        built.mesh.validate().unwrap();
        assert_eq!(built.sources.len(), built.mesh.vertex_count());
        assert_eq!(
            built.mesh.face_count() + built.repairs.dropped_faces,
            soup.face_count()
        );
        for shell in built.mesh.shells() {
            let twice = 2 - shell.boundary_loops as i64 - shell.euler_characteristic();
            assert!(twice >= 0 && twice % 2 == 0);
        }
        // Repaired meshes need no further repair, nor do their triangles.
        let again = HalfEdgeMesh::from_polygons(&built.mesh.to_polygons()).unwrap();
        assert_eq!(again.face_count(), built.mesh.face_count());
        let triangles = built.mesh.to_triangles().unwrap();
        let cut = HalfEdgeMesh::from_triangles(&triangles).unwrap();
        assert_eq!(
            cut.euler_characteristic(),
            built.mesh.euler_characteristic()
        );
    }
}

/// The half-edge some steps on around its loop.
fn further(mesh: &HalfEdgeMesh, h: HalfEdgeId, steps: usize) -> HalfEdgeId {
    (0..steps).fold(h, |h, _| mesh.next(h))
}

/// Makes a random edit, which may be refused.
fn random_edit(mesh: &mut HalfEdgeMesh, random: &mut Random) -> Result<(), EditError> {
    let h = HalfEdgeId(random.below(mesh.half_edge_slots() + 1) as u32);
    let f = FaceId(random.below(mesh.face_slots() + 1) as u32);
    let p = random.vector(1.0);
    let is_large = mesh.face_count() > 1500;
    match random.below(12) {
        0 if !is_large => mesh.split_edge(h, p).map(drop),
        1 if !is_large => mesh.bisect_edge(h, p).map(drop),
        2 if !is_large => mesh.poke_face(f, p).map(drop),
        3 if mesh.has_half_edge(h) => {
            let steps = random.below(5);
            let other = further(mesh, h, steps);
            mesh.split_face(h, other).map(drop)
        }
        4 | 5 => mesh.flip_edge(h),
        6..=8 => mesh.collapse_edge(h, p),
        9 if random.below(4) == 0 => mesh.delete_faces(&[f]).map(drop),
        9 => mesh.triangulate_face(f),
        10 if mesh.has_half_edge(h) => match random.below(3) {
            0 => mesh.fill_hole(h).map(drop),
            _ => mesh.close_hole(h).map(drop),
        },
        _ => {
            let holes = mesh.boundary_loops();
            if holes.is_empty() {
                return Err(EditError::WrongSide);
            }
            let a = holes[random.below(holes.len())];
            let b = if random.chance(0.5) {
                mesh.next(a)
            } else {
                let other = holes[random.below(holes.len())];
                let steps = random.below(6);
                further(mesh, other, steps)
            };
            mesh.weld(a, b)
        }
    }
}

fn run(mut mesh: HalfEdgeMesh, seed: u64, steps: usize, every: usize) -> (HalfEdgeMesh, usize) {
    let mut random = Random::new(seed);
    let mut done = 0;
    for step in 0..steps {
        let before = (step % every == 0).then(|| mesh.clone());
        match random_edit(&mut mesh, &mut random) {
            Ok(()) => done += 1,
            Err(_) => {
                if let Some(before) = &before {
                    assert_eq!(mesh, *before, "a refused edit changes nothing");
                }
            }
        }
        if before.is_some() {
            if let Err(violation) = mesh.validate() {
                panic!("step {step}: {violation}");
            }
            let shells = mesh.shells();
            let euler: i64 = shells.iter().map(|s| s.euler_characteristic()).sum();
            assert_eq!(euler, mesh.euler_characteristic());
            for shell in &shells {
                let twice = 2 - shell.boundary_loops as i64 - shell.euler_characteristic();
                assert!(twice >= 0 && twice % 2 == 0, "step {step}: {twice}");
            }
        }
        if mesh.face_count() == 0 {
            mesh = HalfEdgeMesh::from_triangles(&sphere(3)).unwrap();
        }
    }
    (mesh, done)
}

#[test]
fn random_edits_keep_all_invariants() {
    // Small meshes, looked at after every step: here the odd cases are.
    for seed in 0..count(40) as u64 {
        run(cube_mesh(), seed, 500, 1);
        let torus = HalfEdgeMesh::from_triangles(&torus(3, 4)).unwrap();
        run(torus, seed, 500, 1);
    }
    let sphere = HalfEdgeMesh::from_triangles(&sphere(10)).unwrap();
    let steps = count(100_000);
    let (one, done) = run(sphere.clone(), 4711, steps, 100);
    assert!(
        10 * done > 3 * steps,
        "{done} edits of {steps} were possible"
    );
    let (other, _) = run(sphere, 4711, steps, steps);
    assert_eq!(one, other, "the same edits give the same mesh");
    let compact = one.compact();
    assert_eq!(counts(&compact), counts(&one));
    assert_eq!(compact.to_polygons(), one.to_polygons());
    let triangles = one.to_triangles().unwrap();
    HalfEdgeMesh::from_triangles(&triangles)
        .unwrap()
        .validate()
        .unwrap();
}

#[test]
fn large_meshes_are_built_quickly() {
    let torus = torus(400, 250);
    let begin = std::time::Instant::now();
    let mesh = HalfEdgeMesh::from_triangles(&torus).unwrap();
    mesh.validate().unwrap();
    assert_eq!(mesh.face_count(), 200_000);
    assert!(begin.elapsed().as_secs() < 20, "{:?}", begin.elapsed());
    let _: TriangleMesh = mesh.to_triangles().unwrap();
}
