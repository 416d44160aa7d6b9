//! Every primitive × every evaluator, against quadrature.

use core::f64::consts::{PI, TAU};
use field::{Evaluate, Kernel, Primitive, Real, Shaping, Skeleton};
use glam::{DQuat, DVec3};
use oracle::evaluation::{extent, jet, primitive, sensitivity, single};
use oracle::quadrature;
use trials::skeletons::{KINDS, Kind, move_by, shaping};
use trials::{Random, count};
use wide::f32x8;

/// Half a unit in the last place of 1.
const EPSILON64: f64 = f64::EPSILON / 2.0;
const EPSILON32: f64 = f32::EPSILON as f64 / 2.0;

/// Single precision: units in the last place by which inputs would have to differ to make results
/// exact. Worst of 2·10⁶ cases a kind: point 8, segment 9, arc 42, triangle 9, plane 4.
fn ulps(kind: Kind) -> f64 {
    match kind {
        Kind::Arc => 64.0,
        _ => 16.0,
    }
}

fn close_to_quadrature<R: Evaluate>(primitive: &Primitive, point: DVec3, relative: f64) {
    let want = quadrature::value(primitive, point);
    let (value, gradient) = jet::<R>(primitive, point);
    let slack = 64.0 * EPSILON64 * sensitivity(primitive, point);
    assert!(
        (value - want).abs() <= relative * want.abs() + slack,
        "{value:e} instead of {want:e}: {primitive:?} at {point:?}"
    );
    assert!(gradient.is_finite(), "{primitive:?} at {point:?}");
}

/// Sizes from a thousandth to 300 kernel widths, distances from 10⁻⁶ to 10⁶.
#[test]
fn double_precision_matches_quadrature() {
    for kind in KINDS {
        let mut random = Random::new(1);
        for _ in 0..count(250) {
            let size = random.decades(-3.0, 2.5);
            let skeleton = random.skeleton(kind, size);
            let shaping = random.shaping(1.0);
            let primitive = primitive(skeleton.clone(), &shaping, None);
            let far = random.pick(&[1.0, 1.0, 6.0]);
            let point = random.near(&skeleton, -6.0, far);
            close_to_quadrature::<f64>(&primitive, point, 1e-11);
        }
    }
}

/// Scenes as people write them: the bound of 10⁻⁵ holds with no allowance.
#[test]
fn single_precision_matches_quadrature() {
    for kind in KINDS {
        let mut random = Random::new(2);
        for _ in 0..count(250) {
            let size = random.decades(-2.0, 0.5);
            let skeleton = random.skeleton(kind, size);
            let radius = random.decades(-0.7, 0.3);
            let shaping = random.shaping(radius);
            let primitive = primitive(skeleton.clone(), &shaping, None);
            let point = single(random.near(&skeleton, -3.0, 0.7));
            let want = quadrature::value(&primitive, point);
            let needle = match skeleton {
                Skeleton::Triangle { .. } => EPSILON32 * sensitivity(&primitive, point),
                _ => 0.0,
            };
            for value in [
                jet::<f32>(&primitive, point).0,
                jet::<f32x8>(&primitive, point).0,
            ] {
                assert!(
                    (value - want).abs() <= 1e-5 * want.abs() + 8.0 * needle,
                    "{value:e} instead of {want:e}: {primitive:?} at {point:?}"
                );
            }
        }
    }
}

/// Single precision agrees with double, in the same formulas, on many more cases than quadrature
/// allows.
#[test]
fn single_precision_is_exact_for_inputs_nearby() {
    for kind in KINDS {
        let mut random = Random::new(3);
        for _ in 0..count(20_000) {
            let size = random.decades(-3.0, 2.5);
            let skeleton = random.skeleton(kind, size);
            let primitive = primitive(skeleton.clone(), &random.shaping(1.0), None);
            let far = random.pick(&[1.0, 1.0, 4.0]);
            let point = single(random.near(&skeleton, -5.0, far));
            let (want, want_gradient) = jet::<f64>(&primitive, point);
            let (value, gradient) = jet::<f32>(&primitive, point);
            let scale = want.abs() + sensitivity(&primitive, point) + 1e-25;
            let error = (value - want).abs() / (EPSILON32 * scale);
            assert!(
                error <= ulps(kind),
                "{error} ulps, {value:e} instead of {want:e}: {primitive:?} at {point:?}"
            );
            // Gradients: the second derivative is at most a few times f/(1+d²) and f/(1+d).
            let s = primitive.width;
            let d = s * skeleton.distance(point);
            let reach = s * (point.length() + extent(&skeleton));
            let scale =
                scale * s * (1.0 / (1.0 + d) + reach / (1.0 + d * d)) + want_gradient.length();
            let error = (gradient - want_gradient).length() / (EPSILON32 * scale);
            // Far outside its depth of influence a triangle's slope across its plane is lost.
            let lost = kind == Kind::Triangle && d > 100.0;
            assert!(
                lost || error <= 4.0 * ulps(kind),
                "{error} ulps, {gradient} instead of {want_gradient}: {primitive:?} at {point:?}"
            );
        }
    }
}

