//! Lesson 3: the field of the open dataset on a movable plane.
//!
//! The field is sampled coarsely at once and then ever more finely, a few milliseconds in each
//! frame, so that nothing stutters however large the dataset is.

use crate::bench::Bench;
use crate::command::Command;
use crate::dataset::Dataset;
use crate::figure::{Figure, Words};
use crate::plot::{self, number};
use crate::sample::{self, Filling, Window};
use crate::tools::{Stage, choice, heading, reading, remark, slider};
use egui::{
    Align2, Color32, ColorImage, FontId, Pos2, Rect, Sense, Stroke, TextureHandle, TextureOptions,
    Ui, pos2, vec2,
};
use field::{Implicit, THRESHOLD};
use glam::DVec3;
use scene::{Scene, Surface};
use widgets::theme;

/// Samples across, from the first look to the last.
const LEVELS: [usize; 5] = [24, 48, 96, 192, 320];
/// Least and most seconds of sampling in one frame.
const BUDGET: [f64; 2] = [0.006, 0.05];
/// Share of a frame for sampling: where drawing takes long anyway, a little more is not felt.
const SHARE: f64 = 0.4;
/// Values of the thin lines.
const LINES: [f32; 6] = [0.1, 0.25, 0.5, 2.0, 4.0, 8.0];

/// Direction that the plane faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Axis {
    X,
    Y,
    Z,
    Camera,
}

/// Piece of a line.
type Piece = [[f32; 2]; 2];

/// Key of a sampled slice.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Cut {
    generation: u64,
    window: Window,
    /// Height over width.
    tall: f64,
}

/// Functions of a scene's bodies, and where these are.
struct Subject {
    generation: u64,
    bodies: Vec<Surface>,
    center: DVec3,
    reach: f64,
}

impl Subject {
    fn functions(&self) -> Vec<&dyn Implicit> {
        self.bodies.iter().map(Surface::function).collect()
    }
}

/// The words of the lesson.
pub static WORDS: Words = Words {
    link: "slice",
    title: "A slice through the field",
    name: "A slice of the field",
    short: "Slice",
    about: "your dataset, seen from inside",
    sentences: "Here is the field of the dataset in your editor, cut by a plane. The surface that \
                the picture shows is one of these lines, F = T, and the other lines show where it \
                would be with another threshold. Move the plane and point at a place to read the \
                field there.",
};

/// The lesson's state.
pub struct Slice {
    axis: Axis,
    /// Distance of the plane from the middle as a fraction of the reach.
    offset: f64,
    zoom: f64,
    subject: Option<Subject>,
    cut: Option<Cut>,
    level: usize,
    filling: Filling,
    /// Content of the screen: the colours, and the lines in fractions of the window.
    texture: Option<TextureHandle>,
    surface: Vec<Piece>,
    lines: Vec<Piece>,
    width: usize,
}

impl Default for Slice {
    fn default() -> Self {
        Self {
            axis: Axis::Camera,
            offset: 0.0,
            zoom: 1.0,
            subject: None,
            cut: None,
            level: 0,
            filling: Filling::default(),
            texture: None,
            surface: Vec::new(),
            lines: Vec::new(),
            width: 0,
        }
    }
}

impl Figure for Slice {
    fn show(&mut self, ui: &mut Ui, bench: &mut Bench<'_>) {
        self.look(bench.dataset);
        let mut stage = Stage::new(ui, bench.narrow, bench.height, 0.95);
        let subject = self.subject.as_ref();
        let soft = subject.map_or(0, |subject| elements_of(&subject.bodies));
        bench.readings.insert("primitives", soft as f64);
        if soft == 0 {
            nothing(ui, &stage, bench);
            stage.finish(ui);
            return;
        }
        let place = stage.figure;
        let tall = f64::from(place.height() / place.width().max(1.0));
        // Samples are square, and their number does not change with every pixel of the window.
        let tall = (tall * 40.0).round().max(1.0) / 40.0;
        if let Some((window, _)) = self.window(bench.dataset, tall) {
            let generation = bench.dataset.generation;
            self.work(
                ui,
                Cut {
                    generation,
                    window,
                    tall,
                },
            );
            self.picture(ui, place, window, bench);
        }
        let controls = &mut stage.controls;
        heading(controls, "The plane faces");
        choice(
            controls,
            &mut self.axis,
            &[
                (Axis::Camera, "the camera"),
                (Axis::X, "x"),
                (Axis::Y, "y"),
                (Axis::Z, "z"),
            ],
        );
        slider(
            controls,
            "Where it stands",
            &mut self.offset,
            -1.0..=1.0,
            "",
        );
        slider(controls, "Nearer", &mut self.zoom, 1.0..=6.0, "×");
        controls.add_space(4.0);
        legend(controls);
        controls.add_space(6.0);
        if let Some(value) = bench.readings.get("value").copied() {
            let palette = theme::palette(controls.visuals());
            let inside = value > THRESHOLD;
            reading(
                controls,
                "Field here",
                &format!("F = {}", number(value)),
                palette.accent,
            );
            remark(
                controls,
                if inside {
                    "More than T: this place is inside the flesh."
                } else {
                    "Less than T: this place is outside."
                },
            );
        } else {
            remark(controls, "Point at the slice to read the field there.");
        }
        let text = format!(
            "{soft} soft primitive{} make this field.",
            if soft == 1 { "" } else { "s" }
        );
        remark(controls, text);
        let readings = &mut bench.readings;
        readings.insert("offset", self.offset);
        readings.insert(
            "samples",
            if self.level == 0 {
                0.0
            } else {
                self.width as f64
            },
        );
        readings.insert("finished", f64::from(u8::from(self.level == LEVELS.len())));
        stage.finish(ui);
    }

