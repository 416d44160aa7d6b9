//! The far field of a sum: a hierarchy of boxes, each with a polynomial of all that is far from it
//! and a list of what is near.
//!
//! Space is a cube that is halved along all axes again and again (an octree). A cell's polynomial
//! is its parent's, plus the primitives that are far from the cell but were near its parent,
//! evaluated at the nodes of [`Expansion`]; so each primitive is evaluated for a bounded number of
//! cells of each size. Cells are made where and when they are first asked for, and depend on the
//! primitives alone.
//!
//! A cell's list and its share of the polynomial depend on the primitives near its parent alone:
//! thresholds depend on the cell's depth, not on the error that it inherits. After an edit of few
//! primitives a hierarchy takes lists and shares from an [earlier one](FarField::after) in all
//! cells near whose parents nothing has changed, and has the same bits as if it were made anew.
//!
//! # The bound
//!
//! The kernels that never end are `G = (ε² + u²)^(−e/2)`, with e = 1, 2, 3 for the inverse, the
//! squared and the cubed kernel, and e = 4, ε = 1 for Cauchy's. Along a straight line that is the
//! generating function's root of the Gegenbauer polynomials `C_n` of order e/2: its n-th derivative
//! is `±n!·C_n(cos θ)·b^(−e−n)` with `b² = ε² + u²`, where `b·cos θ` is the position along the
//! line. A skeleton adds up such terms. With A = 1 − I, the error of interpolation along an axis at
//! n = 5 Chebyshev nodes of an interval of half length w, `|A f| ≤ 2(w/2)ⁿ/n!·|f⁽ⁿ⁾|`.
//! Interpolation along all three axes, in any order, is off by `A₁f + I₁A₂f + I₁I₂A₃f`, and |I| ≤
//! Λ, so that the error is at most
//!
//! `2M·q⁵·(c₁ + Λc₂ + Λ²c₃)`, `q = s·w/2b`, `c₁ ≥ c₂ ≥ c₃`,
//!
//! where M bounds the field, s is the width parameter, and cᵢ bounds |C₅(cos θ)| for the lines
//! along axis i. |C₅| is small up to a certain cosine, which at most one axis exceeds as seen from
//! far away. Interpolation of the parent's polynomial is exact.
//!
//! Kernels that end, the Gaussian and primitives with a profile are near wherever they are not
//! negligible.
mod expansion;
mod source;
mod sums;

use crate::kernel::Tail;
use crate::{Jet, Kernel, Primitive, THRESHOLD};
use core::cell::OnceCell;
pub use expansion::{DEGREE, Expansion};
use expansion::{Series, VECTORS, slope_of};
use glam::DVec3;
use source::{Points, Seen, Source};
use std::sync::{Arc, OnceLock};
use sums::NodeSums;
use wide::f32x8;

/// Half the extent of the box in which a cell's polynomial holds, over half the cell's own: rays of
/// a beam may leave the cell by the difference.
pub const LOOSE: f64 = 1.3;
/// Largest error of a cell's polynomial, in T.
pub const MOST_ERROR: f64 = 1e-4 * THRESHOLD;
/// Part of [`MOST_ERROR`] that a cell adds to its parent's error, at most.
const PORTION: f64 = 1.0 / 16.0;
/// Number of halvings of the cube beyond which that part is halved with each further one, so that
/// the sum stays below 1.
const EVEN: i32 = 12;
/// Largest error of the interpolant of a primitive that is taken for far. A power of two, so that
/// halvings of it are told by exponents.
const FIRST_SHARE: f64 = 1.0 / (1 << 22) as f64;
/// Largest number of halvings of [`FIRST_SHARE`] in a cell that has too many far primitives.
const MOST_HALVINGS: usize = 24;
/// Rounding of coordinates in single precision, in the world and in a primitive's own frame,
/// relative to them.
const MISPLACED: f64 = 2.5e-7;
/// Near primitives up to which [`FarField::around`] divides no cell.
pub const FEW_NEAR: usize = 48;
/// Least size of a cell, over the hierarchy's.
pub const SMALLEST: f64 = 1e-6;
/// Part of T by which bounds must be below it.
const BELOW: f64 = 1e-5;

