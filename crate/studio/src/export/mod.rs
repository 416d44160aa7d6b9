//! The dialog that shows the model as a mesh and saves it.

pub mod wish;

use crate::page::{Moment, Page};
use crate::panel::Panel;
use crate::wish::{Dialog, MeshWish, Wish, Wishes};
use crate::{places, theme};
use document::mesh_export::{self, Film, MOST_EDGES, Made, MeshExport, State};
use document::session::Session;
use document::{asset, work};
use egui::{
    Align, Button, Color32, ColorImage, Context, DragValue, Layout, ProgressBar, Response,
    RichText, ScrollArea, Sense, TextureHandle, TextureOptions, Ui, Vec2, vec2,
};
use glam::DVec3;
use mesh::Format;
use pool::Tools;
use tools::{MeshFacts, Written};
use viewport::{Frame, Look, View};

/// Finest and coarsest tolerance that the dialog offers, as parts of the longest side.
const TOLERANCES: [f64; 2] = [1e-4, 2e-2];
/// Shortest and longest length that can be asked for, millimetres.
const SIZES: [f64; 2] = [1.0, 5000.0];
/// Most pixels of the view, so that it follows a hand where the processor draws it.
const MOST_PIXELS: f32 = 480_000.0;

/// The view of the mesh.
struct Show {
    wireframe: bool,
    /// The camera, once there is a mesh.
    view: Option<View>,
    /// The number of the mesh that is drawn, and [`Session::generation`] of its scene.
    drawn: Option<(u64, u64)>,
    frame: Frame,
    texture: Option<TextureHandle>,
    /// Whether the image must be drawn again.
    is_stale: bool,
}

impl Show {
    /// Looks at a mesh from the front if it is of another scene than the one before.
    fn follow(&mut self, made: &Made) {
        let key = (made.number, made.generation());
        if self.drawn == Some(key) {
            return;
        }
        let is_other = self.drawn.is_none_or(|(_, generation)| generation != key.1);
        if let Some([low, high]) = made.surface.bounds()
            && (is_other || self.view.is_none())
        {
            let mut view = View::around([low.as_dvec3(), high.as_dvec3()]);
            view.look_from(DVec3::new(0.35, 0.3, 1.0), DVec3::Y);
            self.view = Some(view);
        }
        self.drawn = Some(key);
        self.is_stale = true;
    }
}

/// The dialog with the model as a mesh.
pub struct MeshPanel {
    /// The mesh and its jobs.
    pub export: MeshExport,
    show: Show,
}

impl MeshPanel {
    /// Makes a dialog without a mesh.
    #[must_use]
    pub fn new(tools: Tools) -> Self {
        Self {
            export: MeshExport::new(tools),
            show: Show {
                wireframe: false,
                view: None,
                drawn: None,
                frame: Frame::default(),
                texture: None,
                is_stale: true,
            },
        }
    }

    /// Carries out a wish.
    pub fn act(&self, wish: MeshWish, page: &mut Page, at: &Moment<'_>) {
        let MeshWish::Save = wish;
        let files = self.export.files();
        for file in files {
            browser::download(&file.name, "application/octet-stream", &file.bytes);
        }
        let names: Vec<&str> = files.iter().map(|file| file.name.as_str()).collect();
        if !names.is_empty() {
            page.tell(format!("Saved {}.", names.join(" and ")), at.now);
        }
    }

    /// Returns the state for scripts while the dialog is open.
    #[must_use]
    pub fn report(&self, page: &Page) -> Option<mesh_export::Report> {
        let is_open = page.dialog == Some(Dialog::Mesh);
        is_open.then(|| self.export.report(&page.work.session, page.film))?
    }
}

