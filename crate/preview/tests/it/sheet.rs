//! The draft of every example of the gallery beside its traced picture, with the offset surfaces
//! and with a mesh of the true surface: a contact sheet to look at, `target/tmp/drafts-N.png`, and
//! what can be said of it in numbers.

use crate::common::gpu::{Gpu, Picture, gpus};
use preview::{Draft, Mesh, Sampling, looks};
use rats::{Asset, File, Project};
use scene::Scene;
use std::path::{Path, PathBuf};
use tools::{Detail, Job, Progress, ViewScene};

fn examples() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../www/examples")
}

/// The scene of an example, with the files that its text names.
fn scene(name: &str) -> Scene {
    fn read(name: &str) -> Vec<u8> {
        std::fs::read(examples().join(name)).unwrap()
    }
    let text = String::from_utf8(read(&format!("{name}.rat"))).unwrap();
    let mut files = vec![File {
        name: format!("{name}.rat"),
        text: text.clone(),
    }];
    let mut assets = Vec::new();
    for entry in std::fs::read_dir(examples()).unwrap() {
        let file = entry.unwrap().file_name().into_string().unwrap();
        if file.ends_with(".rat") || !text.contains(&file) {
            continue;
        }
        let bytes = read(&file);
        if file.ends_with(".strokes") {
            let text = String::from_utf8(bytes).unwrap();
            files.push(File { name: file, text });
        } else {
            assets.push(Asset::new(file, bytes));
        }
    }
    let compiled = rats::compile_at(&Project { files }, &assets, 0.0);
    assert!(!compiled.scene.elements.is_empty(), "{name}");
    std::sync::Arc::unwrap_or_clone(compiled.scene)
}

/// The traced picture of an example, as the gallery shows it.
fn gallery_picture(name: &str) -> Picture {
    let file = std::fs::File::open(examples().join(format!("{name}.png"))).unwrap();
    let mut decoder = png::Decoder::new(std::io::BufReader::new(file));
    decoder.set_transformations(png::Transformations::normalize_to_color8());
    let mut reader = decoder.read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    let step = info.color_type.samples();
    assert!(step >= 3, "{name}.png has colours");
    let pixels = bytes.chunks_exact(step).map(|p| [p[0], p[1], p[2], 255]);
    Picture {
        size: [info.width, info.height],
        pixels: pixels.collect(),
    }
}

/// Most elements of a scene that is meshed here: unoptimised code takes long for more.
const MOST: usize = 150;

/// Draws a scene as offset surfaces, and, if it has a finite soft surface of a moderate size, as a
/// mesh.
fn drafts(gpu: &Gpu, scene: &Scene, size: [u32; 2]) -> (Picture, Option<Picture>) {
    let mut draft = Draft::new(&gpu.device, &gpu.queue);
    draft.set_sampling(Sampling::Four);
    draft.set_scene(&gpu.device, &gpu.queue, scene);
    let plain = gpu.render(&mut draft, &scene.camera, size);
    let mut soft = scene.clone();
    soft.elements.retain(|element| scene.is_soft(element));
    let is_endless = soft
        .elements
        .iter()
        .any(|element| element.shape.bounds(0.0).is_none());
    if soft.elements.is_empty() || is_endless || soft.elements.len() > MOST {
        return (plain, None);
    }
    let job = ViewScene {
        looks: looks(&soft),
        scene: soft.into(),
        detail: Detail::Coarse,
    };
    let view = match job.run(&mut Progress::silent()) {
        // A lattice: the page drafts it, too.
        Err(error) if error == "the surface has too many parts" => {
            return (plain, None);
        }
        view => view.expect("there is a surface"),
    };
    let mesh = Mesh {
        vertices: &view.vertices,
        triangles: &view.triangles,
        origin: view.origin,
        unit: view.unit,
    };
    assert!(draft.set_mesh(&gpu.device, &gpu.queue, Some(&mesh)));
    (plain, Some(gpu.render(&mut draft, &scene.camera, size)))
}

