//! The far field of a sum: a hierarchy of boxes, each with a polynomial of all that is far from it and a list of what is near.
//!
//! Space is a cube that is halved along all axes again and again (an octree). A cell's polynomial is its parent's, plus the
//! primitives that are far from the cell but were near its parent, evaluated at the nodes of [`Expansion`]; so each primitive is
//! evaluated for a bounded number of cells of each size. Cells are made where and when they are first asked for, and depend on the
//! primitives alone.
//!
//! # The bound
//!
//! The kernels that never end are `G = (ε² + u²)^(−e/2)`, with e = 1, 2, 3 for the inverse, the squared and the cubed kernel, and
//! e = 4, ε = 1 for Cauchy's. Along a straight line that is the generating function's root of the Gegenbauer polynomials, so that
//! its derivatives are `n!·C_n(cos θ)·b^(−e−n)`, at most `(e)_n·b^(−e−n)` with `b² = ε² + u²` and `(e)_n = e(e+1)…(e+n−1)`. By Banach's
//! theorem on symmetric multilinear forms the same number bounds mixed derivatives of order n. A skeleton adds up such terms.
//! With A = 1 − I, the error of interpolation along an axis at n Chebyshev nodes of an interval of half length w,
//! `|A f| ≤ 2(w/2)ⁿ/n!·|f⁽ⁿ⁾|`, and interpolation along all three is off by
//! `ΣA₁ − ΣA₁A₂ + A₁A₂A₃`, at most
//!
//! `M·(6·(e)₅/5!·q⁵ + 12·(e)₁₀/(5!)²·q¹⁰ + 8·(e)₁₅/(5!)³·q¹⁵)`, `q = s·w/2b`,
//!
//! where M bounds the field and s is the width parameter. Interpolation of the parent's polynomial is exact.
//!
//! Kernels that end, the Gaussian and primitives with a profile are near wherever they are not negligible.
mod expansion;

use crate::bone::Bone;
use crate::{Bound, Cut, Kernel, Primitive, THRESHOLD, inverse};
pub use expansion::{DEGREE, Expansion};
use expansion::{LEBESGUE, VECTORS};
use glam::DVec3;
use std::sync::OnceLock;
use wide::f32x8;

/// Half the extent of the box in which a cell's polynomial holds, over half the cell's own: rays of a beam may leave the cell by the
/// difference.
pub const LOOSE: f64 = 1.5;
/// Largest error of a cell's polynomial, in T.
pub const MOST_ERROR: f64 = 5e-5 * THRESHOLD;
/// Part of what is left of [`MOST_ERROR`] that one more cell may use up.
const PORTION: f64 = 0.5;
/// Error up to which a primitive is far, as a part of what the cell may use up, at first.
const FIRST_SHARE: f64 = 0.125;
/// Largest number of halvings of that.
const MOST_HALVINGS: u32 = 24;
/// Number of values in a partial sum of single precision.
const PARTIAL_SUM: usize = 32;
/// Rounding of a primitive's value in single precision, relative to it, and of one addition.
const ROUNDING: [f64; 2] = [2e-6, 6e-8];
/// Rounding of coordinates in single precision, in the world and in a primitive's own frame, relative to them.
const MISPLACED: f64 = 2.5e-7;

/// A primitive as others see it from afar.
#[derive(Clone, Debug)]
struct Source {
    /// Ball around its skeleton.
    center: DVec3,
    around: f64,
    /// Bound on the field times the kernel's reciprocal ([`Bound::far`]), and the least width parameter.
    whole: f64,
    width: f64,
    /// The largest width parameter.
    finest: f64,
    /// Of a point without a profile: its factor.
    point: Option<f32>,
    /// The bounds of all others.
    bound: Option<Box<Bound>>,
    adds: bool,
    kernel: Kernel,
    /// Whether it has an expansion.
    endless: bool,
}

/// A primitive as seen from a box.
#[derive(Clone, Copy)]
struct Seen {
    /// Bound on its size in the box.
    magnitude: f64,
    /// Bound on the error of its expansion, or of leaving it out.
    error: f64,
    /// Its largest slope over its size, about, where its place is rounded to single precision.
    steep: f64,
    /// Whether it has an expansion.
    expands: bool,
}

