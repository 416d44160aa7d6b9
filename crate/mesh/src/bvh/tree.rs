//! The tree itself: nodes, the boxes below them, and how it follows boxes that move.

use crate::aabb::Aabb;

/// The deepest path from the root to a leaf: see `build`.
pub(super) const MAX_DEPTH: usize = 96;

/// Node: a leaf if it has primitives, else the parent of `first` and `first + 1`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub(super) bounds: Aabb,
    /// First child, or first place in `Bvh::order`.
    pub(super) first: u32,
    /// Number of primitives of a leaf; 0 for an inner node.
    pub(super) count: u32,
}

/// Bounding volume hierarchy over numbered boxes, the primitives.
///
/// The tree depends on the boxes and their order only, so that it is the same on every machine.
/// Primitives whose box is empty or has a NaN are kept but never found.
///
/// ```
/// use glam::DVec3;
/// use mesh::{Aabb, Bvh, Ray};
///
/// let boxes: Vec<Aabb> = (0..100)
///     .map(|i| DVec3::new(f64::from(i), 0.0, 0.0))
///     .map(|p| Aabb::of_points([p, p + DVec3::splat(0.5)]))
///     .collect();
/// let bvh = Bvh::new(&boxes);
///
/// let query = Aabb::of_points([DVec3::new(10.2, 0.0, 0.0), DVec3::new(12.0, 1.0, 1.0)]);
/// let mut found: Vec<u32> = bvh.overlapping(&query).collect();
/// found.sort();
/// assert_eq!(found, [10, 11, 12]);
///
/// // The first box that a ray meets.
/// let ray = Ray::new(DVec3::new(49.75, 0.2, 0.2), DVec3::X);
/// let mut first = None;
/// bvh.along_ray(&ray, f64::INFINITY, |i, far| {
///     let entry = boxes[i as usize].min.x - 49.75;
///     if entry > 0.0 && entry < far {
///         first = Some(i);
///         return entry;
///     }
///     far
/// });
/// assert_eq!(first, Some(50));
///
/// // The primitive nearest to a point.
/// let point = DVec3::new(7.9, 0.2, 0.2);
/// let nearest = bvh.nearest(point, f64::INFINITY, |i| boxes[i as usize].distance_squared(point));
/// assert_eq!(nearest.unwrap().0, 8);
/// ```
#[derive(Clone, Debug)]
pub struct Bvh {
    /// Parents come before their children; the root is the first.
    pub(super) nodes: Vec<Node>,
    /// The parent of each node; the root's own is 0.
    pub(super) parents: Vec<u32>,
    /// Primitives, leaf by leaf.
    pub(super) order: Vec<u32>,
    /// The box of each primitive.
    pub(super) boxes: Vec<Aabb>,
    /// The leaf of each primitive.
    pub(super) leaves: Vec<u32>,
}

impl Bvh {
    /// Number of primitives.
    #[must_use]
    pub fn len(&self) -> usize {
        self.boxes.len()
    }

    /// `true` if there are no primitives.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.boxes.is_empty()
    }

    /// The box that contains all primitives; empty without any.
    #[must_use]
    pub fn bounds(&self) -> Aabb {
        self.nodes.first().map_or(Aabb::EMPTY, |root| root.bounds)
    }

    /// The box of a primitive.
    ///
    /// # Panics
    /// If there is no such primitive.
    #[must_use]
    pub fn bounds_of(&self, primitive: u32) -> Aabb {
        self.boxes[primitive as usize]
    }

    /// Number of primitives below each node, by the numbers that [`Bvh::descend`] tells.
    #[must_use]
    pub fn counts(&self) -> Vec<u32> {
        let mut counts: Vec<u32> = self.nodes.iter().map(|node| node.count).collect();
        for node in (1..self.nodes.len()).rev() {
            counts[self.parents[node] as usize] += counts[node];
        }
        counts
    }

    /// Gives a primitive a new box, and updates the nodes above it. Costs the depth of the tree.
    /// The tree's shape stays, so that after large motions [`Bvh::new`] gives a faster one.
    ///
    /// # Panics
    /// If there is no such primitive.
    pub fn set_box(&mut self, primitive: u32, bounds: Aabb) {
        self.boxes[primitive as usize] = sanitize(bounds);
        let mut node = self.leaves[primitive as usize];
        loop {
            let fitted = self.fit(node);
            let old = &mut self.nodes[node as usize].bounds;
            if *old == fitted || node == 0 {
                *old = fitted;
                return;
            }
            *old = fitted;
            node = self.parents[node as usize];
        }
    }

    /// Gives all primitives new boxes; the tree's shape stays.
    ///
    /// # Panics
    /// If there are not as many boxes as primitives.
    pub fn refit(&mut self, boxes: &[Aabb]) {
        assert_eq!(boxes.len(), self.boxes.len(), "one box for each primitive");
        for (own, new) in self.boxes.iter_mut().zip(boxes) {
            *own = sanitize(*new);
        }
        for node in (0..self.nodes.len() as u32).rev() {
            self.nodes[node as usize].bounds = self.fit(node);
        }
    }

    /// The box of all that is directly below a node.
    pub(super) fn fit(&self, node: u32) -> Aabb {
        let node = self.nodes[node as usize];
        if node.count == 0 {
            let [a, b] = [node.first, node.first + 1].map(|i| &self.nodes[i as usize].bounds);
            return a.union(b);
        }
        let primitives = self.primitives(&node).iter();
        primitives.fold(Aabb::EMPTY, |all, i| all.union(&self.boxes[*i as usize]))
    }

    /// The primitives of a leaf; none of an inner node.
    pub(super) fn primitives(&self, node: &Node) -> &[u32] {
        match node.count {
            0 => &[],
            count => &self.order[node.first as usize..(node.first + count) as usize],
        }
    }
}

/// The box, or the empty one if it has a NaN.
pub(super) fn sanitize(bounds: Aabb) -> Aabb {
    if bounds.is_empty() {
        Aabb::EMPTY
    } else {
        bounds
    }
}
