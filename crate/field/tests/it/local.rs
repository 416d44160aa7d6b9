//! Local convolution: against its definition, by quadrature; its bounds, by sampling; and how
//! smooth it is.

use field::local::{Limb, LimbPiece, LocalError, Two};
use field::{Ball, BlobScale, Implicit, Jet, Kernel, Local, Primitive, Shaping, Skeleton, Taper};
use glam::DVec3;
use oracle::quadrature;
use trials::{Random, count};
use wide::f32x8;

/// A skeleton: points with radii, and segments between them, curve by curve.
struct Figure {
    points: Vec<(DVec3, f64)>,
    /// Pairs of points.
    segments: Vec<[usize; 2]>,
    reach: f64,
    kernel: Kernel,
}

/// A piece: two ends with radii, and from where to where on its segment.
#[derive(Clone, Copy)]
struct Piece {
    segment: usize,
    from: f64,
    to: f64,
}

const PIECES: usize = 2;

impl Figure {
    fn new(points: Vec<(DVec3, f64)>, curves: &[Vec<usize>], reach: f64, kernel: Kernel) -> Self {
        let mut segments = Vec::new();
        for curve in curves {
            segments.extend(curve.windows(2).map(|w| [w[0], w[1]]));
        }
        Self {
            points,
            segments,
            reach,
            kernel,
        }
    }

    fn length(&self, [a, b]: [usize; 2]) -> f64 {
        self.points[a].0.distance(self.points[b].0)
    }

    /// The radius at a part of a segment.
    fn radius(&self, [a, b]: [usize; 2], part: f64) -> f64 {
        let [start, end] = [a, b].map(|i| self.points[i].1);
        start + (end - start) * part
    }

    fn primitive(&self, [a, b]: [usize; 2], from: f64, to: f64) -> Primitive {
        let [(base, start), (apex, end)] = [self.points[a], self.points[b]];
        let shaping = Shaping {
            kernel: self.kernel,
            radius: self.radius([a, b], from),
            blobbiness: 2.0,
            blob_scale: BlobScale::Relative,
            strength: 1.0,
            influence: 1e-3,
            taper: (start != end).then_some(Taper {
                radius: self.radius([a, b], to),
                blobbiness: 2.0,
            }),
        };
        let skeleton = Skeleton::Segment {
            base: base.lerp(apex, from),
            apex: base.lerp(apex, to),
        };
        Primitive::new(skeleton, &shaping, None).expect("it is a segment")
    }

    fn pieces(&self) -> Vec<Piece> {
        let mut all = Vec::new();
        for segment in 0..self.segments.len() {
            for i in 0..PIECES {
                let [from, to] = [i, i + 1].map(|i| i as f64 / PIECES as f64);
                all.push(Piece { segment, from, to });
            }
        }
        all
    }

    fn local(&self) -> Local {
        let segments = &self.segments;
        let limbs: Vec<Limb> = (segments.iter())
            .map(|ends| Limb {
                ends: ends.map(|end| end as u32),
                pieces: (0..PIECES)
                    .map(|i| {
                        let [from, to] = [i, i + 1].map(|i| i as f64 / PIECES as f64);
                        // A piece of two primitives is as one of their sum.
                        let middle = 0.5 * (from + to);
                        let halves = [[from, middle], [middle, to]];
                        LimbPiece {
                            primitives: halves.map(|[a, b]| self.primitive(*ends, a, b)).to_vec(),
                            length: self.length(*ends) / PIECES as f64,
                            radius: self.radius(*ends, middle),
                        }
                    })
                    .collect(),
            })
            .collect();
        let points: Vec<DVec3> = self.points.iter().map(|p| p.0).collect();
        Local::new(&points, &limbs, self.reach).expect("it is short")
    }

