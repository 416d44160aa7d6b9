//! Random rays through random scenes, judged by the reference.

use crate::reference::{Fault, Near, Reference};
use core::fmt::Write;
use field::Kernel;
use field::Skeleton;
use glam::DVec3;
use scene::Scene;
use tracer::{Hit, Picture};
use trials::Random;
use trials::scenes::{Kind, World, scene};

/// Rays of one packet.
const PACKET: usize = 8;

/// Scene with its reference and its rays.
pub struct Trial {
    /// Name of kernel, kind and seed.
    pub name: String,
    /// The scene.
    pub scene: Scene,
    /// Width and height of its picture, pixels.
    pub size: u32,
    /// Rays, by origin and direction.
    pub rays: Vec<(DVec3, DVec3)>,
    /// The surface as the reference knows it.
    pub reference: Reference,
    /// End of rays.
    pub limit: f64,
}

impl Trial {
    /// Returns the trial of a kernel, a kind and a seed.
    pub fn new(kernel: Kernel, kind: Kind, seed: u64, packets: usize) -> Self {
        let random = Random::new(number(kernel, kind, seed));
        Self::of(kernel, kind, seed, packets, random)
    }

    /// Returns a trial as it was when the numbers came from another generator.
    pub fn earlier(kernel: Kernel, kind: Kind, seed: u64, packets: usize) -> Self {
        let random = Random::linear(number(kernel, kind, seed) | 1);
        Self::of(kernel, kind, seed, packets, random)
    }

    /// Makes a trial by numbers of a generator.
    fn of(kernel: Kernel, kind: Kind, seed: u64, packets: usize, mut n: Random) -> Self {
        let (scene, world) = scene(kernel, kind, &mut n);
        let mut reference = Reference::new(scene.soft_surfaces().swap_remove(0).sum.primitives);
        reference.patience = 3000;
        let size = 64 << n.below(7);
        let tolerance = Picture::new(&scene, [size; 2]).tolerance(f64::INFINITY);
        let mut rays = Vec::new();
        // Trials end: a scene may have no point outside the surface.
        for _ in 0..4 * packets {
            if rays.len() >= packets * PACKET {
                break;
            }
            packet(&scene, &mut reference, &mut n, world, tolerance, &mut rays);
        }
        Self {
            name: format!("{} {kind:?} {seed}", kernel.name()),
            scene,
            size,
            rays,
            reference,
            limit: 60.0 * world.scale,
        }
    }
}

/// Returns the generator's seed for a trial.
fn number(kernel: Kernel, kind: Kind, seed: u64) -> u64 {
    (seed * 1009 + kernel as u64 * 31 + kind as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15)
}

/// Adds a packet of rays, of one of the ways in which rays meet a surface.
fn packet(
    scene: &Scene,
    reference: &mut Reference,
    n: &mut Random,
    world: World,
    tolerance: f64,
    rays: &mut Vec<(DVec3, DVec3)>,
) {
    let scale = world.scale;
    let bone = bone_point(scene, n);
    let aim = bone + n.vector(1.0) * (0.3 * scale);
    let eye = world.at(n.vector(1.0).normalize() * n.range(2.0, 6.0));
    let mut made: Vec<(DVec3, DVec3)> = Vec::new();
    // The point where a ray towards the bone meets the surface, and the normal there.
    let foot = |reference: &mut Reference| {
        let direction = (aim - eye).try_normalize()?;
        let first = reference.crossings(eye, direction, 20.0 * scale, tolerance);
        let point = eye + direction * first.roots.first()?.t;
        let (_, gradient) = reference.excess(point);
        Some((point, -gradient.try_normalize()?))
    };
    match n.below(8) {
        // Like neighbouring pixels.
        0 | 1 => {
            let spread = n.power(-3.0, -1.0) * scale;
            for _ in 0..PACKET {
                made.push((eye, aim + n.vector(1.0) * spread - eye));
            }
        }
        // Tangents, a little inside or outside.
        2..=4 => {
            if let Some((point, normal)) = foot(reference) {
                let along = normal.cross(n.vector(1.0)).normalize_or_zero();
                let back = n.range(0.5, 5.0) * scale;
                for i in 0..PACKET {
                    let off = n.power(-8.0, -1.5) * scale;
                    let off = if i % 4 == 3 { off } else { -off };
                    let start = point + normal * off - along * back;
                    made.push((start, along));
                }
            }
        }
        // Rays from inside, in all directions, or from just outside.
        5 => {
            if let Some((point, normal)) = foot(reference) {
                let depth = n.range(-0.1, 0.3) * scale;
                for _ in 0..PACKET {
                    made.push((point - normal * depth, n.vector(1.0)));
                }
            }
        }
        // Rays at the bone itself, its ends, and the edge of the kernel's support.
        6 => {
            for _ in 0..PACKET {
                made.push((eye, bone + n.vector(1.0) * (0.02 * scale) - eye));
            }
        }
        // Rays that have nothing to do with one another.
        _ => {
            for _ in 0..PACKET {
                let from = world.at(n.vector(1.0) * 3.0);
                let to = bone_point(scene, n) + n.vector(1.0) * (0.2 * scale);
                made.push((from, to - from));
            }
        }
    }
    for (origin, direction) in made {
        // The side on which a ray starts must be certain.
        let clear = reference.surface_near(origin, 4.0 * tolerance);
        if let (Some(direction), Near::Beyond) = (direction.try_normalize(), clear) {
            rays.push((origin, direction));
        }
    }
}

