//! Wood and sandalwood. Both grow along the z axis.

use super::{Grain, mix, smooth};
use crate::noise::{fractal, noise, scatter, scramble, unit};
use glam::DVec3;

/// Rings whose early wood is light and darkens slowly to late wood, then breaks off.
pub fn wood(q: DVec3, grain: Grain) -> f64 {
    let t = grain.turbulence;
    // A trunk is not quite straight, and its rings not quite round.
    let slow = q * DVec3::new(0.8, 0.8, 0.3);
    let x = q.x + t * 0.16 * noise(slow + DVec3::splat(2.7));
    let y = q.y + t * 0.16 * noise(slow + DVec3::new(11.9, 4.2, 0.8));
    let uneven = t * 0.22 * fractal(q * DVec3::new(1.7, 1.7, 0.5), grain.octaves.min(2.0));
    let rings = 4.0 * (x * x + y * y).sqrt() + uneven;
    let index = rings.floor();
    let place = rings - index;
    let strong = 0.6 + 0.4 * unit(scramble(index as i64 as u32 ^ 0x51));
    let late = strong * smooth(0.15, 0.86, place) * (1.0 - smooth(0.92, 1.0, place));
    // Fibres: noise drawn out along the trunk; they show more in late wood.
    let fibre = fractal(q * DVec3::new(21.0, 21.0, 1.1), grain.octaves.min(3.0));
    let pores = pores(q, DVec3::new(22.0, 22.0, 3.2), 0.5);
    0.93 - 0.56 * late + t.clamp(-1.0, 1.0) * (0.1 * fibre - 0.2 * pores * (0.4 + 0.6 * late))
}

/// Streaks that waver together, light and dark by turns, and pores.
pub fn sandal(q: DVec3, grain: Grain) -> f64 {
    let t = grain.turbulence;
    // Straight fibres that waver together.
    let along = q * DVec3::new(0.7, 0.7, 0.55);
    let sway = t * 0.22;
    let x = q.x + sway * noise(along + DVec3::splat(6.1));
    let y = q.y + sway * noise(along + DVec3::new(3.3, 17.0, 5.5));
    let p = DVec3::new(x, y, q.z);
    let figure = fractal(p * DVec3::new(2.3, 2.3, 0.22), grain.octaves.min(2.0));
    let streak = fractal(p * DVec3::new(8.0, 8.0, 0.25), grain.octaves.min(3.0));
    let fibre = noise(p * DVec3::new(46.0, 46.0, 1.6));
    let pores = pores(p, DVec3::new(17.0, 17.0, 2.2), 0.4);
    0.66 + 0.2 * figure + 0.42 * streak + 0.12 * fibre - 0.4 * pores
}

/// Short dark dashes: balls around scattered points of a space that is stretched along z, in a
/// share of the cells. 1 in the middle of a dash, 0 outside.
fn pores(q: DVec3, scale: DVec3, share: f64) -> f64 {
    let p = q * scale;
    let mut most = 0.0_f64;
    scatter(p, 23, |hash, at| {
        if unit(hash) < share {
            let radius = mix(0.12, 0.3, unit(scramble(hash)));
            let d = at.distance(p) / radius;
            most = most.max(1.0 - smooth(0.3, 1.0, d));
        }
    });
    most
}
