//! Random scenes and rays for comparisons of pictures with the reference.
use super::common::{Numbers, empty};
use core::f64::consts::TAU;
use field::{BlobScale, Kernel, Profile, Wave};
use glam::DVec3;
use scene::{Element, Flesh, Fragile, Scene, Shape};
use std::fmt::Write;
use tracer::reference::{Fault, Reference};
use tracer::{Hit, Picture};

/// Kinds of scenes, by their elements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Point,
    Segment,
    Arc,
    Triangle,
    Polygon,
    Plane,
    Curve,
    /// A segment, arc or curve whose radius and blobbiness vary.
    Taper,
    /// Profiles with smooth waves …
    Waves,
    /// … and with kinks and jumps.
    Kinks,
    /// Triangles whose field is restricted.
    Restricted,
    /// Some of everything, with other kernels beside.
    Mixed,
    /// A hundred or two points and segments.
    Cluster,
    /// A hundred or two points that add up.
    Cloud,
}

pub const KINDS: [Kind; 14] = [
    Kind::Point,
    Kind::Segment,
    Kind::Arc,
    Kind::Triangle,
    Kind::Polygon,
    Kind::Plane,
    Kind::Curve,
    Kind::Taper,
    Kind::Waves,
    Kind::Kinks,
    Kind::Restricted,
    Kind::Mixed,
    Kind::Cluster,
    Kind::Cloud,
];

/// A scene, its reference and its rays.
pub struct Trial {
    pub scene: Scene,
    pub size: u32,
    pub rays: Vec<(DVec3, DVec3)>,
    pub reference: Reference,
    /// End of rays.
    pub limit: f64,
}

/// Rays of one packet.
const PACKET: usize = 8;

/// The places of a scene: moved and magnified.
#[derive(Clone, Copy)]
struct World {
    center: DVec3,
    scale: f64,
}

impl World {
    fn at(self, p: DVec3) -> DVec3 {
        self.center + p * self.scale
    }
}

impl Trial {
    /// The trial of that number.
    pub fn new(kernel: Kernel, kind: Kind, seed: u64, packets: usize) -> Self {
        let mut n = Numbers(
            (seed * 1009 + kernel as u64 * 31 + kind as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15)
                | 1,
        );
        n.unit();
        let scale = match (n.unit() * 8.0) as u32 {
            0 => 1e-6,
            1 => 1e6,
            2 => 10f64.powi(n.between(-4.0, 4.0) as i32),
            _ => 1.0,
        };
        let far = if n.unit() < 0.4 {
            10f64.powi(n.between(0.0, 5.0) as i32)
        } else {
            0.0
        };
        let world = World {
            center: n.vector() * (far * scale),
            scale,
        };
        let scene = random_scene(kernel, kind, &mut n, world);
        let mut reference = Reference::new(scene.soft_surfaces().swap_remove(0).sum.primitives);
        reference.patience = 3000;
        let limit = 60.0 * scale;
        let size = 64 << (n.unit() * 7.0) as u32;
        let tolerance = Picture::new(&scene, [size; 2]).tolerance(f64::INFINITY);
        let mut rays = Vec::new();
        // Some scenes have no point outside the surface.
        for _ in 0..4 * packets {
            if rays.len() >= packets * PACKET {
                break;
            }
            packet(&scene, &mut reference, &mut n, world, tolerance, &mut rays);
        }
        Self {
            scene,
            size,
            rays,
            reference,
            limit,
        }
    }
}

