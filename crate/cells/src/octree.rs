//! The octree of a body: cells that the surface does not pass are known to be inside or outside,
//! others have a cubic that stands for the function there.
//!
//! A cell is settled if bounds on the function, or its samples where they vary smoothly, leave the
//! threshold out. Else it is halved until a cubic follows the function so closely that normals are
//! off by less than a degree, or until it is smaller than a pixel of a usual picture. There, or
//! somewhat before if they are few, the terms that matter are listed, if their formulas are on the
//! card: then the cubic stands for what is far only.

use crate::counted::Counted;
use crate::cubic::{Cubic, SAMPLES, places};
use field::{Ball, Implicit, Part, Slack, THRESHOLD};
use glam::DVec3;
use std::collections::VecDeque;
use std::sync::Arc;
use wide::f32x8;

/// Error that a body's function bears in a cell, in units of its threshold.
const SLACK: Slack = Slack {
    left_out: 2e-5,
    far: 2e-4,
};
/// Most error of a cubic over its spread: normals are off by some three to nine times as much.
const CLOSE: f64 = 0.01;
/// Most distance by which a cubic may miss the surface, over 1 plus the distance from the scene's
/// middle, in draft units.
const OFF: f64 = 1e-4;
/// Most error of a cubic over its spread with which its range settles a cell.
const SMOOTH: f64 = 0.1;
/// Bound on the change that a cell's linear part leaves out, in units of the threshold, from which
/// on samples would not tell how the function goes.
const LIVELY: f64 = 16.0;
/// Half of the side of the smallest cell, over 1 plus its distance from the scene's middle, in
/// draft units.
const FINEST: f64 = 0.003;
/// Half of the side of the largest cell that lists terms, as [`FINEST`].
const LISTED: f64 = 4.0 * FINEST;
/// Most terms of a cell that are listed before it is as small as may be.
const SHORT: usize = 20;
/// Most share of leaves that are drawn by cubics which are not close, in a tree that is.
const CRUDE: f64 = 0.02;
/// Most and fewest cells that are looked at together.
const BATCH: u64 = 1024;
const FEWEST: u64 = 64;
/// Evaluations of a look at a cell, about.
const LOOK: u64 = 12;
/// Fewest cells that are worth a thread.
#[cfg(not(target_arch = "wasm32"))]
const FEW: usize = 64;
/// Value that samples are cut off at.
const HIGH: f32 = 1e6;
/// Half of the side of the octree of a body that has no end.
pub(crate) const ENDLESS: f64 = 8.0;

/// Knowledge of a cell.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Cell {
    /// The first of eight cells.
    Parted(u32),
    /// The function is below the threshold.
    Outside,
    /// The function is above the threshold.
    Inside,
    /// Number of a leaf.
    Leaf(u32),
}

/// Cell that the surface may pass.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Leaf {
    /// The function, by coordinates from −1 to 1.
    pub(crate) cubic: Cubic,
    /// The middle.
    pub(crate) center: DVec3,
    /// Half the side.
    pub(crate) half: f64,
    /// The terms that matter here; `None` if all may.
    pub(crate) terms: Option<Vec<u32>>,
    /// Terms that are evaluated one by one; then the cubic stands for what is far only.
    pub(crate) listed: Vec<u32>,
}

/// Choice of the terms that a leaf lists.
pub(crate) type List<'a> = dyn Fn(Option<&[u32]>) -> Vec<u32> + Sync + 'a;

/// The cells of a body. The first is the root.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Octree {
    /// The root's middle.
    pub(crate) center: DVec3,
    /// Half the root's side.
    pub(crate) half: f64,
    /// The cells, eight by eight after the root.
    pub(crate) cells: Vec<Cell>,
    /// The cells that the surface may pass.
    pub(crate) leaves: Vec<Leaf>,
    /// Number of cells that were as small as may be, or for which there was no room, before their
    /// cubic was close.
    pub(crate) rough: usize,
    /// Number of those that are larger than a pixel, and list no terms.
    pub(crate) crude: usize,
}

/// Bounds on the work for an octree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Limits {
    /// About the most leaves.
    pub(crate) leaves: usize,
    /// The most work, as [`Counted`] counts it.
    pub(crate) work: u64,
    /// Whether it is given up at these limits. Else leaves are rough from there on.
    pub(crate) is_strict: bool,
}

