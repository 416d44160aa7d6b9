//! The model as a mesh, for printers and other programs: the dialog, the job of the tools worker, scripts that ask for one.
//!
//! The mesh is made apart from the page's thread. What is shown is that of the settings made last; a finer one replaces
//! it when it is there.

use crate::command::Command;
use crate::session::Session;
use crate::{asset, places, theme};
use egui::{
    Align, Button, Color32, ColorImage, DragValue, Layout, ProgressBar, Response, RichText,
    ScrollArea, Sense, TextureHandle, TextureOptions, Ui, Vec2, vec2,
};
use glam::DVec3;
use mesh::{ExportedFile, Format, TriangleMesh};
use mesher::{Tolerance, Wishes};
use pool::{ToolEvent, Tools};
use tools::{Job, MeshFacts, MeshJob, Meshed, Output};
use viewport::{Frame, Look, Surface, View};

/// Finest and coarsest tolerance that the dialog offers, in lengths of the model.
const TOLERANCES: [f64; 2] = [1e-4, 2e-2];
/// Lengths of the longest side that can be asked for, millimetres.
const SIZES: [f64; 2] = [1.0, 5000.0];
/// Most pixels of the view, so that it follows a hand where the processor draws it.
const MOST_PIXELS: f32 = 480_000.0;
/// Most triangles whose edges are shown: beyond there are more edges than pixels.
const MOST_EDGES: usize = 300_000;

/// What is to be made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Order {
    /// Format of the file.
    pub format: Format,
    /// Largest distance between mesh and surface, in lengths of the model.
    pub tolerance: f64,
    /// Length of the model's longest side, millimetres.
    pub size: f64,
    /// Whether bodies that overlap become one.
    pub union: bool,
}

impl Default for Order {
    fn default() -> Self {
        Self {
            format: Format::Stl,
            tolerance: 1e-3,
            size: 100.0,
            union: false,
        }
    }
}

impl Order {
    /// What is wrong with it, in a sentence.
    ///
    /// # Errors
    /// If a number is none, or out of its range.
    pub fn check(&self) -> Result<(), String> {
        let [finest, coarsest] = [1e-6, 0.5];
        if !(finest..=coarsest).contains(&self.tolerance) {
            return Err(format!(
                "The tolerance is a part of the model's length from {finest} to {coarsest}."
            ));
        }
        if !(1e-3..=1e6).contains(&self.size) {
            return Err(String::from(
                "The size is a length in millimetres from 0.001 to 1000000.",
            ));
        }
        Ok(())
    }
}

/// Takes a file's bytes, or the reason why there are none.
pub type Taker = Box<dyn FnOnce(Result<Vec<u8>, String>)>;

/// A job that runs.
struct Running {
    id: u64,
    order: Order,
    /// Of the scene that is meshed.
    generation: u64,
    fraction: f32,
    /// A script that waits for it.
    taker: Option<Taker>,
}

/// A mesh that is there.
struct Made {
    order: Order,
    generation: u64,
    files: Vec<ExportedFile>,
    facts: MeshFacts,
    surface: Surface,
}

/// The model as a mesh.
pub struct MeshExport {
    tools: Tools,
    order: Order,
    running: Vec<Running>,
    made: Option<Made>,
    /// Why the settings made last give no mesh.
    trouble: Option<(Order, u64, String)>,
    wireframe: bool,
    view: Option<View>,
    frame: Frame,
    texture: Option<TextureHandle>,
    /// Whether the image must be drawn again.
    is_stale: bool,
}

impl MeshExport {
    /// Makes nothing yet; the worker is started for the first mesh. `repaint` is called when
    /// [`MeshExport::tick`] has something to do.
    #[must_use]
    pub fn new(repaint: impl Fn() + Send + Sync + 'static) -> Self {
        Self {
            tools: Tools::new(repaint),
            order: Order::default(),
            running: Vec::new(),
            made: None,
            trouble: None,
            wireframe: false,
            view: None,
            frame: Frame::default(),
            texture: None,
            is_stale: true,
        }
    }

    /// Takes in what the worker has done.
    pub fn tick(&mut self) {
        for (id, event) in self.tools.poll() {
            let Some(index) = self.running.iter().position(|job| job.id == id) else {
                continue;
            };
            match event {
                ToolEvent::Progress(fraction) => self.running[index].fraction = fraction,
                // A mesh comes in one piece.
                ToolEvent::Partial(_) => {}
                ToolEvent::Done(result) => {
                    let job = self.running.remove(index);
                    let result = match result {
                        Ok(Output::Meshed(meshed)) => Ok(*meshed),
                        Ok(_) => Err(String::from("The tools worker gave no mesh.")),
                        Err(reason) => Err(reason),
                    };
                    self.finish(job, result);
                }
            }
        }
    }

