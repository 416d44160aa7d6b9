//! Sculpting in the page: opens and begins texts of strokes in the sculpting view (crate
//! `modeling`), and carries out its wishes.

pub mod wish;

use crate::page::{Moment, Page};
use crate::panel::Panel;
use crate::scripts::report;
use crate::scripts::request::Request;
use crate::wish::{
    Dialog, FitWish, SculptWish, Setting, TextWish, ViewWish, Wish, Wishes, WorkWish,
};
use crate::{places, theme};
use document::asset::{self, Kind};
use document::examples;
use document::mesh_export::Order;
use document::project_file::Project;
use document::session::Session;
use egui::{Button, Context, RichText, Ui};
use glam::DVec3;
use modeling::{Flesh, Outside, Sculpting};
use rats::{Asset, File, TextEdit, is_strokes};
use scene::Camera;
use wish::Attempt;

/// Shapes to begin with, each of some 20,000 faces: name, and the line of the text.
const SHAPES: [(&str, &str); 5] = [
    ("Ball", "start sphere 50"),
    ("Box", "start box 40"),
    ("Cylinder", "start cylinder 40"),
    ("Tetrahedron", "start tetrahedron 70"),
    ("Plane", "start plane 100"),
];

/// Details of the model's mesh: name, and number of faces.
const DETAILS: [(&str, usize); 3] = [("Coarse", 10_000), ("Medium", 30_000), ("Fine", 100_000)];

/// Camera and lights of a new work.
const STUDIO: &str = "\
# The mesh is made by strokes of tools: Sculpt, above, goes on with it.
framesize 640 480
eyep 3.6 -4.6 2.6
vrp 0 0 0
vup 0 0 1
fov 30
sample 2
background 0.86 0.88 0.9
light White point, position 3 -6 8
light <0.35 0.35 0.42> point, position -6 -3 3
";

/// The name of the first sculpture of a work.
const FIRST: &str = "sculpture.strokes";

/// Returns the mesh file that a text of strokes of the session starts from.
fn start_of(session: &Session, name: &str, text: &str) -> Option<Asset> {
    let wanted = rats::start_file(text)?;
    let mut places = rats::places(name, &wanted).into_iter();
    let all = session.assets().iter();
    places.find_map(|place| all.clone().find(|asset| asset.name == place).cloned())
}

/// Reads the file that strokes start from.
fn load(start: Option<&Asset>, name: &str) -> Result<mesh::TriangleMesh, String> {
    let asset = start.ok_or_else(|| format!("there is no mesh `{name}` in this work"))?;
    let mesh = asset.mesh().map_err(|error| error.to_string())?;
    Ok((*mesh).clone())
}

/// The colour of clay.
const CLAY: &str = "<0.78 0.62 0.5>";

/// Returns the lines that show a sculpture, with a material whose name the text does not have.
fn lines(text: &str, file: &str, diffuse: &str) -> String {
    let name = (1..)
        .map(|n| match n {
            1 => String::from("Clay"),
            n => format!("Clay{n}"),
        })
        .find(|name| !text.contains(name))
        .unwrap_or_default();
    format!("surface {name}, diffuse {diffuse}, specular White, shine 20\nmesh {name} {file}\n")
}

