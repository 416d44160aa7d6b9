//! PRIMITIVES: shapes made of a material.

use super::model::Part;
use super::{Evaluator, Flow};
use crate::Severity;
use crate::commands::CommandSpec;
use crate::geometry::{self, ThreePoints};
use crate::problem::{Outcome, Problem};
use crate::reader::{Name, Reader};
use crate::syntax::Command;
use scene::{Element, Shape};

/// Reads the material's name, which shapes of a chain leave out, then the rest.
fn operands<'a, T>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    rest: impl FnOnce(&mut Reader<'_, 'a>) -> Outcome<T>,
) -> Outcome<(Name<'a>, T)> {
    let chain = run.model.chain.clone();
    let in_chain = chain.is_some();
    let name = match chain {
        Some(name) => name,
        None => run.reader(command).name("the material's name")?,
    };
    // `sphere 1 0 0 0`: better say this than that a coordinate is missing at the end.
    if name.text.parse::<f64>().is_ok() && !run.palette.has(name.text) {
        return Err(Problem::new(
            name.span,
            format!("expected the material's name, found `{}`", name.text),
        )
        .maybe_hint(command.spec.map(CommandSpec::usage)));
    }
    let mut read = run.reader(command);
    if !in_chain {
        read.name("the material's name")?;
    }
    let rest = rest(&mut read)?;
    read.end()?;
    Ok((name, rest))
}

impl<'a> Evaluator<'a> {
    fn add(&mut self, command: &'a Command, name: &Name<'a>, shape: Shape) -> Outcome<Flow> {
        let material = self.material(name)?;
        self.add_of(command, material, shape, false)
    }

    fn add_of(
        &mut self,
        command: &'a Command,
        material: usize,
        shape: Shape,
        is_pipe: bool,
    ) -> Outcome<Flow> {
        let part = Part {
            element: Element {
                shape,
                material,
                origin: self.origin(command),
            },
            growth: 1.0,
            is_pipe,
            removed: false,
        };
        self.model.push(part, &command.span)?;
        self.palette.surfaces[material].used = true;
        Ok(Flow::Next)
    }
}

/// `sphere sn r POS`
pub fn sphere<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let (name, (radius, center)) = operands(run, command, |read| {
        Ok((read.number("the radius")?, read.vector("the centre")?))
    })?;
    run.add(command, &name, Shape::Sphere { center, radius })
}

fn cylinder_operands<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
) -> Outcome<(Name<'a>, Shape)> {
    operands(run, command, |read| {
        Ok(Shape::Cylinder {
            radius: read.number("the radius")?,
            base: read.vector("the base")?,
            apex: read.vector("the apex")?,
        })
    })
}

/// `cylinder sn r BASE APEX`
pub fn cylinder<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let (name, shape) = cylinder_operands(run, command)?;
    run.add(command, &name, shape)
}

/// `pipe sn r BASE APEX`: drawn with lids, which soft ones do not show.
pub fn pipe<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let (name, shape) = cylinder_operands(run, command)?;
    let material = run.material(&name)?;
    if !run.palette.surfaces[material].material.is_soft() {
        run.say(Severity::Warning, command.word_span.clone(), || {
            (
                String::from("a hard pipe is drawn as a cylinder, with lids, in this version"),
                None,
            )
        });
    }
    run.add_of(command, material, shape, true)
}

/// `arc sn a b P N a1 a2`
pub fn arc<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let (name, (shape, width)) = operands(run, command, |read| {
        let sweep = read.number("the sweep radius")?;
        let radius = read.number("the tube radius")?;
        let center = read.vector("the centre")?;
        let normal = read.direction("the normal")?;
        let start = read.number("the start angle")?;
        let width = read.number("the width, an angle")?;
        let shape = geometry::arc(center, normal, sweep, radius, start, width);
        Ok((shape, width))
    })?;
    if width.abs() > 360.0 {
        run.say(Severity::Warning, command.span.clone(), || {
            (
                format!("an arc of {width} degrees is a full circle"),
                Some(String::from(
                    "the last number is the arc's width, not its last angle; 360 is the most",
                )),
            )
        });
    }
    run.add(command, &name, shape)
}

