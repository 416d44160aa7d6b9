//! The fonts of the page: no sign is missing, and leaving out their hinting changed no letter.

use egui::epaint::text::{FontId, Fonts, LayoutJob, TextFormat, TextOptions};
use egui::{Color32, FontData, FontDefinitions, FontFamily};
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;

fn characters(folder: &Path, kinds: &[&str], found: &mut BTreeSet<char>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            characters(&path, kinds, found);
        } else if path
            .extension()
            .is_some_and(|kind| kinds.iter().any(|known| kind == *known))
        {
            let text = std::fs::read_to_string(&path).unwrap();
            // Texts of tests and comments are not drawn.
            let text = text.split("#[cfg(test)]").next().unwrap();
            let lines = text
                .lines()
                .filter(|line| !line.trim_start().starts_with("//"));
            found.extend(lines.flat_map(str::chars).filter(|c| !c.is_control()));
        }
    }
}

#[test]
fn every_sign_that_the_page_writes_can_be_drawn() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut signs = BTreeSet::new();
    for folder in [
        "src",
        "../browser/src",
        "../document/src",
        "../field/src/kernel",
        "../lab/src",
        "../widgets/src",
        "../rats/src",
        "../scene/src",
        "../../www",
    ] {
        characters(&root.join(folder), &["rs", "rat"], &mut signs);
    }
    assert!(signs.contains(&'…') && signs.contains(&'ρ'), "{signs:?}");
    let mut fonts = Fonts::new(TextOptions::default(), studio::fonts::definitions());
    for family in [FontFamily::Proportional, FontFamily::Monospace] {
        let id = FontId::new(14.0, family.clone());
        let missing: Vec<char> = signs
            .iter()
            .copied()
            .filter(|sign| !fonts.has_glyph(&id, *sign))
            .collect();
        assert_eq!(missing, [], "{family:?}");
    }
}

/// Draws all signs that both fonts have, without hinting. Returns the sizes and the atlas.
fn draw(definitions: FontDefinitions) -> (Vec<[f32; 2]>, egui::ColorImage) {
    let options = TextOptions {
        font_hinting: false,
        ..TextOptions::default()
    };
    let mut fonts = Fonts::new(options, definitions);
    let signs: String = ('!'..='\u{2fff}')
        .filter(|sign| {
            [FontId::proportional(13.5), FontId::monospace(13.5)]
                .iter()
                .all(|id| fonts.has_glyph(id, *sign))
        })
        .collect();
    assert!(signs.chars().count() > 1500);
    let mut sizes = Vec::new();
    for family in [FontFamily::Proportional, FontFamily::Monospace] {
        // Pairs that are kerned, and ligatures.
        for text in ["AV To fi ffl Ty. W, \"L'", &signs] {
            let format = TextFormat::simple(FontId::new(13.5, family.clone()), Color32::WHITE);
            let mut job = LayoutJob::single_section(text.to_owned(), format);
            job.wrap.max_width = 600.0;
            let galley = fonts.with_pixels_per_point(1.0).layout_job(job);
            sizes.push(galley.size().into());
        }
    }
    (sizes, fonts.image())
}

#[test]
fn leaving_out_the_hinting_changed_no_outline_and_no_width() {
    let mut whole = studio::fonts::definitions();
    for (name, bytes) in [
        ("sans", epaint_default_fonts::UBUNTU_LIGHT),
        ("mono", epaint_default_fonts::HACK_REGULAR),
    ] {
        let lean = whole
            .font_data
            .insert(name.to_owned(), Arc::new(FontData::from_static(bytes)))
            .expect("the same names");
        assert!(
            10 * (*lean.font).as_ref().len() < 6 * bytes.len(),
            "{name}: {} of {} bytes",
            (*lean.font).as_ref().len(),
            bytes.len()
        );
    }
    let (whole, lean) = (draw(whole), draw(studio::fonts::definitions()));
    assert_eq!(lean.0, whole.0);
    assert!(lean.1 == whole.1, "the letters differ");
}