/// Returns the text with other flesh in its `mesh` command for a file; `None` if it has no such
/// command.
fn grow(text: &str, file: &str, flesh: Flesh, edge: f64) -> Option<String> {
    let bare = file.rsplit('/').next().unwrap_or(file);
    let line = text.lines().find(|line| {
        let words = line.split(|c: char| c.is_whitespace() || c == ',');
        let mut words = words.filter(|word| !word.is_empty());
        let is_mesh = words.next() == Some("mesh");
        is_mesh
            && words
                .nth(1)
                .is_some_and(|name| name == file || name == bare)
    })?;
    let old = line.split_whitespace().nth(1)?.trim_end_matches(',');
    // The material of flesh has a name of its own, so that the hard one can be found again.
    let hard = old
        .strip_suffix("Flesh")
        .filter(|name| !name.is_empty())
        .unwrap_or(old);
    let soft = format!("{hard}Flesh");
    let new = match flesh {
        Flesh::Hard => format!("mesh {hard} {file}"),
        Flesh::Metaballs => format!(
            "mesh {hard} {file} metaballs triangular {} {}",
            write_length(0.15 * edge),
            write_length(14.0 / edge.max(1e-9))
        ),
        Flesh::Convolved => {
            let command = format!("mesh {soft} {file}");
            let is_there = text.contains(&format!("surface {soft},"));
            let material = format!(
                "surface {soft}, diffuse Coral, specular White, shine 40, kernel quartic, \
                    blobbiness -2, radius {}\n",
                write_length(0.5 * edge)
            );
            if is_there {
                command
            } else {
                material + &command
            }
        }
    };
    Some(text.replacen(line, &new, 1))
}

/// Writes a length in three digits.
fn write_length(x: f64) -> String {
    let digits = (2.0 - libm::floor(libm::log10(x.max(1e-9)))).clamp(0.0, 9.0) as usize;
    format!("{x:.digits$}")
}

/// Whether the file that a text of strokes starts from is there and not read yet.
fn must_wait(session: &Session, name: &str, text: &str) -> bool {
    start_of(session, name, text).is_some_and(|asset| asset.is_unread())
}

/// The sculpture that is worked on, in place of the editor.
#[derive(Default)]
pub struct SculptPanel {
    open: Option<Box<Sculpting>>,
    /// The text in the editor. The app keeps it up to date.
    pub on_show: Option<usize>,
    /// The text that is opened once the file that it starts from is read.
    next: Option<String>,
}

impl SculptPanel {
    /// Whether the sculpting view is open.
    #[must_use]
    pub fn is_open(&self) -> bool {
        self.open.is_some()
    }

    /// Carries out a wish.
    pub fn act(&mut self, wish: SculptWish, page: &mut Page, at: &Moment<'_>) {
        match wish {
            SculptWish::Show => {
                let files = &page.work.session.project().files;
                let on_show = self.on_show.and_then(|file| files.get(file));
                let on_show = on_show.filter(|file| is_strokes(&file.name));
                let first = files.iter().find(|file| is_strokes(&file.name));
                match on_show.or(first).map(|file| file.name.clone()) {
                    Some(name) => self.open(&name, page),
                    None => page.dialog = Some(Dialog::Sculpt),
                }
            }
            SculptWish::New => page.dialog = Some(Dialog::Sculpt),
            SculptWish::Open(name) => self.open(&name, page),
            SculptWish::Begin { start, is_new } => begin(page, &start, is_new, at.now),
            SculptWish::Model(faces) => {
                page.dialog = None;
                page.tell("The model is being meshed; then you can sculpt it.", at.now);
                let first = Attempt {
                    faces,
                    tolerance: Order::default().tolerance,
                    left: 2,
                    revision: page.work.session.revision(),
                    before: None,
                };
                mesh_model(page, first);
            }
            SculptWish::Mesh(_, attempt) if attempt.revision != page.work.session.revision() => {
                page.warn("The text changed while the model was meshed: choose Sculpt this again.");
            }
            SculptWish::Mesh(result, attempt) => match next(&result, &attempt) {
                Some(next) => mesh_model(page, next),
                None => sculpt_mesh(
                    page,
                    result.or_else(|why| attempt.before.ok_or(why)),
                    at.now,
                ),
            },
            SculptWish::SetStrokes { name, text, mesh } => {
                set_strokes(page, &name, text, mesh.map(|mesh| *mesh), at.now);
            }
            SculptWish::Grow { name, flesh, edge } => {
                grow_flesh(page, &name, flesh, edge, at.now);
            }
            SculptWish::Fit(name) => {
                self.open = None;
                page.wish(FitWish::Show(true));
                page.wish(FitWish::Choose(name));
            }
            SculptWish::Close => self.open = None,
        }
    }

