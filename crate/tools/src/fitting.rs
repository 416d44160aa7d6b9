//! The job of fitting a mesh.

use crate::job::Progress;
use crate::message::{Controls, FitJob, FitStep, Output};
use fit::{Error, Fitted, Problem, Rigid, cage, deform_lines, fit, web};
use mesh::TriangleMesh;

/// Carries out a fit, passing on every iteration.
pub(crate) fn run(job: FitJob, progress: &mut Progress<'_>) -> Result<Output, Error> {
    let FitJob {
        positions,
        triangles,
        controls,
        observations,
        options,
    } = job;
    let (frame, start) = match controls {
        Controls::Given(given) => {
            let places: Vec<_> = given.iter().map(|[place, _]| *place).collect();
            let ways = given.iter().map(|[_, way]| *way).collect();
            let between = web(&places);
            (TriangleMesh::new(places, between), ways)
        }
        Controls::Around(count) => {
            let made = cage(&positions, &triangles, count as usize);
            let still = vec![glam::DVec3::ZERO; made.positions.len()];
            (made, still)
        }
    };
    let mesh = TriangleMesh::new(positions, triangles);
    let problem = Problem::new(&mesh, &frame, observations, options)?.starting_at(start)?;
    let most = options.iterations.max(1) as f32;
    let mut rigid = Rigid::IDENTITY;
    let step = |rigid: &Rigid, now: &fit::Progress| FitStep {
        iteration: now.iteration as u32,
        residual: now.residual,
        outliers: now.outliers,
        text: deform_lines(None, rigid, &frame.positions, &now.moves),
    };
    let mut tell = |now: &fit::Progress| {
        rigid = now.rigid;
        progress.report(now.iteration as f32 / most);
        progress.pass(Output::Fit(step(&rigid, now)));
        progress.goes_on().is_continue()
    };
    let Fitted { rigid, last, .. } = fit(&problem, &mut tell)?;
    Ok(Output::Fit(step(&rigid, &last)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use fit::{Kind, Observations, Options, trial};

    #[test]
    fn fit_passes_on_its_iterations_and_ends_nearer() {
        let head = trial::head(300);
        let points = trial::sample(&head.positions, &head.triangles, 600, 3);
        let shifted = points.iter().map(|p| *p + glam::DVec3::X * 0.1 * p.z);
        let job = FitJob {
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
        let mut pass = |output| passed.push(output);
        let mut report = |_| ();
        let last = run(job, &mut Progress::new(&mut report).passing(&mut pass)).unwrap();
        let residual = |output: &Output| match output {
            Output::Fit(step) => step.residual,
            other => panic!("{other:?}"),
        };
        assert!(passed.len() > 3);
        assert!(residual(&last) < 0.5 * residual(&passed[0]));
        let Output::Fit(step) = last else { panic!() };
        assert_eq!(step.text.matches("  control <").count(), 20);
    }
}
