//! The page's two fonts: one for words, one for the text of datasets. Each stands in for the other
//! where a character is missing.
//!
//! The build script leaves out their hinting programs. Letters are kept sharp by egui's own hinter,
//! which works on the bare outlines.

use egui::{FontData, FontDefinitions, FontFamily};
use std::sync::Arc;

const SANS: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/sans.ttf"));
const MONO: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/mono.ttf"));

/// Returns the fonts and their families.
#[must_use]
pub fn definitions() -> FontDefinitions {
    let mut fonts = FontDefinitions::empty();
    for (name, bytes) in [("sans", SANS), ("mono", MONO)] {
        let data = Arc::new(FontData::from_static(bytes));
        fonts.font_data.insert(name.to_owned(), data);
    }
    for (family, names) in [
        (FontFamily::Proportional, ["sans", "mono"]),
        (FontFamily::Monospace, ["mono", "sans"]),
    ] {
        let names = names.map(str::to_owned).to_vec();
        fonts.families.insert(family, names);
    }
    fonts
}
