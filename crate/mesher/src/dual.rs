//! The mesh that is dual to cells: a vertex for each leaf that the surface crosses, in the middle
//! of its part there and put onto it, and a polygon for each edge of leaves whose ends are on
//! different sides, through the leaves around it (Ju, Losasso, Schaefer and Warren 2002).
//!
//! It is closed where the surface does not reach the end of the box, and a manifold where the
//! polygons around each leaf make one ring: other leaves are split.

use crate::certify::{Vertex, descend, sag};
use crate::crease::{self, TURNED, meet};
use crate::forest::{Forest, NONE, Side};
use crate::grow::{Corners, Sizes, each_crossed_edge, grow, on_edge, split_all};
use crate::march::Raw;
use crate::options::{MeshError, Progress};
use crate::parallel::map_told;
use crate::refine::crossing;
use crate::space::Space;
use glam::DVec3;

/// Most times that leaves are split for the sake of the mesh's topology.
const ROUNDS: usize = 24;
/// Most times for a mesh that may touch or cut itself.
const ROUGH: usize = 3;
/// Most leaves that are split at once for its sake.
const MOST_PINCHED: usize = 5000;
/// Largest distances from the surface of the middle of a triangle and of a vertex, by first-order
/// estimates in tolerances. Leaves with others are split, but not below the usual size.
const OFF: f64 = 0.8;
const ON: f64 = 0.1;
/// Newton's steps that put a vertex onto the surface.
const STEPS: usize = 3;
/// Distance from its leaf's centre that a vertex may have along an axis, in sides of the leaf.
const ROOM: f64 = 0.6;

/// A polygon around an edge of leaves.
struct Polygon {
    /// Leaves in the order of the corners, the last one twice if it is a triangle.
    leaves: [u32; 4],
    /// The place where the surface crosses the edge.
    place: DVec3,
}

impl Polygon {
    fn corners(&self) -> &[u32] {
        let is_triangle = self.leaves[2] == self.leaves[3];
        &self.leaves[..if is_triangle { 3 } else { 4 }]
    }
}

/// Divides the cells that are not known yet, and makes the mesh; `None` where the surface reaches
/// the end of the box, or touches itself too closely for leaves to tell it apart.
///
/// # Errors
/// If there are too many cells, or if the caller cancels.
pub fn dual(
    space: &mut Space<'_>,
    corners: &mut Corners,
    sizes: &Sizes,
    progress: &mut Progress<'_>,
) -> Result<Option<Raw>, MeshError> {
    for round in 0..ROUNDS {
        let start = round as f32 / ROUNDS as f32;
        let mut part = progress.part(start, 1.0);
        let Some(polygons) = close(space, corners, sizes, &mut part)? else {
            return Ok(None);
        };
        let rings = polygons.iter().map(Polygon::corners);
        let mut bad = find_pinched(rings);
        if bad.is_empty() {
            let mut mesh = Mesh::new(space, corners, &polygons, sizes, progress)?;
            bad = mesh.triangulate(&polygons);
            if bad.is_empty() {
                bad = mesh.find_far(space, sizes, progress)?;
                if bad.is_empty() || round + 1 == ROUNDS {
                    return Ok(Some(mesh.raw));
                }
                split_all(space, &bad, sizes.threads, progress)?;
                continue;
            }
        }
        let cells = &space.forest.cells;
        let mut levels = bad.iter().map(|i| cells[*i as usize].level);
        if bad.len() > MOST_PINCHED || levels.any(|level| level >= space.forest.deepest) {
            return Ok(None);
        }
        split_all(space, &bad, sizes.threads, progress)?;
    }
    Ok(None)
}

/// Makes the mesh as [`dual`] does, but leaves it where it is no manifold after some rounds.
///
/// # Errors
/// If there are too many cells, or if the caller cancels.
pub fn sketch(
    space: &mut Space<'_>,
    corners: &mut Corners,
    sizes: &Sizes,
    progress: &mut Progress<'_>,
) -> Result<Option<Raw>, MeshError> {
    for round in 0..=ROUGH {
        let mut part = progress.part(round as f32 / (ROUGH + 1) as f32, 1.0);
        let Some(polygons) = close(space, corners, sizes, &mut part)? else {
            break;
        };
        let mut bad = find_pinched(polygons.iter().map(Polygon::corners));
        if bad.is_empty() || round == ROUGH {
            let mut mesh = Mesh::new(space, corners, &polygons, sizes, progress)?;
            bad = mesh.triangulate(&polygons);
            if bad.is_empty() || round == ROUGH {
                return Ok(Some(mesh.raw));
            }
        }
        let deepest = space.forest.deepest;
        bad.retain(|leaf| space.forest.cells[*leaf as usize].level < deepest);
        split_all(space, &bad, sizes.threads, progress)?;
    }
    Ok(None)
}

