//! Bounds ([`field::Bound`]) hold: for values, slopes, curvatures and the errors of Hermite spans.

use field::bound::{Bound, Estimate, SpanLength};
use field::{Kernel, Primitive, Profile, Shaping, Taper, Wave};
use glam::DVec3;
use oracle::evaluation::{primitive, span_error};
use trials::skeletons::{ALL_KINDS, Kind};
use trials::{Random, count};

/// Options of a primitive beyond kernel and bone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Dress {
    Plain,
    /// A profile.
    Wavy,
    /// A radius and a blobbiness that vary.
    Tapered,
}

impl Dress {
    /// The kinds of bones that can have it.
    fn kinds(self) -> &'static [Kind] {
        match self {
            Self::Plain => &ALL_KINDS,
            Self::Wavy => &[Kind::Segment, Kind::Arc, Kind::Triangle],
            Self::Tapered => &[Kind::Segment, Kind::Arc, Kind::Curve],
        }
    }
}

/// Returns a random primitive of this kernel and kind.
fn random_primitive(random: &mut Random, kernel: Kernel, kind: Kind, dress: Dress) -> Primitive {
    let size = random.decades(-1.5, 1.0);
    let skeleton = random.skeleton(kind, size);
    let mut shaping = Shaping {
        kernel,
        ..random.shaping(1.0)
    };
    if dress == Dress::Tapered {
        shaping.taper = Some(Taper {
            radius: random.range(0.7, 1.3),
            blobbiness: shaping.blobbiness * random.range(0.7, 1.3),
        });
    }
    let profile = (dress == Dress::Wavy).then(|| smooth_profile(random));
    primitive(skeleton, &shaping, profile)
}

/// Returns a profile of smooth waves.
fn smooth_profile(random: &mut Random) -> Profile {
    let waves = [Wave::Sin, Wave::Cos, Wave::Sin2, Wave::Cos2, Wave::One];
    Profile {
        waves: [random.pick(&waves[..4]), random.pick(&waves)],
        scale: [random.range(1.0, 20.0), random.range(0.5, 8.0)],
        bounds: [random.range(0.2, 0.9), 1.0],
        times: random.range(0.5, 1.5),
        restriction: random.pick(&[0.0, 0.7]),
    }
}

fn bounds_hold(kernel: Kernel) {
    for dress in [Dress::Plain, Dress::Wavy, Dress::Tapered] {
        for kind in dress.kinds() {
            bounds_hold_of(kernel, *kind, dress);
        }
    }
}

