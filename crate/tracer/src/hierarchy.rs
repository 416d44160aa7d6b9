//! A hierarchy of bounding balls: finds the few of many things that a beam may meet.
use crate::beam::Beam;
use field::Cut;
use glam::DVec3;
use wide::f64x4;

/// A binary tree of balls over items that each have a ball.
#[derive(Clone, Debug, Default)]
pub struct Hierarchy {
    nodes: Vec<Node>,
    /// The items' balls, in the tree's order.
    balls: Vec<(DVec3, f64)>,
    /// The items' own numbers, in the tree's order.
    items: Vec<u32>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    center: DVec3,
    radius: f64,
    /// First item below this node, and how many.
    first: u32,
    count: u32,
    /// The right child; the left one follows its parent. 0 in a leaf.
    right: u32,
}

/// Items in a leaf.
const LEAF: usize = 8;

impl Hierarchy {
    /// Builds the tree over items given as (number, centre, radius).
    #[must_use]
    pub fn new(items: Vec<(u32, DVec3, f64)>) -> Self {
        Self::with_leaves(items, LEAF)
    }

    /// Builds the tree with up to `leaf` items in a leaf.
    #[must_use]
    pub fn with_leaves(mut items: Vec<(u32, DVec3, f64)>, leaf: usize) -> Self {
        let mut nodes = Vec::new();
        if !items.is_empty() {
            build(&mut items, 0, leaf, &mut nodes);
        }
        Self {
            nodes,
            balls: items.iter().map(|i| (i.1, i.2)).collect(),
            items: items.iter().map(|i| i.0).collect(),
        }
    }

    /// Returns the tree with larger balls. `radius` returns the new radius of an item, at least the
    /// old one, from its number, centre and radius. A node's ball grows as much as the one below it
    /// that grows most.
    #[must_use]
    pub fn enlarge(&self, radius: impl Fn(u32, DVec3, f64) -> f64) -> Self {
        let mut tree = self.clone();
        let mut growth = vec![0.0f64; tree.nodes.len()];
        // Children come after their parents.
        for index in (0..tree.nodes.len()).rev() {
            let node = tree.nodes[index];
            growth[index] = if node.right == 0 {
                let below = node.first as usize..(node.first + node.count) as usize;
                let items = tree.items[below.clone()].iter();
                let mut most: f64 = 0.0;
                for (&i, (center, r)) in items.zip(&mut tree.balls[below]) {
                    let before = *r;
                    *r = radius(i, *center, before);
                    most = most.at_least(*r - before);
                }
                most
            } else {
                growth[index + 1].at_least(growth[node.right as usize])
            };
            tree.nodes[index].radius += growth[index];
        }
        tree
    }

    /// Returns the number of nodes; node 0 is the root.
    #[must_use]
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Returns the ball of a node.
    #[inline]
    #[must_use]
    pub fn ball(&self, node: usize) -> (DVec3, f64) {
        let node = &self.nodes[node];
        (node.center, node.radius)
    }

    /// Returns the numbers of the items below a node.
    #[must_use]
    pub fn items(&self, node: usize) -> &[u32] {
        let node = &self.nodes[node];
        &self.items[node.first as usize..(node.first + node.count) as usize]
    }

    /// Returns the children of a node; `None` for a leaf.
    #[must_use]
    pub fn children(&self, node: usize) -> Option<[usize; 2]> {
        let right = self.nodes[node].right;
        (right != 0).then_some([node + 1, right as usize])
    }

    /// Calls `found` with the number and ball of each item whose ball the beam may meet.
    pub fn search(&self, beam: &Beam, found: impl FnMut(u32, DVec3, f64)) {
        self.select(|center, radius| beam.meets(center, radius), found);
    }

    /// Calls `found` with the number and ball of each item whose ball meets a ball.
    pub fn around(&self, middle: DVec3, reach: f64, found: impl FnMut(u32, DVec3, f64)) {
        self.select(
            |center, radius| {
                let both = radius + reach;
                center.distance_squared(middle) <= both * both * (1.0 + 1e-9)
            },
            found,
        );
    }

