//! Kalra and Barr's LG surfaces: the ray is halved until two Lipschitz constants isolate the root
//! of each interval.
//!
//! Let d be half an interval's length and m its middle. If |F(m)−T| > L·d, where L bounds the rate
//! of change of F, there is no root. If |F′(m)| > G·d, where G bounds F′'s rate of change, F is
//! monotone, so the signs at the ends show whether there is a root; the regula falsi refines it.
//! Otherwise both halves are searched. L and G are computed for each interval, from bounds per
//! primitive.
use crate::march::Bracket;
use crate::{Side, Sight, regula_falsi};
use core::ops::Range;
use tracer::Quest;

/// Length below which intervals are not halved.
const SHORTEST_INTERVAL: f64 = 1e-7;
/// Most looks at a primitive on a ray, unless 64 times its primitives are more: along a ray that
/// lies in the surface every interval would have to be halved to the last. The signs at the ends
/// decide the rest.
const MOST_LG_LOOKS: u64 = 1 << 16;

/// Finds the first crossing that the quest asks for.
pub(crate) fn first(sight: &mut Sight<'_>, quest: Quest) -> Option<f64> {
    let all = 0..sight.terms.len() as u32;
    let mut search = Search {
        most: MOST_LG_LOOKS.max(64 * u64::from(all.end)),
        lists: all.collect(),
        sight,
        side: Side::unknown(quest),
        looks: 0,
    };
    let ends = search.sight.range;
    let all = 0..search.lists.len();
    search.visit(ends, all)
}

/// A search on one ray.
struct Search<'s, 'a> {
    sight: &'s mut Sight<'a>,
    side: Side,
    /// Primitives that count in the intervals being searched, a range for each level.
    lists: Vec<u32>,
    looks: u64,
    most: u64,
}

impl Search<'_, '_> {
    /// Returns F − T and its slope, of some primitives.
    fn value(&mut self, list: &Range<usize>, t: f64) -> (f64, f64) {
        self.sight.excess_of(&self.lists[list.clone()], t)
    }

    /// Looks through an interval, front to back.
    fn visit(&mut self, ends: [f64; 2], above: Range<usize>) -> Option<f64> {
        let [from, to] = ends;
        let start = self.lists.len();
        for i in above {
            let term = self.lists[i];
            if self.sight.terms[term as usize].meets(from, to) {
                self.lists.push(term);
            }
        }
        let list = start..self.lists.len();
        self.looks += 1 + list.len() as u64;
        let found = self.isolate(ends, list);
        self.lists.truncate(start);
        found
    }

    /// Searches an interval, given the primitives that count in it.
    fn isolate(&mut self, ends: [f64; 2], list: Range<usize>) -> Option<f64> {
        let [from, to] = ends;
        let middle = 0.5 * (from + to);
        let half = 0.5 * (to - from);
        let (value, slope) = self.value(&list, middle);
        let terms = &self.lists[list.clone()];
        let (rate, turn) = self.sight.lipschitz(terms, ends, true);
        if value.abs() > rate * half {
            return self.side.arrive(value > 0.0).then_some(from);
        }
        let monotone = slope.abs() > turn * half;
        if !monotone && to - from > SHORTEST_INTERVAL && self.looks < self.most {
            let front = self.visit([from, middle], list.clone());
            return front.or_else(|| self.visit([middle, to], list));
        }
        let values = ends.map(|t| self.value(&list, t).0);
        if self.side.arrive(values[0] > 0.0) {
            return Some(from);
        }
        if !self.side.arrive(values[1] > 0.0) {
            return None;
        }
        let bracket = Bracket { ends, values };
        let (sight, terms) = (&mut *self.sight, &self.lists[list]);
        let root = regula_falsi::refine(&mut |t| sight.excess_of(terms, t).0, bracket);
        Some(root)
    }
}
