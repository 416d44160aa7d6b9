//! A piece of a surface of the second degree, cut off by a box.
use super::cuboid::reach;
use super::{Crossing, zeros};
use crate::ray::Ray;
use glam::{DMat3, DVec3};

/// A quadric made ready: see [`scene::Quadric`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quadric {
    surface: scene::Quadric,
    local_from_world: DMat3,
}

impl Quadric {
    /// Prepares the shape; `None` unless it is a surface in a box with a volume, and all numbers
    /// are finite.
    #[must_use]
    pub fn new(surface: &scene::Quadric) -> Option<Self> {
        let local_from_world = surface.local_from_world()?;
        surface.is_surface().then_some(Self {
            surface: *surface,
            local_from_world,
        })
    }

    /// Adds all places where the ray's line crosses the surface, in no order.
    pub fn crossings(&self, ray: &Ray, out: &mut Vec<Crossing>) {
        let start = self.local_from_world * (ray.origin - self.surface.center);
        let rate = self.local_from_world * ray.direction;
        // The part of the line in the box.
        let (mut from, mut to) = (f64::NEG_INFINITY, f64::INFINITY);
        for (start, rate) in start.to_array().into_iter().zip(rate.to_array()) {
            if rate != 0.0 {
                let [a, b] = [(-1.0 - start) / rate, (1.0 - start) / rate];
                from = from.max(a.min(b));
                to = to.min(a.max(b));
            } else if start.abs() > 1.0 {
                return;
            }
        }
        if from > to || !from.is_finite() || !to.is_finite() {
            return;
        }
        // From its middle, so that a far eye costs no digits.
        let middle = 0.5 * (from + to);
        let half = 0.5 * (to - from);
        let q = self.local_from_world * (ray.at(middle) - self.surface.center);
        let a = rate.dot(self.surface.square * rate);
        let (c, gradient) = self.surface.value(q);
        let Some(roots) = zeros(a, 0.5 * gradient.dot(rate), c) else {
            return;
        };
        for s in roots {
            if s.abs() <= half {
                let (_, gradient) = self.surface.value(q + rate * s);
                let normal = self.local_from_world.transpose() * gradient;
                out.push(Crossing {
                    t: middle + s,
                    // At the tip of a cone there is none.
                    normal: normal.normalize_or(-ray.direction),
                });
            }
        }
    }

    /// Returns a ball (centre, radius) that holds the shape.
    #[must_use]
    pub fn ball(&self) -> (DVec3, f64) {
        (self.surface.center, reach(self.surface.axes))
    }
}
