//! The hierarchy against looking at every box.

use core::ops::ControlFlow;
use glam::DVec3;
use mesh::{Aabb, Bvh, Ray};
use trials::{Random, count};

/// Boxes of several kinds: scattered, flat, equal, in a row of very different sizes.
fn scenes(random: &mut Random) -> Vec<Vec<Aabb>> {
    let mut around = |many: usize, size: f64| -> Vec<Aabb> {
        (0..many)
            .map(|_| {
                let p = random.vector(1.0);
                Aabb::of_points([p, p + random.vector(1.0) * size])
            })
            .collect()
    };
    let scattered = around(500, 0.1);
    let large = around(60, 2.0);
    let mut flat = around(200, 0.3);
    flat.iter_mut()
        .for_each(|b| (b.min.z, b.max.z) = (0.5, 0.5));
    let point = DVec3::splat(0.25);
    let equal = vec![Aabb::of_points([point]); 300];
    let row = (0..1000).map(|i| {
        let x = libm::exp2(f64::from(i) - 500.0);
        Aabb::of_points([DVec3::new(x, 0.0, 0.0), DVec3::new(1.5 * x, x, x)])
    });
    let mut odd = around(20, 0.5);
    odd.push(Aabb::EMPTY);
    odd.push(Aabb {
        min: DVec3::NAN,
        max: DVec3::ONE,
    });
    odd.push(Aabb {
        min: DVec3::NEG_INFINITY,
        max: DVec3::INFINITY,
    });
    odd.push(Aabb {
        min: DVec3::splat(-f64::MAX),
        max: DVec3::splat(f64::MAX),
    });
    vec![
        scattered,
        large,
        flat,
        equal,
        row.collect(),
        odd,
        around(1, 1.0),
        Vec::new(),
    ]
}

fn overlapping(boxes: &[Aabb], query: &Aabb) -> Vec<u32> {
    let hits = (0..boxes.len() as u32).filter(|i| {
        let b = &boxes[*i as usize];
        (0..3).all(|k| b.min[k] <= query.max[k] && query.min[k] <= b.max[k])
            && (0..3).all(|k| b.min[k] <= b.max[k])
    });
    hits.collect()
}

#[test]
fn boxes_that_overlap_are_found() {
    let mut random = Random::new(1);
    for boxes in scenes(&mut random) {
        let bvh = Bvh::new(&boxes);
        assert_eq!(bvh.len(), boxes.len());
        for _ in 0..count(100) {
            let p = random.vector(1.0);
            let query = Aabb::of_points([p, p + random.vector(1.0) * random.unit()]);
            let mut found: Vec<u32> = bvh.overlapping(&query).collect();
            found.sort_unstable();
            assert_eq!(found, overlapping(&boxes, &query));
        }
    }
}

#[test]
fn pairs_are_found_once() {
    for boxes in scenes(&mut Random::new(2)) {
        let mut found = Vec::new();
        Bvh::new(&boxes).pairs(|i, j| {
            found.push((i, j));
            ControlFlow::Continue(())
        });
        found.sort_unstable();
        let mut expected = Vec::new();
        for (i, bounds) in (0..).zip(&boxes) {
            let others = overlapping(&boxes, bounds).into_iter();
            if !bounds.is_empty() {
                expected.extend(others.filter(|j| *j > i).map(|j| (i, j)));
            }
        }
        assert_eq!(found, expected);
        let mut seen = 0;
        Bvh::new(&boxes).pairs(|_, _| {
            seen += 1;
            if seen == 3 {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        });
        assert_eq!(seen, expected.len().min(3));
    }
}

#[test]
fn rays_miss_no_box_and_come_front_to_back() {
    let mut random = Random::new(3);
    for boxes in scenes(&mut random) {
        let bvh = Bvh::new(&boxes);
        for k in 0..count(100) {
            // Some start on corners, some go along axes.
            let (mut origin, mut direction) = (random.vector(1.0) * 1.5, random.vector(1.0));
            if k % 3 == 0 && !boxes.is_empty() {
                origin = boxes[random.below(boxes.len())].min;
                if !origin.is_finite() {
                    origin = DVec3::ZERO;
                }
            }
            if k % 4 == 0 {
                direction = [DVec3::X, DVec3::NEG_Y, DVec3::Z][k % 3];
            }
            let ray = Ray::new(origin, direction);
            let mut found = Vec::new();
            bvh.along_ray(&ray, 3.0, |i, far| {
                found.push(i);
                far
            });
            found.sort_unstable();
            // Points along the ray, exactly where that can be.
            for (i, bounds) in (0..).zip(&boxes) {
                let steps = (0..=60).map(|s| origin + direction * (f64::from(s) / 20.0));
                if steps.into_iter().any(|p| bounds.distance_squared(p) == 0.0) {
                    assert!(found.binary_search(&i).is_ok(), "{i} {bounds:?} {ray:?}");
                }
            }
            // The first box, with the search cut short.
            let entry = |i: u32| ray.entry(&boxes[i as usize], 3.0).unwrap();
            let mut first = None;
            bvh.along_ray(&ray, 3.0, |i, far| {
                if entry(i) < far {
                    first = Some(entry(i));
                    return entry(i);
                }
                far
            });
            let expected = found.iter().map(|i| entry(*i)).reduce(f64::min);
            assert_eq!(first, expected.filter(|e| *e < 3.0));
            let mut visits = 0;
            bvh.along_ray(&ray, 3.0, |_, _| {
                visits += 1;
                -1.0
            });
            assert_eq!(visits, found.len().min(1));
        }
    }
}

#[test]
fn the_nearest_is_the_nearest() {
    let mut random = Random::new(4);
    for boxes in scenes(&mut random) {
        let bvh = Bvh::new(&boxes);
        for _ in 0..count(100) {
            let p = random.vector(1.0) * 3.0;
            let limit = if random.chance(0.5) {
                f64::INFINITY
            } else {
                random.unit()
            };
            let distance = |i: u32| boxes[i as usize].distance_squared(p);
            let expected = (0..boxes.len() as u32)
                .map(|i| (distance(i), i))
                .filter(|(d, _)| *d <= limit && d.is_finite())
                .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))
                .map(|(d, i)| (i, d));
            assert_eq!(bvh.nearest(p, limit, distance), expected);
        }
    }
}

#[test]
fn boxes_may_move() {
    let mut random = Random::new(5);
    for mut boxes in scenes(&mut random) {
        let mut bvh = Bvh::new(&boxes);
        for round in 0..count(30) {
            if boxes.is_empty() {
                break;
            }
            if round % 10 == 9 {
                boxes
                    .iter_mut()
                    .for_each(|b| *b = Aabb::of_points([random.vector(1.0)]));
                bvh.refit(&boxes);
            }
            let i = random.below(boxes.len());
            let p = random.vector(1.0) * 2.0;
            boxes[i] = Aabb::of_points([p, p + 0.1]);
            bvh.set_box(i as u32, boxes[i]);
            let all = boxes.iter().filter(|b| !b.is_empty());
            let bounds = all.fold(Aabb::EMPTY, |all, b| all.union(b));
            assert_eq!(bvh.bounds(), bounds);
            let query = Aabb::of_points([random.vector(1.0), random.vector(1.0)]);
            let mut found: Vec<u32> = bvh.overlapping(&query).collect();
            found.sort_unstable();
            assert_eq!(found, overlapping(&boxes, &query));
        }
    }
}
