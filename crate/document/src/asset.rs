//! Images, meshes and skeletons that a work refers to: accepted formats, and messages about them.
//!
//! Only their headers are read here; the language interprets them.

use ::picture::{Format, file};
use archive::Archive;
pub use rats::Asset;
use std::path::Path;

/// Largest image or mesh, bytes.
pub const MAX_ASSET: usize = 8 << 20;
/// Largest sum of all images and meshes of a work, bytes.
pub const MAX_ALL: usize = 24 << 20;
/// Most images and meshes of a work.
pub const MAX_ASSETS: usize = 16;
/// Longest side of an image, pixels.
pub const MAX_SIDE: u32 = 4096;

/// Most members of a 3MF file that is looked into.
const MOST_MEMBERS: usize = 1000;

/// A mesh file of more bytes than this is read by a tools worker, not by the page's thread.
pub const LARGE_MESH: usize = 256 << 10;

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
    match extension(name).as_str() {
        "png" | "gif" | "tga" | "tif" | "tiff" | "mtv" => Some(Kind::Image),
        "obj" | "ply" | "stl" | "glb" | "3mf" => Some(Kind::Mesh),
        "swc" | "vtp" | "vtk" | "csv" | "pdb" | "ent" | "xyz" => Some(Kind::Skeleton),
        _ => None,
    }
}

