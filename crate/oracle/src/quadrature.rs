//! Fields by numerical integration.
//!
//! [`value`] integrates the kernel over the skeleton adaptively, and shares nothing with the closed
//! forms but the definition of the field. It is slow (10² to 10⁵ kernel evaluations).
use field::integral::{integral, of_one_panel};
use field::skeleton::{area_vector, cubic};
use field::{Kernel, Primitive, Profile, Shaping, Skeleton, Sum, Wave};
use glam::DVec3;

/// A kernel by its definition (fields.md, section 1), as a function G of q, the square of the
/// distance u in its widths.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Definition {
    /// A smooth function, 0 only at infinity.
    Smooth(fn(f64) -> f64),
    /// 1/u to the power of an exponent, with its pole rounded off.
    Pole(i32),
    /// Functions of q up to places u, the last at 1, and 0 beyond.
    Pieces(&'static [Piece]),
}

/// The place u where a piece of a kernel ends, and G on it.
type Piece = (f64, fn(f64) -> f64);

/// The place on a line, and its length per unit of the parameter, by the parameter from 0 to 1.
type Trace<'l> = Box<dyn Fn(f64) -> (DVec3, f64) + 'l>;

/// Returns a kernel's definition.
pub(crate) fn define(kernel: Kernel) -> Definition {
    use Definition::{Pieces, Pole, Smooth};
    match kernel {
        Kernel::Cauchy => Smooth(|q| 1.0 / ((1.0 + q) * (1.0 + q))),
        Kernel::Gauss => Smooth(|q| libm::exp(-q)),
        Kernel::Inverse => Pole(1),
        Kernel::Squared => Pole(2),
        Kernel::Cubed => Pole(3),
        Kernel::Metaballs => Pieces(&[
            (1.0 / 3.0, |q| 1.0 - 3.0 * q),
            (1.0, |q| 1.5 * (1.0 - q.sqrt()) * (1.0 - q.sqrt())),
        ]),
        // (1−q)² times what is left of the polynomial, so that its end keeps its digits.
        Kernel::Soft => Pieces(&[(1.0, |q| (1.0 - q) * (1.0 - q) * (1.0 - 4.0 / 9.0 * q))]),
        Kernel::Quartic => Pieces(&[(1.0, |q| (1.0 - q) * (1.0 - q))]),
        Kernel::Compact6 => Pieces(&[(1.0, |q| (1.0 - q) * (1.0 - q) * (1.0 - q))]),
    }
}

impl Definition {
    /// Computes the kernel.
    pub(crate) fn value(self, q: f64) -> f64 {
        let pole = q + 1e-10;
        match self {
            Self::Smooth(g) => g(q),
            Self::Pole(1) => 1.0 / pole.sqrt(),
            Self::Pole(2) => 1.0 / pole,
            Self::Pole(_) => 1.0 / (pole * pole.sqrt()),
            Self::Pieces(pieces) => {
                let u = q.sqrt();
                pieces
                    .iter()
                    .find(|(end, _)| u <= *end)
                    .map_or(0.0, |(_, g)| g(q))
            }
        }
    }

    /// Returns the places u at which the kernel's pieces end.
    pub(crate) fn kinks(self) -> impl Iterator<Item = f64> + Clone {
        let pieces = match self {
            Self::Pieces(pieces) => pieces,
            Self::Smooth(_) | Self::Pole(_) => &[],
        };
        pieces.iter().map(|(end, _)| *end)
    }

    /// Whether the kernel has a pole.
    pub(crate) fn has_pole(self) -> bool {
        matches!(self, Self::Pole(_))
    }

    /// Whether the kernel's integral over a line (1) or a plane (2) is finite.
    pub(crate) fn is_finite_over(self, dimension: i32) -> bool {
        !matches!(self, Self::Pole(exponent) if exponent <= dimension)
    }

    /// Returns the length scale, in kernel widths, on which an integrand varies: the kernel's
    /// width, or its pole's.
    fn finest(self) -> f64 {
        if self.has_pole() { 1e-5 } else { 1.0 }
    }
}

