//! What is around the shapes: background, sky, ground, fog and clouds of light.

use super::extent::extent;
use super::state::{Evaluator, Flow};
use crate::Severity;
use crate::given::Given;
use crate::limits::{MAX_BACKDROPS, MAX_CLOUDS};
use crate::problem::{Outcome, Problem};
use crate::syntax::Command;
use glam::DVec3;
use scene::{Background, Cloud, Fog, Ground, Rgb, Sky};

/// Directions in which a ray looks for the sky, if the text does not say.
const SKY_SAMPLES: u32 = 4;

fn number(given: &Given<'_>, option: &'static str, parameter: &'static str) -> Option<f64> {
    Some(given.option(option)?.given.number(parameter))
}

/// The colour of every `to`, in order.
fn more_colours(given: &Given<'_>) -> impl Iterator<Item = Rgb> {
    let to = given.options.iter().filter(|chosen| chosen.name == "to");
    to.map(|chosen| chosen.given.colour("Color"))
}

/// `background Color [to Color …]`, `background fn`
pub fn background<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let given = run.given(command)?;
    let Some(name) = given.maybe_name("Color|fn").cloned() else {
        let mut colours = vec![given.colour("Color|fn")];
        colours.extend(more_colours(&given));
        if colours.len() > MAX_BACKDROPS {
            return Err(Problem::new(
                command.span.clone(),
                format!("a background has at most {MAX_BACKDROPS} colours"),
            )
            .hint("use an image: `background file.png`"));
        }
        run.air.background = Some(match colours[..] {
            [colour] => Background::Colour(colour),
            _ => Background::Gradient(colours),
        });
        return Ok(Flow::Next);
    };
    if let Some(to) = given.option("to") {
        run.say(Severity::Warning, to.span.clone(), || {
            (
                String::from("`to` says nothing about a background that is an image"),
                None,
            )
        });
    }
    let image = run.image(&name)?;
    run.air.background = Some(Background::Image(image as u32));
    Ok(Flow::Next)
}

/// `sky Color [to Color] [intensity k] [samples n]`
pub fn sky<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let given = run.given(command)?;
    let above = given.colour("Color");
    let horizon = more_colours(&given).last().unwrap_or(above);
    let intensity = number(&given, "intensity", "k").unwrap_or(1.0) as f32;
    let lit = |colour: Rgb| colour.map(|c| c * intensity);
    let sky = Sky {
        colour: lit(above),
        horizon: lit(horizon),
        samples: number(&given, "samples", "n").map_or(SKY_SAMPLES, |n| n as u32),
    };
    run.air.sky = Some((sky, [above, horizon]));
    Ok(Flow::Next)
}

/// `ground Color [height h]`
pub fn ground<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let given = run.given(command)?;
    run.air.ground = Some(Ground {
        colour: given.colour("Color"),
        height: number(&given, "height", "h"),
    });
    Ok(Flow::Next)
}

/// `fog Color [distance d] [height h]`
pub fn fog<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let given = run.given(command)?;
    let distance = number(&given, "distance", "d");
    let fog = Fog {
        colour: given.colour("Color"),
        distance: distance.unwrap_or(1.0),
        height: number(&given, "height", "h"),
    };
    run.air.fog = Some((fog, distance.is_some()));
    Ok(Flow::Next)
}

/// `cloud Color [position P | object name] [radius r] [density k]`
pub fn cloud<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let given = run.given(command)?;
    if run.air.clouds.len() >= MAX_CLOUDS {
        return Err(Problem::new(
            command.span.clone(),
            format!("there are more than {MAX_CLOUDS} clouds"),
        ));
    }
    let place = given.option("position");
    let mut position = place.map_or(DVec3::ZERO, |chosen| chosen.given.vector("XYZ"));
    let mut radius = 1.0;
    if let Some(object) = given.option("object") {
        if let Some(place) = place {
            return Err(Problem::new(
                place.span.clone(),
                "a cloud has a position or an object in its middle, not both",
            )
            .hint("leave one out"));
        }
        let name = object.given.name("name");
        let range = run.model.find(name)?;
        run.scope.step(range.len() as u64, &name.span)?;
        let parts = run.model.parts[range].iter();
        let (middle, reach) = extent(parts.map(|part| &part.element.shape)).ok_or_else(|| {
            Problem::new(
                name.span.clone(),
                format!(
                    "the object `{}` has no middle: it is empty or endless",
                    name.text
                ),
            )
            .hint("give the cloud a `position`")
        })?;
        (position, radius) = (middle, (2.0 * reach).max(1e-9));
    }
    run.air.clouds.push(Cloud {
        colour: given.colour("Color"),
        position,
        radius: number(&given, "radius", "r").unwrap_or(radius),
        density: number(&given, "density", "k").unwrap_or(1.0),
    });
    Ok(Flow::Next)
}
