//! The thesis's digger (section 4.2): a fixed number of Hermite spans a primitive, two as
//! published.
//!
//! The interval of the ray within a primitive's bounding volume is cut into spans of equal length.
//! At both ends of the interval value and slope are taken to be 0, at the nodes between they are
//! the field's own. The spans' ends cut the ray into slabs, on each of which the sum of all spans
//! minus T is one cubic; its roots are the hits.
use crate::{Side, Sight};
use field::THRESHOLD;
use scene::Settings;
use tracer::{Quest, roots};

/// Most spans added up on a ray, unless 64 times its primitives are more; crossings beyond are not
/// found.
const MOST_SPANS: usize = 1 << 18;

/// Cubic on a part of the ray.
struct CubicPart {
    from: f64,
    to: f64,
    /// Coefficients, by powers of t − from.
    powers: [f64; 4],
}

impl CubicPart {
    /// Makes the cubic that has these values and slopes at its ends.
    fn new(from: f64, to: f64, [(a, rise), (d, fall)]: [(f64, f64); 2]) -> Self {
        let length = to - from;
        let third = length / 3.0;
        // Bernstein coefficients.
        let (b, c) = (a + rise * third, d - fall * third);
        let x = 1.0 / length;
        Self {
            from,
            to,
            powers: [
                a,
                3.0 * (b - a) * x,
                3.0 * (a - 2.0 * b + c) * (x * x),
                (d - a + 3.0 * (b - c)) * (x * x * x),
            ],
        }
    }

    /// Returns the coefficients by powers of t − `start`.
    fn shift(&self, start: f64) -> [f64; 4] {
        let s = start - self.from;
        let [a, b, c, d] = self.powers;
        [
            a + s * (b + s * (c + s * d)),
            b + s * (2.0 * c + s * 3.0 * d),
            c + 3.0 * s * d,
            d,
        ]
    }
}

/// Finds the first crossing that the quest asks for, by `spans` spans of each primitive.
pub(crate) fn first(spans: u32, sight: &mut Sight<'_>, quest: Quest) -> Option<f64> {
    let spans = spans.clamp(1, Settings::MAX_SPANS);
    let mut pieces = Vec::new();
    let mut cuts = sight.range.to_vec();
    for term in 0..sight.terms.len() {
        let [from, to] = sight.terms[term].interval;
        let places: Vec<f64> = (0..=spans)
            .map(|i| from + (to - from) * (f64::from(i) / f64::from(spans)))
            .collect();
        let mut left = (0.0, 0.0);
        for (i, ends) in places.windows(2).enumerate() {
            let mut right = (0.0, 0.0);
            if i + 2 < places.len() {
                right = sight.one(term, ends[1]);
            }
            pieces.push(CubicPart::new(ends[0], ends[1], [left, right]));
            left = right;
        }
        cuts.extend(places);
    }
    cuts.retain(|t| *t >= sight.range[0] && *t <= sight.range[1]);
    field::heap_sort(&mut cuts, |a, b| a.total_cmp(b).is_lt());
    pieces.sort_by(|a, b| a.from.total_cmp(&b.from));

    let mut side = Side::unknown(quest);
    let (mut active, mut next) = (Vec::new(), 0);
    let mut left = MOST_SPANS.max(64 * sight.terms.len());
    for slab in cuts.windows(2) {
        let (from, to) = (slab[0], slab[1]);
        if from == to {
            continue;
        }
        while next < pieces.len() && pieces[next].from <= from {
            active.push(next);
            next += 1;
        }
        active.retain(|&i: &usize| pieces[i].to > from);
        left = left.checked_sub(active.len())?;
        let mut sum = [-THRESHOLD, 0.0, 0.0, 0.0];
        for &i in &active {
            for (total, part) in sum.iter_mut().zip(pieces[i].shift(from)) {
                *total += part;
            }
        }
        let length = to - from;
        let found = roots(&sum, 0.0, length);
        let found = found.as_slice();
        let places = [0.0].into_iter().chain(found.iter().copied());
        for (i, root) in places.enumerate() {
            let beyond = found.get(i).copied().unwrap_or(length);
            let x = 0.5 * (root + beyond);
            let value = sum.iter().rev().fold(0.0, |value, c| value * x + c);
            if side.arrive(value > 0.0) {
                return Some(from + root);
            }
        }
    }
    None
}
