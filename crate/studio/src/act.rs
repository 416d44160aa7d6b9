//! Carrying out the user's commands.

use crate::app::{App, Dialog, Tab};
use crate::command::Command;
use crate::intake::Incoming;
use crate::notice::Notice;
use crate::pencil::{Pencil, page, tool::Tool};
use crate::project_file::{self, Project};
use crate::tray::item::Item;
use crate::{asset, examples, picture, platform, share, work};
use egui::{Context, Key, KeyboardShortcut, Modifiers};
use lab::Lesson;
use rats::TextEdit;
use std::ops::Range;

impl App {
    pub(crate) fn keys(&self, ctx: &Context, commands: &mut Vec<Command>) {
        let pressed = |modifiers: Modifiers, key: Key| {
            ctx.input_mut(|input| input.consume_shortcut(&KeyboardShortcut::new(modifiers, key)))
        };
        if self.sculpts() && self.dialog.is_none() {
            // Sculpting has keys of its own.
            return;
        }
        if self.lab.is_open() {
            // The text is out of sight, so no key may change it.
            if pressed(Modifiers::NONE, Key::Escape) {
                commands.push(Command::CloseLab);
            }
            return;
        }
        // The longer combination first: the shorter one matches it too.
        if pressed(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z)
            || pressed(Modifiers::COMMAND, Key::Y)
        {
            commands.push(Command::Redo);
        } else if pressed(Modifiers::COMMAND, Key::Z) {
            commands.push(Command::Undo);
        }
        if pressed(Modifiers::COMMAND, Key::S) {
            commands.push(Command::SavePng);
        }
        if self.dialog.is_some() && pressed(Modifiers::NONE, Key::Escape) {
            commands.push(Command::Close);
        }
        let types = ctx.egui_wants_keyboard_input();
        if self.dialog.is_none() && !types && pressed(Modifiers::NONE, Key::D) {
            let tool = match self.pencil.tool() {
                None => Some(Tool::Draw),
                Some(_) => None,
            };
            commands.push(Command::SetTool(tool));
        }
    }

    /// Carries out a command of the user.
    pub(crate) fn carry_out(&mut self, ctx: &Context, command: Command, now: f64) {
        let session = &mut self.work.session;
        match command {
            Command::Edit { edits, step } => self.edit(ctx, &edits, step, now),
            Command::Tell(text) => self.notice = Some(Notice::success(text, now)),
            Command::SetHints(hints) => self.settings.hints = hints,
            Command::AddFile => {
                let result = session.add_file(now);
                let result = result.map(|file| self.editor.jump(file, 0..0));
                self.warn_if_refused(result);
            }
            Command::RenameFile(file, name) => {
                let result = session.rename_file(file, &name, now);
                self.warn_if_refused(result);
            }
            Command::RemoveFile(file) => session.remove_file(file, now),
            Command::PickFiles => platform::pick_files(&self.parts.requests),
            Command::PutAsset(asset) => {
                let result = session.put_assets(vec![asset]);
                self.notice = None;
                self.warn_if_refused(result);
            }
            Command::RemoveAsset(name) => self.remove_asset(&name, now),
            Command::Hold => {
                session.hold();
                self.live.want();
            }
            Command::Release => session.release(),
            Command::Undo => {
                let place = session.undo();
                self.show_change(place);
            }
            Command::Redo => {
                let place = session.redo();
                self.show_change(place);
            }
            Command::Jump { file, range } => self.jump(file, range),
            Command::ShowPlace { file, byte } => self.editor.show_place(file, byte),
            Command::SetCamera(_)
            | Command::ShowAll
            | Command::Cancel
            | Command::Again
            | Command::SetShow(_)
            | Command::SetSize(_)
            | Command::SetTheme(_)
            | Command::Play
            | Command::SetFilmFrame(_)
            | Command::SetFilmLength(_)
            | Command::SetFilmRate(_)
            | Command::SetPlayback(_)
            | Command::SaveFilm(_)
            | Command::StopFilm => self.carry_out_on_picture(ctx, command, now),
            Command::ShowResult(_)
            | Command::SaveResult(_)
            | Command::KeepResult(_)
            | Command::FindResult(_)
            | Command::FoldTray(_) => self.carry_out_in_tray(ctx, command, now),
            Command::SavePng => self.save_png(now),
            Command::ShowMesh => self.dialog = Some(Dialog::Mesh),
            Command::SaveMesh => self.save_mesh(now),
            Command::SaveProject => self.save_project(now),
            Command::Share => self.share(ctx, now),
            Command::OpenExample(_)
            | Command::OpenSaved(_)
            | Command::OpenText { .. }
            | Command::New
            | Command::DrawNew
            | Command::GoBack
            | Command::Rename(_)
            | Command::Delete(_) => self.carry_out_on_works(ctx, command, now),
            Command::OpenLab(_) | Command::ShowLab | Command::CloseLab | Command::ShareLab => {
                self.carry_out_in_lab(ctx, command, now);
            }
            Command::ShowSculpt => self.show_sculpt(),
            Command::SculptModel => self.sculpt_model(now),
            Command::NewSculpture => self.dialog = Some(Dialog::Sculpt),
            Command::OpenSculpture(name) => self.open_sculpture(&name),
            Command::BeginSculpture { start, is_new } => {
                self.begin_sculpture(ctx, &start, is_new, now);
            }
            Command::SetStrokes { name, text, mesh } => {
                self.set_strokes(&name, text, mesh.map(|mesh| *mesh), now);
            }
            Command::GrowFlesh { name, flesh, edge } => self.grow_flesh(&name, flesh, edge, now),
            Command::CloseSculpt => self.close_sculpt(),
            Command::SetTool(tool) => self.take_tool(ctx, tool, now),
            Command::Enable => {
                self.notice = None;
                session.enable();
            }
            Command::FitSculpture(name) => self.fit_sculpture(&name),
            Command::ShowFit(open) => {
                self.fitting.open = open;
                self.tab = if open { Tab::Fit } else { Tab::Text };
            }
            Command::StartFit => self.fitting.start(session, now),
            Command::StopFit => {
                self.fitting.stop(session, now);
                session.compile();
            }
            Command::ShowGallery => self.show_gallery(),
            Command::ShowHelp => {
                self.help.turn_to_words();
                self.dialog = Some(Dialog::Help);
            }
            Command::ShowManual(name) => {
                self.help.turn_to(&name);
                self.dialog = Some(Dialog::Help);
            }
            Command::Close => {
                if self.dialog.take().is_none() {
                    self.notice = None;
                }
            }
        }
    }

