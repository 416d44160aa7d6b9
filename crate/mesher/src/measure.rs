//! Distances between a mesh and a surface by samples: they check what is proved, and tell of what
//! is not.

use crate::certify::{Vertex, project_exactly};
use crate::forest::Cell;
use crate::improve::{Improved, may_be_unproved};
use crate::march::Raw;
use crate::options::{MeshError, Progress};
use crate::parallel::{LARGE, map_by, map_told};
use crate::refine::crossing;
use crate::space::Space;
use glam::DVec3;
use mesh::{Aabb, Bvh, closest_point};

/// Most triangles, and most places of the surface, that are looked at where proofs may fail: they
/// are spread evenly.
const MOST: usize = 1500;
/// Most of those anywhere.
const FEW: usize = 600;
/// Doublings of the distance in which a place of the surface is looked for.
const DOUBLINGS: usize = 10;
/// Halvings of the interval that contains it.
const HALVINGS: usize = 6;

/// The largest distances that samples found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measured {
    /// Of points of the mesh from the surface, and of points of the surface from the mesh.
    pub largest: [f64; 2],
    /// Numbers of those points.
    pub samples: [usize; 2],
}

impl Measured {
    /// Both measurements as one.
    #[must_use]
    pub fn with(&self, other: &Self) -> Self {
        Self {
            largest: [0, 1].map(|i| self.largest[i].max(other.largest[i])),
            samples: [0, 1].map(|i| self.samples[i] + other.samples[i]),
        }
    }

    /// One way of several, of distances that were found.
    pub fn add(&mut self, way: usize, distances: &[f64]) {
        for distance in distances.iter().filter(|distance| distance.is_finite()) {
            self.largest[way] = self.largest[way].max(*distance);
            self.samples[way] += 1;
        }
    }
}

