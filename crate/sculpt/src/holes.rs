//! Filling holes, deleting and simplifying the region.

use crate::clay::{Clay, Region, mean_color};
use crate::delta::Delta;
use crate::editor::Editor;
use crate::error::{Error, fail};
use crate::limits::MAX_SIDES;
use mesh::{FaceId, HalfEdgeId, VertexId};
use std::collections::BTreeSet;

/// Remainder of a region that is deleted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Deletion {
    /// Faces: one in place of each connected part.
    Face,
    /// Holes.
    Hole,
}

impl Deletion {
    /// The choices, in the order of the manual.
    pub const ALL: [Self; 2] = [Self::Face, Self::Hole];

    /// Returns the word for it in texts of strokes.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Face => "face",
            Self::Hole => "hole",
        }
    }
}

impl Clay {
    /// Closes the holes beside the region by triangles about a centre vertex, the mean of the
    /// vertices around. The triangles belong to the region.
    ///
    /// # Errors
    /// If the mesh would become too large; then it is as it was before.
    pub fn fill_holes(&mut self) -> Result<(), Error> {
        self.fill_holes_with().map(drop)
    }

    pub(crate) fn fill_holes_with(&mut self) -> Result<Delta, Error> {
        self.change(|clay| {
            let mut editor = Editor::new(clay);
            for h in editor.clay.mesh.boundary_loops() {
                let mesh = &editor.clay.mesh;
                let around: Vec<HalfEdgeId> = mesh.loop_half_edges(h).collect();
                if around
                    .iter()
                    .any(|h| editor.region_face(mesh.twin(*h)).is_some())
                {
                    editor.need_room(around.len())?;
                    let corners: Vec<VertexId> = around.iter().map(|h| mesh.origin(*h)).collect();
                    let center = editor.clay.mesh.fill_hole(h)?;
                    editor.set_mean(center, &corners);
                    let faces: Vec<FaceId> = editor.clay.mesh.vertex_faces(center).collect();
                    faces.into_iter().for_each(|f| editor.set_in(f, true));
                }
            }
            editor.finish();
            Ok(())
        })
    }

    /// Deletes the region, but for faces with a vertex whose mask is 1. Of a region deleted to one
    /// face, the new faces are the region then; after a deletion to a hole it is all.
    ///
    /// # Errors
    /// If nothing would be left; if a part that should become one face has a hole or ends with the
    /// mesh. Then all is as it was before.
    pub fn delete(&mut self, to: Deletion) -> Result<(), Error> {
        self.delete_with(to).map(drop)
    }

    pub(crate) fn delete_with(&mut self, to: Deletion) -> Result<Delta, Error> {
        self.change(|clay| {
            let faces = clay.free_faces();
            if faces.len() == clay.mesh.face_count() {
                return fail("nothing would be left: choose a region first");
            }
            match to {
                Deletion::Hole => {
                    clay.remove_faces(&faces)?;
                    clay.region = Region::All;
                }
                Deletion::Face => {
                    let mut made = Vec::new();
                    for part in clay.parts(&faces) {
                        made.push(clay.merge(&part)?);
                    }
                    made.sort_unstable();
                    clay.region = Region::Faces(made);
                }
            }
            Ok(())
        })
    }

    /// Simplifies the region to a share of its faces: edges are collapsed, those first that change
    /// the shape least. Vertices with faces outside the region or a mask of 1 stay.
    ///
    /// # Errors
    /// If there is no such share.
    pub fn simplify(&mut self, share: f64) -> Result<(), Error> {
        self.simplify_with(share).map(drop)
    }