    /// Calls `found` with the number and ball of each item for whose ball, and those of the nodes
    /// above it, `meets` is true.
    fn select(&self, meets: impl Fn(DVec3, f64) -> bool, mut found: impl FnMut(u32, DVec3, f64)) {
        // The tree halves its items at each level, so 32 levels hold 2³² of them.
        let mut stack = [0u32; 64];
        let mut depth = usize::from(!self.nodes.is_empty());
        while depth > 0 {
            depth -= 1;
            let index = stack[depth];
            let node = &self.nodes[index as usize];
            if !meets(node.center, node.radius) {
                continue;
            }
            if node.right == 0 {
                for i in node.first as usize..(node.first + node.count) as usize {
                    let (center, radius) = self.balls[i];
                    if node.count == 1 || meets(center, radius) {
                        found(self.items[i], center, radius);
                    }
                }
            } else {
                stack[depth] = node.right;
                stack[depth + 1] = index + 1;
                depth += 2;
            }
        }
    }
}

/// Returns a ball around some balls, and the extent of their middles along each axis.
fn around(items: &[(u32, DVec3, f64)]) -> (DVec3, f64, DVec3) {
    // By lanes: a scalar minimum compiles to an unpredictable branch in wasm.
    let far = f64x4::splat(f64::INFINITY);
    let mut middles = [far, -far];
    let mut hull = [far, -far];
    for (_, center, radius) in items {
        let center = f64x4::new([center.x, center.y, center.z, 0.0]);
        let radius = f64x4::splat(*radius);
        middles = [lesser(center, middles[0]), greater(center, middles[1])];
        hull = [
            lesser(center - radius, hull[0]),
            greater(center + radius, hull[1]),
        ];
    }
    let [low, high] = hull.map(vector);
    let center = 0.5 * (low + high);
    let radius = items.iter().fold(0.0f64, |most, (_, other, radius)| {
        let square = other.distance_squared(center);
        let room = most - radius;
        // Roots take time, and most balls are well inside.
        if room >= 0.0 && square <= room * room {
            most
        } else {
            most.at_least(square.sqrt() + radius)
        }
    });
    (center, radius, vector(middles[1] - middles[0]))
}

#[inline(always)]
fn lesser(a: f64x4, b: f64x4) -> f64x4 {
    a.simd_lt(b).select(a, b)
}

#[inline(always)]
fn greater(a: f64x4, b: f64x4) -> f64x4 {
    b.simd_lt(a).select(a, b)
}

fn vector(lanes: f64x4) -> DVec3 {
    let [x, y, z, _] = lanes.to_array();
    DVec3::new(x, y, z)
}