impl Panel for MeshPanel {
    fn show(&mut self, page: &Page, ui: &mut Ui, wishes: &mut Wishes) {
        let session = &page.work.session;
        let size = ui.available_size();
        let palette = theme::palette(ui.visuals());
        if let Some(made) = &self.export.made {
            self.show.follow(made);
        }
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
                    wishes.push(Wish::Close);
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
                ui.vertical(|ui| {
                    settled = self.settings(ui, session);
                    ui.separator();
                    self.outcome(ui, page, wishes);
                });
            });
        } else {
            // Progress and facts of the mesh stay in view below the rest.
            let below = 150.0;
            let height = (size.y - 60.0 - below).max(120.0);
            let above = ScrollArea::vertical().id_salt("mesh settings");
            above.max_height(height).show(ui, |ui| {
                let side = (height - 290.0).clamp(120.0, 420.0);
                self.view(ui, vec2(ui.available_width(), side));
                ui.add_space(4.0);
                settled = self.settings(ui, session);
            });
            ui.separator();
            let outcome = ScrollArea::vertical().id_salt("mesh outcome");
            outcome.max_height(below).auto_shrink(false).show(ui, |ui| {
                self.outcome(ui, page, wishes);
            });
        }
        if self.show.is_stale {
            // It was drawn before the settings that it depends on.
            ui.ctx().request_repaint();
        }
        // While a slider is dragged nothing is begun.
        if settled {
            let name = work::file_stem(&page.work.name);
            self.export.follow(session, page.film, &name);
        }
    }

    fn tick(&mut self, page: &mut Page, at: &Moment<'_>) {
        if self.export.tick() {
            at.ctx.request_repaint();
        }
        if page.dialog != Some(Dialog::Mesh) {
            self.export.stop();
        }
    }

    fn forget(&mut self, _page: &mut Page, _ctx: &Context) {
        self.export.forget();
        (self.show.view, self.show.drawn) = (None, None);
    }
}

