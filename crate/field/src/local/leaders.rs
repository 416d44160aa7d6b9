//! Bounds on the largest of the stretches in a ball, and on the largest one that is far from it.
use super::survey::{Bounds, Survey};
use super::{FAINT, Local};
use crate::Ball;

/// Bounds on the fields of the stretches of interest in a ball, see [`Local::two`] for what they
/// are.
#[derive(Clone, Copy, Debug)]
pub struct Two {
    /// The largest stretch.
    pub first: Bounds,
    /// The largest one that is far from it, or the level below which that is of no interest, if it
    /// is more; `None` if none is above the level.
    pub second: Option<Bounds>,
}

/// Candidates that may be the largest.
struct Leaders {
    floor: f64,
    members: Vec<usize>,
}

/// Balls with a larger radius, in reaches, are not looked at closely.
const COARSE: f64 = 0.25;
/// More chains than this that may lead are not compared with each other.
const MOST_COMPARED: usize = 8;

impl Leaders {
    fn above(survey: &Survey, floor: f64, of: impl Fn(usize) -> bool) -> Self {
        let all = &survey.all;
        let members = (0..all.len()).filter(|i| all[*i].most >= floor && of(*i));
        Self {
            floor,
            members: members.collect(),
        }
    }

    /// Bounds on the largest of them. Where they are less than `floor`, that counts in their place.
    fn bounds(&self, survey: &Survey) -> Bounds {
        let mut own = Bounds {
            value: [self.floor; 2],
            slope: 0.0,
            curvature: 0.0,
            jump: 0.0,
        };
        // For each chain its gradient at the centre, and how much that changes.
        let mut chains: Vec<(usize, Option<glam::DVec3>, f64)> = Vec::new();
        let radius = survey.ball.radius;
        for candidate in self.members.iter().map(|i| &survey.all[*i]) {
            let Some(known) = &candidate.known else {
                // None has been looked at that is below the floor.
                own.value[1] = own.value[1].max(candidate.most);
                (own.slope, own.curvature) = (f64::INFINITY, f64::INFINITY);
                continue;
            };
            let bounds = &known.bounds;
            own.value[1] = own.value[1].max(bounds.value[1]);
            own.slope = own.slope.max(bounds.slope);
            own.curvature = own.curvature.max(bounds.curvature);
            let changes = bounds.curvature * radius;
            match chains.iter_mut().find(|chain| chain.0 == candidate.chain) {
                Some(chain) => {
                    chain.1 = chain.1.or(known.gradient);
                    chain.2 = chain.2.max(changes);
                    own.jump += bounds.jump;
                }
                None => {
                    chains.push((candidate.chain, known.gradient, changes));
                    own.jump += bounds.jump;
                }
            }
        }
        let most = 2.0 * own.slope;
        if chains.len() > MOST_COMPARED {
            own.jump = most;
        } else if chains.len() > 1 {
            let mut differ = 0.0f64;
            for (i, a) in chains.iter().enumerate() {
                for b in &chains[..i] {
                    differ = differ.max(match (a.1, b.1) {
                        (Some(one), Some(other)) => one.distance(other) + a.2 + b.2,
                        _ => most,
                    });
                }
            }
            own.jump = (own.jump + differ).min(most);
        }
        own
    }
}

impl Local {
    /// Bounds on the largest stretch in a ball and, if a level is given, on the largest one more
    /// than 2D away from it along the skeleton, or the level where that is more.
    #[must_use]
    pub fn enclose_two(&self, ball: Ball, level: Option<f64>) -> Two {
        let everything = self.everything(&ball);
        let faint = |low: f64| Bounds {
            value: [low, everything.max(low)],
            slope: f64::INFINITY,
            curvature: f64::INFINITY,
            jump: f64::INFINITY,
        };
        // In balls that large hardly anything is decided, and nearly all of the skeleton would have
        // to be looked at.
        if everything < FAINT || ball.radius > COARSE * self.reach() {
            return Two {
                first: faint(0.0),
                second: level.map(faint),
            };
        }
        // Cells know no second stretch that is fainter.
        let terms = match level {
            Some(level) if level < FAINT => &self.terms,
            _ => self.terms_in(&ball, level.is_some()),
        };
        let mut survey = Survey::new(self, ball, terms);
        let floor = survey.floor();
        let from = level.map_or(floor, |level| level.min(floor));
        for i in 0..survey.all.len() {
            if survey.all[i].most >= from && survey.most(i) >= from {
                survey.look(i);
            }
        }
        let floor = survey.least(|_, _| true).max(floor);
        let leaders = Leaders::above(&survey, floor, |_| true);
        let mut first = leaders.bounds(&survey);
        first.value[1] = first.value[1].min(everything).max(first.value[0]);
        Two {
            first,
            second: level.and_then(|level| second(&survey, &leaders, level)),
        }
    }
}

/// Bounds on the largest stretch that is far from those that lead, or a level, if that is more;
/// `None` if none is above the level.
fn second(survey: &Survey, leaders: &Leaders, level: f64) -> Option<Bounds> {
    let far = 2.0 * survey.local.reach();
    // For each candidate and each leader the least and the largest distance between them, if the
    // candidate is of interest.
    let all = &survey.all;
    let count = leaders.members.len();
    let mut distances = vec![[0.0; 2]; all.len() * count];
    let mut is_any = false;
    for (i, candidate) in all.iter().enumerate().filter(|(_, c)| c.most >= level) {
        for (k, leader) in leaders.members.iter().enumerate() {
            let leader = &all[*leader];
            // Along one chain they are 0 apart.
            if candidate.chain != leader.chain {
                let ((a, half_a), (b, half_b)) = (survey.middle(candidate), survey.middle(leader));
                let distance = survey.local.distance(a, b);
                let most = distance + half_a + half_b;
                distances[i * count + k] = [distance - half_a - half_b, most];
                is_any |= most > far;
            }
        }
    }
    if !is_any {
        return None;
    }
    let of = |i: usize| &distances[i * count..(i + 1) * count];
    let floor = (0..count)
        .map(|k| survey.least(|i, _| of(i)[k][0] > far))
        .fold(f64::INFINITY, f64::min)
        .max(level);
    let seconds = Leaders::above(survey, floor, |i| of(i).iter().any(|d| d[1] > far));
    let mut own = seconds.bounds(survey);
    let are_apart = seconds.members.iter().all(|&i| {
        let mut pairs = leaders.members.iter().zip(of(i));
        pairs.all(|(k, d)| all[i].chain == all[*k].chain || d[0] > far)
    });
    if !are_apart {
        own.slope = f64::INFINITY;
        own.curvature = f64::INFINITY;
        own.jump = f64::INFINITY;
    } else if count > 1 && !seconds.members.is_empty() {
        // Which one is second may change with which one is first.
        let mut chains = leaders.members.iter().map(|i| all[*i].chain);
        let first = chains.next();
        if chains.any(|chain| Some(chain) != first) {
            own.jump = 2.0 * own.slope;
        }
    }
    Some(own)
}
