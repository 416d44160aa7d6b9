//! Shading by waves of paths, for scenes with reflection, refraction, textures or fog.
//!
//! A path is a ray with the share of its light that reaches the eye. [`World::illuminate`] follows
//! the paths of some packets in waves: each surface point adds its own light to its sample, and
//! asks for further rays, which make the next wave. The light that a point adds depends on nothing
//! but the path and the point.
use crate::air::GroundPoint;
use crate::free::FreeRay;
use crate::lamps::{Draw, Receiver};
use crate::layout::PACKET;
use crate::material::Look;
use crate::media::Media;
use crate::meet::Seen;
use crate::ray::Ray;
use crate::rich::Rich;
use crate::sample::Sample;
use crate::shade::{Finish, clamp};
use crate::stats::Stats;
use crate::workspace::Workspace;
use crate::world::{SurfacePoint, World};
use glam::Vec3;
use scene::Skip;
use texture::refraction::{reflect, refract};

/// Most surfaces that a ray passes as if they were not there.
const MOST_SKIPPED: u32 = 64;
/// Most rays of a wave for each ray from the eye; further ones are not sent.
const MOST_RAYS: usize = 512;
/// Most rays of all waves together for each ray from the eye: glass inside glass may ask for 2ⁿ
/// rays at depth n.
const MOST_RAYS_IN_ALL: usize = 2048;

/// Key of samples that see the ground.
pub(crate) const GROUND: u32 = 1 << 31;

/// Kind of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Pixel,
    Reflected,
    Transmitted,
}

impl Kind {
    /// Whether a ray of this kind passes surfaces that rays skip so.
    fn passes(self, skip: Skip) -> bool {
        match self {
            Self::Pixel => skip.pixel,
            Self::Reflected => skip.reflected,
            Self::Transmitted => skip.transmitted,
        }
    }
}

/// A ray whose light is wanted.
#[derive(Clone, Copy, Debug)]
struct Path {
    ray: Ray,
    /// Share of its light that reaches the eye.
    weight: Vec3,
    /// The sample it is for: packet and lane.
    owner: (usize, usize),
    draw: Draw,
    kind: Kind,
    /// Surfaces that have reflected or refracted it.
    depth: u32,
    /// Surfaces passed since.
    skipped: u32,
    /// Number that tells the paths of a sample apart.
    branch: u32,
    media: Media,
}

/// A receiver with the path that has come to it.
struct Stop {
    path: Path,
    /// The ground's colour times the share of the path's light.
    ground: Option<Vec3>,
}

impl World {
    /// Takes samples with the rays of some packets in a rich scene, and leaves them in the working
    /// space. `draw` returns the sample of a pixel that a ray, given by packet and lane, belongs
    /// to.
    pub fn illuminate(
        &self,
        rich: &Rich,
        seen: &[Seen],
        draw: &dyn Fn(usize, usize) -> Draw,
        work: &mut Workspace,
        stats: &mut Stats,
    ) {
        let mut samples = core::mem::take(&mut work.samples);
        samples.clear();
        let mut wave = Vec::new();
        for (k, seen) in seen.iter().enumerate() {
            samples.push(core::array::from_fn(|i| Sample {
                cost: seen.costs[i],
                ..Sample::BLANK
            }));
            let rays = seen.rays.iter().zip(&seen.hits).take(seen.used);
            for (i, (ray, hit)) in rays.enumerate() {
                let path = Path {
                    ray: *ray,
                    weight: Vec3::ONE,
                    owner: (k, i),
                    draw: draw(k, i),
                    kind: Kind::Pixel,
                    depth: 0,
                    skipped: 0,
                    branch: 1,
                    media: Media::default(),
                };
                wave.push((path, *hit));
            }
        }
        let most = MOST_RAYS * PACKET * seen.len();
        let mut left = MOST_RAYS_IN_ALL * PACKET * seen.len();
        while !wave.is_empty() {
            let [mirrored, passed] = self.shade(rich, &wave, &mut samples, work, stats);
            wave.clear();
            // Neighbours that are mirrored run together, and so do those that pass.
            for mut paths in [mirrored, passed] {
                paths.truncate(most.min(left));
                left -= paths.len();
                stats.secondary_rays += paths.len() as u64;
                let rays: Vec<FreeRay> = paths
                    .iter()
                    .map(|path| FreeRay {
                        ray: path.ray,
                        front_only: self.one_sided && path.media.is_air(),
                    })
                    .collect();
                let hits = self.meet_free(&rays, work, stats);
                wave.extend(paths.into_iter().zip(hits));
            }
        }
        for sample in samples.iter_mut().flatten() {
            sample.colour = clamp(rich.tone(sample.colour));
        }
        work.samples = samples;
    }

