//! Near primitives of any kind: cubic Hermite spans along the rays, on pieces that are halved until their errors are small.
use super::hits::{Known, Start};
use super::piece::Piece;
use super::{FarBody, FarQuery, FarWork, ROUNDING};
use crate::blob_march::{Backdrop, Marched, extremes};
use crate::layout::PACKET;
use crate::root_isolation::RootIsolator;
use crate::slabs::LARGE_TERM;
use crate::spans::{KnownPart, Node};
use crate::walk::Quest;
use core::ops::Range;
use field::bound::SpanLength;
use field::{Bound, Cut, THRESHOLD};
use wide::f32x8;

/// Largest error of all spans of a piece together, in T …
const OF_SPANS: f64 = 1e-4 * THRESHOLD;
/// … and the part of what is left of it that one of them may use up.
const SHARE: f64 = 0.125;
/// Largest error of all that is known of a piece; beyond it this is not the way.
const MOST_ERROR: f64 = 5e-4 * THRESHOLD;
/// Rounding of coordinates and values in single precision.
pub const SINGLE: f64 = 2.5e-7;
/// Rounding of a polynomial's coefficients as pieces are halved, and of its values, over the sum of the coefficients' sizes.
const COEFFICIENTS: f64 = 1e-6;
/// Width of the beam over half a piece's length from which on primitives are judged ray by ray.
const WIDE: f64 = 0.5;
/// Largest number of halvings.
const MOST_HALVINGS: u32 = 16;

/// Bounds on a primitive on a piece.
#[derive(Clone, Copy)]
pub struct Judged {
    /// On its size, on each ray.
    pub sizes: [f64; PACKET],
    /// On the error of its span.
    pub error: f64,
    /// On the effect of rounding in single precision.
    pub noise: f64,
}

/// Work with the pieces of a cell.
struct Halving<'a, 'q> {
    query: &'a FarQuery<'q>,
    /// Whether the rays start with the piece.
    is_start: bool,
}

impl FarBody {
    /// Follows rays through a piece of their way among primitives of any kind. Returns those that cross the surface there; `None` if
    /// this is not the way.
    pub(super) fn follow_spans(
        &self,
        query: &FarQuery<'_>,
        piece: &Piece<'_>,
        alive: u32,
        is_start: bool,
        work: &mut FarWork,
    ) -> Option<u32> {
        work.blobs.clear();
        work.intervals.clear();
        work.pending.clear();
        work.pending.extend(&piece.cell.near);
        let halving = Halving { query, is_start };
        let known = Known {
            backdrop: piece.far(),
            error: piece.cell.error,
        };
        let left = OF_SPANS;
        let all = 0..work.pending.len();
        self.descend(&halving, piece, (known, left), all, alive, 0, work)
    }

