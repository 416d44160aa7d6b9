//! The fine mesh of limbs that are many times longer than thick: tubes around them that are united,
//! then brought to the surface. Cubic cells would have to be as small as limbs are thin, along all
//! of them.
//!
//! The tubes' corners stand at the limbs' radii. Where limbs blend, that is below the surface: from
//! there vertices climb along gradients, in steps that turn no triangle over. Edges are halved
//! until the surface is within the tolerance of them.

use crate::cages::Cage;
use crate::certify::{Vertex, descend, sag};
use crate::forest::NONE;
use crate::grow::{SAG, Sizes, split_all};
use crate::guard::{Corner, Guard};
use crate::march::Raw;
use crate::options::{MeshError, Progress};
use crate::space::Space;
use crate::unite::union;
use field::{Ball, THRESHOLD};
use glam::DVec3;
use mesh::{FaceId, HalfEdgeId, HalfEdgeMesh, TriangleMesh, VertexId, self_intersections};

/// Cubic cells that a limb needs for each radius of its length, with those beside the surface.
const CELLS: f64 = 120.0;
/// Most steps along gradients that bring a vertex to the surface.
const STEPS: usize = 24;
/// Longest step, as a share of the radius of the flesh.
const STRIDE: f64 = 0.3;
/// Shares of a step that are tried, the largest first that turns no triangle over.
const SHARES: [f64; 4] = [1.0, 0.5, 0.2, 0.05];
/// Largest distance by a first-order estimate, in tolerances, at which a vertex stays.
const LANDED: f64 = 1e-3;
/// Largest such distance at which a vertex counts as on the surface.
const ON: f64 = 0.1;
/// Shortest edges of the united tubes, as a share of the radius there.
const SHORT: f64 = 0.35;
/// Least cosine of the angle by which a step or the collapse of an edge turns a triangle.
const TURNED: f64 = 0.3;
/// Least cosine of the angle between a triangle and the surface at its corners.
const OUTWARD: f64 = 0.1;
/// Smallest cells with terms of their own, in radii of the flesh.
const WIDTHS: f64 = 0.5;
/// Edits between two questions to the caller.
const BETWEEN: usize = 2000;
/// Most rounds of repairs.
const REPAIRS: usize = 6;
/// Most times that edges are halved.
const HALVINGS: usize = 12;
/// Edges are not halved below so many tolerances.
const LEAST: f64 = 0.5;

/// Returns whether cages are those of limbs and balls alone.
pub fn are_limbs(cages: &[Cage]) -> bool {
    !cages.is_empty()
        && cages
            .iter()
            .all(|cage| !cage.lines.is_empty() || is_ball(cage))
}

/// Returns whether all rays of a cage start from one point.
fn is_ball(cage: &Cage) -> bool {
    let mut spokes = cage.spokes.windows(2);
    spokes.all(|pair| pair[0].origin == pair[1].origin)
}

/// Estimates the number of cubic cells that limbs would need.
pub fn estimate_cells(cages: &[Cage]) -> f64 {
    let lines = cages.iter().flat_map(|cage| &cage.lines);
    let lengths = lines.filter(|line| line.is_own).map(|line| {
        let [a, b] = line.ends;
        a.distance(b) / (0.5 * (line.radii[0] + line.radii[1]))
    });
    CELLS * lengths.filter(|length| length.is_finite()).sum::<f64>()
}

