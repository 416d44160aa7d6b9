//! Operations on graphs, and the counts that describe them.

use crate::common::{check, drawing, graph, with};
use glam::{DAffine3, DVec3};
use limbs::{Graph, Reading};
use std::fmt::Write as _;
use trials::{Random, count};

/// A random graph: paths between random points that share nodes, as an OBJ file.
fn random_graph(random: &mut Random) -> Graph {
    let nodes = 3 + random.below(30);
    let mut text = String::from("# vt: radius\n");
    for _ in 0..nodes {
        let p = random.vector(5.0);
        let _ = writeln!(
            text,
            "v {} {} {}\nvt {}",
            p.x,
            p.y,
            p.z,
            random.range(0.1, 0.5)
        );
    }
    for _ in 0..1 + random.below(5) {
        text.push('l');
        for _ in 0..2 + random.below(nodes) {
            let node = 1 + random.below(nodes);
            let _ = write!(text, " {node}/{node}");
        }
        text.push('\n');
    }
    // A limb that surely has a length.
    text.push_str("l 1/1 2/2\n");
    graph("a.obj", text)
}

fn is_set(row: &[u64], column: usize) -> bool {
    row[column / 64] >> (column % 64) & 1 == 1
}

/// Returns the rank of the incidence matrix of nodes and limbs over the numbers 0 and 1.
fn rank(graph: &Graph) -> usize {
    let mut rows: Vec<Vec<u64>> = graph
        .limbs
        .iter()
        .map(|limb| {
            let mut row = vec![0; graph.nodes.len().div_ceil(64)];
            for end in limb.ends {
                row[end as usize / 64] ^= 1 << (end % 64);
            }
            row
        })
        .collect();
    let mut rank = 0;
    for column in 0..graph.nodes.len() {
        let Some(pivot) = (rank..rows.len()).find(|i| is_set(&rows[*i], column)) else {
            continue;
        };
        rows.swap(rank, pivot);
        let pivot = rows[rank].clone();
        for row in rows[rank + 1..]
            .iter_mut()
            .filter(|row| is_set(row, column))
        {
            row.iter_mut().zip(&pivot).for_each(|(a, b)| *a ^= b);
        }
        rank += 1;
    }
    rank
}

#[test]
fn cycles_and_components_are_those_of_linear_algebra() {
    let mut random = Random::new(3);
    for _ in 0..count(100) {
        let graph = random_graph(&mut random);
        check(&graph);
        let (facts, rank) = (graph.facts(), rank(&graph));
        assert_eq!(facts.components, graph.nodes.len() - rank);
        assert_eq!(facts.cycles, graph.limbs.len() - rank);
        let mut degrees = vec![0; graph.nodes.len()];
        for end in graph.limbs.iter().flat_map(|limb| limb.ends) {
            degrees[end as usize] += 1;
        }
        assert_eq!(
            facts.free_ends,
            degrees.iter().filter(|degree| **degree == 1).count()
        );
        assert_eq!(facts.valence, degrees.into_iter().max().unwrap());
    }
}

#[test]
fn rigid_motions_and_scales_keep_what_they_must() {
    let mut random = Random::new(4);
    for _ in 0..count(50) {
        let graph = random_graph(&mut random);
        let factor = random.range(0.5, 3.0);
        let map = DAffine3::from_scale_rotation_translation(
            DVec3::splat(factor),
            random.rotation(),
            random.vector(10.0),
        );
        let mut moved = graph.clone();
        moved.place(&map);
        for i in 0..graph.limbs.len() {
            assert!((moved.length(i) - factor * graph.length(i)).abs() < 1e-9);
            let radii = graph.limbs[i].radii.map(|radius| factor * radius);
            assert!((moved.limbs[i].radii[0] - radii[0]).abs() < 1e-12);
        }
        assert_eq!(moved.facts(), graph.facts());
        let mut scaled = graph.clone();
        scaled.scale(2.0);
        scaled.scale(0.5);
        assert_eq!(drawing(&scaled), drawing(&graph));
    }
}

#[test]
fn thickening_adds_to_radii_and_thinning_takes_limbs_out() {
    let mut graph = graph("a.swc", "1 2 0 0 0 3 -1\n2 2 9 0 0 1 1\n3 2 18 0 0 1 2\n");
    graph.thicken(0.5);
    assert_eq!(graph.limbs[0].radii, [3.5, 1.5]);
    graph.thicken(-2.0);
    check(&graph);
    assert_eq!(graph.limbs.len(), 1);
    assert_eq!(graph.limbs[0].radii, [1.5, 0.0015]);
    assert_eq!(graph.nodes.len(), 2);
    assert!(graph.remarks[0].text.starts_with("1 limbs or balls"));
}

