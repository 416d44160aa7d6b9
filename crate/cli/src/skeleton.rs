//! `sinew skeleton`: skeletons of straight limbs, from and to the files that people have.

use crate::{Outcome, files, view, whole};
use clap::Args;
use limbs::{Builder, Graph, Recipe};
use scene::{Scene, Shape};
use std::io::Write as _;
use std::path::{Path, PathBuf};

/// Endings of datasets.
const TEXTS: [&str; 5] = ["rat", "art", "ice", "dat", "txt"];

/// `sinew skeleton FILE [--to OUT] [--scale S] …`.
#[derive(Args)]
pub struct Skeleton {
    /// The skeleton: .swc, .3mf, .vtp, .vtk, .csv, .obj, .ply, .xyz, .pdb, or a dataset (.rat)
    file: PathBuf,
    /// File to write: .rat (the block form of `skeleton`), .swc or .obj
    #[arg(long, value_name = "OUT")]
    to: Option<PathBuf>,
    /// Factor on all lengths
    #[arg(long, default_value_t = 1.0, value_name = "S")]
    scale: f64,
    /// Length that is added to all radii
    #[arg(
        long,
        default_value_t = 0.0,
        value_name = "R",
        allow_negative_numbers = true
    )]
    thicken: f64,
    /// Join lines that run within D of each other
    #[arg(long, value_name = "D")]
    merge: Option<f64>,
    /// Fewer limbs, whose centrelines and radii move by at most E
    #[arg(long, value_name = "E")]
    simplify: Option<f64>,
    /// Join atoms that are bound
    #[arg(long)]
    bonds: bool,
    /// Radius where the file gives none
    #[arg(long, value_name = "R")]
    radius: Option<f64>,
    /// Name of the file's array or column of radii
    #[arg(long, value_name = "NAME")]
    radii: Option<String>,
    /// Print the counts as JSON
    #[arg(long)]
    json: bool,
}

impl Skeleton {
    /// Reads the skeleton, tells its counts and remarks, and writes it. False if a dataset has
    /// errors.
    pub fn run(&self) -> Outcome {
        if !(is_length(self.scale, 1e-9) && is_length(self.thicken, f64::MIN)) {
            return Err(String::from(
                "--scale must be above 0, and --thicken a number",
            ));
        }
        for (word, length) in [("--merge", self.merge), ("--simplify", self.simplify)] {
            if length.is_some_and(|length| !is_length(length, 0.0)) {
                return Err(format!("{word} must be 0 or more"));
            }
        }
        if self.radius.is_some_and(|radius| !is_length(radius, 1e-12)) {
            return Err(String::from("--radius must be above 0"));
        }
        let write = self.to.as_deref().map(choose_writer).transpose()?;
        let Some(graph) = self.graph()? else {
            return Ok(false);
        };
        self.tell(&graph);
        if let (Some(write), Some(to)) = (write, &self.to) {
            let name = self.file.file_stem().unwrap_or_default();
            let limbs::Written { text, remarks } = write(&graph, &name.to_string_lossy());
            for remark in remarks {
                eprintln!("{}: {remark}", to.display());
            }
            whole::write(to, |file| {
                file.write_all(text.as_bytes())
                    .map_err(|error| format!("cannot write {}: {error}", to.display()))
            })?;
            eprintln!("wrote {}", to.display());
        }
        Ok(true)
    }

    /// Returns the skeleton as it is wanted; `None` if a dataset has errors.
    fn graph(&self) -> Result<Option<Graph>, String> {
        let name = self.file.display();
        let ending = self.file.extension().unwrap_or_default().to_string_lossy();
        let is_text = TEXTS.iter().any(|own| own.eq_ignore_ascii_case(&ending));
        let mut graph = if is_text {
            let loaded = files::load(&self.file)?;
            if !crate::report::to_stderr(&loaded) {
                return Ok(None);
            }
            let graph = gather(&loaded.compiled.scene);
            let mut graph = graph.map_err(|error| format!("{name}: {error}"))?;
            if let Some(within) = self.merge {
                let merged = graph.merge(within / self.scale);
                merged.map_err(|error| format!("{name}: {error}"))?;
            }
            if let Some(within) = self.simplify {
                graph.simplify(within / self.scale);
            }
            graph
        } else {
            let bytes = files::read_bounded(&self.file, files::MAX_ASSET)?;
            let recipe = Recipe {
                radii: self.radii.clone(),
                bonds: self.bonds,
                merge: self.merge.map(|within| within / self.scale),
                simplify: self.simplify.map(|within| within / self.scale),
            };
            recipe
                .make(&name.to_string(), &bytes)
                .map_err(|error| format!("{name}: {error}"))?
        };
        graph.scale(self.scale);
        if graph.nodes.iter().any(|node| node.is_guessed) {
            let Some(radius) = self.radius else {
                return Err(format!(
                    "{name} gives no radii above 0: name its array of radii by --radii NAME, or \
                     give it a radius by --radius R"
                ));
            };
            graph.give_radius(radius);
        }
        if self.thicken != 0.0 {
            graph.thicken(self.thicken);
        }
        Ok(Some(graph))
    }

