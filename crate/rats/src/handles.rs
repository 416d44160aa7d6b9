//! The numbers of a shape as places in the world that a hand can move.
//!
//! [`handles`] gives the handles of one element of a compiled scene: points, radii, angles and
//! directions of the command that made it. [`drag`] says how the texts change when a handle is moved:
//! only the numbers that change are replaced, everything else stays as it was written. A number that a
//! variable stands for is moved where the variable is set; one that is computed, or that made several
//! shapes at once, has a handle that says so and cannot be moved.

use crate::commands::Kind as Takes;
use crate::compiled::{Compiled, Placement};
use crate::limits::MAX_MAGNITUDE;
use crate::parser::parse;
use crate::provenance::{Number, Operand, Provenance, Source};
use crate::symbol::Symbols;
use crate::syntax::{Block, Node};
use crate::{Asset, Project, provenance};
use glam::{DAffine3, DMat3, DVec3};
use scene::{Element, Origin, Scene, Shape};
use std::ops::Range;

/// What a handle moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A place: it follows the hand.
    Point,
    /// A direction: the handle turns around the shape's middle.
    Direction,
    /// A radius: the handle moves to and from the middle.
    Length,
    /// An angle of an arc: the handle moves along its circle.
    Angle,
}

/// Whether a handle can be moved.
#[derive(Clone, Debug, PartialEq)]
pub enum Editable {
    /// Yes: these numbers can change, each in a file (an index of [`Project::files`]) at a byte range.
    Literal {
        /// The places.
        spans: Vec<(usize, Range<usize>)>,
    },
    /// No.
    Fixed {
        /// Why not, a sentence's end: "is made in a loop".
        why: String,
    },
}

/// A place that stands for numbers of the text.
#[derive(Clone, Debug)]
pub struct Handle {
    /// What it moves.
    pub kind: Kind,
    /// Where it is, world coordinates.
    pub place: DVec3,
    /// What it is: "the centre".
    pub label: String,
    /// Whether it can be moved.
    pub edit: Editable,
    numbers: Vec<Number>,
    moves: Moves,
}

impl Handle {
    /// Its numbers as the text might give them, short.
    #[must_use]
    pub fn text(&self) -> String {
        let numbers = self.numbers.iter().map(|number| write(number.value, 1e-4));
        numbers.collect::<Vec<_>>().join(" ")
    }
}

/// How a handle's place follows from its numbers.
#[derive(Clone, Copy, Debug)]
enum Moves {
    /// `to_world · (x, y, z)`
    Freely(DAffine3),
    /// `anchor + along·(length·growth)`, `along` being a unit vector.
    Along {
        anchor: DVec3,
        along: DVec3,
        growth: f64,
    },
    /// `anchor + size·linear·(x, y, z)`, made a unit vector before it is multiplied by `size`.
    Around {
        anchor: DVec3,
        linear: DMat3,
        size: f64,
    },
    /// On the circle of an arc: where it starts if `start`, else where it ends.
    Circle {
        center: DVec3,
        u: DVec3,
        v: DVec3,
        sweep: f64,
        angle: f64,
        turns: f64,
        start: bool,
    },
    Nowhere,
}

/// A change of one file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Edit {
    /// Index of the file in [`Project::files`].
    pub file: usize,
    /// The bytes to replace.
    pub span: Range<usize>,
    /// What comes there.
    pub text: String,
}

