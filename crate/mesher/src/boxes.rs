//! A hierarchy of boxes that come and go, for queries while a mesh changes.

use glam::DVec3;
use mesh::Aabb;

/// No node.
const NONE: u32 = u32::MAX;

#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: Aabb,
    parent: u32,
    /// Both children; in a leaf `NONE` and the number of its item.
    children: [u32; 2],
}

/// Boxes of numbered items. Queries do not depend on the order of the changes, only their time
/// does.
#[derive(Debug, Default)]
pub struct Boxes {
    nodes: Vec<Node>,
    free: Vec<u32>,
    root: Option<u32>,
    /// The leaf of each item.
    leaves: Vec<u32>,
}

impl Boxes {
    /// A balanced hierarchy of numbered boxes.
    pub fn new(mut items: Vec<(u32, Aabb)>) -> Self {
        let mut all = Self::default();
        if items.is_empty() {
            return all;
        }
        // Ranges to divide, with the node that each becomes.
        let count = items.len();
        all.nodes.push(Node {
            bounds: Aabb::EMPTY,
            parent: NONE,
            children: [NONE; 2],
        });
        all.root = Some(0);
        let mut open = vec![(0_u32, 0, count)];
        while let Some((node, start, end)) = open.pop() {
            let range = &mut items[start..end];
            let bounds = range
                .iter()
                .fold(Aabb::EMPTY, |all, (_, own)| all.union(own));
            all.nodes[node as usize].bounds = bounds;
            if let [(item, _)] = *range {
                all.nodes[node as usize].children = [NONE, item];
                all.set_leaf(item, node);
                continue;
            }
            let centers = Aabb::of_points(range.iter().map(|(_, own)| own.center()));
            let axis = (centers.max - centers.min).max_position();
            let half = range.len() / 2;
            let place = |(i, own): &(u32, Aabb)| (own.center()[axis], *i);
            range.select_nth_unstable_by(half, |a, b| {
                let [(p, i), (q, j)] = [place(a), place(b)];
                p.total_cmp(&q).then(i.cmp(&j))
            });
            let first = all.nodes.len() as u32;
            let child = Node {
                bounds: Aabb::EMPTY,
                parent: node,
                children: [NONE; 2],
            };
            all.nodes.extend([child; 2]);
            all.nodes[node as usize].children = [first, first + 1];
            open.push((first + 1, start + half, end));
            open.push((first, start, start + half));
        }
        all
    }

    fn set_leaf(&mut self, item: u32, node: u32) {
        if self.leaves.len() <= item as usize {
            self.leaves.resize(item as usize + 1, NONE);
        }
        self.leaves[item as usize] = node;
    }

    fn add(&mut self, node: Node) -> u32 {
        match self.free.pop() {
            Some(i) => {
                self.nodes[i as usize] = node;
                i
            }
            None => {
                self.nodes.push(node);
                self.nodes.len() as u32 - 1
            }
        }
    }

    /// Gives an item a box, in place of the one it had.
    pub fn set(&mut self, item: u32, bounds: Aabb) {
        let known = self.leaves.get(item as usize).copied();
        if let Some(leaf) = known.filter(|leaf| *leaf != NONE) {
            // Edits are small: it stays where it is among the others.
            let node = &mut self.nodes[leaf as usize];
            node.bounds = bounds;
            let parent = node.parent;
            self.fit(parent);
            return;
        }
        let leaf = self.add(Node {
            bounds,
            parent: NONE,
            children: [NONE, item],
        });
        self.set_leaf(item, leaf);
        let Some(root) = self.root else {
            self.root = Some(leaf);
            return;
        };
        // Down to where boxes grow least.
        let mut beside = root;
        loop {
            let [a, b] = self.nodes[beside as usize].children;
            if a == NONE {
                break;
            }
            let growth = |node: u32| {
                let own = self.nodes[node as usize].bounds;
                half_area(&own.union(&bounds)) - half_area(&own)
            };
            beside = if growth(a) <= growth(b) { a } else { b };
        }
        let parent = self.nodes[beside as usize].parent;
        let joint = self.add(Node {
            bounds: self.nodes[beside as usize].bounds.union(&bounds),
            parent,
            children: [beside, leaf],
        });
        self.nodes[beside as usize].parent = joint;
        self.nodes[leaf as usize].parent = joint;
        self.replace(parent, beside, joint);
        self.fit(parent);
    }

