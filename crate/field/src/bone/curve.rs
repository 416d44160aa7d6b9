//! A curve made of cubics, cut into spans that Gauss–Legendre quadrature takes in one step; the
//! kernel's width and the field's density may vary along it.
//!
//! In units of the kernel's width (the largest, if it varies) the field at p is
//!
//! `∫ α G(ω·|p − q(t)|²) |q′(t)| dt`
//!
//! with the density α and the thinness ω, the square of the width parameter in units of its largest
//! value. Without a [`Law`] both are 1.
//!
//! A span is accepted when
//! - its direction turns by at most [`Demands::turn`] from the span's middle, so that the distance
//!   from a point has at most one extremum on it, near which it is almost a parabola;
//! - a polynomial through its speed at [`Demands::terms`] Chebyshev points (and through α and ω,
//!   whose polynomials are kept) is right to [`Demands::tolerance`] between them, so that
//!   Gauss–Legendre with half as many nodes is right to that, too;
//! - a smooth kernel's span is at most 2 widths long: the integrand, whose singularities are
//!   about a width away from it, then calls for at most 9 nodes in single precision, 16 in double;
//! - the speed varies at most threefold, so that a distance is a known change of t (spans of less
//!   than [`Demands::slow`] may do otherwise).
//!
//! The curve is cut at the slowest places first, so that cusps are ends. Spans shorter than
//! [`Demands::least`] are accepted as they are. Should there be more than [`MOST_SPANS`] spans,
//! turn and length are doubled and the tolerance is multiplied by 16, until there are not: a smooth
//! kernel's curve of more than a thousand widths is then a chain of blobs that begin to show (4
//! nodes a width leave 10⁻⁶ of the field, 2 nodes 10⁻³).
//!
//! Both precisions have spans of their own: those of double precision would cost single precision
//! three times as much.
use crate::Kernel;
use crate::kernel::Tail;
use crate::kernel::cubed::cone::Cone;
use core::f64::consts::PI;
use glam::DVec3;

/// Number of terms kept of polynomials in t.
pub const TERMS: usize = 12;

/// Number of those terms that single precision's spans use.
pub const SINGLE_TERMS: usize = 8;

/// Largest number of spans (see the module).
const MOST_SPANS: usize = 512;

/// α and ω at a fraction of the curve's length.
pub(crate) type Law<'a> = &'a dyn Fn(f64) -> [f64; 2];

/// Coefficients of a cubic in powers of a parameter.
pub(crate) type Cubic = [DVec3; 4];

/// A curve in local coordinates, prepared for one kernel.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve<S> {
    /// Nodes of the quadrature, for smooth kernels.
    pub nodes: Vec<Node<S>>,
    /// Pieces of the curve, for other kernels.
    pub spans: Vec<Span<S>>,
    /// Nodes in (−1, 1) and weights of the rule by which a span, or its part within the kernel's
    /// support, is integrated.
    pub rule: Vec<[S; 2]>,
    /// Whether α or ω vary.
    pub tapered: bool,
    /// Closed form, if there is one; there are no nodes and spans then.
    pub cone: Option<Cone<S>>,
    /// Half the length of a cone of a compact kernel, in double precision only.
    pub capsule: Option<f64>,
    /// Bounds on its pieces, in double precision only.
    pub piece_bounds: Vec<PieceBounds>,
    /// The coarser version for single precision; `None` in that version itself.
    single: Option<Box<Curve<S>>>,
}

/// A node of the quadrature: a point of the curve with its weight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node<S> {
    /// Position in local coordinates.
    pub position: [S; 3],
    /// `α|q′|dt`.
    pub weight: S,
    /// ω.
    pub thinness: S,
}

/// A piece: `c₀ + c₁t + c₂t² + c₃t³`, −1 ≤ t ≤ 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span<S> {
    /// The coefficients.
    pub position: [[S; 3]; 4],
    /// `c₁c₁, 3c₁c₂, 2c₂c₂ + 4c₁c₃, 5c₂c₃, 3c₃c₃`.
    pub products: [S; 5],
    /// α, coefficients in powers of t.
    pub density: [S; TERMS],
    /// ω, coefficients in powers of t.
    pub thinness: [S; TERMS],
    /// Square of the distance from c₀ beyond which a compact kernel sees nothing of the span.
    pub reach2: S,
}

