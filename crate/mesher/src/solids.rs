//! Hard shapes as triangles within a tolerance of the surface. Polygons have the areas of the
//! circles that they stand for, and balls their volume: corners lie outside and sides inside.

use core::f64::consts::{PI, TAU};
use field::Skeleton;
use glam::DVec3;
use manifold_rust::linalg::Vec2;
use manifold_rust::polygon::triangulate;
use manifold_rust::types::Polygons;
use mesh::{Aabb, TriangleMesh};
use scene::{Ends, Shape};

/// Most segments of a circle.
const MOST_SEGMENTS: usize = 2048;
/// Fewest segments of a circle. Neighbouring sides then differ by less than 30°, so that files
/// shade them smoothly.
const LEAST_SEGMENTS: usize = 13;

/// A hard shape as triangles.
#[derive(Clone, Debug, Default)]
pub struct Solid {
    /// Closed shells that may overlap: the shape is their union.
    pub shells: Vec<TriangleMesh>,
    /// Surfaces that are open by nature.
    pub sheets: Vec<TriangleMesh>,
}

impl Solid {
    fn closed(mesh: TriangleMesh) -> Self {
        Self {
            shells: vec![mesh],
            sheets: Vec::new(),
        }
    }

    fn open(mesh: TriangleMesh) -> Self {
        Self {
            shells: Vec::new(),
            sheets: vec![mesh],
        }
    }
}

/// Tessellates a shape with a radius that may overrule its own, and cuts a plane off by a box.
/// Quadrics are left out: they are level sets.
pub fn tessellate(shape: &Shape, radius: f64, tolerance: f64, limits: &Aabb) -> Solid {
    let bone = match shape {
        Shape::Bone(bone) => bone,
        Shape::Box(cuboid) => return Solid::closed(parallelepiped(cuboid.center, cuboid.axes)),
        Shape::Function(function) => {
            let parts = function.draft();
            return union(
                parts.iter().map(|part| (part, part.radius())),
                tolerance,
                limits,
            );
        }
        Shape::Quadric(_) => return Solid::default(),
    };
    match bone.skeleton {
        Skeleton::Point { center } => Solid::closed(ball(center, radius, tolerance)),
        Skeleton::Segment { base, apex } => {
            let has_lids = bone.ends != Ends::Open;
            let mesh = cone([base, apex], bone.radii(radius), tolerance, has_lids);
            if has_lids {
                Solid::closed(mesh)
            } else {
                Solid::open(mesh)
            }
        }
        Skeleton::Arc {
            center,
            u,
            v,
            radius: sweep,
            angle,
        } => arc(center, [u, v], sweep, angle, radius, tolerance),
        Skeleton::Triangle { corners } => match &bone.normals {
            Some(normals) => {
                let mut mesh = TriangleMesh::new(corners.to_vec(), vec![[0, 1, 2]]);
                mesh.normals = Some(normals.to_vec());
                Solid::open(mesh)
            }
            None => prism(&[corners.to_vec()], radius),
        },
        Skeleton::Polygon { ref rings } => prism(rings, radius),
        Skeleton::Plane { point, normal } => plane(point, normal, radius, limits),
        // The balls and cylinders that pictures show.
        _ => {
            let parts = shape.parts(radius);
            let mut solid = union(parts.iter().map(|part| (part, radius)), tolerance, limits);
            // Pieces of no length have none.
            solid.shells.retain(|mesh| mesh.signed_volume() > 0.0);
            solid
        }
    }
}

/// Tessellates shapes with their radii.
fn union<'a>(
    parts: impl Iterator<Item = (&'a Shape, f64)>,
    tolerance: f64,
    limits: &Aabb,
) -> Solid {
    let mut all = Solid::default();
    for (part, radius) in parts {
        let own = tessellate(part, radius, tolerance, limits);
        all.shells.extend(own.shells);
        all.sheets.extend(own.sheets);
    }
    all
}

/// Segments of a circle such that chords are within a tolerance.
fn segments(radius: f64, tolerance: f64) -> usize {
    let half = libm::acos((1.0 - tolerance / radius).max(0.0));
    ((PI / half).ceil() as usize).clamp(LEAST_SEGMENTS, MOST_SEGMENTS)
}

/// Factor by which the corners of a polygon, at this angle from each other about the middle, are
/// farther from it than the circle of the same area.
fn growth(angle: f64) -> f64 {
    let sine = libm::sin(angle);
    // Not so for an angle of 0.
    let is_sound = sine > 0.0;
    if is_sound { (angle / sine).sqrt() } else { 1.0 }
}

