//! The memory of very many elements, as Linux tells it.
#![cfg(target_os = "linux")]
use std::process::Command;

/// A tenth of a million elements have a tenth of their room, 1.5 GiB; `cargo xtask bench memory`
/// measures all of them.
#[test]
fn a_hundred_thousand_elements_are_traced_within_a_tenth_of_a_gibibyte_and_a_half() {
    let output = Command::new(env!("CARGO_BIN_EXE_sinew"))
        .args(["time", "--balls", "100000", "--size", "64", "64"])
        .output()
        .expect("the program starts");
    assert!(output.status.success());
    let figures: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let most = figures["memory"].as_f64().expect("what Linux tells");
    // Less than their places and sizes would be no measurement.
    let least = 100_000.0 * 32.0;
    assert!(
        (least..0.15 * f64::from(1 << 30)).contains(&most),
        "{most} bytes"
    );
    assert_eq!(figures["elements"], 100_000);
    // They are seen: every ray that meets one evaluates fields.
    assert!(figures["stats"]["field_evaluations"].as_u64() > Some(4096));
}
