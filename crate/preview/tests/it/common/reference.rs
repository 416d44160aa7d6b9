//! Shapes defined anew, by which points belong to them, and a patient ray caster in `f64` that
//! shares neither formula nor method with the shaders.

use field::Skeleton;
use glam::{DVec2, DVec3};
use scene::{Cuboid, Ends, Quadric, Scene, Shape};

/// Steps along a ray. A chord shorter than a step is missed, which concerns silhouettes only.
const STEPS: u32 = 1000;

/// A shape by its name.
enum Solid<'a> {
    Sphere {
        center: DVec3,
    },
    Cylinder {
        base: DVec3,
        apex: DVec3,
    },
    Cone {
        base: DVec3,
        base_radius: f64,
        apex: DVec3,
        apex_radius: f64,
    },
    Pipe {
        base: DVec3,
        apex: DVec3,
    },
    Arc {
        center: DVec3,
        u: DVec3,
        v: DVec3,
        sweep: f64,
        angle: f64,
    },
    Triangle {
        corners: [DVec3; 3],
    },
    Patch {
        corners: [DVec3; 3],
        normals: [DVec3; 3],
    },
    Plane {
        point: DVec3,
        normal: DVec3,
    },
    Box {
        center: DVec3,
        axes: [DVec3; 3],
    },
    Quadric(&'a Quadric),
}

fn name(shape: &Shape) -> Solid<'_> {
    let bone = match shape {
        Shape::Bone(bone) => bone,
        Shape::Box(Cuboid { center, axes }) => {
            let (center, axes) = (*center, *axes);
            return Solid::Box { center, axes };
        }
        Shape::Quadric(quadric) => return Solid::Quadric(quadric),
        Shape::Function(_) => unreachable!("drawn as its parts"),
    };
    match bone.skeleton {
        Skeleton::Point { center } => Solid::Sphere { center },
        Skeleton::Segment { base, apex } => match (bone.end_radius, bone.ends) {
            (Some(apex_radius), _) => Solid::Cone {
                base,
                base_radius: bone.radius,
                apex,
                apex_radius,
            },
            (None, Ends::Open) => Solid::Pipe { base, apex },
            (None, _) => Solid::Cylinder { base, apex },
        },
        Skeleton::Arc {
            center,
            u,
            v,
            radius: sweep,
            angle,
        } => Solid::Arc {
            center,
            u,
            v,
            sweep,
            angle,
        },
        Skeleton::Triangle { corners } => match &bone.normals {
            None => Solid::Triangle { corners },
            Some(normals) => Solid::Patch {
                corners,
                normals: **normals,
            },
        },
        Skeleton::Plane { point, normal } => Solid::Plane { point, normal },
        Skeleton::Polygon { .. } | Skeleton::Curve { .. } => unreachable!("drawn as their parts"),
    }
}

/// First crossing of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Met {
    pub element: usize,
    pub distance: f64,
    /// Unit normal turned against the ray.
    pub normal: DVec3,
}

/// The first element that a ray meets, elements being solid at `scene.radius`.
pub fn first(scene: &Scene, eye: DVec3, direction: DVec3) -> Option<Met> {
    let mut best: Option<Met> = None;
    for (index, element) in scene.elements.iter().enumerate() {
        let radius = scene.radius(element);
        if let Some(distance) = boundary(&element.shape, radius, eye, direction)
            && best.is_none_or(|met| distance < met.distance)
        {
            let mut normal = normal(&element.shape, radius, eye + direction * distance);
            if let Solid::Patch {
                corners: [a, b, c], ..
            } = name(&element.shape)
            {
                // A patch is seen from the side that its face shows, at most edge-on.
                let face = (b - a).cross(c - a);
                let face = face * face.dot(normal).signum();
                if face.dot(direction) * normal.dot(direction) < 0.0 {
                    normal = (normal - direction * normal.dot(direction)).normalize();
                }
            }
            best = Some(Met {
                element: index,
                distance,
                normal: if normal.dot(direction) > 0.0 {
                    -normal
                } else {
                    normal
                },
            });
        }
    }
    best
}

