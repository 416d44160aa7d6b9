//! Input of a fit: a mesh, its control mesh, the observations.

use crate::deformation::{Deformation, lattice};
use crate::error::{Error, fail};
use crate::field::Kind;
use crate::sight::Sight;
use crate::stiffness::stiffness;
use glam::DVec3;
use mesh::TriangleMesh;
use serde::{Deserialize, Serialize};

/// Most control points of a cage in a fit: its equations take time in proportion to their cube.
pub const MAX_FITTED_CONTROLS: usize = 500;
/// Most vertices of a mesh that are fitted one by one.
pub const MAX_FITTED_VERTICES: usize = 50_000;
/// Most points, and most lines of sight.
pub const MAX_OBSERVATIONS: usize = 200_000;

/// Measured places of a surface.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Observations {
    /// Points on the surface.
    pub points: Vec<DVec3>,
    /// Lines that graze the surface.
    pub sights: Vec<Sight>,
}

/// The way in which distances h from the surface count in a fit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Loss {
    /// `(s·tanh(h/s))²`, with a scale s that falls: no more beyond s.
    #[default]
    Saturating,
    /// `h²`, as if there were no outliers.
    Squares,
    /// `((1 − F)/k)²` with the field `F = e^−kh`, as Ilić and Fua have it, and with a slope k that
    /// rises; `h²` where there is no field, of facets themselves.
    Algebraic,
}

/// Options of a fit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Options {
    /// Surface that stands for the mesh.
    pub kind: Kind,
    /// k of the implicit surface at the end of the fit; `None` for 20 over the mean edge.
    pub slope: Option<f64>,
    /// Weight of the smoothness of the moves, ≥ 0; at 1 it counts as much as the observations do
    /// together.
    pub smooth: f64,
    /// Weight of the outlines beside the points, ≥ 0; at 1 they count alike.
    pub outlines: f64,
    /// The way in which distances count.
    pub loss: Loss,
    /// Whether the mesh is first turned and moved as a whole; if not, it still is where the fit
    /// fails otherwise, or comes much nearer so.
    pub align: bool,
    /// Most iterations in all; of a fit of single vertices, in each of its two parts.
    pub iterations: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            kind: Kind::Triangular { thickness: 0.0 },
            slope: None,
            smooth: 0.02,
            outlines: 1.0,
            loss: Loss::Saturating,
            align: false,
            iterations: 100,
        }
    }
}

/// The way in which a fit moves the vertices of a mesh.
#[derive(Clone, Debug, PartialEq)]
pub enum Controls {
    /// Sibson's coordinates in the vertices of a mesh, whose triangles say which of them are
    /// neighbours.
    Cage(TriangleMesh),
    /// A lattice in the mesh's box, with these numbers of nodes along the axes.
    Lattice([usize; 3]),
    /// Vertices moved one by one, after a fit by a cage of the mesh's own.
    Vertices,
}

/// Mesh to fit with its control points.
#[derive(Clone, Debug)]
pub struct Problem {
    pub(crate) by: Controls,
    pub(crate) positions: Vec<DVec3>,
    pub(crate) triangles: Vec<[u32; 3]>,
    pub(crate) controls: Vec<DVec3>,
    pub(crate) cage: Vec<[u32; 3]>,
    pub(crate) deformation: Deformation,
    pub(crate) observations: Observations,
    pub(crate) options: Options,
    /// The moves to begin with.
    pub(crate) start: Vec<DVec3>,
}

impl Problem {
    /// Prepares a fit. The vertices of `cage` are the control points, its triangles say which are
    /// neighbours.
    ///
    /// # Errors
    /// Says which input cannot be used: a mesh without triangles, too many controls, no or too few
    /// observations, numbers out of range.
    pub fn new(
        mesh: &TriangleMesh,
        cage: &TriangleMesh,
        observations: Observations,
        options: Options,
    ) -> Result<Self, Error> {
        Self::with(mesh, Controls::Cage(cage.clone()), observations, options)
    }

    /// Prepares a fit that moves the vertices in any of the ways.
    ///
    /// # Errors
    /// Fails as [`Self::new`] does, and if a lattice has too few or too many nodes.
    pub fn with(
        mesh: &TriangleMesh,
        by: Controls,
        observations: Observations,
        options: Options,
    ) -> Result<Self, Error> {
        check(mesh, &by, &observations, &options)?;
        let mut problem = Self {
            by,
            positions: mesh.positions.clone(),
            triangles: mesh.triangles.clone(),
            controls: Vec::new(),
            cage: Vec::new(),
            deformation: Deformation::direct(&[]),
            observations,
            options,
            start: Vec::new(),
        };
        if problem.mean_edge() <= 0.0 {
            return fail("the mesh has no extent");
        }
        problem.control()?;
        problem.start = vec![DVec3::ZERO; problem.controls.len()];
        Ok(problem)
    }

