//! Molecules: XYZ files with a count and element symbols, and PDB files. Atoms are balls of their
//! van der Waals radius, in ångströms.

use super::elements::{ELEMENTS, Element};
use super::{Reading, place};
use crate::draft::Draft;
use crate::error::{Error, fail, fail_at, shorten};
use crate::graph::{Cap, Graph, Limb};
use crate::limits::{MAX_LISTED, MAX_NODES};
use glam::DVec3;
use mesh::formats::text;
use mesh::{Aabb, Bvh};
use std::collections::HashMap;
use std::ops::ControlFlow;

/// Millimetres of an ångström.
const MILLIMETRES: f64 = 1e-7;
/// Slack of a bond's length over the sum of its atoms' covalent radii, ångström: Open Babel's.
const SLACK: f64 = 0.45;
/// Least length of a bond, ångström: nearer atoms are alternatives of one another.
const LEAST_BOND: f64 = 0.4;
/// Radius of the limbs that stand for bonds, ångström.
const BOND_RADIUS: f64 = 0.2;

/// Reads an XYZ file; `None` if it holds measured points instead of a molecule.
pub(super) fn read_xyz(bytes: &[u8], reading: &Reading<'_>) -> Result<Option<Graph>, Error> {
    let text = text::decode(bytes);
    let mut lines = (1..).zip(text.lines());
    let count = lines
        .next()
        .and_then(|(_, line)| line.trim().parse::<usize>().ok());
    let first = text
        .lines()
        .nth(2)
        .and_then(|line| line.split_ascii_whitespace().next());
    let (Some(count), Some(_)) = (count, first.and_then(element)) else {
        return Ok(None);
    };
    let mut molecule = Molecule::default();
    for (line, content) in lines.skip(1).take(count) {
        let mut words = content.split_ascii_whitespace();
        let symbol = words.next().unwrap_or_default();
        let Some(place) = place(&mut words) else {
            return fail_at(line, "an atom is its element's symbol and three numbers");
        };
        molecule.atom(line, symbol, place)?;
    }
    let found = molecule.atoms.len();
    if found < count {
        return fail(format!(
            "line 1: this file says that it has {count} atoms and has {found}: it is cut off"
        ));
    }
    let mut lines = text.lines().skip(count + 2).map(str::trim);
    if lines.any(|line| !line.is_empty()) {
        let text = "the frames behind the first one are left out";
        molecule.draft.remark(Some(count + 3), text);
    }
    molecule.finish(reading).map(Some)
}

/// Reads a PDB file: the atoms of its first model, and of alternative places the first.
pub(super) fn read_pdb(bytes: &[u8], reading: &Reading<'_>) -> Result<Graph, Error> {
    let text = text::decode(bytes);
    let mut molecule = Molecule::default();
    let mut serials: HashMap<i64, u32> = HashMap::new();
    let mut joined: Vec<[i64; 2]> = Vec::new();
    let (mut is_over, mut alternatives) = (false, 0);
    for (line, content) in (1..).zip(text.lines()) {
        match field(content, 1, 6).trim_end() {
            "ATOM" | "HETATM" if !is_over => {
                if !matches!(field(content, 17, 17), " " | "" | "A" | "1") {
                    alternatives += 1;
                    continue;
                }
                let [x, y, z] =
                    [(31, 38, "x"), (39, 46, "y"), (47, 54, "z")].map(|(a, b, name)| {
                        let word = field(content, a, b).trim();
                        match word.parse::<f64>() {
                            Ok(number) => Ok(number),
                            Err(_) => fail_at(
                                line,
                                format!(
                                    "columns {a} to {b}: `{name}` is `{}`, which is no number",
                                    shorten(word)
                                ),
                            ),
                        }
                    });
                let symbol = match field(content, 77, 78).trim() {
                    "" => symbol_of(field(content, 13, 16)),
                    symbol => symbol.into(),
                };
                let atom = molecule.atom(line, &symbol, DVec3::new(x?, y?, z?))?;
                if let Ok(serial) = field(content, 7, 11).trim().parse() {
                    serials.entry(serial).or_insert(atom);
                }
            }
            "ENDMDL" => is_over = true,
            "CONECT" => {
                let serials = [(7, 11), (12, 16), (17, 21), (22, 26), (27, 31)];
                let mut serials = serials
                    .into_iter()
                    .map_while(|(a, b)| field(content, a, b).trim().parse().ok());
                if let Some(first) = serials.next() {
                    joined.extend(serials.map(|other| [first, other]));
                }
            }
            _ => {}
        }
    }
    if molecule.atoms.is_empty() {
        return fail("this PDB file has no lines `ATOM` or `HETATM`");
    }
    molecule
        .draft
        .remark_count(alternatives, "atoms at alternative places are left out");
    for pair in joined {
        if let [Some(a), Some(b)] = pair.map(|serial| serials.get(&serial)) {
            molecule.bonds.push([*a, *b]);
        }
    }
    molecule.finish(reading)
}

