//! What the packets of a square of pixels share.
use crate::area::Area;
use crate::beam::Beam;
use crate::lens::Lens;
use crate::nearby::{Nearby, Other};
use crate::packet::{Near, Workspace};
use crate::picture::{Picture, Stats, packet_number};
use crate::quick::LEFT_OUT_OF_PARTS;
use crate::slabs::Slabs;

/// What is known of the soft surface in a square of pixels.
#[expect(clippy::large_enum_variant, reason = "a thread has one at a time")]
pub(crate) enum Square<'a> {
    /// There is none.
    Empty,
    /// Lumps, and few other primitives if any.
    Lumps(Lumps<'a>),
    /// Slabs, and the parameter at which they start.
    Slabs((Slabs<'a>, f64)),
}

impl<'a> Square<'a> {
    /// What of it a packet needs, given by its column and row among so many.
    pub fn near(
        &mut self,
        place: [u32; 2],
        packets: [u32; 2],
        work: &mut Workspace,
    ) -> Near<'_, 'a> {
        let slabs = match self {
            Self::Empty => return Near::Nothing,
            Self::Slabs(slabs) => slabs,
            Self::Lumps(lumps) => {
                if !lumps.meets_others(place) {
                    return match lumps.near(place) {
                        (near, _) if near.len() == 0 => Near::Nothing,
                        (near, lens) => Near::Lumps(near, lens),
                    };
                }
                let (picture, area) = (lumps.picture, lumps.area);
                let slabs = lumps
                    .slabs
                    .get_or_insert_with(|| picture.slabs(area, packets, work));
                match slabs {
                    Some(slabs) => slabs,
                    None => return Near::Nothing,
                }
            }
        };
        let number = packet_number(place, packets);
        if slabs.0.is_empty_for(number) {
            Near::Nothing
        } else {
            Near::Slabs(slabs, number)
        }
    }
}

impl Square<'_> {
    /// Leaves the space that it took to others, and counts what was done for all of its packets.
    pub fn leave(self, work: &mut Workspace, stats: &mut Stats) {
        let slabs = match self {
            Self::Slabs(slabs) => Some(slabs),
            Self::Lumps(lumps) => lumps.slabs.flatten(),
            Self::Empty => None,
        };
        if let Some((slabs, _)) = slabs {
            stats.field_evaluations += slabs.evaluations();
            work.scratch.spaces.push(slabs.into_space());
        }
    }
}

/// Parts of a square in each direction.
const PARTS: u32 = 4;

/// Longer lists have none for parts, which would need much space where lumps are large.
const MANY: usize = 1 << 15;

/// The lumps in a square, and in each of its parts; and its slabs, for packets near anything else.
pub(crate) struct Lumps<'a> {
    picture: &'a Picture,
    area: Area,
    packets: [u32; 2],
    all: Nearby,
    lens: Option<Lens>,
    parts: Vec<Option<Nearby>>,
    slabs: Option<Option<(Slabs<'a>, f64)>>,
}

impl<'a> Lumps<'a> {
    /// `all` are those near the beam of the area.
    pub fn new(
        picture: &'a Picture,
        area: Area,
        packets: [u32; 2],
        beam: &Beam,
        all: Nearby,
    ) -> Self {
        Self {
            lens: Lens::new(picture, area, beam),
            picture,
            area,
            packets,
            all,
            parts: vec![None; (PARTS * PARTS) as usize],
            slabs: None,
        }
    }

    /// Whether the packet in a column and row comes near anything that is no lump.
    fn meets_others(&mut self, [column, row]: [u32; 2]) -> bool {
        if self.all.others.is_empty() {
            return false;
        }
        let (picture, area, packets) = (self.picture, self.area, self.packets);
        let (near, _) = self.near([column, row]);
        if near.others.is_empty() {
            return false;
        }
        // Others may be nearer than the first lump, from which lists are counted.
        let beam = picture.beam(area.cell([column, row], packets));
        picture.soft.meets_any(&near.others, &beam, f64::INFINITY)
    }

    /// Those in the part that holds the packet in a column and row.
    fn near(&mut self, [column, row]: [u32; 2]) -> (&Nearby, Option<&Lens>) {
        let [columns, rows] = self.packets;
        if self.all.len() == 0 || self.all.len() > MANY || columns < 2 * PARTS {
            return (&self.all, self.lens.as_ref());
        }
        let (i, j) = (column * PARTS / columns, row * PARTS / rows);
        let Self {
            picture,
            area,
            all,
            lens,
            parts,
            ..
        } = self;
        let part = parts[(j * PARTS + i) as usize].get_or_insert_with(|| {
            let mut near = Nearby::default();
            let beam = picture.beam(area.cell([i, j], [PARTS; 2]));
            all.narrow(&beam.from(all.base), LEFT_OUT_OF_PARTS, &mut near);
            let met = |other: &&Other| beam.meets(other.center, other.radius);
            near.others.extend(all.others.iter().filter(met));
            near
        });
        (part, lens.as_ref())
    }
}
