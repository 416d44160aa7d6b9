//! The map that brings a scene to unit size around the origin.
//!
//! Single precision is used where rays meet the soft surface, so a scene far from the origin, very
//! large or very small would lose digits. Before tracing it is moved to the origin and scaled to
//! about unit size, for pictures by a power of two (which costs no digits). Nothing else changes:
//! fields, angles and colours are the same.
use crate::{Element, LightKind, Scene, Shape};
use field::skeleton::Map;
use glam::{DAffine3, DQuat, DVec3};

/// The map from the world to the unit scene: `scale·(p − center)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    center: DVec3,
    scale: f64,
}

impl Unit {
    /// The map that changes nothing.
    pub const IDENTITY: Self = Self {
        center: DVec3::ZERO,
        scale: 1.0,
    };

    /// Returns the map of a ball to that of radius 1 around the origin. The radius must be > 0.
    #[must_use]
    pub fn of_ball(center: DVec3, radius: f64) -> Self {
        Self {
            center,
            scale: 1.0 / radius,
        }
    }

    /// Returns the map that fits a scene, and the scene mapped as [`Unit::map_scene`] does.
    #[must_use]
    pub fn fit(scene: &Scene) -> (Self, Scene) {
        let mut mapped = scene.clone();
        let nothing = drop_endless(&mut mapped);
        let mut low = DVec3::INFINITY;
        let mut high = DVec3::NEG_INFINITY;
        for element in mapped.elements.iter().filter(|e| **e != nothing) {
            let (a, b) = corners(&element.shape);
            let radius = DVec3::splat(scene.radius(element).abs().min(f64::MAX));
            low = low.min(a - radius);
            high = high.max(b + radius);
        }
        let center = 0.5 * (low + high);
        let half = (0.5 * (high - low)).max_element();
        let unit = if center.is_finite() && half.is_finite() {
            let scale = if half > 1e-200 {
                libm::exp2(-libm::floor(libm::log2(half)))
            } else {
                1.0
            };
            Self { center, scale }
        } else {
            Self::IDENTITY
        };
        unit.apply(&mut mapped);
        (unit, mapped)
    }

    /// Returns a scene mapped. Elements with coordinates that are not finite, which no ray can
    /// meet, become hard balls of radius 0, which have no surface, so that all elements keep their
    /// numbers.
    #[must_use]
    pub fn map_scene(&self, scene: &Scene) -> Scene {
        let mut mapped = scene.clone();
        drop_endless(&mut mapped);
        self.apply(&mut mapped);
        mapped
    }

    /// Maps a scene.
    fn apply(&self, scene: &mut Scene) {
        let k = self.scale;
        for element in &mut scene.elements {
            element.shape = element.shape.transform(self);
        }
        for frame in &mut scene.frames {
            frame.growth *= k;
            frame.to_world = self.affine() * frame.to_world;
        }
        for light in &mut scene.lights {
            match &mut light.kind {
                LightKind::Point { position } | LightKind::Spot { position, .. } => {
                    *position = self.map(*position);
                    light.size *= k;
                }
                LightKind::Distant { .. } => {}
            }
        }
        scene.camera.eye = self.map(scene.camera.eye);
        scene.camera.target = self.map(scene.camera.target);
    }

    /// Converts a point from the world to the unit scene.
    #[must_use]
    pub fn map(&self, point: DVec3) -> DVec3 {
        (point - self.center) * self.scale
    }

    /// Converts a point from the unit scene to the world.
    #[must_use]
    pub fn world(&self, point: DVec3) -> DVec3 {
        point / self.scale + self.center
    }

    /// Converts a length from the unit scene to the world.
    #[must_use]
    pub fn length(&self, length: f64) -> f64 {
        length / self.scale
    }
}

/// Returns the least height of a scene's elements along the scene's `up`, apart from planes; 0
/// without any.
#[must_use]
pub fn lowest(scene: &Scene) -> f64 {
    let up = scene.up.normalize_or(DVec3::Y);
    let mut lowest = f64::INFINITY;
    for element in &scene.elements {
        if let Some((low, high)) = element.shape.bounds(0.0) {
            let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
            let radius = scene.radius(element).abs();
            lowest = lowest.min(middle.dot(up) - half.dot(up.abs()) - radius);
        }
    }
    if lowest.is_finite() { lowest } else { 0.0 }
}

/// Directions stay as they are, to the bit.
impl Map for Unit {
    fn point(&self, point: DVec3) -> DVec3 {
        self.map(point)
    }

    fn vector(&self, vector: DVec3) -> DVec3 {
        vector * self.scale
    }

    fn normal(&self, normal: DVec3) -> DVec3 {
        normal
    }

    fn axes(&self, axes: [DVec3; 2]) -> [DVec3; 2] {
        axes
    }

    fn length(&self, length: f64) -> f64 {
        length * self.scale
    }

    fn affine(&self) -> DAffine3 {
        DAffine3::from_scale_rotation_translation(
            DVec3::splat(self.scale),
            DQuat::IDENTITY,
            -self.scale * self.center,
        )
    }
}

/// Replaces elements that are not finite by one without a surface, and returns that.
fn drop_endless(scene: &mut Scene) -> Element {
    let nothing = Element::new(Shape::sphere(DVec3::ZERO, 0.0));
    for element in &mut scene.elements {
        let (low, high) = corners(&element.shape);
        if !low.is_finite() || !high.is_finite() {
            *element = nothing.clone();
        }
    }
    nothing
}

/// Returns the least and the greatest corner of a box that holds a shape's skeleton; of a plane its
/// point.
fn corners(shape: &Shape) -> (DVec3, DVec3) {
    let middle = shape.middle();
    shape.bounds(0.0).unwrap_or((middle, middle))
}
