//! The textures that egui has given out: the font atlas and the app's pictures.

use std::collections::HashMap;
use std::ops::Range;

use egui::{
    Color32, ImageData, TextureFilter, TextureId, TextureOptions, TextureWrapMode, TexturesDelta,
    epaint::ImageDelta,
};

/// Textures remember when they changed in squares of this many texels.
const BLOCK: usize = 64;

/// How far a sample is moved at most so that its weights are multiples of 1/256.
const ROUNDING: f32 = 1.0 / 512.0;

/// A texture and when each part of it changed.
#[derive(Debug)]
pub struct Texture {
    size: [usize; 2],
    texels: Vec<Color32>,
    options: TextureOptions,
    /// For every block, in rows, the time of its last change.
    changed: Vec<u64>,
}

/// Where a sample lies between two neighbouring texels of a row or column: at `near` for
/// `weight` = 0, going to `far` as the weight goes to 256.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tap {
    pub near: usize,
    pub far: usize,
    pub weight: u32,
}

impl Texture {
    fn new(delta: ImageDelta, now: u64) -> Self {
        let ImageData::Color(image) = delta.image;
        let image = std::sync::Arc::unwrap_or_clone(image);
        Self {
            size: image.size,
            options: delta.options,
            changed: vec![now; image.size[0].div_ceil(BLOCK) * image.size[1].div_ceil(BLOCK)],
            texels: image.pixels,
        }
    }

    /// Writes a patch; what of it lies outside the texture is left out.
    fn patch(&mut self, delta: &ImageDelta, [left, top]: [usize; 2], now: u64) {
        let ImageData::Color(image) = &delta.image;
        let width = image.size[0].min(self.size[0].saturating_sub(left));
        let height = image.size[1].min(self.size[1].saturating_sub(top));
        if width == 0 || height == 0 {
            return;
        }
        for y in 0..height {
            let from = y * image.size[0];
            let to = (top + y) * self.size[0] + left;
            self.texels[to..to + width].copy_from_slice(&image.pixels[from..from + width]);
        }
        let columns = self.size[0].div_ceil(BLOCK);
        for y in top / BLOCK..(top + height).div_ceil(BLOCK) {
            for x in left / BLOCK..(left + width).div_ceil(BLOCK) {
                self.changed[y * columns + x] = now;
            }
        }
        self.options = delta.options;
    }

    /// Width and height in texels.
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// When a rectangle of texels (from, to, both within) last changed. Coordinates outside the
    /// texture count as its edge; with wrapping, all of the texture counts.
    pub fn changed(&self, from: [f32; 2], to: [f32; 2]) -> u64 {
        let blocks = |axis: usize| {
            let last = self.size[axis].saturating_sub(1);
            // A sample reaches half a texel to each side, but for the rounding of its weight. The
            // casts saturate.
            let range = if self.options.wrap_mode == TextureWrapMode::ClampToEdge {
                let reach = 0.5 - ROUNDING;
                let last_seen = (to[axis] + reach).ceil() - 1.0;
                ((from[axis] - reach) as usize).min(last)..=(last_seen as usize).min(last)
            } else {
                0..=last
            };
            range.start() / BLOCK..=range.end() / BLOCK
        };
        let columns = self.size[0].div_ceil(BLOCK);
        blocks(1)
            .flat_map(|y| blocks(0).map(move |x| y * columns + x))
            .filter_map(|block| self.changed.get(block).copied())
            .max()
            .unwrap_or(0)
    }

    /// Whether neighbouring texels are blended where so many of them fall on a pixel.
    pub fn is_smooth(&self, texels_per_pixel: f32) -> bool {
        let filter = if texels_per_pixel > 1.0 {
            self.options.minification
        } else {
            self.options.magnification
        };
        filter == TextureFilter::Linear
    }

    /// The texels around the coordinate `at` (in texels) along an axis (0 = x, 1 = y).
    pub fn tap(&self, axis: usize, at: f32, smooth: bool) -> Tap {
        let wrap = |index: i64| {
            let size = self.size[axis] as i64;
            (match self.options.wrap_mode {
                TextureWrapMode::ClampToEdge => index.clamp(0, size - 1),
                TextureWrapMode::Repeat => index.rem_euclid(size),
                TextureWrapMode::MirroredRepeat => {
                    let phase = index.rem_euclid(2 * size);
                    phase.min(2 * size - 1 - phase)
                }
            }) as usize
        };
        if !smooth {
            let near = wrap(at.floor() as i64);
            return Tap {
                near,
                far: near,
                weight: 0,
            };
        }
        // Weights in 1/256, as GPUs have them. Rounding makes samples at texel centres exact.
        let fixed = ((at - 0.5) * 256.0).round() as i64;
        let near = wrap(fixed >> 8);
        let weight = (fixed & 255) as u32;
        Tap {
            near,
            far: if weight == 0 {
                near
            } else {
                wrap((fixed >> 8).saturating_add(1))
            },
            weight,
        }
    }

