//! The strip under the picture of an animated work: play, go to a frame, save the film.

use crate::command::Command;
use crate::film::{MAX_FRAMES, Player};
use crate::icon::{self, Icon};
use crate::{places, slider, theme};
use egui::{DragValue, RichText, Slider, Ui};

/// Shows the strip in all of `ui`; `frame` is the frame on show.
pub fn show(ui: &mut Ui, player: &Player, frame: u32, commands: &mut Vec<Command>) {
    let palette = theme::palette(ui.visuals());
    places::note(ui.ctx(), "timeline", ui.max_rect());
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
            commands.push(Command::Play);
        }
        let mut shown = frame;
        let last = player.count.saturating_sub(1).max(1);
        let width = (ui.available_width() - 200.0).clamp(60.0, 520.0);
        let slider = ui.scope(|ui| {
            slider::colours(ui);
            ui.spacing_mut().slider_width = width;
            ui.add(
                Slider::new(&mut shown, 0..=last)
                    .clamping(egui::SliderClamping::Never)
                    .show_value(false),
            )
        });
        let slider = slider.inner.accessible_name("Frame of the film");
        places::note(ui.ctx(), "slider frame", slider.rect);
        if slider.changed() {
            commands.push(Command::SetFilmFrame(shown));
        }
        ui.label(RichText::new(format!("frame {frame} of")).color(palette.weak));
        let mut count = player.count;
        let field = ui
            .add(DragValue::new(&mut count).range(2..=MAX_FRAMES))
            .accessible_name("Number of frames")
            .on_hover_text("How many frames are played and saved");
        if field.changed() {
            commands.push(Command::SetFilmLength(count));
        }
        let tip = "Save all frames as an animated PNG";
        let save = icon::button(ui, Icon::Save, tip, true);
        places::note(ui.ctx(), "save film", save.rect);
        if save.clicked() {
            commands.push(Command::SaveFilm);
        }
    });
}
