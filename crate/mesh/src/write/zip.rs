//! Zip archives, without a date.

use miniz_oxide::deflate::compress_to_vec;

/// Effort of packing, 0 … 10.
const LEVEL: u8 = 6;

/// An archive of members: names and contents. Names must be ASCII.
pub(super) fn archive(members: &[(&str, &[u8])]) -> Vec<u8> {
    let mut bytes: Vec<u8> = Vec::new();
    let mut directory: Vec<u8> = Vec::new();
    for (name, contents) in members {
        let packed = compress_to_vec(contents, LEVEL);
        let start = bytes.len() as u32;
        // What the member's heading and the directory have in common.
        let mut common: Vec<u8> = Vec::new();
        // Version 2.0, no flags, deflated, midnight on 1 January 1980.
        for word in [20_u16, 0, 8, 0, 0x21] {
            common.extend(word.to_le_bytes());
        }
        for word in [
            checksum(contents),
            packed.len() as u32,
            contents.len() as u32,
        ] {
            common.extend(word.to_le_bytes());
        }
        for word in [name.len() as u16, 0] {
            common.extend(word.to_le_bytes());
        }
        bytes.extend(b"PK\x03\x04");
        bytes.extend(&common);
        bytes.extend(name.as_bytes());
        bytes.extend(&packed);
        directory.extend(b"PK\x01\x02\x14\x00");
        directory.extend(&common);
        // No comment, first disk, no attributes.
        directory.extend([0; 10]);
        directory.extend(start.to_le_bytes());
        directory.extend(name.as_bytes());
    }
    let start = bytes.len() as u32;
    bytes.extend(&directory);
    bytes.extend(b"PK\x05\x06\x00\x00\x00\x00");
    for word in [members.len() as u16; 2] {
        bytes.extend(word.to_le_bytes());
    }
    for word in [directory.len() as u32, start] {
        bytes.extend(word.to_le_bytes());
    }
    bytes.extend([0; 2]);
    bytes
}

/// CRC-32 (polynomial 0xEDB88320, reflected).
fn checksum(bytes: &[u8]) -> u32 {
    let table: [u32; 256] = core::array::from_fn(|i| {
        (0..8).fold(i as u32, |crc, _| {
            (crc >> 1) ^ (0xEDB8_8320 & (crc & 1).wrapping_neg())
        })
    });
    let step = |crc: u32, byte: &u8| table[((crc ^ u32::from(*byte)) & 255) as usize] ^ (crc >> 8);
    !bytes.iter().fold(u32::MAX, step)
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_checksum_is_the_known_one() {
        assert_eq!(super::checksum(b"123456789"), 0xCBF4_3926);
    }
}
