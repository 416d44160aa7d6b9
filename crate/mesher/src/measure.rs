//! Distances between a mesh and a surface by samples, where proofs fail.

use crate::certify::Vertex;
use crate::improve::{Improved, may_be_unproved};
use crate::march::Raw;
use crate::options::{MeshError, Progress};
use crate::parallel::map_told;
use crate::space::Space;
use glam::DVec3;
use mesh::{Aabb, Bvh, closest_point};

/// Most triangles, and most places of the surface, that are looked at: they are spread evenly.
const MOST: usize = 4000;
/// Doublings of the distance in which a place of the surface is looked for, from a hundredth of a triangle's size on.
const DOUBLINGS: usize = 10;
/// Halvings of the interval that contains it.
const HALVINGS: usize = 6;

/// The largest distance of samples of unproved triangles from the surface, and of places of the surface where proofs may fail from the
/// mesh; zeros if all is proved. Those places are the vertices of the mesh before it was improved.
///
/// # Errors
/// If the caller cancels.
pub fn distances(
    space: &Space<'_>,
    raw: &Raw,
    improved: &Improved,
    threads: usize,
    progress: &mut Progress<'_>,
) -> Result<[f64; 2], MeshError> {
    let mesh = &improved.mesh;
    let unproved = (0..).zip(&improved.is_unproved).filter(|(_, is)| **is);
    let unproved: Vec<u32> = unproved.map(|(i, _)| i).collect();
    if unproved.is_empty() {
        return Ok([0.0; 2]);
    }
    let unproved = spread(unproved);
    let is_near = |v: &&Vertex| may_be_unproved(&space.forest, v.position);
    let known = raw.vertices.iter().filter(is_near).map(|v| v.position);
    let all: Vec<DVec3> = known.collect();
    let known = spread(all.clone());
    let largest = |all: Vec<f64>| {
        let finite = all.into_iter().filter(|distance| distance.is_finite());
        finite.fold(0.0, f64::max)
    };
    let bvh = Bvh::new(&mesh.triangle_boxes());
    let back = map_told(threads, &known, progress, |p| {
        let square = |i: u32| closest_point(&mesh.corners(i as usize), *p).distance_squared(*p);
        root_of(bvh.nearest(*p, f64::INFINITY, square))
    })?;
    let points: Vec<Aabb> = all.iter().map(|p| Aabb::of_points([*p])).collect();
    let points = Bvh::new(&points);
    let nearest = |p: DVec3| {
        let square = |i: u32| all[i as usize].distance_squared(p);
        root_of(points.nearest(p, f64::INFINITY, square))
    };
    let there = map_told(threads, &unproved, progress, |i| {
        let [a, b, c] = mesh.corners(*i as usize);
        let size = a.distance(b).max(b.distance(c)).max(c.distance(a));
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let samples = [
            (a + b + c) / 3.0,
            a.midpoint(b),
            b.midpoint(c),
            c.midpoint(a),
        ];
        let distance = |p: DVec3| {
            let at = Vertex::new(p, &space.jet_at(p));
            let uphill = at.gradient.normalize_or_zero();
            let toward = if at.value > 0.0 { -uphill } else { uphill };
            let most = nearest(p);
            let ray = |direction: DVec3| along_ray(space, p, direction, size, most);
            let found = ray(toward).or_else(|| ray(normal)).or_else(|| ray(-normal));
            found.unwrap_or(most).min(most)
        };
        samples.map(distance).into_iter().fold(0.0, f64::max)
    })?;
    Ok([largest(there), largest(back)])
}

/// Some of many, spread evenly.
fn spread<T>(all: Vec<T>) -> Vec<T> {
    let step = all.len().div_ceil(MOST).max(1);
    all.into_iter().step_by(step).collect()
}

/// Distance to a place of the surface on a ray, no nearer than it is; `None` if none was found within the largest distance.
fn along_ray(
    space: &Space<'_>,
    from: DVec3,
    direction: DVec3,
    size: f64,
    most: f64,
) -> Option<f64> {
    let is_inside = |t: f64| {
        let point = from + direction * t;
        Vertex::new(point, &space.jet_at(point)).value > 0.0
    };
    let start = is_inside(0.0);
    let (mut low, mut high) = (0.0, 0.01 * size);
    for _ in 0..DOUBLINGS {
        if is_inside(high) != start {
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                *(if is_inside(middle) == start {
                    &mut low
                } else {
                    &mut high
                }) = middle;
            }
            return Some(high);
        }
        (low, high) = (high, 2.0 * high);
        if low > most {
            return None;
        }
    }
    None
}

/// The distance that a search found; infinite if there was nothing.
fn root_of(found: Option<(u32, f64)>) -> f64 {
    found.map_or(f64::INFINITY, |(_, square)| square.sqrt())
}
