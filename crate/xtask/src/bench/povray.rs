//! POV-Ray (Debian's package `povray`) as a peer: our scenes in its language, and its timings.
//!
//! The same elements, camera and light. What our fields are to a `blob` of POV-Ray: a component's
//! field is s·(1 − d²/ρ²)² at the distance d. With ρ² = R² + 2/a and s = 1/(1 − R²/ρ²)² an isolated
//! one has the radius R, and there the slope of the Gaussian exp(−a·d²).

use crate::shell::{command, find};
use anyhow::{Context, Result, bail};
use serde_json::Value;
use std::f64::consts::PI;
use std::fmt::Write;
use std::path::Path;
use std::process::{Command, Stdio};

/// Cost of a picture in POV-Ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    /// Seconds of one processor, of tracing alone.
    pub seconds: f64,
    /// Rays from the eye.
    pub rays: f64,
}

/// Its name and version, if it is installed.
pub fn version() -> Option<String> {
    // It says it on the standard error.
    let output = Command::new(find("povray")?)
        .arg("--version")
        .output()
        .ok()?;
    let said = String::from_utf8_lossy(&output.stderr) + String::from_utf8_lossy(&output.stdout);
    said.lines()
        .find(|line| line.starts_with("POV-Ray "))
        .map(|line| line.trim().to_owned())
}

/// The options of a picture, with or without anti-aliasing: one thread, nothing shown or written.
pub fn options(smooth: bool) -> &'static [&'static str] {
    if smooth {
        &[
            "+W512", "+H512", "-D", "-F", "+A0.3", "+AM1", "+R4", "-J", "+WT1", "-V",
        ]
    } else {
        &["+W512", "+H512", "-D", "-F", "-A", "+WT1", "-V"]
    }
}

/// Traces a picture.
pub fn time(file: &Path, smooth: bool) -> Result<Cost> {
    let input = format!("+I{}", file.to_string_lossy());
    let output = command("povray", &[&input])
        .args(options(smooth))
        .stdin(Stdio::null())
        .output()
        .context("povray could not be run")?;
    let said = String::from_utf8_lossy(&output.stderr);
    if !output.status.success() {
        bail!("povray failed on {}: {said}", file.display());
    }
    read(&said).with_context(|| format!("povray told no times of {}", file.display()))
}

/// The figures of its statistics.
fn read(said: &str) -> Option<Cost> {
    let rays = said
        .lines()
        .find_map(|line| line.strip_prefix("Rays:"))?
        .split_whitespace()
        .next()?
        .parse()
        .ok()?;
    let (_, after) = said.split_once("Trace Time:")?;
    let (_, after) = after.split_once("thread(s) with ")?;
    let seconds = after.split_whitespace().next()?.parse().ok()?;
    Some(Cost { seconds, rays })
}

/// The elements of a scene as components of a `blob`; an arc as so many cylinders.
pub fn blob(scene: &Value, pieces: u32) -> Result<String> {
    let mut components = String::new();
    for element in elements(scene)? {
        let Soft { shape, radius, a } = soft(scene, element)?;
        let reach = radius * radius + 2.0 / a;
        let share = |gap: f64| (1.0 - (radius * radius + gap * gap) / reach).max(0.0);
        let depth = reach.sqrt();
        if let Some(ball) = shape.get("Sphere") {
            let strength = 1.0 / share(0.0).powi(2);
            let center = point(vector(&ball["center"])?);
            writeln!(components, "sphere {{ {center}, {depth}, {strength} }}")?;
        } else if let Some(bone) = shape.get("Cylinder") {
            let strength = 1.0 / share(0.0).powi(2);
            let ends = [vector(&bone["base"])?, vector(&bone["apex"])?].map(point);
            let [base, apex] = ends;
            writeln!(
                components,
                "cylinder {{ {base}, {apex}, {depth}, {strength} }}"
            )?;
        } else if let Some(arc) = shape.get("Arc") {
            let (sweep, angle) = (number(&arc["sweep"])?, number(&arc["angle"])?);
            // The pieces' round ends overlap: an endless row of them has the radius R beside the
            // middle of a piece.
            let length = sweep * angle / f64::from(pieces);
            let beside: f64 = (1..)
                .map(|i| share((f64::from(i) - 0.5) * length).powi(2))
                .take_while(|field| *field > 0.0)
                .sum();
            let strength = 1.0 / (share(0.0).powi(2) + 2.0 * beside);
            let [center, u, v] = ["center", "u", "v"].map(|name| vector(&arc[name]));
            let (center, u, v) = (center?, u?, v?);
            let place = |i: u32| {
                let (s, c) = libm::sincos(angle * f64::from(i) / f64::from(pieces));
                point(std::array::from_fn(|k| {
                    center[k] + sweep * (c * u[k] + s * v[k])
                }))
            };
            for i in 0..pieces {
                let (base, apex) = (place(i), place(i + 1));
                writeln!(
                    components,
                    "cylinder {{ {base}, {apex}, {depth}, {strength} }}"
                )?;
            }
        } else {
            bail!("a shape that no blob has: {shape}");
        }
    }
    let head = head(scene)?;
    let flesh = finish(scene)?;
    Ok(format!(
        "{head}blob {{ threshold 1\n{components}{flesh} }}\n"
    ))
}

