//! Cells of the size that the surface's curvature asks for, as samples tell it: for meshes whose
//! error is measured, not proved.
//!
//! Bounds say where no surface can be, and how small cells must be so that none hides between
//! samples; normals at the corners and the centre of a cell say how far its triangles would be from
//! the surface. Where the surface leaves the cells that were taken for all of it, it is followed
//! across their faces, so that the level set is closed.

use crate::forest::{Cell, NONE, Side};
use crate::lattice::{Lattice, tetrahedra};
use crate::options::{MeshError, Progress};
use crate::parallel::map_told;
use crate::refine::{around, coarse_range, crossing, error, fine_range, side};
use crate::space::Space;
use field::{Jet, Part, THRESHOLD};
use glam::DVec3;

/// Cells are taken to hide nothing if the second derivative's bound times the square of their size
/// is at most so many thresholds: first the least, then more where that asks for too many cells, as
/// where bounds are far from the truth.
pub const HIDING: [f64; 3] = [6.0, 60.0, 600.0];
/// Largest height of the surface's arc between centre and corner of a cell, in tolerances.
const SAG: f64 = 0.3;
/// Least cosine of the angle between the normals at the centre and at a corner.
const EVEN: f64 = 0.6;
/// Cells are not divided below so many tolerances where only normals ask for it, as at creases.
pub const FINEST: f64 = 2.0;
/// Levels below that of the finest cells, for parts that are thinner.
pub const LEVELS: u32 = 6;
/// Cells that are looked at between two reports.
const BATCH: usize = 20_000;

/// Result of a look at a cell.
struct Look {
    side: Side,
    split: bool,
    part: Option<Part>,
}

/// Looks at a cell; `is_crossed` if the surface is known to be in it.
fn look(space: &Space<'_>, cell: &Cell, [tolerance, hiding]: [f64; 2], is_crossed: bool) -> Look {
    let forest = &space.forest;
    let (center, size) = (forest.center(cell), forest.size(cell.level));
    let longest = size.max_element();
    let variation = around(space, cell.part, center, size);
    let off = error(space, cell.part, size);
    let sure = side(coarse_range(&variation, off));
    if !is_crossed && sure != Side::Crossing && variation.jump == 0.0 {
        return Look::leaf(sure);
    }
    let jet = space.jet(cell.part, center);
    let sure = side(fine_range(&variation, &jet, size, off));
    if !is_crossed && sure != Side::Crossing {
        return Look::leaf(sure);
    }
    // Not so for NaN.
    let hides_nothing = variation.curvature * longest * longest <= hiding * THRESHOLD;
    let is_last = cell.level >= forest.deepest;
    if !hides_nothing && !is_last {
        return Look::split(space, cell);
    }
    let Seen {
        is_near,
        sag,
        cosine,
    } = Seen::new(space, cell, &jet, tolerance);
    if !is_near && !is_crossed {
        return Look::leaf(if jet.value > THRESHOLD {
            Side::Inside
        } else {
            Side::Outside
        });
    }
    let is_fine = sag <= SAG * tolerance && cosine >= EVEN;
    if is_fine || cell.level >= forest.usual {
        Look::leaf(Side::Crossing)
    } else {
        Look::split(space, cell)
    }
}

impl Look {
    fn leaf(side: Side) -> Self {
        Self {
            side,
            split: false,
            part: None,
        }
    }

    fn split(space: &Space<'_>, cell: &Cell) -> Self {
        Self {
            side: Side::Crossing,
            split: true,
            part: space.narrow(cell),
        }
    }
}

/// The surface in a cell by samples.
struct Seen {
    /// Whether the samples do not say that it is elsewhere.
    is_near: bool,
    /// The largest height of its arc between centre and corner.
    sag: f64,
    /// The least cosine of the angle between the normals there.
    cosine: f64,
}

impl Seen {
    fn new(space: &Space<'_>, cell: &Cell, middle: &Jet<f64>, tolerance: f64) -> Self {
        let forest = &space.forest;
        let (center, half) = (forest.center(cell), 0.5 * forest.size(cell.level));
        let ways: [DVec3; 8] = core::array::from_fn(|i| {
            let signs = [1, 2, 4].map(|bit| if i & bit == 0 { -1.0 } else { 1.0 });
            DVec3::from_array(signs) * half
        });
        let jets = space.jets(cell.part, &ways.map(|way| center + way), tolerance);
        let own = middle.value - THRESHOLD;
        let uphill = DVec3::from_array(middle.gradient);
        let normal = uphill.normalize_or_zero();
        let (mut sag, mut cosine, mut bend) = (0.0_f64, 1.0_f64, 0.0_f64);
        let mut least = own.abs();
        let mut is_near = false;
        for (way, jet) in ways.iter().zip(&jets) {
            let value = jet.value - THRESHOLD;
            let gradient = DVec3::from_array(jet.gradient);
            let other = gradient.normalize_or_zero();
            // A value that is no number counts as outside.
            is_near |= (value > 0.0) != (own > 0.0);
            least = least.min(value.abs());
            sag = sag.max((other - normal).dot(*way).abs() / 8.0);
            cosine = cosine.min(other.dot(normal));
            bend = bend.max((gradient - uphill).dot(*way).abs() / 8.0);
        }
        // Between samples the function is as far from its interpolant as along their edges.
        // Not so for NaN.
        let is_far = least > BEND * bend;
        is_near |= !is_far;
        Self {
            is_near,
            sag,
            cosine,
        }
    }
}

