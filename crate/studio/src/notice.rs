//! A message across the top of the picture: something that went wrong or was done, perhaps with a
//! button. There is one at a time.

use crate::icon::{self, Icon};
use crate::wish::{Wish, Wishes};
use crate::{places, theme};
use egui::{Align, Button, Frame, Label, Layout, Margin, Rect, RichText, Ui, vec2};

/// A message.
#[derive(Clone, Debug, PartialEq)]
pub struct Notice {
    /// The text.
    pub text: String,
    /// Whether something went wrong.
    pub bad: bool,
    /// A button: its text and its wish.
    pub action: Option<(String, Wish)>,
    /// Time at which the message disappears by itself, seconds on the app's clock.
    pub until: Option<f64>,
}

impl Notice {
    /// Makes a message about something that was done. It disappears after six seconds.
    #[must_use]
    pub fn success(text: impl Into<String>, now: f64) -> Self {
        Self {
            text: text.into(),
            bad: false,
            action: None,
            until: Some(now + 6.0),
        }
    }

    /// Makes a message about something that went wrong. It stays until it is closed.
    #[must_use]
    pub fn trouble(text: impl Into<String>) -> Self {
        Self {
            text: text.into(),
            bad: true,
            action: None,
            until: None,
        }
    }

    /// Adds a button.
    #[must_use]
    pub fn with_button(mut self, text: &str, wish: impl Into<Wish>) -> Self {
        self.action = Some((text.to_owned(), wish.into()));
        self
    }
}

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
    let shown = frame.show(&mut ui, |ui| {
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if icon::button(ui, Icon::Close, "Close this message", true).clicked() {
                wishes.push(Wish::Close);
            }
            if let Some((text, wish)) = &notice.action {
                let button =
                    Button::new(RichText::new(text).color(palette.on_accent)).fill(palette.accent);
                if ui.add(button).clicked() {
                    wishes.push(wish.clone());
                }
            }
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                ui.add(Label::new(RichText::new(&notice.text).color(palette.text)).wrap());
            });
        });
    });
    places::note(ui.ctx(), "notice", shown.response.rect);
}
