//! A ball that is wholly inside a body, to leave out the start of rays that begin there.
//!
//! Many elements whose kernel has a pole have a surface far from all of them. Between them the
//! field is thousands of times T, and so is the error of its interpolants, so that it takes long to
//! prove that it does not cross T. But these kernels are bounded from below by their distance,
//! which proves it for a whole ball at once.
use crate::beam::Beam;
use field::{Bound, Cut, THRESHOLD};
use glam::DVec3;

/// A ball in which a body's field is above T.
#[derive(Clone, Copy, Debug)]
pub struct InnerBall {
    center: DVec3,
    radius: f64,
}

/// Least excess of the field over T in the ball, relative to T, for rounding.
const MARGIN: f64 = 1e-6;
/// Halvings of the step that finds the radius.
const STEPS: u32 = 24;
/// Radius from which the search doubles it no more.
const LARGEST: f64 = 1e12;

impl InnerBall {
    /// Finds the largest ball around the middle of a ball that holds a body's skeletons, given the
    /// bounds of its terms. `None` if the field is not known to be above T even in the given ball,
    /// or if some term carves: near its pole nothing is inside.
    #[must_use]
    pub fn new(bounds: &[Bound], (center, skeletons): (DVec3, f64)) -> Option<Self> {
        let carves = bounds.iter().any(Bound::carves);
        if carves || !(skeletons > 0.0 && is_inside(bounds, center, skeletons)) {
            return None;
        }
        let mut radius = skeletons;
        while radius < LARGEST && is_inside(bounds, center, 2.0 * radius) {
            radius *= 2.0;
        }
        let mut step = 0.5 * radius;
        for _ in 0..STEPS {
            if is_inside(bounds, center, radius + step) {
                radius += step;
            }
            step *= 0.5;
        }
        Some(Self { center, radius })
    }

    /// Returns a parameter up to which all rays of a beam are in the ball; 0 if not all start
    /// there.
    #[must_use]
    pub fn exit(&self, beam: &Beam) -> f64 {
        let away = beam.axis.origin - self.center;
        let along = away.dot(beam.axis.direction);
        let end = |radius: f64| {
            let square = radius * radius - (away.length_squared() - along * along);
            square.at_least(0.0).sqrt() - along
        };
        // A beam never narrows, and a ball is convex.
        let t = end(self.radius - beam.extent(end(self.radius))) * (1.0 - 1e-9);
        if self.holds(beam, 0.0) && self.holds(beam, t) {
            t.at_least(0.0)
        } else {
            0.0
        }
    }

    /// Whether the rays of a beam are in the ball at a parameter.
    fn holds(&self, beam: &Beam, t: f64) -> bool {
        beam.axis.at(t).distance(self.center) + beam.extent(t) <= self.radius
    }
}

/// Whether the field is known to be above T in a ball.
fn is_inside(bounds: &[Bound], center: DVec3, radius: f64) -> bool {
    let least = bounds.iter().map(|bound| bound.least(center, radius));
    least.sum::<f64>() > THRESHOLD * (1.0 + MARGIN)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ray::Ray;
    use field::{BlobScale, Kernel, Primitive, Shaping, Skeleton};
    use trials::{Random, count};

    /// Returns points and segments in a cube, of which some carve if `carving` is negative.
    fn body(kernel: Kernel, carving: f64, numbers: &mut Random) -> Vec<Primitive> {
        let mut primitives = Vec::new();
        for i in 0..300_u32 {
            let base = numbers.vector(1.0);
            let skeleton = if i.is_multiple_of(3) {
                let apex = base + numbers.vector(0.2);
                Skeleton::Segment { base, apex }
            } else {
                Skeleton::Point { center: base }
            };
            let shaping = Shaping {
                kernel,
                radius: 0.05,
                blobbiness: 2.0,
                blob_scale: BlobScale::Relative,
                strength: if i % 7 == 1 { carving } else { 1.0 },
                influence: 1e-3,
                taper: None,
            };
            primitives.push(Primitive::new(skeleton, &shaping, None).expect("flesh"));
        }
        primitives
    }

    /// The field is above T everywhere in the ball, whose radius is near that of the surface.
    #[test]
    fn the_field_is_above_the_threshold_in_the_ball() {
        let mut numbers = Random::new(7);
        let primitives = body(Kernel::Inverse, 1.0, &mut numbers);
        let bounds: Vec<Bound> = primitives.iter().map(Bound::new).collect();
        let ball = InnerBall::new(&bounds, (DVec3::ZERO, 2.0)).expect("a ball");
        let value = |place: DVec3| field::sum(&primitives, place.to_array()).value;
        for i in 0..300 {
            let radius = ball.radius * f64::from(i + 1) / 300.0;
            let place = numbers.direction() * radius;
            assert!(value(place) > THRESHOLD, "{place}");
        }
        let outside = DVec3::X * (ball.radius + 4.0);
        assert!(value(outside) < THRESHOLD, "{outside}");
        // Other kernels have no bound from below, and what carves is stronger than all near its
        // pole.
        for (kernel, carving) in [(Kernel::Cauchy, 1.0), (Kernel::Inverse, -0.1)] {
            let primitives = body(kernel, carving, &mut numbers);
            let bounds: Vec<Bound> = primitives.iter().map(Bound::new).collect();
            assert!(InnerBall::new(&bounds, (DVec3::ZERO, 2.0)).is_none());
        }
    }

    /// A beam's rays are all in the ball until the beam leaves it, which is not much later.
    #[test]
    fn a_beam_is_in_the_ball_until_it_leaves_it() {
        let mut numbers = Random::new(8);
        let (mut within, mut outside) = (0, 0);
        for _ in 0..count(400) {
            let ball = InnerBall {
                center: numbers.vector(1.0),
                radius: numbers.range(1.0, 3.0),
            };
            let origin = numbers.vector(3.0);
            let (direction, narrow) = (numbers.direction(), numbers.range(0.0, 0.1));
            let rays: Vec<Ray> = (0..8)
                .map(|_| Ray {
                    origin: origin + numbers.vector(1.0) * narrow,
                    direction: (direction + numbers.vector(1.0) * narrow).normalize(),
                })
                .collect();
            let beam = Beam::around(&rays).expect("a beam");
            let t = ball.exit(&beam);
            if t == 0.0 {
                outside += 1;
                continue;
            }
            within += 1;
            for ray in &rays {
                for part in [0.0, 0.3, 0.7, 1.0] {
                    assert!(ray.at(part * t).distance(ball.center) <= ball.radius);
                }
            }
            let after = beam.axis.at(t + 1e-6).distance(ball.center);
            let wide = beam.extent(2.0 * ball.radius);
            assert!(
                after + wide + 1e-3 > ball.radius || wide > 0.4,
                "{after} {wide}"
            );
        }
        assert!(
            within > count(20) && outside > count(60),
            "{within} {outside}"
        );
    }
}