    /// Commands about the view, the picture and the film. Others do nothing.
    fn carry_out_on_picture(&mut self, ctx: &Context, command: Command, now: f64) {
        let session = &mut self.work.session;
        match command {
            Command::SetCamera(camera) => {
                session.set_camera(camera);
                self.settings.turned = true;
                if camera.is_some() {
                    self.live.want();
                }
            }
            Command::ShowAll => {
                if let Some(scene) = session.scene() {
                    let camera = preview::orbit::frame(scene, session.camera(), session.frame());
                    session.set_camera(Some(camera));
                }
            }
            Command::Cancel => self.renderer.cancel(),
            Command::Again => self.renderer.again(now),
            Command::SetShow(show) => self.settings.show = show,
            Command::SetSize(size) => {
                self.settings.size = size;
                self.forced_size = None;
            }
            Command::SetTheme(theme) => {
                self.settings.theme = theme;
                ctx.set_theme(theme);
            }
            Command::Play => self.play(now),
            Command::SetFilmFrame(frame) => {
                self.player.pause();
                session.set_film_frame(frame);
            }
            Command::SetFilmLength(count) => {
                self.player.count = count;
                self.player.chosen = true;
            }
            Command::SetFilmRate(rate) => {
                self.player.rate = rate;
                self.player.chosen = true;
            }
            Command::SetPlayback(playback) => self.player.playback = playback,
            Command::SaveFilm(kind) => self.begin_film(ctx, kind, now),
            Command::StopFilm => self.stop_film("You stopped it."),
            _ => {}
        }
    }

    /// Commands about the lab. Others do nothing.
    fn carry_out_in_lab(&mut self, ctx: &Context, command: Command, now: f64) {
        match command {
            Command::OpenLab(lesson) => self.open_lab(lesson),
            Command::ShowLab => self.open_lab(self.lab.lesson()),
            Command::CloseLab => {
                platform::push_hash(self.lab.came_from());
                self.lab.close();
            }
            Command::ShareLab => {
                let text = "Link to this lesson copied.";
                ctx.copy_text(format!("{}{}", platform::page(), self.lab.lesson().hash()));
                self.lab.say(text, now);
            }
            _ => {}
        }
    }

    /// Commands about the results of the text's jobs on pictures. Others do nothing.
    fn carry_out_in_tray(&mut self, ctx: &Context, command: Command, now: f64) {
        match command {
            Command::ShowResult(index) => {
                self.tray.open(index);
                self.dialog = Some(Dialog::Result);
            }
            Command::SaveResult(index) => self.save_result(index, now),
            Command::KeepResult(index) => self.keep_result(ctx, index, now),
            Command::FindResult(index) => {
                if let Some((file, range)) = self.tray.place_of(index, &self.work.session) {
                    self.dialog = None;
                    self.editor.asset = None;
                    self.jump(file, range);
                }
            }
            Command::FoldTray(folded) => self.tray.folded = folded,
            _ => {}
        }
    }