    /// Opens a text of strokes.
    fn open(&mut self, name: &str, page: &mut Page) {
        page.dialog = None;
        self.next = None;
        let session = &page.work.session;
        let mut files = session.project().files.iter();
        let Some(file) = files.find(|file| file.name == name) else {
            return;
        };
        if must_wait(session, name, &file.text) {
            self.next = Some(name.to_owned());
            return;
        }
        let start = start_of(session, name, &file.text);
        match Sculpting::open(name, &file.text, &mut |name| load(start.as_ref(), name)) {
            Ok(mut place) => {
                // The camera that the model is seen by.
                let camera = session.camera();
                place.look_from(camera.eye - camera.target, camera.up);
                page.notice = None;
                self.open = Some(Box::new(place));
            }
            Err(trouble) => page.warn(format!("{name}, {trouble}.")),
        }
    }

    /// Returns the state for scripts.
    #[must_use]
    pub fn report(&self) -> Option<report::Sculpture> {
        self.open.as_ref().map(|place| report::Sculpture {
            name: place.name.clone(),
            counts: place.counts(),
            depth: place.depth(),
        })
    }
}

impl Panel for SculptPanel {
    fn show(&mut self, page: &Page, ui: &mut Ui, wishes: &mut Wishes) {
        let Some(place) = &mut self.open else {
            return;
        };
        let session = &page.work.session;
        let files = &session.project().files;
        let Some(file) = files.iter().find(|file| file.name == place.name) else {
            self.open = None;
            return;
        };
        if place.is_behind(&file.text) && !must_wait(session, &place.name, &file.text) {
            let start = start_of(session, &place.name, &file.text);
            place.sync(&file.text, &mut |name| load(start.as_ref(), name));
        }
        let traced = page.renderer.texture().zip(page.renderer.image());
        let traced = traced.filter(|_| page.is_fresh());
        let outside = Outside {
            now: browser::now(ui.ctx()),
            theme: page.settings.theme,
            pressure: browser::pen_pressure(),
            traced: traced.map(|((texture, _), image)| (texture.id(), image.size)),
            errors: session.errors(),
            depth: [session.can_undo(), session.can_redo()],
        };
        let mut commands = Vec::new();
        modeling::show(place, &outside, ui, &mut commands);
        let name = &place.name;
        wishes.extend(commands.into_iter().map(|command| wish(command, name)));
    }

    fn tick(&mut self, page: &mut Page, _at: &Moment<'_>) {
        let session = &page.work.session;
        let mut files = session.project().files.iter();
        let next = self.next.take_if(|name| {
            let file = files.find(|file| file.name == *name);
            file.is_none_or(|file| !must_wait(session, name, &file.text))
        });
        if let Some(name) = next {
            self.open(&name, page);
        }
    }

    fn forget(&mut self, _page: &mut Page, _ctx: &Context) {
        *self = Self::default();
    }
}

/// Returns the wish that carries out a command of the sculpting view on a text of strokes.
fn wish(command: modeling::Command, name: &str) -> Wish {
    let name = name.to_owned();
    match command {
        modeling::Command::Changed { text, mesh } => {
            let mesh = mesh.map(Box::new);
            SculptWish::SetStrokes { name, text, mesh }.into()
        }
        modeling::Command::Grow { flesh, edge } => SculptWish::Grow { name, flesh, edge }.into(),
        modeling::Command::Fit => SculptWish::Fit(name).into(),
        modeling::Command::Undo => TextWish::Undo.into(),
        modeling::Command::Redo => TextWish::Redo.into(),
        modeling::Command::Close => SculptWish::Close.into(),
        modeling::Command::New => SculptWish::New.into(),
        modeling::Command::SetTheme(choice) => Setting::Theme(choice).into(),
    }
}

