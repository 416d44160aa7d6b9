//! Fills triangles and rectangles with colours and pictures, as egui's shader does on a GPU.

use std::ops::Range;

use egui::Color32;

use crate::{
    shape::{Area, Corner, Quad, STEPS, Triangle, bounds},
    texture::{Tap, Texture, interpolate},
};

/// A picture being drawn on: red, green, blue, alpha in rows from the top.
#[derive(Debug, Default)]
pub struct Sheet {
    width: usize,
    height: usize,
    pixels: Vec<[u8; 4]>,
    /// Kept to save allocations.
    columns: Columns,
}

/// The columns of pixels of a shape whose rows are rows of its texture.
#[derive(Debug, Default)]
struct Columns {
    /// The place of each in the texture.
    taps: Vec<Tap>,
    /// Whether each shows one texel.
    exact: bool,
    /// Whether they follow each other as the texels do.
    ordered: bool,
    /// The weight of each column's second texel, 0 … 256, once for each channel.
    weights: Vec<[u16; 4]>,
    /// The channels of the texels at the present row, see [`Texture::between`].
    between: Vec<u16>,
    /// The first texel of each column at the present row.
    near: Vec<[u16; 4]>,
    /// The second texel of each column at the present row.
    far: Vec<[u16; 4]>,
    /// The colours of the columns at the present row.
    colors: Vec<[u8; 4]>,
}

impl Sheet {
    /// A sheet of undefined content.
    pub fn new(width: usize, height: usize) -> Self {
        Self {
            width,
            height,
            pixels: vec![[0; 4]; width * height],
            columns: Columns::default(),
        }
    }

    /// Width and height.
    pub fn size(&self) -> [usize; 2] {
        [self.width, self.height]
    }

    /// The area of all pixels.
    pub fn area(&self) -> Area {
        Area {
            x0: 0,
            y0: 0,
            x1: self.width as i32,
            y1: self.height as i32,
        }
    }

    /// The bytes of all pixels.
    pub fn bytes(&self) -> &[u8] {
        self.pixels.as_flattened()
    }

    /// Sets the pixels of an area.
    pub fn clear(&mut self, area: Area, color: Color32) {
        let area = area.intersect(self.area());
        for y in area.y0..area.y1 {
            self.span(y, area.x0, area.x1).fill(color.to_array());
        }
    }

    /// The pixels x0 ≤ x < x1 of a row; they must lie within the sheet.
    fn span(&mut self, y: i32, x0: i32, x1: i32) -> &mut [[u8; 4]] {
        let row = y as usize * self.width;
        &mut self.pixels[row + x0 as usize..row + x1 as usize]
    }

    /// Draws the part of a rectangle that lies in an area.
    pub fn quad(&mut self, quad: &Quad, texture: &Texture, area: Area) {
        let area = area.intersect(quad.area()).intersect(self.area());
        if area.is_empty() {
            return;
        }
        let tint = quad.corners()[0].tint.to_array();
        let smooth = texture.is_smooth(quad.scale(0).abs().max(quad.scale(1).abs()));
        let mut columns = self.columns(
            (area.x0..area.x1).map(|x| quad.texel(0, x)),
            texture,
            smooth,
        );
        for y in area.y0..area.y1 {
            let row = texture.tap(1, quad.texel(1, y), smooth);
            let span = self.span(y, area.x0, area.x1);
            columns.copy(0, span, row, texture, tint);
        }
        self.columns = columns;
    }

    /// Finds the places of the columns of pixels with these texture coordinates in a texture. They
    /// take the room of `self.columns`, to be put back there after use.
    fn columns(
        &mut self,
        coordinates: impl Iterator<Item = f32>,
        texture: &Texture,
        smooth: bool,
    ) -> Columns {
        let mut columns = std::mem::take(&mut self.columns);
        let taps = &mut columns.taps;
        taps.clear();
        taps.extend(coordinates.map(|at| texture.tap(0, at, smooth)));
        columns.exact = taps.iter().all(|tap| tap.weight == 0);
        columns.ordered = taps
            .windows(2)
            .all(|pair| pair[0].near <= pair[1].near && pair[0].far <= pair[1].far);
        columns.weights.clear();
        columns
            .weights
            .extend(taps.iter().map(|tap| [tap.weight as u16; 4]));
        columns
    }

