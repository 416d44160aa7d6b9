//! Changes of a skeleton's text. Each gives the whole new text of the file; what it does not name
//! stays as it is written.

use crate::block::Block;
use rats::TextEdit;
use skeleton::{Node, Skeleton};
use std::fmt::Write;
use std::ops::Range;

/// The beginning of a new curve.
#[derive(Clone, Debug, PartialEq)]
pub enum Start {
    /// A node of its own.
    Free,
    /// A node that is there.
    Node(usize),
    /// A node that is there. If that is the end of a single curve then this one is made longer.
    End(usize),
    /// A new node on a curve, between two of its nodes.
    Between {
        /// The curve's index.
        curve: usize,
        /// The new node comes behind the curve's node of this number.
        span: usize,
        /// The place from that node to the next one, 0 … 1, which orders several new nodes there.
        share: f64,
        /// The new node.
        node: Node,
    },
    /// The beginning of the new curve before this one.
    Same,
}

/// A new curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Limb {
    /// The beginning.
    pub start: Start,
    /// The nodes; without the first one, unless that is a node of its own.
    pub nodes: Vec<Node>,
}

/// Adds curves to the skeleton whose command is at `span`. `grain` is a length that counts for
/// little, to which coordinates are rounded. `None` if there is no such skeleton, node or curve.
#[must_use]
pub fn extend(text: &str, span: Range<usize>, limbs: &[Limb], grain: f64) -> Option<String> {
    let block = Block::read(text, span)?;
    let mut names = Names::of(&block);
    let indent = indent(text, &block);
    let end_of_line = end_of_line(text);
    let mut added = String::new();
    let mut edits: Vec<(f64, TextEdit)> = Vec::new();
    let mut before: Option<String> = None;
    for limb in limbs {
        let start = match &limb.start {
            Start::Free => None,
            Start::Same => Some(before.clone()?),
            Start::Node(index) | Start::End(index) => Some(block.nodes.get(*index)?.name.clone()),
            Start::Between {
                curve,
                span,
                share,
                node,
            } => {
                let name = names.next();
                line(&mut added, &indent, &name, node, grain);
                let (_, behind) = block.curves.get(*curve)?.names.get(*span)?;
                edits.push((*share, put(behind.end, format!(" {name}"))));
                Some(name)
            }
        };
        let own: Vec<String> = limb.nodes.iter().map(|_| names.next()).collect();
        for (name, node) in own.iter().zip(&limb.nodes) {
            line(&mut added, &indent, name, node, grain);
        }
        let first = start.clone().or_else(|| own.first().cloned())?;
        let end = match &limb.start {
            Start::End(_) => end_of_curve(&block, &first),
            _ => None,
        };
        // Two new curves that begin at one end branch there.
        let goes_on = end.filter(|(place, _)| edits.iter().all(|(_, edit)| edit.span != *place));
        if let Some((place, is_last)) = goes_on {
            let along = if is_last {
                own.iter().fold(String::new(), |all, name| all + " " + name)
            } else {
                own.iter()
                    .rev()
                    .fold(String::new(), |all, name| all + name + " ")
            };
            // Behind new nodes of the same place.
            edits.push((2.0, TextEdit::new(0, place, along)));
        } else {
            let along = start.iter().chain(&own).cloned().collect::<Vec<_>>();
            if along.len() < 2 {
                return None;
            }
            let _ = writeln!(added, "{indent}curve {}", along.join(" "));
        }
        before = Some(first);
    }
    edits.push((0.0, at_end(text, &block, added.replace('\n', end_of_line))));
    Some(apply(text, edits))
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
    let end_of_line = end_of_line(text);
    let mut text = text.to_owned();
    if !text.is_empty() && !text.ends_with('\n') {
        text.push_str(end_of_line);
    }
    if !text.is_empty() {
        text.push_str(end_of_line);
    }
    let start = text.len();
    let _ = write!(
        text,
        "skeleton {material}, {name} {{{end_of_line}}}{end_of_line}"
    );
    let end = text.len() - end_of_line.len();
    let text = extend(&text, start..end, limbs, grain)?;
    let block = Block::read(&text, start..text.len())?;
    (!block.curves.is_empty()).then_some(text)
}

