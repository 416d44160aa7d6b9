//! Lesson 13: what a file of centrelines and radii says, as capsules, and the smooth surface around
//! the same limbs.

use crate::bench::Bench;
use crate::command::Command;
use crate::figure::{Figure, Words};
use crate::plane::Plane;
use crate::plot::{self, number};
use crate::sample::{self, Window};
use crate::tools::{self, Stage, heading, reading, remark, slider};
use egui::{Color32, CursorIcon, Rect, Stroke, Ui, pos2};
use field::{Kernel, Primitive, Skeleton, Sum, THRESHOLD};
use glam::DVec3;
use picture::contour::Grid;
use widgets::theme;

/// Samples of the fields, columns and rows.
const SAMPLES: [usize; 2] = [121, 91];
/// The part of the plane that is shown, from the middle.
const HALF: [f64; 2] = [4.0, 3.0];
/// Names of the nodes; the second is where the limbs meet.
const NAMES: [&str; 4] = ["INLET", "FORK", "LEFT", "RIGHT"];
/// Index of the node where the limbs meet.
const FORK: usize = 1;
/// Limbs: the nodes at their ends, and their radii as shares of the trunk's, which obey Murray's
/// law, 1 = 0.83³ + 0.754³.
const LIMBS: [([usize; 2], f64); 3] = [([0, 1], 1.0), ([1, 2], 0.83), ([1, 3], 0.754)];

/// The words of the lesson.
pub static WORDS: Words = Words {
    link: "centreline",
    title: "From centreline to surface",
    name: "Centrelines",
    short: "Centrelines",
    about: "what a file of limbs and radii becomes",
    sentences: "Scanners and tracing programs give a vessel, a neuron or a tree as lines with \
                radii, and the plainest surface around them is one of capsules, dashed here, with \
                a crease at each fork. The convolution of the same lines is smooth, and stands at \
                the file's radius along a limb where the kernel falls steeply. A soft kernel \
                swells where limbs meet and thins what is short, so a file's limbs are drawn with \
                a steep one unless a text says otherwise.",
};

/// Inputs of the fields.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Key {
    nodes: [[f64; 2]; 4],
    kernel: Kernel,
    radius: f64,
    blobbiness: f64,
}

/// The lesson's state.
pub struct Centreline {
    key: Key,
    computed: Option<(Key, Surfaces)>,
}

impl Default for Centreline {
    fn default() -> Self {
        Self {
            key: Key {
                nodes: [[-3.2, 0.0], [-0.2, 0.0], [2.9, 1.7], [2.6, -1.9]],
                kernel: Kernel::Compact6,
                radius: 0.45,
                blobbiness: 8.0,
            },
            computed: None,
        }
    }
}

/// Outlines and measures.
struct Surfaces {
    smooth: Vec<[[f32; 2]; 2]>,
    inside: Vec<Vec<[f32; 2]>>,
    capsules: Vec<[[f32; 2]; 2]>,
    /// Radius at the middle of each limb over that of the file.
    middles: [f64; 3],
    /// Thickness at the fork over that of the capsules, across the trunk.
    fork: f64,
}

impl Figure for Centreline {
    fn show(&mut self, ui: &mut Ui, bench: &mut Bench<'_>) {
        let key = self.key;
        tools::renew(&mut self.computed, key, Key::compute);
        let mut stage = Stage::new(ui, bench.narrow, bench.height, 0.8);
        let palette = theme::palette(ui.visuals());
        plot::panel(ui, stage.figure);
        let map = Plane::new(stage.figure.shrink(8.0), HALF, SAMPLES);
        if let Some((_, surfaces)) = &self.computed {
            draw(ui, stage.figure, &map, surfaces, &key);
        }
        for (name, node) in NAMES.into_iter().zip(&mut self.key.nodes) {
            let grip = plot::grip(ui, name, map.at(*node), palette.accent, CursorIcon::Grab);
            if let (true, Some(pointer)) = (grip.dragged(), grip.interact_pointer_pos()) {
                *node = map.world(pointer);
                for (x, half) in node.iter_mut().zip(HALF) {
                    *x = x.clamp(0.05 - half, half - 0.05);
                }
            }
        }
        let controls = &mut stage.controls;
        let (radius, blobbiness) = (&mut self.key.radius, &mut self.key.blobbiness);
        slider(controls, "Radius of the trunk", radius, 0.15..=0.8, "");
        slider(controls, "Blobbiness |B|", blobbiness, 0.5..=16.0, "");
        heading(controls, "Kernel");
        if let Some(kernel) = tools::kernels(controls, |kernel| kernel == key.kernel) {
            self.key.kernel = kernel;
        }
        if let Some((_, surfaces)) = &self.computed {
            heading(
                controls,
                "Radius at the middle of a limb ÷ that of the file",
            );
            for (name, ratio) in ["Trunk", "Left", "Right"].into_iter().zip(surfaces.middles) {
                reading(controls, name, &format!("{ratio:.3}"), palette.note);
            }
            heading(controls, "Thickness at the fork ÷ that of the capsules");
            reading(
                controls,
                "Fork",
                &format!("{:.3}", surfaces.fork),
                palette.accent,
            );
            remark(
                controls,
                "Drag the nodes. Dashed: the capsules that the file describes.",
            );
            let readings = &mut bench.readings;
            readings.insert("middle", surfaces.middles[0]);
            readings.insert("fork", surfaces.fork);
            readings.insert("inlet", key.nodes[0][0]);
        }
        stage.finish(ui);
    }

