//! Profiles in a primitive's local frame: the factor on its field and that factor's gradient.
use crate::angle::direction;
use crate::bone::Bone;
use crate::{Jet, Profile, Real, Wave};

/// Source of the natural parameters u, v of a primitive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Parameters<S> {
    /// Nowhere: both are 0 (points and planes).
    None,
    /// u and v are linear functions `gradient·p + start` (segments and triangles), cut to [0, 1].
    Linear {
        gradient: [[S; 2]; 2],
        start: [S; 2],
    },
    /// u is the angle from an arc's start over the arc's angle, clamped to [0, 1]. On the circle's
    /// axis the angle is undefined: with q the distance from the axis over the circle's radius, the
    /// waves count as `g = (2q/(1+q²))²`, which is 1 and flat at the circle and 0 on the axis, and
    /// their `mean` over the arc counts as `1 − g`.
    Angle {
        radius: S,
        side: S,
        start: S,
        rate: S,
        mean: S,
    },
}

/// Profile prepared for evaluation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Waves<S> {
    pub waves: [Wave; 2],
    /// The waves' places in [`Wave::ALL`].
    kinds: [S; 2],
    pub scale: [S; 2],
    pub low: S,
    pub rise: S,
    /// Restriction of a [`Profile`]; 0 but on triangles.
    restriction: S,
    parameters: Parameters<S>,
}

impl Waves<f64> {
    pub fn new(profile: &Profile, bone: &Bone<f64>) -> Self {
        let parameters = match bone {
            Bone::Point | Bone::Plane | Bone::Polygon(_) | Bone::Curve(_) => Parameters::None,
            Bone::Segment(segment) => Parameters::Linear {
                gradient: [[inverse(2.0 * segment.half), 0.0], [0.0; 2]],
                start: [0.5, 0.0],
            },
            Bone::Arc(arc) => Parameters::Angle {
                radius: arc.radius,
                side: arc.side,
                start: arc.half_angle,
                rate: inverse(2.0 * arc.half_angle),
                mean: mean(profile),
            },
            Bone::Triangle(triangle) => {
                // The inverse of the matrix of the sides from corner 0.
                let [[ax, ay], b, c] = triangle.corners;
                let e1 = [b[0] - ax, b[1] - ay];
                let e2 = [c[0] - ax, c[1] - ay];
                let i = inverse(triangle.double_area);
                let gradient = [[e2[1] * i, -e2[0] * i], [-e1[1] * i, e1[0] * i]];
                Parameters::Linear {
                    gradient,
                    start: gradient.map(|[gx, gy]| -(gx * ax + gy * ay)),
                }
            }
        };
        Self {
            waves: profile.waves,
            kinds: profile.waves.map(|wave| wave as u8 as f64),
            scale: profile.scale,
            low: profile.times * profile.bounds[0],
            rise: profile.times * (profile.bounds[1] - profile.bounds[0]),
            restriction: match bone {
                Bone::Triangle(_) => profile.restriction,
                _ => 0.0,
            },
            parameters,
        }
    }
}

/// The mean of the waves along u, where v is 0: `1/s·∫₀ˢ wave` with s the scale of u.
fn mean(profile: &Profile) -> f64 {
    let s = profile.scale[0];
    let (whole, part) = (s.floor(), s - s.floor());
    let along = match profile.waves[0] {
        _ if s == 0.0 => wave(profile.waves[0], s).0,
        Wave::One => 1.0,
        Wave::X if s < 0.0 => 0.0,
        Wave::X if s < 1.0 => s / 2.0,
        Wave::X => 1.0 - 0.5 / s,
        Wave::Sin => (1.0 + (1.0 - libm::cos(s)) / s) / 2.0,
        Wave::Cos => (1.0 + libm::sin(s) / s) / 2.0,
        Wave::Sin2 => (1.0 - libm::sin(2.0 * s) / (2.0 * s)) / 2.0,
        Wave::Cos2 => (1.0 + libm::sin(2.0 * s) / (2.0 * s)) / 2.0,
        // The periodic ones have mean ½ over a period.
        Wave::Saw => (whole + part * part) / (2.0 * s),
        Wave::Hat if part <= 0.5 => (whole / 2.0 + part * part) / s,
        Wave::Hat => (whole / 2.0 + 0.5 - (1.0 - part) * (1.0 - part)) / s,
        Wave::Step => (whole / 2.0 + (part - 0.5).max(0.0)) / s,
    };
    along * wave(profile.waves[1], 0.0).0
}

