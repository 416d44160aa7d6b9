//! `LevelSet` of manifold-rust, with the field evaluated by the terms that matter in each cell of a
//! grid.

use field::{Ball, Implicit, Part, Slack, THRESHOLD};
use glam::DVec3;
use manifold_rust::linalg::Vec3;
use manifold_rust::manifold::Manifold;
use manifold_rust::sdf::level_set;
use manifold_rust::types::Box as Bounds;
use mesh::{Aabb, TriangleMesh};

/// Cells of the grid along the longest side.
const GRID: f64 = 24.0;
/// The bound on terms that are left out in a cell; polynomials stand for none.
const SLACK: Slack = Slack {
    left_out: 1e-7,
    far: 0.0,
};

/// Makes the mesh in a box with cubes of an edge length, vertices within `precision` of the
/// surface.
pub fn mesh(grid: &Grid, bounds: &Aabb, edge: f64, precision: f64) -> TriangleMesh {
    let bounds = Bounds::from_points(vector(bounds.min), vector(bounds.max));
    let value = |p: Vec3| grid.value(DVec3::new(p.x, p.y, p.z)) - THRESHOLD;
    let made = Manifold::from_impl(level_set(value, bounds, edge, 0.0, precision));
    let gl = made.get_mesh_gl64(-1);
    let positions = gl.vert_properties.chunks_exact(gl.num_prop as usize);
    let triangles = gl.tri_verts.chunks_exact(3);
    TriangleMesh::new(
        positions.map(|v| DVec3::new(v[0], v[1], v[2])).collect(),
        triangles
            .map(|t| [t[0], t[1], t[2]].map(|i| i as u32))
            .collect(),
    )
}

fn vector(p: DVec3) -> Vec3 {
    Vec3::new(p.x, p.y, p.z)
}

/// A grid of the terms that matter in each of its cells.
pub struct Grid<'a> {
    function: &'a dyn Implicit,
    low: DVec3,
    size: f64,
    counts: [usize; 3],
    parts: Vec<Option<Part>>,
}

impl<'a> Grid<'a> {
    /// Prepares the cells of a box.
    pub fn new(function: &'a dyn Implicit, bounds: &Aabb) -> Self {
        let size = bounds.size().max_element() / GRID;
        let counts = (bounds.size() / size)
            .ceil()
            .to_array()
            .map(|n| n as usize + 1);
        let mut parts = Vec::new();
        for z in 0..counts[2] {
            for y in 0..counts[1] {
                for x in 0..counts[0] {
                    let at = DVec3::new(x as f64, y as f64, z as f64) + 0.5;
                    let ball = Ball {
                        center: bounds.min + at * size,
                        radius: 0.87 * size,
                    };
                    parts.push(function.narrow(ball, None, SLACK));
                }
            }
        }
        Self {
            function,
            low: bounds.min,
            size,
            counts,
            parts,
        }
    }

    fn value(&self, point: DVec3) -> f64 {
        let at = ((point - self.low) / self.size).floor().to_array();
        let inside = (0..3).all(|i| at[i] >= 0.0 && at[i] < self.counts[i] as f64);
        let index = || {
            let [x, y, z] = at.map(|x| x as usize);
            (z * self.counts[1] + y) * self.counts[0] + x
        };
        match inside.then(|| self.parts[index()].as_ref()).flatten() {
            Some(part) => self.function.jet_of(part, point).value,
            None => self.function.jet(point).value,
        }
    }
}
