//! Refinement of cells until each proves that the linear interpolant has the topology of the
//! surface and is near it.
//!
//! Let L be the interpolant of F on the tetrahedra of the [lattice](crate::lattice). Where no point
//! with F = T lies in a tetrahedron, or else ⟨∇F(x), ∇L⟩ > 0 for all x of it, the level sets of
//! (1−s)F + sL are isotopic for all s from 0 to 1: none of the generalised gradients vanishes
//! (Agrachev, Pallaschke and Scholtes 1997, on piecewise smooth functions). That is Plantinga and
//! Vegter's condition, for tetrahedra. The gradient in a tetrahedron in a ball of radius R is the
//! linear interpolant of those at its corners up to D·R²/2, with D a bound on the third derivative;
//! or up to C·R, with C one on the second.

use crate::forest::{Bounds, Cell, Forest, NONE, Side};
use crate::lattice::Lattice;
use crate::options::{MeshError, Progress};
use crate::parallel::map_told;
use crate::space::{SLACK, Space};
use field::{Ball, Jet, Part, THRESHOLD, Variation};
use glam::DVec3;
use mesh::Aabb;

/// Cells are split until the gradient is so many times the error of its interpolant: then nearly
/// all tetrahedra pass.
const STEADY: f64 = 1.5;

/// The tetrahedra of a cell of size s are in balls with R² = 5/16·s²; linear interpolation is off
/// by R²/2 times the second derivative at most (Waldron 1998).
const INTERPOLATION: f64 = 5.0 / 32.0;

/// Values nearer to the threshold than this share of the tolerance times the slope are moved away
/// from it, so that no vertex of the mesh is at a vertex of the lattice.
pub const NUDGE: f64 = 0.1;

/// Cells are not divided below so many tolerances where the gradient jumps.
const KINKED: f64 = 4.0;

/// What was found in a cell.
struct Look {
    side: Side,
    bounds: Bounds,
    split: bool,
    part: Option<Part>,
}

/// Bounds in the ball around a box.
pub fn around(space: &Space<'_>, part: u32, center: DVec3, size: DVec3) -> Variation {
    let radius = 0.5 * size.length() * (1.0 + 1e-9);
    space.variation(part, Ball { center, radius })
}

/// The error of values in a box that a part of the function leaves.
pub fn error(space: &Space<'_>, part: u32, size: DVec3) -> f64 {
    let [value, slope] = space.error(part);
    SLACK + value + slope * 0.5 * size.length()
}

/// Bounds on the value in a box, by those in a ball around it alone and the values' error.
pub fn coarse_range(variation: &Variation, error: f64) -> [f64; 2] {
    let [low, high] = variation.range.value;
    [low - error, high + error]
}

/// Bounds on the value in a box, by those in a ball around it, the function in its middle, and the
/// values' error.
pub fn fine_range(variation: &Variation, jet: &Jet<f64>, size: DVec3, error: f64) -> [f64; 2] {
    let radius = 0.5 * size.length() * (1.0 + 1e-9);
    // A box is a part of the ball.
    let linear = (0.5 * DVec3::from_array(jet.gradient).abs() * size).element_sum();
    let bend = (0.5 * variation.curvature * radius + variation.jump) * radius;
    let change = linear + bend + variation.step + SLACK;
    let narrow = variation.range.about(jet, radius).value;
    [
        narrow[0].max(jet.value - change) - error,
        narrow[1].min(jet.value + change) + error,
    ]
}

/// The side of values within bounds.
pub fn side([low, high]: [f64; 2]) -> Side {
    if low > THRESHOLD {
        Side::Inside
    } else if high < THRESHOLD {
        Side::Outside
    } else {
        Side::Crossing
    }
}

