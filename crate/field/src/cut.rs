//! Minimum and maximum of two numbers that are fast in wasm, too.
//!
//! `f64::min` and `f64::max` ignore NaN. Wasm has no instruction for that and calls a function of the C library for each:
//! 5 % of the time of the bounds, of which a picture evaluates millions.

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

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg_attr(target_arch = "wasm32", wasm_bindgen_test::wasm_bindgen_test)]
    #[cfg_attr(not(target_arch = "wasm32"), test)]
    fn as_in_the_standard_library() {
        let numbers = [f64::NAN, f64::NEG_INFINITY, -1.0, 0.0, 2.5, f64::INFINITY];
        for a in numbers {
            for b in numbers {
                let same = |x: f64, y: f64| x == y || x.is_nan() && y.is_nan();
                assert!(same(a.at_least(b), a.max(b)), "{a} {b}");
                assert!(same(a.at_most(b), a.min(b)), "{a} {b}");
            }
        }
    }
}
