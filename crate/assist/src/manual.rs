//! The reference page: every command with all that the table says of it, as one HTML document.

use crate::complete::hex;
use crate::grammar::{Grammar, Param};
use crate::{first, swatches};
use rats::commands::{self, CommandSpec, GROUPS, Group, Kind, OptionSpec};
use rats::link::{self, Shared};
use rats::{File, Project, colours, functions, manual};
use std::fmt::Write;

/// The groups by what they are for, in the order in which a newcomer needs them.
pub const TASKS: [(Group, &str); 9] = [
    (Group::Primitives, "Shapes"),
    (Group::Materials, "Materials and textures"),
    (Group::Objects, "Objects"),
    (Group::Scene, "Light and picture"),
    (Group::Camera, "Camera"),
    (Group::Extensions, "Programming and ready-made shapes"),
    (Group::Options, "Settings"),
    (Group::Run, "Running"),
    (Group::Tools, "Pictures and films"),
];

/// Returns the commands of a group.
#[must_use]
pub fn commands_of(group: Group) -> &'static [&'static CommandSpec] {
    let mut groups = GROUPS.iter();
    groups
        .find(|(name, _)| *name == group)
        .map_or(&[], |(_, list)| *list)
}

/// Returns the manual page of a command as plain text; `None` if there is no such command.
///
/// ```
/// let page = assist::manual::page("sphere").unwrap();
/// assert!(page.starts_with("sphere sn r POS [depth d]: "));
/// ```
#[must_use]
pub fn page(command: &str) -> Option<String> {
    commands::find(command).map(manual::page)
}

/// Returns the examples of the reference page that make a picture: the name of the command and the
/// text.
///
/// ```
/// let drawn = assist::manual::examples_with_pictures();
/// assert!(drawn.iter().any(|(name, _)| *name == "sphere"));
/// ```
#[must_use]
pub fn examples_with_pictures() -> Vec<(&'static str, String)> {
    commands::all().filter_map(example_with_picture).collect()
}

/// Returns the texts of which the reference page shows pictures, each with the name of its
/// picture's file without extension.
#[must_use]
pub fn texts_with_pictures() -> Vec<(String, String)> {
    let examples = examples_with_pictures().into_iter();
    let examples = examples.map(|(name, text)| (name.to_owned(), text));
    let swatches = swatches::all().into_iter().map(|s| (s.name, s.text));
    examples.chain(swatches).collect()
}

/// Returns a command's example if it compiles without errors to a scene that is not empty.
fn example_with_picture(spec: &'static CommandSpec) -> Option<(&'static str, String)> {
    let project = project_of(spec);
    let compiled = rats::compile(&project);
    let mut severities = compiled
        .diagnostics
        .iter()
        .map(|diagnostic| diagnostic.severity);
    let is_right = severities.all(|severity| severity != rats::Severity::Error);
    let draws = is_right && !compiled.scene.elements.is_empty();
    draws.then(|| (spec.name, project.files[0].text.clone()))
}

/// Makes a project of a command's example.
fn project_of(spec: &CommandSpec) -> Project {
    Project {
        files: vec![File {
            name: format!("{}-example.rat", spec.name),
            text: format!("{}\n", spec.example),
        }],
    }
}

/// Writes the reference page: an HTML document that needs nothing but the pictures in the folder
/// `reference` beside it. Each command has its name as its anchor.
#[must_use]
pub fn reference() -> String {
    let mut page = String::with_capacity(200_000);
    page += HEAD;
    page += "<nav>\n<p><a href=\"#first\">Your first shape</a></p>\n";
    for (group, title) in TASKS {
        let _ = write!(page, "<p><a href=\"#group-{group:?}\">{title}</a>");
        for spec in commands_of(group) {
            let _ = write!(page, " <a class=\"c\" href=\"#{0}\">{0}</a>", spec.name);
        }
        page += "</p>\n";
    }
    page += "<p><a href=\"#functions\">Functions</a> <a href=\"#textures\">Textures</a> \
        <a href=\"#waves\">Waves</a> <a href=\"#strokes\">Strokes of sculptures</a> \
        <a href=\"#lights\">Light and air</a> <a href=\"#colours\">Colours</a></p>\n</nav>\n";
    first(&mut page);
    page += RULES;
    for (group, title) in TASKS {
        let _ = writeln!(
            page,
            "<h2 id=\"group-{group:?}\">{title}</h2>\n<p>{}</p>",
            about(group)
        );
        for spec in commands_of(group) {
            command(&mut page, spec, group == Group::Extensions);
        }
    }
    functions(&mut page);
    strokes(&mut page);
    swatches::section(&mut page, |swatch| {
        fragment(&swatch.name, swatch.text.clone())
    });
    colours(&mut page);
    page += "</main>\n</html>\n";
    page
}

