//! `skeleton`: subdivision curves through named nodes, with flesh around them.

use super::model::{Group, Part};
use super::primitives::operands;
use super::state::{Evaluator, Flow};
use crate::given::{Chosen, Given};
use crate::problem::{Outcome, Problem};
use crate::reader::Name;
use crate::syntax::Command;
use crate::{Severity, suggest};
use field::Kernel;
use glam::DAffine3;
use scene::{Curves, Element, Form, Function, Shape};
use skeleton::{Node, Scheme, Skeleton};
use std::ops::Range;
use std::rc::Rc;
use std::sync::Arc;

/// Levels of subdivision unless the text says so.
const LEVELS: f64 = 3.0;
/// Segments that cost as much as a step.
const SEGMENTS_PER_STEP: usize = 4;

/// `skeleton sn, name [subdivide n] [scheme name] [local D] { node A <x y z> [radius r] … curve A B … … }`
pub fn skeleton<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let (sn, given) = operands(run, command)?;
    let name = given.name("name").clone();
    let material = run.material(&sn)?;
    let flesh = &run.palette.surfaces[material].flesh;
    let mut read = Read {
        nodes: Vec::new(),
        curves: Vec::new(),
        material: sn.text,
        radius: flesh.radius,
    };
    read.nodes(&given)?;
    for chosen in given.options.iter().filter(|c| c.name == "curve") {
        run.scope
            .step((read.nodes.len() / 8) as u64, &chosen.span)?;
        read.curve(chosen)?;
    }
    if read.curves.is_empty() {
        return Err(
            Problem::new(command.word_span.clone(), "this skeleton has no curves")
                .hint("write `{ node A <0 0 0> node B <1 0 0> curve A B }`"),
        );
    }
    let lonely = read.lonely();
    let names = read.nodes.iter().map(|(name, _)| name.text.to_owned());
    let names = names.collect();
    let curves = read.refined(command, &given)?;
    let segments = curves.polyline().map_or(0, |p| p.segments.len());
    run.scope
        .step((segments / SEGMENTS_PER_STEP) as u64, &command.word_span)?;
    for Name { text, span } in lonely {
        run.say(Severity::Warning, span, || {
            (
                format!("no curve goes along the node `{text}`"),
                Some(String::from("name it in a `curve`, or take it out")),
            )
        });
    }
    run.model.open(run.file, &name, Group::Object)?;
    let element = Element {
        flesh: Some(material as u32),
        finish: material as u32,
        body: run.model.body(),
        kernel: Kernel::Cubed,
        origin: run.origin(command),
        ..Element::new(Shape::Function(Box::new(Function {
            form: Form::Skeleton(Arc::new(curves)),
            to_world: DAffine3::IDENTITY,
        })))
    };
    let part = Part {
        tapers: false,
        element,
        growth: 1.0,
        moved: None,
        repeated: run.repeating > 0 || !run.is_own(),
        removed: false,
        nodes: Some(Rc::new(names)),
        moves: false,
    };
    let pushed = run.model.push(part, &command.span);
    run.model.close();
    pushed?;
    run.palette.surfaces[material].used = true;
    Ok(Flow::Next)
}

/// The least length along its curves within which flesh may blend, in its largest radius.
const LEAST_REACH: f64 = 0.2;

/// What a block says.
struct Read<'a> {
    nodes: Vec<(Name<'a>, Node)>,
    /// For each curve where it stands and the indices of its nodes.
    curves: Vec<(Range<usize>, Vec<usize>)>,
    /// The material's name and radius.
    material: &'a str,
    radius: f64,
}

impl<'a> Read<'a> {
    /// The nodes and their radii.
    fn nodes(&mut self, given: &Given<'a>) -> Outcome<()> {
        let mut before = None;
        for chosen in &given.options {
            match chosen.name {
                "node" => self.node(chosen)?,
                // It belongs to the node right before it.
                "radius" => match (before, self.nodes.last_mut()) {
                    (Some("node"), Some((_, node))) => node.radius = chosen.given.number("r"),
                    _ => {
                        return Err(Problem::new(
                            chosen.span.clone(),
                            "this `radius` stands behind no node",
                        )
                        .hint("write `node A <0 0 0> radius 0.5`"));
                    }
                },
                _ => {}
            }
            before = Some(chosen.name);
        }
        Ok(())
    }