/// Returns the fine mesh of limbs and balls: closed, and it does not cut itself.
///
/// # Errors
/// If the tubes cannot be united, or if the caller cancels.
pub fn unite_tubes(
    space: &mut Space<'_>,
    cages: &[Cage],
    sizes: &Sizes,
    progress: &mut Progress<'_>,
) -> Result<Raw, MeshError> {
    let mut shells = Vec::new();
    for cage in cages {
        progress.again()?;
        let shell = around(cage);
        if is_sound(&shell) {
            shells.push(shell);
            continue;
        }
        for line in cage.lines.iter().filter(|line| line.is_own) {
            let ends = [0, 1].map(|i| (line.ends[i], line.radii[i]));
            shells.extend(Cage::around_lines(&[ends]).iter().map(around));
        }
    }
    let united = union(&shells, progress)?;
    progress.at(0.3)?;
    let colors = united.colors.as_deref().unwrap_or_default();
    let mesh = HalfEdgeMesh::from_triangles(&united).map_err(fail)?;
    let mut skin = Skin {
        space,
        sizes,
        guard: Guard::new(&mesh, |_| true),
        mesh,
        vertices: united.positions.iter().map(|p| start(*p)).collect(),
        radii: colors.iter().map(|color| f64::from(color[0])).collect(),
    };
    for share in [0.03 * SHORT, 0.3 * SHORT, SHORT] {
        let all = skin.mesh.edges().collect();
        skin.collapse(all, share, progress)?;
    }
    let mut fresh: Vec<VertexId> = skin.mesh.vertices().collect();
    for round in 0..HALVINGS {
        progress.at(0.3 + 0.7 * round as f32 / HALVINGS as f32)?;
        skin.climb(fresh, progress)?;
        skin.repair(progress)?;
        fresh = skin.halve(progress)?;
        if fresh.is_empty() {
            break;
        }
    }
    skin.climb(fresh, progress)?;
    let vertices = skin.mesh.vertices().map(|v| skin.vertices[v.index()]);
    let triangles = skin.mesh.to_triangles().map_err(fail)?.triangles;
    Ok(Raw {
        is_lid: vec![false; triangles.len()],
        vertices: vertices.collect(),
        triangles,
        anchors: Vec::new(),
    })
}

fn fail(error: impl core::fmt::Display) -> MeshError {
    MeshError::Failed(error.to_string())
}

/// The mesh of a cage whose vertices are as far from its lines as their radii tell, with these
/// as colours.
fn around(cage: &Cage) -> TriangleMesh {
    let spokes = cage.spokes.iter();
    let ends = spokes.map(|spoke| spoke.origin + spoke.direction * spoke.radius());
    let mut mesh = TriangleMesh::new(ends.collect(), cage.triangles.clone());
    let radii = cage.spokes.iter().map(|spoke| [spoke.radius() as f32; 3]);
    mesh.colors = Some(radii.collect());
    mesh
}

fn is_sound(shell: &TriangleMesh) -> bool {
    self_intersections(shell, 1).is_ok_and(|crossings| crossings.is_free())
}

/// A vertex where the function is not known.
fn start(position: DVec3) -> Vertex {
    Vertex {
        position,
        value: f64::NAN,
        gradient: DVec3::ZERO,
    }
}

/// A mesh on its way to the surface.
struct Skin<'a, 'b> {
    space: &'a mut Space<'b>,
    sizes: &'a Sizes,
    mesh: HalfEdgeMesh,
    /// The function at each vertex.
    vertices: Vec<Vertex>,
    /// Radius of the flesh around each vertex.
    radii: Vec<f64>,
    guard: Guard,
}

impl Skin<'_, '_> {
    fn length(&self, h: HalfEdgeId) -> f64 {
        let [a, b] = [self.mesh.origin(h), self.mesh.target(h)];
        self.mesh.position(a).distance(self.mesh.position(b))
    }

    /// Sorts edges, the shortest first.
    fn sort_by_length(&self, edges: &mut [HalfEdgeId]) {
        edges.sort_by(|a, b| {
            let lengths = [*a, *b].map(|h| self.length(h));
            lengths[0].total_cmp(&lengths[1]).then(a.cmp(b))
        });
    }

    /// Brings vertices to the surface along gradients.
    fn climb(
        &mut self,
        mut open: Vec<VertexId>,
        progress: &mut Progress<'_>,
    ) -> Result<(), MeshError> {
        for step in 0..=STEPS {
            self.evaluate(&open, progress)?;
            let near = LANDED * self.sizes.tolerance;
            open.retain(|v| {
                let is_there = self.vertices[v.index()].distance() <= near;
                !is_there
            });
            if open.is_empty() {
                break;
            }
            if step == STEPS {
                self.drop_stuck(&open)?;
                break;
            }
            for v in &open {
                self.step(*v)?;
            }
            let around = open.iter();
            let around = around.flat_map(|v| self.mesh.vertex_half_edges(*v));
            let mut around: Vec<HalfEdgeId> = around.collect();
            around.sort_unstable();
            around.dedup();
            self.collapse(around, SHORT * 0.8, progress)?;
            open.retain(|v| self.mesh.has_vertex(*v) && !self.is_new(*v));
            open.extend(self.mesh.vertices().filter(|v| self.is_new(*v)));
            open.sort_unstable();
        }
        Ok(())
    }

