//! Light that surface points get: from sources, which may have a size, and from the sky.
use crate::layout::PACKET;
use crate::ray::Ray;
use crate::rich::Rich;
use crate::shade::{Finish, towards};
use crate::stats::Stats;
use crate::workspace::{Shadow, State, Workspace};
use crate::world::World;
use glam::{DVec3, Vec3};
use scene::{Light, LightKind, Sky};
use texture::disc;
use texture::sequence::{Purpose, sample};

/// Fewest directions of the sky for samples that all have the same ones.
const FEWEST_DIRECTIONS: u32 = 4;

/// The sample of a pixel that a path belongs to, on which it depends where on lights its rays end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Draw {
    /// The middles of all lights, and the same directions of the sky for all pixels.
    Middle,
    /// The sample of this number of a pixel.
    Sample { pixel: [u32; 2], number: u32 },
}

/// A point from where rays to the lights start.
pub(crate) struct Receiver {
    pub position: DVec3,
    /// The surface's own unit normal on the side that is seen.
    pub flat: DVec3,
    /// The unit normal with bumps, on that side.
    pub normal: DVec3,
    /// Distance along `flat` at which the rays start.
    pub lift: f64,
    /// Direction of the ray that sees it.
    pub view: DVec3,
    pub draw: Draw,
    pub branch: u32,
    /// Whether it is seen from inside a body.
    pub inside: bool,
    /// Colours of the surface; white for the ground.
    pub finish: Finish,
}

/// The light of a receiver.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Received {
    /// Light that it sends to the eye.
    pub light: Vec3,
    /// Light that it would send to the eye if nothing were in the way of the lights.
    pub free: Vec3,
    /// Lights that reach it, a bit each.
    pub lit: u32,
}

impl Received {
    /// Returns the share of its colour that the ground shows: the part of its light that nothing
    /// shadows; 1 where no light shines on it at all.
    pub fn of_ground(&self) -> Vec3 {
        let share = self.light / self.free.max(Vec3::splat(1e-6));
        Vec3::select(self.free.cmpgt(Vec3::ZERO), share, Vec3::ONE)
    }
}

impl Draw {
    /// Returns two numbers in [0, 1) for a purpose; `None` for the middle.
    fn numbers(self, branch: u32, purpose: Purpose) -> Option<[f64; 2]> {
        match self {
            Self::Middle => None,
            Self::Sample {
                pixel: [x, y],
                number,
            } => {
                // Paths of one sample that have parted are as far apart as distant pixels.
                let pixel = [x ^ (branch - 1).wrapping_mul(0x9e37_79b9), y];
                Some(sample(pixel, number, purpose))
            }
        }
    }
}

impl World {
    /// Returns the light that each of some points gets and sends on to the eye.
    pub fn receive(
        &self,
        rich: &Rich,
        receivers: &[Receiver],
        work: &mut Workspace,
        stats: &mut Stats,
    ) -> Vec<Received> {
        let mut received = vec![Received::default(); receivers.len()];
        for (which, light) in self.lights.iter().enumerate() {
            self.receive_from(rich, (which, light), receivers, &mut received, work, stats);
        }
        if let Some(sky) = &rich.air.sky {
            for turn in 0..directions(sky, receivers) {
                self.receive_sky(rich, turn, receivers, &mut received, work, stats);
            }
        }
        received
    }

    /// Adds the light of a source.
    fn receive_from(
        &self,
        rich: &Rich,
        (which, light): (usize, &Light),
        receivers: &[Receiver],
        received: &mut [Received],
        work: &mut Workspace,
        stats: &mut Stats,
    ) {
        let mut rays = core::mem::take(&mut work.shadows);
        rays.clear();
        for (number, receiver) in receivers.iter().enumerate() {
            let purpose = Purpose::Light(which as u16);
            let spread = if rich.penumbra && light.size > 0.0 {
                receiver.draw.numbers(receiver.branch, purpose)
            } else {
                None
            };
            let (direction, limit) = lamp(light, receiver.position, spread);
            let mut normals = [receiver.normal, receiver.flat].into_iter();
            if normals.all(|normal| normal.dot(direction) > 0.0)
                && light.share(receiver.position) > 0.0
            {
                rays.push(receiver.ray(number, direction, limit));
            }
        }
        let passing = if light.shadow {
            self.passing(rich, &mut rays, receivers, work, stats)
        } else {
            vec![Vec3::ONE; rays.len()]
        };
        for (ray, passing) in rays.iter().zip(passing) {
            let number = ray.hit.0;
            let receiver = &receivers[number];
            let colour = Vec3::from(light.colour) * light.share(receiver.position) as f32;
            let free = receiver.finish.shade(
                colour,
                receiver.normal.as_vec3(),
                ray.ray.direction.as_vec3(),
                receiver.view.as_vec3(),
            );
            let sum = &mut received[number];
            sum.free += free;
            sum.light += free * passing;
            if passing.max_element() > 0.5 {
                sum.lit ^= 1 << (which % 8);
            }
        }
        work.shadows = rays;
    }

