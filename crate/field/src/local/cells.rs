//! An octree of space: which pieces count in a cell. Cells are made at first use and kept.
use super::bounds::Nearby;
use super::mean::CUT;
use super::{Local, Run};
use crate::Ball;
use glam::DVec3;
use std::sync::{Arc, OnceLock};

/// Half side, as a part of the reach, from which on cells are not halved.
const FINEST: f64 = 1.0 / 24.0;
/// Largest number of halvings.
const DEEPEST: u32 = 10;
/// Half side, as a part of the reach, above which nearly everything matters in a cell.
const COARSE: f64 = 0.8;
/// Distance of a piece from a ball, in the ball's radii, from which on bounds on its derivatives
/// are about the same in all smaller ones.
const FAR_AWAY: f64 = 5.0;
/// Most pairs of pieces that are looked at one by one.
const MOST_PAIRS: usize = 1 << 16;

/// A cube of space, cut into cells.
#[derive(Clone, Debug)]
pub(super) struct Cells {
    center: DVec3,
    half: f64,
    depth: u32,
    root: Cell,
}

#[derive(Clone, Debug, Default)]
struct Cell {
    /// Terms that matter; `None` if there are none of its own.
    terms: Option<Arc<Terms>>,
    parts: [OnceLock<Box<Cell>>; 8],
}

/// Pieces that matter in a ball.
#[derive(Clone, Debug)]
pub(super) struct Terms {
    /// Pieces with a weight in F.
    pub lead: Vec<u32>,
    /// Pieces of all stretches around pieces that have a weight in F or F₂.
    pub slots: Slots,
    /// Bounds on the first three derivatives in all of the ball, of pieces that are far away from
    /// it.
    pub calm: Vec<Option<[f32; 3]>>,
    /// Pieces with a weight in F₂, if it may be above its level.
    pub far: Option<Far>,
}

/// Pieces that are far from some of those that lead.
#[derive(Clone, Debug)]
pub(super) struct Far {
    pub pieces: Vec<u32>,
    /// Leading pieces from which another fold may be above half of the level.
    from: Vec<u32>,
    rows: OnceLock<Rows>,
}

/// Weights of far pieces as other folds, one row for each leading piece. Many have the same row.
#[derive(Clone, Debug, Default)]
pub(super) struct Rows {
    width: usize,
    values: Vec<f64>,
    /// The number of the row of each that leads; more than any if it has none.
    pub classes: Vec<u32>,
}

impl Rows {
    /// Returns the number of different rows.
    pub fn count(&self) -> usize {
        self.values.len() / self.width
    }

    /// Returns the number of a class, which for those without a row is the number of rows.
    pub fn number(&self, class: u32) -> usize {
        (class as usize).min(self.count())
    }

    pub fn row(&self, number: usize) -> &[f64] {
        &self.values[number * self.width..][..self.width]
    }
}

impl Far {
    /// Returns the rows of those that lead.
    pub fn rows(&self, local: &Local, lead: &[u32]) -> &Rows {
        self.rows.get_or_init(|| {
            let mut rows = Rows {
                width: self.pieces.len(),
                ..Rows::default()
            };
            for piece in lead {
                if self.from.binary_search(piece).is_err() {
                    rows.classes.push(u32::MAX);
                    continue;
                }
                let row: Vec<f64> = local.apart(*piece, &self.pieces).collect();
                let known = (0..rows.count()).find(|i| rows.row(*i) == row);
                rows.classes
                    .push(known.unwrap_or_else(|| rows.count()) as u32);
                if known.is_none() {
                    rows.values.extend(row);
                }
            }
            rows
        })
    }
}

/// Places of pieces that are evaluated together: runs of their numbers, in ascending order.
#[derive(Clone, Debug, Default)]
pub(super) struct Slots {
    /// Number of the first piece and of the piece behind the last, and the slot of the first.
    runs: Vec<[u32; 3]>,
}

