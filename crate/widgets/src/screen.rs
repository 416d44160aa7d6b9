//! Measures of the page that its layout depends on.

use egui::Context;

/// Below this width in points the parts stand on top of each other.
pub const NARROW: f32 = 700.0;

/// Whether the page is narrow.
#[must_use]
pub fn is_narrow(ctx: &Context) -> bool {
    ctx.content_rect().width() < NARROW
}
