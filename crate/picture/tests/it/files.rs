//! Files of pictures: what is written is read again, and no bytes do harm.
//!
//! Run with the feature `formats`; without it only PNG and MTV are tested.

use picture::animation::{Timing, Writer};
use picture::file::{decode, decode_at_most, encode, size};
use picture::{Format, Picture, Problem};
use std::path::Path;
use trials::trials;

#[cfg(feature = "formats")]
const FORMATS: &[Format] = &[
    Format::Png,
    Format::Mtv,
    Format::Tga,
    Format::Tif,
    Format::Gif,
    Format::Jpg,
];
#[cfg(not(feature = "formats"))]
const FORMATS: &[Format] = &[Format::Png, Format::Mtv];

/// A picture of few colours, so that GIF can keep it.
fn sample(width: u32, height: u32, seed: u32) -> Picture {
    let pixels = (0..width * height)
        .flat_map(|i| {
            let k = (i.wrapping_mul(2_654_435_761) >> 27).wrapping_add(seed) as u8 & 15;
            [k * 16, 255 - k * 16, k * 3, 255]
        })
        .collect();
    Picture::new(width, height, pixels).expect("a picture")
}

#[test]
fn files_are_written_and_read_back() {
    for &format in FORMATS {
        for (width, height) in [(1, 1), (7, 3), (40, 30)] {
            let picture = sample(width, height, 0);
            #[cfg(feature = "formats")]
            if format == Format::Jpg {
                continue;
            }
            let bytes = encode(&picture, format).expect("written");
            let again = decode(&bytes, format).expect("read");
            assert!(again == picture, "{format:?} {width}×{height}");
        }
    }
}

#[test]
fn opacity_is_kept_where_there_is_room_for_it() {
    let mut pixels = sample(4, 4, 0).into_pixels();
    pixels[3] = 0;
    pixels[7] = 100;
    let picture = Picture::new(4, 4, pixels).expect("a picture");
    for &format in FORMATS {
        let bytes = encode(&picture, format).expect("written");
        let again = decode(&bytes, format).expect("read");
        match format {
            Format::Mtv => assert!(again.is_opaque()),
            #[cfg(feature = "formats")]
            Format::Jpg => assert!(again.is_opaque()),
            // A pixel of a GIF file shows through or does not.
            #[cfg(feature = "formats")]
            Format::Gif => assert_eq!(again.pixel(0, 0).map(|p| p[3]), Some(0)),
            _ => assert!(again == picture, "{format:?}"),
        }
    }
}

#[test]
fn endings_tell_the_format() {
    for (name, format) in [("a.png", Format::Png), ("b/c.d.MTV", Format::Mtv)] {
        assert_eq!(Format::of(Path::new(name)), Ok(format));
    }
    #[cfg(feature = "formats")]
    for (name, format) in [
        ("a.tga", Format::Tga),
        ("a.tif", Format::Tif),
        ("a.TIFF", Format::Tif),
        ("a.gif", Format::Gif),
        ("a.jpg", Format::Jpg),
        ("a.JPEG", Format::Jpg),
    ] {
        assert_eq!(Format::of(Path::new(name)), Ok(format));
    }
    for name in ["a.rat", "png", "", "a.webp"] {
        let problem = Format::of(Path::new(name)).expect_err("no format");
        assert!(problem.to_string().contains(".png"), "{problem}");
    }
}

/// Photographs keep their colours nearly, and are read with the same bits on every machine.
#[cfg(feature = "formats")]
#[test]
fn photographs_are_read() {
    let pixels = (0..21u8).flat_map(|y| (0..33u8).flat_map(move |x| [x * 7, y * 12, 128, 255]));
    let picture = Picture::new(33, 21, pixels.collect()).expect("a picture");
    let bytes = encode(&picture, Format::Jpg).expect("written");
    let again = decode(&bytes, Format::Jpg).expect("read");
    let differences = picture.pixels().iter().zip(again.pixels());
    let largest = differences.map(|(a, b)| a.abs_diff(*b)).max();
    assert!(
        largest.is_some_and(|value| (1..16).contains(&value)),
        "{largest:?}"
    );
    let sum = again.pixels().iter().fold(0_u32, |sum, &value| {
        sum.wrapping_mul(31).wrapping_add(u32::from(value))
    });
    assert_eq!(sum, 1_017_943_876);
}