impl Slots {
    /// Makes slots for runs of pieces, which may overlap.
    fn new(mut all: Vec<[u32; 2]>) -> Self {
        all.sort_unstable();
        let mut runs: Vec<[u32; 3]> = Vec::new();
        for [first, end] in all {
            match runs.last_mut() {
                Some(last) if first <= last[1] => last[1] = last[1].max(end),
                last => {
                    let slot = last.map_or(0, |last| last[2] + last[1] - last[0]);
                    runs.push([first, end, slot]);
                }
            }
        }
        Self { runs }
    }

    /// Returns the slot of a piece that has one.
    pub fn of(&self, piece: u32) -> usize {
        let behind = self.runs.partition_point(|run| run[0] <= piece);
        let [first, _, slot] = self.runs[behind - 1];
        (piece - first + slot) as usize
    }

    /// Returns all pieces, in the order of their slots.
    pub fn pieces(&self) -> impl Iterator<Item = u32> + '_ {
        self.runs.iter().flat_map(|[first, end, _]| *first..*end)
    }

    pub fn count(&self) -> usize {
        self.runs
            .last()
            .map_or(0, |[first, end, slot]| (slot + end - first) as usize)
    }
}

impl Cells {
    /// Makes cells around the points of a skeleton.
    pub fn new(points: &[DVec3], reach: f64) -> Self {
        let low = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let high = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
        let half = 0.5 * (high - low).max_element() + reach;
        let depth = (0..DEEPEST)
            .find(|depth| half * f64::from(1u32 << depth).recip() < FINEST * reach)
            .unwrap_or(DEEPEST);
        Self {
            center: 0.5 * (low + high),
            half,
            depth,
            root: Cell::default(),
        }
    }

    /// Forgets all cells.
    pub fn clear(&mut self) {
        self.root = Cell::default();
    }
}

impl Local {
    /// Returns the terms that matter in a ball.
    pub(super) fn terms_in(&self, ball: &Ball) -> Arc<Terms> {
        let (mut center, mut half) = (self.cells.center, self.cells.half);
        let mut terms: Option<&Arc<Terms>> = None;
        let mut cell = &self.cells.root;
        let is_inside = (ball.center - center).abs().max_element() <= half;
        for _ in 0..if is_inside { self.cells.depth } else { 0 } {
            half *= 0.5;
            if ball.radius > half {
                break;
            }
            let above = ball.center.cmpge(center);
            let part = above.bitmask() as usize;
            center += DVec3::select(above, DVec3::splat(half), DVec3::splat(-half));
            cell = cell.parts[part].get_or_init(|| {
                let is_coarse = half > COARSE * self.reach();
                // A ball of half a side about any point of the cell is in this one.
                let ball = Ball {
                    center,
                    radius: half * 2.75,
                };
                Box::new(Cell {
                    terms: (!is_coarse).then(|| self.choose(terms, ball)),
                    parts: Default::default(),
                })
            });
            terms = cell.terms.as_ref();
        }
        match terms {
            Some(terms) => Arc::clone(terms),
            None => self.choose(None, *ball),
        }
    }

    /// Returns the terms that matter in a ball, among those of a larger one.
    fn choose(&self, among: Option<&Arc<Terms>>, ball: Ball) -> Arc<Terms> {
        let all: Terms;
        let terms = match among {
            Some(terms) => &**terms,
            None => {
                all = self.all_terms();
                &all
            }
        };
        let before = &terms.lead;
        let mut near = Nearby::new(self, ball, terms);
        let weights = near.weights(before);
        let floor = weights.iter().map(|[low, _]| *low).fold(0.0, f64::max) * CUT;
        let lead = before.iter().zip(&weights);
        let lead: Vec<u32> = lead
            .filter(|(_, [_, most])| *most >= floor)
            .map(|(piece, _)| *piece)
            .collect();
        let far = self
            .level
            .and_then(|level| {
                match among {
                    Some(terms) => terms.far.as_ref().map(|far| far.pieces.clone()),
                    None => Some(before.clone()),
                }
                .map(|pieces| self.choose_far(pieces, &lead, &mut near, level))
            })
            .filter(|(pieces, _)| !pieces.is_empty());
        let runs = (lead.iter().chain(far.iter().flat_map(|far| &far.0)))
            .flat_map(|piece| self.links(*piece))
            .map(|Run { first, count, .. }| [*first, first + count]);
        let slots = Slots::new(runs.collect());
        Arc::new(Terms {
            calm: self.find_calm(&slots, &ball),
            slots,
            lead,
            far: far.map(|(pieces, from)| Far {
                pieces,
                from,
                rows: OnceLock::new(),
            }),
        })
    }

