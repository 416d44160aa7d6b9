//! Solid patterns and waves: ranges, continuity, and what each one's name promises.

use crate::common::ODD;
use glam::DVec3;
use texture::{Grain, Solid, Wave};
use trials::{Random, count};

const CALM: Grain = Grain {
    turbulence: 0.0,
    octaves: 5.0,
};

fn grey(solid: Solid, p: DVec3, grain: Grain) -> f64 {
    solid.pattern(p, grain)[0]
}

#[test]
fn patterns_stay_between_0_and_1_and_use_most_of_it() {
    let mut random = Random::new(21);
    for solid in Solid::ALL {
        let (mut low, mut high) = (1.0_f64, 0.0_f64);
        for _ in 0..count(4_000).max(4_000) {
            let p = random.vector(6.0);
            for x in solid.pattern(p, Grain::default()) {
                assert!((0.0..=1.0).contains(&x), "{solid:?} at {p}: {x}");
                (low, high) = (low.min(x), high.max(x));
            }
        }
        assert!(low < 0.31 && high > 0.9, "{solid:?}: {low} to {high}");
    }
}

#[test]
fn odd_numbers_give_numbers() {
    for solid in Solid::ALL {
        for x in ODD {
            for y in ODD {
                let p = DVec3::new(x, y, y);
                let grain = Grain {
                    turbulence: x,
                    octaves: y,
                };
                for grain in [Grain::default(), grain] {
                    assert!(
                        solid
                            .pattern(p, grain)
                            .iter()
                            .all(|x| (0.0..=1.0).contains(x)),
                        "{solid:?} at {p}"
                    );
                    assert!(solid.relief(p, grain).is_finite(), "{solid:?} at {p}");
                }
            }
        }
    }
}

/// Patterns are continuous, but for checkers, crystals and where paints meet: short steps make
/// short changes.
#[test]
fn patterns_do_not_jump() {
    let mut random = Random::new(22);
    for solid in [
        Solid::Marble,
        Solid::Agate,
        Solid::Moon,
        Solid::Onion,
        Solid::Wood,
        Solid::Ripples,
        Solid::Sandal,
    ] {
        for _ in 0..count(4_000) {
            let p = random.vector(3.0);
            let q = p + 1e-7 * random.direction();
            let (a, b) = (
                grey(solid, p, Grain::default()),
                grey(solid, q, Grain::default()),
            );
            assert!((a - b).abs() < 2e-5, "{solid:?} at {p}: {a} and {b}");
        }
    }
}

#[test]
fn checker_is_a_checker() {
    let mut random = Random::new(23);
    for _ in 0..count(2_000) {
        let p = random.vector(20.0);
        if (p - p.round()).abs().min_element() < 1e-4 {
            continue;
        }
        let odd = p
            .to_array()
            .iter()
            .filter(|x| (x.floor() as i64).rem_euclid(2) == 1)
            .count()
            % 2
            == 1;
        assert_eq!(grey(Solid::Checker, p, CALM), if odd { 0.0 } else { 1.0 });
    }
    // A face on the border of cubes is of one colour, whatever rounding does.
    let [above, below] =
        [1e-12, -1e-12].map(|y| grey(Solid::Checker, DVec3::new(0.5, y, 0.5), CALM));
    assert_eq!(above, below);
}

/// Without noise, onions depend on the distance from the middle but for their lines, and wood on
/// the distance from the axis but for its fibres, which are then off.
#[test]
fn calm_wood_has_round_rings() {
    let mut random = Random::new(24);
    for _ in 0..count(500) {
        let (r, a, b) = (
            random.range(0.0, 3.0),
            random.range(0.0, 6.3),
            random.range(0.0, 6.3),
        );
        let [x, y] = [(a, -2.0), (b, 5.0)].map(|(angle, z)| {
            let p = DVec3::new(r * libm::cos(angle), r * libm::sin(angle), z);
            grey(Solid::Wood, p, CALM)
        });
        assert!((x - y).abs() < 1e-9, "{x} and {y}");
        let other = random.direction();
        let (x, y) = (
            grey(Solid::Onion, r * DVec3::Y, CALM),
            grey(Solid::Onion, r * other, CALM),
        );
        assert!((x - y).abs() < 1e-9, "{x} and {y}");
    }
}