/// Bounds on a piece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PieceBounds {
    /// Centre of a ball that holds the piece.
    pub center: DVec3,
    /// The ball's radius.
    pub radius: f64,
    /// `∫α|q′|dt`, from above.
    pub mass: f64,
    /// The largest α, from above.
    pub density: f64,
    /// The smallest ω, from below.
    pub thinness: f64,
}

/// Fineness at which a curve is cut.
#[derive(Clone, Copy)]
struct Demands {
    /// Radians by which the direction may differ from that of the span's middle.
    turn: f64,
    /// Relative tolerance of polynomials, and of smooth kernels' integrals.
    tolerance: f64,
    /// Terms of polynomials in t.
    terms: usize,
    /// Longest span of a smooth kernel, in widths.
    longest: f64,
    /// Length below which a span is accepted in any case.
    least: f64,
    /// Length below which a span's speed may vary.
    slow: f64,
    /// Nodes on either side of the nearest point within the support of a compact kernel.
    clipped: usize,
    /// Nodes of the inverse kernel, and of the squared and the cubed one.
    pole: [usize; 2],
}

impl Demands {
    const DOUBLE: Self = Self {
        turn: 0.15,
        tolerance: 1e-11,
        terms: TERMS,
        longest: 2.0,
        least: 1e-9,
        clipped: 14,
        slow: 1e-5,
        pole: [48, 36],
    };
    const SINGLE: Self = Self {
        turn: 0.4,
        tolerance: 1e-6,
        terms: SINGLE_TERMS,
        longest: 2.0,
        least: 1e-6,
        clipped: 6,
        slow: 1e-3,
        pole: [20, 12],
    };

    fn relax(self) -> Self {
        Self {
            turn: self.turn * 2.0,
            tolerance: self.tolerance * 16.0,
            longest: self.longest * 2.0,
            ..self
        }
    }
}

impl<S: Copy> Curve<S> {
    /// Returns the version for single precision in another number type.
    pub(crate) fn cast<Q>(&self, f: impl Fn(S) -> Q + Copy) -> Curve<Q> {
        let source = self.single.as_deref().unwrap_or(self);
        Curve {
            rule: source.rule.iter().map(|pair| pair.map(f)).collect(),
            cone: source.cone.as_ref().map(|cone| cone.cast(f)),
            // The lists whose lengths differ from curve to curve come last, as `Term::cast` says.
            nodes: source.nodes.iter().map(|node| node.cast(f)).collect(),
            spans: source.spans.iter().map(|span| span.cast(f)).collect(),
            tapered: source.tapered,
            capsule: None,
            piece_bounds: Vec::new(),
            single: None,
        }
    }
}

impl<S: Copy> Node<S> {
    fn cast<Q>(&self, f: impl Fn(S) -> Q + Copy) -> Node<Q> {
        Node {
            position: self.position.map(f),
            weight: f(self.weight),
            thinness: f(self.thinness),
        }
    }
}

impl<S: Copy> Span<S> {
    fn cast<Q>(&self, f: impl Fn(S) -> Q + Copy) -> Span<Q> {
        Span {
            position: self.position.map(|c| c.map(f)),
            products: self.products.map(f),
            density: self.density.map(f),
            thinness: self.thinness.map(f),
            reach2: f(self.reach2),
        }
    }
}

impl Curve<f64> {
    /// Prepares a curve from successive cubics over 0 ≤ t ≤ 1, in a fine version for double
    /// precision and a coarse one for single.
    pub(crate) fn new(
        kernel: Kernel,
        fine: &[Cubic],
        coarse: &[Cubic],
        law: Option<Law<'_>>,
    ) -> Self {
        let single = Self::prepare(kernel, coarse, law, Demands::SINGLE);
        let mut double = Self::prepare(kernel, fine, law, Demands::DOUBLE);
        // Fewer and larger pieces make bounds cheaper.
        double.piece_bounds.clone_from(&single.piece_bounds);
        double.single = Some(Box::new(single));
        double
    }

