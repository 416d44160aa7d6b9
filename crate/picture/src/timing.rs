//! The speed of an animation.

use crate::Problem;

/// The speed and the repetition of an animation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Timing {
    /// The time for which each frame is shown, hundredths of a second; 1 or more. Browsers show
    /// frames of a GIF file for 2 at least.
    pub delay: u16,
    /// Whether it begins again after the last frame.
    pub repeats: bool,
}

impl Timing {
    /// Returns the timing whose whole hundredths of a second are nearest to so many frames in a
    /// second.
    ///
    /// # Errors
    /// If there are not 0.01 … 100 frames in a second.
    pub fn new(frames_per_second: f64, repeats: bool) -> Result<Self, Problem> {
        if !(0.01..=100.0).contains(&frames_per_second) {
            return Err(Problem::Speed);
        }
        let delay = (100.0 / frames_per_second).round() as u16;
        Ok(Self { delay, repeats })
    }
}
