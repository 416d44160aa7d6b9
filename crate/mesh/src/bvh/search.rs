//! Searches: overlap, rays, the nearest primitive, pairs.

use super::tree::{Bvh, MAX_DEPTH};
use crate::aabb::Aabb;
use core::ops::ControlFlow;
use glam::DVec3;

/// Nodes that wait for their visit: at most one for each level, and the present one's children.
struct Stack {
    nodes: [u32; MAX_DEPTH + 2],
    len: usize,
}

impl Stack {
    /// The root, or nothing if the tree is empty.
    fn new(bvh: &Bvh) -> Self {
        Self {
            nodes: [0; MAX_DEPTH + 2],
            len: usize::from(!bvh.is_empty()),
        }
    }

    fn push(&mut self, node: u32) {
        self.nodes[self.len] = node;
        self.len += 1;
    }

    fn pop(&mut self) -> Option<u32> {
        self.len = self.len.checked_sub(1)?;
        Some(self.nodes[self.len])
    }
}

/// Ray, prepared for meeting many boxes.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// Point with the parameter 0.
    pub origin: DVec3,
    /// Vector from the origin to the point with the parameter 1; not zero. Components below 1e-300
    /// count as 0.
    pub direction: DVec3,
    inverse: DVec3,
}

impl Ray {
    /// Returns a ray from a point in a direction of any length.
    #[must_use]
    pub fn new(origin: DVec3, direction: DVec3) -> Self {
        Self {
            origin,
            direction,
            inverse: direction.recip(),
        }
    }

    /// The parameter ≥ 0 at which the ray enters a box, rounded down; `None` if it misses the box,
    /// or enters it beyond `far`. A box that the ray only touches is never missed.
    #[must_use]
    pub fn entry(&self, bounds: &Aabb, far: f64) -> Option<f64> {
        if bounds.is_empty() {
            return None;
        }
        let (mut near, mut exit) = (0.0_f64, far);
        for axis in 0..3 {
            let inverse = self.inverse[axis];
            let one = (bounds.min[axis] - self.origin[axis]) * inverse;
            let other = (bounds.max[axis] - self.origin[axis]) * inverse;
            // 0 · ∞ is a ray within a face of the box; `min` and `max` then take the other number.
            let (enters, leaves) = (one.min(other), one.max(other));
            // Three roundings: 2⁻⁵¹ more than covers them.
            near = near.max(enters - enters.abs() * 2.0 * f64::EPSILON);
            exit = exit.min(leaves + leaves.abs() * 2.0 * f64::EPSILON);
        }
        (near <= exit).then_some(near)
    }
}

/// Bounds the square of the distance from a box: lower by more than what rounding may have added.
#[inline]
fn least_distance_squared(bounds: &Aabb, point: DVec3) -> f64 {
    bounds.distance_squared(point) * (1.0 - 16.0 * f64::EPSILON)
}

