//! Bounds on random primitives: depth of influence, ray intervals, spheres, distances.

use core::f64::consts::TAU;
use field::{Kernel, Primitive, Profile, Shaping, Skeleton, THRESHOLD, Wave};
use glam::DVec3;
use oracle::evaluation::{jet, primitive, sensitivity};
use trials::skeletons::{KINDS, Kind, shaping};
use trials::{Random, count};

/// A kernel that is level at the skeleton, and one with a pole there.
const KERNELS: [Kernel; 2] = [Kernel::Cauchy, Kernel::Cubed];

fn random_primitive(random: &mut Random, kind: Kind) -> Primitive {
    let size = random.decades(-2.0, 1.5);
    let skeleton = random.skeleton(kind, size);
    let shaping = Shaping {
        kernel: random.pick(&KERNELS),
        influence: random.decades(-4.0, -1.0),
        ..random.shaping(1.0)
    };
    let wave = Profile {
        waves: [Wave::Sin, Wave::Cos2],
        scale: [9.0, 3.0],
        bounds: [0.5, 1.7],
        times: 1.2,
        restriction: 0.0,
    };
    let profile = random.pick(&[None, None, Some(wave)]);
    primitive(skeleton.clone(), &shaping, profile)
}

/// Returns a point at exactly this distance from a place on the skeleton, so at most that from it.
fn at_distance(random: &mut Random, skeleton: &Skeleton, distance: f64) -> DVec3 {
    random.place(skeleton) + random.direction() * distance
}

/// |f| ≤ most_beyond(distance), which does not grow, and is below ε·T at the depth of influence.
#[test]
fn influence_bounds_the_field() {
    for kind in KINDS {
        let mut random = Random::new(21);
        for _ in 0..count(300) {
            let primitive = random_primitive(&mut random, kind);
            for _ in 0..60 {
                let depth = random.decades(-2.0, 1.0);
                let point = at_distance(&mut random, &primitive.skeleton, depth);
                let distance = primitive.skeleton.distance(point);
                let value = jet::<f64>(&primitive, point).0.abs();
                let bound = primitive.most_beyond(distance);
                // Next to a pole the distance's rounding counts.
                let slack = 4.0 * f64::EPSILON * sensitivity(&primitive, point);
                assert!(
                    value <= bound * (1.0 + 1e-12) + slack,
                    "{value} > {bound}: {primitive:?} at {point:?}"
                );
                assert!(
                    primitive.most_beyond(1.1 * distance) <= bound * (1.0 + 1e-12),
                    "{primitive:?} at {distance}"
                );
            }
        }
    }
}

/// Fields are below ε·T beyond the depth of influence, which is not needlessly large.
#[test]
fn influence_is_tight() {
    for kind in KINDS {
        let mut random = Random::new(22);
        for _ in 0..count(200) {
            let size = random.decades(-1.0, 2.0);
            let skeleton = random.skeleton(kind, size);
            let kernel = random.pick(&KERNELS);
            let shaping = Shaping {
                kernel,
                influence: random.decades(-4.0, -1.0),
                ..shaping(1.0, 1.0)
            };
            let primitive = primitive(skeleton.clone(), &shaping, None);
            let level = shaping.influence * THRESHOLD;
            assert!(
                primitive.most_beyond(primitive.influence * (1.0 + 1e-9)) <= level * (1.0 + 1e-9)
            );
            if primitive.influence == 0.0 {
                continue;
            }
            // Largest field at that distance over many directions.
            let largest = (0..2_000)
                .map(|_| {
                    // Straight out from the nearest point of the skeleton.
                    let place = at_distance(&mut random, &skeleton, primitive.influence);
                    let nearest = skeleton.nearest(place);
                    let outward = (place - nearest).normalize_or_zero();
                    let point = nearest + outward * primitive.influence;
                    if skeleton.distance(point) < primitive.influence * 0.999 {
                        return 0.0;
                    }
                    jet::<f64>(&primitive, point).0.abs()
                })
                .fold(0.0, f64::max);
            let factor = match kind {
                Kind::Point | Kind::Plane => 0.99,
                Kind::Segment => 0.5,
                // Half a plane beside an edge, and needles.
                _ => 0.1,
            };
            assert!(largest <= level * 1.01, "{primitive:?}");
            assert!(
                largest >= level * factor,
                "{largest} of {level}: {primitive:?}"
            );
        }
    }
}

