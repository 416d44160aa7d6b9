//! The work for a scene is bounded: a page waits for it while a hand turns the model.

use cells::{Cubics, Detail, Packed};
use std::path::{Path, PathBuf};

/// Most work of a quick draft, in evaluations of terms: a share may be exceeded by what is looked
/// at together.
const MOST_WORK: u64 = 30_000_000;
/// Most bytes of a quick draft.
const MOST_BYTES: usize = 25_000_000;

/// Compiles a dataset with the files beside it that it reads.
fn load(path: &Path) -> scene::Scene {
    let folder = path.parent().unwrap();
    let text = std::fs::read_to_string(path).unwrap();
    let mut project = rats::Project {
        files: vec![rats::File {
            name: path.file_name().unwrap().to_string_lossy().into_owned(),
            text: text.clone(),
        }],
    };
    for name in rats::reads(&text) {
        if let Ok(text) = std::fs::read_to_string(folder.join(&name)) {
            project.files.push(rats::File { name, text });
        }
    }
    let mut assets = Vec::new();
    for name in rats::asset_names(&text) {
        if let Ok(bytes) = std::fs::read(folder.join(&name)) {
            assets.push(rats::Asset::new(name, bytes));
        }
    }
    let compiled = rats::compile_at(&project, &assets, 0.0);
    std::sync::Arc::unwrap_or_clone(compiled.scene)
}

fn quick(scene: &scene::Scene) -> Packed {
    Packed::new(scene, Detail::Quick, &Cubics, &mut |_| true).expect("wanted")
}

#[test]
fn quick_drafts_of_all_examples_take_bounded_work() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../www/examples");
    let files = std::fs::read_dir(folder).unwrap();
    let mut files: Vec<PathBuf> = files.map(|file| file.unwrap().path()).collect();
    files.retain(|file| file.extension().is_some_and(|end| end == "rat"));
    files.sort();
    assert!(files.len() > 50);
    let mut dear = Vec::new();
    for file in files {
        let name = file.file_stem().unwrap().to_string_lossy().into_owned();
        let packed = quick(&load(&file));
        let (work, bytes) = (packed.work, packed.data.len());
        println!(
            "{name}: work {work}, {bytes} bytes, meshed {:?}",
            packed.meshed
        );
        if work > MOST_WORK || bytes > MOST_BYTES {
            dear.push((name, work, bytes));
        }
    }
    assert!(dear.is_empty(), "{dear:?}");
}

/// Bodies that do not fit share what there is, and all are drawn.
#[test]
fn many_bodies_share_the_work() {
    let mut text =
        String::from("eyep 30 20 300\nvrp 30 20 22\nsurface a, diffuse Red, blobbiness -2\n");
    for body in 0..12 {
        text += &format!("body b{body}\n");
        for i in 0..250 {
            let (x, y) = (3 * (i % 20), 3 * (i / 20));
            text += &format!("sphere a 1, {x} {y} {}\n", 4 * body);
        }
        text += &format!("close b{body}\n");
    }
    let project = rats::Project {
        files: vec![rats::File {
            name: "main.rat".into(),
            text,
        }],
    };
    let compiled = rats::compile(&project);
    assert!(
        compiled.diagnostics.is_empty(),
        "{:?}",
        compiled.diagnostics
    );
    let packed = quick(&compiled.scene);
    assert_eq!(packed.meshed.len(), 12);
    assert!(
        packed.work <= MOST_WORK && packed.data.len() <= MOST_BYTES,
        "{}",
        packed.work
    );
}