/// Looks at a cell.
fn look(space: &Space<'_>, cell: &Cell, [tolerance, fine]: [f64; 2]) -> Look {
    let forest = &space.forest;
    let size = forest.size(cell.level);
    let center = forest.center(cell);
    let radius = 0.5 * size.length();
    let variation = around(space, cell.part, center, size);
    let Variation {
        curvature,
        third,
        rough,
        jump,
        step,
        ..
    } = variation;
    let error = error(space, cell.part, size);
    let sure = side(coarse_range(&variation, error));
    // Away from the surface the function itself does not matter, unless a jump could be as large as
    // its slope.
    let is_known = sure != Side::Crossing && jump == 0.0;
    let jet = (!is_known).then(|| space.jet(cell.part, center));
    let side = jet.map_or(sure, |jet| side(fine_range(&variation, &jet, size, error)));
    let steep = jet.map_or(f64::INFINITY, |jet| {
        DVec3::from_array(jet.gradient).length()
    });
    let longest = size.max_element();
    let square = INTERPOLATION * longest * longest;
    let reach = (2.0 * square).sqrt();
    let rest = (third * square + rough * reach).min(curvature * reach) + jump + SLACK / radius;
    let off = curvature * square + jump * reach + step + SLACK;
    let nudged = off + NUDGE * tolerance * steep;
    let mut bounds = Bounds {
        rest: if rest.is_nan() { f64::INFINITY } else { rest },
        off,
        error: f64::INFINITY,
        is_stuck: jump >= steep && longest <= KINKED * fine,
    };
    // Not so for NaN.
    let is_steady = steep > STEADY * rest;
    if is_steady {
        bounds.error = nudged / (steep - rest);
    }
    let wanted = side == Side::Crossing && !(is_steady && bounds.error <= tolerance);
    let split = wanted && cell.level < forest.usual && !bounds.is_stuck;
    Look {
        side,
        bounds,
        split,
        part: if split { space.narrow(cell) } else { None },
    }
}

/// A box around the surface in a box; `None` if there is no surface. On each side it is larger by
/// at most [`EXCESS`] of its longest side, but for surfaces that end at very many places there.
///
/// # Errors
/// If all of the box is inside, or if the caller cancels.
pub fn extent(
    function: &dyn field::Implicit,
    domain: &Aabb,
    threads: usize,
    progress: &mut Progress<'_>,
) -> Result<Option<Aabb>, MeshError> {
    let size = domain.max - domain.min;
    let forest = Forest::new(domain, size.max_element() * 2e-5, 0);
    let mut space = Space::new(function, forest, EXTENT);
    let mut open: Vec<u32> = (0..space.forest.cells.len() as u32).collect();
    let mut crossing: Vec<u32> = Vec::new();
    let mut is_inside = false;
    loop {
        progress.at(0.5)?;
        let cells: Vec<Cell> = open
            .iter()
            .map(|i| space.forest.cells[*i as usize])
            .collect();
        // No cell is good enough for a tolerance of 0.
        let looks = map_told(threads, &cells, progress, |cell| {
            look(&space, cell, [0.0; 2])
        })?;
        for (node, Look { side, part, .. }) in open.drain(..).zip(looks) {
            is_inside |= side == Side::Inside;
            if side != Side::Crossing {
                continue;
            }
            if let Some(part) = part {
                let part = space.add(part, space.forest.cells[node as usize].part);
                space.forest.cells[node as usize].part = part;
            }
            crossing.push(node);
        }
        if crossing.is_empty() {
            let nothing = if is_inside {
                Err(MeshError::AllInside)
            } else {
                Ok(None)
            };
            return nothing;
        }
        let bounds = |forest: &Forest, node: u32| {
            let cell = &forest.cells[node as usize];
            let (center, half) = (forest.center(cell), 0.5 * forest.size(cell.level));
            Aabb::of_points([center - half, center + half])
        };
        let boxes = crossing.iter().map(|node| bounds(&space.forest, *node));
        let hull = boxes.fold(Aabb::EMPTY, |all, one| all.union(&one));
        let longest = hull.size().max_element();
        if crossing.len() <= MANY_CELLS {
            // Cells that say where the box ends: what the others hold is within it.
            let is_coarse = |node: &u32| {
                let cell = &space.forest.cells[*node as usize];
                let size = space.forest.size(cell.level);
                if cell.level >= space.forest.usual {
                    return false;
                }
                let own = bounds(&space.forest, *node);
                let is_last =
                    own.min.cmple(hull.min + 0.25 * size) | own.max.cmpge(hull.max - 0.25 * size);
                let is_wide = size.cmpgt(DVec3::splat(EXCESS * longest));
                (is_last & is_wide).any()
            };
            open = crossing.extract_if(.., |node| is_coarse(node)).collect();
        }
        if open.is_empty() {
            return Ok(Some(hull));
        }
        let parents = core::mem::take(&mut open);
        for node in parents {
            // Without balance: nothing is interpolated here.
            let first = space.forest.divide(node);
            open.extend(first..first + 8);
        }
    }
}

/// How much larger than the surface its box may be on each side, as a part of its longest side.
pub const EXCESS: f64 = 1.0 / 128.0;

/// Accuracy of the extent, as a part of it.
const EXTENT: f64 = 1e-3;

/// Cells with which the search for the extent ends in any case.
const MANY_CELLS: usize = 100_000;