    /// Prepares a straight curve that has a closed form: of its pieces only the bounds are kept.
    pub(crate) fn straight(kernel: Kernel, cone: Cone<f64>, cubic: Cubic, law: Law<'_>) -> Self {
        let pieces = cut(kernel, &[cubic], Some(law), Demands::SINGLE);
        Self {
            nodes: Vec::new(),
            spans: Vec::new(),
            rule: Vec::new(),
            tapered: true,
            cone: Some(cone),
            capsule: None,
            piece_bounds: pieces.iter().map(Piece::bounds).collect(),
            single: None,
        }
    }

    /// Prepares a segment of a compact kernel whose support is a slender cone.
    pub(crate) fn cone(cone: Cone<f64>) -> Self {
        let Cone {
            half,
            middle,
            slope,
            ..
        } = cone;
        let [first, last] = [middle - slope * half, middle + slope * half];
        // Pieces along which bounds vary twofold.
        let count = if first.max(last) > 2.0 * first.min(last) {
            8
        } else {
            1
        };
        let pieces = (0..count).map(|i| {
            let [from, to] =
                [i, i + 1].map(|i| (2.0 * f64::from(i) / f64::from(count) - 1.0) * half);
            let [a, b] = [from, to].map(|t| middle + slope * t);
            let density = first / a.min(b) * (1.0 + 1e-9);
            PieceBounds {
                center: DVec3::X * (0.5 * (from + to)),
                radius: 0.5 * (to - from) * (1.0 + 1e-9),
                mass: density * (to - from),
                density,
                thinness: (1.0 - 1e-9) / (a.max(b) * a.max(b)),
            }
        });
        Self {
            nodes: Vec::new(),
            spans: Vec::new(),
            rule: Vec::new(),
            tapered: true,
            piece_bounds: pieces.collect(),
            capsule: Some(half),
            cone: Some(cone),
            single: None,
        }
    }

    fn prepare(
        kernel: Kernel,
        cubics: &[Cubic],
        law: Option<Law<'_>>,
        mut demands: Demands,
    ) -> Self {
        let mut pieces = cut(kernel, cubics, law, demands);
        for _ in 0..12 {
            if pieces.len() <= MOST_SPANS {
                break;
            }
            demands = demands.relax();
            pieces = cut(kernel, cubics, law, demands);
        }
        let is_smooth = !(kernel.is_compact() || kernel.has_pole());
        let mut curve = Self {
            nodes: Vec::new(),
            spans: Vec::new(),
            rule: gauss_legendre(match kernel.tail() {
                Tail::Power { exponent: 1, .. } => demands.pole[0],
                Tail::Power { .. } => demands.pole[1],
                Tail::Compact | Tail::Fast => demands.clipped,
            }),
            tapered: law.is_some(),
            cone: None,
            capsule: None,
            piece_bounds: pieces.iter().map(Piece::bounds).collect(),
            single: None,
        };
        if is_smooth {
            let mut rules = vec![Vec::new(); 48];
            for piece in &pieces {
                curve.nodes.extend(piece.nodes(kernel, demands, &mut rules));
            }
        } else {
            curve.spans = pieces.iter().map(|piece| piece.span(demands)).collect();
        }
        curve
    }

    /// Upper bound on the field at distance d or more, as if all of the curve were at that
    /// distance.
    pub(crate) fn most_beyond(&self, kernel: Kernel, d: f64) -> f64 {
        let pieces = self.piece_bounds.iter();
        let sum = pieces.map(|piece| piece.mass * kernel.value(d * piece.thinness.sqrt()));
        let sum: f64 = sum.sum();
        if self.capsule.is_none() {
            return sum;
        }
        // No more than an endless line of the largest density and the smallest width.
        let [_, density, thinness] = self.extremes();
        let width = thinness.sqrt();
        sum.min(density / width * kernel.line(d * width))
    }