/// The hierarchy of a list of primitives.
#[derive(Debug)]
pub struct FarField {
    sources: Arc<Sources>,
    /// The primitives that count, in ascending order.
    members: Vec<u32>,
    center: DVec3,
    half: f64,
    nodes: [[f32x8; 3]; VECTORS],
    purpose: Purpose,
    root: OnceLock<Arc<Cell>>,
    earlier: Option<Earlier>,
}

/// A hierarchy that was made before a few primitives changed.
#[derive(Debug)]
struct Earlier {
    members: Vec<u32>,
    root: Arc<Cell>,
    /// Numbers of the primitives that have changed since, in ascending order.
    changed: Arc<[u32]>,
}

/// The use of a hierarchy, which says what its cells hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Purpose {
    /// The field.
    Values,
    /// The field and bounds on its derivatives.
    Derivatives,
    /// The surface: cells in which the field is below T are left empty.
    Surface,
}

/// The primitives' bounds.
#[derive(Debug)]
struct Sources {
    each: Vec<Source>,
    /// The points side by side, if all primitives are points of one kernel.
    points: Option<Points>,
}

/// A cube of space.
#[derive(Debug)]
pub struct Cell {
    /// Centre.
    pub center: DVec3,
    /// Half its side.
    pub half: f64,
    /// Numbers of the primitives near it, in ascending order.
    pub near: Arc<[u32]>,
    /// Sum of all others in the cube of half side `LOOSE·half`, in coordinates from −1 to 1 there.
    pub expansion: Expansion,
    /// Bound on its error.
    pub error: f64,
    /// Upper bound on the far field, with the expansion's error.
    pub far_most: f64,
    /// Lower bound on it.
    pub far_least: f64,
    /// Upper bound on the whole field.
    pub most: f64,
    /// Whether there is nothing but this bound, since it is below T ([`FarField::surface_only`]).
    pub is_empty: bool,
    /// Bounds that hierarchies have which were made [with derivatives](FarField::with_derivatives).
    pub smooth: Smooth,
    /// Bounds on the error and on its slope that parts inherit: without the rounding of evaluation.
    passed: [f64; 2],
    /// Number of halvings of the hierarchy's cube.
    depth: i32,
    /// Sum of bounds on the primitives near its parent that add to the field.
    candidates_most: f64,
    /// The part that is not inherited; `None` in an empty cell.
    own: Option<Arc<Own>>,
    children: [OnceLock<Arc<Cell>>; 8],
}

/// The part of a cell that is not inherited: its list and the polynomial of primitives that are far
/// from it but near its parent.
#[derive(Debug)]
struct Own {
    near: Arc<[u32]>,
    /// Sum of bounds on those near ones that add to the field.
    near_most: f64,
    /// Interpolant of the far ones.
    series: Series,
    /// Bound on its error, with the rounding of the sums.
    error: f64,
    smooth: Smooth,
}

/// Bounds on the far field of a cell, in its loose cube; infinite where they are not known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Smooth {
    /// Bound on the length of the gradient of the expansion's error.
    pub slope_error: f64,
    /// Bounds on the first to third derivative of the true far field along any line.
    pub derivatives: [f64; 3],
}

impl Smooth {
    const UNKNOWN: Self = Self {
        slope_error: f64::INFINITY,
        derivatives: [f64::INFINITY; 3],
    };

    fn add(&mut self, other: Self) {
        self.slope_error += other.slope_error;
        for (sum, own) in self.derivatives.iter_mut().zip(other.derivatives) {
            *sum += own;
        }
    }
}

