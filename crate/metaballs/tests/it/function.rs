//! The function against a plain sum, differences and samples.

use crate::common::lumpy_sphere;
use field::{Ball, Enclosure, Implicit, Jet, Slack, THRESHOLD};
use glam::DVec3;
use metaballs::{Error, Kind, Metaballs, circumcircle, nearest};
use trials::{Random, count};
use wide::f32x8;

const KINDS: [(Kind, f64); 3] = [
    (Kind::Spherical, 12.0),
    (Kind::Triangular { thickness: 0.05 }, 40.0),
    (Kind::Triangular { thickness: 0.0 }, 25.0),
];

fn balls(kind: Kind, k: f64, rings: u32) -> (Metaballs, Vec<[DVec3; 3]>) {
    let (positions, triangles) = lumpy_sphere(rings, 7);
    let facets = triangles
        .iter()
        .map(|t| t.map(|i| positions[i as usize]))
        .collect();
    let made = Metaballs::new(&positions, &triangles, kind, k).expect("a good mesh");
    (made, facets)
}

/// The definition without any cut, and the number of facets within reach.
fn plain(facets: &[[DVec3; 3]], kind: Kind, k: f64, p: DVec3) -> Jet<f64> {
    let mut sum = Jet::zero();
    for facet in facets {
        let (from, radius) = match kind {
            Kind::Spherical => circumcircle(facet),
            Kind::Triangular { thickness } => (mesh::closest_point(facet, p), thickness),
        };
        let value = libm::exp(-k * (p.distance(from) - radius));
        let gradient = (p - from).normalize_or_zero() * (-k * value);
        sum = sum.plus(Jet {
            value,
            gradient: gradient.to_array(),
        });
    }
    sum
}

#[test]
fn cut_sum_is_the_plain_sum_but_for_the_stated_remainder() {
    for (kind, k) in KINDS {
        let (balls, facets) = balls(kind, k, 12);
        let mut random = Random::new(1);
        for _ in 0..count(2000) {
            let p = random.vector(1.4);
            let exact = plain(&facets, kind, k, p);
            let jet = balls.jet(p);
            let remainder = 1.2e-7 * facets.len() as f64;
            let tolerance = remainder + 1e-9 * exact.value;
            assert!((jet.value - exact.value).abs() < tolerance, "{kind:?} {p}");
            for i in 0..3 {
                assert!((jet.gradient[i] - exact.gradient[i]).abs() < 1.5 * k * tolerance);
            }
        }
    }
}

#[test]
fn cut_sum_is_the_sum_of_all_facets_within_reach() {
    for (kind, k) in KINDS {
        let (balls, facets) = balls(kind, k, 12);
        let mut random = Random::new(2);
        for _ in 0..count(500) {
            let p = random.vector(1.4);
            let mut sum = 0.0;
            for facet in &facets {
                let (distance, radius) = match kind {
                    Kind::Spherical => {
                        let (center, radius) = circumcircle(facet);
                        (p.distance(center), radius)
                    }
                    Kind::Triangular { thickness } => {
                        (p.distance(nearest(facet, p).point), thickness)
                    }
                };
                sum += metaballs::profile(k * (distance - radius)).0;
            }
            let value = balls.jet(p).value;
            assert!((value - sum).abs() < 1e-11 * (1.0 + sum), "{value} {sum}");
        }
    }
}

#[test]
fn gradient_agrees_with_differences() {
    let h = 1e-6;
    for (kind, k) in KINDS {
        let (balls, _) = balls(kind, k, 8);
        let mut random = Random::new(3);
        for _ in 0..count(1000) {
            let p = random.direction() * (random.range(0.8, 1.2));
            let jet = balls.jet(p);
            for (axis, gradient) in [DVec3::X, DVec3::Y, DVec3::Z].iter().zip(jet.gradient) {
                let [after, before] = [p + axis * h, p - axis * h].map(|p| balls.jet(p).value);
                let difference = (after - before) / (2.0 * h);
                let error = (difference - gradient).abs();
                assert!(error < 1e-3 * k * (0.1 + jet.value), "{kind:?} {p} {error}");
            }
        }
    }
}

