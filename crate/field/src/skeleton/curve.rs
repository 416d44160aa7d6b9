//! A cubic Bézier curve.
use super::{Geometry, Map, Skeleton};
use glam::DVec3;

/// Number of lines that draw a curve.
const LINES: usize = 48;
/// Steps of the parameter between which the nearest point of a curve is looked for.
const SAMPLES: i32 = 128;

pub(super) struct Curve {
    pub control: [DVec3; 4],
}

impl Geometry for Curve {
    fn name(&self) -> &'static str {
        "curve"
    }

    fn dimension(&self) -> u8 {
        1
    }

    fn is_numeric(&self) -> bool {
        true
    }

    /// The length of the control polygon.
    fn most_length(&self) -> f64 {
        let sides = self.control.windows(2);
        sides.map(|w| w[0].distance(w[1])).sum()
    }

    fn nearest(&self, point: DVec3) -> DVec3 {
        let c = cubic(self.control);
        nearest_along(|t| c[0] + t * (c[1] + t * (c[2] + t * c[3])), point)
    }

    fn middle(&self) -> DVec3 {
        self.control.iter().sum::<DVec3>() / 4.0
    }

    fn landmarks(&self) -> Vec<(DVec3, &'static str)> {
        self.control.map(|p| (p, "a control point")).into()
    }

    fn fault(&self) -> Option<&'static str> {
        let [a, b, c, d] = self.control;
        (a == b && b == c && c == d).then_some("'s points are all the same")
    }

    fn at(&self, share: f64) -> DVec3 {
        let [a, b, c, d] = self.control;
        let (s, t) = (1.0 - share, share);
        a * (s * s * s) + b * (3.0 * s * s * t) + c * (3.0 * s * t * t) + d * (t * t * t)
    }

    /// The direction of the derivative; where that is 0, from the first point to the last.
    fn tangent(&self, share: f64) -> Option<DVec3> {
        let [a, b, c, d] = self.control;
        let (s, t) = (1.0 - share, share);
        let along = (b - a) * (s * s) + (c - b) * (2.0 * s * t) + (d - c) * (t * t);
        along.try_normalize().or((d - a).try_normalize())
    }

    fn lines(&self, _: f64) -> Vec<Vec<DVec3>> {
        let [a, b, c, d] = self.control;
        let shares = (0..=LINES).map(|i| i as f64 / LINES as f64);
        let line = shares.map(|share| self.at(share)).collect();
        vec![line, vec![a, b], vec![c, d]]
    }

    fn transform(&self, map: &dyn Map) -> Skeleton {
        let control = self.control.map(|p| map.point(p));
        Skeleton::Curve { control }
    }

    fn part(&self, from: f64, to: f64) -> Option<Skeleton> {
        let (_, rest) = halves(self.control, from);
        let (control, _) = halves(rest, (to - from) / (1.0 - from));
        Some(Skeleton::Curve { control })
    }

    fn cubics(&self, _: f64) -> Vec<[DVec3; 4]> {
        vec![self.control]
    }
}

/// Computes a Bézier curve's length.
pub(super) fn length(control: [DVec3; 4]) -> f64 {
    let c = cubic(control);
    let breaks: Vec<f64> = (0..=8).map(|i| f64::from(i) / 8.0).collect();
    crate::integral::integral(
        &mut |t| (c[1] + t * (2.0 * c[2] + 3.0 * t * c[3])).length(),
        &breaks,
        1e-12,
    )
}

/// Finds the point of a line, given by its place at a share of its parameter, that is nearest to a
/// point: the best of samples, improved by bisection of the steps to either side.
pub(super) fn nearest_along(at: impl Fn(f64) -> DVec3, point: DVec3) -> DVec3 {
    let distance = |t: f64| at(t).distance_squared(point);
    let mut best = (0..=SAMPLES)
        .map(|i| f64::from(i) / f64::from(SAMPLES))
        .min_by(|s, t| distance(*s).total_cmp(&distance(*t)))
        .unwrap_or(0.0);
    let mut step = 1.0 / f64::from(SAMPLES);
    while step > 1e-12 {
        step *= 0.5;
        for t in [(best - step).max(0.0), (best + step).min(1.0)] {
            if distance(t) < distance(best) {
                best = t;
            }
        }
    }
    at(best)
}

/// Computes a Bézier curve's coefficients in powers of t.
#[must_use]
pub fn cubic([a, b, c, d]: [DVec3; 4]) -> [DVec3; 4] {
    [
        a,
        (b - a) * 3.0,
        (a - b * 2.0 + c) * 3.0,
        d - a + (b - c) * 3.0,
    ]
}

/// Cuts a Bézier curve at t (de Casteljau).
#[must_use]
pub fn halves([a, b, c, d]: [DVec3; 4], t: f64) -> ([DVec3; 4], [DVec3; 4]) {
    let (ab, bc, cd) = (a.lerp(b, t), b.lerp(c, t), c.lerp(d, t));
    let (abc, bcd) = (ab.lerp(bc, t), bc.lerp(cd, t));
    let m = abc.lerp(bcd, t);
    ([a, ab, abc, m], [m, bcd, cd, d])
}
