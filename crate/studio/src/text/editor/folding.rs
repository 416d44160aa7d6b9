//! Folding: blocks, objects and long comments shut to their first line. The text stays whole:
//! folded lines are laid out without height. A small triangle beside the first line, or F8, shuts
//! and opens.

use crate::theme::Palette;
use egui::text::{LayoutJob, LayoutSection};
use egui::{Color32, CursorIcon, FontId, Pos2, Rect, Sense, Shape, Stroke, Ui, pos2, vec2};
use std::collections::{BTreeSet, HashMap};
use std::ops::Range;

/// The folded blocks of each file.
#[derive(Default)]
pub struct Folding {
    files: HashMap<usize, Folds>,
}

#[derive(Default)]
struct Folds {
    text: String,
    /// Blocks that can be folded, as lines from 0.
    ranges: Vec<Range<usize>>,
    /// The first lines of blocks that are folded.
    shut: BTreeSet<usize>,
    /// The bytes that are folded away.
    hidden: Vec<Range<usize>>,
}

impl Folding {
    /// Forgets everything, when another work was opened.
    pub fn clear(&mut self) {
        self.files.clear();
    }

    /// Follows an edit; folded blocks stay folded. Returns the bytes that are folded away.
    pub fn update(&mut self, file: usize, text: &str) -> Vec<Range<usize>> {
        let folds = self.files.entry(file).or_default();
        if folds.text != text {
            folds.follow(text);
        }
        folds.hidden.clone()
    }

    /// Opens the folds that hide a line.
    pub fn reveal(&mut self, file: usize, line: usize) {
        if let Some(folds) = self.files.get_mut(&file) {
            for fold in &folds.ranges {
                if fold.start < line && line < fold.end {
                    folds.shut.remove(&fold.start);
                }
            }
            folds.hide();
        }
    }

    /// Returns the outermost fold that hides a line.
    pub fn around(&self, file: usize, line: usize) -> Option<Range<usize>> {
        let folds = self.files.get(&file)?;
        let mut shut = folds
            .ranges
            .iter()
            .filter(|fold| folds.shut.contains(&fold.start));
        shut.find(|fold| fold.start < line && line < fold.end)
            .cloned()
    }

    /// Shuts or opens the innermost fold around a line. Returns its lines if it is shut now.
    pub fn toggle(&mut self, file: usize, line: usize) -> Option<Range<usize>> {
        let folds = self.files.get_mut(&file)?;
        let around = folds
            .ranges
            .iter()
            .rfind(|fold| fold.contains(&line))?
            .clone();
        let is_shut = !folds.shut.remove(&around.start);
        if is_shut {
            folds.shut.insert(around.start);
        }
        folds.hide();
        is_shut.then_some(around)
    }

    /// Draws triangles at `x` beside the lines `rows` (from 0) that can be folded, and a mark
    /// behind those that are folded. Returns the line whose triangle was clicked.
    pub fn show(
        &self,
        ui: &Ui,
        palette: &Palette,
        file: usize,
        rows: &[(usize, Rect)],
        x: f32,
    ) -> Option<usize> {
        let folds = self.files.get(&file)?;
        let mut clicked = None;
        for (line, row) in rows {
            if folds
                .ranges
                .binary_search_by_key(line, |fold| fold.start)
                .is_err()
            {
                continue;
            }
            let shut = folds.shut.contains(line);
            let middle = pos2(x, row.center().y);
            let place = Rect::from_center_size(middle, vec2(16.0, row.height()));
            let name = format!("{} line {}", if shut { "Unfold" } else { "Fold" }, line + 1);
            let response = ui
                .interact(place, ui.scope_id().with(("fold", line)), Sense::click())
                .on_hover_cursor(CursorIcon::PointingHand);
            response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &name));
            if response.clicked() {
                clicked = Some(*line);
            }
            let colour = if response.hovered() || shut {
                palette.text
            } else {
                palette.comment
            };
            triangle(ui, middle, shut, colour);
            if shut {
                let dots = Rect::from_min_size(
                    pos2(row.right() + 6.0, row.center().y - 7.0),
                    vec2(22.0, 14.0),
                );
                ui.painter().rect_filled(dots, 4.0, palette.button);
                for i in -1..=1 {
                    let dot = dots.center() + vec2(5.0 * i as f32, 0.0);
                    ui.painter().circle_filled(dot, 1.3, palette.weak);
                }
            }
        }
        clicked
    }
}

impl Folds {
    /// Takes a new text: folded lines after the edit stay folded.
    fn follow(&mut self, text: &str) {
        let (old, new): (Vec<&str>, Vec<&str>) =
            (self.text.lines().collect(), text.lines().collect());
        let before = old.iter().zip(&new).take_while(|(a, b)| a == b).count();
        let most = old.len().min(new.len()) - before;
        let after = (old.iter().rev().zip(new.iter().rev()))
            .take(most)
            .take_while(|(a, b)| a == b)
            .count();
        self.ranges = assist::folds(text);
        let starts: BTreeSet<usize> = self.ranges.iter().map(|fold| fold.start).collect();
        self.shut = self
            .shut
            .iter()
            .map(|line| {
                if *line >= old.len() - after {
                    line + new.len() - old.len()
                } else {
                    *line
                }
            })
            .filter(|line| starts.contains(line))
            .collect();
        text.clone_into(&mut self.text);
        self.hide();
    }

