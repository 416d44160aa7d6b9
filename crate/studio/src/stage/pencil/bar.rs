//! The strip of drawing tools under the picture, and buttons on the picture.

use super::{Pencil, THICKNESS, tool::Tool};
use crate::icon::{self, Icon};
use crate::wish::{ViewWish, Wishes, WorkWish};
use crate::{places, slider, theme};
use egui::{
    Align, Color32, CornerRadius, FontId, Layout, Popup, Rect, Response, Sense, Slider, Stroke, Ui,
    Vec2, pos2, vec2,
};
use sketch::page;

/// Height of the strip.
pub const HEIGHT: f32 = 60.0;

/// Shows the button on the picture that begins drawing.
pub fn start(ui: &mut Ui, picture: Rect, wishes: &mut Wishes) {
    let palette = theme::palette(ui.visuals());
    // A small picture is covered by no more than the pencil.
    let has_word = picture.height() >= 240.0;
    let size = vec2(if has_word { 92.0 } else { 40.0 }, 40.0);
    if picture.width() < size.x + 40.0 || picture.height() < size.y + 40.0 {
        return;
    }
    let place = Rect::from_min_size(picture.left_bottom() + vec2(12.0, -12.0 - size.y), size);
    let response = ui.interact(place, ui.scope_id().with("begin drawing"), Sense::click());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, "Draw a creature"));
    places::note(ui.ctx(), "draw", place);
    let painter = ui.painter();
    let round = CornerRadius::same(20);
    painter.rect_filled(
        place.translate(vec2(0.0, 1.5)),
        round,
        Color32::from_black_alpha(90),
    );
    let fill = if response.hovered() {
        palette.accent.gamma_multiply(1.15)
    } else {
        palette.accent
    };
    painter.rect_filled(place, round, fill);
    let ink = Stroke::new(1.7, palette.on_accent);
    icon::paint(
        painter,
        Icon::Pencil,
        place.left_center() + vec2(if has_word { 24.0 } else { 20.0 }, 0.0),
        ink,
    );
    if has_word {
        painter.text(
            place.left_center() + vec2(39.0, 0.0),
            egui::Align2::LEFT_CENTER,
            "Draw",
            FontId::proportional(15.5),
            palette.on_accent,
        );
    }
    if response
        .on_hover_text("Draw a creature: strokes become limbs (D)")
        .on_hover_cursor(egui::CursorIcon::PointingHand)
        .clicked()
    {
        wishes.push(ViewWish::SetTool(Some(Tool::Draw)));
    }
}

/// Shows the button on the picture that makes the last stroke one of a pair, or single. Returns
/// whether it was clicked.
pub fn turn(ui: &mut Ui, picture: Rect, pair: bool) -> bool {
    let palette = theme::palette(ui.visuals());
    let (word, tip) = if pair {
        (
            "Make it a pair",
            "Let the last stroke grow on the other side too",
        )
    } else {
        (
            "Only one",
            "Keep the last stroke single, without another one on the other side",
        )
    };
    let font = FontId::proportional(14.0);
    let galley = ui
        .painter()
        .layout_no_wrap(word.to_owned(), font, palette.text);
    let size = vec2(galley.size().x + 54.0, 38.0);
    let place = Rect::from_min_size(picture.left_bottom() + vec2(10.0, -10.0 - size.y), size);
    if !picture.contains_rect(place) {
        return false;
    }
    let response = ui.interact(place, ui.scope_id().with("other stroke"), Sense::click());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, word));
    places::note(ui.ctx(), "draw other", place);
    let fill = if response.hovered() {
        palette.hover
    } else {
        palette.button
    };
    ui.painter()
        .rect_filled(place, CornerRadius::same(19), fill);
    let ink = Stroke::new(1.6, palette.text);
    icon::paint(
        ui.painter(),
        Icon::Mirror,
        place.left_center() + vec2(23.0, 0.0),
        ink,
    );
    let at = place.left_center() + vec2(39.0, -0.5 * galley.size().y);
    ui.painter().galley(at, galley, palette.text);
    response
        .on_hover_text(tip)
        .on_hover_cursor(egui::CursorIcon::PointingHand)
        .clicked()
}

