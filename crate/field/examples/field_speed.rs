//! Evaluations a second of each primitive's value and derivative along a ray.
//!
//! `cargo run --release -p field --example field_speed`. The thesis's table 2.6 gives the ratios
//! point : line : arc : triangle : plane = 1 : 4.48 : 8.17 : 14.36 : 1.02.
use field::real::Scalar;
use field::{BlobScale, Evaluate, Kernel, Primitive, Shaping, Skeleton};
use glam::DVec3;
use std::hint::black_box;
use std::time::Instant;
use wide::f32x8;

fn main() {
    let shaping = Shaping {
        kernel: Kernel::Cauchy,
        radius: 0.2,
        blobbiness: 1.0,
        blob_scale: BlobScale::Relative,
        strength: 1.0,
        influence: 1e-3,
        taper: None,
    };
    let skeletons = [
        (
            "point",
            1.0,
            Skeleton::Point {
                center: DVec3::ZERO,
            },
        ),
        (
            "segment",
            4.48,
            Skeleton::Segment {
                base: DVec3::new(-0.5, 0.1, 0.0),
                apex: DVec3::new(0.5, 0.2, 0.1),
            },
        ),
        (
            "arc",
            8.17,
            Skeleton::Arc {
                center: DVec3::ZERO,
                u: DVec3::X,
                v: DVec3::Y,
                radius: 0.5,
                angle: 2.0,
            },
        ),
        (
            "triangle",
            14.36,
            Skeleton::Triangle {
                corners: [DVec3::X, DVec3::Y, DVec3::new(-0.3, -0.2, 0.1)],
            },
        ),
        (
            "plane",
            1.02,
            Skeleton::Plane {
                point: DVec3::ZERO,
                normal: DVec3::Z,
            },
        ),
    ];
    println!("million evaluations a second (ratio to the point's time)");
    println!("            f32x8            f32              f64             thesis");
    let mut first = None;
    for (name, thesis, skeleton) in skeletons {
        let Some(primitive) = Primitive::new(skeleton, &shaping, None) else {
            continue;
        };
        let rates = [
            rate::<f32x8>(&primitive),
            rate::<f32>(&primitive),
            rate::<f64>(&primitive),
        ];
        let point = *first.get_or_insert(rates);
        print!("{name:10}");
        for i in 0..3 {
            print!("{:7.1} ({:5.2})  ", rates[i], point[i] / rates[i]);
        }
        println!("{thesis:6.2}");
    }
}

fn rate<R: Evaluate<Scalar: Evaluate>>(primitive: &Primitive) -> f64
where
    R::Scalar: Scalar,
{
    let ray = primitive.on_ray::<R::Scalar>(DVec3::new(-2.0, 0.3, 0.2), DVec3::X);
    // Short runs, many: the best is one that nothing interrupted.
    let count = 8_000;
    let mut best = f64::INFINITY;
    for _ in 0..200 {
        let start = Instant::now();
        // Four sums, so that evaluations need not wait for one another.
        let mut sums = [R::splat(0.0); 4];
        let mut t = R::from_lanes(|i| 0.01 * i as f64);
        for _ in 0..count / 4 {
            for sum in &mut sums {
                let (value, slope) = ray.at(t);
                *sum = *sum + value + slope;
                t = t + R::splat(1e-5);
            }
        }
        black_box(sums.map(|sum| sum.lane(0)));
        best = best.min(start.elapsed().as_secs_f64());
    }
    (count * R::LANES) as f64 / best / 1e6
}
