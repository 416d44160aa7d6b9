//! The text editor: finding and replacing, colours, line numbers, underlined mistakes, indentation,
//! completions, cards, the line that says how a command is written, definitions, renaming.

mod answers;
mod completion;
pub mod find;
mod folding;
mod hover;
mod place;
mod rename;
mod signature;
mod tint;

use crate::problems;
use crate::text::code::Colouring;
use crate::text::keyboard::{self, is_brace};
use crate::text::marks::{self, Marks};
use crate::theme::{self, Palette};
use crate::wish::{TextWish, Wishes};
use assist::indent::{self, Edited};
use document::session::Session;
use egui::text::{CCursor, CCursorRange};
use egui::{
    Align, FontId, Galley, Key, Margin, Modifiers, Pos2, Rect, ScrollArea, TextBuffer, TextEdit,
    Ui, pos2,
};
use place::{Place, id, to_bytes, to_chars};
use std::ops::Range;

/// Most places that are found and shown on a light ground.
const LIT: usize = 200;

/// The state of the editor that is not part of the user's work.
#[derive(Default)]
pub struct Editor {
    /// The file on show.
    pub file: usize,
    /// The image or mesh on show instead, by its name.
    pub asset: Option<String>,
    /// The file and bytes of the commands that are chosen in the picture, shown on a light ground.
    pub lit: Option<(usize, Range<usize>)>,
    /// The strip in which one finds and replaces.
    find: find::Find,
    buffer: Buffer,
    cursor: Cursor,
    look: Look,
    cards: Cards,
}

/// The text that is edited, a copy of the session's.
#[derive(Default)]
struct Buffer {
    text: String,
    /// The session's revision and the file that it is of.
    of: Option<(u64, usize)>,
}

/// The cursor.
#[derive(Default)]
struct Cursor {
    /// The bytes to select at the next frame.
    jump: Option<Range<usize>>,
    /// The byte to show at the next frame.
    place: Option<usize>,
    /// The cursor before the last frame's edits.
    before: Option<CCursorRange>,
    /// The line, from 1.
    line: usize,
    /// Whether a letter was typed in the last frame, which may open the completions.
    typed: bool,
    /// Whether the text was written in by hand since [`Editor::take_written`].
    wrote: bool,
    /// The file and byte.
    caret: Option<(usize, usize)>,
}

/// The text's colours, folds and underlines.
#[derive(Default)]
struct Look {
    colouring: Colouring,
    folding: folding::Folding,
    marks: Marks,
}

/// Lists, cards, lines and fields that open beside the cursor or the pointer.
#[derive(Default)]
struct Cards {
    completions: completion::Popup,
    hover: hover::Hover,
    signature: signature::Line,
    tints: tint::Tints,
    rename: Option<rename::Rename>,
}

impl Editor {
    /// Shows a file.
    pub fn open(&mut self, file: usize) {
        self.file = file;
        self.asset = None;
    }

    /// Selects a byte range of a file and scrolls to it, at the next frame.
    pub fn jump(&mut self, file: usize, range: Range<usize>) {
        self.open(file);
        self.cursor.jump = Some(range);
    }

    /// Takes the session's text again after an edit was refused, with the cursor where it was.
    pub fn resync(&mut self, ctx: &egui::Context) {
        self.buffer.of = None;
        if let Some(mut state) = TextEdit::load_state(ctx, id()) {
            state.cursor.set_char_range(self.cursor.before);
            state.store(ctx, id());
        }
    }

    /// Shows a byte of a file, without taking the focus from where it is.
    pub fn show_place(&mut self, file: usize, byte: usize) {
        self.open(file);
        self.cursor.place = Some(byte);
    }

    /// Returns the file and byte of the cursor; `None` until the text has had the focus.
    #[must_use]
    pub fn caret(&self) -> Option<(usize, usize)> {
        self.cursor.caret
    }

    /// Returns whether the text was written in by hand since the last call.
    pub fn take_written(&mut self) -> bool {
        std::mem::take(&mut self.cursor.wrote)
    }