/// Whether a file holds limbs: by its name, or as its content says where files of that name may
/// hold a mesh or points, too.
#[must_use]
pub fn is_skeleton(name: &str, bytes: &[u8]) -> bool {
    let has_line = |begins: &dyn Fn(&[u8]) -> bool| {
        let mut lines = bytes.split(|byte| *byte == b'\n' || *byte == b'\r');
        lines.any(|line| begins(line.trim_ascii_start()))
    };
    match extension(name).as_str() {
        "obj" => {
            let has = |word: &'static [u8]| has_line(&|line: &[u8]| line.starts_with(word));
            has(b"l ") && !has(b"f ")
        }
        "ply" => ply_head(bytes).is_some_and(|head| element_count(head, "edge") > Some(0)),
        // A molecule counts its atoms in its first line, and names an element in each of the others.
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
    let Ok(archive) = Archive::open(bytes, MOST_MEMBERS) else {
        return false;
    };
    let models = archive.entries().iter();
    let models = models.filter(|entry| entry.name.ends_with(".model"));
    models.take(16).any(|entry| {
        let text = archive.read(entry, 2 * MAX_ASSET).unwrap_or_default();
        text.windows(11).any(|part| part == b"beamlattice")
    })
}

/// Whether this is a mesh so large that reading it would freeze the page's thread.
#[must_use]
pub fn is_large_mesh(asset: &Asset) -> bool {
    kind(&asset.name) == Some(Kind::Mesh) && asset.bytes.len() > LARGE_MESH
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
        Some(Kind::Mesh) if extension(&asset.name) == "3mf" => {
            match Archive::open(&asset.bytes, MOST_MEMBERS) {
                Ok(_) => Ok(String::from("a mesh")),
                Err(error) => Err(format!("it {error}")),
            }
        }
        Some(Kind::Mesh) => {
            let counts = match extension(&asset.name).as_str() {
                "obj" => obj(&asset.bytes),
                "ply" => ply(&asset.bytes),
                "stl" => stl(&asset.bytes),
                _ => glb(&asset.bytes),
            };
            counts
                .map(Counts::words)
                .ok_or_else(|| String::from("no mesh could be found in it"))
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

fn obj(bytes: &[u8]) -> Option<Counts> {
    let count = |word: &[u8]| {
        let lines = bytes.split(|byte| *byte == b'\n' || *byte == b'\r');
        lines.filter(|line| line.starts_with(word)).count() as u64
    };
    let counts = Counts {
        corners: Some(count(b"v ")),
        faces: count(b"f "),
    };
    (counts.corners > Some(0) && counts.faces > 0).then_some(counts)
}

/// Returns the header of a PLY file.
fn ply_head(bytes: &[u8]) -> Option<&str> {
    let head = &bytes[..bytes.len().min(64 * 1024)];
    let end = head.windows(10).position(|part| part == b"end_header")?;
    let head = std::str::from_utf8(&head[..end]).ok()?;
    head.starts_with("ply").then_some(head)
}

/// Returns the number of elements of a name that the header of a PLY file tells.
fn element_count(head: &str, element: &str) -> Option<u64> {
    head.lines()
        .find_map(|line| line.strip_prefix("element ")?.trim().strip_prefix(element))
        .and_then(|number| number.trim().parse::<u64>().ok())
}

fn ply(bytes: &[u8]) -> Option<Counts> {
    let head = ply_head(bytes)?;
    Some(Counts {
        corners: Some(element_count(head, "vertex")?),
        faces: element_count(head, "face")?,
    })
}

fn stl(bytes: &[u8]) -> Option<Counts> {
    let count = bytes
        .get(80..84)
        .and_then(|number| number.try_into().ok())
        .map_or(0, |number| u64::from(u32::from_le_bytes(number)));
    let faces = if bytes.len() as u64 == 84 + 50 * count {
        count
    } else {
        // A text, not the binary format.
        let lines = bytes.split(|byte| *byte == b'\n' || *byte == b'\r');
        lines
            .filter(|line| line.trim_ascii_start().starts_with(b"facet"))
            .count() as u64
    };
    (faces > 0).then_some(Counts {
        corners: None,
        faces,
    })
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
        facts(&Asset {
            name: String::from(name),
            bytes: bytes.into(),
        })
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

    #[test]
    fn content_tells_skeletons_from_meshes_and_points() {
        let is_skeleton = |name: &str, text: &str| is_skeleton(name, text.as_bytes());
        assert!(is_skeleton("a.swc", ""));
        assert!(is_skeleton("a.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n"));
        assert!(!is_skeleton("a.obj", "v 0 0 0\nv 1 0 0\nl 1 2\nf 1 2 1\n"));
        assert!(is_skeleton(
            "a.ply",
            "ply\nelement vertex 2\nelement edge 1\nend_header\n"
        ));
        assert!(!is_skeleton("a.ply", "ply\nelement vertex 2\nend_header\n"));
        assert!(is_skeleton("a.xyz", "2\nwater\nO 0 0 0\nH 1 0 0\n"));
        assert!(!is_skeleton("a.xyz", "0 0 0\n1 0 0\n0 1 0\n"));
        assert!(!is_skeleton("a.xyz", "2\n\n0 0 0\n1 0 0\n"));
        assert!(!is_skeleton("a.3mf", "no archive"));
        let model = "<model><b:beamlattice/></model>";
        let member = |text| archive::Member::new("3D/a.model", text);
        let file = |text: &'static str| archive::write(&[member(text.as_bytes())]).unwrap();
        assert!(super::is_skeleton("a.3mf", &file(model)));
        assert!(!super::is_skeleton("a.3mf", &file("<model/>")));
        assert_eq!(describe("a.3mf", &file("<model/>")).unwrap(), "a mesh");
        assert_eq!(
            describe("a.obj", b"v 0 0 0\nv 1 0 0\nl 1 2\n").unwrap(),
            "a skeleton"
        );
    }

    #[test]
    fn files_of_another_format_are_refused() {
        for name in [
            "a.obj", "a.ply", "a.stl", "a.glb", "a.png", "a.gif", "a.tif", "a.mtv", "a",
        ] {
            for bytes in [
                &b""[..],
                b"ply\n",
                b"glTF",
                b"\x89PNG\r\n\x1a\n",
                &[255; 99],
            ] {
                assert!(describe(name, bytes).is_err(), "{name}");
            }
        }
        let png = |size: [u32; 2]| {
            let rgba = vec![9; 4 * size[0] as usize * size[1] as usize];
            crate::picture::png(&pool::Image { size, rgba }).unwrap()
        };
        assert_eq!(describe("a.png", &png([2, 3])).unwrap(), "2 × 3 pixels");
        let wide = describe("a.png", &png([MAX_SIDE + 1, 1]));
        assert!(wide.unwrap_err().contains("limit"));
    }
}