    /// Draws the part of a triangle that lies in an area.
    pub fn triangle(&mut self, corners: &[Corner; 3], texture: &Texture, area: Area) {
        let area = area.intersect(self.area());
        let Some(triangle) = Triangle::new(corners) else {
            return;
        };
        let [a, b, c] = corners;
        if a.texel != b.texel || a.texel != c.texel {
            self.picture(&triangle, texture, area);
            return;
        }
        // Shapes without a picture show one white texel everywhere.
        let smooth = texture.is_smooth(0.0);
        let texel = texture.sample(
            texture.tap(0, a.texel[0], smooth),
            texture.tap(1, a.texel[1], smooth),
        );
        if a.tint == b.tint && a.tint == c.tint {
            self.solid(&triangle, tint_texel(texel, a.tint.to_array()), area);
        } else {
            self.shade(&triangle, texel, area);
        }
    }

    /// Fills a triangle with one colour.
    fn solid(&mut self, triangle: &Triangle, color: [u8; 4], area: Area) {
        triangle.rows(area, |y, x0, x1| {
            let span = self.span(y, x0, x1);
            if color[3] == 255 {
                span.fill(color);
            } else {
                span.iter_mut().for_each(|pixel| blend(pixel, color));
            }
        });
    }

    /// Fills a triangle with a texel and a tint that changes.
    fn shade(&mut self, triangle: &Triangle, texel: [u8; 4], area: Area) {
        let tint = triangle.tint();
        let factor = texel.map(|channel| f32::from(channel) / 255.0);
        let step: [f32; 4] = std::array::from_fn(|c| tint[c].dx as f32 * factor[c]);
        triangle.rows(area, |y, x0, x1| {
            let start: [f32; 4] = std::array::from_fn(|c| tint[c].at(x0, y) * factor[c]);
            for (i, pixel) in self.span(y, x0, x1).iter_mut().enumerate() {
                let i = i as f32;
                blend_exact(pixel, std::array::from_fn(|c| start[c] + i * step[c]));
            }
        });
    }

    /// Fills a triangle with a part of a picture and a tint.
    fn picture(&mut self, triangle: &Triangle, texture: &Texture, area: Area) {
        let area = area.intersect(bounds(&triangle.corners));
        let texel = triangle.texel();
        let [right, down] = [texel.map(|plane| plane.dx), texel.map(|plane| plane.dy)]
            .map(|[u, v]| (u * u + v * v).sqrt());
        let smooth = texture.is_smooth(right.max(down) as f32);
        let [a, b, c] = triangle.corners.map(|corner| corner.tint);
        let turned = (texel[0].dy * f64::from(area.y1 - area.y0)).abs()
            + (texel[1].dx * f64::from(area.x1 - area.x0)).abs();
        if a == b && a == c && turned * f64::from(STEPS) < 1.0 {
            // The inside of a picture with round corners: its rows are rows of the texture.
            let across = (area.x0..area.x1).map(|x| texel[0].at(x, area.y0));
            let mut columns = self.columns(across, texture, smooth);
            triangle.rows(area, |y, x0, x1| {
                let row = texture.tap(1, texel[1].at(area.x0, y), smooth);
                let first = (x0 - area.x0) as usize;
                columns.copy(first, self.span(y, x0, x1), row, texture, a.to_array());
            });
            self.columns = columns;
            return;
        }
        let tint = triangle.tint();
        let step = tint.map(|plane| plane.dx as f32);
        triangle.rows(area, |y, x0, x1| {
            let start = tint.map(|plane| plane.at(x0, y));
            for (i, pixel) in self.span(y, x0, x1).iter_mut().enumerate() {
                let [u, v] = texel.map(|plane| plane.at(x0 + i as i32, y));
                let color = texture.sample(texture.tap(0, u, smooth), texture.tap(1, v, smooth));
                let i = i as f32;
                blend_exact(
                    pixel,
                    std::array::from_fn(|c| (start[c] + i * step[c]) * f32::from(color[c]) / 255.0),
                );
            }
        });
    }
}

impl Columns {
    /// The range from the first to the last texel that some columns show.
    fn texels(&self, taps: &[Tap]) -> Range<usize> {
        if let ([first, ..], [.., last], true) = (taps, taps, self.ordered) {
            return first.ends()[0]..last.ends()[1] + 1;
        }
        let ends = taps.iter().map(Tap::ends);
        let first = ends.clone().map(|ends| ends[0]).min().unwrap_or(0);
        first..ends.map(|ends| ends[1]).max().unwrap_or(0) + 1
    }