#[test]
fn single_precision_is_near_and_lanes_are_equal_to_it() {
    for (kind, k) in KINDS {
        let (balls, _) = balls(kind, k, 12);
        let mut random = Random::new(4);
        for _ in 0..count(300) {
            let middle = random.direction();
            let points: [DVec3; 8] = core::array::from_fn(|_| middle + random.vector(0.2));
            let lanes = [0, 1, 2].map(|i| f32x8::new(points.map(|p| p[i] as f32)));
            let together = balls.jet8(lanes);
            for (lane, p) in points.iter().enumerate() {
                let alone = balls.jet32(p.to_array().map(|x| x as f32));
                assert_eq!(
                    together.value.to_array()[lane].to_bits(),
                    alone.value.to_bits()
                );
                for (g, alone) in together.gradient.iter().zip(alone.gradient) {
                    assert_eq!(g.to_array()[lane].to_bits(), alone.to_bits());
                }
                let exact = balls.jet(*p);
                let error = (f64::from(alone.value) - exact.value).abs();
                assert!(error < 1e-4 * (0.1 + exact.value), "{kind:?} {p} {error}");
            }
        }
    }
}

#[test]
fn enclosures_hold() {
    for (kind, k) in KINDS {
        let (balls, _) = balls(kind, k, 10);
        let mut random = Random::new(5);
        let (mut decided, mut curved, mut together) = (0, 0, 0);
        for _ in 0..count(1500) {
            let center = random.vector(1.5);
            // From far below the size of a facet to above that of the mesh.
            let radius = libm::exp(-9.0 * random.unit()) * 1.5;
            let ball = Ball { center, radius };
            // The two ways in turn.
            let enclosure = if random.chance(0.5) {
                balls.enclose(ball)
            } else {
                let (variation, jet) = balls.variation_with_jet(None, ball);
                if let Some(jet) = jet {
                    together += 1;
                    assert_eq!(jet, balls.jet(center));
                }
                Enclosure {
                    curvature: if variation.jump > 0.0 {
                        f64::INFINITY
                    } else {
                        variation.curvature
                    },
                    ..variation.range
                }
            };
            let [low, high] = enclosure.value;
            decided += usize::from(low > THRESHOLD || high < THRESHOLD);
            curved += usize::from(enclosure.curvature.is_finite());
            for _ in 0..20 {
                let p = center + random.direction() * radius * random.unit();
                let jet = balls.jet(p);
                assert!(
                    low <= jet.value && jet.value <= high,
                    "{kind:?} {center} {radius}"
                );
                let gradient = DVec3::from_array(jet.gradient);
                assert!(gradient.length() <= enclosure.slope * (1.0 + 1e-9));
                // The gradient between two points of the ball, as far as the bound says.
                let q = center + random.direction() * radius * random.unit();
                let change = gradient - DVec3::from_array(balls.jet(q).gradient);
                let along = (p - q).normalize_or_zero();
                let bend = change.dot(along).abs();
                assert!(bend <= enclosure.curvature * p.distance(q) * (1.0 + 1e-6) + 1e-9 * k);
            }
        }
        // They say something, too.
        assert!(
            decided > count(500) && curved > count(700),
            "{kind:?} {decided} {curved}"
        );
        assert!(together > count(200), "{kind:?} {together}");
    }
}

#[test]
fn surface_is_within_its_support() {
    for (kind, k) in KINDS {
        let (balls, _) = balls(kind, k, 6);
        let support = balls.support().expect("a mesh is bounded");
        let mut random = Random::new(6);
        for _ in 0..count(2000) {
            let p = support.center + random.direction() * support.radius * (1.0 + random.unit());
            assert!(balls.jet(p).value < THRESHOLD);
        }
    }
}

#[test]
fn surface_has_the_stated_thickness() {
    // A plane of facets: above the inside of a facet d₀, above an edge d₀ + ln 2/k, above a vertex
    // of six d₀ + ln 6/k.
    let (positions, triangles) = grid(20);
    let kind = Kind::Triangular { thickness: 0.2 };
    let k = 50.0;
    let balls = Metaballs::new(&positions, &triangles, kind, k).expect("a good mesh");
    let height = |x: f64, y: f64| {
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let z = 0.5 * (low + high);
            let inside = balls.jet(DVec3::new(x, y, z)).value > THRESHOLD;
            *(if inside { &mut low } else { &mut high }) = z;
        }
        low
    };
    let above = |count: f64| 0.2 + libm::log(count) / k;
    // Of other facets, at least d = √(0.2² + 0.2²) away, e^(−50·0.08) remains.
    assert!((height(10.25, 10.25) - above(1.0)).abs() < 0.04 / k);
    assert!((height(10.5, 10.0) - above(2.0)).abs() < 0.02 / k);
    assert!((height(10.0, 10.0) - above(6.0)).abs() < 0.02 / k);
}

