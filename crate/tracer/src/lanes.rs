//! Several rays in step.
//!
//! The digger is written once, for any number of rays side by side: eight in single precision for
//! pictures, one in double precision for exact answers.
use field::Real;
use wide::f32x8;

/// Numbers of several rays, side by side, whose comparisons can steer the program.
pub trait Lanes: Real {
    /// One bit a lane: whether the number is less than the other. Never set for NaN.
    fn less(self, other: Self) -> u32;
    /// A number of single precision, in all lanes.
    fn single(value: f32) -> Self;
}

impl Lanes for f32x8 {
    #[inline]
    fn less(self, other: Self) -> u32 {
        self.simd_lt(other).to_bitmask()
    }

    #[inline(always)]
    fn single(value: f32) -> Self {
        Self::splat(value)
    }
}

impl Lanes for f64 {
    #[inline]
    fn less(self, other: Self) -> u32 {
        u32::from(self < other)
    }

    #[inline(always)]
    fn single(value: f32) -> Self {
        Self::from(value)
    }
}
