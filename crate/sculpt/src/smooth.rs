//! Smoothing of the region: Loop's subdivision, and averaging.

use crate::clay::Clay;
use crate::delta::Delta;
use crate::editor::Editor;
use crate::error::{Error, fail};
use crate::limits::MAX_LEVELS;
use core::f64::consts::TAU;
use glam::DVec3;
use mesh::{HalfEdgeId, HalfEdgeMesh, VertexId};

impl Clay {
    /// Subdivides the region by Loop's scheme, so many times. Polygons are divided about their
    /// centres first. Vertices with faces outside the region stay; edges between inside and outside
    /// are halved. Where the mesh ends, so does the scheme of curves: (1, 6, 1)/8. Masks hold
    /// vertices back.
    ///
    /// # Errors
    /// If the mesh would become too large; then it is as it was before.
    pub fn smooth_loop(&mut self, levels: u32) -> Result<(), Error> {
        self.smooth_loop_with(levels).map(drop)
    }

    pub(crate) fn smooth_loop_with(&mut self, levels: u32) -> Result<Delta, Error> {
        if levels > MAX_LEVELS {
            return fail(format!("at most {MAX_LEVELS} levels"));
        }
        self.change(|clay| {
            let mut editor = Editor::new(clay);
            for _ in 0..levels {
                editor.poke_all(4)?;
                editor.loop_level()?;
            }
            editor.finish();
            Ok(())
        })
    }

    /// Moves the vertices of the region towards the mean of their neighbours by a share, so many
    /// times. Vertices with faces outside the region stay; those at an end of the mesh move along
    /// it only. Masks hold vertices back.
    ///
    /// # Errors
    /// If there are too many levels.
    pub fn average(&mut self, levels: u32, share: f64) -> Result<(), Error> {
        self.average_with(levels, share).map(drop)
    }

    pub(crate) fn average_with(&mut self, levels: u32, share: f64) -> Result<Delta, Error> {
        if levels > MAX_LEVELS {
            return fail(format!("at most {MAX_LEVELS} levels"));
        }
        let editor = Editor::new(self);
        let inner = editor.inner_vertices();
        let mut moved: Vec<(u32, DVec3)> = inner
            .iter()
            .map(|v| (v.0, self.mesh.position(*v)))
            .collect();
        for _ in 0..levels {
            self.work += inner.len() as u64;
            let places: Vec<DVec3> = inner
                .iter()
                .map(|v| {
                    let p = self.mesh.position(*v);
                    let free = 1.0 - f64::from(self.mask(*v));
                    p + (mean_of_neighbors(&self.mesh, *v) - p) * (share * free)
                })
                .collect();
            for (v, place) in inner.iter().zip(places) {
                if self.mask(*v) < 1.0 {
                    self.replace_position(v.0, place);
                }
            }
        }
        moved.retain(|(v, old)| {
            let new = self.mesh.position(VertexId(*v));
            old.to_array().map(f64::to_bits) != new.to_array().map(f64::to_bits)
        });
        Ok(Delta {
            moved,
            ..Delta::default()
        })
    }
}

/// The mean of a vertex's neighbours; at an end of the mesh of the two along it.
pub(crate) fn mean_of_neighbors(mesh: &HalfEdgeMesh, v: VertexId) -> DVec3 {
    if mesh.is_boundary_vertex(v) {
        let [a, b] = ends_beside(mesh, v);
        return 0.5 * (a + b);
    }
    let (mut sum, mut count) = (DVec3::ZERO, 0.0);
    for n in mesh.neighbors(v) {
        sum += mesh.position(n);
        count += 1.0;
    }
    sum / count
}

/// The neighbours of a boundary vertex along the boundary.
fn ends_beside(mesh: &HalfEdgeMesh, v: VertexId) -> [DVec3; 2] {
    let bare = mesh.outgoing(v);
    let before = mesh.origin(mesh.previous(bare));
    [mesh.position(mesh.target(bare)), mesh.position(before)]
}

impl Editor<'_> {
    /// The vertices all of whose faces are in the region, in ascending order.
    pub fn inner_vertices(&self) -> Vec<VertexId> {
        let mesh = &self.clay.mesh;
        mesh.vertices()
            .filter(|v| mesh.vertex_faces(*v).all(|f| self.is_in(f)))
            .collect()
    }

    /// Subdivides once.
    fn loop_level(&mut self) -> Result<(), Error> {
        let vertices = self.inner_vertices();
        let moved: Vec<(VertexId, DVec3)> = vertices
            .iter()
            .map(|v| {
                let (p, free) = (self.clay.mesh.position(*v), self.freedom(&[*v]));
                (*v, p + (loop_vertex(&self.clay.mesh, *v) - p) * free)
            })
            .collect();
        let edges = self.triangle_edges();
        let middles: Vec<DVec3> = edges.iter().map(|h| self.loop_edge(*h)).collect();
        let halved = self.halve(&edges)?;
        for (edge, middle) in halved.iter().zip(middles) {
            self.clay.mesh.set_position(edge.middle, middle)?;
        }
        for (v, place) in moved {
            if self.clay.mask(v) < 1.0 {
                self.clay.mesh.set_position(v, place)?;
            }
        }
        self.divide_beside(&halved, true)
    }

    /// Returns the share of a motion that vertices take: one less the mean of their masks.
    fn freedom(&self, vertices: &[VertexId]) -> f64 {
        let masks = vertices.iter().map(|v| f64::from(self.clay.mask(*v)));
        1.0 - masks.sum::<f64>() / vertices.len() as f64
    }

    /// The place of an edge's new vertex.
    fn loop_edge(&self, h: HalfEdgeId) -> DVec3 {
        let mesh = &self.clay.mesh;
        let ends = [mesh.origin(h), mesh.target(h)];
        let sum = mesh.position(ends[0]) + mesh.position(ends[1]);
        let middle = 0.5 * mesh.position(ends[0]) + 0.5 * mesh.position(ends[1]);
        let sides = [h, mesh.twin(h)];
        if sides.iter().any(|side| self.region_face(*side).is_none()) {
            return middle;
        }
        let [c, d] = sides.map(|side| mesh.position(mesh.origin(mesh.previous(side))));
        let place = sum * 0.375 + (c + d) * 0.125;
        middle + (place - middle) * self.freedom(&ends)
    }
}

/// The new place of an old vertex by Loop's scheme (1987): `(1 − nβ)·v + β·Σ neighbours` with
/// `β = (5/8 − (3/8 + cos(2π/n)/4)²)/n`.
fn loop_vertex(mesh: &HalfEdgeMesh, v: VertexId) -> DVec3 {
    let p = mesh.position(v);
    if mesh.is_boundary_vertex(v) {
        let [a, b] = ends_beside(mesh, v);
        return 0.75 * p + 0.125 * (a + b);
    }
    let n = mesh.degree(v) as f64;
    let c = 0.375 + 0.25 * libm::cos(TAU / n);
    let beta = (0.625 - c * c) / n;
    let sum: DVec3 = mesh.neighbors(v).map(|n| mesh.position(n)).sum();
    p * (1.0 - n * beta) + sum * beta
}
