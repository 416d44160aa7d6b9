//! Files are read by others' readers.

use matroska_demuxer::{Frame, MatroskaFile, TrackType};
use std::io::Cursor;
use video::{Codec, Colours, Error, Packet, Video, mp4, webm};

/// A configuration record for H.264's simplest profile, with one parameter set of each kind.
const RECORD: &[u8] = &[
    1, 66, 0, 31, 0xff, 0xe1, 0, 4, 0x67, 66, 0, 31, 1, 0, 2, 0x68, 0xce,
];

fn packets(count: u64) -> Vec<Packet> {
    let packets = (0..count).map(|number| Packet {
        time: number * 83_333,
        is_key: number % 10 == 0,
        bytes: vec![number as u8; 3 + number as usize % 7],
    });
    packets.collect()
}

fn video(codec: Codec, packets: Vec<Packet>) -> Video {
    Video {
        codec,
        size: [322, 200],
        frame_time: 83_333,
        colours: Colours::BT709,
        packets,
    }
}

#[test]
fn webm_is_read_back() {
    let made = video(Codec::Vp9, packets(25));
    let bytes = webm(&made).unwrap();
    let mut file = MatroskaFile::open(Cursor::new(&bytes)).unwrap();
    assert_eq!(file.ebml_header().doc_type(), "webm");
    let duration = file.info().duration().unwrap();
    assert!((duration - 25.0 * 83.333).abs() < 1e-6, "{duration}");
    let [track] = file.tracks() else {
        panic!("one track")
    };
    assert_eq!(track.track_type(), TrackType::Video);
    assert_eq!(track.codec_id(), "V_VP9");
    let frame = track.video().unwrap();
    assert_eq!(frame.pixel_width().get(), 322);
    assert_eq!(frame.pixel_height().get(), 200);
    let mut next = Frame::default();
    for packet in &made.packets {
        assert!(file.next_frame(&mut next).unwrap());
        assert_eq!(
            (&next.data, next.is_keyframe),
            (&packet.bytes, Some(packet.is_key))
        );
        let late = next.timestamp as f64 - packet.time as f64 / 1e3;
        assert!(late.abs() <= 0.5, "{late} ms");
    }
    assert!(!file.next_frame(&mut next).unwrap());
    // The table of places leads to clusters.
    file.seek(900).unwrap();
    assert!(file.next_frame(&mut next).unwrap());
    assert_eq!(next.timestamp, 917);
}

#[test]
fn webm_of_one_key_frame_only_has_clusters_that_are_short_enough() {
    let packets = (0..100).map(|number| Packet {
        time: number * 1_000_000,
        is_key: number == 0,
        bytes: vec![1],
    });
    let bytes = webm(&video(Codec::Vp8, packets.collect())).unwrap();
    let mut file = MatroskaFile::open(Cursor::new(&bytes)).unwrap();
    let mut next = Frame::default();
    for second in 0..100 {
        assert!(file.next_frame(&mut next).unwrap());
        assert_eq!(next.timestamp, second * 1000);
    }
}

#[test]
fn mp4_is_read_back() {
    let configuration = RECORD.to_vec();
    let made = video(Codec::H264 { configuration }, packets(25));
    let bytes = mp4(&made).unwrap();
    let context = mp4parse::read_mp4(&mut Cursor::new(&bytes)).unwrap();
    let [track] = &context.tracks[..] else {
        panic!("one track")
    };
    assert_eq!(track.track_type, mp4parse::TrackType::Video);
    assert_eq!(track.duration.as_ref().unwrap().0, 25 * 83_333);
    let entries = &track.stsd.as_ref().unwrap().descriptions;
    let mp4parse::SampleEntry::Video(entry) = &entries[0] else {
        panic!("a video")
    };
    assert_eq!((entry.width, entry.height), (322, 200));
    assert_eq!(entry.codec_type, mp4parse::CodecType::H264);
    let mp4parse::VideoCodecSpecific::AVCConfig(record) = &entry.codec_specific else {
        panic!("H.264")
    };
    assert_eq!(&record[..], RECORD);
    let sizes = &track.stsz.as_ref().unwrap().sample_sizes;
    let mut at = track.stco.as_ref().unwrap().offsets[0] as usize;
    assert_eq!(sizes.len(), 25);
    for (packet, size) in made.packets.iter().zip(sizes.iter()) {
        assert_eq!(&bytes[at..at + *size as usize], &packet.bytes);
        at += *size as usize;
    }
    assert_eq!(at, bytes.len());
    let keys = &track.stss.as_ref().unwrap().samples;
    assert_eq!(keys[..], [1, 11, 21]);
    assert!(track.ctts.is_none());
}

#[test]
fn frames_that_are_shown_in_another_order_are_delayed() {
    let mut packets = packets(4);
    packets.swap(1, 2);
    let configuration = RECORD.to_vec();
    let bytes = mp4(&video(Codec::H264 { configuration }, packets)).unwrap();
    let context = mp4parse::read_mp4(&mut Cursor::new(&bytes)).unwrap();
    let delays = &context.tracks[0].ctts.as_ref().unwrap().samples;
    let delays: Vec<i64> = delays
        .iter()
        .map(|run| match run.time_offset {
            mp4parse::TimeOffsetVersion::Version0(delay) => delay.into(),
            mp4parse::TimeOffsetVersion::Version1(delay) => delay.into(),
        })
        .collect();
    assert_eq!(delays, [0, 83_333, -83_333, 0]);
}

#[test]
fn what_cannot_be_written_is_told() {
    assert_eq!(webm(&video(Codec::Vp9, Vec::new())), Err(Error::NoStart));
    let later = packets(3).split_off(1);
    assert_eq!(webm(&video(Codec::Vp9, later)), Err(Error::NoStart));
    let empty = Video {
        size: [0, 2],
        ..video(Codec::Vp9, packets(1))
    };
    assert_eq!(webm(&empty), Err(Error::Empty));
    let mut long = video(Codec::Vp9, packets(2));
    long.packets[1].time = u64::MAX;
    assert_eq!(webm(&long), Err(Error::TooLong));
    assert_eq!(mp4(&video(Codec::Vp9, packets(1))), Err(Error::Codec));
    let configuration = RECORD.to_vec();
    let h264 = video(Codec::H264 { configuration }, packets(1));
    assert_eq!(webm(&h264), Err(Error::Codec));
}
