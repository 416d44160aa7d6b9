//! Cages: coarse closed meshes around the pieces of a skeleton, whose vertices are rays.

use core::f64::consts::TAU;
use field::Skeleton;
use glam::DVec3;
use mesh::TriangleMesh;
use scene::{Form, Scene, Shape, Surface};
use std::collections::BTreeMap;

/// Rays of a ring around a line.
const AROUND: usize = 6;
/// Rays end at so many radii from the skeleton …
const REACH: f64 = 4.0;
/// … and, where lines branch or balls may be inside others, at so many.
const SHORT: f64 = 2.5;
/// Steps of a search along a ray, in radii.
const STEP: f64 = 0.5;
/// Largest angle between two straight parts of an arc or a curve, radians.
const TURN: f64 = 0.6;
/// Most parts of an arc or a curve.
const MOST_PARTS: usize = 64;

/// A ray from a skeleton along which a vertex moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spoke {
    /// A point of the skeleton.
    pub origin: DVec3,
    /// A unit vector.
    pub direction: DVec3,
    /// Length of the steps in which the surface is searched, > 0.
    pub step: f64,
    /// Where the search ends.
    pub reach: f64,
}

impl Spoke {
    /// Returns the radius of the flesh around the ray's origin.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.step / STEP
    }
}

/// A closed mesh of rays.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cage {
    /// Its vertices.
    pub spokes: Vec<Spoke>,
    /// Triangles, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// The lines that it is around, and lines of other cages beside. A ray ends where another line
    /// is nearer: its surface is met by rays of that line, and beyond, edges between rays would be
    /// webs across a bend or between limbs.
    pub lines: Vec<Line>,
}

/// A straight part of a skeleton.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Its ends.
    pub ends: [DVec3; 2],
    /// Radii there.
    pub radii: [f64; 2],
    /// Whether it belongs to the cage.
    pub is_own: bool,
}

impl Line {
    /// Distance of a point in radii.
    fn distance(&self, point: DVec3) -> f64 {
        let [a, b] = self.ends;
        let along = b - a;
        let share = (point - a).dot(along) / along.length_squared();
        let share = if share > 0.0 { share.min(1.0) } else { 0.0 };
        let radius = self.radii[0] + share * (self.radii[1] - self.radii[0]);
        (a + along * share).distance(point) / radius
    }
}

/// How much nearer another line must be to end a ray, as a share.
const NEARER: f64 = 1e-6;
/// Halvings of the interval in which a ray ends.
const HALVINGS: usize = 20;

/// A point of a line, with the radius around it.
type Place = (DVec3, f64);

fn spoke(origin: DVec3, direction: DVec3, radius: f64, reach: f64) -> Spoke {
    Spoke {
        origin,
        direction,
        step: STEP * radius,
        reach: reach * radius,
    }
}

impl Cage {
    /// Where a ray of the cage ends: at its reach, or where another line is nearer than those that
    /// it starts from.
    #[must_use]
    pub fn end(&self, spoke: &Spoke) -> f64 {
        let is_start = |line: &Line| line.is_own && line.distance(spoke.origin) < 1e-6;
        let starts: Vec<&Line> = self.lines.iter().filter(|line| is_start(line)).collect();
        let is_near = |line: &&Line| {
            let [a, b] = line.ends;
            let room = 2.0 * spoke.reach + 0.5 * a.distance(b);
            a.midpoint(b).distance_squared(spoke.origin) < room * room && !is_start(line)
        };
        let others: Vec<&Line> = self.lines.iter().filter(is_near).collect();
        if starts.is_empty() || others.is_empty() {
            return spoke.reach;
        }
        let least = |lines: &[&Line], point: DVec3| {
            let distances = lines.iter().map(|line| line.distance(point));
            distances.fold(f64::INFINITY, f64::min)
        };
        let is_beyond = |t: f64| {
            let point = spoke.origin + spoke.direction * t;
            least(&others, point) < (1.0 - NEARER) * least(&starts, point)
        };
        let (mut low, mut high) = (0.0, 0.0);
        while !is_beyond(high) {
            if high >= spoke.reach {
                return spoke.reach;
            }
            (low, high) = (high, (high + 0.5 * spoke.step).min(spoke.reach));
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            *(if is_beyond(middle) {
                &mut high
            } else {
                &mut low
            }) = middle;
        }
        low
    }

