//! Proven bounds on the sum in a ball.

use crate::function::{Metaballs, term};
use crate::profile::{CUT, DEEP, FADE, FADING, Range, range};
use field::{Ball, Clearance, Enclosure, Implicit, Jet, Part, Real, THRESHOLD};
use glam::DVec3;

/// Nodes of the hierarchy smaller than this part of the ball's radius are bounded as a whole.
const COARSE: f64 = 0.5;
/// The least k(d − ρ) of a point from which all facets are counted as equally far.
const AFAR: f64 = 300.0;
/// Group of facets is counted as one where it adds less than this, in the most that the nearest
/// facet may add.
const FEW: f64 = 0.02;
/// s up to which a term is counted that is to keep F above the threshold.
const SAFE: f64 = 8.0;
/// Relative rounding errors of a bound, from above.
const ROUNDING: f64 = 1e-9;

/// The largest k·r of a ball whose bounds follow from the values at its centre.
const SMALL: f64 = 2.0;

/// Returns a bound on the second derivative along any line of a metaball of at most this value,
/// whose d is at least `nearest`: with c the cosine between the line and ∇d,
/// `|φ″k²c² + φ′k(1 − c²)/d| ≤ max(|φ″|k², |φ′|k/d)`.
fn bend(k: f64, value: f64, nearest: f64, [first, second]: [f64; 2]) -> f64 {
    if nearest > 0.0 {
        value * k * (second * k).max(first / nearest)
    } else {
        f64::INFINITY
    }
}

/// Widens bounds by what their rounding errors may be; values are 0 or more.
fn widen(bounds: Enclosure) -> Enclosure {
    let [low, high] = bounds.value;
    Enclosure {
        value: [low * (1.0 - ROUNDING), high * (1.0 + ROUNDING)],
        slope: bounds.slope * (1.0 + ROUNDING),
        curvature: bounds.curvature * (1.0 + ROUNDING),
    }
}

