//! `cargo xtask COMMAND`.

use anyhow::Result;
use clap::{Parser, Subcommand};
use std::process::ExitCode;
use xtask::{check, dist, examples, figures, fuzz, package, pins, serve, shell};

#[derive(Parser)]
#[command(name = "cargo xtask", about = "Builds, serves, packs and tests Sinew.")]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Build the page and serve it on this machine.
    Serve {
        /// The port. Without this option another one is taken if 8080 is in use.
        #[arg(long)]
        port: Option<u16>,
        /// Build it as for a release: slower to build, faster to use.
        #[arg(long)]
        release: bool,
    },
    /// Write dist/, a folder that any static host can serve from any path.
    Dist,
    /// Write target/npm/sinew/, an npm package for other pages.
    Package,
    /// Run all tests, or one part of them.
    Test {
        /// Part to run.
        part: Option<check::Part>,
        /// Package to test (a folder in crate/), or part of the names of tests or of files of
        /// browser tests.
        filter: Option<String>,
    },
    /// Run the random tests with fresh seeds, the fuzzer of the language and the targets of
    /// cargo-fuzz, each for some minutes.
    Fuzz {
        /// Minutes for each.
        #[arg(default_value_t = 10)]
        minutes: u64,
    },
    /// Measure, and write BENCHMARKS.md.
    Bench {
        /// Parts to run; all if none is named.
        parts: Vec<String>,
    },
    /// Draw the thumbnails of the examples, www/examples/*.png, with our own renderer.
    Examples {
        /// Names of files without their extension; all if none is named.
        names: Vec<String>,
    },
    /// Write the page of the papers' figures and tables, www/figures.html, and draw its pictures.
    Figures,
    /// Write the reference page, www/reference.html, and draw the pictures of its examples.
    Reference,
    /// Write shaders/field/, the formulas of the chart for the graphics card.
    Shaders,
    /// Renew tests/pins.txt, the hashes that pictures must have, after an intended change of the
    /// pictures, and show the old and the new ones.
    Pins,
}

fn main() -> ExitCode {
    xtask::end(run(Arguments::parse().command))
}

fn run(command: Command) -> Result<()> {
    match command {
        Command::Serve { port, release } => serve::serve(port, release),
        Command::Dist => dist::dist().map(|_| ()),
        Command::Package => package::package().map(|_| ()),
        Command::Test { part, filter } => check::test(part, filter),
        Command::Fuzz { minutes } => fuzz::fuzz(minutes),
        Command::Bench { parts } => {
            let bench = shell::words("run --package bench --");
            shell::run(shell::cargo(&bench).args(parts))
        }
        Command::Examples { names } => examples::draw(&names),
        Command::Figures => figures::figures(),
        Command::Reference => examples::reference(),
        Command::Shaders => shell::run(&mut shell::cargo(&shell::words("run --package shader"))),
        Command::Pins => pins::renew(),
    }
}
