//! The soft, quartic and compact6 kernels: `g(v) = c₂v² + c₃v³` of v = 1−r² ≥ 0, and 0 beyond.
//!
//! Along a line and an arc v is a polynomial of the place and of the azimuth's sine and cosine;
//! over a polygon Green's theorem leaves polynomials along the edges. So every cell is exact once
//! the bone is clipped to the ball v ≥ 0. Nothing is subtracted: outside, the field is 0 to the
//! last bit, and short pieces keep their digits.

pub mod arc;
pub mod polygon;
pub mod segment;

/// Positive nodes and weights of the Gauss–Legendre rule with four nodes on [−1, 1], exact for
/// polynomials of degree 7.
pub(crate) const GAUSS4: [[f64; 2]; 2] = [
    [0.339_981_043_584_856_26, 0.652_145_154_862_546_1],
    [0.861_136_311_594_052_6, 0.347_854_845_137_453_86],
];