    /// Commands that open, name or delete works. Others do nothing.
    fn carry_out_on_works(&mut self, ctx: &Context, command: Command, now: f64) {
        match command {
            Command::OpenExample(index) => {
                let example = examples::ALL.get(index).filter(|e| e.files.is_empty());
                match example.and_then(|example| example.text) {
                    Some(text) => {
                        let result = self.work.open_example(index, text, Vec::new());
                        self.show_opened(ctx, result);
                    }
                    None => self.fetch_example(index),
                }
            }
            Command::OpenSaved(id) => {
                let result = self.work.open_saved(&id);
                self.show_opened(ctx, result);
            }
            Command::OpenText { name, text } => {
                let result = self.work.open_text(&name, text);
                self.show_opened(ctx, result);
            }
            Command::New => {
                let result = self.work.open_new();
                self.show_opened(ctx, result);
            }
            Command::DrawNew => {
                let text = page::fresh(self.ratio(ctx));
                let result = self.work.open_page(text);
                self.show_opened(ctx, result);
                self.pencil.take(Some(Tool::Draw));
            }
            Command::GoBack => {
                if let Some(id) = self.work.before().map(str::to_owned) {
                    platform::set_hash("");
                    let result = self.work.open_saved(&id);
                    self.show_opened(ctx, result);
                }
            }
            Command::Rename(name) => self.work.rename(name, now),
            Command::Delete(id) => {
                self.parts.shelf.borrow_mut().delete(&id);
                self.gallery.refresh(self.parts.shelf.borrow().entries());
            }
            _ => {}
        }
    }

    /// Takes a drawing tool in hand, or lays it down. Drawing begins on an empty page if the open
    /// one is an example or a link without a skeleton.
    fn take_tool(&mut self, ctx: &Context, tool: Option<Tool>, now: f64) {
        let begins = tool.is_some() && self.pencil.tool().is_none();
        self.pencil.take(tool);
        self.hands.let_go();
        if !begins || !self.work.session.is_compiled() {
            return;
        }
        let session = &mut self.work.session;
        let is_one = session.project().files.len() == 1 && session.assets().is_empty();
        if is_one && page::is_empty(session.text(0)) {
            session.set_camera(None);
            let text = page::fresh(self.ratio(ctx));
            self.carry_out(ctx, Command::step(TextEdit::whole(0, text)), now);
        } else if matches!(self.work.origin, work::Origin::Example | work::Origin::Link)
            && !Pencil::has_skeleton(session)
        {
            self.carry_out(ctx, Command::DrawNew, now);
        }
    }

    /// Returns height by width of the picture to draw on: on an upright page it fills the space
    /// between the bars.
    fn ratio(&self, ctx: &Context) -> f64 {
        let size = ctx.content_rect().size();
        if size.y <= size.x {
            return 0.75;
        }
        let bars = if crate::screen::is_narrow(ctx) {
            150.0
        } else {
            300.0
        };
        f64::from((size.y - bars).max(1.0) / size.x.max(1.0))
    }

    /// Shows a notice if an edit was refused.
    fn warn_if_refused<T>(&mut self, result: Result<T, impl ToString>) {
        if let Err(refused) = result {
            self.notice = Some(Notice::trouble(refused.to_string()));
        }
    }

    fn edit(&mut self, ctx: &Context, edits: &[TextEdit], step: bool, now: f64) {
        let session = &mut self.work.session;
        if step {
            session.end_step();
        }
        let result = session.edit(edits, now);
        if step {
            session.end_step();
        }
        if result.is_err() {
            self.editor.resync(ctx);
        }
        self.warn_if_refused(result);
    }

    fn remove_asset(&mut self, name: &str, now: f64) {
        if let Some(asset) = self.work.session.remove_asset(name) {
            let text = format!("Removed {name}.");
            let put_back = Command::PutAsset(asset);
            self.notice = Some(Notice::success(text, now).with_button("Put it back", put_back));
        }
    }

    /// Shows where undoing or redoing changed the text.
    fn show_change(&mut self, place: Option<(usize, usize)>) {
        if let Some((file, byte)) = place {
            self.editor.show_place(file, byte);
        }
    }

    fn jump(&mut self, file: usize, range: Range<usize>) {
        self.tab = Tab::Text;
        self.editor.jump(file, range);
    }