    /// Adds to the samples the light that the paths of a wave bring from where they end. Returns
    /// the reflected paths and those that go on.
    fn shade(
        &self,
        rich: &Rich,
        wave: &[(Path, Option<SurfacePoint>)],
        samples: &mut [[Sample; PACKET]],
        work: &mut Workspace,
        stats: &mut Stats,
    ) -> [Vec<Path>; 2] {
        let [mut mirrored, mut passed] = [Vec::new(), Vec::new()];
        let (mut stops, mut receivers) = (Vec::new(), Vec::new());
        for (path, hit) in wave {
            let mut path = *path;
            let (k, i) = path.owner;
            let sample = &mut samples[k][i];
            let is_in_air = path.media.is_air();
            let ray = path.ray;
            let (ground, clear) = self.through_air(
                rich,
                &ray,
                is_in_air,
                hit.as_ref(),
                &mut path.weight,
                sample,
            );
            if let Some(ground) = ground {
                receivers.push(self.on_ground(&path, &ground));
                stops.push(Stop {
                    ground: Some(path.weight * ground.cover * ground.colour),
                    path,
                });
                if path.kind == Kind::Pixel {
                    (sample.key, sample.depth) =
                        (GROUND, (ground.t / self.unit.length(1.0)) as f32);
                }
            } else if let Some(hit) = hit {
                let look = self.look(rich, hit);
                if path.kind.passes(look.skip) {
                    if path.skipped < MOST_SKIPPED {
                        passed.push(self.beyond(&path, hit));
                    }
                    continue;
                }
                if path.kind == Kind::Pixel {
                    (sample.key, sample.depth) = (hit.surface << 8, hit.t as f32);
                }
                path.weight *= clear;
                sample.colour += path.weight * look.surface.ambient;
                let receiver = self.on_surface(&path, hit, &look);
                self.scatter(
                    rich,
                    &path,
                    hit,
                    (&look, &receiver),
                    &mut mirrored,
                    &mut passed,
                );
                receivers.push(receiver);
                stops.push(Stop { path, ground: None });
            }
        }
        let received = self.receive(rich, &receivers, work, stats);
        for (stop, received) in stops.iter().zip(&received) {
            let (k, i) = stop.path.owner;
            let sample = &mut samples[k][i];
            sample.colour += match stop.ground {
                None => stop.path.weight * received.light,
                Some(colour) => colour * received.of_ground(),
            };
            if stop.path.kind == Kind::Pixel {
                sample.key ^= received.lit;
            }
        }
        [mirrored, passed]
    }

    /// Adds the light of the air on a ray's way, and of the background if it meets nothing, times
    /// `weight`; up to the ground, the air takes its part of `weight`. Returns the point of the
    /// ground if that is nearer than the ray's hit, and the share of light that the air lets pass.
    pub fn through_air(
        &self,
        rich: &Rich,
        ray: &Ray,
        is_in_air: bool,
        hit: Option<&SurfacePoint>,
        weight: &mut Vec3,
        sample: &mut Sample,
    ) -> (Option<GroundPoint>, f32) {
        let air = &rich.air;
        let (origin, direction) = (self.unit.world(ray.origin), ray.direction);
        let limit = hit.map_or(f64::INFINITY, |hit| self.unit.length(hit.t));
        let ground = if is_in_air {
            air.ground(origin, direction, limit)
        } else {
            None
        };
        let length = ground.map_or(limit, |ground| ground.t);
        // There is no fog inside of bodies.
        let (clear, glow) = if is_in_air {
            air.passes(origin, direction, length)
        } else {
            (1.0, Vec3::ZERO)
        };
        sample.colour += *weight * glow;
        if let Some(ground) = &ground {
            *weight *= clear;
            sample.colour += *weight * (1.0 - ground.cover) * air.background(direction);
        } else if hit.is_none() {
            sample.colour += *weight * clear * air.background(direction);
        }
        (ground, clear)
    }

