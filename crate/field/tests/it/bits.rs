//! Bits are the same natively and as wasm, optimised or not: hashes of fields at fixed places. A
//! change of one is a change of pictures, and must be meant.

use core::cell::RefCell;
use field::bound::SpanLength;
use field::{
    Ball, Bound, Cut, Evaluate, Exponentials, FarField, Implicit, Jet, Kernel, Logarithm, Placed,
    Primitive, Profile, Real, Shaping, Slack, Sum, Taper, Variation, Wave,
};
use glam::{DAffine3, DVec3};
use std::sync::Arc;
use trials::Random;
use trials::bits::Hash;
use trials::skeletons::{ALL_KINDS, Kind, hairpin};
use wide::f32x8;

#[test]
fn bits_are_the_same_on_every_platform() {
    let found = Found::default();
    for kernel in Kernel::ALL {
        for kind in ALL_KINDS {
            let name = format!("{} {kind:?}", kernel.name());
            found.primitives(&name, kind, |random| shaping(random, kernel), None);
        }
        for kind in [Kind::Segment, Kind::Arc, Kind::Curve] {
            let tapered = |random: &mut Random| Shaping {
                taper: Some(Taper {
                    radius: random.pick(&[0.0, 0.4, 1.7]),
                    blobbiness: random.decades(-1.0, 1.0),
                }),
                ..shaping(random, kernel)
            };
            let name = format!("{} tapered {kind:?}", kernel.name());
            found.primitives(&name, kind, tapered, None);
        }
        found.kernel(kernel);
    }
    for waves in [
        [Wave::One, Wave::X],
        [Wave::Sin, Wave::Cos2],
        [Wave::Cos, Wave::Saw],
        [Wave::Sin2, Wave::Hat],
        [Wave::Step, Wave::One],
    ] {
        for kind in ALL_KINDS {
            let profile = Profile {
                waves,
                scale: [9.0, 3.0],
                bounds: [0.5, 1.7],
                times: 1.2,
                restriction: 0.7,
            };
            let name = format!("{waves:?} {kind:?}");
            let shaping = |random: &mut Random| shaping(random, Kernel::Cauchy);
            found.primitives(&name, kind, shaping, Some(profile));
        }
    }
    found.functions();
    found.reals::<f64>("f64");
    found.reals::<f32>("f32");
    found.reals::<f32x8>("f32x8");
    found.limits();
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/bits.txt");
    trials::bits::compare(&found.0.into_inner(), include_str!("../bits.txt"), path);
}

/// Returns a shaping of width about 1.
fn shaping(random: &mut Random, kernel: Kernel) -> Shaping {
    Shaping {
        kernel,
        ..random.shaping(1.0)
    }
}

/// Value and gradient.
fn numbers<R: Real>(jet: Jet<R>) -> impl Iterator<Item = f64> {
    let [x, y, z] = jet.gradient;
    let all = [jet.value, x, y, z].into_iter();
    all.flat_map(|of| (0..R::LANES).map(move |lane| of.lane(lane)))
}

/// Hashes of results, by name.
#[derive(Default)]
struct Found(RefCell<Vec<(String, Hash)>>);

impl Found {
    fn add(&self, name: String, hash: Hash) {
        self.0.borrow_mut().push((name.replace(", ", "-"), hash));
    }

