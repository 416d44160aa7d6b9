//! Edits of elements that keep what is beside them: masks, colours, and which faces are in the
//! region.

use crate::clay::{Clay, Region, mean_color};
use crate::error::{Error, fail};
use crate::limits::MAX_FACES;
use glam::DVec3;
use mesh::{FaceId, HalfEdgeId, VertexId};

/// Clay whose elements are edited.
pub(crate) struct Editor<'a> {
    pub clay: &'a mut Clay,
    /// Tells of each face slot whether it is in the region.
    pub in_region: Vec<bool>,
    /// `true` if the region is all.
    is_all: bool,
}

impl<'a> Editor<'a> {
    pub fn new(clay: &'a mut Clay) -> Self {
        let slots = clay.mesh.face_slots();
        let (in_region, is_all) = match &clay.region {
            Region::All => (vec![true; slots], true),
            Region::Faces(faces) => {
                let mut flags = vec![false; slots];
                faces.iter().for_each(|f| flags[f.index()] = true);
                (flags, false)
            }
        };
        Self {
            clay,
            in_region,
            is_all,
        }
    }

    /// Writes the region back: the faces that are marked now.
    pub fn finish(self) {
        if !self.is_all {
            let faces = self.clay.mesh.faces();
            let kept = faces.filter(|f| self.in_region[f.index()]);
            self.clay.region = Region::Faces(kept.collect());
        }
    }

    pub fn is_in(&self, f: FaceId) -> bool {
        self.in_region[f.index()]
    }

    /// The faces of the region, in ascending order.
    pub fn faces(&self) -> Vec<FaceId> {
        let faces = self.clay.mesh.faces();
        faces.filter(|f| self.is_in(*f)).collect()
    }

    pub fn set_in(&mut self, f: FaceId, is_in: bool) {
        if self.in_region.len() <= f.index() {
            self.in_region.resize(f.index() + 1, false);
        }
        self.in_region[f.index()] = is_in;
    }

    /// The face on the left of a half-edge, if it is in the region.
    pub fn region_face(&self, h: HalfEdgeId) -> Option<FaceId> {
        self.clay.mesh.face(h).filter(|f| self.is_in(*f))
    }

    /// Gives a new vertex the means of others.
    pub fn set_mean(&mut self, v: VertexId, of: &[VertexId]) {
        let clay = &mut *self.clay;
        let colors: Vec<[f32; 3]> = of.iter().map(|v| clay.colors[v.index()]).collect();
        let masks: f64 = of.iter().map(|v| f64::from(clay.masks[v.index()])).sum();
        if clay.colors.len() <= v.index() {
            clay.colors.resize(v.index() + 1, [1.0; 3]);
            clay.masks.resize(v.index() + 1, 0.0);
        }
        clay.colors[v.index()] = mean_color(&colors);
        clay.masks[v.index()] = (masks / of.len().max(1) as f64) as f32;
    }

    /// Puts a vertex in the middle of an edge.
    pub fn split_edge(&mut self, h: HalfEdgeId) -> Result<VertexId, Error> {
        let mesh = &mut self.clay.mesh;
        let ends = [mesh.origin(h), mesh.target(h)];
        let middle = 0.5 * mesh.position(ends[0]) + 0.5 * mesh.position(ends[1]);
        let v = mesh.split_edge(h, middle)?;
        self.set_mean(v, &ends);
        Ok(v)
    }

    /// Divides a face by an edge between the origins of two of its half-edges; both parts are in
    /// the region if it was.
    pub fn split_face(&mut self, a: HalfEdgeId, b: HalfEdgeId) -> Result<FaceId, Error> {
        let old = self.clay.mesh.face(a);
        let new = self.clay.mesh.split_face(a, b)?;
        let is_in = old.is_some_and(|f| self.is_in(f));
        self.set_in(new, is_in);
        Ok(new)
    }

    /// Divides a face into triangles about a centre vertex: the mean of its vertices.
    pub fn poke(&mut self, f: FaceId) -> Result<(), Error> {
        let is_in = self.is_in(f);
        let corners: Vec<VertexId> = self.clay.mesh.face_vertices(f).collect();
        let count = corners.len() as f64;
        let center: DVec3 = corners
            .iter()
            .map(|v| self.clay.mesh.position(*v) / count)
            .sum();
        let v = self.clay.mesh.poke_face(f, center)?;
        self.set_mean(v, &corners);
        let faces: Vec<FaceId> = self.clay.mesh.vertex_faces(v).collect();
        for f in faces {
            self.set_in(f, is_in);
        }
        Ok(())
    }

    /// Refuses to go on if the mesh would have too many faces.
    pub fn need_room(&self, more: usize) -> Result<(), Error> {
        let faces = self.clay.mesh.face_count().saturating_add(more);
        if faces > MAX_FACES {
            return fail(format!(
                "this would be {faces} faces or so; a sculpture has at most {MAX_FACES}"
            ));
        }
        Ok(())
    }
}
