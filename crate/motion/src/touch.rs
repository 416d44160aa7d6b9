//! Touching flesh: samples of the surface, what they can meet, and how they are pushed back.

use crate::field::{End, distance};
use crate::obstacle::{Standing, foot};
use crate::setup::{Body, Settings};
use crate::thickness::thickness;
use glam::DVec3;
use skeleton::Polyline;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Levels of subdivision of the curves that touch.
const LEVELS: u32 = 1;
/// Most distance of neighbouring samples, in radii, unless that makes too many of them.
const SPACING: f64 = 1.5;
/// The most samples of a segment, besides its ends.
const MOST_BETWEEN: usize = 3;

/// The share of its radius by which a sample that begins in an obstacle is put out in a step.
const RISE: f64 = 0.005;

/// Mean of some nodes: their numbers and weights, which add up to 1.
type Mean = Vec<(u32, f64)>;

fn at(mean: &Mean, places: &[DVec3]) -> DVec3 {
    mean.iter().fold(DVec3::ZERO, |sum, &(node, weight)| {
        sum + places[node as usize] * weight
    })
}

/// `Σ weight²/mass`: the inverse of the mass that a force on the point meets.
fn inverse_mass(mean: &Mean, inverse: &[f64]) -> f64 {
    mean.iter()
        .map(|&(node, weight)| weight * weight * inverse[node as usize])
        .sum()
}

/// Moves a point's nodes by an impulse.
fn push(mean: &Mean, impulse: DVec3, places: &mut [DVec3], inverse: &[f64]) {
    for &(node, weight) in mean {
        places[node as usize] += impulse * (weight * inverse[node as usize]);
    }
}

/// Point of a curve and the ball of flesh around it.
#[derive(Clone, Debug)]
struct Sample {
    mean: Mean,
    radius: f64,
    /// The segments that it can meet.
    far: Vec<u32>,
    /// Segments of `far` that were near when last looked for.
    near: Vec<u32>,
    /// Depth to which the flesh overlapped at first, which is not pushed out.
    overlap: f64,
}

/// Piece of a curve.
#[derive(Clone, Debug)]
struct Segment {
    ends: [u32; 2],
    radius: f64,
}

/// Sample that met an obstacle in this step.
#[derive(Clone, Copy, Debug)]
struct Hit {
    sample: usize,
    normal: DVec3,
    /// The speed away from the obstacle before.
    speed: f64,
}

/// The flesh of all bodies of a simulation.
#[derive(Clone, Debug)]
pub struct Flesh {
    vertices: Vec<Mean>,
    segments: Vec<Segment>,
    samples: Vec<Sample>,
    /// Places of the vertices in this step, and lengths of the segments.
    now: Vec<DVec3>,
    lengths: Vec<f64>,
    before: Vec<DVec3>,
    /// Places of the nodes when near segments were last looked for.
    looked: Vec<DVec3>,
    /// Distance by which a sample may miss a segment and still be taken for near.
    margin: f64,
    hits: Vec<Hit>,
    sight: Sight,
}

/// Sample as all vertices see it, and the gradients there of the fields of the segments that it can
/// meet.
#[derive(Clone, Debug, Default)]
struct Sight {
    ends: Vec<End>,
    gradients: Vec<DVec3>,
}

