//! What the packets of a square of pixels share.
use crate::area::Area;
use crate::beam::Beam;
use crate::lens::Lens;
use crate::nearby::Nearby;
use crate::packet::{Near, Workspace};
use crate::picture::{Picture, packet_number};
use crate::quick::LEFT_OUT_OF_PARTS;
use crate::slabs::Slabs;

/// What is known of the soft surface in a square of pixels.
pub(crate) enum Square<'a> {
    /// There is none.
    Empty,
    /// Lumps alone.
    Lumps(Lumps<'a>),
    /// Slabs, and the parameter at which they start.
    Slabs((Slabs<'a>, f64)),
}

impl<'a> Square<'a> {
    /// What of it a packet needs, given by its column and row among so many.
    pub fn near(&mut self, place: [u32; 2], packets: [u32; 2]) -> Near<'_, 'a> {
        match self {
            Self::Empty => Near::Nothing,
            Self::Slabs(slabs) => {
                let number = packet_number(place, packets);
                if slabs.0.is_empty_for(number) {
                    Near::Nothing
                } else {
                    Near::Slabs(slabs, number)
                }
            }
            Self::Lumps(lumps) => match lumps.near(place) {
                (near, _) if near.len() == 0 => Near::Nothing,
                (near, lens) => Near::Lumps(near, lens),
            },
        }
    }
}

impl Square<'_> {
    /// Leaves the space that it took to others.
    pub fn leave(self, work: &mut Workspace) {
        if let Self::Slabs((slabs, _)) = self {
            work.scratch.spaces.push(slabs.into_space());
        }
    }
}

/// Parts of a square in each direction.
const PARTS: u32 = 4;

/// Longer lists have none for parts, which would need much space where lumps are large.
const MANY: usize = 1 << 15;

/// The lumps in a square, and in each of its parts.
pub(crate) struct Lumps<'a> {
    picture: &'a Picture,
    area: Area,
    packets: [u32; 2],
    all: Nearby,
    lens: Option<Lens>,
    parts: Vec<Option<Nearby>>,
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
        }
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
            let [width, height] =
                [area.right - area.left, area.bottom - area.top].map(|n| n / PARTS);
            let (left, top) = (area.left + i * width, area.top + j * height);
            let part = Area {
                left,
                top,
                right: left + width,
                bottom: top + height,
            };
            let mut near = Nearby::default();
            let beam = picture.beam(part).from(all.base);
            all.narrow(&beam, LEFT_OUT_OF_PARTS, &mut near);
            near
        });
        (part, lens.as_ref())
    }
}
