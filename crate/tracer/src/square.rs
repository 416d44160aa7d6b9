//! Convolution surfaces near a square of pixels: data that its packets share.
use crate::area::Area;
use crate::beams::Beams;
use crate::layout::packet_number;
use crate::lens::Lens;
use crate::nearby::Nearby;
use crate::quick::LEFT_OUT_OF_PARTS;
use crate::scratch::Scratch;
use crate::slabs::Slabs;
use crate::soft::Soft;
use crate::stats::Stats;
use crate::view::{View, division};
use crate::world::World;

/// Number of parts of a square in each direction.
const PARTS: u32 = 4;

/// Length of a list from which the parts get no lists of their own, which would need much space
/// where blobs are large.
const MANY: usize = 1 << 15;

/// The convolution surfaces near a square of pixels, divided into columns and rows of packets.
pub(crate) struct Square<'a> {
    soft: &'a Soft,
    view: &'a View,
    area: Area,
    packets: [u32; 2],
    /// Blobs near the square; `None` if all bodies take the general way.
    blobs: Option<Blobs>,
    /// Bodies that take the general way in every packet, each with the least parameter at which a
    /// ray may meet it.
    general: Vec<(f64, u32)>,
    /// Slabs of bodies, with the parameter at which they start; made at the first use.
    slabs: Vec<(u32, Option<(Slabs<'a>, f64)>)>,
}

/// The blobs in a square, and in each of its parts.
struct Blobs {
    all: Nearby,
    lens: Option<Lens>,
    parts: Vec<Option<Nearby>>,
}

impl<'a> Square<'a> {
    /// Prepares an area. `packets` are powers of two.
    pub fn new(world: &'a World, view: &'a View, area: Area, packets: [u32; 2]) -> Self {
        let soft = &world.soft;
        let mut square = Self {
            soft,
            view,
            area,
            packets,
            blobs: None,
            general: Vec::new(),
            slabs: Vec::new(),
        };
        if soft.is_empty() {
            return square;
        }
        let mut all = Nearby::default();
        let beam = view.beam(area);
        if soft.list_blobs(&beam, f64::INFINITY, &mut all) {
            square.blobs = Some(Blobs {
                lens: Lens::new(view, area, &beam),
                all,
                parts: vec![None; (PARTS * PARTS) as usize],
            });
            let bodies = 0..soft.bodies.len() as u32;
            let everywhere = bodies.filter(|&body| soft.is_everywhere(body));
            square.general = everywhere.map(|body| (0.0, body)).collect();
        } else if soft.bodies.len() == 1 {
            square.general.push((0.0, 0));
        } else {
            soft.bodies_along(&beam, f64::INFINITY, &mut square.general);
        }
        square
    }

    /// Lists the bodies that take the general way in a packet, given by its column and row: those
    /// with primitives near it that are no blobs, each with the least parameter at which a ray may
    /// meet it.
    pub fn general(&mut self, place: [u32; 2], bodies: &mut Vec<(f64, u32)>) {
        bodies.clear();
        let several = self.soft.bodies.len() > 1;
        let beam = |square: &Self| square.view.beam(square.area.cell(place, square.packets));
        if several && !self.general.is_empty() {
            let beam = beam(self);
            bodies.extend(self.general.iter().filter(|&&(_, body)| {
                let ball = self.soft.bodies[body as usize].ball;
                ball.is_none_or(|(center, radius)| beam.meets(center, radius))
            }));
        } else {
            bodies.extend(&self.general);
        }
        if self
            .blobs
            .as_ref()
            .is_none_or(|blobs| blobs.all.others.is_empty())
        {
            return;
        }
        let Some((near, _)) = self.blobs(place) else {
            return;
        };
        if near.others.is_empty() {
            return;
        }
        let others = near.others.clone();
        // Others may be nearer than the first blob, where the list's parameters start.
        let mut met = Vec::new();
        self.soft
            .bodies_met(&others, &beam(self), f64::INFINITY, &mut met);
        bodies.extend(met.into_iter().map(|body| (0.0, body)));
    }

    /// Returns the blobs near the part that holds a packet, given by its column and row, and the
    /// lens for single precision rays (`None` if the square is too wide); `None` if there are none,
    /// or all bodies take the general way.
    pub fn blobs(&mut self, [column, row]: [u32; 2]) -> Option<(&Nearby, Option<&Lens>)> {
        let [columns, rows] = self.packets;
        let (view, area) = (self.view, self.area);
        let Blobs { all, lens, parts } = self.blobs.as_mut()?;
        if all.len() == 0 && all.others.is_empty() {
            return None;
        }
        if all.len() == 0 || all.len() > MANY || columns < 2 * PARTS {
            return Some((all, lens.as_ref()));
        }
        let (i, j) = (column * PARTS / columns, row * PARTS / rows);
        let part = parts[(j * PARTS + i) as usize].get_or_insert_with(|| {
            let mut near = Nearby::default();
            let beam = view.beam(area.cell([i, j], [PARTS; 2]));
            all.narrow(&beam.from(all.base), LEFT_OUT_OF_PARTS, &mut near);
            let others = all.others.iter();
            near.others
                .extend(others.filter(|other| beam.meets(other.center, other.radius)));
            near
        });
        Some((part, lens.as_ref()))
    }

    /// Returns the slabs of a body, the parameter at which they start, and the packet's number
    /// among the divisions of their beam; `None` if no ray of the packet, given by its column and
    /// row, can meet the body.
    pub fn slabs(
        &mut self,
        body: u32,
        place: [u32; 2],
        scratch: &mut Scratch,
    ) -> Option<(&mut Slabs<'a>, f64, usize)> {
        let at = match self.slabs.iter().position(|(own, _)| *own == body) {
            Some(at) => at,
            None => {
                let slabs = self.make_slabs(body, scratch);
                self.slabs.push((body, slabs));
                self.slabs.len() - 1
            }
        };
        let number = packet_number(place, self.packets);
        let (slabs, base) = self.slabs[at].1.as_mut()?;
        (!slabs.is_empty_for(number)).then_some((slabs, *base, number))
    }

    /// Makes the slabs of a body along the square's beam; `None` if no ray can meet the body.
    fn make_slabs(&self, body: u32, scratch: &mut Scratch) -> Option<(Slabs<'a>, f64)> {
        let (view, area, packets) = (self.view, self.area, self.packets);
        let levels = packets[0].ilog2() + packets[1].ilog2();
        self.soft.slabs(
            body,
            view.beam(area),
            |base| {
                Beams::tree(levels, move |number| {
                    view.beam(division(area, packets, number)).from(base)
                })
            },
            f64::INFINITY,
            &mut scratch.spaces,
        )
    }

    /// Returns the square's working space to `scratch`, and adds its evaluations to `stats`.
    pub fn leave(self, scratch: &mut Scratch, stats: &mut Stats) {
        for (slabs, _) in self.slabs.into_iter().filter_map(|(_, slabs)| slabs) {
            stats.field_evaluations += slabs.evaluations();
            scratch.spaces.push(slabs.into_space());
        }
    }
}