/// Points of a ray within the depth of influence are within its interval; the sphere holds them
/// too.
#[test]
fn ray_intervals_are_conservative() {
    for kind in KINDS {
        let mut random = Random::new(23);
        let (mut hits, mut misses) = (0, 0);
        for _ in 0..count(400) {
            let primitive = random_primitive(&mut random, kind);
            if primitive.influence == 0.0 {
                continue;
            }
            for _ in 0..20 {
                let from = random.decades(-1.0, 2.0);
                let origin = random.direction() * from;
                let near = random.range(0.0, 1.5) * primitive.influence;
                let target = at_distance(&mut random, &primitive.skeleton, near);
                let axis = random.pick(&[DVec3::X, DVec3::Y, DVec3::Z]);
                let direction = random.pick(&[target - origin, target - origin, axis])
                    * random.decades(-2.0, 2.0);
                let interval = primitive.ray_interval(origin, direction);
                match interval {
                    Some(_) => hits += 1,
                    None => misses += 1,
                }
                // Around the target, and around the interval's ends.
                let around = (target - origin).dot(direction) / direction.length_squared();
                let step = primitive.influence / direction.length();
                for i in 0..60 {
                    let t = match (i % 3, interval) {
                        (0, Some([start, _])) if start.is_finite() => {
                            start - step * random.decades(-6.0, 0.5)
                        }
                        (1, Some([_, end])) if end.is_finite() => {
                            end + step * random.decades(-6.0, 0.5)
                        }
                        _ => around + step * random.range(-2.0, 2.0),
                    };
                    let point = origin + direction * t;
                    let inside = interval.is_some_and(|[start, end]| (start..=end).contains(&t));
                    let distance = primitive.skeleton.distance(point);
                    assert!(
                        inside || distance >= primitive.influence * (1.0 - 1e-9),
                        "t = {t} at distance {distance} of {} is not in {interval:?}: \
                         {primitive:?}, {origin:?} {direction:?}",
                        primitive.influence
                    );
                    if let Some((center, radius)) = primitive.bounding_sphere() {
                        assert!(
                            distance > primitive.influence
                                || point.distance(center) <= radius * (1.0 + 1e-9),
                            "{primitive:?} at {point:?}"
                        );
                    }
                }
            }
        }
        assert!(
            hits > count(1_000) && (misses > count(300) || kind == Kind::Plane),
            "{kind:?}: {hits} {misses}"
        );
    }
}

/// Long thin skeletons have tight intervals: most of an interval is near the skeleton.
#[test]
fn ray_intervals_are_tight() {
    let mut random = Random::new(24);
    for kind in KINDS {
        let (mut inside, mut all) = (0.0, 0.0);
        for _ in 0..count(300) {
            let skeleton = random.skeleton(kind, 10.0);
            let primitive = primitive(skeleton.clone(), &shaping(0.1, 1.0), None);
            let target = at_distance(&mut random, &skeleton, 0.5 * primitive.influence);
            let origin = random.direction() * 30.0;
            let direction = (target - origin).normalize();
            let Some([start, end]) = primitive.ray_interval(origin, direction) else {
                continue;
            };
            for i in 0..50 {
                let t = start + (end - start) * (f64::from(i) + 0.5) / 50.0;
                all += end - start;
                if primitive.skeleton.distance(origin + direction * t) <= primitive.influence {
                    inside += end - start;
                }
            }
        }
        let share = inside / all;
        let least = if kind == Kind::Arc { 0.2 } else { 0.8 };
        assert!(share > least, "{kind:?}: {share}");
    }
}

/// The nearest point, by search.
#[test]
fn distance_is_the_smallest() {
    for kind in [Kind::Segment, Kind::Arc, Kind::Triangle] {
        let mut random = Random::new(27);
        for _ in 0..count(200) {
            let skeleton = random.skeleton(kind, 1.0);
            let point = random.near(&skeleton, -2.0, 0.5);
            let distance = skeleton.distance(point);
            for _ in 0..200 {
                let (s, t) = (random.unit(), random.unit());
                let other = match skeleton {
                    Skeleton::Segment { base, apex } => base + (apex - base) * s,
                    Skeleton::Arc {
                        center,
                        u,
                        v,
                        radius,
                        angle,
                    } => {
                        let (sine, cosine) = libm::sincos(angle.min(TAU) * s);
                        center + radius * (u * cosine + v * sine)
                    }
                    Skeleton::Triangle { corners: [a, b, c] } => {
                        a + (b - a) * s + (c - a) * (t * (1.0 - s))
                    }
                    _ => point,
                };
                assert!(
                    distance <= point.distance(other) + 1e-9,
                    "{skeleton:?} {point:?}"
                );
            }
        }
    }
}
