//! Lesson 5: the strength of a bone as a function along it.

use super::grid::note_refusal;
use crate::bench::Bench;
use crate::command::Command;
use crate::figure::{Figure, Words};
use crate::plot::{self, Axis, Plot};
use crate::tools::{Stage, heading, remark, slider};
use core::f64::consts::PI;
use egui::{Align2, CursorIcon, FontId, Rect, Sense, Stroke, StrokeKind, Ui, vec2};
use widgets::{places, theme};

/// A profile of the language.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Wave {
    Constant,
    Linear,
    Hat,
    Sin2,
}

const WAVES: [Wave; 4] = [Wave::Constant, Wave::Linear, Wave::Hat, Wave::Sin2];

impl Wave {
    fn name(self) -> &'static str {
        match self {
            Self::Constant => "constant",
            Self::Linear => "linear",
            Self::Hat => "hat",
            Self::Sin2 => "sin²",
        }
    }

    /// Returns the word of the language.
    fn word(self) -> &'static str {
        match self {
            Self::Constant => "one",
            Self::Linear => "x",
            Self::Hat => "hat",
            Self::Sin2 => "sin^2",
        }
    }

    /// Returns the factor on u for a number of bumps.
    fn scale(self, bumps: f64) -> f64 {
        match self {
            Self::Constant | Self::Linear => 1.0,
            Self::Hat => bumps,
            Self::Sin2 => PI * bumps,
        }
    }

    /// Computes the wave, from 0 to 1, as `field::Wave` does.
    fn value(self, x: f64) -> f64 {
        match self {
            Self::Constant => 1.0,
            Self::Linear => x.clamp(0.0, 1.0),
            Self::Hat => 1.0 - (2.0 * (x - x.floor()) - 1.0).abs(),
            Self::Sin2 => {
                let sine = libm::sin(x);
                sine * sine
            }
        }
    }
}

/// The words of the lesson.
pub static WORDS: Words = Words {
    link: "profiles",
    title: "Profiles",
    name: "Profiles",
    short: "Profiles",
    about: "strength along a bone",
    sentences: "A profile multiplies the field of a bone by a function along it, here drawn below \
                each picture. Where the function is large the flesh swells, where it is small the \
                flesh thins out or is gone. It is the field that is multiplied, not the radius, \
                so the outline does not copy the curve.",
};

/// The lesson's state.
pub struct Profiles {
    bumps: f64,
    low: f64,
    high: f64,
    /// The wave that "Open as dataset" writes.
    chosen: Wave,
}

impl Default for Profiles {
    fn default() -> Self {
        Self {
            bumps: 3.0,
            low: 0.3,
            high: 2.0,
            chosen: Wave::Sin2,
        }
    }
}

impl Figure for Profiles {
    fn show(&mut self, ui: &mut Ui, bench: &mut Bench<'_>) {
        let tall = if bench.narrow { 1.0 } else { 0.5 };
        let mut stage = Stage::new(ui, bench.narrow, bench.height, tall);
        let all = if bench.narrow {
            // Four below each other need more than a figure's height.
            let height = 4.0 * (0.72 * stage.figure.width()) + 3.0 * 12.0;
            let all = Rect::from_min_size(stage.figure.min, vec2(stage.figure.width(), height));
            let below = stage.controls.max_rect().with_min_y(all.bottom() + 12.0);
            stage.controls = ui.new_child(places::part("lab below", below));
            stage.controls.spacing_mut().item_spacing.y = 5.0;
            stage.figure = all;
            all
        } else {
            stage.figure
        };
        let columns = if bench.narrow { 1 } else { 2 };
        let gap = 12.0;
        let rows = WAVES.len() / columns;
        let size = vec2(
            (all.width() - gap * (columns - 1) as f32) / columns as f32,
            (all.height() - gap * (rows - 1) as f32) / rows as f32,
        );
        for (index, wave) in WAVES.into_iter().enumerate() {
            let (row, column) = (index / columns, index % columns);
            let step = vec2((size.x + gap) * column as f32, (size.y + gap) * row as f32);
            self.card(ui, Rect::from_min_size(all.min + step, size), wave, bench);
        }
        let controls = &mut stage.controls;
        slider(controls, "Bumps", &mut self.bumps, 0.5..=10.0, "");
        slider(controls, "Lowest strength", &mut self.low, 0.0..=2.0, "");
        slider(controls, "Highest strength", &mut self.high, 0.0..=4.0, "");
        controls.add_space(4.0);
        heading(controls, "In the language");
        let palette = theme::palette(controls.visuals());
        let word = self.chosen.word();
        let text = format!("texture along strength {word} one, bounds …, scale …");
        controls.label(
            egui::RichText::new(text)
                .monospace()
                .size(12.5)
                .color(palette.command),
        );
        remark(
            controls,
            "Click a picture to go on with it in the editor. Only the hat and sin² have bumps.",
        );
        bench.readings.insert("bumps", self.bumps);
        stage.finish(ui);
    }

    fn dataset(&self) -> Command {
        Command::open("Profiles", self.all())
    }
}

/// Half the length of the bone.
const BONE: f64 = 1.5;
/// Half the width of the picture.
const VIEW: f64 = 2.05;