/// Begins a sculpture with a line of its text, in a new work or in the open one.
fn begin(page: &mut Page, start: &str, is_new: bool, now: f64) {
    page.dialog = None;
    let files = &page.work.session.project().files;
    let name = (1..)
        .map(|n| match n {
            1 => String::from(FIRST),
            n => format!("sculpture{n}.strokes"),
        })
        .find(|name| is_new || files.iter().all(|file| file.name != *name))
        .unwrap_or_default();
    let strokes = File {
        name: name.clone(),
        text: format!("strokes 1\n{start}\n"),
    };
    let result = if is_new {
        let main = File {
            name: String::from("main.rat"),
            text: format!("{STUDIO}\n{}", lines("", &name, CLAY)),
        };
        let project = Project {
            name: String::from("Sculpture"),
            texts: vec![main, strokes],
            ..Project::default()
        };
        let result = page.work.open_files(project);
        if result.is_ok() {
            browser::set_hash("");
        }
        result
    } else {
        let mut files = files.clone();
        if let Some(main) = files.first_mut() {
            if !main.text.ends_with('\n') {
                main.text.push('\n');
            }
            main.text += &lines(&main.text, &name, CLAY);
        }
        files.push(strokes);
        let result = page.work.session.put_files(files, now);
        result.map_err(|refused| refused.to_string())
    };
    if page.accept(result).is_some() {
        page.wish(SculptWish::Open(name));
    }
}

/// Begins to mesh the model, which is sculpted when the mesh is there.
fn mesh_model(page: &mut Page, attempt: Attempt) {
    let order = Order {
        format: mesh::Format::Ply,
        tolerance: attempt.tolerance,
        // In the model's own units, so that its camera sees the clay.
        size: 0.0,
        union: true,
        ..Order::default()
    };
    let (requests, of) = (page.parts.requests.clone(), page.work.number());
    let taker = Box::new(move |result| {
        requests.ask(Request::Late {
            of,
            what: String::from("The mesh to be sculpted"),
            wish: SculptWish::Mesh(result, attempt).into(),
        });
    });
    page.parts.requests.ask(Request::Mesh(order, taker));
}

/// Returns the attempt that follows one whose mesh has far too many or too few faces; `None` if
/// the mesh will do, or there is no better one.
fn next(result: &Result<Vec<u8>, String>, attempt: &Attempt) -> Option<Attempt> {
    let file = result.as_ref().ok()?;
    let (count, wanted) = (face_count(file)? as f64, attempt.faces as f64);
    let off = count / wanted;
    if attempt.left == 0 || (0.7..1.6).contains(&off) {
        return None;
    }
    // There are about as many faces as the tolerance goes into one; at most half a percent.
    let tolerance = (attempt.tolerance * off).clamp(2e-5, 5e-3);
    (tolerance != attempt.tolerance).then(|| Attempt {
        tolerance,
        left: attempt.left - 1,
        before: Some(file.clone()),
        ..*attempt
    })
}

/// Returns the number of faces that the head of a PLY file tells.
fn face_count(file: &[u8]) -> Option<usize> {
    let head = String::from_utf8_lossy(&file[..file.len().min(1000)]);
    let line = head
        .lines()
        .find_map(|line| line.strip_prefix("element face "));
    line?.trim().parse().ok()
}

/// Returns the lines of a camera, and of two lights beside it.
fn studio_of(camera: &Camera, frame: [u32; 2]) -> String {
    let [width, height] = frame;
    let axes = camera.projection(width, height).world_from_view;
    let far = camera.eye.distance(camera.target).max(f64::MIN_POSITIVE);
    let decimals = libm::floor(4.0 - libm::log10(far)).clamp(0.0, 12.0) as usize;
    let lights = [DVec3::new(-0.2, 0.75, 1.45), DVec3::new(-1.0, 0.5, 0.0)];
    let [key, fill] = lights.map(|way| camera.target + axes * (way * far));
    let [eye, target, key, fill] = [camera.eye, camera.target, key, fill]
        .map(|place| place.to_array().map(|x| short(x, decimals)).join(" "));
    format!(
        "\
# The mesh is made by strokes of tools: Sculpt, above, goes on with it.
framesize {width} {height}
eyep {eye}
vrp {target}
vup {}
fov {}
sample 2
background 0.86 0.88 0.9
light White point, position {key}
light <0.35 0.35 0.42> point, position {fill}
",
        camera
            .up
            .normalize_or(DVec3::Y)
            .to_array()
            .map(|x| short(x, 4))
            .join(" "),
        short(camera.fov, 3),
    )
}