/// Lanes are computed as `f32` is, to the last bit.
#[test]
fn lanes_equal_scalars() {
    for kind in KINDS {
        let mut random = Random::new(4);
        for _ in 0..count(500) {
            let size = random.decades(-2.0, 1.0);
            let skeleton = random.skeleton(kind, size);
            let kernel = random.pick(&Kernel::ALL);
            let shaping = Shaping {
                kernel,
                ..random.shaping(1.0)
            };
            let primitive = primitive(skeleton.clone(), &shaping, None);
            let points: [DVec3; 8] =
                core::array::from_fn(|_| single(random.near(&skeleton, -3.0, 2.0)));
            let lanes = primitive.jet([0, 1, 2].map(|axis| f32x8::from_lanes(|i| points[i][axis])));
            for (i, point) in points.iter().enumerate() {
                let scalar = primitive.jet(point.to_array().map(|x| x as f32));
                let bits = [
                    lanes.value,
                    lanes.gradient[0],
                    lanes.gradient[1],
                    lanes.gradient[2],
                ]
                .map(|x| x.to_array()[i].to_bits());
                let [x, y, z] = scalar.gradient;
                assert_eq!(
                    bits,
                    [scalar.value, x, y, z].map(f32::to_bits),
                    "{primitive:?} at {point:?}"
                );
            }
        }
    }
}

/// Against a five-point difference of the value.
#[test]
fn gradient_is_the_derivative() {
    for kind in KINDS {
        let mut random = Random::new(5);
        for _ in 0..count(1_000) {
            let size = random.decades(-2.0, 1.5);
            let skeleton = random.skeleton(kind, size);
            let primitive = primitive(skeleton.clone(), &random.shaping(1.0), None);
            let point = random.near(&skeleton, -3.0, 1.0);
            let h = 1e-3 / primitive.width;
            let (value, gradient) = jet::<f64>(&primitive, point);
            for axis in 0..3 {
                let at = |step: f64| {
                    let mut p = point;
                    p[axis] += step * h;
                    primitive.value(p.to_array())
                };
                let difference = (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * h);
                let tolerance =
                    1e-9 * primitive.width * (value.abs() + sensitivity(&primitive, point) * 1e-3);
                assert!(
                    (gradient[axis] - difference).abs() <= tolerance,
                    "axis {axis}: {} instead of {difference}, tolerance {tolerance:e}: \
                     {primitive:?} at {point:?}",
                    gradient[axis]
                );
            }
        }
    }
}

