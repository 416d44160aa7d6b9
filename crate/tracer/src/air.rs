//! Air and surroundings, which rays pass and see beside surfaces: background, sky, fog, clouds of
//! light, and the plane of the ground.
//!
//! Everything here is in the world's coordinates.
use core::f64::consts::TAU;
use glam::{DVec2, DVec3, Vec3};
use scene::{Background, Cloud, Fog, Ground, Scene, Sky};
use std::sync::Arc;
use texture::{Edge, Rgb8};

/// Sine of the height above the horizon at which a gradient reaches its first colour; as far below
/// it reaches the last.
const GRADIENT: f64 = 0.5;
/// Distances from the scene's middle, in halves of its size, between which the ground fades into
/// the background.
const GROUND: [f64; 2] = [4.0, 16.0];

/// Air and surroundings.
pub(crate) struct Air {
    background: Background,
    image: Option<Arc<Rgb8>>,
    pub sky: Option<Sky>,
    fog: Option<Fog>,
    clouds: Vec<Cloud>,
    ground: Option<Floor>,
    up: DVec3,
}

/// The plane of the ground.
#[derive(Clone, Copy, Debug)]
struct Floor {
    colour: Vec3,
    height: f64,
    middle: DVec3,
    /// Half the scene's size.
    size: f64,
}

/// A point of the ground that a ray meets.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GroundPoint {
    /// The ray's parameter.
    pub t: f64,
    pub position: DVec3,
    pub normal: DVec3,
    pub colour: Vec3,
    /// Share of the ground there; the rest is background.
    pub cover: f32,
}

impl Air {
    /// Prepares a scene's air. `lowest` is the scene's least height, `middle` and `size` its middle
    /// and half its size.
    pub fn new(scene: &Scene, lowest: f64, middle: DVec3, size: f64) -> Self {
        let image = match scene.background {
            Background::Image(index) => scene.images.get(index as usize).cloned(),
            _ => None,
        };
        Self {
            background: scene.background.clone(),
            image,
            sky: scene.sky,
            fog: scene.fog.filter(|fog| fog.distance > 0.0),
            clouds: scene.clouds.clone(),
            ground: scene.ground.map(|Ground { colour, height }| {
                let height = height.unwrap_or(lowest);
                Floor {
                    colour: Vec3::from(colour),
                    height: if height.is_finite() { height } else { 0.0 },
                    middle,
                    size,
                }
            }),
            up: scene.up.normalize_or(DVec3::Y),
        }
    }

    /// Whether every ray that meets no surface sees the same colour.
    pub fn is_plain(&self) -> bool {
        matches!(self.background, Background::Colour(_))
            && self.fog.is_none()
            && self.clouds.is_empty()
            && self.ground.is_none()
    }

    /// Returns the light from a direction in which there is nothing.
    pub fn background(&self, direction: DVec3) -> Vec3 {
        match &self.background {
            Background::Colour(colour) => Vec3::from(*colour),
            Background::Gradient(colours) => {
                let height = direction.dot(self.up).clamp(-GRADIENT, GRADIENT);
                let share = 0.5 - 0.5 * height / GRADIENT;
                let last = colours.len().saturating_sub(1);
                let place = share * last as f64;
                let first = (place as usize).min(last);
                let [below, above] = [first, first + 1]
                    .map(|i| colours.get(i.min(last)).map_or(Vec3::ZERO, |&c| c.into()));
                below.lerp(above, (place - first as f64) as f32)
            }
            Background::Image(_) => {
                let Some(image) = &self.image else {
                    return Vec3::splat(0.5);
                };
                let [front, side] = self.around();
                let (x, z) = (direction.dot(side), direction.dot(front));
                let around = libm::atan2(x, z) / TAU + 0.5;
                let flat = (x * x + z * z).sqrt();
                let height = libm::atan2(direction.dot(self.up), flat) / (0.5 * TAU) + 0.5;
                let inner = 0.5 / f64::from(image.size[1].max(1));
                let height = height.clamp(inner, 1.0 - inner);
                let colour = texture::sample(&**image, DVec2::new(around, height), Edge::Wrap);
                colour.map_or(Vec3::ZERO, |c| DVec3::from_array(c).as_vec3())
            }
        }
    }

