//! Places where names are made and used, and renaming.

use crate::texts::{at_mark, corpus, examples, file, names_soup, one_file, soup};
use assist::{Index, SymbolKind, definition, references, rename, rename_file};
use rats::{Compiled, Project, compile};
use trials::trials;

/// The place in «…» is where the name at `|` is made.
fn check_definition(text: &str) {
    let (project, file, byte) = at_mark(&text.replace(['«', '»'], ""));
    let found = definition(&project, file, byte);
    let (wanted, in_file, start) = at_mark(&text.replace('|', "").replace('«', "|"));
    let end = wanted.files[in_file].text.find('»').expect("an end");
    assert_eq!(
        found.map(|place| (place.file, place.span)),
        Some((in_file, start..end)),
        "{text}"
    );
}

/// The name at `|` stands in exactly the places that are in «…».
fn stands(text: &str) {
    let bare = text.replace(['«', '»'], "");
    let (project, file, byte) = at_mark(&bare);
    let mut shown = project.clone();
    for place in references(&project, file, byte).into_iter().rev() {
        shown.files[place.file].text.insert(place.span.end, '»');
        shown.files[place.file].text.insert(place.span.start, '«');
    }
    let mut joined = String::new();
    for (index, file) in shown.files.iter().enumerate() {
        if index > 0 {
            joined += &format!("#file {}\n", file.name);
        }
        joined += &file.text;
    }
    assert_eq!(joined, text.replace('|', ""));
}

#[test]
fn the_last_definition_counts() {
    check_definition("var a = 1\nvar «a» = 2\nsphere s |a P\nvar a = 3\n");
    check_definition(
        "surface T1 diff Red\nsurface «T1» = T0\nsphere T1| 1 0 0 0\n\
        surface T1 = T0\n",
    );
    check_definition("surface «T1» diff Red\nsurface T1 = |T1\n");
    check_definition("sphere |s 1 0 0 0\nsurface «s» diff Red\n");
    check_definition("var «P» = 1 2 3\nsphere s |P.x P\n");
    check_definition("texture «t» strength sin one\nsurface s rad 1 text u + |t\n");
    check_definition("object «A»\nclose\nobject B\nclose\nrotate 0 0 1 30, |A\n");
    check_definition("define «leg»(a) {\n}\n|leg 3\n");
    check_definition("define leg(«a», B) {\n sphere s |a B\n}\n");
    check_definition("define leg(surface «s») {\n sphere |s 1 0 0 0\n}\n");
    check_definition("define walk() { leg 1, b|=3 }\ndefine leg(a, «b» = 2) {\n}\n");
    check_definition("define leg(a, «b» = 2) {\n}\nleg 1, b|=3\n");
    check_definition("var «r» = 1 hot\nvar h = 2 hot\npreset big, set h 3, set |r 4, set h 5\n");
    check_definition("var r = 1 hot\nvar «V» = 1 2 3 hot\npreset big set r 3 set V| 4 5 6\n");
    check_definition("for «i» = 1 to 3 {\n sphere s |i 0 0 0\n}\n");
    check_definition("var i = 1\nfor «i» = 1 to 3 { sphere s |i 0 0 0 }\n");
    check_definition("for i = 1 to 3 { for «i» = i to 3 { sphere s |i 0 0 0 } }\n");
}

#[test]
fn all_names() {
    let mut project = one_file(
        "surface S diff Red\nvar a = 1\nfor i = 1 to a { sphere S i 0 0 0 }\nread b.rat\n\
         surface S rad a\n",
    );
    project.files.push(file(
        "b.rat",
        "define f(P) { object O\nclose }\ntexture t strength x x\n",
    ));
    let index = Index::of(&project);
    let names: Vec<_> = index
        .symbols()
        .into_iter()
        .map(|s| (s.kind.word(), s.name, s.place.file, s.place.span.start))
        .collect();
    assert_eq!(
        names,
        [
            ("file", "main.rat".to_owned(), 0, 0),
            ("file", "b.rat".to_owned(), 1, 0),
            ("material", "S".to_owned(), 0, 8),
            ("variable", "a".to_owned(), 0, 23),
            ("loop variable", "i".to_owned(), 0, 33),
            ("command", "f".to_owned(), 1, 7),
            ("parameter", "P".to_owned(), 1, 9),
            ("object", "O".to_owned(), 1, 21),
            ("texture", "t".to_owned(), 1, 39),
        ]
    );
    assert_eq!(index.places().count(), 15);
    assert_eq!(
        index.symbol_at(0, 53).map(|s| s.kind),
        Some(SymbolKind::Material)
    );
}

