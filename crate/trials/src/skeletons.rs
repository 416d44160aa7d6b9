//! Random skeletons, places near them, and their flesh.

use crate::Random;
use core::f64::consts::{PI, TAU};
use field::local::{Limb, LimbPiece};
use field::skeleton::Map;
use field::{BlobScale, Kernel, Local, Primitive, Shaping, Skeleton};
use glam::{DAffine3, DQuat, DVec3};

/// A kind of skeleton.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A point.
    Point,
    /// A segment.
    Segment,
    /// An arc of a circle.
    Arc,
    /// A triangle.
    Triangle,
    /// A plane.
    Plane,
    /// A star, not convex as a rule, sometimes with a hole.
    Polygon,
    /// A cubic curve.
    Curve,
}

/// The kinds of lines.
pub const LINES: [Kind; 3] = [Kind::Segment, Kind::Arc, Kind::Curve];

/// The kinds that have closed forms of the Cauchy kernel.
pub const KINDS: [Kind; 5] = [
    Kind::Point,
    Kind::Segment,
    Kind::Arc,
    Kind::Triangle,
    Kind::Plane,
];

/// Every kind.
pub const ALL_KINDS: [Kind; 7] = [
    Kind::Point,
    Kind::Segment,
    Kind::Arc,
    Kind::Triangle,
    Kind::Plane,
    Kind::Polygon,
    Kind::Curve,
];

impl Random {
    /// Returns a skeleton near the origin, of about this size.
    pub fn skeleton(&mut self, kind: Kind, size: f64) -> Skeleton {
        let [x, y, _] = self.axes();
        let shift = self.vector(0.5 * size);
        match kind {
            Kind::Point => Skeleton::Point { center: shift },
            Kind::Segment => Skeleton::Segment {
                base: shift - x * (size / 2.0),
                apex: shift + x * (size / 2.0),
            },
            Kind::Arc => {
                let small = self.decades(-6.0, 0.0);
                let any = self.range(0.0, TAU);
                let angle = self.pick(&[TAU, TAU - small, small, PI, PI + small, any, any, any]);
                Skeleton::Arc {
                    // A short arc is near its own middle.
                    center: shift - if angle < 1.0 { x * size } else { DVec3::ZERO },
                    u: x,
                    v: y,
                    radius: size,
                    angle,
                }
            }
            Kind::Triangle => {
                let thin = self.decades(-4.0, 0.0);
                let width = size * self.pick(&[1.0, 1.0, thin]);
                let along = self.range(-1.0, 1.0);
                let mut corners = [
                    -x * (size / 2.0),
                    x * (size / 2.0),
                    x * (size * along) + y * width,
                ]
                .map(|p| p + shift);
                corners.rotate_left(self.below(3));
                Skeleton::Triangle { corners }
            }
            Kind::Plane => Skeleton::Plane {
                point: shift,
                normal: x,
            },
            Kind::Polygon => {
                // The hole is around its centre.
                let count = 3 + self.below(5);
                let mut ring = |low: f64, high: f64, count: usize| -> Vec<DVec3> {
                    (0..count)
                        .map(|i| {
                            let (sine, cosine) = libm::sincos(TAU * i as f64 / count as f64);
                            let r = size * self.range(low, high);
                            shift + (x * cosine + y * sine) * r
                        })
                        .collect()
                };
                let mut rings = vec![ring(0.5, 1.0, count)];
                if count.is_multiple_of(2) {
                    rings.push(ring(0.1, 0.3, 3));
                }
                Skeleton::Polygon { rings }
            }
            Kind::Curve => Skeleton::Curve {
                control: core::array::from_fn(|_| shift + self.vector(size)),
            },
        }
    }

    /// Returns a point on the skeleton or in a natural place of it (an end, an axis, a centre).
    pub fn place(&mut self, skeleton: &Skeleton) -> DVec3 {
        let (inside, around) = (self.unit(), self.range(-0.5, 1.5));
        match *skeleton {
            Skeleton::Point { center } => center,
            Skeleton::Segment { base, apex } => {
                base + (apex - base) * self.pick(&[0.0, 1.0, 0.5, inside, around])
            }
            Skeleton::Arc {
                center,
                u,
                v,
                radius,
                angle,
            } => {
                let t = angle * self.pick(&[0.0, 1.0, 0.5, inside, around]);
                let r = radius * self.pick(&[1.0, 1.0, 0.0, inside, around]);
                let (sine, cosine) = libm::sincos(t);
                center + r * (u * cosine + v * sine)
            }
            Skeleton::Triangle { corners: [a, b, c] } => {
                let other = self.unit();
                let (s, t) = self.pick(&[
                    (0.0, 0.0),
                    (1.0, 0.0),
                    (0.0, 1.0),
                    (inside, 0.0),
                    (inside, 1.0 - inside),
                    (inside, other * (1.0 - inside)),
                    (around, other),
                ]);
                a + (b - a) * s + (c - a) * t
            }
            Skeleton::Plane { point, .. } => point,
            Skeleton::Polygon { ref rings } => {
                let ring = &rings[(inside * rings.len() as f64) as usize];
                let at = self.below(ring.len());
                let (p, q) = (ring[at], ring[(at + 1) % ring.len()]);
                let center = rings[0].iter().sum::<DVec3>() / rings[0].len() as f64;
                self.pick(&[p, p + (q - p) * around, p + (center - p) * inside, center])
            }
            ref line => line.at(self.pick(&[0.0, 1.0, inside, inside])),
        }
    }

