//! The strip above the text for finding, replacing and going to a line.

use super::place;
use crate::icon::{self, Icon};
use crate::{places, theme};
use egui::{Id, Key, Modifiers, RichText, TextEdit, Ui};
use std::ops::Range;

/// Most places that are found.
const MOST: usize = 2000;

/// The use of the strip.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Seek {
    /// Find a text.
    #[default]
    Text,
    /// Find a text and replace it.
    Replace,
    /// Go to a line.
    Line,
}

/// The strip, if it is open.
#[derive(Default)]
pub struct Find {
    /// The use of it; `None` while it is closed.
    seek: Option<Seek>,
    needle: String,
    with: String,
    line: String,
    /// Whether the field is to have the focus at the next frame.
    focus: bool,
    /// The byte from which the next place is sought.
    from: usize,
    /// The places that were found, and the one on show among them.
    found: Vec<Range<usize>>,
    at: Option<usize>,
}

/// The strip's wish.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Sought {
    /// Nothing.
    Nothing,
    /// Show a place.
    Show(Range<usize>),
    /// Close the strip, and select a place.
    Close(Option<Range<usize>>),
    /// Take over the text that was changed.
    Changed,
}

fn id() -> Id {
    Id::unique("find")
}

/// Returns the id of the field for the text that replaces.
fn with_id() -> Id {
    Id::unique("replace with")
}

/// Returns the keys that a field of the strip keeps: with Escape the strip closes.
fn filter() -> egui::EventFilter {
    egui::EventFilter {
        horizontal_arrows: true,
        vertical_arrows: true,
        escape: true,
        tab: false,
    }
}

impl Find {
    /// Opens the strip, which looks for the selected text from a byte on.
    pub(super) fn open(&mut self, seek: Seek, selected: &str, from: usize) {
        self.seek = Some(seek);
        self.focus = true;
        self.from = from;
        self.line.clear();
        if !selected.is_empty() && !selected.contains('\n') {
            selected.clone_into(&mut self.needle);
        }
    }

    /// Closes the strip.
    pub(super) fn close(&mut self) {
        self.seek = None;
        self.found.clear();
    }

    /// Returns the places that were found, and the one on show.
    pub(super) fn places(&self) -> (&[Range<usize>], Option<usize>) {
        (&self.found, self.at)
    }

    /// Shows the strip at the top of `ui`, if it is open. It may change the text.
    pub(super) fn show(&mut self, ui: &mut Ui, text: &mut String) -> Sought {
        let Some(seek) = self.seek else {
            return Sought::Nothing;
        };
        let mut sought = Sought::Nothing;
        let strip = egui::Frame::new()
            .fill(theme::palette(ui.visuals()).panel)
            .inner_margin(egui::Margin::symmetric(10, 5))
            .show(ui, |ui| {
                ui.set_width(ui.available_width());
                sought = if seek == Seek::Line {
                    self.show_line(ui, text)
                } else {
                    self.show_text(ui, text, seek == Seek::Replace)
                };
            });
        places::note(ui.ctx(), "find", strip.response.rect);
        if matches!(sought, Sought::Close(_)) {
            self.close();
        }
        sought
    }

    fn show_line(&mut self, ui: &mut Ui, text: &str) -> Sought {
        let (enter, escape) = keys(ui);
        let lines = text.matches('\n').count() + 1;
        let mut closes = escape;
        ui.horizontal(|ui| {
            let hint = format!("Line, 1 to {lines}");
            self.field(ui, |find| &mut find.line, &hint, 120.0);
            closes |= icon::button(ui, Icon::Close, "Close", true).clicked();
        });
        let line = self.line.trim().parse::<usize>();
        match line {
            Ok(line) if enter.is_some() => {
                let start = start_of_line(text, line.clamp(1, lines));
                Sought::Close(Some(start..start))
            }
            _ if closes => Sought::Close(None),
            _ => Sought::Nothing,
        }
    }

