//! Coatings: coarse closed meshes around the pieces of a skeleton that follow it while a hand drags
//! it.
//!
//! Angelidis, Jepp and Cani 2002, §3. Each maximal piece of a skeleton without branches has a
//! [`Cage`]: a closed mesh each vertex of which moves along a ray (u, t, d) from a point u of the
//! skeleton in a direction d, to where the field is T. An edge is split where |f(middle) − T|
//! exceeds a bound; the rays of its ends are interpolated for the new vertex. When the skeleton
//! moves, each search starts from the last t.
//!
//! Nothing is proved of these meshes: pieces overlap where they blend, and what no ray meets is not
//! there. The meshes of [`crate::mesh_scene`] are for files.

use crate::cages::{Cage, Spoke};
use crate::options::{MeshError, Progress};
use crate::space::SLACK;
use core::ops::ControlFlow;
use field::{Ball, Implicit, Jet, Part, Slack, THRESHOLD};
use glam::DVec3;
use mesh::{Aabb, TriangleMesh};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Most times that triangles are divided.
const DEEPEST: u32 = 8;
/// Edges between rays that are nearer to each other than this share of their steps are not split:
/// the surface jumps between them …
const ALIKE: f64 = 1.0 / 32.0;
/// … and than this one where one ray stays inside.
const ALIKE_INSIDE: f64 = 0.5;
/// Vertices are brought so near to the surface, as a share of the bound on |f − T| …
const CLOSE: f64 = 0.08;
/// … where f may be off by this share of the bound, as a polynomial may stand for its far terms.
const FAR: f64 = 0.02;
/// Steps of Newton's method from a known place before the ray is searched from its start.
const STEPS: usize = 4;
/// Bisections of a bracket, Newton's steps included.
const NARROWINGS: usize = 40;
/// Terms that are evaluated between two reports: some milliseconds.
const BETWEEN: u64 = 100_000;

/// The rays of a coating with where they met the surface last: what the next one starts from.
///
/// ```
/// use field::{BlobScale, Kernel, Primitive, Shaping, Skeleton, Sum};
/// use glam::DVec3;
/// use mesher::{Cage, Coating};
///
/// let shaping = Shaping {
///     kernel: Kernel::Gauss,
///     radius: 0.3,
///     blobbiness: 2.0,
///     blob_scale: BlobScale::Relative,
///     strength: 1.0,
///     influence: 1e-3,
///     taper: None,
/// };
/// let limb = |apex: DVec3| {
///     let skeleton = Skeleton::Segment { base: DVec3::ZERO, apex };
///     let sum: Sum = Primitive::new(skeleton, &shaping, None).into_iter().collect();
///     (sum, Cage::around_lines(&[[(DVec3::ZERO, 0.3), (apex, 0.3)]]))
/// };
/// let mut coating = Coating::default();
/// let (sum, cages) = limb(DVec3::X);
/// let first = coating.update(&sum, &cages, &|_| 0.05);
/// // The skeleton moves a little: all is found again with fewer evaluations.
/// let (sum, cages) = limb(DVec3::new(1.0, 0.02, 0.0));
/// let second = coating.update(&sum, &cages, &|_| 0.05);
/// assert!(second.evaluations < first.evaluations);
/// assert!(second.mesh.signed_volume() > 0.2);
/// ```
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Coating {
    /// The last distance along each ray, by the ray's number.
    known: BTreeMap<u64, f64>,
}

/// A coating's mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Coat {
    /// Closed shells, one for each cage, with normals.
    pub mesh: TriangleMesh,
    /// Evaluations of the function.
    pub evaluations: u64,
    /// Vertices whose ray does not leave the surface within its reach: they are inside, where other
    /// shells cover them.
    pub buried: usize,
    /// The largest |f − T| in the middle of an edge with both ends on the surface.
    pub excess: f64,
    /// Cages without a shell: coating them would take too long.
    pub left_out: usize,
}

impl Coating {
    /// Most triangles of a coating: edges are not split further beyond.
    pub const MOST_TRIANGLES: usize = 400_000;
    /// Most primitives that are evaluated at a point, summed over all points: some seconds. Edges
    /// are not split further beyond, and beyond twice as many the cages that are left get no
    /// shells.
    pub const MOST_WORK: u64 = 40_000_000;

