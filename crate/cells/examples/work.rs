//! Tells what the cells of datasets cost: `cargo run -p cells --example work -- [--quick] FILES`.

use cells::{Cubics, Detail, Packed};
use std::path::Path;
use std::time::Instant;

fn main() {
    let (options, files): (Vec<_>, Vec<_>) = std::env::args()
        .skip(1)
        .partition(|argument| argument == "--quick");
    let details: &[Detail] = if options.is_empty() {
        &[Detail::Quick, Detail::Fine]
    } else {
        &[Detail::Quick]
    };
    for file in files {
        let path = Path::new(&file);
        let folder = path.parent().unwrap_or(Path::new(""));
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let text = std::fs::read_to_string(path).expect("a text");
        let mut project = rats::Project {
            files: vec![rats::File {
                name: name.clone().into_owned(),
                text: text.clone(),
            }],
        };
        for name in rats::reads(&text) {
            if let Ok(text) = std::fs::read_to_string(folder.join(&name)) {
                project.files.push(rats::File { name, text });
            }
        }
        let assets: Vec<_> = rats::asset_names(&text)
            .into_iter()
            .filter_map(|name| {
                let bytes = std::fs::read(folder.join(&name)).ok()?;
                Some(rats::Asset::new(name, bytes))
            })
            .collect();
        let scene = rats::compile_at(&project, &assets, 0.0).scene;
        for detail in details {
            let start = Instant::now();
            let packed = Packed::new(&scene, *detail, &Cubics, &mut |_| true).expect("wanted");
            println!(
                "{name:20} {detail:?} {:6.2} s, {:6} kB, {:6} leaves, {:6} rough, work {:8}, \
                 meshed {:?}",
                start.elapsed().as_secs_f64(),
                packed.data.len() / 1000,
                packed.leaves,
                packed.rough,
                packed.work,
                packed.meshed
            );
        }
    }
}
