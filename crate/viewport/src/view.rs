//! The camera: a virtual trackball about a movable centre.

use glam::{DMat3, DQuat, DVec2, DVec3};

/// A perspective camera that looks at a centre of rotation.
///
/// ```
/// use glam::DVec3;
/// use viewport::View;
///
/// let mut view = View::around([DVec3::splat(-1.0), DVec3::ONE]);
/// let before = view.axes()[2];
/// view.turn([0.0, 0.0], [0.4, 0.0]);
/// assert!(view.axes()[2].distance(before) > 0.3);
/// let pixel = view.project(view.center, [200, 100]).unwrap();
/// assert_eq!(pixel, [100.0, 50.0]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// The centre of rotation, in the middle of the image.
    pub center: DVec3,
    /// The rotation from the camera's axes (right, up, towards the eye) to the mesh's.
    pub rotation: DQuat,
    /// The distance from the eye to the centre.
    pub distance: f64,
}

/// Half of the image's lesser side over the distance: a field of view of 38°.
const TANGENT: f64 = 0.344;
/// The trackball's radius, in halves of the image's lesser side.
const RADIUS: f64 = 0.9;
/// The nearest points that are drawn, as a share of the distance.
pub(crate) const NEAR: f64 = 0.02;

impl View {
    /// A view of a box from the front, the right and above; z points up.
    #[must_use]
    pub fn around([low, high]: [DVec3; 2]) -> Self {
        let radius = (0.5 * (high - low).length()).max(1e-9);
        let mut view = Self {
            center: 0.5 * (low + high),
            rotation: DQuat::IDENTITY,
            distance: radius / TANGENT * 1.02,
        };
        view.look_from(DVec3::new(0.75, -0.6, 0.42), DVec3::Z);
        view
    }

    /// Turns so that a direction points to the eye and another one up.
    pub fn look_from(&mut self, toward: DVec3, up: DVec3) {
        let back = toward.normalize_or(DVec3::Z);
        let right = up.cross(back);
        let right = right.normalize_or(back.any_orthonormal_vector());
        let axes = DMat3::from_cols(right, back.cross(right), back);
        self.rotation = DQuat::from_mat3(&axes);
    }

    /// The directions to the right, up and towards the eye.
    #[must_use]
    pub fn axes(&self) -> [DVec3; 3] {
        [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| self.rotation * axis)
    }

    /// Computes the rotation of a trackball (after Chen 1988), in coordinates of the mesh. The
    /// pointer's places `from` and `to` are in halves of the image's lesser side from its middle,
    /// y up; outside the ball the image rolls.
    #[must_use]
    pub fn roll(&self, from: [f64; 2], to: [f64; 2]) -> DQuat {
        let [from, to] = [from, to].map(|[x, y]| {
            let p = DVec2::new(x, y) / RADIUS;
            let squared = p.length_squared();
            if squared <= 0.5 {
                p.extend((1.0 - squared).sqrt())
            } else {
                // A hyperbolic sheet goes on from the ball without a kink.
                p.extend(0.5 / squared.sqrt()).normalize()
            }
        });
        self.rotation * DQuat::from_rotation_arc(from, to) * self.rotation.inverse()
    }

    /// Turns the image by the trackball.
    pub fn turn(&mut self, from: [f64; 2], to: [f64; 2]) {
        let rolled = self.roll(from, to);
        self.rotation = (rolled.inverse() * self.rotation).normalize();
    }

    /// Moves the image by pixels, x to the right and y down, in an image of this size.
    pub fn shift(&mut self, [x, y]: [f64; 2], size: [usize; 2]) {
        let [right, up, _] = self.axes();
        let pixel = self.distance / self.focal(size);
        self.center += (up * y - right * x) * pixel;
    }

    /// Takes a point as the centre of rotation, at the distance that it has.
    pub fn center_on(&mut self, point: DVec3) {
        let depth = self.depth(point);
        if depth > 0.0 {
            self.center = point;
            self.distance = depth;
        }
    }

    /// Comes nearer by a factor above 1.
    pub fn zoom(&mut self, factor: f64) {
        if factor.is_finite() && factor > 0.0 {
            self.distance = (self.distance / factor).clamp(1e-6, 1e9);
        }
    }

    /// Pixels of a length at a distance of as much.
    #[must_use]
    pub fn focal(&self, size: [usize; 2]) -> f64 {
        0.5 * size[0].min(size[1]) as f64 / TANGENT
    }

    /// Pixels of a length at a point; 0 behind the eye.
    #[must_use]
    pub fn pixels_at(&self, point: DVec3, size: [usize; 2]) -> f64 {
        let depth = self.depth(point);
        if depth > 0.0 {
            self.focal(size) / depth
        } else {
            0.0
        }
    }

    /// The distance of a point from the eye along the view.
    #[must_use]
    pub fn depth(&self, point: DVec3) -> f64 {
        self.distance - (point - self.center).dot(self.axes()[2])
    }

    /// The pixel of a point; `None` behind the eye.
    #[must_use]
    pub fn project(&self, point: DVec3, size: [usize; 2]) -> Option<[f64; 2]> {
        let [right, up, _] = self.axes();
        let depth = self.depth(point);
        if depth < NEAR * self.distance {
            return None;
        }
        let scale = self.focal(size) / depth;
        let p = point - self.center;
        Some([
            0.5 * size[0] as f64 + p.dot(right) * scale,
            0.5 * size[1] as f64 - p.dot(up) * scale,
        ])
    }

    /// The point at a pixel with this depth.
    #[must_use]
    pub fn point(&self, [x, y]: [f64; 2], depth: f64, size: [usize; 2]) -> DVec3 {
        let [right, up, back] = self.axes();
        let scale = depth / self.focal(size);
        let (x, y) = (x - 0.5 * size[0] as f64, 0.5 * size[1] as f64 - y);
        self.center + (right * x + up * y) * scale + back * (self.distance - depth)
    }

    /// The eye.
    #[must_use]
    pub fn eye(&self) -> DVec3 {
        self.center + self.axes()[2] * self.distance
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_found_again_at_their_pixels() {
        let mut view = View::around([DVec3::new(-1.0, 2.0, 0.0), DVec3::new(3.0, 5.0, 1.0)]);
        view.turn([0.1, 0.2], [-0.5, 0.7]);
        view.shift([12.0, -7.0], [320, 200]);
        view.zoom(1.3);
        let size = [320, 200];
        for p in [DVec3::new(0.3, 3.0, 0.4), DVec3::new(2.0, 4.5, 0.9)] {
            let pixel = view.project(p, size).unwrap();
            assert!(view.point(pixel, view.depth(p), size).distance(p) < 1e-12);
        }
        // A point behind the eye is not projected.
        let behind = view.eye() + (view.eye() - view.center);
        assert_eq!(view.project(behind, size), None);
    }

    #[test]
    fn trackball_takes_the_point_under_the_pointer_along() {
        let mut view = View::around([DVec3::splat(-1.0), DVec3::ONE]);
        let back = view.axes()[2];
        // The point of the ball in front goes to the right and up with the pointer.
        view.turn([0.0, 0.0], [0.3, 0.1]);
        let [right, up, _] = view.axes();
        assert!((back.dot(right) - 0.3 / RADIUS).abs() < 1e-9);
        assert!((back.dot(up) - 0.1 / RADIUS).abs() < 1e-9);
        // There and back is where it was.
        view.turn([0.3, 0.1], [0.0, 0.0]);
        assert!(view.axes()[2].distance(back) < 1e-9);
    }
}
