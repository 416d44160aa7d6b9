//! Places of the widgets: parts of the page that keep their identity, and rectangles of widgets for
//! tests that drive the page from outside, as a canvas has no elements that they could look for.

use egui::{Context, Id, Rect, UiBuilder};
use std::collections::BTreeMap;

/// Names and rectangles, in points.
pub type Places = BTreeMap<String, Rect>;

fn id() -> Id {
    Id::unique("places")
}

/// Returns a builder for a part of the page. egui tells widgets from each other by their order, so
/// that one that comes or goes (a spinner, a strip) would give those after it another identity, and
/// a click that has begun on one of them would be lost. The widgets of a part are counted apart.
pub fn part(name: &str, place: Rect) -> UiBuilder {
    UiBuilder::new()
        .scope_id(Id::unique(("part", name)))
        .max_rect(place)
}

/// Forgets all places: a new frame begins.
pub fn clear(ctx: &Context) {
    ctx.data_mut(|data| data.get_temp_mut_or_default::<Places>(id()).clear());
}

/// Notes the place of a widget.
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
