//! What pictures show, against the true surface: no hit further from it than the tolerance, nothing missed
//! that is thicker, nothing invented. The same on a million rays: `cargo run --release -p tracer
//! --example certify`.
#![cfg(not(target_arch = "wasm32"))]
mod common;
#[path = "common/trials.rs"]
mod trials;

use field::Kernel;
use trials::{KINDS, Kind, Row, check};

#[test]
fn pictures_are_within_the_tolerance_of_the_true_surface() {
    let mut told = String::new();
    let mut total = Row::default();
    for kernel in Kernel::ALL {
        for kind in KINDS {
            let (scenes, packets) = match kind {
                Kind::Cluster => (1, 2),
                _ => (4, 6),
            };
            for seed in 0..scenes {
                let row = check(
                    kernel,
                    kind,
                    seed,
                    packets,
                    &|p, rays| p.cast(rays),
                    &mut told,
                );
                total.add(&row);
            }
        }
    }
    assert!(total.rays > 15_000 && total.hits > 5_000, "{total:?}");
    assert!(total.faults() == 0, "{total:?}\n{told}");
}
