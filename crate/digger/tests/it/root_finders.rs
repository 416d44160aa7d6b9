//! Tests of root finders against exact hits.
use glam::DVec3;
use scene::{Digger, Scene, Shape};
use tracer::{Pass, Picture, Stats, Tile};
use trials::scenes::{blend, clothe, element, empty, soft};
use trials::{Random, count};

const ALL: [Digger; 9] = [
    Digger::Hermite,
    Digger::Spans(2),
    Digger::Spans(16),
    Digger::Lagrange,
    Digger::Brent,
    Digger::Ridder,
    Digger::RegulaFalsi,
    Digger::Lg,
    Digger::Sphere,
];

/// Returns the largest error of a digger's crossings in an easy scene, along the ray.
fn tolerance(digger: Digger) -> f64 {
    match digger {
        // Two spans are crude, the more so as the field is cut off so late here.
        Digger::Spans(2) => 0.5,
        Digger::Spans(_) => 5e-3,
        Digger::Hermite | Digger::Lagrange => 1e-3,
        // The error of the field's cut-off at the depth of influence.
        _ => 1e-5,
    }
}

/// Returns the picture of a scene by a digger.
fn dig(scene: &Scene, digger: Digger) -> Picture {
    let mut scene = scene.clone();
    scene.settings.digger = digger;
    digger::picture(&scene, [16, 16])
}

/// Returns the first crossing of a ray, as the picture's digger finds it.
fn meets(picture: &Picture, origin: DVec3, direction: DVec3) -> Option<f64> {
    picture.cast(&[(origin, direction)])[0].map(|hit| hit.t)
}

/// Returns two crossed bars and a ball, cut off where no digger can notice.
fn easy() -> Scene {
    let mut scene = empty();
    scene.settings.influence = 1e-6;
    clothe(&mut scene, vec![soft(2.0, 1.0)]);
    let radius = 0.25;
    for shape in [
        Shape::cylinder(
            DVec3::new(-1.0, 0.0, 0.1),
            DVec3::new(1.0, 0.0, 0.1),
            radius,
        ),
        Shape::cylinder(
            DVec3::new(0.1, -1.0, 0.0),
            DVec3::new(0.0, 1.0, 0.0),
            radius,
        ),
        Shape::sphere(DVec3::new(0.7, 0.7, 0.2), radius),
    ] {
        scene.elements.push(element(shape, 0));
    }
    // Infinite kernels that fade slowly have long intervals; this one is over soon.
    for element in &mut scene.elements {
        element.kernel = field::Kernel::Gauss;
    }
    scene
}

#[test]
fn all_diggers_agree_on_an_easy_scene() {
    let scene = easy();
    let exact = Picture::new(&scene, [16, 16]);
    for digger in ALL {
        let picture = dig(&scene, digger);
        let mut n = Random::new(9);
        let (mut met, mut worst) = (0, 0.0_f64);
        for _ in 0..count(400) {
            let origin = n.direction() * 4.0;
            // At the bars' axes, so that no ray grazes.
            let aim = DVec3::new(n.range(-0.8, 0.8), 0.0, 0.1);
            let direction = (aim - origin).normalize();
            let hits = exact.hits(origin, direction);
            let Some(first) = hits.first() else { continue };
            let steep = first.normal.dot(direction).abs();
            let thick = hits[1].t - first.t;
            if steep < 0.3 || thick < 0.2 {
                continue;
            }
            let found = meets(&picture, origin, direction);
            let t = found.unwrap_or_else(|| panic!("{digger:?} misses a hit at {}", first.t));
            worst = worst.max((t - first.t).abs() * steep);
            met += 1;
        }
        assert!(met > count(200), "{met}");
        assert!(worst < tolerance(digger), "{digger:?}: {worst}");
    }
}

#[test]
fn methods_with_lipschitz_constants_miss_and_invent_nothing() {
    let mut n = Random::new(3);
    let mut met = 0;
    for seed in 0..count(40) as u64 {
        let mut scene = blend(seed, 2 + seed as usize % 7);
        scene.settings.influence = 1e-9;
        // Rays that leave through the far end of a plane are beyond what is compared.
        scene.elements.retain(|e| e.shape.bounds(0.0).is_some());
        let exact = Picture::new(&scene, [8, 8]);
        let field = scene.soft_surfaces().swap_remove(0).sum;
        for digger in [Digger::Lg, Digger::Sphere] {
            let picture = dig(&scene, digger);
            for case in 0..25 {
                let origin = n.vector(1.0) * if case % 2 == 0 { 4.0 } else { 0.8 };
                let direction = (n.vector(0.8) - origin).normalize();
                let hits = exact.hits(origin, direction);
                let found = meets(&picture, origin, direction);
                // Whether the field stays near T on the missed or invented interval.
                let grazes = |from: f64, to: f64| {
                    (0..=100).all(|i| {
                        let t = from + (to - from) * f64::from(i) / 100.0;
                        (field.jet(origin + direction * t).value - 1.0).abs() < 1e-5
                    })
                };
                match (found, hits.first()) {
                    (None, None) => (),
                    (Some(t), Some(first)) if (t - first.t).abs() < 1e-5 => met += 1,
                    (found, first) => {
                        let end = hits.get(1).map_or(1e9, |h| h.t);
                        let missed = first.is_some_and(|first| grazes(first.t, end));
                        let invented = found.is_some_and(|t| grazes(t, t + 1e-6));
                        assert!(missed || invented, "{digger:?} {seed}: {found:?} {first:?}");
                    }
                }
            }
        }
    }
    assert!(met > count(700), "{met}");
}