impl Flesh {
    /// The flesh of bodies, whose nodes come one body after another.
    pub fn new(bodies: &[Body]) -> Result<Self, skeleton::Error> {
        let mut flesh = Self {
            vertices: Vec::new(),
            segments: Vec::new(),
            samples: Vec::new(),
            now: Vec::new(),
            lengths: Vec::new(),
            before: Vec::new(),
            looked: Vec::new(),
            margin: 0.0,
            hits: Vec::new(),
            sight: Sight::default(),
        };
        let mut first = 0;
        let mut starts = Vec::new();
        let mut lines = Vec::new();
        for body in bodies {
            let polyline = body.skeleton.polyline(body.scheme, LEVELS)?;
            starts.push((flesh.samples.len(), flesh.segments.len()));
            flesh.add(body, &polyline, first)?;
            first += body.skeleton.nodes.len();
            lines.push(polyline);
        }
        starts.push((flesh.samples.len(), flesh.segments.len()));
        let places: Vec<DVec3> = bodies
            .iter()
            .flat_map(|b| b.skeleton.nodes.iter().map(|n| n.position))
            .collect();
        flesh.refresh(&places);
        for (number, polyline) in lines.iter().enumerate() {
            let (samples, segments) = (starts[number], starts[number + 1]);
            flesh.own_folds(
                samples.0..segments.0,
                samples.1..segments.1,
                polyline,
                &places,
            );
        }
        flesh.margin = flesh.samples.iter().map(|s| s.radius).fold(0.0, f64::max);
        flesh.look(&places);
        let mut sight = Sight::default();
        for index in 0..flesh.samples.len() {
            let overlap = flesh
                .depth(index, &places, &mut sight)
                .map_or(0.0, |(depth, _)| depth.max(0.0));
            flesh.samples[index].overlap = overlap;
        }
        Ok(flesh)
    }

    /// Adds the vertices, segments and samples of a body.
    fn add(
        &mut self,
        body: &Body,
        polyline: &Polyline,
        first: usize,
    ) -> Result<(), skeleton::Error> {
        let base = self.vertices.len();
        let weights = body.skeleton.weights(body.scheme, LEVELS)?;
        let means: Vec<Mean> = weights
            .into_iter()
            .map(|own| {
                own.into_iter()
                    .map(|(node, weight)| ((first + node) as u32, weight))
                    .collect()
            })
            .collect();
        let pieces: Vec<_> = polyline
            .segments
            .iter()
            .map(|s| {
                let [a, b] = s.ends.map(|end| &polyline.vertices[end]);
                (a.position, b.position, 0.5 * (a.radius + b.radius))
            })
            .collect();
        for (index, vertex) in polyline.vertices.iter().enumerate() {
            let around = polyline.around(index);
            let Some(&one) = around.first() else {
                continue;
            };
            let (a, b, _) = pieces[one];
            self.samples.push(Sample {
                mean: means[index].clone(),
                radius: thickness(
                    &pieces,
                    vertex.position,
                    b - a,
                    vertex.radius,
                    around.len() == 1,
                ),
                far: Vec::new(),
                near: Vec::new(),
                overlap: 0.0,
            });
        }
        for (segment, &(a, b, radius)) in polyline.segments.iter().zip(&pieces) {
            self.segments.push(Segment {
                ends: segment.ends.map(|end| (base + end) as u32),
                radius,
            });
            let between = if radius > 0.0 {
                ((segment.length / (SPACING * radius)) as usize).min(MOST_BETWEEN)
            } else {
                0
            };
            for i in 1..=between {
                let along = i as f64 / (between + 1) as f64;
                let [first, second] = segment.ends.map(|end| &means[end]);
                let radii = segment.ends.map(|end| polyline.vertices[end].radius);
                let own = radii[0] + (radii[1] - radii[0]) * along;
                self.samples.push(Sample {
                    mean: mix(first, second, along),
                    radius: thickness(&pieces, a.lerp(b, along), b - a, own, false),
                    far: Vec::new(),
                    near: Vec::new(),
                    overlap: 0.0,
                });
            }
        }
        self.vertices.extend(means);
        Ok(())
    }