    /// The colour at a place: of one texel, or blended of up to four.
    #[inline]
    pub fn sample(&self, column: Tap, row: Tap) -> [u8; 4] {
        let near = row.near * self.size[0];
        let texel = |index: usize| self.texels[index].to_array();
        if column.weight == 0 && row.weight == 0 {
            return texel(near + column.near);
        }
        let far = row.far * self.size[0];
        let across = |row: usize| {
            let [near, far] = [column.near, column.far].map(|x| Mix::of(self.texels[row + x]));
            near.with(far, column.weight)
        };
        across(near).with(across(far), row.weight).rounded()
    }

    /// The texels of some columns at a place between two rows.
    pub fn between(&self, row: Tap, columns: Range<usize>, between: &mut Vec<Mix>) {
        let [near, far] = [row.near, row.far].map(|y| &self.row(y)[columns.clone()]);
        between.clear();
        let pairs = near.iter().zip(far);
        between.extend(pairs.map(|(near, far)| Mix::of(*near).with(Mix::of(*far), row.weight)));
    }

    /// The texels of a row.
    pub fn row(&self, y: usize) -> &[Color32] {
        &self.texels[y * self.size[0]..(y + 1) * self.size[0]]
    }
}

/// A texel, or what lies between texels: channels 0 and 2 in the halves of one number, 1 and 3 in those of another, so that
/// two are blended at a time. Each blend makes them 256 times as large; there is room for two.
#[derive(Clone, Copy, Debug)]
pub struct Mix([u64; 2]);

impl Mix {
    #[inline]
    fn of(texel: Color32) -> Self {
        let [a, b, c, d] = texel.to_array().map(u64::from);
        Self([a | c << 32, b | d << 32])
    }

    /// What lies between this and another, nearer to the other the larger the weight, 0 … 256.
    #[inline]
    pub fn with(self, other: Self, weight: u32) -> Self {
        let (own, its) = (u64::from(256 - weight), u64::from(weight));
        Self(std::array::from_fn(|i| self.0[i] * own + other.0[i] * its))
    }

    /// The channels after two blends.
    #[inline]
    pub fn rounded(self) -> [u8; 4] {
        let [even, odd] = self.0.map(|pair| (pair + 0x8000_0000_8000) >> 16);
        [even, odd, even >> 32, odd >> 32].map(|channel| channel as u8)
    }
}

/// All textures in use.
#[derive(Debug, Default)]
pub struct Textures {
    textures: HashMap<TextureId, Texture>,
    /// Counts the changes.
    now: u64,
}

impl Textures {
    /// Takes new and changed textures over.
    pub fn set(&mut self, delta: &mut TexturesDelta) {
        for (id, images) in delta.set.drain() {
            for image in images {
                self.now += 1;
                match image.pos {
                    Some(position) => {
                        if let Some(texture) = self.textures.get_mut(&id) {
                            texture.patch(&image, position, self.now);
                        }
                    }
                    None => {
                        self.textures.insert(id, Texture::new(image, self.now));
                    }
                }
            }
        }
    }

    /// Forgets textures that are no longer used.
    pub fn free(&mut self, delta: &mut TexturesDelta) {
        for id in delta.free.drain() {
            self.textures.remove(&id);
        }
    }

