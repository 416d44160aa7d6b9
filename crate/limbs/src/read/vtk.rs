//! VTK's legacy format: polygonal data with lines, as text or as numbers, highest byte first.

use super::Reading;
use super::polydata::{Array, Kind, PolyData, check_count, finish};
use crate::draft::Draft;
use crate::error::{Error, fail, fail_at, shorten};
use crate::graph::Graph;
use crate::limits::{MAX_LISTED, MAX_POINTS};

/// Place in a file.
struct Source<'a> {
    bytes: &'a [u8],
    at: usize,
    is_text: bool,
}

/// Reads a legacy VTK file.
pub(super) fn read(bytes: &[u8], reading: &Reading<'_>) -> Result<Graph, Error> {
    let mut source = Source {
        bytes,
        at: 0,
        is_text: true,
    };
    if !source.line().starts_with("# vtk DataFile") {
        return fail("this is no VTK file: its first line does not begin with `# vtk DataFile`");
    }
    source.line();
    source.is_text = match source.word().to_ascii_uppercase().as_str() {
        "ASCII" => true,
        "BINARY" => false,
        _ => return source.wrong("`ASCII` or `BINARY` is expected here"),
    };
    let [word, kind] = [source.word(), source.word()].map(str::to_ascii_uppercase);
    if word != "DATASET" || kind != "POLYDATA" {
        return source.wrong("only `DATASET POLYDATA` has lines to be read");
    }
    let data = source.data()?;
    let mut draft = Draft::new(None);
    data.draw(reading, &mut draft)?;
    finish(draft, reading)
}

impl<'a> Source<'a> {
    fn wrong<T>(&self, text: impl std::fmt::Display) -> Result<T, Error> {
        let before = &self.bytes[..self.at.min(self.bytes.len())];
        fail_at(before.iter().filter(|b| **b == b'\n').count() + 1, text)
    }

