//! Flat and open ends of limbs in meshes.

use crate::judges::assert_manifold;
use glam::DVec3;
use mesh::TriangleMesh;
use mesher::{Model, Progress, Tolerance, Wishes, mesh_scene};
use rats::{Project, compile};
use std::collections::BTreeMap;
use std::ops::ControlFlow;

/// Meshes a text behind a soft material.
fn build(text: &str, wishes: &Wishes) -> Model {
    let text = format!(
        "verbose off\neyep 0 0 90\n\
         surface Flesh, diffuse Red, kernel compact6, blobbiness -8\n{text}"
    );
    let compiled = compile(&Project::single(text));
    assert_eq!(compiled.diagnostics, []);
    let go_on = &mut |_| ControlFlow::Continue(());
    mesh_scene(&compiled.scene, wishes, &mut Progress::new(go_on)).unwrap()
}

fn wishes() -> Wishes {
    Wishes {
        tolerance: Tolerance::Absolute(0.01),
        prove: false,
        ..Wishes::default()
    }
}

/// The names of a mesh's groups, with their areas.
fn areas(mesh: &TriangleMesh) -> Vec<(&str, f64)> {
    let groups = mesh.groups.iter().map(|group| {
        let areas = group.triangles.clone().map(|i| {
            let [a, b, c] = mesh.corners(i as usize);
            0.5 * (b - a).cross(c - a).length()
        });
        (&group.name[..], areas.sum())
    });
    groups.collect()
}

/// The loops of sides that one triangle has, as their vertices.
fn rims(mesh: &TriangleMesh) -> Vec<Vec<DVec3>> {
    let mut next = BTreeMap::new();
    for [a, b, c] in &mesh.triangles {
        for side in [(*a, *b), (*b, *c), (*c, *a)] {
            if next.remove(&(side.1, side.0)).is_none() {
                next.insert(side, ());
            }
        }
    }
    let mut next: BTreeMap<u32, u32> = next.into_keys().collect();
    let mut rims = Vec::new();
    while let Some((first, mut at)) = next.pop_first() {
        let mut rim = vec![mesh.positions[first as usize]];
        while at != first {
            rim.push(mesh.positions[at as usize]);
            at = next.remove(&at).expect("a loop");
        }
        rims.push(rim);
    }
    rims
}

const LIMBS: [(&str, f64, [f64; 2]); 3] = [
    ("cylinder Flesh 1, <-9 0 0>, <9 0 0> ends", 18.0, [1.0, 1.0]),
    (
        "cone Flesh 1, <-9 0 0>, 0.6, <9 0 0> ends",
        18.0 * 0.98 / 1.5 * 1.0,
        [1.0, 0.6],
    ),
    (
        "skeleton Flesh, S { node A <-9 0 0> radius 1 node B <9 0 0> radius 1 curve A B ends",
        18.0,
        [1.0, 1.0],
    ),
];

fn text(limb: &str, ends: &str) -> String {
    format!(
        "{limb} {ends}{}",
        if limb.contains('{') { " }" } else { "" }
    )
}

#[test]
fn flat_ends_are_groups_of_a_closed_mesh() {
    for (limb, length, radii) in LIMBS {
        let model = build(&text(limb, "flat"), &wishes());
        let [part] = &model.parts[..] else {
            panic!("one part")
        };
        assert!(part.is_closed, "{limb}");
        assert_manifold(limb, &part.mesh);
        let volume = part.mesh.signed_volume() / core::f64::consts::PI;
        assert!((volume / length - 1.0).abs() < 0.03, "{limb}: {volume}");
        let areas = areas(&part.mesh);
        let names: Vec<&str> = areas.iter().map(|(name, _)| *name).collect();
        assert!(names == ["", "inlet", "outlet-1"] || names == ["", "outlet-1", "inlet"]);
        for (_, area) in &areas[1..] {
            let radius = (area / core::f64::consts::PI).sqrt();
            let off = radii.map(|own| (radius / own - 1.0).abs());
            assert!(off[0].min(off[1]) < 0.08, "{limb}: {radius}");
        }
    }
}

#[test]
fn open_ends_are_holes_in_their_planes() {
    for (limb, _, radii) in LIMBS {
        let model = build(&text(limb, "open"), &wishes());
        let [part] = &model.parts[..] else {
            panic!("one part")
        };
        assert!(!part.is_closed, "{limb}");
        assert!(
            model
                .notes
                .iter()
                .any(|note| note.ends_with("2 ends are open"))
        );
        assert_eq!(areas(&part.mesh).len(), 1, "{limb}");
        let rims = rims(&part.mesh);
        assert_eq!(rims.len(), 2, "{limb}");
        for rim in rims {
            let side = rim[0].x.signum();
            let radius = radii[usize::from(side > 0.0)];
            for p in rim {
                assert!((p.x - 9.0 * side).abs() < 1e-9, "{limb}: {p}");
                let own = p.with_x(0.0).length();
                assert!((own / radius - 1.0).abs() < 0.08, "{limb}: {own}");
            }
        }
    }
}
