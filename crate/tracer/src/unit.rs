//! The map that brings a scene to unit size around the origin.
//!
//! Single precision is used where rays meet the soft surface, so a scene far from the origin, very
//! large or very small would lose digits. Before tracing it is moved to the origin and scaled by a
//! power of two (which costs no digits) to about unit size. Nothing else changes: fields, angles
//! and colours are the same.
use glam::{DAffine3, DQuat, DVec3};
use scene::{Element, LightKind, Origin, Scene, Shape};

/// An element without a surface, in place of one that no ray can meet.
const NOTHING: Element = Element {
    shape: Shape::Sphere {
        center: DVec3::ZERO,
        radius: 0.0,
    },
    flesh: None,
    finish: 0,
    body: 0,
    frame: 0,
    kernel: field::Kernel::Cauchy,
    origin: Origin {
        file: 0,
        start: 0,
        end: 0,
    },
    paint: None,
};

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

    /// Returns the map that fits a scene, and the scene mapped. Elements with coordinates that are
    /// not finite, which no ray can meet, become hard balls of radius 0, which have no surface, so
    /// that all elements keep their numbers.
    #[must_use]
    pub fn fit(scene: &Scene) -> (Self, Scene) {
        let mut mapped = scene.clone();
        for element in &mut mapped.elements {
            let (low, high) = corners(&element.shape);
            if !low.is_finite() || !high.is_finite() {
                *element = NOTHING;
            }
        }
        let mut low = DVec3::INFINITY;
        let mut high = DVec3::NEG_INFINITY;
        for element in mapped.elements.iter().filter(|e| **e != NOTHING) {
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

    /// Maps a scene.
    fn apply(&self, scene: &mut Scene) {
        let k = self.scale;
        for element in &mut scene.elements {
            match &mut element.shape {
                Shape::Sphere { center, radius } => {
                    *center = self.map(*center);
                    *radius *= k;
                }
                Shape::Cylinder { base, apex, radius } | Shape::Pipe { base, apex, radius } => {
                    *base = self.map(*base);
                    *apex = self.map(*apex);
                    *radius *= k;
                }
                Shape::Arc {
                    center,
                    sweep,
                    radius,
                    ..
                } => {
                    *center = self.map(*center);
                    *sweep *= k;
                    *radius *= k;
                }
                Shape::Triangle { corners, radius } => {
                    *corners = corners.map(|c| self.map(c));
                    *radius *= k;
                }
                Shape::Polygon { rings, radius } => {
                    for corner in rings.iter_mut().flatten() {
                        *corner = self.map(*corner);
                    }
                    *radius *= k;
                }
                Shape::Curve { control, radius } => {
                    *control = control.map(|c| self.map(c));
                    *radius *= k;
                }
                Shape::Plane { point, radius, .. } => {
                    *point = self.map(*point);
                    *radius *= k;
                }
                Shape::Cone {
                    base,
                    base_radius,
                    apex,
                    apex_radius,
                } => {
                    *base = self.map(*base);
                    *apex = self.map(*apex);
                    *base_radius *= k;
                    *apex_radius *= k;
                }
                Shape::Box { center, axes } => {
                    *center = self.map(*center);
                    *axes = axes.map(|axis| axis * k);
                }
                Shape::Patch { corners, .. } => *corners = corners.map(|c| self.map(c)),
                Shape::Quadric(quadric) => {
                    quadric.center = self.map(quadric.center);
                    quadric.axes = quadric.axes.map(|axis| axis * k);
                }
                Shape::Function(function) => **function = function.moved(&self.to_unit()),
            }
        }
        for frame in &mut scene.frames {
            frame.growth *= k;
            frame.to_world = self.to_unit() * frame.to_world;
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

    /// Returns the map from the world to the unit scene.
    fn to_unit(self) -> DAffine3 {
        DAffine3::from_scale_rotation_translation(
            DVec3::splat(self.scale),
            DQuat::IDENTITY,
            -self.scale * self.center,
        )
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
        if !matches!(element.shape, Shape::Plane { .. }) {
            let (low, high) = corners(&element.shape);
            let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
            let radius = scene.radius(element).abs();
            lowest = lowest.min(middle.dot(up) - half.dot(up.abs()) - radius);
        }
    }
    if lowest.is_finite() { lowest } else { 0.0 }
}

/// Returns the least and the greatest corner of a box that holds a shape's skeleton.
fn corners(shape: &Shape) -> (DVec3, DVec3) {
    match *shape {
        Shape::Polygon { ref rings, .. } => extent(rings.iter().flatten()),
        Shape::Curve { ref control, .. } => extent(control),
        Shape::Sphere { center, .. } => (center, center),
        Shape::Cylinder { base, apex, .. }
        | Shape::Pipe { base, apex, .. }
        | Shape::Cone { base, apex, .. } => extent(&[base, apex]),
        Shape::Arc { center, sweep, .. } => {
            (center - DVec3::splat(sweep), center + DVec3::splat(sweep))
        }
        Shape::Triangle { ref corners, .. } | Shape::Patch { ref corners, .. } => extent(corners),
        Shape::Plane { point, .. } => (point, point),
        Shape::Box { center, axes } => extent_of_box(center, axes),
        Shape::Quadric(ref quadric) => extent_of_box(quadric.center, quadric.axes),
        Shape::Function(ref function) => function.corners(),
    }
}

/// Returns the least and the greatest coordinates of some points; NaN if a coordinate is NaN.
fn extent<'a>(points: impl IntoIterator<Item = &'a DVec3>) -> (DVec3, DVec3) {
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for p in points {
        if p.is_nan() {
            return (DVec3::NAN, DVec3::NAN);
        }
        (low, high) = (low.min(*p), high.max(*p));
    }
    (low, high)
}

/// Returns the least and the greatest coordinates of a box, given by its middle and half axes.
fn extent_of_box(center: DVec3, axes: [DVec3; 3]) -> (DVec3, DVec3) {
    let reach = axes[0].abs() + axes[1].abs() + axes[2].abs();
    (center - reach, center + reach)
}