    /// Draws a row of pixels, the first of which is in the column of this number.
    fn copy(
        &mut self,
        first: usize,
        span: &mut [[u8; 4]],
        row: Tap,
        texture: &Texture,
        tint: [u8; 4],
    ) {
        let taps = &self.taps[first..first + span.len()];
        if self.exact && row.weight == 0 {
            // Texels on pixels, as nearly all text is.
            let texels = texture.row(row.near);
            for (pixel, column) in span.iter_mut().zip(taps) {
                blend(pixel, tint_texel(texels[column.near], tint));
            }
            return;
        }
        let seen = self.texels(taps);
        if seen.len() > 2 * span.len() {
            for (pixel, &column) in span.iter_mut().zip(taps) {
                blend(pixel, tint_texel(texture.sample(column, row), tint));
            }
        } else {
            // Most texels are seen more than once. Each step is the same for all numbers side by
            // side.
            let start = seen.start;
            texture.between(row, seen, &mut self.between);
            let (texels, _) = self.between.as_chunks::<4>();
            self.near.clear();
            self.near
                .extend(taps.iter().map(|tap| texels[tap.near - start]));
            self.far.clear();
            self.far
                .extend(taps.iter().map(|tap| texels[tap.far - start]));
            let weights = self.weights[first..first + span.len()].as_flattened();
            self.colors.resize(span.len(), [0; 4]);
            let pairs = self.near.as_flattened().iter().zip(self.far.as_flattened());
            let colors = self.colors.as_flattened_mut().iter_mut();
            for ((color, (near, far)), weight) in colors.zip(pairs).zip(weights) {
                *color = interpolate(*near, *far, *weight);
            }
            let opaque = self
                .colors
                .iter()
                .fold(255, |least, color| least & color[3])
                == 255;
            if opaque && tint == [255; 4] {
                span.copy_from_slice(&self.colors);
            } else {
                for (pixel, color) in span.iter_mut().zip(&self.colors) {
                    blend(pixel, tint_texel(*color, tint));
                }
            }
        }
    }
}

/// ⌊x/255 + ½⌋ for 0 ≤ x ≤ 255².
#[inline]
fn over_255(x: u32) -> u32 {
    ((x + 128) * 257) >> 16
}

/// Multiplies a texel by the tint of its shape.
#[inline]
fn tint_texel(texel: [u8; 4], tint: [u8; 4]) -> [u8; 4] {
    if tint == [255; 4] {
        return texel;
    }
    std::array::from_fn(|c| over_255(u32::from(texel[c]) * u32::from(tint[c])) as u8)
}

/// Puts a colour, multiplied by its alpha, over a pixel.
#[inline]
fn blend(pixel: &mut [u8; 4], color: [u8; 4]) {
    match color {
        [0, 0, 0, 0] => {}
        [_, _, _, 255] => *pixel = color,
        _ => {
            let rest = 255 - u32::from(color[3]);
            *pixel = std::array::from_fn(|c| {
                (u32::from(color[c]) + over_255(u32::from(pixel[c]) * rest)).min(255) as u8
            });
        }
    }
}

/// [`blend`] with a colour of channels from 0 to 255 that is not rounded yet.
#[inline]
fn blend_exact(pixel: &mut [u8; 4], color: [f32; 4]) {
    let rest = 1.0 - color[3] * (1.0 / 255.0);
    // The cast saturates.
    *pixel = std::array::from_fn(|c| (color[c] + f32::from(pixel[c]) * rest + 0.5) as u8);
}

#[cfg(test)]
mod tests {
    use egui::{
        ColorImage, TextureId, TextureOptions, TexturesDelta,
        epaint::{ImageDelta, textures::TextureFilter},
    };
    use trials::{Random, count};

    use super::*;
    use crate::texture::Textures;

    const BLACK: [u8; 4] = [0, 0, 0, 255];
    /// Added to what is there, so that it counts how often a pixel is drawn.
    const ONCE: Color32 = Color32::from_rgba_premultiplied(1, 0, 0, 0);

    /// Calls `test` with a texture of one white texel, as shapes without a picture have it.
    fn with_texture(image: ColorImage, options: TextureOptions, test: impl FnOnce(&Texture)) {
        let mut delta = TexturesDelta::default();
        delta.push(TextureId::default(), ImageDelta::full(image, options));
        let mut textures = Textures::default();
        textures.set(&mut delta);
        test(textures.get(TextureId::default()).unwrap());
    }

    fn with_white(test: impl FnOnce(&Texture)) {
        with_texture(
            ColorImage::filled([1, 1], Color32::WHITE),
            TextureOptions::LINEAR,
            test,
        );
    }