/// Computes a primitive's field at a point, by integration over its skeleton.
///
/// Relative error about 10⁻¹² (triangles and polygons, and tapered limbs of kernels with a pole,
/// 10⁻¹¹).
#[must_use]
pub fn value(primitive: &Primitive, point: DVec3) -> f64 {
    let factor = primitive
        .profile
        .as_ref()
        .map_or(1.0, |profile| factor(profile, &primitive.skeleton, point));
    factor
        * match &primitive.tapered {
            Some(shaping) => integrate_tapered(primitive, shaping, point),
            None => primitive.height * integrate(primitive, &primitive.skeleton, point),
        }
}

/// Integrates the kernel over a skeleton.
fn integrate(primitive: &Primitive, skeleton: &Skeleton, point: DVec3) -> f64 {
    let s = primitive.width;
    let k = define(primitive.kernel);
    let h = |q: DVec3| k.value(s * s * q.distance_squared(point));
    let grain = |length: f64| k.finest() / (s * length);
    let along = |base: DVec3, d: DVec3| {
        let length = d.length();
        let near = near(base, d, point);
        // Places where the kernel's pieces meet on the line.
        let beside = (base + d * near).distance_squared(point);
        let kinks = k.kinks().flat_map(|kink| {
            let reach = (kink / s).powi(2) - beside;
            let reach = reach.max(0.0).sqrt() / length;
            [near - reach, near + reach]
        });
        length * split(|t| h(base + d * t), near, grain(length), kinks)
    };
    match *skeleton {
        Skeleton::Point { center } => h(center),
        Skeleton::Segment { base, apex } => along(base, apex - base),
        Skeleton::Arc {
            center,
            u,
            v,
            radius,
            angle,
        } => {
            let d = point - center;
            let azimuth = libm::atan2(d.dot(v), d.dot(u)).rem_euclid(core::f64::consts::TAU);
            // |p − q|² = a − b·cos of the angle between them.
            let a = d.length_squared() + radius * radius;
            let b = 2.0 * radius * (d.dot(u) * d.dot(u) + d.dot(v) * d.dot(v)).sqrt();
            let kinks = k.kinks().flat_map(|kink| {
                let turn = libm::acos(((a - (kink / s).powi(2)) / b).clamp(-1.0, 1.0));
                let tau = core::f64::consts::TAU;
                [
                    azimuth - turn,
                    azimuth + turn,
                    azimuth - turn + tau,
                    azimuth + turn - tau,
                ]
                .map(|t| t / angle)
            });
            let length = radius * angle;
            length
                * split(
                    |t| {
                        let (sine, cosine) = libm::sincos(angle * t);
                        h(center + radius * (u * cosine + v * sine))
                    },
                    azimuth / angle,
                    grain(length),
                    kinks,
                )
        }
        Skeleton::Triangle { corners: [a, b, c] } => {
            // Strips parallel to the longest side, so that they do not become needles.
            let (a, b, c) = [(a, b, c), (b, c, a), (c, a, b)]
                .into_iter()
                .max_by(|x, y| {
                    (x.1 - x.0)
                        .length_squared()
                        .total_cmp(&(y.1 - y.0).length_squared())
                })
                .unwrap_or((a, b, c));
            let side = b - a;
            let foot = a + side * ((c - a).dot(side) / side.length_squared().max(1e-300));
            let altitude = c - foot;
            // Strips that touch the edge of the kernel's pieces, or leave the triangle there.
            let mut kinks = Vec::new();
            let normal = side.cross(altitude).normalize_or_zero();
            let height = (point - a).dot(normal);
            for kink in k.kinks() {
                let reach = ((kink / s).powi(2) - height * height).max(0.0).sqrt();
                let middle = near(foot, altitude, point);
                let step = reach / altitude.length();
                kinks.extend([middle - step, middle + step]);
                for (p, d) in [(a, c - a), (b, c - b)] {
                    let near = near(p, d, point);
                    let beside = (p + d * near).distance_squared(point);
                    let reach = ((kink / s).powi(2) - beside).max(0.0).sqrt() / d.length();
                    kinks.extend([near - reach, near + reach]);
                }
            }
            // Strips through the feet on the sides, where the pole comes near.
            kinks.extend([near(a, c - a, point), near(b, c - b, point)]);
            altitude.length()
                * split(
                    |t| {
                        let (p, q) = (a + (c - a) * t, b + (c - b) * t);
                        along(p, q - p)
                    },
                    near(foot, altitude, point),
                    grain(altitude.length()),
                    kinks.into_iter(),
                )
        }
        Skeleton::Polygon { ref rings } => {
            // Triangles from one corner over every edge, counted by their orientation.
            let normal = area_vector(rings).normalize_or_zero();
            let apex = rings[0][0];
            let mut sum = 0.0;
            for (number, ring) in rings.iter().enumerate() {
                let turns = ring
                    .windows(2)
                    .map(|w| (w[0] - ring[0]).cross(w[1] - ring[0]));
                let runs = turns.sum::<DVec3>().dot(normal).signum();
                let wanted = if number == 0 { 1.0 } else { -1.0 };
                for i in 0..ring.len() {
                    let (p, q) = (ring[i], ring[(i + 1) % ring.len()]);
                    let area = (p - apex).cross(q - apex).dot(normal) * runs * wanted;
                    if area != 0.0 {
                        let corners = [apex, p, q];
                        let part = integrate(primitive, &Skeleton::Triangle { corners }, point);
                        sum += part * area.signum();
                    }
                }
            }
            sum
        }
        Skeleton::Plane { point: p, normal } => {
            let d = (point - p).dot(normal.normalize());
            // Rings; where the integral diverges, up to ten radii, else of radius t/(1−t)/s.
            let windowed = !k.is_finite_over(2);
            let kinks = k.kinks().map(|kink| {
                let r = (kink * kink - d * d * s * s).max(0.0).sqrt();
                r / (1.0 + r)
            });
            let (peak, grain) = if windowed {
                (0.0, k.finest().max(d.abs() * s) / 10.0)
            } else {
                (0.5, 1.0)
            };
            split(
                |t| {
                    let (r, stretch) = if windowed {
                        (10.0 * t / s, 10.0 / s)
                    } else {
                        let rest = 1.0 - t;
                        (t / rest / s, 1.0 / (rest * rest * s))
                    };
                    core::f64::consts::TAU * r * stretch * k.value(s * s * (d * d + r * r))
                },
                peak,
                grain,
                kinks,
            )
        }
        ref line => {
            let Some(at) = trace(line) else {
                return 0.0;
            };
            let breaks = breaks_along(k, &|t| s * at(t).0.distance(point));
            integral(
                &mut |t| {
                    let (place, speed) = at(t);
                    h(place) * speed
                },
                &breaks,
                1e-13,
            )
        }
    }
}

