//! Cells of space, in which a function is known well enough to meet many rays.
//!
//! The cube around a body's surface is halved along each axis, again and again, but only where rays
//! go, and front to back along them. A cell is one of
//!
//! - *outside* or *inside*: the function is proved to be below, or above, the threshold;
//! - *flat*: the function is near the first terms of its Taylor series about the cell's middle c:
//!   `f(c) + ∇f(c)·x`, from which it differs by at most `C·|x|²/2 + J·|x|`, where C bounds the
//!   curvature and J the jumps of the gradient ([`field::Variation`]); or, where that is not
//!   enough, these and `xᵀHx/2`, from which second derivatives differ by at most `2.74·R + M·|x|`,
//!   where M bounds the third derivative of all that has one, and R the second one of the rest.
//!   The error of the gradient is at most a share of `|∇f(c)|`. So most rays are decided by
//!   arithmetic alone: those along which the series is further from T than its error do not cross,
//!   those along which its slope is larger than its error cross once or not at all, as the sides at
//!   both ends tell. All others are halved ([`search`]) with bounds of the cell, which costs a
//!   value for each half and no bounds;
//! - *few*: only few terms of the function matter, and rays go among these alone;
//! - *rough*: as small as cells get. Rays are halved there with bounds of their own ([`search`]);
//! - *split*: none of these. Its eight parts are made when a ray comes to them.
//!
//! On its way down the function is narrowed ([`Implicit::narrow`]) to the terms that matter, by as
//! little as hits cannot show ([`SLACK`]). A hit is found between two places whose sides are known,
//! by Newton's steps on the function of the cell itself, down to the precision of double numbers.
//!
//! # Why it is the same picture in any order
//!
//! A cell is a function of the body and of its address, and of no ray. The rays that come first
//! make it, and all others find the same; a ray's crossings depend on the cells along it alone.
//! Threads share the cells, as `OnceLock`s; two that make one at a time make the same. Costs
//! of making cells are not counted to rays ([`map`](crate::map)), as it depends on the order who
//! makes them.
//!
//! # Limits
//!
//! - A cell is no smaller than [`DEEPEST`] halvings of the cube.
//! - All cells of a world take at most [`MOST_BYTES`]: beyond, cells are made for a ray and
//!   forgotten, so that pictures are the same and take longer.
//! - Functions without a ball around their surface have no cells. Their rays are halved alone.
mod flat;
pub(crate) mod search;

use crate::ray::Ray;
use core::sync::atomic::{AtomicUsize, Ordering};
use field::{Ball, Implicit, Part, Slack, THRESHOLD};
use flat::{Bend, Flat};
use glam::{DMat3, DVec3};
use search::{Search, jet_of};
use std::sync::{Arc, OnceLock};

/// Most halvings of the cube.
const DEEPEST: u32 = 8;
/// Most bytes that the cells of a world take, 256 MB.
const MOST_BYTES: usize = 256 << 20;
/// Largest sum of terms that narrowing leaves out, in units of T.
const SLACK: f64 = 1e-11;
/// Step of differences of gradients, over a cell's radius.
const STEP: f64 = 1e-3;
/// Rounding of a gradient, as a share of the steepest.
const ROUNDING: f64 = 1e-10;
/// Terms among which rays go without further cells.
const FEW: usize = 12;
/// Radius of cells in the function's scale below which rays go without further cells.
const FINE: f64 = 0.5;
/// Vain attempts to narrow a function after which its parts are not narrowed either.
const VAIN: u32 = 3;

/// The cells of a body.
#[derive(Debug)]
pub(crate) struct Cells {
    center: DVec3,
    half: f64,
    root: Cell,
    /// Bytes that the cells of the whole world take.
    bytes: Arc<AtomicUsize>,
}

/// A cell, made when the first ray comes to it.
#[derive(Debug, Default)]
struct Cell {
    state: OnceLock<State>,
    parts: OnceLock<Box<[Cell; 8]>>,
}

