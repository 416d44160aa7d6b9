//! Local convolution and contact, as pictures show them, against the reference: no crossing missed, none invented.
//!
//! With SINEW_RAYS as many rays; then the table is printed with `--nocapture`.
#![cfg(not(target_arch = "wasm32"))]
mod common;

use common::{Numbers, empty};
use contact::Bulge;
use field::Kernel;
use glam::{DAffine3, DVec3};
use scene::{Body, Contact, Curves, Element, Flesh, Form, Function, Scene, Shape, Surface};
use skeleton::{Node, Scheme, Skeleton};
use std::sync::Arc;
use tracer::Picture;
use tracer::reference::{Deformation, Fault, Near, Reference, Substance, TouchingBody};

/// Kinds of scenes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// A skeleton whose folds do not blend.
    Folds,
    /// … and touch.
    SelfContact,
    /// Two bodies.
    Pair,
    /// Three to five bodies.
    Crowd,
    /// A folded skeleton that touches a ball, with its own folds in contact.
    Grasp,
}

const KINDS: [Kind; 5] = [
    Kind::Folds,
    Kind::SelfContact,
    Kind::Pair,
    Kind::Crowd,
    Kind::Grasp,
];

fn bulge(numbers: &mut Numbers, least: f64) -> Bulge {
    let c = numbers.between(least, 0.5);
    match (3.0 * numbers.unit()) as u32 {
        0 => Bulge::Fast { c },
        1 => Bulge::Height {
            c,
            m: 0.7,
            h: numbers.between(0.0, 0.25),
        },
        _ => Bulge::Ripple {
            c,
            h: numbers.between(0.0, 0.25),
            n: (3.0 * numbers.unit()) as u32,
        },
    }
}

/// The bulges written out once more.
fn deformation(bulge: Bulge) -> Deformation {
    let fall = |f: f64, m: f64, h: f64| {
        let w = 1.0 - m;
        let x = (f - m) / w;
        h + ((w - 3.0 * h) + (2.0 * h - w) * x) * x * x
    };
    let formula: Arc<dyn Fn(f64) -> f64 + Send + Sync> = match bulge {
        Bulge::Fast { c } => Arc::new(move |f| {
            let x = (f - c) / (1.0 - c);
            (1.0 - c) * x * x * (1.0 - x)
        }),
        Bulge::Height { c, m, h } => Arc::new(move |f| {
            let x = (f - c) / (m - c);
            if f < m {
                (3.0 - 2.0 * x) * x * x * h
            } else {
                fall(f, m, h)
            }
        }),
        Bulge::Ripple { c, h, n } => Arc::new(move |f| {
            let turns = f64::from(2 * n + 1);
            let m = c + (1.0 - c) * (1.0 - 1.0 / f64::from(4 * n + 3));
            let x = (f - c) / (m - c);
            let wave = (libm::cos((turns * x + 1.0) * core::f64::consts::PI) + 1.0) / 2.0;
            if f < m {
                (3.0 - 2.0 * x) * x * x * h * wave
            } else {
                fall(f, m, h)
            }
        }),
    };
    Deformation::new(bulge.start(), formula)
}

fn flesh(numbers: &mut Numbers, scene: &mut Scene) -> u32 {
    let kernels = [None, Some(Kernel::Cauchy), Some(Kernel::Gauss)];
    scene.flesh.push(Flesh {
        radius: numbers.between(0.15, 0.25),
        kernel: kernels[(3.0 * numbers.unit()) as usize],
        blobbiness: -numbers.between(1.0, 4.0),
        ..Flesh::default()
    });
    scene.flesh.len() as u32 - 1
}

/// A worm that goes to and fro, with a branch.
fn worm(numbers: &mut Numbers, scene: &mut Scene, body: u32) {
    let count = 5 + (3.0 * numbers.unit()) as usize;
    let mut nodes = Vec::new();
    for i in 0..count {
        let x = [-0.7, 0.7][i % 2];
        let y = 0.36 * (i as f64 - 0.5 * (count - 1) as f64);
        nodes.push(Node {
            position: DVec3::new(x, y, 0.0) + 0.12 * numbers.vector(),
            radius: numbers.between(0.14, 0.24),
        });
    }
    let mut curves = vec![(0..count as u32).collect::<Vec<u32>>()];
    if numbers.unit() < 0.5 {
        nodes.push(Node {
            position: numbers.vector(),
            radius: 0.2,
        });
        curves.push(vec![(count / 2) as u32, count as u32]);
    }
    let curves = curves
        .into_iter()
        .map(|c| c.into_iter().map(|i| i as _).collect());
    let skeleton = Skeleton {
        nodes,
        curves: curves.collect(),
    };
    let detail = 1 + (2.0 * numbers.unit()) as u32;
    let curves = Curves::new(skeleton, Scheme::Cubic, detail)
        .expect("it has curves")
        .within(numbers.between(0.7, 1.1));
    let flesh = flesh(numbers, scene);
    scene.elements.push(Element {
        flesh: Some(flesh),
        kernel: Kernel::Cubed,
        body,
        ..Element::new(Shape::Function(Box::new(Function {
            form: Form::Skeleton(Arc::new(curves)),
            to_world: DAffine3::IDENTITY,
        })))
    });
}

