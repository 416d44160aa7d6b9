//! Texts of strokes.

use sculpt::{Beginning, COMMANDS, Script, Shape, Start, replay};
use trials::{Random, count, trials};

/// The message for a text that begins well.
fn message(line: &str) -> String {
    let text = format!("strokes 1\nstart sphere 3\n{line}\n");
    text.parse::<Script>().unwrap_err().to_string()
}

#[test]
fn what_is_written_is_read_again() {
    for seed in 0..count(500) as u64 {
        let mut random = Random::new(seed);
        let strokes = (0..20)
            .map(|_| crate::strokes::stroke(&mut random, 100))
            .collect();
        let mut start = Start::new(random.pick(&Shape::ALL), 1 + random.below(9) as u32);
        if seed % 2 == 0 {
            start.semi_axes = random.vector(2.0).abs() + 0.1;
        }
        let script = Script::new(Beginning::Shape(start), strokes);
        let again: Script = script.to_string().parse().unwrap();
        assert_eq!((again.start, again.strokes), (script.start, script.strokes));
    }
    let file: Script = "strokes 1\nstart file my bone.obj\n".parse().unwrap();
    assert_eq!(file.start, Beginning::File("my bone.obj".into()));
    assert_eq!(
        file.to_string().parse::<Script>().unwrap().start,
        file.start
    );
}

#[test]
fn comments_blank_lines_and_what_may_be_left_out() {
    let text = "# a clay\n\nstrokes 1 # first\r\n  start sphere 3 1 2 3\n\trefine\naverage 2\n\
        region grow\n\
        push box 1 1 1 0.5 0.5 turn 0 0 45 goo 1 normal only:0 0 0 0.5,1 0 0\n";
    let script: Script = text.parse().unwrap();
    let written = script.to_string();
    assert_eq!(
        written,
        "strokes 1\nstart sphere 3 1 2 3\nrefine propagate\naverage 2 1\nregion grow 1\n\
         push box 1 1 1 0.5 0.5 turn 0 0 45 goo 1 normal only : 0 0 0 0.5, 1 0 0\n"
    );
    assert_eq!(script.line(0), 5);
}

#[test]
fn problems_say_where_and_what() {
    for (line, words) in [
        (
            "shove sphere 1 1 1 : 0 0 0",
            "line 3, column 1: there is no command `shove`; there are strokes, start",
        ),
        (
            "push globe 1 1 1 : 0 0 0",
            "line 3, column 6: a tool is expected",
        ),
        (
            "push sphere 1 1 : 0 0 0",
            "line 3, column 17: a number is expected: a semi-axis",
        ),
        (
            "push sphere 1 1 0 : 0 0 0",
            "line 3, column 17: a semi-axis must be from 0.000001 to 1000000",
        ),
        (
            "push sphere 1 1 1 3 1 : 0 0 0",
            "line 3, column 19: an exponent must be from 0.05 to 2",
        ),
        (
            "push sphere 1 1 1 bell : 0 0 0",
            "line 3, column 24: a number is expected: the range",
        ),
        (
            "push sphere 1 1 1 belly 1 : 0 0 0",
            "line 3, column 19: a colon and the path are expected",
        ),
        (
            "push sphere 1 1 1 : 0 0",
            "line 3, column 24: a number is expected: a coordinate",
        ),
        (
            "push sphere 1 1 1 : 0 0 inf",
            "line 3, column 25: a coordinate of the path must be from",
        ),
        (
            "push sphere 1 1 1 : 0 0 NaN",
            "line 3, column 25: a coordinate of the path must be from",
        ),
        (
            "push sphere 1 1 1 : 0 0 0 2",
            "line 3, column 27: the pressure must be from 0 to 1",
        ),
        (
            "push sphere 1 1 1 : 0 0 0 1 1",
            "line 3, column 29: the line should end here",
        ),
        (
            "push sphere 1 1 1 :",
            "line 3, column 20: a number is expected",
        ),
        (
            "mask 2 sphere 1 1 1 : 0 0 0",
            "line 3, column 6: the mask must be from 0 to 1",
        ),
        (
            "symmetry w",
            "line 3, column 10: x, y, z or `off` is expected",
        ),
        ("delete", "line 3, column 7: `face` or `hole` is expected"),
        (
            "loop 0",
            "line 3, column 6: the levels must be from 1 to 100",
        ),
        (
            "average 1000",
            "line 3, column 9: how often must be from 1 to 100",
        ),
        (
            "start sphere 3",
            "line 3, column 1: there is a `start` before",
        ),
        (
            "stage",
            "line 3, column 6: the name of the stage is expected",
        ),
        ("région", "line 3, column 1: there is no command `région`"),
    ] {
        let found = message(line);
        assert!(found.starts_with(words), "{line}: {found}");
    }
    for (text, words) in [
        ("", "line 1, column 1: there must be `strokes 1`"),
        (
            "start sphere 1",
            "line 1, column 1: the first line must be `strokes 1`",
        ),
        ("strokes 2", "line 1, column 1: version 2 is not known"),
        (
            "strokes 1\nloop",
            "line 2, column 1: there must be a `start` first",
        ),
        (
            "strokes 1\nstart cone 3",
            "line 2, column 7: a start shape is expected",
        ),
        (
            "strokes 1\nstart sphere 900",
            "line 2, column 14: this would be more than 2000000 faces",
        ),
        (
            "strokes 1\nstart file",
            "line 2, column 11: the name of a file is expected",
        ),
    ] {
        let found = text.parse::<Script>().unwrap_err().to_string();
        assert!(found.starts_with(words), "{text:?}: {found}");
    }
    let many = "strokes 1\nstart box 1\n".to_owned() + &"oops\n".repeat(100);
    let problems = Script::parse(&many).unwrap_err();
    assert_eq!(problems.len(), 20);
    assert_eq!(&many[problems[0].span.clone()], "oops");
}

