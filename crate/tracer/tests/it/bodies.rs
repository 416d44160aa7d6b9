//! Tests of several bodies in one picture, and of bodies of functions that are no sums.

use field::{Ball, Enclosure, Implicit, Jet, Kernel, Sum, THRESHOLD};
use glam::{DAffine3, DMat3, DVec3};
use metaballs::Metaballs;
use oracle::Reference;
use oracle::rays::{Row, Trial, check, parameters};
use scene::{Body, Element, Form, Function, Scene, Shape};
use std::sync::Arc;
use tracer::{Hit, Pass, Picture, Stats, Tile};
use trials::scenes::{Kind, blend};
use trials::{Random, count};
use wide::f32x8;

/// Returns soft elements of all kinds, spread over some bodies.
fn in_bodies(seed: u64, elements: usize, bodies: u32) -> Scene {
    let mut scene = blend(seed, elements);
    for _ in 0..bodies {
        scene.bodies.push(Body::default());
    }
    for (element, body) in scene.elements.iter_mut().zip((0..=bodies).cycle()) {
        element.body = body;
    }
    scene
}

/// Returns a scene with the elements of one body only.
fn one_body(scene: &Scene, body: u32) -> Scene {
    let mut scene = scene.clone();
    // An element without a finish is not drawn, and leaves the scene as large as it was.
    for element in scene.elements.iter_mut().filter(|e| e.body != body) {
        element.finish = u32::MAX;
    }
    scene
}

/// Returns rays in packets from around the scene towards its middle.
fn rays(numbers: &mut Random, packets: usize) -> Vec<(DVec3, DVec3)> {
    let mut rays = Vec::new();
    for _ in 0..packets {
        let eye = numbers.direction() * 6.0;
        let to = numbers.vector(1.0);
        for _ in 0..8 {
            let to = to + numbers.vector(0.02);
            rays.push((eye, (to - eye).normalize()));
        }
    }
    rays
}

#[test]
fn the_nearest_body_is_seen() {
    let (mut hits, mut seen) = (0, std::collections::BTreeSet::new());
    let (mut differ, mut all) = (0, 0);
    for seed in 0..count(30) as u64 {
        let elements = 3 + seed as usize % 7;
        let scene = in_bodies(seed, elements, 1 + seed as u32 % 3);
        let picture = Picture::new(&scene, [512; 2]);
        let bodies = 0..scene.bodies.len() as u32;
        let alone: Vec<Picture> = bodies
            .map(|body| Picture::new(&one_body(&scene, body), [512; 2]))
            .collect();
        let rays = rays(&mut Random::new(seed * 2 + 1), 12);
        for (ray, hit) in rays.iter().zip(picture.cast(&rays)) {
            let firsts = alone.iter().map(|picture| {
                let hits = picture.hits(ray.0, ray.1);
                hits.first().map_or(f64::INFINITY, |hit| hit.t)
            });
            let nearest = (0u32..).zip(firsts).min_by(|a, b| a.1.total_cmp(&b.1));
            let (body, t) = nearest.expect("there are bodies");
            all += 1;
            match hit {
                Some(hit) if (hit.t - t).abs() < 1e-3 => {
                    hits += 1;
                    assert_eq!(hit.body, Some(body), "{seed}");
                    seen.insert(body);
                    let element = hit.element.expect("it is an element's");
                    assert_eq!(scene.elements[element as usize].body, body);
                }
                None if t == f64::INFINITY => {}
                // A ray that grazes may be seen to meet or not.
                _ => differ += 1,
            }
        }
    }
    assert!(
        hits > count(400) && seen.len() >= count(30).min(4),
        "{hits} {seen:?}"
    );
    assert!(differ * 300 < all, "{differ} of {all}");
}

