//! Bounds on the fields in a ball.
//!
//! At a point of the ball F is the mean `E[W]` of stretches by their shares ω̂. With `gⱼ = ∇ln ωⱼ =
//! 8∇fⱼ/fⱼ`, and a, b the differences of g and W from values that are the same for all of them,
//!
//! `∇F = E[∇W] + Cov(g, W)`,
//! `∇²F = E[∇²W] + 2·Cov(g, ∇W) + Cov(∇g, W) + E[(g−E g)²(W−E W)]`,
//! `|Cov(g, W)| ≤ E|a||b| + |E a||E b|`, and so on. Here b is the difference from the mean of all
//! stretches by their shares at the ball's centre, and a that from the mean of g there: at the
//! centre both have the mean 0.
use super::cells::{Far, Rows, Slots, Terms};
use super::mean::{CUT, POWER, power, ramp, shares};
use super::{Local, Piece};
use crate::ripple::times;
use crate::{Ball, Enclosure, Jet, THRESHOLD, Variation};
use glam::DVec3;

/// Bounds on a function in a ball: those of [`crate::Enclosure`], and how much its gradient jumps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The least and the largest value.
    pub value: [f64; 2],
    /// The largest length of the gradient; infinite if the value may jump.
    pub slope: f64,
    /// The largest second derivative along any line, where there is one.
    pub curvature: f64,
    /// The gradients at two points differ by no more than the curvature times their distance and
    /// this.
    pub jump: f64,
    /// Bounds on the two functions that it is the sum of.
    pub halves: Halves,
}

/// Bounds on a function as the sum of a main one, the mean by constant shares, and of the rest,
/// which is small where neighbouring stretches are alike, however fast the shares change.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Halves {
    /// The main function's largest second derivative along any line.
    pub curvature: f64,
    /// The main function's largest third derivative along any line; infinite if none is known.
    pub third: f64,
    /// The largest length of the gradient of the rest.
    pub rest: f64,
}

impl Halves {
    /// Halves of which nothing is known.
    pub const UNKNOWN: Self = Self {
        curvature: f64::INFINITY,
        third: f64::INFINITY,
        rest: f64::INFINITY,
    };

    /// Returns bounds on the sum with a multiple of another function, whose third derivative is
    /// not known.
    #[must_use]
    pub fn plus(self, factor: f64, other: &Self) -> Self {
        Self {
            curvature: self.curvature + times(factor, other.curvature),
            third: f64::INFINITY,
            rest: self.rest + times(factor, other.rest),
        }
    }
}

/// Bounds on F and F₂ in a ball.
#[derive(Clone, Copy, Debug)]
pub struct Two {
    /// Bounds on F.
    pub first: Bounds,
    /// Bounds on F₂; `None` if it is nowhere above its level.
    pub second: Option<Bounds>,
    /// F and F₂ at the ball's centre, if finding the bounds finds them.
    pub at_center: Option<(Jet<f64>, Option<Jet<f64>>)>,
}

/// Sums of all fields below this are not looked at closely.
const FAINT: f64 = 0.05;
/// Balls with a larger radius, in reaches, are not looked at closely.
const COARSE: f64 = 0.25;
/// Part of the largest value by which that of a point may be off, as small weights count as 0.
const LEFT_OUT: f64 = 1e-10;

impl Bounds {
    /// Returns bounds on a function of which no more is known than its values.
    fn loose(value: [f64; 2]) -> Self {
        Self {
            value,
            slope: f64::INFINITY,
            curvature: f64::INFINITY,
            jump: f64::INFINITY,
            halves: Halves::UNKNOWN,
        }
    }

    /// Returns the bounds as an enclosure, whose curvature is infinite where the gradient jumps.
    #[must_use]
    pub fn enclosure(&self) -> Enclosure {
        Enclosure {
            value: self.value,
            slope: self.slope,
            curvature: if self.jump > 0.0 {
                f64::INFINITY
            } else {
                self.curvature
            },
        }
    }

