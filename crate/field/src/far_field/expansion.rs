//! Polynomials of three variables on a box, by interpolation at Chebyshev nodes.
//!
//! Values at 5 × 5 × 5 nodes give the coefficients of products of Chebyshev polynomials up to
//! degree 4 in each coordinate. Those of total degree above 5 are dropped, and the sum of their
//! sizes is the exact bound of what that changes, since |Tₖ| ≤ 1. The rest are kept as powers of
//! the coordinates, so that along a straight line the polynomial is one of degree 5 in one
//! variable.
use crate::{Jet, Real};
use core::f64::consts::PI;
use std::sync::OnceLock;
use wide::f32x8;

/// Nodes along each axis.
pub const NODES: usize = 5;
/// Nodes of a box.
pub const ALL: usize = NODES * PLANE;
/// Vectors of eight that hold a value for each node.
pub const VECTORS: usize = ALL.div_ceil(8);
/// Largest total degree.
pub const DEGREE: usize = 5;
/// Number of coefficients.
const TERMS: usize = 53;
/// Lebesgue's constant of interpolation at the nodes of three axes: the largest factor on errors of
/// the values.
pub const LEBESGUE: f64 = 7.9;
/// Upper bound on √3, the ratio of a gradient's length to its largest component.
pub const AXES: f64 = 1.733;
/// Largest ratio of a gradient's component to the polynomial's size, in the box's coordinates:
/// Markov's inequality for degree 4.
const MARKOV: f64 = 16.0;
/// Rounding of the polynomial's evaluation in single precision, relative to the sum of its
/// coefficients' sizes.
const ROUNDING: f64 = 2e-6;
/// Rounding of its coefficients in single precision.
const STORED: f64 = 6e-8;

/// A function on a box `center ± half`, in coordinates from −1 to 1.
#[derive(Clone, Debug)]
pub struct Expansion {
    /// Coefficients of `xⁱyʲzᵏ`, i innermost.
    terms: [f32; TERMS],
}

/// An interpolant: coefficients of products of Chebyshev polynomials, in the order of an
/// expansion's terms.
#[derive(Clone, Debug)]
pub struct Series {
    terms: [f32; TERMS],
    /// Bound on what dropped terms and rounding change.
    pub error: f64,
}

impl Series {
    /// The series 0.
    pub const ZERO: Self = Self {
        terms: [0.0; TERMS],
        error: 0.0,
    };

    /// The interpolant of values at the [`nodes`].
    pub fn fit(values: &[f64; ALL]) -> Self {
        let mut all = *values;
        apply([&tables().chebyshev; 3], &mut all);
        let size: f64 = all.iter().map(|term| term.abs()).sum();
        let mut terms = [0.0; TERMS];
        let (mut next, mut kept) = (0, 0.0);
        each_term(|node| {
            kept += all[node].abs();
            terms[next] = all[node] as f32;
            next += 1;
        });
        Self {
            terms,
            error: (size - kept) + STORED * size,
        }
    }
}

/// Calls a function with the number of each node whose degrees add up to no more than [`DEGREE`].
fn each_term(mut act: impl FnMut(usize)) {
    for k in 0..=most(0) {
        for j in 0..=most(k) {
            for i in 0..=most(j + k) {
                act((k * NODES + j) * NODES + i);
            }
        }
    }
}

/// An expansion with what is known of it.
pub struct Fitted {
    /// The polynomial.
    pub expansion: Expansion,
    /// Bound on the rounding of its coefficients.
    pub error: f64,
    /// Bound on the rounding of its evaluation.
    pub evaluation: f64,
    /// Bounds on it in the box from below and above.
    pub range: [f64; 2],
}

/// Returns a bound on the gradient's length of a polynomial with degree 4 in each coordinate, on a
/// box of this half extent, given one on its size.
pub fn slope_of(size: f64, half: f64) -> f64 {
    AXES * MARKOV * size / half
}