/// The corners of a polygon of a circle's area.
fn circle(center: DVec3, [x, y]: [DVec3; 2], radius: f64, count: usize) -> Vec<DVec3> {
    let radius = radius * growth(TAU / count as f64);
    let point = |i: usize| {
        let (sine, cosine) = libm::sincos(TAU * i as f64 / count as f64);
        center + radius * (x * cosine + y * sine)
    };
    (0..count).map(point).collect()
}

/// Two unit vectors across a direction; with it they are right-handed.
fn across(direction: DVec3) -> [DVec3; 2] {
    let x = direction.any_orthonormal_vector();
    [x, direction.cross(x)]
}

/// Triangles between rings, each a single point or `n` points that turn counter-clockwise seen from
/// the last ring; the last is joined with the first if `is_closed`.
fn skin(rings: &[Vec<DVec3>], is_closed: bool) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    let mut starts = Vec::new();
    for ring in rings {
        starts.push(mesh.positions.len() as u32);
        mesh.positions.extend(ring);
    }
    let pairs = if is_closed {
        rings.len()
    } else {
        rings.len().saturating_sub(1)
    };
    for i in 0..pairs {
        let j = (i + 1) % rings.len();
        let count = rings[i].len().max(rings[j].len());
        for k in 0..count {
            let at = |ring: usize, k: usize| starts[ring] + (k % rings[ring].len()) as u32;
            let (a, b) = (at(i, k), at(i, k + 1));
            let (c, d) = (at(j, k), at(j, k + 1));
            if a != b {
                mesh.triangles.push([a, b, d]);
            }
            if c != d {
                mesh.triangles.push([a, d, c]);
            }
        }
    }
    mesh
}

/// A ball: an icosahedron whose faces are divided and put on a sphere a little larger.
fn ball(center: DVec3, radius: f64, tolerance: f64) -> TriangleMesh {
    // The largest triangle's circle is 0.607·1.26 of the radius over the number of divisions.
    let sag = (tolerance / radius).min(1.0);
    let widest = (2.0 * sag - sag * sag).sqrt();
    let n = ((0.77 / widest).ceil() as usize).clamp(2, 512);
    let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
    let corners: Vec<DVec3> = (0..12)
        .map(|i| {
            let sign = |bit: usize| if i & bit == 0 { 1.0 } else { -1.0 };
            let (one, phi) = (sign(1), sign(2) * golden);
            match i / 4 {
                0 => DVec3::new(0.0, one, phi),
                1 => DVec3::new(one, phi, 0.0),
                _ => DVec3::new(phi, 0.0, one),
            }
        })
        .collect();
    let mut mesh = TriangleMesh::default();
    let mut of_key = std::collections::BTreeMap::new();
    let near = |i: usize, j: usize| corners[i].distance_squared(corners[j]) < 4.1;
    for i in 0..12 {
        for j in i + 1..12 {
            for k in j + 1..12 {
                if !(near(i, j) && near(j, k) && near(k, i)) {
                    continue;
                }
                let is_outward = corners[i].dot(corners[j].cross(corners[k])) > 0.0;
                let face = if is_outward { [i, j, k] } else { [i, k, j] };
                // A vertex is known by its corners with their weights.
                let mut vertex = |weights: [usize; 3]| {
                    let mut key = [(0, 0); 3];
                    for (slot, (corner, weight)) in key.iter_mut().zip(face.iter().zip(weights)) {
                        *slot = (weight, if weight == 0 { 0 } else { *corner });
                    }
                    key.sort_unstable_by_key(|(weight, corner)| (*weight == 0, *corner));
                    *of_key.entry(key).or_insert_with(|| {
                        let sum: DVec3 = key.iter().map(|(w, c)| corners[*c] * *w as f64).sum();
                        mesh.positions.push(center + sum.normalize() * radius);
                        mesh.positions.len() as u32 - 1
                    })
                };
                for a in 0..n {
                    for b in 0..n - a {
                        let p = |x: usize, y: usize| [n - x - y, x, y];
                        let [q, r, s] = [p(a, b), p(a + 1, b), p(a, b + 1)].map(&mut vertex);
                        mesh.triangles.push([q, r, s]);
                        if a + b + 2 <= n {
                            let t = vertex(p(a + 1, b + 1));
                            mesh.triangles.push([r, t, s]);
                        }
                    }
                }
            }
        }
    }
    let whole = 2.0 / 3.0 * TAU * radius * radius * radius;
    let moved = mesh.positions.iter().map(|p| *p - center).collect();
    let volume = TriangleMesh::new(moved, mesh.triangles.clone()).signed_volume();
    if volume > 0.0 {
        let growth = libm::cbrt(whole / volume);
        for p in &mut mesh.positions {
            *p = center + (*p - center) * growth;
        }
    }
    mesh
}