/// State of a cell: knowledge of the function in it.
#[derive(Debug)]
enum State {
    Outside,
    Inside,
    Flat(Box<Flat>),
    /// A cell with few terms, or as small as cells get.
    Last(Option<Arc<Part>>),
    Split {
        part: Option<Arc<Part>>,
        /// Number of attempts to narrow the function further that were in vain.
        vain: u32,
    },
}

/// Knowledge that a cell inherits from the one that it is a part of.
#[derive(Clone, Copy)]
struct Above<'a> {
    /// The function as it is narrowed there.
    part: Option<&'a Arc<Part>>,
    /// Number of attempts to narrow it that were in vain.
    vain: u32,
    /// Whether there is room for the cell, or it is made for one ray.
    kept: bool,
}

impl Above<'_> {
    /// Knowledge of the cell of the whole cube.
    const NONE: Self = Self {
        part: None,
        vain: 0,
        kept: true,
    };
}

/// A cube of space: the address of a cell.
#[derive(Clone, Copy)]
struct Cube {
    center: DVec3,
    half: f64,
    depth: u32,
}

impl Cube {
    /// Returns a ball around the cube, a little larger than rounded parameters of rays need.
    fn ball(&self, whole: f64) -> Ball {
        Ball {
            center: self.center,
            radius: self.half * 3f64.sqrt() * (1.0 + 1e-9) + 1e-12 * whole,
        }
    }

    /// Returns one of the eight parts: bit i of the number tells whether it is the upper half along
    /// axis i.
    fn part(&self, number: usize) -> Self {
        let half = 0.5 * self.half;
        let sides = [0, 1, 2].map(|axis| if number >> axis & 1 == 0 { -half } else { half });
        Self {
            center: self.center + DVec3::from_array(sides),
            half,
            depth: self.depth + 1,
        }
    }
}

impl Cells {
    /// Prepares the cells of a surface in a ball.
    pub fn new(support: Ball, bytes: Arc<AtomicUsize>) -> Self {
        Self {
            center: support.center,
            half: support.radius * (1.0 + 1e-6),
            root: Cell::default(),
            bytes,
        }
    }

    /// Returns the cube that is cut.
    fn cube(&self) -> Cube {
        Cube {
            center: self.center,
            half: self.half,
            depth: 0,
        }
    }

    /// Searches a piece of a ray that is in a cell. Returns false if the search is to end.
    fn visit(
        &self,
        cell: &Cell,
        cube: Cube,
        above: Above<'_>,
        search: &mut Search<'_>,
        [from, to]: [f64; 2],
    ) -> bool {
        let state = cell.state.get_or_init(|| {
            let state = self.examine(search.function, cube, above);
            if above.kept {
                self.bytes
                    .fetch_add(state.bytes(above.part), Ordering::Relaxed);
            }
            state
        });
        match state {
            State::Outside => search.pass(from, false),
            State::Inside => search.pass(from, true),
            State::Flat(flat) => search.cross_flat(flat, [from, to]),
            State::Last(part) => search.march(part.as_deref(), [from, to]),
            State::Split { part, vain } => {
                let fresh;
                let kept = match cell.parts.get() {
                    Some(parts) => Some(parts),
                    None if above.kept && self.bytes.load(Ordering::Relaxed) < MOST_BYTES => {
                        Some(cell.parts.get_or_init(|| {
                            self.bytes
                                .fetch_add(size_of::<[Cell; 8]>(), Ordering::Relaxed);
                            Box::default()
                        }))
                    }
                    None => None,
                };
                let below = Above {
                    part: part.as_ref(),
                    vain: *vain,
                    kept: kept.is_some(),
                };
                let parts = match kept {
                    Some(parts) => parts,
                    None => {
                        fresh = Box::default();
                        &fresh
                    }
                };
                let mut start = from;
                for end in cuts(&search.ray, &cube, [from, to]) {
                    if end > start {
                        let place = search.ray.at(0.5 * (start + end));
                        let number = place.cmpge(cube.center).bitmask() as usize;
                        let part = cube.part(number);
                        if !self.visit(&parts[number], part, below, search, [start, end]) {
                            return false;
                        }
                        start = end;
                    }
                }
                true
            }
        }
    }