    /// `∫α|q′|dt` and the largest α, from above, and the smallest ω, from below.
    pub(crate) fn extremes(&self) -> [f64; 3] {
        self.piece_bounds.iter().fold([0.0, 0.0, 1.0], |e, piece| {
            [
                e[0] + piece.mass,
                e[1].max(piece.density),
                e[2].min(piece.thinness),
            ]
        })
    }

    /// The largest radius of a compact kernel's support on it: 1, unless it is tapered.
    pub(crate) fn support(&self) -> f64 {
        1.0 / self.extremes()[2].sqrt()
    }
}

/// A piece of the curve for one application of the rule: a cubic over −1 ≤ t ≤ 1, and its position
/// along the curve.
struct Piece<'a> {
    c: Cubic,
    length: f64,
    /// Length of the curve before the piece, and of the whole curve.
    start: f64,
    total: f64,
    law: Option<Law<'a>>,
}

impl Piece<'_> {
    fn at(&self, t: f64) -> DVec3 {
        let [a, b, c, d] = self.c;
        a + t * (b + t * (c + t * d))
    }

    fn tangent(&self, t: f64) -> DVec3 {
        tangent(&self.c, t)
    }

    /// α and ω.
    fn law(&self, t: f64) -> [f64; 2] {
        self.law.map_or([1.0; 2], |law| {
            let fraction = (self.start + arc(&self.c, -1.0, t)) / self.total;
            law(if fraction.is_finite() {
                fraction.clamp(0.0, 1.0)
            } else {
                0.0
            })
        })
    }

    /// Whether the piece meets the demands; else it is cut.
    fn suits(&self, kernel: Kernel, demands: Demands) -> bool {
        if self.length <= demands.least * self.total.min(1.0) {
            return true;
        }
        let terms = demands.terms;
        let between: Vec<f64> = (0..=terms)
            .map(|i| libm::cos(PI * i as f64 / terms as f64))
            .collect();
        let tangents: Vec<DVec3> = between.iter().map(|t| self.tangent(*t)).collect();
        let fastest = tangents.iter().fold(0.0, |l: f64, v| l.max(v.length()));
        let slowest = tangents.iter().fold(fastest, |l: f64, v| l.min(v.length()));
        let middle = self.tangent(0.0).normalize_or_zero();
        let (sine, cosine) = libm::sincos(demands.turn.min(1.5));
        let straight = tangents.iter().all(|v| {
            let along = v.dot(middle);
            // The direction is rounding noise at a cusp.
            v.length() <= 1e-6 * fastest
                || along > 0.0 && v.cross(middle).length() * cosine <= along * sine
        });
        let (slow, longest) = match kernel.tail() {
            Tail::Compact => (demands.slow, f64::INFINITY),
            Tail::Power { .. } if kernel.has_pole() => (1e-7, f64::INFINITY),
            Tail::Power { .. } | Tail::Fast => (demands.slow, demands.longest),
        };
        let even = fastest <= 3.0 * slowest || self.length <= slow;
        if !(straight && even) || longest.is_finite() && self.width() > longest {
            return false;
        }
        let places = chebyshev_points(terms);
        let exact = |at_places: &[f64], f: &dyn Fn(usize) -> f64| {
            let p = fit(at_places);
            let largest = at_places.iter().fold(0.0, |l: f64, v| l.max(v.abs()));
            let most = demands.tolerance * largest;
            (0..)
                .zip(&between)
                .all(|(i, t)| (horner(&p, *t) - f(i)).abs() <= most)
        };
        let speeds: Vec<f64> = places.iter().map(|t| self.tangent(*t).length()).collect();
        if !exact(&speeds, &|i| tangents[i].length()) {
            return false;
        }
        if self.law.is_none() {
            return true;
        }
        let laws: Vec<_> = places.iter().map(|t| self.law(*t)).collect();
        let laws_between: Vec<_> = between.iter().map(|t| self.law(*t)).collect();
        [0, 1].into_iter().all(|which| {
            let values: Vec<f64> = laws.iter().map(|law| law[which]).collect();
            exact(&values, &|i| laws_between[i][which])
        })
    }

    /// Length in units of the local kernel width, counted longer where the curve is bent: there the
    /// singularities of a Cauchy kernel may be nearer than a width. On a circle of radius r they
    /// are no nearer than `√(2r(√(r²+1)−r))`.
    fn width(&self) -> f64 {
        let mut largest: f64 = 0.0;
        for i in -2..=2 {
            let t = 0.5 * f64::from(i);
            let v = self.tangent(t);
            let a = 2.0 * (self.c[2] + 3.0 * t * self.c[3]);
            let speed = v.length();
            let thin = self.law(t)[1].sqrt();
            let radius = thin * speed * speed * speed / v.cross(a).length();
            let near = if radius < 1e3 {
                (2.0 * radius / ((radius * radius + 1.0).sqrt() + radius)).sqrt()
            } else {
                1.0
            };
            largest = largest.max(thin * self.length / near.max(0.05));
        }
        largest
    }

    fn nodes(
        &self,
        kernel: Kernel,
        demands: Demands,
        rules: &mut [Vec<[f64; 2]>],
    ) -> Vec<Node<f64>> {
        let half = self.width().min(demands.longest) / 2.0;
        // The error of n nodes is about ρ^−2n, where 1/half = (ρ − 1/ρ)/2 for poles at ±i; for
        // exp(−x²) it is about (half²/4)ⁿ/n!.
        let order = (2..36).find(|&n| {
            let error = if kernel.is_entire() {
                (1..=n).fold(4.0 * half, |e, i| e * half * half / (4.0 * i as f64))
            } else {
                let rho = 1.0 / half + (1.0 + 1.0 / (half * half)).sqrt();
                libm::pow(rho, -2.0 * n as f64)
            };
            error <= demands.tolerance
        });
        // Enough for the speed times the kernel's first terms.
        let order = (order.unwrap_or(36) + 1).max(demands.terms / 2 + 1);
        let order = if self.length <= demands.least * self.total.min(1.0) {
            1
        } else {
            order
        };
        if rules[order].is_empty() {
            rules[order] = gauss_legendre(order);
        }
        rules[order]
            .iter()
            .map(|&[t, weight]| {
                let [density, thinness] = self.law(t);
                Node {
                    position: self.at(t).to_array(),
                    weight: weight * density * self.tangent(t).length(),
                    thinness,
                }
            })
            .collect()
    }

    fn span(&self, demands: Demands) -> Span<f64> {
        let [_, c1, c2, c3] = self.c;
        let mut span = Span {
            position: self.c.map(|c| c.to_array()),
            products: [
                c1.dot(c1),
                3.0 * c1.dot(c2),
                2.0 * c2.dot(c2) + 4.0 * c1.dot(c3),
                5.0 * c2.dot(c3),
                3.0 * c3.dot(c3),
            ],
            density: [0.0; TERMS],
            thinness: [0.0; TERMS],
            reach2: 0.0,
        };
        span.density[0] = 1.0;
        span.thinness[0] = 1.0;
        let mut slimmest = 1.0_f64;
        if self.law.is_some() {
            let values: Vec<_> = chebyshev_points(demands.terms)
                .iter()
                .map(|t| self.law(*t))
                .collect();
            // The least may be slightly smaller between the sample points.
            slimmest = values
                .iter()
                .fold(slimmest, |least, v| least.min(0.8 * v[1]));
            for (i, terms) in [&mut span.density, &mut span.thinness]
                .into_iter()
                .enumerate()
            {
                let values: Vec<f64> = values.iter().map(|v| v[i]).collect();
                terms[..demands.terms].copy_from_slice(&fit(&values));
            }
        }
        let reach = c1.length() + c2.length() + c3.length() + 1.0 / slimmest.sqrt();
        // Rounding must not leave anything out.
        span.reach2 = reach * reach * 1.001;
        span
    }

    fn bounds(&self) -> PieceBounds {
        let [a, b, c, d] = self.c;
        // Bézier points of the cubic over −1 ≤ t ≤ 1.
        let control = [
            a - b + c - d,
            a - b / 3.0 - c / 3.0 + d,
            a + b / 3.0 - c / 3.0 - d,
            a + b + c + d,
        ];
        let low = control.iter().fold(DVec3::INFINITY, |l, p| l.min(*p));
        let high = control.iter().fold(DVec3::NEG_INFINITY, |h, p| h.max(*p));
        let center = (low + high) / 2.0;
        let reach = control
            .iter()
            .fold(0.0, |r: f64, p| r.max(p.distance(center)));
        let (mut density, mut thinness) = (1.0, 1.0);
        if self.law.is_some() {
            // Density and thinness vary little on a piece; 1 % covers the values between samples.
            let (mut most, mut least) = (0.0_f64, f64::INFINITY);
            for i in -8..=8 {
                let [alpha, omega] = self.law(f64::from(i) / 8.0);
                most = most.max(alpha.abs());
                least = least.min(omega);
            }
            density = most * 1.01;
            thinness = least * 0.99;
        }
        // 10⁻⁶ is more than the error of the coarse version of a circle.
        PieceBounds {
            center,
            radius: reach * (1.0 + 1e-6),
            mass: density * self.length * (1.0 + 1e-6),
            density,
            thinness,
        }
    }
}

