//! `light`.

use super::state::{Evaluator, Flow};
use crate::Severity;
use crate::given::Given;
use crate::limits::MAX_LIGHTS;
use crate::problem::{Outcome, Problem};
use crate::syntax::Command;
use glam::DVec3;
use scene::{Light, LightKind};

/// Angle of a spot that gives none, in degrees.
const SPOT_ANGLE: f64 = 30.0;
/// Share of a spot's angle over which its light fades, if the text gives no edge.
const SPOT_EDGE: f64 = 0.25;

/// `light Color [option …]`
pub fn light<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let given = run.given(command)?;
    let kinds = ["point", "distant", "spot"];
    let mut named = given.options.iter().map(|chosen| chosen.name);
    let name = named.rfind(|name| kinds.contains(name)).unwrap_or(kinds[0]);
    let kind = match name {
        "distant" => distant(&given, command)?,
        "spot" => spot(&given, command)?,
        _ => LightKind::Point {
            position: position(&given, command)?,
        },
    };
    // What says nothing about this kind of light is not passed over in silence.
    for chosen in &given.options {
        let counts = match chosen.name {
            "direction" => name != "point",
            "position" => name != "distant" || given.option("direction").is_none(),
            "angle" | "edge" => name == "spot",
            _ => true,
        };
        if !counts {
            let option = chosen.name;
            run.say(Severity::Warning, chosen.span.clone(), || {
                (
                    format!("`{option}` says nothing about this kind of light"),
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
    let number = |option, parameter| Some(given.option(option)?.given.number(parameter));
    let size = number("size", "s").unwrap_or(0.0);
    if size > 0.0 && run.sized_light.is_none() {
        let span = given.option("size").map(|chosen| chosen.span.clone());
        run.sized_light = span.map(|span| (run.file, span));
    }
    let intensity = number("intensity", "k").unwrap_or(1.0);
    run.lights.push(Light {
        kind,
        colour: given.colour("Color").map(|c| c * intensity as f32),
        shadow: given.option("noshadow").is_none(),
        size,
    });
    Ok(Flow::Next)
}

fn vector(given: &Given<'_>, name: &'static str) -> Option<DVec3> {
    Some(given.option(name)?.given.vector("XYZ"))
}

fn position(given: &Given<'_>, command: &Command) -> Outcome<DVec3> {
    vector(given, "position").ok_or_else(|| {
        Problem::new(command.span.clone(), "this light has no position")
            .hint("add `position x y z`")
    })
}

fn distant(given: &Given<'_>, command: &Command) -> Outcome<LightKind> {
    let from = || vector(given, "position").and_then(DVec3::try_normalize);
    let towards = vector(given, "direction")
        .map(|d| -d)
        .or_else(from)
        .ok_or_else(|| {
            Problem::new(command.span.clone(), "a distant light needs a direction")
                .hint("add `direction x y z`, or a `position x y z` from where it shines")
        })?;
    Ok(LightKind::Distant { towards })
}

fn spot(given: &Given<'_>, command: &Command) -> Outcome<LightKind> {
    let position = position(given, command)?;
    let to_origin = || (-position).try_normalize();
    let direction = vector(given, "direction")
        .or_else(to_origin)
        .ok_or_else(|| {
            Problem::new(command.span.clone(), "a spot at 0 0 0 needs a direction")
                .hint("add `direction x y z`")
        })?;
    let degrees = |option, parameter| Some(given.option(option)?.given.number(parameter));
    let angle = degrees("angle", "a").unwrap_or(SPOT_ANGLE);
    let edge = degrees("edge", "e").unwrap_or(SPOT_EDGE * angle);
    if edge > angle
        && let Some(chosen) = given.option("edge")
    {
        return Err(Problem::new(
            chosen.given.span("e").unwrap_or(chosen.span.clone()),
            format!("the spot's soft edge must be at most its angle, {angle}, not {edge}"),
        )
        .hint("the light fades over the edge, within the angle"));
    }
    Ok(LightKind::Spot {
        position,
        direction,
        angle,
        edge,
    })
}

impl Evaluator<'_> {
    /// Says that lights with a size need `penumbra on`.
    pub(super) fn check_penumbra(&mut self) {
        if let Some((file, span)) = self.sized_light.take()
            && !self.settings.penumbra
        {
            self.say_at(file, Severity::Note, span, || {
                (
                    String::from("the size of a light shows with `penumbra on` only"),
                    Some(String::from("add `penumbra on`")),
                )
            });
        }
    }
}
