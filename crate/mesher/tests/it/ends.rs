//! Flat and open ends of limbs in meshes.

use crate::judges::{assert_embedded, assert_manifold};
use glam::DVec3;
use mesh::{Topology, TriangleMesh};
use mesher::{Model, ModelPart, Progress, Tolerance, Wishes, mesh_scene};
use rats::{Project, compile};
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use trials::Random;

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
        tolerance: Tolerance::Absolute(0.02),
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
    ("cylinder Flesh 1, <-5 0 0>, <5 0 0> ends", 10.0, [1.0, 1.0]),
    (
        "cone Flesh 1, <-5 0 0>, 0.6, <5 0 0> ends",
        10.0 * 0.98 / 1.5 * 1.0,
        [1.0, 0.6],
    ),
    (
        "skeleton Flesh, S { node A <-5 0 0> radius 1 node B <5 0 0> radius 1 curve A B ends",
        10.0,
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
                assert!((p.x - 5.0 * side).abs() < 1e-9, "{limb}: {p}");
                let own = p.with_x(0.0).length();
                assert!((own / radius - 1.0).abs() < 0.08, "{limb}: {own}");
            }
        }
    }
}

/// Asserts that a part is what is told of it.
fn assert_told(name: &str, part: &ModelPart) {
    if part.is_closed {
        assert_manifold(name, &part.mesh);
    }
    if part.crossings == 0 {
        assert_embedded(name, &part.mesh);
    }
}

/// Ends at which another limb goes on are none.
#[test]
fn flat_ends_that_meet_are_none() {
    let limbs = "cylinder Flesh 1, <-4 0 0>, <0 0 0> ends flat\n\
        cylinder Flesh 1, <0 0 0>, <4 0 0> ends flat";
    let model = build(limbs, &wishes());
    let [part] = &model.parts[..] else {
        panic!("one part")
    };
    assert!(part.is_closed && part.crossings == 0);
    assert_told("flat", part);
    let names: Vec<&str> = areas(&part.mesh).iter().map(|(name, _)| *name).collect();
    assert_eq!(names.len(), 3, "{names:?}");
    let model = build(&limbs.replace("flat", "open"), &wishes());
    assert_eq!(rims(&model.parts[0].mesh).len(), 2);
    let mut notes = model.notes.iter();
    assert!(notes.any(|note| note.ends_with("2 ends are open")));
}

/// Moving vertices into planes may fold a mesh; then it is told.
#[test]
fn what_is_told_is_true_of_near_planes() {
    let coarse = Wishes {
        tolerance: Tolerance::Absolute(0.03),
        ..wishes()
    };
    let straight = "<3 0 0>";
    let bent = "<2.5 1.5 0>";
    let mut crossings = 0;
    for (shift, other) in [
        (-0.05, straight),
        (-0.01, straight),
        (0.01, bent),
        (0.03, bent),
    ] {
        let limbs = format!(
            "cylinder Flesh 1, <-3 0 0>, <0 0 0> ends flat\n\
             cylinder Flesh 1, <{shift} 0 0>, {other} ends flat"
        );
        for part in &build(&limbs, &coarse).parts {
            assert_told(&format!("{shift} {other}"), part);
            crossings += part.crossings;
        }
    }
    assert!(crossings > 0, "one of them is folded");
}

/// Parts that are smaller than cells of the usual size are seen beside flat ends, too.
#[test]
fn small_parts_at_flat_ends_are_not_missed() {
    let mut random = Random::new(5);
    let mut text = String::from("cylinder Flesh 1, <-2 0 0>, <0 0 0> ends flat\n");
    for _ in 0..12 {
        let [y, z] = [(); 2].map(|()| random.range(-0.7, 0.7));
        let x = random.range(0.045, 0.06);
        text += &format!("sphere Flesh 0.012, <{x} {y} {z}>\n");
    }
    let wishes = Wishes {
        tolerance: Tolerance::Absolute(0.02),
        ..wishes()
    };
    let model = build(&text, &wishes);
    let shells = Topology::of(&model.parts[0].mesh).unwrap().genera.len();
    assert_eq!(shells, 13);
}

/// Tips of cones take about as long as thick ends.
#[test]
fn tips_of_cones_are_quick() {
    for kernel in ["compact6", "quartic"] {
        let [tip, thick] = ["0", "0.1"].map(|radius| {
            let text = format!(
                "verbose off\neyep 0 0 90\nsurface s, diffuse Red, kernel {kernel}, \
                 blobbiness -8\ncone s 1, <-4 0 0>, {radius}, <4 0 0>"
            );
            let scene = compile(&Project::single(text)).scene;
            let go_on = &mut |_| ControlFlow::Continue(());
            let model = mesh_scene(&scene, &wishes(), &mut Progress::new(go_on)).unwrap();
            assert_eq!(Topology::of(&model.parts[0].mesh).unwrap().genera, [0]);
            println!("{kernel} {radius}: {}", model.evaluations);
            model.evaluations
        });
        assert!(tip < 4 * thick, "{kernel}: {tip} {thick}");
    }
}
