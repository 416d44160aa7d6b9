//! Drawing creatures on the picture: strokes become curves of a skeleton, with flesh around them.
//!
//! Nothing is kept here that the text does not say: each gesture changes the text, in one undo
//! step. Crate `sketch` finds the text's skeletons in the picture and makes texts of gestures;
//! [`paint`] shows strokes and skeletons, [`bar`] is the strip with the tools.

pub mod bar;
mod grip;
mod paint;
pub mod tool;

use crate::places;
use crate::stage::handles::Handles;
use crate::wish::{TextWish, ViewWish, Wish, Wishes};
use document::session::Session;
use egui::{CursorIcon, Event, Key, Modifiers, PointerButton, Pos2, Rect, Response, Ui, pos2};
use field::Skeleton;
use glam::DVec3;
use grip::Grip;
use rats::TextEdit;
use sketch::Sight;
use sketch::drawn::{Spot, crossing, node_at, spot_at};
use sketch::edits::{self, Base, Beginning, Brush, Intent, Root};
use sketch::{Drawn, Mark, Stroke, page};
use tool::Tool;
use widgets::keys::take_key;

/// Least and most radius of strokes, points of a picture 640 points wide.
pub const THICKNESS: [f32; 2] = [3.0, 60.0];
/// Factor on the thickness of the first stroke of a page.
const BODY: f32 = 2.6;

/// The tool in hand and its gesture.
pub struct Pencil {
    tool: Option<Tool>,
    /// Whether strokes are mirrored.
    pub mirror: bool,
    /// Radius of strokes, points of a picture 640 points wide.
    pub thickness: f32,
    /// Points of the screen for one of those.
    scale: f32,
    /// Index of the colour of strokes; `None`: that of their root.
    pub colour: Option<usize>,
    /// The skeletons of a revision and frame of the film.
    all: Vec<Drawn>,
    made: Option<(u64, u32)>,
    gesture: Option<Gesture>,
    /// The node that was touched last: skeleton and node.
    chosen: Option<(usize, usize)>,
    /// The node under the pointer.
    over: Option<(usize, usize)>,
    grip: Handles,
    /// The alternative to the last stroke.
    alternative: Option<Alternative>,
    /// Places on the picture where no stroke begins.
    off: Vec<Rect>,
}

/// The last stroke as one of a pair if it is single, or single if it is one of a pair.
struct Alternative {
    /// Revision of the text with the last stroke; `None` until it is there.
    revision: Option<u64>,
    /// The text with the last stroke.
    now: String,
    /// The edit to the text with the alternative.
    change: TextEdit,
    /// Whether the alternative is a pair.
    pair: bool,
}

enum Gesture {
    /// A limb is being drawn.
    Stroke(Stroke, Box<Beginning>),
    /// A cut is being made.
    Cut(Stroke),
    /// A node is held.
    Grip(Grip),
    /// A curve is pressed, and gets a node if the hand moves.
    Bend(Pos2, Spot),
    /// The radius of a node is held.
    Rim,
}

/// Surroundings of the tool.
pub struct Around<'a> {
    /// The user's work.
    pub session: &'a Session,
    /// Whether something lies over the page.
    pub covered: bool,
    /// Whether the picture on show is of an older scene: neither a draft nor a traced picture of
    /// this one.
    pub late: bool,
    /// Whether fingers are likely.
    pub touch: bool,
}

impl Default for Pencil {
    fn default() -> Self {
        Self {
            tool: None,
            mirror: true,
            thickness: 14.0,
            scale: 1.0,
            colour: None,
            all: Vec::new(),
            made: None,
            gesture: None,
            chosen: None,
            over: None,
            grip: Handles::default(),
            alternative: None,
            off: Vec::new(),
        }
    }
}

impl Pencil {
    /// Returns the tool in hand.
    #[must_use]
    pub fn tool(&self) -> Option<Tool> {
        self.tool
    }

    /// Takes a tool in hand, or lays it down.
    pub fn take(&mut self, tool: Option<Tool>) {
        self.tool = tool;
        self.gesture = None;
        self.over = None;
        if tool != Some(Tool::Move) {
            self.chosen = None;
        }
    }

    /// Sets places on the picture where no stroke begins, as something covers them.
    pub fn keep_off(&mut self, places: Vec<Rect>) {
        self.off = places;
    }

    /// Whether the last stroke can be made one of a pair, or else single; `None` if it cannot be
    /// changed, as after another edit.
    #[must_use]
    pub fn alternative(&self, session: &Session) -> Option<bool> {
        let other = self.alternative.as_ref();
        let other = other.filter(|_| self.gesture.is_none())?;
        (other.revision == Some(session.revision())).then_some(other.pair)
    }

