//! Clouds of points and outlines: the first byte chooses.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let Some((choice, bytes)) = bytes.split_first() else {
        return;
    };
    match choice % 3 {
        0 => drop(fit::cloud("cloud.ply", bytes)),
        1 => drop(fit::cloud("cloud.xyz", bytes)),
        _ => {
            if let Ok(outlines) = fit::outlines(bytes) {
                let all = fit::sights(&outlines);
                assert!(all.iter().all(|sight| sight.direction.is_finite()));
            }
        }
    }
});
