//! Triangles and rectangles on the grid of pixels: which pixels they cover, and what value a
//! quantity given at the corners has at each.
//!
//! A pixel belongs to a triangle when its centre lies inside; on an edge, when the edge is a top or
//! a left one, so that neighbours neither leave gaps nor blend twice. Corners are snapped to 1/256
//! of a pixel and the edges are evaluated in integers, so this is exact.

use egui::Color32;

/// Steps in a pixel to which corners are snapped, as on GPUs.
pub const STEPS: i32 = 256;
/// Corners further out than this, in pixels, are moved here, so that integers do not overflow.
const FAR: f32 = (1 << 21) as f32;

/// The pixels x0 ≤ x < x1, y0 ≤ y < y1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Area {
    /// First column.
    pub x0: i32,
    /// First row.
    pub y0: i32,
    /// After the last column.
    pub x1: i32,
    /// After the last row.
    pub y1: i32,
}

impl Area {
    /// The pixels in both areas.
    #[must_use]
    pub fn intersect(self, other: Self) -> Self {
        Self {
            x0: self.x0.max(other.x0),
            y0: self.y0.max(other.y0),
            x1: self.x1.min(other.x1),
            y1: self.y1.min(other.y1),
        }
    }

    /// Returns the hash of this area after what has the hash `before`.
    pub fn hash(self, before: u64) -> u64 {
        let columns = join([self.x0 as u32, self.x1 as u32]);
        let rows = join([self.y0 as u32, self.y1 as u32]);
        mix(mix(before, columns), rows)
    }

    /// Whether there is no pixel in it.
    #[must_use]
    pub fn is_empty(self) -> bool {
        self.x0 >= self.x1 || self.y0 >= self.y1
    }
}

/// A corner of a triangle.
#[derive(Clone, Copy, Debug)]
pub struct Corner {
    /// Position in steps of 1/256 pixel.
    position: [i32; 2],
    /// Texture coordinates in texels.
    pub texel: [f32; 2],
    /// The tint of the texture, multiplied by its alpha.
    pub tint: Color32,
}

impl Corner {
    /// A corner at a position in pixels; `None` if a coordinate is not a number.
    pub fn new(position: [f32; 2], texel: [f32; 2], tint: Color32) -> Option<Self> {
        let defined = position.iter().chain(&texel).all(|c| !c.is_nan());
        defined.then(|| Self {
            position: position
                .map(|c| (c.clamp(-FAR, FAR) * STEPS as f32).round_ties_even() as i32),
            texel,
            tint,
        })
    }

    /// Returns the hash of this corner after what has the hash `before`.
    pub fn hash(&self, before: u64) -> u64 {
        let words = [
            join(self.position.map(|c| c as u32)),
            join(self.texel.map(f32::to_bits)),
            u64::from(u32::from_le_bytes(self.tint.to_array())),
        ];
        words.into_iter().fold(before, mix)
    }
}

/// Returns a hash of two numbers in order, the first of which is a hash.
pub fn mix(a: u64, b: u64) -> u64 {
    // An odd multiplier (2⁶⁴ over the golden ratio) loses nothing and carries low bits up.
    (a.rotate_left(5) ^ b).wrapping_mul(0x9e37_79b9_7f4a_7c15)
}

/// Returns the number with these upper and lower halves.
fn join([a, b]: [u32; 2]) -> u64 {
    u64::from(a) << 32 | u64::from(b)
}

/// The first pixel whose centre is not before a position in steps.
fn first_pixel(position: i64) -> i32 {
    // ⌈(position − 128) / 256⌉
    let pixel = position
        .saturating_add(i64::from(STEPS) / 2 - 1)
        .div_euclid(i64::from(STEPS));
    pixel.clamp(i32::MIN.into(), i32::MAX.into()) as i32
}

/// A rectangle along the axes with one tint, as glyphs and pictures are.
#[derive(Clone, Copy, Debug)]
pub struct Quad {
    /// The left upper and the right lower corner.
    corners: [Corner; 2],
}

impl Quad {
    /// The rectangle which the corners left top, right top, left bottom, right bottom make, if
    /// they do.
    pub fn new([a, b, c, d]: [Corner; 4]) -> Option<Self> {
        let is_quad = is_box([a, b, c, d].map(|corner| corner.position))
            && is_box([a, b, c, d].map(|corner| corner.texel))
            && [b, c, d].iter().all(|corner| corner.tint == a.tint)
            && (0..2).all(|axis| a.position[axis] < d.position[axis]);
        is_quad.then_some(Self { corners: [a, d] })
    }

