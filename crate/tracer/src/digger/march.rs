//! Marching: equal steps along a ray until the field changes its sign (the "hill climbing" and "ray
//! marching" of the literature, with a step that suits the kernels). What refines the root is the
//! caller's choice.
use super::{Side, Sight};
use crate::walk::Quest;

/// Steps in the length on which the sharpest kernel changes. A surface may be missed where the ray is
/// inside it for less than a step.
const STEPS: f64 = 8.0;
/// Most steps on a ray: so many, but fewer where it meets very many primitives, so that it looks at
/// no more than about [`MOST_LOOKS`] of them, or 64 times at each.
const MOST: usize = 4096;
/// See [`MOST`].
const MOST_LOOKS: usize = 1 << 18;
/// How exactly roots are refined.
pub(super) const TOLERANCE: f64 = 1e-9;
/// Most evaluations while refining a root.
pub(super) const MOST_REFINING: usize = 100;

/// The length of a step.
pub(super) fn step(sight: &Sight<'_>) -> f64 {
    let [from, to] = sight.range;
    let most = (MOST_LOOKS / sight.terms.len().max(1)).clamp(64, MOST);
    (sight.finest() / STEPS).max((to - from) / most as f64)
}

/// The ends of an interval and the values there, which have different signs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bracket {
    pub ends: [f64; 2],
    pub values: [f64; 2],
}

/// Marches to the first change of sign that the quest asks for, and has it refined.
pub(super) fn march(
    sight: &mut Sight<'_>,
    quest: Quest,
    refine: impl Fn(&mut dyn FnMut(f64) -> f64, Bracket) -> f64,
) -> Option<f64> {
    let [from, to] = sight.range;
    let step = step(sight);
    let mut side = Side::unknown(quest);
    let mut at = from;
    let mut value = sight.excess(at).0;
    side.arrive(value > 0.0);
    while at < to {
        let next = (at + step).min(to);
        let there = sight.excess(next).0;
        if side.arrive(there > 0.0) {
            let bracket = Bracket {
                ends: [at, next],
                values: [value, there],
            };
            return Some(refine(&mut |t| sight.excess(t).0, bracket));
        }
        (at, value) = (next, there);
    }
    None
}
