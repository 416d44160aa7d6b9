//! Lesson 1: the kernels, bare and as the field of a point.

use crate::bench::Bench;
use crate::command::Command;
use crate::figure::{Figure, Words};
use crate::plot::{self, Axis, Plot, number};
use crate::sample;
use crate::tools::{self, Stage, choice, heading, reading, remark, slider};
use egui::{Align2, Color32, FontId, Sense, Stroke, Ui, pos2};
use field::{Kernel, Shaping, Skeleton, THRESHOLD};
use glam::DVec3;
use widgets::theme;

/// Share of the threshold below which an infinite kernel counts as over.
const INFLUENCE: f64 = 1e-3;

/// Plotted quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum View {
    /// The field of a point, against the distance.
    Flesh,
    /// The kernel alone, against distance in units of its width.
    Bare,
}

/// The words of the lesson.
pub static WORDS: Words = Words {
    link: "kernels",
    title: "Kernels",
    name: "Kernels",
    short: "Kernels",
    about: "how a field falls with distance",
    sentences: "A kernel says how strong the field of a point of the skeleton is at a distance \
                r. Whatever the kernel, it is scaled so that a lone point has its surface exactly \
                at the radius R, where its field equals the threshold T = 1. What differs is how \
                the field falls: some kernels fade for ever, others end at a certain distance and \
                give nothing beyond it.",
};

/// The lesson's state.
pub struct Kernels {
    view: View,
    radius: f64,
    blobbiness: f64,
    strength: f64,
    /// The kernels to compare, at most two; the others fade.
    chosen: Vec<Kernel>,
}

impl Default for Kernels {
    fn default() -> Self {
        Self {
            view: View::Flesh,
            radius: 1.0,
            blobbiness: 1.0,
            strength: 1.0,
            chosen: vec![Kernel::Cauchy, Kernel::Quartic],
        }
    }
}

impl Figure for Kernels {
    fn show(&mut self, ui: &mut Ui, bench: &mut Bench<'_>) {
        let mut stage = Stage::new(ui, bench.narrow, bench.height, 0.86);
        self.figure(ui, &stage, bench);
        let controls = &mut stage.controls;
        choice(
            controls,
            &mut self.view,
            &[
                (View::Flesh, "Field of a point"),
                (View::Bare, "Kernel alone"),
            ],
        );
        if self.view == View::Flesh {
            slider(controls, "Radius R", &mut self.radius, 0.3..=2.0, "");
            slider(
                controls,
                "Blobbiness |B|",
                &mut self.blobbiness,
                0.15..=6.0,
                "",
            );
            slider(controls, "Strength", &mut self.strength, 0.2..=3.0, "");
        }
        heading(controls, "Compare two (dashed: kernels that end)");
        let clicked = tools::kernels(controls, |kernel| self.chosen.contains(&kernel));
        if let Some(kernel) = clicked {
            self.toggle(kernel);
        }
        controls.add_space(6.0);
        if self.view == View::Flesh {
            for kernel in self.chosen.clone() {
                if let Some(depth) = self.depth(kernel) {
                    let name = format!("{} reaches to", kernel.name());
                    let colour = tools::hue(controls, kernel);
                    reading(controls, &name, &format!("r = {}", number(depth)), colour);
                }
            }
            if self.chosen.iter().any(|kernel| !kernel.is_compact()) {
                let text = "A kernel that never ends counts as faded where \
                    its field is below a thousandth of T.";
                remark(controls, text);
            }
            if (self.strength - 1.0).abs() > 1e-6 {
                let text = "With a strength other than 1 the surface is no longer at R.";
                remark(controls, text);
            }
        } else {
            remark(
                controls,
                "1/u, 1/u² and 1/u³ have a pole: their field is infinite at the skeleton itself.",
            );
        }
        bench.readings.insert("radius", self.radius);
        bench.readings.insert("blobbiness", self.blobbiness);
        bench.readings.insert("chosen", self.chosen.len() as f64);
        stage.finish(ui);
    }

    fn dataset(&self) -> Command {
        Command::open("Kernels", self.text())
    }
}

/// Width and height of a kernel.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Shape {
    width: f64,
    height: f64,
}

