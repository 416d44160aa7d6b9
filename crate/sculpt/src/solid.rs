//! Solids that drive vertices out: superquadrics, and bodies of a model.

use field::{Implicit, THRESHOLD};
use glam::DVec3;
use mesh::Aabb;

/// Steps along the gradient at most.
const MAX_STEPS: u32 = 40;

/// Solid about the origin.
pub trait Solid {
    /// Returns a box that contains it.
    fn bounds(&self) -> Aabb;

    /// The length of a step along a path that leaves out nothing.
    fn step(&self) -> f64;

    /// `true` if a point is inside.
    fn contains(&self, point: DVec3) -> bool;

    /// Returns the place to which a point inside is driven; `None` for a point outside, and if
    /// there is no way out.
    fn drive_out(&self, point: DVec3) -> Option<DVec3>;
}

/// Body of a model as a tool, a hand that works the clay: what is inside its surface is driven out
/// along its gradient.
#[derive(Clone, Copy, Debug)]
pub struct Body<'a> {
    /// Function of the body, which is inside where this is larger than the threshold.
    pub function: &'a dyn Implicit,
    /// Box that contains its surface.
    pub bounds: Aabb,
}

impl Solid for Body<'_> {
    fn bounds(&self) -> Aabb {
        self.bounds
    }

    fn step(&self) -> f64 {
        let size = self.bounds.max - self.bounds.min;
        0.25 * size.min_element().max(1e-6)
    }

    fn contains(&self, point: DVec3) -> bool {
        self.function.jet(point).value > THRESHOLD
    }

    /// Newton's method along the gradient; a step is never longer than an eighth of the box, so
    /// that it does not leave the part of the body that the point is in.
    fn drive_out(&self, point: DVec3) -> Option<DVec3> {
        let longest = 0.125 * (self.bounds.max - self.bounds.min).length();
        let mut p = point;
        for i in 0..MAX_STEPS {
            let jet = self.function.jet(p);
            let gradient = DVec3::from_array(jet.gradient);
            let excess = jet.value - THRESHOLD;
            let steep = gradient.length();
            if i == 0 && (excess <= 0.0 || excess.is_nan()) {
                return None;
            }
            if excess.abs() < 1e-9 {
                return Some(p);
            }
            let way = excess / steep;
            if !way.is_finite() {
                return None;
            }
            p -= gradient / steep * way.clamp(-longest, longest);
        }
        p.is_finite().then_some(p)
    }
}
