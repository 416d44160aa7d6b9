//! PLY: a heading that lists elements with their properties, then rows of values, as text or as
//! numbers.
//!
//! Of the element `vertex` the properties x, y, z, nx, ny, nz and red, green, blue are read, of
//! `face` the list `vertex_indices` (or `vertex_index`).

use super::cursor::Cursor;
use crate::color::decode;
use crate::error::{Error, fail};
use crate::limits::{MAX_BYTES, MAX_TRIANGLES, MAX_VERTICES};
use crate::triangle_mesh::TriangleMesh;
use glam::DVec3;

/// The longest heading, bytes.
const LONGEST_HEADING: usize = 64 * 1024;

#[derive(Clone, Copy, Debug)]
enum Kind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Kind {
    /// Returns a colour's channel, 0 … 1: whole numbers count to the largest of their type.
    fn share(self, value: f64) -> f64 {
        value
            / match self {
                Self::I8 => 127.0,
                Self::U8 => 255.0,
                Self::I16 => 32_767.0,
                Self::U16 => 65_535.0,
                Self::I32 => f64::from(i32::MAX),
                Self::U32 => f64::from(u32::MAX),
                Self::F32 | Self::F64 => 1.0,
            }
    }
}

struct Property<'a> {
    name: &'a str,
    /// Type of a list's length; `None` if it is no list.
    length: Option<Kind>,
    kind: Kind,
}

struct Element<'a> {
    name: &'a str,
    count: u64,
    properties: Vec<Property<'a>>,
}

/// Source of a file's values.
enum Source<'a> {
    Text(core::str::SplitAsciiWhitespace<'a>),
    Numbers(Cursor<'a>),
}

impl Source<'_> {
    fn next(&mut self, kind: Kind) -> Option<f64> {
        let at = match self {
            Self::Text(words) => return words.next()?.parse().ok(),
            Self::Numbers(at) => at,
        };
        Some(match kind {
            Kind::I8 => f64::from(i8::from_le_bytes(at.take()?)),
            Kind::U8 => f64::from(u8::from_le_bytes(at.take()?)),
            Kind::I16 => f64::from(i16::from_le_bytes(at.take()?)),
            Kind::U16 => f64::from(u16::from_le_bytes(at.take()?)),
            Kind::I32 => f64::from(i32::from_le_bytes(at.take()?)),
            Kind::U32 => f64::from(u32::from_le_bytes(at.take()?)),
            Kind::F32 => at.f32()?,
            Kind::F64 => f64::from_le_bytes(at.take()?),
        })
    }
}

/// Reads the vertices of a PLY file, which needs no faces.
///
/// # Errors
/// As [`crate::read`], but a file without triangles is none.
pub fn read_points(bytes: &[u8]) -> Result<Vec<DVec3>, Error> {
    if bytes.len() > MAX_BYTES {
        return fail("this file is too large");
    }
    Ok(read(bytes)?.positions)
}

pub(crate) fn read(bytes: &[u8]) -> Result<TriangleMesh, Error> {
    let (heading, body) = split(bytes)?;
    let heading = core::str::from_utf8(heading)
        .map_err(|_| Error("the heading of this PLY file is no text".into()))?;
    let (format, elements) = parse(heading)?;
    let text;
    let mut source = match format {
        "binary_little_endian" => Source::Numbers(Cursor::new(body, false)),
        "binary_big_endian" => Source::Numbers(Cursor::new(body, true)),
        "ascii" => {
            text = String::from_utf8_lossy(body);
            Source::Text(text.split_ascii_whitespace())
        }
        _ => {
            return fail(
                "the heading of this PLY file has no `format` (ascii, binary_little_endian or \
                 binary_big_endian)",
            );
        }
    };
    let mut mesh = TriangleMesh::default();
    for element in &elements {
        let most = match element.name {
            "vertex" => MAX_VERTICES,
            "face" => MAX_TRIANGLES,
            // A row takes a byte at least, so that a false count ends with the file.
            _ => usize::MAX,
        };
        if element.count > most as u64 {
            return fail(format!(
                "this file has {} of `{}`, more than the {most} that are taken",
                element.count, element.name
            ));
        }
        // Without properties there is nothing to read, however many there are.
        if !element.properties.is_empty() {
            rows(element, &mut source, &mut mesh)?;
        }
    }
    Ok(mesh)
}

/// The heading, and what follows its last line.
fn split(bytes: &[u8]) -> Result<(&[u8], &[u8]), Error> {
    let mut start = 0;
    while let Some(length) = bytes[start..].iter().position(|b| *b == b'\n') {
        let line = bytes[start..start + length].trim_ascii();
        start += length + 1;
        if line == b"end_header" {
            return Ok((&bytes[..start], &bytes[start..]));
        }
        if start > LONGEST_HEADING {
            break;
        }
    }
    fail("the heading of this PLY file does not end (with `end_header`)")
}