/// Writes a number with so many decimals, or fewer where the last ones are 0.
fn short(x: f64, decimals: usize) -> String {
    let text = format!("{x:.decimals$}");
    let text = match text.split_once('.') {
        Some(_) => text.trim_end_matches('0').trim_end_matches('.'),
        None => &text,
    };
    String::from(if text == "-0" { "0" } else { text })
}

/// Replaces the texts by the mesh of the model, as one undo step, and opens it.
fn sculpt_mesh(page: &mut Page, result: Result<Vec<u8>, String>, now: f64) {
    let session = &mut page.work.session;
    let camera = session.camera();
    let frame = session.scene().map(|scene| scene.settings.frame);
    let studio = studio_of(&camera, frame.unwrap_or([640, 480]));
    let result = result.and_then(|bytes| {
        let asset = document::intake::asset(&session.free_name("model.ply"), bytes)?;
        let strokes = File {
            name: FIRST.to_owned(),
            text: format!("strokes 1\nstart file {}\n", asset.name),
        };
        // If the file has a colour for each vertex, it replaces that of clay.
        let head = &asset.bytes[..asset.bytes.len().min(400)];
        let is_coloured = head.windows(5).any(|word| word == b" red\n");
        let diffuse = if is_coloured { "White" } else { CLAY };
        let main = File {
            name: session.project().files[0].name.clone(),
            text: format!("{studio}\n{}", lines("", FIRST, diffuse)),
        };
        session
            .put_assets(vec![asset])
            .and_then(|()| session.set_files(vec![main, strokes], now))
            .map_err(|refused| refused.to_string())
    });
    if page.accept(result).is_some() {
        // The text has the camera that was looked from.
        page.work.session.set_camera(None);
        page.wish(TextWish::ShowFile(0));
        page.wish(ViewWish::LetGo);
        page.wish(SculptWish::Open(FIRST.to_owned()));
    }
}

/// Takes over the text of a sculpture from the sculpting view, with the mesh that it makes.
fn set_strokes(
    page: &mut Page,
    name: &str,
    text: String,
    mesh: Option<mesh::TriangleMesh>,
    now: f64,
) {
    let session = &mut page.work.session;
    let files = &session.project().files;
    let Some(file) = files.iter().position(|file| file.name == name) else {
        return;
    };
    if let Some(mesh) = mesh {
        let start = start_of(session, name, &text);
        rats::keep_sculpted(&text, start.as_ref(), mesh);
    }
    let result = session.step(TextEdit::whole(file, text), now);
    // If it is refused, the sculpting view goes back to the session's text.
    page.accept(result);
}

/// Gives a sculpture other flesh: changes the `mesh` command of the text that shows it.
fn grow_flesh(page: &mut Page, name: &str, flesh: Flesh, edge: f64, now: f64) {
    let session = &mut page.work.session;
    let files = session.project().files.iter().enumerate();
    let changed = files
        .filter(|(_, file)| !is_strokes(&file.name))
        .find_map(|(index, file)| Some((index, grow(&file.text, name, flesh, edge)?)));
    let Some((index, text)) = changed else {
        page.warn(format!("No text of this work has a line “mesh … {name}”."));
        return;
    };
    session.end_step();
    let result = session.edit(&[TextEdit::whole(index, text)], now);
    session.end_step();
    if page.accept(result).is_some() {
        page.tell("The text has changed; the picture follows.", now);
    }
}

fn heading(ui: &mut Ui, text: &str) {
    let palette = theme::palette(ui.visuals());
    ui.add_space(10.0);
    ui.label(RichText::new(text).size(13.0).color(palette.weak));
}

