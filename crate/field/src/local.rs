//! Local convolution: of a skeleton only the stretch near a point counts, so that its folds do not
//! blend.
//!
//! A skeleton is cut into short pieces, each of one primitive or of some that follow one another.
//! Around each piece j there is a *stretch*: the part of the
//! skeleton within an arc length D of it, which runs through branches into every curve that meets
//! there, and fades towards its ends, see [`window`]. The field at a point is the mean of the
//! fields of all stretches, weighted by how near their pieces are:
//!
//! `F = Σⱼ ωⱼWⱼ / Σⱼ ωⱼ`, `Wⱼ = Σᵢ wᵢⱼfᵢ`, `ωⱼ = lⱼ·(rⱼfⱼ/lⱼ)⁸`,
//!
//! with fᵢ the field of the piece i, lᵢ its length, rᵢ its radius, and wᵢⱼ the window's mean over
//! the piece i, a constant. Thanks to the radius a thin limb weighs at its surface what a thick one
//! does there. So each piece keeps its closed form, its taper and its bounds, F is as smooth as
//! they are, and it is never above the largest of the Wⱼ: what is far along the skeleton blends
//! with nothing. Its gradient is `∇F = Σᵢ (Σⱼ ω̂ⱼwᵢⱼ + 8ω̂ᵢ(Wᵢ−F)/fᵢ)·∇fᵢ`, where `ω̂ⱼ = ωⱼ/Σω`.
//!
//! Of folds that touch there is a second field, of what is far along the skeleton from the pieces
//! that count at a point, see [`Local::two`]:
//!
//! `F₂ = Σⱼ ω̂ⱼ·r(F₂ⱼ)`, `F₂ⱼ = Σₖ vⱼₖωₖ·vⱼₖWₖ / Σₖ vⱼₖωₖ`,
//!
//! where vⱼₖ rises from 0 to 1 as the distance of the two pieces along the skeleton does from 2D
//! to 3D, and r(x) is x from the level on below which F₂ is of no interest, and 0 up to half of it.
//!
//! Weights below 2⁻⁴⁰ of the largest count as 0. So in a small part of space few pieces matter.
//!
//! - `build.rs`: making it; [`graph`]: distances along a skeleton; [`window`]: weights of pieces;
//! - `mean.rs`: the fields; `bounds.rs`: bounds on them in balls; `tree.rs`: on the sum of all
//!   pieces;
//! - `cells.rs`: an octree that knows which pieces matter where.
mod bounds;
mod build;
mod cells;
pub mod graph;
mod mean;
mod tree;
pub mod window;

pub use bounds::{Bounds, Halves, Two};
pub use build::{Limb, LimbPiece, LocalError, MOST_LINKS};

use crate::term::Evaluate;
use crate::{Ball, Bound, Enclosure, Implicit, Jet, Part, Primitive, THRESHOLD, Variation};
use cells::Cells;
use core::ops::Range;
use glam::DVec3;
use tree::Tree;
use wide::f32x8;
use window::Window;

/// The local convolution of a skeleton.
///
/// It has one element, and is its own [`Implicit`]. See the [module](self) for its definition.
#[derive(Clone, Debug)]
pub struct Local {
    window: Window,
    pieces: Vec<Piece>,
    /// Runs of pieces in the stretches around each piece, and the pieces' weights.
    runs: Vec<Run>,
    weights: Vec<f64>,
    /// Pieces within 3D of each piece, in order, and how much they count as another fold: less
    /// than 1.
    near: Vec<(u32, f64)>,
    /// Value of F₂ below which it is of no interest; `None` if all of it is of none.
    level: Option<f64>,
    tree: Tree,
    cells: Cells,
}

#[derive(Clone, Debug)]
struct Piece {
    parts: Vec<(Primitive, Bound)>,
    length: f64,
    /// Radius over length: the factor on the field in the weight.
    thickness: f64,
    /// The runs of its stretch.
    links: Range<u32>,
    /// The pieces near it.
    near: Range<u32>,
}

/// Pieces one after the other, with their weights in a stretch.
#[derive(Clone, Copy, Debug)]
struct Run {
    first: u32,
    count: u32,
    weights: u32,
}

impl Piece {
    /// Computes the field.
    fn jet<R: Evaluate>(&self, point: [R; 3]) -> Jet<R> {
        let [(first, _), others @ ..] = &self.parts[..] else {
            return Jet::zero();
        };
        (others.iter()).fold(first.jet(point), |sum, (primitive, _)| {
            sum.plus(primitive.jet(point))
        })
    }

    /// Returns an upper bound on the field in a ball.
    fn most(&self, ball: &Ball) -> f64 {
        let bounds = self.parts.iter().map(|(_, bound)| bound);
        let most = bounds.map(|bound| bound.magnitude(bound.nearness(ball.center, ball.radius)));
        most.sum()
    }
}

