//! The camera, and the one projection that the tracer and the draft share.

use glam::{DMat3, DVec3};
use serde::{Deserialize, Serialize};

/// Pinhole camera (`eyep`, `vrp`, `vup`, `fov`).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Camera {
    /// The eye, world coordinates (`eyep`).
    pub eye: DVec3,
    /// The view reference point, in the middle of the picture (`vrp`).
    pub target: DVec3,
    /// The direction that is up in the picture (`vup`); need not be a unit vector.
    pub up: DVec3,
    /// Horizontal angle of view in degrees, in (0, 180). The vertical angle follows from the
    /// picture's proportions and those of its pixels: the published seahorse asks for 13°×13° in a
    /// 160×256 frame and fits only when its pixels are square.
    pub fov: f64,
    /// Shift of the picture across the view, in halves of its width to the right and up: 0 0 has
    /// the target in the middle (`window`, Foley's camera).
    #[serde(default)]
    pub shift: [f64; 2],
    /// Height of a pixel over its width, in [`Camera::PIXELS`]; 1 for square pixels.
    #[serde(default = "square")]
    pub pixel: f64,
}

/// Returns the proportions of square pixels.
fn square() -> f64 {
    1.0
}

impl Default for Camera {
    fn default() -> Self {
        Self {
            eye: DVec3::new(0.0, 0.0, 10.0),
            target: DVec3::ZERO,
            up: DVec3::Y,
            fov: 45.0,
            shift: [0.0; 2],
            pixel: 1.0,
        }
    }
}

impl Camera {
    /// Least and largest angle of view, degrees.
    pub const ANGLES: [f64; 2] = [0.01, 179.0];
    /// Largest shift of a picture, either way.
    pub const MAX_SHIFT: f64 = 2e4;
    /// Least and largest proportions of a pixel.
    pub const PIXELS: [f64; 2] = [1e-3, 1e3];

    /// Places the eye so far away that rays are as good as parallel, as `direction` points from the
    /// target towards it (its last coordinate along `normal`, above 0), and lets the picture show
    /// `half` to either side of the target.
    ///
    /// That is 11,459 halves away, for the least angle of view. Where a true parallel projection
    /// puts a place that is z halves nearer than the target, this one puts it nearer to the edge by
    /// z / 11,459 of its distance from the point below the eye: within z ≤ 5 that is less than half
    /// a pixel of a picture 2,000 wide.
    #[must_use]
    pub fn far(self, axes: [DVec3; 3], direction: DVec3, half: f64) -> Self {
        let [right, up, normal] = axes;
        let distance = half / libm::tan(Self::ANGLES[0].to_radians() * 0.5);
        let lean = direction / direction.z;
        let eye = self.target + (right * lean.x + up * lean.y + normal) * distance;
        Self {
            eye,
            target: eye - normal * distance,
            up,
            fov: Self::ANGLES[0],
            shift: [lean.x, lean.y].map(|lean| -lean * distance / half),
            ..self
        }
    }

    /// The projection of this camera onto a picture of the given size in pixels.
    ///
    /// Degenerate cameras (eye on target, up along the view) are repaired by an arbitrary but
    /// fixed choice, so a projection is always finite.
    #[must_use]
    pub fn projection(&self, width: u32, height: u32) -> Projection {
        let forward = (self.target - self.eye)
            .try_normalize()
            .unwrap_or(DVec3::NEG_Z);
        let right = forward
            .cross(self.up)
            .try_normalize()
            .or_else(|| forward.cross(DVec3::Y).try_normalize())
            .unwrap_or(DVec3::X);
        let up = right.cross(forward);
        let [least, most] = Self::ANGLES;
        let half_width = libm::tan(self.fov.clamp(least, most).to_radians() * 0.5);
        let mut half_height = half_width * f64::from(height.max(1)) / f64::from(width.max(1));
        if self.pixel > 0.0 && self.pixel != 1.0 {
            half_height *= self.pixel.clamp(Self::PIXELS[0], Self::PIXELS[1]);
        }
        Projection {
            eye: self.eye,
            world_from_view: DMat3::from_cols(right, up, -forward),
            half_width,
            half_height,
            shift: self.shift.map(|s| s * half_width),
        }
    }
}

/// Projection of a camera onto a picture. View space looks along −z, x to the right, y up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projection {
    /// The eye in world coordinates.
    pub eye: DVec3,
    /// Turns view directions into world directions (a rotation; its columns are right, up, back).
    pub world_from_view: DMat3,
    /// Tangent of half the horizontal angle of view.
    pub half_width: f64,
    /// Tangent of half the vertical angle of view.
    pub half_height: f64,
    /// Place of the picture's middle, as tangents to the right and up.
    pub shift: [f64; 2],
}

impl Projection {
    /// The unit direction of the ray through a point of the picture: `x` from 0 (left edge) to 1
    /// (right edge), `y` from 0 (top edge) to 1 (bottom edge).
    #[must_use]
    pub fn direction(&self, x: f64, y: f64) -> DVec3 {
        self.view(x, y).normalize()
    }

    /// Returns [`Projection::direction`] with the length that makes it 1 along the view's axis.
    #[must_use]
    pub fn view(&self, x: f64, y: f64) -> DVec3 {
        let view = DVec3::new(
            (2.0 * x - 1.0) * self.half_width + self.shift[0],
            (1.0 - 2.0 * y) * self.half_height + self.shift[1],
            -1.0,
        );
        self.world_from_view * view
    }

    /// Returns the changes of [`Projection::view`] from the left edge of the picture to the right
    /// one, and from the top edge to the bottom: two vectors at right angles.
    #[must_use]
    pub fn across(&self) -> [DVec3; 2] {
        [
            self.world_from_view.x_axis * (2.0 * self.half_width),
            self.world_from_view.y_axis * (-2.0 * self.half_height),
        ]
    }
}
