//! CAMERA: from where the picture is taken.

use super::state::{Evaluator, Flow};
use crate::Severity;
use crate::commands::CommandSpec;
use crate::commands::build::{clay, row, sets, takes};
use crate::commands::slot::{degrees, direction, length, number, vector};
use crate::limits::MAX_MAGNITUDE;
use crate::problem::{Outcome, Problem};
use crate::syntax::Command;
use glam::DVec3;
use std::ops::Range;

/// Most by which parallel rays lean against the normal of the view plane.
const MOST_LEAN: f64 = 1.7;

pub static EYEP: CommandSpec = row("eyep", "position of the eye")
    .with(takes!(eyep, vector("XYZ", "the eye's position")))
    .default("0 0 10")
    .example(clay!("eyep 5 5 8\nsphere Clay 2, 0 0 0"));

fn eyep<'a>(run: &mut Evaluator<'a>, command: &'a Command, eye: DVec3) -> Outcome<Flow> {
    run.camera.eye = eye;
    let before = std::mem::take(&mut run.view_plane);
    if before.is_given() {
        let message = "`cp`, `vpn` and `window` from before do not count any more";
        let hint = "there are two kinds of camera; the last one counts";
        run.note(&command.word_span, message, hint);
    }
    run.aimed_at = (run.file, command.span.clone());
    Ok(Flow::Next)
}

pub static VRP: CommandSpec = row("vrp", "view reference point, in the middle of the picture")
    .with(takes!(vrp, vector("XYZ", "the view reference point")))
    .default("0 0 0")
    .example(clay!("vrp 0 1 0\nsphere Clay 2, 0 0 0"));

fn vrp<'a>(run: &mut Evaluator<'a>, command: &'a Command, target: DVec3) -> Outcome<Flow> {
    run.camera.target = target;
    run.aimed_at = (run.file, command.span.clone());
    Ok(Flow::Next)
}

pub static VUP: CommandSpec = row("vup", "direction that is up in the picture")
    .with(sets!(
        |run, up| run.camera.up = up,
        direction("XYZ", "the direction up")
    ))
    .default("0 1 0")
    .example(clay!(
        "vup 0 0 1\neyep 8 4 4\ncylinder Clay 1, <0 0 -2>, <0 0 2>"
    ));

pub static FOV: CommandSpec = row("fov", "angle of view")
    .with(takes!(
        fov,
        degrees("hor", "the horizontal angle of view").from(0.01, 179.0),
        degrees("vert", "the vertical angle of view")
            .from(0.01, 179.0)
            .optional("as the frame's sides")
    ))
    .default("45")
    .details(
        "Without a second angle, or if both are equal, pixels are square: the vertical angle \
         follows from the horizontal one and `framesize`. A second angle that differs from that by \
         more than a twentieth stretches the picture: pixels show more, or less, upwards than \
         across.",
    )
    .example(clay!("fov 30\nsphere Clay 2, 0 0 0"));

fn fov<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    angle: f64,
    vertical: Option<f64>,
) -> Outcome<Flow> {
    let vertical = vertical.unwrap_or(angle);
    run.camera.fov = angle;
    run.view_plane.window = None;
    // Equal angles are how the datasets write "no other proportions than the frame's".
    run.vertical = (vertical != angle).then(|| (vertical, run.file, command.span.clone()));
    Ok(Flow::Next)
}

pub static APERTURE: CommandSpec = row("aperture", "radius of the lens")
    .with(sets!(
        |run, radius| run.lens.aperture = radius,
        length("radius", "the radius of the lens").at_least(0.0)
    ))
    .default("0")
    .details(
        "0 is a pinhole, which draws everything sharp. A lens draws sharp what is as far away as \
         `focus` says, measured along the direction of view; a point at another distance z \
         becomes a disc, whose radius is radius·|focus − z|/z, measured at the distance `focus`. \
         More samples (`sample`) make the blur smoother.",
    )
    .example(clay!(
        "aperture 0.3\nfocus 8\nsample 3\nsphere Clay 1, -1.5 0 -3\nsphere Clay 1, 0 0 2\n\
         sphere Clay 0.7, 1.2 0 5"
    ));