/// Shows the dialog that asks how to begin.
pub fn ask(page: &Page, ui: &mut Ui, wishes: &mut Wishes) {
    let palette = theme::palette(ui.visuals());
    ui.label(RichText::new("Sculpt").heading().color(palette.strong));
    ui.label(
        "Push, pull, refine and smooth a mesh with virtual tools. What you do is written as a \
            text of strokes, which belongs to the work like any other.",
    );
    let id = egui::Id::unique("sculpt in this work");
    let mut here = ui.data(|data| data.get_temp::<bool>(id)).unwrap_or(false);
    heading(ui, "Begin with");
    ui.horizontal_wrapped(|ui| {
        for (name, start) in SHAPES {
            if choose(ui, name) {
                wishes.push(SculptWish::Begin {
                    start: start.to_owned(),
                    is_new: !here,
                });
            }
        }
    });
    let check = ui.checkbox(&mut here, "Add it to the open work");
    places::note(ui.ctx(), "begin here", check.rect);
    ui.data_mut(|data| data.insert_temp(id, here));
    heading(ui, "This model");
    ui.horizontal_wrapped(|ui| {
        let id = egui::Id::unique("sculpt detail");
        let mut faces = ui.data(|data| data.get_temp(id)).unwrap_or(DETAILS[1].1);
        for (name, count) in DETAILS {
            let tip = format!("About {} faces", document::numerals::count(count as u64));
            let row = ui.selectable_label(faces == count, name).on_hover_text(tip);
            places::note(ui.ctx(), format!("begin {}", name.to_lowercase()), row.rect);
            if row.clicked() {
                faces = count;
            }
        }
        ui.data_mut(|data| data.insert_temp(id, faces));
        let label = Button::new(RichText::new("Sculpt this").size(14.5));
        let button = ui
            .add(label)
            .on_hover_text("The model is meshed first; undo brings its text back");
        places::note(ui.ctx(), "begin this", button.rect);
        if button.clicked() {
            wishes.push(SculptWish::Model(faces));
        }
    });
    let session = &page.work.session;
    let meshes = session.assets().iter();
    let meshes: Vec<&str> = meshes
        .filter(|asset| asset::kind(&asset.name) == Some(Kind::Mesh))
        .map(|asset| asset.name.as_str())
        .collect();
    if !meshes.is_empty() {
        heading(ui, "A mesh of this work");
        ui.horizontal_wrapped(|ui| {
            for name in meshes {
                if choose(ui, name) {
                    wishes.push(SculptWish::Begin {
                        start: format!("start file {name}"),
                        is_new: false,
                    });
                }
            }
        });
    }
    let texts = session.project().files.iter();
    let texts: Vec<&str> = texts
        .map(|file| file.name.as_str())
        .filter(|name| is_strokes(name))
        .collect();
    if !texts.is_empty() {
        heading(ui, "Go on with");
        ui.horizontal_wrapped(|ui| {
            for name in texts {
                if choose(ui, name) {
                    wishes.push(SculptWish::Open(name.to_owned()));
                }
            }
        });
    }
    heading(ui, "An example, stroke by stroke");
    ui.horizontal_wrapped(|ui| {
        for (index, example) in examples::ALL.iter().enumerate() {
            if example.group == document::examples::SCULPTED && choose(ui, example.title) {
                wishes.push(WorkWish::OpenExample(index));
                wishes.push(SculptWish::Show);
            }
        }
    });
    ui.add_space(12.0);
    if choose(ui, "Close") {
        wishes.push(Wish::Close);
    }
}

