//! A skeleton's local convolution whose folds press each other flat.
use crate::Bulge;
use field::local::Two;
use field::{Ball, Enclosure, Implicit, Jet, Local, THRESHOLD};
use glam::DVec3;
use std::sync::Arc;
use wide::f32x8;

/// The function `f₁ + g(f₂)`: f₁ is the largest stretch of a skeleton at a point, f₂ the largest one more than 2D away from it along
/// the skeleton ([`Local::two`]), and g the deformation of [`Bulge::jet`].
///
/// Where both are above T this is `T + f₁ − f₂`, which is T on the sheet f₁ = f₂ between two folds. As that is no surface, but the
/// inside of one body, the value there is `(f₁+T)/2` where that is more.
#[derive(Clone, Debug)]
pub struct Folded {
    local: Arc<Local>,
    bulge: Bulge,
    height: f64,
}

impl Folded {
    /// A skeleton with the bulge beside its folds.
    #[must_use]
    pub fn new(local: Arc<Local>, bulge: Bulge) -> Self {
        Self {
            local,
            height: bulge.height(),
            bulge,
        }
    }
}

impl Implicit for Folded {
    fn jet(&self, point: DVec3) -> Jet<f64> {
        let (first, second) = self.local.two(point);
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
        let Two { first, second } = self.local.enclose_two(ball, true);
        let Some(second) = second else { return first };
        let spread = self.bulge.spread(second.value);
        let bounded = |factor: f64, bound: f64| if factor == 0.0 { 0.0 } else { factor * bound };
        // f₂ ≤ f₁, so that g lowers nothing but what is inside.
        let inside = second.value[1] > THRESHOLD && first.value[1] > THRESHOLD;
        let low = first.value[0];
        let lowest = if inside && low > THRESHOLD {
            0.5 * (low + THRESHOLD)
        } else {
            low
        };
        let all = Enclosure {
            value: [
                (low + spread.value[0]).max(lowest),
                first.value[1] + spread.value[1].max(0.0),
            ],
            slope: first.slope + bounded(spread.slope, second.slope),
            curvature: if inside {
                f64::INFINITY
            } else {
                first.curvature
                    + bounded(spread.curvature, second.slope * second.slope)
                    + bounded(spread.slope, second.curvature)
            },
        };
        all.about(&self.jet(ball.center), ball.radius)
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