const HEAD: &str = concat!(
    r#"<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Sinew: the language</title>
<link rel="stylesheet" href="reference.css">
<script type="module" src="reference.js"></script>
<header>
<a href="./">Sinew</a>
<a class="aside" href="figures.html">Figures</a>
<input type="search" id="search" placeholder="Search" "#,
    r#"aria-label="Search commands, options and colours" autocomplete="off">
</header>
<main>
<h1>The language</h1>
<p id="none" hidden>Nothing is called that and nothing tells of it.</p>
<p><a href="neurons.html">Neurons from SWC</a> · <a href="lattices.html">Lattices from 3MF</a> · "#,
    r#"<a href="metaballs.html">From BOSL2 metaballs to Sinew</a></p>
"#
);

const RULES: &str = "<h2>How a text is written</h2>
<p>A text is a list of commands, one in a line, run from top to bottom. <code>#</code> begins a \
comment.
Commas, <code>&lt;</code> and <code>&gt;</code> separate like space does. Operands may go on over \
several
lines inside <code>{ … }</code>.</p>
<p>Commands and options are written in any case, and options may be shortened as long as they stay
unmistakable: <code>diff</code>, <code>rad</code>, <code>blob</code>. Names of your own keep their \
case.</p>
<p>In what follows, an operand in CAPITALS is three numbers, a vector or a colour; what stands in
<code>[ ]</code> may be left out; <code>…</code> means that more of the kind may follow. Wherever \
a number
stands there can be arithmetic: <code>2*r + sin(a)</code>. In a list, <code>1 -2</code> is two \
operands
and <code>1 - 2</code> is one.</p>
<p><span class=\"ours\">ours</span> marks what RATS did not have.</p>
";

/// Writes the steps to the first shape.
fn first(page: &mut String) {
    *page += "<h2 id=\"first\">Your first shape</h2>\n\
        <p>Five steps. <a href=\"./#first\">Take them in Sinew</a>, \
        which writes along.</p>\n<ol>\n";
    for step in first::STEPS {
        let (title, words) = (step.title, step.words);
        let _ = write!(page, "<li><b>{title}.</b> {words}");
        if !step.code.is_empty() {
            let _ = write!(page, "\n<pre>{}</pre>", escape(step.code.trim_end()));
        }
        *page += "</li>\n";
    }
    let text = first::STEPS.iter().map(|step| step.code);
    let text: String = core::iter::once(first::START).chain(text).collect();
    *page += "</ol>\n";
    if let Some(link) = fragment("my-first-shape", text) {
        let _ = writeln!(page, "<p><a href=\"./#{link}\">Open the whole text</a></p>");
    }
}

/// Describes a group.
fn about(group: Group) -> &'static str {
    match group {
        Group::Run => "Running texts, variables, help.",
        Group::Camera => "From where the picture is taken.",
        Group::Materials => "What shapes are made of.",
        Group::Primitives => {
            "Shapes. The name of their material comes first, but not in a chain. Shapes of a \
             material that has a blobbiness are soft: they are skeletons, and their flesh melts \
             together."
        }
        Group::Objects => "Groups of shapes, and moving them.",
        Group::Options => "Settings of the whole picture.",
        Group::Scene => "Lights, the background, the picture.",
        Group::Tools => "Pictures and films.",
        Group::Extensions => {
            "What RATS did not have: loops, choices, commands of your own, and more."
        }
    }
}