#[test]
fn every_command_is_in_the_table_and_understood() {
    for command in &COMMANDS[2..] {
        if command.name != "stage" {
            let found = message(&format!("{} ~", command.name));
            assert!(!found.contains("there is no command"), "{found}");
        }
        assert!(
            command
                .forms
                .iter()
                .all(|form| form.starts_with(command.name))
        );
        assert!(!command.meaning.is_empty());
    }
}

#[test]
fn no_text_panics() {
    let words = [
        "push", "pull", "sphere", "box", "1", "0.5", "-2", ":", ",", "bell", "only", "region",
        "add", "\n", "#", "é", "mask", "start", "strokes", "turn", "1e999", "file", "loop", "grow",
        "x",
    ];
    trials(|u| {
        let mut text = String::from(if u.arbitrary()? {
            "strokes 1\nstart box 1\n"
        } else {
            ""
        });
        while !u.is_empty() && text.len() < 400 {
            text += words[u.choose_index(words.len())?];
            text += if u.arbitrary()? { " " } else { "" };
        }
        if let Ok(script) = Script::parse(&text) {
            let again = Script::parse(&script.to_string()).unwrap();
            assert_eq!(again.strokes, script.strokes);
        }
        Ok(())
    })
    .cases(2000);
}

#[test]
fn too_much_work_is_refused_at_its_line() {
    let path = vec!["0 0 0, 1 0 0"; 200].join(", ");
    let text = format!(
        "strokes 1\nstart sphere 50\npush sphere 2 2 2 flat 0.1 : 0 0 0\npull sphere 3 3 3 : \
         {path}\n"
    );
    let script: Script = text.parse().unwrap();
    let problem = replay(
        &script,
        &mut |_| Err(String::new()),
        1_000_000,
        |_, _, _| (),
    )
    .unwrap_err();
    assert_eq!(
        problem.to_string(),
        "line 4, column 1: all strokes together take too long"
    );
    let long = "strokes 1\nstart box 1\n".to_owned() + &"fill\n".repeat(100_001);
    assert!(
        Script::parse(&long).unwrap_err()[0]
            .message
            .contains("more than 100000 strokes")
    );
    let large = " ".repeat(sculpt::limits::MAX_BYTES + 1);
    assert!(
        Script::parse(&large).unwrap_err()[0]
            .message
            .contains("at most")
    );
}

#[test]
fn a_missing_file_is_told_at_the_start() {
    let script: Script = "strokes 1\nstart file a.obj\nloop\n".parse().unwrap();
    let problem = replay(
        &script,
        &mut |name| Err(format!("no {name}")),
        1,
        |_, _, _| (),
    )
    .unwrap_err();
    assert_eq!(problem.to_string(), "line 2, column 1: no a.obj");
}
