//! Repairs of a coarse mesh at the few places where it is too far from the surface: the surface's
//! place there becomes a vertex, and edges around it are flipped.

use crate::certify::{Vertex, sag};
use crate::improve::sine;
use glam::DVec3;
use mesh::{FaceId, HalfEdgeId, HalfEdgeMesh, TriangleMesh, VertexId, closest_point};

/// Least barycentric weight of a place within a triangle; those beyond are on its edge.
const WITHIN: f64 = 0.15;
/// Least growth of the sine of the smallest angle at a flip.
const BETTER: f64 = 1.1;
/// Least cosine of the angle between a triangle's normal and the surface's at its corners.
const FACING: f64 = 0.5;
/// Largest height of the surface's arc over an edge, in tolerances.
const SAG: f64 = 0.6;
/// Most edges that are looked at around a new vertex.
const MOST: usize = 32;

/// A mesh that is being mended.
struct Mending {
    mesh: HalfEdgeMesh,
    vertices: Vec<Vertex>,
    /// Faces that are not those of the mesh before.
    is_changed: Vec<bool>,
    tolerance: f64,
}

/// Puts places of the surface into a mesh, each into a triangle that is near it, one at most into
/// each; `None` if none could be.
pub fn mend(mesh: &TriangleMesh, gaps: &[(u32, Vertex)], tolerance: f64) -> Option<TriangleMesh> {
    let corners = mesh.positions.iter().zip(mesh.normals.as_ref()?);
    let vertices = corners.map(|(position, normal)| Vertex {
        position: *position,
        value: 0.0,
        gradient: -*normal,
    });
    let mut mending = Mending {
        mesh: HalfEdgeMesh::from_triangles(mesh).ok()?,
        vertices: vertices.collect(),
        is_changed: vec![false; mesh.triangles.len()],
        tolerance,
    };
    let mut count = 0;
    for (triangle, vertex) in gaps {
        count += usize::from(mending.add(FaceId(*triangle), vertex).is_some());
    }
    if count == 0 {
        return None;
    }
    let mut mended = mending.mesh.to_triangles().ok()?;
    mended.normals = Some(mending.vertices.iter().map(Vertex::normal).collect());
    Some(mended)
}

/// Returns the number of the old triangle with the same corners, for each new one.
pub fn match_triangles(old: &[[u32; 3]], new: &[[u32; 3]]) -> Vec<Option<u32>> {
    /// Turns a triangle so that its least corner is the first.
    fn turn(mut triangle: [u32; 3]) -> [u32; 3] {
        while triangle[0] > triangle[1].min(triangle[2]) {
            triangle.rotate_left(1);
        }
        triangle
    }
    let mut sorted: Vec<([u32; 3], u32)> = (0..).zip(old).map(|(i, t)| (turn(*t), i)).collect();
    sorted.sort_unstable();
    let found = new.iter().map(|triangle| {
        let place = sorted.binary_search_by_key(&turn(*triangle), |(own, _)| *own);
        place.ok().map(|place| sorted[place].1)
    });
    found.collect()
}

impl Mending {
    fn corners(&self, f: FaceId) -> Option<[VertexId; 3]> {
        let mut all = self.mesh.face_vertices(f);
        Some([all.next()?, all.next()?, all.next()?])
    }

    fn positions(&self, corners: [VertexId; 3]) -> [DVec3; 3] {
        corners.map(|v| self.mesh.position(v))
    }

    /// Whether triangles from some edges to a new vertex look outward there.
    fn faces_outward(&self, edges: &[[VertexId; 2]], vertex: &Vertex) -> bool {
        edges.iter().all(|ends| {
            let [a, b] = ends.map(|v| self.mesh.position(v));
            (b - a).cross(vertex.position - a).dot(vertex.normal()) > 0.0
        })
    }

