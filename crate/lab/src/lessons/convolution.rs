//! Lesson 2: geometry × kernel = field, in one dimension.
//!
//! The geometry g is 1 on bars of a line and 0 elsewhere; the field at x is `∫ g(t)·h(|x−t|/w) dt`,
//! divided by what an endless bar would give, so that a long bar has the field 1. With H the
//! kernel's integral from 0, a bar [a, b] gives `w·(H((b−x)/w) − H((a−x)/w))`.

use crate::bench::Bench;
use crate::command::Command;
use crate::figure::{Figure, Words};
use crate::plot::{self, Axis, Plot, number};
use crate::tools::{self, Stage, heading, reading, remark, slider};
use egui::{Align2, Button, Color32, CursorIcon, FontId, Rect, Sense, Stroke, Ui, pos2, vec2};
use field::Kernel;
use field::kernel::Tail;
use widgets::{places, theme};

/// Shown part of the line.
const LINE: [f64; 2] = [-5.0, 5.0];
/// Most bars.
const MOST: usize = 5;
/// Distance from the line, in widths, at which kernels with a pole are shown.
const BESIDE: f64 = 0.25;
/// Half length, in widths, of the bar that stands for an infinite one: 1/u has no finite integral.
const ENDLESS: f64 = 10.0;

/// The words of the lesson.
pub static WORDS: Words = Words {
    link: "convolution",
    title: "Convolution in one dimension",
    name: "Convolution",
    short: "Convolution",
    about: "geometry × kernel = field",
    sentences: "Slide the kernel along the line: the field at a place is the area that kernel and \
                geometry have in common there. The surface lies where this field crosses the \
                iso-value, so bars that come near each other grow together. A kernel that ends is \
                a window: what lies outside it does not count, so a long bar looks the same in \
                its middle however much longer it grows.",
};

/// The lesson's state.
pub struct Convolution {
    bars: Vec<[f64; 2]>,
    kernel: Kernel,
    /// The kernel's width: u = distance/width.
    width: f64,
    iso: f64,
    probe: f64,
}

impl Default for Convolution {
    fn default() -> Self {
        Self {
            bars: vec![[-3.4, -0.9], [0.5, 1.5]],
            kernel: Kernel::Quartic,
            width: 1.2,
            iso: 0.5,
            probe: -0.2,
        }
    }
}

impl Figure for Convolution {
    fn show(&mut self, ui: &mut Ui, bench: &mut Bench<'_>) {
        let mut stage = Stage::new(ui, bench.narrow, bench.height, 1.2);
        plot::panel(ui, stage.figure);
        let split = stage.figure.top() + stage.figure.height() * 0.55;
        let upper = stage.figure.with_max_y(split);
        let lower = stage.figure.with_min_y(split);
        let palette = theme::palette(ui.visuals());
        ui.painter().hline(
            stage.figure.x_range(),
            split,
            Stroke::new(1.0, palette.line),
        );
        self.field_plot(ui, upper, bench);
        self.geometry_plot(ui, lower);

        let controls = &mut stage.controls;
        slider(controls, "Kernel width", &mut self.width, 0.2..=3.0, "");
        heading(controls, "Kernel");
        if let Some(kernel) = tools::kernels(controls, |kernel| kernel == self.kernel) {
            self.kernel = kernel;
        }
        heading(controls, "Bars: drag them, or their ends");
        controls.horizontal(|ui| {
            let add = ui.add_enabled(self.bars.len() < MOST, Button::new("Add a bar"));
            places::note(ui.ctx(), "lab add", add.rect);
            if add.clicked() {
                let x = [-4.2, 2.4, 3.8, -0.2, 0.0][self.bars.len().min(MOST - 1)];
                self.bars.push([x - 0.4, x + 0.4]);
            }
            if ui
                .add_enabled(self.bars.len() > 1, Button::new("Remove one"))
                .clicked()
            {
                self.bars.pop();
            }
        });
        controls.add_space(6.0);
        let here = self.field(self.probe);
        let colour = tools::hue(controls, self.kernel);
        reading(controls, "Field at the probe", &number(here), colour);
        if let Some(share) = self.share_in_window() {
            let text = format!("{:.0} % of the bars", 100.0 * share);
            reading(controls, "The window sees", &text, colour);
            remark(
                controls,
                "This kernel ends, so it is a window: what is shaded does not count at all. Make a \
                 bar longer outside the window, and nothing changes here.",
            );
        } else {
            let text = if self.kernel.has_pole() {
                "This kernel has a pole on the line itself, so it is shown a quarter of a width \
                 beside the line. It never ends: every bar counts everywhere."
            } else {
                "This kernel never ends: every bar counts everywhere, even if very little far away."
            };
            remark(controls, text);
        }
        let readings = &mut bench.readings;
        readings.insert("probe", self.probe);
        readings.insert("field", here);
        readings.insert("iso", self.iso);
        readings.insert("bars", self.bars.len() as f64);
        stage.finish(ui);
    }

