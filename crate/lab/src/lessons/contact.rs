//! Lesson 9: two drops that touch and do not melt. Each is pressed onto the sheet where both fields
//! are equal; a bulge, a function of the other's field, keeps the surface smooth and gives back
//! volume.

use crate::bench::Bench;
use crate::command::Command;
use crate::figure::{Figure, Words};
use crate::plane::Plane;
use crate::plot::{self, Axis, Plot};
use crate::sample::{self, Window};
use crate::tools::{self, Stage, choice, heading, reading, remark, slider};
use contact::Bulge;
use core::f64::consts::PI;
use egui::{Align2, Color32, CursorIcon, FontId, Rect, Stroke, Ui, pos2, vec2};
use field::{Kernel, Primitive, Skeleton, Sum, THRESHOLD};
use glam::DVec3;
use picture::contour::Grid;
use widgets::theme;

/// Samples of the fields, columns and rows.
const SAMPLES: [usize; 2] = [141, 81];
/// The part of the plane that is shown, from the middle.
const HALF: [f64; 2] = [2.8, 1.6];
/// Radius of each drop alone.
const RADIUS: f64 = 1.0;
/// Blobbiness of the drops.
const BLOBBINESS: f64 = 1.5;
/// The range of half the distance between the drops.
const APART: [f64; 2] = [0.35, 1.5];

/// Kind of bulge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    Fast,
    Height,
    Ripple,
}

/// Inputs of the figure.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Key {
    kernel: Kernel,
    form: Form,
    /// Half the distance between the drops.
    apart: f64,
    c: f64,
    m: f64,
    h: f64,
    n: f64,
}

/// The words of the lesson.
pub static WORDS: Words = Words {
    link: "contact",
    title: "Drops that do not melt",
    name: "Drops that do not melt",
    short: "Contact",
    about: "pressed flat, with a bulge",
    sentences: "Where two drops would overlap, each loses as much of its field as the other's \
                exceeds T, so that both end on the sheet where the two fields are equal. Just \
                beside the sheet a small bulge is added instead, which keeps the surface smooth \
                and gives back some of the volume. Drag the drops, the beginning of the bulge and \
                its crest.",
};

/// The lesson's state.
pub struct Contact {
    key: Key,
    computed: Option<(Key, Drops)>,
}

impl Default for Contact {
    fn default() -> Self {
        Self {
            key: Key {
                kernel: Kernel::Cauchy,
                form: Form::Height,
                apart: 0.75,
                c: 0.2,
                m: 0.65,
                h: 0.25,
                n: 2.0,
            },
            computed: None,
        }
    }
}

impl Figure for Contact {
    fn show(&mut self, ui: &mut Ui, bench: &mut Bench<'_>) {
        let key = self.key;
        tools::renew(&mut self.computed, key, Key::compute);
        let mut stage = Stage::new(ui, bench.narrow, bench.height, 1.22);
        let palette = theme::palette(ui.visuals());
        let all = stage.figure;
        let gap = 10.0;
        let split = all.top() + 0.6 * (all.height() - gap);
        let upper = all.with_max_y(split);
        let lower = all.with_min_y(split + gap);
        if let Some((_, drops)) = &self.computed {
            draw(ui, upper, drops);
        }
        let map = Plane::below_title(upper, HALF, SAMPLES);
        for (name, sign) in [("left drop", -1.0), ("right drop", 1.0)] {
            let at = map.at([sign * key.apart, 0.0]);
            let grip = plot::grip(ui, name, at, palette.accent, CursorIcon::Grab);
            if let (true, Some(pointer)) = (grip.dragged(), grip.interact_pointer_pos()) {
                self.key.apart = (sign * map.world(pointer)[0]).clamp(APART[0], APART[1]);
            }
        }
        self.chart(ui, lower);
        self.controls(&mut stage.controls);
        if let Some((_, drops)) = &self.computed {
            let readings = &mut bench.readings;
            readings.insert("apart", key.apart);
            readings.insert("c", key.c);
            readings.insert("volume", drops.volumes[0]);
            readings.insert("cut", drops.volumes[1]);
            readings.insert("gap", drops.gap);
        }
        stage.finish(ui);
    }

    fn dataset(&self) -> Command {
        Command::open("Drops", self.text())
    }
}

