//! Subdivision of the region.

use crate::clay::Clay;
use crate::delta::Delta;
use crate::editor::Editor;
use crate::error::Error;
use mesh::{FaceId, HalfEdgeId, VertexId};

/// Way to refine the faces of the region.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refinement {
    /// Triangles become four by the middles of their edges (polygons get a centre vertex);
    /// neighbours are divided so that no face with more than three sides is left at the region.
    Propagate,
    /// Like [`Self::Propagate`], but neighbours outside the region stay one face and gain vertices.
    Local,
    /// Faces with more than three sides get a centre vertex; triangles stay.
    Polygons,
    /// Every face gets a centre vertex.
    Centers,
}

impl Refinement {
    /// The ways to refine, in the order of the manual.
    pub const ALL: [Self; 4] = [Self::Propagate, Self::Local, Self::Polygons, Self::Centers];

    /// Returns the word for it in texts of strokes.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Propagate => "propagate",
            Self::Local => "local",
            Self::Polygons => "polygons",
            Self::Centers => "centers",
        }
    }
}

impl Clay {
    /// Refines the region.
    ///
    /// # Errors
    /// If the mesh would become too large; then it is as it was before.
    pub fn refine(&mut self, how: Refinement) -> Result<(), Error> {
        self.refine_with(how).map(drop)
    }

    pub(crate) fn refine_with(&mut self, how: Refinement) -> Result<Delta, Error> {
        self.change(|clay| {
            let mut editor = Editor::new(clay);
            match how {
                Refinement::Propagate => editor.quarter(true)?,
                Refinement::Local => editor.quarter(false)?,
                Refinement::Polygons => editor.poke_all(4)?,
                Refinement::Centers => editor.poke_all(3)?,
            }
            editor.finish();
            Ok(())
        })
    }
}

/// An edge that was halved.
pub(crate) struct Halved {
    /// The half-edge that leads to the new vertex.
    pub edge: HalfEdgeId,
    pub middle: VertexId,
}

impl Editor<'_> {
    /// Gives all faces of the region with so many sides or more a centre vertex.
    pub fn poke_all(&mut self, sides: usize) -> Result<(), Error> {
        let mut faces = self.faces();
        let mesh = &self.clay.mesh;
        faces.retain(|f| mesh.face_degree(*f) >= sides);
        self.need_room(faces.iter().map(|f| mesh.face_degree(*f) - 1).sum())?;
        faces.into_iter().try_for_each(|f| self.poke(f))
    }

    /// The edges of the region's triangles, in ascending order.
    pub fn triangle_edges(&self) -> Vec<HalfEdgeId> {
        let mesh = &self.clay.mesh;
        let faces = self.faces();
        let triangles = faces.iter().filter(|f| mesh.face_degree(**f) == 3);
        let sides = triangles.flat_map(|f| mesh.face_half_edges(*f));
        let mut edges: Vec<HalfEdgeId> = sides.map(|h| HalfEdgeId(h.0 & !1)).collect();
        edges.sort_unstable();
        edges.dedup();
        edges
    }

    fn quarter(&mut self, propagates: bool) -> Result<(), Error> {
        let edges = self.triangle_edges();
        let halved = self.halve(&edges)?;
        self.divide_beside(&halved, propagates)
    }

    /// Halves edges.
    pub fn halve(&mut self, edges: &[HalfEdgeId]) -> Result<Vec<Halved>, Error> {
        let faces = self.faces();
        let polygons = faces.iter().map(|f| self.clay.mesh.face_degree(*f));
        let sides: usize = polygons.filter(|degree| *degree > 3).sum();
        // Each middle adds a face on either side.
        self.need_room(2 * edges.len() + sides)?;
        edges
            .iter()
            .map(|h| {
                let middle = self.split_edge(*h)?;
                Ok(Halved { edge: *h, middle })
            })
            .collect()
    }

    /// Divides the faces beside halved edges, and the region's polygons.
    pub fn divide_beside(&mut self, halved: &[Halved], propagates: bool) -> Result<(), Error> {
        let mut is_middle = vec![false; self.clay.mesh.vertex_slots()];
        for edge in halved {
            is_middle[edge.middle.index()] = true;
        }
        let mesh = &self.clay.mesh;
        let beside = halved.iter().flat_map(|e| [e.edge, mesh.twin(e.edge)]);
        let mut faces: Vec<FaceId> = beside.filter_map(|h| mesh.face(h)).collect();
        let region = self.faces().into_iter();
        faces.extend(region.filter(|f| mesh.face_degree(*f) > 3));
        faces.sort_unstable();
        faces.dedup();
        for f in faces {
            if propagates || self.is_in(f) {
                self.divide(f, &is_middle)?;
            }
        }
        Ok(())
    }

    /// Divides a triangle whose sides have middles, or any other face about its centre.
    fn divide(&mut self, f: FaceId, is_middle: &[bool]) -> Result<(), Error> {
        let mesh = &self.clay.mesh;
        let sides: Vec<HalfEdgeId> = mesh.face_half_edges(f).collect();
        let has_middle = |h: &HalfEdgeId| is_middle[mesh.origin(*h).index()];
        let middles = sides.iter().filter(|h| has_middle(h)).count();
        let first = match (sides.len() - middles, middles) {
            (3, 1 | 3) => sides.iter().position(has_middle),
            // Middle, corner, middle, corner, corner.
            (3, 2) => (0..5).find(|i| has_middle(&sides[*i]) && has_middle(&sides[(i + 2) % 5])),
            _ => None,
        };
        let Some(first) = first else {
            return self.poke(f);
        };
        let side = |i: usize| sides[(first + i) % sides.len()];
        let cut = match middles {
            1 => self.split_face(side(0), side(2)).map(drop),
            2 => self.cut_twice(side),
            _ => self.cut_corners(side),
        };
        // Faces between the same vertices cannot have the same edge twice; the new vertex in the
        // centre has none yet.
        cut.or_else(|_| {
            let rest = self.clay.mesh.face(side(middles));
            rest.map_or(Ok(()), |f| self.poke(f))
        })
    }

    /// Divides a triangle with two middles, from which the sides 0 and 2 leave: cuts off the corner
    /// between them, then divides the rest along its shorter diagonal.
    fn cut_twice(&mut self, side: impl Fn(usize) -> HalfEdgeId) -> Result<(), Error> {
        self.split_face(side(2), side(0))?;
        let mesh = &self.clay.mesh;
        let [a, b, c, d] = [0, 2, 3, 4].map(|i| mesh.position(mesh.origin(side(i))));
        let closing = mesh.next(side(4));
        if b.distance_squared(d) <= a.distance_squared(c) {
            self.split_face(side(4), side(2))?;
        } else {
            self.split_face(side(3), closing)?;
        }
        Ok(())
    }

    /// Cuts off the corners of a triangle with three middles, from which the sides 0, 2 and 4
    /// leave; the face keeps the triangle of the middles.
    fn cut_corners(&mut self, side: impl Fn(usize) -> HalfEdgeId) -> Result<(), Error> {
        self.split_face(side(2), side(0))?;
        self.split_face(side(4), side(2))?;
        let closing = self.clay.mesh.next(side(5));
        self.split_face(closing, side(4))?;
        Ok(())
    }
}
