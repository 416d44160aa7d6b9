//! The mesh of one function.

use crate::forest::{Forest, NONE};
use crate::improve::Improver;
use crate::march::march;
use crate::options::{MeshError, Options, Phase, Progress};
use crate::refine;
use crate::space::Space;
use field::{Ball, Implicit};
use glam::DVec3;
use mesh::{Aabb, TriangleMesh};

/// The mesh of an implicit surface, with what was proved of it.
#[derive(Clone, Debug)]
pub struct SurfaceMesh {
    /// A closed manifold with normals, oriented outward.
    pub mesh: TriangleMesh,
    /// No point of the mesh is farther from the surface than this, and no point of the surface farther from the mesh, but for
    /// undecided cells and unproved triangles.
    pub error: f64,
    /// Triangles that are not proved to be within the tolerance: near undecided cells and kinks.
    pub unproved: usize,
    /// Centres of the cells in which the topology of the surface is not proved before it is meshed: none if all is. If all triangles
    /// are proved, components of the surface may be missing there that are as small as a cell; the others have the topology of
    /// the mesh.
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

/// Meshes the surface of a function within a domain: what goes beyond is cut off and closed by flat lids.
///
/// # Errors
/// See [`MeshError`].
pub fn polygonize(
    function: &dyn Implicit,
    domain: &Aabb,
    options: &Options,
    progress: &mut Progress<'_>,
) -> Result<SurfaceMesh, MeshError> {
    let Options {
        tolerance,
        max_triangles,
        threads,
    } = *options;
    check(domain)?;
    // Not so for NaN.
    let is_sound = tolerance > 0.0 && tolerance.is_finite();
    if !is_sound {
        return Err(MeshError::NotFinite("the tolerance".into()));
    }
    let hull = extent(function, domain, threads, &mut progress.part(0.0, 0.02))?;
    let hull = hull.ok_or(MeshError::Nothing)?;
    // The surface does not touch the boundary of the hull, unless that of the domain.
    let room = 0.02 * (hull.max - hull.min).max_element() + tolerance;
    let forest = Forest::new(
        &Aabb {
            min: (hull.min - room).max(domain.min),
            max: (hull.max + room).min(domain.max),
        },
        FINEST * tolerance,
    );
    let mut space = Space::new(function, forest);
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
    let lattice = refine::refine(
        &mut space,
        [coarse, tolerance],
        max_cells,
        threads,
        &mut progress.part(0.02, 0.4).in_phase(Phase::Cells),
    )
    .map_err(too_many)?;
    let mut progress = progress.part(0.0, 1.0).in_phase(Phase::Triangles);
    progress.at(0.4)?;
    let raw = march(&space, &lattice, threads);
    drop(lattice);
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
    let improver = Improver::new(&space, raw, [tolerance, coarse], threads)?;
    let improved = improver.run(&mut progress.part(0.4, 1.0))?;
    if improved.mesh.triangles.len() > max_triangles {
        return Err(MeshError::TooMany {
            limit: max_triangles,
            // The number of triangles is inverse to the tolerance.
            fitting: Some(
                tolerance * 1.2 * improved.mesh.triangles.len() as f64 / max_triangles as f64,
            ),
        });
    }
    Ok(SurfaceMesh {
        mesh: improved.mesh,
        error: improved.error,
        unproved: improved.unproved,
        undecided,
        finest,
        cells,
        raw_triangles,
        is_cut,
        evaluations: space.evaluations(),
    })
}

/// Cells are at least half so large, in tolerances: smaller ones take minutes where surfaces touch. Parts of a surface that are smaller
/// than they may be missing; where they leave the topology open, they are told.
const FINEST: f64 = 4.0;

/// Cells may be so many times as far from the surface as the result.
const COARSE: f64 = 16.0;

/// A limit of cells that is not too low for any surface's topology.
const LEAST_CELLS: usize = 400_000;

fn check(domain: &Aabb) -> Result<(), MeshError> {
    let size = domain.max - domain.min;
    if size.is_finite() && size.min_element() > 0.0 {
        Ok(())
    } else {
        Err(MeshError::NotFinite("each side of the box".into()))
    }
}