/// Exactly degenerate positions and skeletons, and their neighbours a few units in the last
/// place away.
#[test]
fn degenerate_inputs() {
    let arc = |radius: f64, angle: f64| Skeleton::Arc {
        center: DVec3::ZERO,
        u: DVec3::X,
        v: DVec3::Y,
        radius,
        angle,
    };
    let triangle = |b: [f64; 2], c: [f64; 2]| Skeleton::Triangle {
        corners: [
            DVec3::ZERO,
            DVec3::new(b[0], b[1], 0.0),
            DVec3::new(c[0], c[1], 0.0),
        ],
    };
    let segment = |length: f64| Skeleton::Segment {
        base: DVec3::ZERO,
        apex: DVec3::X * length,
    };
    let skeletons = [
        Skeleton::Point {
            center: DVec3::ZERO,
        },
        Skeleton::Plane {
            point: DVec3::ZERO,
            normal: DVec3::Z,
        },
        segment(2.0),
        segment(0.0),
        segment(1e-30),
        segment(1e-9),
        arc(1.0, TAU),
        arc(1.0, PI),
        arc(1.0, TAU.next_down()),
        arc(1.0, PI.next_down()),
        arc(1.0, PI.next_up()),
        arc(1.0, 1e-9),
        arc(1.0, 1e-300),
        arc(1.0, 0.0),
        arc(0.0, 3.0),
        arc(1e-12, TAU),
        arc(1e3, 1e-3),
        triangle([2.0, 0.0], [0.0, 2.0]),
        triangle([2.0, 0.0], [1.0, 0.0]),
        triangle([2.0, 0.0], [1.0, 1e-16]),
        triangle([2.0, 0.0], [2.0, 0.0]),
        triangle([0.0, 0.0], [0.0, 0.0]),
        triangle([1e-9, 0.0], [0.0, 1e-9]),
        triangle([0.0, 1e3], [1e3, 0.0]),
    ];
    let mut points = vec![];
    for x in [0.0, 1.0, -1.0, 2.0, 0.5, -3.0, 1e3, 1e6] {
        for y in [0.0, 1.0, 0.5, -1.0] {
            for z in [0.0, 1.0, 1e-8, -1e6] {
                points.push(DVec3::new(x, y, z));
            }
        }
    }
    for skeleton in skeletons {
        let primitive = primitive(skeleton.clone(), &shaping(1.0, 1.0), None);
        for &point in &points {
            close_to_quadrature::<f64>(&primitive, point, 1e-10);
            let beside = DVec3::new(point.x.next_up(), point.y.next_down(), point.z.next_up());
            close_to_quadrature::<f64>(&primitive, beside, 1e-10);
            let (want, _) = jet::<f64>(&primitive, point);
            let scale = want.abs() + sensitivity(&primitive, point);
            let beside = point.to_array().map(|x| f64::from((x as f32).next_up()));
            for p in [point, DVec3::from_array(beside)] {
                let (value, gradient) = jet::<f32x8>(&primitive, p);
                assert!(gradient.is_finite(), "{skeleton:?} at {p:?}");
                assert!(
                    (value - want).abs() <= 64.0 * EPSILON32 * scale + 1e-30,
                    "{value:e} instead of {want:e}: {skeleton:?} at {p:?}"
                );
            }
        }
    }
}

/// However far, results are numbers.
#[test]
fn nothing_overflows() {
    for kind in KINDS {
        let mut random = Random::new(6);
        for _ in 0..count(2_000) {
            let size = random.decades(-8.0, 5.0);
            let skeleton = random.skeleton(kind, size);
            let primitive = primitive(skeleton.clone(), &random.shaping(1.0), None);
            let point = random.near(&skeleton, -20.0, 30.0);
            for (value, gradient) in [
                jet::<f64>(&primitive, point),
                jet::<f32>(&primitive, point),
                jet::<f32x8>(&primitive, point),
            ] {
                assert!(
                    value.is_finite() && gradient.is_finite(),
                    "{value} {gradient}: {primitive:?} at {point:?}"
                );
            }
        }
    }
}

/// The ray's own evaluation, with origins far from the world's.
#[test]
fn along_ray_is_the_field() {
    for kind in KINDS {
        let mut random = Random::new(7);
        for _ in 0..count(500) {
            let mut skeleton = random.skeleton(kind, 1.0);
            if kind == Kind::Triangle && skeleton.measure() < 0.1 {
                continue; // The shift would change a needle's shape.
            }
            let shift = DVec3::new(1e4, -2e4, 3e4);
            skeleton = move_by(&skeleton, DQuat::IDENTITY, 1.0, shift);
            let primitive = primitive(skeleton.clone(), &random.shaping(0.1), None);
            let origin = shift + random.vector(1.0);
            let direction = random.direction() * random.range(0.5, 2.0);
            let t = f64::from(random.range(-1.0, 1.0) as f32);
            let (want, gradient) = jet::<f64>(&primitive, origin + direction * t);
            let slope = gradient.dot(direction);
            let scale = primitive.width * want.abs();
            let (value, derivative) =
                primitive.along_ray(origin, direction, f32x8::splat(t as f32));
            assert!(
                (value.lane(0) - want).abs() <= 3e-5 * want.abs(),
                "{primitive:?}"
            );
            assert!(
                (derivative.lane(0) - slope).abs() <= 1e-4 * scale,
                "{primitive:?}"
            );
            let (value, derivative) = primitive.along_ray(origin, direction, t);
            assert!((value - want).abs() <= 1e-9 * want.abs(), "{primitive:?}");
            assert!((derivative - slope).abs() <= 1e-9 * scale, "{primitive:?}");
        }
    }
}
