//! The tetrahedra of a balanced forest: a body-centred lattice whose cells may differ in size.
//!
//! Between two leaves of one size, four tetrahedra stand around the line that joins their centres,
//! one for each edge of the common face, or two where a finer cell nearby divides that edge. Where
//! a leaf meets finer ones, each quarter of its face is two triangles, which make tetrahedra with
//! the centres on both sides. So all tetrahedra fit together face to face.

use crate::forest::{Forest, NONE, Side};
use crate::options::{MeshError, Progress};
use crate::parallel::map_told;
use crate::refine::NUDGE;
use crate::space::Space;
use field::{Jet, THRESHOLD};
use glam::DVec3;
use std::collections::{BTreeMap, BTreeSet};

/// Whole coordinates in one number.
pub type Key = u64;

/// Packs whole coordinates.
pub fn pack([x, y, z]: [u32; 3]) -> Key {
    u64::from(x) << 42 | u64::from(y) << 21 | u64::from(z)
}

/// Unpacks whole coordinates.
pub fn unpack(key: Key) -> [u32; 3] {
    [42, 21, 0].map(|shift| (key >> shift) as u32 & 0x1f_ffff)
}

/// The direction of a side of a cell: −x, +x, −y, +y, −z, +z.
pub fn direction(side: usize) -> [i64; 3] {
    let mut direction = [0; 3];
    direction[side / 2] = 2 * (side as i64 % 2) - 1;
    direction
}

/// Values at the vertices of the lattice near the surface.
#[derive(Debug, Default)]
pub struct Lattice {
    keys: Vec<Key>,
    values: Vec<(f64, DVec3)>,
    /// Values of the function at vertices whose value in the lattice was moved away from the
    /// threshold.
    moved: BTreeMap<Key, f64>,
    /// Vertices whose sign was changed.
    forced: BTreeSet<Key>,
}

impl Lattice {
    /// Index of a vertex.
    pub fn index(&self, key: Key) -> u32 {
        match self.keys.binary_search(&key) {
            Ok(i) | Err(i) => i as u32,
        }
    }

    /// Index of a vertex; `None` if it has no value.
    pub fn find(&self, key: Key) -> Option<u32> {
        self.keys.binary_search(&key).ok().map(|i| i as u32)
    }

    /// Number of vertices.
    pub fn len(&self) -> usize {
        self.keys.len()
    }

    /// The key of a vertex by its index.
    pub fn key(&self, index: u32) -> Key {
        self.keys[index as usize]
    }

    /// Value at a vertex, less the threshold: never 0.
    pub fn value(&self, index: u32) -> f64 {
        self.values[index as usize].0
    }

    /// Changes the sign at a vertex: the surface is near, but no vertex is beyond it.
    pub fn force(&mut self, key: Key) {
        if let Ok(i) = self.keys.binary_search(&key)
            && self.forced.insert(key)
        {
            self.values[i].0 = -self.values[i].0;
        }
    }

    /// Whether the sign at a vertex was changed.
    pub fn is_forced(&self, index: u32) -> bool {
        let key = self.keys.get(index as usize);
        key.is_some_and(|key| self.forced.contains(key))
    }

    /// Gradient at a vertex.
    pub fn gradient(&self, index: u32) -> DVec3 {
        self.values[index as usize].1
    }

    /// Value and gradient of the function at a vertex, without the changes that keep values off the
    /// threshold; `None` if it was not evaluated there.
    pub fn jet(&self, key: Key) -> Option<Jet<f64>> {
        let index = self.find(key)?;
        let value = match self.moved.get(&key) {
            Some(value) => *value,
            None if self.is_forced(index) => -self.value(index),
            None => self.value(index),
        };
        Some(Jet {
            value: value + THRESHOLD,
            gradient: self.gradient(index).to_array(),
        })
    }

