//! Meshes for the eye of bodies that cells would take too long for.

use crate::counted::Counted;
use crate::octree::Told;
use crate::pack::{Detail, Share};
use core::ops::ControlFlow;
use mesh::{Aabb, TriangleMesh};
use mesher::{Cage, MeshError, Progress, Spoke, THINNEST, look};
use scene::{Scene, Surface};

/// Most side of cells where a surface bends, in diagonals of its skeleton's box.
const MOST: f64 = 1.0 / 50.0;
/// Side of the cells of the first mesh, over the least.
const COARSE: f64 = 8.0;
/// Factor on the side of cells after a mesh that took too much work.
const COARSER: f64 = 2.0;
/// Most meshes that are tried.
const TRIES: usize = 4;
/// Factor on the side of cells with which another mesh is worth its time.
const WORTH: f64 = 0.8;
/// Factors on the work and the triangles of a mesh with cells of half the side, about.
const WORK: f64 = 3.0;
const TRIANGLES: f64 = 4.0;

/// A reason for which there is no mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NoMesh {
    /// Even a coarse one takes more work than allowed.
    Dear,
    /// The surface has no end, or there is none.
    Endless,
    /// Nobody waits for it.
    Cancelled,
}

/// Returns the least side of cells, in diagonals of the skeleton's box, their side in radii of the
/// thinnest part, and the tolerance in sides of cells.
fn sizes(detail: Detail) -> [f64; 3] {
    match detail {
        Detail::Quick => [1.0 / 75.0, 1.0, 0.06],
        Detail::Fine | Detail::Full => [1.0 / 150.0, 0.5, 0.03],
    }
}

/// Meshes a body, coarsely at first, and then as finely as its share allows. Returns the mesh and
/// the radius of flesh below which parts of it may be missing.
pub(crate) fn mesh(
    scene: &Scene,
    surface: &Surface,
    function: &Counted<'_>,
    share: Share,
    detail: Detail,
    told: &mut Told<'_>,
) -> Result<(TriangleMesh, f64), NoMesh> {
    let cages = Cage::of_surface(scene, surface);
    let spokes = cages.iter().flat_map(|cage| &cage.spokes);
    let radii = spokes.clone().map(Spoke::radius);
    let thinnest = radii.fold(f64::INFINITY, f64::min);
    let bounds = Aabb::of_points(spokes.flat_map(|spoke| {
        let radius = spoke.radius();
        [spoke.origin - radius, spoke.origin + radius]
    }));
    let size = bounds.size().length();
    let is_sound = size > 0.0 && size.is_finite() && thinnest > 0.0;
    if !is_sound {
        return Err(NoMesh::Endless);
    }
    let [least, of_radius, off] = sizes(detail);
    let finest = (of_radius * thinnest).clamp(least * size, MOST * size);
    let mut step = COARSE * finest;
    let mut best = None;
    for _ in 0..TRIES {
        let start = function.work();
        let left = share.work.saturating_sub(start);
        // A second try needs as much.
        let most = if best.is_some() { left } else { left / 2 };
        let mut is_wanted = true;
        let made = look(
            function,
            &cages,
            [off * step, step],
            &mut Progress::new(&mut |at| {
                is_wanted = told(at.fraction);
                if is_wanted && function.work() - start <= most {
                    ControlFlow::Continue(())
                } else {
                    ControlFlow::Break(())
                }
            }),
        );
        if !is_wanted {
            return Err(NoMesh::Cancelled);
        }
        let factor = match made {
            Ok(mesh) => {
                let used = (function.work() - start).max(1);
                let count = mesh.triangles.len().max(1);
                let mut work = left.saturating_sub(used) as f64 / used as f64;
                let mut room = share.triangles as f64 / count as f64;
                if count <= share.triangles {
                    best = Some((mesh, THINNEST * step));
                }
                // Cells are halved: between two halves there is nothing.
                let mut factor = if room < 1.0 { COARSER } else { 1.0 };
                while step * factor > finest && work >= WORK && room >= TRIANGLES {
                    (work, room) = (work / WORK, room / TRIANGLES);
                    factor *= 0.5;
                }
                factor.max(finest / step)
            }
            Err(MeshError::Cancelled | MeshError::TooMany { .. }) => COARSER,
            Err(_) => return best.ok_or(NoMesh::Endless),
        };
        if best.is_some() && factor > WORTH {
            break;
        }
        step *= factor;
    }
    best.ok_or(NoMesh::Dear)
}
