//! OBJ: lines of text, of which `v` (with or without a colour), `vn`, `f`, and the names in `o`,
//! `g` and `usemtl` are read.

use crate::color::decode;
use crate::error::{Error, fail};
use crate::formats::text;
use crate::limits::{MAX_COORDINATE, MAX_MATERIALS, MAX_VERTICES};
use crate::triangle_mesh::{Group, Material, TriangleMesh};
use glam::DVec3;
use std::collections::HashMap;

/// Corner of a face: its position and its normal, counted from 0.
type Corner = (u32, Option<u32>);

#[derive(Default)]
struct Reader {
    mesh: TriangleMesh,
    positions: Vec<DVec3>,
    normals: Vec<DVec3>,
    /// Corner of the mesh that each position with a normal has become.
    corners: HashMap<Corner, u32>,
    /// The normal of each corner of the mesh.
    chosen: Vec<Option<u32>>,
    /// The colour of each position, as far as there are any.
    colors: Vec<[f32; 3]>,
    /// The position of each corner of the mesh.
    sources: Vec<u32>,
    /// The names that `o` or `g`, and `usemtl` gave last.
    name: String,
    material: Option<String>,
    /// The first triangle with these.
    start: u32,
}

pub(crate) fn read(bytes: &[u8]) -> Result<TriangleMesh, Error> {
    let text = text::decode(bytes);
    let mut reader = Reader::default();
    // A backslash at its end continues a line.
    let mut begun = String::new();
    for (line, number) in text.lines().zip(1..) {
        let result = if let Some(part) = line.trim_end().strip_suffix('\\') {
            begun.push_str(part);
            begun.push(' ');
            Ok(())
        } else if begun.is_empty() {
            reader.line(line)
        } else {
            begun.push_str(line);
            reader.line(&std::mem::take(&mut begun))
        };
        if let Err(Error(text)) = result {
            return fail(format!("line {number}: {text}"));
        }
    }
    reader.finish()
}

impl Reader {
    fn line(&mut self, line: &str) -> Result<(), Error> {
        let line = line.split_once('#').map_or(line, |(line, _)| line);
        let mut words = line.split_ascii_whitespace();
        match words.next() {
            Some("v") => {
                let mut numbers = words.clone();
                triple(&mut self.positions, words)?;
                if self
                    .positions
                    .last()
                    .is_some_and(|p| !p.is_finite() || p.abs().max_element() > MAX_COORDINATE)
                {
                    return fail(format!(
                        "numbers within ±{MAX_COORDINATE:e} are needed here"
                    ));
                }
                // Three more numbers are a colour, one more is a weight.
                let colour: [_; 6] = core::array::from_fn(|_| {
                    let number = numbers.next().and_then(|word| word.parse::<f64>().ok());
                    number.map(|x| decode(x.clamp(0.0, 1.0)))
                });
                if let [.., Some(r), Some(g), Some(b)] = colour {
                    self.colors.resize(self.positions.len() - 1, [1.0; 3]);
                    self.colors.push([r, g, b]);
                }
                Ok(())
            }
            Some("vn") => triple(&mut self.normals, words),
            Some("f") => self.face(words),
            Some("o" | "g") => {
                self.end_group()?;
                self.name = words.collect::<Vec<_>>().join(" ");
                Ok(())
            }
            Some("usemtl") => {
                self.end_group()?;
                self.material = Some(words.collect::<Vec<_>>().join(" "));
                Ok(())
            }
            // Texture coordinates, lines, …
            _ => Ok(()),
        }
    }

    /// Ends the group of the triangles since the last name, if they have a name.
    fn end_group(&mut self) -> Result<(), Error> {
        let triangles = self.start..self.mesh.triangles.len() as u32;
        self.start = triangles.end;
        if triangles.is_empty() || (self.name.is_empty() && self.material.is_none()) {
            return Ok(());
        }
        if self.mesh.groups.len() == MAX_MATERIALS {
            return fail(format!("more than {MAX_MATERIALS} groups"));
        }
        let material = self.material.clone().map(|name| Material {
            name,
            ..Material::default()
        });
        self.mesh.groups.push(Group {
            name: self.name.clone(),
            material,
            triangles,
        });
        Ok(())
    }

    fn face<'a>(&mut self, words: impl Iterator<Item = &'a str>) -> Result<(), Error> {
        let mut first_and_last = None;
        let mut count = 0;
        for word in words {
            let corner = self.corner(word)?;
            count += 1;
            first_and_last = match first_and_last {
                None => Some((corner, None)),
                Some((first, None)) => Some((first, Some(corner))),
                Some((first, Some(last))) => {
                    self.mesh.add_triangle([first, last, corner])?;
                    Some((first, Some(corner)))
                }
            };
        }
        if count < 3 {
            return fail("a face needs at least three corners");
        }
        Ok(())
    }

    /// Reads a corner written as `position`, `position/texture`, `position//normal` or
    /// `position/texture/normal`.
    fn corner(&mut self, word: &str) -> Result<u32, Error> {
        let mut parts = word.split('/');
        let position = index(parts.next().unwrap_or(""), self.positions.len(), "v")?;
        let normal = match parts.nth(1) {
            None | Some("") => None,
            Some(part) => Some(index(part, self.normals.len(), "vn")?),
        };
        if let Some(&known) = self.corners.get(&(position, normal)) {
            return Ok(known);
        }
        let corner = self.mesh.add_vertex(self.positions[position as usize])?;
        self.corners.insert((position, normal), corner);
        self.chosen.push(normal);
        self.sources.push(position);
        Ok(corner)
    }

    fn finish(mut self) -> Result<TriangleMesh, Error> {
        self.end_group()?;
        let normals = self.chosen.iter();
        self.mesh.normals = normals
            .map(|chosen| chosen.map(|i| self.normals[i as usize]))
            .collect();
        if !self.colors.is_empty() {
            self.mesh.colors = Some(
                self.sources
                    .iter()
                    .map(|i| self.colors.get(*i as usize).copied().unwrap_or([1.0; 3]))
                    .collect(),
            );
        }
        Ok(self.mesh)
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
            word.chars().take(20).collect::<String>()
        )),
    }
}

fn triple<'a>(
    list: &mut Vec<DVec3>,
    mut words: impl Iterator<Item = &'a str>,
) -> Result<(), Error> {
    let numbers = [0; 3].map(|_| words.next().and_then(|word| word.parse::<f64>().ok()));
    let [Some(x), Some(y), Some(z)] = numbers else {
        return fail("three numbers are needed here");
    };
    if list.len() == MAX_VERTICES {
        return fail(format!("more than {MAX_VERTICES} positions or normals"));
    }
    list.push(DVec3::new(x, y, z));
    Ok(())
}
