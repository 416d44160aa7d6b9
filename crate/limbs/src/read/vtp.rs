//! VTK's XML format of polygonal data with lines: arrays as text, as base64 or behind the tags,
//! packed by zlib or not.

use super::Reading;
use super::polydata::{Array, Kind, PolyData, check_count, finish};
use super::radii::find;
use crate::draft::Draft;
use crate::error::{Error, fail, fail_at, shorten};
use crate::graph::Graph;
use crate::limits::{MAX_POINTS, MAX_UNPACKED};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use mesh::formats::text;
use mesh::formats::xml::{Event, Reader, Tag};
use miniz_oxide::inflate::decompress_to_vec_zlib_with_limit;
use std::borrow::Cow;

/// The tag behind which data begin that are no XML.
const APPENDED: &[u8] = b"<AppendedData";

/// Way in which numbers are written.
#[derive(Clone, Copy, Default)]
struct Coding<'a> {
    big_endian: bool,
    /// Whether lengths have eight bytes, not four.
    is_long: bool,
    is_packed: bool,
    /// Data behind the tags, and whether they are base64.
    appended: Option<(&'a [u8], bool)>,
}

/// Bytes of an array with its lengths, as they stand in the file.
enum Encoded<'a> {
    Raw(&'a [u8]),
    Base64(Cow<'a, [u8]>),
}

/// Reads a VTP file.
pub(super) fn read(bytes: &[u8], reading: &Reading<'_>) -> Result<Graph, Error> {
    // Such a file has no data behind its tags.
    let wide = text::is_wide(bytes).then(|| text::decode(bytes));
    let bytes = wide.as_ref().map_or(bytes, |text| text.as_bytes());
    let cut = bytes
        .windows(APPENDED.len())
        .position(|window| window == APPENDED);
    let (tags, rest) = bytes.split_at(cut.unwrap_or(bytes.len()));
    let tags = core::str::from_utf8(tags)
        .map_err(|_| Error("this VTP file is no text before its appended data".into()))?;
    let mut coding = Coding::default();
    if cut.is_some() {
        coding.appended = Some(data_behind(rest)?);
    }
    let mut reader = Reader::new(tags);
    let mut draft = Draft::new(None);
    let mut piece = Piece::default();
    let mut section = String::new();
    let mut budget = MAX_UNPACKED;
    let mut is_known = false;
    while let Some(event) = reader.next()? {
        let line = reader.line();
        match event {
            Event::Start(tag) => match tag.name() {
                "VTKFile" => {
                    is_known = tag.get("type")?.as_deref() == Some("PolyData");
                    coding.read(&tag, line)?;
                }
                "Piece" => {
                    piece = Piece {
                        points: check_count(count(&tag, "NumberOfPoints")?, MAX_POINTS, "points")?,
                        ..Piece::default()
                    };
                    piece.data.vertices = count(&tag, "NumberOfVerts")?;
                }
                name @ ("Points" | "Lines" | "PointData" | "CellData" | "Verts" | "Polys"
                | "Strips" | "FieldData") => section = name.into(),
                "DataArray" => {
                    let array = Listed::read(&tag, line)?;
                    let text = match array.format.as_str() {
                        "appended" => "",
                        _ => reader.text()?,
                    };
                    if piece.wants(&section, &array) {
                        // Of other arrays only the names are told.
                        let is_read = !section.ends_with("Data")
                            || find([&array.name[..]].into_iter(), reading.radii).is_some();
                        let values = match is_read {
                            true => array
                                .values(text, &coding, &mut budget)
                                .or_else(|Error(text)| fail_at(line, text))?,
                            false => Vec::new(),
                        };
                        piece.take(&section, array.name, values);
                    }
                }
                _ => {}
            },
            Event::End(name) if name == "Piece" => {
                let data = std::mem::take(&mut piece).data;
                data.draw(reading, &mut draft)?;
            }
            Event::End(_) => {}
        }
    }
    if cut.is_none() && !reader.is_whole() {
        return fail("this VTP file is cut off");
    }
    if !is_known {
        return fail("this is no VTP file: it has no `<VTKFile type=\"PolyData\">`");
    }
    finish(draft, reading)
}

/// Returns a count of a tag, 0 without it.
fn count(tag: &Tag<'_>, name: &str) -> Result<usize, Error> {
    let count = tag.get(name)?.unwrap_or_default();
    Ok(count.trim().parse().unwrap_or(0))
}

/// Returns the data behind the tag and whether they are base64.
fn data_behind(bytes: &[u8]) -> Result<(&[u8], bool), Error> {
    let tag_end = bytes.iter().position(|b| *b == b'>');
    let (tag, rest) = bytes.split_at(tag_end.unwrap_or(bytes.len()));
    let start = rest.iter().position(|b| *b == b'_');
    let Some(data) = start.and_then(|start| rest.get(start + 1..)) else {
        return fail("the appended data of this VTP file do not begin with `_`");
    };
    let is_base64 = tag.windows(6).any(|word| word == b"base64");
    Ok((data, is_base64))
}

impl Coding<'_> {
    fn read(&mut self, tag: &Tag<'_>, line: usize) -> Result<(), Error> {
        self.big_endian = tag.get("byte_order")?.as_deref() == Some("BigEndian");
        self.is_long = tag.get("header_type")?.as_deref() == Some("UInt64");
        self.is_packed = match tag.get("compressor")?.as_deref() {
            None | Some("") => false,
            Some("vtkZLibDataCompressor") => true,
            Some(other) => {
                let other = shorten(other);
                return fail_at(
                    line,
                    format!("`{other}` is not read: save it without compression or with zlib"),
                );
            }
        };
        Ok(())
    }

    /// Returns the first lengths of an array.
    fn lengths(&self, encoded: &Encoded<'_>, count: usize) -> Result<Vec<usize>, Error> {
        let kind = if self.is_long { Kind::U64 } else { Kind::U32 };
        let bytes = encoded.take(count * kind.size())?;
        let numbers = kind.numbers(&bytes, self.big_endian);
        Ok(numbers.into_iter().map(|number| number as usize).collect())
    }

    /// Returns the bytes of an array's numbers.
    fn bytes(&self, encoded: &Encoded<'_>, budget: &mut usize) -> Result<Vec<u8>, Error> {
        let word = if self.is_long { 8 } else { 4 };
        let first = self.lengths(encoded, 1)?[0];
        if !self.is_packed {
            spend(first, budget)?;
            let mut bytes = encoded.take(word + first)?.into_owned();
            bytes.drain(..word);
            return Ok(bytes);
        }
        if first > encoded.most() {
            return Err(cut_off());
        }
        if first == 0 {
            return Ok(Vec::new());
        }
        let lengths = self.lengths(encoded, 3 + first)?;
        let (whole, last, packed) = (lengths[1], lengths[2], &lengths[3..]);
        let last = if last == 0 { whole } else { last };
        let size = whole
            .checked_mul(first - 1)
            .and_then(|all| all.checked_add(last));
        spend(size.unwrap_or(usize::MAX), budget)?;
        let packed_size = packed
            .iter()
            .try_fold(0_usize, |sum, size| sum.checked_add(*size));
        let start = (3 + first) * word;
        let end = packed_size
            .and_then(|size| size.checked_add(start))
            .ok_or_else(cut_off)?;
        let all = encoded.take(end)?;
        let mut rest = &all[start..];
        let mut bytes = Vec::new();
        for (i, size) in packed.iter().enumerate() {
            let (block, after) = rest.split_at_checked(*size).ok_or_else(cut_off)?;
            rest = after;
            let most = if i + 1 == first { last } else { whole };
            let block = decompress_to_vec_zlib_with_limit(block, most)
                .map_err(|_| Error("this array is damaged and cannot be unpacked".into()))?;
            bytes.extend(block);
        }
        Ok(bytes)
    }
}

