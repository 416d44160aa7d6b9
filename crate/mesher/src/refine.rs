//! Refinement of cells until each proves that the linear interpolant has the topology of the surface and is near it.
//!
//! Let L be the interpolant of F on the tetrahedra of the [lattice](crate::lattice). Where no cell with F = T lies in a
//! tetrahedron, or else ⟨∇F(x), ∇L⟩ > 0 for all x of it, the level sets of (1−s)F + sL are isotopic for all s from 0 to 1: none
//! of the generalised gradients vanishes (Agrachev, Pallaschke and Scholtes 1997, on piecewise smooth functions). The
//! condition is Plantinga and Vegter's, for tetrahedra: it holds if ⟨g, ∇L⟩ > C·r·|∇L|, with g the gradient at the centre
//! of a ball of radius r around the cell and C the bound on the curvature there.

use crate::forest::{Bounds, Cell, Forest, NONE, Side};
use crate::lattice::Lattice;
use crate::options::{MeshError, Progress};
use crate::parallel::map;
use crate::space::{SLACK, Space};
use field::{Ball, Part, THRESHOLD, Variation};
use glam::DVec3;
use mesh::Aabb;

/// Cells are split until the gradient is so many times its possible change: then nearly all tetrahedra pass.
const STEADY: f64 = 1.2;

/// |F − L| ≤ C·R²/2 on a tetrahedron in a ball of radius R (Waldron 1998), and those of a cell of size s have R² ≤ 5/16·s².
const INTERPOLATION: f64 = 5.0 / 32.0;

/// Values nearer to the threshold than this share of the tolerance times the slope are moved away from it, so that no vertex
/// of the mesh is at a vertex of the lattice.
pub const NUDGE: f64 = 0.1;

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
        third,
        rough,
    } = space.variation(cell.part, ball);
    let jet = space.jet(cell.part, center);
    let side_of = |[low, high]: [f64; 2]| {
        if low - SLACK > THRESHOLD {
            Side::Inside
        } else if high + SLACK < THRESHOLD {
            Side::Outside
        } else {
            Side::Crossing
        }
    };
    let gradient = DVec3::from_array(jet.gradient);
    let mut side = side_of(range.about(&jet, radius).value);
    let mut bounds = Bounds {
        gradient,
        spread: range.curvature * radius + SLACK / radius,
        ..Bounds::NONE
    };
    // Differences say nothing of terms whose second derivative jumps; it is at most √3 of their bound.
    let is_smooth = third.is_finite() && rough.is_finite();
    let mut bend = range.curvature;
    if side == Side::Crossing && is_smooth {
        let step = 1e-3 * radius;
        let hessian = space.hessian(cell.part, center, step);
        let rest = |r: f64| 0.5 * third * r * r + 3.0 * rough * r + third * step * r + SLACK / r;
        let norm = hessian.to_cols_array().map(|x| x * x).into_iter().sum::<f64>().sqrt();
        // The cell is a box.
        let linear = (gradient.abs() * size * 0.5).element_sum();
        let change = linear + 0.5 * norm * radius * radius + radius * rest(radius) + 1e-12;
        side = side_of([jet.value - change, jet.value + change]);
        bounds.hessian = hessian;
        bounds.rest = rest(radius);
        bounds.spread = bounds.spread.min(norm * radius + rest(radius));
        bend = bend.min(norm + third * around + 3.0 * rough);
    }
    let steep = gradient.length();
    let longest = size.max_element();
    let beyond = bounds.spread + bend * (around - radius);
    let off =
        bend * INTERPOLATION * longest * longest + NUDGE * tolerance * (steep + beyond) + SLACK;
    // Not so for NaN.
    let is_steady = steep > STEADY * bounds.spread.min(0.6 * bounds.spread + bounds.rest);
    let least = steep - beyond.min(0.6 * beyond + bounds.rest);
    if least > 0.0 {
        bounds.error = off / least;
    }
    let wanted = side == Side::Crossing && !(is_steady && bounds.error <= tolerance);
    let split = wanted && cell.level < forest.deepest;
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
    let mut space = Space::new(function, Forest::new(domain, size.max_element() * 2e-5));
    let mut open: Vec<u32> = (0..space.forest.cells.len() as u32).collect();
    let mut is_inside = false;
    while !open.is_empty() {
        progress.at(0.5)?;
        let cells: Vec<Cell> = open.iter().map(|i| space.forest.cells[*i as usize]).collect();
        // No cell is good enough for a tolerance of 0.
        let looks = map(threads, &cells, |cell| look(&space, cell, [0.0; 2]));
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
            let (center, half) = (space.forest.center(&cell), 0.5 * space.forest.size(cell.level));
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
        look_at_all(space, &mut fresh, tolerances, max_cells, threads, progress, &mut fraction)?;
        look_beside(space, tolerances, threads);
        let crossing = crossing(&space.forest);
        lattice.extend(space, &crossing, tolerances[0], threads);
        let failing = map(threads, &crossing, |node| failing(space, &lattice, *node));
        let mut failing: Vec<u32> = failing.into_iter().flatten().collect();
        failing.sort_unstable();
        failing.dedup();
        let mut is_done = true;
        for node in failing {
            let cell = &mut space.forest.cells[node as usize];
            if cell.level == space.forest.deepest {
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
        let open: Vec<u32> = (*fresh as u32..cells.len() as u32).filter(is_open).collect();
        *fresh = cells.len();
        if open.is_empty() {
            return Ok(());
        }
        *fraction += 0.07 * (1.0 - *fraction);
        for batch in open.chunks(BATCH) {
            progress.at(*fraction)?;
            let leaves: Vec<Cell> = batch.iter().map(|i| space.forest.cells[*i as usize]).collect();
            let looks = map(threads, &leaves, |cell| look(space, cell, tolerances));
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
    let crossing = forest.cells.iter().filter(|c| c.side == Side::Crossing && c.has_bounds);
    let mut errors: Vec<f64> = crossing
        .map(|cell| cell.bounds.error)
        .filter(|error| error.is_finite())
        .collect();
    errors.sort_unstable_by(f64::total_cmp);
    // Most of the cells were divided already.
    errors.get(errors.len() * 9 / 10).copied()
}

/// Computes bounds for leaves without the surface that share a face with one that has it.
fn look_beside(space: &mut Space<'_>, tolerances: [f64; 2], threads: usize) {
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
    let looks = map(threads, &cells, |cell| look(space, cell, tolerances));
    for (node, look) in open.into_iter().zip(looks) {
        let cell = &mut space.forest.cells[node as usize];
        cell.bounds = look.bounds;
        cell.has_bounds = true;
    }
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
fn failing(space: &Space<'_>, lattice: &Lattice, node: u32) -> Vec<u32> {
    let cells = &space.forest.cells;
    let mut failing = Vec::new();
    crate::lattice::tetrahedra(&space.forest, node, &mut |keys, owners| {
        let corners = keys.map(|key| space.forest.position(crate::lattice::unpack(key)));
        let values = keys.map(|key| lattice.value(key));
        let slope = gradient(&corners, &values);
        for (k, owner) in owners.into_iter().enumerate() {
            let center = space.forest.center(&cells[owner as usize]);
            let mut within = corners.map(|p| p - center);
            if owners[0] != owners[1] {
                // The half in this cell ends where the line of the centres crosses the face.
                within[1 - k] = 0.5 * (corners[0] + corners[1]) - center;
            }
            let proves = cells[owner as usize].bounds.rises(slope, &within);
            if !proves && !failing.contains(&owner) {
                failing.push(owner);
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
