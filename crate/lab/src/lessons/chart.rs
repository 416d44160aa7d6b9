//! Lesson 6: every kernel on every primitive, traced and timed.

use super::grid::note_refusal;
use crate::bench::Bench;
use crate::command::Command;
use crate::figure::{Figure, Words};
use crate::formulas::{self, BONES, Bone};
use crate::plot::number;
use crate::sample;
use crate::tools::{self, heading, remark};
use egui::{
    Align2, Color32, CursorIcon, FontId, Frame, Margin, Rect, RichText, Sense, Stroke, StrokeKind,
    Ui, pos2, vec2,
};
use field::{Kernel, Primitive, Skeleton};
use glam::DVec3;
use std::collections::HashMap;
use std::hint::black_box;
use wide::f32x8;
use widgets::{places, theme};

/// Seconds of each of the three timings of a cell, the quickest of which counts: browsers' clocks
/// tick every tenth of a millisecond.
const TIMING: f64 = 0.002;
/// Times that each cell is timed: the first round may come while the page is still starting.
const ROUNDS: usize = 2;
/// Least and most seconds of timing in one frame.
const BUDGET: [f64; 2] = [0.01, 0.12];
/// Share of a frame for timing.
const SHARE: f64 = 0.4;
/// Cells of the chart.
const CELLS: usize = Kernel::ALL.len() * BONES.len();

/// Remark on the numbers below the pictures.
const COSTS: &str = "2× means that a value and its gradient take twice as long as those of a \
    Cauchy point, measured just now in this window.";

/// A cell of the chart.
type Cell = (Kernel, Bone);

/// The words of the lesson.
pub static WORDS: Words = Words {
    link: "chart",
    title: "The chart",
    name: "The chart",
    short: "Chart",
    about: "every kernel on every primitive",
    sentences: "Every kernel can be convolved with every primitive; this is the whole table, \
                traced just now. Some cells have a closed formula, some need an elliptic \
                integral, some a small numerical one, and that shows in the time they take. \
                Choose a cell to see how its field is computed.",
};

/// The lesson's state.
pub struct Chart {
    chosen: Cell,
    /// Nanoseconds that one value and gradient take.
    costs: HashMap<Cell, f64>,
    /// The number of timings so far.
    timings: usize,
}

impl Default for Chart {
    fn default() -> Self {
        Self {
            chosen: (Kernel::Cauchy, Bone::Line),
            costs: HashMap::new(),
            timings: 0,
        }
    }
}

impl Figure for Chart {
    fn show(&mut self, ui: &mut Ui, bench: &mut Bench<'_>) {
        let top = ui.cursor().min;
        if bench.narrow {
            self.narrow(ui, bench);
        } else {
            self.wide(ui, bench);
        }
        let size = vec2(ui.available_width(), ui.cursor().top() - top.y);
        places::note(ui.ctx(), "lab figure", Rect::from_min_size(top, size));
        self.measure(ui, bench);
        let timed = (self.timings / ROUNDS) as f64;
        bench.readings.insert("timed", timed);
        if let Some(cost) = self.relative((Kernel::Cauchy, Bone::Line)) {
            bench.readings.insert("cauchyLine", cost);
        }
    }

    fn dataset(&self) -> Command {
        Command::open("Chart", self.text())
    }
}

/// Returns the bone of a column, as it is drawn.
fn skeleton(bone: Bone) -> Skeleton {
    let at = DVec3::new;
    match bone {
        Bone::Point => Skeleton::Point {
            center: DVec3::ZERO,
        },
        Bone::Line => Skeleton::Segment {
            base: at(-1.0, -0.35, 0.0),
            apex: at(1.0, 0.35, 0.0),
        },
        Bone::Arc => Skeleton::Arc {
            center: at(0.0, -0.35, 0.0),
            u: DVec3::X,
            v: DVec3::Y,
            radius: 0.95,
            angle: core::f64::consts::PI,
        },
        Bone::Triangle => Skeleton::Triangle {
            corners: [
                at(-1.0, -0.75, 0.0),
                at(1.0, -0.6, 0.0),
                at(-0.1, 0.95, 0.0),
            ],
        },
        Bone::Polygon => Skeleton::Polygon {
            rings: vec![L_SHAPE.map(|[x, y]| at(x, y, 0.0)).to_vec()],
        },
        Bone::Plane => Skeleton::Plane {
            point: at(0.0, -0.45, 0.0),
            normal: at(0.0, 1.0, 0.05).normalize(),
        },
        Bone::Curve => Skeleton::Curve {
            control: CURVE.map(|[x, y]| at(x, y, 0.0)),
        },
    }
}