/// Returns a kernel `(ε² + u²)^(−e/2)`, given e, from 1 to 4, and `1/(ε² + u²)`.
#[inline(always)]
#[must_use]
pub fn decay(power: i32, inverse: f32x8) -> f32x8 {
    match power {
        1 => inverse.sqrt(),
        2 => inverse,
        3 => inverse * inverse.sqrt(),
        _ => inverse * inverse,
    }
}

/// Ratio of a cube's half diagonal to half its side, or more.
const DIAGONAL: f64 = 1.733;

/// Returns the exponent e, from 1 to 4, and the square ε² of a kernel `(ε² + u²)^(−e/2)`; `None`
/// for all other kernels.
#[must_use]
pub fn power(kernel: Kernel) -> Option<(i32, f64)> {
    match kernel.tail() {
        Tail::Power {
            exponent,
            softening,
        } if exponent <= 4 => Some((exponent, softening)),
        _ => None,
    }
}

impl FarField {
    /// The hierarchy of some primitives in a cube of space with this half side.
    #[must_use]
    pub fn new(primitives: &[Primitive], center: DVec3, half: f64) -> Self {
        let each: Vec<Source> = primitives.iter().map(Source::of).collect();
        Self {
            members: (0..each.len() as u32).collect(),
            sources: Arc::new(Sources {
                points: Points::of(&each),
                each,
            }),
            center,
            half,
            nodes: expansion::nodes(),
            purpose: Purpose::Values,
            root: OnceLock::new(),
            earlier: None,
        }
    }

    /// Returns the hierarchy with an earlier one that helps to make it: cells near whose parents
    /// nothing has changed take their lists and shares of polynomials from there. `changed` lists
    /// the numbers of the primitives that differ, in ascending order. An earlier hierarchy in
    /// another cube, of another use or of another number of primitives is of no help.
    #[must_use]
    pub fn after(self, earlier: Option<&Self>, changed: &Arc<[u32]>) -> Self {
        let frame = |field: &Self| {
            let count = field.sources.each.len();
            (field.center, field.half, field.purpose, count)
        };
        let earlier = earlier.filter(|earlier| frame(earlier) == frame(&self));
        let earlier = earlier.and_then(|earlier| {
            Some(Earlier {
                members: earlier.members.clone(),
                root: earlier.root.get()?.clone(),
                changed: changed.clone(),
            })
        });
        Self { earlier, ..self }
    }

    /// Whether an earlier hierarchy helps to make this one ([`FarField::after`]).
    #[must_use]
    pub fn is_helped(&self) -> bool {
        self.earlier.is_some()
    }

    /// Returns the hierarchy for callers that look for the surface alone: where bounds show that
    /// the field is below T, cells have no list, no polynomial and no parts, and cost next to
    /// nothing.
    #[must_use]
    pub fn surface_only(self) -> Self {
        Self {
            purpose: Purpose::Surface,
            ..self
        }
    }

    /// Returns the hierarchy with bounds on derivatives and on the error of slopes
    /// ([`Cell::smooth`]).
    #[must_use]
    pub fn with_derivatives(self) -> Self {
        Self {
            purpose: Purpose::Derivatives,
            ..self
        }
    }

    /// Returns the hierarchy, in the same cube, of the primitives that add to the field and for
    /// which a condition holds.
    #[must_use]
    pub fn of_positive(&self, holds: impl Fn(u32) -> bool) -> Self {
        let each = &self.sources.each;
        Self {
            sources: self.sources.clone(),
            members: (0..each.len() as u32)
                .filter(|i| each[*i as usize].adds && holds(*i))
                .collect(),
            purpose: Purpose::Values,
            root: OnceLock::new(),
            earlier: None,
            ..*self
        }
    }

    /// Number of primitives that have an expansion.
    #[must_use]
    pub fn count_expansions(&self) -> usize {
        let each = self.sources.each.iter();
        each.filter(|source| source.power > 0).count()
    }

