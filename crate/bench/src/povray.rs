//! POV-Ray (Debian's package `povray`) as a peer: our scenes in its language, and its timings.
//!
//! The same elements, camera and light. What our fields are to a `blob` of POV-Ray: a component's
//! field is s·(1 − d²/ρ²)² at the distance d. With ρ² = R² + 2/a and s = 1/(1 − R²/ρ²)² an isolated
//! one has the radius R, and there the slope of the Gaussian exp(−a·d²).

use anyhow::{Context, Result, bail};
use glam::DVec3;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::f64::consts::PI;
use std::fmt::Write;
use std::process::{Command, Stdio};
use xtask::shell::{command, find};

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
    let output = Command::new(find("povray")?).arg("--version").output();
    let said = String::from_utf8(output.ok()?.stderr).ok()?;
    let line = said.lines().find(|line| line.starts_with("POV-Ray "))?;
    Some(line.trim().to_owned())
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
///
/// # Errors
/// If it is not installed, or cannot trace the file.
pub fn time(file: &str, smooth: bool) -> Result<Cost> {
    find("povray").context("POV-Ray is not installed")?;
    let output = command("povray", &[&format!("+I{file}")])
        .args(options(smooth))
        .stdin(Stdio::null())
        .output()?;
    let said = String::from_utf8_lossy(&output.stderr);
    if !output.status.success() {
        bail!("povray failed on {file}: {said}");
    }
    cost(&said).with_context(|| format!("povray told no times of {file}"))
}

/// The figures of its statistics.
fn cost(said: &str) -> Option<Cost> {
    let number = |text: &str| text.split_whitespace().next()?.parse().ok();
    let rays = number(said.split_once("\nRays:")?.1)?;
    let (_, after) = said.split_once("Trace Time:")?;
    let seconds = number(after.split_once("thread(s) with ")?.1)?;
    Some(Cost { seconds, rays })
}

/// The elements of a scene as components of a `blob`; an arc as so many cylinders.
pub fn blob(scene: &Value, pieces: u32) -> Result<String> {
    let mut components = String::new();
    for element in elements(scene)? {
        let Soft {
            kind,
            shape,
            radius,
            a,
        } = soft(scene, element)?;
        let reach = radius * radius + 2.0 / a;
        let share = |gap: f64| (1.0 - (radius * radius + gap * gap) / reach).max(0.0);
        let depth = reach.sqrt();
        let strength = 1.0 / share(0.0).powi(2);
        let mut cylinder = |base, apex, strength: f64| {
            let (base, apex) = (point(base), point(apex));
            writeln!(
                components,
                "cylinder {{ {base}, {apex}, {depth}, {strength} }}"
            )
        };
        match kind {
            "Sphere" => {
                let center = point(read(&shape["center"])?);
                writeln!(components, "sphere {{ {center}, {depth}, {strength} }}")?;
            }
            "Cylinder" => cylinder(read(&shape["base"])?, read(&shape["apex"])?, strength)?,
            "Arc" => {
                let [sweep, angle]: [f64; 2] = [read(&shape["sweep"])?, read(&shape["angle"])?];
                // The pieces' round ends overlap: an endless row of them has the radius R beside the
                // middle of a piece.
                let length = sweep * angle / f64::from(pieces);
                let beside: f64 = (1..)
                    .map(|i| share((f64::from(i) - 0.5) * length).powi(2))
                    .take_while(|field| *field > 0.0)
                    .sum();
                let strength = 1.0 / (share(0.0).powi(2) + 2.0 * beside);
                let center: DVec3 = read(&shape["center"])?;
                let [u, v]: [DVec3; 2] = [read(&shape["u"])?, read(&shape["v"])?];
                let place = |i: u32| {
                    let (s, c) = libm::sincos(angle * f64::from(i) / f64::from(pieces));
                    center + sweep * (c * u + s * v)
                };
                for i in 0..pieces {
                    cylinder(place(i), place(i + 1), strength)?;
                }
            }
            _ => bail!("a shape that no blob has: {kind}"),
        }
    }
    let (head, flesh) = (head(scene)?, finish(scene)?);
    Ok(format!(
        "{head}blob {{ threshold 1\n{components}{flesh} }}\n"
    ))
}

/// The field of a line of length L (thesis, formula 2.21), where X is along the bone, D2 the square of the distance from its
/// start, and S2 the square of the width.
const LINE: &str = "#declare LINE = function(X, D2, L, S2) {
  X/(2*(1 + S2*(D2 - X*X))*(1 + S2*D2))
  + (L - X)/(2*(1 + S2*(D2 - X*X))*(1 + S2*(D2 + L*L - 2*L*X)))
  + (atan2(sqrt(S2)*X, sqrt(1 + S2*(D2 - X*X))) + atan2(sqrt(S2)*(L - X), sqrt(1 + S2*(D2 - X*X))))
    / (2*sqrt(S2)*pow(1 + S2*(D2 - X*X), 1.5)) }
