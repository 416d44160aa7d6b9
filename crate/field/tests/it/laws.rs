//! Laws of convolution surfaces: the radius as asked, no bulges at joints, invariance under rigid
//! motions, strengths and profiles that multiply.

use core::f64::consts::TAU;
use field::{BlobScale, Kernel, Primitive, Profile, Shaping, Skeleton, Sum, THRESHOLD, Wave};
use glam::{DQuat, DVec3};
use oracle::evaluation::{jet, primitive, sensitivity, single};
use oracle::quadrature;
use trials::skeletons::{KINDS, Kind, halves, move_by, shaping};
use trials::{Random, count};
use wide::f32x8;

const WAVES: [Wave; 9] = [
    Wave::One,
    Wave::X,
    Wave::Sin,
    Wave::Cos,
    Wave::Sin2,
    Wave::Cos2,
    Wave::Saw,
    Wave::Hat,
    Wave::Step,
];

/// Cutting a bone in two changes nothing: neither value nor gradient.
#[test]
fn superposition() {
    for kind in [Kind::Segment, Kind::Arc, Kind::Triangle] {
        let mut random = Random::new(11);
        for _ in 0..count(2_000) {
            let size = random.decades(-2.0, 1.0);
            let skeleton = random.skeleton(kind, size);
            let shaping = random.shaping(1.0);
            let at = random.unit();
            let Some(parts) = halves(&skeleton, at) else {
                continue;
            };
            let whole = primitive(skeleton.clone(), &shaping, None);
            let sum: Sum = parts
                .into_iter()
                .map(|part| primitive(part, &shaping, None))
                .collect();
            let point = random.near(&skeleton, -3.0, 1.0);
            let (value, gradient) = jet::<f64>(&whole, point);
            let cut = sum.jet(point);
            let scale = value.abs() + sensitivity(&whole, point);
            assert!(
                (cut.value - value).abs() <= 1e-14 * scale,
                "{skeleton:?} at {point:?}"
            );
            let error = (DVec3::from_array(cut.gradient) - gradient).length();
            assert!(
                error <= 1e-13 * whole.width * (1.0 + size) * scale,
                "{error:e} {skeleton:?} at {point:?}"
            );
            let cut = f64::from(sum.sum(point.to_array().map(|x| x as f32)).value);
            assert!(
                (cut - value).abs() <= 5e-6 * scale,
                "{skeleton:?} at {point:?}"
            );
            let weights: f64 = sum.weights(point).iter().sum();
            assert_eq!(weights, sum.jet(point).value);
        }
    }
}

/// Points that a rigid motion takes along see the same field.
#[test]
fn rigid_motion() {
    for kind in KINDS {
        let mut random = Random::new(12);
        for _ in 0..count(500) {
            let skeleton = random.skeleton(kind, 1.0);
            let shaping = random.shaping(0.5);
            let turn = DQuat::from_axis_angle(random.direction(), random.range(0.0, TAU));
            let shift = random.vector(3.0);
            let point = random.near(&skeleton, -2.0, 1.0);
            let here = primitive(skeleton.clone(), &shaping, None);
            let there = primitive(move_by(&skeleton, turn, 1.0, shift), &shaping, None);
            let (value, gradient) = jet::<f64>(&here, point);
            let (other, other_gradient) = jet::<f64>(&there, turn * point + shift);
            let scale = value.abs() + 10.0 * sensitivity(&here, point);
            assert!(
                (value - other).abs() <= 1e-14 * scale,
                "{skeleton:?} at {point:?}"
            );
            assert!(
                (turn * gradient - other_gradient).length() <= 1e-12 * here.width * scale,
                "{skeleton:?} at {point:?}"
            );
        }
    }
}

/// Blinn's radius: alone, a point, a long line and a plane have their surface at R.
#[test]
fn radius_in_isolation() {
    let mut random = Random::new(13);
    for scale in [BlobScale::Relative, BlobScale::Absolute] {
        for _ in 0..count(50) {
            let radius = random.decades(-2.0, 1.0);
            let blobbiness = match scale {
                BlobScale::Relative => random.decades(-1.0, 1.0),
                BlobScale::Absolute => random.decades(-1.0, 1.0) / (radius * radius),
            };
            let shaping = Shaping {
                blob_scale: scale,
                ..shaping(radius, blobbiness)
            };
            let long = 3e3 / shaping.width().unwrap();
            for (skeleton, tolerance) in [
                (
                    Skeleton::Point {
                        center: DVec3::ZERO,
                    },
                    1e-14,
                ),
                (
                    Skeleton::Plane {
                        point: DVec3::ZERO,
                        normal: DVec3::Y,
                    },
                    1e-14,
                ),
                (
                    Skeleton::Segment {
                        base: DVec3::X * -long,
                        apex: DVec3::X * long,
                    },
                    1e-7,
                ),
                (
                    Skeleton::Triangle {
                        corners: [
                            DVec3::new(-3.0, 0.0, -2.0) * long,
                            DVec3::new(3.0, 0.0, -2.0) * long,
                            DVec3::new(0.0, 0.0, 4.0) * long,
                        ],
                    },
                    1e-5,
                ),
            ] {
                let primitive = primitive(skeleton.clone(), &shaping, None);
                let (value, gradient) = jet::<f64>(&primitive, DVec3::Y * radius);
                assert!(
                    (value - THRESHOLD).abs() < tolerance,
                    "{value}: {skeleton:?} {shaping:?}"
                );
                assert!(gradient.y < 0.0);
            }
            // A circle of large radius is a line.
            let ring = Skeleton::Arc {
                center: DVec3::Y * -long,
                u: DVec3::Y,
                v: DVec3::X,
                radius: long,
                angle: TAU,
            };
            let value = jet::<f64>(&primitive(ring, &shaping, None), DVec3::Y * radius).0;
            assert!((value - THRESHOLD).abs() < 1e-2, "{value}");
        }
    }
}