/// Coefficients of products of Chebyshev polynomials, x innermost.
pub type Coefficients = [f64; ALL];

/// Matrix that acts along one axis.
type Matrix = [[f64; NODES]; NODES];

/// The nodes and the matrices from values to Chebyshev coefficients and from these to powers.
struct Tables {
    nodes: [f64; NODES],
    chebyshev: Matrix,
    powers: Matrix,
}

fn tables() -> &'static Tables {
    static TABLES: OnceLock<Tables> = OnceLock::new();
    TABLES.get_or_init(|| {
        let angle = |i: usize| PI * (2 * i + 1) as f64 / (2 * NODES) as f64;
        Tables {
            nodes: core::array::from_fn(|i| libm::cos(angle(i))),
            chebyshev: core::array::from_fn(|k| {
                let weight = if k == 0 { 1.0 } else { 2.0 } / NODES as f64;
                core::array::from_fn(|i| weight * libm::cos(k as f64 * angle(i)))
            }),
            // Row i: the coefficient of xⁱ in each Chebyshev polynomial.
            powers: [
                [1.0, 0.0, -1.0, 0.0, 1.0],
                [0.0, 1.0, 0.0, -3.0, 0.0],
                [0.0, 0.0, 2.0, 0.0, -8.0],
                [0.0, 0.0, 0.0, 4.0, 0.0],
                [0.0, 0.0, 0.0, 0.0, 8.0],
            ],
        }
    })
}

/// Coordinates of the nodes along an axis, −1 to 1.
pub fn axis() -> [f32; NODES] {
    tables().nodes.map(|x| x as f32)
}

/// Coordinates of the nodes eight at a time, x innermost; those beyond the last repeat it.
pub fn nodes() -> [[f32x8; 3]; VECTORS] {
    let x = axis();
    core::array::from_fn(|v| {
        core::array::from_fn(|axis| {
            f32x8::new(core::array::from_fn(|lane| {
                let node = (8 * v + lane).min(ALL - 1);
                x[node / [1, NODES, NODES * NODES][axis] % NODES]
            }))
        })
    })
}

/// Nodes of a plane.
const PLANE: usize = NODES * NODES;

/// Multiplies the values along each axis by a matrix: those of x, y and z.
fn apply([x, y, z]: [&Matrix; 3], values: &mut [f64; ALL]) {
    // Along the last axis, whose planes are rows of memory; then the axes change places, and after
    // three times are as before.
    for matrix in [z, y, x] {
        let mut rows = [[0.0; PLANE]; NODES];
        for (row, factors) in rows.iter_mut().zip(matrix) {
            for (plane, factor) in values.chunks_exact(PLANE).zip(factors) {
                for (sum, value) in row.iter_mut().zip(plane) {
                    *sum += factor * value;
                }
            }
        }
        for (at, own) in values.chunks_exact_mut(NODES).enumerate() {
            for (value, row) in own.iter_mut().zip(&rows) {
                *value = row[at];
            }
        }
    }
}

/// Largest degree in x, or in y, where the other degrees add up to `others`.
#[inline(always)]
const fn most(others: usize) -> usize {
    if DEGREE - others < NODES - 1 {
        DEGREE - others
    } else {
        NODES - 1
    }
}

impl Expansion {
    /// The polynomial 0.
    pub const ZERO: Self = Self {
        terms: [0.0; TERMS],
    };

    /// The sum of an interpolant and of a polynomial's [coefficients](Expansion::in_part).
    pub fn of(series: &Series, more: Option<&Coefficients>) -> Fitted {
        let mut all = [0.0; ALL];
        let mut size = 0.0;
        let mut next = 0;
        each_term(|node| {
            let own = f64::from(series.terms[next]) + more.map_or(0.0, |more| more[node]);
            size += own.abs();
            all[node] = own;
            next += 1;
        });
        let first = all[0];
        let change = size - first.abs();
        apply([&tables().powers; 3], &mut all);
        let mut terms = [0.0; TERMS];
        let mut next = 0;
        let mut largest = 0.0;
        each_term(|node| {
            let term = all[node];
            largest += term.abs();
            terms[next] = term as f32;
            next += 1;
        });
        let error = STORED * largest;
        let evaluation = ROUNDING * largest;
        let change = change + evaluation;
        Fitted {
            expansion: Self { terms },
            error,
            evaluation,
            range: [first - change - error, first + change + error],
        }
    }

