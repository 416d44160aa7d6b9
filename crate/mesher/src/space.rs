//! A function with its terms sorted by place, so that evaluations cost what is nearby.

use core::sync::atomic::{AtomicU64, Ordering};
use field::{Ball, Implicit, Jet, Logarithm, Part, Slack, THRESHOLD, Variation};
use glam::DVec3;
use wide::f32x8;

use crate::forest::{Cell, Forest, NONE};
use crate::lattice::Lattice;
use crate::options::{MeshError, Progress};
use crate::parallel::map_told;
use crate::patches::Patches;

/// Bound on the sum of terms that are left out at a place, in units of the threshold.
pub const SLACK: f64 = 1e-7;

/// Error of a polynomial that may stand for far terms, in units of the threshold, over the
/// tolerance as a part of the surface's size: where the function falls by the threshold along the
/// whole surface or on a shorter way, it moves no point by more than a fifth of the tolerance, and
/// mostly by far less.
const BORNE: f64 = 0.2;

/// Largest coordinates at which single precision tells places apart, over the tolerance: some
/// hundred roundings of 2⁻²⁴.
const SINGLE: f64 = 1e-5;

/// Least size of terms, in thresholds, at which the widths of their kernels matter.
const MATTERS: f64 = 0.05;

/// Parts with fewer terms are not divided further.
const FEW_TERMS: usize = 4;

/// A part, and that of a larger ball which it was chosen from.
#[derive(Debug)]
struct Nested {
    part: Part,
    parent: u32,
}

/// A function in a forest of cells.
#[derive(Debug)]
pub struct Space<'a> {
    function: &'a dyn Implicit,
    /// The function's logarithm, which is looked at in its place where it has sharper bounds.
    logarithm: Option<Logarithm<'a>>,
    /// The cells.
    pub forest: Forest,
    /// Whether all terms of the function are known to add to it.
    pub only_adds: bool,
    parts: Vec<Nested>,
    /// Largest error of polynomials that stand for far terms.
    far: f64,
    /// The largest errors of values and gradients in any part, beyond what is left out.
    worst: [f64; 2],
    evaluations: AtomicU64,
    patches: Patches,
}

impl<'a> Space<'a> {
    /// A function in a forest of which nothing is known yet, for a tolerance as a part of the
    /// surface's size.
    pub fn new(function: &'a dyn Implicit, forest: Forest, tolerance: f64) -> Self {
        Self {
            function,
            logarithm: function.logarithm(),
            forest,
            only_adds: false,
            parts: Vec::new(),
            far: BORNE * tolerance,
            worst: [0.0; 2],
            evaluations: AtomicU64::new(0),
            patches: Patches::default(),
        }
    }

    /// Whether the function's logarithm, not itself, tells where it may fall below the threshold.
    pub fn is_logarithmic_inside(&self) -> bool {
        self.only_adds && self.logarithm.is_none()
    }

    fn part(&self, part: u32) -> Option<&Part> {
        self.parts.get(part as usize).map(|nested| &nested.part)
    }

    /// Value and gradient at a point of the ball of a part.
    pub fn jet(&self, part: u32, point: DVec3) -> Jet<f64> {
        self.evaluations.fetch_add(1, Ordering::Relaxed);
        let jet = match self.part(part) {
            Some(part) => self.function.jet_of(part, point),
            None => self.function.jet(point),
        };
        match self.logarithm {
            Some(_) => Logarithm::of(&jet),
            None => jet,
        }
    }

    /// Value and gradient at eight points of the ball of a part, in single precision where that is
    /// enough for places within a tolerance.
    pub fn jets(&self, part: u32, points: &[DVec3; 8], tolerance: f64) -> [Jet<f64>; 8] {
        let largest = points.iter().map(|p| p.abs().max_element());
        // Not so for NaN.
        let is_near = largest.fold(0.0, f64::max) * SINGLE <= tolerance;
        if !is_near {
            return points.map(|point| self.jet(part, point));
        }
        self.evaluations.fetch_add(8, Ordering::Relaxed);
        let lanes = [0, 1, 2].map(|axis| f32x8::new(points.map(|p| p[axis] as f32)));
        let jet = match self.part(part) {
            Some(part) => self.function.jet8_of(part, lanes),
            None => self.function.jet8(lanes),
        };
        let value = jet.value.to_array();
        let gradient = jet.gradient.map(|slope| slope.to_array());
        core::array::from_fn(|i| {
            let jet = Jet {
                value: f64::from(value[i]),
                gradient: gradient.map(|slope| f64::from(slope[i])),
            };
            match self.logarithm {
                Some(_) => Logarithm::of(&jet),
                None => jet,
            }
        })
    }