    /// Opens the strip in which one finds and replaces, with what is selected.
    pub fn seek(&mut self, seek: find::Seek) {
        self.asset = None;
        let selected = self.cursor.before.map_or(0..0, |range| {
            let range = range.as_sorted_char_range();
            let text = &self.buffer.text;
            to_bytes(text, range.start.0)..to_bytes(text, range.end.0)
        });
        let text = self.buffer.text.get(selected.clone()).unwrap_or_default();
        self.find.open(seek, text, selected.start);
    }

    /// Shows the first file from the top, when another work was opened.
    pub fn reset(&mut self, ctx: &egui::Context) {
        self.open(0);
        self.cards.completions.close();
        self.look.folding.clear();
        self.cards.rename = None;
        self.find.close();
        self.buffer.of = None;
        self.cursor.caret = None;
        self.cursor.jump = None;
        ctx.data_mut(|data| data.remove::<egui::text_edit::TextEditState>(id()));
    }

    /// Shows the editor in all the space of `ui`, with `hints` also the line at the caret that says
    /// how its command is written.
    pub fn show(&mut self, ui: &mut Ui, session: &Session, hints: bool, wishes: &mut Wishes) {
        self.file = self
            .file
            .min(session.project().files.len().saturating_sub(1));
        if self.buffer.of != Some((session.revision(), self.file)) {
            session.text(self.file).clone_into(&mut self.buffer.text);
            self.buffer.of = Some((session.revision(), self.file));
        }
        self.look.marks.update(
            [session.revision(), session.messages_number()],
            session.project(),
            self.file,
            session.messages(),
        );
        let palette = theme::palette(ui.visuals());
        ui.painter().rect_filled(ui.max_rect(), 0.0, palette.paper);
        self.cursor.before =
            TextEdit::load_state(ui.ctx(), id()).and_then(|state| state.cursor.char_range());
        self.offer(ui, session);
        let chosen = self.cards.completions.keys(ui);
        let mut is_step = self.write(ui, chosen);
        self.ask(ui, session, wishes);
        let has_changed = self.keys(ui);
        is_step |= self.show_find(ui);
        let height = ui.available_height();
        let lines = self
            .buffer
            .text
            .bytes()
            .filter(|byte| *byte == b'\n')
            .count()
            + 1;
        let digits = lines.to_string().len().max(2);
        let gutter = digits as f32 * theme::CODE_SIZE * 0.6 + 26.0;
        let caret = ScrollArea::vertical()
            .id_salt(("editor", self.file))
            .auto_shrink(false)
            .show(ui, |ui| {
                let caret = self.text(ui, palette, session, gutter, height, wishes);
                let focused = ui.memory(|memory| memory.has_focus(id()));
                if let (Some((caret, place)), true, true) = (caret, focused, hints) {
                    self.cards
                        .signature
                        .show(ui, session, place, self.cursor.line, caret);
                }
                caret
            })
            .inner;
        if let Some((caret, _)) = caret {
            let chosen = self.cards.completions.show(ui, caret);
            is_step |= self.write(ui, chosen);
            self.show_rename(ui, session, caret, wishes);
        }
        let (file, text) = (self.file, &self.buffer.text);
        if is_step {
            wishes.push(TextWish::step(rats::TextEdit::whole(file, text)));
        } else if has_changed || text != session.text(file) {
            wishes.push(TextWish::edit(rats::TextEdit::whole(file, text)));
        }
    }

    /// Shows the strip in which one finds and replaces, if it is open. Returns whether the text
    /// changed.
    fn show_find(&mut self, ui: &mut Ui) -> bool {
        match self.find.show(ui, &mut self.buffer.text) {
            find::Sought::Nothing => {}
            find::Sought::Show(place) => self.cursor.place = Some(place.start),
            find::Sought::Close(Some(place)) => self.cursor.jump = Some(place),
            find::Sought::Close(None) => place::focus(ui.ctx()),
            find::Sought::Changed => return true,
        }
        false
    }