/// Pictures show all bodies, and shadows fall from one body onto another.
#[test]
fn pictures_show_all_bodies() {
    const SIDE: u32 = 40;
    let whole = Tile {
        x: 0,
        y: 0,
        width: SIDE,
        height: SIDE,
    };
    let trace = |scene: &Scene| {
        let picture = Picture::new(scene, [SIDE; 2]);
        let pixels = picture.trace(whole, Pass::Full, &|| false, &mut Stats::default());
        pixels.expect("nobody asked to stop")
    };
    let (mut equal, mut differ, mut shaded) = (0, 0, 0);
    for seed in 0..count(12) as u64 {
        let mut scene = in_bodies(seed, 6, 2);
        scene.lights[0].shadow = false;
        let pixels = trace(&scene);
        let alone: Vec<Vec<u8>> = (0..3).map(|body| trace(&one_body(&scene, body))).collect();
        for (i, pixel) in pixels.chunks_exact(4).enumerate() {
            // A pixel shows what one of the bodies alone would show.
            let same = alone.iter().any(|alone| {
                let other = &alone[4 * i..4 * i + 4];
                pixel.iter().zip(other).all(|(a, b)| a.abs_diff(*b) <= 2)
            });
            *(if same { &mut equal } else { &mut differ }) += 1;
        }
        scene.lights[0].shadow = true;
        shaded += usize::from(trace(&scene) != pixels);
    }
    assert!(differ * 200 < equal, "{differ} of {equal}");
    assert!(shaded >= count(5), "{shaded}");
}

/// The general path for any function, judged by the reference as pictures of sums are.
#[test]
fn surfaces_of_functions_are_within_the_tolerance() {
    let kinds = [
        Kind::Point,
        Kind::Segment,
        Kind::Arc,
        Kind::Triangle,
        Kind::Curve,
        Kind::Taper,
        Kind::Waves,
        Kind::Kinks,
        Kind::Mixed,
    ];
    let (mut all, mut faults) = (Row::default(), String::new());
    for kernel in [Kernel::Gauss, Kernel::Cauchy, Kernel::Quartic, Kernel::Soft] {
        for kind in kinds {
            for seed in 0..count(2) as u64 {
                let seed = 8_000_000 + seed;
                let trial = Trial::new(kernel, kind, seed, 2);
                let row = check(
                    trial,
                    &|trial: &Trial, _: &Picture| {
                        let mut scene = trial.scene.clone();
                        let sum = scene.soft_surfaces().swap_remove(0).sum;
                        for element in &mut scene.elements {
                            element.finish = u32::MAX;
                        }
                        let mut picture = Picture::new(&scene, [trial.size; 2]);
                        let body = picture.add_function(Arc::new(sum), vec![0]);
                        let hits = picture.cast(&trial.rays);
                        assert!(hits.iter().flatten().all(|hit| hit.body == Some(body)));
                        parameters(&hits)
                    },
                    &mut faults,
                );
                all.add(&row);
            }
        }
    }
    assert!(
        all.rays > 400 * count(2) as u64 && 2 * all.hits > all.rays,
        "{all:?}"
    );
    assert!(all.missed == 0 && all.invented == 0, "{all:?}\n{faults}");
}

/// A smooth maximum of two functions: `(a + b + √((a−b)² + k²))/2`.
#[derive(Debug)]
struct SmoothMaximum {
    parts: [Sum; 2],
    k: f64,
}

impl SmoothMaximum {
    /// Returns the value, and the share of the first part.
    fn mix(&self, a: f64, b: f64) -> (f64, f64) {
        let root = libm::sqrt((a - b) * (a - b) + self.k * self.k);
        (0.5 * (a + b + root), 0.5 * (1.0 + (a - b) / root))
    }
}

impl Implicit for SmoothMaximum {
    fn jet(&self, point: DVec3) -> Jet<f64> {
        let [a, b] = self.parts.each_ref().map(|part| part.jet(point));
        let (value, share) = self.mix(a.value, b.value);
        let gradient = a.times(share).plus(b.times(1.0 - share)).gradient;
        Jet { value, gradient }
    }

    fn jet32(&self, point: [f32; 3]) -> Jet<f32> {
        let jet = self.jet(DVec3::from_array(point.map(f64::from)));
        Jet {
            value: jet.value as f32,
            gradient: jet.gradient.map(|x| x as f32),
        }
    }

