//! `texture`. This version draws one kind: a pair of waves whose target is the strength, which is a
//! profile of the field ([`field::Profile`]). All others are read and checked, and a warning says that
//! they are not drawn.

use super::{Evaluator, Flow};
use crate::Severity;
use crate::commands::OptionSpec;
use crate::commands::options::{SOLIDS, TARGETS, TEXTURE};
use crate::limits::MAX_OPERANDS;
use crate::problem::{Outcome, Problem};
use crate::reader::{Name, Reader};
use crate::syntax::Command;
use field::{Profile, Wave};
use glam::DVec3;
use std::ops::Range;

/// The waves of the method `Fu Fv`.
const WAVES: [(&str, Wave); 9] = [
    ("one", Wave::One),
    ("x", Wave::X),
    ("saw", Wave::Saw),
    ("hat", Wave::Hat),
    ("step", Wave::Step),
    ("sin", Wave::Sin),
    ("cos", Wave::Cos),
    ("sin^2", Wave::Sin2),
    ("cos^2", Wave::Cos2),
];

/// `texture { alias target method option … }`, `texture new = old`
pub fn texture<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let name = run.reader(command).name("the texture's name")?;
    make(run, command).inspect_err(|_| run.palette.insert_broken(name.text))?;
    Ok(Flow::Next)
}

/// What a texture's own layer does.
#[derive(Debug)]
enum Method {
    Waves([Wave; 2]),
    Other(&'static str),
}

/// The options of a texture.
#[derive(Debug)]
struct Options<'a> {
    scale: DVec3,
    bounds: [f64; 2],
    times: f64,
    layers: Vec<Name<'a>>,
    not_drawn: Vec<(&'static str, Range<usize>)>,
}

fn make<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<()> {
    let mut read = run.reader(command);
    let name = read.name("the texture's name")?;
    if read.sign(b'=') {
        let old = read.name("the name of the old texture")?;
        read.end()?;
        let texture = run.palette.texture(&old)?.clone();
        return run.palette.insert_texture(&name, texture);
    }
    let start = read.start();
    let Some((target, target_span)) = read.option(TARGETS)? else {
        return Err(read.expected("what the texture changes, such as `strength`"));
    };
    let mut options = Options {
        scale: DVec3::ONE,
        bounds: [0.0, 1.0],
        times: 1.0,
        layers: Vec::new(),
        not_drawn: Vec::new(),
    };
    let method = if target.name == "texture" {
        layer_names(&mut read, &mut options)?;
        None
    } else {
        Some(method(&mut read)?)
    };
    let span = read.since(start);
    while let Some((option, span)) = read.option(TEXTURE)? {
        texture_option(&mut read, option.name, span, &mut options)?;
    }
    let mut texture = run.palette.layers(&options.layers)?;
    match method {
        None => {}
        Some(Method::Waves(waves)) if target.name == "strength" => {
            texture.layers += 1;
            texture.profile = Some(Profile {
                waves,
                scale: [options.scale.x, options.scale.y],
                bounds: options.bounds,
                times: options.times,
                restriction: 0.0,
            });
            for (what, span) in options.not_drawn {
                not_drawn(run, span, format!("`{what}` of a strength"));
            }
        }
        Some(method) => {
            texture.layers += 1;
            let method = match method {
                Method::Waves(_) => "waves",
                Method::Other(name) => name,
            };
            let span = target_span.start..span.end;
            not_drawn(
                run,
                span,
                format!("a texture of {method} on `{}`", target.name),
            );
        }
    }
    run.palette.insert_texture(&name, texture)
}

fn not_drawn(run: &mut Evaluator<'_>, span: Range<usize>, what: String) {
    run.say(Severity::Warning, span, || {
        (format!("{what} is not drawn yet"), None)
    });
}

fn layer_names<'a>(read: &mut Reader<'_, 'a>, options: &mut Options<'a>) -> Outcome<()> {
    options.layers.push(read.name("the texture's name")?);
    while read.sign(b'+') {
        options.layers.push(read.name("the texture's name")?);
    }
    Ok(())
}

/// A solid texture, a pair of waves, an image or a colour.
fn method(read: &mut Reader<'_, '_>) -> Outcome<Method> {
    const WHAT: &str =
        "how to texture: a solid such as `wood`, two waves such as `sin one`, a colour or an image";
    if read.peek_word().is_none() {
        read.colour(WHAT)?;
        return Ok(Method::Other("a colour"));
    }
    let back = read.at;
    let word = read.file_name(WHAT)?;
    let wave = |word: &str| {
        WAVES
            .iter()
            .find(|(name, _)| name.eq_ignore_ascii_case(word))
            .map(|(_, wave)| *wave)
    };
    if let Some(u) = wave(word.text) {
        let second = read.name("the second wave, such as `one`")?;
        let v = wave(second.text).ok_or_else(|| {
            let names = WAVES.map(|(name, _)| name).join(", ");
            Problem::new(second.span, format!("there is no wave `{}`", second.text))
                .hint(format!("the waves are {names}"))
        })?;
        return Ok(Method::Waves([u, v]));
    }
    if read.keyword("plain") {
        return Ok(Method::Other("an image"));
    }
    if read.keyword("region") {
        for _ in 0..6 {
            read.vector("the region: min, max and four corners")?;
        }
        return Ok(Method::Other("an image"));
    }
    let is_solid = |solid: &&OptionSpec| solid.name.eq_ignore_ascii_case(word.text);
    if let Some(solid) = SOLIDS.iter().find(is_solid) {
        return Ok(Method::Other(solid.name));
    }
    read.at = back;
    read.colour(WHAT)?;
    Ok(Method::Other("a colour"))
}

fn texture_option<'a>(
    read: &mut Reader<'_, 'a>,
    option: &'static str,
    span: Range<usize>,
    options: &mut Options<'a>,
) -> Outcome<()> {
    match option {
        "translate" => {
            if read.vector("the shift")? != DVec3::ZERO {
                options.not_drawn.push((option, span));
            }
        }
        "scale" => options.scale = read.vector("the scale")?,
        // A strength is one number: the first of the three.
        "times" => options.times = read.vector("the factor")?.x,
        "bounds" => {
            let low = read.vector("the lowest value")?.x;
            options.bounds = [low, read.vector("the highest value")?.x];
        }
        "turbulence" => {
            read.number("the turbulence")?;
            options.not_drawn.push((option, span));
        }
        "octaves" => {
            read.number("the octaves")?;
            options.not_drawn.push((option, span));
        }
        "mask" => {
            read.number("the mask, of 1 and 0")?;
            let mut count = 1;
            while count < MAX_OPERANDS && read.more() && read.peek_word().is_none() {
                read.number("the mask, of 1 and 0")?;
                count += 1;
            }
            options.not_drawn.push((option, span));
        }
        "replace" => options.not_drawn.push((option, span)),
        _ => layer_names(read, options)?,
    }
    Ok(())
}
