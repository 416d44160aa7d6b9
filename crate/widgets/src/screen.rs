//! Measures of the page that its layout depends on.

use egui::Context;

/// Width in points below which the parts of the page stand on top of each other.
pub const NARROW: f32 = 700.0;

/// Whether the page is narrow.
#[must_use]
pub fn is_narrow(ctx: &Context) -> bool {
    ctx.content_rect().width() < NARROW
}