/// Cells that are being refined, with the values at the vertices of their lattice.
pub struct Refinement<'s, 'a> {
    /// The cells, and the function.
    pub space: &'s mut Space<'a>,
    /// The values.
    pub lattice: Lattice,
    /// The tolerance of the interpolant, and that of the final mesh.
    pub tolerances: [f64; 2],
    /// Most cells.
    pub max_cells: usize,
    /// Threads.
    pub threads: usize,
    /// Number of cells that were looked at.
    fresh: usize,
    /// For each cell that was judged since something changed beside it, those around it in which
    /// the interpolant changes its sign.
    verdicts: Vec<Option<Vec<u32>>>,
    /// Number of cells that there were then, and the errors of values and gradients.
    judged: (usize, [f64; 2]),
    fraction: f32,
}

impl<'s, 'a> Refinement<'s, 'a> {
    /// Cells of which nothing is known yet.
    pub fn new(
        space: &'s mut Space<'a>,
        tolerances: [f64; 2],
        max_cells: usize,
        threads: usize,
    ) -> Self {
        Self {
            space,
            lattice: Lattice::default(),
            tolerances,
            max_cells,
            threads,
            fresh: 0,
            verdicts: Vec::new(),
            judged: (0, [0.0; 2]),
            fraction: 0.0,
        }
    }

    /// Refines the cells, down to the usual level, until their interpolants have the topology of
    /// the surface and are within the tolerance. Cells that cannot be refined further are marked as
    /// undecided. Returns the leaves in which the interpolant changes its sign, in the order of
    /// their numbers.
    ///
    /// # Errors
    /// If there are too many cells, or if the caller cancels.
    pub fn settle(&mut self, progress: &mut Progress<'_>) -> Result<Vec<u32>, MeshError> {
        let threads = self.threads;
        loop {
            look_at_all(self, progress)?;
            let crossing = crossing(&self.space.forest);
            // Each becomes about ten triangles, which are there before they are made fewer.
            if crossing.len() > self.max_cells / 2 {
                return Err(too_many(self.space));
            }
            progress.at(self.fraction)?;
            self.forget();
            let new = |node: &u32| self.verdicts[*node as usize].is_none();
            let new: Vec<u32> = crossing.iter().copied().filter(new).collect();
            look_beside(self.space, &new, self.tolerances, threads, progress)?;
            let coarse = self.tolerances[0];
            self.lattice
                .extend(self.space, &new, true, coarse, threads, progress)?;
            let (space, lattice) = (&*self.space, &self.lattice);
            let verdicts = map_told(threads, &new, progress, |node| {
                verdict(space, lattice, *node, coarse)
            })?;
            let (mut failing, mut open, mut seen) = (Vec::new(), Vec::new(), Vec::new());
            for (node, verdict) in new.iter().zip(verdicts) {
                failing.extend_from_slice(&verdict.failing);
                open.extend_from_slice(&verdict.open);
                self.verdicts[*node as usize] = Some(verdict.seen);
            }
            for node in &crossing {
                seen.extend(self.verdicts[*node as usize].iter().flatten());
            }
            for all in [&mut failing, &mut open, &mut seen] {
                all.sort_unstable();
                all.dedup();
            }
            let mut is_done = true;
            for node in failing {
                let cell = self.space.forest.cells[node as usize];
                let is_last = cell.level >= self.space.forest.usual || cell.bounds.is_stuck;
                if !is_last && cell.child == NONE {
                    is_done = false;
                    self.split(node);
                }
            }
            for node in open {
                let cell = &mut self.space.forest.cells[node as usize];
                if cell.level >= self.space.forest.usual || cell.bounds.is_stuck {
                    cell.undecided |= !cell.is_empty;
                }
            }
            if is_done {
                return Ok(seen);
            }
        }
    }

    /// Forgets the verdicts on cells beside others that were split since they were judged.
    fn forget(&mut self) {
        let forest = &self.space.forest;
        let error = self.space.worst_error();
        let (before, old_error) = self.judged;
        if error != old_error {
            self.verdicts.clear();
        }
        self.verdicts.resize_with(forest.cells.len(), || None);
        let verdicts = &mut self.verdicts;
        let mut forget = |node: u32| verdicts[node as usize] = None;
        // The children of a cell come one after the other.
        for first in (before..forest.cells.len()).step_by(8) {
            let child = &forest.cells[first];
            let Some(level) = child.level.checked_sub(1) else {
                continue;
            };
            let at = child.at.map(|x| i64::from(x / 2));
            for i in 0..27 {
                let direction = [i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1];
                let place = [0, 1, 2].map(|k| at[k] + direction[k]);
                let mut open: Vec<u32> = forest.find(level, place).into_iter().collect();
                // Leaves beside the children are at most one level finer than these.
                while let Some(node) = open.pop() {
                    forget(node);
                    let cell = &forest.cells[node as usize];
                    if cell.child != NONE && cell.level < level + 2 {
                        open.extend(cell.child..cell.child + 8);
                    }
                }
            }
        }
        self.judged = (forest.cells.len(), error);
    }

