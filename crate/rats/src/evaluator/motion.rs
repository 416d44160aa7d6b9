//! `motion`: skeletons that fall, swing and touch.
//!
//! The state in a frame follows from that in the frame before, so that frames are computed in order
//! from frame 0 on. They are kept, and a text that is compiled again goes on from them. The shapes
//! of frame 0 are the ones that move: in another frame a text whose variables change is run again
//! for them, and for the places of pinned nodes in all frames up to the present one.

use super::model::Part;
use super::state::{Evaluator, Flow};
use crate::commands::build::{options, row, takes};
use crate::commands::slot::{Named, direction, existing, number, triple, vector, whole};
use crate::commands::{CommandSpec, Names};
use crate::given::Options;
use crate::limits::{MAX_MOTION_WORK, MAX_MOTIONS, MAX_PIN_STEPS};
use crate::problem::{Outcome, Problem};
use crate::reader::Name;
use crate::scope::Scope;
use crate::suggest;
use crate::syntax::Command;
use field::Skeleton as Bone;
use glam::{DAffine3, DVec3};
use motion::{Body, MOST_FRAMES, Obstacle, Settings, Setup, Simulation};
use scene::{Curves, Form, Shape};
use skeleton::{Node, Skeleton};
use std::cell::RefCell;
use std::ops::Range;
use std::sync::Arc;

/// Most motions that are kept: all of one text, before and after an edit.
const KEPT: usize = 2 * MAX_MOTIONS;

/// Most places of nodes that are kept, of 24 bytes each: more than one text can have.
const MOST_PLACES: usize = 4_000_000;
/// Depth of flesh in obstacles that is not worth a warning.
const THIN: f64 = 1e-3;
/// Operations as which the room for a node's place counts.
const WORK_PER_NODE: u64 = 100;

/// Work of `motion` in this run.
#[derive(Debug, Default)]
pub struct Moving {
    /// The number of motions.
    count: usize,
    /// The operations up to this frame.
    work: u64,
    /// Frames of a second of the last one.
    rate: Option<f64>,
    /// Whether the run only collects setups, in `found`.
    collects: bool,
    found: Vec<Setup>,
}

impl Moving {
    /// Returns whether anything moves.
    pub fn is_any(&self) -> bool {
        self.count > 0
    }

    /// Returns the frames of a second, as the last motion says.
    pub fn rate(&self) -> Option<f64> {
        self.rate
    }
}

/// Motion and its frames.
struct Kept {
    setup: Setup,
    /// The places of pinned nodes in each frame from frame 1 on; none if they stay.
    pins: Vec<Vec<DVec3>>,
    simulation: Simulation,
    /// The nodes' places in each frame.
    frames: Vec<Vec<DVec3>>,
    /// The first frame in which something was too fast.
    hurried: Option<usize>,
    /// The depth of the flesh in obstacles in frame 0.
    sunk: f64,
}

/// Motions of a text in all its frames.
struct Frames {
    texts: Vec<String>,
    /// The motions in frame 0.
    first: Vec<Setup>,
    /// The places of the pinned nodes of each motion, frame by frame.
    pins: Vec<Vec<Vec<DVec3>>>,
    /// Steps of one run.
    steps: u64,
}

thread_local! {
    static KEEP: RefCell<Vec<Kept>> = const { RefCell::new(Vec::new()) };
    static FRAMES: RefCell<Option<Frames>> = const { RefCell::new(None) };
}

