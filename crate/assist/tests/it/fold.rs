//! Folding texts.

use crate::texts::{corpus, examples, soup};
use assist::folds;
use trials::trials;

/// The first line of each and the line after its last.
fn lines(text: &str) -> Vec<(usize, usize)> {
    folds(text)
        .into_iter()
        .map(|fold| (fold.start, fold.end))
        .collect()
}

#[test]
fn comments_and_blocks_fold() {
    let text = "\
# a
# b
object A
  for i = 1 to 2 {
    arch s 1 { 1 2 3
      4 5 6
    }
  }
  # one line
close A
if a { quit }
if b {
  quit
} else if c {
  return
} else {
  quit
}
";
    assert_eq!(
        lines(text),
        [
            (0, 2),
            (2, 10),
            (3, 8),
            (4, 7),
            (11, 13),
            (13, 15),
            (15, 18)
        ]
    );
}

#[test]
fn braces_without_end_do_not_fold() {
    assert_eq!(lines("object A\n  sphere\nfor {\n}\n"), [(2, 4)]);
    assert_eq!(lines("for {\n { \n }\n"), [(1, 3)]);
    assert_eq!(lines("}\n}\nclose\nclose"), []);
    assert_eq!(lines(""), []);
}

fn check(text: &str) {
    let folds = folds(text);
    let lines = text.matches('\n').count() + 1;
    for (index, fold) in folds.iter().enumerate() {
        assert!(fold.len() >= 2 && fold.end <= lines, "{text:?} {fold:?}");
        for other in &folds[index + 1..] {
            assert!(fold.start < other.start, "{text:?} {folds:?}");
            let apart = other.start >= fold.end;
            assert!(apart || other.end <= fold.end, "{text:?} {folds:?}");
        }
    }
}

#[test]
fn folds_lie_within_each_other_or_apart() {
    for project in examples().iter().chain(&corpus()) {
        for file in &project.files {
            check(&file.text);
        }
    }
    trials(|u| {
        check(&soup(u)?);
        Ok(())
    })
    .cases(600);
}
