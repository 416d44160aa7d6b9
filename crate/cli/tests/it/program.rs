//! The program's subcommands, end to end.

use crate::common::{Folder, sinew, stdout};
use serde_json::Value;

const BALL: &str = "eyep 0 0 5\nvrp 0 0 0\nvup 0 1 0\nfov 40 40\nframesize 32 24\n\
    light White point pos 3 4 5\nsurface flesh diffuse OrangeRed blob -2\n\
    sphere flesh 1 0 0 0\nshoot\n";

#[test]
fn check_points_at_every_error_and_exits_1() {
    let folder = Folder::new("check");
    let bad = folder.write(
        "bad.rat",
        "surface s diffuse White\nspere s 1 0 0 0\nsphere nobody 1 0 0 0\n",
    );
    let output = sinew(&["check", &bad], "");
    assert_eq!(output.status.code(), Some(1));
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(
        said.contains("bad.rat:2:1") && said.contains("sphere"),
        "{said}"
    );
    assert!(said.contains("bad.rat:3:8"), "{said}");

    let output = sinew(&["check", &bad, "--json"], "");
    assert_eq!(output.status.code(), Some(1));
    let list: Vec<Value> = serde_json::from_str(&stdout(&output)).expect("JSON");
    let lines: Vec<_> = list
        .iter()
        .filter(|d| d["severity"] == "error")
        .map(|d| d["line"].as_u64())
        .collect();
    assert_eq!(lines, [Some(2), Some(3)]);

    let good = folder.write("good.rat", BALL);
    assert_eq!(sinew(&["check", &good], "").status.code(), Some(0));
}

#[test]
fn check_takes_several_files_and_exits_with_the_worst() {
    let folder = Folder::new("several");
    let good = folder.write("good.rat", BALL);
    let bad = folder.write("bad.rat", "spere s 1 0 0 0\n");
    let worse = folder.write("worse.rat", "sphere nobody 1 0 0 0\n");
    let missing = folder.path("missing.rat");
    for (files, status) in [
        (&[&*good, &good][..], 0),
        (&[&bad, &good], 1),
        (&[&missing, &bad, &good], 2),
        (&[], 2),
    ] {
        let output = sinew(&[&["check"], files].concat(), "");
        assert_eq!(output.status.code(), Some(status), "{files:?}");
    }

    // Files after a missing one are checked all the same, and each missing file is named.
    let other = folder.path("other.rat");
    let output = sinew(&["check", &missing, &bad, &other], "");
    let said = String::from_utf8_lossy(&output.stderr);
    for named in ["missing.rat", "bad.rat:1:1", "other.rat"] {
        assert!(said.contains(named), "{said}");
    }

    let output = sinew(&["check", "--json", &bad, &good, &worse], "");
    assert_eq!(output.status.code(), Some(1));
    let list: Vec<Value> = serde_json::from_str(&stdout(&output)).expect("JSON");
    let errors = list.iter().filter(|d| d["severity"] == "error");
    let files: Vec<_> = errors.filter_map(|d| d["file"].as_str()).collect();
    assert_eq!(files, [&bad, &worse]);
}

#[test]
fn a_missing_file_is_a_sentence_and_exit_2() {
    let output = sinew(&["check", "no-such-file.rat"], "");
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("no-such-file.rat"));
}

