//! Cutting faces into triangles.

use super::connectivity::HalfEdgeMesh;
use super::id::{EditError, FaceId, HalfEdgeId};
use glam::DVec3;

/// Faces with more vertices get a centre vertex: choosing ears takes the cube of their number.
const MOST_EARS: usize = 64;

impl HalfEdgeMesh {
    /// Cuts a face into triangles: ears first whose smallest angle is largest, seen along the
    /// face's mean normal. A centre vertex is added where no ear is left that keeps a simple mesh,
    /// and to faces of more than 64 vertices.
    ///
    /// # Errors
    /// If there is no such face, or the mesh is full.
    pub fn triangulate_face(&mut self, f: FaceId) -> Result<(), EditError> {
        self.need(self.has_face(f))?;
        let degree = self.face_degree(f);
        self.need_room(2 * degree)?;
        if degree > MOST_EARS {
            let center = self.loop_center(self.face_first(f));
            return self.poke_face(f, center).map(drop);
        }
        for _ in 3..degree {
            let Some((before, after)) = self.best_ear(f) else {
                let center = self.loop_center(self.face_first(f));
                return self.poke_face(f, center).map(drop);
            };
            // The face keeps what is left; the ear becomes a new one.
            self.split_face(after, before)?;
        }
        Ok(())
    }

    /// Cuts all faces into triangles.
    ///
    /// # Errors
    /// If the mesh is full; then some faces are cut and others are not.
    pub fn triangulate(&mut self) -> Result<(), EditError> {
        let faces: Vec<FaceId> = self.faces().collect();
        for f in faces {
            if self.face_degree(f) > 3 {
                self.triangulate_face(f)?;
            }
        }
        Ok(())
    }

    fn face_first(&self, f: FaceId) -> HalfEdgeId {
        HalfEdgeId(self.face_first[f.index()])
    }

    /// The sum of the areas of a face's triangles about its centre, as a vector along its mean
    /// normal (Newell's normal); its length is twice the area of a flat face.
    #[must_use]
    pub fn face_normal(&self, f: FaceId) -> DVec3 {
        let origin = self.position(self.origin(self.face_first(f)));
        self.face_half_edges(f)
            .map(|h| {
                let [a, b] = [self.origin(h), self.target(h)].map(|v| self.position(v) - origin);
                a.cross(b)
            })
            .sum()
    }

    /// The half-edges from which and to which the diagonal of the best ear goes: the ear's first,
    /// and the one after its last.
    fn best_ear(&self, f: FaceId) -> Option<(HalfEdgeId, HalfEdgeId)> {
        let normal = self.face_normal(f);
        let sides: Vec<HalfEdgeId> = self.face_half_edges(f).collect();
        let n = sides.len();
        let places: Vec<DVec3> = (0..=2 * n)
            .map(|i| self.position(self.origin(sides[i % n])))
            .collect();
        let mut best: Option<(f64, usize)> = None;
        for i in 0..n {
            let ear = [places[i], places[i + 1], places[i + 2]];
            let quality = ear_quality(&ear, normal);
            let is_better = quality > 0.0 && best.is_none_or(|(most, _)| quality > most);
            if is_better
                && !(i + 3..i + n).any(|k| contains(&ear, places[k], normal))
                && !self.are_joined(self.origin(sides[i]).0, self.origin(sides[(i + 2) % n]).0)
            {
                best = Some((quality, i));
            }
        }
        best.map(|(_, i)| (sides[i], sides[(i + 2) % n]))
    }
}

/// Returns a measure of the smallest angle of a triangle; negative if it is turned against the
/// normal.
fn ear_quality([a, b, c]: &[DVec3; 3], normal: DVec3) -> f64 {
    let area = (*b - *a).cross(*c - *a);
    let longest = [*a - *b, *b - *c, *c - *a]
        .map(DVec3::length_squared)
        .into_iter()
        .fold(0.0, f64::max);
    let sides = a.distance(*b) + b.distance(*c) + c.distance(*a);
    let quality = area.length() / (longest.sqrt() * sides).max(f64::MIN_POSITIVE);
    if area.dot(normal) > 0.0 {
        quality
    } else {
        -1.0
    }
}

/// `true` if a point lies in a triangle, its sides included, seen along a normal.
fn contains([a, b, c]: &[DVec3; 3], p: DVec3, normal: DVec3) -> bool {
    [(a, b), (b, c), (c, a)]
        .iter()
        .all(|(from, to)| (**to - **from).cross(p - **from).dot(normal) >= 0.0)
}
