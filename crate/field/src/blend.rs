//! Sums of functions: shapes of different kinds that blend.
use crate::implicit::{self, Variation};
use crate::{Ball, Clearance, Enclosure, Implicit, Jet, Sum};
use glam::DVec3;
use std::sync::Arc;
use wide::f32x8;

/// The sum of a convolution surface's field and of other functions: their shapes blend as
/// primitives do.
///
/// Its elements are the sum's primitives, then those of the other functions, one after the other.
///
/// ```
/// use field::{Blend, Exponentials, Implicit, Sum, THRESHOLD};
/// use glam::DVec3;
/// use std::sync::Arc;
///
/// let ball = |x: f64| Exponentials::new(4.0, vec![(DVec3::X * x, 0.5)]);
/// let parts = [-0.6, 0.6].into_iter().filter_map(ball).map(|ball| (Arc::new(ball) as _, 1));
/// let blend = Blend::new(Sum::default(), parts.collect());
/// // Neither ball reaches the middle, both together do.
/// assert!(blend.jet(DVec3::ZERO).value > THRESHOLD);
/// ```
#[derive(Clone, Debug)]
pub struct Blend {
    sum: Sum,
    parts: Vec<Part>,
}

#[derive(Clone, Debug)]
struct Part {
    function: Arc<dyn Implicit>,
    /// Number of its first element.
    first: u32,
}

impl Blend {
    /// The sum of a field and some functions, each given with the number of its elements.
    #[must_use]
    pub fn new(sum: Sum, functions: Vec<(Arc<dyn Implicit>, u32)>) -> Self {
        let mut first = sum.primitives.len() as u32;
        let parts = functions.into_iter().map(|(function, elements)| {
            let part = Part { function, first };
            first += elements;
            part
        });
        Self {
            parts: parts.collect(),
            sum,
        }
    }

    /// Returns the only function, if there is nothing else.
    fn single(&self) -> Option<&dyn Implicit> {
        match &self.parts[..] {
            [part] if self.sum.primitives.is_empty() => Some(&*part.function),
            _ => None,
        }
    }
}

impl Implicit for Blend {
    fn jet(&self, point: DVec3) -> Jet<f64> {
        self.parts.iter().fold(self.sum.jet(point), |jet, part| {
            jet.plus(part.function.jet(point))
        })
    }

    fn jet32(&self, point: [f32; 3]) -> Jet<f32> {
        self.parts.iter().fold(self.sum.jet32(point), |jet, part| {
            jet.plus(part.function.jet32(point))
        })
    }

    fn jet8(&self, points: [f32x8; 3]) -> Jet<f32x8> {
        self.parts.iter().fold(self.sum.jet8(points), |jet, part| {
            jet.plus(part.function.jet8(points))
        })
    }

    fn enclose(&self, ball: Ball) -> Enclosure {
        self.parts.iter().fold(self.sum.enclose(ball), |all, part| {
            all.plus(part.function.enclose(ball))
        })
    }

    fn narrow(
        &self,
        ball: Ball,
        among: Option<&implicit::Part>,
        slack: implicit::Slack,
    ) -> Option<implicit::Part> {
        match self.single() {
            Some(function) => function.narrow(ball, among, slack),
            None => self.sum.narrow(ball, among, slack),
        }
    }

    fn jet_of(&self, part: &implicit::Part, point: DVec3) -> Jet<f64> {
        if let Some(function) = self.single() {
            return function.jet_of(part, point);
        }
        let sum = self.sum.jet_of(part, point);
        let functions = self.parts.iter().map(|part| part.function.jet(point));
        functions.fold(sum, Jet::plus)
    }

    fn jet8_of(&self, part: &implicit::Part, points: [f32x8; 3]) -> Jet<f32x8> {
        if let Some(function) = self.single() {
            return function.jet8_of(part, points);
        }
        let sum = self.sum.jet8_of(part, points);
        let functions = self.parts.iter().map(|part| part.function.jet8(points));
        functions.fold(sum, Jet::plus)
    }

    fn variation(&self, part: Option<&implicit::Part>, ball: Ball) -> Variation {
        if let Some(function) = self.single() {
            return function.variation(part, ball);
        }
        let sum = self.sum.variation(part, ball);
        let functions = self
            .parts
            .iter()
            .map(|part| part.function.variation(None, ball));
        functions.fold(sum, Variation::plus)
    }

    fn least_width(&self, part: Option<&implicit::Part>, ball: Ball, enough: f64) -> Option<f64> {
        if let Some(function) = self.single() {
            return function.least_width(part, ball, enough);
        }
        // Functions that are weak by themselves may matter together.
        let each = enough / (self.parts.len() + 1) as f64;
        let sum = self.sum.least_width(part, ball, each)?;
        self.parts.iter().try_fold(sum, |least, part| {
            Some(least.min(part.function.least_width(None, ball, each)?))
        })
    }

    fn most(&self, ball: Ball) -> f64 {
        // A sum of primitives has no bound that is cheaper than the whole.
        let sum = match self.sum.primitives.len() {
            0 => 0.0,
            _ => self.sum.most(ball),
        };
        let functions = self.parts.iter().map(|part| part.function.most(ball));
        functions.fold(sum, |all, most| all + most)
    }

    fn variation_with_jet(
        &self,
        part: Option<&implicit::Part>,
        ball: Ball,
    ) -> (Variation, Option<Jet<f64>>) {
        match self.single() {
            Some(function) => function.variation_with_jet(part, ball),
            None => (self.variation(part, ball), None),
        }
    }

    fn turn_smoothly(
        &self,
        part: Option<&implicit::Part>,
        ball: Ball,
        step: f64,
    ) -> Option<[DVec3; 3]> {
        self.single()?.turn_smoothly(part, ball, step)
    }

    fn clearance(&self, point: DVec3) -> Option<Clearance> {
        // A function does not know what others add to it.
        self.single()?.clearance(point)
    }

    fn clearance_of(&self, part: &implicit::Part, point: DVec3) -> Option<Clearance> {
        self.single()?.clearance_of(part, point)
    }

    fn shares(&self, point: DVec3, out: &mut Vec<(u32, f64)>) {
        self.sum.shares(point, out);
        for Part { function, first } in &self.parts {
            let own = out.len();
            function.shares(point, out);
            for (element, _) in &mut out[own..] {
                *element += first;
            }
        }
    }

    fn support(&self) -> Option<Ball> {
        self.support_at(crate::THRESHOLD)
    }

    fn support_at(&self, level: f64) -> Option<Ball> {
        if let Some(function) = self.single() {
            return function.support_at(level);
        }
        // Outside all balls no function has more than its share of the level.
        let functions = self.parts.iter().map(|part| &*part.function);
        let sum: Option<&dyn Implicit> = match self.sum.primitives.len() {
            0 => None,
            _ => Some(&self.sum),
        };
        let share = level / (self.parts.len() + 1) as f64;
        let mut balls = functions.chain(sum).map(|f| f.support_at(share));
        let mut all = balls.next().unwrap_or(Some(Ball {
            center: DVec3::ZERO,
            radius: 0.0,
        }))?;
        for ball in balls {
            all = all.around(&ball?);
        }
        Some(all)
    }
}
