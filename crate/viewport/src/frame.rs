//! The image: triangles, the wireframe, the tool and its shadow, with the depth of each pixel.

use crate::shadow::Shadow;
use crate::surface::Surface;
use crate::view::{NEAR, View};
use glam::{DVec3, Mat3, Vec3};

/// The light, the colours, and the things that are drawn besides the mesh.
#[derive(Clone, Debug)]
pub struct Look<'a> {
    /// The direction towards the light, in coordinates of the mesh.
    pub light: Vec3,
    /// Whether the edges are drawn.
    pub wireframe: bool,
    /// The colour of the background, 0 … 1.
    pub background: [f32; 3],
    /// Colour of the edges.
    pub edge: [f32; 3],
    /// Colour that chosen triangles and the tool take.
    pub accent: [f32; 3],
    /// The tool about the origin, and the places where it and its mirror images stand.
    pub tool: Option<(&'a Surface, &'a [Vec3])>,
    /// Planes of symmetry: the axis across, and half a side.
    pub planes: &'a [(usize, f32)],
}

impl Default for Look<'_> {
    fn default() -> Self {
        Self {
            light: Vec3::new(0.4, -0.5, 0.8),
            wireframe: false,
            background: [0.09, 0.1, 0.12],
            edge: [0.05, 0.06, 0.08],
            accent: [0.25, 0.62, 0.95],
            tool: None,
            planes: &[],
        }
    }
}

/// The surface at a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    /// The point.
    pub point: DVec3,
    /// The smooth normal there, of length 1.
    pub normal: DVec3,
    /// The triangle's index.
    pub triangle: usize,
}

/// An image that is drawn again and again.
#[derive(Clone, Debug, Default)]
pub struct Frame {
    size: [usize; 2],
    rgba: Vec<u8>,
    /// The reciprocal of the depth of each pixel; 0 where nothing is.
    near: Vec<f32>,
    /// The triangle of each pixel.
    owner: Vec<u32>,
    corners: Vec<Corner>,
}

/// A vertex in the image.
#[derive(Clone, Copy, Debug, Default)]
struct Corner {
    x: f32,
    y: f32,
    /// The reciprocal of the depth; 0 behind the eye.
    near: f32,
    front: [f32; 3],
    back: [f32; 3],
}

const NOTHING: u32 = u32::MAX;

impl Frame {
    /// An empty image of at least one pixel.
    #[must_use]
    pub fn new(size: [usize; 2]) -> Self {
        let mut frame = Self::default();
        frame.resize(size);
        frame
    }

    /// Returns width and height in pixels.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Red, green, blue and opacity of each pixel, row by row.
    #[must_use]
    pub fn rgba(&self) -> &[u8] {
        &self.rgba
    }

    /// Takes another size; what was drawn is lost.
    pub fn resize(&mut self, size: [usize; 2]) {
        let size = size.map(|side| side.clamp(1, 4096));
        if self.size != size {
            self.size = size;
            let pixels = size[0] * size[1];
            self.rgba = vec![255; 4 * pixels];
            self.near = vec![0.0; pixels];
            self.owner = vec![NOTHING; pixels];
        }
    }

    /// Draws a surface.
    pub fn draw(&mut self, view: &View, surface: &Surface, look: &Look<'_>) {
        self.clear(look);
        let camera = Camera::new(view, self.size);
        self.place_corners(&camera, surface, look);
        for (index, triangle) in surface.triangles.iter().enumerate() {
            let is_chosen = surface.chosen.get(index) == Some(&true);
            self.fill(index as u32, triangle, surface.is_closed, is_chosen, look);
        }
        if let Some((tool, places)) = look.tool {
            for place in places {
                let shadow = Shadow::of(tool, *place, look.light);
                self.darken(&camera, &shadow);
            }
        }
        if look.wireframe {
            for [a, b] in &surface.edges {
                let ends = [a, b].map(|i| self.corners[*i as usize]);
                self.line(ends, look.edge, 0.55);
            }
        }
        for (axis, half) in look.planes {
            self.plane(&camera, *axis, *half, look.accent);
        }
        if let Some((tool, places)) = look.tool {
            for place in places {
                self.glass(&camera, tool, *place, look);
            }
        }
    }

