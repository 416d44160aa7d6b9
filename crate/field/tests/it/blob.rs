//! Blobs along rays: values are the field's, and bounds hold.

use field::{Blob, Evaluate, Kernel, Limits, Primitive, Profile, Real, Skeleton, Wave};
use glam::DVec3;
use oracle::evaluation::primitive;
use trials::{Random, count};
use wide::f32x8;

const KERNELS: [Kernel; 5] = [
    Kernel::Gauss,
    Kernel::Metaballs,
    Kernel::Soft,
    Kernel::Quartic,
    Kernel::Compact6,
];

/// Blobs of each kind, with a ray that may run through the middle, along the segment, or far away.
fn cases() -> Vec<(Primitive, DVec3, DVec3)> {
    let mut random = Random::new(51);
    let mut cases = Vec::new();
    for i in 0..count(400) {
        let kernel = if i % 2 == 0 {
            Kernel::Gauss
        } else {
            random.pick(&KERNELS)
        };
        let size = random.decades(-2.0, 1.0);
        let base = random.vector(size);
        let along = random.direction();
        let skeleton = if kernel == Kernel::Gauss && i % 4 == 0 {
            let apex = base + along * size * random.range(1.0, 30.0);
            Skeleton::Segment { base, apex }
        } else {
            Skeleton::Point { center: base }
        };
        let shaping = field::Shaping {
            kernel,
            ..random.shaping(size)
        };
        let ramp = Profile {
            waves: [Wave::X, Wave::One],
            scale: [random.pick(&[1.0, 0.6, 3.0]), 1.0],
            bounds: [random.range(0.0, 3.0), random.range(0.0, 3.0)],
            ..Profile::default()
        };
        let profile = (i % 8 == 0).then_some(ramp);
        let primitive = primitive(skeleton, &shaping, profile);
        if primitive.blob::<f64>().is_none() {
            continue;
        }
        let aside = random.vector(2.0 * size) * random.pick(&[0.0, 1e-7, 0.3, 1.0]);
        let other = random.direction();
        let direction = random.pick(&[along, other]);
        let origin = primitive.blob_middle() + aside - direction * size * random.range(0.0, 20.0);
        cases.push((primitive, origin, direction));
    }
    cases
}

fn on_ray<R: Real<Scalar: Evaluate>>(
    primitive: &Primitive,
    origin: DVec3,
    direction: DVec3,
) -> field::BlobOnRay<R> {
    let blob: Blob<R::Scalar> = primitive.blob().expect("a blob");
    let middle = (primitive.blob_middle() - origin).to_array().map(R::splat);
    blob.on_ray(middle, direction.to_array().map(R::splat))
}

/// Value and slope are those of the primitive, exactly in double and nearly in single precision.
#[test]
fn a_blob_on_a_ray_is_the_field() {
    let cases = cases();
    assert!(cases.len() > count(200), "{}", cases.len());
    for (primitive, origin, direction) in cases {
        let exact = on_ray::<f64>(&primitive, origin, direction);
        let shipped = on_ray::<f32x8>(&primitive, origin, direction);
        for i in 0..60 {
            let t = f64::from(i) * 0.4 / primitive.width;
            let jet = primitive.jet((origin + direction * t).to_array());
            let slope = DVec3::from_array(jet.gradient).dot(direction);
            let steep = 1.0 + 2.0 * primitive.width;
            let (value, change) = exact.at(t);
            let size = 1.0 + jet.value.abs();
            assert!(
                (value - jet.value).abs() < 1e-7 * size,
                "{primitive:?} {t}: {value} {jet:?}"
            );
            assert!(
                (change - slope).abs() < 1e-6 * size * steep,
                "{primitive:?} {t}: {change} {slope}"
            );
            let (value, change) = shipped.at(f32x8::splat(t as f32));
            assert!(
                (value.lane(3) - jet.value).abs() < 3e-4 * size,
                "{primitive:?} {t}: {} {jet:?}",
                value.lane(3)
            );
            assert!(
                (change.lane(3) - slope).abs() < 3e-3 * size * steep,
                "{primitive:?} {t}"
            );
            let blob: Blob<f64> = primitive.blob().expect("a blob");
            let own = blob.jet((origin + direction * t - primitive.blob_middle()).to_array());
            assert!(
                (own.value - jet.value).abs() < 1e-12 * size,
                "{primitive:?} {t}"
            );
            for (a, b) in own.gradient.into_iter().zip(jet.gradient) {
                assert!((a - b).abs() < 1e-11 * size * steep, "{primitive:?} {t}");
            }
        }
    }
}

