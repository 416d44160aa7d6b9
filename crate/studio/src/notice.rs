//! The message across the top of the picture. There is one at a time.

use crate::icon::{self, Icon};
use crate::wish::{Notice, Wish, Wishes};
use crate::{places, theme};
use egui::{Align, Button, Frame, Label, Layout, Margin, Rect, RichText, Ui, vec2};

/// Shows a message at the top of a place.
pub fn show(ui: &mut Ui, place: Rect, notice: &Notice, wishes: &mut Wishes) {
    let palette = theme::palette(ui.visuals());
    let width = (place.width() - 24.0).min(620.0);
    let top = place.center_top() + vec2(-width / 2.0, 12.0);
    let place = Rect::from_min_size(top, vec2(width, 10.0));
    let part = places::part("notice", place).layout(Layout::top_down(Align::Min));
    let mut ui = ui.new_child(part);
    let edge = if notice.bad {
        palette.error
    } else {
        palette.accent
    };
    let frame = Frame::new()
        .fill(palette.raised)
        .stroke(egui::Stroke::new(1.0, edge))
        .corner_radius(10)
        .shadow(ui.visuals().popup_shadow)
        .inner_margin(Margin::symmetric(14, 8));
    // Buttons that leave little room for the words stand below them.
    let is_below = notice.actions.len() > 1 && width < 520.0;
    let shown = frame.show(&mut ui, |ui| {
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if icon::button(ui, Icon::Close, "Close this message", true).clicked() {
                wishes.push(Wish::Close);
            }
            if !is_below {
                buttons(ui, notice, wishes);
            }
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                let words = RichText::new(&notice.text).color(palette.text);
                let words = ui.add(Label::new(words).wrap());
                ui.ctx().accesskit_node_builder(words.id, |node| {
                    node.set_live(egui::accesskit::Live::Polite);
                });
            });
        });
        if is_below {
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                buttons(ui, notice, wishes)
            });
        }
    });
    places::note(ui.ctx(), "notice", shown.response.rect);
}

/// Shows the buttons of a message, the last one first.
fn buttons(ui: &mut Ui, notice: &Notice, wishes: &mut Wishes) {
    let palette = theme::palette(ui.visuals());
    for (text, wish) in notice.actions.iter().rev() {
        let button = Button::new(RichText::new(text).color(palette.on_accent)).fill(palette.accent);
        let button = ui.add(button);
        places::note(ui.ctx(), text.to_lowercase(), button.rect);
        if button.clicked() {
            wishes.push(wish.clone());
        }
    }
}
