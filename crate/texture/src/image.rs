//! Images as textures.

use crate::solid::mix;
use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

/// Picture that textures read. Row 0 is at the top.
pub trait Image {
    /// Width and height in texels; if one is 0 the image textures nothing.
    fn size(&self) -> [u32; 2];
    /// Red, green and blue in [0, 1] of the texel in column `x` of row `y`, both within the size.
    fn texel(&self, x: u32, y: u32) -> [f32; 3];
}

/// An image of three bytes a texel, rows from the top. Bytes are shares of 255; nothing is done
/// about gamma.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Rgb8 {
    /// Width and height.
    pub size: [u32; 2],
    /// `3 · width · height` bytes; those that are missing count as 0.
    pub bytes: Vec<u8>,
}

impl Image for Rgb8 {
    fn size(&self) -> [u32; 2] {
        self.size
    }

    fn texel(&self, x: u32, y: u32) -> [f32; 3] {
        let start = 3 * (y as usize * self.size[0] as usize + x as usize);
        [0, 1, 2].map(|i| f32::from(self.bytes.get(start + i).copied().unwrap_or(0)) / 255.0)
    }
}

/// Continuation of an image beyond its edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edge {
    /// The image is repeated.
    Wrap,
    /// The outermost texels are continued.
    Hold,
}

/// Colour of an image at (u, v): interpolated linearly between the middles of four texels. (0, 0)
/// is the lower left corner, (1, 1) the upper right one. `None` if the image is empty.
///
/// ```
/// use glam::DVec2;
/// use texture::{Edge, Rgb8, sample};
/// let image = Rgb8 { size: [2, 1], bytes: vec![0, 0, 0, 255, 255, 255] };
/// assert_eq!(sample(&image, DVec2::new(0.5, 0.5), Edge::Wrap), Some([0.5; 3]));
/// assert_eq!(sample(&image, DVec2::new(0.75, 0.5), Edge::Wrap), Some([1.0; 3]));
/// ```
#[must_use]
pub fn sample(image: &dyn Image, uv: DVec2, edge: Edge) -> Option<[f64; 3]> {
    let size = image.size();
    if size[0] == 0 || size[1] == 0 {
        return None;
    }
    let [([x0, x1], s), ([y0, y1], t)] =
        [(uv.x, size[0]), (1.0 - uv.y, size[1])].map(|(t, size)| {
            let t = if t.is_finite() { t } else { 0.0 };
            let t = match edge {
                Edge::Wrap => t - t.floor(),
                Edge::Hold => t.clamp(0.0, 1.0),
            };
            let at = t * f64::from(size) - 0.5;
            let low = at.floor();
            // −1 to size − 1, and the next.
            let (low, share) = (low as i64, at - low);
            let size = i64::from(size);
            let texels = [low, low + 1].map(|i| match edge {
                Edge::Wrap => i.rem_euclid(size),
                Edge::Hold => i.clamp(0, size - 1),
            } as u32);
            (texels, share)
        });
    let corners = [(x0, y0), (x1, y0), (x0, y1), (x1, y1)];
    let corners = corners.map(|(x, y)| image.texel(x, y).map(f64::from));
    Some([0, 1, 2].map(|i| {
        let [a, b, c, d] = corners.map(|corner| corner[i]);
        let value = mix(mix(a, b, s), mix(c, d, s), t);
        if value.is_nan() {
            0.0
        } else {
            value.clamp(0.0, 1.0)
        }
    }))
}

/// Region of space in which an image is projected onto a surface: a point is textured if it lies in
/// the box and the line from it along its outward normal meets the rectangle. There it reads the
/// image, whose lower left corner is at the first corner, lower right at the second, upper right at
/// the third, upper left at the fourth.
///
/// A rectangle that stands before a face thus spreads the image over all that looks at it, around
/// bulges as well, as a flat sheet wrapped over the face would; what looks elsewhere stays plain.
///
/// ```
/// use glam::{DVec2, DVec3};
/// use texture::Region;
/// let square = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
/// let square = square.map(|(x, y)| DVec3::new(x, y, 2.0));
/// let region = Region { min: DVec3::splat(-1.0), max: DVec3::splat(1.0), corners: square };
/// assert_eq!(region.uv(DVec3::Z, DVec3::Z), Some(DVec2::splat(0.5)));
/// assert_eq!(region.uv(DVec3::X, DVec3::X), None); // looks past the square
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Region {
    /// Corner of the box.
    pub min: DVec3,
    /// The opposite corner; the two may be given in any order.
    pub max: DVec3,
    /// The rectangle's corners in order around it. The third follows from the others: P3 = P2 + P4
    /// − P1 (see [`Region::is_rectangle`]); a parallelogram serves as well.
    pub corners: [DVec3; 4],
}

impl Region {
    /// Returns the place where the line from a point along its outward unit normal meets the
    /// rectangle, in shares of its sides. `None` if the point is outside the box, or the line
    /// misses the rectangle, runs away from it or beside it, or if the rectangle has no area.
    #[must_use]
    pub fn uv(&self, point: DVec3, normal: DVec3) -> Option<DVec2> {
        let (low, high) = (self.min.min(self.max), self.min.max(self.max));
        if !(point.cmpge(low).all() && point.cmple(high).all()) {
            return None;
        }
        let [origin, second, _, fourth] = self.corners;
        let (right, up) = (second - origin, fourth - origin);
        let across = right.cross(up);
        let area = across.length_squared();
        let slope = across.dot(normal);
        // NaN fails the comparisons.
        if !(area > 0.0 && area < f64::INFINITY && slope * slope > 1e-18 * area) {
            return None;
        }
        let distance = across.dot(origin - point) / slope;
        if !(0.0..f64::INFINITY).contains(&distance) {
            return None;
        }
        let at = point + distance * normal - origin;
        let uv = DVec2::new(at.cross(up).dot(across), right.cross(at).dot(across)) / area;
        (uv.cmpge(DVec2::ZERO).all() && uv.cmple(DVec2::ONE).all()).then_some(uv)
    }

    /// Whether the four corners are those of a parallelogram with an area, up to a thousandth of
    /// its longer side.
    #[must_use]
    pub fn is_rectangle(&self) -> bool {
        let [a, b, c, d] = self.corners;
        let size = (b - a).length().max((d - a).length());
        let area = (b - a).cross(d - a).length();
        area > 1e-9 * size * size && (a + c - b - d).length() <= 1e-3 * size
    }
}
