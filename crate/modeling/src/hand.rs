//! The work of pointer, pen, fingers and keys in the place.

use crate::brush::{Doing, round, round_vector};
use crate::grip::{Modal, Ongoing, Setting, State};
use crate::state::{Command, Outside, Sculpting, Turning};
use egui::{Event, Key, Modifiers, PointerButton, Pos2, Rect, Sense, Ui, Vec2};
use glam::{DQuat, DVec3};
use sculpt::{PathPoint, Refinement, RegionChange, Stroke};

/// Seconds after which a second finger ends a stroke in place of giving it up.
const FIRM: f64 = 0.4;
/// Share of the tool's size by which a push goes into the surface.
const DEPTH: f64 = 0.4;
/// Points of movement that double the tool in S and F.
const DOUBLE: f32 = 140.0;

/// Names the axis that a movement keeps to.
fn in_words(axis: Option<usize>) -> &'static str {
    axis.map_or("", |i| [" along x", " along y", " along z"][i])
}

/// Returns a line on what a hand can do now.
pub fn hint(place: &Sculpting, narrow: bool) -> String {
    match &place.hand.doing {
        State::Stroke(on) if on.is_free => {
            format!(
                "Grab{} · X, Y, Z: one axis · click: let go · Esc: give up",
                in_words(on.axis)
            )
        }
        State::Modal(modal) => {
            let what = match modal.what {
                Setting::Turn => "Turn the tool",
                Setting::Scale => "Scale the tool",
                Setting::Size => "Size of the tool",
                Setting::Range => "Range of the decay",
            };
            format!(
                "{what}{} · click: take it · Esc: as it was",
                in_words(modal.axis)
            )
        }
        _ if narrow => format!(
            "{}: a finger on the mesh · two fingers turn and zoom",
            place.brush.doing.name()
        ),
        _ => format!(
            "{}: drag on the mesh · drag beside it: turn · wheel: zoom · ?: all keys",
            place.brush.doing.name()
        ),
    }
}

/// Takes what the pointer does on the mesh in `rect`.
pub fn pointer(
    place: &mut Sculpting,
    outside: &Outside,
    ui: &mut Ui,
    rect: Rect,
    commands: &mut Vec<Command>,
) {
    let response = ui.interact(
        rect,
        ui.scope_id().with("sculpture"),
        Sense::click_and_drag(),
    );
    response.widget_info(|| {
        egui::WidgetInfo::labeled(egui::Role::Image, true, "The mesh that is sculpted")
    });
    let over = response.contains_pointer() || response.is_pointer_button_down_on();
    if fingers(place, outside, ui, rect, commands) {
        return;
    }
    let (at, moves, modifiers, pressed, any_down) = ui.input(|input| {
        let moves = input.events.iter().filter_map(|event| match event {
            Event::PointerMoved(at) => Some(*at),
            _ => None,
        });
        let pressed = [
            PointerButton::Primary,
            PointerButton::Secondary,
            PointerButton::Middle,
        ]
        .into_iter()
        .find(|button| input.pointer.button_pressed(*button));
        (
            input.pointer.latest_pos(),
            moves.collect::<Vec<Pos2>>(),
            input.modifiers,
            pressed,
            input.pointer.any_down(),
        )
    });
    let pressure = pressure(outside);
    let Some(at) = at else {
        // A finger was lifted.
        place.hand.shown = None;
        if !any_down && !matches!(place.hand.doing, State::Modal(_)) {
            finish(place, true, commands);
        }
        return;
    };
    if let Some(at) = place.hand.grabs.take() {
        begin_stroke(place, outside, rect, at, Modifiers::NONE, 1.0, true);
    }
    if let Some(at) = place.hand.centers.take()
        && let Some(found) = place.pick(rect, at)
    {
        place.view.center_on(found.point);
    }
    match &place.hand.doing {
        State::Idle => {
            if let (Some(button), true) = (pressed, over && rect.contains(at)) {
                begin(place, outside, rect, at, button, modifiers, pressure);
            }
        }
        State::Fingers if !any_down => place.hand.doing = State::Idle,
        State::Stroke(on) if on.is_free && pressed.is_some() => {
            finish(place, pressed == Some(PointerButton::Primary), commands);
        }
        State::Modal(_) if pressed.is_some() => {
            end_modal(place, pressed == Some(PointerButton::Primary))
        }
        _ => {}
    }
    let moves = if moves.is_empty() { vec![at] } else { moves };
    for to in moves {
        follow_pointer(place, rect, to, modifiers, pressure);
    }
    let is_held = matches!(&place.hand.doing, State::Stroke(on) if !on.is_free)
        || matches!(place.hand.doing, State::Turn(_) | State::Shift(_));
    if is_held && !any_down {
        finish(place, true, commands);
    }
    hover(place, rect, at, over, modifiers);
    if over {
        let zoom = ui.input(|input| {
            let scroll = f64::from(input.smooth_scroll_delta().y);
            libm::exp(scroll / 600.0) * f64::from(input.zoom_delta())
        });
        if zoom != 1.0 {
            place.view.zoom(zoom);
        }
    }
    if !matches!(place.hand.doing, State::Idle) {
        ui.ctx().request_repaint();
    }
}

