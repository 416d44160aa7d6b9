//! Interpolants of the sum of many primitives on a piece of a beam, shared by all its rays.
//!
//! A box along the beam's axis encloses the piece. At its eight corners all the primitives are
//! evaluated once, side by side, with their gradients; in between values and slopes are
//! interpolated: linearly across from the corners, and along each edge by the cubic with the values
//! and slopes of its ends (Adini's element in three dimensions). Cubic polynomials are reproduced,
//! and the error is bounded by the fourth derivative, so that distant primitives, whose sum is
//! smooth, cost a ray almost nothing however many they are.
use crate::beam::Beam;
use crate::lanes::{Lanes, least};
use field::{Cut, Primitive};
use glam::DVec3;
use wide::f32x8;

/// Number of points at which each primitive is evaluated for an interpolant.
pub const CORNERS: u64 = 8;

/// The box around a piece of a beam.
#[derive(Clone, Copy, Debug)]
pub struct Cell {
    corner: DVec3,
    /// Orthonormal axes; the last is the beam's.
    axes: [DVec3; 3],
    /// Extent of the box along each axis.
    size: [f64; 3],
    /// Axes divided by the extents along them.
    scaled: [DVec3; 3],
    /// Largest change of a ray's distance from the axis over the piece.
    travel: f64,
}

/// Least ratio of the extent across the beam to that along it.
const THINNEST: f64 = 1.0 / 64.0;

impl Cell {
    /// Returns the box around all rays of a beam between two parameters.
    #[must_use]
    pub fn around(beam: &Beam, from: f64, to: f64) -> Self {
        // Rays lag behind the axis, or are ahead of it, by a little.
        let lag = beam.lag(to);
        let length = to - from + 2.0 * lag;
        let width = (2.0 * beam.width(to)).at_least(THINNEST * length);
        let along = beam.axis.direction;
        let (across, up) = along.any_orthonormal_pair();
        let start = beam.axis.at(from) - along * lag;
        let inverse = 1.0 / width;
        Self {
            corner: start - (across + up) * (0.5 * width),
            axes: [across, up, along],
            size: [width, width, length],
            scaled: [across * inverse, up * inverse, along / length],
            travel: beam.spread * (to - from),
        }
    }

    /// Returns the radius of the ball around the box.
    #[must_use]
    pub fn radius(&self) -> f64 {
        0.5 * DVec3::from_array(self.size).length() * (1.0 + 1e-9)
    }

    /// Returns the factor from a bound on the fourth derivative along any line in the box to the
    /// error of the cubic Hermite span of the interpolant along a ray.
    ///
    /// With A = 1 − L and C = 1 − H the errors of linear and cubic interpolation along an axis, the
    /// interpolant's error is `ΣC₁L₂L₃ + ΣA₁A₂L₃ + A₁A₂A₃`, where |C| ≤ h⁴/384, |A| ≤ h²/8 times a
    /// derivative, and |L| ≤ 1. Along a ray that moves across by s the interpolant is not quite
    /// cubic: the changes of its quadratic and cubic parts from edge to edge, times s over the
    /// box's width, are its fourth derivative.
    #[must_use]
    pub fn roughness(&self) -> f64 {
        let [b, _, h] = self.size;
        let s = self.travel;
        let (b2, h2, s2) = (b * b, h * h, s * s);
        let inside = (h2 * h2 + 2.0 * b2 * b2) / 384.0 + (2.0 * h2 * b2 + 3.0 * b2 * b2) / 64.0;
        let along =
            s * h * h2 / 48.0 + s2 * h2 * (h / (32.0 * b) + 1.0 / 32.0) + s2 * s * (h + s) / 16.0;
        inside + along
    }

