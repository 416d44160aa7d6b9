//! The gallery: the user's own works, and examples.

use crate::first;
use crate::page::Page;
use crate::panel::Panel;
use crate::places;
use crate::theme;
use crate::thumbnail::Thumbnail;
use crate::wish::{Wish, Wishes, WorkWish};
use document::examples;
use document::storage::Entry;
use egui::text::{LayoutJob, TextWrapping};
use egui::{
    Align2, Button, Color32, CornerRadius, FontId, Rect, RichText, ScrollArea, Sense, TextEdit, Ui,
    Vec2, pos2, vec2,
};

/// Saved works that are listed at once.
const FEW: usize = 5;

/// The gallery's thumbnails, fetched when it is first opened, and the works.
#[derive(Default)]
pub struct Gallery {
    thumbnails: Vec<Thumbnail>,
    /// The text of the search field.
    search: String,
    /// The saved works, read when the gallery opens.
    entries: Vec<Entry>,
    /// The work whose deletion waits for a second click.
    to_delete: Option<String>,
    /// Whether all saved works are listed, not only the last ones.
    all: bool,
    /// Whether the search is to have the focus at the next frame.
    focus: bool,
    /// The example that was asked for last, whose files may be on their way.
    pub(super) asked: Option<usize>,
}

impl Gallery {
    /// Reads the list of saved works anew.
    pub fn refresh(&mut self, entries: Vec<Entry>) {
        self.entries = entries;
        self.to_delete = None;
        self.search.clear();
        self.all = false;
    }

    /// Gives the search the focus at the next frame.
    pub fn focus(&mut self) {
        self.focus = true;
    }

    fn examples(&mut self, ui: &mut Ui, wishes: &mut Wishes) {
        let palette = theme::palette(ui.visuals());
        if self.thumbnails.is_empty() {
            self.thumbnails = examples::ALL
                .iter()
                .map(|example| Thumbnail::fetch(ui, example.thumbnail))
                .collect();
        }
        for thumbnail in &mut self.thumbnails {
            thumbnail.arrive(ui);
        }
        let gap = 12.0;
        let columns = ((ui.available_width() + gap) / (190.0 + gap))
            .floor()
            .clamp(2.0, 3.0);
        let width = ((ui.available_width() + gap) / columns - gap).floor();
        let words = self.words();
        let found: Vec<usize> = (0..examples::ALL.len())
            .filter(|&index| examples::ALL[index].matches(&words))
            .collect();
        if !found.is_empty() && !self.entries.is_empty() {
            let heading = ui.label(RichText::new("Examples").heading().color(palette.strong));
            places::note(ui.ctx(), "examples heading", heading.rect);
        }
        for group in found.chunk_by(|a, b| examples::ALL[*a].group == examples::ALL[*b].group) {
            ui.label(RichText::new(examples::ALL[group[0]].group).color(palette.weak));
            for row in group.chunks(columns as usize) {
                ui.horizontal(|ui| {
                    ui.spacing_mut().item_spacing.x = gap;
                    for &index in row {
                        if self.card(ui, index, width) {
                            wishes.push(WorkWish::OpenExample(index));
                        }
                    }
                });
                ui.add_space(gap - ui.spacing().item_spacing.y);
            }
        }
        if found.is_empty() {
            let text = format!("No example has “{}” in its name.", self.search.trim());
            ui.label(RichText::new(text).color(palette.weak));
        }
    }

    /// Returns the words of the search, in lower case.
    fn words(&self) -> Vec<String> {
        let text = self.search.to_lowercase();
        text.split_whitespace().map(str::to_owned).collect()
    }

