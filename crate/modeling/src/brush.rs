//! The tool in hand.

use glam::{DQuat, DVec3};
use sculpt::{Action, Choice, Constraint, Decay, Form, Sweep, Tool};

/// The effect of the tool.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Doing {
    /// Drives the surface out of itself.
    Push,
    /// Takes the surface along.
    Pull,
    /// Evens it.
    Smooth,
    /// Keeps it from moving.
    Mask,
    /// Colours it.
    Paint,
    /// Chooses faces.
    Region,
}

impl Doing {
    /// The effects in the order of the page.
    pub const ALL: [Self; 6] = [
        Self::Pull,
        Self::Push,
        Self::Smooth,
        Self::Mask,
        Self::Paint,
        Self::Region,
    ];

    /// Returns the name on the page.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Push => "Push",
            Self::Pull => "Pull",
            Self::Smooth => "Smooth",
            Self::Mask => "Mask",
            Self::Paint => "Paint",
            Self::Region => "Region",
        }
    }

    /// Returns a sentence on the effect.
    #[must_use]
    pub fn meaning(self) -> &'static str {
        match self {
            Self::Push => "Dents the surface; with Ctrl it swells (P)",
            Self::Pull => "Takes the surface along (L)",
            Self::Smooth => "Evens the surface (hold Shift with any tool)",
            Self::Mask => "Holds the surface fast; with Ctrl it lets go (M)",
            Self::Paint => "Colours the surface (C)",
            Self::Region => {
                "Chooses faces to refine, smooth or delete; with Ctrl it takes them out (B)"
            }
        }
    }
}

/// A virtual tool with its settings.
#[derive(Clone, Debug, PartialEq)]
pub struct Brush {
    /// The effect.
    pub doing: Doing,
    /// The basic form.
    pub form: Form,
    /// The radius, as a length of the mesh.
    pub size: f64,
    /// Factors of the radius along its axes.
    pub stretch: DVec3,
    /// The exponents of its superquadric.
    pub exponents: [f64; 2],
    /// The rotation.
    pub turn: DQuat,
    /// The function by which a motion fades over neighbours.
    pub decay: Decay,
    /// The distance at which it has faded, as a multiple of the radius.
    pub range: f64,
    /// A limit on the direction of motions.
    pub constraint: Option<Constraint>,
    /// Whether only the region is touched.
    pub only_region: bool,
    /// The colour that it paints, sRGB.
    pub color: [f32; 3],
}

impl Brush {
    /// A round tool that pulls.
    #[must_use]
    pub fn new(size: f64) -> Self {
        Self {
            doing: Doing::Pull,
            form: Form::Sphere,
            size,
            stretch: DVec3::ONE,
            exponents: Form::Sphere.exponents(),
            turn: DQuat::IDENTITY,
            decay: Decay::Bell,
            range: 1.5,
            constraint: None,
            only_region: false,
            color: [0.85, 0.35, 0.25],
        }
    }

    /// Takes another basic form, with its exponents.
    pub fn set_form(&mut self, form: Form) {
        self.form = form;
        self.exponents = form.exponents();
    }

    /// The tool as a text says it: with numbers of a few digits.
    #[must_use]
    pub fn tool(&self, decimals: i32) -> Tool {
        let axes = (self.stretch * self.size).max(DVec3::splat(sculpt::limits::SMALLEST));
        let mut tool = Tool::new(
            self.form,
            round_vector(axes, decimals).max(DVec3::splat(smallest(decimals))),
        );
        tool.exponents = self.exponents.map(|e| round(e, 2).clamp(0.05, 2.0));
        tool.turn = round_vector(angles(self.turn), 1);
        tool
    }