    /// Adds the light of one direction of the sky.
    fn receive_sky(
        &self,
        rich: &Rich,
        turn: u32,
        receivers: &[Receiver],
        received: &mut [Received],
        work: &mut Workspace,
        stats: &mut Stats,
    ) {
        let Some(sky) = &rich.air.sky else { return };
        let all = directions(sky, receivers);
        let mut rays = core::mem::take(&mut work.shadows);
        rays.clear();
        for (number, receiver) in receivers.iter().enumerate() {
            let draw = match receiver.draw {
                Draw::Middle => Draw::Sample {
                    pixel: [0; 2],
                    number: turn,
                },
                Draw::Sample { pixel, number } => Draw::Sample {
                    pixel,
                    number: number.wrapping_mul(all).wrapping_add(turn),
                },
            };
            let numbers = draw.numbers(receiver.branch, Purpose::Sky);
            let direction = disc::cosine(receiver.normal, numbers.unwrap_or([0.5; 2]));
            if direction.dot(receiver.flat) > 0.0 {
                rays.push(receiver.ray(number, direction, f64::INFINITY));
            }
        }
        let passing = self.passing(rich, &mut rays, receivers, work, stats);
        for (ray, passing) in rays.iter().zip(passing) {
            let light = rich.air.sky_light(ray.ray.direction) / all as f32;
            let free = receivers[ray.hit.0].finish.diffuse() * light;
            let sum = &mut received[ray.hit.0];
            sum.free += free;
            sum.light += free * passing;
        }
        work.shadows = rays;
    }

    /// Returns the share of light that passes along each of some rays to lights.
    fn passing(
        &self,
        rich: &Rich,
        rays: &mut [Shadow],
        receivers: &[Receiver],
        work: &mut Workspace,
        stats: &mut Stats,
    ) -> Vec<Vec3> {
        stats.shadow_rays += rays.len() as u64;
        self.look_for_shadows_apart(rays, work, stats);
        let mut passing: Vec<Vec3> = rays
            .iter()
            .map(|ray| match ray.state {
                State::Dark => Vec3::ZERO,
                _ => Vec3::ONE,
            })
            .collect();
        if rich.see_through {
            // Rays from inside a body leave it: that is not looked for.
            let doubtful: Vec<usize> = (0..rays.len())
                .filter(|&i| rays[i].state == State::Dark || receivers[rays[i].hit.0].inside)
                .collect();
            for some in doubtful.chunks(PACKET * PACKET) {
                let ends: Vec<(Ray, f64)> =
                    some.iter().map(|&i| (rays[i].ray, rays[i].limit)).collect();
                let light = self.transmission(rich, &ends, work, stats);
                for (&i, light) in some.iter().zip(light) {
                    passing[i] = light;
                }
            }
        }
        passing
    }
}

impl Receiver {
    /// Returns the ray from the receiver of a number in a direction, up to a limit.
    fn ray(&self, number: usize, direction: DVec3, limit: f64) -> Shadow {
        Shadow {
            hit: (number, 0),
            ray: Ray {
                origin: self.position + self.flat * self.lift,
                direction,
            },
            limit,
            depth: 0.0,
            state: State::Unknown,
            cost: 0.0,
        }
    }
}

/// Returns the number of directions of the sky from which points get light.
fn directions(sky: &Sky, receivers: &[Receiver]) -> u32 {
    let count = sky.samples.clamp(1, Sky::MAX_SAMPLES);
    match receivers.first() {
        Some(Receiver {
            draw: Draw::Middle, ..
        }) => count.max(FEWEST_DIRECTIONS),
        _ => count,
    }
}

/// Returns the direction and distance from a point to a light, or to the place on it that is given
/// by two numbers in [0, 1).
fn lamp(light: &Light, point: DVec3, numbers: Option<[f64; 2]>) -> (DVec3, f64) {
    let Some(numbers) = numbers else {
        return towards(light, point);
    };
    match light.kind {
        LightKind::Distant { .. } => {
            let (middle, limit) = towards(light, point);
            let [first, second] = disc::frame(middle);
            let at = disc::disc(numbers) * light.size;
            let direction = middle + at.x * first + at.y * second;
            (direction.normalize_or(middle), limit)
        }
        LightKind::Point { position } | LightKind::Spot { position, .. } => {
            let way = disc::light(position, light.size, point, numbers) - point;
            (way.try_normalize().unwrap_or(DVec3::Z), way.length())
        }
    }
}
