//! Levenberg and Marquardt's method on the control points' moves.
//!
//! The residual of an observation, if nothing else is asked for, is `w·s·tanh(h/s)` with the
//! distance h of [`Field::distance`]: a length that does not grow beyond s, so that outliers pull
//! little. s falls in steps from the mesh's distance at the start to three times the spread of the
//! nearer observations ([`spread`]), of which up to nearly half may be wrong: graduated
//! non-convexity.
//!
//! An implicit surface has two sheets, and where it is wide its field says little about which of
//! them a point is on. So the facets themselves are fitted first. Then they are drawn back from the
//! points by the height of the outer sheet over them ([`Run::heights`]), and only then the surface
//! takes their place, as thick as it is to be. The surface of balls is high over the facets, and
//! higher over large ones: it is the mesh that is to be on the points there, and the sheet above it
//! is fitted to points that are moved outwards by its mean height.

use crate::align::{Rigid, align, nudge};
use crate::cage::cage;
use crate::error::Error;
use crate::field::{Field, Gradient, Kind};
use crate::noise::noise;
use crate::normal::Normal;
use crate::problem::{Controls, Loss, Options, Problem};
use crate::stiffness::energy;
use core::cell::Cell;
use glam::DVec3;
use mesh::{Aabb, Bvh};
use metaballs::nearest;
use std::collections::BTreeSet;

/// Most iterations of a level, the last one or one on the way.
const PER_LEVEL: usize = 12;
const PER_COARSE_LEVEL: usize = 5;
/// s in spreads of the distances: at the start, and at the least.
const WIDE: f64 = 5.0;
const NARROW: f64 = 3.0;
/// The least s, in diagonals of the mesh's box.
const LEAST_SCALE: f64 = 3e-4;
/// Most levels.
const MOST_LEVELS: usize = 16;
/// Relative decrease of the sum below which a level is done, the last one or one on the way.
const SETTLED: f64 = 1e-4;
const SETTLED_COARSE: f64 = 1e-2;
/// Steps tried from one place, each more damped.
const MOST_TRIES: usize = 8;
/// The damping at the start of a level, and the least.
const DAMPING: f64 = 1e-3;
const LEAST_DAMPING: f64 = 1e-7;
/// k times the spread of the observations at the start of a fit by the field.
const REACH: f64 = 2.0;
/// Control points of the cage by which a mesh is fitted before its single vertices are.
const COARSE: usize = 60;
/// Steps to a height of the surface.
const RISING: usize = 12;
/// Share of left-out measurements above which a fit has failed: others may be the right ones.
const MOST_LEFT_OUT: f64 = 0.5;
/// Times the noise of the points, as they tell it themselves, that their spread about the surface
/// may have. Outliers make the noise look larger than it is, never smaller.
const ROUGHLY: f64 = 1.3;

/// State of a fit after an iteration.
#[derive(Clone, Debug, PartialEq)]
pub struct Progress {
    /// Iterations done.
    pub iteration: usize,
    /// Root of the mean square of the distances of the points that are no outliers; of outlines
    /// where there are no points.
    pub residual: f64,
    /// The share of observations further than three times that.
    pub outliers: f64,
    /// s, beyond which distances count no more.
    pub scale: f64,
    /// Rigid motion of the mesh before the fit.
    pub rigid: Rigid,
    /// The control points' moves.
    pub moves: Vec<DVec3>,
}

/// The result of a fit.
#[derive(Clone, Debug, PartialEq)]
pub struct Fitted {
    /// Rigid motion of the mesh and its controls before the fit.
    pub rigid: Rigid,
    /// The control points' moves after that, in the directions of the data.
    pub moves: Vec<DVec3>,
    /// The mesh's vertices.
    pub positions: Vec<DVec3>,
    /// The state after the last iteration.
    pub last: Progress,
    /// The factor of the moves' energy `½ Σ XᵀKX` in the sum that was made small last.
    pub smooth: f64,
    /// Whether the fit was stopped before it had settled.
    pub stopped: bool,
    /// Numbers of the points that were left out: further than three times the residual from the
    /// surface.
    pub left_out: Vec<u32>,
    /// Reason why the result cannot be relied on, a sentence; `None` if it can.
    pub failure: Option<String>,
}

