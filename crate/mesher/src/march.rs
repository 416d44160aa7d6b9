//! Marching tetrahedra: the level set of the linear interpolant, closed by lids where the box cuts
//! it off. Its vertices slide along the edges of the lattice to the surface: that keeps each
//! triangle in its tetrahedron, so that the mesh does not cut itself.

use crate::certify::{Vertex, root};
use crate::forest::{Forest, NONE, Side};
use crate::lattice::{Key, Lattice, boundary_triangles, tetrahedra, unpack};
use crate::options::{MeshError, Progress};
use crate::parallel::map_told;
use crate::refine::crossing;
use crate::space::Space;
use field::Ball;
use glam::DVec3;

/// An edge of the lattice on which a vertex of the mesh lies, as the numbers of its ends, the lower
/// one first; or twice the same vertex of the lattice.
type Place = u64;

/// The mesh before it is improved.
#[derive(Clone, Debug, Default)]
pub struct Raw {
    /// Vertices: on edges of the lattice where the surface crosses those, and at corners of lids.
    pub vertices: Vec<Vertex>,
    /// Triangles.
    pub triangles: Vec<[u32; 3]>,
    /// Whether each is a lid on the boundary of the box.
    pub is_lid: Vec<bool>,
    /// Places near the surface in the cells of vertices, if the mesh is dual to cells.
    pub anchors: Vec<DVec3>,
}

/// Vertices keep away from the ends of their edges by this share of them.
const MARGIN: f64 = 0.01;

/// Even permutations that bring one corner to the front.
const FIRST: [[usize; 4]; 4] = [[0, 1, 2, 3], [1, 0, 3, 2], [2, 0, 1, 3], [3, 0, 2, 1]];

/// Even permutations that bring two corners to the front, for pairs in the order 01, 02, 03, 12,
/// 13, 23.
const FIRST_TWO: [[usize; 4]; 6] = [
    [0, 1, 2, 3],
    [0, 2, 3, 1],
    [0, 3, 1, 2],
    [1, 2, 0, 3],
    [1, 3, 2, 0],
    [2, 3, 0, 1],
];

fn place(a: u32, b: u32) -> Place {
    u64::from(a.min(b)) << 32 | u64::from(a.max(b))
}

/// The ends of the edge of a place.
fn ends(place: Place) -> [u32; 2] {
    [(place >> 32) as u32, place as u32]
}

/// The triangles of the level set in a tetrahedron: none, one or two, outward for a positive one.
fn in_tetrahedron(corners: [u32; 4], inside: [bool; 4], mut each: impl FnMut([Place; 3])) {
    let count = inside.iter().filter(|i| **i).count();
    if let 1 | 3 = count {
        let is_one = count == 1;
        let alone = inside.iter().position(|i| *i == is_one).unwrap_or(0);
        let [a, b, c, d] = FIRST[alone].map(|i| corners[i]);
        let [p, q, r] = [b, c, d].map(|other| place(a, other));
        each(if is_one { [p, q, r] } else { [p, r, q] });
    } else if count == 2 {
        let is_first = |order: &&[usize; 4]| inside[order[0]] && inside[order[1]];
        let order = FIRST_TWO.iter().find(is_first).unwrap_or(&FIRST_TWO[0]);
        let [a, b, c, d] = order.map(|i| corners[i]);
        let [p, q, r, s] = [place(a, c), place(a, d), place(b, d), place(b, c)];
        each([p, q, r]);
        each([p, r, s]);
    }
}

/// The part of a triangle of the box's boundary that is inside.
fn lid(corners: [u32; 3], inside: [bool; 3], mut each: impl FnMut([Place; 3])) {
    let count = inside.iter().filter(|i| **i).count();
    let turned = |is_first: bool| {
        let first = inside.iter().position(|i| *i == is_first).unwrap_or(0);
        [0, 1, 2].map(|i| corners[(first + i) % 3])
    };
    match count {
        3 => each(corners.map(|i| place(i, i))),
        1 => {
            let [a, b, c] = turned(true);
            each([place(a, a), place(a, b), place(a, c)]);
        }
        2 => {
            let [a, b, c] = turned(false);
            each([place(a, b), place(b, b), place(c, c)]);
            each([place(a, b), place(c, c), place(c, a)]);
        }
        _ => {}
    }
}