/// The cubed kernel has no width: a point's field is (R/d)³, a long line's (R/d)², a plane's R/d,
/// whatever the blobbiness.
#[test]
fn fields_of_the_cubed_kernel_are_powers_of_the_distance() {
    let mut random = Random::new(18);
    for _ in 0..count(100) {
        let radius = random.decades(-2.0, 1.0);
        let shaping = Shaping {
            kernel: Kernel::Cubed,
            ..shaping(radius, random.decades(-1.0, 1.0))
        };
        let distance = radius * random.decades(-1.0, 1.0);
        let long = 1e6 * radius;
        let line = Skeleton::Segment {
            base: DVec3::X * -long,
            apex: DVec3::X * long,
        };
        let plane = Skeleton::Plane {
            point: DVec3::ZERO,
            normal: DVec3::Y,
        };
        for (skeleton, power) in [
            (
                Skeleton::Point {
                    center: DVec3::ZERO,
                },
                3,
            ),
            (line, 2),
            (plane, 1),
        ] {
            let primitive = primitive(skeleton, &shaping, None);
            let value = jet::<f64>(&primitive, DVec3::Y * distance).0;
            let want = (radius / distance).powi(power);
            // The pole's ε, at a tenth of a radius.
            assert!(
                (value / want - 1.0).abs() < 2e-8,
                "{value} {want} {primitive:?}"
            );
        }
    }
}

#[test]
fn strength_multiplies() {
    for kind in KINDS {
        let mut random = Random::new(14);
        let skeleton = random.skeleton(kind, 1.0);
        let point = random.near(&skeleton, -1.0, 0.0);
        let at = |strength: f64| {
            let shaping = Shaping {
                strength,
                ..shaping(0.5, 1.0)
            };
            jet::<f64>(&primitive(skeleton.clone(), &shaping, None), point)
        };
        let (value, gradient) = at(1.0);
        assert!(value > 0.0);
        assert_eq!(at(-2.0), (-2.0 * value, -2.0 * gradient));
    }
}

/// Shapings without flesh, or with none that can be computed, give no primitive, and no panic.
#[test]
fn refusals() {
    let point = Skeleton::Point {
        center: DVec3::ZERO,
    };
    let good = shaping(1.0, 1.0);
    assert!(Primitive::new(point.clone(), &good, None).is_some());
    for bad in [0.0, f64::NAN, f64::INFINITY, -f64::INFINITY] {
        assert!(
            Primitive::new(
                point.clone(),
                &Shaping {
                    radius: bad,
                    ..good
                },
                None
            )
            .is_none()
        );
        assert!(
            Primitive::new(
                point.clone(),
                &Shaping {
                    blobbiness: bad,
                    ..good
                },
                None
            )
            .is_none()
        );
        assert!(
            Primitive::new(
                point.clone(),
                &Shaping {
                    strength: bad,
                    ..good
                },
                None
            )
            .is_none()
        );
    }
    assert!(
        Primitive::new(
            point.clone(),
            &Shaping {
                radius: -1.0,
                ..good
            },
            None
        )
        .is_none()
    );
    let long = Skeleton::Segment {
        base: DVec3::ZERO,
        apex: DVec3::X * 1e9,
    };
    assert!(Primitive::new(long.clone(), &good, None).is_none());
    let nowhere = Skeleton::Segment {
        base: DVec3::NAN,
        apex: DVec3::X,
    };
    assert!(Primitive::new(nowhere, &good, None).is_none());
    for extreme in [1e-300, 1e300] {
        let _ = Primitive::new(
            point.clone(),
            &Shaping {
                radius: extreme,
                ..good
            },
            None,
        );
        let _ = Primitive::new(
            point.clone(),
            &Shaping {
                blobbiness: extreme,
                ..good
            },
            None,
        );
        let _ = Primitive::new(
            long.clone(),
            &Shaping {
                strength: extreme,
                ..good
            },
            None,
        );
    }
}

