//! Fields of infinite lines, by which segments, arcs and curves are normalised (fields.md, section
//! 3.4), at a distance x, in kernel widths.
use crate::plane::WINDOW;
use crate::{Kernel, inverse};
use core::f64::consts::PI;

/// `∫ h(√(x²+t²)) dt` over all t; for the inverse kernel, whose integral diverges, over |t| ≤ 10.
#[must_use]
pub fn line(kernel: Kernel, x: f64) -> f64 {
    let q = x * x;
    match kernel {
        Kernel::Cauchy => PI / (2.0 * (1.0 + q) * (1.0 + q).sqrt()),
        Kernel::Gauss => PI.sqrt() * libm::exp(-q),
        Kernel::Inverse => 2.0 * libm::asinh(WINDOW / (q + inverse::POLE2).sqrt()),
        Kernel::Squared => PI / (q + inverse::POLE2).sqrt(),
        Kernel::Cubed => 2.0 / (q + inverse::POLE2),
        Kernel::Metaballs => 1.5 * cone(x) - cone(3.0 * x) / 6.0,
        Kernel::Soft | Kernel::Quartic | Kernel::Compact6 => {
            let [c2, c3] = kernel.polynomial().unwrap_or_default();
            let v = (1.0 - q).max(0.0);
            v * v * v.sqrt() * (c2 * 16.0 / 15.0 + c3 * 32.0 / 35.0 * v)
        }
    }
}

/// The line integral of `(1−u)²` within u ≤ 1.
fn cone(x: f64) -> f64 {
    if x >= 1.0 {
        return 0.0;
    }
    let c = (1.0 - x * x).sqrt();
    let slant = if x > 0.0 {
        x * x * libm::asinh(c / x)
    } else {
        0.0
    };
    2.0 * ((1.0 + x * x) * c + c * c * c / 3.0 - c - slant)
}
