//! Lesson 7: cutting a bone changes nothing, since the integral over the whole is the sum of those
//! over its parts; a field made of distances bulges at the cut.

use crate::bench::Bench;
use crate::command::Command;
use crate::figure::{Figure, Words};
use crate::plane::Plane;
use crate::plot::{self, number};
use crate::sample::{self, Window};
use crate::tools::{self, Stage, choice, heading, reading, remark, slider};
use core::f64::consts::PI;
use egui::{Align2, Color32, CursorIcon, FontId, Pos2, Rect, Stroke, Ui, pos2, vec2};
use field::{Kernel, Primitive, Shaping, Skeleton, Sum, THRESHOLD};
use glam::DVec3;
use picture::contour::Grid;
use widgets::theme;

/// Samples of the fields, columns and rows.
const SAMPLES: [usize; 2] = [121, 67];
/// The part of the plane that is shown, from the middle.
const HALF: [f64; 2] = [2.9, 1.4];
/// Half the length of the segment.
const LENGTH: f64 = 2.0;
/// Radius and half the opening of the arc.
const ARC: (f64, f64) = (1.75, 1.15);
/// The arc's centre, so that its middle is about that of the figure.
const CENTER: DVec3 = DVec3::new(0.0, -1.2, 0.0);

/// Bone that is cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Bone {
    Segment,
    Arc,
}

/// Inputs of the fields.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Key {
    bone: Bone,
    kernel: Kernel,
    radius: f64,
    blobbiness: f64,
    cut: f64,
}

/// The words of the lesson.
pub static WORDS: Words = Words {
    link: "superposition",
    title: "Superposition",
    name: "Superposition",
    short: "Superposition",
    about: "why a cut bone shows no seam",
    sentences: "Cut the bone wherever you like: an integral over the whole is the sum of the \
                integrals over its parts, so a convolution surface does not notice. In the lower \
                figure the fields of the same parts depend on the distance instead, and near the \
                cut both parts count in full, so the surface bulges. That is why a skeleton may \
                be put together from many pieces here.",
};

/// The lesson's state.
pub struct Superposition {
    key: Key,
    computed: Option<(Key, Fields)>,
}

impl Default for Superposition {
    fn default() -> Self {
        Self {
            key: Key {
                bone: Bone::Segment,
                kernel: Kernel::Cauchy,
                radius: 0.45,
                blobbiness: 2.0,
                cut: 0.42,
            },
            computed: None,
        }
    }
}

impl Figure for Superposition {
    fn show(&mut self, ui: &mut Ui, bench: &mut Bench<'_>) {
        let key = self.key;
        tools::renew(&mut self.computed, key, Key::compute);
        let mut stage = Stage::new(ui, bench.narrow, bench.height, 1.22);
        let palette = theme::palette(ui.visuals());
        let all = stage.figure;
        let gap = 10.0;
        let half = (all.height() - gap) / 2.0;
        let upper = Rect::from_min_size(all.min, vec2(all.width(), half));
        let lower = Rect::from_min_size(all.min + vec2(0.0, half + gap), upper.size());
        if let Some((_, fields)) = &self.computed {
            let titles = [
                "Convolution: ∫ h over each part",
                "Distance: h(nearest point) of each part",
            ];
            for (index, place) in [upper, lower].into_iter().enumerate() {
                let lines = if index == 0 {
                    &fields.convolution
                } else {
                    &fields.distance
                };
                let inside = &fields.insides[index];
                let colour = if index == 0 {
                    palette.note
                } else {
                    palette.accent
                };
                outline(ui, place, titles[index], lines, inside, colour, &key);
            }
        }
        // The cut is one, so it can be taken hold of in both.
        for (name, place) in [("cut", upper), ("cut below", lower)] {
            let map = Plane::below_title(place, HALF, SAMPLES);
            let at = map.at(key.place(key.cut).truncate().into());
            let grip = plot::grip(ui, name, at, palette.accent, CursorIcon::Grab);
            if let (true, Some(pointer)) = (grip.dragged(), grip.interact_pointer_pos()) {
                self.key.cut = key.share(map.world(pointer)).clamp(0.02, 0.98);
            }
        }
        let controls = &mut stage.controls;
        choice(
            controls,
            &mut self.key.bone,
            &[(Bone::Segment, "Segment"), (Bone::Arc, "Arc")],
        );
        slider(controls, "Cut at", &mut self.key.cut, 0.02..=0.98, "");
        slider(controls, "Radius R", &mut self.key.radius, 0.15..=0.9, "");
        let blobbiness = &mut self.key.blobbiness;
        slider(controls, "Blobbiness |B|", blobbiness, 0.3..=6.0, "");
        heading(controls, "Kernel");
        if let Some(kernel) = tools::kernels(controls, |kernel| kernel == key.kernel) {
            self.key.kernel = kernel;
        }
        if let Some((_, fields)) = &self.computed {
            heading(controls, "Largest change of the field by the cut");
            let [one, other] = fields
                .differences
                .map(|value| format!("{} T", number(value)));
            reading(controls, "Convolution", &one, palette.note);
            reading(controls, "Distance", &other, palette.accent);
            heading(controls, "Growth in thickness at the cut");
            let growth = fields
                .swelling
                .map(|ratio| format!("{:.1} %", 100.0 * (ratio - 1.0)));
            reading(controls, "Convolution", &growth[0], palette.note);
            reading(controls, "Distance", &growth[1], palette.accent);
            remark(
                controls,
                "The difference in the first line is only the rounding of single precision.",
            );
            let readings = &mut bench.readings;
            readings.insert("cut", key.cut);
            readings.insert("convolution", fields.differences[0]);
            readings.insert("distance", fields.differences[1]);
            readings.insert("swelling", fields.swelling[1]);
        }
        stage.finish(ui);
    }