#[test]
fn files() {
    check_definition("read b.rat\nsphere s |a 0 0 0\n#file b.rat\nvar «a» = 2\n");
    check_definition("var «a» = 2\nread b.rat\nvar a = 3\n#file b.rat\nsphere s |a 0 0 0\n");
    let (project, file, byte) = at_mark("quit\nread ./b|.rat\n#file b.rat\nquit\n");
    let place = definition(&project, file, byte).expect("a file");
    assert_eq!((place.file, place.span), (1, 0..0));
    stands("read «b|.rat», ./«b.rat»\n#file b.rat\n# b.rat\n");
}

#[test]
fn one_kind_of_name_is_not_another() {
    stands(
        "surface «s|» diff Red\nobject s\nclose s\nvar s = 1\nsphere «s» s 0 0 0\nchain «s», s\n\
         close\n",
    );
    stands(
        "surface s diff Red\nvar «s» = 1\nsphere s |«s» 0 0 0 # s\n"
            .replace("|«s»", "«|s»")
            .as_str(),
    );
    stands("define f(«a|») { var b = «a»*2\n sphere s b «a» 0 0 }\nvar a = 2\nf a\n");
    stands(
        "var «a|» = 2\ndefine f(a) { sphere s a 0 0 0 }\ndefine g(b) { sphere s «a» b 0 0 }\n\
         f «a»\n",
    );
    stands("var «a|» = 2\ndefine f(b) { var a = «a» + b\n sphere s a 0 0 0 }\n");
    stands("var a = 2\ndefine f(b) { var «a» = a + b\n sphere s «|a» 0 0 0 }\n");
}

#[test]
fn names_that_may_be_the_same_are_renamed_together() {
    // Set only sometimes: the other variable may be meant.
    stands("var «a|» = 2\ndefine f(b) { if b { var «a» = 1 }\n sphere s «a» 0 0 0 }\n");
    // Without another one there is nothing to be mixed up with.
    stands(
        "define f(b) { if b { var «a|» = 1 }\n sphere s «a» 0 0 0 }\n\
         for a = 1 to 2 { sphere s a 0 0 0 }\n",
    );
    // The second time round the local one is meant.
    stands("var «a|» = 2\ndefine f(b) { for i = 1 to 2 { sphere s «a» 0 0 0\nvar «a» = 1 } }\n");
    // A command that is called in the loop sees its variable.
    stands("define f() { sphere s «i» 0 0 0 }\nfor «i|» = 1 to 3 { f }\nfor «i» = 1 to 2 { f }\n");
    stands("define f() { sphere s 1 0 0 0 }\nfor «i|» = 1 to 3 { f }\nfor i = 1 to 2 { f }\n");
    // So does a file that is read there.
    stands("for «i|» = 1 to 3 { read b.rat }\n#file b.rat\nsphere s «i» 0 0 0\n");
    stands("read b.rat\nfor «i|» = 1 to 3 { read b.rat }\n#file b.rat\nsphere s «i» 0 0 0\n");
    stands("define f(«i|») { read b.rat }\n#file b.rat\nsphere s «i» 0 0 0\n");
}