    fn dataset(&self) -> Command {
        Command::open("Convolution", self.text())
    }
}

impl Convolution {
    /// Returns the value of the kernel as the figure shows it.
    fn kernel_at(&self, u: f64) -> f64 {
        match self.kernel {
            kernel if kernel.has_pole() => {
                let beside = (u * u + BESIDE * BESIDE).sqrt();
                // As high as 1, like the others.
                self.kernel.value(beside) / self.kernel.value(BESIDE)
            }
            kernel => kernel.value(u),
        }
    }

    /// Computes the kernel's integral from 0 to u, an odd function.
    fn integral(&self, u: f64) -> f64 {
        let along = match self.kernel.tail() {
            Tail::Power { exponent, .. } if self.kernel.has_pole() => match exponent {
                1 => libm::asinh(u.abs() / BESIDE) * BESIDE,
                2 => libm::atan(u.abs() / BESIDE) * BESIDE,
                _ => BESIDE * u.abs() / (u * u + BESIDE * BESIDE).sqrt(),
            },
            _ => self.kernel.along(u.abs()),
        };
        along.copysign(u)
    }

    /// Returns half of the field of an endless bar, in widths.
    fn endless(&self) -> f64 {
        self.integral(if self.kernel.is_finite_over(1) {
            1e9
        } else {
            ENDLESS
        })
    }

    /// Computes the contribution of one bar at x.
    fn part(&self, [a, b]: [f64; 2], x: f64) -> f64 {
        let [a, b] = [a, b].map(|end| self.integral((end - x) / self.width));
        (b - a) / (2.0 * self.endless())
    }

    /// Computes the field at x.
    fn field(&self, x: f64) -> f64 {
        self.bars.iter().map(|bar| self.part(*bar, x)).sum()
    }

    /// Returns half the width of the kernel's window, if it ends.
    fn window(&self) -> Option<f64> {
        self.kernel.is_compact().then_some(self.width)
    }

    /// Returns the share of the geometry inside the window at the probe, if the kernel ends.
    fn share_in_window(&self) -> Option<f64> {
        let reach = self.window()?;
        let (low, high) = (self.probe - reach, self.probe + reach);
        let length: f64 = self.bars.iter().map(|[a, b]| b - a).sum();
        let inside: f64 = self
            .bars
            .iter()
            .map(|[a, b]| (b.min(high) - a.max(low)).max(0.0))
            .sum();
        (length > 0.0).then(|| inside / length)
    }

    /// Finds the intervals in which the field is above the iso-value.
    fn flesh(&self, samples: usize) -> Vec<[f64; 2]> {
        let mut spans = Vec::new();
        let mut begun = (self.field(LINE[0]) > self.iso).then_some(LINE[0]);
        let mut before = (LINE[0], self.field(LINE[0]) - self.iso);
        for i in 1..=samples {
            let x = LINE[0] + (LINE[1] - LINE[0]) * i as f64 / samples as f64;
            let here = (x, self.field(x) - self.iso);
            let crossing = before.0 + (here.0 - before.0) * before.1 / (before.1 - here.1);
            if before.1 <= 0.0 && here.1 > 0.0 {
                begun = Some(crossing);
            } else if before.1 > 0.0 && here.1 <= 0.0 {
                spans.extend(begun.take().map(|from| [from, crossing]));
            }
            before = here;
        }
        spans.extend(begun.map(|from| [from, LINE[1]]));
        spans
    }

