//! Changes of the region.

use crate::clay::{Clay, Region};
use mesh::{FaceId, VertexId};
use std::collections::BTreeSet;

/// How faces that are chosen change the region.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Choice {
    /// They are the region.
    Replace,
    /// They are added to it.
    Add,
    /// They are taken out of it.
    Remove,
}

impl Choice {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Replace, Self::Add, Self::Remove];

    /// The word for it; none for the first.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Replace => "",
            Self::Add => "add",
            Self::Remove => "remove",
        }
    }
}

/// A change of the region without a tool.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RegionChange {
    /// All faces.
    All,
    /// No face.
    None,
    /// The others.
    Invert,
    /// The faces around, too, so many times.
    Grow(u32),
    /// Without the faces at its border, so many times.
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
        let is_inner = |v: VertexId| self.mesh.vertex_faces(v).all(|f| self.is_in_region(f));
        let mut faces = self.region_faces();
        faces.retain(|f| self.mesh.face_vertices(*f).all(is_inner));
        self.region = Region::Faces(faces);
    }
}
