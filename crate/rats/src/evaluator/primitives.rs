//! PRIMITIVES: shapes made of a material.

use super::implicit_mesh;
use super::model::Part;
use super::state::{Evaluator, Flow};
use super::tints;
use crate::Severity;
use crate::geometry::{self, ThreePoints, Transform};
use crate::given::Given;
use crate::limits::MAX_CORNERS;
use crate::problem::{Outcome, Problem};
use crate::reader::Name;
use crate::strokes::{self, Sculpted};
use crate::syntax::Command;
use crate::{assets, is_strokes};
use field::Kernel;
use glam::{DMat3, DVec3};
use mesh::TriangleMesh;
use scene::{Element, Quadric, Shape};
use std::rc::Rc;

/// The operands, and the material's name: the chain's inside a chain, where shapes leave it out.
pub(super) fn operands<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
) -> Outcome<(Name<'a>, Given<'a>)> {
    let given = run.given(command)?;
    let name = match run.model.chain.clone() {
        Some(name) => name,
        None => given.name("sn").clone(),
    };
    run.watch_shape(command, &name, &given);
    Ok((name, given))
}

impl<'a> Evaluator<'a> {
    fn add(&mut self, command: &'a Command, name: &Name<'a>, shape: Shape) -> Outcome<Flow> {
        let material = self.material(name)?;
        self.add_of(command, material, shape, Kernel::Cauchy)
    }

    pub(super) fn add_of(
        &mut self,
        command: &'a Command,
        material: usize,
        shape: Shape,
        kernel: Kernel,
    ) -> Outcome<Flow> {
        let flesh = &self.palette.surfaces[material].flesh;
        let part = Part {
            tapers: match shape {
                Shape::Cylinder { .. } | Shape::Pipe { .. } | Shape::Arc { .. } => {
                    flesh.end_radius.is_some() || flesh.end_blobbiness.is_some()
                }
                Shape::Cone { .. } => flesh.is_soft(),
                _ => false,
            },
            element: Element {
                flesh: flesh.is_soft().then_some(material as u32),
                finish: material as u32,
                body: self.model.body(),
                kernel,
                origin: self.origin(command),
                ..Element::new(shape)
            },
            growth: 1.0,
            moved: None,
            repeated: self.repeating > 0 || !self.is_own(),
            removed: false,
            nodes: None,
            moves: false,
        };
        self.model.push(part, &command.span)?;
        self.palette.surfaces[material].used = true;
        Ok(Flow::Next)
    }
}

/// `sphere sn r POS`
pub fn sphere<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let (name, given) = operands(run, command)?;
    let shape = Shape::Sphere {
        center: given.vector("POS"),
        radius: given.number("r"),
    };
    run.add(command, &name, shape)
}

fn cylinder_of(given: &Given<'_>) -> Shape {
    Shape::Cylinder {
        radius: given.number("r"),
        base: given.vector("BASE"),
        apex: given.vector("APEX"),
    }
}

/// `cylinder sn r BASE APEX`
pub fn cylinder<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let (name, given) = operands(run, command)?;
    run.add(command, &name, cylinder_of(&given))
}

/// `pipe sn r BASE APEX`
pub fn pipe<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let (name, given) = operands(run, command)?;
    let shape = Shape::Pipe {
        radius: given.number("r"),
        base: given.vector("BASE"),
        apex: given.vector("APEX"),
    };
    run.add(command, &name, shape)
}

/// `arc sn a b P N a1 a2`
pub fn arc<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let (name, given) = operands(run, command)?;
    let width = given.number("a2");
    let shape = geometry::arc(
        given.vector("P"),
        given.vector("N"),
        given.number("a"),
        given.number("b"),
        given.number("a1"),
        width,
    );
    if width.abs() > 360.0 {
        let span = given.span("a2").unwrap_or_else(|| command.span.clone());
        run.say(Severity::Warning, span, || {
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
    let (name, given) = operands(run, command)?;
    let radius = given.number("b");
    let [a, b, c] = ["P1", "P2", "P3"].map(|point| given.vector(point));
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
    let (name, given) = operands(run, command)?;
    let shape = geometry::arc(
        given.vector("POS"),
        given.vector("NORM"),
        given.number("a"),
        given.number("b"),
        0.0,
        360.0,
    );
    run.add(command, &name, shape)
}

fn corners(given: &Given<'_>) -> Shape {
    Shape::Triangle {
        corners: ["V1", "V2", "V3"].map(|corner| given.vector(corner)),
        radius: 0.0,
    }
}

/// `triangle sn V1 V2 V3`
pub fn triangle<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let (name, given) = operands(run, command)?;
    run.add(command, &name, corners(&given))
}

/// `plane sn POS NORM`
pub fn plane<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let (name, given) = operands(run, command)?;
    let shape = Shape::Plane {
        point: given.vector("POS"),
        normal: given.vector("NORM"),
        radius: 0.0,
    };
    run.add(command, &name, shape)
}