    fn finish(&mut self, job: Running, result: Result<Meshed, String>) {
        if let Some(taker) = job.taker {
            taker(result.map(|meshed| {
                // OBJ has its materials in a second file, which it can do without.
                let mut files = meshed.files.into_iter();
                files.next().map_or_else(Vec::new, |file| file.bytes)
            }));
            return;
        }
        match result {
            Ok(meshed) => {
                let surface = surface(&meshed.parts, meshed.facts.is_closed);
                let other = self.made.as_ref().map(|made| made.generation) != Some(job.generation);
                if other || self.view.is_none() {
                    self.view = surface.bounds().map(|[low, high]| {
                        let mut view = View::around([low.as_dvec3(), high.as_dvec3()]);
                        view.look_from(DVec3::new(0.35, 0.3, 1.0), DVec3::Y);
                        view
                    });
                }
                self.trouble = None;
                self.is_stale = true;
                self.made = Some(Made {
                    order: job.order,
                    generation: job.generation,
                    files: meshed.files,
                    facts: meshed.facts,
                    surface,
                });
            }
            Err(reason) => self.trouble = Some((job.order, job.generation, reason)),
        }
    }

    /// Makes a mesh of the session's scene for a script.
    pub fn make_for(&mut self, session: &Session, name: &str, order: Order, taker: Taker) {
        if let Err(reason) = order.check() {
            taker(Err(reason));
        } else if session.scene().is_none() {
            taker(Err(String::from("There is no model yet.")));
        } else {
            self.begin(session, name, order, Some(taker));
        }
    }

    fn begin(&mut self, session: &Session, name: &str, order: Order, taker: Option<Taker>) {
        let Some(scene) = session.scene() else {
            return;
        };
        let wishes = Wishes {
            tolerance: Tolerance::Relative(order.tolerance),
            union: order.union,
            ..Wishes::default()
        };
        let job = Job::Mesh(Box::new(MeshJob {
            scene,
            wishes,
            format: Some(order.format),
            name: name.to_owned(),
            size: order.size,
        }));
        self.running.push(Running {
            id: self.tools.submit(job),
            order,
            generation: session.generation(),
            fraction: 0.0,
            taker,
        });
    }

    /// Ends the job that the dialog waits for, as it is closed or nobody wants its mesh any more.
    pub fn stop(&mut self) {
        let Self { tools, running, .. } = self;
        running.retain(|job| {
            if job.taker.is_none() {
                tools.cancel(job.id);
            }
            job.taker.is_some()
        });
    }

    /// Whether a mesh of these settings is there, comes, or cannot be had.
    fn is_known(&self, generation: u64) -> bool {
        let is_it = |order: &Order, of: u64| *order == self.order && of == generation;
        self.made
            .as_ref()
            .is_some_and(|made| is_it(&made.order, made.generation))
            || self
                .trouble
                .as_ref()
                .is_some_and(|(order, of, _)| is_it(order, *of))
            || self
                .running
                .iter()
                .any(|job| job.taker.is_none() && is_it(&job.order, job.generation))
    }

