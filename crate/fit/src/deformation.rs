//! Free-form deformation of vertices: by natural neighbours (Dirichlet), by a lattice, or each
//! vertex by itself.

use crate::error::{Error, fail};
use crate::sibson::{Sibson, Workspace};
use glam::DVec3;
use mesh::{Aabb, TriangleMesh};
use std::collections::HashMap;

/// Most nodes of a lattice.
pub const MAX_NODES: usize = 500;

/// The coordinates of a mesh's vertices, computed once: vertices follow any moves of the controls.
///
/// A vertex moves by `Σ uₖ·Δₖ` over the controls that are its natural neighbours, where the far
/// corners of [`Sibson`] stay; or over all nodes of a lattice.
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

    /// Computes the coordinates of vertices in a lattice of nodes that fills their box (Sederberg
    /// and Parry): products of Bernstein's polynomials along the axes. Nodes along x come first.
    ///
    /// # Errors
    /// If an axis has fewer than two nodes, all have more than [`MAX_NODES`], or a vertex is no
    /// finite point.
    ///
    /// ```
    /// use fit::Deformation;
    /// use glam::DVec3;
    ///
    /// let vertices = [DVec3::ZERO, DVec3::ONE, DVec3::splat(0.5)];
    /// let deformation = Deformation::lattice(&vertices, [2, 2, 3])?;
    /// let mut moves = [DVec3::ZERO; 12];
    /// moves[11] = DVec3::X;
    /// // The last node takes along the corner where it is, and a sixteenth of the middle.
    /// let moved = deformation.apply(&vertices, &moves);
    /// assert_eq!(moved[1].x, 2.0);
    /// assert_eq!(moved[2].x, 0.5 + 1.0 / 16.0);
    /// # Ok::<(), fit::Error>(())
    /// ```
    pub fn lattice(vertices: &[DVec3], counts: [usize; 3]) -> Result<Self, Error> {
        let nodes = nodes(counts)?;
        let bounds = Aabb::of_points(vertices.iter().copied());
        let mut weights = Vec::new();
        let mut ends = Vec::with_capacity(vertices.len());
        for (number, vertex) in vertices.iter().enumerate() {
            if !vertex.is_finite() {
                return fail(format!("vertex {} is no finite point", number + 1));
            }
            let share = (*vertex - bounds.min) / bounds.size().max(DVec3::splat(f64::MIN_POSITIVE));
            let along = [0, 1, 2].map(|axis| bernstein(counts[axis] - 1, share[axis]));
            for (node, place) in places(counts).enumerate() {
                let weight: f64 = (0..3).map(|axis| along[axis][place[axis]]).product();
                if weight != 0.0 {
                    weights.push((node as u32, weight));
                }
            }
            ends.push(weights.len() as u32);
        }
        Ok(Self {
            controls: nodes,
            ends,
            weights,
        })
    }

    /// Returns the deformation that moves each vertex by itself, those in the same place together:
    /// with the first of them.
    #[must_use]
    pub fn direct(vertices: &[DVec3]) -> Self {
        let mut first = HashMap::new();
        let own = vertices.iter().zip(0..).map(|(place, i)| {
            let bits = (*place + 0.0).to_array().map(f64::to_bits);
            (*first.entry(bits).or_insert(i), 1.0)
        });
        Self {
            controls: vertices.len(),
            weights: own.collect(),
            ends: (1..=vertices.len() as u32).collect(),
        }
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

/// Returns the nodes of a lattice that fills the box of vertices, with triangles between those that
/// are neighbours: two in each square.
///
/// # Errors
/// If an axis has fewer than two nodes, or all have more than [`MAX_NODES`].
pub fn lattice(vertices: &[DVec3], counts: [usize; 3]) -> Result<TriangleMesh, Error> {
    nodes(counts)?;
    let bounds = Aabb::of_points(vertices.iter().copied());
    let positions = places(counts).map(|place| {
        let share = [0, 1, 2].map(|axis| place[axis] as f64 / (counts[axis] - 1) as f64);
        bounds.min + bounds.size() * DVec3::from_array(share)
    });
    let strides = [1, counts[0], counts[0] * counts[1]];
    let mut triangles = Vec::new();
    for (node, place) in places(counts).enumerate() {
        for [u, v] in [[0, 1], [1, 2], [2, 0]] {
            if place[u] + 1 < counts[u] && place[v] + 1 < counts[v] {
                let [a, b] = [node, node + strides[u]];
                let [c, d] = [a, b].map(|node| node + strides[v]);
                triangles.extend([[a, b, d], [a, d, c]].map(|t| t.map(|i| i as u32)));
            }
        }
    }
    Ok(TriangleMesh::new(positions.collect(), triangles))
}

/// Returns the number of a lattice's nodes.
fn nodes(counts: [usize; 3]) -> Result<usize, Error> {
    if counts.iter().any(|count| *count < 2) {
        return fail("a lattice has at least two nodes along each axis");
    }
    let nodes = counts
        .iter()
        .try_fold(1, |all: usize, n| all.checked_mul(*n));
    match nodes {
        Some(nodes) if nodes <= MAX_NODES => Ok(nodes),
        _ => fail(format!("a lattice has at most {MAX_NODES} nodes in all")),
    }
}

/// The columns of all nodes of a lattice, by number.
fn places([x, y, z]: [usize; 3]) -> impl Iterator<Item = [usize; 3]> {
    (0..x * y * z).map(move |node| [node % x, node / x % y, node / (x * y)])
}

/// Returns the values of Bernstein's polynomials of a degree, by de Casteljau's steps.
fn bernstein(degree: usize, t: f64) -> Vec<f64> {
    let mut values = vec![0.0; degree + 1];
    values[0] = 1.0;
    for last in 1..=degree {
        for i in (0..=last).rev() {
            let before = if i > 0 { values[i - 1] } else { 0.0 };
            values[i] = (1.0 - t) * values[i] + t * before;
        }
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trial;

    #[test]
    fn lattice_moves_vertices_as_its_nodes_move() {
        fn linear(p: DVec3) -> DVec3 {
            DVec3::new(0.3 - p.z, 2.0 * p.x + p.y, 0.5 * p.y - 1.0)
        }
        let head = trial::head(300);
        let counts = [3, 4, 5];
        let nodes = lattice(&head.positions, counts).unwrap();
        let deformation = Deformation::lattice(&head.positions, counts).unwrap();
        assert_eq!((deformation.controls(), nodes.positions.len()), (60, 60));
        // A linear move of the nodes is one of the vertices: Σ u = 1 and Σ u·c = v.
        let moves: Vec<DVec3> = nodes.positions.iter().map(|p| linear(*p)).collect();
        let moved = deformation.apply(&head.positions, &moves);
        for (i, (moved, p)) in moved.iter().zip(&head.positions).enumerate() {
            assert!(moved.distance(*p + linear(*p)) < 1e-12);
            assert!(
                deformation
                    .weights(i)
                    .iter()
                    .all(|(_, weight)| *weight >= 0.0)
            );
        }
        // Two in each square of all planes: 2·(2·3·5 + 3·4·3 + 4·2·4).
        assert_eq!(nodes.triangles.len(), 196);
    }

    #[test]
    fn bad_lattices_are_told_and_flat_meshes_are_borne() {
        for (counts, words) in [
            ([1, 4, 4], "at least two nodes"),
            ([8, 8, 8], "at most 500 nodes"),
            ([usize::MAX; 3], "at most 500 nodes"),
        ] {
            let error = Deformation::lattice(&[DVec3::ZERO], counts).unwrap_err();
            assert!(error.0.contains(words), "{error}");
            assert_eq!(lattice(&[DVec3::ZERO], counts), Err(error));
        }
        let bad = Deformation::lattice(&[DVec3::NAN], [2; 3]).unwrap_err();
        assert_eq!(bad.0, "vertex 1 is no finite point");
        let flat = [DVec3::ZERO, DVec3::X, DVec3::Y];
        let deformation = Deformation::lattice(&flat, [2; 3]).unwrap();
        let moved = deformation.apply(&flat, &[DVec3::Z; 8]);
        assert_eq!(moved[1], DVec3::new(1.0, 0.0, 1.0));
    }

    #[test]
    fn vertices_move_by_themselves() {
        let vertices = [DVec3::ZERO, DVec3::X, DVec3::X];
        let moves = [DVec3::X, DVec3::Y, DVec3::Z];
        let moved = Deformation::direct(&vertices).apply(&vertices, &moves);
        let both = DVec3::new(1.0, 1.0, 0.0);
        assert_eq!(moved, [DVec3::X, both, both]);
    }
}
