//! Root isolation along single rays in double precision, where the spans of a packet leave a ray in
//! doubt.
//!
//! Where a ray grazes the surface, the field comes nearer to T than the error of single precision
//! spans. On such an interval the field is interpolated by one cubic, and the interval is halved
//! until the error bound isolates the crossings, or the pieces are shorter than the resolution. A
//! primitive whose own error on a piece is negligible is *resolved* there: its cubic is kept, and
//! the halves do not evaluate it again. At kinks and jumps of profiles the ray is cut.
//!
//! Among very many primitives most are far away and have shared interpolants already. Their error
//! seldom matters, so isolation is first tried with these interpolants in place of the far
//! primitives ([`KnownPart`]).
use crate::kinks::Kinks;
use crate::ray::Ray;
use crate::roots::refine_root;
use crate::slabs::LARGE_TERM;
use crate::spans::{KnownPart, Node, Span};
use core::ops::Range;
use field::bound::SpanLength;
use field::{Bound, Cut, Primitive, THRESHOLD};

/// Most pieces of all rays of a packet; on the rest the signs at the ends decide.
const MOST_PIECES: u32 = 1 << 16;
/// Ratio of the remaining pieces to those that an interval may use: a ray that runs along the
/// surface would use up any number, and later intervals need some.
const AT_ONCE: u32 = 4;
/// Ratio of an interval's pieces to those kept for the parts after the next one (from kink to kink,
/// or the near half of a piece). A larger reserve would starve small parts of long intervals, as
/// each halving takes its share; pieces that a part does not use go to those after it in any case.
const KEPT: u32 = 8;
/// Fewest pieces for a part, if there are as many left: enough to isolate a few crossings.
const FEWEST_PIECES: u32 = 256;
/// Largest number of halvings of a piece, also for lengths that are not finite.
const MOST_HALVINGS: u32 = 50;
/// Number of primitives for which a piece counts as one more.
const PRIMITIVES_A_PIECE: u32 = 64;
/// Largest error of all resolved primitives together, in T.
const RESOLVED: f64 = 1e-9;
/// Rounding of a field in double precision, relative to the sizes of its terms.
const SUM_ROUNDING: f64 = 1e-12;
/// Ratio to a Hermite cubic's error bound from which differences of its Bernstein coefficients
/// prove that the field is monotone. The cubic's slope is off by at most four times the bound over
/// the length (for bounds by the second derivative; for the fourth it is 3.08), and the slope's own
/// Bernstein coefficients are 3/length times those differences: 4/3 and a little.
pub const STEEP: f64 = 1.34;

/// Error of the [`KnownPart`]; 0 without one.
#[derive(Clone, Copy, Debug, Default)]
struct Off {
    /// Error of the value.
    value: f64,
    /// Error of the value over the length of the interval.
    steep: f64,
}

/// Isolator of the crossings of one packet's rays.
#[derive(Debug)]
pub struct RootIsolator {
    /// Primitives that count on the interval.
    pub list: Vec<u32>,
    pieces: u32,
    off: Off,
    /// Whether the known part's error was too large to decide.
    unsure: bool,
    /// Evaluations of one primitive's field at one point.
    pub evaluations: u64,
}

impl Default for RootIsolator {
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

/// A piece of an interval.
#[derive(Clone, Debug)]
struct Subinterval {
    from: f64,
    to: f64,
    /// Number of halvings.
    depth: u32,
    /// Number of pieces that it may be cut into.
    most: u32,
    /// Sum of the resolved terms and the known part, less T.
    resolved: Span<f64>,
    /// Range of the list that holds the other primitives.
    rest: Range<usize>,
    /// Sum of the other primitives' fields at both ends.
    ends: [Node<f64>; 2],
}

/// Primitives with their bounds and kinks.
#[derive(Clone, Copy, Debug)]
pub struct BoundedTerms<'a> {
    /// The primitives.
    pub primitives: &'a [Primitive],
    /// Bounds of the primitives.
    pub bounds: &'a [Bound],
    /// Kinks of the primitives' profiles.
    pub kinks: &'a Kinks,
}