    /// Fields, their bounds and their course on rays at 200 places near 25 skeletons of a kind.
    fn primitives(
        &self,
        name: &str,
        kind: Kind,
        shaping: impl Fn(&mut Random) -> Shaping,
        profile: Option<Profile>,
    ) {
        let mut random = Random::fixed(8);
        let [mut double, mut single, mut eight, mut bounds] = [Hash::default(); 4];
        for _ in 0..25 {
            let size = random.decades(-2.0, 1.0);
            let skeleton = random.skeleton(kind, size);
            let primitive = Primitive::new(skeleton.clone(), &shaping(&mut random), profile);
            let primitive = primitive.expect("flesh");
            let points: [DVec3; 8] =
                core::array::from_fn(|_| random.near(&primitive.skeleton, -3.0, 1.0));
            for point in points {
                double.numbers(numbers(primitive.jet(point.to_array())));
                single.numbers(numbers(primitive.jet(point.as_vec3().to_array())));
            }
            let lanes = [0, 1, 2].map(|k| f32x8::new(points.map(|p| p[k] as f32)));
            eight.numbers(numbers(primitive.jet(lanes)));
            let (origin, way) = (random.vector(2.0), random.direction());
            let (value, slope) = primitive.along_ray(origin, way, 0.7_f64);
            double.numbers([value, slope]);
            let (value, slope) = primitive.along_ray(origin, way, f32x8::splat(0.7));
            eight.numbers([value.lane(5), slope.lane(5)]);
            bounds.numbers([primitive.influence]);
            bounds.numbers(primitive.ray_interval(origin, way).unwrap_or_default());
            let sphere = primitive.bounding_sphere().unwrap_or_default();
            bounds.numbers(sphere.0.to_array().into_iter().chain([sphere.1]));
            for kink in field::kinks::of(&primitive) {
                bounds.numbers([kink.along(origin, way)]);
            }
            let bound = Bound::new(&primitive);
            for point in points {
                let radius = random.decades(-3.0, 0.0);
                let near = bound.nearness(point, radius);
                let estimate = bound.estimate(near, &SpanLength::new(radius));
                bounds.numbers([
                    primitive.most_beyond(primitive.skeleton.distance(point)),
                    bound.magnitude(near),
                    bound.slope(near),
                    bound.curvature(near),
                    bound.third(near),
                    bound.jump(near),
                    bound.least(point, radius),
                    estimate.error,
                    estimate.fourth,
                ]);
            }
        }
        self.add(format!("{name} f64"), double);
        self.add(format!("{name} f32"), single);
        self.add(format!("{name} f32x8"), eight);
        self.add(format!("{name} bounds"), bounds);
    }

    /// A kernel's derivatives and integrals, its blobs on rays, chains of them, quadrature.
    fn kernel(&self, kernel: Kernel) {
        let mut random = Random::fixed(9);
        let [mut own, mut blobs] = [Hash::default(); 2];
        for _ in 0..200 {
            let (u, q) = (random.decades(-3.0, 0.5), random.decades(-2.0, 0.5));
            own.numbers(kernel.derivatives(q * q));
            own.numbers([kernel.value(u), kernel.along(u), kernel.between(u, u + q)]);
            own.numbers([kernel.over_ring(q, q + u), kernel.over_ring(0.0, q)]);
        }
        for _ in 0..20 {
            let (kind, size) = (random.pick(&[Kind::Point, Kind::Segment, Kind::Curve]), 1.0);
            let skeleton = random.skeleton(kind, size);
            let shaping = Shaping {
                strength: 1.0,
                ..shaping(&mut random, kernel)
            };
            let primitive = Primitive::new(skeleton, &shaping, None).expect("flesh");
            let point = random.near(&primitive.skeleton, -1.0, 0.3);
            own.numbers([oracle::quadrature::value(&primitive, point)]);
            for blob in primitive.blob_chain().unwrap_or_default() {
                blobs.numbers([blob.scale, blob.amplitude]);
                blobs.numbers(blob.center.to_array());
            }
            blobs.numbers(on_ray::<f64>(&primitive, point));
            blobs.numbers(on_ray::<f32x8>(&primitive, point));
        }
        self.add(format!("{} kernel", kernel.name()), own);
        self.add(format!("{} blobs", kernel.name()), blobs);
    }

