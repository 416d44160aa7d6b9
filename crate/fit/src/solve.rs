//! Levenberg and Marquardt's method on the control points' moves.
//!
//! The residual of an observation is `w·s·tanh(h/s)` with the distance h of [`Field::distance`]: a
//! length that does not grow beyond s, so that outliers pull little. s falls in steps from the
//! mesh's distance at the start to three times the spread of the observations, and the implicit
//! surface's k rises with it to its last value: coarse to fine.

use crate::align::{Rigid, align};
use crate::deformation::Deformation;
use crate::error::Error;
use crate::field::{Field, Gradient, Kind};
use crate::normal::Normal;
use crate::problem::{Options, Problem};
use crate::stiffness::energy;
use core::cell::Cell;
use glam::DVec3;
use mesh::{Aabb, Bvh};

/// Most iterations of a level.
const PER_LEVEL: usize = 12;
/// Most levels.
const MOST_LEVELS: usize = 12;
/// Relative decrease of the sum below which a level is done.
const SETTLED: f64 = 1e-4;
/// Steps tried from one place, each more damped.
const MOST_TRIES: usize = 8;
/// The damping at the start of a level, and the least.
const DAMPING: f64 = 1e-3;
const LEAST_DAMPING: f64 = 1e-7;
/// The distance that the implicit surface's field reaches, in s.
const REACH: f64 = 8.0;

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
}

/// Fits a mesh. `tell` is called after each iteration, and says whether to go on.
///
/// # Errors
/// If the implicit surface cannot be made.
pub fn fit(problem: &Problem, tell: &mut dyn FnMut(&Progress) -> bool) -> Result<Fitted, Error> {
    let mut problem = problem.clone();
    let rigid = if problem.options.align {
        align(
            &problem.positions,
            &problem.triangles,
            &problem.observations.points,
        )
    } else {
        Rigid::IDENTITY
    };
    if rigid != Rigid::IDENTITY {
        for place in problem.positions.iter_mut().chain(&mut problem.controls) {
            *place = rigid.apply(*place);
        }
        // The far corners are those of the turned mesh, as where the moves are carried out.
        problem.deformation = Deformation::new(&problem.positions, &problem.controls)?;
    }
    let mut run = Run::new(&problem, rigid);
    let stopped = !run.all(tell)?;
    Ok(Fitted {
        rigid,
        positions: run.positions.clone(),
        last: run.progress()?,
        smooth: run.smooth,
        moves: run.moves,
        stopped,
    })
}

/// An observation for one iteration: a place, and its class.
type Place = (DVec3, usize);

struct Run<'a> {
    problem: &'a Problem,
    rigid: Rigid,
    options: Options,
    stiffness: Vec<(u32, u32, f64)>,
    moves: Vec<DVec3>,
    positions: Vec<DVec3>,
    /// Facet that was last found nearest to each point.
    facets: Vec<Cell<u32>>,
    /// Distance of each point from the nearest facet at the present positions, if the last sum has
    /// left these.
    apart: Option<Vec<f64>>,
    /// k at the end.
    slope: f64,
    scale: f64,
    damping: f64,
    iteration: usize,
    /// Weights of points and outlines.
    weights: [f64; 2],
    /// Weight of the smoothness.
    smooth: f64,
}

impl<'a> Run<'a> {
    fn new(problem: &'a Problem, rigid: Rigid) -> Self {
        let options = problem.options;
        Self {
            problem,
            rigid,
            options,
            stiffness: problem.stiffness(),
            moves: problem.start.clone(),
            positions: problem
                .deformation
                .apply(&problem.positions, &problem.start),
            facets: vec![Cell::new(u32::MAX); problem.observations.points.len()],
            apart: None,
            slope: options.slope.unwrap_or(20.0 / problem.mean_edge()),
            scale: f64::INFINITY,
            damping: DAMPING,
            iteration: 0,
            weights: [1.0; 2],
            smooth: 0.0,
        }
    }