    /// Returns a point at a distance of these decades from a natural place of the skeleton
    /// ([`Random::place`]).
    pub fn near(&mut self, skeleton: &Skeleton, low: f64, high: f64) -> DVec3 {
        let place = self.place(skeleton);
        let direction = match *skeleton {
            Skeleton::Segment { base, apex } => (apex - base).normalize_or_zero(),
            Skeleton::Arc { u, v, .. } => u.cross(v),
            Skeleton::Triangle { corners: [a, b, c] } => (b - a).cross(c - a).normalize_or_zero(),
            Skeleton::Polygon { ref rings } => {
                let [a, b, c] = [rings[0][0], rings[0][1], rings[0][2]];
                (b - a).cross(c - a).normalize_or_zero()
            }
            _ => DVec3::ZERO,
        };
        let any = self.direction();
        let direction = self.pick(&[direction, any, any, DVec3::ZERO]);
        place + direction * self.decades(low, high)
    }

    /// Returns a shaping of a radius R, whose width is about 1/R.
    pub fn shaping(&mut self, radius: f64) -> Shaping {
        Shaping {
            blobbiness: self.decades(-1.0, 1.0),
            strength: self.pick(&[1.0, 1.0, 1.5, -1.0]),
            ..shaping(radius, 1.0)
        }
    }
}

/// Returns a shaping of Cauchy's kernel: relative blobbiness, strength 1, ε = 1e-3.
pub fn shaping(radius: f64, blobbiness: f64) -> Shaping {
    Shaping {
        kernel: Kernel::Cauchy,
        radius,
        blobbiness,
        blob_scale: BlobScale::Relative,
        strength: 1.0,
        influence: 1e-3,
        taper: None,
    }
}

/// Returns a hairpin of two legs, nearer to each other than two radii of 0.4 if `apart` < 0.8.
///
/// # Panics
/// If `apart` is no number.
pub fn hairpin(kernel: Kernel, apart: f64) -> Local {
    let mut points = Vec::new();
    for i in 0..=8 {
        points.push(DVec3::new(-2.0 + 0.25 * f64::from(i), -0.5 * apart, 0.0));
    }
    for i in 1..8 {
        let angle = PI * (f64::from(i) / 8.0 - 0.5);
        points.push(DVec3::new(
            0.9 * libm::cos(angle),
            0.5 * apart * libm::sin(angle),
            0.0,
        ));
    }
    for i in 0..=8 {
        points.push(DVec3::new(-0.25 * f64::from(i), 0.5 * apart, 0.0));
    }
    let shaping = Shaping {
        kernel,
        ..shaping(0.4, 2.0)
    };
    let count = points.len() as u32 - 1;
    let limbs = (0..count).map(|i| {
        let [base, apex] = [i, i + 1].map(|k| points[k as usize]);
        let piece = Primitive::new(Skeleton::Segment { base, apex }, &shaping, None);
        Limb {
            ends: [i, i + 1],
            pieces: vec![LimbPiece {
                primitives: vec![piece.expect("it is a segment")],
                length: base.distance(apex),
                radius: 0.4,
            }],
        }
    });
    Local::new(&points, &limbs.collect::<Vec<_>>(), 1.2).expect("it is short")
}

/// Returns the parts of a skeleton that is cut in two at a fraction `at` of its parameter; `None`
/// if it has no such parts.
#[must_use]
pub fn halves(skeleton: &Skeleton, at: f64) -> Option<[Skeleton; 2]> {
    Some(match *skeleton {
        Skeleton::Triangle { corners: [a, b, c] } => {
            let middle = a + (b - a) * at;
            [
                Skeleton::Triangle {
                    corners: [a, middle, c],
                },
                Skeleton::Triangle {
                    corners: [middle, b, c],
                },
            ]
        }
        Skeleton::Polygon { ref rings } => {
            // From the centre of the star to two corners.
            let ring = &rings[0];
            if rings.len() > 1 || ring.len() < 4 {
                return None;
            }
            let center = (ring[0] + ring[2]) * 0.5;
            let half = ring.len() / 2;
            let mut first: Vec<DVec3> = ring[..=half].to_vec();
            first.push(center);
            let mut second: Vec<DVec3> = ring[half..].to_vec();
            second.extend([ring[0], center]);
            // Only if both are simple, with areas that add up.
            let whole = skeleton.measure();
            let parts = [first, second].map(|ring| Skeleton::Polygon { rings: vec![ring] });
            let sum = parts[0].measure() + parts[1].measure();
            if (sum - whole).abs() > 1e-9 * whole {
                return None;
            }
            parts
        }
        ref line => [line.part(0.0, at)?, line.part(at, 1.0)?],
    })
}

