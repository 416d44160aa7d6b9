//! The sum of metaballs as an implicit function.

use crate::ball::{Ball, circumcircle};
use crate::profile::{CUT, profile};
use crate::triangle::Triangle;
use core::fmt;
use field::real::Scalar;
use field::{Implicit, Jet, Part, Real, Slack, THRESHOLD, Variation};
use glam::DVec3;
use mesh::limits::MAX_TRIANGLES;
use mesh::{Aabb, Bvh};
use serde::{Deserialize, Serialize};
use wide::f32x8;

/// Kind of metaball around a facet.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Kind {
    /// Ball: dᵢ is the distance from the circumcentre, ρᵢ the circumradius ([`circumcircle`]).
    Spherical,
    /// Shell: dᵢ is the distance from the whole triangle, ρᵢ the thickness.
    Triangular {
        /// ρᵢ of all facets, ≥ 0.
        thickness: f64,
    },
}

/// Why a mesh has no implicit surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Error {
    /// Mesh without triangles.
    Empty,
    /// Mesh of this many triangles, more than [`MAX_TRIANGLES`].
    TooMany(usize),
    /// Triangle of this number with a vertex that is not there, or not finite.
    Broken(usize),
    /// k that is not a finite number above 0.
    Sharpness(f64),
    /// Thickness that is not a finite number of 0 or more.
    Thickness(f64),
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => f.write_str("the mesh has no triangles"),
            Self::TooMany(count) => write!(
                f,
                "the mesh has {count} triangles, more than {MAX_TRIANGLES}"
            ),
            Self::Broken(triangle) => {
                write!(f, "a corner of triangle {triangle} is no finite point")
            }
            Self::Sharpness(k) => write!(f, "k must be a number above 0, not {k}"),
            Self::Thickness(d) => write!(f, "the thickness must be a number from 0 on, not {d}"),
        }
    }
}

impl core::error::Error for Error {}

/// The facets in one precision.
#[derive(Clone, Debug)]
pub(crate) enum Facets<S> {
    Balls(Vec<Ball<S>>),
    Triangles(Vec<Triangle<S>>, S),
}

impl<S: Scalar> Facets<S> {
    /// Returns the vector whose length is d, and ρ, of a facet.
    #[inline(always)]
    pub fn offset<R: Real<Scalar = S>>(&self, facet: u32, point: [R; 3]) -> ([R; 3], R) {
        match self {
            Self::Balls(balls) => balls[facet as usize].offset(point),
            Self::Triangles(triangles, thickness) => {
                (triangles[facet as usize].offset(point), R::lift(*thickness))
            }
        }
    }
}

/// The implicit function of a mesh.
#[derive(Clone, Debug)]
pub struct Metaballs {
    kind: Kind,
    /// k, the inverse of the length in which a term falls to 1/e.
    pub(crate) sharpness: f64,
    pub(crate) double: Facets<f64>,
    single: Facets<f32>,
    /// Hierarchy of boxes around the points with d ≤ ρ, facet by facet.
    pub(crate) bvh: Bvh,
    /// Facets below each node of the hierarchy.
    pub(crate) counts: Vec<u32>,
    /// The smallest ρ.
    pub(crate) thinnest: f64,
}

