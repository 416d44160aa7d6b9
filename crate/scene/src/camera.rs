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
    /// Horizontal angle of view in degrees, in (0, 180). Pixels are square, so the vertical angle
    /// follows from the picture's proportions: the published seahorse asks for 13°×13° in a
    /// 160×256 frame and fits only when read so.
    pub fov: f64,
    /// Shift of the picture across the view, in halves of its width to the right and up: 0 0 has
    /// the target in the middle (`window`, Foley's camera).
    #[serde(default)]
    pub shift: [f64; 2],
}

impl Default for Camera {
    fn default() -> Self {
        Self {
            eye: DVec3::new(0.0, 0.0, 10.0),
            target: DVec3::ZERO,
            up: DVec3::Y,
            fov: 45.0,
            shift: [0.0; 2],
        }
    }
}

impl Camera {
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
        let half_width = libm::tan(self.fov.clamp(0.01, 179.0).to_radians() * 0.5);
        let half_height = half_width * f64::from(height.max(1)) / f64::from(width.max(1));
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