/// A reason for which an octree is not made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Halt {
    /// More work is needed than allowed.
    Limit,
    /// Nobody waits for it.
    Cancelled,
}

/// Hears the share of work done, 0 to 1; returns whether to go on.
pub type Told<'a> = dyn FnMut(f32) -> bool + 'a;

/// Cell that is to be looked at.
struct Open {
    place: usize,
    center: DVec3,
    half: f64,
    part: Option<Arc<Part>>,
}

impl Octree {
    /// Divides the space of a function in draft units into cells. `list` returns the terms to be
    /// listed of some that matter, or of all; none if the card has not all formulas. `None` if
    /// there is no surface.
    ///
    /// # Errors
    /// If it takes too much work, or is not wanted any more.
    pub(crate) fn new(
        function: &Counted<'_>,
        limits: Limits,
        list: &List<'_>,
        told: &mut Told<'_>,
    ) -> Result<Option<Self>, Halt> {
        let (center, half) = match function.support() {
            Some(ball) if ball.radius.is_finite() && ball.center.is_finite() => {
                (ball.center, ball.radius * 1.001)
            }
            _ => (DVec3::ZERO, ENDLESS),
        };
        if half <= 0.0 {
            return Ok(None);
        }
        let mut tree = Self {
            center,
            half,
            cells: vec![Cell::Outside],
            leaves: Vec::new(),
            rough: 0,
            crude: 0,
        };
        let nodes = places();
        let mut open = VecDeque::from([Open {
            place: 0,
            center,
            half,
            part: None,
        }]);
        let start = function.work();
        // Little is done beyond a limit.
        let most = (limits.work / (LOOK * function.whole())).clamp(FEWEST, BATCH);
        while !open.is_empty() {
            let work = function.work() - start;
            if !told((work as f64 / limits.work as f64) as f32) {
                return Err(Halt::Cancelled);
            }
            // At the limit each open cell may become a leaf.
            let others = if limits.is_strict { 0 } else { open.len() };
            let room = tree.leaves.len() + others < limits.leaves && work <= limits.work;
            if !room && limits.is_strict {
                return Err(Halt::Limit);
            }
            let batch: Vec<Open> = open.drain(..open.len().min(most as usize)).collect();
            let looks = map(&batch, |cell| look(function, cell, &nodes, room, list));
            for (cell, look) in batch.into_iter().zip(looks) {
                tree.add(cell, look, &mut open);
            }
        }
        Ok((!tree.leaves.is_empty()).then_some(tree))
    }

    /// Whether few leaves are drawn by cubics that are not close.
    pub(crate) fn is_close(&self) -> bool {
        self.crude as f64 <= CRUDE * self.leaves.len() as f64
    }

    /// Adds what was found in a cell, and the parts that it is to be divided into.
    fn add(&mut self, cell: Open, look: Look, open: &mut VecDeque<Open>) {
        match look {
            Look::Settled(settled) => self.cells[cell.place] = settled,
            Look::Crossed {
                cubic,
                part,
                is_rough,
                listed,
            } => {
                self.rough += usize::from(is_rough);
                let is_large = cell.half > FINEST * (1.0 + cell.center.length());
                self.crude += usize::from(is_rough && is_large && listed.is_empty());
                self.cells[cell.place] = Cell::Leaf(self.leaves.len() as u32);
                self.leaves.push(Leaf {
                    cubic: *cubic,
                    center: cell.center,
                    half: cell.half,
                    terms: part.map(|part| part.terms.clone()),
                    listed,
                });
            }
            Look::Unknown(part) => {
                let first = self.cells.len();
                self.cells[cell.place] = Cell::Parted(first as u32);
                self.cells.resize(first + 8, Cell::Outside);
                let half = 0.5 * cell.half;
                for (place, corner) in (first..).zip(corners()) {
                    open.push_back(Open {
                        place,
                        center: cell.center + half * corner,
                        half,
                        part: part.clone(),
                    });
                }
            }
        }
    }
}

/// The places of a cell's corners, each coordinate −1 or 1.
pub(crate) fn corners() -> [DVec3; 8] {
    core::array::from_fn(|i| {
        let [x, y, z] = [0, 1, 2].map(|axis| if i >> axis & 1 == 1 { 1.0 } else { -1.0 });
        DVec3::new(x, y, z)
    })
}

