//! Times the tracer on the benchmark scenes and on the cowrie.
//!
//! `cargo run --release -p tracer --example time -- SCENE.json … [--out FOLDER] [--pass full]`
//!
//! A scene file holds `points` (x y z R), `lines` (x₀ y₀ z₀ x₁ y₁ z₁ R) or `arcs`, and a camera;
//! the name `cowrie` stands for the cowrie of the published dataset.
use glam::DVec3;
use scene::{Camera, Element, Light, LightKind, Material, Origin, Scene, Shape};
use std::time::Instant;
use tracer::{Pass, Picture, Stats, Tile};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut out = None;
    let mut pass = Pass::Full;
    let mut names = Vec::new();
    let mut args = std::env::args().skip(1);
    while let Some(arg) = args.next() {
        match arg.as_str() {
            "--out" => out = args.next(),
            "--pass" => {
                pass = match args.next().as_deref() {
                    Some("coarse") => Pass::Coarse,
                    Some("smooth") => Pass::Smooth,
                    _ => Pass::Full,
                }
            }
            _ => names.push(arg),
        }
    }
    for name in names {
        let scene = if name == "cowrie" {
            cowrie()
        } else {
            benchmark(&serde_json::from_str(&std::fs::read_to_string(&name)?)?)
                .ok_or("not a benchmark scene")?
        };
        let size = scene.settings.frame;
        let mut best = f64::INFINITY;
        let mut result = None;
        for _ in 0..3 {
            let start = Instant::now();
            let mut stats = Stats::default();
            let whole = Tile {
                x: 0,
                y: 0,
                width: size[0],
                height: size[1],
            };
            let pixels = Picture::new(&scene, size).trace(whole, pass, &|| false, &mut stats);
            result = pixels.map(|pixels| (pixels, stats));
            best = best.min(start.elapsed().as_secs_f64());
        }
        let (pixels, stats) = result.ok_or("nothing rendered")?;
        let stem = std::path::Path::new(&name)
            .file_stem()
            .map_or(name.clone(), |s| s.to_string_lossy().into_owned());
        println!(
            "{stem}: {} elements, {best:.3} s, {} primary rays, {} shadow rays, {:.1} evaluations a ray",
            scene.elements.len(),
            stats.primary_rays,
            stats.shadow_rays,
            stats.field_evaluations as f64 / (stats.primary_rays + stats.shadow_rays) as f64,
        );
        if let Some(folder) = &out {
            let file = std::fs::File::create(format!("{folder}/{stem}.png"))?;
            let mut png = png::Encoder::new(file, size[0], size[1]);
            png.set_color(png::ColorType::Rgba);
            png.write_header()?.write_image_data(&pixels)?;
        }
    }
    Ok(())
}

fn element(shape: Shape, material: usize) -> Element {
    Element {
        shape,
        material,
        kernel: std::env::var("KERNEL")
            .ok()
            .and_then(|k| field::Kernel::named(&k))
            .unwrap_or(field::Kernel::Gauss),
        origin: Origin::default(),
    }
}

fn flesh(diffuse: [f32; 3], shine: f32, blobbiness: f64, radius: f64, strength: f64) -> Material {
    Material {
        ambient: diffuse.map(|c| c * Material::AMBIENT_SHARE),
        diffuse,
        specular: [1.0; 3],
        shine,
        blobbiness,
        radius,
        strength,
        ..Material::default()
    }
}

