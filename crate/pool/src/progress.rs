//! Progress of a picture, and the costs of its tiles from which the remaining time is predicted.

use tracer::{Pass, Stats};

/// Progress of a picture, for the progress bar and for scripts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Progress {
    /// The number of the picture, if one was ever started.
    pub generation: Option<u64>,
    /// Share of the work done, 0 … 1. Never falls while one picture is traced.
    pub fraction: f64,
    /// The pass that is being traced; `None` when nothing is being done.
    pub pass: Option<Pass>,
    /// Whether all tiles of all passes are done, or given up.
    pub finished: bool,
    /// Estimated time left; `None` until enough tiles were measured.
    pub remaining_seconds: Option<f64>,
    /// Seconds from the start to now, or to the end of the picture.
    pub seconds: f64,
    /// Seconds from the start to the end of each pass: coarse, full, smooth.
    pub pass_seconds: [Option<f64>; 3],
    /// Workers that run or are being started.
    pub workers: usize,
    /// Workers replaced because they died or hung, since the page was opened.
    pub restarted: u32,
    /// Tiles given up because three workers failed at them.
    pub failed_tiles: u32,
    /// The work done for this picture.
    pub stats: Stats,
    /// Error message for the user, if there was an error.
    pub error: Option<String>,
}

/// Typical cost of a tile in the passes, in units of the coarse one; used until it is measured.
const TYPICAL: [f64; 3] = [1.0, 30.0, 20.0];
/// Tiles that must have been measured before a remaining time is predicted.
const ENOUGH: u32 = 4;

/// Measured time of the tiles of one pass.
#[derive(Clone, Debug, Default)]
struct Measured {
    tiles: u32,
    seconds: f64,
    slowest: f64,
}

/// Costs of the tiles of a picture: measured where possible, else scaled from other passes.
#[derive(Clone, Debug, Default)]
pub(crate) struct Costs {
    passes: [Measured; 3],
}

impl Costs {
    /// Adds the measured time of a tile.
    pub fn add(&mut self, pass: usize, seconds: f64) {
        let measured = &mut self.passes[pass];
        measured.tiles += 1;
        measured.seconds += seconds;
        measured.slowest = measured.slowest.max(seconds);
    }

    /// Estimates the seconds of one tile of a pass; a bare guess if nothing was measured.
    pub fn estimate(&self, pass: usize) -> f64 {
        // The pass itself, else the finest one measured.
        let mut bases = [pass, 2, 1, 0].into_iter();
        let base = bases.find(|i| self.passes[*i].tiles > 0);
        base.map_or(TYPICAL[pass] * 1e-3, |i| {
            let mean = self.passes[i].seconds / f64::from(self.passes[i].tiles);
            mean.max(1e-6) * TYPICAL[pass] / TYPICAL[i]
        })
    }

    /// Returns the seconds of the slowest tile of a pass; 0 if none was measured.
    pub fn slowest(&self, pass: usize) -> f64 {
        self.passes[pass].slowest
    }

    /// Whether enough was measured to predict a time.
    pub fn enough(&self) -> bool {
        self.passes.iter().map(|pass| pass.tiles).sum::<u32>() >= ENOUGH
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn costs_are_measured_or_scaled_from_what_was_measured() {
        let mut costs = Costs::default();
        assert!(!costs.enough());
        costs.add(0, 0.002);
        costs.add(0, 0.004);
        assert!((costs.estimate(0) - 0.003).abs() < 1e-12);
        assert!((costs.estimate(1) - 0.003 * TYPICAL[1]).abs() < 1e-12);
        costs.add(1, 0.05);
        assert!((costs.estimate(2) - 0.05 * TYPICAL[2] / TYPICAL[1]).abs() < 1e-12);
        assert!((costs.slowest(0) - 0.004).abs() < 1e-12);
        costs.add(1, 0.05);
        assert!(costs.enough());
    }
}