fn parse(heading: &str) -> Result<(&str, Vec<Element<'_>>), Error> {
    let mut format = "";
    let mut elements: Vec<Element<'_>> = Vec::new();
    for (line, number) in heading.lines().zip(1..) {
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        let wrong = || Error(format!("line {number}: this is no line of a PLY heading"));
        match words[..] {
            ["format", name, _] => format = name,
            ["element", name, count] => elements.push(Element {
                name,
                count: count.parse().map_err(|_| wrong())?,
                properties: Vec::new(),
            }),
            ["property", ref of @ .., name] => {
                let (length, kind) = match *of {
                    [kind] => (None, kind),
                    ["list", length, kind] => (Some(length), kind),
                    _ => return Err(wrong()),
                };
                let named = |name: &str| {
                    kind_of(name).ok_or_else(|| {
                        let name: String = name.chars().take(20).collect();
                        Error(format!(
                            "line {number}: `{name}` is no type of a PLY property"
                        ))
                    })
                };
                let element = elements.last_mut().ok_or_else(wrong)?;
                element.properties.push(Property {
                    name,
                    length: length.map(named).transpose()?,
                    kind: named(kind)?,
                });
            }
            ["property" | "element" | "format", ..] => return Err(wrong()),
            // Comments.
            _ => {}
        }
    }
    Ok((format, elements))
}

fn kind_of(name: &str) -> Option<Kind> {
    Some(match name {
        "char" | "int8" => Kind::I8,
        "uchar" | "uint8" => Kind::U8,
        "short" | "int16" => Kind::I16,
        "ushort" | "uint16" => Kind::U16,
        "int" | "int32" => Kind::I32,
        "uint" | "uint32" => Kind::U32,
        "float" | "float32" => Kind::F32,
        "double" | "float64" => Kind::F64,
        _ => return None,
    })
}

/// Reads all rows of an element.
fn rows(
    element: &Element<'_>,
    source: &mut Source<'_>,
    mesh: &mut TriangleMesh,
) -> Result<(), Error> {
    let is_vertex = element.name == "vertex";
    let is_face = element.name == "face";
    let normals = ["nx", "ny", "nz"];
    let has = |name: &&str| element.properties.iter().any(|p| p.name == *name);
    let has_normals = is_vertex && normals.iter().all(has);
    let has_colors = is_vertex && ["red", "green", "blue"].iter().all(has);
    for row in 0..element.count {
        let wrong = |what: &str| Error(format!("`{}` {row} (from 0): {what}", element.name));
        let ended = || wrong("a number is missing or cannot be read");
        let (mut position, mut normal) = (DVec3::NAN, DVec3::ZERO);
        let mut color = [0.0; 3];
        for property in &element.properties {
            let Some(length) = property.length else {
                let value = source.next(property.kind).ok_or_else(ended)?;
                match property.name {
                    "x" => position.x = value,
                    "y" => position.y = value,
                    "z" => position.z = value,
                    "nx" => normal.x = value,
                    "ny" => normal.y = value,
                    "nz" => normal.z = value,
                    "red" => color[0] = property.kind.share(value),
                    "green" => color[1] = property.kind.share(value),
                    "blue" => color[2] = property.kind.share(value),
                    _ => {}
                }
                continue;
            };
            let length = source.next(length).ok_or_else(ended)?;
            if !(0.0..=f64::from(u32::MAX)).contains(&length) || length != length.trunc() {
                return Err(wrong("a list's length is no whole number"));
            }
            let is_corners = is_face && matches!(property.name, "vertex_indices" | "vertex_index");
            let (mut first, mut last) = (0, 0);
            for i in 0..length as u64 {
                let value = source.next(property.kind).ok_or_else(ended)?;
                if !is_corners {
                    continue;
                }
                if !(0.0..f64::from(u32::MAX)).contains(&value) || value != value.trunc() {
                    return Err(wrong("a corner is no whole number from 0"));
                }
                let corner = value as u32;
                match i {
                    0 => first = corner,
                    1 => {}
                    _ => mesh.add_triangle([first, last, corner])?,
                }
                last = corner;
            }
        }
        if is_vertex {
            if position.is_nan() {
                return Err(wrong("it has no x, y and z that are numbers"));
            }
            mesh.add_vertex(position)?;
            if has_normals {
                mesh.normals.get_or_insert_default().push(normal);
            }
            if has_colors {
                let linear = color.map(|x: f64| decode(x.clamp(0.0, 1.0)));
                mesh.colors.get_or_insert_default().push(linear);
            }
        }
    }
    Ok(())
}
