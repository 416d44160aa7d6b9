//! A small field that renames the name at the caret everywhere.

use super::place::{self, Place};
use crate::theme;
use crate::wish::{TextWish, Wishes};
use document::session::Session;
use egui::{Area, Frame, Id, Key, Order, Rect, RichText, TextEdit, Ui, pos2};

/// The field.
pub struct Rename {
    place: Place,
    /// The session's revision of the text at opening; a change closes the field.
    revision: u64,
    name: String,
    places: usize,
    trouble: Option<String>,
    fresh: bool,
}

impl Rename {
    /// Opens the field for the name at a place.
    ///
    /// # Errors
    /// If no name that the texts define stands there.
    pub fn open(session: &Session, place: Place) -> Result<Self, String> {
        let project = session.project();
        let places = assist::references(project, place.file, place.byte);
        let here = places
            .iter()
            .find(|other| {
                other.file == place.file
                    && other.span.start <= place.byte
                    && place.byte <= other.span.end
            })
            .and_then(|here| session.text(place.file).get(here.span.clone()));
        match here {
            Some(name) => Ok(Self {
                place,
                revision: session.revision(),
                name: name.to_owned(),
                places: places.len(),
                trouble: None,
                fresh: true,
            }),
            None => Err(String::from(
                "F2 renames variables, materials, objects and commands that the text defines. \
                    Put the caret on such a name.",
            )),
        }
    }

    /// Shows the field at the caret. Returns whether it stays open.
    pub fn show(&mut self, ui: &Ui, session: &Session, caret: Rect, wishes: &mut Wishes) -> bool {
        if session.revision() != self.revision {
            return false;
        }
        let id = Id::unique("rename");
        let screen = ui.ctx().content_rect();
        let left = caret.left().min(screen.right() - 240.0).max(4.0);
        let mut open = true;
        let area = Area::new(id.with("area"))
            .order(Order::Foreground)
            .fixed_pos(pos2(left, caret.bottom() + 4.0));
        area.show(ui.ctx(), |ui| {
            let palette = theme::palette(ui.visuals());
            Frame::popup(ui.style()).inner_margin(8).show(ui, |ui| {
                ui.set_width(216.0);
                let field = TextEdit::singleline(&mut self.name)
                    .id(id)
                    .font(egui::TextStyle::Monospace)
                    .desired_width(f32::INFINITY)
                    .hint_text("New name");
                let field = ui.add(field);
                crate::places::note(ui.ctx(), "rename", field.rect);
                if std::mem::take(&mut self.fresh) {
                    field.request_focus();
                    place::select_all(ui.ctx(), id, &self.name);
                }
                if field.changed() {
                    self.trouble = None;
                }
                let (text, colour) = match &self.trouble {
                    Some(trouble) => (trouble.clone(), palette.error),
                    None => {
                        let text = match self.places {
                            1 => String::from("1 place. Enter renames it."),
                            count => format!("{count} places. Enter renames them."),
                        };
                        (text, palette.weak)
                    }
                };
                let line = RichText::new(text).size(12.0).color(colour);
                let line = ui.add(egui::Label::new(line).wrap());
                if let Some(trouble) = &self.trouble {
                    place::say(ui.ctx(), line.id, trouble);
                }
                if field.lost_focus() {
                    open = ui.input(|input| input.key_pressed(Key::Enter))
                        && !self.carry_out(session, wishes);
                    if open {
                        field.request_focus();
                    }
                }
            });
        });
        open
    }

    /// Changes the names, or shows why not. Returns whether they were changed.
    fn carry_out(&mut self, session: &Session, wishes: &mut Wishes) -> bool {
        let Place { file, byte } = self.place;
        match assist::rename(session.project(), file, byte, self.name.trim()) {
            Ok(edits) => {
                wishes.push(TextWish::Edit { edits, step: true });
                true
            }
            Err(trouble) => {
                self.trouble = Some(trouble);
                false
            }
        }
    }
}
