//! Check of bulges: one that is wide and high, where a field falls slowly, wraps the other body.
use crate::Bulge;
use field::{Ball, Implicit, THRESHOLD};
use glam::DVec3;

/// Places along each axis of a box at which the contact is looked for.
const PLACES: u32 = 9;
/// Halvings of the steps by which the place found is made better.
const HALVINGS: u32 = 12;
/// Steps through the other body.
const STEPS: u32 = 160;

/// Whether the bulge that another body raises on a body's surface reaches round to the far side of
/// the other: whether `f + b(f′) > T` at the crest of the bulge where a line that goes straight
/// through the contact leaves the other body. Functions are those without contact. `false` if a
/// body has no known end.
#[must_use]
pub fn coats(own: &dyn Implicit, other: &dyn Implicit, bulge: &Bulge) -> bool {
    let (crest, height) = (bulge.crest(), bulge.height());
    let (Some(here), Some(there)) = (own.support_at(crest), other.support_at(crest)) else {
        return false;
    };
    let Some(contact) = contact(own, other, [here, there]) else {
        return false;
    };
    let [away, into] = [own, other].map(|f| DVec3::from_array(f.jet(contact).gradient));
    let direction = (into - away).normalize_or(there.center - here.center);
    let step = 2.0 * there.radius / f64::from(STEPS);
    let along = (0..=STEPS).map(|i| contact + direction * (step * f64::from(i)));
    let inside = along.take_while(|point| other.jet(*point).value >= crest);
    // The line leaves the other body right behind the last point.
    let last = inside.last();
    last.is_some_and(|point| own.jet(point + direction * step).value + height > THRESHOLD)
}

/// Returns the place where the lesser one of two fields is about the largest; `None` if their balls
/// are apart.
fn contact(own: &dyn Implicit, other: &dyn Implicit, balls: [Ball; 2]) -> Option<DVec3> {
    let [low, high] = [-1.0, 1.0].map(|side| {
        let [a, b] = balls.map(|ball| side * ball.center + ball.radius);
        side * a.min(b)
    });
    if low.cmpgt(high).any() {
        return None;
    }
    let functions = [own, other];
    let steps = f64::from(PLACES - 1);
    let places = (0..PLACES * PLACES * PLACES).map(|number| {
        let axes = [number, number / PLACES, number / (PLACES * PLACES)];
        let part = DVec3::from_array(axes.map(|i| f64::from(i % PLACES)));
        low + (high - low) * part / steps
    });
    let mut best = places.fold((f64::NEG_INFINITY, low), |best, place| {
        deeper(functions, best, place)
    });
    let mut step = (high - low) / steps;
    for _ in 0..HALVINGS {
        for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
            for side in [-1.0, 1.0] {
                best = deeper(functions, best, best.1 + side * step * axis);
            }
        }
        step *= 0.5;
    }
    Some(best.1)
}

/// Returns a place with the lesser one of two fields there, or the best one before, if that is
/// deeper.
fn deeper(functions: [&dyn Implicit; 2], best: (f64, DVec3), place: DVec3) -> (f64, DVec3) {
    let [a, b] = functions.map(|function| function.jet(place).value);
    if a.min(b) > best.0 {
        (a.min(b), place)
    } else {
        best
    }
}
