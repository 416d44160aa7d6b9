//! Writers: files are read as they were written.

use crate::common::{check, drawing, graph};
use limbs::Graph;

const NEURON: &str = "1 1 0 0 0 6 -1\n2 3 1 9 0 1.75 1\n4 3 1 21 0 1.25 2\n7 3 -3 25.5 0 0.7 4\n\
                      8 4 7 33 0 0.8 4\n11 2 1 -9 0 1 1\n12 2 1 -31 0 0.5 11\n";

const RING: &str = "# vt: radius\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0.1 0.7 3e-5\nvt 0.1\nvt 0.2\nvt \
 0.3\n\
                    usemtl steel\nl 1/1 2/2 3/3 1/1\nusemtl brass\nl 3/2 4/1\n";

fn groups(graph: &Graph) -> Vec<&str> {
    let mut names: Vec<&str> = graph
        .limbs
        .iter()
        .map(|limb| &graph.groups[limb.group as usize].name[..])
        .collect();
    names.sort_unstable();
    names
}

#[test]
fn swc_is_read_as_it_was_written() {
    let before = graph("a.swc", NEURON);
    let written = before.write_swc();
    assert!(written.remarks.is_empty());
    let after = graph("a.swc", &written.text);
    check(&after);
    assert_eq!(drawing(&after), drawing(&before));
    assert_eq!(groups(&after), groups(&before));
    for graph in [&before, &after] {
        assert_eq!(graph.nodes.iter().filter(|node| node.is_ball).count(), 1);
    }
    // Once more, the text is the same.
    assert_eq!(
        after.write_swc().text,
        graph("a.swc", after.write_swc().text).write_swc().text
    );
}

/// Returns the places of each limb's ends.
fn places(graph: &Graph) -> Vec<[[f64; 3]; 2]> {
    let ends = drawing(graph);
    ends.iter()
        .map(|ends| ends.map(|[x, y, z, _]| [x, y, z]))
        .collect()
}

#[test]
fn what_swc_cannot_say_is_told() {
    let ring = graph("a.obj", RING);
    let written = ring.write_swc();
    let remarks: Vec<String> = written.remarks.iter().map(ToString::to_string).collect();
    assert!(remarks[0].starts_with("1 cycles are cut"), "{remarks:?}");
    assert!(
        remarks[1].starts_with("1 limbs begin with another radius"),
        "{remarks:?}"
    );
    assert!(written.text.contains("# type 7: steel\n# type 8: brass\n"));
    let after = graph("a.swc", &written.text);
    assert_eq!(after.limbs.len(), ring.limbs.len());
    assert_eq!(places(&after), places(&ring));
}

#[test]
fn obj_is_read_as_it_was_written() {
    for (name, text) in [("a.obj", RING), ("a.swc", NEURON)] {
        let before = graph(name, text);
        let written = before.write_obj();
        let after = graph("a.obj", &written.text);
        check(&after);
        assert_eq!(drawing(&after), drawing(&before));
        assert_eq!(groups(&after), groups(&before));
        assert_eq!(
            written.remarks.len(),
            usize::from(name == "a.swc"),
            "the soma is no line"
        );
    }
}

#[test]
fn blocks_name_their_nodes_and_materials() {
    let neuron = graph("a.swc", NEURON);
    let written = neuron.write_block("Flesh", "N", &[("axon", "Blue")]);
    assert_eq!(
        written.text,
        "skeleton Flesh, N subdivide 0 {\n  \
         node n0 <0 0 0> radius 1.75\n  node n1 <1 9 0> radius 1.75\n  \
         node n2 <1 21 0> radius 1.25\n  node n3 <-3 25.5 0> radius 0.7\n  \
         node n4 <7 33 0> radius 0.8\n  \
         curve n0 n1 n2\n  curve n2 n3\n  curve n2 n4\n}\n\
         sphere Flesh 6 <0 0 0>\n\
         skeleton Blue, N_Blue subdivide 0 {\n  \
         node n0 <0 0 0> radius 1\n  node n1 <1 -9 0> radius 1\n  node n2 <1 -31 0> radius 0.5\n  \
         curve n0 n1 n2\n}\n"
    );
    // A jump of the radius is a node for each.
    let ring = graph("a.obj", RING).write_block("s", "R", &[]);
    assert!(ring.text.contains("<1 1 0> radius 0.3") && ring.text.contains("<1 1 0> radius 0.2"));
    assert!(ring.text.contains("<0.1 0.7 0.00003>"), "{}", ring.text);
}