/// The handles of an element of `compiled.scene`, which came from `project` with these assets, at this
/// frame. `view` is [`scene::Projection::world_from_view`]: knobs for radii lie across the view.
///
/// The text is run once more up to the element's command, so the cost is that of compiling. An index
/// that is none gives no handles.
#[must_use]
pub fn handles(
    project: &Project,
    assets: &[Asset],
    frame: u32,
    compiled: &Compiled,
    element: usize,
    view: &DMat3,
) -> Vec<Handle> {
    let scene = &compiled.scene;
    let (Some(shape), Some(placement)) = (
        scene.elements.get(element),
        compiled.placements.get(element),
    ) else {
        return Vec::new();
    };
    let why = match placement.repeated {
        true => why_repeated(project, shape.origin),
        false => None,
    };
    let Some(seen) = provenance(project, assets, frame, shape.origin) else {
        let why = why.unwrap_or_else(|| String::from("has no numbers of its own in the text"));
        return plain(&shape.shape, &why);
    };
    let siblings = scene
        .elements
        .iter()
        .filter(|e| e.origin == shape.origin)
        .count();
    let maker = Maker {
        scene,
        element: shape,
        placement,
        view,
        seen: &seen,
    };
    if let Some(why) = why {
        let mut handles = plain(&shape.shape, &why);
        handles.extend(maker.shared_radius());
        return handles;
    }
    if !placement.repeated && siblings > parts(&seen) {
        return plain(&shape.shape, "is in a file that is read more than once");
    }
    let handles = maker.handles();
    if handles.is_empty() {
        return plain(&shape.shape, "follows from numbers that have no place");
    }
    handles
}

/// How many elements a command makes.
fn parts(seen: &Provenance) -> usize {
    match seen.spec.name {
        "curve" => {
            let is_point = |operand: &&Operand| operand.numbers.len() == 3;
            let points = seen.operands.iter().filter(is_point).count();
            points.saturating_sub(1) / 3
        }
        _ => 1,
    }
}

/// The places of a shape, none of which can be moved.
fn plain(shape: &Shape, why: &str) -> Vec<Handle> {
    let places = match shape {
        Shape::Sphere { center, .. } | Shape::Box { center, .. } => vec![(*center, "the centre")],
        Shape::Arc {
            center,
            u,
            v,
            sweep,
            angle,
            ..
        } => {
            let at = |share: f64| {
                let (sin, cos) = libm::sincos(share * angle);
                *center + (*u * cos + *v * sin) * *sweep
            };
            vec![
                (at(0.0), "the start"),
                (at(0.5), "the middle"),
                (at(1.0), "the end"),
            ]
        }
        Shape::Cylinder { base, apex, .. }
        | Shape::Cone { base, apex, .. }
        | Shape::Pipe { base, apex, .. } => vec![(*base, "the base"), (*apex, "the apex")],
        Shape::Triangle { corners, .. } | Shape::Patch { corners, .. } => {
            corners.map(|c| (c, "a corner")).to_vec()
        }
        Shape::Polygon { rings, .. } => rings.iter().flatten().map(|c| (*c, "a corner")).collect(),
        Shape::Curve { control, .. } => control.map(|c| (c, "a control point")).to_vec(),
        Shape::Plane { point, .. } => vec![(*point, "a point of the plane")],
        Shape::Quadric(quadric) => vec![(quadric.center, "the centre")],
    };
    let handle = |(place, label): (DVec3, &str)| Handle {
        kind: Kind::Point,
        place,
        label: label.to_owned(),
        edit: Editable::Fixed {
            why: why.to_owned(),
        },
        numbers: Vec::new(),
        moves: Moves::Nowhere,
    };
    places.into_iter().map(handle).collect()
}

/// Why the numbers of a command that made an element differ from one element to the next, if they may.
/// Copies by `instance` share theirs.
fn why_repeated(project: &Project, origin: Origin) -> Option<String> {
    let file = project.files.get(origin.file as usize)?;
    let mut symbols = Symbols::default();
    let syntax = parse(&file.text, &mut symbols);
    let mut block = &syntax.block;
    let mut why = None;
    let at = origin.start as usize;
    'inner: loop {
        for node in block {
            let (head, inside) = match node {
                Node::Command(command) => {
                    if command.span.start == at
                        && let Some(spec) = command.spec.filter(|spec| spec.is_library())
                    {
                        why = Some(format!("is made by the library's `{}`", spec.name));
                    } else if command.span.start == at
                        && let Some(spec) = command.spec
                        && matches!(spec.name, "mesh" | "terra")
                    {
                        why = Some(format!("is made by `{}` from a file", spec.name));
                    } else if command.span.start == at && command.spec.is_none() {
                        why = Some(String::from("is made by a defined command"));
                    }
                    continue;
                }
                Node::For(node) => (&node.head, &node.body),
                Node::If(node) => {
                    let holds = |block: &Block| last_byte(block) >= at;
                    let branch = if holds(&node.then) {
                        &node.then
                    } else {
                        &node.otherwise
                    };
                    (&node.head, branch)
                }
                Node::Define(node) => (&node.head, &node.body),
            };
            if head.span.start <= at && at < last_byte(inside).max(head.span.end) {
                match node {
                    Node::For(_) => why = Some(String::from("is made in a loop")),
                    Node::Define(node) => {
                        let name = symbols.word(node.name);
                        why = Some(format!("is made by the defined command `{name}`"));
                    }
                    _ => {}
                }
                block = inside;
                continue 'inner;
            }
        }
        return why;
    }
}

