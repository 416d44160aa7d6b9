//! Colours: every character but white space has exactly one.

use crate::texts::{corpus, examples, soup};
use arbtest::arbtest;
use assist::highlight::highlight;

/// Checks that the pieces are in order and that only white space lies between them.
fn check(text: &str) {
    let mut end = 0;
    for (range, _) in highlight(text) {
        let between = text[end..range.start].trim_matches('\u{feff}');
        assert!(between.trim().is_empty(), "{between:?}");
        assert!(range.start < range.end);
        end = range.end;
    }
    assert!(text[end..].trim_matches('\u{feff}').trim().is_empty());
}

#[test]
fn any_text_is_covered() {
    for project in examples().iter().chain(&corpus()) {
        for file in &project.files {
            check(&file.text);
        }
    }
    arbtest(|u| {
        check(&soup(u)?);
        let bytes: Vec<u8> = u.arbitrary()?;
        check(&String::from_utf8_lossy(&bytes));
        Ok(())
    })
    .budget_ms(1500);
}
