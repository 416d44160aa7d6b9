//! OPTIONS: settings of the whole picture.

use super::{Evaluator, Flow};
use crate::problem::{Outcome, Problem};
use crate::syntax::Command;
use field::BlobScale;
use scene::{Fragile, Settings};

fn switch<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<bool> {
    let mut read = run.reader(command);
    let on = read.on_off()?;
    read.end()?;
    Ok(on)
}

/// `echo on|off`: nothing is echoed anyway, and every published dataset says it, so nothing is said.
pub fn silent_switch<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    switch(run, command)?;
    Ok(Flow::Next)
}

/// `warning on|off`
pub fn warning<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    run.report.no_warnings = !switch(run, command)?;
    Ok(Flow::Next)
}

/// `verbose on|off`
pub fn verbose<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    run.report.no_notes = !switch(run, command)?;
    Ok(Flow::Next)
}

/// `soft on|off`
pub fn soft<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    run.settings.soft = switch(run, command)?;
    Ok(Flow::Next)
}

/// `gamma value`
pub fn gamma<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let mut read = run.reader(command);
    let gamma = read.number_in("gamma", 0.1, 10.0)?;
    read.end()?;
    run.settings.gamma = gamma as f32;
    Ok(Flow::Next)
}

/// `framesize w h`
pub fn framesize<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let mut read = run.reader(command);
    let width = read.whole("the width", 1, Settings::MAX_FRAME)?;
    let height = read.whole("the height", 1, Settings::MAX_FRAME)?;
    read.end()?;
    run.settings.frame = [width, height];
    Ok(Flow::Next)
}

/// `sample n`
pub fn sample<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let mut read = run.reader(command);
    let samples = read.whole("the number of samples", 1, Settings::MAX_SAMPLES)?;
    let method = read.more().then(|| read.here());
    run.settings.samples = samples;
    if let Some(span) = method {
        run.not_carried_out(span, "the sampling method");
    }
    Ok(Flow::Next)
}

/// `contrast r g b`
pub fn contrast<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let mut read = run.reader(command);
    let contrast = read.colour("the contrast")?;
    read.end()?;
    run.settings.contrast = contrast;
    Ok(Flow::Next)
}

/// `fragile all|none|arc|…`: what it names, and nothing else.
pub fn fragile<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let mut read = run.reader(command);
    let mut fragile = Fragile::default();
    if !read.more() {
        return Err(read.expected("`all`, `none` or the names of primitives"));
    }
    while let Some((option, _)) = read.option(crate::commands::options::FRAGILE)? {
        match option.name {
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
    let mut read = run.reader(command);
    let Some((option, _)) = read.option(crate::commands::options::BLOBSCALE)? else {
        return Err(read.expected("`relative` or `absolute`"));
    };
    read.end()?;
    run.settings.blob_scale = match option.name {
        "absolute" => BlobScale::Absolute,
        _ => BlobScale::Relative,
    };
    Ok(Flow::Next)
}

/// `influence e`
pub fn influence<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let mut read = run.reader(command);
    let influence = read.number_in("the share of the threshold", 1e-9, 0.5)?;
    read.end()?;
    run.settings.influence = influence;
    Ok(Flow::Next)
}

/// `digger …`: Hermite interpolation is the one there is.
pub fn digger<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let mut read = run.reader(command);
    let Some((option, span)) = read.option(crate::commands::options::DIGGER)? else {
        return Err(Problem::new(command.span.clone(), "`digger` needs a name")
            .hint("`hermite` is the one there is"));
    };
    read.end()?;
    if option.name != "hermite" {
        run.not_carried_out(span, &format!("`{}`", option.name));
    }
    Ok(Flow::Next)
}