    fn node(&mut self, chosen: &Chosen<'a>) -> Outcome<()> {
        let name = chosen.given.name("A").clone();
        if let Some((first, _)) = self.nodes.iter().find(|(n, _)| n.text == name.text) {
            return Err(Problem::new(
                name.span.clone(),
                format!("there are two nodes `{}`", name.text),
            )
            .hint("give one of them another name")
            .related(None, first.span.clone(), "the first one"));
        }
        let node = Node {
            position: chosen.given.vector("P"),
            radius: self.radius,
        };
        self.nodes.push((name, node));
        Ok(())
    }

    fn curve(&mut self, chosen: &Chosen<'a>) -> Outcome<()> {
        let names = chosen.given.names("A B");
        let along: Vec<usize> = names.iter().map(|n| self.find(n)).collect::<Outcome<_>>()?;
        if along.len() < 2 {
            return Err(Problem::new(
                chosen.span.start..names.last().map_or(chosen.span.end, |n| n.span.end),
                "a curve goes along two nodes or more",
            )
            .hint("write `curve A B`"));
        }
        if along.iter().all(|&index| self.nodes[index].1.radius <= 0.0) {
            let (name, material) = (&names[0], self.material);
            return Err(Problem::new(
                name.span.clone(),
                format!("the node `{}` has no radius, nor has its curve", name.text),
            )
            .hint(format!(
                "write `radius 0.5` behind the node, or give the material `{material}` a radius"
            )));
        }
        self.curves.push((chosen.span.clone(), along));
        Ok(())
    }

    fn find(&self, name: &Name<'_>) -> Outcome<usize> {
        let names = || self.nodes.iter().map(|(own, _)| own.text);
        names().position(|own| own == name.text).ok_or_else(|| {
            Problem::new(
                name.span.clone(),
                format!("this skeleton has no node `{}`", name.text),
            )
            .maybe_hint(suggest::hint(name.text, names()))
        })
    }

    /// The names of nodes that are on no curve.
    fn lonely(&self) -> Vec<Name<'a>> {
        let mut used = vec![false; self.nodes.len()];
        for &index in self.curves.iter().flat_map(|(_, along)| along) {
            used[index] = true;
        }
        let nodes = self.nodes.iter().zip(used);
        let lonely = nodes.filter(|(_, used)| !used);
        lonely.map(|((name, _), _)| name.clone()).collect()
    }

    /// The curves, refined as the options say.
    fn refined(self, command: &Command, given: &Given<'_>) -> Outcome<Curves> {
        let levels = given.option("subdivide");
        let levels = levels.map_or(LEVELS, |chosen| chosen.given.number("n")) as u32;
        let scheme = given.option("scheme");
        let scheme = match scheme.and_then(|chosen| chosen.given.word("name")) {
            Some("chaikin") => Scheme::Chaikin,
            Some("fourpoint") => Scheme::FourPoint,
            _ => Scheme::Cubic,
        };
        let (places, curves): (Vec<_>, Vec<_>) = self.curves.into_iter().unzip();
        let nodes: Vec<Node> = self.nodes.into_iter().map(|(_, node)| node).collect();
        let thickest = nodes
            .iter()
            .fold(0.0, |most: f64, node| most.max(node.radius));
        let mut curves = Curves::new(Skeleton { nodes, curves }, scheme, levels)
            .map_err(|error| Problem::new(command.word_span.clone(), error.to_string()))?;
        if let Some(local) = given.option("local") {
            let reach = local.given.number("D");
            // So few of the field's sources count within less that no flesh is left.
            if reach < LEAST_REACH * thickest {
                return Err(Problem::new(
                    local.given.span("D").unwrap_or_else(|| local.span.clone()),
                    format!(
                        "flesh as thick as {thickest} blends along {reach} of its curves only, and vanishes"
                    ),
                )
                .hint("let it blend about as far as it is thick, and a fifth of that at least"));
            }
            curves = curves.within(reach);
        }
        // A curve all of whose nodes are at one place has no flesh.
        let lengths = curves.polyline().map_or(&[][..], |p| &p.lengths);
        let flat = lengths.iter().position(|length| *length <= 0.0);
        match flat {
            None => Ok(curves),
            Some(index) => Err(Problem::new(
                places[index].clone(),
                "this curve has no length: its nodes are at the same place",
            )),
        }
    }
}