    fn dataset(&self) -> Command {
        Command::open("Centreline", self.text())
    }
}

impl Key {
    /// Returns a node's place in space.
    fn place(&self, node: usize) -> DVec3 {
        DVec3::new(self.nodes[node][0], self.nodes[node][1], 0.0)
    }

    /// Returns the field of all limbs.
    fn field(&self) -> Sum {
        let limbs = LIMBS.iter().filter_map(|(ends, share)| {
            let [base, apex] = ends.map(|node| self.place(node));
            let shaping = sample::shaping(self.kernel, self.radius * share, self.blobbiness);
            Primitive::new(Skeleton::Segment { base, apex }, &shaping, None)
        });
        limbs.collect()
    }

    /// Computes how deep a place is within the capsules, below 0 outside.
    fn depth(&self, place: DVec3) -> f64 {
        let depths = LIMBS.iter().map(|(ends, share)| {
            let [base, apex] = ends.map(|node| self.place(node));
            let limb = Skeleton::Segment { base, apex };
            self.radius * share - limb.distance(place)
        });
        depths.fold(f64::NEG_INFINITY, f64::max)
    }

    /// Computes outlines and measures.
    fn compute(&self) -> Surfaces {
        let field = self.field();
        let window = Window {
            corner: DVec3::new(-HALF[0], -HALF[1], 0.0),
            across: DVec3::X * (2.0 * HALF[0]),
            up: DVec3::Y * (2.0 * HALF[1]),
        };
        let [width, height] = SAMPLES;
        let smooth = sample::whole(&field, &window, width, height);
        let depths = (0..width * height).map(|i| {
            let x = (i % width) as f64 / (width - 1) as f64;
            let y = (i / width) as f64 / (height - 1) as f64;
            self.depth(window.at(x, y)) as f32
        });
        let capsules = Grid {
            width,
            height,
            values: depths.collect(),
        };
        let middles = LIMBS.map(|(ends, share)| {
            let [base, apex] = ends.map(|node| self.place(node));
            // Out of the plane, where no other limb is.
            reach(0.5 * (base + apex), DVec3::Z, |place| {
                is_inside(&field, place)
            }) / (self.radius * share)
        });
        let fork = self.place(FORK);
        let exact = reach(fork, DVec3::Z, |place| self.depth(place) > 0.0);
        let level = THRESHOLD as f32;
        Surfaces {
            inside: smooth.inside(level),
            smooth: smooth.line(level),
            capsules: capsules.line(0.0),
            middles,
            fork: reach(fork, DVec3::Z, |place| is_inside(&field, place)) / exact.max(1e-9),
        }
    }
}

/// Whether a place is within a field's surface.
fn is_inside(field: &Sum, place: DVec3) -> bool {
    sample::one(&[field], place) > THRESHOLD
}

/// Finds the distance from a place at which one leaves a solid, by bisection; 0 outside.
fn reach(from: DVec3, way: DVec3, holds: impl Fn(DVec3) -> bool) -> f64 {
    if !holds(from) {
        return 0.0;
    }
    let (mut low, mut high) = (0.0, 20.0);
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        match holds(from + way * middle) {
            true => low = middle,
            false => high = middle,
        }
    }
    low
}

