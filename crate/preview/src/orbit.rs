//! Moving a camera with the pointer: pure functions from a camera to a camera.
//!
//! Distances that the pointer went are shares of the view: `across` of its width, positive to the
//! right; `down` of its height, positive downwards. So the feel is the same on a phone and on a
//! large screen. All cameras that come out are finite and can be drawn.

use cells::Bounds;
use core::f64::consts::PI;
use glam::DVec3;
use scene::{Camera, Scene};

/// The nearest that the line of sight comes to the up vector, radians: at the poles themselves
/// there is no telling what is up.
const POLE: f64 = 0.01;
/// Distances from eye to target that [`zoom`] keeps to, world units.
const DISTANCES: [f64; 2] = [1e-6, 1e9];
/// The most that one call of [`zoom`] changes the distance.
const STRONGEST_ZOOM: f64 = 100.0;

/// Turns the eye around the target as on a turntable: across the whole view is half a turn. The
/// up vector stays, and the eye stops just short of the poles, so the picture never flips.
#[must_use]
pub fn orbit(camera: Camera, across: f64, down: f64) -> Camera {
    let camera = usable(camera);
    let across = finite(across);
    let down = finite(down);
    let axes = camera.projection(1, 1).world_from_view;
    let axis = camera.up.try_normalize().unwrap_or(axes.y_axis);
    let distance = camera.eye.distance(camera.target);
    let backwards = axes.z_axis;

    // Spherical coordinates about the up vector.
    let height = libm::asin(backwards.dot(axis).clamp(-1.0, 1.0));
    let limit = 0.5 * PI - POLE;
    let height = (height + down * PI).clamp(-limit, limit);
    // Horizontal part of the line of sight; at a pole, the picture's vertical.
    let level = axis.cross(axes.x_axis).normalize_or(backwards) * -1.0;
    let level = turn(level, axis, -across * PI);
    let (sine, cosine) = libm::sincos(height);
    Camera {
        eye: camera.target + (level * cosine + axis * sine) * distance,
        ..camera
    }
}

/// Shifts eye and target in the plane of the picture, so that what is at the target's distance
/// follows the pointer. `size` gives the view's proportions.
#[must_use]
pub fn pan(camera: Camera, across: f64, down: f64, size: [u32; 2]) -> Camera {
    let camera = usable(camera);
    let projection = camera.projection(size[0], size[1]);
    let axes = projection.world_from_view;
    let distance = camera.eye.distance(camera.target);
    let shift = axes.y_axis * (finite(down) * 2.0 * projection.half_height * distance)
        - axes.x_axis * (finite(across) * 2.0 * projection.half_width * distance);
    Camera {
        eye: camera.eye + shift,
        target: camera.target + shift,
        ..camera
    }
}

/// Multiplies the distance from eye to target by `factor`: less than 1 comes nearer. It stays
/// between 10⁻⁶ and 10⁹. A factor that is not a positive number does nothing.
#[must_use]
pub fn zoom(camera: Camera, factor: f64) -> Camera {
    let camera = usable(camera);
    if factor.is_nan() || factor <= 0.0 {
        return camera;
    }
    let factor = factor.clamp(1.0 / STRONGEST_ZOOM, STRONGEST_ZOOM);
    let distance = camera.eye.distance(camera.target);
    let wanted = (distance * factor).clamp(DISTANCES[0], DISTANCES[1]);
    let backwards = camera.projection(1, 1).world_from_view.z_axis;
    Camera {
        eye: camera.target + backwards * wanted,
        ..camera
    }
}

/// The share of the picture's shorter side that [`frame`] leaves free around a scene.
const MARGIN: f64 = 0.05;

/// Returns a camera that sees all of a scene in the middle of a picture of the given size, for a
/// text that gives none or to recover a lost view. It keeps the direction, up vector and angle of
/// view of `camera`.
#[must_use]
pub fn frame(scene: &Scene, camera: Camera, size: [u32; 2]) -> Camera {
    let bounds = Bounds::of(scene);
    let projection = camera.projection(size[0], size[1]);
    let narrow = projection.half_width.min(projection.half_height) * (1.0 - MARGIN);
    // A sphere of radius r touches a cone of half angle α whose tip is r / sin α away.
    let sine = narrow / (1.0 + narrow * narrow).sqrt();
    let backwards = projection.world_from_view.z_axis;
    Camera {
        eye: bounds.center + backwards * (bounds.radius / sine),
        target: bounds.center,
        shift: [0.0; 2],
        ..camera
    }
}

fn near(v: DVec3) -> bool {
    v.is_finite() && v.abs().max_element() < 1e100
}

/// A camera that has a finite place and looks somewhere.
fn usable(camera: Camera) -> Camera {
    let fallback = Camera::default();
    if !near(camera.eye)
        || !near(camera.target)
        || !camera.fov.is_finite()
        || !camera.pixel.is_finite()
        || !camera.shift.iter().all(|s| s.abs() <= Camera::MAX_SHIFT)
    {
        return fallback;
    }
    let up = if near(camera.up) && camera.up.try_normalize().is_some() {
        camera.up
    } else {
        fallback.up
    };
    let eye = if camera.eye == camera.target {
        camera.target + DVec3::Z
    } else {
        camera.eye
    };
    Camera { eye, up, ..camera }
}

fn finite(x: f64) -> f64 {
    if x.is_finite() { x } else { 0.0 }
}

/// Turns a vector about a unit axis by an angle in radians (Rodrigues).
fn turn(v: DVec3, axis: DVec3, angle: f64) -> DVec3 {
    let (sine, cosine) = libm::sincos(angle);
    v * cosine + axis.cross(v) * sine + axis * (axis.dot(v) * (1.0 - cosine))
}

#[cfg(test)]
mod tests;
