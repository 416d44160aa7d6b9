//! The menu of everything that the page can save as a file.

use crate::film::FilmPanel;
use crate::page::Page;
use crate::wish::{Dialog, FilmWish, Quality, ViewWish, Wish, Wishes, WorkWish};
use crate::{places, theme};
use browser::recording::Kind;
use egui::{Button, RichText, Ui};

/// Lists what there is to download.
pub fn menu(page: &Page, film: &FilmPanel, ui: &mut Ui, wishes: &mut Wishes) {
    ui.set_width(270.0);
    let size = page.renderer.image().map(|image| image.size);
    let picture = match size {
        Some([width, height]) => format!("PNG, {width} × {height} pixels"),
        None => String::from("not traced yet"),
    };
    if row(ui, "download picture", "Picture", &picture) {
        wishes.push(ViewWish::Save);
    }
    if row(
        ui,
        "download mesh",
        "3D model …",
        "a mesh to print, or for Blender: STL, 3MF, GLB, OBJ, PLY",
    ) {
        wishes.push(Wish::Open(Dialog::Mesh));
    }
    if row(
        ui,
        "download project",
        "Project",
        "one zip of all texts, images and meshes",
    ) {
        wishes.push(WorkWish::Save);
    }
    if page.work.session.has_frames() {
        ui.separator();
        films(page, film, ui, wishes);
    }
}

/// Lists the kinds of files that a film can become, after the choice of how its frames are made.
pub fn films(page: &Page, film: &FilmPanel, ui: &mut Ui, wishes: &mut Wishes) {
    if page.screen.has_draft {
        let quality = film.quality(page);
        ui.horizontal_wrapped(|ui| {
            label(ui, "Frames");
            for own in [Quality::Traced]
                .into_iter()
                .chain(Quality::LINES.map(Quality::Draft))
            {
                let (text, tip) = match own {
                    Quality::Traced => ("traced".into(), "As fine as the picture"),
                    Quality::Draft(lines) => (
                        format!("draft {lines}"),
                        "As the draft shows them, in a fraction of the time; pixels of the \
                         shorter side",
                    ),
                };
                let choice = ui.selectable_label(quality == own, &text);
                places::note(ui.ctx(), format!("film {text}"), choice.rect);
                if choice.on_hover_text(tip).clicked() {
                    wishes.push(FilmWish::SetQuality(own));
                }
            }
        });
    }
    let formats = film.formats();
    for kind in Kind::ALL {
        if kind.is_video() && formats.iter().all(|format| format.kind != kind) {
            continue;
        }
        let name = format!("download {}", kind.extension());
        let title = format!("Film: {}", kind.label());
        if row(ui, &name, &title, kind.facts()) {
            wishes.push(FilmWish::Save(kind));
        }
    }
}

/// A row of the menu with an explanation below. Returns whether it was clicked.
fn row(ui: &mut Ui, place: &str, title: &str, facts: &str) -> bool {
    let palette = theme::palette(ui.visuals());
    let mut text = egui::text::LayoutJob::default();
    let body = egui::TextStyle::Button.resolve(ui.style());
    let small = egui::FontId::proportional(12.0);
    for (part, font, colour) in [
        (title, body, palette.text),
        ("\n", small.clone(), palette.weak),
        (facts, small, palette.weak),
    ] {
        text.append(part, 0.0, egui::TextFormat::simple(font, colour));
    }
    let button = Button::new(text).min_size(egui::vec2(ui.available_width(), 0.0));
    let button = ui.add(button);
    places::note(ui.ctx(), place, button.rect);
    if button.clicked() {
        ui.close();
    }
    button.clicked()
}

/// A line that says what a control is for.
pub fn label(ui: &mut Ui, text: &str) {
    let palette = theme::palette(ui.visuals());
    ui.label(RichText::new(text).size(12.5).color(palette.weak));
}
