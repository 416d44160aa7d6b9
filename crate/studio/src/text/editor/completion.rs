//! The list of what can be written at the caret: opened by typing a word or with Ctrl+Space, used
//! with the arrow keys, Enter or Tab, closed with Escape.
//!
//! While the user types, a list that takes long to make waits for a short rest, so that typing
//! never waits for it.

use super::place::{self, Place};
use crate::theme::{self, Palette};
use crate::thumbnail::Thumbnails;
use assist::{Completion, CompletionKind, Completions, SymbolKind};
use document::session::Session;
use egui::{
    Align2, Area, Color32, FontId, Frame, Key, Modifiers, Order, Rect, Role, Sense, Ui, WidgetInfo,
    pos2, vec2,
};
use widgets::keys::take_key;

/// Seconds of rest after which a list that takes long is made.
const REST: f64 = 0.15;
/// Seconds up to which a list is quick enough to be made while the user types on.
const QUICK: f64 = 0.004;
/// Letters after which the list opens by itself.
const LETTERS: usize = 2;
/// Size of the picture of the selected row.
const PICTURE: egui::Vec2 = vec2(128.0, 96.0);

/// Returns the number of rows on show and their height: fewer and higher ones for thumbs.
fn rows(style: &egui::Style) -> (usize, f32) {
    if style.spacing.interact_size.y >= 40.0 {
        (5, 36.0)
    } else {
        (8, 22.0)
    }
}

/// The list and where it belongs.
#[derive(Default)]
pub struct Popup {
    /// The completions on offer, and the place that they are for.
    offers: Option<(Place, Completions)>,
    /// The part of the word before the caret, in lower case.
    written: String,
    selected: usize,
    /// Whether the user moved the selection, so that Enter takes it.
    chosen: bool,
    /// Whether the list was asked for.
    asked: bool,
    /// A place for which a list is wanted, and since when; whether it was asked for.
    wanted: Option<(Place, f64, bool)>,
    /// Seconds that making the last list took.
    cost: f64,
    pictures: Thumbnails,
}

/// A choice from the list.
#[derive(Debug, PartialEq)]
pub enum Choice {
    /// Nothing was chosen.
    Nothing,
    /// The completion to write in place of these bytes.
    Take(Completion, std::ops::Range<usize>),
}

impl Popup {
    /// Whether the list is on show.
    #[must_use]
    pub fn is_open(&self) -> bool {
        self.offers.is_some()
    }

    /// Closes the list.
    pub fn close(&mut self) {
        self.offers = None;
        self.wanted = None;
    }

    /// Opens the list at this place, as the user asked for it.
    pub fn ask(&mut self, place: Place) {
        self.wanted = Some((place, f64::NEG_INFINITY, true));
    }

    /// Follows a typed letter, after which the caret is at this place.
    pub fn follow(&mut self, text: &str, place: Place, now: f64) {
        let word = text[..place.byte]
            .chars()
            .rev()
            .take_while(|c| c.is_alphanumeric() || *c == '_')
            .count();
        let was_open = self.is_open();
        self.close();
        // Behind a word, which may be a command that takes a material.
        let line = text[..place.byte].rsplit('\n').next().unwrap_or_default();
        let is_behind = line
            .strip_suffix(' ')
            .is_some_and(|line| line.ends_with(char::is_alphanumeric) && !line.contains('#'));
        if word >= LETTERS || (was_open && word > 0) || is_behind {
            self.wanted = Some((place, now, false));
        }
    }

