//! The mesh of one function.

use crate::forest::{Forest, NONE};
use crate::guard::Guarded;
use crate::improve::{Improved, Improver};
use crate::march::{Raw, march};
use crate::measure::{self, Measured};
use crate::options::{MeshError, Options, Phase, Progress};
use crate::refine::{self, Refinement};
use crate::space::Space;
use crate::thin;
use field::{Ball, Implicit};
use glam::DVec3;
use mesh::{Aabb, TriangleMesh};

/// The mesh of an implicit surface, with what was proved of it.
#[derive(Clone, Debug)]
pub struct SurfaceMesh {
    /// A closed manifold with normals, oriented outward.
    pub mesh: TriangleMesh,
    /// No point of a triangle is farther from the surface than this, but for unproved ones.
    pub error: f64,
    /// Triangles that are not proved to be within the tolerance: in parts as thin as it, near
    /// undecided cells and kinks.
    pub unproved: usize,
    /// Distances that samples found.
    pub measured: Measured,
    /// Pairs of triangles that cut or touch each other, a hundred at most: none but where vertices
    /// are nearer to each other than numbers can tell.
    pub crossings: usize,
    /// Centres of the cells in which the topology of the surface is not proved before it is meshed:
    /// none if all is. Components of the surface may be missing there that are as small as a cell.
    /// Places that are not within the tolerance, if the mesh is only measured.
    pub undecided: Vec<DVec3>,
    /// The least edge length that cells may have.
    pub finest: f64,
    /// Leaves that the surface may cross.
    pub cells: usize,
    /// Triangles before they were made fewer.
    pub raw_triangles: usize,
    /// Whether the domain cut something off, which was closed by flat lids.
    pub is_cut: bool,
    /// Evaluations of the function and of its bounds.
    pub evaluations: u64,
}

/// The box of a ball.
#[must_use]
pub fn box_of(ball: Ball) -> Aabb {
    Aabb::of_points([ball.center - ball.radius, ball.center + ball.radius])
}

/// A box around a surface within a domain, a little too large; `None` if there is no surface.
///
/// # Errors
/// If all of the domain is inside, if it is empty or not finite, or if the caller cancels.
pub fn extent(
    function: &dyn Implicit,
    domain: &Aabb,
    threads: usize,
    progress: &mut Progress<'_>,
) -> Result<Option<Aabb>, MeshError> {
    check(domain)?;
    refine::extent(function, domain, threads, progress)
}

/// Meshes the surface of a function within a domain: what goes beyond is cut off and closed by flat
/// lids.
///
/// # Errors
/// See [`MeshError`].
pub fn polygonize(
    function: &dyn Implicit,
    domain: &Aabb,
    options: &Options,
    progress: &mut Progress<'_>,
) -> Result<SurfaceMesh, MeshError> {
    guarded(function, domain, options, Guarded::Unproved, progress)
}

/// The same, with a choice of where edits are kept from making the mesh cut itself.
fn guarded(
    function: &dyn Implicit,
    domain: &Aabb,
    options: &Options,
    guarded: Guarded,
    progress: &mut Progress<'_>,
) -> Result<SurfaceMesh, MeshError> {
    let Options {
        tolerance,
        max_triangles,
        threads,
        ..
    } = *options;
    check(domain)?;
    // Not so for NaN.
    let is_sound = tolerance > 0.0 && tolerance.is_finite();
    if !is_sound {
        return Err(MeshError::NotFinite("the tolerance".into()));
    }
    let hull = extent(function, domain, threads, &mut progress.part(0.0, 0.02))?;
    let hull = hull.ok_or(MeshError::Nothing)?;
    // Cells of larger tolerances may not see the shape at all, and a mesh within a smaller one is
    // within a larger one, too.
    let tolerance = tolerance.min(LARGEST * (hull.max - hull.min).max_element());
    // The surface does not touch the boundary of the hull, unless that of the domain.
    let room = 0.02 * (hull.max - hull.min).max_element() + tolerance;
    let forest = Forest::new(
        &Aabb {
            min: (hull.min - room).max(domain.min),
            max: (hull.max + room).min(domain.max),
        },
        FINEST * tolerance,
        thin::LEVELS,
    );
    let size = (hull.max - hull.min).max_element();
    let mut space = Space::new(function, forest, tolerance / size);
    let max_cells = max_triangles.saturating_mul(2).max(LEAST_CELLS);
    let too_many = |error| match error {
        MeshError::TooMany { fitting, .. } => MeshError::TooMany {
            limit: max_triangles,
            fitting: fitting
                .map(|error| error / COARSE)
                .filter(|fitting| *fitting > tolerance),
        },
        other => other,
    };
    // Vertices come to the surface later, and triangles are divided where that is not enough.
    let coarse = COARSE * tolerance;
    let lattice = {
        let mut progress = progress.part(0.02, 0.4).in_phase(Phase::Cells);
        let mut refinement = Refinement::new(&mut space, [coarse, tolerance], max_cells, threads);
        refinement
            .settle(&mut progress.part(0.0, 0.8))
            .and_then(|seen| {
                thin::deepen(&mut refinement, seen, &mut progress.part(0.8, 1.0))?;
                Ok(refinement.lattice)
            })
            .map_err(too_many)?
    };
    let mut progress = progress.part(0.0, 1.0).in_phase(Phase::Triangles);
    progress.at(0.4)?;
    let raw = march(&space, &lattice, None, threads, &mut progress)?;
    if raw.triangles.is_empty() {
        return Err(MeshError::Nothing);
    }
    let forest = &space.forest;
    let undecided: Vec<u32> = (0..forest.cells.len() as u32)
        .filter(|i| {
            let cell = &forest.cells[*i as usize];
            cell.child == NONE && cell.undecided
        })
        .collect();
    let undecided: Vec<DVec3> = undecided
        .into_iter()
        .map(|i| forest.center(&forest.cells[i as usize]))
        .collect();
    let finest = forest.size(forest.deepest).max_element();
    let cells = refine::crossing(forest).len();
    let raw_triangles = raw.triangles.len();
    let is_cut = raw.is_lid.contains(&true);
    space.fit(&lattice, tolerance, threads, &mut progress)?;
    drop(lattice);
    let start = Start {
        space: &space,
        raw,
        tolerances: [tolerance, coarse],
        threads,
        guarded,
    };
    let (improved, crossings) = start.improved(&mut progress.part(0.4, 0.98))?;
    if improved.mesh.triangles.len() > max_triangles {
        return Err(MeshError::TooMany {
            limit: max_triangles,
            // The number of triangles is inverse to the tolerance.
            fitting: Some(
                tolerance * 1.2 * improved.mesh.triangles.len() as f64 / max_triangles as f64,
            ),
        });
    }
    let mut progress = progress.part(0.98, 1.0);
    let measured = measure::distances(
        &space,
        &start.raw,
        &improved,
        tolerance,
        threads,
        &mut progress,
    )?;
    let unproved = improved.is_unproved.iter().filter(|is| **is).count();
    Ok(SurfaceMesh {
        mesh: improved.mesh,
        error: tolerance,
        unproved,
        measured,
        crossings,
        undecided,
        finest,
        cells,
        raw_triangles,
        is_cut,
        evaluations: space.evaluations(),
    })
}

