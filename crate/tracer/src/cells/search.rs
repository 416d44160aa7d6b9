//! Certified search for the crossings of one ray with the surface of a function.
//!
//! On a piece of a ray with the middle m and the half-length h Taylor's theorem says
//! `|f(m+x) − f(m) − f′(m)·x| ≤ C·x²/2 + J·|x|`, where C bounds the curvature in a ball around the
//! piece, and J the jumps of the gradient. So a piece has no crossing if the function's range in
//! that ball leaves the threshold out, or if `|f(m) − T| > (|f′(m)| + J)·h + C·h²/2`; and at most
//! one if `|f′(m)| > C·h + J`, which the sides at its ends then tell. Any other piece is halved,
//! down to a resolution. Its halves have the same C and J, until they are so short that bounds of
//! their own pay.
use super::flat::{Bend, Flat};
use crate::ray::Ray;
use field::{Ball, Implicit, Jet, Part, THRESHOLD};
use glam::DVec3;

/// Most halvings of pieces of one ray; on the rest the sides at the ends decide.
const MOST_HALVED: u32 = 1 << 16;
/// Radius of a ball without crossings, in the function's scale, below which the surface is looked
/// for.
const NEAR: f64 = 0.25;
/// Rounding of a function's value in double precision, in T.
const VALUE_ERROR: f64 = 1e-12;
/// Radius of the ball around a piece, over that of the ball for which its bounds were found, below
/// which bounds of its own pay.
const SHORT: f64 = 0.15;
/// Error of hits over 1 + t.
const HIT_ERROR: f64 = 1e-14;

/// Value and gradient of a function, or of a part of it.
pub(super) fn jet_of(function: &dyn Implicit, part: Option<&Part>, point: DVec3) -> Jet<f64> {
    match part {
        Some(part) => function.jet_of(part, point),
        None => function.jet(point),
    }
}

/// A search for the crossings of a ray. Pieces are searched one after the other.
pub(crate) struct Search<'a> {
    pub function: &'a dyn Implicit,
    pub ray: Ray,
    /// Length below which pieces are not halved.
    resolution: f64,
    /// Whether crossings are asked for that enter alone, and not where they are exactly.
    entries: bool,
    /// Side of the surface on which the last piece ended, if it is known.
    inside: Option<bool>,
    /// Halvings that are left.
    left: u32,
    pub evaluations: u64,
    /// Takes each crossing, and whether the ray enters there; returns whether to go on.
    tell: &'a mut dyn FnMut(f64, bool) -> bool,
}

/// A piece of a ray on which a function rises or falls all the way.
struct Slope {
    piece: [f64; 2],
    /// Sides at the ends, where they are known.
    sides: [Option<bool>; 2],
    /// Slope somewhere on the piece.
    slope: f64,
    /// Place where the crossing may be, if there is one.
    guess: f64,
    curvature: f64,
}

impl<'a> Search<'a> {
    /// Starts a search.
    pub fn new(
        function: &'a dyn Implicit,
        ray: Ray,
        (resolution, entries): (f64, bool),
        tell: &'a mut dyn FnMut(f64, bool) -> bool,
    ) -> Self {
        Self {
            function,
            ray,
            resolution,
            entries,
            inside: None,
            left: MOST_HALVED,
            evaluations: 0,
            tell,
        }
    }

    /// Goes over a piece that is all on one side. Returns false if the search is to end, as all of
    /// the following do.
    pub fn pass(&mut self, from: f64, inside: bool) -> bool {
        let before = self.inside.replace(inside);
        match before {
            Some(before) if before != inside => self.report(from, inside),
            _ => true,
        }
    }

    /// Reports a crossing, if it is asked for.
    fn report(&mut self, t: f64, enters: bool) -> bool {
        (self.entries && !enters) || (self.tell)(t, enters)
    }

    /// Value, less T, and slope at a parameter.
    fn at(&mut self, part: Option<&Part>, t: f64) -> [f64; 2] {
        let jet = self.jet(part, self.ray.at(t));
        let slope = DVec3::from_array(jet.gradient).dot(self.ray.direction);
        [jet.value - THRESHOLD, slope]
    }

