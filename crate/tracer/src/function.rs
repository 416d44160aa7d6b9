//! Bodies whose surface is that of any implicit function: certified root isolation along single
//! rays.
//!
//! On a piece of a ray with the middle m and the half-length h Taylor's theorem says
//! `|f(m+x) − f(m) − f′(m)·x| ≤ C·x²/2 + J·|x|`, where C bounds the curvature in the ball around
//! the piece, and J the jumps of the gradient. So a piece has no crossing if the function's range
//! in that ball leaves the threshold out, or if `|f(m) − T| > (|f′(m)| + J)·h + C·h²/2`; and at
//! most one if `|f′(m)| > C·h + J`, which the signs at its ends then tell. Any other piece is
//! halved, down to a resolution.
use crate::body::Body;
use crate::ray::Ray;
use crate::roots::refine_root;
use crate::walk::Quest;
use field::{Ball, Implicit, THRESHOLD};
use glam::DVec3;
use scene::{ComposedSurface, Scene, Unit};
use std::sync::Arc;

/// Length below which pieces of rays are not halved, in units of the scene's size.
const RESOLUTION: f64 = 5e-7;
/// Distance up to which surfaces without a support are followed, in units of the scene's size.
const FURTHEST: f64 = 1e4;
/// Offset of rays to the lights above a hit at t, over 1 + t.
const LIFT: f64 = 1e-6;
/// Most halvings of pieces of one ray; on the rest the signs at the ends decide.
const MOST_HALVED: u32 = 1 << 16;
/// Radius of a ball without crossings, in the function's scale, below which the surface is looked
/// for.
const NEAR: f64 = 0.25;
/// Rounding of a function's value in double precision, in T.
const VALUE_ERROR: f64 = 1e-12;

/// The surface of an implicit function as a body of a picture.
#[derive(Clone, Debug)]
pub(crate) struct FunctionBody {
    /// The body's number in the scene.
    pub number: u32,
    /// The function, in coordinates of its own.
    pub function: Arc<dyn Implicit>,
    /// Finish of each of the function's elements.
    pub finish: Vec<u32>,
    /// The scene's element that each of the function's elements came from; empty for a function
    /// that was added.
    pub element: Vec<u32>,
    /// Ball outside which there is no surface, in the function's coordinates.
    pub support: Option<Ball>,
    /// The map from the function's coordinates to those of the unit scene.
    pub unit: Unit,
}

/// A query for the crossings along one ray.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RayQuery {
    pub ray: Ray,
    /// Parameters between which the ray is followed.
    pub range: [f64; 2],
    /// Length below which pieces are not halved.
    pub resolution: f64,
}

impl FunctionBody {
    /// Returns the function of a body of the unit scene.
    pub fn of(surface: ComposedSurface, scene: &Scene) -> Self {
        let elements = surface.element.iter();
        Self {
            number: surface.body,
            support: surface.function.support(),
            finish: elements
                .map(|&e| scene.elements[e as usize].finish)
                .collect(),
            function: surface.function,
            element: surface.element,
            unit: Unit::IDENTITY,
        }
    }

    /// Calls `tell` with each crossing of a ray of the unit scene, and whether the ray enters
    /// there, until `tell` returns false. Returns the number of evaluations.
    fn crossings(&self, ray: &Ray, limit: f64, mut tell: impl FnMut(f64, bool) -> bool) -> u64 {
        let scale = self.unit.length(1.0);
        let ray = Ray {
            origin: self.unit.world(ray.origin),
            direction: ray.direction,
        };
        let Some(range) = range(self.support, &ray, limit * scale, FURTHEST * scale) else {
            return 0;
        };
        let along = RayQuery {
            ray,
            range,
            resolution: RESOLUTION * scale,
        };
        crossings(&*self.function, &along, |t, enters| tell(t / scale, enters))
    }
}

impl Body for FunctionBody {
    fn number(&self) -> u32 {
        self.number
    }

    fn first(&self, ray: &Ray, limit: f64, quest: Quest) -> (Option<f64>, u64) {
        let mut found = None;
        let evaluations = self.crossings(ray, limit, |t, enters| {
            if enters || quest != Quest::Entry {
                found = Some(t);
            }
            found.is_none()
        });
        (found, evaluations)
    }

    fn all(&self, ray: &Ray) -> Vec<(f64, DVec3)> {
        let mut found = Vec::new();
        self.crossings(ray, f64::INFINITY, |t, _| {
            found.push((t, self.gradient(ray, t)));
            true
        });
        found
    }

    fn gradient(&self, ray: &Ray, t: f64) -> DVec3 {
        let jet = self.function.jet(self.unit.world(ray.at(t)));
        DVec3::from_array(jet.gradient)
    }

    fn shares(&self, point: DVec3, shares: &mut Vec<(u32, u32, f64)>) {
        let mut own = Vec::new();
        self.function.shares(self.unit.world(point), &mut own);
        let first = self.finish.first();
        shares.extend(own.into_iter().filter_map(|(number, share)| {
            let element = self.element.get(number as usize).unwrap_or(&u32::MAX);
            let finish = self.finish.get(number as usize).or(first)?;
            Some((*element, *finish, share))
        }));
    }

