//! Local convolution: of a skeleton only the stretch near a point counts, so that its folds do not
//! blend.
//!
//! Along each segment of the skeleton planes sweep from one end to the other, see
//! [`planes`](self::planes). A point lies in some of them; each is a *place* on the skeleton. The
//! field of a place is that of the skeleton within an arc length D of it, which runs through
//! branches into every curve that meets there, and fades towards its ends, see
//! [`window`](self::window). The field at the point is the largest of those of its places, of the
//! skeleton's free ends and of its branches:
//!
//! `F(p) = max W(s, p)`, `W(s, p) = Σᵢ wᵢ(s)·fᵢ(p)`, wᵢ(s) the window's mean over the piece i, fᵢ
//! the piece's field.
//!
//! So each piece keeps its closed form, its taper and its bounds. Pieces are to be short compared
//! with D.
//!
//! **Continuity.** While one place leads, F has a continuous gradient `∇F = W_p + W_s∇s` within the
//! planes of a segment. Where two places tie, and where planes change from one segment to the next
//! (or at a branch), the gradient jumps: by `W_s` times the jump of ∇s there, as W_s counts only
//! what is in the fading parts of the window. The value is continuous but where a place vanishes
//! that leads: where planes of a bend meet, at its centre of curvature or beyond it.
//! [`Local::enclose`] knows all of these: bounds that do not hold are infinite.
//!
//! Bounds, in a ball of radius r for the places `s₀ ≤ s ≤ s₁` whose planes meet it: with
//! `d·(p−r(u)) = 0` we have `∇u = −d/g`, `g = ∂(d·(p−r))/∂u`, and
//! `|∇²u| ≤ (|g_u||∇u|² + 2|d_u||∇u|)/|g|`; wᵢ changes by at most `1.5/δ`, and its derivative by
//! `6/δ²`, and only where a piece is in a fading part.
//!
//! - `build.rs`: making it; [`graph`]: distances along a skeleton;
//! - [`planes`]: the places whose planes hold a point; [`window`]: weights of pieces;
//!   `stretch.rs`: the field;
//! - `survey.rs`: bounds on the fields of the places of a ball; `leaders.rs`: on the largest of
//!   them; `groups.rs`: on the sum of all;
//! - `cells.rs`: an octree that knows which places may lead where; `near.rs`: pieces, each
//!   evaluated once for all places.
mod build;
mod cells;
pub mod graph;
mod groups;
mod leaders;
mod near;
pub mod planes;
mod stretch;
mod survey;
pub mod window;

pub use build::{Limb, LocalError, MOST_LINKS};
pub use leaders::Two;
pub use survey::Bounds;

use crate::{Ball, Bound, Enclosure, Implicit, Jet, Primitive, Real, THRESHOLD, Variation};
use cells::Cells;
use glam::DVec3;
use groups::{Group, Node};
use planes::Swept;
use stretch::Stretch;
use wide::f32x8;
use window::Window;

/// The local convolution of a skeleton.
///
/// It has one element, and is its own [`Implicit`]. See the [module](self) for its definition.
#[derive(Clone, Debug)]
pub struct Local {
    window: Window,
    pieces: Vec<Piece>,
    segments: Vec<Segment>,
    links: Vec<Link>,
    /// Ends and branches: a segment, and which of its ends.
    nodes: Vec<(u32, usize)>,
    /// Points within twice the reach of each point of the skeleton, in order, with their distances.
    near: Vec<Vec<(u32, f64)>>,
    /// Tree of all pieces, halved again and again: a group is followed by its first half, and knows
    /// where its second one starts.
    tree: Vec<(Group, Node)>,
    /// Numbers of all terms: segments, whose places sweep along them, then ends and branches.
    terms: Vec<u32>,
    /// The terms that matter in parts of space.
    cells: Cells,
}

#[derive(Clone, Debug)]
struct Piece {
    primitive: Primitive,
    bound: Bound,
}

#[derive(Clone, Debug)]
struct Segment {
    ends: [u32; 2],
    next: [Option<u32>; 2],
    swept: Swept,
    length: f64,
    /// The links to its own pieces and to all others within reach.
    links: core::ops::Range<usize>,
    /// A ball around all pieces within reach, and bounds on their fields.
    group: Group,
}