    /// Coats the cages of a function with the bound on |f − T| in the middles of edges, which may
    /// depend on the place: larger far from the eye, say.
    pub fn update(
        &mut self,
        function: &dyn Implicit,
        cages: &[Cage],
        bound: &dyn Fn(DVec3) -> f64,
    ) -> Coat {
        let mut go_on = |_| ControlFlow::Continue(());
        self.update_told(function, cages, bound, &mut Progress::new(&mut go_on))
            // Nothing cancels it.
            .unwrap_or_default()
    }

    /// The same with reports of the progress.
    ///
    /// # Errors
    /// If the caller cancels; then all that was known before is kept.
    pub fn update_told(
        &mut self,
        function: &dyn Implicit,
        cages: &[Cage],
        bound: &dyn Fn(DVec3) -> f64,
        progress: &mut Progress<'_>,
    ) -> Result<Coat, MeshError> {
        let mut work = Work {
            function,
            bound,
            before: &self.known,
            known: BTreeMap::new(),
            coat: Coat::default(),
            part: None,
            terms: 1,
            done: 0,
            told: 0,
        };
        let mut positions = Vec::new();
        let mut normals = Vec::new();
        let mut triangles = Vec::new();
        let mut left = Self::MOST_TRIANGLES;
        for (number, cage) in cages.iter().enumerate() {
            if work.done > 2 * Self::MOST_WORK {
                work.coat.left_out = cages.len() - number;
                break;
            }
            work.narrow(cage, cages.len());
            let (vertices, own) = work.shell(number, cage, left, progress)?;
            left = left.saturating_sub(own.len());
            let first = positions.len() as u32;
            for vertex in &vertices {
                positions.push(vertex.position);
                normals.push(-DVec3::from_array(vertex.jet.gradient).normalize_or_zero());
                work.coat.buried += usize::from(vertex.is_buried);
            }
            triangles.extend(own.iter().map(|t| t.map(|i| i + first)));
        }
        let Work { known, coat, .. } = work;
        self.known = known;
        let mut mesh = TriangleMesh::new(positions, triangles);
        mesh.normals = Some(normals);
        Ok(Coat { mesh, ..coat })
    }
}

/// A vertex of a coating.
#[derive(Clone, Copy, Debug)]
struct Vertex {
    spoke: Spoke,
    number: u64,
    along: f64,
    position: DVec3,
    jet: Jet<f64>,
    is_buried: bool,
}

struct Work<'a> {
    function: &'a dyn Implicit,
    bound: &'a dyn Fn(DVec3) -> f64,
    before: &'a BTreeMap<u64, f64>,
    known: BTreeMap<u64, f64>,
    coat: Coat,
    /// The terms of the function that matter around the present cage; `None` if all do.
    part: Option<Part>,
    /// Their number.
    terms: u64,
    /// Terms that were evaluated.
    done: u64,
    /// Terms that were evaluated when the progress was reported last.
    told: u64,
}

