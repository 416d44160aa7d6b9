//! Noise: range, gradient, continuity, octaves.

use crate::common::{ODD, slope};
use glam::DVec3;
use texture::{fractal, noise, noise_jet, turbulence};
use trials::{Random, count};

#[test]
fn noise_stays_within_one_and_uses_it() {
    let mut random = Random::new(11);
    let (mut low, mut high, mut sum) = (0.0_f64, 0.0_f64, 0.0);
    // Fewer do not come near to its extremes.
    let points = count(60_000).max(60_000);
    for _ in 0..points {
        let x = noise(random.vector(1e4));
        (low, high, sum) = (low.min(x), high.max(x), sum + x);
    }
    assert!(
        (-1.0..-0.8).contains(&low) && (0.8..=1.0).contains(&high),
        "{low} to {high}"
    );
    // It leans to neither side.
    assert!((sum / points as f64).abs() < 2.0 / (points as f64).sqrt());
}

#[test]
fn gradient_matches_differences() {
    let mut random = Random::new(12);
    for _ in 0..count(2_000) {
        let p = random.vector(30.0);
        let (_, gradient) = noise_jet(p);
        let want = slope(noise, p, 1e-5);
        assert!(
            (gradient - want).length() < 1e-8,
            "{gradient} instead of {want} at {p}"
        );
    }
}

/// Across the sides of cells, value and gradient go on.
#[test]
fn nothing_jumps_between_cells() {
    let mut random = Random::new(13);
    for _ in 0..count(1_000) {
        let mut p = random.vector(20.0);
        let axis = random.below(3);
        p[axis] = p[axis].round();
        let mut before = p;
        before[axis] -= 1e-9;
        let ((v0, g0), (v1, g1)) = (noise_jet(before), noise_jet(p));
        assert!(
            (v0 - v1).abs() < 1e-8 && (g0 - g1).length() < 1e-7,
            "at {p}"
        );
    }
}

#[test]
fn octaves_add_up_and_the_last_fades() {
    let mut random = Random::new(14);
    for _ in 0..count(300) {
        let p = random.vector(9.0);
        for sum in [fractal, turbulence] {
            let (two, three) = (sum(p, 2.0), sum(p, 3.0));
            assert!((sum(p, 2.5) - 0.5 * (two + three)).abs() < 1e-14);
            assert_eq!(sum(p, 0.0), 0.0);
            assert_eq!(sum(p, -3.0), 0.0);
            assert_eq!(sum(p, 32.0), sum(p, 1e9));
            assert!((three - two).abs() <= 0.25);
        }
        assert!(turbulence(p, 6.0) >= fractal(p, 6.0).abs());
        assert!(turbulence(p, 6.0) < 2.0);
    }
    // The second octave is new noise, not a copy of the first in half the size.
    let p = DVec3::new(0.3, 0.7, 0.2);
    assert!((fractal(p, 2.0) - noise(p) - 0.5 * noise(2.0 * p)).abs() > 1e-3);
}

#[test]
fn odd_numbers_give_numbers() {
    for x in ODD {
        for y in ODD {
            for octaves in ODD {
                let p = DVec3::new(x, y, 0.3);
                let (value, gradient) = noise_jet(p);
                assert!(value.abs() <= 1.0 && gradient.is_finite(), "{p}");
                assert!(fractal(p, octaves).abs() < 2.0 && turbulence(p, octaves) < 2.0);
            }
        }
    }
}
