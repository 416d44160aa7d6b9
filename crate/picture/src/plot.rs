//! A line through numbers.

use crate::limits::MAX_POINTS;
use crate::{Picture, Problem};

/// Size of the picture, pixels.
const SIZE: [u32; 2] = [512, 320];
/// Space around the line, pixels.
const MARGIN: f64 = 16.0;
/// Half the thickness of the line, pixels.
const HALF_WIDTH: f64 = 1.0;
const PAPER: [f64; 3] = [255.0, 255.0, 255.0];
const INK: [f64; 3] = [32.0, 64.0, 160.0];
const AXIS: [f64; 3] = [170.0, 170.0, 170.0];

/// A line through points at equal distances from left to right, of which `values` are the heights.
/// The least stands at the bottom, the greatest at the top; a thin line marks 0 where it lies
/// between them.
///
/// # Errors
/// If there are fewer than 2 or more than [`MAX_POINTS`] values, or if one is not finite.
pub fn plot(values: &[f64]) -> Result<Picture, Problem> {
    if !(2..=MAX_POINTS).contains(&values.len()) {
        return Err(Problem::PointCount(values.len()));
    }
    if values.iter().any(|value| !value.is_finite()) {
        return Err(Problem::NotFinite);
    }
    let [width, height] = SIZE;
    let mut paper = Paper {
        picture: Picture::filled(width, height, [255; 4])?,
        shares: vec![0.0; width as usize * height as usize],
    };
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    let greatest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let (right, bottom) = (f64::from(width) - MARGIN, f64::from(height) - MARGIN);
    // Halves, because the distance of two finite numbers may be beyond the largest.
    let range = greatest / 2.0 - least / 2.0;
    let y = |value: f64| {
        let share = if range > 0.0 {
            (value / 2.0 - least / 2.0) / range
        } else {
            0.5
        };
        bottom + (MARGIN - bottom) * share
    };
    if least <= 0.0 && greatest >= 0.0 {
        paper.line([MARGIN, y(0.0)], [right, y(0.0)], HALF_WIDTH / 2.0);
        paper.ink(AXIS);
    }
    let step = (right - MARGIN) / (values.len() - 1) as f64;
    for (index, ends) in values.windows(2).enumerate() {
        let [a, b] = [0, 1].map(|end| [MARGIN + step * (index + end) as f64, y(ends[end])]);
        paper.line(a, b, HALF_WIDTH);
    }
    paper.ink(INK);
    Ok(paper.picture)
}

/// A picture, and how much of each pixel the line that is being drawn covers.
struct Paper {
    picture: Picture,
    shares: Vec<f64>,
}

impl Paper {
    /// Covers the pixels of a straight piece with round ends. Pieces of one line that touch are not
    /// counted twice.
    fn line(&mut self, a: [f64; 2], b: [f64; 2], half_width: f64) {
        let [width, height] = self.picture.size();
        let reach = half_width + 1.0;
        let [columns, rows] = [(0, width), (1, height)].map(|(axis, end)| {
            let first = (a[axis].min(b[axis]) - reach).floor().max(0.0) as u32;
            let last = (a[axis].max(b[axis]) + reach).ceil();
            first..last.clamp(0.0, f64::from(end)) as u32
        });
        for row in rows {
            for column in columns.clone() {
                let centre = [f64::from(column) + 0.5, f64::from(row) + 0.5];
                // A pixel is covered as far as the line's edge has passed its centre.
                let share = (half_width + 0.5 - distance(centre, a, b)).clamp(0.0, 1.0);
                let slot = &mut self.shares[row as usize * width as usize + column as usize];
                *slot = slot.max(share);
            }
        }
    }

    /// Colours what is covered, and begins the next line.
    fn ink(&mut self, colour: [f64; 3]) {
        let pixels = self.picture.pixels_mut().chunks_exact_mut(4);
        for (pixel, share) in pixels.zip(&mut self.shares) {
            for (byte, (ink, paper)) in pixel.iter_mut().zip(colour.into_iter().zip(PAPER)) {
                let under = f64::from(*byte).min(paper);
                *byte = (under + (ink - under) * *share).round() as u8;
            }
            *share = 0.0;
        }
    }
}

/// The distance of a point from the segment between two others.
fn distance(point: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let along = [b[0] - a[0], b[1] - a[1]];
    let to = [point[0] - a[0], point[1] - a[1]];
    let length = along[0] * along[0] + along[1] * along[1];
    let t = if length > 0.0 {
        ((to[0] * along[0] + to[1] * along[1]) / length).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let off = [to[0] - t * along[0], to[1] - t * along[1]];
    (off[0] * off[0] + off[1] * off[1]).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether the ink, not the axis, is near a place.
    fn has_ink(picture: &Picture, x: u32, y: u32) -> bool {
        picture.pixel(x, y).is_some_and(|pixel| pixel[0] < 100)
    }

    #[test]
    fn the_line_goes_through_its_points() {
        let picture = plot(&[0.0, 1.0, 0.0]).expect("a plot");
        assert!(has_ink(&picture, 16, 303));
        assert!(has_ink(&picture, 256, 17));
        assert!(has_ink(&picture, 495, 303));
        assert!(
            !has_ink(&picture, 256, 303),
            "only the axis is below the peak"
        );
        assert_eq!(picture.pixel(256, 303).map(|p| p[0] < 255), Some(true));
        assert_eq!(picture.pixel(3, 3), Some([255; 4]));
    }

    #[test]
    fn any_finite_numbers() {
        for values in [
            vec![5.0; 2],
            vec![f64::MAX, f64::MIN],
            vec![1e-320, 2e-320, 0.0],
            vec![-1.0; MAX_POINTS],
        ] {
            let picture = plot(&values).expect("a plot");
            let dark = picture.pixels().chunks_exact(4).filter(|p| p[0] < 100);
            assert!(dark.count() > 400, "{values:?}");
        }
        assert_eq!(plot(&[1.0]), Err(Problem::PointCount(1)));
        assert_eq!(plot(&[1.0; 257]), Err(Problem::PointCount(257)));
        assert_eq!(plot(&[1.0, f64::NAN]), Err(Problem::NotFinite));
        assert_eq!(plot(&[1.0, f64::INFINITY]), Err(Problem::NotFinite));
    }
}
