//! PLY's tables: a heading that lists elements with their properties, then rows of values, as text
//! or as numbers.

use crate::error::{Error, fail};
use crate::read::Cursor;

/// The longest heading, bytes.
const LONGEST_HEADING: usize = 64 * 1024;

/// Type of a value.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Kind {
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
    pub(crate) fn share(self, value: f64) -> f64 {
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

/// Property of an element's rows.
pub struct Property<'a> {
    /// Name.
    pub name: &'a str,
    /// Type of a list's length; `None` if it is no list.
    length: Option<Kind>,
    pub(crate) kind: Kind,
}

impl Property<'_> {
    /// Whether each value is a list.
    #[must_use]
    pub fn is_list(&self) -> bool {
        self.length.is_some()
    }
}

/// Element: a table of values.
pub struct Element<'a> {
    /// Name.
    pub name: &'a str,
    /// Number of rows, as the heading says.
    pub count: u64,
    /// Columns of each row.
    pub properties: Vec<Property<'a>>,
}

impl Element<'_> {
    /// Returns an error about a row.
    #[must_use]
    pub fn wrong(&self, row: u64, what: &str) -> Error {
        Error(format!("`{}` {row} (from 0): {what}", self.name))
    }

    /// Returns the index of a property that is no list, by one of its names.
    #[must_use]
    pub fn column(&self, names: &[&str]) -> Option<usize> {
        let mut columns = self.properties.iter();
        columns.position(|p| !p.is_list() && names.contains(&p.name))
    }
}

/// Row of an element.
pub struct Row {
    /// Index of the row.
    pub index: u64,
    /// Value of each property; 0 for lists.
    pub values: Vec<f64>,
    /// List of each property; empty for others.
    pub lists: Vec<Vec<f64>>,
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

    /// Reads the next row of an element.
    fn row(&mut self, element: &Element<'_>, row: &mut Row) -> Result<(), Error> {
        for (i, property) in element.properties.iter().enumerate() {
            let ended = || element.wrong(row.index, "a number is missing or cannot be read");
            let Some(length) = property.length else {
                row.values[i] = self.next(property.kind).ok_or_else(ended)?;
                continue;
            };
            let length = self.next(length).ok_or_else(ended)?;
            if !(0.0..=f64::from(u32::MAX)).contains(&length) || length != length.trunc() {
                return Err(element.wrong(row.index, "a list's length is no whole number"));
            }
            row.lists[i].clear();
            for _ in 0..length as u64 {
                row.lists[i].push(self.next(property.kind).ok_or_else(ended)?);
            }
        }
        Ok(())
    }
}

/// Reads a PLY file, and visits the rows of all elements in the file's order.
///
/// # Errors
/// If the file is broken, or `visit` returns an error.
pub fn visit(
    bytes: &[u8],
    mut visit: impl FnMut(&Element<'_>, &Row) -> Result<(), Error>,
) -> Result<(), Error> {
    let (heading, body) = split(bytes)?;
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
    // Without properties there is nothing to read, however many rows there are.
    for element in elements
        .iter()
        .filter(|element| !element.properties.is_empty())
    {
        let width = element.properties.len();
        let mut row = Row {
            index: 0,
            values: vec![0.0; width],
            lists: vec![Vec::new(); width],
        };
        // A row takes a byte at least, so that a false count ends with the file.
        while row.index < element.count {
            source.row(element, &mut row)?;
            visit(element, &row)?;
            row.index += 1;
        }
    }
    Ok(())
}

/// Returns the elements that the heading of a PLY file lists.
///
/// # Errors
/// If the heading is broken.
pub fn elements(bytes: &[u8]) -> Result<Vec<Element<'_>>, Error> {
    let (heading, _) = split(bytes)?;
    parse(heading).map(|(_, elements)| elements)
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

fn parse(heading: &[u8]) -> Result<(&str, Vec<Element<'_>>), Error> {
    let heading = core::str::from_utf8(heading)
        .map_err(|_| Error("the heading of this PLY file is no text".into()))?;
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
