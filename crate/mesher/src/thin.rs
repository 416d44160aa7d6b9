//! Finer cells where those of the usual size leave the surface open, so that parts thinner than the
//! tolerance are not lost.
//!
//! After refinement the surface can only hide in undecided cells: all others prove that they hold
//! none, or that the interpolant has its topology. Undecided cells are *thin* if the interpolant
//! has one sign in them. Of most of those a search by bounds proves that there is no surface in
//! them. Where it finds some, all undecided cells are split to a small fraction of the tolerance,
//! until they prove the topology, as long as there are not too many. Thin cells that still hide the
//! surface get the other sign at their centre, so that the mesh has a part there which is a cell
//! wide, and no point of the surface is farther from it than about a cell.

use crate::forest::{Cell, Forest, NONE, Side};
use crate::lattice::{Lattice, direction, pack};
use crate::options::{MeshError, Progress};
use crate::parallel::{LARGE, map_by};
use crate::refine::{Refinement, around, coarse_range, error, fine_range};
use crate::space::Space;
use field::THRESHOLD;
use glam::DVec3;
use std::collections::{BTreeMap, BTreeSet};

/// Undecided cells are split down to so many tolerances, even where the interpolant changes its
/// sign.
const SEEN: f64 = 2.0;
/// Thin ones and those beside cells in which the surface hid are.
const THIN: f64 = 0.5;
/// Levels below the usual one that cells are split to where the surface hid.
pub const LEVELS: u32 = 4;
/// Most cells that are split in one pass.
const MOST: usize = 16_000;
/// Most of those that hide the surface, if no others are.
const MOST_HIDING: usize = 60_000;
/// Most cells that are searched in one pass.
const MOST_SEARCHED: usize = 60_000;
/// Cells that the split of one may make: with neighbours that would differ by two levels.
const MADE: usize = 24;
/// Largest cells, in tolerances, that get another sign at their centre.
const FORCED: f64 = 1.0;

/// Splits undecided cells, and gives another sign to those that would hide a part of the surface.
/// `seen` are the leaves in which the interpolant changes its sign.
///
/// # Errors
/// If there are too many cells, or if the caller cancels.
pub fn deepen(
    refinement: &mut Refinement<'_, '_>,
    mut seen: Vec<u32>,
    progress: &mut Progress<'_>,
) -> Result<(), MeshError> {
    // Cells in which the surface hid, and what they were split into.
    let mut known = BTreeSet::new();
    let mut searched = Searched::default();
    // Each pass makes all cells of a level one finer.
    for pass in 0..=LEVELS {
        progress.at(pass as f32 / (LEVELS + 1) as f32)?;
        let open = undecided(refinement.space, &seen);
        let thin = open.iter().filter(|(_, is_thin)| *is_thin);
        let thin: Vec<u32> = thin.map(|(node, _)| *node).collect();
        let hiding = searched.hiding(refinement, &thin, progress)?;
        known.extend(hiding.iter().copied());
        let is_open =
            |(node, _): &(u32, bool)| refinement.space.forest.cells[*node as usize].undecided;
        let open: Vec<(u32, bool)> = open.into_iter().filter(is_open).collect();
        let chosen = chosen(refinement, &open, &hiding, &known);
        if chosen.is_empty() {
            break;
        }
        for node in chosen {
            if refinement.space.forest.cells[node as usize].child == NONE {
                refinement.split(node);
            }
        }
        seen = refinement.settle(progress)?;
        inherit(&refinement.space.forest, &mut known);
    }
    let open = undecided(refinement.space, &seen).into_iter();
    let thin: Vec<u32> = open
        .filter(|(_, is_thin)| *is_thin)
        .map(|(node, _)| node)
        .collect();
    let largest = FORCED * refinement.tolerances[1];
    for node in searched.hiding(refinement, &thin, progress)? {
        let forest = &refinement.space.forest;
        let cell = &forest.cells[node as usize];
        if forest.size(cell.level).max_element() <= largest {
            refinement.lattice.force(pack(forest.center_key(cell)));
        }
    }
    Ok(())
}