fn grid(side: u32) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let at = |x: u32, y: u32| y * (side + 1) + x;
    let places = (0..=side).flat_map(|y| (0..=side).map(move |x| (x, y)));
    let positions = places.map(|(x, y)| DVec3::new(f64::from(x), f64::from(y), 0.0));
    let mut triangles = Vec::new();
    for y in 0..side {
        for x in 0..side {
            let [a, b, c, d] = [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)];
            triangles.extend([[a, b, d], [b, c, d]]);
        }
    }
    (positions.collect(), triangles)
}

#[test]
fn degenerate_facets_are_segments_and_points() {
    let positions = [DVec3::ZERO, DVec3::X, 0.4 * DVec3::X, DVec3::X];
    let triangles = [[0, 1, 2], [2, 1, 0], [1, 3, 1]];
    let kind = Kind::Triangular { thickness: 0.1 };
    let k = 30.0;
    let balls = Metaballs::new(&positions, &triangles, kind, k).expect("flat facets are allowed");
    let mut random = Random::new(8);
    for _ in 0..count(500) {
        let p = random.vector(0.6) + 0.5 * DVec3::X;
        let on_axis = DVec3::new(p.x.clamp(0.0, 1.0), 0.0, 0.0);
        let term = |d: f64| metaballs::profile(k * (d - 0.1)).0;
        let exact = 2.0 * term(p.distance(on_axis)) + term(p.distance(DVec3::X));
        assert!((balls.jet(p).value - exact).abs() < 1e-9 * (1.0 + exact));
    }
}

#[test]
fn cost_grows_with_what_is_near() {
    // Facets found near the surface, with lengths in proportion to the mean edge.
    let [coarse, fine] = [24, 150].map(|rings| {
        let edge = 3.0 / f64::from(rings);
        let kind = Kind::Triangular {
            thickness: 0.2 * edge,
        };
        let (balls, _) = balls(kind, 12.0 / edge, rings);
        let mut random = Random::new(9);
        let near: usize = (0..200)
            .map(|_| balls.near(random.direction()).count())
            .sum();
        near as f64 / 200.0
    });
    assert!(fine < 1.3 * coarse, "{coarse} {fine}");
}

#[test]
fn bad_input_is_told() {
    let corners = [DVec3::ZERO, DVec3::X, DVec3::Y];
    let make = |positions: &[DVec3], triangles: &[[u32; 3]], kind, k| {
        Metaballs::new(positions, triangles, kind, k).expect_err("on purpose")
    };
    let thin = Kind::Triangular { thickness: 0.1 };
    assert_eq!(make(&corners, &[], thin, 1.0), Error::Empty);
    assert_eq!(make(&corners, &[[0, 1, 3]], thin, 1.0), Error::Broken(0));
    let nowhere = [DVec3::ZERO, DVec3::NAN, DVec3::Y];
    assert_eq!(make(&nowhere, &[[0, 1, 2]], thin, 1.0), Error::Broken(0));
    assert_eq!(
        make(&corners, &[[0, 1, 2]], thin, 0.0),
        Error::Sharpness(0.0)
    );
    assert_eq!(
        make(&corners, &[[0, 1, 2]], thin, f64::INFINITY),
        Error::Sharpness(f64::INFINITY)
    );
    let inside_out = Kind::Triangular { thickness: -1.0 };
    assert_eq!(
        make(&corners, &[[0, 1, 2]], inside_out, 1.0),
        Error::Thickness(-1.0)
    );
    let many = vec![[0, 1, 2]; mesh::limits::MAX_TRIANGLES + 1];
    assert_eq!(make(&corners, &many, thin, 1.0), Error::TooMany(many.len()));
}

