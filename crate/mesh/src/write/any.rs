//! The writer of any format.

use super::export::{Export, ExportedFile};
use super::prepared::prepare;
use super::{glb, obj, ply, stl, three_mf};
use crate::error::Error;
use crate::format::Format;

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
}
