//! Soft shapes whose field is no convolution of a skeleton.

use crate::{Curves, ImplicitMesh, Shape};
use field::{Exponentials, Implicit, Placed};
use glam::{DAffine3, DVec3};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Soft shape that is a function of space, placed in the world. It adds to the field of its body as
/// primitives do.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Function {
    /// The function, in coordinates of its own.
    pub form: Form,
    /// Map from the function's own coordinates to the world's.
    pub to_world: DAffine3,
}

/// The kinds of functions. Copies of an element share what is large.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Form {
    /// Balls whose fields fall exponentially, see [`Exponentials`].
    Metaballs {
        /// Rate at which the fields fall, an inverse length.
        hardness: f64,
        /// Centres and radii.
        balls: Arc<Vec<(DVec3, f64)>>,
    },
    /// Curves convolved with the kernel of their flesh. They are primitives, so that they have no
    /// function of their own.
    Skeleton(Arc<Curves>),
    /// The implicit surface of a mesh.
    Mesh(Arc<ImplicitMesh>),
}

/// Returns the lowest and the highest corner of the box around balls.
fn corners_around(balls: impl Iterator<Item = (DVec3, f64)>) -> (DVec3, DVec3) {
    let start = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    balls.fold(start, |(low, high), (center, radius)| {
        (low.min(center - radius), high.max(center + radius))
    })
}

impl Function {
    /// The function in the world's coordinates; `None` if its numbers are not usable, or if it is a
    /// sum of primitives.
    #[must_use]
    pub fn implicit(&self) -> Option<Arc<dyn Implicit>> {
        let own: Arc<dyn Implicit> = match &self.form {
            Form::Metaballs { hardness, balls } => {
                Arc::new(Exponentials::new(*hardness, balls.to_vec())?)
            }
            Form::Skeleton(_) => return None,
            Form::Mesh(mesh) => mesh.function().ok()?,
        };
        Some(Arc::new(Placed::new(own, self.to_world)?))
    }

    /// Number of shapes that the function counts as where their number is limited.
    #[must_use]
    pub fn weight(&self) -> usize {
        match &self.form {
            Form::Metaballs { balls, .. } => balls.len(),
            Form::Skeleton(curves) => curves.pieces().count(),
            Form::Mesh(mesh) => mesh.triangles.len(),
        }
    }

    /// The function after a map of the world.
    #[must_use]
    pub fn moved(&self, map: &DAffine3) -> Self {
        Self {
            form: self.form.clone(),
            to_world: *map * self.to_world,
        }
    }

    /// The curves, if it is a skeleton.
    #[must_use]
    pub fn curves(&self) -> Option<&Curves> {
        match &self.form {
            Form::Skeleton(curves) => Some(curves),
            Form::Metaballs { .. } | Form::Mesh(_) => None,
        }
    }

    /// The factor from its own lengths to the world's; where directions are stretched differently,
    /// their geometric mean.
    #[must_use]
    pub fn growth(&self) -> f64 {
        libm::cbrt(self.to_world.matrix3.determinant().abs())
    }

    /// Points on its skeleton, where it is strongest, in the world's coordinates: as many as suit a
    /// quick look.
    #[must_use]
    pub fn axis(&self) -> Vec<DVec3> {
        const MOST: usize = 16;
        let points: Vec<DVec3> = match &self.form {
            Form::Metaballs { balls, .. } => balls.iter().map(|ball| ball.0).collect(),
            Form::Skeleton(curves) => curves.points().map(|(point, _)| point).collect(),
            // Evenly over the list: a mesh may have a hundred thousand vertices.
            Form::Mesh(mesh) => {
                let step = mesh.positions.len().div_ceil(MOST).max(1);
                mesh.positions.iter().copied().step_by(step).collect()
            }
        };
        let step = points.len().div_ceil(MOST).max(1);
        let some = points.into_iter().step_by(step);
        some.map(|p| self.to_world.transform_point3(p)).collect()
    }

    /// The shapes that stand for it where it is not drawn soft, and in drafts.
    #[must_use]
    pub fn draft(&self) -> Vec<Shape> {
        let growth = self.growth();
        match &self.form {
            Form::Metaballs { balls, .. } => balls
                .iter()
                .map(|&(center, radius)| {
                    Shape::sphere(self.to_world.transform_point3(center), radius * growth)
                })
                .collect(),
            Form::Skeleton(curves) => curves.draft(&self.to_world, growth),
            Form::Mesh(mesh) => {
                let mut parts = Vec::new();
                for triangle in &mesh.triangles {
                    let corners = triangle.map(|i| mesh.positions.get(i as usize));
                    if let [Some(a), Some(b), Some(c)] = corners {
                        let corners = [a, b, c].map(|p| self.to_world.transform_point3(*p));
                        parts.push(Shape::triangle(corners, 0.0));
                    }
                }
                parts
            }
        }
    }

    /// Returns the lowest and the highest corner of a box that holds what [`Function::draft`]
    /// shows.
    #[must_use]
    pub fn corners(&self) -> (DVec3, DVec3) {
        let (low, high) = match &self.form {
            Form::Metaballs { balls, .. } => corners_around(balls.iter().copied()),
            Form::Skeleton(curves) => corners_around(curves.points()),
            Form::Mesh(mesh) => mesh.corners(),
        };
        let middle = self.to_world.transform_point3(0.5 * (low + high));
        let half = 0.5 * (high - low);
        let columns = [0, 1, 2].map(|i| self.to_world.matrix3.col(i).abs() * half[i]);
        let reach = columns[0] + columns[1] + columns[2];
        (middle - reach, middle + reach)
    }

    /// The middle of that box.
    #[must_use]
    pub fn middle(&self) -> DVec3 {
        let (low, high) = self.corners();
        0.5 * (low + high)
    }
}
