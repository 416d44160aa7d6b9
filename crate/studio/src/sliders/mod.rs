//! Sliders, colour pickers and drag pads for the variables marked `hot`. Moving one rewrites its
//! number in the text, so that the text stays the only truth and undo works as for typing.

mod pad;

use crate::page::Page;
use crate::panel::Panel;
use crate::slider::{colours, counts, decimals, fitting_range, snap};
use crate::wish::{TextWish, Wishes};
use crate::{places, screen, theme};
use document::session::Session;
use egui::{Context, DragValue, RichText, ScrollArea, Slider, SliderClamping, Ui};
use pad::Bounds;
use rats::{HotValue, HotVariable, Preset, TextEdit, hot};
use std::collections::HashMap;

/// The ranges of the sliders. They do not change while a slider is dragged.
#[derive(Default)]
pub struct Sliders {
    ranges: HashMap<(usize, String), (f64, f64)>,
    dragging: bool,
    /// Height of the rows of the last text without errors.
    height: f32,
}

impl Sliders {
    /// Returns the height of all rows: while the text has errors, that of the last one without, so
    /// that nothing moves.
    pub fn height(&mut self, ui: &Ui, session: &Session) -> f32 {
        if session.errors() == 0 || self.height == 0.0 {
            self.height = height(ui, &session.compilation().hot);
        }
        self.height
    }

    /// Shows a row for each variable.
    fn rows(&mut self, ui: &mut Ui, hot: &[HotVariable], wishes: &mut Wishes) {
        let mut dragging = false;
        let widest = hot
            .iter()
            .map(|variable| variable.name.chars().count())
            .max()
            .unwrap_or(0);
        // In a narrow place most of a row is left for the values.
        let most = (0.3 * ui.available_width()).clamp(32.0, 130.0);
        let name_width = (widest as f32 * 8.3 + 2.0).clamp(32.0, most);
        for variable in hot {
            ui.push_id((variable.file, &variable.name), |ui| {
                ui.horizontal(|ui| {
                    name(ui, &variable.name, name_width);
                    let Some(range) = &variable.literal else {
                        ui.weak(hot::write(&variable.value)).on_hover_text(
                            "This value is computed, so there is no number in the text to move.",
                        );
                        return;
                    };
                    let (held, value) = match variable.value {
                        HotValue::Scalar(value) => {
                            let (held, value) = self.scalar(ui, variable, value);
                            (held, value.map(HotValue::Scalar))
                        }
                        HotValue::Vector(vector) => {
                            let (held, vector) = self.vector(ui, variable, vector);
                            (held, vector.map(HotValue::Vector))
                        }
                        HotValue::Colour(colour) => {
                            let (held, colour) = colour_button(ui, &variable.name, colour);
                            (held, colour.map(HotValue::Colour))
                        }
                    };
                    dragging |= held;
                    if let Some(value) = value {
                        let value = hot::write(&value);
                        let edit = TextEdit::new(variable.file, range.clone(), value);
                        wishes.push(TextWish::edit(edit));
                    }
                });
            });
        }
        wishes.hold_while(dragging, &mut self.dragging);
    }