impl Work<'_> {
    /// Finds the terms of the function that matter along the rays of one of so many cages.
    fn narrow(&mut self, cage: &Cage, count: usize) {
        let bounds = Aabb::of_points(cage.spokes.iter().map(|spoke| spoke.origin));
        let center = bounds.center();
        let far = |spoke: &Spoke| spoke.origin.distance(center) + spoke.reach;
        let radius = cage.spokes.iter().map(far).fold(0.0, f64::max);
        let ball = Ball {
            center,
            radius: radius * (1.0 + 1e-9),
        };
        let slack = Slack {
            left_out: SLACK,
            far: FAR * (self.bound)(center),
        };
        self.part = self.function.narrow(ball, None, slack);
        let terms = self.part.as_ref().map_or(count, |part| part.terms.len());
        self.terms = terms.max(1) as u64;
    }

    /// Reports the progress now and then.
    fn tell(&mut self, progress: &mut Progress<'_>) -> Result<(), MeshError> {
        if self.done < self.told + BETWEEN {
            return Ok(());
        }
        self.told = self.done;
        progress.at(self.done as f32 / (2 * Coating::MOST_WORK) as f32)
    }

    fn jet(&mut self, point: DVec3) -> Jet<f64> {
        self.coat.evaluations += 1;
        self.done += self.terms;
        match &self.part {
            Some(part) => self.function.jet_of(part, point),
            None => self.function.jet(point),
        }
    }

    /// The vertices and triangles of a cage, most triangles as given.
    fn shell(
        &mut self,
        number: usize,
        cage: &Cage,
        most: usize,
        progress: &mut Progress<'_>,
    ) -> Result<(Vec<Vertex>, Vec<[u32; 3]>), MeshError> {
        let mut vertices: Vec<Vertex> = Vec::with_capacity(cage.spokes.len());
        for (i, spoke) in cage.spokes.iter().enumerate() {
            self.tell(progress)?;
            let number = mixed((number as u64) << 32 | i as u64);
            vertices.push(self.meet(cage, *spoke, number, None));
        }
        let mut done: Vec<[u32; 3]> = Vec::new();
        let mut open = cage.triangles.clone();
        for depth in 0..=DEEPEST {
            let may_split = depth < DEEPEST
                && done.len() + 4 * open.len() <= most
                && self.done <= Coating::MOST_WORK;
            let middles = self.split(cage, &mut vertices, &open, may_split, progress)?;
            let of_edge = |a: u32, b: u32| {
                let edge = [a.min(b), a.max(b)];
                let found = middles.binary_search_by_key(&edge, |(edge, _)| *edge);
                found.ok().map(|i| middles[i].1)
            };
            let mut next = Vec::new();
            for triangle in open {
                let [a, b, c] = triangle;
                let halves = [of_edge(a, b), of_edge(b, c), of_edge(c, a)];
                match halves.iter().flatten().count() {
                    0 => done.push(triangle),
                    _ => divide(&vertices, triangle, halves, &mut next),
                }
            }
            open = next;
            if open.is_empty() {
                break;
            }
        }
        done.extend(open);
        Ok((vertices, done))
    }

    /// Splits the edges of some triangles that need it, and returns those with their new vertices,
    /// sorted.
    fn split(
        &mut self,
        cage: &Cage,
        vertices: &mut Vec<Vertex>,
        triangles: &[[u32; 3]],
        may_split: bool,
        progress: &mut Progress<'_>,
    ) -> Result<Vec<([u32; 2], u32)>, MeshError> {
        let mut edges: Vec<[u32; 2]> = triangles
            .iter()
            .flat_map(|[a, b, c]| [[*a, *b], [*b, *c], [*c, *a]])
            .map(|[a, b]| [a.min(b), a.max(b)])
            .collect();
        edges.sort_unstable();
        edges.dedup();
        let mut middles = Vec::new();
        for edge in edges {
            self.tell(progress)?;
            let [a, b] = edge.map(|i| vertices[i as usize]);
            if a.is_buried && b.is_buried {
                continue;
            }
            let middle = a.position.midpoint(b.position);
            let excess = (self.jet(middle).value - THRESHOLD).abs();
            if may_split && !are_alike(&a, &b) && excess > (self.bound)(middle) {
                let direction = a.spoke.direction + b.spoke.direction;
                let spoke = Spoke {
                    origin: a.spoke.origin.midpoint(b.spoke.origin),
                    direction: direction.normalize_or(a.spoke.direction),
                    step: 0.5 * (a.spoke.step + b.spoke.step),
                    reach: 0.5 * (a.spoke.reach + b.spoke.reach),
                };
                let number = mixed(a.number.min(b.number) ^ mixed(a.number.max(b.number)));
                let vertex = self.meet(cage, spoke, number, Some(0.5 * (a.along + b.along)));
                middles.push((edge, vertices.len() as u32));
                vertices.push(vertex);
            } else if !(a.is_buried || b.is_buried) {
                self.coat.excess = self.coat.excess.max(excess);
            }
        }
        Ok(middles)
    }

    /// The vertex of a ray: from where it was last, else from a guess, else from the skeleton
    /// outwards.
    fn meet(&mut self, cage: &Cage, spoke: Spoke, number: u64, guess: Option<f64>) -> Vertex {
        self.done += 10 * cage.lines.len() as u64;
        let end = cage.end(&spoke);
        let start = self.before.get(&number).copied().or(guess);
        let near = start
            .filter(|t| *t > 0.0 && *t < end)
            .and_then(|t| self.follow(&spoke, end, t));
        let (along, jet, is_buried) = near.unwrap_or_else(|| self.search(&spoke, end));
        self.known.insert(number, along);
        Vertex {
            spoke,
            number,
            along,
            position: spoke.origin + spoke.direction * along,
            jet,
            is_buried,
        }
    }

    fn close(&self, at: DVec3) -> f64 {
        CLOSE * (self.bound)(at)
    }

    /// Newton's method along a ray from a place near the surface.
    fn follow(&mut self, spoke: &Spoke, end: f64, start: f64) -> Option<(f64, Jet<f64>, bool)> {
        let mut along = start;
        for _ in 0..STEPS {
            let at = spoke.origin + spoke.direction * along;
            let jet = self.jet(at);
            let slope = DVec3::from_array(jet.gradient).dot(spoke.direction);
            // A ray leaves the surface there, does not enter it.
            if slope >= 0.0 || jet.value.is_nan() {
                return None;
            }
            let excess = jet.value - THRESHOLD;
            if excess.abs() <= self.close(at) {
                return Some((along, jet, false));
            }
            let step = (-excess / slope).clamp(-spoke.step, spoke.step);
            along += step;
            if !(along > 0.0 && along < end) {
                return None;
            }
        }
        None
    }

    /// The first place where a ray leaves the inside: in steps, then between two of them.
    fn search(&mut self, spoke: &Spoke, end: f64) -> (f64, Jet<f64>, bool) {
        let at = |along: f64| spoke.origin + spoke.direction * along;
        let mut low = (0.0, self.jet(at(0.0)));
        // A skeleton without a surface around it: the vertex stays on it. Not so for NaN.
        let is_inside = low.1.value > THRESHOLD;
        if !is_inside {
            return (0.0, low.1, true);
        }
        let mut high = low;
        while high.1.value > THRESHOLD {
            low = high;
            if low.0 >= end {
                return (low.0, low.1, true);
            }
            let next = (low.0 + spoke.step).min(end);
            high = (next, self.jet(at(next)));
        }
        for _ in 0..NARROWINGS {
            // From the end whose step of Newton's stays within.
            let newton = [low, high].map(|(along, jet)| {
                let slope = DVec3::from_array(jet.gradient).dot(spoke.direction);
                along - (jet.value - THRESHOLD) / slope
            });
            let is_within = |t: &&f64| **t > low.0 && **t < high.0;
            let middle = 0.5 * (low.0 + high.0);
            let along = newton.iter().find(is_within).copied().unwrap_or(middle);
            let jet = self.jet(at(along));
            if (jet.value - THRESHOLD).abs() <= self.close(at(along)) {
                return (along, jet, false);
            }
            if jet.value > THRESHOLD {
                low = (along, jet);
            } else {
                high = (along, jet);
            }
        }
        (low.0, low.1, false)
    }
}

