//! OPTIONS: settings of the whole picture.

use super::state::{Evaluator, Flow};
use crate::Severity;
use crate::commands::options::{FORMATS, MESH};
use crate::problem::Outcome;
use crate::syntax::Command;
use field::BlobScale;
use scene::{Digger, Fragile, Tone};

/// `echo on|off`: nothing is echoed anyway, and every published dataset says it, so nothing is said.
pub fn silent_switch<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    run.given(command)?;
    Ok(Flow::Next)
}

/// `warning on|off`
pub fn warning<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    run.report.no_warnings = !run.given(command)?.switch();
    Ok(Flow::Next)
}

/// `verbose on|off`
pub fn verbose<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    run.report.no_notes = !run.given(command)?.switch();
    Ok(Flow::Next)
}

/// `soft on|off`
pub fn soft<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    run.settings.soft = run.given(command)?.switch();
    Ok(Flow::Next)
}

/// `double on|off`
pub fn double<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    run.settings.double_sided = run.given(command)?.switch();
    Ok(Flow::Next)
}

/// `gamma value`
pub fn gamma<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    run.settings.gamma = run.given(command)?.number("value") as f32;
    Ok(Flow::Next)
}

/// `framesize w h`
pub fn framesize<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let given = run.given(command)?;
    run.settings.frame = ["w", "h"].map(|side| given.number(side) as u32);
    Ok(Flow::Next)
}

/// `filename name`: an ending that is a format counts as `format` too.
pub fn filename<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let given = run.given(command)?;
    let name = given.name("name").text;
    let format = name.rsplit_once('.').and_then(|(stem, ending)| {
        let known = FORMATS
            .iter()
            .find(|f| f.name.eq_ignore_ascii_case(ending))?;
        Some((stem, known.name))
    });
    match format {
        Some((stem, format)) => {
            run.output.name = stem.to_owned();
            run.output.format = Some(format);
        }
        None => run.output.name = name.to_owned(),
    }
    Ok(Flow::Next)
}

/// `format tif|tga|mtv|png`
pub fn format<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    run.output.format = run.given(command)?.word("format");
    Ok(Flow::Next)
}

/// `nosave on|off`
pub fn nosave<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    run.output.saved = !run.given(command)?.switch();
    Ok(Flow::Next)
}

/// `sample n`
pub fn sample<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let given = run.given(command)?;
    run.settings.samples = given.number("n") as u32;
    run.sampled = true;
    if let Some(span) = given.span("method") {
        run.say(Severity::Note, span, || {
            (
                String::from(
                    "the method changes nothing here: there is one, which spreads rays evenly",
                ),
                None,
            )
        });
    }
    Ok(Flow::Next)
}

/// `penumbra on|off`
pub fn penumbra<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    run.settings.penumbra = run.given(command)?.switch();
    Ok(Flow::Next)
}

/// `epsilon value`
pub fn epsilon<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    run.settings.epsilon = run.given(command)?.number("value");
    Ok(Flow::Next)
}

/// `vanish value`
pub fn vanish<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    run.settings.vanish = run.given(command)?.number("value") as f32;
    Ok(Flow::Next)
}

/// `maxdepth number`
pub fn maxdepth<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    run.settings.max_depth = run.given(command)?.number("number") as u32;
    Ok(Flow::Next)
}

/// `tone none|filmic`
pub fn tone<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    run.settings.tone = match run.given(command)?.word("what") {
        Some("filmic") => Tone::Filmic,
        _ => Tone::None,
    };
    Ok(Flow::Next)
}

/// `contrast r g b`
pub fn contrast<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    run.settings.contrast = run.given(command)?.colour("r g b");
    Ok(Flow::Next)
}

/// `fragile all|none|arc|…`: what it names, and nothing else.
pub fn fragile<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let mut fragile = Fragile::default();
    for (name, _) in run.given(command)?.words("what") {
        match name {
            "all" => fragile = Fragile::ALL,
            "none" => fragile = Fragile::default(),
            "arc" => fragile.arc = true,
            "pipe" => fragile.pipe = true,
            "cylinder" => fragile.cylinder = true,
            _ => fragile.sphere = true,
        }
    }
    run.settings.fragile = fragile;
    Ok(Flow::Next)
}

/// `blobscale relative|absolute`
pub fn blobscale<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    run.settings.blob_scale = match run.given(command)?.word("what") {
        Some("absolute") => BlobScale::Absolute,
        _ => BlobScale::Relative,
    };
    Ok(Flow::Next)
}

/// `influence e`
pub fn influence<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    run.settings.influence = run.given(command)?.number("e");
    Ok(Flow::Next)
}

/// `digger name [n]`
pub fn digger<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let given = run.given(command)?;
    run.settings.digger = match given.word("name") {
        Some("hermite2") => Digger::Spans(given.maybe_number("n").map_or(2, |n| n as u32)),
        Some("lagrange") => Digger::Lagrange,
        Some("brent") => Digger::Brent,
        Some("ridder") => Digger::Ridder,
        Some("RF") => Digger::RegulaFalsi,
        Some("LG") => Digger::Lg,
        Some("sphere") => Digger::Sphere,
        _ => Digger::Hermite,
    };
    if let Some(span) = given.span("n")
        && !matches!(run.settings.digger, Digger::Spans(_))
    {
        run.say(Severity::Warning, span, || {
            (
                String::from("only `hermite2` has a number of spans"),
                Some(String::from("leave the number out")),
            )
        });
    }
    Ok(Flow::Next)
}

/// `map on|off [N]`
pub fn map<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let given = run.given(command)?;
    let gamma = given.maybe_number("N").unwrap_or(1.0) as f32;
    run.settings.map = given.switch().then_some(gamma);
    Ok(Flow::Next)
}

/// `mesh robust|fast`, `mesh sn fn`
pub fn mesh<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let mut read = run.reader(command);
    let is_control = read.peek_word().is_some_and(|(_, word)| {
        MESH.iter()
            .any(|control| control.name.eq_ignore_ascii_case(word))
    });
    // A material may be called so: then a file follows.
    let alone = read.items.len() == read.at + 1;
    if !is_control || !alone {
        return super::primitives::mesh(run, command);
    }
    read.at += 1;
    read.end()?;
    run.say(Severity::Note, command.word_span.clone(), || {
        (
            String::from("`mesh` with this word changes nothing here: faces are always checked"),
            None,
        )
    });
    Ok(Flow::Next)
}
