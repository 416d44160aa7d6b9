//! The list of all messages of the compiler. A click goes to the place.

use crate::page::Page;
use crate::places;
use crate::theme::{self, Palette};
use crate::wish::{TextWish, Wish, Wishes};
use egui::{Button, Color32, RichText, ScrollArea, Sense, Ui, vec2};
use rats::{Diagnostic, Project, Severity};
use std::ops::Range;

/// Most rows that are shown; a text can have thousands of mistakes.
const MOST: usize = 200;

/// Returns the colour of a severity.
#[must_use]
pub fn colour(palette: &Palette, severity: Severity) -> Color32 {
    match severity {
        Severity::Error => palette.error,
        Severity::Warning => palette.warning,
        Severity::Note => palette.note,
    }
}

/// Returns the numbers of errors, warnings and notes in words; empty if there are none.
#[must_use]
pub fn summary(diagnostics: &[Diagnostic]) -> String {
    let mut parts = Vec::new();
    for (severity, one, many) in [
        (Severity::Error, "error", "errors"),
        (Severity::Warning, "warning", "warnings"),
        (Severity::Note, "note", "notes"),
    ] {
        let of_severity = diagnostics.iter().filter(|d| d.severity == severity);
        match of_severity.count() {
            0 => {}
            1 => parts.push(format!("1 {one}")),
            n => parts.push(format!("{n} {many}")),
        }
    }
    parts.join(", ")
}

/// Shows the list in all of `ui`.
pub fn show(page: &Page, ui: &mut Ui, wishes: &mut Wishes) {
    // It has its place even while there is nothing to tell.
    ui.set_min_size(ui.available_size());
    let session = &page.work.session;
    let (project, diagnostics) = (session.project(), session.messages());
    if diagnostics.is_empty() {
        ui.weak("No problems.");
        return;
    }
    places::note(ui.ctx(), "problems", ui.max_rect());
    let area = ScrollArea::vertical().id_salt("problems");
    let area = area.min_scrolled_height(0.0).auto_shrink(false);
    area.show(ui, |ui| {
        let palette = theme::palette(ui.visuals());
        ui.spacing_mut().item_spacing.y = 2.0;
        for (index, diagnostic) in diagnostics.iter().take(MOST).enumerate() {
            ui.push_id(("problem", index), |ui| {
                let clicked = row(ui, palette, project, diagnostic, index == 0).clicked();
                let place = (&diagnostic.file, &diagnostic.span);
                wishes.extend(jump(project, place).filter(|_| clicked));
                more(ui, palette, project, diagnostic, wishes);
            });
        }
        if diagnostics.len() > MOST {
            ui.weak(format!("… and {} more", diagnostics.len() - MOST));
        }
    });
}

/// Returns the wish that goes to a place, if its file is still there.
fn jump(project: &Project, (name, span): (&String, &Range<usize>)) -> Option<TextWish> {
    let file = project.files.iter().position(|file| file.name == *name)?;
    Some(TextWish::Jump {
        file,
        range: span.clone(),
    })
}

/// Shows buttons below a message: other places that explain it, and the manual.
fn more(
    ui: &mut Ui,
    palette: &Palette,
    project: &Project,
    diagnostic: &Diagnostic,
    wishes: &mut Wishes,
) {
    if diagnostic.related.is_empty() && diagnostic.command.is_none() {
        return;
    }
    ui.horizontal_wrapped(|ui| {
        ui.add_space(20.0);
        ui.spacing_mut().item_spacing.x = 4.0;
        let quiet = |text: String| {
            Button::new(RichText::new(text).size(12.5).color(palette.note))
                .fill(Color32::TRANSPARENT)
                .wrap()
        };
        for related in &diagnostic.related {
            let place = if related.file == diagnostic.file {
                format!("{}:{}", related.line, related.column)
            } else {
                format!("{}:{}:{}", related.file, related.line, related.column)
            };
            let text = format!("{place} {}", related.message);
            if ui.add(quiet(text)).on_hover_text("Go there").clicked() {
                wishes.extend(jump(project, (&related.file, &related.span)));
            }
        }
        if let Some(name) = &diagnostic.command {
            let text = format!("manual: {name}");
            if ui
                .add(quiet(text))
                .on_hover_text("How this command is written")
                .clicked()
            {
                wishes.push(Wish::Manual(name.clone()));
            }
        }
    });
}

fn row(
    ui: &mut Ui,
    palette: &Palette,
    project: &Project,
    diagnostic: &Diagnostic,
    is_first: bool,
) -> egui::Response {
    let several = project.files.len() > 1;
    let place = if several {
        format!(
            "{}:{}:{}",
            diagnostic.file, diagnostic.line, diagnostic.column
        )
    } else {
        format!("{}:{}", diagnostic.line, diagnostic.column)
    };
    let background = ui.painter().add(egui::Shape::Noop);
    let inner = ui.scope(|ui| {
        ui.set_width(ui.available_width());
        ui.add_space(3.0);
        ui.horizontal_top(|ui| {
            ui.add_space(4.0);
            let (dot, _) =
                ui.allocate_exact_size(vec2(8.0, ui.spacing().interact_size.y), Sense::hover());
            ui.painter()
                .circle_filled(dot.center(), 3.5, colour(palette, diagnostic.severity));
            ui.vertical(|ui| {
                ui.spacing_mut().item_spacing.y = 0.0;
                ui.horizontal_wrapped(|ui| {
                    ui.spacing_mut().item_spacing.x = 8.0;
                    ui.label(
                        RichText::new(place)
                            .monospace()
                            .size(12.0)
                            .color(palette.weak),
                    );
                    let message = RichText::new(&diagnostic.message).color(palette.text);
                    let message = ui.label(message);
                    if is_first {
                        // Screen readers say it when it comes.
                        ui.ctx().accesskit_node_builder(message.id, |node| {
                            node.set_live(egui::accesskit::Live::Polite);
                        });
                    }
                });
                if let Some(hint) = &diagnostic.hint {
                    ui.label(RichText::new(hint).size(12.5).color(palette.weak));
                }
            });
        });
        ui.add_space(3.0);
    });
    let name = format!("Problem at {}:{}", diagnostic.line, diagnostic.column);
    let response = ui
        .interact(
            inner.response.rect,
            ui.scope_id().with("row"),
            Sense::click(),
        )
        .on_hover_cursor(egui::CursorIcon::PointingHand);
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, name.as_str()));
    theme::ring(ui, &response);
    if response.hovered() {
        let shape = egui::Shape::rect_filled(response.rect, f32::from(theme::ROUND), palette.hover);
        ui.painter().set(background, shape);
    }
    response
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_summary_counts_each_kind() {
        assert_eq!(summary(&[]), "");
        let list = [
            diagnostic(Severity::Error),
            diagnostic(Severity::Note),
            diagnostic(Severity::Error),
        ];
        assert_eq!(summary(&list), "2 errors, 1 note");
    }

    fn diagnostic(severity: Severity) -> Diagnostic {
        Diagnostic {
            severity,
            message: String::new(),
            file: String::new(),
            span: 0..0,
            line: 1,
            column: 1,
            hint: None,
            fix: None,
            related: Vec::new(),
            command: None,
        }
    }
}