fn command(page: &mut String, spec: &'static CommandSpec, is_ours: bool) {
    let idle = spec.idle();
    let class = if idle.is_some() {
        " class=\"idle\""
    } else {
        ""
    };
    let _ = writeln!(
        page,
        "<section id=\"{}\"{class}>\n<h3><code>{}</code>{}</h3>\n<p>{}.</p>",
        spec.name,
        escape(&spec.synopsis()),
        if is_ours {
            " <span class=\"ours\">ours</span>"
        } else {
            ""
        },
        sentence(spec.meaning)
    );
    if let Some(reason) = idle {
        let _ = writeln!(page, "<p>Changes nothing here: {}.</p>", escape(reason));
    }
    if !spec.details.is_empty() {
        let _ = writeln!(page, "<p>{}</p>", mark(spec.details));
    }
    if !spec.default.is_empty() {
        let _ = writeln!(page, "<p>By default {}.</p>", escape(spec.default));
    }
    let grammar = Grammar::of(spec);
    if !grammar.parameters.is_empty() {
        page.push_str("<table>\n");
        for parameter in &grammar.parameters {
            row(page, parameter);
        }
        page.push_str("</table>\n");
    }
    for parameter in &grammar.parameters {
        if let Kind::Word(words) = parameter.kind {
            options(page, words, parameter.meaning);
        }
    }
    if !spec.options.is_empty() {
        options(page, spec.options, "options");
        for option in spec.options {
            for parameter in option.parameters {
                if let Kind::Word(words) = parameter.kind {
                    options(page, words, &format!("after `{}`", option.name));
                }
            }
        }
    }
    if !spec.example.is_empty() {
        let link = link_to(spec);
        page.push_str("<div class=\"example\">\n");
        let _ = writeln!(page, "<pre>{}</pre>", escape(spec.example));
        if example_with_picture(spec).is_some() {
            let picture = format!(
                "<img src=\"reference/{}.png\" width=\"240\" height=\"180\" \
                 loading=\"lazy\" alt=\"What the example of {} draws\">",
                spec.name, spec.name
            );
            let _ = match &link {
                Some(link) => writeln!(page, "<a href=\"./#{link}\">{picture}</a>"),
                None => writeln!(page, "{picture}"),
            };
        }
        page.push_str("</div>\n");
        if let Some(link) = link {
            let _ = writeln!(page, "<p><a href=\"./#{link}\">Try it</a></p>");
        }
    }
    page.push_str("</section>\n");
}

/// Describes texts of strokes.
fn strokes(page: &mut String) {
    *page += "<h2 id=\"strokes\">Strokes of sculptures</h2>\n\
        <p>A file whose name ends in <code>.strokes</code> makes a mesh, which the command \
        <a href=\"#mesh\"><code>mesh</code></a> shows. Sculpt, in Sinew, writes a line for each \
        stroke; written by hand they do the same. From the same lines comes the same mesh, bit for \
        bit.</p>\n<table>\n";
    for (word, form) in [
        ("TOOL", sculpt::TOOL),
        ("DECAY", sculpt::DECAY),
        ("PATH", sculpt::PATH),
    ] {
        let form = escape(form);
        let _ = writeln!(page, "<tr><td>{word}</td><td><code>{form}</code></td></tr>");
    }
    *page += "</table>\n\
        <p>A tool has three semi-axes, two exponents (1 is round, small is square) and turns about \
        the axes, in degrees. Motions fade over neighbours by a decay function, within its \
        range.</p>\n";
    for command in sculpt::COMMANDS {
        let forms = command.forms.iter().map(|form| escape(form));
        let forms = forms.collect::<Vec<_>>().join("</code><br><code>");
        let (name, meaning) = (command.name, sentence(command.meaning));
        let _ = writeln!(
            page,
            "<section id=\"strokes-{name}\">\n<h3><code>{forms}</code></h3>\n<p>{meaning}.</p>"
        );
        if !command.details.is_empty() {
            let _ = writeln!(page, "<p>{}</p>", mark(command.details));
        }
        page.push_str("</section>\n");
    }
}

