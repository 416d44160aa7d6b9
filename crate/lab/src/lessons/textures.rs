//! Lesson 12: two balls, each with a map of u and v of its own, and how their textures mix where
//! their flesh does.

use super::grid::note_refusal;
use crate::bench::Bench;
use crate::command::Command;
use crate::figure::{Figure, Words};
use crate::plot::{self, Axis, Plot};
use crate::sample;
use crate::tools::{self, Stage, choice, heading, reading, remark, slider};
use egui::{CursorIcon, Rect, Sense, Stroke, Ui, vec2};
use field::{Kernel, Primitive, Skeleton, Sum};
use glam::DVec3;
use widgets::{places, theme};

/// Half of the width that is shown.
const VIEW: f64 = 2.1;
/// Radius of each ball.
const RADIUS: f64 = 0.8;

/// Texture of the balls.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Cloth {
    /// Stripes on one, rings on the other, each by its own u and v.
    Maps,
    /// A block of marble, out of which both are cut.
    Solid,
    /// A colour each.
    Colours,
}

/// The words of the lesson.
pub static WORDS: Words = Words {
    link: "textures",
    title: "Textures over blends",
    name: "Textures over blends",
    short: "Textures",
    about: "patterns that cross-dissolve",
    sentences: "Each element has its own map of u and v, so two balls that blend have two \
                patterns. At a point of the surface each pattern is evaluated on its own, and the \
                results are mixed by the elements' shares of the field there. A solid texture \
                fills space and needs no map, so it runs through both as through one block.",
};

/// The lesson's state.
pub struct Textures {
    kernel: Kernel,
    /// Half the distance of the centres.
    apart: f64,
    blobbiness: f64,
    waves: f64,
    cloth: Cloth,
}

impl Default for Textures {
    fn default() -> Self {
        Self {
            kernel: Kernel::Gauss,
            apart: 0.75,
            blobbiness: 1.5,
            waves: 10.0,
            cloth: Cloth::Maps,
        }
    }
}

impl Figure for Textures {
    fn show(&mut self, ui: &mut Ui, bench: &mut Bench<'_>) {
        let mut stage = Stage::new(ui, bench.narrow, bench.height, 0.9);
        let all = stage.figure;
        plot::panel(ui, all);
        // Both are as wide as the plot's curves, so that places stand below each other.
        let inner = all.shrink2(vec2(16.0, 12.0));
        let inner = inner.with_min_x(all.left() + 44.0);
        let height = (0.5 * inner.width()).min(0.62 * inner.height());
        let picture = Rect::from_center_size(
            inner.center_top() + vec2(0.0, 0.5 * height),
            vec2(inner.width(), height),
        );
        let text = self.text();
        let response = ui.interact(picture, ui.scope_id().with("textures"), Sense::click());
        let name = "Two balls with a texture each";
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, name));
        places::note(ui.ctx(), "lab textures", picture);
        let shown = bench.pictures.show(ui, "textures", &text, picture);
        note_refusal(ui, picture, &shown);
        let clicked = response
            .on_hover_cursor(CursorIcon::PointingHand)
            .on_hover_text("Open in the editor")
            .clicked();
        if clicked {
            bench.commands.push(Command::OpenText {
                name: String::from("Textures"),
                text,
            });
        }
        let fields = self.fields();
        // The width of the plane that the picture shows.
        let reach = VIEW * f64::from(picture.width() / (2.0 * picture.height())).max(1.0);
        let reach = if picture.width() >= picture.height() {
            VIEW
        } else {
            reach
        };
        let below = all.with_min_y(picture.bottom() + 8.0);
        let plot = Plot::new(
            ui,
            below,
            Axis::new([-reach, reach], "along the line through both"),
            Axis::new([0.0, 1.05], "share"),
        );
        let hues = [0, 1].map(|index| plot::hue(ui, index));
        for (index, hue) in hues.into_iter().enumerate() {
            plot.curve(Stroke::new(2.0, hue), |x| {
                let share = Self::share(&fields, x).unwrap_or(0.5);
                if index == 0 { share } else { 1.0 - share }
            });
        }
        let zone = Self::zone(&fields);
        let controls = &mut stage.controls;
        heading(controls, "Texture");
        let cloths = [
            (Cloth::Maps, "maps of u, v"),
            (Cloth::Solid, "one block"),
            (Cloth::Colours, "colours"),
        ];
        choice(controls, &mut self.cloth, &cloths);
        slider(controls, "Apart", &mut self.apart, 0.3..=1.4, "");
        slider(
            controls,
            "Blobbiness |B|",
            &mut self.blobbiness,
            0.3..=8.0,
            "",
        );
        if self.cloth != Cloth::Colours {
            slider(controls, "Waves", &mut self.waves, 2.0..=24.0, "");
        }
        heading(controls, "Kernel");
        if let Some(kernel) = tools::kernels(controls, |kernel| kernel == self.kernel) {
            self.kernel = kernel;
        }
        let palette = theme::palette(controls.visuals());
        reading(
            controls,
            "Width of the zone where both count",
            &plot::number(zone),
            palette.strong,
        );
        remark(
            controls,
            "The lines are the shares of the two balls: the \
             field of one, divided by the sum of both.",
        );
        bench.readings.insert("zone", zone);
        stage.finish(ui);
    }

    fn dataset(&self) -> Command {
        Command::open("Textures", self.text())
    }
}

