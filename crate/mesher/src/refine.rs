//! Refinement of cells until each proves that the linear interpolant has the topology of the surface and is near it.
//!
//! Let L be the interpolant of F on the tetrahedra of the [lattice](crate::lattice). Where no point with F = T lies in a
//! tetrahedron, or else ⟨∇F(x), ∇L⟩ > 0 for all x of it, the level sets of (1−s)F + sL are isotopic for all s from 0 to 1: none
//! of the generalised gradients vanishes (Agrachev, Pallaschke and Scholtes 1997, on piecewise smooth functions). That is Plantinga
//! and Vegter's condition, for tetrahedra. The gradient in a tetrahedron in a ball of radius R is the linear interpolant of
//! those at its corners up to D·R²/2, with D a bound on the third derivative; or up to C·R, with C one on the second.

use crate::forest::{Bounds, Cell, Forest, NONE, Side};
use crate::lattice::Lattice;
use crate::options::{MeshError, Progress};
use crate::parallel::map_told;
use crate::space::{SLACK, Space};
use field::{Ball, Part, THRESHOLD, Variation};
use glam::DVec3;
use mesh::Aabb;

/// Cells are split until the gradient is so many times the error of its interpolant: then nearly all tetrahedra pass.
const STEADY: f64 = 1.5;

/// The tetrahedra of a cell of size s are in balls with R² = 5/16·s²; linear interpolation is off by R²/2 times the second
/// derivative at most (Waldron 1998).
const INTERPOLATION: f64 = 5.0 / 32.0;

/// Values nearer to the threshold than this share of the tolerance times the slope are moved away from it, so that no vertex
/// of the mesh is at a vertex of the lattice.
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

/// Looks at a cell, with so much room around it that a path of the length of the finer tolerance does not leave the ball.
fn look(space: &Space<'_>, cell: &Cell, [tolerance, fine]: [f64; 2]) -> Look {
    let forest = &space.forest;
    let size = forest.size(cell.level);
    let center = forest.center(cell);
    let radius = 0.5 * size.length() * (1.0 + 1e-9);
    let around = radius + fine.min(radius);
    let ball = Ball {
        center,
        radius: around,
    };
    let Variation {
        range,
        curvature,
        third,
        rough,
        jump,
        step,
    } = space.variation(cell.part, ball);
    let jet = space.jet(cell.part, center);
    let [error, steep_error] = space.error(cell.part);
    let gradient = DVec3::from_array(jet.gradient);
    // The cell is a box: a part of the ball.
    let linear = (0.5 * gradient.abs() * size).element_sum();
    let change = linear + (0.5 * curvature * radius + jump) * radius + step + SLACK;
    let narrow = range.about(&jet, radius).value;
    let low = narrow[0].max(jet.value - change);
    let high = narrow[1].min(jet.value + change);
    let unsure = SLACK + error + steep_error * radius;
    let side = if low - unsure > THRESHOLD {
        Side::Inside
    } else if high + unsure < THRESHOLD {
        Side::Outside
    } else {
        Side::Crossing
    };
    let longest = size.max_element();
    let square = INTERPOLATION * longest * longest;
    let reach = (2.0 * square).sqrt();
    let rest = (third * square + rough * reach).min(curvature * reach) + jump + SLACK / radius;
    let off = curvature * square + jump * reach + step + SLACK;
    let steep = gradient.length();
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
    let split = wanted && cell.level < forest.deepest && !bounds.is_stuck;
    Look {
        side,
        bounds,
        split,
        part: if split { space.narrow(cell) } else { None },
    }
}

/// A box around the surface in a box, at most an eighth too large on each side; `None` if there is no surface.
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
    let forest = Forest::new(domain, size.max_element() * 2e-5);
    let mut space = Space::new(function, forest, EXTENT);
    let mut open: Vec<u32> = (0..space.forest.cells.len() as u32).collect();
    let mut is_inside = false;
    while !open.is_empty() {
        progress.at(0.5)?;
        let cells: Vec<Cell> = open
            .iter()
            .map(|i| space.forest.cells[*i as usize])
            .collect();
        // No cell is good enough for a tolerance of 0.
        let looks = map_told(threads, &cells, progress, |cell| {
            look(&space, cell, [0.0; 2])
        })?;
        let mut hull = Aabb::EMPTY;
        let mut crossing = Vec::new();
        for (node, Look { side, part, .. }) in open.iter().zip(looks) {
            let cell = space.forest.cells[*node as usize];
            is_inside |= side == Side::Inside;
            if side != Side::Crossing {
                continue;
            }
            if let Some(part) = part {
                let part = space.add(part, cell.part);
                space.forest.cells[*node as usize].part = part;
            }
            let (center, half) = (
                space.forest.center(&cell),
                0.5 * space.forest.size(cell.level),
            );
            hull = hull.union(&Aabb::of_points([center - half, center + half]));
            crossing.push(*node);
        }
        let Some(first) = crossing.first() else {
            break;
        };
        let level = space.forest.cells[*first as usize].level;
        let size = space.forest.size(level).max_element();
        let is_fine = size * 16.0 <= (hull.max - hull.min).max_element();
        if is_fine || level == space.forest.deepest || crossing.len() > MANY_CELLS {
            return Ok(Some(hull));
        }
        open.clear();
        for node in crossing {
            // Without balance: nothing is interpolated here.
            let first = space.forest.divide(node);
            open.extend(first..first + 8);
        }
    }
    if is_inside {
        Err(MeshError::AllInside)
    } else {
        Ok(None)
    }
}

