//! The strip at the top: examples, the name of the work, undo, and above all Share.

use crate::film::FilmPanel;
use crate::icon::{self, Icon};
use crate::page::Page;
use crate::wish::{Dialog, LabWish, SculptWish, Setting, TextWish, Wish, Wishes, WorkWish};
use crate::{download, places, theme};
use document::work::{Origin, Work};
use egui::{Align, Button, Layout, RichText, TextEdit, Ui};

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
        let gallery = ui
            .button("Examples")
            .on_hover_text("Pick a model to start from, or one of your own");
        places::note(ui.ctx(), "examples", gallery.rect);
        if gallery.clicked() {
            wishes.push(Wish::Open(Dialog::Gallery));
        }
        let lab = ui
            .button("Lab")
            .on_hover_text("See and try out how convolution surfaces work");
        places::note(ui.ctx(), "lab", lab.rect);
        if lab.clicked() {
            wishes.push(LabWish::Show);
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

fn more(page: &Page, film: &FilmPanel, ui: &mut Ui, wishes: &mut Wishes) {
    let choice = page.settings.theme;
    let button = icon::button(ui, Icon::More, "More", true);
    places::note(ui.ctx(), "more", button.rect);
    egui::Popup::menu(&button).show(|ui| {
        ui.set_min_width(190.0);
        let sculpt = ui.button("Sculpt");
        places::note(ui.ctx(), "sculpt", sculpt.rect);
        if sculpt.clicked() {
            wishes.push(SculptWish::Show);
        }
        if ui.button("How it works").clicked() {
            wishes.push(Wish::Open(Dialog::Help));
        }
        if ui.button("Open files…").clicked() {
            wishes.push(WorkWish::PickFiles);
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
    });
}