/// The pressure of a pen; what has none presses fully.
fn pressure(outside: &Outside) -> f64 {
    let pressure = outside.pressure.unwrap_or(1.0);
    round(f64::from(pressure.clamp(0.02, 1.0)), 2)
}

/// Turns, zooms and rolls by two fingers. Returns whether they are down.
fn fingers(
    place: &mut Sculpting,
    outside: &Outside,
    ui: &Ui,
    rect: Rect,
    commands: &mut Vec<Command>,
) -> bool {
    let Some(touch) = ui.input(egui::InputState::multi_touch) else {
        return false;
    };
    if let State::Stroke(on) = &place.hand.doing {
        // The first finger of two is no stroke.
        let is_firm = outside.now - on.began > FIRM;
        finish(place, is_firm, commands);
    }
    place.hand.doing = State::Fingers;
    place.hand.shown = None;
    let from = touch.center_pos - touch.translation_delta;
    turn(place, rect, from, touch.center_pos);
    place.view.zoom(f64::from(touch.zoom_delta));
    let half = -0.5 * f64::from(touch.rotation_delta);
    let back = place.view.axes()[2] * libm::sin(half);
    let roll = DQuat::from_xyzw(back.x, back.y, back.z, libm::cos(half));
    place.view.rotation = (roll.inverse() * place.view.rotation).normalize();
    ui.ctx().request_repaint();
    true
}

fn begin(
    place: &mut Sculpting,
    outside: &Outside,
    rect: Rect,
    at: Pos2,
    button: PointerButton,
    modifiers: Modifiers,
    pressure: f64,
) {
    let found = (button == PointerButton::Primary).then(|| place.pick(rect, at));
    match found.flatten() {
        Some(_) => begin_stroke(place, outside, rect, at, modifiers, pressure, false),
        None if button == PointerButton::Middle && modifiers.shift => {
            place.hand.doing = State::Shift(at);
        }
        None => place.hand.doing = State::Turn(at),
    }
}

fn begin_stroke(
    place: &mut Sculpting,
    outside: &Outside,
    rect: Rect,
    at: Pos2,
    modifiers: Modifiers,
    pressure: f64,
    is_free: bool,
) {
    let Some(found) = place.pick(rect, at) else {
        return;
    };
    let doing = match (is_free, modifiers.shift) {
        (true, _) => Doing::Pull,
        (false, true) => Doing::Smooth,
        (false, false) => place.brush.doing,
    };
    let reverses = modifiers.command || modifiers.ctrl;
    let sweep = place.brush.sweep(doing, reverses, place.decimals);
    let center = center(place, doing, reverses, found.point, found.normal);
    let point = PathPoint {
        position: round_vector(center, place.decimals),
        pressure: if is_free { 1.0 } else { pressure },
    };
    let goes_along = doing != Doing::Pull;
    let seen = goes_along.then(|| (place.frame.clone(), place.surface.clone(), place.view));
    place.document.begin(sweep);
    place.document.drag(point);
    place.hand.doing = State::Stroke(Box::new(Ongoing {
        doing,
        reverses,
        seen,
        depth: place.view.depth(found.point),
        grip: found.point,
        normal: found.normal,
        axis: None,
        last: point,
        began: outside.now,
        is_free,
    }));
    place.hand.shown = Some(point.position);
}

