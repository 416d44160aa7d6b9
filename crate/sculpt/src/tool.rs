//! Virtual tools: superquadrics.

use crate::solid::Solid;
use crate::start::{Shape, Start};
use core::f64::consts::PI;
use glam::{DMat3, DVec3};
use mesh::{Aabb, PolygonSoup};

/// The basic form of a tool: exponents that it has unless others are chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Box with slightly rounded edges.
    Box,
    /// Cylinder along z with slightly rounded edges.
    Cylinder,
    /// An ellipsoid.
    Sphere,
}

impl Form {
    /// The forms, in the order of the manual.
    pub const ALL: [Self; 3] = [Self::Box, Self::Cylinder, Self::Sphere];

    /// Returns the word for it in texts of strokes.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Box => "box",
            Self::Cylinder => "cylinder",
            Self::Sphere => "sphere",
        }
    }

    /// The exponents (north–south, east–west): 1 is round, 0 square.
    #[must_use]
    pub fn exponents(self) -> [f64; 2] {
        match self {
            Self::Box => [0.1, 0.1],
            Self::Cylinder => [0.1, 1.0],
            Self::Sphere => [1.0, 1.0],
        }
    }
}

/// Superquadric ellipsoid (Barr 1981) about the origin, turned about the axes:
/// `(|x/a|^(2/e₂) + |y/b|^(2/e₂))^(e₂/e₁) + |z/c|^(2/e₁) = 1` with semi-axes a, b, c and exponents
/// e₁, e₂.
///
/// ```
/// use glam::DVec3;
/// use sculpt::{Form, Tool};
///
/// let ball = Tool::new(Form::Sphere, DVec3::splat(2.0));
/// assert_eq!(ball.gauge(DVec3::X), 0.5);
/// assert_eq!(ball.inside_outside(DVec3::X), 0.25);
/// // A box's corner is nearly a corner.
/// let cube = Tool::new(Form::Box, DVec3::ONE);
/// assert!(cube.gauge(DVec3::splat(0.9)) < 1.0 && cube.gauge(DVec3::splat(0.98)) > 1.0);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Tool {
    /// Basic form, which tells how the tool is drawn.
    pub form: Form,
    /// Semi-axes, > 0.
    pub semi_axes: DVec3,
    /// The exponents e₁ and e₂, in [`Tool::EXPONENTS`]: 1 is round, the smaller the squarer, 2 an
    /// octahedron.
    pub exponents: [f64; 2],
    /// Rotations about x, then y, then z, degrees.
    pub turn: DVec3,
}

impl Tool {
    /// Range of the exponents.
    pub const EXPONENTS: [f64; 2] = [0.05, 2.0];

    /// Returns a tool with the exponents of its form, not turned.
    #[must_use]
    pub fn new(form: Form, semi_axes: DVec3) -> Self {
        Self {
            form,
            semi_axes,
            exponents: form.exponents(),
            turn: DVec3::ZERO,
        }
    }

    /// The tool's axes as columns.
    #[must_use]
    pub fn axes(&self) -> DMat3 {
        let [x, y, z] = self.turn.to_array().map(|degrees| {
            let angle = degrees * (PI / 180.0);
            // Quarter turns without a remainder of rounding.
            match libm::fmod(degrees, 360.0) {
                0.0 => (0.0, 1.0),
                90.0 | -270.0 => (1.0, 0.0),
                180.0 | -180.0 => (0.0, -1.0),
                270.0 | -90.0 => (-1.0, 0.0),
                _ => (libm::sin(angle), libm::cos(angle)),
            }
        });
        let about_x = DMat3::from_cols_array(&[1.0, 0.0, 0.0, 0.0, x.1, x.0, 0.0, -x.0, x.1]);
        let about_y = DMat3::from_cols_array(&[y.1, 0.0, -y.0, 0.0, 1.0, 0.0, y.0, 0.0, y.1]);
        let about_z = DMat3::from_cols_array(&[z.1, z.0, 0.0, -z.0, z.1, 0.0, 0.0, 0.0, 1.0]);
        about_z * about_y * about_x
    }

    /// The distance of a point from the centre, as a multiple of the surface's along the same ray:
    /// below 1 inside. It is the nested norm `‖(‖(x/a, y/b)‖, z/c)‖` with powers 2/e₂ and 2/e₁.
    #[must_use]
    pub fn gauge(&self, point: DVec3) -> f64 {
        self.gauge_along(self.axes(), point)
    }

    fn gauge_along(&self, axes: DMat3, point: DVec3) -> f64 {
        let local = (axes.transpose() * point / self.semi_axes).abs();
        let [north, east] = self.exponents.map(|e| 2.0 / e);
        norm(norm(local.x, local.y, east), local.z, north)
    }

    /// The inside–outside function: below 1 inside, 1 on the surface; the gauge to the power of
    /// 2/e₁.
    #[must_use]
    pub fn inside_outside(&self, point: DVec3) -> f64 {
        libm::pow(self.gauge(point), 2.0 / self.exponents[0])
    }

    /// The polyhedron by which the tool is drawn: its form's start mesh with n divisions, put on
    /// the superquadric.
    #[must_use]
    pub fn polyhedron(&self, n: u32) -> PolygonSoup {
        let shape = match self.form {
            Form::Box => Shape::Box,
            Form::Cylinder => Shape::Cylinder,
            Form::Sphere => Shape::Sphere,
        };
        let start = Start::new(shape, n.clamp(1, 64));
        let mut soup = start.polygons();
        let axes = self.axes();
        for p in &mut soup.positions {
            let turned = axes * (*p * self.semi_axes);
            *p = turned / self.gauge_along(axes, turned);
        }
        soup
    }

    /// The tool as a solid.
    #[must_use]
    pub fn solid(&self) -> impl Solid + use<> {
        Placed {
            axes: self.axes(),
            tool: self.clone(),
        }
    }
}

/// Tool with its axes worked out.
struct Placed {
    tool: Tool,
    axes: DMat3,
}

impl Solid for Placed {
    fn bounds(&self) -> Aabb {
        let half = self.axes.abs() * self.tool.semi_axes;
        Aabb {
            min: -half,
            max: half,
        }
    }

    fn step(&self) -> f64 {
        0.5 * self.tool.semi_axes.min_element()
    }

    fn contains(&self, point: DVec3) -> bool {
        self.tool.gauge_along(self.axes, point) < 1.0
    }

    fn drive_out(&self, point: DVec3) -> Option<DVec3> {
        let gauge = self.tool.gauge_along(self.axes, point);
        let surface = point / gauge;
        (gauge < 1.0 && surface.is_finite()).then_some(surface)
    }
}

/// `(a^k + b^k)^(1/k)` for a, b ≥ 0, without overflow.
fn norm(a: f64, b: f64, k: f64) -> f64 {
    let (large, small) = if a > b { (a, b) } else { (b, a) };
    if small == 0.0 {
        return large;
    }
    let t = small / large;
    if k == 2.0 {
        large * (1.0 + t * t).sqrt()
    } else {
        large * libm::pow(1.0 + libm::pow(t, k), 1.0 / k)
    }
}