    /// Returns the [`CORNERS`] corners; bits 0, 1, 2 of the lane's number are the steps along the
    /// axes.
    fn corners(&self) -> [f32x8; 3] {
        let places: [DVec3; 8] = core::array::from_fn(|lane| {
            (0..3).fold(self.corner, |p, i| {
                p + self.axes[i] * (self.size[i] * (lane >> i & 1) as f64)
            })
        });
        core::array::from_fn(|k| f32x8::new(places.map(|p| p[k] as f32)))
    }

    /// Converts positions to coordinates of the box, 0 to 1.
    #[inline(always)]
    #[must_use]
    pub fn local<L: Lanes>(&self, point: [L; 3]) -> [L; 3] {
        let [x, y, z] = core::array::from_fn(|k| point[k] - L::splat(self.corner[k]));
        self.steps([x, y, z])
    }

    /// Converts a direction to coordinates of the box.
    #[inline(always)]
    #[must_use]
    pub fn steps<L: Lanes>(&self, [x, y, z]: [L; 3]) -> [L; 3] {
        self.scaled
            .map(|a| x * L::splat(a.x) + y * L::splat(a.y) + z * L::splat(a.z))
    }

    /// Converts a gradient from coordinates of the box to the world.
    #[inline(always)]
    #[must_use]
    pub fn world<L: Lanes>(&self, [x, y, z]: [L; 3]) -> [L; 3] {
        let [a, b, c] = self.scaled;
        core::array::from_fn(|k| x * L::splat(a[k]) + y * L::splat(b[k]) + z * L::splat(c[k]))
    }
}

/// An interpolant in a [`Cell`].
#[derive(Clone, Copy, Debug)]
pub struct Shared {
    /// The edges along x, at y, z = 00, 10, 01, 11.
    rows: [Row; 4],
    /// Sums of the changes with x of [`Row::y`], for the two faces across z.
    bends: [f32; 2],
    /// Changes with x of the difference of [`Row::z`] between the rows, for the two faces across z.
    twists: [f32; 2],
    /// Upper bound in the box.
    top: f32,
}

/// Coefficients along an edge.
#[derive(Clone, Copy, Debug, Default)]
struct Row {
    /// Coefficients of the value, a polynomial.
    value: [f32; 4],
    /// Slope along y less that of the straight line, times the edge's length: at the start, and its
    /// change.
    y: [f32; 2],
    /// Slope along z less that of the straight line, likewise.
    z: [f32; 2],
}

impl Row {
    /// Returns the value at x, its slope, and the coefficients by y and by z.
    #[inline(always)]
    fn jet<L: Lanes>(&self, x: L) -> (L, L, L, L) {
        let [a, b, c, d] = self.value.map(L::single);
        let dx = d * x;
        let second = c + dx;
        let first = b + second * x;
        let value = a + first * x;
        let slope = first + (second + dx) * x;
        let [by_y, by_z] =
            [self.y, self.z].map(|[start, change]| L::single(start) + L::single(change) * x);
        (value, slope, by_y, by_z)
    }
}

/// Value and gradient at the corners.
#[derive(Clone, Copy)]
struct Corners([f32x8; 4]);

impl Corners {
    const NONE: Self = Self([f32x8::ZERO; 4]);

    fn plus(self, other: Self) -> Self {
        Self(core::array::from_fn(|i| self.0[i] + other.0[i]))
    }
}

/// Number of terms in a partial sum, which keeps digits in sums of very many terms.
const PARTIAL_SUM: usize = 32;

/// Accumulator of the sum of primitives at a cell's corners.
pub struct Sums<'c> {
    cell: &'c Cell,
    corners: [f32x8; 3],
    /// Sums of the finishes: the finish, the sum so far, the present partial sum and its number of
    /// terms.
    sums: Vec<(u32, Corners, Corners, usize)>,
    last: usize,
}

impl<'c> Sums<'c> {
    /// Starts with no primitives.
    #[must_use]
    pub fn new(cell: &'c Cell) -> Self {
        Self {
            cell,
            corners: cell.corners(),
            sums: Vec::new(),
            last: 0,
        }
    }

