//! The number types that formulas are generic over.
//!
//! Each formula of this crate is written once, generic over [`Real`], without branches on values:
//! it runs as `f64` (the reference), as `f32`, and as [`wide::f32x8`] (eight at a time). Only
//! operations that IEEE 754 defines to the last bit (`+ − × ÷ √`, comparisons) and polynomials of
//! our own are used, never a fused multiply-add and never a platform's `sin` or `atan`. So results
//! have the same bits on every platform, and a lane of `f32x8` has the same bits as `f32` alone.

use crate::error_function;
use core::ops::{Add, Div, Mul, Neg, Sub};

mod double;
mod single;
mod wide8;

/// A real number, or several side by side that are computed in step.
pub trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + 'static
{
    /// The type of one lane.
    type Scalar: Scalar;
    /// The result of a comparison, one truth value a lane.
    type Mask: Copy;
    /// Numbers side by side.
    const LANES: usize;
    /// Coordinates (in units of the kernel's width) are cut to ± this: beyond it the fourth powers
    /// that formulas contain would overflow, and the field there is below 10⁻³⁵ anyway.
    const HORIZON: f64;
    /// Steps that [`carlson`](crate::carlson) takes: enough for the type's precision.
    const DUPLICATIONS: usize;
    /// Whether this is double precision.
    const DOUBLE: bool = core::mem::size_of::<Self::Scalar>() == 8;

    /// Returns the same constant in every lane, rounded to the type.
    fn splat(value: f64) -> Self;
    /// Returns the same prepared constant in every lane.
    fn lift(value: Self::Scalar) -> Self;
    /// Makes lanes from a function of the lane's number.
    fn from_lanes(lane: impl FnMut(usize) -> f64) -> Self;
    /// Returns a lane.
    ///
    /// # Panics
    /// If `index ≥ LANES`.
    fn lane(self, index: usize) -> f64;

    /// √x.
    fn sqrt(self) -> Self;
    /// |x|.
    fn abs(self) -> Self;
    /// The greatest integer not above x.
    fn floor(self) -> Self;
    /// The smaller of two numbers.
    fn min(self, other: Self) -> Self;
    /// The larger of two numbers.
    fn max(self, other: Self) -> Self;
    /// Compares: the mask holds where `self < other`.
    fn lt(self, other: Self) -> Self::Mask;
    /// Selects `yes` where the mask holds, else `no`.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// Returns the mask that holds where both masks hold.
    fn both(a: Self::Mask, b: Self::Mask) -> Self::Mask;
    /// Whether the mask holds in any lane. To be used only to skip work that would not change any
    /// bit of the result: else lanes would differ from `f32`.
    fn any(mask: Self::Mask) -> bool;

    /// Does work only where the mask holds in a lane, else returns zeros: for work that gives 0
    /// where the mask does not hold, or is not used there.
    #[inline(always)]
    fn where_any<const N: usize>(mask: Self::Mask, work: impl FnOnce() -> [Self; N]) -> [Self; N] {
        if Self::any(mask) {
            work()
        } else {
            [Self::splat(0.0); N]
        }
    }
    /// Adds terms, one for each item, to sums.
    #[inline(always)]
    fn add_over<T, const N: usize>(
        mut sums: [Self; N],
        items: &[T],
        mut term: impl FnMut(&T) -> [Self; N],
    ) -> [Self; N] {
        for item in items {
            for (sum, part) in sums.iter_mut().zip(term(item)) {
                *sum = *sum + part;
            }
        }
        sums
    }
    /// Computes that one of `count` functions which a constant selects: `choice` is its value.
    #[inline(always)]
    fn one_of<const N: usize>(
        _selector: Self::Scalar,
        choice: usize,
        _count: usize,
        function: impl Fn(usize) -> [Self; N],
    ) -> [Self; N] {
        function(choice)
    }

    /// `Q(y)` of `arctan x = x − x³/3 + x⁵·Q(x²)`, for 0 ≤ y ≤ tan²(π/8), to the type's precision.
    #[inline(always)]
    fn arctangent_tail(square: Self) -> Self {
        single::arctangent_tail(square)
    }
    /// Sine and cosine, for |x| up to 10⁴ or so.
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        single::sin_cos(self)
    }
    /// Sine and cosine, for |x| ≤ π/4.
    #[inline(always)]
    fn sin_cos_octant(self) -> (Self, Self) {
        single::sin_cos_octant(self)
    }
    /// `erfc x` of x ≥ 0, the complementary error function, to the last digits also where it is
    /// tiny. `bell` is e^(−x²), which callers mostly have already.
    #[inline(always)]
    fn erfc(self, bell: Self) -> Self {
        error_function::erfc(self, bell)
    }

    /// e^(−x), x ≥ −88. In single precision 0 for x from 87.69 on, and meaningless below −88.
    fn decay(self) -> Self;
    /// Upper bound on e^(−x), x ≥ 0, at most 7 % above it; in single precision at least 10⁻³⁸ and
    /// at a fifth of the cost. x must not be NaN.
    #[inline(always)]
    fn decay_at_most(self) -> Self {
        self.decay()
    }
    /// The natural logarithm of a positive, normal number.
    fn ln(self) -> Self;

    /// e^x, x ≤ 88.
    #[inline(always)]
    fn exp(self) -> Self {
        (-self).decay()
    }

    /// ln(1+x), x > −1, to the last digits also where x is small.
    #[inline(always)]
    fn ln_1p(self) -> Self {
        let one = Self::splat(1.0);
        let sum = one + self;
        sum.ln() + (self - (sum - one)) / sum
    }

    /// The inverse of the hyperbolic sine.
    #[inline(always)]
    fn asinh(self) -> Self {
        let one = Self::splat(1.0);
        let x = self.abs();
        let square = x * x;
        self.sign_to((x + square / (one + (one + square).sqrt())).ln_1p())
    }

    /// `magnitude` with the sign of `self`.
    #[inline(always)]
    fn sign_to(self, magnitude: Self) -> Self {
        Self::select(self.lt(Self::splat(0.0)), -magnitude, magnitude)
    }

    /// x².
    #[inline(always)]
    fn square(self) -> Self {
        self * self
    }
}

/// A real number of one lane, the type that prepared constants have.
pub trait Scalar: Real<Scalar = Self> + PartialEq + core::fmt::Debug {
    /// The nearest number of this type.
    fn round(value: f64) -> Self;
    /// Whether a condition on constants of a bone holds.
    fn decide(condition: Self::Mask) -> bool;
}

/// `c₀ + c₁x + c₂x² + …`
///
/// Longer ones as a polynomial of x² for even powers and one for odd: processors follow both at a
/// time, where in one row each step would wait for the one before.
#[inline(always)]
pub(crate) fn polynomial<R: Real, const N: usize>(x: R, coefficients: [f64; N]) -> R {
    let every = |step: usize, last: usize, x: R| {
        let mut sum = R::splat(coefficients[last]);
        for i in (0..last).rev().skip(step - 1).step_by(step) {
            sum = sum * x + R::splat(coefficients[i]);
        }
        sum
    };
    if N < 5 {
        return every(1, N - 1, x);
    }
    let square = x * x;
    let [even, odd] = [(N - 1) & !1, (N - 2) | 1].map(|last| every(2, last, square));
    even + x * odd
}
