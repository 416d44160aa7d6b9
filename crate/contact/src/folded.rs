//! Local convolution of a skeleton whose folds press each other flat.
use crate::Bulge;
use crate::squashed::product;
use field::local::{Bounds, Halves, Two};
use field::{Ball, Enclosure, Implicit, Jet, Local, Part, Real, THRESHOLD, Variation};
use glam::DVec3;
use wide::f32x8;

/// The function `f₁ + g(f₂)` of the local convolution F of a skeleton at a point and that, F₂, of
/// what is far from there along the skeleton ([`Local::two`]): `f₁ = max(F, ρ(F₂))` and
/// `f₂ = min(F, F₂)`, with g the deformation of [`Bulge::jet`]. ρ(x) is x but for what is far below
/// T, where the bulge begins: 0 up to there, c, x from (c+T)/2 on, and `x·(3t² − 2t³)`,
/// t = 2(x−c)/(T−c), between.
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
        let (ramped, slope) = self.ramp(second.value);
        let ramped = Jet {
            value: ramped,
            gradient: second.gradient.map(|g| slope * g),
        };
        let second = pick(first.value.lt(second.value), first, second);
        let first = pick(first.value.lt(ramped.value), ramped, first);
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

    /// Computes ρ and its slope.
    fn ramp<R: Real>(&self, x: R) -> (R, R) {
        let [zero, one] = [0.0, 1.0].map(R::splat);
        let start = self.bulge.start();
        let rate = 2.0 / (THRESHOLD - start);
        let t = (R::splat(rate) * (x - R::splat(start))).max(zero).min(one);
        let part = t * t * (R::splat(3.0) - t - t);
        let slope = R::splat(6.0 * rate) * t * (one - t);
        (x * part, part + x * slope)
    }

    /// Bounds in a ball, not narrowed by the value at its centre, and both fields there.
    fn bounds(&self, ball: Ball) -> (Bounds, Option<Jet<f64>>) {
        let Two {
            mut first,
            second,
            at_center,
        } = self.local.enclose_two(ball);
        let at_center = at_center.map(|two| self.combine(two));
        let Some(mut second) = second else {
            return (first, at_center);
        };
        let (own, other) = (first, second);
        let mut crease = 0.0;
        if other.value[1] > own.value[0] {
            // Either may be the larger one. Bounds on the derivatives of ρ where it is not x.
            let rate = 2.0 / (THRESHOLD - self.bulge.start());
            let [once, twice] = match self.ramp(other.value[0]).0 == other.value[0] {
                true => [1.0, 0.0],
                false => [1.0 + 1.5 * rate, (3.0 + 6.0 * rate) * rate],
            };
            let ramped = other.value.map(|x| self.ramp(x).0);
            first.value = [0, 1].map(|i| own.value[i].max(ramped[i]));
            second.value = [0, 1].map(|i| own.value[i].min(other.value[i]));
            second.slope = own.slope.max(other.slope);
            second.curvature = own.curvature.max(other.curvature);
            if ramped[1] > own.value[0] {
                first.slope = own.slope.max(once * other.slope);
                let bend = product(twice, other.slope * other.slope);
                first.curvature = own.curvature.max(once * other.curvature + bend);
            }
            crease = first.slope + second.slope;
            first.halves = Halves::UNKNOWN;
        }
        let [low, high] = first.value;
        let spread = self.bulge.spread(second.value);
        // If g lowers f₁, f₂ is above T, and f₁ no less.
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
                false => (1.0 + spread.slope) * crease,
            },
            halves: Halves {
                curvature: first.halves.curvature
                    + product(spread.curvature, second.slope * second.slope),
                ..first.halves
            }
            .plus(spread.slope, &second.halves),
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

    fn variation_with_jet(
        &self,
        _part: Option<&Part>,
        ball: Ball,
    ) -> (Variation, Option<Jet<f64>>) {
        let (bounds, at_center) = self.bounds(ball);
        (bounds.variation_by_halves(ball.radius), at_center)
    }

    fn turn_smoothly(&self, part: Option<&Part>, ball: Ball, step: f64) -> Option<[DVec3; 3]> {
        self.local.turn_smoothly(part, ball, step)
    }

    fn least_width(&self, part: Option<&Part>, ball: Ball, enough: f64) -> Option<f64> {
        Some(self.bulge.fineness() * self.local.least_width(part, ball, enough)?)
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