    /// Shows a slider. Returns whether a drag continues, and the number if it changed.
    fn scalar(
        &mut self,
        ui: &mut Ui,
        variable: &HotVariable,
        mut value: f64,
    ) -> (bool, Option<f64>) {
        let key = (variable.file, variable.name.clone());
        let (given, step) = bounds(variable);
        let fresh = given.unwrap_or_else(|| fitting_range(value));
        let range = match given {
            Some(range) => range,
            None => *self.ranges.entry(key.clone()).or_insert(fresh),
        };
        let (low, high) = range;
        let decimals = if given.is_none() && counts(value) {
            0
        } else {
            decimals(high - low)
        };
        const FIELD: f32 = 66.0;
        let width = ui.available_width() - FIELD - 2.0 * ui.spacing().item_spacing.x;
        let clamping = match given {
            Some(_) => SliderClamping::Edits,
            None => SliderClamping::Never,
        };
        let slider = ui.scope(|ui| {
            colours(ui);
            ui.spacing_mut().slider_width = width.clamp(60.0, 420.0);
            let mut slider = Slider::new(&mut value, low..=high)
                .clamping(clamping)
                .max_decimals(decimals)
                .show_value(false)
                .smart_aim(false);
            if let Some(step) = step {
                slider = slider.step_by(step);
            }
            ui.add(slider)
        });
        let slider = slider.inner.accessible_name(&variable.name);
        places::note(ui.ctx(), format!("slider {}", variable.name), slider.rect);
        let size = egui::vec2(FIELD, ui.spacing().interact_size.y);
        let mut field = DragValue::new(&mut value)
            .speed(step.unwrap_or((high - low) / 500.0))
            .max_decimals(decimals)
            .custom_formatter(|value, _| hot::write(&HotValue::Scalar(value)));
        if given.is_some() {
            field = field.range(low..=high).clamp_existing_to_range(false);
        }
        let field = ui
            .add_sized(size, field)
            .on_hover_text("Drag sideways, or click to type");
        let dragged = slider.dragged() || field.dragged();
        let changed = (slider.changed() || field.changed()) && value.is_finite();
        // At rest the range follows the value, so that a slider at its end can go further.
        if given.is_none() && !dragged && !slider.is_pointer_button_down_on() {
            let inside = value > low + 0.02 * (high - low) || value == low && low == 0.0;
            if !inside || value >= high {
                self.ranges.insert(key, fresh);
            }
        }
        (dragged, changed.then(|| snap(value, low, step, decimals)))
    }

    /// Shows a pad. Returns whether a drag continues, and the vector if it changed.
    fn vector(
        &mut self,
        ui: &mut Ui,
        variable: &HotVariable,
        vector: [f64; 3],
    ) -> (bool, Option<[f64; 3]>) {
        let key = (variable.file, variable.name.clone());
        let (given, step) = bounds(variable);
        let largest = vector.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        let reach = if largest > 0.0 { 2.0 * largest } else { 1.0 };
        let range = match given {
            Some(range) => range,
            None => *self.ranges.entry(key.clone()).or_insert((-reach, reach)),
        };
        let (held, changed) = pad::show(ui, &variable.name, vector, Bounds { range, step });
        let down = ui.input(|input| input.pointer.any_down());
        if given.is_none() && !held && !down && (largest >= range.1 || largest < 0.05 * range.1) {
            self.ranges.insert(key, (-reach, reach));
        }
        (held, changed)
    }
}

impl Panel for Sliders {
    fn show(&mut self, page: &Page, ui: &mut Ui, wishes: &mut Wishes) {
        let palette = theme::palette(ui.visuals());
        places::note(ui.ctx(), "sliders", ui.max_rect());
        let waits = page.work.session.shows_errors();
        let hot = &page.work.session.compilation().hot;
        let has_room = !screen::is_small(ui.ctx());
        if waits || has_room || !hot.is_empty() {
            let (text, colour) = if waits {
                (
                    "Sliders: the picture waits until the errors are mended",
                    palette.error,
                )
            } else {
                ("Sliders", palette.weak)
            };
            let head = ScrollArea::horizontal().id_salt("presets");
            head.auto_shrink([false, true]).show(ui, |ui| {
                ui.horizontal(|ui| {
                    if waits || has_room {
                        ui.label(RichText::new(text).size(12.5).color(colour))
                            .on_hover_text("Variables marked hot in the text");
                    }
                    if !waits {
                        preset_buttons(ui, &page.work.session, wishes);
                    }
                });
            });
        }
        ScrollArea::vertical()
            .id_salt("sliders")
            .min_scrolled_height(0.0)
            .auto_shrink(false)
            .show(ui, |ui| self.rows(ui, hot, wishes));
    }

    fn forget(&mut self, _page: &mut Page, _ctx: &Context) {
        self.ranges.clear();
        self.height = 0.0;
    }
}

