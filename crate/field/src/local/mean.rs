//! The fields at a point: weighted means of the fields of stretches.
use super::cells::{Far, Slots, Terms};
use super::{Local, Piece};
use crate::term::Evaluate;
use crate::{Ball, Jet, Real, THRESHOLD};
use glam::DVec3;

/// The power of a piece's density in its weight: three squarings.
pub(super) const POWER: f64 = 8.0;
/// Part of the largest weight below which weights count as 0, 2⁻⁴⁰.
pub(super) const CUT: f64 = 1.0 / (1u64 << 40) as f64;
/// Density below which nothing counts.
const FAINTEST: f64 = 1e-30;

/// Returns x⁸.
pub(super) fn power<R: Real>(x: R) -> R {
    x.square().square().square()
}

/// Computes the shares `ω/Σω` of weights `part·density⁸`, given as pairs of density and part.
pub(super) fn shares<R: Real>(all: &[(R, f64)]) -> Vec<R> {
    let [zero, one] = [0.0, 1.0].map(R::splat);
    let counted = all.iter().filter(|(_, part)| *part > 0.0);
    let densest = counted.fold(zero, |most, (density, _)| most.max(*density));
    let is_any = R::splat(FAINTEST).lt(densest);
    let scale = R::select(is_any, one / densest, zero);
    let mut weights: Vec<R> = all
        .iter()
        .map(|(density, part)| match *part > 0.0 {
            true => R::splat(*part) * power(*density * scale),
            false => zero,
        })
        .collect();
    let largest = weights.iter().fold(zero, |most, weight| most.max(*weight));
    let least = largest * R::splat(CUT);
    let mut sum = zero;
    for weight in &mut weights {
        *weight = R::select(weight.lt(least), zero, *weight);
        sum = sum + *weight;
    }
    let scale = R::select(zero.lt(sum), one / sum, zero);
    for weight in &mut weights {
        *weight = *weight * scale;
    }
    weights
}

/// The mean of stretches at a point, and factors on the gradients of all pieces in its gradient.
struct Mean<R> {
    value: R,
    factors: Vec<R>,
}

impl<R: Real> Mean<R> {
    fn jet(&self, jets: &[Jet<R>]) -> Jet<R> {
        let mut sum = Jet::zero();
        for (factor, jet) in self.factors.iter().zip(jets) {
            for (own, gradient) in sum.gradient.iter_mut().zip(jet.gradient) {
                *own = *own + *factor * gradient;
            }
        }
        Jet {
            value: self.value,
            ..sum
        }
    }
}

/// Computes a far field without what is of no interest, and its slope: 0 up to half of a level,
/// x from the level on, and `x·(3t² − 2t³)`, t = 2x/level − 1, between.
pub(super) fn ramp<R: Real>(x: R, level: f64) -> (R, R) {
    let [zero, one] = [0.0, 1.0].map(R::splat);
    let rate = 2.0 / level;
    let t = (R::splat(rate) * x - one).max(zero).min(one);
    let part = t * t * (R::splat(3.0) - t - t);
    let slope = R::splat(6.0 * rate) * t * (one - t);
    (x * part, part + x * slope)
}

/// Whether a share is above 0 at any of some points.
fn counts<R: Real>(share: R) -> bool {
    R::any(R::splat(0.0).lt(share))
}

/// Computes `8·share/f`, 0 where nothing is shared.
fn sharpness<R: Real>(share: R, field: R) -> R {
    let zero = R::splat(0.0);
    R::select(zero.lt(share), R::splat(POWER) * share / field, zero)
}

impl Local {
    /// Computes the field of the stretch around a piece.
    pub(super) fn stretch<R: Real>(&self, piece: u32, slots: &Slots, jets: &[Jet<R>]) -> R {
        let mut sum = R::splat(0.0);
        for run in self.links(piece) {
            let jets = &jets[slots.of(run.first)..];
            for (weight, jet) in self.weights(run).iter().zip(jets) {
                sum = sum + R::splat(*weight) * jet.value;
            }
        }
        sum
    }

    /// Adds a multiple of a stretch's weights to factors of its pieces.
    pub(super) fn add_stretch<R: Real>(
        &self,
        (piece, times): (u32, R),
        slots: &Slots,
        factors: &mut [R],
    ) {
        for run in self.links(piece) {
            let factors = &mut factors[slots.of(run.first)..];
            for (weight, factor) in self.weights(run).iter().zip(factors) {
                *factor = *factor + R::splat(*weight) * times;
            }
        }
    }

    /// Returns densities of pieces, `r·f/l`, with their lengths as parts.
    pub(super) fn densities<R: Real>(
        &self,
        pieces: &[u32],
        slots: &Slots,
        jets: &[Jet<R>],
    ) -> Vec<(R, f64)> {
        let all = pieces.iter().map(|piece| {
            let Piece {
                length, thickness, ..
            } = self.pieces[*piece as usize];
            (jets[slots.of(*piece)].value * R::splat(thickness), length)
        });
        all.collect()
    }

    /// Computes F and F₂ from some terms.
    pub(super) fn two_of<R: Evaluate>(
        &self,
        terms: &Terms,
        point: [R; 3],
    ) -> (Jet<R>, Option<Jet<R>>) {
        let pieces = terms.slots.pieces();
        let jets: Vec<Jet<R>> = pieces
            .map(|piece| self.pieces[piece as usize].jet(point))
            .collect();
        let shares = shares(&self.densities(&terms.lead, &terms.slots, &jets));
        let first = self.first(terms, &shares, &jets).jet(&jets);
        let far = terms.far.as_ref();
        let second = far.map(|far| self.second(terms, far, &shares, &jets).jet(&jets));
        (first, second)
    }