const L_SHAPE: [[f64; 2]; 6] = [
    [-0.9, -0.9],
    [0.9, -0.9],
    [0.9, -0.2],
    [-0.1, -0.2],
    [-0.1, 0.9],
    [-0.9, 0.9],
];
const CURVE: [[f64; 2]; 4] = [[-1.1, -0.8], [-0.2, 1.9], [0.2, -1.9], [1.1, 0.8]];

/// Writes the line of the language that makes the bone.
fn line(bone: Bone) -> String {
    fn list(points: &[[f64; 2]]) -> String {
        let points = points.iter().map(|[x, y]| format!(" <{x} {y} 0>"));
        points.collect()
    }
    match bone {
        Bone::Point => String::from("sphere flesh radius, <0 0 0>"),
        Bone::Line => String::from("cylinder flesh radius, <-1 -0.35 0> <1 0.35 0>"),
        Bone::Arc => String::from("arc flesh 0.95 radius, <0 -0.35 0> <0 0 1> 0 180"),
        Bone::Triangle => String::from("triangle flesh <-1 -0.75 0> <1 -0.6 0> <-0.1 0.95 0>"),
        Bone::Polygon => format!("polygon flesh{}", list(&L_SHAPE)),
        Bone::Plane => String::from("plane flesh <0 -0.45 0> <0 1 0.05>"),
        Bone::Curve => format!("curve flesh radius,{}", list(&CURVE)),
    }
}

/// Returns the strength that a cell needs: kernels without a finite line or plane are scaled by one
/// of 10 radii to each side, and bones that are much smaller need more to have flesh.
fn strength(kernel: Kernel, bone: Bone) -> &'static str {
    match (kernel, bone) {
        (Kernel::Inverse, Bone::Line) => ", strength 1.6",
        (Kernel::Inverse, Bone::Arc | Bone::Curve) => ", strength 1.3",
        (Kernel::Inverse, Bone::Triangle | Bone::Polygon) => ", strength 6",
        (Kernel::Squared, Bone::Triangle | Bone::Polygon) => ", strength 5",
        _ => "",
    }
}

/// Writes a cell as a dataset.
fn text((kernel, bone): Cell) -> String {
    let name = kernel.name();
    format!(
        "# The kernel {name} on {bone}. From the lab, lesson 6.\n\
         # {formula}\n\n\
         {view}\nvup 0 1 0\nfov 32\nframesize 480 400\nsample 3\n\
         light White point, position 3 6 6, intensity 0.9\n\
         light SlateBlue point, position -5 -1 4, intensity 0.5, noshadow\n\n\
         var radius     = 0.35 hot\n\
         var blobbiness = -1.5 hot\n\
         surface flesh, diffuse Coral, specular 0.5 0.5 0.5, shine \
         40, blobbiness blobbiness, radius radius, kernel {name}{strength}\n\n\
         {line}\n",
        view = if bone == Bone::Plane {
            // The horizon in the middle.
            "eyep 1.6 0.5 5.2\nvrp 0 0.1 0"
        } else {
            "eyep 1.6 1.3 5.2\nvrp 0 0 0"
        },
        strength = strength(kernel, bone),
        bone = bone.with_article(),
        formula = formulas::cell(kernel, bone).formula,
        line = line(bone),
    )
}

