//! An infinite plane (thesis 2.24): a function of the height z above it alone.
//!
//! `f(z) = π·∫_{z²}^∞ G(q) dq`, and so `f′ = −2πz·G(z²)`: Cauchy `π/(1+z²)`; Gauss `π·exp(−z²)`;
//! cubed `2π/√(z²+ε²)`; with v = 1−z² quartic `πv³/3`, compact6 `πv⁴/4`, soft `π(20v³ + 12v⁴)/108`;
//! metaballs from `P(z) = (π/6)(1−z)³(1+3z)` as `1.5·P(z) − P(3z)/18` (see `metaballs`).
//!
//! The integrals of the inverse and the squared kernel diverge. There the plane counts only up to
//! [`WINDOW`] = 10 radii around the foot of the perpendicular, so that it is still the same
//! everywhere: `2π(√(z²+ε²+100) − √(z²+ε²))` and `π·ln(1 + 100/(z²+ε²))`.
use crate::{Jet, Kernel, Real, inverse};
use core::f64::consts::PI;

/// Half-length, in radii, of the finite lines and planes that stand for infinite ones where those
/// have no finite field.
pub const WINDOW: f64 = 10.0;

/// Value and gradient at a local position.
#[inline(always)]
pub fn jet<R: Real>(kernel: Kernel, [_, _, z]: [R; 3]) -> Jet<R> {
    let zero = R::splat(0.0);
    let one = R::splat(1.0);
    let pi = R::splat(PI);
    let (g, _) = kernel.pair(z * z);
    let (value, slope) = match kernel {
        Kernel::Cauchy => {
            let i = one / (one + z * z);
            (pi * i, g)
        }
        Kernel::Gauss => (pi * g, g),
        Kernel::Inverse => {
            let q = z * z + R::splat(inverse::POLE2);
            let window = R::splat(WINDOW * WINDOW);
            let (near, far) = (q.sqrt(), (q + window).sqrt());
            let value = (pi + pi) * window / (near + far);
            // G(z²) − G(z²+100)
            (value, window / ((near + far) * near * far))
        }
        Kernel::Squared => {
            let q = z * z + R::splat(inverse::POLE2);
            let window = R::splat(WINDOW * WINDOW);
            let ratio = window / q;
            (pi * ratio.ln_1p(), ratio / (q + window))
        }
        Kernel::Cubed => {
            let c = (z * z + R::splat(inverse::POLE2)).sqrt();
            ((pi + pi) / c, g)
        }
        Kernel::Metaballs => {
            let height = z.abs();
            let part = |scale: f64| {
                let u = height * R::splat(scale);
                let rest = (one - u).max(zero);
                rest * rest * rest * (one + R::splat(3.0) * u)
            };
            let value =
                R::splat(PI / 6.0) * (R::splat(1.5) * part(1.0) - R::splat(1.0 / 18.0) * part(3.0));
            (value, g)
        }
        Kernel::Soft | Kernel::Quartic | Kernel::Compact6 => {
            let [c2, c3] = kernel.polynomial().unwrap_or_default();
            let v = (one - z * z).max(zero);
            let value = v * v * v * (R::splat(PI * c2 / 3.0) + R::splat(PI * c3 / 4.0) * v);
            (value, g)
        }
    };
    Jet {
        value,
        gradient: [zero, zero, R::splat(-2.0 * PI) * z * slope],
    }
}
