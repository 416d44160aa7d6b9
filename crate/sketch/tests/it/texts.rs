//! Changes of texts.

use glam::DVec3;
use skeleton::Node;
use sketch::{Block, Limb, Start, create, extend, remove, widen};

fn node(x: f64, y: f64) -> Node {
    Node {
        position: DVec3::new(x, y, -0.0),
        radius: 0.25,
    }
}

const TEXT: &str = "\
surface clay, radius 1
# an animal
skeleton clay, animal subdivide 2 {
    node head <0 0 0> radius 2 * r   # round
    node neck <1 0 0>
    node tail <3 0 0> radius 0.5
    curve head neck tail
    node foot <1 -1 0>  curve neck foot
}
rotate animal 0 90 0
";

fn span() -> std::ops::Range<usize> {
    let start = TEXT.find("skeleton").unwrap();
    start..TEXT.find("}\n").unwrap() + 1
}

fn extend_text(limbs: &[Limb]) -> String {
    let text = extend(TEXT, span(), limbs, 0.01).unwrap();
    // What was there stays there.
    assert!(text.starts_with(&TEXT[..span().start]) && text.ends_with("rotate animal 0 90 0\n"));
    text
}

#[test]
fn a_block_is_read() {
    let block = Block::read(TEXT, span()).unwrap();
    let names: Vec<&str> = block.nodes.iter().map(|node| node.name.as_str()).collect();
    assert_eq!(names, ["head", "neck", "tail", "foot"]);
    assert_eq!(&TEXT[block.nodes[0].radius.clone().unwrap()], "2 * r");
    assert_eq!(block.nodes[1].radius, None);
    assert_eq!(&TEXT[block.nodes[1].span.clone()], "node neck <1 0 0>");
    assert_eq!(&TEXT[block.curves[1].span.clone()], "curve neck foot");
    assert_eq!(&TEXT[block.close..], "}\nrotate animal 0 90 0\n");
    let text = "skeleton a, b { node nodes <0 0 0> node b <1 0 0> curve nodes b }";
    let block = Block::read(text, 0..text.len()).unwrap();
    assert_eq!((block.nodes.len(), block.curves.len()), (2, 1));
    assert_eq!(block.curves[0].names[0].0, "nodes");
    for bad in [
        "",
        "sphere a 1, 0 0 0",
        "skeleton",
        "skeleton a, b } {",
        "skeleton { node }",
    ] {
        assert_eq!(Block::read(bad, 0..bad.len()), None, "{bad}");
    }
    assert_eq!(Block::read("ä", 1..2), None);
}

#[test]
fn a_limb_goes_on_or_branches() {
    let limb = |start| Limb {
        start,
        nodes: vec![node(4.0, 0.5), node(5.126, 0.0)],
    };
    let lines = "    node n5 <4 0.5 0> radius 0.25\n    node n6 <5.13 0 0> radius 0.25\n";
    let text = extend_text(&[limb(Start::End(2))]);
    assert!(text.contains("curve head neck tail n5 n6\n"), "{text}");
    assert!(
        text.contains(&format!("curve neck foot\n{lines}}}")),
        "{text}"
    );
    let text = extend_text(&[limb(Start::End(0))]);
    assert!(text.contains("curve n6 n5 head neck tail\n"), "{text}");
    // Or branches there, at a corner.
    let text = extend_text(&[limb(Start::Node(2))]);
    assert!(
        text.contains(&format!("{lines}    curve tail n5 n6\n}}")),
        "{text}"
    );
    let text = extend_text(&[limb(Start::Node(1))]);
    assert!(
        text.contains(&format!("{lines}    curve neck n5 n6\n}}")),
        "{text}"
    );
    let text = extend_text(&[limb(Start::Free)]);
    assert!(
        text.contains(&format!("{lines}    curve n5 n6\n}}")),
        "{text}"
    );
    let middle = Start::Between {
        curve: 0,
        span: 1,
        share: 0.5,
        node: node(2.0, 0.0),
    };
    let text = extend_text(&[limb(middle), limb(Start::Same)]);
    assert!(text.contains("curve head neck n5 tail\n"), "{text}");
    assert!(text.contains("    node n5 <2 0 0> radius 0.25\n"), "{text}");
    assert!(text.contains("    curve n5 n6 n7\n"), "{text}");
    assert!(text.contains("    curve n5 n8 n9\n}"), "{text}");
    // Both sides of an end: one goes on, the other branches.
    let text = extend_text(&[limb(Start::End(3)), limb(Start::Same)]);
    assert!(text.contains("curve neck foot n5 n6\n"), "{text}");
    assert!(text.contains("    curve foot n7 n8\n}"), "{text}");
    let nowhere = extend(TEXT, span(), &[limb(Start::Node(9))], 0.01);
    assert_eq!(nowhere, None);
}

#[test]
fn nodes_go_with_what_hangs_on_them() {
    let text = remove(TEXT, span(), 0).unwrap();
    assert!(
        !text.contains("head") && text.contains("    curve neck tail\n"),
        "{text}"
    );
    let text = remove(TEXT, span(), 3).unwrap();
    assert!(
        !text.contains("foot") && !text.contains("curve neck f"),
        "{text}"
    );
    assert!(text.contains("curve head neck tail\n}"), "{text}");
    let text = remove(TEXT, span(), 1).unwrap();
    assert!(
        text.contains("curve head tail\n") && !text.contains("foot"),
        "{text}"
    );
    let first = remove(TEXT, span(), 0).unwrap();
    let start = first.find("skeleton").unwrap();
    let second = remove(&first, start..first.find("}\n").unwrap() + 1, 1).unwrap();
    let end = second.find("}\n").unwrap() + 1;
    let third = remove(&second, start..end, 0).unwrap();
    assert_eq!(
        third,
        "surface clay, radius 1\n# an animal\nrotate animal 0 90 0\n"
    );
    assert_eq!(remove(TEXT, span(), 4), None);
}

#[test]
fn radii_are_rewritten() {
    let text = widen(TEXT, span(), 0, 0.123456, 0.01).unwrap();
    assert!(
        text.contains("node head <0 0 0> radius 0.12   # round"),
        "{text}"
    );
    let text = widen(TEXT, span(), 1, 3.0, 0.01).unwrap();
    assert!(text.contains("node neck <1 0 0> radius 3\n"), "{text}");
    let text = widen(TEXT, span(), 3, -1.0, 0.01).unwrap();
    assert!(
        text.contains("node foot <1 -1 0> radius 0  curve"),
        "{text}"
    );
}

#[test]
fn a_new_skeleton_stands_at_the_end() {
    let limb = Limb {
        start: Start::Free,
        nodes: vec![node(0.0, 0.0), node(1234.5, 1e-3)],
    };
    let text = create("surface a, radius 1", "a", "s", &[limb], 20.0).unwrap();
    let expected = "surface a, radius 1\n\nskeleton a, s {\n  node n1 <0 0 0> radius 0\n  \
        node n2 <1234 0 0> radius 0\n  curve n1 n2\n}\n";
    assert_eq!(text, expected);
    let short = Limb {
        start: Start::Free,
        nodes: vec![node(0.0, 0.0)],
    };
    assert_eq!(create("", "a", "s", &[short], 0.1), None);
    assert_eq!(create("", "a", "s", &[], 0.1), None);
}
