//! The job of coating the skeletons of a scene, which gives a first mesh of it quickly.

use crate::job::{Job, Pace, Progress};
use mesh::TriangleMesh;
use mesher::Coating;
use scene::Scene;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Coats the skeletons of a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CoatScene {
    /// The scene.
    pub scene: Arc<Scene>,
    /// Largest |f − T| in the middle of an edge.
    pub bound: f64,
    /// Coatings from the last job, to start from; empty at first.
    pub coatings: Vec<Coating>,
}

/// The coatings of a scene.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Coated {
    /// A mesh for each body with its name, in units of the scene.
    pub parts: Vec<(String, TriangleMesh)>,
    /// Coatings for the next job.
    pub coatings: Vec<Coating>,
}

impl Job for CoatScene {
    type Output = Coated;
    const PACE: Pace = Pace::Long;

    fn run(mut self, progress: &mut Progress<'_, Coated>) -> Result<Coated, String> {
        let is_sound = self.bound > 0.0 && self.bound.is_finite();
        if !is_sound {
            return Err("the bound must be a positive number".into());
        }
        let bodies = mesher::coat_scene(
            &self.scene,
            self.bound,
            &mut self.coatings,
            &mut mesher::Progress::new(&mut |step| progress.report(step.fraction)),
        )
        .map_err(|error| error.to_string())?;
        let parts = bodies.into_iter().map(|body| (body.name, body.coat.mesh));
        Ok(Coated {
            parts: parts.collect(),
            coatings: self.coatings,
        })
    }
}

/// Returns a scene of a soft ball in the origin.
#[cfg(test)]
pub(crate) fn ball(radius: f64) -> Arc<Scene> {
    let mut scene = Scene::default();
    scene.flesh.push(scene::Flesh {
        blobbiness: Some(2.0),
        ..scene::Flesh::default()
    });
    let center = glam::DVec3::ZERO;
    scene.elements.push(scene::Element {
        flesh: Some(0),
        ..scene::Element::new(scene::Shape::sphere(center, radius))
    });
    Arc::new(scene)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn skeletons_are_coated_from_the_last_coating() {
        let coat = |coatings, radius| {
            let job = CoatScene {
                scene: ball(radius),
                bound: 0.02,
                coatings,
            };
            job.run(&mut Progress::silent()).unwrap()
        };
        let first = coat(Vec::new(), 1.0);
        let second = coat(first.coatings, 1.01);
        for (coated, radius) in [(first.parts, 1.0), (second.parts, 1.01)] {
            assert_eq!(coated.len(), 1);
            let mut lengths = coated[0].1.positions.iter().map(|p| p.length());
            assert!(lengths.all(|length| (length - radius).abs() < 0.01));
        }
    }
}
