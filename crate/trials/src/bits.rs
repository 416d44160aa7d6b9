//! Hashes of results that have the same bits on every platform, kept in a text file.

use core::fmt::Write;

/// An FNV-1a hash of bit patterns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hash(u64);

impl Default for Hash {
    fn default() -> Self {
        Self(0xCBF2_9CE4_8422_2325)
    }
}

impl Hash {
    /// Returns the hash of bytes.
    pub fn of(bytes: &[u8]) -> Self {
        let mut hash = Self::default();
        hash.bytes(bytes);
        hash
    }

    /// Adds bytes.
    pub fn bytes(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01B3);
        }
    }

    /// Adds numbers; every NaN is the same, as its bits are left to the platform.
    pub fn numbers(&mut self, numbers: impl IntoIterator<Item = f64>) {
        for x in numbers {
            let x = if x.is_nan() { f64::NAN } else { x };
            self.bytes(&x.to_bits().to_le_bytes());
        }
    }
}

/// Compares hashes with kept ones, lines `NAME HASH` of a file. With `UPDATE_EXPECT=1` it writes
/// the file instead, natively.
///
/// ```no_run
/// let mut hash = trials::bits::Hash::default();
/// hash.numbers([libm::sin(1.0), libm::cos(1.0)]);
/// let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/bits.txt");
/// let kept = "circle 5e1f7ed2f2b4e7b6"; // include_str!("../bits.txt")
/// trials::bits::compare(&[("circle".into(), hash)], kept, path);
/// ```
///
/// # Panics
/// If they differ, with the names of those that do.
pub fn compare(found: &[(String, Hash)], kept: &str, path: &str) {
    let mut text = String::new();
    for (name, Hash(hash)) in found {
        let _ = writeln!(text, "{name} {hash:016x}");
    }
    if cfg!(not(target_arch = "wasm32")) && std::env::var_os("UPDATE_EXPECT").is_some() {
        std::fs::write(path, text).unwrap_or_else(|error| panic!("{path}: {error}"));
        return;
    }
    let [new, old] = [&text[..], kept].map(|text| text.lines().collect::<Vec<_>>());
    let changed = new.iter().filter(|line| !old.contains(line));
    let gone = old.iter().filter(|line| !new.contains(line));
    let differing: Vec<String> = (changed.map(|line| format!("now  {line}")))
        .chain(gone.map(|line| format!("kept {line}")))
        .collect();
    assert!(
        differing.is_empty(),
        "bits differ from those kept in {path}:\n{}\nIf that is meant, and they differ natively, \
         too: run the test with UPDATE_EXPECT=1. Bits that differ only as wasm are a fault.",
        differing.join("\n")
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hash(number: f64) -> Hash {
        let mut hash = Hash::default();
        hash.numbers([number]);
        hash
    }

    #[test]
    fn hashes_tell_numbers_apart() {
        // FNV-1a's published value.
        assert_eq!(Hash::of(b"foobar"), Hash(0x8594_4171_F739_67E8));
        assert_ne!(hash(1.0), hash(1.0_f64.next_up()));
        assert_ne!(hash(0.0), hash(-0.0));
        assert_eq!(hash(f64::NAN), hash(-f64::NAN));
    }

    #[test]
    fn names_of_differing_hashes_are_shown() {
        let found = [1.0, 2.0].map(|x| (format!("number {x}"), hash(x)));
        let text = found
            .iter()
            .map(|(name, Hash(hash))| format!("{name} {hash:016x}\n"));
        let text: String = text.collect();
        compare(&found, &text, "/nowhere");
        for kept in [text.replace("number 2", "number 3"), String::new()] {
            let error = std::panic::catch_unwind(|| compare(&found, &kept, "/nowhere"));
            let error = error.expect_err("they differ");
            let message = error.downcast_ref::<String>().expect("a message");
            assert!(message.contains("now  number 2 "), "{message}");
        }
    }
}
