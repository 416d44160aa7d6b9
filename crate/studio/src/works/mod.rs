//! Whole works: the gallery, opening, naming, deleting, saving and sharing them, and files that
//! arrive from outside.

mod arrivals;
pub mod gallery;
pub mod versions;
pub mod wish;

use crate::first;
use crate::page::{self, Moment, Page, Tab};
use crate::scripts::request::Request;
use crate::stage::pencil::tool::Tool;
use crate::wish::{Notice, TextWish, ViewWish, WorkWish};
use document::asset;
use document::project_file::{self, Project};
use document::work::Origin;
use document::{examples, share, work};
use gallery::Gallery;

impl Gallery {
    /// Carries out a wish.
    pub fn act(&mut self, wish: WorkWish, page: &mut Page, at: &Moment<'_>) {
        match wish {
            WorkWish::OpenExample(index) => {
                self.asked = Some(index);
                let example = examples::ALL.get(index).filter(|e| e.files.is_empty());
                match example.and_then(|example| example.text) {
                    Some(text) => {
                        let result = page.work.open_example(index, text, Vec::new());
                        show_example(page, index, result);
                    }
                    None => arrivals::fetch_example(page, index),
                }
            }
            // Another one was asked for since.
            WorkWish::OpenFetched { index, .. } if self.asked != Some(index) => {}
            WorkWish::OpenFetched {
                index,
                text: Some(text),
                assets,
            } => {
                let result = page.work.open_example(index, &text, assets);
                show_example(page, index, result);
            }
            WorkWish::OpenFetched { text: None, .. } => {
                page.dialog = None;
                page.warn(
                    "This example could not be loaded. Check the connection and try again; \
                        your work stays open.",
                );
            }
            WorkWish::OpenSaved(id) => {
                let (of, requests) = (page.work.number(), page.parts.requests.clone());
                browser::fetch_work(&id.clone(), move || {
                    requests.ask(Request::Late {
                        of,
                        what: String::from("The work"),
                        wish: WorkWish::OpenFetchedWork(id).into(),
                    });
                });
            }
            WorkWish::OpenFetchedWork(id) => {
                let result = page.work.open_saved(&id);
                show_opened(page, result);
            }
            WorkWish::TakeOver => {
                if let Some(id) = page.work.own_id() {
                    browser::take_work_over(&id);
                }
            }
            WorkWish::Copy => {
                let result = page.work.copy(at.now);
                if page.accept(result).is_some() {
                    page.tell(format!("This is “{}” now.", page.work.name), at.now);
                }
            }
            WorkWish::BringBack(index) => {
                let versions = page.parts.shelf.borrow().versions().all().to_vec();
                if let Some(version) = versions.into_iter().nth(index) {
                    let files = version.project.files;
                    let result = page.work.session.set_files(files, at.now);
                    if page.accept(result).is_some() {
                        page.dialog = None;
                        let notice = Notice::success("This version is back.", at.now);
                        page.notice = Some(notice.with_button("Undo", TextWish::Undo));
                    }
                }
            }
            WorkWish::OpenText { name, text } => {
                let result = page.work.open_text(&name, text, Origin::Example);
                show_opened(page, result);
            }
            WorkWish::New => {
                let text = String::from(examples::BLANK);
                let result = page.work.open_text("Untitled", text, Origin::Fresh);
                show_opened(page, result);
            }
            WorkWish::First => {
                let text = String::from(first::TEXT);
                let result = page.work.open_text("My first shape", text, Origin::Fresh);
                page.first = Some((page.work.number(), 0));
                page.tab = Tab::Text;
                show_opened(page, result);
            }
            WorkWish::Step(step) => page.first = step,
            WorkWish::DrawNew => {
                let text = sketch::page::fresh(page::ratio(at.ctx));
                let result = page.work.open_text("Drawing", text, Origin::Fresh);
                show_opened(page, result);
                page.wish(ViewWish::SetTool(Some(Tool::Draw)));
            }
            WorkWish::GoBack => {
                if let Some(id) = page.work.before().map(str::to_owned) {
                    page.wish(WorkWish::OpenSaved(id));
                }
            }
            WorkWish::Rename(name) => page.work.rename(name, at.now),
            WorkWish::Delete(id) => {
                let shelf = &page.parts.shelf;
                shelf.borrow_mut().delete(&id);
                self.refresh(shelf.borrow().entries());
            }
            WorkWish::Enable => {
                page.notice = None;
                page.work.session.enable();
            }
            WorkWish::Save => save(page, at.now),
            WorkWish::Share => share(page, at),
            WorkWish::PickFiles => {
                let of = page.work.number();
                browser::pick_files(page.parts.requests.taker(of));
            }
            WorkWish::Take { files, show } => arrivals::take_in(page, files, show, at),
        }
    }

    /// Reads the list of saved works anew, before the gallery is shown.
    pub fn open(&mut self, page: &mut Page) {
        let result = page.work.flush();
        page.accept(result);
        self.refresh(page.parts.shelf.borrow().entries());
        self.focus();
    }
}

/// Shows a work that was opened, or why it could not be.
fn show_opened(page: &mut Page, result: Result<(), String>) {
    if result.is_ok() {
        page.leave_lesson();
        browser::set_hash("");
    } else {
        page.dialog = None;
    }
    page.accept(result);
}

/// Shows an example that was opened, at first as it was drawn before if its picture takes long.
fn show_example(page: &mut Page, index: usize, result: Result<(), String>) {
    if result.is_ok() && examples::ALL[index].is_slow() {
        page.wish(ViewWish::ShowKept(examples::ALL[index].thumbnail));
    }
    show_opened(page, result);
}

/// Writes all texts, images and meshes to one file.
fn save(page: &mut Page, now: f64) {
    let session = &page.work.session;
    let packed = project_file::pack(&Project {
        name: page.work.name.clone(),
        texts: session.project().files.clone(),
        assets: session.assets().to_vec(),
        camera: session.user_camera(),
    });
    if let Some(bytes) = page.accept(packed) {
        let name = format!("{}.zip", work::file_stem(&page.work.name));
        browser::download(&name, "application/zip", &bytes);
        let size = asset::size(bytes.len());
        page.tell(format!("Saved {name}, {size}. Open it here to go on."), now);
    }
}

/// Copies a link to the work, and puts it into the address bar.
fn share(page: &mut Page, at: &Moment<'_>) {
    let session = &page.work.session;
    let link = share::link(&browser::page(), session.project(), session.user_camera());
    let carries = if session.assets().is_empty() {
        "It carries the text and the view."
    } else {
        "It carries the texts and the view, not the images and meshes."
    };
    if let Some(link) = page.accept(link) {
        if let Some((_, fragment)) = link.split_once('#') {
            browser::set_hash(&format!("#{fragment}"));
        }
        let size = share::size(&link);
        at.ctx.copy_text(link);
        page.tell(format!("Link copied ({size}). {carries}"), at.now);
    }
}
