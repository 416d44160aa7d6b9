//! `contact`: bodies that touch instead of overlap.

use super::state::{Evaluator, Flow};
use crate::Severity;
use crate::given::Given;
use crate::limits::MAX_CONTACTS;
use crate::problem::{Outcome, Problem};
use crate::syntax::Command;
use contact::Bulge;
use scene::Contact;

/// `contact A B [fast c | height c m h | ripple c h n]`, `contact A self …`
pub fn contact<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let given = run.given(command)?;
    let (a, b) = (given.name("A"), given.name("B"));
    let first = run.model.find_body(a)?;
    let folds = b.text == "self";
    let bodies = [
        first,
        if folds {
            first
        } else {
            run.model.find_body(b)?
        },
    ];
    if folds && !run.model.has_local(first) {
        return Err(Problem::new(
            b.span.clone(),
            format!("`{}` has no skeleton whose folds could touch", a.text),
        )
        .hint("write `local 1` in the body's `skeleton`, before its block: within this length it blends"));
    }
    if bodies[0] == bodies[1] && !folds {
        return Err(
            Problem::new(b.span.clone(), format!("`{}` cannot touch itself", b.text))
                .hint("name another body, or write `self` for its folds"),
        );
    }
    let bulge = bulge(&given)?;
    let model = &mut run.model;
    let contacts = &mut model.contacts;
    let same = |c: &Contact| c.bodies == bodies || c.bodies == [bodies[1], bodies[0]];
    if contacts.len() >= MAX_CONTACTS {
        return Err(Problem::new(
            command.word_span.clone(),
            format!("there are more than {MAX_CONTACTS} contacts"),
        ));
    }
    // Of the same bodies the last one counts.
    let earlier = contacts.iter().position(same);
    if let Some(index) = earlier {
        contacts.remove(index);
        model.contact_places.remove(index);
    }
    let shared = |c: &&Contact| {
        c.bodies[0] != c.bodies[1] && !folds && c.bodies.iter().any(|body| bodies.contains(body))
    };
    let differs = contacts.iter().filter(shared).any(|c| c.bulge != bulge);
    contacts.push(Contact { bodies, bulge });
    model.contact_places.push((run.file, command.span.clone()));
    let (a, b) = (a.text, b.text);
    if earlier.is_some() {
        run.say(Severity::Warning, command.span.clone(), || {
            (
                format!("how `{a}` and `{b}` touch is said twice: the last time counts"),
                Some(String::from("take one of them out")),
            )
        });
    }
    if differs {
        run.say(Severity::Warning, command.span.clone(), || {
            (
                format!("`{a}` or `{b}` touches another body with another bulge"),
                Some(String::from(
                    "where three bodies meet, different bulges leave a step; write the same for all",
                )),
            )
        });
    }
    Ok(Flow::Next)
}

/// The bulge that the options say; the default without any.
fn bulge(given: &Given<'_>) -> Outcome<Bulge> {
    let [chosen, others @ ..] = &given.options[..] else {
        return Ok(Bulge::default());
    };
    if let Some(second) = others.first() {
        return Err(
            Problem::new(second.span.clone(), "a contact has one bulge only")
                .hint("write `fast c`, `height c m h` or `ripple c h n`"),
        );
    }
    let number = |name| chosen.given.number(name);
    let c = number("c");
    let bulge = match chosen.name {
        "height" => Bulge::Height {
            c,
            m: number("m"),
            h: number("h"),
        },
        "ripple" => Bulge::Ripple {
            c,
            h: number("h"),
            n: number("n") as u32,
        },
        _ => Bulge::Fast { c },
    };
    if !bulge.is_usable() {
        let span = chosen.given.span("m");
        return Err(Problem::new(
            span.unwrap_or_else(|| chosen.span.clone()),
            "the bulge is highest before it begins",
        )
        .hint("m must be above c"));
    }
    Ok(bulge)
}