/// One past the last byte of the last command of a block.
fn last_byte(block: &Block) -> usize {
    block.last().map_or(0, |node| match node {
        Node::Command(command) => command.span.end,
        Node::For(node) => last_byte(&node.body).max(node.head.span.end),
        Node::Define(node) => last_byte(&node.body).max(node.head.span.end),
        Node::If(node) => last_byte(&node.then)
            .max(last_byte(&node.otherwise))
            .max(node.head.span.end),
    })
}

/// Makes the handles of one element.
struct Maker<'a> {
    scene: &'a Scene,
    element: &'a Element,
    placement: &'a Placement,
    view: &'a DMat3,
    seen: &'a Provenance,
}

impl Maker<'_> {
    fn handles(&self) -> Vec<Handle> {
        let mut handles = Vec::new();
        for (index, operand) in self.seen.operands.iter().enumerate() {
            let same = |o: &&Operand| o.meaning == operand.meaning;
            let mut label = operand.meaning.to_owned();
            if self.seen.operands.iter().filter(same).count() > 1 {
                let number = self.seen.operands[..=index].iter().filter(same).count();
                label = format!("{label} ({number})");
            }
            match operand.kind {
                // A quadric's triples are factors and bounds.
                Takes::Vector if matches!(self.element.shape, Shape::Quadric(_)) => {}
                Takes::Vector => handles.push(self.point(operand, label)),
                Takes::Direction => handles.extend(self.direction(operand, label)),
                Takes::Number { .. } => handles.extend(self.number(operand, label)),
                _ => {}
            }
        }
        if self.material_decides() {
            let label = format!("the radius of the material `{}`", self.seen.material);
            let length = self.radius(0.0);
            handles.push(handle(
                Kind::Length,
                label,
                vec![self.seen.radius.clone()],
                length,
            ));
        }
        handles.retain(|handle| handle.place.is_finite());
        handles
    }

    /// The knob of the radius of a shape that a loop or a defined command makes, if the number is written
    /// out or is a variable from outside: then all that is made so follows it.
    fn shared_radius(&self) -> Option<Handle> {
        let mut handle = self.handles().into_iter().find(|handle| {
            let is_radius = handle.label.contains("radius") && !handle.label.contains("sweep");
            handle.kind == Kind::Length && is_radius
        })?;
        let radius = handle.numbers.first()?.value * self.placement.growth;
        let shown = self.scene.radius(self.element);
        let same = (radius - shown).abs() <= 1e-9 * shown.abs();
        if !same || matches!(handle.edit, Editable::Fixed { .. }) {
            return None;
        }
        handle.label += "; of all that are made here";
        Some(handle)
    }

    fn point(&self, operand: &Operand, label: String) -> Handle {
        let moves = Moves::Freely(self.placement.to_world);
        handle(Kind::Point, label, operand.numbers.clone(), moves)
    }

    fn direction(&self, operand: &Operand, label: String) -> Option<Handle> {
        let linear = self.placement.to_world.matrix3;
        let (anchor, linear, size) = match self.element.shape {
            Shape::Arc { center, sweep, .. } => (center, linear, 0.75 * sweep),
            // A normal stays perpendicular to what the map makes of its plane.
            Shape::Plane { point, .. } => {
                (point, linear.inverse().transpose(), self.placement.growth)
            }
            _ => return None,
        };
        let moves = Moves::Around {
            anchor,
            linear,
            size,
        };
        Some(handle(
            Kind::Direction,
            label,
            operand.numbers.clone(),
            moves,
        ))
    }

    /// A radius or an angle of the shape, if it can be seen.
    fn number(&self, operand: &Operand, label: String) -> Option<Handle> {
        let circle = |start: bool| match self.element.shape {
            Shape::Arc {
                center,
                u,
                v,
                sweep,
                angle,
                ..
            } => {
                let width = self.seen.operands.iter().find(|o| o.name == "a2");
                let width = width.map_or(1.0, |width| width.numbers[0].value);
                // Turning a full circle changes nothing.
                let moves = Moves::Circle {
                    center,
                    u,
                    v,
                    sweep,
                    angle,
                    turns: if width < 0.0 { -1.0 } else { 1.0 },
                    start,
                };
                (!start || angle < std::f64::consts::TAU - 1e-3).then_some(moves)
            }
            _ => None,
        };
        let (kind, moves) = match (self.seen.spec.name, operand.name) {
            ("arc", "a1") => (Kind::Angle, circle(true)?),
            ("arc", "a2") => (Kind::Angle, circle(false)?),
            ("arc" | "torus", "a") => (Kind::Length, self.sweep()?),
            ("brick", side) => (Kind::Length, self.side(side)?),
            ("sphere" | "cylinder" | "pipe", "r")
            | ("arc" | "torus" | "arch" | "curve" | "cone", "b")
            | ("cone", "a") => {
                if self.material_decides() {
                    return None;
                }
                let at_apex = operand.name == "a";
                (Kind::Length, self.radius(if at_apex { 1.0 } else { 0.0 }))
            }
            _ => return None,
        };
        Some(handle(kind, label, operand.numbers.clone(), moves))
    }

    /// Whether the radius that counts is the material's.
    fn material_decides(&self) -> bool {
        let material = &self.scene.materials[self.element.material];
        if !material.is_soft()
            || !self.element.shape.has_skeleton()
            || self.seen.radius.value == 0.0 && material.depth == 0.0
        {
            return false;
        }
        let mut wider = self.element.clone();
        match &mut wider.shape {
            Shape::Sphere { radius, .. }
            | Shape::Cylinder { radius, .. }
            | Shape::Arc { radius, .. }
            | Shape::Triangle { radius, .. }
            | Shape::Polygon { radius, .. }
            | Shape::Curve { radius, .. }
            | Shape::Pipe { radius, .. }
            | Shape::Plane { radius, .. } => *radius = 2.0 * *radius + 1.0,
            Shape::Cone {
                base_radius,
                apex_radius,
                ..
            } => {
                *base_radius = 2.0 * *base_radius + 1.0;
                *apex_radius = 2.0 * *apex_radius + 1.0;
            }
            Shape::Box { .. } | Shape::Patch { .. } | Shape::Quadric(_) => {}
        }
        // A shape without a radius of its own (`dot`, `line`) has its material's.
        self.element.shape.radius() == 0.0
            || self.scene.radius(&wider) == self.scene.radius(self.element)
    }

    /// Where the knob of the shape's radius is: on the rim, across the view. `end` is the end of a cone
    /// or limb that tapers, 0 or 1.
    fn radius(&self, end: f64) -> Moves {
        let view = self.view;
        let (right, towards) = (view.x_axis, view.z_axis);
        let tapers = self.scene.materials[self.element.material]
            .end_radius
            .is_some()
            || matches!(self.element.shape, Shape::Cone { .. });
        let share = if tapers { end } else { 0.5 };
        let across = |axis: DVec3| {
            let across = axis.cross(towards).try_normalize().unwrap_or(right);
            if across.dot(right + view.y_axis * 0.5) < 0.0 {
                -across
            } else {
                across
            }
        };
        let (anchor, along) = match &self.element.shape {
            Shape::Sphere { center, .. } => (*center, right),
            Shape::Cylinder { base, apex, .. }
            | Shape::Cone { base, apex, .. }
            | Shape::Pipe { base, apex, .. } => {
                let axis = (*apex - *base).normalize_or(right);
                (base.lerp(*apex, share), across(axis))
            }
            Shape::Arc {
                center,
                u,
                v,
                sweep,
                angle,
                ..
            } => {
                let (sin, cos) = libm::sincos(share * angle);
                let radial = *u * cos + *v * sin;
                let tangent = *v * cos - *u * sin;
                (*center + radial * *sweep, across(tangent))
            }
            Shape::Triangle { corners, .. } | Shape::Patch { corners, .. } => {
                let [a, b, c] = *corners;
                let normal = (b - a).cross(c - a).normalize_or(towards);
                ((a + b + c) / 3.0, normal)
            }
            Shape::Polygon { rings, .. } => {
                let outer = rings.first().map_or(&[][..], Vec::as_slice);
                let first = outer.first().copied().unwrap_or_default();
                let normal: DVec3 = outer
                    .windows(2)
                    .map(|w| (w[0] - first).cross(w[1] - first))
                    .sum();
                let count = outer.len().max(1) as f64;
                let middle = outer.iter().map(|p| *p / count).sum();
                (middle, normal.normalize_or(towards))
            }
            Shape::Curve { control, .. } => {
                let [a, b, c, d] = *control;
                if tapers {
                    (a, across((b - a).normalize_or((d - a).normalize_or(right))))
                } else {
                    let tangent = (c + d - a - b).normalize_or((d - a).normalize_or(right));
                    ((a + 3.0 * (b + c) + d) / 8.0, across(tangent))
                }
            }
            Shape::Plane { point, normal, .. } => (*point, *normal),
            Shape::Box { center, .. } => (*center, right),
            Shape::Quadric(quadric) => (quadric.center, right),
        };
        Moves::Along {
            anchor,
            along,
            growth: self.placement.growth,
        }
    }

    /// Where the knob of a brick's side is: in the middle of a face.
    fn side(&self, name: &str) -> Option<Moves> {
        let Shape::Box { center, axes } = self.element.shape else {
            return None;
        };
        let k = ["x", "y", "z"].iter().position(|side| *side == name)?;
        Some(Moves::Along {
            anchor: center,
            along: axes[k].try_normalize()?,
            // The side is as long as both halves.
            growth: 0.5 * self.placement.to_world.matrix3.col(k).length(),
        })
    }

    /// Where the knob of an arc's sweep radius is: in the middle of the arc.
    fn sweep(&self) -> Option<Moves> {
        let Shape::Arc {
            center,
            u,
            v,
            angle,
            ..
        } = self.element.shape
        else {
            return None;
        };
        let (sin, cos) = libm::sincos(0.5 * angle);
        Some(Moves::Along {
            anchor: center,
            along: u * cos + v * sin,
            growth: self.placement.growth,
        })
    }
}

