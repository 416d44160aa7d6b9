//! What is promised of lumps: their course along rays is the field's, and its bounds hold.
mod common;

use common::{Random, primitive};
use field::{Kernel, Limits, Lump, Primitive, Profile, Real, Skeleton, Wave};
use glam::DVec3;
use wide::f32x8;

const KERNELS: [Kernel; 5] = [
    Kernel::Gauss,
    Kernel::Metaballs,
    Kernel::Soft,
    Kernel::Quartic,
    Kernel::Compact6,
];

/// Lumps of each kind, with a ray that may run through the middle, along the segment, or far away.
fn cases() -> Vec<(Primitive, DVec3, DVec3)> {
    let mut random = Random::new(51);
    let mut cases = Vec::new();
    for i in 0..400 {
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
        if primitive.lump::<f64>().is_none() {
            continue;
        }
        let aside = random.vector(2.0 * size) * random.pick(&[0.0, 1e-7, 0.3, 1.0]);
        let other = random.direction();
        let direction = random.pick(&[along, other]);
        let origin = primitive.lump_middle() + aside - direction * size * random.range(0.0, 20.0);
        cases.push((primitive, origin, direction));
    }
    cases
}

fn course<R: Real>(primitive: &Primitive, origin: DVec3, direction: DVec3) -> field::Course<R> {
    let lump: Lump<R::Scalar> = primitive.lump().expect("a lump");
    let middle = (primitive.lump_middle() - origin).to_array().map(R::splat);
    lump.course(middle, direction.to_array().map(R::splat))
}

