//! Onion and checker: patterns of planes and shells.

use super::{Grain, smooth};
use crate::noise::{noise, scramble, unit};
use glam::DVec3;

/// Sides of cubes are moved by this, so that an object's face on a border is of one colour,
/// whatever rounding does.
const NUDGE: f64 = 1e-5;

pub fn checker(q: DVec3) -> f64 {
    let cells = (q + NUDGE).floor();
    let sum = odd(cells.x) + odd(cells.y) + odd(cells.z);
    if odd(sum) == 0.0 { 1.0 } else { 0.0 }
}

/// Returns the remainder of a whole number by 2: 0 or 1.
fn odd(x: f64) -> f64 {
    x - 2.0 * (0.5 * x).floor()
}

/// The checker's height: 1 and 0, with slopes a tenth of a unit wide between the cubes.
pub fn checker_height(q: DVec3) -> f64 {
    // 1 in even units, −1 in odd ones, 0 on their borders.
    let [x, y, z] = q.to_array().map(|x| {
        let x = 0.5 * x;
        let place = 2.0 * (x - x.floor());
        let to_border = if place < 1.0 {
            place.min(1.0 - place)
        } else {
            -(place - 1.0).min(2.0 - place)
        };
        (20.0 * to_border).clamp(-1.0, 1.0)
    });
    0.5 + 0.5 * x * y * z
}

/// Shells around the origin. Their borders are at (k + ½)/4, so that round sizes lie in the middle
/// of flesh.
pub fn onion(q: DVec3, grain: Grain) -> f64 {
    let t = grain.turbulence;
    let r = q.length();
    let shells = 4.0 * r + 0.5 + t * 0.22 * noise(q * 1.6 + DVec3::splat(3.9));
    let index = shells.floor();
    let place = shells - index;
    let random = unit(scramble(index as i64 as u32 ^ 0xa7));
    // A dark skin at both ends of the flesh; flesh that is brightest in the middle, of varying
    // brightness.
    let flesh = smooth(0.0, 0.16, place) * (1.0 - smooth(0.9, 1.0, place));
    let glow = smooth(0.0, 0.6, place) * (1.0 - smooth(0.6, 1.0, place));
    // Lines from pole to pole: noise of the longitude alone, fading at the axis, where it has none.
    let around = (q.x * q.x + q.z * q.z).sqrt();
    let line = if around > 0.0 {
        let (x, z) = (q.x / around, q.z / around);
        let along = if r > 0.0 { q.y / r } else { 0.0 };
        let [coarse, fine] =
            [9.0, 23.0].map(|f| noise(DVec3::new(f * x, 0.8 * along + 5.0 * index, f * z)));
        let fade = smooth(0.0, 0.35, around / r);
        fade * (0.6 * coarse + 0.6 * fine)
    } else {
        0.0
    };
    0.3 + flesh * (0.4 + 0.1 * random + 0.2 * glow + t.clamp(-1.0, 1.0) * 0.3 * line)
}
