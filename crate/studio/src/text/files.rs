//! The strip above the text: one tab for each file of the work, and quieter ones for its images and
//! meshes.

use crate::icon::{self, Icon};
use crate::text::editor::Editor;
use crate::wish::{TextWish, Wishes, WorkWish};
use crate::{places, problems, theme};
use document::asset::{self, Asset};
use document::session::Session;
use egui::{
    Align, Button, Color32, Key, Layout, Popup, PopupCloseBehavior, RichText, TextEdit, Ui,
};

/// Shows the strip; with `summary` also the number of problems, on the right.
pub fn show(
    ui: &mut Ui,
    session: &Session,
    editor: &mut Editor,
    summary: bool,
    wishes: &mut Wishes,
) {
    let palette = theme::palette(ui.visuals());
    ui.horizontal_centered(|ui| {
        ui.add_space(10.0);
        ui.spacing_mut().item_spacing.x = 2.0;
        let files = &session.project().files;
        for (index, file) in files.iter().enumerate() {
            let open = index == editor.file && editor.asset.is_none();
            let colour = if open { palette.strong } else { palette.weak };
            let alone = files.len() == 1 && session.assets().is_empty();
            let fill = if open && !alone {
                palette.button
            } else {
                Color32::TRANSPARENT
            };
            let tab = ui
                .add(Button::new(RichText::new(&file.name).size(13.0).color(colour)).fill(fill))
                .on_hover_text(if index == 0 {
                    "This file is run. Right-click to rename it."
                } else {
                    "Other files run it with `read` and its name. \
                        Right-click to rename or remove it."
                });
            if tab.clicked() {
                editor.open(index);
            }
            let menu_of_tab =
                Popup::context_menu(&tab).close_behavior(PopupCloseBehavior::CloseOnClickOutside);
            menu_of_tab.show(|ui| menu(ui, index, &file.name, wishes));
        }
        for asset in session.assets() {
            asset_tab(ui, asset, editor, wishes);
        }
        let tip = "Add a file that this one can read";
        if icon::button(ui, Icon::Add, tip, true).clicked() {
            wishes.push(TextWish::AddFile);
        }
        let tip = "Open files, or drop them on the page: texts, images, meshes";
        let pick = icon::button(ui, Icon::Open, tip, true);
        places::note(ui.ctx(), "open files", pick.rect);
        if pick.clicked() {
            wishes.push(WorkWish::PickFiles);
        }
        if editor.asset.is_none() {
            let tip = "Lay the text out neatly (Ctrl+Shift+F)";
            let button = icon::button(ui, Icon::Lines, tip, true);
            places::note(ui.ctx(), "lay out", button.rect);
            if button.clicked() {
                editor.format(session, wishes);
            }
        }
        if !summary {
            return;
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.add_space(12.0);
            let diagnostics = session.messages();
            let text = problems::summary(diagnostics);
            if !text.is_empty() {
                let worst = diagnostics.iter().map(|d| d.severity).max();
                let colour = worst.map_or(palette.weak, |worst| problems::colour(palette, worst));
                ui.label(RichText::new(text).size(12.5).color(colour));
            }
        });
    });
}

/// Shows the tab of an image or a mesh, with an icon before its name.
fn asset_tab(ui: &mut Ui, asset: &Asset, editor: &mut Editor, wishes: &mut Wishes) {
    let palette = theme::palette(ui.visuals());
    let open = editor.asset.as_deref() == Some(&asset.name);
    let (colour, fill) = if open {
        (palette.strong, palette.button)
    } else {
        (palette.weak, Color32::TRANSPARENT)
    };
    let (sign, what) = match asset::kind(&asset.name) {
        Some(asset::Kind::Image) => (Icon::Image, "Image"),
        Some(asset::Kind::Skeleton) => (Icon::Mesh, "Skeleton"),
        _ => (Icon::Mesh, "Mesh"),
    };
    let text = RichText::new(format!("      {}", asset.name))
        .size(12.5)
        .italics()
        .color(colour);
    let size = asset::size(asset.bytes.len());
    let tab = ui
        .add(Button::new(text).fill(fill))
        .on_hover_text(format!("{what}, {size}. Right-click to remove it."));
    let at = tab.rect.left_center() + egui::vec2(ui.spacing().button_padding.x + 6.0, 0.0);
    icon::paint(ui.painter(), sign, at, egui::Stroke::new(1.2, colour));
    places::note(ui.ctx(), format!("tab {}", asset.name), tab.rect);
    if tab.clicked() {
        editor.asset = Some(asset.name.clone());
    }
    Popup::context_menu(&tab).show(|ui| {
        if ui.button("Remove").clicked() {
            wishes.push(TextWish::RemoveAsset(asset.name.clone()));
            ui.close();
        }
    });
}

/// Shows the context menu of a tab.
fn menu(ui: &mut Ui, index: usize, name: &str, wishes: &mut Wishes) {
    ui.set_min_width(190.0);
    let id = ui.scope_id().with(("rename", index));
    let mut new = ui
        .data(|data| data.get_temp::<String>(id))
        .unwrap_or_else(|| name.to_owned());
    let field = ui.add(TextEdit::singleline(&mut new).hint_text("Name of the file"));
    let done = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
    if ui.button("Rename").clicked() || done {
        wishes.push(TextWish::RenameFile(index, new));
        ui.data_mut(|data| data.remove::<String>(id));
        ui.close();
        return;
    }
    ui.data_mut(|data| data.insert_temp(id, new));
    if index > 0 && ui.button("Remove").clicked() {
        wishes.push(TextWish::RemoveFile(index));
        ui.close();
    }
}
