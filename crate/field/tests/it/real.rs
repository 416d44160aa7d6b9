//! The arithmetic under the formulas: own sines and arctangents against libm's, lanes against
//! scalars.

use field::Real;
use trials::{Random, count};
use wide::f32x8;

fn arctangent<R: Real>(x: f64) -> f64 {
    let x = R::splat(x);
    let y = x * x;
    let tail = R::arctangent_tail(y);
    (x + x * y * (R::splat(-1.0 / 3.0) + y * tail)).lane(0)
}

#[test]
fn arctangent_in_the_octant() {
    for i in -1000..=1000 {
        let x = f64::from(i) / 1000.0 * 0.41421;
        assert!((arctangent::<f64>(x) - libm::atan(x)).abs() <= 4e-16 * x.abs());
        let x = f64::from(x as f32);
        let want = libm::atan(x);
        assert!((arctangent::<f32>(x) - want).abs() <= 1.5e-7 * want.abs());
        assert_eq!(arctangent::<f32>(x), arctangent::<f32x8>(x));
    }
}

#[test]
fn sine_and_cosine() {
    let mut random = Random::new(31);
    for _ in 0..count(20_000) {
        let x = random.decades(-6.0, 4.0) * random.pick(&[1.0, -1.0]);
        let single = x as f32;
        let (sine, cosine) = libm::sincos(f64::from(single));
        let (s, c) = Real::sin_cos(single);
        assert!((f64::from(s) - sine).abs() < 1e-6, "sin {single}");
        assert!((f64::from(c) - cosine).abs() < 1e-6, "cos {single}");
        let (s8, c8) = Real::sin_cos(f32x8::splat(single));
        assert_eq!((s8.to_array()[5], c8.to_array()[5]), (s, c));
        assert_eq!(Real::sin_cos(x), libm::sincos(x));
    }
}

#[test]
fn lanes_are_separate() {
    let x = f32x8::from_lanes(|i| i as f64 - 3.5);
    let y = f32x8::splat(0.0);
    let smaller = Real::lt(x, y);
    for i in 0..8 {
        let v = i as f64 - 3.5;
        assert_eq!(x.lane(i), v);
        assert_eq!(
            f32x8::select(smaller, x, y).lane(i),
            if v < 0.0 { v } else { 0.0 }
        );
        assert_eq!(Real::floor(x).lane(i), v.floor());
        assert_eq!(Real::max(x, y).lane(i), v.max(0.0));
        assert_eq!(Real::min(x, y).lane(i), v.min(0.0));
        assert_eq!(x.sign_to(f32x8::splat(2.0)).lane(i), 2.0 * v.signum());
    }
}
