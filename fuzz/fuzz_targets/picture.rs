//! Files of pictures and animations: the first byte chooses the format.
#![no_main]

use libfuzzer_sys::fuzz_target;
use picture::{Format, animation, file};

/// Larger pictures than this would only tell how fast memory is.
const MAX_PIXELS: u64 = 1 << 20;

fuzz_target!(|bytes: &[u8]| {
    let Some((choice, bytes)) = bytes.split_first() else {
        return;
    };
    let formats = [Format::Png, Format::Mtv, Format::Tga, Format::Tif, Format::Gif];
    let format = formats[usize::from(*choice) % formats.len()];
    if let Ok(picture) = file::decode_at_most(bytes, format, MAX_PIXELS) {
        let again = file::encode(&picture, Format::Png).expect("a PNG file holds any picture");
        assert!(file::decode(&again, Format::Png) == Ok(picture));
    }
    if let Ok(frames) = animation::frames(bytes, format) {
        let _ = frames.take(8).count();
    }
});
