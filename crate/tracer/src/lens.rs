//! The rays of a square's pixels in single precision, eight at a time.
//!
//! The direction through a pixel is that through the square's middle plus a small deviation. For a
//! view `w = w₀ + δ`, where δ lies in the plane of the picture, the deviation is
//! `w/|w| − w₀/|w₀| = a·g + ε(1+g)` with the axis a = w₀/|w₀|, ε = δ/|w₀|,
//! e = |w|²/|w₀|² − 1 = 2a·ε + ε·ε and `g = 1/√(1+e) − 1 = −e/(√(1+e)·(1 + √(1+e)))`: nothing
//! cancels, so single precision gives the deviation to its own last digits, wherever the eye is.
use crate::area::Area;
use crate::beam::Beam;
use crate::lanes::least;
use crate::layout::PACKET;
use crate::nearby::Nearby;
use crate::quick::Rays;
use crate::ray::Ray;
use crate::view::View;
use field::Real;
use glam::DVec3;
use wide::f32x8;

/// Largest spread of a square's beam for which there is a lens.
const WIDEST_LENS: f64 = 0.25;

/// A map from positions in a square to rays.
pub(crate) struct Lens {
    axis: Ray,
    /// Change of ε from a pixel to the next one, to the right and down.
    steps: [DVec3; 2],
}

/// The rays of a packet.
pub(crate) struct Fan {
    /// Directions less the axis'.
    deviation: [f32x8; 3],
    /// Deviation of the packet's middle.
    middle: DVec3,
    /// Largest distance of a direction from the middle's.
    spread: f64,
}

impl Lens {
    /// Prepares an area, given its beam. `None` if that is too wide.
    pub fn new(camera: &View, area: Area, beam: &Beam) -> Option<Self> {
        if beam.spread.is_nan() || beam.spread > WIDEST_LENS {
            return None;
        }
        let [l, t, r, b] = [area.left, area.top, area.right, area.bottom].map(f64::from);
        let [width, height] = camera.size.map(f64::from);
        let (x, y) = (0.5 * (l + r) / width, 0.5 * (t + b) / height);
        let view = camera.projection.view(x, y);
        let length = view.length();
        let [right, down] = camera.projection.across();
        Some(Self {
            axis: beam.axis,
            steps: [right / (width * length), down / (height * length)],
        })
    }

    /// Returns the rays through places given in pixels from the square's middle, around the ray
    /// through one in their midst.
    pub fn fan(&self, places: [f32x8; 2], middle: [f64; 2]) -> Fan {
        let deviation = self.deviation(places);
        let middle = self.deviation(middle);
        let [x, y, z]: [f32x8; 3] =
            core::array::from_fn(|k| deviation[k] - f32x8::splat(middle[k] as f32));
        let widest = -least(-(x * x + y * y + z * z));
        let middle = DVec3::from_array(middle);
        Fan {
            deviation,
            middle,
            spread: f64::from(widest).sqrt() * 1.001 + 1e-7 * middle.length(),
        }
    }

    /// Returns the deviation of a ray's direction from the axis', given its place in pixels from
    /// the square's middle.
    #[inline(always)]
    fn deviation<R: Real>(&self, [x, y]: [R; 2]) -> [R; 3] {
        let one = R::splat(1.0);
        let axis = self.axis.direction;
        let [right, down] = self.steps;
        let lean = x * R::splat(2.0 * axis.dot(right)) + y * R::splat(2.0 * axis.dot(down));
        // The two steps are at right angles.
        let excess = lean
            + x * x * R::splat(right.length_squared())
            + y * y * R::splat(down.length_squared());
        let root = (one + excess).sqrt();
        let shrink = -(excess / (root * (one + root)));
        let stay = one + shrink;
        core::array::from_fn(|k| {
            let aside = x * R::splat(right[k]) + y * R::splat(down[k]);
            R::splat(axis[k]) * shrink + aside * stay
        })
    }