    /// Shows the dialog in a space of a size.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        size: Vec2,
        session: &Session,
        name: &str,
        commands: &mut Vec<Command>,
    ) {
        let palette = theme::palette(ui.visuals());
        let generation = session.generation();
        ui.horizontal(|ui| {
            ui.label(
                RichText::new("The model as a mesh")
                    .heading()
                    .color(palette.strong),
            );
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                let close = ui.button("Close");
                places::note(ui.ctx(), "close mesh", close.rect);
                if close.clicked() {
                    commands.push(Command::Close);
                }
            });
        });
        ui.add_space(6.0);
        let wide = size.x > 620.0;
        let mut settled = true;
        if wide {
            ui.horizontal_top(|ui| {
                let view = vec2(size.x - 300.0, (size.y - 70.0).max(160.0));
                self.view(ui, view);
                ui.add_space(8.0);
                ui.vertical(|ui| settled = self.panel(ui, commands));
            });
        } else {
            ScrollArea::vertical().show(ui, |ui| {
                self.view(ui, vec2(size.x, (size.y * 0.42).max(140.0)));
                ui.add_space(8.0);
                settled = self.panel(ui, commands);
            });
        }
        // While a slider is dragged nothing is begun.
        if settled && !self.is_known(generation) && session.scene().is_some() {
            self.stop();
            self.begin(session, name, self.order, None);
        }
    }

    /// Shows the mesh, to be turned, shifted and brought nearer.
    fn view(&mut self, ui: &mut Ui, size: Vec2) {
        let palette = theme::palette(ui.visuals());
        let (rect, response) = ui.allocate_exact_size(size, Sense::drag());
        places::note(ui.ctx(), "mesh view", rect);
        let density = ui.ctx().pixels_per_point();
        let scale = density.min((MOST_PIXELS / (size.x * size.y)).sqrt());
        let pixels = [size.x, size.y].map(|side| (side * scale).max(1.0) as usize);
        self.turn(ui, &response, f64::from(scale), pixels);
        let painter = ui.painter_at(rect);
        painter.rect_filled(rect, 6.0, palette.button);
        let (Some(made), Some(view)) = (&self.made, &self.view) else {
            let text = match &self.trouble {
                Some(_) => "No mesh",
                None => "The mesh is being made …",
            };
            let font = egui::TextStyle::Body.resolve(ui.style());
            painter.text(
                rect.center(),
                egui::Align2::CENTER_CENTER,
                text,
                font,
                palette.weak,
            );
            return;
        };
        let background = channels(palette.button);
        if self.is_stale || self.frame.size() != pixels {
            self.frame.resize(pixels);
            let [right, up, back] = view.axes();
            let look = Look {
                light: (right * -0.4 + up * 0.6 + back * 0.7).as_vec3(),
                wireframe: self.wireframe && made.surface.triangles.len() <= MOST_EDGES,
                background,
                edge: background.map(|channel| 0.4 * channel),
                ..Look::default()
            };
            self.frame.draw(view, &made.surface, &look);
            let image = ColorImage::from_rgba_unmultiplied(pixels, self.frame.rgba());
            match &mut self.texture {
                Some(texture) => texture.set(image, TextureOptions::LINEAR),
                None => {
                    let options = TextureOptions::LINEAR;
                    self.texture = Some(ui.ctx().load_texture("mesh view", image, options));
                }
            }
            self.is_stale = false;
        }
        if let Some(texture) = &self.texture {
            let whole = egui::Rect::from_min_max(egui::pos2(0.0, 0.0), egui::pos2(1.0, 1.0));
            painter.image(texture.id(), rect, whole, Color32::WHITE);
        }
    }

    /// Follows the pointer: the first button turns, another one shifts, wheel and two fingers zoom.
    fn turn(&mut self, ui: &Ui, response: &Response, scale: f64, pixels: [usize; 2]) {
        let Some(view) = &mut self.view else {
            return;
        };
        let before = *view;
        let moved = response.drag_delta();
        if let Some(at) = response.interact_pointer_pos()
            && moved != Vec2::ZERO
        {
            if response.dragged_by(egui::PointerButton::Primary) {
                let half = 0.5 * response.rect.width().min(response.rect.height());
                let place = |at: egui::Pos2| {
                    let from_middle = (at - response.rect.center()) / half;
                    [f64::from(from_middle.x), -f64::from(from_middle.y)]
                };
                view.turn(place(at - moved), place(at));
            } else {
                view.shift([moved.x, moved.y].map(|way| f64::from(way) * scale), pixels);
            }
        }
        if response.contains_pointer() {
            let (scroll, pinch) =
                ui.input(|input| (input.smooth_scroll_delta().y, input.zoom_delta()));
            view.zoom(f64::from(pinch) * libm::exp(f64::from(scroll) * 0.003));
        }
        self.is_stale |= *view != before;
    }

    /// Shows the settings, and what the mesh is like. Returns whether the settings are not just being changed.
    fn panel(&mut self, ui: &mut Ui, commands: &mut Vec<Command>) -> bool {
        let palette = theme::palette(ui.visuals());
        let mut settled = true;
        ui.spacing_mut().item_spacing.y = 6.0;
        ui.horizontal_wrapped(|ui| {
            for (format, title, tip) in FORMATS {
                let chosen = self.order.format == format;
                let button = ui.selectable_label(chosen, title).on_hover_text(tip);
                places::note(ui.ctx(), format!("mesh format {title}"), button.rect);
                if button.clicked() {
                    self.order.format = format;
                }
            }
        });
        ui.label(RichText::new("Longest side").color(palette.weak).size(12.5));
        let side = DragValue::new(&mut self.order.size)
            .range(SIZES[0]..=SIZES[1])
            .speed(1.0)
            .max_decimals(2)
            .suffix(" mm");
        let side = ui.add(side);
        places::note(ui.ctx(), "mesh size", side.rect);
        settled &= !side.dragged() && !side.has_focus();
        ui.label(RichText::new("Detail").color(palette.weak).size(12.5));
        // To the right it is finer.
        let mut detail = -libm::log10(self.order.tolerance);
        let range = -libm::log10(TOLERANCES[1])..=-libm::log10(TOLERANCES[0]);
        let slider = egui::Slider::new(&mut detail, range)
            .show_value(false)
            .trailing_fill(true);
        let slider = ui.add(slider);
        places::note(ui.ctx(), "mesh detail", slider.rect);
        if slider.changed() {
            self.order.tolerance = libm::pow(10.0, -detail);
        }
        settled &= !slider.dragged() && !slider.is_pointer_button_down_on();
        let off = millimetres(self.order.tolerance * self.order.size);
        ui.label(RichText::new(format!("at most {off} from the surface")).size(12.5));
        let union = ui
            .checkbox(&mut self.order.union, "Join bodies that overlap")
            .on_hover_text("One shell instead of several that go through each other");
        places::note(ui.ctx(), "mesh union", union.rect);
        let wires = ui.checkbox(&mut self.wireframe, "Show the triangles");
        places::note(ui.ctx(), "mesh wireframe", wires.rect);
        self.is_stale |= wires.changed();
        ui.separator();
        self.state(ui, commands);
        settled
    }

    /// Shows progress, or what the mesh is like and the button that saves it.
    fn state(&mut self, ui: &mut Ui, commands: &mut Vec<Command>) {
        let palette = theme::palette(ui.visuals());
        if let Some(job) = self.running.iter().find(|job| job.taker.is_none()) {
            let bar = ui.add(ProgressBar::new(job.fraction).desired_width(220.0));
            places::note(ui.ctx(), "mesh progress", bar.rect);
            let stop = ui.button("Stop");
            places::note(ui.ctx(), "stop mesh", stop.rect);
            if stop.clicked() {
                let text = String::from("Stopped. Choose less detail, or close this window.");
                self.trouble = Some((job.order, job.generation, text));
                self.stop();
            }
            return;
        }
        if let Some((order, _, reason)) = &self.trouble
            && *order == self.order
        {
            ui.label(RichText::new(sentence(reason)).color(palette.error));
            return;
        }
        let Some(made) = self.made.as_ref().filter(|made| made.order == self.order) else {
            return;
        };
        let facts = &made.facts;
        let bytes = made.files.iter().map(|file| file.bytes.len()).sum();
        let [x, y, z] = facts.sides.map(millimetres);
        let mut lines = vec![
            format!(
                "{} triangles, {}",
                thousands(facts.triangles),
                asset::size(bytes)
            ),
            format!("{x} × {y} × {z}"),
        ];
        if facts.is_closed {
            let shells = match facts.shells {
                1 => String::from("one closed shell"),
                shells => format!("{shells} closed shells"),
            };
            lines.push(format!("{:.4} cm³, {shells}", facts.volume / 1000.0));
        } else {
            lines.push(String::from("not closed: a printer may refuse it"));
        }
        if facts.undecided + facts.unproved > 0 {
            lines.push(format!(
                "not proved in {} places",
                thousands(facts.undecided + facts.unproved)
            ));
        }
        for line in lines.iter().chain(&facts.notes) {
            ui.label(RichText::new(sentence(line)).size(13.0).color(palette.text));
        }
        ui.add_space(4.0);
        let save = Button::new(RichText::new("Save").color(palette.on_accent).size(14.5))
            .fill(palette.accent)
            .min_size(vec2(120.0, 30.0));
        let save = ui.add(save);
        places::note(ui.ctx(), "save mesh", save.rect);
        if save.clicked() {
            commands.push(Command::SaveMesh);
        }
    }

    /// The files of the mesh on show.
    #[must_use]
    pub fn files(&self) -> &[ExportedFile] {
        self.made.as_ref().map_or(&[], |made| &made.files)
    }
}