#[test]
fn files_that_are_no_use_are_told_with_their_lines() {
    let folder = Folder::new("no-use");
    fn messages(arguments: &[&str]) -> String {
        String::from_utf8_lossy(&sinew(arguments, "").stderr).into_owned()
    }
    let latin = folder.path("latin.rat");
    std::fs::write(
        &latin,
        b"surface A, diffuse Red\n# \xe9\nsphere A 1 0 0 0\n",
    )
    .unwrap();
    let said = messages(&["check", &latin]);
    assert!(
        said.contains("latin.rat:2: this line is not UTF-8"),
        "{said}"
    );
    folder.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    folder.write("nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n");
    for (mesh, words) in [
        ("flat.obj", "no triangle in this file has an area"),
        ("nan.obj", "line 2: numbers within ±1e12 are needed here"),
    ] {
        let text = format!("surface A, diffuse Red\nmesh A {mesh}\n");
        let said = messages(&["check", &folder.write("mesh.rat", &text)]);
        assert!(said.contains(words), "{said}");
    }
    let ball = folder.write("ball.rat", "surface A, diffuse Red\nsphere A 1 0 0 0\n");
    let film = folder.path("film.mp4");
    let said = messages(&["animate", &ball, "-f", "2", "-o", &film]);
    assert!(said.contains("must end in .png or .gif"), "{said}");
    for size in ["1e300", "1e-300", "nan", "-1"] {
        let out = folder.path("ball.stl");
        let size = format!("--size={size}");
        let said = messages(&["mesh", &ball, "-o", &out, &size]);
        assert!(said.contains("from 1e-3 to 1e9"), "{said}");
    }
}

#[test]
fn render_writes_a_picture_and_counts_its_work() {
    let folder = Folder::new("render");
    let file = folder.write("ball.rat", BALL);
    let picture = folder.path("ball.png");
    let output = sinew(
        &[
            "render",
            &file,
            "-o",
            &picture,
            "-r",
            "40",
            "30",
            "-s",
            "2",
            "--threads",
            "2",
            "--json",
        ],
        "",
    );
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let summary: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
    assert_eq!(summary["elements"]["soft"], 1);
    assert!(summary["rays"]["primary"].as_u64() >= Some(40 * 30));
    assert!(summary["field_evaluations"].as_u64() > Some(0));
    assert!(summary["seconds"]["trace"].as_f64() > Some(0.0));

    let mut reader = png::Decoder::new(std::io::BufReader::new(
        std::fs::File::open(&picture).expect("written"),
    ))
    .read_info()
    .expect("PNG");
    let mut pixels = vec![0; reader.output_buffer_size().expect("size")];
    let frame = reader.next_frame(&mut pixels).expect("frame");
    assert_eq!((frame.width, frame.height), (40, 30));
    let [middle, first, last] =
        [(20, 15), (0, 0), (39, 29)].map(|(x, y)| &pixels[(y * 40 + x) * 3..][..3]);
    assert!(middle[0] > 2 * middle[2], "the ball is orange: {middle:?}");
    assert_eq!(first, last, "the corners are background");
}

#[test]
fn render_refuses_what_it_cannot_do() {
    let folder = Folder::new("refuse");
    let file = folder.write("ball.rat", BALL);
    for arguments in [
        ["-o", "x.jpeg", "-r", "4", "4"],
        ["-o", "x.png", "-r", "0", "4"],
        ["-o", "x.png", "-r", "4", "100000"],
    ] {
        let mut all = vec!["render", file.as_str()];
        all.extend(arguments);
        assert_eq!(sinew(&all, "").status.code(), Some(2), "{arguments:?}");
    }
}

#[test]
fn the_number_of_threads_does_not_change_the_picture() {
    let folder = Folder::new("threads");
    let file = folder.write("ball.rat", BALL);
    let pictures = ["1", "2", "5"].map(|threads| {
        let path = folder.path(&format!("{threads}.png"));
        assert!(
            sinew(
                &[
                    "render",
                    &file,
                    "-o",
                    &path,
                    "-s",
                    "3",
                    "--threads",
                    threads
                ],
                ""
            )
            .status
            .success()
        );
        std::fs::read(path).expect("written")
    });
    assert!(pictures[0] == pictures[1] && pictures[1] == pictures[2]);
}

