//! `f32`, one lane of the shipping path.
use super::{Real, Scalar, polynomial};

impl Scalar for f32 {
    #[inline(always)]
    fn round(value: f64) -> Self {
        value as f32
    }

    #[inline(always)]
    fn decide(condition: bool) -> bool {
        condition
    }
}

impl Real for f32 {
    type Scalar = Self;
    type Mask = bool;
    const LANES: usize = 1;
    const HORIZON: f64 = 1e9;
    const DUPLICATIONS: usize = 5;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        value as f32
    }

    #[inline(always)]
    fn lift(value: f32) -> Self {
        value
    }

    #[inline(always)]
    fn from_lanes(mut lane: impl FnMut(usize) -> f64) -> Self {
        lane(0) as f32
    }

    #[inline(always)]
    fn lane(self, index: usize) -> f64 {
        assert_eq!(index, 0, "f32 has one lane");
        f64::from(self)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        f32::sqrt(self)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        f32::abs(self)
    }

    #[inline(always)]
    fn floor(self) -> Self {
        f32::floor(self)
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

    #[inline(always)]
    fn decay(self) -> Self {
        decay(self)
    }

    #[inline(always)]
    fn decay_at_most(self) -> Self {
        decay_at_most(self)
    }

    #[inline(always)]
    fn ln(self) -> Self {
        ln(self)
    }
}

impl Binary for f32 {
    #[inline(always)]
    fn bits_up<const BITS: u32>(self) -> Self {
        f32::from_bits(self.to_bits() << BITS)
    }

    #[inline(always)]
    fn parts(self) -> (Self, Self) {
        let bits = self.to_bits() as i32;
        let exponent = (bits - ROOT_HALF_BITS) >> 23;
        (
            f32::from_bits((bits - (exponent << 23)) as u32),
            exponent as f32,
        )
    }
}

/// The bits of √½ in single precision.
pub(super) const ROOT_HALF_BITS: i32 = 0x3F35_04F3;

/// Access to the bits of single precision numbers, for the exponential and the logarithm.
pub(super) trait Binary: Real {
    /// Shifts the number's bits up by `BITS` and reads them as a number.
    fn bits_up<const BITS: u32>(self) -> Self;
    /// Splits a positive, normal x = m·2ⁿ into m in [√½, √2) and the integer n.
    fn parts(self) -> (Self, Self);
}

/// `e⁻ˣ` in single precision: −x and the nearest multiple n of ln 2 (in two parts, the first with
/// so few bits that its products are exact) leave r, and `eʳ = 1 + r + r²·P(r)`. P is fitted for
/// the least relative error where |r| ≤ ½·ln 2 (and a little more), which is 3·10⁻⁹.
#[inline(always)]
pub(super) fn decay<R: Binary>(x: R) -> R {
    // A larger x has n = −127, too, which encodes 0.
    let x = x.min(R::splat(88.1));
    // Adding 1.5·2²³ rounds to a whole number, and leaves that in the low bits.
    let shifted = R::splat(ROUNDER) - x * R::splat(core::f64::consts::LOG2_E);
    let less = R::splat(ROUNDER) - shifted;
    let r = less * R::splat(0.693_359_375) - x;
    let r = r + less * R::splat(-2.121_944_400_546_905_8e-4);
    let [a, b, c, d, e] = [
        0.499_999_934_034_217_7,
        0.166_665_199_733_604_66,
        0.041_668_395_795_250_22,
        0.008_368_796_699_068_273,
        0.001_381_443_325_322_647_7,
    ]
    .map(R::splat);
    // Independent parts, as latency dominates where many e⁻ˣ are computed.
    let square = r * r;
    let low = R::splat(1.0) + r + square * (a + b * r);
    let power = low + square * square * (c + d * r + e * square);
    // 2ⁿ: the low bits are those of an exponent.
    power * shifted.bits_up::<23>()
}

/// Upper bound on `e⁻ˣ`, x ≥ 0: with the exponent that is stored in front of them, the bits of n +
/// f are (1 + f)·2ⁿ, where f is between 0 and 1; that is the chord of 2ⁿ⁺ᶠ, which is convex, and
/// above it by no more than 6.2 %.
#[inline(always)]
pub(super) fn decay_at_most<R: Binary>(x: R) -> R {
    // The exponent stays 1 or more.
    let x = x.min(R::splat(87.3));
    let shifted = R::splat(EIGHT_BITS) - x * R::splat(core::f64::consts::LOG2_E);
    shifted.bits_up::<15>()
}

/// 1.5·2¹⁵, so that a sum with it is rounded to 8 bits after the point, the exponent of 2⁰, and the
/// last of these bits, which is more than what is lost by rounding down.
const EIGHT_BITS: f64 = 49_152.0 + 127.0 + 1.0 / 256.0;

/// 1.5·2²³, and the exponent that a number of single precision stores for 2⁰.
const ROUNDER: f64 = 12_582_912.0 + 127.0;