    /// Adds a primitive of some finish.
    #[inline(always)]
    pub fn add(&mut self, primitive: &Primitive, finish: u32) {
        let jet = primitive.jet(self.corners);
        let [x, y, z] = jet.gradient;
        let sums = &mut self.sums;
        if sums.get(self.last).is_none_or(|sum| sum.0 != finish) {
            let known = sums.iter().position(|sum| sum.0 == finish);
            self.last = known.unwrap_or_else(|| {
                sums.push((finish, Corners::NONE, Corners::NONE, 0));
                sums.len() - 1
            });
        }
        let (_, whole, group, count) = &mut sums[self.last];
        *group = group.plus(Corners([jet.value, x, y, z]));
        *count += 1;
        if (*count).is_multiple_of(PARTIAL_SUM) {
            *whole = whole.plus(*group);
            *group = Corners::NONE;
        }
    }

    /// Returns the interpolant of all primitives, and those of each finish.
    #[must_use]
    pub fn finish(self) -> (Shared, Vec<(u32, Shared)>) {
        let sums = || {
            self.sums
                .iter()
                .map(|(m, whole, group, _)| (*m, whole.plus(*group)))
        };
        let total = sums().fold(Corners::NONE, |all, sum| all.plus(sum.1));
        let total = Shared::new(self.cell, &total);
        let of_each = match &self.sums[..] {
            [only] => vec![(only.0, total)],
            _ => sums()
                .map(|(m, sum)| (m, Shared::new(self.cell, &sum)))
                .collect(),
        };
        (total, of_each)
    }
}

impl Shared {
    /// Returns the interpolant of a sum at a cell's corners.
    fn new(cell: &Cell, sum: &Corners) -> Self {
        let [values, x, y, z] = sum.0.map(f32x8::to_array);
        // Slopes along each axis at the corners less those of the straight edges, times the edges'
        // lengths.
        let excess: [[f32; 8]; 3] = core::array::from_fn(|axis| {
            core::array::from_fn(|lane| {
                let gradient = DVec3::from_array([x, y, z].map(|g| f64::from(g[lane])));
                let slope = gradient.dot(cell.axes[axis]) * cell.size[axis];
                let bit = 1 << axis;
                let straight = f64::from(values[lane | bit]) - f64::from(values[lane & !bit]);
                (slope - straight) as f32
            })
        });
        let value = greatest_number(sum.0[0], f32x8::splat(f32::NEG_INFINITY));
        let bends = excess.map(|all| greatest_number(f32x8::new(all).abs(), f32x8::ZERO));
        // |x(1−x)²| + |x²(1−x)| ≤ ¼.
        let bends = 0.25 * bends.iter().sum::<f32>();
        let top = value + bends + 1e-6 * (value.abs() + bends);
        let rows: [Row; 4] = core::array::from_fn(|i| {
            let [[f, g], [a, b], y, z] = [&values, &excess[0], &excess[1], &excess[2]]
                .map(|corners| [corners[2 * i], corners[2 * i + 1]]);
            Row {
                // f + (g−f)x + a·x(1−x)² − b·x²(1−x).
                value: [f, g - f + a, -(a + a + b), a + b],
                y: [y[0], y[1] - y[0]],
                z: [z[0], z[1] - z[0]],
            }
        });
        Self {
            rows,
            bends: [0, 2].map(|i| rows[i].y[1] + rows[i + 1].y[1]),
            twists: [0, 2].map(|i| rows[i + 1].z[1] - rows[i].z[1]),
            top,
        }
    }

    /// Returns an upper bound on the interpolant in the box.
    #[must_use]
    pub fn top(&self) -> f64 {
        f64::from(self.top)
    }

