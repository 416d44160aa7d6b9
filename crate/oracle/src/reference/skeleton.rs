//! Local convolution of the reference: places are found by a search of its own, bounds come from
//! pieces, distances from Floyd and Warshall's method. It shares the sum of a place's window with
//! [`field::Local`], and nothing else.
use super::function::{Evaluation, FIELD_ERROR};
use super::pieces::{Magnitudes, Pieces};
use super::range::{Deformation, Range};
use field::local::{Limb, LocalError, Place};
use field::{Local, Primitive};
use glam::DVec3;

/// A skeleton that is convolved locally, whose folds may touch.
#[derive(Clone, Debug)]
pub(super) struct SkeletonTerms {
    local: Local,
    limbs: Vec<Stalk>,
    pieces: Vec<Part>,
    /// Distances along the skeleton between its points.
    between: Vec<Vec<f64>>,
    reach: f64,
    fold: Option<Deformation>,
}

/// A segment with the normals of its planes, which sweep along it.
#[derive(Clone, Debug)]
struct Stalk {
    ends: [usize; 2],
    base: DVec3,
    along: DVec3,
    normals: [DVec3; 2],
    length: f64,
    /// Whether the next segment goes on from its end, with the same plane.
    joined: bool,
    /// Whether the ends are ends of the skeleton, or branches.
    loose: [bool; 2],
}

/// A piece of a limb.
#[derive(Clone, Debug)]
struct Part {
    limb: usize,
    /// Arc lengths of the piece's ends.
    stretch: [f64; 2],
    primitive: [Primitive; 1],
    bounds: Pieces,
}

/// Places of a limb whose planes may meet a ball.
#[derive(Clone, Copy, Debug)]
struct Cluster {
    limb: usize,
    /// Interval of the limb, as fractions of its length.
    parts: [f64; 2],
    /// Sides of the ball on which the planes before and behind the interval are; 0 at an end of the
    /// limb.
    sides: [i8; 2],
    /// Whether there is a place for every point of the ball, in this cluster or in the others of
    /// its chain.
    lasting: bool,
    /// First of the clusters that continue each other from limb to limb.
    chain: usize,
    range: Range,
}

/// The steepest slope of the window, times its reach.
const STEEP: f64 = 1.5 * 3.0;

impl SkeletonTerms {
    /// Prepares a skeleton.
    pub fn new(
        points: &[DVec3],
        limbs: &[Limb],
        reach: f64,
        fold: Option<Deformation>,
    ) -> Result<Self, LocalError> {
        let direction = |limb: &Limb| {
            let [a, b] = limb.ends.map(|end| points[end as usize]);
            (b - a).normalize()
        };
        let mut stalks = Vec::new();
        let mut pieces = Vec::new();
        let n = points.len();
        let mut between = vec![vec![f64::INFINITY; n]; n];
        for (i, limb) in limbs.iter().enumerate() {
            let ends = limb.ends.map(|end| end as usize);
            let normals = [0, 1].map(|end| match limb.next[end] {
                None => direction(limb),
                Some(next) => {
                    let next = &limbs[next as usize];
                    let turned = next.ends[end] == limb.ends[end];
                    let other = if turned {
                        -direction(next)
                    } else {
                        direction(next)
                    };
                    (direction(limb) + other).normalize()
                }
            });
            let follows = limb.next[1] == Some(i as u32 + 1);
            let mut from = 0.0;
            for (primitive, length) in &limb.pieces {
                pieces.push(Part {
                    limb: i,
                    stretch: [from, from + length],
                    bounds: Pieces::new(core::slice::from_ref(primitive)),
                    primitive: [primitive.clone()],
                });
                from += length;
            }
            stalks.push(Stalk {
                ends,
                base: points[ends[0]],
                along: points[ends[1]] - points[ends[0]],
                normals,
                length: from,
                joined: follows && limbs[i + 1].ends[0] == limb.ends[1],
                loose: [0, 1].map(|end| limb.next[end].is_none()),
            });
            for [a, b] in [ends, [ends[1], ends[0]]] {
                between[a][b] = between[a][b].min(from);
            }
        }
        for (i, row) in between.iter_mut().enumerate() {
            row[i] = 0.0;
        }
        for k in 0..n {
            for i in 0..n {
                for j in 0..n {
                    between[i][j] = between[i][j].min(between[i][k] + between[k][j]);
                }
            }
        }
        Ok(Self {
            local: Local::new(points, limbs, reach)?,
            limbs: stalks,
            pieces,
            between,
            reach,
            fold,
        })
    }

    /// Returns the distance along the skeleton between two places.
    fn distance(&self, a: Place, b: Place) -> f64 {
        let [one, other] = [a, b].map(|place| &self.limbs[place.segment as usize]);
        let mut least = f64::INFINITY;
        if a.segment == b.segment {
            least = (a.along - b.along).abs();
        }
        for (i, here) in [a.along, one.length - a.along].into_iter().enumerate() {
            for (k, there) in [b.along, other.length - b.along].into_iter().enumerate() {
                least = least.min(here + self.between[one.ends[i]][other.ends[k]] + there);
            }
        }
        least
    }

