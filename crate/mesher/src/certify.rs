//! Proof that a triangle is near the surface, and looks the same way.
//!
//! Let a triangle have the unit normal n, let its grid of m² equal triangles have circles of radius ρ around them, and let C bound the
//! curvature of F within ε of the triangle. Then |F − T| on it is at most its largest value at the vertices of the grid plus
//! C·ρ²/2, and −∇F·n within ε of it is at least its least value at those vertices less C·(ρ + ε). If that is a positive number s,
//! the line of steepest ascent or descent from any point of the triangle meets the surface after |F − T|/s, if that is not
//! above ε.
//!
//! A closed mesh of such triangles that was made from an isotopic one by changes of such triangles covers each point of the
//! surface exactly once: along those lines it is mapped to the surface with positive orientation and degree 1. So it is
//! isotopic to the surface, does not cut itself, and no point of the surface is farther from it than ε.

use crate::space::{SLACK, Space};
use field::{Ball, Jet, THRESHOLD};
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

/// Edges of the grid's triangles are this share of the triangle's.
const GRID: usize = 3;

/// The largest distance of a triangle from the surface, as proved; `None` if it is not proved to be at most the tolerance.
pub fn distance(space: &Space<'_>, corners: [&Vertex; 3], tolerance: f64) -> Option<f64> {
    let positions = corners.map(|v| v.position);
    let [a, b, c] = positions;
    let normal = (b - a).cross(c - a).try_normalize()?;
    let steepness = |gradient: DVec3| -gradient.dot(normal);
    let mut highest = corners.iter().map(|v| v.value.abs()).fold(0.0, f64::max);
    let mut steep = corners.iter().map(|v| steepness(v.gradient)).fold(f64::INFINITY, f64::min);
    if !(steep > 0.0 && highest <= tolerance * steep) {
        return None;
    }
    let Ball { center, radius } = ball(&positions);
    let reach = Ball {
        center,
        radius: radius + tolerance,
    };
    let part = space.part_for(reach);
    let curvature = space.enclose(part, reach).curvature;
    if !curvature.is_finite() {
        return None;
    }
    let bound = |highest: f64, steep: f64, share: f64| {
        let radius = radius * share;
        let steep = steep - curvature * (radius + tolerance) - SLACK;
        let off = highest + 0.5 * curvature * radius * radius + SLACK;
        (steep > 0.0 && off <= tolerance * steep).then(|| off / steep)
    };
    if let Some(distance) = bound(highest, steep, 1.0) {
        return Some(distance);
    }
    // Without hope even if all went well at the vertices of the grid.
    let share = 1.0 / GRID as f64;
    bound(highest, steep, share)?;
    for i in 0..=GRID {
        for j in 0..=GRID - i {
            let k = GRID - i - j;
            if [i, j, k].contains(&GRID) {
                continue;
            }
            let [u, v, w] = [i, j, k].map(|n| n as f64 * share);
            let vertex = Vertex::new(a * u + b * v + c * w, &space.jet(part, a * u + b * v + c * w));
            highest = highest.max(vertex.value.abs());
            steep = steep.min(steepness(vertex.gradient));
            bound(highest, steep, share)?;
        }
    }
    bound(highest, steep, share)
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
