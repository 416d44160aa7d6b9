//! How thick flesh is at points of curves.

use crate::field::line;
use glam::DVec3;

/// Radii within which curves add to the thickness of the flesh at a point.
const NEAR: f64 = 8.0;

/// The radius of the flesh across a curve, where the field of all its segments is 1: `Σ R²/2 ∫ ds/d³`. At an end the mean of that
/// across and that ahead.
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
    let is_near = |&&(a, b, _): &&(DVec3, DVec3, f64)| {
        let reach = NEAR * radius + 0.5 * a.distance(b);
        point.distance_squared((a + b) * 0.5) < reach * reach
    };
    let near: Vec<_> = pieces.iter().filter(is_near).collect();
    let value = |p: DVec3| {
        let field = |&&(a, b, r): &&(DVec3, DVec3, f64)| 0.5 * r * r * line(p, a, b).0;
        near.iter().map(field).sum::<f64>()
    };
    let reach = |direction: DVec3| {
        let mut reach = radius;
        // Exact in a step where the field falls as 1/d².
        for _ in 0..12 {
            let next = reach * value(point + direction * reach).sqrt();
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