/// Fits a mesh. `tell` is called after each iteration, and says whether to go on.
///
/// A mesh that is not to be turned and moved as a whole is fitted again after that, where its
/// result cannot be relied on, or where it is twice as near the points by that alone; the better
/// result counts.
///
/// # Errors
/// If the implicit surface cannot be made.
pub fn fit(problem: &Problem, tell: &mut Tell<'_>) -> Result<Fitted, Error> {
    if problem.by == Controls::Vertices {
        return fit_vertices(problem, tell);
    }
    let (points, options) = (&problem.observations.points, problem.options);
    let (positions, triangles) = (&problem.positions, &problem.triangles);
    if options.align {
        return fit_from(problem, align(positions, triangles, points), tell);
    }
    let fitted = fit_from(problem, Rigid::IDENTITY, tell)?;
    let begins_moved = problem.start.iter().any(|way| *way != DVec3::ZERO);
    let size = Aabb::of_points(positions.iter().copied()).size().length();
    let has_failed = fitted.failure.is_some();
    let is_near = !has_failed && fitted.last.residual < 1e-3 * size;
    if fitted.stopped || options.loss != Loss::Saturating || begins_moved || is_near {
        return Ok(fitted);
    }
    let rigid = if has_failed {
        align(positions, triangles, points)
    } else {
        nudge(positions, triangles, points)
    };
    if rigid == Rigid::IDENTITY {
        return Ok(fitted);
    }
    let again = fit_from(problem, rigid, tell)?;
    let is_nearer = has_failed || again.last.residual < 0.8 * fitted.last.residual;
    let is_better = again.failure.is_none() && !again.stopped && is_nearer;
    Ok(if is_better { again } else { fitted })
}

/// Fits a mesh by a cage of its own, then its vertices one by one. So many unknowns come so near
/// the points that the spread of these is no measure any more: it is held at the cage's.
fn fit_vertices(problem: &Problem, tell: &mut Tell<'_>) -> Result<Fitted, Error> {
    let mut coarse = problem.clone();
    for (place, way) in coarse.positions.iter_mut().zip(&problem.start) {
        *place += *way;
    }
    coarse.by = Controls::Cage(cage(&coarse.positions, &coarse.triangles, COARSE));
    coarse.control()?;
    coarse.start = vec![DVec3::ZERO; coarse.controls.len()];
    let mut fitted = fit(&coarse, tell)?;
    if !fitted.stopped && fitted.failure.is_none() {
        let mut fine = problem.clone();
        fine.positions.clone_from(&fitted.positions);
        fine.start.fill(DVec3::ZERO);
        fine.control()?;
        let mut run = Run::new(&fine, fitted.rigid);
        run.iteration = fitted.last.iteration;
        run.options.iterations += fitted.last.iteration;
        run.least_spread = fitted.last.residual;
        // Moves are smoothed over as wide a part of the surface as those of the cage were.
        let moved = fine.cage.iter().flatten().collect::<BTreeSet<_>>().len();
        run.options.smooth *= moved as f64 / coarse.controls.len() as f64;
        fitted = run.end(tell)?;
    }
    let own = problem.positions.iter();
    let ways = fitted.positions.iter().zip(own);
    fitted.moves = ways
        .map(|(end, own)| *end - fitted.rigid.apply(*own))
        .collect();
    fitted.last.moves.clone_from(&fitted.moves);
    Ok(fitted)
}

/// Fits a mesh that is turned and moved as a whole first.
fn fit_from(problem: &Problem, rigid: Rigid, tell: &mut Tell<'_>) -> Result<Fitted, Error> {
    let mut problem = problem.clone();
    if rigid != Rigid::IDENTITY {
        let cage = match &mut problem.by {
            Controls::Cage(cage) => &mut cage.positions[..],
            Controls::Lattice(_) | Controls::Vertices => &mut [],
        };
        for place in problem.positions.iter_mut().chain(cage) {
            *place = rigid.apply(*place);
        }
        // The far corners are those of the turned mesh, as where the moves are carried out.
        problem.control()?;
    }
    Run::new(&problem, rigid).end(tell)
}

/// Listener that is told the state after each iteration, and says whether to go on.
type Tell<'a> = dyn FnMut(&Progress) -> bool + 'a;

/// An observation for one iteration: a place, and its class: points, outlines, or [`LEFT_OUT`].
type Place = (DVec3, usize);