    /// Evaluates the function at all vertices of the tetrahedra of some cells where that was not
    /// done, exactly or as well as a mesh within the tolerance needs it.
    ///
    /// # Errors
    /// If the caller cancels.
    pub fn extend(
        &mut self,
        space: &Space<'_>,
        cells: &[u32],
        is_exact: bool,
        tolerance: f64,
        threads: usize,
        progress: &mut Progress<'_>,
    ) -> Result<(), MeshError> {
        let mut wanted: Vec<(Key, u32)> = Vec::new();
        for node in cells {
            let mut add = |key| wanted.push((key, *node));
            tetrahedra(&space.forest, *node, &mut |keys, _| {
                keys.into_iter().for_each(&mut add)
            });
            if wanted.len() > MANY_KEYS {
                wanted.sort_unstable();
                wanted.dedup_by_key(|(key, _)| *key);
            }
        }
        wanted.sort_unstable();
        wanted.dedup_by_key(|(key, _)| *key);
        wanted.retain(|(key, _)| self.keys.binary_search(key).is_err());
        let jets = if is_exact {
            map_told(threads, &wanted, progress, |(key, node)| {
                let cell = &space.forest.cells[*node as usize];
                space.jet(cell.part, space.forest.position(unpack(*key)))
            })?
        } else {
            let places = wanted.iter().map(|(key, node)| {
                let part = space.forest.cells[*node as usize].part;
                (part, space.forest.position(unpack(*key)))
            });
            let places: Vec<(u32, DVec3)> = places.collect();
            space.jets_in_parts(&places, tolerance, threads, progress)?
        };
        let values = wanted.iter().zip(&jets).map(|((_, node), jet)| {
            let cell = &space.forest.cells[*node as usize];
            let gradient = DVec3::from_array(jet.gradient);
            let slope = gradient.length();
            let least = space.forest.size(cell.level).max_element();
            let least = slope * (NUDGE * tolerance).min(0.02 * least) + f64::MIN_POSITIVE;
            let exact = jet.value - THRESHOLD;
            // A value that is no number counts as outside.
            let value = if exact.abs() >= least {
                exact
            } else if exact > 0.0 {
                least
            } else {
                -least
            };
            (value, exact, gradient)
        });
        let values: Vec<(f64, f64, DVec3)> = values.collect();
        for ((key, _), (value, exact, _)) in wanted.iter().zip(&values) {
            if value != exact {
                self.moved.insert(*key, *exact);
            }
        }
        let values = values
            .into_iter()
            .map(|(value, _, gradient)| (value, gradient));
        let mut all: Vec<(Key, (f64, DVec3))> =
            self.keys.drain(..).zip(self.values.drain(..)).collect();
        all.extend(wanted.iter().map(|(key, _)| *key).zip(values));
        all.sort_unstable_by_key(|(key, _)| *key);
        (self.keys, self.values) = all.into_iter().unzip();
        Ok(())
    }
}

/// Vertices that are collected before doubles are removed.
const MANY_KEYS: usize = 8_000_000;

/// Calls a function with the corners of each tetrahedron of a leaf that the surface may cross, and
/// the one or two cells that it lies in. A tetrahedron between two such leaves comes once, with one
/// of them. Its corners a, b, c, d are turned so that (b−a)×(c−a)·(d−a) > 0.
pub fn tetrahedra(forest: &Forest, node: u32, each: &mut impl FnMut([Key; 4], [u32; 2])) {
    for side in 0..6 {
        let cell = &forest.cells[node as usize];
        let Some(neighbor) = forest.neighbor(cell, direction(side)) else {
            let center = pack(forest.center_key(cell));
            for triangle in boundary_triangles(forest, node, side) {
                let [a, b, c] = triangle;
                each([center, a, b, c], [node, node]);
            }
            continue;
        };
        let other = &forest.cells[neighbor as usize];
        if other.child != NONE {
            quarters(forest, node, side, each);
        } else if other.level < cell.level {
            // The coarser one has made them if it is crossed.
            if other.side != Side::Crossing {
                quarter(forest, neighbor, node, side ^ 1, each);
            }
        } else if other.side != Side::Crossing || node < neighbor {
            between(forest, node, neighbor, side, each);
        }
    }
}

/// The corners of a face, counter-clockwise seen from outside the cell, and for the edge from each
/// to the next the direction from the cell to that edge.
fn ring(low: [u32; 3], span: u32, side: usize) -> [([u32; 3], [i64; 3]); 4] {
    let (axis, is_high) = (side / 2, side % 2 == 1);
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let corner = |a: u32, b: u32| {
        let mut corner = low;
        corner[axis] += if is_high { span } else { 0 };
        corner[u] += a * span;
        corner[v] += b * span;
        corner
    };
    let toward = |along: usize, sign: i64| {
        let mut direction = [0; 3];
        direction[along] = sign;
        direction
    };
    if is_high {
        [
            (corner(0, 0), toward(v, -1)),
            (corner(1, 0), toward(u, 1)),
            (corner(1, 1), toward(v, 1)),
            (corner(0, 1), toward(u, -1)),
        ]
    } else {
        [
            (corner(0, 0), toward(u, -1)),
            (corner(0, 1), toward(v, 1)),
            (corner(1, 1), toward(u, 1)),
            (corner(1, 0), toward(v, -1)),
        ]
    }
}