    /// Finds out about the function in a cell.
    fn examine(&self, function: &dyn Implicit, cube: Cube, above: Above<'_>) -> State {
        let ball = cube.ball(self.half);
        if function.most(ball) < THRESHOLD {
            return State::Outside;
        }
        let slack = Slack {
            left_out: SLACK,
            far: 0.0,
        };
        let own = if above.vain < VAIN {
            function.narrow(ball, above.part.map(|part| &**part), slack)
        } else {
            None
        };
        let vain = if own.is_some() { 0 } else { above.vain + 1 };
        let part = own.map(Arc::new).or_else(|| above.part.cloned());
        let narrow = part.as_deref();
        let is_last = cube.depth >= DEEPEST;
        let clear = match narrow {
            Some(part) => function.clearance_of(part, ball.center),
            None => function.clearance(ball.center),
        };
        if let Some(clear) = clear {
            if clear.radius > ball.radius {
                return State::of_side(jet_of(function, narrow, ball.center).value > THRESHOLD);
            }
            let is_few = narrow.is_some_and(|part| part.terms.len() <= FEW);
            return if is_few || is_last || ball.radius < FINE * clear.scale {
                State::Last(part)
            } else {
                State::Split { part, vain }
            };
        }
        let (bounds, jet) = function.variation_with_jet(narrow, ball);
        let jet = jet.unwrap_or_else(|| jet_of(function, narrow, ball.center));
        let bounds = bounds.about(&jet, ball.radius);
        let [least, most] = bounds.range.value;
        if least > THRESHOLD || most < THRESHOLD {
            return State::of_side(least > THRESHOLD);
        }
        let bend = Bend::of(&bounds, ball.radius);
        let gradient = DVec3::from_array(jet.gradient);
        let mut flat = Flat {
            center: ball.center,
            value: jet.value - THRESHOLD,
            gradient,
            hessian: DMat3::ZERO,
            second: bend.curvature,
            third: 0.0,
            bend,
            part,
        };
        if flat.is_flat() {
            return State::Flat(Box::new(flat));
        }
        // Forward differences of the gradient are off by their share of the third derivative, and
        // by what is rough; a column each.
        let step = STEP * ball.radius;
        let root = 3f64.sqrt();
        flat.second = (1.0 + root) * bounds.rough + root * 0.5 * step * bounds.third;
        flat.third = bounds.third;
        let mut turns = None;
        if flat.is_flat() {
            turns = function.turn_smoothly(flat.part.as_deref(), ball, step);
            // Where the gradient jumps, its differences say nothing about second derivatives.
            if turns.is_none() && bend.jump == 0.0 {
                turns = Some(DVec3::AXES.map(|axis| {
                    let beside = ball.center + axis * step;
                    let beside = jet_of(function, flat.part.as_deref(), beside);
                    DVec3::from_array(beside.gradient) - gradient
                }));
            }
        }
        if let Some(turns) = turns {
            let [x, y, z] = turns.map(|turn| turn / step);
            let found = DMat3::from_cols(x, y, z);
            flat.hessian = (found + found.transpose()) * 0.5;
            // Rounding of the gradients.
            flat.second += ROUNDING * gradient.length().max(bend.slope) / step;
            return State::Flat(Box::new(flat));
        }
        let part = flat.part;
        if is_last {
            State::Last(part)
        } else {
            State::Split { part, vain }
        }
    }
}

/// Searches a ray for crossings in a range of its parameters, which must be within the ball of the
/// cells, if there are any. Returns the number of evaluations.
pub(crate) fn search_in(cells: Option<&Cells>, mut search: Search<'_>, range: [f64; 2]) -> u64 {
    match cells {
        Some(cells) => cells.visit(&cells.root, cells.cube(), Above::NONE, &mut search, range),
        None => search.march(None, range),
    };
    search.evaluations
}

