//! The time that a picture still takes, from the costs of its finished tiles.

/// Seconds of a picture before which no time is told.
const SILENCE: f64 = 1.0;
/// Seconds between two looks at the tiles.
const PERIOD: f64 = 0.25;
/// Seconds in which an end that is told goes half its way to a new one.
const CALM: f64 = 2.0;

/// A tile in a pass: what it was expected to cost, and what it cost once it is finished, seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Task {
    pub expected: f64,
    pub taken: Option<f64>,
}

/// Computes the seconds of work that the open tasks of one pass take: the sum of what is expected
/// of them, times the median of taken/expected over the finished ones, each as heavy as what was
/// expected of it, so that many cheap tiles do not speak for few dear ones.
pub fn work_left(tasks: &[Task]) -> f64 {
    let mut ratios: Vec<(f64, f64)> = Vec::new();
    let mut open = 0.0;
    for task in tasks {
        match task.taken {
            Some(taken) if task.expected > 0.0 => {
                ratios.push((taken / task.expected, task.expected))
            }
            Some(_) => {}
            None => open += task.expected,
        }
    }
    ratios.sort_by(|a, b| a.0.total_cmp(&b.0));
    let half = 0.5 * ratios.iter().map(|(_, weight)| weight).sum::<f64>();
    let mut below = 0.0;
    let median = ratios.iter().find(|(_, weight)| {
        below += weight;
        below >= half
    });
    open * median.map_or(1.0, |(ratio, _)| *ratio)
}

/// The end of a picture as it is told: later looks move it by degrees.
#[derive(Clone, Debug, Default)]
pub struct Forecast {
    /// Time of the last look, and the end told then, seconds.
    told: Option<(f64, f64)>,
}

impl Forecast {
    /// Whether the tiles should be looked at, `now`, in a picture that was begun at `begun`.
    pub fn is_due(&self, begun: f64, now: f64) -> bool {
        now - begun >= SILENCE && self.told.is_none_or(|(at, _)| now - at >= PERIOD)
    }

    /// Takes in that the picture takes `left` more seconds from `now` on.
    pub fn note(&mut self, left: f64, now: f64) {
        let end = now + left;
        let end = self.told.map_or(end, |(at, before)| {
            let passed = (now - at).max(0.0);
            before + (end - before) * passed / (CALM + passed)
        });
        self.told = Some((now, end));
    }

    /// Returns the seconds that are left; `None` before anything is known.
    pub fn remaining(&self, now: f64) -> Option<f64> {
        self.told.map(|(_, end)| (end - now).max(0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use trials::Random;

    /// Checks that from a fifth of the work on the told time is within a factor of two of the
    /// true one, and moves by less than a fifth of it (or a second) at a look. Tiles cost
    /// `cost(place)`, place 0 … 1 in their order; the cheaper pass told it up to a factor `noise`.
    fn check(name: &str, noise: f64, cost: impl Fn(f64) -> f64) {
        let mut random = Random::fixed(7);
        let costs: Vec<f64> = (0..400).map(|i| cost(f64::from(i) / 400.0)).collect();
        let all: f64 = costs.iter().sum();
        // The whole takes a minute; the cheaper pass knows costs up to a common factor of 30.
        let costs: Vec<f64> = costs.iter().map(|cost| cost * 60.0 / all).collect();
        let mut tasks: Vec<Task> = costs
            .iter()
            .map(|cost| Task {
                expected: cost / 30.0 * random.range(1.0 / noise, noise),
                taken: None,
            })
            .collect();
        let (mut forecast, mut now, mut told) = (Forecast::default(), 0.0, 0);
        for (i, cost) in costs.iter().enumerate() {
            now += cost;
            tasks[i].taken = Some(*cost);
            if forecast.is_due(0.0, now) {
                let before = forecast.remaining(now);
                forecast.note(work_left(&tasks), now);
                let after = forecast.remaining(now).unwrap();
                if let Some(before) = before.filter(|_| now > 12.0) {
                    let jump = (after - before).abs();
                    assert!(jump < (0.2 * before).max(1.0), "{name}: {before} → {after}");
                }
            }
            let Some(left) = forecast.remaining(now) else {
                assert!(now < 1.0, "{name}: nothing told at {now}");
                continue;
            };
            assert!(now >= 1.0, "{name}: told at {now}");
            if (12.0..58.0).contains(&now) {
                let truth = 60.0 - now;
                assert!(
                    left > 0.5 * truth && left < 2.0 * truth,
                    "{name}: {left} s told of {truth} s at {now} s"
                );
                told += 1;
            }
        }
        assert!(told > 10, "{name}: told {told} times");
    }

    #[test]
    fn time_left_is_within_a_factor_of_two_from_a_fifth_on() {
        for noise in [1.0, 1.5] {
            check("even", noise, |_| 1.0);
            check(
                "front-loaded",
                noise,
                |place| if place < 0.2 { 20.0 } else { 1.0 },
            );
            check(
                "back-loaded",
                noise,
                |place| if place > 0.8 { 20.0 } else { 1.0 },
            );
        }
    }

    #[test]
    fn one_tile_that_hung_does_not_move_the_time_left() {
        let mut tasks = vec![
            Task {
                expected: 1.0,
                taken: Some(2.0)
            };
            50
        ];
        let open = Task {
            expected: 1.0,
            taken: None,
        };
        tasks.extend([open; 50]);
        tasks[3].taken = Some(500.0);
        assert!((work_left(&tasks) - 100.0).abs() < 1e-9);
    }
}
