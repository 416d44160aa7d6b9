//! A planar polygon with holes.
use super::{Geometry, Map, Skeleton, ball_around, nearest_of, segment};
use crate::Kernel;
use crate::bone::{self, Bone};
use crate::term::{Frame, frame};
use glam::{DMat3, DVec3};

/// Most corners among the samples.
const MOST_SAMPLES: usize = 16;

pub(super) struct Polygon<'a> {
    pub rings: &'a [Vec<DVec3>],
}

impl Polygon<'_> {
    fn outer(&self) -> &[DVec3] {
        self.rings.first().map_or(&[], Vec::as_slice)
    }
}

impl Geometry for Polygon<'_> {
    fn name(&self) -> &'static str {
        "polygon"
    }

    fn dimension(&self) -> u8 {
        2
    }

    fn measure(&self) -> f64 {
        (area_vector(self.rings).length() / 2.0).abs()
    }

    fn nearest(&self, point: DVec3) -> DVec3 {
        let n = area_vector(self.rings).try_normalize();
        let foot = n.zip(self.outer().first());
        let inside = foot
            .map(|(n, o)| point - n * (point - *o).dot(n))
            .filter(|q| n.is_some_and(|n| is_inside(self.rings, n, *q)));
        let on_edges = edges(self.rings).map(|(p, q)| segment::nearest(point, p, q));
        nearest_of(point, on_edges.chain(inside)).unwrap_or(DVec3::ZERO)
    }

    fn bounding_sphere(&self) -> Option<(DVec3, f64)> {
        Some(ball_around(self.rings.iter().flatten()))
    }

    /// The mean of the outer corners.
    fn middle(&self) -> DVec3 {
        let outer = self.outer();
        outer.iter().sum::<DVec3>() / outer.len().max(1) as f64
    }

    fn landmarks(&self) -> Vec<(DVec3, &'static str)> {
        let corners = self.rings.iter().flatten();
        corners.map(|corner| (*corner, "a corner")).collect()
    }

    fn fault(&self) -> Option<&'static str> {
        let outer = self.outer();
        let reach = outer.iter().map(|p| p.distance(outer[0]));
        let longest = reach.fold(0.0, f64::max);
        let area = ring_vector(outer).length();
        let has_area = outer.len() >= 3 && area > 1e-12 * longest * longest;
        (!has_area).then_some(" has no area")
    }

    fn normal(&self) -> Option<DVec3> {
        ring_vector(self.outer()).try_normalize()
    }

    fn samples(&self) -> Vec<DVec3> {
        let corners = self.rings.iter().flatten();
        corners.copied().take(MOST_SAMPLES).collect()
    }

    fn lines(&self, _: f64) -> Vec<Vec<DVec3>> {
        self.rings.iter().map(|ring| close(ring)).collect()
    }

    fn transform(&self, map: &dyn Map) -> Skeleton {
        let rings = self.rings.iter();
        let moved = rings.map(|ring| ring.iter().map(|p| map.point(*p)).collect());
        Skeleton::Polygon {
            rings: moved.collect(),
        }
    }

    fn place(&self, _: Kernel, s: f64) -> (Frame<f64>, Bone<f64>) {
        let z = area_vector(self.rings).try_normalize().unwrap_or(DVec3::Z);
        let x = z.any_orthonormal_vector();
        let axes = DMat3::from_cols(x, z.cross(x), z);
        let corners: Vec<DVec3> = self.rings.iter().flatten().copied().collect();
        let origin = corners.iter().sum::<DVec3>() / corners.len().max(1) as f64;
        let flat = self.rings.iter().map(|ring| {
            let local = ring.iter().map(|p| axes.transpose() * (*p - origin) * s);
            local.map(|local| [local.x, local.y]).collect()
        });
        (
            frame(origin, axes, s),
            Bone::Polygon(Box::new(bone::Polygon::new(flat.collect()))),
        )
    }
}

/// Returns the corners of a ring, and the first one again.
pub(super) fn close(ring: &[DVec3]) -> Vec<DVec3> {
    ring.iter().chain(ring.first()).copied().collect()
}

/// The edges of all rings.
fn edges(rings: &[Vec<DVec3>]) -> impl Iterator<Item = (DVec3, DVec3)> {
    rings
        .iter()
        .flat_map(|ring| (0..ring.len()).map(|i| (ring[i], ring[(i + 1) % ring.len()])))
}

/// Normal of a polygon, twice as long as its area is large: of the outer ring less the holes, which
/// may run either way round.
#[must_use]
pub fn area_vector(rings: &[Vec<DVec3>]) -> DVec3 {
    let Some((outer, holes)) = rings.split_first() else {
        return DVec3::ZERO;
    };
    let whole = ring_vector(outer);
    holes.iter().fold(whole, |sum, hole| {
        let hole = ring_vector(hole);
        if hole.dot(whole) > 0.0 {
            sum - hole
        } else {
            sum + hole
        }
    })
}

/// Normal of a ring, twice as long as its area is large.
#[must_use]
pub fn ring_vector(ring: &[DVec3]) -> DVec3 {
    let o = ring.first().copied().unwrap_or_default();
    ring.windows(2).map(|w| (w[0] - o).cross(w[1] - o)).sum()
}

/// Whether a point of the polygon's plane lies inside: an odd number of edges crosses a line from
/// it.
fn is_inside(rings: &[Vec<DVec3>], normal: DVec3, point: DVec3) -> bool {
    let x = normal.any_orthonormal_vector();
    let y = normal.cross(x);
    let mut inside = false;
    for (a, b) in edges(rings) {
        let (a, b) = (a - point, b - point);
        let (ay, by) = (a.dot(y), b.dot(y));
        if (ay > 0.0) != (by > 0.0) && a.dot(x) + (b - a).dot(x) * (ay / (ay - by)) > 0.0 {
            inside = !inside;
        }
    }
    inside
}