/// The logarithm in single precision: with `s = (m−1)/(m+1)`, `ln m = 2(s + s³/3 + s⁵/5 + …)`;
/// |s| ≤ 0.1716, so the terms up to s⁹ leave 4·10⁻¹⁰.
#[inline(always)]
pub(super) fn ln<R: Binary>(x: R) -> R {
    let (m, n) = x.parts();
    let s = (m - R::splat(1.0)) / (m + R::splat(1.0));
    let square = s * s;
    let rest = s * square * polynomial(square, [2.0 / 3.0, 0.4, 2.0 / 7.0, 2.0 / 9.0]);
    n * R::splat(0.693_359_375) + (s + s + (rest + n * R::splat(-2.121_944_400_546_905_8e-4)))
}

/// The tail of the arctangent in single precision: Chebyshev fit, error below 4·10⁻⁷, which
/// weighs x⁴ ≤ 0.03 against x.
#[inline(always)]
pub(super) fn arctangent_tail<R: Real>(square: R) -> R {
    polynomial(
        square,
        [
            0.199_999_606_718_600_2,
            -0.142_783_460_273_654_1,
            0.108_910_396_491_263_4,
            -0.069_082_154_306_575_76,
        ],
    )
}

/// Sine and cosine in single precision for |r| ≤ π/4: Chebyshev fits with errors below 4·10⁻⁹.
#[inline(always)]
pub(super) fn sin_cos_octant<R: Real>(r: R) -> (R, R) {
    let square = r * r;
    let sine = r + r
        * square
        * polynomial(
            square,
            [
                -0.166_666_646_563_122_08,
                0.008_332_747_104_664_53,
                -0.000_195_876_390_987_376_2,
            ],
        );
    let cosine = R::splat(1.0) - square * R::splat(0.5)
        + square
            * square
            * polynomial(
                square,
                [
                    0.041_666_664_653_488_79,
                    -0.001_388_830_186_756_237,
                    0.000_024_547_689_772_460_03,
                ],
            );
    (sine, cosine)
}

/// Sine and cosine in single precision: the argument is brought to |r| ≤ π/4 by subtracting a
/// multiple of π/2 in three parts (the first two have so few bits that their products are exact),
/// then comes [`sin_cos_octant`]. Absolute error below 10⁻⁶ for |x| ≤ 10⁴.
#[inline(always)]
pub(super) fn sin_cos<R: Real>(x: R) -> (R, R) {
    let half = R::splat(0.5);
    let turns = (x * R::splat(core::f64::consts::FRAC_2_PI) + half).floor();
    let r = x - turns * R::splat(1.5703125);
    let r = r - turns * R::splat(4.837512969970703e-4);
    let r = r - turns * R::splat(7.549_789_954_891e-8);
    let (sine, cosine) = sin_cos_octant(r);
    // Quadrant 0…3: odd quadrants swap the two, quadrants 2 and 3 negate the sine, 1 and 2 the
    // cosine.
    let quadrant = turns - (turns * R::splat(0.25)).floor() * R::splat(4.0);
    let odd = half.lt(quadrant - (quadrant * half).floor() * R::splat(2.0));
    let upper = R::splat(1.5).lt(quadrant);
    let middle = (quadrant - R::splat(1.5)).abs().lt(R::splat(1.0));
    let s = R::select(odd, cosine, sine);
    let c = R::select(odd, sine, cosine);
    (R::select(upper, -s, s), R::select(middle, -c, c))
}

#[cfg(test)]
mod tests {
    use super::*;
    use wide::f32x8;

    #[test]
    fn decay_is_as_in_double_precision() {
        for i in -80_000..=88_000 {
            let x = i as f32 * 1e-3;
            let want = libm::exp(-f64::from(x));
            let off = (f64::from(decay(x)) - want).abs();
            // Below the smallest normal number digits go.
            assert!(off <= 2e-7 * want + 9e-39, "{x}: off {off}, of {want}");
        }
    }

    #[test]
    fn decay_is_bounded() {
        for i in 0..=900_000 {
            let x = i as f32 * 1e-4;
            let (bound, want) = (f64::from(decay_at_most(x)), libm::exp(-f64::from(x)));
            let most = 1.07 * want + 2e-38;
            assert!((want..=most).contains(&bound), "{x}: {bound}, of {want}");
            let lanes = f32x8::splat(x).decay_at_most().to_array();
            assert_eq!(lanes.map(f32::to_bits), [decay_at_most(x).to_bits(); 8]);
        }
        for x in [0.0, 1e9, f32::MAX, f32::INFINITY] {
            let bound = f64::from(decay_at_most(x));
            let want = libm::exp(-f64::from(x));
            assert!((want..=want + 1e-2).contains(&bound), "{x}: {bound}");
        }
    }

    #[test]
    fn decay_ends_at_nothing() {
        assert_eq!(decay(0.0f32), 1.0);
        for x in [88.1, 89.0, 1e9, f32::MAX, f32::INFINITY] {
            assert_eq!(decay(x), 0.0, "{x}");
        }
    }
}
