//! The examples that the page shows must compile without a word of complaint.

use field::Skeleton;
use rats::{Compiled, File, HotValue, Project, Severity, compile};
use scene::{Scene, Shape};

fn example(name: &str) -> (String, Compiled) {
    let path = format!(
        "{}/../../www/examples/{name}.rat",
        env!("CARGO_MANIFEST_DIR")
    );
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{path}: {e}"));
    let project = Project {
        files: vec![File {
            name: format!("{name}.rat"),
            text: text.clone(),
        }],
    };
    (text, compile(&project))
}

/// Returns the noun for a shape of a bone.
fn noun(shape: &Shape) -> &'static str {
    shape.bone().map_or("", scene::Bone::name)
}

fn count(scene: &Scene, is: fn(&Shape) -> bool) -> usize {
    scene.elements.iter().filter(|e| is(&e.shape)).count()
}

#[test]
fn no_complaints() {
    for name in EXAMPLES {
        let (_, compiled) = example(name);
        let complaint = compiled
            .diagnostics
            .iter()
            .find(|d| d.severity > Severity::Note);
        if *name == "coating" {
            // It shows what this warning is about.
            let warning = complaint.map(|d| d.message.as_str());
            assert!(warning.is_some_and(|m| m.contains("coats")), "{warning:?}");
        } else {
            assert_eq!(complaint, None, "{name}");
        }
        assert!(!compiled.scene.elements.is_empty(), "{name}");
        assert!(!compiled.hot.is_empty(), "{name} has nothing to drag");
        for hot in &compiled.hot {
            assert!(hot.literal.is_some(), "{name}: {hot:?}");
        }
    }
}

/// Examples that are read as absolute, and no others, would be asked how their blobbiness is
/// meant, and the change that the message proposes makes of them what they are.
#[test]
fn radii_that_go_with_blobbiness_are_asked_about() {
    let mut asked = Vec::new();
    for name in EXAMPLES {
        let (text, compiled) = example(name);
        let lines = text.lines().filter(|line| !line.starts_with("blobscale"));
        let bare: String = lines.map(|line| format!("{line}\n")).collect();
        let project = Project::single(bare);
        let again = compile(&project);
        let Some(found) = again.diagnostics.iter().find(|d| d.fix.is_some()) else {
            continue;
        };
        asked.push(*name);
        assert!(
            found.message.contains("absolute"),
            "{name}: {}",
            found.message
        );
        let mended = compile(&project.apply(found.fix.as_slice()));
        assert!(mended.scene.is_same_but_written(&compiled.scene), "{name}");
        assert!(mended.diagnostics.iter().all(|d| d.fix.is_none()), "{name}");
        let kept = compile(&Project::single(format!("{text}blobscale relative\n")));
        assert!(kept.diagnostics.iter().all(|d| d.fix.is_none()), "{name}");
    }
    assert_eq!(asked, ["cowrie", "seahorse"]);
}

#[test]
fn moving_a_slider_changes_one_value() {
    for name in EXAMPLES {
        let (text, compiled) = example(name);
        for hot in &compiled.hot {
            let HotValue::Scalar(value) = hot.value else {
                continue;
            };
            // In quarters, which need no rounding when they are written.
            let moved = HotValue::Scalar((value * 4.0).round() / 4.0 + 1.25);
            let range = hot.literal.clone().expect("a literal");
            let project = Project {
                files: vec![File {
                    name: String::from("moved.rat"),
                    text: rats::hot::set(&text, range, &moved),
                }],
            };
            let again = compile(&project);
            let found = again.hot.iter().find(|h| h.name == hot.name);
            assert_eq!(found.map(|h| &h.value), Some(&moved), "{name}");
        }
    }
}

#[test]
fn cowrie() {
    let (_, compiled) = example("cowrie");
    let scene = compiled.scene;
    assert_eq!(count(&scene, |s| noun(s) == "arc"), 3);
    assert_eq!(count(&scene, |s| noun(s) == "cylinder"), 100);
    assert_eq!(scene.finishes.len(), 4);
    assert!(scene.elements.iter().all(|e| scene.is_soft(e)));
    assert_eq!(scene.settings.frame, [640, 480]);
    // Every spike begins on the circle of the body, which the rotation has taken along.
    let Some(&Skeleton::Arc {
        center,
        radius: sweep,
        ..
    }) = scene.elements[0].shape.skeleton()
    else {
        panic!("the body comes first");
    };
    for element in &scene.elements[3..] {
        let Some(&Skeleton::Segment { base, apex }) = element.shape.skeleton() else {
            panic!("spikes come after");
        };
        assert!((base.distance(center) - sweep).abs() < 1e-12);
        assert!(base.distance(apex) <= 0.75 + 1e-12);
    }
}