/// Takes a node away, from its curves as well; a curve of a single node goes with it. Without a
/// curve the whole command goes. `None` if there is no such node.
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
    let number = decimal(radius.max(0.0), grain);
    let edit = match &node.radius {
        Some(range) => TextEdit::new(0, range.clone(), number),
        None => put(node.span.end, format!(" radius {number}")),
    };
    Some(TextEdit::apply(text, [&edit]))
}

/// Gives a curve a new node behind its node of number `behind`. It becomes the block's last one.
/// `None` if there is no such place.
#[must_use]
pub fn insert(
    text: &str,
    span: Range<usize>,
    curve: usize,
    behind: usize,
    node: &Node,
    grain: f64,
) -> Option<String> {
    let block = Block::read(text, span)?;
    let names = &block.curves.get(curve)?.names;
    // Behind the last one there is no curve.
    names.get(behind + 1)?;
    let place = names[behind].1.end;
    let name = Names::of(&block).next();
    let last = block.nodes.last()?.span.end;
    let mut added = String::new();
    line(&mut added, &indent(text, &block), &name, node, grain);
    let added = format!("{}{}", end_of_line(text), added.trim_end());
    // A remark behind the last node stays on its line.
    let rest = &text[last..];
    let remark = rest.lines().next().unwrap_or_default();
    let last = if remark.trim_start().starts_with('#') {
        last + remark.len()
    } else {
        last
    };
    Some(apply(
        text,
        vec![
            (0.0, put(place, format!(" {name}"))),
            (1.0, put(last, added)),
        ],
    ))
}

/// Takes a curve away, and nodes that no other curve goes along. Without a curve the whole command
/// goes. `None` if there is no such curve.
#[must_use]
pub fn remove_curve(text: &str, span: Range<usize>, curve: usize) -> Option<String> {
    let block = Block::read(text, span.clone())?;
    block.curves.get(curve)?;
    Some(without_curves(text, span, &block, &[curve], &[]))
}

/// Cuts a curve between its node of number `between` and the next one: what hangs on the shorter
/// side falls off, with all curves that lead nowhere else. The other side ends at `end`; where its
/// last node is nearer to the cut than the radius there, it ends at that node. If both sides still
/// hang together another way, the curve only gets a gap there. Without a curve the whole command
/// goes.
///
/// `skeleton` is what the text makes. `None` if it does not belong to the text, or there is no such
/// curve.
#[must_use]
pub fn cut(
    text: &str,
    span: Range<usize>,
    skeleton: &Skeleton,
    curve: usize,
    between: usize,
    end: &Node,
    grain: f64,
) -> Option<String> {
    let block = Block::read(text, span.clone())?;
    let same = block.nodes.len() == skeleton.nodes.len()
        && block.curves.len() == skeleton.curves.len()
        && block.curves.iter().zip(&skeleton.curves).all(|(a, b)| {
            a.names.len() == b.len()
                && a.names
                    .iter()
                    .zip(b)
                    .all(|((name, _), node)| block.node(name) == Some(*node))
        });
    let along = skeleton.curves.get(curve).filter(|_| same)?;
    let (before, behind) = (*along.get(between)?, *along.get(between + 1)?);
    let sides = [before, behind].map(|node| side(skeleton, curve, between, node));
    let names = &block.curves[curve].names;
    let joined = sides[0][behind];
    let lengths = sides.each_ref().map(|side| length(skeleton, side));
    let near = [before, behind].map(|node| skeleton.nodes[node].position.distance(end.position));
    let first_stays = lengths[0] + near[0] >= lengths[1] + near[1];
    let mut added = String::new();
    let mut edits: Vec<(f64, TextEdit)> = Vec::new();
    let mut gone: Vec<usize> = Vec::new();
    if joined {
        // Pieces of a single node are nothing.
        let parts = [&names[..=between], &names[between + 1..]];
        let parts = parts.map(|part| part.iter().map(|(name, _)| name.as_str()));
        let long: Vec<String> = parts
            .into_iter()
            .map(|part| part.collect::<Vec<_>>())
            .filter(|part| part.len() > 1)
            .map(|part| part.join(" "))
            .collect();
        match long.as_slice() {
            [] => gone.push(curve),
            [first, others @ ..] => {
                let all = names[0].1.start..names[names.len() - 1].1.end;
                edits.push((0.0, TextEdit::new(0, all, first.clone())));
                for other in others {
                    let _ = writeln!(added, "{}curve {other}", indent(text, &block));
                }
            }
        }
    } else {
        let (stays, falls) = if first_stays { (0, 1) } else { (1, 0) };
        let kept = if first_stays {
            &names[..=between]
        } else {
            &names[between + 1..]
        };
        for (other, along) in skeleton.curves.iter().enumerate() {
            if other != curve && along.iter().all(|node| sides[falls][*node]) {
                gone.push(other);
            }
        }
        debug_assert!(!sides[stays][if first_stays { behind } else { before }]);
        let ends_there = near[stays] <= end.radius.max(grain);
        if ends_there && kept.len() < 2 {
            gone.push(curve);
        } else {
            let mut kept: Vec<String> = kept.iter().map(|(name, _)| name.clone()).collect();
            if !ends_there {
                let name = Names::of(&block).next();
                line(&mut added, &indent(text, &block), &name, end, grain);
                kept.insert(if first_stays { kept.len() } else { 0 }, name);
            }
            let all = names[0].1.start..names[names.len() - 1].1.end;
            edits.push((0.0, TextEdit::new(0, all, kept.join(" "))));
        }
    }
    // The curves that fall off keep their numbers while lines are added behind them.
    let added = added.replace('\n', end_of_line(text));
    edits.push((0.0, at_end(text, &block, added)));
    let changed = apply(text, edits);
    let end = (span.end + changed.len()).checked_sub(text.len())?;
    let span = span.start..end;
    let block = Block::read(&changed, span.clone())?;
    let along: Vec<&String> = names.iter().map(|(name, _)| name).collect();
    Some(without_curves(&changed, span, &block, &gone, &along))
}

