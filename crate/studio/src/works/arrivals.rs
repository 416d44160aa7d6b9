//! Taking in files that were dropped on the page or opened: as new tabs if a work of the user's is
//! open, else as a new work.

use crate::page::{Moment, Page};
use crate::scripts::request::Request;
use crate::wish::{FitWish, LabWish, Notice, TextWish, Wish, WorkWish};
use browser;
use document::asset::Asset;
use document::examples;
use document::intake::{self, Incoming, Sorted};
use document::project_file::{self, Project};
use document::work::Origin;
use std::cell::RefCell;
use std::rc::Rc;

/// Fetches the text, the images and the meshes of an example, which is opened when all are here.
/// An image or a mesh that does not come becomes an error of the text.
pub(super) fn fetch_example(page: &Page, index: usize) {
    let Some(example) = examples::ALL.get(index) else {
        return;
    };
    let text = example.text.is_none().then_some(&example.path);
    let paths = text.into_iter().chain(example.files);
    let own = example.text.map(str::to_owned);
    let of = page.work.number();
    let inbox = Rc::new(RefCell::new((paths.clone().count(), own, Vec::new())));
    for path in paths {
        let (inbox, requests) = (inbox.clone(), page.parts.requests.clone());
        browser::fetch(path, move |bytes| {
            let (missing, text, assets) = &mut *inbox.borrow_mut();
            *missing -= 1;
            if *path == example.path {
                *text = bytes.and_then(|bytes| String::from_utf8(bytes).ok());
            } else {
                let name = path.rsplit('/').next().unwrap_or(path).to_owned();
                assets.extend(bytes.map(|bytes| Asset::await_mesh(name, bytes)));
            }
            if *missing == 0 {
                let (text, assets) = (text.take(), std::mem::take(assets));
                let wish = WorkWish::OpenFetched {
                    index,
                    text,
                    assets,
                };
                requests.ask(Request::Late {
                    of,
                    what: format!("The example {}", example.title),
                    wish: wish.into(),
                });
            }
        });
    }
}

/// Makes texts into tabs or a new work, and puts images and meshes beside them.
pub(super) fn take_in(page: &mut Page, taken: Vec<Incoming>, show: bool, at: &Moment<'_>) {
    let (projects, taken): (Vec<_>, Vec<_>) = taken
        .into_iter()
        .partition(|file| intake::is_project(&file.name));
    at.ctx.request_repaint();
    if let Some(project) = projects.into_iter().next() {
        // Other files that were dropped with it would mix with its own.
        take_project(page, project, at.now);
        return;
    }
    let Sorted {
        texts,
        assets,
        measured,
        refused,
    } = intake::sort(taken);
    let text_names = texts.iter().map(|file| file.name.clone());
    let asset_names = assets.iter().map(|asset| asset.name.clone());
    let all = list_names(&text_names.chain(asset_names).collect::<Vec<_>>());
    if !measured.is_empty() || !all.is_empty() {
        page.leave_lesson();
        page.wish(LabWish::Follow(None));
    }
    for (name, bytes) in measured {
        page.wish(FitWish::Take { name, bytes });
    }
    let is_own = page.work.origin == Origin::Own;
    let mut texts = texts;
    let drawn = intake::write_text(&assets).filter(|_| texts.is_empty() && !is_own);
    let is_drawn = drawn.is_some();
    texts.extend(drawn);
    let outcome = if all.is_empty() {
        Ok(String::new())
    } else if texts.is_empty() || page.work.origin == Origin::Own {
        add(page, texts, assets, show, at.now).map(|replaced| {
            if replaced.is_empty() {
                format!("Added {all}.")
            } else {
                format!("Added {all}; Undo brings back {}.", list_names(&replaced))
            }
        })
    } else {
        let project = Project {
            texts,
            assets,
            ..Project::default()
        };
        page.work.open_files(project).map(|()| {
            browser::set_hash("");
            format!("Opened {all} as a new work.")
        })
    };
    if is_drawn && outcome.is_ok() {
        page.to_frame = Some(page.work.number());
    }
    page.wishes.extend(report(outcome, &refused, at.now));
}