/// Calls a function with each cell; natively with several at once.
fn map(cells: &[Open], look: impl Fn(&Open) -> Look + Sync) -> Vec<Look> {
    #[cfg(not(target_arch = "wasm32"))]
    {
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        let share = cells.len().div_ceil(threads).max(FEW);
        let look = &look;
        std::thread::scope(|scope| {
            let parts: Vec<_> = cells
                .chunks(share)
                .map(|part| scope.spawn(move || part.iter().map(look).collect::<Vec<_>>()))
                .collect();
            let looks = parts.into_iter().flat_map(|part| match part.join() {
                Ok(looks) => looks,
                Err(panic) => std::panic::resume_unwind(panic),
            });
            looks.collect()
        })
    }
    #[cfg(target_arch = "wasm32")]
    cells.iter().map(look).collect()
}

/// Result of a look at a cell.
enum Look {
    Settled(Cell),
    Crossed {
        cubic: Box<Cubic>,
        part: Option<Arc<Part>>,
        is_rough: bool,
        listed: Vec<u32>,
    },
    Unknown(Option<Arc<Part>>),
}

/// Looks at a cell; if there is no `room` for parts it is settled, or a leaf.
fn look(
    function: &dyn Implicit,
    cell: &Open,
    nodes: &[DVec3; SAMPLES],
    room: bool,
    list: &List<'_>,
) -> Look {
    let ball = Ball {
        center: cell.center,
        radius: cell.half * 3.0_f64.sqrt() * (1.0 + 1e-9),
    };
    let narrower = function.narrow(ball, cell.part.as_deref(), SLACK);
    let part = narrower.map(Arc::new).or_else(|| cell.part.clone());
    let of_part = part.as_deref();
    let slack = of_part.map_or(0.0, |part| part.error()[0]);
    let (variation, jet) = match of_part {
        Some(part) => (
            function.variation(Some(part), ball),
            function.jet_of(part, ball.center),
        ),
        None => {
            let (variation, jet) = function.variation_with_jet(None, ball);
            (variation, jet.unwrap_or_else(|| function.jet(ball.center)))
        }
    };
    let [low, high] = variation.about(&jet, ball.radius).range.value;
    if high + slack < THRESHOLD {
        return Look::Settled(Cell::Outside);
    }
    if low - slack > THRESHOLD {
        return Look::Settled(Cell::Inside);
    }
    let away = 1.0 + cell.center.length();
    let finest = cell.half <= FINEST * away;
    let bend = (variation.curvature * ball.radius + variation.jump) * ball.radius + variation.step;
    if room && !finest && (bend >= LIVELY || bend.is_nan()) {
        return Look::Unknown(part);
    }
    let samples = sample(cell, nodes, |points| match of_part {
        Some(part) => function.jet8_of(part, points).value,
        None => function.jet8(points).value,
    });
    let mut cubic = Cubic::fit(&samples);
    cubic.check_center(jet.value, DVec3::from_array(jet.gradient) * cell.half);
    let reach = cubic.spread + 4.0 * cubic.error + slack;
    if cubic.error <= SMOOTH * cubic.spread && (cubic.mean - THRESHOLD).abs() > reach {
        return Look::Settled(if cubic.mean > THRESHOLD {
            Cell::Inside
        } else {
            Cell::Outside
        });
    }
    let is_rough = cubic.error > CLOSE.min(OFF * away / cell.half) * cubic.spread;
    let listed = if is_rough && (!room || cell.half <= LISTED * away) {
        list(of_part.map(|part| part.terms.as_slice()))
    } else {
        Vec::new()
    };
    if is_rough && room && !finest && !(1..=SHORT).contains(&listed.len()) {
        return Look::Unknown(part);
    }
    let far = of_part.and_then(|part| part.far.as_ref());
    let cubic = match far {
        _ if listed.is_empty() => cubic,
        Some(far) => Cubic::fit(&sample(cell, nodes, |points| far.jet8(points).value)),
        None => Cubic::fit(&[0.0; SAMPLES]),
    };
    Look::Crossed {
        cubic: Box::new(cubic),
        part,
        is_rough,
        listed,
    }
}

