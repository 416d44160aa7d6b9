//! The texts, images and meshes of the work: their tabs, the editor, the view of an image or a
//! mesh, and every change of a text.

pub mod asset_view;
pub mod code;
pub mod editor;
pub mod files;
pub mod keyboard;
pub mod marks;
pub mod wish;

use crate::page::{Moment, Page, Tab};
use crate::panel::Panel;
use crate::places;
use crate::wish::{Notice, TextWish, ViewWish, Wishes};
use asset_view::AssetView;
use editor::Editor;
use egui::{Context, Ui};

/// The panel of the texts, images and meshes.
#[derive(Default)]
pub struct TextPanel {
    /// The editor, also of the choice of what is on show.
    pub editor: Editor,
    asset_view: AssetView,
}

impl TextPanel {
    /// Returns the index of the text on show; `None` while an image or a mesh is.
    #[must_use]
    pub fn file_on_show(&self) -> Option<usize> {
        self.editor.asset.is_none().then_some(self.editor.file)
    }

    /// Carries out a wish.
    pub fn act(&mut self, wish: TextWish, page: &mut Page, at: &Moment<'_>) {
        let (session, now) = (&mut page.work.session, at.now);
        match wish {
            TextWish::Edit { edits, step } => {
                let result = if step {
                    session.end_step();
                    let result = session.edit(&edits, now);
                    session.end_step();
                    result
                } else {
                    session.edit(&edits, now)
                };
                if page.accept(result).is_none() {
                    self.editor.resync(at.ctx);
                }
            }
            TextWish::AddFile => {
                let result = session.add_file(now);
                if let Some(file) = page.accept(result) {
                    self.editor.jump(file, 0..0);
                }
            }
            TextWish::RenameFile(file, name) => {
                let result = session.rename_file(file, &name, now);
                page.accept(result);
            }
            TextWish::RemoveFile(file) => session.remove_file(file, now),
            TextWish::ShowFile(file) => self.editor.open(file),
            TextWish::PutAsset(asset) => {
                let result = session.put_assets(vec![asset]);
                page.notice = None;
                page.accept(result);
            }
            TextWish::RemoveAsset(name) => {
                if let Some(asset) = session.remove_asset(&name) {
                    let notice = Notice::success(format!("Removed {name}."), now);
                    let put_back = TextWish::PutAsset(asset);
                    page.notice = Some(notice.with_button("Put it back", put_back));
                }
            }
            TextWish::ShowAsset(name) => self.editor.asset = Some(name),
            TextWish::Hold => {
                session.hold();
                page.wish(ViewWish::Follow);
            }
            TextWish::Release => session.release(),
            TextWish::Find(seek) => {
                page.tab = Tab::Text;
                self.editor.seek(seek);
            }
            TextWish::Undo => {
                let place = session.undo();
                self.show_change(place);
            }
            TextWish::Redo => {
                let place = session.redo();
                self.show_change(place);
            }
            TextWish::Jump { file, range } => {
                page.tab = Tab::Text;
                self.editor.jump(file, range);
            }
            TextWish::ShowPlace { file, byte } => self.editor.show_place(file, byte),
        }
    }

    /// Shows where undoing or redoing changed the text.
    fn show_change(&mut self, place: Option<(usize, usize)>) {
        if let Some((file, byte)) = place {
            self.editor.show_place(file, byte);
        }
    }
}

impl Panel for TextPanel {
    /// Shows the editor, or the image or mesh whose tab is open.
    fn show(&mut self, page: &Page, ui: &mut Ui, wishes: &mut Wishes) {
        let session = &page.work.session;
        let shown = self.editor.asset.as_ref();
        let mut assets = session.assets().iter();
        if let Some(asset) = shown.and_then(|name| assets.find(|asset| asset.name == *name)) {
            if self.asset_view.show(ui, asset, wishes) {
                self.editor.asset = None;
            }
            return;
        }
        self.editor.asset = None;
        places::note(ui.ctx(), "editor", ui.available_rect_before_wrap());
        if page.is_short_of_time() {
            ui.visuals_mut().text_cursor.blink = false;
        }
        self.editor.show(ui, session, page.settings.hints, wishes);
    }

    fn forget(&mut self, _page: &mut Page, ctx: &Context) {
        self.editor.reset(ctx);
    }
}
