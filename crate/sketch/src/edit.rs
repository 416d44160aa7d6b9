//! Changes of a skeleton's text. Each gives the whole new text of the file; what it does not name stays as it is
//! written.

use crate::block::Block;
use skeleton::Node;
use std::fmt::Write;
use std::ops::Range;

/// Where a new curve begins.
#[derive(Clone, Debug, PartialEq)]
pub enum Start {
    /// At a node of its own.
    Free,
    /// At a node that is there. At the end of a single curve it goes on along that one.
    Node(usize),
    /// On a curve between two of its nodes, where it gets a new one.
    Between {
        /// The curve's index.
        curve: usize,
        /// The new node comes behind the curve's node of this number.
        span: usize,
        /// The new node.
        node: Node,
    },
    /// Where the new curve before this one begins.
    Same,
}

/// A new curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Limb {
    /// Its beginning.
    pub start: Start,
    /// Its nodes; unless it begins at a node of its own, without the first one.
    pub nodes: Vec<Node>,
}

/// A replacement of a piece of the text.
type Edit = (Range<usize>, String);

/// Adds curves to the skeleton whose command is at `span`. `grain` is a length that counts for little, to which
/// coordinates are rounded. `None` if there is no such skeleton, node or curve.
#[must_use]
pub fn extend(text: &str, span: Range<usize>, limbs: &[Limb], grain: f64) -> Option<String> {
    let block = Block::read(text, span)?;
    let mut names = Names::of(&block);
    let indent = indent(text, &block);
    let mut added = String::new();
    let mut edits: Vec<Edit> = Vec::new();
    let mut before: Option<String> = None;
    for limb in limbs {
        let start = match &limb.start {
            Start::Free => None,
            Start::Same => Some(before.clone()?),
            Start::Node(index) => Some(block.nodes.get(*index)?.name.clone()),
            Start::Between { curve, span, node } => {
                let name = names.next();
                line(&mut added, &indent, &name, node, grain);
                let (_, behind) = block.curves.get(*curve)?.names.get(*span)?;
                edits.push((behind.end..behind.end, format!(" {name}")));
                Some(name)
            }
        };
        let own: Vec<String> = limb.nodes.iter().map(|_| names.next()).collect();
        for (name, node) in own.iter().zip(&limb.nodes) {
            line(&mut added, &indent, name, node, grain);
        }
        let first = start.clone().or_else(|| own.first().cloned())?;
        let end = match &limb.start {
            Start::Node(_) => end_of_curve(&block, &first),
            _ => None,
        };
        // Two new curves that begin at one end branch there.
        let goes_on = end.filter(|(place, _)| edits.iter().all(|(range, _)| range != place));
        if let Some((place, is_last)) = goes_on {
            let along = if is_last {
                own.iter().fold(String::new(), |all, name| all + " " + name)
            } else {
                own.iter()
                    .rev()
                    .fold(String::new(), |all, name| all + name + " ")
            };
            edits.push((place, along));
        } else {
            let along = start.iter().chain(&own).cloned().collect::<Vec<_>>();
            if along.len() < 2 {
                return None;
            }
            let _ = writeln!(added, "{indent}curve {}", along.join(" "));
        }
        before = Some(first);
    }
    edits.push(at_end(text, &block, added));
    Some(applied(text, edits))
}

/// A text with a new skeleton at its end. `None` if no limb has two nodes of its own to begin with.
#[must_use]
pub fn create(
    text: &str,
    material: &str,
    name: &str,
    limbs: &[Limb],
    grain: f64,
) -> Option<String> {
    let mut text = text.to_owned();
    if !text.is_empty() && !text.ends_with('\n') {
        text.push('\n');
    }
    if !text.is_empty() {
        text.push('\n');
    }
    let start = text.len();
    let _ = write!(text, "skeleton {material}, {name} {{\n}}\n");
    let end = text.len() - 1;
    let text = extend(&text, start..end, limbs, grain)?;
    let block = Block::read(&text, start..text.len())?;
    (!block.curves.is_empty()).then_some(text)
}

/// Takes a node away, from its curves as well; a curve of a single node goes with it. Without a curve the whole command
/// goes. `None` if there is no such node.
#[must_use]
pub fn remove(text: &str, span: Range<usize>, node: usize) -> Option<String> {
    let block = Block::read(text, span.clone())?;
    let name = &block.nodes.get(node)?.name;
    let mut removed: Vec<Range<usize>> = Vec::new();
    let mut left = 0;
    let mut used: Vec<&str> = Vec::new();
    let mut dropped: Vec<&str> = vec![name];
    for curve in &block.curves {
        let rest: Vec<&str> = curve
            .names
            .iter()
            .map(|(own, _)| own.as_str())
            .filter(|own| own != name)
            .collect();
        let is_short = rest.len() < 2 || rest.iter().all(|own| *own == rest[0]);
        if is_short {
            removed.push(curve.span.clone());
            dropped.extend(rest);
        } else {
            left += 1;
            used.extend(rest);
            for (own, range) in &curve.names {
                if own == name {
                    let behind = text[range.end..].trim_start_matches([' ', '\t']);
                    removed.push(range.start..text.len() - behind.len());
                }
            }
        }
    }
    if left == 0 {
        return Some(without(text, &[span]));
    }
    for node in &block.nodes {
        let own = node.name.as_str();
        if dropped.contains(&own) && !used.contains(&own) {
            removed.push(node.span.clone());
        }
    }
    Some(without(text, &removed))
}