#[test]
fn words_that_are_no_names() {
    for text in [
        "surface s |diff Red",
        "surface s diff |Red",
        "|sphere s 1 0 0 0",
        "# |a",
        "var a = 1 |hot",
        "sphere s |1 0 0 0",
        "var a = |sin(1)",
        "|",
        "sphere s 1| 0 0 0",
    ] {
        let (project, file, byte) = at_mark(text);
        assert_eq!(definition(&project, file, byte), None, "{text}");
        assert_eq!(references(&project, file, byte), [], "{text}");
    }
    let project = one_file("var a = 1\n");
    assert_eq!(definition(&project, 7, 4), None);
    assert_eq!(definition(&project, 0, 400), None);
}

fn rename_at(text: &str, name: &str) -> Result<String, String> {
    let (project, file, byte) = at_mark(text);
    let edits = rename(&project, file, byte, name)?;
    Ok(project.apply(&edits).files[0].text.clone())
}

fn refusal(text: &str, name: &str) -> String {
    rename_at(text, name).expect_err("a refusal")
}

#[test]
fn renaming() {
    assert_eq!(
        rename_at(
            "var |a = 1 # a\nsurface a rad a\nsphere a a 0 0 0\n",
            "radius"
        ),
        Ok(String::from(
            "var radius = 1 # a\nsurface a rad radius\nsphere a radius 0 0 0\n"
        ))
    );
    assert_eq!(
        rename_at("surface a^2 rad 1\nsphere |a^2 1 0 0 0\n", "b^3.x"),
        Ok(String::from("surface b^3.x rad 1\nsphere b^3.x 1 0 0 0\n"))
    );
    // Before it is a variable it is a colour.
    assert_eq!(
        rename_at("background Red\nvar |Red = Red\nfog Red", "b"),
        Ok(String::from("background Red\nvar b = Red\nfog b"))
    );
    assert_eq!(
        refusal("var b = 2\nvar |a = 1\n", "b"),
        "`b` is taken: line 1 of main.rat makes a variable of that name"
    );
    assert_eq!(
        refusal("var |a = 1\n", "2"),
        "`2` is no name: a name is a word of letters, digits and `_`"
    );
    assert_eq!(
        refusal("var |a = 1\n", "a b"),
        "`a b` is no name: a name is a word of letters, digits and `_`"
    );
    assert_eq!(
        refusal("var |a = 1\n", "hot"),
        "`hot` is a word of the language"
    );
    assert_eq!(refusal("var |a = 1\n", "red"), "`red` is a colour");
    assert_eq!(
        refusal("var |a = 1\n", "sin"),
        "`sin` is a function or constant"
    );
    assert_eq!(
        refusal("define f(|P) {\n}\n", "p").split(',').next(),
        Some("a parameter in CAPITALS takes a triple")
    );
    assert_eq!(
        refusal("define |f(P) {\n}\n", "sphere"),
        "`sphere` is already a command of the language"
    );
    assert_eq!(
        refusal("|quit\n", "a"),
        "there is no name here that the texts define"
    );
    // `shin` would be the option of the surface, and no second number.
    assert_eq!(
        refusal("var |q = 1\nsurface s blob -1 q\n", "shin"),
        "`shin` would be taken for something else in one of the places"
    );
    // In the command the parameter would be meant.
    assert_eq!(
        refusal("var |a = 1\ndefine f(b) { sphere s a b 0 0 }\n", "b"),
        "`b` would be taken for something else in one of the places"
    );
    assert_eq!(
        refusal("var |a = 1\nfor i = 1 to 2 {\nsphere s a 0 0 0\n", "b"),
        "first mend line 2 of main.rat: this `{` of `for` is never closed"
    );
    assert_eq!(
        rename_at("var |a = 1\n", "a"),
        Ok(String::from("var a = 1\n"))
    );
}

#[test]
fn renaming_files() {
    let mut project = one_file("read a.rat, ./a.rat\nread b.rat\n");
    project.files.push(file("a.rat", "# a.rat\n"));
    project.files.push(file("b.rat", ""));
    let edits = rename_file(&project, 1, "sub/c-2.rat").expect("edits");
    assert_eq!(
        project.apply(&edits).files[0].text,
        "read sub/c-2.rat, ./sub/c-2.rat\nread b.rat\n"
    );
    assert_eq!(
        rename(&project, 0, 6, "sub/c-2.rat"),
        Err(String::from(
            "`a.rat` is a file: rename the file itself, and what reads it follows"
        ))
    );
    for name in ["", "b.rat", "a b", "a,b", "x#", "🐚", "./a"] {
        assert!(rename_file(&project, 1, name).is_err(), "{name}");
    }
    assert!(rename_file(&project, 9, "c.rat").is_err());
}

