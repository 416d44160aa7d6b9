//! The controls of the lessons, all of one kind: sliders under their names, chips for kernels,
//! choices side by side.

use crate::plot;
use egui::{
    Button, Color32, Rect, Response, RichText, Sense, Slider, Stroke, StrokeKind, Ui, vec2,
};
use field::Kernel;
use widgets::{places, slider, theme};

/// Width of the controls beside a figure.
const SIDE: f32 = 292.0;

/// A figure's place and, beside or below it, that of its controls.
pub struct Stage {
    /// Place of the figure.
    pub figure: Rect,
    /// Place of the controls.
    pub controls: Ui,
}

impl Stage {
    /// Takes the room. On a narrow page the figure is `tall` times as high as wide.
    pub fn new(ui: &mut Ui, narrow: bool, height: f32, tall: f32) -> Self {
        let all = ui.available_rect_before_wrap();
        let (figure, controls) = if narrow {
            let size = vec2(all.width(), (all.width() * tall).clamp(240.0, 460.0));
            let figure = Rect::from_min_size(all.min, size);
            let below = all.with_min_y(figure.bottom() + 12.0);
            (figure, below)
        } else {
            let split = all.right() - SIDE;
            let figure = all.with_max_x(split - 22.0).with_max_y(all.top() + height);
            (figure, all.with_min_x(split).with_max_y(all.top() + height))
        };
        ui.expand_to_include_rect(figure);
        let mut controls = ui.new_child(places::part("lab controls", controls));
        controls.spacing_mut().item_spacing.y = 5.0;
        places::note(ui.ctx(), "lab figure", figure);
        Self { figure, controls }
    }

    /// Goes on below both.
    pub fn finish(self, ui: &mut Ui) {
        let all = self.figure.union(self.controls.min_rect());
        ui.allocate_rect(all, Sense::hover());
    }
}

/// Computes a value anew if it is not the one of the key.
pub fn renew<K: PartialEq, V>(kept: &mut Option<(K, V)>, key: K, compute: impl FnOnce(&K) -> V) {
    if kept.as_ref().is_none_or(|(known, _)| *known != key) {
        let value = compute(&key);
        *kept = Some((key, value));
    }
}

/// Draws a slider under its name and value.
pub fn slider(
    ui: &mut Ui,
    name: &str,
    value: &mut f64,
    range: core::ops::RangeInclusive<f64>,
    unit: &str,
) -> Response {
    let palette = theme::palette(ui.visuals());
    let width = ui.available_width();
    ui.scope(|ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        ui.horizontal(|ui| {
            ui.spacing_mut().interact_size.y = 20.0;
            ui.label(RichText::new(name).size(13.5).color(palette.text));
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                let text = format!("{}{unit}", plot::number(*value));
                ui.label(RichText::new(text).size(13.5).color(palette.strong));
            });
        });
        slider::colours(ui);
        ui.spacing_mut().slider_width = width.min(520.0);
        let slider = ui
            .add(Slider::new(value, range).show_value(false).smart_aim(false))
            .accessible_name(name);
        places::note(ui.ctx(), format!("lab slider {name}"), slider.rect);
        ui.add_space(4.0);
        slider
    })
    .inner
}

/// Draws choices side by side; returns whether another one was taken.
pub fn choice<T: PartialEq + Copy>(ui: &mut Ui, value: &mut T, choices: &[(T, &str)]) -> bool {
    let palette = theme::palette(ui.visuals());
    let before = *value;
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = vec2(4.0, 4.0);
        for (choice, text) in choices {
            let chosen = *choice == *value;
            let colour = if chosen { palette.strong } else { palette.weak };
            let button = Button::new(RichText::new(*text).size(13.5).color(colour))
                .fill(if chosen {
                    palette.button
                } else {
                    Color32::TRANSPARENT
                })
                .stroke(Stroke::new(1.0, palette.line));
            let button = ui.add(button);
            places::note(ui.ctx(), format!("lab choice {text}"), button.rect);
            if button.clicked() {
                *value = *choice;
            }
        }
    });
    *value != before
}