    /// Splits a leaf, with the part of the function that its children need.
    pub fn split(&mut self, node: u32) {
        let cell = self.space.forest.cells[node as usize];
        if let Some(part) = self.space.narrow(&cell) {
            self.space.forest.cells[node as usize].part = self.space.add(part, cell.part);
        }
        self.space.forest.split(node);
    }
}

/// Looks at all leaves that are not known, and splits those that need it, until there are none.
fn look_at_all(
    refinement: &mut Refinement<'_, '_>,
    progress: &mut Progress<'_>,
) -> Result<(), MeshError> {
    let Refinement {
        space,
        tolerances,
        max_cells,
        threads,
        fresh,
        fraction,
        ..
    } = refinement;
    loop {
        let cells = &space.forest.cells;
        let is_open = |i: &u32| {
            let cell = &cells[*i as usize];
            cell.child == NONE && cell.side == Side::Unknown
        };
        let open: Vec<u32> = (*fresh as u32..cells.len() as u32)
            .filter(is_open)
            .collect();
        *fresh = cells.len();
        if open.is_empty() {
            return Ok(());
        }
        *fraction += 0.07 * (1.0 - *fraction);
        for batch in open.chunks(BATCH) {
            progress.at(*fraction)?;
            let leaves: Vec<Cell> = batch
                .iter()
                .map(|i| space.forest.cells[*i as usize])
                .collect();
            let looks = map_told(*threads, &leaves, progress, |cell| {
                look(space, cell, *tolerances)
            })?;
            for (node, look) in batch.iter().zip(looks) {
                let cell = &mut space.forest.cells[*node as usize];
                cell.side = look.side;
                cell.bounds = look.bounds;
                cell.has_bounds = true;
                let part = cell.part;
                if let Some(new) = look.part {
                    let part = space.add(new, part);
                    space.forest.cells[*node as usize].part = part;
                }
                if look.split {
                    space.forest.split(*node);
                }
            }
            if space.forest.cells.len() > *max_cells {
                return Err(too_many(space));
            }
        }
    }
}

/// Cells that are looked at between two reports.
const BATCH: usize = 20_000;

/// Cells of a flat region that are looked at to tell it.
const MOST_LOOKED_AT: usize = 1000;
/// Change of the function over such a cell together with its distance from the threshold, in
/// thresholds.
const FLAT: f64 = 0.02;

/// Why there are too many cells.
fn too_many(space: &Space<'_>) -> MeshError {
    let is_rough = |cell: &&Cell| {
        cell.child == NONE && cell.side == Side::Crossing && !cell.bounds.error.is_finite()
    };
    let rough: Vec<&Cell> = space.forest.cells.iter().filter(is_rough).collect();
    let step = rough.len().div_ceil(MOST_LOOKED_AT).max(1);
    let some: Vec<&Cell> = rough.into_iter().step_by(step).collect();
    let is_flat = |cell: &&&Cell| {
        let jet = space.jet(cell.part, space.forest.center(cell));
        let size = space.forest.size(cell.level).max_element();
        let change = DVec3::from_array(jet.gradient).length() * size;
        (jet.value - THRESHOLD).abs() + change < FLAT * THRESHOLD
    };
    let flat: Vec<&&Cell> = some.iter().filter(is_flat).collect();
    match flat.get(flat.len() / 2) {
        Some(cell) if 2 * flat.len() > some.len() => MeshError::Flat {
            near: space.forest.center(cell).to_array(),
        },
        _ => MeshError::TooMany {
            limit: 0,
            fitting: fitting(&space.forest),
        },
    }
}

/// A tolerance for which the present cells would be fine enough, where their topology is sure.
fn fitting(forest: &Forest) -> Option<f64> {
    let crossing = forest
        .cells
        .iter()
        .filter(|c| c.side == Side::Crossing && c.has_bounds);
    let mut errors: Vec<f64> = crossing
        .map(|cell| cell.bounds.error)
        .filter(|error| error.is_finite())
        .collect();
    errors.sort_unstable_by(f64::total_cmp);
    // Most of the cells were divided already.
    errors.get(errors.len() * 9 / 10).copied()
}