    fn dataset(&self) -> Command {
        Command::open("Superposition", self.text())
    }
}

/// Outlines and measures of the fields.
struct Fields {
    /// Outline of the whole bone and of the sum of its parts.
    convolution: [Vec<Piece>; 2],
    /// Outline of the whole bone and of its parts, for fields of the distance.
    distance: [Vec<Piece>; 2],
    /// Areas that the parts enclose, by convolution and by distance.
    insides: [Vec<Vec<[f32; 2]>>; 2],
    /// Largest difference that the cut makes, over the plane, in units of T.
    differences: [f64; 2],
    /// Thickness at the cut over that of the whole bone.
    swelling: [f64; 2],
}

type Piece = [[f32; 2]; 2];

impl Key {
    fn shaping(&self) -> Shaping {
        sample::shaping(self.kernel, self.radius, self.blobbiness)
    }

    /// Returns the place on the bone at a share of its length.
    fn place(&self, share: f64) -> DVec3 {
        match self.bone {
            Bone::Segment => DVec3::new(LENGTH * (2.0 * share - 1.0), 0.0, 0.0),
            Bone::Arc => {
                let (radius, opening) = ARC;
                let angle = PI / 2.0 + opening * (1.0 - 2.0 * share);
                let (sine, cosine) = libm::sincos(angle);
                CENTER + DVec3::new(radius * cosine, radius * sine, 0.0)
            }
        }
    }

    /// Returns the share of the bone's length nearest to a place.
    fn share(&self, [x, y]: [f64; 2]) -> f64 {
        match self.bone {
            Bone::Segment => (x / LENGTH + 1.0) / 2.0,
            Bone::Arc => {
                let angle = libm::atan2(y - CENTER.y, x);
                (1.0 - (angle - PI / 2.0) / ARC.1) / 2.0
            }
        }
    }

    /// Returns the part of the bone between two shares of its length.
    fn part(&self, from: f64, to: f64) -> Skeleton {
        match self.bone {
            Bone::Segment => Skeleton::Segment {
                base: self.place(from),
                apex: self.place(to),
            },
            Bone::Arc => {
                let (radius, opening) = ARC;
                let u = (self.place(from) - CENTER) / radius;
                // Clockwise.
                let v = DVec3::new(u.y, -u.x, 0.0);
                Skeleton::Arc {
                    center: CENTER,
                    u,
                    v,
                    radius,
                    angle: 2.0 * opening * (to - from),
                }
            }
        }
    }

    fn window(&self) -> Window {
        Window {
            corner: DVec3::new(-HALF[0], -HALF[1], 0.0),
            across: DVec3::X * (2.0 * HALF[0]),
            up: DVec3::Y * (2.0 * HALF[1]),
        }
    }

    /// Returns the field of parts by convolution.
    fn convolve(&self, parts: &[Skeleton]) -> Sum {
        let shaping = self.shaping();
        parts
            .iter()
            .filter_map(|part| Primitive::new(part.clone(), &shaping, None))
            .collect()
    }

    /// Computes Σ h(distance to each part), scaled so that one part has the radius R.
    fn by_distance(&self, parts: &[Skeleton], at: DVec3) -> f64 {
        let shaping = self.shaping();
        let center = DVec3::ZERO;
        let point = Skeleton::Point { center };
        let (Some(width), Some(height)) = (shaping.width(), shaping.height(&point)) else {
            return 0.0;
        };
        let distances = parts.iter().map(|part| part.distance(at));
        distances
            .map(|distance| height * self.kernel.value(width * distance))
            .sum()
    }

