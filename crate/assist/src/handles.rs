//! The numbers of a shape as places in the world that a hand can move.
//!
//! [`handles`] gives the handles of one element of a compiled scene: points, radii, angles and
//! directions of the command that made it. [`drag`] says how the texts change when a handle is
//! moved: only the numbers that change are replaced, everything else stays as it was written. A
//! number that a variable stands for is moved where the variable is set; one that is computed, or
//! that made several shapes at once, has a handle that says so and cannot be moved.
//!
//! ```
//! use assist::handles::{drag, handles};
//! use glam::{DMat3, DVec3};
//!
//! let project = rats::Project::single("surface Clay, diffuse SandyBrown\nsphere Clay 1, 0 0 0\n");
//! let compiled = rats::compile(&project);
//! let handles = handles(&project, &[], 0, &compiled, 0, &DMat3::IDENTITY);
//! let centre = handles.iter().find(|handle| handle.label == "the centre").unwrap();
//! // To the right by 2.5, exact to a tenth.
//! let edits = drag(centre, DVec3::new(2.5, 0.0, 0.0), 0.1);
//! let moved = project.apply(&edits);
//! assert!(moved.files[0].text.ends_with("sphere Clay 1, 2.5 0 0\n"));
//! ```

mod cage;
mod decimal;
mod drag;
mod fixed;
mod handle;
mod maker;

pub use cage::{cage, pull};
pub use drag::drag;
pub use handle::{Editable, Handle, Kind};

use field::Skeleton;
use fixed::{plain, why_repeated};
use glam::DMat3;
use maker::Maker;
use rats::provenance::Provenance;
use rats::{Asset, Compiled, Project, provenance};
use scene::Element;

/// Returns the handles of an element of `compiled.scene`, which came from `project` with these
/// assets, at this frame. `view` is [`scene::Projection::world_from_view`]: knobs for radii lie
/// across the view.
///
/// The text is run once more up to the element's command, so the cost is that of compiling. An
/// index that is none gives no handles.
#[must_use]
pub fn handles(
    project: &Project,
    assets: &[Asset],
    frame: u32,
    compiled: &Compiled,
    element: usize,
    view: &DMat3,
) -> Vec<Handle> {
    let scene = &compiled.scene;
    let (Some(shape), Some(placement)) = (
        scene.elements.get(element),
        compiled.placements.get(element),
    ) else {
        return Vec::new();
    };
    let why = match placement.repeated {
        true => why_repeated(project, shape.origin),
        false => None,
    };
    let Some(seen) = provenance(project, assets, f64::from(frame), shape.origin) else {
        let why = why.unwrap_or_else(|| String::from("has no numbers of its own in the text"));
        return plain(&shape.shape, &why);
    };
    let siblings = scene
        .elements
        .iter()
        .filter(|e| e.origin == shape.origin)
        .count();
    let maker = Maker {
        scene,
        element: shape,
        placement,
        view,
        seen: &seen,
    };
    if let Some(why) = why {
        let mut handles = plain(&shape.shape, &why);
        handles.extend(maker.radius_of_all());
        return handles;
    }
    if !placement.repeated && siblings > parts(&seen, shape) {
        return plain(&shape.shape, "is in a file that is read more than once");
    }
    let handles = maker.handles();
    if handles.is_empty() {
        return plain(&shape.shape, "follows from numbers that have no place");
    }
    handles
}

/// Counts the elements that the command of an element makes: a curve has one for each three points
/// after the first.
fn parts(seen: &Provenance, element: &Element) -> usize {
    if !matches!(element.shape.skeleton(), Some(Skeleton::Curve { .. })) {
        return 1;
    }
    let operands = seen.operands.iter();
    let points = operands
        .filter(|operand| operand.numbers.len() == 3)
        .count();
    points.saturating_sub(1) / 3
}
