//! The bulges: what they promise at their ends, their slopes, and bounds on them.

use contact::Bulge;
use wide::f32x8;

fn all() -> Vec<Bulge> {
    let mut all = vec![
        Bulge::default(),
        Bulge::Fast { c: 0.7 },
        Bulge::Height {
            c: 0.2,
            m: 0.65,
            h: 0.25,
        },
        Bulge::Height {
            c: 0.05,
            m: 0.1,
            h: 0.9,
        },
        // So low that the second piece rises above h first.
        Bulge::Height {
            c: 0.2,
            m: 0.4,
            h: 0.01,
        },
        Bulge::Height {
            c: 0.4,
            m: 0.9,
            h: 0.0,
        },
    ];
    for n in [0, 1, 2, 7, Bulge::MOST_RIPPLES] {
        all.push(Bulge::Ripple { c: 0.2, h: 0.25, n });
    }
    all
}

/// The value alone, from the formulas as they are printed (with the corrections that the
/// documentation names).
fn independent(bulge: &Bulge, f: f64) -> f64 {
    if f >= 1.0 {
        return 1.0 - f;
    }
    if f <= bulge.start() {
        return 0.0;
    }
    let rise = |c: f64, m: f64, h: f64| {
        let x = (f - c) / (m - c);
        ((3.0 - 2.0 * x) * x * x * h, x)
    };
    let fall = |m: f64, h: f64| {
        let w = 1.0 - m;
        let x = (f - m) / w;
        h + ((w - 3.0 * h) + (2.0 * h - w) * x) * x * x
    };
    match *bulge {
        Bulge::Fast { c } => {
            let x = (f - c) / (1.0 - c);
            (1.0 - c) * x * x * (1.0 - x)
        }
        Bulge::Height { c, m, h } if f < m => rise(c, m, h).0,
        Bulge::Height { m, h, .. } => fall(m, h),
        Bulge::Ripple { c, h, n } => {
            let n = f64::from(n);
            let m = c + (1.0 - c) * (1.0 - 1.0 / (4.0 * n + 3.0));
            if f >= m {
                return fall(m, h);
            }
            let (rise, x) = rise(c, m, h);
            rise * (libm::cos(((2.0 * n + 1.0) * x + 1.0) * core::f64::consts::PI) + 1.0) / 2.0
        }
    }
}

#[test]
fn it_is_the_formula() {
    for bulge in all() {
        assert!(bulge.is_usable());
        for i in 0..=2000 {
            let f = f64::from(i) * 1e-3;
            let want = independent(&bulge, f);
            assert!((bulge.jet(f).0 - want).abs() < 1e-14, "{bulge:?} {f}");
        }
    }
}

#[test]
fn it_joins_smoothly() {
    for bulge in all() {
        let c = bulge.start();
        let near = |f: f64, value: f64, slope: f64| {
            for side in [-1e-9, 1e-9] {
                let (v, s) = bulge.jet(f + side);
                assert!((v - value).abs() < 1e-8, "{bulge:?} {f}");
                assert!((s - slope).abs() < 1e-3, "{bulge:?} {f}: {s}");
            }
        };
        near(c, 0.0, 0.0);
        near(1.0, 0.0, -1.0);
        if let Bulge::Height { m, h, .. } = bulge {
            near(m, h, 0.0);
        }
        if let Bulge::Ripple { h, .. } = bulge {
            near(bulge.crest(), h, 0.0);
        }
    }
}

#[test]
fn slopes_are_differences() {
    for bulge in all() {
        for i in 0..999 {
            let f = 1e-3 * (f64::from(i) + 0.517);
            let value = |s: f64| bulge.jet(f + s * 1e-6).0;
            let difference = (value(1.0) - value(-1.0)) / 2e-6;
            let slope = bulge.jet(f).1;
            assert!(
                (slope - difference).abs() < 1e-3 * (1.0 + slope.abs()),
                "{bulge:?} {f}"
            );
        }
    }
}

#[test]
fn bounds_hold_and_are_not_far_off() {
    for bulge in all() {
        let (mut wide, mut smooth) = (0, 0);
        for i in 0..60 {
            let low = -0.1 + f64::from(i) * 0.02;
            for width in [0.0, 1e-3, 0.05, 0.4, 3.0] {
                let spread = bulge.spread([low, low + width]);
                let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
                for k in 0..=50 {
                    let f = low + width * f64::from(k) / 50.0;
                    let (value, slope) = bulge.jet(f);
                    (least, most) = (least.min(value), most.max(value));
                    assert!(
                        value >= spread.value[0] && value <= spread.value[1],
                        "{bulge:?} {f}"
                    );
                    assert!(slope.abs() <= spread.slope + 1e-13, "{bulge:?} {f}");
                    let step = (1e-5_f64).min(width / 4.0);
                    if step > 0.0 && f - step >= low && f + step <= low + width {
                        let bend = (bulge.jet(f + step).1 - bulge.jet(f - step).1) / (2.0 * step);
                        assert!(
                            bend.abs() <= spread.curvature + 1e-4,
                            "{bulge:?} {f} {bend}"
                        );
                    }
                    let step = (1e-3_f64).min(width / 4.0);
                    if step > 0.0 && f - step >= low && f + step <= low + width {
                        let slopes = [f - step, f, f + step].map(|f| bulge.jet(f).1);
                        let third = slopes[0] - 2.0 * slopes[1] + slopes[2];
                        smooth += u32::from(spread.third.is_finite());
                        assert!(
                            third.abs() <= spread.third * step * step + 1e-13,
                            "{bulge:?} {f} {third}"
                        );
                    }
                }
                let loose = (spread.value[1] - most).max(least - spread.value[0]);
                wide += u32::from(loose > 0.02);
            }
        }
        assert!(smooth > 2000, "{bulge:?} {smooth}");
        if !matches!(bulge, Bulge::Ripple { .. }) {
            assert_eq!(wide, 0, "{bulge:?}");
        }
    }
}

#[test]
fn all_precisions_agree() {
    for bulge in all() {
        let values: [f32; 8] = core::array::from_fn(|i| 0.15 * i as f32 + 0.07);
        let (eight, slopes) = bulge.jet(f32x8::new(values));
        for (i, f) in values.into_iter().enumerate() {
            let (single, slope) = bulge.jet(f);
            assert_eq!((single, slope), (eight.to_array()[i], slopes.to_array()[i]));
            let (double, steep) = bulge.jet(f64::from(f));
            assert!((f64::from(single) - double).abs() < 1e-5);
            assert!((f64::from(slope) - steep).abs() < 1e-3);
        }
    }
}

#[test]
fn numbers_out_of_range_are_refused() {
    for bulge in [
        Bulge::Fast { c: 0.0 },
        Bulge::Fast { c: 1.0 },
        Bulge::Fast { c: f64::NAN },
        Bulge::Height {
            c: 0.5,
            m: 0.5,
            h: 0.1,
        },
        Bulge::Height {
            c: 0.5,
            m: 1.0,
            h: 0.1,
        },
        Bulge::Height {
            c: 0.5,
            m: 0.7,
            h: 1.0,
        },
        Bulge::Ripple {
            c: 0.5,
            h: -0.1,
            n: 1,
        },
        Bulge::Ripple {
            c: 0.5,
            h: 0.1,
            n: Bulge::MOST_RIPPLES + 1,
        },
    ] {
        assert!(!bulge.is_usable(), "{bulge:?}");
    }
}