    /// Sums, their hierarchy of far fields, their logarithm, and functions composed of others.
    fn functions(&self) {
        let mut random = Random::fixed(10);
        for kernel in [Kernel::Cauchy, Kernel::Cubed, Kernel::Gauss] {
            let primitives: Vec<Primitive> = (0..300)
                .filter_map(|i| {
                    let kind = [Kind::Point, Kind::Segment, Kind::Triangle][i % 3];
                    let shaping = Shaping {
                        kernel,
                        strength: 1.0,
                        ..random.shaping(0.03)
                    };
                    let shift = random.vector(1.0);
                    let skeleton = random.skeleton(kind, 0.05);
                    let moved = translate(skeleton, shift);
                    Primitive::new(moved, &shaping, None)
                })
                .collect();
            let mut far = Hash::default();
            let field = FarField::new(&primitives, DVec3::ZERO, 2.0).with_derivatives();
            for _ in 0..40 {
                let (center, radius) = (random.vector(1.0), 0.05 * random.unit());
                if let Some(cell) = field.around(&primitives, center, radius) {
                    far.numbers([cell.error, cell.far_least, cell.far_most, cell.most]);
                    far.numbers(cell.smooth.derivatives);
                    far.numbers([cell.smooth.slope_error, cell.near.len() as f64]);
                    far.numbers(numbers(cell.jet(center)));
                }
            }
            self.add(format!("{} far field", kernel.name()), far);
            let sum = Sum::new(primitives);
            self.function(&format!("{} sum", kernel.name()), &sum);
            if let Some(logarithm) = sum.logarithm() {
                let mut hash = Hash::default();
                for _ in 0..40 {
                    let center = random.vector(1.0);
                    let radius = random.decades(-3.0, -0.5);
                    let ball = Ball { center, radius };
                    hash.numbers(numbers(Logarithm::of(&sum.jet(center))));
                    hash.numbers(bounds(&logarithm.variation(None, ball)));
                }
                self.add(format!("{} logarithm", kernel.name()), hash);
            }
        }
        let balls = (0..5).map(|_| (random.vector(1.0), random.range(0.1, 0.6)));
        let balls = Arc::new(Exponentials::new(4.0, balls.collect()).expect("usable numbers"));
        self.function("exponentials", &*balls);
        let mut map = DAffine3::from_scale_rotation_translation(
            DVec3::new(0.7, 1.3, -1.1),
            random.rotation(),
            random.vector(0.3),
        );
        map.matrix3.x_axis.y += 0.2;
        self.function("placed", &Placed::new(balls, map).expect("an inverse"));
        for kernel in [Kernel::Cubed, Kernel::Cauchy, Kernel::Quartic] {
            let local = hairpin(kernel, 0.55).with_folds(0.05);
            let name = format!("{} local", kernel.name());
            self.function(&name, &local);
            let mut hash = Hash::default();
            for _ in 0..100 {
                let (first, second) = local.two(random.vector(1.5).to_array());
                hash.numbers(numbers(first));
                hash.numbers(second.into_iter().flat_map(numbers));
            }
            self.add(format!("{name} two"), hash);
        }
    }

    /// An implicit function's values and bounds.
    fn function(&self, name: &str, function: &dyn Implicit) {
        let mut random = Random::fixed(11);
        let [mut values, mut limits] = [Hash::default(); 2];
        for _ in 0..25 {
            let points: [DVec3; 8] = core::array::from_fn(|_| random.vector(1.2));
            for point in points {
                values.numbers(numbers(function.jet(point)));
                values.numbers(numbers(function.jet32(point.as_vec3().to_array())));
            }
            let lanes = [0, 1, 2].map(|k| f32x8::new(points.map(|p| p[k] as f32)));
            values.numbers(numbers(function.jet8(lanes)));
            let ball = Ball {
                center: points[0],
                radius: random.decades(-3.0, -0.3),
            };
            let range = function.enclose(ball);
            limits.numbers(
                range
                    .value
                    .into_iter()
                    .chain([range.slope, range.curvature]),
            );
            limits.numbers([function.most(ball)]);
            limits.numbers(bounds(&function.variation(None, ball)));
            let slack = Slack {
                left_out: 1e-7,
                far: 1e-4,
            };
            if let Some(part) = function.narrow(ball, None, slack) {
                limits.numbers(part.terms.iter().map(|term| f64::from(*term)));
                limits.numbers(part.error());
                values.numbers(numbers(function.jet_of(&part, ball.center)));
                limits.numbers(bounds(&function.variation(Some(&part), ball)));
            }
            if let Some(clear) = function.clearance(points[1]) {
                limits.numbers([clear.radius, clear.scale]);
            }
        }
        self.add(format!("{name} values"), values);
        self.add(format!("{name} bounds"), limits);
    }

