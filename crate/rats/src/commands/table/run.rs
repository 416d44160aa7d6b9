//! RUN: the flow of a text, variables, help.

use crate::commands::build::{clay, idle, row, run};
use crate::commands::options as o;
use crate::commands::parameter::{Kind, Names, parameter, word};
use crate::commands::spec::{Action, CommandSpec, Routine};

const REPORTS: &str = "the page and the program report what they do";

/// The commands.
#[rustfmt::skip]
pub static RUN: &[CommandSpec] = &[
    row("read", "run the commands of other files", Action::Read)
        .takes(&[parameter("fn", Kind::File, "a file's name").many()])
        .details("A file is looked for among the files of the project, then in the library (`tree.rat`, `shell.rat`, …). A file that reads itself, even by way of others, is refused.")
        .example("read sphereflake.rat\nlight White, position 4 8 10\nsurface Clay, diffuse SandyBrown\nsphereflake Clay, 2"),
    row("pause", "show a message", run(Routine::Pause))
        .takes(&[parameter("message", Kind::Text, "the message").optional("")])
        .details("RATS waits for a key. A page cannot, so the message is shown among the notes.")
        .example("pause this stands among the notes"),
    row("return", "return from a file, or from a defined command", run(Routine::Return))
        .example(clay!("sphere Clay 2, 0 0 0\nreturn\nnothing here is run")),
    row("info", "tell the version", run(Routine::Info)).example("info"),
    row("help", "explain a command, or list all", run(Routine::Help))
        .takes(&[parameter("command", Kind::Known(Names::Command), "a command").optional("")])
        .example("help sphere"),
    row("man", "explain a command and its options", run(Routine::Man))
        .takes(&[parameter("command", Kind::Known(Names::Command), "a command")])
        .example("man surface"),
    row("test", "run the example of a command", Action::Test)
        .takes(&[
            parameter("command", Kind::Known(Names::Command), "a command"),
            word("print", o::TEST, "`print`").optional(""),
        ])
        .details("The example joins the scene as if it had been read from a file. With `print` its text is only shown.")
        .example("test torus"),
    row("log", "open or close a log", idle(REPORTS))
        .takes(&[parameter("file", Kind::NewFile, "the log's name").optional("")])
        .example("log session.txt"),
    row("var", "create or change a variable; `hot` makes it a slider", run(Routine::Var))
        .takes(&[
            parameter("name", Kind::New(Names::Variable), "the variable's name"),
            parameter("= value", Kind::Value, "a value"),
        ])
        .options(o::VAR)
        .details("A value is a number, three numbers or a colour. A colour stays a colour when it is set to three numbers. `+= step` and `*= factor` change it with every frame of an animation.")
        .example(clay!("var r = 1.5 hot 0.5 2.5 0.1\nvar Where = 0 0 0\nsphere Clay r, Where")),
    row("stopwatch", "measure time", idle(REPORTS))
        .takes(&[word("what", o::STOPWATCH, "`start` or `stop`")])
        .example("stopwatch start"),
    row("quit", "end the run", run(Routine::Quit))
        .example(clay!("sphere Clay 2, 0 0 0\nquit\nnothing here is run")),
];
