//! Proven bounds on the sum in a ball.

use crate::function::{Metaballs, term};
use crate::profile::{CUT, Range, range};
use field::{Ball, Enclosure, Implicit, Jet, THRESHOLD};
use glam::DVec3;

/// Nodes of the hierarchy smaller than this part of the ball's radius are bounded as a whole.
const COARSE: f64 = 0.5;
/// Relative rounding errors of a bound, from above.
const ROUNDING: f64 = 1e-9;

impl Metaballs {
    /// Proven bounds in a ball. Each facet is bounded by itself: its distance changes by at most the radius. Groups of
    /// facets that are small beside the ball are bounded by their box, so that large balls cost no more than small ones.
    pub(crate) fn enclosure(&self, Ball { center, radius }: Ball) -> Enclosure {
        let k = self.sharpness;
        let point = center.to_array();
        let mut total = Enclosure::ZERO;
        let mut at_center = Jet::zero();
        let mut whole = true;
        self.bvh.descend(|node, bounds, facets| {
            // Below d − ρ of all facets of the node, at all points of the ball.
            let gap = bounds.distance_squared(center).sqrt() - radius;
            if k * gap > CUT * (1.0 + ROUNDING) {
                return false;
            }
            if bounds.size().length() < COARSE * radius {
                let count = f64::from(self.counts[node as usize]);
                let near = [gap.max(-self.thickest()), f64::INFINITY];
                // Outside the box, which holds all points with d ≤ ρ.
                let nearest = if gap > 0.0 { self.thinnest + gap } else { 0.0 };
                let one = self.bounds(near, nearest);
                total = total.plus(Enclosure {
                    value: [0.0, count * one.value[1]],
                    slope: count * one.slope,
                    curvature: count * one.curvature,
                });
                whole = false;
                return false;
            }
            for facet in facets {
                let (offset, thickness) = self.double.offset(*facet, point);
                let distance = DVec3::from_array(offset).length();
                // A distance has a rounding error of its own.
                let rounding = 4.0 * f64::EPSILON * (distance + center.abs().max_element());
                let [near, far] = [
                    (distance - radius - rounding).max(0.0),
                    distance + radius + rounding,
                ];
                if k * (near - thickness) > CUT {
                    continue;
                }
                total = total.plus(self.bounds([near - thickness, far - thickness], near));
                at_center = at_center.plus(term(k, offset, thickness));
            }
            true
        });
        let slack = |bound: f64| bound * (1.0 + ROUNDING);
        total = Enclosure {
            value: [total.value[0] * (1.0 - ROUNDING), slack(total.value[1])],
            slope: slack(total.slope),
            curvature: slack(total.curvature),
        };
        // Where the surface is out of question already the narrower range is not needed.
        if total.value[1] < THRESHOLD || total.value[0] > THRESHOLD {
            return total;
        }
        let jet = if whole { at_center } else { self.jet(center) };
        total.about(&jet, radius)
    }

    /// The largest ρ, from above.
    fn thickest(&self) -> f64 {
        0.5 * self.bvh.bounds().size().max_element()
    }

    /// Bounds on one metaball whose d − ρ is in a range and whose d is at least `nearest`.
    fn bounds(&self, [low, high]: [f64; 2], nearest: f64) -> Enclosure {
        let k = self.sharpness;
        let Range {
            value,
            slope,
            curvature,
        } = range(k * low, k * high);
        // Along a line, with c the cosine between it and ∇d: |φ″k²c² + φ′k(1 − c²)/d| ≤ max(|φ″|k², |φ′|k/d).
        let bend = (curvature * k * k).max(slope * k / nearest);
        Enclosure {
            value,
            slope: slope * k,
            curvature: if nearest > 0.0 || slope == 0.0 {
                bend.max(0.0)
            } else {
                f64::INFINITY
            },
        }
    }
}