    fn jet8(&self, points: [f32x8; 3]) -> Jet<f32x8> {
        let lanes = points.map(f32x8::to_array);
        let jets: [Jet<f32>; 8] =
            core::array::from_fn(|i| self.jet32([0, 1, 2].map(|k: usize| lanes[k][i])));
        Jet {
            value: f32x8::new(jets.map(|jet| jet.value)),
            gradient: core::array::from_fn(|k| f32x8::new(jets.map(|jet| jet.gradient[k]))),
        }
    }

    fn enclose(&self, ball: Ball) -> Enclosure {
        let [a, b] = self.parts.each_ref().map(|part| part.enclose(ball));
        // It grows with both; its gradient is a mean of theirs, and the shares change by no more
        // than 1/(2k).
        let both = a.slope + b.slope;
        Enclosure {
            value: [0, 1].map(|i| self.mix(a.value[i], b.value[i]).0),
            slope: a.slope.max(b.slope),
            curvature: a.curvature.max(b.curvature) + both * both / (2.0 * self.k),
        }
    }

    fn shares(&self, point: DVec3, out: &mut Vec<(u32, f64)>) {
        let [a, b] = self.parts.each_ref().map(|part| part.jet(point).value);
        let (_, share) = self.mix(a, b);
        out.extend([(0, share), (1, 1.0 - share)]);
    }

    fn support(&self) -> Option<Ball> {
        // The function reaches T beyond the supports of its parts.
        None
    }
}

/// Returns the crossings of a ray, by marching in small steps.
fn march(function: &dyn Implicit, (origin, direction): (DVec3, DVec3)) -> Vec<f64> {
    let inside = |t: f64| function.jet(origin + direction * t).value >= THRESHOLD;
    let step = 1e-3;
    let mut found = Vec::new();
    let mut before = inside(0.0);
    for i in 1..12_000 {
        let t = step * f64::from(i);
        let after = inside(t);
        if after != before {
            let (mut low, mut high) = (t - step, t);
            for _ in 0..40 {
                let middle = 0.5 * (low + high);
                *(if inside(middle) == before {
                    &mut low
                } else {
                    &mut high
                }) = middle;
            }
            found.push(0.5 * (low + high));
        }
        before = after;
    }
    found
}

#[test]
fn a_smooth_maximum_is_seen_where_it_is() {
    let (mut crossings, mut shown) = (0, 0);
    for seed in 0..count(6) as u64 {
        let scene = in_bodies(seed + 50, 6, 1);
        let mut surfaces = scene.soft_surfaces().into_iter();
        let (Some(a), Some(b)) = (surfaces.next(), surfaces.next()) else {
            continue;
        };
        let function = Arc::new(SmoothMaximum {
            parts: [a.sum, b.sum],
            k: 0.3,
        });
        let mut picture = Picture::new(&Scene::default(), [256; 2]);
        picture.add_function(function.clone(), vec![0, 0]);
        let rays = rays(&mut Random::new(seed * 2 + 9), 3);
        for (ray, hit) in rays.iter().zip(picture.cast(&rays)) {
            let want = march(&*function, *ray);
            let found: Vec<f64> = picture
                .hits(ray.0, ray.1)
                .iter()
                .map(|h: &Hit| h.t)
                .collect();
            // The march may have missed two crossings within a step.
            for t in &want {
                assert!(
                    found.iter().any(|f| (f - t).abs() < 1e-9),
                    "{t} of {found:?}"
                );
            }
            for pair in found
                .iter()
                .filter(|f| !want.iter().any(|t| (*f - t).abs() < 1e-9))
            {
                let on = function.jet(ray.0 + ray.1 * *pair).value - THRESHOLD;
                assert!(on.abs() < 1e-9 || *pair > 11.9, "{pair}: {on}");
            }
            crossings += want.len();
            if let (Some(hit), Some(first)) = (hit, found.first()) {
                assert!((hit.t - first).abs() < 1e-9);
                shown += 1;
            } else {
                assert_eq!(hit.is_none(), found.is_empty());
            }
        }
    }
    assert!(
        crossings > count(60) && shown > count(30),
        "{crossings} {shown}"
    );
}

