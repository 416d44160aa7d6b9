//! `texture`: layers of patterns on a material, and profiles of a field's strength.

use super::palette::Texture;
use super::state::{Evaluator, Flow};
use crate::Severity;
use crate::commands::OptionSpec;
use crate::commands::options::{MAPPINGS, SOLIDS, TARGETS, TEXTURE, WAVES};
use crate::given::Chosen;
use crate::problem::{Outcome, Problem};
use crate::reader::{Name, Reader};
use crate::suggest;
use crate::syntax::Command;
use field::Profile;
use glam::DVec3;
use std::ops::Range;
use texture::{Fault, Mapping, Region, Solid, Target};

/// The waves of the table, for profiles and for textures.
#[rustfmt::skip]
const WAVE_KINDS: [(field::Wave, texture::Wave); 9] = [
    (field::Wave::One, texture::Wave::One),
    (field::Wave::X, texture::Wave::X),
    (field::Wave::Saw, texture::Wave::Saw),
    (field::Wave::Hat, texture::Wave::Hat),
    (field::Wave::Step, texture::Wave::Step),
    (field::Wave::Sin, texture::Wave::Sin),
    (field::Wave::Cos, texture::Wave::Cos),
    (field::Wave::Sin2, texture::Wave::Sin2),
    (field::Wave::Cos2, texture::Wave::Cos2),
];

const WHAT: &str =
    "how to texture: a solid such as `wood`, two waves such as `sin one`, a colour or an image";

fn index_of(list: &[OptionSpec], word: &str) -> Option<usize> {
    list.iter()
        .position(|one| one.name.eq_ignore_ascii_case(word))
}

/// A target of the table; `None` is `strength`.
fn target(name: &str) -> Option<Target> {
    Some(match name {
        "diffuse" => Target::Diffuse,
        "ambient" => Target::Ambient,
        "specular" => Target::Specular,
        "reflective" => Target::Reflective,
        "transparent" => Target::Transparent,
        "index" => Target::Index,
        "shine" => Target::Shine,
        "pigment" => Target::Pigment,
        "normal" => Target::Normal,
        _ => return None,
    })
}

/// `texture { alias target method option … }`, `texture new = old`
///
/// Of our own: `texture new = old option …` changes the copy.
pub fn texture<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let name = run.reader(command).new_name("the texture's name")?;
    make(run, command).inspect_err(|_| run.palette.insert_broken(name.text))?;
    Ok(Flow::Next)
}

/// Where a texture's values come from, as the text says it.
#[derive(Debug)]
enum Method<'a> {
    /// Two waves, by their indices in [`WAVE_KINDS`].
    Waves([usize; 2]),
    Colour(DVec3),
    Solid(Solid),
    Image(Name<'a>, Mapping),
}

fn make<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<()> {
    let mut read = run.reader(command);
    let name = read.name("the texture's name")?;
    if read.sign(b'=') {
        let old = read.known_name("the name of the old texture")?;
        let options = read.chosen(TEXTURE)?;
        read.end()?;
        let texture = run.palette.texture(&old)?.clone();
        return finish(run, &name, texture, options);
    }
    let Some((word, _)) = read.option(TARGETS)? else {
        return Err(read.expected("what the texture changes, such as `pigment`"));
    };
    let below = read.operands(word.parameters, TEXTURE)?.names("t1 +");
    let start = read.start();
    let method = match word.name {
        "texture" => None,
        _ => Some(method(&mut read)?),
    };
    let span = read.since(start);
    let options = read.chosen(TEXTURE)?;
    read.end()?;
    let texture = match method {
        None => run.palette.layers(&below)?,
        Some(method) => own_layer(run, target(word.name), method, span)?,
    };
    finish(run, &name, texture, options)
}

/// A texture of one layer, or a profile where there is no target.
fn own_layer<'a>(
    run: &mut Evaluator<'a>,
    target: Option<Target>,
    method: Method<'a>,
    span: Range<usize>,
) -> Outcome<Texture> {
    let Some(target) = target else {
        let (waves, times) = match method {
            Method::Waves(waves) => (waves.map(|index| WAVE_KINDS[index].0), 1.0),
            Method::Colour(colour) => ([field::Wave::One; 2], colour.x),
            Method::Solid(_) | Method::Image(..) => {
                return Err(Problem::new(
                    span,
                    "a strength varies along the bone only: it takes two waves",
                )
                .hint(
                    "write two waves, such as `sin one`; `normal` with this method makes bumps",
                ));
            }
        };
        let profile = Profile {
            waves,
            scale: [1.0; 2],
            bounds: [0.0, 1.0],
            times,
            restriction: 0.0,
        };
        return Ok(Texture {
            profile: Some(profile),
            ..Texture::default()
        });
    };
    let method = match method {
        Method::Waves(waves) => texture::Method::Waves(waves.map(|index| WAVE_KINDS[index].1)),
        Method::Colour(colour) => texture::Method::Colour(colour),
        Method::Solid(solid) => texture::Method::Solid(solid),
        Method::Image(name, mapping) => texture::Method::Image(run.image(&name)?, mapping),
    };
    Ok(Texture {
        layers: vec![texture::Texture::new(target, method)],
        ..Texture::default()
    })
}

