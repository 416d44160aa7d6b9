//! The earlier versions of the open work, each of which can be brought back.

use super::gallery::ago;
use crate::page::Page;
use crate::wish::{Wish, Wishes, WorkWish};
use crate::{places, theme};
use egui::{Align, Layout, RichText, ScrollArea, Ui};
use rats::Project;

/// Longest piece of a text that tells a version from others, letters.
const PIECE: usize = 48;

/// Shows the versions, the newest first.
pub fn show(page: &Page, ui: &mut Ui, wishes: &mut Wishes) {
    let palette = theme::palette(ui.visuals());
    ui.horizontal(|ui| {
        ui.label(RichText::new("Versions").heading().color(palette.strong));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if ui.button("Close").clicked() {
                wishes.push(Wish::Close);
            }
        });
    });
    ui.label(
        RichText::new(
            "The texts as they were: many of the last hour, fewer of the time before. \
                Bringing one back is a step that can be undone.",
        )
        .color(palette.weak),
    );
    ui.add_space(6.0);
    let (shelf, now) = (page.work.shelf().borrow(), browser::unix_time());
    let present = page.work.session.project();
    let all = shelf.versions().all();
    if all.is_empty() {
        ui.label("There is none yet: they come as you change the text.");
    }
    ScrollArea::vertical()
        .auto_shrink([false, true])
        .show(ui, |ui| {
            for (index, version) in all.iter().enumerate().rev() {
                ui.horizontal(|ui| {
                    let back = ui.button("Bring back");
                    places::note(ui.ctx(), format!("version {index}"), back.rect);
                    if back.clicked() {
                        wishes.push(WorkWish::BringBack(index));
                    }
                    ui.label(ago(now - version.until));
                    let (lines, piece) = difference(&version.project, present);
                    let text = RichText::new(format!("{lines} lines · {piece}"));
                    ui.add(egui::Label::new(text.color(palette.weak).size(12.5)).truncate());
                });
            }
        });
}

/// Returns the number of lines of a version, and its first line that is not the present one's.
fn difference(version: &Project, present: &Project) -> (usize, String) {
    let mut files = version.files.iter().enumerate();
    let lines = files.clone().map(|(_, file)| file.text.lines().count());
    let count = lines.sum();
    let line = files.find_map(|(index, file)| {
        let now = present
            .files
            .get(index)
            .map_or("", |file| file.text.as_str());
        let mut now = now.lines();
        let other = file.text.lines().find(|line| now.next() != Some(line));
        other.map(|line| line.trim().chars().take(PIECE).collect())
    });
    (
        count,
        line.unwrap_or_else(|| String::from("the beginning of the present text")),
    )
}
