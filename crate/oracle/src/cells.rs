//! Checks of a cell of the chart, a kernel on a kind of skeleton: against adaptive quadrature,
//! against differences, and against the laws that convolution obeys.
//!
//! Each panics where a cell, as it is evaluated, does not hold.

use crate::evaluation::{
    Evaluation, assert_near, evaluate_alike, extent, jet, peak, primitive, sensitivity, single,
};
use crate::quadrature;
use core::f64::consts::TAU;
use field::kernel::Tail;
use field::{Kernel, Shaping, Skeleton};
use glam::{DQuat, DVec3};
use trials::skeletons::{Kind, degenerate, halves, move_by, shaping};
use trials::{Random, count};

const EPSILON32: f64 = f32::EPSILON as f64 / 2.0;

/// Accuracy of cells: errors are at most `relative·|f| + floor·(the largest field it can have)`.
#[derive(Clone, Copy)]
struct Accuracy {
    relative: f64,
    floor: f64,
}

/// Accuracy of double precision against quadrature, in every cell.
const DOUBLE: Accuracy = Accuracy {
    relative: 1e-9,
    floor: 1e-13,
};

/// Accuracy of single precision against double, in every cell.
const SINGLE: Accuracy = Accuracy {
    relative: 1e-5,
    floor: 2e-6,
};

/// Returns a random shaping of radius 1 with a kernel.
fn shape(random: &mut Random, kernel: Kernel) -> Shaping {
    Shaping {
        kernel,
        ..random.shaping(1.0)
    }
}

/// Returns a random skeleton for a kernel, of these decades of its radius (1).
fn skeleton(random: &mut Random, kind: Kind, low: f64, high: f64) -> Skeleton {
    let size = random.decades(low, high);
    random.skeleton(kind, size)
}

/// Checks that values are those of quadrature, to 10⁻⁹.
pub fn matches_quadrature(kernel: Kernel, kind: Kind, evaluate: Evaluation<'_>) {
    let mut random = Random::new(101);
    let cases = match kind {
        Kind::Triangle => 120,
        Kind::Polygon => 40,
        _ => 250,
    };
    for _ in 0..count(cases) {
        let skeleton = skeleton(&mut random, kind, -2.0, 1.2);
        let shaping = shape(&mut random, kernel);
        let primitive = primitive(skeleton.clone(), &shaping, None);
        let far = random.pick(&[0.3, 0.3, 2.0]);
        let point = random.near(&skeleton, -4.0, far);
        let want = quadrature::value(&primitive, point);
        let (value, gradient) = evaluate(&primitive, point);
        let Accuracy { relative, floor } = DOUBLE;
        let tolerance = relative * want.abs()
            + floor * peak(&primitive)
            + 64.0 * f64::EPSILON * sensitivity(&primitive, point);
        assert_near(value, want, tolerance, &primitive, point);
        assert!(gradient.is_finite(), "{primitive:?} at {point:?}");
    }
}

