//! Dirichlet free-form deformation of vertices.

use crate::error::Error;
use crate::sibson::{Sibson, Workspace};
use glam::DVec3;
use mesh::Aabb;

/// The coordinates of a mesh's vertices, computed once: vertices follow any moves of the controls.
///
/// A vertex moves by `Σ uₖ·Δₖ` over the controls that are its natural neighbours; the far corners
/// of [`Sibson`] stay.
#[derive(Clone, Debug, PartialEq)]
pub struct Deformation {
    controls: usize,
    /// End of each vertex's weights in `weights`.
    ends: Vec<u32>,
    weights: Vec<(u32, f64)>,
}

impl Deformation {
    /// Computes the coordinates of vertices with respect to control points.
    ///
    /// # Errors
    /// Fails as [`Sibson::new`] does, and if a vertex is no finite point.
    pub fn new(vertices: &[DVec3], controls: &[DVec3]) -> Result<Self, Error> {
        let bounds = Aabb::of_points(vertices.iter().copied());
        let sibson = Sibson::new(controls, &bounds)?;
        let mut work = Workspace::default();
        let (mut row, mut weights) = (Vec::new(), Vec::new());
        let mut ends = Vec::with_capacity(vertices.len());
        for (number, vertex) in vertices.iter().enumerate() {
            if !sibson.row(*vertex, &mut work, &mut row) {
                return Err(Error(format!("vertex {} is no finite point", number + 1)));
            }
            weights.extend(row.iter().filter(|(k, _)| (*k as usize) < controls.len()));
            ends.push(weights.len() as u32);
        }
        Ok(Self {
            controls: controls.len(),
            ends,
            weights,
        })
    }

    /// Number of control points.
    #[must_use]
    pub fn controls(&self) -> usize {
        self.controls
    }

    /// Number of vertices.
    #[must_use]
    pub fn vertices(&self) -> usize {
        self.ends.len()
    }

    /// The controls that move a vertex, each with its weight, by number.
    ///
    /// # Panics
    /// If there is no such vertex.
    #[must_use]
    pub fn weights(&self, vertex: usize) -> &[(u32, f64)] {
        let start = vertex.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.weights[start as usize..self.ends[vertex] as usize]
    }

    /// Returns the vertices moved.
    ///
    /// # Panics
    /// If there are not as many vertices or moves as before.
    #[must_use]
    pub fn apply(&self, vertices: &[DVec3], moves: &[DVec3]) -> Vec<DVec3> {
        assert_eq!(vertices.len(), self.ends.len(), "the vertices of before");
        assert_eq!(moves.len(), self.controls, "a move for each control");
        vertices
            .iter()
            .enumerate()
            .map(|(i, vertex)| {
                *vertex
                    + self
                        .weights(i)
                        .iter()
                        .map(|(k, weight)| moves[*k as usize] * *weight)
                        .sum::<DVec3>()
            })
            .collect()
    }
}