fn random_scene(kernel: Kernel, kind: Kind, n: &mut Numbers, world: World) -> Scene {
    let mut scene = empty();
    scene.camera.eye = world.at(DVec3::Z * 4.0);
    scene.camera.target = world.at(DVec3::ZERO);
    scene.settings.fragile = Fragile::ALL;
    if n.unit() < 0.1 {
        scene.settings.blob_scale = BlobScale::Absolute;
    }
    let count = match kind {
        Kind::Cluster => n.between(60.0, 300.0) as usize,
        Kind::Cloud => n.between(64.0, 300.0) as usize,
        Kind::Mixed => n.between(4.0, 16.0) as usize,
        _ if n.unit() < 0.4 => 1,
        _ => n.between(2.0, 6.0) as usize,
    };
    let crisp = 10f64.powf_of(n.between(-1.0, 1.5));
    for i in 0..count {
        let alone = match kind {
            Kind::Taper => [Kind::Segment, Kind::Arc, Kind::Curve][(n.unit() * 3.0) as usize],
            Kind::Waves | Kind::Kinks => {
                [Kind::Segment, Kind::Arc, Kind::Triangle][(n.unit() * 3.0) as usize]
            }
            Kind::Restricted => Kind::Triangle,
            Kind::Mixed => KINDS[(n.unit() * 7.0) as usize],
            Kind::Cluster => KINDS[(n.unit() * 2.0) as usize],
            Kind::Cloud => Kind::Point,
            _ => kind,
        };
        // Now and then a thin spike.
        let thin = n.unit() < 0.15;
        let radius = match kind {
            Kind::Cluster | Kind::Cloud => n.between(0.02, 0.12),
            _ if thin => n.between(0.008, 0.03),
            _ => n.between(0.05, 0.4),
        };
        let blobbiness = match scene.settings.blob_scale {
            BlobScale::Relative if n.unit() < 0.7 => crisp,
            BlobScale::Relative => 10f64.powf_of(n.between(-1.0, 1.5)),
            BlobScale::Absolute => crisp / (radius * radius * world.scale * world.scale),
        };
        let mut flesh = Flesh {
            radius: radius * world.scale,
            blobbiness: -blobbiness,
            kernel: Some(kernel),
            ..Flesh::default()
        };
        if kind == Kind::Mixed && n.unit() < 0.3 {
            flesh.kernel = Some(Kernel::ALL[(n.unit() * 8.0) as usize]);
        }
        if i > 0 && n.unit() < 0.15 {
            flesh.strength = -n.between(0.2, 1.5);
        } else if n.unit() < 0.2 {
            flesh.strength = n.between(0.5, 2.0);
        }
        if kind == Kind::Cloud {
            flesh.strength = flesh.strength.abs();
        }
        if kind == Kind::Taper || (kind == Kind::Mixed && n.unit() < 0.2) {
            flesh.end_radius = Some(flesh.radius * n.between(0.02, 1.5));
            if n.unit() < 0.3 {
                flesh.end_blobbiness = Some(flesh.blobbiness * n.between(0.3, 3.0));
            }
        }
        if kind == Kind::Restricted {
            flesh.restriction = n.between(0.2, 1.0);
        }
        if matches!(kind, Kind::Waves | Kind::Kinks) {
            let smooth = [Wave::Sin, Wave::Cos, Wave::Sin2, Wave::Cos2];
            let kinked = [Wave::X, Wave::Saw, Wave::Hat, Wave::Step];
            let waves = if kind == Kind::Waves { smooth } else { kinked };
            flesh.profile = Some(Profile {
                waves: [waves[(n.unit() * 4.0) as usize], Wave::One],
                scale: [n.between(1.0, 20.0), 1.0],
                bounds: [n.between(0.3, 0.9), 1.0],
                times: n.between(1.0, 1.5),
                restriction: 0.0,
            });
        }
        let shape = shape(alone, radius, thin, n, world);
        scene.elements.push(Element {
            flesh: Some(scene.flesh.len() as u32),
            ..Element::new(shape)
        });
        scene.flesh.push(flesh);
    }
    scene
}

