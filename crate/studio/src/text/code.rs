//! The colours of the text.

use crate::theme::{CODE_SIZE, Palette};
use assist::highlight::{TokenKind, highlight};
use egui::text::{LayoutJob, TextFormat};
use egui::{Color32, FontId};

/// A layout of coloured words, kept because every frame asks for the same text.
#[derive(Default)]
pub struct Colouring {
    text: String,
    dark: bool,
    job: LayoutJob,
}

impl Colouring {
    /// Returns the layout of a text, wrapped at `width`.
    pub fn job(&mut self, text: &str, palette: &Palette, dark: bool, width: f32) -> LayoutJob {
        if self.text != text || self.dark != dark || self.job.is_empty() {
            text.clone_into(&mut self.text);
            self.dark = dark;
            self.job = colour(text, palette);
        }
        let mut job = self.job.clone();
        job.wrap.max_width = width;
        job
    }
}

/// Returns a text with coloured words, not wrapped.
#[must_use]
pub fn colour(text: &str, palette: &Palette) -> LayoutJob {
    let mut job = LayoutJob {
        keep_trailing_whitespace: true,
        ..LayoutJob::default()
    };
    let mut done = 0;
    for (range, kind) in highlight(text) {
        let (Some(gap), Some(word)) = (text.get(done..range.start), text.get(range.clone())) else {
            continue;
        };
        job.append(gap, 0.0, format(palette.text));
        job.append(word, 0.0, format(token_colour(palette, kind)));
        done = range.end;
    }
    job.append(&text[done..], 0.0, format(palette.text));
    job
}

/// Returns the letters of code in a colour.
fn format(color: Color32) -> TextFormat {
    TextFormat {
        line_height: Some(CODE_SIZE * 1.45),
        ..TextFormat::simple(FontId::monospace(CODE_SIZE), color)
    }
}

fn token_colour(palette: &Palette, kind: TokenKind) -> Color32 {
    match kind {
        TokenKind::Command => palette.command,
        TokenKind::Option => palette.option,
        TokenKind::Number => palette.number,
        TokenKind::Colour => palette.colour,
        TokenKind::Name => palette.text,
        TokenKind::Comment => palette.comment,
        TokenKind::Sign => palette.sign,
    }
}
