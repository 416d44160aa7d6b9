//! The formats of mesh files.

use crate::error::Error;
use serde::{Deserialize, Serialize};

/// File format that can be read and written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Format {
    /// Binary glTF: parts, groups, normals, colours, materials; metres.
    Glb,
    /// 3D Manufacturing Format: parts, colours, materials; millimetres.
    ThreeMf,
    /// STL, written in its binary form: triangles only; millimetres.
    Stl,
    /// Wavefront OBJ with an MTL file: parts, groups, normals, colours, materials; millimetres.
    Obj,
    /// PLY, written in its binary form: normals and colours; millimetres.
    Ply,
}

/// First bytes that tell a format.
const BEGINNINGS: [(&[u8], Format); 4] = [
    (b"glTF", Format::Glb),
    (b"PK\x03\x04", Format::ThreeMf),
    (b"ply\n", Format::Ply),
    (b"ply\r", Format::Ply),
];

impl Format {
    /// Formats, each once.
    pub const ALL: [Self; 5] = [Self::Glb, Self::ThreeMf, Self::Stl, Self::Obj, Self::Ply];
    /// The endings of file names, for messages.
    pub const ENDINGS: &str = ".glb, .3mf, .stl, .obj, .ply";

    /// Returns the error of a file that is of none of the formats.
    #[must_use]
    pub fn refuse() -> Error {
        Error(format!("meshes are read from files {}", Self::ENDINGS))
    }

    /// The ending of file names, without the dot.
    #[must_use]
    pub fn extension(self) -> &'static str {
        match self {
            Self::Glb => "glb",
            Self::ThreeMf => "3mf",
            Self::Stl => "stl",
            Self::Obj => "obj",
            Self::Ply => "ply",
        }
    }

    /// The format of a file name's ending, in any case; `None` for others.
    ///
    /// ```
    /// assert_eq!(mesh::Format::of_name("a.STL"), Some(mesh::Format::Stl));
    /// assert_eq!(mesh::Format::of_name("stl"), None);
    /// ```
    #[must_use]
    pub fn of_name(name: &str) -> Option<Self> {
        let (_, ending) = name.rsplit_once('.')?;
        Self::ALL
            .into_iter()
            .find(|format| ending.eq_ignore_ascii_case(format.extension()))
    }

    /// The format that the first bytes of a file tell; `None` if they do not, as those of OBJ and
    /// STL files.
    #[must_use]
    pub fn of_bytes(bytes: &[u8]) -> Option<Self> {
        BEGINNINGS
            .iter()
            .find(|(beginning, _)| bytes.starts_with(beginning))
            .map(|(_, format)| *format)
    }

    /// The format by which [`crate::read`] takes a file: that of its first bytes, else that of its
    /// name.
    ///
    /// ```
    /// use mesh::Format;
    ///
    /// assert_eq!(Format::of("a.stl", b"glTF"), Some(Format::Glb));
    /// assert_eq!(Format::of("a.stl", b"solid a"), Some(Format::Stl));
    /// ```
    #[must_use]
    pub fn of(name: &str, bytes: &[u8]) -> Option<Self> {
        Self::of_bytes(bytes).or_else(|| Self::of_name(name))
    }
}

#[cfg(test)]
mod tests {
    use super::Format;

    #[test]
    fn endings_are_those_of_all_formats() {
        let endings = Format::ALL.map(|format| format!(".{}", format.extension()));
        assert_eq!(Format::ENDINGS, endings.join(", "));
    }
}
