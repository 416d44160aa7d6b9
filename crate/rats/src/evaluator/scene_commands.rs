//! SCENE: `report`, `reset`, `shoot`.

use super::state::{Evaluator, Flow};
use super::surroundings::Air;
use crate::Severity;
use crate::problem::Outcome;
use crate::syntax::Command;
use scene::{Background, Camera, Lens, Settings};

/// `report [what …]`
pub fn report<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let given = run.given(command)?;
    let words = given.words("what");
    let is_named = |name: &str| words.iter().any(|(word, _)| *word == name);
    let is = |names: &[&str]| {
        words.is_empty()
            || words
                .iter()
                .any(|(word, _)| names.contains(word) || *word == "all")
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
    run.say(Severity::Note, command.span.clone(), || {
        (format!("there are here: {}", lines.join(", ")), None)
    });
    Ok(Flow::Next)
}

/// `reset all|data|…`
pub fn reset<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let given = run.given(command)?;
    let what = given.words("what").into_iter().map(|(word, _)| word);
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
pub fn shoot<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let given = run.given(command)?;
    if let Some(span) = given.span("options") {
        run.say(Severity::Note, span, || {
            (
                String::from("`shoot` has no options here: the picture is as the commands say"),
                None,
            )
        });
    }
    if run.shot.is_none() {
        let parts = run.model.parts.clone();
        run.shot = Some(run.picture(parts));
    }
    Ok(Flow::Next)
}