/// Shows a button for each preset of the text, and one that writes a new one.
fn preset_buttons(ui: &mut Ui, session: &Session, wishes: &mut Wishes) {
    let compiled = session.compilation();
    for (index, preset) in compiled.presets.iter().enumerate() {
        let button = ui.push_id(index, |ui| {
            ui.button(RichText::new(&preset.name).size(12.5))
                .on_hover_text("Set the sliders to this preset")
        });
        let button = button.inner;
        places::note(ui.ctx(), format!("preset {}", preset.name), button.rect);
        if button.clicked() {
            let edits = edits_of(preset, &compiled.hot);
            wishes.push(TextWish::Edit { edits, step: true });
        }
    }
    let Some(edit) = keep(session) else {
        return;
    };
    let button = ui.button(RichText::new("Keep").size(12.5));
    places::note(ui.ctx(), "keep preset", button.rect);
    let button = button.on_hover_text("Write these values into the text, as a preset");
    if button.clicked() {
        wishes.push(TextWish::step(edit));
    }
}

/// Returns the changes of the text that a preset asks for, in its order.
fn edits_of(preset: &Preset, hot: &[HotVariable]) -> Vec<TextEdit> {
    let mut edits: Vec<TextEdit> = Vec::new();
    for variable in hot {
        let mut values = preset.values.iter().rev();
        let value = values.find(|(name, _)| *name == variable.name);
        if let (Some((_, value)), Some(range)) = (value, &variable.literal) {
            let edit = TextEdit::new(variable.file, range.clone(), hot::write(value));
            edits.push(edit);
        }
    }
    edits.sort_by_key(|edit| (edit.file, edit.span.start));
    edits
}

/// Returns the change that writes a preset of the present values below the last variable; `None`
/// if there are no sliders.
fn keep(session: &Session) -> Option<TextEdit> {
    let compiled = session.compilation();
    let all = compiled.hot.iter().filter(|hot| hot.literal.is_some());
    let last = all.clone().next_back()?;
    let names = (1..).map(|number| format!("set{number}"));
    let mut free = names.filter(|name| compiled.presets.iter().all(|known| known.name != *name));
    let mut line = format!("preset {}", free.next()?);
    for variable in all {
        line += &format!(", set {} {}", variable.name, hot::write(&variable.value));
    }
    let (text, end) = (session.text(last.file), last.literal.as_ref()?.end);
    let end = text
        .get(end..)?
        .find('\n')
        .map_or(text.len(), |far| end + far);
    Some(TextEdit::new(last.file, end..end, format!("\n{line}")))
}

/// Returns the height of the rows of these variables together.
fn height(ui: &Ui, hot: &[HotVariable]) -> f32 {
    let spacing = ui.spacing();
    hot.iter()
        .map(|variable| match (&variable.value, &variable.literal) {
            (HotValue::Vector(_), Some(_)) => pad::height(ui),
            _ => spacing.interact_size.y,
        })
        .map(|height| height + spacing.item_spacing.y)
        .sum()
}

/// Returns the range and the step that the text gives a variable.
fn bounds(variable: &HotVariable) -> (Option<(f64, f64)>, Option<f64>) {
    let range = variable.range.filter(|[low, high]| low < high);
    (range.map(|[low, high]| (low, high)), variable.step)
}

fn name(ui: &mut Ui, name: &str, width: f32) {
    let palette = theme::palette(ui.visuals());
    let name = RichText::new(name).monospace().color(palette.text);
    let height = ui.spacing().interact_size.y;
    ui.allocate_ui_with_layout(
        egui::vec2(width, height),
        egui::Layout::left_to_right(egui::Align::Center),
        |ui| {
            ui.set_min_width(width);
            ui.add(egui::Label::new(name).truncate());
        },
    );
}

/// Shows a colour picker. Returns whether a drag continues, and the colour if it changed.
fn colour_button(ui: &mut Ui, name: &str, colour: [f32; 3]) -> (bool, Option<[f32; 3]>) {
    // With gamma 1, the default, a colour's numbers go to the screen as they are.
    let mut bytes = colour.map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8);
    let button = ui
        .color_edit_button_srgb(&mut bytes)
        .accessible_name(format!("Colour {name}"))
        .on_hover_text("Choose a colour");
    places::note(ui.ctx(), format!("colour {name}"), button.rect);
    let changed = button.changed();
    // The picker is a popup of its own; while the pointer is down in it, a drag goes on.
    let held = changed && ui.input(|input| input.pointer.any_down());
    (
        held,
        changed.then(|| bytes.map(|byte| f32::from(byte) / 255.0)),
    )
}
