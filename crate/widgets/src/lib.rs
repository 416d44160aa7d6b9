//! The look of the page, shared by its editor and its lab: two palettes ([`theme`]), two fonts
//! ([`fonts`]), drawn icons ([`icon`]), sliders ([`slider`]), keys ([`keys`]), the width below
//! which a page is narrow ([`screen`]), and the places of widgets for tests that click them
//! ([`places`]).
//!
//! ```
//! use widgets::{icon, places, theme};
//!
//! let context = egui::Context::default();
//! context.set_fonts(widgets::fonts::definitions());
//! theme::apply(&context, false);
//! let output = context.run_ui(egui::RawInput::default(), |ui| {
//!     let undo = icon::button(ui, icon::Icon::Undo, "Undo", true);
//!     places::note(ui.ctx(), "undo", undo.rect);
//! });
//! output.drop_without_applying_deltas();
//! assert!(places::all(&context)["undo"].width() >= 28.0);
//! ```

pub mod fonts;
pub mod icon;
pub mod keys;
pub mod places;
pub mod screen;
pub mod slider;
pub mod theme;