/// Crossings of triangles with which a search for them ends.
pub const MOST_CROSSINGS: usize = 100;

/// A mesh that was not yet improved.
struct Start<'a> {
    space: &'a Space<'a>,
    raw: Raw,
    tolerances: [f64; 2],
    threads: usize,
    guarded: Guarded,
}

impl Start<'_> {
    /// The improved mesh, with its number of crossings. Each change is kept from making any where
    /// cells leave the surface open; if there are some nonetheless, a second attempt does so
    /// everywhere, and takes longer.
    fn improved(&self, progress: &mut Progress<'_>) -> Result<(Improved, usize), MeshError> {
        let attempt = |guarded: Guarded, progress: &mut Progress<'_>| {
            let raw = self.raw.clone();
            let improver = Improver::new(self.space, raw, self.tolerances, self.threads, guarded)?;
            let improved = improver.run(&mut progress.part(0.0, 0.95))?;
            progress.at(0.95)?;
            let found = mesh::self_intersections(&improved.mesh, MOST_CROSSINGS);
            let crossings = found.map_or(0, |found| found.pairs.len() + found.flat.len());
            Ok((improved, crossings.min(MOST_CROSSINGS)))
        };
        let (improved, crossings) = attempt(self.guarded, &mut progress.part(0.0, 0.7))?;
        if crossings == 0 || self.guarded != Guarded::Unproved {
            return Ok((improved, crossings));
        }
        attempt(Guarded::Everywhere, &mut progress.part(0.7, 1.0))
    }
}

/// Largest tolerance that is worked with, in sizes of the surface.
pub const LARGEST: f64 = 0.02;
/// Cells are at least half so large, in tolerances, but for those that hold parts of the surface
/// which are [thinner](crate::thin): smaller ones take minutes where surfaces touch.
const FINEST: f64 = 4.0;

/// Cells may be so many times as far from the surface as the result.
const COARSE: f64 = 16.0;

/// A limit of cells that is not too low for any surface's topology.
pub const LEAST_CELLS: usize = 400_000;

pub fn check(domain: &Aabb) -> Result<(), MeshError> {
    let size = domain.max - domain.min;
    if size.is_finite() && size.min_element() > 0.0 {
        Ok(())
    } else {
        Err(MeshError::NotFinite("each side of the box".into()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::ops::ControlFlow;
    use field::{BlobScale, Kernel, Primitive, Shaping, Skeleton, Sum};

    #[test]
    fn mesh_cuts_itself_without_a_guard() {
        // Spikes as thin as the tolerance, beside each other: little is proved there.
        let limb = |radius: f64, base: DVec3, apex: DVec3| {
            let shaping = Shaping {
                kernel: Kernel::Gauss,
                radius,
                blobbiness: 2.0,
                blob_scale: BlobScale::Relative,
                strength: 1.0,
                influence: 1e-3,
                taper: None,
            };
            Primitive::new(Skeleton::Segment { base, apex }, &shaping, None)
        };
        let crossings = |apart: f64, guard: Guarded| {
            let spike = |i: i32| {
                let base = DVec3::new(apart * f64::from(i), 0.0, 0.2);
                let apex = base + DVec3::new(0.0, 0.02 * f64::from(i % 3), 0.6);
                limb(0.02, base, apex)
            };
            let body = limb(0.3, DVec3::NEG_X, DVec3::X);
            let sum: Sum = (-6..7).map(spike).chain([body]).flatten().collect();
            let domain = box_of(sum.support().unwrap());
            let mut report = |_| ControlFlow::Continue(());
            let progress = &mut Progress::new(&mut report);
            let surface = guarded(&sum, &domain, &Options::new(0.02), guard, progress).unwrap();
            assert!(surface.unproved > 100, "{}", surface.unproved);
            surface.crossings
        };
        // Where the cells lie decides whether a mesh cuts itself: the first distance between spikes
        // where it does is enough.
        let mut apart = [0.055, 0.05, 0.045, 0.04, 0.06, 0.065].into_iter();
        let cut = apart.find(|apart| crossings(*apart, Guarded::Nowhere) > 0);
        let cut = cut.expect("no mesh cuts itself");
        assert_eq!(crossings(cut, Guarded::Unproved), 0, "{cut}");
    }
}