/// Returns metaballs in some bodies, stretched and far from the origin, beside soft elements.
fn with_functions(seed: u64) -> Scene {
    let mut scene = in_bodies(seed, 5, 1);
    let mut numbers = Random::new(2 * seed + 77);
    for body in [0, 0, 2] {
        let balls = (0..3).map(|_| (numbers.vector(0.6), 0.3)).collect();
        let map = DMat3::from_cols(
            DVec3::X + numbers.vector(0.3),
            1.5 * DVec3::Y,
            DVec3::Z + numbers.vector(0.3),
        );
        let shape = Shape::Function(Box::new(Function {
            form: Form::Metaballs {
                hardness: 5.0,
                balls: Arc::new(balls),
            },
            to_world: DAffine3::from_mat3_translation(map, numbers.vector(0.8)),
        }));
        scene.elements.push(Element {
            body,
            ..Element::new(shape)
        });
    }
    scene.bodies.push(Body::default());
    scene
}

/// Returns the functions of a scene, scaled and moved.
fn move_scene(scene: &Scene, scale: f64, shift: DVec3) -> Scene {
    let map = DAffine3::from_scale_rotation_translation(
        DVec3::splat(scale),
        glam::DQuat::IDENTITY,
        shift,
    );
    let mut scene = scene.clone();
    for element in &mut scene.elements {
        match &mut element.shape {
            Shape::Function(function) => **function = function.moved(&map),
            // Only functions are compared.
            _ => element.finish = u32::MAX,
        }
    }
    scene.camera.eye = map.transform_point3(scene.camera.eye);
    scene.camera.target = map.transform_point3(scene.camera.target);
    scene
}

/// Checks that the hits of a ray are on the surfaces, and that none is missed; returns the number
/// of crossings that are found by marching.
fn check_hits(surfaces: &[scene::Surface], hits: &[tracer::Hit], ray: (DVec3, DVec3)) -> usize {
    let mut crossings = 0;
    for surface in surfaces {
        let found = hits.iter().filter(|hit| hit.body == Some(surface.body()));
        let found: Vec<f64> = found.map(|hit| hit.t).collect();
        let want = march(surface.function(), ray);
        for t in &want {
            let near = found.iter().any(|f| (f - t).abs() < 1e-8);
            assert!(near, "missed {t}: {found:?}");
        }
        crossings += want.len();
    }
    for hit in hits {
        let body = hit.body.expect("nothing is hard");
        let own = surfaces.iter().find(|surface| surface.body() == body);
        let value = own.map(|own| own.function().jet(hit.position).value);
        assert!((value.expect("it has a surface") - THRESHOLD).abs() < 1e-6);
    }
    crossings
}

#[test]
fn bodies_with_functions_are_seen_where_they_are() {
    let (mut crossings, mut of_functions) = (0, 0);
    for seed in 0..count(3) as u64 {
        let scene = with_functions(seed);
        let surfaces = scene.surfaces();
        let picture = Picture::new(&scene, [256; 2]);
        let picker = tracer::Picker::new(&scene);
        let rays = rays(&mut Random::new(seed * 2 + 9), 3);
        for (ray, hit) in rays.iter().zip(picture.cast(&rays)) {
            let hits = picture.hits(ray.0, ray.1);
            crossings += check_hits(&surfaces, &hits, *ray);
            for hit in &hits {
                let body = hit.body.expect("nothing is hard");
                let element = hit.element.expect("they are all of the scene") as usize;
                assert_eq!(scene.elements[element].body, body);
                let is_function = matches!(scene.elements[element].shape, Shape::Function(_));
                of_functions += usize::from(is_function);
            }
            let firsts = [hit, picker.pick(ray.0, ray.1)].map(|hit| hit.map(|hit| hit.t));
            for first in firsts {
                match (first, hits.first()) {
                    (Some(t), Some(hit)) => assert!((t - hit.t).abs() < 1e-3),
                    // A ray that grazes may be seen to meet or not.
                    (first, exact) => assert!(first.is_none() && exact.is_none(), "{seed}"),
                }
            }
        }
    }
    assert!(
        crossings > count(100) && of_functions > count(30),
        "{crossings} {of_functions}"
    );
}