    fn dataset(&self) -> Command {
        Command::open("Slice", self.text())
    }
}

impl Slice {
    /// Looks at the scene again if it has changed.
    fn look(&mut self, dataset: Dataset<'_>) {
        let generation = dataset.generation;
        let known = self.subject.as_ref().map(|subject| subject.generation);
        if known == Some(generation) {
            return;
        }
        let (bodies, (center, reach)) = dataset.scene.map_or_else(
            || (Vec::new(), (DVec3::ZERO, 2.0)),
            |scene| {
                let bodies = scene.surfaces();
                let place = extent(scene, &bodies);
                let place = frame(&bodies, place).unwrap_or(place);
                (bodies, place)
            },
        );
        self.subject = Some(Subject {
            generation,
            bodies,
            center,
            reach,
        });
    }

    /// Returns the plane's window and normal.
    fn window(&self, dataset: Dataset<'_>, tall: f64) -> Option<(Window, DVec3)> {
        let subject = self.subject.as_ref()?;
        let (right, up, normal) = match self.axis {
            Axis::X => (DVec3::NEG_Z, DVec3::Y, DVec3::X),
            Axis::Y => (DVec3::X, DVec3::NEG_Z, DVec3::Y),
            Axis::Z => (DVec3::X, DVec3::Y, DVec3::Z),
            Axis::Camera => {
                let view = dataset.camera.projection(4, 3).world_from_view;
                (view.x_axis, view.y_axis, view.z_axis)
            }
        };
        // Both the whole width and the whole height of the scene are seen.
        let half = subject.reach / self.zoom / tall.min(1.0);
        let across = right * (2.0 * half);
        let up = up * (2.0 * half * tall);
        let middle = subject.center + normal * (self.offset * subject.reach);
        let corner = middle - across / 2.0 - up / 2.0;
        Some((Window { corner, across, up }, normal))
    }

    /// Goes on sampling for a while.
    fn work(&mut self, ui: &Ui, cut: Cut) {
        if self.cut != Some(cut) {
            self.cut = Some(cut);
            self.level = 0;
            self.filling = grid(0, cut.tall);
        }
        let Some(subject) = &self.subject else { return };
        let functions = subject.functions();
        let elements = elements_of(&subject.bodies);
        let begun = pool::clock::stopwatch();
        let frame = f64::from(ui.input(|input| input.unstable_dt));
        let budget = (SHARE * frame).clamp(BUDGET[0], BUDGET[1]);
        while self.level < LEVELS.len() {
            let is_full = self.filling.go_on(&functions, elements, &cut.window, || {
                pool::clock::stopwatch() - begun > budget
            });
            if !is_full {
                break;
            }
            let Filling {
                grid: grid_done,
                leading,
            } = core::mem::take(&mut self.filling);
            let scale = [grid_done.width - 1, grid_done.height - 1].map(|n| n as f32);
            let share = |piece: Piece| piece.map(|[x, y]| [x / scale[0], y / scale[1]]);
            let surface = grid_done.line(THRESHOLD as f32).into_iter();
            // Bodies in contact share a sheet, which is one line.
            let sheets = grid_done.border(&leading, THRESHOLD as f32);
            self.surface = surface.chain(sheets).map(share).collect();
            // Thin lines need fewer pieces than the finest grid would give.
            if self.level + 1 < LEVELS.len() {
                let lines = LINES.iter().flat_map(|level| grid_done.line(*level));
                self.lines = lines.map(share).collect();
            }
            let dark = ui.visuals().dark_mode;
            let rows = grid_done.values.chunks_exact(grid_done.width).rev();
            let pixels = rows
                .flatten()
                .map(|value| colour(*value, dark))
                .collect::<Vec<_>>();
            let image = ColorImage::new([grid_done.width, grid_done.height], pixels);
            self.width = grid_done.width;
            match &mut self.texture {
                Some(texture) => texture.set(image, TextureOptions::LINEAR),
                None => {
                    let texture = ui
                        .ctx()
                        .load_texture("slice", image, TextureOptions::LINEAR);
                    self.texture = Some(texture);
                }
            }
            self.level += 1;
            if self.level < LEVELS.len() {
                self.filling = grid(self.level, cut.tall);
            }
            if pool::clock::stopwatch() - begun > budget {
                break;
            }
        }
        if self.level < LEVELS.len() {
            ui.ctx().request_repaint();
        }
    }