/// The field along a ray.
#[derive(Clone, Copy, Debug)]
pub struct Along<'a> {
    /// The field's primitives.
    pub sight: BoundedTerms<'a>,
    /// The ray, its direction of unit length.
    pub ray: Ray,
    /// Length below which pieces are not halved.
    pub resolution: f64,
}

impl RootIsolator {
    /// Calls `tell` with the start of an interval and whether it is inside the surface, and then
    /// with each crossing and whether it enters, in order, until `tell` returns false.
    pub fn crossings(
        &mut self,
        along: &Along<'_>,
        interval: [f64; 2],
        mut tell: impl FnMut(f64, bool) -> bool,
    ) {
        self.off = Off::default();
        self.follow(along, interval, &|_| Node::zero(), &mut tell);
    }

    /// Returns the crossings of the sum of a known part and the listed primitives, after the start
    /// of the interval, as [`RootIsolator::crossings`] gives them. `None` if the known part's error
    /// leaves one in doubt.
    pub fn crossings_with(
        &mut self,
        along: &Along<'_>,
        interval: [f64; 2],
        known: &KnownPart<'_>,
    ) -> Option<Vec<(f64, bool)>> {
        self.off = Off {
            value: known.off,
            steep: known.off / (interval[1] - interval[0]),
        };
        self.unsure = false;
        let pieces = self.pieces;
        let mut crossings = Vec::new();
        self.follow(along, interval, known.node, &mut |t, inside| {
            crossings.push((t, inside));
            true
        });
        if self.unsure {
            // The search with all primitives gets them.
            self.pieces = pieces;
            return None;
        }
        Some(crossings)
    }

    /// Follows a ray through an interval, cut at kinks, like [`RootIsolator::crossings`]; `known`
    /// returns the known part.
    fn follow(
        &mut self,
        along: &Along<'_>,
        [from, to]: [f64; 2],
        known: &dyn Fn(f64) -> Node<f64>,
        tell: &mut dyn FnMut(f64, bool) -> bool,
    ) {
        // Error up to which a primitive counts as resolved.
        let share = RESOLVED * THRESHOLD / self.list.len().max(1) as f64;
        let mut start = from;
        let parts = self.kinks(along, [from, to]);
        let mut left = self.pieces / AT_ONCE;
        let count = parts.len() as u32;
        for (i, end) in (0..count).zip(parts) {
            // Next to a kink, not on it.
            let [before, behind] =
                [start, end].map(|t| (1e-3 * along.resolution).max(1e-13 * (1.0 + t)));
            let first = if start > from { start + before } else { from };
            let last = if end < to { end - behind } else { to };
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
            let known = Span::hermite(known(first), known(last), last - first);
            let resolved = Span([-THRESHOLD; 4]).plus(known);
            let piece = Subinterval {
                from: first,
                to: last,
                depth: 0,
                most,
                resolved,
                rest,
                ends,
            };
            if !tell(first, resolved.0[0] + ends[0].value >= 0.0)
                || !self.between(along, share, piece, tell)
            {
                return;
            }
            left = left.saturating_sub(before - self.pieces);
        }
    }