/// A handle at the place that its numbers give, and whether they can be changed.
fn handle(kind: Kind, mut label: String, numbers: Vec<Number>, moves: Moves) -> Handle {
    let mut spans: Vec<(usize, Range<usize>)> = Vec::new();
    let mut variables: Vec<&str> = Vec::new();
    let mut why: Vec<&str> = Vec::new();
    for number in &numbers {
        match &number.source {
            Source::Literal {
                file,
                span,
                variable,
                ..
            } => {
                let place = (*file, span.clone());
                if spans.contains(&place) {
                    why.push("uses one number twice");
                }
                spans.push(place);
                if let Some(name) = variable
                    && !variables.contains(&name.as_str())
                {
                    variables.push(name);
                }
            }
            Source::Computed(reason) => why.push(reason),
        }
    }
    // A direction's three numbers belong together, and so do numbers that are one in the text.
    let twice = why.contains(&"uses one number twice");
    let edit = if spans.is_empty() || twice || (kind == Kind::Direction && !why.is_empty()) {
        let why = why.first().copied().unwrap_or_default();
        Editable::Fixed {
            why: why.to_owned(),
        }
    } else {
        for (axis, number) in ["x", "y", "z"].iter().zip(&numbers) {
            if numbers.len() == 3
                && let Source::Computed(reason) = &number.source
            {
                label += &format!("; its {axis} {reason}");
            }
        }
        match variables.as_slice() {
            [] => {}
            [name] => label += &format!(" (the variable `{name}`)"),
            names => label += &format!(" (the variables `{}`)", names.join("`, `")),
        }
        Editable::Literal { spans }
    };
    let place = place(&numbers, &moves);
    Handle {
        kind,
        place,
        label,
        edit,
        numbers,
        moves,
    }
}