options! {
    /// Options of `motion`.
    MOTION_OPTIONS:
    GRAVITY: DVec3 = ("gravity", "0 -9.81 0", "acceleration of all that falls, lengths per second²",
        triple("V", "the acceleration"));
    DAMPING: f64 = ("damping", "0.2", "share of the speed that air takes in a second",
        number("d", "the damping").at_least(0.0));
    STIFFNESS: f64 = ("stiffness", "1000",
        "force that stretches a curve to twice its length, for nodes of a mean mass of 1",
        number("k", "the stiffness").at_least(0.0));
    BENDING: f64 = ("bending", "0.2",
        "share of the stiffness with which curves resist bending and twisting",
        number("b", "the share").at_least(0.0));
    STEPS: u32 = ("steps", "16", "steps of a frame",
        whole("n", 1, motion::MOST_STEPS, "the steps of a frame"));
    RATE: f64 = ("rate", "25", "frames of a second",
        number("f", "frames of a second").from(0.1, 1000.0));
    FLOOR: (DVec3, DVec3) = ("floor", "none",
        "a floor or wall; the normal points to where there is room; there may be several",
        vector("P", "a point of the floor"), direction("N", "the floor's normal"));
    BOUNCE: f64 = ("bounce", "0", "share of the speed that is left after a blow",
        number("e", "the share").from(0.0, 1.0));
    FRICTION: f64 = ("friction", "0.4", "friction: 0 is ice, 1 is rubber",
        number("m", "the coefficient").from(0.0, 1000.0));
    PIN: Vec<Named> = ("pin", "", "nodes that stay where the text has them, frame by frame",
        existing("A", Names::Node, "the name of a node").many());
    AGAINST: Vec<Named> = ("against", "",
        "objects that stand in the way: boxes, spheres, cylinders, cones, pipes, planes, skeletons",
        existing("object", Names::Object, "an object's name").many());
}

pub static MOTION: CommandSpec = row("motion", "let skeletons fall, swing and touch")
    .with(takes!(
        motion,
        [MOTION_OPTIONS],
        existing("object", Names::Object, "an object's name").any()
    ))
    .newer()
    .details(
        "Stands behind skeletons, and moves the last one or those of the objects it names, \
         together. Nodes are masses and curves are springs; frame 0 has them where the text has \
         them, and each further frame follows from the one before. Floors, the objects of \
         `against` and the flesh of all that moves together, own folds too, push back. A chain of \
         n nodes that hangs is stretched by a share of n·gravity/stiffness at its upper end. \
         Flesh moves at most half its thickness in a step, so that it passes through nothing: \
         fast things need more `steps`. A node that is pinned follows variables that change with \
         the frames. At most 200 nodes move together, 3000 frames long.",
    )
    .example(
        "light White, position 4 8 10\nsurface Flesh, kernel cauchy, diffuse SandyBrown, specular \
         Gray50, shine 40, radius 0.4, blobbiness -2\nskeleton Flesh, TAIL {\n  \
         node ROOT <-3 2 0> radius 0.6\n  \
         node A <-1.5 2.2 0> node B <0 2 0> node C <1.5 2.2 0>\n  node TIP <3 2 0> radius 0.2\n  \
         curve ROOT A B C TIP\n}\nmotion TAIL { gravity 0 -10 0, stiffness 400, steps 20, pin \
         ROOT, floor <0 -2 0> <0 1 0> }",
    );

fn motion<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    options: &Options<'a>,
    objects: Vec<Name<'a>>,
) -> Outcome<Flow> {
    let wanted = Wanted::read(run, command, &objects, options)?;
    if run.moving.count >= MAX_MOTIONS {
        return Err(Problem::new(
            &command.word_span,
            format!("there are more than {MAX_MOTIONS} motions"),
        )
        .hint("name several skeletons in one motion"));
    }
    let number = run.moving.count;
    run.moving.count += 1;
    run.moving.rate = Some(wanted.setup.settings.rate);
    if run.moving.collects {
        run.moving.found.push(wanted.setup);
        return Ok(Flow::Next);
    }
    let Wanted { setup, parts } = wanted;
    let frame = run.moment.ceil().min(f64::from(MOST_FRAMES)) as usize;
    let (setup, pins) = if run.animated && frame > 0 {
        run.motion_and_pins(number, frame)
            .unwrap_or((setup, Vec::new()))
    } else {
        (setup, Vec::new())
    };
    let left = MAX_MOTION_WORK - run.moving.work;
    let moved = advance(setup, pins, run.moment, left)
        .map_err(|error| Problem::new(&command.word_span, error.to_string()))?;
    run.moving.work += moved.work;
    run.warn_of_motion(&command.word_span, &moved);
    let mut places = moved.places.iter().copied();
    for index in parts {
        let part = &mut run.model.parts[index];
        part.moves = true;
        let count = part
            .element
            .shape
            .curves()
            .map_or(0, |c| c.skeleton.nodes.len());
        let own: Vec<DVec3> = places.by_ref().take(count).collect();
        // Frame 0 is the text's to the last bit.
        if run.moment > 0.0 && own.len() == count {
            put(part, &own).map_err(|error| Problem::new(&command.word_span, error.to_string()))?;
        }
    }
    Ok(Flow::Next)
}

