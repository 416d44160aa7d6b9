//! Certified marching among very many points of kernels that never end.
//!
//! Such a field is small nowhere, so no ball bounds what a ray meets. A [`FarField`] divides space
//! into cells, each with a polynomial of what is far and a list of what is near. A packet visits
//! the cells along its beam, front to back: those in which the field is below T are left at once,
//! in the others
//!
//! - the far field is the cell's polynomial along each ray,
//! - near points whose cubic Hermite span over the cell has a small enough error are added to it by
//!   that,
//! - the rest are blobs, and [`march_before`](crate::blob_march::march_before) follows the rays
//!   among them.
//!
//! A packet that is too wide for small cells where many points are near is divided, down to single
//! rays.
//!
//! So the surface found is that of a field that differs from the true one by a stated bound, which
//! counts like rounding: what it may hide is searched again among all points in double precision.
//!
//! `body.rs` prepares a body, `piece.rs` is a packet's way through a cell, `points.rs` prepares the
//! points near it, `hits.rs` follows the rays and samples the surface where they meet it.
mod body;
mod hits;
mod piece;
mod points;
mod query;

use crate::beam::Beam;
use crate::layout::{PACKET, lanes_in};
use crate::ray::Ray;
use crate::walk::Quest;
use body::ROOM;
use field::far_field::{Cell, FEW_NEAR, LOOSE, SMALLEST};
use field::{Cut, THRESHOLD};
use glam::DVec3;
use hits::Start;
use piece::{Piece, leaves};
use query::ROUNDING;
use std::sync::Arc;
use wide::f32x8;

pub(crate) use body::FarBody;
pub use query::{FarQuery, FarWork};

/// Largest error of a cell's polynomial; beyond it rounding is too large for this way.
const MOST_OF_CELLS: f64 = 2e-4 * THRESHOLD;
/// Near points of a cell beyond which a packet that is too wide for the cell's parts is divided.
const MANY: usize = 128;
/// Most cells that a packet visits.
const MOST_CELLS: u32 = 4096;

impl FarBody {
    /// Finds the first crossings of rays with the surface; for [`Quest::Entry`] only whether there
    /// is one from outside. Returns the rays that cross, a bit each, with the surface there in
    /// `work.samples`. `None` if this way does not serve these rays; the caller then takes the
    /// general one.
    pub fn first(&self, query: &FarQuery<'_>, work: &mut FarWork) -> Option<u32> {
        if query.quest != Quest::Entry {
            work.samples.weights.clear();
            let zero = f32x8::splat(0.0);
            let weights = self.finishes.iter().map(|(finish, _)| (*finish, zero));
            work.samples.weights.extend(weights);
        }
        self.first_of(query, query.alive, 0.0, work)
    }

