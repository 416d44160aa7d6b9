//! The resolution at which frames keep up with a hand.
//!
//! Frames become coarser where they are late, and finer after some that are early. How long a frame
//! took is known to within the time from one frame of the screen to the next, as cards are asked
//! then.

/// Seconds of a frame above which the next one is coarser.
const LATE: f64 = 0.05;
/// Seconds of a frame below which a finer one is tried: it was there at the next frame of a screen
/// with 60 of them a second.
const EARLY: f64 = 0.0205;
/// Early frames in sequence after which a finer one is tried, once one was late.
const CALM: u32 = 12;
/// Number of steps from a frame with all pixels to the coarsest. Each halves the number of pixels.
const COARSEST: i32 = 8;
/// The step of the first frame: nobody knows yet what it costs.
const FIRST: i32 = 4;
/// Most seconds of a frame that is drawn once a hand rests.
const REST: f64 = 0.4;
/// Most seconds of one with four rays for each pixel.
const FOUR: f64 = 0.15;

/// Finds the resolution of frames from the time that they take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pace {
    step: i32,
    early: u32,
    was_late: bool,
    /// Estimate of the seconds for a frame with all pixels.
    seconds: Option<f64>,
}

impl Default for Pace {
    fn default() -> Self {
        Self {
            step: FIRST,
            early: 0,
            was_late: false,
            seconds: None,
        }
    }
}

impl Pace {
    /// Returns the share of a picture's sides that a frame has while something moves.
    #[must_use]
    pub fn scale(&self) -> f64 {
        libm::exp2(-0.5 * f64::from(self.step))
    }

    /// Takes note of the seconds that a frame took whose sides were some share of the picture's.
    pub fn note(&mut self, seconds: f64, scale: f64) {
        self.seconds = Some(seconds / (scale * scale).max(1e-6));
        if seconds > LATE {
            let steps = libm::ceil(libm::log2(seconds / LATE)).clamp(1.0, 4.0) as i32;
            self.step = (self.step + steps).min(COARSEST);
            self.early = 0;
            self.was_late = true;
        } else if seconds < EARLY {
            self.early += 1;
            if !self.was_late || self.early >= CALM {
                self.step = (self.step - 1).max(0);
                self.early = 0;
            }
        } else {
            self.early = 0;
        }
    }

    /// Returns the share of a picture's sides that a frame has once nothing moves: 2 for four rays
    /// a pixel, where the card is quick.
    #[must_use]
    pub fn still(&self) -> f64 {
        match self.seconds {
            // Early frames may have taken far less than was measured.
            Some(seconds) if 4.0 * seconds <= FOUR => 2.0,
            Some(seconds) if seconds > REST => libm::sqrt(REST / seconds).max(self.scale()),
            _ => 1.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the scales of frames on a card that takes some seconds for one with all pixels, as a
    /// screen of 60 frames a second sees it.
    fn scales(pace: &mut Pace, whole: f64, frames: usize) -> Vec<f64> {
        let scales = (0..frames).map(|_| {
            let scale = pace.scale();
            let frames = libm::ceil(60.0 * whole * scale * scale).max(1.0);
            pace.note(frames / 60.0, scale);
            scale
        });
        scales.collect()
    }

    #[test]
    fn quick_cards_soon_draw_all_pixels() {
        let mut pace = Pace::default();
        assert!(pace.scale() < 0.3);
        let all = scales(&mut pace, 0.005, 10);
        assert_eq!(all.last(), Some(&1.0));
        assert_eq!(pace.still(), 2.0);
    }

    #[test]
    fn slow_cards_keep_up_with_few_pixels() {
        for whole in [0.1, 1.0, 5.0] {
            let mut pace = Pace::default();
            let all = scales(&mut pace, whole, 200);
            let late = all
                .iter()
                .skip(10)
                .filter(|scale| whole * *scale * *scale > LATE);
            assert!(late.count() <= 20, "{whole} {all:?}");
            let last = all[190..].iter().fold(f64::INFINITY, |a, b| a.min(*b));
            assert!(last >= 0.06, "{whole} {all:?}");
            let still = pace.still();
            assert!(whole * still * still <= 2.5 * REST, "{whole} {still}");
        }
    }

    #[test]
    fn one_late_frame_is_no_reason_for_ever() {
        let mut pace = Pace::default();
        scales(&mut pace, 0.005, 20);
        pace.note(0.3, 1.0);
        assert!(pace.scale() < 0.6);
        let all = scales(&mut pace, 0.005, 8 * CALM as usize);
        assert_eq!(all.last(), Some(&1.0));
    }
}