/// A cone or cylinder, with lids or without.
fn cone([base, apex]: [DVec3; 2], radii: [f64; 2], tolerance: f64, has_lids: bool) -> TriangleMesh {
    let axes = across((apex - base).normalize_or_zero());
    let count = segments(radii[0].max(radii[1]), tolerance);
    let mut rings = Vec::new();
    for (center, radius) in [(base, radii[0]), (apex, radii[1])] {
        let lid = vec![center];
        if radius == 0.0 {
            rings.push(lid);
            continue;
        }
        let ring = circle(center, axes, radius, count);
        let is_first = rings.is_empty();
        if has_lids && is_first {
            rings.push(lid.clone());
        }
        rings.push(ring);
        if has_lids && !is_first {
            rings.push(lid);
        }
    }
    skin(&rings, false)
}

fn arc(
    center: DVec3,
    [u, v]: [DVec3; 2],
    sweep: f64,
    angle: f64,
    radius: f64,
    tolerance: f64,
) -> Solid {
    let axis = u.cross(v);
    let is_round = angle >= TAU * (1.0 - 1e-12);
    // Both directions add their part of the error.
    let along = segments(sweep + radius, 0.5 * tolerance);
    let count = segments(radius, 0.5 * tolerance);
    let steps = ((along as f64 * angle / TAU).ceil() as usize).max(if is_round { 3 } else { 1 });
    let step = angle / steps as f64;
    let disc = |i: usize| {
        let (sine, cosine) = libm::sincos(step * i as f64);
        let outward = (u * cosine + v * sine) * growth(step);
        (center + outward * sweep, [outward, -axis])
    };
    let ring = |i: usize| {
        let (center, axes) = disc(i);
        circle(center, axes, radius, count)
    };
    if radius < sweep * (1.0 - 1e-9) {
        let turned = |mut ring: Vec<DVec3>| {
            ring.reverse();
            ring
        };
        if is_round {
            let rings: Vec<_> = (0..steps).map(|i| turned(ring(i))).collect();
            return Solid::closed(outward(skin(&rings, true)));
        }
        let mut rings = vec![vec![disc(0).0]];
        rings.extend((0..=steps).map(|i| turned(ring(i))));
        rings.push(vec![disc(steps).0]);
        return Solid::closed(outward(skin(&rings, false)));
    }
    // The disc reaches over the axis: the union of wedges.
    let wedges = (0..steps).filter_map(|i| {
        let mut points = ring(i);
        points.extend(ring((i + 1) % if is_round { steps } else { steps + 1 }));
        crate::unite::convex_hull(&points)
    });
    Solid {
        shells: wedges.collect(),
        sheets: Vec::new(),
    }
}

/// Turns a closed mesh so that its volume is positive.
fn outward(mut mesh: TriangleMesh) -> TriangleMesh {
    if mesh.signed_volume() < 0.0 {
        mesh.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    }
    mesh
}

/// A flat polygon with holes, as triangles.
pub struct Face {
    /// Unit normal.
    pub normal: DVec3,
    /// The outer ring, which turns left around the normal, then the holes, which turn right.
    pub rings: Vec<Vec<DVec3>>,
    /// Triangles between the corners of all rings, counted in their order.
    pub triangles: Vec<[u32; 3]>,
}

impl Face {
    /// The face of an outer ring and holes; `None` if it has no area.
    pub fn new(rings: &[Vec<DVec3>]) -> Option<Self> {
        let outer = rings.first().filter(|ring| ring.len() >= 3)?;
        let area = |ring: &[DVec3]| -> DVec3 {
            let pairs = ring.windows(2);
            pairs.map(|w| (w[0] - ring[0]).cross(w[1] - ring[0])).sum()
        };
        let z = area(outer).try_normalize()?;
        let x = z.any_orthonormal_vector();
        let y = z.cross(x);
        let rings: Vec<Vec<DVec3>> = rings
            .iter()
            .enumerate()
            .filter(|(_, ring)| ring.len() >= 3)
            .map(|(i, ring)| {
                let mut ring = ring.clone();
                if (area(&ring).dot(z) > 0.0) != (i == 0) {
                    ring.reverse();
                }
                ring
            })
            .collect();
        // This one uses every corner of a side, also of those that lie on one line, so that prisms
        // are closed.
        let flat = |p: &DVec3| Vec2::new((*p - outer[0]).dot(x), (*p - outer[0]).dot(y));
        let polygons = rings.iter().map(|ring| ring.iter().map(flat).collect());
        let polygons: Polygons = polygons.collect();
        let triangles = triangulate(&polygons, -1.0, true);
        let triangles = triangles.iter().map(|t| [t.x, t.y, t.z].map(|i| i as u32));
        Some(Self {
            normal: z,
            triangles: triangles.collect(),
            rings,
        })
    }
}