/// Returns a point on some bone, often one of its ends.
fn bone_point(scene: &Scene, n: &mut Random) -> DVec3 {
    let count = scene.elements.len();
    let shape = &scene.elements[n.below(count)].shape;
    let share = {
        let shares = [0.0, 1.0, n.unit(), n.unit()];
        n.pick(&shares)
    };
    match shape.skeleton() {
        Some(Skeleton::Triangle { corners }) => {
            corners[0].lerp(corners[1].lerp(corners[2], share), n.unit())
        }
        Some(Skeleton::Polygon { rings }) => rings[0][0].lerp(rings[0][1], share),
        Some(Skeleton::Curve { control }) => control[0].lerp(control[3], share),
        Some(other) => other.at(share),
        None => DVec3::ZERO,
    }
}

/// Counts of rays and verdicts.
#[derive(Clone, Copy, Debug, Default)]
pub struct Row {
    /// Rays judged.
    pub rays: u64,
    /// Rays with a hit.
    pub hits: u64,
    /// Missed crossings of rays that go deeper than the tolerance.
    pub missed: u64,
    /// Missed crossings of rays that graze.
    pub grazed: u64,
    /// Hits away from any surface.
    pub invented: u64,
    /// Largest distance of hits, in tolerances.
    pub worst: f64,
    /// Undecided rays.
    pub uncertain: u64,
}

impl Row {
    /// Returns the number of faults.
    pub fn faults(&self) -> u64 {
        self.missed + self.grazed + self.invented
    }

    /// Adds the counts of others.
    pub fn add(&mut self, other: &Self) {
        self.rays += other.rays;
        self.hits += other.hits;
        self.missed += other.missed;
        self.grazed += other.grazed;
        self.invented += other.invented;
        self.worst = self.worst.max(other.worst);
        self.uncertain += other.uncertain;
    }

    /// Judges the first hits that were found for rays up to a limit. Returns a line for each fault
    /// and each ray that stays undecided.
    pub fn judge(
        &mut self,
        (picture, reference): (&Picture, &mut Reference),
        rays: &[(DVec3, DVec3)],
        found: &[Option<f64>],
        limit: f64,
    ) -> String {
        assert_eq!(found.len(), rays.len());
        let mut lines = String::new();
        for (number, (&(origin, direction), t)) in rays.iter().zip(found).enumerate() {
            // Hits beyond the search's end are not judged.
            let t = t.filter(|t| *t < limit);
            self.rays += 1;
            self.hits += u64::from(t.is_some());
            let verdict = reference.judge(origin, direction, t, limit, |t| picture.tolerance(t));
            let at = picture.tolerance(t.unwrap_or(limit));
            if t.is_some() {
                self.worst = self.worst.max(verdict.distance / at);
            }
            self.uncertain += u64::from(!verdict.certain);
            match verdict.fault {
                None if verdict.certain => continue,
                None => {}
                Some(Fault::Missed { grazing: true, .. }) => self.grazed += 1,
                Some(Fault::Missed { .. }) => self.missed += 1,
                Some(Fault::Invented(_)) => self.invented += 1,
            }
            let (fault, ray) = (verdict.fault, (origin, direction));
            let _ = writeln!(
                lines,
                "  ray {number} {ray:?}: hit {t:?}, {fault:?}, tolerance {at:e}"
            );
        }
        lines
    }
}

/// Way of finding the first crossings of a trial's rays with its surface: returns their parameters.
/// The picture is that of the trial's scene.
pub type Method<'m> = &'m dyn Fn(&Trial, &Picture) -> Vec<Option<f64>>;

/// Returns the parameters of hits.
pub fn parameters(hits: &[Option<Hit>]) -> Vec<Option<f64>> {
    hits.iter().map(|hit| hit.map(|hit| hit.t)).collect()
}

/// Judges the crossings that a method finds for a trial's rays; appends a line for each fault to
/// `faults`.
pub fn check(mut trial: Trial, method: Method<'_>, faults: &mut String) -> Row {
    let picture = Picture::new(&trial.scene, [trial.size; 2]);
    let found = method(&trial, &picture);
    let mut row = Row::default();
    let judges = (&picture, &mut trial.reference);
    let lines = row.judge(judges, &trial.rays, &found, trial.limit);
    if !lines.is_empty() {
        let _ = write!(faults, "{}:\n{lines}", trial.name);
    }
    row
}
