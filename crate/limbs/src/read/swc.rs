//! SWC: a node in each line, with its type, place, radius and the node before it.
//!
//! The seven columns are those of Cannon et al., J. Neurosci. Methods 84 (1998); the meaning of
//! types and of a soma of three nodes are NeuroMorpho.Org's.

use super::Reading;
use crate::draft::Draft;
use crate::error::{Error, fail, fail_at, shorten};
use crate::graph::{Cap, Graph, Limb};
use crate::limits::MAX_POINTS;
use glam::DVec3;
use mesh::formats::text;
use std::collections::BTreeMap;

/// Type of a soma's nodes.
const SOMA: i64 = 1;

/// Columns of a line.
const COLUMNS: usize = 7;

/// Largest magnitude of whole numbers, all of which up to it a double holds.
const MAX_WHOLE: f64 = 9e15;

/// Names of the types 0 … 6.
pub(crate) const TYPES: [&str; 7] = [
    "undefined",
    "soma",
    "axon",
    "dendrite",
    "apical",
    "fork",
    "end",
];

/// Line of a file.
#[derive(Clone, Copy, PartialEq)]
struct Row {
    line: usize,
    kind: i64,
    position: DVec3,
    radius: f64,
    parent: i64,
}

/// Reads an SWC file, in micrometres.
pub(super) fn read(bytes: &[u8], reading: &Reading<'_>) -> Result<Graph, Error> {
    let text = text::decode(bytes);
    let mut draft = Draft::new(Some(1e-3));
    let mut rows = rows(&text, &mut draft)?;
    if rows.is_empty() {
        return fail("this SWC file has no nodes: lines are `id type x y z radius parent`");
    }
    cut_cycles(&mut rows, &mut draft);
    let mut nodes: BTreeMap<i64, u32> = BTreeMap::new();
    for (id, row) in &rows {
        let group = draft.group(&name(row.kind), None)?;
        let node = draft
            .node(row.position, row.radius, group)
            .or_else(|Error(text)| fail_at(row.line, text))?;
        nodes.insert(*id, node);
    }
    let flat = standard_soma(&rows);
    // Whether each node is joined to another one, for a node of a soma to another one of it.
    let mut is_joined = vec![false; draft.count()];
    for (id, row) in &rows {
        let (Some(parent), Some(before)) = (rows.get(&row.parent), nodes.get(&row.parent)) else {
            continue;
        };
        let ends = [*before, nodes[id]];
        let group = draft.group(&name(row.kind), None)?;
        let [is_child_soma, is_parent_soma] = [row, parent].map(|row| row.kind == SOMA);
        is_joined[ends[0] as usize] |= is_child_soma || !is_parent_soma;
        is_joined[ends[1] as usize] |= is_parent_soma || !is_child_soma;
        let own = draft.radius(ends[1]);
        // A branch is as thick at the soma as where it is seen first.
        let before = match is_parent_soma && !is_child_soma {
            true => own,
            false => draft.radius(ends[0]),
        };
        draft.add(Limb {
            ends,
            radii: [before, own],
            group,
            caps: [row.parent, *id].map(|id| match flat.contains(&id) {
                true => Cap::Flat,
                false => Cap::Round,
            }),
            clip: None,
        })?;
    }
    for (node, is_joined) in (0..).zip(is_joined) {
        if !is_joined {
            draft.ball(node);
        }
    }
    draft.finish(reading.radius)
}

/// Reads the lines, by their ids.
fn rows(text: &str, draft: &mut Draft) -> Result<BTreeMap<i64, Row>, Error> {
    let mut rows: BTreeMap<i64, Row> = BTreeMap::new();
    for (line, content) in (1..).zip(text.lines()) {
        let (content, comment) = content.split_once('#').unwrap_or((content, ""));
        let words = split(content);
        if words.is_empty() {
            remark_scale(line, comment, draft);
            continue;
        }
        if rows.is_empty() && words.iter().all(|word| word.parse::<f64>().is_err()) {
            draft.remark(
                Some(line),
                "this line has no numbers and is taken for a heading",
            );
            continue;
        }
        let mut words = words.into_iter();
        let id = whole(line, "id", number(line, "id", &mut words)?)?;
        let kind = whole(line, "type", number(line, "type", &mut words)?)?;
        let x = number(line, "x", &mut words)?;
        let y = number(line, "y", &mut words)?;
        let z = number(line, "z", &mut words)?;
        let row = Row {
            line,
            kind,
            position: DVec3::new(x, y, z),
            radius: number(line, "radius", &mut words)?,
            parent: whole(line, "parent", number(line, "parent", &mut words)?)?,
        };
        if row.radius <= 0.0 {
            draft.remark(
                Some(line),
                format!("the radius of node {id} is not above 0"),
            );
        }
        if rows.len() == MAX_POINTS {
            return fail_at(line, format!("more than {MAX_POINTS} nodes"));
        }
        if let Some(first) = rows.get(&id) {
            let text = match *first
                == (Row {
                    line: first.line,
                    ..row
                }) {
                true => format!("node {id} stands in line {} already", first.line),
                false => format!(
                    "node {id} stands in line {} already, and otherwise: this one is left out",
                    first.line
                ),
            };
            draft.remark(Some(line), text);
            continue;
        }
        rows.insert(id, row);
    }
    let mut orphans: Vec<(usize, i64, i64)> = rows
        .iter()
        // Where ids count from 1, 0 stands for none.
        .filter(|(_, row)| row.parent > 0 && !rows.contains_key(&row.parent))
        .map(|(id, row)| (row.line, *id, row.parent))
        .collect();
    orphans.sort_unstable();
    for (line, id, parent) in orphans {
        let text = format!("there is no node {parent}, which is to come before node {id}");
        draft.remark(Some(line), text);
    }
    Ok(rows)
}

