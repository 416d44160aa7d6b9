//! Jobs on pictures in memory.

use super::*;
use picture::{Format, Picture, Problem, file};
use rats::Tool;
use rats::tool::{Playback, Shown};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::io::{self, Write};
use std::path::Path;
use std::rc::Rc;

type Files = Rc<RefCell<BTreeMap<String, Vec<u8>>>>;

struct Memory {
    files: Files,
    most: u64,
    seen: bool,
}

impl Memory {
    fn new(names: &[(&str, [u32; 2])]) -> Self {
        let files = names.iter().enumerate().map(|(index, (name, size))| {
            let level = 40 * (index as u8 + 1);
            let picture = Picture::filled(size[0], size[1], [level, 0, level, 255]).unwrap();
            let format = Format::of(Path::new(name)).unwrap();
            let bytes = file::encode(&picture, format).unwrap();
            (String::from(*name), bytes)
        });
        Self {
            files: Rc::new(RefCell::new(files.collect())),
            most: 10_000,
            seen: false,
        }
    }
}

impl Shelf for Memory {
    fn read(&self, name: &str) -> Result<Vec<u8>, String> {
        let files = self.files.borrow();
        files.get(name).cloned().ok_or(format!("no {name}"))
    }

    fn create(&self, name: &str) -> Result<Box<dyn Target>, String> {
        let (name, files) = (name.to_owned(), self.files.clone());
        let bytes = Vec::new();
        Ok(Box::new(Sheet { name, bytes, files }))
    }

    fn most_pixels(&self) -> u64 {
        self.most
    }

    fn is_seen(&self) -> bool {
        self.seen
    }
}

struct Sheet {
    name: String,
    bytes: Vec<u8>,
    files: Files,
}

