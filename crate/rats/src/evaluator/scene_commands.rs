//! SCENE: `report`, `reset`, `shoot`.

use super::state::{Evaluator, Flow};
use super::surroundings::Air;
use crate::Severity;
use crate::commands::build::{clay, idle, plain, row, takes, word_of};
use crate::commands::slot::{text, word};
use crate::commands::{CommandSpec, OptionSpec};
use crate::problem::Outcome;
use crate::syntax::Command;
use scene::{Camera, Lens, Settings};
use std::ops::Range;

/// `reset`, `report`.
pub static RESET_WORDS: &[OptionSpec] = &[
    word_of("all", "everything"),
    word_of("data", "shapes and objects"),
    word_of("model", "shapes and objects"),
    word_of("surfaces", "materials"),
    word_of("textures", "textures"),
    word_of("lights", "lights"),
    word_of("background", "the background, sky and ground"),
    word_of("clouds", "clouds of light"),
    word_of("fog", "fog"),
    word_of("cameras", "the camera"),
    word_of("options", "all settings"),
    word_of("var", "variables"),
];

pub static REPORT: CommandSpec = row("report", "tell what the scene holds")
    .with(takes!(
        report,
        word("what", RESET_WORDS, "what to report on").any()
    ))
    .details(
        "Without a word it counts what there is; with one it tells values: of each material, \
         light or variable, of the camera, of the settings. `report all` tells all of them.",
    )
    .example("report");

fn report<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    words: Vec<&'static str>,
) -> Outcome<Flow> {
    let parts = run.model.parts.len() as u64;
    let things = run.palette.surfaces.len() as u64 + run.scope.symbols.count() as u64;
    run.scope.step(
        1 + (parts + things) / 16 * words.len().max(1) as u64,
        &command.word_span,
    )?;
    if !run.is_news(Severity::Note, &command.span) {
        return Ok(Flow::Next);
    }
    if words.is_empty() {
        let counts = run.counts().join(", ");
        run.note(&command.span, format_args!("there are here: {counts}"), "");
        return Ok(Flow::Next);
    }
    let mut lines = Vec::new();
    for word in &words {
        match run.values_of(word) {
            values if values.is_empty() => lines.push(format!("no {word}")),
            values => lines.extend(values),
        }
    }
    run.note(&command.span, lines.join("\n"), "");
    Ok(Flow::Next)
}

impl Evaluator<'_> {
    /// Counts what there is, kind by kind.
    fn counts(&self) -> Vec<String> {
        let parts = self.model.parts.iter().filter(|part| !part.removed).count();
        let (camera, settings) = (self.camera, self.settings);
        let [eye, target] = [camera.eye, camera.target].map(|p| format!("{} {} {}", p.x, p.y, p.z));
        let [width, height] = settings.frame;
        let mut counts = vec![
            format!("{parts} shapes"),
            format!("{} materials", self.palette.surfaces.len()),
            format!("{} textures", self.palette.textures()),
            format!("{} lights", self.lights.len()),
            super::values::background(&self.air.background()),
            format!(
                "the eye at {eye}, seeing {target} at {} degrees",
                camera.fov
            ),
            format!(
                "a picture of {width}×{height} pixels, {} samples, gamma {}, soft {}",
                settings.samples,
                settings.gamma,
                if settings.soft { "on" } else { "off" }
            ),
            format!("{} variables", self.scope.names().count()),
        ];
        if !self.air.clouds.is_empty() {
            counts.push(format!("{} clouds", self.air.clouds.len()));
        }
        if let Some(fog) = self.air.fog(camera.eye.distance(camera.target)) {
            counts.push(format!("fog of the distance {}", fog.distance));
        }
        counts
    }
}

pub static RESET: CommandSpec = row("reset", "put things back to what they are at the start")
    .with(takes!(
        reset,
        word("what", RESET_WORDS, "what to reset, such as `all`").many()
    ))
    .interrupts()
    .example(clay!(
        "sphere Clay 2, 3 0 0\nreset data\nsphere Clay 2, 0 0 0"
    ));

fn reset<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    what: Vec<&'static str>,
) -> Outcome<Flow> {
    for name in what {
        let is = |wanted: &str| name == wanted || name == "all";
        if is("data") || is("model") {
            run.model.clear();
        }
        if is("surfaces") {
            run.palette.forget_surfaces();
        }
        if is("textures") {
            run.palette.forget_textures();
        }
        if is("lights") {
            run.lights.clear();
            run.sized_light = None;
        }
        if is("background") {
            let Air { fog, clouds, .. } = std::mem::take(&mut run.air);
            run.air = Air {
                fog,
                clouds,
                ..Air::default()
            };
        }
        if is("fog") {
            run.air.fog = None;
        }
        if is("clouds") {
            run.air.clouds.clear();
        }
        if is("cameras") {
            run.camera = Camera::default();
            run.lens = Lens::default();
            run.shutter = 0.0;
            run.aimed_at = (run.file, command.span.clone());
            run.vertical = None;
            run.view_plane = super::view_plane::ViewPlane::default();
        }
        if is("options") {
            run.settings = Settings::default();
            run.sampled = false;
            run.scaled = false;
            run.report.no_warnings = false;
            run.report.no_notes = false;
            run.output = crate::compiled::Output::default();
        }
        if is("var") {
            run.scope.clear();
            run.hot.clear();
            run.presets.clear();
        }
    }
    Ok(Flow::Next)
}

/// `shoot`: the picture is the scene as it is here.
pub static SHOOT: CommandSpec = row("shoot", "draw the picture")
    .with(takes!(
        shoot,
        text("options", "the picture's options").optional("")
    ))
    .interrupts()
    .details(
        "The picture shows what has been made so far, and is saved under the `filename` that \
         stands so far. A text can have several: the program writes each, the page shows them \
         as frames to choose from, or the last where frames are those of a film. The model lives \
         on behind a `shoot`: a material made again under its name changes the shapes \
         that stand there, while shapes keep the variables that they were made with. \
         What follows the last `shoot` is in its picture, too, up to a `reset`; without `shoot` \
         the picture shows what there is at the end.",
    )
    .example(clay!("sphere Clay 2, 0 0 0\nshoot"));

fn shoot<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    options: Option<Range<usize>>,
) -> Outcome<Flow> {
    if let Some(span) = options {
        run.note(
            &span,
            "`shoot` has no options here: the picture is as the commands say",
            "",
        );
    }
    run.shoot(command)?;
    Ok(Flow::Next)
}

pub static PREVIEW: CommandSpec = row("preview", "preview")
    .with(idle(
        "the draft is always shown",
        plain![text("options", "the preview's options").optional("")],
    ))
    .example("preview");