#[test]
fn probe_shows_rays_entering_and_leaving() {
    let folder = Folder::new("rays");
    let file = folder.write("ball.rat", BALL);
    let output = sinew(
        &["probe", &file, "--rays", "-"],
        "0 0 5 0 0 -2\n0 5 5 0 0 -1\n1 2 3\n",
    );
    assert_eq!(output.status.code(), Some(1), "the third line is no ray");
    let lines: Vec<Value> = stdout(&output)
        .lines()
        .map(|line| serde_json::from_str(line).expect("JSON"))
        .collect();
    let hits = lines[0]["hits"].as_array().expect("list");
    let distances: Vec<f64> = hits.iter().filter_map(|hit| hit["t"].as_f64()).collect();
    assert_eq!(distances.len(), 2);
    // Radius in isolation 1: that is what the field is normalised for.
    assert!(
        (distances[0] - 4.0).abs() < 1e-6 && (distances[1] - 6.0).abs() < 1e-6,
        "{distances:?}"
    );
    assert!(
        hits[0]["normal"][2].as_f64() > Some(0.999) && hits[1]["normal"][2].as_f64() < Some(-0.999)
    );
    assert_eq!(lines[1]["hits"].as_array().map(Vec::len), Some(0));
    assert_eq!(lines[2]["line"], 3);
}

#[test]
fn probe_weighs_materials() {
    let folder = Folder::new("weights");
    let file = folder.write(
        "two.rat",
        "surface red diffuse Red blob -2\nsurface blue diffuse Blue blob -2\nsphere red 1 -1 0 0\n\
         sphere blue 1 1 0 0\n",
    );
    let output = sinew(&["probe", &file, "--points", "-"], "0 0.5 0\n-1 0 0\n");
    let lines: Vec<Value> = stdout(&output)
        .lines()
        .map(|line| serde_json::from_str(line).expect("JSON"))
        .collect();
    let weight = |line: usize, name: &str| lines[line]["weights"][name].as_f64().expect("a weight");
    assert!((weight(0, "red") - 0.5).abs() < 1e-12 && (weight(0, "blue") - 0.5).abs() < 1e-12);
    assert!(weight(1, "red") > 0.8);
    assert!((weight(1, "red") + weight(1, "blue") - 1.0).abs() < 1e-12);
}

#[test]
fn links_carry_all_texts_there_and_back() {
    let folder = Folder::new("share");
    folder.write("part.rat", "sphere flesh 1 0 0 0 # ünïcode\n");
    let main = "surface flesh diffuse White blob -1\nread part.rat\n";
    let file = folder.write("main.rat", main);
    let output = sinew(
        &["share", &file, "--page", "https://example.org/sinew/"],
        "",
    );
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let link = stdout(&output).trim().to_owned();
    assert!(link.starts_with("https://example.org/sinew/#"), "{link}");
    let out = folder.path("out");
    assert!(sinew(&["open", &link, "-o", &out], "").status.success());
    let opened =
        |name: &str| std::fs::read_to_string(folder.0.join("out").join(name)).expect("written");
    assert_eq!(opened("main.rat"), main);
    assert_eq!(opened("part.rat"), "sphere flesh 1 0 0 0 # ünïcode\n");
    assert_eq!(
        sinew(&["open", &link, "-o", &out], "").status.code(),
        Some(2),
        "nothing is overwritten"
    );
    assert_eq!(
        sinew(&["open", "https://example.org/#rubbish"], "")
            .status
            .code(),
        Some(2)
    );
}

