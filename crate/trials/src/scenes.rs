//! Random scenes.

use crate::Random;
use core::f64::consts::TAU;
use field::{BlobScale, Kernel, Profile, Wave};
use glam::{DMat3, DVec3};
use scene::{Camera, Element, Finish, Flesh, Fragile, Light, LightKind, Quadric, Scene, Shape};

impl Random {
    /// Returns a shape that may be soft, of one of five kinds.
    pub fn shape(&mut self, kind: usize) -> Shape {
        let radius = self.range(0.1, 0.4);
        match kind % 5 {
            0 => Shape::sphere(self.vector(1.0), radius),
            1 => Shape::cylinder(self.vector(1.0), self.vector(1.0), radius),
            2 => {
                let u = self.vector(1.0).normalize();
                Shape::arc(
                    self.vector(1.0) * 0.5,
                    [u, u.cross(self.vector(1.0)).normalize()],
                    self.range(0.2, 1.2),
                    self.range(0.3, TAU),
                    radius,
                )
            }
            3 => Shape::triangle([0, 1, 2].map(|_| self.vector(1.0)), radius),
            _ => Shape::plane(self.vector(1.0), self.vector(1.0).normalize(), radius),
        }
    }

    /// Returns a shape that is rarely soft, or cannot be, of one of five kinds.
    pub fn solid(&mut self, kind: usize) -> Shape {
        let radius = self.range(0.1, 0.4);
        match kind % 5 {
            0 => Shape::cone(
                self.vector(1.0),
                radius,
                self.vector(1.0),
                self.range(0.0, 0.2),
            ),
            1 => Shape::pipe(self.vector(1.0), self.vector(1.0), radius),
            2 => Shape::cuboid(self.vector(1.0), [0, 1, 2].map(|_| self.vector(0.5))),
            3 => Shape::patch(
                [0, 1, 2].map(|_| self.vector(1.0)),
                [0, 1, 2].map(|_| DVec3::Z + self.vector(1.0)),
            ),
            _ => Shape::Quadric(Box::new(Quadric {
                square: DMat3::from_diagonal(DVec3::new(1.0, 1.3, -0.5)),
                linear: self.vector(0.3),
                constant: -0.3,
                center: self.vector(1.0),
                axes: [0, 1, 2].map(|_| self.vector(0.5)),
            })),
        }
    }

    /// Returns 10 to a power; the scenes of earlier faults depend on each bit of it.
    pub fn power(&mut self, low: f64, high: f64) -> f64 {
        libm::pow(10.0, self.range(low, high))
    }
}

/// Returns an element with the flesh and the finish of an index; hard, if the scene has no such
/// flesh.
pub fn element(shape: Shape, index: u32) -> Element {
    Element {
        flesh: Some(index),
        finish: index,
        ..Element::new(shape)
    }
}

/// Returns flesh of radius 0.25.
pub fn soft(blobbiness: f64, strength: f64) -> Flesh {
    Flesh {
        blobbiness: Some(blobbiness),
        strength,
        radius: 0.25,
        ..Flesh::default()
    }
}

/// Gives a scene some fleshes, each with a finish that shines.
pub fn clothe(scene: &mut Scene, flesh: Vec<Flesh>) {
    scene.finishes = flesh
        .iter()
        .map(|_| Finish {
            specular: [0.5; 3],
            shine: 20.0,
            ..Finish::default()
        })
        .collect();
    scene.flesh = flesh;
}

/// Returns a scene looking at the origin from (0, 0, 4), with one light and no elements.
pub fn empty() -> Scene {
    let mut scene = Scene {
        camera: Camera {
            eye: DVec3::new(0.0, 0.0, 4.0),
            target: DVec3::ZERO,
            up: DVec3::Y,
            fov: 50.0,
            ..Camera::default()
        },
        ..Scene::default()
    };
    scene.lights.push(Light {
        kind: LightKind::Point {
            position: DVec3::new(4.0, 5.0, 6.0),
        },
        colour: [1.0; 3],
        shadow: true,
        size: 0.0,
    });
    scene
}

/// Returns a scene of some soft elements of all kinds, a few of them carving.
pub fn blend(seed: u64, count: usize) -> Scene {
    let mut n = Random::new(seed);
    let mut scene = empty();
    let flesh = vec![soft(0.5, 1.0), soft(4.0, 1.0), soft(1.0, -0.7)];
    clothe(&mut scene, flesh);
    scene.finishes[0].diffuse = [0.9, 0.3, 0.1];
    scene.finishes[1].diffuse = [0.1, 0.5, 0.9];
    for _ in 0..count {
        let kind = n.below(5);
        let kind = if kind == 4 && n.chance(0.7) { 0 } else { kind };
        let material = n.range(0.0, 2.4) as u32;
        let shape = n.shape(kind);
        scene.elements.push(element(shape, material));
    }
    scene
}