    /// Distances along the skeleton between all points (Floyd and Warshall).
    fn distances(&self) -> Vec<Vec<f64>> {
        let n = self.points.len();
        let mut d = vec![vec![f64::INFINITY; n]; n];
        for (i, row) in d.iter_mut().enumerate() {
            row[i] = 0.0;
        }
        for &ends in &self.segments {
            let length = self.length(ends);
            for [a, b] in [ends, [ends[1], ends[0]]] {
                d[a][b] = d[a][b].min(length);
            }
        }
        for k in 0..n {
            for i in 0..n {
                for j in 0..n {
                    d[i][j] = d[i][j].min(d[i][k] + d[k][j]);
                }
            }
        }
        d
    }

    /// Distance along the skeleton between parts of segments.
    fn distance(&self, between: &[Vec<f64>], a: (usize, f64), b: (usize, f64)) -> f64 {
        let segments = &self.segments;
        let (first, second) = (segments[a.0], segments[b.0]);
        let (own, other) = (self.length(first), self.length(second));
        let mut least = match a.0 == b.0 {
            true => (a.1 - b.1).abs() * own,
            false => f64::INFINITY,
        };
        for (i, here) in [a.1 * own, (1.0 - a.1) * own].into_iter().enumerate() {
            for (k, there) in [b.1 * other, (1.0 - b.1) * other].into_iter().enumerate() {
                least = least.min(here + between[first[i]][second[k]] + there);
            }
        }
        least
    }

    /// W at a place, by its definition: the window's mean by Simpson's rule, pieces by quadrature.
    fn stretch(&self, between: &[Vec<f64>], place: (usize, f64), point: DVec3) -> f64 {
        const STEPS: usize = 200;
        let fade = self.reach / 3.0;
        let window = |x: f64| {
            let t = ((x - self.reach + fade) / fade).clamp(0.0, 1.0);
            1.0 - t * t * (3.0 - 2.0 * t)
        };
        let segments = &self.segments;
        let mut sum = 0.0;
        for Piece { segment, from, to } in self.pieces() {
            // Simpson's rule.
            let at = |i: usize| {
                let part = from + (to - from) * i as f64 / STEPS as f64;
                window(self.distance(between, place, (segment, part)))
            };
            let inner = |first: usize| (first..STEPS).step_by(2).map(at).sum::<f64>();
            let mean = (at(0) + at(STEPS) + 4.0 * inner(1) + 2.0 * inner(2)) / (3 * STEPS) as f64;
            if mean > 0.0 {
                sum +=
                    mean * quadrature::value(&self.primitive(segments[segment], from, to), point);
            }
        }
        sum
    }

    /// Computes F, F₂ and the largest W, by their definition.
    fn fields(&self, point: DVec3, level: f64) -> [f64; 3] {
        let between = self.distances();
        let pieces = self.pieces();
        let middle = |p: &Piece| (p.segment, 0.5 * (p.from + p.to));
        let weights = pieces.iter().map(|p| {
            let length = self.length(self.segments[p.segment]) * (p.to - p.from);
            let primitive = self.primitive(self.segments[p.segment], p.from, p.to);
            let radius = self.radius(self.segments[p.segment], 0.5 * (p.from + p.to));
            length * (quadrature::value(&primitive, point) * radius / length).powi(8)
        });
        let weights: Vec<f64> = weights.collect();
        let stretches = pieces.iter();
        let stretches = stretches.map(|p| self.stretch(&between, middle(p), point));
        let stretches: Vec<f64> = stretches.collect();
        let mean = |of: &dyn Fn(usize) -> [f64; 2]| {
            let [mut sum, mut total] = [0.0; 2];
            for i in 0..pieces.len() {
                let [weight, value] = of(i);
                sum += weight * value;
                total += weight;
            }
            if total > 0.0 { sum / total } else { 0.0 }
        };
        let second = |j: usize| {
            let far = mean(&|k| {
                let distance = self.distance(&between, middle(&pieces[j]), middle(&pieces[k]));
                let t = (distance / self.reach - 2.0).clamp(0.0, 1.0);
                let apart = t * t * (3.0 - 2.0 * t);
                [apart * weights[k], apart * stretches[k]]
            });
            let t = (2.0 * far / level - 1.0).clamp(0.0, 1.0);
            far * t * t * (3.0 - 2.0 * t)
        };
        [
            mean(&|j| [weights[j], stretches[j]]),
            mean(&|j| [weights[j], second(j)]),
            stretches.iter().copied().fold(0.0, f64::max),
        ]
    }
}