/// Computes the field of a tapered bone, integrated with each point's own radius and blobbiness.
fn integrate_tapered(primitive: &Primitive, shaping: &Shaping, point: DVec3) -> f64 {
    let k = define(primitive.kernel);
    let skeleton = &primitive.skeleton;
    let Some(at) = trace(skeleton) else {
        return 0.0;
    };
    // Length up to t: exact at the ends of steps, and integrated from the one before t.
    const STEPS: usize = 64;
    let place = |i: usize| i as f64 / STEPS as f64;
    let mut speed = |t: f64| at(t).1;
    let mut lengths = vec![0.0];
    for i in 0..STEPS {
        let step = integral(&mut speed, &[place(i), place(i + 1)], 1e-13);
        lengths.push(lengths[i] + step);
    }
    let total = lengths[STEPS];
    let here = |t: f64| {
        let i = ((t * STEPS as f64) as usize).min(STEPS - 1);
        let rest = match skeleton {
            Skeleton::Segment { .. } | Skeleton::Arc { .. } => (t - place(i)) * total,
            // A single panel is nearly always enough, and most of the time goes here.
            _ => {
                let (low, high) = (place(i), t.max(place(i)));
                of_one_panel(&mut |t| at(t).1, low, high, 1e-11)
            }
        };
        shaping.at((lengths[i] + rest) / total)
    };
    let breaks = breaks_along(k, &|t| {
        here(t).width().unwrap_or(0.0) * at(t).0.distance(point)
    });
    // Next to a pole, as narrow as 10⁻⁵, the rounding of places alone changes the integrand by more
    // than 10⁻¹² of itself.
    let tolerance = if k.has_pole() { 1e-11 } else { 1e-13 };
    integral(
        &mut |t| {
            let (q, speed) = at(t);
            let shaping = here(t);
            let (s, h) = (shaping.width(), shaping.height(skeleton));
            let s = s.unwrap_or(0.0);
            h.unwrap_or(0.0) * k.value(s * s * q.distance_squared(point)) * speed
        },
        &breaks,
        tolerance,
    )
}

