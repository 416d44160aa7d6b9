//! Lines of sight that graze the surface: the points at which a silhouette holds it.

use crate::field::{Field, Gradient};
use glam::DVec3;
use mesh::{Bvh, Ray};
use serde::{Deserialize, Serialize};

/// Line of sight through a point of an outline.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sight {
    /// The eye.
    pub origin: DVec3,
    /// Unit vector.
    pub direction: DVec3,
}

/// Steps of a search along a line: the interval shrinks to 0.618ⁿ.
const SECTIONS: u32 = 24;

impl Sight {
    fn at(&self, t: f64) -> DVec3 {
        self.origin + self.direction * t
    }

    /// Returns the point of the line at which the surface should touch it: where the line passes
    /// the mesh by, the point with the largest field; where it goes through, the one with the
    /// smallest within the shortest piece inside. There the field's gradient is perpendicular to
    /// the line. `None` if the mesh is nowhere near the line's front.
    pub(crate) fn touch(&self, field: &Field<'_>, bvh: &Bvh) -> Option<DVec3> {
        let mut crossings = Vec::new();
        let ray = Ray::new(self.origin, self.direction);
        bvh.along_ray(&ray, f64::INFINITY, |facet, far| {
            crossings.extend(self.crossing(&field.corners(facet)));
            far
        });
        crossings.sort_by(f64::total_cmp);
        // An edge or vertex is met once, though it belongs to several facets.
        let size = bvh.bounds().size().length();
        crossings.dedup_by(|a, b| (*a - *b).abs() < 1e-9 * size);
        let inside = crossings.chunks_exact(2).map(|pair| [pair[0], pair[1]]);
        let shortest = inside.min_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])));
        let mut gradient = Gradient::new();
        let mut distance = |t: f64| field.distance(self.at(t), &mut gradient);
        if let Some([enter, leave]) = shortest {
            let t = section(enter, leave, |t| -distance(t));
            return Some(self.at(t));
        }
        let (nearest, gap) = self.nearest(field, bvh)?;
        let reach = 0.5 * gap + 0.01 * size;
        Some(self.at(section(nearest - reach, nearest + reach, distance)))
    }

    /// The parameter at which the line crosses a triangle; `None` if it does not.
    fn crossing(&self, [a, b, c]: &[DVec3; 3]) -> Option<f64> {
        let (side_b, side_c) = (*b - *a, *c - *a);
        let p = self.direction.cross(side_c);
        let volume = side_b.dot(p);
        if volume == 0.0 {
            return None;
        }
        let offset = self.origin - *a;
        let u = offset.dot(p) / volume;
        let q = offset.cross(side_b);
        let v = self.direction.dot(q) / volume;
        let t = side_c.dot(q) / volume;
        (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0).then_some(t)
    }

    /// The parameter > 0 at which the line comes nearest to an edge of the mesh, and their
    /// distance.
    fn nearest(&self, field: &Field<'_>, bvh: &Bvh) -> Option<(f64, f64)> {
        let mut best: Option<(f64, f64)> = None;
        bvh.descend(|_, bounds, facets| {
            let offset = bounds.center() - self.origin;
            let across = offset - self.direction * offset.dot(self.direction);
            let least = across.length() - 0.5 * bounds.size().length();
            if best.is_some_and(|(_, gap)| least > gap) {
                return false;
            }
            for facet in facets {
                let [a, b, c] = field.corners(*facet);
                for (from, to) in [(a, b), (b, c), (c, a)] {
                    let (t, gap) = self.beside(from, to);
                    if t > 0.0 && best.is_none_or(|(_, least)| gap < least) {
                        best = Some((t, gap));
                    }
                }
            }
            true
        });
        best
    }

    /// The parameter at which the line is nearest to a segment, and their distance.
    fn beside(&self, from: DVec3, to: DVec3) -> (f64, f64) {
        let [start, way] =
            [from - self.origin, to - from].map(|v| v - self.direction * v.dot(self.direction));
        let square = way.length_squared();
        let s = if square > 0.0 {
            (-start.dot(way) / square).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let t = (from + (to - from) * s - self.origin).dot(self.direction);
        (t, (start + way * s).length())
    }
}

/// Returns the place of the least value between two places, by golden sections: a local one where
/// there are several.
fn section(mut low: f64, mut high: f64, mut value: impl FnMut(f64) -> f64) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_8;
    let mut inner = [high - GOLDEN * (high - low), low + GOLDEN * (high - low)];
    let mut values = inner.map(&mut value);
    for _ in 0..SECTIONS {
        if values[0] <= values[1] {
            high = inner[1];
            inner = [high - GOLDEN * (high - low), inner[0]];
            values = [value(inner[0]), values[0]];
        } else {
            low = inner[0];
            inner = [inner[1], low + GOLDEN * (high - low)];
            values = [values[1], value(inner[1])];
        }
    }
    if values[0] <= values[1] {
        inner[0]
    } else {
        inner[1]
    }
}