/// Distance to the first point in front of the eye where the ray enters or leaves the shape.
fn boundary(shape: &Shape, radius: f64, eye: DVec3, direction: DVec3) -> Option<f64> {
    // A flat thing has no inside: where the ray pierces its plane.
    match name(shape) {
        Solid::Plane { point, normal, .. } => {
            let slope = direction.dot(normal);
            let height = (eye - point).dot(normal);
            return [radius, -radius]
                .map(|level| (level - height) / slope)
                .into_iter()
                .filter(|t| *t > 0.0 && t.is_finite())
                .min_by(f64::total_cmp);
        }
        Solid::Triangle {
            corners: [p, q, r], ..
        } if radius == 0.0 => {
            let normal = (q - p).cross(r - p);
            let t = (p - eye).dot(normal) / direction.dot(normal);
            let hit = eye + direction * t;
            return (t > 0.0 && inside_edges([p, q, r], hit)).then_some(t);
        }
        _ => {}
    }
    // A flat thing with normals of its own is where its plane is.
    if let Solid::Patch { corners, .. } = name(shape) {
        let flat = Shape::triangle(corners, 0.0);
        return boundary(&flat, 0.0, eye, direction);
    }
    let (center, reach) = ball_around(shape, radius);
    let middle = (center - eye).dot(direction);
    let square = reach * reach - (center - eye - direction * middle).length_squared();
    let from = (middle - square.max(0.0).sqrt()).max(0.0);
    let to = middle + square.max(0.0).sqrt();
    if to <= from {
        return None;
    }
    let at = |i: u32| from + (to - from) * f64::from(i) / f64::from(STEPS);
    let is_inside = |t: f64| inside(shape, radius, eye + direction * t);
    // An open surface ends where it is cut off, without a crossing.
    let reaches = |t: f64| reaches(shape, eye + direction * t);
    let change = (1..=STEPS).find(|i| {
        let (a, b) = (at(i - 1), at(*i));
        is_inside(a) != is_inside(b) && reaches(a) && reaches(b)
    })?;
    let start = is_inside(at(change - 1));
    let (mut before, mut after) = (at(change - 1), at(change));
    for _ in 0..60 {
        let half = 0.5 * (before + after);
        if is_inside(half) == start {
            before = half;
        } else {
            after = half;
        }
    }
    Some(after)
}

fn ball_around(shape: &Shape, radius: f64) -> (DVec3, f64) {
    match name(shape) {
        Solid::Sphere { center, .. } => (center, 1.01 * radius),
        Solid::Cylinder { base, apex, .. } => {
            (base.midpoint(apex), base.distance(apex) * 0.5 + radius)
        }
        Solid::Arc {
            center,
            u,
            v,
            sweep,
            angle,
            ..
        } => {
            // About the middle of the arc, no point of which is farther than its ends.
            let (sine, cosine) = libm::sincos(0.5 * angle);
            let chord = if angle < core::f64::consts::PI {
                2.0 * sweep * libm::sin(0.25 * angle)
            } else {
                2.0 * sweep
            };
            (
                center + (u * cosine + v * sine) * sweep,
                1.01 * (chord + radius),
            )
        }
        Solid::Triangle { corners, .. } => {
            let center = (corners[0] + corners[1] + corners[2]) / 3.0;
            let far = corners.map(|c| c.distance(center));
            (center, far[0].max(far[1]).max(far[2]) + radius)
        }
        Solid::Cone {
            base,
            apex,
            base_radius,
            apex_radius,
        } => (
            base.midpoint(apex),
            base.distance(apex) * 0.5 + base_radius.max(apex_radius),
        ),
        Solid::Pipe { base, apex, .. } => (base.midpoint(apex), base.distance(apex) * 0.5 + radius),
        Solid::Box { center, axes } => (center, axes.iter().map(|a| a.length()).sum()),
        Solid::Quadric(q) => (q.center, q.axes.iter().map(|a| a.length()).sum()),
        Solid::Plane { .. } | Solid::Patch { .. } => unreachable!("solved directly"),
    }
}

