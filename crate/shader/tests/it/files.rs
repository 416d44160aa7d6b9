//! The files of `shaders/field/`: as they are written now, valid, and fit for WebGL2.

use naga::back::glsl;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use shader::cells::all;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

pub fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shaders/field")
}

/// Returns the functions that all others call.
pub fn mathematics() -> String {
    std::fs::read_to_string(folder().join("math.wgsl")).expect("math.wgsl")
}

#[test]
fn files_are_what_the_formulas_give() {
    let mut names = BTreeSet::from(["math.wgsl".to_owned()]);
    for cell in all() {
        let name = format!("{}.wgsl", cell.name);
        let kept = std::fs::read_to_string(folder().join(&name)).unwrap_or_default();
        assert!(
            kept == cell.file(),
            "shaders/field/{name} is not what the formula gives: run `cargo xtask shaders`"
        );
        assert_eq!(cell.layout.to_string().parse(), Ok(cell.layout));
        names.insert(name);
    }
    let found = std::fs::read_dir(folder()).expect("shaders/field/");
    let found: BTreeSet<String> = found
        .map(|entry| entry.expect("an entry").file_name().into_string())
        .map(|name| name.expect("a name in Unicode"))
        .collect();
    assert_eq!(found, names);
}

/// A fragment program that calls a function, with the constants in a texture: WebGL2 has no buffers
/// of any length.
fn fragment(name: &str, code: &str) -> String {
    format!(
        "{}{code}
@group(0) @binding(0) var constants: texture_2d<f32>;
fn constant(i: u32) -> vec4<f32> {{
    return textureLoad(constants, vec2<u32>(i & 1023u, i >> 10u), 0);
}}
@fragment fn shade(@builtin(position) place: vec4<f32>) -> @location(0) vec4<f32> {{
    return {name}(u32(place.x), u32(place.y), place.xyz);
}}
",
        mathematics()
    )
}

#[test]
fn functions_are_valid_and_translate_to_webgl2() {
    for cell in all() {
        let code = fragment(&cell.name, &cell.code);
        let module = naga::front::wgsl::parse_str(&code)
            .unwrap_or_else(|error| panic!("{}: {}", cell.name, error.emit_to_string(&code)));
        let info = Validator::new(ValidationFlags::all(), Capabilities::empty())
            .validate(&module)
            .unwrap_or_else(|error| panic!("{}: {}", cell.name, error.emit_to_string(&code)));
        let options = glsl::Options {
            version: glsl::Version::Embedded {
                version: 300,
                is_webgl: true,
            },
            ..glsl::Options::default()
        };
        let pipeline = glsl::PipelineOptions {
            entry_point: "shade".into(),
            shader_stage: naga::ShaderStage::Fragment,
            multiview: None,
        };
        let mut text = String::new();
        let policies = naga::proc::BoundsCheckPolicies::default();
        glsl::Writer::new(&mut text, &module, &info, &options, &pipeline, policies)
            .and_then(|mut writer| writer.write())
            .unwrap_or_else(|error| panic!("{}: no GLSL ES 3.00: {error}", cell.name));
        assert!(text.starts_with("#version 300 es"), "{}", cell.name);
    }
}
