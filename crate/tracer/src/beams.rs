//! A beam and its divisions, down to one beam for each packet of rays.
use crate::beam::Beam;
use core::cell::OnceCell;

/// A function that makes the n-th beam of a division, where 0 is the whole and the halves of beam i
/// are 2i+1 and 2i+2.
type Narrow<'a> = dyn Fn(usize) -> Beam + 'a;

/// A binary tree of beams, the halves of beam i at 2i+1 and 2i+2, whose last level has one beam for
/// each packet of rays. Beams are made at first use.
pub struct Beams<'a> {
    made: Vec<OnceCell<Beam>>,
    narrow: Box<Narrow<'a>>,
}

impl<'a> Beams<'a> {
    /// Returns a beam that is not divided.
    #[must_use]
    pub fn one(beam: Beam) -> Self {
        Self {
            made: vec![OnceCell::from(beam)],
            narrow: Box::new(move |_| beam),
        }
    }

    /// Returns the tree of a beam that is halved `levels` times.
    #[must_use]
    pub fn tree(levels: u32, narrow: impl Fn(usize) -> Beam + 'a) -> Self {
        Self {
            made: vec![OnceCell::new(); (2 << levels) - 1],
            narrow: Box::new(narrow),
        }
    }

    /// Returns a beam.
    #[inline]
    #[must_use]
    pub fn get(&self, index: usize) -> &Beam {
        self.made[index].get_or_init(|| (self.narrow)(index))
    }

    /// Returns the number of levels below a beam.
    #[must_use]
    pub fn levels_below(&self, beam: usize) -> u32 {
        (self.made.len() + 1).ilog2() - (beam + 1).ilog2() - 1
    }

    /// Returns the quarter of a beam that contains a packet (the half, if that is not divided
    /// further), and its number among the beam's quarters. `None` if the beam is not divided.
    #[must_use]
    pub fn quarter(&self, beam: usize, packet: usize) -> Option<(usize, usize)> {
        let deeper = self.levels_below(beam).min(2);
        if deeper == 0 {
            return None;
        }
        // The packet's own beam is in the last level; its ancestors are found by halving.
        let own = (self.made.len() / 2) + packet + 1;
        let above = self.levels_below(beam) - deeper;
        let quarter = (own >> above) - 1;
        Some((quarter, (quarter + 1) & ((1 << deeper) - 1)))
    }
}
