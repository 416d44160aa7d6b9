//! Thickness of the flesh at points of curves.

use crate::field::line;
use glam::DVec3;

/// Radii within which curves add to the thickness of the flesh at a point.
const NEAR: f64 = 8.0;

/// The radius of the flesh across a curve, where the field of all its segments is 1:
/// `Σ R²/2 ∫ ds/d³`. At an end the mean of that across and that ahead.
pub fn thickness(
    pieces: &[(DVec3, DVec3, f64)],
    point: DVec3,
    along: DVec3,
    radius: f64,
    is_end: bool,
) -> f64 {
    let Some(along) = along.try_normalize().filter(|_| radius > 0.0) else {
        return radius;
    };
    // Those farther away add a hundredth at most.
    let near: Vec<_> = pieces
        .iter()
        .filter(|&&(a, b, _)| {
            let reach = NEAR * radius + 0.5 * a.distance(b);
            point.distance_squared((a + b) * 0.5) < reach * reach
        })
        .collect();
    let reach = |direction: DVec3| {
        let mut reach = radius;
        // Exact in a step where the field falls as 1/d².
        for _ in 0..12 {
            let p = point + direction * reach;
            let values = near.iter().map(|&&(a, b, r)| 0.5 * r * r * line(p, a, b).0);
            let next = reach * values.sum::<f64>().sqrt();
            reach = next.clamp(0.25 * radius, 2.0 * radius);
        }
        reach
    };
    let across = along.any_orthonormal_vector();
    let other = along.cross(across);
    let sides = [across, other, -across, -other].map(reach);
    let across = 0.25 * sides.iter().sum::<f64>();
    if is_end {
        // The curve goes on to one side only: the other is ahead.
        let ahead = reach(along).min(reach(-along));
        0.5 * (across + ahead)
    } else {
        across
    }
}
