//! `sinew probe`: numbers instead of pictures, for tests and for the curious.

use crate::files::Loaded;
use crate::{Outcome, files, report};
use clap::{Args, ValueEnum};
use field::{Implicit, Jet};
use glam::DVec3;
use scene::{Scene, Surface};
use serde_json::{Map, Value, json};
use std::io::{BufRead, Write};
use std::path::{Path, PathBuf};

#[derive(Clone, Copy, ValueEnum)]
enum Precision {
    /// Double precision: the reference
    F64,
    /// Single precision: what the pictures are made with
    F32,
}

/// `sinew probe FILE --points - | --rays -`.
#[derive(Args)]
pub struct Probe {
    /// The dataset
    file: PathBuf,
    /// Evaluate the field at points: lines `x y z` from a file, or `-` for the standard input
    #[arg(long, value_name = "FILE", required_unless_present = "rays")]
    points: Option<PathBuf>,
    /// Intersect rays with the surfaces: lines `ox oy oz dx dy dz`
    #[arg(long, value_name = "FILE", conflicts_with = "points")]
    rays: Option<PathBuf>,
    /// Arithmetic of the point evaluations
    #[arg(long, default_value = "f64")]
    precision: Precision,
}

impl Probe {
    /// Prints one JSON line for each line read. A line that cannot be read gives
    /// `{"error": …, "line": …}`, and the result is false.
    pub fn run(&self) -> Outcome {
        let sources = [&self.points, &self.rays].map(|source| source.as_deref());
        let input = Path::new(files::INPUT);
        if self.file == input && sources.contains(&Some(input)) {
            return Err(String::from(
                "the dataset and the places cannot both come from the standard input",
            ));
        }
        let loaded = files::load(&self.file)?;
        let mut good = report::to_stderr(&loaded);
        if let Some(source) = &self.points {
            let surfaces = loaded.compiled.scene.surfaces();
            good &= each_line(source, |[x, y, z]: [f64; 3]| {
                Ok(self.point(&loaded, &surfaces, DVec3::new(x, y, z)))
            })?;
        } else if let Some(source) = &self.rays {
            let picture =
                tracer::Picture::new(&loaded.compiled.scene, loaded.compiled.scene.settings.frame);
            good &= each_line(source, |[ox, oy, oz, dx, dy, dz]: [f64; 6]| {
                let scene = &loaded.compiled.scene;
                ray(
                    &picture,
                    scene,
                    DVec3::new(ox, oy, oz),
                    DVec3::new(dx, dy, dz),
                )
            })?;
        }
        Ok(good)
    }

    /// The field of every body at a point; the keys beside `bodies` are those of the body with the
    /// largest field.
    fn point(&self, loaded: &Loaded, surfaces: &[Surface], point: DVec3) -> Value {
        let scene = &loaded.compiled.scene;
        let jets: Vec<Jet<f64>> = surfaces
            .iter()
            .map(|surface| jet(surface.function(), point, self.precision))
            .collect();
        let bodies: Vec<Value> = surfaces
            .iter()
            .zip(&jets)
            .map(|(surface, Jet { value, gradient })| {
                let name = &scene.bodies[surface.body() as usize].name;
                json!({ "name": name, "field": value, "gradient": gradient })
            })
            .collect();
        let largest = (0..jets.len()).max_by(|&a, &b| {
            // The first of equal ones.
            jets[a].value.total_cmp(&jets[b].value).then(b.cmp(&a))
        });
        let (jet, weights) = match largest {
            Some(i) => (jets[i], weights(loaded, &surfaces[i], point)),
            None => (Jet::zero(), Map::new()),
        };
        json!({
            "field": jet.value,
            "gradient": jet.gradient,
            "weights": weights,
            "bodies": bodies,
        })
    }
}

fn jet(field: &dyn Implicit, point: DVec3, precision: Precision) -> Jet<f64> {
    match precision {
        Precision::F64 => field.jet(point),
        Precision::F32 => {
            let jet = field.jet32(point.as_vec3().to_array());
            Jet {
                value: f64::from(jet.value),
                gradient: jet.gradient.map(f64::from),
            }
        }
    }
}