/// Returns a line of an OBJ file through vertices that follow on each other.
fn run(from: usize, to: usize) -> String {
    (from..=to).fold(String::from("l"), |line, i| format!("{line} {i}/{i}"))
}

/// Returns the least of the larger of the distances in place and in radius, from a point of a line
/// to a graph, by sampling it.
fn distance(place: DVec3, radius: f64, graph: &Graph) -> f64 {
    let limbs = graph.limbs.iter().map(|limb| {
        let [a, b] = limb.ends.map(|end| graph.nodes[end as usize].position);
        let count = (a.distance(b) / 0.01).ceil();
        let samples = (0..=count as u32).map(|i| {
            let t = f64::from(i) / count;
            let own = limb.radii[0] + (limb.radii[1] - limb.radii[0]) * t;
            place.distance(a + (b - a) * t).max((radius - own).abs())
        });
        samples.fold(f64::INFINITY, f64::min)
    });
    limbs.fold(f64::INFINITY, f64::min)
}

#[test]
fn lines_stay_where_they_are_when_they_are_simplified() {
    let mut random = Random::new(5);
    for _ in 0..count(6) {
        // A tree of wobbly lines, with a cycle.
        let mut text = String::from("# vt: radius\n");
        let mut at = DVec3::ZERO;
        let mut radius = 0.3;
        for _ in 0..120 {
            at += random.direction() * 0.1 + DVec3::X * 0.2;
            radius = (radius + random.range(-0.02, 0.02)).clamp(0.1, 0.5);
            let _ = writeln!(text, "v {} {} {}\nvt {radius}", at.x, at.y, at.z);
        }
        let _ = writeln!(
            text,
            "{}\n{}\nl 20/20 81/81\nl 120/120 90/90",
            run(1, 80),
            run(81, 120)
        );
        let before = graph("a.obj", text);
        let within = random.range(0.02, 0.3);
        let mut after = before.clone();
        after.simplify(within);
        check(&after);
        assert!(after.limbs.len() < before.limbs.len());
        let [a, b] = [before.facts(), after.facts()];
        assert_eq!(
            (a.components, a.cycles, a.free_ends),
            (b.components, b.cycles, b.free_ends)
        );
        // Both ways, up to the distance between samples.
        for [from, to] in [[&before, &after], [&after, &before]] {
            for limb in &from.limbs {
                let [p, q] = limb.ends.map(|end| from.nodes[end as usize].position);
                for i in 0..=4 {
                    let t = f64::from(i) / 4.0;
                    let radius = limb.radii[0] + (limb.radii[1] - limb.radii[0]) * t;
                    let far = distance(p + (q - p) * t, radius, to);
                    assert!(far <= within + 0.01, "{far} > {within}");
                }
            }
        }
        // Nothing moves within nothing, and straight lines need no nodes.
        let mut same = before.clone();
        same.simplify(0.0);
        assert_eq!(drawing(&same), drawing(&before));
    }
    let mut line = graph(
        "a.swc",
        "1 2 0 0 0 1 -1\n2 2 1 0 0 2 1\n3 2 2 0 0 3 2\n4 2 3 0 0 4 3\n",
    );
    line.simplify(1e-9);
    assert_eq!(
        drawing(&line),
        [[[0.0, 0.0, 0.0, 1.0], [3.0, 0.0, 0.0, 4.0]]]
    );
}

#[test]
fn simplifying_keeps_cycles_and_parallel_lines() {
    let reading = Reading {
        radius: Some(0.1),
        ..Reading::default()
    };
    let ring: String = (0..60)
        .map(|i| {
            let angle = f64::from(i) * std::f64::consts::TAU / 60.0;
            format!("v {} {} 0\n", libm::cos(angle), libm::sin(angle))
        })
        .collect();
    let all: String = (1..=60).map(|i| format!(" {i}")).collect();
    for text in [
        format!("{ring}l{all} 1\n"),
        format!("{ring}l{all} 1\nv 5 0 0\nl 1 61\n"),
        // Two lines between the same two nodes.
        format!("{ring}l{all} 1\nv 5 0 0\nv -5 0 0\nl 1 61\nl 31 62\n"),
    ] {
        let mut graph = with("a.obj", text, reading);
        let before = graph.facts();
        graph.simplify(100.0);
        check(&graph);
        assert_eq!(graph.facts().cycles, 1);
        assert_eq!(graph.facts().free_ends, before.free_ends);
        assert!(graph.limbs.len() <= 6);
    }
}

