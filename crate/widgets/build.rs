//! Writes the two fonts of the page without their hinting programs.
//!
//! Half of a font's bytes are programs that move its outlines to whole pixels; the page draws its
//! letters with a hinter that needs none (see `src/fonts.rs`). The outlines, the widths, the
//! kerning and the notice of the font's authors stay as they are.

use std::path::Path;

/// Tables of a TrueType font that only hinting and old printers need.
const LEFT_OUT: [&[u8; 4]; 9] = [
    b"fpgm", b"prep", b"cvt ", b"hdmx", b"VDMX", b"LTSH", b"gasp", b"TTFA", b"DSIG",
];

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let folder = std::env::var("OUT_DIR").expect("cargo sets it");
    for (name, font) in [
        ("sans.ttf", epaint_default_fonts::UBUNTU_LIGHT),
        ("mono.ttf", epaint_default_fonts::HACK_REGULAR),
    ] {
        let lean = lean(font).unwrap_or_else(|| panic!("{name} is not a TrueType font"));
        std::fs::write(Path::new(&folder).join(name), lean).expect("cargo's folder can be written");
    }
}

fn u16_at(bytes: &[u8], at: usize) -> Option<usize> {
    let bytes = bytes.get(at..at + 2)?;
    Some(usize::from(u16::from_be_bytes(bytes.try_into().ok()?)))
}

fn u32_at(bytes: &[u8], at: usize) -> Option<usize> {
    let bytes = bytes.get(at..at + 4)?;
    usize::try_from(u32::from_be_bytes(bytes.try_into().ok()?)).ok()
}

/// Returns a font without hinting; `None` if it cannot be understood.
fn lean(font: &[u8]) -> Option<Vec<u8>> {
    let count = u16_at(font, 4)?;
    let mut tables: Vec<([u8; 4], Vec<u8>)> = Vec::new();
    for entry in 0..count {
        let entry = 12 + 16 * entry;
        let tag: [u8; 4] = font.get(entry..entry + 4)?.try_into().ok()?;
        let start = u32_at(font, entry + 8)?;
        let bytes = font.get(start..start + u32_at(font, entry + 12)?)?;
        tables.push((tag, bytes.to_vec()));
    }
    let table = |tag: &[u8; 4]| {
        let found = tables.iter().position(|(name, _)| name == tag)?;
        Some((found, tables[found].1.clone()))
    };
    let (head, mut head_bytes) = table(b"head")?;
    let (loca, loca_bytes) = table(b"loca")?;
    let (glyf, glyf_bytes) = table(b"glyf")?;
    let (post, post_bytes) = table(b"post")?;
    let long = u16_at(&head_bytes, 50)? == 1;
    let starts: Vec<usize> = if long {
        let words = loca_bytes.chunks_exact(4);
        words.map(|word| u32_at(word, 0)).collect::<Option<_>>()?
    } else {
        let words = loca_bytes.chunks_exact(2);
        words
            .map(|word| Some(2 * u16_at(word, 0)?))
            .collect::<Option<_>>()?
    };
    let (mut glyphs, mut places) = (Vec::new(), vec![0_u32]);
    for pair in starts.windows(2) {
        glyphs.extend(glyph(glyf_bytes.get(pair[0]..pair[1])?)?);
        // Glyphs begin at words.
        glyphs.resize(glyphs.len().next_multiple_of(4), 0);
        places.push(u32::try_from(glyphs.len()).ok()?);
    }
    head_bytes[50..52].copy_from_slice(&1_u16.to_be_bytes());
    tables[head].1 = head_bytes;
    tables[loca].1 = places.into_iter().flat_map(u32::to_be_bytes).collect();
    tables[glyf].1 = glyphs;
    // Version 3: without the names of the glyphs, which only printers ask for.
    let mut nameless = post_bytes.get(..32)?.to_vec();
    nameless[..4].copy_from_slice(&0x0003_0000_u32.to_be_bytes());
    tables[post].1 = nameless;
    tables.retain(|(tag, _)| !LEFT_OUT.contains(&tag));
    Some(assemble(&font[..4], &tables))
}

/// Returns a glyph without its instructions. Its outline follows them (or, if it is made of other
/// glyphs, goes before them).
fn glyph(bytes: &[u8]) -> Option<Vec<u8>> {
    const WORDS: usize = 0x0001;
    const SCALE: usize = 0x0008;
    const MORE: usize = 0x0020;
    const TWO_SCALES: usize = 0x0040;
    const MATRIX: usize = 0x0080;
    const INSTRUCTIONS: usize = 0x0100;
    if bytes.is_empty() {
        return Some(Vec::new());
    }
    let contours = u16_at(bytes, 0)?;
    if contours < 0x8000 {
        let length = 10 + 2 * contours;
        let outline = bytes.get(length + 2 + u16_at(bytes, length)?..)?;
        return Some([&bytes[..length], &[0, 0], outline].concat());
    }
    let mut parts = bytes.to_vec();
    let mut at = 10;
    loop {
        let flags = u16_at(bytes, at)?;
        let without = u16::try_from(flags & !INSTRUCTIONS).ok()?;
        parts[at..at + 2].copy_from_slice(&without.to_be_bytes());
        at += if flags & WORDS == 0 { 6 } else { 8 };
        at += match flags & (SCALE | TWO_SCALES | MATRIX) {
            SCALE => 2,
            TWO_SCALES => 4,
            MATRIX => 8,
            _ => 0,
        };
        if flags & MORE == 0 {
            break;
        }
    }
    parts.truncate(at);
    (parts.len() == at).then_some(parts)
}

fn assemble(kind: &[u8], tables: &[([u8; 4], Vec<u8>)]) -> Vec<u8> {
    let count = tables.len() as u16;
    let power = count.ilog2() as u16;
    let mut font = kind.to_vec();
    for word in [count, 16 << power, power, 16 * count - (16 << power)] {
        font.extend(word.to_be_bytes());
    }
    let mut start = 12 + 16 * tables.len();
    for (tag, bytes) in tables {
        let sum = bytes.chunks(4).fold(0_u32, |sum, chunk| {
            let mut word = [0; 4];
            word[..chunk.len()].copy_from_slice(chunk);
            sum.wrapping_add(u32::from_be_bytes(word))
        });
        font.extend(tag);
        for word in [sum, start as u32, bytes.len() as u32] {
            font.extend(word.to_be_bytes());
        }
        start += bytes.len().next_multiple_of(4);
    }
    for (_, bytes) in tables {
        font.extend(bytes);
        font.resize(font.len().next_multiple_of(4), 0);
    }
    font
}
