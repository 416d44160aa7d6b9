//! Faults of a mesh that a fit can do little about.

use crate::error::{Error, fail};
use mesh::{Topology, TriangleMesh, self_intersections};

/// Pairs of triangles that are counted.
const MOST_PAIRS: usize = 1000;

/// Returns what is unusual about a mesh that is to be fitted, a sentence each: open, no manifold,
/// cutting itself. None of this keeps a fit from running; the sentences say what comes of it.
///
/// # Errors
/// If there are no triangles, or a corner is no finite point.
///
/// ```
/// let open = mesh::read("corner.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")?;
/// let remarks = fit::remarks(&open).unwrap();
/// assert!(remarks[0].starts_with("the mesh is open: 3 edges"));
/// # Ok::<(), mesh::Error>(())
/// ```
pub fn remarks(mesh: &TriangleMesh) -> Result<Vec<String>, Error> {
    if mesh.triangles.is_empty() {
        return fail("the mesh has no triangles");
    }
    let topology = Topology::of(mesh).map_err(|error| Error(error.to_string()))?;
    let mut remarks = Vec::new();
    let edges = topology.boundary_edges;
    if edges > 0 {
        let loops = topology.boundary_loops;
        remarks.push(format!(
            "the mesh is open: {edges} edges in {loops} {} have one facet only; outlines count \
             those rims as a border, too",
            if loops == 1 { "loop" } else { "loops" }
        ));
    }
    if !topology.repairs.is_none() {
        remarks.push(format!(
            "the mesh is no manifold ({}); all of its facets are fitted all the same",
            topology.repairs
        ));
    }
    let crossed = self_intersections(mesh, MOST_PAIRS).map_err(|error| Error(error.to_string()))?;
    let count = crossed.pairs.len();
    if count > 0 {
        let or_more = if crossed.is_complete { "" } else { " or more" };
        remarks.push(format!(
            "the mesh cuts itself: {count}{or_more} pairs of facets, the first {} and {}; points \
             near there may hold either sheet",
            crossed.pairs[0][0] + 1,
            crossed.pairs[0][1] + 1
        ));
    }
    Ok(remarks)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn unusual_meshes_are_told() {
        let tetrahedron = TriangleMesh::new(
            vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z],
            vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
        );
        assert_eq!(remarks(&tetrahedron), Ok(Vec::new()));
        let mut two = tetrahedron.clone();
        two.positions
            .extend(tetrahedron.positions.iter().map(|p| *p + 0.25));
        let copy = tetrahedron.triangles.iter().map(|t| t.map(|i| i + 4));
        two.triangles.extend(copy);
        let said = remarks(&two).unwrap();
        assert!(
            said.len() == 1 && said[0].contains("cuts itself"),
            "{said:?}"
        );
        let mut three = tetrahedron.clone();
        three.positions.push(DVec3::ONE);
        three.triangles.push([0, 1, 4]);
        let said = remarks(&three).unwrap();
        assert!(said.iter().any(|s| s.contains("no manifold")), "{said:?}");
        let empty = TriangleMesh::default();
        assert_eq!(remarks(&empty).unwrap_err().0, "the mesh has no triangles");
    }
}
