//! Building the hierarchy.
//!
//! Nothing calls itself: nodes to split wait on a list. Each split depends on a set of primitives
//! only, and each leaf lists its primitives in ascending order, so that the tree depends on no
//! library's way of sorting.

use super::tree::{Bvh, MAX_DEPTH, Node, sanitize};
use crate::aabb::Aabb;
use glam::DVec3;

/// Most primitives of a leaf.
const LEAF: usize = 4;
/// Bins of the surface area heuristic.
const BINS: usize = 16;
/// Depth from which nodes are split by the median, which halves them: as there are fewer than 2³¹
/// boxes, the deepest level is 64 + 31.
const MEDIAN_FROM: usize = 64;
const _: () = assert!(MEDIAN_FROM + 31 < MAX_DEPTH);

/// Node that is not yet split: its place, its range in the order, and its depth.
struct Open {
    node: u32,
    start: usize,
    end: usize,
    depth: usize,
}

impl Bvh {
    /// Builds the hierarchy: splits by the surface area heuristic over 16 bins of box centres, and
    /// by the median where that makes no progress. Takes time in proportion to n log n.
    ///
    /// # Panics
    /// If there are 2³¹ boxes or more.
    #[must_use]
    pub fn new(boxes: &[Aabb]) -> Self {
        assert!(boxes.len() < 1 << 31, "fewer than 2³¹ boxes");
        let boxes: Vec<Aabb> = boxes.iter().copied().map(sanitize).collect();
        let mut bvh = Self {
            nodes: Vec::new(),
            parents: Vec::new(),
            order: (0..boxes.len() as u32).collect(),
            leaves: vec![0; boxes.len()],
            boxes,
        };
        if bvh.boxes.is_empty() {
            return bvh;
        }
        let centers: Vec<DVec3> = bvh.boxes.iter().map(center).collect();
        let unset = Node {
            bounds: Aabb::EMPTY,
            first: 0,
            count: 0,
        };
        bvh.nodes.push(unset);
        bvh.parents.push(0);
        let mut open = vec![Open {
            node: 0,
            start: 0,
            end: bvh.boxes.len(),
            depth: 0,
        }];
        while let Some(Open {
            node,
            start,
            end,
            depth,
        }) = open.pop()
        {
            let range = &mut bvh.order[start..end];
            let bounds = range
                .iter()
                .fold(Aabb::EMPTY, |all, i| all.union(&bvh.boxes[*i as usize]));
            if range.len() <= LEAF {
                range.sort_unstable();
                for i in &*range {
                    bvh.leaves[*i as usize] = node;
                }
                bvh.nodes[node as usize] = Node {
                    bounds,
                    first: start as u32,
                    count: range.len() as u32,
                };
                continue;
            }
            let by_area = (depth < MEDIAN_FROM)
                .then(|| split_by_area(range, &bvh.boxes, &centers))
                .flatten();
            let middle = start + by_area.unwrap_or_else(|| split_by_median(range, &centers));
            let first = bvh.nodes.len() as u32;
            bvh.nodes[node as usize] = Node {
                bounds,
                first,
                count: 0,
            };
            bvh.nodes.extend([unset, unset]);
            bvh.parents.extend([node, node]);
            for (node, start, end) in [(first + 1, middle, end), (first, start, middle)] {
                open.push(Open {
                    node,
                    start,
                    end,
                    depth: depth + 1,
                });
            }
        }
        bvh
    }
}

/// The middle of a box, or the origin where that is not finite.
fn center(bounds: &Aabb) -> DVec3 {
    let center = bounds.center();
    if center.is_finite() {
        center
    } else {
        DVec3::ZERO
    }
}

/// The axis along which centres are spread most, with their range.
fn widest(range: &[u32], centers: &[DVec3]) -> (usize, f64, f64) {
    let spread = Aabb::of_points(range.iter().map(|i| centers[*i as usize]));
    // Halves, so that the difference of the largest numbers stays finite.
    let size = 0.5 * spread.max - 0.5 * spread.min;
    let axis = size.max_position();
    (axis, spread.min[axis], spread.max[axis])
}

/// Sorts a range into two parts at the boundary of bins with the least expected cost. `None` if all
/// centres fall into one bin.
fn split_by_area(range: &mut [u32], boxes: &[Aabb], centers: &[DVec3]) -> Option<usize> {
    let (axis, low, high) = widest(range, centers);
    let scale = BINS as f64 / (high - low);
    if !(scale.is_finite() && scale > 0.0) {
        return None;
    }
    let bin = |i: u32| {
        let at = (centers[i as usize][axis] - low) * scale;
        (at as usize).min(BINS - 1)
    };
    let mut bins = [(Aabb::EMPTY, 0_usize); BINS];
    for i in &*range {
        let (bounds, count) = &mut bins[bin(*i)];
        *bounds = bounds.union(&boxes[*i as usize]);
        *count += 1;
    }
    // Cost of the bins from k on, for each k.
    let mut above = [0.0; BINS];
    let (mut bounds, mut count) = (Aabb::EMPTY, 0);
    for k in (1..BINS).rev() {
        bounds = bounds.union(&bins[k].0);
        count += bins[k].1;
        above[k] = bounds.half_area() * count as f64;
    }
    let (mut bounds, mut count) = (Aabb::EMPTY, 0);
    let mut best: Option<(f64, usize)> = None;
    for (k, above) in above.iter().enumerate().skip(1) {
        bounds = bounds.union(&bins[k - 1].0);
        count += bins[k - 1].1;
        let cost = bounds.half_area() * count as f64 + above;
        let is_split = count > 0 && count < range.len();
        if is_split && best.is_none_or(|(least, _)| cost < least) {
            best = Some((cost, k));
        }
    }
    let (_, k) = best?;
    // Both parts keep their order.
    let above: Vec<u32> = range.iter().copied().filter(|i| bin(*i) >= k).collect();
    let mut count = 0;
    for place in 0..range.len() {
        if bin(range[place]) < k {
            range[count] = range[place];
            count += 1;
        }
    }
    range[count..].copy_from_slice(&above);
    Some(count)
}

/// Sorts a range into halves by the centres along the widest axis, then by number.
fn split_by_median(range: &mut [u32], centers: &[DVec3]) -> usize {
    let (axis, ..) = widest(range, centers);
    let middle = range.len() / 2;
    range.select_nth_unstable_by(middle, |a, b| {
        let [one, other] = [a, b].map(|i| centers[*i as usize][axis]);
        one.total_cmp(&other).then(a.cmp(b))
    });
    middle
}
