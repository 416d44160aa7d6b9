//! Random primitives and points, equal on every platform.

use core::f64::consts::{PI, TAU};
use field::{BlobScale, Evaluate, Jet, Kernel, Primitive, Profile, Shaping, Skeleton};
use glam::DVec3;

/// Tests that run natively and, by the same names, in WebAssembly.
#[macro_export]
macro_rules! tests {
    ($($(#[$attribute:meta])* fn $name:ident() $body:block)*) => {$(
        // First, as it looks only at the attributes after it (`ignore`).
        #[cfg_attr(target_arch = "wasm32", wasm_bindgen_test::wasm_bindgen_test)]
        #[cfg_attr(not(target_arch = "wasm32"), test)]
        $(#[$attribute])*
        fn $name() $body
    )*};
}

/// The kinds of skeleton.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Point,
    Segment,
    Arc,
    Triangle,
    Plane,
    Polygon,
    Curve,
}

/// The kinds that have closed forms of the Cauchy kernel.
pub const KINDS: [Kind; 5] = [
    Kind::Point,
    Kind::Segment,
    Kind::Arc,
    Kind::Triangle,
    Kind::Plane,
];

/// All kinds.
pub const ALL_KINDS: [Kind; 7] = [
    Kind::Point,
    Kind::Segment,
    Kind::Arc,
    Kind::Triangle,
    Kind::Plane,
    Kind::Polygon,
    Kind::Curve,
];

/// A splitmix64 generator.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^= z >> 31;
        (z >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// 10 to a random power.
    pub fn decades(&mut self, low: f64, high: f64) -> f64 {
        libm::exp10(self.range(low, high))
    }

    pub fn pick<T: Copy>(&mut self, of: &[T]) -> T {
        of[(self.unit() * of.len() as f64) as usize]
    }

    pub fn vector(&mut self, size: f64) -> DVec3 {
        DVec3::new(
            self.range(-size, size),
            self.range(-size, size),
            self.range(-size, size),
        )
    }

    pub fn direction(&mut self) -> DVec3 {
        loop {
            let v = self.vector(1.0);
            if (0.1..1.0).contains(&v.length()) {
                return v.normalize();
            }
        }
    }

    /// Three orthonormal vectors.
    pub fn axes(&mut self) -> [DVec3; 3] {
        let x = self.direction();
        let y = loop {
            if let Some(y) = x.cross(self.direction()).try_normalize() {
                break y;
            }
        };
        [x, y, x.cross(y)]
    }

    /// A skeleton near the origin, of about this size.
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
                let turn = (self.unit() * 3.0) as usize;
                corners.rotate_left(turn);
                Skeleton::Triangle { corners }
            }
            Kind::Plane => Skeleton::Plane {
                point: shift,
                normal: x,
            },
            Kind::Polygon => {
                // A star, not convex as a rule, sometimes with a hole around its centre.
                let count = 3 + (self.unit() * 5.0) as usize;
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

    /// A point on the skeleton or in a natural place of it (an end, an axis, a centre).
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
                let at = (self.unit() * ring.len() as f64) as usize;
                let (p, q) = (ring[at], ring[(at + 1) % ring.len()]);
                let center = rings[0].iter().sum::<DVec3>() / rings[0].len() as f64;
                self.pick(&[p, p + (q - p) * around, p + (center - p) * inside, center])
            }
            Skeleton::Curve {
                control: [a, b, c, d],
            } => {
                let t = self.pick(&[0.0, 1.0, inside, inside]);
                let s = 1.0 - t;
                a * (s * s * s) + b * (3.0 * s * s * t) + c * (3.0 * s * t * t) + d * (t * t * t)
            }
        }
    }

    /// A point at a distance of these decades from such a place.
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

    /// A shaping of width about 1/R.
    pub fn shaping(&mut self, radius: f64) -> Shaping {
        Shaping {
            blobbiness: -self.decades(-1.0, 1.0),
            strength: self.pick(&[1.0, 1.0, 1.5, -1.0]),
            ..shaping(radius, 1.0)
        }
    }
}

/// Relative blobbiness, strength 1, ε = 1e-3.
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

