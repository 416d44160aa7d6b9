//! Envelopes of a kernel's derivatives: the largest derivative along any straight line at a
//! distance u or more, and the integrals of that bound over a line and a plane at that distance.
//!
//! The order of the derivative is the highest that exists everywhere: 4 for smooth kernels; 2
//! for those whose slope has kinks (metaballs, soft, quartic), 3 for compact6. The cubic Hermite
//! interpolant on a span of length h is then within `c·hᵐ·max|f⁽ᵐ⁾|` of the function, with Peano's
//! constants c₂ = 1/16, c₃ = 1/96, c₄ = 1/384, both at a span's middle.
//!
//! The Cauchy kernel's envelopes are formulas; the other kernels' are tables, made once, from upper
//! sums over steps of 1/64 octave.
use crate::Kernel;
use core::f64::consts::TAU;
use std::sync::OnceLock;

/// Peano's constant for each order, 2 to 4.
pub const PEANO: [f64; 3] = [1.0 / 16.0, 1.0 / 96.0, 1.0 / 384.0];

/// Bounds on a derivative at some distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Roughness {
    /// Bound at any one point.
    pub point: f64,
    /// Integral of the bound over a straight line at that distance.
    pub line: f64,
    /// Integral of the bound over a plane at that distance.
    pub plane: f64,
    /// Integral of the bound over the distance from there on.
    pub outward: f64,
}

impl Roughness {
    /// Bounds on the zero function.
    const NONE: Self = Self {
        point: 0.0,
        line: 0.0,
        plane: 0.0,
        outward: 0.0,
    };
}

/// Order of the derivative that is bounded.
#[must_use]
pub fn order(kernel: Kernel) -> usize {
    kernel.smoothness().saturating_add(1).min(4)
}

/// Returns the bounds at a distance of `u ≥ 0` kernel widths or more.
#[inline]
#[must_use]
pub fn roughness(kernel: Kernel, u: f64) -> Roughness {
    if let Some(roughness) = kernel.roughness(u) {
        return roughness;
    }
    if kernel.is_compact() && u >= 1.0 {
        return Roughness::NONE;
    }
    table(kernel)[index(u)]
}

/// Returns [`Roughness::point`] alone at a distance of `u ≥ 0` or more.
#[inline]
#[must_use]
pub fn rough_point(kernel: Kernel, u: f64) -> f64 {
    match kernel.value_and_roughness(u) {
        Some((_, point)) => point,
        None => roughness(kernel, u).point,
    }
}

/// Bounds on the derivative of an order (1 to 3) along any line, at a distance of `u ≥ 0` or more,
/// wherever the kernel has one.
#[must_use]
pub fn derivative(kernel: Kernel, order: usize, u: f64) -> Roughness {
    static TABLES: [[OnceLock<Vec<Roughness>>; Kernel::ALL.len()]; 3] =
        [const { [const { OnceLock::new() }; Kernel::ALL.len()] }; 3];
    if kernel.is_compact() && u >= 1.0 {
        return Roughness::NONE;
    }
    TABLES[order - 1][kernel as usize].get_or_init(|| tabulate(kernel, order))[index(u)]
}

/// Tables start at 2⁻¹⁸ (below which there is one entry) and end at 2¹⁴, with 32 entries an octave.
const FIRST: i32 = -18;
const OCTAVES: usize = 32;
const STEPS: usize = 32;

/// The entry of a distance: from the exponent and the first bits of its mantissa.
#[inline]
fn index(u: f64) -> usize {
    let from = (1023 + i64::from(FIRST)) << 5;
    let place = (u.to_bits() >> 47) as i64 - from;
    (place + 1).clamp(0, (OCTAVES * STEPS) as i64) as usize
}

fn table(kernel: Kernel) -> &'static [Roughness] {
    static TABLES: [OnceLock<Vec<Roughness>>; Kernel::ALL.len()] =
        [const { OnceLock::new() }; Kernel::ALL.len()];
    TABLES[kernel as usize].get_or_init(|| tabulate(kernel, order(kernel)))
}

/// Fine steps in one step of the table.
const FINE: usize = 2;
/// Distance in kernel widths below which a kernel without a pole is treated as constant: integrals
/// over a line from there on differ from those from the middle by less than 1 %.
const FLAT: f64 = 1.0 / 256.0;
/// Largest ratio of a derivative within a fine step (1/64 octave) to its larger end. Near a zero of
/// the derivative the envelope of larger distances counts.
const SLACK: f64 = 1.03;

