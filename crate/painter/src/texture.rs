//! The textures that egui has given out: the font atlas and the app's pictures.

use std::ops::Range;

use egui::{
    Color32, ImageData, TextureFilter, TextureId, TextureOptions, TextureWrapMode, TexturesDelta,
    epaint::ImageDelta,
};

/// Textures remember when they changed in squares of this many texels.
const BLOCK: usize = 64;

/// The most by which a sample is moved, in texels, so that its weights are multiples of 1/256.
const ROUNDING: f32 = 1.0 / 512.0;

/// A texture and when each part of it changed.
#[derive(Debug)]
pub struct Texture {
    size: [usize; 2],
    /// Red, green, blue, alpha in rows from the top.
    texels: Vec<[u8; 4]>,
    options: TextureOptions,
    /// The time of the last change of every block, in rows.
    changed: Vec<u64>,
}

/// The place of a sample between two neighbouring texels of a row or column: at `near` for
/// `weight` = 0, going to `far` as the weight goes to 256.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tap {
    pub near: usize,
    pub far: usize,
    pub weight: u32,
}

impl Tap {
    /// Returns the first and the last texel.
    pub fn ends(&self) -> [usize; 2] {
        [self.near.min(self.far), self.near.max(self.far)]
    }
}

impl Texture {
    fn new(delta: ImageDelta, now: u64) -> Self {
        let ImageData::Color(image) = delta.image;
        let image = std::sync::Arc::unwrap_or_clone(image);
        Self {
            size: image.size,
            options: delta.options,
            changed: vec![now; image.size[0].div_ceil(BLOCK) * image.size[1].div_ceil(BLOCK)],
            texels: image.pixels.iter().map(Color32::to_array).collect(),
        }
    }

    /// Writes the part of a patch that lies inside the texture. A block counts as changed only if
    /// a texel differs: a picture that is traced more finely has the same background.
    fn patch(&mut self, delta: &ImageDelta, [left, top]: [usize; 2], now: u64) {
        let ImageData::Color(image) = &delta.image;
        let width = image.size[0].min(self.size[0].saturating_sub(left));
        let height = image.size[1].min(self.size[1].saturating_sub(top));
        if width == 0 || height == 0 {
            return;
        }
        let columns = self.size[0].div_ceil(BLOCK);
        for y in 0..height {
            let from = y * image.size[0];
            let to = (top + y) * self.size[0] + left;
            let row = &image.pixels[from..from + width];
            let texels = &mut self.texels[to..to + width];
            let first = (top + y) / BLOCK * columns;
            let mut x = 0;
            while x < width {
                let block = (left + x) / BLOCK;
                let end = width.min((block + 1) * BLOCK - left);
                let pairs = texels[x..end].iter_mut().zip(&row[x..end]);
                // Without a branch for each texel.
                let apart = pairs.fold(0, |apart, (texel, new)| {
                    let before = u32::from_ne_bytes(*texel);
                    *texel = new.to_array();
                    apart | before ^ u32::from_ne_bytes(*texel)
                });
                if apart != 0 {
                    self.changed[first + block] = now;
                }
                x = end;
            }
        }
    }

    /// Sets filters and wrapping.
    fn set_options(&mut self, options: TextureOptions, now: u64) {
        if self.options != options {
            self.options = options;
            self.changed.fill(now);
        }
    }

    /// Width and height in texels.
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Returns the time at which a rectangle of texels (from, to, both within) last changed.
    /// Coordinates outside the texture count as its edge; with wrapping, all of the texture counts.
    pub fn last_change(&self, from: [f32; 2], to: [f32; 2]) -> u64 {
        let [across, down] = [0, 1].map(|axis| {
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
        });
        let columns = self.size[0].div_ceil(BLOCK);
        down.flat_map(|y| across.clone().map(move |x| y * columns + x))
            .filter_map(|block| self.changed.get(block).copied())
            .max()
            .unwrap_or(0)
    }