    /// Finds the bytes that are folded away.
    fn hide(&mut self) {
        let ends = self.text.match_indices('\n').map(|(at, _)| at + 1);
        let starts: Vec<usize> = std::iter::once(0).chain(ends).collect();
        self.hidden.clear();
        for fold in self
            .ranges
            .iter()
            .filter(|fold| self.shut.contains(&fold.start))
        {
            let [start, end] = [fold.start + 1, fold.end]
                .map(|line| starts.get(line).copied().unwrap_or(self.text.len()));
            let bytes = start..end;
            // A block inside a folded one is hidden already.
            let is_inside = self.hidden.last().is_some_and(|last| last.end >= bytes.end);
            if !is_inside && !bytes.is_empty() {
                self.hidden.push(bytes);
            }
        }
    }
}

fn triangle(ui: &Ui, middle: Pos2, shut: bool, colour: Color32) {
    let corners = if shut {
        [vec2(-2.0, -3.5), vec2(-2.0, 3.5), vec2(2.5, 0.0)]
    } else {
        [vec2(-3.5, -2.0), vec2(3.5, -2.0), vec2(0.0, 2.5)]
    };
    let corners = corners.map(|corner| middle + corner).to_vec();
    ui.painter()
        .add(Shape::convex_polygon(corners, colour, Stroke::NONE));
}

/// Returns a layout in which the hidden bytes have no height.
#[must_use]
pub fn hide(mut job: LayoutJob, hidden: &[Range<usize>]) -> LayoutJob {
    if hidden.is_empty() {
        return job;
    }
    let mut sections = Vec::with_capacity(job.sections.len() + 2 * hidden.len());
    for section in job.sections {
        let Range { mut start, end } = section.byte_range.start.0..section.byte_range.end.0;
        for range in hidden {
            let (from, to) = (range.start.max(start), range.end.min(end));
            if from >= to {
                continue;
            }
            if start < from {
                sections.push(part(&section, start..from, false));
            }
            sections.push(part(&section, from..to, true));
            start = to;
        }
        if start < end {
            sections.push(part(&section, start..end, false));
        }
    }
    job.sections = sections;
    job
}

/// Returns the part of a section that covers some of its bytes.
fn part(section: &LayoutSection, bytes: Range<usize>, is_hidden: bool) -> LayoutSection {
    let mut part = section.clone();
    part.byte_range = egui::text::ByteIndex(bytes.start)..egui::text::ByteIndex(bytes.end);
    if is_hidden {
        part.format.font_id = FontId::monospace(0.1);
        part.format.line_height = Some(0.01);
        part.format.color = Color32::TRANSPARENT;
    }
    part
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "object A\n  sphere s 1 0 0 0\nclose\nfor i = 1 to 3 {\n  quit\n}\n";

    #[test]
    fn folds_follow_edits_above_them_and_end_with_their_block() {
        let mut folding = Folding::default();
        assert!(folding.update(0, TEXT).is_empty());
        let shut = folding.toggle(0, 4).unwrap();
        assert_eq!(shut.start, 3);
        let hidden = folding.update(0, TEXT);
        assert_eq!(hidden.len(), 1);
        assert!(TEXT[hidden[0].clone()].starts_with("  quit"));
        let longer = format!("# a remark\n{TEXT}");
        let hidden = folding.update(0, &longer);
        assert!(longer[hidden[0].clone()].starts_with("  quit"));
        assert!(folding.around(0, 5).is_some());
        assert!(folding.update(0, "quit\n").is_empty());
    }

    #[test]
    fn lines_in_folds_can_be_revealed() {
        let mut folding = Folding::default();
        folding.update(0, TEXT);
        folding.toggle(0, 0);
        assert!(folding.around(0, 1).is_some());
        folding.reveal(0, 1);
        assert!(folding.around(0, 1).is_none());
        assert!(folding.update(0, TEXT).is_empty());
    }

    #[test]
    fn bytes_in_folds_are_cut_out_of_their_sections() {
        let job = LayoutJob::simple(
            String::from("abc\ndef\nghi"),
            FontId::monospace(13.0),
            Color32::RED,
            100.0,
        );
        let hidden = 4..8;
        let job = hide(job, std::slice::from_ref(&hidden));
        let sizes: Vec<_> = job
            .sections
            .iter()
            .map(|s| {
                (
                    s.byte_range.start.0,
                    s.byte_range.end.0,
                    s.format.font_id.size < 1.0,
                )
            })
            .collect();
        assert_eq!(sizes, [(0, 4, false), (4, 8, true), (8, 11, false)]);
    }
}