/// Class of the points that are passed over.
const LEFT_OUT: usize = 2;

struct Run<'a> {
    problem: &'a Problem,
    rigid: Rigid,
    options: Options,
    /// The surface that is fitted now.
    kind: Kind,
    /// Height of the surface's outer sheet over each vertex.
    heights: Vec<f64>,
    /// Whether each observation is passed over; none where this is empty.
    left_out: Vec<bool>,
    /// Shift of observations along the normals of their facets, in heights.
    shift: f64,
    /// Height over the facets at which the observations are to lie, in heights.
    rise: f64,
    stiffness: Vec<(u32, u32, f64)>,
    moves: Vec<DVec3>,
    positions: Vec<DVec3>,
    /// Facet that was last found nearest to each point.
    facets: Vec<Cell<u32>>,
    /// Distance of each point at the present positions, once it is known: see
    /// [`Self::apart`].
    apart: Option<Vec<f64>>,
    /// k of the implicit surface.
    slope: f64,
    scale: f64,
    damping: f64,
    iteration: usize,
    /// Whether there were too few iterations.
    is_cut: bool,
    /// The least spread of the observations that is believed.
    least_spread: f64,
    /// Weights of points, outlines and what is left out.
    weights: [f64; 3],
    /// Weight of the smoothness.
    smooth: f64,
}

impl<'a> Run<'a> {
    fn new(problem: &'a Problem, rigid: Rigid) -> Self {
        let options = problem.options;
        let slope = options.slope.unwrap_or(20.0 / problem.mean_edge());
        Self {
            problem,
            rigid,
            options,
            kind: Kind::Explicit,
            heights: Vec::new(),
            left_out: Vec::new(),
            shift: 0.0,
            rise: 0.0,
            stiffness: problem.stiffness(),
            moves: problem.start.clone(),
            positions: problem
                .deformation
                .apply(&problem.positions, &problem.start),
            facets: vec![Cell::new(u32::MAX); problem.observations.points.len()],
            apart: None,
            slope,
            scale: f64::INFINITY,
            damping: DAMPING,
            iteration: 0,
            is_cut: false,
            least_spread: 0.0,
            weights: [1.0, 1.0, 0.0],
            smooth: 0.0,
        }
    }

