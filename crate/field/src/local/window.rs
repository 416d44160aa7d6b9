//! The window of local convolution: how much of the skeleton counts at a distance along it.

/// A window of arc length D to either side: 1 up to D−δ, then falling as `1 − 3t² + 2t³`, t =
/// (x−D+δ)/δ, to 0 at D.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// D.
    pub reach: f64,
    /// δ.
    fade: f64,
}

/// The part of D over which a window fades.
const FADE: f64 = 1.0 / 3.0;

impl Window {
    /// Prepares a window of a reach > 0.
    #[must_use]
    pub fn new(reach: f64) -> Self {
        Self {
            reach,
            fade: FADE * reach,
        }
    }

    /// Returns `∫₀ˣ` of the weight.
    fn area(&self, x: f64) -> f64 {
        let flat = self.reach - self.fade;
        let t = ((x - flat) / self.fade).clamp(0.0, 1.0);
        x.min(flat) + self.fade * t * (1.0 - t * t * (1.0 - 0.5 * t))
    }

    /// Returns the mean weight over a piece of a length whose ends are at these distances from the
    /// window's middle: `(2A(τ) − A(α) − A(β))/l`, where the two ways to the piece meet after τ =
    /// (α+β+l)/2. Exactly 1 where all of it is in the flat part.
    #[must_use]
    pub fn mean(&self, [a, b]: [f64; 2], length: f64) -> f64 {
        if a.min(b) >= self.reach {
            return 0.0;
        }
        // An end is no further than the other one and the piece's length.
        let [a, b] = [a.min(b + length), b.min(a + length)];
        let meet = (0.5 * (a + b + length)).max(a).max(b);
        if meet <= self.reach - self.fade {
            return 1.0;
        }
        let area = 2.0 * self.area(meet) - self.area(a) - self.area(b);
        (area / length).clamp(0.0, 1.0)
    }

    /// Returns the mean weight over a piece of a length whose middle is the window's.
    #[must_use]
    pub fn mean_around(&self, length: f64) -> f64 {
        (2.0 * self.area(0.5 * length) / length).min(1.0)
    }

    /// Returns how much a stretch counts as another fold at a distance x ≥ 0 along the skeleton: 0
    /// up to 2D, then rising as `3t² − 2t³`, t = x/D − 2, to 1 at 3D.
    #[must_use]
    pub fn apart(&self, x: f64) -> f64 {
        let t = (x / self.reach - 2.0).clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    }
}
