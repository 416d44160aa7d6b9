//! Results whose bits are to be the same on every platform.

use core::fmt::Write;

/// Returns the hash (FNV-1a) of bytes.
pub fn hash(bytes: impl IntoIterator<Item = u8>) -> u64 {
    bytes.into_iter().fold(0xCBF2_9CE4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01B3)
    })
}

/// Compares hashes with those of a file: a line for each, `NAME HASH`. Where `UPDATE_EXPECT` is set
/// the file is written anew.
///
/// `kept` is the file's text, as wasm can't read it: `include_str!("../bits.txt")`.
///
/// # Panics
/// If a hash differs, is missing, or is too much in the file; the message names each.
pub fn compare(kept: &str, path: &str, found: &[(&str, u64)]) {
    let lines = found
        .iter()
        .map(|(name, hash)| format!("{name} {hash:016x}"));
    let lines: Vec<String> = lines.collect();
    if std::env::var_os("UPDATE_EXPECT").is_some() {
        std::fs::write(path, lines.join("\n") + "\n").expect("the file of hashes can be written");
        return;
    }
    let mut differences = String::new();
    for line in &lines {
        if !kept.lines().any(|other| other == line) {
            let _ = writeln!(differences, "  now     {line}");
        }
    }
    for line in kept.lines() {
        if !lines.iter().any(|other| other == line) {
            let _ = writeln!(differences, "  before  {line}");
        }
    }
    assert!(
        differences.is_empty(),
        "These bits differ:\n{differences}If they are meant to change, run this test natively with \
         UPDATE_EXPECT=1, which writes {path} anew."
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hashes_are_fnv_1a() {
        assert_eq!(hash([]), 0xCBF2_9CE4_8422_2325);
        assert_eq!(hash(*b"foobar"), 0x8594_4171_F739_67E8);
    }

    #[test]
    fn same_hashes_pass() {
        compare("a 000000000000000a\n", "", &[("a", 10)]);
        compare("", "", &[]);
    }

    #[test]
    #[should_panic(expected = "  now     a 000000000000000b\n  before  a 000000000000000a\n")]
    fn another_hash_is_told() {
        compare("a 000000000000000a\n", "", &[("a", 11)]);
    }

    #[test]
    #[should_panic(expected = "  before  b 000000000000000a")]
    fn a_hash_that_is_no_longer_made_is_told() {
        compare("b 000000000000000a\n", "", &[]);
    }
}