";

/// Cylinders with Cauchy fields as an `isosurface` of just those fields.
pub fn cauchy_lines(scene: &Value) -> Result<String> {
    let mut sum = String::from("1");
    let [mut low, mut high] = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    for element in elements(scene)? {
        let Soft {
            kind,
            shape,
            radius,
            a,
        } = soft(scene, element)?;
        if kind != "Cylinder" {
            bail!("no cylinder: {kind}");
        }
        let [base, apex]: [DVec3; 2] = [read(&shape["base"])?, read(&shape["apex"])?];
        let length = base.distance(apex);
        // An endless line has the field T = 1 at the distance R.
        let height = 2.0 * a.sqrt() * libm::pow(1.0 + a * radius * radius, 1.5) / PI;
        let from = [0, 1, 2].map(|k| format!("({} - {:e})", ["x", "y", "z"][k], base[k]));
        let share = (apex - base) / length;
        let along = [0, 1, 2]
            .map(|k| format!("{}*{:e}", from[k], share[k]))
            .join(" + ");
        let squares = from.map(|from| format!("{from}*{from}")).join(" + ");
        write!(
            sum,
            "\n  - {height}*LINE({along}, {squares}, {length}, {a})"
        )?;
        low = low.min(base.min(apex) - 2.5 * radius);
        high = high.max(base.max(apex) + 2.5 * radius);
    }
    let (head, low, high, flesh) = (head(scene)?, point(low), point(high), finish(scene)?);
    Ok(format!(
        "{head}{LINE}isosurface {{ function {{ {sum} }}\n  contained_by {{ box {{ {low}, {high} }} }} \
         max_gradient 30 accuracy 0.001\n{flesh} }}\n"
    ))
}

/// A soft element: its shape, its radius, and the a of its Gaussian exp(−a·d²) or the s² of its
/// Cauchy kernel.
struct Soft<'a> {
    kind: &'a str,
    shape: &'a Value,
    radius: f64,
    a: f64,
}

fn soft<'a>(scene: &'a Value, element: &'a Value) -> Result<Soft<'a>> {
    let flesh = element["flesh"].as_u64().context("not soft")? as usize;
    let (flesh, settings) = (&scene["flesh"][flesh], &scene["settings"]);
    let shape = element["shape"]
        .as_object()
        .and_then(|shape| shape.iter().next());
    let (kind, shape) = shape.context("no shape")?;
    let fragile = settings["fragile"][kind.to_lowercase()] == true;
    let radius: f64 = read(&if fragile { flesh } else { shape }["radius"])?;
    let mut a = read::<f64>(&flesh["blobbiness"])?.abs();
    if settings["blob_scale"] != "Absolute" {
        a /= radius * radius;
    }
    Ok(Soft {
        kind,
        shape,
        radius,
        a,
    })
}

fn elements(scene: &Value) -> Result<&Vec<Value>> {
    scene["elements"].as_array().context("no elements")
}

/// Background, camera and light.
fn head(scene: &Value) -> Result<String> {
    let camera = &scene["camera"];
    let place = |value: &Value| Ok::<_, anyhow::Error>(point(read(value)?));
    let (eye, up, target) = (
        place(&camera["eye"])?,
        place(&camera["up"])?,
        place(&camera["target"])?,
    );
    let fov: f64 = read(&camera["fov"])?;
    let background = place(&scene["background"]["Colour"])?;
    let light = place(&scene["lights"][0]["kind"]["Point"]["position"])?;
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
    let [ambient, diffuse]: [DVec3; 2] = [read(&finish["ambient"])?, read(&finish["diffuse"])?];
    // Its ambient light is this share of the colour.
    let share = ambient.x / diffuse.x;
    let colour = point(diffuse);
    Ok(format!(
        "pigment {{ rgb {colour} }} finish {{ ambient {share} diffuse 1 }}"
    ))
}

/// A number or a point.
fn read<T: DeserializeOwned>(value: &Value) -> Result<T> {
    T::deserialize(value).context("the scene lacks a number or a point")
}

fn point(v: DVec3) -> String {
    format!("<{:e},{:e},{:e}>", v.x, v.y, v.z)
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
        let (seconds, rays) = (0.689, 626_720.0);
        assert_eq!(cost(said), Some(Cost { seconds, rays }));
        assert_eq!(cost("povray: no such file"), None);
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
        let numbers = component.split(['>', ',', '}']);
        let numbers: Vec<f64> = numbers
            .filter_map(|word| word.trim().parse().ok())
            .collect();
        let [.., depth, strength] = numbers[..] else {
            panic!("{component}");
        };
        assert!((depth * depth - 0.375).abs() < 1e-12, "{component}");
        assert!((strength - 9.0).abs() < 1e-9, "{component}");
        assert!(blob(&scene(json!({ "Plane": { "radius": 1.0 } })), 1).is_err());
    }
}