/// Returns the tool's centre when it touches a point of the surface.
fn center(place: &Sculpting, doing: Doing, reverses: bool, point: DVec3, normal: DVec3) -> DVec3 {
    if doing != Doing::Push {
        return point;
    }
    let gauge = place.brush.tool(place.decimals).gauge(normal);
    let reach = if gauge > 0.0 { 1.0 / gauge } else { 0.0 };
    let side = if reverses { DEPTH - 1.0 } else { 1.0 - DEPTH };
    point + normal * (reach * side)
}

fn follow_pointer(
    place: &mut Sculpting,
    rect: Rect,
    to: Pos2,
    modifiers: Modifiers,
    pressure: f64,
) {
    let mut doing = core::mem::take(&mut place.hand.doing);
    match &mut doing {
        State::Stroke(on) => follow_stroke(place, rect, to, on, pressure),
        State::Turn(from) => {
            turn(place, rect, *from, to);
            *from = to;
        }
        State::Shift(from) => {
            let (a, b) = (place.pixel(rect, *from), place.pixel(rect, to));
            place
                .view
                .shift([b[0] - a[0], b[1] - a[1]], place.frame.size());
            *from = to;
        }
        State::Modal(modal) => set(place, rect, to, modal, modifiers),
        State::Idle | State::Fingers => {}
    }
    place.hand.doing = doing;
}

fn follow_stroke(place: &mut Sculpting, rect: Rect, to: Pos2, on: &mut Ongoing, pressure: f64) {
    let pixel = place.pixel(rect, to);
    let position = if let Some((frame, surface, view)) = &on.seen {
        let found = frame.pick(view, surface, pixel);
        if let Some(found) = found {
            on.depth = view.depth(found.point);
            on.normal = found.normal;
        }
        // Beside the mesh it goes on at the same depth.
        let point = found.map_or_else(
            || view.point(pixel, on.depth, frame.size()),
            |found| found.point,
        );
        center(place, on.doing, on.reverses, point, on.normal)
    } else {
        let point = place.view.point(pixel, on.depth, place.frame.size());
        let mut way = point - on.grip;
        if let Some(axis) = on.axis {
            way = along(place, rect, to, on.grip, axis);
        }
        on.grip + way
    };
    let point = PathPoint {
        position: round_vector(position, place.decimals),
        pressure: if on.is_free { 1.0 } else { pressure },
    };
    let step = 0.12 * place.brush.size * place.brush.stretch.min_element();
    let is_far = point.position.distance(on.last.position) >= step;
    let is_other = (point.pressure - on.last.pressure).abs() > 0.1 && on.doing != Doing::Pull;
    place.hand.shown = Some(point.position);
    if is_far || is_other {
        place.document.drag(point);
        on.last = point;
    }
}

/// The way along an axis that comes nearest to the pointer.
fn along(place: &Sculpting, rect: Rect, to: Pos2, grip: DVec3, axis: usize) -> DVec3 {
    let unit = DVec3::AXES[axis];
    let eye = place.view.eye();
    let pixel = place.pixel(rect, to);
    let ray = (place
        .view
        .point(pixel, place.view.distance, place.frame.size())
        - eye)
        .normalize_or(DVec3::Z);
    // The nearest points of two lines.
    let (b, w) = (unit.dot(ray), grip - eye);
    let d = 1.0 - b * b;
    if d < 1e-3 {
        return DVec3::ZERO;
    }
    let t = (b * ray.dot(w) - unit.dot(w)) / d;
    let most = 4.0 * place.size.max(place.view.distance);
    unit * t.clamp(-most, most)
}

/// Ends or gives up what is held.
fn finish(place: &mut Sculpting, keeps: bool, commands: &mut Vec<Command>) {
    if let State::Stroke(_) = core::mem::take(&mut place.hand.doing) {
        if keeps {
            place.document.end();
        } else {
            place.document.cancel();
        }
        place.report(Ok(()), commands);
    }
}

/// Turns view, mesh, tool or light by the trackball.
fn turn(place: &mut Sculpting, rect: Rect, from: Pos2, to: Pos2) {
    let half = 0.5 * rect.size().min_elem().max(1.0);
    let [from, to] = [from, to].map(|at| {
        let p = (at - rect.center()) / half;
        [f64::from(p.x), -f64::from(p.y)]
    });
    match place.turning {
        Turning::View => place.view.turn(from, to),
        Turning::Mesh => {
            // The light stays where it is seen.
            let before = place.view.rotation;
            place.view.turn(from, to);
            place.light = place.view.rotation * (before.inverse() * place.light);
        }
        Turning::Tool => {
            let rolled = place.view.roll(from, to);
            place.brush.turn = (rolled * place.brush.turn).normalize();
        }
        Turning::Light => {
            let rolled = place.view.roll(from, to);
            place.light = rolled * place.light;
        }
    }
}

