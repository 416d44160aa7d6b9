//! Folds of one skeleton in contact: against the formula and in balls.
use contact::{Bulge, Folded};
use field::{Ball, Implicit, Kernel, THRESHOLD};
use glam::DVec3;
use trials::skeletons::hairpin;
use trials::{Random, count};

const BULGES: [Bulge; 3] = [
    Bulge::Fast { c: 0.3 },
    Bulge::Height {
        c: 0.3,
        m: 0.65,
        h: 0.25,
    },
    Bulge::Ripple {
        c: 0.3,
        h: 0.2,
        n: 2,
    },
];

#[test]
fn folds_are_deformed_as_the_formula_says() {
    let local = hairpin(Kernel::Cubed, 0.5);
    let both = local.clone().with_folds(0.3);
    let mut random = Random::new(5);
    let mut kinds = [0; 4];
    for bulge in BULGES {
        let folded = Folded::new(local.clone(), bulge);
        for _ in 0..count(1200) {
            let point = DVec3::new(-1.0, 0.0, 0.0) + random.vector(1.0) * DVec3::new(0.8, 0.6, 0.4);
            let (first, second) = both.two(point.to_array());
            let Some(second) = second else { continue };
            let (own, second) = (first.value, second.value);
            let t = ((second - 0.3) / 0.35).clamp(0.0, 1.0);
            let f = own.max(second * t * t * (3.0 - 2.0 * t));
            let other = second.min(own);
            // The bulges written out once more.
            let g = if other > 1.0 {
                kinds[0] += 1;
                1.0 - other
            } else if other < 0.3 {
                kinds[1] += 1;
                0.0
            } else {
                kinds[2] += 1;
                let x = (other - 0.3) / 0.7;
                match bulge {
                    Bulge::Fast { .. } => 0.7 * x * x * (1.0 - x),
                    Bulge::Height { .. } => crest(other, 0.65, 0.25, 1.0),
                    Bulge::Ripple { .. } => {
                        let m = 0.3 + 0.7 * (1.0 - 1.0 / 11.0);
                        let x = (other - 0.3) / (m - 0.3);
                        let wave = (libm::cos((5.0 * x + 1.0) * core::f64::consts::PI) + 1.0) / 2.0;
                        crest(other, m, 0.2, wave)
                    }
                }
            };
            let mut want = f + g;
            if f > 1.0 && other > 1.0 && f - other < 0.5 * (f - 1.0) {
                kinds[3] += 1;
                want = 0.5 * (f + 1.0);
            }
            let value = folded.jet(point).value;
            assert!(
                (value - want).abs() < 1e-9 * (1.0 + want.abs()),
                "{value} {want}"
            );
            // Nothing inside becomes an outside: the sheet is no surface.
            assert!(f <= THRESHOLD || value > THRESHOLD, "{f} {value}");
        }
    }
    assert!(kinds.iter().all(|n| *n > count(30)), "{kinds:?}");
}

/// The bulge of a height h at m, times a wave on its first piece.
fn crest(f: f64, m: f64, h: f64, wave: f64) -> f64 {
    if f < m {
        let x = (f - 0.3) / (m - 0.3);
        (3.0 - 2.0 * x) * x * x * h * wave
    } else {
        let w = 1.0 - m;
        let x = (f - m) / w;
        h + ((w - 3.0 * h) + (2.0 * h - w) * x) * x * x
    }
}

#[test]
fn bounds_hold_in_balls() {
    let local = hairpin(Kernel::Cubed, 0.55);
    let mut random = Random::new(9);
    let (mut finite, mut all) = (0, 0);
    for bulge in BULGES {
        let folded = Folded::new(local.clone(), bulge);
        for _ in 0..count(150) {
            let center =
                DVec3::new(-1.0, 0.0, 0.0) + random.vector(1.0) * DVec3::new(1.5, 1.0, 0.7);
            let radius = 0.3 * random.decades(-3.0, 0.0);
            let ball = Ball { center, radius };
            let bounds = folded.enclose(ball);
            let (traced, jet) = folded.variation_with_jet(None, ball);
            let bends = [folded.variation(None, ball), traced];
            let bends = bends.map(|bounds| bounds.curvature * radius + bounds.jump);
            let at_center = DVec3::from_array(folded.jet(center).gradient);
            if let Some(jet) = jet {
                let exact = folded.jet(center);
                assert!((jet.value - exact.value).abs() <= 1e-9 * (1.0 + exact.value));
            }
            all += 1;
            finite += u32::from(bounds.slope.is_finite());
            for _ in 0..10 {
                let point = center + random.direction() * (radius * random.unit());
                let jet = folded.jet(point);
                let slack = 1e-9 * (1.0 + jet.value.abs());
                let [low, high] = bounds.value;
                assert!(
                    low - slack <= jet.value && jet.value <= high + slack,
                    "{jet:?} {bounds:?}"
                );
                let gradient = DVec3::from_array(jet.gradient);
                let steep = gradient.length();
                assert!(steep <= bounds.slope * (1.0 + 1e-9), "{steep} {bounds:?}");
                let change = gradient.distance(at_center);
                for bend in bends {
                    assert!(change <= bend * (1.0 + 1e-6) + 1e-7, "{change} {bend}");
                }
            }
        }
    }
    assert!(2 * finite > all, "{finite} of {all}");
}