impl Centreline {
    /// Writes the limbs as a dataset: a skeleton of nodes with radii, as `sinew skeleton` writes a
    /// file.
    fn text(&self) -> String {
        let key = self.key;
        let mut text = format!(
            "# Three limbs that meet: the block form of what a file of centrelines holds.\n\
             # From the lab, lesson 13. Drag the nodes.\n\n\
             eyep 0 0 12\nvrp 0 0 0\nvup 0 1 0\nfov 34\nframesize 640 480\nsample 3\n\
             light White point, position 4 6 8, intensity 0.9\n\
             light SlateBlue point, position -6 -1 4, intensity 0.5, noshadow\n\n\
             var softness = {:.3} hot -16 -0.5   # blobbiness\n\
             surface vessel, diffuse 0.75 0.18 0.15, specular 0.5 0.5 0.5, shine 40, \
             blobbiness softness, kernel {}\n\n",
            -key.blobbiness,
            key.kernel.name(),
        );
        // Each limb keeps its radius up to the fork.
        for ([a, b], share) in LIMBS {
            let name = NAMES[if a == FORK { b } else { a }];
            text.push_str(&format!("skeleton vessel, {name}_LIMB subdivide 0 {{\n"));
            for node in [a, b] {
                let [x, y] = key.nodes[node];
                text.push_str(&format!(
                    "  node {} <{x:.3} {y:.3} 0> radius {:.4}\n",
                    NAMES[node],
                    key.radius * share
                ));
            }
            text.push_str(&format!("  curve {} {}\n}}\n", NAMES[a], NAMES[b]));
        }
        text
    }
}

/// Draws the flesh, its outline, the capsules in dashes, and the limbs.
fn draw(ui: &Ui, place: Rect, map: &Plane, surfaces: &Surfaces, key: &Key) {
    let palette = theme::palette(ui.visuals());
    let painter = ui.painter_at(place.shrink(1.0));
    let tint: Color32 = palette.note.gamma_multiply(0.2);
    map.fill(&painter, &surfaces.inside, tint);
    for piece in &surfaces.smooth {
        let stroke = Stroke::new(2.5, palette.note);
        painter.line_segment(piece.map(|p| map.sample(p)), stroke);
    }
    // Every other piece: dashes.
    for piece in surfaces.capsules.iter().step_by(2) {
        let stroke = Stroke::new(1.2, palette.strong);
        painter.line_segment(piece.map(|p| map.sample(p)), stroke);
    }
    for (ends, share) in LIMBS {
        let [a, b] = ends.map(|node| map.at(key.nodes[node]));
        painter.line_segment([a, b], Stroke::new(3.0, palette.text));
        let text = format!("r {}", number(key.radius * share));
        let at = pos2(0.5 * (a.x + b.x), 0.5 * (a.y + b.y) - 12.0);
        let font = egui::FontId::proportional(12.0);
        painter.text(at, egui::Align2::CENTER_CENTER, text, font, palette.weak);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limbs_stand_at_their_radii_with_a_steep_kernel_and_swell_with_a_soft_one() {
        let steep = Centreline::default().key;
        let surfaces = steep.compute();
        for ratio in surfaces.middles {
            assert!((ratio - 1.0).abs() < 1e-3, "{ratio}");
        }
        assert!((0.9..1.25).contains(&surfaces.fork), "{}", surfaces.fork);
        let soft = Key {
            kernel: Kernel::Cauchy,
            blobbiness: 1.0,
            ..steep
        };
        let swollen = soft.compute().fork;
        assert!(swollen > surfaces.fork + 0.05, "{swollen}");
    }

    #[test]
    fn dataset_has_the_same_limbs() {
        for kernel in Kernel::ALL {
            let mut lesson = Centreline::default();
            lesson.key.kernel = kernel;
            let file = rats::File {
                name: String::from("main.rat"),
                text: lesson.text(),
            };
            let compiled = rats::compile(&rats::Project { files: vec![file] });
            assert_eq!(compiled.diagnostics, [], "{kernel:?}");
            let field = compiled.scene.soft_surfaces().swap_remove(0).sum;
            assert_eq!(field.primitives.len(), 3);
            let own = lesson.key.field();
            for place in [DVec3::new(-1.0, 0.3, 0.2), DVec3::new(1.0, 1.0, 0.4)] {
                let [a, b] = [&field, &own].map(|field| sample::one(&[field], place));
                assert!((a - b).abs() < 2e-2 * a.max(1.0), "{kernel:?} {a} {b}");
            }
        }
    }

    #[test]
    fn murrays_law_holds() {
        let cubes = LIMBS.map(|(_, share)| share * share * share);
        assert!((cubes[0] - cubes[1] - cubes[2]).abs() < 1e-3);
    }
}