    /// Coefficients in τ of the polynomial on the line `place + τ·step`, both in the box's
    /// coordinates. `single` converts a number.
    #[inline(always)]
    #[must_use]
    pub fn along<R: Real>(
        &self,
        place: [R; 3],
        step: [R; 3],
        single: impl Fn(f32) -> R,
    ) -> [R; DEGREE + 1] {
        let zero = R::splat(0.0);
        // Multiplies a polynomial of some degree by the line's coordinate, and adds another.
        let times = |sum: &mut [R; DEGREE + 1], degree: usize, axis: usize| {
            for n in (1..=degree).rev() {
                sum[n] = sum[n] * place[axis] + sum[n - 1] * step[axis];
            }
            sum[0] = sum[0] * place[axis];
        };
        let mut next = TERMS;
        let mut by_z = [zero; DEGREE + 1];
        for k in (0..=most(0)).rev() {
            let mut by_y = [zero; DEGREE + 1];
            for j in (0..=most(k)).rev() {
                let mut by_x = [zero; DEGREE + 1];
                let top = most(j + k);
                for i in (0..=top).rev() {
                    next -= 1;
                    times(&mut by_x, top - i, 0);
                    by_x[0] = by_x[0] + single(self.terms[next]);
                }
                times(&mut by_y, DEGREE - k - j, 1);
                for (sum, own) in by_y.iter_mut().zip(&by_x[..=top]) {
                    *sum = *sum + *own;
                }
            }
            times(&mut by_z, DEGREE - k, 2);
            for (sum, own) in by_z.iter_mut().zip(&by_y[..=DEGREE - k]) {
                *sum = *sum + *own;
            }
        }
        by_z
    }

    /// Value and gradient at a place, both in the box's coordinates.
    #[inline(always)]
    #[must_use]
    pub fn jet<R: Real>(&self, [x, y, z]: [R; 3], single: impl Fn(f32) -> R) -> Jet<R> {
        let zero = R::splat(0.0);
        let mut next = TERMS;
        let mut sum = Jet::zero();
        for k in (0..=most(0)).rev() {
            let (mut plane, mut plane_x, mut plane_y) = (zero, zero, zero);
            for j in (0..=most(k)).rev() {
                let (mut row, mut row_x) = (zero, zero);
                for _ in 0..=most(j + k) {
                    next -= 1;
                    row_x = row_x * x + row;
                    row = row * x + single(self.terms[next]);
                }
                plane_y = plane_y * y + plane;
                plane = plane * y + row;
                plane_x = plane_x * y + row_x;
            }
            sum.gradient[2] = sum.gradient[2] * z + sum.value;
            sum.value = sum.value * z + plane;
            sum.gradient[0] = sum.gradient[0] * z + plane_x;
            sum.gradient[1] = sum.gradient[1] * z + plane_y;
        }
        sum
    }

