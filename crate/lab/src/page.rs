//! The lab's page: its bar, the list of lessons, and the open lesson.

use crate::bench::Bench;
use crate::command::Command;
use crate::dataset::Dataset;
use crate::lesson::Lesson;
use crate::state::Lab;
use egui::{
    Align, Align2, Button, CentralPanel, Color32, FontId, Layout, Margin, Panel, Rect, RichText,
    ScrollArea, Sense, Stroke, Ui, vec2,
};
use widgets::icon::{self, Icon};
use widgets::{places, screen, theme};

/// Width of the list of lessons on a wide page.
const LIST: f32 = 236.0;
/// Widest line of text that reads well, points.
const MEASURE: f32 = 820.0;

/// State outside the lab that its page shows.
pub struct Frame<'a> {
    /// The dataset that is open in the editor.
    pub dataset: Dataset<'a>,
    /// Fraction done of the picture that the workers trace for the editor, while they do.
    pub tracing: Option<f64>,
    /// The chosen palette.
    pub theme: theme::Choice,
    /// Seconds on the page's clock.
    pub now: f64,
}

/// Draws the lab in place of the editor.
pub fn show(lab: &mut Lab, frame: &Frame<'_>, ui: &mut Ui, commands: &mut Vec<Command>) {
    let narrow = screen::is_narrow(ui.ctx());
    let palette = theme::palette(ui.visuals());
    let flat = egui::Frame::new().fill(palette.panel);
    lab.pictures.begin_frame();
    lab.readings.clear();
    Panel::top("lab bar")
        .exact_size(if narrow { 52.0 } else { 46.0 })
        .frame(flat)
        .show(ui, |ui| lab_bar(lab, frame, ui, narrow, commands));
    if narrow {
        Panel::top("lab lessons")
            .exact_size(54.0)
            .frame(flat)
            .show(ui, |ui| strip(lab.lesson, ui, commands));
    } else {
        Panel::left("lab lessons")
            .exact_size(LIST)
            .resizable(false)
            .frame(flat.inner_margin(Margin::symmetric(12, 14)))
            .show(ui, |ui| list(lab.lesson, ui, commands));
    }
    lab.pictures.blocked = frame.tracing;
    CentralPanel::no_frame().show(ui, |ui| {
        let all = ui.max_rect();
        ui.painter().rect_filled(all, 0.0, palette.panel);
        let margin = if narrow { 14.0 } else { 28.0 };
        ScrollArea::vertical()
            .id_salt(("lesson", lab.lesson))
            .auto_shrink(false)
            .show(ui, |ui| {
                let width = (all.width() - 2.0 * margin).min(1500.0);
                egui::Frame::new()
                    .inner_margin(Margin::symmetric(
                        margin as i8,
                        if narrow { 14 } else { 22 },
                    ))
                    .show(ui, |ui| {
                        ui.set_width(width);
                        ui.spacing_mut().item_spacing = vec2(8.0, 8.0);
                        lesson(lab, frame.dataset, ui, all, narrow, commands);
                    });
            });
    });
}

/// Draws the bar of the lab.
fn lab_bar(
    lab: &mut Lab,
    frame: &Frame<'_>,
    ui: &mut Ui,
    narrow: bool,
    commands: &mut Vec<Command>,
) {
    let palette = theme::palette(ui.visuals());
    ui.horizontal_centered(|ui| {
        ui.add_space(if narrow { 6.0 } else { 12.0 });
        let back = ui
            .button("‹ Editor")
            .on_hover_text("Back to your dataset, as you left it (Esc)");
        places::note(ui.ctx(), "lab back", back.rect);
        if back.clicked() {
            commands.push(Command::Close);
        }
        ui.add_space(4.0);
        icon::mark(ui);
        ui.label(RichText::new("Lab").size(17.0).color(palette.strong));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.add_space(if narrow { 6.0 } else { 12.0 });
            let share = Button::new(RichText::new("Share").color(palette.on_accent).size(14.5))
                .fill(palette.accent);
            let share = ui.add(share).on_hover_text("Copy a link to this lesson");
            places::note(ui.ctx(), "lab share", share.rect);
            if share.clicked() {
                commands.push(Command::Share);
            }
            let next = theme::other(ui);
            let tip = format!("Colours: {}", theme::label(frame.theme));
            if icon::button(ui, Icon::Theme, &tip, true).clicked() {
                commands.push(Command::SetTheme(next));
            }
            let now = frame.now;
            if let Some((message, until)) = lab.message {
                if now < until {
                    ui.label(RichText::new(message).color(palette.weak).size(13.0));
                    ui.ctx().request_repaint_after_secs((until - now) as f32);
                } else {
                    lab.message = None;
                }
            }
        });
    });
}