    /// Makes the list when its time has come, and forgets one whose place was left.
    pub fn update(&mut self, ui: &Ui, session: &Session, here: Place, now: f64) {
        if self
            .offers
            .as_ref()
            .is_some_and(|(place, _)| *place != here)
        {
            self.offers = None;
        }
        let Some((place, since, asked)) = self.wanted else {
            return;
        };
        if place != here {
            self.wanted = None;
            return;
        }
        if self.cost > QUICK && now - since < REST {
            let rest = (REST - (now - since)) as f32;
            ui.ctx().request_repaint_after_secs(rest + 0.002);
            return;
        }
        self.wanted = None;
        let start = pool::clock::stopwatch();
        let completions = assist::complete(session.project(), here.file, here.byte);
        self.cost = pool::clock::stopwatch() - start;
        let typed = session
            .text(here.file)
            .get(completions.replace.clone())
            .unwrap_or_default();
        // Nothing is left to complete.
        let done = completions
            .items
            .iter()
            .any(|item| item.insert.trim_end() == typed);
        let before = completions.replace.start..here.byte;
        let written = session.text(here.file).get(before).unwrap_or_default();
        let is_material = completions
            .items
            .first()
            .is_some_and(|first| first.kind == CompletionKind::Name(SymbolKind::Material));
        let is_wanted = if written.is_empty() {
            is_material
        } else {
            !done
        };
        if !completions.items.is_empty() && (asked || is_wanted) {
            self.asked = asked;
            self.written = written.to_lowercase();
            self.offers = Some((here, completions));
            self.selected = 0;
            self.chosen = false;
        }
    }

    /// Consumes the keys that work on the list, before the text sees them.
    pub fn keys(&mut self, ui: &Ui) -> Choice {
        let Some((_, completions)) = &self.offers else {
            return Choice::Nothing;
        };
        let count = completions.items.len();
        let (page, _) = rows(ui.style());
        let selected = self.selected;
        if take_key(ui.ctx(), Modifiers::NONE, Key::ArrowDown) {
            self.select((selected + 1) % count);
        } else if take_key(ui.ctx(), Modifiers::NONE, Key::ArrowUp) {
            self.select((selected + count - 1) % count);
        } else if take_key(ui.ctx(), Modifiers::NONE, Key::PageDown) {
            self.select((selected + page).min(count - 1));
        } else if take_key(ui.ctx(), Modifiers::NONE, Key::PageUp) {
            self.select(selected.saturating_sub(page));
        } else if take_key(ui.ctx(), Modifiers::NONE, Key::Escape) {
            self.close();
        } else if take_key(ui.ctx(), Modifiers::NONE, Key::Tab) {
            return self.take(selected);
        } else if self.is_meant(selected) {
            if take_key(ui.ctx(), Modifiers::NONE, Key::Enter) {
                return self.take(selected);
            }
        } else if ui.input(|input| input.key_pressed(Key::Enter)) {
            // The line ends here; the text gets the key.
            self.close();
        }
        Choice::Nothing
    }

    fn select(&mut self, to: usize) {
        self.selected = to;
        self.chosen = true;
    }

    /// Whether Enter takes this row: the user moved there, or it begins as the word does.
    fn is_meant(&self, index: usize) -> bool {
        let item = self
            .offers
            .as_ref()
            .and_then(|(_, completions)| completions.items.get(index));
        // Before the first letter of a word Enter ends the line, unless the list was asked for.
        self.chosen
            || (self.asked || !self.written.is_empty())
                && item.is_some_and(|item| item.text.to_lowercase().starts_with(&self.written))
    }

    fn take(&mut self, index: usize) -> Choice {
        let offers = self.offers.take();
        let taken = offers.and_then(|(_, mut completions)| {
            let fits = index < completions.items.len();
            fits.then(|| (completions.items.swap_remove(index), completions.replace))
        });
        match taken {
            Some((item, range)) => Choice::Take(item, range),
            None => Choice::Nothing,
        }
    }

