//! Meshes with fewer triangles: edges are collapsed, those first that cost least by their quadrics
//! (Garland and Heckbert 1997).

use crate::bvh::Bvh;
use crate::error::{Error, fail};
use crate::half_edge::{HalfEdgeId, HalfEdgeMesh, VertexId};
use crate::measure::closest_point;
use crate::triangle_mesh::TriangleMesh;
use core::cmp::Ordering;
use glam::{DMat3, DVec3};
use std::collections::BinaryHeap;

/// Simplified mesh with its distance from the one it was made of.
#[derive(Clone, Debug, PartialEq)]
pub struct Level {
    /// The mesh, with normals and colours if the first has them; without groups.
    pub mesh: TriangleMesh,
    /// The largest distance found from vertices, middles of edges and middles of triangles of
    /// either mesh to the other, in the mesh's unit. Measured at these points, not proved between
    /// them.
    pub error: f64,
}

/// Levels of detail of a manifold mesh: each has a quarter of the triangles of the one before, down
/// to `least` triangles or as few as a simple mesh of the same topology allows. The mesh itself is
/// not among them.
///
/// ```
/// use mesh::{Format, levels_of_detail};
/// # let corner = |i: u32| glam::DVec3::new(f64::from(i % 21), f64::from(i / 21), 0.0);
/// # let mut mesh = mesh::TriangleMesh::new((0..441).map(corner).collect(), vec![]);
/// # for i in (0..420).filter(|i| i % 21 < 20) {
/// #     mesh.triangles.extend([[i, i + 1, i + 22], [i, i + 22, i + 21]]);
/// # }
/// // A flat square of 800 triangles.
/// let levels = levels_of_detail(&mesh, 20)?;
/// assert_eq!(levels.len(), 3);
/// assert!(levels[1].mesh.triangles.len() <= 50);
/// assert!(levels[1].error < 1e-6);
/// # Ok::<(), mesh::Error>(())
/// ```
///
/// # Errors
/// If the mesh is no manifold (see [`HalfEdgeMesh::from_polygons`]).
pub fn levels_of_detail(mesh: &TriangleMesh, least: usize) -> Result<Vec<Level>, Error> {
    let mut coarse = HalfEdgeMesh::from_triangles(mesh)?;
    let first = Surface::new(mesh);
    let mut levels: Vec<Level> = Vec::new();
    loop {
        let before = coarse.face_count();
        let target = (before / 4).max(least);
        if target >= before {
            return Ok(levels);
        }
        simplify(&mut coarse, target);
        if coarse.face_count() == before {
            return Ok(levels);
        }
        let triangles = coarse.to_triangles();
        let mut level = triangles.map_err(|error| Error(error.to_string()))?;
        let error = first
            .farthest(&level)
            .max(Surface::new(&level).farthest(mesh));
        if !error.is_finite() {
            return fail("the simplified mesh has no distance from the first");
        }
        first.transfer(&mut level);
        levels.push(Level { mesh: level, error });
    }
}

/// Collapses edges of a triangle mesh, the cheapest first, until `target` faces or fewer are left,
/// or no edge can be collapsed: the topology stays, and no triangle turns by more than 78° at once.
pub fn simplify(mesh: &mut HalfEdgeMesh, target: usize) {
    simplify_part(mesh, target, |_| true, |_, _| ());
}

/// Like [`simplify`], but only edges are collapsed both of whose ends are free. `merged` is told of
/// each collapse: the vertex that is removed, then the one that stays.
pub fn simplify_part(
    mesh: &mut HalfEdgeMesh,
    target: usize,
    is_free: impl Fn(VertexId) -> bool,
    mut merged: impl FnMut(VertexId, VertexId),
) {
    let is_free_edge =
        |mesh: &HalfEdgeMesh, h: HalfEdgeId| is_free(mesh.origin(h)) && is_free(mesh.target(h));
    let mut quadrics = vertex_quadrics(mesh);
    let mut ages = vec![0_u32; mesh.vertex_slots()];
    let mut queue: BinaryHeap<Candidate> = mesh
        .edges()
        .filter(|h| is_free_edge(mesh, *h))
        .map(|h| Candidate::of(mesh, h, &quadrics, &ages))
        .collect();
    while mesh.face_count() > target {
        let Some(candidate) = queue.pop() else {
            return;
        };
        let h = candidate.edge;
        if !mesh.has_half_edge(h) {
            continue;
        }
        let (u, v) = (mesh.origin(h), mesh.target(h));
        // Something has changed at its ends since.
        if [ages[u.index()], ages[v.index()]] != candidate.ages || candidate.ends != [u, v] {
            continue;
        }
        if turns_over(mesh, h, candidate.position)
            || mesh.collapse_edge(h, candidate.position).is_err()
        {
            continue;
        }
        merged(u, v);
        quadrics[v.index()] = quadrics[u.index()].plus(&quadrics[v.index()]);
        ages[u.index()] += 1;
        ages[v.index()] += 1;
        let around: Vec<HalfEdgeId> = mesh
            .vertex_half_edges(v)
            .filter(|h| is_free_edge(mesh, *h))
            .collect();
        queue.extend(
            around
                .into_iter()
                .map(|h| Candidate::of(mesh, h, &quadrics, &ages)),
        );
    }
}

