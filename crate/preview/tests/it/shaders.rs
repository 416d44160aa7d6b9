//! Every shader is valid WGSL within the limits of WebGPU, and translates to the GLSL ES 3.00 that
//! WebGL2 takes.

use naga::back::glsl;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Shapes that rays meet.
const SHAPES: [&str; 6] = ["sphere", "cylinder", "arc", "triangle", "plane", "patch"];

/// The code of each pipeline, put together as the crate does.
fn programs() -> BTreeMap<&'static str, String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shaders");
    let files: BTreeMap<String, String> = std::fs::read_dir(&folder)
        .expect("the folder shaders/")
        .map(|entry| entry.expect("an entry of shaders/"))
        .filter(|entry| entry.path().is_file())
        .map(|entry| {
            let name = entry.file_name().into_string().expect("a name in Unicode");
            let text = std::fs::read_to_string(entry.path()).expect("a text file");
            (name.replace(".wgsl", ""), text)
        })
        .collect();
    let mut parts: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for entry in ["compute", "fragment"] {
        let tracer = ["view", "sky", "solid"].into_iter().chain(SHAPES);
        parts.insert(entry, tracer.chain(["march", "scene", entry]).collect());
    }
    let used: BTreeSet<&str> = parts.values().flatten().copied().collect();
    let all: BTreeSet<&str> = files.keys().map(String::as_str).collect();
    assert_eq!(used, all, "files of no program, or missing ones");
    let programs = parts.into_iter().map(|(name, parts)| {
        let mut code: String = parts.iter().map(|part| files[*part].as_str()).collect();
        if parts.contains(&"march") {
            for formulas in ["plain_term", "profile_of_term"] {
                code += &format!("fn {formulas}(kind: u32, at: u32, count: u32, p: vec3f)");
                code += " -> vec4f { return vec4f(); }";
            }
        }
        (name, code)
    });
    programs.collect()
}

#[test]
fn shaders_are_valid_and_translate_to_webgl2() {
    let programs = programs();
    for (name, code) in &programs {
        let module = naga::front::wgsl::parse_str(code)
            .unwrap_or_else(|error| panic!("{name}: {}", error.emit_to_string(code)));
        let info = Validator::new(ValidationFlags::all(), Capabilities::empty())
            .validate(&module)
            .unwrap_or_else(|error| panic!("{name}: {}", error.emit_to_string(code)));
        if *name == "compute" {
            assert_eq!(module.entry_points.len(), 1);
            continue;
        }
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