/// The triangles of one cell.
fn in_cell(forest: &Forest, lattice: &Lattice, node: u32) -> Vec<([Place; 3], bool)> {
    let mut triangles = Vec::new();
    tetrahedra(forest, node, &mut |keys, _| {
        let corners = keys.map(|key| lattice.index(key));
        let inside = corners.map(|i| lattice.value(i) > 0.0);
        in_tetrahedron(corners, inside, |places| triangles.push((places, false)));
    });
    triangles.extend(lids(forest, node, |key| {
        let index = lattice.index(key);
        (index, lattice.value(index) > 0.0)
    }));
    triangles
}

/// The lids of a leaf on the boundary of the box.
fn lids(
    forest: &Forest,
    node: u32,
    mut vertex: impl FnMut(Key) -> (u32, bool),
) -> Vec<([Place; 3], bool)> {
    let mut triangles = Vec::new();
    for side in 0..6 {
        let cell = &forest.cells[node as usize];
        if forest
            .neighbor(cell, crate::lattice::direction(side))
            .is_some()
        {
            continue;
        }
        for triangle in boundary_triangles(forest, node, side) {
            let vertices = triangle.map(&mut vertex);
            let [corners, inside] = [vertices.map(|v| v.0), vertices.map(|v| u32::from(v.1))];
            lid(corners, inside.map(|i| i == 1), |places| {
                triangles.push((places, true));
            });
        }
    }
    triangles
}

/// The level set of the interpolant in all cells. Leaves that are wholly inside have lids, too:
/// `lattice` is extended by their vertices. With a tolerance, vertices are put onto the surface as
/// well as that needs it, eight at a time.
///
/// # Errors
/// If the caller cancels.
pub fn march(
    space: &Space<'_>,
    lattice: &Lattice,
    tolerance: Option<f64>,
    threads: usize,
    progress: &mut Progress<'_>,
) -> Result<Raw, MeshError> {
    let forest = &space.forest;
    let cells = crossing(forest);
    let mut triangles: Vec<([Place; 3], bool)> = map_told(threads, &cells, progress, |node| {
        in_cell(forest, lattice, *node)
    })?
    .into_iter()
    .flatten()
    .collect();
    // Vertices of lids away from the surface are not in the lattice: they are numbered after it.
    let mut beyond: Vec<Key> = Vec::new();
    let inside: Vec<u32> = (0..forest.cells.len() as u32)
        .filter(|i| {
            let cell = &forest.cells[*i as usize];
            cell.child == NONE && cell.side == Side::Inside
        })
        .collect();
    for node in &inside {
        let _ = lids(forest, *node, |key| {
            if lattice.find(key).is_none() {
                beyond.push(key);
            }
            (0, true)
        });
    }
    beyond.sort_unstable();
    beyond.dedup();
    let number = |key: Key| match (lattice.find(key), beyond.binary_search(&key)) {
        (Some(i), _) => i,
        (None, Ok(i) | Err(i)) => (lattice.len() + i) as u32,
    };
    for node in &inside {
        triangles.extend(lids(forest, *node, |key| (number(key), true)));
    }

    let mut places: Vec<Place> = triangles.iter().flat_map(|(places, _)| *places).collect();
    places.sort_unstable();
    places.dedup();
    let at = |index: u32| {
        let key = match (index as usize).checked_sub(lattice.len()) {
            Some(i) => beyond[i],
            None => lattice.key(index),
        };
        forest.position(unpack(key))
    };
    let found = match tolerance {
        None => vec![None; places.len()],
        Some(tolerance) => {
            let edges = places.iter().map(|place| {
                let [a, b] = ends(*place);
                (a != b).then(|| Edge::new(lattice, [a, b], [at(a), at(b)]))
            });
            Edge::roots(edges.collect(), space, tolerance, threads, progress)?
        }
    };
    let places_found: Vec<(Place, Option<Vertex>)> = places.iter().copied().zip(found).collect();
    let vertices = map_told(threads, &places_found, progress, |(place, found)| {
        if let Some(vertex) = found {
            return *vertex;
        }
        let [a, b] = ends(*place);
        if a == b {
            return Vertex::new(at(a), &space.jet_at(at(a)));
        }
        if lattice.is_forced(a) || lattice.is_forced(b) {
            let middle = at(a).midpoint(at(b));
            return Vertex::new(middle, &space.jet_at(middle));
        }
        let values = [a, b].map(|i| lattice.value(i));
        root(space, [at(a), at(b)], values, MARGIN)
    })?;
    let index = |place: &Place| match places.binary_search(place) {
        Ok(i) | Err(i) => i as u32,
    };
    Ok(Raw {
        vertices,
        triangles: triangles
            .iter()
            .map(|(p, _)| p.each_ref().map(index))
            .collect(),
        is_lid: triangles.iter().map(|(_, is_lid)| *is_lid).collect(),
        anchors: Vec::new(),
    })
}

