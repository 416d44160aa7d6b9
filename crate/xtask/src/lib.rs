//! Builds, serves, packs and tests Sinew. Every command installs what it lacks where that can be
//! done without asking (Rust's wasm target, node packages, on Debian and Ubuntu the browser), says
//! what it runs, and otherwise fails with a sentence that says what to install.

pub mod check;
pub mod dist;
pub mod examples;
pub mod figures;
pub mod fuzz;
pub mod offline;
pub mod package;
pub mod packages;
pub mod page;
pub mod pictures;
pub mod pins;
pub mod serve;
pub mod shell;
pub mod tools;

/// Ends a command: prints the reason if it failed.
pub fn end(result: anyhow::Result<()>) -> std::process::ExitCode {
    let Err(error) = result else {
        return std::process::ExitCode::SUCCESS;
    };
    eprintln!("\nxtask: {error:#}");
    std::process::ExitCode::FAILURE
}