#[test]
fn functions_are_the_same_at_any_size_and_place() {
    let mut crossings = 0;
    for seed in 0..count(4) as u64 {
        let plain = move_scene(&with_functions(seed), 1.0, DVec3::ZERO);
        let (scale, shift) = (1000.0, DVec3::new(3e4, -5.0, 7e3));
        let large = move_scene(&plain, scale, shift);
        let [plain, large] = [&plain, &large].map(|scene| Picture::new(scene, [64; 2]));
        for ray in rays(&mut Random::new(seed * 2 + 5), 4) {
            let here = plain.hits(ray.0, ray.1);
            let there = large.hits(ray.0 * scale + shift, ray.1);
            assert_eq!(here.len(), there.len());
            for (a, b) in here.iter().zip(&there) {
                assert!((a.t - b.t / scale).abs() < 1e-8);
                assert_eq!((a.body, a.element), (b.body, b.element));
            }
            crossings += here.len();
        }
    }
    assert!(crossings > count(60), "{crossings}");
}

/// Functions are drawn as their drafts if they are not drawn soft.
#[test]
fn functions_have_a_hard_form() {
    let mut scene = with_functions(1);
    scene.settings.soft = false;
    let picture = Picture::new(&scene, [64; 2]);
    let Shape::Function(function) = &scene.elements[5].shape else {
        panic!("no function");
    };
    let ball = function.draft().remove(0);
    let (center, radius) = (ball.middle(), ball.radius());
    let hits = picture.hits(center + 10.0 * DVec3::Z, DVec3::NEG_Z);
    assert!(hits.iter().any(|hit| (hit.t - 10.0 + radius).abs() < 1e-9));
}

/// Returns bodies of primitives and functions of which some touch, each pair with a bulge of its
/// own.
fn in_contact(seed: u64) -> Scene {
    let mut scene = with_functions(seed);
    let bulges = [
        contact::Bulge::default(),
        contact::Bulge::Height {
            c: 0.2,
            m: 0.65,
            h: 0.25,
        },
        contact::Bulge::Ripple {
            c: 0.2,
            h: 0.25,
            n: 2,
        },
    ];
    let bulge = bulges[seed as usize % 3];
    for bodies in [[0, 1], [1, 2], [0, 2]] {
        scene.contacts.push(scene::Contact { bodies, bulge });
    }
    scene
}

/// The crossings of all rays with bodies in contact are those that dense sampling finds: none is
/// missed and none invented.
#[test]
fn bodies_in_contact_are_seen_where_they_are() {
    let (mut crossings, mut shared) = (0, 0);
    for seed in 0..count(3) as u64 {
        let scene = in_contact(seed);
        let surfaces = scene.surfaces();
        assert!(
            surfaces
                .iter()
                .all(|surface| matches!(surface, scene::Surface::Composed(_)))
        );
        let picture = Picture::new(&scene, [256; 2]);
        for ray in rays(&mut Random::new(seed * 2 + 19), 3) {
            let hits = picture.hits(ray.0, ray.1);
            crossings += check_hits(&surfaces, &hits, ray);
            for pair in hits.windows(2) {
                if pair[1].t - pair[0].t < 1e-9 && pair[0].body != pair[1].body {
                    // One body is left before the other is entered.
                    assert!(pair[0].normal.dot(ray.1) >= 0.0, "{seed}");
                    assert!(pair[1].normal.dot(ray.1) <= 0.0, "{seed}");
                    shared += 1;
                }
            }
        }
    }
    assert!(
        crossings > count(75) && shared >= count(2),
        "{crossings} {shared}"
    );
}