    /// The surface at a pixel, as it was drawn last; `None` where nothing is.
    #[must_use]
    pub fn pick(&self, view: &View, surface: &Surface, pixel: [f64; 2]) -> Option<Found> {
        let [x, y] = pixel.map(f64::floor);
        let [w, h] = self.size;
        if !(x >= 0.0 && y >= 0.0 && x < w as f64 && y < h as f64) {
            return None;
        }
        let at = y as usize * w + x as usize;
        if self.owner[at] == NOTHING || self.near[at] <= 0.0 {
            return None;
        }
        let triangle = self.owner[at] as usize;
        let corners = *surface.triangles.get(triangle)?;
        let point = view.point(pixel, 1.0 / f64::from(self.near[at]), self.size);
        let [a, b, c] = corners.map(|i| surface.positions[i as usize].as_dvec3());
        let shares = shares(point, [a, b, c]);
        let normals = corners.map(|i| surface.normals[i as usize].as_dvec3());
        let sum: DVec3 = normals.iter().zip(shares).map(|(n, s)| *n * s).sum();
        let flat = (b - a).cross(c - a).normalize_or(DVec3::Z);
        let mut normal = sum.normalize_or(flat);
        if normal.dot(view.eye() - point) < 0.0 && !surface.is_closed {
            normal = -normal;
        }
        Some(Found {
            point,
            normal,
            triangle,
        })
    }

    fn clear(&mut self, look: &Look<'_>) {
        let [w, h] = self.size;
        for (y, row) in self.rgba.chunks_exact_mut(4 * w).enumerate() {
            // A little lighter above.
            let t = 1.16 - 0.3 * y as f32 / h as f32;
            let color = look.background.map(|c| byte(255.0 * c * t));
            let pixel = [color[0], color[1], color[2], 255];
            for out in row.as_chunks_mut::<4>().0 {
                *out = pixel;
            }
        }
        self.near.fill(0.0);
        self.owner.fill(NOTHING);
    }

    fn place_corners(&mut self, camera: &Camera, surface: &Surface, look: &Look<'_>) {
        let light = look.light.normalize_or(Vec3::Z);
        let white = [0.75; 3];
        self.corners.clear();
        let all = surface.positions.iter().zip(&surface.normals).enumerate();
        self.corners.extend(all.map(|(i, (p, n))| {
            let base = surface.colors.get(i).copied().unwrap_or(white);
            let [x, y, near] = camera.place(*p);
            let eye = (camera.eye - *p).normalize_or(Vec3::Z);
            Corner {
                x,
                y,
                near,
                front: shade(base, *n, light, eye, camera.up),
                back: shade(base.map(|c| 0.45 * c), -*n, light, eye, camera.up),
            }
        }));
    }

    fn fill(
        &mut self,
        index: u32,
        corners: &[u32; 3],
        culls: bool,
        is_chosen: bool,
        look: &Look<'_>,
    ) {
        let [a, b, c] = corners.map(|i| self.corners[i as usize]);
        if a.near <= 0.0 || b.near <= 0.0 || c.near <= 0.0 {
            return;
        }
        // Counter-clockwise on the page is clockwise where y points down.
        let area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        let is_front = area < 0.0;
        if area.abs() < 1e-9 || (culls && !is_front) {
            return;
        }
        let colors = [a, b, c].map(|v| if is_front { v.front } else { v.back });
        let colors = match is_chosen {
            true => colors.map(|color| mix(color, look.accent.map(|c| 255.0 * c), 0.42)),
            false => colors,
        };
        let [w, h] = self.size;
        let (Some(xs), Some(ys)) = (span([a.x, b.x, c.x], w), span([a.y, b.y, c.y], h)) else {
            return;
        };
        let inverse = 1.0 / area;
        // The shares of a and b grow linearly; c has the rest.
        let (ux, uy) = ((b.y - c.y) * inverse, (c.x - b.x) * inverse);
        let (vx, vy) = ((c.y - a.y) * inverse, (a.x - c.x) * inverse);
        for y in ys {
            let (dx, dy) = (xs.start as f32 + 0.5 - c.x, y as f32 + 0.5 - c.y);
            let (mut u, mut v) = (ux * dx + uy * dy, vx * dx + vy * dy);
            for i in y * w + xs.start..y * w + xs.end {
                let t = 1.0 - u - v;
                if u >= 0.0 && v >= 0.0 && t >= 0.0 {
                    let near = u * a.near + v * b.near + t * c.near;
                    if near > self.near[i] {
                        self.near[i] = near;
                        self.owner[i] = index;
                        let color: [f32; 3] = core::array::from_fn(|k| {
                            u * colors[0][k] + v * colors[1][k] + t * colors[2][k]
                        });
                        let out = &mut self.rgba[4 * i..4 * i + 3];
                        out.copy_from_slice(&color.map(byte));
                    }
                }
                u += ux;
                v += vx;
            }
        }
    }