/// Shows a button of the dialog. Returns whether it was clicked.
fn choose(ui: &mut Ui, name: &str) -> bool {
    let button = ui.add(Button::new(RichText::new(name).size(14.5)));
    places::note(
        ui.ctx(),
        format!("begin {}", name.to_lowercase()),
        button.rect,
    );
    button.clicked()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn compile(main: &str, strokes: &str) -> rats::Compiled {
        let files = [("main.rat", main), ("a.strokes", strokes)];
        rats::compile(&rats::Project {
            files: files
                .map(|(name, text)| File {
                    name: name.into(),
                    text: text.into(),
                })
                .to_vec(),
        })
    }

    #[test]
    fn a_mesh_of_too_few_or_too_many_faces_is_made_anew() {
        fn file(faces: usize) -> Vec<u8> {
            format!("ply\nformat ascii 1.0\nelement face {faces}\nend_header\n").into_bytes()
        }
        fn attempt(left: u32) -> Attempt {
            Attempt {
                faces: 30_000,
                tolerance: 1e-3,
                left,
                revision: 0,
                before: None,
            }
        }
        fn after(faces: usize, left: u32) -> Option<Attempt> {
            next(&Ok(file(faces)), &attempt(left))
        }
        assert_eq!(after(30_000, 2), None);
        assert_eq!(after(3_000, 0), None);
        let finer = after(3_000, 2).unwrap();
        assert!((finer.tolerance - 1e-4).abs() < 1e-12 && finer.left == 1);
        assert_eq!(finer.before, Some(file(3_000)));
        assert!(after(90_000, 1).unwrap().tolerance > 2e-3);
        assert_eq!(next(&Ok(b"none".to_vec()), &attempt(1)), None);
        assert_eq!(next(&Err(String::from("no")), &finer), None);
    }

    #[test]
    fn a_new_work_compiles_cleanly_with_each_shape() {
        for (name, start) in SHAPES {
            let main = format!("{STUDIO}{}", lines("", "a.strokes", CLAY));
            let compiled = compile(&main, &format!("strokes 1\n{start}\n"));
            // A corner of the box may be outside the picture, which is worth a note.
            for diagnostic in &compiled.diagnostics {
                assert_eq!(
                    diagnostic.severity,
                    rats::Severity::Note,
                    "{name}: {diagnostic:?}"
                );
            }
            let faces = compiled.scene.elements.len();
            assert!((19_000..=20_000).contains(&faces), "{name}: {faces}");
        }
        // The studio of a model is seen as the model was.
        let camera = Camera {
            eye: DVec3::new(1.0, 0.25, 30.0),
            target: DVec3::new(0.0, 0.5, -1.0),
            up: DVec3::Z,
            fov: 12.5,
            ..Camera::default()
        };
        let main = studio_of(&camera, [300, 200]) + &lines("", "a.strokes", CLAY);
        let compiled = compile(&main, "strokes 1\nstart sphere 3\n");
        assert_eq!(compiled.diagnostics, []);
        assert_eq!(compiled.scene.camera, camera);
        assert_eq!(compiled.scene.settings.frame, [300, 200]);
        let text = "surface Clay, diffuse Red\nmesh Clay, a.strokes\n";
        let strokes = "strokes 1\nstart sphere 3\n";
        let soft = grow(text, "a.strokes", Flesh::Convolved, 0.4).unwrap();
        assert!(soft.contains("mesh ClayFlesh a.strokes"), "{soft}");
        let diagnostics = compile(&soft, strokes).diagnostics;
        for diagnostic in &diagnostics {
            assert_ne!(diagnostic.severity, rats::Severity::Error, "{diagnostic:?}");
        }
        let balls = grow(&soft, "a.strokes", Flesh::Metaballs, 0.4).unwrap();
        assert!(
            balls.ends_with("mesh Clay a.strokes metaballs triangular 0.0600 35.0\n"),
            "{balls}"
        );
        assert_eq!(compile(&balls, strokes).scene.elements.len(), 1);
        let hard = grow(&balls, "a.strokes", Flesh::Hard, 0.4).unwrap();
        assert!(hard.ends_with("\nmesh Clay a.strokes\n"), "{hard}");
        assert_eq!(grow(text, "b.strokes", Flesh::Hard, 0.4), None);
        assert!(
            lines("surface Clay, diffuse Red\n", "b.strokes", CLAY).starts_with("surface Clay2,")
        );
    }
}