impl MeshPanel {
    /// Shows the mesh, which can be turned, shifted and zoomed.
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
        let (Some(made), Some(view)) = (&self.export.made, &self.show.view) else {
            let text = if self.export.has_failed() {
                "No mesh"
            } else {
                "The mesh is being made …"
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
        if self.show.is_stale || self.show.frame.size() != pixels {
            self.show.frame.resize(pixels);
            let [right, up, back] = view.axes();
            let look = Look {
                light: (right * -0.4 + up * 0.6 + back * 0.7).as_vec3(),
                wireframe: self.show.wireframe && made.surface.triangles.len() <= MOST_EDGES,
                background,
                edge: background.map(|channel| 0.4 * channel),
                ..Look::default()
            };
            self.show.frame.draw(view, &made.surface, &look);
            let image = ColorImage::from_rgba_unmultiplied(pixels, self.show.frame.rgba());
            match &mut self.show.texture {
                Some(texture) => texture.set(image, TextureOptions::LINEAR),
                None => {
                    let options = TextureOptions::LINEAR;
                    self.show.texture = Some(ui.ctx().load_texture("mesh view", image, options));
                }
            }
            self.show.is_stale = false;
        }
        if let Some(texture) = &self.show.texture {
            let whole = egui::Rect::from_min_max(egui::pos2(0.0, 0.0), egui::pos2(1.0, 1.0));
            painter.image(texture.id(), rect, whole, Color32::WHITE);
        }
    }

    /// Follows the pointer: the first button turns, another one shifts, wheel and two fingers zoom.
    fn turn(&mut self, ui: &Ui, response: &Response, scale: f64, pixels: [usize; 2]) {
        let Some(view) = &mut self.show.view else {
            return;
        };
        let before = *view;
        let moved = response.drag_delta();
        if let Some(at) = response.interact_pointer_pos()
            && moved != Vec2::ZERO
        {
            if response.dragged_by(egui::PointerButton::Primary) {
                let half = 0.5 * response.rect.width().min(response.rect.height());
                let [from, to] = [at - moved, at].map(|at| {
                    let from_middle = (at - response.rect.center()) / half;
                    [f64::from(from_middle.x), -f64::from(from_middle.y)]
                });
                view.turn(from, to);
            } else {
                view.shift([moved.x, moved.y].map(|way| f64::from(way) * scale), pixels);
            }
        }
        if response.contains_pointer() {
            let (scroll, pinch) =
                ui.input(|input| (input.smooth_scroll_delta().y, input.zoom_delta()));
            view.zoom(f64::from(pinch) * libm::exp(f64::from(scroll) * 0.003));
        }
        self.show.is_stale |= *view != before;
    }

    /// Shows the settings. Returns whether they are settled: no slider is being dragged.
    fn settings(&mut self, ui: &mut Ui, session: &Session) -> bool {
        let palette = theme::palette(ui.visuals());
        let mut settled = true;
        ui.spacing_mut().item_spacing.y = 6.0;
        ui.horizontal_wrapped(|ui| {
            for (format, title, tip) in FORMATS {
                let chosen = self.export.order.format == format;
                let button = ui.selectable_label(chosen, title).on_hover_text(tip);
                places::note(ui.ctx(), format!("mesh format {title}"), button.rect);
                if button.clicked() {
                    self.export.order.format = format;
                }
            }
        });
        let label =
            |ui: &mut Ui, text: &str| ui.label(RichText::new(text).color(palette.weak).size(12.5));
        ui.horizontal(|ui| {
            label(ui, "Longest side");
            let side = DragValue::new(&mut self.export.order.size)
                .range(SIZES[0]..=SIZES[1])
                .speed(1.0)
                .max_decimals(2)
                .suffix(" mm");
            let side = ui.add(side);
            places::note(ui.ctx(), "mesh size", side.rect);
            settled &= !side.dragged() && !side.has_focus();
        });
        ui.horizontal(|ui| {
            label(ui, "Coarse");
            // To the right it is finer.
            let mut detail = -libm::log10(self.export.order.tolerance);
            let range = -libm::log10(TOLERANCES[1])..=-libm::log10(TOLERANCES[0]);
            let slider = egui::Slider::new(&mut detail, range)
                .show_value(false)
                .trailing_fill(true);
            let slider = ui.add(slider);
            places::note(ui.ctx(), "mesh detail", slider.rect);
            if slider.changed() {
                self.export.order.tolerance = libm::pow(10.0, -detail);
            }
            settled &= !slider.dragged() && !slider.is_pointer_button_down_on();
            label(ui, "fine");
        });
        let off = millimetres(self.export.order.tolerance * self.export.order.size);
        ui.label(RichText::new(format!("At most {off} from the surface")).size(12.5));
        let shown = self
            .export
            .made
            .as_ref()
            .map_or(0, |made| made.surface.triangles.len());
        let wires = egui::Checkbox::new(&mut self.show.wireframe, "Show the triangles");
        let wires = ui
            .add_enabled(shown <= MOST_EDGES, wires)
            .on_disabled_hover_text("They are smaller than pixels");
        places::note(ui.ctx(), "mesh wireframe", wires.rect);
        self.show.is_stale |= wires.changed();
        let union = ui
            .checkbox(&mut self.export.order.union, "Join bodies that overlap")
            .on_hover_text("One shell instead of several that go through each other");
        places::note(ui.ctx(), "mesh union", union.rect);
        let prove = ui
            .checkbox(&mut self.export.order.prove, "Prove it")
            .on_hover_text(
                "Bounds of the field prove the distance from the surface and the topology, where \
                that is possible. It takes about ten times as long",
            );
        places::note(ui.ctx(), "mesh prove", prove.rect);
        let scene = &session.compilation().scene;
        if self.export.order.format == Format::Glb && rig::has_skeleton(scene) {
            let title = if session.is_animated() {
                "With joints and motion"
            } else {
                "With joints"
            };
            let rig = ui
                .checkbox(&mut self.export.order.rig, title)
                .on_hover_text(
                    "Nodes of the skeleton as bones, so that the mesh can be posed; \
                    the film as an animation",
                );
            places::note(ui.ctx(), "mesh rig", rig.rect);
        }
        settled
    }

    /// Shows progress, or the button that saves the mesh and facts about it.
    fn outcome(&mut self, ui: &mut Ui, page: &Page, wishes: &mut Wishes) {
        let (session, film) = (&page.work.session, page.film);
        let palette = theme::palette(ui.visuals());
        ui.spacing_mut().item_spacing.y = 4.0;
        match self.export.state(session, film) {
            State::Idle => {}
            State::Making(fraction) => {
                let bar = ui.add(ProgressBar::new(fraction).desired_width(220.0));
                places::note(ui.ctx(), "mesh progress", bar.rect);
                if self.export.shows_coat() {
                    let text = "Until then you see a rough coat of it.";
                    ui.label(RichText::new(text).size(12.5).color(palette.weak));
                }
                let stop = ui.button("Stop");
                places::note(ui.ctx(), "stop mesh", stop.rect);
                if stop.clicked() {
                    self.export.give_up(session, film);
                }
            }
            State::Trouble(reason) => {
                ui.label(RichText::new(sentence(reason)).color(palette.error));
                let again = ui.button("Try again");
                places::note(ui.ctx(), "mesh again", again.rect);
                if again.clicked() {
                    self.export.again();
                }
            }
            State::Done(facts, written) => {
                let lines = lines(facts, self.export.growth(facts), written, film);
                let save = Button::new(RichText::new("Save").color(palette.on_accent).size(14.5))
                    .fill(palette.accent);
                let height = ui.spacing().interact_size.y.max(30.0);
                let save = ui.add_sized(vec2(120.0, height), save);
                places::note(ui.ctx(), "save mesh", save.rect);
                if save.clicked() {
                    wishes.push(MeshWish::Save);
                }
                for line in lines.iter().chain(&facts.notes) {
                    ui.label(RichText::new(sentence(line)).size(13.0).color(palette.text));
                }
            }
        }
    }
}

/// Returns lines of facts about a mesh.
fn lines(facts: &MeshFacts, growth: f64, written: &Written, film: Film) -> Vec<String> {
    let bytes = written.files.iter().map(|file| file.bytes.len()).sum();
    let [x, y, z] = facts.sides.map(|side| millimetres(side * growth));
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
        let volume = facts.volume * growth * growth * growth;
        lines.push(format!("{}, {shells}", cubic(volume)));
    } else {
        lines.push(String::from("not closed: a printer may refuse it"));
    }
    let unsure = match facts.undecided + facts.unproved {
        0 => String::new(),
        1 => String::from(", except in one place"),
        places => format!(", except in {} places", thousands(places)),
    };
    let error = millimetres(facts.error * growth);
    if !facts.is_measured {
        lines.push(format!("proved: at most {error} off{unsure}"));
    }
    if facts.samples > 0 {
        lines.push(format!(
            "measured at {} points: at most {} off",
            thousands(facts.samples),
            millimetres(facts.measured * growth)
        ));
    }
    if written.joints > 0 {
        let motion = match written.frames {
            0 | 1 => String::new(),
            frames => format!(", {frames} frames at {} a second", film.rate),
        };
        let s = if written.joints == 1 { "" } else { "s" };
        lines.push(format!("{} joint{s}{motion}", written.joints));
    }
    lines
}

