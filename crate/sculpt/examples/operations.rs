//! A million random strokes, in blocks: each is checked, taken back and replayed. `operations [BLOCKS [FIRST]]`: blocks of
//! 1000 strokes, 1000 unless told.

#[path = "../tests/it/common/mod.rs"]
mod common;

fn main() {
    let mut numbers = std::env::args()
        .skip(1)
        .filter_map(|word| word.parse().ok());
    let blocks: u64 = numbers.next().unwrap_or(1000);
    let first: u64 = numbers.next().unwrap_or(1_000_000);
    let mut refused = 0;
    for block in 0..blocks {
        refused += common::run(first + block, 1000);
    }
    println!(
        "{} strokes, {refused} of them refused: all invariants held",
        blocks * 1000
    );
}