/// The formats as the dialog lists them: best known first.
const FORMATS: [(Format, &str, &str); 5] = [
    (
        Format::Stl,
        "STL",
        "Every printer's program takes it; no colours",
    ),
    (
        Format::ThreeMf,
        "3MF",
        "For printers: millimetres and colours",
    ),
    (
        Format::Glb,
        "GLB",
        "For Blender, games and the web: colours and materials",
    ),
    (
        Format::Obj,
        "OBJ",
        "Old and known everywhere; its materials are a second file",
    ),
    (
        Format::Ply,
        "PLY",
        "For measuring programs: colours of vertices",
    ),
];

/// Colours as they are shown, 0 … 1.
fn channels(color: Color32) -> [f32; 3] {
    [color.r(), color.g(), color.b()].map(|channel| f32::from(channel) / 255.0)
}

/// A length in words.
fn millimetres(length: f64) -> String {
    if length >= 100.0 {
        format!("{length:.0} mm")
    } else if length >= 1.0 {
        format!("{length:.1} mm")
    } else {
        format!("{length:.3} mm")
    }
}

/// A number with its thousands apart.
fn thousands(number: usize) -> String {
    let digits = number.to_string();
    let mut apart = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            apart.push('\u{202f}');
        }
        apart.push(digit);
    }
    apart
}

