//! Pictures of local convolution and of folds in contact, against a search along the ray.

use contact::Bulge;
use field::{Implicit, Kernel, Local, THRESHOLD};
use glam::{DAffine3, DVec3};
use scene::{Contact, Curves, Element, Flesh, Form, Function, Scene, Shape};
use skeleton::{Node, Scheme, Skeleton};
use std::sync::Arc;
use tracer::Picture;
use trials::Random;
use trials::scenes::empty;

/// Returns a worm that folds and crosses itself, with or without contact of the folds.
fn worm(seed: u64, touching: bool) -> Scene {
    let mut numbers = Random::new(seed * 2 + 11);
    numbers.unit();
    let mut scene = empty();
    scene.flesh = vec![Flesh {
        radius: 0.22,
        kernel: [None, Some(Kernel::Cauchy)][seed as usize % 2],
        blobbiness: Some(2.0),
        ..Flesh::default()
    }];
    let mut nodes = Vec::new();
    for i in 0..7 {
        // To and fro.
        let x = [-0.7, 0.7][i % 2];
        let position = DVec3::new(x, 0.34 * (i as f64 - 3.0), 0.0) + numbers.vector(0.12);
        let radius = numbers.range(0.16, 0.24);
        nodes.push(Node { position, radius });
    }
    nodes.push(Node {
        position: numbers.vector(1.0),
        radius: 0.2,
    });
    let curves = vec![(0..7).collect(), vec![3, 7]];
    let skeleton = Skeleton { nodes, curves };
    let curves = Curves::new(skeleton, Scheme::Cubic, 2)
        .expect("it has curves")
        .within(0.9);
    scene.elements = vec![Element {
        flesh: Some(0),
        kernel: Kernel::Cubed,
        ..Element::new(Shape::Function(Box::new(Function {
            form: Form::Skeleton(Arc::new(curves)),
            to_world: DAffine3::IDENTITY,
        })))
    }];
    if touching {
        scene.contacts.push(Contact {
            bodies: [0, 0],
            bulge: Bulge::Fast { c: 0.4 },
        });
    }
    scene
}

/// Returns the first crossing of a ray, by small steps, and the least distance to the threshold
/// before it.
fn march(function: &dyn Implicit, (origin, direction): (DVec3, DVec3)) -> (Option<f64>, f64) {
    const STEP: f64 = 4e-3;
    let value = |t: f64| function.jet(origin + direction * t).value - THRESHOLD;
    let (mut t, mut nearest) = (2.0, f64::INFINITY);
    while t < 7.0 {
        let next = t + STEP;
        let here = value(next);
        if here >= 0.0 {
            let (mut low, mut high) = (t, next);
            for _ in 0..50 {
                let middle = 0.5 * (low + high);
                if value(middle) >= 0.0 {
                    high = middle;
                } else {
                    low = middle;
                }
            }
            return (Some(high), nearest);
        }
        nearest = nearest.min(-here);
        // Far outside steps may be longer: no field is steeper than that.
        t = if here < -0.7 { next + 6.0 * STEP } else { next };
    }
    (None, nearest)
}

#[test]
fn folds_are_seen_where_they_are() {
    let rays = trials::count(360);
    const SCENES: usize = 6;
    let (mut hits, mut grazing, mut worst) = (0, 0, 0.0f64);
    for seed in 0..SCENES {
        let scene = worm(seed as u64, seed % 3 > 0);
        let picture = Picture::new(&scene, [256; 2]);
        let surfaces = scene.surfaces();
        assert_eq!(surfaces.len(), 1);
        let function = surfaces[0].function();
        let mut numbers = Random::new(seed as u64 * 7 + 3);
        for _ in 0..rays.div_ceil(8 * SCENES) {
            let eye = numbers.direction() * 4.5;
            let to = numbers.vector(0.8);
            let packet: Vec<(DVec3, DVec3)> = (0..8)
                .map(|_| (eye, (to + numbers.vector(0.05) - eye).normalize()))
                .collect();
            for (ray, hit) in packet.iter().zip(picture.cast(&packet)) {
                let (want, nearest) = march(function, *ray);
                match (hit, want) {
                    (Some(hit), Some(t)) if (hit.t - t).abs() < 1e-5 => {
                        hits += 1;
                        worst = worst.max((hit.t - t).abs());
                    }
                    (None, None) => {}
                    // Between two steps the ray may have dipped into the surface.
                    (Some(hit), want) if nearest < 0.02 => {
                        let value = function.jet(hit.position).value - THRESHOLD;
                        assert!(
                            value.abs() < 1e-6 && want.is_none_or(|t| hit.t < t),
                            "{ray:?} {value}"
                        );
                        grazing += 1;
                    }
                    (hit, want) => panic!(
                        "{seed} {ray:?}: {:?} in place of {want:?}",
                        hit.map(|h| h.t)
                    ),
                }
            }
        }
    }
    println!("{hits} hits, {grazing} grazing, off by {worst:.1e}");
    assert!(hits * 4 > rays && grazing * 20 < hits, "{hits} {grazing}");
}