    /// Returns a fan's rays, with parameters counted from the base of a list of the blobs near the
    /// square.
    pub fn rays(&self, fan: &Fan, near: &Nearby) -> Rays {
        let base = f32x8::splat(near.base as f32);
        let axis = self.axis.direction;
        let direction = axis + fan.middle;
        let spread = fan.spread + (direction.length() - 1.0).abs();
        Rays {
            origin: fan.deviation.map(|d| d * base),
            direction: core::array::from_fn(|k| f32x8::splat(axis[k] as f32) + fan.deviation[k]),
            beam: Beam {
                axis: Ray {
                    origin: near.middle + fan.middle * near.base,
                    direction: direction.normalize(),
                },
                radius: spread * near.base,
                spread,
                ahead: spread * near.base,
            },
        }
    }

    /// Returns a fan's rays in double precision.
    pub fn wide(&self, fan: &Fan) -> [Ray; PACKET] {
        let [x, y, z] = fan.deviation.map(f32x8::to_array);
        core::array::from_fn(|i| Ray {
            origin: self.axis.origin,
            direction: self.axis.direction
                + DVec3::new(f64::from(x[i]), f64::from(y[i]), f64::from(z[i])),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use scene::{Camera, Scene};

    #[test]
    fn the_rays_are_those_of_the_picture_and_within_their_beam() {
        for (distance, fov, shift) in [
            (10.0, 45.0, [0.0; 2]),
            (1e4, 0.02, [0.0; 2]),
            (3.0, 100.0, [0.4, -0.7]),
        ] {
            let scene = Scene {
                camera: Camera {
                    eye: DVec3::new(0.3, -0.5, 1.0).normalize() * distance,
                    fov,
                    shift,
                    ..Camera::default()
                },
                ..Scene::default()
            };
            let view = View {
                size: [512, 384],
                projection: scene.camera.projection(512, 384),
                shortest: 1.0,
            };
            for (left, top) in [(0, 0), (256, 128), (448, 320)] {
                let area = Area {
                    left,
                    top,
                    right: left + 64,
                    bottom: top + 64,
                };
                let beam = view.beam(area);
                let lens = Lens::new(&view, area, &beam).expect("a narrow square");
                let mut near = Nearby::default();
                near.begin(beam.axis.at(distance), distance);
                let x: [f64; 8] = core::array::from_fn(|i| -31.75 + 17.0 * (i % 4) as f64);
                let y: [f64; 8] = core::array::from_fn(|i| 3.5 + 20.0 * (i / 4) as f64);
                let places = [x, y].map(|place| f32x8::from_lanes(|i| place[i]));
                let fan = lens.fan(places, [-6.0, 13.0]);
                let rays = lens.rays(&fan, &near);
                let wide = lens.wide(&fan);
                // Single precision of the square's width.
                let digits = 3e-7 * beam.spread;
                for (i, ray) in wide.iter().enumerate() {
                    let want =
                        view.ray(f64::from(left) + 32.0 + x[i], f64::from(top) + 32.0 + y[i]);
                    let off = ray.direction.distance(want.direction);
                    assert!(off < digits, "{fov} {left} {i}: {off} of {digits}");
                    let [origin, direction] = [rays.origin, rays.direction]
                        .map(|v| DVec3::from_array(v.map(|v| v.lane(i))));
                    let start = want.at(distance) - near.middle;
                    let off = start.distance(origin);
                    assert!(off < 2.0 * digits * distance, "{fov} {left} {i}: {off}");
                    assert!(want.direction.distance(direction) < 2e-7);
                    let beam = &rays.beam;
                    assert!(beam.axis.direction.distance(want.direction) <= beam.spread);
                    let start = near.middle + start;
                    assert!(start.distance(beam.axis.origin) <= beam.radius);
                }
            }
        }
    }

    #[test]
    fn a_square_seen_at_a_wide_angle_has_none() {
        let mut scene = Scene::default();
        scene.camera.fov = 120.0;
        let view = View {
            size: [32, 32],
            projection: scene.camera.projection(32, 32),
            shortest: 1.0,
        };
        let area = Area {
            left: 0,
            top: 0,
            right: 64,
            bottom: 64,
        };
        assert!(Lens::new(&view, area, &view.beam(area)).is_none());
    }
}
