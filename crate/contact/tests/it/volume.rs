//! Volume that is left of a ball when two are pressed together, by Monte Carlo: the table of
//! the crate's front page.
use contact::{Bulge, Squashed};
use field::{BlobScale, Implicit, Kernel, Primitive, Shaping, Skeleton, Sum, THRESHOLD};
use glam::DVec3;
use std::sync::Arc;
use trials::{Random, count};

/// Points a figure. Its error is then about 0.3 % of the volume.
const POINTS: usize = 150_000;
/// Half the edge of the cube that is sampled.
const HALF: f64 = 1.7;

fn ball(kernel: Kernel, x: f64) -> Arc<dyn Implicit> {
    let shaping = Shaping {
        kernel,
        radius: 1.0,
        blobbiness: 1.5,
        blob_scale: BlobScale::Relative,
        strength: 1.0,
        influence: 1e-3,
        taper: None,
    };
    let center = DVec3::X * x;
    let point = Primitive::new(Skeleton::Point { center }, &shaping, None);
    Arc::new(point.into_iter().collect::<Sum>())
}

/// The part of the unit ball's volume where a function of the point holds.
fn volume(inside: impl Fn(DVec3) -> bool) -> f64 {
    let mut random = Random::new(17);
    let points = count(POINTS);
    let mut found = 0;
    for _ in 0..points {
        found += usize::from(inside(random.vector(HALF)));
    }
    let ball = 4.0 / 3.0 * core::f64::consts::PI;
    found as f64 / points as f64 * 8.0 * HALF * HALF * HALF / ball
}

#[test]
fn bulges_give_back_volume() {
    let bulges = [
        ("fast 0.2", Bulge::Fast { c: 0.2 }),
        (
            "height 0.2 0.65 0.25",
            Bulge::Height {
                c: 0.2,
                m: 0.65,
                h: 0.25,
            },
        ),
        (
            "ripple 0.2 0.25 2",
            Bulge::Ripple {
                c: 0.2,
                h: 0.25,
                n: 2,
            },
        ),
    ];
    for kernel in [Kernel::Cauchy, Kernel::Gauss, Kernel::Cubed] {
        // The balls overlap by half a radius; this one is in the middle of the cube.
        let (own, other) = (ball(kernel, 0.0), ball(kernel, 1.5));
        let alone = volume(|p| own.jet(p).value >= THRESHOLD);
        assert!((alone - 1.0).abs() < 0.012, "{alone}");
        let cut = volume(|p| own.jet(p).value >= other.jet(p).value.max(THRESHOLD));
        let mut row = format!("{kernel:?}: cut {:.1} %", 100.0 * cut);
        let mut before = cut;
        for (name, bulge) in bulges {
            let pressed = Squashed::new(own.clone(), vec![(other.clone(), bulge)]);
            let left = volume(|p| pressed.jet(p).value >= THRESHOLD);
            row += &format!(", {name} {:.1} %", 100.0 * left);
            assert!(left > cut + 0.005, "{kernel:?} {name}: {left} {cut}");
            before = f64::max(before, left);
        }
        println!("{row}");
        assert!(before < 1.35, "{row}");
    }
}