    /// Returns shapes behind bytes of the text.
    fn shapes_behind(
        &self,
        galley: &Galley,
        origin: Pos2,
        bytes: &Range<usize>,
        colour: egui::Color32,
    ) -> impl Iterator<Item = egui::Shape> {
        let text = &self.buffer.text;
        let chars = to_chars(text, bytes.start)..to_chars(text, bytes.end);
        let rows = marks::rows(galley, chars).into_iter();
        rows.map(move |row| {
            let row = row
                .translate(origin.to_vec2())
                .expand2(egui::vec2(3.0, 0.0));
            egui::Shape::rect_filled(row, 3.0, colour)
        })
    }

    /// Shows the text. Returns the caret's rectangle and place.
    fn text(
        &mut self,
        ui: &mut Ui,
        palette: &'static Palette,
        session: &Session,
        gutter: f32,
        height: f32,
        wishes: &mut Wishes,
    ) -> Option<(Rect, Place)> {
        let dark = ui.visuals().dark_mode;
        let wanted = self
            .cursor
            .jump
            .as_ref()
            .map(|range| range.start)
            .or(self.cursor.place);
        if let Some(byte) = wanted {
            let line = line_of(&self.buffer.text, byte);
            self.look.folding.reveal(self.file, line);
        }
        let (colouring, folding, file) =
            (&mut self.look.colouring, &mut self.look.folding, self.file);
        let margin = Margin {
            left: gutter.min(120.0) as i8,
            right: 12,
            top: 10,
            bottom: 40,
        };
        let behind = ui.painter().add(egui::Shape::Noop);
        let output = TextEdit::multiline(&mut self.buffer.text)
            .id(id())
            .code_editor()
            // Escape closes what is open, and only then leaves the text.
            .event_filter(egui::EventFilter {
                tab: !keyboard::passes(ui.ctx()),
                horizontal_arrows: true,
                vertical_arrows: true,
                escape: self.cards.completions.is_open()
                    || self.cards.signature.is_open(self.cursor.line),
            })
            .frame(egui::Frame::new().inner_margin(margin))
            .desired_width(f32::INFINITY)
            .min_size(egui::vec2(0.0, height))
            .hint_text("Write a dataset here, or pick an example.")
            .layouter(&mut |ui: &Ui, text: &dyn TextBuffer, width: f32| {
                let job = colouring.job(text.as_str(), palette, dark, width);
                let job = folding::hide(job, &folding.update(file, text.as_str()));
                ui.fonts_mut(|fonts| fonts.layout_job(job))
            })
            .show(ui);
        let (galley, origin) = (output.galley.clone(), output.galley_pos);
        if output.response.response.changed() {
            self.cursor.wrote = true;
            self.cursor.typed = ui.input(|input| {
                input.events.iter().any(writes_letters)
                    || self.cards.completions.is_open() && input.key_pressed(Key::Backspace)
            });
        }
        let mut state = output.state;
        if let Some(range) = self.cursor.jump.take() {
            let start = to_chars(&self.buffer.text, range.start);
            let end = to_chars(&self.buffer.text, range.end);
            let selected = CCursorRange::two(CCursor::new(start), CCursor::new(end));
            state.cursor.set_char_range(Some(selected));
            state.clone().store(ui.ctx(), id());
            place::focus(ui.ctx());
            let place = galley.pos_from_cursor(CCursor::new(start));
            ui.scroll_to_rect(place.translate(origin.to_vec2()), Some(Align::Center));
        } else if let Some(byte) = self.cursor.place.take() {
            let cursor = CCursor::new(to_chars(&self.buffer.text, byte));
            state.cursor.set_char_range(Some(CCursorRange::one(cursor)));
            state.clone().store(ui.ctx(), id());
            let place = galley.pos_from_cursor(cursor);
            // With a few rows around it, as a command may take several.
            let around = place
                .translate(origin.to_vec2())
                .expand2(egui::vec2(0.0, 70.0));
            ui.scroll_to_rect(around, None);
        } else if let Some(range) = output.cursor_range {
            let byte = to_bytes(&self.buffer.text, range.primary.index.0);
            let byte = self.out_of_folds(ui, byte, &mut state);
            self.cursor.caret = Some((self.file, byte));
            self.cursor.line = line_of(&self.buffer.text, byte) + 1;
        }
        let mut shapes = Vec::new();
        if let Some((file, range)) = &self.lit
            && *file == self.file
        {
            let light = palette.accent.gamma_multiply(0.22);
            shapes.extend(self.shapes_behind(&galley, origin, range, light));
        }
        let (found, shown) = self.find.places();
        for (index, place) in found.iter().enumerate() {
            let is_shown = shown == Some(index);
            if is_shown || index < LIT {
                let strength = if is_shown { 0.5 } else { 0.18 };
                let light = palette.accent.gamma_multiply(strength);
                shapes.extend(self.shapes_behind(&galley, origin, place, light));
            }
        }
        ui.painter().set(behind, egui::Shape::Vec(shapes));
        self.look
            .marks
            .paint(ui.painter(), palette, &galley, origin);
        let focused = ui.memory(|memory| memory.has_focus(id()));
        let rows = self.line_numbers(ui, palette, &galley, origin, focused);
        let x = origin.x - gutter.min(120.0) + 9.0;
        if let Some(line) = self.look.folding.show(ui, palette, self.file, &rows, x) {
            self.fold(ui, line);
        }
        self.point(&output.response.response, session, &galley, origin, wishes);
        let caret = state.cursor.char_range()?.primary;
        let rect = galley.pos_from_cursor(caret).translate(origin.to_vec2());
        let byte = to_bytes(&self.buffer.text, caret.index.0);
        let file = self.file;
        let place = Place { file, byte };
        let rows = galley.rows.iter();
        let rows = rows.map(|row| row.rect().translate(origin.to_vec2()));
        let room = (rows, ui.max_rect().right() - 10.0);
        (self.cards.tints).show(ui, session, (rect, place), room, wishes);
        Some((rect, place))
    }

