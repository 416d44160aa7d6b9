//! A mesh for the eye, in a fraction of a second: cells are found by samples alone, from where
//! skeletons are. Nothing is measured; parts are missed that no skeleton lies in and that are as
//! thin as a cell.

use crate::cages::{Cage, Line};
use crate::dual::sketch;
use crate::forest::Forest;
use crate::grow::{Corners, Sizes, split_all};
use crate::options::{MeshError, Progress};
use crate::space::Space;
use crate::surface::box_of;
use field::Implicit;
use glam::DVec3;
use mesh::{Aabb, TriangleMesh};

/// Levels below the usual one, for limbs that are thinner.
const LEVELS: u32 = 2;
/// Radius of flesh over `step` of [`look`], below which parts of the mesh may be missing.
pub const THINNEST: f64 = 1.0 / (1 << LEVELS) as f64;
/// Side of the cells around a skeleton, in radii of its flesh, with which one of their corners is
/// inside: less than 2/√3.
const OF_RADIUS: f64 = 1.0;
/// Most places along a line.
const MOST_PLACES: f64 = 1000.0;
/// Most cells.
const MOST_CELLS: usize = 1_000_000;

/// Meshes the surface of a function for the eye, off by about the tolerance, with cells no smaller
/// than `step` but around limbs that are thinner. It is followed from the skeletons in the
/// cages. The mesh is closed, but it may touch or cut itself.
///
/// # Errors
/// [`MeshError::Unbounded`] if the surface has no end, [`MeshError::TooMany`] if it needs too many
/// cells, [`MeshError::Nothing`] if there is none, and if the caller cancels.
pub fn look(
    function: &dyn Implicit,
    cages: &[Cage],
    [tolerance, step]: [f64; 2],
    progress: &mut Progress<'_>,
) -> Result<TriangleMesh, MeshError> {
    // Not so for NaN.
    let is_sound = tolerance > 0.0 && step > 0.0 && step.is_finite();
    if !is_sound {
        return Err(MeshError::NotFinite("the tolerance".into()));
    }
    let spokes = cages.iter().flat_map(|cage| &cage.spokes);
    let domain = match function.support() {
        Some(ball) => box_of(ball),
        None => Aabb::of_points(spokes.clone().flat_map(|spoke| {
            let reach = DVec3::splat(spoke.reach);
            [spoke.origin - reach, spoke.origin + reach]
        })),
    };
    let is_empty = spokes.clone().next().is_none();
    if is_empty || !domain.size().is_finite() || domain.size().min_element() <= 0.0 {
        return Err(MeshError::Nothing);
    }
    let forest = Forest::new(&domain, step, LEVELS);
    let mut space = Space::new(function, forest, tolerance / domain.size().max_element());
    let thinnest = THINNEST * step;
    let own = cages.iter().flat_map(|cage| &cage.lines);
    let lines = own.filter(|line| line.is_own);
    let along = lines.flat_map(|line| places_along(line, thinnest));
    let starts = spokes.map(|spoke| (spoke.origin, spoke.radius()));
    let places: Vec<(DVec3, f64)> = starts.chain(along).collect();
    seed(&mut space, &places, progress)?;
    let sizes = Sizes {
        tolerance,
        hiding: f64::INFINITY,
        most: MOST_CELLS,
        threads: 1,
    };
    let raw = sketch(&mut space, &mut Corners::default(), &sizes, progress)?;
    let raw = raw.ok_or(MeshError::Unbounded)?;
    if raw.triangles.is_empty() {
        return Err(MeshError::Nothing);
    }
    let positions = raw.vertices.iter().map(|vertex| vertex.position).collect();
    let mut mesh = TriangleMesh::new(positions, raw.triangles);
    mesh.normals = Some(raw.vertices.iter().map(|vertex| vertex.normal()).collect());
    Ok(mesh)
}

/// Returns places on a line with the radius of the flesh there, no farther apart than it, nor than
/// a length below which parts may be missed.
fn places_along(line: &Line, least: f64) -> impl Iterator<Item = (DVec3, f64)> {
    let ([a, b], [from, to]) = (line.ends, line.radii);
    let apart = from.min(to).max(least);
    let count = (a.distance(b) / apart).ceil().clamp(1.0, MOST_PLACES) as u32;
    (0..=count).map(move |i| {
        let share = f64::from(i) / f64::from(count);
        (a.lerp(b, share), from + (to - from) * share)
    })
}

/// Splits the cells around places in the flesh until they are as small as it is thin there.
fn seed(
    space: &mut Space<'_>,
    places: &[(DVec3, f64)],
    progress: &mut Progress<'_>,
) -> Result<(), MeshError> {
    loop {
        let forest = &space.forest;
        let large = places.iter().filter_map(|(place, radius)| {
            let leaf = forest.leaf_at(*place);
            let level = forest.cells[leaf as usize].level;
            let is_large = forest.size(level).max_element() > OF_RADIUS * radius;
            (is_large && level < forest.deepest).then_some(leaf)
        });
        let mut large: Vec<u32> = large.collect();
        if large.is_empty() {
            return Ok(());
        }
        large.sort_unstable();
        large.dedup();
        split_all(space, &large, 1, progress)?;
        if space.forest.cells.len() > MOST_CELLS {
            return Err(MeshError::TooMany {
                limit: MOST_CELLS,
                fitting: None,
            });
        }
    }
}
