//! Bodies that touch, as one function: the largest of the bodies' own, each as the others press it.
use super::range::{Deformation, Range};
use super::skeleton::SkeletonTerms;
use super::terms::{Evaluation, FieldTerms};
use field::Primitive;
use field::local::{Limb, LocalError};
use glam::DVec3;

/// The substance of a body.
#[derive(Clone, Debug)]
pub enum Substance {
    /// The sum of primitives.
    Sum(Vec<Primitive>),
    /// A skeleton that is convolved locally.
    Skeleton {
        /// Points of the skeleton.
        points: Vec<DVec3>,
        /// Segments between the points.
        limbs: Vec<Limb>,
        /// The reach D.
        reach: f64,
        /// Deformation by which the folds press each other, if they do.
        fold: Option<Deformation>,
    },
}

/// A body that touches others.
#[derive(Clone, Debug)]
pub struct TouchingBody {
    /// Substance of the body.
    pub substance: Substance,
    /// Numbers of the bodies that press it, and the deformations.
    pub partners: Vec<(usize, Deformation)>,
}

#[derive(Clone, Debug)]
enum Terms {
    Sum(FieldTerms),
    Skeleton(Box<SkeletonTerms>),
}

/// The largest of the functions of some bodies.
#[derive(Clone, Debug)]
pub(super) struct Touching {
    bodies: Vec<(Terms, Vec<(usize, Deformation)>)>,
}

impl Touching {
    pub fn new(bodies: Vec<TouchingBody>) -> Result<Self, LocalError> {
        let made = bodies.into_iter().map(|body| {
            let terms = match body.substance {
                Substance::Sum(primitives) => Terms::Sum(FieldTerms::new(primitives)),
                Substance::Skeleton {
                    points,
                    limbs,
                    reach,
                    fold,
                } => {
                    let terms = SkeletonTerms::new(&points, &limbs, reach, fold)?;
                    Terms::Skeleton(Box::new(terms))
                }
            };
            Ok((terms, body.partners))
        });
        Ok(Self {
            bodies: made.collect::<Result<_, _>>()?,
        })
    }

    pub fn sample(&self, point: DVec3) -> Evaluation {
        let alone: Vec<Evaluation> = (self.bodies.iter())
            .map(|(terms, _)| match terms {
                Terms::Sum(terms) => terms.sample(point),
                Terms::Skeleton(terms) => terms.sample(point),
            })
            .collect();
        let pressed = self.bodies.iter().zip(&alone).map(|((_, partners), own)| {
            let values = partners
                .iter()
                .map(|(j, by)| (alone[*j].excess + 1.0, *j, by));
            let Some((f, j, by)) = values.max_by(|a, b| a.0.total_cmp(&b.0)) else {
                return *own;
            };
            let other = &alone[j];
            let slope = by.slope(f);
            Evaluation {
                excess: own.excess + by.value(f),
                gradient: own.gradient + slope * other.gradient,
                noise: own.noise + (1.0 + slope.abs()) * other.noise,
                slope_noise: f64::INFINITY,
            }
        });
        let largest = pressed.max_by(|a, b| a.excess.total_cmp(&b.excess));
        largest.unwrap_or(Evaluation {
            excess: -1.0,
            gradient: DVec3::ZERO,
            noise: 0.0,
            slope_noise: 0.0,
        })
    }

    /// Returns the least and the largest value in a ball.
    pub fn range(&mut self, center: DVec3, radius: f64) -> Range {
        let alone: Vec<Range> = (self.bodies.iter_mut())
            .map(|(terms, _)| match terms {
                Terms::Skeleton(terms) => terms.range(center, radius),
                Terms::Sum(terms) => {
                    let here = terms.sample(center);
                    let extent = terms.extent(center, radius, None);
                    let steep = here.gradient.length() + here.slope_noise;
                    let change = (steep + 0.5 * extent.curvature * radius) * radius;
                    let change = change.min(extent.slope * radius) + here.noise;
                    let value = here.excess + 1.0;
                    Range {
                        low: (value - change).max(-extent.below),
                        high: (value + change).min(extent.above + here.noise),
                    }
                }
            })
            .collect();
        let mut all = Range {
            low: f64::NEG_INFINITY,
            high: f64::NEG_INFINITY,
        };
        for ((_, partners), own) in self.bodies.iter().zip(&alone) {
            let floor = partners.iter().map(|(j, _)| alone[*j].low);
            let floor = floor.fold(f64::NEG_INFINITY, f64::max);
            let mut pressed: Option<Range> = None;
            for (j, by) in partners.iter().filter(|(j, _)| alone[*j].high >= floor) {
                let part = by.range(Range {
                    low: floor,
                    high: alone[*j].high,
                });
                pressed = Some(pressed.map_or(part, |all| Range {
                    low: all.low.min(part.low),
                    high: all.high.max(part.high),
                }));
            }
            let by = pressed.unwrap_or(Range {
                low: 0.0,
                high: 0.0,
            });
            all = all.or(Range {
                low: own.low + by.low,
                high: own.high + by.high,
            });
        }
        all
    }
}
