//! Measures of the page that its layout depends on.

use egui::Context;

/// Width in points below which the parts of the page stand on top of each other.
pub const NARROW: f32 = 700.0;
/// Height in points below which the page has no room for all its strips.
pub const LOW: f32 = 480.0;

/// Whether the page is narrow.
#[must_use]
pub fn is_narrow(ctx: &Context) -> bool {
    ctx.content_rect().width() < NARROW
}

/// Whether the page has no room for all its parts at once.
#[must_use]
pub fn is_small(ctx: &Context) -> bool {
    is_narrow(ctx) || ctx.content_rect().height() < LOW
}