/// Divides the cells that are not known yet, and returns the polygons between all that the surface
/// crosses; `None` where it reaches the end of the box.
fn close(
    space: &mut Space<'_>,
    corners: &mut Corners,
    sizes: &Sizes,
    progress: &mut Progress<'_>,
) -> Result<Option<Vec<Polygon>>, MeshError> {
    let mut crossed = Vec::new();
    for round in 0..ROUNDS {
        let start = round as f32 / ROUNDS as f32;
        let mut part = progress.part(start, 1.0);
        grow(space, corners, crossed, sizes, &mut part)?;
        if is_cut(space) {
            break;
        }
        let Some(polygons) = polygons(space, corners, sizes.threads, progress)? else {
            break;
        };
        crossed = find_missing(space, &polygons);
        if crossed.is_empty() {
            return Ok(Some(polygons));
        }
    }
    Ok(None)
}

/// Whether the end of the box is inside somewhere.
fn is_cut(space: &Space<'_>) -> bool {
    let forest = &space.forest;
    let span = forest.span(0);
    forest.cells.iter().any(|cell| {
        let (low, own) = (forest.corner(cell), forest.span(cell.level));
        let is_end = (0..3).any(|k| low[k] == 0 || low[k] + own == forest.counts[k] * span);
        cell.child == NONE && cell.side == Side::Inside && is_end
    })
}

/// The polygons; `None` if one reaches the end of the box.
fn polygons(
    space: &Space<'_>,
    corners: &Corners,
    threads: usize,
    progress: &mut Progress<'_>,
) -> Result<Option<Vec<Polygon>>, MeshError> {
    let forest = &space.forest;
    let cells = crossing(forest);
    let found = map_told(threads, &cells, progress, |node| {
        let mut found = Vec::new();
        let mut is_open = false;
        each_crossed_edge(forest, corners, *node, true, |ring, ends| {
            let [Some(a), Some(b), Some(c), Some(d)] = ring else {
                is_open = true;
                return;
            };
            let mut leaves = [a, b, c, d];
            if let Some(i) = (0..4).find(|i| leaves[*i] == leaves[(i + 1) % 4]) {
                // The same leaf twice comes last.
                leaves.rotate_left((i + 2) % 4);
            }
            found.push(Polygon {
                leaves,
                place: on_edge(ends),
            });
        });
        (!is_open).then_some(found)
    })?;
    let found: Option<Vec<Vec<Polygon>>> = found.into_iter().collect();
    Ok(found.map(|found| found.into_iter().flatten().collect()))
}

/// The leaves of polygons that are not known to be crossed, in ascending order.
fn find_missing(space: &Space<'_>, polygons: &[Polygon]) -> Vec<u32> {
    let all = polygons.iter().flat_map(|polygon| polygon.leaves);
    let missing = all.filter(|i| space.forest.cells[*i as usize].side != Side::Crossing);
    let mut missing: Vec<u32> = missing.collect();
    missing.sort_unstable();
    missing.dedup();
    missing
}

/// The mesh with its leaves.
struct Mesh {
    raw: Raw,
    /// The leaf of each vertex, in ascending order.
    leaves: Vec<u32>,
}

impl Mesh {
    /// The vertices.
    fn new(
        space: &Space<'_>,
        corners: &Corners,
        polygons: &[Polygon],
        sizes: &Sizes,
        progress: &mut Progress<'_>,
    ) -> Result<Self, MeshError> {
        let forest = &space.forest;
        let all = polygons.iter().flat_map(|polygon| polygon.leaves);
        let mut leaves: Vec<u32> = all.collect();
        leaves.sort_unstable();
        leaves.dedup();
        let mut sums = vec![(DVec3::ZERO, 0.0); leaves.len()];
        for polygon in polygons {
            for leaf in polygon.corners() {
                if let Ok(i) = leaves.binary_search(leaf) {
                    sums[i] = (sums[i].0 + polygon.place, sums[i].1 + 1.0);
                }
            }
        }
        fn size(forest: &Forest, leaf: u32) -> DVec3 {
            forest.size(forest.cells[leaf as usize].level)
        }
        let middles = leaves.iter().zip(&sums).map(|(leaf, (sum, count))| {
            let longest = 0.5 * size(forest, *leaf).max_element();
            (*sum / *count, longest)
        });
        let middles: Vec<(DVec3, f64)> = middles.collect();
        let anchors = middles.iter().map(|(place, _)| *place).collect();
        let mut vertices = descend(
            space,
            &middles,
            STEPS,
            sizes.tolerance,
            sizes.threads,
            progress,
        )?;
        // A vertex that has left its leaf could make triangles cut others.
        let away = (0..leaves.len()).filter(|i| !has_room(forest, leaves[*i], &vertices[*i]));
        let away: Vec<usize> = away.collect();
        let middles: Vec<(DVec3, f64)> = away.iter().map(|i| middles[*i]).collect();
        let back = descend(space, &middles, 0, sizes.tolerance, sizes.threads, progress)?;
        for (i, vertex) in away.into_iter().zip(back) {
            vertices[i] = vertex;
        }
        let raw = Raw {
            vertices,
            anchors,
            ..Raw::default()
        };
        let mut mesh = Self { raw, leaves };
        mesh.sharpen(space, corners, polygons, sizes, progress)?;
        Ok(mesh)
    }