/// Motion that a command asks for.
struct Wanted {
    setup: Setup,
    /// The shapes that move, in the order of the setup's bodies.
    parts: Vec<usize>,
}

impl Wanted {
    fn read<'a>(
        run: &mut Evaluator<'a>,
        command: &'a Command,
        names: &[Name<'a>],
        options: &Options<'a>,
    ) -> Outcome<Self> {
        let mut ranges = Vec::new();
        for name in names {
            ranges.push((name.span.clone(), run.model.find(name)?));
        }
        if names.is_empty() {
            ranges.push((
                command.word_span.clone(),
                run.model.last(&command.word_span)?,
            ));
        }
        let shapes = ranges.iter().map(|(_, range)| range.len() as u64);
        run.scope
            .step(1 + shapes.sum::<u64>(), &command.word_span)?;
        let (mut parts, mut bodies) = (Vec::new(), Vec::new());
        for (span, range) in ranges {
            for index in range {
                let part = &run.model.parts[index];
                let Some(curves) = part.element.shape.curves().filter(|_| !part.removed) else {
                    continue;
                };
                if part.moves {
                    return Err(moves_already(span));
                }
                if !parts.contains(&index) {
                    parts.push(index);
                    bodies.push(body(part, curves));
                }
            }
            if parts.is_empty() {
                return Err(Problem::new(&span, "only skeletons move, and here is none")
                    .hint("make one with `skeleton` before, and name it: `motion TAIL { … }`"));
            }
        }
        pin(run, options, &parts, &mut bodies)?;
        let obstacles = obstacles(run, options, &parts)?;
        let nodes: usize = bodies.iter().map(|b| b.skeleton.nodes.len()).sum();
        run.scope.step(8 * nodes as u64, &command.word_span)?;
        Ok(Self {
            setup: Setup {
                bodies,
                obstacles,
                settings: settings(options),
            },
            parts,
        })
    }
}

/// Makes the problem that something cannot be moved twice.
fn moves_already(span: Range<usize>) -> Box<Problem> {
    Problem::new(&span, "this moves already, or is a copy of what does").hint(
        "name all skeletons that move together in one `motion`, and copy what is to move before \
         it moves",
    )
}

/// Returns a skeleton in coordinates of the world.
fn body(part: &Part, curves: &Curves) -> Body {
    let to_world = to_world(part);
    let nodes = curves.skeleton.nodes.iter().map(|node| Node {
        position: to_world.transform_point3(node.position),
        radius: node.radius * part.growth,
    });
    Body {
        skeleton: Skeleton {
            nodes: nodes.collect(),
            curves: curves.skeleton.curves.clone(),
        },
        scheme: curves.scheme,
        pinned: Vec::new(),
    }
}

/// Returns the map from a skeleton's coordinates to those of the world.
fn to_world(part: &Part) -> DAffine3 {
    match &part.element.shape {
        Shape::Function(function) => function.to_world,
        _ => DAffine3::IDENTITY,
    }
}

/// Puts a skeleton's nodes to places in the world.
fn put(part: &mut Part, places: &[DVec3]) -> Result<(), skeleton::Error> {
    if let Shape::Function(function) = &mut part.element.shape
        && let Form::Skeleton(curves) = &mut function.form
    {
        let to_own = function.to_world.inverse();
        let own: Vec<DVec3> = places.iter().map(|p| to_own.transform_point3(*p)).collect();
        *curves = Arc::new(curves.moved(&own)?);
    }
    Ok(())
}

