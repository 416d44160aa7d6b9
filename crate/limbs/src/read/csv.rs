//! CSV: cylinders of a tree, a row each, in named columns.
//!
//! The names are those of TreeQSM, SimpleForest, aRchi and rTwig, in which case, spaces and
//! punctuation do not count. A cylinder has a start, and an end or an axis and a length.

use super::Reading;
use super::radii::{list, plain};
use crate::draft::Draft;
use crate::error::{Error, fail, fail_at, shorten};
use crate::graph::{Cap, Graph, Limb};
use crate::limits::MAX_LIMBS;
use csv::{ReaderBuilder, StringRecord};
use glam::DVec3;
use mesh::formats::text;
use std::collections::HashMap;

/// Spellings of the columns, the best first.
const START: [&str; 5] = ["start?", "startpoint?", "?start", "?1", "base?"];
const END: [&str; 5] = ["end?", "endpoint?", "?end", "?2", "top?"];
const AXIS: [&str; 4] = ["axis?", "axisdirection?", "direction?", "dir?"];
const RADIUS: [&str; 7] = [
    "radius",
    "radiusm",
    "radiuscyl",
    "cylradius",
    "modified",
    "rawradius",
    "unmodradius",
];
const DIAMETER: [&str; 4] = ["diameter", "diameterm", "cyldiameter", "diametercyl"];
const LENGTH: [&str; 5] = ["length", "lengthm", "axislength", "cyllength", "height"];
const ID: [&str; 4] = ["id", "cylid", "cylinderid", "index"];
const PARENT: [&str; 5] = [
    "parent",
    "parentid",
    "parentcylinder",
    "idparent",
    "parentcyl",
];

/// Names of the axes, letters before the numbers of a matrix' columns.
const AXES: [[&str; 3]; 2] = [["x", "y", "z"], ["1", "2", "3"]];

/// Share of a parent's radius within which its end counts as its child's start.
const NEAR: f64 = 1e-3;

/// Columns of a table, by their indices.
struct Columns {
    start: [usize; 3],
    end: Option<[usize; 3]>,
    axis: Option<([usize; 3], usize)>,
    /// Column, and the factor that makes radii of its values: a half for diameters.
    radius: (usize, f64),
    id: Option<usize>,
    parent: Option<usize>,
}

/// Cylinder of a tree.
struct Cylinder {
    line: usize,
    ends: [DVec3; 2],
    radius: f64,
    parent: Option<i64>,
}

/// Reads a table of cylinders, in metres.
pub(super) fn read(bytes: &[u8], reading: &Reading<'_>) -> Result<Graph, Error> {
    let text = text::decode(bytes);
    let bytes = text.as_bytes();
    let heading = bytes
        .split(|byte| *byte == b'\n')
        .find(|line| !matches!(line.trim_ascii(), [] | [b'#', ..]));
    let heading = heading.unwrap_or_default();
    // A comma wins where others are as many.
    let delimiter = [b' ', b'\t', b';', b',']
        .into_iter()
        .max_by_key(|delimiter| heading.iter().filter(|byte| *byte == delimiter).count());
    let mut reader = ReaderBuilder::new()
        .delimiter(delimiter.unwrap_or(b','))
        .flexible(true)
        .trim(csv::Trim::All)
        .comment(Some(b'#'))
        .from_reader(bytes);
    let names = reader.headers().map_err(wrong)?.clone();
    let columns = Columns::find(&names, reading.radii)?;
    let mut draft = Draft::new(Some(1000.0));
    let group = draft.group("", None)?;
    let mut cylinders: Vec<Cylinder> = Vec::new();
    let mut ids: HashMap<i64, usize> = HashMap::new();
    let mut record = StringRecord::new();
    while reader.read_record(&mut record).map_err(wrong)? {
        if cylinders.len() == MAX_LIMBS {
            return fail(format!("more than {MAX_LIMBS} cylinders"));
        }
        let line = record
            .position()
            .map_or(0, |position| position.line() as usize);
        let cylinder = columns.cylinder(&names, &record, line)?;
        // Without a column of ids, rows count from 1.
        let id = match columns.id {
            Some(column) => whole(&names, &record, line, column)?,
            None => cylinders.len() as i64 + 1,
        };
        if let Some(first) = ids.insert(id, cylinders.len()) {
            let text = format!(
                "cylinder {id} stands in line {} already",
                cylinders[first].line
            );
            draft.remark(Some(line), text);
            ids.insert(id, first);
        }
        if cylinder.radius <= 0.0 {
            draft.remark(
                Some(line),
                format!("the radius of cylinder {id} is not above 0"),
            );
        }
        cylinders.push(cylinder);
    }
    // Roots name a parent below the least id: 0, or -1 where cylinders count from 0.
    let least = ids.keys().copied().min().unwrap_or(0);
    for cylinder in &mut cylinders {
        cylinder.parent = cylinder.parent.filter(|parent| *parent >= least);
    }
    join(&cylinders, &ids, group, &mut draft)?;
    draft.weld();
    draft.finish(reading.radius)
}

