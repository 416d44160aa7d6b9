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
        ["-o", "x.webp", "-r", "4", "4"],
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

/// Pixels of a picture file, three bytes each, with its size.
fn pixels(path: &str) -> ([u32; 2], Vec<u8>) {
    let bytes = std::fs::read(path).unwrap_or_else(|error| panic!("{path}: {error}"));
    let picture = picture::file::decode(&bytes, picture::Format::Png).expect("a picture");
    (picture.size(), picture.rgb())
}

/// Pictures of several `shoot`s have names of their own; `-o` numbers those before the last.
#[test]
fn several_shoots_write_several_pictures() {
    let folder = Folder::new("shoots");
    let text = "eyep 0 0 5\nfov 40\nframesize 16 12\nlight White, pos 3 4 5\n\
        surface s diffuse Red\nsphere s 0.5 -1 0 0\nfilename one\nshoot\n\
        surface s diffuse Blue\nsphere s 0.5 1 0 0\nfilename two.tga\nshoot\n\
        reset data\nfilename three\nformat png\nsphere s 0.5 0 0 0\nshoot\n";
    let file = folder.write("film.rat", text);
    let output = sinew(&[&file], "");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    for name in ["one.png", "two.tga", "three.png"] {
        assert!(said.contains(&format!("wrote {name}, 16×12")), "{said}");
    }
    // First one red ball to the left, then two blue ones, then one in the middle.
    fn lit((size, bytes): &([u32; 2], Vec<u8>), channel: usize) -> [usize; 2] {
        let width = size[0] as usize;
        let rgb = bytes.chunks_exact(3).enumerate();
        let bright = rgb.filter(|(_, rgb)| rgb[channel] > 60 && rgb[2 - channel] < 60);
        let sides: Vec<bool> = bright.map(|(i, _)| i % width < width / 2).collect();
        let first = sides.iter().filter(|is_left| **is_left).count();
        [first, sides.len() - first]
    }
    let one = pixels(&folder.path("one.png"));
    assert!(
        lit(&one, 0)[0] > 3 && lit(&one, 0)[1] == 0,
        "{:?}",
        lit(&one, 0)
    );
    assert_eq!(lit(&one, 2), [0, 0]);
    let three = pixels(&folder.path("three.png"));
    assert!(lit(&three, 2).into_iter().all(|count| count > 3));

    let picture = folder.path("out.png");
    for arguments in [
        &["render", &file, "-o", &picture][..],
        &["-o", &picture, &file],
    ] {
        let output = sinew(arguments, "");
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        let names = ["out-1.png", "out-2.png", "out.png"].map(|name| folder.path(name));
        let [first, second, last] = names.each_ref().map(|name| pixels(name));
        assert_eq!((&first, &last), (&one, &three));
        let both = lit(&second, 2);
        assert!(both[0] > 3 && both[1] > 3, "{both:?}");
        for name in names {
            std::fs::remove_file(name).expect("removed");
        }
    }
}

/// `-` is a dataset that comes from the standard input.
#[test]
fn datasets_come_from_the_standard_input() {
    let folder = Folder::new("input");
    let picture = folder.path("ball.png");
    let output = sinew(&["-o", &picture, "-"], BALL);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    assert_eq!(pixels(&picture).0, [32, 24]);
    let output = sinew(&["check", "-"], "wibble\n");
    assert_eq!(output.status.code(), Some(1));
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(said.contains("input.rat:1:1"), "{said}");
    let output = sinew(&["scene", "-"], BALL);
    assert!(stdout(&output).contains("\"elements\""));
}