    pub(crate) fn simplify_with(&mut self, share: f64) -> Result<Delta, Error> {
        if !(0.0..=1.0).contains(&share) {
            return fail("a share is from 0 to 1");
        }
        self.change(|clay| {
            let editor = Editor::new(clay);
            let mut is_free = vec![false; editor.clay.mesh.vertex_slots()];
            for v in editor.inner_vertices() {
                is_free[v.index()] = editor.clay.mask(v) < 1.0;
            }
            let before = editor.faces().len() as f64;
            let fewer = (before - before * share) as usize;
            let target = editor.clay.mesh.face_count() - fewer;
            let Clay {
                mesh,
                colors,
                masks,
                ..
            } = &mut *editor.clay;
            mesh::simplify_part(
                mesh,
                target,
                |v| is_free[v.index()],
                |gone, kept| {
                    let [a, b] = [gone.index(), kept.index()];
                    colors[b] = mean_color(&[colors[a], colors[b]]);
                    masks[b] = masks[b].max(masks[a]);
                },
            );
            editor.finish();
            Ok(())
        })
    }

    /// The faces of the region without a vertex whose mask is 1.
    fn free_faces(&self) -> Vec<FaceId> {
        let mut faces = self.region_faces();
        faces.retain(|f| self.mesh.face_vertices(*f).all(|v| self.mask(v) < 1.0));
        faces
    }

    fn remove_faces(&mut self, faces: &[FaceId]) -> Result<(), Error> {
        for made in self.mesh.delete_faces(faces)? {
            let [old, new] = [made.original.index(), made.copy.index()];
            let slots = self.mesh.vertex_slots();
            self.colors.resize(slots, [1.0; 3]);
            self.masks.resize(slots, 0.0);
            self.colors[new] = self.colors[old];
            self.masks[new] = self.masks[old];
        }
        Ok(())
    }

    /// The parts of a set of faces that are connected by edges, in the order of their lowest faces.
    fn parts(&self, faces: &[FaceId]) -> Vec<Vec<FaceId>> {
        let mut left: BTreeSet<FaceId> = faces.iter().copied().collect();
        let mut parts = Vec::new();
        while let Some(first) = left.pop_first() {
            let mut part = vec![first];
            let mut done = 0;
            while done < part.len() {
                for h in self.mesh.face_half_edges(part[done]) {
                    let across = self.mesh.face(self.mesh.twin(h));
                    part.extend(across.filter(|f| left.remove(f)));
                }
                done += 1;
            }
            parts.push(part);
        }
        parts
    }

    /// Makes one face of a connected part that is a disc.
    fn merge(&mut self, part: &[FaceId]) -> Result<FaceId, Error> {
        let mesh = &self.mesh;
        let sides = || part.iter().flat_map(|f| mesh.face_half_edges(*f));
        let own: BTreeSet<FaceId> = part.iter().copied().collect();
        if sides().any(|h| mesh.is_boundary_edge(h)) {
            return fail(
                "a part of the region ends with the mesh and cannot become one face: fill the hole \
                 first, or use `delete hole`",
            );
        }
        let vertices: BTreeSet<VertexId> = sides().map(|h| mesh.origin(h)).collect();
        let rim: Vec<HalfEdgeId> = sides()
            .filter(|h| match mesh.face(mesh.twin(*h)) {
                Some(f) => !own.contains(&f),
                None => true,
            })
            .collect();
        // Inner edges come twice.
        let edges = (sides().count() - rim.len()) / 2 + rim.len();
        let euler = (vertices.len() + part.len()) as i64 - edges as i64;
        let corners: BTreeSet<VertexId> = rim.iter().map(|h| mesh.origin(*h)).collect();
        if euler != 1 || corners.len() != rim.len() {
            return fail(
                "a part of the region has a hole, or is all of a body, and cannot become one face",
            );
        }
        if rim.len() > MAX_SIDES {
            return fail(format!("a face has at most {MAX_SIDES} sides"));
        }
        // Where the faces around form another fan at a corner, or the hole would be that of two
        // faces, all is refused.
        let first = rim[0];
        let copies = self.mesh.delete_faces(part)?;
        if !copies.is_empty() || !self.mesh.has_half_edge(first) {
            return fail(
                "a part of the region cannot become one face: faces around it would fall apart",
            );
        }
        Ok(self.mesh.close_hole(first)?)
    }
}