    /// The cages around straight lines, each given by its two ends with their radii: lines that
    /// meet end to end are one piece, and where three or more meet, pieces end.
    #[must_use]
    pub fn around_lines(lines: &[[Place; 2]]) -> Vec<Self> {
        let chains = chains(lines);
        let lines_of = |(places, is_closed, _): &(Vec<Place>, bool, [End; 2])| -> Vec<Line> {
            let next = places
                .iter()
                .skip(1)
                .chain(places.first().filter(|_| *is_closed));
            let line = |(a, b): (&Place, &Place)| Line {
                ends: [a.0, b.0],
                radii: [a.1, b.1],
                is_own: true,
            };
            places.iter().zip(next).map(line).collect()
        };
        let all: Vec<Vec<Line>> = chains.iter().map(lines_of).collect();
        let mut cages = Vec::new();
        for (i, (places, is_closed, ends)) in chains.iter().enumerate() {
            let Some(mut cage) = tube(places, *is_closed, *ends) else {
                continue;
            };
            // Those that meet an end of it.
            let (first, last) = (places[0].0, places[places.len() - 1].0);
            let meets = |line: &&Line| line.ends.contains(&first) || line.ends.contains(&last);
            let others = all.iter().enumerate().filter(|(j, _)| *j != i);
            let others = others.flat_map(|(_, lines)| lines.iter().filter(meets));
            let others = others.map(|line| Line {
                is_own: false,
                ..*line
            });
            cage.lines = all[i].iter().copied().chain(others).collect();
            cages.push(cage);
        }
        cages
    }

    /// The cage around a point: an icosahedron.
    #[must_use]
    pub fn around_point(center: DVec3, radius: f64) -> Self {
        let phi = 0.5 * (1.0 + 5.0_f64.sqrt());
        let corners: Vec<DVec3> = (0..12)
            .map(|i| {
                let sign = |bit: usize| if i & bit == 0 { 1.0 } else { -1.0 };
                let (one, golden) = (sign(1), sign(2) * phi);
                let corner = match i / 4 {
                    0 => DVec3::new(0.0, one, golden),
                    1 => DVec3::new(one, golden, 0.0),
                    _ => DVec3::new(golden, 0.0, one),
                };
                corner.normalize()
            })
            .collect();
        let near = |i: usize, j: usize| corners[i].dot(corners[j]) > 0.4;
        let mut triangles = Vec::new();
        for i in 0..12 {
            for j in i + 1..12 {
                for k in j + 1..12 {
                    if near(i, j) && near(j, k) && near(k, i) {
                        let is_outward = corners[i].dot(corners[j].cross(corners[k])) > 0.0;
                        let face = if is_outward { [i, j, k] } else { [i, k, j] };
                        triangles.push(face.map(|i| i as u32));
                    }
                }
            }
        }
        let spokes = corners.iter().map(|d| spoke(center, *d, radius, SHORT));
        Self {
            spokes: spokes.collect(),
            triangles,
            lines: Vec::new(),
        }
    }

    /// The cage around a flat face with holes: three rays from each corner, to both sides and
    /// outward. `None` if it has no area.
    #[must_use]
    pub fn around_face(rings: &[Vec<DVec3>], radius: f64) -> Option<Self> {
        let face = crate::solids::Face::new(rings)?;
        let mut cage = Self::default();
        let mut start = 0;
        for ring in &face.rings {
            let n = ring.len();
            for i in 0..n {
                let [before, own, after] = [i + n - 1, i, i + 1].map(|k| ring[k % n]);
                // Rings turn left around the face: outside is on the right.
                let sides = [own - before, after - own];
                let out: DVec3 = sides
                    .iter()
                    .map(|s| s.cross(face.normal).normalize_or_zero())
                    .sum();
                let out = out.normalize_or(sides[1].cross(face.normal).normalize_or_zero());
                for direction in [face.normal, out, -face.normal] {
                    cage.spokes.push(spoke(own, direction, radius, REACH));
                }
                let [a, b] = [start + i, start + (i + 1) % n].map(|k| 3 * k as u32);
                for k in 0..2 {
                    cage.triangles.push([a + k, a + k + 1, b + k + 1]);
                    cage.triangles.push([a + k, b + k + 1, b + k]);
                }
            }
            start += n;
        }
        for [a, b, c] in &face.triangles {
            cage.triangles.push([3 * a, 3 * b, 3 * c]);
            cage.triangles.push([3 * a + 2, 3 * c + 2, 3 * b + 2]);
        }
        Some(cage)
    }

