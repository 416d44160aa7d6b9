//! OBJECTS: groups of shapes and their transforms.

use super::model::Group;
use super::state::{Evaluator, Flow};
use crate::Severity;
use crate::commands::build::{clay, flesh, options, row, takes};
use crate::commands::slot::{Named, Placed, Slot, degrees, existing, new, triple, vector};
use crate::commands::{Bracket, CommandSpec, Names};
use crate::geometry::Transform;
use crate::given::Options;
use crate::problem::{Outcome, Problem};
use crate::reader::Name;
use crate::syntax::Command;
use glam::DVec3;
use std::ops::Range;

/// Object that a transform is for.
pub(super) const TARGET: Slot<Option<Named>> =
    existing("object", Names::Object, "an object's name").optional("the last one");

pub static CHAIN: CommandSpec = row(
    "chain",
    "begin shapes of one material, whose name they leave out",
)
.with(takes!(
    chain,
    existing("material", Names::Material, "the material's name"),
    new("name", Names::Object, "the chain's name")
))
.bracket(Bracket::Chain)
.mark_failed(refuse)
.example(flesh!(
    "chain Flesh, LINKS\n  sphere 0.6, -1 0 0\n  sphere 0.6, 0 0 0\n  sphere 0.6, 1 0 0\nclose"
));

fn chain<'a>(
    run: &mut Evaluator<'a>,
    _: &'a Command,
    material: Name<'a>,
    name: Name<'a>,
) -> Outcome<Flow> {
    run.material(&material)?;
    run.model.open(run.file, &name, Group::Chain(material))?;
    Ok(Flow::Next)
}

/// Notes that the `close` of an object that was refused is still to come.
fn refuse<'a>(run: &mut Evaluator<'a>, _: &'a Command) {
    run.model.refused += 1;
}

pub static OBJECT: CommandSpec = row("object", "begin an object")
    .with(takes!(
        |run, _command, name| begin(run, &name, Group::Object),
        new("name", Names::Object, "the object's name")
    ))
    .bracket(Bracket::Object)
    .mark_failed(refuse)
    .details("Objects can stand inside each other, 16 deep at most.")
    .example(clay!(
        "object PAIR\n  sphere Clay 1, -1.5 0 0\n  sphere Clay 1, 1.5 0 0\nclose\n\
         rotate 0 0 1 30, PAIR"
    ));

/// `body name`: an object whose shapes blend with one another and with no others.
pub static BODY: CommandSpec = row("body", "begin a body, whose shapes blend with no others")
    .with(takes!(
        |run, _command, name| begin(run, &name, Group::Body),
        new("name", Names::Object, "the body's name")
    ))
    .bracket(Bracket::Object)
    .mark_failed(refuse)
    .details(
        "Soft shapes of a body flow together; those of two bodies do not, however near they are: \
         legs that touch stay legs. Shapes that stand in no body make one together. A body is an \
         object: it is moved, turned and copied by its name, and a copy is a new body. Objects \
         can stand in bodies and bodies in objects, but no body in a body.",
    )
    .example(flesh!(
        "body LEFT\n  sphere Flesh 1, -0.9 0 0\nclose\nbody RIGHT\n  sphere Flesh 1, 0.9 0 0\n\
         close"
    ));

fn begin<'a>(run: &mut Evaluator<'a>, name: &Name<'a>, group: Group<'a>) -> Outcome<Flow> {
    if let Some(earlier) = run.model.idle_place(name.text).cloned() {
        run.say_made_twice(Severity::Note, name, earlier, || {
            format!(
                "the object `{0}` above stays, but the name `{0}` now means this one",
                name.text
            )
        });
    }
    run.model.open(run.file, name, group)?;
    Ok(Flow::Next)
}

pub static CLOSE: CommandSpec = row("close", "end an object or chain")
    .with(takes!(
        close,
        existing("name", Names::Object, "the object's name").optional("the one that is open")
    ))
    .bracket(Bracket::Close)
    .example(clay!("object BALL\n  sphere Clay 2, 0 0 0\nclose BALL"));

fn close<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    name: Option<Name<'a>>,
) -> Outcome<Flow> {
    if run.model.refused > 0 {
        run.model.refused -= 1;
        return Ok(Flow::Next);
    }
    if let (Some(name), Some((innermost, (file, span)))) = (&name, run.model.innermost())
        && name.text != innermost
    {
        return Err(Problem::new(
            &name.span,
            format!("the object that is open here is `{innermost}`"),
        )
        .hint(format!("write `close` or `close {innermost}`"))
        .with_place(Some(*file), span.clone(), "it begins here"));
    }
    if run.model.close().is_none() {
        return Err(
            Problem::new(&command.word_span, "there is no object to close")
                .hint("begin one with `object name`"),
        );
    }
    Ok(Flow::Next)
}

