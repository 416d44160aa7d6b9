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
use std::process::Command;
use xtask::shell::{command, find, words};

/// Cost of a picture in POV-Ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cost {
    /// Seconds of one processor, of tracing alone.
    pub seconds: f64,
    /// Rays from the eye.
    pub rays: f64,
}

/// Returns POV-Ray's name and version, if it is installed.
pub fn version() -> Option<String> {
    // It says it on the standard error.
    let output = Command::new(find("povray")?).arg("--version").output();
    let said = String::from_utf8(output.ok()?.stderr).ok()?;
    let line = said.lines().find(|line| line.starts_with("POV-Ray "))?;
    Some(line.trim().to_owned())
}

/// The options of a picture, with or without anti-aliasing: one thread, nothing shown or written.
pub fn options(smooth: bool) -> Vec<&'static str> {
    let smooth = if smooth { "+A0.3 +AM1 +R4 -J" } else { "-A" };
    let (picture, thread) = (words("+W512 +H512 -D -F"), words("+WT1 -V"));
    [picture, words(smooth), thread].concat()
}

/// Traces a picture.
///
/// # Errors
/// If it is not installed, or cannot trace the file.
pub fn time(file: &str, smooth: bool) -> Result<Cost> {
    find("povray").context("POV-Ray is not installed")?;
    let mut command = command("povray", &[&format!("+I{file}")]);
    let output = command.args(options(smooth)).output()?;
    let said = String::from_utf8_lossy(&output.stderr);
    cost(&said).with_context(|| format!("povray told no times of {file}: {said}"))
}

/// The figures of its statistics.
fn cost(said: &str) -> Option<Cost> {
    fn number(text: &str) -> Option<f64> {
        text.split_whitespace().next()?.parse().ok()
    }
    let rays = number(said.split_once("\nRays:")?.1)?;
    let (_, after) = said.split_once("Trace Time:")?;
    let seconds = number(after.split_once("thread(s) with ")?.1)?;
    Some(Cost { seconds, rays })
}

/// The elements of a scene as components of a `blob`; an arc as so many cylinders.
pub fn blob(scene: &Value, pieces: u32) -> Result<String> {
    let mut components = String::new();
    for soft in softs(scene)? {
        let reach = soft.radius * soft.radius + 2.0 / soft.a;
        let share = |gap: f64| (1.0 - (soft.radius * soft.radius + gap * gap) / reach).max(0.0);
        let depth = reach.sqrt();
        let strength = 1.0 / share(0.0).powi(2);
        let mut add = |kind: &str, ends: &[DVec3], strength: f64| {
            let ends: String = ends.iter().map(|end| point(*end) + ", ").collect();
            components += &format!("{kind} {{ {ends}{depth}, {strength} }}\n");
        };
        match soft.kind {
            "Point" => add("sphere", &[soft.read("center")?], strength),
            "Segment" => add(
                "cylinder",
                &[soft.read("base")?, soft.read("apex")?],
                strength,
            ),
            "Arc" => {
                let (sweep, angle): (f64, f64) = (soft.read("radius")?, soft.read("angle")?);
                // The pieces' round ends overlap: an endless row of them has the radius R beside
                // the middle of a piece.
                let length = sweep * angle / f64::from(pieces);
                let beside = (1..).map(|i| share((f64::from(i) - 0.5) * length).powi(2));
                let beside: f64 = beside.take_while(|field| *field > 0.0).sum();
                let strength = 1.0 / (share(0.0).powi(2) + 2.0 * beside);
                let center: DVec3 = soft.read("center")?;
                let (u, v): (DVec3, DVec3) = (soft.read("u")?, soft.read("v")?);
                for i in 0..pieces {
                    let ends = [i, i + 1].map(|i| {
                        let (s, c) = libm::sincos(angle * f64::from(i) / f64::from(pieces));
                        center + sweep * (c * u + s * v)
                    });
                    add("cylinder", &ends, strength);
                }
            }
            kind => bail!("a shape that no blob has: {kind}"),
        }
    }
    whole(scene, &format!("blob {{ threshold 1\n{components}"))
}

/// The field of a line of length L (thesis, formula 2.21), where X is along the bone, D2 the square
/// of the distance from its start, and S2 the square of the width.
const LINE: &str = "#declare LINE = function(X, D2, L, S2) {
  X/(2*(1 + S2*(D2 - X*X))*(1 + S2*D2))
  + (L - X)/(2*(1 + S2*(D2 - X*X))*(1 + S2*(D2 + L*L - 2*L*X)))
  + (atan2(sqrt(S2)*X, sqrt(1 + S2*(D2 - X*X)))
     + atan2(sqrt(S2)*(L - X), sqrt(1 + S2*(D2 - X*X))))
    / (2*sqrt(S2)*pow(1 + S2*(D2 - X*X), 1.5)) }
";