/// `polygon sn V1 … Vn [hole W1 … Wm …]`
pub fn polygon<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let (name, given) = operands(run, command)?;
    let mut rings = vec![given.vectors("V1")];
    rings.extend(given.options.iter().map(|hole| hole.given.vectors("W1")));
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

/// `curve sn b P1 P2 P3 P4 [P …]`: cubic Bézier curves, each beginning where the last one ends.
pub fn curve<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let (name, given) = operands(run, command)?;
    let radius = given.number("b");
    let mut points: Vec<_> = ["P1", "P2", "P3", "P4"]
        .iter()
        .map(|point| given.vector(point))
        .collect();
    points.extend(given.vectors("P"));
    if points.len() % 3 != 1 {
        let missing = 3 - (points.len() - 1) % 3;
        return Err(Problem::new(
            command.span.clone(),
            format!("the last curve lacks {missing} of its three points"),
        )
        .hint("each curve after the first takes two control points and an end point"));
    }
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
    shape: fn(&Given<'a>) -> Shape,
) -> Outcome<Flow> {
    let (name, given) = operands(run, command)?;
    let mut shape = shape(&given);
    let material = run.material(&name)?;
    let flesh = &run.palette.surfaces[material].flesh;
    if !flesh.is_soft() {
        // Drawn as an offset surface, which has a radius.
        if let Shape::Sphere { radius, .. } | Shape::Cylinder { radius, .. } = &mut shape {
            *radius = flesh.radius;
        }
    }
    run.add_of(command, material, shape, kernel)
}

fn point(given: &Given<'_>) -> Shape {
    Shape::Sphere {
        center: given.vector("POS"),
        radius: 0.0,
    }
}

/// `dot sn POS`
pub fn dot<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    of_kernel(run, command, Kernel::Quartic, |given| point(given))
}

/// `gauss sn POS`
pub fn gauss<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    of_kernel(run, command, Kernel::Gauss, |given| point(given))
}

/// `line sn BASE APEX`
pub fn line<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    of_kernel(run, command, Kernel::Gauss, |given| Shape::Cylinder {
        base: given.vector("BASE"),
        apex: given.vector("APEX"),
        radius: 0.0,
    })
}

/// `triad sn V1 V2 V3`
pub fn triad<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    of_kernel(run, command, Kernel::Inverse, |given| corners(given))
}

/// `cone sn b BASE a APEX`
pub fn cone<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let (name, given) = operands(run, command)?;
    let shape = Shape::Cone {
        base: given.vector("BASE"),
        base_radius: given.number("b"),
        apex: given.vector("APEX"),
        apex_radius: given.number("a"),
    };
    run.add(command, &name, shape)
}

/// A shape that has no skeleton: a soft material makes it no softer.
fn add_hard<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    name: &Name<'a>,
    shape: Shape,
) -> Outcome<Flow> {
    let material = run.material(name)?;
    if run.palette.surfaces[material].flesh.is_soft() {
        let word = run.scope.symbols.word(command.word);
        run.say(Severity::Warning, command.word_span.clone(), || {
            (
                format!("a {word} is no skeleton: it stays hard, whatever its material"),
                Some(String::from("give it a material without blobbiness")),
            )
        });
    }
    run.add(command, name, shape)
}

fn box_between(low: DVec3, high: DVec3) -> Shape {
    let half = (high - low).abs() * 0.5;
    Shape::Box {
        center: (low + high) * 0.5,
        axes: [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| axis * half),
    }
}

/// `box sn PMIN PMAX`
pub fn box_<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let (name, given) = operands(run, command)?;
    let shape = box_between(given.vector("PMIN"), given.vector("PMAX"));
    add_hard(run, command, &name, shape)
}

/// `brick sn x y z`
pub fn brick<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let (name, given) = operands(run, command)?;
    let half = DVec3::from_array(["x", "y", "z"].map(|side| given.number(side))) * 0.5;
    add_hard(run, command, &name, box_between(-half, half))
}

/// `patch sn V1 N1 V2 N2 V3 N3`
pub fn patch<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let (name, given) = operands(run, command)?;
    let shape = Shape::Patch {
        corners: ["V1", "V2", "V3"].map(|corner| given.vector(corner)),
        normals: ["N1", "N2", "N3"].map(|normal| given.vector(normal)),
    };
    run.add(command, &name, shape)
}

