//! The command that the caret is in.

use crate::texts::{at_mark, corpus, one_file, soup};
use assist::signature;
use trials::trials;

/// The signature at `|` with the active parameter in brackets.
fn shows(text: &str, wanted: &str) {
    let (project, file, byte) = at_mark(text);
    let found = signature(&project, file, byte).map(|signature| {
        let mut shown = signature.command;
        for (index, part) in signature.parameters.iter().enumerate() {
            shown += " ";
            if signature.active == Some(index) {
                shown += &format!("«{}»", part.text);
            } else {
                shown += &part.text;
            }
        }
        shown
    });
    assert_eq!(found.as_deref().unwrap_or(""), wanted, "{text}");
}

#[test]
fn whose_turn_it_is() {
    shows("sphere|", "sphere sn r POS [option …]");
    shows("sphere |", "sphere «sn» r POS [option …]");
    shows("sphere s|", "sphere «sn» r POS [option …]");
    shows("sphere s |", "sphere sn «r» POS [option …]");
    shows("sphere s 1| 2 3 4", "sphere sn «r» POS [option …]");
    shows("sphere s 1 |", "sphere sn r «POS» [option …]");
    shows("sphere s 1 0 0 |", "sphere sn r «POS» [option …]");
    shows("sphere s 1 0 0 0 |", "sphere sn r POS «[option …]»");
    shows("sphere s 1 <0 0| 0>", "sphere sn r «POS» [option …]");
    shows("sphere s 1+|", "sphere sn «r» POS [option …]");
    shows("sphere s 1 + |", "sphere sn «r» POS [option …]");
    shows("chain s, C\nsphere |", "sphere «r» POS [option …]");
    shows("surface |", "surface «alias» [= old] [option …]");
    shows("surface s diff Red |", "surface alias [= old] «[option …]»");
    shows("surface s rad |", "surface … radius «r» [end]");
    shows("surface s {\n rad 1 2|\n}", "surface … radius r «[end]»");
    shows(
        "define leg(surface s, B, n = 2) {\n}\nleg a, 1 2 3, |",
        "leg s B «[n]»",
    );
    shows(
        "define leg(surface s, B, n = 2) {\n}\nleg a, n=|",
        "leg s B «[n]»",
    );
    shows("for i = 1 to |", "for i = a «to b» [step c] { … }");
    shows("if a < |", "if «condition» { … } [{ … }]");
    shows("sphere s 1 0 0 0 # |", "");
    shows("nosuch 1 |", "");
    shows("quit\n|", "");
}

#[test]
fn any_place() {
    for project in corpus() {
        let length = project.files[0].text.len();
        for byte in (0..length + 2).step_by(1 + length / 60) {
            if let Some(found) = signature(&project, 0, byte) {
                assert!(
                    found
                        .active
                        .is_none_or(|active| active < found.parameters.len())
                );
            }
        }
    }
    trials(|u| {
        let text = soup(u)?;
        let byte = u.int_in_range(0..=text.len() + 1)?;
        if let Some(found) = signature(&one_file(&text), 0, byte) {
            assert!(
                found
                    .active
                    .is_none_or(|active| active < found.parameters.len())
            );
        }
        Ok(())
    })
    .cases(600);
}