    /// Whether neighbouring texels are blended, at a number of texels per pixel.
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
        if !smooth {
            let near = self.wrap(axis, at.floor() as i64);
            return Tap {
                near,
                far: near,
                weight: 0,
            };
        }
        // Weights in 1/256, as GPUs have them. Rounding makes samples at texel centres exact.
        let fixed = ((at - 0.5) * 256.0).round_ties_even() as i64;
        let near = self.wrap(axis, fixed >> 8);
        let weight = (fixed & 255) as u32;
        Tap {
            near,
            far: if weight == 0 {
                near
            } else {
                self.wrap(axis, (fixed >> 8).saturating_add(1))
            },
            weight,
        }
    }

    /// Returns the texel that stands for one of any index, outside the texture too.
    #[inline]
    fn wrap(&self, axis: usize, index: i64) -> usize {
        let size = self.size[axis] as i64;
        (match self.options.wrap_mode {
            TextureWrapMode::ClampToEdge => index.clamp(0, size - 1),
            TextureWrapMode::Repeat => index.rem_euclid(size),
            TextureWrapMode::MirroredRepeat => {
                let phase = index.rem_euclid(2 * size);
                phase.min(2 * size - 1 - phase)
            }
        }) as usize
    }

    /// The colour at a place: of one texel, or blended of up to four.
    #[inline]
    pub fn sample(&self, column: Tap, row: Tap) -> [u8; 4] {
        let near = row.near * self.size[0];
        if column.weight == 0 && row.weight == 0 {
            return self.texels[near + column.near];
        }
        let far = row.far * self.size[0];
        let [own, its] = [256 - row.weight, row.weight].map(|weight| weight as u16);
        let [left, right]: [[u16; 4]; 2] = [column.near, column.far].map(|x| {
            let [near, far] = [near, far].map(|row| self.texels[row + x].map(u16::from));
            std::array::from_fn(|c| near[c] * own + far[c] * its)
        });
        std::array::from_fn(|c| interpolate(left[c], right[c], column.weight as u16))
    }

    /// Computes the channels of the texels of some columns at a place between two rows, 256 times
    /// as large.
    pub fn between(&self, row: Tap, columns: Range<usize>, between: &mut Vec<u16>) {
        let [near, far] =
            [row.near, row.far].map(|y| self.row(y)[columns.clone()].as_flattened().iter());
        let [own, its] = [256 - row.weight, row.weight].map(|weight| weight as u16);
        between.clear();
        between.extend(
            near.zip(far)
                .map(|(near, far)| u16::from(*near) * own + u16::from(*far) * its),
        );
    }

    /// The texels of a row.
    pub fn row(&self, y: usize) -> &[[u8; 4]] {
        &self.texels[y * self.size[0]..(y + 1) * self.size[0]]
    }
}

/// Interpolates two channels, each scaled by 256: the weight 0 … 256 is that of the second.
#[inline]
pub fn interpolate(near: u16, far: u16, weight: u16) -> u8 {
    let [near, far, weight] = [near, far, weight].map(u32::from);
    ((near * (256 - weight) + far * weight + (1 << 15)) >> 16) as u8
}

/// The textures in use. They are few, and the one that is looked for most, the font, came first.
#[derive(Debug, Default)]
pub struct Textures {
    textures: Vec<(TextureId, Texture)>,
    /// Counts the changes.
    now: u64,
}

impl Textures {
    /// Takes new and changed textures over.
    pub fn set(&mut self, delta: &mut TexturesDelta) {
        for (id, images) in delta.set.drain() {
            for image in images {
                self.now += 1;
                let known = self.textures.iter_mut().find(|(known, _)| *known == id);
                match (known, image.pos) {
                    (Some((_, texture)), Some(position)) => {
                        texture.set_options(image.options, self.now);
                        texture.patch(&image, position, self.now);
                    }
                    (None, Some(_)) => {}
                    (Some((_, texture)), None) => {
                        if texture.size == image.image.size() && texture.options == image.options {
                            texture.patch(&image, [0; 2], self.now);
                        } else {
                            *texture = Texture::new(image, self.now);
                        }
                    }
                    (None, None) => self.textures.push((id, Texture::new(image, self.now))),
                }
            }
        }
    }

    /// Forgets textures that are no longer used.
    pub fn free(&mut self, delta: &mut TexturesDelta) {
        for id in delta.free.drain() {
            self.textures.retain(|(known, _)| *known != id);
        }
    }

