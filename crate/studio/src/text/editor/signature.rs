//! A quiet line at the caret that says how its command is written and which operand is next.

use super::place::{self, Place};
use crate::theme;
use assist::Signature;
use browser;
use document::session::Session;
use egui::text::{LayoutJob, TextFormat};
use egui::{Area, Color32, FontId, Frame, Order, Rect, Ui, pos2, vec2};

/// Seconds of rest after which a line that takes long is made.
const REST: f64 = 0.2;
/// Seconds up to which a line is quick enough to be made at once.
const QUICK: f64 = 0.003;

/// The line and where it belongs.
#[derive(Default)]
pub struct Line {
    known: Option<(Place, u64, Option<Signature>)>,
    /// Place of the caret and revision of the text, and since when they are so.
    here: Option<(Place, u64, f64)>,
    cost: f64,
    /// The caret's line in which the user closed it.
    closed: Option<usize>,
}

impl Line {
    /// Whether it is on show in the caret's line.
    #[must_use]
    pub fn is_open(&self, line: usize) -> bool {
        self.closed != Some(line) && self.signature().is_some()
    }

    /// Closes it until the caret goes to another line.
    pub fn close(&mut self, line: usize) {
        self.closed = Some(line);
        self.known = None;
    }

    fn signature(&self) -> Option<&Signature> {
        self.known
            .as_ref()
            .and_then(|(_, _, signature)| signature.as_ref())
    }

    /// Shows it above the caret (below where there is no room).
    pub fn show(&mut self, ui: &Ui, session: &Session, place: Place, line: usize, caret: Rect) {
        if self.closed.is_some_and(|closed| closed != line) {
            self.closed = None;
        }
        if self.closed.is_some() {
            return;
        }
        self.update(ui, session, place);
        let Some(signature) = self.signature() else {
            return;
        };
        if signature.parameters.is_empty() || !ui.clip_rect().intersects(caret) {
            return;
        }
        let screen = ui.ctx().content_rect();
        let width = (screen.width() - 24.0).min(520.0);
        let job = lay_out(signature, ui, width);
        let galley = ui.fonts_mut(|fonts| fonts.layout_job(job));
        let size = galley.size() + vec2(16.0, 8.0);
        let left = caret.left().min(screen.right() - size.x - 8.0).max(4.0);
        let above = caret.top() - size.y - 3.0;
        let top = if above >= ui.clip_rect().top() {
            above
        } else {
            caret.bottom() + 3.0
        };
        let spoken = in_words(signature);
        let area = Area::new(egui::Id::unique("signature"))
            .order(Order::Middle)
            .fixed_pos(pos2(left, top))
            .constrain(false)
            .interactable(false);
        let shown = area.show(ui.ctx(), |ui| {
            let palette = theme::palette(ui.visuals());
            Frame::new()
                .fill(palette.raised)
                .stroke(egui::Stroke::new(1.0, palette.line))
                .corner_radius(theme::ROUND)
                .inner_margin(egui::Margin::symmetric(8, 4))
                .show(ui, |ui| {
                    let label = ui.add(egui::Label::new(galley));
                    place::say(ui.ctx(), label.id, &spoken);
                });
        });
        crate::places::note(ui.ctx(), "signature", shown.response.rect);
    }

    fn update(&mut self, ui: &Ui, session: &Session, place: Place) {
        let now = browser::now(ui.ctx());
        let key = (place, session.revision());
        let since = match self.here {
            Some((at, revision, since)) if (at, revision) == key => since,
            _ => {
                self.here = Some((place, session.revision(), now));
                now
            }
        };
        let fresh = self
            .known
            .as_ref()
            .is_some_and(|known| (known.0, known.1) == key);
        if fresh {
            return;
        }
        if self.cost > QUICK && now - since < REST {
            let rest = (REST - (now - since)) as f32;
            ui.ctx().request_repaint_after_secs(rest + 0.002);
            // The line about another place is wrong here.
            self.known = None;
            return;
        }
        let start = pool::clock::stopwatch();
        let signature = assist::signature(session.project(), place.file, place.byte);
        self.cost = pool::clock::stopwatch() - start;
        self.known = Some((place, session.revision(), signature));
    }
}

fn lay_out(signature: &Signature, ui: &Ui, width: f32) -> LayoutJob {
    let palette = theme::palette(ui.visuals());
    let mut job = LayoutJob::default();
    job.wrap.max_width = width;
    job.append(&signature.command, 0.0, format(palette.command));
    for (index, part) in signature.parameters.iter().enumerate() {
        let active = signature.active == Some(index);
        let colour = if active { palette.accent } else { palette.weak };
        job.append(&part.text, 7.0, format(colour));
    }
    if let Some(part) = signature
        .active
        .and_then(|index| signature.parameters.get(index))
    {
        let words = TextFormat::simple(FontId::proportional(12.0), palette.text);
        job.append(&format!("\n{}", part.meaning), 0.0, words);
    }
    job
}

/// Returns the letters of a signature in a colour.
fn format(colour: Color32) -> TextFormat {
    TextFormat::simple(FontId::monospace(12.0), colour)
}

/// Returns the text for screen readers.
fn in_words(signature: &Signature) -> String {
    match signature
        .active
        .and_then(|index| signature.parameters.get(index))
    {
        Some(part) => format!("{}, {}: {}", signature.command, part.text, part.meaning),
        None => signature.command.clone(),
    }
}
