//! Several rays in step.
//!
//! The walk is written once, for any number of rays side by side: eight in single precision for
//! pictures, one in double precision for exact answers.
use crate::ray::Ray;
use field::Evaluate;
use wide::bytemuck::cast;
use wide::{f32x4, f32x8};

/// Numbers of several rays, side by side, with comparisons as bit masks.
pub trait Lanes: Evaluate {
    /// Returns one bit for each lane: whether the number is less than the other. NaN never is.
    fn less(self, other: Self) -> u32;
    /// Returns a number of single precision, in all lanes.
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

/// Returns origins and directions of rays by lanes; those not in use repeat the last ray.
#[inline(always)]
#[must_use]
pub fn spread<L: Lanes>(rays: &[Ray]) -> [[L; 3]; 2] {
    let last = rays.len() - 1;
    [
        core::array::from_fn(|k| L::from_lanes(|i| rays[i.min(last)].origin[k])),
        core::array::from_fn(|k| L::from_lanes(|i| rays[i.min(last)].direction[k])),
    ]
}

/// Returns the least of eight numbers. By lanes: a scalar minimum compiles to an unpredictable
/// branch in wasm.
#[inline(always)]
#[must_use]
pub fn least(x: f32x8) -> f32 {
    let [a, b]: [f32x4; 2] = cast(x);
    let four = lesser(a, b);
    let [a, b, c, d] = four.to_array();
    let two = lesser(four, f32x4::new([c, d, a, b]));
    let [a, b, c, d] = two.to_array();
    lesser(two, f32x4::new([b, a, d, c])).to_array()[0]
}

#[inline(always)]
fn lesser(a: f32x4, b: f32x4) -> f32x4 {
    a.simd_lt(b).select(a, b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_is_found_in_every_lane() {
        for lane in 0..8 {
            let mut numbers = [3.0, 4.0, 5.0, f32::INFINITY, 7.0, 8.0, 9.0, 3.5];
            for low in [-1.0, 2.0, f32::NEG_INFINITY] {
                numbers[lane] = low;
                assert_eq!(least(f32x8::new(numbers)), low, "{lane}");
            }
        }
        assert_eq!(least(f32x8::splat(f32::INFINITY)), f32::INFINITY);
    }
}
