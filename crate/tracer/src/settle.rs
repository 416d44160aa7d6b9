//! What the spans of a packet leave open: one ray at a time, in double precision.
//!
//! Where a ray grazes the surface, the field comes nearer to T than spans of single precision can tell.
//! On such a stretch the field is interpolated by one cubic, and the stretch is halved until the error bound
//! proves where the ray crosses, or the pieces are too short to matter. A primitive whose own error on a piece is next to
//! nothing is *calm* there: its cubic stays, and the halves do not evaluate it any more. Where a profile has a kink
//! or a jump the ray is cut.
//!
//! Where very many primitives count, most of them are far, and are interpolated together already. What that is off by mostly leaves
//! no doubt, so that rays are first asked with these interpolants in place of the far ones ([`Given`]).
use crate::kinks::Kinks;
use crate::ray::Ray;
use crate::roots::bracketed;
use crate::slabs::LARGE_TERM;
use crate::spans::{Node, Span};
use core::ops::Range;
use field::bound::SpanLength;
use field::{Bound, Cut, Primitive, THRESHOLD};

/// Pieces that one packet may have looked at; what is left is decided by the signs at its ends.
const MOST_PIECES: u32 = 1 << 16;
/// A stretch may have the pieces that are left over this: where a ray runs along the surface no number would do, and
/// what comes behind must not go short.
const AT_ONCE: u32 = 4;
/// Of the pieces that a stretch may have, one over this is kept for what comes behind its next part, be that one from
/// kink to kink or the near half of a piece. More would starve what lies in a small part of a long stretch, as
/// each halving on the way there takes its share; what a part leaves is had by those behind it in any case.
const KEPT: u32 = 8;
/// But a part may have no fewer than these, if there are so many: they tell a few crossings apart.
const FEW: u32 = 256;
/// Pieces halved so often are not halved further: lengths that are not finite would never be short.
const DEEPEST: u32 = 50;
/// A piece with so many primitives more counts as one more.
const LONG: u32 = 64;
/// Calm primitives together are off by at most this part of T.
const CALM: f64 = 1e-9;
/// Rounding of a field in double precision, relative to the sizes of its terms.
const ROUNDING: f64 = 1e-12;
/// The slope of a Hermite cubic is off by at most four times its error bound over its length (for bounds
/// by the second derivative; for the fourth it is 3.08), and the slope's own Bernstein coefficients are 3/length times the
/// differences of the cubic's. So the field is monotone where those are larger than the bound times this.
pub const STEEP: f64 = 1.34;

/// What is known of a part of the field along a stretch of a ray, in place of its primitives.
pub struct Given<'a> {
    /// Its value and slope.
    pub node: &'a dyn Fn(f64) -> Node<f64>,
    /// The cubic between the stretch's ends is off by no more than this: so its slope is off by no more than about four times that over
    /// the length. That of what is left out may be off by more: where the field is within `off` of T, it may cross T three times
    /// instead of once.
    pub off: f64,
}

/// What [`Given`] is off by: nothing, if there is none.
#[derive(Clone, Copy, Debug, Default)]
struct Off {
    value: f64,
    /// Over the length of a piece.
    steep: f64,
}

/// Settles what happens to rays of one packet.
#[derive(Debug)]
pub struct Settler {
    /// The primitives that count on the stretch.
    pub list: Vec<u32>,
    pieces: u32,
    off: Off,
    /// Whether what is given is off by too much to tell.
    unsure: bool,
    /// Evaluations of one primitive's field at one point.
    pub evaluations: u64,
}

impl Default for Settler {
    fn default() -> Self {
        Self {
            list: Vec::new(),
            pieces: MOST_PIECES,
            off: Off::default(),
            unsure: false,
            evaluations: 0,
        }
    }
}

/// A stretch of a ray that is being looked at.
#[derive(Clone, Debug)]
struct Piece {
    from: f64,
    to: f64,
    /// How many times halved.
    depth: u32,
    /// How many pieces may be looked at in it.
    most: u32,
    /// What is calm, less T.
    calm: Span<f64>,
    /// The primitives that are not: a range of the list.
    rest: Range<usize>,
    /// What those add up to at both ends.
    ends: [Node<f64>; 2],
}

/// The primitives, and what is known of them.
#[derive(Clone, Copy, Debug)]
pub struct Sight<'a> {
    /// All primitives.
    pub primitives: &'a [Primitive],
    /// Their bounds.
    pub bounds: &'a [Bound],
    /// Where they are not smooth.
    pub kinks: &'a Kinks,
}

/// The field along a ray.
#[derive(Clone, Copy, Debug)]
pub struct Along<'a> {
    /// What makes it.
    pub sight: Sight<'a>,
    /// The ray, its direction of unit length.
    pub ray: Ray,
    /// Pieces shorter than this are not looked into.
    pub resolution: f64,
}

