//! The view of a picture's camera: the rays through its pixels.
use crate::area::Area;
use crate::beam::Beam;
use crate::layout::halves_across;
use crate::ray::Ray;
use scene::{Camera, Projection, Scene, Unit};

/// The camera of a picture of a given size.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View {
    /// Width and height in pixels.
    pub size: [u32; 2],
    pub projection: Projection,
    /// Shorter side of a pixel over its width; 1 for square pixels.
    pub shortest: f64,
}

impl View {
    /// Returns the view of a scene's camera, in units of the scene's size.
    pub fn of(scene: &Scene, unit: &Unit, size: [u32; 2]) -> Self {
        let mut camera = scene.camera;
        camera.eye = unit.map(camera.eye);
        camera.target = unit.map(camera.target);
        Self {
            size,
            projection: camera.projection(size[0], size[1]),
            shortest: if camera.pixel > 0.0 {
                camera.pixel.clamp(Camera::PIXELS[0], 1.0)
            } else {
                1.0
            },
        }
    }

    /// Returns the ray through a point of the picture, in pixels.
    pub fn ray(&self, x: f64, y: f64) -> Ray {
        Ray {
            origin: self.projection.eye,
            direction: self
                .projection
                .direction(x / f64::from(self.size[0]), y / f64::from(self.size[1])),
        }
    }

    /// Returns the width of a pixel at distance 1, or its height if that is less.
    pub fn pixel(&self) -> f64 {
        2.0 * self.projection.half_width / f64::from(self.size[0]) * self.shortest
    }

    /// Returns the beam of all rays through a rectangle of pixels.
    pub fn beam(&self, area: Area) -> Beam {
        let [l, t, r, b] = [area.left, area.top, area.right, area.bottom].map(f64::from);
        let axis = self.ray(0.5 * (l + r), 0.5 * (t + b));
        // Directions of equal distance from the axis' lie on ellipses or so in the picture: the
        // furthest of a rectangle is at a corner.
        let spread = [(l, t), (r, t), (l, b), (r, b)]
            .map(|(x, y)| self.ray(x, y).direction.distance(axis.direction))
            .into_iter()
            .fold(0.0, f64::max);
        Beam {
            axis,
            radius: 0.0,
            spread: spread * (1.0 + 1e-9),
            ahead: 0.0,
        }
    }
}

/// Returns the part of a rectangle of columns and rows of packets that has a number in the binary
/// tree of its divisions: the halves of i are 2i+1 (left or upper) and 2i+2.
pub(crate) fn division(area: Area, mut packets: [u32; 2], number: usize) -> Area {
    let path = number + 1;
    let mut part = area;
    for level in (0..path.ilog2()).rev() {
        let across = halves_across(packets);
        part = part.halves(across)[path >> level & 1];
        packets[usize::from(!across)] /= 2;
    }
    part
}
