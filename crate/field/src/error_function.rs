//! The complementary error function in single precision.
//!
//! `erfc x = e^(−x²)·E(x)` for x ≥ 0, where E falls from 1 and is about 1/(x√π) far out. So
//! `(x+2)·E(x)` is nearly level, and a polynomial of `v = (x−2)/(x+2)`, which maps the half line to
//! an interval, stands for it. The polynomial has the value's digits also where erfc is tiny.
use crate::Real;
use crate::real::polynomial;

/// `erfc x` for x ≥ 0, given `bell` = e^(−x²).
///
/// Chebyshev fit for x ≤ 9.4, beyond which single precision has no e^(−x²); relative error 5·10⁻⁸.
#[inline(always)]
pub fn erfc<R: Real>(x: R, bell: R) -> R {
    let one = R::splat(1.0);
    let two = R::splat(2.0);
    let reciprocal = one / (x + two);
    let v = one - (two + two) * reciprocal;
    let level = polynomial(
        v,
        [
            1.021_582_752_767_861_3,
            -0.687_160_930_583_887,
            0.279_469_275_261_407_25,
            -0.036_435_891_865_681_24,
            -0.021_481_830_991_706_12,
            0.006_440_449_154_195_223,
            0.002_977_505_990_578_918,
            -0.000_758_750_561_200_951_9,
            -0.000_462_905_167_607_549,
        ],
    );
    bell * reciprocal * level
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_in_double_precision() {
        for i in 0..9000 {
            let x = i as f32 * 1e-3;
            // The bell is given, so its own rounding does not count.
            let square = f64::from(x) * f64::from(x);
            let bell = libm::exp(-square);
            let got = f64::from(erfc::<f64>(f64::from(x), bell) as f32);
            let want = libm::erfc(f64::from(x));
            assert!((got - want).abs() <= 1.2e-7 * want, "{x}: {got} {want}");
            let got = f64::from(erfc(x, bell as f32));
            // Below the smallest normal number digits go.
            assert!(
                (got - want).abs() <= 6e-7 * want + 1e-38,
                "{x}: {got} {want}"
            );
        }
    }
}