    /// Draws the slice, its lines, and the value under the pointer.
    fn picture(&mut self, ui: &Ui, place: Rect, window: Window, bench: &mut Bench<'_>) {
        let palette = theme::palette(ui.visuals());
        let painter = ui.painter_at(place);
        painter.rect_filled(place, 10.0, palette.paper);
        if let Some(texture) = &self.texture {
            let whole = Rect::from_min_max(Pos2::ZERO, Pos2::new(1.0, 1.0));
            let shape = egui::epaint::RectShape::filled(place, 10.0, Color32::WHITE);
            painter.add(shape.with_texture(texture.id(), whole));
        }
        let at = |[x, y]: [f32; 2]| {
            pos2(
                place.left() + x * place.width(),
                place.bottom() - y * place.height(),
            )
        };
        // Not transparent: where pieces meet, that would show.
        let thin = Stroke::new(1.0, Color32::from_rgb(176, 176, 196));
        for piece in &self.lines {
            painter.line_segment(piece.map(at), thin);
        }
        // Readable on dark and on bright colours alike.
        for stroke in [
            Stroke::new(5.0, Color32::from_black_alpha(150)),
            Stroke::new(2.5, Color32::WHITE),
        ] {
            for piece in &self.surface {
                painter.line_segment(piece.map(at), stroke);
            }
        }
        self.directions(&painter, place);
        let response = ui.interact(place, ui.scope_id().with("slice"), Sense::click_and_drag());
        response.widget_info(|| {
            egui::WidgetInfo::labeled(egui::Role::Image, true, "Slice through the field")
        });
        let pointer = response.hover_pos().or(response.interact_pointer_pos());
        let (Some(pointer), Some(subject)) = (pointer, &self.subject) else {
            return;
        };
        let x = f64::from((pointer.x - place.left()) / place.width());
        let y = f64::from((place.bottom() - pointer.y) / place.height());
        let value = sample::one(&subject.functions(), window.at(x, y));
        bench.readings.insert("value", value);
        let text = format!("F = {}", number(value));
        let font = FontId::proportional(14.0);
        let galley = painter.layout_no_wrap(text, font, Color32::WHITE);
        let side = if pointer.x + galley.size().x + 40.0 > place.right() {
            Align2::RIGHT_BOTTOM
        } else {
            Align2::LEFT_BOTTOM
        };
        let sign = if side == Align2::RIGHT_BOTTOM {
            -1.0
        } else {
            1.0
        };
        let near = pointer + vec2(sign * 16.0, -10.0);
        let near = pos2(near.x, near.y.max(place.top() + 34.0));
        let rect = side
            .anchor_size(near, galley.size())
            .expand2(vec2(9.0, 5.0));
        painter.rect_filled(rect, 8.0, Color32::from_black_alpha(190));
        painter.galley(rect.min + vec2(9.0, 5.0), galley, Color32::WHITE);
        painter.circle(
            pointer,
            4.0,
            Color32::WHITE,
            Stroke::new(1.5, Color32::BLACK),
        );
    }

    /// Draws the names of the directions in a corner.
    fn directions(&self, painter: &egui::Painter, place: Rect) {
        let (across, up) = match self.axis {
            Axis::X => ("−z", "y"),
            Axis::Y => ("x", "−z"),
            Axis::Z => ("x", "y"),
            Axis::Camera => return,
        };
        let at = place.left_bottom() + vec2(24.0, -24.0);
        let stroke = Stroke::new(1.5, Color32::WHITE);
        painter.arrow(at, vec2(34.0, 0.0), stroke);
        painter.arrow(at, vec2(0.0, -34.0), stroke);
        let font = FontId::proportional(13.0);
        let white = Color32::WHITE;
        painter.text(
            at + vec2(42.0, 0.0),
            Align2::LEFT_CENTER,
            across,
            font.clone(),
            white,
        );
        painter.text(
            at + vec2(0.0, -40.0),
            Align2::CENTER_BOTTOM,
            up,
            font,
            white,
        );
    }

