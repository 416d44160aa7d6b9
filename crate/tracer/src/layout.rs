//! The layout of a picture: squares of pixels, and in them packets of rays.
//!
//! Squares and packets are laid out from the picture's corner, whatever the tiles, and a packet is
//! always traced whole: so a pixel's value does not depend on how the picture is cut into tiles.

/// Number of rays in a packet.
pub const PACKET: usize = 8;
/// Pixels of a packet, across and down.
pub(crate) const PACKET_SIZE: [u32; 2] = [4, 2];
/// Side of the squares of pixels that share a beam.
pub(crate) const SQUARE: u32 = 64;
/// Side of the blocks of pixels that have one ray at first.
pub(crate) const BLOCK: u32 = 8;

/// Returns the lanes of a packet whose bits are set.
#[inline(always)]
pub(crate) fn lanes_in(bits: u32) -> impl Iterator<Item = usize> + Clone {
    (0..PACKET).filter(move |lane| bits >> lane & 1 != 0)
}

/// Whether a rectangle of packets is next halved across: as long as it is not taller than wide.
pub(crate) fn halves_across([columns, rows]: [u32; 2]) -> bool {
    columns * PACKET_SIZE[0] >= rows * PACKET_SIZE[1] && columns > 1
}

/// Returns the number of a packet, given its column and row in a rectangle of packets, in the last
/// level of the binary tree of the rectangle's halves.
pub(crate) fn packet_number([mut column, mut row]: [u32; 2], mut packets: [u32; 2]) -> usize {
    let mut number = 0;
    while packets != [1, 1] {
        let across = halves_across(packets);
        let axis = usize::from(!across);
        packets[axis] /= 2;
        let place = if across { &mut column } else { &mut row };
        let far = *place >= packets[axis];
        if far {
            *place -= packets[axis];
        }
        number = 2 * number + usize::from(far);
    }
    number
}
