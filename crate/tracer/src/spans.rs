//! Spans: cubic Hermite interpolants along rays, in Bernstein form.
//!
//! A span replaces a function of t between two nodes by the cubic that has its value and slope at
//! both. Its four Bernstein coefficients bound it from both sides, halving it is exact, and the sum
//! of spans over the same interval is a span.
use crate::lanes::Lanes;
use crate::roots::{Roots, refine_root_from, roots};

/// A cubic on an interval, by its Bernstein coefficients.
#[derive(Clone, Copy, Debug)]
pub struct Span<L>(pub [L; 4]);

/// Value and slope at a node.
#[derive(Clone, Copy, Debug)]
pub struct Node<L> {
    /// The function's value.
    pub value: L,
    /// The function's derivative along the ray.
    pub slope: L,
}

impl<L: Lanes> Node<L> {
    /// Returns zero with slope zero.
    #[must_use]
    pub fn zero() -> Self {
        Self {
            value: L::splat(0.0),
            slope: L::splat(0.0),
        }
    }

    /// Returns the sum of two functions' nodes at one place.
    #[inline]
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            slope: self.slope + other.slope,
        }
    }
}

impl<L: Lanes> Span<L> {
    /// Returns the cubic that is zero.
    #[must_use]
    pub fn zero() -> Self {
        Self([L::splat(0.0); 4])
    }

    /// Returns the Hermite interpolant over an interval of the given length.
    #[inline]
    #[must_use]
    pub fn hermite(left: Node<L>, right: Node<L>, length: f64) -> Self {
        let third = L::splat(length / 3.0);
        Self([
            left.value,
            left.value + left.slope * third,
            right.value - right.slope * third,
            right.value,
        ])
    }

    /// Returns the sum of two cubics on the same interval.
    #[inline]
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self(core::array::from_fn(|i| self.0[i] + other.0[i]))
    }

    /// Returns the cubic on the left and on the right half of its interval (de Casteljau).
    #[inline]
    #[must_use]
    pub fn halves(self) -> [Self; 2] {
        let [a, b, c, d] = self.0;
        let (ab, bc, cd) = (middle(a, b), middle(b, c), middle(c, d));
        let (abc, bcd) = (middle(ab, bc), middle(bc, cd));
        let m = middle(abc, bcd);
        [Self([a, ab, abc, m]), Self([m, bcd, cd, d])]
    }

    /// Returns an upper bound on the cubic.
    #[inline]
    #[must_use]
    pub fn max(self) -> L {
        let [a, b, c, d] = self.0;
        a.max(b).max(c.max(d))
    }

    /// Returns a lower bound on the cubic.
    #[inline]
    #[must_use]
    pub fn min(self) -> L {
        let [a, b, c, d] = self.0;
        a.min(b).min(c.min(d))
    }

    /// Returns the cubic of one lane.
    #[must_use]
    pub fn lane(self, index: usize) -> Span<f64> {
        Span(self.0.map(|c| c.lane(index)))
    }
}

/// Accuracy of roots, relative to the interval.
const ROOT_ACCURACY: f64 = 1e-13;

impl Span<f64> {
    /// Returns the x in 0..=1 (the interval's ends) where the cubic crosses a level, ascending;
    /// none if a coefficient is NaN.
    #[must_use]
    pub fn crossings(self, level: f64) -> Roots {
        let [a, b, c, d] = self.0;
        let sides = self.0.map(|x| x < level);
        let changes = sides.windows(2).filter(|pair| pair[0] != pair[1]).count();
        if changes == 1 && self.0.iter().all(|x| x.is_finite() && *x != level) {
            // One sign change of the coefficients: one root (variation diminishing).
            let root = refine_root_from(
                |x| {
                    let (value, slope) = self.value_and_slope(x);
                    (value - level, slope)
                },
                [0.0, 1.0],
                // The secant's root is near.
                (level - a) / (d - a),
                ROOT_ACCURACY,
            );
            return Roots::one(root);
        }
        roots(
            &[
                a - level,
                3.0 * (b - a),
                3.0 * (a - 2.0 * b + c),
                d - a + 3.0 * (b - c),
            ],
            0.0,
            1.0,
        )
    }

