//! The distance of points from a mesh as a fit sees it, with derivatives by the mesh's vertices.

use crate::error::Error;
use core::cell::Cell;
use field::Real;
use glam::{DMat3, DVec3};
use mesh::{Aabb, Bvh};
use metaballs::{Metaballs, Nearest, circumcircle, nearest, profile};
use serde::{Deserialize, Serialize};

/// Surface that stands for a mesh in a fit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Kind {
    /// The facets themselves.
    Explicit,
    /// The implicit surface of balls around the facets.
    Spherical,
    /// The implicit surface of shells of a thickness around the facets.
    Triangular {
        /// The thickness, ≥ 0.
        thickness: f64,
    },
}

/// Mesh at one moment of a fit.
#[derive(Debug)]
pub(crate) struct Field<'a> {
    pub positions: &'a [DVec3],
    pub triangles: &'a [[u32; 3]],
    form: Form,
}

#[derive(Debug)]
enum Form {
    Explicit(Bvh),
    Shells {
        bvh: Bvh,
        thickness: f64,
        sharpness: f64,
    },
    Balls(Box<Metaballs>),
}

/// Facets are left out where they add less than e^−this times as much as the nearest one.
const FAINT: f64 = 14.0;

/// The derivative of a distance: vertices and how it grows when they move.
pub(crate) type Gradient = Vec<(u32, DVec3)>;

impl<'a> Field<'a> {
    /// Prepares a mesh; k is the sharpness of implicit surfaces.
    pub fn new(
        positions: &'a [DVec3],
        triangles: &'a [[u32; 3]],
        kind: Kind,
        k: f64,
    ) -> Result<Self, Error> {
        let boxes = triangles
            .iter()
            .map(|t| Aabb::of_points(t.map(|i| positions[i as usize])));
        let form = match kind {
            Kind::Explicit => Form::Explicit(Bvh::new(&boxes.collect::<Vec<_>>())),
            Kind::Triangular { thickness } => Form::Shells {
                bvh: Bvh::new(&boxes.collect::<Vec<_>>()),
                thickness,
                sharpness: k,
            },
            Kind::Spherical => Metaballs::new(positions, triangles, metaballs::Kind::Spherical, k)
                .map(|made| Form::Balls(Box::new(made)))
                .map_err(|error| Error(error.to_string()))?,
        };
        Ok(Self {
            positions,
            triangles,
            form,
        })
    }

    pub fn corners(&self, triangle: u32) -> [DVec3; 3] {
        self.triangles[triangle as usize].map(|i| self.positions[i as usize])
    }

    /// Returns the unit normal of a facet; 0 without area.
    pub fn normal(&self, triangle: u32) -> DVec3 {
        let [a, b, c] = self.corners(triangle);
        (b - a).cross(c - a).normalize_or_zero()
    }

    /// Returns the distance of a point from the surface and sets its derivative: of an explicit
    /// mesh the distance from the nearest facet, of an implicit one `−ln F/k`, which is d − ρ where
    /// a single facet counts. Infinite, without a derivative, where no facet acts.
    pub fn distance(&self, point: DVec3, gradient: &mut Gradient) -> f64 {
        self.distance_near(point, &Cell::new(u32::MAX), gradient)
    }

    /// Returns the distance of a point as [`Self::distance`] does. `facet` holds the number of a
    /// facet that was nearest before, or another number, and gets the present one: with it a search
    /// among the facets need not go farther than that one.
    pub fn distance_near(&self, point: DVec3, facet: &Cell<u32>, gradient: &mut Gradient) -> f64 {
        gradient.clear();
        match &self.form {
            Form::Balls(balls) => self.distance_from_balls(balls, point, gradient),
            Form::Explicit(_) => {
                let Some((facet, square)) = self.nearest(point, facet) else {
                    return f64::INFINITY;
                };
                let found = nearest(&self.corners(facet), point);
                self.pull(facet, &found, point, 1.0, gradient);
                square.sqrt()
            }
            Form::Shells {
                bvh,
                thickness,
                sharpness: k,
            } => {
                let Some((_, square)) = self.nearest(point, facet) else {
                    return f64::INFINITY;
                };
                // −ln Σ e^−k(d − ρ) = k(d₀ − ρ) − ln Σ e^−k(d − d₀), d₀ the least distance.
                let least = square.sqrt();
                let reach = least + FAINT / k;
                let around = Aabb {
                    min: point - reach,
                    max: point + reach,
                };
                let mut sum = 0.0;
                for facet in bvh.overlapping(&around) {
                    let found = nearest(&self.corners(facet), point);
                    let beyond = k * (found.point.distance(point) - least);
                    if beyond < FAINT {
                        let value = Real::exp(-beyond);
                        sum += value;
                        self.pull(facet, &found, point, value, gradient);
                    }
                }
                for (_, way) in gradient {
                    *way /= sum;
                }
                least - thickness - Real::ln(sum) / k
            }
        }
    }

    /// Returns the facet that is nearest to a point, and the square of the distance; `known` is as
    /// in [`Self::distance_near`]. `None` of balls.
    pub fn nearest(&self, point: DVec3, known: &Cell<u32>) -> Option<(u32, f64)> {
        let (Form::Explicit(bvh) | Form::Shells { bvh, .. }) = &self.form else {
            return None;
        };
        let square = |i| {
            nearest(&self.corners(i), point)
                .point
                .distance_squared(point)
        };
        let limit = if (known.get() as usize) < self.triangles.len() {
            square(known.get())
        } else {
            f64::INFINITY
        };
        let found = bvh.nearest(point, limit, square)?;
        known.set(found.0);
        Some(found)
    }

