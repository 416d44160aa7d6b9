//! Evaluations of a primitive's field, and how exact they can be.

use crate::quadrature::{Definition, define};
use core::f64::consts::PI;
use field::{Evaluate, Jet, Primitive, Profile, Shaping, Skeleton};
use glam::DVec3;

/// Way of computing a primitive's field: value and gradient at a point.
pub type Evaluation<'e> = &'e dyn Fn(&Primitive, DVec3) -> (f64, DVec3);

/// Returns a primitive that has flesh.
///
/// # Panics
/// If it has none.
pub fn primitive(skeleton: Skeleton, shaping: &Shaping, profile: Option<Profile>) -> Primitive {
    Primitive::new(skeleton.clone(), shaping, profile)
        .unwrap_or_else(|| panic!("no flesh: {skeleton:?} {shaping:?}"))
}

/// Returns value and gradient by one of `field`'s own evaluators, as doubles: an [`Evaluation`].
pub fn jet<R: Evaluate>(primitive: &Primitive, point: DVec3) -> (f64, DVec3) {
    let Jet { value, gradient } = primitive.jet(point.to_array().map(R::splat));
    (
        value.lane(0),
        DVec3::from_array(gradient.map(|g| g.lane(0))),
    )
}

/// Returns the nearest point with coordinates of single precision.
pub fn single(point: DVec3) -> DVec3 {
    DVec3::from_array(point.to_array().map(|x| f64::from(x as f32)))
}

/// Returns the sensitivity of the value to its input: its change when the point and the skeleton's
/// corners move by one part in 1 of their size.
///
/// Errors are measured against it: `error ≤ n·ε·(|f| + sensitivity)` says that a result is exact
/// for inputs that differ by n units in the last place from those given.
pub fn sensitivity(primitive: &Primitive, point: DVec3) -> f64 {
    let size = extent(&primitive.skeleton);
    let slope = jet::<f64>(primitive, point).1.length();
    let mut sum = slope * (point.length() + size);
    let longest = match &primitive.skeleton {
        Skeleton::Triangle { corners: [a, b, c] } => (*b - *a)
            .length()
            .max((*c - *b).length())
            .max((*a - *c).length()),
        Skeleton::Polygon { rings } => rings
            .iter()
            .flat_map(|ring| (0..ring.len()).map(|i| ring[i].distance(ring[(i + 1) % ring.len()])))
            .fold(0.0, f64::max),
        _ => 0.0,
    };
    if longest > 0.0 {
        // A needle's width is uncertain by its length: so is the field, by a line's of that width.
        let square = (primitive.width * primitive.skeleton.distance(point)).powi(2);
        let line = match define(primitive.kernel) {
            Definition::Pole(1) => {
                let k = (square + 1e-10).sqrt() / primitive.width;
                2.0 * libm::asinh(longest / (2.0 * k)) / primitive.width
            }
            Definition::Pole(2) => {
                let k = (square + 1e-10).sqrt() / primitive.width;
                2.0 * libm::atan(longest / (2.0 * k)) / (k * primitive.width * primitive.width)
            }
            Definition::Pole(_) => {
                let k2 = (square + 1e-10) / primitive.width.powi(2);
                longest / (k2 * (k2 + longest * longest / 4.0).sqrt() * primitive.width.powi(3))
            }
            _ => {
                let q = 1.0 + square;
                longest.min(PI / 2.0 * q.sqrt() / primitive.width) / (q * q)
            }
        };
        sum += primitive.height.abs() * longest * line;
    }
    sum
}

/// Returns the largest coordinate of a skeleton.
pub fn extent(skeleton: &Skeleton) -> f64 {
    match *skeleton {
        Skeleton::Arc { center, radius, .. } => center.length() + radius,
        ref other => {
            let places = other.landmarks();
            places.iter().fold(0.0, |l, (p, _)| p.length().max(l))
        }
    }
}

/// Evaluates a primitive in two forms, which must have the same bits.
pub(crate) fn evaluate_alike(
    forms: [Evaluation<'_>; 2],
    primitive: &Primitive,
    point: DVec3,
) -> (f64, DVec3) {
    let [one, other] = forms.map(|form| form(primitive, point));
    assert_eq!(
        (one.0.to_bits(), one.1),
        (other.0.to_bits(), other.1),
        "{primitive:?} at {point:?}"
    );
    one
}

/// Checks that a value is within a tolerance of the wanted one.
pub(crate) fn assert_near(
    value: f64,
    want: f64,
    tolerance: f64,
    primitive: &Primitive,
    point: DVec3,
) {
    let off = (value - want).abs();
    assert!(
        off <= tolerance,
        "{value:e} instead of {want:e} (off by {off:e}, at most {tolerance:e}): \
         {primitive:?} at {point:?}"
    );
}

/// Returns the largest distance between a primitive and its interpolant on a span.
pub fn span_error(primitive: &Primitive, start: DVec3, direction: DVec3, h: f64) -> f64 {
    let [(a, da), (b, db)] = [0.0, h].map(|t| primitive.along_ray(start, direction, t));
    let mut worst = 0.0_f64;
    for i in 1..16 {
        let t = f64::from(i) / 16.0;
        let (u, v) = (1.0 - t, t);
        let cubic = a * u * u * (1.0 + 2.0 * t)
            + b * v * v * (3.0 - 2.0 * t)
            + h * (da * u * u * t - db * v * v * u);
        let (value, _) = primitive.along_ray(start, direction, h * t);
        worst = worst.max((cubic - value).abs());
    }
    worst
}

/// Returns the largest field that a primitive can have; at a radius (of a taper's thin end) from
/// poles.
pub fn peak(primitive: &Primitive) -> f64 {
    let from = if primitive.kernel.has_pole() {
        1.0 / primitive.width
    } else {
        0.0
    };
    primitive.most_beyond(from)
}
