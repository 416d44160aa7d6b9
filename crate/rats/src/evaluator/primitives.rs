//! PRIMITIVES: shapes made of a material.

use super::model::Part;
use super::{Evaluator, Flow};
use crate::Severity;
use crate::commands::CommandSpec;
use crate::geometry::{self, ThreePoints};
use crate::limits::MAX_CORNERS;
use crate::problem::{Outcome, Problem};
use crate::reader::{Name, Reader};
use crate::syntax::Command;
use field::Kernel;
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
        self.add_of(command, material, shape, Kernel::Cauchy, false)
    }

    fn add_of(
        &mut self,
        command: &'a Command,
        material: usize,
        shape: Shape,
        kernel: Kernel,
        is_pipe: bool,
    ) -> Outcome<Flow> {
        let flesh = &self.palette.surfaces[material].material;
        let part = Part {
            tapers: matches!(shape, Shape::Cylinder { .. } | Shape::Arc { .. })
                && (flesh.end_radius.is_some() || flesh.end_blobbiness.is_some()),
            element: Element {
                shape,
                material,
                kernel,
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
    run.add_of(command, material, shape, Kernel::Cauchy, true)
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

/// `polygon sn V1 … Vn [hole W1 … Wm …]`
pub fn polygon<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let (name, mut rings) = operands(run, command, |read| {
        let mut rings = vec![Vec::new()];
        while read.more() {
            if read.keyword("hole") {
                rings.push(Vec::new());
                continue;
            }
            let corner = read.vector("a corner")?;
            rings.last_mut().expect("one at least").push(corner);
        }
        Ok(rings)
    })?;
    let corners: usize = rings.iter().map(Vec::len).sum();
    if corners > MAX_CORNERS {
        return Err(Problem::new(
            command.span.clone(),
            format!("a polygon can have {MAX_CORNERS} corners at most, this one has {corners}"),
        ));
    }
    if rings.iter().any(|ring| ring.len() < 3) {
        return Err(Problem::new(
            command.span.clone(),
            "a polygon, and each hole of it, needs at least three corners",
        ));
    }
    // Each pair of edges is looked at.
    run.scope
        .step((corners * corners / 50) as u64, &command.word_span)?;
    let off = geometry::flatten(&mut rings);
    if geometry::crosses_itself(&rings) {
        return Err(Problem::new(
            command.span.clone(),
            "edges of this polygon cross each other",
        )
        .hint("list the corners in order around it; holes lie inside, apart from each other"));
    }
    if off > 1e-3 {
        run.say(Severity::Warning, command.span.clone(), || {
            (
                String::from("the corners do not lie in one plane: they are moved onto it"),
                Some(format!(
                    "the furthest is {:.1}% of the polygon's size away from it",
                    100.0 * off
                )),
            )
        });
    }
    run.add(command, &name, Shape::Polygon { rings, radius: 0.0 })
}

/// `curve sn b P1 P2 P3 P4 [P5 P6 P7 …]`: cubic Bézier curves, each beginning where the last one ends.
pub fn curve<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let (name, (radius, points)) = operands(run, command, |read| {
        let radius = read.number("the tube radius")?;
        let mut points = vec![read.vector("the first control point")?];
        while points.len() < 4 || read.more() {
            for what in [
                "the second control point",
                "the third control point",
                "the end point",
            ] {
                points.push(read.vector(what)?);
            }
        }
        Ok((radius, points))
    })?;
    for i in (0..points.len() - 1).step_by(3) {
        let control = [points[i], points[i + 1], points[i + 2], points[i + 3]];
        run.add(command, &name, Shape::Curve { control, radius })?;
    }
    Ok(Flow::Next)
}

/// A primitive whose kernel the opcode names, and which has no radius of its own: its material's counts.
fn of_kernel<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    kernel: Kernel,
    rest: fn(&mut Reader<'_, 'a>) -> Outcome<Shape>,
) -> Outcome<Flow> {
    let (name, mut shape) = operands(run, command, rest)?;
    let material = run.material(&name)?;
    let surface = &run.palette.surfaces[material].material;
    if !surface.is_soft() {
        // Drawn as an offset surface, which has a radius.
        if let Shape::Sphere { radius, .. } | Shape::Cylinder { radius, .. } = &mut shape {
            *radius = surface.radius;
        }
    }
    run.add_of(command, material, shape, kernel, false)
}

fn point(read: &mut Reader<'_, '_>) -> Outcome<Shape> {
    Ok(Shape::Sphere {
        center: read.vector("the position")?,
        radius: 0.0,
    })
}

/// `dot sn POS`
pub fn dot<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    of_kernel(run, command, Kernel::Quartic, point)
}

/// `gauss sn POS`
pub fn gauss<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    of_kernel(run, command, Kernel::Gauss, point)
}

/// `line sn BASE APEX`
pub fn line<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    of_kernel(run, command, Kernel::Gauss, |read| {
        Ok(Shape::Cylinder {
            base: read.vector("the base")?,
            apex: read.vector("the apex")?,
            radius: 0.0,
        })
    })
}

/// `triad sn V1 V2 V3`
pub fn triad<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    of_kernel(run, command, Kernel::Inverse, corners)
}
