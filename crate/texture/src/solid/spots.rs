//! Moon, ripples, paint: patterns around scattered points.

use super::{Grain, mix, smooth};
use crate::noise::{fractal, noise, scatter, scramble, unit, warp};
use core::f64::consts::TAU;
use glam::DVec3;

/// Rings of ripples in a unit.
pub const RIPPLES: f64 = 5.0;

/// Height of a crater over the plain, in radii, at distance x radii from its middle: a bowl with a
/// flat floor, a rim, and a slope outside that ends at 1.6.
fn crater(x: f64) -> f64 {
    const FLOOR: f64 = -0.34;
    const RIM: f64 = 0.13;
    if x < 1.0 {
        mix(FLOOR, RIM, smooth(0.3, 1.0, x))
    } else {
        let t = ((1.6 - x) / 0.6).max(0.0);
        RIM * t * t
    }
}

/// Height of the moon's ground, in units: four sizes of craters and rough ground.
pub fn craters(q: DVec3, grain: Grain) -> f64 {
    // Craters are not quite round.
    let bent = q + grain.turbulence * 0.02 * warp(q * 3.0, grain.octaves.min(2.0));
    let (mut height, mut size) = (0.0, 0.8);
    for seed in 0..4 {
        let p = bent / size + DVec3::splat(0.37 * f64::from(seed));
        scatter(p, 31 + seed, |hash, at| {
            let luck = unit(hash);
            if luck < 0.55 {
                // Small ones are more frequent.
                let radius = mix(0.2, 0.6, luck * luck * 3.3);
                let x = at.distance(p) / radius;
                if x < 1.6 {
                    height += radius * size * crater(x);
                }
            }
        });
        size *= 0.52;
    }
    height + grain.turbulence * 0.012 * fractal(q * 5.0, grain.octaves)
}

/// Brightness of the moon: ground, dark plains, dark floors and bright rims.
pub fn moon(q: DVec3, grain: Grain) -> f64 {
    let plain = noise(q * 0.85 + DVec3::new(7.1, 2.2, 5.8))
        + grain.turbulence * 0.25 * fractal(q * 2.1, grain.octaves);
    let dark = smooth(-0.02, 0.3, plain);
    0.78 - 0.3 * dark
        + 2.4 * craters(q, grain).clamp(-0.16, 0.1)
        + grain.turbulence * 0.05 * fractal(q * 9.0, grain.octaves)
}

/// Waves in [−1, 1]: rings around scattered drops, dying out at two and a half units.
pub fn ripples(q: DVec3, grain: Grain) -> f64 {
    const REACH: f64 = 2.5;
    let q = q + grain.turbulence * 0.01 * warp(q * 1.5, grain.octaves.min(2.0));
    let p = q / REACH;
    let mut sum = 0.0;
    scatter(p, 43, |hash, at| {
        let d = at.distance(p);
        // Few drops, else no ring is seen for all the others.
        if d < 1.0 && unit(hash) < 0.4 {
            let fade = 1.0 - d * d;
            sum += 1.5 * fade * fade * libm::cos(TAU * (RIPPLES * REACH * d - 2.5 * unit(hash)));
        }
    });
    // Where drops meet their waves add up; this keeps them within ±1.
    sum / (1.0 + sum * sum).sqrt()
}

/// Returns a bright colour: hue by a hash.
fn bright(hash: u32) -> [f64; 3] {
    const COLOURS: [[f64; 3]; 7] = [
        [0.90, 0.10, 0.12],
        [1.00, 0.55, 0.05],
        [1.00, 0.86, 0.10],
        [0.12, 0.65, 0.22],
        [0.08, 0.38, 0.85],
        [0.50, 0.15, 0.65],
        [0.06, 0.06, 0.08],
    ];
    COLOURS[(hash >> 7) as usize % COLOURS.len()]
}

/// Colour and thickness (0 to 1) of splashes: large blots with ragged arms, then smaller ones and
/// droplets upon them.
pub fn paint(q: DVec3, grain: Grain) -> ([f64; 3], f64) {
    let (mut colour, mut thick) = ([1.0; 3], 0.0_f64);
    let mut size = 1.5;
    for seed in 0..4 {
        let p = q / size + DVec3::splat(0.41 * f64::from(seed));
        let ragged = grain.turbulence * 0.3 * fractal(p * 2.6, grain.octaves.min(2.0))
            + grain.turbulence * 0.22 * noise(p * 6.5);
        let (mut best, mut hash) = (0.0, 0);
        scatter(p, 61 + seed, |cell, at| {
            let luck = unit(cell);
            if luck < 0.5 {
                let radius = mix(0.22, 0.52, luck * 2.0);
                let depth = radius * (1.0 + ragged) - at.distance(p);
                if depth > best {
                    (best, hash) = (depth, cell);
                }
            }
        });
        let cover = smooth(0.0, 0.03, best * size);
        let paint = bright(scramble(hash));
        for i in 0..3 {
            colour[i] = mix(colour[i], paint[i], cover);
        }
        thick = mix(
            thick,
            (thick + 1.0).min(2.0),
            smooth(0.0, 0.12, best * size),
        );
        size *= 0.5;
    }
    (colour, 0.5 * thick)
}
