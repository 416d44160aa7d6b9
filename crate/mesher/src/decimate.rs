//! Fewer and better triangles: edges are collapsed into one of their ends, the cheapest first, and
//! flipped, and vertices move along the surface, as long as all vertices of the fine mesh stay near
//! the coarse one and its edges near the arcs that the surface's normals tell. The function is
//! evaluated where vertices move, nowhere else.

use crate::certify::{Vertex, descend};
use crate::guard::{Corner, Guard};
use crate::improve::sine;
use crate::march::Raw;
use crate::options::{MeshError, Progress};
use crate::space::Space;
use glam::{DMat3, DVec3};
use mesh::{FaceId, HalfEdgeId, HalfEdgeMesh, TriangleMesh, VertexId, closest_point};

/// Largest distance of fine vertices from the mesh, in tolerances.
const OFF: f64 = 0.75;
/// Largest height of the surface's arc over an edge, in tolerances: over a triangle's middle it may
/// be a third more.
const SAG: f64 = 0.6;
/// Least cosine of the angle between the normals of a triangle and of the surface at its corners.
const FACING: f64 = 0.5;
/// Least cosine of the angle by which a triangle may turn at a flip.
const TURN: f64 = 0.3;
/// Least cosine of the angle by which a triangle may turn at a collapse, whatever the surface's
/// normals are: at creases they are those of either side.
const STEADY: f64 = 0.9;
/// Least sine of a new triangle's smallest angle, unless one was worse before.
const SHARP: f64 = 0.26;
/// Largest distance from the surface of vertices that were moved, in tolerances.
const ON: f64 = 0.05;
/// Most edges at a vertex.
const MOST_EDGES: usize = 14;
/// Largest costs of collapses in one round after the other, in squares of the tolerance.
const COSTS: [f64; 6] = [1e-4, 1e-3, 0.01, 0.05, 0.25, 1.0];
/// Part of the square of an edge's length that its collapse costs, so that short ones go first.
const LENGTH: f64 = 1e-6;
/// Neighbours that a vertex may be merged into, the cheapest first.
const TARGETS: usize = 3;
/// Most passes over all vertices with the same largest cost.
const PASSES: usize = 4;
/// A pass that merges a smaller part of the vertices than one of so many is the last one.
const FEW: usize = 50;
/// Vertices and edges that are looked at between two reports.
const BATCH: usize = 4096;
/// Rounds of collapses and flips.
const ROUNDS: usize = 3;

/// Sine of the angles below which a vertex is moved.
const NARROW: f64 = 0.45;

/// A mesh that is being decimated.
pub struct Decimation<'a> {
    space: &'a Space<'a>,
    raw: &'a Raw,
    threads: usize,
    tolerance: f64,
    /// Share of the tolerance that each fine vertex is given; 0 keeps it.
    shares: &'a [f64],
    mesh: HalfEdgeMesh,
    normals: Vec<DVec3>,
    /// Vertices where lids meet the surface or each other.
    is_fixed: Vec<bool>,
    /// Vertices within lids.
    is_lid: Vec<bool>,
    /// Vertices that are not where they were in the fine mesh.
    is_moved: Vec<bool>,
    /// Fine vertices that each face stands for.
    kept: Vec<Vec<u32>>,
    quadrics: Vec<Quadric>,
    /// Number of the edit that is next; for each vertex that of the last one around it; and when
    /// its collapse was refused, with how many targets.
    now: u32,
    changed: Vec<u32>,
    refused: Vec<(u32, usize)>,
    guard: Guard,
}

/// A decimated mesh.
pub struct Decimated {
    /// The mesh, with normals.
    pub mesh: TriangleMesh,
    /// Number of each vertex in the fine mesh.
    pub sources: Vec<u32>,
}