/// Every name of a project can be renamed, and the texts mean the same.
fn any_rename(project: &Project) -> bool {
    let before = compile(project);
    let has_errors = before
        .diagnostics
        .iter()
        .any(|d| d.severity == rats::Severity::Error);
    for symbol in Index::of(project).symbols() {
        if symbol.kind == SymbolKind::File {
            continue;
        }
        let new = if symbol.name.chars().any(char::is_lowercase) {
            "zqx"
        } else {
            "ZQX"
        };
        let byte = symbol.place.span.start;
        let edits = match rename(project, symbol.place.file, byte, new) {
            Ok(edits) => edits,
            // An `else` may have lost its `if`.
            Err(why) if why.starts_with("first mend") => return false,
            Err(why) => panic!("{}: {why}\n{:?}", symbol.name, project.files),
        };
        let after = project.apply(&edits);
        // A command that fails may leave a variable unset, and then another one of its name counts.
        if has_errors {
            continue;
        }
        let compiled = compile(&after);
        assert_eq!(
            (without_names(&before), places_of(&before)),
            (without_names(&compiled), places_of(&compiled)),
            "{symbol:?}\n{:?}\n{:?}",
            project.files,
            after.files
        );
    }
    !has_errors
}

fn without_names(compiled: &Compiled) -> scene::Scene {
    let mut scene = scene::Scene::clone(&compiled.scene);
    for element in &mut scene.elements {
        element.origin.start = 0;
        element.origin.end = 0;
    }
    for finish in &mut scene.finishes {
        finish.name = String::new();
    }
    for body in &mut scene.bodies {
        *body = scene::Body::default();
    }
    scene
}

/// The messages without what stands in them, since they tell names.
fn places_of(compiled: &Compiled) -> Vec<(String, usize, rats::Severity)> {
    let diagnostics = compiled.diagnostics.iter();
    diagnostics
        .map(|d| (d.file.clone(), d.line, d.severity))
        .collect()
}

#[test]
fn renaming_keeps_the_meaning_of_examples() {
    for project in examples() {
        let text = &project.files[0].text;
        // Those with images, meshes and other texts of their own do not compile without them.
        if text.len() < 20_000 && rats::asset_names(text).is_empty() && rats::reads(text).is_empty()
        {
            assert!(any_rename(&project));
        }
    }
}

#[test]
fn renaming_keeps_the_meaning_of_any_names() {
    let compared = std::cell::Cell::new(0);
    trials(|u| {
        let mut project = one_file(&names_soup(u)?);
        project.files.push(file("other.rat", &names_soup(u)?));
        compared.set(compared.get() + usize::from(any_rename(&project)));
        Ok(())
    })
    .cases(300);
    assert!(compared.get() >= 1, "no text without errors");
}

#[test]
fn any_place_of_any_text() {
    for project in corpus() {
        let index = Index::of(&project);
        for (number, file) in project.files.iter().enumerate() {
            for byte in 0..file.text.len() + 2 {
                let places = index.references_at(number, byte);
                let definition = index.definition_at(number, byte);
                assert_eq!(definition.is_none(), places.is_empty());
            }
        }
    }
    trials(|u| {
        let mut project = one_file(&soup(u)?);
        project.files.push(file("other.rat", &soup(u)?));
        let byte = u.int_in_range(0..=project.files[0].text.len() + 1)?;
        for place in references(&project, 0, byte) {
            assert!(project.files[place.file].text.get(place.span).is_some());
        }
        let _ = rename(&project, 0, byte, "new");
        Ok(())
    })
    .cases(600);
}