    /// Adds the spans of those pending primitives that are exact enough to what is known of a piece, and follows the rays if there
    /// are no others, or halves the piece.
    #[expect(clippy::too_many_arguments, reason = "each is something else")]
    fn descend(
        &self,
        halving: &Halving<'_, '_>,
        piece: &Piece<'_>,
        (mut known, mut budget): (Known, f64),
        pending: Range<usize>,
        alive: u32,
        depth: u32,
        work: &mut FarWork,
    ) -> Option<u32> {
        let query = halving.query;
        let bottom = work.pending.len();
        self.judge(query, piece, &pending, alive, SHARE * budget, work);
        work.resolved.clear();
        let (mut all, mut left, mut lost) = ([0.0; PACKET], [0.0; PACKET], 0.0);
        for (index, at) in pending.enumerate() {
            let number = work.pending[at];
            let Judged {
                sizes,
                error,
                noise,
            } = work.judged[index];
            let adds = self.bound(query, number).adds();
            if adds {
                all.iter_mut().zip(sizes).for_each(|(sum, own)| *sum += own);
            }
            if error <= SHARE * budget {
                budget -= error;
                lost += error + noise;
                work.resolved.push(number);
            } else {
                work.pending.push(number);
                if adds {
                    left.iter_mut()
                        .zip(sizes)
                        .for_each(|(sum, own)| *sum += own);
                }
            }
        }
        // The rays on which what is known and some more may add up to T.
        let may_meet = |known: &Known, more: [f64; PACKET]| {
            let (most, _) = known.backdrop.limits();
            let most = most.to_array();
            let level = THRESHOLD - ROUNDING - known.error;
            (0..PACKET).fold(0, |lanes, i| {
                // Not so for NaN.
                let is_below = f64::from(most[i]) + more[i] < level;
                lanes | u32::from(!is_below) << i
            })
        };
        let mut alive = alive & may_meet(&known, all);
        if alive == 0 {
            work.pending.truncate(bottom);
            return Some(0);
        }
        if !work.resolved.is_empty() {
            let nodes = self.nodes(query, piece, work);
            piece.add_span(&mut known.backdrop, nodes);
            known.error += lost;
        }
        let pending = bottom..work.pending.len();
        if pending.is_empty() {
            let size = known.backdrop.coefficients.iter();
            let size = size.fold(f32x8::splat(0.0), |sum, c| sum + c.abs());
            let (_, size) = extremes(size, size, alive);
            known.error += COEFFICIENTS * f64::from(size);
            // Not so for NaN.
            let is_exact = known.error <= MOST_ERROR;
            if !is_exact {
                return None;
            }
            let far = f32x8::splat(f32::INFINITY);
            let start = Start {
                guess: far,
                first: far,
                is_start: halving.is_start,
            };
            return self.follow(query, piece, &known, alive, start, work);
        }
        alive &= may_meet(&known, left);
        let met = if alive == 0 {
            0
        } else if depth >= MOST_HALVINGS {
            self.isolate_pending(halving, piece, &known, &pending, alive, work)?
        } else {
            let [near, far] = piece.halves();
            let [first, last] = known.halves();
            let next = depth + 1;
            let met = self.descend(
                halving,
                &near,
                (first, budget),
                pending.clone(),
                alive,
                next,
                work,
            )?;
            let later = Halving {
                is_start: false,
                ..*halving
            };
            let rest = alive & !met;
            if rest == 0 {
                met
            } else {
                met | self.descend(&later, &far, (last, budget), pending, rest, next, work)?
            }
        };
        work.pending.truncate(bottom);
        Some(met)
    }

    /// Bounds on pending primitives on a piece: on its whole, or ray by ray if the beam is wide and the error more than this.
    fn judge(
        &self,
        query: &FarQuery<'_>,
        piece: &Piece<'_>,
        pending: &Range<usize>,
        alive: u32,
        enough: f64,
        work: &mut FarWork,
    ) {
        work.judged.clear();
        let is_wide = piece.width > WIDE * piece.half;
        let numbers = &work.pending[pending.clone()];
        if let Some(bars) = &self.bars {
            let alive = if is_wide { alive } else { 0 };
            bars.judge(piece, numbers, alive, enough, &mut work.judged);
            return;
        }
        let radius = (piece.half + piece.width) * (1.0 + 1e-9);
        let length = SpanLength::new(2.0 * piece.half);
        let primitives = self.primitives(query);
        for &number in numbers {
            let bound = self.bound(query, number);
            let near = bound.nearness(piece.middle, radius);
            let estimate = bound.estimate(near, &length);
            // Where the field is T.
            let size = estimate.magnitude.at_most(LARGE_TERM);
            let away = primitives[number as usize].frame_middle() - piece.middle;
            let misplaced = SINGLE * (away.length() + radius);
            let places = misplaced * size * bound.relative_slope(near);
            let mut own = Judged {
                sizes: [estimate.magnitude; PACKET],
                error: estimate.error,
                noise: places + SINGLE * (size + 2.0 * bound.cancels()),
            };
            if is_wide && own.error > enough {
                own.error = 0.0;
                for lane in (0..PACKET).filter(|i| alive >> i & 1 != 0) {
                    let near = bound.nearness(piece.middle_of(lane), piece.half);
                    let estimate = bound.estimate(near, &length);
                    own.error = estimate.error.at_least(own.error);
                    own.sizes[lane] = estimate.magnitude;
                }
            }
            work.judged.push(own);
        }
    }

