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
//! e = 4, ε = 1 for Cauchy's. Along a straight line that is the generating function's root of the Gegenbauer polynomials
//! `C_n` of order e/2: its n-th derivative is `±n!·C_n(cos θ)·b^(−e−n)` with `b² = ε² + u²`, where `b·cos θ` is the position
//! along the line. A skeleton adds up such terms. With A = 1 − I, the error of interpolation along an axis at n = 5 Chebyshev nodes of
//! an interval of half length w, `|A f| ≤ 2(w/2)ⁿ/n!·|f⁽ⁿ⁾|`. Interpolation along all three axes, in any order, is off by
//! `A₁f + I₁A₂f + I₁I₂A₃f`, and |I| ≤ Λ, so that the error is at most
//!
//! `2M·q⁵·(c₁ + Λc₂ + Λ²c₃)`, `q = s·w/2b`, `c₁ ≥ c₂ ≥ c₃`,
//!
//! where M bounds the field, s is the width parameter, and cᵢ bounds |C₅(cos θ)| for the lines along axis i. |C₅| is small up to a
//! certain cosine, which at most one axis exceeds as seen from far away. Interpolation of the parent's polynomial is exact.
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
pub const MOST_ERROR: f64 = 1e-4 * THRESHOLD;
/// Part of what is left of [`MOST_ERROR`] that one more cell may use up.
const PORTION: f64 = 0.25;
/// Error up to which a primitive is far, as a part of what the cell may use up, at first.
const FIRST_SHARE: f64 = 0.06;
/// Largest number of halvings of that.
const MOST_HALVINGS: u32 = 24;
/// Number of values in a partial sum of single precision.
const PARTIAL_SUM: usize = 32;
/// Rounding of a primitive's value in single precision, relative to it, and of one addition.
const ROUNDING: [f64; 2] = [2e-6, 6e-8];
/// Rounding of coordinates in single precision, in the world and in a primitive's own frame, relative to them.
const MISPLACED: f64 = 2.5e-7;
/// Part of T by which bounds must be below it.
const BELOW: f64 = 1e-5;

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
    /// The kernel's exponent and softening; an exponent of 0 tells that there is no expansion.
    power: i32,
    softening: f64,
}

/// A primitive as seen from a box.
#[derive(Clone, Copy, Debug)]
struct Seen {
    /// Bound on its size in the box.
    magnitude: f64,
    /// Bound on the error of its expansion, or of leaving it out.
    error: f64,
    /// Its largest slope over its size, about, where its place is rounded to single precision.
    steep: f64,
}

/// The hierarchy of a list of primitives.
#[derive(Debug)]
pub struct FarField {
    sources: Vec<Source>,
    points: Option<Points>,
    center: DVec3,
    half: f64,
    nodes: [[f32x8; 3]; VECTORS],
    /// Whether cells in which the field is below T are left empty.
    surface_only: bool,
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
    /// Whether there is nothing but this bound, since it is below T ([`FarField::surface_only`]).
    pub is_empty: bool,
    children: [OnceLock<Box<Cell>>; 8],
}

