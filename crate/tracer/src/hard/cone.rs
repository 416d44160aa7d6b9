//! A cone cut off at both ends, with flat lids.
use super::{Clip, Crossing, zeros};
use crate::ray::Ray;
use glam::DVec3;

/// The points whose foot on the axis lies between its ends, no further from it than a radius that
/// varies evenly from one end to the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    base: DVec3,
    apex: DVec3,
    axis: DVec3,
    length: f64,
    base_radius: f64,
    apex_radius: f64,
    /// Change of the radius per unit of length.
    slope: f64,
}

impl Cone {
    /// Prepares the shape; `None` unless the length and one radius are positive, none is negative,
    /// and all numbers are finite.
    #[must_use]
    pub fn new([base, apex]: [DVec3; 2], [base_radius, apex_radius]: [f64; 2]) -> Option<Self> {
        let axis = (apex - base).try_normalize()?;
        let length = base.distance(apex);
        let slope = (apex_radius - base_radius) / length;
        let sound = base.is_finite()
            && apex.is_finite()
            && slope.is_finite()
            && base_radius.min(apex_radius) >= 0.0
            && base_radius.max(apex_radius) > 0.0;
        sound.then_some(Self {
            base,
            apex,
            axis,
            length,
            base_radius,
            apex_radius,
            slope,
        })
    }

    /// Adds all places where the ray's line crosses the surface, in no order.
    pub fn crossings(&self, ray: &Ray, out: &mut Vec<Crossing>) {
        // From the point of the line that is nearest to the middle: from a far eye the differences
        // of squares would lose their digits.
        let middle = 0.5 * (self.base + self.apex);
        let shift = (middle - ray.origin).dot(ray.direction);
        let near = Ray {
            origin: ray.at(shift),
            ..*ray
        };
        let mut clip = Clip::whole_line();
        clip.half_space(&near, self.base, -self.axis);
        clip.half_space(&near, self.apex, self.axis);

        // Squared distance from the axis less squared radius; inside, it is negative.
        let start = near.origin - self.base;
        let (along, rate) = (start.dot(self.axis), near.direction.dot(self.axis));
        let across = start - self.axis * along;
        let drift = near.direction - self.axis * rate;
        let (radius, growth) = (self.base_radius + self.slope * along, self.slope * rate);
        let a = drift.length_squared() - growth * growth;
        let b = across.dot(drift) - radius * growth;
        let c = across.length_squared() - radius * radius;
        let Some([first, second]) = zeros(a, b, c) else {
            // The line is parallel to the axis of a near-cylinder, or passes by.
            if a <= 0.0 && b == 0.0 && c < 0.0 {
                clip.finish_from(shift, out);
            }
            return;
        };
        // The equation holds on the cone and on its mirror image beyond the tip, where the radius
        // would be negative. A steep line is inside of each from one root to infinity.
        let (first, second) = match () {
            () if a >= 0.0 => (first, second),
            () if growth > 0.0 => (second, f64::INFINITY),
            () => (f64::NEG_INFINITY, first),
        };
        let [enter, leave] = [first, second].map(|t| Crossing {
            t,
            normal: self.outward(near.at(t)),
        });
        clip.stretch(enter, leave);
        clip.finish_from(shift, out);
    }

    /// Returns the outward unit normal at a point of the wall.
    fn outward(&self, p: DVec3) -> DVec3 {
        let start = p - self.base;
        let across = start - self.axis * start.dot(self.axis);
        // At the tip there is no way across, and the normal is the axis.
        (across.normalize_or_zero() - self.axis * self.slope).normalize_or(self.axis)
    }

    /// Returns a ball (centre, radius) that holds the shape.
    #[must_use]
    pub fn ball(&self) -> (DVec3, f64) {
        // Through both rims if that is a sensible place, else about the wider lid.
        let (r, s) = (self.base_radius, self.apex_radius);
        let place = 0.5 * (self.length + (s - r) * (s + r) / self.length);
        let place = place.clamp(0.0, self.length);
        let [base, apex] = [(place, r), (self.length - place, s)]
            .map(|(along, radius)| (along * along + radius * radius).sqrt());
        (self.base + self.axis * place, base.max(apex))
    }
}