fn tangent(c: &Cubic, t: f64) -> DVec3 {
    c[1] + t * (2.0 * c[2] + 3.0 * t * c[3])
}

/// The positive nodes and the weights of the Gauss–Legendre rule of 16 points.
const RULE16: [[f64; 2]; 8] = [
    [0.989_400_934_991_649_9, 0.027_152_459_411_754_096],
    [0.944_575_023_073_232_6, 0.062_253_523_938_647_894],
    [0.865_631_202_387_831_8, 0.095_158_511_682_492_79],
    [0.755_404_408_355_003, 0.124_628_971_255_533_88],
    [0.617_876_244_402_643_8, 0.149_595_988_816_576_74],
    [0.458_016_777_657_227_37, 0.169_156_519_395_002_54],
    [0.281_603_550_779_258_9, 0.182_603_415_044_923_58],
    [0.095_012_509_837_637_44, 0.189_450_610_455_068_5],
];

/// The length between two parameters, if the speed is smooth there.
fn arc(c: &Cubic, from: f64, to: f64) -> f64 {
    let (middle, half) = ((from + to) / 2.0, (to - from) / 2.0);
    let speed = |t: f64| tangent(c, t).length();
    let pairs = RULE16.map(|[x, w]| w * (speed(middle - half * x) + speed(middle + half * x)));
    half * pairs.iter().sum::<f64>()
}