    fn field<'b>(&self, positions: &'b [DVec3], kind: Kind) -> Result<Field<'b>, Error>
    where
        'a: 'b,
    {
        Field::new(positions, &self.problem.triangles, kind, self.slope)
    }

    /// Fits and judges the result.
    fn end(mut self, tell: &mut Tell<'_>) -> Result<Fitted, Error> {
        let stopped = !self.all(tell)?;
        let failure = if stopped { None } else { self.judge()? };
        let last = self.progress()?;
        let points = self.problem.observations.points.len();
        let numbered = self.apart()?.iter().take(points).zip(0..);
        let left_out = numbered.filter(|(d, _)| **d > 3.0 * last.residual);
        let left_out = left_out.map(|(_, i)| i).collect();
        Ok(Fitted {
            rigid: self.rigid,
            left_out,
            positions: self.positions,
            last,
            smooth: self.smooth,
            moves: self.moves,
            stopped,
            failure,
        })
    }

    /// Fits the facets, then the surface that stands for them. Returns whether it came to the end.
    fn all(&mut self, tell: &mut Tell<'_>) -> Result<bool, Error> {
        let kind = self.options.kind;
        if self.options.loss == Loss::Algebraic && kind != Kind::Explicit {
            return self.rise(tell);
        }
        if !self.stage(Kind::Explicit, 0.0, WIDE, tell)? {
            return Ok(false);
        }
        if kind == Kind::Explicit {
            return Ok(true);
        }
        self.heights = self.heights()?;
        let distances = self.distances()?;
        let spread = self.spread(&distances);
        let distances = self.apart()?.iter();
        let left_out = distances.map(|d| *d > NARROW * spread).collect();
        if kind == Kind::Spherical {
            self.left_out = left_out;
            return self.stage(kind, 1.0, NARROW, tell);
        }
        self.rise = 1.0;
        // A thin shell is on the points with both its sheets.
        if self.heights.iter().any(|height| *height > spread) {
            self.left_out = left_out;
            if !self.stage(Kind::Explicit, -1.0, NARROW, tell)? {
                return Ok(false);
            }
            self.left_out.clear();
        }
        self.stage(kind, 0.0, NARROW, tell)
    }

    /// Fits the implicit surface by its field, with a slope that rises from where the field reaches
    /// the observations. Returns whether it came to the end.
    fn rise(&mut self, tell: &mut Tell<'_>) -> Result<bool, Error> {
        let last = self.slope;
        let start = self.distances()?;
        self.kind = self.options.kind;
        self.slope = (REACH / self.spread(&start)).min(last);
        for _ in 0..MOST_LEVELS {
            // Far from all facets the residual is that of F = 0.
            self.scale = 1.0 / self.slope;
            let is_coarse = self.slope < last;
            if !self.level(is_coarse, tell)? {
                return Ok(false);
            }
            if !is_coarse {
                break;
            }
            self.slope = (2.0 * self.slope).min(last);
        }
        Ok(true)
    }

    /// Fits one surface, coarse to fine. Returns whether to go on.
    fn stage(
        &mut self,
        kind: Kind,
        shift: f64,
        spreads: f64,
        tell: &mut Tell<'_>,
    ) -> Result<bool, Error> {
        (self.kind, self.shift, self.apart) = (kind, shift, None);
        let mut begun = (self.positions.clone(), self.moves.clone());
        let start = self.distances()?;
        let size = Aabb::of_points(self.positions.iter().copied())
            .size()
            .length();
        self.scale = (spreads * self.spread(&start)).clamp(LEAST_SCALE * size, size);
        for level in 0..MOST_LEVELS {
            let distances = self.distances()?;
            let least = (NARROW * self.spread(&distances)).max(LEAST_SCALE * size);
            let is_coarse = level == 0 || self.scale > 1.01 * least;
            if !self.level(is_coarse, tell)? {
                return Ok(false);
            }
            let distances = self.distances()?;
            let least = (NARROW * self.spread(&distances)).max(LEAST_SCALE * size);
            if self.options.loss != Loss::Saturating || (!is_coarse && self.scale <= 1.01 * least) {
                break;
            }
            self.scale = (0.5 * self.scale).max(least).min(self.scale);
        }
        // A surface that leads away from where the facets were is left.
        if spreads == NARROW && mean_of_half(&self.distances()?) > 1.1 * mean_of_half(&start) {
            self.exchange(&mut begun);
        }
        Ok(true)
    }

    /// Returns the mean height of the surface's outer sheet over the facets around each vertex; 0
    /// if they do not agree on what is outside.
    fn heights(&self) -> Result<Vec<f64>, Error> {
        let facets = &self.problem.triangles;
        if !face_alike(facets) {
            return Ok(vec![0.0; self.positions.len()]);
        }
        let mut sums = vec![(0.0, 0.0); self.positions.len()];
        let field = self.field(&self.positions, self.options.kind)?;
        // Shells are as high everywhere.
        let samples: &[[f64; 2]] = match self.options.kind {
            Kind::Spherical => &[[1.0 / 3.0; 2], [0.6, 0.2], [0.2, 0.6], [0.2, 0.2]],
            _ => &[[1.0 / 3.0; 2]],
        };
        let mut gradient = Gradient::new();
        for (facet, corners) in facets.iter().enumerate() {
            let [a, b, c] = field.corners(facet as u32);
            let normal = field.normal(facet as u32);
            for [u, v] in samples {
                let base = a + (b - a) * *u + (c - a) * *v;
                // The distance changes no faster than the height, so that this does not go too far.
                let mut height = 0.0;
                for _ in 0..RISING {
                    let distance = field.distance(base + normal * height, &mut gradient);
                    if distance.is_finite() {
                        height -= distance;
                    }
                }
                for vertex in corners {
                    let (sum, count) = &mut sums[*vertex as usize];
                    (*sum, *count) = (*sum + height, *count + 1.0);
                }
            }
        }
        Ok(sums
            .iter()
            .map(|(sum, count)| sum / f64::max(*count, 1.0))
            .collect())
    }

    /// Returns the height over a facet at the place nearest to a point.
    fn height(&self, field: &Field<'_>, facet: u32, point: DVec3) -> f64 {
        let weights = nearest(&field.corners(facet), point).weights;
        let corners = self.problem.triangles[facet as usize].into_iter();
        corners
            .zip(weights)
            .map(|(vertex, weight)| self.heights[vertex as usize] * weight)
            .sum()
    }

    /// The places of the observations: where lines of sight should touch the surface is found anew.
    fn places(&self, field: &Field<'_>, shift: f64, has_sights: bool) -> Result<Vec<Place>, Error> {
        let observations = &self.problem.observations;
        let left_out = self.left_out.iter().chain(core::iter::repeat(&false));
        let points = observations.points.iter().zip(left_out);
        let mut places: Vec<Place> = points
            .map(|(p, out)| (*p, if *out { LEFT_OUT } else { 0 }))
            .collect();
        if has_sights && self.options.outlines > 0.0 && !observations.sights.is_empty() {
            let corners = (0..self.problem.triangles.len() as u32).map(|i| field.corners(i));
            let boxes: Vec<Aabb> = corners.map(Aabb::of_points).collect();
            let bvh = Bvh::new(&boxes);
            let touches = observations
                .sights
                .iter()
                .filter_map(|s| s.touch(field, &bvh));
            places.extend(touches.map(|place| (place, 1)));
        }
        if shift != 0.0 {
            let facets = self.field(field.positions, Kind::Explicit)?;
            let none = Cell::new(u32::MAX);
            for (i, (place, _)) in places.iter_mut().enumerate() {
                let known = self.facets.get(i).unwrap_or(&none);
                if let Some((facet, _)) = facets.nearest(*place, known) {
                    let height = self.height(&facets, facet, *place);
                    *place += facets.normal(facet) * (shift * height);
                }
                none.set(u32::MAX);
            }
        }
        Ok(places)
    }

    /// The distance of an observation by its number and place: see [`Field::distance`].
    fn distance(&self, field: &Field<'_>, i: usize, place: DVec3, gradient: &mut Gradient) -> f64 {
        match self.facets.get(i) {
            Some(facet) => field.distance_near(place, facet, gradient),
            None => field.distance(place, gradient),
        }
    }

    /// Computes the distances of the points, or of the outlines if there are none, from where they
    /// are to be: from the surface of balls, else from the height over the facets at which the
    /// surface's outer sheet lies. Of a thin shell the distance from its surface would be that of
    /// the nearer of two sheets.
    fn apart(&mut self) -> Result<&[f64], Error> {
        if self.apart.is_none() {
            self.apart = Some(self.measure()?);
        }
        Ok(self.apart.as_deref().unwrap_or_default())
    }

    fn measure(&self) -> Result<Vec<f64>, Error> {
        let is_round = self.kind == Kind::Spherical;
        let kind = if is_round { self.kind } else { Kind::Explicit };
        let field = self.field(&self.positions, kind)?;
        let shift = if is_round { self.shift } else { 0.0 };
        let has_points = !self.facets.is_empty();
        let places = self.places(&field, shift, !has_points)?;
        let mut gradient = Gradient::new();
        let none = Cell::new(u32::MAX);
        let mut distances = Vec::with_capacity(places.len());
        for (i, (place, _)) in places.into_iter().enumerate() {
            let known = self.facets.get(i).unwrap_or(&none);
            distances.push(match field.nearest(place, known) {
                Some((facet, square)) if self.rise != 0.0 => {
                    let away = (place - field.corners(facet)[0]).dot(field.normal(facet));
                    let height = self.rise * self.height(&field, facet, place);
                    (square.sqrt().copysign(away) - height).abs()
                }
                Some((_, square)) => square.sqrt(),
                None => self.distance(&field, i, place, &mut gradient).abs(),
            });
            none.set(u32::MAX);
        }
        Ok(distances)
    }

    /// Returns the same distances, the least first.
    fn distances(&mut self) -> Result<Vec<f64>, Error> {
        let mut distances = self.apart()?.to_vec();
        distances.sort_by(f64::total_cmp);
        Ok(distances)
    }

    /// Returns why the present state cannot be relied on, if it cannot; goes back to the start if
    /// that was better.
    fn judge(&mut self) -> Result<Option<String>, Error> {
        let end = self.distances()?;
        let own = &self.problem.positions;
        let begun = self.problem.start.clone();
        let mut other = (self.problem.deformation.apply(own, &begun), begun);
        let size = Aabb::of_points(other.0.iter().copied()).size().length();
        self.exchange(&mut other);
        let start = self.distances()?;
        let [before, after] = [&start, &end].map(|distances| mean_of_half(distances));
        if after.is_nan() || after > 1.1 * before + 1e-6 * size {
            return Ok(Some(format!(
                "the nearer half of the measurements was {before:.3e} away at the start, and \
                 {after:.3e} at the end"
            )));
        }
        self.exchange(&mut other);
        let spread = self.spread(&end);
        let near = end.partition_point(|d| *d <= NARROW * spread);
        let share = 1.0 - near as f64 / end.len().max(1) as f64;
        if share > MOST_LEFT_OUT {
            return Ok(Some(format!(
                "{:.0} % of the measurements are left out, and others may be right",
                100.0 * share
            )));
        }
        if self.is_cut && spread > 1e-3 * size {
            return Ok(Some(format!(
                "it has not settled within {} iterations",
                self.options.iterations
            )));
        }
        let noise = noise(&self.problem.observations.points);
        // Points that are of no surface tell a noise of any size.
        let limit = (ROUGHLY * noise).max(0.01 * size).min(0.02 * size);
        if spread > limit {
            return Ok(Some(format!(
                "the nearer measurements are {spread:.3e} away from the surface, {:.1} % of the \
                 mesh's size, and {noise:.3e} from planes through their neighbours: the start may \
                 be too far off, the control points too few, or too many measurements wrong",
                100.0 * spread / size
            )));
        }
        Ok(None)
    }

    /// Returns the spread of sorted distances, as far as it is believed.
    fn spread(&self, sorted: &[f64]) -> f64 {
        spread(sorted).max(self.least_spread)
    }

    /// Exchanges the positions and moves for others.
    fn exchange(&mut self, other: &mut (Vec<DVec3>, Vec<DVec3>)) {
        core::mem::swap(&mut self.positions, &mut other.0);
        core::mem::swap(&mut self.moves, &mut other.1);
        self.apart = None;
    }

    fn progress(&mut self) -> Result<Progress, Error> {
        let distances = self.distances()?;
        let limit = NARROW * self.spread(&distances);
        let near = distances.partition_point(|d| *d <= limit);
        let squares: f64 = distances[..near].iter().map(|d| d * d).sum();
        let residual = (squares / near.max(1) as f64).sqrt();
        let far = distances.len() - distances.partition_point(|d| *d <= 3.0 * residual);
        Ok(Progress {
            iteration: self.iteration,
            residual,
            outliers: far as f64 / distances.len().max(1) as f64,
            scale: self.scale,
            rigid: self.rigid,
            moves: self.moves.clone(),
        })
    }

    /// Iterates with one scale, the last one or one on the way. Returns whether to go on.
    fn level(&mut self, is_coarse: bool, tell: &mut Tell<'_>) -> Result<bool, Error> {
        self.damping = DAMPING;
        let (most, settled) = match (self.options.loss, is_coarse) {
            (Loss::Squares, _) => (self.options.iterations, SETTLED),
            (_, false) => (PER_LEVEL, SETTLED),
            (_, true) => (PER_COARSE_LEVEL, SETTLED_COARSE),
        };
        for turn in 0..most {
            if self.iteration >= self.options.iterations {
                self.is_cut = self.options.loss == Loss::Saturating;
                return Ok(true);
            }
            let field = self.field(&self.positions, self.kind)?;
            let places = self.places(&field, self.shift, true)?;
            if turn == 0 {
                (self.weights, self.smooth) = self.balance(&field, &places);
            }
            let (normal, before) = self.equations(&field, &places);
            let decrease = self.step(&normal, before, &places)?;
            self.iteration += 1;
            if !tell(&self.progress()?) {
                return Ok(false);
            }
            if decrease <= settled * before {
                break;
            }
        }
        Ok(true)
    }

    /// Weights that make the classes, and the smoothness, count as the options say: by the sums of
    /// the squares of their derivatives.
    fn balance(&self, field: &Field<'_>, places: &[Place]) -> ([f64; 3], f64) {
        let mut sums = [0.0; 3];
        let mut row = Row::new(self.moves.len());
        for (i, (place, class)) in places.iter().enumerate() {
            if *class == LEFT_OUT {
                continue;
            }
            if let Some((_, factor)) = self.residual(field, i, *place, &mut row) {
                let square: f64 = row
                    .entries
                    .iter()
                    .map(|(_, way)| way.length_squared())
                    .sum();
                sums[*class] += factor * factor * square;
            }
        }
        let [points, outlines, _] = sums;
        let weights = if points > 0.0 && outlines > 0.0 {
            [1.0, self.options.outlines * points / outlines, 0.0]
        } else {
            [1.0, 1.0, 0.0]
        };
        let all = weights[0] * points + weights[1] * outlines;
        let diagonal = self.stiffness.iter().filter(|(i, j, _)| i == j);
        let stiff: f64 = 3.0 * diagonal.map(|(.., value)| value).sum::<f64>();
        let smooth = if stiff > 0.0 {
            self.options.smooth * all / stiff
        } else {
            0.0
        };
        (weights, smooth)
    }

    /// Sets the derivative of an observation's distance by the moves. Returns its residual and the
    /// factor between the residual's derivative and the distance's; `None` if nothing acts there.
    fn residual(
        &self,
        field: &Field<'_>,
        i: usize,
        place: DVec3,
        row: &mut Row,
    ) -> Option<(f64, f64)> {
        let distance = self.distance(field, i, place, &mut row.gradient);
        if !distance.is_finite() {
            return None;
        }
        row.chain(self.problem);
        Some(self.weigh(distance))
    }

    /// Returns the residual of a distance h, a length, and its derivative: see [`Loss`].
    fn weigh(&self, distance: f64) -> (f64, f64) {
        match self.options.loss {
            Loss::Saturating => {
                let share = libm::tanh(distance / self.scale);
                (self.scale * share, 1.0 - share * share)
            }
            Loss::Algebraic if self.kind != Kind::Explicit => {
                let field = libm::exp(-self.slope * distance);
                ((1.0 - field) / self.slope, field)
            }
            Loss::Squares | Loss::Algebraic => (distance, 1.0),
        }
    }

    /// The equations at the present moves, and the sum that is to fall.
    fn equations(&self, field: &Field<'_>, places: &[Place]) -> (Normal, f64) {
        let size = 3 * self.moves.len();
        let mut normal = match self.problem.by {
            Controls::Vertices => Normal::sparse(size),
            Controls::Cage(_) | Controls::Lattice(_) => Normal::dense(size),
        };
        let mut row = Row::new(self.moves.len());
        let mut sum = 0.0;
        for (i, (place, class)) in places.iter().enumerate() {
            let weight = self.weights[*class];
            if weight == 0.0 {
                continue;
            }
            let Some((residual, factor)) = self.residual(field, i, *place, &mut row) else {
                sum += 0.5 * weight * self.scale * self.scale;
                continue;
            };
            sum += 0.5 * weight * residual * residual;
            row.entries.iter_mut().for_each(|(_, way)| *way *= factor);
            normal.add(residual, &row.entries, weight);
        }
        for (i, j, value) in &self.stiffness {
            let value = value * self.smooth;
            normal.add_alike(*i, *j, value);
            for (to, from) in [(*i, *j), (*j, *i)].iter().take(if i == j { 1 } else { 2 }) {
                for axis in 0..3 {
                    normal.gradient[3 * *to as usize + axis] +=
                        value * self.moves[*from as usize][axis];
                }
            }
        }
        (
            normal,
            sum + self.smooth * energy(&self.stiffness, &self.moves),
        )
    }

    /// The sum at some moves, and each observation's distance.
    fn sum(
        &self,
        moves: &[DVec3],
        positions: &[DVec3],
        places: &[Place],
    ) -> Result<(f64, Vec<f64>), Error> {
        let field = self.field(positions, self.kind)?;
        let mut gradient = Gradient::new();
        let numbered = places.iter().enumerate();
        let distances: Vec<f64> = numbered
            .map(|(i, (place, _))| self.distance(&field, i, *place, &mut gradient))
            .collect();
        let sum: f64 = places
            .iter()
            .zip(&distances)
            .map(|((_, class), distance)| {
                let distance = *distance;
                let residual = if distance.is_finite() {
                    self.weigh(distance).0
                } else {
                    self.scale
                };
                0.5 * self.weights[*class] * residual.powi(2)
            })
            .sum();
        Ok((
            sum + self.smooth * energy(&self.stiffness, moves),
            distances,
        ))
    }

    /// Moves the controls to where the sum is less. Returns by how much, 0 if there is no such
    /// place.
    ///
    /// The damping falls by how well the equations foretold the new sum, and grows twice as quickly
    /// with each failure (Nielsen 1999).
    fn step(&mut self, normal: &Normal, before: f64, places: &[Place]) -> Result<f64, Error> {
        let mut growth = 2.0;
        for _ in 0..MOST_TRIES {
            if let Some(way) = normal.solve(self.damping) {
                let moved = self.moves.iter().zip(way.chunks_exact(3));
                let moves: Vec<DVec3> = moved.map(|(m, way)| *m + DVec3::from_slice(way)).collect();
                let positions = self
                    .problem
                    .deformation
                    .apply(&self.problem.positions, &moves);
                let (after, mut distances) = self.sum(&moves, &positions, places)?;
                if after < before {
                    (self.moves, self.positions) = (moves, positions);
                    // Lines of sight touch elsewhere now.
                    let is_told =
                        self.kind == Kind::Explicit && self.shift == 0.0 && !self.facets.is_empty();
                    distances.truncate(self.facets.len());
                    self.apart = is_told.then_some(distances);
                    let foretold = normal.decrease(&way);
                    let miss = 2.0 * (before - after) / foretold - 1.0;
                    let fall = (1.0 - miss.powi(3)).clamp(0.1, 2.0);
                    self.damping = (self.damping * fall).max(LEAST_DAMPING);
                    return Ok(before - after);
                }
            }
            self.damping *= growth;
            growth *= 2.0;
        }
        Ok(0.0)
    }
}

