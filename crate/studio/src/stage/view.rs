//! The picture: draft and traced picture in one place, and the gestures that turn it.
//!
//! While the scene or the camera is newer than the traced picture, the draft stands in; the traced
//! picture fades in over it once the coarse picture is complete.

use crate::places;
use crate::render::Renderer;
use crate::settings::Show;
use crate::theme;
use crate::wish::{ViewWish, Wishes};
use document::session::Session;
use egui::emath::GuiRounding;
use egui::epaint::RectShape;
use egui::{
    Color32, CursorIcon, PointerButton, Pos2, Rect, Response, Sense, TextureId, Ui, Vec2, vec2,
};
use preview::orbit;
use scene::Camera;

/// Seconds to the coarse picture up to which a draft by the processor is not worth its time.
pub const SOON: f64 = 1.0;

/// Pixels of the shorter side of a picture below which its place does not fit it exactly.
const SHORT: f32 = 32.0;

/// Inputs of the view.
pub struct Scenery<'a> {
    /// The user's work.
    pub session: &'a Session,
    /// The traced picture.
    pub renderer: &'a Renderer,
    /// The draft, if there is one.
    pub draft: Option<TextureId>,
    /// Choice between draft and picture.
    pub show: Show,
    /// Seconds on the app's clock.
    pub now: f64,
    /// Whether the draft is a picture that was traced when the example was made.
    pub is_kept: bool,
    /// Whether to show a hint of how to turn the picture.
    pub hint: bool,
    /// Whether fingers turn it.
    pub touch: bool,
    /// Whether the text has errors, so that the picture is of one before.
    pub old: bool,
    /// Radius of the corners.
    pub round: f32,
    /// Gestures that do not move the camera.
    pub grasp: Grasp,
}

/// Gestures on the picture that do not move the camera.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Grasp {
    /// The first button and a single finger draw; other buttons, the space bar and two fingers
    /// turn.
    pub draws: bool,
    /// The wheel does not zoom.
    pub wheel: bool,
    /// Pinching does not zoom.
    pub pinch: bool,
}

/// Returns the largest rectangle of the frame's proportions in the middle of a place. It lies on
/// whole pixels of the screen, and a picture made to fit it ([`document::size::pixels`]) has as
/// many, so that it is shown as sharp as it was traced.
#[must_use]
pub fn fit(place: Rect, frame: [u32; 2], pixels_per_point: f32) -> Rect {
    let frame = vec2(frame[0].max(1) as f32, frame[1].max(1) as f32);
    let scale = (place.width() / frame.x)
        .min(place.height() / frame.y)
        .max(0.0);
    let size = frame * (scale * pixels_per_point);
    let shorter = (size.min_elem() + 1e-3).floor();
    // The longer side is computed from the rounded shorter one, which `size::pixels` gets back from
    // it. If the shorter one is very short, the longer one would be far from the room for it.
    let size = if shorter >= SHORT {
        (frame * (shorter / frame.min_elem())).round()
    } else {
        size.ceil()
    };
    let size = size / pixels_per_point;
    let min = place.center() - 0.5 * size;
    Rect::from_min_size(min.round_to_pixels(pixels_per_point), size)
}

/// Whether the draft must be drawn. `slow`: the processor draws the window, which keeps the workers
/// waiting. Then the last picture stands in for it if a coarse one comes [`SOON`]. `fades`: the
/// picture fades in over it.
#[must_use]
pub fn needs_draft(
    show: Show,
    session: &Session,
    renderer: &Renderer,
    slow: bool,
    fades: bool,
    now: f64,
) -> bool {
    match show {
        Show::Draft => true,
        Show::Traced => false,
        Show::Auto => {
            let fresh = renderer
                .texture()
                .is_some_and(|(_, generation)| generation == session.generation());
            if slow {
                !fresh && !renderer.is_near(SOON, now)
            } else {
                !fresh || fades && renderer.opacity(now) < 1.0
            }
        }
    }
}