/// Kinds of scenes, by their elements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Points.
    Point,
    /// Segments.
    Segment,
    /// Arcs.
    Arc,
    /// Triangles.
    Triangle,
    /// Polygons, some with holes.
    Polygon,
    /// Planes.
    Plane,
    /// Cubic curves.
    Curve,
    /// A segment, arc or curve whose radius and blobbiness vary.
    Taper,
    /// Profiles with smooth waves.
    Waves,
    /// Profiles with kinks and jumps.
    Kinks,
    /// Triangles whose field is restricted.
    Restricted,
    /// Elements of all of the first seven kinds, some with other kernels.
    Mixed,
    /// A hundred or two points and segments.
    Cluster,
    /// A hundred or two points that add up.
    Cloud,
    /// A few dozen bones beside each other that add up, most of them triangles near one plane, some
    /// restricted.
    Patch,
}

/// Every kind but patches.
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

/// The map of a scene's places, which are moved and magnified.
#[derive(Clone, Copy, Debug)]
pub struct World {
    /// Place of the origin.
    pub center: DVec3,
    /// Length of a unit.
    pub scale: f64,
}

impl World {
    /// Returns the place of a point.
    pub fn at(self, p: DVec3) -> DVec3 {
        self.center + p * self.scale
    }
}

/// Returns a scene of a kind and its places: some are tiny or huge, some far from the origin.
pub fn scene(kernel: Kernel, kind: Kind, n: &mut Random) -> (Scene, World) {
    n.unit();
    let scale = match n.below(8) {
        0 => 1e-6,
        1 => 1e6,
        2 => 10f64.powi(n.range(-4.0, 4.0) as i32),
        _ => 1.0,
    };
    let far = if n.chance(0.4) {
        10f64.powi(n.range(0.0, 5.0) as i32)
    } else {
        0.0
    };
    let center = n.vector(1.0) * (far * scale);
    let world = World { center, scale };
    (scene_in(world, kernel, kind, n), world)
}

