//! Editing by hand: a click on the picture finds the shape's place in the text and lights its bone;
//! knobs on it move the numbers of the text.
//!
//! The chosen shape also follows the caret of the editor. Nothing is kept here that the text does
//! not say: each change goes through [`Command::Edit`], and a drag is one undo step.

mod cage;
mod knob;
mod sight;
mod skeleton;

pub use sight::Sight;

use crate::command::Command;
use crate::session::Session;
use assist::handles::{self, Handle};
use egui::{Color32, Key, Modifiers, Painter, Rect, Response, Stroke, Ui};
use glam::DVec3;
use scene::{Camera, Origin, Scene, Shape};
use std::ops::Range;

/// Bones of one command that are lit, at most: a loop may make thousands.
const MOST_BONES: usize = 400;
/// Knobs that are shown, at most: a polygon may have hundreds of corners.
const MOST_KNOBS: usize = 240;

/// The chosen shape and what is being done to it.
#[derive(Default)]
pub struct Hands {
    /// Index of the chosen element in the compiled scene.
    chosen: Option<usize>,
    /// How many elements that scene had.
    count: usize,
    /// The file and byte of the caret when it was last looked at.
    caret: Option<(usize, usize)>,
    handles: Vec<Handle>,
    /// Key of the handles: revision, frame of the film, element; and the camera.
    made: Option<((u64, u32, usize), Camera)>,
    drag: Option<Drag>,
    /// The deformation whose control points are shown.
    cage: cage::Cage,
}

/// A knob that is held.
struct Drag {
    handle: usize,
    /// Position to which the pointer has dragged it, before its numbers' limits.
    target: DVec3,
}

/// Surroundings of the handles.
pub struct Around<'a> {
    /// The user's work.
    pub session: &'a Session,
    /// The file and byte of the editor's caret, once it had one.
    pub caret: Option<(usize, usize)>,
    /// Whether something lies over the page.
    pub covered: bool,
    /// Whether the draft is on show, in which shapes have not melted together.
    pub draft: bool,
    /// Whether fingers are likely.
    pub touch: bool,
}

impl Hands {
    /// Lets go: no shape is chosen.
    pub fn let_go(&mut self) {
        self.cage.let_go();
        self.chosen = None;
        self.handles.clear();
        self.made = None;
    }

    /// Another work is open.
    pub fn clear(&mut self) {
        *self = Self::default();
    }

    /// The chosen element of the compiled scene.
    #[must_use]
    pub fn chosen(&self) -> Option<usize> {
        self.chosen
    }

    /// The file and the bytes of the chosen shape's command.
    #[must_use]
    pub fn lit(&self, session: &Session) -> Option<(usize, Range<usize>)> {
        let scene = &session.compiled().scene;
        let origin = scene.elements.get(self.chosen?)?.origin;
        Some((
            origin.file as usize,
            origin.start as usize..origin.end as usize,
        ))
    }