    fn show_gallery(&mut self) {
        if let Err(trouble) = self.work.flush() {
            self.notice = Some(Notice::trouble(trouble));
        }
        self.gallery.refresh(self.parts.shelf.borrow().entries());
        self.dialog = Some(Dialog::Gallery);
    }

    fn open_lab(&mut self, lesson: Lesson) {
        self.lab.open(lesson, &platform::hash());
        platform::push_hash(&lesson.hash());
    }

    /// Shows a work that was opened, or why it could not be.
    pub(crate) fn show_opened(&mut self, ctx: &Context, result: Result<(), String>) {
        match result {
            Ok(()) => {
                if self.lab.is_open() {
                    // So that the way back leads to the lesson.
                    platform::push_hash("");
                }
                platform::set_hash("");
                self.reset_panels(ctx);
            }
            Err(trouble) => {
                self.dialog = None;
                self.notice = Some(Notice::trouble(trouble));
            }
        }
    }

    fn save_png(&mut self, now: f64) {
        let Some(image) = self.renderer.image() else {
            self.notice = Some(Notice::trouble("There is no picture to save yet."));
            return;
        };
        match picture::png(image) {
            Ok(bytes) => {
                let name = format!("{}.png", work::file_stem(&self.work.name));
                platform::download(&name, "image/png", &bytes);
                let [width, height] = image.size;
                let text = format!("Saved {name}, {width} × {height} pixels.");
                self.notice = Some(Notice::success(text, now));
            }
            Err(error) => self.notice = Some(Notice::trouble(error.to_string())),
        }
    }

    /// Writes all texts, images and meshes to one file.
    fn save_project(&mut self, now: f64) {
        let session = &self.work.session;
        let packed = project_file::pack(&Project {
            name: self.work.name.clone(),
            texts: session.project().files.clone(),
            assets: session.assets().to_vec(),
            camera: session.user_camera(),
        });
        self.notice = Some(match packed {
            Ok(bytes) => {
                let name = format!("{}.zip", work::file_stem(&self.work.name));
                platform::download(&name, "application/zip", &bytes);
                let size = asset::size(bytes.len());
                Notice::success(format!("Saved {name}, {size}. Open it here to go on."), now)
            }
            Err(trouble) => Notice::trouble(trouble),
        });
    }

    /// Writes the mesh on show to files.
    fn save_mesh(&mut self, now: f64) {
        let files = self.mesh_export.files();
        for file in files {
            platform::download(&file.name, "application/octet-stream", &file.bytes);
        }
        let names: Vec<&str> = files.iter().map(|file| file.name.as_str()).collect();
        if !names.is_empty() {
            let text = format!("Saved {}.", names.join(" and "));
            self.notice = Some(Notice::success(text, now));
        }
    }

    fn save_result(&mut self, index: usize, now: f64) {
        let items = self.tray.items();
        if let Some(film) = items.get(index).and_then(Item::film) {
            // The browser makes a file of the last part of the name.
            let name = film.name.rsplit(['/', '\\']).next().unwrap_or_default();
            platform::download(name, film.mime(), &film.bytes);
            self.notice = Some(Notice::success(
                format!("Saved {name}, {}.", film.facts()),
                now,
            ));
        }
    }

    /// Adds a result to the work's images, like a file that is dropped on the page; the text stays
    /// in view.
    fn keep_result(&mut self, ctx: &Context, index: usize, now: f64) {
        let items = self.tray.items();
        if let Some(film) = items.get(index).and_then(Item::film) {
            // A free name: an image of the work is not replaced.
            let taken = Incoming {
                name: self.work.session.free_name(&film.name),
                bytes: Ok(film.bytes.to_vec()),
            };
            let open = self.editor.asset.take();
            self.take_in(ctx, vec![taken], now);
            self.editor.asset = open;
        }
    }

    fn share(&mut self, ctx: &Context, now: f64) {
        let session = &self.work.session;
        match share::link(&platform::page(), session.project(), session.user_camera()) {
            Ok(link) => {
                if let Some((_, fragment)) = link.split_once('#') {
                    platform::set_hash(&format!("#{fragment}"));
                }
                let size = share::size(&link);
                let carries = if session.assets().is_empty() {
                    "It carries the text and the view."
                } else {
                    "It carries the texts and the view, not the images and meshes."
                };
                let text = format!("Link copied ({size}). {carries}");
                ctx.copy_text(link);
                self.notice = Some(Notice::success(text, now));
            }
            Err(trouble) => self.notice = Some(Notice::trouble(trouble)),
        }
    }
}
