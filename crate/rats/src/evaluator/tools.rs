//! TOOLS: work on pictures. The compiler touches no files, so each command becomes a [`Tool`] in
//! the result, for the program and the page to carry out.

use super::state::{Evaluator, Flow};
use crate::colours;
use crate::commands::build::{idle, options, plain, row, takes};
use crate::commands::slot::{
    Named, Placed, Slot, Text, colour, file, new_file, number, text, whole,
};
use crate::commands::{CommandSpec, Unit};
use crate::given::Options;
use crate::limits::MAX_TOOLS;
use crate::problem::{Outcome, Problem};
use crate::reader::Name;
use crate::syntax::Command;
use crate::tool::{Playback, Shown, Tool};
use scene::Rgb;

const FILE: Slot<Named> = file("fn", "a picture's name");
const OTHER: Slot<Named> = file("fn2", "another picture's name");
const WINDOW: Slot<Option<Text>> = text("w", "a window").optional("");
/// Details of all commands: the place of the pictures.
const WORK: &str = "The program works on files of the dataset's folder when it runs the dataset. \
    The page works on the images of the work and on its own picture \
    (`scene.png`, or as `filename` and \
    `format` say), and shows the results below the picture.";

/// Lists a job.
fn job<'a>(run: &mut Evaluator<'a>, command: &'a Command, tool: Tool) -> Outcome<Flow> {
    if run.tools.len() >= MAX_TOOLS {
        return Err(Problem::new(
            &command.span,
            format!("there are more than {MAX_TOOLS} jobs on files"),
        ));
    }
    run.tools.push(tool);
    run.tool_origins.push(run.origin(command));
    Ok(Flow::Next)
}

/// Returns the text of a name.
fn text_of(name: &Name<'_>) -> String {
    name.text.to_owned()
}

/// Returns the texts of names.
fn texts(names: &[Name<'_>]) -> Vec<String> {
    names.iter().map(text_of).collect()
}

options! {
    /// Options of `animate` and `play`.
    ANIMATE_OPTIONS:
    LOOP: () = ("loop", "", "again and again");
    MIRROR: () = ("mirror", "", "there and back");
    DITHER: () = ("dither", "", "fewer colours");
}

pub static ANIMATE: CommandSpec = row("animate", "make a film of pictures")
    .with(takes!(animate, [ANIMATE_OPTIONS], FILE.many()))
    .details(WORK)
    .example("animate one.png two.png loop");

fn animate<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    options: &Options<'a>,
    files: Vec<Name<'a>>,
) -> Outcome<Flow> {
    let tool = Tool::Animate {
        files: texts(&files),
        playback: match (options.has(&LOOP), options.has(&MIRROR)) {
            (_, true) => Playback::Mirror,
            (true, _) => Playback::Loop,
            _ => Playback::Once,
        },
        dither: options.has(&DITHER),
    };
    job(run, command, tool)
}

pub static PLAY: CommandSpec = row("play", "play a film")
    .with(takes!(
        |run, command, file| job(
            run,
            command,
            Tool::Play {
                file: text_of(&file)
            }
        ),
        FILE
    ))
    .details(WORK)
    .example("play film.gif");

pub static SPLIT: CommandSpec = row("split", "split a film into pictures")
    .with(takes!(
        |run, command, file, pattern| {
            let (file, pattern) = (text_of(&file), pattern.as_ref().map(text_of));
            job(run, command, Tool::Split { file, pattern })
        },
        FILE,
        new_file("frame.fmt", "the pictures' name").optional("frame.png")
    ))
    .details(WORK)
    .example("split film.gif frame.png");

options! {
    /// Options of `collage`.
    COLLAGE_OPTIONS:
    COLUMNS: u32 = ("columns", "as many as make it square", "pictures side by side",
        whole("n", 1, 256, "the number of columns"));
    GAP: u32 = ("gap", "0", "room between pictures",
        whole("p", 0, 256, "the gap").unit(Unit::Pixels));
}

pub static COLLAGE: CommandSpec = row("collage", "put pictures side by side")
    .with(takes!(collage, [COLLAGE_OPTIONS], FILE.many()))
    .details(WORK)
    .example("collage one.png two.png columns 2");

fn collage<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    options: &Options<'a>,
    files: Vec<Name<'a>>,
) -> Outcome<Flow> {
    let tool = Tool::Collage {
        columns: options.last(&COLUMNS),
        files: texts(&files),
    };
    job(run, command, tool)
}

options! {
    /// Options of `fli`.
    FLI_OPTIONS:
    SPEED: u32 = ("speed", "10", "pictures in a second",
        whole("N", 1, 100, "the pictures in a second"));
    SIZE: (u32, u32) = ("size", "of the first", "size of the film",
        whole("W", 1, 4096, "the width").unit(Unit::Pixels),
        whole("H", 1, 4096, "the height").unit(Unit::Pixels));
}

pub static FLI: CommandSpec = row("fli", "make a film of pictures of one size")
    .with(takes!(fli, [FLI_OPTIONS], FILE.many()))
    .details(
        "RATS wrote Autodesk's FLI; ours writes an animated GIF, and `animate` an animated PNG. \
         The program works on files of the dataset's folder, the page on the images of the work.",
    )
    .example("fli one.png two.png speed 12");

fn fli<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    options: &Options<'a>,
    files: Vec<Name<'a>>,
) -> Outcome<Flow> {
    let tool = Tool::Fli {
        files: texts(&files),
        speed: options.last(&SPEED).map(f64::from),
        size: options.last(&SIZE).map(|(width, height)| [width, height]),
    };
    job(run, command, tool)
}

