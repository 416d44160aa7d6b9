//! Places of a segment whose planes pass through a point, or through a ball.
use crate::Ball;
use glam::DVec3;

/// A segment with the planes that sweep along it: at its part u the plane through
/// `r(u) = base + u·along` with the normal
/// `d(u) = normal + u·turn`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Swept {
    /// Start.
    pub base: DVec3,
    /// Vector from start to end.
    pub along: DVec3,
    /// Unit normal at the start.
    normal: DVec3,
    /// Difference of the normal at the end from that at the start.
    turn: DVec3,
}

/// Places on a segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Places {
    /// Parts of the segment from which and to which they reach.
    pub parts: [f64; 2],
    /// The least |∂(d·(p−r))/∂u| at any of them and any point of the ball, with its sign; 0 if it
    /// may vanish.
    pub rate: f64,
}

/// Part of a segment by which a root may miss an end and still be one.
const ROUNDING: f64 = 1e-9;

impl Swept {
    /// The planes of a segment with unit normals at its ends.
    #[must_use]
    pub fn new([base, end]: [DVec3; 2], [first, last]: [DVec3; 2]) -> Self {
        Self {
            base,
            along: end - base,
            normal: first,
            turn: last - first,
        }
    }

    /// The point at a part of it.
    #[must_use]
    pub fn at(&self, part: f64) -> DVec3 {
        self.base + self.along * part
    }

    /// The normal at a part of it, not of unit length.
    #[must_use]
    pub fn normal(&self, part: f64) -> DVec3 {
        self.normal + self.turn * part
    }

    /// Returns how much the normal changes over the segment, and the second derivative of `d·(p−r)`
    /// by u.
    #[must_use]
    pub fn bends(&self) -> [f64; 2] {
        [self.turn.length(), -2.0 * self.turn.dot(self.along)]
    }

    /// `d·(p−r)` as a polynomial of u.
    fn polynomial(&self, point: DVec3) -> [f64; 3] {
        let away = point - self.base;
        [
            self.normal.dot(away),
            self.turn.dot(away) - self.normal.dot(self.along),
            -self.turn.dot(self.along),
        ]
    }

    /// `∂(d·(p−r))/∂u`.
    #[must_use]
    pub fn rate(&self, point: DVec3, part: f64) -> f64 {
        let [_, b, a] = self.polynomial(point);
        b + 2.0 * a * part
    }

    /// Calls `f` with each part u of the segment whose plane passes through a point.
    pub fn each(&self, point: DVec3, mut f: impl FnMut(f64)) {
        let polynomial = self.polynomial(point);
        for root in roots(polynomial).into_iter().flatten() {
            if (-ROUNDING..=1.0 + ROUNDING).contains(&root) {
                f(root.clamp(0.0, 1.0));
            }
        }
    }

    /// Calls `f` with the intervals of parts whose planes may pass through a ball, at most three.
    pub fn each_in(&self, ball: Ball, mut f: impl FnMut(Places)) {
        let [c, b, a] = self.polynomial(ball.center);
        // No normal is longer than 1.
        let reach = ball.radius * (1.0 + ROUNDING) + ROUNDING * self.along.length();
        // Most segments are nowhere near: a quadratic is within |a|/4 of its chord.
        let slack = reach + 0.25 * a.abs();
        let ends = [c, c + b + a];
        if ends[0].min(ends[1]) > slack || ends[0].max(ends[1]) < -slack {
            return;
        }
        let mut breaks = [0.0, 1.0, 2.0, 2.0, 2.0, 2.0];
        let mut count = 2;
        for level in [-reach, reach] {
            for root in roots([c - level, b, a]).into_iter().flatten() {
                if root > 0.0 && root < 1.0 {
                    breaks[count] = root;
                    count += 1;
                }
            }
        }
        let breaks = &mut breaks[..count];
        breaks.sort_unstable_by(f64::total_cmp);
        let mut open: Option<f64> = None;
        let mut report = |from: f64, to: f64| {
            let parts = [(from - ROUNDING).max(0.0), (to + ROUNDING).min(1.0)];
            let rates = parts.map(|u| b + 2.0 * a * u);
            let slowest = rates[0].abs().min(rates[1].abs()) - self.turn.length() * ball.radius;
            let steady = rates[0] * rates[1] > 0.0 && slowest > 0.0;
            let rate = if steady {
                rates[0].signum() * slowest
            } else {
                0.0
            };
            f(Places { parts, rate });
        };
        for pair in breaks.windows(2) {
            let u = 0.5 * (pair[0] + pair[1]);
            let inside = (c + u * (b + u * a)).abs() <= reach;
            match (inside, open) {
                (true, None) => open = Some(pair[0]),
                (false, Some(from)) => {
                    report(from, pair[0]);
                    open = None;
                }
                _ => {}
            }
        }
        if let Some(from) = open {
            report(from, 1.0);
        }
    }
}

/// The real roots of `c + bu + au²`.
fn roots([c, b, a]: [f64; 3]) -> [Option<f64>; 2] {
    let discriminant = b * b - 4.0 * a * c;
    if discriminant.is_nan() || discriminant < 0.0 {
        return [None; 2];
    }
    // The stable one of the two forms of each.
    let q = -0.5 * (b + discriminant.sqrt().copysign(b));
    [c / q, q / a].map(|root| root.is_finite().then_some(root))
}