impl Source {
    fn of(primitive: &Primitive) -> Self {
        let bound = Bound::new(primitive);
        let [whole, width] = bound.far();
        let ball = primitive.skeleton.bounding_sphere();
        let (center, around) = ball.unwrap_or((DVec3::ZERO, f64::INFINITY));
        let plain = !bound.has_profile() && ball.is_some() && whole.is_finite();
        let kernel = power(primitive.kernel).filter(|_| plain);
        let (power, softening) = kernel.unwrap_or_default();
        let term = &primitive.prepared.double;
        let is_point = power > 0 && matches!(term.form.bone, Bone::Point);
        Self {
            center,
            around,
            whole,
            width,
            finest: primitive.width,
            point: is_point.then_some(term.amplitude as f32),
            adds: bound.adds(),
            kernel: primitive.kernel,
            power,
            softening,
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
        if self.power == 0 {
            return Seen {
                magnitude,
                error: magnitude,
                steep,
            };
        }
        let u = distance * self.width;
        let b = (self.softening + u * u).sqrt();
        let inverse = 1.0 / b;
        let own = self.whole * (0..self.power).fold(1.0, |product, _| product * inverse);
        let magnitude = magnitude.at_most(own);
        let q = 0.5 * self.finest * half * inverse;
        // The parts of a skeleton are seen along different lines.
        let factor = GEGENBAUER[self.power as usize - 1].factor(3);
        Seen {
            magnitude,
            error: own * (q * q * q * q * q) * factor,
            steep,
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

/// Bounds on the Gegenbauer polynomial C₅ of order e/2, e = 1 to 4: everywhere, and up to a cosine.
#[derive(Clone, Copy)]
struct Gegenbauer {
    /// Value at 1, the largest.
    high: f64,
    /// Largest size up to the cosine …
    low: f64,
    /// … with this square.
    square: f64,
}

const GEGENBAUER: [Gegenbauer; 4] = [
    Gegenbauer {
        high: 1.0,
        low: 0.42,
        square: 0.91,
    },
    Gegenbauer {
        high: 6.0,
        low: 1.44,
        square: 0.833,
    },
    Gegenbauer {
        high: 21.0,
        low: 3.3,
        square: 0.767,
    },
    Gegenbauer {
        high: 56.0,
        low: 6.2,
        square: 0.71,
    },
];

/// Lebesgue's constant of one axis.
const LAMBDA: f64 = 1.99;

impl Gegenbauer {
    /// `2(c₁ + Λc₂ + Λ²c₃)`, of which so many axes may exceed the cosine.
    fn factor(self, high: usize) -> f64 {
        let of = |axis: usize| if axis < high { self.high } else { self.low };
        2.0 * (of(0) + LAMBDA * of(1) + LAMBDA * LAMBDA * of(2))
    }
}

/// All primitives side by side, if they are points of one kernel.
#[derive(Debug)]
struct Points {
    /// Place, width parameter, bound on the field over the kernel.
    place: [Vec<f32>; 3],
    scale: Vec<f32>,
    whole: Vec<f32>,
    power: i32,
    softening: f32,
    /// Largest coordinate of a place.
    furthest: f64,
    /// [`Gegenbauer::factor`] for 0 to 3 axes.
    factors: [f32; 4],
    square: f32,
}

impl Points {
    /// `None` if the sources are anything else.
    fn of(sources: &[Source]) -> Option<Self> {
        let power = sources.first()?.power;
        let plain = |s: &Source| s.point.is_some() && s.power == power;
        if !sources.iter().all(plain) {
            return None;
        }
        let all = |of: &dyn Fn(&Source) -> f64| sources.iter().map(|s| of(s) as f32).collect();
        let furthest = sources.iter().map(|s| s.center.abs().max_element());
        let bounds = GEGENBAUER[power as usize - 1];
        Some(Self {
            place: core::array::from_fn(|i| all(&|s| s.center[i])),
            scale: all(&|s| s.finest),
            whole: all(&|s| s.whole),
            power,
            softening: sources[0].softening as f32,
            furthest: furthest.fold(0.0, f64::max),
            factors: core::array::from_fn(|high| bounds.factor(high) as f32),
            square: bounds.square as f32,
        })
    }

    /// Bounds on sizes and errors of some points in a box, rounded upwards.
    fn seen(&self, center: DVec3, half: f64, candidates: &[u32], seen: &mut Vec<Seen>) {
        let coordinates = self.furthest + center.abs().max_element();
        // Places are rounded.
        let wide = half * (1.0 + 1e-6) + MISPLACED * coordinates;
        let half = f32x8::splat(wide as f32);
        let center = center.as_vec3().to_array().map(f32x8::splat);
        let (zero, one) = (f32x8::splat(0.0), f32x8::splat(1.0));
        let softening = f32x8::splat(self.softening);
        let square = f32x8::splat(self.square * (1.0 - 1e-4));
        let rest = f32x8::splat(1.0 - self.square * (1.0 - 1e-4));
        let [f0, f1, f2, f3] = self.factors.map(f32x8::splat);
        let up = f32x8::splat(1.0 + 1e-4);
        for block in candidates.chunks(8) {
            let gather = |row: &[f32]| {
                let of = |lane: usize| row[block[lane.min(block.len() - 1)] as usize];
                f32x8::new(core::array::from_fn(of))
            };
            let (scale, whole) = (gather(&self.scale), gather(&self.whole));
            // In kernel widths, squared.
            let widths = scale * scale;
            let away: [f32x8; 3] =
                core::array::from_fn(|i| (gather(&self.place[i]) - center[i]).abs());
            let outside = away
                .map(|x| (x - half).fast_max(zero))
                .map(|x| x * x * widths);
            let [x, y, z] = outside;
            let base = softening + x + y + z;
            let inverse = one / base;
            let size = match self.power {
                1 => inverse.sqrt(),
                2 => inverse,
                3 => inverse * inverse.sqrt(),
                _ => inverse * inverse,
            };
            let size = whole * size * up;
            let inner = f32x8::splat(0.25) * half * half * widths * inverse;
            let five = inner * inner * inner.sqrt();
            // cos² = X²/(X² + R²), with the largest X and the least R in the box.
            let mut high = zero;
            for (own, outside) in away.iter().zip(outside) {
                let most = *own + half;
                let steep = (square * (base - outside)).simd_lt(rest * (most * most * widths));
                high += steep.select(one, zero);
            }
            let factor = f32x8::splat(0.5).simd_lt(high).select(f1, f0);
            let factor = f32x8::splat(1.5).simd_lt(high).select(f2, factor);
            let factor = f32x8::splat(2.5).simd_lt(high).select(f3, factor);
            let error = size * five * factor * up;
            let (size, error) = (size.to_array(), error.to_array());
            seen.extend((0..block.len()).map(|lane| Seen {
                magnitude: f64::from(size[lane]),
                error: f64::from(error[lane]),
                steep: 0.0,
            }));
        }
    }
}

impl FarField {
    /// The hierarchy of some primitives in a cube of space with this half side.
    #[must_use]
    pub fn new(primitives: &[Primitive], center: DVec3, half: f64) -> Self {
        let sources: Vec<Source> = primitives.iter().map(Source::of).collect();
        Self {
            points: Points::of(&sources),
            sources,
            center,
            half,
            nodes: expansion::nodes(),
            surface_only: false,
            root: OnceLock::new(),
        }
    }

    /// The same for those who look for the surface alone: where bounds show that the field is below T, cells have no list, no
    /// polynomial and no parts, and cost next to nothing.
    #[must_use]
    pub fn surface_only(self) -> Self {
        Self {
            surface_only: true,
            ..self
        }
    }

    /// The cube itself, given the primitives of which the hierarchy was made.
    pub fn root(&self, primitives: &[Primitive]) -> &Cell {
        self.root.get_or_init(|| {
            let all: Vec<u32> = (0..self.sources.len() as u32).collect();
            Box::new(self.cell(primitives, self.center, self.half, &all, None))
        })
    }

    /// One of the eight parts of a cell that is not empty: bit i of the number tells that it is the upper half along axis i.
    pub fn part<'c>(&self, primitives: &[Primitive], of: &'c Cell, number: usize) -> &'c Cell {
        if of.is_empty {
            return of;
        }
        of.children[number].get_or_init(|| {
            let half = 0.5 * of.half;
            let side = |axis: usize| if number >> axis & 1 == 0 { -half } else { half };
            let center = of.center + DVec3::new(side(0), side(1), side(2));
            Box::new(self.cell(primitives, center, half, &of.near, Some(of)))
        })
    }

    /// Some primitives as seen from a box.
    fn seen(&self, center: DVec3, half: f64, candidates: &[u32]) -> Vec<Seen> {
        let Some(points) = &self.points else {
            let seen = candidates.iter();
            return seen
                .map(|&i| self.sources[i as usize].seen(center, half))
                .collect();
        };
        let mut seen = Vec::with_capacity(candidates.len());
        points.seen(center, half, candidates, &mut seen);
        seen
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
        let seen = self.seen(center, loose, candidates);
        let adding = candidates.iter().zip(&seen);
        let adding = adding.filter(|(i, _)| self.sources[**i as usize].adds);
        let bound = parent.map_or(0.0, |parent| parent.far_most)
            + adding.map(|(_, seen)| seen.magnitude).sum::<f64>();
        if self.surface_only && bound < THRESHOLD * (1.0 - BELOW) {
            return Cell {
                center,
                half,
                near: Vec::new(),
                expansion: Expansion::ZERO,
                error: inherited,
                far_most: bound,
                most: bound,
                is_empty: true,
                children: Default::default(),
            };
        }
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
                if source.power > 0 {
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
                is_empty: false,
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
            is_empty: false,
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

    /// Whether a place is in the cell.
    #[inline]
    #[must_use]
    pub fn holds(&self, place: DVec3) -> bool {
        (place - self.center).abs().max_element() <= self.half
    }

    /// Half the side of the box in which the expansion holds.
    #[inline]
    #[must_use]
    pub fn reach(&self) -> f64 {
        LOOSE * self.half
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The bounds on Gegenbauer polynomials: everywhere, and up to the cosine, where they are nearly reached.
    #[cfg_attr(target_arch = "wasm32", wasm_bindgen_test::wasm_bindgen_test)]
    #[cfg_attr(not(target_arch = "wasm32"), test)]
    fn gegenbauer_polynomials_are_bounded() {
        for (bounds, e) in GEGENBAUER.iter().zip(1..) {
            let order = 0.5 * f64::from(e);
            let polynomial = |x: f64| {
                let (mut before, mut own) = (1.0, 2.0 * order * x);
                for n in 2..=5 {
                    let n = f64::from(n);
                    let next = 2.0 * x * (n + order - 1.0) * own - (n + 2.0 * order - 2.0) * before;
                    (before, own) = (own, next / n);
                }
                own.abs()
            };
            let (mut low, mut high) = (0.0f64, 0.0f64);
            for i in 0..=10_000 {
                let x = f64::from(i) * 1e-4;
                high = high.max(polynomial(x));
                if x * x <= bounds.square {
                    low = low.max(polynomial(x));
                }
            }
            assert!(high <= bounds.high * (1.0 + 1e-12), "{e}: {high}");
            assert!(low <= bounds.low && low > 0.9 * bounds.low, "{e}: {low}");
        }
    }

    /// Interpolation of a single point's field at the nodes of a box is no further off than its bound, which is nearly reached.
    #[cfg_attr(target_arch = "wasm32", wasm_bindgen_test::wasm_bindgen_test)]
    #[cfg_attr(not(target_arch = "wasm32"), test)]
    fn interpolants_of_points_are_within_their_bounds() {
        use crate::{BlobScale, Shaping, Skeleton};
        let mut state = 6u64;
        let mut next = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(99);
            (state >> 33) as f64 / f64::from(1u32 << 31) * 2.0 - 1.0
        };
        let nodes: [f64; 5] =
            core::array::from_fn(|i| libm::cos(core::f64::consts::PI * (2 * i + 1) as f64 / 10.0));
        // Lagrange's polynomials.
        let weights = |x: f64| -> [f64; 5] {
            core::array::from_fn(|i| {
                let others = (0..5).filter(|j| *j != i);
                others
                    .map(|j| (x - nodes[j]) / (nodes[i] - nodes[j]))
                    .product()
            })
        };
        for kernel in [
            Kernel::Inverse,
            Kernel::Squared,
            Kernel::Cubed,
            Kernel::Cauchy,
        ] {
            let (mut tightest, mut checked) = (0.0f64, 0);
            for case in 0..400 {
                let mut direction = DVec3::new(next(), next(), next()).normalize();
                if case % 2 == 0 {
                    // Nearly along an axis.
                    direction = (DVec3::X + 0.1 * direction).normalize();
                }
                let center = direction * (1.5 + 2.0 * next().abs());
                let shaping = Shaping {
                    kernel,
                    radius: 0.05 + 0.5 * next().abs(),
                    blobbiness: -2.0,
                    blob_scale: BlobScale::Relative,
                    strength: 1.0,
                    influence: 1e-3,
                    taper: None,
                };
                let point = Primitive::new(Skeleton::Point { center }, &shaping, None);
                let point = point.expect("flesh");
                let half = 0.6;
                let points = Points::of(&[Source::of(&point)]).expect("a point");
                let mut seen = Vec::new();
                points.seen(DVec3::ZERO, half, &[0], &mut seen);
                let value = |x: f64, y: f64, z: f64| point.value([x, y, z].map(|c| c * half));
                for _ in 0..6 {
                    let place = [next(), next(), next()];
                    let [u, v, w] = place.map(weights);
                    let mut told = 0.0;
                    for k in 0..5 {
                        for j in 0..5 {
                            for i in 0..5 {
                                let own = value(nodes[i], nodes[j], nodes[k]);
                                told += u[i] * v[j] * w[k] * own;
                            }
                        }
                    }
                    let want = value(place[0], place[1], place[2]);
                    assert!(want.abs() <= seen[0].magnitude, "{kernel:?} {seen:?}");
                    let off = (told - want).abs();
                    let most = seen[0].error;
                    assert!(off <= most, "{kernel:?} {center}: {off} > {most}");
                    tightest = tightest.max(off / most);
                    checked += 1;
                }
            }
            assert!(tightest > 0.1 && checked == 2400, "{kernel:?}: {tightest}");
        }
    }
}