/// An edge of the lattice that the surface crosses.
#[derive(Clone, Copy)]
struct Edge {
    ends: [DVec3; 2],
    /// Values at its ends, less the threshold.
    values: [f64; 2],
    /// Share of the way at which the surface is.
    share: f64,
}

/// The root of the cubic polynomial with these values, of different signs, and slopes at 0 and 1;
/// not quite at an end.
pub fn crossing_share([a, b]: [f64; 2], [c, d]: [f64; 2]) -> f64 {
    let rest = b - a - c;
    let bend = d - c;
    // a + c·t + square·t² + cube·t³.
    let (square, cube) = (3.0 * rest - bend, bend - 2.0 * rest);
    let (mut low, mut high) = (0.0, 1.0);
    let mut t = a / (a - b);
    for _ in 0..6 {
        let value = a + t * (c + t * (square + t * cube));
        let slope = c + t * (2.0 * square + t * 3.0 * cube);
        *(if (value > 0.0) == (a > 0.0) {
            &mut low
        } else {
            &mut high
        }) = t;
        let next = t - value / slope;
        t = if next > low && next < high {
            next
        } else {
            0.5 * (low + high)
        };
    }
    t.clamp(MARGIN, 1.0 - MARGIN)
}

/// Largest distance from the surface of vertices that two steps put onto it, in tolerances.
const NEAR: f64 = 0.02;

impl Edge {
    fn new(lattice: &Lattice, numbers: [u32; 2], ends: [DVec3; 2]) -> Self {
        let way = ends[1] - ends[0];
        let values = numbers.map(|i| lattice.value(i));
        let slopes = numbers.map(|i| lattice.gradient(i).dot(way));
        Self {
            ends,
            values,
            share: crossing_share(values, slopes),
        }
    }

    fn place(&self) -> DVec3 {
        // Exact where the edge is across an axis.
        self.ends[0] + (self.ends[1] - self.ends[0]) * self.share
    }

    /// The places of the surface on edges by two evaluations each; `None` where that is not enough.
    fn roots(
        mut edges: Vec<Option<Self>>,
        space: &Space<'_>,
        tolerance: f64,
        threads: usize,
        progress: &mut Progress<'_>,
    ) -> Result<Vec<Option<Vertex>>, MeshError> {
        let parts = map_told(threads, &edges, progress, |edge| {
            edge.map_or(NONE, |Self { ends: [a, b], .. }| {
                space.part_for(Ball {
                    center: a.midpoint(b),
                    radius: 0.5 * a.distance(b),
                })
            })
        })?;
        let mut found: Vec<Option<Vertex>> = vec![None; edges.len()];
        for step in 0..2 {
            let known = (0..).zip(&edges).zip(&parts);
            let known = known.filter_map(|((i, edge), part)| Some((i, edge.as_ref()?, *part)));
            let known = known.filter(|(i, ..)| found[*i].is_none());
            let places: Vec<(usize, (u32, DVec3))> = known
                .map(|(i, edge, part)| (i, (part, edge.place())))
                .collect();
            let (numbers, places): (Vec<usize>, Vec<(u32, DVec3)>) = places.into_iter().unzip();
            let jets = space.jets_in_parts(&places, tolerance, threads, progress)?;
            for (i, ((_, place), jet)) in numbers.into_iter().zip(places.iter().zip(jets)) {
                let vertex = Vertex::new(*place, &jet);
                let Some(edge) = &mut edges[i] else {
                    continue;
                };
                let off = vertex.value.abs() / vertex.gradient.length();
                let is_end = edge.share <= MARGIN || edge.share >= 1.0 - MARGIN;
                // Not so for NaN.
                if off <= NEAR * tolerance || (is_end && step == 1) {
                    found[i] = Some(vertex);
                }
                let slope = vertex.gradient.dot(edge.ends[1] - edge.ends[0]);
                let next = edge.share - vertex.value / slope;
                let is_first = (vertex.value > 0.0) == (edge.values[0] > 0.0);
                let is_ahead = (next > edge.share) == is_first;
                if next.is_finite() && is_ahead {
                    edge.share = next.clamp(MARGIN, 1.0 - MARGIN);
                }
            }
        }
        Ok(found)
    }
}
