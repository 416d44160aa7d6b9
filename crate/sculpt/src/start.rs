//! The shapes that sculpting starts from.

use crate::error::{Error, fail};
use crate::limits::MAX_FACES;
use glam::{DVec3, IVec3};
use mesh::PolygonSoup;
use std::collections::BTreeMap;

/// Shape to start from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// The square −1 … 1 of the plane z = 0, seen from above: 2n² triangles.
    Plane,
    /// The unit sphere, an octahedron's faces divided: 8n² triangles.
    Sphere,
    /// The tetrahedron on four corners of the cube −1 … 1: 4n² triangles.
    Tetrahedron,
    /// The cylinder of radius 1 about the z-axis from −1 to 1: 12n² triangles.
    Cylinder,
    /// The cube −1 … 1: 12n² triangles.
    Box,
}

impl Shape {
    /// The shapes, in the order of the manual.
    pub const ALL: [Self; 5] = [
        Self::Plane,
        Self::Sphere,
        Self::Tetrahedron,
        Self::Cylinder,
        Self::Box,
    ];

    /// Returns the word for it in texts of strokes.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Plane => "plane",
            Self::Sphere => "sphere",
            Self::Tetrahedron => "tetrahedron",
            Self::Cylinder => "cylinder",
            Self::Box => "box",
        }
    }

    /// Faces with one division of each edge.
    fn faces(self) -> usize {
        match self {
            Self::Plane => 2,
            Self::Sphere => 8,
            Self::Tetrahedron => 4,
            Self::Cylinder | Self::Box => 12,
        }
    }
}

/// Shape with an initial refinement.
///
/// ```
/// use sculpt::{Shape, Start};
///
/// let start = Start::new(Shape::Sphere, 4);
/// assert_eq!(start.polygons().face_count(), 8 * 16);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Start {
    /// The shape.
    pub shape: Shape,
    /// Divisions of each of its edges, 1 or more.
    pub divisions: u32,
    /// Factors along the axes.
    pub semi_axes: DVec3,
}

impl Start {
    /// Returns a shape of its own size.
    #[must_use]
    pub fn new(shape: Shape, divisions: u32) -> Self {
        Self {
            shape,
            divisions,
            semi_axes: DVec3::ONE,
        }
    }

    /// Number of faces of the mesh.
    ///
    /// ```
    /// assert_eq!(sculpt::Start::new(sculpt::Shape::Box, 3).face_count(), 108);
    /// ```
    #[must_use]
    pub fn face_count(&self) -> usize {
        let n = self.divisions as usize;
        n.saturating_mul(n).saturating_mul(self.shape.faces())
    }

    /// Checks the number of faces.
    ///
    /// # Errors
    /// If there would be too many, or none.
    pub fn check(&self) -> Result<(), Error> {
        let n = self.divisions as usize;
        if n == 0 {
            return fail("a start shape has one division or more");
        }
        match n
            .checked_mul(n)
            .and_then(|n| n.checked_mul(self.shape.faces()))
        {
            Some(faces) if faces <= MAX_FACES => Ok(()),
            _ => fail(format!("this would be more than {MAX_FACES} faces")),
        }
    }

    /// Triangulates the shape. Opposite sides have the same pattern mirrored (for a plane, box or
    /// cylinder if the number of divisions is even).
    #[must_use]
    pub fn polygons(&self) -> PolygonSoup {
        let n = self.divisions.max(1) as i32;
        let mut lattice = Lattice::default();
        match self.shape {
            Shape::Plane => lattice.square(n, [IVec3::X, IVec3::Y], IVec3::ZERO),
            Shape::Box | Shape::Cylinder => lattice.cube(n),
            Shape::Sphere => lattice.octahedron(n),
            Shape::Tetrahedron => lattice.tetrahedron(n),
        }
        let mut soup = PolygonSoup::new(
            lattice
                .points
                .iter()
                .map(|p| {
                    let p = p.as_dvec3();
                    self.semi_axes
                        * match self.shape {
                            Shape::Sphere => p / p.length(),
                            Shape::Cylinder => round(p / f64::from(n)),
                            _ => p / f64::from(n),
                        }
                })
                .collect(),
        );
        for triangle in &lattice.triangles {
            soup.add_face(triangle);
        }
        soup
    }
}

/// Returns a point of the cube, moved towards the z-axis so that squares become circles.
fn round(p: DVec3) -> DVec3 {
    let along = (p.x * p.x + p.y * p.y).sqrt();
    if along == 0.0 {
        return p;
    }
    let shrunk = p.x.abs().max(p.y.abs()) / along;
    DVec3::new(p.x * shrunk, p.y * shrunk, p.z)
}

/// Triangles between points with whole coordinates, which are shared.
#[derive(Default)]
struct Lattice {
    points: Vec<IVec3>,
    numbers: BTreeMap<[i32; 3], u32>,
    triangles: Vec<[u32; 3]>,
}

impl Lattice {
    fn vertex(&mut self, p: IVec3) -> u32 {
        let next = self.points.len() as u32;
        let number = *self.numbers.entry(p.to_array()).or_insert(next);
        if number == next {
            self.points.push(p);
        }
        number
    }

    fn triangle(&mut self, corners: [IVec3; 3]) {
        let triangle = corners.map(|p| self.vertex(p));
        self.triangles.push(triangle);
    }

    /// Adds a square with sides of 2n along two axes about a centre, in n² cells; diagonals lead
    /// from the middle outwards.
    fn square(&mut self, n: i32, [u, v]: [IVec3; 2], center: IVec3) {
        for i in 0..n {
            for j in 0..n {
                let [a, b, c, d] = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
                    .map(|(i, j)| center + u * (2 * i - n) + v * (2 * j - n));
                if (2 * i + 1 < n) == (2 * j + 1 < n) {
                    self.triangle([a, b, c]);
                    self.triangle([a, c, d]);
                } else {
                    self.triangle([a, b, d]);
                    self.triangle([b, c, d]);
                }
            }
        }
    }

    fn cube(&mut self, n: i32) {
        let axes = [IVec3::X, IVec3::Y, IVec3::Z];
        for k in 0..3 {
            let [u, v, w] = [1, 2, 3].map(|i| axes[(k + i) % 3]);
            self.square(n, [u, v], w * n);
            self.square(n, [v, u], w * -n);
        }
    }

    /// The triangle of three points, n times the corners, in n² triangles.
    fn divide_triangle(&mut self, n: i32, [a, b, c]: [IVec3; 3]) {
        let at = |i: i32, j: i32| a * (n - i - j) + b * i + c * j;
        for i in 0..n {
            for j in 0..n - i {
                self.triangle([at(i, j), at(i + 1, j), at(i, j + 1)]);
                if i + j + 1 < n {
                    self.triangle([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
                }
            }
        }
    }

    fn octahedron(&mut self, n: i32) {
        for x in [1, -1] {
            for y in [1, -1] {
                for z in [1, -1] {
                    let [a, b, c] = [IVec3::X * x, IVec3::Y * y, IVec3::Z * z];
                    let is_turned = x * y * z < 0;
                    self.divide_triangle(n, if is_turned { [a, c, b] } else { [a, b, c] });
                }
            }
        }
    }

    fn tetrahedron(&mut self, n: i32) {
        let corner = IVec3::new;
        let [a, b, c, d] = [
            corner(1, 1, 1),
            corner(1, -1, -1),
            corner(-1, 1, -1),
            corner(-1, -1, 1),
        ];
        for face in [[a, b, c], [a, d, b], [a, c, d], [b, d, c]] {
            self.divide_triangle(n, face);
        }
    }
}
