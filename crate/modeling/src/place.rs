//! Layout of the place: a bar, tools, stages, and the mesh with what lies over it.

use crate::hand;
use crate::keys::KEYS;
use crate::panel;
use crate::state::{Command, Outside, Sculpting};
use egui::{
    Align, Button, CentralPanel, Color32, Context, Frame as UiFrame, Layout, Margin, Panel, Pos2,
    Rect, RichText, ScrollArea, Stroke, Ui, pos2, vec2,
};
use widgets::icon::{self, Icon};
use widgets::{places, screen, theme};

/// Draws the place into all of `ui`, and takes what is done in it.
pub fn show(place: &mut Sculpting, outside: &Outside, ui: &mut Ui, commands: &mut Vec<Command>) {
    let narrow = screen::is_narrow(ui.ctx());
    let palette = theme::palette(ui.visuals());
    let flat = UiFrame::new().fill(palette.panel);
    hand::keys(place, ui, commands);
    Panel::top("sculpt bar")
        .exact_size(if narrow { 52.0 } else { 46.0 })
        .frame(flat)
        .show(ui, |ui| bar(place, outside, ui, narrow, commands));
    if narrow {
        Panel::bottom("sculpt tools")
            .exact_size(54.0)
            .frame(flat)
            .show(ui, |ui| panel::strip(place, ui, commands));
        if place.sheet {
            let height = (0.45 * ui.available_height()).clamp(160.0, 420.0);
            Panel::bottom("sculpt sheet")
                .exact_size(height)
                .frame(flat.inner_margin(Margin::symmetric(14, 8)))
                .show(ui, |ui| scroll(place, ui, commands));
        }
    } else {
        Panel::left("sculpt panel")
            .exact_size(272.0)
            .resizable(false)
            .frame(flat.inner_margin(Margin::symmetric(14, 10)))
            .show(ui, |ui| scroll(place, ui, commands));
    }
    Panel::bottom("sculpt stages")
        .exact_size(if narrow { 44.0 } else { 40.0 })
        .frame(flat)
        .show(ui, |ui| panel::stages(place, ui, commands));
    CentralPanel::no_frame().show(ui, |ui| scene(place, outside, ui, narrow, commands));
    if place.keys {
        keys(place, ui.ctx());
    }
}

fn scroll(place: &mut Sculpting, ui: &mut Ui, commands: &mut Vec<Command>) {
    ScrollArea::vertical()
        .id_salt("sculpt controls")
        .auto_shrink(false)
        .show(ui, |ui| panel::controls(place, ui, commands));
}

fn bar(
    place: &mut Sculpting,
    outside: &Outside,
    ui: &mut Ui,
    narrow: bool,
    commands: &mut Vec<Command>,
) {
    let palette = theme::palette(ui.visuals());
    ui.horizontal_centered(|ui| {
        ui.add_space(if narrow { 6.0 } else { 12.0 });
        let back = ui
            .button("‹ Editor")
            .on_hover_text("Back to the text and the traced picture (Tab)");
        places::note(ui.ctx(), "sculpt back", back.rect);
        if back.clicked() {
            commands.push(Command::Close);
        }
        ui.add_space(4.0);
        if !narrow {
            icon::mark(ui);
        }
        // The narrowest phones need the room for buttons.
        if ui.available_width() >= 260.0 {
            ui.label(RichText::new("Sculpt").size(17.0).color(palette.strong));
        }
        let new = icon::button(ui, Icon::Add, "Begin another sculpture", true);
        places::note(ui.ctx(), "sculpt new", new.rect);
        if new.clicked() {
            commands.push(Command::New);
        }
        if !narrow {
            ui.label(RichText::new(&place.name).size(13.0).color(palette.weak));
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.add_space(if narrow { 6.0 } else { 12.0 });
            let help = icon::button(ui, Icon::Help, "Keys and gestures (?)", true);
            places::note(ui.ctx(), "sculpt help", help.rect);
            if help.clicked() {
                place.keys = !place.keys;
            }
            if !narrow {
                let next = theme::other(ui);
                let tip = format!("Colours: {}", theme::label(outside.theme));
                if icon::button(ui, Icon::Theme, &tip, true).clicked() {
                    commands.push(Command::SetTheme(next));
                }
            }
            let all = icon::button(ui, Icon::Frame, "See all of it (Home)", true);
            places::note(ui.ctx(), "sculpt all", all.rect);
            if all.clicked() {
                place.see_all();
            }
            let own = place.depth().map(|count| count > 0);
            let [undo, redo] = [0, 1].map(|i| own[i] || outside.depth[i]);
            let redo = icon::button(ui, Icon::Redo, "Redo (Ctrl+Shift+Z)", redo);
            places::note(ui.ctx(), "sculpt redo", redo.rect);
            if redo.clicked() {
                place.redo(commands);
            }
            let undo = icon::button(ui, Icon::Undo, "Undo (Ctrl+Z)", undo);
            places::note(ui.ctx(), "sculpt undo", undo.rect);
            if undo.clicked() {
                place.undo(commands);
            }
        });
    });
}

