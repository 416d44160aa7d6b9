//! Groups of pieces, and a tree of them: bounds on the sum of all fields that need no look at
//! single pieces.
use super::{Local, Piece};
use crate::{Ball, Kernel};

/// Pieces of a leaf of the tree.
const LEAF: usize = 4;
/// Ratio of a group's radius to its distance above which the group is opened.
const NEAR: f64 = 0.35;

/// Group of pieces: their field is at most `mass` times the kernel at their distance.
#[derive(Clone, Copy, Debug)]
pub(super) struct Group {
    pub ball: Ball,
    pub mass: f64,
    pub width: f64,
    pub kernel: Kernel,
}

/// A node of the tree.
#[derive(Clone, Copy, Debug)]
pub(super) enum Node {
    /// Pieces.
    Leaf([u32; 2]),
    /// The number of its second half; the first one follows.
    Halves(u32),
}

impl Group {
    /// Returns an upper bound on its field at a distance from its ball.
    pub fn most(&self, distance: f64) -> f64 {
        self.mass * self.kernel.value(distance.max(0.0) * self.width)
    }

    pub fn join(self, other: Self) -> Self {
        Self {
            ball: self.ball.around(&other.ball),
            mass: self.mass + other.mass,
            width: self.width.min(other.width),
            ..self
        }
    }

    /// Distance of a ball from its own.
    pub fn distance(&self, ball: &Ball) -> f64 {
        (self.ball.center.distance(ball.center) - self.ball.radius - ball.radius).max(0.0)
    }
}

impl Piece {
    pub(super) fn group(&self) -> Option<Group> {
        let (center, radius) = self.primitive.skeleton.bounding_sphere()?;
        let [mass, width] = self.bound.far();
        Some(Group {
            ball: Ball {
                center,
                radius: radius * (1.0 + 1e-12),
            },
            mass,
            width,
            kernel: self.primitive.kernel,
        })
    }
}

impl Local {
    /// Makes the tree over some pieces; returns its number.
    pub(super) fn plant(&mut self, groups: &[Group], [from, to]: [u32; 2]) -> Option<u32> {
        let own = &groups[from as usize..to as usize];
        let group = own.iter().copied().reduce(Group::join)?;
        let number = self.tree.len();
        self.tree.push((group, Node::Leaf([from, to])));
        if own.len() > LEAF {
            let middle = (from + to) / 2;
            self.plant(groups, [from, middle]);
            let second = self.plant(groups, [middle, to])?;
            self.tree[number].1 = Node::Halves(second);
        }
        Some(number as u32)
    }

    /// Bound on the sum of all pieces' fields in a ball, which is no less than the field.
    pub(super) fn everything(&self, ball: &Ball) -> f64 {
        let mut sum = 0.0;
        let mut waiting = vec![0u32];
        while let Some(number) = waiting.pop() {
            let Some((group, node)) = self.tree.get(number as usize) else {
                continue;
            };
            let distance = group.distance(ball);
            match node {
                _ if group.ball.radius < NEAR * distance => sum += group.most(distance),
                Node::Halves(second) => waiting.extend([*second, number + 1]),
                Node::Leaf([from, to]) => {
                    for piece in &self.pieces[*from as usize..*to as usize] {
                        let near = piece.bound.nearness(ball.center, ball.radius);
                        sum += piece.bound.magnitude(near);
                    }
                }
            }
        }
        sum
    }
}
