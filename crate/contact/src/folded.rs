//! Local convolution of a skeleton whose folds press each other flat.
use crate::Bulge;
use crate::squashed::product;
use field::local::{Bounds, Two};
use field::{Ball, Enclosure, Implicit, Jet, Local, Part, Real, THRESHOLD, Variation};
use glam::DVec3;
use wide::f32x8;

/// The function `f₁ + g(f₂)`: f₁ is the local convolution of a skeleton at a point, f₂ that of what
/// is far from there along the skeleton ([`Local::two`]) or f₁ if that is less, and g the
/// deformation of [`Bulge::jet`].
///
/// Where both are above T this is `T + f₁ − f₂`, which is T on the sheet f₁ = f₂ between two folds.
/// As that is no surface, but the inside of one body, the value there is `(f₁+T)/2` where that is
/// more.
#[derive(Clone, Debug)]
pub struct Folded {
    local: Local,
    bulge: Bulge,
    height: f64,
}

impl Folded {
    /// Makes the function of a skeleton with a bulge beside its folds.
    #[must_use]
    pub fn new(local: Local, bulge: Bulge) -> Self {
        Self {
            // Below its start the bulge is 0.
            local: local.with_folds(bulge.start()),
            height: bulge.height(),
            bulge,
        }
    }

    /// Computes value and gradient from those of both fields.
    fn combine<R: Real>(&self, (first, second): (Jet<R>, Option<Jet<R>>)) -> Jet<R> {
        let Some(second) = second else { return first };
        let second = pick(first.value.lt(second.value), first, second);
        let (deformed, slope) = self.bulge.jet(second.value);
        let pressed = first.plus(Jet {
            value: deformed,
            gradient: second.gradient.map(|g| slope * g),
        });
        let [half, threshold] = [0.5, THRESHOLD].map(R::splat);
        let least = Jet {
            value: half * (first.value + threshold),
            gradient: first.gradient.map(|g| half * g),
        };
        let inside = R::both(threshold.lt(second.value), pressed.value.lt(least.value));
        pick(inside, least, pressed)
    }

    /// Bounds in a ball, not narrowed by the value at its centre, and both fields there.
    fn bounds(&self, ball: Ball) -> (Bounds, Option<Jet<f64>>) {
        let Two {
            first,
            second,
            at_center,
        } = self.local.enclose_two(ball);
        let at_center = at_center.map(|two| self.combine(two));
        let Some(mut second) = second else {
            return (first, at_center);
        };
        let [low, high] = first.value;
        let crossing = second.value[1] > low;
        second.value = [second.value[0].min(low), second.value[1].min(high)];
        if crossing {
            // The gradient of the lesser one is either's.
            second.jump = second.jump.max(first.slope + second.slope);
            second.slope = second.slope.max(first.slope);
            second.curvature = second.curvature.max(first.curvature);
        }
        let spread = self.bulge.spread(second.value);
        // f₂ ≤ f₁, so that g lowers nothing but what is inside.
        let inside = second.value[1] > THRESHOLD;
        let lowest = if inside && low > THRESHOLD {
            0.5 * (low + THRESHOLD)
        } else {
            low
        };
        let slope = first.slope + product(spread.slope, second.slope);
        let bounds = Bounds {
            value: [
                (low + spread.value[0]).max(lowest),
                high + spread.value[1].max(0.0),
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
        };
        (bounds, at_center)
    }
}

/// Returns one of two values and gradients.
fn pick<R: Real>(mask: R::Mask, yes: Jet<R>, no: Jet<R>) -> Jet<R> {
    Jet {
        value: R::select(mask, yes.value, no.value),
        gradient: core::array::from_fn(|i| R::select(mask, yes.gradient[i], no.gradient[i])),
    }
}

impl Implicit for Folded {
    fn jet(&self, point: DVec3) -> Jet<f64> {
        self.combine(self.local.two(point.to_array()))
    }

    fn jet32(&self, point: [f32; 3]) -> Jet<f32> {
        self.combine(self.local.two(point))
    }

    fn jet8(&self, points: [f32x8; 3]) -> Jet<f32x8> {
        self.combine(self.local.two(points))
    }

    fn enclose(&self, ball: Ball) -> Enclosure {
        let (bounds, at_center) = self.bounds(ball);
        match at_center {
            Some(jet) => bounds.enclosure().about(&jet, ball.radius),
            None => bounds.enclosure(),
        }
    }

    fn variation(&self, _part: Option<&Part>, ball: Ball) -> Variation {
        self.bounds(ball).0.variation()
    }

    fn variation_with_jet(&self, ball: Ball) -> (Variation, Option<Jet<f64>>) {
        let (bounds, at_center) = self.bounds(ball);
        (bounds.variation(), at_center)
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
