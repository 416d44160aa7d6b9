//! The strip at the top: whole works, examples, the name of the work, undo, and above all Share.

use crate::film::FilmPanel;
use crate::icon::{self, Icon};
use crate::page::Page;
use crate::text::editor::find::Seek;
use crate::wish::{
    Dialog, LabWish, SculptWish, Setting, TextWish, ViewWish, Wish, Wishes, WorkWish,
};
use crate::{download, places, theme};
use document::work::{Origin, Work};
use egui::{Align, Button, Layout, RichText, ScrollArea, TextEdit, Ui};

/// Shows the bar.
pub fn show(page: &Page, film: &FilmPanel, ui: &mut Ui, narrow: bool, wishes: &mut Wishes) {
    let (work, theme_choice) = (&page.work, page.settings.theme);
    let palette = theme::palette(ui.visuals());
    ui.horizontal_centered(|ui| {
        ui.add_space(if narrow { 6.0 } else { 12.0 });
        if narrow {
            ui.spacing_mut().item_spacing.x = 4.0;
        }
        // The narrowest phones need the room for buttons.
        if ui.available_width() >= 376.0 {
            icon::mark(ui);
        }
        if !narrow {
            ui.label(RichText::new("Sinew").size(17.0).color(palette.strong));
            ui.add_space(6.0);
        }
        if !narrow {
            let button = ui
                .button("Work")
                .on_hover_text("New, open, my work, versions");
            places::note(ui.ctx(), "work", button.rect);
            egui::Popup::menu(&button).show(|ui| whole_work(ui, wishes));
        }
        let gallery = ui
            .button("Examples")
            .on_hover_text("Pick a model to start from, or one of your own");
        places::note(ui.ctx(), "examples", gallery.rect);
        if gallery.clicked() {
            wishes.push(Wish::Open(Dialog::Gallery));
        }
        if !has_short_bar(ui) {
            lab(ui, wishes);
        }
        // A narrow page has it in its menu.
        if !narrow {
            let sculpt = ui
                .button("Sculpt")
                .on_hover_text("Push and pull a mesh with virtual tools");
            places::note(ui.ctx(), "sculpt", sculpt.rect);
            if sculpt.clicked() {
                wishes.push(SculptWish::Show);
            }
        }
        if !narrow {
            name(ui, work, wishes);
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.add_space(if narrow { 6.0 } else { 12.0 });
            let share = Button::new(RichText::new("Share").color(palette.on_accent).size(14.5))
                .fill(palette.accent);
            let share = ui
                .add(share)
                .on_hover_text("Copy a link that carries the text and the view");
            places::note(ui.ctx(), "share", share.rect);
            if share.clicked() {
                wishes.push(WorkWish::Share);
            }
            if narrow {
                more(page, film, ui, wishes);
            } else {
                if icon::button(ui, Icon::Help, "How it works", true).clicked() {
                    wishes.push(Wish::Open(Dialog::Help));
                }
                let next = theme::other(ui);
                let tip = format!("Colours: {}", theme::label(theme_choice));
                if icon::button(ui, Icon::Theme, &tip, true).clicked() {
                    wishes.push(Setting::Theme(next));
                }
            }
            ui.spacing_mut().item_spacing.x = 2.0;
            let redo = icon::button(
                ui,
                Icon::Redo,
                "Redo (Ctrl+Shift+Z)",
                work.session.can_redo(),
            );
            if redo.clicked() {
                wishes.push(TextWish::Redo);
            }
            let undo = icon::button(ui, Icon::Undo, "Undo (Ctrl+Z)", work.session.can_undo());
            places::note(ui.ctx(), "undo", undo.rect);
            if undo.clicked() {
                wishes.push(TextWish::Undo);
            }
        });
    });
}

/// Whether the page is so narrow that the menu has what else stands in the bar.
fn has_short_bar(ui: &Ui) -> bool {
    ui.ctx().content_rect().width() < 350.0
}

fn lab(ui: &mut Ui, wishes: &mut Wishes) {
    let lab = ui
        .button("Lab")
        .on_hover_text("See and try out how convolution surfaces work");
    places::note(ui.ctx(), "lab", lab.rect);
    if lab.clicked() {
        wishes.push(LabWish::Show);
    }
}

