//! Writes the chart's formulas to `shaders/field/`.
use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shaders/field");
    for cell in shader::cells::all() {
        let path = folder.join(&cell.name).with_extension("wgsl");
        if let Err(error) = std::fs::write(&path, cell.file()) {
            eprintln!("{}: {error}", path.display());
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}