/// Adds the children of cells that were split.
fn inherit(forest: &Forest, known: &mut BTreeSet<u32>) {
    let mut open: Vec<u32> = known.iter().copied().collect();
    while let Some(node) = open.pop() {
        let first = forest.cells[node as usize].child;
        if first != NONE {
            for child in first..first + 8 {
                if known.insert(child) {
                    open.push(child);
                }
            }
        }
    }
}

/// The undecided leaves, in the order of their numbers, and for each whether it is thin.
fn undecided(space: &Space<'_>, seen: &[u32]) -> Vec<(u32, bool)> {
    let leaves = (0..).zip(&space.forest.cells);
    let open = leaves
        .filter(|(_, cell)| cell.child == NONE && cell.undecided && cell.side == Side::Crossing);
    open.map(|(node, _)| (node, seen.binary_search(&node).is_err()))
        .collect()
}

/// The cells to be split, of open ones and those of them that hide the surface: if these are too
/// many, the hiding ones and those beside them, or only the former, or none.
fn chosen(
    refinement: &Refinement<'_, '_>,
    open: &[(u32, bool)],
    hiding: &[u32],
    known: &BTreeSet<u32>,
) -> Vec<u32> {
    let forest = &refinement.space.forest;
    let tolerance = refinement.tolerances[1];
    let is_beside = |cell: &Cell| {
        (0..6).any(|side| {
            let neighbor = forest.neighbor(cell, direction(side));
            neighbor.is_some_and(|i| match forest.cells[i as usize].child {
                NONE => known.contains(&i),
                first => (first..first + 8).any(|i| known.contains(&i)),
            })
        })
    };
    let (mut all, mut some, mut few) = (Vec::new(), Vec::new(), Vec::new());
    for (node, is_thin) in open {
        let cell = &forest.cells[*node as usize];
        if cell.level == forest.deepest {
            continue;
        }
        let size = forest.size(cell.level).max_element() / tolerance;
        let is_large = size > THIN;
        let is_hiding = hiding.binary_search(node).is_ok();
        let is_near = is_hiding
            || (!is_thin && known.contains(node))
            || (is_large && !is_thin && is_beside(cell));
        if is_hiding {
            few.push(*node);
        }
        if is_near {
            some.push(*node);
        }
        if is_near || size > SEEN || (is_large && *is_thin) {
            all.push(*node);
        }
    }
    let room = refinement.max_cells.saturating_sub(forest.cells.len()) / MADE;
    let choices = [(all, MOST), (some, MOST), (few, MOST_HIDING)];
    let fit = choices
        .into_iter()
        .find(|(cells, most)| cells.len() <= room.min(*most));
    fit.map_or_else(Vec::new, |(cells, _)| cells)
}

/// Results of searches for the other side of the surface in thin cells, by their numbers: values at
/// the vertices of the lattice stay what they are, so that another search in the same cell would
/// find the same.
#[derive(Default)]
struct Searched {
    found: BTreeMap<u32, Found>,
}

impl Searched {
    /// Those of some thin cells in which a search finds a point on the other side of the surface.
    /// Where it proves that there is none, the cell is no longer undecided.
    fn hiding(
        &mut self,
        refinement: &mut Refinement<'_, '_>,
        thin: &[u32],
        progress: &mut Progress<'_>,
    ) -> Result<Vec<u32>, MeshError> {
        let (space, lattice) = (&*refinement.space, &refinement.lattice);
        let thin = &thin[..thin.len().min(MOST_SEARCHED)];
        let new: Vec<u32> = thin
            .iter()
            .copied()
            .filter(|node| !self.found.contains_key(node))
            .collect();
        let found = map_by(LARGE, refinement.threads, &new, progress, |node| {
            search(space, lattice, &space.forest.cells[*node as usize])
        })?;
        self.found.extend(new.into_iter().zip(found));
        let mut hiding = Vec::new();
        for node in thin {
            let cell = &mut refinement.space.forest.cells[*node as usize];
            match self.found[node] {
                Found::Other => hiding.push(*node),
                Found::None => (cell.is_empty, cell.undecided) = (true, false),
                Found::Unknown => {}
            }
        }
        Ok(hiding)
    }
}