    /// Moves the vertices of leaves with a crease onto it.
    fn sharpen(
        &mut self,
        space: &Space<'_>,
        corners: &Corners,
        polygons: &[Polygon],
        sizes: &Sizes,
        progress: &mut Progress<'_>,
    ) -> Result<(), MeshError> {
        let (forest, vertices) = (&space.forest, &mut self.raw.vertices);
        let is_turned = self.leaves.iter().zip(&*vertices).map(|(leaf, vertex)| {
            let normal = vertex.normal();
            corners.of(*leaf).is_some_and(|ends| {
                let mut turns = ends.iter().map(|end| end.normal().dot(normal));
                turns.any(|turn| turn < TURNED)
            })
        });
        let is_turned: Vec<bool> = is_turned.collect();
        let mut places: Vec<(usize, DVec3)> = Vec::new();
        for polygon in polygons {
            for leaf in polygon.corners() {
                let found = self.leaves.binary_search(leaf);
                places.extend(
                    found
                        .ok()
                        .filter(|i| is_turned[*i])
                        .map(|i| (i, polygon.place)),
                );
            }
        }
        // The sort keeps the order of each leaf's places.
        places.sort_by_key(|(i, _)| *i);
        let goals = places.iter().map(|(i, place)| {
            let size = forest.size(forest.cells[self.leaves[*i] as usize].level);
            (*place, 0.1 * size.max_element())
        });
        let goals: Vec<(DVec3, f64)> = goals.collect();
        let (tolerance, threads) = (sizes.tolerance, sizes.threads);
        let found = descend(space, &goals, 1, tolerance, threads, progress)?;
        let mut edges = Vec::new();
        let mut at = 0;
        for same in places.chunk_by(|one, other| one.0 == other.0) {
            let own = &found[at..at + same.len()];
            at += same.len();
            if crease::is_turned(own) {
                edges.push((same[0].0, meet(own)));
            }
        }
        let goals = edges.iter().map(|(i, edge)| {
            let size = forest.size(forest.cells[self.leaves[*i] as usize].level);
            (*edge, 0.1 * size.max_element())
        });
        let goals: Vec<(DVec3, f64)> = goals.collect();
        let found = descend(space, &goals, STEPS, tolerance, threads, progress)?;
        for ((i, _), vertex) in edges.into_iter().zip(found) {
            let is_near = vertex.distance() <= ON * tolerance;
            if is_near && has_room(forest, self.leaves[i], &vertex) {
                vertices[i] = vertex;
            }
        }
        Ok(())
    }

    /// Makes triangles of the polygons, and returns the leaves at which they are no manifold.
    fn triangulate(&mut self, polygons: &[Polygon]) -> Vec<u32> {
        let vertices = &self.raw.vertices;
        let mut triangles: Vec<[u32; 3]> = Vec::new();
        for polygon in polygons {
            let [a, b, c, d] = polygon
                .leaves
                .map(|leaf| self.leaves.partition_point(|own| *own < leaf) as u32);
            if c == d {
                triangles.push([a, b, c]);
                continue;
            }
            // Along the lower arc.
            let [one, other] = [[a, c], [b, d]]
                .map(|ends| ends.map(|i| &vertices[i as usize]))
                .map(|[from, to]| sag(from, to));
            if one <= other {
                triangles.extend([[a, b, c], [a, c, d]]);
            } else {
                triangles.extend([[a, b, d], [b, c, d]]);
            }
        }
        let bad = find_pinched(triangles.iter().map(|t| &t[..]));
        self.raw.is_lid = vec![false; triangles.len()];
        self.raw.triangles = triangles;
        let bad = bad.into_iter().map(|i| self.leaves[i as usize]);
        bad.collect()
    }
}

/// Whether a vertex is so near its leaf that its triangles cut no others.
fn has_room(forest: &Forest, leaf: u32, vertex: &Vertex) -> bool {
    let cell = &forest.cells[leaf as usize];
    let off = (vertex.position - forest.center(cell)).abs();
    off.cmple(ROOM * forest.size(cell.level)).all()
}

