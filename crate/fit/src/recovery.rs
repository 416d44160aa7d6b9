//! The trial that tells how well a known shape is found again: a head, deformed, measured with
//! noise, outliers, a gap and outlines, and fitted in several ways.

use crate::disturb::Disturbance;
use crate::error::Error;
use crate::field::{Field, Gradient, Kind};
use crate::outlines::{Outline, sights};
use crate::problem::{Observations, Options, Problem, mean_edge};
use crate::trial;
use crate::{Deformation, fit};
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
    /// Value of [`Options::saturates`].
    pub saturates: bool,
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
        let sampled = trial::sample(&truth.positions, &truth.triangles, points, 3);
        let disturbance = Disturbance {
            noise: NOISE,
            outliers,
            gap: 0.25,
            seed: 8,
        };
        // The gap's border, along its direction.
        let toward = disturbance.toward();
        let mut along: Vec<f64> = sampled.iter().map(|p| p.dot(toward)).collect();
        along.sort_by(f64::total_cmp);
        let border = along.get(along.len() * 3 / 4).copied().unwrap_or(0.0);
        let probes = trial::sample(&truth.positions, &truth.triangles, 4000, 77);
        let (gap, near) = probes.into_iter().partition(|p| p.dot(toward) > border);
        Ok(Self {
            cage,
            observations: Observations {
                points: disturbance.apply(&sampled),
                sights: sights(&outlines(&Surface::new(&truth))),
            },
            probes: [near, gap],
        })
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
    /// As [`Problem::new`].
    pub fn problem(&self, model: &TriangleMesh, way: Way) -> Result<Problem, Error> {
        let mut observations = self.observations.clone();
        if !way.outlines {
            observations.sights.clear();
        }
        let edge = mean_edge(&model.positions, &model.triangles);
        let options = Options {
            kind: way.kind,
            slope: Some(way.sharpness / edge),
            saturates: way.saturates,
            ..Options::default()
        };
        Problem::new(model, &self.cage, observations, options)
    }

    /// Fits a mesh and measures the result.
    ///
    /// # Errors
    /// As [`Problem::new`] and [`fit()`].
    pub fn run(&self, model: &TriangleMesh, way: Way) -> Result<Outcome, Error> {
        let problem = self.problem(model, way)?;
        let fitted = fit(&problem, &mut |_| true)?;
        let mesh = TriangleMesh::new(fitted.positions.clone(), model.triangles.clone());
        let [near, gap] = self.start(&mesh);
        let slope = way.sharpness / mean_edge(&model.positions, &model.triangles);
        let field = Field::new(&mesh.positions, &mesh.triangles, way.kind, slope)?;
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
    (0..6)
        .map(|i| {
            let angle = core::f64::consts::PI / 6.0 * f64::from(i);
            let mut outline = Outline {
                eye: [9.0 * libm::sin(angle), -9.0 * libm::cos(angle), 0.4],
                target: [0.0, 0.0, -0.1],
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
