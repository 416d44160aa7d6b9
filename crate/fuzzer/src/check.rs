//! Properties of all texts and all links.

use assist::{format, highlight};
use rats::link::{self, Shared};
use rats::{Compiled, File, Project, Severity, compile};
use scene::Origin;

/// Elements of the largest scene that is looked through for numbers that are none, which takes
/// long.
const LOOKED_THROUGH: usize = 5000;

/// A project of two files; the second is there to be read.
pub fn project(text: &str, other: &str) -> Project {
    let files = [("main.rat", text), ("other.rat", other)].map(|(name, text)| File {
        name: name.to_owned(),
        text: text.to_owned(),
    });
    Project {
        files: files.into(),
    }
}

/// Checks what a text was compiled to.
///
/// # Errors
/// Says what does not hold.
pub fn result(project: &Project, compiled: &Compiled) -> Result<(), String> {
    let text = |file: usize| project.files.get(file).map(|file| file.text.as_str());
    if compiled.diagnostics.len() > rats::limits::MAX_DIAGNOSTICS {
        return Err(format!("{} messages", compiled.diagnostics.len()));
    }
    for message in &compiled.diagnostics {
        // Messages may be about a file of the library as well.
        let own = project.files.iter().find(|file| file.name == message.file);
        let known = own
            .map(|file| file.text.as_str())
            .or_else(|| rats::library::find(&message.file));
        let Some(text) = known else {
            return Err(format!("a message about no file: {message:?}"));
        };
        let said = !message.message.is_empty() && message.line >= 1 && message.column >= 1;
        if !said || text.get(message.span.clone()).is_none() {
            return Err(format!("a message without a place or a word: {message:?}"));
        }
    }
    for hot in &compiled.hot {
        let place = hot.literal.clone();
        if place.is_some_and(|range| text(hot.file).is_none_or(|text| text.get(range).is_none())) {
            return Err(format!("a slider outside its text: {hot:?}"));
        }
    }
    let scene = &compiled.scene;
    if scene.finishes.is_empty() {
        return Err(String::from("a scene without a material"));
    }
    if scene.elements.len() > rats::limits::MAX_ELEMENTS {
        return Err(format!("{} elements", scene.elements.len()));
    }
    let lost = scene
        .elements
        .iter()
        .find(|element| element.finish as usize >= scene.finishes.len());
    if let Some(element) = lost {
        return Err(format!("an element of no material: {element:?}"));
    }
    if scene.elements.len() <= LOOKED_THROUGH
        && let Some(place) = not_a_number(&format!("{scene:?}"))
    {
        return Err(format!("a number that is none: {place}"));
    }
    Ok(())
}

/// Finds `NaN` or `inf` outside quotes in what `Debug` prints of plain data.
fn not_a_number(printed: &str) -> Option<&str> {
    let mut quoted = false;
    let mut escaped = false;
    for (index, c) in printed.char_indices() {
        match c {
            '"' if !escaped => quoted = !quoted,
            'N' | 'i' if !quoted => {
                let rest = &printed[index..];
                let before = printed[..index].chars().next_back();
                let begins = before.is_some_and(|c| !c.is_alphanumeric() && c != '_');
                let is_none = ["NaN", "inf"].into_iter().any(|word| {
                    rest.strip_prefix(word)
                        .is_some_and(|rest| rest.starts_with([',', ')', ']', ' ', '}']))
                });
                if begins && is_none {
                    let start = printed.floor_char_boundary(index.saturating_sub(120));
                    let end = printed.floor_char_boundary(index + 20);
                    return Some(&printed[start..end]);
                }
            }
            _ => {}
        }
        escaped = c == '\\' && !escaped;
    }
    None
}

/// Checks what needs no run: colouring and the names of files.
///
/// # Errors
/// Says what does not hold.
pub fn unrun(text: &str) -> Result<(), String> {
    let mut end = 0;
    for (range, _) in highlight::highlight(text) {
        if range.start < end || range.start >= range.end || text.get(range.clone()).is_none() {
            return Err(format!("coloured {range:?} after {end}"));
        }
        end = range.end;
    }
    let _ = rats::reads(text);
    Ok(())
}

/// A text that is compiled twice must mean the same.
///
/// # Errors
/// Says that it does not.
pub fn repeats(project: &Project, first: &Compiled) -> Result<(), String> {
    if compile(project) == *first {
        Ok(())
    } else {
        Err(String::from(
            "compiled again, the text means something else",
        ))
    }
}