    /// Returns the bounds as mesher and tracer read them.
    #[must_use]
    pub fn variation(&self) -> Variation {
        // Where the value jumps, nothing is known of derivatives.
        let is_tame = self.slope.is_finite() && self.curvature.is_finite();
        let curvature = if is_tame { self.curvature } else { 0.0 };
        Variation {
            range: self.enclosure(),
            curvature,
            third: 0.0,
            rough: curvature,
            jump: if is_tame { self.jump } else { f64::INFINITY },
            step: 0.0,
        }
    }

    /// Returns the bounds as [`Bounds::variation`] does, with a third derivative of the main half.
    /// Where the gradient of the rest changes less by its slope than by its curvature in a ball of
    /// this radius, that counts as a jump.
    #[must_use]
    pub fn variation_by_halves(&self, radius: f64) -> Variation {
        let whole = self.variation();
        let Halves {
            curvature,
            third,
            rest,
        } = self.halves;
        let [bend, jump] = [self.curvature - curvature, 2.0 * rest];
        let is_split = jump < bend * radius;
        if self.jump > 0.0 || !(is_split || third.is_finite()) {
            return whole;
        }
        if !is_split {
            return Variation {
                third,
                rough: bend,
                ..whole
            };
        }
        let [third, rough] = match third.is_finite() {
            true => [third, 0.0],
            false => [0.0, curvature],
        };
        Variation {
            curvature,
            third,
            rough,
            jump,
            ..whole
        }
    }
}

/// Bounds on a piece's field in a ball.
#[derive(Clone, Copy, Debug, Default)]
struct Close {
    low: f64,
    most: f64,
    slope: f64,
    curvature: f64,
    third: f64,
}

/// Bounds on pieces in a ball, each made once.
pub(super) struct Nearby<'a> {
    local: &'a Local,
    ball: Ball,
    slots: &'a Slots,
    calm: &'a [Option<[f32; 3]>],
    known: Vec<u8>,
    /// Upper bounds on fields in the ball.
    most: Vec<f64>,
    /// Fields at the ball's centre, and bounds on them in the ball.
    jets: Vec<Jet<f64>>,
    close: Vec<Close>,
}

impl<'a> Nearby<'a> {
    /// Prepares looks at pieces in a ball that is within that of the terms.
    pub fn new(local: &'a Local, ball: Ball, terms: &'a Terms) -> Self {
        let count = terms.slots.count();
        Self {
            local,
            ball,
            slots: &terms.slots,
            calm: &terms.calm,
            known: vec![0; count],
            most: vec![0.0; count],
            jets: vec![Jet::zero(); count],
            close: vec![Close::default(); count],
        }
    }

