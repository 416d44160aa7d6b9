//! `texture`. This version draws one kind: a pair of waves whose target is the strength, which is a
//! profile of the field ([`field::Profile`]). All others are read and checked, and a warning says that
//! they are not drawn.

use super::{Evaluator, Flow};
use crate::Severity;
use crate::commands::OptionSpec;
use crate::commands::options::{SOLIDS, TARGETS, TEXTURE, WAVES};
use crate::given::Chosen;
use crate::problem::{Outcome, Problem};
use crate::reader::Reader;
use crate::syntax::Command;
use field::{Profile, Wave};
use glam::DVec3;
use std::ops::Range;

/// A wave of the table.
fn wave(word: &str) -> Option<Wave> {
    let name = WAVES
        .iter()
        .find(|wave| wave.name.eq_ignore_ascii_case(word))?
        .name;
    Some(match name {
        "one" => Wave::One,
        "x" => Wave::X,
        "saw" => Wave::Saw,
        "hat" => Wave::Hat,
        "step" => Wave::Step,
        "sin" => Wave::Sin,
        "cos" => Wave::Cos,
        "sin^2" => Wave::Sin2,
        _ => Wave::Cos2,
    })
}

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

fn make<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<()> {
    let mut read = run.reader(command);
    let name = read.name("the texture's name")?;
    if read.sign(b'=') {
        let old = read.known_name("the name of the old texture")?;
        read.end()?;
        let texture = run.palette.texture(&old)?.clone();
        return run.palette.insert_texture(&name, texture);
    }
    let start = read.start();
    let Some((target, target_span)) = read.option(TARGETS)? else {
        return Err(read.expected("what the texture changes, such as `strength`"));
    };
    let mut layers = read.operands(target.parameters, TEXTURE)?.names("t1 +");
    let method = match target.name {
        "texture" => None,
        _ => Some(method(&mut read)?),
    };
    let span = read.since(start);
    let options = read.chosen(TEXTURE)?;
    read.end()?;
    let mut profile = Profile {
        waves: [Wave::One; 2],
        scale: [1.0; 2],
        bounds: [0.0, 1.0],
        times: 1.0,
        restriction: 0.0,
    };
    let mut ignored = Vec::new();
    let mut of_waves = Vec::new();
    for Chosen { name, span, given } in options {
        match name {
            "scale" | "times" | "bounds" if method.is_none() => of_waves.push((name, span)),
            "scale" => profile.scale = [given.vector("XYZ").x, given.vector("XYZ").y],
            // A strength is one number: the first of the three.
            "times" => profile.times = given.vector("RGB").x,
            "bounds" => {
                let bounds = given.vectors("RGB");
                profile.bounds = [bounds[0].x, bounds[1].x];
            }
            "texture" => layers.extend(given.names("t1 +")),
            "translate" if given.vector("XYZ") == DVec3::ZERO => {}
            _ => ignored.push((name, span)),
        }
    }
    let mut texture = run.palette.layers(&layers)?;
    match method {
        None => {
            for (what, span) in ignored.into_iter().chain(of_waves) {
                not_drawn(run, span, format!("`{what}` of layers"));
            }
        }
        Some(Method::Waves(waves)) if target.name == "strength" => {
            texture.layers += 1;
            texture.profile = Some(Profile { waves, ..profile });
            for (what, span) in ignored {
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
    if let Some(u) = wave(word.text) {
        let second = read.name("the second wave, such as `one`")?;
        let v = wave(second.text).ok_or_else(|| {
            let names: Vec<_> = WAVES.iter().map(|wave| wave.name).collect();
            let names = names.join(", ");
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