/// Returns the text of an example.
fn example(name: &str) -> String {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../www/examples");
    std::fs::read_to_string(format!("{folder}/{name}.rat")).expect(name)
}

/// Whether the field of other folds equals that of the folds themselves within a distance of a
/// point, to first order: where they press each other there is a crease.
fn is_crease(local: &Local, point: DVec3, distance: f64) -> bool {
    let (own, Some(other)) = local.two(point.to_array()) else {
        return false;
    };
    let [own_slope, other_slope] = [own, other].map(|jet| DVec3::from_array(jet.gradient));
    (own.value - other.value).abs() <= own_slope.distance(other_slope) * distance
}

/// Normals 10⁻⁵ radii apart differ by less than a degree: of folds with and without contact, of a
/// skeleton with eight arms and of five curves that meet. Where folds press each other there may be
/// a crease.
#[test]
fn normals_do_not_jump() {
    let star = "surface s, radius 0.2, kernel cauchy, blobbiness -2\n\
        skeleton s, STAR subdivide 3 local 0.6 {\n node O <0 0 0>\n node A <1 0 0.2>\n \
        node B <0.3 1 0>\n node C <-0.8 0.6 -0.3>\n node D <-0.8 -0.6 0.1>\n \
        node E <0.3 -1 0.2>\n curve O A curve O B curve O C curve O D curve O E }";
    let octopus = example("octopus").replace("subdivide 3 {", "subdivide 3 local 0.9 {");
    assert!(octopus.contains("local 0.9"));
    for (name, text, radius) in [
        ("folds", example("folds"), 0.23),
        ("coils", example("coils"), 0.3),
        ("octopus", octopus, 0.2),
        ("star", star.to_owned(), 0.2),
    ] {
        let compiled = rats::compile(&rats::Project::single(&text));
        let scene = &compiled.scene;
        let surfaces = scene.surfaces();
        let function = surfaces.last().expect(name).function();
        let (element, own, curves) = (scene.elements.iter())
            .filter_map(|element| match &element.shape {
                Shape::Function(own) => Some((element, own, own.curves()?)),
                _ => None,
            })
            .find(|(.., curves)| curves.local.is_some())
            .expect(name);
        let local = scene.local(element, own).expect(name).expect(name);
        let start = scene.contacts.first().map(|contact| contact.bulge.start());
        let local = start.map(|start| local.with_folds(start));
        let points: Vec<DVec3> = curves.points().map(|(point, _)| point).collect();
        let mut numbers = Random::new(31);
        let tries = trials::count(4000);
        let (mut worst, mut found, mut creases) = ((0.0, DVec3::ZERO), 0, 0);
        for _ in 0..tries {
            let mut point = numbers.pick(&points) + numbers.direction() * radius * 1.2;
            for _ in 0..8 {
                let jet = function.jet(point);
                let gradient = DVec3::from_array(jet.gradient);
                let step = gradient * ((THRESHOLD - jet.value) / gradient.length_squared());
                point += step.clamp_length_max(0.3 * radius);
            }
            if (function.jet(point).value - THRESHOLD).abs() > 1e-6 {
                continue;
            }
            let distance = 1e-5 * radius;
            let both = [point, point + numbers.direction() * distance];
            let normals = both.map(|p| DVec3::from_array(function.jet(p).gradient).normalize());
            let turn = normals[0].distance(normals[1]).to_degrees();
            found += 1;
            if local
                .as_ref()
                .is_some_and(|local| is_crease(local, point, distance))
            {
                creases += 1;
                continue;
            }
            if turn > worst.0 {
                worst = (turn, point);
            }
        }
        println!("{name}: {worst:?} of {found}, {creases} at creases");
        assert!(worst.0 < 1.0, "{name}: {worst:?} of {found}");
        assert!(
            2 * found > tries && 100 * creases < found,
            "{name}: {creases} of {found}"
        );
    }
}