/// Traces a line; `None` for other bones.
fn trace(skeleton: &Skeleton) -> Option<Trace<'_>> {
    Some(match *skeleton {
        Skeleton::Segment { base, apex } => Box::new(move |t| {
            let d = apex - base;
            (base + d * t, d.length())
        }),
        Skeleton::Arc {
            center,
            u,
            v,
            radius,
            angle,
        } => Box::new(move |t| {
            let (sine, cosine) = libm::sincos(angle * t);
            (center + radius * (u * cosine + v * sine), radius * angle)
        }),
        Skeleton::Curve { control } => {
            let c = cubic(control);
            Box::new(move |t| {
                let tangent = c[1] + t * (2.0 * c[2] + 3.0 * t * c[3]);
                (c[0] + t * (c[1] + t * (c[2] + t * c[3])), tangent.length())
            })
        }
        ref line if line.dimension() == 1 => {
            Box::new(move |t| (line.at(t), difference(|t| line.at(t), t, 0.01).length()))
        }
        _ => return None,
    })
}

/// Returns breaks in [0, 1] for an integrand that depends on a distance, in kernel widths: around
/// every place where the distance has a minimum, and where it passes a kink.
fn breaks_along(k: Definition, distance: &dyn Fn(f64) -> f64) -> Vec<f64> {
    const SAMPLES: usize = 400;
    let place = |i: usize| i as f64 / SAMPLES as f64;
    let mut breaks = Vec::new();
    for i in 0..=SAMPLES {
        let (a, b) = (place(i), place(i + 1).min(1.0));
        let before = distance(place(i.saturating_sub(1)));
        if distance(a) <= before && distance(a) <= distance(b) {
            let (mut low, mut high) = (place(i.saturating_sub(1)), b);
            for _ in 0..60 {
                let third = (high - low) / 3.0;
                if distance(low + third) < distance(high - third) {
                    high -= third;
                } else {
                    low += third;
                }
            }
            let middle = 0.5 * (low + high);
            let mut reach = 1e-6;
            breaks.push(middle);
            while reach < 1.0 {
                breaks.extend([middle - reach, middle + reach]);
                reach *= 4.0;
            }
            // The samples next to it may both be on the same side of a kink.
            for (a, b) in [(a.min(middle), middle), (middle, b.max(middle))] {
                breaks.extend(k.kinks().filter_map(|u| passes(distance, u, a, b)));
            }
        }
        breaks.extend(k.kinks().filter_map(|u| passes(distance, u, a, b)));
    }
    breaks.extend((0..=16).map(|i| f64::from(i) / 16.0));
    breaks.retain(|t| (0.0..=1.0).contains(t));
    breaks.sort_unstable_by(f64::total_cmp);
    breaks.dedup();
    breaks
}

/// Computes a derivative from differences over steps of h: it is exact but for h⁸f⁽⁹⁾/630.
pub(crate) fn difference<V>(f: impl Fn(f64) -> V, x: f64, h: f64) -> V
where
    V: core::ops::Sub<Output = V> + core::ops::Mul<f64, Output = V> + core::iter::Sum,
{
    let factors = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];
    let terms = factors.into_iter().zip(1..).map(|(factor, i)| {
        let step = f64::from(i) * h;
        (f(x + step) - f(x - step)) * (factor / h)
    });
    terms.sum()
}

/// Returns the place between two others where a function passes a level; `None` if it is on one
/// side at both.
fn passes(f: &dyn Fn(f64) -> f64, level: f64, mut a: f64, mut b: f64) -> Option<f64> {
    let below = f(a) < level;
    if below == (f(b) < level) {
        return None;
    }
    for _ in 0..60 {
        let middle = 0.5 * (a + b);
        if (f(middle) < level) == below {
            a = middle;
        } else {
            b = middle;
        }
    }
    Some(a)
}

/// Computes the whole field at a point, by integration.
#[must_use]
pub fn sum(field: &Sum, point: DVec3) -> f64 {
    field.primitives.iter().map(|p| value(p, point)).sum()
}