/// Shows the strip in all of `ui`.
pub fn show(pencil: &mut Pencil, ui: &mut Ui, wishes: &mut Wishes) {
    places::note(ui.ctx(), "draw tools", ui.max_rect());
    let narrow = ui.available_width() < 560.0;
    let tool = pencil.tool();
    ui.spacing_mut().item_spacing.x = if narrow { 2.0 } else { 5.0 };
    ui.horizontal_centered(|ui| {
        ui.add_space(if narrow { 4.0 } else { 12.0 });
        for (own, sign, text, tip) in [
            (Tool::Draw, Icon::Pencil, "Draw", "A stroke becomes a limb"),
            (
                Tool::Move,
                Icon::Move,
                "Move",
                "Drag dots, bend limbs, make them thicker or thinner",
            ),
            (
                Tool::Cut,
                Icon::Scissors,
                "Cut",
                "Cut limbs off, remove dots, limbs and eyes",
            ),
        ] {
            let button = tool_button(ui, sign, text, tool == Some(own)).on_hover_text(tip);
            places::note(ui.ctx(), format!("tool {}", own.id()), button.rect);
            if button.clicked() {
                wishes.push(ViewWish::SetTool(Some(own)));
            }
        }
        ui.add_space(if narrow { 1.0 } else { 10.0 });
        let tip = "Limbs in pairs: what is drawn on one side grows on the other too";
        let mirror = tool_button(ui, Icon::Mirror, "Pairs", pencil.mirror).on_hover_text(tip);
        places::note(ui.ctx(), "draw mirror", mirror.rect);
        if mirror.clicked() {
            pencil.mirror = !pencil.mirror;
        }
        let colour = tool_button(ui, Icon::Drop, "Colour", false);
        let dot = colour.rect.center_top() + vec2(0.0, 20.0);
        if let Some(index) = pencil.colour {
            let [r, g, b] = page::COLOURS[index].1.map(|c| (c * 255.0) as u8);
            ui.painter()
                .circle_filled(dot, 8.0, Color32::from_rgb(r, g, b));
            ui.painter()
                .circle_stroke(dot, 8.0, Stroke::new(1.2, Color32::WHITE));
        }
        places::note(ui.ctx(), "draw colour", colour.rect);
        Popup::menu(&colour).show(|ui| colours(ui, &mut pencil.colour));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.add_space(if narrow { 4.0 } else { 12.0 });
            let done =
                tool_button(ui, Icon::Done, "Done", false).on_hover_text("Put the pencil down (D)");
            places::note(ui.ctx(), "draw done", done.rect);
            if done.clicked() {
                wishes.push(ViewWish::SetTool(None));
            }
            if !narrow {
                let fresh = tool_button(ui, Icon::Add, "New", false)
                    .on_hover_text("An empty page to draw on; this work is kept");
                places::note(ui.ctx(), "draw new", fresh.rect);
                if fresh.clicked() {
                    wishes.push(WorkWish::DrawNew);
                }
            }
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                ui.add_space(4.0);
                thickness(ui, &mut pencil.thickness);
            });
        });
    });
}

