//! Meshes for the eye of bodies that cells would take too long for.

use crate::octree::Told;
use crate::pack::Detail;
use core::ops::ControlFlow;
use mesh::{Aabb, TriangleMesh};
use mesher::{Cage, Spoke, look};
use scene::{Scene, Surface};

/// Most side of cells where a surface bends, in diagonals of its skeleton's box.
const MOST: f64 = 1.0 / 50.0;

/// Returns the least side of cells, in diagonals of the skeleton's box, their side in radii of the
/// thinnest part, and the tolerance in sides of cells.
fn sizes(detail: Detail) -> [f64; 3] {
    match detail {
        Detail::Quick => [1.0 / 75.0, 1.0, 0.06],
        Detail::Fine | Detail::Full => [1.0 / 150.0, 0.5, 0.03],
    }
}

/// Meshes a body; `None` if there is nothing to see, or it has no end.
pub(crate) fn mesh(
    scene: &Scene,
    surface: &Surface,
    detail: Detail,
    told: &mut Told<'_>,
) -> Option<TriangleMesh> {
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
        return None;
    }
    let [least, of_radius, off] = sizes(detail);
    let step = (of_radius * thinnest).clamp(least * size, MOST * size);
    let mesh = look(
        surface.function(),
        &cages,
        [off * step, step],
        &mut mesher::Progress::new(&mut |step| match told(step.fraction) {
            true => ControlFlow::Continue(()),
            false => ControlFlow::Break(()),
        }),
    );
    mesh.ok()
}