/// Paints the picture into `rect`, and carries out gestures on it.
pub fn show(ui: &mut Ui, rect: Rect, scenery: &Scenery<'_>, wishes: &mut Wishes) -> Response {
    let Scenery {
        session,
        renderer,
        draft,
        show,
        now,
        is_kept,
        hint,
        touch,
        old,
        round,
        grasp,
    } = *scenery;
    let palette = theme::palette(ui.visuals());
    let painter = ui.painter().clone();
    painter.rect_filled(rect, round, background(session));
    let traced = renderer.texture();
    let fresh = traced.is_some_and(|(_, generation)| generation == session.generation());
    let image = |texture: TextureId, alpha: f32| {
        let whole = Rect::from_min_max(Pos2::ZERO, Pos2::new(1.0, 1.0));
        let shape = RectShape::filled(rect, round, Color32::WHITE.gamma_multiply(alpha));
        painter.add(shape.with_texture(texture, whole));
    };
    let draft = draft.filter(|_| is_kept || show != Show::Traced);
    if let Some(draft) = draft {
        image(draft, 1.0);
    }
    match (traced, draft) {
        (Some((texture, _)), None) => image(texture.id(), 1.0),
        (Some((texture, _)), Some(_)) if fresh && show == Show::Auto && !is_kept => {
            let moves = ui.style().animation_time > 0.0;
            let opacity = if moves { renderer.opacity(now) } else { 1.0 };
            image(texture.id(), opacity);
            if opacity < 1.0 {
                ui.ctx().request_repaint();
            }
        }
        (None, None) if session.is_enabled() => {
            let place = Rect::from_center_size(rect.center(), Vec2::splat(28.0));
            ui.place(place, egui::Spinner::new().color(palette.weak));
        }
        _ => {}
    }

    let response = ui.interact(rect, ui.scope_id().with("picture"), Sense::click_and_drag());
    response
        .widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, "Picture of the model"));
    let camera = session.camera();
    if let Some(moved) = gesture(ui, &response, rect, camera, grasp) {
        wishes.push(ViewWish::SetCamera(Some(moved)));
    }
    let response =
        response.on_hover_and_drag_cursor(if ui.input(|input| input.pointer.any_down()) {
            CursorIcon::Grabbing
        } else {
            CursorIcon::Grab
        });
    if old {
        painter.rect_filled(rect, round, Color32::from_black_alpha(110));
        let text = "of the last text without errors";
        let place = inscribe(&painter, rect, egui::Align2::CENTER_TOP, text);
        places::note(ui.ctx(), "old picture", place);
    }
    if is_kept && !old {
        let place = inscribe(&painter, rect, egui::Align2::CENTER_TOP, "made before");
        places::note(ui.ctx(), "made before", place);
    }
    let is_free = !(touch && (old || is_kept));
    if hint && is_free && !grasp.draws && response.hovered() && !response.dragged() {
        // At the lower edge of a narrow picture is the button to draw.
        let (align, text) = if touch {
            let text = "drag to turn · two fingers to move and zoom · tap a shape to edit it";
            (egui::Align2::CENTER_TOP, text)
        } else {
            let text =
                "drag to turn · shift-drag to move · scroll to zoom · click a shape to edit it";
            (egui::Align2::CENTER_BOTTOM, text)
        };
        inscribe(&painter, rect, align, text);
    }
    response
}

/// Writes words on a dark ground at an edge of the picture. Returns their place.
fn inscribe(painter: &egui::Painter, rect: Rect, align: egui::Align2, text: &str) -> Rect {
    let font = egui::FontId::proportional(12.5);
    let width = (rect.width() - 32.0).max(60.0);
    let galley = painter.layout(text.to_owned(), font, Color32::from_gray(235), width);
    let place = align.align_size_within_rect(galley.size(), rect.shrink(16.0));
    let ground = place.expand2(vec2(10.0, 5.0));
    painter.rect_filled(ground, 8.0, Color32::from_black_alpha(150));
    painter.galley(place.min, galley, Color32::WHITE);
    ground
}

fn background(session: &Session) -> Color32 {
    let [r, g, b] = session
        .background()
        .map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8);
    Color32::from_rgb(r, g, b)
}