    /// Sets the control points, their triangles and the deformation to those of the vertices.
    pub(crate) fn control(&mut self) -> Result<(), Error> {
        let positions = &self.positions;
        (self.controls, self.cage, self.deformation) = match &self.by {
            Controls::Cage(cage) => {
                let deformation = Deformation::new(positions, &cage.positions)?;
                (cage.positions.clone(), cage.triangles.clone(), deformation)
            }
            Controls::Lattice(counts) => {
                let nodes = lattice(positions, *counts)?;
                let deformation = Deformation::lattice(positions, *counts)?;
                (nodes.positions, nodes.triangles, deformation)
            }
            Controls::Vertices => {
                let deformation = Deformation::direct(positions);
                let triangles = self.triangles.iter();
                let between = triangles.map(|t| t.map(|i| deformation.weights(i as usize)[0].0));
                (positions.clone(), between.collect(), deformation)
            }
        };
        Ok(())
    }

    /// Lets the fit begin with moves of the control points, such as those of an earlier one.
    ///
    /// # Errors
    /// If there are not as many moves as control points, or one is not finite.
    pub fn starting_at(mut self, moves: Vec<DVec3>) -> Result<Self, Error> {
        if moves.len() != self.controls.len() {
            return fail(format!(
                "there are {} moves to begin with for {} control points",
                moves.len(),
                self.controls.len()
            ));
        }
        if let Some(bad) = moves.iter().position(|way| !way.is_finite()) {
            return fail(format!(
                "the move of control point {} is not finite",
                bad + 1
            ));
        }
        self.start = moves;
        Ok(self)
    }

    /// Entries (i, j, value) with i ≥ j of the control mesh's stiffness matrix; one with i > j
    /// stands for both of its places, and places may come several times, which add up.
    #[must_use]
    pub fn stiffness(&self) -> Vec<(u32, u32, f64)> {
        stiffness(&self.controls, &self.cage)
    }

    /// The mean length of the edges of all triangles.
    #[must_use]
    pub fn mean_edge(&self) -> f64 {
        mean_edge(&self.positions, &self.triangles)
    }
}

/// The mean length of the edges of triangles; 0 without any.
#[must_use]
pub fn mean_edge(positions: &[DVec3], triangles: &[[u32; 3]]) -> f64 {
    let sum: f64 = triangles
        .iter()
        .map(|[a, b, c]| {
            let [a, b, c] = [*a, *b, *c].map(|i| positions[i as usize]);
            a.distance(b) + b.distance(c) + c.distance(a)
        })
        .sum();
    sum / (3 * triangles.len()).max(1) as f64
}

fn check(
    mesh: &TriangleMesh,
    by: &Controls,
    observations: &Observations,
    options: &Options,
) -> Result<(), Error> {
    if mesh.triangles.is_empty() {
        return fail("the mesh has no triangles");
    }
    let (count, most, what) = match by {
        Controls::Cage(cage) => (
            cage.positions.len(),
            MAX_FITTED_CONTROLS,
            "control mesh has",
        ),
        Controls::Vertices => (
            mesh.positions.len(),
            MAX_FITTED_VERTICES,
            "mesh to be fitted vertex by vertex has",
        ),
        Controls::Lattice(_) => (0, 0, ""),
    };
    if count > most {
        return fail(format!(
            "the {what} {count} vertices, more than the {most} that a fit takes"
        ));
    }
    let Observations { points, sights } = observations;
    if points.is_empty() && sights.is_empty() {
        return fail("there are no points and no outlines to fit to");
    }
    for (count, what) in [(points.len(), "points"), (sights.len(), "lines of sight")] {
        if count > MAX_OBSERVATIONS {
            return fail(format!(
                "there are {count} {what}, more than the {MAX_OBSERVATIONS} that a fit takes"
            ));
        }
    }
    if sights.is_empty() && points.len() < 4 {
        return fail(format!(
            "a cloud of {} point{} says too little; four are the least",
            points.len(),
            if points.len() == 1 { "" } else { "s" }
        ));
    }
    if let Some(bad) = points.iter().position(|p| !p.is_finite()) {
        return fail(format!("point {} of the cloud is no finite point", bad + 1));
    }
    if sights.is_empty() && points.iter().all(|p| p == &points[0]) {
        return fail("all points of the cloud are in one place");
    }
    if sights
        .iter()
        .any(|s| !(s.origin.is_finite() && s.direction.is_normalized()))
    {
        return fail("a line of sight has no direction");
    }
    let weights = [options.smooth, options.outlines];
    if weights.iter().any(|w| !(w.is_finite() && *w >= 0.0)) {
        return fail("weights must be numbers from 0 on");
    }
    if let Some(k) = options.slope
        && !(k.is_finite() && k > 0.0)
    {
        return fail("the slope must be a number above 0");
    }
    if let Kind::Triangular { thickness } = options.kind
        && !(thickness.is_finite() && thickness >= 0.0)
    {
        return fail("the thickness must be a number from 0 on");
    }
    Ok(())
}