/// The mesh, full size.
fn scene(
    place: &mut Sculpting,
    outside: &Outside,
    ui: &mut Ui,
    narrow: bool,
    commands: &mut Vec<Command>,
) {
    let palette = theme::palette(ui.visuals());
    let rect = ui.max_rect();
    places::note(ui.ctx(), "sculpture", rect);
    if rect.width() < 2.0 || rect.height() < 2.0 {
        return;
    }
    hand::pointer(place, outside, ui, rect, commands);
    let dark = ui.visuals().dark_mode;
    let ctx = ui.ctx().clone();
    place.draw(&ctx, rect, dark, outside.now);
    let painter = ui.painter().with_clip_rect(rect);
    if let Some(texture) = &place.texture {
        let whole = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
        painter.image(texture.id(), rect, whole, Color32::WHITE);
    }
    let [vertices, faces] = place.counts();
    let font = egui::FontId::proportional(12.5);
    let line = format!("{vertices} vertices · {faces} faces");
    let at = rect.left_bottom() + vec2(12.0, -10.0);
    painter.text(
        at,
        egui::Align2::LEFT_BOTTOM,
        line,
        font.clone(),
        palette.weak,
    );
    let hint = match &place.trouble {
        Some(trouble) => (trouble.clone(), palette.error),
        None => (hand::hint(place, narrow), palette.weak),
    };
    let galley = painter.layout(hint.0, font, hint.1, (rect.width() - 24.0).max(80.0));
    let at = rect.left_top() + vec2(12.0, 10.0);
    painter.galley(at, galley, hint.1);
    center(place, &painter, rect, palette);
    inset(outside, ui, rect, narrow);
}

/// A cross at the centre of rotation while the pointer turns.
fn center(place: &Sculpting, painter: &egui::Painter, rect: Rect, palette: &theme::Palette) {
    if !place.hand.turns() {
        return;
    }
    let at = rect.center();
    let stroke = Stroke::new(1.5, palette.accent);
    for way in [vec2(7.0, 0.0), vec2(0.0, 7.0)] {
        painter.line_segment([at - way, at + way], stroke);
    }
}

/// The traced picture of the model in a corner.
fn inset(outside: &Outside, ui: &Ui, rect: Rect, narrow: bool) {
    let Some((texture, [w, h])) = outside.traced else {
        return;
    };
    let longest = if narrow {
        96.0
    } else {
        190.0_f32.min(0.28 * rect.width())
    };
    let size = vec2(w as f32, h as f32);
    let size = size * (longest / size.max_elem().max(1.0));
    let place = Rect::from_min_size(rect.right_bottom() - size - vec2(12.0, 12.0), size);
    places::note(ui.ctx(), "sculpt traced", place);
    let palette = theme::palette(ui.visuals());
    let painter = ui.painter().with_clip_rect(rect);
    painter.rect_filled(place.expand(1.5), 4.0, palette.line);
    let whole = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
    painter.image(texture, place, whole, Color32::WHITE);
}

/// The keys of the place.
fn keys(place: &mut Sculpting, ctx: &Context) {
    let modal = egui::Modal::new(egui::Id::unique("sculpt keys"))
        .backdrop_color(Color32::from_black_alpha(120))
        .show(ctx, |ui| {
            let palette = theme::palette(ui.visuals());
            let width = (ctx.content_rect().width() - 60.0).min(560.0);
            ui.set_width(width);
            ui.label(
                RichText::new("Hands and keys")
                    .size(17.0)
                    .color(palette.strong),
            );
            ui.add_space(6.0);
            let most = (ctx.content_rect().height() - 160.0).max(120.0);
            ScrollArea::vertical().max_height(most).show(ui, |ui| {
                egui::Grid::new("sculpt keys")
                    .num_columns(2)
                    .spacing([16.0, 5.0])
                    .show(ui, |ui| {
                        for (key, meaning) in KEYS {
                            for (text, color, share) in
                                [(key, palette.text, 0.36), (meaning, palette.weak, 0.56)]
                            {
                                let text = RichText::new(text).size(13.0).color(color);
                                ui.scope(|ui| {
                                    ui.set_width(share * width);
                                    ui.add(egui::Label::new(text).wrap());
                                });
                            }
                            ui.end_row();
                        }
                    });
            });
            ui.add_space(8.0);
            ui.add(Button::new("Close")).clicked()
        });
    places::note(ctx, "sculpt keys", modal.response.rect);
    if modal.inner || modal.backdrop_response.clicked() {
        place.keys = false;
    }
}