options! {
    /// Options of `instance`.
    INSTANCE_OPTIONS:
    MOVED: DVec3 = ("translate", "0 0 0", "moves the copy", vector("x y z", "the shift"));
    TURNED: (Placed<DVec3>, Option<f64>) = ("rotate", "0 0 0", "turns the copy",
        AXIS.with_place(), ANGLE.optional("the three numbers are angles"));
    SCALED: Placed<DVec3> = ("scale", "1 1 1", "scales the copy",
        triple("x y z", "the scale").with_place());
}

pub static INSTANCE: CommandSpec = row("instance", "copy an object")
    .with(takes!(
        instance,
        [INSTANCE_OPTIONS],
        existing("name", Names::Object, "the object's name"),
        new("copy", Names::Object, "the copy's name").optional("the same name")
    ))
    .details(
        "The transforms move the copy and leave the object. They are carried out in the order in \
         which they are written; each may be written several times.",
    )
    .example(clay!(
        "object BALL\n  sphere Clay 1, -1.5 0 0\nclose\ninstance BALL, OTHER translate 3 0 0\n\
         instance BALL scale 0.5 0.5 0.5 translate 0.75 1 0"
    ));

fn instance<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    options: &Options<'a>,
    old: Name<'a>,
    new: Option<Name<'a>>,
) -> Outcome<Flow> {
    let mut transforms = Vec::new();
    for chosen in options.iter() {
        transforms.push(if let Some((axis, angle)) = TURNED.of(chosen) {
            turn(axis, angle)?
        } else if let Some(factors) = SCALED.of(chosen) {
            stretch(factors)?
        } else {
            Transform::translation(MOVED.of(chosen).unwrap_or_default())
        });
    }
    let range = run.model.find(&old)?;
    charge(run, command, &range)?;
    run.model.copy(range, &new.unwrap_or(old))?;
    for transform in &transforms {
        transform_by(run, command, None, transform)?;
    }
    Ok(Flow::Next)
}

pub static TRANSLATE: CommandSpec = row("translate", "move an object")
    .with(takes!(
        |run, command, shift, object| {
            transform_by(run, command, object, &Transform::translation(shift))
        },
        vector("x y z", "the shift"),
        TARGET
    ))
    .example(clay!("sphere Clay 1, 0 0 0\ntranslate 1 1 0"));

/// Axis of a turn, or its three angles.
const AXIS: Slot<DVec3> = triple("x y z", "the axis, or three angles about x, y and z");
/// Angle of a turn about an axis.
const ANGLE: Slot<f64> = degrees("angle", "the angle");

pub static ROTATE: CommandSpec = row("rotate", "turn an object about axes through the origin")
    .with(takes!(
        |run, command, axis, angle, object| {
            transform_by(run, command, object, &turn(axis, angle)?)
        },
        AXIS.with_place(),
        ANGLE.optional("the three numbers are angles"),
        TARGET
    ))
    .details(
        "With an angle, `x y z` is the axis. Without one they are angles in degrees: the object is \
         turned about the x axis, then about y, then about z.",
    )
    .example(clay!(
        "cylinder Clay 0.6, <-2 0 0>, <2 0 0>\nrotate 0 0 1 30\n\
         object BAR\n  cylinder Clay 0.3, <-3 0 0>, <3 0 0>\nclose\nrotate 0 20 -45, BAR"
    ));

/// Makes the turn about an axis, or by three angles.
///
/// # Errors
/// If the axis has no length.
fn turn((axis, span): (DVec3, Range<usize>), angle: Option<f64>) -> Outcome<Transform> {
    match (angle, axis.try_normalize()) {
        (None, _) => Ok(Transform::rotations(axis)),
        (Some(angle), Some(axis)) => Ok(Transform::rotation(axis, angle)),
        (Some(_), None) => Err(Problem::new(
            &span,
            "the axis must not be 0 0 0: it is a direction",
        )),
    }
}

pub static SCALE: CommandSpec = row("scale", "scale an object")
    .with(takes!(
        scale,
        triple("x y z", "the scale").with_place(),
        TARGET
    ))
    .details(
        "Radii grow by the mean of the three factors: round shapes stay round, but for balls, \
         which become ellipsoids.",
    )
    .example(clay!("sphere Clay 1, 0 0 0\nscale 2 2 2"));

fn scale<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    factors: (DVec3, Range<usize>),
    object: Option<Name<'a>>,
) -> Outcome<Flow> {
    transform_by(run, command, object, &stretch(factors)?)
}

