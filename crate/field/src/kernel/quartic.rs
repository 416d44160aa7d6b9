//! The quartic kernel, `(1−u²)²` up to u = 1.
use crate::kernel::polynomial::Polynomial;

/// The quartic kernel.
pub(crate) struct Quartic;

impl Polynomial for Quartic {
    const NAME: &'static str = "quartic";
    const MEANING: &'static str = "(1−r²)², nothing beyond r = 1";
    const FORMULA: &'static str = "h(u) = (1−u²)² up to u = 1";
    const PLANE: &'static str = "F = π/3 · (1−d²)³";
    const COEFFICIENTS: [f64; 2] = [1.0, 0.0];

    fn width(blobbiness: f64) -> f64 {
        1.0 / (1.0 + 2.0 / blobbiness).sqrt()
    }
}
