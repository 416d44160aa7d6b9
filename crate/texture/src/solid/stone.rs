//! Marble, agate, granite.

use super::{Grain, mix, smooth};
use crate::noise::{fractal, noise, scatter, scramble, unit, warp};
use core::f64::consts::PI;
use glam::DVec3;

/// 1 where x is 0, falling to 0 at ±`width`.
fn ridge(x: f64, width: f64) -> f64 {
    let t = (1.0 - x.abs() / width).max(0.0);
    t * t
}

/// Planes across x, bent by noise: dark where `sin πx` crosses 0, with a soft shade around and
/// finer veins between.
pub fn marble(q: DVec3, grain: Grain) -> f64 {
    let t = grain.turbulence;
    let bent = t * fractal(q, grain.octaves);
    let main = libm::sin(PI * (q.x + 0.3 * q.y + 1.3 * bent));
    // Fine veins wander across: where a second noise is 0.
    let second = fractal(q * 1.4 + DVec3::new(5.2, 1.3, 8.1), grain.octaves) + 0.35 * bent;
    let fine = t.abs().min(1.0) * ridge(second, 0.09);
    // A vein is here strong, there a breath.
    let strength = 0.55 + 0.45 * noise(q * 1.1 + DVec3::splat(9.4));
    let cloud = 0.07 * t.clamp(-1.0, 1.0) * bent.clamp(-1.0, 1.0);
    0.95 + cloud
        - 0.62 * strength * ridge(main, 0.34)
        - 0.26 * (1.0 - main.abs()) * (1.0 - main.abs())
        - 0.34 * fine * (0.5 + 0.5 * strength)
}

/// Returns the random number in [0, 1) of a whole number.
fn step(index: f64, seed: u32) -> f64 {
    unit(scramble(
        (index as i64 as u32).wrapping_mul(0x9e37_79b1) ^ seed,
    ))
}

/// Bands of one random brightness each, with short soft edges.
fn bands(x: f64, seed: u32) -> f64 {
    let index = x.floor();
    let t = smooth(0.0, 0.3, x - index);
    mix(step(index - 1.0, seed), step(index, seed), t)
}

/// Level sets of a slow noise, banded coarsely and finely: bands close in on themselves around the
/// noise's hills.
pub fn agate(q: DVec3, grain: Grain) -> f64 {
    let slow =
        noise(q * 0.9 + DVec3::new(0.4, 3.1, 7.7)) + 0.3 * noise(q * 1.9 + DVec3::splat(4.6));
    let level = 1.5 * slow + grain.turbulence * 0.09 * fractal(q * 2.3, grain.octaves);
    let coarse = bands(4.0 * level, 1);
    let medium = bands(13.0 * level, 2);
    let fine = bands(41.0 * level, 3);
    // Sums of random numbers crowd in the middle.
    0.5 + 1.3 * (0.52 * coarse + 0.33 * medium + 0.15 * fine - 0.5)
}

/// Returns two random numbers in [0, 1) of the scattered point that is nearest.
fn crystal(q: DVec3, seed: u32) -> (f64, f64) {
    let (mut nearest, mut hash) = (f64::INFINITY, 0);
    scatter(q, seed, |cell, at| {
        let d = at.distance_squared(q);
        if d < nearest {
            (nearest, hash) = (d, cell);
        }
    });
    (unit(hash), unit(scramble(hash)))
}

/// Cells around scattered points, their borders frayed by noise: a cell is feldspar (light), quartz
/// (grey) or mica (dark); and grains half as large between.
pub fn granite(q: DVec3, grain: Grain) -> f64 {
    let q = q * 11.0;
    let q = q + grain.turbulence * 0.22 * warp(q * 1.2, grain.octaves.min(3.0));
    let (kind, shade) = crystal(q, 11);
    let (small, tone) = crystal(q * 2.1 + DVec3::splat(0.37), 12);
    let base = match kind {
        k if k < 0.17 => 0.06 + 0.14 * shade,
        k if k < 0.5 => 0.46 + 0.2 * shade,
        _ => 0.74 + 0.24 * shade,
    };
    match small {
        s if s < 0.14 => 0.1 + 0.15 * tone,
        s if s < 0.3 => 0.8 + 0.18 * tone,
        _ => base + 0.1 * (tone - 0.5),
    }
}
