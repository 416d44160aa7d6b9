//! Hierarchy of boxes around hard shapes, in the order in which `shaders/scene.wgsl` goes through
//! it.

use glam::DVec3;

/// Box of a node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Node {
    pub(crate) low: DVec3,
    pub(crate) high: DVec3,
    /// The node that follows those below this one.
    pub(crate) next: u32,
    /// The shape, if there is nothing below.
    pub(crate) item: Option<u32>,
}

/// Returns a hierarchy of items with boxes, each node before those below it.
pub(crate) fn nodes(boxes: &[(DVec3, DVec3)]) -> Vec<Node> {
    let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
    let mut nodes = Vec::with_capacity(2 * boxes.len());
    if !order.is_empty() {
        append(boxes, &mut order, &mut nodes);
    }
    nodes
}

/// Appends the node of some items, and those below it.
fn append(boxes: &[(DVec3, DVec3)], items: &mut [u32], nodes: &mut Vec<Node>) {
    let all = items.iter().map(|&i| boxes[i as usize]);
    let empty = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (low, high) = all.fold(empty, |(low, high), (a, b)| (low.min(a), high.max(b)));
    let place = nodes.len();
    nodes.push(Node {
        low,
        high,
        next: 0,
        item: (items.len() == 1).then(|| items[0]),
    });
    if items.len() > 1 {
        let size = high - low;
        let axis = (0..3)
            .max_by(|&i, &j| size[i].total_cmp(&size[j]))
            .unwrap_or(0);
        let half = items.len() / 2;
        items.select_nth_unstable_by(half, |&i, &j| {
            let [a, b] = [i, j].map(|k| boxes[k as usize].0[axis] + boxes[k as usize].1[axis]);
            a.total_cmp(&b).then(i.cmp(&j))
        });
        let (first, second) = items.split_at_mut(half);
        append(boxes, first, nodes);
        append(boxes, second, nodes);
    }
    nodes[place].next = nodes.len() as u32;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_item_is_below_the_boxes_around_it() {
        let boxes: Vec<_> = (0..100)
            .map(|i| {
                let low = DVec3::new(f64::from(i * 37 % 100), f64::from(i * 61 % 100), 0.0);
                (low, low + DVec3::ONE)
            })
            .collect();
        let nodes = nodes(&boxes);
        assert_eq!(nodes.len(), 199);
        let mut seen = vec![0; boxes.len()];
        for (i, node) in nodes.iter().enumerate() {
            for below in &nodes[i..node.next as usize] {
                assert!(below.low.cmpge(node.low).all() && below.high.cmple(node.high).all());
            }
            if let Some(item) = node.item {
                seen[item as usize] += 1;
                assert_eq!(node.next as usize, i + 1);
                assert_eq!((node.low, node.high), boxes[item as usize]);
            }
        }
        assert!(seen.iter().all(|count| *count == 1));
    }
}
