//! Curves with flesh around them, whether a block or a file says them.

use super::state::Evaluator;
use crate::commands::OptionSpec;
use crate::commands::build::{options, plain, word_of};
use crate::commands::slot::{Slot, Word, length, word};
use crate::given::Options;
use crate::limits::CURVE_WEIGHT;
use crate::problem::{Outcome, Problem};
use crate::reader::Name;
use crate::syntax::Command;
use field::{Shaping, Taper};
use scene::curves::MOST_FLAT;
use scene::{Curves, Element, Ends};
use std::ops::Range;

/// Schemes of subdivision.
pub(super) const SCHEMES: &[OptionSpec] = &[
    word_of("cubic", "the smoothest: cubic B-splines"),
    word_of(
        "chaikin",
        "nearer to the nodes: corners are cut, quadratic B-splines",
    ),
    word_of("fourpoint", "through every node"),
];

/// Shapes of free ends.
const END_SHAPES: &[OptionSpec] = &[
    word_of("round", "the surface goes on beyond a free end"),
    word_of(
        "flat",
        "the surface ends in a plane through the free end, across its limb",
    ),
    word_of(
        "open",
        "as flat ones, but meshes have holes there; pictures show the planes",
    ),
];

/// Shape of free ends.
pub(super) const END_SHAPE: Slot<Word> = word("shape", END_SHAPES, "`round`, `flat` or `open`");

options! {
    /// Options of a limb by itself.
    LIMB_OPTIONS:
    ENDS: Word = ("ends", "round", "shape of its ends, where it is soft", END_SHAPE);
    DEPTH: f64 = ("depth", "",
        "depth of influence, in place of its radius, where it is soft (ours)",
        length("d", "the depth").at_least(1e-9));
}

/// Options of a point.
pub static POINT_OPTIONS: &[OptionSpec] = plain![DEPTH];

impl Evaluator<'_> {
    /// Gives the shapes that a command has added, those from `first` on, the depth of influence
    /// that its options say.
    pub(super) fn keep_depth(&mut self, command: &Command, options: &Options<'_>, first: usize) {
        let Some(depth) = options.last(&DEPTH) else {
            return;
        };
        let (mut is_kept, mut is_soft) = (true, true);
        for part in &mut self.model.parts[first..] {
            let bone = part.element.shape.bone();
            let fits =
                part.element.flesh.is_some() && bone.is_some_and(|bone| bone.end_radius.is_none());
            part.depth = fits.then_some(depth);
            is_kept &= fits;
            is_soft &= part.element.flesh.is_some();
        }
        if !is_kept {
            let message = "a `depth` is for soft shapes of one radius: this one keeps its own";
            let hint = match is_soft {
                true => "give it one radius",
                false => "give its material a `blobbiness`",
            };
            self.warn(&command.word_span, message, hint);
        }
    }
}

/// Returns the shape of free ends that a text asks for; round if it asks for none.
pub(super) fn ends_of(options: &Options<'_>) -> Ends {
    match options.last(&ENDS) {
        Some("flat") => Ends::Lids,
        Some("open") => Ends::Open,
        _ => Ends::Round,
    }
}

/// Notes that the flat ends of a skeleton are round.
pub(super) fn note_round(run: &mut Evaluator<'_>, name: &Name<'_>, count: usize) {
    let message = format!(
        "{}: {count} flat ends are round: {MOST_FLAT} may be cut by a plane, and none where \
         `local` counts",
        name.text
    );
    run.note(&name.span, message, "");
}

/// Returns the number of shapes as which the limbs of an element count: those that taper count as
/// [`CURVE_WEIGHT`], unless they are [cones](Shaping::is_cone).
pub(super) fn weigh(run: &Evaluator<'_>, element: &Element) -> usize {
    let flesh = element
        .flesh
        .map(|material| &run.palette.surfaces[material as usize].flesh);
    let (Some(curves), Some(flesh)) = (element.shape.curves(), flesh) else {
        return 0;
    };
    let blobbiness = flesh.blobbiness.unwrap_or(scene::curves::BLOBBINESS);
    let mut weight = 0;
    for [(base, start), (apex, end)] in curves.pieces() {
        let shaping = Shaping {
            kernel: flesh.kernel.unwrap_or(element.kernel),
            radius: start,
            blobbiness,
            blob_scale: run.settings.blob_scale,
            strength: 1.0,
            influence: run.settings.influence,
            taper: Some(Taper {
                radius: end,
                blobbiness,
            }),
        };
        let is_one = start == end || shaping.is_cone(&field::Skeleton::Segment { base, apex });
        weight += if is_one { 1 } else { CURVE_WEIGHT };
    }
    weight
}

/// Length along its curves within which flesh blends as if all of it counted, in its largest radii.
const SUITABLE_REACH: f64 = 4.0;
/// Least length along its curves within which flesh may blend, in its largest radii.
const LEAST_REACH: f64 = 0.2;

/// Returns curves whose flesh blends within a reach along them. Refuses a reach within which so few
/// of the field's sources count that no flesh is left, and warns of one that leaves it thinner than
/// the radii say.
pub(super) fn keep_apart(
    run: &mut Evaluator<'_>,
    curves: Curves,
    (reach, span): (f64, Range<usize>),
) -> Outcome<Curves> {
    let thickest = curves.points().fold(0.0, |most: f64, (_, r)| most.max(r));
    let flesh =
        format_args!("flesh as thick as {thickest} blends along {reach} of its curves only");
    if reach < LEAST_REACH * thickest {
        let hint = "let it blend about as far as it is thick, and a fifth of that at least";
        return Err(Problem::new(&span, format!("{flesh}, and vanishes")).hint(hint));
    }
    if reach < thickest {
        let enough = (1e3 * SUITABLE_REACH * thickest - 1e-6).ceil() / 1e3;
        let message = format_args!("{flesh}, and is thinner than that");
        run.warn(&span, message, format_args!("write `local {enough}`"));
    }
    Ok(curves.within(reach))
}