    /// Follows some of the rays from a parameter on.
    fn first_of(
        &self,
        query: &FarQuery<'_>,
        mut alive: u32,
        from: f64,
        work: &mut FarWork,
    ) -> Option<u32> {
        let primitives = self.primitives(query);
        let lanes = lanes_in(alive);
        let followed: Vec<Ray> = lanes.clone().map(|i| query.rays[i]).collect();
        let beam = Beam::around(&followed)?;
        let [first, last] = self.range(&beam)?;
        let furthest = lanes.fold(0.0, |most, i| query.limits[i].at_least(most));
        let to = last.at_most(furthest);
        let mut t = first.at_least(from);
        let root = self.field.root(primitives);
        let mut met = 0;
        // The present cell and those that contain it, the largest first.
        let mut path = vec![root];
        let mut cells = 0;
        while t < to {
            for (lane, limit) in query.limits.iter().enumerate() {
                alive &= !(u32::from(*limit <= t) << lane);
            }
            if alive == 0 {
                break;
            }
            cells += 1;
            if cells > MOST_CELLS {
                return None;
            }
            let place = beam.axis.at(t + 1e-9 * root.half);
            let room = (LOOSE - 1.0) * (1.0 - 1e-6);
            // The beam where it leaves a cell is compared with the cell's size.
            if beam.extent(t + 4.0 * root.half) > room * root.half {
                return None;
            }
            // Back to the smallest cell that still holds the beam.
            while let [_, .., cell] = &path[..]
                && (!cell.holds(place) || beam.extent(t + 4.0 * cell.half) > room * cell.half)
            {
                path.pop();
            }
            let mut cell: &Arc<Cell> = path[path.len() - 1];
            let mut is_wide = false;
            let empty = loop {
                if cell.most < THRESHOLD - ROUNDING {
                    break true;
                }
                let half = 0.5 * cell.half;
                if cell.near.len() <= FEW_NEAR || half < SMALLEST * root.half {
                    break false;
                }
                is_wide = beam.extent(t + 4.0 * half) > room * half;
                if is_wide {
                    break false;
                }
                cell = self.field.part(primitives, cell, cell.part_of(place));
                path.push(cell);
            };
            let end = leaves(&beam.axis, t, cell).at_most(to);
            let is_one = alive & (alive - 1) == 0;
            if !empty {
                let mut found = None;
                if is_one || !is_wide || cell.near.len() <= MANY {
                    if cell.error > MOST_OF_CELLS {
                        return None;
                    }
                    let piece = Piece::new(cell, &beam, query.rays, [t, end]);
                    let is_start = t <= 0.0;
                    found = self.follow_points(query, &piece, alive, is_start, work);
                }
                let Some(found) = found else {
                    if is_one {
                        return None;
                    }
                    for half in halves(query.rays, alive, t) {
                        met |= self.first_of(query, half, t, work)?;
                    }
                    return Some(met);
                };
                met |= found;
                alive &= !found;
            }
            t = end;
        }
        Some(met)
    }

    /// Follows rays through a piece of their way among points. Returns those that cross the surface
    /// there, a bit each; `None` if they must be followed in another way.
    fn follow_points(
        &self,
        query: &FarQuery<'_>,
        piece: &Piece<'_>,
        alive: u32,
        is_start: bool,
        work: &mut FarWork,
    ) -> Option<u32> {
        let Some(known) = self.points.prepare(piece, work) else {
            return Some(0);
        };
        let [guess, first] = self.points.guess(piece, work);
        let start = Start {
            guess,
            first,
            is_start,
        };
        self.follow(query, piece, &known, alive, start, work)
    }

    /// Returns the parameters between which a beam may meet the surface's ball; `None` if the beam
    /// is too wide for the hierarchy. The range is empty if the beam misses the ball.
    fn range(&self, beam: &Beam) -> Option<[f64; 2]> {
        let away = self.center - beam.axis.origin;
        let along = away.dot(beam.axis.direction);
        let last = (along + self.radius).at_least(0.0);
        let width = beam.extent(last);
        if width.is_nan() || width > 0.1 * (ROOM - 1.0) * self.radius {
            return None;
        }
        let radius = self.radius + width;
        let across = (away - beam.axis.direction * along).length_squared();
        let square = radius * radius - across;
        if square <= 0.0 {
            return Some([0.0, 0.0]);
        }
        let half = square.sqrt();
        Some([(along - half).at_least(0.0), along + half])
    }
}

