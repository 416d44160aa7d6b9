//! Mirrors and glass: directions of reflected and refracted rays, and the shares of light they
//! carry.
//!
//! As in RATS the shares are the material's `reflective` and `transparent`, whatever the angle:
//! there is no Fresnel term. Where a ray is totally reflected, the share that would have passed is
//! mirrored as well ([`shares`]).

use glam::{DVec3, Vec3};

/// Wavelengths of red, green and blue light, in µm, at which indices are taken.
pub const WAVELENGTHS: [f64; 3] = [0.61, 0.55, 0.465];

/// Mirror image of a direction at a surface with a unit normal.
#[must_use]
pub fn reflect(direction: DVec3, normal: DVec3) -> DVec3 {
    direction - 2.0 * direction.dot(normal) * normal
}

/// Direction of a ray beyond a surface (Snell's law). `direction` and `normal` have length 1; the
/// normal may point to either side. `ratio` is the index on the side the ray comes from over the
/// index beyond. `None` at total reflection, and if the ratio is not a positive number.
///
/// ```
/// use glam::DVec3;
/// use texture::refraction::refract;
/// let down = -DVec3::Y;
/// assert_eq!(refract(down, DVec3::Y, 1.0 / 1.5), Some(down));
/// let steep = DVec3::new(0.8, -0.6, 0.0); // from glass at 53°, beyond the critical 42°
/// assert_eq!(refract(steep, DVec3::Y, 1.5), None);
/// ```
#[must_use]
pub fn refract(direction: DVec3, normal: DVec3, ratio: f64) -> Option<DVec3> {
    if !(ratio > 0.0 && ratio.is_finite()) {
        return None;
    }
    let falling = -direction.dot(normal);
    let (normal, cos) = if falling < 0.0 {
        (-normal, -falling)
    } else {
        (normal, falling)
    };
    // The part along the surface is stretched by the ratio: the sines' law.
    let along = ratio * (direction + cos * normal);
    let rest = 1.0 - along.length_squared();
    // At the critical angle itself nothing passes.
    (rest > 0.0).then(|| (along - rest.sqrt() * normal).normalize())
}

/// Indices for red, green and blue of a material of index `index` and `dispersion`: by Cauchy's law
/// n = A + B/λ² at [`WAVELENGTHS`], with A and B such that green has the index itself, and blue's
/// is larger than red's by the dispersion. A result that is not positive is replaced by the index.
///
/// ```
/// let [red, green, blue] = texture::refraction::dispersed(1.5, 0.02);
/// assert!(green == 1.5 && red < green && green < blue);
/// assert!((blue - red - 0.02).abs() < 1e-15);
/// ```
#[must_use]
pub fn dispersed(index: f64, dispersion: f64) -> [f64; 3] {
    let [red, green, blue] = WAVELENGTHS.map(|w| 1.0 / (w * w));
    [red, green, blue].map(|power| {
        let n = index + dispersion * (power - green) / (blue - red);
        if n > 0.0 && n.is_finite() { n } else { index }
    })
}

/// Shares of the light from the mirrored and from the refracted direction, where the ray is totally
/// reflected or not.
#[must_use]
pub fn shares(reflective: Vec3, transparent: Vec3, total_reflection: bool) -> [Vec3; 2] {
    if total_reflection {
        [reflective + transparent, Vec3::ZERO]
    } else {
        [reflective, transparent]
    }
}
