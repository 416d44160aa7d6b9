//! The soft objects' kernel, `1 − (4/9)u⁶ + (17/9)u⁴ − (22/9)u²` up to u = 1.
use crate::kernel::polynomial::Polynomial;

/// The soft objects' kernel.
pub(crate) struct Soft;

impl Polynomial for Soft {
    const NAME: &'static str = "soft";
    const MEANING: &'static str = "the soft objects' polynomial of degree 6, nothing beyond r = 1";
    const FORMULA: &'static str = "h(u) = 1 − 4/9·u⁶ + 17/9·u⁴ − 22/9·u² up to u = 1";
    const PLANE: &'static str = "F = π · (5/27·(1−d²)³ + 1/9·(1−d²)⁴)";
    const COEFFICIENTS: [f64; 2] = [5.0 / 9.0, 4.0 / 9.0];

    /// v = 1−u² solves `(12+4|B|)v² + (5|B|−2)v = 10`.
    fn width(blobbiness: f64) -> f64 {
        let b = blobbiness;
        let (two_a, half_b) = (12.0 + 4.0 * b, (5.0 * b - 2.0) / 2.0);
        // The stable one of the two forms of the positive root.
        let root = (half_b * half_b + 10.0 * two_a).sqrt();
        let v = if half_b > 0.0 {
            10.0 / (half_b + root)
        } else {
            (root - half_b) / two_a
        };
        (1.0 - v).max(0.0).sqrt()
    }
}