#[test]
fn merging_joins_lines_that_run_together() {
    // A trunk of a centreline that is listed for each of two outlets, sampled at other places.
    let text = "# vt: radius\nvt 0.5\nv 0 0 0\nv 2 0 0\nv 4 0 0\nv 6 2 0\n\
                v 0 0.01 0\nv 1 0 0.01\nv 3 0 0\nv 4.005 0 0\nv 6 -2 0\n\
                l 1/1 2/1 3/1 4/1\nl 5/1 6/1 7/1 8/1 9/1\n";
    let mut graph = graph("a.obj", text);
    assert_eq!(graph.facts().components, 2);
    graph.merge(0.02).unwrap();
    check(&graph);
    let facts = graph.facts();
    assert_eq!((facts.components, facts.cycles, facts.free_ends), (1, 0, 3));
    assert_eq!(graph.limbs.len(), 6);
    // Nothing is near enough here.
    let before = drawing(&graph);
    graph.merge(0.02).unwrap();
    assert_eq!(drawing(&graph), before);
}

/// Returns the places of all ends of limbs.
fn places(graph: &Graph) -> Vec<[f64; 3]> {
    let drawing = drawing(graph);
    let ends = drawing.iter().flatten();
    ends.map(|end| [end[0], end[1], end[2]]).collect()
}

#[test]
fn merging_does_not_depend_on_order() {
    let mut random = Random::new(6);
    for _ in 0..count(30) {
        let graph = random_graph(&mut random);
        let mut other = graph.clone();
        // Nodes the other way round.
        let last = graph.nodes.len() as u32 - 1;
        other.nodes.reverse();
        other.limbs.reverse();
        for limb in &mut other.limbs {
            limb.ends = limb.ends.map(|end| last - end);
        }
        let within = random.range(0.1, 2.0);
        let [mut a, mut b] = [graph.clone(), other];
        a.merge(within).unwrap();
        b.merge(within).unwrap();
        if !a.limbs.is_empty() {
            check(&a);
        }
        assert_eq!(places(&a), places(&b));
        for node in &a.nodes {
            assert!(graph.nodes.iter().any(|old| old.position == node.position));
        }
    }
}

#[test]
fn crowds_of_limbs_are_refused_in_time() {
    // All limbs between points that are nearly on a line run through each other.
    let mut text = String::from("# vt: radius\nvt 1\n");
    let mut random = Random::new(7);
    for _ in 0..600 {
        let p = random.vector(1.0) * DVec3::new(1.0, 1e-5, 1e-5);
        let _ = writeln!(text, "v {} {} {}", p.x, p.y, p.z);
    }
    for a in 1..=600 {
        for b in a + 1..=600 {
            let _ = writeln!(text, "l {a}/1 {b}/1");
        }
    }
    let mut graph = graph("a.obj", &text);
    assert_eq!(graph.limbs.len(), 600 * 599 / 2);
    let told = graph.merge(1e-4).unwrap_err().to_string();
    assert!(
        told.starts_with("too many limbs are within 0.0001"),
        "{told}"
    );
    assert!(graph.limbs.is_empty());
    // One more than the limit of limbs.
    let most = limbs::limits::MAX_LIMBS;
    let chain: String = (0..=most + 1)
        .map(|i| {
            format!(
                "{} 2 {i} 0 0 1 {}\n",
                i + 1,
                if i == 0 { -1 } else { i as i64 }
            )
        })
        .collect();
    let told = crate::common::message("a.swc", &chain);
    assert!(
        told.contains("200001 limbs") && told.contains("200000 limbs"),
        "{told}"
    );
    let shorter: String = chain
        .lines()
        .take(most + 1)
        .map(|line| format!("{line}\n"))
        .collect();
    let mut graph = crate::common::graph("a.swc", shorter);
    assert_eq!(graph.limbs.len(), most);
    graph.simplify(0.5);
    assert_eq!(graph.limbs.len(), 1);
}
