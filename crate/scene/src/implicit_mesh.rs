//! Meshes as soft shapes.

use field::Implicit;
use glam::DVec3;
use metaballs::{Error, Kind, Metaballs};
use serde::{Deserialize, Serialize};
use std::sync::{Arc, OnceLock};

/// Mesh whose implicit surface is a soft shape, in coordinates of its own.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ImplicitMesh {
    /// Vertices.
    pub positions: Vec<DVec3>,
    /// Triangles, as numbers of vertices.
    pub triangles: Vec<[u32; 3]>,
    /// Kind of metaball around each triangle.
    pub kind: Kind,
    /// Sharpness k, an inverse length: each term falls by 1/e over 1/k.
    pub sharpness: f64,
    /// The function, made at first use: large meshes take a while.
    #[serde(skip)]
    function: OnceLock<Result<Arc<Metaballs>, Error>>,
}

impl ImplicitMesh {
    /// Makes the soft shape of a mesh.
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
    /// Fails as [`Metaballs::new`] does.
    pub fn function(&self) -> Result<Arc<dyn Implicit>, Error> {
        let function = self.function.get_or_init(|| {
            Metaballs::new(&self.positions, &self.triangles, self.kind, self.sharpness)
                .map(Arc::new)
        });
        Ok(function.clone()?)
    }

    /// Returns the lowest and the highest corner of a box around the triangles with their
    /// thickness; for balls, around the triangles alone.
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