    fn piece(&self, number: u32) -> &'a Piece {
        &self.local.pieces[number as usize]
    }

    /// Returns an upper bound on the field of a piece.
    fn most_at(&mut self, number: u32, slot: usize) -> f64 {
        if self.known[slot] == 0 {
            self.most[slot] = self.piece(number).most(&self.ball);
            self.known[slot] = 1;
        }
        self.most[slot]
    }

    /// Looks closely at a piece.
    fn look(&mut self, number: u32, slot: usize, leads: bool) {
        if self.known[slot] == 2 {
            return;
        }
        let Ball { center, radius } = self.ball;
        let piece = self.piece(number);
        let jet = piece.jet(center.to_array());
        let (mut most, mut least) = (f64::INFINITY, 0.0);
        let [slope, curvature, third] = match self.calm[slot] {
            Some(bounds) => bounds.map(f64::from),
            None => {
                let mut sums = [0.0; 5];
                for (_, bound) in &piece.parts {
                    let near = bound.nearness(center, radius);
                    let magnitude = bound.magnitude(near);
                    let least = bound.least(center, radius);
                    let third = bound.third(near);
                    let [slope, curvature] = [bound.slope(near), bound.curvature(near)];
                    let own = [slope, curvature, third, magnitude, least];
                    sums = core::array::from_fn(|i| sums[i] + own[i]);
                }
                [most, least] = [sums[3], sums[4]];
                [sums[0], sums[1], sums[2]]
            }
        };
        let steep = DVec3::from_array(jet.gradient).length() * (1.0 + 1e-12);
        let slope = slope.min(steep + curvature * radius);
        let change = steep * radius + 0.5 * curvature * radius * radius;
        let change = change.min(slope * radius) + 1e-12 * jet.value;
        let mut low = (jet.value - change).max(least);
        if leads && low < 0.5 * jet.value {
            let parts = piece.parts.iter();
            let parts = parts.map(|(_, bound)| bound.remains(center, radius));
            low = low.max(jet.value * parts.fold(1.0, f64::min));
        }
        let most = most.min(jet.value + change);
        self.close[slot] = Close {
            low: low.max(0.0),
            most,
            slope,
            curvature,
            third,
        };
        self.jets[slot] = jet;
        self.most[slot] = most;
        self.known[slot] = 2;
    }

    /// Returns the least and the largest weights of pieces, in units of the largest one's scale.
    pub fn weights(&mut self, pieces: &[u32]) -> Vec<[f64; 2]> {
        let mut densest = 0.0f64;
        let ranges: Vec<_> = pieces
            .iter()
            .map(|&piece| {
                let slot = self.slots.of(piece);
                self.look(piece, slot, true);
                let Close { low, most, .. } = self.close[slot];
                let own = self.piece(piece);
                let [low, most] = [low, most].map(|field| field * own.thickness);
                densest = densest.max(most);
                (own.length, [low, most])
            })
            .collect();
        let scale = if densest > 0.0 { densest.recip() } else { 0.0 };
        ranges
            .into_iter()
            .map(|(length, densities)| {
                // Rounding in single precision may make either a little more or less.
                let [low, most] = densities.map(|density| length * power(density * scale));
                [low * 0.99, most * 1.01]
            })
            .collect()
    }

    /// Returns an upper bound on the field of a piece's stretch.
    pub fn most_of(&mut self, piece: u32) -> f64 {
        let mut sum = 0.0;
        for run in self.local.links(piece) {
            let first = self.slots.of(run.first);
            for (i, weight) in self.local.weights(run).iter().enumerate() {
                sum += weight * self.most_at(run.first + i as u32, first + i);
            }
        }
        sum
    }

    /// Returns an upper bound on the field of a stretch whose pieces have been looked at.
    fn recall_most_of(&self, piece: u32) -> f64 {
        let runs = self.local.links(piece).iter();
        let most = runs.flat_map(|run| {
            let most = &self.most[self.slots.of(run.first)..];
            (self.local.weights(run).iter().zip(most)).map(|(weight, most)| weight * most)
        });
        most.sum()
    }

    /// Looks closely at all pieces of a stretch; returns a lower bound on its field.
    fn least_of(&mut self, piece: u32) -> f64 {
        let mut sum = 0.0;
        for run in self.local.links(piece) {
            let first = self.slots.of(run.first);
            for (i, weight) in self.local.weights(run).iter().enumerate() {
                self.look(run.first + i as u32, first + i, false);
                sum += weight * self.close[first + i].low;
            }
        }
        sum
    }

    /// Returns the gradient of the logarithm of a piece's weight at the ball's centre, 0 if the
    /// weight is 0.
    fn rise(&self, slot: usize) -> DVec3 {
        let Jet { value, gradient } = self.jets[slot];
        if value > 0.0 {
            DVec3::from_array(gradient) * (POWER / value)
        } else {
            DVec3::ZERO
        }
    }

    /// Returns bounds on the shares of some pieces with parts of their weights.
    fn enclose_shares(&self, items: &[(u32, f64)]) -> Vec<Share> {
        let slots: Vec<usize> = items
            .iter()
            .map(|(piece, _)| self.slots.of(*piece))
            .collect();
        let parts = items.iter().zip(&slots).map(|((piece, part), slot)| {
            let own = self.piece(*piece);
            let density = self.jets[*slot].value * own.thickness;
            (density, own.length * part)
        });
        let parts: Vec<(f64, f64)> = parts.collect();
        let at_center = shares(&parts);
        let mean: DVec3 = (at_center.iter().zip(&slots))
            .map(|(share, slot)| self.rise(*slot) * *share)
            .sum();
        let densest = items
            .iter()
            .zip(&slots)
            .filter(|((_, part), _)| *part > 0.0);
        let densest = densest
            .map(|((piece, _), slot)| self.close[*slot].most * self.piece(*piece).thickness)
            .fold(0.0, f64::max);
        let weights = items.iter().zip(&slots).map(|((piece, part), slot)| {
            let own = self.piece(*piece);
            let Close { low, most, .. } = self.close[*slot];
            let scale = own.thickness / densest;
            [low, most].map(|field| times(own.length * part, power(field * scale)))
        });
        let weights: Vec<[f64; 2]> = weights.collect();
        let least: f64 = weights.iter().map(|[low, _]| low).sum();
        let radius = self.ball.radius;
        let all = weights.iter().zip(&slots).zip(at_center);
        all.map(|(([low, high], slot), center)| {
            let close = &self.close[*slot];
            let rest = ((least - low) * (1.0 - 1e-12)).max(0.0);
            let most = high / (high + rest);
            if most.is_nan() || *high == 0.0 {
                return Share::default();
            }
            // The share over the field, and over its square: `f⁷/(f⁸+rest)` is at most either.
            let [once, twice] = [close.most, close.most * close.most]
                .map(|field| high / field / rest)
                .map(|over| if over.is_nan() { f64::INFINITY } else { over });
            let once = once.min(most / close.low);
            let twice = twice.min(most / (close.low * close.low));
            let bend = POWER * (close.curvature / close.low + (close.slope / close.low).powi(2));
            let differs = self.rise(*slot).distance(mean) + radius * bend;
            let steep = POWER * once * close.slope;
            let steeper = 2.0 * POWER * POWER * twice * close.slope * close.slope;
            let apart = mean.length();
            Share {
                center,
                most,
                first: (most * differs).min(steep + most * apart),
                second: (most * differs * differs).min(steeper + 2.0 * most * apart * apart),
                turn: POWER * (once * close.curvature + twice * close.slope * close.slope),
            }
        })
        .collect()
    }

    /// Returns the mean of stretches, with factors, by their shares at the centre, and bounds on
    /// their differences from it.
    fn compare(&self, items: &[(u32, f64)], shares: &[Share]) -> (Change, Vec<Change>) {
        let local = self.local;
        let mut weights = vec![0.0; self.jets.len()];
        for ((piece, factor), share) in items.iter().zip(shares).filter(|(_, s)| s.center > 0.0) {
            local.add_stretch((*piece, share.center * factor), self.slots, &mut weights);
        }
        let mut mean = Change::default();
        for (slot, weight) in weights.iter().enumerate().filter(|(_, w)| **w > 0.0) {
            mean.add(*weight, &self.jets[slot], &self.close[slot]);
        }
        let changes = items.iter().zip(shares).map(|((piece, factor), share)| {
            if share.most == 0.0 {
                return Change::default();
            }
            let mut own = Change {
                // What rounding leaves of sums that cancel.
                slope: mean.slope * (1.0 + 1e-12),
                curvature: mean.curvature * (1.0 + 1e-12),
                value: -mean.value,
                gradient: -mean.gradient,
                halves: Halves::default(),
            };
            for run in local.links(*piece) {
                let first = self.slots.of(run.first);
                for (i, weight) in local.weights(run).iter().enumerate() {
                    let slot = first + i;
                    let (weight, before) = (weight * factor, weights[slot]);
                    let (jet, close) = (&self.jets[slot], &self.close[slot]);
                    let more = (weight - before).abs() - before;
                    own.value += weight * jet.value;
                    own.gradient += weight * DVec3::from_array(jet.gradient);
                    own.slope += more * close.slope;
                    own.curvature += more * close.curvature;
                }
            }
            own
        });
        let changes = changes.collect();
        (mean, changes)
    }

    /// Returns value and gradient at the centre of the mean of functions by their shares.
    fn mean_of(
        &self,
        (mean, changes): (&Change, &[Change]),
        items: &[(u32, f64)],
        shares: &[Share],
    ) -> Jet<f64> {
        let mut gradient = mean.gradient;
        for (((piece, _), share), change) in items.iter().zip(shares).zip(changes) {
            if share.center > 0.0 {
                let jet = &self.jets[self.slots.of(*piece)];
                let sharp = POWER * share.center / jet.value * change.value;
                gradient += sharp * DVec3::from_array(jet.gradient);
            }
        }
        Jet {
            value: mean.value,
            gradient: gradient.to_array(),
        }
    }
}