fn tabulate(kernel: Kernel, order: usize) -> Vec<Roughness> {
    // Distances between fine steps; from 0 to the first in one step.
    let mut places = vec![0.0];
    for octave in 0..OCTAVES as i32 {
        let base = libm::exp2(f64::from(FIRST + octave));
        for i in 0..STEPS * FINE {
            places.push(base * (1.0 + i as f64 / (STEPS * FINE) as f64));
        }
    }
    places.push(libm::exp2(f64::from(FIRST + OCTAVES as i32)));
    // Running maximum from the far end inwards.
    let mut rough = vec![0.0f64; places.len()];
    let mut largest = 0.0f64;
    for i in (0..places.len()).rev() {
        let mut here = along_any_line(kernel, order, places[i]);
        for kink in kernel.kinks() {
            let next = places.get(i + 1).copied().unwrap_or(f64::INFINITY);
            if (places[i]..=next).contains(kink) {
                for side in [1.0 - 1e-12, 1.0 + 1e-12] {
                    here = here.max(along_any_line(kernel, order, kink * side));
                }
            }
        }
        largest = largest.max(SLACK * here);
        rough[i] = largest;
    }
    // The step from 0 on may hold a peak of its own near a pole.
    rough[0] = largest.max(SLACK * along_any_line(kernel, order, 0.0));
    let last = places.len() - 1;
    let plane_diverges = order == 1 && !kernel.is_finite_over(1);
    // Entry 0 stands for all below the first place.
    let mut table = vec![integrate(&places, &rough, 0, plane_diverges)];
    let mut octave = 0;
    for step in 0..=OCTAVES * STEPS {
        let start = (1 + step * FINE).min(last);
        if step % STEPS == 0 {
            octave = start;
        }
        // A bound at a smaller distance holds here, too; without a pole it is hardly larger, and
        // saves a sum.
        let same = start > octave && places[start] < FLAT && rough[octave] <= 1.0001 * rough[start];
        let here = if same { table.last().copied() } else { None };
        table.push(here.unwrap_or_else(|| integrate(&places, &rough, start, plane_diverges)));
    }
    table
}

/// Returns the bound at a place of the table, and its integrals from there on. `rough[i]` bounds
/// the derivative from `places[i]` on; where `plane_diverges` the integral over a plane is
/// infinite.
fn integrate(places: &[f64], rough: &[f64], start: usize, plane_diverges: bool) -> Roughness {
    let last = places.len() - 1;
    let near = places[start] * places[start];
    let (mut line, mut plane, mut outward) = (0.0, 0.0, 0.0);
    let mut before = 0.0;
    for i in start..last {
        // The kernel's support ends here, or it underflows.
        if rough[i] == 0.0 {
            break;
        }
        let far = places[i + 1] * places[i + 1];
        let t = (far - near).max(0.0).sqrt();
        line += 2.0 * rough[i] * (t - before);
        plane += TAU / 2.0 * rough[i] * (far - places[i] * places[i]);
        outward += rough[i] * (places[i + 1] - places[i]);
        before = t;
    }
    // Derivatives fall beyond the last place as r⁻⁴ or faster (slopes of the inverse kernel as
    // r⁻², whose integral over a plane diverges).
    line += 2.0 * rough[last] * places[last];
    plane += TAU * rough[last] * places[last] * places[last];
    if plane_diverges {
        plane = f64::INFINITY;
    }
    outward += rough[last] * places[last];
    Roughness {
        point: rough[start],
        line,
        plane,
        outward,
    }
}

