//! Check of bulges: one that is wide and high, where a field falls slowly, wraps the other body
//! wholly.
use crate::Bulge;
use field::{Implicit, THRESHOLD};
use glam::DVec3;

/// Directions that are looked into.
const DIRECTIONS: u32 = 48;
/// Steps of each, from outside to the middle.
const STEPS: u32 = 40;

/// Whether the bulge that another body raises on a body's surface reaches round to the far side of
/// the other: whether `f + b(f′) > T` at the crest of the bulge, on all rays into the other body
/// from there. Functions are those without contact. `false` if a body has no known end.
#[must_use]
pub fn coats(own: &dyn Implicit, other: &dyn Implicit, bulge: &Bulge) -> bool {
    let (Some(here), Some(there)) = (own.support(), other.support_at(bulge.start())) else {
        return false;
    };
    let away = (there.center - here.center).normalize_or_zero();
    let (crest, height) = (bulge.crest(), bulge.height());
    let mut coated = 0;
    for direction in directions().filter(|d| d.dot(away) > 0.7) {
        let at = |step: f64| there.center + direction * (there.radius * (1.0 - step));
        let inside = |step: f64| other.jet(at(step)).value >= crest;
        let step = f64::from(STEPS).recip();
        let Some(first) = (0..=STEPS).find(|i| inside(f64::from(*i) * step)) else {
            continue;
        };
        let (mut outer, mut inner) = (f64::from(first) * step - step, f64::from(first) * step);
        for _ in 0..20 {
            let middle = 0.5 * (outer + inner);
            if inside(middle) {
                inner = middle;
            } else {
                outer = middle;
            }
        }
        if own.jet(at(inner)).value + height <= THRESHOLD {
            return false;
        }
        coated += 1;
    }
    coated > 0
}

/// Unit vectors spread evenly over the sphere (Vogel's spiral).
fn directions() -> impl Iterator<Item = DVec3> {
    // π(3−√5).
    const GOLDEN: f64 = 2.399963229728653;
    (0..DIRECTIONS).map(|i| {
        let z = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(DIRECTIONS);
        let radius = (1.0 - z * z).sqrt();
        let (sine, cosine) = field::Real::sin_cos(GOLDEN * f64::from(i));
        DVec3::new(radius * cosine, radius * sine, z)
    })
}
