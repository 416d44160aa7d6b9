//! `skeleton`: subdivision curves through named nodes, with flesh around them.

use super::curves::{END_SHAPE, SCHEMES, ends_of, keep_apart, note_round, weigh};
use super::model::{Group, Part};
use super::skeleton_file::{self, FILE, FILE_OPTIONS, NAME};
use super::state::{Evaluator, Flow};
use crate::commands::build::{by_itself, options, plain, row};
use crate::commands::slot::{Named, Placed, SN, Word, existing, length, new, vector, whole, word};
use crate::commands::{CommandSpec, Names, OptionSpec, Parameter, Role};
use crate::given::{Chosen, Options};
use crate::limits::MAX_BLOCK_OPERANDS;
use crate::problem::{Outcome, Problem};
use crate::reader::Name;
use crate::suggest;
use crate::syntax::Command;
use crate::{is_mesh, is_skeleton};
use field::Kernel;
use glam::{DAffine3, DVec3};
use scene::curves::MOST_FLAT;
use scene::{Curves, Element, Ends, Form, Function, Shape};
use skeleton::{Node, Scheme, Skeleton};
use std::collections::HashMap;
use std::ops::Range;
use std::rc::Rc;
use std::sync::Arc;

/// Levels of subdivision, if the text gives none.
const LEVELS: u32 = 3;
/// Segments that cost as much as a step.
const SEGMENTS_PER_STEP: usize = 4;

options! {
    /// Options of `skeleton`.
    SKELETON_OPTIONS:
    NODE: (Named, DVec3) = ("node", "", "a node, with a name that curves call it by",
        new("A", Names::Node, "the node's name"), vector("P", "the node's place"));
    RADIUS: f64 = ("radius", "the material's",
        "radius of the flesh at the node that stands before it",
        length("r", "the radius at the node").at_least(0.0).role(Role::NodeRadius));
    CURVE: Vec<Named> = ("curve", "",
        "a curve along nodes, two at least: from the first to the last, \
         drawn towards those between",
        existing("A B", Names::Node, "the name of a node").many());
    SUBDIVIDE: u32 = ("subdivide", "3",
        "how often curves are refined: each time doubles their segments",
        whole("n", 0, skeleton::MOST_LEVELS, "how often curves are refined"));
    SCHEME: Word = ("scheme", "cubic", "how curves are refined",
        word("name", SCHEMES, "the scheme's name"));
    LOCAL: Placed<f64> = ("local", "",
        "folds do not blend: at a point only what is within D along the curves counts",
        length("D", "the length along the curves within which flesh \
            blends").at_least(1e-6).with_place());
    BLOCK_ENDS: Word = ("ends", "round", "shape of free ends", END_SHAPE);
}

/// Operands of the form with a block.
const PARAMETERS: &[Parameter] = plain![SN, NAME];

/// Options of both forms, for the manual and the editor.
static ALL_OPTIONS: &[OptionSpec] = plain![
    NODE,
    RADIUS,
    CURVE,
    SUBDIVIDE,
    SCHEME,
    LOCAL,
    BLOCK_ENDS,
    skeleton_file::SCALE,
    skeleton_file::THICKEN,
    skeleton_file::MERGE,
    skeleton_file::SIMPLIFY,
    skeleton_file::MATERIALS,
    skeleton_file::BONDS,
];

/// `skeleton sn, name [option …] { node A <x y z> [radius r] … curve A B … … }`
pub static SKELETON: CommandSpec = row("skeleton", "curves that branch, with flesh around them")
    .with(by_itself(
        skeleton,
        plain![SN, NAME, FILE.optional("")],
        ALL_OPTIONS,
    ))
    .newer()
    .most_operands(MAX_BLOCK_OPERANDS)
    .details(
        "Nodes and curves stand in `{ … }`. A curve begins and ends at its end nodes, passes \
         through nodes that it shares with other curves, which branch there, and is drawn towards \
         all others. A curve that ends where it begins is closed. The radius varies smoothly from \
         node to node. The flesh is soft whatever the material's blobbiness; its kernel is \
         `cubed` unless the material names another. With `local D` only the stretch within D \
         along the curves counts at a point, so that a fold does not blend with what lies beside \
         it; about four radii suit, and less than one makes limbs thinner. A skeleton is an \
         object: it is moved, turned and copied by its name. With `ends flat` the surface ends in \
         a plane at each free end, which meshes have as a group: `inlet`, the widest, `outlet-1` \
         and so on; with `ends open` meshes have a hole there.\n\
         `skeleton sn, name file.swc` has the limbs of a file of the project in place of a block: \
         neurons (.swc), lattices of beams (.3mf), centrelines (.vtp .vtk), trees (.csv), lines \
         with radii (.obj .ply) and molecules (.xyz .pdb). Its limbs are straight, `subdivide 0`, \
         unless the text says otherwise; `subdivide` rounds them through their nodes. Radii are \
         those of the file, times `scale`; `radius NAME` names the array or column that has \
         them. Round free ends reach their radius beyond their node. The surface stands at the \
         radii for the kernel `compact6` and the blobbiness 8, which a material has here that \
         names neither.",
    )
    .example(
        "light White, position 4 8 10\nsurface Flesh, kernel cauchy, diffuse SandyBrown, specular \
         Gray50, shine 40, radius 0.6, blobbiness -2\nskeleton Flesh, HAND {\n  \
         node WRIST <-3 -1 0> radius 0.5\n  node PALM <-0.5 0 0> radius 0.9\n  \
         node TIP <3 1.2 0> radius 0.3\n  node THUMB <0.5 2.4 0> radius 0.3\n  \
         curve WRIST PALM TIP\n  curve PALM THUMB\n}",
    );

