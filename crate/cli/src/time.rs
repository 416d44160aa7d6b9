//! `sinew time`: what tracing a picture costs on one thread, for `cargo xtask bench`.
//!
//! Nothing is written to a file. The figures go to the standard output as one line of JSON.

mod balls;
mod machine;

use crate::{Outcome, files, report};
use clap::{Args, ValueEnum};
use field::Kernel;
use scene::Scene;
use serde_json::json;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;
use tracer::Pass;

#[derive(Clone, Copy, ValueEnum)]
enum Switch {
    On,
    Off,
}

/// The kernel of a name.
fn kernel(name: &str) -> Result<Kernel, String> {
    Kernel::named(name).ok_or_else(|| {
        let names = Kernel::ALL.map(Kernel::name).join(", ");
        format!("the kernels are {names}")
    })
}

/// The last pass of the picture that is traced.
#[derive(Clone, Copy, ValueEnum)]
enum Fineness {
    /// A ray for every block of 8×8 pixels.
    Coarse,
    /// A ray a pixel.
    Full,
    /// Several rays a pixel where neighbouring pixels differ.
    Smooth,
}

/// Bodies that the balls belong to.
#[derive(Clone, Copy, ValueEnum)]
enum Bodies {
    /// A single body.
    One,
    /// A single body, with three smaller balls in place of each.
    Triples,
    /// A body for each three smaller balls.
    Many,
}

/// `sinew time FILE | --balls N [--kernel K] [--apart D] [--bodies B] [--pass P] [--size W H]
/// [--soft on|off] [--hierarchy on|off] [--rays N]`.
#[derive(Args)]
pub struct Time {
    /// The dataset
    #[arg(required_unless_present = "balls")]
    file: Option<PathBuf>,
    /// Instead of a dataset: so many balls spread evenly through a cube
    #[arg(long, value_name = "N", conflicts_with = "file")]
    balls: Option<u32>,
    /// Kernel of the balls
    #[arg(
        long,
        value_name = "K",
        default_value = "gauss",
        value_parser = kernel,
        requires = "balls"
    )]
    kernel: Kernel,
    /// The mean distance of their middles, in radii: at 3 many touch and melt together
    #[arg(long, value_name = "D", default_value_t = 3.0, requires = "balls")]
    apart: f64,
    /// Bodies that they belong to
    #[arg(long, value_name = "B", default_value = "one", requires = "balls")]
    bodies: Bodies,
    /// Pass to trace
    #[arg(long, default_value = "full")]
    pass: Fineness,
    /// Width and height in pixels, instead of the dataset's `framesize`
    #[arg(long, num_args = 2, value_names = ["W", "H"])]
    size: Option<Vec<u32>>,
    /// Draw the convolution surface, or the offset surfaces of its elements
    #[arg(long)]
    soft: Option<Switch>,
    /// Whether far primitives are judged in groups and interpolated for many rays at once, or (for
    /// comparison) each is followed by itself
    #[arg(long, default_value = "on")]
    hierarchy: Switch,
    /// Instead of the dataset's `contrast`, the one with which about so many rays are sent from the
    /// eye (with `--pass smooth`)
    #[arg(long, value_name = "N")]
    rays: Option<u64>,
}

impl Time {
    /// Traces the picture and prints what it cost; false if the dataset has errors.
    pub fn run(&self) -> Outcome {
        let (mut scene, clean) = match (&self.file, self.balls) {
            (Some(file), _) => {
                let loaded = files::load(file)?;
                let clean = report::to_stderr(&loaded);
                (Arc::unwrap_or_clone(loaded.compiled.scene), clean)
            }
            (None, count) => {
                let count = count.unwrap_or(1);
                let (kernel, apart) = (self.kernel, self.apart);
                let scene = match self.bodies {
                    Bodies::One => balls::scene(count, kernel, apart),
                    Bodies::Triples => balls::triples(count, kernel, apart, false),
                    Bodies::Many => balls::triples(count, kernel, apart, true),
                };
                (scene, true)
            }
        };
        if let Some(soft) = self.soft {
            scene.settings.soft = matches!(soft, Switch::On);
        }
        let wishes = crate::trace::Wishes {
            size: self.size.as_ref().map(|size| [size[0], size[1]]),
            ..Default::default()
        };
        wishes.apply(&mut scene)?;
        let size = scene.settings.frame;
        let pass = match self.pass {
            Fineness::Coarse => Pass::Coarse,
            Fineness::Full => Pass::Full,
            Fineness::Smooth => Pass::Smooth,
        };
        let trace = |scene: &Scene| {
            let mut picture = digger::picture(scene, size);
            if matches!(self.hierarchy, Switch::Off) {
                picture.forgo_hierarchy();
            }
            tracer::render(&picture, 1, pass, &|_| ()).1
        };
        if let Some(rays) = self.rays {
            choose_contrast(&mut scene, rays, |scene| trace(scene).primary_rays);
        }

        let (start, busy) = (Instant::now(), machine::thread_seconds());
        let stats = trace(&scene);
        let busy = machine::thread_seconds() - busy;
        let seconds = start.elapsed().as_secs_f64();
        let before = machine::thread_seconds();
        drop(digger::picture(&scene, size));
        let prepare = machine::thread_seconds() - before;
        println!(
            "{}",
            json!({
                "elements": scene.elements.len(),
                "contrast": scene.settings.contrast[0],
                "seconds": { "wall": seconds, "busy": busy, "prepare": prepare },
                "memory": machine::peak_memory(),
                "stats": stats,
            })
        );
        Ok(clean)
    }
}

/// Sets the contrast with which `rays_of` the scene come nearest to `rays`: fewer with a higher
/// one.
fn choose_contrast(scene: &mut Scene, rays: u64, rays_of: impl Fn(&Scene) -> u64) {
    let mut best = (u64::MAX, 0.0);
    // Exponents of two.
    let (mut low, mut high) = (-12.0_f64, 1.0_f64);
    for _ in 0..9 {
        let middle = 0.5 * (low + high);
        let contrast = libm::exp2(middle) as f32;
        scene.settings.contrast = [contrast; 3];
        let sent = rays_of(scene);
        let off = sent.abs_diff(rays);
        if off < best.0 {
            best = (off, contrast);
        }
        if sent > rays {
            low = middle;
        } else {
            high = middle;
        }
    }
    scene.settings.contrast = [best.1; 3];
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_contrast_with_the_wanted_number_of_rays_is_found() {
        fn rays_of(scene: &Scene) -> u64 {
            (1000.0 / scene.settings.contrast[0]) as u64
        }
        let mut scene = Scene::default();
        choose_contrast(&mut scene, 8000, rays_of);
        let rays = rays_of(&scene);
        assert!(rays.abs_diff(8000) < 200, "{rays}");
    }

    #[test]
    fn balls_are_as_many_as_asked_for_and_apart() {
        let scene = balls::scene(1000, Kernel::Gauss, 3.0);
        assert_eq!(scene.elements.len(), 1000);
        let surfaces = scene.soft_surfaces();
        assert_eq!(surfaces[0].sum.primitives.len(), 1000);
    }

    #[test]
    fn triples_are_one_body_or_many() {
        for (in_bodies, bodies) in [(false, 1), (true, 50)] {
            let scene = balls::triples(50, Kernel::Gauss, 3.0, in_bodies);
            let surfaces = scene.soft_surfaces();
            assert_eq!((scene.elements.len(), surfaces.len()), (150, bodies));
        }
    }
}
