//! Controls for a hot vector: a square in which dragging sets x and y, a slim slider beside it for
//! z, and three fields for exact numbers. The wheel over the square and Page Up and Page Down move
//! z too.

use crate::{places, slider, theme};
use egui::{
    DragValue, EventFilter, Key, Pos2, Rect, Response, Role, Sense, Slider, Stroke, Ui, Vec2,
    WidgetInfo, pos2, vec2,
};
use rats::{HotValue, hot};

/// Limits of the numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Smallest and largest number that the square and the slider reach.
    pub range: (f64, f64),
    /// Step of the numbers, counted from the smallest.
    pub step: Option<f64>,
}

impl Bounds {
    /// Returns the nearest number that these bounds allow, without digits finer than a pixel.
    fn snap(self, value: f64) -> f64 {
        let (low, high) = self.range;
        let value = value.clamp(low, high);
        slider::snap(value, low, self.step, slider::decimals(high - low))
    }
}

/// Space between the three fields.
const GAP: f32 = 3.0;
/// Width of the slider for z.
const RAIL: f32 = 18.0;
/// Width of an axis's letter and the space behind it.
const AXIS: f32 = 16.0;
/// Width of a field.
const FIELD: f32 = 68.0;

/// Returns the height of the controls.
#[must_use]
pub fn height(ui: &Ui) -> f32 {
    3.0 * ui.spacing().interact_size.y + 2.0 * GAP
}

/// Shows the controls. Returns whether a drag continues, and the vector if it changed.
pub fn show(
    ui: &mut Ui,
    name: &str,
    mut vector: [f64; 3],
    bounds: Bounds,
) -> (bool, Option<[f64; 3]>) {
    let before = vector;
    let side = height(ui);
    // The square gives way to the fields where the row is narrow.
    let beside = RAIL + AXIS + FIELD + 3.0 * ui.spacing().item_spacing.x;
    let width = (ui.available_width() - beside).clamp(48.0, side);
    let square = square(ui, name, &mut vector, bounds, vec2(width, side));
    let (low, high) = bounds.range;
    let rail = ui.scope(|ui| {
        slider::colours(ui);
        ui.spacing_mut().slider_width = side;
        ui.spacing_mut().interact_size.y = RAIL;
        let mut z = vector[2].clamp(low, high);
        let rail = ui.add(
            Slider::new(&mut z, low..=high)
                .vertical()
                .show_value(false)
                .smart_aim(false),
        );
        if rail.changed() {
            vector[2] = bounds.snap(z);
        }
        rail
    });
    let rail = rail
        .inner
        .accessible_name(format!("{name}, z"))
        .on_hover_text("z");
    places::note(ui.ctx(), format!("slider {name} z"), rail.rect);
    let mut dragging = square.dragged() || rail.dragged();
    ui.vertical(|ui| {
        ui.spacing_mut().item_spacing.y = GAP;
        for (axis, value) in ["x", "y", "z"].into_iter().zip(&mut vector) {
            ui.horizontal(|ui| {
                ui.spacing_mut().item_spacing.x = 6.0;
                ui.weak(axis);
                let width = ui.available_width().clamp(36.0, FIELD);
                let size = vec2(width, ui.spacing().interact_size.y);
                let field = DragValue::new(value)
                    .speed((high - low) / 500.0)
                    .max_decimals(4)
                    .custom_formatter(|value, _| hot::write(&HotValue::Scalar(value)));
                let field = ui
                    .add_sized(size, field)
                    .accessible_name(format!("{name}, {axis}"))
                    .on_hover_text("Drag sideways, or click to type");
                dragging |= field.dragged();
            });
        }
    });
    let changed = vector != before && vector.iter().all(|v| v.is_finite());
    (dragging, changed.then_some(vector))
}

/// Shows the square with a dot at x and y. Changes the vector by pointer, keys and wheel.
fn square(ui: &mut Ui, name: &str, vector: &mut [f64; 3], bounds: Bounds, size: Vec2) -> Response {
    let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
    places::note(ui.ctx(), format!("pad {name}"), rect);
    if let Some(at) = response.interact_pointer_pos()
        && (response.dragged() || response.clicked())
    {
        let [x, y] = numbers(at, rect, bounds.range);
        vector[0] = bounds.snap(x);
        vector[1] = bounds.snap(y);
        response.request_focus();
    }
    let moved = keys(ui, &response, bounds) + wheel(ui, &response, bounds);
    for (value, by) in vector.iter_mut().zip([moved.x, moved.y, moved.z]) {
        if by != 0.0 {
            *value = bounds.snap(*value + by);
        }
    }
    response.widget_info(|| {
        let mut info = WidgetInfo::labeled(Role::Slider, true, format!("{name}, x and y"));
        info.current_text_value = Some(format!("{}, {}", vector[0], vector[1]));
        info
    });
    paint(ui, &response, rect, *vector, bounds.range);
    response.on_hover_text("Drag or arrow keys: x and y. Wheel, Page Up and Page Down: z.")
}

