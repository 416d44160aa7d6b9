//! Function deformed by those that its surface touches.
use crate::Bulge;
use field::local::{Bounds, Halves};
use field::{Ball, Enclosure, Implicit, Jet, Part, Real, Slack, THRESHOLD, Variation};
use glam::DVec3;
use std::sync::Arc;
use wide::f32x8;

/// The function `f + g(maxⱼ fⱼ)` of a body's own function f and those fⱼ of the bodies that it
/// touches, see [`Bulge::jet`] for g. The bulge is that of the largest fⱼ; where two are equally
/// large, there is a crease.
///
/// Its elements are those of f.
#[derive(Clone, Debug)]
pub struct Squashed {
    own: Arc<dyn Implicit>,
    partners: Vec<Partner>,
    /// The greatest height of a bulge.
    height: f64,
    /// Least field of a partner that changes the function.
    start: f64,
}

#[derive(Clone, Debug)]
struct Partner {
    function: Arc<dyn Implicit>,
    bulge: Bulge,
    /// Ball outside which the partner changes nothing.
    reach: Option<Ball>,
}

impl Squashed {
    /// Makes the function of a body from its own and those that it touches, with the bulges that
    /// these raise. The functions given are those without any contact.
    #[must_use]
    pub fn new(own: Arc<dyn Implicit>, partners: Vec<(Arc<dyn Implicit>, Bulge)>) -> Self {
        // Where none is above the least start, all change nothing.
        let starts = partners.iter().map(|(_, bulge)| bulge.start());
        let start = starts.fold(THRESHOLD, f64::min);
        let partners = partners.into_iter().map(|(function, bulge)| Partner {
            reach: function.support_at(start),
            function,
            bulge,
        });
        let partners: Vec<Partner> = partners.collect();
        let heights = partners.iter().map(|partner| partner.bulge.height());
        Self {
            height: heights.fold(0.0, f64::max),
            start,
            own,
            partners,
        }
    }

    /// Computes value and gradient, given those of any function in the same precision.
    fn combine<R: Real>(&self, jet: impl Fn(&dyn Implicit) -> Jet<R>) -> Jet<R> {
        press(jet(&*self.own), self.partners.iter(), jet)
    }

    /// Bounds on the deformation in a ball; `None` if there is none.
    fn deformation(&self, ball: Ball) -> Option<Variation> {
        let near = self.partners.iter().filter(|partner| {
            let is_far = partner.reach.is_some_and(|reach| {
                reach.center.distance(ball.center) > reach.radius + ball.radius
            });
            !is_far && partner.function.most(ball) >= self.start
        });
        let near = near.map(|partner| {
            let bounds = partner.function.variation(None, ball);
            let at_center = partner.function.jet(ball.center);
            (partner, bounds.about(&at_center, ball.radius))
        });
        let near: Vec<(&Partner, Variation)> = near.collect();
        let floor = near.iter().map(|(_, bounds)| bounds.range.value[0]);
        let floor = floor.fold(f64::NEG_INFINITY, f64::max);
        // Those that may be the largest somewhere in the ball.
        let largest = near.iter().filter(|(_, b)| b.range.value[1] >= floor);
        let mut all: Option<Bounds> = None;
        let (mut candidates, mut active) = (0, 0);
        let (mut first, mut same) = (None, true);
        let (mut third, mut rough) = (f64::INFINITY, 0.0);
        for (partner, bounds) in largest {
            let Enclosure { value, slope, .. } = bounds.range;
            let spread = partner.bulge.spread([value[0].max(floor), value[1]]);
            let stepped = bounds.step > 0.0 && spread.slope > 0.0;
            let [slope_bound, jump] = match stepped {
                true => [f64::INFINITY; 2],
                false => [slope, bounds.jump].map(|bound| product(spread.slope, bound)),
            };
            let deformed = Bounds {
                value: spread.value,
                slope: slope_bound,
                curvature: product(spread.curvature, slope * slope)
                    + product(spread.slope, bounds.curvature),
                jump,
                halves: Halves::UNKNOWN,
            };
            // The third derivative of g(f) is g‴f′³ + 3g″f′f″ + g′f‴.
            third = product(spread.third, slope * slope * slope)
                + product(3.0 * spread.curvature, slope * bounds.curvature)
                + product(spread.slope, bounds.third);
            rough = product(spread.slope, bounds.rough);
            same &= *first.get_or_insert(partner.bulge) == partner.bulge;
            candidates += 1;
            active += usize::from(spread.value != [0.0; 2] || spread.slope > 0.0);
            all = Some(all.map_or(deformed, |all| Bounds {
                value: [
                    all.value[0].min(deformed.value[0]),
                    all.value[1].max(deformed.value[1]),
                ],
                slope: all.slope.max(deformed.slope),
                curvature: all.curvature.max(deformed.curvature),
                jump: all.jump.max(deformed.jump),
                halves: Halves::UNKNOWN,
            }));
        }
        let mut all = all?;
        // Where two partners tie the gradient jumps, and the value, too, if their bulges differ.
        let jumps = !same && candidates > 1 && active > 0;
        if jumps {
            all.slope = f64::INFINITY;
        }
        if jumps || active > 1 {
            all.jump = 2.0 * all.slope;
        }
        let all = all.variation();
        // Alone, and where g″ does not jump, a bulge is as smooth as its partner's field.
        Some(if candidates == 1 && third.is_finite() {
            Variation {
                third,
                rough,
                ..all
            }
        } else {
            all
        })
    }
}