/// Bounds on the share of a piece in a mean.
#[derive(Clone, Copy, Debug, Default)]
struct Share {
    /// The share at the ball's centre.
    center: f64,
    /// The largest share ω̂ in the ball.
    most: f64,
    /// Bounds on ω̂|a|, ω̂a² and ω̂|∇g|.
    first: f64,
    second: f64,
    turn: f64,
}

/// A function's value and gradient at the centre of a ball, and bounds on the gradient and the
/// second derivative of its terms.
#[derive(Clone, Copy, Debug, Default)]
struct Change {
    value: f64,
    gradient: DVec3,
    slope: f64,
    curvature: f64,
    /// Bounds on the two functions that a mean is the sum of.
    halves: Halves,
}

impl Change {
    fn add(&mut self, weight: f64, jet: &Jet<f64>, close: &Close) {
        self.value += weight * jet.value;
        self.gradient += weight * DVec3::from_array(jet.gradient);
        self.slope += weight * close.slope;
        self.curvature += weight * close.curvature;
        self.halves.curvature += weight * close.curvature;
        self.halves.third += weight * close.third;
    }
}

/// Returns a bound, infinity in place of what is no number.
fn or_infinity(bound: f64) -> f64 {
    if bound.is_nan() { f64::INFINITY } else { bound }
}

