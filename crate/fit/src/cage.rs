//! Control points around a mesh, and triangles between control points.

use core::cmp::Ordering;
use glam::DVec3;
use mesh::{Aabb, TriangleMesh};
use std::collections::BTreeSet;

/// Distance of control points from the mesh, outwards, as a share of the diagonal of its box.
const OUTSIDE: f64 = 0.03;
/// Neighbours of a control point that are looked at for triangles.
const NEAR: usize = 14;

/// Returns a control mesh around a mesh: of its vertices about `count` that are far from each
/// other, a little outside, with triangles where their parts of the surface meet. At most a third
/// of the vertices are taken.
///
/// ```
/// use fit::{cage, trial};
///
/// let head = trial::head(2000);
/// let cage = cage(&head.positions, &head.triangles, 60);
/// assert_eq!(cage.positions.len(), 60);
/// assert!(cage.triangles.len() > 80);
/// ```
#[must_use]
pub fn cage(positions: &[DVec3], triangles: &[[u32; 3]], count: usize) -> TriangleMesh {
    let normals = normals(positions, triangles);
    let mut used: Vec<u32> = triangles.iter().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    let bounds = Aabb::of_points(used.iter().map(|i| positions[*i as usize]));
    let count = count.min(used.len().div_ceil(3)).max(4).min(used.len());
    // The next one is the furthest from those before.
    let mut gaps: Vec<f64> = used
        .iter()
        .map(|i| -positions[*i as usize].distance_squared(bounds.center()))
        .collect();
    let mut owner = vec![0_u32; positions.len()];
    let mut chosen: Vec<u32> = Vec::new();
    while chosen.len() < count {
        let furthest = (1..used.len()).fold(0, |best, i| {
            let nearer = if chosen.is_empty() {
                gaps[i] < gaps[best]
            } else {
                gaps[i] > gaps[best]
            };
            if nearer { i } else { best }
        });
        if !chosen.is_empty() && gaps[furthest] <= 0.0 {
            break;
        }
        let center = positions[used[furthest] as usize];
        for (gap, i) in gaps.iter_mut().zip(&used) {
            let square = positions[*i as usize].distance_squared(center);
            if chosen.is_empty() || square < *gap {
                *gap = square;
                owner[*i as usize] = chosen.len() as u32;
            }
        }
        chosen.push(used[furthest]);
    }
    let shift = OUTSIDE * bounds.size().length();
    let controls: Vec<DVec3> = chosen
        .iter()
        .map(|i| positions[*i as usize] + normals[*i as usize] * shift)
        .collect();
    let mut seen = BTreeSet::new();
    let between = triangles.iter().filter_map(|triangle| {
        let corners = triangle.map(|i| owner[i as usize]);
        let mut key = corners;
        key.sort_unstable();
        let is_whole = key[0] < key[1] && key[1] < key[2];
        (is_whole && seen.insert(key)).then_some(corners)
    });
    let between: Vec<[u32; 3]> = between.collect();
    TriangleMesh::new(controls, between)
}

/// Unit normals of the vertices, outwards where the mesh is closed.
fn normals(positions: &[DVec3], triangles: &[[u32; 3]]) -> Vec<DVec3> {
    let mut normals = vec![DVec3::ZERO; positions.len()];
    let middle = Aabb::of_points(positions.iter().copied()).center();
    let mut volume = 0.0;
    for triangle in triangles {
        let [a, b, c] = triangle.map(|i| positions[i as usize]);
        let normal = (b - a).cross(c - a);
        volume += normal.dot(a - middle);
        for i in triangle {
            normals[*i as usize] += normal;
        }
    }
    let side = if volume < 0.0 { -1.0 } else { 1.0 };
    for normal in &mut normals {
        *normal = normal.normalize_or_zero() * side;
    }
    normals
}

/// Returns the [`NEAR`] points nearest to that of a number, with the squares of their distances.
fn nearest(points: &[DVec3], i: usize) -> Vec<(f64, u32)> {
    let mut near: Vec<(f64, u32)> = (0..)
        .zip(points)
        .filter(|(j, _)| *j as usize != i)
        .map(|(j, p)| (p.distance_squared(points[i]), j))
        .collect();
    if near.len() > NEAR {
        near.select_nth_unstable_by(NEAR, by_distance);
        near.truncate(NEAR);
    }
    near.sort_by(by_distance);
    near
}