#[test]
fn seahorse() {
    let (_, compiled) = example("seahorse");
    let scene = compiled.scene;
    assert_eq!(count(&scene, |s| noun(s) == "arc"), 40);
    assert_eq!(count(&scene, |s| noun(s) == "sphere"), 3);
    let hard = scene.elements.iter().filter(|e| !scene.is_soft(e)).count();
    assert_eq!(hard, 2);
    let profiles = scene
        .elements
        .iter()
        .filter_map(|e| scene.flesh[e.flesh? as usize].profile)
        .count();
    assert_eq!(profiles, 5);
}

#[test]
fn icicle() {
    let scene = example("icicle").1.scene;
    assert_eq!(count(&scene, |s| noun(s) == "cylinder"), 3);
    assert_eq!(count(&scene, |s| noun(s) == "sphere"), 1);
    for element in &scene.elements {
        assert!(scene.is_soft(element));
        assert_eq!(scene.radius(element), 0.25);
        assert_eq!(
            scene.flesh[element.flesh.expect("soft") as usize].blobbiness,
            Some(0.3)
        );
    }
}

#[test]
fn tshape() {
    let scene = example("tshape").1.scene;
    assert_eq!(count(&scene, |s| noun(s) == "cylinder"), 2);
}

#[test]
fn starfish() {
    let scene = example("starfish").1.scene;
    assert_eq!(scene.elements.len(), 7);
    assert_eq!(count(&scene, |s| noun(s) == "arc"), 7);
}

#[test]
fn sphereflake() {
    let (text, compiled) = example("sphereflake");
    assert_eq!(compiled.scene.elements.len(), 91);
    // The last of the database's second level.
    let wanted = glam::DVec3::new(0.471_404_520_791_031_35, -0.471_404_520_791_031_35, 0.0);
    let is_there = compiled.scene.elements.iter().any(|element| {
        let (center, radius) = (element.shape.middle(), element.shape.radius());
        center.distance(wanted) < 1e-12 && (radius - 1.0 / 6.0).abs() < 1e-12
    });
    assert!(is_there);
    for (depth, balls) in [(0.0, 10), (1.0, 10), (3.0, 820), (9.0, 820)] {
        let range = compiled.hot[0].literal.clone().expect("a literal");
        let text = rats::hot::set(&text, range, &HotValue::Scalar(depth));
        let again = compile(&Project {
            files: vec![File {
                name: String::from("sphereflake.rat"),
                text,
            }],
        });
        assert_eq!(again.scene.elements.len(), balls);
        assert!(again.diagnostics.is_empty());
    }
}

#[test]
fn the_thesis_s_models_have_its_numbers_of_elements() {
    // Points, lines, arcs and curves, triangles; hard ones among them.
    let wanted = [
        ("starfish-a", [0, 0, 7, 0], 7),
        ("starfish-b", [0, 0, 7, 0], 0),
        ("shell-1", [361, 0, 0, 0], 0),
        ("shell-2", [0, 42, 0, 0], 0),
        ("shell-3", [0, 55 + 15, 0, 0], 0),
        ("seaweed", [0, 31, 0, 0], 0),
        ("coral-crab", [2, 28 + 608, 26, 7], 2),
        ("spinal-starecase", [38 + 107, 333, 0, 0], 107),
    ];
    for (name, numbers, hard) in wanted {
        let scene = example(name).1.scene;
        let found = [
            count(&scene, |s| noun(s) == "sphere"),
            count(&scene, |s| ["cylinder", "pipe"].contains(&noun(s))),
            count(&scene, |s| ["arc", "curve"].contains(&noun(s))),
            count(&scene, |s| noun(s) == "triangle"),
        ];
        assert_eq!(found, numbers, "{name}");
        let found = scene.elements.iter().filter(|e| !scene.is_soft(e)).count();
        assert_eq!(found, hard, "{name}");
    }
    assert_eq!(example("hermite-crab").1.scene.elements.len(), 988);
    // 31 branches; the spikes are shared out among them in whole numbers.
    assert_eq!(example("coral-tree").1.scene.elements.len(), 31 + 508);
}

const EXAMPLES: &[&str] = &[
    "agate-shell",
    "blends",
    "coating",
    "coils",
    "coral-crab",
    "coral-tree",
    "cowrie",
    "diamond",
    "drops",
    "falling",
    "fawn",
    "fireflies",
    "flakes",
    "floppy-ears",
    "fog-stones",
    "folds",
    "generators",
    "glass-drops",
    "grasp",
    "hermite-crab",
    "icicle",
    "jelly",
    "octopus",
    "pebbles",
    "planets",
    "sea-urchin",
    "seahorse",
    "seaweed",
    "shell-1",
    "shell-2",
    "shell-3",
    "snail",
    "sphereflake",
    "spinal-starecase",
    "squeeze",
    "starfish",
    "starfish-a",
    "starfish-b",
    "starfish-c",
    "starfish-d",
    "starfish-e",
    "starfish-f",
    "stem-flakes",
    "still-life",
    "tide",
    "time-map",
    "touching",
    "tshape",
    "urchin-patterns",
    "wrinkles",
];
