//! The strip below the picture that shows the results side by side.

use super::Tray;
use super::item::{Content, Film, Item};
use crate::icon::{self, Icon};
use crate::wish::{TrayWish, Wishes};
use crate::works::gallery::contain;
use crate::{places, theme};
use egui::text::{LayoutJob, TextWrapping};
use egui::{
    Align, Align2, CornerRadius, FontId, Layout, Painter, Pos2, Rect, RichText, ScrollArea, Sense,
    Stroke, TextFormat, Ui, Vec2, vec2,
};

/// Height of the head on a wide page, points.
const HEAD: f32 = 32.0;

/// The measures of a card, points.
struct Measures {
    /// Size of the thumbnail.
    picture: Vec2,
    /// Height of the caption.
    words: f32,
    /// Width of a card with a sentence.
    sentence: f32,
    /// Space between cards.
    gap: f32,
}

const WIDE: Measures = Measures {
    picture: vec2(124.0, 82.0),
    words: 36.0,
    sentence: 236.0,
    gap: 10.0,
};
const NARROW: Measures = Measures {
    picture: vec2(88.0, 56.0),
    words: 20.0,
    sentence: 190.0,
    gap: 8.0,
};

/// Returns the height of the strip.
#[must_use]
pub fn height(narrow: bool, folded: bool) -> f32 {
    match (narrow, folded) {
        (true, _) => NARROW.picture.y + NARROW.words + 2.0 * NARROW.gap,
        (false, true) => HEAD,
        (false, false) => HEAD + WIDE.picture.y + WIDE.words + WIDE.gap + 4.0,
    }
}

/// Shows the strip in all of `ui`.
pub fn show(ui: &mut Ui, tray: &Tray, narrow: bool, wishes: &mut Wishes) {
    places::note(ui.ctx(), "tray", ui.max_rect());
    if !narrow {
        head(ui, tray, wishes);
        if tray.folded {
            return;
        }
    }
    let measures = if narrow { &NARROW } else { &WIDE };
    let all = ui.available_rect_before_wrap();
    let mut ui = ui.new_child(places::part("tray results", all));
    // The wheel, too, scrolls along the strip.
    ui.style_mut().always_scroll_the_only_direction = true;
    ScrollArea::horizontal()
        .id_salt("results")
        .auto_shrink(false)
        .show(&mut ui, |ui| {
            if narrow {
                ui.add_space(measures.gap);
            }
            ui.horizontal(|ui| {
                ui.spacing_mut().item_spacing.x = measures.gap;
                ui.add_space(12.0);
                for (index, item) in tray.items().iter().enumerate() {
                    if card(ui, item, measures) {
                        wishes.push(TrayWish::Show(index));
                    }
                }
                let state = tray.state();
                if narrow && !state.is_empty() {
                    let palette = theme::palette(ui.visuals());
                    ui.label(RichText::new(state).size(12.5).color(palette.weak));
                }
                ui.add_space(4.0);
            });
        });
}

/// Shows the title, the progress of the jobs, and a button that folds the strip.
fn head(ui: &mut Ui, tray: &Tray, wishes: &mut Wishes) {
    let palette = theme::palette(ui.visuals());
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), HEAD), Sense::hover());
    let part = places::part("tray head", rect).layout(Layout::left_to_right(Align::Center));
    let mut ui = ui.new_child(part);
    ui.add_space(12.0);
    let count = tray.items().len();
    let refused = tray.items().iter().filter(|item| item.is_refused()).count();
    let title = match count - refused {
        0 => String::from("Results"),
        count => format!("Results {count}"),
    };
    ui.label(RichText::new(title).size(12.5).color(palette.weak))
        .on_hover_text("Results of the commands on pictures in the text");
    if refused > 0 {
        let text = format!("{refused} could not be made");
        ui.label(RichText::new(text).size(12.5).color(palette.error));
    }
    let state = tray.state();
    if !state.is_empty() {
        ui.label(RichText::new(state).size(12.5).color(palette.weak));
    }
    ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
        ui.add_space(8.0);
        let (sign, tip) = if tray.folded {
            (Icon::Up, "Show the results")
        } else {
            (Icon::Down, "Hide the results")
        };
        let fold = icon::button(ui, sign, tip, true);
        places::note(ui.ctx(), "fold tray", fold.rect);
        if fold.clicked() {
            wishes.push(TrayWish::Fold(!tray.folded));
        }
    });
}