/// The part of a cubic over from ≤ t ≤ to, as one over −1 ≤ t ≤ 1.
fn part([a, b, c, d]: Cubic, from: f64, to: f64) -> Cubic {
    let (m, h) = ((from + to) / 2.0, (to - from) / 2.0);
    [
        a + m * (b + m * (c + m * d)),
        h * (b + m * (2.0 * c + 3.0 * m * d)),
        h * h * (c + 3.0 * m * d),
        h * h * h * d,
    ]
}

/// The pieces of a curve, in order.
fn cut<'a>(
    kernel: Kernel,
    cubics: &[Cubic],
    law: Option<Law<'a>>,
    demands: Demands,
) -> Vec<Piece<'a>> {
    let mut parts = Vec::new();
    for c in cubics {
        parts.extend(slowest(c).windows(2).map(|ends| (*c, ends[0], ends[1])));
    }
    let total: f64 = parts.iter().map(|(c, a, b)| length(c, *a, *b)).sum();
    let (mut pieces, mut start) = (Vec::new(), 0.0);
    for (cubic, low, high) in parts {
        // Depth first, so that pieces come in order.
        let mut waiting = vec![(low, high, 0)];
        while let Some((low, high, depth)) = waiting.pop() {
            let c = part(cubic, low, high);
            let piece = Piece {
                c,
                length: arc(&c, -1.0, 1.0),
                start,
                total,
                law,
            };
            if depth >= 40 || pieces.len() > 8 * MOST_SPANS || piece.suits(kernel, demands) {
                start += piece.length;
                pieces.push(piece);
            } else {
                let middle = (low + high) / 2.0;
                waiting.push((middle, high, depth + 1));
                waiting.push((low, middle, depth + 1));
            }
        }
    }
    pieces
}