    fn show_text(&mut self, ui: &mut Ui, text: &mut String, replaces: bool) -> Sought {
        let (enter, escape) = keys(ui);
        let mut step = enter;
        let mut closes = escape;
        self.seek_in(text);
        ui.horizontal(|ui| {
            let width = (ui.available_width() - 180.0).clamp(90.0, 240.0);
            if self.field(ui, |find| &mut find.needle, "Find", width) {
                self.seek_in(text);
                step = Some(0);
            }
            let count = match (self.at, self.found.len()) {
                (_, 0) if self.needle.is_empty() => String::new(),
                (_, 0) => String::from("none"),
                (Some(at), all) => format!("{} of {all}", at + 1),
                (None, all) => format!("{all}"),
            };
            let some = !self.found.is_empty();
            if icon::button(ui, Icon::Up, "The one before (Shift+Enter)", some).clicked() {
                step = Some(-1);
            }
            if icon::button(ui, Icon::Down, "The next one (Enter)", some).clicked() {
                step = Some(1);
            }
            closes |= icon::button(ui, Icon::Close, "Close (Escape)", true).clicked();
            ui.label(RichText::new(count).size(12.5));
        });
        let mut changed = false;
        if replaces {
            ui.horizontal(|ui| {
                let width = (ui.available_width() - 180.0).clamp(90.0, 240.0);
                let field = TextEdit::singleline(&mut self.with)
                    .id(with_id())
                    .event_filter(filter())
                    .hint_text("Replace with")
                    .desired_width(width);
                let field = ui.add(field);
                places::note(ui.ctx(), "replace with", field.rect);
                let one = ui.button("Replace");
                places::note(ui.ctx(), "replace", one.rect);
                let all = ui.button("All");
                places::note(ui.ctx(), "replace all", all.rect);
                if one.clicked() {
                    changed = self.replace(text);
                } else if all.clicked() {
                    changed = self.replace_all(text);
                }
            });
        }
        if changed {
            return Sought::Changed;
        }
        let place = step.and_then(|step| self.step(step));
        if closes {
            return Sought::Close(self.at.and_then(|at| self.found.get(at).cloned()));
        }
        place.map_or(Sought::Nothing, Sought::Show)
    }

    /// Shows the field of the strip. Returns whether its text changed.
    fn field(
        &mut self,
        ui: &mut Ui,
        of: fn(&mut Self) -> &mut String,
        hint: &str,
        width: f32,
    ) -> bool {
        let takes_focus = std::mem::take(&mut self.focus);
        let text = of(self);
        if takes_focus {
            place::select_all(ui.ctx(), id(), text);
        }
        let field = TextEdit::singleline(text)
            .id(id())
            .event_filter(filter())
            .hint_text(hint)
            .desired_width(width);
        let field = ui.add(field);
        places::note(ui.ctx(), "find field", field.rect);
        if takes_focus {
            field.request_focus();
        }
        field.changed()
    }

    /// Finds all places in a text.
    fn seek_in(&mut self, text: &str) {
        let shown = self.at.and_then(|at| self.found.get(at).cloned());
        self.found = find(text, &self.needle);
        self.at = shown.and_then(|shown| self.found.iter().position(|found| *found == shown));
    }

    /// Goes to the next place, to the one before, or with 0 to the first behind where one began.
    fn step(&mut self, step: isize) -> Option<Range<usize>> {
        let count = self.found.len();
        if count == 0 {
            return None;
        }
        let behind = self.found.iter().position(|found| found.start >= self.from);
        let at = match (self.at, step) {
            (Some(at), -1) => (at + count - 1) % count,
            (Some(at), 1) => (at + 1) % count,
            (None, -1) => (behind.unwrap_or(0) + count - 1) % count,
            _ => behind.unwrap_or(0),
        };
        self.at = Some(at);
        Some(self.found[at].clone())
    }

    /// Replaces the place on show, or shows the first if there is none. Returns whether the text
    /// changed.
    fn replace(&mut self, text: &mut String) -> bool {
        let shown = self.at.and_then(|at| self.found.get(at).cloned());
        let Some(place) = shown else {
            self.step(0);
            return false;
        };
        self.from = place.start + self.with.len();
        text.replace_range(place, &self.with);
        self.at = None;
        self.seek_in(text);
        self.step(0);
        true
    }

