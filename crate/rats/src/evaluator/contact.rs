//! `contact`: bodies that touch instead of overlap.

use super::state::{Evaluator, Flow};
use crate::commands::build::{flesh, options, row, takes};
use crate::commands::slot::{Placed, Slot, existing, number, whole};
use crate::commands::{CommandSpec, Names};
use crate::given::Options;
use crate::limits::MAX_CONTACTS;
use crate::problem::{Outcome, Problem};
use crate::reader::Name;
use crate::syntax::Command;
use contact::Bulge;
use scene::Contact;

const BULGE_START: Slot<f64> =
    number("c", "the other's field where the bulge begins").from(0.001, 0.999);
const BULGE_HEIGHT: Slot<f64> = number("h", "the height of the bulge").from(0.0, 0.999);

options! {
    /// Options of `contact`.
    CONTACT_OPTIONS:
    FAST: f64 = ("fast", "0.2", "a plain bulge, which begins where the other's field is c",
        BULGE_START);
    HEIGHT: (f64, Placed<f64>, f64) = ("height", "",
        "a bulge from c on that is highest, h, where the other's field is m",
        BULGE_START,
        number("m", "the other's field where the bulge is highest").from(0.001, 0.999).with_place(),
        BULGE_HEIGHT);
    RIPPLE: (f64, f64, u32) = ("ripple", "",
        "a bulge of height h with n ripples outside it, from c on",
        BULGE_START,
        BULGE_HEIGHT,
        whole("n", 0, contact::Bulge::MOST_RIPPLES, "the number of ripples"));
}

/// `contact A B [fast c | height c m h | ripple c h n]`, `contact A self …`
pub static CONTACT: CommandSpec = row("contact", "let two bodies touch instead of overlap")
    .with(takes!(
        contact,
        [CONTACT_OPTIONS],
        existing("A", Names::Object, "a body's name"),
        existing("B", Names::Object, "the other body's name, or `self`")
    ))
    .newer()
    .default("fast 0.2")
    .details(
        "Where the bodies would overlap, each is pressed flat against the other, and beside it \
         both swell a little. Fields are in units of the threshold: the other body's surface is \
         where its field is 1, and the bulge begins where it is c. The smaller c, the wider the \
         bulge; where the fields fall slowly a wide and high one would coat the other body, which \
         a warning tells. A body can touch many others. With `self` the folds of a body's \
         skeletons touch, which needs `local D` there: what is 3D away along the curves presses \
         in full, and what is nearer than 2D does not.",
    )
    .example(flesh!(
        "body LEFT\n  sphere Flesh 1.2, -0.9 0 0\nclose\nbody RIGHT\n  sphere Flesh 1.2, 0.9 0 0\n\
         close\ncontact LEFT RIGHT"
    ));

fn contact<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    options: &Options<'a>,
    a: Name<'a>,
    b: Name<'a>,
) -> Outcome<Flow> {
    let first = run.model.find_body(&a)?;
    let folds = b.text == "self";
    let bodies = [
        first,
        if folds {
            first
        } else {
            run.model.find_body(&b)?
        },
    ];
    if folds && !run.model.has_local(first) {
        return Err(Problem::new(
            &b.span,
            format!("`{}` has no skeleton whose folds could touch", a.text),
        )
        .hint(
            "write `local 1` in the body's `skeleton`, before \
            its block: within this length it blends",
        ));
    }
    if bodies[0] == bodies[1] && !folds {
        return Err(
            Problem::new(&b.span, format!("`{}` cannot touch itself", b.text))
                .hint("name another body, or write `self` for its folds"),
        );
    }
    let bulge = bulge(options)?;
    let model = &mut run.model;
    let contacts = &mut model.contacts;
    if contacts.len() >= MAX_CONTACTS {
        return Err(Problem::new(
            &command.word_span,
            format!("there are more than {MAX_CONTACTS} contacts"),
        ));
    }
    // Of the same bodies the last one counts.
    let [first, second] = bodies;
    let earlier = contacts
        .iter()
        .position(|c| c.bodies == [first, second] || c.bodies == [second, first]);
    if let Some(index) = earlier {
        contacts.remove(index);
        model.contact_places.remove(index);
    }
    let differs = contacts.iter().any(|c| {
        let shares = c.bodies.iter().any(|body| bodies.contains(body));
        c.bodies[0] != c.bodies[1] && !folds && shares && c.bulge != bulge
    });
    contacts.push(Contact { bodies, bulge });
    model.contact_places.push((run.file, command.span.clone()));
    let (a, b) = (a.text, b.text);
    if earlier.is_some() {
        let message = format_args!("how `{a}` and `{b}` touch is said twice: the last time counts");
        run.warn(&command.span, message, "take one of them out");
    }
    if differs {
        let message = format_args!("`{a}` or `{b}` touches another body with another bulge");
        let hint = "where three bodies meet, different bulges leave a step; write the same for all";
        run.warn(&command.span, message, hint);
    }
    Ok(Flow::Next)
}

/// The bulge that the options say; the default without any.
fn bulge(options: &Options<'_>) -> Outcome<Bulge> {
    let [chosen, others @ ..] = &options.0[..] else {
        return Ok(Bulge::default());
    };
    if let Some(second) = others.first() {
        return Err(Problem::new(&second.span, "a contact has one bulge only")
            .hint("write `fast c`, `height c m h` or `ripple c h n`"));
    }
    let mut span = chosen.span.clone();
    let bulge = if let Some(c) = FAST.of(chosen) {
        Bulge::Fast { c }
    } else if let Some((c, (m, place), h)) = HEIGHT.of(chosen) {
        span = place;
        Bulge::Height { c, m, h }
    } else if let Some((c, h, n)) = RIPPLE.of(chosen) {
        Bulge::Ripple { c, h, n }
    } else {
        Bulge::default()
    };
    if !bulge.is_usable() {
        return Err(
            Problem::new(&span, "the bulge is highest before it begins").hint("m must be above c")
        );
    }
    Ok(bulge)
}