    /// Finds for each sample of a body the segments it can meet: all of other bodies, and those of
    /// its own that are neither near along the curves nor near in space as they are at first.
    fn own_folds(
        &mut self,
        samples: std::ops::Range<usize>,
        segments: std::ops::Range<usize>,
        polyline: &Polyline,
        places: &[DVec3],
    ) {
        let along: Vec<Vec<f64>> = (0..polyline.vertices.len())
            .map(|vertex| ways(polyline, vertex))
            .collect();
        // Samples at vertices come first, then those within segments.
        let at_vertices: Vec<usize> = (0..polyline.vertices.len())
            .filter(|&v| !polyline.around(v).is_empty())
            .collect();
        let mut hosts: Vec<[(usize, f64); 2]> =
            at_vertices.iter().map(|&v| [(v, 0.0), (v, 0.0)]).collect();
        for segment in &polyline.segments {
            let radius = segment.ends.map(|end| polyline.vertices[end].radius);
            let radius = 0.5 * (radius[0] + radius[1]);
            let between = if radius > 0.0 {
                ((segment.length / (SPACING * radius)) as usize).min(MOST_BETWEEN)
            } else {
                0
            };
            for i in 1..=between {
                let share = i as f64 / (between + 1) as f64;
                hosts.push([
                    (segment.ends[0], segment.length * share),
                    (segment.ends[1], segment.length * (1.0 - share)),
                ]);
            }
        }
        for (index, host) in samples.zip(hosts) {
            let (point, radius) = (
                at(&self.samples[index].mean, places),
                self.samples[index].radius,
            );
            let mut far = Vec::new();
            for number in 0..self.segments.len() {
                if segments.contains(&number) {
                    let own = &polyline.segments[number - segments.start];
                    let reach = radius + self.segments[number].radius;
                    let ways = host.map(|(vertex, start)| {
                        let to = own.ends.map(|end| along[vertex][end]);
                        start + to[0].min(to[1])
                    });
                    let [a, b] = self.ends(number);
                    let apart = point.distance(a.lerp(b, foot(point, a, b)));
                    let is_far = ways[0].min(ways[1]) > 2.0 * reach && apart > 1.05 * reach;
                    if !is_far {
                        continue;
                    }
                }
                far.push(number as u32);
            }
            self.samples[index].far = far;
        }
    }

    fn ends(&self, segment: usize) -> [DVec3; 2] {
        self.segments[segment]
            .ends
            .map(|end| self.now[end as usize])
    }

    /// Takes the vertices to where the nodes are.
    fn refresh(&mut self, places: &[DVec3]) {
        self.now.clear();
        self.now
            .extend(self.vertices.iter().map(|mean| at(mean, places)));
        let now = &self.now;
        self.lengths.clear();
        self.lengths.extend(self.segments.iter().map(|segment| {
            let [a, b] = segment.ends.map(|end| now[end as usize]);
            a.distance(b)
        }));
    }

    /// Looks for the segments near each sample.
    fn look(&mut self, places: &[DVec3]) {
        self.looked.clear();
        self.looked.extend_from_slice(places);
        let (now, segments, margin) = (&self.now, &self.segments, self.margin);
        for sample in &mut self.samples {
            let point = at(&sample.mean, places);
            let (far, radius) = (&sample.far, sample.radius);
            sample.near.clear();
            sample.near.extend(far.iter().copied().filter(|&number| {
                let segment = &segments[number as usize];
                let [a, b] = segment.ends.map(|end| now[end as usize]);
                let reach = radius + segment.radius + 0.5 * a.distance(b) + margin;
                point.distance_squared((a + b) * 0.5) < reach * reach
            }));
        }
    }

