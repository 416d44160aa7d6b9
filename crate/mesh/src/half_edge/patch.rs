//! Differences between two states of a mesh, for undo.

use super::connectivity::HalfEdgeMesh;
use glam::DVec3;

/// Equal values between two changes that are stored rather than beginning a new run: a run costs
/// about as much.
const SHORT_GAP: usize = 8;

/// Contents of a list in another state: its length, and runs of values that differ.
#[derive(Clone, Debug, PartialEq)]
pub struct ListPatch<T> {
    length: usize,
    runs: Vec<(usize, Vec<T>)>,
}

impl<T: Copy> ListPatch<T> {
    /// The patch that makes `old` of `new`. `is_same` must compare bits, so that the first bits
    /// come back.
    pub fn between(old: &[T], new: &[T], is_same: impl Fn(&T, &T) -> bool) -> Self {
        let mut runs: Vec<(usize, Vec<T>)> = Vec::new();
        let shared = old.len().min(new.len());
        let mut i = 0;
        while i < shared {
            if is_same(&old[i], &new[i]) {
                i += 1;
                continue;
            }
            // From the first difference to the last one before a long gap.
            let start = i;
            let mut end = i + 1;
            while i < shared && i < end + SHORT_GAP {
                if !is_same(&old[i], &new[i]) {
                    end = i + 1;
                }
                i += 1;
            }
            i = end;
            runs.push((start, old[start..end].to_vec()));
        }
        if old.len() > shared {
            runs.push((shared, old[shared..].to_vec()));
        }
        Self {
            length: old.len(),
            runs,
        }
    }

    /// Gives the list its other state, and becomes the patch that leads back.
    pub fn swap(&mut self, list: &mut Vec<T>) {
        let present = list.len();
        let cut = list.get(self.length..).map(<[T]>::to_vec);
        list.truncate(self.length);
        for (start, values) in &mut self.runs {
            let inside = present.saturating_sub(*start).min(values.len());
            for (value, place) in values.iter_mut().zip(&mut list[*start..*start + inside]) {
                core::mem::swap(value, place);
            }
            list.extend(values.drain(inside..));
        }
        self.runs.retain(|(_, values)| !values.is_empty());
        if let Some(cut) = cut.filter(|cut| !cut.is_empty()) {
            self.runs.push((self.length, cut));
        }
        self.length = present;
    }

    /// Bytes that it takes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        size_of::<Self>()
            + self
                .runs
                .iter()
                .map(|(_, values)| size_of::<(usize, Vec<T>)>() + values.len() * size_of::<T>())
                .sum::<usize>()
    }
}

/// Difference between two states of a mesh, which leads from one to the other and back by
/// [`HalfEdgeMesh::swap`]. It takes space only for what differs.
///
/// ```
/// use glam::DVec3;
/// use mesh::{HalfEdgeMesh, MeshPatch, PolygonSoup};
///
/// let mut soup = PolygonSoup::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y]);
/// soup.add_face(&[0, 1, 2]);
/// let first = HalfEdgeMesh::from_polygons(&soup)?;
/// let mut mesh = first.clone();
/// let face = mesh.faces().next().unwrap();
/// mesh.poke_face(face, DVec3::Z)?;
/// let later = mesh.clone();
///
/// let mut patch = MeshPatch::between(&first, &mesh);
/// mesh.swap(&mut patch);
/// assert_eq!(mesh, first);
/// mesh.swap(&mut patch);
/// assert_eq!(mesh, later);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct MeshPatch {
    positions: ListPatch<DVec3>,
    /// Lists of numbers, in the order of [`HalfEdgeMesh::lists`].
    lists: [ListPatch<u32>; 9],
}

impl MeshPatch {
    /// The patch that makes `old` of `new`.
    #[must_use]
    pub fn between(old: &HalfEdgeMesh, new: &HalfEdgeMesh) -> Self {
        let (before, after) = (old.lists(), new.lists());
        Self {
            positions: ListPatch::between(&old.positions, &new.positions, |a, b| {
                a.to_array().map(f64::to_bits) == b.to_array().map(f64::to_bits)
            }),
            lists: core::array::from_fn(|i| ListPatch::between(before[i], after[i], |a, b| a == b)),
        }
    }

    /// Bytes that it takes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.positions.bytes() + self.lists.iter().map(ListPatch::bytes).sum::<usize>()
    }
}

impl HalfEdgeMesh {
    /// Gives the mesh its other state, and the patch becomes the one that leads back. The mesh must
    /// be in one of the two states that the patch was made of.
    pub fn swap(&mut self, patch: &mut MeshPatch) {
        patch.positions.swap(&mut self.positions);
        let lists = [
            &mut self.outgoing,
            &mut self.next,
            &mut self.prev,
            &mut self.origin,
            &mut self.face,
            &mut self.face_first,
            &mut self.free_vertices,
            &mut self.free_edges,
            &mut self.free_faces,
        ];
        for (patch, list) in patch.lists.iter_mut().zip(lists) {
            patch.swap(list);
        }
    }

    fn lists(&self) -> [&[u32]; 9] {
        [
            &self.outgoing,
            &self.next,
            &self.prev,
            &self.origin,
            &self.face,
            &self.face_first,
            &self.free_vertices,
            &self.free_edges,
            &self.free_faces,
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_of_any_lengths_lead_to_each_other() {
        let lists: [&[u32]; 7] = [
            &[],
            &[1],
            &[1, 2, 3],
            &[1, 9, 3, 4],
            &[7; 40],
            &[
                1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23,
            ],
            &[
                0, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 0, 0,
            ],
        ];
        for old in lists {
            for new in lists {
                let mut patch = ListPatch::between(old, new, |a, b| a == b);
                let mut list = new.to_vec();
                for _ in 0..2 {
                    patch.swap(&mut list);
                    assert_eq!(list, old);
                    patch.swap(&mut list);
                    assert_eq!(list, new);
                }
            }
        }
        // Changes that are far apart are stored apart.
        let patch = ListPatch::between(lists[5], lists[6], |a, b| a == b);
        assert_eq!(patch.runs, [(0, vec![1]), (21, vec![22, 23])]);
    }
}