    /// Draws the field, the iso-value, and where the one is above the other.
    fn field_plot(&mut self, ui: &Ui, place: Rect, bench: &mut Bench<'_>) {
        let palette = theme::palette(ui.visuals());
        let y = Axis::new([0.0, 1.3], "field F(x)");
        let plot = Plot::new(ui, place, Axis::new(LINE, "").bare(), y);
        // Anywhere in the figure the probe can be set.
        let response = ui.interact(
            plot.rect,
            ui.scope_id().with("probe"),
            Sense::click_and_drag(),
        );
        response.widget_info(|| {
            egui::WidgetInfo::labeled(egui::Role::Slider, true, "Probe on the field")
        });
        if let (true, Some(pointer)) = (
            response.dragged() || response.clicked(),
            response.interact_pointer_pos(),
        ) {
            self.probe = plot.value(pointer)[0].clamp(LINE[0], LINE[1]);
        }
        let colour = tools::hue(ui, self.kernel);
        let spans = self.flesh(plot.enough());
        for span in &spans {
            let tint = palette.accent.gamma_multiply(0.22);
            plot.fill(tint, *span, |x| self.field(x));
        }
        plot.curve(Stroke::new(2.5, colour), |x| self.field(x));
        for [from, to] in &spans {
            let [a, b] = [from, to].map(|x| plot.at(*x, 0.0));
            let bar = Rect::from_two_pos(a - vec2(0.0, 3.0), b + vec2(0.0, 3.0));
            ui.painter().rect_filled(bar, 3.0, palette.accent);
            for x in [from, to] {
                let ends = [plot.at(*x, 0.0), plot.at(*x, self.iso)];
                let dashes =
                    egui::Shape::dashed_line(&ends, Stroke::new(1.0, palette.accent), 3.0, 3.0);
                plot.painter.extend(dashes);
            }
        }
        bench.readings.insert("pieces", spans.len() as f64);

        let iso = plot.at(0.0, self.iso).y;
        let stroke = Stroke::new(1.5, palette.accent);
        plot.painter.hline(plot.rect.x_range(), iso, stroke);
        let at = pos2(plot.rect.right() - 30.0, iso - 3.0);
        let text = format!("iso-value T = {:.2}", self.iso);
        let font = FontId::proportional(12.5);
        plot.painter
            .text(at, Align2::RIGHT_BOTTOM, text, font, palette.accent);
        let at = pos2(plot.rect.right() - 12.0, iso);
        let grip = plot::grip(
            ui,
            "iso-value",
            at,
            palette.accent,
            CursorIcon::ResizeVertical,
        );
        if let (true, Some(pointer)) = (grip.dragged(), grip.interact_pointer_pos()) {
            self.iso = plot.value(pointer)[1].clamp(0.03, 1.25);
        }
        self.probe_line(ui, &plot);
        let at = plot.at(self.probe, self.field(self.probe));
        ui.painter()
            .circle(at, 5.5, colour, Stroke::new(2.0, palette.paper));
    }

    fn probe_line(&self, ui: &Ui, plot: &Plot) {
        let palette = theme::palette(ui.visuals());
        let at = plot.at(self.probe, 0.0).x;
        let stroke = Stroke::new(1.5, palette.text);
        plot.painter.vline(at, plot.rect.y_range(), stroke);
    }

