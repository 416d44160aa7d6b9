//! The program `sinew`: the same core as the page, on a command line.
//!
//! Each subcommand is a module of its own; without one the program takes the options of RATS.
//! Results go to the standard output, everything said to a person goes to the standard error, and
//! the exit status is 0 when all went well, 1 when the dataset has errors or a fit failed, and 2
//! when the command could not be carried out at all.

mod animate;
mod check;
mod classic;
mod files;
mod fit;
mod fmt;
mod interludes;
mod meshes;
mod plot;
mod probe;
mod render;
mod report;
mod said;
mod scan;
mod sculpt;
mod share;
mod skeleton;
mod time;
mod tools;
mod trace;
mod view;
mod whole;

use clap::{CommandFactory, Parser, Subcommand};
use std::process::ExitCode;

#[derive(Parser)]
#[command(
    name = "sinew",
    version,
    about = "Convolution surfaces: smooth shapes grown on a skeleton",
    after_help = "sinew [-/+options] FILE.rat … runs datasets as RATS did; sinew -? lists its \
        options."
)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Say what is wrong with a dataset
    Check(check::Check),
    /// Trace a dataset's picture
    Render(render::Render),
    /// Trace a dataset whose variables change with the frames to an animation
    Animate(animate::Animate),
    /// Mesh a dataset's surfaces, for printers and other programs
    Mesh(meshes::Mesh),
    /// Evaluate the field at points, or intersect rays with the surface
    Probe(probe::Probe),
    /// Plot kernels, or the field along a line or on a plane
    Plot(plot::Plot),
    /// Carry out the strokes of a sculpture and write its mesh
    Sculpt(sculpt::Sculpt),
    /// Tell what is in a skeleton's file, or write it in another format
    Skeleton(skeleton::Skeleton),
    /// Bring a mesh onto measured points and outlines
    Fit(Box<fit::Fit>),
    /// Measure a dataset's surfaces: points and outlines, with noise, gaps and outliers
    Scan(scan::Scan),
    /// Lay datasets out: indentation and spaces, nothing that they mean
    Fmt(fmt::Fmt),
    /// Print the evaluated scene as JSON
    Scene(check::Scene),
    /// Print the link that opens a dataset in the page
    Share(share::Share),
    /// Take a link apart: print or write the texts it carries
    Open(share::Open),
    /// Time the tracer on one thread (for `cargo xtask bench`)
    #[command(hide = true)]
    Time(time::Time),
}

/// Result of a subcommand: `Ok(true)` all well, `Ok(false)` the dataset has errors or a fit failed,
/// `Err` a sentence that says why it could not be carried out and what to do.
type Outcome = Result<bool, String>;

fn main() -> ExitCode {
    match run() {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(sentence) => {
            eprintln!("sinew: {sentence}");
            ExitCode::from(2)
        }
    }
}

fn run() -> Outcome {
    let arguments: Vec<String> = std::env::args_os()
        .skip(1)
        .map(|word| word.to_string_lossy().into_owned())
        .collect();
    let description = Arguments::command();
    let subcommands: Vec<&str> = description
        .get_subcommands()
        .map(|subcommand| subcommand.get_name())
        .chain(["help"])
        .collect();
    if classic::is_meant(&arguments, &subcommands) {
        return classic::run(&arguments);
    }
    match Arguments::parse().command {
        Command::Check(command) => command.run(),
        Command::Render(command) => command.run(),
        Command::Animate(command) => command.run(),
        Command::Sculpt(command) => command.run(),
        Command::Skeleton(command) => command.run(),
        Command::Fit(command) => command.run(),
        Command::Scan(command) => command.run(),
        Command::Fmt(command) => command.run(),
        Command::Mesh(command) => command.run(),
        Command::Plot(command) => command.run(),
        Command::Probe(command) => command.run(),
        Command::Scene(command) => command.run(),
        Command::Share(command) => command.run(),
        Command::Open(command) => command.run(),
        Command::Time(command) => command.run(),
    }
}