/// Computes bounds on a mean by shares in a ball: from the mean by the shares at the centre, and
/// the differences of each function from that. The value is that at the centre, give or take.
fn enclose_mean(
    (mean, changes): (&Change, &[Change]),
    shares: &[Share],
    at_center: &Jet<f64>,
    radius: f64,
) -> Bounds {
    let [mut t1, mut t2, mut tg] = [0.0; 3];
    // Sums, and the largest ones, of the differences, their gradients and second derivatives.
    let (mut sums, mut largest) = ([0.0; 3], [0.0f64; 3]);
    let [mut t1b, mut t1g, mut t2b, mut tgb] = [0.0; 4];
    for (share, change) in shares.iter().zip(changes).filter(|(s, _)| s.most > 0.0) {
        let value = change.value.abs() + radius * change.slope;
        let gradient = change.gradient.length() + radius * change.curvature;
        let gradient = gradient.min(change.slope);
        for (i, size) in [value, gradient, change.curvature].into_iter().enumerate() {
            sums[i] += times(share.most, size);
            largest[i] = largest[i].max(size);
        }
        t1 += share.first;
        t2 += share.second;
        tg += share.turn;
        t1b += times(share.first, value);
        t1g += times(share.first, gradient);
        t2b += times(share.second, value);
        tgb += times(share.turn, value);
    }
    let [qb, qg, qc] = [0, 1, 2].map(|i| sums[i].min(largest[i]));
    let ea = t1.min(radius * (tg + t2));
    let eb = qb.min(radius * (qg + t1b + times(t1, qb)));
    let plain = (mean.gradient.length() + radius * mean.curvature).min(mean.slope);
    // Of all but the mean by the shares at the centre.
    let rest = qg + t1b + times(ea, eb);
    let slope = plain + rest;
    let curvature = mean.curvature
        + qc
        + 2.0 * (t1g + times(ea, qg))
        + (tgb + times(tg, eb))
        + (t2b + 2.0 * times(ea, t1b) + times(t2, eb) + 2.0 * times(ea * ea, eb));
    let (slope, curvature) = (or_infinity(slope), or_infinity(curvature) * (1.0 + 1e-9));
    let steep = DVec3::from_array(at_center.gradient).length();
    let slope = slope.min(or_infinity(steep + radius * curvature)) * (1.0 + 1e-9) + LEFT_OUT;
    let change = (slope * radius).min(or_infinity((steep + 0.5 * curvature * radius) * radius));
    let change = change.min(or_infinity(plain * radius + eb)) * (1.0 + 1e-9);
    let change = change + LEFT_OUT * at_center.value.abs();
    Bounds {
        value: [-1.0, 1.0].map(|side| at_center.value + side * change),
        slope,
        curvature,
        jump: 0.0,
        halves: Halves {
            curvature: mean.halves.curvature * (1.0 + 1e-9),
            third: mean.halves.third * (1.0 + 1e-9),
            rest: or_infinity(mean.halves.rest + rest) * (1.0 + 1e-9) + LEFT_OUT,
        },
    }
}

