//! The first shape in five steps: a card above the editor that says what to write, writes it if
//! asked to, and can be skipped.

use crate::page::Page;
use crate::wish::{TextWish, Wishes, WorkWish};
use crate::{places, screen, theme};
use assist::first::{START, STEPS};
use document::session::Session;
use egui::{Button, Frame, Id, Label, Margin, Panel, RichText, Ui, UiBuilder};
use rats::TextEdit;

/// Text of the work that it begins with.
pub const TEXT: &str = START;

/// Shows the button that begins it.
pub fn offer(ui: &mut Ui, wishes: &mut Wishes) {
    let offer = ui.button("Your first shape, in five steps");
    places::note(ui.ctx(), "offer first shape", offer.rect);
    if offer.clicked() {
        wishes.push(WorkWish::First);
    }
    ui.add_space(6.0);
}

/// Returns the number of the open work and its step, if it is the first shape.
pub fn step_of(page: &Page) -> Option<(u64, usize)> {
    page.first.filter(|(of, _)| *of == page.work.number())
}

/// Shows the card of the present step above the rest of `ui`, while its work is open.
pub fn show(page: &Page, ui: &mut Ui, wishes: &mut Wishes) {
    let session = &page.work.session;
    let Some((number, at)) = step_of(page) else {
        return;
    };
    let palette = theme::palette(ui.visuals());
    let step = &STEPS[at];
    let frame = Frame::new()
        .fill(palette.raised)
        .inner_margin(Margin::symmetric(12, 6));
    let card = Panel::top("first shape").frame(frame).show(ui, |ui| {
        let place = format!("{} of {}: {}", at + 1, STEPS.len(), step.title);
        let words = if screen::is_small(ui.ctx()) {
            format!("{place}. {}", step.words)
        } else {
            ui.label(RichText::new(place).color(palette.strong));
            step.words.to_owned()
        };
        let words = ui.add(Label::new(RichText::new(words).size(13.0)).wrap());
        ui.ctx().accesskit_node_builder(words.id, |node| {
            node.set_live(egui::accesskit::Live::Polite);
        });
        if !step.code.is_empty() {
            let mut code = crate::text::code::colour(step.code.trim_end(), palette);
            code.wrap.max_width = ui.available_width();
            ui.add(Label::new(code));
        }
        ui.horizontal_wrapped(|ui| {
            let is_done = is_done(session, at);
            let may_write = !is_done && !step.code.is_empty();
            if may_write && shows(ui, "write", Button::new("Write it")) {
                let end = session.text(0).len();
                let gap = if session.text(0).ends_with('\n') {
                    ""
                } else {
                    "\n"
                };
                let edit = TextEdit::new(0, end..end, format!("{gap}{}", step.code));
                wishes.push(TextWish::step(edit));
            }
            let is_last = at + 1 == STEPS.len();
            let next = RichText::new(if is_last { "Finish" } else { "Next" });
            let next = if is_done {
                Button::new(next.color(palette.on_accent)).fill(palette.accent)
            } else {
                Button::new(next)
            };
            if shows(ui, "next", next) {
                let next = (!is_last).then_some((number, at + 1));
                wishes.push(WorkWish::Step(next));
            }
            if !is_last && shows(ui, "skip", Button::new("Skip")) {
                wishes.push(WorkWish::Step(None));
            }
        });
    });
    places::note(ui.ctx(), "first shape", card.response.rect);
}

/// Shows a button that stays itself where others come and go beside it; returns whether it is
/// clicked.
fn shows(ui: &mut Ui, name: &str, button: Button<'_>) -> bool {
    let part = UiBuilder::new().scope_id(Id::unique(("first shape", name)));
    ui.scope_builder(part, |ui| ui.add(button).clicked()).inner
}

/// Whether the user, or the button, has done what a step asks for.
fn is_done(session: &Session, step: usize) -> bool {
    let compiled = session.compilation();
    let count = compiled.scene.elements.len();
    let is_well = session.errors() == 0;
    is_well
        && match step {
            0 => count >= 1,
            1 => count >= 2,
            2 => !compiled.hot.is_empty(),
            3 => count >= 5,
            _ => session.user_camera().is_some(),
        }
}