/// `arch sn b P1 P2 P3`
pub fn arch<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let (name, (radius, points)) = operands(run, command, |read| {
        let radius = read.number("the tube radius")?;
        let points = [
            read.vector("the first point")?,
            read.vector("the second point")?,
            read.vector("the third point")?,
        ];
        Ok((radius, points))
    })?;
    let [a, b, c] = points;
    match geometry::through(a, b, c, radius) {
        ThreePoints::Arc(shape) => run.add(command, &name, shape),
        ThreePoints::Line(base, apex) => {
            run.say(Severity::Warning, command.span.clone(), || {
                (
                    String::from("the three points lie on a line: a straight cylinder is drawn"),
                    None,
                )
            });
            run.add(command, &name, Shape::Cylinder { base, apex, radius })
        }
        ThreePoints::Same => Err(Problem::new(
            command.span.clone(),
            "an arch needs three different points",
        )),
    }
}

/// `torus sn a b POS NORM`
pub fn torus<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let (name, shape) = operands(run, command, |read| {
        let sweep = read.number("the sweep radius")?;
        let radius = read.number("the tube radius")?;
        let center = read.vector("the centre")?;
        let normal = read.direction("the normal")?;
        Ok(geometry::arc(center, normal, sweep, radius, 0.0, 360.0))
    })?;
    run.add(command, &name, shape)
}

fn corners(read: &mut Reader<'_, '_>) -> Outcome<Shape> {
    Ok(Shape::Triangle {
        corners: [
            read.vector("the first corner")?,
            read.vector("the second corner")?,
            read.vector("the third corner")?,
        ],
        radius: 0.0,
    })
}

/// `triangle sn V1 V2 V3`
pub fn triangle<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let (name, shape) = operands(run, command, corners)?;
    run.add(command, &name, shape)
}

/// `plane sn POS NORM`
pub fn plane<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let (name, shape) = operands(run, command, |read| {
        Ok(Shape::Plane {
            point: read.vector("a point of the plane")?,
            normal: read.direction("the normal")?,
            radius: 0.0,
        })
    })?;
    run.add(command, &name, shape)
}

/// A primitive whose kernel the opcode names and which this version does not have: drawn if its material
/// names another kernel.
fn of_other_kernel<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    kernel: &str,
    rest: fn(&mut Reader<'_, 'a>) -> Outcome<Shape>,
) -> Outcome<Flow> {
    let (name, mut shape) = operands(run, command, rest)?;
    let material = run.material(&name)?;
    let surface = &run.palette.surfaces[material];
    if !surface.kernel_given {
        let word = run.scope.symbols.word(command.word);
        run.say(Severity::Warning, command.word_span.clone(), || {
            (
                format!(
                    "`{word}` is understood but not carried out in this version: its kernel is {kernel}"
                ),
                Some(format!(
                    "write `kernel cauchy` in the material `{}` to draw it with that kernel",
                    name.text
                )),
            )
        });
        return Ok(Flow::Next);
    }
    // These have no radius of their own.
    if let Shape::Sphere { radius, .. } | Shape::Cylinder { radius, .. } = &mut shape {
        *radius = surface.material.radius;
    }
    run.add_of(command, material, shape, false)
}

fn point(read: &mut Reader<'_, '_>) -> Outcome<Shape> {
    Ok(Shape::Sphere {
        center: read.vector("the position")?,
        radius: 0.0,
    })
}

/// `dot sn POS`
pub fn dot<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    of_other_kernel(run, command, "polynomial", point)
}

/// `gauss sn POS`
pub fn gauss<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    of_other_kernel(run, command, "Gaussian", point)
}

/// `line sn BASE APEX`
pub fn line<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    of_other_kernel(run, command, "Gaussian", |read| {
        Ok(Shape::Cylinder {
            base: read.vector("the base")?,
            apex: read.vector("the apex")?,
            radius: 0.0,
        })
    })
}

/// `triad sn V1 V2 V3`
pub fn triad<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    of_other_kernel(run, command, "Newtonian", corners)
}