/// Row of derivatives by the control points.
struct Row {
    gradient: Gradient,
    entries: Vec<(u32, DVec3)>,
    /// Number of each control's entry, from 1; 0 for none.
    places: Vec<u32>,
}

impl Row {
    fn new(controls: usize) -> Self {
        Self {
            gradient: Vec::new(),
            entries: Vec::new(),
            places: vec![0; controls],
        }
    }

    /// Computes the derivatives by control points from those by vertices (the chain rule).
    fn chain(&mut self, problem: &Problem) {
        self.entries.clear();
        for (vertex, way) in &self.gradient {
            for (control, weight) in problem.deformation.weights(*vertex as usize) {
                let place = &mut self.places[*control as usize];
                if *place == 0 {
                    self.entries.push((*control, DVec3::ZERO));
                    *place = self.entries.len() as u32;
                }
                self.entries[*place as usize - 1].1 += *way * *weight;
            }
        }
        for (control, _) in &self.entries {
            self.places[*control as usize] = 0;
        }
        self.entries.sort_unstable_by_key(|(control, _)| *control);
    }
}

/// Whether no two triangles pass an edge in the same direction.
fn face_alike(triangles: &[[u32; 3]]) -> bool {
    let ways = triangles
        .iter()
        .flat_map(|[a, b, c]| [(a, b), (b, c), (c, a)]);
    let mut ways: Vec<_> = ways.collect();
    ways.sort_unstable();
    ways.windows(2).all(|pair| pair[0] != pair[1])
}

/// Returns the mean of the least half of sorted distances.
fn mean_of_half(sorted: &[f64]) -> f64 {
    let near = &sorted[..sorted.len().div_ceil(2)];
    near.iter().sum::<f64>() / near.len().max(1) as f64
}

/// Returns the standard deviation of the nearer ones of sorted distances: from the median of those
/// within three of it, so that the others do not count.
fn spread(sorted: &[f64]) -> f64 {
    let (mut near, mut spread) = (sorted, f64::INFINITY);
    // The number falls each time.
    loop {
        spread = spread.min(1.4826 * quantile(near, 0.5));
        let count = near.partition_point(|d| *d <= 3.0 * spread);
        if count == near.len() {
            return spread;
        }
        near = &near[..count];
    }
}

/// Returns a quantile of sorted numbers; 0 without any.
fn quantile(sorted: &[f64], share: f64) -> f64 {
    let last = sorted.len().saturating_sub(1);
    sorted
        .get((share * last as f64) as usize)
        .copied()
        .unwrap_or(0.0)
}