fn skeleton<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let is_file = is_file_next(run, command)?;
    let (parameters, options) = match is_file {
        true => (skeleton_file::PARAMETERS, FILE_OPTIONS),
        false => (PARAMETERS, SKELETON_OPTIONS),
    };
    let given = run.read_given_by(command, &SKELETON, parameters, options)?;
    let mut values = given.values();
    let (sn, name) = (values.take(|| SN)?, values.take(|| NAME)?);
    if is_file {
        let file = values.take(|| FILE)?;
        return skeleton_file::add(run, command, &given.options, &[sn, name, file]);
    }
    add_block(run, command, &given.options, sn, name)
}

/// Returns whether a file's name, which has a dot, stands behind those of material and skeleton.
///
/// # Errors
/// If it stands in the place of the skeleton's name, or in quotes.
fn is_file_next(run: &mut Evaluator<'_>, command: &Command) -> Outcome<bool> {
    let mut read = run.reader(command);
    let Ok(sn) = read.name("") else {
        return Ok(false);
    };
    if let Ok(file) = read.file_name("")
        && (is_skeleton(file.text) || is_mesh(file.text))
    {
        let hint = format!("write `skeleton {} NAME {}`", sn.text, file.text);
        return Err(Problem::new(&file.span, "a skeleton has a name before its file").hint(hint));
    }
    let mut read = run.reader(command);
    let is_named = read.name("").is_ok() && read.name("").is_ok();
    let is_word = is_named && read.peek_word().is_some();
    Ok(is_word && read.file_name("")?.text.contains('.'))
}