fn bounds_hold_of(kernel: Kernel, kind: Kind, dress: Dress) {
    let mut random = Random::new(31);
    let (mut tightest, mut tightest_span) = (0.0_f64, 0.0_f64);
    let (mut tightest_slope, mut tightest_turn) = (0.0_f64, 0.0_f64);
    let mut tightest_bend = 0.0_f64;
    // Tapers take long to prepare, so that there are fewer, which do not come near to the bounds.
    let [cases, least] = if dress == Dress::Tapered {
        [8, 8]
    } else {
        [80, 12]
    };
    for _ in 0..count(cases).max(least) {
        let primitive = random_primitive(&mut random, kernel, kind, dress);
        let kinks = field::kinks::of(&primitive);
        let bound = Bound::new(&primitive);
        for _ in 0..10 {
            // A ball, and spans within it.
            let center = random.near(&primitive.skeleton, -1.0, 0.4);
            let radius = random.decades(-2.0, 0.0) / primitive.width;
            if kinks.iter().any(|kink| kink.cuts(center, radius)) {
                continue;
            }
            let near = bound.nearness(center, radius);
            let nearest = primitive.skeleton.nearest(center);
            let way = (nearest - center).normalize_or_zero();
            let p = center + way * radius;
            let reach = primitive.skeleton.distance(p);
            assert!(
                near.distance <= reach * (1.0 + 1e-9) + 1e-9,
                "{primitive:?} {p}"
            );
            let magnitude = bound.magnitude(near);
            let value = primitive.value(p.to_array()).abs();
            // Far out, sums over edges leave rounding errors of the field near by.
            let rounding = 1e-15 * primitive.most_beyond(0.5 / primitive.width);
            assert!(
                value <= magnitude * (1.0 + 1e-6) + rounding,
                "{value} > {magnitude}: {primitive:?} {p}"
            );
            tightest = tightest.max(value / magnitude);
            let gradient = DVec3::from_array(primitive.jet(p.to_array()).gradient);
            let steepest = bound.slope(near);
            let tolerance = 1e-6 * steepest + 1e3 * rounding * primitive.width;
            assert!(
                gradient.length() <= steepest + tolerance,
                "{gradient} is steeper than {steepest}: {primitive:?} {p}"
            );
            tightest_slope = tightest_slope.max(gradient.length() / steepest);
            let direction = random.direction();
            let h = 2.0 * radius;
            let Estimate { error, .. } = bound.estimate(near, &SpanLength::new(h));
            let off = span_error(&primitive, center - direction * radius, direction, h);
            // The slope along a chord of the ball turns no faster than the curvature allows.
            let start = center - direction * radius;
            let slope_at = |t: f64| primitive.along_ray(start, direction, t).1;
            let turned = (slope_at(0.7 * h) - slope_at(0.3 * h)).abs();
            let allowed = 0.4 * h * bound.curvature(near);
            assert!(
                turned <= allowed * (1.0 + 1e-6) + 1e-6 * steepest + tolerance,
                "{turned} > {allowed} on {h}: {primitive:?} {center}"
            );
            tightest_turn = tightest_turn.max(turned / allowed);
            // The slope on a chord is off its linear interpolant by an eighth of the third
            // derivative times its square.
            let bent = slope_at(0.5 * h) - 0.5 * (slope_at(0.3 * h) + slope_at(0.7 * h));
            let allowed = 0.125 * (0.4 * h) * (0.4 * h) * bound.third(near);
            assert!(
                bent.abs() <= allowed * (1.0 + 1e-6) + 1e-6 * steepest + tolerance,
                "{bent} > {allowed} on {h}: {primitive:?} {center}"
            );
            if allowed.is_finite() && allowed > 1e-4 * steepest + 100.0 * tolerance {
                tightest_bend = tightest_bend.max(bent.abs() / allowed);
            }
            let least = bound.least(center, radius);
            assert!(
                value >= least * (1.0 - 1e-9) - rounding,
                "{value} < {least}: {primitive:?} {p}"
            );
            let far = center - way * radius;
            let value = primitive.value(far.to_array()).abs();
            assert!(
                value >= least * (1.0 - 1e-9) - rounding,
                "{value} < {least}: {primitive:?} {far}"
            );
            // Rounding in f64, and of cells that are integrated numerically.
            let noise = 1e-9 * magnitude + rounding;
            assert!(
                off <= error + noise,
                "{off} > {error} on {h}: {primitive:?} {center}"
            );
            if noise < 0.01 * error {
                tightest_span = tightest_span.max(off / error);
            }
        }
    }
    // The bounds are of use: somewhere a good part of them is taken up.
    // The slopes of a plane of poles cancel but for a hair.
    let least = match kind {
        Kind::Plane if !kernel.is_finite_over(2) => 0.0,
        _ => 0.02,
    };
    assert!(
        tightest > 0.3 && tightest_span > least && tightest_slope > least,
        "{kind:?} {dress:?}: {tightest} {tightest_span} {tightest_slope}"
    );
    assert!(tightest_turn > least, "{kind:?} {dress:?}: {tightest_turn}");
    // The third derivative may be told nowhere, for kernels that end in a kink and for planes.
    assert!(
        tightest_bend <= 1.0 && (tightest_bend == 0.0 || tightest_bend > 0.1 * least),
        "{kind:?} {dress:?}: {tightest_bend}"
    );
}

#[test]
fn cauchy() {
    bounds_hold(Kernel::Cauchy);
}
#[test]
fn gauss() {
    bounds_hold(Kernel::Gauss);
}
#[test]
fn inverse() {
    bounds_hold(Kernel::Inverse);
}
#[test]
fn squared() {
    bounds_hold(Kernel::Squared);
}
#[test]
fn metaballs() {
    bounds_hold(Kernel::Metaballs);
}
#[test]
fn soft() {
    bounds_hold(Kernel::Soft);
}
#[test]
fn quartic() {
    bounds_hold(Kernel::Quartic);
}
#[test]
fn compact6() {
    bounds_hold(Kernel::Compact6);
}
#[test]
fn cubed() {
    bounds_hold(Kernel::Cubed);
}

/// The field with a profile is nowhere above that without one times the factor between two points,
/// and as large on restricted triangles.
#[test]
fn a_profile_is_nowhere_above_its_bound_between_two_points() {
    let mut random = Random::new(17);
    let (mut nearest, mut plain_differs) = (0.0_f64, 0);
    for case in 0..count(600) {
        let kind = random.pick(Dress::Wavy.kinds());
        let skeleton = random.skeleton(kind, 1.0);
        let shaping = Shaping {
            strength: 1.0,
            ..random.shaping(1.0)
        };
        let profile = match case % 3 {
            0 => Profile {
                restriction: random.range(0.1, 1.0),
                ..Profile::default()
            },
            _ => smooth_profile(&mut random),
        };
        let bare = primitive(skeleton.clone(), &shaping, None);
        let wavy = primitive(skeleton, &shaping, Some(profile));
        let ends = [0; 2].map(|_| random.vector(1.0));
        let most = wavy.factor_between(ends.map(|end| end.to_array()));
        for i in 0..=20 {
            let point = ends[0].lerp(ends[1], f64::from(i) / 20.0).to_array();
            let (value, plain): (f64, f64) = (wavy.value(point), wavy.plain_value(point));
            plain_differs += usize::from(plain != bare.value(point));
            let bound = most * plain * (1.0 + 1e-12);
            assert!(value <= bound, "{case} {kind:?}: {value} > {bound}");
            if case % 3 == 0 && kind == Kind::Triangle {
                nearest = nearest.max(value / bound);
            }
        }
    }
    assert_eq!(plain_differs, 0);
    assert!(nearest > 0.99, "{nearest}");
}