    /// Draws the bars, and the kernel over them: the area that they share is the field.
    fn geometry_plot(&mut self, ui: &Ui, place: Rect) {
        let palette = theme::palette(ui.visuals());
        let y = Axis::new([0.0, 1.3], "geometry, and the kernel at the probe");
        let plot = Plot::new(ui, place, Axis::new(LINE, "x"), y);
        let colour = tools::hue(ui, self.kernel);
        let kernel = |x: f64| self.kernel_at((x - self.probe).abs() / self.width);
        for (index, [a, b]) in self.bars.iter().enumerate() {
            let bar = Rect::from_two_pos(plot.at(*a, 1.0), plot.at(*b, 0.0));
            let fill = palette.hover;
            plot.painter.rect_filled(bar, 3.0, fill);
            if bar.width() > 40.0 {
                let font = FontId::proportional(12.0);
                let at = bar.center_top() + vec2(0.0, 5.0);
                let text = format!("bar {}", index + 1);
                plot.painter
                    .text(at, Align2::CENTER_TOP, text, font, palette.weak);
            }
            plot.fill(colour.gamma_multiply(0.55), [*a, *b], kernel);
        }
        if let Some(reach) = self.window() {
            let [from, to] = [self.probe - reach, self.probe + reach].map(|x| plot.at(x, 0.0).x);
            let veil = palette.paper.gamma_multiply(0.72);
            let all = plot.rect;
            let left = all.with_max_x(from.clamp(all.left(), all.right()));
            let right = all.with_min_x(to.clamp(all.left(), all.right()));
            for rect in [left, right] {
                plot.painter.rect_filled(rect, 0.0, veil);
            }
            let stroke = Stroke::new(1.5, colour);
            for x in [from, to] {
                let ends = [pos2(x, all.top()), pos2(x, all.bottom())];
                let dashes = egui::Shape::dashed_line(&ends, stroke, 5.0, 4.0);
                plot.painter.extend(dashes);
            }
            let font = FontId::proportional(12.0);
            let at = pos2((from + to) / 2.0, all.top() + 2.0);
            let text = "window";
            let painter = &plot.painter;
            painter.text(at, Align2::CENTER_TOP, text, font, colour);
        }
        plot.curve(Stroke::new(2.0, colour), kernel);
        self.probe_line(ui, &plot);
        self.bar_grips(ui, &plot, palette.strong);
        let at = pos2(plot.at(self.probe, 0.0).x, plot.rect.bottom());
        let grip = plot::grip(ui, "probe", at, colour, CursorIcon::ResizeHorizontal);
        if let (true, Some(pointer)) = (grip.dragged(), grip.interact_pointer_pos()) {
            self.probe = plot.value(pointer)[0].clamp(LINE[0], LINE[1]);
        }
    }

