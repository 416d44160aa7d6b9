//! Editing by hand: a click on the picture finds the shape's place in the text and lights its bone;
//! knobs on it move the numbers of the text.
//!
//! The chosen shape also follows the caret of the editor. Nothing is kept here that the text does
//! not say: each change goes through [`TextWish::Edit`], and a drag is one undo step.

mod around;
mod cage;
mod knob;

use crate::stage::handles::Handles;
use crate::wish::{TextWish, Wishes};
pub use around::Around;
use assist::handles::{self, Handle};
use document::session::Session;
use egui::{Key, Modifiers, Painter, Rect, Response, Ui};
use field::Skeleton;
use glam::DVec3;
use knob::stroke;
use scene::{Origin, Scene};
use sketch::Sight;
use std::ops::Range;

/// Most bones of one command that are shown: a loop may make thousands.
const MOST_BONES: usize = 400;
/// Most knobs that are shown: a polygon may have hundreds of corners.
const MOST_KNOBS: usize = 240;

/// The chosen shape and its handles.
#[derive(Default)]
pub struct Hands {
    /// Index of the chosen element in the compiled scene.
    chosen: Option<usize>,
    /// The number of elements of that scene.
    count: usize,
    /// The file and byte of the caret at the last frame.
    caret: Option<(usize, usize)>,
    handles: Handles,
    /// The knob that is held, and the place to which it is dragged.
    drag: Option<(usize, DVec3)>,
    /// The deformation whose control points are shown.
    cage: cage::Cage,
}

impl Hands {
    /// Lets go: no shape is chosen.
    pub fn let_go(&mut self) {
        self.cage.let_go();
        self.chosen = None;
        self.handles.clear();
    }

    /// Forgets everything, when another work was opened.
    pub fn clear(&mut self) {
        *self = Self::default();
    }

    /// Returns the file and the bytes of the chosen shape's command.
    #[must_use]
    pub fn lit(&self, session: &Session) -> Option<(usize, Range<usize>)> {
        let scene = &session.compilation().scene;
        let origin = scene.elements.get(self.chosen?)?.origin;
        Some((
            origin.file as usize,
            origin.start as usize..origin.end as usize,
        ))
    }

    /// Draws the bone and the knobs of the chosen shape over the picture in `rect`, and carries out
    /// what the user does to them. `picture` is the response of the picture itself.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        picture: &Response,
        around: &Around<'_>,
        wishes: &mut Wishes,
    ) {
        let session = around.session;
        knob::release(&mut self.drag, ui, wishes);
        knob::release(&mut self.cage.drag, ui, wishes);
        // Before the text has compiled without errors, the picture is not of this text.
        if !session.is_compiled() || session.errors() > 0 || rect.width() < 1.0 {
            return;
        }
        let scene = &session.compilation().scene;
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
            self.click(around, &sight, at, wishes);
        }
        let is_cage = self.cage.deform(session).is_some();
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
            self.cage.show(ui, &painter, rect, &sight, around, wishes);
            return;
        }
        let Some(chosen) = chosen else { return };
        let held = ui.input(|input| input.pointer.any_down());
        let handles = self.handles.of(session, &sight, chosen, held);
        let handles = &handles[..handles.len().min(MOST_KNOBS)];
        paint(&painter, &sight, scene, chosen);
        let place = Place {
            painter: &painter,
            rect,
            sight: &sight,
        };
        knobs(handles, &mut self.drag, ui, &place, around.touch, wishes);
    }

    /// Chooses the shape whose command the caret has come to.
    fn follow(&mut self, session: &Session, caret: Option<(usize, usize)>) {
        if self.caret == caret || self.drag.is_some() {
            return;
        }
        self.caret = caret;
        let Some((file, byte)) = caret else { return };
        let scene = &session.compilation().scene;
        let text = session.text(file);
        let line = line_of(text, byte);
        let is_at = |origin: Origin| {
            origin.file as usize == file
                && (origin.start as usize..=origin.end as usize).contains(&byte)
        };
        let is_in_line = |origin: Origin| {
            is_at(origin) || origin.file as usize == file && line.contains(&(origin.start as usize))
        };
        let stays = self
            .chosen
            .and_then(|chosen| scene.elements.get(chosen))
            .is_some_and(|element| is_in_line(element.origin));
        if !stays {
            self.handles.clear();
            let mut elements = scene.elements.iter();
            self.chosen = elements.position(|element| is_at(element.origin));
            if self.chosen.is_none() {
                let mut elements = scene.elements.iter();
                self.chosen = elements.position(|element| is_in_line(element.origin));
            }
        }
    }

    /// Chooses the shape that is seen at a point of the picture.
    fn click(&mut self, around: &Around<'_>, sight: &Sight, at: egui::Pos2, wishes: &mut Wishes) {
        let session = around.session;
        let scene = &session.compilation().scene;
        let Some(picker) = session.picker() else {
            return;
        };
        let eye = sight.projection.eye;
        // A finger, or a hand that is not quite still, may mean what is next to the point.
        let reach = if around.touch { 12.0 } else { 4.0 };
        let found = picker.pick(eye, sight.direction(at)).or_else(|| {
            (0..8)
                .map(|i| at + reach * egui::Vec2::angled(i as f32 * std::f32::consts::FRAC_PI_4))
                .filter_map(|at| picker.pick(eye, sight.direction(at)))
                .min_by(|a, b| a.t.total_cmp(&b.t))
        });
        self.let_go();
        if let Some(element) = found.and_then(|hit| hit.element) {
            self.chosen = Some(element as usize);
            let mut origin = scene.elements[element as usize].origin;
            if let Some(deform) = self.cage.choose_of(session, origin) {
                origin = deform;
            }
            wishes.push(TextWish::ShowPlace {
                file: origin.file as usize,
                byte: origin.start as usize,
            });
        }
    }
}