fn thickness(ui: &mut Ui, value: &mut f32) {
    let width = (ui.available_width() - 10.0).clamp(36.0, 190.0);
    let (rect, _) = ui.allocate_exact_size(vec2(width, HEIGHT - 6.0), Sense::hover());
    let palette = theme::palette(ui.visuals());
    // A wedge says what the slider does.
    let wedge = Rect::from_center_size(rect.center() - vec2(0.0, 9.0), vec2(width - 8.0, 12.0));
    let shape = vec![
        pos2(wedge.left(), wedge.center().y),
        wedge.right_top(),
        wedge.right_bottom(),
    ];
    ui.painter().add(egui::Shape::convex_polygon(
        shape,
        palette.button,
        Stroke::NONE,
    ));
    // As high as the slider is, or it would lie lower, on its caption.
    let height = ui.spacing().interact_size.y.max(26.0);
    let place = Rect::from_center_size(wedge.center(), vec2(width, height));
    let part = places::part("draw thickness", place);
    let mut inner = ui.new_child(part.layout(Layout::left_to_right(Align::Center)));
    slider::colours(&mut inner);
    inner.spacing_mut().slider_width = width - 2.0;
    let slider = inner.add(
        Slider::new(value, THICKNESS[0]..=THICKNESS[1])
            .logarithmic(true)
            .show_value(false),
    );
    let slider = slider.on_hover_text("Thickness of strokes ([ and ])");
    places::note(ui.ctx(), "draw thickness", slider.rect);
    caption(ui, rect, "Thickness", palette.weak);
}

fn caption(ui: &Ui, rect: Rect, text: &str, colour: Color32) {
    ui.painter().text(
        rect.center_bottom() - vec2(0.0, 5.0),
        egui::Align2::CENTER_BOTTOM,
        text,
        FontId::proportional(11.5),
        colour,
    );
}

/// Shows a button with an icon above its word.
fn tool_button(ui: &mut Ui, sign: Icon, text: &str, chosen: bool) -> Response {
    let width = match ui.ctx().content_rect().width() {
        ..360.0 => 38.0,
        ..560.0 => 46.0,
        _ => 56.0,
    };
    let (rect, response) = ui.allocate_exact_size(vec2(width, HEIGHT - 8.0), Sense::click());
    response.widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, true, chosen, text));
    let palette = theme::palette(ui.visuals());
    let fill = if chosen {
        palette.accent
    } else if response.hovered() {
        palette.hover
    } else {
        Color32::TRANSPARENT
    };
    let ink = if chosen {
        palette.on_accent
    } else {
        palette.text
    };
    ui.painter()
        .rect_filled(rect, f32::from(theme::ROUND), fill);
    icon::paint(
        ui.painter(),
        sign,
        rect.center_top() + vec2(0.0, 20.0),
        Stroke::new(1.6, ink),
    );
    caption(ui, rect, text, ink);
    response
}

/// Shows the colours to draw with.
fn colours(ui: &mut Ui, chosen: &mut Option<usize>) {
    ui.set_width(196.0);
    ui.label("Colour of the next stroke");
    let side = 44.0;
    egui::Grid::new("draw colours")
        .spacing(Vec2::splat(4.0))
        .show(ui, |ui| {
            for (index, (name, colour)) in page::COLOURS.iter().enumerate() {
                let (rect, response) = ui.allocate_exact_size(Vec2::splat(side), Sense::click());
                response.widget_info(|| {
                    egui::WidgetInfo::selected(
                        egui::Role::Button,
                        true,
                        *chosen == Some(index),
                        *name,
                    )
                });
                places::note(ui.ctx(), format!("draw colour {name}"), rect);
                let [r, g, b] = colour.map(|c| (c * 255.0) as u8);
                ui.painter()
                    .circle_filled(rect.center(), 17.0, Color32::from_rgb(r, g, b));
                if *chosen == Some(index) || response.hovered() {
                    let palette = theme::palette(ui.visuals());
                    ui.painter().circle_stroke(
                        rect.center(),
                        19.5,
                        Stroke::new(2.0, palette.accent),
                    );
                }
                if response.on_hover_text(*name).clicked() {
                    *chosen = Some(index);
                    ui.close();
                }
                if index % 4 == 3 {
                    ui.end_row();
                }
            }
        });
    let same = ui.selectable_label(chosen.is_none(), "Same as what it grows from");
    places::note(ui.ctx(), "draw colour same", same.rect);
    if same.clicked() {
        *chosen = None;
    }
}