    /// Returns the largest cell, the cube itself, given the primitives of which the hierarchy was
    /// made.
    pub fn root(&self, primitives: &[Primitive]) -> &Arc<Cell> {
        self.root.get_or_init(|| {
            let own = self
                .earlier
                .as_ref()
                .filter(|earlier| earlier.members == self.members && earlier.changed.is_empty());
            let own = own.map(|earlier| &earlier.root);
            Arc::new(self.cell(
                primitives,
                (self.center, self.half),
                &self.members,
                None,
                own,
            ))
        })
    }

    /// Returns one of the eight parts of a cell: bit i of `number` tells whether it is the upper
    /// half along axis i. An empty cell has no parts and is returned itself.
    pub fn part<'c>(
        &self,
        primitives: &[Primitive],
        of: &'c Arc<Cell>,
        number: usize,
    ) -> &'c Arc<Cell> {
        if of.is_empty {
            return of;
        }
        of.children[number].get_or_init(|| {
            let place = (of.middle_of(number), 0.5 * of.half);
            let earlier = self.earlier.as_ref();
            let before = earlier.and_then(|earlier| earlier.part(of, number));
            Arc::new(self.cell(primitives, place, &of.near, Some(of), before))
        })
    }

    /// Returns the cell for a ball of space: the first that has no more than [`FEW_NEAR`] near
    /// primitives, or whose part around the ball's middle does not hold the ball in its loose cube.
    /// `None` if not even the largest does.
    pub fn around(
        &self,
        primitives: &[Primitive],
        center: DVec3,
        radius: f64,
    ) -> Option<&Arc<Cell>> {
        let room = radius * (1.0 + 1e-9);
        let fits = |middle: DVec3, half: f64| {
            (center - middle).abs().max_element() + room <= LOOSE * half * (1.0 - 1e-9)
        };
        let mut cell = self.root(primitives);
        // NaN fits nowhere.
        if !(cell.holds(center) && fits(cell.center, cell.half)) {
            return None;
        }
        while cell.near.len() > FEW_NEAR && !cell.is_empty && cell.half > SMALLEST * self.half {
            let number = cell.part_of(center);
            if !fits(cell.middle_of(number), 0.5 * cell.half) {
                break;
            }
            cell = self.part(primitives, cell, number);
        }
        Some(cell)
    }

    /// Computes bounds on some primitives in a box.
    fn bounds_in(&self, center: DVec3, half: f64, candidates: &[u32]) -> Vec<Seen> {
        let mut seen = Vec::with_capacity(candidates.len());
        match &self.sources.points {
            Some(points) => points.bounds_in(center, half, candidates, &mut seen),
            None => seen.extend(
                candidates
                    .iter()
                    .map(|&i| self.sources.each[i as usize].bounds_in(center, half)),
            ),
        }
        seen
    }

    /// Makes a cell from the primitives near its parent (`candidates`). `before` is an earlier cell
    /// at the place that was made from the same ones.
    fn cell(
        &self,
        primitives: &[Primitive],
        (center, half): (DVec3, f64),
        candidates: &[u32],
        parent: Option<&Cell>,
        before: Option<&Arc<Cell>>,
    ) -> Cell {
        let loose = LOOSE * half;
        let seen = OnceCell::new();
        let seen = || seen.get_or_init(|| self.bounds_in(center, loose, candidates));
        let candidates_most = before.map(|before| before.candidates_most);
        let candidates_most = candidates_most.unwrap_or_else(|| self.adding(candidates, seen()));
        let inherited = parent.map_or([0.0; 2], |parent| parent.passed);
        let bound = parent.map_or(0.0, |parent| parent.far_most) + candidates_most;
        let depth = parent.map_or(0, |parent| parent.depth + 1);
        let mut cell = Cell {
            center,
            half,
            near: Arc::default(),
            expansion: Expansion::ZERO,
            error: inherited[0],
            far_most: bound,
            far_least: f64::NEG_INFINITY,
            most: bound,
            is_empty: true,
            smooth: Smooth::UNKNOWN,
            passed: inherited,
            depth,
            candidates_most,
            own: None,
            children: Default::default(),
        };
        if self.purpose == Purpose::Surface && bound < THRESHOLD * (1.0 - BELOW) {
            return cell;
        }
        cell.is_empty = false;
        let before = before.and_then(|before| before.own.clone());
        let own = before.unwrap_or_else(|| {
            Arc::new(self.own(primitives, (center, loose), depth, candidates, seen()))
        });
        cell.near = own.near.clone();
        cell.inherit(&own, parent);
        cell.most = own.near_most + cell.far_most;
        if self.purpose != Purpose::Derivatives {
            cell.smooth = Smooth::UNKNOWN;
        }
        cell.own = Some(own);
        cell
    }

    /// Sum of bounds on those primitives that add to the field.
    fn adding(&self, candidates: &[u32], seen: &[Seen]) -> f64 {
        let both = candidates.iter().zip(seen);
        let adding = both.filter(|(i, _)| self.sources.each[**i as usize].adds);
        adding.map(|(_, seen)| seen.magnitude).sum()
    }

    /// Divides candidates into near and far ones, and interpolates the sum of the far ones in a
    /// box.
    fn own(
        &self,
        primitives: &[Primitive],
        (center, loose): (DVec3, f64),
        depth: i32,
        candidates: &[u32],
        seen: &[Seen],
    ) -> Own {
        let sources = &self.sources.each;
        let smaller = (depth - EVEN).max(0);
        let [portion, first] =
            [PORTION * MOST_ERROR, FIRST_SHARE].map(|x| x * 0.5f64.powi(smaller));
        let share = share_of(portion, first, seen);
        let mut smooth = Smooth {
            slope_error: 0.0,
            derivatives: [0.0; 3],
        };
        let mut sums = NodeSums::new(&self.nodes, center, loose);
        let (mut near, mut near_most, mut error) = (Vec::new(), 0.0, 0.0);
        for (&i, seen) in candidates.iter().zip(seen) {
            let source = &sources[i as usize];
            let mut is_far = seen.error < share;
            if is_far && self.purpose == Purpose::Derivatives {
                let own = source.smooth(center, loose, seen.error);
                is_far = own.derivatives.iter().all(|bound| bound.is_finite());
                if is_far {
                    smooth.add(own);
                }
            }
            if is_far {
                error += seen.error;
                if source.power > 0 {
                    sums.add(source, &primitives[i as usize], seen);
                }
            } else {
                near.push(i);
                if source.adds {
                    near_most += seen.magnitude;
                }
            }
        }
        let rounding = sums.rounding();
        let series = sums.fit();
        let rounding = rounding + series.error;
        smooth.slope_error += slope_of(rounding, loose);
        Own {
            near: near.into(),
            near_most,
            series,
            error: error + rounding,
            smooth,
        }
    }
}

