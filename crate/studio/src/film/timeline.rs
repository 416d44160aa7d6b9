//! The strip under the picture of an animated work: play, go to a frame, save the film. While a
//! film is saved the strip shows its progress.

use super::FilmPanel;
use crate::icon::{self, Icon};
use crate::page::Page;
use crate::wish::{FilmWish, Wishes};
use crate::{download, places, slider, theme};
use browser::recording::Recording;
use document::player::{MAX_FRAMES, MAX_RATE, Playback, Player};
use egui::{
    Align, Button, DragValue, Layout, Popup, PopupCloseBehavior, ProgressBar, RichText, Slider, Ui,
};

/// Width of the strip in points above which it holds all controls.
const WIDE: f32 = 520.0;

/// Shows the strip in all of `ui`.
pub fn show(film: &FilmPanel, page: &Page, ui: &mut Ui, wishes: &mut Wishes) {
    places::note(ui.ctx(), "timeline", ui.max_rect());
    if let Some(saving) = &film.saving {
        progress(ui, &saving.recording, wishes);
        return;
    }
    let player = &film.player;
    let frame = page.work.session.film_frame();
    let palette = theme::palette(ui.visuals());
    let wide = ui.available_width() >= WIDE;
    ui.horizontal_centered(|ui| {
        ui.add_space(10.0);
        let (sign, tip) = if player.is_playing() {
            (Icon::Pause, "Pause")
        } else {
            (Icon::Play, "Play the frames one after another")
        };
        let play = icon::button(ui, sign, tip, true);
        places::note(ui.ctx(), "play", play.rect);
        if play.clicked() {
            wishes.push(FilmWish::Play);
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.add_space(10.0);
            let save = icon::button(ui, Icon::Save, "Save the film", true);
            places::note(ui.ctx(), "save film", save.rect);
            Popup::menu(&save)
                .close_behavior(PopupCloseBehavior::CloseOnClickOutside)
                .show(|ui| {
                    ui.set_width(270.0);
                    download::films(page, film, ui, wishes);
                });
            if wide {
                playback(ui, player, wishes);
                rate(ui, player, wishes);
                count(ui, player, wishes);
                ui.label(RichText::new(format!("frame {frame} of")).color(palette.weak));
            } else {
                let more = icon::button(ui, Icon::More, "Number of frames, speed, playback", true);
                places::note(ui.ctx(), "film settings", more.rect);
                Popup::menu(&more)
                    .close_behavior(PopupCloseBehavior::CloseOnClickOutside)
                    .show(|ui| settings(ui, player, wishes));
                let text = format!("{frame} / {}", player.count);
                ui.label(RichText::new(text).color(palette.weak));
            }
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                scrub(ui, player, frame, wishes);
            });
        });
    });
}

/// Shows the slider of frames, as wide as there is room.
fn scrub(ui: &mut Ui, player: &Player, frame: u32, wishes: &mut Wishes) {
    let mut wanted = frame;
    let last = player.count.saturating_sub(1).max(1);
    let width = (ui.available_width() - 12.0).max(40.0);
    let slider = ui.scope(|ui| {
        slider::colours(ui);
        ui.spacing_mut().slider_width = width;
        ui.add(
            Slider::new(&mut wanted, 0..=last)
                .clamping(egui::SliderClamping::Never)
                .show_value(false),
        )
    });
    let slider = slider.inner.accessible_name("Frame of the film");
    places::note(ui.ctx(), "slider frame", slider.rect);
    if slider.changed() {
        wishes.push(FilmWish::SetFrame(wanted));
    }
}

fn count(ui: &mut Ui, player: &Player, wishes: &mut Wishes) {
    let mut count = player.count;
    let field = ui
        .add(DragValue::new(&mut count).range(2..=MAX_FRAMES))
        .accessible_name("Number of frames")
        .on_hover_text("How many frames are played and saved");
    places::note(ui.ctx(), "film length", field.rect);
    if field.changed() {
        wishes.push(FilmWish::SetLength(count));
    }
}

fn rate(ui: &mut Ui, player: &Player, wishes: &mut Wishes) {
    let mut rate = player.rate;
    let field = ui
        .add(DragValue::new(&mut rate).range(1..=MAX_RATE).suffix(" fps"))
        .accessible_name("Frames in a second")
        .on_hover_text("How many frames are shown in a second, played and saved");
    if field.changed() {
        wishes.push(FilmWish::SetRate(rate));
    }
}

fn playback(ui: &mut Ui, player: &Player, wishes: &mut Wishes) {
    let menu = ui.menu_button(player.playback.label(), |ui| {
        for playback in Playback::ALL {
            let chosen = player.playback == playback;
            if ui.selectable_label(chosen, playback.label()).clicked() {
                wishes.push(FilmWish::SetPlayback(playback));
                ui.close();
            }
        }
    });
    places::note(ui.ctx(), "playback", menu.response.rect);
    menu.response
        .on_hover_text("What comes after the last frame, played and saved");
}

/// Shows the menu of controls that have no room in a narrow strip.
fn settings(ui: &mut Ui, player: &Player, wishes: &mut Wishes) {
    egui::Grid::new("film settings")
        .num_columns(2)
        .spacing([16.0, 8.0])
        .show(ui, |ui| {
            download::label(ui, "Frames");
            count(ui, player, wishes);
            ui.end_row();
            download::label(ui, "Speed");
            rate(ui, player, wishes);
            ui.end_row();
        });
    ui.separator();
    for playback in Playback::ALL {
        let chosen = player.playback == playback;
        let choice = ui.selectable_label(chosen, playback.label());
        places::note(
            ui.ctx(),
            format!("playback {}", playback.label()),
            choice.rect,
        );
        if choice.clicked() {
            wishes.push(FilmWish::SetPlayback(playback));
        }
    }
}

/// Shows the progress of a film, and a button that stops it.
fn progress(ui: &mut Ui, recording: &Recording, wishes: &mut Wishes) {
    let palette = theme::palette(ui.visuals());
    let now = browser::now(ui.ctx());
    ui.horizontal_centered(|ui| {
        ui.add_space(12.0);
        let words = RichText::new(recording.words(now)).color(palette.text);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.add_space(10.0);
            let stop = Button::new(RichText::new("Stop").color(palette.on_accent));
            let stop = ui.add(stop.fill(palette.accent));
            places::note(ui.ctx(), "stop film", stop.rect);
            if stop.clicked() {
                wishes.push(FilmWish::Stop);
            }
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                ui.label(words);
                let width = ui.available_width() - 8.0;
                if width > 30.0 {
                    let bar = ProgressBar::new(recording.fraction());
                    let bar = bar
                        .desired_width(width)
                        .desired_height(6.0)
                        .fill(palette.accent);
                    ui.add(bar);
                }
            });
        });
    });
}