/// Appends the nodes of a tree over items, which are numbered from `first` on in the whole tree,
/// and puts the items in the tree's order.
fn build(items: &mut [(u32, DVec3, f64)], first: u32, leaf: usize, nodes: &mut Vec<Node>) {
    let (center, radius, extent) = around(items);
    let index = nodes.len();
    nodes.push(Node {
        center,
        radius,
        first,
        count: items.len() as u32,
        right: 0,
    });
    if items.len() <= leaf {
        return;
    }
    let axis = (0..3)
        .max_by(|&a, &b| extent[a].total_cmp(&extent[b]))
        .unwrap_or(0);
    let half = items.len() / 2;
    // Equal centres are ordered by number, so that the tree is the same everywhere.
    items.select_nth_unstable_by(half, |a, b| {
        a.1[axis].total_cmp(&b.1[axis]).then(a.0.cmp(&b.0))
    });
    let (left, right) = items.split_at_mut(half);
    build(left, first, leaf, nodes);
    nodes[index].right = nodes.len() as u32;
    build(right, first + half as u32, leaf, nodes);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ray::Ray;
    use trials::Random;

    #[test]
    fn a_search_finds_what_a_full_scan_finds() {
        let mut random = Random::new(3);
        let items: Vec<_> = (0..500)
            .map(|i| {
                let c = random.vector(1.0);
                (i, c, 0.1 * random.unit())
            })
            .collect();
        let tree = Hierarchy::new(items.clone());
        for case in 0..trials::count(200) {
            let beam = Beam {
                axis: Ray {
                    origin: random.vector(1.0) * 3.0,
                    direction: random.direction(),
                },
                radius: if case % 2 == 0 { 0.0 } else { 0.05 },
                spread: 0.05 * random.unit(),
                ahead: 0.0,
            };
            let mut found = Vec::new();
            tree.search(&beam, |i, _, _| found.push(i));
            found.sort_unstable();
            let scanned: Vec<u32> = items
                .iter()
                .filter(|i| beam.meets(i.1, i.2))
                .map(|i| i.0)
                .collect();
            // The tree may skip items that a beam grazes by rounding only; it must find the rest.
            for i in &scanned {
                let (_, c, r) = items[*i as usize];
                assert!(found.contains(i) || !beam.meets(c, r * (1.0 - 1e-6)));
            }
            assert!(found.iter().all(|i| scanned.contains(i)));
            // Against points of the beam's own rays.
            for &(i, c, r) in &items {
                let t = (c - beam.axis.origin).dot(beam.axis.direction).max(0.0);
                if beam.axis.at(t).distance(c) < r + (beam.radius + beam.spread * t) * 0.99 {
                    assert!(found.contains(&i));
                }
            }
        }
    }

    #[test]
    fn balls_of_nodes_hold_all_below_also_with_other_radii() {
        let mut numbers = Random::new(5);
        let items: Vec<_> = (0..300)
            .map(|i| (i, numbers.vector(1.0), 0.1 * numbers.unit()))
            .collect();
        let mut larger = items.clone();
        for (i, _, radius) in &mut larger {
            *radius *= f64::from(1 + *i % 5);
        }
        let tree = Hierarchy::new(items.clone());
        let other = tree.enlarge(|i, center, radius| {
            assert_eq!((i, center, radius), items[i as usize]);
            larger[i as usize].2
        });
        // Radius of the loosest ball of a node over the least radius that would do.
        let [loosest, loosest_of_larger] =
            [(&tree, &items), (&other, &larger)].map(|(tree, items)| {
                let mut loosest = 0.0f64;
                for node in 0..tree.len() {
                    let (center, around) = tree.ball(node);
                    let below = tree.items(node).iter().map(|&i| items[i as usize]);
                    let most = below.map(|(_, place, radius)| place.distance(center) + radius);
                    let most = most.fold(0.0, f64::max);
                    assert!(most < around + 1e-12, "{node}: {around} {most}");
                    loosest = loosest.max(around - most);
                }
                loosest
            });
        assert!(loosest < 1e-12);
        // The largest is 5 times its ball.
        assert!(
            (1e-3..0.4).contains(&loosest_of_larger),
            "{loosest_of_larger}"
        );
        assert_eq!(tree.items(0), other.items(0));
    }

    #[test]
    fn items_around_a_ball_are_those_that_meet_it() {
        let mut random = Random::new(8);
        let items: Vec<_> = (0..400)
            .map(|i| {
                let c = random.vector(1.0);
                (i, c, 0.2 * random.unit())
            })
            .collect();
        let tree = Hierarchy::new(items.clone());
        let mut all = 0;
        for _ in 0..trials::count(200) {
            let (middle, reach) = (random.vector(1.0), 0.3 * random.unit());
            let mut found = Vec::new();
            tree.around(middle, reach, |i, center, radius| {
                assert_eq!((i, center, radius), items[i as usize]);
                found.push(i);
            });
            found.sort_unstable();
            let scanned = items.iter().filter(|i| i.1.distance(middle) <= i.2 + reach);
            assert!(scanned.map(|i| i.0).eq(found.iter().copied()), "{found:?}");
            all += found.len();
        }
        assert!(all > trials::count(500), "{all}");
    }

    #[test]
    fn an_empty_tree_and_a_tree_of_equal_balls_work() {
        let beam = Beam::of_ray(Ray {
            origin: DVec3::ZERO,
            direction: DVec3::X,
        });
        Hierarchy::new(Vec::new()).search(&beam, |_, _, _| panic!("nothing to find"));
        let tree = Hierarchy::new((0..1000).map(|i| (i, DVec3::X, 0.0)).collect());
        let mut n = 0;
        tree.search(&beam, |_, _, _| n += 1);
        assert_eq!(n, 1000);
    }
}