    /// The cage of a closed mesh: a ray outwards from each vertex. `None` if it is open.
    #[must_use]
    pub fn around_mesh(mesh: &TriangleMesh, radius: f64) -> Option<Self> {
        let topology = mesh::Topology::of(mesh).ok()?;
        if !topology.is_closed_manifold() {
            return None;
        }
        let mut normals = vec![DVec3::ZERO; mesh.positions.len()];
        for (i, triangle) in mesh.triangles.iter().enumerate() {
            let [a, b, c] = mesh.corners(i);
            for v in triangle {
                normals[*v as usize] += (b - a).cross(c - a);
            }
        }
        let turn = if mesh.signed_volume() < 0.0 {
            -1.0
        } else {
            1.0
        };
        let rays = mesh.positions.iter().zip(&normals);
        let mut triangles = mesh.triangles.clone();
        if turn < 0.0 {
            triangles.iter_mut().for_each(|t| t.swap(1, 2));
        }
        Some(Self {
            spokes: rays
                .map(|(p, n)| spoke(*p, (*n * turn).normalize_or(DVec3::Z), radius, REACH))
                .collect(),
            triangles,
            lines: Vec::new(),
        })
    }

    /// The cages around the skeletons of a body's surface. Skeletons without an end (planes), and
    /// those that carve, have none.
    #[must_use]
    pub fn of_surface(scene: &Scene, surface: &Surface) -> Vec<Self> {
        let mut elements = surface.element().to_vec();
        elements.sort_unstable();
        elements.dedup();
        let mut lines: Vec<[Place; 2]> = Vec::new();
        let mut others = Vec::new();
        for element in elements {
            let element = &scene.elements[element as usize];
            let flesh = element.flesh.and_then(|i| scene.flesh.get(i as usize));
            if flesh.is_some_and(|flesh| flesh.strength < 0.0) {
                continue;
            }
            let radius = scene.radius(element);
            match &element.shape {
                // Faces that are lit as if they were curved are drawn by themselves.
                Shape::Bone(bone) if bone.normals.is_some() => {}
                Shape::Bone(bone) => match &bone.skeleton {
                    Skeleton::Point { center } => others.push(Self::around_point(*center, radius)),
                    Skeleton::Segment { base, apex } => {
                        let [start, end] = bone.radii(radius);
                        lines.push([(*base, start), (*apex, end)]);
                    }
                    Skeleton::Triangle { corners } => {
                        others.extend(Self::around_face(&[corners.to_vec()], radius));
                    }
                    Skeleton::Polygon { rings } => others.extend(Self::around_face(rings, radius)),
                    Skeleton::Plane { .. } => {}
                    line => lines.extend(chords(line, radius)),
                },
                Shape::Function(function) => {
                    let place = |p: DVec3| function.to_world.transform_point3(p);
                    let growth = function.growth();
                    match &function.form {
                        Form::Skeleton(curves) => {
                            let world = |(p, r): Place| (place(p), r * growth);
                            lines.extend(curves.pieces().map(|ends| ends.map(world)));
                        }
                        Form::Mesh(mesh) => {
                            let positions = mesh.positions.iter().map(|p| place(*p)).collect();
                            let own = TriangleMesh::new(positions, mesh.triangles.clone());
                            let size = own.bounds().size().max_element();
                            others.extend(Self::around_mesh(&own, 0.05 * size));
                        }
                        // Whatever else is drawn as balls in drafts.
                        _ => {
                            let balls = function.draft();
                            others.extend(balls.iter().filter_map(
                                |shape| match shape.skeleton()? {
                                    Skeleton::Point { center } => {
                                        Some(Self::around_point(*center, shape.radius()))
                                    }
                                    _ => None,
                                },
                            ));
                        }
                    }
                }
                Shape::Box(_) | Shape::Quadric(_) => {}
            }
        }
        let mut cages = Self::around_lines(&lines);
        cages.extend(others);
        let is_sound = |s: &Spoke| {
            s.origin.is_finite() && s.direction.is_finite() && s.step > 0.0 && s.reach.is_finite()
        };
        cages.retain(|cage| cage.spokes.iter().all(is_sound));
        cages
    }
}