    /// Shows the list below the caret (above where there is no room). Returns the row that was
    /// clicked.
    pub fn show(&mut self, ui: &Ui, caret: Rect) -> Choice {
        let Some((_, completions)) = &self.offers else {
            return Choice::Nothing;
        };
        let palette = theme::palette(ui.visuals());
        let items = &completions.items;
        let (most, row_height) = rows(ui.style());
        let rows = items.len().min(most);
        let first = self
            .selected
            .saturating_sub(most - 1)
            .min(items.len() - rows);
        let screen = ui.ctx().content_rect();
        let width = 380.0_f32.min(screen.width() - 16.0);
        // Room for pictures stays while the selection moves through the list.
        let pictures = if items.iter().any(|item| item.picture.is_some()) {
            PICTURE.y + 8.0
        } else {
            0.0
        };
        let height = rows as f32 * row_height + 36.0 + pictures;
        let below = caret.bottom() + 4.0;
        let top = if below + height <= screen.bottom() {
            below
        } else {
            (caret.top() - 4.0 - height).max(screen.top())
        };
        let left = (caret.left() - 8.0).min(screen.right() - width - 8.0);
        let mut clicked = None;
        let area = Area::new(egui::Id::unique("completions"))
            .order(Order::Foreground)
            .fixed_pos(pos2(left, top))
            .constrain(false)
            .sense(Sense::hover());
        let shown = area.show(ui.ctx(), |ui| {
            Frame::popup(ui.style()).inner_margin(6).show(ui, |ui| {
                ui.set_width(width - 12.0);
                ui.spacing_mut().item_spacing.y = 0.0;
                for (index, item) in items.iter().enumerate().skip(first).take(rows) {
                    let is_selected = index == self.selected;
                    if row(ui, palette, item, is_selected, row_height) {
                        clicked = Some(index);
                    }
                }
                if let Some(item) = items.get(self.selected) {
                    if let Some(path) = item.picture {
                        ui.add_space(4.0);
                        self.pictures.show(ui, path, PICTURE);
                    }
                    let spoken = format!(
                        "{}, {} of {}: {}",
                        item.text,
                        self.selected + 1,
                        items.len(),
                        item.detail
                    );
                    foot(ui, palette, item, &spoken);
                }
            });
        });
        crate::places::note(ui.ctx(), "completions", shown.response.rect);
        clicked.map_or(Choice::Nothing, |index| self.take(index))
    }
}

/// Shows a row. Returns whether it was clicked.
fn row(ui: &mut Ui, palette: &Palette, item: &Completion, selected: bool, height: f32) -> bool {
    let size = vec2(ui.available_width(), height);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    response.widget_info(|| {
        WidgetInfo::selected(Role::ListBoxOption, true, selected, item.text.as_str())
    });
    let painter = ui.painter_at(rect);
    if selected || response.hovered() {
        painter.rect_filled(rect, f32::from(theme::ROUND), palette.hover);
    }
    let (sign, colour) = sign(item.kind, palette);
    let mark = pos2(rect.left() + 11.0, rect.center().y);
    if let Some(swatch) = item.swatch {
        let [r, g, b] = swatch.map(|part| (part.clamp(0.0, 1.0) * 255.0).round() as u8);
        let square = Rect::from_center_size(mark, vec2(11.0, 11.0));
        painter.rect_filled(square, 2.0, Color32::from_rgb(r, g, b));
    } else {
        painter.text(
            mark,
            Align2::CENTER_CENTER,
            sign,
            FontId::monospace(11.0),
            colour,
        );
    }
    let name = painter.text(
        pos2(rect.left() + 24.0, rect.center().y),
        Align2::LEFT_CENTER,
        &item.text,
        FontId::monospace(13.0),
        if selected {
            palette.strong
        } else {
            palette.text
        },
    );
    let left = name.right() + 12.0;
    let room = Rect::from_min_max(pos2(left, rect.top()), rect.max - vec2(6.0, 0.0));
    if room.width() > 30.0 {
        ui.painter_at(room).text(
            pos2(left, rect.center().y),
            Align2::LEFT_CENTER,
            &item.detail,
            FontId::proportional(12.0),
            palette.weak,
        );
    }
    response.clicked()
}

/// Shows the line at the foot, about the selected row. Screen readers say `spoken` when it changes.
fn foot(ui: &mut Ui, palette: &Palette, item: &Completion, spoken: &str) {
    let text = egui::RichText::new(&item.detail)
        .size(12.0)
        .color(palette.weak);
    ui.add_space(4.0);
    let line = ui.add(egui::Label::new(text).truncate());
    place::say(ui.ctx(), line.id, spoken);
}

/// Returns a letter for a kind, and its colour.
fn sign(kind: CompletionKind, palette: &Palette) -> (&'static str, Color32) {
    match kind {
        CompletionKind::Command => ("c", palette.command),
        CompletionKind::Option => ("o", palette.option),
        CompletionKind::Word => ("w", palette.option),
        CompletionKind::Name(_) => ("n", palette.text),
        CompletionKind::Function => ("f", palette.number),
        CompletionKind::Colour => ("#", palette.colour),
    }
}