/// Returns x and y at the pointer; y grows upwards.
fn numbers(at: Pos2, rect: Rect, (low, high): (f64, f64)) -> [f64; 2] {
    let share = (at - rect.min) / rect.size();
    [share.x, 1.0 - share.y].map(|share| low + f64::from(share.clamp(0.0, 1.0)) * (high - low))
}

/// Returns the position of x and y in the square.
fn place(x: f64, y: f64, rect: Rect, (low, high): (f64, f64)) -> Pos2 {
    let [x, y] = [x, y].map(|value| ((value - low) / (high - low)).clamp(0.0, 1.0) as f32);
    pos2(
        rect.left() + x * rect.width(),
        rect.bottom() - y * rect.height(),
    )
}

/// Returns the movement of the vector by keys.
fn keys(ui: &Ui, response: &Response, bounds: Bounds) -> glam::DVec3 {
    if !response.has_focus() {
        return glam::DVec3::ZERO;
    }
    let filter = EventFilter {
        horizontal_arrows: true,
        vertical_arrows: true,
        ..EventFilter::default()
    };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
    let (low, high) = bounds.range;
    ui.input(|input| {
        let small = bounds.step.unwrap_or((high - low) / 100.0);
        let step = if input.modifiers.shift {
            10.0 * small
        } else {
            small
        };
        let times =
            |more, less| step * (input.num_presses(more) as f64 - input.num_presses(less) as f64);
        glam::DVec3::new(
            times(Key::ArrowRight, Key::ArrowLeft),
            times(Key::ArrowUp, Key::ArrowDown),
            times(Key::PageUp, Key::PageDown),
        )
    })
}

/// Returns the movement of z by the wheel over the square. The list does not scroll meanwhile.
fn wheel(ui: &Ui, response: &Response, bounds: Bounds) -> glam::DVec3 {
    /// Points of scrolling from one end of the range to the other.
    const WHOLE: f64 = 1200.0;
    if !response.hovered() {
        return glam::DVec3::ZERO;
    }
    let scrolled = ui.input_mut(|input| std::mem::take(&mut input.smooth_scroll_delta).y);
    let (low, high) = bounds.range;
    let by = f64::from(scrolled) / WHOLE * (high - low);
    // Less than half a step would be rounded away.
    let by = match bounds.step {
        Some(step) if by != 0.0 && by.abs() < step => step.copysign(by),
        _ => by,
    };
    glam::DVec3::new(0.0, 0.0, by)
}

fn paint(ui: &Ui, response: &Response, rect: Rect, vector: [f64; 3], range: (f64, f64)) {
    let palette = theme::palette(ui.visuals());
    let painter = ui.painter_at(rect);
    let round = f32::from(theme::ROUND);
    painter.rect_filled(rect, round, palette.paper);
    let line = Stroke::new(1.0, palette.line);
    let zero = place(0.0, 0.0, rect, range);
    painter.vline(zero.x, rect.y_range(), line);
    painter.hline(rect.x_range(), zero.y, line);
    let edge = if response.has_focus() {
        palette.accent
    } else if response.hovered() {
        palette.weak
    } else {
        palette.line
    };
    let edge = Stroke::new(1.0, edge);
    painter.rect_stroke(rect, round, edge, egui::StrokeKind::Inside);
    let dot = place(vector[0], vector[1], rect.shrink(4.0), range);
    painter.circle_filled(dot, 4.5, palette.accent);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_and_numbers_belong_together() {
        let rect = Rect::from_min_size(pos2(10.0, 20.0), vec2(100.0, 100.0));
        let range = (-2.0, 2.0);
        assert_eq!(numbers(pos2(10.0, 20.0), rect, range), [-2.0, 2.0]);
        assert_eq!(numbers(pos2(999.0, 999.0), rect, range), [2.0, -2.0]);
        assert_eq!(place(0.0, 1.0, rect, range), pos2(60.0, 45.0));
        assert_eq!(place(f64::NAN, 9.0, rect, range).y, 20.0);
    }

    #[test]
    fn numbers_keep_to_their_bounds_and_steps() {
        let bounds = Bounds {
            range: (0.0, 1.0),
            step: Some(0.25),
        };
        assert_eq!(bounds.snap(0.3), 0.25);
        assert_eq!(bounds.snap(7.0), 1.0);
        let free = Bounds {
            step: None,
            ..bounds
        };
        assert_eq!(free.snap(1.0 / 3.0), 0.333);
    }
}
