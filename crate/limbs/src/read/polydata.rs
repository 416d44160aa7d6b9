//! VTK's polygonal data: what both of its formats end with.

use super::Reading;
use super::radii::{Radii, find, list};
use crate::draft::{Draft, UNKNOWN};
use crate::error::{Error, fail, shorten};
use crate::graph::{Cap, Graph, Limb};
use crate::limits::{MAX_LISTED, MAX_POINTS};
use glam::DVec3;

/// Named array of numbers, one for each point or line.
pub(super) struct Array {
    pub(super) name: String,
    pub(super) values: Vec<f64>,
}

/// Points, lines through them, and arrays of single numbers.
#[derive(Default)]
pub(super) struct PolyData {
    /// Coordinates, three for each point.
    pub(super) points: Vec<f64>,
    /// Indices of points, line by line.
    pub(super) corners: Vec<f64>,
    /// The end of each line in `corners`.
    pub(super) ends: Vec<f64>,
    pub(super) of_points: Vec<Array>,
    /// Arrays over all cells: vertices come before lines.
    pub(super) of_cells: Vec<Array>,
    /// Number of vertices, which are cells, too.
    pub(super) vertices: usize,
}

/// Checks a count against a limit before there is memory for it.
pub(super) fn check_count(count: usize, most: usize, of: &str) -> Result<usize, Error> {
    match count <= most {
        true => Ok(count),
        false => fail(format!("this file has {count} {of}; {most} are the limit")),
    }
}

impl PolyData {
    /// Adds the lines to a draft.
    pub(super) fn draw(&self, reading: &Reading<'_>, draft: &mut Draft) -> Result<(), Error> {
        let count = check_count(self.points.len() / 3, MAX_POINTS, "points")?;
        check_count(self.corners.len(), MAX_LISTED, "points on lines")?;
        let of_points = find(self.of_points.iter().map(|a| &a.name[..]), reading.radii);
        let of_cells = find(self.of_cells.iter().map(|a| &a.name[..]), reading.radii);
        if let (Some(name), None, None) = (reading.radii, of_points, of_cells) {
            let all = self.of_points.iter().chain(&self.of_cells);
            return fail(format!(
                "this file has no array `{}`; its arrays of single numbers are {}",
                shorten(name),
                list(all.map(|array| &array.name[..]))
            ));
        }
        let group = draft.group("", None)?;
        let first = draft.count() as u32;
        for (i, point) in self.points.chunks_exact(3).enumerate() {
            let radius = value(&self.of_points, of_points, i);
            draft
                .node(DVec3::from_slice(point), radius, group)
                .map_err(|Error(text)| Error(format!("point {i} (from 0): {text}")))?;
        }
        let mut start = 0;
        for (line, end) in self.ends.iter().enumerate() {
            let corners = self.corners.get(start..*end as usize);
            let Some(corners) = corners.filter(|_| *end == end.trunc()) else {
                return fail(format!(
                    "line {line} (from 0) of this file ends before it begins"
                ));
            };
            start = *end as usize;
            let own = value(&self.of_cells, of_cells, self.vertices + line);
            for pair in corners.windows(2) {
                if let Some(beyond) = pair.iter().find(|i| !is_index(**i, count)) {
                    return fail(format!(
                        "a line of this file has point {beyond} (from 0) of {count}"
                    ));
                }
                let ends = [pair[0], pair[1]].map(|i| first + i as u32);
                let radii = match of_points {
                    Some(_) => ends.map(|end| draft.radius(end)),
                    None => [own; 2],
                };
                draft.add(Limb {
                    ends,
                    radii,
                    group,
                    caps: [Cap::Round; 2],
                    clip: None,
                })?;
            }
        }
        Ok(())
    }
}

/// Whether a number is an index into a list of some length.
fn is_index(i: f64, count: usize) -> bool {
    i >= 0.0 && i < count as f64 && i == i.trunc()
}

/// Returns a radius of an array; [`UNKNOWN`] without one.
fn value(arrays: &[Array], radii: Option<Radii>, i: usize) -> f64 {
    let value = radii.and_then(|radii| {
        let value = arrays[radii.index].values.get(i)?;
        Some(value * radii.factor)
    });
    value.unwrap_or(UNKNOWN)
}

/// Returns the skeleton of some polygonal data.
pub(super) fn finish(mut draft: Draft, reading: &Reading<'_>) -> Result<Graph, Error> {
    if draft.is_bare() {
        return fail("this file has no lines: a centreline is wanted here, not a surface");
    }
    draft.weld();
    draft.finish(reading.radius)
}

/// Type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

impl Kind {
    /// Number of bytes.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    /// Reads numbers from bytes, as many as are whole.
    pub(super) fn numbers(self, bytes: &[u8], big_endian: bool) -> Vec<f64> {
        let size = self.size();
        let numbers = bytes.chunks_exact(size).map(|chunk| {
            // Lowest byte first, with zeros behind.
            let mut b = [0; 8];
            b[..size].copy_from_slice(chunk);
            if big_endian {
                b[..size].reverse();
            }
            let word = u64::from_le_bytes(b);
            match self {
                Self::I8 => f64::from(word as i8),
                Self::U8 | Self::U16 | Self::U32 | Self::U64 => word as f64,
                Self::I16 => f64::from(word as i16),
                Self::I32 => f64::from(word as i32),
                Self::I64 => word as i64 as f64,
                Self::F32 => f64::from(f32::from_bits(word as u32)),
                Self::F64 => f64::from_bits(word),
            }
        });
        numbers.collect()
    }
}