    fn jet(&mut self, part: Option<&Part>, point: DVec3) -> Jet<f64> {
        self.evaluations += 1;
        jet_of(self.function, part, point)
    }

    /// Searches a piece of the ray. If the function knows balls without crossings the ray goes from
    /// one to the next; the piece after them is as long as the function's scale.
    pub fn march(&mut self, part: Option<&Part>, [from, to]: [f64; 2]) -> bool {
        let mut at = from;
        while at < to {
            let place = self.ray.at(at);
            let clear = match part {
                Some(part) => self.function.clearance_of(part, place),
                None => self.function.clearance(place),
            };
            let Some(clear) = clear else {
                return self.cross(part, [at, to], None);
            };
            self.evaluations += 1;
            // A shorter step would cost more than it saves.
            if clear.radius < NEAR * clear.scale {
                let end = (at + clear.scale).min(to);
                if !self.cross(part, [at, end], None) {
                    return false;
                }
                at = end;
            } else {
                at += clear.radius;
            }
        }
        true
    }

    /// Searches a piece of the ray in a flat cell.
    pub fn cross_flat(&mut self, flat: &Flat, [from, to]: [f64; 2]) -> bool {
        let direction = self.ray.direction;
        let [start, end] = [from, to].map(|t| self.ray.at(t) - flat.center);
        let length = to - from;
        let reach = start.length().max(end.length()) * (1.0 + 1e-9);
        // v(x) = v₀ + v₁·x + v₂·x², x from the start of the piece.
        let bent = flat.hessian * start;
        let value = flat.value + flat.gradient.dot(start) + 0.5 * bent.dot(start);
        let slope = flat.gradient.dot(direction) + bent.dot(direction);
        let half = 0.5 * direction.dot(flat.hessian * direction);
        let values = [value, value + (slope + half * length) * length];
        let slopes = [slope, slope + 2.0 * half * length];
        let doubt = flat.error(reach) + VALUE_ERROR * (2.0 + flat.value.abs());
        let sides = values.map(|value| (value.abs() > doubt).then_some(value > 0.0));
        let turn = flat.turn(reach);
        let same = slopes[0] * slopes[1] > 0.0;
        if let [Some(a), Some(b)] = sides
            && a == b
        {
            // Between the ends it turns where its slope is 0.
            let crest = value - 0.25 * slope * slope / half;
            if same || (crest.abs() > doubt && (crest > 0.0) == a) {
                return self.pass(from, a);
            }
        }
        let part = flat.part.as_deref();
        let least = slopes[0].abs().min(slopes[1].abs());
        if same && least > turn {
            let root = (slope * slope - 4.0 * half * value).max(0.0).sqrt();
            let guess = from - 2.0 * value / (slope + root.copysign(slope));
            let slope = Slope {
                piece: [from, to],
                sides,
                slope,
                guess,
                curvature: flat.bend.smooth(),
            };
            return self.cross_slope(part, &slope);
        }
        let along = 2.0 * half.abs() + flat.second + flat.third * reach;
        let bend = Bend {
            curvature: flat.bend.curvature.min(along),
            ..flat.bend
        };
        self.cross(part, [from, to], Some(bend))
    }

