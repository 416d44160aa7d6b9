//! Local convolution of a skeleton whose folds press each other flat.
use crate::Bulge;
use crate::squashed::product;
use field::local::{Bounds, Two};
use field::{Ball, Enclosure, Implicit, Jet, Local, Part, THRESHOLD, Variation};
use glam::DVec3;
use std::sync::Arc;
use wide::f32x8;

/// The function `f₁ + g(f₂)`: f₁ is the largest stretch of a skeleton at a point, f₂ the largest
/// one more than 2D away from it along the skeleton ([`Local::two`]), and g the deformation of
/// [`Bulge::jet`].
///
/// Where both are above T this is `T + f₁ − f₂`, which is T on the sheet f₁ = f₂ between two folds.
/// As that is no surface, but the inside of one body, the value there is `(f₁+T)/2` where that is
/// more.
#[derive(Clone, Debug)]
pub struct Folded {
    local: Arc<Local>,
    bulge: Bulge,
    height: f64,
}

impl Folded {
    /// Makes the function of a skeleton with a bulge beside its folds.
    #[must_use]
    pub fn new(local: Arc<Local>, bulge: Bulge) -> Self {
        Self {
            local,
            height: bulge.height(),
            bulge,
        }
    }

    /// Bounds in a ball, not narrowed by the value at its centre.
    fn bounds(&self, ball: Ball) -> Bounds {
        let Two { first, second } = self.local.enclose_two(ball, Some(self.bulge.start()));
        let Some(second) = second else { return first };
        let spread = self.bulge.spread(second.value);
        // f₂ ≤ f₁, so that g lowers nothing but what is inside.
        let inside = second.value[1] > THRESHOLD && first.value[1] > THRESHOLD;
        let low = first.value[0];
        let lowest = if inside && low > THRESHOLD {
            0.5 * (low + THRESHOLD)
        } else {
            low
        };
        let slope = first.slope + product(spread.slope, second.slope);
        Bounds {
            value: [
                (low + spread.value[0]).max(lowest),
                first.value[1] + spread.value[1].max(0.0),
            ],
            slope,
            curvature: first.curvature
                + product(spread.curvature, second.slope * second.slope)
                + product(spread.slope, second.curvature),
            // Inside there is a crease beside the sheet.
            jump: match inside {
                true => 2.0 * slope,
                false => first.jump + product(spread.slope, second.jump),
            },
        }
    }
}

impl Implicit for Folded {
    fn jet(&self, point: DVec3) -> Jet<f64> {
        // Below its start the bulge is 0.
        let (first, second) = self.local.two_above(point, self.bulge.start());
        let Some(second) = second else { return first };
        let (deformed, slope) = self.bulge.jet(second.value);
        if first.value > THRESHOLD && second.value > THRESHOLD {
            let half = 0.5 * (first.value - THRESHOLD);
            let apart = first.value - second.value;
            if apart < half {
                return Jet {
                    value: THRESHOLD + half,
                    gradient: first.gradient.map(|g| 0.5 * g),
                };
            }
        }
        first.plus(Jet {
            value: deformed,
            gradient: second.gradient.map(|g| slope * g),
        })
    }

    fn jet32(&self, point: [f32; 3]) -> Jet<f32> {
        field::local::narrow(self.jet(DVec3::from_array(point.map(f64::from))))
    }

    fn jet8(&self, points: [f32x8; 3]) -> Jet<f32x8> {
        field::local::lanes(points, |point| self.jet32(point))
    }

    fn enclose(&self, ball: Ball) -> Enclosure {
        let bounds = self.bounds(ball).enclosure();
        bounds.about(&self.jet(ball.center), ball.radius)
    }

    fn variation(&self, _part: Option<&Part>, ball: Ball) -> Variation {
        self.bounds(ball).variation()
    }

    fn most(&self, ball: Ball) -> f64 {
        self.local.most(ball) + self.height
    }

    fn shares(&self, point: DVec3, out: &mut Vec<(u32, f64)>) {
        self.local.shares(point, out);
    }

    fn support(&self) -> Option<Ball> {
        self.support_at(THRESHOLD)
    }

    fn support_at(&self, level: f64) -> Option<Ball> {
        let below = level - self.height;
        if below <= 0.0 {
            return None;
        }
        self.local.support_at(below)
    }
}
