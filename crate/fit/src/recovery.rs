//! The trial that tells how well a known shape is found again: a head, or another shape, deformed,
//! measured with noise, outliers, a gap and outlines, and fitted in several ways.

use crate::align::Rigid;
use crate::disturb::Disturbance;
use crate::error::Error;
use crate::field::{Field, Gradient, Kind};
use crate::outlines::{Outline, sights};
use crate::problem::{Controls, Loss, Observations, Options, Problem, mean_edge};
use crate::trial;
use crate::{Deformation, Fitted, fit};
use glam::DVec3;
use mesh::{Aabb, Bvh, HalfEdgeMesh, Ray, TriangleMesh, closest_point, simplify};

/// Standard deviation of each coordinate of the measured points; the head is 3.5 high.
pub const NOISE: f64 = 0.01;

/// Way to fit in a trial.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Way {
    /// Surface that stands for the mesh.
    pub kind: Kind,
    /// k times the mean edge.
    pub sharpness: f64,
    /// The way in which distances count.
    pub loss: Loss,
    /// Whether outlines are used beside the points.
    pub outlines: bool,
}

/// Result of a fit, in units of [`NOISE`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// Root of the mean square of the distances of the truth's points from the fitted mesh, away
    /// from the gap.
    pub mesh: f64,
    /// Root of the mean square of those distances in the gap.
    pub gap: f64,
    /// Root of the mean square of the distances from the surface that was fitted, away from the
    /// gap: the implicit one, `|ln F|/k`.
    pub surface: f64,
    /// Iterations.
    pub iterations: usize,
    /// Whether the fit itself says that it failed.
    pub failed: bool,
}

/// True shape with its measurements.
#[derive(Debug)]
pub struct Trial {
    cage: TriangleMesh,
    observations: Observations,
    /// Points of the truth, away from the gap and in it.
    probes: [Vec<DVec3>; 2],
}

impl Trial {
    /// Measures the head of `facets` triangles, deformed by its cage: `points` points before a
    /// quarter of them is left out, a share of outliers, six outlines.
    ///
    /// # Errors
    /// If there are too few facets.
    pub fn new(facets: usize, points: usize, outliers: f64) -> Result<Self, Error> {
        let head = trial::head(facets);
        let cage = trial::cage();
        let deformation = Deformation::new(&head.positions, &cage.positions)?;
        let moves = trial::moves(&cage.positions, 0.16, 11);
        let truth = TriangleMesh::new(
            deformation.apply(&head.positions, &moves),
            head.triangles.clone(),
        );
        let disturbance = Disturbance {
            noise: NOISE,
            outliers,
            gap: 0.25,
            seed: 8,
            ..Disturbance::default()
        };
        Ok(Self::of(&truth, cage, points, disturbance))
    }

    /// Measures a shape, which is to be found again by moving the vertices of a cage: `points`
    /// points before the gap, six outlines.
    #[must_use]
    pub fn of(
        truth: &TriangleMesh,
        cage: TriangleMesh,
        points: usize,
        disturbance: Disturbance,
    ) -> Self {
        let sampled = trial::sample(&truth.positions, &truth.triangles, points, 3);
        // The gap's border, along its direction.
        let toward = disturbance.toward();
        let mut along: Vec<f64> = sampled.iter().map(|p| p.dot(toward)).collect();
        along.sort_by(f64::total_cmp);
        let kept = along.len() as f64 * (1.0 - disturbance.gap);
        let border = along.get(kept as usize).copied().unwrap_or(f64::INFINITY);
        let probes = trial::sample(&truth.positions, &truth.triangles, 4000, 77);
        let (gap, near) = probes.into_iter().partition(|p| p.dot(toward) > border);
        Self {
            cage,
            observations: Observations {
                points: disturbance.apply(&sampled),
                sights: sights(&outlines(&Surface::new(truth))),
            },
            probes: [near, gap],
        }
    }

    /// Returns the trial with all that was measured turned and moved, and the truth with it.
    #[must_use]
    pub fn turn(mut self, rigid: &Rigid) -> Self {
        for sight in &mut self.observations.sights {
            sight.origin = rigid.apply(sight.origin);
            sight.direction = rigid.turn * sight.direction;
        }
        let [near, gap] = &mut self.probes;
        for place in near
            .iter_mut()
            .chain(gap)
            .chain(&mut self.observations.points)
        {
            *place = rigid.apply(*place);
        }
        self
    }

    /// Numbers of control points, points and lines of sight.
    #[must_use]
    pub fn counts(&self) -> [usize; 3] {
        [
            self.cage.positions.len(),
            self.observations.points.len(),
            self.observations.sights.len(),
        ]
    }

    /// The measured points.
    #[must_use]
    pub fn points(&self) -> &[DVec3] {
        &self.observations.points
    }

    /// Computes the errors of a mesh that is not fitted, away from the gap and in it.
    #[must_use]
    pub fn start(&self, model: &TriangleMesh) -> [f64; 2] {
        let surface = Surface::new(model);
        [0, 1].map(|i| root_mean_square(&self.probes[i], |p| surface.distance(p)) / NOISE)
    }

    /// Makes the problem of a fit.
    ///
    /// # Errors
    /// Fails as [`Problem::new`] does.
    pub fn problem(&self, model: &TriangleMesh, way: Way) -> Result<Problem, Error> {
        let edge = mean_edge(&model.positions, &model.triangles);
        let options = Options {
            kind: way.kind,
            slope: Some(way.sharpness / edge),
            loss: way.loss,
            ..Options::default()
        };
        let observations = self.observe(true, way.outlines);
        Problem::new(model, &self.cage, observations, options)
    }

