//! Gaussian bones as strings of beads: sums of so many points that the difference is next to nothing.
//!
//! What is known of a point's course along a ray is exact (see [`course`](crate::course)), so a ray is followed sooner
//! through the beads of a bone than through the bone. Where the field itself is computed by nodes, as that of curves and of
//! limbs that taper, the beads are those nodes. Arcs and short segments get some by Gauss–Legendre: for `e^(−x²)` over a length l
//! the rule with n nodes is right to `l²ⁿ⁺¹(n!)³/((2n+1)(2n)!²)`, since the largest of the derivatives of order 2n is
//! `(2n)!/n!`, at 0.
use crate::bone::Bone;
use crate::bone::curve::gauss_legendre;
use crate::{Kernel, Lump, Primitive, Skeleton};
use glam::DVec3;

/// A point that stands for a piece of a Gaussian bone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bead {
    /// Where it is.
    pub center: DVec3,
    /// The width parameter of its kernel.
    pub scale: f64,
    /// Its field at the centre.
    pub amplitude: f64,
}

/// Bones that would need more beads than this are not cut into beads.
const MOST: usize = 256;

/// An arc is cut into pieces of at most this length, in kernel widths …
const LONGEST: f64 = 4.0;
/// … and of at most this angle.
const WIDEST: f64 = 1.0;

/// What is left, in kernel widths: of the integral of `e^(−x²)` over a piece.
const LEFT: f64 = 2e-8;

impl Primitive {
    /// The beads of a bone that is not too long, adds to the field, and has no profile. `None` for bones that are points already, for
    /// straight long ones and for faces, and for all kernels but the Gaussian.
    #[must_use]
    pub fn beads(&self) -> Option<Vec<Bead>> {
        let term = &self.prepared.double;
        if self.kernel != Kernel::Gauss || term.waves.is_some() || term.amplitude <= 0.0 {
            return None;
        }
        let along = |measure: f64, angle: f64, place: &dyn Fn(f64) -> DVec3| {
            let length = measure * self.width;
            // The field of a crisp bone is a tiny part of its amplitude where it is T.
            let left = LEFT / term.amplitude.max(1.0);
            let pieces = (length / LONGEST).max(angle / WIDEST).ceil().max(1.0);
            // A bent piece calls for one more.
            let count = nodes(length / pieces, left) + usize::from(angle > 0.0);
            if pieces * count as f64 > MOST as f64 {
                return None;
            }
            let rule = gauss_legendre(count);
            let mut beads = Vec::with_capacity(pieces as usize * count);
            for piece in 0..pieces as usize {
                beads.extend(rule.iter().map(|[node, weight]| Bead {
                    center: place((piece as f64 + 0.5 + 0.5 * node) / pieces),
                    scale: self.width,
                    amplitude: term.amplitude * 0.5 * weight * length / pieces,
                }));
            }
            Some(beads)
        };
        match (&term.form.bone, &self.skeleton) {
            (Bone::Curve(_), _) => {
                let Bone::Curve(shipped) = &self.prepared.single.form.bone else {
                    return None;
                };
                if shipped.nodes.len() > MOST {
                    return None;
                }
                let axes = term.frame.axes.map(DVec3::from_array);
                let origin = DVec3::from_array(term.frame.origin);
                let square = self.width * self.width;
                let bead = |node: &crate::bone::curve::Node<f32>| {
                    let [x, y, z] = node.position.map(f64::from);
                    let thinness = if shipped.tapered {
                        f64::from(node.thinness)
                    } else {
                        1.0
                    };
                    Bead {
                        center: origin + (axes[0] * x + axes[1] * y + axes[2] * z) / square,
                        scale: self.width * thinness.sqrt(),
                        amplitude: term.amplitude * f64::from(node.weight),
                    }
                };
                Some(shipped.nodes.iter().map(bead).collect())
            }
            (
                Bone::Arc(_),
                &Skeleton::Arc {
                    center,
                    u,
                    v,
                    radius,
                    angle,
                },
            ) => along(radius * angle, angle, &|share| {
                let (sine, cosine) = libm::sincos(share * angle);
                center + (u * cosine + v * sine) * radius
            }),
            (Bone::Segment(_), &Skeleton::Segment { base, apex })
                if self.lump::<f32>().is_none() =>
            {
                along(base.distance(apex), 0.0, &|share| base.lerp(apex, share))
            }
            _ => None,
        }
    }
}

impl Bead {
    /// The bead as a lump, if it is not too large for one.
    #[must_use]
    pub fn lump(&self) -> Option<Lump<f32>> {
        Lump::point(self.scale, self.amplitude)
    }
}

/// So many nodes leave no more than `most` of the integral over a length.
fn nodes(length: f64, most: f64) -> usize {
    // The remainder for one node, and from one number of nodes to the next.
    let (mut left, mut n) = (length * length * length / 12.0, 1.0);
    while left > most && n < 48.0 {
        n += 1.0;
        let (a, b) = (2.0 * n, 2.0 * n - 1.0);
        left *= length * length * n * n * n * b / ((a + 1.0) * (a * b) * (a * b));
    }
    n as usize
}