/// Returns the camera after this frame's dragging, scrolling and pinching, if it moved.
fn gesture(
    ui: &Ui,
    response: &Response,
    rect: Rect,
    camera: Camera,
    grasp: Grasp,
) -> Option<Camera> {
    let size = rect.size().max(Vec2::splat(1.0));
    let pixels = [size.x as u32, size.y as u32];
    let mut new = camera;
    let touch = ui.input(egui::InputState::multi_touch);
    if let Some(touch) = touch {
        if rect.contains(touch.center_pos) {
            let [across, down] = <[f32; 2]>::from(touch.translation_delta / size).map(f64::from);
            new = if grasp.draws && touch.num_touches == 2 {
                orbit::orbit(new, across, down)
            } else {
                orbit::pan(new, across, down, pixels)
            };
            if !grasp.pinch {
                new = orbit::zoom(new, 1.0 / f64::from(touch.zoom_delta));
            }
        }
    } else if response.dragged() && response.drag_delta() != Vec2::ZERO {
        let [across, down] = <[f32; 2]>::from(response.drag_delta() / size).map(f64::from);
        let (shift, space) =
            ui.input(|input| (input.modifiers.shift, input.key_down(egui::Key::Space)));
        let first = response.dragged_by(PointerButton::Primary);
        let second = response.dragged_by(PointerButton::Secondary);
        let pans = if grasp.draws {
            shift || !(first || second)
        } else {
            shift || !first
        };
        new = if grasp.draws && first && !space && !shift {
            new
        } else if pans {
            orbit::pan(new, across, down, pixels)
        } else {
            orbit::orbit(new, across, down)
        };
    }
    if response.contains_pointer() && touch.is_none() {
        let (scroll, pinch) = ui.input(|input| (input.smooth_scroll_delta().y, input.zoom_delta()));
        // A notch of a wheel (100 or 120 points) zooms by an eighth.
        let factor = libm::exp(-f64::from(scroll) / 800.0) / f64::from(pinch);
        if factor != 1.0 && !grasp.wheel {
            new = orbit::zoom(new, factor);
        }
    }
    (new != camera).then_some(new)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_made_to_fit_lies_texel_on_pixel() {
        for scale in [1.0, 1.25, 1.5, 2.0, 2.625] {
            for frame in [
                [640, 480],
                [480, 640],
                [512, 512],
                [1920, 803],
                [37, 1000],
                [1000, 1],
            ] {
                for step in 0..50 {
                    let side = 100.3 + 7.7 * step as f32;
                    let place = Rect::from_min_size(Pos2::new(3.3, 41.0), vec2(side, 350.6));
                    let rect = fit(place, frame, scale);
                    let pixels = [rect.left(), rect.top(), rect.width(), rect.height()];
                    for at in pixels.map(|at| at * scale) {
                        assert!((at - at.round()).abs() < 1e-2, "{frame:?} {side} {scale}");
                    }
                    let shown = [2, 3].map(|i| (pixels[i] * scale).round());
                    assert!(shown[0] >= 1.0 && shown[1] >= 1.0);
                    if shown[0].min(shown[1]) < SHORT {
                        continue;
                    }
                    let traced = document::size::pixels(Default::default(), frame, shown, 8192);
                    // A larger one is traced with fewer pixels.
                    let small = f64::from(shown[0] * shown[1]) <= document::size::FIT_PIXELS;
                    assert!(
                        !small || traced.map(|side| side as f32) == shown,
                        "{frame:?} {side}"
                    );
                    let over = (rect.size() - place.size()).max_elem();
                    assert!(over * scale <= 1.01, "{frame:?} {side} {scale}");
                }
            }
        }
    }

    #[test]
    fn the_picture_keeps_the_proportions_of_the_frame() {
        let place = Rect::from_min_size(Pos2::new(10.0, 0.0), vec2(100.0, 300.0));
        let wide = fit(place, [2, 1], 1.0);
        assert_eq!(
            (wide.size(), wide.center()),
            (vec2(100.0, 50.0), place.center())
        );
        let high = fit(place, [1, 4], 1.0);
        assert_eq!(high.size(), vec2(75.0, 300.0));
        let inverted = Rect::ZERO.shrink(9.0);
        assert_eq!(fit(inverted, [0, 0], 1.0).size(), Vec2::ZERO);
    }
}
