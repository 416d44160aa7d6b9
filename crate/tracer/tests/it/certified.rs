//! Ways of finding surfaces, held to the conformance suite: no hits further from the true surface
//! than the tolerance, none missed where it is thicker than that, none invented.
//! `cargo run --release -p tracer --example certify` does so on many more rays, kernel by kernel.

use field::Kernel;
use glam::DVec3;
use oracle::rays::{Method, parameters};
use oracle::surfaces::{self, judge};
use scene::{Element, Scene, Shape};
use tracer::{Pass, Picture, Stats, Tile};
use trials::scenes::{Kind, clothe, element, empty, soft};
use trials::{Random, count};

/// The way of pictures.
const PICTURES: Method<'static> = &|trial, picture| parameters(&picture.cast(&trial.rays));

/// The exact way.
const EXACT: Method<'static> = &|trial, picture| {
    let rays = trial.rays.iter();
    rays.map(|&(origin, direction)| picture.hits(origin, direction).first().map(|hit| hit.t))
        .collect()
};

/// Defines a test for each check of the suite, so that they run side by side.
macro_rules! hold {
    ($($module:ident: $method:expr, $($check:ident),*;)*) => {$(
        mod $module {
            use super::*;
            $(#[test]
            fn $check() {
                surfaces::$check($method);
            })*
        }
    )*};
}

hold! {
    pictures: PICTURES, blobs, points_and_lines, faces, profiles, mixtures_and_clusters, clouds,
        patches, starts_beside_a_cloud, earlier_faults, earlier_faults_that_are_hard_to_judge;
    exact: EXACT, blobs, points_and_lines, faces, profiles, mixtures_and_clusters, clouds, patches;
}

/// Kinds in whose pictures each of the following faults would show.
const PLAIN: [Kind; 3] = [Kind::Point, Kind::Segment, Kind::Arc];

#[test]
fn a_hit_that_is_three_tolerances_off_is_noticed() {
    let (total, _) = judge(&Kernel::ALL, &PLAIN, 18, 3, &|trial, picture| {
        let mut hits = picture.cast(&trial.rays);
        for (hit, (_, direction)) in hits.iter_mut().zip(&trial.rays) {
            if let Some(hit) = hit {
                // Where the ray grazes, a small distance from the surface is a long way along it.
                let steep = hit.normal.dot(*direction).abs().max(1e-3);
                hit.t -= 3.0 * picture.tolerance(hit.t) / steep;
            }
        }
        parameters(&hits)
    });
    assert!(total.invented * 10 > total.hits * 8, "{total:?}");
}

#[test]
fn a_hit_that_is_not_reported_is_noticed() {
    let (total, _) = judge(&Kernel::ALL, &PLAIN, 18, 3, &|trial, picture| {
        let mut hits = parameters(&picture.cast(&trial.rays));
        hits.iter_mut().step_by(3).for_each(|hit| *hit = None);
        hits
    });
    assert!(total.missed * 10 > total.rays, "{total:?}");
}

#[test]
fn the_far_side_instead_of_the_near_one_is_noticed() {
    let (total, _) = judge(&Kernel::ALL, &PLAIN, 18, 3, &|trial, picture| {
        let rays = trial.rays.iter();
        rays.map(|&(origin, direction)| picture.hits(origin, direction).last().map(|hit| hit.t))
            .collect()
    });
    assert!(total.missed * 10 > total.hits * 2, "{total:?}");
}

#[test]
fn a_primitive_that_is_left_out_is_noticed() {
    let (total, _) = judge(&Kernel::ALL, &[Kind::Mixed], 9, 3, &|trial, _| {
        let mut scene = trial.scene.clone();
        scene.elements.pop();
        let size = [trial.size; 2];
        parameters(&Picture::new(&scene, size).cast(&trial.rays))
    });
    assert!(total.faults() * 20 > total.rays, "{total:?}");
}

