//! Every shader is valid WGSL within the limits of WebGPU, and translates to the GLSL ES 3.00 that
//! WebGL2 takes.

use naga::back::glsl;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use std::collections::BTreeMap;
use std::path::Path;

/// The code of each pipeline, put together as the crate does: the shapes' files are continuations
/// of `element.wgsl`, and all but the last pass begin with `view.wgsl`.
fn programs() -> BTreeMap<String, String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shaders");
    let mut files: BTreeMap<String, String> = std::fs::read_dir(&folder)
        .expect("the folder shaders/")
        .map(|entry| entry.expect("an entry of shaders/"))
        .filter(|entry| entry.path().is_file())
        .map(|entry| {
            let name = entry.file_name().into_string().expect("a name in Unicode");
            let text = std::fs::read_to_string(entry.path()).expect("a text file");
            (name, text)
        })
        .collect();
    let view = files.remove("view.wgsl").expect("view.wgsl");
    let element = files.remove("element.wgsl").expect("element.wgsl");
    for (name, text) in &mut files {
        match name.as_str() {
            "resolve.wgsl" => {}
            "backdrop.wgsl" | "mesh.wgsl" => *text = format!("{view}{text}"),
            _ => *text = format!("{view}{element}{text}"),
        }
    }
    files
}

#[test]
fn shaders_are_valid_and_translate_to_webgl2() {
    let programs = programs();
    let names: Vec<&str> = programs.keys().map(String::as_str).collect();
    assert_eq!(
        names,
        [
            "arc.wgsl",
            "backdrop.wgsl",
            "cylinder.wgsl",
            "mesh.wgsl",
            "patch.wgsl",
            "plane.wgsl",
            "resolve.wgsl",
            "sphere.wgsl",
            "triangle.wgsl"
        ]
    );
    for (name, code) in &programs {
        let module = naga::front::wgsl::parse_str(code)
            .unwrap_or_else(|error| panic!("{name}: {}", error.emit_to_string(code)));
        let info = Validator::new(ValidationFlags::all(), Capabilities::empty())
            .validate(&module)
            .unwrap_or_else(|error| panic!("{name}: {}", error.emit_to_string(code)));
        assert!(module.entry_points.len() >= 2, "{name} draws nothing");
        for entry in &module.entry_points {
            let glsl = to_glsl(&module, &info, entry)
                .unwrap_or_else(|error| panic!("{name}, {}: no GLSL ES 3.00: {error}", entry.name));
            assert!(glsl.starts_with("#version 300 es"), "{name}: {glsl}");
            assert!(glsl.contains("precision highp float"), "{name}: {glsl}");
        }
    }
}

fn to_glsl(
    module: &naga::Module,
    info: &naga::valid::ModuleInfo,
    entry: &naga::EntryPoint,
) -> Result<String, glsl::Error> {
    let options = glsl::Options {
        version: glsl::Version::Embedded {
            version: 300,
            is_webgl: true,
        },
        writer_flags: glsl::WriterFlags::ADJUST_COORDINATE_SPACE,
        ..glsl::Options::default()
    };
    let pipeline = glsl::PipelineOptions {
        entry_point: entry.name.clone(),
        shader_stage: entry.stage,
        multiview: None,
    };
    let mut text = String::new();
    let policies = naga::proc::BoundsCheckPolicies::default();
    glsl::Writer::new(&mut text, module, info, &options, &pipeline, policies)?.write()?;
    Ok(text)
}
