//! Figures of every cell of the chart: how exact single precision is, which is a test, and how fast
//! each evaluator is, which is a measurement (`cargo xtask bench` runs it, natively and as wasm).

use core::hint::black_box;
use field::real::Scalar;
use field::{Evaluate, Kernel, Primitive, Shaping, Skeleton};
use glam::DVec3;
use std::time::Instant;
use trials::Random;
use trials::skeletons::{ALL_KINDS, Kind, shaping};
use wide::f32x8;

/// The errors, which are the same as wasm.
#[cfg(not(target_arch = "wasm32"))]
mod errors {
    use super::name;
    use field::{Kernel, Shaping, Skeleton};
    use oracle::evaluation::{jet, primitive, single};
    use trials::skeletons::{ALL_KINDS, Kind, shaping};
    use trials::{Random, count};
    use wide::f32x8;

    /// The worst relative error of single precision against double, at points 0.05 or more from the
    /// skeleton where the field is at least T/10, of random primitives of radius 1, a hundredth to
    /// ten long, that are no needles.
    fn worst_error(kernel: Kernel, kind: Kind) -> f64 {
        let mut random = Random::new(41);
        let mut worst = 0.0_f64;
        for _ in 0..count(2_000) {
            let size = random.decades(-2.0, 1.0);
            let skeleton = random.skeleton(kind, size);
            let blobbiness = random.decades(-1.0, 1.0);
            let shaping = Shaping {
                kernel,
                ..shaping(1.0, blobbiness)
            };
            let primitive = primitive(skeleton.clone(), &shaping, None);
            let point = single(random.near(&skeleton, -1.0, 0.7));
            let (want, _) = jet::<f64>(&primitive, point);
            if want < 0.1 || skeleton.distance(point) < 0.05 || is_needle(&skeleton) {
                continue;
            }
            let (value, _) = jet::<f32x8>(&primitive, point);
            worst = worst.max((value - want).abs() / want);
        }
        worst
    }

    /// Whether a triangle is more than ten times as long as wide: its coordinates' rounding is then
    /// a good part of its width.
    fn is_needle(skeleton: &Skeleton) -> bool {
        let Skeleton::Triangle { corners: [a, b, c] } = *skeleton else {
            return false;
        };
        let longest = (b - a).length().max((c - b).length()).max((a - c).length());
        (b - a).cross(c - a).length() < 0.1 * longest * longest
    }

    /// The bound that each cell is held to. (Listed, with the figures, in BENCHMARKS.md.)
    fn most_error(kernel: Kernel, kind: Kind) -> f64 {
        match (kernel, kind) {
            // The window over which it is integrated leaves out 2·10⁻⁶ of the field on the
            // skeleton, which is up to e¹⁰·T here.
            (Kernel::Gauss, Kind::Arc) => 2e-4,
            // The rounding of coordinates alone, 1/40 of a radius from circles of 10: 3·10⁻⁷ of the
            // distance, thrice.
            (Kernel::Cubed, Kind::Arc) => 5e-5,
            // Sums over edges, whose terms are larger than they.
            (_, Kind::Triangle | Kind::Polygon) => 5e-5,
            (Kernel::Metaballs, Kind::Segment) => 5e-5,
            _ => 2e-5,
        }
    }

    #[test]
    fn single_precision_is_as_exact_as_listed() {
        for kernel in Kernel::ALL {
            for kind in ALL_KINDS {
                let worst = worst_error(kernel, kind);
                println!("error {} {} {worst:.1e}", kernel.name(), name(kind));
                assert!(
                    worst <= most_error(kernel, kind),
                    "{kernel:?} {kind:?}: {worst:e}"
                );
            }
        }
    }
}

fn name(kind: Kind) -> String {
    format!("{kind:?}").to_lowercase()
}

/// Lines `speed KERNEL KIND f32x8 f32 f64`, million values with gradients a second.
#[test]
#[ignore = "a measurement, for optimised builds"]
fn speed() {
    for kernel in Kernel::ALL {
        for kind in ALL_KINDS {
            let shaping = Shaping {
                kernel,
                ..shaping(0.2, 1.0)
            };
            let primitive = Primitive::new(typical(kind), &shaping, None).expect("flesh");
            let rates = [
                rate::<f32x8>(&primitive),
                rate::<f32>(&primitive),
                rate::<f64>(&primitive),
            ];
            let [a, b, c] = rates.map(|rate| format!("{rate:.2}"));
            println!("speed {} {} {a} {b} {c}", kernel.name(), name(kind));
        }
    }
}

/// Returns a skeleton of each kind, about one unit long.
fn typical(kind: Kind) -> Skeleton {
    let flat = [DVec3::X, DVec3::Y, DVec3::new(-0.3, -0.2, 0.0)];
    match kind {
        Kind::Segment => Skeleton::Segment {
            base: DVec3::new(-0.5, 0.1, 0.0),
            apex: DVec3::new(0.5, 0.2, 0.1),
        },
        Kind::Arc => Skeleton::Arc {
            center: DVec3::ZERO,
            u: DVec3::X,
            v: DVec3::Y,
            radius: 0.5,
            angle: 2.0,
        },
        Kind::Triangle => Skeleton::Triangle { corners: flat },
        Kind::Polygon => Skeleton::Polygon {
            rings: vec![vec![flat[0], flat[1], DVec3::NEG_X * 0.4, flat[2]]],
        },
        Kind::Plane => Skeleton::Plane {
            point: DVec3::ZERO,
            normal: DVec3::Z,
        },
        Kind::Curve => Skeleton::Curve {
            control: [
                DVec3::new(-0.5, 0.0, 0.0),
                DVec3::new(-0.2, 0.4, 0.0),
                DVec3::new(0.2, -0.4, 0.1),
                DVec3::new(0.5, 0.0, 0.0),
            ],
        },
        other => Random::fixed(1).skeleton(other, 1.0),
    }
}

/// Million evaluations a second along rays near the skeleton.
fn rate<R: Evaluate<Scalar: Evaluate>>(primitive: &Primitive) -> f64
where
    R::Scalar: Scalar,
{
    let ray = primitive.on_ray::<R::Scalar>(DVec3::new(-1.0, 0.13, 0.1), DVec3::X);
    let mut best = f64::INFINITY;
    let mut count = 64;
    // Runs of at least five milliseconds, which the clock of a browser can tell; the best of them.
    let mut good = 0;
    while good < 5 {
        let start = Instant::now();
        let mut sums = [R::splat(0.0); 2];
        for i in 0..count {
            let t = R::from_lanes(|lane| 2.0 * ((i * 37 + lane * 5) % 512) as f64 / 512.0);
            let (value, slope) = ray.at(t);
            sums[0] = sums[0] + value;
            sums[1] = sums[1] + slope;
        }
        black_box(sums.map(|sum| sum.lane(0)));
        let seconds = start.elapsed().as_secs_f64();
        if seconds < 5e-3 {
            count *= 2;
            continue;
        }
        good += 1;
        best = best.min(seconds / (count * R::LANES) as f64);
    }
    1e-6 / best
}
