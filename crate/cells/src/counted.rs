//! Work, counted in evaluations of terms: the same on every machine, where seconds are not.

use core::sync::atomic::{AtomicU64, Ordering};
use field::{Ball, Enclosure, Implicit, Jet, Logarithm, Part, Slack, Variation};
use glam::DVec3;
use scene::Surface;
use wide::f32x8;

/// Work of an evaluation beside that of its terms.
const PLAIN: u64 = 4;
/// Work of bounds on a term.
const BOUNDS: u64 = 2;
/// Work of an evaluation of a function that is no sum, for each of its elements.
const COMPOSED: u64 = 400;

/// A body's function that counts what it is asked for.
pub(crate) struct Counted<'a> {
    function: &'a dyn Implicit,
    /// The work of an evaluation of each term.
    each: u64,
    /// Number of terms.
    terms: u64,
    spent: AtomicU64,
}

impl<'a> Counted<'a> {
    /// A function of which nothing was asked yet.
    pub(crate) fn new(surface: &'a Surface) -> Self {
        let each = match surface {
            Surface::Sum(_) => 1,
            Surface::Composed(_) => COMPOSED,
        };
        Self::with(surface.function(), each, surface.element().len() as u64)
    }

    /// A function whose terms each take some work.
    pub(crate) fn with(function: &'a dyn Implicit, each: u64, terms: u64) -> Self {
        Self {
            function,
            each,
            terms,
            spent: AtomicU64::new(0),
        }
    }

    /// Returns the work done.
    pub(crate) fn work(&self) -> u64 {
        self.spent.load(Ordering::Relaxed)
    }

    /// Returns the work of an evaluation of all terms.
    pub(crate) fn whole(&self) -> u64 {
        PLAIN + self.each * self.terms
    }

    /// Adds the work of an evaluation of a part's terms, which somebody else does.
    pub(crate) fn note(&self, part: &Part) {
        self.count(1, Some(part));
    }

    /// Adds the work of some evaluations, and returns the function.
    fn count(&self, times: u64, part: Option<&Part>) -> &'a dyn Implicit {
        let terms = part.map_or(self.terms, |part| part.terms.len() as u64);
        let work = times * (PLAIN + self.each * terms);
        self.spent.fetch_add(work, Ordering::Relaxed);
        self.function
    }
}

impl Implicit for Counted<'_> {
    fn jet(&self, point: DVec3) -> Jet<f64> {
        self.count(1, None).jet(point)
    }

    fn jet32(&self, point: [f32; 3]) -> Jet<f32> {
        self.count(1, None).jet32(point)
    }

    fn jet8(&self, points: [f32x8; 3]) -> Jet<f32x8> {
        self.count(1, None).jet8(points)
    }

    fn enclose(&self, ball: Ball) -> Enclosure {
        self.count(BOUNDS, None).enclose(ball)
    }

    fn shares(&self, point: DVec3, out: &mut Vec<(u32, f64)>) {
        self.count(1, None).shares(point, out);
    }

    fn support(&self) -> Option<Ball> {
        self.function.support()
    }

    fn support_at(&self, level: f64) -> Option<Ball> {
        self.function.support_at(level)
    }

    fn narrow(&self, ball: Ball, among: Option<&Part>, slack: Slack) -> Option<Part> {
        self.count(BOUNDS, among).narrow(ball, among, slack)
    }

    fn jet_of(&self, part: &Part, point: DVec3) -> Jet<f64> {
        self.count(1, Some(part)).jet_of(part, point)
    }

    fn jet8_of(&self, part: &Part, points: [f32x8; 3]) -> Jet<f32x8> {
        self.count(1, Some(part)).jet8_of(part, points)
    }

    fn variation(&self, part: Option<&Part>, ball: Ball) -> Variation {
        self.count(BOUNDS, part).variation(part, ball)
    }

    fn variation_with_jet(&self, part: Option<&Part>, ball: Ball) -> (Variation, Option<Jet<f64>>) {
        self.count(BOUNDS, part).variation_with_jet(part, ball)
    }

    fn logarithm(&self) -> Option<Logarithm<'_>> {
        self.function.logarithm()
    }
}