/// 1/x, or 0 where x is 0: then a parameter is constant at its start.
fn inverse(x: f64) -> f64 {
    if x > 0.0 { 1.0 / x } else { 0.0 }
}

impl<S: Copy> Waves<S> {
    pub fn cast<Q>(&self, f: impl Fn(S) -> Q + Copy) -> Waves<Q> {
        Waves {
            waves: self.waves,
            kinds: self.kinds.map(f),
            scale: self.scale.map(f),
            low: f(self.low),
            rise: f(self.rise),
            restriction: f(self.restriction),
            parameters: match &self.parameters {
                Parameters::None => Parameters::None,
                Parameters::Linear { gradient, start } => Parameters::Linear {
                    gradient: gradient.map(|g| g.map(f)),
                    start: start.map(f),
                },
                Parameters::Angle {
                    radius,
                    side,
                    start,
                    rate,
                    mean,
                } => Parameters::Angle {
                    radius: f(*radius),
                    side: f(*side),
                    start: f(*start),
                    rate: f(*rate),
                    mean: f(*mean),
                },
            },
        }
    }

    /// Returns the name of the place that the waves run along.
    pub fn course(&self) -> &'static str {
        match self.parameters {
            Parameters::None => "nowhere",
            Parameters::Linear { .. } => "plane",
            Parameters::Angle { .. } => "circle",
        }
    }

    /// Returns an upper bound on the factor between two local positions, at least 0. On a triangle
    /// each barycentric coordinate is linear between them.
    #[inline(always)]
    pub fn most_between<R: Real<Scalar = S>>(&self, ends: [[R; 3]; 2]) -> R {
        let (zero, one) = (R::splat(0.0), R::splat(1.0));
        let low = R::lift(self.low);
        let most = low.max(low + R::lift(self.rise)).max(zero);
        let Parameters::Linear { gradient, start } = &self.parameters else {
            return most;
        };
        let [near, far] = ends.map(|p| {
            let [u, v] = [0, 1].map(|i| {
                let [x, y] = gradient[i].map(R::lift);
                x * p[0] + y * p[1] + R::lift(start[i])
            });
            [u, v, one - u - v]
        });
        let [u, v, w] = core::array::from_fn(|i| near[i].max(far[i]).max(zero));
        // 1 − restriction·(1−b), where b = 27·uvw is at most 1.
        let lost = R::lift(self.restriction) * (one - (R::splat(27.0) * u * v * w).min(one));
        most * (one - lost)
    }

    /// The factor and its local gradient at a local position.
    #[inline(always)]
    pub fn jet<R: Real<Scalar = S>>(&self, p: [R; 3]) -> Jet<R> {
        let zero = R::splat(0.0);
        let one = R::splat(1.0);
        let two = R::splat(2.0);
        // u and v, not yet cut, and their derivatives in the plane; and how much the waves count.
        let (parameters, gradients, fade) = match &self.parameters {
            Parameters::None => ([zero; 2], [[zero; 2]; 2], None),
            Parameters::Linear { gradient, start } => {
                let gradient = gradient.map(|g| g.map(R::lift));
                (
                    [0, 1]
                        .map(|i| gradient[i][0] * p[0] + gradient[i][1] * p[1] + R::lift(start[i])),
                    gradient,
                    None,
                )
            }
            Parameters::Angle {
                radius,
                side,
                start,
                rate,
                mean,
            } => {
                // Coordinates from the circle's centre, x towards the arc's middle: the jump of the
                // angle is then in the middle of the gap.
                let (side, rate) = (R::lift(*side), R::lift(*rate));
                let radius = R::lift(*radius);
                let x = side * (radius + p[0]);
                let y = side * p[1];
                let square = (x * x + y * y).max(R::splat(1e-30));
                let both = square + radius * radius;
                let share = radius * radius / both;
                let g = R::splat(4.0) * share * (one - share);
                let slope = R::splat(8.0) * share * (two * share - one) / both;
                let fade = Fade {
                    g,
                    gradient: [slope * side * x, slope * side * y],
                    mean: R::lift(*mean),
                };
                (
                    [(direction(y, x) + R::lift(*start)) * rate, zero],
                    [
                        [-(side * y * rate) / square, side * x * rate / square],
                        [zero; 2],
                    ],
                    Some(fade),
                )
            }
        };
        let factors = [0, 1].map(|i| {
            let scale = R::lift(self.scale[i]);
            let cut = parameters[i].max(zero).min(one);
            let [value, slope] = R::one_of(
                self.kinds[i],
                self.waves[i] as usize,
                Wave::ALL.len(),
                |kind| wave(Wave::ALL[kind], scale * cut).into(),
            );
            let inside = R::both(zero.lt(parameters[i]), parameters[i].lt(one));
            (value, R::select(inside, scale * slope, zero))
        });
        let mut value = factors[0].0 * factors[1].0;
        let (by_u, by_v) = (factors[0].1 * factors[1].0, factors[0].0 * factors[1].1);
        let mut gradient = [0, 1].map(|i| by_u * gradients[0][i] + by_v * gradients[1][i]);
        if let Some(Fade {
            g,
            gradient: of_g,
            mean,
        }) = fade
        {
            let swing = value - mean;
            gradient = [0, 1].map(|i| g * gradient[i] + swing * of_g[i]);
            value = mean + g * swing;
        }
        let rise = R::lift(self.rise);
        let value = R::lift(self.low) + rise * value;
        let gradient = gradient.map(|g| rise * g);
        // 1 − restriction·(1−b); b and its derivatives vanish outside the triangle.
        let restriction = R::lift(self.restriction);
        let [u, v] = parameters;
        let w = one - u - v;
        let inside = zero.lt(u.min(v).min(w));
        let steep = |x: R| R::select(inside, R::splat(27.0) * restriction * x, zero);
        let factor = one - restriction + steep(u * v * w);
        let (by_u, by_v) = (steep(v * (w - u)), steep(u * (w - v)));
        let [gu, gv] = gradients;
        let [along_x, along_y] =
            [0, 1].map(|i| factor * gradient[i] + value * (by_u * gu[i] + by_v * gv[i]));
        Jet {
            value: value * factor,
            gradient: [along_x, along_y, zero],
        }
    }
}