impl<'a> Decimation<'a> {
    /// Takes a fine mesh over. Edits at guarded vertices are kept from making it cut itself.
    ///
    /// # Errors
    /// If it is no manifold.
    pub fn new(
        space: &'a Space<'a>,
        raw: &'a Raw,
        threads: usize,
        tolerance: f64,
        shares: &'a [f64],
        is_guarded: &[bool],
    ) -> Result<Self, MeshError> {
        let positions: Vec<DVec3> = raw.vertices.iter().map(|v| v.position).collect();
        let mesh = TriangleMesh::new(positions, raw.triangles.clone());
        let mesh = HalfEdgeMesh::from_triangles(&mesh)
            .map_err(|error| MeshError::Failed(error.to_string()))?;
        let count = raw.vertices.len();
        let mut normals: Vec<DVec3> = raw.vertices.iter().map(|v| v.normal()).collect();
        let [mut is_fixed, mut is_lid, mut is_surface] = [(); 3].map(|()| vec![false; count]);
        let mut areas = vec![0.0; count];
        for (t, lid) in raw.triangles.iter().zip(&raw.is_lid) {
            let [a, b, c] = t.map(|i| raw.vertices[i as usize].position);
            let area = (b - a).cross(c - a);
            let normal = area.normalize_or_zero();
            for i in t.map(|i| i as usize) {
                areas[i] += area.length();
                if !lid {
                    is_surface[i] = true;
                } else if is_lid[i] {
                    is_fixed[i] |= normals[i].dot(normal) < 0.99;
                } else {
                    is_lid[i] = true;
                    if !is_surface[i] {
                        normals[i] = normal;
                    }
                }
            }
        }
        for i in 0..count {
            if is_lid[i] && is_surface[i] {
                normals[i] = raw.vertices[i].normal();
                (is_fixed[i], is_lid[i]) = (true, false);
            }
        }
        let quadrics = raw.vertices.iter().zip(&normals).zip(&areas);
        let quadrics = quadrics.map(|((v, normal), area)| Quadric::new(v.position, *normal, *area));
        let quadrics = quadrics.collect();
        Ok(Self {
            space,
            raw,
            threads,
            is_moved: vec![false; count],
            tolerance,
            shares,
            quadrics,
            now: 1,
            changed: vec![0; count],
            refused: vec![(0, 0); count],
            guard: Guard::new(&mesh, |v| is_guarded[v.index()]),
            kept: vec![Vec::new(); mesh.face_slots()],
            mesh,
            normals,
            is_fixed,
            is_lid,
        })
    }

    /// Decimates the mesh.
    ///
    /// # Errors
    /// If the caller cancels.
    pub fn run(mut self, progress: &mut Progress<'_>) -> Result<Decimated, MeshError> {
        for round in 0..ROUNDS {
            progress.at(round as f32 / ROUNDS as f32)?;
            self.collapse(progress)?;
            self.flip(progress)?;
            self.relax(progress)?;
        }
        self.flip(progress)?;
        let mesh = &self.mesh;
        let sources: Vec<u32> = mesh.vertices().map(|v| v.index() as u32).collect();
        let normals = sources.iter().map(|i| self.normals[*i as usize]).collect();
        let triangles = mesh.to_triangles();
        let mut mesh = triangles.map_err(|error| MeshError::Failed(error.to_string()))?;
        mesh.normals = Some(normals);
        Ok(Decimated { mesh, sources })
    }

    /// Merges vertices into neighbours: first all that cost hardly anything, then those that cost
    /// more.
    fn collapse(&mut self, progress: &mut Progress<'_>) -> Result<(), MeshError> {
        let mut fan = Fan::default();
        for cost in COSTS {
            for _ in 0..PASSES {
                let merged = self.collapse_within(cost, &mut fan, progress)?;
                if merged * FEW < self.mesh.vertex_count() {
                    break;
                }
            }
        }
        Ok(())
    }

