//! The reference page, `www/reference.html`, is made from the table of commands.
//!
//! `UPDATE_EXPECT=1 cargo test -p assist --test it reference::` writes it anew; the test fails
//! while it is not what the table says.

use std::path::Path;

#[test]
fn the_page_is_what_the_table_says() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../www/reference.html");
    let page = assist::manual::reference();
    if std::env::var_os("UPDATE_EXPECT").is_some() {
        std::fs::write(&path, &page).expect("writing");
    }
    let kept = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        kept == page,
        "{} is out of date: run this test with UPDATE_EXPECT=1",
        path.display()
    );
    for spec in rats::commands::all() {
        assert!(
            page.contains(&format!("id=\"{}\"", spec.name)),
            "{}",
            spec.name
        );
    }
}

#[test]
fn pictures_are_those_of_the_examples() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../www/reference");
    let drawn = assist::manual::texts_with_pictures();
    assert!(drawn.len() > 60, "{} texts make a picture", drawn.len());
    for (name, text) in &drawn {
        let kept = std::fs::read_to_string(folder.join(format!("{name}.rat"))).unwrap_or_default();
        let has_picture = folder.join(format!("{name}.png")).is_file();
        assert!(
            kept == *text && has_picture,
            "the picture of {name} is out of date: cargo xtask reference"
        );
    }
    let files = std::fs::read_dir(&folder).expect("the folder").count();
    assert_eq!(
        files,
        2 * drawn.len(),
        "files that nothing uses in {folder:?}"
    );
}