impl Profiles {
    /// Returns the strength at a share u of the bone.
    fn strength(&self, wave: Wave, u: f64) -> f64 {
        self.low + (self.high - self.low) * wave.value(wave.scale(self.bumps) * u)
    }

    /// Writes the bar with a profile, as a dataset.
    fn text(&self, wave: Wave) -> String {
        // From far away, so that the picture and the curve below it stand in line.
        let eye = 30.0;
        let angle = 2.0 * libm::atan(VIEW / eye).to_degrees();
        format!(
            "# A bar whose strength goes along it as {name}: \
             times low + (high - low) * wave(scale * u),\n\
             # with u from 0 to 1 along the bar. From the lab, lesson 5.\n\n\
             eyep 0 0 {eye}\nvrp 0 0 0\nvup 0 1 0\nfov {angle:.3}\nframesize 640 320\nsample 3\n\
             light White point, position 8 16 20, intensity 0.9\n\
             light SlateBlue point, position -16 -4 10, intensity 0.5, noshadow\n\n\
             var low  = {low:.3} hot    # the strength where the wave is 0\n\
             var high = {high:.3} hot    # and where it is 1\n\n\
             texture along strength {word} one, bounds low low low high \
             high high, scale {scale:.4} 1 1\n\
             surface flesh, diffuse Coral, specular 0.5 0.5 0.5, shine \
             40, blobbiness -3, texture along\n\n\
             cylinder flesh 0.36, <{a} 0 0> <{b} 0 0>\n",
            name = wave.word(),
            low = self.low,
            high = self.high,
            word = wave.word(),
            scale = wave.scale(self.bumps),
            a = -BONE,
            b = BONE,
        )
    }

    /// Draws the picture of a wave and its curve.
    fn card(&mut self, ui: &Ui, place: Rect, wave: Wave, bench: &mut Bench<'_>) {
        let palette = theme::palette(ui.visuals());
        plot::panel(ui, place);
        let left = 44.0;
        let split = place.top() + place.height() * 0.6;
        let right = 16.0;
        let picture = Rect::from_min_max(
            place.min + vec2(left, 8.0),
            egui::pos2(place.right() - right, split),
        );
        let id = ui.scope_id().with(("profile", wave.name()));
        let response = ui.interact(picture, id, Sense::click());
        let name = format!("Bar with the profile {}", wave.name());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &name));
        places::note(ui.ctx(), format!("lab profile {}", wave.word()), picture);
        let text = self.text(wave);
        let shown = bench
            .pictures
            .show(ui, ("profile", wave.name()), &text, picture);
        note_refusal(ui, picture, &shown);
        if response.hovered() || response.has_focus() {
            let stroke = Stroke::new(2.0, palette.accent);
            ui.painter()
                .rect_stroke(picture, 6.0, stroke, StrokeKind::Inside);
        }
        let clicked = response
            .on_hover_cursor(CursorIcon::PointingHand)
            .on_hover_text("Open in the editor")
            .clicked();
        if clicked {
            self.chosen = wave;
            bench.commands.push(Command::OpenText {
                name: format!("Profile {}", wave.word().replace('^', "")),
                text,
            });
        }
        ui.painter().text(
            picture.min + vec2(10.0, 8.0),
            Align2::LEFT_TOP,
            wave.name(),
            FontId::proportional(14.0),
            palette.strong,
        );
        // The same x as in the picture: u = 0 and 1 are the ends of the bone.
        let end = (VIEW / BONE - 1.0) / 2.0;
        let most = self.high.max(self.low).max(0.5) * 1.12;
        let lower = place.with_min_y(split - 22.0);
        let plot = Plot::new(
            ui,
            lower,
            Axis::new([-end, 1.0 + end], "u along the bone"),
            Axis::new([0.0, most], ""),
        );
        let colour = plot::hue(ui, 1);
        plot.fill(colour.gamma_multiply(0.25), [0.0, 1.0], |u| {
            self.strength(wave, u)
        });
        let points: Vec<_> = (0..=300)
            .map(|i| f64::from(i) / 300.0)
            .map(|u| plot.at(u, self.strength(wave, u)))
            .collect();
        plot.painter.line(points, Stroke::new(2.5, colour));
    }

    /// Writes the bar with the profile chosen last.
    fn all(&self) -> String {
        self.text(self.chosen)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use field::{Profile, Wave as Given};

    #[test]
    fn plots_agree_with_the_language() {
        let lesson = Profiles::default();
        for wave in WAVES {
            let file = rats::File {
                name: String::from("main.rat"),
                text: lesson.text(wave),
            };
            let compiled = rats::compile(&rats::Project { files: vec![file] });
            assert_eq!(compiled.diagnostics, [], "{wave:?}");
            let flesh = compiled.scene.flesh.iter();
            let profile: Profile = flesh
                .filter_map(|flesh| flesh.profile)
                .next_back()
                .expect("a profile");
            let given = match wave {
                Wave::Constant => Given::One,
                Wave::Linear => Given::X,
                Wave::Hat => Given::Hat,
                Wave::Sin2 => Given::Sin2,
            };
            assert_eq!(profile.waves[0], given);
            // As many digits as the text has.
            assert!((profile.scale[0] - wave.scale(lesson.bumps)).abs() < 1e-4);
            assert_eq!(profile.bounds, [lesson.low, lesson.high]);
            assert_eq!(profile.times, 1.0);
        }
    }
}
