//! SCENE: `report`, `reset`, `shoot`.

use super::state::{Evaluator, Flow};
use super::surroundings::Air;
use crate::Severity;
use crate::commands::build::{clay, idle, plain, row, takes, word_of};
use crate::commands::slot::{text, word};
use crate::commands::{CommandSpec, OptionSpec};
use crate::problem::Outcome;
use crate::syntax::Command;
use scene::{Background, Camera, Lens, Settings};
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
    .example("report");

fn report<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    words: Vec<&'static str>,
) -> Outcome<Flow> {
    let is_named = |name: &str| words.contains(&name);
    let is = |names: &[&str]| {
        words.is_empty()
            || words
                .iter()
                .any(|word| names.contains(word) || *word == "all")
    };
    run.scope
        .step(1 + run.model.parts.len() as u64 / 16, &command.word_span)?;
    if !run.is_news(Severity::Note, &command.span) {
        return Ok(Flow::Next);
    }
    let parts = run.model.parts.iter().filter(|part| !part.removed).count();
    let (camera, settings) = (run.camera, run.settings);
    let mut lines = Vec::new();
    if is(&["data", "model"]) {
        lines.push(format!("{parts} shapes"));
    }
    if is(&["surfaces"]) {
        lines.push(format!("{} materials", run.palette.surfaces.len()));
    }
    if is(&["textures"]) {
        lines.push(format!("{} textures", run.palette.textures()));
    }
    if is(&["lights"]) {
        lines.push(format!("{} lights", run.lights.len()));
    }
    if is(&["background"]) {
        lines.push(match run.air.background() {
            Background::Colour([r, g, b]) => format!("the background {r} {g} {b}"),
            Background::Gradient(colours) => format!("a background of {} colours", colours.len()),
            Background::Image(_) => String::from("an image as the background"),
        });
    }
    if is(&["cameras"]) {
        let [eye, target] = [camera.eye, camera.target].map(|p| format!("{} {} {}", p.x, p.y, p.z));
        lines.push(format!(
            "the eye at {eye}, seeing {target} at {} degrees",
            camera.fov
        ));
    }
    if is(&["options"]) {
        let [width, height] = settings.frame;
        lines.push(format!(
            "a picture of {width}×{height} pixels, {} samples, gamma {}, soft {}",
            settings.samples,
            settings.gamma,
            if settings.soft { "on" } else { "off" }
        ));
    }
    if is(&["var"]) {
        lines.push(format!("{} variables", run.scope.names().count()));
    }
    let count = run.air.clouds.len();
    if count > 0 || is_named("clouds") {
        lines.push(format!("{count} clouds"));
    }
    match run.air.fog(camera.eye.distance(camera.target)) {
        Some(fog) if is(&["fog"]) => lines.push(format!("fog of the distance {}", fog.distance)),
        None if is_named("fog") => lines.push(String::from("no fog")),
        _ => {}
    }
    run.note(
        &command.span,
        format_args!("there are here: {}", lines.join(", ")),
        "",
    );
    Ok(Flow::Next)
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
            run.report.no_warnings = false;
            run.report.no_notes = false;
            run.output = crate::compiled::Output::default();
        }
        if is("var") {
            run.scope.clear();
            run.hot.clear();
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
        "The picture shows what has been made so far. Without `shoot` it shows what there is at \
         the end.",
    )
    .example(clay!("sphere Clay 2, 0 0 0\nshoot"));

fn shoot<'a>(
    run: &mut Evaluator<'a>,
    _: &'a Command,
    options: Option<Range<usize>>,
) -> Outcome<Flow> {
    if let Some(span) = options {
        run.note(
            &span,
            "`shoot` has no options here: the picture is as the commands say",
            "",
        );
    }
    if run.shot.is_none() {
        let parts = run.model.parts.clone();
        run.shot = Some(run.picture(parts));
    }
    Ok(Flow::Next)
}

pub static PREVIEW: CommandSpec = row("preview", "preview")
    .with(idle(
        "the draft is always shown",
        plain![text("options", "the preview's options").optional("")],
    ))
    .example("preview");