/// A text that is laid out must mean the same, and be left alone when it is laid out again.
///
/// # Errors
/// Says what does not hold.
pub fn layout(project: &Project, first: &Compiled) -> Result<(), String> {
    let mut project = project.clone();
    for file in &mut project.files {
        let once = format(&file.text);
        if format(&once) != once {
            return Err(format!("laid out again, {} changes", file.name));
        }
        file.text = once;
    }
    let again = compile(&project);
    // Places move, also those in hints.
    let scenes = [&again, first].map(|compiled| {
        let mut scene = scene::Scene::clone(&compiled.scene);
        let moments = scene
            .moments
            .iter_mut()
            .flat_map(|moment| &mut moment.elements);
        for element in scene.elements.iter_mut().chain(moments) {
            element.origin = Origin::default();
        }
        scene
    });
    let messages = [&again, first].map(|compiled| {
        let messages = compiled.diagnostics.iter();
        let messages = messages.map(|message| (message.severity, message.message.clone()));
        messages.collect::<Vec<_>>()
    });
    let sliders = [&again, first].map(|compiled| {
        let hot = compiled.hot.iter();
        hot.map(|hot| (hot.name.clone(), hot.value.clone()))
            .collect::<Vec<_>>()
    });
    let differs = if scenes[0] != scenes[1] {
        "another scene"
    } else if sliders[0] != sliders[1] {
        "other sliders"
    } else if messages[0] != messages[1] {
        "other messages"
    } else if again.tools != first.tools || again.output != first.output {
        "other work"
    } else {
        return Ok(());
    };
    Err(format!("laid out, the text gives {differs}"))
}

/// Answers about a place, which may lie between the bytes of a letter or behind the end, must be
/// answered; and a name that is changed everywhere changes nothing else.
///
/// # Errors
/// Says what does not hold.
pub fn help(project: &Project, first: &Compiled, byte: usize) -> Result<(), String> {
    let _ = assist::complete(project, 0, byte);
    let _ = assist::hover(project, 0, byte);
    let _ = assist::signature(project, 0, byte);
    let _ = assist::folds(&project.files[0].text);
    let definition = assist::definition(project, 0, byte);
    for place in assist::references(project, 0, byte)
        .iter()
        .chain(&definition)
    {
        let text = project.files.get(place.file).map(|file| file.text.as_str());
        if text.is_some_and(|text| text.get(place.span.clone()).is_none()) {
            return Err(format!("a reference outside its text: {place:?}"));
        }
    }
    // With mistakes nobody knows what a name means.
    if has_errors(first) {
        return Ok(());
    }
    let Ok(edits) = assist::rename(project, 0, byte, "another_name") else {
        return Ok(());
    };
    let again = compile(&project.apply(&edits));
    if has_errors(&again) {
        return Err(String::from("renamed, the text has mistakes"));
    }
    let shapes = [&again, first].map(|compiled| {
        let elements = compiled.scene.elements.iter();
        let shapes = elements.map(|element| (element.shape.clone(), element.finish, element.body));
        shapes.collect::<Vec<_>>()
    });
    if shapes[0] != shapes[1] {
        return Err(String::from("renamed, the text gives another scene"));
    }
    Ok(())
}

/// Opens a link, and what opens must survive being sent on.
///
/// # Errors
/// Says what does not hold.
pub fn link(fragment: &str) -> Result<(), String> {
    let Ok(shared) = link::decode(fragment) else {
        return Ok(());
    };
    match link::encode(&shared).map(|again| link::decode(&again)) {
        Ok(Ok(again)) if again == shared => Ok(()),
        // The compressor may be worse than the one that made the link, so that it becomes too long.
        Err(link::LinkError::TooLong | link::LinkError::TooLarge) => Ok(()),
        other => Err(format!("a link that cannot be sent on: {other:?}")),
    }
}

/// Opens the content of a link: JSON that was not packed by us.
///
/// # Errors
/// Fails as [`link`] does.
pub fn link_content(json: &[u8]) -> Result<(), String> {
    use base64::Engine;
    let mut bytes = vec![1];
    bytes.extend(miniz_oxide::deflate::compress_to_vec(json, 1));
    link(&base64::engine::general_purpose::URL_SAFE_NO_PAD.encode(bytes))
}

/// A project becomes a link and comes back.
///
/// # Errors
/// Says that it does not.
pub fn sharing(project: &Project) -> Result<(), String> {
    let shared = Shared {
        project: project.clone(),
        camera: None,
    };
    let Ok(fragment) = link::encode(&shared) else {
        return Ok(());
    };
    if link::decode(&fragment) == Ok(shared) {
        Ok(())
    } else {
        Err(String::from("a link that brings something else"))
    }
}

fn has_errors(compiled: &Compiled) -> bool {
    let mut messages = compiled.diagnostics.iter();
    messages.any(|message| message.severity == Severity::Error)
}