    /// The points, or the outlines, or both.
    fn observe(&self, points: bool, outlines: bool) -> Observations {
        let mut observations = self.observations.clone();
        if !points {
            observations.points.clear();
        }
        if !outlines {
            observations.sights.clear();
        }
        observations
    }

    /// Fits a mesh and measures the result.
    ///
    /// # Errors
    /// Fails as [`Problem::new`] and [`fit()`] do.
    pub fn run(&self, model: &TriangleMesh, way: Way) -> Result<Outcome, Error> {
        let fitted = fit(&self.problem(model, way)?, &mut |_| true)?;
        let slope = way.sharpness / mean_edge(&model.positions, &model.triangles);
        self.measure(&fitted, &model.triangles, way.kind, slope)
    }

    /// Fits a mesh with other options than those of a [`Way`], to the points, the outlines or both,
    /// and measures the result.
    ///
    /// # Errors
    /// Fails as [`Problem::new`] and [`fit()`] do.
    pub fn run_with(
        &self,
        model: &TriangleMesh,
        options: Options,
        data: [bool; 2],
    ) -> Result<(Fitted, Outcome), Error> {
        self.run_by(model, Controls::Cage(self.cage.clone()), options, data)
    }

    /// Fits a mesh as [`Self::run_with`] does, with its vertices moved in any of the ways.
    ///
    /// # Errors
    /// Fails as [`Problem::with`] and [`fit()`] do.
    pub fn run_by(
        &self,
        model: &TriangleMesh,
        by: Controls,
        options: Options,
        [points, outlines]: [bool; 2],
    ) -> Result<(Fitted, Outcome), Error> {
        let observations = self.observe(points, outlines);
        let problem = Problem::with(model, by, observations, options)?;
        let fitted = fit(&problem, &mut |_| true)?;
        let slope = options.slope.unwrap_or(20.0 / problem.mean_edge());
        let outcome = self.measure(&fitted, &model.triangles, options.kind, slope)?;
        Ok((fitted, outcome))
    }

    fn measure(
        &self,
        fitted: &Fitted,
        triangles: &[[u32; 3]],
        kind: Kind,
        slope: f64,
    ) -> Result<Outcome, Error> {
        let mesh = TriangleMesh::new(fitted.positions.clone(), triangles.to_vec());
        let [near, gap] = self.start(&mesh);
        let field = Field::new(&mesh.positions, &mesh.triangles, kind, slope)?;
        let mut gradient = Gradient::new();
        // Where no facet acts the surface is further away than that.
        let surface = root_mean_square(&self.probes[0], |p| {
            field.distance(p, &mut gradient).min(1.0)
        }) / NOISE;
        Ok(Outcome {
            mesh: near,
            gap,
            surface,
            iterations: fitted.last.iteration,
            failed: fitted.failure.is_some(),
        })
    }
}

/// The head as a coarse mesh of uneven facets.
///
/// # Errors
/// If the head is no manifold, which it is.
pub fn coarse(facets: usize) -> Result<TriangleMesh, Error> {
    let mut polygons = HalfEdgeMesh::from_triangles(&trial::head(4000))
        .map_err(|error| Error(error.to_string()))?;
    simplify(&mut polygons, facets);
    polygons
        .to_triangles()
        .map_err(|error| Error(format!("{error:?}")))
}

fn root_mean_square(points: &[DVec3], mut value: impl FnMut(DVec3) -> f64) -> f64 {
    let sum: f64 = points.iter().map(|p| value(*p).powi(2)).sum();
    (sum / points.len().max(1) as f64).sqrt()
}

/// Returns six outlines of the truth, seen from around.
fn outlines(truth: &Surface) -> Vec<Outline> {
    let bounds = truth.bvh.bounds();
    let (middle, far) = (bounds.center(), 1.9 * bounds.size().length());
    (0..6)
        .map(|i| {
            let angle = core::f64::consts::PI / 6.0 * f64::from(i);
            let way = DVec3::new(libm::sin(angle), -libm::cos(angle), 0.05);
            let mut outline = Outline {
                eye: (middle + way * far).to_array(),
                target: middle.to_array(),
                up: [0.0, 0.0, 1.0],
                fov: 32.0,
                size: [640.0, 640.0],
                lines: Vec::new(),
            };
            outline.trace(16.0, &mut |eye, way| truth.is_met(eye, way));
            outline
        })
        .collect()
}

/// Mesh to measure distances from.
struct Surface {
    facets: Vec<[DVec3; 3]>,
    bvh: Bvh,
}

impl Surface {
    fn new(mesh: &TriangleMesh) -> Self {
        let facets: Vec<_> = (0..mesh.triangles.len()).map(|i| mesh.corners(i)).collect();
        let boxes: Vec<_> = facets.iter().map(|f| Aabb::of_points(*f)).collect();
        Self {
            facets,
            bvh: Bvh::new(&boxes),
        }
    }

    fn distance(&self, p: DVec3) -> f64 {
        let found = self.bvh.nearest(p, f64::INFINITY, |i| {
            closest_point(&self.facets[i as usize], p).distance_squared(p)
        });
        found.map_or(f64::INFINITY, |(_, square)| square.sqrt())
    }

    fn is_met(&self, origin: DVec3, direction: DVec3) -> bool {
        let mut met = false;
        let ray = Ray::new(origin, direction);
        self.bvh.along_ray(&ray, f64::INFINITY, |i, far| {
            let [a, b, c] = self.facets[i as usize].map(|p| p - origin);
            let sides = [(a, b), (b, c), (c, a)].map(|(p, q)| p.cross(q).dot(direction));
            met |= sides.iter().all(|s| *s >= 0.0) || sides.iter().all(|s| *s <= 0.0);
            if met { -1.0 } else { far }
        });
        met
    }
}