/// Returns the settings that the options give.
fn settings(options: &Options<'_>) -> Settings {
    let usual = Settings::default();
    Settings {
        gravity: options.last(&GRAVITY).unwrap_or(usual.gravity),
        damping: options.last(&DAMPING).unwrap_or(usual.damping),
        stiffness: options.last(&STIFFNESS).unwrap_or(usual.stiffness),
        bending: options.last(&BENDING).unwrap_or(usual.bending),
        bounce: options.last(&BOUNCE).unwrap_or(usual.bounce),
        friction: options.last(&FRICTION).unwrap_or(usual.friction),
        steps: options.last(&STEPS).unwrap_or(usual.steps),
        rate: options.last(&RATE).unwrap_or(usual.rate),
    }
}

/// Pins the nodes of these names.
fn pin<'a>(
    run: &Evaluator<'a>,
    options: &Options<'a>,
    parts: &[usize],
    bodies: &mut [Body],
) -> Outcome<()> {
    let names = |index: usize| run.model.parts[index].nodes.as_deref();
    for name in options.all(&PIN).flatten() {
        let mut found = false;
        for (body, &index) in bodies.iter_mut().zip(parts) {
            let mut own = names(index).into_iter().flatten();
            if let Some(node) = own.position(|own| own == name.text) {
                found = true;
                body.pinned.push(node);
            }
        }
        if !found {
            return Err(no_such_node(&name, parts.iter().filter_map(|&i| names(i))));
        }
    }
    for body in bodies {
        body.pinned.sort_unstable();
        body.pinned.dedup();
    }
    Ok(())
}

/// Makes the problem that no node of a name moves.
fn no_such_node<'n>(name: &Name<'_>, all: impl Iterator<Item = &'n Vec<String>>) -> Box<Problem> {
    let names: Vec<&str> = all.flatten().map(String::as_str).collect();
    Problem::new(&name.span, format!("no node `{}` moves here", name.text))
        .maybe_hint(suggest::hint(name.text, names.iter().copied()))
}

/// Collects floors, walls, and the shapes of objects that stand in the way.
fn obstacles<'a>(
    run: &mut Evaluator<'a>,
    options: &Options<'a>,
    parts: &[usize],
) -> Outcome<Vec<Obstacle>> {
    let mut obstacles = Vec::new();
    for chosen in options.iter() {
        if let Some((point, normal)) = FLOOR.of(chosen) {
            obstacles.push(Obstacle::Plane { point, normal });
        }
        for name in AGAINST.of(chosen).unwrap_or_default() {
            let range = run.model.find(&name)?;
            run.scope.step(1 + range.len() as u64, &name.span)?;
            for index in range {
                let part = &run.model.parts[index];
                if part.removed {
                    continue;
                }
                if part.moves || parts.contains(&index) {
                    return Err(
                        Problem::new(&name.span, format!("`{}` moves itself", name.text)).hint(
                            "skeletons that move together touch anyway: name both in one `motion`",
                        ),
                    );
                }
                if !obstacle(part, &mut obstacles) {
                    return Err(Problem::new(
                        &name.span,
                        format!("`{}` has a shape that cannot stand in the way", name.text),
                    )
                    .hint(
                        "boxes, spheres, cylinders, cones, \
                        pipes, planes and skeletons can; put other \
                           shapes into an object of their own",
                    ));
                }
                if obstacles.len() > motion::MOST_OBSTACLES {
                    let error = motion::Error::Obstacles(obstacles.len());
                    return Err(Problem::new(&name.span, error.to_string()));
                }
            }
        }
    }
    Ok(obstacles)
}

