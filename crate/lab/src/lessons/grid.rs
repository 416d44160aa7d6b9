//! Lesson 4: the T shape for a range of radii and blobbinesses.

use crate::bench::Bench;
use crate::command::Command;
use crate::figure::{Figure, Words};
use crate::pictures::Shown;
use crate::plot::number;
use crate::tools::{self, Stage, heading, remark, slider};
use egui::{Align2, CursorIcon, FontId, Rect, Sense, Stroke, StrokeKind, Ui, pos2, vec2};
use field::Kernel;
use widgets::{places, theme};

/// Pictures in a row and in a column.
const SIDE: usize = 4;

/// The words of the lesson.
pub static WORDS: Words = Words {
    link: "grid",
    title: "Radius and blobbiness",
    name: "Radius and blobbiness",
    short: "Grid",
    about: "the numbers behind a joint",
    sentences: "Two bars make a T, and only two numbers change from picture to picture. The \
                radius says how thick a bar is by itself; the blobbiness says how freely its \
                flesh runs together with its neighbour's. Choose a picture to go on with it in \
                the editor.",
};

/// The lesson's state.
pub struct Grid {
    kernel: Kernel,
    radii: [f64; 2],
    blobbinesses: [f64; 2],
}

impl Default for Grid {
    fn default() -> Self {
        Self {
            kernel: Kernel::Cauchy,
            radii: [0.1, 0.4],
            blobbinesses: [0.25, 8.0],
        }
    }
}

impl Figure for Grid {
    fn show(&mut self, ui: &mut Ui, bench: &mut Bench<'_>) {
        let mut stage = Stage::new(ui, bench.narrow, bench.height.max(560.0), 1.08);
        self.table(ui, &stage, bench);
        let controls = &mut stage.controls;
        heading(controls, "Blobbiness |B|, from and to");
        let [low, high] = &mut self.blobbinesses;
        slider(controls, "softest", low, 0.05..=4.0, "");
        slider(controls, "crispest", high, 0.5..=40.0, "");
        heading(controls, "Radius R, from and to");
        let [thin, thick] = &mut self.radii;
        slider(controls, "thinnest", thin, 0.04..=0.4, "");
        slider(controls, "thickest", thick, 0.1..=0.8, "");
        // The first value stays the smaller one.
        *high = high.max(*low * 1.05);
        *thick = thick.max(*thin * 1.05);
        heading(controls, "Kernel");
        if let Some(kernel) = tools::kernels(controls, |kernel| kernel == self.kernel) {
            self.kernel = kernel;
        }
        controls.add_space(4.0);
        remark(
            controls,
            "Each picture is traced just now, by the same tracer as in the editor.",
        );
        if self.kernel.has_pole() {
            remark(
                controls,
                "This kernel has no width, so the blobbiness does nothing here.",
            );
        }
        bench.readings.insert("cells", (SIDE * SIDE) as f64);
        stage.finish(ui);
    }

    fn dataset(&self) -> Command {
        Command::open("Grid", self.text())
    }
}

/// Writes the T shape as a dataset.
pub fn tee(kernel: Kernel, radius: f64, blobbiness: f64) -> String {
    format!(
        "# Two cylinders make a T. Drag the sliders: blobbiness and radius shape the joint.\n\
         # From the lab, lesson 4.\n\n\
         fragile all                  # the radius comes from the material\n\
         var blobbiness = {blob:.3} hot    # near 0: the joint swells; far from 0: crisp\n\
         var radius     = {radius:.3} hot    # of each cylinder on its own\n\n\
         eyep 0.9 0.3 4.6\nvrp  0 -0.62 0\nvup  0 1 0\nfov  37\nframesize 480 480\nsample 3\n\n\
         light White point, position 2 4 4, intensity 0.9\n\
         light SlateBlue point, position -5 -1 2, intensity 0.6, noshadow\n\n\
         surface Clay {{ diffuse Coral, specular 0.5 0.5 0.5, shine 40\n\
         \x20              blob blobbiness, radius radius, kernel {kernel} }}\n\n\
         cylinder Clay 0.25 <-1 0 0> < 1  0   0>   # the beam\n\
         cylinder Clay 0.25 < 0 0 0> < 0 -1.5 0>   # the post\n",
        blob = -blobbiness,
        kernel = kernel.name(),
    )
}

