//! The compact6 kernel, `(1−u²)³` up to u = 1 (ours).
use crate::kernel::polynomial::Polynomial;

/// The compact6 kernel.
pub(crate) struct Compact6;

impl Polynomial for Compact6 {
    const NAME: &'static str = "compact6";
    const MEANING: &'static str = "(1−r²)³, nothing beyond r = 1";
    const FORMULA: &'static str = "h(u) = (1−u²)³ up to u = 1";
    const PLANE: &'static str = "F = π/4 · (1−d²)⁴";
    const COEFFICIENTS: [f64; 2] = [0.0, 1.0];
    const SMOOTHNESS: usize = 2;

    fn width(blobbiness: f64) -> f64 {
        1.0 / (1.0 + 3.0 / blobbiness).sqrt()
    }
}