    /// Draws the bone and the knobs of the chosen shape over the picture in
    /// `rect`, and takes what is done to them. `picture` is what the picture itself answered.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        picture: &Response,
        around: &Around<'_>,
        commands: &mut Vec<Command>,
    ) {
        let session = around.session;
        if self.drag.is_some() && !ui.input(|input| input.pointer.any_down()) {
            self.drag = None;
            commands.push(Command::Release);
        }
        self.cage.release(ui, commands);
        // Places in the text are only known of a text that was compiled, and without errors: else
        // the picture is not of this text.
        if !session.is_compiled() || session.errors() > 0 || rect.width() < 1.0 {
            return;
        }
        let scene = &session.compiled().scene;
        if self.count != scene.elements.len() {
            self.count = scene.elements.len();
            self.let_go();
        }
        if self.caret != around.caret && self.drag.is_none() {
            self.cage.follow(session, around.caret);
        }
        self.follow(session, around.caret);
        let sight = Sight::new(&session.camera(), rect);
        if picture.clicked()
            && let Some(at) = picture.interact_pointer_pos()
        {
            self.click(around, &sight, at, commands);
        }
        let is_cage = self.cage.chosen(session).is_some();
        let chosen = self.chosen.filter(|chosen| *chosen < self.count);
        if chosen.is_none() && !is_cage {
            return;
        }
        if !around.covered && ui.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Escape))
        {
            self.let_go();
            return;
        }
        let painter = ui.painter().with_clip_rect(rect);
        if is_cage {
            self.cage.show(ui, &painter, rect, &sight, around, commands);
            return;
        }
        let Some(chosen) = chosen else { return };
        let held = ui.input(|input| input.pointer.any_down());
        self.prepare(session, &sight, chosen, held);
        paint(&painter, &sight, scene, chosen);
        self.knobs(ui, &painter, rect, &sight, around.touch, commands);
    }

    /// Chooses the shape whose command the caret has come to.
    fn follow(&mut self, session: &Session, caret: Option<(usize, usize)>) {
        if self.caret == caret || self.drag.is_some() {
            return;
        }
        self.caret = caret;
        let Some((file, byte)) = caret else { return };
        let scene = &session.compiled().scene;
        let text = session.text(file);
        let there = line_of(text, byte);
        let is_at = |origin: Origin| {
            origin.file as usize == file
                && (origin.start as usize..=origin.end as usize).contains(&byte)
        };
        let is_there = |origin: Origin| {
            is_at(origin)
                || origin.file as usize == file && there.contains(&(origin.start as usize))
        };
        let stays = self
            .chosen
            .and_then(|chosen| scene.elements.get(chosen))
            .is_some_and(|element| is_there(element.origin));
        if !stays {
            self.chosen = None;
            self.handles.clear();
            self.made = None;
            let position = |test: &dyn Fn(Origin) -> bool| {
                scene
                    .elements
                    .iter()
                    .position(|element| test(element.origin))
            };
            self.chosen = position(&is_at).or_else(|| position(&is_there));
        }
    }

    /// Chooses what is seen at a point of the picture.
    fn click(
        &mut self,
        around: &Around<'_>,
        sight: &Sight,
        at: egui::Pos2,
        commands: &mut Vec<Command>,
    ) {
        let session = around.session;
        let scene = &session.compiled().scene;
        let Some(picker) = session.picker(around.draft) else {
            return;
        };
        let eye = sight.projection.eye;
        let met = |at| picker.pick(eye, sight.direction(at));
        // A finger, or a hand that is not quite still, may mean what is next to the point.
        let reach = if around.touch { 12.0 } else { 4.0 };
        let nearby =
            (0..8).map(|i| at + reach * egui::Vec2::angled(i as f32 * std::f32::consts::FRAC_PI_4));
        let found = met(at).or_else(|| nearby.filter_map(met).min_by(|a, b| a.t.total_cmp(&b.t)));
        self.let_go();
        if let Some(element) = found.and_then(|hit| hit.element) {
            self.chosen = Some(element as usize);
            let mut origin = scene.elements[element as usize].origin;
            if let Some(deform) = self.cage.choose_of(session, origin) {
                origin = deform;
            }
            commands.push(Command::ShowPlace {
                file: origin.file as usize,
                byte: origin.start as usize,
            });
        }
    }

    /// Brings the handles up to date.
    fn prepare(&mut self, session: &Session, sight: &Sight, chosen: usize, held: bool) {
        let key = (session.revision(), session.film_frame(), chosen);
        let camera = session.camera();
        // While the picture turns, knobs may stay where they are on the shape: making them anew
        // costs as much as compiling.
        let fresh = self
            .made
            .is_some_and(|(made, from)| made == key && (held || from == camera));
        if !fresh {
            self.handles = handles::handles(
                session.project(),
                session.assets(),
                session.film_frame(),
                session.compiled(),
                chosen,
                &sight.projection.world_from_view,
            );
            self.handles.truncate(MOST_KNOBS);
            self.made = Some((key, camera));
        }
    }

    fn knobs(
        &mut self,
        ui: &mut Ui,
        painter: &Painter,
        rect: Rect,
        sight: &Sight,
        touch: bool,
        commands: &mut Vec<Command>,
    ) {
        // Points come last, above the others, which have room to move away.
        let is_point = |index: &usize| self.handles[*index].kind == handles::Kind::Point;
        let all = 0..self.handles.len();
        let (points, others): (Vec<usize>, Vec<usize>) = all.partition(is_point);
        for index in others.into_iter().chain(points) {
            let handle = &self.handles[index];
            let Some(at) = sight.screen(handle.place).filter(|at| rect.contains(*at)) else {
                continue;
            };
            let answer = knob::show(ui, painter, rect, index, at, handle, touch);
            let mut target = None;
            if answer.begins {
                commands.push(Command::Hold);
                self.drag = Some(Drag {
                    handle: index,
                    target: handle.place,
                });
            }
            if let Some(drag) = &mut self.drag
                && drag.handle == index
                && answer.pulled != egui::Vec2::ZERO
            {
                drag.target = sight.moved(drag.target, answer.pulled, answer.deep);
                target = Some(drag.target);
            }
            if answer.nudged != egui::Vec2::ZERO {
                target = Some(sight.moved(handle.place, answer.nudged, answer.deep));
            }
            if let Some(target) = target {
                let grain = sight.point(handle.place);
                let edits = handles::drag(handle, target, grain);
                commands.push(Command::Edit { edits, step: false });
            }
        }
    }
}