/// A polygon with holes; a prism of twice the radius if that is not 0.
fn prism(rings: &[Vec<DVec3>], radius: f64) -> Solid {
    let Some(Face {
        normal,
        rings,
        triangles: face,
    }) = Face::new(rings)
    else {
        return Solid::default();
    };
    let corners: Vec<DVec3> = rings.iter().flatten().copied().collect();
    let mut mesh = TriangleMesh::default();
    if radius <= 0.0 {
        mesh.positions = corners;
        mesh.triangles = face;
        return Solid::open(mesh);
    }
    let count = corners.len() as u32;
    let lift = normal * radius;
    mesh.positions.extend(corners.iter().map(|p| *p + lift));
    mesh.positions.extend(corners.iter().map(|p| *p - lift));
    mesh.triangles.extend(&face);
    mesh.triangles.extend(
        face.iter()
            .map(|[a, b, c]| [a + count, c + count, b + count]),
    );
    let mut start = 0;
    for ring in &rings {
        let n = ring.len() as u32;
        for i in 0..n {
            let (a, b) = (start + i, start + (i + 1) % n);
            mesh.triangles.push([a, a + count, b + count]);
            mesh.triangles.push([a, b + count, b]);
        }
        start += n;
    }
    Solid::closed(mesh)
}

fn parallelepiped(center: DVec3, [x, y, z]: [DVec3; 3]) -> TriangleMesh {
    let ring = |z: DVec3| {
        vec![
            center + z - x - y,
            center + z + x - y,
            center + z + x + y,
            center + z - x + y,
        ]
    };
    let mut mesh = skin(&[ring(-z), ring(z)], false);
    mesh.triangles
        .extend([[0, 2, 1], [0, 3, 2], [4, 5, 6], [4, 6, 7]]);
    outward(mesh)
}

/// The part of a plane, or of a slab, in a box.
fn plane(point: DVec3, normal: DVec3, radius: f64, limits: &Aabb) -> Solid {
    let half = 0.5 * limits.size();
    if !(half.is_finite() && half.min_element() > 0.0) {
        return Solid::default();
    }
    let corners: Vec<DVec3> = (0..8)
        .map(|i| {
            let sign = |bit: usize| if i & bit == 0 { -1.0 } else { 1.0 };
            limits.center() + half * DVec3::new(sign(1), sign(2), sign(4))
        })
        .collect();
    // Where a plane meets the edges of the box.
    let section = |offset: f64| {
        let height = |p: DVec3| (p - point).dot(normal) - offset;
        let mut points = Vec::new();
        for i in 0..8_usize {
            for bit in [1, 2, 4] {
                let (p, q) = (corners[i], corners[i | bit]);
                let (a, b) = (height(p), height(q));
                if i & bit == 0 && (a < 0.0) != (b < 0.0) {
                    points.push(p.lerp(q, a / (a - b)));
                }
            }
        }
        points
    };
    if radius > 0.0 {
        let mut points = section(radius);
        points.extend(section(-radius));
        let is_within = |p: &DVec3| (*p - point).dot(normal).abs() < radius;
        points.extend(corners.iter().copied().filter(is_within));
        return Solid {
            shells: crate::unite::convex_hull(&points).into_iter().collect(),
            sheets: Vec::new(),
        };
    }
    let mut points = section(0.0);
    if points.len() < 3 {
        return Solid::default();
    }
    let center = points.iter().sum::<DVec3>() / points.len() as f64;
    let [x, y] = across(normal);
    let angle = |p: &DVec3| libm::atan2((*p - center).dot(y), (*p - center).dot(x));
    points.sort_by(|p, q| angle(p).total_cmp(&angle(q)));
    let fan = (1..points.len() as u32 - 1).map(|i| [0, i, i + 1]);
    Solid::open(TriangleMesh::new(points.clone(), fan.collect()))
}
