//! An upper bound on sums of Gaussians along rays, by two values.
//!
//! Along a ray the square of the distance from a point is t² plus a linear function. So each
//! Gaussian w·e^(−s²d²) with w > 0 and s² ≤ c is, times e^(ct²), the exponential of a convex
//! function, and the logarithm of a sum or an integral of such exponentials is convex, too (by
//! Hölder's inequality). For every sum f of points, segments, arcs, faces and planes with Gaussian
//! kernels `ln f + c·t²` is convex, with c the largest s²: on a span of length h it is at most its
//! chord. With the values A and B at the ends, where x runs from 0 to 1,
//!
//! `ln f ≤ (1−x)·ln A + x·ln B + c·h²·x(1−x)`.
//!
//! The right side is largest at `x = ½ + ln(B/A)/(2ch²)`, or at an end where this is beyond it.
//! Two values bound any number of terms, whose own bounds may add up to many times their sum.
use crate::lanes::Lanes;

/// Rounding of logarithms of single precision down to [`LEAST`], and of the bound.
const ROUNDING: f64 = 5e-5;
/// Value in place of smaller ones, whose logarithms need not be told apart.
const LEAST: f64 = 1e-30;

/// Returns an upper bound on the logarithm of a number, or of [`LEAST`] if that is larger.
#[inline(never)]
#[must_use]
pub fn log_above<L: Lanes>(value: L) -> L {
    value.max(L::splat(LEAST)).ln() + L::splat(ROUNDING)
}

/// Returns a lower bound on the logarithm of a number; that of smaller ones than [`LEAST`] is -∞.
#[inline]
#[must_use]
pub fn log_below<L: Lanes>(value: L) -> L {
    let log = log_above(value) - L::splat(2.0 * ROUNDING);
    L::select(value.lt(L::splat(LEAST)), L::splat(f64::NEG_INFINITY), log)
}

/// Returns an upper bound on ln f on a span, given upper bounds on ln f at its ends and `c·h²`.
#[inline]
#[must_use]
pub fn most_between<L: Lanes>([a, b]: [L; 2], bend: f64) -> L {
    let (rise, bend) = (b - a, L::splat(bend));
    let turn = rise * rise / bend;
    let inner = L::splat(0.5) * (a + b) + L::splat(0.25) * (bend + turn);
    L::select(rise.abs().lt(bend), inner, a.max(b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use field::{BlobScale, Bound, Kernel, Primitive, Shaping, Skeleton};
    use glam::DVec3;
    use trials::{Random, count};

    /// Returns a Gaussian bone of random kind and width that adds.
    fn bone(random: &mut Random) -> Primitive {
        let [a, b, c] = core::array::from_fn(|_| random.vector(1.0));
        let skeleton = match random.below(5) {
            0 => Skeleton::Point { center: a },
            1 => Skeleton::Segment { base: a, apex: b },
            2 => Skeleton::Triangle { corners: [a, b, c] },
            3 => Skeleton::Arc {
                center: a,
                u: DVec3::X,
                v: DVec3::Y,
                radius: random.range(0.1, 0.8),
                angle: random.range(0.2, 6.0),
            },
            _ => Skeleton::Plane {
                point: a,
                normal: random.direction(),
            },
        };
        let shaping = Shaping {
            kernel: Kernel::Gauss,
            radius: random.range(0.1, 0.5),
            blobbiness: random.range(0.5, 4.0),
            blob_scale: BlobScale::Relative,
            strength: random.range(0.3, 1.5),
            influence: 1e-3,
            taper: None,
        };
        Primitive::new(skeleton, &shaping, None).expect("flesh")
    }

    /// Sums of random bones are nowhere above the bound, and touch it where one point counts.
    #[test]
    fn no_sum_is_above_the_bound() {
        let mut random = Random::new(4);
        let mut least = f64::INFINITY;
        for case in 0..count(3000) {
            let bones: Vec<Primitive> = match case % 4 {
                0 => {
                    let center = random.vector(0.3);
                    let skeleton = Skeleton::Point { center };
                    let shaping = Shaping {
                        kernel: Kernel::Gauss,
                        radius: 0.3,
                        blobbiness: random.range(0.5, 4.0),
                        blob_scale: BlobScale::Relative,
                        strength: 1.0,
                        influence: 1e-3,
                        taper: None,
                    };
                    Primitive::new(skeleton, &shaping, None)
                        .into_iter()
                        .collect()
                }
                _ => (0..1 + random.below(30))
                    .map(|_| bone(&mut random))
                    .collect(),
            };
            let bends = bones.iter().map(|p| Bound::new(p).log_bend());
            let bend = bends.fold(0.0, f64::max);
            let (start, direction) = (random.vector(1.0), random.direction());
            let length = random.range(0.05, 3.0) / bend.sqrt();
            let values: Vec<f64> = (0..=40)
                .map(|i| {
                    let share = f64::from(i) / 40.0;
                    let point = (start + direction * (share * length)).to_array();
                    bones.iter().map(|p| p.value(point)).sum()
                })
                .collect();
            let ends = [0, 40].map(|i| log_above(values[i]));
            if ends.iter().any(|end| *end < -40.0) {
                continue;
            }
            let most = most_between(ends, bend * length * length);
            for value in values {
                let own = libm::log(value);
                assert!(own <= most, "{case}: {own} > {most}");
                least = least.min(most - own);
            }
        }
        assert!(least < 1e-3, "{least}");
    }
}