    /// Acts on F8, Tab, Shift+Tab, Enter, `}` and Ctrl+/ while the text has the focus. Returns
    /// whether the text changed.
    fn keys(&mut self, ui: &Ui) -> bool {
        if !ui.memory(|memory| memory.has_focus(id())) || keyboard::passes(ui.ctx()) {
            return false;
        }
        let folds = ui.input_mut(|input| input.consume_key(Modifiers::NONE, Key::F8));
        if let (true, Some((_, byte))) = (folds, self.cursor.caret) {
            self.fold(ui, line_of(&self.buffer.text, byte));
        }
        let Some(mut state) = TextEdit::load_state(ui.ctx(), id()) else {
            return false;
        };
        let action: Option<fn(&str, Range<usize>) -> Edited> = ui.input_mut(|input| {
            if input.consume_key(Modifiers::SHIFT, Key::Tab) {
                Some(indent::back_tab as _)
            } else if input.consume_key(Modifiers::NONE, Key::Tab) {
                Some(indent::tab as _)
            } else if input.consume_key(Modifiers::COMMAND, Key::Slash) {
                Some(indent::comment as _)
            } else if input.consume_key(Modifiers::NONE, Key::Enter) {
                Some(indent::enter as _)
            } else if let Some(index) = input.events.iter().position(is_brace) {
                input.events.remove(index);
                Some(indent::brace as _)
            } else {
                None
            }
        });
        let Some(action) = action else {
            return false;
        };
        let selected = state.cursor.char_range().map_or(0..0, |range| {
            range.as_sorted_char_range().start.0..range.as_sorted_char_range().end.0
        });
        let selected =
            to_bytes(&self.buffer.text, selected.start)..to_bytes(&self.buffer.text, selected.end);
        let (text, selected) = action(&self.buffer.text, selected);
        self.buffer.text = text;
        let selected = CCursorRange::two(
            CCursor::new(to_chars(&self.buffer.text, selected.start)),
            CCursor::new(to_chars(&self.buffer.text, selected.end)),
        );
        state.cursor.set_char_range(Some(selected));
        state.store(ui.ctx(), id());
        true
    }

