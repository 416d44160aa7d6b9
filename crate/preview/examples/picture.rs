//! Draws the true surface of a dataset on this machine's adapter, tells how long a frame takes, and
//! with `--compare` how much it differs from the traced picture; with `--cubics` as the page does:
//! `cargo run --release -p preview --example picture -- www/examples/seahorse.rat out.png 512 512`

// The tests' way to a device without a window, and to the tracer.
#[path = "../tests/it/common/traced.rs"]
mod traced;

use cells::Detail;
use preview::{Stage, Tracer, orbit};
use scene::Camera;
use std::error::Error;
use std::path::Path;
use std::time::Instant;
use traced::Card;

/// Frames of a turn.
const FRAMES: u32 = 30;
/// Seconds after which no further frame is begun.
const LONGEST: f64 = 10.0;

fn main() -> Result<(), Box<dyn Error>> {
    let (options, arguments): (Vec<_>, Vec<_>) = std::env::args()
        .skip(1)
        .partition(|argument| argument.starts_with("--"));
    let [file, out, size @ ..] = arguments.as_slice() else {
        return Err(
            "usage: picture FILE OUT.png [WIDTH HEIGHT] [--compare] [--quick | --full] [--cubics]"
                .into(),
        );
    };
    let scene = load(Path::new(file))?;
    let size = match size {
        [width, height] => [width.parse()?, height.parse()?],
        _ => scene.settings.frame,
    };
    let detail = if options.iter().any(|option| option == "--quick") {
        Detail::Quick
    } else if options.iter().any(|option| option == "--full") {
        Detail::Full
    } else {
        Detail::Fine
    };
    let card = traced::open().ok_or("no graphics adapter")?;
    let start = Instant::now();
    let has_formulas = !options.iter().any(|option| option == "--cubics");
    let (mut tracer, packed) = card.prepare_with(&scene, detail, Stage::Compute, has_formulas);
    println!(
        "{} leaves, {} rough, work {}, {} kB, prepared in {:.0?}",
        packed.leaves,
        packed.rough,
        packed.work,
        packed.data.len() / 1000,
        start.elapsed()
    );
    let pixels = card.read(&mut tracer, &scene.camera, size);
    let bytes: Vec<u8> = (pixels.iter())
        .flat_map(|pixel| pixel.colour.map(|channel| (channel * 255.0 + 0.5) as u8))
        .collect();
    let file = std::io::BufWriter::new(std::fs::File::create(out)?);
    let mut encoder = png::Encoder::new(file, size[0], size[1]);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header()?.write_image_data(&bytes)?;

    let start = Instant::now();
    let mut frames = 0;
    while frames < FRAMES && start.elapsed().as_secs_f64() < LONGEST {
        let across = 2.0 * f64::from(frames) / f64::from(FRAMES);
        draw(
            &card,
            &mut tracer,
            &orbit::orbit(scene.camera, across, 0.0),
            size,
        );
        frames += 1;
    }
    let frame_ms = 1e3 * start.elapsed().as_secs_f64() / f64::from(frames);
    let surface = pixels.iter().filter(|pixel| pixel.distance >= 0.0).count();
    let evaluations: u64 = pixels.iter().map(|p| u64::from(p.evaluations[0])).sum();
    let differs = if options.iter().any(|option| option == "--compare") {
        let differs = traced::compare(&scene, size, &pixels);
        format!(
            ",\"differs\":{{\"coverage\":{:.5},\"distance\":{:.5},\"normal\":{:.5}}}",
            differs.coverage, differs.distance, differs.normal
        )
    } else {
        String::new()
    };
    println!(
        "{{\"adapter\":{:?},\"elements\":{},\"surface_pixels\":{surface},\
         \"frame_ms\":{frame_ms:.2},\"evaluations_per_pixel\":{:.2},\"meshed\":{:?}{differs}}}",
        card.device.adapter_info().name,
        packed.elements,
        evaluations as f64 / pixels.len() as f64,
        packed.meshed,
    );
    Ok(())
}

/// Draws a frame and waits for it.
fn draw(card: &Card, tracer: &mut Tracer, camera: &Camera, size: [u32; 2]) {
    let mut encoder = card.device.create_command_encoder(&<_>::default());
    tracer.render(&card.device, &card.queue, &mut encoder, camera, size);
    card.queue.submit([encoder.finish()]);
    let poll = wgpu::PollType::wait_indefinitely();
    card.device.poll(poll).expect("the device answers");
}

/// Compiles a dataset with the files beside it that it reads.
fn load(path: &Path) -> Result<scene::Scene, Box<dyn Error>> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let mut project = rats::Project {
        files: vec![rats::File {
            name: name.into_owned(),
            text: std::fs::read_to_string(path)?,
        }],
    };
    let text = project.files[0].text.clone();
    for name in rats::reads(&text) {
        if let Ok(text) = std::fs::read_to_string(folder.join(&name)) {
            project.files.push(rats::File { name, text });
        }
    }
    let mut assets = Vec::new();
    for name in rats::asset_names(&text) {
        if let Ok(bytes) = std::fs::read(folder.join(&name)) {
            assets.push(rats::Asset::new(name, bytes));
        }
    }
    let compiled = rats::compile_at(&project, &assets, 0.0);
    Ok(std::sync::Arc::unwrap_or_clone(compiled.scene))
}
