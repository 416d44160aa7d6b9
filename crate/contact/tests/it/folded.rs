//! Folds of one skeleton in contact: against the formula and in balls.
use contact::{Bulge, Folded};
use field::local::Limb;
use field::{Ball, BlobScale, Implicit, Kernel, Local, Primitive, Shaping, Skeleton, THRESHOLD};
use glam::DVec3;
use std::sync::Arc;

/// Pseudo-random numbers in [0, 1).
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn vector(&mut self) -> DVec3 {
        DVec3::new(self.unit(), self.unit(), self.unit()) * 2.0 - DVec3::ONE
    }
}

/// A hairpin of two legs that are nearer than two radii.
fn hairpin(apart: f64) -> Local {
    let mut points = Vec::new();
    for i in 0..=8 {
        points.push(DVec3::new(-2.0 + 0.25 * f64::from(i), -0.5 * apart, 0.0));
    }
    for i in 1..8 {
        let angle = core::f64::consts::PI * (f64::from(i) / 8.0 - 0.5);
        points.push(DVec3::new(
            0.9 * libm::cos(angle),
            0.5 * apart * libm::sin(angle),
            0.0,
        ));
    }
    for i in 0..=8 {
        points.push(DVec3::new(-0.25 * f64::from(i), 0.5 * apart, 0.0));
    }
    let shaping = Shaping {
        kernel: Kernel::Cubed,
        radius: 0.4,
        blobbiness: -2.0,
        blob_scale: BlobScale::Relative,
        strength: 1.0,
        influence: 1e-3,
        taper: None,
    };
    let count = points.len() as u32 - 1;
    let limbs = (0..count).map(|i| {
        let [base, apex] = [i, i + 1].map(|k| points[k as usize]);
        let piece = Primitive::new(Skeleton::Segment { base, apex }, &shaping, None);
        Limb {
            ends: [i, i + 1],
            next: [i.checked_sub(1), (i + 1 < count).then_some(i + 1)],
            pieces: vec![(piece.expect("it is a segment"), base.distance(apex))],
        }
    });
    Local::new(&points, &limbs.collect::<Vec<_>>(), 1.2).expect("it is short")
}

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
    let local = Arc::new(hairpin(0.5));
    let mut random = Random(5);
    let mut kinds = [0; 4];
    for bulge in BULGES {
        let folded = Folded::new(local.clone(), bulge);
        for _ in 0..1200 {
            let point = DVec3::new(-1.0, 0.0, 0.0) + random.vector() * DVec3::new(0.8, 0.6, 0.4);
            let (first, second) = local.two(point);
            let Some(second) = second else { continue };
            let (f, other) = (first.value, second.value);
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
    assert!(kinds.iter().all(|n| *n > 30), "{kinds:?}");
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
    let local = Arc::new(hairpin(0.55));
    let mut random = Random(9);
    let (mut finite, mut all) = (0, 0);
    for bulge in BULGES {
        let folded = Folded::new(local.clone(), bulge);
        for _ in 0..150 {
            let center = DVec3::new(-1.0, 0.0, 0.0) + random.vector() * DVec3::new(1.5, 1.0, 0.7);
            let radius = 0.3 * libm::pow(10.0, -3.0 * random.unit());
            let bounds = folded.enclose(Ball { center, radius });
            all += 1;
            finite += u32::from(bounds.slope.is_finite());
            for _ in 0..10 {
                let point = center + random.vector().normalize() * (radius * random.unit());
                let jet = folded.jet(point);
                let slack = 1e-9 * (1.0 + jet.value.abs());
                let [low, high] = bounds.value;
                assert!(
                    low - slack <= jet.value && jet.value <= high + slack,
                    "{jet:?} {bounds:?}"
                );
                let steep = DVec3::from_array(jet.gradient).length();
                assert!(steep <= bounds.slope * (1.0 + 1e-9), "{steep} {bounds:?}");
            }
        }
    }
    assert!(2 * finite > all, "{finite} of {all}");
}