impl Metaballs {
    /// Surrounds each triangle with a metaball. `sharpness` is k, the inverse of the length in
    /// which a term falls to 1/e.
    ///
    /// # Errors
    /// If there are no or too many triangles, a corner is no finite point, or a number is out of
    /// range.
    pub fn new(
        positions: &[DVec3],
        triangles: &[[u32; 3]],
        kind: Kind,
        sharpness: f64,
    ) -> Result<Self, Error> {
        if triangles.is_empty() {
            return Err(Error::Empty);
        }
        if triangles.len() > MAX_TRIANGLES {
            return Err(Error::TooMany(triangles.len()));
        }
        if !(sharpness.is_finite() && sharpness > 0.0) {
            return Err(Error::Sharpness(sharpness));
        }
        let mut facets = Vec::with_capacity(triangles.len());
        for (number, triangle) in triangles.iter().enumerate() {
            let [Some(a), Some(b), Some(c)] =
                triangle.map(|i| positions.get(i as usize).filter(|p| p.is_finite()))
            else {
                return Err(Error::Broken(number));
            };
            facets.push([*a, *b, *c]);
        }
        let (double, single, boxes, thinnest) = match kind {
            Kind::Spherical => {
                let balls: Vec<_> = facets.iter().map(circumcircle).collect();
                let thinnest = balls.iter().fold(f64::INFINITY, |least, b| least.min(b.1));
                (
                    Facets::Balls(balls.iter().copied().map(Ball::new).collect()),
                    Facets::Balls(balls.iter().copied().map(Ball::new).collect()),
                    balls.iter().map(|b| box_around(&[b.0], b.1)).collect(),
                    thinnest,
                )
            }
            Kind::Triangular { thickness } => {
                if !(thickness.is_finite() && thickness >= 0.0) {
                    return Err(Error::Thickness(thickness));
                }
                (
                    Facets::Triangles(facets.iter().map(Triangle::new).collect(), thickness),
                    Facets::Triangles(facets.iter().map(Triangle::new).collect(), thickness as f32),
                    facets.iter().map(|f| box_around(f, thickness)).collect(),
                    thickness,
                )
            }
        };
        let boxes: Vec<Aabb> = boxes;
        let bvh = Bvh::new(&boxes);
        let counts = bvh.counts();
        Ok(Self {
            kind,
            sharpness,
            double,
            single,
            bvh,
            counts,
            thinnest,
        })
    }

    /// Kind of metaball around each facet.
    #[must_use]
    pub fn kind(&self) -> Kind {
        self.kind
    }

    /// k, the inverse of the length in which a term falls to 1/e.
    #[must_use]
    pub fn sharpness(&self) -> f64 {
        self.sharpness
    }

    /// Length beyond ρ at which a facet ceases to act.
    pub(crate) fn reach(&self) -> f64 {
        CUT / self.sharpness
    }

    /// The facets that may act at a point: all others give 0. Always in the same order.
    pub fn near(&self, point: DVec3) -> impl Iterator<Item = u32> + use<'_> {
        self.bvh.overlapping(&self.around(point, point))
    }

    /// Value and gradient of some facets.
    fn sum_of<R: Real>(
        &self,
        facets: &Facets<R::Scalar>,
        numbers: &[u32],
        point: [R; 3],
    ) -> Jet<R> {
        let k = R::splat(self.sharpness);
        numbers.iter().fold(Jet::zero(), |sum, facet| {
            let (offset, radius) = facets.offset(*facet, point);
            sum.plus(term(k, offset, radius))
        })
    }

    /// Returns the facets that may act in a ball, in the order in which they are added up.
    fn near_ball(&self, field::Ball { center, radius }: field::Ball) -> impl Iterator<Item = u32> {
        self.bvh
            .overlapping(&self.around(center - radius, center + radius))
    }

    /// Returns a box around the points from which a facet must be looked for, a little wider than
    /// needed in single precision.
    fn around(&self, low: DVec3, high: DVec3) -> Aabb {
        let rounding = 1e-5 * low.abs().max(high.abs()).max_element();
        let reach = self.reach() * (1.0 + 1e-5) + rounding;
        Aabb {
            min: low - reach,
            max: high + reach,
        }
    }

    /// Value and gradient in any precision. `low` and `high` are the corners of a box around all
    /// lanes.
    fn sum<R: Real>(
        &self,
        facets: &Facets<R::Scalar>,
        point: [R; 3],
        [low, high]: [DVec3; 2],
    ) -> Jet<R> {
        let k = R::splat(self.sharpness);
        let mut sum = Jet::zero();
        // Facets beyond their reach add exactly 0, so that lanes do not depend on their neighbours.
        for facet in self.bvh.overlapping(&self.around(low, high)) {
            let (offset, radius) = facets.offset(facet, point);
            sum = sum.plus(term(k, offset, radius));
        }
        sum
    }
}

/// Returns the box of the points within a radius of some points.
fn box_around(points: &[DVec3], radius: f64) -> Aabb {
    let tight = Aabb::of_points(points.iter().copied());
    Aabb {
        min: tight.min - radius,
        max: tight.max + radius,
    }
}

