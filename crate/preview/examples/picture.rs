//! Draws the draft of a dataset without a window, and tells how long a frame takes:
//! `cargo run -p preview --example picture -- www/examples/seahorse.rat draft.png 640 480`

// The tests' way to a device without a window.
#[path = "../tests/it/common/gpu.rs"]
#[allow(dead_code, reason = "one sample a pixel is for tests")]
mod gpu;

use std::error::Error;
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [file, out, size @ ..] = arguments.as_slice() else {
        return Err("usage: picture FILE OUT.png [WIDTH HEIGHT]".into());
    };
    let project = rats::Project {
        files: vec![rats::project::File {
            name: file.clone(),
            text: std::fs::read_to_string(file)?,
        }],
    };
    let compiled = rats::compile(&project);
    let scene = compiled.scene;
    let size = match size {
        [width, height] => [width.parse()?, height.parse()?],
        _ => scene.settings.frame,
    };
    let gpu = gpu::gpus().first().ok_or("no graphics adapter")?;
    let mut draft = preview::Draft::new(&gpu.device, &gpu.queue);
    let start = Instant::now();
    let drawn = draft.set_scene(&gpu.device, &gpu.queue, &scene);
    let prepared = start.elapsed();
    gpu.render(&mut draft, &scene.camera, size);
    let start = Instant::now();
    let picture = gpu.render(&mut draft, &scene.camera, size);
    println!(
        "{}: {drawn:?}, prepared in {prepared:.1?}, a frame in {:.1?}",
        gpu.name,
        start.elapsed()
    );

    let mut encoder = png::Encoder::new(
        std::io::BufWriter::new(std::fs::File::create(out)?),
        picture.size[0],
        picture.size[1],
    );
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder
        .write_header()?
        .write_image_data(picture.pixels.as_flattened())?;
    Ok(())
}
