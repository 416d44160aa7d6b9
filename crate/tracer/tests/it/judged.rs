//! Scenes of bodies, skeletons and contacts as the reference knows them, and verdicts on rays
//! through them.
use contact::Bulge;
use glam::DVec3;
use oracle::reference::{Deformation, Near, Reference, Substance, TouchingBody};
use scene::{Scene, Shape, Surface};
use std::sync::Arc;
use tracer::Picture;
use trials::Random;

/// Returns the formulas of bulges, written out once more.
pub fn deformation(bulge: Bulge) -> Deformation {
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

/// Returns a scene as the reference knows it: bodies of primitives, and bodies of one skeleton that
/// is convolved locally.
pub fn reference(scene: &Scene) -> Reference {
    let partners = scene.partners();
    let surfaces = scene.surfaces_apart();
    let mut bodies = Vec::new();
    for surface in &surfaces {
        let body = surface.body();
        let substance = match surface {
            Surface::Sum(soft) => Substance::Sum(soft.sum.primitives.clone()),
            Surface::Composed(composed) => {
                let [number] = composed.element[..] else {
                    panic!("body {body} is more than a skeleton");
                };
                let element = &scene.elements[number as usize];
                let Shape::Function(function) = &element.shape else {
                    panic!("body {body} is no skeleton");
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
        let others = partners.get(&body).into_iter().flatten();
        bodies.push(TouchingBody {
            substance,
            partners: others
                .filter_map(|(j, by)| {
                    let place = surfaces.iter().position(|surface| surface.body() == *j)?;
                    Some((place, deformation(*by)))
                })
                .collect(),
        });
    }
    let mut reference = Reference::touching(bodies).expect("the numbers are usable");
    reference.patience = 6000;
    reference
}

/// A box at which rays are aimed.
#[derive(Clone, Copy, Debug)]
pub struct Range {
    pub center: DVec3,
    /// Half the edges of the box.
    pub half: DVec3,
    /// Distance of eyes from the centre.
    pub far: f64,
}

/// Returns a packet of rays from outside.
pub fn packet(
    numbers: &mut Random,
    range: &Range,
    picture: &Picture,
    reference: &mut Reference,
) -> Vec<(DVec3, DVec3)> {
    let Range { center, half, far } = *range;
    let eye = center + numbers.direction() * far;
    let aim = center + half * numbers.vector(1.0);
    let mut rays: Vec<(DVec3, DVec3)> = match numbers.below(3) as u32 {
        // Like neighbouring pixels.
        0 => {
            let spread = numbers.decades(-3.0, -1.0) * half.max_element();
            (0..8)
                .map(|_| (eye, (aim + spread * numbers.vector(1.0) - eye).normalize()))
                .collect()
        }
        // Tangents, a little inside or outside.
        1 => {
            let ray = (eye, (aim - eye).normalize());
            let met = picture.cast(&[ray])[0];
            let Some(hit) = met else { return Vec::new() };
            let along = hit.normal.cross(numbers.vector(1.0)).normalize_or(DVec3::X);
            (0..8)
                .map(|i| {
                    let off = numbers.decades(-6.0, -1.5);
                    let off = if i % 4 == 3 { off } else { -off };
                    let off = off * half.max_element();
                    let back = 5.0 / 9.0 * far;
                    (hit.position + hit.normal * off - along * back, along)
                })
                .collect()
        }
        // Nothing to do with one another.
        _ => (0..8)
            .map(|_| {
                let from = center + numbers.direction() * (2.0 / 3.0 * far);
                let to = center + 0.8 * half.max_element() * numbers.vector(1.0);
                (from, (to - from).normalize())
            })
            .collect(),
    };
    rays.retain(|(origin, _)| is_outside(reference, *origin));
    rays
}

/// Whether a point is outside of all bodies, and not just so.
pub fn is_outside(reference: &mut Reference, point: DVec3) -> bool {
    reference.excess(point).0 < 0.0 && reference.surface_near(point, 1e-4) == Near::Beyond
}

/// Returns the distances of the first hits of rays in a picture.
pub fn distances(picture: &Picture, rays: &[(DVec3, DVec3)]) -> Vec<Option<f64>> {
    let hits = picture.cast(rays).into_iter();
    hits.map(|hit| hit.map(|hit| hit.t)).collect()
}
