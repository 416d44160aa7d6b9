//! Projection of places in the world to points on the screen, and back.

use emath::{Pos2, Rect, Vec2, pos2};
use glam::DVec3;
use scene::{Camera, Projection};

/// A camera's view of the world in a rectangle of the screen.
#[derive(Clone, Copy, Debug)]
pub struct Sight {
    /// The projection.
    pub projection: Projection,
    rect: Rect,
}

impl Sight {
    /// Makes the view of a camera that fills a rectangle.
    #[must_use]
    pub fn new(camera: &Camera, rect: Rect) -> Self {
        // Only the proportions count; thousandths of points are exact enough for them.
        let [width, height] =
            [rect.width(), rect.height()].map(|points| (points.max(1.0) * 1000.0) as u32);
        Self {
            projection: camera.projection(width, height),
            rect,
        }
    }

    /// Returns a place in the camera's axes: to the right, up, and behind the eye.
    fn view(&self, place: DVec3) -> DVec3 {
        self.projection.world_from_view.transpose() * (place - self.projection.eye)
    }

    /// Returns the depth of a place in front of the eye; negative behind it.
    #[must_use]
    pub fn depth(&self, place: DVec3) -> f64 {
        -self.view(place).z
    }

    /// Projects a place to the screen; `None` if it is not in front of the eye, or too far aside.
    #[must_use]
    pub fn screen(&self, place: DVec3) -> Option<Pos2> {
        let view = self.view(place);
        let depth = -view.z;
        if depth.is_nan() || depth <= 1e-9 * view.length() {
            return None;
        }
        let Projection {
            half_width,
            half_height,
            shift,
            ..
        } = self.projection;
        let x = ((view.x / depth - shift[0]) / half_width + 1.0) * 0.5;
        let y = (1.0 - (view.y / depth - shift[1]) / half_height) * 0.5;
        (x.abs() < 1e4 && y.abs() < 1e4).then(|| {
            pos2(
                self.rect.left() + x as f32 * self.rect.width(),
                self.rect.top() + y as f32 * self.rect.height(),
            )
        })
    }

    /// Projects a line between two places, cut off where it passes behind the eye.
    #[must_use]
    pub fn line(&self, from: DVec3, to: DVec3) -> Option<[Pos2; 2]> {
        /// The share of the longer end's depth at which lines are cut off.
        const NEAR: f64 = 1e-3;
        let (a, b) = (self.depth(from), self.depth(to));
        let near = NEAR * a.max(b);
        let (from, to) = match (a > near, b > near) {
            (true, true) => (from, to),
            (true, false) => (from, from.lerp(to, ((a - near) / (a - b)).clamp(0.0, 1.0))),
            (false, true) => (to.lerp(from, ((b - near) / (b - a)).clamp(0.0, 1.0)), to),
            (false, false) => return None,
        };
        Some([self.screen(from)?, self.screen(to)?])
    }

    /// Returns the unit direction in which a point of the screen is seen.
    #[must_use]
    pub fn direction(&self, at: Pos2) -> DVec3 {
        let share = (at - self.rect.min) / self.rect.size().max(Vec2::splat(1e-3));
        self.projection
            .direction(f64::from(share.x), f64::from(share.y))
    }

    /// Returns the length in the world of a point of the screen, at the depth of a place.
    #[must_use]
    pub fn point(&self, place: DVec3) -> f64 {
        let width = f64::from(self.rect.width().max(1.0));
        self.depth(place).max(1e-9) * 2.0 * self.projection.half_width / width
    }

    /// Moves a place by `by` points on the screen, in the plane through it that is parallel to the
    /// screen; with `deep` moving up takes it further away from the eye.
    #[must_use]
    pub fn drag(&self, place: DVec3, by: Vec2, deep: bool) -> DVec3 {
        let axes = self.projection.world_from_view;
        let point = self.point(place);
        let across = axes.x_axis * (f64::from(by.x) * point);
        if deep {
            let ray = place - self.projection.eye;
            // As far as the pointer would have moved it across.
            let further = (-f64::from(by.y) * point / ray.length().max(1e-9)).clamp(-0.5, 0.5);
            place + across + ray * further
        } else {
            place + across - axes.y_axis * (f64::from(by.y) * point)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use emath::vec2;

    fn sight() -> Sight {
        let camera = Camera {
            eye: DVec3::new(1.0, 2.0, 8.0),
            target: DVec3::new(0.0, 1.0, 0.0),
            shift: [0.2, -0.1],
            ..Camera::default()
        };
        Sight::new(
            &camera,
            Rect::from_min_size(pos2(30.0, 40.0), vec2(300.0, 200.0)),
        )
    }

    #[test]
    fn there_and_back() {
        let sight = sight();
        for place in [DVec3::ZERO, DVec3::new(1.0, 2.0, 3.0), DVec3::NEG_ONE] {
            let at = sight.screen(place).expect("in front of the eye");
            let direction = sight.direction(at);
            let to = (place - sight.projection.eye).normalize();
            assert!(direction.distance(to) < 1e-5);
        }
        assert_eq!(sight.screen(DVec3::new(1.0, 2.0, 9.0)), None);
    }

    #[test]
    fn points_follow_the_pointer() {
        let sight = sight();
        let before = sight.screen(DVec3::ONE).expect("visible");
        let by = vec2(12.0, -7.0);
        let after = sight
            .screen(sight.drag(DVec3::ONE, by, false))
            .expect("visible");
        assert!((after - before - by).length() < 1e-2, "{before} {after}");
        let deep = sight.drag(DVec3::ONE, vec2(0.0, -10.0), true);
        assert!(sight.depth(deep) > sight.depth(DVec3::ONE));
        assert!((sight.screen(deep).expect("visible") - before).length() < 1e-2);
    }

    #[test]
    fn lines_end_at_the_eye() {
        let sight = sight();
        let behind = DVec3::new(1.0, 2.0, 20.0);
        assert!(sight.line(DVec3::ZERO, behind).is_some());
        assert!(sight.line(behind, behind + DVec3::X).is_none());
    }
}