/// Returns the fragment that opens a command's example in the page.
fn link_to(spec: &CommandSpec) -> Option<String> {
    encode(project_of(spec))
}

/// Returns the fragment that opens a text in the page.
fn fragment(name: &str, text: String) -> Option<String> {
    let name = format!("{name}.rat");
    encode(Project {
        files: vec![File { name, text }],
    })
}

/// Returns the fragment that opens a project in the page.
fn encode(project: Project) -> Option<String> {
    let shared = Shared {
        project,
        camera: None,
    };
    link::encode(&shared).ok()
}

fn row(page: &mut String, parameter: &Param<'_>) {
    let mut more = Vec::new();
    let range = parameter.range();
    for part in [parameter.unit.word(), &range] {
        if !part.is_empty() {
            more.push(escape(part));
        }
    }
    let _ = writeln!(
        page,
        "<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>",
        escape(&parameter.synopsis()),
        mark(parameter.meaning),
        more.join(", "),
        default(parameter.default)
    );
}

fn options(page: &mut String, list: &'static [OptionSpec], title: &str) {
    let _ = writeln!(
        page,
        "<table>\n<tr><th colspan=\"3\">{}</th></tr>",
        sentence(title)
    );
    for option in list {
        let _ = writeln!(
            page,
            "<tr><td>{}</td><td>{}{}</td><td>{}</td></tr>",
            escape(&option.synopsis()),
            mark(option.meaning),
            units(option),
            default(option.default)
        );
    }
    page.push_str("</table>\n");
}

/// Writes the units and ranges of an option's operands.
fn units(option: &OptionSpec) -> String {
    let mut text = String::new();
    for parameter in option.parameters {
        let range = parameter.range();
        let parts = [parameter.unit.word(), range.as_str()];
        let parts: Vec<_> = parts.into_iter().filter(|part| !part.is_empty()).collect();
        if !parts.is_empty() {
            let name = escape(&parameter.synopsis());
            let _ = write!(
                text,
                "<br><code>{name}</code>: {}",
                escape(&parts.join(", "))
            );
        }
    }
    text
}

fn default(default: &str) -> String {
    if default.is_empty() {
        String::new()
    } else {
        format!("by default {}", escape(default))
    }
}

fn functions(page: &mut String) {
    page.push_str("<h2 id=\"functions\">Functions</h2>\n<p>Angles are in radians.</p>\n<table>\n");
    for function in functions::FUNCTIONS {
        let (form, meaning) = function
            .meaning
            .split_once(": ")
            .unwrap_or(("", function.meaning));
        let _ = writeln!(
            page,
            "<tr><td>{}</td><td>{}</td></tr>",
            escape(form),
            mark(meaning)
        );
    }
    page.push_str("<tr><td>pi</td><td>3.14159…</td></tr>\n</table>\n");
}

fn colours(page: &mut String) {
    page.push_str(
        "<h2 id=\"colours\">Colours</h2>\n<p>Also <code>Gray0</code> \
        (black) to <code>Gray100</code> (white).</p>\n<div class=\"colours\">\n",
    );
    for name in colours::names() {
        let code = colours::find(name).map(hex).unwrap_or_default();
        let _ = writeln!(
            page,
            "<span><i style=\"background:{code}\"></i> {name}</span>"
        );
    }
    page.push_str("</div>\n");
}

/// Writes a meaning with a capital letter first.
fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(|c| c.to_uppercase().collect::<String>());
    mark(&(first.unwrap_or_default() + letters.as_str()))
}

/// Writes text for HTML, with `code` and the mark of our own extensions.
fn mark(text: &str) -> String {
    let mut out = String::new();
    for (index, part) in text.split('`').enumerate() {
        let part = escape(part);
        if index % 2 == 1 {
            let _ = write!(out, "<code>{part}</code>");
        } else {
            out += &part;
        }
    }
    out.replace(" (ours)", " <span class=\"ours\">ours</span>")
}

/// Escapes text for HTML.
fn escape(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}