/// A ball or a limb of two segments.
fn lump(numbers: &mut Numbers, scene: &mut Scene, body: u32) {
    let flesh = flesh(numbers, scene);
    let at = |numbers: &mut Numbers| 0.6 * numbers.vector();
    let shapes = if numbers.unit() < 0.4 {
        vec![Shape::Sphere {
            center: at(numbers),
            radius: numbers.between(0.3, 0.6),
        }]
    } else {
        let [a, b, c] = [0; 3].map(|_| at(numbers));
        let radius = numbers.between(0.2, 0.35);
        [(a, b), (b, c)]
            .map(|(base, apex)| Shape::Cylinder { base, apex, radius })
            .to_vec()
    };
    for shape in shapes {
        scene.elements.push(Element {
            flesh: Some(flesh),
            body,
            ..Element::new(shape)
        });
    }
}

fn scene(kind: Kind, numbers: &mut Numbers) -> Scene {
    let mut scene = empty();
    let bodies = match kind {
        Kind::Folds | Kind::SelfContact => 1,
        Kind::Pair | Kind::Grasp => 2,
        Kind::Crowd => 3 + (3.0 * numbers.unit()) as u32,
    };
    scene.bodies.resize(bodies as usize, Body::default());
    for body in 0..bodies {
        match kind {
            Kind::Folds | Kind::SelfContact => worm(numbers, &mut scene, body),
            Kind::Grasp if body == 0 => worm(numbers, &mut scene, body),
            _ => lump(numbers, &mut scene, body),
        }
    }
    let all = bulge(numbers, 0.15);
    for a in 0..bodies {
        for b in 0..a {
            scene.contacts.push(Contact {
                bodies: [a, b],
                bulge: all,
            });
        }
    }
    if matches!(kind, Kind::SelfContact | Kind::Grasp) {
        scene.contacts.push(Contact {
            bodies: [0, 0],
            bulge: bulge(numbers, 0.3),
        });
    }
    scene
}

/// The scene as the reference knows it.
fn reference(scene: &Scene) -> Reference {
    let partners = scene.partners();
    let mut bodies = Vec::new();
    for surface in scene.surfaces_apart() {
        let body = surface.body();
        let substance = match &surface {
            Surface::Sum(soft) => Substance::Sum(soft.sum.primitives.clone()),
            Surface::Composed(_) => {
                let element = scene.elements.iter().find(|e| e.body == body);
                let element = element.expect("the body has one");
                let Shape::Function(function) = &element.shape else {
                    panic!("the body is a skeleton");
                };
                let limbs = scene.limbs(element, function).expect("it is a skeleton");
                Substance::Skeleton {
                    points: limbs.points,
                    limbs: limbs.limbs,
                    reach: limbs.reach,
                    fold: scene.fold(body).map(deformation),
                }
            }
        };
        assert_eq!(body as usize, bodies.len());
        let partners = partners.get(&body).into_iter().flatten();
        bodies.push(TouchingBody {
            substance,
            partners: partners
                .map(|(j, b)| (*j as usize, deformation(*b)))
                .collect(),
        });
    }
    let mut reference = Reference::touching(bodies).expect("the numbers are usable");
    reference.patience = 6000;
    reference
}