/// Whether a place is too far from the surface by a first-order estimate, or that is no number.
fn is_beyond(place: &Vertex, most: f64) -> bool {
    let is_near = place.distance() <= most;
    !is_near
}

impl Mesh {
    /// Returns the leaves, in ascending order, in which the mesh is far from the surface and which
    /// are larger than usual: samples at their corners did not tell how the surface bends there.
    fn find_far(
        &self,
        space: &Space<'_>,
        sizes: &Sizes,
        progress: &mut Progress<'_>,
    ) -> Result<Vec<u32>, MeshError> {
        let Raw {
            vertices,
            triangles,
            ..
        } = &self.raw;
        let middles = triangles.iter().map(|corners| {
            let [a, b, c] = corners.map(|i| vertices[i as usize].position);
            ((a + b + c) / 3.0, 0.0)
        });
        let middles: Vec<(DVec3, f64)> = middles.collect();
        let found = descend(space, &middles, 0, sizes.tolerance, sizes.threads, progress)?;
        let [off, on] = [OFF, ON].map(|most| most * sizes.tolerance);
        let corners = triangles.iter().zip(&found);
        let corners = corners.filter(|(_, middle)| is_beyond(middle, off));
        let corners = corners.flat_map(|(corners, _)| *corners);
        let astray = (0..).zip(vertices).filter(|(_, own)| is_beyond(own, on));
        let astray = astray.map(|(i, _)| i);
        let far = corners.chain(astray).map(|i| self.leaves[i as usize]);
        let forest = &space.forest;
        let large = far.filter(|leaf| forest.cells[*leaf as usize].level < forest.usual);
        let mut far: Vec<u32> = large.collect();
        far.sort_unstable();
        far.dedup();
        Ok(far)
    }
}

/// The vertices of polygons whose edges do not all have two sides, or around which the polygons
/// make more than one ring; in ascending order.
fn find_pinched<'a>(polygons: impl Iterator<Item = &'a [u32]>) -> Vec<u32> {
    // For each corner of a polygon its vertex, the next one, and the one before.
    let corners = polygons.flat_map(|own| {
        let count = own.len();
        (0..count).map(move |i| [own[i], own[(i + 1) % count], own[(i + count - 1) % count]])
    });
    let mut corners: Vec<[u32; 3]> = corners.collect();
    corners.sort_unstable();
    let mut bad = Vec::new();
    for own in corners.chunk_by(|one, other| one[0] == other[0]) {
        let mut at = own[0][1];
        let mut length = 0;
        // Each next vertex comes once, and the ring closes after all triangles.
        let is_ring = own.windows(2).all(|pair| pair[0][1] != pair[1][1])
            && loop {
                let Ok(i) = own.binary_search_by_key(&at, |corner| corner[1]) else {
                    break false;
                };
                (at, length) = (own[i][2], length + 1);
                if at == own[0][1] {
                    break length == own.len();
                }
                if length > own.len() {
                    break false;
                }
            };
        if !is_ring {
            bad.push(own[0][0]);
        }
    }
    bad
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pinch_is_found() {
        // A pyramid over a square.
        let base = [[4, 3, 2, 1]];
        let sides = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]];
        fn polygons(sides: &[[u32; 3]], bases: &[[u32; 4]]) -> Vec<Vec<u32>> {
            let sides = sides.iter().map(|own| own.to_vec());
            sides.chain(bases.iter().map(|own| own.to_vec())).collect()
        }
        fn find(all: &[Vec<u32>]) -> Vec<u32> {
            find_pinched(all.iter().map(|own| &own[..]))
        }
        let whole = polygons(&sides, &base);
        assert!(find(&whole).is_empty());
        // Open along two edges.
        assert_eq!(find(&polygons(&sides[..3], &base)), [0, 1, 4]);
        // Another one that shares the tip.
        let second = polygons(&sides, &base).into_iter();
        let second = second.map(|own| {
            own.iter()
                .map(|i| if *i == 0 { 0 } else { i + 4 })
                .collect()
        });
        let both: Vec<Vec<u32>> = whole.iter().cloned().chain(second).collect();
        assert_eq!(find(&both), [0]);
        // Another one that shares an edge.
        let other = polygons(&sides, &base).into_iter();
        let other = other.map(|own| {
            own.iter()
                .map(|i| if *i < 2 { *i } else { i + 4 })
                .collect()
        });
        let both: Vec<Vec<u32>> = whole.into_iter().chain(other).collect();
        assert_eq!(find(&both), [0, 1]);
    }
}
