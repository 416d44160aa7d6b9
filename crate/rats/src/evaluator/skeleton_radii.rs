//! Radii of a file at which the surface cannot stand, in words.

use super::state::Evaluator;
use crate::reader::Name;
use field::{Primitive, Shaping, THRESHOLD, Taper};
use glam::DVec3;
use limbs::{Graph, Limb};

/// Limbs of a file that are measured, evenly taken from all.
const MOST_MEASURED: usize = 32;
/// Least length of these in radii, so that what blends at their nodes does not reach their middles.
const LONG: f64 = 6.0;
/// Share of its radius by which a surface may miss it unsaid, and share of limbs that may.
const CLOSE: f64 = 0.05;
/// Distance in radii of a limb beyond which others do not count at its middle.
const NEAR: f64 = 12.0;
/// Largest radius that is looked for, in that of the limb.
const FARTHEST: f64 = 4.0;

/// Result of a measurement at the middle of a limb.
enum Verdict {
    /// The surface stands at the radius.
    Kept,
    /// Share of the radius at which it stands.
    Missed(f64),
    /// Limbs that lie around it on all sides.
    Crowded,
}

/// Says so where the surface does not stand at the radii of long limbs at their middles: by which
/// factor it misses them, or how many lie within others.
pub(super) fn tell(run: &mut Evaluator<'_>, graph: &Graph, shapings: &[Shaping], file: &Name<'_>) {
    let long: Vec<usize> = (0..graph.limbs.len())
        .filter(|i| graph.length(*i) >= LONG * thickness(&graph.limbs[*i]))
        .collect();
    let step = long.len().div_ceil(MOST_MEASURED).max(1);
    let (mut crowded, mut ratios, mut all) = (0, Vec::new(), 0);
    for limb in long.into_iter().step_by(step) {
        all += 1;
        match measure(graph, shapings, limb) {
            Verdict::Kept => {}
            Verdict::Missed(ratio) => ratios.push(ratio),
            Verdict::Crowded => crowded += 1,
        }
    }
    let few = CLOSE * f64::from(all);
    if ratios.len() as f64 > few {
        ratios.sort_by(f64::total_cmp);
        let (count, middle) = (ratios.len(), ratios[ratios.len() / 2]);
        let message = format!(
            "{}: at the middles of {count} of {all} long limbs the surface stands at {middle:.2} \
             of the file's radius, which this kernel and blobbiness do not keep",
            file.text
        );
        let hint = "it stands there with `kernel compact6, blobbiness -8`, or a larger blobbiness";
        run.note(&file.span, message, hint);
    } else if f64::from(crowded) > few {
        let message = format!(
            "{}: {crowded} of {all} long limbs lie within others at their middles, where the \
             surface is as thick as all of them",
            file.text
        );
        run.note(&file.span, message, "");
    }
}

/// Returns the larger radius of a limb.
fn thickness(limb: &Limb) -> f64 {
    limb.radii[0].max(limb.radii[1])
}

/// Measures where the surface stands at the middle of a limb, in four directions across it.
fn measure(graph: &Graph, shapings: &[Shaping], limb: usize) -> Verdict {
    let [start, end] = ends(graph, &graph.limbs[limb]);
    let middle = 0.5 * (start + end);
    let radius = 0.5 * (graph.limbs[limb].radii[0] + graph.limbs[limb].radii[1]);
    let mut field = Vec::new();
    let mut others = Vec::new();
    for (own, i) in graph.limbs.iter().zip(0..) {
        let [base, apex] = ends(graph, own);
        if distance(middle, [base, apex]).0 > NEAR * radius.max(thickness(own)) {
            continue;
        }
        field.extend(primitive(
            [base, apex],
            own.radii,
            &shapings[own.group as usize],
        ));
        if i != limb {
            others.push(own);
        }
    }
    let Some(axis) = (end - start).try_normalize() else {
        return Verdict::Kept;
    };
    let (u, v) = axis.any_orthonormal_pair();
    let free: Vec<DVec3> = [u, v, -u, -v]
        .into_iter()
        .filter(|way| {
            let place = middle + *way * (radius * (1.0 + CLOSE));
            others.iter().all(|other| {
                let (far, at) = distance(place, ends(graph, other));
                far > other.radii[0] + (other.radii[1] - other.radii[0]) * at
            })
        })
        .collect();
    if free.is_empty() {
        return Verdict::Crowded;
    }
    let mut ratios: Vec<f64> = free
        .into_iter()
        .map(|way| find_surface(&field, middle, way * radius))
        .collect();
    ratios.sort_by(f64::total_cmp);
    let ratio = ratios[ratios.len() / 2];
    match (ratio - 1.0).abs() < CLOSE {
        true => Verdict::Kept,
        false => Verdict::Missed(ratio),
    }
}

/// Whether a place is within the surface of a field.
fn is_inside(field: &[Primitive], place: DVec3) -> bool {
    let parts = field.iter().map(|part| part.value::<f64>(place.to_array()));
    parts.sum::<f64>() >= THRESHOLD
}

/// Finds the share of a step at which one leaves the surface, by bisection; 1 if it is close to it.
fn find_surface(field: &[Primitive], from: DVec3, step: DVec3) -> f64 {
    let [before, behind] =
        [1.0 - CLOSE, 1.0 + CLOSE].map(|share| is_inside(field, from + step * share));
    let (mut low, mut high) = match (before, behind) {
        (true, false) => return 1.0,
        (false, _) => (0.0, 1.0 - CLOSE),
        (true, true) => (1.0 + CLOSE, FARTHEST),
    };
    for _ in 0..20 {
        let middle = 0.5 * (low + high);
        match is_inside(field, from + step * middle) {
            true => low = middle,
            false => high = middle,
        }
    }
    low
}

/// Returns the places of a limb's ends.
fn ends(graph: &Graph, limb: &Limb) -> [DVec3; 2] {
    limb.ends.map(|end| graph.nodes[end as usize].position)
}

/// Returns the distance of a place from a segment, and the share of its length at the nearest
/// point.
fn distance(place: DVec3, [base, apex]: [DVec3; 2]) -> (f64, f64) {
    let along = apex - base;
    let share = (place - base).dot(along) / along.length_squared();
    let at = share.clamp(0.0, 1.0);
    (place.distance(base + along * at), at)
}

/// Returns the field of a limb; of one that would be integrated piece by piece as if it had its
/// mean radius all along.
fn primitive([base, apex]: [DVec3; 2], radii: [f64; 2], shaping: &Shaping) -> Option<Primitive> {
    let skeleton = field::Skeleton::Segment { base, apex };
    let cone = Shaping {
        radius: radii[0],
        taper: Some(Taper {
            radius: radii[1],
            blobbiness: shaping.blobbiness,
        }),
        ..*shaping
    };
    let even = Shaping {
        radius: 0.5 * (radii[0] + radii[1]),
        taper: None,
        ..*shaping
    };
    let is_cone = radii[0] != radii[1] && cone.is_cone(&skeleton);
    Primitive::new(skeleton, if is_cone { &cone } else { &even }, None)
}