/// Returns triangles between control points that stand anywhere: those of near neighbours whose
/// circumcircle's ball holds no other (Gabriel's), and, for a point without any, one with its two
/// nearest. None for fewer than three points.
///
/// ```
/// use glam::DVec3;
///
/// let square = [DVec3::ZERO, DVec3::X, DVec3::new(1.1, 1.1, 0.0), DVec3::Y];
/// assert_eq!(fit::web(&square), [[0, 1, 3], [1, 2, 3]]);
/// ```
#[must_use]
pub fn web(controls: &[DVec3]) -> Vec<[u32; 3]> {
    let mut found = BTreeSet::new();
    if controls.len() < 3 {
        return Vec::new();
    }
    let mut has_any = vec![false; controls.len()];
    for i in 0..controls.len() {
        let near = nearest(controls, i);
        for (at, (_, j)) in near.iter().enumerate() {
            for (_, k) in &near[..at] {
                let corners = [i as u32, *j, *k].map(|n| controls[n as usize]);
                let Some((center, square)) = circle(&corners) else {
                    continue;
                };
                let is_empty = near.iter().all(|(_, other)| {
                    other == j
                        || other == k
                        || controls[*other as usize].distance_squared(center)
                            >= square * (1.0 - 1e-9)
                });
                // Balls that reach beyond the neighbours may hold others.
                let furthest = near[near.len() - 1].0;
                if is_empty && (near.len() < NEAR || 4.0 * square <= furthest) {
                    let mut key = [i as u32, *j, *k];
                    key.sort_unstable();
                    key.iter().for_each(|n| has_any[*n as usize] = true);
                    found.insert(key);
                }
            }
        }
    }
    for (i, has) in has_any.iter().enumerate() {
        if !has && let [(_, j), (_, k), ..] = nearest(controls, i)[..] {
            let mut key = [i as u32, j, k];
            key.sort_unstable();
            found.insert(key);
        }
    }
    found.into_iter().collect()
}

/// Compares numbered things by their distance, then by their number.
pub(crate) fn by_distance(a: &(f64, u32), b: &(f64, u32)) -> Ordering {
    a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))
}

/// The circumcentre of a triangle and the square of its circumradius; `None` without area.
fn circle([a, b, c]: &[DVec3; 3]) -> Option<(DVec3, f64)> {
    let (u, v) = (*b - *a, *c - *a);
    let normal = u.cross(v);
    let square = normal.length_squared();
    if square <= 1e-18 * u.length_squared() * v.length_squared() {
        return None;
    }
    let arm = (normal.cross(u) * v.length_squared() + v.cross(normal) * u.length_squared())
        / (2.0 * square);
    Some((*a + arm, arm.length_squared()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trial;

    #[test]
    fn cage_is_outside_and_covers_the_mesh() {
        let head = trial::head(2000);
        let cage = cage(&head.positions, &head.triangles, 60);
        let bounds = Aabb::of_points(head.positions.iter().copied());
        let own = Aabb::of_points(cage.positions.iter().copied());
        assert!(own.min.cmple(bounds.min + 0.1).all() && own.max.cmpge(bounds.max - 0.1).all());
        // Every control has triangles, and they surround the mesh.
        let mut counts = [0; 60];
        for i in cage.triangles.iter().flatten() {
            counts[*i as usize] += 1;
        }
        assert!(counts.iter().all(|count| *count >= 3), "{counts:?}");
        assert!(crate::Deformation::new(&head.positions, &cage.positions).is_ok());
        // Few vertices give few controls.
        let few = trial::head(72);
        let cage = super::cage(&few.positions, &few.triangles, 60);
        assert!((8..30).contains(&cage.positions.len()));
    }

    #[test]
    fn web_of_a_ball_is_a_surface_and_of_anything_has_every_point() {
        let mut random = trials::Random::new(5);
        let ball: Vec<DVec3> = (0..80).map(|_| random.direction()).collect();
        let web = super::web(&ball);
        // A closed surface of 80 vertices has 156 triangles; a few are not Gabriel's.
        assert!((80..180).contains(&web.len()), "{}", web.len());
        let line: Vec<DVec3> = (0..9).map(|i| DVec3::X * f64::from(i)).collect();
        for points in [&ball[..], &line[..], &[DVec3::ZERO, DVec3::X, DVec3::Y][..]] {
            let web = super::web(points);
            assert!((0..points.len() as u32).all(|i| web.iter().flatten().any(|j| *j == i)));
        }
        assert!(super::web(&line[..2]).is_empty());
    }
}