    /// k at the present scale.
    fn sharpness(&self) -> f64 {
        self.slope.min(REACH / self.scale)
    }

    fn field<'b>(&self, positions: &'b [DVec3]) -> Result<Field<'b>, Error>
    where
        'a: 'b,
    {
        Field::new(
            positions,
            &self.problem.triangles,
            self.options.kind,
            self.sharpness(),
        )
    }

    /// Runs all levels, coarse to fine. Returns whether it came to the end.
    fn all(&mut self, tell: &mut dyn FnMut(&Progress) -> bool) -> Result<bool, Error> {
        let apart = self.distances()?;
        let size = Aabb::of_points(self.positions.iter().copied())
            .size()
            .length();
        // Nine of ten are within it.
        self.scale = quantile(&apart, 0.9).clamp(1e-9 * size, size);
        for _ in 0..MOST_LEVELS {
            if !self.level(tell)? {
                return Ok(false);
            }
            if !self.has_scale() {
                break;
            }
            let spread = 1.4826 * quantile(&self.distances()?, 0.5);
            let least = (3.0 * spread).max(1e-9 * size);
            if self.scale <= least * 1.01 {
                break;
            }
            self.scale = (0.5 * self.scale).max(least);
        }
        Ok(true)
    }

    /// Whether the scale changes what is summed: distances that saturate, or an implicit surface
    /// that sharpens with it.
    fn has_scale(&self) -> bool {
        self.options.saturates || self.options.kind != Kind::Explicit
    }

    /// The places of the observations: where lines of sight should touch the surface is found anew.
    fn places(&self, field: &Field<'_>) -> Vec<Place> {
        let observations = &self.problem.observations;
        let mut places: Vec<Place> = observations.points.iter().map(|p| (*p, 0)).collect();
        if self.options.outlines > 0.0 && !observations.sights.is_empty() {
            let corners = (0..self.problem.triangles.len() as u32).map(|i| field.corners(i));
            let boxes: Vec<Aabb> = corners.map(Aabb::of_points).collect();
            let bvh = Bvh::new(&boxes);
            let touches = observations
                .sights
                .iter()
                .filter_map(|s| s.touch(field, &bvh));
            places.extend(touches.map(|place| (place, 1)));
        }
        places
    }

    /// The distance of an observation by its number and place: see [`Field::distance`].
    fn distance(&self, field: &Field<'_>, i: usize, place: DVec3, gradient: &mut Gradient) -> f64 {
        match self.facets.get(i) {
            Some(facet) => field.distance_near(place, facet, gradient),
            None => field.distance(place, gradient),
        }
    }

    /// Distances of all observations from the nearest facets of the present mesh, the least first.
    fn distances(&self) -> Result<Vec<f64>, Error> {
        let mut distances = if let Some(apart) = &self.apart {
            apart.clone()
        } else {
            let (facets, kind) = (&self.problem.triangles, Kind::Explicit);
            let field = Field::new(&self.positions, facets, kind, self.slope)?;
            let mut gradient = Gradient::new();
            let places = self.places(&field);
            let numbered = places.iter().enumerate();
            numbered
                .map(|(i, (place, _))| self.distance(&field, i, *place, &mut gradient))
                .collect()
        };
        distances.sort_by(f64::total_cmp);
        Ok(distances)
    }

    fn progress(&self) -> Result<Progress, Error> {
        let distances = self.distances()?;
        let spread = 1.4826 * quantile(&distances, 0.5);
        let near = distances.partition_point(|d| *d <= 3.0 * spread);
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

    /// Iterates with one scale. Returns whether to go on.
    fn level(&mut self, tell: &mut dyn FnMut(&Progress) -> bool) -> Result<bool, Error> {
        self.damping = DAMPING;
        let most = if self.has_scale() {
            PER_LEVEL
        } else {
            self.options.iterations
        };
        for turn in 0..most {
            if self.iteration >= self.options.iterations {
                return Ok(true);
            }
            let field = self.field(&self.positions)?;
            let places = self.places(&field);
            if turn == 0 {
                (self.weights, self.smooth) = self.balance(&field, &places);
            }
            let (normal, before) = self.equations(&field, &places);
            let settled = self.step(&normal, before, &places)?;
            self.iteration += 1;
            if !tell(&self.progress()?) {
                return Ok(false);
            }
            if settled {
                break;
            }
        }
        Ok(true)
    }

    /// Weights that make the classes, and the smoothness, count as the options say: by the sums of
    /// the squares of their derivatives.
    fn balance(&self, field: &Field<'_>, places: &[Place]) -> ([f64; 2], f64) {
        let mut sums = [0.0; 2];
        let mut row = Row::new(self.moves.len());
        for (i, (place, class)) in places.iter().enumerate() {
            if let Some((_, factor)) = self.residual(field, i, *place, &mut row) {
                let square: f64 = row
                    .entries
                    .iter()
                    .map(|(_, way)| way.length_squared())
                    .sum();
                sums[*class] += factor * factor * square;
            }
        }
        let [points, outlines] = sums;
        let weights = if points > 0.0 && outlines > 0.0 {
            [1.0, self.options.outlines * points / outlines]
        } else {
            [1.0; 2]
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
        Some(self.saturate(distance))
    }

    /// Returns the residual s·tanh(h/s) of a distance h, and its derivative.
    fn saturate(&self, distance: f64) -> (f64, f64) {
        if !self.options.saturates {
            return (distance, 1.0);
        }
        let share = libm::tanh(distance / self.scale);
        (self.scale * share, 1.0 - share * share)
    }

    /// The equations at the present moves, and the sum that is to fall.
    fn equations(&self, field: &Field<'_>, places: &[Place]) -> (Normal, f64) {
        let mut normal = Normal::new(3 * self.moves.len());
        let mut row = Row::new(self.moves.len());
        let mut sum = 0.0;
        for (i, (place, class)) in places.iter().enumerate() {
            let weight = self.weights[*class];
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
        let field = self.field(positions)?;
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
                    self.saturate(distance).0
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

    /// Moves the controls to where the sum is less. Returns whether it has settled.
    ///
    /// The damping falls by how well the equations foretold the new sum, and grows twice as quickly
    /// with each failure (Nielsen 1999).
    fn step(&mut self, normal: &Normal, before: f64, places: &[Place]) -> Result<bool, Error> {
        let mut growth = 2.0;
        for _ in 0..MOST_TRIES {
            if let Some(way) = normal.solve(self.damping) {
                let moved = self.moves.iter().zip(way.chunks_exact(3));
                let moves: Vec<DVec3> = moved.map(|(m, way)| *m + DVec3::from_slice(way)).collect();
                let positions = self
                    .problem
                    .deformation
                    .apply(&self.problem.positions, &moves);
                let (after, distances) = self.sum(&moves, &positions, places)?;
                if after < before {
                    (self.moves, self.positions) = (moves, positions);
                    // Where lines of sight touch, and what is fitted to, may be other than what is
                    // told.
                    let is_told =
                        self.options.kind == Kind::Explicit && distances.len() == self.facets.len();
                    self.apart = is_told.then_some(distances);
                    let foretold = normal.decrease(&way);
                    let miss = 2.0 * (before - after) / foretold - 1.0;
                    let fall = (1.0 - miss.powi(3)).clamp(0.1, 2.0);
                    self.damping = (self.damping * fall).max(LEAST_DAMPING);
                    return Ok(before - after <= SETTLED * before);
                }
            }
            self.damping *= growth;
            growth *= 2.0;
        }
        Ok(true)
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

/// Returns a quantile of sorted numbers; 0 without any.
fn quantile(sorted: &[f64], share: f64) -> f64 {
    let last = sorted.len().saturating_sub(1);
    sorted
        .get((share * last as f64) as usize)
        .copied()
        .unwrap_or(0.0)
}
