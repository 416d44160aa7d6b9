//! Cutting, taking away and inserting, and texts as people write them.

use glam::DVec3;
use rats::{Project, compile};
use scene::{Form, Shape};
use skeleton::{Node, Skeleton};
use sketch::{
    Block, Limb, Start, create, cut, extend, free_name, insert, remove, remove_curve, widen,
    without_commands,
};
use std::ops::Range;

/// The skeletons of a text, each with its command's place.
fn skeletons(text: &str) -> Vec<(Range<usize>, Skeleton)> {
    let compiled = compile(&Project::single(text));
    let errors = compiled
        .diagnostics
        .iter()
        .filter(|d| d.severity == rats::Severity::Error);
    let errors: Vec<_> = errors.map(|d| &d.message).collect();
    assert!(errors.is_empty(), "{errors:?}\n{text}");
    let elements = compiled.scene.elements.iter();
    let skeleton = |element: &scene::Element| {
        let span = element.origin.start as usize..element.origin.end as usize;
        match &element.shape {
            Shape::Function(function) => match &function.form {
                Form::Skeleton(curves) => Some((span, curves.skeleton.clone())),
                _ => None,
            },
            _ => None,
        }
    };
    elements.filter_map(skeleton).collect()
}

fn node(x: f64, y: f64, z: f64, radius: f64) -> Node {
    Node {
        position: DVec3::new(x, y, z),
        radius,
    }
}

/// Texts with a body of three nodes and two limbs, written in many ways; the skeleton of the given
/// number is the animal.
const WAYS: [(&str, usize); 7] = [
    (
        "surface a, radius 1\nskeleton a, s {\n  node A <0 0 0>\n  node B <2 0 0>\n  \
         node C <5 0 0>\n  node D <2 -2 0>\n  node E <5 -2 0>\n  curve A B C\n  curve B D\n  \
         curve C E\n}\n",
        0,
    ),
    // Remarks, also with words of the block, and all on few lines.
    (
        "surface a, radius 1\nskeleton a, s { # node X } curve\n  # curve A D\n  \
         node A <0 0 0> node B <2 0 0> # the middle\n  node C <5 0 0>, node D <2 -2 0>\n  \
         node E <5 -2 0> curve A B C # the body }\n  curve B D curve C E }\n",
        0,
    ),
    // Words in any case, options, expressions, a variable of the text.
    (
        "surface a, radius 1\nvar r = 0.5 hot\nSkeleton a, s subdivide 2 scheme chaikin {\n  \
         NODE A <0, 0, 0> RADIUS 2*r\n  node B <4*r 0 0> radius r\n  node C <5 0 0>\n  \
         node D <2 -2 0> radius (r)\n  node E <5 -2 0>\n  Curve A, B, C\n  curve B D\n  curve C E\n\
         }\n",
        0,
    ),
    // A defined command and an object with skeletons of their own, before and behind.
    (
        "surface a, radius 1\ndefine limb x {\n  \
         skeleton a, part { node A <x 0 0> node B <x 1 0> curve A B }\n}\nlimb 9\n\
         skeleton a, s {\n  node A <0 0 0>\n  node B <2 0 0>\n  node C <5 0 0>\n  \
         node D <2 -2 0>\n  node E <5 -2 0>\n  curve A B C\n  curve B D\n  curve C E\n}\n\
         object group\n  skeleton a, t { node A <0 9 0> node B <2 9 0> curve A B }\nclose\n",
        1,
    ),
    // A node whose name begins as the word does.
    (
        "surface a, radius 1\nskeleton a, s {\n  node nodes <0 0 0>\n  node B <2 0 0>\n  \
         node C <5 0 0>\n  node D <2 -2 0>\n  node E <5 -2 0>\n  curve nodes B C\n  curve B D\n  \
         curve C E\n}\n",
        0,
    ),
    // Letters of several bytes.
    (
        "surface a, radius 1 # größer\nskeleton a, s {\n  node Ä <0 0 0>\n  node ß <2 0 0> # ä\n  \
         node é <5 0 0>\n  node D <2 -2 0>\n  node E <5 -2 0>\n  curve Ä ß é\n  curve ß D\n  \
         curve é E\n}",
        0,
    ),
    // Another one before it.
    (
        "surface a, radius 1\nskeleton a, t { node A <0 9 0> node B <2 9 0> curve A B }\n\
         skeleton a, s {\n  node A <0 0 0>\n  node B <2 0 0>\n  node C <5 0 0>\n  \
         node D <2 -2 0>\n  node E <5 -2 0>\n  curve A B C\n  curve B D\n  curve C E\n}\n\
         rotate 0 1 0 90, s\n",
        1,
    ),
];

/// The ways of writing, with both kinds of line ends.
fn ways() -> Vec<(String, usize)> {
    let ways = WAYS.iter().flat_map(|&(text, which)| {
        [text.to_owned(), text.replace('\n', "\r\n")].map(|text| (text, which))
    });
    ways.collect()
}

