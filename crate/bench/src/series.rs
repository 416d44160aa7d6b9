//! Runs in turn, so that what disturbs one disturbs the other as well.

use crate::report::Short;
use anyhow::Result;
use std::fmt::{Display, Formatter};

/// Seconds of several runs of the same.
#[derive(Clone, Debug, Default)]
pub struct Runs(Vec<f64>);

impl Runs {
    /// Adds a run.
    pub fn add(&mut self, seconds: f64) {
        self.0.push(seconds);
    }

    /// The quickest, which was disturbed least.
    pub fn best(&self) -> f64 {
        self.0.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// Returns the quickest time as a multiple of that of others.
    pub fn over(&self, others: &Self) -> Short {
        Short(self.best() / others.best())
    }
}

/// The quickest, and how much longer the middle one took.
impl Display for Runs {
    fn fmt(&self, f: &mut Formatter) -> std::fmt::Result {
        let mut sorted = self.0.clone();
        sorted.sort_by(f64::total_cmp);
        let (best, middle) = (self.best(), sorted[sorted.len() / 2]);
        write!(f, "{best:.4} +{:.0} %", 100.0 * (middle / best - 1.0))
    }
}

/// Runs the first to the `N`th of something in turn, so many rounds; each run gives its seconds.
pub fn in_turn<const N: usize>(
    rounds: usize,
    mut run: impl FnMut(usize) -> Result<f64>,
) -> Result<[Runs; N]> {
    let mut all = std::array::from_fn(|_| Runs::default());
    for _ in 0..rounds {
        for (i, runs) in all.iter_mut().enumerate() {
            runs.add(run(i)?);
        }
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_quickest_counts_and_the_middle_tells_the_spread() {
        let mut seconds = [3.0, 1.0, 2.0, 1.0, 4.0, 1.0].into_iter();
        let [runs, ones] = in_turn(3, |_| Ok(seconds.next().unwrap())).unwrap();
        assert_eq!(runs.over(&ones), Short(2.0));
        assert_eq!(runs.to_string(), "2.0000 +50 %");
        assert!(in_turn::<1>(1, |_| anyhow::bail!("no")).is_err());
    }
}
