//! OBJECTS: groups of shapes and their transforms.

use super::model::Group;
use super::state::{Evaluator, Flow};
use crate::Severity;
use crate::geometry::Transform;
use crate::given::Given;
use crate::problem::{Outcome, Problem};
use crate::syntax::Command;
use glam::DVec3;
use scene::Shape;
use std::ops::Range;

/// `chain sn, name`
pub fn chain<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let opened = run.given(command).and_then(|given| {
        let material = given.name("material");
        run.material(material)?;
        let file = run.file;
        run.model
            .open(file, given.name("name"), Group::Chain(material.clone()))
    });
    opened.inspect_err(|_| run.model.refused += 1)?;
    Ok(Flow::Next)
}

/// `object name`
pub fn object<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    begin(run, command, Group::Object)
}

/// `body name`: an object whose shapes blend with one another and with no others.
pub fn body<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    begin(run, command, Group::Body)
}

fn begin<'a>(run: &mut Evaluator<'a>, command: &'a Command, group: Group<'a>) -> Outcome<Flow> {
    let opened = run.given(command).and_then(|given| {
        let name = given.name("name");
        if let Some(earlier) = run.model.unnamed(name.text).cloned() {
            run.say_made_twice(Severity::Note, name, earlier, || {
                format!(
                    "the object `{0}` above stays, but the name `{0}` now means this one",
                    name.text
                )
            });
        }
        run.model.open(run.file, name, group)
    });
    // Its `close` will come all the same.
    opened.inspect_err(|_| run.model.refused += 1)?;
    Ok(Flow::Next)
}

/// `close [name]`
pub fn close<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let given = run.given(command)?;
    if run.model.refused > 0 {
        run.model.refused -= 1;
        return Ok(Flow::Next);
    }
    if let (Some(name), Some((innermost, (file, span)))) =
        (given.maybe_name("name"), run.model.innermost())
        && name.text != innermost
    {
        return Err(Problem::new(
            name.span.clone(),
            format!("the object that is open here is `{innermost}`"),
        )
        .hint(format!("write `close` or `close {innermost}`"))
        .related(Some(*file), span.clone(), "it begins here"));
    }
    if run.model.close().is_none() {
        return Err(
            Problem::new(command.word_span.clone(), "there is no object to close")
                .hint("begin one with `object name`"),
        );
    }
    Ok(Flow::Next)
}

/// `instance name [new name]`
pub fn instance<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let given = run.given(command)?;
    let old = given.name("name");
    let new = given.maybe_name("copy").unwrap_or(old);
    let range = run.model.find(old)?;
    charge(run, command, &range)?;
    run.model.copy(range, new)?;
    Ok(Flow::Next)
}

/// `translate x y z [object]`
pub fn translate<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let given = run.given(command)?;
    let transform = Transform::translation(given.vector("x y z"));
    transform_by(run, command, &given, &transform)
}

/// `rotate x y z angle [object]`
pub fn rotate<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let given = run.given(command)?;
    let transform = Transform::rotation(given.vector("x y z"), given.number("angle"));
    transform_by(run, command, &given, &transform)
}

/// `scale x y z [object]`
pub fn scale<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let given = run.given(command)?;
    let factors = given.vector("x y z");
    if factors.to_array().iter().any(|f| f.abs() < 1e-9) {
        return Err(Problem::new(
            given.span("x y z").unwrap_or_else(|| command.span.clone()),
            "a scale factor must not be 0",
        ));
    }
    transform_by(run, command, &given, &Transform::scaling(factors))
}

/// `explode x y z [object]`: each shape moves away from the middle of the object.
pub fn explode<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let given = run.given(command)?;
    let shares = given.vector("x y z");
    let range = target(run, command, &given)?;
    charge(run, command, &range)?;
    let parts = &run.model.parts[range.clone()];
    let centres: Vec<DVec3> = parts.iter().map(|p| middle(&p.element.shape)).collect();
    let Some(centre) = (!centres.is_empty())
        .then(|| centres.iter().sum::<DVec3>() / centres.len() as f64)
        .filter(|centre| centre.is_finite())
    else {
        return Ok(Flow::Next);
    };
    for (index, place) in range.zip(centres) {
        let shift = Transform::translation((place - centre) * shares);
        run.model.transform(index..index + 1, &shift);
    }
    Ok(Flow::Next)
}

/// The middle of a shape's skeleton.
fn middle(shape: &Shape) -> DVec3 {
    match shape {
        Shape::Sphere { center, .. } => *center,
        Shape::Cylinder { base, apex, .. }
        | Shape::Pipe { base, apex, .. }
        | Shape::Cone { base, apex, .. } => (*base + *apex) * 0.5,
        Shape::Box { center, .. } => *center,
        Shape::Quadric(quadric) => quadric.center,
        Shape::Function(function) => function.middle(),
        Shape::Arc {
            center,
            u,
            v,
            sweep,
            angle,
            ..
        } => *center + (*u * libm::cos(0.5 * angle) + *v * libm::sin(0.5 * angle)) * *sweep,
        Shape::Triangle { corners, .. } | Shape::Patch { corners, .. } => {
            corners.iter().sum::<DVec3>() / 3.0
        }
        Shape::Polygon { rings, .. } => rings.first().map_or(DVec3::ZERO, |ring| {
            ring.iter().sum::<DVec3>() / ring.len().max(1) as f64
        }),
        Shape::Curve { control, .. } => control.iter().sum::<DVec3>() / 4.0,
        Shape::Plane { point, .. } => *point,
    }
}

/// `transform [object]`: transforms are always applied at once, so this checks the name only.
pub fn transform<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let given = run.given(command)?;
    target(run, command, &given)?;
    Ok(Flow::Next)
}

/// `remove object`
pub fn remove<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let given = run.given(command)?;
    let range = run.model.find(given.name("object"))?;
    charge(run, command, &range)?;
    run.model.remove(range);
    Ok(Flow::Next)
}

fn transform_by<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    given: &Given<'a>,
    transform: &Transform,
) -> Outcome<Flow> {
    let range = target(run, command, given)?;
    charge(run, command, &range)?;
    if !transform.uniform && run.model.has_round(range.clone()) {
        run.say(Severity::Warning, command.span.clone(), || {
            (
                String::from(
                    "round shapes cannot be stretched: their radii grow by the mean factor",
                ),
                Some(String::from("use three equal factors")),
            )
        });
    }
    run.model.transform(range, transform);
    Ok(Flow::Next)
}

/// The shapes that a transform is for: the object it names, else the last one.
fn target<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    given: &Given<'a>,
) -> Outcome<Range<usize>> {
    match given.maybe_name("object") {
        Some(name) => run.model.find(name),
        None => run.model.last(&command.word_span),
    }
}

/// Work on many shapes counts as many steps.
fn charge(run: &mut Evaluator<'_>, command: &Command, range: &Range<usize>) -> Outcome<()> {
    run.scope.step(1 + range.len() as u64, &command.word_span)
}

impl Evaluator<'_> {
    /// Warns of objects that no `close` ends.
    pub(super) fn check_open_objects(&mut self) {
        while let Some((name, (file, span))) = self.model.innermost() {
            let (name, file, span) = (name.to_owned(), *file, span.clone());
            self.model.close();
            self.say_at(file, Severity::Warning, span, || {
                (
                    format!("the object `{name}` is never closed"),
                    Some(String::from("end it with `close`")),
                )
            });
        }
    }
}