    /// Puts a vertex into a face, or onto one of its edges.
    fn add(&mut self, f: FaceId, vertex: &Vertex) -> Option<()> {
        if self.is_changed[f.index()] {
            return None;
        }
        let corners = self.corners(f)?;
        let triangle = self.positions(corners);
        let weights = weigh(&triangle, closest_point(&triangle, vertex.position));
        let beyond: Vec<usize> = (0..3).filter(|i| weights[*i] < WITHIN).collect();
        let [a, b, c] = corners;
        let v = match beyond[..] {
            [] if self.faces_outward(&[[a, b], [b, c], [c, a]], vertex) => {
                self.mesh.poke_face(f, vertex.position).ok()?
            }
            [i] => {
                let [from, to] = [1, 2].map(|k| corners[(i + k) % 3]);
                let h = self.mesh.find_half_edge(from, to)?;
                let twin = self.mesh.twin(h);
                if self.is_changed[self.mesh.face(twin)?.index()] {
                    return None;
                }
                let [one, other] = [corners[i], self.mesh.target(self.mesh.next(twin))];
                let edges = [[to, one], [one, from], [from, other], [other, to]];
                if !self.faces_outward(&edges, vertex) {
                    return None;
                }
                self.mesh.bisect_edge(h, vertex.position).ok()?
            }
            // Beside a corner it would make triangles that are too narrow. On another part of the
            // surface, some that look inward.
            _ => return None,
        };
        self.vertices.push(*vertex);
        self.is_changed.resize(self.mesh.face_slots(), true);
        let mut open = Vec::new();
        for h in self.mesh.vertex_half_edges(v) {
            self.is_changed[self.mesh.face(h)?.index()] = true;
            open.push(self.mesh.next(h));
        }
        for _ in 0..MOST {
            let Some(h) = open.pop() else {
                break;
            };
            if let Some(beside) = self.flip(h) {
                open.extend(beside);
            }
        }
        Some(())
    }

    /// Flips an edge opposite a new vertex if that makes better triangles, and returns the two
    /// edges that are opposite it then.
    fn flip(&mut self, h: HalfEdgeId) -> Option<[HalfEdgeId; 2]> {
        let mesh = &self.mesh;
        let twin = mesh.twin(h);
        let faces = [mesh.face(h)?, mesh.face(twin)?];
        let (p, q) = (mesh.origin(h), mesh.target(h));
        let (r, s) = (mesh.target(mesh.next(h)), mesh.target(mesh.next(twin)));
        if mesh.degree(p).min(mesh.degree(q)) <= 3 {
            return None;
        }
        let [old, new] = [[[p, q, r], [q, p, s]], [[s, r, p], [r, s, q]]];
        let [before, after] = [old, new].map(|[a, b]| {
            let [a, b] = [a, b].map(|t| sine(self.positions(t)));
            a.min(b)
        });
        let [one, other] = [r, s].map(|v| &self.vertices[v.index()]);
        let is_low = sag(one, other) <= SAG * self.tolerance;
        let is_sound = new.iter().all(|corners| {
            let [a, b, c] = self.positions(*corners);
            let area = (b - a).cross(c - a);
            corners.iter().all(|v| {
                let normal = self.vertices[v.index()].normal();
                area.dot(normal) > FACING * area.length()
            })
        });
        if after < BETTER * before || !is_low || !is_sound {
            return None;
        }
        self.mesh.flip_edge(h).ok()?;
        for f in faces {
            self.is_changed[f.index()] = true;
        }
        let mesh = &self.mesh;
        Some([mesh.find_half_edge(p, s)?, mesh.find_half_edge(s, q)?])
    }
}

