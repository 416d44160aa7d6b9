//! Groups of neighbouring primitives with common bounds by distance.
//!
//! Groups form a binary tree. Each has a ball that holds its members' skeletons, and a table of
//! bounds on the sums of the members' fields and of their fourth derivatives, by distance from the
//! ball. So a distant group is dropped or interpolated as a whole, however many members it has.
use crate::hierarchy::Hierarchy;
use field::Cut;
use field::bound::{Bound, Nearness, SpanLength};
use glam::DVec3;

/// Entries of a table in an octave of distances.
const STEPS: usize = 4;
/// Exponent of the second entry's distance, 2 to this power. The first entry is for distance 0.
const FIRST: i32 = -10;
/// Number of octaves from there on; they end at distance 4, and the scene's size is between 2 and
/// 4.
const OCTAVES: usize = 12;
/// Number of entries beyond the octaves, each for twice the distance of the one before: kernels
/// that fall slowly have surfaces far from all elements.
const FAR_ENTRIES: usize = 12;
/// Index of the entry for the distance at which the octaves end.
const LAST: usize = 1 + OCTAVES * STEPS;
/// Number of entries of a table.
const ENTRIES: usize = LAST + 1 + FAR_ENTRIES;

/// Most members of a leaf group.
const GROUP_SIZE: usize = 16;

/// The tree of groups.
pub struct Clusters {
    tree: Hierarchy,
    facts: Vec<Facts>,
}

/// Bounds on a group.
#[derive(Clone, Debug)]
struct Facts {
    /// Bounds on the sums of the members' fields and of their fourth derivatives, by distance.
    table: [[f32; 2]; ENTRIES],
    /// Largest relative slope, |slope|/field, of a member where its field is not negligible.
    steep: f32,
    /// Largest [`Bound::power`] of a member: no relative slope exceeds that over the distance.
    power: f32,
    /// Sum of the members' [`Bound::cancels`].
    cancels: f32,
    /// Largest [`Bound::log_bend`] of a member.
    log_bend: f32,
    adds: bool,
    carves: bool,
}

/// A group as seen from a ball.
#[derive(Clone, Copy, Debug)]
pub struct GroupView {
    /// Bound on the sum of the members' fields.
    pub magnitude: f64,
    /// Bound on the fourth derivative of their sum along any line; infinite if unknown.
    pub fourth: f64,
    /// Distance from the nearest member, or less.
    pub distance: f64,
    /// Whether it is so near that its parts are examined instead.
    pub near: bool,
    /// Number of members.
    pub count: usize,
    /// Whether some may be positive.
    pub adds: bool,
    /// Whether some may be negative.
    pub carves: bool,
}

/// Parts of a group.
pub enum Members<'a> {
    /// Numbers of two groups.
    Groups([u32; 2]),
    /// Numbers of primitives.
    Primitives(&'a [u32]),
}

/// Ratio of distance to radius up to which a group is near.
const NEAR: f64 = 2.0;
/// Ratio of a group's radius to that of the ball it is seen from below which the group is not near:
/// its parts look no different from there.
const WIDE_VIEW: f64 = 0.3;

impl Clusters {
    /// Builds the groups of primitives, given as (number, centre, radius) of balls that hold their
    /// skeletons.
    #[must_use]
    pub fn new(balls: Vec<(u32, DVec3, f64)>, bounds: &[Bound]) -> Self {
        let tree = Hierarchy::with_leaves(balls, GROUP_SIZE);
        let mut facts: Vec<Facts> = Vec::with_capacity(tree.len());
        facts.resize(tree.len(), Facts::NONE);
        // Children come after their parents.
        for index in (0..tree.len()).rev() {
            facts[index] = match tree.children(index) {
                Some([left, right]) => facts[left].plus(&facts[right]),
                None => Facts::of(tree.items(index).iter().map(|&i| &bounds[i as usize])),
            };
        }
        Self { tree, facts }
    }