/// The formats as the dialog lists them: best known first.
const FORMATS: [(Format, &str, &str); 5] = [
    (
        Format::Stl,
        "STL",
        "Every program for printing reads it; no colours",
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
        "Old and known everywhere; materials are in a second file",
    ),
    (
        Format::Ply,
        "PLY",
        "For measuring programs: colours of vertices",
    ),
];

/// Returns the channels of a colour as they are shown, 0 … 1.
fn channels(color: Color32) -> [f32; 3] {
    [color.r(), color.g(), color.b()].map(|channel| f32::from(channel) / 255.0)
}

/// Returns a length in words.
fn millimetres(length: f64) -> String {
    if length >= 100.0 {
        format!("{length:.0} mm")
    } else if length >= 1.0 {
        format!("{length:.1} mm")
    } else {
        format!("{length:.3} mm")
    }
}

/// Returns a volume, given in cubic millimetres, in words.
fn cubic(volume: f64) -> String {
    let centimetres = volume / 1000.0;
    if centimetres >= 100.0 {
        format!("{centimetres:.0} cm³")
    } else if centimetres >= 1.0 {
        format!("{centimetres:.2} cm³")
    } else {
        format!("{volume:.2} mm³")
    }
}

/// Returns a number with a narrow space between its thousands.
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

/// Returns a text with a capital letter at its start.
fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| {
        first.to_uppercase().chain(letters).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_easy_to_read() {
        assert_eq!(thousands(1_234_567), "1\u{202f}234\u{202f}567");
        assert_eq!(thousands(12), "12");
        assert_eq!(millimetres(0.1), "0.100 mm");
        assert_eq!(cubic(12_345.0), "12.35 cm³");
        assert_eq!(cubic(0.5), "0.50 mm³");
        assert_eq!(sentence("no surface"), "No surface");
    }
}