/// A profile's factor against its definition, and the product rule against differences.
#[test]
fn profiles() {
    for kind in KINDS {
        let mut random = Random::new(15);
        for _ in 0..count(400) {
            let skeleton = random.skeleton(kind, 1.0);
            if skeleton.measure() < 0.1 {
                continue;
            }
            let profile = Profile {
                waves: [random.pick(&WAVES), random.pick(&WAVES)],
                scale: [random.range(0.5, 25.0), random.range(0.5, 25.0)],
                bounds: [random.range(0.0, 1.0), random.range(0.0, 1.0)],
                times: random.range(0.5, 2.0),
                restriction: random.pick(&[0.0, 0.7]),
            };
            let primitive = primitive(skeleton.clone(), &random.shaping(0.5), Some(profile));
            let point = single(random.near(&skeleton, -2.0, 0.5));
            if let Skeleton::Arc { center, u, v, .. } = skeleton {
                let d = point - center;
                if d.dot(u).abs() + d.dot(v).abs() < 1e-2 {
                    continue; // The angle turns ever faster towards the axis.
                }
            }
            let want = quadrature::value(&primitive, point);
            let (value, gradient) = jet::<f64>(&primitive, point);
            let (single, _) = jet::<f32x8>(&primitive, point);
            // Rounding decides for a side at kinks and jumps (and at the axis of an arc): all that
            // the neighbourhood takes on is right.
            let h = 1e-6;
            let scale = 30.0 * primitive.most_beyond(0.0);
            let around = [DVec3::X, DVec3::Y, DVec3::Z]
                .map(|axis| [-h, h].map(|h| quadrature::value(&primitive, point + axis * h)));
            let lowest = around.iter().flatten().fold(want, |low, x| low.min(*x));
            let highest = around.iter().flatten().fold(want, |high, x| high.max(*x));
            for (value, tolerance) in [(value, 1e-11), (single, 1e-5)] {
                assert!(
                    value > lowest - tolerance * scale && value < highest + tolerance * scale,
                    "{value} is not in {lowest}..{highest}: {primitive:?} at {point:?}"
                );
            }
            let tolerance = 1e-3 * primitive.width * scale;
            for axis in 0..3 {
                let [left, right] = around[axis];
                let (a, b) = ((want - left) / h, (right - want) / h);
                assert!(
                    gradient[axis] > a.min(b) - tolerance && gradient[axis] < a.max(b) + tolerance,
                    "axis {axis}: {} is not in {a}..{b}: {primitive:?} at {point:?}",
                    gradient[axis]
                );
            }
        }
    }
}

/// The seahorse's: `sin one bounds 0.5 0.7 scale 22 22 1 times 1.15`, 3.5 waves along an arc.
#[test]
fn waves_along_an_arc() {
    let profile = Profile {
        waves: [Wave::Sin, Wave::One],
        scale: [22.0, 22.0],
        bounds: [0.5, 0.7],
        times: 1.15,
        restriction: 0.0,
    };
    let arc = Skeleton::Arc {
        center: DVec3::ZERO,
        u: DVec3::X,
        v: DVec3::Y,
        radius: 2.0,
        angle: 3.0,
    };
    let with = primitive(arc.clone(), &shaping(0.3, 1.0), Some(profile));
    let without = primitive(arc.clone(), &shaping(0.3, 1.0), None);
    let factor = |t: f64| {
        let (sine, cosine) = libm::sincos(3.0 * t);
        let p = DVec3::new(2.0 * cosine, 2.0 * sine, 0.2);
        jet::<f64>(&with, p).0 / jet::<f64>(&without, p).0
    };
    // The mean of the waves counts on the axis, where all angles meet.
    let axis = DVec3::new(0.0, 0.0, 0.2);
    let mean = 1.15 * (0.5 + 0.2 * (1.0 + (1.0 - libm::cos(22.0)) / 22.0) / 2.0);
    let on_axis = jet::<f64>(&with, axis).0 / jet::<f64>(&without, axis).0;
    assert!((on_axis - mean).abs() < 1e-9, "{on_axis} is not {mean}");
    for i in 0..=20 {
        let t = f64::from(i) / 20.0;
        let want = 1.15 * (0.5 + 0.2 * (1.0 + libm::sin(22.0 * t)) / 2.0);
        assert!((factor(t) - want).abs() < 1e-9, "{t}");
    }
    // Past the ends, the ends' values, each up to the middle of the gap.
    let gap = (TAU - 3.0) / 3.0;
    for past in [0.1, 0.49] {
        assert!((factor(1.0 + past * gap) - factor(1.0)).abs() < 1e-9);
        assert!((factor(-past * gap) - factor(0.0)).abs() < 1e-9);
    }
}