/// A text that begins with a capital letter.
fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| {
        first.to_uppercase().chain(letters).collect()
    })
}

/// The parts of a mesh as one surface to be drawn.
fn surface(parts: &[(String, TriangleMesh)], is_closed: bool) -> Surface {
    let mut all = Surface {
        is_closed,
        ..Surface::default()
    };
    let clay = [0.8, 0.62, 0.5];
    for (_, mesh) in parts {
        let first = all.positions.len() as u32;
        all.positions
            .extend(mesh.positions.iter().map(|p| p.as_vec3()));
        match &mesh.colors {
            Some(colors) => all.colors.extend(colors.iter().map(|c| c.map(encoded))),
            None => all
                .colors
                .extend(std::iter::repeat_n(clay, mesh.positions.len())),
        }
        let triangles = mesh.triangles.iter().map(|t| t.map(|i| first + i));
        all.triangles.extend(triangles);
    }
    all.smooth();
    if all.triangles.len() <= MOST_EDGES {
        // Of a closed mesh each edge has two triangles, in opposite directions.
        let sides = |t: &[u32; 3]| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]];
        let edges = all.triangles.iter().flat_map(sides);
        all.edges = edges.filter(|[a, b]| a < b || !is_closed).collect();
    }
    all
}

/// A channel of linear light as sRGB shows it, closely enough for a view.
fn encoded(channel: f32) -> f32 {
    libm::powf(channel.clamp(0.0, 1.0), 1.0 / 2.2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::Kept;
    use rats::{File, Project};
    use std::cell::RefCell;
    use std::rc::Rc;
    use std::time::{Duration, Instant};

    fn session(text: &str) -> Session {
        let file = File {
            name: String::from("main.rat"),
            text: text.to_owned(),
        };
        let kept = Kept {
            project: Project { files: vec![file] },
            ..Kept::default()
        };
        let mut session = Session::new(kept, true);
        session.compile();
        session
    }

    fn made_for_a_script(text: &str, order: Order) -> Result<Vec<u8>, String> {
        let mut export = MeshExport::new(|| {});
        let given = Rc::new(RefCell::new(None));
        let place = given.clone();
        let taker = Box::new(move |result| *place.borrow_mut() = Some(result));
        export.make_for(&session(text), "ball", order, taker);
        let deadline = Instant::now() + Duration::from_secs(60);
        while given.borrow().is_none() {
            assert!(Instant::now() < deadline);
            std::thread::sleep(Duration::from_millis(1));
            export.tick();
        }
        given.take().unwrap()
    }

    const BALL: &str = "surface s diffuse Gold, blob -2\nsphere s 1 0 0 0\n";

    #[test]
    fn script_gets_the_file_in_millimetres() {
        let order = Order {
            tolerance: 1e-2,
            size: 30.0,
            ..Order::default()
        };
        let bytes = made_for_a_script(BALL, order).unwrap();
        let mesh = mesh::read("ball.stl", &bytes).unwrap();
        let far = mesh.positions.iter().map(|p| p.x.abs()).fold(0.0, f64::max);
        assert!((far - 15.0).abs() < 0.5, "{far}");
    }

    #[test]
    fn what_cannot_be_made_is_told() {
        let order = Order::default();
        let nothing = made_for_a_script("surface s diffuse Gold\n", order).unwrap_err();
        assert!(nothing.contains("no surface"), "{nothing}");
        for (tolerance, size) in [
            (0.0, 1.0),
            (f64::NAN, 1.0),
            (1e-3, -1.0),
            (1e-3, f64::INFINITY),
        ] {
            let order = Order {
                tolerance,
                size,
                ..order
            };
            assert!(made_for_a_script(BALL, order).is_err());
        }
    }

    #[test]
    fn numbers_are_easy_to_read() {
        assert_eq!(thousands(1_234_567), "1\u{202f}234\u{202f}567");
        assert_eq!(thousands(12), "12");
        assert_eq!(millimetres(0.1), "0.100 mm");
        assert_eq!(sentence("no surface"), "No surface");
    }
}