/// Link from a segment to a piece.
#[derive(Clone, Copy, Debug)]
struct Link {
    piece: u32,
    length: f64,
    /// Distances of both ends of the piece from both ends of the segment; for a piece of the
    /// segment itself, distances of its ends from the segment's start.
    distances: [[f64; 2]; 2],
    own: bool,
}

/// A place on the skeleton.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// The segment.
    pub segment: u32,
    /// Arc length from its start.
    pub along: f64,
}

/// Fields below this are not looked at closely.
const FAINT: f64 = 0.05;

impl Local {
    /// The reach D.
    #[must_use]
    pub fn reach(&self) -> f64 {
        self.window.reach
    }
}

impl Bounds {
    /// Returns the bounds as an enclosure, whose curvature is infinite where the gradient jumps.
    #[must_use]
    pub fn enclosure(&self) -> Enclosure {
        Enclosure {
            value: self.value,
            slope: self.slope,
            curvature: if self.jump > 0.0 {
                f64::INFINITY
            } else {
                self.curvature
            },
        }
    }

    /// Returns the bounds as mesher and tracer read them.
    #[must_use]
    pub fn variation(&self) -> Variation {
        // Where the value jumps, nothing is known of derivatives.
        let is_tame = self.slope.is_finite() && self.curvature.is_finite();
        let curvature = if is_tame { self.curvature } else { 0.0 };
        Variation {
            range: self.enclosure(),
            curvature,
            third: 0.0,
            rough: curvature,
            jump: if is_tame { self.jump } else { f64::INFINITY },
            step: 0.0,
        }
    }
}

impl Implicit for Local {
    fn jet(&self, point: DVec3) -> Jet<f64> {
        let [first, _] = self.two_at(point, None);
        first.map_or_else(Jet::zero, |stretch| stretch.jet)
    }

    fn jet32(&self, point: [f32; 3]) -> Jet<f32> {
        narrow(self.jet(DVec3::from_array(point.map(f64::from))))
    }

    fn jet8(&self, points: [f32x8; 3]) -> Jet<f32x8> {
        lanes(points, |point| self.jet32(point))
    }

    fn enclose(&self, ball: Ball) -> Enclosure {
        let bounds = self.enclose_two(ball, None).first.enclosure();
        bounds.about(&self.jet(ball.center), ball.radius)
    }

    fn variation(&self, _part: Option<&crate::Part>, ball: Ball) -> Variation {
        self.enclose_two(ball, None).first.variation()
    }

    fn most(&self, ball: Ball) -> f64 {
        self.everything(&ball)
    }

    fn shares(&self, point: DVec3, out: &mut Vec<(u32, f64)>) {
        let [Some(Stretch { place, .. }), _] = self.two_at(point, None) else {
            return;
        };
        out.push((0, self.stretch_at(place, point).value));
    }

    fn support(&self) -> Option<Ball> {
        self.support_at(THRESHOLD)
    }

    fn support_at(&self, level: f64) -> Option<Ball> {
        // Where no piece has more than its share of the level; a stretch has as many as a segment
        // has links.
        let most = self.segments.iter().map(|s| s.links.len()).max()?;
        let share = level / most as f64;
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for piece in &self.pieces {
            let (center, around) = piece.primitive.skeleton.bounding_sphere()?;
            let reach = around + piece.bound.distance_of(share);
            (low, high) = (low.min(center - reach), high.max(center + reach));
        }
        Some(Ball {
            center: 0.5 * (low + high),
            radius: 0.5 * low.distance(high),
        })
    }
}

/// Converts a jet to single precision.
#[must_use]
pub fn narrow(jet: Jet<f64>) -> Jet<f32> {
    Jet {
        value: jet.value as f32,
        gradient: jet.gradient.map(|x| x as f32),
    }
}

/// Computes jets at eight points, one after the other.
#[must_use]
pub fn lanes(points: [f32x8; 3], jet: impl Fn([f32; 3]) -> Jet<f32>) -> Jet<f32x8> {
    let points = points.map(|x| x.to_array());
    let jets: [Jet<f32>; 8] = core::array::from_fn(|i| jet(core::array::from_fn(|k| points[k][i])));
    Jet {
        value: f32x8::from_lanes(|i| f64::from(jets[i].value)),
        gradient: core::array::from_fn(|k| f32x8::from_lanes(|i| f64::from(jets[i].gradient[k]))),
    }
}
