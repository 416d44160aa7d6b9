//! TOOLS: pictures, films, and generators.

use crate::commands::build::{clay, idle, library, row, run};
use crate::commands::options as o;
use crate::commands::parameter::{Kind, Parameter, Unit, number, parameter, whole};
use crate::commands::spec::{CommandSpec, Routine};

const FILE: Parameter = parameter("fn", Kind::File, "a picture's name");
const OTHER: Parameter = parameter("fn2", Kind::File, "another picture's name");
const WINDOW: Parameter = parameter("w", Kind::Text, "a window").optional("");
/// Where the pictures are, for the details of all of them.
const WORK: &str = "The program works on files of the dataset's folder when it runs the dataset. The page works on the images of the work and on its own picture (`scene.png`, or as `filename` and `format` say), and shows the results below the picture.";

/// The commands.
#[rustfmt::skip]
pub static TOOLS: &[CommandSpec] = &[
    row("animate", "make a film of pictures", run(Routine::Animate))
        .takes(&[FILE.many()])
        .options(o::ANIMATE)
        .details(WORK)
        .example("animate one.png two.png loop"),
    row("play", "play a film", run(Routine::Play))
        .takes(&[FILE])
        .details(WORK)
        .example("play film.gif"),
    row("split", "split a film into pictures", run(Routine::Split))
        .takes(&[FILE, parameter("frame.fmt", Kind::NewFile, "the pictures' name").optional("frame.png")])
        .details(WORK)
        .example("split film.gif frame.png"),
    row("collage", "put pictures side by side", run(Routine::Collage))
        .takes(&[FILE.many()])
        .options(o::COLLAGE)
        .details(WORK)
        .example("collage one.png two.png columns 2"),
    row("fli", "make a film of pictures of one size", run(Routine::Fli))
        .takes(&[FILE.many()])
        .options(o::FLI)
        .details("RATS wrote Autodesk's FLI; ours writes an animated GIF, and `animate` an animated PNG. The program works on files of the dataset's folder, the page on the images of the work.")
        .example("fli one.png two.png speed 12"),
    row("convert", "convert a picture", run(Routine::Convert))
        .takes(&[FILE, parameter("fn2", Kind::NewFile, "the new picture's name")])
        .details(WORK)
        .example("convert one.png one.tga"),
    row("resize", "resize a picture", run(Routine::Resize))
        .takes(&[FILE, whole("x", 1, 8192, "the width").unit(Unit::Pixels), whole("y", 1, 8192, "the height").unit(Unit::Pixels)])
        .details(WORK)
        .example("resize one.png 320 200"),
    row("diff", "difference of two pictures", run(Routine::Diff))
        .takes(&[FILE, OTHER]).options(o::SAVE).details(WORK)
        .example("diff one.png two.png save difference.png"),
    row("and", "AND of two pictures", run(Routine::And))
        .takes(&[FILE, OTHER]).options(o::SAVE).details(WORK)
        .example("and one.png two.png save both.png"),
    row("xor", "XOR of two pictures", run(Routine::Xor))
        .takes(&[FILE, OTHER]).options(o::SAVE).details(WORK)
        .example("xor one.png two.png save either.png"),
    row("show", "show a file, a colour, a palette", run(Routine::Show))
        .options(o::SHOW)
        .details(WORK)
        .example("show color OrangeRed"),
    row("kill", "close windows", idle("results go when the commands that made them go")).takes(&[WINDOW]).example("kill"),
    row("refresh", "draw windows again", idle("results are made again when the text or its pictures change")).takes(&[WINDOW]).example("refresh"),
    row("tile", "arrange windows", idle("results lie side by side anyway")).takes(&[WINDOW]).example("tile"),
    row("colors", "list the colours by name", run(Routine::Colors)).example("colors"),
    row("rats", "small talk", run(Routine::Rats)).example("rats"),
    row("table", "plot numbers", run(Routine::Table))
        .takes(&[number("v", "a number").many()])
        .details("A polyline of 2 to 256 points. The program draws it as a picture `table.png`, and the page shows it below its own picture.")
        .example("table 1 4 9 16 25"),
    library("shell", "a spiral shell of spheres")
        .example(clay!("eyep 1 3 1.5\nvrp -0.1 0 0\nvup 0 0 1\nshell Clay, 5, rise=0.4")),
    library("horn", "a curled horn that tapers")
        .example(clay!("eyep 0.5 4 1.2\nvrp 0.5 0 0.7\nvup 0 0 1\nhorn Clay, length=2.5, curl=200")),
];
