//! Writes the trial head as an OBJ file, simplified to uneven facets or, with `even`, as it is
//! made.
//!
//! `cargo run -p fit --example head -- 420 www/examples/head.obj`

use fit::trial;
use std::fmt::Write;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let (Some(facets), Some(path)) = (arguments.next(), arguments.next()) else {
        return Err("give the number of facets and a file".into());
    };
    let facets = facets.parse()?;
    let mesh = if arguments.next().is_some_and(|word| word == "even") {
        trial::head(facets)
    } else {
        fit::recovery::coarse(facets)?
    };
    let mut text = String::from("# A head with neck and shoulders; it looks along -y, z is up.\n");
    for p in &mesh.positions {
        writeln!(text, "v {:.3} {:.3} {:.3}", p.x, p.y, p.z)?;
    }
    for [a, b, c] in &mesh.triangles {
        writeln!(text, "f {} {} {}", a + 1, b + 1, c + 1)?;
    }
    std::fs::write(path, text)?;
    Ok(())
}
