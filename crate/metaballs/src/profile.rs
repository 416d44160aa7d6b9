//! The profile of a metaball.

use field::Real;

/// s from which the profile is 0: facets further than `ρ + CUT/k` do not act.
pub const CUT: f64 = 20.0;
/// s from which the profile falls faster than the exponential.
pub(crate) const FADE: f64 = 16.0;
/// |φ′| and |φ″| in times of `e^−s`, at most, where φ falls to 0.
pub(crate) const FADING: [f64; 2] = [1.47, 2.31];
/// s below which the profile is its tangent at this place.
pub(crate) const DEEP: f64 = -40.0;

/// Returns the profile φ(s) and its derivative, both continuous: `e^−s` for −40 ≤ s ≤ 16, times a
/// smooth step of the fifth degree that falls to 0 at [`CUT`], and its tangent at −40 below.
#[inline(always)]
#[must_use]
pub fn profile<R: Real>(s: R) -> (R, R) {
    let (zero, one) = (R::splat(0.0), R::splat(1.0));
    let shallow = s.max(R::splat(DEEP));
    let decay = shallow.decay();
    let value = decay * (one + (shallow - s));
    let width = CUT - FADE;
    let u = ((s - R::splat(FADE)) * R::splat(1.0 / width))
        .max(zero)
        .min(one);
    let rest = one - u;
    // 1 − u³(10 − 15u + 6u²), in the form that is exactly 1 and 0 at the ends.
    let step = rest * rest * rest * (one + u * (R::splat(3.0) + R::splat(6.0) * u));
    let fall = R::splat(-30.0 / width) * (u * rest).square();
    (value * step, value * fall - decay * step)
}

/// Bounds on φ, |φ′| and |φ″| over all s in an interval.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Range {
    /// The least and the largest value.
    pub value: [f64; 2],
    /// The largest |φ′|.
    pub slope: f64,
    /// The largest |φ″|.
    pub curvature: f64,
}

/// Returns bounds on the profile for s from `low` to `high`.
pub(crate) fn range(low: f64, high: f64) -> Range {
    if low >= CUT {
        return Range {
            value: [0.0; 2],
            slope: 0.0,
            curvature: 0.0,
        };
    }
    let decay = low.max(DEEP).decay();
    // φ falls with s. With the step w, |w′| ≤ 0.47 and |w″| ≤ 0.37: |φ′| = e^−s (w + |w′|), |φ″| ≤
    // e^−s (w + 2|w′| + |w″|).
    let (first, second) = if high <= FADE {
        (1.0, 1.0)
    } else {
        (FADING[0], FADING[1])
    };
    Range {
        value: [profile(high).0, profile(low).0],
        slope: decay * first,
        curvature: decay * second,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn profile_is_the_exponential_between_its_ends() {
        for i in -400..=160 {
            let s = 0.1 * f64::from(i);
            let exact = libm::exp(-s);
            let (value, slope) = profile(s);
            assert!((value / exact - 1.0).abs() < 1e-14, "{s}");
            assert!((slope / exact + 1.0).abs() < 1e-14, "{s}");
        }
        assert_eq!(profile(CUT), (0.0, 0.0));
        assert_eq!(profile(1e9), (0.0, 0.0));
        assert_eq!(profile(CUT as f32), (0.0, 0.0));
        assert!(profile(-1e6_f32).0.is_finite());
    }

    #[test]
    fn derivative_and_bounds_agree_with_differences() {
        let h = 1e-4;
        for i in -5000..2500 {
            let s = 0.0137 * f64::from(i);
            let [before, (value, slope), after] = [s - h, s, s + h].map(profile);
            let scale = libm::exp(-s.max(DEEP));
            let first = (after.0 - before.0) / (2.0 * h);
            assert!(
                (first - slope).abs() <= 1e-4 * scale,
                "{s}: {first} {slope}"
            );
            let second = (after.1 - before.1) / (2.0 * h);
            let bound = range(s - 0.01, s + 0.3);
            assert!(bound.value[0] <= value && value <= bound.value[1]);
            assert!(slope.abs() <= bound.slope * 1.000_001, "{s}");
            assert!(second.abs() <= bound.curvature * 1.000_001, "{s}");
        }
    }
}