/// Curves that fold and branch; some lie across the others.
fn figure(random: &mut Random, kernel: Kernel) -> Figure {
    let mut points = vec![(DVec3::ZERO, 0.3)];
    let mut curve = vec![0];
    let mut heading = random.direction();
    for _ in 0..7 {
        heading = (heading + 0.7 * random.direction()).normalize();
        let before = points[points.len() - 1].0;
        let radius = if random.chance(0.5) {
            0.3
        } else {
            random.range(0.15, 0.4)
        };
        points.push((before + heading * random.range(0.25, 0.5), radius));
        curve.push(points.len() - 1);
    }
    // A branch that turns back.
    let mut branch = vec![3];
    let mut heading = (points[0].0 - points[3].0).normalize() + 0.8 * random.direction();
    for _ in 0..3 {
        heading = (heading + 0.5 * random.direction()).normalize();
        let before = points[branch[branch.len() - 1]].0;
        points.push((before + heading * 0.4, 0.25));
        branch.push(points.len() - 1);
    }
    let reach = random.range(0.8, 1.4);
    Figure::new(points, &[curve, branch], reach, kernel)
}

fn near(figure: &Figure, random: &mut Random, spread: f64) -> DVec3 {
    let [a, b] = random.pick(&figure.segments);
    let on = figure.points[a].0.lerp(figure.points[b].0, random.unit());
    on + random.direction() * random.range(0.05, spread)
}

/// Figures that are out of the common: a closed curve, five curves of one node, curves along each
/// other, a reach beyond the whole, and two parts that nothing joins.
fn odd_figures(kernel: Kernel) -> Vec<Figure> {
    let at = |x: f64, y: f64| (DVec3::new(x, y, 0.1 * x * y), 0.25);
    let ring = [0.0, 1.0, 2.0, 3.0, 4.0].map(|i| {
        let (y, x) = libm::sincos(i * core::f64::consts::TAU / 5.0);
        at(0.6 * x, 0.6 * y)
    });
    let two = vec![at(-1.0, 0.0), at(-0.5, 0.0), at(0.0, 0.1), at(0.5, 0.0)];
    let along = vec![vec![0, 1, 2, 3], vec![0, 1, 2, 3], vec![3, 2]];
    let apart = vec![vec![0, 1], vec![2, 3]];
    let whole = vec![vec![0, 1, 2, 3]];
    vec![
        Figure::new(ring.to_vec(), &[vec![0, 1, 2, 3, 4, 0]], 0.7, kernel),
        Figure::new(ring.to_vec(), &[vec![0, 1, 2, 3, 4, 0]], 0.4, kernel),
        star(5, kernel),
        Figure::new(two.clone(), &along, 0.6, kernel),
        Figure::new(two.clone(), &whole, 50.0, kernel),
        Figure::new(two, &apart, 0.4, kernel),
    ]
}

fn figures(random: &mut Random, kernel: Kernel) -> Vec<Figure> {
    let mut figures = odd_figures(kernel);
    figures.extend((0..3).map(|_| figure(random, kernel)));
    figures
}