    /// Computes the depth of a sample in the flesh of other stretches, and the push out of it,
    /// along the gradient `Σ ∇∫ds/d³`; leaves the gradient of each of `far` in `sight`. The field's
    /// value stands for a distance, from which both radii are taken. `None` if the sample touches
    /// nothing.
    fn depth(&self, index: usize, places: &[DVec3], sight: &mut Sight) -> Option<(f64, Push)> {
        let sample = &self.samples[index];
        if sample.near.is_empty() {
            return None;
        }
        let point = at(&sample.mean, places);
        let touches = sample.near.iter().any(|&number| {
            let [a, b] = self.ends(number as usize);
            let reach = sample.radius + self.segments[number as usize].radius;
            point.distance_squared(a.lerp(b, foot(point, a, b))) < reach * reach
        });
        if !touches {
            return None;
        }
        let Sight { ends, gradients } = sight;
        ends.clear();
        ends.extend(self.now.iter().map(|vertex| End::new(point, *vertex)));
        gradients.clear();
        let (mut value, mut slope, mut radii) = (0.0, DVec3::ZERO, 0.0);
        for &number in &sample.far {
            let segment = &self.segments[number as usize];
            let [a, b] = segment.ends.map(|end| &ends[end as usize]);
            let (own, gradient) = a.line(b, self.lengths[number as usize]);
            value += own;
            slope += gradient;
            radii += segment.radius * segment.radius * own;
            gradients.push(gradient);
        }
        if !(value > 0.0 && value.is_finite() && slope.is_finite()) {
            return None;
        }
        let apart = distance(value);
        let depth = sample.radius + (radii / value).sqrt() - apart;
        // ∇√(2/S) = −½√(2/S)·∇S/S
        let scale = -0.5 * apart / value;
        Some((
            depth,
            Push {
                point,
                scale,
                slope: slope * scale,
            },
        ))
    }

    /// Pushes samples out of the flesh of other stretches: springs of the constant
    /// `stiffness/radius`, with friction.
    pub fn solve_folds(
        &mut self,
        places: &mut [DVec3],
        previous: &[DVec3],
        inverse: &[f64],
        settings: &Settings,
        step: f64,
    ) {
        if settings.stiffness <= 0.0 || self.samples.iter().all(|s| s.far.is_empty()) {
            return;
        }
        self.refresh(places);
        let moved = places.iter().zip(&self.looked);
        let moved = moved
            .map(|(a, b)| a.distance_squared(*b))
            .fold(0.0, f64::max);
        let is_near = 4.0 * moved <= self.margin * self.margin;
        // Also where a place is no number.
        if !is_near {
            self.look(places);
        }
        self.before.clear();
        let vertices = &self.vertices;
        self.before
            .extend(vertices.iter().map(|mean| at(mean, previous)));
        let mut sight = core::mem::take(&mut self.sight);
        for index in 0..self.samples.len() {
            let Some((depth, push_by)) = self.depth(index, places, &mut sight) else {
                continue;
            };
            let sample = &self.samples[index];
            let depth = depth - sample.overlap;
            if depth <= 0.0 {
                continue;
            }
            // The share of each segment in the push, on the point of it that is nearest; the push
            // is their sum, so that it equals the push back.
            let mut shares: Vec<(usize, f64, DVec3)> = Vec::with_capacity(sample.far.len());
            let mut normal = DVec3::ZERO;
            let mut weight = 0.0;
            let least = 1e-6 * push_by.slope.length_squared();
            for (&number, gradient) in sample.far.iter().zip(&sight.gradients) {
                let own = *gradient * push_by.scale;
                if own.length_squared() < least {
                    continue;
                }
                normal += own;
                let [a, b] = self.ends(number as usize);
                let along = foot(push_by.point, a, b);
                let [first, second] = self.segments[number as usize]
                    .ends
                    .map(|end| inverse_mass(&self.vertices[end as usize], inverse));
                weight += own.length_squared()
                    * ((1.0 - along) * (1.0 - along) * first + along * along * second);
                shares.push((number as usize, along, own));
            }
            weight += inverse_mass(&sample.mean, inverse) * normal.length_squared();
            let give = sample.radius / settings.stiffness;
            let hold = weight + give / (step * step);
            if hold <= 0.0 || hold.is_nan() {
                continue;
            }
            let mut impulse = depth / hold;
            // No farther than is deep: springs that pull on light ends of heavy limbs would throw
            // them.
            let own = inverse_mass(&sample.mean, inverse) * normal.length();
            if impulse * own > depth {
                impulse = depth / own;
            }
            let rub = self.friction(
                index, &push_by, &shares, previous, settings, impulse, inverse,
            );
            let sample = &self.samples[index];
            push(&sample.mean, normal * impulse + rub, places, inverse);
            let length = normal.length();
            for (number, along, own) in shares {
                let share = own.dot(normal) / (length * length);
                let back = -own * impulse - rub * share;
                let [first, second] = self.segments[number].ends;
                push(
                    &self.vertices[first as usize],
                    back * (1.0 - along),
                    places,
                    inverse,
                );
                push(
                    &self.vertices[second as usize],
                    back * along,
                    places,
                    inverse,
                );
            }
        }
        self.sight = sight;
    }