fn add_block<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    options: &Options<'a>,
    sn: Name<'a>,
    name: Name<'a>,
) -> Outcome<Flow> {
    let material = run.material(&sn)?;
    let flesh = &run.palette.surfaces[material].flesh;
    let mut read = Read {
        nodes: Vec::new(),
        indices: HashMap::new(),
        curves: Vec::new(),
        material: sn.text,
        radius: flesh.radius,
    };
    read.nodes(options)?;
    for chosen in options.iter().filter(|chosen| CURVE.is(chosen)) {
        read.curve(chosen)?;
    }
    if read.curves.is_empty() {
        return Err(
            Problem::new(&command.word_span, "this skeleton has no curves")
                .hint("write `{ node A <0 0 0> node B <1 0 0> curve A B }`"),
        );
    }
    let lonely = read.lonely();
    let names = read.nodes.iter().map(|(name, _)| name.text.to_owned());
    let names = names.collect();
    let mut curves = read.refine(command, options)?;
    let ends = ends_of(options);
    let free = curves.free_nodes();
    if let Some(reach) = options.last(&LOCAL) {
        curves = keep_apart(run, curves, reach)?;
    }
    if ends != Ends::Round {
        let cuts = free.len() <= MOST_FLAT && curves.local.is_none();
        if cuts {
            curves = curves.with_flat(free, ends == Ends::Open);
        } else {
            note_round(run, &name, free.len());
        }
    }
    let segments = curves.polyline().map_or(0, |p| p.segments.len());
    run.scope
        .step((segments / SEGMENTS_PER_STEP) as u64, &command.word_span)?;
    for Name { text, span } in lonely {
        let message = format_args!("no curve goes along the node `{text}`");
        run.warn(&span, message, "name it in a `curve`, or take it out");
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
        limbs: weigh(run, &element),
        element,
        depth: None,
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

/// Content of a block.
struct Read<'a> {
    nodes: Vec<(Name<'a>, Node)>,
    /// The index of each node.
    indices: HashMap<&'a str, usize>,
    /// The place of each curve and the indices of its nodes.
    curves: Vec<(Range<usize>, Vec<usize>)>,
    /// The material's name and radius.
    material: &'a str,
    radius: f64,
}

impl<'a> Read<'a> {
    /// Reads the nodes and their radii.
    fn nodes(&mut self, options: &Options<'a>) -> Outcome<()> {
        let mut is_behind_node = false;
        for chosen in options.iter() {
            if let Some((name, place)) = NODE.of(chosen) {
                self.node(name, place)?;
            } else if let Some(radius) = RADIUS.of(chosen) {
                // It belongs to the node right before it.
                match self.nodes.last_mut() {
                    Some((_, node)) if is_behind_node => node.radius = radius,
                    _ => {
                        return Err(Problem::new(
                            &chosen.span,
                            "this `radius` stands behind no node",
                        )
                        .hint("write `node A <0 0 0> radius 0.5`"));
                    }
                }
            }
            is_behind_node = NODE.is(chosen);
        }
        Ok(())
    }

    /// Adds a node.
    fn node(&mut self, name: Name<'a>, place: DVec3) -> Outcome<()> {
        if let Some(first) = self.indices.get(name.text) {
            let (first, _) = &self.nodes[*first];
            return Err(
                Problem::new(&name.span, format!("there are two nodes `{}`", name.text))
                    .hint("give one of them another name")
                    .with_place(None, first.span.clone(), "the first one"),
            );
        }
        let node = Node {
            position: place,
            radius: self.radius,
        };
        self.indices.insert(name.text, self.nodes.len());
        self.nodes.push((name, node));
        Ok(())
    }

    /// Adds a curve.
    fn curve(&mut self, chosen: &Chosen<'a>) -> Outcome<()> {
        let names = CURVE.of(chosen).unwrap_or_default();
        let along: Vec<usize> = names.iter().map(|n| self.find(n)).collect::<Outcome<_>>()?;
        if along.len() < 2 {
            return Err(Problem::new(
                &(chosen.span.start..names.last().map_or(chosen.span.end, |n| n.span.end)),
                "a curve goes along two nodes or more",
            )
            .hint("write `curve A B`"));
        }
        if along.iter().all(|&index| self.nodes[index].1.radius <= 0.0) {
            let (name, material) = (&names[0], self.material);
            return Err(Problem::new(
                &name.span,
                format!("the node `{}` has no radius, nor has its curve", name.text),
            )
            .hint(format!(
                "write `radius 0.5` behind the node, or give the material `{material}` a radius"
            )));
        }
        self.curves.push((chosen.span.clone(), along));
        Ok(())
    }

    /// Finds the index of a node.
    fn find(&self, name: &Name<'_>) -> Outcome<usize> {
        self.indices.get(name.text).copied().ok_or_else(|| {
            let names = self.nodes.iter().map(|(own, _)| own.text);
            let message = format!("this skeleton has no node `{}`", name.text);
            Problem::new(&name.span, message).maybe_hint(suggest::hint(name.text, names))
        })
    }

    /// Returns the names of nodes that are on no curve.
    fn lonely(&self) -> Vec<Name<'a>> {
        let mut used = vec![false; self.nodes.len()];
        for &index in self.curves.iter().flat_map(|(_, along)| along) {
            used[index] = true;
        }
        let nodes = self.nodes.iter().zip(used);
        let lonely = nodes.filter(|(_, used)| !used);
        lonely.map(|((name, _), _)| name.clone()).collect()
    }

    /// Refines the curves as the options say.
    fn refine(self, command: &Command, options: &Options<'_>) -> Outcome<Curves> {
        let levels = options.last(&SUBDIVIDE).unwrap_or(LEVELS);
        let scheme = match options.last(&SCHEME) {
            Some("chaikin") => Scheme::Chaikin,
            Some("fourpoint") => Scheme::FourPoint,
            _ => Scheme::Cubic,
        };
        let (places, curves): (Vec<_>, Vec<_>) = self.curves.into_iter().unzip();
        let nodes: Vec<Node> = self.nodes.into_iter().map(|(_, node)| node).collect();
        let curves = Curves::new(Skeleton { nodes, curves }, scheme, levels)
            .map_err(|error| Problem::new(&command.word_span, error.to_string()))?;
        // A curve all of whose nodes are at one place has no flesh.
        let lengths = curves.polyline().map_or(&[][..], |p| &p.lengths);
        let flat = lengths.iter().position(|length| *length <= 0.0);
        match flat {
            None => Ok(curves),
            Some(index) => Err(Problem::new(
                &places[index],
                "this curve has no length: its nodes are at the same place",
            )),
        }
    }
}
