//! Jobs on pictures in a folder of their own.

use super::*;
use picture::file;
use picture::{Format, combine};
use rats::tool::{Playback, Shown};

/// A folder that is removed when dropped.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("sinew-tools-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&path).expect("temporary folder");
        Self(path)
    }

    fn put(&self, name: &str, level: u8, size: [u32; 2]) -> Picture {
        let picture =
            Picture::filled(size[0], size[1], [level, 0, level / 2, 255]).expect("a picture");
        let bytes = file::encode(&picture, Format::of(Path::new(name)).expect("a format"));
        std::fs::write(self.0.join(name), bytes.expect("encoded")).expect("written");
        picture
    }

    fn get(&self, name: &str) -> Picture {
        let bytes = std::fs::read(self.0.join(name)).unwrap_or_else(|e| panic!("{name}: {e}"));
        file::decode(&bytes, Format::of(Path::new(name)).expect("a format")).expect("read")
    }

    #[track_caller]
    fn does(&self, tool: Tool) -> String {
        let said = carry_out(&[tool], &self.0).remove(0);
        said.unwrap_or_else(|sentence| panic!("{sentence}"))
    }

    #[track_caller]
    fn refuses(&self, tool: Tool, why: &str) {
        let said = carry_out(&[tool], &self.0).remove(0);
        let sentence = said.expect_err("refused");
        assert!(sentence.contains(why), "{sentence}");
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // A leftover temporary folder is not worth failing a test for.
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn names(names: &[&str]) -> Vec<String> {
    names.iter().map(|&name| name.to_owned()).collect()
}

fn convert(from: &str, to: &str) -> Tool {
    Tool::Convert {
        from: from.to_owned(),
        to: to.to_owned(),
    }
}

#[test]
fn convert_and_resize() {
    let folder = Folder::new("convert");
    let picture = folder.put("a.png", 200, [6, 4]);
    for to in ["a.tga", "a.tif", "a.mtv", "a.gif", "b.png"] {
        folder.does(convert("a.png", to));
        assert!(folder.get(to) == picture, "{to}");
    }
    let said = folder.does(Tool::Resize {
        file: String::from("a.tga"),
        width: 12,
        height: 3,
    });
    assert_eq!(said, "wrote a-12x3.tga, 12×3");
    assert_eq!(folder.get("a-12x3.tga").size(), [12, 3]);
    assert_eq!(folder.get("a.tga").size(), [6, 4], "the old one stays");
}

#[test]
fn arithmetic_tells_what_is_left_and_saves_on_demand() {
    let folder = Folder::new("arithmetic");
    let a = folder.put("a.png", 0b1100, [5, 5]);
    let b = folder.put("b.png", 0b1010, [5, 5]);
    folder.put("c.png", 1, [5, 4]);
    let said = folder.does(Tool::Diff {
        a: String::from("a.png"),
        b: String::from("b.png"),
        save: None,
    });
    assert!(said.contains("25 of 25 pixels"), "{said}");
    assert!(!folder.0.join("d.png").exists());
    folder.does(Tool::Xor {
        a: String::from("a.png"),
        b: String::from("b.png"),
        save: Some(String::from("x.png")),
    });
    assert!(Ok(folder.get("x.png")) == combine::xor(&a, &b));
    folder.does(Tool::And {
        a: String::from("a.png"),
        b: String::from("b.png"),
        save: Some(String::from("n.png")),
    });
    assert!(Ok(folder.get("n.png")) == combine::and(&a, &b));
    folder.refuses(
        Tool::Diff {
            a: String::from("a.png"),
            b: String::from("c.png"),
            save: None,
        },
        "same size",
    );
}

#[test]
fn animations_are_made_told_of_and_taken_apart() {
    let folder = Folder::new("animations");
    let frames: Vec<Picture> = (0..3)
        .map(|i| folder.put(&format!("f{i}.png"), 40 * i, [8, 6]))
        .collect();
    let files = names(&["f0.png", "f1.png", "f2.png"]);
    let animate = |playback, dither| Tool::Animate {
        files: files.clone(),
        playback,
        dither,
    };
    let said = carry_out(
        &[
            animate(Playback::Mirror, false),
            animate(Playback::Once, false),
            animate(Playback::Loop, true),
            Tool::Fli {
                files: files.clone(),
                speed: Some(25.0),
                size: Some([4, 3]),
            },
        ],
        &folder.0,
    );
    assert_eq!(
        said,
        [
            "animation.png, 4 frames of 8×6",
            "animation-2.png, 3 frames of 8×6",
            "animation.gif, 3 frames of 8×6",
            "fli.gif, 3 frames of 4×3",
        ]
        .map(|file| Ok(format!("wrote {file}")))
    );
    let fli = Tool::Play {
        file: String::from("fli.gif"),
    };
    assert_eq!(folder.does(fli), "fli.gif: GIF, 3 frames of 4×3");
    let split = folder.does(Tool::Split {
        file: String::from("animation.png"),
        pattern: Some(String::from("out.tga")),
    });
    assert!(split.contains("4 frames"), "{split}");
    for (name, frame) in [(0, 0), (1, 1), (2, 2), (3, 1)] {
        assert!(folder.get(&format!("out00{name}.tga")) == frames[frame]);
    }
    folder.refuses(
        Tool::Animate {
            files: names(&[]),
            playback: Playback::Once,
            dither: false,
        },
        "at least one",
    );
    folder.put("big.png", 1, [9, 9]);
    folder.refuses(
        Tool::Animate {
            files: names(&["f0.png", "big.png"]),
            playback: Playback::Once,
            dither: false,
        },
        "same size",
    );
    let archive = Tool::Play {
        file: String::from("out000.tga.zip"),
    };
    folder.refuses(archive, ".png");
}

#[test]
fn sheets_plots_and_colours() {
    let folder = Folder::new("sheets");
    for i in 0..4 {
        folder.put(&format!("{i}.png"), 50 * i, [10, 10]);
    }
    folder.does(Tool::Collage {
        columns: Some(4),
        files: names(&["0.png", "1.png", "2.png", "3.png"]),
    });
    assert_eq!(folder.get("collage.png").size(), [40, 10]);
    folder.does(Tool::Table {
        values: vec![0.0, 1.0, 4.0, 9.0],
    });
    assert_eq!(folder.get("table.png").size(), [512, 320]);
    let said = folder.does(Tool::Show {
        what: Shown::Colour {
            name: String::from("Gold"),
            rgb: [1.0, 0.843, 0.0],
        },
    });
    assert!(said.starts_with("Gold: wrote colour.png"), "{said}");
    let names: Vec<[f32; 3]> = rats::colours::names()
        .filter_map(rats::colours::find)
        .collect();
    folder.does(Tool::Show {
        what: Shown::Palette(names),
    });
    assert!(folder.get("palette.png").width() > 400);
    folder.refuses(Tool::Table { values: vec![1.0] }, "2 to 256");
}

#[test]
fn nothing_outside_the_folder_and_no_dataset_is_touched() {
    let folder = Folder::new("outside");
    folder.put("a.png", 9, [2, 2]);
    std::fs::write(folder.0.join("model.rat"), "sphere").expect("written");
    for name in ["../a.png", "/tmp/a.png", "sub/../../a.png"] {
        folder.refuses(convert(name, "b.png"), "leads out");
        folder.refuses(convert("a.png", name), "leads out");
    }
    for name in ["model.rat", "model.ART", "x.ice", "x.dat"] {
        folder.refuses(convert("a.png", name), "is a dataset");
    }
    folder.refuses(convert("a.png", "script.sh"), ".png");
    folder.refuses(convert("a.png", "no-such-folder/b.png"), "cannot write");
    folder.refuses(convert("missing.png", "b.png"), "missing.png");
    std::fs::write(folder.0.join("junk.png"), b"not really a picture").expect("written");
    folder.refuses(convert("junk.png", "b.png"), "damaged");
    let text = std::fs::read_to_string(folder.0.join("model.rat")).expect("still there");
    assert_eq!(text, "sphere");
    assert!(!folder.0.join("b.png").exists());
}

#[cfg(unix)]
#[test]
fn links_do_not_lead_out() {
    let folder = Folder::new("links");
    let other = Folder::new("links-other");
    folder.put("a.png", 9, [2, 2]);
    other.put("secret.png", 200, [3, 2]);
    let link = |from: &str, to: &Path| {
        std::os::unix::fs::symlink(to, folder.0.join(from)).expect("a link");
    };
    link("in.png", &other.0.join("secret.png"));
    link("sub", &other.0);
    folder.refuses(convert("in.png", "b.png"), "leads out");
    folder.refuses(convert("sub/secret.png", "b.png"), "leads out");
    folder.refuses(convert("a.png", "in.png"), "leads out");
    folder.refuses(convert("a.png", "sub/b.png"), "leads out");
    assert!(!other.0.join("b.png").exists());
    // The same holds where a file is written before it has its name.
    link("c.png.part", &other.0.join("secret.png"));
    let before = std::fs::read(other.0.join("secret.png")).expect("bytes");
    folder.does(convert("a.png", "c.png"));
    let after = std::fs::read(other.0.join("secret.png")).expect("bytes");
    assert_eq!(before, after);
}

#[test]
fn results_without_a_name_take_none_that_the_text_uses() {
    let folder = Folder::new("names");
    folder.put("a.png", 9, [2, 2]);
    let tools = [
        convert("a.png", "collage.png"),
        Tool::Collage {
            columns: None,
            files: vec![String::from("a.png")],
        },
    ];
    let said = carry_out(&tools, &folder.0);
    assert!(said.iter().all(Result::is_ok), "{said:?}");
    assert!(folder.0.join("collage-2.png").exists());
}