/// Splits a line at blanks and commas; at blanks alone where these make all columns, so that a
/// comma in a word is told as no part of a number.
fn split(line: &str) -> Vec<&str> {
    let blanks = line.split_ascii_whitespace();
    let words: Vec<&str> = blanks.map(|word| word.trim_end_matches(',')).collect();
    if words.len() >= COLUMNS {
        return words;
    }
    let words = line.split(|c: char| c.is_ascii_whitespace() || c == ',');
    words.filter(|word| !word.is_empty()).collect()
}

/// Tells of a scale that the comments ask for.
fn remark_scale(line: usize, comment: &str, draft: &mut Draft) {
    let mut words = comment.split_ascii_whitespace();
    let is_scale = words
        .next()
        .is_some_and(|word| word.eq_ignore_ascii_case("SCALE"));
    let is_other = words.any(|word| word.parse::<f64>().is_ok_and(|scale| scale != 1.0));
    if is_scale && is_other {
        let text = "this scale is not applied: coordinates are taken for micrometres";
        draft.remark(Some(line), text);
    }
}

/// Reads the next word of a line as a number.
fn number<'a>(
    line: usize,
    column: &str,
    words: &mut impl Iterator<Item = &'a str>,
) -> Result<f64, Error> {
    let Some(word) = words.next() else {
        let form = "a node of an SWC file is `id type x y z radius parent`";
        return fail_at(line, format!("`{column}` is missing: {form}"));
    };
    match word.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => {
            let is_comma = word.replacen(',', ".", 1).parse::<f64>().is_ok();
            let hint = if is_comma { ": it needs a point" } else { "" };
            let text = format!(
                "`{column}` is `{}`, which is no number{hint}",
                shorten(word)
            );
            fail_at(line, text)
        }
    }
}

/// Returns a whole number.
fn whole(line: usize, column: &str, number: f64) -> Result<i64, Error> {
    if number != number.trunc() || number.abs() > MAX_WHOLE {
        let text = format!("`{column}` is {number}, no whole number up to {MAX_WHOLE:e}");
        return fail_at(line, text);
    }
    Ok(number as i64)
}

/// Makes roots of nodes that come before themselves: on each such cycle the one of the least id.
fn cut_cycles(rows: &mut BTreeMap<i64, Row>, draft: &mut Draft) {
    // The root from whose walk each node was reached.
    let mut seen: BTreeMap<i64, i64> = BTreeMap::new();
    let mut cuts: Vec<(usize, i64)> = Vec::new();
    for start in rows.keys().copied() {
        let mut at = start;
        let walk = loop {
            let Some(row) = rows.get(&at) else { break None };
            if let Some(walk) = seen.get(&at) {
                break Some(*walk);
            }
            seen.insert(at, start);
            at = row.parent;
        };
        if walk != Some(start) {
            continue;
        }
        // The walk has met itself: `at` is on the cycle.
        let (mut least, end) = (at, at);
        loop {
            at = rows[&at].parent;
            least = least.min(at);
            if at == end {
                break;
            }
        }
        cuts.push((rows[&least].line, least));
    }
    cuts.sort_unstable();
    for (line, id) in cuts {
        if let Some(row) = rows.get_mut(&id) {
            row.parent = -1;
        }
        let text = format!("node {id} comes before itself: it is taken for a root");
        draft.remark(Some(line), text);
    }
}

/// Returns the ids of a soma's two outer nodes if it is the standard's of three nodes, a cylinder
/// that is as long as it is wide: a centre, and two nodes a radius to either side, its children.
fn standard_soma(rows: &BTreeMap<i64, Row>) -> Vec<i64> {
    let soma: Vec<(&i64, &Row)> = rows.iter().filter(|(_, row)| row.kind == SOMA).collect();
    let [first, second, third] = soma[..] else {
        return Vec::new();
    };
    for [centre, a, b] in [
        [first, second, third],
        [second, first, third],
        [third, first, second],
    ] {
        let radius = centre.1.radius;
        let about = 0.05 * radius;
        let [to_a, to_b] = [a, b].map(|side| side.1.position - centre.1.position);
        let is_child = [a, b].iter().all(|side| side.1.parent == *centre.0);
        let is_as_wide = [a, b]
            .iter()
            .all(|side| (side.1.radius - radius).abs() <= about);
        let is_opposite = (to_a + to_b).length() <= about;
        let is_as_long = (to_a.length() - radius).abs() <= about;
        if radius > 0.0 && is_child && is_as_wide && is_opposite && is_as_long {
            return vec![*a.0, *b.0];
        }
    }
    Vec::new()
}

/// Returns the name of a type.
fn name(kind: i64) -> String {
    let known = usize::try_from(kind).ok().and_then(|kind| TYPES.get(kind));
    known.map_or_else(|| format!("type{kind}"), ToString::to_string)
}