/// Measures the nanoseconds for one value and gradient of a primitive, over places near it.
fn time(cell: Cell) -> Option<f64> {
    let shaping = sample::shaping(cell.0, 0.35, 1.5);
    let primitive = Primitive::new(skeleton(cell.1), &shaping, None)?;
    let places: Vec<[f32x8; 3]> = (0..64)
        .map(|step| {
            [0.618, 0.414, 0.732].map(|rate: f32| {
                f32x8::from(core::array::from_fn(|lane| {
                    let x = (8 * step + lane) as f32 * rate;
                    2.4 * (x - x.floor()) - 1.2
                }))
            })
        })
        .collect();
    let mut quickest = f64::INFINITY;
    for _ in 0..3 {
        let mut sum = f32x8::splat(0.0);
        let mut count = 0u32;
        let begun = pool::clock::stopwatch();
        let mut taken = 0.0;
        while taken < TIMING {
            for place in &places {
                let jet = black_box(&primitive).jet::<f32x8>(*place);
                sum += jet.value + jet.gradient[0] + jet.gradient[1] + jet.gradient[2];
            }
            count += 64;
            taken = pool::clock::stopwatch() - begun;
        }
        black_box(sum);
        quickest = quickest.min(1e9 * taken / (8.0 * f64::from(count)));
    }
    Some(quickest)
}

impl Chart {
    /// Returns the cost of a cell relative to the Cauchy point, once both are known.
    fn relative(&self, cell: Cell) -> Option<f64> {
        let unit = self.costs.get(&(Kernel::Cauchy, Bone::Point))?;
        Some(self.costs.get(&cell)? / unit)
    }

    /// Whether every cell was timed.
    fn is_timed(&self) -> bool {
        self.timings >= ROUNDS * CELLS
    }

    /// Times more cells. Pictures wait until all are timed, so that the workers do not compete.
    fn measure(&mut self, ui: &Ui, bench: &Bench<'_>) {
        if bench.pictures.blocked.is_some() || self.is_timed() {
            return;
        }
        let frame = f64::from(ui.input(|input| input.unstable_dt));
        let budget = (SHARE * frame).clamp(BUDGET[0], BUDGET[1]);
        let begun = pool::clock::stopwatch();
        while !self.is_timed() && pool::clock::stopwatch() - begun < budget {
            let index = self.timings % CELLS;
            let cell = (Kernel::ALL[index / BONES.len()], BONES[index % BONES.len()]);
            let cost = time(cell).unwrap_or(f64::NAN);
            let known = self.costs.entry(cell).or_insert(cost);
            *known = known.min(cost);
            self.timings += 1;
        }
        ui.ctx().request_repaint();
    }

    fn narrow(&mut self, ui: &mut Ui, bench: &mut Bench<'_>) {
        heading(ui, "Kernel");
        if let Some(kernel) = tools::kernels(ui, |kernel| kernel == self.chosen.0) {
            self.chosen.0 = kernel;
        }
        ui.add_space(6.0);
        let gap = 10.0;
        let width = ((ui.available_width() - gap) / 2.0).floor();
        let size = vec2(width, (0.8 * width).floor() + 46.0);
        for row in BONES.chunks(2) {
            ui.horizontal(|ui| {
                ui.spacing_mut().item_spacing.x = gap;
                for &bone in row {
                    let (place, _) = ui.allocate_exact_size(size, Sense::hover());
                    self.cell(ui, place, (self.chosen.0, bone), 46.0, true, bench);
                }
            });
        }
        ui.add_space(4.0);
        self.details(ui, bench);
        remark(ui, COSTS);
    }

