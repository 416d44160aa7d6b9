//! SWC: conventions, order, and what is told of bad lines.

use crate::common::{graph, message, remarks};
use glam::DVec3;
use limbs::Cap;
use trials::{Random, count};

/// A ball of a soma, a trunk of which branches in two, and an axon.
const NEURON: &str = "# soma, dendrite, axon\r\n\t7 3 -3 25.5 0 .7 4\n\n9\t1 1e0 0 0 6 -1 \n\
                      4 3 1 21 0 1.25 2 # fork\n2 3 1 9 0 1.75 9\n8 3 7 33 0 0.8 4\n\
                      11 2 1 -9 0 1.0 9\n12 2 1 -31 0 0.5 11\n";

#[test]
fn conventions_of_the_format_hold() {
    let graph = graph("a.SWC", NEURON);
    assert!(graph.remarks.is_empty(), "{:?}", graph.remarks);
    assert_eq!((graph.nodes.len(), graph.limbs.len()), (7, 6));
    let facts = graph.facts();
    assert_eq!((facts.components, facts.cycles, facts.free_ends), (1, 0, 3));
    let balls: Vec<_> = graph.nodes.iter().filter(|node| node.is_ball).collect();
    assert_eq!(balls.len(), 1);
    assert_eq!((balls[0].position, balls[0].radius), (DVec3::X, 6.0));
    let names: Vec<&str> = graph.groups.iter().map(|group| &group.name[..]).collect();
    for limb in &graph.limbs {
        let [a, b] = limb.ends.map(|end| graph.nodes[end as usize]);
        if a.is_ball {
            assert_eq!(limb.radii, [b.radius; 2]);
            assert!(matches!(names[limb.group as usize], "dendrite" | "axon"));
        } else {
            assert_eq!(limb.radii, [a.radius, b.radius]);
        }
    }
    assert_eq!(graph.millimetres, Some(0.001));
}

#[test]
fn a_soma_of_three_nodes_is_a_cylinder() {
    let text = "1 1 2 3 4 5 -1\n2 1 2 -2 4 5 1\n3 1 2 8 4 5 1\n4 3 9 3 4 1 1\n";
    let graph = graph("a.swc", text);
    assert!(graph.nodes.iter().all(|node| !node.is_ball));
    let soma: Vec<_> = graph.limbs.iter().filter(|l| l.radii == [5.0; 2]).collect();
    assert_eq!(soma.len(), 2);
    assert!(soma.iter().all(|limb| limb.caps == [Cap::Round, Cap::Flat]));
    // Its side's area is that of the ball of the same radius.
    let length: f64 = (0..2).map(|limb| graph.length(limb)).sum();
    let [side, ball] = [2.0 * 5.0 * length, 4.0 * 5.0 * 5.0];
    assert!((side - ball).abs() < 1e-12);
    // A soma of three nodes in a row is none of the standard's.
    let text = text.replace("3 1 2 8 4 5 1", "3 1 2 8 4 5 2");
    let graph = crate::common::graph("a.swc", text);
    assert!(graph.limbs.iter().all(|limb| limb.caps == [Cap::Round; 2]));
}

#[test]
fn order_of_lines_does_not_matter() {
    let mut random = Random::new(1);
    let lines: Vec<&str> = NEURON.lines().collect();
    let first = graph("a.swc", NEURON);
    for _ in 0..count(50) {
        let mut lines = lines.clone();
        for i in (1..lines.len()).rev() {
            lines.swap(i, random.below(i + 1));
        }
        assert_eq!(graph("a.swc", lines.join("\n")), first);
    }
}

#[test]
fn several_roots_and_loose_nodes_are_kept() {
    let text = "1 2 0 0 0 1 -1\n2 2 4 0 0 1 1\n3 2 9 9 9 2 -1\n4 7 9 9 19 2 3\n5 0 50 0 0 3 -1\n";
    let graph = graph("a.swc", text);
    let facts = graph.facts();
    assert_eq!((facts.components, facts.free_ends), (3, 4));
    assert!(
        graph
            .nodes
            .iter()
            .any(|node| node.is_ball && node.radius == 3.0)
    );
    assert!(graph.groups.iter().any(|group| group.name == "type7"));
}

#[test]
fn faults_are_told_with_their_lines_and_the_rest_is_read() {
    for (from, to, told, limbs) in [
        (
            "2 3 1 9 0 1.75 9",
            "2 3 1 9 0 1.75 99",
            "line 6: there is no node 99",
            5,
        ),
        (
            "2 3 1 9 0 1.75 9",
            "2 3 1 9 0 1.75 8",
            "line 6: node 2 comes before itself",
            5,
        ),
        (
            "2 3 1 9 0 1.75 9",
            "2 3 1 9 0 1.75 2",
            "line 6: node 2 comes before itself",
            5,
        ),
        (
            "2 3 1 9 0 1.75 9",
            "2 3 1 9 0 0 9",
            "line 6: the radius of node 2 is not above 0",
            6,
        ),
        (
            "2 3 1 9 0 1.75 9",
            "2 3 1 9 0 -1 9",
            "line 6: the radius of node 2 is not above 0",
            6,
        ),
        (
            "12 2 1 -31 0 0.5",
            "11 2 1 -31 0 0.5",
            "line 9: node 11 stands in line 8 already",
            5,
        ),
        (
            "12 2 1 -31 0 0.5 11",
            "11 2 1 -9 0 1 9",
            "line 9: node 11 stands in line 8 already",
            5,
        ),
        (
            "12 2 1 -31 0 0.5",
            "12 2 1 -9 0 0.5",
            "1 limbs have no length",
            5,
        ),
        (
            "# fork",
            "# \n# SCALE 2 2 1",
            "line 6: this scale is not applied",
            6,
        ),
    ] {
        let text = NEURON.replace(from, to);
        assert_ne!(text, NEURON, "{from}");
        let graph = graph("a.swc", &text);
        let remarks = remarks(&graph);
        assert!(remarks[0].starts_with(told), "{to}: {remarks:?}");
        assert_eq!(graph.limbs.len(), limbs, "{to}");
        assert!(
            graph
                .limbs
                .iter()
                .flat_map(|limb| limb.radii)
                .all(|radius| radius > 0.0)
        );
    }
}

#[test]
fn lines_that_cannot_be_read_are_errors() {
    for (from, to, told) in [
        (
            "-9 0 1.0",
            "-9 NaN 1.0",
            "line 8: `z` is `NaN`, which is no number",
        ),
        (
            "-9 0 1.0",
            "-9 0 inf",
            "line 8: `radius` is `inf`, which is no number",
        ),
        (
            "-9 0 1.0",
            "-9 0 1e400",
            "line 8: `radius` is `1e400`, which is no number",
        ),
        ("-9 0 1.0", "-9 0", "line 8: `parent` is missing"),
        ("11 2", "11.5 2", "line 8: `id` is 11.5, no whole number"),
        (
            "-9 0 1.0",
            "-9e15 0 1.0",
            "line 8: coordinates must be numbers within",
        ),
    ] {
        let text = NEURON.replace(from, to);
        assert_ne!(text, NEURON, "{from}");
        let message = message("a.swc", &text);
        assert!(message.starts_with(told), "{to}: {message}");
    }
    assert!(message("a.swc", "# nothing\n").contains("id type x y z radius parent"));
}
