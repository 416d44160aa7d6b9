//! Colours of the command at the caret, shown behind its line, or where a row beside it has room: a
//! click on one opens the colour picker, which writes into the text.

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
    /// Shows the colours at the end `right` of the row nearest to the caret's that has room for
    /// them, of the `rows` of the text.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        session: &Session,
        (caret, place): (Rect, Place),
        (rows, right): (impl Iterator<Item = Rect>, f32),
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
        let mut left = right - self.tints.len() as f32 * (SIDE + GAP);
        let row = roomy(rows, caret, left - GAP);
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

/// Returns the row nearest to the caret's whose text ends left of a place: the lower one of two.
/// Below the last row there is one without text. A folded row has no height, and no room.
fn roomy(rows: impl Iterator<Item = Rect>, caret: Rect, left: f32) -> Rect {
    let mut found = None;
    let mut end = caret;
    for row in rows {
        let distance = (row.center().y - caret.center().y).abs();
        let has_room = row.right() <= left && row.height() > 2.0;
        if has_room && found.is_none_or(|(_, nearest)| distance <= nearest) {
            found = Some((row, distance));
        }
        end = row;
    }
    let below = end.translate(vec2(0.0, caret.height()));
    found.map_or(below, |(row, _)| row)
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::pos2;

    fn row(number: usize, right: f32, height: f32) -> Rect {
        let top = 20.0 * number as f32;
        Rect::from_min_max(pos2(40.0, top), pos2(right, top + height))
    }

    #[test]
    fn colours_lie_over_no_text() {
        // A line of three rows between two others; the one above is folded.
        let rows = [
            row(0, 90.0, 20.0),
            row(1, 60.0, 0.5),
            row(2, 300.0, 20.0),
            row(3, 295.0, 20.0),
            row(4, 120.0, 20.0),
            row(5, 200.0, 20.0),
        ];
        for (caret, own) in [(0, 0), (2, 4), (3, 4), (4, 4), (5, 5)] {
            let found = roomy(rows.into_iter(), row(caret, 41.0, 20.0), 280.0);
            assert_eq!(found, rows[own], "{caret}");
        }
        let caret = row(2, 41.0, 20.0);
        assert_eq!(roomy(rows.into_iter(), caret, 310.0), rows[2]);
        let full = rows[2..4].iter().copied();
        assert_eq!(roomy(full, caret, 280.0).top(), rows[4].top());
    }
}
