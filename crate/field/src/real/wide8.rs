//! `wide::f32x8`, eight lanes of the shipping path.
use super::single::Binary;
use super::{Real, single};
use wide::bytemuck::cast;
use wide::{f32x8, i32x8};

impl Real for f32x8 {
    type Scalar = f32;
    type Mask = Self;
    const LANES: usize = 8;
    const HORIZON: f64 = <f32 as Real>::HORIZON;
    const DUPLICATIONS: usize = <f32 as Real>::DUPLICATIONS;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        f32x8::splat(value as f32)
    }

    #[inline(always)]
    fn lift(value: f32) -> Self {
        f32x8::splat(value)
    }

    #[inline(always)]
    fn from_lanes(mut lane: impl FnMut(usize) -> f64) -> Self {
        f32x8::new(core::array::from_fn(|i| lane(i) as f32))
    }

    #[inline(always)]
    fn lane(self, index: usize) -> f64 {
        f64::from(self.to_array()[index])
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        f32x8::sqrt(self)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        f32x8::abs(self)
    }

    #[inline(always)]
    fn floor(self) -> Self {
        f32x8::floor(self)
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.fast_min(other)
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.fast_max(other)
    }

    #[inline(always)]
    fn lt(self, other: Self) -> Self {
        self.simd_lt(other)
    }

    #[inline(always)]
    fn select(mask: Self, yes: Self, no: Self) -> Self {
        mask.select(yes, no)
    }

    #[inline(always)]
    fn both(a: Self, b: Self) -> Self {
        a & b
    }

    #[inline(always)]
    fn any(mask: Self) -> bool {
        mask.any()
    }

    #[inline(always)]
    fn decay(self) -> Self {
        single::decay(self)
    }

    #[inline(always)]
    fn decay_at_most(self) -> Self {
        single::decay_at_most(self)
    }

    #[inline(always)]
    fn ln(self) -> Self {
        single::ln(self)
    }
}

impl Binary for f32x8 {
    #[inline(always)]
    fn bits_up<const BITS: u32>(self) -> Self {
        cast(cast::<Self, i32x8>(self) << BITS)
    }

    #[inline(always)]
    fn parts(self) -> (Self, Self) {
        let bits: i32x8 = cast(self);
        let exponent = (bits - i32x8::splat(single::ROOT_HALF_BITS)) >> 23;
        (cast(bits - (exponent << 23)), f32x8::from_i32x8(exponent))
    }
}
