//! Local convolution of the reference, by its definition: windows by Simpson's rule between their
//! kinks, distances by Floyd and Warshall's method, all pairs of pieces, bounds by interval
//! arithmetic. It shares nothing with [`field::Local`] but the pieces.
use super::pieces::Pieces;
use super::range::{Deformation, Range};
use super::terms::{Evaluation, FIELD_ERROR};
use field::Primitive;
use field::local::{Limb, LocalError};
use glam::DVec3;

/// A skeleton that is convolved locally, whose folds may touch.
#[derive(Clone, Debug)]
pub(super) struct SkeletonTerms {
    pieces: Vec<Part>,
    fold: Option<Deformation>,
}

/// A piece of a limb.
#[derive(Clone, Debug)]
struct Part {
    length: f64,
    radius: f64,
    primitives: Vec<Primitive>,
    bounds: Pieces,
    /// Weights of all pieces in the stretch around this one.
    weights: Vec<f64>,
    /// Weights of the stretches around all pieces as other folds here.
    apart: Vec<f64>,
}

/// Values of pieces, or of stretches.
#[derive(Clone, Copy, Debug)]
struct Field {
    value: f64,
    gradient: DVec3,
}

impl Part {
    /// Returns the base of the weight of a value of the field.
    fn density(&self, field: f64) -> f64 {
        field * self.radius / self.length
    }

    /// Returns the field at a point.
    fn sum(&self, point: DVec3) -> Field {
        let jets = self.primitives.iter().map(|p| p.jet(point.to_array()));
        jets.fold(NOTHING, |sum, jet| Field {
            value: sum.value + jet.value,
            gradient: sum.gradient + DVec3::from_array(jet.gradient),
        })
    }
}

/// Share of the largest weight below which a weight is not looked at.
const SMALLEST: f64 = 1e-18;