impl Local {
    /// Returns an upper bound on F in a ball.
    pub(super) fn most_in(&self, ball: Ball) -> f64 {
        let is_coarse = ball.radius > COARSE * self.reach();
        let enough = if is_coarse { f64::INFINITY } else { THRESHOLD };
        let all = self.tree.most(&self.pieces, &ball, enough);
        if is_coarse || all < enough {
            return all;
        }
        let terms = self.terms_in(&ball);
        let mut near = Nearby::new(self, ball, &terms);
        let stretches = terms.lead.iter().map(|piece| near.most_of(*piece));
        stretches.fold(0.0, f64::max)
    }

    /// Returns bounds on F and F₂ in a ball.
    #[must_use]
    pub fn enclose_two(&self, ball: Ball) -> Two {
        let is_coarse = ball.radius > COARSE * self.reach();
        let enough = if is_coarse { f64::INFINITY } else { FAINT };
        let all = self.tree.most(&self.pieces, &ball, enough);
        if is_coarse || all < enough {
            let loose = Bounds::loose([0.0, all]);
            return Two {
                first: loose,
                second: self.level.filter(|level| all >= *level).map(|_| loose),
                at_center: None,
            };
        }
        let terms = self.terms_in(&ball);
        let mut near = Nearby::new(self, ball, &terms);
        let weights = near.weights(&terms.lead);
        let floor = weights.iter().map(|[low, _]| *low).fold(0.0, f64::max) * CUT;
        // The others count as 0 everywhere in the ball.
        let counted = terms.lead.iter().zip(weights);
        let items: Vec<(u32, f64)> = counted
            .filter(|(_, [_, most])| *most >= floor)
            .map(|(piece, _)| (*piece, 1.0))
            .collect();
        let mut range = [f64::INFINITY, 0.0];
        for (piece, _) in &items {
            range[0] = range[0].min(near.least_of(*piece));
            range[1] = range[1].max(near.most_of(*piece));
        }
        range[0] = if range[0].is_finite() { range[0] } else { 0.0 };
        let shares = near.enclose_shares(&items);
        let (mean, changes) = near.compare(&items, &shares);
        let jet = near.mean_of((&mean, &changes), &items, &shares);
        let mut first = enclose_mean((&mean, &changes), &shares, &jet, ball.radius);
        let margin = LEFT_OUT * range[1];
        first.value = [
            first.value[0].max(range[0] - margin),
            first.value[1].min(range[1] + margin),
        ];
        let second = (terms.far.as_ref()).and_then(|far| {
            let rows = far.rows(self, &terms.lead);
            self.enclose_second((far, rows), &terms.lead, &mut near, (&items, &shares))
        });
        let level = self.level.unwrap_or(f64::INFINITY);
        Two {
            first,
            at_center: Some((jet, second.map(|(_, jet)| jet))),
            second: second
                .map(|(bounds, _)| bounds)
                .filter(|bounds| bounds.value[1] >= level),
        }
    }