impl Bvh {
    /// The primitives whose box has a point in common with a query box, in an order that is always
    /// the same.
    pub fn overlapping<'a>(&'a self, query: &Aabb) -> impl Iterator<Item = u32> + use<'a> {
        let query = *query;
        let mut stack = Stack::new(self);
        let mut leaf: &[u32] = &[];
        core::iter::from_fn(move || {
            loop {
                while let Some((first, rest)) = leaf.split_first() {
                    leaf = rest;
                    if self.boxes[*first as usize].overlaps(&query) {
                        return Some(*first);
                    }
                }
                let node = &self.nodes[stack.pop()? as usize];
                if !node.bounds.overlaps(&query) {
                    continue;
                }
                if node.count > 0 {
                    leaf = self.primitives(node);
                } else {
                    stack.push(node.first + 1);
                    stack.push(node.first);
                }
            }
        })
    }

    /// Calls `visit` with the primitives whose box a ray enters at a parameter from 0 to `far`,
    /// boxes of nodes nearest first. `visit` gets `far` and returns the next one: where the ray
    /// meets the primitive, or `far` again. A negative one ends the search.
    pub fn along_ray(&self, ray: &Ray, far: f64, mut visit: impl FnMut(u32, f64) -> f64) {
        let mut far = far;
        let mut stack = Stack::new(self);
        while let Some(node) = stack.pop() {
            let node = &self.nodes[node as usize];
            if ray.entry(&node.bounds, far).is_none() {
                continue;
            }
            for i in self.primitives(node) {
                if ray.entry(&self.boxes[*i as usize], far).is_some() {
                    far = far.min(visit(*i, far));
                }
            }
            if node.count == 0 {
                match [node.first, node.first + 1]
                    .map(|child| ray.entry(&self.nodes[child as usize].bounds, far))
                {
                    [Some(a), Some(b)] if b < a => {
                        stack.push(node.first);
                        stack.push(node.first + 1);
                    }
                    [a, b] => {
                        if b.is_some() {
                            stack.push(node.first + 1);
                        }
                        if a.is_some() {
                            stack.push(node.first);
                        }
                    }
                }
            }
        }
    }

    /// The primitive with the least squared distance, and that distance: `distance_squared` is
    /// asked about primitives whose box is near enough. Of equally distant ones the lowest number
    /// is returned; `None` if none is within √`limit` (a squared distance, too).
    ///
    /// `distance_squared` must not return less than the squared distance of the primitive's box,
    /// roundings aside.
    pub fn nearest(
        &self,
        point: DVec3,
        limit: f64,
        mut distance_squared: impl FnMut(u32) -> f64,
    ) -> Option<(u32, f64)> {
        let mut best: Option<(u32, f64)> = None;
        let mut reach = limit;
        let mut stack = Stack::new(self);
        while let Some(node) = stack.pop() {
            let node = &self.nodes[node as usize];
            if least_distance_squared(&node.bounds, point) > reach {
                continue;
            }
            for i in self.primitives(node) {
                if least_distance_squared(&self.boxes[*i as usize], point) > reach {
                    continue;
                }
                let found = distance_squared(*i);
                let is_nearer = match best {
                    Some((j, least)) => found < least || (found == least && *i < j),
                    None => found <= limit,
                };
                if is_nearer {
                    best = Some((*i, found));
                    reach = found;
                }
            }
            if node.count == 0 {
                let [a, b] = [node.first, node.first + 1];
                let [to_a, to_b] =
                    [a, b].map(|i| least_distance_squared(&self.nodes[i as usize].bounds, point));
                let [farther, nearer] = if to_b < to_a { [a, b] } else { [b, a] };
                stack.push(farther);
                stack.push(nearer);
            }
        }
        best
    }

    /// Visits nodes from the root down, the first child before the second. `visit` gets a node's
    /// number, its box, and its primitives if it is a leaf, and says whether the nodes below it are
    /// to be visited.
    pub fn descend(&self, mut visit: impl FnMut(u32, &Aabb, &[u32]) -> bool) {
        let mut stack = Stack::new(self);
        while let Some(number) = stack.pop() {
            let node = &self.nodes[number as usize];
            if visit(number, &node.bounds, self.primitives(node)) && node.count == 0 {
                stack.push(node.first + 1);
                stack.push(node.first);
            }
        }
    }

    /// Calls `visit` once with each pair of primitives (lower number first) whose boxes have a
    /// point in common, until it breaks. The order of pairs is always the same.
    pub fn pairs(&self, mut visit: impl FnMut(u32, u32) -> ControlFlow<()>) {
        let mut open: Vec<(u32, u32)> = Vec::new();
        if !self.is_empty() {
            open.push((0, 0));
        }
        while let Some((a, b)) = open.pop() {
            let [one, other] = [a, b].map(|i| &self.nodes[i as usize]);
            if !one.bounds.overlaps(&other.bounds) {
                continue;
            }
            if one.count > 0 && other.count > 0 {
                for i in self.primitives(one) {
                    for j in self.primitives(other) {
                        // Within a leaf each pair appears twice.
                        let is_new = a != b || i < j;
                        if is_new
                            && self.boxes[*i as usize].overlaps(&self.boxes[*j as usize])
                            && visit(*i.min(j), *i.max(j)).is_break()
                        {
                            return;
                        }
                    }
                }
            } else if a == b {
                let [l, r] = [one.first, one.first + 1];
                open.extend([(r, r), (l, r), (l, l)]);
            } else if other.count > 0
                || (one.count == 0 && one.bounds.half_area() >= other.bounds.half_area())
            {
                open.extend([(one.first + 1, b), (one.first, b)]);
            } else {
                open.extend([(a, other.first + 1), (a, other.first)]);
            }
        }
    }
}