/// Returns some columns of a line, counted from 1.
fn field(line: &str, start: usize, end: usize) -> &str {
    line.get(start - 1..end.min(line.len())).unwrap_or_default()
}

/// Atoms so far.
struct Molecule {
    draft: Draft,
    atoms: Vec<&'static Element>,
    bonds: Vec<[u32; 2]>,
    unknown: usize,
}

impl Default for Molecule {
    fn default() -> Self {
        Self {
            draft: Draft::new(Some(MILLIMETRES)),
            atoms: Vec::new(),
            bonds: Vec::new(),
            unknown: 0,
        }
    }
}

impl Molecule {
    /// Adds an atom, and returns its index.
    fn atom(&mut self, line: usize, symbol: &str, position: DVec3) -> Result<u32, Error> {
        let Some(element) = element(symbol) else {
            let symbol = shorten(symbol);
            return fail_at(line, format!("`{symbol}` is no symbol of an element"));
        };
        if self.atoms.len() == MAX_NODES {
            return fail_at(line, format!("more than {MAX_NODES} atoms"));
        }
        let [r, g, b] = element.color.to_be_bytes()[1..] else {
            unreachable!("a colour has four bytes")
        };
        let color = [r, g, b].map(mesh::linear_from_srgb);
        let group = self.draft.group(element.symbol, Some(color))?;
        self.unknown += usize::from(element.radius.is_none());
        let radius = element.radius.unwrap_or(OTHER_RADIUS);
        let node = self.draft.node(position, radius, group);
        let node = node.or_else(|Error(text)| fail_at(line, text))?;
        self.draft.ball(node);
        self.atoms.push(element);
        Ok(node)
    }

    /// Returns the graph, with bonds if they are asked for.
    fn finish(mut self, reading: &Reading<'_>) -> Result<Graph, Error> {
        let text =
            format!("atoms are of elements without a known radius: {OTHER_RADIUS} Å is used");
        self.draft.remark_count(self.unknown, &text);
        if reading.bonds {
            let mut bonds = self.near();
            bonds.append(&mut self.bonds);
            for pair in &mut bonds {
                pair.sort_unstable();
            }
            bonds.sort_unstable();
            bonds.dedup();
            let group = self.draft.group("bond", None)?;
            for ends in bonds {
                self.draft.add(Limb {
                    ends,
                    radii: [BOND_RADIUS; 2],
                    group,
                    caps: [Cap::Round; 2],
                    clip: None,
                })?;
            }
        }
        self.draft.weld();
        self.draft.finish(reading.radius)
    }

    /// Lists the pairs of atoms that are near enough for a bond.
    fn near(&self) -> Vec<[u32; 2]> {
        let boxes: Vec<Aabb> = (0..)
            .zip(&self.atoms)
            .map(|(i, atom)| {
                let place = self.draft.position(i);
                let reach = DVec3::splat(atom.covalent + SLACK / 2.0);
                Aabb::of_points([place - reach, place + reach])
            })
            .collect();
        let mut pairs = Vec::new();
        Bvh::new(&boxes).pairs(|a, b| {
            let length = self.draft.position(a).distance(self.draft.position(b));
            let sum: f64 = [a, b].map(|i| self.atoms[i as usize].covalent).iter().sum();
            if (LEAST_BOND..=sum + SLACK).contains(&length) {
                pairs.push([a, b]);
            }
            match pairs.len() > MAX_LISTED / 2 {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            }
        });
        pairs
    }
}

/// Radius of atoms whose element has none in the table, ångström.
const OTHER_RADIUS: f64 = 2.0;

/// Finds an element by its symbol, in any case, by its number, or by a label that begins with its
/// symbol: `C12`, `H_a`.
fn element(symbol: &str) -> Option<&'static Element> {
    let letters = symbol.find(|c: char| !c.is_ascii_alphabetic());
    let symbol = match letters {
        Some(end) if end > 0 => &symbol[..end],
        _ => symbol,
    };
    if let Ok(number) = symbol.parse::<usize>() {
        return ELEMENTS.get(number.checked_sub(1)?);
    }
    if symbol.eq_ignore_ascii_case("D") {
        return ELEMENTS.first();
    }
    ELEMENTS
        .iter()
        .find(|element| element.symbol.eq_ignore_ascii_case(symbol))
}

/// Returns the symbol in the name of a PDB file's atom, which ends in the second of its four
/// columns; but hydrogen's name of four characters begins with it.
fn symbol_of(name: &str) -> String {
    let start: String = name
        .chars()
        .take(2)
        .filter(char::is_ascii_alphabetic)
        .collect();
    let is_hydrogen = name.trim().len() == 4 && name.starts_with('H');
    match element(&start) {
        Some(_) if !is_hydrogen => start,
        _ => name
            .chars()
            .find(char::is_ascii_alphabetic)
            .into_iter()
            .collect(),
    }
}