    /// Computes bounds on F₂, and its value and gradient at the centre, from the shares of those
    /// that lead and count; `None` if it is nowhere above its level.
    fn enclose_second(
        &self,
        (far, rows): (&Far, &Rows),
        lead: &[u32],
        near: &mut Nearby,
        (items, shares): (&[(u32, f64)], &[Share]),
    ) -> Option<(Bounds, Jet<f64>)> {
        let (radius, level) = (near.ball.radius, self.level?);
        let weights = near.weights(&far.pieces);
        for piece in &far.pieces {
            near.least_of(*piece);
        }
        let most = far.pieces.iter().map(|piece| near.recall_most_of(*piece));
        let most: Vec<f64> = most.collect();
        let mut high = 0.0f64;
        // Far pieces of each row that count somewhere in the ball. Rows that differ in no others
        // are one class. The first one has none: from there F₂ⱼ is below half of the level.
        let mut groups: Vec<Vec<(u32, f64)>> = vec![Vec::new()];
        let mut known: Vec<Option<usize>> = vec![None; rows.count()];
        let mut leading = lead.iter().zip(&rows.classes);
        let classes = items.iter().map(|(piece, _)| {
            let found = leading.find(|(lead, _)| *lead == piece);
            let number = found.map_or(rows.count(), |(_, class)| rows.number(*class));
            let Some(known) = known.get_mut(number) else {
                return 0;
            };
            *known.get_or_insert_with(|| {
                let row = rows.row(number).iter().zip(&weights);
                let floor = row.clone().map(|(apart, [low, _])| apart * low);
                let floor = floor.fold(0.0, f64::max) * CUT;
                let (mut group, mut top) = (Vec::new(), 0.0f64);
                for ((piece, most), (apart, [_, weight])) in far.pieces.iter().zip(&most).zip(row) {
                    if *apart > 0.0 && apart * weight >= floor {
                        group.push((*piece, *apart));
                        top = top.max(apart * most);
                    }
                }
                if top * (1.0 + LEFT_OUT) <= 0.5 * level {
                    return 0;
                }
                high = high.max(top);
                let same = groups.iter().position(|other| *other == group);
                same.unwrap_or_else(|| {
                    groups.push(group);
                    groups.len() - 1
                })
            })
        });
        let classes: Vec<usize> = classes.collect();
        if high * (1.0 + LEFT_OUT) < level {
            return None;
        }
        let mut totals = vec![(0.0, 0.0); groups.len()];
        for (class, share) in classes.iter().zip(shares) {
            let (center, most) = &mut totals[*class];
            *center += share.center;
            *most += share.most;
        }
        // The mean by the shares at the centre of the means of all classes.
        let mut mean = Change::default();
        let means = totals.iter().zip(&groups).map(|((center, total), items)| {
            if *total == 0.0 || items.is_empty() {
                return Change::default();
            }
            let shares = near.enclose_shares(items);
            let (own, changes) = near.compare(items, &shares);
            let jet = near.mean_of((&own, &changes), items, &shares);
            let Bounds {
                value: [low, most],
                slope,
                curvature,
                halves,
                ..
            } = enclose_mean((&own, &changes), &shares, &jet, radius);
            // Bounds on the derivatives of the ramp.
            let [once, twice] = match level {
                level if low >= level => [1.0, 0.0],
                level if most <= 0.5 * level => [0.0; 2],
                level => [4.0, 30.0 / level],
            };
            let (value, steep) = ramp(jet.value, level);
            let own = Change {
                value,
                gradient: steep * DVec3::from_array(jet.gradient),
                slope: times(once, slope),
                curvature: times(once, curvature) + times(twice, slope * slope),
                halves: Halves {
                    curvature: times(twice, slope * slope),
                    ..Halves::default()
                }
                .plus(once, &halves),
            };
            mean.value += center * own.value;
            mean.gradient += *center * own.gradient;
            mean.slope += times(*center, own.slope);
            mean.curvature += times(*center, own.curvature);
            mean.halves = mean.halves.plus(*center, &own.halves);
            own
        });
        let means: Vec<Change> = means.collect();
        let is_one = totals.iter().filter(|(_, total)| *total > 0.0).count() < 2;
        let changes = classes.iter().map(|class| {
            let own = &means[*class];
            if is_one {
                return Change::default();
            }
            Change {
                value: own.value - mean.value,
                gradient: own.gradient - mean.gradient,
                slope: own.slope + mean.slope,
                curvature: own.curvature + mean.curvature,
                halves: Halves::default(),
            }
        });
        let changes: Vec<Change> = changes.collect();
        let jet = near.mean_of((&mean, &changes), items, shares);
        let mut bounds = enclose_mean((&mean, &changes), shares, &jet, radius);
        let margin = LEFT_OUT * high;
        bounds.value = [bounds.value[0].max(0.0), bounds.value[1].min(high) + margin];
        Some((bounds, jet))
    }
}
