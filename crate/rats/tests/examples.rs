//! The examples that the page shows must compile without a word of complaint.

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

fn count(scene: &Scene, is: fn(&Shape) -> bool) -> usize {
    scene.elements.iter().filter(|e| is(&e.shape)).count()
}

#[test]
fn no_complaints() {
    for name in EXAMPLES {
        let (_, compiled) = example(name);
        for d in &compiled.diagnostics {
            assert!(d.severity == Severity::Note, "{name}: {d:?}");
        }
        assert!(!compiled.scene.elements.is_empty(), "{name}");
        assert!(!compiled.hot.is_empty(), "{name} has nothing to drag");
        for hot in &compiled.hot {
            assert!(hot.literal.is_some(), "{name}: {hot:?}");
        }
    }
}

#[test]
fn moving_a_slider_changes_one_value() {
    for name in EXAMPLES {
        let (text, compiled) = example(name);
        for hot in &compiled.hot {
            let HotValue::Scalar(value) = hot.value else {
                continue;
            };
            let moved = HotValue::Scalar(value + 1.0);
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
    assert_eq!(count(&scene, |s| matches!(s, Shape::Arc { .. })), 3);
    assert_eq!(count(&scene, |s| matches!(s, Shape::Cylinder { .. })), 100);
    assert_eq!(scene.materials.len(), 4);
    assert!(scene.elements.iter().all(|e| scene.is_soft(e)));
    assert_eq!(scene.settings.frame, [640, 480]);
    // Every spike begins on the circle of the body, which the rotation has taken along.
    let Shape::Arc { center, sweep, .. } = scene.elements[0].shape else {
        panic!("the body comes first");
    };
    for element in &scene.elements[3..] {
        let Shape::Cylinder { base, apex, .. } = element.shape else {
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
    assert_eq!(count(&scene, |s| matches!(s, Shape::Arc { .. })), 40);
    assert_eq!(count(&scene, |s| matches!(s, Shape::Sphere { .. })), 3);
    let hard = scene.elements.iter().filter(|e| !scene.is_soft(e)).count();
    assert_eq!(hard, 2);
    let profiles = scene
        .elements
        .iter()
        .filter(|e| scene.materials[e.material].profile.is_some())
        .count();
    assert_eq!(profiles, 5);
}

const EXAMPLES: &[&str] = &["cowrie", "seahorse"];