/// Measures both distances: at places spread over the mesh and the surface, and more of them where
/// proofs may fail.
///
/// # Errors
/// If the caller cancels.
pub fn distances(
    space: &Space<'_>,
    raw: &Raw,
    improved: &Improved,
    tolerance: f64,
    threads: usize,
    progress: &mut Progress<'_>,
) -> Result<Measured, MeshError> {
    let mesh = &improved.mesh;
    let mut measured = Measured::default();
    let bvh = Bvh::new(&mesh.triangle_boxes());
    let from_mesh = |p: DVec3| {
        let square = |i: u32| closest_point(&mesh.corners(i as usize), p).distance_squared(p);
        root_of(bvh.nearest(p, f64::INFINITY, square))
    };

    // The surface: where the mesh was before it was improved, and what is near points of the cells
    // that it may cross.
    let is_open = |v: &&Vertex| may_be_unproved(&space.forest, v.position);
    let open: Vec<DVec3> = raw
        .vertices
        .iter()
        .filter(is_open)
        .map(|v| v.position)
        .collect();
    let mut places = spread(open.clone(), MOST);
    // Corners of lids are no places of the surface.
    let is_on = |v: &&Vertex| v.value.abs() <= tolerance * v.gradient.length();
    let all: Vec<DVec3> = raw
        .vertices
        .iter()
        .filter(is_on)
        .map(|v| v.position)
        .collect();
    places.extend(spread(all, FEW));
    let cells = crossing(&space.forest);
    let is_undecided = |node: &&u32| space.forest.cells[**node as usize].undecided;
    let undecided: Vec<u32> = cells.iter().filter(is_undecided).copied().collect();
    let mut cells = spread(cells, FEW);
    cells.extend(spread(undecided, MOST));
    let found = map_told(threads, &cells, progress, |node| {
        let cell = &space.forest.cells[*node as usize];
        let reach = space.forest.size(cell.level).length();
        let found = project_exactly(space, scattered(space, cell, *node), reach, tolerance)?;
        space
            .forest
            .contains(found.position)
            .then_some(found.position)
    })?;
    places.extend(found.into_iter().flatten());
    let back = map_told(threads, &places, progress, |p| from_mesh(*p))?;
    measured.add(1, &back);

    // The mesh: a few points of triangles.
    let of_kind = |is_unproved: bool| -> Vec<u32> {
        let all = (0..).zip(&improved.is_unproved);
        let own = all.filter(|(_, own)| **own == is_unproved).map(|(i, _)| i);
        own.collect()
    };
    let points: Vec<Aabb> = open.iter().map(|p| Aabb::of_points([*p])).collect();
    let points = Bvh::new(&points);
    let nearest = |p: DVec3| {
        let square = |i: u32| open[i as usize].distance_squared(p);
        root_of(points.nearest(p, f64::INFINITY, square))
    };
    let distance = |p: DVec3, normal: DVec3, size: f64, most: f64| {
        let at = Vertex::new(p, &space.jet_at(p));
        let uphill = at.gradient.normalize_or_zero();
        let toward = if at.value > 0.0 { -uphill } else { uphill };
        let first = (1.05 * at.value.abs() / at.gradient.length()).clamp(1e-9 * size, size);
        let ray = |direction: DVec3| along_ray(space, p, direction, first, most);
        // Near a kink the gradient may lead past a place of the surface that is nearer.
        let mut least = most;
        for direction in [toward, normal, -normal] {
            least = least.min(ray(direction).unwrap_or(most));
            if least <= tolerance {
                break;
            }
        }
        least
    };
    let sampled = |i: &u32, is_unproved: bool| {
        let [a, b, c] = mesh.corners(*i as usize);
        let size = a.distance(b).max(b.distance(c)).max(c.distance(a));
        let normal = (b - a).cross(c - a).normalize_or_zero();
        let points = [
            (a + b + c) / 3.0,
            a.midpoint(b),
            b.midpoint(c),
            c.midpoint(a),
        ];
        points.map(|p| {
            let most = if is_unproved {
                nearest(p)
            } else {
                f64::INFINITY
            };
            distance(p, normal, size, most)
        })
    };
    let unproved = spread(of_kind(true), MOST);
    let there = map_by(LARGE, threads, &unproved, progress, |i| sampled(i, true))?;
    measured.add(0, there.as_flattened());
    let proved: Vec<u32> = of_kind(false)
        .into_iter()
        .filter(|i| !improved.is_lid[*i as usize])
        .collect();
    let there = map_by(LARGE, threads, &spread(proved, FEW), progress, |i| {
        sampled(i, false)
    })?;
    measured.add(0, there.as_flattened());
    Ok(measured)
}

/// A point of a cell, another share of the way in each: by the fractions of multiples of three
/// irrational numbers.
fn scattered(space: &Space<'_>, cell: &Cell, node: u32) -> DVec3 {
    let share = (DVec3::new(0.819_172_513, 0.671_043_607, 0.549_700_478) * f64::from(node)).fract();
    space.forest.center(cell) + (share - 0.5) * space.forest.size(cell.level)
}

/// Some of many, spread evenly.
pub fn spread<T>(all: Vec<T>, most: usize) -> Vec<T> {
    let step = all.len().div_ceil(most).max(1);
    all.into_iter().step_by(step).collect()
}

/// Distance to a place of the surface on a ray, no nearer than it is; `None` if none was found
/// within the largest distance.
pub fn along_ray(
    space: &Space<'_>,
    from: DVec3,
    direction: DVec3,
    first: f64,
    most: f64,
) -> Option<f64> {
    let is_inside = |t: f64| {
        let point = from + direction * t;
        Vertex::new(point, &space.jet_at(point)).value > 0.0
    };
    let start = is_inside(0.0);
    let (mut low, mut high) = (0.0, first);
    for i in 0..DOUBLINGS {
        if is_inside(high) != start {
            // The first guess is not much too large.
            for _ in 0..if i == 0 { 0 } else { HALVINGS } {
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
pub fn root_of(found: Option<(u32, f64)>) -> f64 {
    found.map_or(f64::INFINITY, |(_, square)| square.sqrt())
}
