//! Places of the compiler's messages in the laid-out text: underlines, dots beside line numbers,
//! and the messages under the pointer.

use crate::problems;
use crate::theme::Palette;
use egui::text::CCursor;
use egui::{Galley, Painter, Pos2, Rect, Shape, Stroke, pos2};
use rats::{Diagnostic, Project, Severity};
use std::ops::Range;

/// Most messages that are marked in the text; the list shows more.
const MOST: usize = 300;

/// The messages about one file, with their places counted in characters.
#[derive(Default)]
pub struct Marks {
    key: Option<([u64; 2], usize)>,
    marks: Vec<Mark>,
}

struct Mark {
    index: usize,
    severity: Severity,
    line: usize,
    chars: Range<usize>,
}

impl Marks {
    /// Brings the marks up to date with the messages that are shown. `state` has the numbers that
    /// rise when the text or the messages change.
    pub fn update(
        &mut self,
        state: [u64; 2],
        project: &Project,
        file: usize,
        diagnostics: &[Diagnostic],
    ) {
        if self.key == Some((state, file)) {
            return;
        }
        self.key = Some((state, file));
        self.marks.clear();
        let Some(File { name, text }) = project.files.get(file).map(File::of) else {
            return;
        };
        let mut counter = Counter::new(text);
        for (index, diagnostic) in diagnostics.iter().enumerate() {
            if diagnostic.file != name || self.marks.len() >= MOST {
                continue;
            }
            let start = counter.chars(diagnostic.span.start);
            let end = counter.chars(diagnostic.span.end).max(start);
            self.marks.push(Mark {
                index,
                severity: diagnostic.severity,
                line: diagnostic.line,
                chars: start..end,
            });
        }
    }

    /// Returns the worst severity in a line, counted from 1.
    #[must_use]
    pub fn of_line(&self, line: usize) -> Option<Severity> {
        self.marks
            .iter()
            .filter(|mark| mark.line == line)
            .map(|mark| mark.severity)
            .max()
    }

    /// Returns the indices of the messages at a character.
    pub fn at(&self, char: usize) -> impl Iterator<Item = usize> {
        self.marks
            .iter()
            .filter(move |mark| mark.chars.start <= char && char <= mark.chars.end)
            .map(|mark| mark.index)
    }

    /// Draws the underlines that lie in the painter's clip rectangle.
    pub fn paint(&self, painter: &Painter, palette: &Palette, galley: &Galley, origin: Pos2) {
        let clip = painter.clip_rect();
        for mark in &self.marks {
            let colour = problems::colour(palette, mark.severity);
            for row in rows(galley, mark.chars.clone()) {
                let row = row.translate(origin.to_vec2());
                if row.intersects(clip) {
                    squiggle(painter, row, Stroke::new(1.3, colour));
                }
            }
        }
    }
}

/// A borrowed file.
struct File<'a> {
    name: &'a str,
    text: &'a str,
}

impl<'a> File<'a> {
    fn of(file: &'a rats::File) -> Self {
        Self {
            name: &file.name,
            text: &file.text,
        }
    }
}

/// Turns byte positions into character positions, quickly when they rise.
struct Counter<'a> {
    text: &'a str,
    byte: usize,
    chars: usize,
}

impl<'a> Counter<'a> {
    fn new(text: &'a str) -> Self {
        Self {
            text,
            byte: 0,
            chars: 0,
        }
    }

    fn chars(&mut self, byte: usize) -> usize {
        let byte = self.text.floor_char_boundary(byte);
        if byte < self.byte {
            (self.byte, self.chars) = (0, 0);
        }
        self.chars += self.text[self.byte..byte].chars().count();
        self.byte = byte;
        self.chars
    }
}

/// Returns the rectangles that a range of characters covers, one for each row.
pub(crate) fn rows(galley: &Galley, chars: Range<usize>) -> Vec<Rect> {
    let start = galley.layout_from_cursor(CCursor::new(chars.start));
    let end = galley.layout_from_cursor(CCursor::new(chars.end));
    let mut rectangles = Vec::new();
    for (index, row) in galley
        .rows
        .iter()
        .enumerate()
        .take(end.row + 1)
        .skip(start.row)
    {
        let rect = row.rect();
        let left = if index == start.row {
            galley.pos_from_cursor(CCursor::new(chars.start)).left()
        } else {
            rect.left()
        };
        let right = if index == end.row {
            galley.pos_from_cursor(CCursor::new(chars.end)).right()
        } else {
            rect.right()
        };
        // A place between characters gets a mark that can be seen.
        let right = right.max(left + 7.0);
        rectangles.push(Rect::from_min_max(
            pos2(left, rect.top()),
            pos2(right, rect.bottom()),
        ));
    }
    rectangles
}

fn squiggle(painter: &Painter, row: Rect, stroke: Stroke) {
    let y = row.bottom() - 2.0;
    let steps = ((row.width() / 2.5).ceil() as usize).clamp(2, 400);
    let points = (0..=steps)
        .map(|step| {
            let x = row.left() + row.width() * step as f32 / steps as f32;
            pos2(x, if step % 2 == 0 { y + 1.1 } else { y - 1.1 })
        })
        .collect();
    painter.add(Shape::line(points, stroke));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_become_characters_in_any_order() {
        let mut counter = Counter::new("aäb€c");
        assert_eq!(counter.chars(3), 2);
        assert_eq!(counter.chars(7), 4);
        assert_eq!(counter.chars(1), 1);
        assert_eq!(counter.chars(2), 1, "inside ä");
        assert_eq!(counter.chars(99), 5);
    }
}
