//! Phong's model: ambient light, and for each source a diffuse and a specular share.
//!
//! `ambient + Σ light·(diffuse·(N·L) + specular·(R·V)^shine)`, where N is the normal, L points to
//! the light, R is L mirrored at N and V points to the eye.
use glam::{DVec3, Vec3};
use scene::{Light, LightKind};
use texture::Surface;
use wide::f32x4;

/// A surface's colours for Phong's model; those of several materials can be mixed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Finish {
    ambient: Vec3,
    diffuse: Vec3,
    specular: Vec3,
    shine: f32,
}

impl Finish {
    /// Prepares a finish of the scene.
    #[must_use]
    pub fn of(finish: &scene::Finish) -> Self {
        Self {
            ambient: Vec3::from(finish.ambient),
            diffuse: Vec3::from(finish.diffuse),
            specular: Vec3::from(finish.specular),
            shine: finish.shine.max(0.0),
        }
    }

    /// Returns the part of a material that Phong's model needs.
    #[must_use]
    pub fn of_surface(surface: &Surface) -> Self {
        Self {
            ambient: surface.ambient,
            diffuse: surface.diffuse,
            specular: surface.specular,
            shine: surface.shine,
        }
    }

    /// Returns the finish of a surface that only scatters light.
    #[must_use]
    pub fn dull(diffuse: Vec3) -> Self {
        Self {
            diffuse,
            ..Self::default()
        }
    }

    /// Returns the share of light that is scattered evenly.
    #[must_use]
    pub fn diffuse(&self) -> Vec3 {
        self.diffuse
    }

    /// Adds a share of another finish.
    pub fn mix(&mut self, other: &Self, share: f32) {
        self.ambient += other.ambient * share;
        self.diffuse += other.diffuse * share;
        self.specular += other.specular * share;
        self.shine += other.shine * share;
    }

    /// Returns the ambient light, which does not depend on sources.
    #[must_use]
    pub fn glow(&self) -> Vec3 {
        self.ambient
    }

    /// Returns the light of a source (unit vector `towards` it) that a surface with unit `normal`
    /// sends to the eye (unit vector `view` from the eye).
    #[must_use]
    pub fn shade(&self, colour: Vec3, normal: Vec3, towards: Vec3, view: Vec3) -> Vec3 {
        let cosine = normal.dot(towards);
        if cosine.is_nan() || cosine <= 0.0 {
            return Vec3::ZERO;
        }
        let mut share = self.diffuse * cosine;
        if self.specular != Vec3::ZERO {
            let mirrored = normal * (2.0 * cosine) - towards;
            let glance = -mirrored.dot(view);
            if glance > 0.0 {
                share += self.specular * libm::powf(glance, self.shine);
            }
        }
        colour * share
    }
}

/// Returns the direction and distance from a point to a light source.
#[must_use]
pub fn towards(light: &Light, point: DVec3) -> (DVec3, f64) {
    match light.kind {
        LightKind::Distant { towards } => {
            (towards.try_normalize().unwrap_or(DVec3::Z), f64::INFINITY)
        }
        LightKind::Point { position } | LightKind::Spot { position, .. } => {
            let way = position - point;
            (way.try_normalize().unwrap_or(DVec3::Z), way.length())
        }
    }
}

/// Converts a colour for the screen: gamma-corrected (`value^(1/gamma)`), 8 bits a channel.
#[must_use]
pub fn bytes(colour: Vec3, gamma: f32) -> [u8; 3] {
    let power = if gamma > 0.0 { 1.0 / gamma } else { 1.0 };
    let mut colour = clamp(colour).to_array();
    if power != 1.0 {
        colour = colour.map(|v| libm::powf(v, power));
    }
    let [red, green, blue] = colour.map(|v| (v * 255.0 + 0.5) as u8);
    [red, green, blue]
}

/// Clamps each channel between 0 and 1; NaN becomes 0. By lanes: in wasm a choice between two
/// single numbers is a branch, and these cannot be predicted.
#[must_use]
pub fn clamp(colour: Vec3) -> Vec3 {
    let [zero, one] = [0.0, 1.0].map(f32x4::splat);
    let colour = f32x4::new([colour.x, colour.y, colour.z, 0.0]);
    let colour = zero.simd_lt(colour).select(colour, zero);
    let [red, green, blue, _] = colour.simd_lt(one).select(colour, one).to_array();
    Vec3::new(red, green, blue)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_cut_to_what_a_screen_shows() {
        let (far, none) = (f32::INFINITY, f32::NAN);
        for (colour, want) in [
            ([0.0, 0.5, 1.0], [0.0, 0.5, 1.0]),
            ([-0.0, -1.0, 2.0], [0.0, 0.0, 1.0]),
            ([-far, far, none], [0.0, 1.0, 0.0]),
        ] {
            assert_eq!(clamp(Vec3::from(colour)), Vec3::from(want), "{colour:?}");
        }
    }

    #[test]
    fn bytes_are_corrected_by_gamma() {
        let colour = Vec3::new(0.25, 0.6, f32::NAN);
        // 0.25 · 255 = 63.75, and its root is half.
        for (gamma, want) in [
            (1.0, [64, 153, 0]),
            (2.0, [128, 198, 0]),
            (0.0, [64, 153, 0]),
            (-1.0, [64, 153, 0]),
            (f32::NAN, [64, 153, 0]),
        ] {
            assert_eq!(bytes(colour, gamma), want, "{gamma}");
        }
        assert_eq!(
            bytes(Vec3::new(-1.0, 2.0, f32::INFINITY), 2.2),
            [0, 255, 255]
        );
    }
}
