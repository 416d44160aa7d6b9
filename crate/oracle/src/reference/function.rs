//! The function whose surface the reference looks for: a field, the smooth maximum of two, or the
//! largest of those of bodies that touch.
use super::pieces::Magnitudes;
use super::range::Range;
use super::terms::{Evaluation, FieldTerms};
use super::touching::Touching;
use super::waves::Factor;
use field::Kink;
use glam::DVec3;

/// A function of space.
#[derive(Clone, Debug)]
pub(super) enum Function {
    Sum(FieldTerms),
    /// `(a + b + √((a−b)² + k²))/2`, k > 0.
    SmoothMaximum(Box<[FieldTerms; 2]>, f64),
    /// The largest of the functions of bodies that touch.
    Touching(Touching),
}

impl Function {
    /// Evaluates the function at a point.
    pub fn sample(&self, point: DVec3) -> Evaluation {
        match self {
            Self::Sum(terms) => terms.sample(point),
            Self::Touching(bodies) => bodies.sample(point),
            Self::SmoothMaximum(parts, k) => {
                let [a, b] = parts.each_ref().map(|part| part.sample(point));
                let noise = a.noise.max(b.noise) + 4.0 * f64::EPSILON * k;
                let (excess, share) = mix(a.excess, b.excess, *k);
                // The share changes by at most 1/(2k) where the difference changes by 1.
                let turned = (a.noise + b.noise) / (2.0 * k) * a.gradient.distance(b.gradient);
                Evaluation {
                    excess,
                    gradient: a.gradient * share + b.gradient * (1.0 - share),
                    noise,
                    slope_noise: a.slope_noise.max(b.slope_noise) + turned,
                }
            }
        }
    }

    /// Returns bounds in a ball; that on the second derivative is along a unit vector, if one is
    /// given, else in any direction.
    pub fn extent(&mut self, center: DVec3, radius: f64, along: Option<DVec3>) -> Magnitudes {
        match self {
            Self::Sum(terms) => terms.extent(center, radius, along),
            // The range alone is known.
            Self::Touching(_) => Magnitudes {
                above: f64::INFINITY,
                below: f64::INFINITY,
                slope: f64::INFINITY,
                curvature: f64::INFINITY,
            },
            Self::SmoothMaximum(parts, k) => {
                let [a, b] = parts
                    .each_mut()
                    .map(|part| part.extent(center, radius, along));
                let both = a.slope + b.slope;
                Magnitudes {
                    // The maximum grows with both parts, and is above each.
                    above: mix(a.above, b.above, *k).0,
                    below: a.below.min(b.below),
                    slope: a.slope.max(b.slope),
                    // f″ = s·a″ + (1−s)·b″ + (a′−b′)²·k²/(2·√((a−b)² + k²)³), 0 < s < 1.
                    curvature: a.curvature.max(b.curvature) + both * both / (2.0 * *k),
                }
            }
        }
    }

    /// Returns the range of values in a ball, for functions with creases; `None` for others.
    pub fn range(&mut self, center: DVec3, radius: f64) -> Option<Range> {
        match self {
            Self::Touching(bodies) => Some(bodies.range(center, radius)),
            _ => None,
        }
    }

    /// Returns the kinks of all terms.
    pub fn kinks(&self) -> Vec<Kink> {
        let parts = match self {
            Self::Sum(terms) => core::slice::from_ref(terms),
            Self::SmoothMaximum(parts, _) => &parts[..],
            // Contacts have more kinks than could be named.
            Self::Touching(_) => &[],
        };
        let primitives = parts.iter().flat_map(|part| &part.primitives);
        primitives.flat_map(|p| Factor::of(p).kinks).collect()
    }
}

/// Returns the smooth maximum of two values and the share of the first in its derivative. The
/// values may be less T as well.
fn mix(a: f64, b: f64, k: f64) -> (f64, f64) {
    let root = libm::hypot(a - b, k);
    (0.5 * (a + b + root), 0.5 * (1.0 + (a - b) / root))
}