    /// Returns the change of the gradient over a step along each axis from a ball's centre, of the
    /// mean of stretches by their shares at the centre.
    pub(super) fn turn_mean(&self, ball: Ball, step: f64) -> [DVec3; 3] {
        let Ball { center, .. } = ball;
        let terms = self.terms_in(&ball);
        let pieces = terms.slots.pieces();
        let pieces: Vec<&Piece> = pieces.map(|piece| &self.pieces[piece as usize]).collect();
        let jets = pieces.iter().map(|piece| piece.jet(center.to_array()));
        let jets: Vec<Jet<f64>> = jets.collect();
        let shares = shares(&self.densities(&terms.lead, &terms.slots, &jets));
        let mut factors = vec![0.0; jets.len()];
        for (piece, share) in terms.lead.iter().zip(shares) {
            self.add_stretch((*piece, share), &terms.slots, &mut factors);
        }
        DVec3::AXES.map(|axis| {
            let beside = (center + axis * step).to_array();
            let all = pieces.iter().zip(&factors).zip(&jets);
            all.filter(|((_, factor), _)| **factor > 0.0)
                .map(|((piece, factor), jet)| {
                    let beside = DVec3::from_array(piece.jet(beside).gradient);
                    (beside - DVec3::from_array(jet.gradient)) * *factor
                })
                .sum()
        })
    }

    fn first<R: Real>(&self, terms: &Terms, shares: &[R], jets: &[Jet<R>]) -> Mean<R> {
        let (slots, zero) = (&terms.slots, R::splat(0.0));
        let mut value = zero;
        let mut stretches = vec![zero; shares.len()];
        let all = terms.lead.iter().zip(shares).zip(&mut stretches);
        for ((piece, share), stretch) in all.filter(|((_, share), _)| counts(**share)) {
            *stretch = self.stretch(*piece, slots, jets);
            value = value + *share * *stretch;
        }
        let mut factors = vec![zero; jets.len()];
        let all = terms.lead.iter().zip(shares).zip(&stretches);
        for ((piece, share), stretch) in all.filter(|((_, share), _)| counts(**share)) {
            self.add_stretch((*piece, *share), slots, &mut factors);
            let own = slots.of(*piece);
            let sharp = sharpness(*share, jets[own].value);
            factors[own] = factors[own] + sharp * (*stretch - value);
        }
        Mean { value, factors }
    }

    fn second<R: Real>(
        &self,
        terms: &Terms,
        far: &Far,
        shares_of_lead: &[R],
        jets: &[Jet<R>],
    ) -> Mean<R> {
        let (slots, zero) = (&terms.slots, R::splat(0.0));
        let densities = self.densities(&far.pieces, slots, jets);
        let rows = far.rows(self, &terms.lead);
        let mut stretches: Vec<Option<R>> = vec![None; far.pieces.len()];
        // The mean of each class, and the sum of the shares of those that are of it.
        let mut classes: Vec<(R, R)> = vec![(zero, zero); rows.count() + 1];
        for (class, share) in rows.classes.iter().zip(shares_of_lead) {
            let sum = &mut classes[rows.number(*class)].1;
            *sum = *sum + *share;
        }
        let mut value = zero;
        let mut factors = vec![zero; jets.len()];
        let level = self.level.unwrap_or(THRESHOLD);
        for (number, (ramped, total)) in classes.iter_mut().enumerate().take(rows.count()) {
            if !R::any(zero.lt(*total)) {
                continue;
            }
            let row = rows.row(number);
            let parts: Vec<(R, f64)> = densities
                .iter()
                .zip(row)
                .map(|((density, length), apart)| (*density, length * apart))
                .collect();
            let shares = shares(&parts);
            let mut mean = zero;
            let all = far.pieces.iter().zip(&shares).zip(&mut stretches).zip(row);
            for (((piece, share), stretch), apart) in all.filter(|(((_, s), _), _)| counts(**s)) {
                let own = *stretch.get_or_insert_with(|| self.stretch(*piece, slots, jets));
                mean = mean + *share * (R::splat(*apart) * own);
            }
            let (own, slope) = ramp(mean, level);
            *ramped = own;
            value = value + *total * own;
            let times = *total * slope;
            let all = far.pieces.iter().zip(&shares).zip(&stretches).zip(row);
            for (((piece, share), stretch), apart) in all {
                let Some(stretch) = stretch.filter(|_| counts(*share)) else {
                    continue;
                };
                let (own, apart) = (slots.of(*piece), R::splat(*apart));
                self.add_stretch((*piece, times * *share * apart), slots, &mut factors);
                let sharp = sharpness(*share, jets[own].value);
                factors[own] = factors[own] + times * (sharp * (apart * stretch - mean));
            }
        }
        let all = terms.lead.iter().zip(shares_of_lead).zip(&rows.classes);
        for ((piece, share), class) in all {
            let own = slots.of(*piece);
            let sharp = sharpness(*share, jets[own].value);
            factors[own] = factors[own] + sharp * (classes[rows.number(*class)].0 - value);
        }
        Mean { value, factors }
    }
}