/// Takes bytes from what may still be unpacked.
fn spend(size: usize, budget: &mut usize) -> Result<(), Error> {
    match budget.checked_sub(size) {
        Some(rest) => {
            *budget = rest;
            Ok(())
        }
        None => fail(format!(
            "the arrays of this file have more than {MAX_UNPACKED} bytes"
        )),
    }
}

fn cut_off() -> Error {
    Error("this array is cut off".into())
}

impl Encoded<'_> {
    /// Returns a bound on the number of bytes.
    fn most(&self) -> usize {
        match self {
            Self::Raw(bytes) => bytes.len(),
            Self::Base64(text) => text.len(),
        }
    }

    /// Returns the first bytes, exactly as many. Units of base64 may follow on each other, each
    /// with its padding.
    fn take(&self, count: usize) -> Result<Cow<'_, [u8]>, Error> {
        let text = match self {
            Self::Raw(bytes) => {
                return bytes.get(..count).map(Cow::Borrowed).ok_or_else(cut_off);
            }
            Self::Base64(text) => text,
        };
        if count > text.len() {
            return Err(cut_off());
        }
        let mut bytes = Vec::with_capacity(count + 3);
        let mut rest = &text[..];
        while bytes.len() < count {
            // Four letters are three bytes.
            let wanted = (count - bytes.len()).div_ceil(3) * 4;
            let unit = &rest[..wanted.min(rest.len())];
            let end = match unit.iter().position(|b| *b == b'=') {
                Some(padding) => (padding / 4 + 1) * 4,
                None => unit.len(),
            };
            let unit = unit
                .get(..end)
                .filter(|unit| !unit.is_empty())
                .ok_or_else(cut_off)?;
            STANDARD
                .decode_vec(unit, &mut bytes)
                .map_err(|error| Error(format!("this array is no base64: {error}")))?;
            rest = &rest[unit.len()..];
        }
        bytes.truncate(count);
        Ok(Cow::Owned(bytes))
    }
}