    /// Shows the card of an example. Returns whether it was clicked.
    fn card(&self, ui: &mut Ui, index: usize, width: f32) -> bool {
        let palette = theme::palette(ui.visuals());
        let example = &examples::ALL[index];
        let picture = vec2(width, (width * 0.75).floor());
        let (rect, response) = ui.allocate_exact_size(picture + vec2(0.0, 44.0), Sense::click());
        response.widget_info(|| {
            egui::WidgetInfo::labeled(egui::Role::Button, true, format!("Open {}", example.title))
        });
        let hot = response.hovered() || response.has_focus();
        let painter = ui.painter_at(rect);
        painter.rect_filled(rect, 8.0, if hot { palette.hover } else { palette.button });
        let place = Rect::from_min_size(rect.min, picture);
        if let Some(Thumbnail::Here(texture)) = self.thumbnails.get(index) {
            // The card's upper corners are round.
            let corners_of = |rect: Rect| CornerRadius {
                nw: 8 * u8::from(rect.min == place.min),
                ne: 8 * u8::from(rect.right_top() == place.right_top()),
                sw: 0,
                se: 0,
            };
            let size = texture.size_vec2();
            let inner = contain(size, place);
            // Edges of the picture are stretched over the free space beside it.
            for (strip, uv) in strips(inner, place, size) {
                let image = egui::Image::from_texture(texture).uv(uv);
                image.corner_radius(corners_of(strip)).paint_at(ui, strip);
            }
            let round = corners_of(inner);
            egui::Image::from_texture(texture)
                .corner_radius(round)
                .paint_at(ui, inner);
        }
        let text = place.left_bottom() + vec2(10.0, 6.0);
        painter.text(
            text,
            Align2::LEFT_TOP,
            example.title,
            FontId::proportional(14.0),
            palette.strong,
        );
        let about = FontId::proportional(11.5);
        let mut about = LayoutJob::simple_singleline(example.about.into(), about, palette.weak);
        about.wrap = TextWrapping::truncate_at_width(width - 20.0);
        let about = painter.layout_job(about);
        painter.galley(text + vec2(0.0, 18.0), about, palette.weak);
        theme::ring(ui, &response);
        if response.gained_focus() {
            response.scroll_to_me(None);
        }
        response
            .on_hover_cursor(egui::CursorIcon::PointingHand)
            .clicked()
    }

    fn works(&mut self, ui: &mut Ui, open: Option<&str>, now: f64, wishes: &mut Wishes) {
        let palette = theme::palette(ui.visuals());
        let words = self.words();
        let found: Vec<&Entry> = self
            .entries
            .iter()
            .filter(|entry| {
                let name = entry.name.to_lowercase();
                words.iter().all(|word| name.contains(word))
            })
            .collect();
        if found.is_empty() {
            return;
        }
        let heading = ui.label(RichText::new("My work").heading().color(palette.strong));
        places::note(ui.ctx(), "my work", heading.rect);
        ui.add_space(4.0);
        let shown = if self.all { found.len() } else { FEW };
        let more = found.len().saturating_sub(shown);
        for entry in found.into_iter().take(shown) {
            let is_open = open == Some(entry.id.as_str());
            ui.horizontal(|ui| {
                let name = if entry.name.is_empty() {
                    "Untitled"
                } else {
                    &entry.name
                };
                let size = vec2(
                    (ui.available_width() - 200.0).max(110.0),
                    ui.spacing().interact_size.y,
                );
                let (rect, row) = ui.allocate_exact_size(size, Sense::click());
                row.widget_info(|| {
                    egui::WidgetInfo::labeled(egui::Role::Button, true, format!("Open {name}"))
                });
                if row.hovered() || is_open {
                    ui.painter()
                        .rect_filled(rect, f32::from(theme::ROUND), palette.button);
                }
                ui.painter_at(rect.shrink(2.0)).text(
                    rect.left_center() + vec2(8.0, 0.0),
                    Align2::LEFT_CENTER,
                    name,
                    FontId::proportional(14.0),
                    palette.text,
                );
                theme::ring(ui, &row);
                if row
                    .on_hover_cursor(egui::CursorIcon::PointingHand)
                    .clicked()
                {
                    wishes.push(WorkWish::OpenSaved(entry.id.clone()));
                }
                ui.label(
                    RichText::new(ago(now - entry.saved))
                        .color(palette.weak)
                        .size(12.5),
                );
                ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                    // The scroll bar lies there.
                    ui.add_space(6.0);
                    if is_open {
                        ui.label(RichText::new("open").color(palette.weak).size(12.5));
                        return;
                    }
                    let is_sure = self.to_delete.as_ref() == Some(&entry.id);
                    let (text, colour) = if is_sure {
                        ("Really delete?", palette.error)
                    } else {
                        ("Delete", palette.weak)
                    };
                    let button = Button::new(RichText::new(text).color(colour).size(12.5))
                        .fill(Color32::TRANSPARENT);
                    if ui.add(button).clicked() {
                        if is_sure {
                            wishes.push(WorkWish::Delete(entry.id.clone()));
                        }
                        self.to_delete = Some(entry.id.clone());
                    }
                });
            });
        }
        if more > 0 && ui.button(format!("{more} more")).clicked() {
            self.all = true;
        }
        ui.add_space(14.0);
    }
}