/// The hierarchy of a list of primitives.
#[derive(Debug)]
pub struct FarField {
    sources: Vec<Source>,
    center: DVec3,
    half: f64,
    nodes: [[f32x8; 3]; VECTORS],
    root: OnceLock<Box<Cell>>,
}

/// A cube of space.
#[derive(Debug)]
pub struct Cell {
    /// Its middle.
    pub center: DVec3,
    /// Half its side.
    pub half: f64,
    /// Numbers of the primitives near it, in ascending order.
    pub near: Vec<u32>,
    /// Sum of all others in the cube of half side `LOOSE·half`, in coordinates from −1 to 1 there.
    pub expansion: Expansion,
    /// Bound on its error.
    pub error: f64,
    /// Upper bound on the expansion, with its error.
    pub far_most: f64,
    /// Upper bound on the whole field.
    pub most: f64,
    children: [OnceLock<Box<Cell>>; 8],
}

impl Source {
    fn of(primitive: &Primitive) -> Self {
        let bound = Bound::new(primitive);
        let [whole, width] = bound.far();
        let ball = primitive.skeleton.bounding_sphere();
        let (center, around) = ball.unwrap_or((DVec3::ZERO, f64::INFINITY));
        let plain = !bound.has_profile() && ball.is_some() && whole.is_finite();
        let endless = plain && power(primitive.kernel).is_some();
        let term = &primitive.prepared.double;
        let is_point = endless && matches!(term.form.bone, Bone::Point);
        Self {
            center,
            around,
            whole,
            width,
            finest: primitive.width,
            point: is_point.then_some(term.amplitude as f32),
            adds: bound.adds(),
            kernel: primitive.kernel,
            endless,
            bound: (!is_point).then(|| Box::new(bound)),
        }
    }

    /// The primitive as seen from a box of this half extent.
    fn seen(&self, center: DVec3, half: f64) -> Seen {
        let away = (self.center - center).abs();
        let outside = (away - half).max(DVec3::ZERO).length();
        let mut distance = (outside - self.around).at_least(0.0);
        let mut magnitude = f64::INFINITY;
        let mut steep = 0.0;
        if let Some(bound) = &self.bound {
            let near = bound.nearness(center, half * DIAGONAL);
            distance = distance.at_least(near.distance);
            magnitude = bound.magnitude(near);
            steep = bound.relative_slope(near);
        }
        let Some((power, softening)) = power(self.kernel).filter(|_| self.endless) else {
            return Seen {
                magnitude,
                error: magnitude,
                steep,
                expands: false,
            };
        };
        let u = distance * self.width;
        let b = (softening + u * u).sqrt();
        let inverse = 1.0 / b;
        let own = self.whole * (0..power).fold(1.0, |product, _| product * inverse);
        let magnitude = magnitude.at_most(own);
        let q = 0.5 * self.finest * half * inverse;
        let five = q * q * q * q * q;
        let [a, b, c] = FACTORS[power as usize - 1];
        Seen {
            magnitude,
            error: own * five * (a + five * (b + five * c)),
            steep,
            expands: true,
        }
    }
}

/// Ratio of a cube's half diagonal to half its side, or more.
const DIAGONAL: f64 = 1.733;

/// Returns the exponent e and the square ε² of a kernel `(ε² + u²)^(−e/2)`; `None` for kernels that end and the Gaussian.
#[must_use]
pub fn power(kernel: Kernel) -> Option<(i32, f64)> {
    match kernel {
        Kernel::Cauchy => Some((4, 1.0)),
        Kernel::Inverse => Some((1, inverse::POLE2)),
        Kernel::Squared => Some((2, inverse::POLE2)),
        Kernel::Cubed => Some((3, inverse::POLE2)),
        _ => None,
    }
}

/// `6·(e)₅/5!`, `12·(e)₁₀/(5!)²` and `8·(e)₁₅/(5!)³` for e = 1 to 4.
const FACTORS: [[f64; 3]; 4] = [factors(1), factors(2), factors(3), factors(4)];

const fn factors(power: u32) -> [f64; 3] {
    let mut rising = [1.0; 3];
    let mut all = 1.0;
    let mut n = 0;
    while n < 15 {
        all *= (power + n) as f64;
        n += 1;
        if n % 5 == 0 {
            rising[n as usize / 5 - 1] = all;
        }
    }
    [
        6.0 * rising[0] / 120.0,
        12.0 * rising[1] / (120.0 * 120.0),
        8.0 * rising[2] / (120.0 * 120.0 * 120.0),
    ]
}