/// The nodes that hang together with a node when the piece of a curve behind its node `between` is
/// not there.
fn side(skeleton: &Skeleton, curve: usize, between: usize, from: usize) -> Vec<bool> {
    let mut next: Vec<Vec<usize>> = vec![Vec::new(); skeleton.nodes.len()];
    for (number, along) in skeleton.curves.iter().enumerate() {
        for (i, ends) in along.windows(2).enumerate() {
            if (number, i) != (curve, between) {
                next[ends[0]].push(ends[1]);
                next[ends[1]].push(ends[0]);
            }
        }
    }
    let mut reached = vec![false; next.len()];
    reached[from] = true;
    let mut waiting = vec![from];
    while let Some(node) = waiting.pop() {
        for &other in &next[node] {
            if !std::mem::replace(&mut reached[other], true) {
                waiting.push(other);
            }
        }
    }
    reached
}

/// The length of the control polygons between some nodes.
fn length(skeleton: &Skeleton, nodes: &[bool]) -> f64 {
    let pieces = skeleton.curves.iter().flat_map(|along| along.windows(2));
    pieces
        .filter(|ends| nodes[ends[0]] && nodes[ends[1]])
        .map(|ends| {
            let [from, to] = [ends[0], ends[1]].map(|node| skeleton.nodes[node].position);
            from.distance(to)
        })
        .sum()
}

/// A text without some curves of a block, and without their nodes and others that no curve is left
/// for. Nodes that no curve went along before stay.
fn without_curves(
    text: &str,
    span: Range<usize>,
    block: &Block,
    gone: &[usize],
    others: &[&String],
) -> String {
    if (0..block.curves.len()).all(|index| gone.contains(&index)) {
        return without(text, &[span]);
    }
    let names = |curve: &usize| block.curves[*curve].names.iter().map(|(name, _)| name);
    let all: Vec<usize> = (0..block.curves.len()).collect();
    let kept = all.iter().filter(|index| !gone.contains(index));
    let used: Vec<&String> = kept.flat_map(names).collect();
    let mut dropped: Vec<&String> = gone.iter().flat_map(names).collect();
    dropped.extend(others);
    let nodes = block
        .nodes
        .iter()
        .filter(|node| dropped.contains(&&node.name) && !used.contains(&&node.name));
    let mut removed: Vec<Range<usize>> = nodes.map(|node| node.span.clone()).collect();
    removed.extend(gone.iter().map(|index| block.curves[*index].span.clone()));
    without(text, &removed)
}