/// Returns one of [`SIDE`] values from `low` to `high`, by equal ratios, in two digits.
fn between([low, high]: [f64; 2], index: usize) -> f64 {
    let share = index as f64 / (SIDE - 1) as f64;
    let value = low * libm::pow(high / low, share);
    // Enough digits to read.
    let digits = libm::pow(10.0, 1.0 - libm::floor(libm::log10(value)));
    libm::round(value * digits) / digits
}

impl Grid {
    /// Draws the pictures with their radii and blobbinesses.
    fn table(&self, ui: &Ui, stage: &Stage, bench: &mut Bench<'_>) {
        let palette = theme::palette(ui.visuals());
        let all = stage.figure;
        let (left, top) = if bench.narrow {
            (34.0, 24.0)
        } else {
            (64.0, 30.0)
        };
        let gap = if bench.narrow { 4.0 } else { 8.0 };
        let inner = Rect::from_min_max(all.min + vec2(left, top), all.max);
        let size = vec2(
            (inner.width() - gap * (SIDE - 1) as f32) / SIDE as f32,
            (inner.height() - gap * (SIDE - 1) as f32) / SIDE as f32,
        )
        .floor();
        // A little wider than high is best for a T with its light.
        let size = vec2(size.x.min(size.y * 1.35), size.y.min(size.x * 1.1));
        let painter = ui.painter();
        let font = FontId::proportional(if bench.narrow { 11.5 } else { 13.0 });
        for row in 0..SIDE {
            let blobbiness = between(self.blobbinesses, row);
            let y = inner.top() + (size.y + gap) * row as f32;
            let at = pos2(inner.left() - 8.0, y + size.y / 2.0);
            let text = if bench.narrow {
                number(-blobbiness)
            } else {
                format!("B {}", number(-blobbiness))
            };
            painter.text(at, Align2::RIGHT_CENTER, text, font.clone(), palette.weak);
            for column in 0..SIDE {
                let radius = between(self.radii, column);
                let x = inner.left() + (size.x + gap) * column as f32;
                if row == 0 {
                    let at = pos2(x + size.x / 2.0, inner.top() - 8.0);
                    let text = format!("R {}", number(radius));
                    painter.text(at, Align2::CENTER_BOTTOM, text, font.clone(), palette.weak);
                }
                let place = Rect::from_min_size(pos2(x, y), size);
                let text = tee(self.kernel, radius, blobbiness);
                cell(
                    ui,
                    bench,
                    place,
                    ("grid", row, column),
                    &format!("T with R {radius} and B −{blobbiness}"),
                    text,
                );
            }
        }
    }

    /// Writes the T in the middle of the table, as a dataset.
    fn text(&self) -> String {
        tee(
            self.kernel,
            between(self.radii, SIDE / 2),
            between(self.blobbinesses, 1),
        )
    }
}

/// Draws a picture that opens in the editor when it is clicked.
fn cell(
    ui: &Ui,
    bench: &mut Bench<'_>,
    place: Rect,
    slot: (&str, usize, usize),
    name: &str,
    text: String,
) {
    let palette = theme::palette(ui.visuals());
    let response = ui.interact(place, ui.scope_id().with(slot), Sense::click());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, name));
    places::note(ui.ctx(), format!("lab cell {} {}", slot.1, slot.2), place);
    let shown = bench.pictures.show(ui, slot, &text, place);
    note_refusal(ui, place, &shown);
    if response.hovered() || response.has_focus() {
        let stroke = Stroke::new(2.0, palette.accent);
        ui.painter()
            .rect_stroke(place, 6.0, stroke, StrokeKind::Inside);
    }
    let clicked = response
        .on_hover_cursor(CursorIcon::PointingHand)
        .on_hover_text(format!("{name}: open in the editor"))
        .clicked();
    if clicked {
        bench.commands.push(Command::OpenText {
            name: String::from("T-shape"),
            text,
        });
    }
}

/// Writes the reason why there is no picture, if there is none.
pub fn note_refusal(ui: &Ui, place: Rect, shown: &Shown) {
    if let Shown::Refused(reason) = shown {
        let palette = theme::palette(ui.visuals());
        let painter = ui.painter_at(place);
        let text = format!("not yet drawn:\n{reason}");
        let width = place.width() - 12.0;
        let font = FontId::proportional(11.0);
        let galley = painter.layout(text, font, palette.weak, width);
        let at = place.center() - galley.size() / 2.0;
        painter.galley(at, galley, palette.weak);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_go_from_the_first_to_the_last() {
        assert_eq!(between([0.1, 0.8], 0), 0.1);
        assert_eq!(between([0.1, 0.8], 1), 0.2);
        assert_eq!(between([0.1, 0.8], 3), 0.8);
    }
}
