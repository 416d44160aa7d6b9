//! Any bytes as a dataset.
#![no_main]

use fuzzer::check;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let text = String::from_utf8_lossy(bytes);
    let project = check::project(&text, "sphere m0 1 0 0 0\n");
    let compiled = rats::compile(&project);
    check::result(&project, &compiled).expect("a sound scene");
    check::unrun(&text).expect("a text that can be coloured");
});