/// The skin between shells is darker than the flesh, four times a unit.
#[test]
fn onion_has_four_shells_a_unit() {
    for shell in 0..8 {
        let middle = f64::from(shell) * 0.25;
        let [dark, light] =
            [middle + 0.125, middle].map(|r| grey(Solid::Onion, r * DVec3::Y, CALM));
        assert!(dark < 0.31 && light > 0.6);
    }
}

/// Crests are a fifth of a unit apart. Counted by crossings of the mean.
#[test]
fn ripples_are_five_a_unit() {
    let mut random = Random::new(25);
    let (mut crossings, mut length) = (0, 0.0);
    for _ in 0..count(60) {
        let (p, d) = (random.vector(30.0), random.direction());
        let mut before = grey(Solid::Ripples, p, CALM);
        for i in 1..400 {
            let x = grey(Solid::Ripples, p + d * (f64::from(i) * 0.005), CALM);
            crossings += i32::from((x > 0.5) != (before > 0.5));
            before = x;
        }
        length += 2.0;
    }
    // Rings are crossed at all angles: at most 10 a unit; on average over angles half of that, less
    // where no drop fell.
    let rate = f64::from(crossings) / length;
    assert!((3.0..10.0).contains(&rate), "{rate}");
}

/// Craters dig, and are rare on the way up.
#[test]
fn moon_has_bowls_and_rims() {
    let mut random = Random::new(26);
    let heights: Vec<f64> = (0..count(6_000))
        .map(|_| Solid::Moon.relief(random.vector(20.0), CALM))
        .collect();
    let (low, high) = heights
        .iter()
        .fold((0.0_f64, 0.0_f64), |(l, h), &x| (l.min(x), h.max(x)));
    assert!(low < -0.1 && high > 0.03 && high < -low, "{low} to {high}");
    // No bump is steeper than about 1.
    for _ in 0..count(2_000) {
        let (p, d) = (random.vector(9.0), random.direction());
        let rise = Solid::Moon.relief(p + 1e-4 * d, CALM) - Solid::Moon.relief(p - 1e-4 * d, CALM);
        assert!((rise / 2e-4).abs() < 2.5, "{rise}");
    }
}

#[test]
fn turbulence_0_makes_marble_of_straight_planes() {
    let a = grey(Solid::Granite, DVec3::new(0.1, 0.2, 0.3), CALM);
    assert_ne!(a, grey(Solid::Granite, DVec3::new(0.4, 0.2, 0.3), CALM));
    // Dark veins where x + 0.3 y is whole, light half way, all along them.
    let mut random = Random::new(27);
    let [vein, between] = [0.0, 0.5].map(|offset| {
        let values = (0..300).map(|_| {
            let (y, z) = (random.range(-9.0, 9.0), random.range(-9.0, 9.0));
            grey(
                Solid::Marble,
                DVec3::new(3.0 + offset - 0.3 * y, y, z),
                CALM,
            )
        });
        values.sum::<f64>() / 300.0
    });
    assert!(vein < between - 0.4, "{vein}, {between}");
}

#[test]
fn waves_match_their_formulas() {
    let mut random = Random::new(28);
    for _ in 0..count(1_000) {
        let x = random.range(-20.0, 20.0);
        let f = x - x.floor();
        let (s, c) = (libm::sin(x), libm::cos(x));
        let want = [
            1.0,
            x.clamp(0.0, 1.0),
            f,
            2.0 * f.min(1.0 - f),
            f64::from(u8::from(f >= 0.5)),
            0.5 + 0.5 * s,
            0.5 + 0.5 * c,
            1.0 - c * c,
            1.0 - s * s,
        ];
        for (wave, want) in Wave::ALL.into_iter().zip(want) {
            let (value, slope) = wave.jet(x);
            assert!((value - want).abs() < 1e-13, "{wave:?} at {x}");
            let near_kink = [f, (f - 0.5).abs(), 1.0 - f].iter().any(|d| *d < 1e-4);
            if !near_kink {
                let by_difference = (wave.jet(x + 1e-6).0 - wave.jet(x - 1e-6).0) / 2e-6;
                assert!((slope - by_difference).abs() < 1e-8, "{wave:?} at {x}");
            }
        }
    }
    for x in ODD {
        for wave in Wave::ALL {
            let (value, slope) = wave.jet(x);
            assert!(
                (0.0..=1.0).contains(&value) && slope.is_finite(),
                "{wave:?} at {x}"
            );
        }
    }
}