    /// Writes three balls to cut, as a dataset.
    fn text(&self) -> String {
        String::from(
            "# Three balls and a bar. Go back to the lab, lesson 3, to see \
             their field from inside:\n\
             # the outline of the flesh is the line F = T.\n\n\
             eyep 0 0 9\nvrp 0 0 0\nvup 0 1 0\nfov 36\nframesize 640 480\nsample 3\n\
             light White point, position 4 6 8, intensity 0.9\n\
             light SlateBlue point, position -6 -1 4, intensity 0.5, noshadow\n\n\
             var blobbiness = -1.5 hot    # near 0: the balls run together\n\
             surface flesh, diffuse SummerSky, specular 0.5 0.5 0.5, shine \
             40, blobbiness blobbiness\n\n\
             sphere flesh 0.7, <-1.3  0.5 0>\n\
             sphere flesh 0.5, < 0.2  1.0 0>\n\
             sphere flesh 0.6, < 1.4 -0.2 0.4>\n\
             cylinder flesh 0.3, <-1.5 -1.1 0> <1.2 -1.2 0>\n",
        )
    }
}

/// Begins the grid of a level.
fn grid(level: usize, tall: f64) -> Filling {
    let width = LEVELS[level];
    Filling::new(width, (width as f64 * tall).round() as usize)
}

/// Returns the middle of all skeletons, and the largest distance along an axis of flesh from it.
/// Planes do not count.
fn extent(scene: &Scene, surfaces: &[Surface]) -> (DVec3, f64) {
    let functions = surfaces.iter().filter_map(|surface| match surface {
        Surface::Sum(_) => None,
        Surface::Composed(surface) => surface.function.support(),
    });
    let spheres: Vec<(DVec3, f64)> = surfaces
        .iter()
        .filter_map(|surface| match surface {
            Surface::Sum(surface) => Some(surface),
            Surface::Composed(_) => None,
        })
        .flat_map(|surface| surface.sum.primitives.iter().zip(&surface.element))
        .filter_map(|(primitive, element)| {
            let (center, radius) = primitive.skeleton.bounding_sphere()?;
            // A bone's own flesh, and as much again for what neighbours add and for air.
            let flesh = 2.2 * scene.radius(&scene.elements[*element as usize]);
            Some((center, radius + flesh.min(primitive.influence)))
        })
        .chain(functions.map(|ball| (ball.center, ball.radius)))
        .collect();
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for (center, radius) in &spheres {
        low = low.min(*center - *radius);
        high = high.max(*center + *radius);
    }
    if !(low.is_finite() && high.is_finite()) {
        return (DVec3::ZERO, 2.0);
    }
    let center = (low + high) / 2.0;
    let reach = ((high - low) / 2.0).max_element() * 1.08;
    (center, reach.clamp(1e-6, 1e9))
}

/// Returns the number of elements that the functions of some bodies have.
fn elements_of(bodies: &[Surface]) -> usize {
    bodies.iter().map(|body| body.element().len()).sum()
}

/// Narrows the middle and reach of the skeletons to where the flesh really is, as far as a coarse
/// grid of samples finds it; `None` if it finds none, or there are too many elements.
fn frame(bodies: &[Surface], (center, reach): (DVec3, f64)) -> Option<(DVec3, f64)> {
    /// Samples along each axis.
    const SIDE: usize = 20;
    /// Most elements; more would take too long.
    const MOST: usize = 1500;
    if elements_of(bodies) > MOST {
        return None;
    }
    let functions: Vec<&dyn Implicit> = bodies.iter().map(Surface::function).collect();
    let step = 2.0 * reach / (SIDE - 1) as f64;
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for first in (0..SIDE * SIDE * SIDE).step_by(8) {
        let points = core::array::from_fn(|lane| {
            let index = first + lane;
            let place = [index % SIDE, index / SIDE % SIDE, index / SIDE / SIDE];
            center - reach + DVec3::from(place.map(|i| i as f64)) * step
        });
        for (value, point) in sample::eight(&functions, points).into_iter().zip(points) {
            if f64::from(value) > 0.5 * THRESHOLD {
                low = low.min(point);
                high = high.max(point);
            }
        }
    }
    if !low.is_finite() {
        return None;
    }
    let half = ((high - low) / 2.0).max_element() + step;
    Some(((low + high) / 2.0, (1.3 * half).min(reach)))
}