    /// Returns the group of all primitives; `None` without primitives.
    #[must_use]
    pub fn root(&self) -> Option<u32> {
        (self.tree.len() > 0).then_some(0)
    }

    /// Returns the bounds on a group as seen from a ball.
    #[inline]
    #[must_use]
    pub fn view(&self, cluster: u32, center: DVec3, radius: f64) -> GroupView {
        let index = cluster as usize;
        let (own, around) = self.tree.ball(index);
        let distance = (center.distance(own) - radius - around).at_least(0.0);
        let facts = &self.facts[index];
        let [magnitude, fourth] = facts.table[entry(distance)].map(f64::from);
        GroupView {
            magnitude,
            fourth,
            distance,
            near: distance <= NEAR * around && around > WIDE_VIEW * radius,
            count: self.tree.items(index).len(),
            adds: facts.adds,
            carves: facts.carves,
        }
    }

    /// Estimates the largest relative slope, |slope|/field, of a group's members at a distance.
    #[must_use]
    pub fn relative_slope(&self, cluster: u32, distance: f64) -> f64 {
        let facts = &self.facts[cluster as usize];
        f64::from(facts.steep).at_most(f64::from(facts.power) / distance)
    }

    /// Returns the sum of the members' [`Bound::cancels`].
    #[must_use]
    pub fn cancels(&self, cluster: u32) -> f64 {
        f64::from(self.facts[cluster as usize].cancels)
    }

    /// Returns the largest [`Bound::log_bend`] of a group's members, or little more.
    #[must_use]
    pub fn log_bend(&self, cluster: u32) -> f64 {
        f64::from(self.facts[cluster as usize].log_bend)
    }

    /// Returns a group's parts.
    #[must_use]
    pub fn members(&self, cluster: u32) -> Members<'_> {
        match self.tree.children(cluster as usize) {
            Some(children) => Members::Groups(children.map(|c| c as u32)),
            None => Members::Primitives(self.tree.items(cluster as usize)),
        }
    }

    /// Returns the numbers of all primitives of a group.
    #[must_use]
    pub fn all(&self, cluster: u32) -> &[u32] {
        self.tree.items(cluster as usize)
    }
}

/// Returns the table entry of the largest listed distance that is at most `distance`.
#[inline]
fn entry(distance: f64) -> usize {
    // From the exponent and the first bits of the mantissa.
    let from = (1023 + i64::from(FIRST)) << 2;
    let place = (distance.to_bits() >> 50) as i64 - from;
    let last = LAST as i64;
    if place < last {
        return (place + 1).max(0) as usize;
    }
    (last + (place + 1 - last) / STEPS as i64).min(ENTRIES as i64 - 1) as usize
}

/// Returns the distance that a table entry is for.
fn place(entry: usize) -> f64 {
    match entry.checked_sub(1) {
        None => 0.0,
        Some(_) if entry > LAST => libm::exp2(f64::from(FIRST) + (OCTAVES + entry - LAST) as f64),
        Some(i) => {
            let (octave, step) = (i / STEPS, i % STEPS);
            libm::exp2(f64::from(FIRST) + octave as f64) * (1.0 + step as f64 / STEPS as f64)
        }
    }
}

impl Facts {
    const NONE: Self = Self {
        table: [[0.0; 2]; ENTRIES],
        steep: 0.0,
        power: 0.0,
        cancels: 0.0,
        log_bend: 0.0,
        adds: false,
        carves: false,
    };

