//! Subdivision of a curve, from a control polygon to points on the scheme's limit curve.
//!
//! Points have four coordinates, the last of which is the radius. A step of subdivision doubles the
//! number of control points; after the last step each is moved to where further steps would take it
//! (its limit position), so that all levels are polygons of the same curve.
use crate::Node;
use glam::DVec4;
use serde::{Deserialize, Serialize};

/// Rule of subdivision.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Scheme {
    /// The uniform cubic B-spline, C². It has no curvature at its ends.
    #[default]
    Cubic,
    /// Chaikin's corner cutting: the uniform quadratic B-spline, C¹. It is straight at its ends, up
    /// to the middle of the first and the last side.
    Chaikin,
    /// Dyn, Levin and Gregory's interpolating scheme, C¹: the curve passes through all nodes, and
    /// is a cubic where four or more lie on one at even steps.
    FourPoint,
}

/// Refined curve.
pub struct Refined {
    /// Points, the first and the last of which are the same if the curve is closed.
    pub points: Vec<DVec4>,
    /// Index of the point at each of the curve's nodes, if there is one.
    pub at_nodes: Vec<Option<usize>>,
    /// Index of the node before each segment between two points.
    pub spans: Vec<usize>,
}

/// Steps that distribute the condition to pass through given nodes: each halves what is left, and
/// 2⁻⁶⁰ is below the precision.
const SWEEPS: usize = 60;

/// Refines the curve through `nodes`, and through those that are `fixed`; its ends are, in any
/// case. The last node of a closed curve is the first one again.
pub fn refine(
    scheme: Scheme,
    levels: u32,
    nodes: &[Node],
    fixed: &[bool],
    closed: bool,
) -> Refined {
    let own: Vec<DVec4> = nodes.iter().map(|n| n.position.extend(n.radius)).collect();
    let last = own.len() - 1;
    let fixed = |i: usize| i == 0 || i == last || fixed[i];
    // Without the second copy of a closed curve's first node.
    let ring = if closed { &own[..last] } else { &own[..] };
    let mut refined = match scheme {
        Scheme::Cubic => {
            let mut control = interpolating(ring, &fixed, closed);
            for _ in 0..levels {
                control = split_cubic(&control, closed);
            }
            let points = limits_cubic(&control, closed);
            even_steps(points, levels, last, closed, &fixed)
        }
        Scheme::FourPoint => {
            let mut points = ring.to_vec();
            for _ in 0..levels {
                points = split_four_point(&points, closed);
            }
            even_steps(points, levels, last, closed, &|_| true)
        }
        Scheme::Chaikin => chaikin(ring, levels, last, closed, &fixed),
    };
    let (least, most) = own
        .iter()
        .fold((f64::INFINITY, 0.0f64), |(least, most), p| {
            (least.min(p.w), most.max(p.w))
        });
    for point in &mut refined.points {
        point.w = point.w.clamp(least, most);
    }
    // To the last bit, so that curves meet.
    for (own, at) in own.iter().zip(&refined.at_nodes) {
        if let Some(at) = at {
            refined.points[*at] = *own;
        }
    }
    refined
}

/// Makes the refined curve of points at even steps of the parameter from node to node.
fn even_steps(
    mut points: Vec<DVec4>,
    levels: u32,
    last: usize,
    closed: bool,
    passed: &dyn Fn(usize) -> bool,
) -> Refined {
    if closed {
        points.push(points[0]);
    }
    Refined {
        at_nodes: (0..=last)
            .map(|i| passed(i).then_some(i << levels))
            .collect(),
        spans: (0..points.len() - 1).map(|i| i >> levels).collect(),
        points,
    }
}

/// The neighbours of a point of a polygon; of an end of an open one the other neighbour, mirrored
/// at it.
fn neighbours(points: &[DVec4], i: usize, closed: bool) -> [DVec4; 2] {
    let n = points.len();
    if closed {
        return [points[(i + n - 1) % n], points[(i + 1) % n]];
    }
    match i {
        0 => [2.0 * points[0] - points[1], points[1]],
        i if i + 1 == n => [points[i - 1], 2.0 * points[i] - points[i - 1]],
        i => [points[i - 1], points[i + 1]],
    }
}

/// The control polygon whose cubic B-spline passes through the fixed nodes; other nodes are its
/// corners.
///
/// The spline's point at a corner Q is `(P + 4Q + R)/6` with its neighbours P and R. Where that is
/// to be a node B, `Q = (6B − P − R)/4`, by Gauss–Seidel iteration.
fn interpolating(nodes: &[DVec4], fixed: &dyn Fn(usize) -> bool, closed: bool) -> Vec<DVec4> {
    let mut control = nodes.to_vec();
    let inner = if closed {
        0..nodes.len()
    } else {
        1..nodes.len() - 1
    };
    let passed: Vec<usize> = inner.filter(|&i| fixed(i)).collect();
    for _ in 0..SWEEPS {
        for &i in &passed {
            let [before, after] = neighbours(&control, i, closed);
            control[i] = (6.0 * nodes[i] - before - after) * 0.25;
        }
    }
    control
}

