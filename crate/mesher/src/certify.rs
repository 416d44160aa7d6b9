//! Proof that a triangle is near the surface, and looks the same way.
//!
//! Let a triangle have the unit normal n and be divided into a grid of equal triangles in balls of radius ρ, and let D bound the third
//! derivative of F nearby. The gradients at the corners of a triangle of the grid, interpolated linearly, are the
//! gradient in it up to e = D·ρ²/2 (terms whose second derivative jumps add their curvature times ρ). So
//! −∇F·n is at least its least value s at those corners less e, and F − T is within 3e·ρ of a polynomial of the second degree, whose
//! size is at most that of its Bézier coefficients: the values at corners, and values plus half the slope along edges. With that
//! bound m on |F − T| and a bound C on the curvature within d of the triangle, the line of steepest ascent or descent
//! from any point of the triangle meets the surface within d, if d·(s − e − C·d) ≥ m.
//!
//! A closed mesh of such triangles that was made from an isotopic one by changes near the surface covers each point of the
//! surface exactly once: along those lines it is mapped to the surface with positive orientation and degree 1. So it is
//! isotopic to the surface, does not cut itself, and no point of the surface is farther from it than from the mesh the
//! points of which are mapped there.

use crate::space::{SLACK, Space};
use field::{Ball, Jet, THRESHOLD, Variation};
use glam::DVec3;

/// A vertex of the mesh: position, and the function there.
#[derive(Clone, Copy, Debug)]
pub struct Vertex {
    /// Position.
    pub position: DVec3,
    /// Value less the threshold.
    pub value: f64,
    /// Gradient.
    pub gradient: DVec3,
}

impl Vertex {
    /// The function at a position.
    pub fn new(position: DVec3, jet: &Jet<f64>) -> Self {
        Self {
            position,
            value: jet.value - THRESHOLD,
            gradient: DVec3::from_array(jet.gradient),
        }
    }

    /// Outward unit normal of the level set; 0 where the gradient is.
    pub fn normal(&self) -> DVec3 {
        -self.gradient.normalize_or_zero()
    }
}

/// Centre and radius of the smallest ball around a triangle.
fn ball([a, b, c]: &[DVec3; 3]) -> Ball {
    let sides = [(*b, *c), (*c, *a), (*a, *b)];
    let longest = (0..3).max_by(|i, j| {
        let length = |k: usize| sides[k].0.distance_squared(sides[k].1);
        length(*i).total_cmp(&length(*j))
    });
    let i = longest.unwrap_or(0);
    let (p, q) = sides[i];
    let opposite = [*a, *b, *c][i];
    let (u, v) = (p - opposite, q - opposite);
    if u.dot(v) <= 0.0 {
        return Ball {
            center: 0.5 * (p + q),
            radius: 0.5 * p.distance(q),
        };
    }
    let n = u.cross(v);
    let to = (u.length_squared() * v.cross(n) + v.length_squared() * n.cross(u))
        / (2.0 * n.length_squared());
    Ball {
        center: opposite + to,
        radius: to.length() * (1.0 + 1e-9),
    }
}

/// Twice the area of a triangle over the square of its longest side, below which it counts as flat.
const FLAT: f64 = 1e-7;

/// Divisions of an edge that are tried.
const GRIDS: [usize; 3] = [2, 3, 6];
/// The last of them, which has the points of all.
const FINEST: usize = 6;
/// Its number of points.
const POINTS: usize = (FINEST + 1) * (FINEST + 2) / 2;

/// Index of a point of the finest grid, at so many steps from two sides.
const fn place([i, j]: [usize; 2]) -> usize {
    // Row i starts after those before it, which have 7, 6, … points.
    i * (2 * FINEST + 3 - i) / 2 + j
}

/// Whether a point of the finest grid is one of a coarser grid.
fn is_in([i, j]: [usize; 2], grid: usize) -> bool {
    let step = FINEST / grid;
    i % step == 0 && j % step == 0
}

