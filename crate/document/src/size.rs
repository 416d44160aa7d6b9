//! The size of the traced picture in pixels.

use serde::{Deserialize, Serialize};

/// The user's choice of size.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Choice {
    /// Size of the view, at most [`FIT_PIXELS`].
    #[default]
    Fit,
    /// The dataset's `framesize`.
    Frame,
    /// Twice the dataset's `framesize`.
    Double,
}

impl Choice {
    /// The choices in the order of the menu.
    pub const ALL: [Self; 3] = [Self::Fit, Self::Frame, Self::Double];

    /// Returns the text in the menu.
    #[must_use]
    pub fn label(self) -> &'static str {
        match self {
            Self::Fit => "Fit view",
            Self::Frame => "Frame size",
            Self::Double => "Frame size ×2",
        }
    }
}

/// Most pixels of a picture that fits the view: a second or two of tracing on a laptop.
pub const FIT_PIXELS: f64 = 1_000_000.0;
/// Most pixels of any picture.
pub const MAX_PIXELS: f64 = 16_000_000.0;

/// Returns the picture's size, which has the frame's proportions. `view` is the size of its place
/// in the window in device pixels, `max_side` the longest side of a texture.
#[must_use]
pub fn pixels(choice: Choice, frame: [u32; 2], view: [f32; 2], max_side: u32) -> [u32; 2] {
    let frame = frame.map(|side| f64::from(side.max(1)));
    let (scale, most) = match choice {
        Choice::Fit => {
            let view = view.map(|side| f64::from(side.max(1.0)));
            ((view[0] / frame[0]).min(view[1] / frame[1]), FIT_PIXELS)
        }
        Choice::Frame => (1.0, MAX_PIXELS),
        Choice::Double => (2.0, MAX_PIXELS),
    };
    let scale = scale
        .min((most / (frame[0] * frame[1])).sqrt())
        .min(f64::from(max_side) / frame[0].max(frame[1]));
    frame.map(|side| ((side * scale).round() as u32).clamp(1, max_side.max(1)))
}

/// Returns the size of a picture whose shorter side has so many pixels, in the frame's proportions.
#[must_use]
pub fn of_lines(lines: u32, frame: [u32; 2], max_side: u32) -> [u32; 2] {
    let frame = frame.map(|side| f64::from(side.max(1)));
    let scale = (f64::from(lines) / frame[0].min(frame[1]))
        .min(f64::from(max_side) / frame[0].max(frame[1]));
    frame.map(|side| ((side * scale).round() as u32).clamp(1, max_side.max(1)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fit_keeps_the_proportions_inside_the_view() {
        assert_eq!(
            pixels(Choice::Fit, [640, 480], [800.0, 900.0], 8192),
            [800, 600]
        );
        assert_eq!(
            pixels(Choice::Fit, [160, 256], [800.0, 512.0], 8192),
            [320, 512]
        );
    }

    #[test]
    fn sizes_have_limits() {
        let [w, h] = pixels(Choice::Fit, [640, 480], [9000.0, 9000.0], 8192);
        assert!(f64::from(w * h) <= FIT_PIXELS * 1.01);
        let [w, h] = pixels(Choice::Double, [8192, 8192], [1.0, 1.0], 16384);
        assert!(f64::from(w) * f64::from(h) <= MAX_PIXELS * 1.01);
        assert_eq!(
            pixels(Choice::Frame, [4000, 1], [1.0, 1.0], 2048),
            [2048, 1]
        );
        assert_eq!(
            pixels(Choice::Double, [640, 480], [1.0, 1.0], 2048),
            [1280, 960]
        );
        assert_eq!(pixels(Choice::Fit, [0, 0], [0.0, 0.0], 2048), [1, 1]);
    }

    /// Checks that workers share first samples in every picture that fits the view.
    #[test]
    fn workers_keep_the_samples_of_all_pictures_that_fit() {
        for aspect in 1..=16 {
            let aspect = f64::from(aspect);
            let high = (FIT_PIXELS / aspect).sqrt();
            let [rows, columns] = [high, aspect * high]
                .map(|side| (side as usize).div_ceil(pool::job::TILE as usize));
            assert!(rows * columns <= worker::engine::KEPT, "{aspect}");
        }
    }
}