/// Returns the error below which primitives are far, such that those of all far ones add up to
/// about a portion or less: a power of two, halved as often as need be.
fn share_of(portion: f64, first: f64, seen: &[Seen]) -> f64 {
    // Sums of the errors between one halving and the next, as their exponents of two tell.
    let mut sums = [0.0; MOST_HALVINGS];
    let exponent = |x: f64| (x.to_bits() >> 52) as usize;
    let top = exponent(0.5 * first);
    for seen in seen.iter().filter(|seen| seen.error < first) {
        let halvings = top - exponent(seen.error);
        sums[halvings.min(MOST_HALVINGS - 1)] += seen.error;
    }
    let mut sum: f64 = sums.iter().sum();
    let mut share = first;
    for own in sums {
        if sum <= portion {
            break;
        }
        sum -= own;
        share *= 0.5;
    }
    share
}

impl Earlier {
    /// Returns one of the eight parts that a cell had, if it was made from the same candidates as
    /// it would be now, none of which have changed.
    fn part(&self, of: &Cell, number: usize) -> Option<&Arc<Cell>> {
        let mut cell = &self.root;
        for _ in 0..of.depth {
            cell = cell.children[cell.part_of(of.center)].get()?;
        }
        let part = cell.children[number].get()?;
        let same = cell.near == of.near
            && !self
                .changed
                .iter()
                .any(|i| of.near.binary_search(i).is_ok());
        same.then_some(part)
    }
}