/// Mean difference of two pictures of one size, of 255, after both were made coarser: where things
/// are and what colours they have counts, not their edges.
fn difference(a: &Picture, b: &Picture) -> f64 {
    const BLOCK: u32 = 16;
    assert_eq!(a.size, b.size);
    let [width, height] = a.size.map(|side| side / BLOCK);
    let mut sum = 0.0;
    for y in 0..height {
        for x in 0..width {
            for channel in 0..3 {
                let [mean_a, mean_b] = [a, b].map(|picture| {
                    let mut sum = 0.0;
                    for dy in 0..BLOCK {
                        for dx in 0..BLOCK {
                            let at = (y * BLOCK + dy) * picture.size[0] + x * BLOCK + dx;
                            sum += f64::from(picture.pixels[at as usize][channel]);
                        }
                    }
                    sum / f64::from(BLOCK * BLOCK)
                });
                sum += (mean_a - mean_b).abs();
            }
        }
    }
    sum / f64::from(3 * width * height)
}

/// Examples of a contact sheet.
const A_SHEET: usize = 10;
const CELL: [u32; 2] = [272, 204];

/// Writes rows of three pictures.
fn write(number: usize, rows: &[[Option<&Picture>; 3]]) {
    let [w, h] = CELL;
    let (width, height) = (3 * w, h * rows.len() as u32);
    let mut pixels = vec![[40, 40, 40, 255]; (width * height) as usize];
    for (row, pictures) in rows.iter().enumerate() {
        for (column, picture) in pictures.iter().enumerate() {
            let Some(picture) = picture else { continue };
            for y in 0..picture.size[1].min(h) {
                for x in 0..picture.size[0].min(w) {
                    let at = (row as u32 * h + y) * width + column as u32 * w + x;
                    pixels[at as usize] = picture.pixels[(y * picture.size[0] + x) as usize];
                }
            }
        }
    }
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("drafts-{number}.png"));
    let file = std::io::BufWriter::new(std::fs::File::create(path).unwrap());
    let mut encoder = png::Encoder::new(file, width, height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(pixels.as_flattened()).unwrap();
}

#[test]
fn drafts_of_all_examples_look_like_their_pictures() {
    let Some(gpu) = gpus().first() else { return };
    let mut names: Vec<String> = std::fs::read_dir(examples())
        .unwrap()
        .filter_map(|entry| entry.unwrap().file_name().into_string().ok())
        .filter_map(|name| name.strip_suffix(".rat").map(str::to_owned))
        .collect();
    // `SHEET=coils,coral` draws those with such names alone.
    if let Ok(wanted) = std::env::var("SHEET") {
        names.retain(|name| wanted.split(',').any(|part| name.contains(part)));
    }
    names.sort();
    let mut bad = Vec::new();
    for (number, names) in names.chunks(A_SHEET).enumerate() {
        let mut rows = Vec::new();
        for name in names {
            let scene = scene(name);
            let traced = gallery_picture(name);
            let begun = std::time::Instant::now();
            let (plain, mesh) = drafts(gpu, &scene, traced.size);
            let off = difference(&plain, &traced);
            let near = mesh.as_ref().map(|mesh| difference(mesh, &traced));
            println!(
                "{name}: draft {off:.1}, mesh {near:.1?}, {:.1?}",
                begun.elapsed()
            );
            let (draft_bound, mesh_bound) = bounds(name);
            if off > draft_bound || near.is_some_and(|near| near > mesh_bound) {
                bad.push(format!("{name}: {off:.1} {near:.1?}"));
            }
            rows.push((plain, mesh, traced));
        }
        let rows: Vec<[Option<&Picture>; 3]> = rows
            .iter()
            .map(|(plain, mesh, traced)| [Some(plain), mesh.as_ref(), Some(traced)])
            .collect();
        write(number, &rows);
    }
    assert!(bad.is_empty(), "{bad:#?}");
}

/// The largest differences of draft and mesh from the traced picture. Neither has shadows, and
/// textures are their mean colours; what is seen in glass and mirrors is not drawn at all.
fn bounds(name: &str) -> (f64, f64) {
    match name {
        "glass-drops" | "diamond" | "pebbles" | "still-life" => (31.0, 25.0),
        "shell-2" | "shell-3" | "starfish" | "starfish-c" | "sea-urchin" => (31.0, 25.0),
        // Its picture is a map of what each pixel costs.
        "time-map" => (20.0, 21.0),
        _ => (20.0, 19.0),
    }
}