    /// Returns two unit vectors across `up`: towards the middle of an image around the scene, and
    /// to its right.
    fn around(&self) -> [DVec3; 2] {
        let across = DVec3::NEG_Z - self.up * DVec3::NEG_Z.dot(self.up);
        let front = across.try_normalize().unwrap_or_else(|| {
            let across = DVec3::Y - self.up * DVec3::Y.dot(self.up);
            across.normalize_or(DVec3::X)
        });
        [front, front.cross(self.up)]
    }

    /// Returns the sky's light from a direction; 0 without a sky.
    pub fn sky_light(&self, direction: DVec3) -> Vec3 {
        let Some(sky) = &self.sky else {
            return Vec3::ZERO;
        };
        let height = direction.dot(self.up).clamp(0.0, 1.0) as f32;
        Vec3::from(sky.horizon).lerp(Vec3::from(sky.colour), height)
    }

    /// Returns the point of the ground that a ray from above meets before the parameter `limit`.
    pub fn ground(&self, origin: DVec3, direction: DVec3, limit: f64) -> Option<GroundPoint> {
        let floor = self.ground?;
        let (height, fall) = (origin.dot(self.up) - floor.height, -direction.dot(self.up));
        let t = height / fall;
        if !(fall > 0.0 && height > 0.0 && t < limit) {
            return None;
        }
        let position = origin + direction * t;
        let away = position - floor.middle;
        let away = (away - self.up * away.dot(self.up)).length() / floor.size;
        let far = ((away - GROUND[0]) / (GROUND[1] - GROUND[0])).clamp(0.0, 1.0);
        let cover = 1.0 - far * far * (3.0 - 2.0 * far);
        (cover > 0.0).then_some(GroundPoint {
            t,
            position,
            normal: self.up,
            colour: floor.colour,
            cover: cover as f32,
        })
    }

    /// Returns the share of the light from the distance `length` that reaches a ray's origin, and
    /// the light that the air adds on the way. Clouds shine through the fog before them.
    pub fn passes(&self, origin: DVec3, direction: DVec3, length: f64) -> (f32, Vec3) {
        let (mut share, mut glow) = (1.0, Vec3::ZERO);
        if let Some(fog) = &self.fog {
            share = self.clear(fog, origin, direction, length);
            glow = Vec3::from(fog.colour) * (1.0 - share);
        }
        for cloud in &self.clouds {
            let depth = through(cloud, origin, direction, length);
            if depth > 0.0 {
                let middle = (cloud.position - origin).dot(direction).clamp(0.0, length);
                let clear = self
                    .fog
                    .map_or(1.0, |fog| self.clear(&fog, origin, direction, middle));
                glow += Vec3::from(cloud.colour) * depth as f32 * clear;
            }
        }
        (share, glow)
    }

    /// Returns the share of light that passes the fog up to the distance `length`.
    fn clear(&self, fog: &Fog, origin: DVec3, direction: DVec3, length: f64) -> f32 {
        let [origin, direction] = [origin, direction].map(|v| DVec3::new(0.0, v.dot(self.up), 0.0));
        let air = texture::fog::Fog {
            distance: fog.distance,
            height: fog.height,
        };
        air.passes(origin, direction, length) as f32
    }
}

