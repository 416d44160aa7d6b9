//! `f64`, the reference precision.
use super::{Real, Scalar, polynomial};
use crate::term::{Prepared, Term};

impl Scalar for f64 {
    #[inline(always)]
    fn round(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn prepared(term: &Prepared) -> &Term<Self> {
        &term.double
    }
}

impl Real for f64 {
    type Scalar = Self;
    type Mask = bool;
    const LANES: usize = 1;
    const HORIZON: f64 = 1e60;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn lift(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn from_lanes(mut lane: impl FnMut(usize) -> f64) -> Self {
        lane(0)
    }

    #[inline(always)]
    fn lane(self, index: usize) -> f64 {
        assert_eq!(index, 0, "f64 has one lane");
        self
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }

    #[inline(always)]
    fn floor(self) -> Self {
        f64::floor(self)
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        if self < other { self } else { other }
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        if self > other { self } else { other }
    }

    #[inline(always)]
    fn lt(self, other: Self) -> bool {
        self < other
    }

    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }

    #[inline(always)]
    fn both(a: bool, b: bool) -> bool {
        a && b
    }

    /// Chebyshev fit, error below 3·10⁻¹⁷.
    #[inline(always)]
    fn arctangent_tail(square: Self) -> Self {
        polynomial(
            square,
            [
                0.199999999999999971,
                -0.142857142857101533,
                0.111111111101445796,
                -0.0909090900248955975,
                0.0769230352973463436,
                -0.0666655182835931401,
                0.0588036493997384431,
                -0.0524082969525376745,
                0.045979355161118361,
                -0.0357360706716978522,
                0.0175478151618621204,
            ],
        )
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        libm::sincos(self)
    }
}