    fn bound<'a>(&self, query: &FarQuery<'a>, number: u32) -> &'a Bound {
        &query.sight.bounds[self.first + number as usize]
    }

    /// The sums of the resolved primitives and of their slopes at both ends of a piece.
    fn nodes(
        &self,
        query: &FarQuery<'_>,
        piece: &Piece<'_>,
        work: &mut FarWork,
    ) -> [Node<f32x8>; 2] {
        let primitives = self.primitives(query);
        work.evaluations += 16 * work.resolved.len() as u64;
        let half = f32x8::splat(piece.half as f32);
        [-half, half].map(|t| {
            let place = piece.places(t);
            let mut sum = Node::zero();
            for number in &work.resolved {
                let jet = primitives[*number as usize].jet_about(piece.middle, place);
                let [x, y, z] = jet.gradient;
                let [dx, dy, dz] = piece.direction;
                sum = sum.plus(Node {
                    value: jet.value,
                    slope: x * dx + y * dy + z * dz,
                });
            }
            sum
        })
    }

    /// Isolates the crossings on a piece ray by ray in double precision: with the pending primitives and what is known of the
    /// others, or with all if that leaves one in doubt.
    #[cold]
    #[inline(never)]
    fn isolate_pending(
        &self,
        halving: &Halving<'_, '_>,
        piece: &Piece<'_>,
        known: &Known,
        pending: &Range<usize>,
        alive: u32,
        work: &mut FarWork,
    ) -> Option<u32> {
        let query = halving.query;
        let (mut t, mut met) = ([0.0f32; PACKET], 0);
        for lane in (0..PACKET).filter(|i| alive >> i & 1 != 0) {
            let to = piece.half.at_most(query.limits[lane] - piece.t);
            let interval = [-piece.half, to];
            if interval[0] >= interval[1] {
                continue;
            }
            let along = self.along(query, piece, lane);
            let mut isolator = RootIsolator::default();
            let numbers = work.pending[pending.clone()].iter();
            let numbers = numbers.map(|number| self.first as u32 + number);
            isolator.list.extend(numbers);
            let backdrop = known.lane(lane);
            let part = KnownPart {
                node: &|t| backdrop.node(t),
                off: known.error + ROUNDING + backdrop.off(),
            };
            let mut told = isolator.crossings_with(&along, interval, &part);
            if told.is_none() {
                work.doubts += 1;
                isolator.list.clear();
                isolator.list.extend(self.numbers());
                let mut all = Vec::new();
                isolator.crossings(&along, interval, |t, inside| {
                    all.push((t, inside));
                    !inside
                });
                told = Some(all);
            }
            work.evaluations += isolator.evaluations;
            let inside = told.into_iter().flatten().find(|(_, inside)| *inside);
            if let Some((at, _)) = inside {
                if halving.is_start && at <= interval[0] {
                    return None;
                }
                t[lane] = at as f32;
                met |= 1 << lane;
            }
        }
        if met != 0 && query.quest != Quest::Entry {
            let t = f32x8::new(t);
            let marched = Marched {
                t,
                between: [t, t],
                met,
                doubtful: 0,
                doubt: [t, t],
                evaluations: 0,
            };
            self.sample(query, piece, known, &marched, work)?;
        }
        Some(met)
    }
}

impl Known {
    /// The same on the near and the far half of the piece.
    fn halves(&self) -> [Self; 2] {
        let Backdrop { coefficients, half } = self.backdrop;
        let mut scale = 1.0f32;
        let scaled = coefficients.map(|c| {
            let own = c * f32x8::splat(scale);
            scale *= 0.5;
            own
        });
        // x = (y ∓ 1)/2, with y between −1 and 1 on the half.
        [-1.0, 1.0].map(|shift| {
            let mut own = scaled;
            for first in 0..own.len() - 1 {
                for k in (first..own.len() - 1).rev() {
                    own[k] += f32x8::splat(shift) * own[k + 1];
                }
            }
            Self {
                backdrop: Backdrop {
                    coefficients: own,
                    half: 0.5 * half,
                },
                ..*self
            }
        })
    }

    fn lane(&self, lane: usize) -> OnRay {
        let of = |c: f32x8| f64::from(c.to_array()[lane]);
        OnRay {
            coefficients: self.backdrop.coefficients.map(of),
            half: f64::from(self.backdrop.half),
        }
    }
}

/// A backdrop on one ray.
struct OnRay {
    coefficients: [f64; 6],
    half: f64,
}

impl OnRay {
    fn node(&self, t: f64) -> Node<f64> {
        let x = t / self.half;
        let (mut value, mut slope) = (0.0, 0.0);
        for c in self.coefficients.iter().rev() {
            slope = slope * x + value;
            value = value * x + c;
        }
        Node {
            value,
            slope: slope / self.half,
        }
    }

    /// Bound on the error of a cubic Hermite span of it: `|f⁗|·2⁴/384` in x.
    fn off(&self) -> f64 {
        let [.., e, f] = self.coefficients;
        e.abs() + 5.0 * f.abs()
    }
}