    /// Replaces the last stroke by its alternative.
    pub fn turn(&mut self, session: &Session, wishes: &mut Wishes) {
        let Some(other) = self.alternative.as_mut() else {
            return;
        };
        if other.revision != Some(session.revision()) {
            return;
        }
        std::mem::swap(&mut other.now, &mut other.change.text);
        wishes.push(TextWish::Undo);
        let edit = TextEdit::whole(other.change.file, other.now.as_str());
        wishes.push(TextWish::step(edit));
        other.pair = !other.pair;
        other.revision = None;
    }

    /// Forgets all but the tool and its settings, when another work was opened.
    pub fn clear(&mut self) {
        *self = Self {
            tool: self.tool,
            mirror: self.mirror,
            thickness: self.thickness,
            colour: self.colour,
            ..Self::default()
        };
    }

    /// Whether the wheel makes a node thicker, in place of zooming.
    #[must_use]
    pub fn takes_wheel(&self) -> bool {
        self.tool == Some(Tool::Move) && self.over.is_some()
    }

    /// Whether two fingers make a node thicker.
    #[must_use]
    pub fn takes_pinch(&self) -> bool {
        self.tool == Some(Tool::Move) && self.chosen.is_some()
    }

    /// Whether the text has a skeleton that can be drawn on.
    #[must_use]
    pub fn has_skeleton(session: &Session) -> bool {
        let all = Drawn::all(session.project(), session.compilation());
        all.iter().any(|drawn| drawn.block.is_some())
    }

    /// Returns the brush of the next stroke.
    fn brush(&self, touch: bool) -> Brush {
        let is_first = self.all.iter().all(|drawn| drawn.block.is_none());
        Brush {
            radius: self.scale * self.thickness * if is_first { BODY } else { 1.0 },
            mirror: self.mirror,
            colour: self.colour.map(|index| page::COLOURS[index].1),
            touch,
        }
    }

