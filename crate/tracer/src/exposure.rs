//! Pixels behind a lens and an open shutter: rays that differ in more than their place in the
//! pixel.
//!
//! Each of a pixel's n×n rays has its own cell of the pixel, point of the lens and moment. The
//! points are well spread ([`texture::sequence`]), and each moment gets as many of the rays as any
//! other, or one more.
use crate::area::Area;
use crate::free::FreeRay;
use crate::lamps::Draw;
use crate::layout::PACKET;
use crate::meet::Seen;
use crate::ray::Ray;
use crate::stats::Stats;
use crate::view::View;
use crate::workspace::Workspace;
use crate::world::World;
use glam::Vec3;
use scene::{Scene, Unit};
use texture::disc;
use texture::sequence::{Purpose, sample};

/// The sum of a pixel's samples: the pixel's column and row, the colour and the cost.
pub(crate) type Sum = (u32, u32, Vec3, f32);

/// Lens and shutter of a scene's camera.
pub(crate) struct Exposure {
    lens: ThinLens,
    /// The scene at the moments of the shutter; none if nothing moves.
    moments: Vec<Moment>,
}

/// A scene at a moment.
struct Moment {
    view: View,
    lens: ThinLens,
    world: World,
}

/// A lens that is a disc around the eye, in units of the scene's size.
#[derive(Clone, Copy)]
struct ThinLens {
    /// The disc's radius; 0 is a pinhole.
    aperture: f64,
    /// Distance at which things are sharp.
    focus: f64,
}

/// A ray of a pixel.
struct Shot {
    ray: Ray,
    /// Number of the pixel in the packet.
    owner: usize,
    draw: Draw,
}

impl Exposure {
    /// Prepares a scene's lens and shutter; `None` if it has a pinhole and nothing moves. `unit`
    /// converts the scene to units of its size.
    pub fn of(scene: &Scene, unit: &Unit, size: [u32; 2]) -> Option<Self> {
        let lens = ThinLens::of(scene, unit);
        if lens.aperture == 0.0 && scene.moments.is_empty() {
            return None;
        }
        let mut moments = Vec::new();
        for scene in scene.moments.iter().take(Scene::MAX_MOMENTS) {
            let mut world = World::prepare(scene, true);
            let view = View::of(scene, &world.unit, size);
            world.soft.pixel = view.pixel();
            let lens = ThinLens::of(scene, &world.unit);
            moments.push(Moment { view, lens, world });
        }
        Some(Self { lens, moments })
    }
}

impl ThinLens {
    fn of(scene: &Scene, unit: &Unit) -> Self {
        let camera = &scene.camera;
        let focus = scene.lens.focus;
        let focus = focus.unwrap_or_else(|| camera.eye.distance(camera.target));
        let scale = 1.0 / unit.length(1.0);
        let aperture = scene.lens.aperture * scale;
        Self {
            aperture: if aperture.is_finite() {
                aperture.max(0.0)
            } else {
                0.0
            },
            focus: focus * scale,
        }
    }

    /// Returns the ray of a view through a place in pixels and a point of the lens.
    fn ray(&self, view: &View, [x, y]: [f64; 2], point: [f64; 2]) -> Ray {
        let through = view.ray(x, y);
        let axes = view.projection.world_from_view;
        let axes = [axes.x_axis, axes.y_axis, -axes.z_axis];
        let (eye, direction) = (through.origin, through.direction);
        let (origin, direction) =
            disc::lens(eye, direction, axes, self.aperture, self.focus, point);
        Ray { origin, direction }
    }
}

impl Exposure {
    /// Traces all rays of those pixels of a packet that lie in the picture, `samples` across and
    /// down a pixel, and adds them up. `still` is the scene if nothing moves.
    pub fn trace(
        &self,
        still: (&View, &World),
        packet: Area,
        samples: u32,
        work: &mut Workspace,
        stats: &mut Stats,
    ) -> Vec<Sum> {
        let [width, height] = still.0.size;
        let pixels = packet.pixels().filter(|&(x, y)| x < width && y < height);
        let mut sums: Vec<Sum> = pixels.map(|(x, y)| (x, y, Vec3::ZERO, 0.0)).collect();
        let count = self.moments.len().max(1);
        let turns: Vec<Vec<usize>> = sums
            .iter()
            .map(|&(x, y, ..)| turns([x, y], samples * samples, count))
            .collect();
        for turn in 0..count {
            let (view, lens, world) = match self.moments.get(turn) {
                Some(moment) => (&moment.view, &moment.lens, &moment.world),
                None => (still.0, &self.lens, still.1),
            };
            let mut shots = Vec::new();
            for (owner, (&(x, y, ..), turns)) in sums.iter().zip(&turns).enumerate() {
                for number in (0..turns.len()).filter(|&i| turns[i] == turn) {
                    let (pixel, number) = ([x, y], number as u32);
                    let cell = [number % samples, number / samples];
                    let [across, down] = cell.map(|k| (f64::from(k) + 0.5) / f64::from(samples));
                    let place = [f64::from(x) + across, f64::from(y) + down];
                    shots.push(Shot {
                        ray: lens.ray(view, place, sample(pixel, number, Purpose::Lens)),
                        owner,
                        draw: Draw::Sample { pixel, number },
                    });
                }
            }
            follow(world, &shots, &mut sums, work, stats);
        }
        sums
    }
}

/// Deals moments out to all rays of a pixel: returns the moment, below `count`, of each. Moments
/// occur equally often, give or take one, in an order of the pixel's own.
fn turns(pixel: [u32; 2], all: u32, count: usize) -> Vec<usize> {
    let times: Vec<f64> = (0..all)
        .map(|i| sample(pixel, i, Purpose::Time)[0])
        .collect();
    let all = all as usize;
    let mut order: Vec<usize> = (0..all).collect();
    field::heap_sort(&mut order, |&a, &b| {
        times[a].total_cmp(&times[b]).then(a.cmp(&b)).is_lt()
    });
    let mut turns = vec![0; all];
    for (rank, number) in order.into_iter().enumerate() {
        turns[number] = (2 * rank + 1) * count / (2 * all);
    }
    turns
}

/// Adds the light that some rays see at a moment to their pixels' sums.
fn follow(
    world: &World,
    shots: &[Shot],
    sums: &mut [Sum],
    work: &mut Workspace,
    stats: &mut Stats,
) {
    let Some(rich) = &world.rich else { return };
    let rays: Vec<FreeRay> = shots
        .iter()
        .map(|shot| FreeRay {
            ray: shot.ray,
            front_only: world.one_sided,
        })
        .collect();
    stats.primary_rays += rays.len() as u64;
    let hits = world.meet_free(&rays, work, stats);
    let mut seen = Vec::new();
    for (shots, hits) in shots.chunks(PACKET).zip(hits.chunks(PACKET)) {
        // Lanes not in use repeat the last ray, and meet nothing.
        let mut packet = Seen {
            rays: core::array::from_fn(|i| shots[i.min(shots.len() - 1)].ray),
            costs: [1.0; PACKET],
            used: shots.len(),
            ..Seen::default()
        };
        packet.hits[..hits.len()].copy_from_slice(hits);
        seen.push(packet);
    }
    world.illuminate(
        rich,
        &seen,
        &|packet, lane| shots[(packet * PACKET + lane).min(shots.len() - 1)].draw,
        work,
        stats,
    );
    for (shot, sample) in shots.iter().zip(work.samples.iter().flatten()) {
        let (_, _, colour, cost) = &mut sums[shot.owner];
        *colour += sample.colour;
        *cost += sample.cost;
    }
}