/// Computes value and gradient of a function with the bulge of the largest of some partners.
fn press<'a, R: Real>(
    own: Jet<R>,
    mut partners: impl Iterator<Item = &'a Partner>,
    jet: impl Fn(&dyn Implicit) -> Jet<R>,
) -> Jet<R> {
    let deformed = |partner: &Partner| {
        let field = jet(&*partner.function);
        let (value, slope) = partner.bulge.jet(field.value);
        (field.value, value, field.gradient.map(|g| slope * g))
    };
    let Some(first) = partners.next() else {
        return own;
    };
    let mut largest = deformed(first);
    for partner in partners {
        let other = deformed(partner);
        let more = largest.0.lt(other.0);
        largest = (
            R::select(more, other.0, largest.0),
            R::select(more, other.1, largest.1),
            core::array::from_fn(|i| R::select(more, other.2[i], largest.2[i])),
        );
    }
    own.plus(Jet {
        value: largest.1,
        gradient: largest.2,
    })
}

/// Multiplies two bounds; 0 times an infinite one is 0.
pub(crate) fn product(factor: f64, bound: f64) -> f64 {
    if factor == 0.0 { 0.0 } else { factor * bound }
}

impl Implicit for Squashed {
    fn jet(&self, point: DVec3) -> Jet<f64> {
        self.combine(|function| function.jet(point))
    }

    fn jet32(&self, point: [f32; 3]) -> Jet<f32> {
        self.combine(|function| function.jet32(point))
    }

    fn jet8(&self, points: [f32x8; 3]) -> Jet<f32x8> {
        self.combine(|function| function.jet8(points))
    }

    fn enclose(&self, ball: Ball) -> Enclosure {
        let own = self.own.enclose(ball);
        // Where no bulge could lift the function to the threshold, partners are not asked.
        if own.value[1] + self.height < THRESHOLD {
            return Enclosure {
                value: [f64::NEG_INFINITY, own.value[1] + self.height],
                slope: f64::INFINITY,
                curvature: f64::INFINITY,
            };
        }
        match self.deformation(ball) {
            None => own,
            Some(deformation) => own
                .plus(deformation.range)
                .about(&self.jet(ball.center), ball.radius),
        }
    }

    fn narrow(&self, ball: Ball, among: Option<&Part>, slack: Slack) -> Option<Part> {
        // The deformation may be steeper than the field.
        self.own.narrow(ball, among, Slack { far: 0.0, ..slack })
    }

    fn jet_of(&self, part: &Part, point: DVec3) -> Jet<f64> {
        // Outside the reach of all nothing changes, and partners out of reach are not the largest
        // where something does.
        let near = self.partners.iter().filter(|partner| {
            !partner
                .reach
                .is_some_and(|ball| ball.center.distance(point) > ball.radius)
        });
        press(self.own.jet_of(part, point), near, |f| f.jet(point))
    }

    fn variation(&self, part: Option<&Part>, ball: Ball) -> Variation {
        let own = self.own.variation(part, ball);
        if own.range.value[1] + self.height < THRESHOLD {
            // As in `enclose`.
            return Variation::rough(Enclosure {
                value: [f64::NEG_INFINITY, own.range.value[1] + self.height],
                slope: f64::INFINITY,
                curvature: f64::INFINITY,
            });
        }
        match self.deformation(ball) {
            None => own,
            Some(deformation) => own.plus(deformation),
        }
    }

    fn least_width(&self, part: Option<&Part>, ball: Ball, enough: f64) -> Option<f64> {
        let own = self.own.least_width(part, ball, enough)?;
        let near = self.partners.iter().filter(|partner| {
            !partner.reach.is_some_and(|reach| {
                reach.center.distance(ball.center) > reach.radius + ball.radius
            })
        });
        near.into_iter().try_fold(own, |least, partner| {
            let width = partner.function.least_width(None, ball, enough)?;
            Some(least.min(partner.bulge.fineness() * width))
        })
    }

    fn most(&self, ball: Ball) -> f64 {
        self.own.most(ball) + self.height
    }

    fn shares(&self, point: DVec3, out: &mut Vec<(u32, f64)>) {
        self.own.shares(point, out);
    }

    fn support(&self) -> Option<Ball> {
        self.support_at(THRESHOLD)
    }

    fn support_at(&self, level: f64) -> Option<Ball> {
        let below = level - self.height;
        if below <= 0.0 {
            return None;
        }
        self.own.support_at(below)
    }
}