    /// Returns value and gradient at positions in the box, both in its coordinates.
    #[inline(always)]
    #[must_use]
    pub fn jet<L: Lanes>(&self, [x, y, z]: [L; 3]) -> (L, [L; 3]) {
        let single = L::single;
        let (across, along) = (Bend::at(y), Bend::at(z));
        // Along y: value, slopes by x and y; the coefficient by z, and its slopes.
        let face = |i: usize| {
            let [near, far] = [&self.rows[2 * i], &self.rows[2 * i + 1]];
            let (p, px, q, r) = near.jet(x);
            let (p1, p1x, q1, r1) = far.jet(x);
            let (value, by_y) = across.jet(p, p1, q, q + q1);
            let by_x = across.value(px, p1x, single(near.y[1]), single(self.bends[i]));
            let twist = r1 - r;
            (
                [value, by_x, by_y],
                [
                    r + twist * y,
                    single(near.z[1]) + single(self.twists[i]) * y,
                    twist,
                ],
            )
        };
        let (s, u) = face(0);
        let (t, v) = face(1);
        let (value, by_z) = along.jet(s[0], t[0], u[0], u[0] + v[0]);
        let [by_x, by_y] = [1, 2].map(|i| along.value(s[i], t[i], u[i], u[i] + v[i]));
        (value, [by_x, by_y, by_z])
    }
}

/// A position x along an edge, with the cubic's basis functions there.
#[derive(Clone, Copy)]
struct Bend<L> {
    x: L,
    /// x(1−x).
    bulge: L,
    /// 1−2x, the derivative of x(1−x).
    tilt: L,
}

impl<L: Lanes> Bend<L> {
    #[inline(always)]
    fn at(x: L) -> Self {
        let rest = L::single(1.0) - x;
        Self {
            x,
            bulge: x * rest,
            tilt: rest - x,
        }
    }

    /// Returns the value of the cubic with the values f and g at the ends and the excess slopes a
    /// and b, `f + (g−f)x + x(1−x)(a − (a+b)x)`, given a and a+b.
    #[inline(always)]
    fn value(&self, f: L, g: L, a: L, both: L) -> L {
        f + (g - f) * self.x + (a - both * self.x) * self.bulge
    }

    /// Returns value and derivative of the cubic of [`Bend::value`].
    #[inline(always)]
    fn jet(&self, f: L, g: L, a: L, both: L) -> (L, L) {
        let rise = g - f;
        let lean = a - both * self.x;
        (
            f + rise * self.x + lean * self.bulge,
            rise + lean * self.tilt - both * self.bulge,
        )
    }
}

