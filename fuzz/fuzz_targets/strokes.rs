//! Texts of strokes: those without problems are replayed, whole and after being written again, to
//! the same mesh.
#![no_main]

use libfuzzer_sys::fuzz_target;
use sculpt::Script;

/// Vertices that a replay may visit.
const MOST_WORK: u64 = 200_000;

fn replayed(script: &Script) -> Option<String> {
    let mut clay = script
        .begin(&mut |_: &str| Err(String::from("no files here")))
        .ok()?;
    script.resume(&mut clay, 0, MOST_WORK).ok()?;
    Some(format!("{:?}", clay.to_triangles()))
}

fuzz_target!(|text: &str| {
    let Ok(script) = Script::parse(text) else {
        return;
    };
    let again = Script::parse(&script.to_string()).expect("a written script is parsed");
    assert_eq!(replayed(&script), replayed(&again));
});