/// Tag of an array.
struct Listed {
    name: String,
    kind: Kind,
    components: usize,
    format: String,
    offset: usize,
}

impl Listed {
    fn read(tag: &Tag<'_>, line: usize) -> Result<Self, Error> {
        let kind = match &*tag.get("type")?.unwrap_or_default() {
            "Int8" => Kind::I8,
            "UInt8" => Kind::U8,
            "Int16" => Kind::I16,
            "UInt16" => Kind::U16,
            "Int32" => Kind::I32,
            "UInt32" => Kind::U32,
            "Int64" => Kind::I64,
            "UInt64" => Kind::U64,
            "Float32" => Kind::F32,
            "Float64" => Kind::F64,
            // Arrays of text, which are passed over.
            _ => Kind::U8,
        };
        let format = tag.get("format")?.unwrap_or_default();
        if !matches!(&format[..], "" | "ascii" | "binary" | "appended") {
            let format = shorten(&format);
            return fail_at(line, format!("`{format}` is no format of arrays"));
        }
        Ok(Self {
            name: tag.get("Name")?.unwrap_or_default().into_owned(),
            kind,
            components: tag
                .get("NumberOfComponents")?
                .unwrap_or_default()
                .trim()
                .parse()
                .unwrap_or(1),
            format: format.into_owned(),
            offset: tag
                .get("offset")?
                .unwrap_or_default()
                .trim()
                .parse()
                .unwrap_or(0),
        })
    }

    /// Reads the numbers.
    fn values(
        &self,
        text: &str,
        coding: &Coding<'_>,
        budget: &mut usize,
    ) -> Result<Vec<f64>, Error> {
        let encoded = match self.format.as_str() {
            "appended" => {
                let Some((data, is_base64)) = coding.appended else {
                    return fail("this file has no appended data");
                };
                let data = data.get(self.offset..).ok_or_else(cut_off)?;
                match is_base64 {
                    true => Encoded::Base64(Cow::Borrowed(data)),
                    false => Encoded::Raw(data),
                }
            }
            "binary" => {
                let letters = text.bytes().filter(|b| !b.is_ascii_whitespace());
                Encoded::Base64(Cow::Owned(letters.collect()))
            }
            _ => {
                let numbers = text
                    .split_ascii_whitespace()
                    .map(|word| match word.parse() {
                        Ok(number) => Ok(number),
                        Err(_) => fail(format!("`{}` is no number", shorten(word))),
                    });
                return numbers.collect();
            }
        };
        let bytes = coding.bytes(&encoded, budget)?;
        Ok(self.kind.numbers(&bytes, coding.big_endian))
    }
}

/// Part of a file, with points of its own.
#[derive(Default)]
struct Piece {
    points: usize,
    data: PolyData,
}

impl Piece {
    /// Whether an array says anything about a skeleton.
    fn wants(&self, section: &str, array: &Listed) -> bool {
        match section {
            "Points" => self.data.points.is_empty(),
            "Lines" => true,
            "PointData" | "CellData" => array.components == 1,
            _ => false,
        }
    }

    fn take(&mut self, section: &str, name: String, mut values: Vec<f64>) {
        match (section, name.as_str()) {
            ("Points", _) => {
                values.truncate(3 * self.points);
                self.data.points = values;
            }
            ("Lines", "connectivity") => self.data.corners = values,
            ("Lines", "offsets") => self.data.ends = values,
            ("PointData", _) => self.data.of_points.push(Array { name, values }),
            ("CellData", _) => self.data.of_cells.push(Array { name, values }),
            _ => {}
        }
    }
}
