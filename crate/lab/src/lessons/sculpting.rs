//! Lesson 10: sculpting by strokes: a dog step by step, decay functions, and subdivision with and
//! without propagation (figures 4, 1 and 2 of Bill and Lodha 1995).

use crate::bench::Bench;
use crate::command::Command;
use crate::figure::{Figure, Words};
use crate::tools::{Stage, choice, heading, reading, remark, slider};
use egui::{
    Align2, Color32, ColorImage, FontId, Pos2, Rect, Sense, TextureHandle, TextureOptions, Ui,
    pos2, vec2,
};
use glam::{DVec3, Vec3};
use modeling::{Document, surface_of};
use sculpt::{Clay, Decay, Script};
use viewport::{Frame, Look, Surface, View};
use widgets::{places, theme};

/// The strokes of the dog.
const DOG: &str = include_str!("../../../../www/examples/dog.strokes");

/// Figure of the lesson.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Subject {
    Stages,
    Decays,
    Subdivision,
}

/// The words of the lesson.
pub static WORDS: Words = Words {
    link: "sculpting",
    title: "Sculpting by strokes",
    name: "Sculpting by strokes",
    short: "Sculpting",
    about: "a dog from a box, stroke by stroke",
    sentences: "A virtual tool touches a mesh and pushes or pulls the vertices that it meets, and \
                their neighbours follow as a decay function says. Where detail is wanted, a \
                region is selected, subdivided and smoothed. Each stroke is a line of a text, so \
                the whole animal can be made again, step by step.",
};

/// The lesson's state.
pub struct Sculpting {
    figure: Subject,
    /// The dog, once it was asked for.
    dog: Option<Document>,
    lines: Vec<String>,
    step: f64,
    range: f64,
    radius: f64,
    levels: f64,
    view: View,
    panes: Vec<Pane>,
}

impl Default for Sculpting {
    fn default() -> Self {
        let mut view = View::around([DVec3::new(-1.5, -0.7, -1.3), DVec3::new(1.9, 0.7, 1.2)]);
        view.look_from(DVec3::new(0.55, -0.8, 0.3), DVec3::Z);
        Self {
            figure: Subject::Stages,
            dog: None,
            lines: Vec::new(),
            step: 0.0,
            range: 0.7,
            radius: 0.15,
            levels: 1.0,
            view,
            panes: Vec::new(),
        }
    }
}

impl Figure for Sculpting {
    fn show(&mut self, ui: &mut Ui, bench: &mut Bench<'_>) {
        let mut stage = Stage::new(ui, bench.narrow, bench.height.clamp(360.0, 640.0), 0.9);
        let controls = &mut stage.controls;
        choice(
            controls,
            &mut self.figure,
            &[
                (Subject::Stages, "A dog in six stages"),
                (Subject::Decays, "Decays"),
                (Subject::Subdivision, "Subdivision"),
            ],
        );
        match self.figure {
            Subject::Stages => self.stages(ui, &mut stage, bench),
            Subject::Decays => self.decays(ui, &mut stage, bench),
            Subject::Subdivision => self.subdivision(ui, &mut stage, bench),
        }
        stage.finish(ui);
    }

    /// The dog is an example of the gallery.
    fn dataset(&self) -> Command {
        Command::OpenExample { file: "dog.rat" }
    }
}

/// Drawing, with all that it depends on.
#[derive(Default)]
struct Pane {
    key: Option<String>,
    surface: Surface,
    drawn: Option<(View, [usize; 2], bool)>,
    texture: Option<TextureHandle>,
}