    /// Coefficients of the polynomial in the coordinates of a smaller box, of which
    /// `shift + scale·x` is a place in this one's.
    #[must_use]
    pub fn in_part(&self, shift: [f64; 3], scale: f64) -> Coefficients {
        let mut all = [0.0; ALL];
        let mut next = 0;
        each_term(|node| {
            all[node] = f64::from(self.terms[next]);
            next += 1;
        });
        // Column k: the coefficients of (shift + scale·x)ᵏ, by x·Tₙ = (Tₙ₋₁ + Tₙ₊₁)/2.
        let [x, y, z] = shift.map(|shift| {
            let mut matrix: Matrix = [[0.0; NODES]; NODES];
            let mut power = [0.0; NODES + 2];
            power[0] = 1.0;
            for k in 0..NODES {
                for (row, own) in matrix.iter_mut().zip(power) {
                    row[k] = own;
                }
                let before = power;
                for n in 0..NODES {
                    let lower = if n == 0 { 0.0 } else { before[n - 1] };
                    // x·T₀ is T₁ as a whole.
                    let lower = if n == 1 { 2.0 * lower } else { lower };
                    power[n] = shift * before[n] + 0.5 * scale * (lower + before[n + 1]);
                }
            }
            matrix
        });
        apply([&x, &y, &z], &mut all);
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trials::{Random, count};

    /// Returns a node's coordinates.
    fn place_of(node: usize) -> [f64; 3] {
        nodes()[node / 8].map(|x| f64::from(x.to_array()[node % 8]))
    }

    /// A polynomial within the degrees is reproduced, with its gradient, and along lines.
    #[test]
    fn polynomials_are_reproduced() {
        let mut random = Random::new(4);
        for _ in 0..count(20) {
            let c: [f64; 6] = core::array::from_fn(|_| random.range(-1.0, 1.0));
            let f = |[x, y, z]: [f64; 3]| {
                let mixed = c[3] * x * x * y * z * z + c[4] * x.powi(4) * y;
                c[0] + c[1] * x + c[2] * y * z + mixed + c[5] * y * y * z * z * x
            };
            let values = core::array::from_fn(|node| f(place_of(node)));
            let series = Series::fit(&values);
            let fitted = Expansion::of(&series, None);
            let error = fitted.error + series.error;
            assert!(error < 1e-4, "{error}");
            let (shift, scale) = (random.vector(0.5).to_array(), 0.4);
            let moved = fitted.expansion.in_part(shift, scale);
            let moved = Expansion::of(&Series::ZERO, Some(&moved)).expansion;
            for _ in 0..20 {
                let place = random.vector(1.0).to_array();
                let jet = fitted.expansion.jet(place, f64::from);
                assert!((jet.value - f(place)).abs() <= error + 1e-6);
                let outer = core::array::from_fn(|i| shift[i] + scale * place[i]);
                let want = fitted.expansion.jet(outer, f64::from).value;
                let told = moved.jet(place, f64::from).value;
                assert!((told - want).abs() < 1e-6, "{told} {want}");
                assert!(fitted.range[0] <= jet.value && jet.value <= fitted.range[1]);
                for axis in 0..3 {
                    let [mut a, mut b] = [place; 2];
                    (a[axis], b[axis]) = (a[axis] - 1e-4, b[axis] + 1e-4);
                    let slope = (f(b) - f(a)) / 2e-4;
                    assert!((jet.gradient[axis] - slope).abs() < 1e-4, "{slope} {jet:?}");
                }
                let step = random.vector(0.3).to_array();
                let line = fitted.expansion.along(place, step, f64::from);
                let t = random.range(-1.0, 1.0);
                let there = core::array::from_fn(|i| place[i] + t * step[i]);
                let value = line.iter().rev().fold(0.0, |sum, c| sum * t + c);
                let want = fitted.expansion.jet(there, f64::from).value;
                assert!((value - want).abs() < 1e-12, "{value} {want}");
            }
        }
    }

    /// The terms dropped from a polynomial are part of its bound.
    #[test]
    fn terms_of_higher_degree_count_as_error() {
        let values = core::array::from_fn(|node| {
            let [x, y, z] = place_of(node);
            x * x * x * y * y * z
        });
        let series = Series::fit(&values);
        // x³y²z = (T₃ + 3T₁)/4·(T₂ + 1)/2·T₁: its part of degree 6 is an eighth.
        assert!((series.error - 0.125).abs() < 1e-3, "{}", series.error);
        let jet = Expansion::of(&series, None)
            .expansion
            .jet([1.0; 3], f64::from);
        assert!((jet.value - 0.875).abs() < 1e-5, "{jet:?}");
    }
}