/// All points of the finest grid, those far from the corners first: where triangles fail to be proved it is mostly in the middle.
const POINTS_IN_ORDER: [[usize; 2]; POINTS] = {
    let mut all = [[0; 2]; POINTS];
    let mut count = 0;
    // The largest of the three distances from the sides, from that of the centre to that of the corners.
    let mut most = FINEST / 3;
    while most <= FINEST {
        let mut i = 0;
        while i <= FINEST {
            let mut j = 0;
            while j <= FINEST - i {
                let k = FINEST - i - j;
                let largest = if i > j { i } else { j };
                let largest = if k > largest { k } else { largest };
                if largest == most {
                    all[count] = [i, j];
                    count += 1;
                }
                j += 1;
            }
            i += 1;
        }
        most += 1;
    }
    all
};

/// The function at points of a triangle's finest grid, where it was evaluated.
struct Points {
    vertices: [Option<Vertex>; POINTS],
    corners: [Vertex; 3],
}

impl Points {
    /// The function at a point, by an evaluation if there was none.
    fn at(&mut self, at: [usize; 2], evaluate: impl Fn(DVec3) -> Vertex) -> Vertex {
        let [i, j] = at;
        let shares = [i, j, FINEST - i - j];
        let corners = &self.corners;
        *self.vertices[place(at)].get_or_insert_with(|| {
            match shares.iter().position(|n| *n == FINEST) {
                Some(corner) => corners[corner],
                None => {
                    let [u, v, w] = shares.map(|n| n as f64 * (1.0 / FINEST as f64));
                    let [a, b, c] = corners.map(|corner| corner.position);
                    evaluate(a * u + b * v + c * w)
                }
            }
        })
    }
}

/// The largest distance of a triangle from the surface, as proved; `None` if it is not proved to be at most the tolerance.
pub fn distance(space: &Space<'_>, corners: [&Vertex; 3], tolerance: f64) -> Option<f64> {
    let positions = corners.map(|v| v.position);
    let [a, b, c] = positions;
    let cross = (b - a).cross(c - a);
    let longest = a
        .distance_squared(b)
        .max(b.distance_squared(c))
        .max(c.distance_squared(a));
    // The normal of a flat triangle is noise.
    if cross.length() <= FLAT * longest {
        return None;
    }
    let normal = cross.try_normalize()?;
    let steepness = |gradient: DVec3| -gradient.dot(normal);
    let highest = corners.iter().map(|v| v.value.abs()).fold(0.0, f64::max);
    let steep = corners
        .iter()
        .map(|v| steepness(v.gradient))
        .fold(f64::INFINITY, f64::min);
    if !(steep > 0.0 && highest <= tolerance * steep) {
        return None;
    }
    let Ball { center, radius } = ball(&positions);
    let reach = Ball {
        center,
        radius: radius + tolerance,
    };
    let part = space.part_for(reach);
    let Variation {
        curvature,
        third,
        rough,
        jump,
        step,
        ..
    } = space.variation(part, reach);
    // The corners may have been evaluated in other parts.
    let [error, steep_error] = space.worst_error();
    // What is proved with the least steepness and the highest value at the corners of a grid.
    let proved = |grid: usize, steep: f64, highest: f64| {
        let radius = radius / grid as f64;
        let rest =
            (0.5 * third * radius + rough).min(curvature) * radius + jump + SLACK + steep_error;
        // Coefficients that are found from different corners differ by e times an edge.
        let (steep, off) = (
            steep - rest,
            highest + 3.0 * rest * radius + step + SLACK + error,
        );
        let square = steep * steep - 4.0 * curvature * off;
        // Not so for NaN.
        if !(steep > 0.0 && square >= 0.0) {
            return None;
        }
        let distance = 2.0 * off / (steep + square.sqrt());
        (distance <= tolerance).then_some(distance)
    };
    let edges = [(0, 1), (1, 2), (2, 0)];
    let controls = |vertices: &[Vertex], i: usize, j: usize| {
        let (one, other) = (&vertices[i], &vertices[j]);
        let along = 0.5 * (other.position - one.position);
        let [p, q] = [
            one.value + one.gradient.dot(along),
            other.value - other.gradient.dot(along),
        ];
        p.abs().max(q.abs())
    };
    let whole = corners.map(|v| *v);
    let bezier = edges
        .iter()
        .map(|(i, j)| controls(&whole, *i, *j))
        .fold(highest, f64::max);
    if let Some(distance) = proved(1, steep, bezier) {
        return Some(distance);
    }
    let mut known = Points {
        vertices: [None; POINTS],
        corners: whole,
    };
    GRIDS.into_iter().find_map(|grid| {
        // Without hope even if all went well within.
        proved(grid, steep, highest)?;
        let (mut steep, mut highest) = (steep, highest);
        let mut at = |place| known.at(place, |point| Vertex::new(point, &space.jet(part, point)));
        for place in POINTS_IN_ORDER {
            if !is_in(place, grid) {
                continue;
            }
            let vertex = at(place);
            steep = steep.min(steepness(vertex.gradient));
            highest = highest.max(vertex.value.abs());
            // Further points make it no better.
            proved(grid, steep, highest)?;
        }
        let step = FINEST / grid;
        for i in (0..FINEST).step_by(step) {
            for j in (0..FINEST - i).step_by(step) {
                let corners = [[i, j], [i, j + step], [i + step, j]].map(&mut at);
                for (i, j) in edges {
                    highest = highest.max(controls(&corners, i, j));
                }
            }
        }
        proved(grid, steep, highest)
    })
}

