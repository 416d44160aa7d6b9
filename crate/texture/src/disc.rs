//! Points on discs and spheres, for lenses and for lights with a size, from numbers in [0, 1).

use core::f64::consts::{FRAC_PI_2, FRAC_PI_4, TAU};
use glam::{DVec2, DVec3};

/// Returns a point of the unit disc, evenly spread if (a, b) is over [0, 1)²: squares around the
/// middle become circles (Shirley and Chiu's map), so that near points stay near.
#[must_use]
pub fn disc(sample: [f64; 2]) -> DVec2 {
    let [x, y] = sample.map(|s| 2.0 * s - 1.0);
    if x == 0.0 && y == 0.0 {
        return DVec2::ZERO;
    }
    let (radius, angle) = if x.abs() > y.abs() {
        (x, FRAC_PI_4 * (y / x))
    } else {
        (y, FRAC_PI_2 - FRAC_PI_4 * (x / y))
    };
    let (s, c) = libm::sincos(angle);
    radius * DVec2::new(c, s)
}

/// Returns a direction, evenly spread over the unit sphere.
#[must_use]
pub fn direction(sample: [f64; 2]) -> DVec3 {
    let z = 1.0 - 2.0 * sample[0];
    let around = (1.0 - z * z).max(0.0).sqrt();
    let (s, c) = libm::sincos(TAU * sample[1]);
    DVec3::new(around * c, around * s, z)
}

/// Returns a direction of the half of the unit sphere around a unit `axis`, spread as the cosine of
/// its angle to it: what falls evenly from a sky onto a surface.
#[must_use]
pub fn cosine(axis: DVec3, sample: [f64; 2]) -> DVec3 {
    let [first, second] = frame(axis);
    let at = disc(sample);
    let up = (1.0 - at.length_squared()).max(0.0).sqrt();
    (at.x * first + at.y * second + up * axis).normalize_or(axis)
}

/// Returns two unit vectors perpendicular to a unit vector and to each other.
#[must_use]
pub fn frame(axis: DVec3) -> [DVec3; 2] {
    let size = axis.abs();
    let least = if size.x <= size.y && size.x <= size.z {
        DVec3::X
    } else if size.y <= size.z {
        DVec3::Y
    } else {
        DVec3::Z
    };
    let first = axis.cross(least).normalize_or(DVec3::X);
    [first, axis.cross(first)]
}

/// Returns a point of a spherical light of a radius, seen from `from`: on the disc through its
/// centre that faces the viewer. Its share that is seen past an edge is the light's share that
/// falls there, up to (radius/distance)².
#[must_use]
pub fn light(center: DVec3, radius: f64, from: DVec3, sample: [f64; 2]) -> DVec3 {
    let [first, second] = frame((center - from).normalize_or(DVec3::Z));
    let at = disc(sample) * radius;
    center + at.x * first + at.y * second
}

/// Returns a ray of a thin lens: origin on the lens and unit direction.
///
/// The pinhole's ray goes from `eye` along `direction`. All rays of the lens meet in the point
/// where it meets the plane of focus, `focus` in front of the eye, measured along the unit vector
/// `forward`. `right` and `up` are unit vectors in the lens, `aperture` is its radius. A point at
/// the distance z in front of the eye is thus blurred to a circle whose radius, on the plane of
/// focus, is `aperture·|focus − z|/z`.
#[must_use]
pub fn lens(
    eye: DVec3,
    direction: DVec3,
    [right, up, forward]: [DVec3; 3],
    aperture: f64,
    focus: f64,
    sample: [f64; 2],
) -> (DVec3, DVec3) {
    let ahead = direction.dot(forward);
    if aperture == 0.0 || !(ahead > 0.0 && focus > 0.0 && focus.is_finite()) {
        return (eye, direction);
    }
    let at = disc(sample) * aperture;
    let origin = eye + at.x * right + at.y * up;
    let target = eye + direction * (focus / ahead);
    (origin, (target - origin).normalize_or(direction))
}
