//! Places in a text, and small services for text widgets.

use egui::text::{CCursor, CCursorRange};
use egui::{Id, TextEdit};

/// A place between two characters of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// Index of the file.
    pub file: usize,
    /// Byte in its text.
    pub byte: usize,
}

/// Returns the id of the text widget, the same at every frame and size.
pub fn id() -> Id {
    Id::unique("editor")
}

/// Gives the text the focus, unless it has it: a focus that is requested anew does not keep arrow
/// keys and Tab for a frame.
pub fn focus(ctx: &egui::Context) {
    ctx.memory_mut(|memory| {
        if !memory.has_focus(id()) {
            memory.request_focus(id());
        }
    });
}

/// Selects all of a field's text.
pub fn select_all(ctx: &egui::Context, id: Id, text: &str) {
    let mut state = TextEdit::load_state(ctx, id).unwrap_or_default();
    let end = CCursor::new(text.chars().count());
    let all = CCursorRange::two(CCursor::new(0), end);
    state.cursor.set_char_range(Some(all));
    state.store(ctx, id);
}

/// Lets screen readers say a line when it changes.
pub fn say(ctx: &egui::Context, id: Id, text: &str) {
    ctx.accesskit_node_builder(id, |node| {
        node.set_live(egui::accesskit::Live::Polite);
        node.set_value(text);
    });
}

/// Returns the byte of a character, by its number.
pub fn to_bytes(text: &str, char: usize) -> usize {
    text.char_indices()
        .nth(char)
        .map_or(text.len(), |(byte, _)| byte)
}

/// Returns the number of characters before a byte.
pub fn to_chars(text: &str, byte: usize) -> usize {
    text[..text.floor_char_boundary(byte)].chars().count()
}