    /// The pixels covered.
    pub fn area(&self) -> Area {
        let [from, to] = self
            .corners
            .map(|corner| corner.position.map(|c| first_pixel(i64::from(c))));
        Area {
            x0: from[0],
            y0: from[1],
            x1: to[0],
            y1: to[1],
        }
    }

    /// Texels per pixel along an axis.
    pub fn scale(&self, axis: usize) -> f32 {
        let [from, to] = self.corners;
        let pixels = (to.position[axis] - from.position[axis]) as f32 / STEPS as f32;
        (to.texel[axis] - from.texel[axis]) / pixels
    }

    /// The texture coordinate at the centre of a pixel.
    pub fn texel(&self, axis: usize, pixel: i32) -> f32 {
        let from = self.corners[0];
        let offset = pixel as f32 + 0.5 - from.position[axis] as f32 / STEPS as f32;
        from.texel[axis] + offset * self.scale(axis)
    }

    /// The left upper and the right lower corner.
    pub fn corners(&self) -> &[Corner] {
        &self.corners
    }
}

/// Whether the points left top, right top, left bottom, right bottom make a box along the axes.
fn is_box<T: PartialEq>([a, b, c, d]: [[T; 2]; 4]) -> bool {
    a[1] == b[1] && c[1] == d[1] && a[0] == c[0] && b[0] == d[0]
}

/// A value that changes linearly over the window.
#[derive(Clone, Copy)]
pub struct Plane {
    origin: f64,
    /// Change from a pixel to the next on the right.
    pub dx: f64,
    /// Change from a pixel to the next below.
    pub dy: f64,
}

impl Plane {
    /// Returns the value at the centre of a pixel.
    pub fn at(self, x: i32, y: i32) -> f32 {
        (self.origin + (f64::from(x) + 0.5) * self.dx + (f64::from(y) + 0.5) * self.dy) as f32
    }
}

/// A triangle with an area.
pub struct Triangle {
    /// The corners as given.
    pub corners: [Corner; 3],
    edges: [Edge; 3],
    /// Twice the area in pixels, negative if the corners go round against the clock.
    twice_area: f64,
}

impl Triangle {
    /// `None` when it has no area.
    pub fn new(corners: &[Corner; 3]) -> Option<Self> {
        let [a, b, c] = corners.map(|corner| corner.position);
        let [[bx, by], [cx, cy]] =
            [b, c].map(|to| [0, 1].map(|axis| i64::from(to[axis]) - i64::from(a[axis])));
        let twice = bx * cy - cx * by;
        let edges = match twice {
            0 => return None,
            1.. => [Edge::new(a, b), Edge::new(b, c), Edge::new(c, a)],
            _ => [Edge::new(a, c), Edge::new(c, b), Edge::new(b, a)],
        };
        Some(Self {
            corners: *corners,
            edges,
            twice_area: twice as f64 / f64::from(STEPS * STEPS),
        })
    }

    /// The value that goes linearly from corner to corner.
    fn plane(&self, value: impl Fn(&Corner) -> f32) -> Plane {
        let [a, b, c] = self
            .corners
            .map(|corner| corner.position.map(|c| f64::from(c) / f64::from(STEPS)));
        let [va, vb, vc] = self.corners.map(|corner| f64::from(value(&corner)));
        let (b, c) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
        let (vb, vc) = (vb - va, vc - va);
        let dx = (vb * c[1] - vc * b[1]) / self.twice_area;
        let dy = (vc * b[0] - vb * c[0]) / self.twice_area;
        Plane {
            origin: va - a[0] * dx - a[1] * dy,
            dx,
            dy,
        }
    }

    /// The texture coordinates.
    pub fn texel(&self) -> [Plane; 2] {
        std::array::from_fn(|axis| self.plane(|c| c.texel[axis]))
    }

    /// The channels of the tint.
    pub fn tint(&self) -> [Plane; 4] {
        std::array::from_fn(|channel| self.plane(|c| f32::from(c.tint.to_array()[channel])))
    }

    /// Calls `draw` with the spans of pixels (row, first, after the last) that are in the triangle
    /// and an area.
    pub fn rows(&self, area: Area, mut draw: impl FnMut(i32, i32, i32)) {
        let area = area.intersect(bounds(&self.corners));
        for y in area.y0..area.y1 {
            let (x0, x1) = self
                .edges
                .iter()
                .fold((area.x0, area.x1), |span, edge| edge.narrow(span, y));
            if x0 < x1 {
                draw(y, x0, x1);
            }
        }
    }
}

/// An edge of a triangle: the inside is where `constant − slope·x + along·y` ≥ 0, with x and y in
/// steps.
struct Edge {
    along: i64,
    slope: i64,
    constant: i64,
}

