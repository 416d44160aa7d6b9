//! The page's two fonts: one for words, one for the text of datasets. Each stands in for the other
//! where a character is missing.
//!
//! The build script leaves out their hinting programs. Letters are kept sharp by egui's own hinter,
//! which works on the bare outlines.

use egui::{FontData, FontDefinitions, FontFamily};
use std::sync::Arc;

/// The files of the fonts, beside the page, which fetches them before its window starts.
pub const FILES: [&str; 2] = ["sans.ttf", "mono.ttf"];

/// The contents of [`FILES`].
#[cfg(target_arch = "wasm32")]
static FETCHED: std::sync::OnceLock<[Vec<u8>; 2]> = std::sync::OnceLock::new();

/// Sets the contents of [`FILES`], once.
#[cfg(target_arch = "wasm32")]
pub fn set(fonts: [Vec<u8>; 2]) {
    let _ = FETCHED.set(fonts);
}

/// Returns the fonts for words and for texts.
#[cfg(target_arch = "wasm32")]
fn bytes() -> [&'static [u8]; 2] {
    FETCHED
        .get()
        .map_or([&[]; 2], |fonts| fonts.each_ref().map(|font| &font[..]))
}

/// Returns the fonts for words and for texts: native programs hold them.
#[cfg(not(target_arch = "wasm32"))]
fn bytes() -> [&'static [u8]; 2] {
    [
        include_bytes!(concat!(env!("OUT_DIR"), "/sans.ttf")),
        include_bytes!(concat!(env!("OUT_DIR"), "/mono.ttf")),
    ]
}

/// Returns the fonts and their families.
#[must_use]
pub fn definitions() -> FontDefinitions {
    let mut fonts = FontDefinitions::empty();
    for (name, bytes) in ["sans", "mono"].into_iter().zip(bytes()) {
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
