//! What the spans of a packet leave open: one ray at a time, in double precision.
//!
//! Where a ray grazes the surface, the field comes nearer to T than spans of single precision can tell.
//! On such a stretch the whole field is interpolated by one cubic, which is halved until its error bound
//! proves where the ray crosses, or the pieces are too short to matter.
use crate::ray::Ray;
use crate::roots::bracketed;
use crate::slabs::LARGE_TERM;
use crate::spans::{Node, Span};
use field::bound::SpanLength;
use field::{Bound, Primitive, THRESHOLD};

/// Pieces that one packet may have looked at; what is left is decided by the signs at its ends.
const MOST_PIECES: u32 = 1 << 12;
/// Rounding of a field in double precision, relative to the sizes of its terms.
const ROUNDING: f64 = 1e-12;
/// The slope of a Hermite cubic is off by at most four times its error bound over its length (for bounds
/// by the second derivative; for the fourth it is 3.08), and the slope's own Bernstein coefficients are 3/length times the
/// differences of the cubic's. So the field is monotone where those are larger than the bound times this.
pub const STEEP: f64 = 1.34;

/// Settles what happens to rays of one packet.
#[derive(Debug)]
pub struct Settler {
    /// The primitives that count on the stretch.
    pub list: Vec<u32>,
    pieces: u32,
    /// Evaluations of one primitive's field at one point.
    pub evaluations: u64,
}

impl Default for Settler {
    fn default() -> Self {
        Self {
            list: Vec::new(),
            pieces: MOST_PIECES,
            evaluations: 0,
        }
    }
}

/// A place on the ray: F − T and its slope there.
#[derive(Clone, Copy, Debug)]
struct Place {
    t: f64,
    node: Node<f64>,
}

/// The field along a ray.
#[derive(Clone, Copy, Debug)]
pub struct Along<'a> {
    /// All primitives.
    pub primitives: &'a [Primitive],
    /// Their bounds.
    pub bounds: &'a [Bound],
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
        [from, to]: [f64; 2],
        mut tell: impl FnMut(f64, bool) -> bool,
    ) {
        let left = self.at(along, from);
        if tell(from, left.node.value >= 0.0) {
            let right = self.at(along, to);
            self.between(along, left, right, &mut tell);
        }
    }

    /// F − T and its slope.
    fn at(&mut self, along: &Along<'_>, t: f64) -> Place {
        let point = along.ray.at(t).to_array();
        let [dx, dy, dz] = along.ray.direction.to_array();
        let mut node = Node {
            value: -THRESHOLD,
            slope: 0.0,
        };
        for &p in &self.list {
            let jet = along.primitives[p as usize].jet(point);
            let [gx, gy, gz] = jet.gradient;
            node.value += jet.value;
            node.slope += gx * dx + gy * dy + gz * dz;
        }
        self.evaluations += self.list.len() as u64;
        Place { t, node }
    }

    /// The crossings between two places; whether more are wanted.
    fn between(
        &mut self,
        along: &Along<'_>,
        left: Place,
        right: Place,
        tell: &mut impl FnMut(f64, bool) -> bool,
    ) -> bool {
        let length = right.t - left.t;
        let Some(pieces) = self.pieces.checked_sub(1) else {
            return self.refine(along, left, right, tell);
        };
        self.pieces = pieces;
        let center = along.ray.at(0.5 * (left.t + right.t));
        let radius = 0.5 * length * (1.0 + 1e-9);
        let span_length = SpanLength::new(length);
        let (mut above, mut size, mut error) = (0.0, THRESHOLD, 0.0);
        for &p in &self.list {
            let bound = &along.bounds[p as usize];
            let estimate = bound.estimate(bound.nearness(center, radius), &span_length);
            if bound.adds() {
                above += estimate.magnitude;
            }
            size += estimate.magnitude.min(LARGE_TERM);
            error += estimate.error;
        }
        if above < THRESHOLD {
            return true;
        }
        let error = error + ROUNDING * size;
        let span = Span::hermite(left.node, right.node, length);
        let [a, b, c, d] = span.0;
        if span.max() < -error || span.min() > error {
            return true;
        }
        let steep = STEEP * error;
        let turns = [b - a, c - b, d - c];
        let monotone = turns.iter().all(|x| *x > steep) || turns.iter().all(|x| *x < -steep);
        if monotone || length <= along.resolution {
            return self.refine(along, left, right, tell);
        }
        let middle = self.at(along, 0.5 * (left.t + right.t));
        self.between(along, left, middle, tell) && self.between(along, middle, right, tell)
    }

    /// The crossing between two places if they are on different sides.
    fn refine(
        &mut self,
        along: &Along<'_>,
        left: Place,
        right: Place,
        tell: &mut impl FnMut(f64, bool) -> bool,
    ) -> bool {
        let enters = right.node.value >= 0.0;
        if (left.node.value >= 0.0) == enters {
            return true;
        }
        let excess = |t: f64| {
            let node = self.at(along, t).node;
            (node.value, node.slope)
        };
        let within = 1e-3 * along.resolution;
        tell(bracketed(excess, left.t, right.t, within), enters)
    }
}