    fn bar_grips(&mut self, ui: &Ui, plot: &Plot, colour: Color32) {
        for index in 0..self.bars.len() {
            let [a, b] = self.bars[index];
            let body = Rect::from_two_pos(plot.at(a, 1.0), plot.at(b, 0.35));
            let id = ui.scope_id().with(("bar", index));
            let response = ui.interact(body.shrink2(vec2(8.0, 0.0)), id, Sense::drag());
            let name = format!("bar {}", index + 1);
            response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Slider, true, &name));
            places::note(ui.ctx(), format!("lab {name}"), body);
            let unit = f64::from(plot.rect.width()) / (LINE[1] - LINE[0]);
            if response.dragged() {
                let by = f64::from(response.drag_delta().x) / unit;
                let by = by.clamp(LINE[0] - a, LINE[1] - b);
                self.bars[index] = [a + by, b + by];
            }
            let _ = response.on_hover_and_drag_cursor(CursorIcon::Grab);
            for (end, x) in [("left", a), ("right", b)] {
                let at = plot.at(x, 0.62);
                let size = vec2(ui.spacing().interact_size.y.max(22.0) * 0.7, 44.0);
                let rect = Rect::from_center_size(at, size);
                let id = ui.scope_id().with(("end", index, end));
                let response = ui.interact(rect, id, Sense::drag());
                let name = format!("{end} end of bar {}", index + 1);
                response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Slider, true, &name));
                places::note(ui.ctx(), format!("lab {name}"), rect);
                let hot = response.hovered() || response.dragged();
                let knob = Rect::from_center_size(at, vec2(5.0, 22.0));
                let colour = colour.gamma_multiply(if hot { 1.0 } else { 0.7 });
                ui.painter().rect_filled(knob, 2.5, colour);
                if let (true, Some(pointer)) = (response.dragged(), response.interact_pointer_pos())
                {
                    let x = plot.value(pointer)[0].clamp(LINE[0], LINE[1]);
                    let bar = &mut self.bars[index];
                    if end == "left" {
                        bar[0] = x.min(bar[1] - 0.1);
                    } else {
                        bar[1] = x.max(bar[0] + 0.1);
                    }
                }
                let _ = response.on_hover_and_drag_cursor(CursorIcon::ResizeHorizontal);
            }
        }
    }

    /// Writes the bars as cylinders, as a dataset.
    fn text(&self) -> String {
        let name = self.kernel.name();
        let mut text = format!(
            "# Bars on a line, and the flesh that the kernel {name} grows on them.\n\
             # From the lab, lesson 2: where the field exceeds the iso-value there is flesh.\n\n\
             eyep 0 0 14\nvrp 0 0 0\nvup 0 1 0\nfov 46\nframesize 720 400\nsample 3\n\
             light White point, position 4 6 8, intensity 0.9\n\
             light SlateBlue point, position -6 -1 4, intensity 0.5, noshadow\n\n\
             var radius     = {radius:.3} hot   # of an endless bar\n\
             var blobbiness = -1.5 hot   # near 0: the bars reach for each other\n\n\
             surface flesh, diffuse Coral, specular 0.5 0.5 0.5, shine \
             40, blobbiness blobbiness, kernel {name}\n\n",
            radius = 0.5 * self.width,
        );
        for [a, b] in &self.bars {
            text.push_str(&format!(
                "cylinder flesh radius, <{a:.3} 0 0> <{b:.3} 0 0>\n"
            ));
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_field_is_the_area_that_kernel_and_geometry_share() {
        for kernel in Kernel::ALL {
            let lesson = Convolution {
                kernel,
                ..Convolution::default()
            };
            for x in [-4.0, -2.0, 0.0, 1.1, 4.9] {
                // The midpoint rule with steps of 1/4000: its error is far below the tolerance.
                let steps = 40_000;
                let step = (LINE[1] - LINE[0]) / f64::from(steps);
                let sum: f64 = (0..steps)
                    .map(|i| LINE[0] + (f64::from(i) + 0.5) * step)
                    .filter(|t| lesson.bars.iter().any(|[a, b]| (a..b).contains(&t)))
                    .map(|t| lesson.kernel_at((t - x).abs() / lesson.width) * step)
                    .sum();
                let want = sum / (2.0 * lesson.endless() * lesson.width);
                let got = lesson.field(x);
                assert!((got - want).abs() < 1e-4, "{kernel:?} {x}: {got} {want}");
            }
        }
    }

    #[test]
    fn a_window_does_not_see_what_is_outside() {
        let mut lesson = Convolution {
            bars: vec![[-2.0, 2.0]],
            probe: 0.0,
            ..Convolution::default()
        };
        let before = lesson.field(0.0);
        lesson.bars[0] = [-4.0, 4.5];
        assert_eq!(lesson.field(0.0), before);
        // The window is 2·1.2 of the bar's 8.5.
        assert!((lesson.share_in_window().unwrap() - 2.4 / 8.5).abs() < 1e-12);
        lesson.kernel = Kernel::Cauchy;
        assert_eq!(lesson.share_in_window(), None);
    }

    #[test]
    fn flesh_is_where_the_field_is_above_the_iso_value() {
        let lesson = Convolution::default();
        let spans = lesson.flesh(600);
        assert_eq!(spans.len(), 2);
        for [a, b] in spans {
            assert!((lesson.field(a) - lesson.iso).abs() < 1e-3);
            assert!((lesson.field(b) - lesson.iso).abs() < 1e-3);
            assert!(lesson.field((a + b) / 2.0) > lesson.iso);
        }
    }
}
