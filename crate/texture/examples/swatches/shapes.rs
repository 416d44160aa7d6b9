//! Shapes of the contact sheet, by their distances.

use glam::{DMat3, DVec3};
use texture::{Uv, uv};

pub type Distance = Box<dyn Fn(DVec3) -> f64>;
pub type Coordinates = Box<dyn Fn(DVec3) -> Uv>;

/// Shape with texture coordinates, of its own space.
pub struct Shape {
    pub distance: Distance,
    /// Weights and coordinates: one, or one for each element of a blend.
    pub parts: Vec<(Distance, Coordinates, usize)>,
    /// Map from the shape's own space to the world.
    pub turn: DMat3,
    pub shift: DVec3,
}

pub fn one(distance: Distance, coordinates: Coordinates, turn: DMat3, shift: DVec3) -> Shape {
    Shape {
        distance,
        parts: vec![(Box::new(|_| 1.0), coordinates, 0)],
        turn,
        shift,
    }
}

pub fn ball(shift: DVec3, turn: DMat3) -> Shape {
    one(
        Box::new(|p| p.length() - 1.0),
        Box::new(|p| uv::sphere(DVec3::ZERO, p)),
        // Tilted, so that both ends and sides of patterns along z are seen.
        turn,
        shift,
    )
}

/// Returns a block whose nearest corner is the origin: faces at x = 0, y = 0 and z = 0, all turned
/// to the viewer.
pub fn block(shift: DVec3) -> Shape {
    let (half, center) = (DVec3::splat(0.8), DVec3::new(-0.8, -0.8, -0.8));
    let turn = DMat3::from_rotation_x(0.5) * DMat3::from_rotation_y(-0.6);
    one(
        Box::new(move |p| {
            let q = (p - center).abs() - half;
            q.max(DVec3::ZERO).length() + q.max_element().min(0.0)
        }),
        Box::new(move |p| uv::cuboid(center, [0.8 * DVec3::X, 0.8 * DVec3::Y, 0.8 * DVec3::Z], p)),
        turn,
        shift - turn * center,
    )
}

pub fn segment_distance(a: DVec3, b: DVec3, p: DVec3) -> f64 {
    let d = b - a;
    let t = ((p - a).dot(d) / d.length_squared()).clamp(0.0, 1.0);
    (p - a - t * d).length()
}