    /// A texture that has texels.
    pub fn get(&self, id: TextureId) -> Option<&Texture> {
        self.textures
            .get(&id)
            .filter(|texture| !texture.texels.is_empty())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::ColorImage;

    fn grey(size: [usize; 2], value: impl Fn(usize, usize) -> u8) -> ColorImage {
        ColorImage::new(
            size,
            (0..size[0] * size[1])
                .map(|i| Color32::from_gray(value(i % size[0], i / size[0])))
                .collect(),
        )
    }

    fn ramp(options: TextureOptions) -> Texture {
        let image = grey([4, 2], |x, y| (x * 40 + y * 100) as u8);
        Texture::new(ImageDelta::full(image, options), 1)
    }

    fn at(texture: &Texture, x: f32, y: f32) -> u8 {
        let smooth = texture.is_smooth(1.0);
        texture.sample(texture.tap(0, x, smooth), texture.tap(1, y, smooth))[0]
    }

    #[test]
    fn samples_at_texel_centres_are_the_texels() {
        for options in [TextureOptions::LINEAR, TextureOptions::NEAREST] {
            let texture = ramp(options);
            for (x, y, value) in [(0, 0, 0), (3, 0, 120), (0, 1, 100), (2, 1, 180)] {
                assert_eq!(at(&texture, x as f32 + 0.5, y as f32 + 0.5), value);
            }
        }
    }

    #[test]
    fn samples_between_texels_are_blended_or_nearest() {
        let linear = ramp(TextureOptions::LINEAR);
        assert_eq!(at(&linear, 1.0, 0.5), 20);
        assert_eq!(at(&linear, 1.25, 0.5), 30);
        assert_eq!(at(&linear, 1.0, 1.0), 70);
        let nearest = ramp(TextureOptions::NEAREST);
        assert_eq!(at(&nearest, 1.9, 0.9), 40);
    }

    #[test]
    fn channels_are_blended_each_by_itself() {
        let mut state = 1u64;
        let mut byte = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 56) as u8
        };
        for round in 0..2000 {
            let texels: [[u8; 4]; 4] = std::array::from_fn(|_| {
                std::array::from_fn(|_| if round < 20 { 255 } else { byte() })
            });
            let [across, down] = [byte(), byte()].map(u32::from);
            let [a, b, c, d] =
                texels.map(|[r, g, b, a]| Mix::of(Color32::from_rgba_premultiplied(r, g, b, a)));
            let mixed = a.with(b, across).with(c.with(d, across), down).rounded();
            for channel in 0..4 {
                let [a, b, c, d] = texels.map(|texel| u32::from(texel[channel]));
                let top = a * (256 - across) + b * across;
                let bottom = c * (256 - across) + d * across;
                let whole = top * (256 - down) + bottom * down;
                assert_eq!(u32::from(mixed[channel]), (whole + (1 << 15)) >> 16);
            }
        }
    }

    #[test]
    fn samples_outside_follow_the_wrap_mode() {
        let with = |wrap_mode| {
            ramp(TextureOptions {
                wrap_mode,
                ..TextureOptions::NEAREST
            })
        };
        let clamped = with(TextureWrapMode::ClampToEdge);
        assert_eq!([at(&clamped, -7.5, 0.5), at(&clamped, 9.5, 0.5)], [0, 120]);
        let repeated = with(TextureWrapMode::Repeat);
        assert_eq!(
            [at(&repeated, -0.5, 0.5), at(&repeated, 5.5, 0.5)],
            [120, 40]
        );
        let mirrored = with(TextureWrapMode::MirroredRepeat);
        assert_eq!([at(&mirrored, -0.5, 0.5), at(&mirrored, 5.5, 0.5)], [0, 80]);
        assert_eq!(at(&clamped, f32::NAN, f32::INFINITY), 100);
    }

    #[test]
    fn patches_change_their_blocks_only() {
        let image = grey([200, 100], |_, _| 0);
        let mut texture = Texture::new(ImageDelta::full(image, TextureOptions::LINEAR), 1);
        let patch = grey([10, 10], |_, _| 255);
        // The last five columns and all but five rows lie outside.
        texture.patch(
            &ImageDelta::partial([195, 95], patch.clone(), TextureOptions::LINEAR),
            [195, 95],
            2,
        );
        texture.patch(
            &ImageDelta::partial([500, 0], patch, TextureOptions::LINEAR),
            [500, 0],
            3,
        );
        assert_eq!(at(&texture, 195.5, 95.5), 255);
        assert_eq!(at(&texture, 194.5, 95.5), 0);
        assert_eq!(texture.changed([0.0, 0.0], [120.0, 99.0]), 1);
        assert_eq!(texture.changed([0.0, 0.0], [199.0, 99.0]), 2);
        // A sample at 191.6 also reads the texel 192, which is in the changed block.
        assert_eq!(texture.changed([180.0, 80.0], [191.6, 90.0]), 2);
        assert_eq!(texture.changed([180.0, 80.0], [191.5, 90.0]), 1);
    }
}
