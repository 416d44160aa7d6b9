//! Bounds on the logarithm of a sum of Gaussians.
//!
//! A Gaussian falls so fast that its third derivative changes by a factor within a small part of
//! its width, and bounds that hold in a ball are far from what is at its centre. Its logarithm
//! −a·|x−y|² is a polynomial. Let fᵢ = h·∫ e^(−a|x−y|²) dy over a point or a segment. Its logarithm
//! has the gradient −2a·(x − E[y]), the second derivative −2a + 4a²·Var[y] and the third
//! −8a³·κ₃[y], with the moments of y under the normalised integrand. That is a normal distribution
//! of variance 1/(2a), cut off at the ends of the segment, so that its variance is no larger, and
//! its third cumulant is at most twice the cube of its deviation, as that of any density with a
//! concave logarithm.
//!
//! With wᵢ = fᵢ/(F+δ) the logarithm of F+δ = δ + Σ fᵢ has as derivatives the means and cumulants of
//! those of the terms: the gradient is E[vᵢ], with vᵢ that of ln fᵢ; the second derivative is
//! `E[Hᵢ] + Var[v]`; the third is `E[Tᵢ] + 3·Cov[v, H] + κ₃[v]`. Where one term is much larger than
//! the others, hardly anything is added to its own. The constant δ keeps the logarithm finite where
//! F vanishes.

use crate::sum::TermBounds;
use crate::{Ball, Enclosure, Jet, Kernel, Part, Primitive, Skeleton, THRESHOLD, Variation};
use glam::DVec3;

/// The constant δ that is added to the sum.
const FLOOR: f64 = 1e-7;
/// Value and slope of the logarithm at the threshold are those of the function.
const SCALE: f64 = THRESHOLD + FLOOR;
/// Values of terms below which their gradients are not taken from their jets.
const TINY: f64 = 1e-200;
/// Exponents above which the share of a term is 1.
const LARGE: f64 = 40.0;

/// The function T + (T+δ)·ln((F+δ)/(T+δ)) of a sum F of Gaussians: it is T where F is, with the
/// same gradient, and grows with F.
#[derive(Clone, Debug)]
pub struct Logarithm<'a> {
    primitives: &'a [Primitive],
    terms: &'a [TermBounds],
}

/// Value, gradient and bounds of a term's logarithm in a ball.
struct Term {
    /// Value and gradient at the centre.
    value: f64,
    gradient: DVec3,
    /// Bound on the error of that gradient.
    doubt: f64,
    /// The factor a: second derivatives are from −2a to 0.
    rate: f64,
    /// Whether the second derivative is −2a everywhere.
    is_point: bool,
    /// Bound on the third derivative.
    third: f64,
    /// Bounds on the value in the ball.
    range: [f64; 2],
}

impl<'a> Logarithm<'a> {
    /// The greatest error of F that changes the logarithm by no more than this anywhere.
    #[must_use]
    pub fn slack(error: f64) -> f64 {
        // Gradients change with values, too.
        0.25 * FLOOR / SCALE * error
    }

    /// Prepares the logarithm; `None` unless all terms are Gaussians of points and segments that
    /// add.
    pub(crate) fn new(primitives: &'a [Primitive], terms: &'a [TermBounds]) -> Option<Self> {
        let fits = primitives.iter().all(|p| {
            let is_simple = matches!(
                p.skeleton,
                Skeleton::Point { .. } | Skeleton::Segment { .. }
            );
            let is_plain = p.profile.is_none() && p.tapered.is_none();
            is_simple && is_plain && p.kernel == Kernel::Gauss && p.height > 0.0
        });
        fits.then_some(Self { primitives, terms })
    }

    /// The logarithm's value and gradient where F has these.
    #[must_use]
    pub fn of(jet: &Jet<f64>) -> Jet<f64> {
        let sum = jet.value.max(0.0) + FLOOR;
        let factor = SCALE / sum;
        Jet {
            value: rescale(libm::log(sum)),
            gradient: jet.gradient.map(|slope| slope * factor),
        }
    }

    /// Computes bounds on the logarithm in a ball, within that of the part if there is one.
    #[must_use]
    pub fn variation(&self, part: Option<&Part>, ball: Ball) -> Variation {
        let mut terms = vec![Term {
            value: libm::log(FLOOR),
            gradient: DVec3::ZERO,
            doubt: 0.0,
            rate: 0.0,
            is_point: true,
            third: 0.0,
            range: [libm::log(FLOOR); 2],
        }];
        match part {
            Some(part) => terms.extend(part.terms.iter().map(|i| self.term(*i as usize, ball))),
            None => terms.extend((0..self.primitives.len()).map(|i| self.term(i, ball))),
        }
        let all = bounds(&terms, ball.radius);
        // Terms left out of the part: their sum is at most δ times the slack.
        let rest = part.map_or(Enclosure::ZERO, |part| part.rest);
        let size = rest.value[1].max(-rest.value[0]);
        let slope = all.slope;
        let more = [
            size,
            rest.slope + size * slope,
            rest.curvature + 2.0 * rest.slope * slope + size * (slope * slope + all.curvature),
        ]
        .map(|bound| bound * (2.0 / FLOOR));
        let rough = SCALE * more[2];
        let curvature = SCALE * all.curvature + rough;
        Variation {
            range: Enclosure {
                value: [
                    rescale(all.value[0]) - SCALE * more[0],
                    rescale(all.value[1]) + SCALE * more[0],
                ],
                slope: SCALE * (slope + more[1]),
                curvature,
            },
            curvature,
            third: SCALE * all.third,
            rough,
            jump: 0.0,
            step: 0.0,
        }
    }