impl Panel for Gallery {
    fn show(&mut self, page: &Page, ui: &mut Ui, wishes: &mut Wishes) {
        let (shelf, now) = (page.work.shelf().borrow(), browser::unix_time());
        let palette = theme::palette(ui.visuals());
        ui.horizontal(|ui| {
            ui.label(RichText::new("Open").heading().color(palette.strong));
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                if ui.button("Close").clicked() {
                    wishes.push(Wish::Close);
                }
                if ui
                    .button("New")
                    .on_hover_text("Begin with an almost empty dataset")
                    .clicked()
                {
                    wishes.push(WorkWish::New);
                }
                if ui
                    .button("Draw")
                    .on_hover_text("An empty page to draw a creature on")
                    .clicked()
                {
                    wishes.push(WorkWish::DrawNew);
                }
            });
        });
        ui.add_space(4.0);
        let field = ui.add(
            TextEdit::singleline(&mut self.search)
                .hint_text("Search examples and my work")
                .desired_width(f32::INFINITY)
                .margin(egui::Margin::symmetric(8, 6))
                .background_color(palette.button),
        );
        places::note(ui.ctx(), "search examples", field.rect);
        // On a phone the keyboard would cover half of the window.
        if std::mem::take(&mut self.focus) && page.screen.touch != Some(true) {
            field.request_focus();
        }
        ui.add_space(4.0);
        ScrollArea::vertical()
            .auto_shrink([false, true])
            .show(ui, |ui| {
                if self.entries.is_empty() && self.search.is_empty() {
                    first::offer(ui, wishes);
                }
                self.works(ui, shelf.open_id(), now, wishes);
                self.examples(ui, wishes);
            });
    }
}

/// Returns the largest rectangle of a picture's proportions in the middle of a place; the place
/// itself if they are nearly the same.
pub(crate) fn contain(picture: Vec2, place: Rect) -> Rect {
    let scale = (place.width() / picture.x.max(1.0)).min(place.height() / picture.y.max(1.0));
    let size = picture * scale;
    if (size - place.size()).length() < 0.06 * place.width() {
        place
    } else {
        Rect::from_center_size(place.center(), size)
    }
}

/// Returns an age in words.
pub(super) fn ago(milliseconds: f64) -> String {
    let minutes = (milliseconds / 60_000.0).max(0.0);
    if minutes < 1.0 {
        String::from("just now")
    } else if minutes < 60.0 {
        format!("{minutes:.0} min ago")
    } else if minutes < 48.0 * 60.0 {
        format!("{:.0} h ago", minutes / 60.0)
    } else {
        format!("{:.0} days ago", minutes / 1440.0)
    }
}

/// Returns the two strips of free space beside a picture in a place, each with the texture
/// coordinates of the nearest column or row of the picture.
fn strips(inner: Rect, place: Rect, size: egui::Vec2) -> [(Rect, Rect); 2] {
    let [column, row] = [0.5 / size.x, 0.5 / size.y];
    if inner.width() < place.width() {
        let [left, right] = [
            place.with_max_x(inner.left()),
            place.with_min_x(inner.right()),
        ];
        [(left, column), (right, 1.0 - column)]
            .map(|(strip, x)| (strip, Rect::from_min_max(pos2(x, 0.0), pos2(x, 1.0))))
    } else {
        let [above, below] = [
            place.with_max_y(inner.top()),
            place.with_min_y(inner.bottom()),
        ];
        [(above, row), (below, 1.0 - row)]
            .map(|(strip, y)| (strip, Rect::from_min_max(pos2(0.0, y), pos2(1.0, y))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thumbnails_are_seen_whole() {
        let place = Rect::from_min_size(pos2(0.0, 0.0), vec2(200.0, 150.0));
        assert_eq!(contain(vec2(320.0, 240.0), place), place);
        let high = contain(vec2(100.0, 300.0), place);
        assert_eq!(
            (high.size(), high.center()),
            (vec2(50.0, 150.0), place.center())
        );
    }

    #[test]
    fn strips_fill_what_a_picture_leaves_free() {
        let place = Rect::from_min_size(pos2(10.0, 20.0), vec2(200.0, 150.0));
        for size in [vec2(100.0, 300.0), vec2(300.0, 100.0)] {
            let inner = contain(size, place);
            let [first, second] = strips(inner, place, size);
            let all = inner.area() + first.0.area() + second.0.area();
            assert!((all - place.area()).abs() < 1.0, "{all}");
            assert!(first.1.area() == 0.0 && second.1.area() == 0.0);
            assert_eq!(first.0.min, place.min);
            assert_eq!(second.0.max, place.max);
        }
    }

    #[test]
    fn times_are_rough() {
        assert_eq!(ago(10.0), "just now");
        assert_eq!(ago(-1e9), "just now");
        assert_eq!(ago(5.0 * 60_000.0), "5 min ago");
        assert_eq!(ago(72.0 * 3_600_000.0), "3 days ago");
    }
}