    /// Evaluates the function at vertices.
    fn evaluate(&mut self, own: &[VertexId], progress: &mut Progress<'_>) -> Result<(), MeshError> {
        let places = own.iter();
        let places = places.map(|v| (self.mesh.position(*v), self.radii[v.index()]));
        let places: Vec<(DVec3, f64)> = places.collect();
        narrow(self.space, &places, self.sizes, progress)?;
        let places = places.into_iter().map(|(center, _)| {
            let ball = Ball {
                center,
                radius: 0.0,
            };
            (self.space.part_for(ball), center)
        });
        let places: Vec<(u32, DVec3)> = places.collect();
        let Sizes {
            tolerance, threads, ..
        } = *self.sizes;
        let jets = self
            .space
            .jets_in_parts(&places, tolerance, threads, progress)?;
        for ((v, (_, position)), jet) in own.iter().zip(&places).zip(&jets) {
            self.vertices[v.index()] = Vertex::new(*position, jet);
        }
        Ok(())
    }

    /// Moves a vertex towards the surface as far as no triangle turns over.
    fn step(&mut self, v: VertexId) -> Result<(), MeshError> {
        let vertex = &self.vertices[v.index()];
        let value = vertex.value + THRESHOLD;
        let fall = value * libm::log(value / THRESHOLD) / vertex.gradient.length_squared();
        let way = (-fall * vertex.gradient).clamp_length_max(STRIDE * self.radii[v.index()]);
        if !way.is_finite() {
            return Ok(());
        }
        let from = self.mesh.position(v);
        let place = SHARES.map(|share| from + share * way);
        let place = place
            .into_iter()
            .find(|place| self.stays_turned(&[v], *place) && self.is_free(&[v], v, *place));
        if let Some(place) = place {
            self.mesh.set_position(v, place).map_err(fail)?;
            self.vertices[v.index()] = start(place);
            self.guard_again(v, &[]);
        }
        Ok(())
    }

    /// Returns whether the function is not known at a vertex.
    fn is_new(&self, v: VertexId) -> bool {
        self.vertices[v.index()].value.is_nan()
    }

    /// Returns whether an edge is shorter than a share of the radius.
    fn is_short(&self, h: HalfEdgeId, share: f64) -> bool {
        let [a, b] = [self.mesh.origin(h), self.mesh.target(h)];
        let radius = self.radii[a.index()].min(self.radii[b.index()]);
        self.length(h) < share * radius
    }

    /// Returns a vertex as a corner of triangles.
    fn corner(&self, v: VertexId) -> Corner {
        Corner {
            number: v.index() as u32,
            position: self.mesh.position(v),
        }
    }

    /// Collapses those of some edges that are shorter than a share of the radius.
    fn collapse(
        &mut self,
        mut edges: Vec<HalfEdgeId>,
        share: f64,
        progress: &mut Progress<'_>,
    ) -> Result<(), MeshError> {
        edges.retain(|h| self.is_short(*h, share));
        self.sort_by_length(&mut edges);
        for (i, h) in edges.into_iter().enumerate() {
            if i % BETWEEN == 0 {
                progress.again()?;
            }
            if !self.mesh.has_half_edge(h) || !self.is_short(h, share) {
                continue;
            }
            let [a, b] = [self.mesh.origin(h), self.mesh.target(h)];
            for kept in [a, b] {
                let place = self.mesh.position(kept);
                if self.stays_turned(&[a, b], place)
                    && self.mesh.can_collapse(h).is_ok()
                    && self.is_free(&[a, b], b, place)
                {
                    self.merge(h, kept)?;
                    break;
                }
            }
        }
        Ok(())
    }