impl Kernels {
    fn shaping(&self, kernel: Kernel) -> Shaping {
        Shaping {
            strength: self.strength,
            influence: INFLUENCE,
            ..sample::shaping(kernel, self.radius, self.blobbiness)
        }
    }

    fn shape(&self, kernel: Kernel) -> Option<Shape> {
        let shaping = self.shaping(kernel);
        let center = DVec3::ZERO;
        Some(Shape {
            width: shaping.width()?,
            height: shaping.height(&Skeleton::Point { center })?,
        })
    }

    /// Returns the distance beyond which a point's field is over: the support, or the distance
    /// where it has fallen to [`INFLUENCE`].
    fn depth(&self, kernel: Kernel) -> Option<f64> {
        let Shape { width, height } = self.shape(kernel)?;
        if kernel.is_compact() {
            return Some(1.0 / width);
        }
        let is_felt = |r: f64| height * kernel.value(width * r) > INFLUENCE * THRESHOLD;
        let (mut low, mut high) = (0.0, 1.0);
        while is_felt(high) {
            high *= 2.0;
            if high > 1e9 {
                return None;
            }
        }
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if is_felt(middle) {
                low = middle;
            } else {
                high = middle;
            }
        }
        Some(high)
    }

    /// Chooses a kernel, or lets it go; a third one takes the place of the first.
    fn toggle(&mut self, kernel: Kernel) {
        if self.chosen.contains(&kernel) {
            self.chosen.retain(|k| *k != kernel);
        } else {
            self.chosen.push(kernel);
            if self.chosen.len() > 2 {
                self.chosen.remove(0);
            }
        }
    }

    fn figure(&self, ui: &Ui, stage: &Stage, bench: &mut Bench<'_>) {
        let palette = theme::palette(ui.visuals());
        plot::panel(ui, stage.figure);
        let flesh = self.view == View::Flesh;
        let (x, y) = if flesh {
            let farthest = 3.2 * self.radius.max(0.8);
            let peak = (self.strength * 3.2).max(2.2);
            (
                Axis::new([0.0, farthest], "distance r"),
                Axis::new([0.0, peak], "field of one point"),
            )
        } else {
            (
                Axis::new([0.0, 3.0], "u, distance in kernel widths"),
                Axis::new([0.0, 1.5], "kernel h(u)"),
            )
        };
        let plot = Plot::new(ui, stage.figure, x, y);
        if flesh {
            let threshold = plot.at(0.0, THRESHOLD).y;
            let stroke = Stroke::new(1.5, palette.accent);
            plot.painter.hline(plot.rect.x_range(), threshold, stroke);
            let at = pos2(plot.rect.right() - 4.0, threshold - 4.0);
            let font = FontId::proportional(12.5);
            let text = "T = 1, the surface";
            let (painter, colour) = (ui.painter(), palette.accent);
            painter.text(at, Align2::RIGHT_BOTTOM, text, font, colour);
            plot.upright(
                self.radius,
                Stroke::new(1.0, palette.text),
                "R, the radius in isolation",
            );
        }
        // The chosen kernel is drawn last, above the others.
        let (above, below): (Vec<Kernel>, Vec<Kernel>) = Kernel::ALL
            .into_iter()
            .partition(|kernel| self.chosen.contains(kernel));
        for kernel in below.into_iter().chain(above) {
            self.curve(ui, &plot, kernel);
        }
        if flesh {
            let at = plot.at(self.radius, THRESHOLD * self.strength);
            let ring = Stroke::new(2.0, palette.paper);
            plot.painter.circle(at, 5.0, palette.strong, ring);
        }
        self.pointer(ui, &plot, bench);
    }

    /// Returns the plotted value of a kernel.
    fn value(&self, kernel: Kernel, x: f64) -> f64 {
        match self.view {
            View::Bare => kernel.value(x),
            View::Flesh => self
                .shape(kernel)
                .map_or(0.0, |shape| shape.height * kernel.value(shape.width * x)),
        }
    }

    /// Draws the curve of a kernel; those that are chosen are marked where they end.
    fn curve(&self, ui: &Ui, plot: &Plot, kernel: Kernel) {
        let chosen = self.chosen.contains(&kernel);
        let faded = !self.chosen.is_empty() && !chosen;
        let colour = tools::hue(ui, kernel);
        let colour = if faded {
            colour.gamma_multiply(0.28)
        } else {
            colour
        };
        let stroke = Stroke::new(if chosen { 3.0 } else { 1.8 }, colour);
        let Some(shape) = self.shape(kernel) else {
            return;
        };
        let value = |x: f64| match self.view {
            View::Bare => kernel.value(x),
            View::Flesh => shape.height * kernel.value(shape.width * x),
        };
        if kernel.is_compact() {
            plot.dashes(stroke, value);
        } else {
            plot.curve(stroke, value);
        }
        if !chosen {
            return;
        }
        // The radii at which the formula changes, and at which the kernel ends.
        let unit = if self.view == View::Flesh {
            shape.width
        } else {
            1.0
        };
        for kink in kernel.kinks().iter().filter(|kink| **kink < 1.0) {
            let at = plot.at(kink / unit, value(kink / unit));
            plot.painter.circle_filled(at, 3.5, colour);
        }
        let depth = match self.view {
            View::Flesh => self.depth(kernel),
            View::Bare => kernel.is_compact().then_some(1.0),
        };
        // On a phone the words would cover the curves; they stand below the figure as well.
        let words = plot.rect.width() > 420.0;
        if let Some(depth) = depth {
            let at = plot.at(depth, 0.0);
            let font = FontId::proportional(12.5);
            // Two marks beside each other must not cover each other.
            let lift = if self.chosen.first() == Some(&kernel) {
                30.0
            } else {
                12.0
            };
            if depth < plot.x[1] {
                let triangle = vec![
                    at,
                    at + egui::vec2(-6.0, -10.0),
                    at + egui::vec2(6.0, -10.0),
                ];
                let mark = egui::Shape::convex_polygon(triangle, colour, Stroke::NONE);
                plot.painter.add(mark);
                let place = at + egui::vec2(8.0, -lift + 4.0);
                let text = if words {
                    format!("end of {}", kernel.name())
                } else {
                    String::new()
                };
                let side = if at.x > plot.rect.right() - 110.0 {
                    Align2::RIGHT_BOTTOM
                } else {
                    Align2::LEFT_BOTTOM
                };
                plot.painter.text(place, side, text, font, colour);
            } else if words {
                let place = pos2(plot.rect.right() - 6.0, plot.rect.bottom() - lift);
                let text = format!("{} reaches on to r = {}", kernel.name(), number(depth));
                plot.painter
                    .text(place, Align2::RIGHT_BOTTOM, text, font, colour);
            }
        }
    }

    /// Draws the values under the pointer.
    fn pointer(&self, ui: &Ui, plot: &Plot, bench: &mut Bench<'_>) {
        let palette = theme::palette(ui.visuals());
        let response = ui.interact(plot.rect, ui.scope_id().with("kernels"), Sense::hover());
        let Some(pointer) = response.hover_pos() else {
            return;
        };
        let [x, _] = plot.value(pointer);
        bench.readings.insert("pointer", x);
        let line = Stroke::new(1.0, palette.weak.gamma_multiply(0.6));
        plot.painter.vline(pointer.x, plot.rect.y_range(), line);
        let shown: Vec<Kernel> = if self.chosen.is_empty() {
            Kernel::ALL.to_vec()
        } else {
            self.chosen.clone()
        };
        let name = if self.view == View::Flesh { "r" } else { "u" };
        let mut lines = vec![(format!("{name} = {x:.2}"), palette.strong)];
        for kernel in shown {
            let value = self.value(kernel, x);
            let colour = tools::hue(ui, kernel);
            plot.painter.circle_filled(plot.at(x, value), 4.0, colour);
            lines.push((format!("{}  {}", kernel.name(), number(value)), colour));
        }
        label(plot, pointer, &lines, palette.raised);
    }

    /// Writes balls in pairs, one pair for each of the chosen kernels, as a dataset.
    fn text(&self) -> String {
        let kernels = if self.chosen.is_empty() {
            vec![Kernel::Cauchy, Kernel::Quartic]
        } else {
            self.chosen.clone()
        };
        let mut text = format!(
            "# Two balls at the same distance, once for each kernel: \
             how do they reach for each other?\n\
             # From the lab, lesson 1.\n\n\
             eyep 0 0 {eye:.2}\nvrp 0 0 0\nvup 0 1 0\nfov 40\nframesize 640 480\nsample 3\n\
             light White point, position 4 6 8, intensity 0.9\n\
             light SlateBlue point, position -6 -1 4, intensity 0.5, noshadow\n\n\
             var radius     = {radius:.3} hot    # of each ball by itself\n\
             var blobbiness = {blob:.3} hot   # near 0: reaches far; far from 0: crisp\n\
             var gap        = {gap:.3} hot    # from centre to centre\n",
            eye = 9.0 * self.radius.max(0.6),
            radius = self.radius,
            blob = -self.blobbiness,
            gap = 2.3 * self.radius,
        );
        for (index, kernel) in kernels.iter().enumerate() {
            let colour = ["Coral", "SummerSky"][index % 2];
            let name = kernel.name();
            let y = if kernels.len() == 1 {
                String::from("0")
            } else if index == 0 {
                String::from("1.3*radius")
            } else {
                String::from("-1.3*radius")
            };
            let strength = if (self.strength - 1.0).abs() > 1e-6 {
                format!(", strength {:.3}", self.strength)
            } else {
                String::new()
            };
            text.push_str(&format!(
                "\nsurface {name}_flesh, diffuse {colour}, specular \
                 0.5 0.5 0.5, shine 40, blobbiness blobbiness, kernel {name}{strength}\n\
                 sphere {name}_flesh radius, <-gap/2 {y} 0>\n\
                 sphere {name}_flesh radius, < gap/2 {y} 0>\n"
            ));
        }
        text
    }
}