    /// Darkens the pixels in a shadow.
    fn darken(&mut self, camera: &Camera, shadow: &Shadow) {
        let w = self.size[0];
        for (i, near) in self.near.iter().enumerate() {
            if *near <= 0.0 {
                continue;
            }
            let point = camera.point([(i % w) as f32 + 0.5, (i / w) as f32 + 0.5], 1.0 / near);
            let dark = shadow.at(point);
            if dark > 0.0 {
                for channel in &mut self.rgba[4 * i..4 * i + 3] {
                    *channel = (f32::from(*channel) * (1.0 - 0.5 * dark)) as u8;
                }
            }
        }
    }

    fn line(&mut self, [a, b]: [Corner; 2], color: [f32; 3], share: f32) {
        if a.near <= 0.0 || b.near <= 0.0 {
            return;
        }
        let [w, h] = self.size.map(|side| side as f32);
        let is_outside = [(a.x, b.x, w), (a.y, b.y, h)]
            .iter()
            .any(|(p, q, side)| p.max(*q) < 0.0 || p.min(*q) >= *side);
        if is_outside {
            return;
        }
        let steps = (b.x - a.x)
            .abs()
            .max((b.y - a.y).abs())
            .ceil()
            .clamp(1.0, 8192.0);
        for i in 0..=steps as u32 {
            let t = i as f32 / steps;
            let (x, y) = (a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t);
            if !(x >= 0.0 && y >= 0.0 && x < w && y < h) {
                continue;
            }
            let at = y as usize * self.size[0] + x as usize;
            let near = a.near + (b.near - a.near) * t;
            if near * 1.002 >= self.near[at] {
                self.blend(at, color, share);
            }
        }
    }

    fn blend(&mut self, at: usize, color: [f32; 3], share: f32) {
        for (out, c) in self.rgba[4 * at..4 * at + 3].iter_mut().zip(color) {
            let old = f32::from(*out);
            *out = byte(old + (255.0 * c - old) * share);
        }
    }