    /// Finds the distance from the bone, across it at the cut, where a field falls to T.
    fn thickness(&self, field: impl Fn(DVec3) -> f64) -> f64 {
        let at = self.place(self.cut);
        let out = match self.bone {
            Bone::Segment => DVec3::Y,
            Bone::Arc => (at - CENTER).normalize(),
        };
        let (mut low, mut high) = (0.0, 20.0 * self.radius);
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if field(at + out * middle) > THRESHOLD {
                low = middle;
            } else {
                high = middle;
            }
        }
        low
    }

    /// Computes outlines and measures.
    fn compute(&self) -> Fields {
        let whole = [self.part(0.0, 1.0)];
        let parts = [self.part(0.0, self.cut), self.part(self.cut, 1.0)];
        let [width, height] = SAMPLES;
        let window = self.window();
        let fields = [self.convolve(&whole), self.convolve(&parts)];
        let convolution = [0, 1].map(|i| sample::whole(&fields[i], &window, width, height));
        let distance = [&whole[..], &parts].map(|parts| Grid {
            width,
            height,
            values: (0..width * height)
                .map(|i| {
                    let x = (i % width) as f64 / (width - 1) as f64;
                    let y = (i / width) as f64 / (height - 1) as f64;
                    self.by_distance(parts, window.at(x, y)) as f32
                })
                .collect(),
        });
        let by_integral = [0, 1].map(|i| self.thickness(|at| sample::one(&[&fields[i]], at)));
        let by_distance =
            [&whole[..], &parts].map(|parts| self.thickness(|at| self.by_distance(parts, at)));
        let level = THRESHOLD as f32;
        Fields {
            insides: [&convolution[1], &distance[1]].map(|grid| grid.inside(level)),
            differences: [&convolution, &distance].map(difference),
            swelling: [by_integral, by_distance].map(|[one, two]| two / one.max(1e-9)),
            convolution: convolution.map(|grid| grid.line(level)),
            distance: distance.map(|grid| grid.line(level)),
        }
    }
}

/// Returns the largest difference of two grids.
fn difference([a, b]: &[Grid; 2]) -> f64 {
    let both = a.values.iter().zip(&b.values);
    // At poles of a kernel both are infinite, or nearly.
    let finite = both.filter(|(a, b)| a.max(**b) < 100.0);
    let differences = finite.map(|(a, b)| f64::from((a - b).abs()));
    differences.fold(0.0, f64::max)
}

impl Superposition {
    /// Writes the bone whole and cut, one above the other, as a dataset.
    fn text(&self) -> String {
        let key = self.key;
        let name = key.kernel.name();
        let mut text = format!(
            "# A bone in one piece (above) and the same bone \
             in two (below): no seam is to be seen.\n\
             # From the lab, lesson 7. Drag the cut.\n\n\
             eyep 0 0 11\nvrp 0 0 0\nvup 0 1 0\nfov 34\nframesize 640 480\nsample 3\n\
             light White point, position 4 6 8, intensity 0.9\n\
             light SlateBlue point, position -6 -1 4, intensity 0.5, noshadow\n\n\
             var cut        = {cut:.3} hot    # where, 0 to 1\n\
             var radius     = {radius:.3} hot\n\
             var blobbiness = {blob:.3} hot\n\n\
             surface whole, diffuse SummerSky, specular 0.5 0.5 0.5, shine \
             40, blobbiness blobbiness, kernel {name}\n\
             surface parts, diffuse Coral, specular 0.5 0.5 0.5, shine \
             40, blobbiness blobbiness, kernel {name}\n\n",
            cut = key.cut,
            radius = key.radius,
            blob = -key.blobbiness,
        );
        match key.bone {
            Bone::Segment => text.push_str(&format!(
                "cylinder whole radius, <{a} 1.2 0> <{b} 1.2 0>\n\n\
                 var x = {a} + {length}*cut\n\
                 cylinder parts radius, <{a} -1.2 0> <x -1.2 0>\n\
                 cylinder parts radius, <x -1.2 0> <{b} -1.2 0>\n",
                a = -LENGTH,
                b = LENGTH,
                length = 2.0 * LENGTH,
            )),
            Bone::Arc => {
                let (sweep, opening) = ARC;
                let from = (PI / 2.0 - opening).to_degrees();
                let whole = (2.0 * opening).to_degrees();
                let ends = [0.0, 1.0].map(|share| key.place(share));
                let ends = ends.map(|p| format!("<{:.4} {:.4} 0>", p.x, p.y));
                text.push_str(&format!(
                    "# its ends: {} {}\n\
                     arc whole {sweep} radius, <0 -0.6 0> <0 0 1> {from:.3} {whole:.3}\n\n\
                     var first = {whole:.3}*(1-cut)\n\
                     arc parts {sweep} radius, <0 -2.4 0> <0 0 1> {from:.3} first\n\
                     arc parts {sweep} radius, <0 -2.4 0> <0 0 1> {from:.3}+first \
                     {whole:.3}-first\n",
                    ends[0], ends[1],
                ));
            }
        }
        text
    }
}

