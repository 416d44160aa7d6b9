//! A result, shown large and played if it moves, with buttons that save or keep it.

use super::item::{Content, Film, Item, texture};
use crate::wish::{TrayWish, Wish, Wishes};
use crate::works::gallery::contain;
use crate::{places, theme};
use ::picture::animation::Frames;
use document::asset::{self, Asset, Kind};
use egui::{
    Align, Button, ColorImage, Key, Label, Layout, Modifiers, RichText, ScrollArea, Sense,
    TextureHandle, TextureOptions, Ui, Vec2, vec2,
};
use std::sync::Arc;

/// Longest side of the picture shown, pixels.
const LONGEST: u32 = 2048;
/// Shortest time that a frame is shown, seconds.
const SHORTEST: f64 = 0.02;
/// Height of everything except the picture, points.
const REST: f32 = 148.0;
/// Least height of the place for the picture, points.
const LEAST: f32 = 120.0;

/// Shows a button that leads to the command. Returns whether it was clicked.
fn find(ui: &mut Ui) -> bool {
    let button = ui.button("Show in the text");
    places::note(ui.ctx(), "find result", button.rect);
    button
        .on_hover_text("Go to the command that made it")
        .clicked()
}

/// Shows a button that makes the result a file of the work. Returns whether it was clicked.
fn keep(ui: &mut Ui, film: &Film, kept: &[Asset]) -> bool {
    let mut kept = kept.iter();
    if kept.any(|asset| asset.name == film.name && asset.bytes == film.bytes) {
        ui.add_enabled(false, Button::new("Kept as a file"));
        return false;
    }
    let button = ui.button("Keep as a file");
    places::note(ui.ctx(), "keep result", button.rect);
    let tip = "Put it beside the text, as if it had been dropped on the page";
    button.on_hover_text(tip).clicked()
}

/// The result that was opened.
#[derive(Default)]
pub struct Large {
    /// Index on the tray.
    pub open: usize,
    view: Option<View>,
}

/// A picture on the screen.
struct View {
    bytes: Arc<[u8]>,
    /// The texture; `None` if the file is damaged.
    texture: Option<TextureHandle>,
    /// The frames to come, if it moves.
    frames: Option<Frames<'static>>,
    /// Time of the next frame, seconds.
    due: f64,
}

impl View {
    fn new(ui: &Ui, film: &Film, now: f64) -> Self {
        let first = film.first().ok();
        let moves = first.as_ref().is_some_and(|(_, moves)| *moves);
        Self {
            bytes: film.bytes.clone(),
            texture: first.map(|(picture, _)| texture(ui.ctx(), &picture, LONGEST)),
            frames: moves.then(|| film.frames()).flatten(),
            due: now,
        }
    }

    /// Shows the next frame if its time has come. An animation repeats for ever.
    fn play(&mut self, ui: &Ui, film: &Film, now: f64) {
        let Some(frames) = &mut self.frames else {
            return;
        };
        if now >= self.due {
            match frames.next() {
                Some(Ok(frame)) => {
                    self.due = now + frames.delay().max(SHORTEST);
                    let longest = ui.input(|input| input.max_texture_side) as u32;
                    let size = frame.size().map(|side| side as usize);
                    if frame.width().max(frame.height()) > LONGEST.min(longest) {
                        self.texture = Some(texture(ui.ctx(), &frame, LONGEST));
                    } else if let Some(texture) = &mut self.texture {
                        let pixels = ColorImage::from_rgba_unmultiplied(size, frame.pixels());
                        texture.set(pixels, TextureOptions::LINEAR);
                    }
                }
                // After the last frame, or at a damaged one, it begins again.
                _ => {
                    self.frames = film.frames();
                    self.due = now;
                }
            }
        }
        let wait = (self.due - now).max(0.0);
        ui.ctx().request_repaint_after_secs(wait as f32 + 0.002);
    }
}