#[test]
fn balls_of_clearance_hold_no_crossing_and_are_not_small() {
    for (kind, k) in KINDS
        .into_iter()
        .chain([(Kind::Triangular { thickness: 0.02 }, 900.0)])
    {
        let (balls, facets) = balls(kind, k, 10);
        let mut random = Random::new(6);
        let [mut outside, mut inside] = [0, 0];
        let turns = count(1000).max(500);
        for turn in 0..turns {
            // Near the surface, and far from it.
            let reach = random.decades(-3.0, 1.0);
            let p = random.direction() * (1.0 + reach * random.range(-1.0, 1.0));
            let side = balls.jet(p).value >= THRESHOLD;
            let clear = balls.clearance(p).expect("a ball");
            assert_eq!(clear.scale, 1.0 / k);
            if clear.radius == 0.0 {
                continue;
            }
            *(if side { &mut inside } else { &mut outside }) += 1;
            for _ in 0..60 {
                let q = p + random.direction() * (clear.radius * libm::cbrt(random.unit()));
                assert_eq!(
                    balls.jet(q).value >= THRESHOLD,
                    side,
                    "{kind:?} {turn} {p} {q}"
                );
            }
            if !side {
                // The same bound from all facets one by one.
                let sum = plain(&facets, kind, k, p).value;
                let best = if sum > 0.0 {
                    -libm::log(sum) / k
                } else {
                    f64::INFINITY
                };
                assert!(
                    clear.radius <= best * (1.0 + 1e-6),
                    "{} {best}",
                    clear.radius
                );
                // Afar, boxes stand for facets, which are a third of a unit long.
                let loss = 0.25 + 1.2 * libm::log(facets.len() as f64) / k + 0.2 * best;
                assert!(
                    best > 1e3 || clear.radius >= best - loss,
                    "{} {best}",
                    clear.radius
                );
            }
        }
        assert!(6 * outside > turns, "{kind:?} {outside}");
        assert!(150 * inside > turns || k > 100.0, "{kind:?} {inside}");
    }
}

#[test]
fn parts_are_the_whole_function_in_their_balls() {
    const NOTHING: Slack = Slack {
        left_out: 0.0,
        far: 0.0,
    };
    for (kind, k) in KINDS {
        // At this sharpness few facets act in small balls.
        let (balls, _) = balls(kind, 5.0 * k, 12);
        let mut random = Random::new(8);
        let [mut narrow, mut narrower, mut clear, mut bounded] = [0; 4];
        for _ in 0..count(300) {
            let ball = Ball {
                center: random.direction() * random.range(0.7, 1.3),
                radius: random.decades(-2.0, -0.5),
            };
            let Some(large) = balls.narrow(ball, None, NOTHING) else {
                continue;
            };
            narrow += 1;
            let inner = Ball {
                center: ball.center + random.vector(0.4 * ball.radius),
                radius: 0.3 * ball.radius,
            };
            let small = balls.narrow(inner, Some(&large), NOTHING);
            narrower += usize::from(small.is_some());
            let part = small.as_ref().unwrap_or(&large);
            for _ in 0..20 {
                let away = inner.radius * libm::cbrt(random.unit());
                let p = inner.center + random.direction() * away;
                let whole = balls.jet(p);
                assert_eq!(balls.jet_of(part, p), whole, "{kind:?} {p}");
                let lanes = p.to_array().map(|x| f32x8::splat(x as f32));
                assert_eq!(
                    balls.jet8_of(part, lanes),
                    balls.jet8(lanes),
                    "{kind:?} {p}"
                );
                // Clearances hold within the part's ball.
                let own = balls.clearance_of(part, p).expect("a ball");
                for _ in 0..10 {
                    let q = p + random.direction() * (own.radius * libm::cbrt(random.unit()));
                    if own.radius > 0.0 && q.distance(inner.center) <= inner.radius {
                        clear += 1;
                        let side = balls.jet(q).value >= THRESHOLD;
                        assert_eq!(side, whole.value >= THRESHOLD, "{kind:?} {p} {q}");
                    }
                }
            }
            let (own, jet) = balls.variation_with_jet(Some(part), inner);
            let (all, _) = balls.variation_with_jet(None, inner);
            if let Some(jet) = jet {
                bounded += 1;
                assert_eq!(jet, balls.jet(inner.center));
                let off = own.range.value[1] - all.range.value[1];
                assert!(off.abs() <= 1e-9 * all.range.value[1], "{own:?} {all:?}");
            }
        }
        let met = [narrow, narrower, clear, bounded];
        assert!(met.iter().all(|met| *met > count(30)), "{kind:?} {met:?}");
    }
}
