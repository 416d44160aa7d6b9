//! `ends round|flat|open`, on skeletons and on limbs by themselves.

use field::THRESHOLD;
use glam::DVec3;
use rats::{Compiled, Project, Severity, compile};
use scene::flat_ends::FlatEnd;
use scene::{Scene, Surface};

const LOOKS: &str = "eyep 0 0 90\nsurface Flesh, diffuse Red, radius 1, blobbiness -4\n\
    surface Clay, diffuse Red\n";

/// Compiles a text behind a soft material `Flesh` and a hard one `Clay`.
fn read(text: &str) -> Compiled {
    compile(&Project::single(format!("verbose on\n{LOOKS}{text}")))
}

/// The scene of a text that has no mistakes.
fn scene(text: &str) -> Scene {
    let compiled = read(text);
    let mut told = compiled.diagnostics.iter();
    let complaint = told.find(|told| told.severity > Severity::Note);
    assert_eq!(complaint, None, "{text}");
    std::sync::Arc::unwrap_or_clone(compiled.scene)
}

fn surface(scene: &Scene) -> Surface {
    scene.surfaces().swap_remove(0)
}

fn value(surface: &Surface, place: DVec3) -> f64 {
    surface.function().jet(place).value
}

/// Asserts that a surface reaches a flat end's plane over its disk, and ends there.
fn assert_flat(surface: &Surface, end: &FlatEnd, text: &str) {
    let (u, v) = end.outward.any_orthonormal_pair();
    for i in 0..24 {
        let (sine, cosine) = libm::sincos(f64::from(i) * 1.7);
        let across = (u * cosine + v * sine) * (end.radius * f64::from(i) / 24.0);
        if across.length() < 0.9 * end.radius {
            let before = end.at + across - end.outward * (0.02 * end.radius);
            assert!(value(surface, before) > THRESHOLD, "{text} {i}");
        }
        for step in [0.02, 0.5, 1.2, 3.0] {
            let behind = end.at + across + end.outward * (step * end.radius);
            assert!(value(surface, behind) < THRESHOLD, "{text} {i} {step}");
        }
    }
}

