//! The cost of softness: the thesis's eight models (table 3.3) as convolution surfaces and as the
//! offset surfaces of their skeletons. And the cost of bodies: many small ones against one large one.

use super::goal::{Goal, Wanted, short};
use super::scenes::Scenes;
use super::series::alternate;
use super::{Piece, ours};
use crate::shell::root;
use anyhow::Result;
use std::fmt::Write;

/// Our example, the thesis's name, and its ratio.
const MODELS: [(&str, &str, f64); 8] = [
    ("shell-1", "Shell I", 7.81),
    ("shell-2", "Shell II", 1.58),
    ("shell-3", "Shell III", 3.20),
    ("cowrie", "Cowrie", 3.26),
    ("seaweed", "Seaweed", 1.34),
    ("coral-tree", "Coral", 3.43),
    ("seahorse", "Seahorse", 2.19),
    ("coral-crab", "Crab", 3.29),
];

/// Measures all of them.
pub fn measure() -> Result<Piece> {
    let scenes = Scenes::new()?;
    let mut page = String::from(
        "The thesis's eight models (table 3.3), `www/examples/*.rat` at 512×512 with up to 4×4 rays a pixel and their \
         own lights and shadows, with `soft on` and `soft off`; seconds, the quickest of 3 in turn.\n\n\
         | model | elements | hard | soft | soft ÷ hard | thesis |\n|---|--:|--:|--:|--:|--:|\n",
    );
    let mut ratios = Vec::new();
    for (example, title, thesis) in MODELS {
        let path = root().join(format!("www/examples/{example}.rat"));
        let path = path.to_string_lossy();
        let mut elements = 0.0;
        let mut time = |soft: &str| {
            let options = ["--pass=smooth", "--size", "512", "512", "--soft", soft];
            let cost = ours::time(&scenes.sinew, &[&[&*path][..], &options].concat())?;
            elements = cost.elements;
            Ok(cost.seconds)
        };
        let time = std::cell::RefCell::new(&mut time);
        let [hard, soft] = alternate(
            3,
            [&mut || (time.borrow_mut())("off"), &mut || {
                (time.borrow_mut())("on")
            }],
        )?;
        let ratio = soft.best() / hard.best();
        ratios.push(ratio);
        let row = format!(
            "| {title} | {elements} | {} | {} | {} | {thesis} |\n",
            hard.text(),
            soft.text(),
            short(ratio)
        );
        print!("{row}");
        page += &row;
    }
    let mean = ratios.iter().sum::<f64>() / ratios.len() as f64;
    writeln!(page, "| mean | | | | {} | 3.26 |\n", short(mean))?;
    let goal = Goal {
        what: "8 thesis models, mean of soft ÷ hard".into(),
        against: "thesis: 3.26".into(),
        wanted: Wanted::AtMost(1.6),
        unit: "×",
        measured: Ok(mean),
    };
    let bodies = bodies(&scenes, &mut page)?;
    Ok((vec![goal, bodies], page))
}

/// How many bodies of three elements are compared with one body of all elements.
const BODIES: &str = "5000";

/// Times a scene of very many bodies against the same elements as one body.
fn bodies(scenes: &Scenes, page: &mut String) -> Result<Goal> {
    let time = |bodies: &str| {
        let options = ["--balls", BODIES, "--bodies", bodies];
        Ok(ours::time(&scenes.sinew, &options)?.seconds)
    };
    let [one, many] = alternate(5, [&mut || time("triples"), &mut || time("many")])?;
    let ratio = many.best() / one.best();
    writeln!(
        page,
        "{BODIES} molecules of three Gaussian balls (`sinew time --balls {BODIES} --bodies many`), each a body of its own, and all \
         in one body; one ray a pixel:\n\n| one body | {BODIES} bodies | ratio |\n|--:|--:|--:|\n| {} | {} | {} |\n",
        one.text(),
        many.text(),
        short(ratio)
    )?;
    Ok(Goal {
        what: format!("{BODIES} bodies of 3 elements ÷ one body of them"),
        against: "one body".into(),
        wanted: Wanted::AtMost(2.0),
        unit: "×",
        measured: Ok(ratio),
    })
}