/// Returns an arc around the origin.
fn arc(radius: f64, angle: f64) -> Skeleton {
    Skeleton::Arc {
        center: DVec3::ZERO,
        u: DVec3::X,
        v: DVec3::Y,
        radius,
        angle,
    }
}

/// Returns the corners of a triangle in the plane z = 0, the first at the origin.
fn flat(b: [f64; 2], c: [f64; 2]) -> [DVec3; 3] {
    [[0.0; 2], b, c].map(|[x, y]| DVec3::new(x, y, 0.0))
}

/// Returns skeletons of a kind that are degenerate, or nearly.
#[must_use]
pub fn degenerate(kind: Kind) -> Vec<Skeleton> {
    let triangles = [
        flat([2.0, 0.0], [0.0, 2.0]),
        flat([2.0, 0.0], [1.0, 0.0]),
        flat([2.0, 0.0], [1.0, 1e-16]),
        flat([2.0, 0.0], [2.0, 0.0]),
        flat([0.0, 0.0], [0.0, 0.0]),
        flat([1e-9, 0.0], [0.0, 1e-9]),
        flat([1e-300, 0.0], [0.0, 1e-300]),
    ];
    match kind {
        Kind::Point => vec![Skeleton::Point {
            center: DVec3::ZERO,
        }],
        Kind::Plane => vec![Skeleton::Plane {
            point: DVec3::ZERO,
            normal: DVec3::Z,
        }],
        Kind::Segment => [2.0, 0.0, 1e-300, 1e-30, 1e-9, 1e3]
            .map(|length| Skeleton::Segment {
                base: DVec3::ZERO,
                apex: DVec3::X * length,
            })
            .to_vec(),
        Kind::Arc => vec![
            arc(1.0, TAU),
            arc(1.0, TAU / 2.0),
            arc(1.0, TAU.next_down()),
            arc(1.0, 1e-9),
            arc(1.0, 1e-300),
            arc(1.0, 0.0),
            arc(0.0, 3.0),
            arc(1e-12, TAU),
            arc(1e-300, TAU),
            arc(1e3, 1e-3),
        ],
        Kind::Triangle => triangles
            .map(|corners| Skeleton::Triangle { corners })
            .to_vec(),
        Kind::Polygon => triangles
            .into_iter()
            .map(|corners| Skeleton::Polygon {
                rings: vec![corners.to_vec()],
            })
            .chain([
                // Corners on a side, a corner given twice, a hole, two corners only.
                Skeleton::Polygon {
                    rings: vec![vec![
                        DVec3::ZERO,
                        DVec3::X,
                        DVec3::X * 2.0,
                        DVec3::X * 2.0,
                        DVec3::Y * 2.0,
                        DVec3::Y,
                    ]],
                },
                Skeleton::Polygon {
                    rings: vec![
                        vec![DVec3::ZERO, DVec3::X * 2.0, DVec3::Y * 2.0],
                        flat([0.5, 0.0], [0.0, 0.5])
                            .map(|p| p + DVec3::new(0.2, 0.2, 0.0))
                            .to_vec(),
                    ],
                },
                Skeleton::Polygon {
                    rings: vec![vec![DVec3::ZERO, DVec3::X]],
                },
            ])
            .collect(),
        Kind::Curve => {
            let [o, x, y] = [DVec3::ZERO, DVec3::X, DVec3::Y];
            [
                [o, o, o, o],
                [o, x, x, x],
                [o, x * 0.5, x * 1.5, x * 2.0],
                [o, x * 2.0, o, x * 2.0],
                [o, x, y, o],
                [x, y, y, x],
                [o, x * 1e-300, y * 1e-300, x * 1e-300],
                [o, x * 1e-9, y * 1e-9, x * 1e-9],
            ]
            .map(|control| Skeleton::Curve { control })
            .to_vec()
        }
    }
}

/// A turn, a scale and a shift.
struct Motion {
    turn: DQuat,
    scale: f64,
    shift: DVec3,
}

impl Map for Motion {
    fn point(&self, point: DVec3) -> DVec3 {
        self.turn * point * self.scale + self.shift
    }

    fn vector(&self, vector: DVec3) -> DVec3 {
        self.turn * vector * self.scale
    }

    fn normal(&self, normal: DVec3) -> DVec3 {
        self.turn * normal
    }

    fn axes(&self, axes: [DVec3; 2]) -> [DVec3; 2] {
        axes.map(|axis| self.turn * axis)
    }

    fn length(&self, length: f64) -> f64 {
        length * self.scale
    }

    fn affine(&self) -> DAffine3 {
        let scale = DVec3::splat(self.scale);
        DAffine3::from_scale_rotation_translation(scale, self.turn, self.shift)
    }
}

/// Returns a skeleton turned, scaled and shifted.
#[must_use]
pub fn move_by(skeleton: &Skeleton, turn: DQuat, scale: f64, shift: DVec3) -> Skeleton {
    skeleton.transform(&Motion { turn, scale, shift })
}