    /// The impulse against sliding: at most friction times the push, and no more than stops it.
    #[expect(clippy::too_many_arguments, reason = "a step's data")]
    fn friction(
        &self,
        index: usize,
        push_by: &Push,
        shares: &[(usize, f64, DVec3)],
        previous: &[DVec3],
        settings: &Settings,
        impulse: f64,
        inverse: &[f64],
    ) -> DVec3 {
        let sample = &self.samples[index];
        let Some(normal) = push_by.slope.try_normalize() else {
            return DVec3::ZERO;
        };
        let own = push_by.point - at(&sample.mean, previous);
        let strongest = shares
            .iter()
            .max_by(|a, b| a.2.length_squared().total_cmp(&b.2.length_squared()));
        let Some(&(number, along, _)) = strongest else {
            return DVec3::ZERO;
        };
        let [a, b] = self.segments[number]
            .ends
            .map(|end| self.now[end as usize] - self.before[end as usize]);
        let slide = own - a.lerp(b, along);
        let slide = slide - normal * slide.dot(normal);
        let [first, second] = self.segments[number]
            .ends
            .map(|end| inverse_mass(&self.vertices[end as usize], inverse));
        let weight = inverse_mass(&sample.mean, inverse)
            + (1.0 - along) * (1.0 - along) * first
            + along * along * second;
        resistance(
            slide,
            weight,
            settings.friction * impulse * push_by.slope.length(),
        )
    }

    /// Takes samples out of obstacles, with friction, and notes which were in one.
    pub fn solve_obstacles(
        &mut self,
        places: &mut [DVec3],
        previous: &mut [DVec3],
        velocities: &[DVec3],
        inverse: &[f64],
        obstacles: &[Standing],
        friction: f64,
    ) {
        self.hits.clear();
        for (index, sample) in self.samples.iter().enumerate() {
            let weight = inverse_mass(&sample.mean, inverse);
            if weight <= 0.0 {
                continue;
            }
            let mut point = at(&sample.mean, places);
            for standing in obstacles {
                if standing.is_clear_of(point, sample.radius) {
                    continue;
                }
                let obstacle = &standing.obstacle;
                let (apart, normal) = obstacle.distance(point);
                let depth = sample.radius - apart;
                if depth <= 0.0 || depth.is_nan() {
                    continue;
                }
                self.hits.push(Hit {
                    sample: index,
                    normal,
                    speed: at(&sample.mean, velocities).dot(normal),
                });
                // A sample that was too deep before is put out bit by bit, and without a speed, as
                // if it had been out.
                let before = at(&sample.mean, previous);
                let sunk = (sample.radius - obstacle.distance(before).0).clamp(0.0, depth);
                let out = sunk.min(RISE * sample.radius);
                push(&sample.mean, normal * (out / weight), previous, inverse);
                let depth = depth - sunk + out;
                let slide = point - before;
                let slide = slide - normal * slide.dot(normal);
                let impulse = depth / weight;
                let rub = resistance(slide, weight, friction * impulse);
                push(&sample.mean, normal * impulse + rub, places, inverse);
                point = at(&sample.mean, places);
            }
        }
    }

