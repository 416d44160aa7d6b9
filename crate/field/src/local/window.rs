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

/// A mean weight of a piece of the skeleton.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weight {
    /// The weight, in [0, 1].
    pub value: f64,
    /// Derivative of the weight by the place of the window's middle.
    pub slope: f64,
}

impl Window {
    /// Prepares a window of a reach > 0.
    #[must_use]
    pub fn new(reach: f64) -> Self {
        Self {
            reach,
            fade: FADE * reach,
        }
    }

    /// Distance from which on the window fades.
    #[must_use]
    pub fn flat(&self) -> f64 {
        self.reach - self.fade
    }

    /// Weight at a distance x ≥ 0 along the skeleton.
    #[must_use]
    pub fn weight(&self, x: f64) -> f64 {
        self.at(x)[0]
    }

    /// `∫₀ˣ` of the weight.
    #[must_use]
    pub fn area(&self, x: f64) -> f64 {
        self.at(x)[1]
    }

    /// Computes weight and area at x.
    fn at(&self, x: f64) -> [f64; 2] {
        let flat = self.flat();
        let t = ((x - flat) / self.fade).clamp(0.0, 1.0);
        [
            1.0 - t * t * (3.0 - 2.0 * t),
            x.min(flat) + self.fade * t * (1.0 - t * t * (1.0 - 0.5 * t)),
        ]
    }

    /// Bound on the weight's first and second derivative.
    #[must_use]
    pub fn steepest(&self) -> [f64; 2] {
        [1.5 / self.fade, 6.0 / (self.fade * self.fade)]
    }

    /// The mean weight over a piece of a length whose ends are at these distances from the window's
    /// middle, with the signs by which they change as the middle moves on:
    /// `(2A(τ) − A(α) − A(β))/l`, where the two ways to the piece meet after τ = (α+β+l)/2.
    #[must_use]
    pub fn mean(&self, [a, b]: [f64; 2], [along_a, along_b]: [f64; 2], length: f64) -> Weight {
        if a.min(b) >= self.reach {
            return Weight {
                value: 0.0,
                slope: 0.0,
            };
        }
        let meet = (0.5 * (a + b + length)).max(a).max(b);
        let [[weight_a, area_a], [weight_b, area_b]] = [a, b].map(|x| self.at(x));
        // Mostly there is but one way.
        let [weight, area] = match meet {
            x if x == b => [weight_b, area_b],
            x if x == a => [weight_a, area_a],
            x => self.at(x),
        };
        let ends = weight_a * along_a + weight_b * along_b;
        Weight {
            value: (2.0 * area - area_a - area_b) / length,
            slope: (weight * (along_a + along_b) - ends) / length,
        }
    }

    /// The mean weight over a piece that the window's middle is on, at these distances from its
    /// ends.
    #[must_use]
    pub fn mean_around(&self, [a, b]: [f64; 2], length: f64) -> Weight {
        let [[weight_a, area_a], [weight_b, area_b]] = [a, b].map(|x| self.at(x));
        Weight {
            value: (area_a + area_b) / length,
            slope: (weight_a - weight_b) / length,
        }
    }
}