    fn sheet(width: usize, height: usize) -> Sheet {
        let mut sheet = Sheet::new(width, height);
        sheet.clear(sheet.area(), Color32::BLACK);
        sheet
    }

    fn corner(x: f32, y: f32, tint: Color32) -> Corner {
        Corner::new([x, y], [0.0; 2], tint).unwrap()
    }

    /// Returns a source of random numbers below `end`, multiples of `end / 2²⁴`.
    fn numbers(seed: u64, end: f32) -> impl FnMut() -> f32 {
        let mut random = Random::new(seed);
        move || (random.bits() >> 40) as f32 / (1 << 24) as f32 * end
    }

    #[test]
    fn a_pixel_is_covered_when_its_centre_is_inside_or_on_a_left_or_top_edge() {
        with_white(|white| {
            let mut sheet = sheet(6, 5);
            // The legs of the triangle run through pixel centres, the hypotenuse too.
            let triangle =
                [(1.5, 1.5), (5.5, 1.5), (1.5, 4.5)].map(|(x, y)| corner(x, y, Color32::WHITE));
            sheet.triangle(&triangle, white, sheet.area());
            let drawn = sheet.pixels.chunks(6).map(|row| {
                row.iter()
                    .map(|&pixel| if pixel == BLACK { '.' } else { '#' })
                    .collect()
            });
            let drawn: Vec<String> = drawn.collect();
            assert_eq!(drawn, ["......", ".####.", ".###..", ".##...", "......"]);
        });
    }

    #[test]
    fn triangles_that_share_edges_cover_each_pixel_once() {
        with_white(|white| {
            let mut number = numbers(7, 40.0);
            for _ in 0..count(200) {
                let mut sheet = sheet(40, 40);
                // A fan round an inner point, both ways round, covers the whole sheet.
                let hub = corner(number(), number(), ONCE);
                let rim = [
                    (0.0, 0.0),
                    (number(), 0.0),
                    (40.0, 0.0),
                    (40.0, number()),
                    (40.0, 40.0),
                    (number(), 40.0),
                    (0.0, 40.0),
                    (0.0, number()),
                ]
                .map(|(x, y)| corner(x, y, ONCE));
                for (i, &from) in rim.iter().enumerate() {
                    let to = rim[(i + 1) % rim.len()];
                    let triangle = if i % 2 == 0 {
                        [hub, from, to]
                    } else {
                        [to, from, hub]
                    };
                    sheet.triangle(&triangle, white, sheet.area());
                }
                assert!(sheet.pixels.iter().all(|pixel| pixel[0] == 1));
            }
        });
    }

    #[test]
    fn drawing_in_parts_is_drawing_the_whole() {
        with_white(|white| {
            let mut number = numbers(3, 60.0);
            for _ in 0..count(100) {
                let triangle = [(); 3].map(|()| {
                    let tint = Color32::from_rgba_premultiplied(number() as u8, 20, 0, 100);
                    corner(number() - 10.0, number() - 10.0, tint)
                });
                let mut whole = sheet(40, 40);
                whole.triangle(&triangle, white, whole.area());
                let mut parts = sheet(40, 40);
                for (x, y) in [(0, 0), (13, 0), (0, 17), (13, 17)] {
                    let area = Area {
                        x0: x,
                        y0: y,
                        x1: if x == 0 { 13 } else { 40 },
                        y1: if y == 0 { 17 } else { 40 },
                    };
                    parts.triangle(&triangle, white, area);
                }
                let apart = whole.bytes().iter().zip(parts.bytes());
                // The shade is computed from the left end of each span.
                assert!(apart.into_iter().all(|(a, b)| a.abs_diff(*b) <= 1));
            }
        });
    }