/// The place of knobs.
struct Place<'a> {
    painter: &'a Painter,
    rect: Rect,
    sight: &'a Sight,
}

/// Shows the knobs of the chosen shape, and carries out what the user does to them. `drag` is the
/// knob that is held, and the place to which it is dragged.
fn knobs(
    handles: &[Handle],
    drag: &mut Option<(usize, DVec3)>,
    ui: &mut Ui,
    place: &Place<'_>,
    touch: bool,
    wishes: &mut Wishes,
) {
    let Place {
        painter,
        rect,
        sight,
    } = *place;
    // Points come last, above the others, which have room to move away.
    let (points, others): (Vec<usize>, Vec<usize>) =
        (0..handles.len()).partition(|index| handles[*index].kind == handles::Kind::Point);
    for index in others.into_iter().chain(points) {
        let handle = &handles[index];
        let Some(at) = sight.screen(handle.place).filter(|at| rect.contains(*at)) else {
            continue;
        };
        let answer = knob::show(ui, painter, rect, index, at, handle, touch);
        let at = (index, handle.place);
        if let Some(target) = knob::follow(&answer, at, drag, sight, wishes) {
            let grain = sight.point(handle.place);
            let edits = handles::drag(handle, target, grain);
            wishes.push(TextWish::Edit { edits, step: false });
        }
    }
}

/// Returns the bytes of the line around a byte, without its line feed.
fn line_of(text: &str, byte: usize) -> Range<usize> {
    let byte = text.floor_char_boundary(byte);
    let start = text[..byte].rfind('\n').map_or(0, |end| end + 1);
    let end = text[byte..].find('\n').map_or(text.len(), |end| byte + end);
    start..end
}

/// Draws the bone of the chosen element and, fainter, the bones of others that its command made.
fn paint(painter: &Painter, sight: &Sight, scene: &Scene, chosen: usize) {
    let element = &scene.elements[chosen];
    let others = scene
        .elements
        .iter()
        .enumerate()
        .filter(|(index, other)| *index != chosen && other.origin == element.origin)
        .take(MOST_BONES);
    for (_, other) in others {
        let size = 60.0 * sight.point(other.shape.middle());
        for line in other.shape.lines(size) {
            stroke(painter, sight, &line, 0.45);
        }
    }
    let size = 80.0 * sight.point(element.shape.middle());
    for line in element.shape.lines(size) {
        stroke(painter, sight, &line, 1.0);
    }
    if let Some(&Skeleton::Point { center }) = element.shape.skeleton() {
        let radius = scene.radius(element);
        let axes = sight.projection.world_from_view;
        let rim = (0..=48).map(|i| {
            let (sine, cosine) = libm::sincos(f64::from(i) * std::f64::consts::TAU / 48.0);
            center + (axes.x_axis * cosine + axes.y_axis * sine) * radius
        });
        stroke(painter, sight, &rim.collect::<Vec<_>>(), 0.6);
    }
}