impl FarField {
    /// The hierarchy of some primitives in a cube of space with this half side.
    #[must_use]
    pub fn new(primitives: &[Primitive], center: DVec3, half: f64) -> Self {
        Self {
            sources: primitives.iter().map(Source::of).collect(),
            center,
            half,
            nodes: expansion::nodes(),
            root: OnceLock::new(),
        }
    }

    /// The cube itself, given the primitives of which the hierarchy was made.
    pub fn root(&self, primitives: &[Primitive]) -> &Cell {
        self.root.get_or_init(|| {
            let all: Vec<u32> = (0..self.sources.len() as u32).collect();
            Box::new(self.cell(primitives, self.center, self.half, &all, None))
        })
    }

    /// One of the eight parts of a cell: bit i of the number tells that it is the upper half along axis i.
    pub fn part<'c>(&self, primitives: &[Primitive], of: &'c Cell, number: usize) -> &'c Cell {
        of.children[number].get_or_init(|| {
            let half = 0.5 * of.half;
            let side = |axis: usize| if number >> axis & 1 == 0 { -half } else { half };
            let center = of.center + DVec3::new(side(0), side(1), side(2));
            Box::new(self.cell(primitives, center, half, &of.near, Some(of)))
        })
    }

    /// Makes a cell from those primitives that are near its parent.
    fn cell(
        &self,
        primitives: &[Primitive],
        center: DVec3,
        half: f64,
        candidates: &[u32],
        parent: Option<&Cell>,
    ) -> Cell {
        let loose = LOOSE * half;
        let inherited = parent.map_or(0.0, |parent| parent.error);
        let seen: Vec<Seen> = candidates
            .iter()
            .map(|&i| self.sources[i as usize].seen(center, loose))
            .collect();
        let portion = PORTION * (MOST_ERROR - inherited).at_least(0.0);
        let mut share = FIRST_SHARE * portion;
        for _ in 0..MOST_HALVINGS {
            let far = seen.iter().filter(|seen| seen.error <= share);
            if far.map(|seen| seen.error).sum::<f64>() <= portion {
                break;
            }
            share *= 0.5;
        }
        let mut sums = NodeSums::new(self, center, loose);
        let mut near = Vec::new();
        let (mut error, mut near_most) = (inherited, 0.0);
        for (&i, seen) in candidates.iter().zip(&seen) {
            let source = &self.sources[i as usize];
            if seen.error <= share {
                error += seen.error;
                if seen.expands {
                    sums.add(source, &primitives[i as usize], seen);
                }
            } else {
                near.push(i);
                if source.adds {
                    near_most += seen.magnitude;
                }
            }
        }
        if sums.count == 0 && parent.is_none() {
            return Cell {
                center,
                half,
                near,
                expansion: Expansion::ZERO,
                error,
                far_most: error,
                most: near_most + error,
                children: Default::default(),
            };
        }
        error += sums.rounding();
        let fitted = Expansion::fit(&sums.finish(parent));
        error += fitted.error;
        let far_most = fitted.range[1] + error;
        Cell {
            center,
            half,
            near,
            expansion: fitted.expansion,
            error,
            far_most,
            most: near_most + far_most,
            children: Default::default(),
        }
    }
}

/// Sums of primitives at the nodes of a box.
struct NodeSums<'f> {
    nodes: &'f [[f32x8; 3]; VECTORS],
    center: DVec3,
    half: f64,
    whole: [f32x8; VECTORS],
    partial: [f32x8; VECTORS],
    count: usize,
    /// Sum of the bounds on the primitives' sizes.
    size: f64,
    /// Bound on the effect of rounded places.
    loss: f64,
}

impl<'f> NodeSums<'f> {
    fn new(field: &'f FarField, center: DVec3, half: f64) -> Self {
        Self {
            nodes: &field.nodes,
            center,
            half,
            whole: [f32x8::splat(0.0); VECTORS],
            partial: [f32x8::splat(0.0); VECTORS],
            count: 0,
            size: 0.0,
            loss: 0.0,
        }
    }

