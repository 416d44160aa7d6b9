//! Handles of the control points of a `deform`.

use super::decimal::{power, write};
use super::handle::{Editable, Handle, Kind, Moves};
use glam::{DAffine3, DVec3};
use rats::limits::MAX_MAGNITUDE;
use rats::provenance::{Number, Source};
use rats::{Deform, Project, TextEdit};

/// Returns the handles of the control points of a deformation, in their order, each where its point
/// is moved to.
#[must_use]
pub fn cage(deform: &Deform) -> Vec<Handle> {
    let count = deform.controls.len();
    let controls = deform.controls.iter().enumerate();
    let handles = controls.map(|(index, control)| {
        let why = if deform.repeated {
            Some("is in a loop or a defined command")
        } else if control.is_literal {
            None
        } else {
            Some("has a move that is computed")
        };
        let span = control.way_span.as_ref().unwrap_or(&control.span);
        let edit = match why {
            Some(why) => Editable::Fixed {
                why: why.to_owned(),
            },
            None => Editable::Literal {
                spans: vec![(deform.origin.file as usize, span.clone())],
            },
        };
        let numbers = control.way.to_array().map(|value| Number {
            value,
            source: Source::Computed(String::from("is one of three")),
        });
        Handle {
            kind: Kind::Point,
            place: control.place + control.way,
            label: format!("control {} of {count}, moved by", index + 1),
            edit,
            numbers: numbers.to_vec(),
            moves: Moves::Freely(DAffine3::from_translation(control.place)),
        }
    });
    handles.collect()
}

/// Computes the change of the text that moves a control point of a deformation to a place; a move
/// is written behind a point that has none. `grain` is as for [`drag`](super::drag()). `None` if
/// the point is fixed, or as near already.
///
/// ```
/// use glam::DVec3;
/// use rats::{Asset, Project};
///
/// let obj = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
/// let asset = Asset::new("leaf.obj", *obj);
/// let text = "surface s, diffuse Red\nmesh s leaf.obj\ndeform { control <1 0 0> }\n";
/// let project = Project::single(text);
/// let compiled = rats::compile_at(&project, &[asset], 0.0);
/// let to = DVec3::new(1.0, 0.0, 0.5);
/// let edit = assist::handles::pull(&project, &compiled.deforms[0], 0, to, 0.01).unwrap();
/// let moved = project.apply(&[edit]);
/// let last = moved.files[0].text.lines().last();
/// assert_eq!(last, Some("deform { control <1 0 0> move <0 0 0.5> }"));
/// ```
#[must_use]
pub fn pull(
    project: &Project,
    deform: &Deform,
    index: usize,
    to: DVec3,
    grain: f64,
) -> Option<TextEdit> {
    let control = deform.controls.get(index)?;
    let file = deform.origin.file as usize;
    let text = &project.files.get(file)?.text;
    if deform.repeated || !control.is_literal || !to.is_finite() {
        return None;
    }
    let grain = power(if grain.is_finite() {
        grain.clamp(1e-12, 1e12)
    } else {
        1e-6
    });
    let way = to - control.place;
    if way.abs().max_element() > MAX_MAGNITUDE
        || (way - control.way).abs().max_element() <= 0.5 * grain
    {
        return None;
    }
    let words = way.to_array().map(|value| write(value, grain)).join(" ");
    Some(match &control.way_span {
        Some(span) => {
            let is_closed = text.get(span.clone())?.starts_with(['<', '{', '(']);
            TextEdit {
                file,
                span: span.clone(),
                text: if is_closed {
                    format!("<{words}>")
                } else {
                    words
                },
            }
        }
        None => TextEdit {
            file,
            span: control.span.end..control.span.end,
            text: format!(" move <{words}>"),
        },
    })
}