impl Large {
    /// Shows the result in a window of a size.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        size: Vec2,
        items: &[Item],
        kept: &[Asset],
        now: f64,
        wishes: &mut Wishes,
    ) {
        // The tray may have changed since it was opened.
        let Some(item) = items.get(self.open) else {
            wishes.push(Wish::Close);
            return;
        };
        let palette = theme::palette(ui.visuals());
        let [back, forth] = [Key::ArrowLeft, Key::ArrowRight]
            .map(|key| ui.input_mut(|input| input.consume_key(Modifiers::NONE, key)));
        let mut turn = |forward: bool| {
            let count = items.len();
            let step = if forward { 1 } else { count - 1 };
            wishes.push(TrayWish::Show((self.open + step) % count));
        };
        if back || forth {
            turn(forth);
        }
        let mut close = false;
        ui.horizontal(|ui| {
            let title = RichText::new(item.title()).heading().color(palette.strong);
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                close = ui.button("Close").clicked();
                if items.len() > 1 {
                    if ui.button("Next").clicked() {
                        turn(true);
                    }
                    if ui.button("Previous").clicked() {
                        turn(false);
                    }
                }
                ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                    ui.add(Label::new(title).truncate());
                });
            });
        });
        if close {
            wishes.push(Wish::Close);
        }
        ui.add_space(8.0);
        let Content::File(film) = &item.content else {
            let colour = match item.content {
                Content::Refused => palette.error,
                _ => palette.text,
            };
            ScrollArea::vertical().show(ui, |ui| {
                ui.set_max_height((size.y - REST).max(80.0));
                ui.label(RichText::new(&item.message).color(colour));
            });
            ui.add_space(8.0);
            if find(ui) {
                wishes.push(TrayWish::Find(self.open));
            }
            return;
        };
        self.picture(ui, vec2(size.x, (size.y - REST).max(80.0)), film, now);
        ui.add_space(8.0);
        let facts = RichText::new(film.facts()).color(palette.text);
        ui.add(Label::new(facts).truncate());
        let message = RichText::new(&item.message).size(12.5).color(palette.weak);
        ui.add(Label::new(message).truncate())
            .on_hover_text(&item.message);
        ui.add_space(4.0);
        ui.horizontal(|ui| {
            let save = RichText::new("Save").color(palette.on_accent);
            let save = ui.add(Button::new(save).fill(palette.accent));
            places::note(ui.ctx(), "save result", save.rect);
            if save.on_hover_text("Write it to a file").clicked() {
                wishes.push(TrayWish::Save(self.open));
            }
            if asset::kind(&film.name) == Some(Kind::Image) && keep(ui, film, kept) {
                wishes.push(TrayWish::Keep(self.open));
            }
            if find(ui) {
                wishes.push(TrayWish::Find(self.open));
            }
        });
    }

    fn picture(&mut self, ui: &mut Ui, size: Vec2, film: &Film, now: f64) {
        let palette = theme::palette(ui.visuals());
        let known = self.view.as_ref();
        if known.is_none_or(|view| !Arc::ptr_eq(&view.bytes, &film.bytes)) {
            self.view = Some(View::new(ui, film, now));
        }
        let Some(view) = &mut self.view else {
            return;
        };
        view.play(ui, film, now);
        // No taller than the picture needs.
        let wanted = view.texture.as_ref().map_or(Vec2::splat(LEAST), |texture| {
            let texture = texture.size_vec2();
            texture * (2.0_f32).min((size.x - 16.0) / texture.x.max(1.0))
        });
        let size = vec2(size.x, (wanted.y + 16.0).clamp(LEAST, size.y.max(LEAST)));
        let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
        response.widget_info(|| {
            egui::WidgetInfo::labeled(egui::Role::Image, true, format!("Picture {}", film.name))
        });
        ui.painter().rect_filled(rect, 6.0, palette.stage);
        match &view.texture {
            Some(texture) => {
                // Small pictures are enlarged at most twice, as they would be blurred.
                let full = contain(texture.size_vec2(), rect.shrink(8.0));
                let scale = (2.0 * texture.size_vec2().x / full.width()).min(1.0);
                let place = egui::Rect::from_center_size(full.center(), full.size() * scale);
                egui::Image::from_texture(texture).paint_at(ui, place);
                places::note(ui.ctx(), "result", place);
            }
            None => {
                ui.painter().text(
                    rect.center(),
                    egui::Align2::CENTER_CENTER,
                    "This picture is damaged: it cannot be shown.",
                    egui::FontId::proportional(14.0),
                    palette.weak,
                );
            }
        }
    }
}