fn shape(kind: Kind, radius: f64, thin: bool, n: &mut Numbers, world: World) -> Shape {
    let at = |n: &mut Numbers| world.at(n.vector());
    let radius = radius * world.scale;
    match kind {
        Kind::Point => Shape::Sphere {
            center: at(n),
            radius,
        },
        Kind::Arc => {
            let u = n.vector().normalize();
            Shape::Arc {
                center: world.at(n.vector() * 0.5),
                u,
                v: u.cross(n.vector()).normalize(),
                sweep: n.between(0.1, 1.2) * world.scale,
                angle: if n.unit() < 0.2 {
                    TAU
                } else {
                    n.between(0.2, TAU)
                },
                radius,
            }
        }
        Kind::Triangle => {
            let (a, b) = (n.vector(), n.vector());
            // Some of them needles.
            let c = if thin {
                a.lerp(b, 0.4) + n.vector() * 0.02
            } else {
                n.vector()
            };
            Shape::Triangle {
                corners: [a, b, c].map(|p| world.at(p)),
                radius,
            }
        }
        Kind::Polygon => {
            let x = n.vector().normalize();
            let y = x.cross(n.vector()).normalize();
            let center = n.vector() * 0.3;
            let corners = n.between(3.0, 9.0) as u32;
            let outer: Vec<(f64, f64)> = (0..corners)
                .map(|i| {
                    let turn = f64::from(i) / f64::from(corners) * TAU;
                    let far = n.between(0.4, 1.0);
                    (far * libm::cos(turn), far * libm::sin(turn))
                })
                .collect();
            let ring = |scale: f64| {
                let place = |&(a, b): &(f64, f64)| world.at(center + (x * a + y * b) * scale);
                outer.iter().map(place).collect()
            };
            let mut rings = vec![ring(1.0)];
            // A hole of the same form is inside as long as the form is a star.
            if n.unit() < 0.4 {
                rings.push(ring(0.4));
            }
            Shape::Polygon { rings, radius }
        }
        Kind::Plane => Shape::Plane {
            point: at(n),
            normal: n.vector().normalize(),
            radius,
        },
        Kind::Curve => Shape::Curve {
            control: [at(n), at(n), at(n), at(n)],
            radius,
        },
        _ => Shape::Cylinder {
            base: at(n),
            apex: at(n),
            radius,
        },
    }
}

/// Adds a packet of rays, of one of the ways in which rays meet a surface.
fn packet(
    scene: &Scene,
    reference: &mut Reference,
    n: &mut Numbers,
    world: World,
    tolerance: f64,
    rays: &mut Vec<(DVec3, DVec3)>,
) {
    let scale = world.scale;
    let bone = bone_point(scene, n);
    let aim = bone + n.vector() * (0.3 * scale);
    let eye = world.at(n.vector().normalize() * n.between(2.0, 6.0));
    let mut made: Vec<(DVec3, DVec3)> = Vec::new();
    // Where a ray towards the bone meets the surface, and the normal there.
    let met = |reference: &mut Reference| {
        let direction = (aim - eye).try_normalize()?;
        let first = reference.crossings(eye, direction, 20.0 * scale, tolerance);
        let point = eye + direction * first.roots.first()?.t;
        let (_, gradient) = reference.excess(point);
        Some((point, -gradient.try_normalize()?))
    };
    let way = (n.unit() * 8.0) as u32;
    match way {
        // Like neighbouring pixels.
        0 | 1 => {
            let spread = 10f64.powf_of(n.between(-3.0, -1.0)) * scale;
            for _ in 0..PACKET {
                made.push((eye, aim + n.vector() * spread - eye));
            }
        }
        // Tangents, a little inside or outside.
        2..=4 => {
            if let Some((point, normal)) = met(reference) {
                let along = normal.cross(n.vector()).normalize_or_zero();
                let back = n.between(0.5, 5.0) * scale;
                for i in 0..PACKET {
                    let off = 10f64.powf_of(n.between(-8.0, -1.5)) * scale;
                    let off = if i % 4 == 3 { off } else { -off };
                    let start = point + normal * off - along * back;
                    made.push((start, along));
                }
            }
        }
        // From inside, in all directions; or from just outside.
        5 => {
            if let Some((point, normal)) = met(reference) {
                let depth = n.between(-0.1, 0.3) * scale;
                for _ in 0..PACKET {
                    made.push((point - normal * depth, n.vector()));
                }
            }
        }
        // At the bone itself, its ends, and the edge of the kernel's support.
        6 => {
            for _ in 0..PACKET {
                made.push((eye, bone + n.vector() * (0.02 * scale) - eye));
            }
        }
        // Nothing to do with one another.
        _ => {
            for _ in 0..PACKET {
                let from = world.at(n.vector() * 3.0);
                let to = bone_point(scene, n) + n.vector() * (0.2 * scale);
                made.push((from, to - from));
            }
        }
    }
    for (origin, direction) in made {
        // The side on which a ray starts must be certain.
        let clear = reference.surface_near(origin, 4.0 * tolerance);
        if let (Some(direction), tracer::reference::Near::Beyond) =
            (direction.try_normalize(), clear)
        {
            rays.push((origin, direction));
        }
    }
}

