//! Marching: equal steps along a ray until the field changes its sign (the "hill climbing" and "ray
//! marching" of the literature, with a step that suits the kernels). The caller chooses the method
//! that refines the root.
use crate::{Side, Sight};
use tracer::Quest;

/// Number of steps in the length on which the sharpest kernel changes. A surface may be missed
/// where the ray is inside it for less than a step.
const STEPS: f64 = 8.0;
/// Most steps on a ray.
const MOST_MARCH_STEPS: usize = 4096;
/// Most evaluations on a ray, about, except that each primitive may be evaluated 64 times.
const MOST_MARCH_LOOKS: usize = 1 << 18;
/// Accuracy of refined roots.
pub(crate) const TOLERANCE: f64 = 1e-9;
/// Most evaluations while refining a root.
pub(crate) const MOST_REFINING: usize = 100;

/// Returns the length of a step.
pub(crate) fn step(sight: &Sight<'_>) -> f64 {
    let [from, to] = sight.range;
    let most = (MOST_MARCH_LOOKS / sight.terms.len().max(1)).clamp(64, MOST_MARCH_STEPS);
    (sight.finest() / STEPS).max((to - from) / most as f64)
}

/// The ends of an interval and the values there, which have different signs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bracket {
    pub ends: [f64; 2],
    pub values: [f64; 2],
}

/// Marches to the first change of sign that the quest asks for, and refines the root there.
pub(crate) fn march(
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{brent, regula_falsi, ridder};

    type Refine = fn(&mut dyn FnMut(f64) -> f64, Bracket) -> f64;
    type Function = fn(f64) -> f64;

    #[test]
    fn roots_in_brackets_are_refined_whatever_the_function() {
        // Functions, the root between 0 and 1, and the accuracy to expect of a method that stops
        // when its steps become small.
        let functions: [(Function, f64, f64); 8] = [
            (|t| t - 0.3, 0.3, 1e-8),
            (|t| 0.3 - t, 0.3, 1e-8),
            (|t| t * t * t - 0.125, 0.5, 1e-8),
            // The chord's root is the middle, the function's is not.
            (|t| if t < 0.8 { t - 0.8 } else { 4.0 * t - 3.2 }, 0.8, 1e-8),
            (|t| libm::exp(20.0 * t) - libm::exp(14.0), 0.7, 1e-7),
            (|t| libm::tanh(1e3 * (t - 0.9)), 0.9, 1e-7),
            // Flat at its root, which is then inaccurate.
            (|t| (t - 0.4) * (t - 0.4) * (t - 0.4), 0.4, 1e-3),
            // Infinite at one end, as at a pole.
            (
                |t| if t >= 1.0 { f64::INFINITY } else { t - 0.6 },
                0.6,
                1e-8,
            ),
        ];
        let methods: [(&str, Refine); 3] = [
            ("brent", brent::refine),
            ("ridder", ridder::refine),
            ("RF", regula_falsi::refine),
        ];
        for (name, refine) in methods {
            for (i, (f, root, near)) in functions.into_iter().enumerate() {
                let mut evaluations = 0;
                let bracket = Bracket {
                    ends: [0.0, 1.0],
                    values: [f(0.0), f(1.0)],
                };
                let found = refine(
                    &mut |t| {
                        evaluations += 1;
                        f(t)
                    },
                    bracket,
                );
                assert!((found - root).abs() <= near, "{name} {i}: {found}");
                assert!(evaluations <= MOST_REFINING, "{name} {i}: {evaluations}");
            }
        }
    }
}
