//! The texts in the pages of the manual that are written by hand draw what they say.

use rats::{Asset, Project, compile_at};
use std::fs;
use std::path::Path;

/// The pages, and how many texts to be drawn each has.
const PAGES: [(&str, usize); 3] = [("neurons", 1), ("lattices", 2), ("metaballs", 2)];

#[test]
fn texts_of_the_guides_compile_cleanly() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../www");
    let assets = ["neuron.swc", "lattice.3mf"].map(|name| {
        let bytes = fs::read(folder.join("examples").join(name)).expect(name);
        Asset::new(name, bytes)
    });
    for (name, count) in PAGES {
        let page = fs::read_to_string(folder.join(format!("{name}.html"))).expect(name);
        let texts: Vec<String> = page
            .split("<pre class=\"rat\">")
            .skip(1)
            .map(|rest| {
                let text = rest.split("</pre>").next().unwrap_or_default();
                text.replace("&lt;", "<").replace("&gt;", ">")
            })
            .collect();
        assert_eq!(texts.len(), count, "{name}");
        for text in texts {
            let compiled = compile_at(&Project::single(text.as_str()), &assets, 0.0);
            assert_eq!(compiled.diagnostics, [], "{name}: {text}");
            assert!(!compiled.scene.elements.is_empty(), "{name}: {text}");
        }
    }
}

#[test]
fn spellings_of_elements_in_the_table_are_commands() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../www");
    let page = fs::read_to_string(folder.join("metaballs.html")).expect("the page");
    let mut count = 0;
    for form in page.split("<code>").skip(1) {
        let form = form.split("</code>").next().unwrap_or_default();
        if !form.contains(" Clay ") {
            continue;
        }
        count += 1;
        // Its letters stand for numbers and places.
        let form = form.replace("&lt;", "<").replace("&gt;", ">");
        let text = format!(
            "eyep 0 0 50\nvar r = 1\nvar r1 = 2\nvar r2 = 1\nvar a = 4\nvar R = 8\nvar x = 1\n\
             var y = 2\nvar z = 3\nvar P = <0 0 0>\nvar Q = <5 0 0>\n\
             surface Clay, diffuse Coral, blobbiness -1.5\n{form}\n"
        );
        let compiled = compile_at(&Project::single(text.as_str()), &[], 0.0);
        assert_eq!(
            compiled.scene.elements.len(),
            1,
            "{form}: {:?}",
            compiled.diagnostics
        );
    }
    assert_eq!(count, 5);
}