/// The text before and after a command.
fn around(text: &str, span: &Range<usize>) -> (String, String) {
    (text[..span.start].to_owned(), text[span.end..].to_owned())
}

/// Checks that a change keeps the text around the command and the kind of line ends. Returns the
/// changed skeleton.
fn check_change(before: &str, which: usize, after: &str) -> Skeleton {
    let (span, _) = skeletons(before)[which].clone();
    let (head, tail) = around(before, &span);
    assert!(
        after.starts_with(&head) && after.ends_with(&tail),
        "{after}"
    );
    let bare = after.replace("\r\n", "");
    assert!(!bare.contains('\r'), "{after:?}");
    if before.contains("\r\n") {
        assert!(!bare.contains('\n'), "{after:?}");
    }
    skeletons(after)[which].1.clone()
}

#[test]
fn each_way_of_writing_is_read_as_the_compiler_reads_it() {
    for (text, which) in ways() {
        let (span, skeleton) = &skeletons(&text)[which];
        let block = Block::read(&text, span.clone()).unwrap();
        assert_eq!(block.nodes.len(), skeleton.nodes.len());
        for (names, along) in block.curves.iter().zip(&skeleton.curves) {
            let names: Vec<_> = names
                .names
                .iter()
                .map(|(name, _)| block.node(name))
                .collect();
            let along: Vec<_> = along.iter().map(|node| Some(*node)).collect();
            assert_eq!(names, along);
        }
    }
}

#[test]
fn what_is_beyond_a_cut_falls_off() {
    for (text, which) in ways() {
        let (span, skeleton) = skeletons(&text)[which].clone();
        // Through the body between B and C: C, E and the limb between them are the shorter side? B,
        // A, D are 4 long, C, E are 2.
        let end = node(3.0, 0.0, 0.0, 0.25);
        let cut_text = cut(&text, span.clone(), &skeleton, 0, 1, &end, 0.01).unwrap();
        let left = check_change(&text, which, &cut_text);
        assert_eq!(left.curves.len(), 2, "{cut_text}");
        assert_eq!(left.nodes.len(), 4);
        let last = left.nodes[left.curves[0][2]];
        assert_eq!((last.position, last.radius), (end.position, end.radius));
        assert_eq!(left.curves[0].len(), 3);
        // Through the second limb, half way: a stump is left.
        let end = node(2.0, -1.0, 0.0, 0.25);
        let cut_text = cut(&text, span.clone(), &skeleton, 1, 0, &end, 0.01).unwrap();
        let left = check_change(&text, which, &cut_text);
        assert_eq!((left.curves.len(), left.nodes.len()), (3, 5));
        assert_eq!(left.nodes[left.curves[1][1]].position, end.position);
        // At its root: nothing of it is left.
        let end = node(2.0, -0.2, 0.0, 0.25);
        let cut_text = cut(&text, span.clone(), &skeleton, 1, 0, &end, 0.01).unwrap();
        let left = check_change(&text, which, &cut_text);
        assert_eq!((left.curves.len(), left.nodes.len()), (2, 4), "{cut_text}");
        // The beginning falls off where it is shorter.
        let end = node(0.5, 0.0, 0.0, 0.25);
        let cut_text = cut(&text, span.clone(), &skeleton, 0, 0, &end, 0.01).unwrap();
        let left = check_change(&text, which, &cut_text);
        assert_eq!((left.curves.len(), left.nodes.len()), (3, 5));
        assert_eq!(left.nodes[left.curves[0][0]].position, end.position);
        assert_eq!(cut(&text, span.clone(), &skeleton, 0, 2, &end, 0.01), None);
        assert_eq!(cut(&text, span.clone(), &skeleton, 9, 0, &end, 0.01), None);
        // A skeleton of another text.
        let other = Skeleton::default();
        assert_eq!(cut(&text, span, &other, 0, 0, &end, 0.01), None);
    }
}

#[test]
fn a_ring_is_opened_by_a_cut_and_the_last_curve_takes_the_command_along() {
    let text = "surface a, radius 1\nskeleton a, s {\n  node A <0 0 0>\n  node B <2 0 0>\n  \
        node C <2 2 0>\n  curve A B C A\n}\n";
    let (span, skeleton) = skeletons(text)[0].clone();
    let end = node(2.0, 1.0, 0.0, 0.1);
    let opened = cut(text, span.clone(), &skeleton, 0, 1, &end, 0.01).unwrap();
    let left = check_change(text, 0, &opened);
    assert_eq!(left.curves, [vec![0, 1], vec![2, 0]]);
    let (span, skeleton) = skeletons(&opened)[0].clone();
    let opened = cut(
        &opened,
        span,
        &skeleton,
        0,
        0,
        &node(0.2, 0.0, 0.0, 0.5),
        0.01,
    )
    .unwrap();
    let left = skeletons(&opened)[0].1.clone();
    assert_eq!(left.curves.len(), 1);
    let (span, _) = skeletons(&opened)[0].clone();
    let nothing = remove_curve(&opened, span, 0).unwrap();
    assert_eq!(nothing, "surface a, radius 1\n");
}