    /// Searches a piece of the ray, with bounds that hold around it, if there are any.
    pub fn cross(&mut self, part: Option<&Part>, piece: [f64; 2], known: Option<Bend>) -> bool {
        let mut stack = vec![(piece, known)];
        while let Some(([a, b], known)) = stack.pop() {
            let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
            let center = self.ray.at(middle);
            let radius = half * (1.0 + 1e-9) + 4e-16 * (center.abs().max_element() + middle);
            let (bend, jet) = match known {
                Some(bend) if radius >= SHORT * bend.radius => (bend, None),
                _ => {
                    let ball = Ball { center, radius };
                    if self.function.most(ball) < THRESHOLD {
                        if !self.pass(a, false) {
                            return false;
                        }
                        continue;
                    }
                    let (bounds, jet) = self.function.variation_with_jet(part, ball);
                    self.evaluations += 1;
                    let [least, most] = bounds.range.value;
                    if least > THRESHOLD || most < THRESHOLD {
                        if !self.pass(a, least > THRESHOLD) {
                            return false;
                        }
                        continue;
                    }
                    (Bend::of(&bounds, radius), jet)
                }
            };
            let jet = jet.unwrap_or_else(|| self.jet(part, center));
            let value = jet.value - THRESHOLD;
            let slope = DVec3::from_array(jet.gradient).dot(self.ray.direction);
            let rounding = VALUE_ERROR * (1.0 + jet.value.abs());
            if value.abs() > bend.change(slope, radius) + rounding {
                if !self.pass(a, value > 0.0) {
                    return false;
                }
                continue;
            }
            // False if the bound is infinite.
            let is_slope = slope.abs() > bend.turn(radius) && bend.step == 0.0;
            if !is_slope && b - a > self.resolution && self.left > 0 {
                self.left -= 1;
                stack.push(([middle, b], Some(bend)));
                stack.push(([a, middle], Some(bend)));
                continue;
            }
            let doubt = bend.error(radius) + rounding;
            let sides = [value - slope * half, value + slope * half]
                .map(|end| (is_slope && end.abs() > doubt).then_some(end > 0.0));
            let on = if is_slope {
                let slope = Slope {
                    piece: [a, b],
                    sides,
                    slope,
                    guess: middle - value / slope,
                    curvature: bend.smooth(),
                };
                self.cross_slope(part, &slope)
            } else {
                self.cross_ends(part, [a, b], sides, (middle, f64::INFINITY))
            };
            if !on {
                return false;
            }
        }
        true
    }

    /// Searches a piece on which the function rises or falls all the way.
    fn cross_slope(&mut self, part: Option<&Part>, slope: &Slope) -> bool {
        if self.entries && slope.slope < 0.0 {
            // The ray enters nowhere.
            self.inside = slope.sides[1];
            return true;
        }
        self.cross_ends(
            part,
            slope.piece,
            slope.sides,
            (slope.guess, slope.curvature),
        )
    }

    /// Searches a piece with at most one crossing, which the sides at its ends tell.
    fn cross_ends(
        &mut self,
        part: Option<&Part>,
        [a, b]: [f64; 2],
        sides: [Option<bool>; 2],
        (guess, curvature): (f64, f64),
    ) -> bool {
        let before = self.inside.or(sides[0]);
        let start = before.unwrap_or_else(|| self.at(part, a)[0] >= 0.0);
        let end = sides[1].unwrap_or_else(|| self.at(part, b)[0] >= 0.0);
        self.inside = Some(end);
        if start == end {
            return true;
        }
        let t = if self.entries {
            b
        } else {
            self.refine(part, ([a, b], end), (guess, curvature))
        };
        self.report(t, end)
    }

    /// Finds the crossing on a piece whose ends are on either side, by Newton's steps kept inside a
    /// bracket that shrinks. `rises` tells whether the function is above T at the far end.
    fn refine(
        &mut self,
        part: Option<&Part>,
        ([mut low, mut high], rises): ([f64; 2], bool),
        (guess, curvature): (f64, f64),
    ) -> f64 {
        let tolerance = HIT_ERROR * (1.0 + high);
        let mut x = if guess > low && guess < high {
            guess
        } else {
            0.5 * (low + high)
        };
        let mut width = high - low;
        for _ in 0..200 {
            let [value, slope] = self.at(part, x);
            if value == 0.0 {
                return x;
            }
            if (value < 0.0) == rises {
                low = x;
            } else {
                high = x;
            }
            if high - low <= tolerance {
                break;
            }
            let step = value / slope;
            let newton = x - step;
            let halved = high - low < 0.5 * width;
            width = high - low;
            let is_newton = newton > low && newton < high && (halved || step.abs() < 0.25 * width);
            let next = if is_newton {
                newton
            } else {
                0.5 * (low + high)
            };
            if next == x || next <= low || next >= high {
                break;
            }
            // After a step of Newton's the error is at most C·δ²/(2|f′|).
            let error = (0.5 * curvature * step * step / slope.abs()).min(step.abs());
            if is_newton && error <= tolerance {
                return next;
            }
            x = next;
        }
        x
    }
}
