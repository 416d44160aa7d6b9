//! Convex polyhedra, cut by planes.
//!
//! A face is a list of directed edges in no particular order: cutting needs no more, as one edge of
//! a convex face enters the part that is cut off and one leaves it, and volumes are sums over
//! edges. So no case
//! of several vertices or planes in one place is special: degenerate edges and faces stay in the
//! lists and add nothing.

use glam::DVec3;

/// Convex polyhedron.
#[derive(Clone, Debug, Default)]
pub(crate) struct Cell {
    pub vertices: Vec<DVec3>,
    faces: Vec<Face>,
    /// Edges by face, counterclockwise from outside.
    edges: Vec<[u32; 2]>,
}

/// Face: its label, and the end of its edges in the list.
#[derive(Clone, Copy, Debug)]
struct Face {
    label: u32,
    end: u32,
}

/// Memory for [`Cell::cut`].
#[derive(Debug, Default)]
pub(crate) struct Scratch {
    heights: Vec<f64>,
    renumbered: Vec<u32>,
    made: Vec<([u32; 2], u32)>,
    rim: Vec<[u32; 2]>,
    next: Cell,
}

impl Cell {
    /// Becomes the cube around the origin with these half sides, whose faces have one label.
    pub fn set_cube(&mut self, half: f64, label: u32) {
        const FACES: [[u32; 4]; 6] = [
            [0, 4, 6, 2],
            [1, 3, 7, 5],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 2, 3, 1],
            [4, 5, 7, 6],
        ];
        self.vertices.clear();
        self.vertices.extend((0..8).map(|i| {
            let sides = [1, 2, 4].map(|bit| if i & bit == 0 { -half } else { half });
            DVec3::from_array(sides)
        }));
        self.faces.clear();
        self.edges.clear();
        for corners in FACES {
            let edges = (0..4).map(|i| [corners[i], corners[(i + 1) % 4]]);
            self.edges.extend(edges);
            let end = self.edges.len() as u32;
            self.faces.push(Face { label, end });
        }
    }

    /// Becomes a copy of another cell, in the memory it has.
    pub fn copy(&mut self, other: &Self) {
        self.vertices.clone_from(&other.vertices);
        self.faces.clone_from(&other.faces);
        self.edges.clone_from(&other.edges);
    }

    fn clear(&mut self) {
        self.vertices.clear();
        self.faces.clear();
        self.edges.clear();
    }

    /// Keeps the points x with `normal·x ≤ offset`; the new face gets the label. Returns whether
    /// something was cut off.
    pub fn cut(&mut self, normal: DVec3, offset: f64, label: u32, scratch: &mut Scratch) -> bool {
        let heights = &mut scratch.heights;
        heights.clear();
        heights.extend(self.vertices.iter().map(|v| normal.dot(*v) - offset));
        if heights.iter().all(|h| *h <= 0.0) {
            return false;
        }
        scratch.next.clear();
        scratch.made.clear();
        scratch.rim.clear();
        scratch.renumbered.clear();
        for (vertex, height) in self.vertices.iter().zip(&scratch.heights) {
            scratch.renumbered.push(scratch.next.vertices.len() as u32);
            if *height <= 0.0 {
                scratch.next.vertices.push(*vertex);
            }
        }
        let mut start = 0;
        for face in &self.faces {
            let edges = &self.edges[start..face.end as usize];
            start = face.end as usize;
            self.cut_face(edges, scratch);
            let (end, before) = (
                scratch.next.edges.len() as u32,
                scratch.next.faces.last().map_or(0, |face| face.end),
            );
            if end > before {
                let label = face.label;
                scratch.next.faces.push(Face { label, end });
            }
        }
        if !scratch.rim.is_empty() {
            scratch.next.edges.extend(&scratch.rim);
            let end = scratch.next.edges.len() as u32;
            scratch.next.faces.push(Face { label, end });
        }
        core::mem::swap(self, &mut scratch.next);
        true
    }

    /// Appends what remains of one face, and its edge with the new face, backwards, to the rim.
    fn cut_face(&self, edges: &[[u32; 2]], scratch: &mut Scratch) {
        let Scratch {
            heights,
            renumbered,
            made,
            rim,
            next,
        } = scratch;
        let first_of_rim = rim.len();
        let mut entries = 0;
        for [from, to] in edges.iter().copied() {
            let [is_from_in, is_to_in] = [from, to].map(|v| heights[v as usize] <= 0.0);
            let [new_from, new_to] = [from, to].map(|v| renumbered[v as usize]);
            // The same number for the same edge of the other face.
            let mut crossing = |inner: u32, outer: u32| {
                if let Some((_, vertex)) = made.iter().find(|(edge, _)| *edge == [inner, outer]) {
                    return *vertex;
                }
                let [a, b] = [inner, outer].map(|v| heights[v as usize]);
                let [p, q] = [inner, outer].map(|v| self.vertices[v as usize]);
                let vertex = next.vertices.len() as u32;
                next.vertices.push(p + (q - p) * (a / (a - b)));
                made.push(([inner, outer], vertex));
                vertex
            };
            match (is_from_in, is_to_in) {
                (true, true) => next.edges.push([new_from, new_to]),
                (true, false) => {
                    let exit = crossing(from, to);
                    next.edges.push([new_from, exit]);
                    // Edges of the rim run from entry to exit.
                    match rim[first_of_rim..].iter_mut().find(|e| e[1] == u32::MAX) {
                        Some(edge) => edge[1] = exit,
                        None => rim.push([u32::MAX, exit]),
                    }
                }
                (false, true) => {
                    let entry = crossing(to, from);
                    next.edges.push([entry, new_to]);
                    entries += 1;
                    match rim[first_of_rim..].iter_mut().find(|e| e[0] == u32::MAX) {
                        Some(edge) => edge[0] = entry,
                        None => rim.push([entry, u32::MAX]),
                    }
                }
                (false, false) => {}
            }
        }
        debug_assert_eq!(rim.len() - first_of_rim, entries, "a closed face");
        for [entry, exit] in &rim[first_of_rim..] {
            next.edges.push([*exit, *entry]);
        }
    }

    /// The labels of the faces whose area is more than `least`.
    pub fn labels(&self, least: f64) -> impl Iterator<Item = u32> + '_ {
        let starts = core::iter::once(0).chain(self.faces.iter().map(|face| face.end as usize));
        starts.zip(&self.faces).filter_map(move |(start, face)| {
            let edges = self.edges.get(start..face.end as usize)?;
            let (_, area) = self.apex_and_area(edges)?;
            (area.length() > 2.0 * least).then_some(face.label)
        })
    }

    /// Returns a corner of a face and twice its area along the normal; `None` without edges.
    fn apex_and_area(&self, edges: &[[u32; 2]]) -> Option<(DVec3, DVec3)> {
        let apex = self.vertices[edges.first()?[0] as usize];
        let mut area = DVec3::ZERO;
        for edge in edges {
            let [a, b] = edge.map(|v| self.vertices[v as usize] - apex);
            area += a.cross(b);
        }
        Some((apex, area))
    }

    /// The volume.
    pub fn volume(&self) -> f64 {
        let Some(origin) = self.vertices.first() else {
            return 0.0;
        };
        let mut sum = 0.0;
        let mut start = 0;
        for face in &self.faces {
            let edges = &self.edges[start..face.end as usize];
            start = face.end as usize;
            let Some((apex, area)) = self.apex_and_area(edges) else {
                continue;
            };
            sum += area.dot(apex - *origin);
        }
        sum / 6.0
    }

    /// The largest distance of a vertex from the origin.
    pub fn radius(&self) -> f64 {
        let squares = self.vertices.iter().map(|v| v.length_squared());
        squares.fold(0.0, f64::max).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cube_is_cut_to_an_octahedron() {
        let (mut cell, mut scratch) = (Cell::default(), Scratch::default());
        cell.set_cube(1.0, 9);
        assert!((cell.volume() - 8.0).abs() < 1e-15);
        for i in 0..8 {
            let sides = [1, 2, 4].map(|bit| if i & bit == 0 { -1.0 } else { 1.0 });
            let normal = DVec3::from_array(sides);
            assert!(cell.cut(normal, 1.0, i, &mut scratch));
        }
        // The volume within |x| + |y| + |z| ≤ 1.
        assert!((cell.volume() - 4.0 / 3.0).abs() < 1e-14);
        assert!((cell.radius() - 1.0).abs() < 1e-15);
        let mut labels: Vec<u32> = cell.labels(0.0).filter(|l| *l != 9).collect();
        labels.sort_unstable();
        assert_eq!(labels, [0, 1, 2, 3, 4, 5, 6, 7]);
    }

    #[test]
    fn plane_through_corners_and_edges_cuts_in_half() {
        let (mut cell, mut scratch) = (Cell::default(), Scratch::default());
        for normal in [DVec3::X, DVec3::X + DVec3::Y, DVec3::ONE] {
            cell.set_cube(1.0, 0);
            assert!(cell.cut(normal, 0.0, 1, &mut scratch));
            assert!((cell.volume() - 4.0).abs() < 1e-14);
            // Again, it has nothing to cut, and the opposite half leaves nothing.
            cell.cut(normal, 0.0, 2, &mut scratch);
            assert!((cell.volume() - 4.0).abs() < 1e-14);
            cell.cut(-normal, 0.0, 3, &mut scratch);
            assert!(cell.volume().abs() < 1e-14);
            cell.cut(normal, -1.0, 4, &mut scratch);
            assert_eq!(cell.volume(), 0.0);
        }
    }
}
