//! Reports on meshes: counts, and sentences about them.

use crate::error::Error;
use crate::half_edge::{HalfEdgeMesh, PolygonSoup, Repairs, Shell};
use crate::triangle_mesh::TriangleMesh;
use core::fmt;

/// Topology of a triangle mesh: whether it is closed and a manifold, and what its shells are like.
///
/// ```
/// use glam::DVec3;
/// use mesh::{Topology, TriangleMesh};
///
/// let mut mesh = TriangleMesh::new(
///     vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z],
///     vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
/// );
/// let topology = Topology::of(&mesh)?;
/// assert!(topology.is_closed_manifold());
/// assert_eq!(topology.to_string(), "closed; a manifold; 1 shell, of genus 0");
///
/// mesh.triangles.pop();
/// assert_eq!(
///     Topology::of(&mesh)?.to_string(),
///     "open, with 3 boundary edges in 1 loop; a manifold; 1 shell, of genus 0"
/// );
/// # Ok::<(), mesh::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Topology {
    /// Vertices that triangles use; edges; triangles.
    pub counts: [usize; 3],
    /// Edges of one triangle only, after what [`Topology::repairs`] says.
    pub boundary_edges: usize,
    /// Loops that those form.
    pub boundary_loops: usize,
    /// Changes that would make it a manifold.
    pub repairs: Repairs,
    /// The genus of each connected component, in the order of its lowest triangle; after the
    /// repairs.
    pub genera: Vec<u64>,
}

impl Topology {
    /// Examines a mesh.
    ///
    /// # Errors
    /// Fails as [`HalfEdgeMesh::repair`] does.
    pub fn of(mesh: &TriangleMesh) -> Result<Self, Error> {
        let built = HalfEdgeMesh::repair(&PolygonSoup::from(mesh))?;
        let mesh = &built.mesh;
        let boundary = mesh.edges().filter(|h| mesh.is_boundary_edge(*h));
        Ok(Self {
            counts: [mesh.vertex_count(), mesh.edge_count(), mesh.face_count()],
            boundary_edges: boundary.count(),
            boundary_loops: mesh.boundary_loops().len(),
            repairs: built.repairs,
            genera: mesh.shells().iter().map(Shell::genus).collect(),
        })
    }

    /// `true` if every edge has two triangles that agree on what is outside, and the triangles at
    /// each vertex form one fan.
    #[must_use]
    pub fn is_closed_manifold(&self) -> bool {
        self.boundary_edges == 0 && self.repairs.is_none() && !self.genera.is_empty()
    }
}

/// Returns the ending of a noun after a count.
fn plural(count: usize) -> &'static str {
    if count == 1 { "" } else { "s" }
}

impl fmt::Display for Topology {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (edges, loops) = (self.boundary_edges, self.boundary_loops);
        match edges {
            0 => f.write_str("closed; ")?,
            _ => write!(
                f,
                "open, with {edges} boundary edge{} in {loops} loop{}; ",
                plural(edges),
                plural(loops)
            )?,
        }
        if self.repairs.is_none() {
            f.write_str("a manifold; ")?;
        } else {
            write!(f, "no manifold ({}); ", self.repairs)?;
        }
        let shells = self.genera.len();
        write!(f, "{shells} shell{}", plural(shells))?;
        match self.genera[..] {
            [] => Ok(()),
            [genus] => write!(f, ", of genus {genus}"),
            _ => write!(f, ", of genus {} in all", self.genera.iter().sum::<u64>()),
        }
    }
}
