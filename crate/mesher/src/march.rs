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
/// `lattice` is extended by their vertices.
///
/// # Errors
/// If the caller cancels.
pub fn march(
    space: &Space<'_>,
    lattice: &Lattice,
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
    let vertices = map_told(threads, &places, progress, |place| {
        let [a, b] = [(place >> 32) as u32, *place as u32];
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
    })
}