impl State {
    fn of_side(inside: bool) -> Self {
        if inside { Self::Inside } else { Self::Outside }
    }

    /// Returns the bytes that it takes beside its own size, about, and beside a part that it shares
    /// with the cell above.
    fn bytes(&self, above: Option<&Arc<Part>>) -> usize {
        let (own, part) = match self {
            Self::Outside | Self::Inside => (0, None),
            Self::Flat(flat) => (size_of::<Flat>(), flat.part.as_ref()),
            Self::Last(part) | Self::Split { part, .. } => (0, part.as_ref()),
        };
        let part = part.filter(|part| above.is_none_or(|above| !Arc::ptr_eq(above, part)));
        own + part.map_or(0, |part| size_of::<Part>() + 4 * part.terms.capacity())
    }
}

/// Returns the parameters, in order, at which a piece of a ray passes from one part of a cube to
/// another, and its end.
fn cuts(ray: &Ray, cube: &Cube, [from, to]: [f64; 2]) -> [f64; 4] {
    let mut cuts = [to; 4];
    let offset = cube.center - ray.origin;
    for axis in 0..3 {
        let t = offset[axis] / ray.direction[axis];
        // Not so for a ray along the plane.
        if t > from && t < to {
            cuts[axis] = t;
        }
    }
    // The end is the largest already.
    for (i, j) in [(0, 1), (1, 2), (0, 1)] {
        if cuts[j] < cuts[i] {
            cuts.swap(i, j);
        }
    }
    cuts
}

#[cfg(test)]
mod tests {
    use super::*;
    use field::Sum;
    use trials::{Random, count, scenes};

    /// Returns the sum of some primitives, a place where its surface is, and rays past there.
    fn trial(random: &mut Random) -> (Sum, Ball, DVec3, Vec<Ray>) {
        let (sum, support, place) = loop {
            let scene = scenes::blend(random.below(1000) as u64, 2 + random.below(4));
            let sum = scene.soft_surfaces().swap_remove(0).sum;
            // Not of planes.
            let Some(support) = sum.support() else {
                continue;
            };
            let mut places = (0..200).map(|_| random.vector(1.5));
            if let Some(mut inside) = places.find(|place| sum.jet(*place).value > THRESHOLD) {
                let mut outside = support.center + random.direction() * support.radius;
                for _ in 0..60 {
                    let middle = inside.midpoint(outside);
                    let is_inside = sum.jet(middle).value > THRESHOLD;
                    *(if is_inside { &mut inside } else { &mut outside }) = middle;
                }
                break (sum, support, inside);
            }
        };
        let rays = (0..24).map(|_| {
            let origin = support.center + random.direction() * (2.5 * support.radius);
            let beside = random.decades(-3.0, 0.0);
            let aim = place + random.vector(beside);
            Ray {
                origin,
                direction: (aim - origin).normalize(),
            }
        });
        let rays = rays.collect();
        (sum, support, place, rays)
    }

    fn search(cells: &Cells, sum: &Sum, support: Ball, ray: &Ray, entries: bool) -> Vec<f64> {
        let mut found = Vec::new();
        if let Some(range) = crate::function::range(Some(support), ray, 1e9, 1e9) {
            let asked = (5e-7, entries);
            search_in(
                Some(cells),
                Search::new(sum, *ray, asked, &mut |t, _| {
                    found.push(t);
                    true
                }),
                range,
            );
        }
        found
    }