/// Gives a node another radius. `None` if there is no such node.
#[must_use]
pub fn widen(
    text: &str,
    span: Range<usize>,
    node: usize,
    radius: f64,
    grain: f64,
) -> Option<String> {
    let block = Block::read(text, span)?;
    let node = block.nodes.get(node)?;
    let number = rounded(radius.max(0.0), grain);
    let edit = match &node.radius {
        Some(range) => (range.clone(), number),
        None => (node.span.end..node.span.end, format!(" radius {number}")),
    };
    Some(applied(text, vec![edit]))
}

/// The place where a node's only curve ends or begins with it, and whether it ends there.
fn end_of_curve(block: &Block, node: &str) -> Option<(Range<usize>, bool)> {
    let mut visits = block
        .curves
        .iter()
        .flat_map(|curve| &curve.names)
        .filter(|(name, _)| name == node);
    visits.next()?;
    if visits.next().is_some() {
        return None;
    }
    block.curves.iter().find_map(|curve| {
        let (first, last) = (curve.names.first()?, curve.names.last()?);
        if last.0 == node {
            Some((last.1.end..last.1.end, true))
        } else if first.0 == node {
            Some((first.1.start..first.1.start, false))
        } else {
            None
        }
    })
}

/// Names for new nodes: `n1`, `n2`, …, which the block does not have.
struct Names<'a> {
    block: &'a Block,
    number: usize,
}

impl<'a> Names<'a> {
    fn of(block: &'a Block) -> Self {
        let number = block.nodes.len();
        Self { block, number }
    }

    fn next(&mut self) -> String {
        loop {
            self.number += 1;
            let name = format!("n{}", self.number);
            if self.block.node(&name).is_none() {
                return name;
            }
        }
    }
}

fn line(text: &mut String, indent: &str, name: &str, node: &Node, grain: f64) {
    let [x, y, z] = node.position.to_array().map(|x| rounded(x, grain));
    let radius = rounded(node.radius, grain);
    let _ = writeln!(text, "{indent}node {name} <{x} {y} {z}> radius {radius}");
}

/// A number without the digits that are below a tenth of the grain.
fn rounded(number: f64, grain: f64) -> String {
    let digits = -libm::floor(libm::log10(grain.max(1e-9)));
    let decimals = digits.clamp(0.0, 9.0) as usize;
    let text = format!("{number:.decimals$}");
    let text = if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.')
    } else {
        &text
    };
    match text {
        "-0" | "" => String::from("0"),
        text => text.to_owned(),
    }
}

/// What stands before the block's lines.
fn indent(text: &str, block: &Block) -> String {
    let items = block.nodes.iter().map(|node| node.span.start);
    let mut items = items.chain(block.curves.iter().map(|curve| curve.span.start));
    let own = items.find_map(|at| {
        let start = text[..at].rfind('\n').map_or(0, |end| end + 1);
        let before = &text[start..at];
        before.trim().is_empty().then(|| before.to_owned())
    });
    own.unwrap_or_else(|| String::from("  "))
}

/// Puts lines before the end of a block.
fn at_end(text: &str, block: &Block, lines: String) -> Edit {
    let start = text[..block.close].rfind('\n').map_or(0, |end| end + 1);
    if text[start..block.close].trim().is_empty() {
        (start..start, lines)
    } else {
        (block.close..block.close, format!("\n{lines}"))
    }
}

/// A text without some ranges: a line of which no more than a remark is left goes as a whole.
fn without(text: &str, ranges: &[Range<usize>]) -> String {
    let mut kept = String::new();
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let place = start..start + line.len();
        start = place.end;
        let inside = |at: &usize| ranges.iter().any(|range| range.contains(at));
        let is_touched = (place.start..place.end - 1).any(|at| inside(&at));
        if !is_touched {
            kept.push_str(line);
            continue;
        }
        let rest = line
            .char_indices()
            .filter(|(at, c)| *c == '\n' || !inside(&(place.start + at)));
        let rest: String = rest.map(|(_, c)| c).collect();
        let left = rest.trim_start();
        if !left.is_empty() && !left.starts_with('#') {
            kept.push_str(rest.trim_end());
            kept.push_str(if rest.ends_with('\n') { "\n" } else { "" });
        }
    }
    kept
}

fn applied(text: &str, mut edits: Vec<Edit>) -> String {
    edits.sort_by_key(|(range, _)| range.start);
    let mut text = text.to_owned();
    for (range, with) in edits.into_iter().rev() {
        text.replace_range(range, &with);
    }
    text
}