/// Draws the lessons side by side, for a narrow page.
fn strip(open: Lesson, ui: &mut Ui, commands: &mut Vec<Command>) {
    let palette = theme::palette(ui.visuals());
    ScrollArea::horizontal()
        .id_salt("lessons")
        .scroll_bar_visibility(egui::scroll_area::ScrollBarVisibility::AlwaysHidden)
        .auto_shrink(false)
        .show(ui, |ui| {
            ui.horizontal_centered(|ui| {
                ui.add_space(10.0);
                for (index, lesson) in Lesson::all().enumerate() {
                    let chosen = lesson == open;
                    let colour = if chosen { palette.strong } else { palette.weak };
                    let label = format!("{}  {}", index + 1, lesson.words().short);
                    let button = Button::new(RichText::new(label).color(colour)).fill(if chosen {
                        palette.button
                    } else {
                        Color32::TRANSPARENT
                    });
                    let button = ui.add(button);
                    note(ui, lesson, button.rect);
                    if chosen && !ui.clip_rect().contains_rect(button.rect) {
                        button.scroll_to_me(Some(Align::Center));
                    }
                    if button.clicked() && !chosen {
                        commands.push(Command::Open(lesson));
                    }
                }
                ui.add_space(10.0);
            });
        });
}

/// Notes the place of a lesson's button for tests.
fn note(ui: &Ui, lesson: Lesson, rect: Rect) {
    places::note(
        ui.ctx(),
        format!("lab lesson {}", lesson.words().link),
        rect,
    );
}

/// Draws the lessons below each other, for a wide page.
fn list(open: Lesson, ui: &mut Ui, commands: &mut Vec<Command>) {
    let palette = theme::palette(ui.visuals());
    ui.spacing_mut().item_spacing.y = 4.0;
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        for (index, lesson) in Lesson::all().enumerate() {
            let words = lesson.words();
            let chosen = lesson == open;
            let size = vec2(ui.available_width(), 52.0);
            let (rect, response) = ui.allocate_exact_size(size, Sense::click());
            response.widget_info(|| {
                egui::WidgetInfo::selected(egui::Role::Button, true, chosen, words.title)
            });
            note(ui, lesson, rect);
            let painter = ui.painter();
            let fill = if chosen {
                palette.button
            } else if response.hovered() || response.has_focus() {
                palette.hover
            } else {
                Color32::TRANSPARENT
            };
            painter.rect_filled(rect, 8.0, fill);
            if chosen {
                let mark = Rect::from_min_size(rect.min + vec2(0.0, 12.0), vec2(3.0, 28.0));
                painter.rect_filled(mark, 1.5, palette.accent);
            }
            painter.text(
                rect.min + vec2(22.0, 18.0),
                Align2::CENTER_CENTER,
                index + 1,
                FontId::proportional(13.0),
                if chosen { palette.accent } else { palette.weak },
            );
            painter.text(
                rect.min + vec2(38.0, 18.0),
                Align2::LEFT_CENTER,
                words.name,
                FontId::proportional(14.5),
                if chosen { palette.strong } else { palette.text },
            );
            painter.text(
                rect.min + vec2(38.0, 36.0),
                Align2::LEFT_CENTER,
                words.about,
                FontId::proportional(11.5),
                palette.weak,
            );
            let clicked = response
                .on_hover_cursor(egui::CursorIcon::PointingHand)
                .clicked();
            if clicked && !chosen {
                commands.push(Command::Open(lesson));
            }
        }
    });
}

/// Draws title, sentences, button, and the figure.
fn lesson(
    lab: &mut Lab,
    dataset: Dataset<'_>,
    ui: &mut Ui,
    all: Rect,
    narrow: bool,
    commands: &mut Vec<Command>,
) {
    let palette = theme::palette(ui.visuals());
    let words = lab.lesson.words();
    let width = ui.available_width();
    let top = ui.cursor().top();
    let mut is_dataset_wanted = false;
    let title = RichText::new(words.title).size(if narrow { 22.0 } else { 26.0 });
    let title = title.color(palette.strong);
    if narrow {
        ui.label(title);
        ui.label(
            RichText::new(words.sentences)
                .size(14.5)
                .color(palette.text),
        );
        is_dataset_wanted |= dataset_button(ui);
    } else {
        ui.horizontal(|ui| {
            ui.label(title);
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                is_dataset_wanted |= dataset_button(ui);
            });
        });
        ui.scope(|ui| {
            ui.set_max_width(width.min(MEASURE));
            ui.label(
                RichText::new(words.sentences)
                    .size(15.0)
                    .color(palette.text),
            );
        });
    }
    ui.add_space(if narrow { 6.0 } else { 12.0 });
    let used = ui.cursor().top() - top;
    let mut bench = Bench {
        dataset,
        pictures: &mut lab.pictures,
        commands,
        readings: &mut lab.readings,
        // Beside a figure that narrow there is no room for controls.
        narrow: narrow || width < 640.0,
        height: (all.height() - used - 52.0).clamp(320.0, 900.0),
    };
    let figure = &mut lab.figures[lab.lesson.index()];
    figure.show(ui, &mut bench);
    ui.add_space(if narrow { 24.0 } else { 8.0 });
    if is_dataset_wanted {
        commands.push(figure.dataset());
    }
}

/// Draws the button that opens the lesson as a dataset; returns whether it was clicked.
fn dataset_button(ui: &mut Ui) -> bool {
    let palette = theme::palette(ui.visuals());
    let button = Button::new(RichText::new("Open as dataset").color(palette.accent))
        .fill(Color32::TRANSPARENT)
        .stroke(Stroke::new(1.0, palette.accent));
    let button = ui
        .add(button)
        .on_hover_text("Go on in the editor with a text of this lesson; your own work is kept");
    places::note(ui.ctx(), "lab dataset", button.rect);
    button.clicked()
}