fn wrong(error: csv::Error) -> Error {
    let line = error.position().map_or(1, csv::Position::line);
    Error(format!("line {line}: this is no table of text: {error}"))
}

/// Makes limbs of cylinders. A child begins at its parent's end, or else at the parent's axis, from
/// where a limb as thick as the child leads to it.
fn join(
    cylinders: &[Cylinder],
    ids: &HashMap<i64, usize>,
    group: u32,
    draft: &mut Draft,
) -> Result<(), Error> {
    let mut nodes: Vec<[u32; 2]> = Vec::new();
    for cylinder in cylinders {
        let [a, b] = cylinder.ends.map(|end| {
            draft
                .node(end, cylinder.radius, group)
                .or_else(|Error(text)| fail_at(cylinder.line, text))
        });
        nodes.push([a?, b?]);
    }
    // The nodes on each cylinder's axis, with their share of its length.
    let mut joints: Vec<Vec<(f64, u32)>> = vec![Vec::new(); cylinders.len()];
    let mut limbs: Vec<([u32; 2], f64)> = Vec::new();
    for (i, cylinder) in cylinders.iter().enumerate() {
        let Some(id) = cylinder.parent else { continue };
        let Some(&above) = ids.get(&id).filter(|above| **above != i) else {
            let text = format!("there is no cylinder {id}, which is to come before this one");
            draft.remark(Some(cylinder.line), text);
            continue;
        };
        let (start, parent) = (cylinder.ends[0], &cylinders[above]);
        let near = NEAR * parent.radius.max(0.0);
        let side = [1, 0]
            .into_iter()
            .find(|side| parent.ends[*side].distance(start) <= near);
        if let Some(side) = side {
            nodes[i][0] = nodes[above][side];
            continue;
        }
        let axis = parent.ends[1] - parent.ends[0];
        let share = (start - parent.ends[0]).dot(axis) / axis.length_squared();
        let joint = if share >= 1.0 {
            nodes[above][1]
        } else if share > 0.0 {
            let joint = draft.node(parent.ends[0] + axis * share, parent.radius, group)?;
            joints[above].push((share, joint));
            joint
        } else {
            nodes[above][0]
        };
        limbs.push(([joint, nodes[i][0]], cylinder.radius));
    }
    for ((cylinder, [start, end]), mut joints) in cylinders.iter().zip(nodes).zip(joints) {
        joints.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut at = start;
        for next in joints.into_iter().map(|(_, joint)| joint).chain([end]) {
            limbs.push(([at, next], cylinder.radius));
            at = next;
        }
    }
    for (ends, radius) in limbs {
        draft.add(Limb {
            ends,
            radii: [radius; 2],
            group,
            caps: [Cap::Round; 2],
            clip: None,
        })?;
    }
    Ok(())
}

