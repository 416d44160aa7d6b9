//! Colours: every character but white space has exactly one.

use crate::texts::{corpus, examples, soup};
use assist::highlight::highlight;
use trials::trials;

/// Checks that the pieces are in order and that only white space lies between them.
fn check(text: &str) {
    fn is_blank(text: &str) -> bool {
        text.chars().all(|c| c.is_whitespace() || c == '\u{feff}')
    }
    let mut end = 0;
    for (range, _) in highlight(text) {
        let between = &text[end..range.start];
        assert!(is_blank(between), "{between:?}");
        assert!(range.start < range.end);
        end = range.end;
    }
    assert!(is_blank(&text[end..]), "{:?}", &text[end..]);
}

#[test]
fn any_text_is_covered() {
    for project in examples().iter().chain(&corpus()) {
        for file in &project.files {
            check(&file.text);
        }
    }
    trials(|u| {
        check(&soup(u)?);
        let bytes: Vec<u8> = u.arbitrary()?;
        check(&String::from_utf8_lossy(&bytes));
        Ok(())
    })
    .cases(600);
}