#[test]
fn the_fields_are_the_means_of_stretches() {
    let mut random = Random::new(71);
    let (mut compared, mut seconds) = (0, 0);
    for kernel in [Kernel::Cubed, Kernel::Cauchy, Kernel::Quartic] {
        for figure in figures(&mut random, kernel) {
            let local = figure.local().with_folds(0.01);
            for _ in 0..count(4) {
                let point = near(&figure, &mut random, 0.8);
                let [want, second, most] = figure.fields(point, 0.01);
                let (own, other) = local.two(point.to_array());
                assert!((own.value - want).abs() <= 1e-6 * want, "{own:?} {want}");
                assert!(own.value <= most * (1.0 + 1e-6), "{own:?} {most}");
                match other {
                    Some(own) => {
                        let error = (own.value - second).abs();
                        assert!(error <= 1e-6 * second + 1e-9, "{own:?} {second}");
                        seconds += 1;
                    }
                    None => assert!(second <= 0.01 * (1.0 + 1e-6), "{second}"),
                }
                compared += 1;
            }
        }
    }
    assert!(
        compared > count(40) && 5 * seconds > compared,
        "{compared} {seconds}"
    );
}

#[test]
fn pieces_without_length_are_refused() {
    let figure = &odd_figures(Kernel::Cubed)[3];
    let points: Vec<DVec3> = figure.points.iter().map(|p| p.0).collect();
    let limb = Limb {
        ends: [0, 1],
        pieces: vec![LimbPiece {
            primitives: vec![figure.primitive([0, 1], 0.0, 1.0)],
            length: 0.0,
            radius: 0.3,
        }],
    };
    let made = Local::new(&points, &[limb], 1.0).map(|_| ());
    assert_eq!(made, Err(LocalError::Unusable));
}

/// A lane of eight has the bits of a number alone, wherever the other lanes are, so that cells of
/// space that know which pieces matter change nothing; and both are near those of double precision.
#[test]
fn precisions_agree() {
    let mut random = Random::new(75);
    for kernel in [Kernel::Cubed, Kernel::Cauchy, Kernel::Quartic] {
        for figure in figures(&mut random, kernel) {
            let local = figure.local().with_folds(0.01);
            for _ in 0..count(20) {
                let spread = random.pick(&[0.0, 0.01, 1.0]);
                let middle = near(&figure, &mut random, 0.5);
                let points: [DVec3; 8] =
                    core::array::from_fn(|_| middle + spread * 0.3 * random.direction());
                let points = points.map(|p| p.as_vec3());
                let lanes = [0, 1, 2].map(|k| f32x8::new(points.map(|p| p[k])));
                let eight = local.jet8(lanes);
                for (i, point) in points.into_iter().enumerate() {
                    let one = local.jet32(point.to_array());
                    let bits = |x: f32| x.to_bits();
                    assert_eq!(bits(one.value), bits(eight.value.to_array()[i]));
                    let gradient = eight.gradient.map(|g| bits(g.to_array()[i]));
                    assert_eq!(one.gradient.map(bits), gradient);
                    let exact = local.jet(point.as_dvec3());
                    let size = 1.0 + exact.value;
                    assert!((f64::from(one.value) - exact.value).abs() < 1e-4 * size);
                    let steep = DVec3::from_array(exact.gradient);
                    let own = DVec3::from_array(one.gradient.map(f64::from));
                    let error = own.distance(steep);
                    // The weights of fields that end tell little where these nearly have.
                    let most = if exact.value > 0.3 { 2e-3 } else { 0.05 };
                    assert!(error < most * (size + steep.length()), "{own} {steep}");
                }
            }
        }
    }
}

#[test]
fn gradients_are_derivatives() {
    let mut random = Random::new(72);
    for kernel in [Kernel::Cubed, Kernel::Cauchy] {
        for figure in figures(&mut random, kernel) {
            let local = figure.local().with_folds(0.01);
            for _ in 0..count(20) {
                let point = near(&figure, &mut random, 0.6);
                let both = |point: DVec3| {
                    let (first, second) = local.two(point.to_array());
                    [Some(first), second]
                };
                let jets = both(point);
                let h = 1e-5;
                for which in [0, 1] {
                    let Some(jet) = jets[which] else { continue };
                    let gradient = core::array::from_fn(|axis| {
                        let at = |step: f64| {
                            let mut p = point;
                            p[axis] += step * h;
                            both(p)[which].map_or(f64::NAN, |jet| jet.value)
                        };
                        (at(1.0) - at(-1.0)) / (2.0 * h)
                    });
                    let gradient = DVec3::from_array(gradient);
                    let own = DVec3::from_array(jet.gradient);
                    // F₂ may be left out beside the point.
                    if gradient.is_nan() {
                        continue;
                    }
                    let size = 1.0 + own.length() + jet.value.powi(2);
                    assert!(
                        own.distance(gradient) < 1e-5 * size,
                        "{which}: {own} {gradient}"
                    );
                }
            }
        }
    }
}