    /// Collapses an edge into one of its ends.
    fn merge(&mut self, h: HalfEdgeId, kept: VertexId) -> Result<(), MeshError> {
        let [a, b] = [self.mesh.origin(h), self.mesh.target(h)];
        let gone: Vec<FaceId> = self.mesh.vertex_faces(a).collect();
        self.mesh
            .collapse_edge(h, self.mesh.position(kept))
            .map_err(fail)?;
        self.vertices[b.index()] = self.vertices[kept.index()];
        self.radii[b.index()] = self.radii[kept.index()];
        self.guard_again(b, &gone);
        Ok(())
    }

    /// Takes note of the faces around a vertex, and of some that may be gone.
    fn guard_again(&mut self, v: VertexId, gone: &[FaceId]) {
        for f in gone.iter().copied().filter(|f| !self.mesh.has_face(*f)) {
            self.guard.remove(f);
        }
        for f in self.mesh.vertex_faces(v) {
            self.guard.set(&self.mesh, f);
        }
    }

    /// Returns whether the mesh does not cut itself if some vertices become one at a place.
    fn is_free(&self, own: &[VertexId], kept: VertexId, place: DVec3) -> bool {
        let mesh = &self.mesh;
        let mut gone: Vec<FaceId> = own.iter().flat_map(|v| mesh.vertex_faces(*v)).collect();
        gone.sort_unstable();
        gone.dedup();
        let mut new = Vec::new();
        for f in &gone {
            let mut corners = mesh.face_vertices(*f);
            let corners: [VertexId; 3] = core::array::from_fn(|_| corners.next().unwrap_or(kept));
            if corners.iter().filter(|corner| own.contains(corner)).count() == 1 {
                new.push(corners.map(|v| {
                    let is_own = own.contains(&v);
                    Corner {
                        number: if is_own { kept } else { v }.index() as u32,
                        position: if is_own { place } else { mesh.position(v) },
                    }
                }));
            }
        }
        self.guard.is_free(mesh, &new, &gone)
    }

    /// Returns whether the triangles beside an edge stay apart from others if it gets a vertex.
    fn is_half_free(&self, h: HalfEdgeId, place: DVec3) -> bool {
        let middle = Corner {
            number: u32::MAX,
            position: place,
        };
        let sides = [h, self.mesh.twin(h)];
        let new = sides.map(|h| {
            let opposite = self.mesh.origin(self.mesh.previous(h));
            let [a, b, c] =
                [self.mesh.origin(h), self.mesh.target(h), opposite].map(|v| self.corner(v));
            [[a, middle, c], [middle, b, c]]
        });
        let faces: Vec<FaceId> = sides.iter().filter_map(|h| self.mesh.face(*h)).collect();
        self.guard.is_free(&self.mesh, new.as_flattened(), &faces)
    }

    /// Returns whether no triangle around some vertices turns over if they move to a place.
    fn stays_turned(&self, own: &[VertexId], place: DVec3) -> bool {
        let mesh = &self.mesh;
        own.iter().all(|v| {
            mesh.vertex_faces(*v).all(|f| {
                let mut corners = mesh.face_vertices(f);
                let corners: [VertexId; 3] = core::array::from_fn(|_| corners.next().unwrap_or(*v));
                if corners.iter().filter(|corner| own.contains(corner)).count() > 1 {
                    return true;
                }
                let old = area(corners.map(|c| mesh.position(c)));
                let new = corners.map(|c| {
                    if own.contains(&c) {
                        place
                    } else {
                        mesh.position(c)
                    }
                });
                let new = area(new);
                new.dot(old) > TURNED * new.length() * old.length()
            })
        })
    }

    /// Flips or collapses edges of triangles that look away from the surface.
    fn repair(&mut self, progress: &mut Progress<'_>) -> Result<(), MeshError> {
        for _ in 0..REPAIRS {
            let faces: Vec<FaceId> = self.mesh.faces().collect();
            let bad: Vec<FaceId> = faces.into_iter().filter(|f| !self.looks_out(*f)).collect();
            if bad.is_empty() {
                break;
            }
            for (i, f) in bad.into_iter().enumerate() {
                if i % BETWEEN == 0 {
                    progress.again()?;
                }
                self.mend(f)?;
            }
        }
        Ok(())
    }