/// Adds a shape to what stands in the way; returns false if it cannot stand there.
fn obstacle(part: &Part, into: &mut Vec<Obstacle>) -> bool {
    match &part.element.shape {
        Shape::Bone(bone) => {
            let [from, to] = bone.radii(bone.radius);
            into.push(match bone.skeleton {
                Bone::Point { center } => rod(center, center, from, to),
                Bone::Segment { base, apex } => rod(base, apex, from, to),
                Bone::Plane { point, normal } => Obstacle::Plane { point, normal },
                _ => return false,
            });
        }
        Shape::Box(cuboid) => into.push(Obstacle::Box {
            center: cuboid.center,
            axes: cuboid.axes,
        }),
        Shape::Function(function) => {
            let Some(curves) = function.curves() else {
                return false;
            };
            into.extend(curves.pieces().map(|[(a, from), (b, to)]| {
                let [a, b] = [a, b].map(|p| function.to_world.transform_point3(p));
                rod(a, b, from * part.growth, to * part.growth)
            }));
        }
        Shape::Quadric(_) => return false,
    }
    true
}

/// Returns an obstacle between two places with the radii there.
fn rod(a: DVec3, b: DVec3, from: f64, to: f64) -> Obstacle {
    Obstacle::Rod {
        ends: [a, b],
        radii: [from, to],
    }
}

/// Motion at a moment.
struct Moved {
    places: Vec<DVec3>,
    work: u64,
    /// The last frame that is computed, if the moment is after it.
    stopped: Option<usize>,
    /// The first frame in which something was too fast.
    hurried: Option<usize>,
    speed_limit: f64,
    /// The depth of the flesh in obstacles in frame 0.
    sunk: f64,
}

/// Computes the places of nodes at a moment, or finds them where they are kept.
fn advance(
    setup: Setup,
    pins: Vec<Vec<DVec3>>,
    moment: f64,
    left: u64,
) -> Result<Moved, motion::Error> {
    KEEP.with_borrow_mut(|keep| {
        // Frames that are computed must be of the same pins, as far as they are wanted.
        let found = keep.iter().position(|kept| {
            let both = kept.pins.len().min(pins.len());
            let same = if pins.is_empty() {
                kept.pins.is_empty()
            } else {
                kept.pins[..both] == pins[..both] && kept.pins.len() >= kept.frames.len() - 1
            };
            kept.setup == setup && (moment <= 0.0 || same)
        });
        match found {
            Some(index) => keep[index..].rotate_left(1),
            None => {
                let simulation = Simulation::new(&setup)?;
                let sunk = simulation.deepest();
                if keep.len() >= KEPT {
                    keep.remove(0);
                }
                keep.push(Kept {
                    frames: vec![simulation.positions().to_vec()],
                    setup,
                    pins: Vec::new(),
                    simulation,
                    hurried: None,
                    sunk,
                });
            }
        }
        let last = keep.len() - 1;
        let kept = &mut keep[last];
        if pins.len() > kept.pins.len() {
            kept.pins = pins;
        }
        let moved = kept.at(moment, left);
        let mut all: usize = keep.iter().map(Kept::places).sum();
        while all > MOST_PLACES && keep.len() > 1 {
            all -= keep.remove(0).places();
        }
        Ok(moved)
    })
}

impl Kept {
    /// Returns the number of places that it keeps.
    fn places(&self) -> usize {
        self.frames.len() * self.simulation.positions().len()
    }

    /// Returns the motion at a moment; computes its frames as far as `left` operations suffice.
    fn at(&mut self, moment: f64, left: u64) -> Moved {
        // Frames that are kept take room.
        let each =
            self.simulation.work() + WORK_PER_NODE * self.simulation.positions().len() as u64;
        let each = each.max(1);
        let most = (left / each).min(u64::from(MOST_FRAMES)) as usize;
        let reached = moment.min(most as f64);
        let (before, behind) = (reached.floor() as usize, reached.ceil() as usize);
        while self.frames.len() <= behind {
            let number = self.frames.len();
            let targets = self.pins.get(number - 1).map_or(&[][..], Vec::as_slice);
            self.simulation.advance(targets);
            self.frames.push(self.simulation.positions().to_vec());
            if self.simulation.is_hurried() {
                self.hurried.get_or_insert(number);
            }
        }
        let share = reached - before as f64;
        let between = self.frames[before].iter().zip(&self.frames[behind]);
        let places = between.map(|(a, b)| if share > 0.0 { a.lerp(*b, share) } else { *a });
        Moved {
            places: places.collect(),
            work: each * behind as u64,
            stopped: (moment > most as f64).then_some(most),
            hurried: self.hurried.filter(|&number| number <= behind),
            speed_limit: self.simulation.speed_limit(),
            sunk: self.sunk,
        }
    }
}