/// Applies the options to every layer, puts the other layers that they name upon them, and keeps the result.
fn finish<'a>(
    run: &mut Evaluator<'a>,
    name: &Name<'a>,
    mut texture: Texture,
    options: Vec<Chosen<'a>>,
) -> Outcome<()> {
    let mut above = Vec::new();
    let mut mask = None;
    for chosen in options {
        if chosen.name == "texture" {
            above.extend(chosen.given.names("t1 +"));
            continue;
        }
        if matches!(chosen.name, "mask" | "scale") {
            mask = Some(chosen.span.clone());
        }
        if let Some(message) = set(&mut texture, &chosen) {
            run.say(Severity::Warning, chosen.span, || {
                (message, Some(String::from("leave it out")))
            });
        }
    }
    for layer in &texture.layers {
        layer.check().map_err(|fault| {
            let span = mask.clone().unwrap_or(name.span.clone());
            let problem = Problem::new(span, fault.to_string());
            match fault {
                Fault::Mask(..) => problem.hint(format!("it has {}", layer.mask.len())),
                _ => problem,
            }
        })?;
    }
    run.palette.stack(&mut texture, &above)?;
    run.palette.insert_texture(name, texture)
}

/// Sets an option of every layer and of the profile. Returns what is to be said if it changes nothing.
fn set(texture: &mut Texture, chosen: &Chosen<'_>) -> Option<String> {
    let Chosen { name, given, .. } = chosen;
    let layers = &mut texture.layers;
    if let Some(profile) = &mut texture.profile {
        // A strength is one number: the first of three.
        match *name {
            "scale" => profile.scale = [given.vector("XYZ").x, given.vector("XYZ").y],
            "times" => profile.times = given.vector("RGB").x,
            "bounds" => {
                let bounds = given.vectors("RGB");
                profile.bounds = [bounds[0].x, bounds[1].x];
            }
            "translate" if given.vector("XYZ") == DVec3::ZERO => {}
            _ if layers.is_empty() => {
                return Some(format!(
                    "`{name}` changes nothing about a strength: `scale`, `bounds` and `times` do"
                ));
            }
            _ => {}
        }
    }
    let is_solid = |layer: &texture::Texture| matches!(layer.method, texture::Method::Solid(_));
    if matches!(*name, "turbulence" | "octaves")
        && !layers.is_empty()
        && !layers.iter().any(is_solid)
    {
        return Some(format!(
            "`{name}` says nothing here: it is the noise of solids such as `wood`"
        ));
    }
    for layer in layers {
        match *name {
            "translate" => layer.translate = given.vector("XYZ"),
            "scale" => layer.scale = given.vector("XYZ"),
            "times" => layer.times = given.vector("RGB"),
            "bounds" => {
                let bounds = given.vectors("RGB");
                layer.bounds = [bounds[0], bounds[1]];
            }
            "turbulence" => layer.grain.turbulence = given.number("t"),
            "octaves" => layer.grain.octaves = given.number("r"),
            "mask" => {
                let entries = given.numbers("1 0");
                layer.mask = entries.into_iter().map(|entry| entry == 1.0).collect();
            }
            _ => layer.replace = true,
        }
    }
    None
}

/// A solid texture, a pair of waves, an image or a colour.
fn method<'a>(read: &mut Reader<'_, 'a>) -> Outcome<Method<'a>> {
    if read.peek_word().is_none() {
        return Ok(Method::Colour(colour(read)?));
    }
    let back = read.at;
    let word = read.file_name(WHAT)?;
    if let Some(u) = index_of(WAVES, word.text) {
        let second = read.name("the second wave, such as `one`")?;
        let v = index_of(WAVES, second.text).ok_or_else(|| {
            let names: Vec<_> = WAVES.iter().map(|wave| wave.name).collect();
            let names = names.join(", ");
            Problem::new(second.span, format!("there is no wave `{}`", second.text))
                .hint(format!("the waves are {names}"))
        })?;
        return Ok(Method::Waves([u, v]));
    }
    if read.keyword("plain") {
        return Ok(Method::Image(word, Mapping::Plain));
    }
    if read.keyword("region") {
        return Ok(Method::Image(word, Mapping::Region(region(read)?)));
    }
    if crate::reads::is_image(word.text) {
        let names: Vec<_> = MAPPINGS.iter().map(|m| format!("`{}`", m.name)).collect();
        return Err(read
            .expected(&format!("how the image lies: {}", names.join(" or ")))
            .hint(format!("write `{} plain`", word.text)));
    }
    if let Some(index) = index_of(SOLIDS, word.text) {
        return Ok(Method::Solid(Solid::ALL[index]));
    }
    read.at = back;
    colour(read).map(Method::Colour).map_err(|problem| {
        // Names of one letter are near to any.
        let words = SOLIDS.iter().chain(WAVES).map(|word| word.name);
        match suggest::hint(word.text, words.filter(|word| word.len() > 1)) {
            Some(hint) if problem.span == word.span => problem.hint(hint),
            _ => problem,
        }
    })
}

fn colour(read: &mut Reader<'_, '_>) -> Outcome<DVec3> {
    Ok(DVec3::from_array(read.colour(WHAT)?.map(f64::from)))
}

/// The box and the rectangle of an image that is thrown onto a part.
fn region(read: &mut Reader<'_, '_>) -> Outcome<Region> {
    let start = read.start();
    let mut points = [DVec3::ZERO; 6];
    for (point, parameter) in points.iter_mut().zip(MAPPINGS[1].parameters) {
        *point = read.vector(parameter.meaning)?;
    }
    let [min, max, a, b, c, d] = points;
    let region = Region {
        min,
        max,
        corners: [a, b, c, d],
    };
    if region.is_rectangle() {
        return Ok(region);
    }
    Err(Problem::new(read.since(start), Fault::Region.to_string())
        .hint("two corners of the box, then the lower left, lower right, upper right and upper left corner of the rectangle"))
}