    /// Returns whether a triangle looks along the surface's normals at its corners.
    fn looks_out(&self, f: FaceId) -> bool {
        let mut corners = self.mesh.face_vertices(f);
        let corners: [Option<VertexId>; 3] = core::array::from_fn(|_| corners.next());
        let corners = corners.map(|v| v.map_or(start(DVec3::ZERO), |v| self.vertices[v.index()]));
        faces_out(corners.each_ref())
    }

    fn mend(&mut self, f: FaceId) -> Result<(), MeshError> {
        if !self.mesh.has_face(f) || self.looks_out(f) {
            return Ok(());
        }
        let sides: Vec<HalfEdgeId> = self.mesh.face_half_edges(f).collect();
        // By a flip.
        for h in &sides {
            let [a, b] = [self.mesh.origin(*h), self.mesh.target(*h)];
            let [c, d] = [*h, self.mesh.twin(*h)].map(|h| self.mesh.origin(self.mesh.previous(h)));
            let numbers = [a, b, c, d];
            let [a, b, c, d] = numbers.map(|v| &self.vertices[v.index()]);
            let new = [[2, 0, 3], [3, 1, 2]].map(|t| t.map(|i| self.corner(numbers[i])));
            let faces = [*h, self.mesh.twin(*h)].map(|h| self.mesh.face(h));
            let faces: Vec<FaceId> = faces.into_iter().flatten().collect();
            if faces_out([c, a, d])
                && faces_out([d, b, c])
                && self.guard.is_free(&self.mesh, &new, &faces)
                && self.mesh.flip_edge(*h).is_ok()
            {
                self.guard_again(numbers[2], &[]);
                return Ok(());
            }
        }
        for h in sides {
            if self.merge_well(h)? || self.merge_well(self.mesh.twin(h))? {
                return Ok(());
            }
        }
        Ok(())
    }

    /// Collapses an edge into its target if all triangles there look out then, and returns whether
    /// it did.
    fn merge_well(&mut self, h: HalfEdgeId) -> Result<bool, MeshError> {
        let [a, b] = [self.mesh.origin(h), self.mesh.target(h)];
        let kept = self.vertices[b.index()];
        for f in self.mesh.vertex_faces(a) {
            let mut corners = self.mesh.face_vertices(f);
            let corners: [VertexId; 3] = core::array::from_fn(|_| corners.next().unwrap_or(a));
            if corners.contains(&b) {
                continue;
            }
            let corners = corners.each_ref().map(|v| match *v == a {
                true => &kept,
                false => &self.vertices[v.index()],
            });
            if !faces_out(corners) {
                return Ok(false);
            }
        }
        let may_merge =
            self.mesh.can_collapse(h).is_ok() && self.is_free(&[a, b], b, kept.position);
        if may_merge {
            self.merge(h, b)?;
        }
        Ok(may_merge)
    }

    /// Takes away vertices that do not reach the surface, where the triangles around them look out
    /// without them.
    fn drop_stuck(&mut self, open: &[VertexId]) -> Result<(), MeshError> {
        for v in open {
            if !self.mesh.has_vertex(*v) || self.is_on(*v) {
                continue;
            }
            let sides = self.mesh.vertex_half_edges(*v);
            let sides = sides.filter(|h| self.is_on(self.mesh.target(*h)));
            let mut sides: Vec<HalfEdgeId> = sides.collect();
            self.sort_by_length(&mut sides);
            for h in sides {
                if self.merge_well(h)? {
                    break;
                }
            }
        }
        Ok(())
    }

    /// Returns whether a vertex is on the surface.
    fn is_on(&self, v: VertexId) -> bool {
        self.vertices[v.index()].distance() <= ON * self.sizes.tolerance
    }

    /// Returns whether an edge is to be halved: one beside a triangle that is far from the surface,
    /// or from which the surface bends too far.
    fn is_long(&self, h: HalfEdgeId, is_marked: bool) -> bool {
        let tolerance = self.sizes.tolerance;
        let ends = [self.mesh.origin(h), self.mesh.target(h)];
        let are_on = ends.iter().all(|v| self.is_on(*v));
        let [a, b] = ends.map(|v| &self.vertices[v.index()]);
        let is_bent = is_marked || sag(a, b) > SAG * tolerance;
        are_on && is_bent && self.length(h) > LEAST * tolerance
    }

