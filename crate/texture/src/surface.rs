//! Parameters of shading at a point of a surface, and mixtures of them.

use crate::uv::Uv;
use glam::{DVec3, Vec3};
use serde::{Deserialize, Serialize};

/// The parameters of shading at a point: what textures change.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Surface {
    /// Share of a light's colour scattered evenly.
    pub diffuse: Vec3,
    /// Light given off whatever the lights do.
    pub ambient: Vec3,
    /// Share of a light's colour in the highlight.
    pub specular: Vec3,
    /// Share of the light from the mirrored direction.
    pub reflective: Vec3,
    /// Share of the light from the refracted direction.
    pub transparent: Vec3,
    /// Index of refraction, inside over outside.
    pub index: f32,
    /// Exponent of the highlight.
    pub shine: f32,
    /// Outward unit normal that light sees.
    pub normal: DVec3,
}

impl Default for Surface {
    /// White, dull and opaque, facing +z.
    fn default() -> Self {
        Self {
            diffuse: Vec3::ONE,
            ambient: Vec3::ZERO,
            specular: Vec3::ZERO,
            reflective: Vec3::ZERO,
            transparent: Vec3::ZERO,
            index: 1.0,
            shine: 1.0,
            normal: DVec3::Z,
        }
    }
}

/// Place at which a texture is evaluated, in texture space: the coordinates of the object to which
/// the texture belongs, before the object's own transforms.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Site {
    /// The point.
    pub point: DVec3,
    /// Outward unit normal of the surface itself, without bumps.
    pub normal: DVec3,
    /// Texture coordinates and their gradients.
    pub uv: Uv,
}

/// Returns a weight as it counts in [`blend`]: 0 if it is negative or not finite.
fn counts(weight: f64) -> f64 {
    if weight > 0.0 && weight.is_finite() {
        weight
    } else {
        0.0
    }
}

/// Returns a weight divided by the largest one, and 1 where no weight counts.
fn share(weight: f64, most: f64) -> f64 {
    if most > 0.0 {
        counts(weight) / most
    } else {
        1.0
    }
}

/// Mixes surfaces by weights: every parameter is the weighted mean, index and shine included, and
/// the normal is the mean of the normals, of length 1 (thesis, section 4.2.5). Weights need not sum
/// to 1; those that are negative or not finite count as 0, and if none is left all surfaces count
/// alike. `None` if there are no surfaces.
///
/// ```
/// use texture::{Surface, blend};
/// let air = Surface { index: 1.0, ..Surface::default() };
/// let glass = Surface { index: 1.5, ..Surface::default() };
/// assert_eq!(blend(&[(3.0, air), (1.0, glass)]).unwrap().index, 1.125);
/// ```
#[must_use]
pub fn blend(parts: &[(f64, Surface)]) -> Option<Surface> {
    let (_, first) = parts.first()?;
    if parts.len() == 1 {
        return Some(*first);
    }
    let most = parts.iter().map(|&(w, _)| counts(w)).fold(0.0, f64::max);
    // Divided by the largest first, so that no sum is infinite.
    let sum: f64 = parts.iter().map(|&(w, _)| share(w, most)).sum();
    let mut colours = [[0.0; 3]; 5];
    let (mut index, mut shine, mut normal) = (0.0, 0.0, DVec3::ZERO);
    for (weight, surface) in parts {
        let share = share(*weight, most) / sum;
        let own = [
            surface.diffuse,
            surface.ambient,
            surface.specular,
            surface.reflective,
            surface.transparent,
        ];
        for (sums, colour) in colours.iter_mut().zip(own) {
            for (sum, channel) in sums.iter_mut().zip(colour.to_array()) {
                *sum += share * f64::from(channel);
            }
        }
        index += share * f64::from(surface.index);
        shine += share * f64::from(surface.shine);
        normal += share * surface.normal;
    }
    let [diffuse, ambient, specular, reflective, transparent] =
        colours.map(|colour| Vec3::from_array(colour.map(|channel| channel as f32)));
    let strongest = parts.iter().fold(&parts[0], |best, part| {
        if counts(part.0) > counts(best.0) {
            part
        } else {
            best
        }
    });
    Some(Surface {
        diffuse,
        ambient,
        specular,
        reflective,
        transparent,
        index: index as f32,
        shine: shine as f32,
        normal: normal.normalize_or(strongest.1.normal),
    })
}
