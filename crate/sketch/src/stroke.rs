//! The points of a stroke as a hand draws them.

/// Most points that a stroke keeps.
pub const MOST_MARKS: usize = 8192;

/// A point of a stroke on the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mark {
    /// The place to the right and down, points of the screen.
    pub at: [f32; 2],
    /// Pressure of a pen, 0 … 1, if it is measured.
    pub pressure: Option<f32>,
}

/// A stroke that is being drawn. However long it becomes, it keeps at most 8192 points: of a longer
/// one every second point is left out.
///
/// ```
/// use sketch::{Mark, Stroke};
///
/// let mark = |x| Mark { at: [x, 0.0], pressure: None };
/// let mut stroke = Stroke::begin(mark(0.0));
/// stroke.push(mark(3.0));
/// stroke.push(mark(3.0));
/// assert_eq!((stroke.marks().len(), stroke.reach()), (2, 3.0));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Stroke {
    marks: Vec<Mark>,
    /// Pushed points that are left out between two that are kept.
    skip: usize,
    skipped: usize,
    reach: f32,
}

impl Stroke {
    /// A stroke of one point.
    #[must_use]
    pub fn begin(mark: Mark) -> Self {
        Self {
            marks: vec![mark],
            skip: 0,
            skipped: 0,
            reach: 0.0,
        }
    }

    /// Goes on to a point. One that is where the last one was, or that is not finite, is left out.
    pub fn push(&mut self, mark: Mark) {
        let last = self.marks[self.marks.len() - 1];
        let is_usable = mark.at.iter().all(|x| x.is_finite())
            && mark.pressure.is_none_or(|pressure| pressure.is_finite());
        if !is_usable || last.at == mark.at {
            return;
        }
        let [x, y] = [0, 1].map(|k| mark.at[k] - self.marks[0].at[k]);
        self.reach = self.reach.max((x * x + y * y).sqrt());
        if self.skipped < self.skip {
            self.skipped += 1;
            return;
        }
        self.skipped = 0;
        self.marks.push(mark);
        if self.marks.len() > MOST_MARKS {
            let mut number = 0;
            self.marks.retain(|_| {
                number += 1;
                number % 2 == 1
            });
            self.skip = 2 * self.skip + 1;
        }
    }

    /// The points.
    #[must_use]
    pub fn marks(&self) -> &[Mark] {
        &self.marks
    }

    /// Returns the stroke drawn the other way.
    #[must_use]
    pub fn reversed(&self) -> Self {
        let mut stroke = self.clone();
        stroke.marks.reverse();
        stroke
    }

    /// Returns the greatest distance from the first point, points of the screen.
    #[must_use]
    pub fn reach(&self) -> f32 {
        self.reach
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mark(x: f32, y: f32) -> Mark {
        Mark {
            at: [x, y],
            pressure: None,
        }
    }

    #[test]
    fn a_long_stroke_keeps_its_form_and_bounded_memory() {
        let mut stroke = Stroke::begin(mark(0.0, 0.0));
        for i in 1..=100_000 {
            let t = i as f32 / 1000.0;
            stroke.push(mark(t, libm::sinf(t)));
        }
        let marks = stroke.marks();
        assert!(marks.len() <= MOST_MARKS && marks.len() > MOST_MARKS / 4);
        let gaps = marks.windows(2).map(|pair| pair[1].at[0] - pair[0].at[0]);
        let widest = gaps.fold(0.0, f32::max);
        assert!(widest < 0.04, "{widest}");
        assert!(marks[marks.len() - 1].at[0] > 99.9);
        assert!(stroke.reach() >= 100.0);
    }

    #[test]
    fn points_that_are_none_are_left_out() {
        let mut stroke = Stroke::begin(mark(1.0, 1.0));
        stroke.push(mark(f32::NAN, 0.0));
        stroke.push(mark(0.0, f32::INFINITY));
        stroke.push(mark(1.0, 1.0));
        stroke.push(Mark {
            pressure: Some(f32::NAN),
            ..mark(2.0, 1.0)
        });
        assert_eq!(stroke.marks(), [mark(1.0, 1.0)]);
        assert_eq!(stroke.reach(), 0.0);
        stroke.push(mark(4.0, 5.0));
        assert_eq!(stroke.reach(), 5.0);
        assert_eq!(stroke.reversed().marks(), [mark(4.0, 5.0), mark(1.0, 1.0)]);
    }
}