pub static CONVERT: CommandSpec = row("convert", "convert a picture")
    .with(takes!(
        |run, command, from, to| {
            let (from, to) = (text_of(&from), text_of(&to));
            job(run, command, Tool::Convert { from, to })
        },
        FILE,
        new_file("fn2", "the new picture's name")
    ))
    .details(WORK)
    .example("convert one.png one.tga");

pub static RESIZE: CommandSpec = row("resize", "resize a picture")
    .with(takes!(
        |run, command, file, width, height| {
            let file = text_of(&file);
            job(
                run,
                command,
                Tool::Resize {
                    file,
                    width,
                    height,
                },
            )
        },
        FILE,
        whole("x", 1, 8192, "the width").unit(Unit::Pixels),
        whole("y", 1, 8192, "the height").unit(Unit::Pixels)
    ))
    .details(WORK)
    .example("resize one.png 320 200");

options! {
    /// Options of `diff`, `and` and `xor`.
    SAVE_OPTIONS:
    SAVE: Option<Named> = ("save", "", "writes the result",
        new_file("fn", "the new file's name").optional("the command's, as `diff.png`"));
}

/// Returns the name under which a result is saved, if it is; `own` where the text gives none.
fn name_to_save(options: &Options<'_>, own: &str) -> Option<String> {
    let name = options.last(&SAVE)?;
    Some(name.map_or_else(|| own.to_owned(), |name| text_of(&name)))
}

/// Writes the function of a command that makes one picture of two.
macro_rules! join {
    ($function:ident, $Tool:ident, $own:literal) => {
        fn $function<'a>(
            run: &mut Evaluator<'a>,
            command: &'a Command,
            options: &Options<'a>,
            a: Name<'a>,
            b: Name<'a>,
        ) -> Outcome<Flow> {
            let [a, b] = [a, b].map(|name| text_of(&name));
            let save = name_to_save(options, $own);
            job(run, command, Tool::$Tool { a, b, save })
        }
    };
}

join!(diff, Diff, "diff.png");
join!(and, And, "and.png");
join!(xor, Xor, "xor.png");

pub static DIFF: CommandSpec = row("diff", "difference of two pictures")
    .with(takes!(diff, [SAVE_OPTIONS], FILE, OTHER))
    .details(WORK)
    .example("diff one.png two.png save difference.png");

pub static AND: CommandSpec = row("and", "AND of two pictures")
    .with(takes!(and, [SAVE_OPTIONS], FILE, OTHER))
    .details(WORK)
    .example("and one.png two.png save both.png");

pub static XOR: CommandSpec = row("xor", "XOR of two pictures")
    .with(takes!(xor, [SAVE_OPTIONS], FILE, OTHER))
    .details(WORK)
    .example("xor one.png two.png save either.png");

options! {
    /// Options of `show`.
    SHOW_OPTIONS:
    PICTURE: Named = ("file", "", "a picture", file("fn", "a picture's name"));
    COLOUR: Placed<Rgb> = ("color", "", "a colour", colour("Color", "a colour").with_place());
    PALETTE: () = ("palette", "", "all colours with a name");
}

/// `show file fn`, `show color Color`, `show palette`
pub static SHOW: CommandSpec = row("show", "show a file, a colour, a palette")
    .with(takes!(show, [SHOW_OPTIONS]))
    .details(WORK)
    .example("show color OrangeRed");

fn show<'a>(run: &mut Evaluator<'a>, command: &'a Command, options: &Options<'a>) -> Outcome<Flow> {
    let source = &run.sources.all[run.file];
    let chosen = match &options.0[..] {
        [] => {
            return Err(
                Problem::new(&command.span, "`show` needs something to show")
                    .hint("`file`, `color` or `palette`"),
            );
        }
        [chosen] => chosen,
        [_, second, ..] => {
            return Err(Problem::new(
                &second.span,
                "`show` shows one thing at a time",
            ));
        }
    };
    let what = if let Some(file) = PICTURE.of(chosen) {
        Shown::File(file.text.to_owned())
    } else if let Some((rgb, span)) = COLOUR.of(chosen) {
        let written = &source.text[span];
        // How a text is laid out must not matter, so only a word is kept as it is written.
        let name = if written.chars().all(char::is_alphanumeric) {
            written.to_owned()
        } else {
            rgb.map(|share| share.to_string()).join(" ")
        };
        Shown::Colour { name, rgb }
    } else {
        Shown::Palette(colours::names().filter_map(colours::find).collect())
    };
    job(run, command, Tool::Show { what })
}

pub static TABLE: CommandSpec = row("table", "plot numbers")
    .with(takes!(table, number("v", "a number").many()))
    .details(
        "A polyline of 2 to 256 points. The program writes it as a picture, `table.png`; the page \
         shows it below the picture of the model.",
    )
    .example("table 1 4 9 16 25");

fn table<'a>(run: &mut Evaluator<'a>, command: &'a Command, values: Vec<f64>) -> Outcome<Flow> {
    if !(2..=256).contains(&values.len()) {
        return Err(Problem::new(
            &command.span,
            format!("a table has from 2 to 256 numbers, not {}", values.len()),
        ));
    }
    job(run, command, Tool::Table { values })
}

pub static KILL: CommandSpec = row("kill", "close windows")
    .with(idle(
        "results go when the commands that made them go",
        plain![WINDOW],
    ))
    .example("kill");

pub static REFRESH: CommandSpec = row("refresh", "draw windows again")
    .with(idle(
        "results are made again when the text or its pictures change",
        plain![WINDOW],
    ))
    .example("refresh");

pub static TILE: CommandSpec = row("tile", "arrange windows")
    .with(idle("results lie side by side anyway", plain![WINDOW]))
    .example("tile");