impl Cell {
    /// Adds the part that a cell inherits to its own.
    fn inherit(&mut self, own: &Own, parent: Option<&Cell>) {
        let more = parent.map(|parent| {
            let outer = 1.0 / parent.reach();
            let shift = ((self.center - parent.center) * outer).to_array();
            parent.expansion.in_part(shift, self.reach() * outer)
        });
        let fitted = Expansion::of(&own.series, more.as_ref());
        let mut smooth = own.smooth;
        let [error, slope_error] = self.passed;
        smooth.slope_error += slope_error + slope_of(fitted.error, self.reach());
        if let Some(parent) = parent {
            let inherited = smooth.derivatives.iter_mut().zip(parent.smooth.derivatives);
            inherited.for_each(|(sum, parent)| *sum += parent);
        }
        self.passed = [error + own.error + fitted.error, smooth.slope_error];
        self.error = self.passed[0] + fitted.evaluation;
        smooth.slope_error += slope_of(fitted.evaluation, self.reach());
        self.smooth = smooth;
        self.far_most = fitted.range[1] + self.error;
        self.far_least = fitted.range[0] - self.error;
        self.expansion = fitted.expansion;
    }

    /// The number of the part that holds a place.
    #[inline]
    #[must_use]
    pub fn part_of(&self, place: DVec3) -> usize {
        place.cmpge(self.center).bitmask() as usize
    }

    /// Middle of one of its parts.
    fn middle_of(&self, number: usize) -> DVec3 {
        let half = 0.5 * self.half;
        let sides = [0, 1, 2].map(|axis| if number >> axis & 1 == 0 { -half } else { half });
        self.center + DVec3::from_array(sides)
    }

    /// Whether a place is in the cell.
    #[inline]
    #[must_use]
    pub fn holds(&self, place: DVec3) -> bool {
        (place - self.center).abs().max_element() <= self.half
    }

    /// Whether the cell has taken over the part of another one ([`FarField::after`]).
    #[must_use]
    pub fn has_part_of(&self, other: &Self) -> bool {
        let both = self.own.as_ref().zip(other.own.as_ref());
        both.is_some_and(|(own, other)| Arc::ptr_eq(own, other))
    }

    /// Half the side of the box in which the expansion holds.
    #[inline]
    #[must_use]
    pub fn reach(&self) -> f64 {
        LOOSE * self.half
    }

    /// Value and gradient of the expansion at a place in the loose cube.
    #[must_use]
    pub fn jet(&self, place: DVec3) -> Jet<f64> {
        let scale = 1.0 / self.reach();
        let local = ((place - self.center) * scale).to_array();
        let jet = self.expansion.jet(local, f64::from);
        Jet {
            value: jet.value,
            gradient: jet.gradient.map(|slope| slope * scale),
        }
    }

    /// Value and gradient of the expansion at eight places, in single precision.
    #[must_use]
    pub fn jet8(&self, places: [f32x8; 3]) -> Jet<f32x8> {
        let scale = f32x8::splat(1.0 / self.reach() as f32);
        let center = self.center.to_array();
        let local = [0, 1, 2].map(|i| (places[i] - f32x8::splat(center[i] as f32)) * scale);
        let jet = self.expansion.jet(local, f32x8::splat);
        Jet {
            value: jet.value,
            gradient: jet.gradient.map(|slope| slope * scale),
        }
    }
}