/// Traces a picture in one tile.
fn trace(scene: &Scene, size: [u32; 2]) -> (Vec<u8>, Stats) {
    let mut stats = Stats::default();
    let tile = Tile {
        x: 0,
        y: 0,
        width: size[0],
        height: size[1],
    };
    let picture = digger::picture(scene, size);
    let pixels = picture.trace(tile, Pass::Full, &|| false, &mut stats);
    (pixels.unwrap(), stats)
}

#[test]
fn pictures_of_all_diggers_are_much_alike() {
    let scene = easy();
    let size = [40, 32];
    let (wanted, _) = trace(&scene, size);
    for digger in ALL {
        let mut scene = scene.clone();
        scene.settings.digger = digger;
        let (found, stats) = trace(&scene, size);
        assert_eq!(stats.primary_rays, 40 * 32);
        assert!(stats.field_evaluations > 0 && stats.shadow_rays > 0);
        let differing = wanted
            .chunks_exact(4)
            .zip(found.chunks_exact(4))
            .filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 12))
            .count();
        let allowed = match digger {
            Digger::Spans(2) => 200,
            _ => 12,
        };
        assert!(differing <= allowed, "{digger:?}: {differing} pixels");
    }
}

#[test]
fn rays_along_the_surface_come_to_an_end() {
    // All along the ray the field of the plane is T, and its slope 0.
    let mut scene = empty();
    clothe(&mut scene, vec![soft(1.0, 1.0)]);
    scene
        .elements
        .push(element(Shape::plane(DVec3::ZERO, DVec3::Y, 0.25), 0));
    for digger in ALL {
        let picture = dig(&scene, digger);
        for y in [0.25, 0.25 + 1e-13, 0.25 - 1e-13, 0.0] {
            let _ = meets(&picture, DVec3::new(-3.0, y, 0.0), DVec3::X);
        }
        assert_eq!(meets(&picture, DVec3::NAN, DVec3::X), None);
        assert_eq!(meets(&picture, DVec3::ZERO, DVec3::ZERO), None);
    }
}

#[test]
fn a_map_shows_costs_and_does_not_depend_on_tiles() {
    for digger in [Digger::Hermite, Digger::Lg] {
        let mut scene = easy();
        scene.settings.digger = digger;
        scene.settings.map = Some(1.0);
        scene.settings.samples = 2;
        let size = [70, 50];
        let whole = |scene: &Scene, side: u32| {
            let picture = digger::picture(scene, size);
            let mut pixels = vec![0; 4 * 70 * 50];
            for tile in tracer::tiles(size[0], size[1], side) {
                let stats = &mut Stats::default();
                let part = picture.trace(tile, Pass::Smooth, &|| false, stats).unwrap();
                let row = 4 * tile.width as usize;
                for (y, line) in (tile.y..).zip(part.chunks_exact(row)) {
                    let at = 4 * (y * size[0] + tile.x) as usize;
                    pixels[at..at + row].copy_from_slice(line);
                }
            }
            pixels
        };
        let once = whole(&scene, 128);
        assert!(once == whole(&scene, 16) && once == whole(&scene, 11));
        assert!(
            once.chunks_exact(4)
                .all(|p| p[0] == p[1] && p[1] == p[2] && p[3] == 255)
        );
        // The corner is cheap, the middle is not, and the dearest of the sample is white.
        let [corner, middle] = [(1, 1), (35, 25)].map(|(x, y)| once[4 * (y * 70 + x)]);
        assert!(corner < 20 && middle > 60, "{digger:?}");
        assert!(once.chunks_exact(4).any(|p| p[0] == 255));
        // A gamma lifts what is dark.
        scene.settings.map = Some(2.0);
        let lifted = whole(&scene, 128);
        assert!(once.iter().zip(&lifted).all(|(a, b)| a <= b));
        assert!(lifted != once);
        // A picture that was asked to stop is not spoilt.
        let picture = digger::picture(&scene, size);
        let tile = Tile {
            x: 0,
            y: 0,
            width: 70,
            height: 50,
        };
        let stats = &mut Stats::default();
        assert!(picture.trace(tile, Pass::Full, &|| true, stats).is_none());
        assert!(picture.trace(tile, Pass::Smooth, &|| false, stats) == Some(lifted));
    }
}

#[test]
fn a_ray_through_very_many_primitives_comes_to_an_end() {
    let mut scene = empty();
    // Balls so weak that all together they never reach T, so that a ray meets all of them.
    clothe(&mut scene, vec![soft(1.0, 2e-5)]);
    scene.settings.influence = 1e-9;
    let mut n = Random::new(1);
    for _ in 0..5_000 {
        let center = n.vector(0.3);
        let radius = 0.25;
        let ball = Shape::sphere(center, radius);
        scene.elements.push(element(ball, 0));
    }
    for digger in ALL {
        let mut scene = scene.clone();
        scene.settings.digger = digger;
        let (_, stats) = trace(&scene, [2, 1]);
        // Eight rays are followed, and none needs to look at everything a thousand times.
        assert!(
            stats.field_evaluations < 8 * 5_000 * 200,
            "{digger:?}: {stats:?}"
        );
    }
}
