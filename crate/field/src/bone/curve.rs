//! A cubic curve, cut into spans.

/// A cubic Bézier curve in local coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve<S> {
    /// Its pieces, in order.
    pub spans: Vec<Span<S>>,
}

/// A piece of it: `c₀ + c₁t + c₂t² + c₃t³`, 0 ≤ t ≤ 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span<S> {
    /// The coefficients.
    pub position: [[S; 3]; 4],
}

impl<S: Copy> Curve<S> {
    pub(crate) fn cast<Q>(&self, f: impl Fn(S) -> Q + Copy) -> Curve<Q> {
        Curve {
            spans: self
                .spans
                .iter()
                .map(|span| Span {
                    position: span.position.map(|c| c.map(f)),
                })
                .collect(),
        }
    }
}

impl Curve<f64> {
    /// An upper bound on the field at distance d or more: all of the curve at that distance.
    pub(crate) fn bound_at(&self, kernel: crate::Kernel, d: f64) -> f64 {
        self.length() * kernel.value(d)
    }

    /// The curve's length, from above: that of its spans' control polygons.
    pub(crate) fn length(&self) -> f64 {
        self.spans
            .iter()
            .map(|span| {
                let [_, b, c, d] = span.position.map(glam::DVec3::from_array);
                let (p, q, r) = (b / 3.0, (b + c) / 3.0, b / 3.0 + c * (2.0 / 3.0) + d);
                p.length() + q.length() + r.length()
            })
            .sum()
    }
}

impl Span<f64> {
    /// A ball that holds the span: around the middle of its box.
    pub(crate) fn ball(&self) -> (glam::DVec3, f64) {
        let [a, b, c, d] = self.position.map(glam::DVec3::from_array);
        let control = [a, a + b / 3.0, a + b * (2.0 / 3.0) + c / 3.0, a + b + c + d];
        let low = control.iter().fold(glam::DVec3::INFINITY, |l, p| l.min(*p));
        let high = control
            .iter()
            .fold(glam::DVec3::NEG_INFINITY, |h, p| h.max(*p));
        let center = (low + high) / 2.0;
        let radius = control
            .iter()
            .fold(0.0, |r: f64, p| r.max(p.distance(center)));
        (center, radius * (1.0 + 1e-12))
    }
}