/// Cylinders with Cauchy fields as an `isosurface` of just those fields (thesis, formula 2.21).
pub fn cauchy_lines(scene: &Value) -> Result<String> {
    let mut out = head(scene)?;
    // X along the bone, D2 the square of the distance from its start, L its length, S2 the square of
    // the width.
    out += "#declare LINE = function(X, D2, L, S2) {\n  \
              X/(2*(1 + S2*(D2 - X*X))*(1 + S2*D2))\n  \
              + (L - X)/(2*(1 + S2*(D2 - X*X))*(1 + S2*(D2 + L*L - 2*L*X)))\n  \
              + (atan2(sqrt(S2)*X, sqrt(1 + S2*(D2 - X*X))) + atan2(sqrt(S2)*(L - X), sqrt(1 + S2*(D2 - X*X))))\n    \
              / (2*sqrt(S2)*pow(1 + S2*(D2 - X*X), 1.5)) }\n";
    let mut sum = String::from("1");
    let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    for element in elements(scene)? {
        let Soft { shape, radius, a } = soft(scene, element)?;
        let Some(bone) = shape.get("Cylinder") else {
            bail!("no cylinder: {shape}");
        };
        let (base, apex) = (vector(&bone["base"])?, vector(&bone["apex"])?);
        let length = (0..3)
            .map(|k| (apex[k] - base[k]).powi(2))
            .sum::<f64>()
            .sqrt();
        // An endless line has the field T = 1 at the distance R.
        let height = 2.0 * a.sqrt() * libm::pow(1.0 + a * radius * radius, 1.5) / PI;
        let from = |k: usize| format!("({} - {:e})", ["x", "y", "z"][k], base[k]);
        let along: Vec<String> = (0..3)
            .map(|k| format!("{}*{:e}", from(k), (apex[k] - base[k]) / length))
            .collect();
        let squares: Vec<String> = (0..3).map(|k| format!("{0}*{0}", from(k))).collect();
        write!(
            sum,
            "\n  - {height}*LINE({}, {}, {length}, {a})",
            along.join(" + "),
            squares.join(" + ")
        )?;
        for k in 0..3 {
            let reach = 2.5 * radius;
            bounds[0][k] = bounds[0][k].min(base[k].min(apex[k]) - reach);
            bounds[1][k] = bounds[1][k].max(base[k].max(apex[k]) + reach);
        }
    }
    let [low, high] = bounds.map(point);
    let flesh = finish(scene)?;
    write!(
        out,
        "isosurface {{ function {{ {sum} }}\n  contained_by {{ box {{ {low}, {high} }} }} max_gradient 30 \
         accuracy 0.001\n{flesh} }}\n"
    )?;
    Ok(out)
}

/// A soft element: its shape, its radius, and the a of its Gaussian exp(−a·d²) or the s² of its
/// Cauchy kernel.
struct Soft<'a> {
    shape: &'a Value,
    radius: f64,
    a: f64,
}

fn soft<'a>(scene: &'a Value, element: &'a Value) -> Result<Soft<'a>> {
    let flesh = element["flesh"].as_u64().context("not soft")? as usize;
    let flesh = &scene["flesh"][flesh];
    let shape = &element["shape"];
    let (kind, body) = shape
        .as_object()
        .and_then(|shape| shape.iter().next())
        .context("no shape")?;
    let fragile = scene["settings"]["fragile"][kind.to_lowercase()].as_bool();
    let radius = if fragile == Some(true) {
        number(&flesh["radius"])?
    } else {
        number(&body["radius"])?
    };
    let blobbiness = number(&flesh["blobbiness"])?.abs();
    let a = match scene["settings"]["blob_scale"].as_str() {
        Some("Absolute") => blobbiness,
        _ => blobbiness / (radius * radius),
    };
    Ok(Soft { shape, radius, a })
}