/// Shows the card of a result. Returns whether it was clicked.
fn card(ui: &mut Ui, item: &Item, measures: &Measures) -> bool {
    let palette = theme::palette(ui.visuals());
    let film = item.film();
    let width = match film {
        Some(_) => measures.picture.x,
        None => measures.sentence,
    };
    let size = vec2(width, measures.picture.y + measures.words);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    response.widget_info(|| {
        let name = match &item.content {
            Content::Refused => format!("{} could not be done: {}", item.command, item.message),
            _ => format!("Show {}", item.title()),
        };
        egui::WidgetInfo::labeled(egui::Role::Button, true, name)
    });
    places::note(ui.ctx(), format!("result {}", item.title()), rect);
    if ui.is_rect_visible(rect) {
        let hot = response.hovered() || response.has_focus();
        let painter = ui.painter_at(rect);
        painter.rect_filled(rect, 8.0, if hot { palette.hover } else { palette.button });
        match film {
            Some(film) => picture_card(ui, &painter, rect, film, measures),
            None => sentence_card(&painter, rect, item, palette),
        }
    }
    response
        .on_hover_cursor(egui::CursorIcon::PointingHand)
        .on_hover_text(&item.message)
        .clicked()
}

fn picture_card(ui: &Ui, painter: &Painter, rect: Rect, film: &Film, measures: &Measures) {
    let palette = theme::palette(ui.visuals());
    let place = Rect::from_min_size(rect.min, measures.picture);
    let round = CornerRadius {
        nw: 8,
        ne: 8,
        sw: 0,
        se: 0,
    };
    painter.rect_filled(place, round, palette.stage);
    let small = measures.words < 30.0;
    let mut facts = String::new();
    match &film.look {
        Some(Some(look)) => {
            let [width, height] = look.size;
            facts = format!("{width} × {height}");
            let inner = contain(look.thumbnail.size_vec2(), place);
            let round = if inner == place {
                round
            } else {
                CornerRadius::ZERO
            };
            egui::Image::from_texture(&look.thumbnail)
                .corner_radius(round)
                .paint_at(ui, inner);
            if look.moves {
                let at = place.right_bottom() - vec2(16.0, 16.0);
                painter.circle_filled(at, 11.0, egui::Color32::from_black_alpha(150));
                let white = Stroke::new(1.0, egui::Color32::WHITE);
                icon::paint(painter, Icon::Play, at, white);
            }
        }
        Some(None) => facts = String::from("damaged"),
        None => {}
    }
    let at = place.left_bottom() + vec2(8.0, if small { 3.0 } else { 4.0 });
    let width = rect.width() - 16.0;
    let size = if small { 11.5 } else { 12.5 };
    line(painter, at, width, &film.name, size, palette.strong);
    if !small {
        let at = at + vec2(0.0, 16.0);
        line(painter, at, width, &facts, 11.5, palette.weak);
    }
}

/// Paints the card of a result without a picture, with the job's message.
fn sentence_card(painter: &Painter, rect: Rect, item: &Item, palette: &theme::Palette) {
    let (edge, title) = match item.content {
        Content::Refused => (palette.error, palette.error),
        _ => (palette.note, palette.strong),
    };
    let bar = Rect::from_min_size(rect.min, vec2(3.0, rect.height()));
    painter.rect_filled(bar, 2.0, edge);
    let at = rect.min + vec2(12.0, 7.0);
    let font = FontId::proportional(12.5);
    painter.text(at, Align2::LEFT_TOP, item.command, font, title);
    let at = at + vec2(0.0, 18.0);
    let format = TextFormat::simple(FontId::proportional(11.5), palette.text);
    let mut job = LayoutJob::single_section(item.message.clone(), format);
    let rows = ((rect.bottom() - at.y - 4.0) / 14.5).floor().max(1.0) as usize;
    job.wrap = TextWrapping {
        max_width: rect.right() - at.x - 10.0,
        max_rows: rows,
        ..TextWrapping::default()
    };
    let galley = painter.layout_job(job);
    painter.galley(at, galley, palette.text);
}

/// Paints a line of text, which is cut off with dots at a width.
fn line(painter: &Painter, at: Pos2, width: f32, text: &str, size: f32, colour: egui::Color32) {
    let format = TextFormat::simple(FontId::proportional(size), colour);
    let mut job = LayoutJob::single_section(text.to_owned(), format);
    job.wrap = TextWrapping::truncate_at_width(width);
    let galley = painter.layout_job(job);
    painter.galley(at, galley, colour);
}