/// Barycentric weights of a point of a triangle.
fn weigh([a, b, c]: &[DVec3; 3], point: DVec3) -> [f64; 3] {
    let normal = (b - a).cross(c - a);
    let area = normal.length_squared();
    [(b, c), (c, a), (a, b)].map(|(from, to)| {
        let own = (*to - *from).cross(point - *from).dot(normal);
        own / area
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An icosahedron whose corners are on the unit sphere.
    fn ball() -> TriangleMesh {
        let g = 0.5 * (1.0 + 5.0_f64.sqrt());
        let corners = (0..12).map(|i| {
            let [one, other] = [1, 2].map(|bit| if i & bit == 0 { 1.0 } else { -1.0 });
            let mut corner = [0.0, one, g * other];
            corner.rotate_right(i / 4);
            DVec3::from(corner).normalize()
        });
        let positions: Vec<DVec3> = corners.collect();
        let mut triangles = Vec::new();
        let edge = 2.0 / (1.0 + g * g).sqrt();
        for i in 0..12 {
            for j in i + 1..12 {
                for k in j + 1..12 {
                    let [a, b, c] = [i, j, k].map(|v| positions[v]);
                    let sides = [a.distance(b), b.distance(c), c.distance(a)];
                    if sides.iter().all(|side| (side - edge).abs() < 0.1) {
                        let is_out = (b - a).cross(c - a).dot(a) > 0.0;
                        let [j, k] = if is_out { [j, k] } else { [k, j] };
                        triangles.push([i, j, k].map(|v| v as u32));
                    }
                }
            }
        }
        let mut mesh = TriangleMesh::new(positions.clone(), triangles);
        mesh.normals = Some(positions);
        mesh
    }

    fn on_ball(place: DVec3) -> Vertex {
        let position = place.normalize();
        Vertex {
            position,
            value: 0.0,
            gradient: -position,
        }
    }

    /// Places within triangles, on their edges and at their corners: the mesh stays closed, grows
    /// toward the ball, and tells which of its triangles are the old ones.
    #[test]
    fn places_become_vertices_and_the_rest_stays() {
        let mesh = ball();
        assert_eq!(mesh.triangles.len(), 20);
        let [a, b, c] = mesh.corners(3);
        for (place, faces) in [
            ((a + b + c) / 3.0, Some(22)),
            (0.5 * (a + b), Some(22)),
            (0.49 * a + 0.49 * b + 0.02 * c, Some(22)),
            (0.95 * a + 0.03 * b + 0.02 * c, None),
        ] {
            let vertex = on_ball(place);
            // Twice into the same triangle counts once.
            let mended = mend(&mesh, &[(3, vertex), (3, vertex)], 1.0);
            assert_eq!(mended.as_ref().map(|own| own.triangles.len()), faces);
            let Some(mended) = mended else {
                continue;
            };
            assert_eq!(mended.positions.len(), 13);
            assert_eq!(mended.positions[12], vertex.position);
            assert!(mended.signed_volume() > mesh.signed_volume());
            assert!(HalfEdgeMesh::from_triangles(&mended).unwrap().is_closed());
            let matches = match_triangles(&mesh.triangles, &mended.triangles);
            let mut same = 0;
            for (i, old) in matches.iter().enumerate() {
                let has_new = mended.triangles[i].contains(&12);
                assert!(!(has_new && old.is_some()));
                if let Some(old) = old {
                    let [mut one, mut other] = [mended.triangles[i], mesh.triangles[*old as usize]];
                    one.sort_unstable();
                    other.sort_unstable();
                    assert_eq!(one, other);
                    same += 1;
                }
            }
            let new = mended.triangles.iter().filter(|t| t.contains(&12));
            assert_eq!(same + new.count(), 22);
        }
    }

    /// Places of another sheet, which looks the other way, are not taken.
    #[test]
    fn places_of_other_sheets_are_left() {
        let mesh = ball();
        let [a, b, c] = mesh.corners(3);
        for place in [(a + b + c) / 3.0, 0.5 * (a + b)] {
            let mut vertex = on_ball(place);
            assert!(mend(&mesh, &[(3, vertex)], 1.0).is_some());
            vertex.gradient = -vertex.gradient;
            assert!(mend(&mesh, &[(3, vertex)], 1.0).is_none());
        }
    }

    /// Flips around a new vertex beside an edge make its smallest angle larger.
    #[test]
    fn narrow_triangles_are_flipped() {
        let mesh = ball();
        let [a, b, c] = mesh.corners(0);
        let vertex = on_ball(0.4 * a + 0.4 * b + 0.2 * c);
        let [low, high] = [0.0, 1.0].map(|tolerance| {
            let mended = mend(&mesh, &[(0, vertex)], tolerance).unwrap();
            let sines = (0..mended.triangles.len()).map(|i| sine(mended.corners(i)));
            sines.fold(1.0, f64::min)
        });
        // Without tolerance no edge is low enough.
        assert!(high > 1.05 * low);
    }
}
