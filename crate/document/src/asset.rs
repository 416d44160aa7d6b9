//! Images, meshes and skeletons that a work refers to: accepted formats, and messages about them.
//!
//! Only their headers are read here; the language interprets them.

use ::archive::Archive;
use ::picture::{Format, file};
pub use rats::Asset;
use std::path::Path;

/// Largest image or mesh, bytes.
pub const MAX_ASSET: usize = 16 << 20;
/// Largest sum of all images and meshes of a work, bytes.
pub const MAX_ALL: usize = 48 << 20;
/// Most images and meshes of a work.
pub const MAX_ASSETS: usize = 16;
/// Longest side of an image, pixels.
pub const MAX_SIDE: u32 = 4096;
/// Most members of a 3MF package.
const MAX_PARTS: usize = 4096;

/// Kind of an asset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A picture: PNG, or another format that `darkroom` reads.
    Image,
    /// A mesh of triangles or polygons.
    Mesh,
    /// Limbs with radii.
    Skeleton,
}

/// Returns the end of a file's name after the last dot, in lower case.
#[must_use]
pub fn extension(name: &str) -> String {
    name.rsplit_once('.')
        .map(|(_, end)| end.to_ascii_lowercase())
        .unwrap_or_default()
}

/// Returns the kind of a file by its name; `None` if it is neither.
#[must_use]
pub fn kind(name: &str) -> Option<Kind> {
    if rats::is_image(name) {
        Some(Kind::Image)
    } else if rats::is_mesh(name) {
        Some(Kind::Mesh)
    } else {
        rats::is_skeleton(name).then_some(Kind::Skeleton)
    }
}

/// Whether a file holds limbs: by its name, or as its content says where files of that name may
/// hold a mesh or points, too.
#[must_use]
pub fn is_skeleton(name: &str, bytes: &[u8]) -> bool {
    match extension(name).as_str() {
        "obj" => count_lines(bytes, b"l") > 0 && count_lines(bytes, b"f") == 0,
        "ply" => mesh::formats::ply::elements(bytes).is_ok_and(|elements| {
            elements
                .iter()
                .any(|own| own.name == "edge" && own.count > 0)
        }),
        // A molecule counts its atoms in its first line, and names an element in each other one.
        "xyz" => {
            let text = String::from_utf8_lossy(&bytes[..bytes.len().min(4096)]);
            let mut lines = text.lines();
            let is_count = lines
                .next()
                .is_some_and(|line| line.trim().parse::<u32>().is_ok());
            let third = lines.nth(1).and_then(|line| line.split_whitespace().next());
            is_count && third.is_some_and(|word| word.starts_with(|c: char| c.is_alphabetic()))
        }
        "3mf" => has_beams(bytes),
        _ => kind(name) == Some(Kind::Skeleton),
    }
}

/// Whether a 3MF file has a beam lattice: one of its models says so near its beginning.
fn has_beams(bytes: &[u8]) -> bool {
    let Ok(archive) = Archive::open(bytes, MAX_PARTS) else {
        return false;
    };
    let models = archive.entries().iter();
    let models = models.filter(|entry| entry.name.ends_with(".model"));
    models.take(16).any(|entry| {
        let text = archive.read(entry, 2 * MAX_ASSET).unwrap_or_default();
        text.windows(11).any(|part| part == b"beamlattice")
    })
}

/// Describes the file's content in a few words.
///
/// # Errors
/// Returns why the file is not of its name's format, or too large.
pub fn facts(asset: &Asset) -> Result<String, String> {
    match kind(&asset.name) {
        Some(Kind::Image) => {
            let [width, height] = Format::of(Path::new(&asset.name))
                .and_then(|format| file::size(&asset.bytes, format))
                .map_err(|problem| problem.to_string())?;
            if width.max(height) > MAX_SIDE {
                return Err(format!(
                    "it is {width} × {height} pixels and {MAX_SIDE} on a side is the limit"
                ));
            }
            Ok(format!("{width} × {height} pixels"))
        }
        _ if is_skeleton(&asset.name, &asset.bytes) => Ok(String::from("a skeleton")),
        Some(Kind::Skeleton) => Err(String::from("no skeleton could be found in it")),
        Some(Kind::Mesh) => {
            let bytes = &asset.bytes;
            let words = match mesh::Format::of(&asset.name, bytes) {
                Some(mesh::Format::Obj) => obj(bytes).map(Counts::words),
                Some(mesh::Format::Ply) => ply(bytes).map(Counts::words),
                Some(mesh::Format::Stl) => stl(bytes).map(Counts::words),
                Some(mesh::Format::Glb) => glb(bytes).map(Counts::words),
                Some(mesh::Format::ThreeMf) => package(bytes),
                None => None,
            };
            words.ok_or_else(|| String::from("no mesh could be found in it"))
        }
        None => Err(String::from(
            "it is neither an image nor a mesh nor a skeleton",
        )),
    }
}