/// The general path for a function that is no sum, judged by the reference.
#[test]
fn a_smooth_maximum_is_within_the_tolerance() {
    const LIMIT: f64 = 12.0;
    let wanted = count(400);
    let (mut seen, mut hits, mut uncertain, mut faults) = (0, 0, 0, Vec::new());
    for seed in 0.. {
        if seen >= wanted {
            break;
        }
        let mut scene = in_bodies(seed + 500, 6, 1);
        let parts = || <[_; 2]>::try_from(scene.soft_surfaces()).ok();
        let (Some(a), Some(b)) = (parts(), parts()) else {
            continue;
        };
        let k = [0.05, 0.3, 0.8][seed as usize % 3];
        let function = SmoothMaximum {
            parts: a.map(|surface| surface.sum),
            k,
        };
        let mut reference = Reference::smooth_maximum(b.map(|surface| surface.sum.primitives), k);
        for element in &mut scene.elements {
            element.finish = u32::MAX;
        }
        let mut picture = Picture::new(&scene, [256; 2]);
        picture.add_function(Arc::new(function), vec![0, 0]);
        let rays = rays(&mut Random::new(seed * 2 + 11), 3);
        for (&(origin, direction), hit) in rays.iter().zip(picture.cast(&rays)) {
            let t = hit.map(|hit| hit.t).filter(|t| *t < LIMIT);
            let verdict = reference.judge(origin, direction, t, LIMIT, |t| picture.tolerance(t));
            seen += 1;
            hits += usize::from(t.is_some());
            uncertain += usize::from(!verdict.certain);
            if let Some(fault) = verdict.fault {
                faults.push((seed, t, fault));
            }
        }
    }
    println!(
        "{seen} rays, {hits} hits, {uncertain} undecided, {} faults",
        faults.len()
    );
    assert!(faults.is_empty(), "{faults:?}");
    assert!(
        4 * hits > seen && 200 * uncertain <= seen,
        "{hits} {uncertain} of {seen}"
    );
}

/// Returns molecules of three balls spread through a cube, all in one body or each in one of its
/// own.
fn molecules(number: u32, apart: bool) -> Scene {
    let mut scene = trials::scenes::empty();
    trials::scenes::clothe(&mut scene, vec![trials::scenes::soft(4.0, 1.0)]);
    let mut numbers = Random::new(5);
    let radius = 0.7 / libm::cbrt(f64::from(number));
    for i in 0..number {
        let center = numbers.vector(1.0);
        let body = if apart { i } else { 0 };
        for around in [DVec3::X, DVec3::Y, DVec3::Z] {
            let shape = Shape::sphere(center + 0.5 * radius * around, 0.6 * radius);
            let element = Element {
                kernel: Kernel::Gauss,
                body,
                ..trials::scenes::element(shape, 0)
            };
            scene.elements.push(element);
        }
    }
    let bodies = if apart { number as usize } else { 1 };
    scene.bodies.resize(bodies, Body::default());
    scene
}

/// Thousands of bodies take about as long as one body of their elements. The goal is at most twice
/// as long (`cargo xtask bench models`); a test may be disturbed.
#[test]
fn very_many_bodies_take_as_long_as_one() {
    const SIDE: u32 = 96;
    let whole = Tile {
        x: 0,
        y: 0,
        width: SIDE,
        height: SIDE,
    };
    let scenes = [false, true].map(|apart| molecules(5000, apart));
    let (mut seconds, mut evaluations, mut lit) = ([f64::INFINITY; 2], [0; 2], [0; 2]);
    for _ in 0..5 {
        for (i, scene) in scenes.iter().enumerate() {
            let begun = std::time::Instant::now();
            let picture = Picture::new(scene, [SIDE; 2]);
            let mut stats = Stats::default();
            let pixels = picture.trace(whole, Pass::Full, &|| false, &mut stats);
            seconds[i] = seconds[i].min(begun.elapsed().as_secs_f64());
            evaluations[i] = stats.field_evaluations;
            let pixels = pixels.expect("nobody asked to stop");
            let background = pixels[..4].to_vec();
            lit[i] = pixels
                .chunks_exact(4)
                .filter(|p| **p != background[..])
                .count();
        }
    }
    println!("{seconds:?} s, {evaluations:?} evaluations, {lit:?} pixels");
    let [one, many] = lit;
    assert!(many > 2000 && one > 2000, "{lit:?} pixels show something");
    assert!(evaluations[1] <= 2 * evaluations[0], "{evaluations:?}");
    assert!(seconds[1] <= 3.0 * seconds[0], "{seconds:?}");
}

