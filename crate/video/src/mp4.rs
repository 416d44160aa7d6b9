//! MP4: a file of nested boxes (ISO/IEC 14496-12 and -15).

use crate::{Codec, Error, Video};

/// Units of time in a second.
const SECOND: u64 = 1_000_000;

/// The matrix of a picture that is shown as it is, not turned.
const UPRIGHT: [u32; 9] = [0x1_0000, 0, 0, 0, 0x1_0000, 0, 0, 0, 0x4000_0000];

/// An MP4 file of a video in H.264. The description stands before the frames, so that players can
/// begin before all of it has come.
///
/// # Errors
/// If the video has no frames, or is too long or otherwise encoded.
pub fn mp4(video: &Video) -> Result<Vec<u8>, Error> {
    video.check()?;
    let Codec::H264 { configuration } = &video.codec else {
        return Err(Error::Codec);
    };
    let kind = atom(b"ftyp", &[b"isom", &[0, 0, 2, 0], b"isomiso2avc1mp41"]);
    // The length of the description does not depend on where the frames begin.
    let length = movie(video, configuration, 0).len();
    let start = kind.len() + length + 8;
    let mut file = kind;
    file.extend(movie(video, configuration, start as u32));
    let frames: Vec<&[u8]> = video.packets.iter().map(|p| p.bytes.as_slice()).collect();
    file.extend(atom(b"mdat", &frames));
    Ok(file)
}

/// The description of the file, whose frames begin at a byte of it.
fn movie(video: &Video, configuration: &[u8], start: u32) -> Vec<u8> {
    let end = video.end();
    let [width, height] = video.size.map(|side| u32::from(side) << 16);
    let matrix = words(&UPRIGHT);
    // Version 1, as the times may need more than 32 bits.
    let movie_head = [
        &[1, 0, 0, 0][..],
        &head(&words(&[SECOND as u32])),
        &end.to_be_bytes(),
        // At its own speed and loudness.
        &words(&[0x1_0000, 0x0100_0000, 0, 0]),
        &matrix,
        &[0; 24],
        &words(&[2]),
    ];
    let track_head = [
        // On, and part of the film.
        &[1, 0, 0, 3][..],
        &head(&words(&[1, 0])),
        &end.to_be_bytes(),
        &[0; 16],
        &matrix,
        &words(&[width, height]),
    ];
    let media_head = [
        &[1, 0, 0, 0][..],
        &head(&words(&[SECOND as u32])),
        &end.to_be_bytes(),
        // No language.
        &[0x55, 0xc4, 0, 0],
    ];
    let handler = [&[0; 8][..], b"vide", &[0; 12], b"Frames\0"];
    let here = atom(b"url ", &[&[0, 0, 0, 1]]);
    let data = atom(b"dref", &[&words(&[0, 1]), &here]);
    let information = atom(
        b"minf",
        &[
            &atom(b"vmhd", &[&[0, 0, 0, 1], &[0; 8]]),
            &atom(b"dinf", &[&data]),
            &samples(video, configuration, start),
        ],
    );
    let media = atom(
        b"mdia",
        &[
            &atom(b"mdhd", &media_head),
            &atom(b"hdlr", &handler),
            &information,
        ],
    );
    let track = atom(b"trak", &[&atom(b"tkhd", &track_head), &media]);
    atom(b"moov", &[&atom(b"mvhd", &movie_head), &track])
}

/// Returns two times that nobody asks for, and what comes after them.
fn head(after: &[u8]) -> Vec<u8> {
    [&0_u64.to_be_bytes(), &0_u64.to_be_bytes(), after].concat()
}

/// The tables of frames.
fn samples(video: &Video, configuration: &[u8], start: u32) -> Vec<u8> {
    let packets = &video.packets;
    let count = packets.len() as u32;
    // Frames are decoded in the order of the file and shown in that of their times.
    let mut decoded: Vec<u64> = packets.iter().map(|packet| packet.time).collect();
    decoded.sort_unstable();
    let ends = decoded.iter().skip(1).copied().chain([video.end()]);
    let lasts: Vec<u32> = ends
        .zip(&decoded)
        .map(|(end, at)| (end - at) as u32)
        .collect();
    let shown = packets.iter().zip(&decoded);
    let delays: Vec<u32> = shown
        .map(|(packet, at)| (packet.time as i64 - *at as i64) as i32 as u32)
        .collect();
    let keys: Vec<u32> = (1..)
        .zip(packets)
        .filter_map(|(number, packet)| packet.is_key.then_some(number))
        .collect();
    let sizes: Vec<u32> = packets.iter().map(|p| p.bytes.len() as u32).collect();

    let mut tables = vec![
        atom(b"stsd", &[&words(&[0, 1]), &entry(video, configuration)]),
        atom(b"stts", &[&words(&[0]), &runs(&lasts)]),
        atom(b"stss", &[&words(&[0, keys.len() as u32]), &words(&keys)]),
        // All frames in one piece.
        atom(b"stsc", &[&words(&[0, 1, 1, count, 1])]),
        atom(b"stsz", &[&words(&[0, 0, count]), &words(&sizes)]),
        atom(b"stco", &[&words(&[0, 1, start])]),
    ];
    if delays.iter().any(|delay| *delay != 0) {
        tables.push(atom(b"ctts", &[&[1, 0, 0, 0], &runs(&delays)]));
    }
    let tables: Vec<&[u8]> = tables.iter().map(Vec::as_slice).collect();
    atom(b"stbl", &tables)
}

/// Returns the sample entry, which says how the frames are encoded.
fn entry(video: &Video, configuration: &[u8]) -> Vec<u8> {
    let [width, height] = video.size.map(u16::to_be_bytes);
    let colours = video.colours;
    let range = if colours.full_range { 0x80 } else { 0 };
    let code = [
        0,
        colours.primaries,
        0,
        colours.transfer,
        0,
        colours.matrix,
        range,
    ];
    atom(
        b"avc1",
        &[
            // The only data there is.
            &[0, 0, 0, 0, 0, 0, 0, 1],
            &[0; 16],
            &width,
            &height,
            // 72 dots an inch, one frame a sample, no name, 24 bits.
            &words(&[0x48_0000, 0x48_0000, 0]),
            &[0, 1],
            &[0; 32],
            &[0, 24, 0xff, 0xff],
            &atom(b"avcC", &[configuration]),
            &atom(b"colr", &[b"nclx", &code]),
        ],
    )
}

/// A table of equal numbers in a row: how many runs, and of each its length and its number.
fn runs(numbers: &[u32]) -> Vec<u8> {
    let runs: Vec<u32> = numbers
        .chunk_by(|a, b| a == b)
        .flat_map(|run| [run.len() as u32, run[0]])
        .collect();
    let count = [runs.len() as u32 / 2];
    [words(&count), words(&runs)].concat()
}

fn words(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_be_bytes()).collect()
}

/// A box: its length, its name, its content.
fn atom(name: &[u8; 4], content: &[&[u8]]) -> Vec<u8> {
    let length: usize = content.iter().map(|part| part.len()).sum();
    let mut bytes = ((length + 8) as u32).to_be_bytes().to_vec();
    bytes.extend(name);
    for part in content {
        bytes.extend(*part);
    }
    bytes
}