/// An edge that may be collapsed.
struct Candidate {
    cost: f64,
    edge: HalfEdgeId,
    ends: [VertexId; 2],
    /// Numbers of changes that the ends had seen when the cost was computed.
    ages: [u32; 2],
    position: DVec3,
}

impl Candidate {
    fn of(mesh: &HalfEdgeMesh, edge: HalfEdgeId, quadrics: &[Quadric], ages: &[u32]) -> Self {
        let ends = [mesh.origin(edge), mesh.target(edge)];
        let [a, b] = ends.map(|v| mesh.position(v));
        let quadric = quadrics[ends[0].index()].plus(&quadrics[ends[1].index()]);
        let best = quadric
            .minimum()
            // Nearly flat quadrics have their minimum anywhere.
            .filter(|p| p.distance(a).min(p.distance(b)) <= 2.0 * a.distance(b));
        let (position, cost) = [best, Some(0.5 * a + 0.5 * b), Some(a), Some(b)]
            .into_iter()
            .flatten()
            .map(|p| (p, quadric.at(p)))
            .min_by(|one, other| one.1.total_cmp(&other.1))
            .unwrap_or((a, f64::INFINITY));
        // Of equal costs short edges go first.
        let cost = cost.max(0.0) + 1e-12 * quadric.weight * a.distance_squared(b);
        Self {
            cost,
            edge,
            ends,
            ages: ends.map(|v| ages[v.index()]),
            position,
        }
    }
}

impl Ord for Candidate {
    /// The cheapest is the greatest, then the lowest number.
    fn cmp(&self, other: &Self) -> Ordering {
        let by_cost = other.cost.total_cmp(&self.cost);
        by_cost.then(other.edge.cmp(&self.edge))
    }
}

impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Candidate {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Candidate {}

/// Weighted sum of squared distances from planes, about an origin near them.
#[derive(Clone, Copy)]
struct Quadric {
    origin: DVec3,
    squares: DMat3,
    linear: DVec3,
    constant: f64,
    weight: f64,
}

impl Quadric {
    const fn zero(origin: DVec3) -> Self {
        Self {
            origin,
            squares: DMat3::ZERO,
            linear: DVec3::ZERO,
            constant: 0.0,
            weight: 0.0,
        }
    }

    /// Adds weight · ((p − point) · normal)²; the normal has length 1.
    fn add_plane(&mut self, point: DVec3, normal: DVec3, weight: f64) {
        let scaled = normal * weight;
        let offset = (point - self.origin).dot(normal);
        self.squares += DMat3::from_cols(scaled * normal.x, scaled * normal.y, scaled * normal.z);
        self.linear += scaled * offset;
        self.constant += weight * offset * offset;
        self.weight += weight;
    }

    fn plus(&self, other: &Self) -> Self {
        // The other about this origin.
        let shift = self.origin - other.origin;
        let moved = other.squares * shift;
        Self {
            origin: self.origin,
            squares: self.squares + other.squares,
            linear: self.linear + other.linear - moved,
            constant: self.constant + other.constant - 2.0 * other.linear.dot(shift)
                + moved.dot(shift),
            weight: self.weight + other.weight,
        }
    }

    fn at(&self, point: DVec3) -> f64 {
        let p = point - self.origin;
        p.dot(self.squares * p) - 2.0 * self.linear.dot(p) + self.constant
    }

    /// Returns the point where the quadric is least; `None` if that is no single, well-defined
    /// point.
    fn minimum(&self) -> Option<DVec3> {
        let scale = self.weight / 3.0;
        let is_sound = self.squares.determinant() > 1e-6 * scale * scale * scale;
        let point = self.origin + self.squares.inverse() * self.linear;
        (is_sound && point.is_finite()).then_some(point)
    }
}

/// Computes the quadric of each vertex: the squared distances from the planes of the faces around
/// it, weighted by area; along a boundary also from the planes across it.
fn vertex_quadrics(mesh: &HalfEdgeMesh) -> Vec<Quadric> {
    let mut quadrics = vec![Quadric::zero(DVec3::ZERO); mesh.vertex_slots()];
    for v in mesh.vertices() {
        quadrics[v.index()].origin = mesh.position(v);
    }
    for f in mesh.faces() {
        let area = mesh.face_normal(f);
        let normal = area.normalize_or_zero();
        for h in mesh.face_half_edges(f) {
            let (from, to) = (mesh.origin(h), mesh.target(h));
            let point = mesh.position(from);
            quadrics[from.index()].add_plane(point, normal, area.length());
            if mesh.is_boundary_edge(h) {
                let along = mesh.position(to) - point;
                let across = along.cross(normal).normalize_or_zero();
                for end in [from, to] {
                    quadrics[end.index()].add_plane(point, across, 10.0 * along.length_squared());
                }
            }
        }
    }
    quadrics
}

/// `true` if a collapse would turn a triangle that stays by more than 78°.
fn turns_over(mesh: &HalfEdgeMesh, h: HalfEdgeId, position: DVec3) -> bool {
    let ends = [mesh.origin(h), mesh.target(h)];
    let beside = [mesh.face(h), mesh.face(mesh.twin(h))];
    ends.iter().any(|end| {
        mesh.vertex_half_edges(*end)
            .filter(|out| mesh.face(*out).is_some() && !beside.contains(&mesh.face(*out)))
            .any(|out| {
                let a = mesh.position(*end);
                let b = mesh.position(mesh.target(out));
                let c = mesh.position(mesh.origin(mesh.previous(out)));
                let before = (b - a).cross(c - a);
                let after = (b - position).cross(c - position);
                before.dot(after) < 0.2 * before.length() * after.length()
            })
    })
}

/// Mesh in which the nearest point is searched.
struct Surface<'a> {
    mesh: &'a TriangleMesh,
    bvh: Bvh,
}