impl Textures {
    /// Writes the balls as a dataset.
    fn text(&self) -> String {
        // From far away, so that the picture and the curve below it stand in line.
        let eye = 30.0;
        let angle = 2.0 * libm::atan(VIEW / eye).to_degrees();
        let cloth = match self.cloth {
            Cloth::Maps => format!(
                "# u runs around a ball and v up\n\
                 texture Left  pigment step one, scale {waves:.1} 1 1, \
                 bounds OrangeRed Wheat, replace\n\
                 texture Right pigment one step, scale 1 {rings:.1} 1, \
                 bounds Navy PaleTurquoise, replace\n",
                waves = self.waves,
                rings = 0.5 * self.waves,
            ),
            Cloth::Solid => format!(
                "# one block of stone, out of which both are cut\n\
                 texture Left  pigment marble, scale {scale:.2} \
                 1 1, bounds SteelBlue White, replace\n\
                 texture Right = Left\n",
                scale = 0.2 * self.waves,
            ),
            Cloth::Colours => String::from(
                "# a colour each\ntexture Left  pigment OrangeRed, replace\n\
                 texture Right pigment Navy, replace\n",
            ),
        };
        format!(
            "# Two balls with a texture each: where their flesh \
             mixes, so do the textures, by the same shares.\n\
             # From the lab, lesson 12.\n\n\
             var apart      = {apart:.3} hot 0.3 1.4    # half the distance of the balls\n\
             var blobbiness = {blob:.3} hot -8 -0.3\n\n\
             eyep 0 0 {eye}\nvrp 0 0 0\nvup 0 1 0\nfov {angle:.3}\nframesize 640 320\nsample 3\n\
             light White point, position -8 14 20, intensity 0.9, noshadow\n\
             light SlateBlue point, position 16 -4 10, intensity 0.4, noshadow\n\n\
             {cloth}\n\
             surface one   {{ diffuse White, specular 40%, shine 40, blob \
             blobbiness, kernel {kernel}, texture Left }}\n\
             surface other {{ diffuse White, specular 40%, shine 40, blob \
             blobbiness, kernel {kernel}, texture Right }}\n\n\
             sphere one   {RADIUS}, -apart 0 0\n\
             sphere other {RADIUS},  apart 0 0\n",
            apart = self.apart,
            blob = -self.blobbiness,
            kernel = self.kernel.name(),
        )
    }

    /// Returns the fields of the two balls.
    fn fields(&self) -> [Sum; 2] {
        let shaping = sample::shaping(self.kernel, RADIUS, self.blobbiness);
        [-1.0, 1.0].map(|side| {
            let center = DVec3::new(side * self.apart, 0.0, 0.0);
            Primitive::new(Skeleton::Point { center }, &shaping, None)
                .into_iter()
                .collect()
        })
    }

    /// Returns the share of the first ball at a place of the line through both; `None` where
    /// neither is felt.
    fn share(fields: &[Sum; 2], x: f64) -> Option<f64> {
        let [one, other] =
            [0, 1].map(|i| sample::one(&[&fields[i]], DVec3::new(x, 0.0, 0.0)).min(1e30));
        let whole = one + other;
        (whole > 1e-12).then(|| one / whole)
    }

    /// Returns the width of the zone in which both have more than a tenth.
    fn zone(fields: &[Sum; 2]) -> f64 {
        let steps = 800;
        let mixed = (0..=steps).filter(|&i| {
            let x = VIEW * (2.0 * f64::from(i) / f64::from(steps) - 1.0);
            Self::share(fields, x).is_some_and(|share| (0.1..=0.9).contains(&share))
        });
        mixed.count() as f64 * 2.0 * VIEW / f64::from(steps)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_those_of_two_gaussian_points() {
        let lesson = Textures::default();
        let fields = lesson.fields();
        for x in [-0.9, -0.2, 0.0, 0.1, 0.6] {
            // exp(b(1 − (x ± a)²/R²)): the quotient depends on 4·b·a·x/R² alone.
            let power = 4.0 * lesson.blobbiness * lesson.apart * x / (RADIUS * RADIUS);
            let want = 1.0 / (1.0 + libm::exp(power));
            let got = Textures::share(&fields, x).expect("both are felt");
            assert!((got - want).abs() < 1e-5, "{x}: {got} {want}");
        }
        // A tenth and nine tenths are where that power is ±ln 9.
        let want =
            2.0 * libm::log(9.0) * RADIUS * RADIUS / (4.0 * lesson.blobbiness * lesson.apart);
        assert!((Textures::zone(&fields) - want).abs() < 0.02);
    }

    #[test]
    fn every_cloth_is_a_text_without_mistakes() {
        for cloth in [Cloth::Maps, Cloth::Solid, Cloth::Colours] {
            let lesson = Textures {
                cloth,
                ..Textures::default()
            };
            let compiled = rats::compile(&rats::Project::single(lesson.text()));
            let worst = compiled.diagnostics.iter().map(|d| d.severity).max();
            assert!(
                worst <= Some(rats::Severity::Note),
                "{:?}",
                compiled.diagnostics
            );
        }
    }
}