    #[test]
    fn cells_that_are_forgotten_give_the_same_bits() {
        /// Bytes that are left for some of the cells.
        const ROOM: usize = 10_000;
        let mut random = Random::new(41);
        let (mut hits, mut scarce) = (0, 0);
        for _ in 0..count(12) {
            let (sum, support, _, rays) = trial(&mut random);
            let kept = Cells::new(support, Arc::default());
            let full = Arc::new(AtomicUsize::new(MOST_BYTES));
            let forgotten = Cells::new(support, full.clone());
            let part = Arc::new(AtomicUsize::new(MOST_BYTES - ROOM));
            let partly = Cells::new(support, part.clone());
            for ray in &rays {
                let [a, b, c] = [&kept, &forgotten, &partly].map(|cells| {
                    let found = search(cells, &sum, support, ray, false);
                    found.into_iter().map(f64::to_bits).collect::<Vec<_>>()
                });
                assert_eq!(a, b);
                assert_eq!(a, c);
                hits += a.len();
            }
            let bytes = kept.bytes.load(Ordering::Relaxed);
            let [none, few] = [&full, &part].map(|bytes| bytes.load(Ordering::Relaxed));
            // A world without room keeps the root alone, and one with little room exceeds it by
            // the cells that were being made when it ran out.
            assert!(
                none - MOST_BYTES < 4000 && few - MOST_BYTES < 12_000,
                "{none} {few}"
            );
            assert!(bytes > 4000);
            scarce += usize::from(bytes > ROOM + 12_000);
        }
        assert!(scarce > count(6), "{scarce}");
        assert!(hits > count(200), "{hits}");
    }

    /// Claims of cells about the function hold at random places.
    #[test]
    fn cells_keep_their_word() {
        let mut random = Random::new(42);
        let [mut decided, mut linear, mut quadratic] = [0; 3];
        for _ in 0..count(40) {
            let (sum, support, place, _) = trial(&mut random);
            let cells = Cells::new(support, Arc::default());
            let mut cube = cells.cube();
            for _ in 0..=DEEPEST {
                let state = cells.examine(&sum, cube, Above::NONE);
                for _ in 0..20 {
                    let offset =
                        cube.half * DVec3::from_array([0; 3].map(|_| random.range(-1.0, 1.0)));
                    let jet = sum.jet(cube.center + offset);
                    let value = jet.value - THRESHOLD;
                    match &state {
                        State::Outside => assert!(value < 1e-9),
                        State::Inside => assert!(value > -1e-9),
                        State::Flat(flat) => {
                            let bent = flat.hessian * offset;
                            let series = flat.value + (flat.gradient + 0.5 * bent).dot(offset);
                            let gradient = flat.gradient + bent;
                            let far = offset.length();
                            let doubt = 1e-9 * (1.0 + jet.value.abs());
                            assert!((series - value).abs() <= flat.error(far) + doubt);
                            let off = gradient.distance(DVec3::from_array(jet.gradient));
                            assert!(off <= flat.turn(far) + doubt / cube.half);
                        }
                        State::Last(_) | State::Split { .. } => {}
                    }
                }
                match state {
                    State::Outside | State::Inside => decided += 1,
                    State::Flat(flat) if flat.hessian == DMat3::ZERO => linear += 1,
                    State::Flat(_) => quadratic += 1,
                    State::Last(_) | State::Split { .. } => {}
                }
                // Towards the surface, or not quite.
                let aim = place + random.vector(0.3 * cube.half);
                cube = cube.part(aim.cmpge(cube.center).bitmask() as usize);
            }
        }
        assert!(
            decided > count(20) && quadratic > count(10),
            "{decided} {linear} {quadratic}"
        );
    }

    #[test]
    fn a_ray_enters_where_it_crosses_from_outside() {
        let mut random = Random::new(43);
        let (mut entered, mut missed) = (0, 0);
        for _ in 0..count(20) {
            let (sum, support, _, rays) = trial(&mut random);
            let cells = Cells::new(support, Arc::default());
            for ray in &rays {
                let all = search(&cells, &sum, support, ray, false);
                let entries = search(&cells, &sum, support, ray, true);
                // Rays that start outside enter and leave in turn.
                assert_eq!(entries.len(), all.len().div_ceil(2));
                entered += entries.len();
                missed += usize::from(entries.is_empty());
            }
        }
        assert!(
            entered > count(100) && missed > count(20),
            "{entered} {missed}"
        );
    }
}
