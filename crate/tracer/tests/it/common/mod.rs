//! Random scenes for tests.
use core::f64::consts::TAU;
use glam::{DMat3, DVec3};
use scene::{Camera, Element, Finish, Flesh, Light, LightKind, Quadric, Scene, Shape};

/// A small deterministic generator, enough for test inputs.
pub struct Numbers(pub u64);

impl Numbers {
    /// Between 0 and 1.
    pub fn unit(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Coordinates between −1 and 1.
    pub fn vector(&mut self) -> DVec3 {
        DVec3::new(
            self.between(-1.0, 1.0),
            self.between(-1.0, 1.0),
            self.between(-1.0, 1.0),
        )
    }

    pub fn shape(&mut self, kind: u64) -> Shape {
        let radius = self.between(0.1, 0.4);
        match kind % 5 {
            0 => Shape::Sphere {
                center: self.vector(),
                radius,
            },
            1 => Shape::Cylinder {
                base: self.vector(),
                apex: self.vector(),
                radius,
            },
            2 => {
                let u = self.vector().normalize();
                Shape::Arc {
                    center: self.vector() * 0.5,
                    u,
                    v: u.cross(self.vector()).normalize(),
                    sweep: self.between(0.2, 1.2),
                    angle: self.between(0.3, TAU),
                    radius,
                }
            }
            3 => Shape::Triangle {
                corners: [self.vector(), self.vector(), self.vector()],
                radius,
            },
            _ => Shape::Plane {
                point: self.vector(),
                normal: self.vector().normalize(),
                radius,
            },
        }
    }
}

/// Shapes that are rarely soft, or cannot be.
impl Numbers {
    pub fn solid(&mut self, kind: u64) -> Shape {
        let radius = self.between(0.1, 0.4);
        match kind % 5 {
            0 => Shape::Cone {
                base: self.vector(),
                base_radius: radius,
                apex: self.vector(),
                apex_radius: self.between(0.0, 0.2),
            },
            1 => Shape::Pipe {
                base: self.vector(),
                apex: self.vector(),
                radius,
            },
            2 => Shape::Box {
                center: self.vector(),
                axes: [0, 1, 2].map(|_| self.vector() * 0.5),
            },
            3 => Shape::Patch {
                corners: [0, 1, 2].map(|_| self.vector()),
                normals: [0, 1, 2].map(|_| DVec3::Z + self.vector()),
            },
            _ => Shape::Quadric(Box::new(Quadric {
                square: DMat3::from_diagonal(DVec3::new(1.0, 1.3, -0.5)),
                linear: self.vector() * 0.3,
                constant: -0.3,
                center: self.vector(),
                axes: [0, 1, 2].map(|_| self.vector() * 0.5),
            })),
        }
    }
}

/// An element with the flesh and the finish of this index; hard, if the scene has no such flesh.
pub fn element(shape: Shape, index: u32) -> Element {
    Element {
        flesh: Some(index),
        finish: index,
        ..Element::new(shape)
    }
}

/// Flesh of radius 0.25.
pub fn soft(blobbiness: f64, strength: f64) -> Flesh {
    Flesh {
        blobbiness,
        strength,
        radius: 0.25,
        ..Flesh::default()
    }
}

/// Gives a scene these fleshes, each with a finish that shines.
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

/// A scene looking at the origin from (0, 0, 4), with one light and no elements.
pub fn empty() -> Scene {
    let mut scene = Scene {
        camera: Camera {
            eye: DVec3::new(0.0, 0.0, 4.0),
            target: DVec3::ZERO,
            up: DVec3::Y,
            fov: 50.0,
            shift: [0.0; 2],
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

/// Some soft elements of all kinds, a few of them carving.
pub fn blend(seed: u64, count: usize) -> Scene {
    let mut n = Numbers(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1);
    let mut scene = empty();
    let flesh = vec![soft(-0.5, 1.0), soft(-4.0, 1.0), soft(-1.0, -0.7)];
    clothe(&mut scene, flesh);
    scene.finishes[0].diffuse = [0.9, 0.3, 0.1];
    scene.finishes[1].diffuse = [0.1, 0.5, 0.9];
    for _ in 0..count {
        let kind = (n.unit() * 5.0) as u64;
        let kind = if kind == 4 && n.unit() < 0.7 { 0 } else { kind };
        let material = (n.unit() * 2.4) as u32;
        let shape = n.shape(kind);
        scene.elements.push(element(shape, material));
    }
    scene
}