/// Draws lines of text beside the pointer.
fn label(plot: &Plot, pointer: egui::Pos2, lines: &[(String, Color32)], fill: Color32) {
    let painter = plot.painter.clone();
    let galleys: Vec<_> = lines
        .iter()
        .map(|(text, colour)| {
            let font = FontId::proportional(13.0);
            painter.layout_no_wrap(text.clone(), font, *colour)
        })
        .collect();
    let width = galleys.iter().map(|g| g.size().x).fold(0.0, f32::max) + 20.0;
    let height = galleys.iter().map(|g| g.size().y + 2.0).sum::<f32>() + 14.0;
    let right = pointer.x + 14.0 + width < plot.rect.right();
    let left = if right {
        pointer.x + 14.0
    } else {
        pointer.x - 14.0 - width
    };
    let top = (pointer.y - height - 8.0).clamp(
        plot.rect.top() + 2.0,
        (plot.rect.bottom() - height - 2.0).max(plot.rect.top() + 2.0),
    );
    let rect = egui::Rect::from_min_size(pos2(left, top), egui::vec2(width, height));
    painter.rect_filled(rect, 8.0, fill.gamma_multiply(0.94));
    let mut y = rect.top() + 7.0;
    for galley in galleys {
        let step = galley.size().y + 2.0;
        painter.galley(pos2(rect.left() + 10.0, y), galley, Color32::WHITE);
        y += step;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kernel_passes_through_the_threshold_at_the_radius() {
        let lesson = Kernels {
            radius: 0.7,
            blobbiness: 1.3,
            ..Kernels::default()
        };
        for kernel in Kernel::ALL {
            // Rounding alone.
            assert!((lesson.value(kernel, 0.7) - THRESHOLD).abs() < 1e-12);
            let depth = lesson.depth(kernel).unwrap();
            assert!(depth > 0.7, "{kernel:?}");
            assert!(
                lesson.value(kernel, depth * 1.0001) <= INFLUENCE,
                "{kernel:?}"
            );
        }
    }

    #[test]
    fn a_third_kernel_takes_the_place_of_the_first() {
        let mut lesson = Kernels::default();
        lesson.toggle(Kernel::Gauss);
        assert_eq!(lesson.chosen, [Kernel::Quartic, Kernel::Gauss]);
        lesson.toggle(Kernel::Gauss);
        assert_eq!(lesson.chosen, [Kernel::Quartic]);
    }
}