/// Cylinders with Cauchy fields as an `isosurface` of just those fields.
pub fn cauchy_lines(scene: &Value) -> Result<String> {
    let mut sum = String::from("1");
    let [mut low, mut high] = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    for soft in softs(scene)? {
        let (base, apex): (DVec3, DVec3) = (soft.read("base")?, soft.read("apex")?);
        let (length, a) = (base.distance(apex), soft.a);
        // An endless line has the field T = 1 at the distance R.
        let height = 2.0 * a.sqrt() * libm::pow(1.0 + a * soft.radius * soft.radius, 1.5) / PI;
        let from = [0, 1, 2].map(|k| format!("({} - {:e})", ["x", "y", "z"][k], base[k]));
        let share = (apex - base) / length;
        let along = [0, 1, 2].map(|k| format!("{}*{:e}", from[k], share[k]));
        let squares = from.map(|from| format!("{from}*{from}")).join(" + ");
        let along = along.join(" + ");
        sum += &format!("\n  - {height}*LINE({along}, {squares}, {length}, {a})");
        low = low.min(base.min(apex) - 2.5 * soft.radius);
        high = high.max(base.max(apex) + 2.5 * soft.radius);
    }
    let within = format!("box {{ {}, {} }}", point(low), point(high));
    let limits = "max_gradient 30 accuracy 0.001";
    let surface = format!("function {{ {sum} }}\n  contained_by {{ {within} }} {limits}");
    whole(scene, &format!("{LINE}isosurface {{ {surface}\n"))
}

/// A soft element: its bone, its radius, and the a of its Gaussian exp(−a·d²) or the s² of its
/// Cauchy kernel.
struct Soft<'a> {
    kind: &'a str,
    skeleton: &'a Value,
    radius: f64,
    a: f64,
}

impl Soft<'_> {
    /// A number or a point of the bone.
    fn read<T: DeserializeOwned>(&self, name: &str) -> Result<T> {
        read(&self.skeleton[name])
    }
}

/// The soft elements of a scene: all that it may have.
fn softs(scene: &Value) -> Result<Vec<Soft<'_>>> {
    let settings = &scene["settings"];
    let elements = scene["elements"].as_array().context("no elements")?;
    let softs = elements.iter().map(|element| {
        let flesh = element["flesh"].as_u64().context("not soft")?;
        let flesh = &scene["flesh"][flesh as usize];
        let bone = &element["shape"]["Bone"];
        let skeleton = bone["skeleton"].as_object();
        let (kind, skeleton) = skeleton.and_then(|s| s.iter().next()).context("no bone")?;
        let fragile = match kind.as_str() {
            "Point" => "sphere",
            "Segment" => "cylinder",
            _ => "arc",
        };
        let is_fragile = settings["fragile"][fragile] == true;
        let radius: f64 = read(&if is_fragile { flesh } else { bone }["radius"])?;
        let mut a = read::<f64>(&flesh["blobbiness"])?;
        if settings["blob_scale"] != "Absolute" {
            a /= radius * radius;
        }
        Ok(Soft {
            kind,
            skeleton,
            radius,
            a,
        })
    });
    softs.collect()
}

/// A scene with background, camera and light, and a surface, but for its look and the end.
fn whole(scene: &Value, surface: &str) -> Result<String> {
    let camera = &scene["camera"];
    let [eye, up, target, background, light] = [
        &camera["eye"],
        &camera["up"],
        &camera["target"],
        &scene["background"]["Colour"],
        &scene["lights"][0]["kind"]["Point"]["position"],
    ]
    .map(|value| Ok::<_, anyhow::Error>(point(read(value)?)));
    let (eye, up, target, fov) = (eye?, up?, target?, &camera["fov"]);
    let (background, light) = (background?, light?);
    let finish = &scene["finishes"][0];
    let (ambient, diffuse): (DVec3, DVec3) = (read(&finish["ambient"])?, read(&finish["diffuse"])?);
    // Its ambient light is this share of the colour.
    let (share, colour) = (ambient.x / diffuse.x, point(diffuse));
    let view = format!("location {eye} sky {up} up y right -x angle {fov} look_at {target}");
    Ok(format!(
        "#version 3.7;
global_settings {{ assumed_gamma 1 max_trace_level 1 ambient_light 1 }}
background {{ rgb {background} }}
camera {{ perspective {view} }}
light_source {{ {light} rgb 1 shadowless }}
{surface}pigment {{ rgb {colour} }} finish {{ ambient {share} diffuse 1 }} }}
"
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
    fn a_ball_becomes_a_component_of_the_same_radius() {
        let text = |shape: Value| {
            let scene = json!({
                "elements": [{ "shape": shape, "flesh": 0 }],
                "flesh": [{ "blobbiness": 4.0, "radius": 9.0 }],
                "finishes": [{ "ambient": [0.1, 0.1, 0.1], "diffuse": [0.5, 0.5, 0.5] }],
                "lights": [{ "kind": { "Point": { "position": [1.0, 2.0, 3.0] } } }],
                "camera": { "eye": [0, 0, 5], "up": [0, 1, 0], "target": [0, 0, 0], "fov": 45.0 },
                "background": { "Colour": [0.0, 0.0, 0.0] },
                "settings": { "blob_scale": "Relative", "fragile": { "sphere": false } },
            });
            blob(&scene, 1)
        };
        // a = 16: ρ² = 1/4 + 1/8, 1 − R²/ρ² = 1/3.
        let point = json!({ "Point": { "center": [0.0, 0.0, 0.0] } });
        let ball = json!({ "Bone": { "skeleton": point, "radius": 0.5 } });
        let text_of_ball = text(ball).unwrap();
        let (_, numbers) = text_of_ball.split_once("sphere { <0e0,0e0,0e0>, ").unwrap();
        let (depth, numbers) = numbers.split_once(", ").unwrap();
        let (strength, _) = numbers.split_once(' ').unwrap();
        let [depth, strength] = [depth, strength].map(|number| number.parse::<f64>().unwrap());
        assert!((depth * depth - 0.375).abs() < 1e-12, "{text_of_ball}");
        assert!((strength - 9.0).abs() < 1e-9, "{text_of_ball}");
        assert!(text(json!({ "Bone": { "skeleton": { "Plane": {} }, "radius": 1.0 } })).is_err());
    }
}
