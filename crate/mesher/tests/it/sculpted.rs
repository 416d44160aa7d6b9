//! From clay to a printer: strokes make a mesh, flesh grows on it, the flesh is meshed and written
//! as STL, and what a reader finds in the file is judged by another program.

use crate::judges::assert_manifold;
use mesh::{Export, Format, Part, TriangleMesh};
use mesher::{Progress, Step, Tolerance, Wishes, mesh_scene};
use rats::{File, Project, compile_at};
use std::collections::BTreeMap;
use std::ops::ControlFlow;

/// A ball with a horn.
const STROKES: &str =
    "strokes 1\nstart sphere 3\npull sphere 0.4 0.4 0.4 bell 0.9 : 0 0 0.9, 0.2 0 1.7\n";

/// A mesh whose corners at the same place are one vertex, as a printer's program makes of a file
/// that names each corner.
fn welded(mesh: &TriangleMesh) -> TriangleMesh {
    let mut places = BTreeMap::new();
    let mut positions = Vec::new();
    let mut vertex = |i: u32| {
        let place = mesh.positions[i as usize];
        *places
            .entry(place.to_array().map(f64::to_bits))
            .or_insert_with(|| {
                positions.push(place);
                positions.len() as u32 - 1
            })
    };
    let triangles = mesh.triangles.iter().map(|t| t.map(&mut vertex)).collect();
    TriangleMesh::new(positions, triangles)
}

#[test]
fn sculpture_with_flesh_on_it_is_printed() {
    for (name, main, volumes) in [
        (
            "convolved",
            "soft on\n\
             surface Flesh, diffuse Coral, kernel quartic, blobbiness -2, radius 0.25\n\
             mesh Flesh clay.strokes\n",
            6.0..11.0,
        ),
        (
            "metaballs",
            "surface Clay, diffuse Coral\nmesh Clay clay.strokes metaballs triangular 0.08 40\n",
            // It is hollow.
            2.0..4.0,
        ),
    ] {
        let file = |name: &str, text: &str| File {
            name: name.into(),
            text: text.into(),
        };
        let project = Project {
            files: vec![file("main.rat", main), file("clay.strokes", STROKES)],
        };
        let compiled = compile_at(&project, &[], 0.0);
        assert!(
            compiled
                .diagnostics
                .iter()
                .all(|d| d.severity != rats::Severity::Error),
            "{name}: {:?}",
            compiled.diagnostics
        );
        let wishes = Wishes {
            tolerance: Tolerance::Relative(1e-2),
            ..Wishes::default()
        };
        let mut go_on = |_: Step| ControlFlow::Continue(());
        let model = mesh_scene(&compiled.scene, &wishes, &mut Progress::new(&mut go_on)).unwrap();
        assert_eq!(model.parts.len(), 1, "{name}");
        let part = &model.parts[0];
        assert!(part.is_closed, "{name}");
        assert_manifold(name, &part.mesh);
        let export = Export {
            name: name.into(),
            parts: vec![Part {
                name: part.name.clone(),
                mesh: part.mesh.clone(),
            }],
            millimetres: 20.0,
        };
        let written = &export.write(Format::Stl).unwrap()[0];
        let read = mesh::read(&written.name, &written.bytes).unwrap();
        assert_eq!(read.triangles.len(), part.mesh.triangles.len(), "{name}");
        let read = welded(&read);
        assert_manifold(name, &read);
        // The horn is 1.7 units above the middle of a ball whose radius is 1.
        let height = read.bounds().size().z / 20.0;
        assert!((2.4..3.4).contains(&height), "{name}: {height}");
        let volume = read.signed_volume() / (20.0 * 20.0 * 20.0);
        assert!(volumes.contains(&volume), "{name}: {volume}");
    }
}
