//! CAMERA: from where the picture is taken.

use super::state::{Evaluator, Flow};
use crate::Severity;
use crate::limits::MAX_MAGNITUDE;
use crate::problem::{Outcome, Problem};
use crate::syntax::Command;
use glam::DVec3;

/// `eyep XYZ`
pub fn eyep<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    run.camera.eye = run.given(command)?.vector("XYZ");
    let before = std::mem::take(&mut run.view_plane);
    if before.cp.is_some() || before.normal.is_some() || before.window.is_some() {
        run.say(Severity::Note, command.word_span.clone(), || {
            (
                String::from("`cp`, `vpn` and `window` from before do not count any more"),
                Some(String::from(
                    "there are two kinds of camera; the last one counts",
                )),
            )
        });
    }
    run.aimed_at = (run.file, command.span.clone());
    Ok(Flow::Next)
}

/// `vrp XYZ`
pub fn vrp<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    run.camera.target = run.given(command)?.vector("XYZ");
    run.aimed_at = (run.file, command.span.clone());
    Ok(Flow::Next)
}

/// `vup XYZ`
pub fn vup<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    run.camera.up = run.given(command)?.vector("XYZ");
    Ok(Flow::Next)
}

/// `fov hor [vert]`
pub fn fov<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let given = run.given(command)?;
    let angle = given.number("hor");
    let vertical = given.maybe_number("vert").unwrap_or(angle);
    run.camera.fov = angle;
    run.view_plane.window = None;
    // Equal angles are how the datasets write "no other proportions than the frame's".
    run.vertical = (vertical != angle).then(|| (vertical, run.file, command.span.clone()));
    Ok(Flow::Next)
}

/// `aperture radius`
pub fn aperture<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    run.lens.aperture = run.given(command)?.number("radius");
    Ok(Flow::Next)
}

/// `focus distance`
pub fn focus<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    run.lens.focus = Some(run.given(command)?.number("distance"));
    Ok(Flow::Next)
}

/// `shutter fraction`
pub fn shutter<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    run.shutter = run.given(command)?.number("fraction");
    Ok(Flow::Next)
}

/// `cp x y z [w]`
pub fn cp<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let given = run.given(command)?;
    let weight = given.maybe_number("w").unwrap_or(1.0);
    if weight == 0.0 {
        return Err(Problem::new(
            command.span.clone(),
            "the weight of a centre of projection must not be 0: parallel projections are not drawn",
        )
        .hint("put the eye far away and make the window's angle small"));
    }
    let point = DVec3::new(given.number("x"), given.number("y"), given.number("z")) / weight;
    if !(point.is_finite() && point.abs().max_element() <= MAX_MAGNITUDE) {
        return Err(Problem::new(
            command.span.clone(),
            format!("divided by the weight, the centre of projection is further away than {MAX_MAGNITUDE:e}"),
        )
        .hint("leave the weight out: it is 1 then"));
    }
    if point.z <= 0.0 {
        return Err(Problem::new(
            command.span.clone(),
            "the centre of projection must lie before the view plane: z / w above 0",
        ));
    }
    run.view_plane.cp = Some(point);
    run.view_plane.place = (run.file, command.span.clone());
    Ok(Flow::Next)
}

/// `vpn XYZ`
pub fn vpn<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    run.view_plane.normal = Some(run.given(command)?.vector("XYZ"));
    run.view_plane.place = (run.file, command.span.clone());
    Ok(Flow::Next)
}

/// `window x X y Y`
pub fn window<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let given = run.given(command)?;
    let edges = ["x", "X", "y", "Y"].map(|edge| given.number(edge));
    if edges[0] >= edges[1] || edges[2] >= edges[3] {
        return Err(Problem::new(
            command.span.clone(),
            "the window's first edge must be less than the second, its third less than the fourth",
        )
        .hint("it is written `window left right lower upper`"));
    }
    run.view_plane.window = Some(edges);
    run.view_plane.place = (run.file, command.span.clone());
    Ok(Flow::Next)
}

impl Evaluator<'_> {
    /// The camera that `cp`, `vpn` and `window` describe, or the one of `eyep` and `fov`.
    ///
    /// In Foley's terms the view plane goes through the reference point; u points right, v up, n is
    /// the normal, towards the eye.
    pub(super) fn settled_camera(&mut self) -> scene::Camera {
        let mut camera = self.camera;
        let plane = self.view_plane.clone();
        if plane.cp.is_none() && plane.normal.is_none() && plane.window.is_none() {
            return camera;
        }
        let toward = camera.eye - camera.target;
        let normal = plane
            .normal
            .or_else(|| toward.try_normalize())
            .unwrap_or(DVec3::Z);
        let right = camera
            .up
            .cross(normal)
            .try_normalize()
            .unwrap_or_else(|| normal.any_orthonormal_vector());
        let up = normal.cross(right);
        let cp = plane
            .cp
            .unwrap_or(DVec3::new(0.0, 0.0, toward.length().max(1e-9)));
        let reference = camera.target;
        camera.eye = reference + right * cp.x + up * cp.y + normal * cp.z;
        camera.target = camera.eye - normal * cp.z;
        if let Some([left, rightmost, low, high]) = plane.window {
            let half = 0.5 * (rightmost - left);
            camera.fov = (2.0 * libm::atan(half / cp.z))
                .to_degrees()
                .clamp(0.01, 179.0);
            camera.shift = [
                (0.5 * (left + rightmost) - cp.x) / half,
                (0.5 * (low + high) - cp.y) / half,
            ];
            // Beyond this a picture shows nothing but rays side by side.
            if !camera.shift.iter().all(|shift| shift.abs() <= 1e3) {
                camera.shift = [0.0; 2];
                let (file, span) = plane.place.clone();
                self.say_at(file, Severity::Error, span, || {
                    (
                        String::from(
                            "the window is too small, or too far from the centre of projection",
                        ),
                        Some(String::from(
                            "put the middle of the window nearer to `cp`'s x and y",
                        )),
                    )
                });
            }
            let [width, height] = self.settings.frame.map(f64::from);
            let shown = (rightmost - left) * height / width;
            if (shown / (high - low) - 1.0).abs() > 0.05 {
                let (file, span) = plane.place;
                self.say_at(file, Severity::Note, span, || {
                    (
                        format!(
                            "pixels are square, so the picture shows a height of {shown:.4}, not {:.4}",
                            high - low
                        ),
                        Some(String::from("choose a framesize of the window's proportions")),
                    )
                });
            }
        }
        camera
    }

    /// Checks the camera as a whole, once the text is at its end.
    pub(super) fn check_camera(&mut self) {
        if let Some((vertical, file, span)) = self.vertical.take() {
            let [width, height] = self.settings.frame.map(f64::from);
            let half = libm::tan(self.camera.fov.to_radians() * 0.5) * height / width;
            let drawn = 2.0 * libm::atan(half).to_degrees();
            if (drawn / vertical - 1.0).abs() > 0.05 {
                self.say_at(file, Severity::Note, span, || {
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
