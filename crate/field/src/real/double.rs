//! `f64`, the reference precision.
use super::{Real, Scalar, polynomial};

impl Scalar for f64 {
    #[inline(always)]
    fn round(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn decide(condition: bool) -> bool {
        condition
    }
}

impl Real for f64 {
    type Scalar = Self;
    type Mask = bool;
    const LANES: usize = 1;
    const HORIZON: f64 = 1e60;
    const DUPLICATIONS: usize = 8;

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

    #[inline(always)]
    fn any(mask: bool) -> bool {
        mask
    }

    /// Chebyshev fit, error below 3·10⁻¹⁷.
    #[inline(always)]
    fn arctangent_tail(square: Self) -> Self {
        polynomial(
            square,
            [
                0.199_999_999_999_999_98,
                -0.142_857_142_857_101_52,
                0.111_111_111_101_445_8,
                -0.090_909_090_024_895_6,
                0.076_923_035_297_346_34,
                -0.066_665_518_283_593_14,
                0.058_803_649_399_738_44,
                -0.052_408_296_952_537_674,
                0.045_979_355_161_118_36,
                -0.035_736_070_671_697_85,
                0.017_547_815_161_862_12,
            ],
        )
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        libm::sincos(self)
    }

    #[inline(always)]
    fn sin_cos_octant(self) -> (Self, Self) {
        libm::sincos(self)
    }

    #[inline(always)]
    fn erfc(self, _bell: Self) -> Self {
        libm::erfc(self)
    }

    #[inline(always)]
    fn decay(self) -> Self {
        libm::exp(-self)
    }

    #[inline(always)]
    fn ln(self) -> Self {
        libm::log(self)
    }
}