/// Shows the part of a menu that is about whole works.
fn whole_work(ui: &mut Ui, wishes: &mut Wishes) {
    ui.set_min_width(190.0);
    let rows: [(&str, &str, Wish); 7] = [
        (
            "New",
            "Begin with an almost empty dataset",
            WorkWish::New.into(),
        ),
        (
            "Draw",
            "An empty page to draw a creature on",
            WorkWish::DrawNew.into(),
        ),
        (
            "Open files…",
            "Texts, projects, images, meshes",
            WorkWish::PickFiles.into(),
        ),
        (
            "My work…",
            "All that this browser keeps",
            Wish::Open(Dialog::Gallery),
        ),
        (
            "Versions…",
            "Earlier states of this work",
            Wish::Open(Dialog::Versions),
        ),
        (
            "Save project",
            "All texts, images and meshes in one file",
            WorkWish::Save.into(),
        ),
        (
            "Find and replace",
            "Ctrl+F, Ctrl+H; to a line: Ctrl+G",
            TextWish::Find(Seek::Replace).into(),
        ),
    ];
    for (text, tip, wish) in rows {
        let row = ui.button(text).on_hover_text(tip);
        places::note(ui.ctx(), format!("work {}", text.to_lowercase()), row.rect);
        if row.clicked() {
            wishes.push(wish);
        }
    }
}

fn name(ui: &mut Ui, work: &Work, wishes: &mut Wishes) {
    let palette = theme::palette(ui.visuals());
    let mut name = work.name.clone();
    let font = egui::TextStyle::Body.resolve(ui.style());
    let shown = if name.is_empty() { "Untitled" } else { &name };
    let width = ui
        .painter()
        .layout_no_wrap(shown.to_owned(), font, palette.text)
        .size()
        .x;
    let field = TextEdit::singleline(&mut name)
        .id(egui::Id::unique("work name"))
        .desired_width((width + 18.0).clamp(40.0, 260.0))
        .min_size(egui::vec2(0.0, ui.spacing().interact_size.y))
        .align(egui::Align2::LEFT_CENTER)
        .char_limit(60)
        .text_color(palette.text)
        .frame(egui::Frame::new().inner_margin(egui::Margin::symmetric(6, 3)))
        .hint_text("Untitled");
    let field = ui
        .add(field)
        .on_hover_text("Name of this work: click to change it");
    let kind = match work.origin {
        Origin::Own | Origin::Fresh => "",
        Origin::Example => "example",
        Origin::Link => "shared with you",
    };
    if !kind.is_empty() {
        ui.label(RichText::new(kind).color(palette.weak).size(12.5));
    }
    if field.changed() {
        wishes.push(WorkWish::Rename(name));
    }
}

/// Room below its button, in points, where the menu of a narrow page does not scroll.
const LOW: f32 = 700.0;

fn more(page: &Page, film: &FilmPanel, ui: &mut Ui, wishes: &mut Wishes) {
    let button = icon::button(ui, Icon::More, "More", true);
    places::note(ui.ctx(), "more", button.rect);
    // The menu scrolls in a window that is lower than it.
    let room = ui.ctx().content_rect().bottom() - button.rect.bottom() - 24.0;
    egui::Popup::menu(&button).show(|ui| {
        if room < LOW {
            // Else a menu is no higher than usual windows of egui.
            ui.set_max_height(room);
            let rows = ScrollArea::vertical().max_height(room);
            rows.show(ui, |ui| rest(page, film, ui, wishes));
        } else {
            rest(page, film, ui, wishes);
        }
    });
}

/// Shows the menu of a narrow page: all that its bar has no room for.
fn rest(page: &Page, film: &FilmPanel, ui: &mut Ui, wishes: &mut Wishes) {
    let choice = page.settings.theme;
    ui.set_min_width(190.0);
    whole_work(ui, wishes);
    ui.separator();
    if has_short_bar(ui) {
        lab(ui, wishes);
        if ui.button("See the whole model").clicked() {
            wishes.push(ViewWish::ShowAll);
        }
        if ui.button("Camera of the text").clicked() {
            wishes.push(ViewWish::SetCamera(None));
        }
    }
    let sculpt = ui.button("Sculpt");
    places::note(ui.ctx(), "sculpt", sculpt.rect);
    if sculpt.clicked() {
        wishes.push(SculptWish::Show);
    }
    if ui.button("How it works").clicked() {
        wishes.push(Wish::Open(Dialog::Help));
    }
    ui.separator();
    download::label(ui, "Download");
    download::menu(page, film, ui, wishes);
    ui.separator();
    for theme in [
        theme::Choice::System,
        theme::Choice::Dark,
        theme::Choice::Light,
    ] {
        let label = format!("Colours: {}", theme::label(theme));
        if ui.selectable_label(choice == theme, label).clicked() {
            wishes.push(Setting::Theme(theme));
        }
    }
}