/// `log` and `stopwatch` do what they say; `pause` waits for nobody where nobody sits.
#[test]
fn logs_pauses_and_stopwatches() {
    let folder = Folder::new("interludes");
    let text = BALL.replace(
        "shoot",
        "log said.txt\nstopwatch start\nfilename a\nshoot\n\
        stopwatch stop\npause look\nlog\nfilename b\nshoot",
    );
    let file = folder.write("ball.rat", &text);
    let output = sinew(&["-r", "8", "6", &file], "");
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let log = std::fs::read_to_string(folder.path("said.txt")).expect("the log");
    assert!(
        log.contains("wrote a.png") && log.contains("stopwatch: "),
        "{log}"
    );
    assert!(
        log.contains("look") && !log.contains("wrote b.png"),
        "{log}"
    );
    // A stranger's log stays in the folder, and is none but a log.
    for name in ["../said.txt", "/tmp/said.txt"] {
        let file = folder.write("odd.rat", &format!("log {name}\n{BALL}"));
        let output = sinew(&[&file], "");
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains("leads out of"), "{said}");
    }
}

/// `cp x y z 0` is what an eye twice as near shows, but for a pixel here and there.
#[test]
fn parallel_rays_are_those_of_an_eye_far_away() {
    let folder = Folder::new("parallel");
    let model = "framesize 64 64\nlight White, pos 3 4 5\nsurface s diffuse White, rad 1, blob -2\n\
        surface h diffuse Red\nsphere s 1 -1.5 0 0\ncylinder s 1 <-1 1 -6> <2 -1 6>\n\
        sphere h 1 1.5 1 -5\nsphere h 1 1.5 -1.5 5\n";
    let camera = "cp 0 0 1 0\nwindow -4 4 -4 4\n";
    let near = "eyep 0 0 22918.3\nfov 0.02\n";
    fn show(folder: &Folder, name: &str, text: String) -> Vec<u8> {
        let file = folder.write(&format!("{name}.rat"), &text);
        let picture = folder.path(&format!("{name}.png"));
        let output = sinew(&["render", &file, "-o", &picture, "--threads", "1"], "");
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        pixels(&picture).1
    }
    let parallel = show(&folder, "parallel", format!("{camera}{model}"));
    let far = show(&folder, "far", format!("{near}{model}"));
    fn differ(a: &[u8], b: &[u8]) -> usize {
        let pairs = a.chunks_exact(3).zip(b.chunks_exact(3));
        let pairs = pairs.filter(|(a, b)| (0..3).any(|i| a[i].abs_diff(b[i]) > 24));
        pairs.count()
    }
    assert!(differ(&parallel, &far) < 12, "{}", differ(&parallel, &far));
    let close = show(&folder, "close", format!("eyep 0 0 12\nfov 36.87\n{model}"));
    assert!(differ(&parallel, &close) > 200);
    // The two hard balls are equally large, though one is three times as far from a near eye.
    fn red(pixels: &[u8], rows: std::ops::Range<usize>) -> usize {
        let rows = pixels
            .chunks_exact(3 * 64)
            .enumerate()
            .filter(|(y, _)| rows.contains(y));
        let rgb = rows.flat_map(|(_, row)| row.chunks_exact(3));
        // Also where it is in shadow.
        rgb.filter(|rgb| rgb[0] > 24 && rgb[0] / 2 > rgb[1]).count()
    }
    let [above, below] = [red(&parallel, 0..32), red(&parallel, 32..64)];
    assert!(above.abs_diff(below) < above / 3, "{above} {below}");
    let [above, below] = [red(&close, 0..32), red(&close, 32..64)];
    assert!(below > 2 * above, "{above} {below}");
}

