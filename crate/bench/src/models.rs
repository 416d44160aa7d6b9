//! The cost of softness: the thesis's eight models (table 3.3) as convolution surfaces and as the
//! offset surfaces of their skeletons. And the cost of bodies: many small ones against one large
//! one.

use crate::report::{Report, Short};
use crate::series::in_turn;
use crate::sinew::Sinew;
use anyhow::Result;

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
/// The number of bodies of three elements that are compared with one body of all elements.
const BODIES: &str = "5000";

/// Measures all of them.
pub fn measure() -> Result<Report> {
    let sinew = Sinew::new()?;
    let mut report = Report::default();
    let mut mean = 0.0;
    for (example, title, thesis) in MODELS {
        let path = format!("www/examples/{example}.rat");
        let mut elements = 0.0;
        let [hard, soft] = in_turn(3, |i| {
            let soft = ["off", "on"][i];
            let options = ["--pass=smooth", "--size", "512", "512", "--soft", soft];
            let cost = sinew.time(&[&[&*path][..], &options].concat())?;
            elements = cost.elements;
            Ok(cost.seconds)
        })?;
        let ratio = soft.over(&hard);
        mean += ratio.0 / MODELS.len() as f64;
        let model = format!("{title} | {elements}");
        report.row(
            "models",
            format!("{model} | {hard} | {soft} | {ratio} | {thesis}"),
        );
    }
    let mean = Short(mean);
    report.row("models", format!("mean | | | | {mean} | 3.26"));
    report.goal(
        "8 thesis models, mean of soft ÷ hard | thesis: 3.26 | ≤ 1.6×",
        Ok(mean),
    )?;

    report.set("count", BODIES);
    let [one, many] = ["triples", "many"].map(|bodies| ["--balls", BODIES, "--bodies", bodies]);
    let [one, many] = sinew.compare(5, [&one, &many])?;
    let ratio = many.over(&one);
    report.row("bodies", format!("{one} | {many} | {ratio}"));
    let goal = format!("{BODIES} bodies of 3 elements ÷ one body of them | one body | ≤ 2×");
    report.goal(&goal, Ok(ratio))?;
    Ok(report)
}