    /// Merges vertices where that costs so much at most, in squares of the tolerance; returns how
    /// many.
    fn collapse_within(
        &mut self,
        most: f64,
        fan: &mut Fan,
        progress: &mut Progress<'_>,
    ) -> Result<usize, MeshError> {
        let most = most * self.tolerance * self.tolerance;
        let mut merged = 0;
        let mut targets: Vec<(f64, HalfEdgeId)> = Vec::new();
        for i in 0..self.mesh.vertex_slots() {
            if i % BATCH == 0 {
                progress.again()?;
            }
            let u = VertexId(i as u32);
            if self.is_fixed[i] || self.shares[i] <= 0.0 || !self.mesh.has_vertex(u) {
                continue;
            }
            let own = self.mesh.position(u);
            targets.clear();
            for h in self.mesh.vertex_half_edges(u) {
                let to = self.mesh.position(self.mesh.target(h));
                let cost = self.quadrics[i].mean(to) + LENGTH * own.distance_squared(to);
                if cost <= most {
                    targets.push((cost, h));
                }
            }
            targets.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            targets.truncate(TARGETS);
            let (when, tried) = self.refused[i];
            if self.changed[i] < when && tried == targets.len() {
                continue;
            }
            let found = targets.iter().find(|(_, h)| {
                let is_new = self.allows(*h, fan);
                is_new && self.is_free(*h, fan)
            });
            let merges = found.is_some_and(|(_, h)| self.merge(*h, fan));
            merged += usize::from(merges);
            if !merges {
                self.refused[i] = (self.now, targets.len());
            }
        }
        Ok(merged)
    }

    fn corners(&self, f: FaceId) -> [VertexId; 3] {
        let mut corners = [VertexId(0); 3];
        for (corner, v) in corners.iter_mut().zip(self.mesh.face_vertices(f)) {
            *corner = v;
        }
        corners
    }

    fn positions(&self, corners: [VertexId; 3]) -> [DVec3; 3] {
        corners.map(|v| self.mesh.position(v))
    }

    /// Whether a triangle looks where the surface does at its corners.
    fn faces_out(&self, corners: [VertexId; 3], area: DVec3) -> bool {
        let least = FACING * area.length();
        let normals = corners.map(|v| self.normals[v.index()]);
        normals.iter().all(|normal| area.dot(*normal) >= least)
    }

    /// Whether the surface's arc over an edge is low.
    fn is_low(&self, a: VertexId, b: VertexId) -> bool {
        let turn = self.normals[a.index()] - self.normals[b.index()];
        let way = self.mesh.position(a) - self.mesh.position(b);
        let share = self.shares[a.index()].min(self.shares[b.index()]);
        turn.dot(way).abs() <= 8.0 * SAG * share * self.tolerance
    }

    /// Whether each of some fine vertices is near one of some triangles; adds the number of the
    /// nearest one for each.
    fn are_near(&self, places: &[u32], triangles: &[[DVec3; 3]], nearest: &mut Vec<u32>) -> bool {
        nearest.clear();
        for i in places {
            let place = self.raw.vertices[*i as usize].position;
            let limit = OFF * self.shares[*i as usize] * self.tolerance;
            let mut best = (f64::INFINITY, 0);
            for (number, triangle) in (0..).zip(triangles) {
                let square = closest_point(triangle, place).distance_squared(place);
                if square < best.0 {
                    best = (square, number);
                }
            }
            // Not so for NaN.
            let is_near = best.0 <= limit * limit;
            if !is_near {
                return false;
            }
            nearest.push(best.1);
        }
        true
    }

    /// Whether the origin of a half-edge may be merged into its target.
    fn allows(&self, h: HalfEdgeId, fan: &mut Fan) -> bool {
        let mesh = &self.mesh;
        let (u, v) = (mesh.origin(h), mesh.target(h));
        if mesh.degree(u) + mesh.degree(v) > MOST_EDGES + 4 || mesh.can_collapse(h).is_err() {
            return false;
        }
        let is_lid = self.is_lid[u.index()];
        let to = mesh.position(v);
        fan.clear();
        let mut before = 1.0_f64;
        for out in mesh.vertex_half_edges(u) {
            let Some(f) = mesh.face(out) else {
                return false;
            };
            fan.places.extend_from_slice(&self.kept[f.index()]);
            let (b, c) = (mesh.target(out), mesh.origin(mesh.previous(out)));
            let old = self.positions([u, b, c]);
            before = before.min(sine(old));
            if b == v || c == v {
                fan.beside.push(f);
                continue;
            }
            let [a, q, r] = old;
            let (was, area) = ((q - a).cross(r - a), (q - to).cross(r - to));
            let turn = was.dot(area);
            let most = was.length() * area.length();
            let is_steady = turn >= STEADY * most;
            let is_sound = area != DVec3::ZERO
                && if is_lid {
                    is_steady
                } else {
                    (is_steady || self.faces_out([v, b, c], area)) && self.is_low(v, b)
                };
            if !is_sound {
                return false;
            }
            fan.faces.push(f);
            fan.triangles.push([to, q, r]);
        }
        let least = before.min(SHARP);
        if fan.triangles.iter().any(|t| sine(*t) < least) {
            return false;
        }
        if !self.is_moved[u.index()] {
            fan.places.push(u.0);
        }
        let Fan {
            places,
            triangles,
            nearest,
            ..
        } = fan;
        self.are_near(places, triangles, nearest)
    }