impl Edge {
    /// Makes the edge from `from` to `to` with the inside on the right hand (the y axis points
    /// down).
    fn new(from: [i32; 2], to: [i32; 2]) -> Self {
        let [ax, ay] = from.map(i64::from);
        let [bx, by] = to.map(i64::from);
        let (along, slope) = (bx - ax, by - ay);
        let is_top_or_left = slope < 0 || (slope == 0 && along > 0);
        Self {
            along,
            slope,
            constant: slope * ax - along * ay - i64::from(!is_top_or_left),
        }
    }

    /// Part of a span of pixels in row `y` that is inside.
    fn narrow(&self, (x0, x1): (i32, i32), y: i32) -> (i32, i32) {
        let centre = i64::from(y) * i64::from(STEPS) + i64::from(STEPS) / 2;
        let value = self.constant + self.along * centre;
        match self.slope {
            0 if value >= 0 => (x0, x1),
            0 => (x0, x0),
            slope if slope > 0 => {
                // x ≤ ⌊value / slope⌋
                let end = first_pixel(value.div_euclid(slope) + 1);
                (x0, x1.min(end))
            }
            slope => {
                // x ≥ ⌈value / slope⌉ = −⌊value / −slope⌋
                let start = first_pixel(-value.div_euclid(-slope));
                (x0.max(start), x1)
            }
        }
    }
}

/// The pixels that a triangle may cover.
pub fn bounds(corners: &[Corner; 3]) -> Area {
    let ends: [[i32; 2]; 2] = std::array::from_fn(|axis| {
        let [a, b, c] = corners.map(|corner| corner.position[axis]);
        // A centre on the last edge may belong to the triangle only if that is a top or left edge.
        let [first, last] = [a.min(b).min(c), a.max(b).max(c)].map(i64::from);
        [first_pixel(first), first_pixel(last + 1)]
    });
    let [[x0, x1], [y0, y1]] = ends;
    Area { x0, y0, x1, y1 }
}

/// The least and the greatest texture coordinates at some corners.
pub fn texels(corners: &[Corner]) -> [[f32; 2]; 2] {
    let [mut least, mut most] = [[f32::INFINITY; 2], [f32::NEG_INFINITY; 2]];
    for corner in corners {
        for (axis, at) in corner.texel.into_iter().enumerate() {
            // No corner is NaN. As wasm, `f32::min` is a call, comparisons are not.
            if at < least[axis] {
                least[axis] = at;
            }
            if at > most[axis] {
                most[axis] = at;
            }
        }
    }
    [least, most]
}

/// The texels that a shape shows.
pub struct Showing {
    /// The least and the greatest texture coordinates of the whole shape.
    all: [[f32; 2]; 2],
    /// The texture coordinates at each pixel; none for a triangle with one texel or without an
    /// area.
    at: Option<[Plane; 2]>,
}

impl Showing {
    /// The texels that a triangle shows.
    pub fn triangle(corners: &[Corner; 3]) -> Self {
        let [a, b, c] = corners.map(|corner| corner.texel);
        Self {
            all: texels(corners),
            at: (a != b || a != c)
                .then(|| Triangle::new(corners))
                .flatten()
                .map(|triangle| triangle.texel()),
        }
    }

    /// The texels that a rectangle shows.
    pub fn quad(quad: &Quad) -> Self {
        let [a, d] = quad.corners;
        let other = Corner {
            position: [d.position[0], a.position[1]],
            texel: [d.texel[0], a.texel[1]],
            tint: a.tint,
        };
        Self::triangle(&[a, other, d])
    }

    /// The rectangle of texels (from, to) seen in an area of pixels.
    pub fn within(&self, area: Area) -> [[f32; 2]; 2] {
        let [least, most] = self.all;
        let Some(at) = self.at else {
            return self.all;
        };
        let ends = at.map(|plane| {
            let corners = [
                plane.at(area.x0, area.y0),
                plane.at(area.x1 - 1, area.y0),
                plane.at(area.x0, area.y1 - 1),
                plane.at(area.x1 - 1, area.y1 - 1),
            ];
            // A little more on each side, for rounding.
            let slack = 0.25 / STEPS as f32;
            [
                corners.into_iter().fold(f32::INFINITY, f32::min) - slack,
                corners.into_iter().fold(f32::NEG_INFINITY, f32::max) + slack,
            ]
        });
        [
            [0, 1].map(|axis| ends[axis][0].max(least[axis]).min(most[axis])),
            [0, 1].map(|axis| ends[axis][1].min(most[axis]).max(least[axis])),
        ]
    }
}