/// Outlines and measures of the drops.
struct Drops {
    /// Outlines of the left and the right drop, pressed and alone.
    outlines: [Vec<Piece>; 2],
    alone: [Vec<Piece>; 2],
    insides: [Vec<Vec<[f32; 2]>>; 2],
    /// Volume of a pressed drop over that of one alone: with the bulge, and only cut off.
    volumes: [f64; 2],
    /// Largest gap between the drops where they touch, by their fields.
    gap: f64,
}

type Piece = [[f32; 2]; 2];

impl Key {
    fn bulge(&self) -> Bulge {
        match self.form {
            Form::Fast => Bulge::Fast { c: self.c },
            Form::Height => Bulge::Height {
                c: self.c,
                m: self.m.max(self.c + 0.02),
                h: self.h,
            },
            Form::Ripple => Bulge::Ripple {
                c: self.c,
                h: self.h,
                n: self.n.round().clamp(0.0, 6.0) as u32,
            },
        }
    }

    /// Returns the bulge in words of the language.
    fn words(&self) -> String {
        match self.bulge() {
            Bulge::Fast { c } => format!("fast {c:.3}"),
            Bulge::Height { c, m, h } => format!("height {c:.3} {m:.3} {h:.3}"),
            Bulge::Ripple { c, h, n } => format!("ripple {c:.3} {h:.3} {n}"),
        }
    }

    /// Returns the field of a drop at a place on the x axis.
    fn drop(&self, x: f64) -> Sum {
        let shaping = sample::shaping(self.kernel, RADIUS, BLOBBINESS);
        let center = DVec3::X * x;
        Primitive::new(Skeleton::Point { center }, &shaping, None)
            .into_iter()
            .collect()
    }

    /// Computes the outlines and measures.
    fn compute(&self) -> Drops {
        let [width, height] = SAMPLES;
        let window = Window {
            corner: DVec3::new(-HALF[0], -HALF[1], 0.0),
            across: DVec3::X * (2.0 * HALF[0]),
            up: DVec3::Y * (2.0 * HALF[1]),
        };
        let fields =
            [-self.apart, self.apart].map(|x| sample::whole(&self.drop(x), &window, width, height));
        let bulge = self.bulge();
        let level = THRESHOLD as f32;
        let pressed = [[0, 1], [1, 0]]
            .map(|[own, other]| press(&fields[own], &fields[other], |f| bulge.jet(f).0));
        let cut = press(&fields[0], &fields[1], |f| (THRESHOLD - f).min(0.0));
        let whole = volume(&fields[0]);
        let volumes = [&pressed[0], &cut].map(|grid| volume(grid) / whole.max(1e-9));
        // Inside both, the pressed fields are f₁+1−f₂ and f₂+1−f₁: one is as much above T as the
        // other is below.
        let sum = pressed[0].values.iter().zip(&pressed[1].values);
        let touching = fields[0].values.iter().zip(&fields[1].values);
        let gap = sum.zip(touching).filter(|(_, (a, b))| a.min(**b) > level);
        let gap = gap.map(|((a, b), _)| f64::from(a + b) - 2.0 * THRESHOLD);
        Drops {
            outlines: pressed.each_ref().map(|grid| grid.line(level)),
            alone: fields.each_ref().map(|grid| grid.line(level)),
            insides: pressed.each_ref().map(|grid| grid.inside(level)),
            volumes,
            gap: gap.fold(0.0, |most, gap| gap.abs().max(most)),
        }
    }
}

/// Adds a function of the other drop's field to a drop's own.
fn press(own: &Grid, other: &Grid, bulge: impl Fn(f64) -> f64) -> Grid {
    let both = own.values.iter().zip(&other.values);
    let values = both.map(|(own, other)| own + bulge(f64::from(*other)) as f32);
    Grid {
        values: values.collect(),
        ..*own
    }
}