    fn add(&mut self, source: &Source, primitive: &Primitive, seen: &Seen) {
        self.size += seen.magnitude;
        let coordinates = self.center.abs().max_element() + self.half;
        self.loss += seen.magnitude * (MISPLACED * coordinates * seen.steep).at_most(1.0);
        self.count += 1;
        if let Some(amplitude) = source.point {
            // Relative to the box, in kernel widths: single precision then has its digits whatever the place.
            let scale = source.finest;
            let away = ((self.center - source.center) * scale).as_vec3();
            self.add_point(
                source.kernel,
                away.to_array(),
                (self.half * scale) as f32,
                amplitude,
            );
        } else {
            let half = f32x8::splat(self.half as f32);
            let center = self.center.as_vec3().to_array();
            for (sum, node) in self.partial.iter_mut().zip(self.nodes) {
                let place = core::array::from_fn(|i| f32x8::splat(center[i]) + node[i] * half);
                *sum += primitive.value::<f32x8>(place);
            }
        }
        if self.count.is_multiple_of(PARTIAL_SUM) {
            for (whole, partial) in self.whole.iter_mut().zip(&mut self.partial) {
                *whole += *partial;
                *partial = f32x8::splat(0.0);
            }
        }
    }

    fn add_point(&mut self, kernel: Kernel, away: [f32; 3], half: f32, amplitude: f32) {
        let [x, y, z] = away.map(f32x8::splat);
        let (half, amplitude) = (f32x8::splat(half), f32x8::splat(amplitude));
        let mut all = |value: &dyn Fn(f32x8) -> f32x8| {
            for (sum, node) in self.partial.iter_mut().zip(self.nodes) {
                let [dx, dy, dz] = [x + node[0] * half, y + node[1] * half, z + node[2] * half];
                *sum += amplitude * value(dx * dx + dy * dy + dz * dz);
            }
        };
        if kernel == Kernel::Cauchy {
            let one = f32x8::splat(1.0);
            return self.add_cauchy([x, y, z], half, amplitude, one);
        }
        all(&|square| kernel.falling(square).0);
    }

    /// [`NodeSums::add_point`] for the most common kernel, as a loop without calls.
    #[inline(always)]
    fn add_cauchy(&mut self, [x, y, z]: [f32x8; 3], half: f32x8, amplitude: f32x8, one: f32x8) {
        for (sum, node) in self.partial.iter_mut().zip(self.nodes) {
            let [dx, dy, dz] = [x + node[0] * half, y + node[1] * half, z + node[2] * half];
            let base = one + dx * dx + dy * dy + dz * dz;
            *sum += amplitude / (base * base);
        }
    }

    /// Bound on the rounding of the sums, as the interpolant's error.
    fn rounding(&self) -> f64 {
        let [own, addition] = ROUNDING;
        let additions = (PARTIAL_SUM + self.count / PARTIAL_SUM + 2) as f64;
        LEBESGUE * (self.size * (own + addition * additions) + self.loss)
    }

    /// Returns the sums with the parent's polynomial.
    fn finish(self, parent: Option<&Cell>) -> [f32x8; VECTORS] {
        let mut all: [f32x8; VECTORS] = core::array::from_fn(|i| self.whole[i] + self.partial[i]);
        if let Some(parent) = parent {
            let outer = 1.0 / (LOOSE * parent.half);
            let shift = ((self.center - parent.center) * outer).as_vec3().to_array();
            let scale = f32x8::splat((self.half * outer) as f32);
            for (sum, node) in all.iter_mut().zip(self.nodes) {
                let place = core::array::from_fn(|i| f32x8::splat(shift[i]) + node[i] * scale);
                *sum += Expansion::value(place, &parent.expansion);
            }
        }
        all
    }
}

impl Cell {
    /// The number of the part that holds a place.
    #[inline]
    #[must_use]
    pub fn part_of(&self, place: DVec3) -> usize {
        let above = |axis: usize| usize::from(place[axis] >= self.center[axis]) << axis;
        above(0) | above(1) | above(2)
    }

    /// Half the side of the box in which the expansion holds.
    #[inline]
    #[must_use]
    pub fn reach(&self) -> f64 {
        LOOSE * self.half
    }
}