/// Accuracy of the extent, as a part of it.
const EXTENT: f64 = 1e-3;

/// Cells with which the search for the extent ends in any case.
const MANY_CELLS: usize = 100_000;

/// Refines the cells until their interpolants are within the first tolerance, the second being that of the final mesh, and
/// returns the lattice with values at its vertices.
///
/// # Errors
/// If there are too many cells, or if the caller cancels.
pub fn refine(
    space: &mut Space<'_>,
    tolerances: [f64; 2],
    max_cells: usize,
    threads: usize,
    progress: &mut Progress<'_>,
) -> Result<Lattice, MeshError> {
    let mut lattice = Lattice::default();
    let mut fraction = 0.0;
    let mut fresh = 0;
    loop {
        look_at_all(
            space,
            &mut fresh,
            tolerances,
            max_cells,
            threads,
            progress,
            &mut fraction,
        )?;
        look_beside(space, tolerances, threads, progress)?;
        let crossing = crossing(&space.forest);
        // Each becomes about ten triangles, which are there before they are made fewer.
        if crossing.len() > max_cells / 2 {
            return Err(MeshError::TooMany {
                limit: 0,
                fitting: fitting(&space.forest),
            });
        }
        progress.at(fraction)?;
        lattice.extend(space, &crossing, tolerances[0], threads, progress)?;
        let failing = map_told(threads, &crossing, progress, |node| {
            failing(space, &lattice, *node, tolerances[0])
        })?;
        let mut failing: Vec<u32> = failing.into_iter().flatten().collect();
        failing.sort_unstable();
        failing.dedup();
        let mut is_done = true;
        for node in failing {
            let cell = &mut space.forest.cells[node as usize];
            if cell.level == space.forest.deepest || cell.bounds.is_stuck {
                cell.undecided = true;
            } else if cell.child == NONE {
                is_done = false;
                let cell = *cell;
                if let Some(part) = space.narrow(&cell) {
                    space.forest.cells[node as usize].part = space.add(part, cell.part);
                }
                space.forest.split(node);
            }
        }
        if is_done {
            return Ok(lattice);
        }
    }
}

/// Looks at all leaves that are not known, and splits those that need it, until there are none.
fn look_at_all(
    space: &mut Space<'_>,
    fresh: &mut usize,
    tolerances: [f64; 2],
    max_cells: usize,
    threads: usize,
    progress: &mut Progress<'_>,
    fraction: &mut f32,
) -> Result<(), MeshError> {
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
            let looks = map_told(threads, &leaves, progress, |cell| {
                look(space, cell, tolerances)
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
            if space.forest.cells.len() > max_cells {
                return Err(MeshError::TooMany {
                    limit: 0,
                    fitting: fitting(&space.forest),
                });
            }
        }
    }
}

/// Cells that are looked at between two reports.
const BATCH: usize = 20_000;

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

/// Computes bounds for leaves without the surface that share a face with one that has it.
fn look_beside(
    space: &mut Space<'_>,
    tolerances: [f64; 2],
    threads: usize,
    progress: &mut Progress<'_>,
) -> Result<(), MeshError> {
    let forest = &space.forest;
    let mut open = Vec::new();
    for node in crossing(forest) {
        let cell = forest.cells[node as usize];
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

/// The cells in which a tetrahedron of a cell does not prove the topology.
fn failing(space: &Space<'_>, lattice: &Lattice, node: u32, tolerance: f64) -> Vec<u32> {
    let cells = &space.forest.cells;
    let [error, steep_error] = space.worst_error();
    let mut failing = Vec::new();
    crate::lattice::tetrahedra(&space.forest, node, &mut |keys, owners| {
        let vertices = keys.map(|key| lattice.index(key));
        let values = vertices.map(|i| lattice.value(i));
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
                // The other one alone may be to blame.
                if own.rest >= 0.5 * (rest - steep_error) && !failing.contains(&owner) {
                    failing.push(owner);
                }
            }
        }
    });
    failing
}

/// Gradient of the linear function with these values at the corners of a tetrahedron.
fn gradient(corners: &[DVec3; 4], values: &[f64; 4]) -> DVec3 {
    let [a, b, c] = [1, 2, 3].map(|i| corners[i] - corners[0]);
    let [u, v, w] = [1, 2, 3].map(|i| values[i] - values[0]);
    (u * b.cross(c) + v * c.cross(a) + w * a.cross(b)) / a.dot(b.cross(c))
}