#[test]
fn curves_and_nodes_are_taken_away_and_come() {
    for (text, which) in ways() {
        let (span, skeleton) = skeletons(&text)[which].clone();
        let less = remove_curve(&text, span.clone(), 1).unwrap();
        let left = check_change(&text, which, &less);
        assert_eq!((left.curves.len(), left.nodes.len()), (2, 4), "{less}");
        assert_eq!(remove_curve(&text, span.clone(), 3), None);
        let less = remove(&text, span.clone(), 1).unwrap();
        let left = check_change(&text, which, &less);
        assert_eq!((left.curves.len(), left.nodes.len()), (2, 3), "{less}");
        let new = node(3.5, 0.5, 0.0, 0.25);
        let more = insert(&text, span.clone(), 0, 1, &new, 0.01).unwrap();
        let left = check_change(&text, which, &more);
        assert_eq!(left.nodes.len(), 6);
        assert_eq!(left.nodes[5], new);
        assert_eq!(left.curves[0], [0, 1, 5, 2]);
        assert_eq!(insert(&text, span.clone(), 0, 2, &new, 0.01), None);
        let wide = widen(&text, span.clone(), 3, 0.127, 0.01).unwrap();
        assert_eq!(check_change(&text, which, &wide).nodes[3].radius, 0.13);
        let limb = |start| Limb {
            start,
            nodes: vec![node(0.0, 4.0, 1.0, 0.3), node(0.0, 5.0, 1.0, 0.2)],
        };
        let between = |share| Start::Between {
            curve: 0,
            span: 0,
            share,
            node: node(2.0 * share, 0.0, 0.0, 0.4),
        };
        // Two branches from one piece stand in their order, however they come.
        let limbs = [
            limb(between(0.75)),
            limb(between(0.25)),
            limb(Start::End(3)),
        ];
        let more = extend(&text, span, &limbs, 0.01).unwrap();
        let left = check_change(&text, which, &more);
        let body: Vec<f64> = left.curves[0]
            .iter()
            .map(|i| left.nodes[*i].position.x)
            .collect();
        assert_eq!(body, [0.0, 0.5, 1.5, 2.0, 5.0], "{more}");
        assert_eq!((left.curves.len(), left.nodes.len()), (5, 13), "{more}");
        assert_eq!(left.curves[1].len(), 4);
        assert_eq!(skeleton.nodes.len(), 5);
    }
}

#[test]
fn texts_with_mistakes_are_left_or_changed_but_never_lost() {
    // Texts without the block of a skeleton are not changed, and nothing panics.
    for text in [
        "skeleton",
        "skeleton a, s {",
        "skeleton a, s }",
        "skeleton a, s { node }",
        "skeleton a, s { curve }",
        "skeleton a, s { curve curve curve }",
        "skeleton a, s { node A <0 0 curve A A A }",
        "skeleton a, s { node A radius node A radius radius curve A B C }",
        "skeleton ä, ö { node ü <1 2 3> curve ü ü }",
        "\r\n",
        "",
    ] {
        let skeleton = Skeleton {
            nodes: vec![node(0.0, 0.0, 0.0, 1.0)],
            curves: vec![vec![0, 0]],
        };
        for end in 0..=text.len() {
            let span = 0..end;
            let new = node(f64::NAN, 1e300, -1e-300, f64::INFINITY);
            for index in 0..3 {
                let _ = remove(text, span.clone(), index);
                let _ = remove_curve(text, span.clone(), index);
                let _ = insert(text, span.clone(), index, 0, &new, f64::NAN);
                let _ = widen(text, span.clone(), index, f64::NAN, 0.0);
                let _ = cut(text, span.clone(), &skeleton, index, 0, &new, 0.1);
                let limb = Limb {
                    start: Start::Node(index),
                    nodes: vec![new; 2],
                };
                let _ = extend(text, span.clone(), &[limb], 0.1);
            }
            let _ = without_commands(text, &[span]);
        }
    }
    assert_eq!(without_commands("ä", std::slice::from_ref(&(0..1))), None);
    assert_eq!(
        without_commands("a\r\nb # c\r\nd", std::slice::from_ref(&(3..4))).unwrap(),
        "a\r\nd"
    );
}

#[test]
fn new_names_are_new() {
    let texts = ["surface Skin, radius 1", "var skin2 = 1 # Skin4"];
    assert_eq!(free_name(texts, "Skin"), "Skin3");
    assert_eq!(free_name(texts, "Bead"), "Bead");
    let limb = Limb {
        start: Start::Free,
        nodes: vec![node(0.0, 0.0, 0.0, 0.1), node(1.0, 0.0, 0.0, 0.1)],
    };
    let text = create("surface a\r\n", "a", "s", &[limb], 0.01).unwrap();
    assert!(!text.replace("\r\n", "").contains('\n'), "{text:?}");
    assert_eq!(skeletons(&text)[0].1.nodes.len(), 2);
}