    /// Halves edges whose surface bends too far from them, and returns the new vertices.
    fn halve(&mut self, progress: &mut Progress<'_>) -> Result<Vec<VertexId>, MeshError> {
        let tolerance = self.sizes.tolerance;
        let mut marked = vec![false; self.mesh.half_edge_slots()];
        let faces: Vec<FaceId> = self.mesh.faces().collect();
        let goals = faces.iter().map(|f| {
            let corners = self.mesh.face_vertices(*f).map(|v| self.mesh.position(v));
            (corners.sum::<DVec3>() / 3.0, 0.0)
        });
        let goals: Vec<(DVec3, f64)> = goals.collect();
        let found = descend(
            self.space,
            &goals,
            0,
            tolerance,
            self.sizes.threads,
            progress,
        )?;
        for (f, vertex) in faces.iter().zip(found) {
            let is_near = vertex.distance() <= SAG * tolerance;
            if !is_near {
                let sides = self.mesh.face_half_edges(*f);
                if let Some(longest) =
                    sides.max_by(|a, b| self.length(*a).total_cmp(&self.length(*b)))
                {
                    marked[longest.index()] = true;
                    marked[longest.index() ^ 1] = true;
                }
            }
        }
        let edges = self.mesh.edges();
        let mut edges: Vec<HalfEdgeId> = edges
            .filter(|h| self.is_long(*h, marked[h.index()]))
            .collect();
        self.sort_by_length(&mut edges);
        let mut fresh = Vec::new();
        for (i, h) in edges.into_iter().rev().enumerate() {
            if i % BETWEEN == 0 {
                progress.again()?;
            }
            let [a, b] = [self.mesh.origin(h), self.mesh.target(h)];
            let place = self.mesh.position(a).midpoint(self.mesh.position(b));
            if self.is_half_free(h, place)
                && let Ok(v) = self.mesh.bisect_edge(h, place)
            {
                let radius = 0.5 * (self.radii[a.index()] + self.radii[b.index()]);
                self.vertices.resize(self.mesh.vertex_slots(), start(place));
                self.radii.resize(self.mesh.vertex_slots(), radius);
                self.vertices[v.index()] = start(place);
                self.radii[v.index()] = radius;
                self.guard.set_guarded(v, true);
                self.guard_again(v, &[]);
                fresh.push(v);
            }
        }
        // Two triangles for each cell that there may be.
        if self.mesh.face_count() > 2 * self.sizes.most {
            return Err(fail("the limbs take too many triangles"));
        }
        Ok(fresh)
    }
}

fn faces_out([a, b, c]: [&Vertex; 3]) -> bool {
    let area = (b.position - a.position).cross(c.position - a.position);
    let mean = a.normal() + b.normal() + c.normal();
    area.dot(mean) > OUTWARD * area.length() * mean.length()
}

/// Returns twice the area of a triangle, along its normal.
fn area([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a)
}

/// Splits the cells of places in the flesh as long as many terms matter in them, down to its
/// radius there.
fn narrow(
    space: &mut Space<'_>,
    places: &[(DVec3, f64)],
    sizes: &Sizes,
    progress: &mut Progress<'_>,
) -> Result<(), MeshError> {
    for _ in 0..=space.forest.usual {
        let forest = &space.forest;
        let leaves = places.iter().filter_map(|(place, radius)| {
            let leaf = forest.leaf_at(*place);
            let cell = &forest.cells[leaf as usize];
            let is_large = forest.size(cell.level).max_element() > WIDTHS * radius;
            let may_split = cell.child == NONE && cell.level < forest.usual;
            (may_split && is_large && space.has_many_terms(cell.part)).then_some(leaf)
        });
        let mut leaves: Vec<u32> = leaves.collect();
        leaves.sort_unstable();
        leaves.dedup();
        if leaves.is_empty() {
            return Ok(());
        }
        split_all(space, &leaves, sizes.threads, progress)?;
        if space.forest.cells.len() > sizes.most {
            return Err(fail("the limbs take too many cells"));
        }
    }
    Ok(())
}
