//! An octree of space: which terms may lead in a cell. Cells are made at first use and kept.
use super::survey::Survey;
use super::{FAINT, Local};
use crate::Ball;
use glam::DVec3;
use std::sync::{Arc, OnceLock};

/// Half side, as a part of the reach, from which on cells are not halved.
const FINEST: f64 = 1.0 / 24.0;
/// Largest number of halvings.
const DEEPEST: u32 = 10;
/// Half side, as a part of the reach, above which nearly everything matters in a cell.
const COARSE: f64 = 0.8;

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
    /// Terms that matter; `None` if they are those of the cell that this is a part of.
    terms: Option<Terms>,
    parts: [OnceLock<Box<Cell>>; 8],
}

/// Terms that matter in a ball around a cell, as large as one and a bit cells.
#[derive(Clone, Debug)]
struct Terms {
    /// Terms that may lead.
    first: Arc<[u32]>,
    /// Terms that may lead, and all others whose field may be [`FAINT`] or more.
    both: Arc<[u32]>,
}

impl Cells {
    /// Cells around the points of a skeleton.
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
}

impl Local {
    /// Returns the terms that may lead somewhere in a ball; with `both` also those that may be
    /// above [`FAINT`] there.
    pub(super) fn terms_in(&self, ball: &Ball, both: bool) -> &[u32] {
        let (mut center, mut half) = (self.cells.center, self.cells.half);
        let mut terms: Option<&Terms> = None;
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
                Box::new(Cell {
                    terms: self.choose(terms, center, half),
                    parts: Default::default(),
                })
            });
            terms = cell.terms.as_ref().or(terms);
        }
        match terms {
            None => &self.terms,
            Some(terms) if both => &terms.both,
            Some(terms) => &terms.first,
        }
    }

    /// Returns the terms that matter around a cell, among those of a larger one; `None` if these
    /// are all.
    fn choose(&self, among: Option<&Terms>, center: DVec3, half: f64) -> Option<Terms> {
        if half > COARSE * self.reach() {
            return None;
        }
        // A ball of half a side about any point of the cell is in this one.
        let ball = Ball {
            center,
            radius: half * 2.75,
        };
        let before = among.map_or(&self.terms[..], |terms| &terms.both);
        if before.len() < 2 {
            return None;
        }
        let mut survey = Survey::new(self, ball, before);
        let floor = survey.floor();
        let of = |terms: Vec<u32>, before: &Arc<[u32]>| match terms.len() == before.len() {
            true => Arc::clone(before),
            false => Arc::from(terms),
        };
        let first = survey.terms_above(floor);
        let both = survey.terms_above(floor.min(FAINT));
        Some(match among {
            Some(among) => Terms {
                first: of(first, &among.first),
                both: of(both, &among.both),
            },
            None => Terms {
                first: Arc::from(first),
                both: Arc::from(both),
            },
        })
    }
}