/// Returns a scene of a kind in the places of a world.
fn scene_in(world: World, kernel: Kernel, kind: Kind, n: &mut Random) -> Scene {
    let mut scene = empty();
    scene.camera.eye = world.at(DVec3::Z * 4.0);
    scene.camera.target = world.at(DVec3::ZERO);
    scene.settings.fragile = Fragile::ALL;
    if n.chance(0.1) {
        scene.settings.blob_scale = BlobScale::Absolute;
    }
    let count = match kind {
        Kind::Cluster => n.range(60.0, 300.0) as usize,
        Kind::Cloud => n.range(64.0, 300.0) as usize,
        Kind::Mixed => n.range(4.0, 16.0) as usize,
        Kind::Patch => n.range(24.0, 48.0) as usize,
        _ if n.chance(0.4) => 1,
        _ => n.range(2.0, 6.0) as usize,
    };
    // Meshes of crisp faces are rough.
    let crispest = if kind == Kind::Patch { 0.3 } else { 1.5 };
    let crisp = n.power(-1.0, crispest);
    for i in 0..count {
        let alone = match kind {
            Kind::Taper => n.pick(&[Kind::Segment, Kind::Arc, Kind::Curve]),
            Kind::Waves | Kind::Kinks => n.pick(&[Kind::Segment, Kind::Arc, Kind::Triangle]),
            Kind::Restricted => Kind::Triangle,
            Kind::Mixed => n.pick(&KINDS[..7]),
            Kind::Cluster => n.pick(&KINDS[..2]),
            Kind::Cloud => Kind::Point,
            Kind::Patch if n.chance(0.1) => n.pick(&KINDS[..3]),
            _ => kind,
        };
        // Now and then a thin spike.
        let thin = n.chance(0.15);
        let radius = match kind {
            Kind::Cluster | Kind::Cloud => n.range(0.02, 0.12),
            Kind::Patch => n.range(0.05, 0.15),
            _ if thin => n.range(0.008, 0.03),
            _ => n.range(0.05, 0.4),
        };
        let blobbiness = match scene.settings.blob_scale {
            BlobScale::Relative if n.chance(0.7) => crisp,
            BlobScale::Relative => n.power(-1.0, crispest),
            BlobScale::Absolute => crisp / (radius * radius * world.scale * world.scale),
        };
        let mut flesh = Flesh {
            radius: radius * world.scale,
            blobbiness: Some(blobbiness),
            kernel: Some(kernel),
            ..Flesh::default()
        };
        // Without the last one, which earlier scenes did not know.
        if kind == Kind::Mixed && n.chance(0.3) {
            flesh.kernel = Some(n.pick(&Kernel::ALL[..8]));
        }
        if i > 0 && n.chance(0.15) {
            flesh.strength = -n.range(0.2, 1.5);
        } else if n.chance(0.2) {
            flesh.strength = n.range(0.5, 2.0);
        }
        if kind == Kind::Cloud {
            flesh.strength = flesh.strength.abs();
        }
        if kind == Kind::Taper || (kind == Kind::Mixed && n.chance(0.2)) {
            flesh.end_radius = Some(flesh.radius * n.range(0.02, 1.5));
            if n.chance(0.3) {
                flesh.end_blobbiness = Some(blobbiness * n.range(0.3, 3.0));
            }
        }
        if kind == Kind::Patch {
            flesh.strength = n.range(0.5, 1.2);
        }
        if kind == Kind::Restricted || kind == Kind::Patch && n.chance(0.4) {
            flesh.restriction = n.range(0.2, 1.0);
        }
        if matches!(kind, Kind::Waves | Kind::Kinks) {
            let smooth = [Wave::Sin, Wave::Cos, Wave::Sin2, Wave::Cos2];
            let kinked = [Wave::X, Wave::Saw, Wave::Hat, Wave::Step];
            let waves = if kind == Kind::Waves { smooth } else { kinked };
            flesh.profile = Some(Profile {
                waves: [n.pick(&waves), Wave::One],
                scale: [n.range(1.0, 20.0), 1.0],
                bounds: [n.range(0.3, 0.9), 1.0],
                times: n.range(1.0, 1.5),
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

/// Returns a shape of a kind.
fn shape(kind: Kind, radius: f64, thin: bool, n: &mut Random, world: World) -> Shape {
    let at = |n: &mut Random| world.at(n.vector(1.0));
    let radius = radius * world.scale;
    match kind {
        Kind::Point => Shape::sphere(at(n), radius),
        Kind::Arc => {
            let u = n.vector(1.0).normalize();
            Shape::arc(
                world.at(n.vector(1.0) * 0.5),
                [u, u.cross(n.vector(1.0)).normalize()],
                n.range(0.1, 1.2) * world.scale,
                if n.chance(0.2) {
                    TAU
                } else {
                    n.range(0.2, TAU)
                },
                radius,
            )
        }
        Kind::Triangle => {
            let (a, b) = (n.vector(1.0), n.vector(1.0));
            // Some of them needles.
            let c = if thin {
                a.lerp(b, 0.4) + n.vector(1.0) * 0.02
            } else {
                n.vector(1.0)
            };
            Shape::triangle([a, b, c].map(|p| world.at(p)), radius)
        }
        Kind::Patch => {
            let center = n.vector(0.8);
            let corners = [0; 3].map(|_| center + n.vector(0.4));
            let flat = corners.map(|p| world.at(p * DVec3::new(1.0, 1.0, 0.03)));
            Shape::triangle(flat, radius)
        }
        Kind::Polygon => {
            let x = n.vector(1.0).normalize();
            let y = x.cross(n.vector(1.0)).normalize();
            let center = n.vector(1.0) * 0.3;
            let corners = n.range(3.0, 9.0) as u32;
            let outer: Vec<(f64, f64)> = (0..corners)
                .map(|i| {
                    let turn = f64::from(i) / f64::from(corners) * TAU;
                    let far = n.range(0.4, 1.0);
                    (far * libm::cos(turn), far * libm::sin(turn))
                })
                .collect();
            // A hole of the same form is inside as long as the form is a star.
            let scales: &[f64] = if n.chance(0.4) { &[1.0, 0.4] } else { &[1.0] };
            let mut rings = Vec::new();
            for &scale in scales {
                let corners = outer.iter();
                let corners = corners.map(|&(a, b)| world.at(center + (x * a + y * b) * scale));
                rings.push(corners.collect());
            }
            Shape::polygon(rings, radius)
        }
        Kind::Plane => Shape::plane(at(n), n.vector(1.0).normalize(), radius),
        Kind::Curve => Shape::curve([at(n), at(n), at(n), at(n)], radius),
        _ => Shape::cylinder(at(n), at(n), radius),
    }
}