impl Write for Sheet {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.bytes.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Target for Sheet {
    fn keep(self: Box<Self>) -> Result<(), String> {
        self.files.borrow_mut().insert(self.name, self.bytes);
        Ok(())
    }
}

/// Runs tools; returns the results and the number of steps.
fn run(shelf: Memory, tools: &[Tool]) -> (Vec<Result<Done, String>>, usize) {
    let mut bench = Bench::new(shelf, tools.to_vec());
    let (mut done, mut steps) = (Vec::new(), 0);
    while let Some(step) = bench.step() {
        steps += 1;
        if let Step::Finished(finished) = step {
            done.push(finished);
        }
    }
    assert_eq!((bench.finished(), bench.tool()), (bench.count(), None));
    (done, steps)
}

fn one(shelf: Memory, tool: Tool) -> Result<Done, String> {
    run(shelf, &[tool]).0.remove(0)
}

fn names(names: &[&str]) -> Vec<String> {
    names.iter().map(|&name| name.to_owned()).collect()
}

const TWO: [(&str, [u32; 2]); 2] = [("a.png", [40, 30]), ("b.png", [40, 30])];

#[test]
fn each_step_is_one_picture_and_what_was_written_can_be_read() {
    let files = names(&["a.png", "b.png"]);
    let animate = Tool::Animate {
        files: files.clone(),
        playback: Playback::Loop,
        dither: false,
    };
    let split = Tool::Split {
        file: String::from("animation.png"),
        pattern: None,
    };
    let play = Tool::Play {
        file: String::from("animation.png"),
    };
    let collage = Tool::Collage {
        columns: None,
        files,
    };
    let (done, steps) = run(Memory::new(&TWO), &[animate, split, play, collage]);
    let done: Vec<Done> = done.into_iter().map(Result::unwrap).collect();
    let told: Vec<(&str, Vec<&str>)> = done
        .iter()
        .map(|done| {
            let files = done.files.iter().map(String::as_str);
            (done.said.as_str(), files.collect())
        })
        .collect();
    assert_eq!(
        told,
        [
            (
                "wrote animation.png, 2 frames of 40×30",
                vec!["animation.png"]
            ),
            (
                "wrote 2 frames of animation.png to frame000.png …",
                vec!["frame000.png", "frame001.png"]
            ),
            (
                "animation.png: PNG, 2 frames of 40×30",
                vec!["animation.png"]
            ),
            ("wrote collage.png, 80×30", vec!["collage.png"]),
        ]
    );
    // Each of the four: beginning, two pictures, ending.
    assert_eq!(steps, 16);
}

#[test]
fn a_result_that_is_not_saved_is_written_where_it_is_seen() {
    let diff = Tool::Diff {
        a: String::from("a.png"),
        b: String::from("b.png"),
        save: None,
    };
    let unseen = one(Memory::new(&TWO), diff.clone()).unwrap();
    assert_eq!(unseen.files, [""; 0]);
    let mut shelf = Memory::new(&TWO);
    shelf.seen = true;
    let seen = one(shelf, diff).unwrap();
    assert_eq!((seen.files, seen.said), (names(&["diff.png"]), unseen.said));
}

#[test]
fn there_is_room_for_so_many_pixels_only() {
    fn room(most: u64) -> Memory {
        let mut shelf = Memory::new(&TWO);
        shelf.most = most;
        shelf
    }
    fn resize(width: u32, height: u32) -> Tool {
        Tool::Resize {
            file: String::from("a.png"),
            width,
            height,
        }
    }
    fn collage(count: usize) -> Tool {
        Tool::Collage {
            columns: Some(1),
            files: vec![String::from("a.png"); count],
        }
    }
    let animate = Tool::Animate {
        files: names(&["a.png"]),
        playback: Playback::Once,
        dither: true,
    };
    for (most, tool, why) in [
        (1199, resize(2, 2), "a.png: 40×30 are more pixels"),
        (1200, resize(40, 31), "a.png: 40×31 are more pixels"),
        (1200, resize(1, 31), "a.png: 40×31 are more pixels"),
        (2400, collage(3), "the first 3 pictures have 3600 pixels"),
        (1199, animate, "a.png: 40×30 are more pixels"),
    ] {
        let sentence = one(room(most), tool).unwrap_err();
        assert!(sentence.starts_with(why), "{sentence}");
    }
    assert!(one(room(1200), resize(40, 30)).is_ok());
    assert!(one(room(2400), collage(2)).is_ok());
    // Pictures of different sizes leave room between them.
    let shelf = Memory::new(&[("a.png", [100, 1]), ("b.png", [1, 100])]);
    let cross = Tool::Collage {
        columns: None,
        files: names(&["a.png", "b.png"]),
    };
    let room = Problem::NoRoom {
        size: [200, 100],
        most: 10_000,
    };
    assert_eq!(one(shelf, cross), Err(room.to_string()));
}

#[test]
fn a_shelf_sees_no_name_that_leads_out_and_no_dataset_is_written() {
    struct Closed;
    impl Shelf for Closed {
        fn read(&self, name: &str) -> Result<Vec<u8>, String> {
            assert_eq!(name, "a.mtv", "no other may be asked for");
            Ok(b"1 1\n\x01\x02\x03".to_vec())
        }
        fn create(&self, name: &str) -> Result<Box<dyn Target>, String> {
            panic!("{name} must not be written")
        }
    }
    let jobs = [
        ("../a.png", "b.png", "leads out"),
        ("/a.png", "b.png", "leads out"),
        ("a.xyz", "b.png", ".png"),
        ("a.mtv", "../b.png", "leads out"),
        ("a.mtv", "b.RAT", "is a dataset"),
        ("a.mtv", "b", ".png"),
    ];
    let tools = jobs.map(|(from, to, _)| Tool::Convert {
        from: from.to_owned(),
        to: to.to_owned(),
    });
    let mut bench = Bench::new(Closed, tools.to_vec());
    for (from, to, why) in jobs {
        let Some(Step::Finished(Err(sentence))) = bench.step() else {
            panic!("{from} to {to} was not refused");
        };
        assert!(sentence.contains(why), "{sentence}");
    }
}

#[test]
fn a_job_tells_what_it_reads() {
    let xor = Tool::Xor {
        a: String::from("a.png"),
        b: String::from("b.png"),
        save: Some(String::from("c.png")),
    };
    assert_eq!(xor.reads(), ["a.png", "b.png"]);
    let file = Shown::File(String::from("a.png"));
    assert_eq!(Tool::Show { what: file }.reads(), ["a.png"]);
    let palette = Shown::Palette(Vec::new());
    assert_eq!(Tool::Show { what: palette }.reads(), [""; 0]);
}
