//! The field along one ray.
use field::{AlongRay, Bound, Primitive, THRESHOLD};
use tracer::Ray;

/// End of rays along infinitely wide primitives, in units of the scene's size.
const FAR: f64 = 1e4;

/// Primitive that a ray meets.
pub(crate) struct Term<'a> {
    pub primitive: &'a Primitive,
    pub bound: &'a Bound,
    /// Parameters between which the ray is within the primitive's depth of influence; elsewhere the
    /// primitive's field is taken to be 0.
    pub interval: [f64; 2],
    along: AlongRay<'a, f64>,
}

impl Term<'_> {
    /// Whether the ray is within the depth of influence somewhere between two parameters.
    pub fn meets(&self, from: f64, to: f64) -> bool {
        self.interval[0] <= to && from <= self.interval[1]
    }
}

/// The primitives that one ray can meet.
pub(crate) struct Sight<'a> {
    ray: Ray,
    pub terms: Vec<Term<'a>>,
    /// The part of the ray, between 0 and its limit, in which some primitive counts.
    pub range: [f64; 2],
    /// Evaluations of one primitive's field at one point, so far.
    pub evaluations: u64,
}

impl<'a> Sight<'a> {
    /// Collects the primitives that a ray meets, of those that it may meet; `None` if there are
    /// none.
    pub fn new(candidates: &[(&'a Primitive, &'a Bound)], ray: &Ray, limit: f64) -> Option<Self> {
        let mut terms = Vec::new();
        let mut range = [f64::INFINITY, 0.0_f64];
        for &(primitive, bound) in candidates {
            let interval = primitive.ray_interval(ray.origin, ray.direction);
            let Some(interval) = interval.map(|ends| ends.map(|t| t.clamp(-FAR, FAR))) else {
                continue;
            };
            let [near, far] = interval;
            if far <= 0.0 || near >= limit || near >= far {
                continue;
            }
            range = [range[0].min(near.max(0.0)), range[1].max(far.min(limit))];
            terms.push(Term {
                primitive,
                bound,
                interval,
                along: primitive.on_ray(ray.origin, ray.direction),
            });
        }
        (range[0] < range[1]).then_some(Self {
            ray: *ray,
            terms,
            range,
            evaluations: 0,
        })
    }

    /// Returns F − T and its slope along the ray.
    pub fn excess(&mut self, t: f64) -> (f64, f64) {
        let mut sum = (-THRESHOLD, 0.0);
        for term in &self.terms {
            if term.meets(t, t) {
                let (value, slope) = term.along.at(t);
                sum = (sum.0 + value, sum.1 + slope);
                self.evaluations += 1;
            }
        }
        sum
    }

    /// Returns one primitive's value and slope along the ray, wherever it is.
    pub fn one(&mut self, term: usize, t: f64) -> (f64, f64) {
        self.evaluations += 1;
        self.terms[term].along.at(t)
    }

    /// Returns F − T and its slope along the ray, of some primitives, wherever they are.
    pub fn excess_of(&mut self, terms: &[u32], t: f64) -> (f64, f64) {
        let mut sum = (-THRESHOLD, 0.0);
        for &term in terms {
            let (value, slope) = self.one(term as usize, t);
            sum = (sum.0 + value, sum.1 + slope);
        }
        sum
    }

    /// Returns Kalra and Barr's L of some primitives between two parameters, and if `turns`, their
    /// G: bounds on the rates of change of the field and of its slope along the ray.
    pub fn lipschitz(&self, terms: &[u32], [from, to]: [f64; 2], turns: bool) -> (f64, f64) {
        let center = self.ray.at(0.5 * (from + to));
        let radius = 0.5 * (to - from) * (1.0 + 1e-9);
        let mut sum = (0.0, 0.0);
        for &term in terms {
            let bound = self.terms[term as usize].bound;
            let near = bound.nearness(center, radius);
            sum.0 += bound.slope(near);
            if turns {
                sum.1 += bound.curvature(near);
            }
        }
        sum
    }

    /// Returns the shortest length on which any of the kernels changes: 1/s, the inverse of its
    /// width parameter.
    pub fn finest(&self) -> f64 {
        let widths = self.terms.iter().map(|term| term.primitive.width);
        1.0 / widths.fold(f64::MIN_POSITIVE, f64::max)
    }
}