#[test]
fn mtv_is_as_other_programs_write_it() {
    let picture = decode(b"2 1\n\x01\x02\x03\xff\x00\x10", Format::Mtv).expect("read");
    assert_eq!(picture.pixels(), [1, 2, 3, 255, 255, 0, 16, 255]);
    for (bytes, why) in [
        (&b""[..], "does not begin"),
        (b"12 12", "does not begin"),
        (
            b"                                 1 1\nabc",
            "does not begin",
        ),
        (b"2\nabcdef", "not `width height`"),
        (b"2 1 1\nabcdef", "not `width height`"),
        (b"-2 1\nabcdef", "not `width height`"),
        (b"\xff 1\nabcdef", "not `width height`"),
        (b"2 1\nabcde", "need 6 bytes, it has 5"),
        (b"0 1\nabcde", "0×1 pixels cannot be"),
        (b"65535 65535\nabc", "65535×65535 pixels cannot be"),
        (b"8192 8192\nabc", "need 201326592 bytes"),
    ] {
        let said = decode(bytes, Format::Mtv).expect_err("damaged").to_string();
        assert!(said.contains(why), "{said}");
    }
}

#[test]
fn size_is_checked_before_memory_is_set_aside() {
    for &format in FORMATS {
        let bytes = encode(&sample(40, 30, 0), format).expect("written");
        assert!(decode_at_most(&bytes, format, 1200).is_ok());
        assert_eq!(size(&bytes, format), Ok([40, 30]));
        assert!(size(&bytes[..4], format).is_err(), "{format:?}");
        assert_eq!(
            decode_at_most(&bytes, format, 1199),
            Err(Problem::NoRoom {
                size: [40, 30],
                most: 1199
            }),
            "{format:?}"
        );
    }
}

/// A PNG file whose header tells of more pixels than there are.
#[test]
fn a_boasting_file_is_refused() {
    let mut bytes = encode(&sample(4, 4, 0), Format::Png).expect("written");
    bytes[16..24].copy_from_slice(&[0, 0, 255, 255, 0, 0, 255, 255]);
    let crc = crc32(&bytes[12..29]);
    bytes[29..33].copy_from_slice(&crc.to_be_bytes());
    assert_eq!(
        decode(&bytes, Format::Png),
        Err(Problem::Size(65_535, 65_535))
    );
}

/// The checksum of PNG files, bit by bit.
fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |crc, _| {
            (crc >> 1) ^ (0xEDB8_8320 & (crc & 1).wrapping_neg())
        })
    })
}

#[test]
fn any_bytes_give_a_picture_or_a_sentence() {
    trials(|u| {
        let format = *u.choose(FORMATS)?;
        let mut bytes: Vec<u8> = if u.ratio(1, 4)? {
            u.arbitrary()?
        } else {
            encode(&sample(9, 7, u.arbitrary()?), format).expect("written")
        };
        for _ in 0..u.int_in_range(0..=6)? {
            if bytes.is_empty() {
                break;
            }
            let at = u.choose_index(bytes.len())?;
            match u.int_in_range(0..=2)? {
                0 => bytes[at] = u.arbitrary()?,
                1 => bytes.truncate(at),
                _ => bytes.insert(at, u.arbitrary()?),
            }
        }
        // A bound on memory as well: no sample has more pixels than this.
        match decode_at_most(&bytes, format, 1 << 16) {
            Ok(picture) => assert!(picture.pixels().len() <= 4 << 16),
            Err(problem) => assert!(!problem.to_string().is_empty()),
        }
        #[cfg(feature = "formats")]
        if let Ok(frames) = picture::animation::frames(&bytes, format) {
            let _ = frames.take(20).count();
        }
        Ok(())
    })
    .cases(1_000);
}

const TIMING: Timing = Timing {
    delay: 4,
    repeats: true,
};

