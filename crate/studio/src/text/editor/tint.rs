//! Colours of the command at the caret, shown behind its line: a click on one opens the colour
//! picker, which writes into the text.

use super::place::Place;
use crate::places;
use crate::wish::{TextWish, Wishes};
use assist::Tint;
use document::session::Session;
use egui::{Popup, Rect, Ui, UiBuilder, vec2};
use rats::{HotValue, TextEdit, hot};

/// Side of a square of colour.
const SIDE: f32 = 16.0;
/// Space between two squares.
const GAP: f32 = 5.0;
/// Most colours that are shown.
const MOST: usize = 4;

/// The colours of the command at the caret.
#[derive(Default)]
pub struct Tints {
    /// The place and the revision of the text that they belong to.
    of: Option<(Place, u64)>,
    tints: Vec<Tint>,
    /// The place of the colour that is being chosen: writing it moves the caret, perhaps into
    /// another command.
    anchor: Option<Place>,
    dragging: bool,
}

impl Tints {
    /// Shows the colours at the right end of the caret's line, whose rows span `row`.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        session: &Session,
        place: Place,
        row: Rect,
        wishes: &mut Wishes,
    ) {
        if !Popup::is_any_open(ui.ctx()) {
            self.anchor = None;
        }
        let place = self.anchor.unwrap_or(place);
        let key = (place, session.revision());
        if self.of != Some(key) {
            self.of = Some(key);
            self.tints = assist::tints(session.project(), place.file, place.byte);
            self.tints.truncate(MOST);
        }
        let mut dragging = false;
        let count = self.tints.len() as f32;
        let mut left = row.right() - count * (SIDE + GAP);
        for (index, tint) in self.tints.iter().enumerate() {
            let rect = Rect::from_min_size(
                egui::pos2(left, row.center().y - 0.5 * SIDE),
                vec2(SIDE, SIDE),
            );
            left += SIDE + GAP;
            let mut bytes = tint
                .colour
                .map(|part| (part.clamp(0.0, 1.0) * 255.0).round() as u8);
            let builder = UiBuilder::new().max_rect(rect).id_salt(("tint", index));
            // A child of its own, so that the text's place is not moved.
            let mut child = ui.new_child(builder);
            child.spacing_mut().interact_size = rect.size();
            let button = child
                .color_edit_button_srgb(&mut bytes)
                .accessible_name(format!("Colour {} of the line", index + 1))
                .on_hover_text("Choose this colour of the line");
            places::note(ui.ctx(), format!("tint {index}"), rect);
            if button.changed() {
                dragging = ui.input(|input| input.pointer.any_down());
                self.anchor = Some(Place {
                    byte: tint.span.start,
                    ..place
                });
                let colour = bytes.map(|byte| f32::from(byte) / 255.0);
                let colour = hot::write(&HotValue::Colour(colour));
                let edit = TextEdit::new(place.file, tint.span.clone(), colour);
                wishes.push(TextWish::edit(edit));
            }
        }
        wishes.hold_while(dragging, &mut self.dragging);
    }
}
