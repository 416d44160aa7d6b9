//! The card about the word under the pointer, and the messages about its place.

use super::place::Place;
use crate::text::marks::Marks;
use crate::thumbnail::Thumbnails;
use crate::{problems, theme};
use assist::Card;
use document::session::Session;
use egui::{Color32, Id, Response, RichText, Ui, vec2};

/// Seconds the pointer rests before the card comes.
const REST: f32 = 0.35;

/// The card that was asked for last.
#[derive(Default)]
pub struct Hover {
    card: Option<(Place, u64, Option<Card>)>,
    /// The command that the card on show is about.
    command: Option<&'static str>,
    revision: u64,
    /// Whether the pointer has not moved since the text changed: no card comes while the user
    /// types.
    still: bool,
    pointer: Option<egui::Pos2>,
    pictures: Thumbnails,
}

impl Hover {
    /// Takes the command that the card of the last frame was about.
    pub fn take_command(&mut self) -> Option<&'static str> {
        self.command.take()
    }

    /// Shows the messages and, after a rest, the card about a place of the text under the pointer.
    pub fn show(
        &mut self,
        response: &Response,
        session: &Session,
        marks: &Marks,
        char: usize,
        place: Place,
    ) {
        let ctx = &response.ctx;
        let messages: Vec<usize> = marks.at(char).take(5).collect();
        self.still |= self.revision != session.revision();
        self.revision = session.revision();
        let pointer = response.hover_pos();
        self.still &= self.pointer == pointer;
        self.pointer = pointer;
        let rested = ctx.input(|input| {
            let pointer = &input.pointer;
            if pointer.any_down() {
                0.0
            } else {
                pointer
                    .time_since_last_movement()
                    .min(pointer.time_since_last_click())
            }
        });
        let key = (place, session.revision());
        let known = |card: &&(Place, u64, Option<Card>)| (card.0, card.1) == key;
        if self.still {
            self.card = None;
        } else if rested < REST {
            if self.card.as_ref().filter(known).is_none() {
                ctx.request_repaint_after_secs(REST - rested + 0.01);
            }
        } else if self.card.as_ref().filter(known).is_none() {
            let card = assist::hover(session.project(), place.file, place.byte);
            self.card = Some((place, session.revision(), card));
        }
        let card = self.card.as_ref().filter(known);
        let card = card.and_then(|(_, _, card)| card.as_ref());
        self.command = card.and_then(|card| card.command);
        if messages.is_empty() && card.is_none() {
            return;
        }
        egui::Tooltip::always_open(
            ctx.clone(),
            response.layer_id,
            Id::unique("editor tooltip"),
            egui::PopupAnchor::Pointer,
        )
        .gap(14.0)
        .show(|ui| {
            for index in messages {
                message(ui, session, index);
            }
            if let Some(card) = card {
                show_card(ui, card, &mut self.pictures);
            }
        });
    }
}

fn message(ui: &mut Ui, session: &Session, index: usize) {
    let palette = theme::palette(ui.visuals());
    let Some(diagnostic) = session.messages().get(index) else {
        return;
    };
    let colour = problems::colour(palette, diagnostic.severity);
    ui.label(RichText::new(&diagnostic.message).color(colour));
    if let Some(hint) = &diagnostic.hint {
        ui.label(RichText::new(hint).color(palette.weak));
    }
    for related in &diagnostic.related {
        let text = format!("line {}: {}", related.line, related.message);
        ui.label(RichText::new(text).color(palette.note));
    }
}

fn show_card(ui: &mut Ui, card: &Card, pictures: &mut Thumbnails) {
    let palette = theme::palette(ui.visuals());
    ui.horizontal(|ui| {
        if let Some(swatch) = card.swatch {
            let [r, g, b] = swatch.map(|part| (part.clamp(0.0, 1.0) * 255.0).round() as u8);
            let (rect, _) = ui.allocate_exact_size(vec2(16.0, 16.0), egui::Sense::hover());
            ui.painter()
                .rect_filled(rect, 3.0, Color32::from_rgb(r, g, b));
        }
        let title = RichText::new(&card.title)
            .monospace()
            .size(12.5)
            .color(palette.command);
        ui.add(egui::Label::new(title).wrap());
    });
    if let Some(path) = card.picture {
        pictures.show(ui, path, vec2(160.0, 120.0));
    }
    for line in card.lines.iter().take(12) {
        let text = RichText::new(line).size(12.5).color(palette.text);
        ui.add(egui::Label::new(text).wrap());
    }
    if card.command.is_some() {
        ui.label(RichText::new("F1: manual").size(11.5).color(palette.weak));
    }
}
