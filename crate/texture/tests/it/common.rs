//! Odd numbers, and differences.

use glam::DVec3;

/// Numbers that no formula expects.
pub const ODD: [f64; 9] = [
    0.0,
    -0.0,
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    1e300,
    -1e300,
    1e-310,
    f64::MIN_POSITIVE,
];

/// Gradient of a function by central differences.
pub fn slope(f: impl Fn(DVec3) -> f64, p: DVec3, step: f64) -> DVec3 {
    DVec3::from_array(DVec3::AXES.map(|d| (f(p + step * d) - f(p - step * d)) / (2.0 * step)))
}