impl Pane {
    /// Draws the mesh into a rectangle.
    fn show(&mut self, ui: &Ui, rect: Rect, view: &View, wireframe: bool) {
        let scale = ui.ctx().pixels_per_point();
        let size =
            [rect.width(), rect.height()].map(|side| ((side * scale) as usize).clamp(1, 1400));
        let wanted = (*view, size, wireframe);
        if self.drawn != Some(wanted) || self.texture.is_none() {
            let mut frame = Frame::new(size);
            let dark = ui.visuals().dark_mode;
            let look = Look {
                light: Vec3::new(0.35, -0.65, 0.75),
                wireframe,
                background: if dark {
                    [0.10, 0.112, 0.135]
                } else {
                    [0.80, 0.815, 0.83]
                },
                accent: [0.33, 0.68, 0.98],
                ..Look::default()
            };
            frame.draw(view, &self.surface, &look);
            let image = ColorImage::from_rgba_unmultiplied(size, frame.rgba());
            match &mut self.texture {
                Some(texture) => texture.set(image, TextureOptions::LINEAR),
                None => {
                    let texture = ui.ctx().load_texture("clay", image, TextureOptions::LINEAR);
                    self.texture = Some(texture);
                }
            }
            self.drawn = Some(wanted);
        }
        if let Some(texture) = &self.texture {
            let whole = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
            ui.painter()
                .image(texture.id(), rect, whole, Color32::WHITE);
        }
    }

    /// Makes the mesh of a text, unless it is there already.
    fn make(&mut self, text: &str) {
        if self.key.as_deref() == Some(text) {
            return;
        }
        self.key = Some(text.to_owned());
        self.drawn = None;
        if let Some(clay) = clay_of(text) {
            self.surface = surface_of(&clay);
        }
    }
}

/// Most vertices that the strokes of a figure may visit.
const MOST_WORK: u64 = 20_000_000;

/// Finds no mesh file, as the lesson has none.
fn no_file(name: &str) -> Result<mesh::TriangleMesh, String> {
    Err(format!("there is no {name}"))
}

/// Carries out the strokes of a text; `None` if that cannot be done.
fn clay_of(text: &str) -> Option<Clay> {
    let script: Script = text.parse().ok()?;
    sculpt::replay(&script, &mut no_file, MOST_WORK, |_, _, _| ()).ok()
}

/// Writes a plane with a bump of one decay function.
fn bump(decay: Decay, radius: f64, range: f64) -> String {
    format!(
        "strokes 1\nstart plane 28\n\
         pull sphere {radius:.3} {radius:.3} {radius:.3} {} {range:.3} : 0 0 0, 0 0 0.9\n",
        decay.name()
    )
}

/// Writes a plane whose middle is divided.
fn subdivide(how: &str, levels: usize) -> String {
    let mut text =
        String::from("strokes 1\nstart plane 6\nregion sphere 0.3 0.3 0.3 : 0.1 0.1 0\n");
    for _ in 0..levels {
        text += &format!("refine {how}\n");
    }
    text
}

impl Sculpting {
    /// Returns the drawing with this number, a new one if need be.
    fn pane(&mut self, index: usize) -> &mut Pane {
        if self.panes.len() <= index {
            self.panes.resize_with(index + 1, Pane::default);
        }
        &mut self.panes[index]
    }

    /// Turns the view by dragging in the figure.
    fn turn(&mut self, ui: &Ui, rect: Rect) {
        let response = ui.interact(rect, ui.scope_id().with("clay"), Sense::drag());
        if response.dragged()
            && let Some(at) = response.interact_pointer_pos()
        {
            let half = 0.5 * rect.size().min_elem().max(1.0);
            let [from, to] = [at - response.drag_delta(), at].map(|at| {
                let p = (at - rect.center()) / half;
                [f64::from(p.x), -f64::from(p.y)]
            });
            self.view.turn(from, to);
        }
    }

