//! The writer of any format.

use super::export::{Export, ExportedFile};
use super::prepared::prepare;
use super::rig::Rig;
use super::{glb, obj, ply, stl, three_mf};
use crate::error::{Error, fail};
use crate::format::Format;
use glam::DVec3;

impl Export {
    /// The files of a format: one, or two for OBJ (the second has the materials, if there are any).
    ///
    /// # Errors
    /// If there are no triangles, the parts are not sound (an index out of range, a list of the
    /// wrong length, a position that is not finite as a 32-bit number of millimetres), or they are
    /// over one of the [`crate::limits`].
    pub fn write(&self, format: Format) -> Result<Vec<ExportedFile>, Error> {
        let parts = prepare(self)?;
        let file = |extension: &str, bytes| ExportedFile {
            name: format!("{}.{extension}", self.name),
            bytes,
        };
        let bytes = match format {
            Format::Glb => glb::write(self, &parts, None)?,
            Format::ThreeMf => three_mf::write(self, &parts)?,
            Format::Stl => stl::write(&parts),
            Format::Ply => ply::write(self, &parts),
            Format::Obj => {
                let (object, materials) = obj::write(self, &parts);
                let mut files = vec![file("obj", object)];
                files.extend(materials.map(|bytes| file("mtl", bytes)));
                return Ok(files);
            }
        };
        Ok(vec![file(format.extension(), bytes)])
    }

    /// Returns a GLB file of the meshes with joints, weights and, if there are two frames or more,
    /// an animation.
    ///
    /// # Errors
    /// Fails as [`Export::write`] does, and if the rig does not fit the meshes.
    pub fn write_rigged(&self, rig: &Rig) -> Result<ExportedFile, Error> {
        let parts = prepare(self)?;
        if self.shift() != DVec3::ZERO {
            return fail(
                "the model is too far from its origin for a rig, whose numbers would spoil its \
                 shape; move it nearer, or write it without a rig",
            );
        }
        let vertices: Vec<usize> = parts.iter().map(|part| part.positions.len()).collect();
        rig.check(&vertices)?;
        Ok(ExportedFile {
            name: format!("{}.glb", self.name),
            bytes: glb::write(self, &parts, Some(rig))?,
        })
    }
}