/// Largest distance of the function from its interpolant in a cell, over that along the edges from
/// its centre.
const BEND: f64 = 3.0;

/// Divides the cells that are not known yet, for a tolerance and one of [`HIDING`], and follows the
/// surface through them. The lattice gets the values at the vertices of all cells that it crosses.
///
/// # Errors
/// If there are more cells than `most`, or if the caller cancels.
pub fn grow(
    space: &mut Space<'_>,
    lattice: &mut Lattice,
    [tolerance, hiding]: [f64; 2],
    most: usize,
    threads: usize,
    progress: &mut Progress<'_>,
) -> Result<(), MeshError> {
    let mut left = Vec::new();
    let mut fraction = 0.0;
    loop {
        divide(space, &left, [tolerance, hiding], most, threads, progress)?;
        fraction += 0.3 * (1.0 - fraction);
        progress.at(fraction)?;
        let cells = crossing(&space.forest);
        lattice.extend(space, &cells, false, tolerance, threads, progress)?;
        left = follow(space, lattice, &cells, threads, progress)?;
        if left.is_empty() {
            return Ok(());
        }
    }
}

/// Looks at all leaves that are not known, and splits those that need it, until there are none;
/// those that are crossed first.
fn divide(
    space: &mut Space<'_>,
    crossed: &[u32],
    sizes: [f64; 2],
    most: usize,
    threads: usize,
    progress: &mut Progress<'_>,
) -> Result<(), MeshError> {
    let mut open = crossed.to_vec();
    let mut is_crossed = true;
    let mut fresh = 0;
    loop {
        for batch in open.chunks(BATCH) {
            progress.again()?;
            let leaves: Vec<Cell> = batch
                .iter()
                .map(|i| space.forest.cells[*i as usize])
                .collect();
            let looks = map_told(threads, &leaves, progress, |cell| {
                look(space, cell, sizes, is_crossed)
            })?;
            for (node, look) in batch.iter().zip(looks) {
                if space.forest.cells[*node as usize].child != NONE {
                    // A neighbour was split.
                    continue;
                }
                let cell = &mut space.forest.cells[*node as usize];
                cell.side = look.side;
                let part = cell.part;
                if let Some(new) = look.part {
                    let part = space.add(new, part);
                    space.forest.cells[*node as usize].part = part;
                }
                if look.split {
                    space.forest.split(*node);
                }
            }
            if space.forest.cells.len() > most {
                return Err(MeshError::TooMany {
                    limit: most,
                    fitting: None,
                });
            }
        }
        is_crossed = false;
        let cells = &space.forest.cells;
        let all = (fresh..cells.len() as u32).zip(&cells[fresh as usize..]);
        let new = all.filter(|(_, cell)| cell.child == NONE && cell.side == Side::Unknown);
        open = new.map(|(i, _)| i).collect();
        fresh = cells.len() as u32;
        if open.is_empty() {
            return Ok(());
        }
    }
}

/// The cells beside some that the surface crosses, which it crosses too, but are not known to be.
fn follow(
    space: &Space<'_>,
    lattice: &Lattice,
    cells: &[u32],
    threads: usize,
    progress: &mut Progress<'_>,
) -> Result<Vec<u32>, MeshError> {
    let found = map_told(threads, cells, progress, |node| {
        let mut found = Vec::new();
        tetrahedra(&space.forest, *node, &mut |keys, owners| {
            let cells = owners.map(|i| (i, space.forest.cells[i as usize].side));
            let new = cells
                .into_iter()
                .filter(|(_, side)| *side != Side::Crossing);
            let before = found.len();
            found.extend(new.map(|(i, _)| i));
            if found.len() > before {
                let inside = keys.map(|key| lattice.value(lattice.index(key)) > 0.0);
                if !inside.contains(&true) || !inside.contains(&false) {
                    found.truncate(before);
                }
            }
        });
        found
    })?;
    let mut found: Vec<u32> = found.into_iter().flatten().collect();
    found.sort_unstable();
    found.dedup();
    Ok(found)
}
