//! Kinks of profiles: where a wave has a kink or a jump and where a parameter is clamped to [0, 1].
//! They lie on planes, across a segment or a triangle, or through the axis of an arc: a ray meets
//! each plane at one parameter, and between those the field is smooth.
use crate::skeleton::orthonormal;
use crate::{Primitive, Skeleton, Wave};
use glam::DVec3;

/// A plane on which a profile is not smooth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kink {
    /// Point of the plane.
    pub point: DVec3,
    /// Unit normal.
    pub normal: DVec3,
    /// Whether the profile itself may jump there, not only its slope.
    pub jumps: bool,
    /// Direction, seen from the point, of that half of an arc's plane which has the kink; 0 for
    /// other skeletons.
    toward: DVec3,
}

/// Largest number of kinks of one wave along a bone; further ones are left out.
const MOST_KINKS: f64 = 4096.0;

impl Kink {
    fn new(point: DVec3, normal: DVec3, jumps: bool) -> Self {
        Self {
            point,
            normal: normal.normalize_or_zero(),
            jumps,
            toward: DVec3::ZERO,
        }
    }

    /// Whether a ball meets the plane, or for an arc that half of it which has the kink.
    #[must_use]
    pub fn cuts(&self, center: DVec3, radius: f64) -> bool {
        let from = center - self.point;
        from.dot(self.normal).abs() <= radius && from.dot(self.toward) >= -radius
    }

    /// Parameter at which a ray crosses the plane; infinite or NaN if it is parallel to it.
    #[must_use]
    pub fn along(&self, origin: DVec3, direction: DVec3) -> f64 {
        self.normal.dot(self.point - origin) / self.normal.dot(direction)
    }
}

/// The kinks of a primitive's profile.
#[must_use]
pub fn of(primitive: &Primitive) -> Vec<Kink> {
    let mut kinks = Vec::new();
    let Some(profile) = &primitive.profile else {
        return kinks;
    };
    let jumps = |i: usize| matches!(profile.waves[i], Wave::Saw | Wave::Step);
    match &primitive.skeleton {
        Skeleton::Segment { base, apex } => {
            let axis = *apex - *base;
            for u in breaks(profile.waves[0], profile.scale[0]) {
                kinks.push(Kink::new(*base + axis * u, axis, jumps(0)));
            }
        }
        Skeleton::Triangle { corners: [a, b, c] } => {
            let (e1, e2) = (*b - *a, *c - *a);
            let normal = e1.cross(e2);
            // Planes of constant u, v and 1 − u − v: their gradients are normal to them.
            let (by_u, by_v) = (e2.cross(normal), normal.cross(e1));
            for (i, gradient, edge) in [(0, by_u, e1), (1, by_v, e2)] {
                for u in breaks(profile.waves[i], profile.scale[i]) {
                    kinks.push(Kink::new(*a + edge * u, gradient, jumps(i)));
                }
            }
            if profile.restriction != 0.0 {
                for (corner, gradient) in [(*a, by_u), (*a, by_v), (*b, by_u + by_v)] {
                    kinks.push(Kink::new(corner, gradient, false));
                }
            }
        }
        Skeleton::Arc {
            center,
            u,
            v,
            angle,
            ..
        } if profile.waves[0] != Wave::One => {
            let (x, y) = orthonormal(*u, *v);
            let mut at = |azimuth: f64, jumps: bool| {
                let (sine, cosine) = libm::sincos(azimuth);
                kinks.push(Kink {
                    toward: x * cosine + y * sine,
                    ..Kink::new(*center, y * cosine - x * sine, jumps)
                });
            };
            // The parameter jumps from end to end in the middle of the gap.
            at(0.5 * angle + core::f64::consts::PI, true);
            for u in breaks(profile.waves[0], profile.scale[0]) {
                at(u * angle, jumps(0));
            }
        }
        // Profiles of other bones have no kinks.
        _ => (),
    }
    kinks
}

/// The parameters at which a wave is not smooth, the ends of [0, 1] among them.
fn breaks(wave: Wave, scale: f64) -> Vec<f64> {
    if wave == Wave::One {
        return Vec::new();
    }
    let mut found = vec![0.0, 1.0];
    let step = match wave {
        Wave::X => 1.0,
        Wave::Saw | Wave::Hat | Wave::Step => 0.5,
        _ => return found,
    };
    let count = (scale.abs() / step).min(MOST_KINKS);
    for k in 1..=count as u32 {
        found.push(f64::from(k) * step / scale.abs());
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BlobScale, Kernel, Profile, Shaping};
    use trials::Random;

    /// Length of a step along a ray.
    const STEP: f64 = 1e-4;
    /// Second difference over the step's square that separates smooth places from kinks and jumps,
    /// mostly.
    const SHARP: f64 = 1e3;

    fn wavy(which: usize, random: &mut Random) -> Primitive {
        let [a, b, c] = [(); 3].map(|()| random.vector(1.0));
        let skeleton = match which % 3 {
            0 => Skeleton::Segment { base: a, apex: b },
            1 => Skeleton::Triangle { corners: [a, b, c] },
            _ => Skeleton::Arc {
                center: a * 0.3,
                u: b,
                v: c,
                radius: 0.7,
                angle: random.range(1.0, 5.0),
            },
        };
        let waves = [
            Wave::One,
            Wave::X,
            Wave::Saw,
            Wave::Hat,
            Wave::Step,
            Wave::Sin,
        ];
        let profile = Profile {
            waves: [waves[which / 3 % 6], waves[which / 18 % 6]],
            scale: [(); 2].map(|()| random.range(1.0, 4.0)),
            bounds: [0.2, 1.0],
            times: 1.0,
            restriction: if which.is_multiple_of(2) { 0.0 } else { 0.8 },
        };
        let shaping = Shaping {
            kernel: Kernel::Cauchy,
            radius: 0.5,
            blobbiness: 0.5,
            blob_scale: BlobScale::Relative,
            strength: 1.0,
            influence: 1e-3,
            taper: None,
        };
        Primitive::new(skeleton, &shaping, Some(profile)).expect("flesh")
    }

    #[test]
    fn between_the_kinks_a_field_is_smooth() {
        let mut random = Random::new(9);
        let (mut sharp, mut told) = (0, 0);
        for which in 0..108 {
            let primitive = wavy(which, &mut random);
            let kinks = of(&primitive);
            let (direction, offset) = (random.direction(), random.direction() * 0.4);
            let origin = offset - direction;
            let at =
                |i: i32| primitive.value((origin + direction * (STEP * f64::from(i))).to_array());
            let places: Vec<f64> = kinks.iter().map(|k| k.along(origin, direction)).collect();
            told += places.iter().filter(|t| (0.0..2.0).contains(*t)).count();
            let (mut before, mut here) = (at(0), at(1));
            for i in 2..20_000 {
                let after = at(i);
                let bend = (after - 2.0 * here + before).abs() / (STEP * STEP);
                (before, here) = (here, after);
                if bend > SHARP {
                    sharp += 1;
                    let t = STEP * f64::from(i - 1);
                    let is_listed = places.iter().any(|place| (place - t).abs() <= 1.5 * STEP);
                    assert!(is_listed, "{which} {t}: {bend} {places:?}");
                }
            }
        }
        // Most kinks are sharp, of two or three differences each; few listed ones are none.
        assert!(sharp > 100 && told < 3 * sharp, "{sharp} {told}");
    }
}
