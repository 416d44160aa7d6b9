//! OBJ: of its lines, `v`, `l` and the names in `usemtl` are read.
//!
//! OBJ has no radii. Those that [`crate::Graph::write_obj`] writes stand in texture coordinates,
//! behind the comment [`RADII_IN_VT`].

use super::{Reading, place};
use crate::draft::{Draft, UNKNOWN};
use crate::error::{Error, fail, fail_at, shorten};
use crate::graph::{Cap, Graph, Limb};
use crate::limits::MAX_POINTS;
use mesh::formats::text;

/// Comment that says that each `vt` is a radius.
pub(crate) const RADII_IN_VT: &str = "# vt: radius";

/// Reads an OBJ file; `None` if it has no `l`.
pub(super) fn read(bytes: &[u8], reading: &Reading<'_>) -> Result<Option<Graph>, Error> {
    let text = text::decode(bytes);
    let mut reader = Reader::default();
    // A backslash at its end continues a line.
    let mut begun = String::new();
    let mut lines = text.lines().zip(1..).peekable();
    while let Some((line, number)) = lines.next() {
        if line.trim() == RADII_IN_VT {
            reader.has_radii = true;
        }
        let line = line.split_once('#').map_or(line, |(line, _)| line);
        if let Some(part) = line.trim_end().strip_suffix('\\') {
            begun.push_str(part);
            begun.push(' ');
            if lines.peek().is_some() {
                continue;
            }
        } else {
            begun.push_str(line);
        }
        let result = reader.line(&begun);
        begun.clear();
        result.or_else(|Error(text)| fail_at(number, text))?;
    }
    let Reader {
        mut draft,
        faces,
        has_lines,
        ..
    } = reader;
    if !has_lines {
        return Ok(None);
    }
    draft.remark_count(faces, "faces are left out: this file is read as a skeleton");
    draft.weld();
    draft.finish(reading.radius).map(Some)
}

#[derive(Default)]
struct Reader {
    draft: Draft,
    radii: Vec<f64>,
    material: String,
    faces: usize,
    has_radii: bool,
    has_lines: bool,
}

impl Reader {
    fn line(&mut self, line: &str) -> Result<(), Error> {
        let mut words = line.split_ascii_whitespace();
        match words.next() {
            Some("v") => {
                let Some(place) = place(&mut words) else {
                    return fail("three numbers are needed here");
                };
                self.draft.node(place, UNKNOWN, 0)?;
            }
            Some("vt") if self.has_radii => {
                let radius = words.next().and_then(|word| word.parse::<f64>().ok());
                let radius = radius.filter(|radius| radius.is_finite());
                let Some(radius) = radius else {
                    return fail("a radius is needed here");
                };
                if self.radii.len() == MAX_POINTS {
                    return fail(format!("more than {MAX_POINTS} radii"));
                }
                self.radii.push(radius);
            }
            Some("f") => self.faces += 1,
            Some("usemtl") => self.material = words.collect::<Vec<_>>().join(" "),
            Some("l") => {
                self.has_lines = true;
                let group = self.draft.group(&self.material, None)?;
                let mut before: Option<(u32, f64)> = None;
                for word in words {
                    let own = self.end(word)?;
                    if let Some(before) = before {
                        self.draft.add(Limb {
                            ends: [before.0, own.0],
                            radii: [before.1, own.1],
                            group,
                            caps: [Cap::Round; 2],
                            clip: None,
                        })?;
                    }
                    before = Some(own);
                }
            }
            _ => {}
        }
        Ok(())
    }

    /// Reads an end that is written as `position` or `position/texture`, and its radius.
    fn end(&self, word: &str) -> Result<(u32, f64), Error> {
        let (position, texture) = word.split_once('/').unwrap_or((word, ""));
        let node = index(position, self.draft.count(), "v")?;
        if !self.has_radii || texture.is_empty() {
            return Ok((node, UNKNOWN));
        }
        let radius = index(texture, self.radii.len(), "vt")?;
        Ok((node, self.radii[radius as usize]))
    }
}

/// Returns a place in a list, from 0, of a number that counts from 1, or from the end if it is
/// negative.
fn index(word: &str, count: usize, list: &str) -> Result<u32, Error> {
    let place = match word.parse::<i64>() {
        Ok(n) if n > 0 => Some(n - 1),
        Ok(n) if n < 0 => n.checked_add(count as i64),
        _ => None,
    };
    match place {
        Some(place) if (0..count as i64).contains(&place) => Ok(place as u32),
        _ => fail(format!(
            "`{}` is none of the {count} `{list}` so far",
            shorten(word)
        )),
    }
}
