//! Changes that a stroke has made, for undo.

use crate::clay::{Clay, Region};
use crate::error::Error;
use glam::DVec3;
use mesh::{HalfEdgeMesh, ListPatch, MeshPatch};

/// The changes of a stroke: [`Delta::swap`] takes them back, and again carries them out.
#[derive(Clone, Debug, Default)]
pub(crate) struct Delta {
    pub moved: Vec<(u32, DVec3)>,
    pub colors: Vec<(u32, [f32; 3])>,
    pub masks: Vec<(u32, f32)>,
    pub region: Option<Region>,
    pub symmetry: Option<[bool; 3]>,
    pub is_painted: Option<bool>,
    pub topology: Option<Box<Topology>>,
}

/// Changes of elements, and of all that is kept beside them.
#[derive(Clone, Debug)]
pub(crate) struct Topology {
    mesh: MeshPatch,
    colors: ListPatch<[f32; 3]>,
    masks: ListPatch<f32>,
}

impl Topology {
    /// The changes since an earlier state.
    fn between(old: &State, new: &Clay) -> Self {
        Self {
            mesh: MeshPatch::between(&old.mesh, &new.mesh),
            colors: ListPatch::between(&old.colors, &new.colors, |a, b| {
                a.map(f32::to_bits) == b.map(f32::to_bits)
            }),
            masks: ListPatch::between(&old.masks, &new.masks, |a, b| a.to_bits() == b.to_bits()),
        }
    }
}

impl Delta {
    /// Exchanges the values that are kept with the present ones.
    pub fn swap(&mut self, clay: &mut Clay) {
        for (v, position) in &mut self.moved {
            *position = clay.replace_position(*v, *position);
        }
        for (v, color) in &mut self.colors {
            core::mem::swap(color, &mut clay.colors[*v as usize]);
        }
        for (v, mask) in &mut self.masks {
            core::mem::swap(mask, &mut clay.masks[*v as usize]);
        }
        if let Some(region) = &mut self.region {
            core::mem::swap(region, &mut clay.region);
        }
        if let Some(symmetry) = &mut self.symmetry {
            core::mem::swap(symmetry, &mut clay.symmetry);
        }
        if let Some(is_painted) = &mut self.is_painted {
            core::mem::swap(is_painted, &mut clay.is_painted);
        }
        if let Some(topology) = &mut self.topology {
            clay.mesh.swap(&mut topology.mesh);
            topology.colors.swap(&mut clay.colors);
            topology.masks.swap(&mut clay.masks);
            clay.index_vertices();
        }
    }

    /// Bytes that it takes.
    pub fn bytes(&self) -> usize {
        let topology = self
            .topology
            .as_ref()
            .map_or(0, |t| t.mesh.bytes() + t.colors.bytes() + t.masks.bytes());
        let region = match &self.region {
            Some(Region::Faces(faces)) => 4 * faces.len(),
            _ => 0,
        };
        size_of::<Self>()
            + topology
            + region
            + 32 * self.moved.len()
            + 16 * self.colors.len()
            + 8 * self.masks.len()
    }
}

impl Clay {
    /// Carries out a change of the elements. If it fails, everything is as it was before.
    pub(crate) fn change(
        &mut self,
        change: impl FnOnce(&mut Self) -> Result<(), Error>,
    ) -> Result<Delta, Error> {
        let old = State {
            mesh: self.mesh.clone(),
            colors: self.colors.clone(),
            masks: self.masks.clone(),
        };
        let region = self.region.clone();
        match change(self) {
            Ok(()) => {
                self.index_vertices();
                Ok(Delta {
                    topology: Some(Box::new(Topology::between(&old, self))),
                    region: (region != self.region).then_some(region),
                    ..Delta::default()
                })
            }
            Err(error) => {
                self.mesh = old.mesh;
                self.colors = old.colors;
                self.masks = old.masks;
                self.region = region;
                Err(error)
            }
        }
    }
}

/// The elements of a mesh, and what is kept beside them.
struct State {
    mesh: HalfEdgeMesh,
    colors: Vec<[f32; 3]>,
    masks: Vec<f32>,
}