/// Divides two or more rays by their places at a parameter.
fn halves(rays: &[Ray; PACKET], alive: u32, t: f64) -> [u32; 2] {
    let places = rays.map(|ray| ray.at(t));
    let lanes = lanes_in(alive);
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for i in lanes.clone() {
        low = low.min(places[i]);
        high = high.max(places[i]);
    }
    let axis = (high - low).max_position();
    let middle = 0.5 * (low + high)[axis];
    let below = lanes.filter(|i| places[*i][axis] < middle);
    let below = below.fold(0, |mask, i| mask | 1 << i);
    if below == 0 || below == alive {
        // All at one place, or at none.
        let first = alive & alive.wrapping_neg();
        return [first, alive & !first];
    }
    [below, alive & !below]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::soft::Soft;
    use field::Kernel;
    use scene::{Element, Shape};
    use trials::Random;
    use trials::scenes::{clothe, element, empty, soft};

    /// Returns a cloud of balls of some finishes, in the scene's own places.
    fn cloud(kernel: Kernel, count: u32, finishes: u32, numbers: &mut Random) -> Soft {
        let mut scene = empty();
        clothe(&mut scene, vec![soft(4.0, 1.0); finishes as usize]);
        for i in 0..count {
            let shape = Shape::sphere(numbers.vector(1.0), numbers.range(0.02, 0.07));
            scene.elements.push(Element {
                kernel,
                ..element(shape, i % finishes)
            });
        }
        let surfaces = scene.soft_surfaces();
        let mut soft = Soft::new(scene, surfaces);
        soft.pixel = 2e-3;
        soft
    }

    /// Packets of rays take this way, and meet what single rays meet that are traced exactly.
    #[test]
    fn packets_meet_what_exact_rays_meet() {
        let mut numbers = Random::new(21);
        for kernel in [Kernel::Cauchy, Kernel::Squared, Kernel::Cubed] {
            let soft = cloud(kernel, 200, 3, &mut numbers);
            let mut work = FarWork::default();
            let (mut taken, mut hits, mut differ) = (0, 0, 0);
            for _ in 0..trials::count(60) {
                let eye = numbers.direction() * 4.0;
                let ball = soft.primitives[numbers.below(200)].blob_middle();
                let aim = ball + numbers.vector(0.06);
                let rays: [Ray; PACKET] = core::array::from_fn(|_| Ray {
                    origin: eye,
                    direction: (aim + numbers.vector(1.0) * 4e-3 - eye).normalize(),
                });
                let limits = [f64::INFINITY; PACKET];
                let met = soft.far_first(0, &rays, &limits, 255, Quest::First, &mut work);
                let entered = soft.far_first(0, &rays, &limits, 255, Quest::Entry, &mut work);
                let Some(met) = met else { continue };
                taken += 1;
                // Rays start outside. The answers for grazing ones may differ, as an entry is
                // searched without noise.
                let entered = entered.expect("the same way");
                differ += (entered ^ met).count_ones();
                for (lane, ray) in rays.iter().enumerate() {
                    let exact = soft.crossings(0, ray).first().copied();
                    assert_eq!(met >> lane & 1 != 0, exact.is_some(), "{kernel:?} {ray:?}");
                    let Some((t, gradient)) = exact else { continue };
                    hits += 1;
                    let samples = &work.samples;
                    // The second query has not changed the first one's samples.
                    let off = (samples.t[lane] - t).abs() * gradient.dot(ray.direction).abs();
                    assert!(off < 2e-4 * gradient.length(), "{kernel:?} {off}");
                    let got = samples.gradients()[lane];
                    assert!(got.distance(gradient) < 0.02 * gradient.length());
                    // Each finish has its share, T in all.
                    let place = ray.at(t).to_array();
                    let mut shares = [0.0; 3];
                    for (p, finish) in soft.primitives.iter().zip(&soft.finish) {
                        shares[*finish as usize] += p.value(place);
                    }
                    assert_eq!(samples.weights.len(), 3);
                    for (finish, weight) in &samples.weights {
                        let got = f64::from(weight.to_array()[lane]);
                        let want: f64 = shares[*finish as usize];
                        assert!((got - want).abs() < 2e-3, "{kernel:?} {got} {want}");
                    }
                }
            }
            assert!(
                taken > trials::count(50) && hits > trials::count(100),
                "{kernel:?} {taken} {hits}"
            );
            assert!(differ as usize <= 2 + taken / 60, "{kernel:?} {differ}");
        }
    }

    /// Packets that are too wide for small cells among many points are divided, and no ray of them
    /// is lost.
    #[test]
    fn wide_packets_meet_what_exact_rays_meet() {
        let mut numbers = Random::new(5);
        let soft = cloud(Kernel::Cauchy, 800, 1, &mut numbers);
        let mut work = FarWork::default();
        let (mut taken, mut hits) = (0, 0);
        for _ in 0..trials::count(20) {
            let eye = numbers.direction() * 4.0;
            let aim = numbers.vector(0.9);
            let rays: [Ray; PACKET] = core::array::from_fn(|_| Ray {
                origin: eye,
                direction: (aim + numbers.vector(1.0) * 2.5e-2 - eye).normalize(),
            });
            let limits = [f64::INFINITY; PACKET];
            let Some(met) = soft.far_first(0, &rays, &limits, 255, Quest::First, &mut work) else {
                continue;
            };
            taken += 1;
            for (lane, ray) in rays.iter().enumerate() {
                let exact = soft.crossings(0, ray).first().copied();
                assert_eq!(met >> lane & 1 != 0, exact.is_some(), "{ray:?}");
                let Some((t, gradient)) = exact else { continue };
                hits += 1;
                let off = (work.samples.t[lane] - t).abs() * gradient.dot(ray.direction).abs();
                assert!(off < 2e-4 * gradient.length(), "{off}");
            }
        }
        assert!(
            taken >= trials::count(15) && hits > trials::count(60),
            "{taken} {hits}"
        );
    }

    /// A ray that starts inside is left to the general way, and an end before the surface hides it.
    #[test]
    fn starts_and_ends_of_rays_count() {
        let mut numbers = Random::new(4);
        let soft = cloud(Kernel::Cauchy, 100, 1, &mut numbers);
        let center = soft.primitives[0].blob_middle();
        let mut work = FarWork::default();
        let mut first = |origin: DVec3, limit: f64| {
            let ray = Ray {
                origin,
                direction: DVec3::X,
            };
            soft.far_first(
                0,
                &[ray; PACKET],
                &[limit; PACKET],
                255,
                Quest::First,
                &mut work,
            )
        };
        assert_eq!(first(center, f64::INFINITY), None);
        let outside = DVec3::new(-5.0, center.y, center.z);
        assert_eq!(first(outside, f64::INFINITY), Some(255));
        assert_eq!(first(outside, 1.0), Some(0));
    }

    fn trace_middle(picture: &crate::Picture) -> Vec<u8> {
        let tile = crate::Tile {
            x: 192,
            y: 128,
            width: 128,
            height: 128,
        };
        let stats = &mut crate::Stats::default();
        let pixels = picture.trace(tile, crate::Pass::Full, &|| false, stats);
        pixels.expect("pixels")
    }

    /// A scene in which one ball has moved takes over cells of the scene before, and gives the same
    /// picture as if it were made anew.
    #[test]
    fn edits_give_the_picture_of_a_fresh_scene() {
        let mut numbers = Random::new(8);
        let mut scene = empty();
        clothe(&mut scene, vec![soft(4.0, 1.0); 2]);
        for i in 0..300 {
            let shape = Shape::sphere(numbers.vector(1.0), numbers.range(0.02, 0.07));
            let kernel = Kernel::Cauchy;
            let element = element(shape, i % 2);
            scene.elements.push(Element { kernel, ..element });
        }
        scene.camera.eye = DVec3::new(0.5, -4.0, 1.0).to_array().into();
        // Packets are narrow among so many pixels, of which those in the middle are enough.
        let size = [512, 384];
        let mut picture = crate::Picture::new(&scene, size);
        let mut pixels = trace_middle(&picture);
        for number in [7, 100, 101] {
            let shape = &mut scene.elements[number].shape;
            let center = 0.2 * scene.camera.eye + numbers.vector(0.15);
            *shape = Shape::sphere(center, shape.radius());
            let mut next = crate::Picture::new(&scene, size);
            let fresh = trace_middle(&next);
            assert!(fresh != pixels, "the edit shows");
            next = crate::Picture::new(&scene, size);
            assert!(picture.can_be_followed());
            next.follow(&mut picture);
            pixels = trace_middle(&next);
            let body = next.sampler.world.soft.bodies[0].far_body();
            let body = body.expect("many points");
            assert!(body.field.is_helped(), "{number}");
            let fields = body.finishes.iter().map(|(_, field)| field.as_ref());
            assert!(fields.flatten().all(|field| field.is_helped()), "{number}");
            assert!(fresh == pixels);
            picture = next;
        }
    }
}