/// The ceiling bounds the field at every distance from the bone, and is tight near the bone's
/// middle.
#[test]
fn ceilings_hold() {
    let mut random = Random::new(53);
    let mut tight = 0;
    for (primitive, _, _) in cases() {
        let blob: Blob<f64> = primitive.blob().expect("a blob");
        let (ceiling, half) = (blob.ceiling(), blob.half());
        let middle = primitive.blob_middle();
        let [a, b] = [middle - half, middle + half];
        for _ in 0..40 {
            let along = random.range(-1.2, 1.2);
            let point = middle
                + half * along
                + random.direction() * random.decades(-3.0, 0.7) / primitive.width;
            // The nearest place of the bone.
            let share = if half == DVec3::ZERO {
                0.0
            } else {
                ((point - middle).dot(half) / half.length_squared()).clamp(-1.0, 1.0)
            };
            let distance = point.distance(middle + half * share);
            assert!(distance <= point.distance(a).min(point.distance(b)) * (1.0 + 1e-9));
            let (value, most) = (primitive.value(point.to_array()), ceiling.at(distance));
            assert!(
                value <= most * (1.0 + 1e-9) + 1e-12,
                "{primitive:?} {point}: {value} {most}"
            );
            tight += usize::from(value > 0.9 * most && value > 1e-6);
        }
    }
    assert!(tight > count(1000), "{tight}");
}

/// Bounds on values and second derivatives hold on random intervals; where `rises_until` is true
/// the end is largest.
#[test]
fn bounds_on_pieces_hold() {
    let mut random = Random::new(52);
    let mut tight = 0;
    for (primitive, origin, direction) in cases() {
        let on_ray = on_ray::<f64>(&primitive, origin, direction);
        for _ in 0..20 {
            let from = random.range(0.0, 20.0) / primitive.width;
            let to = from + random.decades(-3.0, 1.0) / primitive.width;
            let Limits { most, bend, kink } = on_ray.most(from, to);
            let (mut largest, mut bent) = (0.0f64, 0.0f64);
            let step = (to - from) / 40.0;
            let at = |i: u32| from + step * f64::from(i);
            for i in 0..=40 {
                largest = largest.max(on_ray.at(at(i)).0);
                if i > 0 && step * primitive.width > 1e-3 {
                    bent = bent.max((on_ray.at(at(i - 1)).1 - on_ray.at(at(i)).1) / step);
                }
            }
            let room = 1e-9 * (1.0 + largest);
            assert!(
                largest <= most + room,
                "{primitive:?} {from} {to}: {largest} {most}"
            );
            let steep = primitive.width * primitive.width;
            let most_bent = bend * (1.0 + 1e-6) + 1e-6 * steep + kink / step;
            assert!(
                bent <= most_bent,
                "{primitive:?} {from} {to}: {bent} {bend} {kink}"
            );
            tight += usize::from(most <= largest * 1.001 + 1e-12);
            let (value, slope, here) = on_ray.bent(to);
            let (same, change) = on_ray.at(to);
            assert!(value == same && (slope - change).abs() <= 1e-12 * (1.0 + change.abs()));
            if on_ray.rises_until(to) {
                assert!((value - most).abs() <= room && (here - bend).abs() <= 1e-9 * (1.0 + bend));
            }
        }
    }
    assert!(tight > count(2000), "{tight}");
}

/// Bounds hold in single precision, too, and those of points exceed double precision's by at most 7
/// %.
#[test]
fn bounds_in_single_precision_hold() {
    let mut random = Random::new(55);
    let (mut loose, mut rising) = (0, 0);
    for (primitive, origin, direction) in cases() {
        let exact = on_ray::<f64>(&primitive, origin, direction);
        let shipped = on_ray::<f32x8>(&primitive, origin, direction);
        let ceiling = primitive.blob::<f32>().expect("a blob").ceiling();
        let within: [f64; 8] = core::array::from_fn(|_| random.range(0.0, 6.0) / primitive.width);
        let lanes = |x: f64| f32x8::splat(x as f32);
        let [peak, scale, compact] = [ceiling.peak, ceiling.scale, ceiling.compact].map(lanes);
        let most = field::Ceiling {
            peak,
            scale,
            compact,
        }
        .at(f32x8::from_lanes(|i| within[i]));
        for (i, distance) in within.into_iter().enumerate() {
            let (most, want) = (most.lane(i), ceiling.at(distance));
            // Bounds are at least 2·10⁻³⁸ of the peak.
            let room = 1e-5 * want + 1e-6 * (ceiling.compact + 1e-30) * ceiling.peak;
            assert!(
                most >= want - room && most <= 1.07 * want + room,
                "{primitive:?} {distance}: {most} {want}"
            );
        }
        let from: [f64; 8] = core::array::from_fn(|_| random.range(0.0, 20.0) / primitive.width);
        let to = from.map(|from| from + random.decades(-3.0, 1.0) / primitive.width);
        let ends = [from, to].map(|ends| f32x8::from_lanes(|i| ends[i]));
        let limits = shipped.most(ends[0], ends[1]);
        for i in 0..8 {
            let [from, to] = ends.map(|ends| ends.lane(i));
            let [most, bend, kink] = [limits.most, limits.bend, limits.kink].map(|x| x.lane(i));
            let step = (to - from) / 40.0;
            let at = |i: u32| exact.at(from + step * f64::from(i));
            let largest = (0..=40).map(|i| at(i).0).fold(0.0, f64::max);
            let room = 3e-4 * (1.0 + largest);
            assert!(
                largest <= most + room,
                "{primitive:?} {from} {to}: {largest} {most}"
            );
            if step * primitive.width > 1e-3 {
                let bent = (0..40)
                    .map(|i| (at(i).1 - at(i + 1).1) / step)
                    .fold(0.0, f64::max);
                let room = 3e-3 * (bend + primitive.width * primitive.width);
                assert!(
                    bent <= bend + kink / step + room,
                    "{primitive:?} {from} {to}: {bent} {bend} {kink}"
                );
            }
            if matches!(primitive.skeleton, Skeleton::Segment { .. }) {
                continue;
            }
            let want = exact.most(from, to);
            let steep = primitive.width * primitive.width;
            assert!(
                most <= 1.07 * want.most + 1e-4 && bend <= 1.07 * want.bend + 1e-3 * steep,
                "{primitive:?}: {limits:?} {want:?}"
            );
            loose += usize::from(most > 1.03 * want.most + 1e-5);
        }
        if shipped.rises_until(ends[1]) {
            // `bent`, its substitute there, is as tight.
            let (value, _, here) = shipped.bent(ends[1]);
            for i in 0..8 {
                let (value, here) = (value.lane(i), here.lane(i));
                assert!(value <= limits.most.lane(i) && here <= limits.bend.lane(i));
                rising += 1;
            }
        }
    }
    assert!(
        loose > count(100) && rising > count(100),
        "{loose} {rising}"
    );
}

