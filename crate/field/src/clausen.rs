//! The dilogarithm's imaginary part in the unit disc, `Im Li₂(β·e^{2iψ}) = Σ βⁿ sin(2nψ)/n²`, for β
//! and ψ with 0 ≤ β ≤ 1 and 0 ≤ ψ ≤ π/2. For β = 1 it is Clausen's function `Cl₂(2ψ)`.
//!
//! `Li₂(z) = S(−ln(1−z))` with `S(u) = u − u²/4 + Σ B₂ₙu²ⁿ⁺¹/(2n+1)!`, Bernoulli's numbers, which
//! converges for
//! |u| < 2π. Where Re z > ½ this comes from `Li₂(z) = π²/6 − ln z·ln(1−z) − Li₂(1−z)`. Then |u| ≤
//! π/3 in the whole disc, and each term is at most 1/36 of the one before: 4 of them do in single
//! precision, 10 in double.
use crate::Real;

/// B₂ₙ/(2n+1)! from n = 0 on.
const COEFFICIENTS: [f64; 11] = [
    1.0,
    1.0 / 36.0,
    -1.0 / 3_600.0,
    1.0 / 211_680.0,
    -1.0 / 10_886_400.0,
    1.0 / 526_901_760.0,
    -4.064_761_645_144_225_6e-11,
    8.921_691_020_456_452e-13,
    -1.993_929_586_072_107_4e-14,
    4.518_980_029_619_918e-16,
    -1.035_651_761_218_124_7e-17,
];

/// A complex number z of the unit disc, in the quantities that the formulas use.
#[derive(Clone, Copy)]
pub struct InDisc<R> {
    /// Half the argument, ψ.
    pub half_argument: R,
    /// Real part.
    pub real: R,
    /// ln |z|. Counts only where the real part is above ½.
    pub ln_modulus: R,
    /// `ln |1−z|²`.
    pub ln_rest2: R,
    /// Minus the argument of 1−z, in [0, π/2].
    pub rest_argument: R,
}

/// `Im Li₂(z)`.
#[inline(always)]
pub fn imaginary_dilogarithm<R: Real>(z: &InDisc<R>) -> R {
    let beyond = R::splat(0.5).lt(z.real);
    let half = R::splat(0.5);
    let real = R::select(beyond, -z.ln_modulus, -half * z.ln_rest2);
    let imaginary = R::select(beyond, z.half_argument + z.half_argument, z.rest_argument);
    let reflected = z.rest_argument * z.ln_modulus - z.half_argument * z.ln_rest2;
    let reflected = R::select(beyond, reflected, R::splat(0.0));
    reflected + imaginary_series(real, imaginary)
}

/// Im S(a+ib). Horner's scheme for a real polynomial of a complex number v = u²: division by the
/// real quadratic whose roots are v and its conjugate.
#[inline(always)]
fn imaginary_series<R: Real>(a: R, b: R) -> R {
    let terms = if R::DOUBLE { COEFFICIENTS.len() } else { 5 };
    let (aa, bb, ab) = (a * a, b * b, a * b);
    let (real, imaginary) = (aa - bb, ab + ab);
    let sum = real + real;
    let modulus2 = (aa + bb) * (aa + bb);
    let (mut one, mut two) = (R::splat(COEFFICIENTS[terms - 1]), R::splat(0.0));
    for i in (1..terms - 1).rev() {
        (one, two) = (R::splat(COEFFICIENTS[i]) + sum * one - modulus2 * two, one);
    }
    let even = R::splat(1.0) + real * one - modulus2 * two;
    b * even + imaginary * (a * one - R::splat(0.25))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of<R: Real>(beta: f64, psi: f64) -> f64 {
        let (sine, cosine) = libm::sincos(2.0 * psi);
        let (x, y) = (1.0 - beta * cosine, beta * sine);
        let z = InDisc {
            half_argument: R::splat(psi),
            real: R::splat(beta * cosine),
            ln_modulus: R::splat(libm::log(beta)),
            ln_rest2: R::splat(libm::log(x * x + y * y)),
            rest_argument: R::splat(libm::atan2(y, x)),
        };
        imaginary_dilogarithm(&z).lane(0)
    }

    #[test]
    fn is_its_power_series() {
        for beta in [1e-6, 0.1, 0.45, 0.55, 0.7, 0.9, 0.97] {
            for i in 1..60 {
                let psi = f64::from(i) / 60.0 * core::f64::consts::FRAC_PI_2;
                let (mut want, mut power) = (0.0, 1.0);
                for n in 1..1500 {
                    power *= beta;
                    let n = f64::from(n);
                    want += power * libm::sin(2.0 * n * psi) / (n * n);
                }
                let value = of::<f64>(beta, psi);
                assert!(
                    (value - want).abs() <= 3e-15,
                    "{beta} {psi}: {value} {want}"
                );
                let single = of::<f32>(beta, psi);
                assert!(
                    (single - want).abs() <= 3e-7,
                    "{beta} {psi}: {single} {want}"
                );
            }
        }
    }

    /// Catalan's constant, the largest value, and the duplication of angles.
    #[test]
    fn is_clausens_function_on_the_circle() {
        use core::f64::consts::{FRAC_PI_2, FRAC_PI_4, FRAC_PI_6};
        let close = |a: f64, b: f64| assert!((a - b).abs() <= 2e-15, "{a} {b}");
        close(of::<f64>(1.0, FRAC_PI_4), 0.915_965_594_177_219);
        close(of::<f64>(1.0, FRAC_PI_6), 1.014_941_606_409_653_7);
        for i in 1..20 {
            let psi = f64::from(i) / 40.0 * FRAC_PI_2;
            let double = 2.0 * (of::<f64>(1.0, psi) - of::<f64>(1.0, FRAC_PI_2 - psi));
            close(of::<f64>(1.0, 2.0 * psi), double);
        }
    }
}