    /// Draws the numbers of the lines in view. Returns those lines, from 0, and their rows.
    fn line_numbers(
        &self,
        ui: &Ui,
        palette: &Palette,
        galley: &Galley,
        origin: Pos2,
        focused: bool,
    ) -> Vec<(usize, Rect)> {
        let mut rows = Vec::new();
        let painter = ui.painter();
        let clip = painter.clip_rect();
        let font = FontId::monospace(11.5);
        let mut line = 1;
        let mut starts = true;
        for row in &galley.rows {
            let rect = row.rect().translate(origin.to_vec2());
            // Folded lines have no height.
            let is_seen = rect.bottom() >= clip.top() && rect.top() <= clip.bottom();
            if starts && is_seen && rect.height() > 2.0 {
                rows.push((line - 1, rect));
                let here = focused && line == self.cursor.line;
                let colour = if here { palette.text } else { palette.comment };
                painter.text(
                    pos2(origin.x - 14.0, rect.center().y),
                    egui::Align2::RIGHT_CENTER,
                    line,
                    font.clone(),
                    colour,
                );
                if let Some(severity) = self.look.marks.of_line(line) {
                    painter.circle_filled(
                        pos2(origin.x - 7.0, rect.center().y),
                        2.5,
                        problems::colour(palette, severity),
                    );
                }
            }
            starts = row.ends_with_newline;
            line += usize::from(starts);
        }
        rows
    }

    /// Folds or unfolds the block around a line, and takes the caret out of a folded one.
    fn fold(&mut self, ui: &Ui, line: usize) {
        let shut = self.look.folding.toggle(self.file, line);
        if let (Some(shut), Some((_, byte))) = (shut, self.cursor.caret)
            && (shut.start + 1..shut.end).contains(&line_of(&self.buffer.text, byte))
        {
            self.cursor.place = Some(end_of_line(&self.buffer.text, shut.start));
        }
        ui.ctx().request_repaint();
    }

    /// Returns the caret's byte outside of folds: arrow keys step over a fold, and any other way
    /// into one opens it.
    fn out_of_folds(
        &mut self,
        ui: &Ui,
        byte: usize,
        state: &mut egui::text_edit::TextEditState,
    ) -> usize {
        let line = line_of(&self.buffer.text, byte);
        let Some(fold) = self.look.folding.around(self.file, line) else {
            return byte;
        };
        let arrows = [
            Key::ArrowUp,
            Key::ArrowDown,
            Key::ArrowLeft,
            Key::ArrowRight,
        ];
        if !ui.input(|input| arrows.iter().any(|key| input.key_pressed(*key))) {
            self.look.folding.reveal(self.file, line);
            ui.ctx().request_repaint();
            return byte;
        }
        let lines = self.buffer.text.matches('\n').count() + 1;
        let went_down = self.cursor.line <= fold.start + 1;
        let target = if went_down && fold.end < lines {
            fold.end
        } else {
            fold.start
        };
        let byte = if went_down && target == fold.end {
            end_of_line(&self.buffer.text, target - 1) + 1
        } else {
            end_of_line(&self.buffer.text, target)
        };
        let cursor = CCursor::new(to_chars(&self.buffer.text, byte));
        state.cursor.set_char_range(Some(CCursorRange::one(cursor)));
        state.clone().store(ui.ctx(), id());
        byte
    }
}

/// Returns the line of a byte, from 0.
fn line_of(text: &str, byte: usize) -> usize {
    text[..text.floor_char_boundary(byte)].matches('\n').count()
}

/// Returns the byte at the end of a line, before its line feed.
fn end_of_line(text: &str, line: usize) -> usize {
    let ends = text.match_indices('\n').map(|(at, _)| at);
    ends.skip(line).chain([text.len()]).next().unwrap_or(0)
}

/// Whether an event types letters or a space, on a keyboard or on that of a phone.
fn writes_letters(event: &egui::Event) -> bool {
    match event {
        egui::Event::Text(text) | egui::Event::Ime(egui::ImeEvent::Commit(text)) => {
            text == " " || !text.is_empty() && text.chars().all(char::is_alphanumeric)
        }
        _ => false,
    }
}