    /// Returns the kinks of the listed primitives between two parameters, and the second parameter,
    /// in order.
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
        field::heap_sort(&mut found, |a, b| a.total_cmp(b).is_lt());
        found
    }

    /// Adds up some primitives of the list at t.
    fn sum(&mut self, along: &Along<'_>, range: &Range<usize>, t: f64) -> Node<f64> {
        let point = along.ray.at(t).to_array();
        let sum = self.list[range.clone()]
            .iter()
            .fold(Node::zero(), |sum, &p| sum.plus(along.node(p, point)));
        self.evaluations += range.len() as u64;
        sum
    }

    /// Reports the crossings on a piece; returns false if `tell` did.
    fn between(
        &mut self,
        along: &Along<'_>,
        share: f64,
        mut piece: Subinterval,
        tell: &mut dyn FnMut(f64, bool) -> bool,
    ) -> bool {
        let cost = 1 + piece.rest.len() as u32 / PRIMITIVES_A_PIECE;
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
        let mut error = RESOLVED * THRESHOLD;
        let places = [piece.from, piece.to].map(|t| along.ray.at(t).to_array());
        let mut resolved = [Node::zero(); 2];
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
                resolved = [0, 1].map(|i| resolved[i].plus(along.node(p, places[i])));
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
        piece.resolved = piece
            .resolved
            .plus(Span::hermite(resolved[0], resolved[1], length));
        for (end, resolved) in piece.ends.iter_mut().zip(resolved) {
            end.value -= resolved.value;
            end.slope -= resolved.slope;
        }
        let more = self.decide(
            along,
            share,
            &piece,
            above,
            error + SUM_ROUNDING * size,
            tell,
        );
        self.list.truncate(bottom);
        more
    }

    /// Decides a piece by its cubic and error bound, or halves it; returns false if `tell` did.
    fn decide(
        &mut self,
        along: &Along<'_>,
        share: f64,
        piece: &Subinterval,
        above: f64,
        error: f64,
        tell: &mut dyn FnMut(f64, bool) -> bool,
    ) -> bool {
        let length = piece.to - piece.from;
        let steep = STEEP * (error + self.off.steep * length);
        // Within this of T the known part's error decides, however short the piece.
        let vague = self.off.value - error;
        let error = error + self.off.value;
        if piece.resolved.max() + above < -error {
            return true;
        }
        let [left, right] = piece.ends;
        let span = piece.resolved.plus(Span::hermite(left, right, length));
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
        if hopeless || length <= along.resolution || piece.depth >= MOST_HALVINGS {
            return self.give_up(along, piece, tell);
        }
        let t = 0.5 * (piece.from + piece.to);
        let middle = self.sum(along, &piece.rest, t);
        let [near, far] = piece.resolved.halves();
        let near = Subinterval {
            to: t,
            depth: piece.depth + 1,
            most: next_share(piece.most),
            resolved: near,
            ends: [left, middle],
            ..piece.clone()
        };
        let before = self.pieces;
        if !self.between(along, share, near, tell) {
            return false;
        }
        // The far half gets the pieces that the near one left.
        let far = Subinterval {
            from: t,
            depth: piece.depth + 1,
            most: piece.most.saturating_sub(before - self.pieces),
            resolved: far,
            ends: [middle, right],
            ..piece.clone()
        };
        self.between(along, share, far, tell)
    }

    /// Decides a piece that is not halved further: by the signs at its ends, unless the known
    /// part's error leaves it in doubt.
    fn give_up(
        &mut self,
        along: &Along<'_>,
        piece: &Subinterval,
        tell: &mut dyn FnMut(f64, bool) -> bool,
    ) -> bool {
        if self.off.value > 0.0 {
            self.unsure = true;
            return false;
        }
        self.refine(along, piece, tell)
    }

    /// Reports the crossing on a piece whose ends have different signs.
    fn refine(
        &mut self,
        along: &Along<'_>,
        piece: &Subinterval,
        tell: &mut dyn FnMut(f64, bool) -> bool,
    ) -> bool {
        let Subinterval {
            from, to, resolved, ..
        } = *piece;
        let enters = resolved.0[3] + piece.ends[1].value >= 0.0;
        if (resolved.0[0] + piece.ends[0].value >= 0.0) == enters {
            return true;
        }
        let t = refine_root(
            |t| {
                let rest = self.sum(along, &piece.rest, t);
                let (value, slope) = resolved.value_and_slope((t - from) / (to - from));
                (rest.value + value, rest.slope + slope / (to - from))
            },
            from,
            to,
            1e-3 * along.resolution,
        );
        tell(t, enters)
    }
}

/// Returns the number of pieces for the next part, of those for it and the parts after it.
fn next_share(pieces: u32) -> u32 {
    (pieces - pieces / KEPT).max(FEWEST_PIECES).min(pieces)
}

