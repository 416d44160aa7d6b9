//! Runs in turn, so that what disturbs one disturbs the other as well.

use anyhow::Result;

/// Rounds of two programs that are compared.
pub const ROUNDS: usize = 7;

/// Seconds of several runs of the same.
#[derive(Clone, Debug, Default)]
pub struct Runs(Vec<f64>);

impl Runs {
    /// One run more.
    pub fn add(&mut self, seconds: f64) {
        self.0.push(seconds);
    }

    /// The quickest, which was disturbed least.
    pub fn best(&self) -> f64 {
        self.0.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// How much longer than the quickest the middle one took, as a share.
    pub fn spread(&self) -> f64 {
        let mut sorted = self.0.clone();
        sorted.sort_by(f64::total_cmp);
        match sorted.get(sorted.len() / 2) {
            Some(middle) => middle / self.best() - 1.0,
            None => 0.0,
        }
    }

    /// `seconds ± spread`.
    pub fn text(&self) -> String {
        format!("{:.4} +{:.0} %", self.best(), 100.0 * self.spread())
    }
}

/// Runs all of them in turn, so many rounds.
pub fn alternate<const N: usize>(
    rounds: usize,
    mut run: [&mut dyn FnMut() -> Result<f64>; N],
) -> Result<[Runs; N]> {
    let mut runs = std::array::from_fn(|_| Runs::default());
    for _ in 0..rounds {
        for (runs, run) in runs.iter_mut().zip(&mut run) {
            let runs: &mut Runs = runs;
            runs.add(run()?);
        }
    }
    Ok(runs)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_quickest_counts_and_the_middle_tells_the_spread() {
        let mut seconds = [3.0, 2.0, 4.0].into_iter();
        let [runs, ones] = alternate(
            3,
            [&mut || Ok(seconds.next().unwrap_or(9.0)), &mut || Ok(1.0)],
        )
        .unwrap();
        assert_eq!((runs.best(), ones.best()), (2.0, 1.0));
        assert!((runs.spread() - 0.5).abs() < 1e-12);
        assert!(alternate(1, [&mut || anyhow::bail!("no")]).is_err());
    }
}