    /// Returns all places of a point: those whose planes hold it, ends and branches.
    fn places(&self, point: DVec3) -> Vec<Place> {
        let mut found = Vec::new();
        for (number, limb) in (0..).zip(&self.limbs) {
            let [a, b, c] = limb.polynomial(point);
            let mut tell = |u: f64| {
                if (-1e-9..=1.0 + 1e-9).contains(&u) {
                    let along = u.clamp(0.0, 1.0) * limb.length;
                    let segment = number;
                    found.push(Place { segment, along });
                }
            };
            let discriminant = b * b - 4.0 * a * c;
            if discriminant >= 0.0 {
                let q = -0.5 * (b + discriminant.sqrt().copysign(b));
                tell(c / q);
                tell(q / a);
            }
            for end in [0, 1] {
                if limb.loose[end] {
                    let along = if end == 0 { 0.0 } else { limb.length };
                    let segment = number;
                    found.push(Place { segment, along });
                }
            }
        }
        found
    }

    /// Evaluates the field at a point.
    pub fn sample(&self, point: DVec3) -> Evaluation {
        let places = self.places(point);
        let jets: Vec<_> = places
            .iter()
            .map(|place| self.local.stretch_at(*place, point))
            .collect();
        let first = (0..jets.len()).max_by(|a, b| jets[*a].value.total_cmp(&jets[*b].value));
        let Some(first) = first else {
            return evaluation(0.0, DVec3::ZERO);
        };
        let own = jets[first];
        let (mut value, mut gradient) = (own.value, DVec3::from_array(own.gradient));
        if let Some(fold) = &self.fold {
            let second = (0..jets.len())
                .filter(|i| self.distance(places[first], places[*i]) > 2.0 * self.reach);
            let second = second.max_by(|a, b| jets[*a].value.total_cmp(&jets[*b].value));
            if let Some(second) = second {
                let other = jets[second];
                let pressed = value + fold.value(other.value);
                if value > 1.0 && other.value > 1.0 && pressed < 0.5 * (value + 1.0) {
                    (value, gradient) = (0.5 * (value + 1.0), 0.5 * gradient);
                } else {
                    value = pressed;
                    gradient += fold.slope(other.value) * DVec3::from_array(other.gradient);
                }
            }
        }
        evaluation(value, gradient)
    }

    /// Returns the least and the largest value in a ball.
    pub fn range(&mut self, center: DVec3, radius: f64) -> Range {
        let clusters = self.clusters(center, radius);
        let mut floor = 0.0f64;
        for cluster in clusters.iter().filter(|c| c.lasting) {
            let chain = clusters.iter().filter(|c| c.chain == cluster.chain);
            floor = floor.max(chain.map(|c| c.range.low).fold(f64::INFINITY, f64::min));
        }
        let high = clusters.iter().map(|c| c.range.high).fold(0.0, f64::max);
        let first = Range { low: floor, high };
        let Some(fold) = &self.fold else {
            return first;
        };
        let middle = |c: &Cluster| {
            let length = self.limbs[c.limb].length;
            let [a, b] = c.parts.map(|part| part * length);
            let segment = c.limb as u32;
            let along = 0.5 * (a + b);
            (Place { segment, along }, 0.5 * (b - a))
        };
        let far = 2.0 * self.reach;
        let mut second = Range {
            low: f64::INFINITY,
            high: 0.0,
        };
        for leader in clusters.iter().filter(|c| c.range.high >= floor) {
            let (place, half) = middle(leader);
            let mut least = 0.0f64;
            for cluster in &clusters {
                let (other, about) = middle(cluster);
                let apart = self.distance(place, other);
                if apart + half + about > far {
                    second.high = second.high.max(cluster.range.high);
                }
                // A cluster alone in its chain is there wherever it is lasting.
                let alone = clusters.iter().filter(|c| c.chain == cluster.chain).count() == 1;
                if apart - half - about > far && cluster.lasting && alone {
                    least = least.max(cluster.range.low);
                }
            }
            second.low = second.low.min(least);
        }
        second.low = second.low.min(second.high);
        let pressed = fold.range(Range {
            low: second.low,
            high: second.high.min(1.0),
        });
        let below = pressed.low.min(0.0);
        Range {
            low: if floor > 1.0 {
                0.5 * (floor + 1.0) + below
            } else {
                floor + below
            },
            high: high + pressed.high.max(0.0),
        }
    }