/// Values, slopes and second derivatives in balls are within their bounds, and the bounds are of
/// use.
#[test]
fn bounds_hold_in_balls() {
    let mut random = Random::new(73);
    let (mut finite, mut all, mut sharpest, mut bent) = (0, 0, [0.0f64; 2], 0);
    for kernel in [Kernel::Cubed, Kernel::Cauchy, Kernel::Quartic] {
        for figure in figures(&mut random, kernel) {
            let local = figure.local().with_folds(0.05);
            for _ in 0..count(50) {
                let center = near(&figure, &mut random, 0.7);
                let radius = random.decades(-4.0, -0.5);
                let ball = Ball { center, radius };
                let Two { first, second, .. } = local.enclose_two(ball);
                let (at_center, other_at_center) = local.two(center.to_array());
                let most = local.most(ball);
                let step = 1e-3 * radius;
                let (variation, _) = local.variation_with_jet(None, ball);
                let turns = local.turn_smoothly(None, ball, step).unwrap();
                bent += u32::from(variation.third > 0.0 && variation.jump.is_finite());
                all += 1;
                finite += u32::from(first.slope.is_finite());
                for _ in 0..12 {
                    let point = center + random.direction() * (radius * random.unit());
                    let (own, other) = local.two(point.to_array());
                    assert!(own.value <= most * (1.0 + 1e-9), "{own:?} {most}");
                    // Both halves' bounds hold here, too: along the gradient at the centre, and
                    // with the main half's second derivative.
                    let (offset, far) = (point - center, point.distance(center));
                    let change =
                        DVec3::from_array(own.gradient) - DVec3::from_array(at_center.gradient);
                    let most = variation.curvature * far + variation.jump;
                    let doubt = 1e-7 + 1e-12 / step;
                    assert!(
                        change.length() <= most * (1.0 + 1e-6) + doubt,
                        "{change} {most}"
                    );
                    if variation.third > 0.0 {
                        let [x, y, z] = turns;
                        let series = (x * offset.x + y * offset.y + z * offset.z) / step;
                        let third = variation.third * (0.5 * far + 2.0 * step) * far;
                        let most = third + variation.rough * far + variation.jump;
                        let off = change.distance(series);
                        assert!(off <= most * (1.0 + 1e-6) + doubt, "{off} {most} {ball:?}");
                    }
                    let bounded = other.map(|other| (other, second, other_at_center));
                    for (i, (own, bounds, center)) in
                        [Some((own, Some(first), Some(at_center))), bounded]
                            .into_iter()
                            .flatten()
                            .enumerate()
                    {
                        let Some(bounds) = bounds else {
                            assert!(own.value <= 0.05 * (1.0 + 1e-6), "{own:?}");
                            continue;
                        };
                        let slack = 1e-9 * (1.0 + own.value.abs());
                        let [low, high] = bounds.value;
                        assert!(
                            low - slack <= own.value && own.value <= high + slack,
                            "{i}: {own:?} {bounds:?} {ball:?}"
                        );
                        let gradient = |jet: Jet<f64>| DVec3::from_array(jet.gradient);
                        let steep = gradient(own).length();
                        assert!(
                            steep <= bounds.slope * (1.0 + 1e-9),
                            "{i}: {steep} {bounds:?} {ball:?}"
                        );
                        if let Some(center) = center {
                            // The gradient changes by no more than the second derivative times
                            // the distance.
                            let change = gradient(own).distance(gradient(center));
                            let most = bounds.curvature * radius + bounds.jump;
                            assert!(change <= most * (1.0 + 1e-6) + 1e-7, "{i}: {change} {most}");
                            if most.is_finite() {
                                sharpest[i] = sharpest[i].max(change / most);
                            }
                        }
                    }
                }
            }
        }
    }
    println!("{finite} of {all}, {sharpest:?} {bent}");
    assert!(
        2 * finite > all && 3 * bent > all && sharpest[0] > 0.1 && sharpest[1] > 0.02,
        "{finite} of {all}, {sharpest:?} {bent}"
    );
}