    fn lift(&self, t: f64) -> f64 {
        LIFT * (1.0 + t)
    }
}

/// Returns the range of a ray, up to a limit, within a surface's ball; `None` if the ray misses it.
/// Without a ball the range ends at `furthest`.
pub(crate) fn range(
    support: Option<Ball>,
    ray: &Ray,
    limit: f64,
    furthest: f64,
) -> Option<[f64; 2]> {
    let [near, far] = match support {
        None => [0.0, furthest],
        Some(Ball { center, radius }) => {
            let offset = center - ray.origin;
            let along = offset.dot(ray.direction);
            let across = (offset - ray.direction * along).length_squared();
            let square = radius * radius * (1.0 + 1e-9) - across;
            if square < 0.0 {
                return None;
            }
            let half = square.sqrt();
            [(along - half).max(0.0), along + half]
        }
    };
    let far = far.min(limit);
    (near < far).then_some([near, far])
}

/// Returns the next piece of a ray, up to `end`, in which there may be crossings, and the number of
/// evaluations that finding it took. If the function knows balls without crossings the ray goes
/// from one to the next; the piece after them is as long as the function's scale. `None` if there
/// is no crossing up to the end.
fn next_piece(function: &dyn Implicit, ray: &Ray, from: f64, end: f64) -> (Option<[f64; 2]>, u64) {
    let mut at = from;
    let mut evaluations = 0;
    while at < end {
        let Some(clear) = function.clearance(ray.at(at)) else {
            return (Some([at, end]), evaluations);
        };
        evaluations += 1;
        // A shorter step would cost more than it saves.
        if clear.radius < NEAR * clear.scale {
            return (Some([at, (at + clear.scale).min(end)]), evaluations);
        }
        at += clear.radius;
    }
    (None, evaluations)
}

/// Calls `tell` with each crossing of a ray with the surface of a function, and whether the ray
/// enters there, in order, until `tell` returns false. Returns the number of evaluations.
pub(crate) fn crossings(
    function: &dyn Implicit,
    along: &RayQuery,
    mut tell: impl FnMut(f64, bool) -> bool,
) -> u64 {
    let [mut from, end] = along.range;
    let mut left = MOST_HALVED;
    let mut evaluations = 0;
    while from < end {
        let (piece, more) = next_piece(function, &along.ray, from, end);
        evaluations += more;
        let Some(piece) = piece else { break };
        if !isolate(
            function,
            along,
            piece,
            &mut left,
            &mut evaluations,
            &mut tell,
        ) {
            break;
        }
        from = piece[1];
    }
    evaluations
}

/// Calls `tell` with each crossing on a piece of a ray. Returns false if `tell` did.
fn isolate(
    function: &dyn Implicit,
    along: &RayQuery,
    piece: [f64; 2],
    left: &mut u32,
    evaluations: &mut u64,
    tell: &mut impl FnMut(f64, bool) -> bool,
) -> bool {
    let ray = &along.ray;
    let mut stack = vec![piece];
    while let Some([a, b]) = stack.pop() {
        let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
        let center = ray.at(middle);
        let radius = half * (1.0 + 1e-9) + 4e-16 * (center.abs().max_element() + middle);
        let ball = Ball { center, radius };
        if function.most(ball) < THRESHOLD {
            continue;
        }
        let (bounds, known) = function.variation_with_jet(ball);
        *evaluations += 1;
        let [least, most] = bounds.range.value;
        if least > THRESHOLD || most < THRESHOLD {
            continue;
        }
        let jet = known.unwrap_or_else(|| function.jet(center));
        let slope = DVec3::from_array(jet.gradient).dot(ray.direction);
        // How much the slope may change between the middle and another point of the piece.
        let bend = bounds.curvature * radius + bounds.jump;
        let change = (slope.abs() + 0.5 * bounds.curvature * radius + bounds.jump) * radius;
        let change = change.min(bounds.range.slope * radius) + bounds.step;
        if (jet.value - THRESHOLD).abs() > change + VALUE_ERROR * (1.0 + jet.value.abs()) {
            continue;
        }
        // False if the bound is infinite.
        let monotone = slope.abs() > bend && bounds.step == 0.0;
        if !monotone && b - a > along.resolution && *left > 0 {
            *left -= 1;
            stack.push([middle, b]);
            stack.push([a, middle]);
            continue;
        }
        let inside = [a, b].map(|t| function.jet(ray.at(t)).value >= THRESHOLD);
        *evaluations += 2;
        if inside[0] == inside[1] {
            continue;
        }
        let t = refine_root(
            |t| {
                *evaluations += 1;
                let jet = function.jet(ray.at(t));
                let slope = DVec3::from_array(jet.gradient).dot(ray.direction);
                (jet.value - THRESHOLD, slope)
            },
            a,
            b,
            1e-14 * (1.0 + b),
        );
        if !tell(t, inside[1]) {
            return false;
        }
    }
    true
}