#[test]
fn the_options_of_rats() {
    let folder = Folder::new("classic");
    let file = folder.write("ball.rat", &format!("wibble\n{BALL}"));
    let picture = folder.path("ball.tga");
    let log = folder.path("said.txt");
    let output = sinew(
        &[
            "-r", "20", "10", "-s", "1", "+e", "-a", "-q", "-o", &picture, "-l", &log, &file,
        ],
        "",
    );
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "wibble is an error: {said}");
    for part in ["-a changes nothing", "> sphere flesh", "wibble", "20×10"] {
        assert!(said.contains(part), "{said}");
    }
    assert_eq!(said, std::fs::read_to_string(&log).expect("the log"));
    let tga = std::fs::read(&picture).expect("written");
    assert_eq!(
        tga[12..16],
        [20, 0, 10, 0],
        "width and height of a TGA file"
    );

    let file = folder.write("good.rat", BALL);
    assert_eq!(sinew(&["-v", &file], "").status.code(), Some(0));
    assert!(folder.0.join("scene.png").exists());
    let named = format!(
        "filename ball\nformat mtv\n{BALL}convert ball.mtv again.tif\nconvert no.png no.tga\n"
    );
    let file = folder.write("named.rat", &named);
    let output = sinew(&[&file], "");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "no.png is missing: {said}");
    assert!(
        said.contains("wrote again.tif, 32×24") && said.contains("cannot read no.png"),
        "{said}"
    );
    let mtv = std::fs::read(folder.0.join("ball.mtv")).expect("written");
    assert!(mtv.starts_with(b"32 24\n"));
    let file = folder.write("away.rat", &format!("filename ../ball\n{BALL}"));
    let said = sinew(&[&file], "");
    assert_eq!(
        said.status.code(),
        Some(2),
        "{}",
        String::from_utf8_lossy(&said.stderr)
    );

    // A text that only works on pictures draws none.
    std::fs::remove_file(folder.0.join("scene.png")).expect("removed");
    let file = folder.write("tools.rat", "resize again.tif 16 12\n");
    assert_eq!(sinew(&[&file], "").status.code(), Some(0));
    assert!(folder.0.join("again-16x12.tif").exists() && !folder.0.join("scene.png").exists());

    // One that is not to be saved is not even traced, unless the command line names it.
    let file = folder.write("unsaved.rat", &format!("nosave on\n{BALL}"));
    let output = sinew(&[&file], "");
    assert!(output.status.success());
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(said.contains("nosave is on"), "{said}");
    assert!(!folder.0.join("scene.png").exists());
    let asked = folder.path("asked.png");
    assert!(sinew(&["-o", &asked, &file], "").status.success());
    assert!(folder.0.join("asked.png").exists());

    for arguments in [
        &["-l", "good.rat"][..],
        &["-q"],
        &["-x", "a.rat"],
        &["-o", "a.rat", "b.rat"],
    ] {
        assert_eq!(sinew(arguments, "").status.code(), Some(2), "{arguments:?}");
    }
    assert!(stdout(&sinew(&["-?"], "")).contains("-r W H"));
}

#[test]
fn every_format_shows_the_same_picture() {
    let folder = Folder::new("formats");
    let file = folder.write("ball.rat", BALL);
    let pictures = ["png", "tga", "tif", "mtv"].map(|ending| {
        let path = folder.path(&format!("ball.{ending}"));
        assert!(sinew(&["render", &file, "-o", &path], "").status.success());
        let bytes = std::fs::read(&path).expect("written");
        let format = picture::Format::of(path.as_ref()).expect("a format");
        picture::file::decode(&bytes, format).expect("a picture")
    });
    assert!(pictures.iter().all(|other| *other == pictures[0]));
}

#[test]
fn animate_follows_the_variables() {
    let folder = Folder::new("animate");
    let file = folder.write(
        "turn.rat",
        &format!(
            "var a = 0\nvar a += 30\nvar r = 0.5 + a/100\n{}",
            BALL.replace("flesh 1 0", "flesh r 0")
        ),
    );
    for ending in ["png", "gif"] {
        let film = folder.path(&format!("film.{ending}"));
        let output = sinew(
            &[
                "animate", &file, "-o", &film, "--frames", "3", "--fps", "10",
            ],
            "",
        );
        assert!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
        let bytes = std::fs::read(&film).expect("written");
        let format = picture::Format::of(film.as_ref()).expect("a format");
        let frames: Vec<_> = picture::animation::frames(&bytes, format)
            .expect("an animation")
            .collect::<Result<_, _>>()
            .expect("whole frames");
        assert_eq!(frames.len(), 3);
        assert!(frames[0] != frames[1] && frames[1] != frames[2]);
    }
    let still = folder.write("still.rat", BALL);
    let film = folder.path("still.png");
    for (arguments, why) in [
        (["animate", &still, "-o", &film, "--frames", "3"], "changes"),
        (
            ["animate", &file, "-o", &film, "--frames", "0"],
            "1 to 10000",
        ),
        (
            ["animate", &file, "-o", "film.tga", "--frames", "2"],
            "an animation must end",
        ),
    ] {
        let output = sinew(&arguments, "");
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains(why), "{said}");
    }
    assert!(!folder.0.join("still.png").exists());
}

