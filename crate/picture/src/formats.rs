//! The formats that the `image` library reads and writes for us.

use crate::limits::{MAX_ANIMATION, MAX_FRAMES, MAX_SIDE};
use crate::picture::{check_room, check_size};
use crate::{Format, Picture, Problem};
use color_quant::NeuQuant;
use image::codecs::gif::{GifDecoder, GifEncoder, Repeat};
use image::codecs::png::PngDecoder;
use image::error::ImageError;
use image::{
    AnimationDecoder, DynamicImage, ExtendedColorType, ImageDecoder, ImageFormat, ImageReader,
    Limits, RgbaImage, imageops,
};
use std::io::{Cursor, Write};

/// Bytes of the largest pixel that is read at full size: four channels of 16 bits.
const BYTES_A_PIXEL: u64 = 8;
/// Bytes a decoder may use besides the picture.
const BESIDES: u64 = 64 << 20;
/// The step between the pixels from which 256 colours are chosen, 1 … 30: 10 is four times as fast
/// as 1, and hardly worse.
const HASTE: i32 = 10;

fn library_format(format: Format) -> ImageFormat {
    match format {
        Format::Png => ImageFormat::Png,
        Format::Mtv => ImageFormat::Pnm,
        Format::Tga => ImageFormat::Tga,
        Format::Tif => ImageFormat::Tiff,
        Format::Gif => ImageFormat::Gif,
        Format::Jpg => ImageFormat::Jpeg,
    }
}

/// Memory limits of a decoder for a picture of a number of pixels.
fn limits(pixels: u64) -> Limits {
    let mut limits = Limits::default();
    limits.max_image_width = Some(MAX_SIDE);
    limits.max_image_height = Some(MAX_SIDE);
    limits.max_alloc = Some(pixels * BYTES_A_PIXEL + BESIDES);
    limits
}

fn damage(format: Format, error: &ImageError) -> Problem {
    Problem::Damaged(format.name(), error.to_string())
}

fn not_written(format: Format, error: &ImageError) -> Problem {
    Problem::NotWritten(format.name(), error.to_string())
}

/// Reads width and height from the head of a file.
pub fn size(bytes: &[u8], format: Format) -> Result<[u32; 2], Problem> {
    let (width, height) = ImageReader::with_format(Cursor::new(bytes), library_format(format))
        .into_dimensions()
        .map_err(|error| damage(format, &error))?;
    check_size(width, height)?;
    Ok([width, height])
}

/// Reads a picture.
pub fn decode(bytes: &[u8], format: Format, max_pixels: u64) -> Result<Picture, Problem> {
    let mut reader = ImageReader::with_format(Cursor::new(bytes), library_format(format));
    reader.limits(limits(max_pixels));
    let decoder = reader
        .into_decoder()
        .map_err(|error| damage(format, &error))?;
    let (width, height) = decoder.dimensions();
    check_room(width, height, max_pixels)?;
    let picture = DynamicImage::from_decoder(decoder).map_err(|error| damage(format, &error))?;
    Picture::new(width, height, picture.into_rgba8().into_raw())
}

/// The bytes of a file.
pub fn encode(picture: &Picture, format: Format) -> Result<Vec<u8>, Problem> {
    let mut bytes = Cursor::new(Vec::new());
    let [width, height] = picture.size();
    let opaque = match format {
        Format::Gif => false,
        Format::Jpg => true,
        _ => picture.is_opaque(),
    };
    let rgb;
    let (pixels, colour) = if opaque {
        rgb = picture.rgb();
        (rgb.as_slice(), ExtendedColorType::Rgb8)
    } else {
        (picture.pixels(), ExtendedColorType::Rgba8)
    };
    image::write_buffer_with_format(
        &mut bytes,
        pixels,
        width,
        height,
        colour,
        library_format(format),
    )
    .map_err(|error| not_written(format, &error))?;
    Ok(bytes.into_inner())
}

/// A GIF file that is being written.
pub struct AnimatedGif<W: Write> {
    encoder: GifEncoder<W>,
    delay: image::Delay,
    dither: bool,
}