/// Returns the colour of a field value: F/(F+T) on the scale of `SHADES`; negative fields count as
/// 0.
fn colour(value: f32, dark: bool) -> Color32 {
    let value = if value.is_finite() {
        value.max(0.0)
    } else {
        1e9
    };
    shade(value / (value + THRESHOLD as f32), dark)
}

/// Scale from violet over green to yellow in even steps of lightness (the map "viridis"), which
/// stays readable for the colour-blind and in grey.
const SHADES: [[u8; 3]; 9] = [
    [68, 1, 84],
    [71, 44, 122],
    [59, 81, 139],
    [44, 113, 142],
    [33, 144, 141],
    [39, 173, 129],
    [92, 200, 99],
    [170, 220, 50],
    [253, 231, 37],
];

/// Returns the colour at a share of the scale of `SHADES`.
pub(crate) fn shade(share: f32, dark: bool) -> Color32 {
    let at = share.clamp(0.0, 1.0) * (SHADES.len() - 1) as f32;
    let index = (at as usize).min(SHADES.len() - 2);
    let t = at - index as f32;
    // On paper the colours are a little lighter.
    let lift = if dark { 0.0 } else { 0.08 };
    let [red, green, blue] = [0, 1, 2].map(|channel| {
        let [a, b] = [index, index + 1].map(|i| f32::from(SHADES[i][channel]));
        let value = a + t * (b - a);
        (value + lift * (255.0 - value)).round() as u8
    });
    Color32::from_rgb(red, green, blue)
}

/// Draws the colours and their values.
fn legend(ui: &mut Ui) {
    let palette = theme::palette(ui.visuals());
    let dark = ui.visuals().dark_mode;
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 44.0), Sense::hover());
    let bar = Rect::from_min_size(rect.min, vec2(rect.width(), 16.0));
    let steps = 48;
    let painter = ui.painter();
    for step in 0..steps {
        let share = (step as f32 + 0.5) / steps as f32;
        let from = bar.left() + bar.width() * step as f32 / steps as f32;
        let piece = Rect::from_min_size(
            pos2(from, bar.top()),
            vec2(bar.width() / steps as f32 + 0.6, bar.height()),
        );
        painter.rect_filled(piece, 0.0, shade(share, dark));
    }
    let font = FontId::proportional(11.5);
    for (value, text) in [
        (0.0, "0"),
        (0.25, "¼"),
        (0.5, "½"),
        (1.0, "T = 1"),
        (2.0, "2"),
        (4.0, "4"),
        (1e9, "∞"),
    ] {
        let share: f32 = value / (value + 1.0);
        let x = bar.left() + bar.width() * share;
        let strong = value == 1.0;
        let colour = if strong { palette.strong } else { palette.weak };
        let stroke = Stroke::new(if strong { 3.0 } else { 1.0 }, colour);
        painter.vline(x, bar.bottom()..=bar.bottom() + 5.0, stroke);
        let side = match share {
            x if x < 0.02 => Align2::LEFT_TOP,
            x if x > 0.98 => Align2::RIGHT_TOP,
            _ => Align2::CENTER_TOP,
        };
        painter.text(
            pos2(x, bar.bottom() + 7.0),
            side,
            text,
            font.clone(),
            colour,
        );
    }
}

/// Draws advice about a dataset without soft shapes.
fn nothing(ui: &mut Ui, stage: &Stage, bench: &mut Bench<'_>) {
    let palette = theme::palette(ui.visuals());
    plot::panel(ui, stage.figure);
    let center = stage.figure.center();
    let font = FontId::proportional(15.0);
    ui.painter().text(
        center - vec2(0.0, 30.0),
        Align2::CENTER_CENTER,
        "The open dataset has no soft shapes, so it has no field.",
        font,
        palette.weak,
    );
    let place = Rect::from_center_size(center + vec2(0.0, 14.0), vec2(180.0, 36.0));
    let button = egui::Button::new("Open the T-shape");
    if ui.place(place, button).clicked() {
        let file = "tshape.rat";
        bench.commands.push(Command::OpenExample { file });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_threshold_is_in_the_middle_of_the_colours() {
        assert_eq!(colour(1.0, true), shade(0.5, true));
        assert_eq!(colour(-3.0, true), shade(0.0, true));
        assert_eq!(colour(f32::INFINITY, true), shade(1.0, true));
        assert_eq!(colour(f32::NAN, true), shade(1.0, true));
    }
}