    /// A plane of symmetry: faint, with an edge.
    fn plane(&mut self, camera: &Camera, axis: usize, half: f32, color: [f32; 3]) {
        let mut ends = [Vec3::ZERO; 4];
        for (end, [s, t]) in
            ends.iter_mut()
                .zip([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
        {
            end[(axis + 1) % 3] = half * s;
            end[(axis + 2) % 3] = half * t;
        }
        let corners = ends.map(|p| {
            let [x, y, near] = camera.place(p);
            Corner {
                x,
                y,
                near,
                ..Corner::default()
            }
        });
        self.veil([corners[0], corners[1], corners[2]], color, [0.1, 0.02]);
        self.veil([corners[0], corners[2], corners[3]], color, [0.1, 0.02]);
        for i in 0..4 {
            self.line([corners[i], corners[(i + 1) % 4]], color, 0.5);
        }
    }

    /// The tool, which can be seen through: more so where it is behind the mesh.
    fn glass(&mut self, camera: &Camera, tool: &Surface, place: Vec3, look: &Look<'_>) {
        let vertices = tool.positions.iter().zip(&tool.normals);
        let corners: Vec<Corner> = vertices
            .map(|(p, n)| {
                let [x, y, near] = camera.place(*p + place);
                let eye = (camera.eye - *p - place).normalize_or(Vec3::Z);
                let rim = 1.0 - n.dot(eye).abs();
                Corner {
                    x,
                    y,
                    near,
                    front: [rim; 3],
                    ..Corner::default()
                }
            })
            .collect();
        for triangle in &tool.triangles {
            let [a, b, c] = triangle.map(|i| corners[i as usize]);
            let area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
            if area < 0.0 {
                // Denser at its rim, as a bubble is.
                let rim = (a.front[0] + b.front[0] + c.front[0]) / 3.0;
                let share = 0.14 + 0.5 * rim * rim;
                self.veil([a, b, c], look.accent, [share, 0.35 * share]);
            }
        }
    }

    /// Mixes a colour into the pixels of a triangle: by one share in front of what was drawn, by
    /// another behind it.
    fn veil(&mut self, [a, b, c]: [Corner; 3], color: [f32; 3], shares: [f32; 2]) {
        let area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        if a.near <= 0.0 || b.near <= 0.0 || c.near <= 0.0 || area.abs() < 1e-9 {
            return;
        }
        let [w, h] = self.size;
        let (Some(xs), Some(ys)) = (span([a.x, b.x, c.x], w), span([a.y, b.y, c.y], h)) else {
            return;
        };
        let inverse = 1.0 / area;
        for y in ys {
            for x in xs.clone() {
                let (dx, dy) = (x as f32 + 0.5 - c.x, y as f32 + 0.5 - c.y);
                let u = ((b.y - c.y) * dx + (c.x - b.x) * dy) * inverse;
                let v = ((c.y - a.y) * dx + (a.x - c.x) * dy) * inverse;
                let t = 1.0 - u - v;
                // Half-open, so that no pixel on an edge is taken twice.
                if u >= 0.0 && v >= 0.0 && t > 0.0 {
                    let near = u * a.near + v * b.near + t * c.near;
                    let at = y * w + x;
                    let is_behind = near < self.near[at];
                    self.blend(at, color, shares[usize::from(is_behind)]);
                }
            }
        }
    }
}

/// A camera ready to place points.
struct Camera {
    axes: Mat3,
    eye: Vec3,
    up: Vec3,
    focal: f32,
    middle: [f32; 2],
    nearest: f32,
}

impl Camera {
    fn new(view: &View, size: [usize; 2]) -> Self {
        let [right, up, back] = view.axes().map(|axis| axis.as_vec3());
        Self {
            axes: Mat3::from_cols(right, up, back).transpose(),
            eye: view.eye().as_vec3(),
            up: (up + 0.3 * back).normalize_or(up),
            focal: view.focal(size) as f32,
            middle: size.map(|side| 0.5 * side as f32),
            nearest: (NEAR * view.distance) as f32,
        }
    }

    /// Pixel, and one over the depth; 0 behind the eye.
    fn place(&self, p: Vec3) -> [f32; 3] {
        let local = self.axes * (p - self.eye);
        let depth = -local.z;
        if depth < self.nearest {
            return [0.0; 3];
        }
        let near = 1.0 / depth;
        let scale = self.focal * near;
        [
            self.middle[0] + local.x * scale,
            self.middle[1] - local.y * scale,
            near,
        ]
    }

    fn point(&self, [x, y]: [f32; 2], depth: f32) -> Vec3 {
        let scale = depth / self.focal;
        let local = Vec3::new(
            (x - self.middle[0]) * scale,
            (self.middle[1] - y) * scale,
            -depth,
        );
        self.eye + self.axes.transpose() * local
    }
}

/// The colour of clay, 0 … 255: a light, the sky above, and a faint gloss.
fn shade(base: [f32; 3], normal: Vec3, light: Vec3, eye: Vec3, up: Vec3) -> [f32; 3] {
    let direct = normal.dot(light).max(0.0);
    let sky = 0.5 + 0.5 * normal.dot(up);
    let facing = normal.dot(eye).max(0.0);
    let half = (light + eye).normalize_or(eye);
    let gloss = normal.dot(half).max(0.0);
    let gloss = {
        let square = gloss * gloss;
        let fourth = square * square;
        fourth * fourth * fourth * fourth
    };
    let lit = 0.16 + 0.3 * sky + 0.14 * facing + 0.62 * direct;
    base.map(|c| 255.0 * (c * lit + 0.1 * gloss * direct))
}

fn mix(a: [f32; 3], b: [f32; 3], share: f32) -> [f32; 3] {
    core::array::from_fn(|k| a[k] + (b[k] - a[k]) * share)
}

/// Rounds a value to a channel, 0 … 255.
fn byte(value: f32) -> u8 {
    (value + 0.5) as u8
}

/// The pixels whose middles may lie between three coordinates; `None` if there are none.
fn span(values: [f32; 3], most: usize) -> Option<core::ops::Range<usize>> {
    let low = values[0].min(values[1]).min(values[2]) - 0.5;
    let high = values[0].max(values[1]).max(values[2]) + 0.5;
    if high.is_nan() || high <= 0.0 || low >= most as f32 {
        return None;
    }
    let start = low.max(0.0) as usize;
    let end = (high.ceil() as usize).min(most);
    (start < end).then_some(start..end)
}

/// Barycentric coordinates of a point in the plane of a triangle.
fn shares(p: DVec3, [a, b, c]: [DVec3; 3]) -> [f64; 3] {
    let (u, v, w) = (b - a, c - a, p - a);
    let (uu, uv, vv) = (u.dot(u), u.dot(v), v.dot(v));
    let (wu, wv) = (w.dot(u), w.dot(v));
    let d = uu * vv - uv * uv;
    if d <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let s = ((vv * wu - uv * wv) / d).clamp(0.0, 1.0);
    let t = ((uu * wv - uv * wu) / d).clamp(0.0, 1.0);
    [(1.0 - s - t).max(0.0), s, t]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ball of triangles.
    fn ball(n: usize) -> Surface {
        let mut surface = Surface {
            is_closed: true,
            ..Surface::default()
        };
        let pi = core::f32::consts::PI;
        for i in 0..=n {
            for j in 0..2 * n {
                let (a, b) = (pi * i as f32 / n as f32, pi * j as f32 / n as f32);
                let p = Vec3::new(
                    libm::sinf(a) * libm::cosf(b),
                    libm::sinf(a) * libm::sinf(b),
                    libm::cosf(a),
                );
                surface.positions.push(p);
            }
        }
        let at = |i: usize, j: usize| (i * 2 * n + j % (2 * n)) as u32;
        for i in 0..n {
            for j in 0..2 * n {
                surface
                    .triangles
                    .push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
                surface
                    .triangles
                    .push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
            }
        }
        surface.normals = surface.positions.clone();
        surface
    }

    #[test]
    fn points_of_a_ball_are_found_where_rays_meet_it() {
        let surface = ball(48);
        let mut view = View::around([DVec3::splat(-1.0), DVec3::ONE]);
        view.turn([0.0, 0.0], [0.3, -0.4]);
        let size = [200, 160];
        let mut frame = Frame::new(size);
        frame.draw(&view, &surface, &Look::default());
        let eye = view.eye();
        let mut hits = 0;
        for y in 0..size[1] {
            for x in 0..size[0] {
                let pixel = [x as f64 + 0.5, y as f64 + 0.5];
                let way = (view.point(pixel, 1.0, size) - eye).normalize();
                let b = way.dot(eye);
                let discriminant = b * b - (eye.length_squared() - 1.0);
                let found = frame.pick(&view, &surface, pixel);
                if discriminant > 0.02 {
                    let expected = eye + way * (-b - discriminant.sqrt());
                    let found = found.expect("the ball is there");
                    assert!(found.point.distance(expected) < 0.02, "{pixel:?}");
                    assert!(found.normal.dot(expected) > 0.995);
                    hits += 1;
                } else if discriminant < -0.02 {
                    assert!(found.is_none(), "{pixel:?}");
                }
            }
        }
        assert!(hits > 3000, "{hits}");
    }

    #[test]
    fn the_nearer_triangle_hides_the_other_whatever_their_order() {
        let mut pictures = Vec::new();
        for order in [[0.0, 0.5], [0.5, 0.0]] {
            let mut surface = Surface::default();
            for (k, z) in order.into_iter().enumerate() {
                let color = if z > 0.2 {
                    [1.0, 0.0, 0.0]
                } else {
                    [0.0, 1.0, 0.0]
                };
                let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
                surface
                    .positions
                    .extend(corners.map(|[x, y]| Vec3::new(x, y, z)));
                surface.colors.extend([color; 4]);
                let triangles = [[0, 1, 2], [0, 2, 3]];
                surface
                    .triangles
                    .extend(triangles.map(|triangle| triangle.map(|i: u32| 4 * k as u32 + i)));
            }
            surface.smooth();
            let mut view = View::around([DVec3::splat(-1.0), DVec3::ONE]);
            view.look_from(DVec3::Z, DVec3::Y);
            let mut frame = Frame::new([40, 40]);
            frame.draw(&view, &surface, &Look::default());
            let middle = &frame.rgba()[4 * (20 * 40 + 20)..][..3];
            assert!(middle[0] > 100 && middle[1] < 60, "{middle:?}");
            pictures.push(frame.rgba().to_vec());
        }
        assert_eq!(pictures[0], pictures[1]);
    }

    #[test]
    fn tool_and_its_shadow_change_the_picture_and_edges_do() {
        let surface = ball(24);
        let view = View::around([DVec3::splat(-1.0), DVec3::ONE]);
        let mut frame = Frame::new([120, 120]);
        let plain = Look::default();
        frame.draw(&view, &surface, &plain);
        let bare = frame.rgba().to_vec();
        let mut small = ball(8);
        for p in &mut small.positions {
            *p *= 0.2;
        }
        let places = [plain.light.normalize() * 1.8];
        let look = Look {
            tool: Some((&small, &places)),
            ..plain.clone()
        };
        frame.draw(&view, &surface, &look);
        let with_tool = frame.rgba().to_vec();
        // In the middle of its shadow it is darker.
        let pixel = view
            .project(plain.light.normalize().as_dvec3(), [120, 120])
            .unwrap();
        let at = 4 * (pixel[1] as usize * 120 + pixel[0] as usize);
        assert!(f32::from(with_tool[at]) < 0.7 * f32::from(bare[at]));
        let mut edged = surface.clone();
        edged.edges = surface.triangles.iter().map(|t| [t[0], t[1]]).collect();
        let look = Look {
            wireframe: true,
            planes: &[(1, 1.3)],
            ..plain
        };
        frame.draw(&view, &edged, &look);
        assert_ne!(frame.rgba(), bare);
    }

    #[test]
    fn no_place_and_no_number_panics() {
        let mut surface = ball(6);
        surface.positions[3] = Vec3::splat(f32::NAN);
        surface.positions[9] = Vec3::splat(1e30);
        surface.positions[11] = Vec3::splat(f32::INFINITY);
        surface.edges = surface.triangles.iter().map(|t| [t[0], t[1]]).collect();
        let mut view = View::around([DVec3::splat(-1.0), DVec3::ONE]);
        let look = Look {
            wireframe: true,
            planes: &[(0, 1.0)],
            ..Look::default()
        };
        for factor in [1.0, 3.0, 10.0, 1e6, f64::NAN, 1e-9, -1.0] {
            view.zoom(factor);
            let mut frame = Frame::new([33, 17]);
            frame.draw(&view, &surface, &look);
            for pixel in [[-1.0, 3.0], [f64::NAN, 0.0], [16.0, 8.0], [1e9, 1e9]] {
                let _ = frame.pick(&view, &surface, pixel);
            }
        }
        Frame::new([0, 0]).draw(&view, &Surface::default(), &Look::default());
    }
}