pub fn primitive(skeleton: Skeleton, shaping: &Shaping, profile: Option<Profile>) -> Primitive {
    Primitive::new(skeleton.clone(), shaping, profile)
        .unwrap_or_else(|| panic!("no flesh: {skeleton:?} {shaping:?}"))
}

/// Value and gradient by one evaluator, as doubles.
pub fn jet<R: Evaluate>(primitive: &Primitive, point: DVec3) -> (f64, DVec3) {
    let Jet { value, gradient } = primitive.jet(point.to_array().map(R::splat));
    (
        value.lane(0),
        DVec3::from_array(gradient.map(|g| g.lane(0))),
    )
}

/// The nearest point with coordinates of single precision.
pub fn single(point: DVec3) -> DVec3 {
    DVec3::from_array(point.to_array().map(|x| f64::from(x as f32)))
}

/// Sensitivity of the value to its input: its change when the point and the skeleton's corners move by one part
/// in 1 of their size.
///
/// Errors are measured against it: `error ≤ n·ε·(|f| + sensitivity)` says that a result is exact
/// for inputs that differ by n units in the last place from those given.
pub fn sensitivity(primitive: &Primitive, point: DVec3) -> f64 {
    let size = extent(&primitive.skeleton);
    let slope = jet::<f64>(primitive, point).1.length();
    let mut sum = slope * (point.length() + size);
    let longest = match &primitive.skeleton {
        Skeleton::Triangle { corners: [a, b, c] } => (*b - *a)
            .length()
            .max((*c - *b).length())
            .max((*a - *c).length()),
        Skeleton::Polygon { rings } => rings
            .iter()
            .flat_map(|ring| (0..ring.len()).map(|i| ring[i].distance(ring[(i + 1) % ring.len()])))
            .fold(0.0, f64::max),
        _ => 0.0,
    };
    if longest > 0.0 {
        // A needle's width is uncertain by its length: so is the field, by a line's of that width.
        let square = (primitive.width * primitive.skeleton.distance(point)).powi(2);
        let line = match primitive.kernel {
            Kernel::Inverse => {
                let k = (square + 1e-10).sqrt() / primitive.width;
                2.0 * libm::asinh(longest / (2.0 * k)) / primitive.width
            }
            Kernel::Squared => {
                let k = (square + 1e-10).sqrt() / primitive.width;
                2.0 * libm::atan(longest / (2.0 * k)) / (k * primitive.width * primitive.width)
            }
            Kernel::Cubed => {
                let k2 = (square + 1e-10) / primitive.width.powi(2);
                longest / (k2 * (k2 + longest * longest / 4.0).sqrt() * primitive.width.powi(3))
            }
            _ => {
                let q = 1.0 + square;
                longest.min(PI / 2.0 * q.sqrt() / primitive.width) / (q * q)
            }
        };
        sum += primitive.height.abs() * longest * line;
    }
    sum
}

/// The largest coordinate of a skeleton.
pub fn extent(skeleton: &Skeleton) -> f64 {
    match *skeleton {
        Skeleton::Point { center } => center.length(),
        Skeleton::Segment { base, apex } => base.length().max(apex.length()),
        Skeleton::Arc { center, radius, .. } => center.length() + radius,
        Skeleton::Triangle { corners } => corners.iter().fold(0.0, |l, p| p.length().max(l)),
        Skeleton::Plane { point, .. } => point.length(),
        Skeleton::Polygon { ref rings } => {
            rings.iter().flatten().fold(0.0, |l, p| p.length().max(l))
        }
        Skeleton::Curve { control } => control.iter().fold(0.0, |l, p| p.length().max(l)),
    }
}

/// The largest distance between a primitive and its interpolant on a span.
pub fn span_error(primitive: &Primitive, start: DVec3, direction: DVec3, h: f64) -> f64 {
    let at = |t: f64| primitive.along_ray(start, direction, t);
    let ((a, da), (b, db)) = (at(0.0), at(h));
    let mut worst = 0.0_f64;
    for i in 1..16 {
        let t = f64::from(i) / 16.0;
        let (u, v) = (1.0 - t, t);
        let cubic = a * u * u * (1.0 + 2.0 * t)
            + b * v * v * (3.0 - 2.0 * t)
            + h * (da * u * u * t - db * v * v * u);
        worst = worst.max((cubic - at(h * t).0).abs());
    }
    worst
}