/// Computes the volume that the figure encloses when it turns about its horizontal axis, by
/// samples.
fn volume(grid: &Grid) -> f64 {
    let [across, up] = [0, 1].map(|i| 2.0 * HALF[i] / (SAMPLES[i] - 1) as f64);
    let rows = grid.values.chunks_exact(grid.width).enumerate();
    let mut volume = 0.0;
    for (y, row) in rows {
        let radius = (y as f64 * up - HALF[1]).abs();
        // The share of each step along the row that is inside, by linear interpolation.
        let shares = row.windows(2).map(|pair| {
            let [a, b] = [pair[0], pair[1]].map(|f| f64::from(f) - THRESHOLD);
            match (a > 0.0, b > 0.0) {
                (true, true) => 1.0,
                (false, false) => 0.0,
                (true, false) => a / (a - b),
                (false, true) => b / (b - a),
            }
        });
        volume += PI * radius * shares.sum::<f64>();
    }
    volume * across * up
}

impl Contact {
    /// Draws the bulge as a function of the other drop's field, with grips.
    fn chart(&mut self, ui: &Ui, place: Rect) {
        let palette = theme::palette(ui.visuals());
        plot::panel(ui, place);
        let top = 0.42;
        let x = Axis::new([0.0, 1.4], "field of the other drop, in T");
        let y = Axis::new([-0.4, top], "added to a drop's own field");
        let plot = Plot::new(ui, place, x, y);
        let bulge = self.key.bulge();
        let tint = palette.note.gamma_multiply(0.25);
        plot.fill(tint, [bulge.start(), 1.0], |f| bulge.jet(f).0);
        plot.curve(Stroke::new(2.5, palette.note), |f| bulge.jet(f).0);
        plot.upright(THRESHOLD, Stroke::new(1.0, palette.text), "its surface");
        let grip = |name: &str, x: f64, y: f64| {
            let at = plot.at(x, y);
            let grip = plot::grip(ui, name, at, palette.accent, CursorIcon::Grab);
            let pointer = grip.interact_pointer_pos().filter(|_| grip.dragged());
            pointer.map(|pointer| plot.value(pointer))
        };
        if let Some([x, _]) = grip("bulge start", self.key.c, 0.0) {
            self.key.c = x.clamp(0.02, 0.9);
        }
        if self.key.form != Form::Fast {
            let crest = bulge.crest();
            if let Some([x, y]) = grip("bulge crest", crest, self.key.h) {
                self.key.h = y.clamp(0.0, top);
                if self.key.form == Form::Height {
                    self.key.m = x.clamp(self.key.c + 0.03, 0.97);
                }
            }
        }
        self.key.m = self.key.m.max(self.key.c + 0.03);
    }

    fn controls(&mut self, ui: &mut Ui) {
        let palette = theme::palette(ui.visuals());
        choice(
            ui,
            &mut self.key.form,
            &[
                (Form::Fast, "fast"),
                (Form::Height, "height"),
                (Form::Ripple, "ripple"),
            ],
        );
        let key = &mut self.key;
        slider(ui, "Half apart", &mut key.apart, APART[0]..=APART[1], "");
        slider(ui, "Begins at c", &mut key.c, 0.02..=0.9, " T");
        if key.form == Form::Height {
            slider(ui, "Highest at m", &mut key.m, key.c + 0.03..=0.97, " T");
        }
        if key.form != Form::Fast {
            slider(ui, "Height h", &mut key.h, 0.0..=0.42, " T");
        }
        if key.form == Form::Ripple {
            slider(ui, "Ripples n", &mut key.n, 0.0..=6.0, "");
            key.n = key.n.round();
        }
        heading(ui, "Kernel");
        if let Some(kernel) = tools::kernels(ui, |kernel| kernel == key.kernel) {
            key.kernel = kernel;
        }
        if let Some((_, drops)) = &self.computed {
            heading(ui, "Volume of a drop, compared with one alone");
            let [with, without] = drops.volumes.map(|share| format!("{:.1} %", 100.0 * share));
            reading(ui, "with the bulge", &with, palette.note);
            reading(ui, "only cut off", &without, palette.accent);
            remark(
                ui,
                "Dashed: each drop alone. Where the drops touch, both surfaces are one sheet, on \
                 which the fields are equal.",
            );
        }
    }