    #[test]
    fn a_picture_can_be_enlarged_tinted_and_blended() {
        let ground = Color32::from_rgb(10, 90, 200);
        let mut number = numbers(5, 256.0);
        for opaque in [true, false] {
            let texels = (0..12 * 9).map(|_| {
                let [red, green, blue, alpha] = [(); 4].map(|()| number() as u8);
                let alpha = if opaque { 255 } else { alpha };
                Color32::from_rgba_unmultiplied(red, green, blue, alpha)
            });
            let image = ColorImage::new([12, 9], texels.collect());
            with_texture(image, TextureOptions::LINEAR, |texture| {
                let shaded = Color32::from_rgba_premultiplied(200, 100, 50, 220);
                for tint in [Color32::WHITE, shaded] {
                    let corners = [
                        ([2.0, 3.0], [0.0, 0.0]),
                        ([34.0, 3.0], [12.0, 0.0]),
                        ([2.0, 30.0], [0.0, 9.0]),
                        ([34.0, 30.0], [12.0, 9.0]),
                    ]
                    .map(|(place, texel)| Corner::new(place, texel, tint).unwrap());
                    let quad = Quad::new(corners).unwrap();
                    let mut drawn = sheet(40, 40);
                    drawn.clear(drawn.area(), ground);
                    drawn.quad(&quad, texture, drawn.area());
                    for (x, y) in (3..30).flat_map(|y| (2..34).map(move |x| (x, y))) {
                        let [column, row] = [(0, x), (1, y)]
                            .map(|(axis, at)| texture.tap(axis, quad.texel(axis, at), true));
                        let mut pixel = ground.to_array();
                        let color = texture.sample(column, row);
                        blend(&mut pixel, tint_texel(color, tint.to_array()));
                        assert_eq!(drawn.span(y, x, x + 1)[0], pixel, "{x} {y}");
                    }
                }
            });
        }
    }