/// Integrates a function from 0 to 1 that has a peak at `peak`, of about the width `grain`, and
/// kinks: panels grow fourfold away from the peak, and end at kinks.
pub(crate) fn split(
    mut f: impl FnMut(f64) -> f64,
    peak: f64,
    grain: f64,
    kinks: impl Iterator<Item = f64>,
) -> f64 {
    let peak = if peak.is_finite() {
        peak.clamp(0.0, 1.0)
    } else {
        0.0
    };
    let grain = grain.max(1e-9);
    let mut breaks = vec![0.0, peak, 1.0];
    let mut reach = grain;
    while reach < 1.0 {
        breaks.extend([peak - reach, peak + reach]);
        reach *= 4.0;
    }
    breaks.extend(kinks);
    breaks.retain(|t| (0.0..=1.0).contains(t));
    breaks.sort_unstable_by(f64::total_cmp);
    breaks.dedup();
    integral(&mut f, &breaks, 1e-13)
}

/// Returns the t of the point's foot on `base + t·d`.
fn near(base: DVec3, d: DVec3, point: DVec3) -> f64 {
    (point - base).dot(d) / d.length_squared()
}

/// Computes a profile's factor, from its definition in the world.
fn factor(profile: &Profile, skeleton: &Skeleton, point: DVec3) -> f64 {
    let (u, v) = match *skeleton {
        Skeleton::Segment { base, apex } => (near(base, apex - base, point), 0.0),
        Skeleton::Arc {
            center,
            u,
            v,
            angle,
            ..
        } => {
            let d = point - center;
            let t = libm::atan2(d.dot(v), d.dot(u)).rem_euclid(core::f64::consts::TAU);
            // A point of the gap is before the start if that is nearer than the end.
            let past = t - angle;
            let before = core::f64::consts::TAU - t;
            (
                if past > 0.0 && before < past {
                    0.0
                } else {
                    t / angle
                },
                0.0,
            )
        }
        Skeleton::Triangle { corners: [a, b, c] } => {
            let (e1, e2, d) = (b - a, c - a, point - a);
            let n = e1.cross(e2);
            let area = n.length_squared();
            (n.dot(d.cross(e2)) / area, n.dot(e1.cross(d)) / area)
        }
        // Other bones have no parameters.
        _ => (0.0, 0.0),
    };
    let [low, high] = profile.bounds;
    let product = wave(profile.waves[0], profile.scale[0] * u.clamp(0.0, 1.0))
        * wave(profile.waves[1], profile.scale[1] * v.clamp(0.0, 1.0));
    let product = match *skeleton {
        Skeleton::Arc {
            center,
            u,
            v,
            radius,
            ..
        } => {
            let d = point - center;
            let q = libm::sqrt(d.dot(u) * d.dot(u) + d.dot(v) * d.dot(v)) / radius;
            let root = 2.0 * q / (1.0 + q * q);
            let mean = mean(profile);
            mean + root * root * (product - mean)
        }
        _ => product,
    };
    let restricted = match skeleton {
        Skeleton::Triangle { .. } => {
            let inside = u > 0.0 && v > 0.0 && u + v < 1.0;
            let middle = if inside {
                27.0 * u * v * (1.0 - u - v)
            } else {
                0.0
            };
            1.0 - profile.restriction * (1.0 - middle)
        }
        _ => 1.0,
    };
    profile.times * (low + (high - low) * product) * restricted
}

/// Computes the waves' mean over u, where v is 0; between two multiples of ½ every wave is smooth.
fn mean(profile: &Profile) -> f64 {
    let scale = profile.scale[0];
    if scale == 0.0 {
        return wave(profile.waves[0], 0.0) * wave(profile.waves[1], 0.0);
    }
    let pieces = (2.0 * scale.abs()).ceil().max(1.0) as u32;
    let breaks: Vec<f64> = (0..=pieces)
        .map(|i| (0.5 * f64::from(i) / scale.abs()).min(1.0))
        .collect();
    let along = integral(&mut |u| wave(profile.waves[0], scale * u), &breaks, 1e-13);
    along * wave(profile.waves[1], 0.0)
}

/// Computes a wave at x.
fn wave(wave: Wave, x: f64) -> f64 {
    let fraction = x - x.floor();
    let (sine, cosine) = libm::sincos(x);
    match wave {
        Wave::One => 1.0,
        Wave::X => x.clamp(0.0, 1.0),
        Wave::Sin => (1.0 + sine) / 2.0,
        Wave::Cos => (1.0 + cosine) / 2.0,
        Wave::Sin2 => sine * sine,
        Wave::Cos2 => cosine * cosine,
        Wave::Saw => fraction,
        Wave::Hat => 1.0 - (2.0 * fraction - 1.0).abs(),
        Wave::Step => f64::from(u8::from(fraction >= 0.5)),
    }
}