    /// Writes the two drops as a dataset.
    fn text(&self) -> String {
        let key = self.key;
        format!(
            "# Two drops that touch and do not melt.\n\
             # From the lab, lesson 9. Drag how far they are apart.\n\n\
             eyep 0 1.2 9\nvrp 0 0 0\nvup 0 1 0\nfov 32\nframesize 640 480\nsample 3\n\
             light White point, position 4 6 8, intensity 0.9\n\
             light SlateBlue point, position -6 -1 4, intensity 0.5, noshadow\n\n\
             var apart = {apart:.3} hot {low} {high}\n\n\
             surface left, diffuse SummerSky, specular 0.5 0.5 0.5, shine \
             40, blobbiness {blob}, kernel {kernel}\n\
             surface right, diffuse Coral, specular 0.5 0.5 0.5, shine \
             40, blobbiness {blob}, kernel {kernel}\n\n\
             body LEFT\n  sphere left {RADIUS}, <-apart 0 0>\nclose\n\
             body RIGHT\n  sphere right {RADIUS}, <apart 0 0>\nclose\n\
             contact LEFT RIGHT {words}\n",
            apart = key.apart,
            low = APART[0],
            high = APART[1],
            blob = -BLOBBINESS,
            kernel = key.kernel.name(),
            words = key.words(),
        )
    }
}

/// Draws the drops, pressed and alone.
fn draw(ui: &Ui, place: Rect, drops: &Drops) {
    let palette = theme::palette(ui.visuals());
    plot::panel(ui, place);
    let painter = ui.painter_at(place.shrink(1.0));
    let map = Plane::below_title(place, HALF, SAMPLES);
    let colours: [Color32; 2] = [palette.note, palette.accent];
    for (inside, colour) in drops.insides.iter().zip(colours) {
        map.fill(&painter, inside, colour.gamma_multiply(0.22));
    }
    let thin = Stroke::new(1.0, palette.weak);
    // Every other piece: dashes.
    for piece in drops.alone.iter().flat_map(|line| line.iter().step_by(2)) {
        painter.line_segment(piece.map(|p| map.sample(p)), thin);
    }
    for (line, colour) in drops.outlines.iter().zip(colours) {
        for piece in line {
            painter.line_segment(piece.map(|p| map.sample(p)), Stroke::new(2.5, colour));
        }
    }
    let font = FontId::proportional(13.0);
    let at = place.min + vec2(14.0, 9.0);
    let title = "Drag a drop";
    painter.text(at, Align2::LEFT_TOP, title, font, palette.text);
    let font = FontId::proportional(12.0);
    let at = pos2(place.right() - 14.0, place.bottom() - 8.0);
    painter.text(
        at,
        Align2::RIGHT_BOTTOM,
        "dashed: alone",
        font,
        palette.weak,
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drops_share_a_sheet_and_bulges_give_back_volume() {
        for kernel in [Kernel::Cauchy, Kernel::Gauss, Kernel::Cubed] {
            for form in [Form::Fast, Form::Height, Form::Ripple] {
                let key = Key {
                    kernel,
                    form,
                    ..Contact::default().key
                };
                let drops = key.compute();
                let [with, without] = drops.volumes;
                assert!(drops.gap < 1e-4, "{kernel:?} {form:?}: {}", drops.gap);
                assert!(without < 0.99 && with > without + 0.003, "{with} {without}");
            }
        }
        // A ball's volume, by samples.
        let key = Contact::default().key;
        let window = Window {
            corner: DVec3::new(-HALF[0], -HALF[1], 0.0),
            across: DVec3::X * (2.0 * HALF[0]),
            up: DVec3::Y * (2.0 * HALF[1]),
        };
        let ball = volume(&sample::whole(
            &key.drop(0.0),
            &window,
            SAMPLES[0],
            SAMPLES[1],
        ));
        assert!((ball / (4.0 / 3.0 * PI) - 1.0).abs() < 0.01, "{ball}");
    }

    #[test]
    fn the_dataset_has_the_drops_in_contact() {
        for form in [Form::Fast, Form::Height, Form::Ripple] {
            let mut lesson = Contact::default();
            lesson.key.form = form;
            let file = rats::File {
                name: String::from("main.rat"),
                text: lesson.text(),
            };
            let compiled = rats::compile(&rats::Project { files: vec![file] });
            assert_eq!(compiled.diagnostics, [], "{form:?}");
            assert_eq!(compiled.scene.contacts.len(), 1);
        }
    }
}