/// The result of a search for the other side of the surface in a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Found {
    /// A point there.
    Other,
    /// A proof that there is none.
    None,
    /// Neither.
    Unknown,
}

/// Steps of a search along gradients.
const STEPS: usize = 8;
/// Most boxes of a search by bounds.
const BOXES: usize = 64;
/// Halvings of a cell after which its boxes are not divided.
const HALVINGS: u32 = 5;

/// Searches a thin cell for a point on the other side of the surface than its centre is: along the
/// gradient, then in the boxes that promise most by the bounds in them.
fn search(space: &Space<'_>, lattice: &Lattice, cell: &Cell) -> Found {
    let forest = &space.forest;
    let center = forest.center(cell);
    let size = forest.size(cell.level);
    let is_inside = lattice.value(lattice.index(pack(forest.center_key(cell)))) > 0.0;
    if climbs(space, cell, center, 0.5 * size, is_inside) {
        return Found::Other;
    }
    // How far values on the other side may be from the threshold.
    let promise = |[low, high]: [f64; 2]| {
        if is_inside {
            THRESHOLD - low
        } else {
            high - THRESHOLD
        }
    };
    // The most promising first, and of equal ones the first.
    let mut open = vec![(f64::INFINITY, center, 0)];
    let mut is_proof = true;
    for _ in 0..BOXES {
        let best = (0..open.len()).max_by(|i, j| open[*i].0.total_cmp(&open[*j].0).then(j.cmp(i)));
        let Some(best) = best else {
            return if is_proof {
                Found::None
            } else {
                Found::Unknown
            };
        };
        let (_, middle, depth) = open.swap_remove(best);
        let own = size / f64::from(1_u32 << depth);
        let variation = around(space, cell.part, middle, own);
        let error = error(space, cell.part, own);
        if promise(coarse_range(&variation, error)) < 0.0 {
            continue;
        }
        let jet = space.jet(cell.part, middle);
        if (jet.value > THRESHOLD) != is_inside {
            return Found::Other;
        }
        let promise = promise(fine_range(&variation, &jet, own, error));
        if promise < 0.0 {
            continue;
        }
        // Not so for NaN.
        let is_open = promise >= 0.0 && depth < HALVINGS;
        if !is_open {
            is_proof = false;
            continue;
        }
        open.extend((0..8).map(|i| {
            let side = [0, 1, 2].map(|k| if i >> k & 1 == 1 { 0.25 } else { -0.25 });
            (promise, middle + own * DVec3::from_array(side), depth + 1)
        }));
    }
    Found::Unknown
}

/// Whether a few steps along gradients from the centre of a cell lead to the other side within it.
fn climbs(space: &Space<'_>, cell: &Cell, center: DVec3, half: DVec3, is_inside: bool) -> bool {
    let mut point = center;
    for _ in 0..STEPS {
        let jet = space.jet(cell.part, point);
        let value = jet.value - THRESHOLD;
        if (value > 0.0) != is_inside {
            return true;
        }
        let gradient = DVec3::from_array(jet.gradient);
        // A little beyond the place where the tangent is at the threshold.
        let step = gradient * (-1.25 * value / gradient.length_squared());
        let step = step.clamp_length_max(0.5 * half.min_element());
        let next = (point + step).clamp(center - half, center + half);
        // Not so for NaN.
        let moves = next.distance(point) > 1e-3 * half.min_element();
        if !moves {
            return false;
        }
        point = next;
    }
    false
}