/// Draws one of the two figures: the flesh, its outline, the outline without the cut, and the bone.
fn outline(
    ui: &Ui,
    place: Rect,
    title: &str,
    [whole, parts]: &[Vec<Piece>; 2],
    inside: &[Vec<[f32; 2]>],
    colour: Color32,
    key: &Key,
) {
    let palette = theme::palette(ui.visuals());
    plot::panel(ui, place);
    let painter = ui.painter_at(place.shrink(1.0));
    let map = Plane::below_title(place, HALF, SAMPLES);
    let tint = colour.gamma_multiply(0.2);
    map.fill(&painter, inside, tint);
    let stroke = Stroke::new(2.5, colour);
    for piece in parts {
        painter.line_segment(piece.map(|p| map.sample(p)), stroke);
    }
    let thin = Stroke::new(1.2, palette.strong);
    // Every other piece: dashes.
    for piece in whole.iter().step_by(2) {
        painter.line_segment(piece.map(|p| map.sample(p)), thin);
    }
    for (from, to, shade) in [(0.0, key.cut, palette.text), (key.cut, 1.0, palette.weak)] {
        let points: Vec<Pos2> = (0..=32)
            .map(|i| key.place(from + (to - from) * f64::from(i) / 32.0))
            .map(|place| map.at(place.truncate().into()))
            .collect();
        painter.line(points, Stroke::new(3.0, shade));
    }
    let font = FontId::proportional(13.0);
    let at = place.min + vec2(14.0, 9.0);
    painter.text(at, Align2::LEFT_TOP, title, font, palette.text);
    let font = FontId::proportional(12.0);
    let at = pos2(place.right() - 14.0, place.bottom() - 8.0);
    let text = "thin line: without the cut";
    painter.text(at, Align2::RIGHT_BOTTOM, text, font, palette.weak);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cut_changes_nothing_in_a_convolution_and_bulges_in_distances() {
        for bone in [Bone::Segment, Bone::Arc] {
            for cut in [0.1, 0.5, 0.83] {
                let key = Key {
                    bone,
                    cut,
                    ..Superposition::default().key
                };
                let fields = key.compute();
                // The rounding of single precision, and no more: see the accuracy of `field`.
                assert!(fields.differences[0] < 1e-4, "{bone:?} {cut}");
                assert!((fields.swelling[0] - 1.0).abs() < 1e-4, "{bone:?} {cut}");
                // At the cut both parts count in full: with T from one part, T too much.
                assert!(fields.differences[1] > 0.9, "{bone:?} {cut}");
                assert!(fields.swelling[1] > 1.1, "{bone:?} {cut}");
            }
        }
    }

    #[test]
    fn the_dataset_has_the_bone_whole_and_in_two_parts() {
        for bone in [Bone::Segment, Bone::Arc] {
            for kernel in Kernel::ALL {
                let mut lesson = Superposition::default();
                (lesson.key.bone, lesson.key.kernel) = (bone, kernel);
                let file = rats::File {
                    name: String::from("main.rat"),
                    text: lesson.text(),
                };
                let compiled = rats::compile(&rats::Project { files: vec![file] });
                assert_eq!(compiled.diagnostics, [], "{bone:?} {kernel:?}");
                let field = compiled.scene.soft_surfaces().swap_remove(0).sum;
                let [whole, one, other] = [0, 1, 2].map(|i| field.primitives[i].skeleton.measure());
                assert!((one + other - whole).abs() < 1e-3, "{bone:?} {kernel:?}");
                assert!(
                    (one / whole - lesson.key.cut).abs() < 0.2,
                    "{bone:?} {kernel:?}"
                );
            }
        }
    }

    #[test]
    fn the_cut_is_where_the_grip_is() {
        for bone in [Bone::Segment, Bone::Arc] {
            let key = Key {
                bone,
                ..Superposition::default().key
            };
            for share in [0.05, 0.3, 0.9] {
                let place = key.place(share);
                assert!((key.share(place.truncate().into()) - share).abs() < 1e-12);
                let ends = key.part(0.0, share);
                // The part ends there.
                assert!(ends.distance(place) < 1e-12);
                assert!(key.part(share, 1.0).distance(place) < 1e-12);
            }
        }
    }
}
