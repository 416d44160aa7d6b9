//! Places of the widgets, for tests that drive the page from outside: a canvas has no elements that
//! they could look for.

use egui::{Context, Id, Rect};
use std::collections::BTreeMap;

/// Names and rectangles, in points.
pub type Places = BTreeMap<String, Rect>;

fn id() -> Id {
    Id::unique("places")
}

/// Forgets all places: a new frame begins.
pub fn clear(ctx: &Context) {
    ctx.data_mut(|data| data.get_temp_mut_or_default::<Places>(id()).clear());
}

/// Notes where a widget is.
pub fn note(ctx: &Context, name: impl Into<String>, rect: Rect) {
    ctx.data_mut(|data| {
        data.get_temp_mut_or_default::<Places>(id())
            .insert(name.into(), rect);
    });
}

/// Returns the places of the last frame.
#[must_use]
pub fn all(ctx: &Context) -> Places {
    ctx.data(|data| data.get_temp::<Places>(id()))
        .unwrap_or_default()
}