fn elements(scene: &Value) -> Result<&Vec<Value>> {
    scene["elements"].as_array().context("no elements")
}

/// Background, camera and light.
fn head(scene: &Value) -> Result<String> {
    let camera = &scene["camera"];
    let [eye, up, target] = ["eye", "up", "target"].map(|name| vector(&camera[name]));
    let (eye, up, target) = (point(eye?), point(up?), point(target?));
    let fov = number(&camera["fov"])?;
    let background = point(vector(&scene["background"]["Colour"])?);
    let light = point(vector(&scene["lights"][0]["kind"]["Point"]["position"])?);
    Ok(format!(
        "#version 3.7;\n\
         global_settings {{ assumed_gamma 1 max_trace_level 1 ambient_light 1 }}\n\
         background {{ rgb {background} }}\n\
         camera {{ perspective location {eye} sky {up} up y right -x angle {fov} look_at {target} }}\n\
         light_source {{ {light} rgb 1 shadowless }}\n"
    ))
}

/// The colour of the first finish.
fn finish(scene: &Value) -> Result<String> {
    let finish = &scene["finishes"][0];
    let diffuse = vector(&finish["diffuse"])?;
    // Its ambient light is this share of the colour.
    let share = vector(&finish["ambient"])?[0] / diffuse[0];
    Ok(format!(
        "pigment {{ rgb {} }} finish {{ ambient {share} diffuse 1 }}",
        point(diffuse)
    ))
}

fn number(value: &Value) -> Result<f64> {
    value.as_f64().context("a number is missing")
}

fn vector(value: &Value) -> Result<[f64; 3]> {
    let list = value.as_array().context("a point is missing")?;
    let mut vector = [0.0; 3];
    for (to, from) in vector.iter_mut().zip(list) {
        *to = number(from)?;
    }
    Ok(vector)
}

fn point(v: [f64; 3]) -> String {
    format!("<{:e},{:e},{:e}>", v[0], v[1], v[2])
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn its_statistics_are_read() {
        let said = "  Parse Time: 0 hours (0.003 seconds)\n  using 1 thread(s) with 0.002 CPU-seconds total\n\
                    Rays:             626720   Saved:                 0   Max Level: 1/1\n\
                    Render Time:\n  Trace Time:       0 hours  0 minutes  0 seconds (0.899 seconds)\n\
                    using 1 thread(s) with 0.689 CPU-seconds total\n";
        let cost = Cost {
            seconds: 0.689,
            rays: 626_720.0,
        };
        assert_eq!(read(said), Some(cost));
        assert_eq!(read("povray: no such file"), None);
    }

    fn scene(shape: Value) -> Value {
        json!({
            "elements": [{ "shape": shape, "flesh": 0, "finish": 0 }],
            "flesh": [{ "blobbiness": -4.0, "radius": 9.0 }],
            "finishes": [{ "ambient": [0.1, 0.1, 0.1], "diffuse": [0.5, 0.5, 0.5] }],
            "lights": [{ "kind": { "Point": { "position": [1.0, 2.0, 3.0] } } }],
            "camera": { "eye": [0.0, 0.0, 5.0], "up": [0.0, 1.0, 0.0], "target": [0.0, 0.0, 0.0], "fov": 45.0 },
            "background": { "Colour": [0.0, 0.0, 0.0] },
            "settings": { "blob_scale": "Relative", "fragile": { "sphere": false } },
        })
    }

    #[test]
    fn a_ball_becomes_a_component_of_the_same_radius() {
        // a = 16: ρ² = 1/4 + 1/8, 1 − R²/ρ² = 1/3.
        let ball = json!({ "Sphere": { "center": [0.0, 0.0, 0.0], "radius": 0.5 } });
        let text = blob(&scene(ball), 1).unwrap();
        let component = text
            .lines()
            .find(|line| line.starts_with("sphere"))
            .unwrap();
        let numbers: Vec<f64> = component
            .split(['>', ',', '}'])
            .filter_map(|word| word.trim().parse().ok())
            .collect();
        let [depth, strength] = numbers[numbers.len() - 2..] else {
            panic!("{component}");
        };
        assert!((depth * depth - 0.375).abs() < 1e-12, "{component}");
        assert!((strength - 9.0).abs() < 1e-9, "{component}");
        assert!(blob(&scene(json!({ "Plane": { "radius": 1.0 } })), 1).is_err());
    }
}