/// `cast`, which the checks use, agrees with pictures.
#[test]
fn cast_agrees_with_pictures() {
    const SIDE: u32 = 48;
    let (mut shown, mut differ) = (0, 0);
    for seed in 0..count(16) as u64 {
        let mut scene = trials::scenes::blend(seed, 5);
        scene.background = [0.0, 0.0, 1.0].into();
        for finish in &mut scene.finishes {
            finish.ambient = [0.5, 0.5, 0.0];
        }
        scene.lights.clear();
        let picture = Picture::new(&scene, [SIDE; 2]);
        let whole = Tile {
            x: 0,
            y: 0,
            width: SIDE,
            height: SIDE,
        };
        let pixels = picture
            .trace(whole, Pass::Full, &|| false, &mut Stats::default())
            .expect("nobody asked to stop");
        let projection = scene.camera.projection(SIDE, SIDE);
        let rays: Vec<_> = (0..SIDE * SIDE)
            .map(|i| {
                let [x, y] = [i % SIDE, i / SIDE].map(|i| (f64::from(i) + 0.5) / f64::from(SIDE));
                (projection.eye, projection.direction(x, y))
            })
            .collect();
        for (pixel, hit) in pixels.chunks(4).zip(picture.cast(&rays)) {
            shown += usize::from(hit.is_some());
            differ += usize::from(hit.is_some() != (pixel[2] == 0));
        }
    }
    assert!(shown > count(5_000), "{shown}");
    assert!(differ <= count(8), "{differ} of {shown}");
}

/// Counts a picture's pixels that show the surface, and those that disagree with their exact rays.
fn count_pixels(mut scene: Scene, side: u32) -> [usize; 2] {
    scene.background = [0.0, 0.0, 1.0].into();
    for finish in &mut scene.finishes {
        finish.ambient = [0.5, 0.5, 0.0];
    }
    scene.lights.clear();
    let picture = Picture::new(&scene, [side; 2]);
    let whole = Tile {
        x: 0,
        y: 0,
        width: side,
        height: side,
    };
    let pixels = picture
        .trace(whole, Pass::Full, &|| false, &mut Stats::default())
        .expect("nobody asked to stop");
    let projection = scene.camera.projection(side, side);
    let (mut shown, mut wrong) = (0, 0);
    for (i, pixel) in (0..side * side).zip(pixels.chunks(4)) {
        let [x, y] = [i % side, i / side].map(|i| (f64::from(i) + 0.5) / f64::from(side));
        let direction = projection.direction(x, y);
        let there = !picture.hits(projection.eye, direction).is_empty();
        shown += usize::from(there);
        wrong += usize::from(there != (pixel[2] == 0));
    }
    [shown, wrong]
}

/// Blobs among bones of other kernels, before and behind them, and so many bones of one infinite
/// kernel that packets share interpolants. Pictures agree with single rays traced exactly.
#[test]
fn pictures_show_what_is_there() {
    let mut n = Random::new(11);
    let (mut seen, mut wrong) = (0, 0);
    for case in 0..count(4) {
        let mut scene = empty();
        let joined = case % 2 == 1;
        clothe(&mut scene, vec![soft(3.0, 1.0)]);
        for k in 0..if joined { 40 } else { 5 } {
            let blob = k % 2 == 0;
            let at = n.vector(1.0);
            let shape = match (joined, blob) {
                (true, _) => n.shape(k),
                (false, true) => Shape::sphere(at, n.range(0.1, 0.5)),
                (false, false) => Shape::cylinder(at + n.vector(0.4), at, n.range(0.02, 0.15)),
            };
            scene.elements.push(Element {
                kernel: match (joined, blob) {
                    (true, _) => Kernel::Cauchy,
                    (false, true) => Kernel::Gauss,
                    (false, false) => Kernel::Quartic,
                },
                ..element(shape, 0)
            });
        }
        let [there, off] = count_pixels(scene, 48);
        seen += there;
        wrong += off;
    }
    assert!(seen > count(1000) && wrong <= count(2), "{wrong} of {seen}");
}

/// A bone that is much thinner than any beam is seen.
#[test]
fn a_thin_bone_beside_blobs_is_not_stepped_over() {
    let mut scene = empty();
    clothe(&mut scene, vec![soft(4.0, 1.0)]);
    scene.camera.eye = DVec3::new(0.0, 0.0, 0.02);
    scene.camera.fov = 0.2;
    let blob = Shape::sphere(DVec3::new(0.0, 3.0, 0.0), 0.8);
    let thin = Shape::cylinder(
        DVec3::new(-3e-5, 0.0, 0.0),
        DVec3::new(3e-5, 0.0, 0.0),
        1e-5,
    );
    for (shape, kernel) in [(blob, Kernel::Gauss), (thin, Kernel::Quartic)] {
        scene.elements.push(Element {
            kernel,
            ..element(shape, 0)
        });
    }
    let [shown, wrong] = count_pixels(scene, 64);
    assert!(shown > 500 && wrong * 50 <= shown, "{wrong} of {shown}");
}
