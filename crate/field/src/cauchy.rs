//! Closed forms of the Cauchy kernel `h(r) = 1/(1+s²r²)²` (thesis, sections 2.3.1 and 2.4).
//!
//! All work in the primitive's own frame, in units of the kernel's width: lengths are multiplied
//! by s, so that the kernel is `1/(1+r²)²`. Each file states its formula. They equal the thesis's,
//! rearranged so that nearly equal numbers are not subtracted: then single precision suffices,
//! and there are no special cases at axes, ends, edges or far away.

pub mod arc;
pub mod polygon;
pub mod segment;
pub mod triangle;