impl<'a> Surface<'a> {
    fn new(mesh: &'a TriangleMesh) -> Self {
        Self {
            mesh,
            bvh: Bvh::new(&mesh.triangle_boxes()),
        }
    }

    /// The nearest triangle and the nearest point of it.
    fn nearest(&self, point: DVec3) -> Option<(usize, DVec3)> {
        let (i, _) = self.bvh.nearest(point, f64::INFINITY, |i| {
            closest_point(&self.mesh.corners(i as usize), point).distance_squared(point)
        })?;
        let i = i as usize;
        Some((i, closest_point(&self.mesh.corners(i), point)))
    }

    /// The largest distance of another mesh's vertices, edges' and triangles' middles.
    fn farthest(&self, other: &TriangleMesh) -> f64 {
        let samples = (0..other.triangles.len()).flat_map(|i| {
            let [a, b, c] = other.corners(i);
            [
                a,
                b,
                c,
                0.5 * (a + b),
                0.5 * (b + c),
                0.5 * (c + a),
                (a + b + c) / 3.0,
            ]
        });
        samples
            .map(|p| {
                let nearest = self.nearest(p);
                nearest.map_or(f64::INFINITY, |(_, q)| q.distance(p))
            })
            .fold(0.0, f64::max)
    }

    /// Gives another mesh's vertices the normals and colours of the nearest points.
    fn transfer(&self, other: &mut TriangleMesh) {
        let places: Vec<(usize, [f64; 3])> = other
            .positions
            .iter()
            .map(|p| {
                let (i, q) = self.nearest(*p).unwrap_or((0, *p));
                (i, weights(&self.mesh.corners(i), q))
            })
            .collect();
        other.normals = self.mesh.normals.as_ref().map(|normals| {
            places
                .iter()
                .map(|(i, w)| {
                    let own =
                        self.mesh.triangles[*i].map(|v| normals[v as usize].normalize_or_zero());
                    (own[0] * w[0] + own[1] * w[1] + own[2] * w[2]).normalize_or_zero()
                })
                .collect()
        });
        other.colors = self.mesh.colors.as_ref().map(|colors| {
            places
                .iter()
                .map(|(i, w)| {
                    let own = self.mesh.triangles[*i].map(|v| colors[v as usize]);
                    [0, 1, 2].map(|k| {
                        let parts = own.iter().zip(w).map(|(c, w)| f64::from(c[k]) * w);
                        parts.sum::<f64>() as f32
                    })
                })
                .collect()
        });
    }
}

/// Barycentric coordinates of a point of a triangle; of one without area the first corner's.
fn weights([a, b, c]: &[DVec3; 3], point: DVec3) -> [f64; 3] {
    let normal = (*b - *a).cross(*c - *a);
    let area = normal.length_squared();
    if area == 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let all = [(b, c), (c, a), (a, b)].map(|(p, q)| {
        let part = (*p - point).cross(*q - point).dot(normal);
        (part / area).max(0.0)
    });
    let sum: f64 = all.iter().sum();
    all.map(|w| w / sum)
}