/// Makes the scaling by three factors.
///
/// # Errors
/// If one of them is 0.
fn stretch((factors, span): (DVec3, Range<usize>)) -> Outcome<Transform> {
    if factors.to_array().iter().any(|f| f.abs() < 1e-9) {
        return Err(Problem::new(&span, "a scale factor must not be 0"));
    }
    Ok(Transform::scaling(factors))
}

/// `explode x y z [object]`: each shape moves away from the middle of the object.
pub static EXPLODE: CommandSpec = row("explode", "move the parts of an object apart")
    .with(takes!(explode, triple("x y z", "the shares"), TARGET))
    .details(
        "Each shape moves away from the middle of the object, by the share x, y, z of its \
         distance along each axis: 0 leaves it, 1 doubles the distance.",
    )
    .example(clay!(
        "object PARTS\n  sphere Clay 0.8, -0.5 0 0\n  sphere Clay 0.8, 0.5 0 0\n  \
         sphere Clay 0.8, 0 0.8 0\nclose\nexplode 2 2 0, PARTS"
    ));

fn explode<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    shares: DVec3,
    object: Option<Name<'a>>,
) -> Outcome<Flow> {
    let range = target(run, command, object.as_ref())?;
    charge(run, command, &range)?;
    let parts = &run.model.parts[range.clone()];
    let centres: Vec<DVec3> = parts.iter().map(|p| p.element.shape.middle()).collect();
    let centre = centres.iter().sum::<DVec3>() / centres.len() as f64;
    // Without shapes there is no middle.
    if !centre.is_finite() {
        return Ok(Flow::Next);
    }
    for (index, place) in range.zip(centres) {
        let shift = Transform::translation((place - centre) * shares);
        run.model.transform(index..index + 1, &shift);
    }
    Ok(Flow::Next)
}

/// `transform [object]`: what has been done to the object so far holds still while the shutter is
/// open.
pub static TRANSFORM: CommandSpec = row(
    "transform",
    "hold an object still while the shutter is open",
)
.with(takes!(transform, TARGET))
.details(
    "Transforms are applied at once. What variables that change with every frame have done to the \
     object so far is then the same for the whole time of the `shutter`; what comes after this is \
     blurred.",
)
.example(clay!(
    "var x = -1.5 += 3\nshutter 1\nsample 3\nobject STILL\n  sphere Clay 1, x 1.2 0\nclose\n\
     transform STILL\nobject MOVING\n  sphere Clay 1, x -1.2 0\nclose"
));

fn transform<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    object: Option<Name<'a>>,
) -> Outcome<Flow> {
    let range = target(run, command, object.as_ref())?;
    charge(run, command, &range)?;
    run.frozen.hold(&mut run.model, range);
    Ok(Flow::Next)
}

pub static REMOVE: CommandSpec = row("remove", "remove an object")
    .with(takes!(
        remove,
        existing("object", Names::Object, "the object's name")
    ))
    .example(clay!(
        "sphere Clay 2, 0 0 0\nobject EXTRA\n  sphere Clay 2, 1 0 0\nclose\nremove EXTRA"
    ));

fn remove<'a>(run: &mut Evaluator<'a>, command: &'a Command, object: Name<'a>) -> Outcome<Flow> {
    let range = run.model.find(&object)?;
    charge(run, command, &range)?;
    run.model.remove(range);
    Ok(Flow::Next)
}

fn transform_by<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    object: Option<Name<'a>>,
    transform: &Transform,
) -> Outcome<Flow> {
    let range = target(run, command, object.as_ref())?;
    charge(run, command, &range)?;
    if !transform.uniform && run.model.has_round(range.clone()) {
        let message = "tubes cannot be stretched: their radii grow by the mean factor";
        run.warn(&command.span, message, "use three equal factors");
    }
    run.model.transform(range, transform);
    Ok(Flow::Next)
}

/// Returns the shapes that a transform is for: the object it names, else the last one.
pub(super) fn target<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    object: Option<&Name<'a>>,
) -> Outcome<Range<usize>> {
    match object {
        Some(name) => run.model.find(name),
        None => run.model.last(&command.word_span),
    }
}

/// Counts work on shapes: a step for each.
fn charge(run: &mut Evaluator<'_>, command: &Command, range: &Range<usize>) -> Outcome<()> {
    run.scope.step(1 + range.len() as u64, &command.word_span)
}

impl Evaluator<'_> {
    /// Warns of objects that no `close` ends.
    pub(super) fn check_open_objects(&mut self) {
        while let Some((name, (file, span))) = self.model.innermost() {
            let (name, file, span) = (name.to_owned(), *file, span.clone());
            self.model.close();
            let message = format_args!("the object `{name}` is never closed");
            self.say_at(
                file,
                Severity::Warning,
                &span,
                message,
                "end it with `close`",
            );
        }
    }
}