    /// Replaces all places. Returns whether there were any.
    fn replace_all(&mut self, text: &mut String) -> bool {
        let all = std::mem::take(&mut self.found);
        for place in all.iter().rev() {
            text.replace_range(place.clone(), &self.with);
        }
        self.at = None;
        !all.is_empty()
    }
}

/// Takes the keys of the strip while one of its fields has the focus: Enter as a step, and whether
/// it is Escape.
fn keys(ui: &Ui) -> (Option<isize>, bool) {
    let is_here = ui.memory(|memory| memory.has_focus(id()) || memory.has_focus(with_id()));
    if !is_here {
        return (None, false);
    }
    ui.input_mut(|input| {
        let before = input.consume_key(Modifiers::SHIFT, Key::Enter);
        let next = input.consume_key(Modifiers::NONE, Key::Enter);
        let escape = input.consume_key(Modifiers::NONE, Key::Escape);
        let step = if before { Some(-1) } else { next.then_some(1) };
        (step, escape)
    })
}

/// Returns the places of a text in another. Without a capital letter it is found in either case.
fn find(text: &str, needle: &str) -> Vec<Range<usize>> {
    if needle.is_empty() {
        return Vec::new();
    }
    let (text, needle) = if needle.chars().any(char::is_uppercase) {
        (text.to_owned(), needle.to_owned())
    } else {
        // These have the same bytes at the same places.
        (text.to_ascii_lowercase(), needle.to_ascii_lowercase())
    };
    text.match_indices(&needle)
        .take(MOST)
        .map(|(at, found)| at..at + found.len())
        .collect()
}

/// Returns the byte at which a line begins, from 1.
fn start_of_line(text: &str, line: usize) -> usize {
    let ends = text.match_indices('\n').map(|(at, _)| at + 1);
    [0].into_iter()
        .chain(ends)
        .nth(line - 1)
        .unwrap_or(text.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn capitals_count_only_where_they_are_asked_for() {
        let text = "Sphere a\nsphere ä\nSPHERE";
        assert_eq!(find(text, "sphere"), [0..6, 9..15, 19..25]);
        assert_eq!(find(text, "Sphere").first(), Some(&(0..6)));
        assert_eq!(find(text, "Sphere").len(), 1);
        assert_eq!(find(text, "ä").first(), Some(&(16..18)));
        assert_eq!(find(text, ""), []);
        assert_eq!(find("aaaa", "aa"), [0..2, 2..4], "places do not overlap");
    }

    #[test]
    fn steps_go_around_and_begin_behind_the_caret() {
        let mut find = Find::default();
        find.open(Seek::Replace, "a", 3);
        find.with = String::from("aa");
        let mut text = String::from("a b a c a");
        find.seek_in(&text);
        assert_eq!(find.step(1), Some(4..5));
        assert_eq!(find.step(1), Some(8..9));
        assert_eq!(find.step(1), Some(0..1));
        assert_eq!(find.step(-1), Some(8..9));
        assert!(find.replace(&mut text));
        assert_eq!((text.as_str(), find.at), ("a b a c aa", Some(0)));
        assert!(find.replace(&mut text));
        assert_eq!(
            (text.as_str(), find.at),
            ("aa b a c aa", Some(2)),
            "not what was written"
        );
        find.seek_in(&text);
        assert!(find.replace_all(&mut text));
        assert_eq!(text, "aaaa b aa c aaaa");
        find.needle = String::from("x");
        find.seek_in(&text);
        assert!(!find.replace_all(&mut text) && find.step(1).is_none());
    }

    #[test]
    fn lines_begin_behind_line_feeds() {
        let text = "a\n\nä\nb";
        let starts: Vec<usize> = (1..=6).map(|line| start_of_line(text, line)).collect();
        assert_eq!(starts, [0, 2, 3, 6, 7, 7]);
    }
}