/// Whether two rays are so near to each other that no ray is put between them.
fn are_alike(a: &Vertex, b: &Vertex) -> bool {
    let turn = a.spoke.direction.distance(b.spoke.direction) * a.along.max(b.along);
    let apart = a.spoke.origin.distance(b.spoke.origin) + turn;
    let share = if a.is_buried || b.is_buried {
        ALIKE_INSIDE
    } else {
        ALIKE
    };
    apart < share * a.spoke.step.min(b.spoke.step)
}

/// The parts of a triangle some edges of which are split: a–b, b–c, c–a.
fn divide(
    vertices: &[Vertex],
    [a, b, c]: [u32; 3],
    halves: [Option<u32>; 3],
    out: &mut Vec<[u32; 3]>,
) {
    // Turned so that the edges that are split come first.
    match halves {
        [Some(p), Some(q), Some(r)] => out.extend([[a, p, r], [p, b, q], [r, q, c], [p, q, r]]),
        [Some(p), None, None] => out.extend([[a, p, c], [p, b, c]]),
        [Some(p), Some(q), None] => {
            out.push([p, b, q]);
            let length = |i: u32, j: u32| {
                let [i, j] = [i, j].map(|i| vertices[i as usize].position);
                i.distance_squared(j)
            };
            if length(a, q) <= length(p, c) {
                out.extend([[a, p, q], [a, q, c]]);
            } else {
                out.extend([[a, p, c], [p, q, c]]);
            }
        }
        [None, None, None] => out.push([a, b, c]),
        [x, y, z] => divide(vertices, [b, c, a], [y, z, x], out),
    }
}

/// A number that is mixed well, the same everywhere (the last step of SplitMix64).
fn mixed(number: u64) -> u64 {
    let number = number.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let number = (number ^ (number >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let number = (number ^ (number >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    number ^ (number >> 31)
}