fn middle(a: [u32; 3], b: [u32; 3]) -> [u32; 3] {
    [0, 1, 2].map(|i| a[i].midpoint(b[i]))
}

/// Calls a function with the edges of a face, halves where finer cells divide them. `across` is the
/// way over the face, if there are cells beyond.
fn face_edges(
    forest: &Forest,
    node: u32,
    side: usize,
    across: Option<[i64; 3]>,
    mut each: impl FnMut(Key, Key),
) {
    let cell = &forest.cells[node as usize];
    let is_divided = |direction: [i64; 3]| {
        let neighbor = forest.neighbor(cell, direction);
        neighbor.is_some_and(|i| forest.cells[i as usize].child != NONE)
    };
    let ring = ring(forest.corner(cell), forest.span(cell.level), side);
    for i in 0..4 {
        let ((a, toward), (b, _)) = (ring[i], ring[(i + 1) % 4]);
        let beyond = across.map(|across| [0, 1, 2].map(|k| across[k] + toward[k]));
        if is_divided(toward) || beyond.is_some_and(is_divided) {
            let half = pack(middle(a, b));
            each(pack(a), half);
            each(half, pack(b));
        } else {
            each(pack(a), pack(b));
        }
    }
}

/// The tetrahedra around the line between the centres of two leaves of one size.
fn between(
    forest: &Forest,
    node: u32,
    other: u32,
    side: usize,
    each: &mut impl FnMut([Key; 4], [u32; 2]),
) {
    let [from, to] = [node, other].map(|i| pack(forest.center_key(&forest.cells[i as usize])));
    face_edges(forest, node, side, Some(direction(side)), |a, b| {
        each([from, to, a, b], [node, other]);
    });
}

/// The tetrahedra at the four quarters of a side of a leaf with finer cells beyond.
fn quarters(forest: &Forest, node: u32, side: usize, each: &mut impl FnMut([Key; 4], [u32; 2])) {
    let cell = &forest.cells[node as usize];
    let Some(beyond) = forest.neighbor(cell, direction(side)) else {
        return;
    };
    let first = forest.cells[beyond as usize].child;
    for i in 0..8 {
        // Those at the face.
        if ((i >> (side / 2)) & 1) as usize != side % 2 {
            quarter(forest, node, first + i, side, each);
        }
    }
}

/// The tetrahedra at the quarter of a side of a leaf that a finer one covers.
fn quarter(
    forest: &Forest,
    coarse: u32,
    fine: u32,
    side: usize,
    each: &mut impl FnMut([Key; 4], [u32; 2]),
) {
    let [large, small] = [coarse, fine].map(|i| &forest.cells[i as usize]);
    let [outer, inner] = [large, small].map(|cell| pack(forest.center_key(cell)));
    let corners = ring(forest.corner(small), forest.span(small.level), side ^ 1).map(|(c, _)| c);
    // The diagonal starts in the middle of the coarse face.
    let span = forest.span(large.level);
    let face = ring(forest.corner(large), span, side).map(|(c, _)| c);
    let center = middle(face[0], face[2]);
    let start = corners.iter().position(|c| *c == center).unwrap_or(0);
    let [p, q, r, s] = [0, 1, 2, 3].map(|i| pack(corners[(start + i) % 4]));
    for [a, b, c] in [[p, q, r], [p, r, s]] {
        each([inner, a, b, c], [fine, fine]);
        each([outer, a, c, b], [coarse, coarse]);
    }
}

/// Triangles of a side of a leaf that is on the boundary of the box, counter-clockwise seen from
/// outside.
pub fn boundary_triangles(forest: &Forest, node: u32, side: usize) -> Vec<[Key; 3]> {
    let cell = &forest.cells[node as usize];
    let face = ring(forest.corner(cell), forest.span(cell.level), side).map(|(c, _)| c);
    let center = pack(middle(face[0], face[2]));
    let mut triangles = Vec::new();
    face_edges(forest, node, side, None, |a, b| {
        triangles.push([center, a, b])
    });
    triangles
}