/// Returns the greatest of eight numbers and `nothing`, for which NaN counts.
#[inline(always)]
fn greatest_number(all: f32x8, nothing: f32x8) -> f32 {
    let numbers = nothing.simd_lt(all).select(all, nothing);
    -least(-numbers)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ray::Ray;
    use crate::spans::{Node, Span};
    use field::bound::SpanLength;
    use field::{Bound, Kernel, Real, Shaping, Skeleton};
    use trials::{Random, count};

    fn primitive(kernel: Kernel, random: &mut Random) -> Primitive {
        let [a, b] = core::array::from_fn(|_| random.vector(1.0));
        let skeleton = if random.unit() < 0.5 {
            Skeleton::Point { center: a }
        } else {
            Skeleton::Segment { base: a, apex: b }
        };
        let shaping = Shaping {
            kernel,
            radius: random.range(0.1, 0.5),
            blobbiness: 1.0,
            blob_scale: field::BlobScale::Relative,
            strength: 1.0,
            influence: 1e-3,
            taper: None,
        };
        Primitive::new(skeleton, &shaping, None).expect("flesh")
    }

    /// The interpolant is smooth and has the values and gradients at the corners, for any cubics
    /// along the edges.
    #[test]
    fn gradients_are_derivatives() {
        let mut random = Random::new(8);
        let axis = Ray {
            origin: DVec3::ZERO,
            direction: DVec3::Z,
        };
        let beam = Beam::around(&[axis]).expect("a beam");
        for _ in 0..count(100) {
            let cell = Cell::around(&beam, 0.0, 1.0);
            let sum = Corners(
                [(); 4]
                    .map(|()| f32x8::new(core::array::from_fn(|_| (random.unit() - 0.5) as f32))),
            );
            let shared = Shared::new(&cell, &sum);
            let value = |p: DVec3| shared.jet(p.to_array()).0;
            let place = random.vector(0.5) + 0.5;
            let (here, gradient) = shared.jet(place.to_array());
            assert!(here <= shared.top(), "{here} {shared:?}");
            for (axis, slope) in DVec3::AXES.into_iter().zip(gradient) {
                let difference = value(place + axis * 1e-5) - value(place - axis * 1e-5);
                assert!((difference / 2e-5 - slope).abs() < 1e-6, "{slope} {axis}");
            }
            for lane in 0..8 {
                let corner = [0, 1, 2].map(|i| f64::from(lane as u32 >> i & 1));
                let (value, gradient) = shared.jet(corner);
                assert!((value - sum.0[0].lane(lane)).abs() < 1e-6);
                for (i, slope) in gradient.into_iter().enumerate() {
                    let given = [1, 2, 3].map(|k| sum.0[k].lane(lane));
                    let given = DVec3::from_array(given).dot(cell.axes[i]) * cell.size[i];
                    assert!((slope - given).abs() < 1e-6, "{slope} {given}");
                }
            }
        }
    }

    /// The error of the cubic between the interpolant's ends is within its bound along rays of a
    /// beam.
    #[test]
    fn no_ray_is_further_off_than_the_bound() {
        let mut random = Random::new(3);
        let mut tightest = 0.0f64;
        for case in 0..count(400) {
            let kernel = [Kernel::Cauchy, Kernel::Gauss, Kernel::Squared][case % 3];
            let primitive = primitive(kernel, &mut random);
            let axis = Ray {
                origin: random.direction() * 2.0,
                direction: random.direction(),
            };
            let (offset, turn) = (random.direction(), random.direction());
            let (radius, spread) = (0.05 * random.unit(), 0.05 * random.unit() * random.unit());
            let direction = (axis.direction + turn * spread * 0.9).normalize();
            let ray = Ray {
                origin: axis.origin + offset * radius,
                direction,
            };
            let beam = Beam::around(&[axis, ray]).expect("a beam");
            let from = random.unit();
            let to = from + 0.05 + 0.5 * random.unit();
            let cell = Cell::around(&beam, from, to);
            let (center, ball) = beam.ball(from, to);
            let bound = Bound::new(&primitive);
            let near = bound.nearness(center, ball.max(cell.radius()));
            let estimate = bound.estimate(near, &SpanLength::new(to - from));
            let most = estimate.fourth * cell.roughness();
            if !most.is_finite() || most > 0.3 * estimate.magnitude {
                continue;
            }
            let mut sums = Sums::new(&cell);
            sums.add(&primitive, 0);
            let (shared, _) = sums.finish();
            let node = |t: f64| {
                let (value, gradient) = shared.jet(cell.local(ray.at(t).to_array()));
                let [x, y, z] = cell.steps(ray.direction.to_array());
                Node {
                    value,
                    slope: gradient[0] * x + gradient[1] * y + gradient[2] * z,
                }
            };
            let span = Span::hermite(node(from), node(to), to - from);
            // Corners and values are rounded to single precision.
            let rounding = 3e-6 * estimate.magnitude * (1.0 + bound.relative_slope(near));
            for i in 0..=20 {
                let x = f64::from(i) / 20.0;
                let point = ray.at(from + x * (to - from));
                let off = (span.value_and_slope(x).0 - primitive.value(point.to_array())).abs();
                assert!(
                    off <= most + rounding,
                    "{case} {kernel:?}: {off} > {most} + {rounding}"
                );
                if rounding < 0.01 * most {
                    tightest = tightest.max(off / most);
                }
                assert!(shared.jet(cell.local(point.to_array())).0 <= shared.top());
            }
        }
        assert!(tightest > 0.02, "{tightest}");
    }
}
