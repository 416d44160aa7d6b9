//! Blob chains: Gaussian bones as sums of points, with a negligible difference.
//!
//! Bounds on a point along a ray are exact (see [`blob`](crate::blob)), so marching a ray through a
//! chain of points is cheaper than through the bone. Where the field itself is a sum over nodes
//! (curves, tapered bones), the chain is those nodes. Arcs and short segments get Gauss–Legendre
//! nodes: for `e^(−x²)` over a length l the rule with n nodes is right to
//! `l²ⁿ⁺¹(n!)³/((2n+1)(2n)!²)`, since the largest of the derivatives of order 2n is `(2n)!/n!`, at
//! 0.
use crate::bone::Bone;
use crate::bone::curve::gauss_legendre;
use crate::{Blob, Kernel, Primitive, Skeleton};
use glam::DVec3;

/// Point of a chain: it stands for a piece of a Gaussian bone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChainBlob {
    /// Position.
    pub center: DVec3,
    /// Width parameter of its kernel, an inverse length.
    pub scale: f64,
    /// Field at the centre.
    pub amplitude: f64,
}

/// Most blobs in a chain; bones that would need more have none.
const MOST_BLOBS: usize = 256;

/// Longest piece of a bone that one rule serves, in kernel widths.
const LONGEST_PIECE: f64 = 4.0;
/// Largest angle of an arc's piece that one rule serves, in radians.
const WIDEST_PIECE: f64 = 1.0;

/// Largest error of the integral of `e^(−x²)` over a piece, in kernel widths.
const MOST_LEFT_OUT: f64 = 2e-8;

impl Primitive {
    /// Returns the bone as a chain of Gaussian points. `None` for kernels other than the Gaussian,
    /// for points, faces and long straight segments, for bones that subtract or have a profile, and
    /// for bones of more than 256 nodes.
    #[must_use]
    pub fn blob_chain(&self) -> Option<Vec<ChainBlob>> {
        let term = &self.prepared.double;
        if self.kernel != Kernel::Gauss || term.waves.is_some() || term.amplitude <= 0.0 {
            return None;
        }
        match (&term.form.bone, &self.skeleton) {
            (Bone::Curve(_), _) => {
                let Bone::Curve(shipped) = &self.prepared.single.form.bone else {
                    return None;
                };
                if shipped.nodes.len() > MOST_BLOBS {
                    return None;
                }
                let axes = term.frame.axes.map(DVec3::from_array);
                let origin = DVec3::from_array(term.frame.origin);
                let square = self.width * self.width;
                let blobs = shipped.nodes.iter().map(|node| {
                    let [x, y, z] = node.position.map(f64::from);
                    let thinness = if shipped.tapered {
                        f64::from(node.thinness)
                    } else {
                        1.0
                    };
                    ChainBlob {
                        center: origin + (axes[0] * x + axes[1] * y + axes[2] * z) / square,
                        scale: self.width * thinness.sqrt(),
                        amplitude: term.amplitude * f64::from(node.weight),
                    }
                });
                Some(blobs.collect())
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
            ) => self.chain_along(radius * angle, angle, |share| {
                let (sine, cosine) = libm::sincos(share * angle);
                center + (u * cosine + v * sine) * radius
            }),
            (Bone::Segment(_), &Skeleton::Segment { base, apex })
                if self.blob::<f32>().is_none() =>
            {
                self.chain_along(base.distance(apex), 0.0, |share| base.lerp(apex, share))
            }
            _ => None,
        }
    }

    /// Returns the chain of a uniform bone, given its length, its angle (0 for a segment) and its
    /// place at each fraction of the length; `None` if it would have too many blobs.
    fn chain_along(
        &self,
        measure: f64,
        angle: f64,
        place: impl Fn(f64) -> DVec3,
    ) -> Option<Vec<ChainBlob>> {
        let amplitude = self.prepared.double.amplitude;
        let length = measure * self.width;
        // The error counts against T, which is a small fraction of a large amplitude.
        let left = MOST_LEFT_OUT / amplitude.max(1.0);
        let pieces = (length / LONGEST_PIECE)
            .max(angle / WIDEST_PIECE)
            .ceil()
            .max(1.0);
        // A curved piece needs one node more.
        let count = nodes(length / pieces, left) + usize::from(angle > 0.0);
        if pieces * count as f64 > MOST_BLOBS as f64 {
            return None;
        }
        let rule = gauss_legendre(count);
        let mut chain = Vec::with_capacity(pieces as usize * count);
        for piece in 0..pieces as usize {
            chain.extend(rule.iter().map(|[node, weight]| ChainBlob {
                center: place((piece as f64 + 0.5 + 0.5 * node) / pieces),
                scale: self.width,
                amplitude: amplitude * 0.5 * weight * length / pieces,
            }));
        }
        Some(chain)
    }
}

impl ChainBlob {
    /// The point as a [`Blob`]; `None` if its derivatives would overflow single precision.
    #[must_use]
    pub fn blob(&self) -> Option<Blob<f32>> {
        Blob::point(self.scale, self.amplitude)
    }
}

/// Returns the number of Gauss–Legendre nodes that leaves an error of at most `most` over a length
/// (see the module).
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