/// Straight parts of an arc or a curve.
fn chords(line: &Skeleton, radius: f64) -> Vec<[Place; 2]> {
    let (turn, least) = match line {
        Skeleton::Arc { angle, .. } => (*angle, 2),
        _ => {
            let control: Vec<DVec3> = line.landmarks().iter().map(|(p, _)| *p).collect();
            let sides: Vec<DVec3> = control.windows(2).map(|w| w[1] - w[0]).collect();
            let turns = sides.windows(2).map(|w| w[0].angle_between(w[1]));
            (turns.filter(|a| a.is_finite()).sum(), 3)
        }
    };
    let count = ((turn / TURN).ceil() as usize).clamp(least, MOST_PARTS);
    let is_closed = matches!(line, Skeleton::Arc { angle, .. } if *angle >= TAU * (1.0 - 1e-9));
    let point = |i: usize| {
        let i = if is_closed { i % count } else { i };
        (line.at(i as f64 / count as f64), radius)
    };
    (0..count).map(|i| [point(i), point(i + 1)]).collect()
}

/// What is at an end of a chain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum End {
    /// Nothing.
    Free,
    /// Other chains.
    Branch,
}

/// Maximal chains of lines, with whether each is a ring, and what is at its ends.
fn chains(lines: &[[Place; 2]]) -> Vec<(Vec<Place>, bool, [End; 2])> {
    let key = |p: DVec3| (p + 0.0).to_array().map(f64::to_bits);
    let mut nodes: BTreeMap<[u64; 3], u32> = BTreeMap::new();
    let mut at: Vec<Vec<usize>> = Vec::new();
    let mut ends = Vec::new();
    for (i, line) in lines.iter().enumerate() {
        let own = line.map(|(p, _)| {
            let next = nodes.len() as u32;
            *nodes.entry(key(p)).or_insert(next) as usize
        });
        at.resize(nodes.len(), Vec::new());
        if own[0] != own[1] {
            own.iter().for_each(|node| at[*node].push(i));
        }
        ends.push(own);
    }
    let mut is_used = vec![false; lines.len()];
    let mut chains = Vec::new();
    let walk = |start: usize, first: usize, is_used: &mut Vec<bool>| {
        let mut places = Vec::new();
        let (mut node, mut line) = (start, first);
        loop {
            is_used[line] = true;
            let side = usize::from(ends[line][0] != node);
            places.push(lines[line][side]);
            node = ends[line][1 - side];
            let next = at[node].iter().copied().find(|i| !is_used[*i]);
            match next.filter(|_| at[node].len() == 2) {
                Some(next) => line = next,
                None => {
                    let is_closed = node == start && at[node].len() == 2;
                    if !is_closed {
                        places.push(lines[line][1 - side]);
                    }
                    let end = |node: usize| match at[node].len() {
                        1 => End::Free,
                        _ => End::Branch,
                    };
                    return (places, is_closed, [end(start), end(node)]);
                }
            }
        }
    };
    for (node, lines) in at.iter().enumerate() {
        if lines.len() != 2 {
            for line in lines {
                if !is_used[*line] {
                    chains.push(walk(node, *line, &mut is_used));
                }
            }
        }
    }
    // What is left are rings.
    for (line, own) in ends.iter().enumerate() {
        if !is_used[line] && own[0] != own[1] {
            chains.push(walk(own[0], line, &mut is_used));
        }
    }
    chains
}

/// A chain without joints that hardly change it.
fn coarser(places: &[Place], is_closed: bool) -> Vec<Place> {
    let mut kept: Vec<Place> = Vec::new();
    for (i, place) in places.iter().enumerate() {
        let is_end = !is_closed && (i == 0 || i + 1 == places.len());
        let keep = match (kept.last(), places.get(i + 1)) {
            (Some((before, radius)), Some((after, _))) if !is_end => {
                let [one, other] = [place.0 - *before, *after - place.0];
                one.length() > *radius || one.angle_between(other) > 0.5 * TURN
            }
            _ => true,
        };
        if keep {
            kept.push(*place);
        }
    }
    if is_closed && kept.len() < 3 {
        return places.to_vec();
    }
    kept
}

