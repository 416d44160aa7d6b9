//! SCENE: lights, background, `reset`, `report`, `shoot`.

use super::state::{Evaluator, Flow};
use crate::Severity;
use crate::limits::MAX_LIGHTS;
use crate::problem::{Outcome, Problem};
use crate::syntax::Command;
use glam::DVec3;
use scene::{Camera, DEFAULT_BACKGROUND, Light, LightKind, Settings};

/// `light Color [option …]`
pub fn light<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let given = run.given(command)?;
    let colour = given.colour("Color");
    let mut is_distant = false;
    let mut as_point = None;
    for chosen in &given.options {
        match chosen.name {
            "point" => is_distant = false,
            "distant" => is_distant = true,
            "spot" | "extended" => {
                is_distant = false;
                as_point = Some((chosen.name, chosen.span.clone()));
            }
            _ => {}
        }
    }
    let vector = |name| given.option(name).map(|chosen| chosen.given.vector("XYZ"));
    let (position, direction) = (vector("position"), vector("direction"));
    let intensity = given
        .option("intensity")
        .map_or(1.0, |chosen| chosen.given.number("k"));
    let shadow = given.option("noshadow").is_none();
    let kind = if is_distant {
        let towards = direction
            .map(|d| -d)
            .or_else(|| position.and_then(DVec3::try_normalize))
            .ok_or_else(|| {
                Problem::new(command.span.clone(), "a distant light needs a direction")
                    .hint("add `direction x y z`, or a `position x y z` from where it shines")
            })?;
        LightKind::Distant { towards }
    } else {
        let position = position.ok_or_else(|| {
            Problem::new(command.span.clone(), "this light has no position")
                .hint("add `position x y z`")
        })?;
        LightKind::Point { position }
    };
    // What says nothing about this kind of light is not passed over in silence.
    for chosen in &given.options {
        let counts = match chosen.name {
            "direction" => is_distant || as_point.is_some(),
            "position" => !is_distant || direction.is_none(),
            "angle" => matches!(as_point, Some(("spot", _))),
            "radius" => matches!(as_point, Some(("extended", _))),
            _ => true,
        };
        if !counts {
            let name = chosen.name;
            run.say(Severity::Warning, chosen.span.clone(), || {
                (
                    format!("`{name}` says nothing about this kind of light"),
                    None,
                )
            });
        }
    }
    if run.lights.len() >= MAX_LIGHTS {
        return Err(Problem::new(
            command.span.clone(),
            format!("there are more than {MAX_LIGHTS} lights"),
        ));
    }
    if let Some((kind, span)) = as_point {
        run.say(Severity::Warning, span, || {
            (
                format!("`{kind}` is not drawn yet: the light shines as a point"),
                None,
            )
        });
    }
    run.lights.push(Light {
        kind,
        colour: colour.map(|c| c * intensity as f32),
        shadow,
        size: 0.0,
    });
    Ok(Flow::Next)
}

/// `background Color`
pub fn background<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let given = run.given(command)?;
    run.background = given.colour("Color");
    if let Some(span) = given.span("options") {
        run.not_carried_out(span, "a background of more than one colour");
    }
    Ok(Flow::Next)
}

/// `report [what …]`
pub fn report<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let given = run.given(command)?;
    let words = given.words("what");
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
        let [r, g, b] = run.background;
        lines.push(format!("the background {r} {g} {b}"));
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
    for nothing in ["clouds", "fog"] {
        if words.iter().any(|(word, _)| *word == nothing) {
            lines.push(format!("no {nothing}"));
        }
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
        }
        if is("background") {
            run.background = DEFAULT_BACKGROUND;
        }
        if is("cameras") {
            run.camera = Camera::default();
            run.aimed_at = (run.file, command.span.clone());
            run.vertical = None;
            run.view_plane = super::view_plane::ViewPlane::default();
        }
        if is("options") {
            run.settings = Settings::default();
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
        run.not_carried_out(span, "an option of `shoot`");
    }
    if run.shot.is_none() {
        let parts = run.model.parts.clone();
        run.shot = Some(run.picture(parts));
    }
    Ok(Flow::Next)
}