    /// Tells counts and remarks.
    fn tell(&self, graph: &Graph) {
        for remark in &graph.remarks {
            eprintln!("{}: {remark}", self.file.display());
        }
        let facts = graph.facts();
        let balls = graph.nodes.iter().filter(|node| node.is_ball).count();
        let radii = graph.limbs.iter().flat_map(|limb| limb.radii);
        let [least, most] = radii.fold([f64::INFINITY, 0.0], |[least, most]: [f64; 2], radius| {
            [least.min(radius), most.max(radius)]
        });
        if self.json {
            let kinds: Vec<&str> = graph.groups.iter().map(|own| own.name.as_str()).collect();
            let counts = serde_json::json!({
                "limbs": graph.limbs.len(),
                "nodes": graph.nodes.len(),
                "balls": balls,
                "components": facts.components,
                "cycles": facts.cycles,
                "free_ends": facts.free_ends,
                "valence": facts.valence,
                "radii": if graph.limbs.is_empty() { None } else { Some([least, most]) },
                "types": kinds,
                "clips": graph.clips.len(),
                "remarks": graph.remarks.iter().map(ToString::to_string).collect::<Vec<_>>(),
            });
            println!("{counts}");
            return;
        }
        eprintln!(
            "{}: {} limbs between {} nodes, {balls} balls, {} parts, {} cycles, {} free ends",
            self.file.display(),
            graph.limbs.len(),
            graph.nodes.len(),
            facts.components,
            facts.cycles,
            facts.free_ends,
        );
    }
}

/// Whether a number is a length, and no less than another.
fn is_length(length: f64, least: f64) -> bool {
    length.is_finite() && length >= least
}

/// Returns the writer for the ending of a file, which also gets the skeleton's name.
fn choose_writer(to: &Path) -> Result<fn(&Graph, &str) -> limbs::Written, String> {
    let ending = to.extension().unwrap_or_default().to_string_lossy();
    match ending.to_ascii_lowercase().as_str() {
        "rat" => Ok(write_text),
        "swc" => Ok(|graph, _| graph.write_swc()),
        "obj" => Ok(|graph, _| graph.write_obj()),
        _ => Err(format!(
            "{}: skeletons are written as .rat, .swc or .obj",
            to.display()
        )),
    }
}

/// Returns a text that draws a skeleton in the block form. Types have materials of their names, so
/// that the way back finds them.
fn write_text(graph: &Graph, name: &str) -> limbs::Written {
    let letters = name.chars().map(|c| match c {
        c if c.is_ascii_alphanumeric() => c,
        _ => '_',
    });
    let name: String = "S_".chars().chain(letters).collect();
    let types = graph.groups.iter().map(|group| &group.name[..]);
    let types: Vec<(&str, &str)> = types
        .filter(|kind| graph.groups.len() > 1 && is_word(kind))
        .map(|kind| (kind, kind))
        .collect();
    let block = graph.write_block("Flesh", &name, &types);
    let mut text = view::write(graph);
    for (_, material) in types.iter().filter(|(kind, _)| *kind != "Flesh") {
        text += &format!("surface {material} = Flesh\n");
    }
    limbs::Written {
        text: text + &block.text,
        remarks: block.remarks,
    }
}

/// Whether a type can be the name of a material.
fn is_word(kind: &str) -> bool {
    kind.starts_with(|c: char| c.is_ascii_alphabetic())
        && kind.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}

/// Returns the lines and balls of a scene; the kinds of limbs are the names of their materials.
fn gather(scene: &Scene) -> Result<Graph, limbs::Error> {
    let mut builder = Builder::default();
    for element in &scene.elements {
        let finish = scene.finishes.get(element.finish as usize);
        let kind = finish.map_or("", |finish| &finish.name);
        if let Shape::Function(function) = &element.shape {
            let growth = function.growth();
            for ends in function
                .curves()
                .into_iter()
                .flat_map(scene::Curves::pieces)
            {
                let places = ends.map(|(place, _)| function.to_world.transform_point3(place));
                builder.limb(places, ends.map(|(_, radius)| radius * growth), kind)?;
            }
        }
        let Some(bone) = element.shape.bone() else {
            continue;
        };
        let radii = bone.radii(scene.radius(element));
        match bone.skeleton.dimension() {
            0 => builder.ball(bone.skeleton.middle(), radii[0], kind)?,
            1 => {
                for line in bone.skeleton.lines(1.0) {
                    let count = (line.len() - 1).max(1) as f64;
                    for (i, ends) in line.windows(2).enumerate() {
                        let own = [i, i + 1]
                            .map(|i| radii[0] + (radii[1] - radii[0]) * (i as f64 / count));
                        builder.limb([ends[0], ends[1]], own, kind)?;
                    }
                }
            }
            _ => {}
        }
    }
    builder.finish()
}
