//! The field of a place: the sum of the pieces in its window, and the largest of such sums at a
//! point.
use super::near::Jets;
use super::survey::reach_of;
use super::window::Weight;
use super::{FAINT, Link, Local, Place, Segment};
use crate::{Ball, Jet};
use glam::DVec3;

/// The field of a place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stretch {
    pub place: Place,
    pub jet: Jet<f64>,
}

/// A place whose field may be asked for.
#[derive(Clone, Copy, Debug)]
struct Site {
    place: Place,
    /// Part of the segment, if a plane sweeps past it; `None` for an end or a branch, which stays
    /// where it is.
    part: Option<f64>,
    /// Upper bound on its field.
    most: f64,
    /// Square of its distance from the point.
    away: f64,
}

impl Local {
    /// Weight of a link for a place on its segment.
    pub(super) fn weight(&self, segment: &Segment, link: &Link, along: f64) -> Weight {
        // Most pieces are wholly within the window's flat part, or out of reach.
        let [nearest, farthest] = reach_of(segment, link, along);
        if nearest >= self.window.reach || farthest <= self.window.flat() {
            return Weight {
                value: f64::from(u8::from(nearest < self.window.reach)),
                slope: 0.0,
            };
        }
        if link.own {
            let [[start, _], [end, _]] = link.distances;
            return match along {
                s if s < start => self
                    .window
                    .mean([start - s, end - s], [-1.0; 2], link.length),
                s if s > end => self
                    .window
                    .mean([s - start, s - end], [1.0; 2], link.length),
                s => self.window.mean_around([s - start, end - s], link.length),
            };
        }
        let rest = segment.length - along;
        let ways = link.distances.map(|[from_start, from_end]| {
            let (back, forth) = (along + from_start, rest + from_end);
            if back <= forth {
                (back, 1.0)
            } else {
                (forth, -1.0)
            }
        });
        let [a, b] = ways;
        // An end beyond the reach of both ways is as far as its piece is long.
        let [a, b] = [
            (
                a.0.min(b.0 + link.length),
                if a.0 <= b.0 + link.length { a.1 } else { b.1 },
            ),
            (
                b.0.min(a.0 + link.length),
                if b.0 <= a.0 + link.length { b.1 } else { a.1 },
            ),
        ];
        self.window.mean([a.0, b.0], [a.1, b.1], link.length)
    }

    /// Computes W and its gradient at a place that stays where it is, at a point.
    #[must_use]
    pub fn stretch_at(&self, place: Place, point: DVec3) -> Jet<f64> {
        let mut jets = Jets::new(&self.pieces, point.to_array());
        self.stretch(place, &mut jets).0
    }

    /// Computes W and its gradient at a place that stays where it is, and the derivative of W by
    /// the place.
    fn stretch(&self, place: Place, jets: &mut Jets) -> (Jet<f64>, f64) {
        let segment = &self.segments[place.segment as usize];
        let (mut sum, mut by_place) = (Jet::zero(), 0.0);
        for link in &self.links[segment.links.clone()] {
            let weight = self.weight(segment, link, place.along);
            if weight.value > 0.0 || weight.slope != 0.0 {
                let jet = jets.get(link.piece);
                sum = sum.plus(jet.times(weight.value));
                by_place += weight.slope * jet.value;
            }
        }
        (sum, by_place)
    }

    /// Computes the share of a site in F.
    fn evaluate(&self, site: &Site, point: DVec3, jets: &mut Jets) -> Stretch {
        let place = site.place;
        let (mut jet, by_place) = self.stretch(place, jets);
        if let Some(part) = site.part {
            let segment = &self.segments[place.segment as usize];
            let rate = segment.swept.rate(point, part);
            let turn = segment.swept.normal(part) * (-by_place * segment.length / rate);
            // Where planes meet there is no gradient.
            if turn.is_finite() {
                let turn = turn.to_array();
                jet.gradient = core::array::from_fn(|i| jet.gradient[i] + turn[i]);
            }
        }
        Stretch { place, jet }
    }