/// Integrates a cloud's density along a ray up to a length, in units of the cloud's radius:
/// `∫(c − u²)² du` with c = 1 − b², where b is the ray's distance from the cloud's middle.
fn through(cloud: &Cloud, origin: DVec3, direction: DVec3, length: f64) -> f64 {
    let radius = cloud.radius;
    if !(radius > 0.0 && radius.is_finite() && cloud.density > 0.0) {
        return 0.0;
    }
    let way = (cloud.position - origin) / radius;
    let along = way.dot(direction);
    let c = 1.0 - (way - direction * along).length_squared();
    if c <= 0.0 || c.is_nan() {
        return 0.0;
    }
    let half = c.sqrt();
    let from = (-along).clamp(-half, half);
    let to = (length / radius - along).clamp(-half, half);
    let [before, all] = [from, to].map(|u| u * (c * c + u * u * (u * u / 5.0 - 2.0 * c / 3.0)));
    (cloud.density * (all - before)).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn air(scene: &Scene) -> Air {
        Air::new(scene, -1.0, DVec3::ZERO, 1.0)
    }

    #[test]
    fn a_cloud_is_the_integral_of_its_density() {
        let cloud = Cloud {
            colour: [1.0; 3],
            position: DVec3::new(0.5, 0.2, -0.1),
            radius: 1.5,
            density: 0.7,
        };
        let direction = DVec3::new(0.2, 0.1, -1.0).normalize();
        for (origin, length) in [
            (DVec3::new(0.0, 0.0, 4.0), f64::INFINITY),
            (DVec3::new(0.0, 0.0, 4.0), 4.2),
            (DVec3::new(0.2, 0.0, 0.5), 0.8),
            (DVec3::new(0.0, 3.0, 4.0), 9.0),
        ] {
            const STEPS: u32 = 100_000;
            let step = length.min(20.0) / f64::from(STEPS);
            let mut sum = 0.0;
            for i in 0..STEPS {
                let at = origin + direction * (f64::from(i) + 0.5) * step;
                let r = at.distance(cloud.position) / cloud.radius;
                sum += cloud.density * (1.0 - r * r).max(0.0).powi(2);
            }
            let want = sum * step / cloud.radius;
            let got = through(&cloud, origin, direction, length);
            assert!((got - want).abs() < 1e-6, "{got} {want}");
        }
    }

    #[test]
    fn gradients_and_images_are_around_the_scene() {
        let mut scene = Scene {
            background: Background::Gradient(vec![[1.0, 0.0, 0.0], [0.0; 3], [0.0, 0.0, 1.0]]),
            ..Scene::default()
        };
        for (direction, want) in [
            (DVec3::Y, Vec3::X),
            (DVec3::X, Vec3::ZERO),
            (DVec3::NEG_Y, Vec3::Z),
            (DVec3::new(0.75_f64.sqrt(), 0.25, 0.0), Vec3::X * 0.5),
        ] {
            let got = air(&scene).background(direction);
            assert!(got.distance(want) < 1e-6, "{direction} {got}");
        }
        // Left half red, right half green.
        let bytes = [[255, 0, 0], [255, 0, 0], [0, 255, 0], [0, 255, 0]].concat();
        scene.images.push(Arc::new(Rgb8 {
            size: [4, 1],
            bytes,
        }));
        scene.background = Background::Image(0);
        let seen =
            [-1.0, 1.0].map(|x| air(&scene).background(DVec3::new(x, 0.3, -1.0).normalize()));
        assert_eq!(seen, [Vec3::X, Vec3::Y]);
    }

    #[test]
    fn the_ground_is_met_from_above_only() {
        let scene = Scene {
            ground: Some(Ground {
                colour: [1.0; 3],
                height: None,
            }),
            ..Scene::default()
        };
        let air = air(&scene);
        let down = DVec3::new(0.6, -0.8, 0.0);
        let met = air.ground(DVec3::Y, down, 9.0).expect("below");
        assert!((met.t - 2.5).abs() < 1e-12 && met.cover == 1.0);
        assert!(air.ground(DVec3::Y, down, 2.0).is_none());
        assert!(air.ground(DVec3::Y, -down, 9.0).is_none());
        assert!(air.ground(DVec3::Y * -3.0, -down, 9.0).is_none());
        let far = DVec3::new(100.0, 0.0, 0.0);
        assert!(air.ground(far, DVec3::NEG_Y, 9.0).is_none());
    }
}
