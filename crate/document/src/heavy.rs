//! Scenes that would keep the workers busy for very long: a picture of them is not begun before the
//! user has said so.

use scene::{Scene, extent};

/// Most elements of a scene that is traced at once.
const MOST: usize = 150_000;
/// Most elements of a scene that is made of a part of a text only, as that has errors: perhaps its
/// loops were stopped.
const PART: usize = 20_000;
/// Most elements that may share a place, on average over the scene.
const SHARED: f64 = 2000.0;

/// Whether a scene has so many elements, or so many at each place, that a picture may take hours.
/// `is_part`: its text has errors.
#[must_use]
pub fn is_heavy(scene: &Scene, is_part: bool) -> bool {
    let count = scene.elements.len();
    if is_part && count > PART {
        return true;
    }
    if count > MOST || (count as f64) < SHARED {
        return count > MOST;
    }
    let shapes = scene.elements.iter().map(|element| &element.shape);
    let Some((_, whole)) = extent(shapes.clone()) else {
        return false;
    };
    let whole = whole.max(f64::MIN_POSITIVE);
    let shares = shapes.filter_map(|shape| shape.bounding_sphere());
    let sum: f64 = shares
        .map(|(_, radius)| cube((radius / whole).min(1.0)))
        .sum();
    sum > SHARED
}

fn cube(side: f64) -> f64 {
    side * side * side
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::Session;

    #[test]
    fn many_elements_and_many_at_one_place_are_heavy() {
        for (loops, is_so) in [
            // The language stops this loop.
            ("190000 { sphere s 0.001, i 0 0 }", true),
            ("100000 { sphere s 0.006, <rand rand rand> }", false),
            ("20000 { sphere s 1, 0 0 0 }", true),
            ("20000 { sphere s 0.1, <rand rand rand> }", false),
            ("1000 { sphere s 1, 0 0 0 }", false),
        ] {
            let text = format!("surface s, diffuse Red, blobbiness -1\nfor i = 1 to {loops}\n");
            let session = Session::of_text(&text);
            let is_part = session.errors() > 0;
            assert_eq!(is_part, loops.starts_with("190000"), "{loops}");
            assert_eq!(
                is_heavy(session.scene().unwrap(), is_part),
                is_so,
                "{loops}"
            );
        }
    }
}