/// A field's slope along a ray falls by at most `Limits::kink` at the end of a ramp, and does not
/// fall at its start.
#[test]
fn kinks_of_ramps_are_bounded() {
    let mut random = Random::new(54);
    let mut falls = 0;
    for (primitive, ..) in cases() {
        let blob: Blob<f64> = primitive.blob().expect("a blob");
        let half = blob.half();
        if primitive.profile.is_none() {
            continue;
        }
        for end in [-1.0, 1.0] {
            let direction = random.direction();
            let aside = random.vector(1.0 / primitive.width);
            // The ray passes the plane at the end of the segment here.
            let place = primitive.blob_middle()
                + half * end
                + (aside - half.normalize() * aside.dot(half.normalize()));
            let away = 3.0 / primitive.width;
            let on_ray = on_ray::<f64>(&primitive, place - direction * away, direction);
            let near = 1e-6 / primitive.width;
            let Limits { bend, kink, .. } = on_ray.most(away - near, away + near);
            let fall = on_ray.at(away - near).1 - on_ray.at(away + near).1;
            assert!(
                fall <= kink + 2.0 * near * bend + 1e-12 * primitive.width,
                "{primitive:?}: {fall} {kink}"
            );
            falls += usize::from(kink > 1e-6 * primitive.width && fall > 0.4 * kink);
        }
    }
    assert!(falls > count(10), "{falls}");
}

/// Primitives that overflow single precision, subtract, or have another kernel are no blobs.
#[test]
fn unsuitable_primitives_are_no_blobs() {
    let blob = |blobbiness: f64, strength: f64, kernel: Kernel| {
        let shaping = field::Shaping {
            kernel,
            strength,
            ..trials::skeletons::shaping(1.0, blobbiness)
        };
        primitive(
            Skeleton::Point {
                center: DVec3::ZERO,
            },
            &shaping,
            None,
        )
        .blob::<f32>()
    };
    assert!(blob(4.0, 1.0, Kernel::Gauss).is_some());
    assert!(blob(100.0, 1.0, Kernel::Gauss).is_none());
    assert!(blob(4.0, -1.0, Kernel::Gauss).is_none());
    assert!(blob(4.0, 1.0, Kernel::Cauchy).is_none());
}

/// A blob's field is below the level beyond its reach and outside the interval of `within`.
#[test]
fn fields_are_small_beyond_the_reach() {
    let mut random = Random::new(53);
    for (primitive, origin, direction) in cases() {
        let blob: Blob<f64> = primitive.blob().expect("a blob");
        let level = random.decades(-7.0, -2.0);
        let square = blob.reach(level);
        let [near, far] = on_ray::<f64>(&primitive, origin, direction).within(square);
        for i in 0..200 {
            let t = f64::from(i) * 0.2 / primitive.width;
            let point = origin + direction * t;
            let value = primitive.value(point.to_array());
            if near > far || t < near || t > far {
                assert!(
                    value <= level * (1.0 + 1e-6) + 1e-12,
                    "{primitive:?} {t} {near} {far}: {value} {level}"
                );
            }
            if value > level {
                let distance = point.distance(primitive.blob_middle());
                assert!(distance <= blob.radius(square) * (1.0 + 1e-9));
            }
        }
    }
}