/// The largest derivative of this order over all directions at a distance u. With y the square of
/// the direction's share of the distance: `2√y·G′`, `2G′+4yG″`, `√y(12G″+8yG‴)`,
/// `12G″+48yG‴+16y²G⁗`.
pub(crate) fn along_any_line(kernel: Kernel, order: usize, u: f64) -> f64 {
    let q = u * u;
    let [_, g1, g2, g3, g4] = kernel.derivatives(q);
    let at = |y: f64| match order {
        1 => (2.0 * y.sqrt() * g1).abs(),
        2 => (2.0 * g1 + 4.0 * y * g2).abs(),
        3 => (y.sqrt() * (12.0 * g2 + 8.0 * y * g3)).abs(),
        _ => (12.0 * g2 + y * (48.0 * g3 + 16.0 * y * g4)).abs(),
    };
    // Ends, and where the derivative by y vanishes.
    let stationary = match order {
        3 => -g2 / (2.0 * g3),
        4 => -1.5 * g3 / g4,
        _ => 0.0,
    };
    let inner = if stationary > 0.0 && stationary < q {
        at(stationary)
    } else {
        0.0
    };
    at(0.0).max(at(q)).max(inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The kernel along a line that passes at distance √p2, at t.
    fn on_line(kernel: Kernel, p2: f64, t: f64) -> f64 {
        kernel.derivatives(p2 + t * t)[0]
    }

    #[test]
    fn no_derivative_exceeds_its_envelope() {
        for kernel in Kernel::ALL {
            let order = order(kernel);
            let mut tightest = 0.0f64;
            for i in 0..300 {
                // Differences say nothing nearer to a pole than 0.05.
                let u = 0.05 + 0.01 * f64::from(i);
                let h = 2e-3 * u.min(0.3);
                let bound = roughness(kernel, u - 3.0 * h).point;
                for j in 0..=20 {
                    let t = u * f64::from(j) / 20.0;
                    let p2 = (u * u - t * t).max(0.0);
                    let k = |s: f64| on_line(kernel, p2, t + s * h);
                    let difference = match order {
                        2 => (k(1.0) - 2.0 * k(0.0) + k(-1.0)) / (h * h),
                        3 => (k(1.5) - 3.0 * k(0.5) + 3.0 * k(-0.5) - k(-1.5)) / (h * h * h),
                        _ => {
                            (k(2.0) - 4.0 * k(1.0) + 6.0 * k(0.0) - 4.0 * k(-1.0) + k(-2.0))
                                / (h * h * h * h)
                        }
                    };
                    let noise = 1e-14 * kernel.value((u - 3.0 * h).max(0.0)) / h.powi(order as i32);
                    assert!(
                        difference.abs() <= bound + noise,
                        "{kernel:?} {u} {t}: {difference} > {bound}"
                    );
                    if noise < 0.01 * bound {
                        tightest = tightest.max(difference.abs() / bound);
                    }
                }
            }
            assert!(tightest > 0.8, "{kernel:?}: {tightest}");
        }
    }

    /// The integrals over a line and a plane, by a midpoint rule.
    #[test]
    fn integrals_are_bounds_and_near() {
        for kernel in Kernel::ALL {
            for u in [0.02, 0.1, 0.3, 0.7, 0.95, 1.5, 3.0] {
                let (mut line, mut plane, mut outward) = (0.0, 0.0, 0.0);
                let n = 40_000;
                // t = u·sinh-like steps: fine near the foot, wide far away.
                for i in 0..n {
                    let t = |i: f64| 1e-2 * u * libm::expm1(i / f64::from(n) * 14.0);
                    let (a, b) = (t(f64::from(i)), t(f64::from(i + 1)));
                    let middle = 0.5 * (a + b);
                    let there = (u * u + middle * middle).sqrt();
                    let here = along_any_line(kernel, order(kernel), there);
                    line += 2.0 * here * (b - a);
                    plane += TAU * middle * here * (b - a);
                    outward += along_any_line(kernel, order(kernel), u + middle) * (b - a);
                }
                let bound = roughness(kernel, u);
                // Derivatives themselves; envelopes are running maxima from outside.
                assert!(
                    line <= bound.line * 1.001,
                    "{kernel:?} {u}: {line} {bound:?}"
                );
                assert!(
                    plane <= bound.plane * 1.001,
                    "{kernel:?} {u}: {plane} {bound:?}"
                );
                assert!(
                    outward <= bound.outward * 1.001,
                    "{kernel:?} {u}: {outward} {bound:?}"
                );
                if bound.line > 0.0 {
                    assert!(line >= 0.3 * bound.line, "{kernel:?} {u}: {line} {bound:?}");
                    assert!(
                        plane >= 0.3 * bound.plane,
                        "{kernel:?} {u}: {plane} {bound:?}"
                    );
                }
            }
        }
    }
}