/// Returns a text without some commands, each at its byte range. `None` if a range is not in the
/// text.
#[must_use]
pub fn without_commands(text: &str, spans: &[Range<usize>]) -> Option<String> {
    let are_inside = spans.iter().all(|span| text.get(span.clone()).is_some());
    are_inside.then(|| without(text, spans))
}

/// A word that does not stand in any of the texts: `stem`, or `stem` with a number.
#[must_use]
pub fn free_name<'a>(texts: impl IntoIterator<Item = &'a str>, stem: &str) -> String {
    let mut taken: Vec<String> = Vec::new();
    for text in texts {
        // A number or a sign behind the stem would only make a name longer.
        let words = text.split(|c: char| !(c.is_alphanumeric() || c == '_'));
        let like = words.filter(|word| {
            word.get(..stem.len())
                .is_some_and(|start| start.eq_ignore_ascii_case(stem))
        });
        taken.extend(like.map(str::to_ascii_lowercase));
    }
    let numbered = (2..).map(|i| format!("{stem}{i}"));
    std::iter::once(stem.to_owned())
        .chain(numbered)
        .find(|name| !taken.contains(&name.to_ascii_lowercase()))
        .unwrap_or_default()
}

/// The ends of a text's lines.
fn end_of_line(text: &str) -> &'static str {
    if text.contains("\r\n") { "\r\n" } else { "\n" }
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
    let [x, y, z] = node.position.to_array().map(|x| decimal(x, grain));
    let radius = decimal(node.radius, grain);
    let _ = writeln!(text, "{indent}node {name} <{x} {y} {z}> radius {radius}");
}

/// Writes a number without the digits that are below a tenth of the grain.
fn decimal(number: f64, grain: f64) -> String {
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

/// Returns the spaces before the block's lines.
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
fn at_end(text: &str, block: &Block, lines: String) -> TextEdit {
    let start = text[..block.close].rfind('\n').map_or(0, |end| end + 1);
    if text[start..block.close].trim().is_empty() {
        put(start, lines)
    } else if lines.is_empty() {
        put(block.close, lines)
    } else {
        let line = end_of_line(text);
        put(block.close, format!("{line}{lines}"))
    }
}

/// A text without some ranges: a line of which no more than a remark is left goes as a whole.
fn without(text: &str, ranges: &[Range<usize>]) -> String {
    let mut kept = String::new();
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let place = start..start + line.len();
        start = place.end;
        let is_touched = ranges
            .iter()
            .any(|range| range.start < place.end && place.start < range.end);
        if !is_touched {
            kept.push_str(line);
            continue;
        }
        let content = line.trim_end_matches(['\n', '\r']);
        let end = &line[content.len()..];
        let rest = content.char_indices().filter(|(at, _)| {
            let at = place.start + at;
            !ranges.iter().any(|range| range.contains(&at))
        });
        let rest: String = rest.map(|(_, c)| c).collect();
        let left = rest.trim_start();
        if !left.is_empty() && !left.starts_with('#') {
            kept.push_str(rest.trim_end());
            kept.push_str(end);
        }
    }
    kept
}

/// Returns the edit that inserts a text at a place of the only file, which has the number 0.
fn put(place: usize, text: String) -> TextEdit {
    TextEdit::new(0, place..place, text)
}

/// Applies edits to a text, each with its order among those at the same place.
fn apply(text: &str, mut edits: Vec<(f64, TextEdit)>) -> String {
    edits.sort_by(|(a, first), (b, second)| {
        let by_place = first.span.start.cmp(&second.span.start);
        by_place.then(a.total_cmp(b))
    });
    TextEdit::apply(text, edits.iter().map(|(_, edit)| edit))
}