fn hover(place: &mut Sculpting, rect: Rect, at: Pos2, over: bool, modifiers: Modifiers) {
    match place.hand.doing {
        State::Idle => {
            let found = (over && rect.contains(at)).then(|| place.pick(rect, at));
            let doing = if modifiers.shift {
                Doing::Smooth
            } else {
                place.brush.doing
            };
            let reverses = modifiers.command || modifiers.ctrl;
            place.hand.shown = found.flatten().map(|found| {
                let at = center(place, doing, reverses, found.point, found.normal);
                round_vector(at, place.decimals)
            });
        }
        State::Turn(_) | State::Shift(_) if place.turning != Turning::Tool => {
            place.hand.shown = None;
        }
        _ => {}
    }
}

fn set(place: &mut Sculpting, rect: Rect, to: Pos2, modal: &mut Modal, modifiers: Modifiers) {
    let moved = to - modal.from;
    let factor = libm::exp2(f64::from((moved.x - moved.y) / DOUBLE));
    let before = &modal.before;
    match modal.what {
        Setting::Size => {
            place.brush.size = (before.size * factor).clamp(1e-4 * place.size, place.size)
        }
        Setting::Range => place.brush.range = (before.range.max(0.05) * factor).clamp(0.0, 12.0),
        Setting::Scale => match modal.axis {
            None => place.brush.size = (before.size * factor).clamp(1e-4 * place.size, place.size),
            Some(axis) => {
                place.brush.stretch[axis] = (before.stretch[axis] * factor).clamp(0.02, 20.0);
            }
        },
        Setting::Turn => {
            let mut angle = f64::from(moved.x - moved.y) * 0.012;
            if modifiers.ctrl || modifiers.command {
                // Steps of 15°.
                let step = core::f64::consts::PI / 12.0;
                angle = (angle / step).round() * step;
            }
            let rolled = match modal.axis {
                Some(axis) => {
                    let axis = DVec3::AXES[axis] * libm::sin(0.5 * angle);
                    DQuat::from_xyzw(axis.x, axis.y, axis.z, libm::cos(0.5 * angle))
                }
                None => {
                    let half = 0.5 * rect.size().min_elem().max(1.0);
                    let way = Vec2::new(moved.x, -moved.y) / half;
                    place
                        .view
                        .roll([0.0, 0.0], [f64::from(way.x), f64::from(way.y)])
                }
            };
            place.brush.turn = (rolled * before.turn).normalize();
        }
    }
}

fn end_modal(place: &mut Sculpting, keeps: bool) {
    if let State::Modal(modal) = core::mem::take(&mut place.hand.doing)
        && !keeps
    {
        place.brush = modal.before;
    }
    place.brush.size = round(place.brush.size, place.decimals).max(1e-6);
    place.brush.range = round(place.brush.range, 2);
    for axis in 0..3 {
        place.brush.stretch[axis] = round(place.brush.stretch[axis], 3);
    }
}

/// Takes the keys of the place.
pub fn keys(place: &mut Sculpting, ui: &Ui, commands: &mut Vec<Command>) {
    let ctx = ui.ctx();
    if ctx.text_edit_focused() {
        return;
    }
    let pressed =
        |modifiers: Modifiers, key: Key| ctx.input_mut(|input| input.consume_key(modifiers, key));
    if place.keys {
        if pressed(Modifiers::NONE, Key::Escape) || pressed(Modifiers::NONE, Key::Questionmark) {
            place.keys = false;
        }
        return;
    }
    if pressed(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z) || pressed(Modifiers::COMMAND, Key::Y)
    {
        place.redo(commands);
    } else if pressed(Modifiers::COMMAND, Key::Z) {
        match place.hand.doing {
            State::Stroke(_) => finish(place, false, commands),
            _ => place.undo(commands),
        }
    }
    if ctx.input(|input| input.modifiers.command) {
        return;
    }
    if pressed(Modifiers::NONE, Key::Escape) {
        match place.hand.doing {
            State::Stroke(_) => finish(place, false, commands),
            State::Modal(_) => end_modal(place, false),
            _ => place.trouble = None,
        }
    }
    if pressed(Modifiers::NONE, Key::Tab) {
        finish(place, true, commands);
        commands.push(Command::Close);
    }
    if pressed(Modifiers::SHIFT, Key::Slash) || pressed(Modifiers::NONE, Key::Questionmark) {
        place.keys = true;
    }
    axes(place, &pressed);
    modals(place, ui, &pressed);
    plain(place, ui, &pressed, commands);
}