    /// Draws the dog at a stroke.
    fn stages(&mut self, ui: &mut Ui, stage: &mut Stage, bench: &mut Bench<'_>) {
        if self.dog.is_none() {
            self.dog = Document::open(DOG, &mut no_file).ok();
            let lines = DOG
                .lines()
                .map(|line| line.split('#').next().unwrap_or_default().trim());
            let lines = lines.filter(|line| !line.is_empty()).skip(1);
            self.lines = lines.map(str::to_owned).collect();
            self.step = self.lines.len().saturating_sub(1) as f64;
        }
        let Some(dog) = &mut self.dog else { return };
        let count = self.lines.len().saturating_sub(1);
        let controls = &mut stage.controls;
        heading(controls, "Stages");
        let mut chosen = usize::MAX;
        let lines = (0_usize..).zip(&self.lines);
        let stages: Vec<(usize, &str)> = lines
            .filter_map(|(at, line)| Some((at, line.strip_prefix("stage ")?)))
            .collect();
        if choice(controls, &mut chosen, &stages) {
            self.step = chosen as f64;
        }
        slider(controls, "stroke", &mut self.step, 0.0..=count as f64, "");
        self.step = self.step.round();
        controls.horizontal(|ui| {
            for (name, way) in [("‹ back", -1.0), ("next ›", 1.0)] {
                let button = ui.button(name);
                places::note(ui.ctx(), format!("lab {name}"), button.rect);
                if button.clicked() {
                    self.step = (self.step + way).clamp(0.0, count as f64);
                }
            }
        });
        let at = self.step as usize;
        // A stroke that was carried out once can be again.
        let _ = dog.go_to(at);
        let palette = theme::palette(controls.visuals());
        let line = self.lines.get(at).map_or("", String::as_str);
        controls.label(
            egui::RichText::new(line)
                .monospace()
                .size(12.5)
                .color(palette.command),
        );
        let mesh = dog.clay().mesh();
        let counts = [mesh.vertex_count(), mesh.face_count()];
        reading(controls, "vertices", &counts[0].to_string(), palette.strong);
        reading(controls, "faces", &counts[1].to_string(), palette.strong);
        remark(
            controls,
            "Drag in the figure to turn it. The same text is in the gallery, where you can go on \
             with it in Sculpt.",
        );
        bench.readings.insert("stroke", at as f64);
        bench.readings.insert("vertices", counts[0] as f64);
        bench.readings.insert("faces", counts[1] as f64);
        let key = format!("dog {at}");
        let surface = (self
            .panes
            .first()
            .is_none_or(|pane| pane.key.as_ref() != Some(&key)))
        .then(|| surface_of(dog.clay()));
        let rect = stage.figure;
        self.turn(ui, rect);
        let view = self.view;
        let pane = self.pane(0);
        if let Some(surface) = surface {
            pane.surface = surface;
            pane.key = Some(key);
            pane.drawn = None;
        }
        pane.show(ui, rect, &view, true);
    }

    /// Draws bumps of all decay functions.
    fn decays(&mut self, ui: &mut Ui, stage: &mut Stage, bench: &mut Bench<'_>) {
        let controls = &mut stage.controls;
        slider(controls, "range", &mut self.range, 0.1..=1.0, "");
        slider(
            controls,
            "radius of the tool",
            &mut self.radius,
            0.05..=0.4,
            "",
        );
        remark(
            controls,
            "A ball pulls up the middle of a plane. Vertices \
             within the range, measured along edges, \
             follow by the share that the decay function gives; t is their distance divided by the \
             range.",
        );
        for (name, formula) in [
            ("goo", "(1 − t⁴)²"),
            ("bell", "(1 + cos πt)/2"),
            ("cusp", "(1 − t)²"),
            ("cone", "1 − t"),
            ("flat", "1"),
        ] {
            let palette = theme::palette(controls.visuals());
            reading(controls, name, formula, palette.strong);
        }
        bench.readings.insert("range", self.range);
        let palette = theme::palette(ui.visuals());
        let columns = if bench.narrow { 2 } else { 3 };
        let rows = Decay::ALL.len().div_ceil(columns);
        let mut view = View::around([DVec3::new(-1.0, -1.0, -0.3), DVec3::new(1.0, 1.0, 0.9)]);
        view.look_from(DVec3::new(0.35, -0.9, 0.42), DVec3::Z);
        view.zoom(1.25);
        for (i, decay) in Decay::ALL.into_iter().enumerate() {
            let rect = cell(stage.figure, i, columns, rows);
            let text = bump(decay, self.radius, self.range);
            let pane = self.pane(1 + i);
            pane.make(&text);
            pane.show(ui, rect, &view, true);
            let font = FontId::proportional(14.0);
            let at = rect.left_top() + vec2(8.0, 6.0);
            ui.painter()
                .text(at, Align2::LEFT_TOP, decay.name(), font, palette.strong);
        }
    }