impl Local {
    /// Returns the reach D.
    #[must_use]
    pub fn reach(&self) -> f64 {
        self.window.reach
    }

    /// Returns the same function with a field of other folds, which is of no interest where it is
    /// below a level > 0.
    #[must_use]
    pub fn with_folds(mut self, level: f64) -> Self {
        self.level = Some(level);
        self.cells.clear();
        self
    }

    /// Computes value and gradient of F and, if there is another fold whose field may be above the
    /// level of [`Local::with_folds`], of F₂.
    #[must_use]
    pub fn two<R: Evaluate>(&self, point: [R; 3]) -> (Jet<R>, Option<Jet<R>>) {
        let mut lanes = (0..R::LANES).map(|k| DVec3::from_array(point.map(|x| x.lane(k))));
        let first = lanes.next().unwrap_or_default();
        let radius = lanes.fold(0.0, |most: f64, other| most.max(first.distance(other)));
        let ball = Ball {
            center: first,
            radius: radius * (1.0 + 1e-12),
        };
        self.two_of(&self.terms_in(&ball), point)
    }

    /// Returns the least width of a kernel among the pieces that count in a ball, or that may be
    /// another fold there; infinite if all pieces together do not matter. `None` if one has a
    /// profile.
    fn least_width_in(&self, ball: &Ball, enough: f64) -> Option<f64> {
        if self.tree.most(&self.pieces, ball, enough) < enough {
            return Some(f64::INFINITY);
        }
        let terms = self.terms_in(ball);
        let far = terms.far.iter().flat_map(|far| &far.pieces);
        let pieces = terms.lead.iter().chain(far);
        let mut parts = pieces.flat_map(|piece| &self.pieces[*piece as usize].parts);
        parts.try_fold(f64::INFINITY, |least, (_, bound)| {
            (!bound.has_profile()).then(|| least.min(bound.kernel_width()))
        })
    }

    /// Returns the runs of the stretch around a piece.
    fn links(&self, piece: u32) -> &[Run] {
        let Range { start, end } = self.pieces[piece as usize].links;
        &self.runs[start as usize..end as usize]
    }

    /// Returns the weights of a run's pieces.
    fn weights(&self, run: &Run) -> &[f64] {
        &self.weights[run.weights as usize..][..run.count as usize]
    }
}

impl Implicit for Local {
    fn jet(&self, point: DVec3) -> Jet<f64> {
        self.two(point.to_array()).0
    }

    fn jet32(&self, point: [f32; 3]) -> Jet<f32> {
        self.two(point).0
    }

    fn jet8(&self, points: [f32x8; 3]) -> Jet<f32x8> {
        self.two(points).0
    }

    fn enclose(&self, ball: Ball) -> Enclosure {
        self.enclose_two(ball).first.enclosure()
    }

    fn variation(&self, _part: Option<&Part>, ball: Ball) -> Variation {
        self.enclose_two(ball).first.variation()
    }

    fn variation_with_jet(
        &self,
        _part: Option<&Part>,
        ball: Ball,
    ) -> (Variation, Option<Jet<f64>>) {
        let two = self.enclose_two(ball);
        let variation = two.first.variation_by_halves(ball.radius);
        (variation, two.at_center.map(|jets| jets.0))
    }

    fn turn_smoothly(&self, _part: Option<&Part>, ball: Ball, step: f64) -> Option<[DVec3; 3]> {
        Some(self.turn_mean(ball, step))
    }

    fn least_width(&self, _part: Option<&Part>, ball: Ball, enough: f64) -> Option<f64> {
        self.least_width_in(&ball, enough)
    }

    fn most(&self, ball: Ball) -> f64 {
        self.most_in(ball)
    }

    fn shares(&self, point: DVec3, out: &mut Vec<(u32, f64)>) {
        let value = self.jet(point).value;
        if value > 0.0 {
            out.push((0, value));
        }
    }

    fn support(&self) -> Option<Ball> {
        self.support_at(THRESHOLD)
    }

    fn support_at(&self, level: f64) -> Option<Ball> {
        // Where no primitive has more than its share of the level; a stretch has all those of the
        // pieces that it links.
        let most = (0..self.pieces.len() as u32).map(|piece| {
            let linked = self.links(piece).iter();
            let linked = linked.flat_map(|run| run.first..run.first + run.count);
            let parts = linked.map(|other| self.pieces[other as usize].parts.len());
            parts.sum::<usize>()
        });
        let share = level / most.max()? as f64;
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for (primitive, bound) in self.pieces.iter().flat_map(|piece| &piece.parts) {
            let (center, around) = primitive.skeleton.bounding_sphere()?;
            let reach = around + bound.distance_of(share);
            (low, high) = (low.min(center - reach), high.max(center + reach));
        }
        Some(Ball {
            center: 0.5 * (low + high),
            radius: 0.5 * low.distance(high),
        })
    }
}