    /// Whether the mesh does not cut itself at a guarded place when the origin of a half-edge is
    /// merged into its target.
    fn is_free(&self, h: HalfEdgeId, fan: &Fan) -> bool {
        let (u, v) = (self.mesh.origin(h), self.mesh.target(h));
        if !self.is_guarded_around(u) {
            return true;
        }
        let new = fan.faces.iter().map(|f| {
            self.corners(*f).map(|w| {
                let own = if w == u { v } else { w };
                Corner {
                    number: own.0,
                    position: self.mesh.position(own),
                }
            })
        });
        let new: Vec<[Corner; 3]> = new.collect();
        let gone: Vec<FaceId> = fan.faces.iter().chain(&fan.beside).copied().collect();
        self.guard.is_free(&self.mesh, &new, &gone)
    }

    /// Merges the origin of a half-edge into its target.
    fn merge(&mut self, h: HalfEdgeId, fan: &Fan) -> bool {
        let (u, v) = (self.mesh.origin(h), self.mesh.target(h));
        let is_guarded = self.is_guarded_around(u);
        let ends = self.guard.is_guarded(u) || self.guard.is_guarded(v);
        let place = self.mesh.position(v);
        if self.mesh.collapse_edge(h, place).is_err() {
            return false;
        }
        for f in fan.faces.iter().chain(&fan.beside) {
            self.kept[f.index()].clear();
        }
        for (i, number) in fan.places.iter().zip(&fan.nearest) {
            self.kept[fan.faces[*number as usize].index()].push(*i);
        }
        let own = self.quadrics[u.index()];
        self.quadrics[v.index()].add(&own);
        self.touch(v);
        if is_guarded {
            self.guard.set_guarded(v, ends);
            let around: Vec<FaceId> = self.mesh.vertex_faces(v).collect();
            self.guard_again(&fan.faces);
            self.guard_again(&fan.beside);
            self.guard_again(&around);
        }
        true
    }

    /// Takes note that the faces at a vertex have changed.
    fn touch(&mut self, v: VertexId) {
        self.changed[v.index()] = self.now;
        for n in self.mesh.neighbors(v) {
            self.changed[n.index()] = self.now;
        }
        self.now += 1;
    }

    fn is_guarded_around(&self, v: VertexId) -> bool {
        let mut around = self.mesh.neighbors(v);
        self.guard.is_guarded(v) || around.any(|n| self.guard.is_guarded(n))
    }

    /// Takes note of faces that have changed or gone.
    fn guard_again(&mut self, faces: &[FaceId]) {
        for f in faces {
            if self.mesh.has_face(*f) {
                self.guard.set(&self.mesh, *f);
            } else {
                self.guard.remove(*f);
            }
        }
    }

    /// Moves vertices with narrow triangles to the middle of their neighbours, on the surface.
    fn relax(&mut self, progress: &mut Progress<'_>) -> Result<(), MeshError> {
        let mesh = &self.mesh;
        let narrow: Vec<VertexId> = mesh.vertices().filter(|v| self.is_narrow(*v)).collect();
        let goals = narrow.iter().map(|v| {
            let (mut sum, mut count) = (DVec3::ZERO, 0.0);
            for n in mesh.neighbors(*v) {
                (sum, count) = (sum + mesh.position(n), count + 1.0);
            }
            let (own, normal) = (mesh.position(*v), self.normals[v.index()]);
            let way = sum / count - own;
            own + (way - normal * way.dot(normal))
        });
        let limit = 4.0 * self.tolerance;
        let goals: Vec<(DVec3, f64)> = goals.map(|place| (place, limit)).collect();
        let found = descend(
            self.space,
            &goals,
            2,
            self.tolerance,
            self.threads,
            progress,
        )?;
        for (v, vertex) in narrow.into_iter().zip(found) {
            let is_on = vertex.value.abs() <= ON * self.tolerance * vertex.gradient.length();
            if is_on && self.space.forest.contains(vertex.position) {
                self.move_one(v, &vertex);
            }
        }
        Ok(())
    }