pub static FOCUS: CommandSpec = row("focus", "distance that the lens draws sharp")
    .with(sets!(
        |run, distance| run.lens.focus = Some(distance),
        length("distance", "the distance of the focal plane").at_least(1e-9)
    ))
    .default("to vrp")
    .details("It only shows when the lens has an `aperture`.")
    .example(clay!(
        "aperture 0.3\nfocus 5\nsample 3\nsphere Clay 1, -1.5 0 -3\nsphere Clay 1, 0 0 2\n\
         sphere Clay 0.7, 1.2 0 5"
    ));

pub static SHUTTER: CommandSpec = row("shutter", "how long the shutter is open")
    .with(sets!(
        |run, fraction| run.shutter = fraction,
        number("fraction", "the fraction of time").from(0.0, 1.0)
    ))
    .default("0")
    .details(
        "A share of the time from one frame of an animation to the next: 0 is no blur, with 1 \
         whatever moves is blurred along its whole way. Shapes move that are made of variables \
         which change with every frame; `transform` holds an object still meanwhile. More samples \
         (`sample`) make the blur smoother.",
    )
    .example(clay!(
        "var x = -1 += 2\nshutter 1\nsample 4\nsphere Clay 1, 0 1.5 0\nsphere Clay 1, x -1 0"
    ));

pub static CP: CommandSpec = row("cp", "centre of projection, view coordinates")
    .with(takes!(
        cp,
        length("x", "the place to the right"),
        length("y", "the place upwards"),
        length("z", "the distance before the view plane").at_least(1e-9),
        number("w", "the weight").optional("1")
    ))
    .details(
        "The camera of Foley et al.: the view plane goes through `vrp` with normal `vpn`; \
         `window` is the part of it that the picture shows, seen from `cp`. The weight divides \
         the others. With the weight 0 rays are parallel, and x y z is the direction against \
         which they run: 0 0 1 looks straight at the view plane, 0.5 0.5 1 from the upper right. \
         The eye is then so far away that a true parallel projection would differ by less than \
         half a pixel; fog is as thick as from there. Without a `window` the picture is as wide as \
         `fov` makes it at `vrp`.",
    )
    .example(clay!(
        "vrp 0 0 0\nvpn 0 0 1\ncp 0 0 8\nwindow -3 3 -3 3\nsphere Clay 2, 0 0 0"
    ));

fn cp<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    x: f64,
    y: f64,
    z: f64,
    weight: Option<f64>,
) -> Outcome<Flow> {
    let weight = weight.unwrap_or(1.0);
    run.view_plane.place = (run.file, command.span.clone());
    if weight == 0.0 {
        if x.abs().max(y.abs()) > MOST_LEAN * z {
            return Err(Problem::new(
                &command.span,
                format!("parallel rays lean by {MOST_LEAN} to 1 at most"),
            )
            .hint("make z larger, or turn the view plane with `vpn`"));
        }
        run.view_plane.parallel = Some(DVec3::new(x, y, z));
        run.view_plane.cp = None;
        return Ok(Flow::Next);
    }
    let point = DVec3::new(x, y, z) / weight;
    if !(point.is_finite() && point.abs().max_element() <= MAX_MAGNITUDE) {
        return Err(Problem::new(
            &command.span,
            format!(
                "divided by the weight, the centre of projection is further away than \
                 {MAX_MAGNITUDE:e}"
            ),
        )
        .hint("leave the weight out: it is 1 then"));
    }
    if point.z <= 0.0 {
        return Err(Problem::new(
            &command.span,
            "the centre of projection must lie before the view plane: z / w above 0",
        ));
    }
    run.view_plane.cp = Some(point);
    run.view_plane.parallel = None;
    Ok(Flow::Next)
}

pub static VPN: CommandSpec = row("vpn", "normal of the view plane, towards the eye")
    .with(takes!(
        vpn,
        direction("XYZ", "the normal of the view plane")
    ))
    .default("0 0 1")
    .example(clay!(
        "vpn 1 1 1\ncp 0 0 8\nwindow -3 3 -3 3\nsphere Clay 2, 0 0 0"
    ));

fn vpn<'a>(run: &mut Evaluator<'a>, command: &'a Command, normal: DVec3) -> Outcome<Flow> {
    run.view_plane.normal = Some(normal);
    run.view_plane.place = (run.file, command.span.clone());
    Ok(Flow::Next)
}

