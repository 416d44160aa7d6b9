//! Builds, serves, packs and tests Sinew: `cargo xtask COMMAND`.
//!
//! Every command installs what it lacks where that can be done without asking (Rust's wasm target,
//! node packages, tools in `.tools/`, on Debian and Ubuntu the browser), says what it runs, and
//! otherwise fails with a sentence that says what to install.

mod bench;
mod check;
mod dist;
mod examples;
mod figures;
mod fuzz;
mod packages;
mod page;
mod pins;
mod serve;
mod shell;
mod tools;

use clap::{Parser, Subcommand};
use std::process::ExitCode;

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
        /// The port; another one is taken if it is in use and was not asked for.
        #[arg(long)]
        port: Option<u16>,
        /// Build as for a release: slower to build, faster to use.
        #[arg(long)]
        release: bool,
    },
    /// Write dist/, a folder that any static host can serve from any path.
    Dist,
    /// Run all tests, or one part of them.
    Test {
        /// Only this part.
        part: Option<check::Part>,
        /// Only this package (a folder in crate/), or tests or files of browser tests with this in their names.
        filter: Option<String>,
    },
    /// Run the random tests with fresh seeds, the fuzzer of the language and the targets of cargo-fuzz, each for some minutes.
    Fuzz {
        /// Minutes for each.
        #[arg(default_value_t = 10)]
        minutes: u64,
    },
    /// Measure, and write BENCHMARKS.md; or measure one part and print it.
    Bench {
        /// Only this part.
        part: Option<bench::Part>,
    },
    /// Draw the thumbnails of the examples, www/examples/*.png, with our own renderer.
    Examples {
        /// Only these: names of files without their extension.
        names: Vec<String>,
    },
    /// Write the page of the thesis's figures, www/figures.html, and draw its pictures.
    Figures,
    /// Write the reference page, www/reference.html, and draw the pictures of its examples.
    Reference,
    /// Renew tests/pins.txt, the hashes that pictures are held to, after a change of the pictures that is meant, and show
    /// the old and the new pictures.
    Pins,
}

fn main() -> ExitCode {
    let done = match Arguments::parse().command {
        Command::Serve { port, release } => serve::serve(port, release),
        Command::Dist => dist::dist().map(|_| ()),
        Command::Test { part, filter } => check::test(part, filter),
        Command::Fuzz { minutes } => fuzz::fuzz(minutes),
        Command::Bench { part } => bench::bench(part),
        Command::Examples { names } => examples::draw(&names),
        Command::Figures => figures::figures(),
        Command::Reference => examples::reference(),
        Command::Pins => pins::renew(),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("\nxtask: {error:#}");
            ExitCode::FAILURE
        }
    }
}