impl<W: Write> AnimatedGif<W> {
    /// Begins a file.
    pub fn begin(to: W, timing: crate::timing::Timing, dither: bool) -> Result<Self, Problem> {
        let mut encoder = GifEncoder::new_with_speed(to, HASTE);
        if timing.repeats {
            encoder
                .set_repeat(Repeat::Infinite)
                .map_err(|error| not_written(Format::Gif, &error))?;
        }
        Ok(Self {
            encoder,
            delay: image::Delay::from_numer_denom_ms(u32::from(timing.delay) * 10, 1),
            dither,
        })
    }

    /// Adds a frame.
    pub fn add(&mut self, frame: &Picture) -> Result<(), Problem> {
        let [width, height] = frame.size();
        let mut image = RgbaImage::from_raw(width, height, frame.pixels().to_vec())
            .ok_or(Problem::Size(width.into(), height.into()))?;
        if self.dither {
            let colours = NeuQuant::new(HASTE, 256, &image);
            imageops::dither(&mut image, &colours);
        }
        self.encoder
            .encode_frame(image::Frame::from_parts(image, 0, 0, self.delay))
            .map_err(|error| not_written(Format::Gif, &error))
    }
}

/// The frames of an animation, one after the other.
pub struct Frames<'a> {
    frames: image::Frames<'a>,
    format: Format,
    count: u32,
    pixels: u64,
    delay: f64,
    failed: bool,
}

/// The frames of a file. A PNG file without an animation has one.
pub fn frames<'a>(
    bytes: impl AsRef<[u8]> + 'a,
    format: Format,
    max_pixels: u64,
) -> Result<Frames<'a>, Problem> {
    let wrong = |error| damage(format, &error);
    let source = Cursor::new(bytes);
    let frames = match format {
        Format::Gif => {
            let mut decoder = GifDecoder::new(source).map_err(wrong)?;
            let (width, height) = decoder.dimensions();
            let pixels = check_room(width, height, max_pixels)?;
            decoder.set_limits(limits(pixels)).map_err(wrong)?;
            decoder.into_frames()
        }
        Format::Png => {
            let largest = limits(crate::limits::MAX_PIXELS);
            let decoder = PngDecoder::with_limits(source, largest).map_err(wrong)?;
            let (width, height) = decoder.dimensions();
            check_room(width, height, max_pixels)?;
            if decoder.is_apng().map_err(wrong)? {
                decoder.apng().map_err(wrong)?.into_frames()
            } else {
                let image = DynamicImage::from_decoder(decoder).map_err(wrong)?;
                let one = image::Frame::new(image.into_rgba8());
                image::Frames::new(Box::new(std::iter::once(Ok(one))))
            }
        }
        other => return Err(Problem::NoAnimation(other.name())),
    };
    Ok(Frames {
        frames,
        format,
        count: 0,
        pixels: 0,
        delay: 0.0,
        failed: false,
    })
}

impl Frames<'_> {
    /// Returns the time for which the frame that came last is to be shown, seconds; 0 if its file
    /// does not say.
    #[must_use]
    pub fn delay(&self) -> f64 {
        self.delay
    }

    fn check(&mut self, frame: Result<image::Frame, ImageError>) -> Result<Picture, Problem> {
        let frame = frame.map_err(|error| damage(self.format, &error))?;
        let (milliseconds, parts) = frame.delay().numer_denom_ms();
        self.delay = f64::from(milliseconds) / f64::from(parts.max(1)) / 1000.0;
        let image = frame.into_buffer();
        let (width, height) = image.dimensions();
        self.count += 1;
        self.pixels += u64::from(width) * u64::from(height);
        if self.count > MAX_FRAMES {
            return Err(Problem::FrameCount(self.count));
        }
        if self.pixels > MAX_ANIMATION {
            return Err(Problem::AnimationTooLarge);
        }
        Picture::new(width, height, image.into_raw())
    }
}

impl Iterator for Frames<'_> {
    type Item = Result<Picture, Problem>;

    /// The next frame. After a mistake there are no more.
    fn next(&mut self) -> Option<Self::Item> {
        if self.failed {
            return None;
        }
        let frame = self.frames.next()?;
        let frame = self.check(frame);
        self.failed = frame.is_err();
        Some(frame)
    }
}