pub static WINDOW: CommandSpec = row(
    "window",
    "the part of the view plane that the picture shows",
)
.with(takes!(
    window,
    length("x", "the left edge"),
    length("X", "the right edge"),
    length("y", "the lower edge"),
    length("Y", "the upper edge")
))
.details(
    "In view coordinates, as for `cp`. Where its proportions are not those of `framesize`, pixels \
     are not square: the picture is stretched.",
)
.example(clay!("cp 0 0 8\nwindow -4 4 -4 4\nsphere Clay 2, 0 0 0"));

fn window<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    left: f64,
    right: f64,
    lower: f64,
    upper: f64,
) -> Outcome<Flow> {
    if left >= right || lower >= upper {
        return Err(Problem::new(
            &command.span,
            "the window's first edge must be less than the second, its third less than the fourth",
        )
        .hint("it is written `window left right lower upper`"));
    }
    run.view_plane.window = Some([left, right, lower, upper]);
    run.view_plane.place = (run.file, command.span.clone());
    Ok(Flow::Next)
}

impl Evaluator<'_> {
    /// Returns the camera that `cp`, `vpn` and `window` describe, or the one of `eyep` and `fov`.
    ///
    /// In Foley's terms the view plane goes through the reference point; u points right, v up, n is
    /// the normal, towards the eye.
    pub(super) fn camera_of_picture(&mut self) -> scene::Camera {
        let mut camera = self.camera;
        let [width, height] = self.settings.frame.map(f64::from);
        let half_angle = camera.fov.to_radians() * 0.5;
        if let Some((vertical, ..)) = self.vertical {
            let half = libm::tan(half_angle) * height / width;
            let square = 2.0 * libm::atan(half).to_degrees();
            // Angles that nearly fit the frame are meant to fit it.
            if (square / vertical - 1.0).abs() > 0.05 {
                let (file, span) = self.place_of_vertical();
                camera.pixel = libm::tan(vertical.to_radians() * 0.5) / half;
                self.check_pixel(&mut camera, file, &span);
            }
        }
        let plane = self.view_plane.clone();
        if !plane.is_given() {
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
        let (file, span) = plane.place;
        if let Some([left, rightmost, low, high]) = plane.window {
            let shown = (rightmost - left) * height / width;
            camera.pixel = (high - low) / shown;
            self.check_pixel(&mut camera, file, &span);
        }
        if let Some(direction) = plane.parallel {
            let [left, rightmost, low, high] = plane.window.unwrap_or_else(|| {
                let half = libm::tan(half_angle) * toward.length().max(1e-9);
                [-half, half, 0.0, 0.0]
            });
            let middle = right * (0.5 * (left + rightmost)) + up * (0.5 * (low + high));
            camera.target += middle;
            return camera.far([right, up, normal], direction, 0.5 * (rightmost - left));
        }
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
                .clamp(scene::Camera::ANGLES[0], scene::Camera::ANGLES[1]);
            camera.shift = [
                (0.5 * (left + rightmost) - cp.x) / half,
                (0.5 * (low + high) - cp.y) / half,
            ];
            // Beyond this a picture shows nothing but rays side by side.
            if !camera.shift.iter().all(|shift| shift.abs() <= 1e3) {
                camera.shift = [0.0; 2];
                let message = "the window is too small, or too far from the centre of projection";
                let hint = "put the middle of the window nearer to `cp`'s x and y";
                self.say_at(file, Severity::Error, &span, message, hint);
            }
        }
        camera
    }

    /// Returns the file and place of the vertical angle of view.
    fn place_of_vertical(&self) -> (usize, Range<usize>) {
        let place = self
            .vertical
            .as_ref()
            .map(|(_, file, span)| (*file, span.clone()));
        place.unwrap_or_default()
    }

    /// Makes the pixels of a camera square, with an error, if they are too far from that.
    fn check_pixel(&mut self, camera: &mut scene::Camera, file: usize, span: &Range<usize>) {
        let [least, most] = scene::Camera::PIXELS;
        if !(least..=most).contains(&camera.pixel) {
            camera.pixel = 1.0;
            let message = format_args!("pixels would be more than {most} times as long as wide");
            let hint = "give the proportions of `framesize`, or nearly so";
            self.say_at(file, Severity::Error, span, message, hint);
        }
    }
}