    fn wide(&mut self, ui: &mut Ui, bench: &mut Bench<'_>) {
        let palette = theme::palette(ui.visuals());
        self.details(ui, bench);
        ui.add_space(6.0);
        let all = ui.available_width();
        let side = 92.0;
        let gap = 8.0;
        let width = ((all - side) / BONES.len() as f32 - gap).floor();
        let picture = (0.72 * width).floor();
        let caption = 24.0;
        let size = vec2(width, picture + caption);
        let font = FontId::proportional(13.5);
        let (head, _) = ui.allocate_exact_size(vec2(all, 22.0), Sense::hover());
        for (column, bone) in BONES.into_iter().enumerate() {
            let x = head.left() + side + (width + gap) * column as f32 + width / 2.0;
            let at = pos2(x, head.center().y);
            let painter = ui.painter();
            painter.text(
                at,
                Align2::CENTER_CENTER,
                bone.name(),
                font.clone(),
                palette.text,
            );
        }
        for kernel in Kernel::ALL {
            let (row, _) = ui.allocate_exact_size(vec2(all, size.y + 2.0), Sense::hover());
            let colour = tools::hue(ui, kernel);
            let at = pos2(row.left(), row.top() + picture / 2.0);
            ui.painter().circle_filled(at + vec2(5.0, 0.0), 5.0, colour);
            let name = kernel.name();
            let at = at + vec2(17.0, 0.0);
            ui.painter()
                .text(at, Align2::LEFT_CENTER, name, font.clone(), palette.text);
            for (column, bone) in BONES.into_iter().enumerate() {
                let x = row.left() + side + (width + gap) * column as f32;
                let place = Rect::from_min_size(pos2(x, row.top()), size);
                self.cell(ui, place, (kernel, bone), caption, false, bench);
            }
        }
        ui.add_space(4.0);
        remark(ui, COSTS);
    }

    fn cell(
        &mut self,
        ui: &Ui,
        place: Rect,
        cell: Cell,
        caption: f32,
        named: bool,
        bench: &mut Bench<'_>,
    ) {
        let (kernel, bone) = cell;
        let palette = theme::palette(ui.visuals());
        let picture = place.with_max_y(place.bottom() - caption);
        let id = ui.scope_id().with(("cell", kernel, bone));
        let response = ui.interact(place, id, Sense::click());
        let name = format!("{} on {}", kernel.name(), bone.with_article());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &name));
        let label = format!("lab cell {} {}", kernel.name(), bone.name());
        places::note(ui.ctx(), label, place);
        // Cells far off the screen are not traced before they are scrolled to.
        let near = ui.clip_rect().expand(400.0).intersects(picture);
        if near && self.is_timed() {
            let slot = ("chart", kernel, bone);
            let shown = bench.pictures.show(ui, slot, &text(cell), picture);
            note_refusal(ui, picture, &shown);
        } else {
            ui.painter().rect_filled(picture, 6.0, palette.paper);
        }
        let chosen = self.chosen == cell;
        if chosen || response.hovered() || response.has_focus() {
            let colour = if chosen { palette.accent } else { palette.weak };
            let stroke = Stroke::new(2.0, colour);
            ui.painter()
                .rect_stroke(picture, 6.0, stroke, StrokeKind::Inside);
        }
        let way = formulas::cell(kernel, bone).way;
        let cost = self.cost(cell);
        let small = FontId::proportional(11.5);
        let painter = ui.painter();
        let mut at = picture.left_bottom() + vec2(3.0, 4.0);
        if named {
            let font = FontId::proportional(14.0);
            painter.text(at, Align2::LEFT_TOP, bone.name(), font, palette.strong);
            at.y += 19.0;
        }
        painter.text(
            at,
            Align2::LEFT_TOP,
            way,
            small.clone(),
            way_colour(ui, way),
        );
        let at = pos2(picture.right() - 3.0, at.y);
        painter.text(at, Align2::RIGHT_TOP, cost, small, palette.text);
        if response.on_hover_cursor(CursorIcon::PointingHand).clicked() {
            self.chosen = cell;
        }
    }

    /// Writes the cost: "–" while it is not known.
    fn cost(&self, cell: Cell) -> String {
        match self.relative(cell).filter(|cost| cost.is_finite()) {
            Some(cost) if cost >= 10.0 => format!("{cost:.0}×"),
            Some(cost) => format!("{cost:.1}×"),
            None => String::from("–"),
        }
    }

    /// Draws the chosen cell: formula, method, cost, and a button that opens it in the editor.
    fn details(&mut self, ui: &mut Ui, bench: &mut Bench<'_>) {
        let palette = theme::palette(ui.visuals());
        let (kernel, bone) = self.chosen;
        let cell = formulas::cell(kernel, bone);
        let frame = Frame::new()
            .fill(palette.paper)
            .stroke(Stroke::new(1.0, palette.line))
            .corner_radius(10.0)
            .inner_margin(Margin::symmetric(16, 12));
        frame.show(ui, |ui| {
            ui.set_width(ui.available_width());
            ui.spacing_mut().item_spacing.y = 5.0;
            ui.horizontal_wrapped(|ui| {
                let title = format!("{} on {}", kernel.name(), bone.with_article());
                ui.label(RichText::new(title).size(16.0).color(palette.strong));
                ui.add_space(6.0);
                let colour = way_colour(ui, cell.way);
                ui.label(RichText::new(cell.way).size(13.0).color(colour));
                let cost = match self.relative(self.chosen).filter(|cost| cost.is_finite()) {
                    Some(_) => {
                        let time = self.costs.get(&self.chosen).copied().unwrap_or(f64::NAN);
                        let cost = self.cost(self.chosen);
                        format!("{cost} the cost of a Cauchy point ({} ns)", number(time))
                    }
                    None => String::from("cost: not measured yet"),
                };
                ui.label(RichText::new(cost).size(13.0).color(palette.weak));
                let open = ui.button(RichText::new("Open this cell").size(13.0));
                places::note(ui.ctx(), "lab open cell", open.rect);
                if open.clicked() {
                    bench.commands.push(Command::OpenText {
                        name: format!("{} {}", kernel.name(), bone.name()),
                        text: text(self.chosen),
                    });
                }
            });
            let formula = format!("{},     {}", kernel.formula(), cell.formula);
            ui.label(RichText::new(formula).size(15.0).color(palette.command));
            remark(
                ui,
                format!("All lengths in kernel widths; {}.", cell.letters),
            );
        });
    }

    /// Writes the chosen cell as a dataset.
    fn text(&self) -> String {
        text(self.chosen)
    }
}