/// A point on some bone, often one of its ends.
fn bone_point(scene: &Scene, n: &mut Numbers) -> DVec3 {
    let count = scene.elements.len();
    let shape = &scene.elements[((n.unit() * count as f64) as usize).min(count - 1)].shape;
    let share = [0.0, 1.0, n.unit(), n.unit()][(n.unit() * 4.0) as usize];
    match shape {
        Shape::Cylinder { base, apex, .. } => base.lerp(*apex, share),
        Shape::Arc {
            center,
            u,
            v,
            sweep,
            angle,
            ..
        } => {
            let (sine, cosine) = libm::sincos(share * angle);
            *center + (*u * cosine + *v * sine) * *sweep
        }
        Shape::Triangle { corners, .. } => {
            corners[0].lerp(corners[1].lerp(corners[2], share), n.unit())
        }
        Shape::Polygon { rings, .. } => rings[0][0].lerp(rings[0][1], share),
        Shape::Curve { control, .. } => control[0].lerp(control[3], share),
        Shape::Sphere { center, .. } => *center,
        Shape::Plane { point, .. } => *point,
        _ => DVec3::ZERO,
    }
}

/// Powers whose exponent is no integer, the same on every platform.
trait Power {
    fn powf_of(self, exponent: f64) -> f64;
}

impl Power for f64 {
    fn powf_of(self, exponent: f64) -> f64 {
        libm::pow(self, exponent)
    }
}

/// One row of the table.
#[derive(Clone, Copy, Debug, Default)]
pub struct Row {
    pub rays: u64,
    pub hits: u64,
    /// Missed crossings of rays that go deeper than the tolerance, and of grazing ones.
    pub missed: u64,
    pub grazed: u64,
    pub invented: u64,
    /// Largest distance of hits within the tolerance, in tolerances; and of all hits.
    pub worst: f64,
    /// Undecided rays.
    pub uncertain: u64,
}

impl Row {
    #[allow(dead_code)] // The table has columns for each.
    pub fn faults(&self) -> u64 {
        self.missed + self.grazed + self.invented
    }

    pub fn add(&mut self, other: &Self) {
        self.rays += other.rays;
        self.hits += other.hits;
        self.missed += other.missed;
        self.grazed += other.grazed;
        self.invented += other.invented;
        self.worst = self.worst.max(other.worst);
        self.uncertain += other.uncertain;
    }
}

/// Judges the results of `cast` for a trial's rays; faults are printed, one a line.
pub fn check(
    kernel: Kernel,
    kind: Kind,
    seed: u64,
    packets: usize,
    cast: &dyn Fn(&Trial, &Picture) -> Vec<Option<Hit>>,
    told: &mut String,
) -> Row {
    let mut trial = Trial::new(kernel, kind, seed, packets);
    let picture = Picture::new(&trial.scene, [trial.size; 2]);
    let hits = cast(&trial, &picture);
    assert_eq!(hits.len(), trial.rays.len());
    let mut row = Row::default();
    for (number, (&(origin, direction), hit)) in trial.rays.iter().zip(&hits).enumerate() {
        row.rays += 1;
        // Hits beyond the search's end are not judged.
        let t = hit.map(|h| h.t).filter(|t| *t < trial.limit);
        row.hits += u64::from(t.is_some());
        let tolerance = |t: f64| picture.tolerance(t);
        let verdict = trial
            .reference
            .judge(origin, direction, t, trial.limit, tolerance);
        if !verdict.certain {
            row.uncertain += 1;
            let _ = writeln!(
                told,
                "{} {kind:?} seed {seed} ray {number}: hit {t:?}, undecided",
                kernel.name()
            );
        }
        if let Some(t) = t {
            row.worst = row.worst.max(verdict.distance / tolerance(t));
        }
        let Some(fault) = verdict.fault else {
            continue;
        };
        match fault {
            Fault::Missed { grazing: true, .. } => row.grazed += 1,
            Fault::Missed { .. } => row.missed += 1,
            Fault::Invented(_) => row.invented += 1,
        }
        let at = tolerance(t.unwrap_or(trial.limit));
        let _ = writeln!(
            told,
            "{} {kind:?} seed {seed} ray {number}: hit {t:?}, {fault:?}, tolerance {at:e}",
            kernel.name()
        );
    }
    row
}
