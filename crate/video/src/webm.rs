//! WebM: a file of nested elements (EBML, RFC 8794; Matroska, RFC 9559).

use crate::{Codec, Error, Packet, Video};

// Identifiers of elements.
const EBML: u32 = 0x1a45_dfa3;
const SEGMENT: u32 = 0x1853_8067;
const INFO: u32 = 0x1549_a966;
const TRACKS: u32 = 0x1654_ae6b;
const CUES: u32 = 0x1c53_bb6b;
const CLUSTER: u32 = 0x1f43_b675;
const TIMESTAMP: u32 = 0xe7;
const SIMPLE_BLOCK: u32 = 0xa3;

/// Nanoseconds of the file's unit of time.
const UNIT: u64 = 1_000_000;

/// Most units from a cluster's start to its frames, whose offsets have 16 bits.
const LONGEST: u64 = 30_000;

/// A WebM file of a video in VP8 or VP9.
///
/// # Errors
/// If the video has no frames, or is too long or otherwise encoded.
pub fn webm(video: &Video) -> Result<Vec<u8>, Error> {
    video.check()?;
    let codec = match video.codec {
        Codec::Vp8 => "V_VP8",
        Codec::Vp9 => "V_VP9",
        Codec::H264 { .. } => return Err(Error::Codec),
    };
    let mut head = Vec::new();
    let duration = (video.end() as f64) * 1e3 / UNIT as f64;
    let info = [
        number(0x2a_d7b1, UNIT),
        element(0x4489, &duration.to_be_bytes()),
        element(0x4d80, b"Sinew"),
        element(0x5741, b"Sinew"),
    ];
    head.extend(element(INFO, &info.concat()));
    head.extend(element(TRACKS, &track(video, codec)));

    let clusters = clusters(video);
    // The places of the clusters come before them and have a fixed length.
    let mut place = (head.len() + cues(&vec![(0, 0); clusters.len()]).len()) as u64;
    let mut places = Vec::new();
    for (time, cluster) in &clusters {
        places.push((*time, place));
        place += cluster.len() as u64;
    }
    head.extend(cues(&places));
    for (_, cluster) in clusters {
        head.extend(cluster);
    }

    let kind = [
        number(0x4286, 1),
        number(0x42f7, 1),
        number(0x42f2, 4),
        number(0x42f3, 8),
        element(0x4282, b"webm"),
        number(0x4287, 4),
        number(0x4285, 2),
    ];
    let mut file = element(EBML, &kind.concat());
    file.extend(element(SEGMENT, &head));
    Ok(file)
}

fn track(video: &Video, codec: &str) -> Vec<u8> {
    let colours = video.colours;
    let colour = [
        number(0x55b1, colours.matrix.into()),
        number(0x55b9, if colours.full_range { 2 } else { 1 }),
        number(0x55ba, colours.transfer.into()),
        number(0x55bb, colours.primaries.into()),
    ];
    let frame = [
        number(0xb0, video.size[0].into()),
        number(0xba, video.size[1].into()),
        element(0x55b0, &colour.concat()),
    ];
    let entry = [
        number(0xd7, 1),
        number(0x73c5, 1),
        // A video, without gaps.
        number(0x83, 1),
        number(0x9c, 0),
        number(0x23_e383, video.frame_time * 1000),
        element(0x86, codec.as_bytes()),
        element(0xe0, &frame.concat()),
    ];
    element(0xae, &entry.concat())
}

/// Clusters of frames, each beginning with one that can be decoded by itself where possible, with
/// their times.
fn clusters(video: &Video) -> Vec<(u64, Vec<u8>)> {
    let time = |packet: &Packet| (packet.time * 1000 + UNIT / 2) / UNIT;
    let mut clusters: Vec<(u64, Vec<u8>)> = Vec::new();
    for packet in &video.packets {
        let time = time(packet);
        let opens = match clusters.last() {
            None => true,
            Some((start, _)) => packet.is_key || !(*start..=start + LONGEST).contains(&time),
        };
        if opens {
            clusters.push((time, number(TIMESTAMP, time)));
        }
        if let Some((start, cluster)) = clusters.last_mut() {
            let [high, low] = ((time - *start) as u16).to_be_bytes();
            let flags = if packet.is_key { 0x80 } else { 0 };
            let mut block = vec![0x81, high, low, flags];
            block.extend(&packet.bytes);
            cluster.extend(element(SIMPLE_BLOCK, &block));
        }
    }
    let wrapped = clusters.into_iter();
    wrapped
        .map(|(time, content)| (time, element(CLUSTER, &content)))
        .collect()
}

/// Returns the index of clusters, from their times and places, bytes from the segment's start.
fn cues(places: &[(u64, u64)]) -> Vec<u8> {
    let points = places.iter().flat_map(|(time, place)| {
        let position = [number(0xf7, 1), element(0xf1, &place.to_be_bytes())];
        let point = [
            element(0xb3, &time.to_be_bytes()),
            element(0xb7, &position.concat()),
        ];
        element(0xbb, &point.concat())
    });
    element(CUES, &points.collect::<Vec<u8>>())
}

/// An element: its identifier, its length in eight bytes, its content.
fn element(id: u32, content: &[u8]) -> Vec<u8> {
    let skipped = id.leading_zeros() as usize / 8;
    let mut bytes = id.to_be_bytes()[skipped..].to_vec();
    bytes.extend((content.len() as u64 | 1 << 56).to_be_bytes());
    bytes.extend(content);
    bytes
}

/// An element with a whole number.
fn number(id: u32, value: u64) -> Vec<u8> {
    let skipped = (value.leading_zeros() as usize / 8).min(7);
    element(id, &value.to_be_bytes()[skipped..])
}
