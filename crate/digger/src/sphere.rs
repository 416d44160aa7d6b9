//! Hart's sphere tracing: from each place a step of |F−T|/L, with L a Lipschitz constant of F,
//! cannot pass the surface, and such steps close in on it from one side.
//!
//! L holds for the stretch ahead that the step stays within, from bounds per primitive; the stretch
//! grows where steps would be longer and shrinks with them.
use crate::{Side, Sight};
use tracer::Quest;

/// The shortest step: a hit is this near to the surface, and no longer part of the ray is missed.
const SHORTEST_STEP: f64 = 1e-6;
/// Evaluations of a primitive (or 64 times the ray's primitives, if those are more) after which a
/// ray that creeps along the surface counts as a hit.
const MOST_SPHERE_LOOKS: usize = 1 << 16;

/// Finds the first crossing that the quest asks for.
pub(crate) fn first(sight: &mut Sight<'_>, quest: Quest) -> Option<f64> {
    let [mut at, to] = sight.range;
    let mut ahead = (to - at) / 16.0;
    let mut side = Side::unknown(quest);
    let mut list: Vec<u32> = Vec::new();
    let (mut looks, most) = (0, MOST_SPHERE_LOOKS.max(64 * sight.terms.len()));
    while looks < most {
        if at >= to {
            return None;
        }
        let end = (at + ahead).min(to);
        list.clear();
        let terms = sight.terms.iter().enumerate();
        list.extend(
            terms
                .filter(|(_, term)| term.meets(at, end))
                .map(|(i, _)| i as u32),
        );
        looks += 1 + list.len();
        let value = sight.excess_of(&list, at).0;
        if side.arrive(value > 0.0) {
            return Some(at);
        }
        let (rate, _) = sight.lipschitz(&list, [at, end], false);
        let safe = value.abs() / rate;
        if safe >= end - at {
            at = end;
            ahead *= 2.0;
        } else {
            // NaN if both are infinite, near a pole.
            let step = safe.max(SHORTEST_STEP);
            at += step;
            ahead = 2.0 * step;
        }
    }
    Some(at)
}
