//! `light`.

use super::state::{Evaluator, Flow};
use crate::Severity;
use crate::commands::CommandSpec;
use crate::commands::build::{options, row, takes};
use crate::commands::slot::{Placed, colour, degrees, direction, length, number, vector};
use crate::given::Options;
use crate::limits::MAX_LIGHTS;
use crate::problem::{Outcome, Problem};
use crate::syntax::Command;
use glam::DVec3;
use scene::{Light, LightKind, Rgb};

/// Angle of a spot that gives none, in degrees.
const SPOT_ANGLE: f64 = 30.0;
/// Share of a spot's angle over which its light fades, if the text gives no edge.
const SPOT_EDGE: f64 = 0.25;

options! {
    /// Options of `light`.
    LIGHT_OPTIONS:
    POINT: () = ("point", "", "shines from a point; the kind of a light that names none");
    DISTANT: () = ("distant", "", "shines from infinity");
    SPOT: () = ("spot", "", "shines in a cone");
    POSITION: DVec3 = ("position", "", "where it is; a distant light shines from there to 0 0 0",
        vector("XYZ", "the light's position"));
    DIRECTION: DVec3 = ("direction", "to 0 0 0", "where a distant light or a spot shines to",
        direction("XYZ", "the light's direction"));
    INTENSITY: f64 = ("intensity", "1", "multiplies the colour",
        number("k", "the intensity").from(0.0, 1e6));
    NOSHADOW: () = ("noshadow", "", "nothing stops it");
    ANGLE: f64 = ("angle", "30", "angle of a spot from its axis to the end of its light (ours)",
        degrees("a", "the spot's angle").from(0.01, 180.0));
    EDGE: Placed<f64> = ("edge", "a quarter of the angle",
        "angle at the end of a spot over which its light fades (ours)",
        degrees("e", "the spot's soft edge").from(0.0, 180.0).with_place());
    SIZE: f64 = ("size", "0",
        "radius, for soft shadows with `penumbra on`; of a distant light at the distance 1 (ours)",
        length("s", "the light's radius").from(0.0, 1e6));
}

pub static LIGHT: CommandSpec = row("light", "make a light")
    .with(takes!(
        light,
        [LIGHT_OPTIONS],
        colour("Color", "the light's colour")
    ))
    .details(
        "A scene without lights and without a `sky` is lit evenly. Light does not fade with \
         distance, as in the published datasets. A spot shines fully within its angle less its \
         edge, and fades to nothing at its angle. A light with a `size` has soft shadows where \
         `penumbra` is on.",
    )
    .example(
        "surface Clay, diffuse SandyBrown, specular Gray50, shine 40\n\
         surface Floor, diffuse Gray70\neyep 0 5 12\n\
         light White, spot, position 6 8 4, direction -6 -9 -4, angle 18, edge 6\n\
         light SkyBlue, distant, direction 1 -1 -1, intensity 0.2, noshadow\n\
         sphere Clay 2, 0 0 0\nplane Floor <0 -2 0> <0 1 0>",
    );

fn light<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    options: &Options<'a>,
    colour: Rgb,
) -> Outcome<Flow> {
    let mut named = options.iter().rev();
    let named = named.find(|c| POINT.is(c) || DISTANT.is(c) || SPOT.is(c));
    let kind = match named {
        Some(chosen) if DISTANT.is(chosen) => distant(options, command)?,
        Some(chosen) if SPOT.is(chosen) => spot(options, command)?,
        _ => LightKind::Point {
            position: position(options, command)?,
        },
    };
    // Options that mean nothing for this kind of light are reported.
    for chosen in options.iter() {
        let is_idle = match kind {
            LightKind::Point { .. } => DIRECTION.is(chosen) || ANGLE.is(chosen) || EDGE.is(chosen),
            LightKind::Distant { .. } => {
                POSITION.is(chosen) && options.has(&DIRECTION)
                    || ANGLE.is(chosen)
                    || EDGE.is(chosen)
            }
            LightKind::Spot { .. } => false,
        };
        if is_idle {
            let option = chosen.option.name;
            let message = format_args!("`{option}` says nothing about this kind of light");
            run.warn(&chosen.span, message, "");
        }
    }
    if run.lights.len() >= MAX_LIGHTS {
        return Err(Problem::new(
            &command.span,
            format!("there are more than {MAX_LIGHTS} lights"),
        ));
    }
    let size = options.last(&SIZE).unwrap_or(0.0);
    if size > 0.0 && run.sized_light.is_none() {
        let chosen = options.find(&SIZE);
        run.sized_light = chosen.map(|chosen| (run.file, chosen.span.clone()));
    }
    let intensity = options.last(&INTENSITY).unwrap_or(1.0);
    run.lights.push(Light {
        kind,
        colour: colour.map(|c| c * intensity as f32),
        shadow: !options.has(&NOSHADOW),
        size,
    });
    Ok(Flow::Next)
}

/// Returns the position of a light that needs one.
fn position(options: &Options<'_>, command: &Command) -> Outcome<DVec3> {
    options.last(&POSITION).ok_or_else(|| {
        Problem::new(&command.span, "this light has no position").hint("add `position x y z`")
    })
}

/// Makes a distant light.
fn distant(options: &Options<'_>, command: &Command) -> Outcome<LightKind> {
    let towards = options
        .last(&DIRECTION)
        .map(|direction| -direction)
        .or_else(|| options.last(&POSITION).and_then(DVec3::try_normalize))
        .ok_or_else(|| {
            Problem::new(&command.span, "a distant light needs a direction")
                .hint("add `direction x y z`, or a `position x y z` from where it shines")
        })?;
    Ok(LightKind::Distant { towards })
}

/// Makes a spot.
fn spot(options: &Options<'_>, command: &Command) -> Outcome<LightKind> {
    let position = position(options, command)?;
    let direction = options.last(&DIRECTION);
    let direction = direction.or_else(|| (-position).try_normalize());
    let direction = direction.ok_or_else(|| {
        Problem::new(&command.span, "a spot at 0 0 0 needs a direction")
            .hint("add `direction x y z`")
    })?;
    let angle = options.last(&ANGLE).unwrap_or(SPOT_ANGLE);
    let edge = match options.last(&EDGE) {
        Some((edge, span)) if edge > angle => {
            return Err(Problem::new(
                &span,
                format!("the spot's soft edge must be at most its angle, {angle}, not {edge}"),
            )
            .hint("the light fades over the edge, within the angle"));
        }
        Some((edge, _)) => edge,
        None => SPOT_EDGE * angle,
    };
    Ok(LightKind::Spot {
        position,
        direction,
        angle,
        edge,
    })
}

impl Evaluator<'_> {
    /// Notes that lights with a size need `penumbra on`.
    pub(super) fn check_penumbra(&mut self) {
        if let Some((file, span)) = self.sized_light.take()
            && !self.settings.penumbra
        {
            let message = "the size of a light shows with `penumbra on` only";
            self.say_at(file, Severity::Note, &span, message, "add `penumbra on`");
        }
    }
}
