//! Functions that the tests of several subjects share.

use limbs::{Graph, Reading};

/// Reads a file that holds a skeleton.
pub fn graph(name: &str, bytes: impl AsRef<[u8]>) -> Graph {
    let graph = limbs::read(name, bytes.as_ref(), &Reading::default());
    let graph = graph.unwrap_or_else(|error| panic!("{name}: {error}"));
    graph.unwrap_or_else(|| panic!("{name} holds no skeleton"))
}

/// Returns what is said of a file that cannot be read.
pub fn message(name: &str, bytes: impl AsRef<[u8]>) -> String {
    match limbs::read(name, bytes.as_ref(), &Reading::default()) {
        Ok(_) => panic!("{name} is read"),
        Err(error) => error.to_string(),
    }
}

/// Returns a graph's remarks, as they are shown.
pub fn remarks(graph: &Graph) -> Vec<String> {
    graph.remarks.iter().map(ToString::to_string).collect()
}

/// Returns a file as [`limbs::read`] does, with choices.
pub fn with(name: &str, bytes: impl AsRef<[u8]>, reading: Reading<'_>) -> Graph {
    limbs::read(name, bytes.as_ref(), &reading)
        .unwrap()
        .unwrap()
}

/// Returns each limb as its two ends with their radii, in an order that does not depend on
/// numbering.
pub fn drawing(graph: &Graph) -> Vec<[[f64; 4]; 2]> {
    let mut limbs: Vec<[[f64; 4]; 2]> = graph
        .limbs
        .iter()
        .map(|limb| {
            let mut ends = [0, 1].map(|side| {
                let [x, y, z] = graph.nodes[limb.ends[side] as usize].position.to_array();
                [x, y, z, limb.radii[side]]
            });
            ends.sort_by(|a, b| a.partial_cmp(b).unwrap());
            ends
        })
        .collect();
    limbs.sort_by(|a, b| a.partial_cmp(b).unwrap());
    limbs
}

/// Checks what every graph promises.
pub fn check(graph: &Graph) {
    assert!(!graph.nodes.is_empty());
    assert!(graph.limbs.len() <= limbs::limits::MAX_LIMBS);
    let mut degrees = vec![0; graph.nodes.len()];
    let mut pairs = std::collections::HashSet::new();
    for limb in &graph.limbs {
        let [a, b] = limb.ends;
        assert!(pairs.insert([a.min(b), a.max(b)]), "a limb is there twice");
        for end in limb.ends {
            degrees[end as usize] += 1;
        }
        let [a, b] = limb.ends.map(|end| graph.nodes[end as usize].position);
        assert!(a != b, "a limb has no length");
        assert!(
            limb.radii
                .iter()
                .all(|radius| *radius > 0.0 && radius.is_finite())
        );
        assert!((limb.group as usize) < graph.groups.len());
        assert!(
            limb.clip
                .is_none_or(|clip| (clip as usize) < graph.clips.len())
        );
    }
    for (node, degree) in graph.nodes.iter().zip(degrees) {
        assert!(node.position.is_finite() && node.radius > 0.0 && node.radius.is_finite());
        assert!(node.is_ball || degree > 0, "a node is alone");
        assert!((node.group as usize) < graph.groups.len());
    }
    let facts = graph.facts();
    assert!(facts.components >= 1 && facts.components <= graph.nodes.len());
}