fn split_cubic(points: &[DVec4], closed: bool) -> Vec<DVec4> {
    let n = points.len();
    let mut split = Vec::with_capacity(2 * n);
    for i in 0..n {
        let [before, after] = neighbours(points, i, closed);
        split.push((before + 6.0 * points[i] + after) * 0.125);
        if closed || i + 1 < n {
            split.push((points[i] + after) * 0.5);
        }
    }
    split
}

fn limits_cubic(points: &[DVec4], closed: bool) -> Vec<DVec4> {
    (0..points.len())
        .map(|i| {
            let [before, after] = neighbours(points, i, closed);
            (before + 4.0 * points[i] + after) * (1.0 / 6.0)
        })
        .collect()
}

/// Puts a new point between each two, see [`between`].
fn split_four_point(points: &[DVec4], closed: bool) -> Vec<DVec4> {
    let mut split = Vec::with_capacity(2 * points.len());
    for (i, &point) in points.iter().enumerate() {
        split.push(point);
        if closed || i + 1 < points.len() {
            split.push(between(points, i, closed));
        }
    }
    split
}

/// Returns the point in the middle of the cubic through the four points around the step from i to
/// i + 1; at the ends of an open curve through the first or the last four, or as many as there are.
fn between(points: &[DVec4], i: usize, closed: bool) -> DVec4 {
    let n = points.len();
    if closed {
        let [a, b, c, d] = [i + n - 1, i, i + 1, i + 2].map(|j| points[j % n]);
        return (9.0 * (b + c) - (a + d)) * 0.0625;
    }
    // From the end nearer to the new point.
    let from_end = |at: &dyn Fn(usize) -> DVec4| match n {
        2 => (at(0) + at(1)) * 0.5,
        3 => (3.0 * at(0) + 6.0 * at(1) - at(2)) * 0.125,
        _ => (5.0 * at(0) + 15.0 * at(1) - 5.0 * at(2) + at(3)) * 0.0625,
    };
    match i {
        0 => from_end(&|j| points[j]),
        i if i + 2 == n => from_end(&|j| points[n - 1 - j]),
        i => (9.0 * (points[i] + points[i + 1]) - (points[i - 1] + points[i + 2])) * 0.0625,
    }
}

/// Refines a curve by cutting corners. The quadratic B-spline touches the middle of every side of
/// its control polygon: these are the limit points. A fixed node is the middle of a side that
/// stands in its place, with the length and direction of the side that cutting its corner would
/// give; at the ends of an open curve that side has no length.
fn chaikin(
    nodes: &[DVec4],
    levels: u32,
    last: usize,
    closed: bool,
    fixed: &dyn Fn(usize) -> bool,
) -> Refined {
    let mut control = Vec::with_capacity(2 * nodes.len());
    // The parameter at each node, in halves of a side: on the middle of a side it is even.
    let mut halves = Vec::with_capacity(nodes.len());
    for (i, &node) in nodes.iter().enumerate() {
        if !fixed(i) {
            halves.push(2 * control.len() - 1);
            control.push(node);
            continue;
        }
        halves.push(2 * control.len());
        let [before, after] = neighbours(nodes, i, closed);
        let end = !closed && (i == 0 || i == last);
        let reach = if end {
            DVec4::ZERO
        } else {
            (after - before) * 0.125
        };
        control.extend([node - reach, node + reach]);
    }
    if closed {
        // The first node's second half ends the curve.
        halves.push(2 * control.len());
    }
    for _ in 0..levels {
        control = cut_corners(&control, closed);
    }
    let sides = if closed {
        control.len()
    } else {
        control.len() - 1
    };
    let mut points: Vec<DVec4> = (0..sides)
        .map(|i| (control[i] + control[(i + 1) % control.len()]) * 0.5)
        .collect();
    if closed {
        points.push(points[0]);
    }
    // The node before the middle of each segment, in 2^(level+1)-ths of a side.
    let mut span = 0;
    let spans = (0..points.len() - 1).map(|i| {
        while span + 1 < last && halves[span + 1] << levels <= 2 * i + 1 {
            span += 1;
        }
        span
    });
    Refined {
        spans: spans.collect(),
        at_nodes: (0..=last)
            .map(|i| fixed(i).then_some((halves[i] / 2) << levels))
            .collect(),
        points,
    }
}

/// Chaikin's step. The first side of a closed polygon stays the one whose middle the curve begins
/// at.
fn cut_corners(control: &[DVec4], closed: bool) -> Vec<DVec4> {
    let n = control.len();
    let sides = if closed { n } else { n - 1 };
    let mut cut = Vec::with_capacity(2 * n);
    for i in 0..sides {
        let (a, b) = (control[i], control[(i + 1) % n]);
        cut.extend([(3.0 * a + b) * 0.25, (a + 3.0 * b) * 0.25]);
    }
    cut
}