    /// Whether a vertex may move and has a narrow triangle.
    fn is_narrow(&self, v: VertexId) -> bool {
        let i = v.index();
        let is_free = !self.is_fixed[i] && !self.is_lid[i] && self.shares[i] > 0.0;
        let mut faces = self.mesh.vertex_faces(v);
        is_free && faces.any(|f| sine(self.positions(self.corners(f))) < NARROW)
    }

    /// Moves a vertex if that makes better triangles which are as near to the surface.
    fn move_one(&mut self, v: VertexId, to: &Vertex) -> Option<()> {
        let mesh = &self.mesh;
        let faces: Vec<FaceId> = mesh.vertex_faces(v).collect();
        let corners: Vec<[VertexId; 3]> = faces.iter().map(|f| self.corners(*f)).collect();
        let new = corners.iter().map(|t| {
            t.map(|w| Corner {
                number: w.0,
                position: if w == v {
                    to.position
                } else {
                    mesh.position(w)
                },
            })
        });
        let new: Vec<[Corner; 3]> = new.collect();
        let triangles = new.iter().map(|t| t.map(|corner| corner.position));
        let triangles: Vec<[DVec3; 3]> = triangles.collect();
        let before = corners.iter().map(|t| sine(self.positions(*t)));
        let before = before.fold(1.0, f64::min);
        let after = triangles.iter().map(|t| sine(*t)).fold(1.0, f64::min);
        if after <= 1.02 * before {
            return None;
        }
        let was = (self.normals[v.index()], mesh.position(v));
        let places = faces
            .iter()
            .flat_map(|f| self.kept[f.index()].iter().copied());
        let own = (!self.is_moved[v.index()]).then_some(v.0);
        let places: Vec<u32> = places.chain(own).collect();
        let mut nearest = Vec::new();
        if !self.are_near(&places, &triangles, &mut nearest) {
            return None;
        }
        let is_guarded = self.is_guarded_around(v);
        if is_guarded && !self.guard.is_free(mesh, &new, &faces) {
            return None;
        }
        self.normals[v.index()] = to.normal();
        self.mesh.set_position(v, to.position).ok()?;
        let is_sound = corners.iter().zip(&triangles).all(|(t, [a, b, c])| {
            let area = area(&[*a, *b, *c]);
            area != DVec3::ZERO && self.faces_out(*t, area)
        });
        let is_sound = is_sound && self.mesh.neighbors(v).all(|n| self.is_low(v, n));
        if !is_sound {
            self.normals[v.index()] = was.0;
            self.mesh.set_position(v, was.1).ok()?;
            return None;
        }
        self.is_moved[v.index()] = true;
        self.touch(v);
        faces.iter().for_each(|f| self.kept[f.index()].clear());
        for (i, number) in places.iter().zip(&nearest) {
            self.kept[faces[*number as usize].index()].push(*i);
        }
        if is_guarded {
            self.guard_again(&faces);
        }
        Some(())
    }

    /// Flips edges where the smallest angle beside them grows.
    fn flip(&mut self, progress: &mut Progress<'_>) -> Result<(), MeshError> {
        let edges: Vec<HalfEdgeId> = self.mesh.edges().collect();
        for (i, h) in edges.into_iter().enumerate() {
            if i % BATCH == 0 {
                progress.again()?;
            }
            self.flip_one(h);
        }
        Ok(())
    }