/// The cowrie: three arcs and a hundred spikes.
fn cowrie() -> Scene {
    let mut scene = Scene::default();
    scene.settings.frame = [640, 480];
    scene.settings.samples = 4;
    scene.settings.blob_scale = field::BlobScale::Absolute;
    scene.settings.fragile = scene::Fragile::ALL;
    scene.camera = Camera {
        eye: DVec3::splat(3.0),
        target: DVec3::ZERO,
        up: DVec3::Z,
        fov: 50.0,
        shift: [0.0; 2],
    };
    scene.lights.push(Light {
        kind: LightKind::Point {
            position: DVec3::new(2.0, 4.0, 3.0),
        },
        colour: [1.2; 3],
        shadow: std::env::var("SHADOW").is_ok(),
    });
    scene.materials = vec![
        flesh([1.0; 3], 10.0, -128.0, 0.034, 2.0),
        flesh([1.0, 0.27, 0.0], 100.0, -16.0, 0.125, 1.0),
        flesh([0.55, 0.0, 0.0], 100.0, -8.0, 0.25, 1.0),
        flesh([1.0, 0.27, 0.0], 100.0, -2.0, 0.5, 1.0),
    ];
    let axis = DVec3::new(1.0, 1.0, 0.0).normalize();
    let turn = glam::DQuat::from_axis_angle(axis, 30f64.to_radians());
    let shift = DVec3::new(-2.5, -2.5, 0.0);
    for (material, (start, end)) in [(1, (5.0, 80.0)), (2, (15.0, 60.0)), (3, (30.0, 30.0))] {
        let from = f64::to_radians(start);
        let angle = if end > start { end - start } else { end };
        let (s, c) = libm::sincos(from);
        let shape = Shape::Arc {
            center: turn * shift,
            u: turn * DVec3::new(c, s, 0.0),
            v: turn * DVec3::new(-s, c, 0.0),
            sweep: 4.0,
            angle: f64::to_radians(angle),
            radius: 0.125,
        };
        scene.elements.push(element(shape, material));
    }
    let mut state = 12345u64;
    for i in 0..100 {
        state = state
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        let chance = (state >> 11) as f64 / (1u64 << 53) as f64 * core::f64::consts::TAU;
        let inc = (5.0 + f64::from(i) / 100.0 * 75.0f64).to_radians();
        let length = 0.75 * libm::sin(2.0 * inc) * libm::sin(2.0 * inc);
        let (s, c) = libm::sincos(inc);
        let place = |r: f64, z: f64| turn * (DVec3::new(r * c, r * s, z) + shift);
        let base = place(4.0, 0.0);
        let apex = place(4.0 + length * libm::cos(chance), length * libm::sin(chance));
        let shape = Shape::Cylinder {
            base,
            apex,
            radius: 0.05,
        };
        scene.elements.push(element(shape, 0));
    }
    scene
}

/// A benchmark scene, with Cauchy fields.
fn benchmark(json: &serde_json::Value) -> Option<Scene> {
    let numbers = |v: &serde_json::Value| -> Option<Vec<f64>> {
        v.as_array()?
            .iter()
            .map(serde_json::Value::as_f64)
            .collect()
    };
    let vector = |v: &serde_json::Value| -> Option<DVec3> {
        if let Some(text) = v.as_str() {
            let n: Vec<f64> = text
                .trim_matches(['<', '>'])
                .split(',')
                .map_while(|n| n.trim().parse().ok())
                .collect();
            return (n.len() == 3).then(|| DVec3::from_slice(&n));
        }
        let n = numbers(v)?;
        (n.len() == 3).then(|| DVec3::from_slice(&n))
    };
    let mut scene = Scene::default();
    scene.settings.frame = [512, 512];
    scene.settings.samples = 4;
    let cam = &json["cam"];
    scene.camera = Camera {
        eye: vector(&cam["loc"])?,
        target: vector(&cam["at"])?,
        up: vector(&cam["sky"])?,
        fov: cam["fov"].as_f64()?,
        shift: [0.0; 2],
    };
    scene.lights.push(Light {
        kind: LightKind::Point {
            position: vector(&cam["light"])?,
        },
        colour: [1.0; 3],
        shadow: std::env::var("SHADOW").is_ok(),
    });
    let b = json["B"].as_f64().unwrap_or(4.0);
    scene.materials = vec![flesh([0.9, 0.6, 0.3], 30.0, b, 0.0, 1.0)];
    for p in json["points"].as_array().into_iter().flatten() {
        let n = numbers(p)?;
        let center = DVec3::from_slice(&n);
        scene.elements.push(element(
            Shape::Sphere {
                center,
                radius: n[3],
            },
            0,
        ));
    }
    for l in json["lines"].as_array().into_iter().flatten() {
        let n = numbers(l)?;
        let shape = Shape::Cylinder {
            base: DVec3::from_slice(&n),
            apex: DVec3::from_slice(&n[3..]),
            radius: n[6],
        };
        scene.elements.push(element(shape, 0));
    }
    if let Some(arcs) = json["arcs"].as_array() {
        scene.settings.blob_scale = field::BlobScale::Absolute;
        scene.settings.fragile = scene::Fragile::ALL;
        let surfaces = json["surf"].as_object()?;
        scene.materials = surfaces
            .values()
            .map(|v| {
                let n = numbers(v)?;
                Some(flesh([0.5, 0.7, 0.9], 100.0, n[0], n[1], 1.0))
            })
            .collect::<Option<_>>()?;
        for a in arcs {
            let name = a["mat"].as_str()?;
            let shape = Shape::Arc {
                center: vector(&a["c"])?,
                u: vector(&a["u"])?,
                v: vector(&a["v"])?,
                sweep: a["r"].as_f64()?,
                angle: a["ang"].as_f64()?,
                radius: 0.1,
            };
            let material = surfaces.keys().position(|k| k == name)?;
            scene.elements.push(element(shape, material));
        }
    }
    Some(scene)
}
