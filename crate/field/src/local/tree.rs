//! A tree of pieces: bounds on the sum of all fields that need no look at single pieces.
use super::Piece;
use crate::{Ball, Kernel};

/// Pieces of a leaf of the tree.
const LEAF: u32 = 4;
/// Ratio of a group's radius to its distance above which the group is opened.
const NEAR: f64 = 0.35;

/// A group of pieces: their field is at most `mass` times the kernel at their distance.
#[derive(Clone, Copy, Debug)]
struct Group {
    ball: Ball,
    mass: f64,
    width: f64,
    kernel: Kernel,
}

/// The tree of all pieces, halved again and again: a group is followed by its first half.
#[derive(Clone, Debug)]
pub(super) struct Tree(Vec<(Group, Node)>);

/// A node of the tree.
#[derive(Clone, Copy, Debug)]
enum Node {
    /// Pieces.
    Leaf([u32; 2]),
    /// The number of its second half.
    Halves(u32),
}

impl Group {
    fn of(piece: &Piece) -> Option<Self> {
        let groups = piece.parts.iter().map(|(primitive, bound)| {
            let (center, radius) = primitive.skeleton.bounding_sphere()?;
            let [mass, width] = bound.far();
            Some(Self {
                ball: Ball {
                    center,
                    radius: radius * (1.0 + 1e-12),
                },
                mass,
                width,
                kernel: primitive.kernel,
            })
        });
        let groups = groups.collect::<Option<Vec<_>>>()?;
        groups.into_iter().reduce(Self::join)
    }

    fn join(self, other: Self) -> Self {
        Self {
            ball: self.ball.around(&other.ball),
            mass: self.mass + other.mass,
            width: self.width.min(other.width),
            ..self
        }
    }
}

impl Tree {
    /// Makes the tree of some pieces; `None` if one of them has no end.
    pub fn new(pieces: &[Piece]) -> Option<Self> {
        let groups = pieces.iter().map(Group::of).collect::<Option<Vec<_>>>()?;
        let mut tree = Self(Vec::new());
        tree.plant(&groups, [0, groups.len() as u32]);
        Some(tree)
    }

    fn plant(&mut self, groups: &[Group], [from, to]: [u32; 2]) -> Option<u32> {
        let own = &groups[from as usize..to as usize];
        let group = own.iter().copied().reduce(Group::join)?;
        let number = self.0.len();
        self.0.push((group, Node::Leaf([from, to])));
        if to - from > LEAF {
            let middle = from.midpoint(to);
            self.plant(groups, [from, middle]);
            let second = self.plant(groups, [middle, to])?;
            self.0[number].1 = Node::Halves(second);
        }
        Some(number as u32)
    }

    /// Returns a bound on the sum of all pieces' fields in a ball; any number that is no less than
    /// `enough`, if the bound is.
    pub fn most(&self, pieces: &[Piece], ball: &Ball, enough: f64) -> f64 {
        let mut sum = 0.0;
        let mut waiting = vec![0u32];
        while let Some(number) = waiting.pop() {
            if sum >= enough {
                break;
            }
            let Some((group, node)) = self.0.get(number as usize) else {
                continue;
            };
            let distance = group.ball.center.distance(ball.center);
            let distance = (distance - group.ball.radius - ball.radius).max(0.0);
            match node {
                _ if group.ball.radius < NEAR * distance => {
                    sum += group.mass * group.kernel.value(distance * group.width);
                }
                Node::Halves(second) => waiting.extend([*second, number + 1]),
                Node::Leaf([from, to]) => {
                    let pieces = &pieces[*from as usize..*to as usize];
                    sum += pieces.iter().map(|piece| piece.most(ball)).sum::<f64>();
                }
            }
        }
        sum
    }
}
