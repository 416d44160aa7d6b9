//! The field on a plane, eight points at a time, a little in each frame.

use field::{BlobScale, Implicit, Kernel, Shaping, Sum};
use glam::DVec3;
use picture::contour::Grid;
use wide::f32x8;

/// Returns the shaping of a primitive in the lessons from kernel, radius and magnitude of the
/// blobbiness.
#[must_use]
pub fn shaping(kernel: Kernel, radius: f64, blobbiness: f64) -> Shaping {
    Shaping {
        kernel,
        radius,
        blobbiness,
        blob_scale: BlobScale::Relative,
        strength: 1.0,
        influence: 1e-3,
        taper: None,
    }
}

/// A rectangle in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// The lower left corner.
    pub corner: DVec3,
    /// The vector along the lower side.
    pub across: DVec3,
    /// The vector along the left side.
    pub up: DVec3,
}

impl Window {
    /// Returns the point at shares of both sides.
    #[must_use]
    pub fn at(&self, x: f64, y: f64) -> DVec3 {
        self.corner + self.across * x + self.up * y
    }
}

/// Computes the largest of the fields of some bodies at eight points, which is above T inside any
/// of them; 0 without bodies.
#[must_use]
pub fn eight(bodies: &[&dyn Implicit], points: [DVec3; 8]) -> [f32; 8] {
    let point = [0, 1, 2].map(|axis: usize| f32x8::from(points.map(|p| p[axis] as f32)));
    let values = bodies.iter().map(|body| body.jet8(point).value);
    let largest = values.reduce(|a, b| a.fast_max(b));
    largest.unwrap_or(f32x8::splat(0.0)).to_array()
}

/// Computes the largest of the fields of some bodies at a point, as [`eight`] does.
#[must_use]
pub fn one(bodies: &[&dyn Implicit], point: DVec3) -> f64 {
    f64::from(eight(bodies, [point; 8])[0])
}

/// Finds for each of eight points the body whose field is the largest there, and the lead of that
/// field over the next one's.
#[must_use]
pub fn leading(bodies: &[&dyn Implicit], points: [DVec3; 8]) -> [(u32, f32); 8] {
    let point = [0, 1, 2].map(|axis: usize| f32x8::from(points.map(|p| p[axis] as f32)));
    let mut leading = [(0, f32::INFINITY); 8];
    let mut most = [f32::NEG_INFINITY; 8];
    for (number, body) in (0..).zip(bodies) {
        for (lane, value) in body.jet8(point).value.to_array().into_iter().enumerate() {
            let apart = (value - most[lane]).abs();
            if value > most[lane] {
                most[lane] = value;
                leading[lane] = (number, apart);
            } else {
                leading[lane].1 = leading[lane].1.min(apart);
            }
        }
    }
    leading
}

/// A grid that is being filled.
#[derive(Clone, Debug, Default)]
pub struct Filling {
    /// The samples so far.
    pub grid: Grid,
    /// The leading body of each, see [`leading`], if there are several bodies.
    pub leading: Vec<(u32, f32)>,
}

impl Filling {
    /// Makes an empty grid of a size.
    #[must_use]
    pub fn new(width: usize, height: usize) -> Self {
        Self {
            grid: Grid {
                width: width.max(2),
                height: height.max(2),
                values: Vec::new(),
            },
            leading: Vec::new(),
        }
    }

    /// Returns whether every sample is there.
    #[must_use]
    pub fn is_full(&self) -> bool {
        self.grid.values.len() >= self.grid.width * self.grid.height
    }