/// Draws a name above some controls.
pub fn heading(ui: &mut Ui, text: &str) {
    let palette = theme::palette(ui.visuals());
    ui.add_space(4.0);
    ui.label(RichText::new(text).size(12.5).color(palette.weak));
}

/// Draws a remark.
pub fn remark(ui: &mut Ui, text: impl Into<String>) {
    let palette = theme::palette(ui.visuals());
    ui.label(RichText::new(text).size(13.0).color(palette.weak));
}

/// Draws a number with its name.
pub fn reading(ui: &mut Ui, name: &str, value: &str, colour: Color32) {
    let palette = theme::palette(ui.visuals());
    ui.horizontal(|ui| {
        ui.spacing_mut().interact_size.y = 22.0;
        ui.label(RichText::new(name).size(13.5).color(palette.text));
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            ui.label(RichText::new(value).size(14.5).color(colour).strong());
        });
    });
}

/// Draws chips for the kernels, each with a sample of its line; returns the one that was clicked.
pub fn kernels(ui: &mut Ui, is_chosen: impl Fn(Kernel) -> bool) -> Option<Kernel> {
    let palette = theme::palette(ui.visuals());
    let mut clicked = None;
    let height = ui.spacing().interact_size.y.max(28.0);
    let columns = if ui.available_width() > 330.0 { 3 } else { 2 };
    let gap = 6.0;
    let width = ((ui.available_width() + gap) / columns as f32 - gap).floor();
    for row in Kernel::ALL.chunks(columns) {
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = gap;
            for &kernel in row {
                let chosen = is_chosen(kernel);
                let (rect, response) = ui.allocate_exact_size(vec2(width, height), Sense::click());
                response.widget_info(|| {
                    let name = kernel.name();
                    egui::WidgetInfo::selected(egui::Role::CheckBox, true, chosen, name)
                });
                places::note(ui.ctx(), format!("lab kernel {}", kernel.name()), rect);
                let fill = if chosen {
                    palette.button
                } else if response.hovered() || response.has_focus() {
                    palette.hover
                } else {
                    Color32::TRANSPARENT
                };
                let line = if chosen { palette.weak } else { palette.line };
                let painter = ui.painter();
                let line = Stroke::new(1.0, line);
                painter.rect(rect, 6.0, fill, line, StrokeKind::Inside);
                let y = rect.center().y;
                sample_line(ui, kernel, [rect.left() + 9.0, rect.left() + 31.0], y);
                painter.text(
                    egui::pos2(rect.left() + 39.0, y),
                    egui::Align2::LEFT_CENTER,
                    kernel.name(),
                    egui::FontId::proportional(13.5),
                    if chosen { palette.strong } else { palette.text },
                );
                if response
                    .on_hover_cursor(egui::CursorIcon::PointingHand)
                    .clicked()
                {
                    clicked = Some(kernel);
                }
            }
        });
    }
    clicked
}

/// Draws a sample of a kernel's line: dashed if the kernel ends.
fn sample_line(ui: &Ui, kernel: Kernel, [from, to]: [f32; 2], y: f32) {
    let stroke = Stroke::new(2.5, hue(ui, kernel));
    let ends = [egui::pos2(from, y), egui::pos2(to, y)];
    if kernel.is_compact() {
        let dashes = egui::Shape::dashed_line(&ends, stroke, 6.0, 3.0);
        ui.painter().extend(dashes);
    } else {
        ui.painter().line_segment(ends, stroke);
    }
}

/// Returns the colour of a kernel.
#[must_use]
pub fn hue(ui: &Ui, kernel: Kernel) -> Color32 {
    let index = Kernel::ALL.iter().position(|k| *k == kernel);
    plot::hue(ui, index.unwrap_or(0))
}
