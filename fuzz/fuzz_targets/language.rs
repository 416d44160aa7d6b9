//! Datasets that are nearly right.
#![no_main]

use arbitrary::Unstructured;
use fuzzer::{check, generate};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = generate::dataset(&mut Unstructured::new(bytes)) else {
        return;
    };
    let project = check::project(&text, "sphere m0 1 0 0 0\n");
    let compiled = rats::compile(&project);
    check::result(&project, &compiled).expect("a sound scene");
    check::repeats(&project, &compiled).expect("the same scene");
    check::layout(&project, &compiled).expect("the same meaning");
    check::sharing(&project).expect("the same project");
});