/// Weight of the waves; their mean has the rest.
struct Fade<R> {
    g: R,
    gradient: [R; 2],
    mean: R,
}

/// Computes a wave and its derivative.
#[inline(always)]
fn wave<R: Real>(wave: Wave, x: R) -> (R, R) {
    let zero = R::splat(0.0);
    let one = R::splat(1.0);
    let two = R::splat(2.0);
    let half = R::splat(0.5);
    match wave {
        Wave::One => (one, zero),
        Wave::X => {
            let inside = R::both(zero.lt(x), x.lt(one));
            (x.max(zero).min(one), R::select(inside, one, zero))
        }
        Wave::Sin => {
            let (s, c) = x.sin_cos();
            (half + half * s, half * c)
        }
        Wave::Cos => {
            let (s, c) = x.sin_cos();
            (half + half * c, -(half * s))
        }
        Wave::Sin2 => {
            let (s, c) = x.sin_cos();
            (s * s, two * s * c)
        }
        Wave::Cos2 => {
            let (s, c) = x.sin_cos();
            (c * c, -(two * s * c))
        }
        Wave::Saw => (x - x.floor(), one),
        Wave::Hat => {
            let t = two * (x - x.floor()) - one;
            (one - t.abs(), -t.sign_to(two))
        }
        Wave::Step => (R::select((x - x.floor()).lt(half), zero, one), zero),
    }
}