    /// Carries out gestures on the picture in `rect`, and shows skeletons and the stroke.
    /// `picture` is the response of the picture itself.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        picture: &Response,
        around: &Around<'_>,
        wishes: &mut Wishes,
    ) {
        let Some(tool) = self.tool else { return };
        let session = around.session;
        self.scale = (rect.width() / 640.0).clamp(0.5, 2.0);
        if !session.is_compiled() || session.errors() > 0 || rect.width() < 1.0 {
            self.drop_gesture(wishes);
            if session.is_compiled() && session.errors() > 0 {
                paint::hint(
                    ui,
                    rect,
                    "The text has a mistake: undo it or fix it to go on drawing",
                );
            }
            return;
        }
        let key = (session.revision(), session.film_frame());
        if self.made != Some(key) {
            self.alternative = self.alternative.take().filter(|other| {
                let file = other.change.file;
                file < session.project().files.len() && session.text(file) == other.now
            });
            if let Some(other) = &mut self.alternative {
                other.revision = Some(key.0);
            }
            self.made = Some(key);
            self.all = Drawn::all(session.project(), session.compilation());
            self.chosen = self.chosen.filter(|(index, node)| {
                let drawn = self.all.get(*index);
                drawn.is_some_and(|drawn| *node < drawn.knobs.len() && drawn.block.is_some())
            });
        }
        let sight = Sight::new(&session.camera(), rect);
        self.listen(ui, rect, &sight, around, wishes);
        let at = picture.hover_pos().filter(|_| !around.covered);
        let reach = if around.touch { 22.0 } else { 11.0 };
        self.over = at.and_then(|at| node_at(&self.all, &sight, at, reach, false));
        self.keys(ui, around, wishes);
        self.note(ui, rect, &sight);
        let painter = ui.painter().with_clip_rect(rect);
        self.paint(&painter, &sight, at, around, tool);
        let text = self.hint(tool, &sight, at, around);
        paint::hint(ui, rect, text);
        if at.is_some() && self.gesture.is_none() {
            let cursor = match tool {
                Tool::Draw => CursorIcon::Crosshair,
                Tool::Move if self.over.is_some() => CursorIcon::Grab,
                Tool::Move => CursorIcon::Default,
                Tool::Cut => CursorIcon::Crosshair,
            };
            ui.ctx().set_cursor_icon(cursor);
        }
    }

    /// Names the places of nodes for tests and scripts.
    fn note(&self, ui: &Ui, rect: Rect, sight: &Sight) {
        for (index, drawn) in self.all.iter().enumerate() {
            let Some(block) = &drawn.block else { continue };
            for (node, (knob, _)) in block.nodes.iter().zip(&drawn.knobs) {
                if let Some(at) = sight.screen(*knob).filter(|at| rect.contains(*at)) {
                    let name = if index == 0 {
                        format!("node {}", node.name)
                    } else {
                        format!("node {}/{index}", node.name)
                    };
                    places::note(
                        ui.ctx(),
                        name,
                        Rect::from_center_size(at, egui::Vec2::splat(20.0)),
                    );
                }
            }
        }
    }

    fn keys(&mut self, ui: &Ui, around: &Around<'_>, wishes: &mut Wishes) {
        if around.covered || ui.ctx().egui_wants_keyboard_input() {
            return;
        }
        if take_key(ui.ctx(), Modifiers::NONE, Key::OpenBracket) {
            self.thickness = (self.thickness / 1.15).max(THICKNESS[0]);
        }
        if take_key(ui.ctx(), Modifiers::NONE, Key::CloseBracket) {
            self.thickness = (self.thickness * 1.15).min(THICKNESS[1]);
        }
        if take_key(ui.ctx(), Modifiers::NONE, Key::Escape) {
            if self.gesture.is_some() {
                self.drop_gesture(wishes);
            } else if self.chosen.is_some() {
                self.chosen = None;
            } else {
                wishes.push(ViewWish::SetTool(None));
            }
        }
        if let Some((index, node)) = self.chosen
            && [Key::Delete, Key::Backspace]
                .iter()
                .any(|key| take_key(ui.ctx(), Modifiers::NONE, *key))
        {
            self.remove_node(around.session, index, node, wishes);
        }
    }

    /// Gives up the gesture.
    fn drop_gesture(&mut self, wishes: &mut Wishes) {
        if let Some(Gesture::Grip(_) | Gesture::Rim) = self.gesture.take() {
            wishes.push(TextWish::Release);
        }
    }

    /// Follows the pointer through all events since the last frame.
    fn listen(
        &mut self,
        ui: &Ui,
        rect: Rect,
        sight: &Sight,
        around: &Around<'_>,
        wishes: &mut Wishes,
    ) {
        let (touch, space) = ui.input(|input| (input.multi_touch(), input.key_down(Key::Space)));
        if let Some(touch) = touch {
            self.drop_gesture(wishes);
            if self.takes_pinch() && touch.zoom_delta != 1.0 {
                self.widen(sight, around, f64::from(touch.zoom_delta), wishes);
            }
            return;
        }
        if self.takes_wheel() && self.gesture.is_none() {
            let scroll = ui
                .input(|input| input.smooth_scroll_delta().y + 400.0 * (input.zoom_delta() - 1.0));
            if scroll != 0.0 {
                self.chosen = self.over;
                self.widen(sight, around, libm::exp(f64::from(scroll) / 400.0), wishes);
            }
        }
        let off = self.off.clone();
        let free = |at: Pos2| {
            rect.contains(at)
                && !around.covered
                && !space
                && !off.iter().any(|place| place.contains(at))
                && ui
                    .ctx()
                    .layer_id_at(at)
                    .is_none_or(|layer| layer == ui.layer_id())
                && !egui::Popup::is_any_open(ui.ctx())
        };
        let mut moved = None;
        for event in ui.input(|input| input.events.clone()) {
            match event {
                Event::PointerButton {
                    pos,
                    button: PointerButton::Primary,
                    pressed: true,
                    modifiers,
                } if free(pos) && !modifiers.shift => {
                    ui.memory_mut(|memory| {
                        if let Some(focused) = memory.focused() {
                            memory.surrender_focus(focused);
                        }
                    });
                    self.press(sight, around, pos, wishes);
                }
                Event::PointerMoved(at) => {
                    moved = Some(at);
                    if let Some(Gesture::Stroke(stroke, _) | Gesture::Cut(stroke)) =
                        &mut self.gesture
                    {
                        stroke.push(mark(at));
                    }
                }
                Event::PointerButton {
                    pos,
                    button: PointerButton::Primary,
                    pressed: false,
                    ..
                } if self.gesture.is_some() => {
                    if let Some(at) = moved.take() {
                        self.drag(sight, around, at, wishes);
                    }
                    self.release(sight, around, pos, wishes);
                }
                _ => {}
            }
        }
        if let Some(at) = moved {
            self.drag(sight, around, at, wishes);
        }
        // Released outside the window.
        if self.gesture.is_some() && !ui.input(|input| input.pointer.any_down()) {
            self.drop_gesture(wishes);
        }
    }

    /// Begins a gesture of the tool.
    fn press(&mut self, sight: &Sight, around: &Around<'_>, at: Pos2, wishes: &mut Wishes) {
        let session = around.session;
        match self.tool {
            Some(Tool::Draw) => {
                let begin = self.begin(session, sight, at, Intent::default(), around.touch);
                self.gesture = Some(Gesture::Stroke(Stroke::begin(mark(at)), Box::new(begin)));
            }
            Some(Tool::Cut) => self.gesture = Some(Gesture::Cut(Stroke::begin(mark(at)))),
            Some(Tool::Move) => {
                let reach = if around.touch { 22.0 } else { 11.0 };
                let rim = self.rim(sight).filter(|rim| rim.1.distance(at) <= reach);
                if let Some(found) = node_at(&self.all, sight, at, reach, false) {
                    self.chosen = Some(found);
                    let grip = Grip::new(&self.all, found, self.mirror, at);
                    self.gesture = Some(Gesture::Grip(grip));
                    wishes.push(TextWish::Hold);
                } else if rim.is_some() {
                    self.gesture = Some(Gesture::Rim);
                    wishes.push(TextWish::Hold);
                } else {
                    self.chosen = None;
                    let spot = spot_at(&self.all, sight, at, 4.0);
                    let spot = spot.filter(|spot| self.all[spot.drawn].block.is_some());
                    self.gesture = spot.map(|spot| Gesture::Bend(at, spot));
                }
            }
            None => {}
        }
    }

    fn begin(
        &self,
        session: &Session,
        sight: &Sight,
        at: Pos2,
        intent: Intent,
        touch: bool,
    ) -> Beginning {
        let brush = self.brush(touch);
        let home = session.camera().target;
        edits::begin(&self.all, sight, at, &brush, intent, home, || {
            let hit = hit(session, sight, at, 0.0)?;
            let is_skeleton = hit
                .element
                .is_some_and(|element| self.all.iter().any(|d| d.element == element as usize));
            (!is_skeleton).then_some(hit.position)
        })
    }

    fn drag(&mut self, sight: &Sight, around: &Around<'_>, at: Pos2, wishes: &mut Wishes) {
        match &mut self.gesture {
            Some(Gesture::Grip(grip)) => {
                if let Some(why) =
                    grip.drag(&self.all, &mut self.grip, around.session, sight, at, wishes)
                {
                    wishes.push(Wish::Tell(why));
                    self.drop_gesture(wishes);
                }
            }
            Some(Gesture::Bend(from, spot)) if from.distance(at) > 4.0 => {
                let (from, spot) = (*from, *spot);
                self.bend(around.session, sight, from, spot, wishes);
            }
            // A stroke from an end may change its beginning with its heading.
            Some(Gesture::Stroke(stroke, begin)) if begin.place.is_some() => {
                let start = stroke.marks()[0].at;
                let intent = Intent {
                    heading: edits::heading(stroke),
                    pair: None,
                };
                let start = pos2(start[0], start[1]);
                let begin = self.begin(around.session, sight, start, intent, around.touch);
                if let Some(Gesture::Stroke(_, held)) = &mut self.gesture {
                    **held = begin;
                }
            }
            Some(Gesture::Rim) => {
                let Some((center, rim)) = self.rim(sight) else {
                    return;
                };
                let (now, wanted) = (center.distance(rim), center.distance(at));
                if wanted > 1.0 && now > 0.0 {
                    self.widen(sight, around, f64::from(wanted / now), wishes);
                }
            }
            _ => {}
        }
    }

    /// Gives a curve a node, and takes hold of it.
    fn bend(
        &mut self,
        session: &Session,
        sight: &Sight,
        from: Pos2,
        spot: Spot,
        wishes: &mut Wishes,
    ) {
        self.gesture = None;
        let drawn = &self.all[spot.drawn];
        let text = session.text(drawn.file);
        let grain = 0.5 * sight.point(spot.place) / drawn.growth.max(f64::MIN_POSITIVE);
        let node = drawn.node_of(&spot);
        let Some(text) = sketch::insert(
            text,
            drawn.span.clone(),
            spot.curve,
            spot.span,
            &node,
            grain,
        ) else {
            return;
        };
        let change = TextEdit::whole(drawn.file, text);
        let number = drawn.knobs.len();
        match edits::check(&base(session), change) {
            Ok((change, project, compiled)) => {
                wishes.push(TextWish::Hold);
                wishes.push(TextWish::edit(change));
                let all = Drawn::all(&project, &compiled);
                let found = (spot.drawn, number);
                if all
                    .get(found.0)
                    .is_some_and(|drawn| number < drawn.knobs.len())
                {
                    self.chosen = Some(found);
                    self.gesture = Some(Gesture::Grip(Grip::new(&all, found, self.mirror, from)));
                }
            }
            Err(why) => wishes.push(Wish::Tell(why)),
        }
    }

    /// Carries out the gesture at its end.
    fn release(&mut self, sight: &Sight, around: &Around<'_>, at: Pos2, wishes: &mut Wishes) {
        let session = around.session;
        let still = if around.touch { 10.0 } else { 5.0 };
        match self.gesture.take() {
            Some(Gesture::Stroke(mut stroke, begin)) => {
                stroke.push(mark(at));
                self.alternative = None;
                let result = if stroke.reach() < still {
                    self.tap(session, sight, around.touch, at, &begin)
                } else {
                    self.limb(session, sight, around.touch, &stroke)
                };
                step(result, wishes);
            }
            Some(Gesture::Cut(mut stroke)) => {
                stroke.push(mark(at));
                if stroke.reach() < still {
                    self.erase(session, sight, around.touch, at, wishes);
                } else {
                    self.cut(session, sight, &stroke, wishes);
                }
            }
            Some(Gesture::Grip(_) | Gesture::Rim) => {
                // The last move is in the text already; the ground follows in the same step.
                for drawn in self.all.iter().take(1) {
                    let text = session.text(drawn.file);
                    let new = edits::put_on_ground(text, &self.all);
                    if session.is_compiled() && new != text {
                        wishes.push(TextWish::edit(TextEdit::whole(drawn.file, new)));
                    }
                }
                wishes.push(TextWish::Release);
            }
            Some(Gesture::Bend(..)) | None => {}
        }
    }

    /// Makes a bead where the picture was tapped.
    fn tap(
        &mut self,
        session: &Session,
        sight: &Sight,
        touch: bool,
        at: Pos2,
        begin: &Beginning,
    ) -> Option<Result<TextEdit, String>> {
        let reach = if touch { 16.0 } else { 5.0 };
        let hit = hit(session, sight, at, reach)?;
        let colour = self
            .colour
            .map_or(page::COLOURS[7].1, |index| page::COLOURS[index].1);
        let mut begin = *begin;
        begin.pair = self.mirror;
        begin.radius = f64::from(self.brush(touch).radius) * sight.point(hit.position);
        let point = sight.point(hit.position);
        // Sunk into the flesh, so that a quarter of its radius is hidden.
        let center = hit.position - hit.normal * (0.15 * begin.radius);
        let change = edits::bead(session.project(), &begin, center, colour, point)?;
        Some(edits::check(&base(session), change).map(|(change, ..)| change))
    }

    /// Makes a limb along a stroke, and keeps the alternative to it.
    fn limb(
        &mut self,
        session: &Session,
        sight: &Sight,
        touch: bool,
        stroke: &Stroke,
    ) -> Option<Result<TextEdit, String>> {
        let (change, is_pair) = self.grow(session, sight, touch, stroke, None)?;
        let change = match edits::check(&base(session), change) {
            Ok((change, ..)) => change,
            Err(why) => return Some(Err(why)),
        };
        if self.mirror
            && let Some((other, pair)) = self.grow(session, sight, touch, stroke, Some(!is_pair))
            && pair != is_pair
            && let Ok((other, ..)) = edits::check(&base(session), other)
            && other.file == change.file
        {
            self.alternative = Some(Alternative {
                revision: None,
                now: change.text.clone(),
                change: other,
                pair,
            });
        }
        Some(Ok(change))
    }

    /// Returns the edit that adds a limb along a stroke, and whether the limb is one of a pair.
    /// `pair`: whether it should be; `None` to decide that by the stroke.
    fn grow(
        &mut self,
        session: &Session,
        sight: &Sight,
        touch: bool,
        stroke: &Stroke,
        pair: Option<bool>,
    ) -> Option<(TextEdit, bool)> {
        let brush = self.brush(touch);
        let home = session.camera().target;
        let start = stroke.marks()[0].at;
        let intent = Intent {
            heading: edits::heading(stroke),
            pair,
        };
        let begin = self.begin(session, sight, pos2(start[0], start[1]), intent, touch);
        let (begin, stroke) = edits::orient(&self.all, sight, &brush, begin, stroke, pair, home);
        let samples = begin.samples(sight, &stroke);
        let point = sight.point(begin.plane.0);
        let project = session.project();
        let change = edits::draw(project, &self.all, &begin, &samples, &brush, point)?;
        Some((change, begin.pair))
    }

    /// Removes the bead, node or curve that is tapped.
    fn erase(
        &mut self,
        session: &Session,
        sight: &Sight,
        touch: bool,
        at: Pos2,
        wishes: &mut Wishes,
    ) {
        let reach = if touch { 20.0 } else { 9.0 };
        if let Some(hit) = hit(session, sight, at, 0.0)
            && let Some(element) = hit.element
        {
            let scene = &session.compilation().scene;
            let element = element as usize;
            let shape = &scene.elements[element];
            let alone = !session.compilation().placements[element].repeated;
            if matches!(shape.shape.skeleton(), Some(Skeleton::Point { .. })) && alone {
                let origin = shape.origin;
                let (file, span) = (
                    origin.file as usize,
                    origin.start as usize..origin.end as usize,
                );
                let text = sketch::without_commands(session.text(file), &[span]);
                let change = text.map(|text| TextEdit::whole(file, text));
                step(
                    change.map(|change| edits::check(&base(session), change).map(|(c, ..)| c)),
                    wishes,
                );
                return;
            }
        }
        if let Some((index, node)) = node_at(&self.all, sight, at, reach, false) {
            self.remove_node(session, index, node, wishes);
            return;
        }
        let Some(spot) = spot_at(&self.all, sight, at, 4.0) else {
            return;
        };
        let drawn = &self.all[spot.drawn];
        if drawn.block.is_none() {
            let why = "This limb is made by a loop or a copy: change it in the text.";
            wishes.push(Wish::Tell(String::from(why)));
            return;
        }
        let text = session.text(drawn.file);
        let Some(text) = sketch::remove_curve(text, drawn.span.clone(), spot.curve) else {
            return;
        };
        let change = TextEdit::whole(drawn.file, text);
        let other = self.mirror_place(spot.drawn, spot.place);
        let radius = spot.radius;
        let result = edits::twice(&base(session), change, |project, all| {
            let (index, spot) = near(all, other?, 0.6 * radius)?;
            let drawn = &all[index];
            let text = &project.files[drawn.file].text;
            Some(TextEdit::whole(
                drawn.file,
                sketch::remove_curve(text, drawn.span.clone(), spot.curve)?,
            ))
        });
        step(Some(result), wishes);
    }

    /// Removes a node, and its mirrored one.
    fn remove_node(&mut self, session: &Session, index: usize, node: usize, wishes: &mut Wishes) {
        let drawn = &self.all[index];
        let text = session.text(drawn.file);
        let Some(text) = sketch::remove(text, drawn.span.clone(), node) else {
            return;
        };
        let change = TextEdit::whole(drawn.file, text);
        let other = self.mirror_place(
            index,
            drawn
                .to_world
                .transform_point3(drawn.skeleton.nodes[node].position),
        );
        let radius = drawn.skeleton.nodes[node].radius;
        self.chosen = None;
        let result = edits::twice(&base(session), change, |project, all| {
            let other = other?;
            let found = all.iter().find_map(|drawn| {
                drawn.block.as_ref()?;
                Some((drawn, drawn.node_near(drawn.to_own(other), 0.3 * radius)?))
            });
            let (drawn, node) = found?;
            let text = &project.files[drawn.file].text;
            Some(TextEdit::whole(
                drawn.file,
                sketch::remove(text, drawn.span.clone(), node)?,
            ))
        });
        step(Some(result), wishes);
    }

    /// Cuts the limb that a stroke crosses, and its mirrored one.
    fn cut(&self, session: &Session, sight: &Sight, stroke: &Stroke, wishes: &mut Wishes) {
        let line: Vec<Pos2> = stroke
            .marks()
            .iter()
            .map(|m| pos2(m.at[0], m.at[1]))
            .collect();
        let Some(spot) = crossing(&self.all, sight, &line) else {
            return;
        };
        let point = sight.point(spot.place);
        let drawn = &self.all[spot.drawn];
        let Some(text) = cut(drawn, session.text(drawn.file), &spot, point) else {
            return;
        };
        let change = TextEdit::whole(drawn.file, text);
        let other = self.mirror_place(spot.drawn, spot.place);
        let result = edits::twice(&base(session), change, |project, all| {
            let (index, spot) = near(all, other?, 0.6 * spot.radius)?;
            let drawn = &all[index];
            Some(TextEdit::whole(
                drawn.file,
                cut(drawn, &project.files[drawn.file].text, &spot, point)?,
            ))
        });
        step(Some(result), wishes);
    }

    /// Returns the place on the other side of the mirror, if strokes are mirrored and it is not the
    /// same.
    fn mirror_place(&self, index: usize, place: DVec3) -> Option<DVec3> {
        let drawn = &self.all[index];
        let own = drawn.to_own(place);
        let other = own * DVec3::new(-1.0, 1.0, 1.0);
        let least = 1e-3 * drawn.middle().distance(place).max(1e-6);
        let apart = self.mirror && own.x.abs() > least;
        apart.then(|| drawn.to_world.transform_point3(other))
    }

    /// Makes the chosen node thicker by a factor, and its mirrored one.
    fn widen(&mut self, sight: &Sight, around: &Around<'_>, factor: f64, wishes: &mut Wishes) {
        let Some((index, node)) = self.chosen else {
            return;
        };
        let factor = if factor.is_finite() {
            factor.clamp(0.2, 5.0)
        } else {
            1.0
        };
        let Some(drawn) = self.all.get(index) else {
            return;
        };
        let mut nodes = vec![node];
        if self.mirror {
            nodes.extend(grip::twin(drawn, node));
        }
        let why = grip::widen(
            drawn,
            &nodes,
            &mut self.grip,
            around.session,
            sight,
            factor,
            wishes,
        );
        if let Some(why) = why {
            wishes.push(Wish::Tell(why));
        }
    }

    /// Returns the chosen node's place on the screen, and that of the knob of its radius.
    fn rim(&self, sight: &Sight) -> Option<(Pos2, Pos2)> {
        let (index, node) = self.chosen?;
        let drawn = self.all.get(index)?;
        let knob = drawn.knobs.get(node)?.0;
        let center = sight.screen(knob)?;
        let radius = (drawn.radius(node) / sight.point(knob)) as f32;
        let out = egui::vec2(0.8, 0.6) * radius.max(1.0);
        Some((center, center + out))
    }

    fn paint(
        &self,
        painter: &egui::Painter,
        sight: &Sight,
        at: Option<Pos2>,
        around: &Around<'_>,
        tool: Tool,
    ) {
        let stroke = match &self.gesture {
            Some(Gesture::Stroke(stroke, begin)) => Some((stroke, begin)),
            _ => None,
        };
        if around.late {
            for drawn in &self.all {
                paint::flesh(painter, sight, drawn);
            }
        }
        let limb = stroke.map(|(stroke, begin)| {
            let samples = begin.samples(sight, stroke);
            let colour = self.stroke_colour(begin);
            (samples, **begin, colour)
        });
        if let Some((samples, begin, colour)) = &limb {
            if begin.pair {
                let mut other = samples.clone();
                for sample in &mut other {
                    sample.position = begin.mirror(sample.position);
                }
                paint::tube(painter, sight, &other, *colour, 0.55);
            }
            paint::tube(painter, sight, samples, *colour, 0.9);
        }
        for (index, drawn) in self.all.iter().enumerate() {
            paint::bones(painter, sight, drawn, tool, |node| {
                if self.chosen == Some((index, node)) {
                    paint::Light::Chosen
                } else if self.over == Some((index, node)) && self.gesture.is_none() {
                    paint::Light::Over
                } else {
                    paint::Light::Plain
                }
            });
        }
        if tool == Tool::Move
            && let Some((center, rim)) = self.rim(sight)
        {
            paint::rim(painter, center, rim);
        }
        if let Some(Gesture::Cut(stroke)) = &self.gesture {
            paint::knife(painter, stroke);
        }
        if tool == Tool::Draw
            && self.gesture.is_none()
            && !around.touch
            && let Some(at) = at
        {
            paint::brush(painter, at, self.brush(false).radius);
        }
    }

    fn stroke_colour(&self, begin: &Beginning) -> scene::Rgb {
        let own = match begin.root {
            Root::Node(index, _) | Root::End(index, _) => Some(index),
            Root::Spot(spot) => Some(spot.drawn),
            Root::Free => edits::target(&self.all, None),
        };
        match (self.colour, own) {
            (Some(index), _) => page::COLOURS[index].1,
            (None, Some(index)) => self.all[index].colour,
            (None, None) => page::COLOURS[0].1,
        }
    }

    /// Returns a sentence about what a gesture would do now.
    fn hint(
        &self,
        tool: Tool,
        sight: &Sight,
        at: Option<Pos2>,
        around: &Around<'_>,
    ) -> &'static str {
        let is_empty = self.all.iter().all(|drawn| drawn.block.is_none());
        match (&self.gesture, tool) {
            (Some(Gesture::Stroke(_, begin)), _) if begin.pair => {
                return "A pair: the other one grows on the other side";
            }
            (Some(Gesture::Stroke(..)), _) => return "Let go, and it becomes a limb",
            (Some(Gesture::Cut(_)), _) => return "Across a limb: the part beyond falls off",
            (Some(Gesture::Rim), _) => return "Away from the dot: thicker",
            (Some(_), _) => return "Let go where it should stay",
            (None, _) => {}
        }
        if tool == Tool::Draw {
            if is_empty && self.all.is_empty() {
                return "Draw a line: it becomes the body";
            }
            if let Some(at) = at.filter(|_| !around.touch) {
                if node_at(&self.all, sight, at, 12.0, true).is_some() {
                    return "Draw: the limb goes on from its end";
                }
                if spot_at(&self.all, sight, at, 4.0).is_some() {
                    return if self.mirror {
                        "Draw: a pair of limbs grows here · click: a pair of beads"
                    } else {
                        "Draw: a limb grows here · click: a bead"
                    };
                }
                return "Draw from the flesh: a limb · right button turns · wheel zooms";
            }
            return if around.touch {
                "From the flesh: a limb · tap it: an eye"
            } else {
                "Draw from the flesh: a limb · right button turns"
            };
        }
        match (tool, around.touch) {
            _ if is_empty => "Nothing is drawn yet: choose Draw",
            (Tool::Move, true) if self.chosen.is_some() => {
                "Pinch: thicker or thinner · drag the dot: move it"
            }
            (Tool::Move, true) => "Drag a dot, or bend a limb · two fingers turn",
            (Tool::Move, false) if self.over.is_some() => {
                "Drag: move it · wheel: thicker or thinner"
            }
            (Tool::Move, false) => "Drag a dot, or bend a limb · right button turns",
            (_, true) => "Cut across a limb · tap a dot, a limb or an eye to remove it",
            (_, false) => "Cut across a limb · click a dot, a limb or an eye to remove it",
        }
    }
}