#[test]
fn an_animation_counts_its_frames() {
    let frame = sample(8, 6, 0);
    for count in [0, 10_001] {
        let mut bytes = Vec::new();
        let begun = Writer::begin(&mut bytes, Format::Png, &frame, count, TIMING, false);
        assert_eq!(begun.map(drop), Err(Problem::FrameCount(count)));
    }
    let mut bytes = Vec::new();
    let mut writer =
        Writer::begin(&mut bytes, Format::Png, &frame, 2, TIMING, false).expect("begun");
    assert!(matches!(
        writer.add(&sample(6, 8, 0)),
        Err(Problem::DifferentSizes(..))
    ));
    writer.add(&frame).expect("added");
    assert_eq!(
        writer.add(&frame),
        Err(Problem::FramesAnnounced {
            announced: 2,
            given: 3
        })
    );
    let mut bytes = Vec::new();
    let short = Writer::begin(&mut bytes, Format::Png, &frame, 2, TIMING, false).expect("begun");
    assert!(short.finish().is_err());
    let mut bytes = Vec::new();
    let problem = Writer::begin(&mut bytes, Format::Mtv, &frame, 1, TIMING, false).map(drop);
    assert_eq!(problem, Err(Problem::NoAnimation("MTV")));
}

/// Readers without animations see the first frame.
#[test]
fn an_animated_png_is_a_picture_too() {
    let mut bytes = Vec::new();
    let mut writer =
        Writer::begin(&mut bytes, Format::Png, &sample(8, 6, 1), 2, TIMING, false).expect("begun");
    writer.add(&sample(8, 6, 2)).expect("added");
    writer.finish().expect("finished");
    assert!(decode(&bytes, Format::Png) == Ok(sample(8, 6, 1)));
}

#[cfg(feature = "formats")]
#[test]
fn animations_come_back_frame_by_frame() {
    for format in [Format::Png, Format::Gif] {
        let mut bytes = Vec::new();
        let mut writer =
            Writer::begin(&mut bytes, format, &sample(8, 6, 0), 3, TIMING, false).expect("begun");
        for seed in 1..3 {
            writer.add(&sample(8, 6, seed)).expect("added");
        }
        writer.finish().expect("finished");
        let frames: Vec<_> = picture::animation::frames(&bytes, format)
            .expect("an animation")
            .collect::<Result<_, _>>()
            .expect("whole frames");
        assert!(
            frames == [0, 1, 2].map(|seed| sample(8, 6, seed)),
            "{format:?}: {} frames",
            frames.len()
        );
        // Cut in the middle it ends with a mistake, and only one.
        let cut = &bytes[..bytes.len() / 2];
        if let Ok(frames) = picture::animation::frames(cut, format) {
            assert!(frames.filter(Result::is_err).count() <= 1);
        }
    }
    let still = encode(&sample(8, 6, 5), Format::Png).expect("written");
    let frames = picture::animation::frames(&still, Format::Png).expect("one frame");
    assert_eq!(frames.count(), 1);
    assert!(picture::animation::frames(&still, Format::Tga).is_err());
}

#[cfg(feature = "formats")]
#[test]
fn dots_mix_what_a_gif_lacks() {
    // A slow ramp through far more than 256 colours.
    let pixels = (0..512 * 512)
        .map(|i| (i % 512, i / 512))
        .flat_map(|(x, y)| [(x / 2) as u8, (y / 2) as u8, ((x + y) / 4) as u8, 255])
        .collect();
    let picture = Picture::new(512, 512, pixels).expect("a picture");
    let [plain, dithered] = [false, true].map(|dither| {
        let mut bytes = Vec::new();
        let writer = Writer::begin(&mut bytes, Format::Gif, &picture, 1, TIMING, dither);
        writer.and_then(Writer::finish).expect("written");
        let again = decode(&bytes, Format::Gif).expect("read");
        // The mean colour of each block of 16×16 is what the eye sees.
        let [a, b] = [&picture, &again].map(|all| picture::resize(all, 32, 32).expect("resized"));
        let errors = a.pixels().iter().zip(b.pixels());
        errors.map(|(a, b)| u64::from(a.abs_diff(*b))).sum::<u64>()
    });
    assert!(2 * dithered < plain, "{dithered} against {plain}");
}
