//! OBJECTS: groups of shapes and their transforms.

use super::{Evaluator, Flow};
use crate::Severity;
use crate::geometry::Transform;
use crate::problem::{Outcome, Problem};
use crate::reader::Reader;
use crate::syntax::Command;
use std::ops::Range;

/// `chain sn, name`
pub fn chain<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let mut read = run.reader(command);
    let material = read.name("the material's name")?;
    let name = read.name("the chain's name")?;
    read.end()?;
    run.material(&material)?;
    run.model.open(&name, Some(material))?;
    Ok(Flow::Next)
}

/// `object name`
pub fn object<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let mut read = run.reader(command);
    let name = read.name("the object's name")?;
    read.end()?;
    run.model.open(&name, None)?;
    Ok(Flow::Next)
}

/// `close [name]`
pub fn close<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let mut read = run.reader(command);
    let name = if read.more() {
        Some(read.name("the object's name")?)
    } else {
        None
    };
    read.end()?;
    if let (Some(name), Some(innermost)) = (&name, run.model.innermost())
        && name.text != innermost
    {
        return Err(Problem::new(
            name.span.clone(),
            format!("the object that is open here is `{innermost}`"),
        )
        .hint(format!("write `close` or `close {innermost}`")));
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
    let mut read = run.reader(command);
    let old = read.name("the object's name")?;
    let new = if read.more() {
        read.name("the copy's name")?
    } else {
        old.clone()
    };
    read.end()?;
    let range = run.model.find(&old)?;
    charge(run, command, &range)?;
    run.model.copy(range, &new)?;
    Ok(Flow::Next)
}

/// `translate x y z [object]`
pub fn translate<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    transform_by(run, command, |read| {
        Ok(Transform::translation(read.vector("the shift")?))
    })
}

/// `rotate x y z angle [object]`
pub fn rotate<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    transform_by(run, command, |read| {
        let axis = read.direction("the axis")?;
        Ok(Transform::rotation(axis, read.number("the angle")?))
    })
}

/// `scale x y z [object]`
pub fn scale<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    transform_by(run, command, |read| {
        let start = read.start();
        let factors = read.vector("the scale")?;
        if factors.to_array().iter().any(|f| f.abs() < 1e-9) {
            return Err(Problem::new(
                read.since(start),
                "a scale factor must not be 0",
            ));
        }
        Ok(Transform::scaling(factors))
    })
}

/// `transform [object]`: transforms are always applied at once, so this checks the name only.
pub fn transform<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    target(run, command, 0)?;
    Ok(Flow::Next)
}

/// `remove object`
pub fn remove<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let mut read = run.reader(command);
    let name = read.name("the object's name")?;
    read.end()?;
    let range = run.model.find(&name)?;
    charge(run, command, &range)?;
    run.model.remove(range);
    Ok(Flow::Next)
}

fn transform_by<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    make: impl FnOnce(&mut Reader<'_, 'a>) -> Outcome<Transform>,
) -> Outcome<Flow> {
    let mut read = run.reader(command);
    let transform = make(&mut read)?;
    let at = read.at;
    let range = target(run, command, at)?;
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
    run.model.transform(range, &transform);
    Ok(Flow::Next)
}

/// The shapes that a transform is for: the object named from operand `at` on, else the last one.
fn target<'a>(run: &mut Evaluator<'a>, command: &'a Command, at: usize) -> Outcome<Range<usize>> {
    let mut read = run.reader(command);
    read.at = at;
    if !read.more() {
        return run.model.last(&command.word_span);
    }
    let name = read.name("an object's name")?;
    read.end()?;
    run.model.find(&name)
}

/// Work on many shapes counts as many steps.
fn charge(run: &mut Evaluator<'_>, command: &Command, range: &Range<usize>) -> Outcome<()> {
    run.scope
        .step(1 + range.len() as u64 / 4, &command.word_span)
}
