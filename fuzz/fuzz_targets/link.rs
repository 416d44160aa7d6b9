//! Links, and what links carry.
#![no_main]

use fuzzer::check;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    check::link(&String::from_utf8_lossy(bytes)).expect("a sound link");
    check::link_content(bytes).expect("a sound content");
});
