//! Writes the texts of which the reference page shows pictures, each as NAME.rat, into a folder.
//! `cargo xtask reference`, which draws their pictures, asks for them.

use std::path::PathBuf;

fn main() -> std::io::Result<()> {
    let Some(folder) = std::env::args_os().nth(1).map(PathBuf::from) else {
        eprintln!("usage: reference_texts FOLDER");
        std::process::exit(2);
    };
    for (name, text) in assist::manual::texts_with_pictures() {
        std::fs::write(folder.join(format!("{name}.rat")), text)?;
    }
    Ok(())
}
