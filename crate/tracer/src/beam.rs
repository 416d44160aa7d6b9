//! Beams: cones that bound a bundle of rays, so that a proof for the beam holds for each of its
//! rays.
use crate::ray::Ray;
use field::Cut;
use glam::DVec3;

/// A cone with a blunt tip that holds a bundle of rays: at parameter t every ray of the bundle is
/// within `radius + spread·t` of the axis' point at the same t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beam {
    /// The middle ray.
    pub axis: Ray,
    /// Largest distance of a ray's origin from the axis' origin.
    pub radius: f64,
    /// Largest length of the difference between a ray's direction and the axis'.
    pub spread: f64,
    /// Largest distance of a ray's origin from the axis' origin, measured along the axis.
    pub ahead: f64,
}

/// Relative slack added to bounds for their own rounding.
const BOUND_SLACK: f64 = 1e-9;
/// Largest rounding error of the difference of two equal squares, relative to them.
const SQUARES: f64 = 2e-15;

impl Beam {
    /// Returns the beam around a single ray.
    #[must_use]
    pub fn of_ray(axis: Ray) -> Self {
        Self {
            axis,
            radius: 0.0,
            spread: 0.0,
            ahead: 0.0,
        }
    }

    /// Returns the beam around some rays; `None` if there are none.
    #[must_use]
    pub fn around(rays: &[Ray]) -> Option<Self> {
        let n = rays.len() as f64;
        let origin = rays.iter().map(|r| r.origin).sum::<DVec3>() / n;
        let direction = rays
            .iter()
            .map(|r| r.direction)
            .sum::<DVec3>()
            .try_normalize()
            .or(rays.first().map(|r| r.direction))?;
        let [radius, spread, ahead] = rays.iter().fold([0.0; 3], |most: [f64; 3], ray| {
            [
                most[0].max(ray.origin.distance(origin)),
                most[1].max(ray.direction.distance(direction)),
                most[2].max((ray.origin - origin).dot(direction).abs()),
            ]
        });
        Some(Self {
            axis: Ray { origin, direction },
            radius: radius * (1.0 + BOUND_SLACK),
            spread: spread * (1.0 + BOUND_SLACK),
            ahead: ahead * (1.0 + BOUND_SLACK),
        })
    }

    /// Returns the largest distance of rays from the axis' point at a parameter.
    #[must_use]
    pub fn width(&self, t: f64) -> f64 {
        self.radius + self.spread * t
    }

    /// Bounds the distance, along the axis, of rays from the axis' point at a parameter: the
    /// projection of a unit vector on another is shorter than 1 by half the square of their
    /// difference.
    #[must_use]
    pub fn lag(&self, t: f64) -> f64 {
        self.ahead + 0.5 * self.spread * self.spread * t
    }

    /// Returns the largest distance of rays at a parameter from the axis' point there: a bound on
    /// both together.
    #[must_use]
    pub fn extent(&self, t: f64) -> f64 {
        self.width(t) + self.lag(t)
    }

    /// Returns the beam with parameters counted from `base` on.
    #[must_use]
    pub fn from(&self, base: f64) -> Self {
        Self {
            axis: Ray {
                origin: self.axis.at(base),
                direction: self.axis.direction,
            },
            radius: self.width(base),
            spread: self.spread,
            ahead: self.lag(base),
        }
    }

    /// Returns a ball (centre, radius) that holds the piece of every ray between two parameters.
    #[must_use]
    pub fn ball(&self, from: f64, to: f64) -> (DVec3, f64) {
        let middle = 0.5 * (from + to);
        let half = 0.5 * (to - from);
        (
            self.axis.at(middle),
            (half + self.width(to)) * (1.0 + BOUND_SLACK),
        )
    }

