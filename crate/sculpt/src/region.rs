//! Changes of the region.

use crate::clay::{Clay, Region};
use mesh::{FaceId, VertexId};
use std::collections::BTreeSet;

/// Change of the region by faces that are chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Choice {
    /// The faces become the region.
    Replace,
    /// The faces are added to the region.
    Add,
    /// The faces are taken out of the region.
    Remove,
}

impl Choice {
    /// The choices, in the order of the manual.
    pub const ALL: [Self; 3] = [Self::Replace, Self::Add, Self::Remove];

    /// Returns the word for it in texts of strokes; an empty one for the first.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Replace => "",
            Self::Add => "add",
            Self::Remove => "remove",
        }
    }
}

/// Change of the region without a tool.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RegionChange {
    /// The region is all faces.
    All,
    /// The region is empty.
    None,
    /// Faces of the region leave it, the others join it.
    Invert,
    /// The faces around join the region, so many times.
    Grow(u32),
    /// The faces at the region's border leave it, so many times.
    Shrink(u32),
}

impl Clay {
    pub(crate) fn choose(&mut self, faces: &BTreeSet<FaceId>, how: Choice) {
        let old: BTreeSet<FaceId> = match how {
            Choice::Replace => BTreeSet::new(),
            _ => self.region_faces().into_iter().collect(),
        };
        let new: Vec<FaceId> = match how {
            Choice::Replace => faces.iter().copied().collect(),
            Choice::Add => old.union(faces).copied().collect(),
            Choice::Remove => old.difference(faces).copied().collect(),
        };
        self.region = Region::Faces(new);
    }

    /// Changes the region.
    pub fn change_region(&mut self, change: RegionChange) {
        match change {
            RegionChange::All => self.region = Region::All,
            RegionChange::None => self.region = Region::Faces(Vec::new()),
            RegionChange::Invert => {
                let others = self.mesh.faces().filter(|f| !self.is_in_region(*f));
                self.region = Region::Faces(others.collect());
            }
            RegionChange::Grow(times) => {
                for _ in 0..times {
                    self.grow();
                }
            }
            RegionChange::Shrink(times) => {
                for _ in 0..times {
                    self.shrink();
                }
            }
        }
    }

    fn grow(&mut self) {
        let Region::Faces(faces) = &self.region else {
            return;
        };
        let corners = faces.iter().flat_map(|f| self.mesh.face_vertices(*f));
        let corners: BTreeSet<VertexId> = corners.collect();
        let around = corners.iter().flat_map(|v| self.mesh.vertex_faces(*v));
        let grown: BTreeSet<FaceId> = around.collect();
        self.region = Region::Faces(grown.into_iter().collect());
    }

    fn shrink(&mut self) {
        let mut faces = self.region_faces();
        faces.retain(|f| {
            let mut around = self
                .mesh
                .face_vertices(*f)
                .flat_map(|v| self.mesh.vertex_faces(v));
            around.all(|f| self.is_in_region(f))
        });
        self.region = Region::Faces(faces);
    }
}