/// Checks that two forms in single precision have the same bits, and are `field`'s double form to
/// 10⁻⁵.
pub fn single_matches_double(kernel: Kernel, kind: Kind, forms: [Evaluation<'_>; 2]) {
    let mut random = Random::new(102);
    for _ in 0..count(2_000) {
        let skeleton = skeleton(&mut random, kind, -2.0, 1.0);
        let shaping = shape(&mut random, kernel);
        let primitive = primitive(skeleton.clone(), &shaping, None);
        let point = single(random.near(&skeleton, -3.0, 1.0));
        let (want, want_gradient) = jet::<f64>(&primitive, point);
        let (value, gradient) = evaluate_alike(forms, &primitive, point);
        let Accuracy {
            mut relative,
            floor,
        } = SINGLE;
        if kernel == Kernel::Cubed && kind == Kind::Curve && skeleton.distance(point) < 1e-3 {
            // A curve's spans are rounded where they meet (tests/it/taper.rs): next to the pole
            // such gaps count.
            relative = 1e-3;
        }
        let slack = 64.0 * EPSILON32 * sensitivity(&primitive, point);
        let tolerance = relative * want.abs() + floor * peak(&primitive) + slack;
        assert_near(value, want, tolerance, &primitive, point);
        // Near poles slopes are steep, and as exact as their size allows.
        let near = (primitive.width * skeleton.distance(point)).max(1e-3);
        let slopes = primitive.width * (1.0 + 1.0 / near);
        let mut tolerance = 30.0 * (tolerance * slopes + relative * want_gradient.length());
        if kernel.has_pole() {
            // A rounding of the coordinates changes a slope by as much of it as it changes the
            // distance from the pole; within a rounding of a pole the slope has no meaning.
            let rounding = 8.0 * EPSILON32 * (point.length() + extent(&skeleton));
            let distance = skeleton.distance(point);
            if distance <= rounding {
                continue;
            }
            let steepest = want_gradient.length() + peak(&primitive) * primitive.width;
            tolerance += 3.0 * steepest * rounding / distance;
        }
        let error = (gradient - want_gradient).length();
        assert!(
            error <= tolerance,
            "{gradient} instead of {want_gradient} \
             (off by {error:e}, at most {tolerance:e}): {primitive:?} at {point:?}"
        );
    }
}

/// Checks that gradients are differences of values.
pub fn gradient_is_the_derivative(kernel: Kernel, kind: Kind, evaluate: Evaluation<'_>) {
    let mut random = Random::new(103);
    for _ in 0..count(600) {
        let skeleton = skeleton(&mut random, kind, -2.0, 1.0);
        let shaping = shape(&mut random, kernel);
        let primitive = primitive(skeleton.clone(), &shaping, None);
        let point = random.near(&skeleton, -2.0, 0.5);
        let u = primitive.width * skeleton.distance(point);
        // A difference is worth nothing across a kink, or next to a pole.
        if kernel.has_pole() && u < 0.05 || kernel == Kernel::Metaballs && u < 0.01 {
            continue;
        }
        let (_, gradient) = evaluate(&primitive, point);
        let h = 1e-5 / primitive.width;
        for axis in 0..3 {
            let [ahead, back] = [h, -h].map(|by| {
                let mut p = point;
                p[axis] += by;
                evaluate(&primitive, p).0
            });
            let difference = (ahead - back) / (2.0 * h);
            let tolerance =
                2e-4 * primitive.width * peak(&primitive).max(gradient.length() / primitive.width);
            assert!(
                (gradient[axis] - difference).abs() <= tolerance,
                "axis {axis}: {} instead of {difference}, \
                 at most {tolerance:e} off: {primitive:?} at {point:?}",
                gradient[axis]
            );
        }
    }
}

/// Checks that a skeleton cut in two has the field of the whole.
pub fn superposition(kernel: Kernel, kind: Kind, evaluate: Evaluation<'_>) {
    let mut random = Random::new(104);
    for _ in 0..count(300) {
        let skeleton = skeleton(&mut random, kind, -1.0, 0.7);
        let at = random.range(0.1, 0.9);
        let Some(parts) = halves(&skeleton, at) else {
            continue;
        };
        let shaping = shape(&mut random, kernel);
        let whole = primitive(skeleton.clone(), &shaping, None);
        let parts = parts.map(|part| primitive(part, &shaping, None));
        let point = random.near(&skeleton, -2.0, 0.5);
        let (value, gradient) = evaluate(&whole, point);
        let (mut sum, mut slopes) = (0.0, DVec3::ZERO);
        for part in &parts {
            let (value, gradient) = evaluate(part, point);
            sum += value;
            slopes += gradient;
        }
        let Accuracy { relative, floor } = DOUBLE;
        let tolerance = 2.0 * relative * value.abs() + 4.0 * floor * peak(&whole);
        assert!(
            (sum - value).abs() <= tolerance,
            "{sum:e} instead of {value:e}: {whole:?} at {point:?}"
        );
        let near = (whole.width * skeleton.distance(point)).max(1e-4);
        let tolerance = 1e3 * (tolerance * whole.width / near + relative * gradient.length());
        assert!(
            (slopes - gradient).length() <= tolerance,
            "{slopes} instead of {gradient}: {whole:?} at {point:?}"
        );
    }
}

/// Checks that a field that is moved, turned and scaled with its surroundings stays the same.
pub fn rigid_motion_and_scale(kernel: Kernel, kind: Kind, evaluate: Evaluation<'_>) {
    let mut random = Random::new(105);
    for _ in 0..count(200) {
        let skeleton = skeleton(&mut random, kind, -1.0, 0.7);
        let shaping = shape(&mut random, kernel);
        let turn = DQuat::from_axis_angle(random.direction(), random.range(0.0, TAU));
        let shift = random.vector(3.0);
        let scale = random.decades(-1.0, 1.0);
        let point = random.near(&skeleton, -2.0, 0.5);
        let here = primitive(skeleton.clone(), &shaping, None);
        let place = turn * point * scale + shift;
        let there = Shaping {
            radius: shaping.radius * scale,
            ..shaping
        };
        let there = primitive(move_by(&skeleton, turn, scale, shift), &there, None);
        let (value, gradient) = evaluate(&here, point);
        let (after, slopes) = evaluate(&there, place);
        let Accuracy { relative, floor } = DOUBLE;
        let tolerance = 2.0 * relative * value.abs()
            + 4.0 * floor * peak(&here)
            + 64.0 * f64::EPSILON * (sensitivity(&here, point) + sensitivity(&there, place));
        assert!(
            (after - value).abs() <= tolerance,
            "{after:e} instead of {value:e}: {here:?} at {point:?}"
        );
        let near = (here.width * skeleton.distance(point)).max(1e-4);
        let tolerance = 1e3 * (tolerance * here.width / near + relative * gradient.length());
        let error = (slopes * scale - turn * gradient).length();
        assert!(
            error <= tolerance,
            "{slopes} instead of {gradient}, {error:e} > {tolerance:e}: {here:?} at {point:?}"
        );
    }
}

/// Checks that straight away from the skeleton the field falls, stays within its bound, and is
/// exactly 0 beyond a compact kernel's support. `epsilon` is the rounding of the evaluation's
/// numbers.
pub fn falls_to_nothing(kernel: Kernel, kind: Kind, evaluate: Evaluation<'_>, epsilon: f64) {
    let mut random = Random::new(106);
    for _ in 0..count(100) {
        let skeleton = skeleton(&mut random, kind, -1.5, 0.7);
        let shaping = Shaping {
            kernel,
            ..shaping(1.0, random.decades(-1.0, 1.0))
        };
        let primitive = primitive(skeleton.clone(), &shaping, None);
        let place = random.near(&skeleton, -1.0, 0.5);
        let nearest = skeleton.nearest(place);
        let Some(outward) = (place - nearest).try_normalize() else {
            continue;
        };
        for i in 1..40 {
            let distance = 0.1 * f64::from(i) / primitive.width;
            let point = nearest + outward * distance;
            let value = evaluate(&primitive, point).0;
            let distance = skeleton.distance(point);
            // The field where the rounded point is, which near a pole is another.
            let slack = 1e-5 * peak(&primitive) + 64.0 * epsilon * sensitivity(&primitive, point);
            assert!(
                value >= -slack,
                "{value} at {distance}: {primitive:?} at {point:?}"
            );
            let bound = primitive.most_beyond(distance);
            assert!(
                value <= bound * (1.0 + 1e-6) + slack,
                "{value} > {bound} at {distance}: {primitive:?} at {point:?}"
            );
            if kernel.is_compact() && distance * primitive.width > 1.0 + 1e-6 {
                assert_eq!(value, 0.0, "at {distance}: {primitive:?} at {point:?}");
            }
        }
        // Far along the way out of a ball around everything it falls with every step.
        let Some((center, radius)) = skeleton.bounding_sphere() else {
            continue;
        };
        let mut before = f64::INFINITY;
        for i in 1..20 {
            let point = center + outward * (radius * 1.01 + 0.2 * f64::from(i) / primitive.width);
            let value = evaluate(&primitive, point).0;
            let slack = 1e-6 * peak(&primitive);
            assert!(
                value <= before + slack,
                "{value} after {before}: {primitive:?} at {point:?}"
            );
            before = value;
        }
    }
}

/// Checks that at degenerate bones and places, and a few units in the last place beside them,
/// values in double and in single precision are finite and continuous.
pub fn degenerate_geometry(kernel: Kernel, kind: Kind, [evaluate, eight]: [Evaluation<'_>; 2]) {
    let shaping = Shaping {
        kernel,
        ..shaping(1.0, 1.0)
    };
    let mut points = vec![];
    for x in [0.0, 1.0, -1.0, 2.0, 0.5, 1e6] {
        for y in [0.0, 1.0, 0.5, -1.0] {
            for z in [0.0, 1.0, 1e-8, 1e-300, -1e6] {
                points.push(DVec3::new(x, y, z));
            }
        }
    }
    for skeleton in degenerate(kind) {
        let primitive = primitive(skeleton.clone(), &shaping, None);
        for &point in &points {
            let beside = DVec3::new(point.x.next_up(), point.y.next_down(), point.z.next_up());
            let (value, gradient) = evaluate(&primitive, point);
            let (other, slopes) = evaluate(&primitive, beside);
            assert!(
                value.is_finite() && gradient.is_finite(),
                "{skeleton:?} at {point:?}: {value} {gradient}"
            );
            assert!(
                other.is_finite() && slopes.is_finite(),
                "{skeleton:?} at {beside:?}: {other} {slopes}"
            );
            let peak = peak(&primitive).max(value.abs());
            // The width of a needle, or of nothing, is uncertain by its length.
            let needle = 64.0 * sensitivity(&primitive, point);
            assert!(
                (value - other).abs() <= 1e-7 * peak + needle * f64::EPSILON,
                "{value} {other}: {skeleton:?} at {point:?}"
            );
            let narrow = point.to_array().map(|x| f64::from(x as f32));
            let wide = narrow.map(|x| f64::from((x as f32).next_up()));
            for p in [narrow, wide].map(DVec3::from_array) {
                let (value8, gradient8) = eight(&primitive, p);
                assert!(
                    value8.is_finite() && gradient8.is_finite(),
                    "{skeleton:?} at {p:?}: {value8} {gradient8}"
                );
                let (want, want_gradient) = evaluate(&primitive, p);
                // Values below single precision's smallest number become 0: a bone 1e-300 long.
                let slack = 64.0 * EPSILON32 * (want_gradient.length() + peak)
                    + f64::from(f32::MIN_POSITIVE) * primitive.height.abs().max(1.0);
                // The same exception is in `single_matches_double`.
                let on_pole = kernel == Kernel::Cubed && kind == Kind::Curve;
                let relative = if on_pole { 1e-3 } else { 1e-4 };
                assert!(
                    (value8 - want).abs() <= relative * peak + needle * EPSILON32 + slack,
                    "{value8} instead of {want}: {skeleton:?} at {p:?}"
                );
            }
        }
    }
}

/// Checks that a point, a plane and a line that is as good as infinite have F = T at a radius from
/// them, and for compact kernels nothing at the depth of influence.
pub fn radius_in_isolation(kernel: Kernel, kind: Kind, evaluate: Evaluation<'_>) {
    let mut random = Random::new(107);
    for _ in 0..count(40) {
        let radius = random.decades(-1.0, 1.0);
        let shaping = Shaping {
            radius,
            kernel,
            ..shaping(1.0, random.decades(-1.0, 1.0))
        };
        // A line of ten radii either way stands for an infinite one of the inverse kernel.
        let reach = if kernel.is_finite_over(1) { 1e5 } else { 10.0 };
        let skeleton = match kind {
            Kind::Point => Skeleton::Point {
                center: DVec3::ZERO,
            },
            Kind::Plane => Skeleton::Plane {
                point: DVec3::ZERO,
                normal: DVec3::Y,
            },
            Kind::Segment => Skeleton::Segment {
                base: DVec3::X * (reach * radius),
                apex: DVec3::NEG_X * (reach * radius),
            },
            _ => continue,
        };
        let primitive = primitive(skeleton, &shaping, None);
        let (value, _) = evaluate(&primitive, DVec3::Y * radius);
        // The rest of a line falls off like its length to the power 1 less the exponent.
        let tolerance = if matches!(kernel.tail(), Tail::Power { exponent: 2, .. }) {
            1e-4
        } else {
            1e-9
        };
        assert!((value - 1.0).abs() < tolerance, "{value}: {primitive:?}");
        if kind == Kind::Point {
            // The radius that follows from a depth of influence is the one that has it.
            let depth = if kernel.is_compact() {
                1.0 / primitive.width
            } else {
                primitive.influence
            };
            let found = shaping.radius_of_depth(depth, 0).expect("a radius");
            assert!(
                (found - radius).abs() < 1e-6 * radius,
                "{found} instead of {radius}: {primitive:?}"
            );
        }
    }
}