    /// Value and gradient at many points, each in the ball of a part: [`Space::jets`] of those that
    /// have the same part.
    ///
    /// # Errors
    /// If the caller cancels.
    pub fn jets_in_parts(
        &self,
        places: &[(u32, DVec3)],
        tolerance: f64,
        threads: usize,
        progress: &mut Progress<'_>,
    ) -> Result<Vec<Jet<f64>>, MeshError> {
        let mut order: Vec<u32> = (0..places.len() as u32).collect();
        order.sort_by_key(|i| places[*i as usize].0);
        let same = order.chunk_by(|i, j| places[*i as usize].0 == places[*j as usize].0);
        let eights: Vec<&[u32]> = same.flat_map(|same| same.chunks(8)).collect();
        let found = map_told(threads, &eights, progress, |eight| {
            let points = core::array::from_fn(|k| places[eight[k.min(eight.len() - 1)] as usize].1);
            self.jets(places[eight[0] as usize].0, &points, tolerance)
        })?;
        let mut jets = vec![Jet::zero(); places.len()];
        for (eight, found) in eights.iter().zip(found) {
            for (i, jet) in eight.iter().zip(found) {
                jets[*i as usize] = jet;
            }
        }
        Ok(jets)
    }

    /// Bounds in a ball within that of a part.
    pub fn variation(&self, part: u32, ball: Ball) -> Variation {
        self.evaluations.fetch_add(1, Ordering::Relaxed);
        match &self.logarithm {
            Some(logarithm) => logarithm.variation(self.part(part), ball),
            None => self.function.variation(self.part(part), ball),
        }
    }

    /// Returns the least width of a kernel that matters in a ball within that of a part; 0 if it is
    /// not known.
    pub fn least_width(&self, part: u32, ball: Ball) -> f64 {
        let enough = MATTERS * THRESHOLD;
        let width = self.function.least_width(self.part(part), ball, enough);
        width.unwrap_or(0.0)
    }

    /// Bounds on the error of values in a part, and on that of gradients, beyond what is left out.
    pub fn error(&self, part: u32) -> [f64; 2] {
        self.part(part).map_or([0.0; 2], Part::error)
    }

    /// The same for points that were evaluated in any part known by now.
    pub fn worst_error(&self) -> [f64; 2] {
        self.worst
    }

    /// Number of evaluations of values and bounds.
    pub fn evaluations(&self) -> u64 {
        self.evaluations.load(Ordering::Relaxed)
    }

    /// Returns whether a part has so many terms that smaller ones are worthwhile.
    pub fn has_many_terms(&self, part: u32) -> bool {
        self.part(part)
            .is_none_or(|part| part.terms.len() > FEW_TERMS)
    }

    /// A smaller part for the children of a cell; `None` if that of the cell will do.
    pub fn narrow(&self, cell: &Cell) -> Option<Part> {
        let part = self.part(cell.part);
        if part.is_some_and(|part| part.terms.len() <= FEW_TERMS) {
            return None;
        }
        let ball = Ball {
            center: self.forest.center(cell),
            // Vertices move and triangles reach beyond a cell.
            radius: self.forest.size(cell.level).length(),
        };
        let slack = Slack {
            left_out: match self.logarithm {
                Some(_) => Logarithm::slack(SLACK),
                None => SLACK,
            },
            far: self.far,
        };
        self.function.narrow(ball, part, slack)
    }

    /// Adds a part, chosen from another one.
    pub fn add(&mut self, part: Part, parent: u32) -> u32 {
        let [value, slope] = part.error();
        self.worst = [self.worst[0].max(value), self.worst[1].max(slope)];
        self.parts.push(Nested { part, parent });
        self.parts.len() as u32 - 1
    }

    /// Fits [polynomials](Patches) to the function near the surface, for a tolerance, when the
    /// cells are known.
    ///
    /// # Errors
    /// If the caller cancels.
    pub fn fit(
        &mut self,
        lattice: &Lattice,
        tolerance: f64,
        threads: usize,
        progress: &mut Progress<'_>,
    ) -> Result<(), MeshError> {
        self.patches = Patches::fit(self, lattice, tolerance, threads, progress)?;
        Ok(())
    }

    /// The smallest part known that serves a ball.
    pub fn part_for(&self, ball: Ball) -> u32 {
        self.part_from(self.forest.leaf_at(ball.center), ball)
    }

    /// The same, where the leaf at its centre is known.
    fn part_from(&self, leaf: u32, ball: Ball) -> u32 {
        let mut part = self.forest.cells[leaf as usize].part;
        while let Some(Nested { part: own, parent }) = self.parts.get(part as usize) {
            if own.ball.center.distance(ball.center) + ball.radius <= own.ball.radius {
                return part;
            }
            part = *parent;
        }
        NONE
    }

    /// Value and gradient anywhere.
    pub fn jet_at(&self, point: DVec3) -> Jet<f64> {
        self.jet_in(self.forest.leaf_at(point), point)
    }

    fn jet_in(&self, leaf: u32, point: DVec3) -> Jet<f64> {
        let ball = Ball {
            center: point,
            radius: 0.0,
        };
        self.jet(self.part_from(leaf, ball), point)
    }

    /// The same, near the surface by polynomials, when these were fitted.
    pub fn near_jet_at(&self, point: DVec3) -> Jet<f64> {
        let leaf = self.forest.leaf_at(point);
        let near = self.patches.jet(leaf, point);
        near.unwrap_or_else(|| self.jet_in(leaf, point))
    }
}