/// `sample 0.5` sends one ray for four pixels, which all show it.
#[test]
fn fewer_rays_than_pixels_make_blocks() {
    let folder = Folder::new("blocks");
    fn render(folder: &Folder, sample: &str, size: [&str; 2]) -> (Option<u64>, Vec<u8>) {
        let picture = folder.path("ball.png");
        let file = folder.write("ball.rat", &format!("sample {sample}\n{BALL}"));
        let [w, h] = size;
        let arguments = ["render", &file, "-o", &picture, "--json", "-r", w, h];
        let output = sinew(&arguments, "");
        assert!(output.status.success(), "{output:?}");
        let summary: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
        (summary["rays"]["primary"].as_u64(), pixels(&picture).1)
    }
    for (sample, side) in [("0.5", 2), ("0.25", 4), ("0.125", 8), ("0.0625", 16)] {
        let (rays, shown) = render(&folder, sample, ["150", "90"]);
        let wanted = 150_u64.div_ceil(side) * 90_u64.div_ceil(side);
        assert_eq!(rays, Some(wanted), "{sample}");
        let side = side as usize;
        for (y, x) in (0..90).flat_map(|y| (0..150).map(move |x| (y, x))) {
            assert_eq!(
                shown[3 * (150 * y + x)..][..3],
                shown[3 * (150 * (y - y % side) + x - x % side)..][..3],
                "{sample}: {x} {y}"
            );
        }
    }
    // A block shows what its middle does: blocks of 2 are the picture of half the size.
    assert_eq!(render(&folder, "0.5", ["128", "96"]).1.len(), 3 * 128 * 96);
    let (_, blocks) = render(&folder, "0.5", ["128", "96"]);
    let (_, half) = render(&folder, "1", ["64", "48"]);
    let small: Vec<u8> = (0..48)
        .flat_map(|y| (0..64).flat_map(move |x| (0..3).map(move |k| 3 * (256 * y + 2 * x) + k)))
        .map(|index| blocks[index])
        .collect();
    let apart = small
        .iter()
        .zip(&half)
        .filter(|(a, b)| a.abs_diff(**b) > 2)
        .count();
    assert!(apart < 30, "{apart}");
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
    // Parts that were traced apart are merged to the same bytes; a GIF from the same pictures.
    let parts = [["0..1", "one.png"], ["1..3", "two.png"]].map(|[frames, name]| {
        let part = folder.path(name);
        let output = sinew(
            &[
                "animate", &file, "-o", &part, "--frames", frames, "--fps", "10",
            ],
            "",
        );
        assert!(output.status.success(), "{frames}");
        part
    });
    for ending in ["png", "gif"] {
        let merged = folder.path(&format!("merged.{ending}"));
        let output = sinew(
            &["animate", "--merge", &parts[0], &parts[1], "-o", &merged],
            "",
        );
        assert!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
        let film = folder.path(&format!("film.{ending}"));
        let [merged, film] = [merged, film].map(|path| std::fs::read(path).expect("written"));
        assert!(merged == film, "{ending}");
    }
    let still = folder.write("still.rat", BALL);
    let film = folder.path("still.png");
    for arguments in [
        vec!["animate", &file, "-o", &film, "--frames", "3..3"],
        vec![
            "animate", &file, "-o", &film, "--frames", "3", "--merge", &parts[0],
        ],
        vec!["animate", "-o", &film],
        vec!["animate", "-o", &film, "--merge", &file],
        vec!["animate", "-o", &film, "--merge", "absent.png"],
    ] {
        assert_eq!(
            sinew(&arguments, "").status.code(),
            Some(2),
            "{arguments:?}"
        );
    }
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
fn types_of_a_neuron_are_materials_and_come_back() {
    let folder = Folder::new("types");
    let neuron = folder.write(
        "n.swc",
        "1 1 0 0 0 5 -1\n2 3 0 8 0 1.5 1\n3 3 0 20 0 1 2\n4 2 0 -8 0 1 1\n5 2 0 -30 0 0.5 4\n",
    );
    let (text, again) = (folder.path("n.rat"), folder.path("again.swc"));
    for (from, to) in [(&neuron, &text), (&text, &again)] {
        let output = sinew(&["skeleton", from, "--to", to], "");
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{said}");
    }
    let types = [&neuron, &again].map(|file| {
        let output = sinew(&["skeleton", file, "--json"], "");
        let known: Value = serde_json::from_str(&stdout(&output)).expect("JSON");
        let mut types: Vec<String> = serde_json::from_value(known["types"].clone()).expect("names");
        types.sort_unstable();
        (types, known["limbs"].clone())
    });
    assert_eq!(types[0].0, ["axon", "dendrite", "soma"]);
    assert_eq!(types[1], types[0]);
}

#[test]
fn a_skeleton_is_drawn_without_a_dataset() {
    let folder = Folder::new("skeleton");
    // In millimetres, far from the origin, as data are.
    let limb = folder.write(
        "a limb.swc",
        "1 3 5000 0 0 2 -1\n2 3 5040 0 0 2 1\n3 3 5060 30 0 1 2\n",
    );
    let picture = folder.path("limb.png");
    let arguments = ["render", &limb, "-o", &picture, "-r", "80", "60"];
    let output = sinew(&arguments, "");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    let bytes = std::fs::read(&picture).expect("written");
    let format = picture::Format::of(picture.as_ref()).expect("a format");
    let picture = picture::file::decode(&bytes, format).expect("a picture");
    // Flesh is seen, framed: in the middle of the picture, and not at its edge.
    let corner = picture.pixel(0, 0);
    let seen = (0..80).flat_map(|x| (0..60).map(move |y| (x, y)));
    let seen: Vec<(u32, u32)> = seen
        .filter(|&(x, y)| picture.pixel(x, y) != corner)
        .collect();
    assert!(seen.len() > 150, "{} pixels", seen.len());
    assert!(
        seen.iter()
            .all(|&(x, y)| (1..79).contains(&x) && (1..59).contains(&y))
    );

    let mesh = folder.write("mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let output = sinew(&["check", &mesh], "");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("no limbs"), "{said}");
}

#[test]
fn plots_are_numbers_and_drawings() {
    let folder = Folder::new("plot");
    let ball = folder.write("ball.rat", BALL);
    fn plot(arguments: &[&str]) -> Option<String> {
        let output = sinew(&[&["plot"], arguments].concat(), "");
        let path = arguments.last().expect("the output");
        (output.status.code() == Some(0)).then(|| std::fs::read_to_string(path).expect("written"))
    }
    fn rows(text: &str) -> Vec<Vec<f64>> {
        let rows = text.lines().skip(1);
        rows.map(|row| {
            row.split(',')
                .map(|n| n.parse().expect("a number"))
                .collect()
        })
        .collect()
    }
    let table = folder.path("plot.csv");
    let text = plot(&["--kernels", "gauss", "-o", &table]).expect("a kernel");
    assert!(text.starts_with("u,gauss\n"), "{text}");
    for row in rows(&text) {
        assert!(
            (row[1] - libm::exp(-row[0] * row[0])).abs() < 1e-12,
            "{row:?}"
        );
    }
    // Along a line from the middle of a ball outwards the field falls below 1 at its radius, 1.
    let line = ["--line", "0", "0", "0", "2", "0", "0"];
    let text = plot(&[&[ball.as_str()], &line[..], &["-o", &table]].concat()).expect("a line");
    for row in rows(&text) {
        assert!(
            (row[0] - 1.0).abs() < 1e-9 || (row[1] > 1.0) == (row[0] < 1.0),
            "{row:?}"
        );
    }
    // So it is on a plane.
    let window = ["--plane", "z=0", "--window", "-2", "-2", "2", "2"];
    let text = plot(&[&[ball.as_str()], &window[..], &["-o", &table]].concat()).expect("a plane");
    for row in rows(&text) {
        let distance = libm::hypot(row[0], row[1]);
        assert!(
            (distance - 1.0).abs() < 1e-5 || (row[2] > 1.0) == (distance < 1.0),
            "{row:?}"
        );
    }
    let drawing = folder.path("plot.svg");
    let text = plot(&["--kernels", "-o", &drawing]).expect("a drawing");
    assert!(text.contains("<path") && text.contains("cauchy") && text.ends_with("</svg>\n"));
    let text = plot(&[ball.as_str(), "--plane", "y=0.25", "-o", &drawing]).expect("a drawing");
    assert!(text.contains("1 T</text>"), "{text}");
    for wrong in [
        vec!["--kernels", "nosuch", "-o", &drawing],
        vec![&ball, "-o", &drawing],
        vec![&ball, "--plane", "w=0", "-o", &drawing],
        vec![
            &ball, "--plane", "z=0", "--window", "1", "0", "0", "1", "-o", &drawing,
        ],
        vec!["--kernels", "-o", "plot.txt"],
    ] {
        assert_eq!(plot(&wrong), None, "{wrong:?}");
    }
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