/// Opens an archive of a whole work as a new one, or adds its images and meshes to the open one if
/// it has no texts.
fn take_project(page: &mut Page, file: Incoming, now: f64) {
    let unpacked = file
        .bytes
        .and_then(|bytes| project_file::unpack(&bytes).map_err(|why| format!("it {why}")));
    let (mut project, refused) = match unpacked {
        Ok(unpacked) => unpacked,
        Err(reason) => {
            let refused = [format!("{}: {reason}.", file.name)];
            page.wishes.extend(report(Ok(String::new()), &refused, now));
            return;
        }
    };
    let names = project.assets.iter().map(|asset| asset.name.clone());
    let names = list_names(&names.collect::<Vec<_>>());
    let outcome = if project.texts.is_empty() {
        let added = add(page, Vec::new(), project.assets, true, now);
        added.map(|_| format!("Added {names}."))
    } else {
        if project.name.is_empty() {
            let name = file.name.rsplit(['/', '\\']).next().unwrap_or_default();
            project.name = name.strip_suffix(".zip").unwrap_or(name).to_owned();
        }
        page.work.open_files(project).map(|()| {
            browser::set_hash("");
            format!("Opened {} as a new work.", page.work.name)
        })
    };
    page.wishes.extend(report(outcome, &refused, now));
}

/// Returns a notice of what became of files, and of those that were refused; `None` if there is
/// nothing to say.
fn report(outcome: Result<String, String>, refused: &[String], now: f64) -> Option<Wish> {
    let mut sentences = Vec::new();
    let bad = outcome.is_err() || !refused.is_empty();
    match outcome {
        Ok(done) => sentences.extend((!done.is_empty()).then_some(done)),
        Err(trouble) => sentences.push(trouble),
    }
    let (few, more) = refused.split_at(refused.len().min(3));
    if !refused.is_empty() {
        sentences.push(format!("Not taken: {}", few.join(" ")));
    }
    if !more.is_empty() {
        sentences.push(format!("And {} more.", more.len()));
    }
    let text = sentences.join(" ");
    let notice = match (text.is_empty(), bad) {
        (true, _) => return None,
        (false, true) => Notice::trouble(text),
        (false, false) => Notice::success(text, now),
    };
    Some(notice.into())
}

/// Adds files to the open work, and with `show` shows the first text or the last asset. Returns the
/// names of texts that were replaced.
fn add(
    page: &mut Page,
    texts: Vec<rats::File>,
    assets: Vec<Asset>,
    show: bool,
    now: f64,
) -> Result<Vec<String>, String> {
    let session = &mut page.work.session;
    let first = texts.first().map(|file| file.name.clone());
    let replaced = session
        .project()
        .files
        .iter()
        .filter(|old| {
            texts
                .iter()
                .any(|new| new.name == old.name && new.text != old.text)
        })
        .map(|old| old.name.clone())
        .collect();
    let shown = assets.last().map(|asset| asset.name.clone());
    session
        .put_files(texts, now)
        .and_then(|()| session.put_assets(assets))
        .map_err(|refused| refused.to_string())?;
    let files = &session.project().files;
    let file = first.and_then(|name| files.iter().position(|file| file.name == name));
    match (file, shown) {
        (Some(file), _) if show => page.wish(TextWish::ShowFile(file)),
        (None, Some(name)) if show => page.wish(TextWish::ShowAsset(name)),
        _ => {}
    }
    Ok(replaced)
}

/// Returns names as a part of a sentence: up to three in full, of more the first and a count.
fn list_names(names: &[String]) -> String {
    match names {
        [] => String::new(),
        [one] => one.clone(),
        [first, .., last] if names.len() <= 3 => {
            let between = &names[1..names.len() - 1];
            let start = [std::slice::from_ref(first), between].concat().join(", ");
            format!("{start} and {last}")
        }
        [first, ..] => format!("{first} and {} more files", names.len() - 1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_make_a_sentence() {
        let names = ["a", "b", "c", "d"].map(String::from);
        assert_eq!(list_names(&names[..1]), "a");
        assert_eq!(list_names(&names[..2]), "a and b");
        assert_eq!(list_names(&names[..3]), "a, b and c");
        assert_eq!(list_names(&names), "a and 3 more files");
    }
}
