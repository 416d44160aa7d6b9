//! CAMERA: from where the picture is taken.

use super::{Evaluator, Flow};
use crate::Severity;
use crate::problem::{Outcome, Problem};
use crate::syntax::Command;

/// `eyep XYZ`
pub fn eyep<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let mut read = run.reader(command);
    let eye = read.vector("the eye's position")?;
    read.end()?;
    run.camera.eye = eye;
    run.aimed_at = (run.file, command.span.clone());
    Ok(Flow::Next)
}

/// `vrp XYZ`
pub fn vrp<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let mut read = run.reader(command);
    let target = read.vector("the view reference point")?;
    read.end()?;
    run.camera.target = target;
    run.aimed_at = (run.file, command.span.clone());
    Ok(Flow::Next)
}

/// `vup XYZ`
pub fn vup<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let mut read = run.reader(command);
    let up = read.direction("the direction up")?;
    read.end()?;
    run.camera.up = up;
    Ok(Flow::Next)
}

/// `fov hor [vert]`
pub fn fov<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let mut read = run.reader(command);
    let start = read.start();
    let angle = read.number("the horizontal angle of view")?;
    let vertical = if read.more() {
        read.number("the vertical angle of view")?
    } else {
        angle
    };
    read.end()?;
    for a in [angle, vertical] {
        if !(0.01..=179.0).contains(&a) {
            return Err(Problem::new(
                read.since(start),
                format!("an angle of view must be from 0.01 to 179 degrees, not {a}"),
            ));
        }
    }
    run.camera.fov = angle;
    // Equal angles are how the datasets write "no other proportions than the frame's".
    run.vertical = (vertical != angle).then(|| (vertical, run.file, command.span.clone()));
    Ok(Flow::Next)
}

/// `aperture radius`: 0, a pinhole, is all there is in this version.
pub fn aperture<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    zero_only(run, command, "the radius of the lens")
}

/// `shutter fraction`: 0, no blur, is all there is in this version.
pub fn shutter<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    zero_only(run, command, "the fraction of time")
}

fn zero_only<'a>(run: &mut Evaluator<'a>, command: &'a Command, what: &str) -> Outcome<Flow> {
    let mut read = run.reader(command);
    let value = read.number_in(what, 0.0, crate::limits::MAX_MAGNITUDE)?;
    read.end()?;
    if value != 0.0 {
        let name = run.scope.symbols.word(command.word);
        run.not_carried_out(command.word_span.clone(), &format!("`{name}`"));
    }
    Ok(Flow::Next)
}

impl Evaluator<'_> {
    /// What is odd about the camera as a whole, once the text is at its end.
    pub(super) fn check_camera(&mut self) {
        if let Some((vertical, file, span)) = self.vertical.take() {
            let [width, height] = self.settings.frame.map(f64::from);
            let half = libm::tan(self.camera.fov.to_radians() * 0.5) * height / width;
            let drawn = 2.0 * libm::atan(half).to_degrees();
            if (drawn / vertical - 1.0).abs() > 0.05 {
                self.file = file;
                self.say(Severity::Note, span, || {
                    (
                        format!(
                            "pixels are square, so the vertical angle of view is {drawn:.1} degrees, not {vertical}"
                        ),
                        Some(String::from(
                            "choose a framesize of the same proportions, or leave the second angle out",
                        )),
                    )
                });
            }
        }
    }
}
