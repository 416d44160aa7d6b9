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
///
/// # Errors
/// If neither is a font.
#[cfg(target_arch = "wasm32")]
pub fn set(fonts: [Vec<u8>; 2]) -> Result<(), String> {
    let _ = FETCHED.set(choose(fonts)?);
    Ok(())
}

/// Returns the contents of [`FILES`] with the other font where one is none: there are hosts that
/// answer with a page where a file is missing, and egui ends the program over it.
#[cfg(any(test, target_arch = "wasm32"))]
fn choose([words, texts]: [Vec<u8>; 2]) -> Result<[Vec<u8>; 2], String> {
    // Outlines of TrueType, or of PostScript.
    fn is_font(bytes: &[u8]) -> bool {
        bytes.starts_with(&[0, 1, 0, 0]) || bytes.starts_with(b"OTTO")
    }
    match (is_font(&words), is_font(&texts)) {
        (true, true) => Ok([words, texts]),
        (true, false) => Ok([words.clone(), words]),
        (false, true) => Ok([texts.clone(), texts]),
        (false, false) => {
            let [words, texts] = FILES;
            Err(format!(
                "{words} and {texts} are no fonts. Reload the page."
            ))
        }
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pages_in_place_of_fonts_are_not_taken() {
        let [words, texts] = bytes().map(<[u8]>::to_vec);
        let page = b"<!doctype html>".to_vec();
        let both = [words.clone(), texts.clone()];
        assert_eq!(choose(both.clone()), Ok(both));
        let one = choose([page.clone(), texts.clone()]);
        assert_eq!(one, Ok([texts.clone(), texts]));
        let one = choose([words.clone(), page.clone()]);
        assert_eq!(one, Ok([words.clone(), words]));
        assert!(choose([page, Vec::new()]).is_err());
    }
}