impl Settler {
    /// Calls `tell` with a stretch's start and whether it is inside the surface, and then with each crossing
    /// and whether it enters, in order, until it says `false`.
    pub fn crossings(
        &mut self,
        along: &Along<'_>,
        stretch: [f64; 2],
        tell: impl FnMut(f64, bool) -> bool,
    ) {
        self.off = Off::default();
        self.follow(along, stretch, &|_| Node::zero(), tell);
    }

    /// The same, of what is given and the listed primitives together. `None` if that is too far off to tell; the crossings of
    /// the field are within what it is off by.
    pub fn crossings_with(
        &mut self,
        along: &Along<'_>,
        stretch: [f64; 2],
        given: &Given<'_>,
    ) -> Option<Vec<(f64, bool)>> {
        self.off = Off {
            value: given.off,
            steep: given.off / (stretch[1] - stretch[0]),
        };
        self.unsure = false;
        let pieces = self.pieces;
        let mut told = Vec::new();
        self.follow(along, stretch, given.node, |t, inside| {
            told.push((t, inside));
            true
        });
        if self.unsure {
            // Those that all primitives need.
            self.pieces = pieces;
            return None;
        }
        Some(told)
    }

    fn follow(
        &mut self,
        along: &Along<'_>,
        [from, to]: [f64; 2],
        given: &dyn Fn(f64) -> Node<f64>,
        mut tell: impl FnMut(f64, bool) -> bool,
    ) {
        // What every primitive may be off by where it is calm.
        let share = CALM * THRESHOLD / self.list.len().max(1) as f64;
        let mut start = from;
        let parts = self.kinks(along, [from, to]);
        let mut left = self.pieces / AT_ONCE;
        let count = parts.len() as u32;
        for (i, end) in (0..count).zip(parts) {
            // Next to a kink, not on it.
            let gap = |t: f64| (1e-3 * along.resolution).max(1e-13 * (1.0 + t));
            let first = if start > from {
                start + gap(start)
            } else {
                from
            };
            let last = if end < to { end - gap(end) } else { to };
            start = end;
            if first >= last {
                continue;
            }
            let most = if i + 1 < count {
                next_share(left)
            } else {
                left
            };
            let before = self.pieces;
            let rest = 0..self.list.len();
            let ends = [first, last].map(|t| self.sum(along, &rest, t));
            let given = Span::hermite(given(first), given(last), last - first);
            let calm = Span([-THRESHOLD; 4]).plus(given);
            let piece = Piece {
                from: first,
                to: last,
                depth: 0,
                most,
                calm,
                rest,
                ends,
            };
            if !tell(first, calm.0[0] + ends[0].value >= 0.0)
                || !self.between(along, share, piece, &mut tell)
            {
                return;
            }
            left = left.saturating_sub(before - self.pieces);
        }
    }

    /// Where the primitives of the list are not smooth between two parameters, and the second of these, in order.
    fn kinks(&self, along: &Along<'_>, [from, to]: [f64; 2]) -> Vec<f64> {
        let mut found = vec![to];
        if along.sight.kinks.is_empty() {
            return found;
        }
        for &p in &self.list {
            for kink in along.sight.kinks.of(p) {
                let t = kink.along(along.ray.origin, along.ray.direction);
                if t > from && t < to {
                    found.push(t);
                }
            }
        }
        found.sort_by(f64::total_cmp);
        found
    }

    /// What some primitives of the list add up to.
    fn sum(&mut self, along: &Along<'_>, range: &Range<usize>, t: f64) -> Node<f64> {
        let point = along.ray.at(t).to_array();
        let sum = self.list[range.clone()]
            .iter()
            .fold(Node::zero(), |sum, &p| sum.plus(along.node(p, point)));
        self.evaluations += range.len() as u64;
        sum
    }