    fn of<'b>(members: impl Iterator<Item = &'b Bound>) -> Self {
        let length = SpanLength::new(1.0);
        members.fold(Self::NONE, |sum, bound| {
            let mut own = Self {
                steep: bound.relative_slope(Nearness::at(0.0)) as f32,
                power: bound.power() as f32,
                cancels: bound.cancels() as f32 * (1.0 + 1e-6),
                log_bend: bound.log_bend() as f32 * (1.0 + 1e-6),
                adds: bound.adds(),
                carves: bound.carves(),
                ..Self::NONE
            };
            for (i, entry) in own.table.iter_mut().enumerate() {
                let estimate = bound.estimate(Nearness::at(place(i)), &length);
                // NaN becomes infinity: no bound.
                *entry = [estimate.magnitude, estimate.fourth]
                    .map(|x| if x.is_nan() { f32::INFINITY } else { x as f32 });
            }
            sum.plus(&own)
        })
    }

    fn plus(&self, other: &Self) -> Self {
        Self {
            table: core::array::from_fn(|i| {
                core::array::from_fn(|k| add_upwards(self.table[i][k], other.table[i][k]))
            }),
            steep: self.steep.max(other.steep),
            power: self.power.max(other.power),
            cancels: add_upwards(self.cancels, other.cancels),
            log_bend: self.log_bend.max(other.log_bend),
            adds: self.adds || other.adds,
            carves: self.carves || other.carves,
        }
    }
}

/// Returns a sum, or a little more: sums are rounded, and those of bounds stay bounds.
fn add_upwards(a: f32, b: f32) -> f32 {
    (a + b) * (1.0 + 1e-6)
}

#[cfg(test)]
mod tests {
    use super::*;
    use field::{Kernel, Primitive, Shaping, Skeleton};
    use trials::Random;

    /// Tables bound their groups' sums, tightly for distant groups.
    #[test]
    fn a_view_bounds_what_a_group_adds_up_to() {
        let mut random = Random::new(5);
        let primitives: Vec<Primitive> = (0..60)
            .map(|i| {
                let center = random.vector(0.5) + 0.5;
                let shaping = Shaping {
                    kernel: [Kernel::Cauchy, Kernel::Gauss, Kernel::Inverse, Kernel::Soft][i % 4],
                    radius: random.range(0.02, 0.12),
                    blobbiness: 1.0,
                    blob_scale: field::BlobScale::Relative,
                    strength: 1.0,
                    influence: 1e-3,
                    taper: None,
                };
                Primitive::new(Skeleton::Point { center }, &shaping, None).expect("flesh")
            })
            .collect();
        let bounds: Vec<Bound> = primitives.iter().map(Bound::new).collect();
        let balls = primitives
            .iter()
            .enumerate()
            .map(|(i, p)| {
                let (center, around) = p.bounding_sphere().expect("a point");
                (i as u32, center, around - p.influence)
            })
            .collect();
        let clusters = Clusters::new(balls, &bounds);
        let mut seen = 0;
        let mut groups = vec![clusters.root().expect("a group")];
        while let Some(group) = groups.pop() {
            match clusters.members(group) {
                Members::Groups(parts) => groups.extend(parts),
                Members::Primitives(members) => seen += members.len(),
            }
            for i in 0..60 {
                // The last twenty are at a distance of up to 10⁶.
                let far = match i {
                    0..40 => 4.0 * random.unit() * random.unit(),
                    _ => random.decades(0.0, 6.0),
                };
                let center = (random.vector(0.5) + 0.5) * (1.0 + far);
                let radius = 0.1 * random.unit();
                let view = clusters.view(group, center, radius);
                assert_eq!(view.count, clusters.all(group).len());
                let offset = random.direction();
                let at = (center + offset * radius).to_array();
                let all = clusters.all(group).iter();
                let sum: f64 = all.map(|&i| primitives[i as usize].value(at)).sum();
                assert!(sum <= view.magnitude, "{sum} {view:?}");
                if group == 0 && far > 2.0 && far < 1e4 {
                    // Of the kernels here the inverse counts most, and falls to a half from one far
                    // entry to the next.
                    assert!(view.magnitude < 8.0 * sum, "{sum} {view:?}");
                }
                assert!(place(entry(view.distance)) <= view.distance, "{view:?}");
            }
        }
        assert_eq!(seen, primitives.len());
    }
}
