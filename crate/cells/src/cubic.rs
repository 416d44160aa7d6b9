//! Cubics of three variables that stand for a function in a cube.
//!
//! The function is sampled at Chebyshev's nodes, four along each axis. There its Chebyshev series
//! up to the third degree along each axis follows from sums over the samples:
//! `c_ijk = Σ f·T_i·T_j·T_k` times 1/4 for each degree 0, 1/2 for others. Of these 64 terms the
//! cubic keeps the 20 of total degree 3 or less. The sizes of the others, which are at most 1 times
//! their coefficients in the cube, tell how well it stands for the function. They tell nothing of
//! the fourth and fifth degree along an axis, which is all that is left out of a function of one
//! coordinate: value and gradient in the middle do.

use glam::DVec3;

/// Number of samples along an axis.
const SIDE: usize = 4;
/// Number of samples.
pub(crate) const SAMPLES: usize = SIDE * SIDE * SIDE;
/// Number of coefficients.
pub(crate) const COEFFICIENTS: usize = 20;

/// Chebyshev's nodes: cos(π(k + ½)/4).
const NODES: [f64; SIDE] = [
    0.923_879_532_511_286_7,
    0.382_683_432_365_089_8,
    -0.382_683_432_365_089_8,
    -0.923_879_532_511_286_7,
];

/// Exponents of x, y and z of the monomials, in the order of `cubic` in `shaders/march.wgsl`.
const MONOMIALS: [[usize; 3]; COEFFICIENTS] = [
    [0, 0, 0],
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
    [2, 0, 0],
    [0, 2, 0],
    [0, 0, 2],
    [1, 1, 0],
    [1, 0, 1],
    [0, 1, 1],
    [1, 1, 1],
    [3, 0, 0],
    [0, 3, 0],
    [0, 0, 3],
    [2, 1, 0],
    [2, 0, 1],
    [1, 2, 0],
    [0, 2, 1],
    [1, 0, 2],
    [0, 1, 2],
];

/// Chebyshev's polynomials of the degrees 0 to 3, by powers.
const CHEBYSHEV: [[f64; SIDE]; SIDE] = [
    [1.0, 0.0, 0.0, 0.0],
    [0.0, 1.0, 0.0, 0.0],
    [-1.0, 0.0, 2.0, 0.0],
    [0.0, -3.0, 0.0, 4.0],
];

/// Cubic of the coordinates in a cube, each from −1 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cubic {
    /// The coefficients of [`MONOMIALS`].
    pub(crate) coefficients: [f64; COEFFICIENTS],
    /// Bound on how far the cubic is from its mean.
    pub(crate) spread: f64,
    /// The mean.
    pub(crate) mean: f64,
    /// Sum of the sizes of what the cubic leaves out, as far as the samples tell.
    pub(crate) error: f64,
}

/// Returns the places of the samples in a cube.
pub(crate) fn places() -> [DVec3; SAMPLES] {
    core::array::from_fn(|n| {
        let [x, y, z] = [0, 1, 2].map(|axis| NODES[n / SIDE.pow(axis) % SIDE]);
        DVec3::new(x, y, z)
    })
}

impl Cubic {
    /// Fits samples at [`places`].
    pub(crate) fn fit(samples: &[f64; SAMPLES]) -> Self {
        let mut series = *samples;
        for axis in 0..3 {
            let step = SIDE.pow(axis);
            for start in (0..SAMPLES).filter(|n| n / step % SIDE == 0) {
                let line: [f64; SIDE] = core::array::from_fn(|k| series[start + k * step]);
                for degree in 0..SIDE {
                    let factor = if degree == 0 { 0.25 } else { 0.5 };
                    let sum: f64 = (0..SIDE)
                        .map(|k| line[k] * chebyshev(degree, NODES[k]))
                        .sum();
                    series[start + degree * step] = factor * sum;
                }
            }
        }
        let mut cubic = Self {
            coefficients: [0.0; COEFFICIENTS],
            spread: 0.0,
            mean: series[0],
            error: 0.0,
        };
        for (n, term) in series.into_iter().enumerate() {
            let degrees = [n % SIDE, n / SIDE % SIDE, n / (SIDE * SIDE)];
            match degrees.iter().sum() {
                0_usize => {}
                1..=3 => cubic.spread += term.abs(),
                _ => {
                    cubic.error += term.abs();
                    continue;
                }
            }
            for (coefficient, powers) in cubic.coefficients.iter_mut().zip(&MONOMIALS) {
                let parts = (0..3).map(|axis| CHEBYSHEV[degrees[axis]][powers[axis]]);
                *coefficient += term * parts.product::<f64>();
            }
        }
        cubic
    }