    fn distance_from_balls(&self, balls: &Metaballs, point: DVec3, gradient: &mut Gradient) -> f64 {
        let k = balls.sharpness();
        let mut sum = 0.0;
        for facet in balls.near(point) {
            let corners = self.corners(facet);
            let (center, radius) = circumcircle(&corners);
            let (value, slope) = profile(k * (point.distance(center) - radius));
            if value == 0.0 {
                continue;
            }
            sum += value;
            let ways = by_circle(&corners, center, radius, point);
            for (vertex, way) in self.triangles[facet as usize].into_iter().zip(ways) {
                gradient.push((vertex, way * slope));
            }
        }
        if sum <= 0.0 {
            gradient.clear();
            return f64::INFINITY;
        }
        // d(−ln F/k) = −dF/(k·F), and each term's dF is k·φ′ times the change of its distance.
        for (_, way) in gradient {
            *way /= -sum;
        }
        -Real::ln(sum) / k
    }

    /// Appends the derivative of the distance from the nearest point of a facet, times a factor.
    fn pull(
        &self,
        facet: u32,
        found: &Nearest,
        point: DVec3,
        factor: f64,
        gradient: &mut Gradient,
    ) {
        let away = (point - found.point).normalize_or_zero() * -factor;
        let corners = self.triangles[facet as usize]
            .into_iter()
            .zip(found.weights);
        gradient.extend(
            corners
                .filter(|(_, weight)| *weight > 0.0)
                .map(|(vertex, weight)| (vertex, away * weight)),
        );
    }
}

/// The derivatives of `|p − c| − ρ` by the corners of a triangle with the circumcentre c and
/// circumradius ρ.
///
/// With y = c − a the centre solves `y·B = B²/2`, `y·C = C²/2`, `y·(B×C) = 0` for the sides B = b −
/// a and C = c − a. Where the circle is not the circumcircle (an angle above 150°) its direction
/// from the longest side is taken as fixed.
fn by_circle(corners: &[DVec3; 3], center: DVec3, radius: f64, point: DVec3) -> [DVec3; 3] {
    let [a, b, c] = *corners;
    let away = (point - center).normalize_or_zero();
    let lengths = [a.distance(b), b.distance(c), c.distance(a)];
    let longest = (0..3).fold(
        0,
        |best, i| if lengths[i] > lengths[best] { i } else { best },
    );
    if radius >= lengths[longest] * (1.0 - 1e-9) {
        // c = (s + t)/2 + e·√¾·L and ρ = L for the longest side from s to t.
        let (start, end) = (longest, (longest + 1) % 3);
        let along = (corners[end] - corners[start]).normalize_or_zero();
        let rise = (center - 0.5 * (corners[start] + corners[end])) / lengths[longest].max(1e-300);
        let by_length = -away.dot(rise) - 1.0;
        let mut ways = [DVec3::ZERO; 3];
        ways[start] = -0.5 * away - along * by_length;
        ways[end] = -0.5 * away + along * by_length;
        return ways;
    }
    let (side_b, side_c, y) = (b - a, c - a, center - a);
    let normal = side_b.cross(side_c);
    let solve = DMat3::from_cols(side_b, side_c, normal).inverse();
    // The wanted change is w·dy − u·da.
    let w = -(away + y / radius);
    let [by_b, by_c, by_normal] = (solve * w).to_array();
    let way_b = by_b * (side_b - y) - by_normal * side_c.cross(y);
    let way_c = by_c * (side_c - y) - by_normal * y.cross(side_b);
    [-away - way_b - way_c, way_b, way_c]
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [DVec3; 4] = [
        DVec3::new(0.0, 0.1, 0.0),
        DVec3::new(1.0, 0.0, 0.2),
        DVec3::new(0.3, 0.9, -0.1),
        DVec3::new(1.1, 1.0, 0.3),
    ];

    #[test]
    fn derivatives_agree_with_differences() {
        let h = 1e-6;
        let triangles = [[0, 1, 2], [2, 1, 3]];
        let kinds = [
            Kind::Explicit,
            Kind::Spherical,
            Kind::Triangular { thickness: 0.1 },
        ];
        for kind in kinds {
            for i in 0..60 {
                let t = f64::from(i);
                let point = DVec3::new(
                    0.5 + libm::sin(1.7 * t),
                    0.5 + libm::cos(2.3 * t),
                    libm::sin(0.9 * t + 1.0),
                );
                let distance = |positions: &[DVec3], gradient: &mut Gradient| {
                    let field = Field::new(positions, &triangles, kind, 8.0).unwrap();
                    field.distance(point, gradient)
                };
                let (mut gradient, mut other) = (Vec::new(), Vec::new());
                if !distance(&CORNERS, &mut gradient).is_finite() {
                    continue;
                }
                for vertex in 0..4 {
                    for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                        let [ahead, back] = [h, -h].map(|by| {
                            let mut positions = CORNERS;
                            positions[vertex] += axis * by;
                            distance(&positions, &mut other)
                        });
                        let difference = (ahead - back) / (2.0 * h);
                        let own = gradient.iter().filter(|(v, _)| *v as usize == vertex);
                        let exact: f64 = own.map(|(_, way)| way.dot(axis)).sum();
                        assert!((difference - exact).abs() < 1e-5, "{kind:?} {point}");
                    }
                }
            }
        }
    }
}