    #[test]
    fn a_picture_of_any_scale_shows_its_samples() {
        let mut number = numbers(11, 256.0);
        let texels = (0..12 * 9).map(|_| {
            let [red, green, blue] = [(); 3].map(|()| number() as u8);
            Color32::from_rgb(red, green, blue)
        });
        let image = ColorImage::new([12, 9], texels.collect());
        with_texture(image, TextureOptions::LINEAR, |texture| {
            for (width, height) in [(40.3, 21.7), (12.0, 9.5), (3.2, 4.9), (12.0, 9.0)] {
                let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)].map(|(x, y)| {
                    let place = [2.25 + x * width, 1.5 + y * height];
                    Corner::new(place, [x * 12.0, y * 9.0], Color32::WHITE).unwrap()
                });
                let quad = Quad::new(corners).unwrap();
                let mut sheet = sheet(50, 30);
                sheet.quad(&quad, texture, sheet.area());
                let area = quad.area();
                assert!(!area.is_empty());
                for y in area.y0..area.y1 {
                    for x in area.x0..area.x1 {
                        let [column, row] = [(0, x), (1, y)]
                            .map(|(axis, at)| texture.tap(axis, quad.texel(axis, at), true));
                        let drawn = sheet.pixels[y as usize * 50 + x as usize];
                        assert_eq!(drawn, texture.sample(column, row), "{x} {y} {width}");
                    }
                }
            }
        });
    }

    #[test]
    fn blending_is_exact_to_half_a_step() {
        for alpha in 0..=255u8 {
            for over in [0, 1, 77, 128, 200, 255] {
                for color in [0, alpha / 3, alpha] {
                    let exact =
                        f64::from(color) + f64::from(over) * (1.0 - f64::from(alpha) / 255.0);
                    let mut pixel = [over, over, over, 255];
                    blend(&mut pixel, [color, 0, 0, alpha]);
                    assert!((f64::from(pixel[0]) - exact).abs() <= 0.5);
                    assert_eq!(pixel[3], 255);
                    let mut pixel = [over, over, over, 255];
                    blend_exact(&mut pixel, [color, 0, 0, alpha].map(f32::from));
                    assert!((f64::from(pixel[0]) - exact).abs() <= 0.501);
                }
            }
        }
        // Colours with no alpha add, up to white.
        let mut pixel = [200, 3, 0, 255];
        blend(&mut pixel, [100, 4, 0, 0]);
        assert_eq!(pixel, [255, 7, 0, 255]);
    }

    #[test]
    fn shades_go_linearly_from_corner_to_corner() {
        with_white(|white| {
            let mut sheet = sheet(255, 2);
            let (left, right) = (Color32::BLACK, Color32::WHITE);
            let [a, b] = [corner(0.0, 0.0, left), corner(0.0, 2.0, left)];
            let [c, d] = [corner(255.0, 0.0, right), corner(255.0, 2.0, right)];
            sheet.triangle(&[a, b, c], white, sheet.area());
            sheet.triangle(&[b, c, d], white, sheet.area());
            for (i, pixel) in sheet.pixels.iter().enumerate() {
                let exact = (i % 255) as f64 + 0.5;
                assert!((f64::from(pixel[0]) - exact).abs() <= 0.6, "{i}: {pixel:?}");
            }
        });
    }

    #[test]
    fn a_box_is_drawn_as_its_two_triangles_are() {
        let mut number = numbers(11, 1.0);
        for round in 0..count(60) {
            let image = ColorImage::new(
                [16, 8],
                (0..128)
                    .map(|_| {
                        Color32::from_rgba_unmultiplied(
                            (number() * 255.0) as u8,
                            (number() * 255.0) as u8,
                            9,
                            (number() * 255.0) as u8,
                        )
                    })
                    .collect(),
            );
            let options = TextureOptions {
                magnification: if round % 2 == 0 {
                    TextureFilter::Linear
                } else {
                    TextureFilter::Nearest
                },
                ..TextureOptions::LINEAR
            };
            with_texture(image, options, |texture| {
                let from = [number() * 20.0, number() * 20.0];
                let to = [
                    from[0] + number() * 40.0 + 0.1,
                    from[1] + number() * 40.0 + 0.1,
                ];
                let tint = Color32::from_rgba_premultiplied(200, 255, 100, 255);
                let corners = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(x, y)| {
                    let position = [[from[0], to[0]][x], [from[1], to[1]][y]];
                    // A texture that is turned left to right.
                    let texel = [[15.2, 1.3][x], [0.4, 6.9][y]];
                    Corner::new(position, texel, tint).unwrap()
                });
                let mut boxed = sheet(50, 50);
                boxed.quad(&Quad::new(corners).unwrap(), texture, boxed.area());
                let mut split = sheet(50, 50);
                let [a, b, c, d] = corners;
                split.triangle(&[a, b, c], texture, split.area());
                split.triangle(&[c, b, d], texture, split.area());
                let differing = boxed
                    .bytes()
                    .iter()
                    .zip(split.bytes())
                    .filter(|(a, b)| a.abs_diff(**b) > 2)
                    .count();
                // Nearest texels may fall either way where a pixel centre lies between two.
                assert!(
                    differing <= if round % 2 == 0 { 0 } else { 20 },
                    "{differing}"
                );
            });
        }
    }

    #[test]
    fn text_is_copied_texel_by_texel() {
        let image = ColorImage::new(
            [300, 200],
            (0..300 * 200)
                .map(|i| Color32::from_gray((i % 251) as u8))
                .collect(),
        );
        with_texture(image, TextureOptions::LINEAR, |texture| {
            let mut sheet = sheet(20, 20);
            let corners = [(0.0, 0.0), (9.0, 0.0), (0.0, 12.0), (9.0, 12.0)].map(|(x, y)| {
                // As egui gives it: relative to the texture's size, in single precision.
                let texel = [(250.0 + x) / 300.0 * 300.0, (170.0 + y) / 200.0 * 200.0];
                Corner::new([3.0 + x, 5.0 + y], texel, Color32::WHITE).unwrap()
            });
            sheet.quad(&Quad::new(corners).unwrap(), texture, sheet.area());
            for (y, row) in sheet.pixels.chunks(20).enumerate() {
                for (x, pixel) in row.iter().enumerate() {
                    let inside = (3..12).contains(&x) && (5..17).contains(&y);
                    let expected = if inside {
                        ((250 + x - 3 + 300 * (170 + y - 5)) % 251) as u8
                    } else {
                        0
                    };
                    assert_eq!(pixel[0], expected, "at {x}, {y}");
                }
            }
        });
    }

    #[test]
    fn strange_corners_do_no_harm() {
        with_white(|white| {
            assert!(Corner::new([f32::NAN, 0.0], [0.0; 2], ONCE).is_none());
            let mut sheet = sheet(9, 9);
            let far = [
                f32::INFINITY,
                f32::NEG_INFINITY,
                1e30,
                -1e9,
                0.0,
                4.5,
                1e-30,
            ];
            for a in far {
                for b in far {
                    for c in far {
                        let at = |x, y, u| Corner::new([x, y], [u, a], ONCE).unwrap();
                        let area = sheet.area();
                        sheet.triangle(&[at(a, b, c), at(b, c, a), at(c, a, b)], white, area);
                        sheet.triangle(&[at(a, b, 0.0), at(b, a, 0.0), at(c, c, 0.0)], white, area);
                        let corners = [at(a, b, b), at(c, b, c), at(a, c, b), at(c, c, c)];
                        if let Some(quad) = Quad::new(corners) {
                            sheet.quad(&quad, white, area);
                        }
                    }
                }
            }
        });
    }
}
