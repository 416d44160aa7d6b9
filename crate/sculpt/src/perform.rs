//! Carrying strokes out on clay.

use crate::clay::{Clay, Region};
use crate::delta::Delta;
use crate::drag::Drag;
use crate::error::{Error, fail};
use crate::region::RegionChange;
use crate::stroke::{Beginning, MaskChange, Stroke};
use mesh::TriangleMesh;

/// Reads a mesh file by its name.
pub type Loader<'a> = &'a mut dyn FnMut(&str) -> Result<TriangleMesh, String>;

/// The clay that strokes begin with.
pub(crate) fn begin(beginning: &Beginning, load: Loader<'_>) -> Result<Clay, Error> {
    match beginning {
        Beginning::Shape(start) => Clay::of_shape(start),
        Beginning::File(name) => {
            let mesh = load(name).map_err(Error)?;
            Clay::of_triangles(&mesh).map(|(clay, _)| clay)
        }
    }
}

/// Visits of a vertex that a face counts as when elements change, since all elements are then
/// compared with those before.
const TOPOLOGY_WORK: u64 = 20;

/// Carries out a stroke, and returns what it has changed.
pub(crate) fn carry_out(clay: &mut Clay, stroke: &Stroke, most_work: u64) -> Result<Delta, Error> {
    let too_much = "all strokes together take too long";
    let delta = match stroke {
        Stroke::Stage(_) => Delta::default(),
        Stroke::Symmetry(planes) => Delta {
            symmetry: Some(core::mem::replace(&mut clay.symmetry, *planes)),
            ..Delta::default()
        },
        Stroke::Sweep(sweep) => {
            let mut drag = Drag::new(clay, sweep);
            for point in &sweep.path {
                drag.step(clay, *point);
                if clay.work > most_work {
                    drag.end(clay).swap(clay);
                    return fail(too_much);
                }
            }
            drag.end(clay)
        }
        Stroke::Region(change) => region(clay, *change),
        Stroke::Masks(change) => masks(clay, *change),
        Stroke::Refine(how) => clay.refine_with(*how)?,
        Stroke::Loop(levels) => clay.smooth_loop_with(*levels)?,
        Stroke::Average(levels, share) => clay.average_with(*levels, *share)?,
        Stroke::Fill => clay.fill_holes_with()?,
        Stroke::Delete(to) => clay.delete_with(*to)?,
        Stroke::Simplify(share) => clay.simplify_with(*share)?,
    };
    if delta.topology.is_some() {
        clay.work += TOPOLOGY_WORK * clay.mesh.face_count() as u64;
    }
    if clay.work > most_work {
        let mut delta = delta;
        delta.swap(clay);
        return fail(too_much);
    }
    Ok(delta)
}

fn region(clay: &mut Clay, change: RegionChange) -> Delta {
    let old: Region = clay.region.clone();
    clay.work += clay.mesh.face_count() as u64;
    clay.change_region(change);
    Delta {
        region: Some(old),
        ..Delta::default()
    }
}

fn masks(clay: &mut Clay, change: MaskChange) -> Delta {
    let mut masks = Vec::new();
    clay.work += clay.mesh.vertex_count() as u64;
    for v in clay.mesh.vertices() {
        let mask = &mut clay.masks[v.index()];
        let new = match change {
            MaskChange::Clear => 0.0,
            MaskChange::Invert => 1.0 - *mask,
        };
        if new.to_bits() != mask.to_bits() {
            masks.push((v.0, core::mem::replace(mask, new)));
        }
    }
    Delta {
        masks,
        ..Delta::default()
    }
}