/// A tube around a chain.
fn tube(places: &[Place], is_closed: bool, ends: [End; 2]) -> Option<Cage> {
    let places = coarser(places, is_closed);
    let n = places.len();
    // Two lines with the same ends are one limb.
    let is_closed = is_closed && n > 2;
    if n < 2 {
        return None;
    }
    let fair = places.iter().map(|p| p.1).fold(0.0, f64::max);
    let lines: Vec<DVec3> = (0..if is_closed { n } else { n - 1 })
        .map(|i| (places[(i + 1) % n].0 - places[i].0).normalize_or_zero())
        .collect();
    let mut cage = Cage::default();
    let mut across = lines.first()?.any_orthonormal_vector();
    let mut starts = Vec::new();
    for (i, &(center, radius)) in places.iter().enumerate() {
        let before = if is_closed {
            lines[(i + n - 1) % n]
        } else {
            lines[i.saturating_sub(1)]
        };
        let after = lines[i.min(lines.len() - 1)];
        let tangent = (before + after).normalize_or(after);
        // Carried along without a twist.
        let flat = across - tangent * across.dot(tangent);
        across = flat
            .try_normalize()
            .unwrap_or_else(|| tangent.any_orthonormal_vector());
        let other = tangent.cross(across);
        let end = match i {
            0 if !is_closed => Some(ends[0]),
            i if i + 1 == n && !is_closed => Some(ends[1]),
            _ => None,
        };
        let reach = if end == Some(End::Branch) {
            SHORT
        } else {
            REACH
        };
        // Tips have no radius.
        let radius = radius.max(0.05 * fair);
        starts.push(cage.spokes.len() as u32);
        for k in 0..AROUND {
            let (sine, cosine) = libm::sincos(TAU * k as f64 / AROUND as f64);
            cage.spokes
                .push(spoke(center, across * cosine + other * sine, radius, reach));
        }
    }
    let ring = |i: usize, k: usize| starts[i] + (k % AROUND) as u32;
    let mut join = |i: usize, j: usize, shift: usize| {
        for k in 0..AROUND {
            let [a, b] = [ring(i, k), ring(i, k + 1)];
            let [c, d] = [ring(j, k + shift), ring(j, k + 1 + shift)];
            cage.triangles.extend([[a, b, d], [a, d, c]]);
        }
    };
    for i in 0..n - 1 {
        join(i, i + 1, 0);
    }
    if is_closed {
        // The frame comes back turned.
        let (last, first) = (starts[n - 1] as usize, starts[0] as usize);
        let closeness = |shift: usize| -> f64 {
            let pair = |k: usize| {
                let [a, b] = [last + k, first + (k + shift) % AROUND];
                cage.spokes[a].direction.dot(cage.spokes[b].direction)
            };
            (0..AROUND).map(pair).sum()
        };
        let best = (0..AROUND).max_by(|a, b| closeness(*a).total_cmp(&closeness(*b)));
        let shift = best.unwrap_or(0);
        for k in 0..AROUND {
            let [a, b] = [ring(n - 1, k), ring(n - 1, k + 1)];
            let [c, d] = [ring(0, k + shift), ring(0, k + 1 + shift)];
            cage.triangles.extend([[a, b, d], [a, d, c]]);
        }
        return Some(cage);
    }
    for (end, i, line) in [
        (ends[0], 0, -lines[0]),
        (ends[1], n - 1, lines[lines.len() - 1]),
    ] {
        let (center, radius) = places[i];
        let reach = if end == End::Branch { STEP } else { REACH };
        let tip = cage.spokes.len() as u32;
        cage.spokes
            .push(spoke(center, line, radius.max(0.05 * fair), reach));
        for k in 0..AROUND {
            let [a, b] = [ring(i, k), ring(i, k + 1)];
            cage.triangles
                .push(if i == 0 { [tip, b, a] } else { [tip, a, b] });
        }
    }
    Some(cage)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A pair of lines between the same ends is no ring, and has a cage.
    #[test]
    fn lines_with_the_same_ends_are_one_limb() {
        let [a, b] = [(DVec3::ZERO, 0.1), (DVec3::X, 0.2)];
        let cages = Cage::around_lines(&[[a, b], [b, a]]);
        let [cage] = &cages[..] else {
            panic!("{} cages", cages.len());
        };
        let ends = cage.spokes.iter();
        let ends = ends.map(|s| s.origin + s.direction * s.radius());
        let mesh = TriangleMesh::new(ends.collect(), cage.triangles.clone());
        let topology = mesh::Topology::of(&mesh).expect("it has triangles");
        assert!(topology.is_closed_manifold());
        assert!(mesh.signed_volume() > 0.03);
    }
}
