//! Far out, a field is a tiny fraction of its largest value, and surfaces of great blobbiness lie
//! there: relative accuracy must hold.

use core::f64::consts::TAU;
use field::bound::{Nearness, SpanLength};
use field::{BlobScale, Bound, Kernel, Primitive, Profile, Shaping, Skeleton, Wave};
use glam::DVec3;
use oracle::evaluation::{primitive, single, span_error};
use oracle::quadrature;
use trials::skeletons::Kind;
use trials::{Random, count};

fn gauss(skeleton: Skeleton) -> Primitive {
    let shaping = Shaping {
        kernel: Kernel::Gauss,
        radius: 1.0,
        blobbiness: 30.0,
        blob_scale: BlobScale::Relative,
        strength: 1.0,
        influence: 1e-3,
        taper: None,
    };
    Primitive::new(skeleton, &shaping, None).expect("flesh")
}

/// Fields keep their digits beyond the ends of a Gaussian's arc, too.
#[test]
fn arcs_keep_their_digits() {
    let mut random = Random::new(5);
    for case in 0..count(400) {
        let u = random.direction();
        let v = u.cross(random.direction()).normalize();
        let radius = random.decades(-0.5, 1.0);
        let angle = random.range(0.1, if case % 4 == 0 { TAU } else { 3.0 });
        let arc = gauss(Skeleton::Arc {
            center: DVec3::ZERO,
            u,
            v,
            radius,
            angle,
        });
        // Around its end.
        let end = (u * libm::cos(angle) + v * libm::sin(angle)) * radius;
        let point = single(end + random.direction() * random.range(0.7, 1.1));
        let want = quadrature::value(&arc, point);
        let double = arc.value(point.to_array());
        assert!(
            (double - want).abs() <= 1e-11 * want,
            "{double:e} {want:e} {arc:?} {point}"
        );
        let single = f64::from(arc.value(point.to_array().map(|x| x as f32)));
        // The field is about T; coordinates are rounded, too.
        assert!(
            (single - want).abs() <= 3e-4 * want + 1e-6,
            "{single:e} {want:e} {arc:?} {point}"
        );
    }
}

/// Rounding errors of a face's sums over edges are within `Bound::cancels`.
#[test]
fn rounding_of_sums_over_edges_is_bounded() {
    let mut random = Random::new(6);
    for case in 0..count(600) {
        let kind = [Kind::Triangle, Kind::Polygon][case % 2];
        let face = gauss(random.skeleton(kind, 2.0));
        let bound = Bound::new(&face);
        let from = face.skeleton.nearest(random.direction() * 4.0);
        let point = single(from + random.direction() * random.range(0.5, 1.1));
        let double = face.value(point.to_array());
        let single = f64::from(face.value(point.to_array().map(|x| x as f32)));
        let steepness = bound.relative_slope(Nearness::at(face.skeleton.distance(point)));
        let most = 2.5e-7 * (2.0 * bound.cancels() + double.abs() * (4.0 + 4.0 * steepness));
        let off = (single - double).abs();
        assert!(
            off <= most,
            "{single:e} {double:e} {most:e} {face:?} {point}"
        );
    }
}

/// Along a plane a field does not change: spans may be as long as they like.
#[test]
fn spans_along_planes_keep_their_bound() {
    let mut random = Random::new(7);
    for _ in 0..count(200) {
        let plane = primitive(
            random.skeleton(Kind::Plane, 1.0),
            &random.shaping(1.0),
            None,
        );
        let Skeleton::Plane { point, normal } = plane.skeleton else {
            panic!("a plane");
        };
        let normal = normal.normalize();
        let along = normal.any_orthonormal_vector();
        let direction = (along + normal * random.decades(-4.0, 0.5)).normalize();
        let length = random.decades(-1.0, 3.0);
        let bound = Bound::new(&plane);
        let start = point + normal * random.range(-2.0, 2.0);
        let shortened = bound.shortened(direction, 0.0);
        let near = bound.nearness(start + direction * (0.5 * length), 0.5 * length * shortened);
        let error = bound
            .estimate(near, &SpanLength::new(length * shortened))
            .error;
        let off = span_error(&plane, start, direction, length);
        let ends = [0.0, length].map(|t| plane.value((start + direction * t).to_array()));
        let size = ends[0].abs() + ends[1].abs();
        assert!(
            off <= error * (1.0 + 1e-6) + 1e-9 * (1.0 + size),
            "{off} > {error} {plane:?}"
        );
    }
}

/// A wave on a needle is steep across the needle.
#[test]
fn waves_on_needles_are_followed() {
    let long = DVec3::X * 4.0;
    let corners = [DVec3::ZERO, long, long * 0.4 + DVec3::Y * 0.02];
    let wave = Profile {
        waves: [Wave::One, Wave::Sin],
        scale: [1.0, 3.0],
        bounds: [0.2, 1.0],
        ..Profile::default()
    };
    let shaping = Shaping {
        kernel: Kernel::Cauchy,
        ..Random::new(1).shaping(0.5)
    };
    let needle = primitive(Skeleton::Triangle { corners }, &shaping, Some(wave));
    let bound = Bound::new(&needle);
    // Across it, where both parameters are between 0 and 1.
    let (start, length) = (DVec3::new(1.6, 0.001, 0.1), 0.018);
    let off = span_error(&needle, start, DVec3::Y, length);
    let near = bound.nearness(start + DVec3::Y * (0.5 * length), 0.5 * length);
    let error = bound.estimate(near, &SpanLength::new(length)).error;
    assert!(off > 1e-4 && off <= error, "{off} {error}");
}