/// A point in coordinates along three axes (Cramer's rule).
fn along([x, y, z]: [DVec3; 3], d: DVec3) -> DVec3 {
    let sides = [d.cross(y).dot(z), x.cross(d).dot(z), x.cross(y).dot(d)];
    DVec3::from(sides) / x.cross(y).dot(z)
}

fn in_quadric(quadric: &Quadric, p: DVec3) -> DVec3 {
    along(quadric.axes, p - quadric.center)
}

/// Share of the way from one end to the other of the foot of p on an axis, and its distance from
/// it.
fn about_axis(base: DVec3, apex: DVec3, p: DVec3) -> (f64, f64) {
    let way = apex - base;
    let share = (p - base).dot(way) / way.length_squared();
    (share, (p - base - way * share).length())
}

/// Whether an open surface is there at all, or cut off.
fn reaches(shape: &Shape, p: DVec3) -> bool {
    match name(shape) {
        Solid::Pipe { base, apex, .. } => (0.0..=1.0).contains(&about_axis(base, apex, p).0),
        Solid::Quadric(quadric) => in_quadric(quadric, p).abs().max_element() <= 1.0,
        _ => true,
    }
}

/// Distance of a point to an arc's circle, and the angle from the arc's start, in [0, 2π).
fn about_circle(center: DVec3, u: DVec3, v: DVec3, sweep: f64, p: DVec3) -> (f64, f64) {
    let way = p - center;
    let flat = DVec2::new(way.dot(u), way.dot(v));
    let height = way.dot(u.cross(v));
    let angle = libm::atan2(flat.y, flat.x).rem_euclid(core::f64::consts::TAU);
    (DVec2::new(flat.length() - sweep, height).length(), angle)
}

fn inside_edges(corners: [DVec3; 3], p: DVec3) -> bool {
    let [a, b, c] = corners;
    let normal = (b - a).cross(c - a);
    [(a, b), (b, c), (c, a)]
        .into_iter()
        .all(|(from, to)| (to - from).cross(p - from).dot(normal) >= 0.0)
}

fn inside(shape: &Shape, radius: f64, p: DVec3) -> bool {
    match name(shape) {
        Solid::Sphere { center, .. } => p.distance(center) <= radius,
        Solid::Cylinder { base, apex, .. } => {
            let axis = (apex - base).normalize();
            let along = (p - base).dot(axis);
            (0.0..=base.distance(apex)).contains(&along)
                && (p - base - axis * along).length() <= radius
        }
        Solid::Arc {
            center,
            u,
            v,
            sweep,
            angle,
            ..
        } => {
            let (distance, turned) = about_circle(center, u, v, sweep, p);
            distance <= radius && turned <= angle
        }
        Solid::Triangle { corners, .. } => {
            let normal = (corners[1] - corners[0])
                .cross(corners[2] - corners[0])
                .normalize();
            (p - corners[0]).dot(normal).abs() <= radius && inside_edges(corners, p)
        }
        Solid::Cone {
            base,
            apex,
            base_radius,
            apex_radius,
        } => {
            let (share, distance) = about_axis(base, apex, p);
            (0.0..=1.0).contains(&share)
                && distance <= base_radius + (apex_radius - base_radius) * share
        }
        Solid::Pipe { base, apex, .. } => about_axis(base, apex, p).1 <= radius,
        Solid::Box { center, axes } => along(axes, p - center).abs().max_element() <= 1.0,
        Solid::Quadric(quadric) => quadric.value(in_quadric(quadric, p)).0 <= 0.0,
        Solid::Plane { .. } | Solid::Patch { .. } => unreachable!("solved directly"),
    }
}

