//! A knob on the picture that stands for numbers of the text: dragged by the pointer or a finger,
//! or moved by the arrow keys.

use crate::places;
use crate::wish::{TextWish, Wishes};
use assist::handles::{Editable, Handle};
use egui::{
    Align2, Color32, CursorIcon, EventFilter, FontId, Key, Painter, Pos2, Rect, Role, Sense,
    Stroke, Ui, Vec2, WidgetInfo, vec2,
};
use glam::DVec3;
use sketch::Sight;

/// The colour of bones and knobs.
pub const LIT: Color32 = Color32::from_rgb(255, 222, 122);

/// Input on a knob in one frame.
pub struct Answer {
    /// A drag begins.
    pub begins: bool,
    /// Movement by the pointer in points.
    pub pulled: Vec2,
    /// Movement by keys in points.
    pub nudged: Vec2,
    /// Whether moving up means away from the eye.
    pub deep: bool,
}

/// Moves what a knob stands for as its answer says, and begins its drag. `drag` is the knob that is
/// held, with the place to which the pointer has dragged it, before its numbers' limits. Returns
/// the place to which the knob goes, if it moves.
pub fn follow(
    answer: &Answer,
    (index, place): (usize, DVec3),
    drag: &mut Option<(usize, DVec3)>,
    sight: &Sight,
    wishes: &mut Wishes,
) -> Option<DVec3> {
    if answer.begins {
        wishes.push(TextWish::Hold);
        *drag = Some((index, place));
    }
    let mut target = None;
    if let Some((held, to)) = drag
        && *held == index
        && answer.pulled != Vec2::ZERO
    {
        *to = sight.drag(*to, answer.pulled, answer.deep);
        target = Some(*to);
    }
    if answer.nudged != Vec2::ZERO {
        target = Some(sight.drag(place, answer.nudged, answer.deep));
    }
    target
}

/// Ends a drag whose pointer is up.
pub fn release(drag: &mut Option<(usize, DVec3)>, ui: &Ui, wishes: &mut Wishes) {
    if drag.is_some() && !ui.input(|input| input.pointer.any_down()) {
        *drag = None;
        wishes.push(TextWish::Release);
    }
}

/// Shows a knob at `at`. `rect` is the picture's place.
pub fn show(
    ui: &mut Ui,
    painter: &Painter,
    rect: Rect,
    index: usize,
    at: Pos2,
    handle: &Handle,
    touch: bool,
) -> Answer {
    let (radius, reach) = if touch { (8.0, 20.0) } else { (5.0, 10.0) };
    let fixed = match &handle.edit {
        Editable::Fixed { why } => Some(why.as_str()),
        Editable::Literal { .. } => None,
    };
    let id = ui.scope_id().with(("hand", index));
    let place = Rect::from_center_size(at, Vec2::splat(2.0 * reach));
    let response = ui.interact(place, id, Sense::drag());
    places::note(ui.ctx(), format!("hand {}", handle.label), place);
    response.widget_info(|| {
        let label = match fixed {
            Some(why) => format!("{}: {why}", handle.label),
            None => handle.label.clone(),
        };
        let mut info = WidgetInfo::labeled(Role::Slider, fixed.is_none(), label);
        info.current_text_value = Some(handle.text());
        info
    });
    let live = response.hovered() || response.dragged() || response.has_focus();
    let dark = Stroke::new(if live { 3.0 } else { 2.0 }, Color32::from_black_alpha(170));
    let size = if live { radius + 1.5 } else { radius };
    if fixed.is_some() {
        painter.circle_stroke(at, size, Stroke::new(4.0, dark.color));
        painter.circle_stroke(at, size, Stroke::new(1.6, LIT));
    } else {
        painter.circle(at, size, LIT, dark);
    }
    if response.has_focus() {
        painter.circle_stroke(at, size + 3.0, Stroke::new(1.5, Color32::WHITE));
    }
    if live {
        caption(painter, rect, at - vec2(0.0, size + 8.0), handle, fixed);
    }
    let response =
        response.on_hover_and_drag_cursor(match (fixed, ui.input(|i| i.pointer.any_down())) {
            (Some(_), _) => CursorIcon::NotAllowed,
            (None, true) => CursorIcon::Grabbing,
            (None, false) => CursorIcon::Grab,
        });
    if response.drag_started() {
        response.request_focus();
    }
    let (nudged, deeper) = if response.has_focus() {
        keys(ui, &response)
    } else {
        (Vec2::ZERO, false)
    };
    let movable = fixed.is_none();
    Answer {
        begins: movable && response.drag_started(),
        pulled: if movable && response.dragged() {
            response.drag_delta()
        } else {
            Vec2::ZERO
        },
        nudged: if movable { nudged } else { Vec2::ZERO },
        deep: deeper || ui.input(|input| input.modifiers.shift),
    }
}

/// Returns the movement by keys of the knob that has the focus, and whether up means away from the
/// eye.
fn keys(ui: &Ui, response: &egui::Response) -> (Vec2, bool) {
    /// Points that a press of an arrow moves.
    const STEP: f32 = 6.0;
    let filter = EventFilter {
        horizontal_arrows: true,
        vertical_arrows: true,
        ..EventFilter::default()
    };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
    ui.input(|input| {
        let presses =
            |more, less| STEP * (input.num_presses(more) as f32 - input.num_presses(less) as f32);
        let deep = presses(Key::PageUp, Key::PageDown);
        if deep != 0.0 {
            return (vec2(0.0, -deep), true);
        }
        let across = presses(Key::ArrowRight, Key::ArrowLeft);
        (vec2(across, presses(Key::ArrowDown, Key::ArrowUp)), false)
    })
}

/// Draws the label beside a knob.
fn caption(painter: &Painter, rect: Rect, at: Pos2, handle: &Handle, fixed: Option<&str>) {
    let mut text = format!("{}  {}", handle.label, handle.text());
    if let Some(why) = fixed {
        text += &format!("\nfixed: it {why}");
    }
    let font = FontId::proportional(12.5);
    let width = (rect.width() - 24.0).clamp(60.0, 320.0);
    let galley = painter.layout(text, font, Color32::from_gray(240), width);
    let place = Align2::CENTER_BOTTOM
        .anchor_size(at, galley.size())
        .expand2(vec2(8.0, 4.0));
    // All of it within the picture, below the knob if there is no room above.
    let mut shift = Vec2::ZERO;
    shift.x =
        (rect.left() + 4.0 - place.left()).max(0.0) + (rect.right() - 4.0 - place.right()).min(0.0);
    if place.top() < rect.top() + 4.0 {
        shift.y = place.height() + 30.0;
    }
    let place = place.translate(shift);
    painter.rect_filled(place, 7.0, Color32::from_black_alpha(175));
    painter.galley(place.min + vec2(8.0, 4.0), galley, Color32::WHITE);
}

/// Draws a line through places, bright within a dark seam, so that it is seen on any picture.
pub fn stroke(painter: &Painter, sight: &Sight, places: &[DVec3], strength: f32) {
    let pieces: Vec<_> = places
        .windows(2)
        .filter_map(|ends| sight.line(ends[0], ends[1]))
        .collect();
    for (width, colour) in [(3.6, Color32::from_black_alpha(110)), (1.5, LIT)] {
        let stroke = Stroke::new(width, colour.gamma_multiply(strength));
        for piece in &pieces {
            painter.line_segment(*piece, stroke);
        }
    }
}