    /// Adds to the error how far the cubic misses a value and a gradient in the middle.
    pub(crate) fn check_center(&mut self, value: f64, gradient: DVec3) {
        let [own, x, y, z, ..] = self.coefficients;
        // There T₄ is 1, and T₅ has a slope that is larger by 2 than that of −T₃, which has the
        // same samples.
        let slope = gradient.distance(DVec3::new(x, y, z)) / 2.0;
        let off = (value - own).abs() + slope;
        self.error += if off.is_finite() { off } else { f64::INFINITY };
    }

    /// Computes the value at a place in the cube.
    #[cfg(test)]
    pub(crate) fn value(&self, place: DVec3) -> f64 {
        let terms = self.coefficients.iter().zip(&MONOMIALS);
        let axes = place.to_array();
        terms
            .map(|(c, powers)| {
                let factors = axes.iter().zip(powers).flat_map(|(x, n)| vec![*x; *n]);
                c * factors.product::<f64>()
            })
            .sum()
    }
}

/// Computes Chebyshev's polynomial of a degree.
fn chebyshev(degree: usize, x: f64) -> f64 {
    let [a, b, c, d] = CHEBYSHEV[degree];
    a + x * (b + x * (c + x * d))
}

#[cfg(test)]
mod tests {
    use super::*;
    use trials::{Random, count};

    #[test]
    fn cubics_are_fitted_exactly() {
        let mut random = Random::new(1);
        for _ in 0..count(100) {
            let coefficients = core::array::from_fn(|_| random.range(-1.0, 1.0));
            let truth = Cubic {
                coefficients,
                spread: 0.0,
                mean: 0.0,
                error: 0.0,
            };
            let fitted = Cubic::fit(&places().map(|place| truth.value(place)));
            assert!(fitted.error < 1e-13, "{fitted:?}");
            let place = DVec3::from_array(core::array::from_fn(|_| random.range(-1.0, 1.0)));
            let off = fitted.value(place) - truth.value(place);
            assert!(off.abs() < 1e-13, "{off}");
            assert!((fitted.value(place) - fitted.mean).abs() <= fitted.spread);
        }
    }

    #[test]
    fn errors_of_functions_of_one_coordinate_are_told_in_the_middle() {
        // Chebyshev's polynomials.
        fn function(degree: f64, z: f64) -> f64 {
            libm::cos(degree * libm::acos(z))
        }
        for degree in [4.0, 5.0] {
            let mut fitted = Cubic::fit(&places().map(|place| function(degree, place.z)));
            let (ahead, behind) = (function(degree, 1e-6), function(degree, -1e-6));
            let slope = (ahead - behind) / 2e-6;
            fitted.check_center(function(degree, 0.0), DVec3::new(0.0, 0.0, slope));
            assert!(fitted.error > 0.9, "{degree}: {}", fitted.error);
        }
    }

    #[test]
    fn errors_of_smooth_functions_are_told() {
        let mut random = Random::new(2);
        for _ in 0..count(100) {
            let wave = DVec3::from_array(core::array::from_fn(|_| random.range(-1.0, 1.0)));
            let phase = random.range(0.0, 6.0);
            let fitted = Cubic::fit(&places().map(|place| libm::sin(place.dot(wave) + phase)));
            for _ in 0..20 {
                let place = DVec3::from_array(core::array::from_fn(|_| random.range(-1.0, 1.0)));
                let off = (fitted.value(place) - libm::sin(place.dot(wave) + phase)).abs();
                assert!(off <= 3.0 * fitted.error + 0.01, "{off} {}", fitted.error);
            }
        }
    }
}