    /// Whether a ray of the beam may meet a ball.
    #[must_use]
    pub fn meets(&self, center: DVec3, radius: f64) -> bool {
        // A beam that widens as fast as it advances reaches every point.
        if self.spread >= 1.0 {
            return true;
        }
        let d = center - self.axis.origin;
        let square = d.length_squared();
        let along = d.dot(self.axis.direction);
        // A difference of large numbers, less its rounding.
        let across = (square - along * along - SQUARES * square).at_least(0.0);
        let d = d.abs();
        let reach = (radius + self.radius) * (1.0 + BOUND_SLACK) + BOUND_SLACK * (d.x + d.y + d.z);
        // The distance from the axis' point at t less the beam's growth,
        // sqrt(across² + (along−t)²) − spread·t, is least where its derivative vanishes, at
        // t = along + across·spread/slope, if that is ≥ 0. Squares avoid roots: trees call this
        // often.
        let spread = self.spread * self.spread;
        let slope = 1.0 - spread;
        let (apart, reach) = if along > 0.0 || across * spread > along * along * slope {
            (across * slope, reach + self.spread * along)
        } else {
            (square, reach)
        };
        reach >= 0.0 && apart <= reach * reach
    }

    /// Returns the parameters between which a ray of the beam may be inside a ball: t ≥ 0 is
    /// distance from the ray's origin, so it differs from the ball's distance by no more than the
    /// radii.
    #[must_use]
    pub fn reach(&self, center: DVec3, radius: f64) -> [f64; 2] {
        let distance = self.axis.origin.distance(center);
        let slack = radius + self.radius + BOUND_SLACK * distance;
        [(distance - slack).at_least(0.0), distance + slack]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trials::{Random, count};

    #[test]
    fn a_beam_meets_the_balls_that_come_near_its_axis() {
        const STEP: f64 = 2e-3;
        let mut numbers = Random::new(12);
        let (mut met, mut missed, mut behind) = (0, 0, 0);
        for case in 0..count(1000) {
            let [origin, direction, center] = core::array::from_fn(|_| numbers.vector(1.0));
            let (direction, center) = (direction.normalize(), 0.7 * center);
            let beam = Beam {
                axis: Ray { origin, direction },
                radius: if case % 3 == 0 {
                    0.0
                } else {
                    0.1 * numbers.unit()
                },
                spread: [0.0, 0.05 * numbers.unit(), 0.95 * numbers.unit()][case % 3],
                ahead: 0.0,
            };
            let radius = 0.3 * numbers.unit();
            // The least distance less the beam's growth.
            let mut least = f64::INFINITY;
            for i in 0..6000 {
                let t = f64::from(i) * STEP;
                least = least.min(beam.axis.at(t).distance(center) - beam.spread * t);
            }
            let reach = radius + beam.radius;
            let meets = beam.meets(center, radius);
            // Widest beams are nearest further away than this.
            let seen = beam.spread < 0.8;
            assert!(meets || least > reach, "{beam:?} {center} {radius}");
            assert!(
                !(meets && seen) || least <= reach + STEP,
                "{beam:?} {center} {radius}"
            );
            met += usize::from(meets);
            missed += usize::from(!meets);
            behind += usize::from(!meets && (center - origin).dot(direction) < 0.0);
            assert!(!meets || beam.meets(center, radius * 1.5));
        }
        assert!(
            met >= count(20) && missed > count(100) && behind > count(100),
            "{met} {missed} {behind}"
        );
        let nowhere = Beam::of_ray(Ray {
            origin: DVec3::ZERO,
            direction: DVec3::X,
        });
        assert!(nowhere.meets(DVec3::X * 3.0, 0.0) && !nowhere.meets(DVec3::X * -3.0, 1.0));
        // Also tiny balls, and balls on the axis itself.
        for _ in 0..count(1000) {
            let direction = numbers.direction();
            let origin = numbers.vector(1.0);
            let ray = Ray { origin, direction };
            assert!(Beam::of_ray(ray).meets(ray.at(5.0), 0.0));
        }
    }
}
