//! SCENE: lights, background, `reset`, `report`, `shoot`.

use super::{Evaluator, Flow};
use crate::Severity;
use crate::commands::options::{LIGHT, RESET};
use crate::limits::MAX_LIGHTS;
use crate::problem::{Outcome, Problem};
use crate::syntax::Command;
use glam::DVec3;
use scene::{Camera, DEFAULT_BACKGROUND, Light, LightKind, Settings};

/// `light Color [option …]`
pub fn light<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let mut read = run.reader(command);
    let colour = read.colour("the light's colour")?;
    let mut is_distant = false;
    let mut position: Option<DVec3> = None;
    let mut direction: Option<DVec3> = None;
    let mut intensity = 1.0;
    let mut shadow = true;
    let mut as_point = None;
    while let Some((option, span)) = read.option(LIGHT)? {
        match option.name {
            "point" => is_distant = false,
            "distant" => is_distant = true,
            "spot" | "extended" => as_point = Some((option.name, span)),
            "position" => position = Some(read.vector("the light's position")?),
            "direction" => direction = Some(read.direction("the light's direction")?),
            "intensity" => intensity = read.number_in("the intensity", 0.0, 1e6)?,
            "noshadow" => shadow = false,
            "angle" => _ = read.number_in("the opening", 0.0, 180.0)?,
            _ => _ = read.number_in("the light's radius", 0.0, 1e6)?,
        }
    }
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
    });
    Ok(Flow::Next)
}

/// `background Color`
pub fn background<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let mut read = run.reader(command);
    let colour = read.colour("the background's colour")?;
    let rest = read.more().then(|| read.here());
    run.background = colour;
    if let Some(span) = rest {
        run.not_carried_out(span, "a background of more than one colour");
    }
    Ok(Flow::Next)
}

/// `report …`
pub fn report<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let parts = run.model.parts.iter().filter(|part| !part.removed).count();
    let (materials, lights) = (run.palette.surfaces.len(), run.lights.len());
    run.scope
        .step(1 + run.model.parts.len() as u64 / 16, &command.word_span)?;
    run.say(Severity::Note, command.span.clone(), || {
        (
            format!(
                "the scene holds {parts} shapes, {materials} materials and {lights} lights here"
            ),
            None,
        )
    });
    Ok(Flow::Next)
}

/// `reset all|data|…`
pub fn reset<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let mut read = run.reader(command);
    if !read.more() {
        return Err(read.expected("what to reset, such as `all`"));
    }
    let mut what = Vec::new();
    while let Some((option, _)) = read.option(RESET)? {
        what.push(option.name);
    }
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
            run.vertical = None;
        }
        if is("options") {
            run.settings = Settings::default();
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
    run.reader(command).end()?;
    if run.shot.is_none() {
        run.shot = Some(run.picture());
    }
    Ok(Flow::Next)
}