    /// A stroke of it without a path. `reverses`: the other way about, as Ctrl asks.
    #[must_use]
    pub fn sweep(&self, doing: Doing, reverses: bool, decimals: i32) -> Sweep {
        let action = match doing {
            Doing::Push => Action::Push,
            Doing::Pull => Action::Pull,
            Doing::Smooth => Action::Smooth,
            Doing::Mask => Action::Mask(if reverses { 0.0 } else { 1.0 }),
            Doing::Paint => Action::Paint(self.color.map(|c| round(f64::from(c), 3))),
            Doing::Region if reverses => Action::Region(Choice::Remove),
            Doing::Region => Action::Region(Choice::Add),
        };
        let mut sweep = Sweep::new(action, self.tool(decimals));
        let fades = !matches!(doing, Doing::Region);
        let range = round(self.range * self.size, decimals);
        if fades && range > 0.0 {
            sweep.decay = self.decay;
            sweep.range = range;
        }
        if matches!(doing, Doing::Push | Doing::Pull | Doing::Smooth) {
            sweep.constraint = self.constraint;
        }
        sweep.only_region = self.only_region && doing != Doing::Region;
        sweep
    }
}

/// Rounds a number to decimals; returns 0 where the result would not be finite.
pub fn round(x: f64, decimals: i32) -> f64 {
    let factor = power(decimals);
    let rounded = (x * factor).round() / factor;
    // No minus before nothing.
    if rounded.is_finite() {
        rounded + 0.0
    } else {
        0.0
    }
}

/// Rounds a vector to decimals.
pub fn round_vector(p: DVec3, decimals: i32) -> DVec3 {
    DVec3::from_array(p.to_array().map(|x| round(x, decimals)))
}

fn power(decimals: i32) -> f64 {
    (0..decimals.clamp(0, 12)).fold(1.0, |p, _| p * 10.0)
}

fn smallest(decimals: i32) -> f64 {
    (1.0 / power(decimals)).max(sculpt::limits::SMALLEST)
}

/// Decimals for lengths of a mesh of this size: about a ten-thousandth of it.
pub fn decimals(size: f64) -> i32 {
    if !(size.is_finite() && size > 0.0) {
        return 4;
    }
    (4.0 - libm::floor(libm::log10(size))).clamp(0.0, 9.0) as i32
}

/// Rotations about x, then y, then z, degrees.
fn angles(turn: DQuat) -> DVec3 {
    let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| turn * axis);
    // z-rotation · y-rotation · x-rotation: x = (cos b cos c, cos b sin c, −sin b).
    let b = libm::asin((-x.z).clamp(-1.0, 1.0));
    let (a, c) = if x.z.abs() < 0.999_999 {
        (libm::atan2(y.z, z.z), libm::atan2(x.y, x.x))
    } else {
        (libm::atan2(-z.y, y.y), 0.0)
    };
    DVec3::new(a, b, c) * (180.0 / core::f64::consts::PI)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_are_those_of_the_tool() {
        for (axis, angle) in [
            (DVec3::X, 0.4),
            (DVec3::new(1.0, 2.0, -0.5), 1.1),
            (DVec3::new(-0.3, 0.1, 0.9), 2.8),
            (DVec3::Y, core::f64::consts::FRAC_PI_2),
            (DVec3::Z, -0.7),
        ] {
            let half = 0.5 * angle;
            let axis = axis.normalize() * libm::sin(half);
            let turn = DQuat::from_xyzw(axis.x, axis.y, axis.z, libm::cos(half));
            let mut tool = Tool::new(Form::Box, DVec3::ONE);
            tool.turn = angles(turn);
            for (own, column) in [DVec3::X, DVec3::Y, DVec3::Z].into_iter().zip([0, 1, 2]) {
                assert!(
                    (turn * own).distance(tool.axes().col(column)) < 1e-6,
                    "{axis} {angle}"
                );
            }
        }
    }

    #[test]
    fn numbers_are_short_and_valid_in_a_text() {
        for size in [1e-3, 0.37, 12.0, 4e4] {
            let decimals = decimals(size);
            let mut brush = Brush::new(0.123_456_789 * size);
            brush.stretch.y = 1e-12;
            let mut sweep = brush.sweep(Doing::Push, false, decimals);
            sweep.path.push(sculpt::PathPoint::new(round_vector(
                DVec3::splat(size / 7.0),
                decimals,
            )));
            let text = format!("strokes 1\nstart box 2\n{}\n", sculpt::Stroke::Sweep(sweep));
            assert!(text.len() < 140, "{text}");
            let _: sculpt::Script = text.parse().unwrap();
        }
        assert_eq!(round(-0.00001, 3).to_bits(), 0.0_f64.to_bits());
    }
}