fn triple(numbers: &[Number]) -> DVec3 {
    match numbers {
        [x, y, z] => DVec3::new(x.value, y.value, z.value),
        _ => DVec3::NAN,
    }
}

fn place(numbers: &[Number], moves: &Moves) -> DVec3 {
    match *moves {
        Moves::Freely(to_world) => to_world.transform_point3(triple(numbers)),
        Moves::Along {
            anchor,
            along,
            growth,
        } => anchor + along * (numbers[0].value * growth),
        Moves::Around {
            anchor,
            linear,
            size,
        } => anchor + (linear * triple(numbers)).normalize_or_zero() * size,
        Moves::Circle {
            center,
            u,
            v,
            sweep,
            angle,
            start,
            ..
        } => {
            let (sin, cos) = libm::sincos(if start { 0.0 } else { angle });
            center + (u * cos + v * sin) * sweep
        }
        Moves::Nowhere => DVec3::NAN,
    }
}

/// The changes of the texts that bring a handle to `to`, or as near as its numbers allow. `grain`, a
/// length of the world above 0 (say, that of a pixel), says how exactly: numbers get no more digits than
/// that needs, and a number that is that near already stays as it is written.
///
/// The changes are in the order of the text, apart from each other; made from the last to the first, no
/// range moves under another. There are none if the handle is fixed, or a number would be out of range.
#[must_use]
pub fn drag(handle: &Handle, to: DVec3, grain: f64) -> Vec<Edit> {
    if matches!(handle.edit, Editable::Fixed { .. }) || !to.is_finite() {
        return Vec::new();
    }
    let grain = if grain.is_finite() {
        grain.clamp(1e-12, 1e12)
    } else {
        1e-6
    };
    let Some(values) = values(handle, to, grain) else {
        return Vec::new();
    };
    let mut edits: Vec<Edit> = Vec::new();
    for (number, (value, grain)) in handle.numbers.iter().zip(values) {
        let Source::Literal {
            file,
            span,
            negated,
            ..
        } = &number.source
        else {
            continue;
        };
        if !value.is_finite() || value.abs() > MAX_MAGNITUDE {
            return Vec::new();
        }
        if (value - number.value).abs() <= 0.5 * grain {
            continue;
        }
        let value = if *negated { -value } else { value };
        edits.push(Edit {
            file: *file,
            span: span.clone(),
            text: write(value, grain),
        });
    }
    edits.sort_by_key(|edit| (edit.file, edit.span.start));
    edits
}