/// Whether no triangle near the middle of this one can be proved, however small: the gradient may jump there by as much as its
/// length.
pub fn is_hopeless(space: &Space<'_>, corners: &[Vertex; 3], tolerance: f64) -> bool {
    let center = corners.iter().map(|v| v.position).sum::<DVec3>() / 3.0;
    let reach = Ball {
        center,
        radius: tolerance,
    };
    let part = space.part_for(reach);
    let Variation { jump, rough, .. } = space.variation(part, reach);
    let jet = space.jet(part, center);
    let steep = DVec3::from_array(jet.gradient).length();
    // Not so for NaN.
    let may_be_proved = steep > jump + rough * tolerance;
    !may_be_proved
}

/// The place of the surface on a segment between two points where the function, less the threshold, has other signs:
/// as a share of the way, between `margin` and 1 − `margin`. By false position with the slopes that were met on the way.
pub fn root(space: &Space<'_>, [a, b]: [DVec3; 2], [at_a, at_b]: [f64; 2], margin: f64) -> Vertex {
    let part = space.part_for(Ball {
        center: 0.5 * (a + b),
        radius: 0.5 * a.distance(b),
    });
    // Exact where the segment is across an axis.
    let at = |share: f64| a + (b - a) * share;
    let evaluate = |share: f64| Vertex::new(at(share), &space.jet(part, at(share)));
    let (mut low, mut high) = ((0.0, at_a), (1.0, at_b));
    let mut share = at_a / (at_a - at_b);
    let mut vertex = evaluate(share);
    for _ in 0..4 {
        let slope = vertex.gradient.dot(b - a);
        if (vertex.value > 0.0) == (at_a > 0.0) {
            low = (share, vertex.value);
        } else {
            high = (share, vertex.value);
        }
        let newton = share - vertex.value / slope;
        let next = if newton > low.0 && newton < high.0 {
            newton
        } else {
            low.0 + (high.0 - low.0) * low.1 / (low.1 - high.1)
        };
        let next = next.clamp(margin, 1.0 - margin);
        let is_done = (next - share).abs() < 1e-5;
        share = next;
        if is_done {
            break;
        }
        vertex = evaluate(share);
    }
    vertex
}

/// The point of the surface that is reached from a position along gradients, by a few steps of Newton's; not farther than
/// `reach`.
pub fn project(space: &Space<'_>, position: DVec3, reach: f64, tolerance: f64) -> Option<Vertex> {
    let mut vertex = Vertex::new(position, &space.jet_at(position));
    for _ in 0..4 {
        let step = vertex.gradient * (-vertex.value / vertex.gradient.length_squared());
        let length = step.length();
        if length <= 1e-3 * tolerance {
            return Some(vertex);
        }
        let next = vertex.position + step;
        // Not so for NaN.
        let is_near = next.distance(position) <= reach;
        if !is_near {
            return None;
        }
        vertex = Vertex::new(next, &space.jet_at(next));
    }
    None
}