    /// Returns the rest of the line, and goes to the next.
    fn line(&mut self) -> &'a str {
        let rest = &self.bytes[self.at..];
        let end = rest.iter().position(|b| *b == b'\n').unwrap_or(rest.len());
        self.at += (end + 1).min(rest.len());
        core::str::from_utf8(&rest[..end])
            .unwrap_or_default()
            .trim()
    }

    /// Returns the next word, empty at the end, and stops right behind it.
    fn word(&mut self) -> &'a str {
        let rest = &self.bytes[self.at..];
        let start = rest.iter().position(|b| !b.is_ascii_whitespace());
        let Some(start) = start else {
            self.at = self.bytes.len();
            return "";
        };
        let word = &rest[start..];
        let end = word
            .iter()
            .position(u8::is_ascii_whitespace)
            .unwrap_or(word.len());
        self.at += start + end;
        core::str::from_utf8(&word[..end]).unwrap_or("?")
    }

    fn count(&mut self, most: usize, of: &str) -> Result<usize, Error> {
        let word = self.word();
        match word.parse() {
            Ok(count) => check_count(count, most, of).or_else(|Error(text)| self.wrong(text)),
            Err(_) => self.wrong(format!("`{}` is no number of {of}", shorten(word))),
        }
    }

    /// Reads the name of a type of numbers.
    fn kind(&mut self) -> Result<Kind, Error> {
        let word = self.word();
        Ok(match word.to_ascii_lowercase().as_str() {
            "char" | "vtktypeint8" => Kind::I8,
            "unsigned_char" | "vtktypeuint8" => Kind::U8,
            "short" | "vtktypeint16" => Kind::I16,
            "unsigned_short" | "vtktypeuint16" => Kind::U16,
            "int" | "vtktypeint32" | "vtkidtype" => Kind::I32,
            "unsigned_int" | "vtktypeuint32" => Kind::U32,
            "long" | "vtktypeint64" => Kind::I64,
            "unsigned_long" | "vtktypeuint64" => Kind::U64,
            "float" => Kind::F32,
            "double" => Kind::F64,
            _ => return self.wrong(format!("`{}` is no type of numbers", shorten(word))),
        })
    }

    /// Reads numbers that begin in the next line.
    fn numbers(&mut self, count: usize, kind: Kind) -> Result<Vec<f64>, Error> {
        if !self.is_text {
            self.line();
            let end = count
                .checked_mul(kind.size())
                .and_then(|size| self.at.checked_add(size));
            let Some(bytes) = end.and_then(|end| self.bytes.get(self.at..end)) else {
                return self.wrong("this file is cut off: numbers are missing here");
            };
            self.at += bytes.len();
            return Ok(kind.numbers(bytes, true));
        }
        // A number takes two bytes at least.
        if count > self.bytes.len() {
            return self.wrong("this file is cut off: numbers are missing here");
        }
        let mut numbers = Vec::with_capacity(count);
        for _ in 0..count {
            let word = self.word();
            match word.parse() {
                Ok(number) => numbers.push(number),
                Err(_) if word.is_empty() => {
                    return self.wrong("this file is cut off: numbers are missing here");
                }
                Err(_) => return self.wrong(format!("`{}` is no number", shorten(word))),
            }
        }
        Ok(numbers)
    }

    /// Reads all sections.
    fn data(&mut self) -> Result<PolyData, Error> {
        let mut data = PolyData::default();
        // The number of points or cells that arrays are about, and whether they are cells.
        let mut about = (0, false);
        loop {
            let word = self.word().to_ascii_uppercase();
            match word.as_str() {
                "" => return Ok(data),
                "POINTS" => {
                    let count = self.count(MAX_POINTS, "points")?;
                    let kind = self.kind()?;
                    data.points = self.numbers(3 * count, kind)?;
                }
                "LINES" => (data.ends, data.corners) = self.cells()?,
                "VERTICES" => data.vertices = self.cells()?.0.len(),
                "POLYGONS" | "TRIANGLE_STRIPS" => drop(self.cells()?),
                "POINT_DATA" => about = (self.count(MAX_POINTS, "points")?, false),
                "CELL_DATA" => about = (self.count(MAX_LISTED, "cells")?, true),
                "METADATA" => self.skip_metadata(),
                "SCALARS" => {
                    let name = self.word().to_owned();
                    let kind = self.kind()?;
                    let rest = self.line();
                    let size = rest.split_ascii_whitespace().next();
                    let size = size.and_then(|word| word.parse().ok()).unwrap_or(1);
                    // The table's name; its line ends where the numbers begin.
                    self.word();
                    self.word();
                    self.array(&mut data, about, (name, size, about.0, kind))?;
                }
                "VECTORS" | "NORMALS" => {
                    let name = self.word().to_owned();
                    let kind = self.kind()?;
                    self.array(&mut data, about, (name, 3, about.0, kind))?;
                }
                "TENSORS" => {
                    let name = self.word().to_owned();
                    let kind = self.kind()?;
                    self.array(&mut data, about, (name, 9, about.0, kind))?;
                }
                "FIELD" => {
                    self.word();
                    for _ in 0..self.count(MAX_POINTS, "arrays")? {
                        let mut name = self.word().to_owned();
                        if name == "METADATA" {
                            self.skip_metadata();
                            name = self.word().to_owned();
                        }
                        let size = self.count(MAX_POINTS, "components")?;
                        let count = self.count(MAX_LISTED, "values")?;
                        let kind = self.kind()?;
                        self.array(&mut data, about, (name, size, count, kind))?;
                    }
                }
                _ => {
                    return self.wrong(format!("`{}` is not read in VTK files", shorten(&word)));
                }
            }
        }
    }

    /// Goes behind the empty line that ends metadata.
    fn skip_metadata(&mut self) {
        self.line();
        while !self.line().is_empty() {}
    }

    /// Reads an array, and keeps it if it has one number for each point or cell.
    fn array(
        &mut self,
        data: &mut PolyData,
        (about, is_of_cells): (usize, bool),
        (name, size, count, kind): (String, usize, usize, Kind),
    ) -> Result<(), Error> {
        let Some(whole) = size.checked_mul(count) else {
            return self.wrong("this array is too large");
        };
        let values = self.numbers(whole, kind)?;
        if size == 1 && count == about {
            let arrays = match is_of_cells {
                true => &mut data.of_cells,
                false => &mut data.of_points,
            };
            arrays.push(Array { name, values });
        }
        Ok(())
    }

    /// Reads cells: the end of each in the list of corners, and the corners. Version 5 writes them
    /// so, older ones the number of corners before those of each cell.
    fn cells(&mut self) -> Result<(Vec<f64>, Vec<f64>), Error> {
        let count = self.count(MAX_LISTED, "cells")?;
        let size = self.count(2 * MAX_LISTED, "corners")?;
        let start = self.at;
        if self.word().eq_ignore_ascii_case("OFFSETS") {
            let kind = self.kind()?;
            let mut ends = self.numbers(count, kind)?;
            if !self.word().eq_ignore_ascii_case("CONNECTIVITY") {
                return self.wrong("`CONNECTIVITY` is expected here");
            }
            let kind = self.kind()?;
            let corners = self.numbers(size, kind)?;
            // The first is where the first cell begins.
            if !ends.is_empty() {
                ends.remove(0);
            }
            return Ok((ends, corners));
        }
        self.at = start;
        let all = self.numbers(size, Kind::I32)?;
        let (mut ends, mut corners) = (Vec::new(), Vec::new());
        let mut at = 0;
        for _ in 0..count {
            let length = all.get(at).copied().unwrap_or(-1.0);
            let cell = (length >= 0.0).then(|| all.get(at + 1..at + 1 + length as usize));
            let Some(cell) = cell.flatten() else {
                return self.wrong("these cells have not as many corners as they say");
            };
            corners.extend(cell);
            ends.push(corners.len() as f64);
            at += 1 + cell.len();
        }
        Ok((ends, corners))
    }
}