    /// Returns the places whose planes may meet a ball, with the ranges of their fields.
    fn clusters(&mut self, center: DVec3, radius: f64) -> Vec<Cluster> {
        let mut found: Vec<Cluster> = Vec::new();
        for (number, limb) in self.limbs.iter().enumerate() {
            limb.clusters(center, radius, |parts, sides| {
                let chain = found.len();
                found.push(Cluster {
                    limb: number,
                    parts,
                    sides,
                    lasting: false,
                    chain,
                    range: Range {
                        low: 0.0,
                        high: 0.0,
                    },
                });
            });
        }
        // Clusters that go on in the next limb: planes on both sides of the ball mean one through
        // each of its points.
        let mut i = 0;
        while i < found.len() {
            let mut last = i;
            while let Some(next) = found.get(last + 1)
                && self.limbs[found[last].limb].joined
                && found[last].parts[1] >= 1.0
                && next.limb == found[last].limb + 1
                && next.parts[0] <= 0.0
            {
                last += 1;
            }
            let (from, to) = (found[i].sides[0], found[last].sides[1]);
            for cluster in &mut found[i..=last] {
                cluster.chain = i;
                cluster.lasting = from * to < 0;
            }
            i = last + 1;
        }
        for (number, limb) in self.limbs.iter().enumerate() {
            for end in [0, 1] {
                if limb.loose[end] {
                    let chain = found.len();
                    found.push(Cluster {
                        limb: number,
                        parts: [end as f64; 2],
                        sides: [0; 2],
                        lasting: true,
                        chain,
                        range: Range {
                            low: 0.0,
                            high: 0.0,
                        },
                    });
                }
            }
        }
        let mut known: Vec<Option<Magnitudes>> = vec![None; self.pieces.len()];
        for cluster in &mut found {
            cluster.range = self.field(cluster, center, radius, &mut known);
        }
        found
    }

    /// Returns the range of the fields of a cluster's places.
    fn field(
        &mut self,
        cluster: &Cluster,
        center: DVec3,
        radius: f64,
        known: &mut [Option<Magnitudes>],
    ) -> Range {
        let limb = &self.limbs[cluster.limb];
        let (ends, length) = (limb.ends, limb.length);
        let [a, b] = cluster.parts.map(|part| part * length);
        let (along, span) = (0.5 * (a + b), 0.5 * (b - a));
        let steep = STEEP / self.reach;
        let (mut most, mut change) = (0.0, 0.0);
        for (i, piece) in self.pieces.iter_mut().enumerate() {
            let nearest = if piece.limb == cluster.limb {
                (piece.stretch[0] - along)
                    .max(along - piece.stretch[1])
                    .max(0.0)
            } else {
                let other = &self.limbs[piece.limb];
                let starts = [piece.stretch[0], other.length - piece.stretch[1]];
                let mut least = f64::INFINITY;
                for (end, here) in ends.into_iter().zip([along, length - along]) {
                    for (start, there) in other.ends.into_iter().zip(starts) {
                        least = least.min(here + self.between[end][start] + there);
                    }
                }
                least
            };
            if nearest - span >= self.reach {
                continue;
            }
            let bounds = known[i]
                .get_or_insert_with(|| piece.bounds.extent(&piece.primitive, center, radius, None));
            most += bounds.above;
            change += bounds.slope * radius + (steep * span).min(1.0) * bounds.above;
        }
        let segment = cluster.limb as u32;
        let value = self
            .local
            .stretch_at(Place { segment, along }, center)
            .value;
        let slack = 1e-9 * (1.0 + value);
        let low = value - change - slack;
        Range {
            low: if low > 0.0 { low } else { 0.0 },
            high: most.min(value + change) + slack,
        }
    }
}

impl Stalk {
    /// Returns `d(u)·(p − r(u))` as a polynomial `au² + bu + c`.
    fn polynomial(&self, point: DVec3) -> [f64; 3] {
        let [first, last] = self.normals;
        let (turn, away) = (last - first, point - self.base);
        [
            -turn.dot(self.along),
            turn.dot(away) - first.dot(self.along),
            first.dot(away),
        ]
    }

    /// Calls `tell` with the intervals of parts whose planes may meet a ball, in order, and the
    /// sides of the ball on which the planes before and behind them are.
    fn clusters(&self, center: DVec3, radius: f64, mut tell: impl FnMut([f64; 2], [i8; 2])) {
        let [a, b, c] = self.polynomial(center);
        let steepest = b.abs() + 2.0 * a.abs();
        // Normals are no longer than 1.
        let reach = radius * (1.0 + 1e-9) + 1e-9 * self.length;
        let finest = (0.5 * radius / self.length).clamp(1e-12, 0.125);
        let mut before = 0;
        let mut open: Option<([f64; 2], i8)> = None;
        let mut waiting = vec![[0.0, 1.0]];
        while let Some([from, to]) = waiting.pop() {
            let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
            let value = c + middle * (b + middle * a);
            if value.abs() > reach + steepest * half {
                let side = if value > 0.0 { 1 } else { -1 };
                if let Some((parts, first)) = open.take() {
                    tell(parts, [first, side]);
                }
                before = side;
            } else if half > finest {
                waiting.push([middle, to]);
                waiting.push([from, middle]);
            } else {
                match &mut open {
                    Some((parts, _)) => parts[1] = to,
                    None => open = Some(([from, to], before)),
                }
            }
        }
        if let Some((parts, first)) = open {
            tell(parts, [first, 0]);
        }
    }
}

/// Returns the evaluation of a value and gradient with their rounding.
fn evaluation(value: f64, gradient: DVec3) -> Evaluation {
    Evaluation {
        excess: value - 1.0,
        gradient,
        noise: FIELD_ERROR * (1.0 + value.abs()),
        slope_noise: f64::INFINITY,
    }
}
