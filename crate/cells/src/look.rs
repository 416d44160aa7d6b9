//! Colours of materials as the draft shows them.

use glam::DVec3;
use scene::{Finish, Rgb};
use texture::{Method, Target};

/// The share of the background's mean colour that mirrors and glass show.
const AROUND: f32 = 0.6;

/// The ambient and diffuse colours of a material under its textures: each pattern counts as if it
/// were half its lowest and half its highest value everywhere, which is what the draft shows of it.
/// A mirror or glass without colours of its own would be black: its reflective and transparent
/// share gives it a grey, and a part of the background's colour `around`.
#[must_use]
pub fn draft_colours(material: &Finish, around: Rgb) -> [Rgb; 2] {
    let mut colours = [material.ambient, material.diffuse];
    for layer in &material.layers {
        let targets: &[usize] = match layer.target {
            Target::Ambient => &[0],
            Target::Diffuse => &[1],
            Target::Pigment => &[0, 1],
            _ => continue,
        };
        let middle = match layer.method {
            Method::Colour(colour) => colour,
            _ => DVec3::splat(0.5),
        };
        let [low, high] = layer.bounds;
        let value = (layer.times * (low + (high - low) * middle)).as_vec3();
        for &target in targets {
            let old = colours[target];
            // An ambient light that is replaced keeps its share of the colour.
            let scale = if layer.replace && target == 1 {
                [1.0; 3]
            } else {
                old
            };
            colours[target] = [0, 1, 2].map(|i| scale[i] * value[i]);
        }
    }
    let [ambient, diffuse] = colours;
    let through = [0, 1, 2].map(|i| material.reflective[i] + material.transparent[i]);
    [
        [0, 1, 2].map(|i| ambient[i] + AROUND * (through[i] * around[i]).clamp(0.0, 1.0)),
        [0, 1, 2].map(|i| diffuse[i].max(0.35 * through[i].min(1.0))),
    ]
}

/// Returns a colour as finite numbers, with a fourth one.
#[must_use]
pub fn with([red, green, blue]: Rgb, fourth: f32) -> [f32; 4] {
    [finite(red), finite(green), finite(blue), fourth]
}

/// Returns the number if it is finite, else 0: a GPU may do anything with others.
#[must_use]
pub fn finite(x: f32) -> f32 {
    if x.is_finite() { x } else { 0.0 }
}
