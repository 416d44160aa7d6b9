//! The surroundings of the shapes: background, sky, ground, fog and clouds of light.

use super::state::{Evaluator, Flow};
use crate::commands::build::{clay, flesh, options, row, takes};
use crate::commands::slot::{Named, backdrop, colour, existing, length, number, vector, whole};
use crate::commands::{CommandSpec, Names};
use crate::given::{Behind, Options};
use crate::limits::{MAX_BACKDROPS, MAX_CLOUDS};
use crate::problem::{Outcome, Problem};
use crate::syntax::Command;
use glam::DVec3;
use scene::{Background, Cloud, Fog, Ground, Rgb, Sky, extent};

/// Directions in which a ray looks for the sky, if the text gives no number.
const SKY_SAMPLES: u32 = 4;

options! {
    /// Options of `background`.
    BACKGROUND_OPTIONS:
    BACKGROUND_TO: Rgb = ("to", "",
        "another colour below the first: they change over around the horizon (ours)",
        colour("Color", "the colour below"));
}

/// `background Color [to Color …]`, `background fn`
pub static BACKGROUND: CommandSpec = row(
    "background",
    "what is behind everything: a colour, colours or an image",
)
.with(takes!(
    background,
    [BACKGROUND_OPTIONS],
    backdrop(
        "Color|fn",
        "the background's colour, or the name of an image"
    )
))
.default("a dark slate, or the `sky`")
.details(
    "There is one background at a time, the last one. With `to` it goes from the first colour, \
     above, to the last, below; they change over around the horizon. An image lies around the \
     scene: the whole way round across, its middle towards −z, from straight up to straight down. \
     It is seen in mirrors and through glass, but it gives no light: `sky` does. Up is the \
     direction `vup`.",
)
.example(clay!(
    "background SteelBlue to White to SaddleBrown\n\
     surface Chrome, diffuse Gray10, reflective 80%\nsphere Chrome 2, 0 0 0\n\
     sphere Clay 0.7, 2.4 -1 2"
));

fn background<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    options: &Options<'a>,
    behind: Behind<'a>,
) -> Outcome<Flow> {
    run.note_replaced(command, run.air.background.is_some());
    run.air.background = Some(match behind {
        Behind::Colour(colour) => {
            let mut colours = vec![colour];
            colours.extend(options.all(&BACKGROUND_TO));
            if colours.len() > MAX_BACKDROPS {
                return Err(Problem::new(
                    &command.span,
                    format!("a background has at most {MAX_BACKDROPS} colours"),
                )
                .hint("use an image: `background file.png`"));
            }
            match colours[..] {
                [colour] => Background::Colour(colour),
                _ => Background::Gradient(colours),
            }
        }
        Behind::Image(name) => {
            if let Some(to) = options.find(&BACKGROUND_TO) {
                run.warn(
                    &to.span,
                    "`to` says nothing about a background that is an image",
                    "",
                );
            }
            Background::Image(run.image(&name)? as u32)
        }
    });
    Ok(Flow::Next)
}

impl Evaluator<'_> {
    /// Notes that a command takes the place of an earlier one, if there was one for this picture:
    /// there is one background, sky, ground and fog at a time. In loops and branches that is meant.
    fn note_replaced(&mut self, command: &Command, is_given: bool) {
        let in_block = self.repeating > 0 || self.depth + 1 > self.reading.len();
        if is_given && !in_block && self.is_own() && self.shots.taken.is_empty() {
            let word = self.scope.symbols.word(command.word);
            let message = format_args!("this `{word}` takes the place of the one before");
            let hint = "there is one at a time: leave one of them out";
            self.note(&command.word_span, message, hint);
        }
    }
}

options! {
    /// Options of `sky`.
    SKY_OPTIONS:
    SKY_TO: Rgb = ("to", "as above", "light from the horizon and below",
        colour("Color", "the horizon's colour"));
    INTENSITY: f64 = ("intensity", "1", "multiplies its light, not what is seen of it",
        number("k", "the intensity").from(0.0, 1e6));
    SAMPLES: u32 = ("samples", "4", "directions in which each ray looks for the sky",
        whole("n", 1, scene::Sky::MAX_SAMPLES, "the number of directions"));
}

pub static SKY: CommandSpec = row("sky", "light from everywhere")
    .with(takes!(
        sky,
        [SKY_OPTIONS],
        colour("Color", "the light's colour from straight above")
    ))
    .default("none")
    .details(
        "Every place gets the light of the part of the sky that it sees: hollows and what touches \
         the ground get darker, as on a cloudy day. Materials whose `ambient` is not given have \
         none under a sky. The sky is seen behind everything unless there is a `background`.",
    )
    .example(flesh!(
        "sky White to SteelBlue, intensity 0.8\nground Gray80\neyep 0 3 9\n\
         sphere Flesh 0.6, -0.6 0 0\nsphere Flesh 0.6, 0.6 0 0"
    ));

fn sky<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    options: &Options<'a>,
    above: Rgb,
) -> Outcome<Flow> {
    run.note_replaced(command, run.air.sky.is_some());
    let horizon = options.last(&SKY_TO).unwrap_or(above);
    let intensity = options.last(&INTENSITY).unwrap_or(1.0) as f32;
    let [colour, lit_horizon] = [above, horizon].map(|rgb| rgb.map(|c| c * intensity));
    let sky = Sky {
        colour,
        horizon: lit_horizon,
        samples: options.last(&SAMPLES).unwrap_or(SKY_SAMPLES),
    };
    run.air.sky = Some((sky, [above, horizon]));
    Ok(Flow::Next)
}

