//! Meshes as soft shapes.

use field::Implicit;
use glam::DVec3;
use metaballs::{Error, Kind, Metaballs};
use serde::{Deserialize, Serialize};
use std::sync::{Arc, OnceLock};

/// A mesh whose implicit surface is a soft shape, in coordinates of its own.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ImplicitMesh {
    /// Vertices.
    pub positions: Vec<DVec3>,
    /// Triangles, as numbers of vertices.
    pub triangles: Vec<[u32; 3]>,
    /// What surrounds each triangle.
    pub kind: Kind,
    /// How sharply the field falls, an inverse length.
    pub sharpness: f64,
    /// The function, made at first use: large meshes take a while.
    #[serde(skip)]
    function: OnceLock<Result<Arc<Metaballs>, Error>>,
}

impl ImplicitMesh {
    /// A mesh with what surrounds its triangles.
    #[must_use]
    pub fn new(
        positions: Vec<DVec3>,
        triangles: Vec<[u32; 3]>,
        kind: Kind,
        sharpness: f64,
    ) -> Self {
        Self {
            positions,
            triangles,
            kind,
            sharpness,
            function: OnceLock::new(),
        }
    }

    /// Returns the function.
    ///
    /// # Errors
    /// As [`Metaballs::new`].
    pub fn function(&self) -> Result<Arc<dyn Implicit>, Error> {
        let make = || {
            let made = Metaballs::new(&self.positions, &self.triangles, self.kind, self.sharpness);
            made.map(Arc::new)
        };
        let made = self.function.get_or_init(make).clone()?;
        Ok(made)
    }

    /// Two corners of a box around the triangles and what surrounds them at their thickness; around balls, the triangles.
    pub(crate) fn corners(&self) -> (DVec3, DVec3) {
        let thickness = match self.kind {
            Kind::Spherical => 0.0,
            Kind::Triangular { thickness } => thickness,
        };
        let start = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let (low, high) = self
            .positions
            .iter()
            .fold(start, |(low, high), p| (low.min(*p), high.max(*p)));
        (low - thickness, high + thickness)
    }
}

impl PartialEq for ImplicitMesh {
    fn eq(&self, other: &Self) -> bool {
        self.kind == other.kind
            && self.sharpness == other.sharpness
            && self.positions == other.positions
            && self.triangles == other.triangles
    }
}