/// Returns `3t² − 2t³` of t cut to [0, 1].
fn step(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Returns the mean of the window over a piece of a length, its distance at a place x given.
fn mean(distance: impl Fn(f64) -> f64, reach: f64, length: f64) -> f64 {
    // Kinks: where two ways to the piece meet, and where the distance is 2/3 D or D; a piece around
    // the window's middle has another one there.
    let (start, end) = (distance(0.0), distance(length));
    let mut kinks = vec![0.0, length, 0.5 * (end - start + length), start.min(length)];
    for level in [2.0 / 3.0 * reach, reach] {
        kinks.extend([
            level - start,
            start - level,
            start + level,
            length + end - level,
        ]);
    }
    kinks.retain(|x| (0.0..=length).contains(x));
    kinks.sort_unstable_by(f64::total_cmp);
    let parts = kinks.windows(2).map(|pair| {
        let [a, b] = [pair[0], pair[1]];
        let [start, middle, end] =
            [a, 0.5 * (a + b), b].map(|x| step(3.0 * (1.0 - distance(x) / reach)));
        (b - a) / 6.0 * (start + 4.0 * middle + end)
    });
    parts.sum::<f64>() / length
}

impl SkeletonTerms {
    /// Prepares a skeleton.
    pub fn new(
        points: &[DVec3],
        limbs: &[Limb],
        reach: f64,
        fold: Option<Deformation>,
    ) -> Result<Self, LocalError> {
        let n = points.len();
        let mut between = vec![vec![f64::INFINITY; n]; n];
        // Limbs of pieces, and where each begins and ends.
        let mut places: Vec<(usize, f64, f64)> = Vec::new();
        let mut lengths = Vec::new();
        for (number, limb) in limbs.iter().enumerate() {
            let mut from = 0.0;
            for piece in &limb.pieces {
                places.push((number, from, from + piece.length));
                from += piece.length;
            }
            let [a, b] = limb.ends.map(|end| end as usize);
            if a.max(b) >= n || from.is_nan() || from <= 0.0 {
                return Err(LocalError::Unusable);
            }
            lengths.push(from);
            between[a][b] = between[a][b].min(from);
            between[b][a] = between[a][b];
        }
        for (i, row) in between.iter_mut().enumerate() {
            row[i] = 0.0;
        }
        for k in 0..n {
            for i in 0..n {
                for j in 0..n {
                    between[i][j] = between[i][j].min(between[i][k] + between[k][j]);
                }
            }
        }
        let distance = |(a, along): (usize, f64), (b, beside): (usize, f64)| {
            let mut least = match a == b {
                true => (along - beside).abs(),
                false => f64::INFINITY,
            };
            for (end, here) in limbs[a].ends.iter().zip([along, lengths[a] - along]) {
                for (start, there) in limbs[b].ends.iter().zip([beside, lengths[b] - beside]) {
                    least = least.min(here + between[*end as usize][*start as usize] + there);
                }
            }
            least
        };
        let pieces = limbs.iter().flat_map(|limb| &limb.pieces);
        let pieces = pieces.zip(&places).map(|(own, place)| {
            let middle = (place.0, 0.5 * (place.1 + place.2));
            let weights = places.iter().map(|other| {
                let length = other.2 - other.1;
                mean(|x| distance(middle, (other.0, other.1 + x)), reach, length)
            });
            let apart = places.iter().map(|other| {
                let far = distance(middle, (other.0, 0.5 * (other.1 + other.2)));
                step(far / reach - 2.0)
            });
            Part {
                length: own.length,
                radius: own.radius,
                weights: weights.collect(),
                apart: apart.collect(),
                bounds: Pieces::new(&own.primitives),
                primitives: own.primitives.clone(),
            }
        });
        Ok(Self {
            pieces: pieces.collect(),
            fold,
        })
    }

    /// Evaluates the field at a point.
    pub fn sample(&self, point: DVec3) -> Evaluation {
        let fields: Vec<Field> = self.pieces.iter().map(|piece| piece.sum(point)).collect();
        let densities = self.pieces.iter().zip(&fields);
        let densest = densities.map(|(piece, field)| piece.density(field.value));
        let densest = densest.fold(f64::MIN_POSITIVE, f64::max);
        let weights = self.pieces.iter().zip(&fields).map(|(piece, field)| {
            let density = piece.density(field.value) / densest;
            let slope = 8.0 * density.powi(7) * piece.radius * field.gradient / densest;
            Field {
                value: piece.length * density.powi(8),
                gradient: slope,
            }
        });
        let weights: Vec<Field> = weights.collect();
        let stretches = self.pieces.iter().map(|piece| {
            let parts = piece.weights.iter().zip(&fields);
            parts.fold(NOTHING, |sum, (weight, field)| Field {
                value: sum.value + weight * field.value,
                gradient: sum.gradient + *weight * field.gradient,
            })
        });
        let stretches: Vec<Field> = stretches.collect();
        let first = average(weights.iter().copied().zip(stretches.iter().copied()));
        let (mut value, mut gradient) = (first.value, first.gradient);
        if let Some(fold) = &self.fold {
            let largest = weights
                .iter()
                .map(|weight| weight.value)
                .fold(0.0, f64::max);
            let seconds = weights.iter().zip(&self.pieces).map(|(weight, piece)| {
                if weight.value < SMALLEST * largest {
                    return (*weight, NOTHING);
                }
                let all = piece.apart.iter().zip(&weights).zip(&stretches);
                let parted = all.map(|((apart, weight), stretch)| {
                    [weight, stretch].map(|field| Field {
                        value: apart * field.value,
                        gradient: *apart * field.gradient,
                    })
                });
                // Weights far from the largest would be lost in the sum of their squares.
                let parted: Vec<_> = parted.collect();
                let most = parted.iter().map(|[w, _]| w.value).fold(0.0, f64::max);
                let scale = if most > 0.0 { most.recip() } else { 0.0 };
                let second = average(parted.iter().map(|[weight, stretch]| {
                    let weight = Field {
                        value: scale * weight.value,
                        gradient: scale * weight.gradient,
                    };
                    (weight, *stretch)
                }));
                let t = (2.0 * second.value / fold.start - 1.0).clamp(0.0, 1.0);
                let slope = step(t) + second.value * 6.0 * t * (1.0 - t) * 2.0 / fold.start;
                let ramped = Field {
                    value: second.value * step(t),
                    gradient: slope * second.gradient,
                };
                (*weight, ramped)
            });
            let seconds: Vec<_> = seconds.collect();
            let mut second = average(seconds.into_iter());
            let mut first = first;
            let middle = 0.5 * (fold.start + 1.0);
            let t = ((second.value - fold.start) / (middle - fold.start)).clamp(0.0, 1.0);
            let larger = second.value * step(t);
            if first.value < second.value {
                let slope = step(t) + second.value * 6.0 * t * (1.0 - t) / (middle - fold.start);
                let ramped = slope * second.gradient;
                second = first;
                if first.value < larger {
                    first = Field {
                        value: larger,
                        gradient: ramped,
                    };
                    (value, gradient) = (first.value, first.gradient);
                }
            }
            if second.value >= fold.start {
                value += fold.value(second.value);
                gradient += fold.slope(second.value) * second.gradient;
                if second.value > 1.0 && value < 0.5 * (first.value + 1.0) {
                    value = 0.5 * (first.value + 1.0);
                    gradient = 0.5 * first.gradient;
                }
            }
        }
        Evaluation {
            excess: value - 1.0,
            gradient,
            noise: FIELD_ERROR * (1.0 + value.abs()),
            slope_noise: f64::INFINITY,
        }
    }

    /// Returns the least and the largest value in a ball.
    pub fn range(&mut self, center: DVec3, radius: f64) -> Range {
        let extents = self.pieces.iter_mut().map(|piece| {
            let here = piece.sum(center);
            let steep = here.gradient.length();
            let extent = piece.bounds.extent(&piece.primitives, center, radius, None);
            let change = (steep + 0.5 * extent.curvature * radius) * radius;
            let change = change.min(extent.slope * radius) + 1e-12 * here.value;
            Range {
                low: (here.value - change).max(0.0),
                high: (here.value + change).min(extent.above),
            }
        });
        let fields: Vec<Range> = extents.collect();
        let densities = self.pieces.iter().zip(&fields);
        let densest = densities.map(|(piece, range)| piece.density(range.high));
        let densest = densest.fold(f64::MIN_POSITIVE, f64::max);
        let weights = self.pieces.iter().zip(&fields).map(|(piece, range)| {
            let [low, high] = [range.low, range.high]
                .map(|field| piece.length * (piece.density(field) / densest).powi(8));
            Range { low, high }
        });
        let weights: Vec<Range> = weights.collect();
        let stretches = self.pieces.iter().map(|piece| {
            let mut sum = Range {
                low: 0.0,
                high: 0.0,
            };
            for (weight, range) in piece.weights.iter().zip(&fields) {
                sum.low += weight * range.low;
                sum.high += weight * range.high;
            }
            sum
        });
        let stretches: Vec<Range> = stretches.collect();
        let pairs = weights.iter().copied().zip(stretches.iter().copied());
        let first = slacken(spread(pairs.collect()));
        let Some(fold) = &self.fold else {
            return first;
        };
        let floor = weights.iter().map(|weight| weight.low).fold(0.0, f64::max) * SMALLEST;
        let seconds = weights.iter().zip(&self.pieces);
        let seconds = seconds.filter(|(weight, _)| weight.high > floor);
        let seconds = seconds.map(|(weight, piece)| {
            let all = piece.apart.iter().zip(&weights).zip(&stretches);
            let parted = all.filter(|((apart, _), _)| **apart > 0.0);
            let parted = parted.map(|((apart, weight), stretch)| {
                let [weight, stretch] = [weight, stretch].map(|range| Range {
                    low: apart * range.low,
                    high: apart * range.high,
                });
                (weight, stretch)
            });
            let far = spread(parted.collect());
            // The ramp rises.
            let [low, high] = [far.low, far.high].map(|x| x * step(2.0 * x / fold.start - 1.0));
            (*weight, Range { low, high })
        });
        let second = slacken(spread(seconds.collect()));
        // The ramp rises.
        let [low, high] = [second.low, second.high].map(|x| {
            let t = 2.0 * (x - fold.start) / (1.0 - fold.start);
            x * step(t)
        });
        let (own, first) = (first, first.or(Range { low, high }));
        let second = Range {
            low: second.low.min(own.low),
            high: second.high.min(own.high),
        };
        let pressed = fold.range(Range {
            low: second.low,
            high: second.high.min(1.0),
        });
        let below = pressed.low.min(0.0);
        Range {
            low: if first.low > 1.0 {
                0.5 * (first.low + 1.0) + below
            } else {
                first.low + below
            },
            high: first.high + pressed.high.max(0.0),
        }
    }
}

const NOTHING: Field = Field {
    value: 0.0,
    gradient: DVec3::ZERO,
};

/// Returns a range with room for rounding.
fn slacken(range: Range) -> Range {
    let slack = FIELD_ERROR * (1.0 + range.high);
    Range {
        low: range.low - slack,
        high: range.high + slack,
    }
}

/// Returns the mean of some functions by weights; 0 if all weights are.
fn average(all: impl Iterator<Item = (Field, Field)>) -> Field {
    let (mut sum, mut total) = (NOTHING, NOTHING);
    for (weight, field) in all {
        sum.value += weight.value * field.value;
        sum.gradient += weight.value * field.gradient + field.value * weight.gradient;
        total.value += weight.value;
        total.gradient += weight.gradient;
    }
    if total.value <= 0.0 {
        return NOTHING;
    }
    let value = sum.value / total.value;
    Field {
        value,
        gradient: (sum.gradient - value * total.gradient) / total.value,
    }
}

/// Returns the range of the mean of values by weights, both in ranges: it is largest where the
/// weights of all values above some level are as large as can be, and those of the others as small.
fn spread(mut all: Vec<(Range, Range)>) -> Range {
    let high = largest_mean(&mut all, |range| range.high);
    let low = -largest_mean(&mut all, |range| -range.low);
    Range {
        low: low.min(high),
        high,
    }
}

/// Returns the largest mean of ends of ranges by weights.
fn largest_mean(all: &mut [(Range, Range)], end: fn(&Range) -> f64) -> f64 {
    all.sort_unstable_by(|a, b| end(&b.1).total_cmp(&end(&a.1)));
    let mut sum: f64 = all.iter().map(|(w, v)| w.low * end(v)).sum();
    let mut total: f64 = all.iter().map(|(w, _)| w.low).sum();
    let mut most = f64::NEG_INFINITY;
    for (weight, value) in all {
        sum += (weight.high - weight.low) * end(value);
        total += weight.high - weight.low;
        if total > 0.0 {
            most = most.max(sum / total);
        }
    }
    if most.is_finite() { most } else { 0.0 }
}