    /// Goes on until the grid is full or `enough` returns true, which is called the more often, the
    /// more elements the bodies have. Returns whether the grid is full.
    pub fn go_on(
        &mut self,
        bodies: &[&dyn Implicit],
        elements: usize,
        window: &Window,
        mut enough: impl FnMut() -> bool,
    ) -> bool {
        let Grid { width, height, .. } = self.grid;
        let all = width * height;
        // A batch takes some tens of microseconds, whatever the field.
        let batch = (4000 / elements.max(1)).clamp(1, 64);
        let mut done = 0;
        while self.grid.values.len() < all {
            let first = self.grid.values.len();
            let points = core::array::from_fn(|lane| {
                let index = (first + lane).min(all - 1);
                let x = (index % width) as f64 / (width - 1) as f64;
                let y = (index / width) as f64 / (height - 1) as f64;
                window.at(x, y)
            });
            let values = eight(bodies, points);
            let left = (all - first).min(8);
            self.grid.values.extend_from_slice(&values[..left]);
            if bodies.len() > 1 {
                self.leading
                    .extend_from_slice(&leading(bodies, points)[..left]);
            }
            done += 1;
            if done % batch == 0 && enough() {
                break;
            }
        }
        self.is_full()
    }
}

/// Samples the field on a whole grid at once.
#[must_use]
pub fn whole(field: &Sum, window: &Window, width: usize, height: usize) -> Grid {
    let mut filling = Filling::new(width, height);
    filling.go_on(&[field], field.primitives.len(), window, || false);
    filling.grid
}

#[cfg(test)]
mod tests {
    use super::*;
    use field::{Primitive, Skeleton, THRESHOLD};
    use std::sync::Arc;

    #[test]
    fn samples_are_the_field() {
        let shaping = shaping(Kernel::Cauchy, 0.5, 2.0);
        let skeleton = Skeleton::Segment {
            base: DVec3::NEG_X,
            apex: DVec3::X,
        };
        let field: Sum = Primitive::new(skeleton, &shaping, None)
            .into_iter()
            .collect();
        let window = Window {
            corner: DVec3::new(-2.0, -1.0, 0.0),
            across: DVec3::X * 4.0,
            up: DVec3::Y * 2.0,
        };
        let grid = whole(&field, &window, 61, 41);
        assert_eq!(grid.values.len(), 61 * 41);
        for (index, value) in grid.values.iter().enumerate() {
            let point = window.at((index % 61) as f64 / 60.0, (index / 61) as f64 / 40.0);
            let want = field.jet(point).value;
            // Single precision; see the accuracy in the docs of `field`.
            assert!((f64::from(*value) - want).abs() < 1e-5 * want.max(1.0));
        }
        let mut filling = Filling::new(61, 41);
        let bodies: &[&dyn Implicit] = &[&field];
        assert!(!filling.go_on(bodies, 1, &window, || true));
        while !filling.go_on(bodies, 1, &window, || true) {}
        assert_eq!(filling.grid, grid);
    }

    #[test]
    fn bodies_in_contact_have_one_border() {
        let shaping = shaping(Kernel::Cauchy, 0.8, 2.0);
        let [left, right] = [-0.5, 0.5].map(|x| -> Arc<dyn Implicit> {
            let center = DVec3::X * x;
            let own = Primitive::new(Skeleton::Point { center }, &shaping, None);
            Arc::new(own.into_iter().collect::<Sum>())
        });
        let window = Window {
            corner: DVec3::new(-2.0, -1.0, 0.0),
            across: DVec3::X * 4.0,
            up: DVec3::Y * 2.0,
        };
        let [a, b] = [(&left, &right), (&right, &left)].map(|(own, other)| {
            let pressed_by = vec![(other.clone(), contact::Bulge::default())];
            contact::Squashed::new(own.clone(), pressed_by)
        });
        for (bodies, touch) in [
            ([&a as &dyn Implicit, &b], true),
            ([&*left, &*right], false),
        ] {
            let mut filling = Filling::new(80, 41);
            filling.go_on(&bodies, 2, &window, || false);
            let border = filling.grid.border(&filling.leading, THRESHOLD as f32);
            assert_eq!(border.is_empty(), !touch);
            // It is the line x = 0, in the middle of an odd number of steps.
            assert!(
                border
                    .iter()
                    .flatten()
                    .all(|[x, _]| (x - 39.5).abs() < 0.05)
            );
            let length: f32 = border.iter().map(|[p, q]| (p[1] - q[1]).abs()).sum();
            assert!(!touch || length > 15.0, "{length}");
        }
    }
}
