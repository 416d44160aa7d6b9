//! Fog: air that swallows light and glows in its own colour.

use glam::{DVec3, Vec3};

/// Air in which light falls by 1/e over a distance.
///
/// ```
/// use texture::fog::Fog;
/// use glam::DVec3;
/// let fog = Fog { distance: 10.0, height: None };
/// assert!((fog.passes(DVec3::ZERO, DVec3::X, 10.0) - (-1.0_f64).exp()).abs() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fog {
    /// Distance over which light falls by 1/e, > 0; of fog with a height, at y = 0.
    pub distance: f64,
    /// Height over which the fog's density falls by 1/e, > 0; below y = 0 it is as dense as there.
    /// `None`: it is equally dense everywhere.
    pub height: Option<f64>,
}

impl Fog {
    /// Share of light, 0 to 1, that passes along `length` of the ray from `origin` in the unit
    /// `direction`: e to the power of minus the density's integral, in closed form. The length may
    /// be infinite.
    #[must_use]
    pub fn passes(&self, origin: DVec3, direction: DVec3, length: f64) -> f64 {
        if !(self.distance > 0.0 && length > 0.0) {
            return 1.0;
        }
        let path = match self.height {
            Some(height) if height > 0.0 && height.is_finite() => {
                thick(origin.y / height, direction.y / height, length)
            }
            _ => length,
        };
        let passes = libm::exp(-path / self.distance);
        if passes.is_nan() {
            1.0
        } else {
            passes.clamp(0.0, 1.0)
        }
    }

    /// Returns the part of `light` that passes, plus the colour of the fog for the rest.
    #[must_use]
    pub fn veil(
        &self,
        colour: Vec3,
        light: Vec3,
        origin: DVec3,
        direction: DVec3,
        length: f64,
    ) -> Vec3 {
        let passes = self.passes(origin, direction, length) as f32;
        passes * light + (1.0 - passes) * colour
    }
}

/// `∫₀ˡ min(1, e^−(y+st)) dt`: the path's length in air as dense as at y ≤ 0.
fn thick(y: f64, s: f64, length: f64) -> f64 {
    // Where the ray passes the height 0: below it counts in full.
    let cross = if s == 0.0 { f64::INFINITY } else { -y / s };
    if y > 0.0 {
        if s >= 0.0 || cross >= length {
            return above(y, s, length);
        }
        above(y, s, cross) + (length - cross)
    } else if s > 0.0 && cross < length {
        cross + above(0.0, s, length - cross)
    } else {
        length
    }
}

/// `∫₀ˡ e^−(y+st) dt` where y + st ≥ 0 all along.
fn above(y: f64, s: f64, length: f64) -> f64 {
    if s < 0.0 {
        // Backwards, from the end: e^−y times a growing power might be 0 times infinity.
        return above((y + s * length).max(0.0), -s, length);
    }
    let x = s * length;
    let mean = if x == 0.0 || x.is_nan() {
        1.0
    } else {
        -libm::expm1(-x) / x
    };
    // An infinite length with a slope: (1 − e^−∞)/s.
    if length == f64::INFINITY && s > 0.0 {
        libm::exp(-y) / s
    } else {
        libm::exp(-y) * mean * length
    }
}
