//! Minimum and maximum of two numbers that are fast in wasm, too.
//!
//! `f64::min` and `f64::max` ignore NaN. Wasm has no instruction for that and calls a function of
//! the C library for each: 5 % of the time of the bounds, of which a picture evaluates millions.

/// Numbers that can be limited. Of two zeros of different signs either may be returned.
pub trait Cut: Copy {
    /// The larger of the two; if one is NaN, the other.
    #[must_use]
    fn at_least(self, low: Self) -> Self;
    /// The smaller of the two; if one is NaN, the other.
    #[must_use]
    fn at_most(self, high: Self) -> Self;
}

macro_rules! cut {
    ($float:ty) => {
        impl Cut for $float {
            #[inline(always)]
            fn at_least(self, low: Self) -> Self {
                if !cfg!(target_arch = "wasm32") {
                    self.max(low)
                } else if self > low || low.is_nan() {
                    self
                } else {
                    low
                }
            }

            #[inline(always)]
            fn at_most(self, high: Self) -> Self {
                if !cfg!(target_arch = "wasm32") {
                    self.min(high)
                } else if self < high || high.is_nan() {
                    self
                } else {
                    high
                }
            }
        }
    };
}

cut!(f32);
cut!(f64);