    /// Draws a plane divided with propagation and without.
    fn subdivision(&mut self, ui: &mut Ui, stage: &mut Stage, bench: &mut Bench<'_>) {
        let controls = &mut stage.controls;
        slider(controls, "times", &mut self.levels, 1.0..=3.0, "");
        self.levels = self.levels.round();
        remark(
            controls,
            "The blue faces are the region. With propagation \
             the faces beside it are divided, too, so \
             that all stay triangles; without, each gains vertices and stays one face.",
        );
        let palette = theme::palette(ui.visuals());
        let columns = if bench.narrow { 1 } else { 2 };
        let rows = 2 / columns;
        let mut view = View::around([DVec3::new(-1.0, -1.0, 0.0), DVec3::new(1.0, 1.0, 0.0)]);
        view.look_from(DVec3::Z, DVec3::Y);
        view.zoom(1.35);
        let levels = self.levels as usize;
        for (i, (how, name)) in [("propagate", "with propagation"), ("local", "without")]
            .into_iter()
            .enumerate()
        {
            let rect = cell(stage.figure, i, columns, rows);
            let pane = self.pane(10 + i);
            let text = subdivide(how, levels);
            pane.make(&text);
            pane.show(ui, rect, &view, true);
            let font = FontId::proportional(14.0);
            let at = rect.left_top() + vec2(8.0, 6.0);
            ui.painter()
                .text(at, Align2::LEFT_TOP, name, font, palette.strong);
            if let Some(clay) = clay_of(&text) {
                let faces = clay.mesh().face_count();
                reading(
                    &mut stage.controls,
                    &format!("faces {name}"),
                    &faces.to_string(),
                    palette.strong,
                );
                let name = if i == 0 { "propagated" } else { "local" };
                bench.readings.insert(name, faces as f64);
            }
        }
    }
}

/// Returns a cell of a table in a figure.
fn cell(all: Rect, index: usize, columns: usize, rows: usize) -> Rect {
    let gap = 8.0;
    let size = vec2(
        (all.width() - gap * (columns - 1) as f32) / columns as f32,
        (all.height() - gap * (rows - 1) as f32) / rows as f32,
    );
    let (column, row) = ((index % columns) as f32, (index / columns) as f32);
    let at = all.min + vec2(column * (size.x + gap), row * (size.y + gap));
    Rect::from_min_size(at, size)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    #[test]
    fn figures_are_made_by_strokes() {
        let dog = clay_of(DOG).expect("the dog");
        assert!(dog.mesh().is_closed());
        for decay in Decay::ALL {
            let clay = clay_of(&bump(decay, 0.15, 0.7)).expect("a bump");
            let mesh = clay.mesh();
            let [middle, beside] = [DVec2::ZERO, DVec2::new(0.97, 0.0)].map(|at| {
                let nearest = mesh.vertices().min_by(|a, b| {
                    let [a, b] = [a, b].map(|v| mesh.position(*v).truncate().distance(at));
                    a.total_cmp(&b)
                });
                nearest.map_or(0.0, |v| mesh.position(v).z)
            });
            assert!((middle - 0.9).abs() < 1e-12);
            assert_eq!(beside, 0.0, "{}", decay.name());
        }
        // Beside the region, propagation makes triangles where there would be polygons without it.
        let [with, without] = ["propagate", "local"].map(|how| {
            let clay = clay_of(&subdivide(how, 1)).expect("a plane");
            let mesh = clay.mesh();
            let polygons = mesh.faces().filter(|f| mesh.face_degree(*f) > 3).count();
            (mesh.face_count(), polygons)
        });
        assert!(
            with.0 > without.0 && with.1 == 0 && without.1 > 0,
            "{with:?} {without:?}"
        );
    }
}