type Pressed<'a> = &'a dyn Fn(Modifiers, Key) -> bool;

/// X, Y and Z.
fn axes(place: &mut Sculpting, pressed: Pressed<'_>) {
    for (axis, key) in [Key::X, Key::Y, Key::Z].into_iter().enumerate() {
        if !pressed(Modifiers::NONE, key) {
            continue;
        }
        match &mut place.hand.doing {
            State::Stroke(on) => on.axis = (on.axis != Some(axis)).then_some(axis),
            State::Modal(modal) => {
                modal.axis = (modal.axis != Some(axis)).then_some(axis);
                place.brush = modal.before.clone();
            }
            _ => {}
        }
    }
}

/// G, R, S and F.
fn modals(place: &mut Sculpting, ui: &Ui, pressed: Pressed<'_>) {
    let at = ui.input(|input| input.pointer.latest_pos());
    let idle = matches!(place.hand.doing, State::Idle);
    let (Some(at), true) = (at, idle) else {
        return;
    };
    let what = if pressed(Modifiers::SHIFT, Key::F) {
        Some(Setting::Range)
    } else if pressed(Modifiers::NONE, Key::F) {
        Some(Setting::Size)
    } else if pressed(Modifiers::NONE, Key::R) {
        Some(Setting::Turn)
    } else if pressed(Modifiers::NONE, Key::S) {
        Some(Setting::Scale)
    } else {
        None
    };
    if let Some(what) = what {
        place.hand.doing = State::Modal(Box::new(Modal {
            what,
            from: at,
            before: place.brush.clone(),
            axis: None,
        }));
    }
    if pressed(Modifiers::NONE, Key::G) {
        place.hand.grabs = Some(at);
    }
}

/// Keys that act at once.
fn plain(place: &mut Sculpting, ui: &Ui, pressed: Pressed<'_>, commands: &mut Vec<Command>) {
    for (key, doing) in [
        (Key::L, Doing::Pull),
        (Key::P, Doing::Push),
        (Key::M, Doing::Mask),
        (Key::C, Doing::Paint),
        (Key::B, Doing::Region),
    ] {
        if pressed(Modifiers::NONE, key) {
            place.brush.doing = doing;
        }
    }
    for (key, factor) in [(Key::OpenBracket, 1.0 / 1.2), (Key::CloseBracket, 1.2)] {
        if pressed(Modifiers::NONE, key) {
            place.brush.size = round(place.brush.size * factor, place.decimals).max(1e-6);
        }
    }
    if pressed(Modifiers::NONE, Key::W) {
        place.wireframe = !place.wireframe;
    }
    if pressed(Modifiers::SHIFT, Key::D) {
        place.carry_out(Stroke::Loop(1), commands);
    } else if pressed(Modifiers::NONE, Key::D) {
        place.carry_out(Stroke::Refine(Refinement::Propagate), commands);
    }
    for (modifiers, key, change) in [
        (Modifiers::ALT, Key::A, RegionChange::None),
        (Modifiers::NONE, Key::A, RegionChange::All),
        (Modifiers::NONE, Key::I, RegionChange::Invert),
    ] {
        if pressed(modifiers, key) {
            place.carry_out(Stroke::Region(change), commands);
        }
    }
    for (key, toward, up) in [
        (Key::Num1, DVec3::NEG_Y, DVec3::Z),
        (Key::Num3, DVec3::X, DVec3::Z),
        (Key::Num7, DVec3::Z, DVec3::Y),
    ] {
        if pressed(Modifiers::NONE, key) {
            place.look_from(toward, up);
        }
    }
    if pressed(Modifiers::NONE, Key::Home) {
        place.see_all();
    }
    if pressed(Modifiers::NONE, Key::Period) {
        place.hand.centers = ui.input(|input| input.pointer.latest_pos());
    }
}