options! {
    /// Options of `ground`.
    GROUND_OPTIONS:
    GROUND_HEIGHT: f64 = ("height", "just below everything", "where it is, along the direction up",
        length("h", "the height"));
}

pub static GROUND: CommandSpec = row("ground", "a plane to stand on")
    .with(takes!(
        ground,
        [GROUND_OPTIONS],
        colour("Color", "the ground's colour")
    ))
    .default("none")
    .details(
        "An endless plane across the direction up (`vup`) that receives light and shadows. \
         Without a height it touches the lowest shape.",
    )
    .example(clay!(
        "ground Wheat\nlight White, distant, direction -1 -2 -1\neyep 0 3 9\nsphere Clay 2, 0 0 0"
    ));

fn ground<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    options: &Options<'a>,
    colour: Rgb,
) -> Outcome<Flow> {
    run.note_replaced(command, run.air.ground.is_some());
    run.air.ground = Some(Ground {
        colour,
        height: options.last(&GROUND_HEIGHT),
    });
    Ok(Flow::Next)
}

options! {
    /// Options of `fog`.
    FOG_OPTIONS:
    FOG_DISTANCE: f64 = ("distance", "twice as far as vrp",
        "where 37% of the light is left, 14% at twice that (ours)",
        length("d", "the distance").at_least(1e-9));
    FOG_HEIGHT: f64 = ("height", "as dense everywhere",
        "over which the fog thins out to 37%, upwards from 0 (ours)",
        length("h", "the height").at_least(1e-9));
}

pub static FOG: CommandSpec = row("fog", "fog over everything")
    .with(takes!(
        fog,
        [FOG_OPTIONS],
        colour("Color", "the fog's colour")
    ))
    .default("none")
    .details(
        "Of the light from a distance x, the share e^(−x/d) arrives; the rest has the fog's own \
         colour. With a `height` the fog lies low: it is thinner the higher one is (up is `vup`), \
         and below 0 as dense as at 0. There is one fog at a time, the last one.",
    )
    .example(clay!(
        "fog LightSteelBlue, distance 12\nbackground LightSteelBlue\neyep 0 2 9\n\
         for i = 0 to 5 { sphere Clay 1, 3-2*i, 0, 3-4*i }"
    ));

fn fog<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    options: &Options<'a>,
    colour: Rgb,
) -> Outcome<Flow> {
    run.note_replaced(command, run.air.fog.is_some());
    let distance = options.last(&FOG_DISTANCE);
    let fog = Fog {
        colour,
        distance: distance.unwrap_or(1.0),
        height: options.last(&FOG_HEIGHT),
    };
    run.air.fog = Some((fog, distance.is_some()));
    Ok(Flow::Next)
}

options! {
    /// Options of `cloud`.
    CLOUD_OPTIONS:
    POSITION: DVec3 = ("position", "0 0 0", "its middle (ours)",
        vector("XYZ", "the cloud's middle"));
    OBJECT: Named = ("object", "",
        "an object in the middle of it, in place of a position: a halo (ours)",
        existing("name", Names::Object, "the object's name"));
    RADIUS: f64 = ("radius", "1; of a halo, twice the object's", "how far it reaches (ours)",
        length("r", "the cloud's radius").at_least(1e-9));
    DENSITY: f64 = ("density", "1", "multiplies its light (ours)",
        number("k", "the density").from(0.0, 1e6));
}

pub static CLOUD: CommandSpec = row("cloud", "a cloud of light, or a halo")
    .with(takes!(
        cloud,
        [CLOUD_OPTIONS],
        colour("Color", "the cloud's colour")
    ))
    .default("none")
    .details(
        "A glowing ball of mist without a surface: it hides nothing and casts no shadow. At the \
         distance r from its middle its density is k·(1 − (r/radius)²)², and a ray gets the \
         integral of that along its way, in units of the radius, times the colour.",
    )
    .example(clay!(
        "background Black\nobject LAMP\n  sphere Clay 0.6, 0 1 0\nclose\n\
         cloud Gold, object LAMP, radius 2.5\n\
         cloud SlateBlue, position -2 -1 0, radius 2, density 0.5"
    ));

fn cloud<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    options: &Options<'a>,
    colour: Rgb,
) -> Outcome<Flow> {
    if run.air.clouds.len() >= MAX_CLOUDS {
        return Err(Problem::new(
            &command.span,
            format!("there are more than {MAX_CLOUDS} clouds"),
        ));
    }
    let mut position = options.last(&POSITION).unwrap_or(DVec3::ZERO);
    let mut radius = 1.0;
    if let Some(name) = options.last(&OBJECT) {
        if let Some(place) = options.find(&POSITION) {
            return Err(Problem::new(
                &place.span,
                "a cloud has a position or an object in its middle, not both",
            )
            .hint("leave one out"));
        }
        let range = run.model.find(&name)?;
        run.scope.step(range.len() as u64, &name.span)?;
        let parts = run.model.parts[range].iter();
        let (middle, reach) = extent(parts.map(|part| &part.element.shape)).ok_or_else(|| {
            Problem::new(
                &name.span,
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
        colour,
        position,
        radius: options.last(&RADIUS).unwrap_or(radius),
        density: options.last(&DENSITY).unwrap_or(1.0),
    });
    Ok(Flow::Next)
}