impl Along<'_> {
    /// Returns the field of a primitive and its slope along the ray, at a point on it.
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

    /// Crossings with a known part are those of the field, whatever the error within the bound;
    /// where the error decides there is no answer.
    #[test]
    fn a_known_part_hides_no_crossing() {
        const OFF: f64 = 1e-2;
        const LENGTH: f64 = 2.0;
        let shaping = Shaping {
            kernel: Kernel::Gauss,
            radius: 0.25,
            blobbiness: 2.0,
            blob_scale: BlobScale::Relative,
            strength: 1.0,
            influence: 1e-3,
            taper: None,
        };
        let primitives = [DVec3::Z * 0.7, DVec3::new(0.1, 0.0, 1.2)].map(|center| {
            Primitive::new(Skeleton::Point { center }, &shaping, None).expect("flesh")
        });
        let bounds = primitives.each_ref().map(Bound::new);
        let sight = BoundedTerms {
            primitives: &primitives,
            bounds: &bounds,
            kinks: &Kinks::default(),
        };
        let (mut count, mut unsure) = (0, 0);
        for i in 0..300 {
            let along = Along {
                sight,
                ray: Ray {
                    origin: DVec3::X * (f64::from(i) * 2e-3 - 0.1),
                    direction: DVec3::Z,
                },
                resolution: 1e-7,
            };
            // A third of T is known.
            let known = KnownPart {
                node: &|_| Node {
                    value: 0.3,
                    slope: 0.0,
                },
                off: OFF,
            };
            let mut isolator = RootIsolator::default();
            isolator.list.extend([0, 1]);
            let Some(found) = isolator.crossings_with(&along, [0.0, LENGTH], &known) else {
                unsure += 1;
                continue;
            };
            count += found.len() - 1;
            for phase in [0, 2, 3, 5] {
                // The field with an error whose slope is at most four times it over the length.
                let excess = |t: f64| {
                    let wave = libm::cos(f64::from(phase) + 4.0 * t / LENGTH);
                    let point = along.ray.at(t).to_array();
                    let field: f64 = primitives.iter().map(|p| p.value(point)).sum();
                    field + 0.3 + 0.99 * OFF * wave - THRESHOLD
                };
                let places = (0..=4000).map(|k| f64::from(k) * LENGTH / 4000.0);
                let places: Vec<f64> = places.collect();
                let crossed = places
                    .windows(2)
                    .filter(|w| (excess(w[0]) >= 0.0) != (excess(w[1]) >= 0.0));
                let crossed: Vec<f64> = crossed.map(|w| w[0]).collect();
                assert_eq!(crossed.len() + 1, found.len(), "{i} {phase}: {found:?}");
                for (t, (found, _)) in crossed.iter().zip(&found[1..]) {
                    let slope = (excess(found + 1e-4) - excess(found - 1e-4)).abs() / 2e-4;
                    let apart = (t - found).abs();
                    assert!(apart < 1e-3 + 3.0 * OFF / slope, "{i} {phase}: {t} {found}");
                }
            }
        }
        assert!(count > 300 && (1..30).contains(&unsure), "{count} {unsure}");
    }

    /// The known part's error may make three crossings of one if it may change the slope's sign.
    #[test]
    fn slopes_of_unknown_sign_are_not_decided() {
        let sight = BoundedTerms {
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
        // `slope·u − off·sin 2u`, u = t − 1, crosses T three times where the slope is less than
        // 2·off.
        for (slope, want) in [(0.015, None), (0.03, Some(2)), (1.0, Some(2))] {
            let known = KnownPart {
                node: &|t| Node {
                    value: THRESHOLD + slope * (t - 1.0),
                    slope,
                },
                off: 0.01,
            };
            let mut isolator = RootIsolator::default();
            let crossings = isolator.crossings_with(&along, [0.0, 2.0], &known);
            assert_eq!(crossings.map(|crossings| crossings.len()), want, "{slope}");
            // A search without an answer uses up no pieces.
            assert_eq!(isolator.pieces == MOST_PIECES, want.is_none(), "{slope}");
        }
    }
}
