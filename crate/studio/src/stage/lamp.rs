//! A light for texts without any: their pictures are nearly black, and the page offers to add one.

use crate::wish::{TextWish, Wish, Wishes};
use crate::{places, theme};
use document::session::Session;
use egui::{CornerRadius, FontId, Rect, Sense, Ui, vec2};
use glam::DVec3;
use rats::{Project, TextEdit};
use scene::{Camera, Finish, Scene};

/// Most ambient light at which a material counts as dark, as a share of its diffuse colour: the
/// share where the text gives none.
const DARK: f32 = 1.01 * Finish::AMBIENT_SHARE;

/// Whether nothing shines on a scene: no light, sky or cloud, and no element that glows by itself.
#[must_use]
pub fn is_dark(scene: &Scene) -> bool {
    let is_lit = !scene.lights.is_empty() || scene.sky.is_some() || !scene.clouds.is_empty();
    !is_lit
        && !scene.elements.is_empty()
        && !scene.elements.iter().any(|element| {
            scene
                .finishes
                .get(element.finish as usize)
                .is_some_and(|finish| {
                    let mut pairs = finish.ambient.iter().zip(&finish.diffuse);
                    pairs.any(|(ambient, diffuse)| *ambient > DARK * diffuse + 1e-3)
                })
        })
}

/// Returns a text with a white light up and to the right behind the eye, before its `shoot` if it
/// has one.
#[must_use]
pub fn with_light(text: &str, camera: &Camera) -> String {
    let back = camera.eye - camera.target;
    let far = back.length().max(1e-6);
    let right = camera.up.cross(back).try_normalize().unwrap_or(DVec3::X);
    let up = camera.up.try_normalize().unwrap_or(DVec3::Y);
    let place = camera.eye + (0.4 * right + 0.7 * up) * far;
    // A hundredth of the distance is exact enough.
    let decimals = (2.0 - libm::floor(libm::log10(far))).clamp(0.0, 9.0) as usize;
    let [x, y, z] = place.to_array().map(|x| format!("{x:.decimals$}"));
    let end = if text.contains("\r\n") { "\r\n" } else { "\n" };
    let line = format!("light White, position {x} {y} {z}{end}");
    let mut start = 0;
    for row in text.split_inclusive('\n') {
        let command = row.split('#').next().unwrap_or_default();
        if command.trim().eq_ignore_ascii_case("shoot") {
            return format!("{}{line}{}", &text[..start], &text[start..]);
        }
        start += row.len();
    }
    let gap = if text.is_empty() || text.ends_with('\n') {
        ""
    } else {
        end
    };
    format!("{text}{gap}{line}")
}

/// Returns the project's first text with a light that shines; `None` if adding one does not help,
/// as where a block is not closed.
#[must_use]
pub fn light(session: &Session) -> Option<String> {
    let text = with_light(session.text(0), &session.camera());
    let mut project: Project = session.project().clone();
    project.files.first_mut()?.text.clone_from(&text);
    let compiled = rats::compile_at(&project, session.assets(), f64::from(session.film_frame()));
    (!compiled.scene.lights.is_empty()).then_some(text)
}

/// Shows the button that adds a light on the picture of a dark scene.
pub fn show(ui: &mut Ui, picture: Rect, session: &Session, wishes: &mut Wishes) {
    let palette = theme::palette(ui.visuals());
    let font = FontId::proportional(14.0);
    let words = String::from("No light shines here: add one");
    let galley = ui.painter().layout_no_wrap(words, font, palette.text);
    let size = galley.size() + vec2(28.0, 20.0);
    let place = Rect::from_center_size(picture.center_top() + vec2(0.0, 12.0 + 0.5 * size.y), size);
    if !picture.contains_rect(place) {
        return;
    }
    let response = ui.interact(place, ui.scope_id().with("add a light"), Sense::click());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, "Add a light"));
    places::note(ui.ctx(), "add light", place);
    let fill = if response.hovered() {
        palette.hover
    } else {
        palette.button
    };
    ui.painter()
        .rect_filled(place, CornerRadius::same(10), fill);
    let at = place.center() - 0.5 * galley.size();
    ui.painter().galley(at, galley, palette.text);
    let clicked = response
        .on_hover_text("Write a white light into the text, behind the eye")
        .on_hover_cursor(egui::CursorIcon::PointingHand)
        .clicked();
    if clicked {
        wishes.push(match light(session) {
            Some(text) => Wish::from(TextWish::step(TextEdit::whole(0, text))),
            None => Wish::Tell(String::from(
                "A light at the end of this text would not shine: \
                    write one before its pictures are made.",
            )),
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene(text: &str) -> std::sync::Arc<Scene> {
        rats::compile(&Project::single(text)).scene
    }

    #[test]
    fn texts_without_light_are_dark_until_they_get_one() {
        for text in [
            "surface s diffuse Gold, blob -2\nsphere s 1 0 0 0",
            "surface s diffuse Gold\r\nsphere s 1 0 0 0\r\nSHOOT\r\n",
            "eyep 0 0 2000\nsurface s diffuse Gold, blob -2\nobject A\nsphere s 1 0 0 0\nclose\n\
                shoot # now",
        ] {
            let dark = scene(text);
            assert!(is_dark(&dark), "{text}");
            let lit = with_light(text, &dark.camera);
            let compiled = rats::compile(&Project::single(&lit));
            assert_eq!(compiled.diagnostics, [], "{lit}");
            assert!(!is_dark(&compiled.scene), "{lit}");
            assert_eq!(compiled.scene.lights.len(), 1, "{lit}");
        }
    }

    #[test]
    fn glowing_and_empty_scenes_are_not_dark() {
        for text in [
            "",
            "light White position 1 2 3\nsurface s diffuse Gold\nsphere s 1 0 0 0",
            "sky White\nsurface s diffuse Gold\nsphere s 1 0 0 0",
            "surface s diffuse Gold, ambient Gold\nsphere s 1 0 0 0",
        ] {
            assert!(!is_dark(&scene(text)), "{text}");
        }
    }
}