/// Computes a cubic's length between two parameters.
fn length(c: &Cubic, from: f64, to: f64) -> f64 {
    let breaks: Vec<f64> = (0..=8)
        .map(|i| from + (to - from) * f64::from(i) / 8.0)
        .collect();
    // Next to a place where the curve stands still its speed is nothing but rounding, which no
    // bisection settles.
    let rounding = 4.0 * f64::EPSILON * (c[1].length() + 2.0 * c[2].length() + 3.0 * c[3].length());
    crate::integral::integral_within(&mut |t| tangent(c, t).length(), &breaks, 1e-13, rounding)
}

/// 0, the places between at which a cubic is much slower than elsewhere, and 1.
fn slowest(c: &Cubic) -> Vec<f64> {
    let speed = |t: f64| tangent(c, t).length();
    let rate = |t: f64| tangent(c, t).dot(2.0 * c[2] + 6.0 * t * c[3]);
    let mean = [0.0, 0.25, 0.5, 0.75, 1.0].map(speed).iter().sum::<f64>() / 5.0;
    const SAMPLES: i32 = 48;
    let place = |i: i32| f64::from(i) / f64::from(SAMPLES);
    let mut places = vec![0.0];
    for i in 0..SAMPLES {
        let (mut low, mut high) = (place(i), place(i + 1));
        if !(rate(low) < 0.0 && rate(high) >= 0.0) {
            continue;
        }
        for _ in 0..60 {
            let middle = (low + high) / 2.0;
            if rate(middle) < 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        if low > 0.0 && high < 1.0 && speed(low) < 0.2 * mean {
            places.push(low);
        }
    }
    places.push(1.0);
    places
}

/// The zeros of the Chebyshev polynomial of degree n.
fn chebyshev_points(n: usize) -> Vec<f64> {
    (0..n)
        .map(|i| libm::cos(PI * (i as f64 + 0.5) / n as f64))
        .collect()
}

/// Coefficients in powers of t of the polynomial with these values at the Chebyshev points.
fn fit(values: &[f64]) -> Vec<f64> {
    let n = values.len();
    let mut sum = vec![0.0; n];
    // Tₖ in powers of t, from Tₖ₊₁ = 2t·Tₖ − Tₖ₋₁.
    let (mut before, mut here) = (vec![0.0; n], vec![0.0; n]);
    here[0] = 1.0;
    for k in 0..n {
        let turn = PI * k as f64 / n as f64;
        let terms = (0..n).map(|i| values[i] * libm::cos(turn * (i as f64 + 0.5)));
        let mean = terms.sum::<f64>() / n as f64;
        let weight = if k == 0 { mean } else { 2.0 * mean };
        let factor = if k == 0 { 1.0 } else { 2.0 };
        let mut next = vec![0.0; n];
        for i in 0..n {
            sum[i] += weight * here[i];
            let shifted = if i == 0 { 0.0 } else { here[i - 1] };
            next[i] = factor * shifted - before[i];
        }
        before = core::mem::replace(&mut here, next);
    }
    sum
}

fn horner(p: &[f64], t: f64) -> f64 {
    p.iter().rev().fold(0.0, |sum, c| sum * t + c)
}

/// Nodes in (−1, 1) and weights of the Gauss–Legendre rule of n points: the zeros of Pₙ, by
/// Newton's method from Tricomi's approximation.
pub(crate) fn gauss_legendre(n: usize) -> Vec<[f64; 2]> {
    (0..n)
        .map(|i| {
            let mut x = libm::cos(PI * (i as f64 + 0.75) / (n as f64 + 0.5));
            let mut slope = 0.0;
            for _ in 0..6 {
                let (mut before, mut here) = (1.0, x);
                for k in 2..=n {
                    let k = k as f64;
                    (before, here) = (here, ((2.0 * k - 1.0) * x * here - (k - 1.0) * before) / k);
                }
                slope = n as f64 * (x * here - before) / (x * x - 1.0);
                x -= here / slope;
            }
            [x, 2.0 / ((1.0 - x * x) * slope * slope)]
        })
        .collect()
}