/// Computes bounds for leaves without the surface that share a face with some that have it.
fn look_beside(
    space: &mut Space<'_>,
    crossing: &[u32],
    tolerances: [f64; 2],
    threads: usize,
    progress: &mut Progress<'_>,
) -> Result<(), MeshError> {
    let forest = &space.forest;
    let mut open = Vec::new();
    for node in crossing {
        let cell = forest.cells[*node as usize];
        for side in 0..6 {
            let neighbor = forest.neighbor(&cell, crate::lattice::direction(side));
            open.extend(neighbor.into_iter().filter(|i| {
                let cell = &forest.cells[*i as usize];
                cell.child == NONE && !cell.has_bounds
            }));
            // The children of a divided neighbour that touch the face.
            if let Some(divided) = neighbor.filter(|i| forest.cells[*i as usize].child != NONE) {
                let first = forest.cells[divided as usize].child;
                open.extend((first..first + 8).filter(|i| {
                    let cell = &forest.cells[*i as usize];
                    cell.child == NONE && !cell.has_bounds
                }));
            }
        }
    }
    open.sort_unstable();
    open.dedup();
    let cells: Vec<Cell> = open.iter().map(|i| forest.cells[*i as usize]).collect();
    let looks = map_told(threads, &cells, progress, |cell| {
        look(space, cell, tolerances)
    })?;
    for (node, look) in open.into_iter().zip(looks) {
        let cell = &mut space.forest.cells[node as usize];
        cell.bounds = look.bounds;
        cell.has_bounds = true;
    }
    Ok(())
}

/// The leaves that the surface may cross.
pub fn crossing(forest: &Forest) -> Vec<u32> {
    let is_crossing = |i: &u32| {
        let cell = &forest.cells[*i as usize];
        cell.child == NONE && cell.side == Side::Crossing
    };
    (0..forest.cells.len() as u32).filter(is_crossing).collect()
}

/// The cells around a cell that its tetrahedra tell something about.
struct Verdict {
    /// The cells in which one does not prove the topology, and which are to blame.
    failing: Vec<u32>,
    /// The cells in which one does not prove the topology.
    open: Vec<u32>,
    /// Those in which the interpolant changes its sign.
    seen: Vec<u32>,
}

fn verdict(space: &Space<'_>, lattice: &Lattice, node: u32, tolerance: f64) -> Verdict {
    let cells = &space.forest.cells;
    let [error, steep_error] = space.worst_error();
    let (mut failing, mut open, mut seen) = (Vec::new(), Vec::new(), Vec::new());
    crate::lattice::tetrahedra(&space.forest, node, &mut |keys, owners| {
        let vertices = keys.map(|key| lattice.index(key));
        let values = vertices.map(|i| lattice.value(i));
        let is_inside = values.map(|v| v > 0.0);
        if is_inside.contains(&true) && is_inside.contains(&false) {
            for owner in owners {
                if !seen.contains(&owner) {
                    seen.push(owner);
                }
            }
        }
        let bounds = owners.map(|owner| cells[owner as usize].bounds);
        let off = bounds[0].off.max(bounds[1].off);
        let gradients = vertices.map(|i| lattice.gradient(i));
        let steepest = gradients.iter().map(|g| g.length()).fold(0.0, f64::max);
        let off = off + error + 2.0 * NUDGE * tolerance * steepest;
        // Neither the function nor its interpolant is 0 in it.
        if values.iter().all(|v| *v > off) || values.iter().all(|v| *v < -off) {
            return;
        }
        let corners = keys.map(|key| space.forest.position(crate::lattice::unpack(key)));
        let slope = gradient(&corners, &values);
        let rises = gradients.map(|gradient| gradient.dot(slope));
        let least = rises.into_iter().fold(f64::INFINITY, f64::min);
        let rest = bounds[0].rest.max(bounds[1].rest) + steep_error;
        // Not so for NaN.
        let proves = least > rest * slope.length();
        if !proves {
            for (owner, own) in owners.into_iter().zip(bounds) {
                if !open.contains(&owner) {
                    open.push(owner);
                }
                // The other one alone may be to blame.
                if own.rest >= 0.5 * (rest - steep_error) && !failing.contains(&owner) {
                    failing.push(owner);
                }
            }
        }
    });
    Verdict {
        failing,
        open,
        seen,
    }
}

/// Gradient of the linear function with these values at the corners of a tetrahedron.
fn gradient(corners: &[DVec3; 4], values: &[f64; 4]) -> DVec3 {
    let [a, b, c] = [1, 2, 3].map(|i| corners[i] - corners[0]);
    let [u, v, w] = [1, 2, 3].map(|i| values[i] - values[0]);
    (u * b.cross(c) + v * c.cross(a) + w * a.cross(b)) / a.dot(b.cross(c))
}