    /// Returns terms of all pieces, of which no more is known.
    fn all_terms(&self) -> Terms {
        let count = self.pieces.len() as u32;
        Terms {
            lead: (0..count).collect(),
            slots: Slots::new(vec![[0, count]]),
            calm: vec![None; count as usize],
            far: None,
        }
    }

    /// Returns bounds on the first three derivatives in a ball of pieces that are far away from it.
    fn find_calm(&self, slots: &Slots, ball: &Ball) -> Vec<Option<[f32; 3]>> {
        let calm = slots.pieces().map(|piece| {
            let mut sum = [0.0; 3];
            for (_, bound) in &self.pieces[piece as usize].parts {
                let near = bound.nearness(ball.center, ball.radius);
                if near.distance < FAR_AWAY * ball.radius {
                    return None;
                }
                sum[0] += bound.slope(near);
                sum[1] += bound.curvature(near);
                sum[2] += bound.third(near);
            }
            Some(sum.map(|x| (x * (1.0 + 1e-6)) as f32 + f32::MIN_POSITIVE))
        });
        calm.collect()
    }

    /// Returns those of some pieces that have a weight in F₂, and those of the leading ones from
    /// which F₂ⱼ may be above half of its level; none if none is.
    fn choose_far(
        &self,
        mut pieces: Vec<u32>,
        lead: &[u32],
        near: &mut Nearby,
        level: f64,
    ) -> (Vec<u32>, Vec<u32>) {
        if lead.len() * pieces.len() > MOST_PAIRS {
            return (pieces, lead.to_vec());
        }
        let most: Vec<f64> = pieces.iter().map(|piece| near.most_of(*piece)).collect();
        let weights = near.weights(&pieces);
        let mut from = Vec::new();
        let mut matters = vec![false; pieces.len()];
        // Many of those that lead are as far from all.
        let mut before: (Vec<f64>, bool) = (Vec::new(), false);
        for own in lead {
            let parts: Vec<f64> = self.apart(*own, &pieces).collect();
            if parts == before.0 {
                from.extend(before.1.then_some(*own));
                continue;
            }
            let fields = parts.iter().zip(&most).map(|(apart, most)| apart * most);
            let presses = fields.fold(0.0, f64::max) >= 0.49 * level;
            if presses {
                let weights = parts.iter().zip(&weights);
                let floor = weights.clone().map(|(apart, [low, _])| apart * low);
                let floor = floor.fold(0.0, f64::max) * CUT;
                for (matters, (apart, [_, most])) in matters.iter_mut().zip(weights) {
                    *matters |= *apart > 0.0 && apart * most >= floor;
                }
            }
            from.extend(presses.then_some(*own));
            before = (parts, presses);
        }
        let mut matters = matters.into_iter();
        pieces.retain(|_| matters.next().unwrap_or(true));
        (pieces, from)
    }

    /// Returns how much some pieces, in ascending order, count as another fold beside a piece.
    fn apart<'a>(&'a self, piece: u32, others: &'a [u32]) -> impl Iterator<Item = f64> + 'a {
        let range = &self.pieces[piece as usize].near;
        let mut near = self.near[range.start as usize..range.end as usize].iter();
        let mut next = near.next();
        others.iter().map(move |other| {
            while next.is_some_and(|(number, _)| number < other) {
                next = near.next();
            }
            match next {
                Some((number, apart)) if number == other => *apart,
                _ => 1.0,
            }
        })
    }
}
