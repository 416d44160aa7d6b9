//! The editor's queries to the language, and its use of the answers: opening the completions and
//! writing one, going to definitions, renaming, laying the text out, the card under the pointer.

use super::completion::Choice;
use super::place::{self, Place, id, to_bytes, to_chars};
use super::{Editor, rename};
use crate::wish::{TextWish, Wish, Wishes};
use document::session::Session;
use egui::text::{CCursor, CCursorRange};
use egui::{Galley, Key, Modifiers, Pos2, Rect, TextEdit, Ui};
use widgets::keys::take_key;

impl Editor {
    /// Shows the field for a new name, if it is open.
    pub(super) fn show_rename(
        &mut self,
        ui: &Ui,
        session: &Session,
        caret: Rect,
        wishes: &mut Wishes,
    ) {
        let Some(rename) = &mut self.cards.rename else {
            return;
        };
        if !rename.show(ui, session, caret, wishes) {
            self.cards.rename = None;
            place::focus(ui.ctx());
        }
    }

    /// Place of the caret.
    pub(super) fn place(&self) -> Option<Place> {
        let caret = self.cursor.before?.primary.index.0;
        Some(Place {
            file: self.file,
            byte: to_bytes(&self.buffer.text, caret),
        })
    }

    /// Opens the completions after a typed letter, and closes them when the caret is elsewhere.
    pub(super) fn offer(&mut self, ui: &Ui, session: &Session) {
        let focused = ui.memory(|memory| memory.has_focus(id()));
        let now = browser::now(ui.ctx());
        let typed = std::mem::take(&mut self.cursor.typed);
        match self.place() {
            Some(place) if focused => {
                if typed {
                    self.cards.completions.follow(&self.buffer.text, place, now);
                }
                self.cards.completions.update(ui, session, place, now);
            }
            // A click into the list takes the focus for a moment.
            _ if !ui.input(|input| input.pointer.any_down() || input.pointer.any_released()) => {
                self.cards.completions.close();
            }
            _ => {}
        }
    }

    /// Writes a completion that was chosen. Returns whether there was one.
    pub(super) fn write(&mut self, ui: &Ui, chosen: Choice) -> bool {
        let Choice::Take(item, range) = chosen else {
            return false;
        };
        if self.buffer.text.get(range.clone()).is_none() {
            return false;
        }
        self.buffer.text.replace_range(range.clone(), &item.insert);
        self.put_caret(ui.ctx(), range.start + item.insert.len());
        place::focus(ui.ctx());
        true
    }

    /// Puts the caret at a byte.
    pub(super) fn put_caret(&mut self, ctx: &egui::Context, byte: usize) {
        let mut state = TextEdit::load_state(ctx, id()).unwrap_or_default();
        let caret = CCursorRange::one(CCursor::new(to_chars(&self.buffer.text, byte)));
        state.cursor.set_char_range(Some(caret));
        state.store(ctx, id());
        self.cursor.before = Some(caret);
    }

    /// Acts on keys that ask about the text: completions, manual, definition, renaming, layout.
    pub(super) fn ask(&mut self, ui: &Ui, session: &Session, wishes: &mut Wishes) {
        // The card under the pointer comes before the caret.
        if let Some(command) = self.cards.hover.take_command()
            && take_key(ui.ctx(), Modifiers::NONE, Key::F1)
        {
            wishes.push(Wish::Manual(command.to_owned()));
            return;
        }
        let Some(place) = self.place() else {
            return;
        };
        if !ui.memory(|memory| memory.has_focus(id())) {
            return;
        }
        if take_key(ui.ctx(), Modifiers::CTRL, Key::Space)
            || take_key(ui.ctx(), Modifiers::COMMAND, Key::Space)
        {
            self.cards.completions.ask(place);
            ui.ctx().request_repaint();
        } else if take_key(ui.ctx(), Modifiers::NONE, Key::F1) {
            let card = assist::hover(session.project(), place.file, place.byte);
            let command = card.and_then(|card| card.command);
            wishes.push(Wish::Manual(command.unwrap_or_default().to_owned()));
        } else if take_key(ui.ctx(), Modifiers::NONE, Key::F12) {
            self.go_to_definition(session, place, wishes);
        } else if take_key(ui.ctx(), Modifiers::NONE, Key::F2) {
            match rename::Rename::open(session, place) {
                Ok(field) => self.cards.rename = Some(field),
                Err(trouble) => wishes.push(Wish::Tell(trouble)),
            }
        } else if take_key(ui.ctx(), Modifiers::COMMAND | Modifiers::SHIFT, Key::F) {
            self.format(session, wishes);
        } else if self.cards.signature.is_open(self.cursor.line)
            && ui.input(|input| input.key_pressed(Key::Escape))
        {
            // The key goes on: it also lets go of what is chosen in the picture.
            self.cards.signature.close(self.cursor.line);
        }
    }

    /// Goes to the definition of the name at a place.
    pub(super) fn go_to_definition(&self, session: &Session, place: Place, wishes: &mut Wishes) {
        let found = assist::definition(session.project(), place.file, place.byte);
        wishes.push(match found {
            Some(found) => Wish::from(TextWish::Jump {
                file: found.file,
                range: found.span,
            }),
            None => Wish::Tell(String::from(
                "The texts do not define the name at the caret. F12 and Ctrl+click go to where a \
                    variable, material, object or command is defined.",
            )),
        });
    }

    /// Formats the file; the caret stays in its line.
    pub fn format(&mut self, session: &Session, wishes: &mut Wishes) {
        let text = session.text(self.file);
        let formatted = assist::format(text);
        if formatted != text {
            let lines = formatted.split_inclusive('\n');
            let before = lines.take(self.cursor.line.saturating_sub(1));
            self.cursor.place = Some(before.map(str::len).sum());
            wishes.push(TextWish::step(rats::TextEdit::whole(self.file, formatted)));
        }
    }

    /// Shows a card about the name under the pointer, or with Ctrl and a click goes to its
    /// definition.
    pub(super) fn point(
        &mut self,
        response: &egui::Response,
        session: &Session,
        galley: &Galley,
        origin: Pos2,
        wishes: &mut Wishes,
    ) {
        let Some(pointer) = response.hover_pos() else {
            return;
        };
        let inside = Rect::from_min_size(origin, galley.size()).expand(4.0);
        // While a list is open at the caret, nothing else opens beside it.
        if !inside.contains(pointer)
            || self.cards.completions.is_open()
            || self.cards.rename.is_some()
        {
            return;
        }
        let char = galley.cursor_from_pos(pointer - origin).index.0;
        let place = Place {
            file: self.file,
            byte: to_bytes(&self.buffer.text, char),
        };
        if response.ctx.input(|input| input.modifiers.command) {
            response.ctx.set_cursor_icon(egui::CursorIcon::PointingHand);
            if response.clicked() {
                self.go_to_definition(session, place, wishes);
            }
            return;
        }
        self.cards
            .hover
            .show(response, session, &self.look.marks, char, place);
    }
}