/// `quadric sn a b c d e f g h i j [translate XYZ] [scale XYZ] [bounds MIN MAX]`
pub fn quadric<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let (name, given) = operands(run, command)?;
    let [a, b, c, d, e, f, g, h, i, j] =
        ["a", "b", "c", "d", "e", "f", "g", "h", "i", "j"].map(|factor| given.number(factor));
    let square = DMat3::from_cols(
        DVec3::new(a, 0.5 * d, 0.5 * f),
        DVec3::new(0.5 * d, b, 0.5 * e),
        DVec3::new(0.5 * f, 0.5 * e, c),
    );
    let linear = DVec3::new(g, h, i) * 0.5;
    let (low, high) = given
        .option("bounds")
        .map_or((-DVec3::ONE, DVec3::ONE), |bounds| {
            let (low, high) = (bounds.given.vector("MIN"), bounds.given.vector("MAX"));
            (low.min(high), low.max(high))
        });
    let mut quadric = Quadric::new(square, linear, j, low, high).ok_or_else(|| {
        Problem::new(
            command.span.clone(),
            "this quadric is no surface: its factors are all 0, or its box has no volume",
        )
    })?;
    let vector = |option| {
        given
            .option(option)
            .map(|chosen| chosen.given.vector("XYZ"))
    };
    let scale = vector("scale").unwrap_or(DVec3::ONE);
    let shift = vector("translate").unwrap_or(DVec3::ZERO);
    quadric.axes = quadric.axes.map(|axis| axis * scale);
    quadric.center = quadric.center * scale + shift;
    add_hard(run, command, &name, Shape::Quadric(Box::new(quadric)))
}

/// `terra sn fn PMIN PMAX`: an image as a height field, lowest where it is black.
pub fn terra<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let (name, given) = operands(run, command)?;
    let asset = run.asset(given.name("fn"))?;
    run.scope.step(assets::cost(asset), &command.word_span)?;
    let (one, other) = (given.vector("PMIN"), given.vector("PMAX"));
    let (low, size) = (one.min(other), (other - one).abs());
    let mesh = assets::terra(asset, size)
        .map_err(|error| Problem::new(given.name("fn").span.clone(), error.to_string()))?;
    let move_there = Transform::translation(low);
    add_mesh(run, command, &name, &mesh, Some(&move_there))
}

/// `mesh sn fn`, `mesh sn fn metaballs spherical k`, `mesh sn fn metaballs triangular d0 k`
pub fn mesh<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let (name, given) = operands(run, command)?;
    let file = given.name("fn");
    if is_strokes(file.text) {
        let made = sculpted(run, command, file)?;
        if let Some(metaballs) = implicit_mesh::metaballs(&given)? {
            let topology = made.topology().cloned();
            return implicit_mesh::add(run, command, &name, topology, &made.mesh, metaballs);
        }
        return add_mesh(run, command, &name, &made.mesh, None);
    }
    let asset = run.asset(file)?;
    run.scope.step(assets::cost(asset), &command.word_span)?;
    let mesh =
        assets::mesh(asset).map_err(|error| Problem::new(file.span.clone(), error.to_string()))?;
    if let Some(metaballs) = implicit_mesh::metaballs(&given)? {
        let topology = assets::topology(asset).ok().map(|own| (*own).clone());
        return implicit_mesh::add(run, command, &name, topology, &mesh, metaballs);
    }
    add_mesh(run, command, &name, &mesh, None)
}

/// The mesh of a text of strokes. What is wrong with that text is told where it stands.
fn sculpted(run: &mut Evaluator<'_>, command: &Command, name: &Name<'_>) -> Outcome<Rc<Sculpted>> {
    let file = run.strokes(name)?;
    let text = run.sources.all[file].text;
    let steps = 1 + text.len() as u64 / 100;
    run.scope.step(steps, &command.word_span)?;
    let start = match crate::start_file(text) {
        Some(wanted) => run.mesh_beside(file, &wanted),
        None => None,
    };
    if let Some(asset) = start {
        run.scope.step(assets::cost(asset), &command.word_span)?;
    }
    strokes::sculpted(text, start).map_err(|told| {
        for problem in told.iter() {
            let problem = Problem::new(problem.span.clone(), problem.message.clone()).related(
                Some(run.file),
                name.span.clone(),
                "used here",
            );
            run.report.add(file, Severity::Error, problem);
        }
        Problem::follow_up(name.span.clone())
    })
}

/// Adds the triangles of a mesh as one object, named after nothing: it is the last one.
fn add_mesh<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    name: &Name<'a>,
    mesh: &TriangleMesh,
    transform: Option<&Transform>,
) -> Outcome<Flow> {
    let material = run.material(name)?;
    run.scope
        .step(mesh.triangles.len() as u64, &command.word_span)?;
    let tinted = tints::materials(&mut run.palette, name, material, mesh)?;
    let first = run.model.parts.len();
    // Each triangle is one of many from here.
    run.repeating += 1;
    let mut result = Ok(());
    for (index, shape) in assets::shapes(mesh).enumerate() {
        let own = tinted.as_ref().map_or(material, |own| own[index]);
        let shape = match transform {
            Some(transform) => transform.apply(&shape),
            None => shape,
        };
        result = run.add_of(command, own, shape, Kernel::Cauchy).map(drop);
        if result.is_err() {
            break;
        }
        if tinted.is_some()
            && let Some(part) = run.model.parts.last_mut()
        {
            part.element.paint = tints::paint(material, mesh, index);
        }
    }
    run.repeating -= 1;
    run.model.group(first);
    result.map(|()| Flow::Next)
}
