//! Soft shapes whose field is no convolution of a skeleton.

use crate::Shape;
use field::{Exponentials, Implicit, Placed};
use glam::{DAffine3, DVec3};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A soft shape that is a function of space, placed in the world. It adds to the field of its body as primitives do.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Function {
    /// The function, in coordinates of its own.
    pub form: Form,
    /// From its own coordinates to the world's.
    pub to_world: DAffine3,
}

/// The kinds of functions. Copies of an element share what is large.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Form {
    /// Balls whose fields fall exponentially, see [`Exponentials`].
    Metaballs {
        /// How fast they fall, an inverse length.
        hardness: f64,
        /// Centres and radii.
        balls: Arc<Vec<(DVec3, f64)>>,
    },
}

impl Function {
    /// The function in the world's coordinates; `None` if its numbers are not usable.
    #[must_use]
    pub fn implicit(&self) -> Option<Arc<dyn Implicit>> {
        let own: Arc<dyn Implicit> = match &self.form {
            Form::Metaballs { hardness, balls } => {
                Arc::new(Exponentials::new(*hardness, balls.to_vec())?)
            }
        };
        Some(Arc::new(Placed::new(own, self.to_world)?))
    }

    /// The function after a map of the world.
    #[must_use]
    pub fn moved(&self, map: &DAffine3) -> Self {
        Self {
            form: self.form.clone(),
            to_world: *map * self.to_world,
        }
    }

    /// The shapes that stand for it where it is not drawn soft, and in drafts.
    #[must_use]
    pub fn draft(&self) -> Vec<Shape> {
        let growth = libm::cbrt(self.to_world.matrix3.determinant().abs());
        match &self.form {
            Form::Metaballs { balls, .. } => {
                let ball = |&(center, radius): &(DVec3, f64)| Shape::Sphere {
                    center: self.to_world.transform_point3(center),
                    radius: radius * growth,
                };
                balls.iter().map(ball).collect()
            }
        }
    }

    /// Two corners of a box that holds what [`Function::draft`] shows.
    #[must_use]
    pub fn corners(&self) -> (DVec3, DVec3) {
        let (low, high) = match &self.form {
            Form::Metaballs { balls, .. } => {
                let start = (DVec3::INFINITY, DVec3::NEG_INFINITY);
                balls.iter().fold(start, |(low, high), (center, radius)| {
                    (low.min(center - radius), high.max(center + radius))
                })
            }
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