    /// A texture that has texels.
    pub fn get(&self, id: TextureId) -> Option<&Texture> {
        let (_, texture) = self.textures.iter().find(|(known, _)| *known == id)?;
        (!texture.texels.is_empty()).then_some(texture)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::ColorImage;
    use trials::{Random, count};

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
        let mut random = Random::new(1);
        for round in 0..20 + count(2000) {
            let texels: [[u8; 4]; 4] = std::array::from_fn(|_| {
                std::array::from_fn(|_| {
                    if round < 20 {
                        255
                    } else {
                        random.below(256) as u8
                    }
                })
            });
            let [across, down] = [0; 2].map(|_| random.below(256) as u32);
            let colors = texels.map(|[r, g, b, a]| Color32::from_rgba_premultiplied(r, g, b, a));
            let image = ColorImage::new([2, 2], colors.to_vec());
            let texture = Texture::new(ImageDelta::full(image, TextureOptions::LINEAR), 1);
            let [column, row] = [across, down].map(|weight| Tap {
                near: 0,
                far: 1,
                weight,
            });
            let mixed = texture.sample(column, row);
            let mut between = Vec::new();
            texture.between(row, 0..2, &mut between);
            let sample =
                std::array::from_fn(|c| interpolate(between[c], between[4 + c], across as u16));
            assert_eq!(sample, mixed);
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
        let [clamped, repeated, mirrored] = [
            TextureWrapMode::ClampToEdge,
            TextureWrapMode::Repeat,
            TextureWrapMode::MirroredRepeat,
        ]
        .map(|wrap_mode| {
            ramp(TextureOptions {
                wrap_mode,
                ..TextureOptions::NEAREST
            })
        });
        assert_eq!([at(&clamped, -7.5, 0.5), at(&clamped, 9.5, 0.5)], [0, 120]);
        assert_eq!(
            [at(&repeated, -0.5, 0.5), at(&repeated, 5.5, 0.5)],
            [120, 40]
        );
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
        assert_eq!(texture.last_change([0.0, 0.0], [120.0, 99.0]), 1);
        assert_eq!(texture.last_change([0.0, 0.0], [199.0, 99.0]), 2);
        // A sample at 191.6 also reads the texel 192, which is in the changed block.
        assert_eq!(texture.last_change([180.0, 80.0], [191.6, 90.0]), 2);
        assert_eq!(texture.last_change([180.0, 80.0], [191.5, 90.0]), 1);
    }

    #[test]
    fn a_picture_or_patch_changes_only_the_blocks_in_which_it_differs() {
        fn dot(x: usize, y: usize) -> ColorImage {
            grey([140, 100], |u, v| if (u, v) == (x, y) { 9 } else { 0 })
        }
        fn flat(height: usize) -> ColorImage {
            grey([140, height], |_, _| 0)
        }
        let id = TextureId::Managed(7);
        let mut textures = Textures::default();
        let mut set = |image: ColorImage, pos, options| {
            let mut delta = TexturesDelta::default();
            let image = match pos {
                Some(pos) => ImageDelta::partial(pos, image, options),
                None => ImageDelta::full(image, options),
            };
            delta.push(id, image);
            textures.set(&mut delta);
            let texture = textures.get(id).unwrap();
            [[10.0; 2], [80.0, 10.0], [130.0, 80.0]].map(|at| texture.last_change(at, at))
        };
        let linear = TextureOptions::LINEAR;
        assert_eq!(set(dot(80, 63), None, linear), [1; 3]);
        assert_eq!(set(dot(80, 63), None, linear), [1; 3]);
        assert_eq!(set(dot(80, 62), None, linear), [1, 3, 1]);
        // Over the corners of four blocks, only in the last of which something differs.
        let patch = grey([10, 10], |x, y| if (x, y) == (9, 9) { 5 } else { 0 });
        let changed = set(patch.clone(), Some([120, 60]), linear);
        assert_eq!(changed, [1, 3, 4]);
        assert_eq!(set(patch, Some([120, 60]), linear), [1, 3, 4]);
        let same = grey([1, 1], |_, _| 0);
        assert_eq!(set(same, Some([0, 0]), TextureOptions::NEAREST), [6; 3]);
        assert_eq!(set(flat(100), None, TextureOptions::NEAREST)[0], 6);
        assert_eq!(set(flat(100), None, linear), [8; 3]);
        assert_eq!(set(flat(101), None, linear), [9; 3]);
    }
}
