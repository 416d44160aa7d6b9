//! The job of fitting a mesh.

use crate::job::{Job, Pace, Progress};
use fit::{Fitted, Observations, Options, Problem, Rigid, cage, deform_lines, fit, web};
use glam::DVec3;
use mesh::TriangleMesh;
use serde::{Deserialize, Serialize};

/// Fits a mesh to measured points and outlines. Every iteration passes on a step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FitMesh {
    /// The mesh's vertices.
    pub positions: Vec<DVec3>,
    /// The mesh's triangles.
    pub triangles: Vec<[u32; 3]>,
    /// The control points.
    pub controls: Controls,
    /// The measured points and outlines.
    pub observations: Observations,
    /// The settings of the fit.
    pub options: Options,
}

/// The control points of a fit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Controls {
    /// The given points, each with the move that the fit begins with.
    Given(Vec<[DVec3; 2]>),
    /// About this number of points around the mesh.
    Around(u32),
}

/// A moment of a fit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FitStep {
    /// Iterations done.
    pub iteration: u32,
    /// The residual, [`fit::Progress::residual`].
    pub residual: f64,
    /// The share of outliers, [`fit::Progress::outliers`].
    pub outliers: f64,
    /// Numbers of the points that were left out, once the fit has ended.
    pub left_out: Vec<u32>,
    /// Reason why the result cannot be relied on, if it cannot.
    pub failure: Option<String>,
    /// The lines of a scene's text that deform the mesh like this.
    pub text: String,
}

impl Job for FitMesh {
    type Output = FitStep;
    const PACE: Pace = Pace::Long;

    fn run(self, progress: &mut Progress<'_, FitStep>) -> Result<FitStep, String> {
        let Self {
            positions,
            triangles,
            controls,
            observations,
            options,
        } = self;
        let (frame, start) = match controls {
            Controls::Given(given) => {
                let places: Vec<_> = given.iter().map(|[place, _]| *place).collect();
                let moves = given.iter().map(|[_, by]| *by).collect();
                let between = web(&places);
                (TriangleMesh::new(places, between), moves)
            }
            Controls::Around(count) => {
                let cage = cage(&positions, &triangles, count as usize);
                let moves = vec![DVec3::ZERO; cage.positions.len()];
                (cage, moves)
            }
        };
        let mesh = TriangleMesh::new(positions, triangles);
        let problem = Problem::new(&mesh, &frame, observations, options)
            .and_then(|problem| problem.starting_at(start))
            .map_err(|error| error.to_string())?;
        let most = options.iterations.max(1) as f32;
        let Fitted {
            rigid,
            last,
            left_out,
            failure,
            ..
        } = fit(&problem, &mut |now| {
            let fraction = now.iteration as f32 / most;
            let step = FitStep::new(&frame, &now.rigid, now);
            progress.report(fraction).is_continue() && progress.pass(step).is_continue()
        })
        .map_err(|error| error.to_string())?;
        Ok(FitStep {
            left_out,
            failure,
            ..FitStep::new(&frame, &rigid, &last)
        })
    }
}

impl FitStep {
    fn new(frame: &TriangleMesh, rigid: &Rigid, now: &fit::Progress) -> Self {
        Self {
            iteration: now.iteration as u32,
            residual: now.residual,
            outliers: now.outliers,
            left_out: Vec::new(),
            failure: None,
            text: deform_lines(None, rigid, &frame.positions, &now.moves),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::News;
    use core::ops::ControlFlow;
    use fit::{Kind, trial};

    #[test]
    fn fit_passes_on_its_iterations_and_ends_nearer() {
        let head = trial::head(300);
        let points = trial::sample(&head.positions, &head.triangles, 600, 3);
        let shifted = points.iter().map(|p| *p + DVec3::X * 0.1 * p.z);
        let job = FitMesh {
            positions: head.positions.clone(),
            triangles: head.triangles.clone(),
            controls: Controls::Around(20),
            observations: Observations {
                points: shifted.collect(),
                sights: Vec::new(),
            },
            options: Options {
                kind: Kind::Explicit,
                iterations: 12,
                ..Options::default()
            },
        };
        let mut passed = Vec::new();
        let last = job.run(&mut Progress::new(&mut |news| {
            if let News::Part(step) = news {
                passed.push(step);
            }
            ControlFlow::Continue(())
        }));
        let last = last.unwrap();
        assert!(passed.len() > 3);
        assert!(last.residual < 0.5 * passed[0].residual);
        assert_eq!(last.text.matches("  control <").count(), 20);
    }
}
