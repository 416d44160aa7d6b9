//! Local convolution: against its definition, by quadrature and search; its bounds, by sampling;
//! and how far it jumps.

use field::local::{Limb, Place, Two};
use field::{Ball, BlobScale, Implicit, Kernel, Local, Primitive, Shaping, Skeleton, Taper};
use glam::DVec3;
use oracle::quadrature;
use trials::{Random, count};

/// A skeleton: points with radii, and segments between them, curve by curve.
struct Figure {
    points: Vec<(DVec3, f64)>,
    /// Pair of points, and the number of their curve.
    segments: Vec<([usize; 2], usize)>,
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
        for (number, curve) in curves.iter().enumerate() {
            segments.extend(curve.windows(2).map(|w| ([w[0], w[1]], number)));
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

    fn primitive(&self, [a, b]: [usize; 2], from: f64, to: f64) -> Primitive {
        let [(base, start), (apex, end)] = [self.points[a], self.points[b]];
        let radius = |part: f64| start + (end - start) * part;
        let shaping = Shaping {
            kernel: self.kernel,
            radius: radius(from),
            blobbiness: 2.0,
            blob_scale: BlobScale::Relative,
            strength: 1.0,
            influence: 1e-3,
            taper: (start != end).then_some(Taper {
                radius: radius(to),
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

    /// The segment that goes on from an end of another.
    fn next(&self, index: usize, end: usize) -> Option<usize> {
        let segments = &self.segments;
        let point = segments[index].0[end];
        let around: Vec<usize> = (0..segments.len())
            .filter(|i| segments[*i].0.contains(&point))
            .collect();
        if around.len() == 2 {
            return around.into_iter().find(|i| *i != index);
        }
        let other = if end == 0 {
            index.checked_sub(1)?
        } else {
            index + 1
        };
        let (ends, curve) = segments.get(other)?;
        (*curve == segments[index].1 && ends[1 - end] == point).then_some(other)
    }

    fn local(&self) -> Local {
        let segments = &self.segments;
        let limbs: Vec<Limb> = (segments.iter().enumerate())
            .map(|(index, (ends, _))| Limb {
                ends: ends.map(|end| end as u32),
                next: [0, 1].map(|end| self.next(index, end).map(|next| next as u32)),
                pieces: (0..PIECES)
                    .map(|i| {
                        let [from, to] = [i, i + 1].map(|i| i as f64 / PIECES as f64);
                        (
                            self.primitive(*ends, from, to),
                            self.length(*ends) / PIECES as f64,
                        )
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
        for &(ends, _) in &self.segments {
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
        let (first, second) = (segments[a.0].0, segments[b.0].0);
        let (own, other) = (self.length(first), self.length(second));
        if a.0 == b.0 {
            return (a.1 - b.1).abs() * own;
        }
        let mut least = f64::INFINITY;
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
                    mean * quadrature::value(&self.primitive(segments[segment].0, from, to), point);
            }
        }
        sum
    }

    /// The places whose planes hold a point, by a search for changes of sign; and ends and
    /// branches.
    fn places(&self, point: DVec3) -> Vec<(usize, f64)> {
        const STEPS: usize = 500;
        let segments = &self.segments;
        let direction = |index: usize| {
            let [a, b] = segments[index].0;
            (self.points[b].0 - self.points[a].0).normalize()
        };
        let mut found = Vec::new();
        for index in 0..segments.len() {
            let ends = segments[index].0;
            let normals = [0, 1].map(|end| match self.next(index, end) {
                None => direction(index),
                Some(next) => {
                    let along = segments[next].0[1 - end] == ends[end];
                    let other = direction(next) * if along { 1.0 } else { -1.0 };
                    (direction(index) + other).normalize()
                }
            });
            let at = |u: f64| {
                let place = self.points[ends[0]].0.lerp(self.points[ends[1]].0, u);
                normals[0].lerp(normals[1], u).dot(point - place)
            };
            for i in 0..STEPS {
                let [mut low, mut high] = [i, i + 1].map(|i| i as f64 / STEPS as f64);
                let first = at(low);
                if (first <= 0.0) == (at(high) <= 0.0) {
                    continue;
                }
                for _ in 0..60 {
                    let middle = 0.5 * (low + high);
                    if (at(middle) <= 0.0) == (first <= 0.0) {
                        low = middle;
                    } else {
                        high = middle;
                    }
                }
                found.push((index, 0.5 * (low + high)));
            }
            for end in [0, 1] {
                if self.next(index, end).is_none() {
                    found.push((index, end as f64));
                }
            }
        }
        found
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
    let segments = &figure.segments;
    let [a, b] = random.pick(segments).0;
    let on = figure.points[a].0.lerp(figure.points[b].0, random.unit());
    on + random.direction() * random.range(0.05, spread)
}

#[test]
fn the_field_is_the_largest_stretch() {
    let mut random = Random::new(71);
    let mut compared = 0;
    for kernel in [Kernel::Cubed, Kernel::Cauchy, Kernel::Quartic] {
        for _ in 0..2 {
            let figure = figure(&mut random, kernel);
            let (local, between) = (figure.local(), figure.distances());
            for _ in 0..count(8) {
                let point = near(&figure, &mut random, 0.8);
                let places = figure.places(point);
                let stretches: Vec<f64> = places
                    .iter()
                    .map(|p| figure.stretch(&between, *p, point))
                    .collect();
                let (leader, want) = (places.iter().zip(&stretches))
                    .max_by(|a, b| a.1.total_cmp(b.1))
                    .expect("there are ends");
                // Beyond all supports all places are alike.
                if *want == 0.0 {
                    continue;
                }
                let jet = local.jet(point);
                let tolerance = 1e-6 * want;
                assert!(
                    (jet.value - want).abs() <= tolerance,
                    "{} for {want}",
                    jet.value
                );
                // Those of the others that are far along the skeleton.
                let far = (places.iter().zip(&stretches))
                    .filter(|(p, _)| figure.distance(&between, **p, *leader) > 2.0 * figure.reach)
                    .map(|(_, w)| *w)
                    .fold(f64::NEG_INFINITY, f64::max);
                match local.two(point).1 {
                    Some(second) => {
                        assert!((second.value - far).abs() <= 1e-6 * far.abs(), "{far}")
                    }
                    None => assert_eq!(far, f64::NEG_INFINITY),
                }
                compared += 1;
            }
        }
    }
    assert!(compared > count(40), "{compared}");
}

/// Cells of space that know which places matter change nothing, down to the last bit.
#[test]
fn cells_leave_nothing_out() {
    let mut random = Random::new(75);
    let (mut seconds, mut all) = (0, 0);
    for kernel in [Kernel::Cubed, Kernel::Cauchy, Kernel::Quartic] {
        for _ in 0..4 {
            let figure = figure(&mut random, kernel);
            let local = figure.local();
            for _ in 0..count(400).max(400) {
                let point = near(&figure, &mut random, 0.7);
                // Below the faintest level all terms are asked.
                let (first, second) = local.two(point);
                assert_eq!(local.jet(point), first);
                let level = 0.1;
                let (own, other) = local.two_above(point, level);
                assert_eq!(own, first);
                all += 1;
                if let Some(second) = second.filter(|second| second.value >= level) {
                    assert_eq!(other, Some(second));
                    seconds += 1;
                }
            }
        }
    }
    assert!(seconds * 50 > all, "{seconds} of {all}");
}

#[test]
fn gradients_are_derivatives() {
    let mut random = Random::new(72);
    let (mut all, mut off) = (0, 0);
    for _ in 0..10 {
        let figure = figure(&mut random, Kernel::Cubed);
        let local = figure.local();
        for _ in 0..count(40) {
            let point = near(&figure, &mut random, 0.6);
            let jet = local.jet(point);
            let h = 1e-5;
            let gradient = DVec3::from_array(core::array::from_fn(|axis| {
                let at = |step: f64| {
                    let mut p = point;
                    p[axis] += step * h;
                    local.jet(p).value
                };
                (at(1.0) - at(-1.0)) / (2.0 * h)
            }));
            let own = DVec3::from_array(jet.gradient);
            all += 1;
            // Two places may tie within h.
            off += u32::from(
                (gradient - own).length() > 1e-5 * (1.0 + own.length() + jet.value.powi(2)),
            );
        }
    }
    assert!(off * 50 < all, "{off} of {all}");
}

/// Values, slopes and second derivatives in balls are within their bounds, and the bounds are of
/// use.
#[test]
fn bounds_hold_in_balls() {
    let mut random = Random::new(73);
    let (mut finite, mut all, mut sharpest) = (0, 0, 0.0f64);
    for kernel in [Kernel::Cubed, Kernel::Cauchy] {
        for _ in 0..8 {
            let figure = figure(&mut random, kernel);
            let local = figure.local();
            for _ in 0..count(60) {
                let center = near(&figure, &mut random, 0.7);
                let radius = random.decades(-4.0, -0.5);
                let ball = Ball { center, radius };
                let Two { first, second } = local.enclose_two(ball, Some(0.0));
                all += 1;
                finite += u32::from(first.slope.is_finite());
                for _ in 0..12 {
                    let point = center + random.direction() * (radius * random.unit());
                    let (own, other) = local.two(point);
                    let inside = |value: f64, [low, high]: [f64; 2]| {
                        let slack = 1e-9 * (1.0 + value.abs());
                        low - slack <= value && value <= high + slack
                    };
                    assert!(
                        inside(own.value, first.value),
                        "{} {first:?} {ball:?}",
                        own.value
                    );
                    let steep = DVec3::from_array(own.gradient).length();
                    assert!(
                        steep <= first.slope * (1.0 + 1e-9),
                        "{steep} {first:?} {ball:?}"
                    );
                    if let (Some(other), Some(second)) = (other, second) {
                        assert!(
                            inside(other.value, second.value),
                            "{} {second:?}",
                            other.value
                        );
                        let steep = DVec3::from_array(other.gradient).length();
                        assert!(steep <= second.slope * (1.0 + 1e-9), "{steep} {second:?}");
                    }
                    assert!(other.is_none() || second.is_some());
                    if first.jump.is_finite() {
                        // The gradient changes by no more than the second derivative times the
                        // distance, and its jumps.
                        let center = local.jet(center);
                        let change =
                            DVec3::from_array(own.gradient) - DVec3::from_array(center.gradient);
                        let most = first.curvature * radius + first.jump;
                        assert!(
                            change.length() <= most * (1.0 + 1e-6) + 1e-7,
                            "{change} {most}"
                        );
                        sharpest = sharpest.max(change.length() / most);
                    }
                }
            }
        }
    }
    assert!(
        2 * finite > all && sharpest > 0.02,
        "{finite} of {all}, {sharpest}"
    );
}

/// Across the planes at joints and at the ends of curves in a branch the value is continuous and
/// the slope jumps a little; where places vanish that lead, far out beside bends, the value jumps.
#[test]
fn jumps_are_small() {
    for kernel in [Kernel::Cubed, Kernel::Cauchy, Kernel::Quartic] {
        let [coarse, fine] = [36, 144].map(|segments| {
            let (figure, planes) = wave(segments, kernel);
            jumps(&figure, &planes)
        });
        // The value has none. A slope's is that of the turn at a joint: the finer the curve, the
        // smaller.
        assert!(
            coarse[0].max(fine[0]) < 1e-6,
            "{kernel:?} {coarse:?} {fine:?}"
        );
        assert!(
            coarse[1] < 0.2 && fine[1] < 0.7 * coarse[1],
            "{kernel:?} {coarse:?} {fine:?}"
        );
        for arms in [3, 6] {
            let (figure, planes) = star(arms, kernel);
            let branch = jumps(&figure, &planes);
            assert!(
                branch[0] < 1e-6 && branch[1] < 0.2,
                "{kernel:?} {arms}: {branch:?}"
            );
        }
    }
}

/// Returns a wave of flesh of a radius of 0.3, whose bends have a radius of 0.5: inside of them ∇s
/// is large. And the planes of its joints: a point and the normal.
fn wave(segments: u32, kernel: Kernel) -> (Figure, Vec<[DVec3; 2]>) {
    let places: Vec<(DVec3, f64)> = (0..=segments)
        .map(|i| {
            let x = 6.0 * f64::from(i) / f64::from(segments) - 3.0;
            (DVec3::new(x, 0.5 * libm::sin(2.0 * x), 0.0), 0.3)
        })
        .collect();
    let planes = places.windows(3).map(|w| {
        let [a, b, c] = [0, 1, 2].map(|i| w[i].0);
        let normal = (b - a).normalize() + (c - b).normalize();
        [b, normal.normalize()]
    });
    let planes = planes.collect();
    let curve: Vec<usize> = (0..places.len()).collect();
    (Figure::new(places, &[curve], 1.2, kernel), planes)
}

/// Arms that end in one branch, and the planes of their ends there.
fn star(arms: usize, kernel: Kernel) -> (Figure, Vec<[DVec3; 2]>) {
    let mut random = Random::new(76);
    let mut places = vec![(DVec3::ZERO, 0.3)];
    let (mut curves, mut planes) = (Vec::new(), Vec::new());
    for _ in 0..arms {
        let direction = random.direction();
        let mut curve = vec![0];
        for i in 1..=6 {
            curve.push(places.len());
            places.push((direction * (0.25 * f64::from(i)), 0.25));
        }
        curves.push(curve);
        planes.push([DVec3::ZERO, direction]);
    }
    (Figure::new(places, &curves, 1.2, kernel), planes)
}

/// The largest jump of the value and of the slope, relative to them, at some planes.
fn jumps(figure: &Figure, planes: &[[DVec3; 2]]) -> [f64; 2] {
    let mut random = Random::new(74);
    let local = figure.local();
    let (mut largest, mut steepest, mut at_surface) = (0.0f64, 0.0f64, 0.0f64);
    for _ in 0..count(1500).max(300) {
        // On the plane, as far from its middle as flesh is.
        let [middle, normal] = random.pick(planes);
        let aside = normal.cross(random.direction()).normalize() * random.range(0.05, 0.45);
        let sides = [-1e-7, 1e-7].map(|off| local.jet(middle + aside + normal * off));
        let [before, after] = sides.map(|jet| DVec3::from_array(jet.gradient));
        let jump = (sides[0].value - sides[1].value).abs() - 2e-7 * before.length();
        largest = largest.max(jump / sides[0].value);
        let kink = (before - after).length() / before.length();
        steepest = steepest.max(kink);
        if (sides[0].value - 1.0).abs() < 0.3 {
            at_surface = at_surface.max(kink);
        }
    }
    println!(
        "{} segments, {:?}: value {largest:.1e}, slope {steepest:.1e}, at the surface \
         {at_surface:.1e}",
        figure.segments.len(),
        figure.kernel
    );
    [largest, steepest]
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
    let place = |segment, along| Place { segment, along };
    assert!((fold(100.0).distance(place(0, 0.5), place(3, 0.5)) - 3.562).abs() < 1e-3);
}