    /// Functions of numbers, each over all of its range.
    fn reals<R: Real>(&self, precision: &str) {
        /// A function's name, itself, and its range.
        type Row<R> = (&'static str, fn(R) -> R, [f64; 2]);
        let rows: [Row<R>; 14] = [
            ("sqrt", R::sqrt, [0.0, 1e9]),
            ("floor", R::floor, [-1e4, 1e4]),
            ("sine", |x| x.sin_cos().0, [-1e3, 1e3]),
            ("cosine", |x| x.sin_cos().1, [-1e3, 1e3]),
            ("octant's sine", |x| x.sin_cos_octant().0, [-0.785, 0.785]),
            ("octant's cosine", |x| x.sin_cos_octant().1, [-0.785, 0.785]),
            ("arctangent", R::arctangent_tail, [0.0, 0.1715]),
            ("error function", |x| x.erfc((x * x).decay()), [0.0, 9.3]),
            ("exponential", R::exp, [-87.0, 87.0]),
            ("decay", R::decay, [-80.0, 87.6]),
            ("decay at most", R::decay_at_most, [0.0, 100.0]),
            ("logarithm", R::ln, [1e-3, 1e6]),
            ("logarithm of 1 + x", R::ln_1p, [-0.9, 3.0]),
            ("area sine", R::asinh, [-50.0, 50.0]),
        ];
        for (name, function, [low, high]) in rows {
            let (mut random, mut hash) = (Random::fixed(12), Hash::default());
            for i in 0..200 {
                // Small numbers, too.
                let x = random.range(low, high) * if i % 4 == 0 { 1e-3 } else { 1.0 };
                let x = x.max(low);
                let value = function(R::from_lanes(|lane| x + (high - x) * 0.1 * lane as f64));
                hash.numbers((0..R::LANES).map(|lane| value.lane(lane)));
            }
            self.add(format!("{name} {precision}"), hash);
        }
        let (mut random, mut hash) = (Random::fixed(13), Hash::default());
        for _ in 0..200 {
            let [a, b] = [0, 1].map(|_| {
                let numbers: [f64; 8] = core::array::from_fn(|_| random.range(-2.0, 2.0));
                R::from_lanes(|lane| numbers[lane])
            });
            for of in [R::min(a, b), R::max(a, b), a.abs(), a.sign_to(b)] {
                hash.numbers((0..R::LANES).map(|lane| of.lane(lane)));
            }
        }
        self.add(format!("limits {precision}"), hash);
    }

    /// The smaller and the larger of two numbers, of which wasm has its own form.
    fn limits(&self) {
        let mut hash = Hash::default();
        let odd = [f64::NAN, f64::NEG_INFINITY, -1.0, 0.0, 2.5, f64::INFINITY];
        for a in odd {
            for b in odd {
                hash.numbers([a.at_least(b), a.at_most(b)]);
                let [a, b] = [a as f32, b as f32];
                hash.numbers([a.at_least(b), a.at_most(b)].map(f64::from));
            }
        }
        self.add("at least and at most".into(), hash);
    }
}

/// Returns a skeleton that is moved by a vector.
fn translate(skeleton: field::Skeleton, by: DVec3) -> field::Skeleton {
    use field::Skeleton::{Point, Segment, Triangle};
    match skeleton {
        Point { center } => Point {
            center: center + by,
        },
        Segment { base, apex } => Segment {
            base: base + by,
            apex: apex + by,
        },
        Triangle { corners } => Triangle {
            corners: corners.map(|p| p + by),
        },
        other => other,
    }
}

/// Numbers of bounds.
fn bounds(of: &Variation) -> [f64; 9] {
    let [low, high] = of.range.value;
    let range = of.range;
    [
        low,
        high,
        range.slope,
        range.curvature,
        of.curvature,
        of.third,
        of.rough,
        of.jump,
        of.step,
    ]
}

/// Values and limits of a blob on the way to it, if it is one.
fn on_ray<R: Real<Scalar: Evaluate>>(primitive: &Primitive, from: DVec3) -> Vec<f64> {
    let Some(blob) = primitive.blob::<R::Scalar>() else {
        return Vec::new();
    };
    let middle = primitive.blob_middle() - from;
    let [to, way] = [middle, middle.normalize_or_zero()].map(|v| v.to_array().map(R::splat));
    let ray = blob.on_ray::<R>(to, way);
    let [a, b] = [0.2, 0.9].map(|t| R::from_lanes(|lane| t * (1.0 + lane as f64)));
    let limits = ray.most(a, b);
    let ((value, slope), bent) = (ray.at(a), ray.bent(b));
    let mut all = vec![value, slope, bent.0, bent.1, bent.2];
    all.extend([limits.most, limits.bend, limits.kink]);
    all.extend(ray.within(R::splat(2.0)));
    let lanes = (0..R::LANES).flat_map(|lane| all.iter().map(move |x| x.lane(lane)));
    lanes.collect()
}