/// Value and gradient of one metaball, from the vector whose length is d.
#[inline(always)]
pub(crate) fn term<R: Real>(k: R, offset: [R; 3], radius: R) -> Jet<R> {
    let [x, y, z] = offset;
    let distance = (x * x + y * y + z * z).sqrt();
    let (value, slope) = profile(k * (distance - radius));
    // On the facet itself there is no gradient; 0 is the mean of those around.
    let along = k * slope / distance.max(R::splat(1e-18));
    Jet {
        value,
        gradient: offset.map(|o| o * along),
    }
}

impl Implicit for Metaballs {
    fn jet(&self, point: DVec3) -> Jet<f64> {
        self.sum(&self.double, point.to_array(), [point; 2])
    }

    fn jet32(&self, point: [f32; 3]) -> Jet<f32> {
        let at = DVec3::from_array(point.map(f64::from));
        self.sum(&self.single, point, [at; 2])
    }

    fn jet8(&self, points: [f32x8; 3]) -> Jet<f32x8> {
        let lanes = points.map(|p| p.to_array().map(f64::from));
        let bounds = [f64::min, f64::max].map(|pick: fn(f64, f64) -> f64| {
            DVec3::from_array(lanes.map(|lane| lane.into_iter().reduce(pick).unwrap_or(f64::NAN)))
        });
        self.sum(&self.single, points, bounds)
    }

    fn enclose(&self, ball: field::Ball) -> field::Enclosure {
        self.enclosure(ball)
    }

    /// The facets that act anywhere in the ball; all others add exactly 0.
    fn narrow(&self, ball: field::Ball, among: Option<&Part>, _slack: Slack) -> Option<Part> {
        let before = among.map_or(self.bvh.len(), |among| among.terms.len());
        let terms: Vec<u32> = match among {
            Some(among) => {
                let terms = among.terms.iter().copied();
                terms.filter(|facet| self.acts(*facet, ball)).collect()
            }
            None => {
                let facets = self.near_ball(ball);
                facets.filter(|facet| self.acts(*facet, ball)).collect()
            }
        };
        (4 * terms.len() <= 3 * before).then_some(Part {
            ball,
            terms,
            rest: field::Enclosure::ZERO,
            far: None,
        })
    }

    fn jet_of(&self, part: &Part, point: DVec3) -> Jet<f64> {
        self.sum_of(&self.double, &part.terms, point.to_array())
    }

    fn jet8_of(&self, part: &Part, points: [f32x8; 3]) -> Jet<f32x8> {
        self.sum_of(&self.single, &part.terms, points)
    }

    fn variation_with_jet(
        &self,
        part: Option<&Part>,
        ball: field::Ball,
    ) -> (Variation, Option<Jet<f64>>) {
        match self.small_enclosure(part, ball) {
            Some((range, jet)) => (Variation::rough(range), Some(jet)),
            None => (self.variation(part, ball), None),
        }
    }

    fn clearance(&self, point: DVec3) -> Option<field::Clearance> {
        Some(self.clear_ball(point))
    }

    fn clearance_of(&self, part: &Part, point: DVec3) -> Option<field::Clearance> {
        Some(self.clear_ball_of(part, point))
    }

    fn shares(&self, point: DVec3, out: &mut Vec<(u32, f64)>) {
        let value = self.jet(point).value;
        if value > 0.0 {
            out.push((0, value));
        }
    }

    fn support(&self) -> Option<field::Ball> {
        self.support_at(THRESHOLD)
    }

    fn support_at(&self, level: f64) -> Option<field::Ball> {
        // n facets at the distance ln(n/a)/k beyond their ρ make a at most.
        let count = (self.bvh.len() as f64 / level).max(1.0);
        let beyond = Real::ln(count).min(CUT) / self.sharpness;
        let Aabb { min, max } = self.bvh.bounds();
        Some(field::Ball {
            center: 0.5 * (min + max),
            radius: (0.5 * min.distance(max) + beyond * 3f64.sqrt()) * (1.0 + 1e-9),
        })
    }
}
