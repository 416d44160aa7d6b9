//! An animated work as a film: its length and rate, and playing its frames one after another.

use serde::{Deserialize, Serialize};

/// Most frames of a film.
pub const MAX_FRAMES: u32 = 240;
/// Frames in a second, at first.
pub const RATE: u16 = 12;
/// Most frames in a second: a GIF file holds no more.
pub const MAX_RATE: u16 = 50;

/// The order of frames after the last one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Playback {
    /// The film ends.
    Once,
    /// The film begins again with the first frame.
    #[default]
    Loop,
    /// The film runs backwards to the first frame, and so on.
    Mirror,
}

impl Playback {
    /// The choices, in the order of the menu.
    pub const ALL: [Self; 3] = [Self::Once, Self::Loop, Self::Mirror];

    /// Returns the text in the menu.
    #[must_use]
    pub fn label(self) -> &'static str {
        match self {
            Self::Once => "Once",
            Self::Loop => "Loop",
            Self::Mirror => "There and back",
        }
    }

    /// Returns the number of frames of a file that shows `count` frames in this order.
    #[must_use]
    pub fn length(self, count: u32) -> u32 {
        match self {
            Self::Once | Self::Loop => count,
            Self::Mirror => (2 * count).saturating_sub(2).max(count),
        }
    }
}

/// The film's frames and whether they are played.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Player {
    /// Number of frames.
    pub count: u32,
    /// Frames in a second.
    pub rate: u16,
    /// The order after the last frame.
    pub playback: Playback,
    /// Whether a person has chosen the number of frames or their rate.
    pub chosen: bool,
    /// Time of the last frame in seconds on the app's clock, while the film is played.
    playing: Option<f64>,
    /// Whether it is played backwards just now.
    back: bool,
}

impl Default for Player {
    fn default() -> Self {
        Self {
            count: 2 * u32::from(RATE),
            rate: RATE,
            playback: Playback::default(),
            chosen: false,
            playing: None,
            back: false,
        }
    }
}

impl Player {
    /// Takes the rate of a work that has one of its own, and a length of four seconds, unless a
    /// person has chosen others.
    pub fn follow(&mut self, rate: Option<f64>) {
        let Some(rate) = rate.filter(|_| !self.chosen) else {
            return;
        };
        self.rate = (rate.round() as u16).clamp(1, MAX_RATE);
        self.count = (4 * u32::from(self.rate)).clamp(2, MAX_FRAMES);
    }

    /// Whether the film is played.
    #[must_use]
    pub fn is_playing(&self) -> bool {
        self.playing.is_some()
    }

    /// Plays from a frame on, or pauses. Returns the frame to begin with.
    pub fn toggle(&mut self, frame: u32, now: f64) -> u32 {
        if self.playing.take().is_some() {
            return frame;
        }
        self.playing = Some(now);
        self.back = false;
        let is_over = self.playback == Playback::Once && frame + 1 >= self.count;
        if is_over { 0 } else { frame }
    }

    /// Pauses.
    pub fn pause(&mut self) {
        self.playing = None;
    }

    /// Returns the frame to show after `frame` if its time has come. `ready`: `frame` was shown.
    pub fn next(&mut self, frame: u32, ready: bool, now: f64) -> Option<u32> {
        let came = self.playing?;
        if !ready || now - came < 1.0 / f64::from(self.rate.max(1)) {
            return None;
        }
        self.playing = Some(now);
        let last = self.count.saturating_sub(1);
        match self.playback {
            Playback::Once if frame >= last => {
                self.playing = None;
                None
            }
            Playback::Once => Some(frame + 1),
            Playback::Loop => Some(if frame >= last { 0 } else { frame + 1 }),
            Playback::Mirror => {
                if frame >= last {
                    self.back = true;
                } else if frame == 0 {
                    self.back = false;
                }
                Some(if self.back {
                    frame.min(last + 1).saturating_sub(1)
                } else {
                    frame + 1
                })
            }
        }
    }

    /// Returns the seconds until [`Player::next`] may return a frame; `None` while paused.
    #[must_use]
    pub fn wait(&self, now: f64) -> Option<f64> {
        Some((self.playing? + 1.0 / f64::from(self.rate.max(1)) - now).max(0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_come_at_their_rate_and_begin_again() {
        let mut player = Player {
            count: 3,
            ..Player::default()
        };
        assert_eq!(player.next(0, true, 9.0), None, "nothing is played");
        player.toggle(0, 10.0);
        assert_eq!(player.next(0, true, 10.01), None);
        assert_eq!(player.next(0, false, 11.0), None, "it was not seen yet");
        assert_eq!(player.next(0, true, 11.0), Some(1));
        assert!(player.wait(11.0).is_some_and(|wait| wait < 0.1));
        assert_eq!(player.next(2, true, 12.0), Some(0));
        player.toggle(0, 12.1);
        assert_eq!((player.is_playing(), player.wait(13.0)), (false, None));
    }

    /// Returns the frames that are shown one after the other, at most `most`.
    fn play(playback: Playback, count: u32, from: u32, most: usize) -> Vec<u32> {
        let mut player = Player {
            count,
            playback,
            ..Player::default()
        };
        let mut frame = player.toggle(from, 0.0);
        let mut frames = vec![frame];
        for second in 1..most {
            let Some(next) = player.next(frame, true, second as f64) else {
                break;
            };
            frame = next;
            frames.push(frame);
        }
        frames
    }

    #[test]
    fn the_end_is_the_end_or_a_new_beginning_or_the_way_back() {
        assert_eq!(play(Playback::Once, 3, 0, 9), [0, 1, 2]);
        assert_eq!(play(Playback::Once, 3, 2, 9), [0, 1, 2]);
        assert_eq!(play(Playback::Loop, 3, 1, 6), [1, 2, 0, 1, 2, 0]);
        assert_eq!(play(Playback::Mirror, 3, 0, 7), [0, 1, 2, 1, 0, 1, 2]);
        assert_eq!(play(Playback::Mirror, 3, 2, 4), [2, 1, 0, 1]);
        assert_eq!(
            play(Playback::Mirror, 3, 9, 4),
            [9, 2, 1, 0],
            "it became shorter"
        );
        assert_eq!(play(Playback::Loop, 3, 9, 3), [9, 0, 1]);
        assert_eq!(play(Playback::Mirror, 2, 0, 4), [0, 1, 0, 1]);
        for playback in Playback::ALL {
            let order = ::picture::animation::mirror(4).count() as u32;
            let length = if playback == Playback::Mirror {
                order
            } else {
                4
            };
            assert_eq!(playback.length(4), length);
            assert_eq!(playback.length(1), 1);
        }
    }
}