    /// Flips an edge if that makes better triangles which are as near to the surface.
    fn flip_one(&mut self, h: HalfEdgeId) -> Option<()> {
        let mesh = &self.mesh;
        let twin = mesh.twin(h);
        let faces = [mesh.face(h)?, mesh.face(twin)?];
        let (p, q) = (mesh.origin(h), mesh.target(h));
        let (r, s) = (mesh.target(mesh.next(h)), mesh.target(mesh.next(twin)));
        let is_lid = [p, q, r, s].iter().any(|v| self.is_lid[v.index()]);
        let is_rim = self.is_fixed[p.index()] && self.is_fixed[q.index()];
        if is_lid || is_rim || mesh.degree(p).min(mesh.degree(q)) <= 3 {
            return None;
        }
        let new = [[s, r, p], [r, s, q]];
        let old = [[p, q, r], [q, p, s]].map(|t| self.positions(t));
        let triangles = new.map(|t| self.positions(t));
        let [after, before] = [triangles, old].map(|[t, u]| sine(t).min(sine(u)));
        if after < 1.1 * before || !self.is_low(r, s) {
            return None;
        }
        let was = area(&old[0]).normalize_or_zero() + area(&old[1]).normalize_or_zero();
        for (corners, triangle) in new.iter().zip(&triangles) {
            let own = area(triangle);
            let is_turned = own.dot(was) <= TURN * own.length() * was.length();
            if is_turned || !self.faces_out(*corners, own) {
                return None;
            }
        }
        let places = faces.map(|f| self.kept[f.index()].clone()).concat();
        let mut nearest = Vec::new();
        if !self.are_near(&places, &triangles, &mut nearest) {
            return None;
        }
        let is_guarded = [p, q, r, s].iter().any(|v| self.guard.is_guarded(*v));
        if is_guarded {
            let corners = new.map(|t| {
                t.map(|v| Corner {
                    number: v.0,
                    position: self.mesh.position(v),
                })
            });
            if !self.guard.is_free(&self.mesh, &corners, &faces) {
                return None;
            }
        }
        self.mesh.flip_edge(h).ok()?;
        for v in [p, q, r, s] {
            self.changed[v.index()] = self.now;
        }
        self.now += 1;
        // Which of the two faces has which corners.
        let first = self.corners(faces[0]).contains(&p);
        let order = if first { faces } else { [faces[1], faces[0]] };
        faces.iter().for_each(|f| self.kept[f.index()].clear());
        for (i, number) in places.iter().zip(&nearest) {
            self.kept[order[*number as usize].index()].push(*i);
        }
        if is_guarded {
            self.guard_again(&faces);
        }
        Some(())
    }
}

/// Twice the area of a triangle, along its normal.
fn area([a, b, c]: &[DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a)
}

/// The triangles around a vertex, and those that take their place when it is merged into another
/// one.
#[derive(Default)]
struct Fan {
    /// The faces that stay, with their new corners.
    faces: Vec<FaceId>,
    triangles: Vec<[DVec3; 3]>,
    /// Faces that go.
    beside: Vec<FaceId>,
    /// The fine vertices that all of them stand for, and for each the nearest new triangle.
    places: Vec<u32>,
    nearest: Vec<u32>,
}

impl Fan {
    fn clear(&mut self) {
        self.faces.clear();
        self.triangles.clear();
        self.beside.clear();
        self.places.clear();
        self.nearest.clear();
    }
}

/// Weighted sum of squared distances from tangent planes, about a place near them.
#[derive(Clone, Copy)]
struct Quadric {
    origin: DVec3,
    squares: DMat3,
    linear: DVec3,
    constant: f64,
    weight: f64,
}

impl Quadric {
    fn new(origin: DVec3, normal: DVec3, weight: f64) -> Self {
        let scaled = normal * weight;
        Self {
            origin,
            squares: DMat3::from_cols(scaled * normal.x, scaled * normal.y, scaled * normal.z),
            linear: DVec3::ZERO,
            constant: 0.0,
            weight,
        }
    }

    fn add(&mut self, other: &Self) {
        // The other about this origin.
        let shift = self.origin - other.origin;
        let moved = other.squares * shift;
        self.constant += other.constant - 2.0 * other.linear.dot(shift) + moved.dot(shift);
        self.linear += other.linear - moved;
        self.squares += other.squares;
        self.weight += other.weight;
    }

    /// Mean squared distance of a point from the planes.
    fn mean(&self, point: DVec3) -> f64 {
        let p = point - self.origin;
        let sum = p.dot(self.squares * p) - 2.0 * self.linear.dot(p) + self.constant;
        if self.weight > 0.0 {
            (sum / self.weight).max(0.0)
        } else {
            0.0
        }
    }
}
