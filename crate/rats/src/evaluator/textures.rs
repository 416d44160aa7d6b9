//! `texture`. This version draws one kind: a pair of waves whose target is the strength, which is a
//! profile of the field ([`field::Profile`]). All others are read and checked, and a warning says that
//! they are not drawn.

use super::palette::Texture;
use super::state::{Evaluator, Flow};
use crate::Severity;
use crate::commands::OptionSpec;
use crate::commands::options::{SOLIDS, TARGETS, TEXTURE, WAVES};
use crate::given::Chosen;
use crate::problem::{Outcome, Problem};
use crate::reader::{Name, Reader};
use crate::suggest;
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
///
/// Of our own: `texture new = old option …` changes the copy.
pub fn texture<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let name = run.reader(command).new_name("the texture's name")?;
    make(run, command).inspect_err(|_| run.palette.insert_broken(name.text))?;
    Ok(Flow::Next)
}

/// The effect of a texture's own layer.
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
        let options = read.chosen(TEXTURE)?;
        read.end()?;
        let texture = derived(run, &old, options)?;
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
    let ignored = change(
        options,
        method.is_some().then_some(&mut profile),
        &mut layers,
    );
    let mut texture = run.palette.layers(&layers)?;
    match method {
        None => {
            for (what, span) in ignored {
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

/// A copy with changes. Those of what is not drawn say nothing: the original's command has said it.
fn derived<'a>(
    run: &mut Evaluator<'a>,
    old: &Name<'a>,
    options: Vec<Chosen<'a>>,
) -> Outcome<Texture> {
    let original = run.palette.texture(old)?.clone();
    let mut own = original.profile.filter(|_| original.layers == 1);
    let mut layers = vec![old.clone()];
    let ignored = change(options, own.as_mut(), &mut layers);
    let mut texture = run.palette.layers(&layers)?;
    texture.profile = own.or(texture.profile);
    if original.profile.is_some() {
        let of = if own.is_some() {
            "a strength"
        } else {
            "layers"
        };
        for (what, span) in ignored {
            not_drawn(run, span, format!("`{what}` of {of}"));
        }
    }
    Ok(texture)
}

/// Applies options to a texture's own profile, if it has one, and collects its other layers; gives the options
/// that change nothing.
fn change<'a>(
    options: Vec<Chosen<'a>>,
    mut profile: Option<&mut Profile>,
    layers: &mut Vec<Name<'a>>,
) -> Vec<(&'static str, Range<usize>)> {
    let mut ignored = Vec::new();
    for Chosen { name, span, given } in options {
        match (name, profile.as_deref_mut()) {
            ("scale", Some(profile)) => {
                profile.scale = [given.vector("XYZ").x, given.vector("XYZ").y];
            }
            // A strength is one number: the first of the three.
            ("times", Some(profile)) => profile.times = given.vector("RGB").x,
            ("bounds", Some(profile)) => {
                let bounds = given.vectors("RGB");
                profile.bounds = [bounds[0].x, bounds[1].x];
            }
            ("texture", _) => layers.extend(given.names("t1 +")),
            ("translate", _) if given.vector("XYZ") == DVec3::ZERO => {}
            _ => ignored.push((name, span)),
        }
    }
    ignored
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
    read.colour(WHAT).map_err(|problem| {
        // Names of one letter are near to any.
        let words = SOLIDS.iter().chain(WAVES).map(|word| word.name);
        match suggest::hint(word.text, words.filter(|word| word.len() > 1)) {
            Some(hint) if problem.span == word.span => problem.hint(hint),
            _ => problem,
        }
    })?;
    Ok(Method::Other("a colour"))
}
