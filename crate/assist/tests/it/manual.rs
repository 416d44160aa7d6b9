//! The reference page.

use crate::texts::one_file;
use assist::manual::{page, reference};
use rats::{Severity, commands, compile};

#[test]
fn every_command_is_explained() {
    let reference = reference();
    for spec in commands::all() {
        let section = format!("<section id=\"{}\"", spec.name);
        assert_eq!(reference.matches(&section).count(), 1, "{}", spec.name);
        let link = format!("href=\"#{}\"", spec.name);
        assert!(reference.contains(&link), "{}", spec.name);
        let text = page(spec.name).expect("a page");
        assert!(text.contains(spec.meaning), "{}", spec.name);
    }
    assert!(page("nosuch").is_none());
}

/// Every element that is opened is closed, inside the element in which it was opened.
#[test]
fn the_page_is_well_formed() {
    let reference = reference();
    let mut open: Vec<&str> = Vec::new();
    let mut rest = reference.as_str();
    while let Some(start) = rest.find('<') {
        let end = start + rest[start..].find('>').expect("an end");
        let tag = &rest[start + 1..end];
        rest = &rest[end + 1..];
        let name = tag.split_whitespace().next().expect("a name");
        match name.strip_prefix('/') {
            Some(name) => assert_eq!(open.pop(), Some(name), "{tag}"),
            None if ["!doctype", "meta", "br", "link", "input", "img"].contains(&name) => {}
            None => open.push(name),
        }
    }
    assert_eq!(open, [""; 0]);
    // Nothing from elsewhere.
    for word in ["http", "url(", "=\"//"] {
        assert!(!reference.contains(word), "{word}");
    }
    for source in reference.split("src=\"").skip(1) {
        let own = source.starts_with("reference.js\"") || source.starts_with("reference/");
        assert!(own, "{}", source.split('"').next().unwrap_or_default());
    }
}

#[test]
fn examples_run() {
    for spec in commands::all() {
        let compiled = compile(&one_file(spec.example));
        let errors: Vec<_> = compiled
            .diagnostics
            .iter()
            .filter(|d| d.severity == Severity::Error)
            .collect();
        assert!(errors.is_empty(), "{}: {errors:?}", spec.name);
    }
}