/// Returns parameters and bodies of the hits of rays that are traced in an order.
fn hits_in_order(
    (scene, seed): (&Scene, u64),
    rays: &[(DVec3, DVec3)],
    order: impl Iterator<Item = usize>,
) -> Vec<Vec<(u64, Option<u32>)>> {
    let mut picture = Picture::new(scene, [64; 2]);
    picture.add_function(Arc::new(implicit_mesh(seed)), vec![0]);
    let mut found = vec![Vec::new(); rays.len()];
    for i in order {
        let hits = picture.hits(rays[i].0, rays[i].1).into_iter();
        found[i] = hits.map(|hit| (hit.t.to_bits(), hit.body)).collect();
    }
    found
}

/// Cells are made by the rays that come first: hits must not depend on which these are.
#[test]
fn hits_do_not_depend_on_the_order_of_rays() {
    let mut hits = 0;
    for seed in 0..count(6) as u64 {
        let scene = match seed % 2 {
            0 => with_functions(seed),
            _ => in_contact(seed),
        };
        let rays = rays(&mut Random::new(seed), 12);
        let found = hits_in_order((&scene, seed), &rays, 0..rays.len());
        let reversed = hits_in_order((&scene, seed), &rays, (0..rays.len()).rev());
        assert_eq!(found, reversed);
        // Alone, each ray finds the same.
        for i in (0..rays.len()).step_by(7) {
            let alone = hits_in_order((&scene, seed), &rays, i..i + 1);
            assert_eq!(found[i], alone[i]);
        }
        hits += found.iter().map(Vec::len).sum::<usize>();
    }
    assert!(hits > count(300), "{hits}");
}

/// Returns the metaballs of triangles that are scattered about.
fn implicit_mesh(seed: u64) -> Metaballs {
    let random = &mut Random::new(seed);
    let mut corners = Vec::new();
    for _ in 0..60 + 40 * random.below(3) {
        let middle = random.vector(0.8);
        corners.extend([0; 3].map(|_| middle + random.vector(0.2)));
    }
    let triangles = (0..corners.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]);
    let triangles: Vec<[u32; 3]> = triangles.collect();
    let kinds = [
        (metaballs::Kind::Spherical, 40.0),
        (metaballs::Kind::Triangular { thickness: 0.02 }, 60.0),
        (metaballs::Kind::Triangular { thickness: 0.0 }, 10.0),
    ];
    let (kind, sharpness) = kinds[seed as usize % 3];
    Metaballs::new(&corners, &triangles, kind, sharpness).expect("a good mesh")
}

/// The crossings of rays with implicit meshes, whose cells have few facets, are those that dense
/// sampling of all facets finds: none is missed and none invented.
#[test]
fn implicit_meshes_are_seen_where_they_are() {
    let mut crossings = [0; 3];
    for seed in 0..count(6) as u64 {
        let function: Arc<dyn Implicit> = Arc::new(implicit_mesh(seed));
        let mut scene = blend(seed, 1);
        scene.elements[0].finish = u32::MAX;
        let mut picture = Picture::new(&scene, [64; 2]);
        let body = picture.add_function(function.clone(), vec![0]);
        for ray in rays(&mut Random::new(seed + 31), 1) {
            let hits = picture.hits(ray.0, ray.1).into_iter();
            let found = hits.filter(|hit| hit.body == Some(body));
            let found: Vec<f64> = found.map(|hit| hit.t).collect();
            let want = march(&*function, ray);
            for t in &want {
                let near = found.iter().any(|f| (f - t).abs() < 1e-8);
                assert!(near, "{seed}: missed {t}: {found:?}");
            }
            for t in &found {
                let sides = [-1e-7, 1e-7].map(|s| {
                    let place = ray.0 + ray.1 * (t + s);
                    function.jet(place).value >= THRESHOLD
                });
                // A grazing ray may have the same side on both ends.
                let value = function.jet(ray.0 + ray.1 * *t).value;
                let is_on = sides[0] != sides[1] || (value - THRESHOLD).abs() < 1e-9;
                assert!(is_on, "{seed}: invented {t}");
            }
            crossings[seed as usize % 3] += want.len();
        }
    }
    assert!(crossings.iter().all(|n| *n > count(8)), "{crossings:?}");
}