impl Metaballs {
    /// Proven bounds in a ball. Each facet is bounded by itself: its distance changes by at most
    /// the radius. Groups of facets that are small beside the ball are bounded by their box, so
    /// that large balls cost no more than small ones.
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
        total = widen(total);
        // Where the surface is out of question already the narrower range is not needed.
        if total.value[1] < THRESHOLD || total.value[0] > THRESHOLD {
            return total;
        }
        let jet = if whole { at_center } else { self.jet(center) };
        total.about(&jet, radius)
    }

    /// Proven bounds in a ball that is no larger than a few 1/k, and value and gradient at its
    /// centre; `None` in a larger one.
    ///
    /// Over the distance r no term changes by more than the factor `e^±kr`, but for those that fall
    /// to 0: they are bounded by the exponential from above and by 0 from below.
    pub(crate) fn small_enclosure(
        &self,
        part: Option<&Part>,
        Ball { center, radius }: Ball,
    ) -> Option<(Enclosure, Jet<f64>)> {
        let k = self.sharpness;
        if k * radius > SMALL {
            return None;
        }
        let place = center.to_array();
        let reach = k * radius * (1.0 + ROUNDING);
        let [grows, falls] = [Real::exp(reach), reach.decay()];
        let mut jet = Jet::zero();
        let (mut low, mut high, mut slope, mut curvature) = (0.0, 0.0, 0.0, 0.0_f64);
        let mut near = Vec::new();
        let facets = match part {
            Some(part) => &part.terms,
            None => {
                self.bvh.descend(|_, bounds, facets| {
                    let gap = k * (bounds.distance_squared(center).sqrt() - radius);
                    let is_far = gap > CUT * (1.0 + ROUNDING);
                    if !is_far {
                        near.extend_from_slice(facets);
                    }
                    !is_far
                });
                &near
            }
        };
        for facet in facets {
            let (offset, thickness) = self.double.offset(*facet, place);
            let distance = DVec3::from_array(offset).length();
            let s = k * (distance - thickness);
            if s - reach > CUT * (1.0 + ROUNDING) {
                continue;
            }
            let rounding = 4.0 * f64::EPSILON * (distance + center.abs().max_element());
            let nearest = distance - radius - rounding;
            let term = term(k, offset, thickness);
            jet = jet.plus(term);
            if s + reach < FADE {
                low += term.value * falls;
                high += term.value * grows;
                slope += term.value * grows;
                curvature += bend(k, term.value * grows, nearest, [1.0, 1.0]);
            } else {
                let most = s.decay() * grows;
                high += most;
                slope += FADING[0] * most;
                curvature += bend(k, most, nearest, FADING);
            }
        }
        let bounds = widen(Enclosure {
            value: [low, high],
            slope: k * slope,
            curvature,
        });
        Some((bounds.about(&jet, radius), jet))
    }

    /// Returns a ball around a point in which F stays on one side of the threshold 1.
    ///
    /// Each dᵢ changes by at most r over the distance r, so `Σ e^−k(dᵢ−ρᵢ)` changes by at most the
    /// factor `e^±kr`. That sum is at least F everywhere; and of terms with s ≤ 16 at the ball's
    /// end, at most F, as the tangent below −40 falls slower than the exponential.
    pub(crate) fn clear_ball(&self, point: DVec3) -> Clearance {
        let k = self.sharpness;
        let scale = 1.0 / k;
        let count = self.bvh.len() as f64;
        // d − ρ of all facets is at least the distance from their boxes.
        let nearest = self.bvh.nearest(point, f64::INFINITY, |facet: u32| {
            self.bvh.bounds_of(facet).distance_squared(point)
        });
        let gap = nearest.map_or(0.0, |(_, square)| square.sqrt());
        let clear = if k * gap > AFAR {
            gap - scale * Real::ln(count)
        } else {
            self.clear_of(self.exponentials(point, FEW * (k * gap).decay()))
        };
        self.clearance_within(point, clear)
    }

    /// Returns [`Self::clear_ball`] within the ball of a part.
    pub(crate) fn clear_ball_of(&self, part: &Part, point: DVec3) -> Clearance {
        let mut sums = [0.0; 2];
        self.add_exponentials(&part.terms, point.to_array(), &mut sums);
        self.clearance_within(point, self.clear_of(sums))
    }

    /// Returns the distance within which the sums of [`Self::exponentials`] leave the threshold
    /// out.
    fn clear_of(&self, [above, below]: [f64; 2]) -> f64 {
        let scale = 1.0 / self.sharpness;
        if above < THRESHOLD {
            -scale * Real::ln(above.max(f64::MIN_POSITIVE))
        } else if below > THRESHOLD {
            scale * Real::ln(below).min(FADE - SAFE)
        } else {
            0.0
        }
    }

    /// Returns a ball of clearance, a little smaller than what rounded numbers say.
    fn clearance_within(&self, point: DVec3, clear: f64) -> Clearance {
        let rounding = 1e-14 * (point.abs().max_element() + clear);
        Clearance {
            radius: (clear * (1.0 - ROUNDING) - rounding).max(0.0),
            scale: 1.0 / self.sharpness,
        }
    }

    /// Whether a facet acts in a ball.
    pub(crate) fn acts(&self, facet: u32, Ball { center, radius }: Ball) -> bool {
        let (offset, thickness) = self.double.offset(facet, center.to_array());
        let distance = DVec3::from_array(offset).length();
        // Also where distances are rounded to single precision.
        let rounding = 1e-5 * (distance + center.abs().max_element() + radius);
        self.sharpness * (distance - radius - rounding - thickness) <= CUT * (1.0 + 1e-5)
    }

    /// Adds the exponentials of some facets to the two sums of [`Self::exponentials`].
    fn add_exponentials(&self, facets: &[u32], place: [f64; 3], sums: &mut [f64; 2]) {
        for facet in facets {
            let (offset, thickness) = self.double.offset(*facet, place);
            let distance = DVec3::from_array(offset).length();
            let term = (self.sharpness * (distance - thickness)).max(DEEP).decay();
            sums[0] += term;
            if term > SAFE.decay() {
                sums[1] += term;
            }
        }
    }

    /// The sum `Σ e^−k(dᵢ−ρᵢ)` at a point from above, where each group of facets that adds less
    /// than `little` is bounded by its box, and the part of it whose s is at most [`SAFE`], from
    /// below.
    fn exponentials(&self, point: DVec3, little: f64) -> [f64; 2] {
        let k = self.sharpness;
        let place = point.to_array();
        let (mut sums, mut groups) = ([0.0; 2], 0.0);
        self.bvh.descend(|node, bounds, facets| {
            let gap = bounds.distance_squared(point).sqrt();
            let most = f64::from(self.counts[node as usize]) * (k * gap).decay();
            if most < little {
                groups += most;
                return false;
            }
            self.add_exponentials(facets, place, &mut sums);
            true
        });
        [sums[0] + groups, sums[1]]
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
        // Along a line, with c the cosine between it and ∇d: |φ″k²c² + φ′k(1 − c²)/d| ≤ max(|φ″|k²,
        // |φ′|k/d).
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