impl Evaluator<'_> {
    /// Finds the motion of this number in frame 0, and the places of its pinned nodes in the frames
    /// up to this one. `None` if there is none in frame 0.
    fn motion_and_pins(&mut self, number: usize, frame: usize) -> Option<(Setup, Vec<Vec<DVec3>>)> {
        FRAMES.with_borrow_mut(|told| {
            let texts = self.sources.all[..self.sources.own].iter();
            let same = told.take().filter(|told| {
                told.texts.len() == self.sources.own
                    && texts.clone().zip(&told.texts).all(|(a, b)| a.text == b)
            });
            let mut now = same.unwrap_or_else(|| Frames {
                texts: texts.clone().map(|s| s.text.to_owned()).collect(),
                first: Vec::new(),
                pins: Vec::new(),
                steps: 0,
            });
            while now.pins.len() <= frame {
                let count = now.pins.len() as u64;
                let is_free = count > 0 && now.first.iter().all(|setup| pins(setup).is_empty());
                if is_free || count * now.steps > MAX_PIN_STEPS {
                    break;
                }
                let scope = Scope::new(self.scope.symbols.clone());
                let mut other = Evaluator::new(self.sources, self.assets, count as f64, scope);
                other.moving.collects = true;
                other.run_all();
                now.steps = now.steps.max(other.scope.steps());
                now.pins.push(other.moving.found.iter().map(pins).collect());
                if count == 0 {
                    now.first = other.moving.found;
                }
            }
            let found = now.at(number, frame);
            *told = Some(now);
            found
        })
    }

    /// Warns where a motion is not what the text asks for.
    fn warn_of_motion(&mut self, span: &Range<usize>, moved: &Moved) {
        if moved.sunk > THIN {
            let depth = format_args!("{:.3} deep in what stands in its way", moved.sunk);
            let message = format_args!("the flesh begins {depth}, and is put out at once");
            self.warn(span, message, "begin farther away");
        } else if let Some(frame) = moved.stopped {
            let message =
                format_args!("this motion is too much work, so it stops in frame {frame}");
            self.warn(span, message, "take fewer nodes or steps");
        } else if self.moment > f64::from(MOST_FRAMES) {
            let message = format_args!(
                "this motion ends with frame {MOST_FRAMES}: later frames are as that one"
            );
            self.warn(span, message, "");
        } else if let Some(frame) = moved.hurried {
            let speed = format_args!("faster than {:.0} units a second", moved.speed_limit);
            let slowed = "and is slowed down to it";
            let message = format_args!("something is {speed} from frame {frame} on, {slowed}");
            self.warn(span, message, "take more `steps`");
        }
    }
}

impl Frames {
    /// Returns the motion of a number in frame 0, and the places of its pinned nodes in the frames
    /// up to one.
    fn at(&self, number: usize, frame: usize) -> Option<(Setup, Vec<Vec<DVec3>>)> {
        let first = self.first.get(number)?.clone();
        let mut last = pins(&first);
        if last.is_empty() {
            return Some((first, Vec::new()));
        }
        let mut all = Vec::with_capacity(frame);
        for index in 1..=frame {
            let now = self.pins.get(index).and_then(|motions| motions.get(number));
            // As many as in frame 0: else they stay.
            if let Some(now) = now.filter(|now| now.len() == last.len()) {
                last.clone_from(now);
            }
            all.push(last.clone());
        }
        Some((first, all))
    }
}

/// Returns the places of the pinned nodes, body by body.
fn pins(setup: &Setup) -> Vec<DVec3> {
    let mut places = Vec::new();
    for body in &setup.bodies {
        let nodes = body.pinned.iter().map(|&node| &body.skeleton.nodes[node]);
        places.extend(nodes.map(|node| node.position));
    }
    places
}