/// Returns the colour of closed formulas, of special functions, or of numerical integrals.
fn way_colour(ui: &Ui, way: &str) -> Color32 {
    match way {
        "closed" | "windowed" => crate::plot::hue(ui, 2),
        "Carlson" | "error function" | "Owen's T" | "dilogarithm" => crate::plot::hue(ui, 1),
        _ => crate::plot::hue(ui, 0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_cell_has_a_formula_and_a_text() {
        for kernel in Kernel::ALL {
            for bone in BONES {
                let cell = formulas::cell(kernel, bone);
                assert!(cell.formula.starts_with("F = ") && !cell.letters.is_empty());
                assert!(text((kernel, bone)).contains(kernel.name()));
                assert!(!cell.way.is_empty());
            }
        }
    }

    #[test]
    fn the_text_of_a_cell_makes_the_bone_that_is_timed() {
        for bone in BONES {
            let file = rats::File {
                name: String::from("main.rat"),
                text: text((Kernel::Cauchy, bone)),
            };
            let compiled = rats::compile(&rats::Project { files: vec![file] });
            // A note says that a short bone's surface is nearer than its radius.
            let mut said = compiled.diagnostics.iter();
            assert!(
                said.all(|said| said.severity == rats::Severity::Note),
                "{bone:?}"
            );
            let field = compiled.scene.soft_surfaces().swap_remove(0).sum;
            // Curves are cut into pieces where they are drawn.
            let pieces = &field.primitives;
            assert!(pieces.len() == 1 || bone == Bone::Curve && !pieces.is_empty());
            let want = skeleton(bone);
            for at in [DVec3::new(0.3, 0.2, 0.1), DVec3::new(-2.0, 0.5, 1.0)] {
                let each = pieces.iter().map(|piece| piece.skeleton.distance(at));
                let (a, b) = (each.fold(f64::INFINITY, f64::min), want.distance(at));
                assert!((a - b).abs() < 1e-6, "{bone:?}: {a} {b}");
            }
        }
    }
}