    /// Puts a node in the place of a child of a parent, or of the root.
    fn replace(&mut self, parent: u32, old: u32, new: u32) {
        match self.nodes.get_mut(parent as usize) {
            Some(node) => {
                let side = usize::from(node.children[1] == old);
                node.children[side] = new;
            }
            None => self.root = Some(new),
        }
    }

    /// Fits the boxes from a node up to their children.
    fn fit(&mut self, mut node: u32) {
        while node != NONE {
            let [a, b] = self.nodes[node as usize].children;
            let [a, b] = [a, b].map(|i| self.nodes[i as usize].bounds);
            let bounds = a.union(&b);
            let own = &mut self.nodes[node as usize];
            if own.bounds == bounds {
                return;
            }
            own.bounds = bounds;
            node = own.parent;
        }
    }

    /// Removes an item, if it is there.
    pub fn remove(&mut self, item: u32) {
        let Some(leaf) = self.leaves.get(item as usize).copied() else {
            return;
        };
        if leaf == NONE {
            return;
        }
        self.leaves[item as usize] = NONE;
        self.free.push(leaf);
        let parent = self.nodes[leaf as usize].parent;
        if parent == NONE {
            self.root = None;
            return;
        }
        let Node {
            parent: above,
            children: [a, b],
            ..
        } = self.nodes[parent as usize];
        let other = if a == leaf { b } else { a };
        self.nodes[other as usize].parent = above;
        self.free.push(parent);
        self.replace(above, parent, other);
        self.fit(above);
    }

    /// Adds all items whose box touches this one.
    pub fn touching(&self, bounds: &Aabb, out: &mut Vec<u32>) {
        let mut open: Vec<u32> = self.root.into_iter().collect();
        while let Some(node) = open.pop() {
            let node = &self.nodes[node as usize];
            if !node.bounds.overlaps(bounds) {
                continue;
            }
            match node.children {
                [NONE, item] => out.push(item),
                children => open.extend(children),
            }
        }
    }
}

fn half_area(bounds: &Aabb) -> f64 {
    let DVec3 { x, y, z } = bounds.size();
    x * y + y * z + z * x
}

#[cfg(test)]
mod tests {
    use super::*;
    use trials::Random;

    #[test]
    fn queries_find_what_a_list_finds() {
        let mut random = Random::new(5);
        let mut a_box = || {
            let corner = random.vector(0.5);
            Aabb::of_points([corner, corner + 0.1 + random.vector(0.1)])
        };
        for boxes in [0, 1, 2, 40] {
            let mut list: Vec<Option<Aabb>> = (0..boxes).map(|_| Some(a_box())).collect();
            let start = (0..).zip(list.iter().flatten().copied()).collect();
            let mut boxes = Boxes::new(start);
            for step in 0..300 {
                let item = step * 7 % 60;
                list.resize(list.len().max(item + 1), None);
                list[item] = if step % 3 == 0 { None } else { Some(a_box()) };
                match list[item] {
                    Some(bounds) => boxes.set(item as u32, bounds),
                    None => boxes.remove(item as u32),
                }
                let around = a_box();
                let mut found = Vec::new();
                boxes.touching(&around, &mut found);
                found.sort_unstable();
                let touches = |i: &u32| list[*i as usize].is_some_and(|own| own.overlaps(&around));
                let expected: Vec<u32> = (0..list.len() as u32).filter(touches).collect();
                assert_eq!(found, expected);
            }
            assert!(list.iter().flatten().count() > 20);
        }
    }
}