/// The normal of the face that a point of the surface is nearest to.
fn normal(shape: &Shape, radius: f64, p: DVec3) -> DVec3 {
    let mut faces: Vec<(f64, DVec3)> = Vec::new();
    match name(shape) {
        Solid::Sphere { center, .. } => return (p - center).normalize(),
        Solid::Plane { normal, .. } => return normal,
        Solid::Patch { corners, normals } => {
            let [a, b, c] = corners;
            let n = (b - a).cross(c - a);
            let share = |q: DVec3, r: DVec3| (q - p).cross(r - p).dot(n);
            let mixed = normals[0].normalize() * share(b, c)
                + normals[1].normalize() * share(c, a)
                + normals[2].normalize() * share(a, b);
            return mixed.normalize();
        }
        Solid::Pipe { base, apex, .. } => {
            let way = (apex - base).normalize();
            return (p - base).reject_from_normalized(way).normalize();
        }
        Solid::Quadric(quadric) => {
            // From one side to the other along each axis of the world.
            let value = |p: DVec3| quadric.value(in_quadric(quadric, p)).0;
            let slope = |axis: DVec3| value(p + axis * 1e-5) - value(p - axis * 1e-5);
            return DVec3::new(slope(DVec3::X), slope(DVec3::Y), slope(DVec3::Z)).normalize();
        }
        Solid::Box { center, axes } => {
            let at = along(axes, p - center);
            for i in 0..3 {
                let across = axes[(i + 1) % 3].cross(axes[(i + 2) % 3]).normalize();
                faces.push(((at[i].abs() - 1.0).abs(), across));
            }
        }
        Solid::Cone {
            base,
            apex,
            base_radius,
            apex_radius,
        } => {
            let (share, distance) = about_axis(base, apex, p);
            let length = base.distance(apex);
            let axis = (apex - base) / length;
            let slope = (apex_radius - base_radius) / length;
            faces.push(((share * length).abs(), axis));
            faces.push((((1.0 - share) * length).abs(), axis));
            let wall = (distance - base_radius - slope * share * length).abs();
            let aside = (p - base).reject_from_normalized(axis).normalize();
            faces.push((wall, (aside - axis * slope).normalize()));
        }
        Solid::Cylinder { base, apex, .. } => {
            let axis = (apex - base).normalize();
            let along = (p - base).dot(axis);
            let aside = p - base - axis * along;
            faces.push((along.abs(), axis));
            faces.push(((p - apex).dot(axis).abs(), axis));
            faces.push(((aside.length() - radius).abs(), aside.normalize()));
        }
        Solid::Arc {
            center,
            u,
            v,
            sweep,
            angle,
            ..
        } => {
            let (distance, turned) = about_circle(center, u, v, sweep, p);
            let (sine, cosine) = libm::sincos(turned);
            let on_circle = center + (u * cosine + v * sine) * sweep;
            faces.push(((distance - radius).abs(), (p - on_circle).normalize()));
            if angle < core::f64::consts::TAU {
                for end in [0.0, angle] {
                    let (sine, cosine) = libm::sincos(end);
                    let along = v * cosine - u * sine;
                    let outward = u * cosine + v * sine;
                    // A lid is on one side of the axis only.
                    if (p - center).dot(outward) > -1e-9 * sweep {
                        faces.push(((p - center).dot(along).abs(), along));
                    }
                }
            }
        }
        Solid::Triangle { corners, .. } => {
            let [a, b, c] = corners;
            let n = (b - a).cross(c - a).normalize();
            if radius == 0.0 {
                return n;
            }
            faces.push((((p - a).dot(n).abs() - radius).abs(), n));
            for (from, to) in [(a, b), (b, c), (c, a)] {
                let aside = (to - from).cross(n).normalize();
                faces.push(((p - from).dot(aside).abs(), aside));
            }
        }
    }
    faces
        .into_iter()
        .min_by(|x, y| x.0.total_cmp(&y.0))
        .expect("every shape has faces")
        .1
}