/// Normals of surfaces that are 10⁻⁵ radii apart differ by less than a degree, at bends, inside of
/// folds and at branches.
#[test]
fn normals_do_not_jump() {
    let mut random = Random::new(77);
    for kernel in [Kernel::Cubed, Kernel::Cauchy, Kernel::Gauss] {
        let mut all = vec![wave(36, kernel), wave(144, kernel)];
        all.extend([3, 5, 6].map(|arms| star(arms, kernel)));
        all.extend((0..3).map(|_| figure(&mut random, kernel)));
        let (mut worst, mut found) = (0.0f64, 0);
        for figure in all {
            let local = figure.local();
            for _ in 0..count(1000) {
                let mut point = near(&figure, &mut random, 0.5);
                for _ in 0..12 {
                    let Jet { value, gradient } = local.jet(point);
                    let gradient = DVec3::from_array(gradient);
                    let step = gradient * ((1.0 - value) / gradient.length_squared());
                    point += step.clamp_length_max(0.05);
                }
                if (local.jet(point).value - 1.0).abs() > 1e-6 {
                    continue;
                }
                found += 1;
                let normal = |point| DVec3::from_array(local.jet(point).gradient).normalize();
                let beside = point + 0.3e-5 * random.direction();
                worst = worst.max(normal(point).distance(normal(beside)).to_degrees());
            }
        }
        println!("{kernel:?}: {worst:.4}° of {found}");
        assert!(
            worst < 1.0 && found > count(3000),
            "{kernel:?} {worst} {found}"
        );
    }
}

/// Returns a wave of flesh of a radius of 0.3, whose bends have a radius of 0.5.
fn wave(segments: u32, kernel: Kernel) -> Figure {
    let places: Vec<(DVec3, f64)> = (0..=segments)
        .map(|i| {
            let x = 6.0 * f64::from(i) / f64::from(segments) - 3.0;
            (DVec3::new(x, 0.5 * libm::sin(2.0 * x), 0.0), 0.3)
        })
        .collect();
    let curve: Vec<usize> = (0..places.len()).collect();
    Figure::new(places, &[curve], 1.2, kernel)
}

/// Returns arms that end in one branch.
fn star(arms: usize, kernel: Kernel) -> Figure {
    let mut random = Random::new(76);
    let mut places = vec![(DVec3::ZERO, 0.3)];
    let mut curves = Vec::new();
    for _ in 0..arms {
        let direction = random.direction();
        let mut curve = vec![0];
        for i in 1..=6 {
            curve.push(places.len());
            places.push((direction * (0.25 * f64::from(i)), 0.25));
        }
        curves.push(curve);
    }
    Figure::new(places, &curves, 1.2, kernel)
}

/// Folds beside each other blend when all of the skeleton counts, and do not when only what is near
/// does.
#[test]
fn folds_do_not_blend() {
    let fold = |reach: f64| {
        let points = [(-2.0, 0.0), (0.0, 0.0), (0.6, 0.5), (0.0, 1.0), (-2.0, 1.0)];
        let points = points.map(|(x, y)| (DVec3::new(x, y, 0.0), 0.4)).to_vec();
        Figure::new(points, &[vec![0, 1, 2, 3, 4]], reach, Kernel::Cubed).local()
    };
    // Between the two legs.
    let between = DVec3::new(-1.5, 0.5, 0.0);
    assert!(fold(100.0).jet(between).value > 1.0);
    assert!(fold(1.0).jet(between).value < 0.9);
}