    /// The crossings on a piece; whether more are wanted.
    fn between(
        &mut self,
        along: &Along<'_>,
        share: f64,
        mut piece: Piece,
        tell: &mut impl FnMut(f64, bool) -> bool,
    ) -> bool {
        let cost = 1 + piece.rest.len() as u32 / LONG;
        if piece.most < cost {
            return self.give_up(along, &piece, tell);
        }
        piece.most -= cost;
        self.pieces = self.pieces.saturating_sub(cost);
        let length = piece.to - piece.from;
        let center = along.ray.at(0.5 * (piece.from + piece.to));
        let radius = 0.5 * length * (1.0 + 1e-9);
        let span_length = SpanLength::new(length);
        let (mut above, mut size) = (0.0, THRESHOLD);
        let mut error = CALM * THRESHOLD;
        let places = [piece.from, piece.to].map(|t| along.ray.at(t).to_array());
        let mut calm = [Node::zero(); 2];
        let bottom = self.list.len();
        for at in piece.rest.clone() {
            let p = self.list[at];
            let bound = &along.sight.bounds[p as usize];
            let shortened = bound.shortened(along.ray.direction, 0.0);
            let span_length = if shortened < 1.0 {
                SpanLength::new(shortened * length)
            } else {
                span_length
            };
            let estimate = bound.estimate(bound.nearness(center, radius), &span_length);
            size += estimate.magnitude.at_most(LARGE_TERM);
            if estimate.error <= share {
                calm = [0, 1].map(|i| calm[i].plus(along.node(p, places[i])));
                self.evaluations += 2;
                continue;
            }
            self.list.push(p);
            error += estimate.error;
            if bound.adds() {
                above += estimate.magnitude;
            }
        }
        piece.rest = bottom..self.list.len();
        piece.calm = piece.calm.plus(Span::hermite(calm[0], calm[1], length));
        for (end, calm) in piece.ends.iter_mut().zip(calm) {
            end.value -= calm.value;
            end.slope -= calm.slope;
        }
        let more = self.decide(along, share, &piece, above, error + ROUNDING * size, tell);
        self.list.truncate(bottom);
        more
    }

    /// The crossings on a piece of which all is known; whether more are wanted.
    fn decide(
        &mut self,
        along: &Along<'_>,
        share: f64,
        piece: &Piece,
        above: f64,
        error: f64,
        tell: &mut impl FnMut(f64, bool) -> bool,
    ) -> bool {
        let length = piece.to - piece.from;
        let steep = STEEP * (error + self.off.steep * length);
        // So near to T what is given tells nothing.
        let vague = self.off.value - error;
        let error = error + self.off.value;
        if piece.calm.max() + above < -error {
            return true;
        }
        let [left, right] = piece.ends;
        let span = piece.calm.plus(Span::hermite(left, right, length));
        let [a, b, c, d] = span.0;
        if span.max() < -error || span.min() > error {
            return true;
        }
        let turns = [b - a, c - b, d - c];
        let monotone = turns.iter().all(|x| *x > steep) || turns.iter().all(|x| *x < -steep);
        if monotone {
            return self.refine(along, piece, tell);
        }
        let hopeless = span.max() <= vague && span.min() >= -vague;
        if hopeless || length <= along.resolution || piece.depth >= DEEPEST {
            return self.give_up(along, piece, tell);
        }
        let t = 0.5 * (piece.from + piece.to);
        let middle = self.sum(along, &piece.rest, t);
        let [near, far] = piece.calm.halves();
        let near = Piece {
            to: t,
            depth: piece.depth + 1,
            most: next_share(piece.most),
            calm: near,
            ends: [left, middle],
            ..piece.clone()
        };
        let before = self.pieces;
        if !self.between(along, share, near, tell) {
            return false;
        }
        // What the near half left is the far one's.
        let far = Piece {
            from: t,
            depth: piece.depth + 1,
            most: piece.most.saturating_sub(before - self.pieces),
            calm: far,
            ends: [middle, right],
            ..piece.clone()
        };
        self.between(along, share, far, tell)
    }

    /// The same where no shorter piece would tell more: the signs at its ends decide, unless it is what is given that leaves it in doubt.
    fn give_up(
        &mut self,
        along: &Along<'_>,
        piece: &Piece,
        tell: &mut impl FnMut(f64, bool) -> bool,
    ) -> bool {
        if self.off.value > 0.0 {
            self.unsure = true;
            return false;
        }
        self.refine(along, piece, tell)
    }

    /// The crossing on a piece if its ends are on different sides.
    fn refine(
        &mut self,
        along: &Along<'_>,
        piece: &Piece,
        tell: &mut impl FnMut(f64, bool) -> bool,
    ) -> bool {
        let Piece { from, to, calm, .. } = *piece;
        let enters = calm.0[3] + piece.ends[1].value >= 0.0;
        if (calm.0[0] + piece.ends[0].value >= 0.0) == enters {
            return true;
        }
        let excess = |t: f64| {
            let rest = self.sum(along, &piece.rest, t);
            let (value, slope) = calm.value_and_slope((t - from) / (to - from));
            (rest.value + value, rest.slope + slope / (to - from))
        };
        let within = 1e-3 * along.resolution;
        tell(bracketed(excess, from, to, within), enters)
    }
}

/// What the next part may have of the pieces that it and those behind it may.
fn next_share(pieces: u32) -> u32 {
    (pieces - pieces / KEPT).max(FEW).min(pieces)
}