/// The numbers that bring a handle to a place, each with its own grain.
fn values(handle: &Handle, to: DVec3, grain: f64) -> Option<Vec<(f64, f64)>> {
    let numbers = &handle.numbers;
    let first = numbers.first()?.value;
    Some(match handle.moves {
        Moves::Freely(to_world) => {
            let now = triple(numbers);
            let new = now + free_move(&to_world.matrix3, numbers, to - handle.place)?;
            (0..3)
                .map(|k| (new[k], power(grain / to_world.matrix3.col(k).length())))
                .collect()
        }
        Moves::Along {
            anchor,
            along,
            growth,
        } => {
            let grain = power(grain / growth);
            // A shape without a radius is none, and its handle would be lost.
            let least = if first > 0.0 { grain.min(first) } else { grain };
            vec![(((to - anchor).dot(along) / growth).max(least), grain)]
        }
        Moves::Around { anchor, linear, .. } => {
            let length = triple(numbers).length();
            let new = (linear.inverse() * (to - anchor)).try_normalize()? * length;
            let grain = power(length * 1e-3);
            new.to_array().map(|x| (x, grain)).to_vec()
        }
        Moves::Circle {
            center,
            u,
            v,
            sweep,
            angle,
            turns,
            start,
        } => {
            let from = to - center;
            let (x, y) = (from.dot(u), from.dot(v));
            if x == 0.0 && y == 0.0 {
                return None;
            }
            let turned = libm::atan2(y, x);
            let grain = power((grain / sweep).to_degrees().clamp(1e-6, 1.0));
            if start {
                vec![(first + turns * turned.to_degrees(), grain)]
            } else {
                const TURN: f64 = std::f64::consts::TAU;
                let near = turned + ((angle - turned) / TURN).round() * TURN;
                let width = near.to_degrees().clamp(1.0, 360.0);
                vec![(turns * width, grain)]
            }
        }
        Moves::Nowhere => return None,
    })
}