    fn term(&self, i: usize, Ball { center, radius }: Ball) -> Term {
        let (primitive, bound) = (&self.primitives[i], &self.terms[i].bound);
        let rate = primitive.width * primitive.width;
        let (middle, half) = match primitive.skeleton {
            Skeleton::Segment { base, apex } => (0.5 * (base + apex), 0.5 * base.distance(apex)),
            Skeleton::Point { center } => (center, 0.0),
            // Sums of other bones have no logarithm.
            _ => (center, f64::INFINITY),
        };
        let most = libm::log(bound.magnitude(bound.nearness(center, radius)));
        let least = libm::log(bound.least(center, radius).max(0.0));
        let is_point = half == 0.0;
        let root = rate.sqrt();
        let jet = primitive.jet(center.to_array());
        let mut term = Term {
            value: f64::NEG_INFINITY,
            gradient: (middle - center) * (2.0 * rate),
            doubt: 2.0 * rate * half,
            rate,
            is_point,
            third: if is_point { 0.0 } else { THIRD * rate * root },
            range: [least, most],
        };
        if jet.value > TINY {
            // The mean of y is on the segment.
            let mean = center + DVec3::from_array(jet.gradient) / (2.0 * rate * jet.value);
            let mean = middle + (mean - middle).clamp_length_max(half);
            term.value = libm::log(jet.value);
            term.gradient = (mean - center) * (2.0 * rate);
            term.doubt = 0.0;
            let steep = term.gradient.length() * radius;
            let bend = rate * radius * radius;
            term.range = [
                least.max(term.value - steep - bend),
                most.min(term.value + steep),
            ];
        }
        term
    }
}

/// Bound on the third derivative of a segment's logarithm, in units of a to the power of 3/2:
/// 8·2/2^(3/2).
const THIRD: f64 = 5.66;

/// Returns the function's value, given the logarithm of F+δ.
fn rescale(logarithm: f64) -> f64 {
    THRESHOLD + SCALE * (logarithm - libm::log(SCALE))
}

/// Bounds on the logarithm of a sum.
struct Bounds {
    value: [f64; 2],
    slope: f64,
    curvature: f64,
    third: f64,
}

/// Bounds by the moments about the gradient and the second derivative of the term that is largest
/// at the centre. Shares of others are bounded by their ratio to it.
fn bounds(terms: &[Term], radius: f64) -> Bounds {
    let mut largest = &terms[0];
    for term in terms {
        if term.value > largest.value {
            largest = term;
        }
    }
    let mut value = [0.0; 2];
    let mut steepest = 0.0_f64;
    // The sum at the centre, and the gradient times it, over the largest term.
    let (mut whole, mut gradient) = (0.0, DVec3::ZERO);
    // Bounds on the means of |v|, |v|², |v|³, |H| and |v|·|H|, less those of the largest term, and
    // on the greatest |v|.
    let [mut first, mut second, mut third, mut bend, mut both] = [0.0; 5];
    let mut widest = 0.0_f64;
    let (mut rate, mut own_third) = (largest.rate, largest.third);
    for term in terms {
        value[0] += libm::exp(term.range[0]);
        value[1] += libm::exp(term.range[1]);
        steepest = steepest.max(term.gradient.length() + term.doubt + 2.0 * term.rate * radius);
        let share = libm::exp(term.value - largest.value);
        whole += share;
        gradient += term.gradient * share;
        if core::ptr::eq(term, largest) {
            continue;
        }
        let are_points = term.is_point && largest.is_point;
        let (change, square) = if are_points {
            let difference = largest.rate - term.rate;
            (2.0 * difference.abs(), difference.max(0.0))
        } else {
            (2.0 * largest.rate.max(term.rate), largest.rate)
        };
        let apart = term.gradient.distance(largest.gradient) + term.doubt;
        let ratio = (term.value - largest.value + (apart + square * radius) * radius)
            .min(term.range[1] - largest.range[0]);
        // A value that is too small to be known bounds nothing.
        let ratio = if term.doubt > 0.0 || term.value == f64::NEG_INFINITY {
            term.range[1] - largest.range[0]
        } else {
            ratio
        };
        let share = if ratio < LARGE {
            let ratio = libm::exp(ratio);
            ratio / (1.0 + ratio)
        } else {
            1.0
        };
        let far = apart + change * radius;
        first += share * far;
        second += share * far * far;
        third += share * far * far * far;
        bend += share * change;
        both += share * far * change;
        widest = widest.max(far);
        rate += share * (term.rate - largest.rate).max(0.0);
        own_third += share * (term.third - largest.third).max(0.0);
    }
    let variance = second.min(widest * widest);
    let skew =
        (2.0 * widest * variance).min(third + 3.0 * first * second + 2.0 * first * first * first);
    let curvature = (2.0 * rate).max(variance);
    let at_center = gradient.length() / whole;
    Bounds {
        value: value.map(libm::log),
        slope: steepest.min(at_center + curvature * radius),
        curvature,
        third: own_third + 3.0 * (both + first * bend) + skew,
    }
}