tests! {
    /// Value and slope are those of the primitive, exactly in double and nearly in single precision.
    fn a_course_is_the_field_along_the_ray() {
        let cases = cases();
        assert!(cases.len() > 200, "{}", cases.len());
        for (primitive, origin, direction) in cases {
            let exact = course::<f64>(&primitive, origin, direction);
            let shipped = course::<f32x8>(&primitive, origin, direction);
            for i in 0..60 {
                let t = f64::from(i) * 0.4 / primitive.width;
                let jet = primitive.jet((origin + direction * t).to_array());
                let slope = DVec3::from_array(jet.gradient).dot(direction);
                let steep = 1.0 + 2.0 * primitive.width;
                let (value, change) = exact.at(t);
                let size = 1.0 + jet.value.abs();
                assert!((value - jet.value).abs() < 1e-7 * size, "{primitive:?} {t}: {value} {jet:?}");
                assert!((change - slope).abs() < 1e-6 * size * steep, "{primitive:?} {t}: {change} {slope}");
                let (value, change) = shipped.at(f32x8::splat(t as f32));
                assert!((value.lane(3) - jet.value).abs() < 3e-4 * size, "{primitive:?} {t}: {} {jet:?}", value.lane(3));
                assert!((change.lane(3) - slope).abs() < 3e-3 * size * steep, "{primitive:?} {t}");
                let lump: Lump<f64> = primitive.lump().expect("a lump");
                let own = lump.jet((origin + direction * t - primitive.lump_middle()).to_array());
                assert!((own.value - jet.value).abs() < 1e-12 * size, "{primitive:?} {t}");
                for (a, b) in own.gradient.into_iter().zip(jet.gradient) {
                    assert!((a - b).abs() < 1e-11 * size * steep, "{primitive:?} {t}");
                }
            }
        }
    }

    /// At no distance from the bone is the field larger than its ceiling, and near the middle of the bone it is about that.
    fn ceilings_hold() {
        let mut random = Random::new(53);
        let mut tight = 0;
        for (primitive, _, _) in cases() {
            let lump: Lump<f64> = primitive.lump().expect("a lump");
            let (ceiling, half) = (lump.ceiling(), lump.half());
            let middle = primitive.lump_middle();
            let [a, b] = [middle - half, middle + half];
            for _ in 0..40 {
                let along = random.range(-1.2, 1.2);
                let point = middle + half * along + random.direction() * random.decades(-3.0, 0.7) / primitive.width;
                // The nearest place of the bone.
                let share = if half == DVec3::ZERO { 0.0 } else { ((point - middle).dot(half) / half.length_squared()).clamp(-1.0, 1.0) };
                let distance = point.distance(middle + half * share);
                assert!(distance <= point.distance(a).min(point.distance(b)) * (1.0 + 1e-9));
                let (value, most) = (primitive.value(point.to_array()), ceiling.at(distance));
                assert!(value <= most * (1.0 + 1e-9) + 1e-12, "{primitive:?} {point}: {value} {most}");
                tight += u32::from(value > 0.9 * most && value > 1e-6);
            }
        }
        assert!(tight > 1000, "{tight}");
    }

    /// On any piece nothing is larger, nothing bends down more, and where a course says that it rises the end is the
    /// largest.
    fn bounds_on_pieces_hold() {
        let mut random = Random::new(52);
        let mut tight = 0;
        for (primitive, origin, direction) in cases() {
            let course = course::<f64>(&primitive, origin, direction);
            for _ in 0..20 {
                let from = random.range(0.0, 20.0) / primitive.width;
                let to = from + random.decades(-3.0, 1.0) / primitive.width;
                let Limits { most, bend, kink } = course.most(from, to);
                let (mut largest, mut bent) = (0.0f64, 0.0f64);
                let step = (to - from) / 40.0;
                let at = |i: u32| from + step * f64::from(i);
                for i in 0..=40 {
                    largest = largest.max(course.at(at(i)).0);
                    if i > 0 && step * primitive.width > 1e-3 {
                        bent = bent.max((course.at(at(i - 1)).1 - course.at(at(i)).1) / step);
                    }
                }
                let room = 1e-9 * (1.0 + largest);
                assert!(largest <= most + room, "{primitive:?} {from} {to}: {largest} {most}");
                let steep = primitive.width * primitive.width;
                let most_bent = bend * (1.0 + 1e-6) + 1e-6 * steep + kink / step;
                assert!(bent <= most_bent, "{primitive:?} {from} {to}: {bent} {bend} {kink}");
                tight += u32::from(most <= largest * 1.001 + 1e-12);
                let (value, slope, here) = course.bent(to);
                let (same, change) = course.at(to);
                assert!(value == same && (slope - change).abs() <= 1e-12 * (1.0 + change.abs()));
                if course.rises_until(to) {
                    assert!((value - most).abs() <= room && (here - bend).abs() <= 1e-9 * (1.0 + bend));
                }
            }
        }
        assert!(tight > 2000, "{tight}");
    }

    /// As shipped bounds hold, too, and those of points are not much more than exact ones: Gaussian ones 7 %.
    fn bounds_in_single_precision_hold() {
        let mut random = Random::new(55);
        let (mut loose, mut rising) = (0, 0);
        for (primitive, origin, direction) in cases() {
            let exact = course::<f64>(&primitive, origin, direction);
            let shipped = course::<f32x8>(&primitive, origin, direction);
            let ceiling = primitive.lump::<f32>().expect("a lump").ceiling();
            let within: [f64; 8] = core::array::from_fn(|_| random.range(0.0, 6.0) / primitive.width);
            let lanes = |x: f64| f32x8::splat(x as f32);
            let [peak, scale, compact] = [ceiling.peak, ceiling.scale, ceiling.compact].map(lanes);
            let most = field::Ceiling { peak, scale, compact }.at(f32x8::from_lanes(|i| within[i]));
            for (i, distance) in within.into_iter().enumerate() {
                let (most, want) = (most.lane(i), ceiling.at(distance));
                // 2·10⁻³⁸ of the peak is what bounds do not go below.
                let room = 1e-5 * want + 1e-6 * (ceiling.compact + 1e-30) * ceiling.peak;
                assert!(most >= want - room && most <= 1.07 * want + room, "{primitive:?} {distance}: {most} {want}");
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
                assert!(largest <= most + room, "{primitive:?} {from} {to}: {largest} {most}");
                if step * primitive.width > 1e-3 {
                    let bent = (0..40).map(|i| (at(i).1 - at(i + 1).1) / step).fold(0.0, f64::max);
                    let room = 3e-3 * (bend + primitive.width * primitive.width);
                    assert!(bent <= bend + kink / step + room, "{primitive:?} {from} {to}: {bent} {bend} {kink}");
                }
                if matches!(primitive.skeleton, Skeleton::Segment { .. }) {
                    continue;
                }
                let want = exact.most(from, to);
                let steep = primitive.width * primitive.width;
                assert!(most <= 1.07 * want.most + 1e-4 && bend <= 1.07 * want.bend + 1e-3 * steep, "{primitive:?}: {limits:?} {want:?}");
                loose += u32::from(most > 1.03 * want.most + 1e-5);
            }
            if shipped.rises_until(ends[1]) {
                // What stands in for it there is no worse.
                let (value, _, here) = shipped.bent(ends[1]);
                for i in 0..8 {
                    let (value, here) = (value.lane(i), here.lane(i));
                    assert!(value <= limits.most.lane(i) && here <= limits.bend.lane(i));
                    rising += 1;
                }
            }
        }
        assert!(loose > 100 && rising > 100, "{loose} {rising}");
    }

    /// Where a ramp stops to rise the slope falls by what is said, and where it begins to it does not fall.
    fn kinks_of_ramps_are_told() {
        let mut random = Random::new(54);
        let mut falls = 0;
        for (primitive, ..) in cases() {
            let lump: Lump<f64> = primitive.lump().expect("a lump");
            let half = lump.half();
            if primitive.profile.is_none() {
                continue;
            }
            for end in [-1.0, 1.0] {
                let direction = random.direction();
                let aside = random.vector(1.0 / primitive.width);
                // The ray passes the plane at the end of the segment here.
                let place = primitive.lump_middle() + half * end + (aside - half.normalize() * aside.dot(half.normalize()));
                let away = 3.0 / primitive.width;
                let course = course::<f64>(&primitive, place - direction * away, direction);
                let near = 1e-6 / primitive.width;
                let Limits { bend, kink, .. } = course.most(away - near, away + near);
                let fall = course.at(away - near).1 - course.at(away + near).1;
                assert!(fall <= kink + 2.0 * near * bend + 1e-12 * primitive.width, "{primitive:?}: {fall} {kink}");
                falls += u32::from(kink > 1e-6 * primitive.width && fall > 0.4 * kink);
            }
        }
        assert!(falls > 10, "{falls}");
    }

    /// What single precision has no room for is no lump, nor what is not simple.
    fn what_is_too_large_or_not_simple_is_no_lump() {
        let lump = |blobbiness: f64, strength: f64, kernel: Kernel| {
            let shaping = field::Shaping {
                kernel,
                strength,
                ..common::shaping(1.0, blobbiness)
            };
            primitive(Skeleton::Point { center: DVec3::ZERO }, &shaping, None).lump::<f32>()
        };
        assert!(lump(-4.0, 1.0, Kernel::Gauss).is_some());
        assert!(lump(-100.0, 1.0, Kernel::Gauss).is_none());
        assert!(lump(-4.0, -1.0, Kernel::Gauss).is_none());
        assert!(lump(-4.0, 1.0, Kernel::Cauchy).is_none());
    }

    /// Beyond its reach a lump's field is small; outside of what `within` says it is beyond.
    fn beyond_the_reach_there_is_little() {
        let mut random = Random::new(53);
        for (primitive, origin, direction) in cases() {
            let lump: Lump<f64> = primitive.lump().expect("a lump");
            let level = random.decades(-7.0, -2.0);
            let square = lump.reach(level);
            let [near, far] = course::<f64>(&primitive, origin, direction).within(square);
            for i in 0..200 {
                let t = f64::from(i) * 0.2 / primitive.width;
                let point = origin + direction * t;
                let value = primitive.value(point.to_array());
                if near > far || t < near || t > far {
                    assert!(value <= level * (1.0 + 1e-6) + 1e-12, "{primitive:?} {t} {near} {far}: {value} {level}");
                }
                if value > level {
                    let distance = point.distance(primitive.lump_middle());
                    assert!(distance <= lump.radius(square) * (1.0 + 1e-9));
                }
            }
        }
    }
}