/// A packet of rays from outside.
fn packet(
    numbers: &mut Numbers,
    picture: &Picture,
    reference: &mut Reference,
) -> Vec<(DVec3, DVec3)> {
    let eye = numbers.vector().normalize() * 4.5;
    let aim = DVec3::new(0.8, 1.0, 0.3) * numbers.vector();
    let mut rays: Vec<(DVec3, DVec3)> = match (3.0 * numbers.unit()) as u32 {
        // Like neighbouring pixels.
        0 => {
            let spread = libm::pow(10.0, numbers.between(-3.0, -1.0));
            let to = |numbers: &mut Numbers| aim + spread * numbers.vector() - eye;
            (0..8).map(|_| (eye, to(numbers).normalize())).collect()
        }
        // Tangents, a little inside or outside.
        1 => {
            let ray = (eye, (aim - eye).normalize());
            let met = picture.cast(&[ray])[0];
            let Some(hit) = met else { return Vec::new() };
            let along = hit.normal.cross(numbers.vector()).normalize_or(DVec3::X);
            (0..8)
                .map(|i| {
                    let off = libm::pow(10.0, numbers.between(-6.0, -1.5));
                    let off = if i % 4 == 3 { off } else { -off };
                    (hit.position + hit.normal * off - along * 2.5, along)
                })
                .collect()
        }
        // Nothing to do with one another.
        _ => (0..8)
            .map(|_| {
                let from = numbers.vector().normalize() * 3.0;
                (from, (0.8 * numbers.vector() - from).normalize())
            })
            .collect(),
    };
    rays.retain(|(origin, _)| {
        reference.excess(*origin).0 < 0.0 && reference.surface_near(*origin, 1e-4) == Near::Beyond
    });
    rays
}

#[derive(Clone, Copy, Debug, Default)]
struct Row {
    rays: usize,
    hits: usize,
    missed: usize,
    grazed: usize,
    invented: usize,
    uncertain: usize,
}

/// Judges rays through scenes of a kind. With a fault that `spoil` makes, if it does.
fn judge(kind: Kind, rays: usize, first: u64, spoil: fn(&mut Option<f64>, usize)) -> Row {
    let mut row = Row::default();
    let mut seed = first;
    while row.rays < rays {
        let mut numbers = Numbers((seed * 8 + kind as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1);
        numbers.unit();
        let scene = scene(kind, &mut numbers);
        let picture = Picture::new(&scene, [256; 2]);
        let mut reference = reference(&scene);
        for _ in 0..12 {
            let rays = packet(&mut numbers, &picture, &mut reference);
            for (number, (ray, hit)) in rays.iter().zip(picture.cast(&rays)).enumerate() {
                let mut t = hit.map(|hit| hit.t);
                spoil(&mut t, number);
                let verdict = reference.judge(ray.0, ray.1, t, 9.0, |t| picture.tolerance(t));
                row.rays += 1;
                row.hits += usize::from(t.is_some());
                row.uncertain += usize::from(!verdict.certain);
                match verdict.fault {
                    None => continue,
                    Some(Fault::Missed { grazing: true, .. }) => row.grazed += 1,
                    Some(Fault::Missed { .. }) => row.missed += 1,
                    Some(Fault::Invented(_)) => row.invented += 1,
                }
                println!(
                    "{kind:?} seed {seed} {ray:?} hit {t:?}: {:?}",
                    verdict.fault
                );
            }
        }
        seed += 1;
    }
    println!("{kind:?} {row:?}");
    row
}

fn asked() -> usize {
    let asked = std::env::var("SINEW_RAYS").ok();
    asked.and_then(|n| n.parse().ok()).unwrap_or(1000)
}

fn certify(kinds: &[Kind]) {
    for &kind in kinds {
        let row = judge(kind, asked() / KINDS.len(), 0, |_, _| {});
        assert!(row.missed == 0 && row.invented == 0, "{kind:?} {row:?}");
        assert!(
            4 * row.hits > row.rays && 100 * row.uncertain <= row.rays,
            "{kind:?} {row:?}"
        );
    }
}

#[test]
fn folds_are_within_the_tolerance() {
    certify(&[Kind::Folds, Kind::SelfContact]);
}

#[test]
fn bodies_in_contact_are_within_the_tolerance() {
    certify(&[Kind::Pair, Kind::Crowd, Kind::Grasp]);
}

#[test]
fn faults_are_told() {
    for kind in [Kind::SelfContact, Kind::Pair, Kind::Grasp] {
        let near = |t: &mut Option<f64>, _: usize| *t = t.map(|t| t - 0.02);
        let row = judge(kind, 60, 900, near);
        assert!(2 * row.invented > row.hits, "{kind:?} {row:?}");
        let none = |t: &mut Option<f64>, number: usize| {
            if number.is_multiple_of(2) {
                *t = None;
            }
        };
        let row = judge(kind, 60, 950, none);
        // Of the rays that meet something about half.
        assert!(3 * row.missed > row.hits + row.missed, "{kind:?} {row:?}");
        let late = |t: &mut Option<f64>, _: usize| *t = t.map(|t| t + 0.05);
        let row = judge(kind, 60, 970, late);
        assert!(
            2 * (row.missed + row.invented) > row.hits,
            "{kind:?} {row:?}"
        );
    }
}