    /// Returns the cubic's value at x in 0..=1, and its derivative by x.
    #[must_use]
    pub fn value_and_slope(self, x: f64) -> (f64, f64) {
        let [a, b, c, d] = self.0;
        let y = 1.0 - x;
        let value = y * y * (y * a + 3.0 * x * b) + x * x * (3.0 * y * c + x * d);
        let slope = y * (y * (b - a) + 2.0 * x * (c - b)) + x * x * (d - c);
        (value, 3.0 * slope)
    }
}

/// A part of the field along an interval of a ray, interpolated in place of its primitives.
pub struct KnownPart<'a> {
    /// Value and slope at a parameter.
    pub node: &'a dyn Fn(f64) -> Node<f64>,
    /// Bound on the error of the cubic between the interval's ends, and so, times about four over
    /// the length, on the error of its slope. Terms that are left out may have a larger slope:
    /// where the field is within `off` of T, it may cross T three times instead of once.
    pub off: f64,
}

#[inline(always)]
fn middle<L: Lanes>(a: L, b: L) -> L {
    (a + b) * L::splat(0.5)
}

#[cfg(test)]
mod tests {
    use super::*;
    use trials::{Random, count};

    #[test]
    fn a_span_reproduces_cubics_and_bounds_them() {
        let f = |t: f64| 2.0 - 3.0 * t + 0.5 * t * t + t * t * t;
        let (a, b) = (-1.5, 2.0);
        let [start, end] = [a, b].map(|t| Node {
            value: f(t),
            slope: -3.0 + t + 3.0 * t * t,
        });
        let span = Span::hermite(start, end, b - a);
        let [left, right] = span.halves();
        let value = |span: Span<f64>, x| span.value_and_slope(x).0;
        for i in 0..=10 {
            let x = f64::from(i) / 10.0;
            assert!((value(span, x) - f(a + x * (b - a))).abs() < 1e-12);
            assert!((value(left, x) - value(span, 0.5 * x)).abs() < 1e-12);
            assert!((value(right, x) - value(span, 0.5 + 0.5 * x)).abs() < 1e-12);
            assert!(value(span, x) <= span.max() && value(span, x) >= span.min());
        }
        for &x in span.crossings(1.0).as_slice() {
            assert!((f(a + x * (b - a)) - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn a_cubic_crosses_as_often_as_its_samples_change_sides() {
        let mut random = Random::new(5);
        let mut counts = [0; 4];
        for _ in 0..count(2000) {
            // Also on the level itself, and very near to it.
            let span = Span([0.0; 4].map(|_: f64| match random.range(-4.0, 4.0) as i32 {
                3 => 0.0,
                2 => 1e-12 * random.range(-0.5, 0.5),
                _ => random.range(-0.5, 0.5),
            }));
            let found = span.crossings(0.0);
            let mut sampled = 0;
            for i in 0..512 {
                let [a, b] = [i, i + 1].map(|i| span.value_and_slope(f64::from(i) / 512.0).0);
                sampled += usize::from(a * b < 0.0);
            }
            // Samples may miss two crossings that are near to one another.
            let found = found.as_slice();
            assert!(found.len() >= sampled, "{span:?} {found:?}");
            assert!(found.is_sorted_by(|a, b| a < b), "{span:?} {found:?}");
            for &x in found {
                assert!(span.value_and_slope(x).0.abs() < 1e-12, "{span:?} {x}");
            }
            counts[found.len()] += 1;
        }
        assert!(
            counts.iter().take(3).all(|times| *times > count(50)),
            "{counts:?}"
        );
        // Cubics with coefficients that are not finite have no crossings.
        for bad in [f64::NAN, f64::INFINITY] {
            let _ = Span([bad, 0.4, 0.5, 0.6]).crossings(0.5);
            let found = Span([bad, bad, 0.5, 0.4]).crossings(1.0);
            assert!(found.as_slice().is_empty(), "{found:?}");
        }
    }
}