/// The change of the numbers that can change which comes nearest to moving their point by `moved`.
fn free_move(linear: &DMat3, numbers: &[Number], moved: DVec3) -> Option<DVec3> {
    let free: Vec<usize> = (0..3)
        .filter(|k| matches!(numbers[*k].source, Source::Literal { .. }))
        .collect();
    let column = |k: usize| linear.col(k);
    let mut change = DVec3::ZERO;
    match *free {
        [k] => change[k] = column(k).dot(moved) / column(k).length_squared(),
        [j, k] => {
            // The normal equations of two unknowns.
            let (a, b) = (column(j), column(k));
            let determinant = a.length_squared() * b.length_squared() - a.dot(b) * a.dot(b);
            let (p, q) = (a.dot(moved), b.dot(moved));
            change[j] = (p * b.length_squared() - q * a.dot(b)) / determinant;
            change[k] = (q * a.length_squared() - p * a.dot(b)) / determinant;
        }
        [_, _, _] => change = linear.inverse() * moved,
        _ => return None,
    }
    change.is_finite().then_some(change)
}

/// The largest power of ten that is not above `x`.
fn power(x: f64) -> f64 {
    let exponent = libm::floor(libm::log10(x) + 1e-9);
    libm::pow(10.0, exponent.clamp(-15.0, 12.0))
}

/// A number rounded to a multiple of a power of ten, as short as it can be written.
fn write(x: f64, grain: f64) -> String {
    let decimals = -libm::round(libm::log10(grain));
    if decimals <= 0.0 {
        let rounded = (x / grain).round() * grain + 0.0;
        return format!("{rounded:.0}");
    }
    let mut text = format!("{x:.*}", decimals as usize);
    text.truncate(text.trim_end_matches('0').trim_end_matches('.').len());
    if text == "-0" {
        text.remove(0);
    }
    text
}

/// A project with changes made, which are apart from each other.
pub fn apply(project: &mut Project, edits: &[Edit]) {
    let mut edits: Vec<&Edit> = edits.iter().collect();
    edits.sort_by_key(|edit| std::cmp::Reverse((edit.file, edit.span.start)));
    for edit in edits {
        if let Some(file) = project.files.get_mut(edit.file)
            && file.text.get(edit.span.clone()).is_some()
        {
            file.text.replace_range(edit.span.clone(), &edit.text);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        for (x, grain, text) in [
            (0.123_456, 0.01, "0.12"),
            (-0.001, 0.01, "0"),
            (2.0, 0.001, "2"),
            (1.25, 0.01, "1.25"),
            (1234.0, 100.0, "1200"),
            (-3.7, 1.0, "-4"),
            (0.30000000000000004, 1e-6, "0.3"),
        ] {
            assert_eq!(write(x, grain), text);
        }
        assert_eq!(power(0.013), 0.01);
        assert_eq!(power(0.01), 0.01);
        assert_eq!(power(250.0), 100.0);
    }
}