/// Samples a function in a cell.
fn sample(
    cell: &Open,
    nodes: &[DVec3; SAMPLES],
    function: impl Fn([f32x8; 3]) -> f32x8,
) -> [f64; SAMPLES] {
    let mut samples = [0.0; SAMPLES];
    let (eights, _) = samples.as_chunks_mut::<8>();
    for (eight, places) in eights.iter_mut().zip(nodes.as_chunks::<8>().0) {
        let points = places.map(|place| (cell.center + cell.half * place).as_vec3());
        let points = [0, 1, 2].map(|axis| f32x8::from(points.map(|point| point[axis])));
        // Poles are endlessly high.
        *eight = function(points)
            .to_array()
            .map(|value| f64::from(if value < HIGH { value } else { HIGH }));
    }
    samples
}

#[cfg(test)]
mod tests {
    use super::*;
    use field::{Enclosure, Jet};

    /// Thin shell around a ball of radius ½: its function is 0 but there.
    struct Shell;

    /// Slope of the shell's function.
    const STEEP: f64 = 100.0;

    impl Implicit for Shell {
        fn jet(&self, point: DVec3) -> Jet<f64> {
            let depth = point.length() - 0.5;
            let value = f64::max(2.0 - STEEP * depth.abs(), 0.0);
            let slope = if value > 0.0 { -STEEP } else { 0.0 };
            Jet {
                value,
                gradient: (point.normalize_or_zero() * slope * depth.signum()).to_array(),
            }
        }

        fn jet32(&self, point: [f32; 3]) -> Jet<f32> {
            let jet = self.jet(point.map(f64::from).into());
            Jet {
                value: jet.value as f32,
                gradient: jet.gradient.map(|x| x as f32),
            }
        }

        fn jet8(&self, points: [f32x8; 3]) -> Jet<f32x8> {
            let [x, y, z] = points.map(f32x8::to_array);
            let jets: [Jet<f32>; 8] = core::array::from_fn(|i| self.jet32([x[i], y[i], z[i]]));
            Jet {
                value: jets.each_ref().map(|jet| jet.value).into(),
                gradient: [0, 1, 2].map(|axis| jets.each_ref().map(|j| j.gradient[axis]).into()),
            }
        }

        fn enclose(&self, ball: Ball) -> Enclosure {
            let middle = (ball.center.length() - 0.5).abs();
            let [high, low] = [middle - ball.radius, middle + ball.radius]
                .map(|depth| f64::max(2.0 - STEEP * f64::max(depth, 0.0), 0.0));
            Enclosure {
                value: [low, high],
                slope: if high > 0.0 { STEEP } else { 0.0 },
                curvature: f64::INFINITY,
            }
        }

        fn shares(&self, _: DVec3, _: &mut Vec<(u32, f64)>) {}

        fn support(&self) -> Option<Ball> {
            Some(Ball {
                center: DVec3::ZERO,
                radius: 1.0,
            })
        }
    }

    #[test]
    fn thin_shells_between_the_samples_are_found() {
        let limits = Limits {
            leaves: 100_000,
            work: u64::MAX,
            is_strict: false,
        };
        let shell = Counted::with(&Shell, 1, 1);
        let tree = Octree::new(&shell, limits, &|_| Vec::new(), &mut |_| true);
        let tree = tree.ok().flatten().expect("a surface");
        for n in 0..1000 {
            let turn = f64::from(n) * 2.4;
            let z = f64::from(n) / 500.0 - 0.999;
            let around = libm::sqrt(1.0 - z * z);
            let out = DVec3::new(around * libm::cos(turn), around * libm::sin(turn), z);
            for (depth, is_inside) in [(0.0, true), (0.02, false)] {
                let place = out * (0.5 + depth);
                let found = match tree.find(place) {
                    (Cell::Leaf(number), own) => {
                        tree.leaves[*number as usize].cubic.value(own) > THRESHOLD
                    }
                    (cell, _) => *cell == Cell::Inside,
                };
                assert_eq!(found, is_inside, "{place}");
            }
        }
    }

    impl Octree {
        /// Returns the smallest cell around a place, and the place in its own coordinates.
        fn find(&self, place: DVec3) -> (&Cell, DVec3) {
            let (mut center, mut half) = (self.center, self.half);
            let mut cell = &self.cells[0];
            while let Cell::Parted(first) = cell {
                let upper = place.cmpge(center).bitmask() as usize;
                half *= 0.5;
                center += half * corners()[upper];
                cell = &self.cells[*first as usize + upper];
            }
            (cell, (place - center) / half)
        }
    }
}