#[test]
fn fmt_lays_out_and_checks() {
    let folder = Folder::new("fmt");
    let untidy = "for i=1 to 3 {\nsphere flesh 1   i 0 0\n}\n";
    let file = folder.write("untidy.rat", untidy);
    let tidy = folder.write("tidy.rat", "sphere flesh 1 0 0 0\n");
    let read = || std::fs::read_to_string(&file).expect("there");
    let output = sinew(&["fmt", "--check", &tidy, &file], "");
    assert_eq!(output.status.code(), Some(1));
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(
        said.contains("untidy.rat") && !said.contains("/tidy.rat"),
        "{said}"
    );
    assert_eq!(read(), untidy);
    assert_eq!(sinew(&["fmt", &tidy, &file], "").status.code(), Some(0));
    assert_eq!(read(), assist::format(untidy));
    assert_ne!(read(), untidy);
    assert_eq!(sinew(&["fmt", "--check", &file], "").status.code(), Some(0));
    assert_eq!(
        sinew(&["fmt", "no-such-file.rat"], "").status.code(),
        Some(2)
    );
    // One that cannot be read does not keep the next from being laid out.
    std::fs::write(&file, untidy).expect("written");
    let output = sinew(&["fmt", "no-such-file.rat", &file], "");
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(read(), assist::format(untidy));
}

#[test]
fn sculpt_replays_strokes_to_meshes_stage_by_stage() {
    let folder = Folder::new("sculpt");
    let text = "strokes 1\nstart sphere 4\nstage egg\n\
        pull sphere 0.5 0.5 0.5 bell 1 : 0 0 1, 0 0 2\nstage nose\n\
        paint 1 0 0 sphere 1 1 1 : 0 0 2\nloop\n";
    let strokes = folder.write("nose.strokes", text);
    for ending in ["ply", "obj", "stl", "glb", "3mf"] {
        let out = folder.path(&format!("nose.{ending}"));
        let output = sinew(&["sculpt", &strokes, "-o", &out], "");
        assert_eq!(output.status.code(), Some(0));
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(
            said.contains("1. egg: 66 vertices, 128 faces, 192 edges, closed"),
            "{said}"
        );
        assert!(said.contains("the mesh: 258 vertices, 512 faces"), "{said}");
        let mesh = mesh::read(&out, &std::fs::read(&out).expect("written")).expect("a mesh");
        assert_eq!(mesh.triangles.len(), 512);
    }
    let out = folder.path("nose.ply");
    assert_eq!(
        sinew(
            &[
                "sculpt", &strokes, "-o", &out, "--stages", "--until", "nose"
            ],
            ""
        )
        .status
        .code(),
        Some(0)
    );
    for (name, triangles) in [("nose.ply", 128), ("nose-1.ply", 128), ("nose-2.ply", 128)] {
        let bytes = std::fs::read(folder.path(name)).expect("written");
        assert_eq!(
            mesh::read(name, &bytes).expect("a mesh").triangles.len(),
            triangles
        );
    }
    assert_eq!(
        sinew(&["sculpt", &strokes, "--until", "ear"], "")
            .status
            .code(),
        Some(2)
    );
    assert_eq!(
        sinew(&["sculpt", &strokes, "-o", "nose.png"], "")
            .status
            .code(),
        Some(2)
    );

    let bad = folder.write("bad.strokes", "strokes 1\nstart file ../x.obj\nfill\n");
    let output = sinew(&["sculpt", &bad], "");
    assert_eq!(output.status.code(), Some(1));
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(
        said.contains("bad.strokes:2:1") && said.contains("not in the folder"),
        "{said}"
    );
}