/// The bytes of the line around a byte, without its end.
fn line_of(text: &str, byte: usize) -> Range<usize> {
    let byte = text.floor_char_boundary(byte);
    let start = text[..byte].rfind('\n').map_or(0, |end| end + 1);
    let end = text[byte..].find('\n').map_or(text.len(), |end| byte + end);
    start..end
}

/// Draws the bone of the chosen element, and fainter those of the others that its command made.
fn paint(painter: &Painter, sight: &Sight, scene: &Scene, chosen: usize) {
    let element = &scene.elements[chosen];
    let others = scene
        .elements
        .iter()
        .enumerate()
        .filter(|(index, other)| *index != chosen && other.origin == element.origin)
        .take(MOST_BONES);
    for (_, other) in others {
        let size = 60.0 * sight.point(middle(&other.shape));
        for line in skeleton::lines(&other.shape, size) {
            stroke(painter, sight, &line, 0.45);
        }
    }
    let size = 80.0 * sight.point(middle(&element.shape));
    for line in skeleton::lines(&element.shape, size) {
        stroke(painter, sight, &line, 1.0);
    }
    if let Shape::Sphere { center, .. } = element.shape {
        let radius = scene.radius(element);
        let axes = sight.projection.world_from_view;
        let rim = (0..=48).map(|i| {
            let (sine, cosine) = libm::sincos(f64::from(i) * std::f64::consts::TAU / 48.0);
            center + (axes.x_axis * cosine + axes.y_axis * sine) * radius
        });
        stroke(painter, sight, &rim.collect::<Vec<_>>(), 0.6);
    }
}

fn middle(shape: &Shape) -> DVec3 {
    match shape {
        Shape::Sphere { center, .. } | Shape::Arc { center, .. } | Shape::Box { center, .. } => {
            *center
        }
        Shape::Cylinder { base, .. } | Shape::Cone { base, .. } | Shape::Pipe { base, .. } => *base,
        Shape::Triangle { corners, .. } | Shape::Patch { corners, .. } => corners[0],
        Shape::Polygon { rings, .. } => rings.iter().flatten().next().copied().unwrap_or_default(),
        Shape::Curve { control, .. } => control[0],
        Shape::Plane { point, .. } => *point,
        Shape::Quadric(quadric) => quadric.center,
        Shape::Function(function) => function.middle(),
    }
}

/// A line through places, bright within a dark seam, so that it is seen on any picture.
fn stroke(painter: &Painter, sight: &Sight, places: &[DVec3], strength: f32) {
    let pieces: Vec<_> = places
        .windows(2)
        .filter_map(|ends| sight.line(ends[0], ends[1]))
        .collect();
    for (width, colour) in [(3.6, Color32::from_black_alpha(110)), (1.5, knob::LIT)] {
        let stroke = Stroke::new(width, colour.gamma_multiply(strength));
        for piece in &pieces {
            painter.line_segment(*piece, stroke);
        }
    }
}