    /// Gives samples that met an obstacle the speed away from it that they are left with, which
    /// does not include that of being pushed out.
    pub fn rebound(&self, velocities: &mut [DVec3], inverse: &[f64], bounce: f64, least: f64) {
        for hit in &self.hits {
            let mean = &self.samples[hit.sample].mean;
            let speed = at(mean, velocities).dot(hit.normal);
            let left = if hit.speed < -least {
                -hit.speed * bounce
            } else {
                // A sample that leaves by itself goes on.
                hit.speed.max(0.0)
            };
            if speed > left || (speed < left && bounce > 0.0 && hit.speed < -least) {
                let weight = inverse_mass(mean, inverse);
                push(
                    mean,
                    hit.normal * ((left - speed) / weight),
                    velocities,
                    inverse,
                );
            }
        }
    }

    /// The thinnest flesh that there is anywhere, if any.
    pub fn thinnest(&self) -> Option<f64> {
        let radii = self.samples.iter().map(|s| s.radius).filter(|r| *r > 0.0);
        radii.min_by(f64::total_cmp)
    }

    /// The energy of the flesh that is pressed in.
    pub fn energy(&mut self, places: &[DVec3], stiffness: f64) -> f64 {
        if stiffness <= 0.0 {
            return 0.0;
        }
        self.refresh(places);
        self.look(places);
        let mut energy = 0.0;
        let mut sight = Sight::default();
        for index in 0..self.samples.len() {
            if let Some((depth, _)) = self.depth(index, places, &mut sight) {
                let sample = &self.samples[index];
                let depth = (depth - sample.overlap).max(0.0);
                if sample.radius > 0.0 {
                    energy += 0.5 * depth * depth * stiffness / sample.radius;
                }
            }
        }
        energy
    }

    /// Returns the largest depth of the flesh in an obstacle; negative if it touches none.
    pub fn deepest(&self, places: &[DVec3], obstacles: &[Standing]) -> f64 {
        self.samples
            .iter()
            .map(|sample| {
                let point = at(&sample.mean, places);
                let apart = obstacles.iter().map(|o| o.obstacle.distance(point).0);
                sample.radius - apart.fold(f64::INFINITY, f64::min)
            })
            .fold(f64::NEG_INFINITY, f64::max)
    }

    /// Operations of a step, roughly.
    pub fn work(&self, obstacles: usize) -> u64 {
        self.samples
            .iter()
            .map(|s| (4 * (1 + obstacles) + s.far.len()) as u64)
            .sum()
    }
}

/// Push on a sample.
struct Push {
    point: DVec3,
    /// Factor from the field's gradient to that of the distance.
    scale: f64,
    /// The gradient of the distance.
    slope: DVec3,
}

/// The impulse that stops a slide, cut off where friction ends.
fn resistance(slide: DVec3, weight: f64, most: f64) -> DVec3 {
    let length = slide.length();
    if !(length > 0.0 && weight > 0.0) {
        return DVec3::ZERO;
    }
    slide * (-(length / weight).min(most) / length)
}

/// Returns the mean for a point on the way from one to another.
fn mix(a: &Mean, b: &Mean, along: f64) -> Mean {
    let mut mixed: Mean = a.iter().map(|&(n, w)| (n, w * (1.0 - along))).collect();
    for &(node, weight) in b {
        match mixed.iter_mut().find(|(own, _)| *own == node) {
            Some((_, own)) => *own += weight * along,
            None => mixed.push((node, weight * along)),
        }
    }
    mixed
}

/// Shortest ways along the curves from a vertex to all.
fn ways(polyline: &Polyline, from: usize) -> Vec<f64> {
    let mut ways = vec![f64::INFINITY; polyline.vertices.len()];
    ways[from] = 0.0;
    // Lengths are not negative, so their bits are in their order.
    let mut open = BinaryHeap::from([Reverse((0u64, from))]);
    while let Some(Reverse((bits, vertex))) = open.pop() {
        let way = f64::from_bits(bits);
        if way > ways[vertex] {
            continue;
        }
        for &number in polyline.around(vertex) {
            let segment = &polyline.segments[number];
            let other = segment.ends[usize::from(segment.ends[0] == vertex)];
            let next = way + segment.length;
            if next < ways[other] {
                ways[other] = next;
                open.push(Reverse((next.to_bits(), other)));
            }
        }
    }
    ways
}