    /// The sites of a point among some terms, the nearest ones first, so that most others need not
    /// be evaluated.
    fn sites(&self, point: DVec3, terms: &[u32]) -> Vec<Site> {
        let ball = Ball {
            center: point,
            radius: 0.0,
        };
        let mut found: Vec<Site> = Vec::new();
        for &term in terms {
            let node = (term as usize).checked_sub(self.segments.len());
            let (number, end) = match node.and_then(|node| self.nodes.get(node)) {
                Some((segment, end)) => (*segment, Some(*end)),
                None => (term, None),
            };
            let segment = &self.segments[number as usize];
            let mut add = |part: f64, sweeps: bool| {
                found.push(Site {
                    place: Place {
                        segment: number,
                        along: part * segment.length,
                    },
                    part: sweeps.then_some(part),
                    most: segment.group.most(segment.group.distance(&ball)),
                    away: segment.swept.at(part).distance_squared(point),
                });
            };
            match end {
                Some(end) => add(end as f64, false),
                None => segment.swept.each(point, |part| add(part, true)),
            }
        }
        // Stable: of two that are as near the first one stays first.
        found.sort_by(|a, b| a.away.total_cmp(&b.away));
        found
    }

    /// Distance along the skeleton between two places; infinite if it is more than 2D.
    #[must_use]
    pub fn distance(&self, a: Place, b: Place) -> f64 {
        let (first, second) = (
            &self.segments[a.segment as usize],
            &self.segments[b.segment as usize],
        );
        let mut least = f64::INFINITY;
        if a.segment == b.segment {
            least = (a.along - b.along).abs();
        }
        for (i, here) in [a.along, first.length - a.along].into_iter().enumerate() {
            for (k, there) in [b.along, second.length - b.along].into_iter().enumerate() {
                let near = &self.near[first.ends[i] as usize];
                let found = near.binary_search_by_key(&second.ends[k], |near| near.0);
                let between = found.map_or(f64::INFINITY, |place| near[place].1);
                least = least.min(here + there + between);
            }
        }
        least
    }

    /// The largest stretch at a point and, if a level is given, the largest one more than 2D away
    /// from it along the skeleton, which may be left out if it is below the level.
    pub(super) fn two_at(&self, point: DVec3, level: Option<f64>) -> [Option<Stretch>; 2] {
        let ball = Ball {
            center: point,
            radius: 0.0,
        };
        // Cells know no second stretch that is fainter.
        let terms = match level {
            Some(level) if level < FAINT => &self.terms,
            _ => self.terms_in(&ball, level.is_some()),
        };
        let sites = self.sites(point, terms);
        let mut jets = Jets::new(&self.pieces, point.to_array());
        let mut known: Vec<Option<Stretch>> = vec![None; sites.len()];
        let mut first: Option<Stretch> = None;
        for (site, known) in sites.iter().zip(&mut known) {
            if first.is_none_or(|first| site.most >= first.jet.value) {
                let stretch = self.evaluate(site, point, &mut jets);
                *known = Some(stretch);
                if first.is_none_or(|first| stretch.jet.value > first.jet.value) {
                    first = Some(stretch);
                }
            }
        }
        let (Some(leader), Some(level)) = (first, level) else {
            return [first, None];
        };
        let mut second: Option<Stretch> = None;
        let far = 2.0 * self.window.reach;
        for (site, known) in sites.iter().zip(&known) {
            let least = second.map_or(level, |second| second.jet.value);
            if site.most < least || self.distance(leader.place, site.place) <= far {
                continue;
            }
            let stretch = known.unwrap_or_else(|| self.evaluate(site, point, &mut jets));
            if second.is_none_or(|second| stretch.jet.value > second.jet.value) {
                second = Some(stretch);
            }
        }
        [first, second]
    }

    /// Value and gradient of the largest stretch at a point, and of the largest one more than 2D
    /// away from it along the skeleton, if there is one.
    #[must_use]
    pub fn two(&self, point: DVec3) -> (Jet<f64>, Option<Jet<f64>>) {
        self.two_above(point, 0.0)
    }

    /// Computes the jets of [`Local::two`]; the second one may be left out if its value is below
    /// `level`.
    #[must_use]
    pub fn two_above(&self, point: DVec3, level: f64) -> (Jet<f64>, Option<Jet<f64>>) {
        let [first, second] = self.two_at(point, Some(level));
        (
            first.map_or_else(Jet::zero, |first| first.jet),
            second.map(|second| second.jet),
        )
    }
}