impl Columns {
    /// Finds the columns by their names.
    fn find(names: &StringRecord, radii: Option<&str>) -> Result<Self, Error> {
        let mut plain_names: Vec<String> = names.iter().map(plain).collect();
        // TreeQSM names three columns once.
        for i in 2..plain_names.len() {
            if !plain_names[i - 2].is_empty() && plain_names[i - 1..=i].iter().all(String::is_empty)
            {
                let name = plain_names[i - 2].clone();
                for (column, axis) in plain_names[i - 2..=i].iter_mut().zip(["x", "y", "z"]) {
                    *column = format!("{name}{axis}");
                }
            }
        }
        let radius = match radii.map(plain) {
            Some(name) => {
                let factor = if name.ends_with("diameter") { 0.5 } else { 1.0 };
                one(&plain_names, &[&name]).map(|column| (column, factor))
            }
            None => one(&plain_names, &RADIUS)
                .map(|column| (column, 1.0))
                .or_else(|| one(&plain_names, &DIAMETER).map(|column| (column, 0.5))),
        };
        let end = three(&plain_names, &END);
        let axis = three(&plain_names, &AXIS).zip(one(&plain_names, &LENGTH));
        match (three(&plain_names, &START), radius) {
            (Some(start), Some(radius)) if end.is_some() || axis.is_some() => Ok(Self {
                start,
                end,
                axis,
                radius,
                id: one(&plain_names, &ID),
                parent: one(&plain_names, &PARENT),
            }),
            _ => fail(format!(
                "line 1: a table of cylinders needs columns of a start, an end (or an axis and a \
                 length) and a radius, such as `start_x`, `start_y`, `start_z`, `end_x`, `end_y`, \
                 `end_z`, `radius` and `parent`; the columns here are {}",
                list(names.iter())
            )),
        }
    }

    /// Reads a row.
    fn cylinder(
        &self,
        names: &StringRecord,
        record: &StringRecord,
        line: usize,
    ) -> Result<Cylinder, Error> {
        let start = triple(names, record, line, self.start)?;
        let end = match (self.end, self.axis) {
            (Some(end), _) => triple(names, record, line, end)?,
            (None, Some((axis, length))) => {
                let length = number(names, record, line, length)?;
                start + triple(names, record, line, axis)?.normalize_or_zero() * length
            }
            (None, None) => start,
        };
        let parent = match self.parent {
            Some(column) => Some(whole(names, record, line, column)?),
            None => None,
        };
        Ok(Cylinder {
            line,
            ends: [start, end],
            radius: number(names, record, line, self.radius.0)? * self.radius.1,
            parent,
        })
    }
}

/// Finds the column of the first spelling that there is.
fn one(names: &[String], spellings: &[&str]) -> Option<usize> {
    let mut places = spellings
        .iter()
        .map(|spelling| names.iter().position(|name| name == spelling));
    places.find_map(|place| place)
}

/// Finds three columns by the first spelling, with the axis or its number for `?`, of which there
/// are all.
fn three(names: &[String], spellings: &[&str]) -> Option<[usize; 3]> {
    let all = AXES
        .iter()
        .flat_map(|axes| spellings.iter().map(move |spelling| (axes, spelling)));
    all.into_iter().find_map(|(axes, spelling)| {
        let columns = axes.map(|axis| one(names, &[&spelling.replace('?', axis)]));
        let [Some(x), Some(y), Some(z)] = columns else {
            return None;
        };
        Some([x, y, z])
    })
}

/// Reads three numbers.
fn triple(
    names: &StringRecord,
    record: &StringRecord,
    line: usize,
    columns: [usize; 3],
) -> Result<DVec3, Error> {
    let [x, y, z] = columns.map(|column| number(names, record, line, column));
    Ok(DVec3::new(x?, y?, z?))
}

/// Reads a number.
fn number(
    names: &StringRecord,
    record: &StringRecord,
    line: usize,
    column: usize,
) -> Result<f64, Error> {
    let name = names.get(column).unwrap_or_default();
    let word = record.get(column).unwrap_or_default();
    // A comma in a cell of a table of semicolons, or in quotes, is a point.
    match word.replacen(',', ".", 1).parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ if word.is_empty() => fail_at(line, format!("`{}` is missing", shorten(name))),
        _ => fail_at(
            line,
            format!(
                "`{}` is `{}`, which is no number",
                shorten(name),
                shorten(word)
            ),
        ),
    }
}

/// Reads a whole number; -1 for what R writes where there is none.
fn whole(
    names: &StringRecord,
    record: &StringRecord,
    line: usize,
    column: usize,
) -> Result<i64, Error> {
    if matches!(record.get(column), Some("NA" | "")) {
        return Ok(-1);
    }
    let number = number(names, record, line, column)?;
    if number != number.trunc() || number.abs() > 9e15 {
        let name = shorten(names.get(column).unwrap_or_default());
        return fail_at(line, format!("`{name}` is {number}, no whole number"));
    }
    Ok(number as i64)
}