/// A command, the place and radius of each end, and a place on the way.
type Limb = (&'static str, [(DVec3, f64); 2], DVec3);

/// Limbs with two free ends.
const LIMBS: [Limb; 8] = [
    (
        "cylinder Flesh 1, <-9 0 0>, <9 0 0>",
        [
            (DVec3::new(-9.0, 0.0, 0.0), 1.0),
            (DVec3::new(9.0, 0.0, 0.0), 1.0),
        ],
        DVec3::ZERO,
    ),
    (
        "pipe Flesh 1, <-9 0 0>, <9 0 0>",
        [
            (DVec3::new(-9.0, 0.0, 0.0), 1.0),
            (DVec3::new(9.0, 0.0, 0.0), 1.0),
        ],
        DVec3::ZERO,
    ),
    (
        "cone Flesh 1, <-9 0 0>, 0.5, <9 0 0>",
        [
            (DVec3::new(-9.0, 0.0, 0.0), 1.0),
            (DVec3::new(9.0, 0.0, 0.0), 0.5),
        ],
        DVec3::ZERO,
    ),
    (
        "line Flesh, <-9 0 0>, <9 0 0>",
        [
            (DVec3::new(-9.0, 0.0, 0.0), 1.0),
            (DVec3::new(9.0, 0.0, 0.0), 1.0),
        ],
        DVec3::ZERO,
    ),
    (
        "arc Flesh 8, 1, <0 0 0>, <0 0 1>, 0 180",
        [
            (DVec3::new(8.0, 0.0, 0.0), 1.0),
            (DVec3::new(-8.0, 0.0, 0.0), 1.0),
        ],
        DVec3::new(0.0, 8.0, 0.0),
    ),
    (
        "arch Flesh 1, <-8 0 0>, <0 8 0>, <8 0 0>",
        [
            (DVec3::new(-8.0, 0.0, 0.0), 1.0),
            (DVec3::new(8.0, 0.0, 0.0), 1.0),
        ],
        DVec3::new(0.0, 8.0, 0.0),
    ),
    (
        "curve Flesh 1, <-18 0 0> <-15 3 0> <-12 3 0> <-9 0 0> <-6 -3 0> <-3 -3 0> <0 0 0>",
        [(DVec3::new(-18.0, 0.0, 0.0), 1.0), (DVec3::ZERO, 1.0)],
        DVec3::new(-9.0, 0.0, 0.0),
    ),
    (
        "skeleton Flesh, S { node A <-9 0 0> node B <0 4 0> radius 2 node C <9 0 0> radius 0.7 \
         curve A B C subdivide 4",
        [
            (DVec3::new(-9.0, 0.0, 0.0), 1.0),
            (DVec3::new(9.0, 0.0, 0.0), 0.7),
        ],
        DVec3::new(0.0, 2.7, 0.0),
    ),
];

/// A limb with ends of some shape.
fn with_ends(limb: &str, ends: &str) -> String {
    let closes = if limb.contains('{') { " }" } else { "" };
    format!("{limb} ends {ends}{closes}")
}

#[test]
fn limbs_of_all_kinds_end_in_planes() {
    for (limb, places, middle) in LIMBS {
        let text = with_ends(limb, "flat");
        let flat = scene(&text);
        let ends = flat.flat_ends(0);
        assert_eq!(ends.len(), 2, "{text}");
        let whole = surface(&flat);
        for (at, radius) in places {
            let end = ends.iter().find(|end| end.at.distance(at) < 1e-9);
            let end = end.unwrap_or_else(|| panic!("{text}: no end at {at}"));
            assert!((end.radius - radius).abs() < 1e-9 && !end.is_open, "{text}");
            assert!((end.outward.length() - 1.0).abs() < 1e-9, "{text}");
            assert_flat(&whole, end, &text);
        }
        // Far from the ends it is as round ones are.
        let round = surface(&scene(&with_ends(limb, "round")));
        for offset in [DVec3::ZERO, DVec3::Z, DVec3::new(0.2, -0.3, 0.7)] {
            let [a, b] = [&whole, &round].map(|surface| value(surface, middle + offset));
            assert!((a - b).abs() < 2e-3 * b.max(1.0), "{text}: {a} {b}");
        }
        assert!(round.function().support().is_some());
        assert_eq!(scene(&with_ends(limb, "round")).flat_ends(0), []);
        let open = scene(&with_ends(limb, "open")).flat_ends(0);
        assert!(open.iter().all(|end| end.is_open), "{text}");
        let open: Vec<DVec3> = open.iter().map(|end| end.at).collect();
        assert_eq!(open, ends.iter().map(|end| end.at).collect::<Vec<_>>());
    }
}

#[test]
fn only_the_limb_itself_is_cut() {
    let alone = "sphere Flesh 1, 10.5 0 0";
    let ball = surface(&scene(alone));
    let both = scene(&format!(
        "cylinder Flesh 1, <0 0 0>, <9 0 0>, ends flat\n{alone}"
    ));
    let both = surface(&both);
    for x in [9.2, 10.0, 10.5, 11.4, 13.0] {
        let [a, b] = [&both, &ball].map(|surface| value(surface, DVec3::X * x));
        assert!((a - b).abs() < 0.02, "{x}: {a} {b}");
    }
}

#[test]
fn free_ends_of_a_block_are_those_that_no_curve_goes_on_from() {
    let text = "skeleton Flesh, S { node A <-9 0 0> node B <0 0 0> node C <9 4 0> node D <9 -4 0> \
        node E <0 0 9> radius 0 curve A B C curve B D curve B E ends flat }";
    let scene = scene(text);
    let mut places: Vec<[f64; 3]> = scene
        .flat_ends(0)
        .iter()
        .map(|end| end.at.to_array())
        .collect();
    places.sort_by(|a, b| a.partial_cmp(b).unwrap());
    let curves = scene.elements[0].shape.curves().unwrap();
    assert_eq!(curves.flat, [0, 2, 3, 4]);
    // A tip is none that could be seen; what leads to it is there.
    places.retain(|place| place[2] == 0.0);
    assert_eq!(
        places,
        [[-9.0, 0.0, 0.0], [9.0, -4.0, 0.0], [9.0, 4.0, 0.0]]
    );
    assert!(value(&surface(&scene), DVec3::Z * 4.0) > THRESHOLD);
    // They move with their object.
    let moved = read(&format!("{text}\ntranslate 0 0 5 S\nscale 2 2 2 S"));
    let ends = moved.scene.flat_ends(0);
    let end = ends
        .iter()
        .find(|end| end.at.distance(DVec3::new(-18.0, 0.0, 10.0)) < 1e-9);
    assert_eq!(end.map(|end| end.radius), Some(2.0));
    assert_flat(&surface(&moved.scene), end.unwrap(), "moved");
    let local = read(&text.replace("ends flat", "ends flat local 4"));
    assert_eq!(local.scene.flat_ends(0), []);
    let mut told = local.diagnostics.iter();
    assert!(told.any(|told| told.message.contains("flat ends are round")));
}

#[test]
fn odd_limbs_end_somehow() {
    for limb in [
        "cylinder Flesh 1, <0 0 0>, <0.3 0 0>",
        "cone Flesh 1, <0 0 0>, 0, <9 0 0>",
        "cone Flesh 0, <0 0 0>, 1e-9, <9 0 0>",
        "arc Flesh 0.5, 1, <0 0 0>, <0 0 1>, 0 300",
        "arc Flesh 5, 1, <0 0 0>, <0 0 1>, 0 360",
        "arc Flesh 5, 1, <0 0 0>, <0 0 1>, 0 1e-9",
        "curve Flesh 1, <0 0 0> <0 0 0> <0 0 0> <1e-9 0 0>",
        "curve Flesh 1, <0 0 0> <9 0 0> <9 0 0> <0 0 0>",
        "cylinder Flesh 1e-300, <0 0 0>, <1e-299 0 0>",
        "cylinder Flesh 1e12, <0 0 0>, <1e12 0 0>",
        "line Flesh, <0 0 0>, <9 0 0>",
    ] {
        for ends in ["flat", "open"] {
            let compiled = read(&format!("{limb} ends {ends}"));
            for surface in compiled.scene.surfaces() {
                for place in [DVec3::ZERO, DVec3::ONE, DVec3::X] {
                    assert!(!surface.function().jet(place).value.is_infinite(), "{limb}");
                }
            }
        }
    }
    // A short one is cut at both planes, and a tip is none.
    let short = scene("cylinder Flesh 1, <0 0 0>, <0.5 0 0>, ends flat");
    for end in short.flat_ends(0) {
        assert_flat(&surface(&short), &end, "short");
    }
    let tip = scene("cone Flesh 1, <0 0 0>, 0, <9 0 0> ends flat");
    assert_eq!(tip.flat_ends(0).len(), 1);
}

#[test]
fn hard_or_too_many_limbs_are_told() {
    let hard = read("cylinder Clay 1, <0 0 0>, <9 0 0> ends flat");
    assert_eq!(hard.scene.flat_ends(0), []);
    let mut told = hard.diagnostics.iter();
    assert!(told.any(|told| told.message.contains("`ends` is for soft limbs")));
    let mut skeletons = String::new();
    for i in 0..200 {
        skeletons += &format!(
            "skeleton Flesh, S{i} {{ node A <{i} 0 0> node B <{i} 3 0> curve A B ends flat }}\n"
        );
    }
    for text in [
        "for i = 1 to 300 { cylinder Flesh 0.2, <i 0 0>, <i 3 0>, ends flat }",
        &skeletons,
    ] {
        let many = read(text);
        let mut told = many.diagnostics.iter();
        assert!(told.any(|told| told.message.contains("more than 256 flat ends")));
        assert!(many.scene.flat_ends(0).len() <= 512);
    }
}

#[test]
fn lines_that_close_have_no_ends() {
    for closed in [
        "arc Flesh 5, 1, <0 0 0>, <0 0 1>, 0 360",
        "arc Flesh 5, 1, <0 3 0>, <0 1 1>, 30 360",
        "curve Flesh 1, <0 0 0> <9 0 0> <9 9 0> <0 0 0>",
        "curve Flesh 1, <0 0 0> <9 0 0> <9 3 0> <9 9 0> <5 9 0> <0 9 0> <0 0 0>",
        "skeleton Flesh, S { node A <-9 0 0> node B <0 9 0> node C <9 0 0> curve A B C A",
    ] {
        let flat = scene(&with_ends(closed, "flat"));
        assert_eq!(flat.flat_ends(0), [], "{closed}");
        let round = surface(&scene(&with_ends(closed, "round")));
        for place in [DVec3::X * 5.0, DVec3::ONE, DVec3::new(3.0, 4.0, 0.5)] {
            assert_eq!(value(&surface(&flat), place), value(&round, place));
        }
    }
    let most = scene("arc Flesh 5, 1, <0 0 0>, <0 0 1>, 0 359 ends flat");
    assert_eq!(most.flat_ends(0).len(), 2);
}