/// The share of each material in the flesh at a point: its elements' shares of the function over
/// the sum of all, as colours are blended (thesis, chapter 4). Carving primitives have no share.
fn weights(loaded: &Loaded, surface: &Surface, point: DVec3) -> Map<String, Value> {
    let scene = &loaded.compiled.scene;
    let mut fields = Vec::new();
    surface.function().shares(point, &mut fields);
    let total: f64 = fields.iter().map(|(_, value)| value).sum();
    let mut shares = vec![0.0; scene.finishes.len()];
    for (number, value) in fields {
        if total > 0.0 {
            let element = surface.element()[number as usize];
            shares[scene.elements[element as usize].finish as usize] += value / total;
        }
    }
    let mut map = Map::new();
    for (material, share) in scene.finishes.iter().zip(shares) {
        if share > 0.0 {
            // A name may be given again to a later material; its shares add up.
            let sum = map
                .get(&material.name)
                .and_then(Value::as_f64)
                .unwrap_or(0.0)
                + share;
            map.insert(material.name.clone(), json!(sum));
        }
    }
    map
}

fn ray(
    picture: &tracer::Picture,
    scene: &Scene,
    origin: DVec3,
    direction: DVec3,
) -> Result<Value, String> {
    let direction = direction
        .try_normalize()
        .ok_or("a ray needs a direction that is not zero")?;
    let hits = picture.hits(origin, direction).into_iter().map(|hit| {
        let body = hit.body.map(|body| &scene.bodies[body as usize].name);
        json!({ "t": hit.t, "position": hit.position, "normal": hit.normal, "body": body })
    });
    Ok(json!({ "hits": hits.collect::<Vec<_>>() }))
}

/// Calls `answer` with the numbers of each line that is not empty, and prints what it gives.
fn each_line<const N: usize>(
    source: &Path,
    answer: impl Fn([f64; N]) -> Result<Value, String>,
) -> Outcome {
    let input: Box<dyn BufRead> = if source == Path::new("-") {
        Box::new(std::io::stdin().lock())
    } else {
        let file = std::fs::File::open(source)
            .map_err(|error| format!("cannot open {}: {error}", source.display()))?;
        Box::new(std::io::BufReader::new(file))
    };
    let mut output = std::io::BufWriter::new(std::io::stdout().lock());
    let mut good = true;
    for (index, line) in input.lines().enumerate() {
        let line = line.map_err(|error| format!("cannot read {}: {error}", source.display()))?;
        if line.trim().is_empty() {
            continue;
        }
        let value = numbers(&line).and_then(&answer).unwrap_or_else(|error| {
            good = false;
            json!({ "error": error, "line": index + 1 })
        });
        writeln!(output, "{value}")
            .map_err(|error| format!("cannot write the answers: {error}"))?;
    }
    output
        .flush()
        .map_err(|error| format!("cannot write the answers: {error}"))?;
    Ok(good)
}

fn numbers<const N: usize>(line: &str) -> Result<[f64; N], String> {
    let words: Vec<&str> = line
        .split(|c: char| c.is_whitespace() || c == ',')
        .filter(|word| !word.is_empty())
        .collect();
    let values: Vec<f64> = words
        .iter()
        .filter_map(|word| word.parse().ok())
        .filter(|value: &f64| value.is_finite())
        .collect();
    match <[f64; N]>::try_from(values) {
        Ok(values) if words.len() == N => Ok(values),
        _ => Err(format!("expected {N} finite numbers, found {line:?}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_numbers() {
        assert_eq!(numbers::<3>("1, 2e-1 -3"), Ok([1.0, 0.2, -3.0]));
        for bad in ["1 2", "1 2 3 4", "1 2 x", "1 2 nan", "1 2 inf"] {
            assert!(numbers::<3>(bad).is_err(), "{bad}");
        }
    }
}