/// Returns the texts of a session as gestures change them.
fn base(session: &Session) -> Base<'_> {
    Base {
        project: session.project(),
        assets: session.assets(),
        frame: f64::from(session.film_frame()),
        compiled: session.compilation(),
    }
}

/// Returns a place near one in the world, on the first skeleton within `reach` that drawing can
/// change.
fn near(all: &[Drawn], place: DVec3, reach: f64) -> Option<(usize, Spot)> {
    all.iter().enumerate().find_map(|(index, drawn)| {
        drawn.block.as_ref()?;
        Some((index, drawn.spot_near(index, place, reach)?))
    })
}

/// Makes an edit as an undo step, or tells why there is none.
fn step(result: Option<Result<TextEdit, String>>, wishes: &mut Wishes) {
    match result {
        Some(Ok(edit)) => wishes.push(TextWish::step(edit)),
        Some(Err(why)) => wishes.push(Wish::Tell(why)),
        None => {}
    }
}

/// Returns a text without the piece of a drawn skeleton around a spot; `point` is the size of a
/// point of the screen there.
fn cut(drawn: &Drawn, text: &str, spot: &Spot, point: f64) -> Option<String> {
    sketch::cut(
        text,
        drawn.span.clone(),
        &drawn.skeleton,
        spot.curve,
        spot.span,
        &drawn.node_of(spot),
        0.5 * point / drawn.growth.max(f64::MIN_POSITIVE),
    )
}

fn mark(at: Pos2) -> Mark {
    Mark {
        at: [at.x, at.y],
        pressure: browser::pen_pressure(),
    }
}

/// Returns the hit that is seen at a place of the screen, or at most `around` points beside it.
fn hit(session: &Session, sight: &Sight, at: Pos2, around: f32) -> Option<tracer::Hit> {
    let picker = session.picker()?;
    let rings = [0.0, 0.5, 1.0].map(|share| share * around);
    let places = rings.into_iter().flat_map(|out| {
        let turns = if out > 0.0 { 8 } else { 1 };
        (0..turns).map(move |turn| {
            at + out * egui::Vec2::angled(turn as f32 * std::f32::consts::FRAC_PI_4)
        })
    });
    places
        .into_iter()
        .find_map(|at| picker.pick(sight.projection.eye, sight.direction(at)))
}