impl Along<'_> {
    /// A primitive's field and its slope along the ray, at a place on it.
    fn node(&self, primitive: u32, place: [f64; 3]) -> Node<f64> {
        let jet = self.sight.primitives[primitive as usize].jet(place);
        let [gx, gy, gz] = jet.gradient;
        let [dx, dy, dz] = self.ray.direction.to_array();
        Node {
            value: jet.value,
            slope: gx * dx + gy * dy + gz * dz,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use field::{BlobScale, Kernel, Shaping, Skeleton};
    use glam::DVec3;

    /// Crossings that are told with something given are those of the field, whatever that really is, within what it is off by; where
    /// that decides nothing is told.
    #[cfg_attr(target_arch = "wasm32", wasm_bindgen_test::wasm_bindgen_test)]
    #[cfg_attr(not(target_arch = "wasm32"), test)]
    fn what_is_given_hides_no_crossing() {
        const OFF: f64 = 1e-2;
        const LENGTH: f64 = 2.0;
        let shaping = Shaping {
            kernel: Kernel::Gauss,
            radius: 0.25,
            blobbiness: -2.0,
            blob_scale: BlobScale::Relative,
            strength: 1.0,
            influence: 1e-3,
            taper: None,
        };
        let ball = |center: DVec3| {
            Primitive::new(Skeleton::Point { center }, &shaping, None).expect("flesh")
        };
        let primitives = [ball(DVec3::Z * 0.7), ball(DVec3::new(0.1, 0.0, 1.2))];
        let bounds = primitives.each_ref().map(Bound::new);
        let sight = Sight {
            primitives: &primitives,
            bounds: &bounds,
            kinks: &Kinks::default(),
        };
        let (mut told_of, mut unsure) = (0, 0);
        for i in 0..600 {
            let along = Along {
                sight,
                ray: Ray {
                    origin: DVec3::X * (f64::from(i) * 1e-3 - 0.1),
                    direction: DVec3::Z,
                },
                resolution: 1e-7,
            };
            // A third of T is given.
            let given = Given {
                node: &|_| Node {
                    value: 0.3,
                    slope: 0.0,
                },
                off: OFF,
            };
            let mut settler = Settler::default();
            settler.list.extend([0, 1]);
            let Some(told) = settler.crossings_with(&along, [0.0, LENGTH], &given) else {
                unsure += 1;
                continue;
            };
            told_of += told.len() - 1;
            for phase in 0..8 {
                // Its slope is off by no more than four times that over the length, too.
                let really = |t: f64| {
                    let wave = libm::cos(f64::from(phase) + 4.0 * t / LENGTH);
                    let point = along.ray.at(t).to_array();
                    let field: f64 = primitives.iter().map(|p| p.value(point)).sum();
                    field + 0.3 + 0.99 * OFF * wave - THRESHOLD
                };
                let places = (0..=4000).map(|k| f64::from(k) * LENGTH / 4000.0);
                let places: Vec<f64> = places.collect();
                let crossed = places
                    .windows(2)
                    .filter(|w| (really(w[0]) >= 0.0) != (really(w[1]) >= 0.0));
                let crossed: Vec<f64> = crossed.map(|w| w[0]).collect();
                assert_eq!(crossed.len() + 1, told.len(), "{i} {phase}: {told:?}");
                for (t, (found, _)) in crossed.iter().zip(&told[1..]) {
                    let slope = (really(found + 1e-4) - really(found - 1e-4)).abs() / 2e-4;
                    let apart = (t - found).abs();
                    assert!(apart < 1e-3 + 3.0 * OFF / slope, "{i} {phase}: {t} {found}");
                }
            }
        }
        assert!(
            told_of > 600 && (2..60).contains(&unsure),
            "{told_of} {unsure}"
        );
    }

    /// Where what is given may be off so that a slope is turned round, one crossing may be three.
    #[cfg_attr(target_arch = "wasm32", wasm_bindgen_test::wasm_bindgen_test)]
    #[cfg_attr(not(target_arch = "wasm32"), test)]
    fn a_slope_that_may_be_turned_is_not_told() {
        let sight = Sight {
            primitives: &[],
            bounds: &[],
            kinks: &Kinks::default(),
        };
        let along = Along {
            sight,
            ray: Ray {
                origin: DVec3::ZERO,
                direction: DVec3::Z,
            },
            resolution: 1e-7,
        };
        // `slope·u − off·sin 2u`, u = t − 1, crosses T three times where the slope is less than 2·off.
        for (slope, told) in [(0.015, None), (0.03, Some(2)), (1.0, Some(2))] {
            let given = Given {
                node: &|t| Node {
                    value: THRESHOLD + slope * (t - 1.0),
                    slope,
                },
                off: 0.01,
            };
            let mut settler = Settler::default();
            let crossings = settler.crossings_with(&along, [0.0, 2.0], &given);
            assert_eq!(crossings.map(|told| told.len()), told, "{slope}");
            // What told nothing takes no pieces from what does.
            assert_eq!(settler.pieces == MOST_PIECES, told.is_none(), "{slope}");
        }
    }
}