    /// Returns the path beyond a surface that it passes as if it were not there.
    fn beyond(&self, path: &Path, hit: &SurfacePoint) -> Path {
        Path {
            ray: Ray {
                origin: hit.position - hit.facing(path.ray.direction) * hit.lift,
                direction: path.ray.direction,
            },
            skipped: path.skipped + 1,
            ..*path
        }
    }

    /// Returns the receiver at a point of the ground.
    fn on_ground(&self, path: &Path, ground: &GroundPoint) -> Receiver {
        let position = self.unit.map(ground.position);
        Receiver {
            position,
            flat: ground.normal,
            normal: ground.normal,
            lift: self.hard_lift * (1.0 + position.length()),
            view: path.ray.direction,
            draw: path.draw,
            branch: path.branch,
            inside: false,
            finish: Finish::dull(Vec3::ONE),
        }
    }

    /// Returns the receiver at a surface point.
    fn on_surface(&self, path: &Path, hit: &SurfacePoint, look: &Look) -> Receiver {
        let direction = path.ray.direction;
        let flat = hit.facing(direction);
        let bumped = if flat == hit.normal {
            look.surface.normal
        } else {
            -look.surface.normal
        };
        Receiver {
            position: hit.position,
            flat,
            // A bump that is turned away from the eye would be lit from behind.
            normal: if bumped.dot(direction) < 0.0 {
                bumped
            } else {
                flat
            },
            lift: hit.lift,
            view: direction,
            draw: path.draw,
            branch: path.branch,
            inside: flat != hit.normal,
            finish: Finish::of_surface(&look.surface),
        }
    }

    /// Adds the paths that a surface reflects and those that it lets pass.
    fn scatter(
        &self,
        rich: &Rich,
        path: &Path,
        hit: &SurfacePoint,
        (look, receiver): (&Look, &Receiver),
        mirrored: &mut Vec<Path>,
        passed: &mut Vec<Path>,
    ) {
        let (surface, direction) = (&look.surface, path.ray.direction);
        let mut mirror = path.weight * surface.reflective;
        let pass = path.weight * surface.transparent;
        if path.depth >= rich.max_depth || mirror == Vec3::ZERO && pass == Vec3::ZERO {
            return;
        }
        let further = |kind, weight, direction, above: f64, branch, media| Path {
            ray: Ray {
                origin: hit.position + receiver.flat * (above * hit.lift),
                direction,
            },
            weight,
            kind,
            depth: path.depth + 1,
            skipped: 0,
            branch: path.branch.wrapping_mul(5).wrapping_add(branch),
            media,
            ..*path
        };
        if rich.shows(pass) {
            let (key, way) = self.medium(rich, hit, direction);
            let sides = path.media.cross(key, way, surface.index, look.dispersion);
            // Colours that are bent alike go together.
            for first in 0..3 {
                let ratio = sides.ratio[first];
                if sides.ratio[..first].contains(&ratio) {
                    continue;
                }
                let own = [0, 1, 2].map(|i| {
                    if sides.ratio[i] == ratio {
                        pass[i]
                    } else {
                        0.0
                    }
                });
                let own = Vec3::from_array(own);
                if !rich.shows(own) {
                    continue;
                }
                let bent = match refract(direction, receiver.normal, ratio) {
                    _ if ratio == 1.0 => Some(direction),
                    // A bump must not send a ray back to where it came from.
                    Some(bent) if bent.dot(receiver.flat) >= 0.0 => {
                        refract(direction, receiver.flat, ratio)
                    }
                    bent => bent,
                };
                match bent {
                    Some(bent) => passed.push(further(
                        Kind::Transmitted,
                        own,
                        bent,
                        -1.0,
                        first as u32 + 1,
                        sides.beyond,
                    )),
                    None => mirror += own,
                }
            }
        }
        if rich.shows(mirror) {
            let mut bent = reflect(direction, receiver.normal);
            if bent.dot(receiver.flat) <= 0.0 {
                bent = reflect(direction, receiver.flat);
            }
            mirrored.push(further(Kind::Reflected, mirror, bent, 1.0, 0, path.media));
        }
    }
}