/// Returns a size in words, rounded up to kB or rounded to 0.1 MB.
#[must_use]
pub fn size(bytes: usize) -> String {
    match bytes {
        0..1000 => format!("{bytes} bytes"),
        1000..1_000_000 => format!("{} kB", bytes.div_ceil(1000)),
        _ => format!("{:.1} MB", bytes as f64 / 1e6),
    }
}

/// Size of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Counts {
    corners: Option<u64>,
    faces: u64,
}

impl Counts {
    fn words(self) -> String {
        match self.corners {
            Some(corners) => {
                format!(
                    "{}, {}",
                    number(corners, "corner"),
                    number(self.faces, "face")
                )
            }
            None => number(self.faces, "triangle"),
        }
    }
}

/// Returns a number of things in words.
fn number(count: u64, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

/// Counts the lines that begin with a word, wherever blanks stand.
fn count_lines(bytes: &[u8], word: &[u8]) -> u64 {
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    let lines = bytes.split(|byte| *byte == b'\n' || *byte == b'\r');
    let lines = lines.map(<[u8]>::trim_ascii_start);
    let begun = lines.filter(|line| {
        let rest = line.strip_prefix(word);
        rest.is_some_and(|rest| rest.first().is_some_and(u8::is_ascii_whitespace))
    });
    begun.count() as u64
}

fn obj(bytes: &[u8]) -> Option<Counts> {
    let counts = Counts {
        corners: Some(count_lines(bytes, b"v")),
        faces: count_lines(bytes, b"f"),
    };
    (counts.corners > Some(0) && counts.faces > 0).then_some(counts)
}

fn ply(bytes: &[u8]) -> Option<Counts> {
    let elements = mesh::formats::ply::elements(bytes).ok()?;
    let [corners, faces] = [&["vertex"][..], &["face", "tristrips"]].map(|names| {
        let mut named = elements.iter().filter(|e| names.contains(&e.name));
        named.next().map(|element| element.count)
    });
    Some(Counts {
        corners: Some(corners?),
        faces: faces?,
    })
}

/// Counts the triangles of an STL file: numbers behind their count, or words.
fn stl(bytes: &[u8]) -> Option<Counts> {
    let count = bytes
        .get(80..84)
        .and_then(|number| number.try_into().ok())
        .map_or(0, |number| u64::from(u32::from_le_bytes(number)));
    let size = bytes.len() as u64;
    // Text has no zeros, and its words may all stand in one line.
    let text = &bytes[..bytes.len().min(1000)];
    let facets = if text.contains(&0) {
        0
    } else {
        let words = bytes.split(u8::is_ascii_whitespace);
        words
            .filter(|word| word.eq_ignore_ascii_case(b"facet"))
            .count() as u64
    };
    let faces = match 84 + 50 * count {
        wanted if wanted == size => count,
        _ if facets > 0 => facets,
        wanted if wanted < size => count,
        _ => 0,
    };
    (faces > 0).then_some(Counts {
        corners: None,
        faces,
    })
}

/// Returns the number of models in a 3MF package in words; `None` if there is none.
fn package(bytes: &[u8]) -> Option<String> {
    let archive = Archive::open(bytes, MAX_PARTS).ok()?;
    let names = archive.entries().iter().map(|entry| &entry.name);
    let models = names.filter(|name| extension(name) == "model").count();
    (models > 0).then(|| format!("3MF, {}", number(models as u64, "model")))
}

fn glb(bytes: &[u8]) -> Option<Counts> {
    if bytes.get(..4)? != b"glTF" || bytes.get(16..20)? != b"JSON" {
        return None;
    }
    let length = u32::from_le_bytes(bytes.get(12..16)?.try_into().ok()?) as usize;
    let json = bytes.get(20..20_usize.checked_add(length)?)?;
    let json: serde_json::Value = serde_json::from_slice(json).ok()?;
    let accessor = |index: &serde_json::Value| {
        let index = usize::try_from(index.as_u64()?).ok()?;
        json["accessors"][index]["count"].as_u64()
    };
    let (mut corners, mut faces) = (0_u64, 0_u64);
    for mesh in json["meshes"].as_array()? {
        for part in mesh["primitives"].as_array()? {
            let here = accessor(&part["attributes"]["POSITION"])?;
            corners = corners.saturating_add(here);
            let ends = accessor(&part["indices"]).unwrap_or(here);
            faces = faces.saturating_add(ends / 3);
        }
    }
    (corners > 0).then_some(Counts {
        corners: Some(corners),
        faces,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn describe(name: &str, bytes: &[u8]) -> Result<String, String> {
        facts(&Asset::await_mesh(name, bytes))
    }

    #[test]
    fn meshes_tell_their_counts() {
        let obj = b"# a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1 2 3\n";
        assert_eq!(describe("a.OBJ", obj).unwrap(), "3 corners, 1 face");
        let ply = b"ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\n\
            element face 12\nend_header\n";
        assert_eq!(describe("a.ply", ply).unwrap(), "8 corners, 12 faces");
        let mut stl = vec![0; 84 + 100];
        stl[80] = 2;
        assert_eq!(describe("a.stl", &stl).unwrap(), "2 triangles");
        let stl = b"solid a\n facet normal 0 0 1\n endfacet\nendsolid a\n";
        assert_eq!(describe("a.stl", stl).unwrap(), "1 triangle");
        let json = br#"{"accessors":[{"count":24},{"count":36}],
            "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}]}"#;
        let mut glb = b"glTF\x02\0\0\0\0\0\0\0".to_vec();
        glb.extend((json.len() as u32).to_le_bytes());
        glb.extend(b"JSON");
        glb.extend(json);
        assert_eq!(describe("a.glb", &glb).unwrap(), "24 corners, 12 faces");
        glb[12..16].copy_from_slice(&u32::MAX.to_le_bytes());
        assert!(describe("a.glb", &glb).is_err());
    }

    /// An STL file with a triangle, as text.
    const STL: &str = "solid a\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   \
        vertex 1 0 0\n   vertex 0 1 0\n  endloop\n endfacet\nendsolid a\n";

    #[test]
    fn whatever_the_readers_take_is_taken() {
        let mut binary = vec![b's'; 80];
        binary.extend(1_u32.to_le_bytes());
        for number in [0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0] {
            binary.extend((number as f32).to_le_bytes());
        }
        binary.extend([0; 2]);
        let longer = [&binary[..], b"made by hand"].concat();
        let ply = "ply\nformat ascii 1.0\nelement  vertex\t3\nproperty float x\n\
            property float y\nproperty float z\nelement face 1\n\
            property list uchar int vertex_index\nend_header\n0 0 0 1 0 0 0 1 0 3 0 1 2\n";
        let strips = ply.replace("face", "tristrips");
        let model = "<model unit=\"millimeter\" xmlns=\"http://x/core\"><resources>\
            <object id=\"1\"><mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/>\
            <vertex x=\"1\" y=\"0\" z=\"0\"/><vertex x=\"0\" y=\"1\" z=\"0\"/></vertices>\
            <triangles><triangle v1=\"0\" v2=\"1\" v3=\"2\"/></triangles></mesh></object>\
            </resources><build><item objectid=\"1\"/></build></model>";
        let member = ::archive::Member::new("3D/3dmodel.model", model.as_bytes());
        let package = ::archive::write(&[member]).unwrap();
        let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
        let files: [(&str, Vec<u8>); 14] = [
            ("a.stl", STL.into()),
            ("a.stl", format!(" \n\t{STL}").into()),
            ("a.stl", format!("\u{feff}\n{STL}").into()),
            ("a.STL", STL.to_uppercase().into()),
            ("a.stl", STL.replace('\n', " ").into()),
            ("a.stl", STL.replace('\n', "\r\n").into()),
            ("a.stl", binary),
            ("a.stl", longer),
            ("a.ply", ply.into()),
            ("a.obj", ply.replace('\n', "\r\n").into()),
            ("a.ply", strips.into()),
            ("a.3mf", package),
            ("a.obj", obj.replace(' ', "\t").into()),
            (
                "a.obj",
                format!("\u{feff}{obj}").replace("\n", "\n  ").into(),
            ),
        ];
        for (name, bytes) in files {
            let what = String::from_utf8_lossy(&bytes).into_owned();
            let read = mesh::read(name, &bytes).map(|mesh| mesh.triangles.len());
            assert_eq!(read, Ok(1), "{name}: {what}");
            let facts = describe(name, &bytes);
            assert!(
                facts.is_ok_and(|facts| facts.contains('1')),
                "{name}: {what}"
            );
            let sorted = crate::intake::sort(vec![crate::intake::Incoming {
                name: name.to_owned(),
                bytes: Ok(bytes),
            }]);
            assert_eq!(sorted.assets.len(), 1, "{name}: {what}");
        }
    }

    #[test]
    fn content_tells_skeletons_from_meshes_and_points() {
        fn is_skeleton(name: &str, text: &str) -> bool {
            super::is_skeleton(name, text.as_bytes())
        }
        fn package(text: &str) -> Vec<u8> {
            let member = ::archive::Member::new("3D/a.model", text.as_bytes());
            ::archive::write(&[member]).unwrap()
        }
        assert!(is_skeleton("a.swc", ""));
        assert!(is_skeleton("a.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n"));
        assert!(!is_skeleton("a.obj", "v 0 0 0\nv 1 0 0\nl 1 2\nf 1 2 1\n"));
        assert!(is_skeleton(
            "a.ply",
            "ply\nformat ascii 1.0\nelement vertex 2\nelement edge 1\nend_header\n"
        ));
        assert!(!is_skeleton(
            "a.ply",
            "ply\nformat ascii 1.0\nelement vertex 2\nend_header\n"
        ));
        assert!(is_skeleton("a.xyz", "2\nwater\nO 0 0 0\nH 1 0 0\n"));
        assert!(!is_skeleton("a.xyz", "0 0 0\n1 0 0\n0 1 0\n"));
        assert!(!is_skeleton("a.xyz", "2\n\n0 0 0\n1 0 0\n"));
        assert!(!is_skeleton("a.3mf", "no archive"));
        let model = "<model><b:beamlattice/></model>";
        assert!(super::is_skeleton("a.3mf", &package(model)));
        assert!(!super::is_skeleton("a.3mf", &package("<model/>")));
        assert_eq!(
            describe("a.obj", b"v 0 0 0\nv 1 0 0\nl 1 2\n").unwrap(),
            "a skeleton"
        );
    }

    #[test]
    fn files_of_another_format_are_refused() {
        for name in [
            "a.obj", "a.ply", "a.stl", "a.glb", "a.3mf", "a.png", "a.gif", "a.tif", "a.mtv", "a",
        ] {
            for bytes in [
                &b""[..],
                b"ply\n",
                b"glTF",
                b"PK\x03\x04",
                b"\x89PNG\r\n\x1a\n",
                &[255; 99],
            ] {
                assert!(describe(name, bytes).is_err(), "{name}");
            }
        }
        assert_eq!(describe("a.png", &png([2, 3])).unwrap(), "2 × 3 pixels");
        let wide = describe("a.png", &png([MAX_SIDE + 1, 1]));
        assert!(wide.unwrap_err().contains("limit"));
    }

    fn png(size: [u32; 2]) -> Vec<u8> {
        let rgba = vec![9; 4 * size[0] as usize * size[1] as usize];
        crate::picture::png(&pool::Image { size, rgba }).unwrap()
    }
}
