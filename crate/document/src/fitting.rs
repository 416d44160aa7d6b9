//! Fitting a mesh of the work to measured points and outlines, in a tools worker.
//!
//! The result is text: the fit writes the `deform` command of the mesh, again and again while it
//! runs, all as one undo step. Measured files are kept here, not in the work, until the page is
//! closed.

use crate::session::Session;
use field::Skeleton;
use fit::{Kind, Observations, Options};
use glam::DVec3;
use pool::{Ticket, Tools};
use rats::{Deform, TextEdit};
use scene::{Form, Origin, Shape};
use serde::Serialize;
use std::ops::Range;
use tools::{Controls, FitMesh, FitStep, ReadMeasured};

/// Most measured files that are kept.
pub const MOST_FILES: usize = 8;
/// Seconds between changes of the text, for small meshes and for those of more than [`LARGE`]
/// triangles.
const INTERVALS: [f64; 2] = [0.25, 3.0];
/// Triangles above which a mesh is large.
const LARGE: usize = 8000;
/// Most points that are drawn over the picture.
const MOST_POINTS: usize = 2500;

/// A measured file.
pub struct Measured {
    /// The file's name.
    pub name: String,
    /// The points or lines of sight, once they are read.
    pub found: Option<Observations>,
    reading: Ticket<Observations>,
}

impl Measured {
    /// Returns the content in a few words.
    #[must_use]
    pub fn words(&self) -> String {
        match &self.found {
            None => String::from("reading …"),
            Some(found) if found.points.is_empty() => {
                format!("{} lines of sight", found.sights.len())
            }
            Some(found) => format!("{} points", found.points.len()),
        }
    }
}

/// A mesh that can be fitted.
#[derive(Clone, Debug, PartialEq)]
pub enum Target {
    /// The mesh of a `deform`, by its index in the compiled text's list.
    Deform(usize),
    /// The mesh of a `mesh` command, which gets an automatic cage.
    Mesh(Origin),
}

/// The surface that is brought onto the measured points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Surface {
    /// The facets themselves.
    Explicit,
    /// The implicit surface of balls around facets.
    Spherical,
    /// The implicit surface of thin shells around facets.
    #[default]
    Triangular,
}

/// Settings by the user.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// The surface that is fitted.
    pub surface: Surface,
    /// Decimal logarithm of the smoothness's weight.
    pub smooth: f64,
    /// Weight of outlines.
    pub outlines: f64,
    /// Control points of an automatic cage.
    pub count: u32,
    /// Whether the mesh is turned and moved first.
    pub align: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            surface: Surface::default(),
            smooth: -1.7,
            outlines: 1.0,
            count: 60,
            align: false,
        }
    }
}

/// A fit that runs.
struct Run {
    ticket: Ticket<FitStep>,
    file: usize,
    /// Byte at which its text begins.
    start: usize,
    /// The text as it was written last.
    text: String,
    /// Line feed before a text that is added.
    lead: &'static str,
    /// Blanks before each line.
    indent: String,
    /// The name of the object, with a space before it.
    name: String,
    /// The last step, until it is written.
    waiting: Option<FitStep>,
    /// Time of the last change of the text, seconds.
    written: f64,
    /// Seconds between changes.
    interval: f64,
    /// Whether the text was changed, so that the undo step is open.
    is_held: bool,
    /// Whether the worker has finished.
    done: bool,
}

/// The panel's state and the fit that runs.
pub struct Fitting {
    tools: Tools,
    /// Whether the panel is shown.
    pub open: bool,
    /// Measured files.
    pub files: Vec<Measured>,
    /// Settings by the user.
    pub settings: Settings,
    /// The mesh that was chosen.
    pub target: Option<Target>,
    /// The meshes in the text that can be fitted, with a label each.
    pub targets: Vec<(Target, String)>,
    /// The revision of the text that they are from, and whether it was compiled.
    targets_of: Option<(u64, bool)>,
    /// Residuals of the iterations of the last fit.
    pub residuals: Vec<f64>,
    /// The last iteration.
    pub last: Option<FitStep>,
    /// A message, and whether it is an error.
    pub message: Option<(String, bool)>,
    run: Option<Run>,
}

/// The state for scripts.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Report {
    /// Whether it runs.
    pub running: bool,
    /// Iterations that were written into the text.
    pub iteration: u32,
    /// Residual after the last iteration.
    pub residual: f64,
    /// Measured points that are read.
    pub points: usize,
    /// The message in the panel.
    pub said: Option<String>,
}

impl Fitting {
    /// Makes a panel that is hidden and fits nothing.
    #[must_use]
    pub fn new(tools: Tools) -> Self {
        Self {
            tools,
            open: false,
            files: Vec::new(),
            settings: Settings::default(),
            target: None,
            targets: Vec::new(),
            targets_of: None,
            residuals: Vec::new(),
            last: None,
            message: None,
            run: None,
        }
    }

    /// Ends the fit, when another work was opened; the measured files stay.
    pub fn forget(&mut self) {
        self.run = None;
        self.target = None;
        self.targets_of = None;
        self.residuals.clear();
        (self.last, self.message) = (None, None);
    }

    /// Whether there is something to fit, so that the panel is offered.
    #[must_use]
    pub fn is_offered(&self) -> bool {
        self.open || !self.targets.is_empty()
    }

    /// Whether a fit runs.
    #[must_use]
    pub fn is_running(&self) -> bool {
        self.run.is_some()
    }

    /// Reads a measured file and shows the panel.
    pub fn add(&mut self, name: String, bytes: Vec<u8>) {
        self.open = true;
        self.message = None;
        self.forget_left_out();
        self.files.retain(|file| file.name != name);
        if self.files.len() >= MOST_FILES {
            self.files.remove(0);
        }
        let reading = self.tools.submit(ReadMeasured {
            name: name.clone(),
            bytes,
        });
        self.files.push(Measured {
            name,
            found: None,
            reading,
        });
    }

    /// Removes a measured file.
    pub fn remove(&mut self, index: usize) {
        if index < self.files.len() {
            self.forget_left_out();
            self.files.remove(index);
        }
    }

    /// Whether a measured file is being read.
    #[must_use]
    pub fn is_reading(&self) -> bool {
        self.files.iter().any(|file| file.found.is_none())
    }

    /// Whether there is anything to fit to.
    #[must_use]
    pub fn has_data(&self) -> bool {
        self.files.iter().any(|file| file.found.is_some())
    }

    /// Whether outlines are among the data.
    #[must_use]
    pub fn has_outlines(&self) -> bool {
        let mut found = self.files.iter().filter_map(|file| file.found.as_ref());
        found.any(|found| !found.sights.is_empty())
    }

    /// Returns points to draw over the picture, at most [`MOST_POINTS`], and whether the fit that
    /// has ended left them out.
    #[must_use]
    pub fn points(&self) -> Vec<(DVec3, bool)> {
        let found = self.files.iter().filter_map(|file| file.found.as_ref());
        let all = found.flat_map(|found| found.points.iter().copied());
        let step = all.clone().count().div_ceil(MOST_POINTS).max(1);
        let left_out = self.outliers();
        let numbered = all.zip(0..).step_by(step);
        numbered
            .map(|(point, i)| (point, left_out.binary_search(&i).is_ok()))
            .collect()
    }

    /// The numbers of the points that the fit that has ended left out.
    #[must_use]
    pub fn outliers(&self) -> &[u32] {
        self.last.as_ref().map_or(&[], |last| &last.left_out)
    }

    /// Forgets which points were left out, as there are others now.
    fn forget_left_out(&mut self) {
        if let Some(last) = &mut self.last {
            last.left_out.clear();
        }
    }

    /// Returns the meshes in the text that can be fitted, with a label each.
    #[must_use]
    pub fn targets(session: &Session) -> Vec<(Target, String)> {
        let compiled = session.compilation();
        let files = session.project().files.len();
        let line = |origin: Origin| {
            let text = session.text(origin.file as usize);
            let before = text.get(..origin.start as usize).unwrap_or_default();
            before.matches('\n').count() + 1
        };
        let mut targets = Vec::new();
        for (index, deform) in compiled.deforms.iter().enumerate() {
            if !deform.repeated && (deform.origin.file as usize) < files {
                let count = deform.controls.len();
                let at = line(deform.origin);
                let label = format!("deform in line {at}, {count} control points");
                targets.push((Target::Deform(index), label));
            }
        }
        let mut seen: Vec<Origin> = Vec::new();
        let elements = compiled.scene.elements.iter().zip(&compiled.placements);
        for (element, placement) in elements {
            let origin = element.origin;
            // The triangles of a mesh are always repeated, as their command makes many. The
            // compiler says when the fit begins whether the command itself is.
            let is_mesh = match &element.shape {
                Shape::Bone(bone) => matches!(bone.skeleton, Skeleton::Triangle { .. }),
                Shape::Function(function) => {
                    matches!(function.form, Form::Mesh(_)) && !placement.repeated
                }
                _ => false,
            };
            if !is_mesh || origin.file as usize >= files || seen.last() == Some(&origin) {
                continue;
            }
            if seen.contains(&origin) || compiled.deforms.iter().any(|d| d.of.contains(&origin)) {
                continue;
            }
            let text = session.text(origin.file as usize);
            let command = text.get(origin.start as usize..origin.end as usize);
            let mut words = command.unwrap_or_default().split_whitespace();
            if words.next().is_some_and(|w| w.eq_ignore_ascii_case("mesh")) {
                seen.push(origin);
                let name = words.nth(1).unwrap_or_default();
                let name = name.trim_end_matches([',', ';']);
                let label = format!("mesh {name} in line {}, a new cage", line(origin));
                targets.push((Target::Mesh(origin), label));
            }
        }
        targets
    }

    /// Chooses the mesh of a file: its `mesh` command, or its deformation if there is one.
    pub fn choose(&mut self, session: &Session, file: &str) {
        let bare = file.rsplit('/').next().unwrap_or(file);
        let shows = |origin: Origin| {
            let text = session.text(origin.file as usize);
            let command = text.get(origin.start as usize..origin.end as usize);
            let mut words = command.unwrap_or_default().split_whitespace();
            let name = words.nth(2).map(|name| name.trim_end_matches([',', ';']));
            name.is_some_and(|name| name == file || name == bare)
        };
        let found = Self::targets(session)
            .into_iter()
            .find(|(target, _)| match target {
                Target::Deform(index) => {
                    let deforms = &session.compilation().deforms;
                    deforms[*index].of.iter().any(|origin| shows(*origin))
                }
                Target::Mesh(origin) => shows(*origin),
            });
        if let Some((target, _)) = found {
            self.target = Some(target);
        }
    }

    /// Begins the fit of the chosen mesh, or says why it cannot.
    pub fn start(&mut self, session: &Session, now: f64) {
        self.run = None;
        self.residuals.clear();
        (self.last, self.message) = (None, None);
        if let Err(trouble) = self.try_start(session, now) {
            self.message = Some((trouble, true));
        }
    }

    fn try_start(&mut self, session: &Session, now: f64) -> Result<(), String> {
        if !session.is_compiled() || session.errors() > 0 {
            return Err(String::from("The text has errors; fix them first."));
        }
        let targets = Self::targets(session);
        let chosen = targets
            .iter()
            .map(|(target, _)| target)
            .find(|target| Some(*target) == self.target.as_ref())
            .or(targets.first().map(|(target, _)| target))
            .ok_or_else(|| {
                String::from(if session.compilation().deforms.is_empty() {
                    "There is no mesh in the text: open one and write a `mesh` command."
                } else {
                    "The mesh is deformed in a loop or a defined command, \
                        whose numbers apply to more than one mesh."
                })
            })?;
        let mut observations = Observations::default();
        for found in self.files.iter().filter_map(|file| file.found.as_ref()) {
            observations.points.extend(&found.points);
            observations.sights.extend(&found.sights);
        }
        if observations == Observations::default() {
            return Err(String::from(
                "There are no measured points: drop a .ply or .xyz file, or outlines as .json.",
            ));
        }
        let (place, deform) = match chosen {
            Target::Deform(index) => {
                let deform = &session.compilation().deforms[*index];
                let place = Place::of(session, deform.origin)?;
                (place, deform.clone())
            }
            Target::Mesh(origin) => Place::after(session, *origin)?,
        };
        let is_new = place.old.is_empty();
        let controls = if is_new {
            Controls::Around(self.settings.count)
        } else {
            let both = deform.controls.iter().map(|c| [c.place, c.way]);
            Controls::Given(both.collect())
        };
        // The field falls within a twentieth of an edge, and shells are two such lengths thick.
        let edge = fit::mean_edge(&deform.positions, &deform.triangles);
        let slope = 20.0 / edge.max(f64::MIN_POSITIVE);
        let job = FitMesh {
            positions: deform.positions.to_vec(),
            triangles: deform.triangles.to_vec(),
            controls,
            observations,
            options: Options {
                kind: match self.settings.surface {
                    Surface::Explicit => Kind::Explicit,
                    Surface::Spherical => Kind::Spherical,
                    Surface::Triangular => Kind::Triangular {
                        thickness: 0.1 / slope,
                    },
                },
                slope: Some(slope),
                smooth: libm::exp(self.settings.smooth * std::f64::consts::LN_10),
                outlines: self.settings.outlines,
                align: self.settings.align,
                ..Options::default()
            },
        };
        self.run = Some(Run {
            ticket: self.tools.submit(job),
            file: place.file,
            start: place.start,
            text: place.old,
            lead: if is_new { "\n" } else { "" },
            indent: place.indent,
            name: place.name,
            waiting: None,
            written: now,
            interval: INTERVALS[usize::from(deform.triangles.len() > LARGE)],
            is_held: false,
            done: false,
        });
        Ok(())
    }

    /// Ends the fit; the last step stays in the text.
    pub fn stop(&mut self, session: &mut Session, now: f64) {
        if self.run.is_some() {
            self.write(session, now, true);
            self.finish(session);
            self.message = Some((String::from("Stopped."), false));
        }
    }

    /// Takes in steps from the worker and measured files. Returns whether the text has changed.
    pub fn tick(&mut self, session: &mut Session, now: f64) -> bool {
        // A scene may have a million elements, so they are not looked through at every frame.
        let text = (session.revision(), session.is_compiled());
        if self.targets_of != Some(text) && session.is_compiled() {
            self.targets_of = Some(text);
            self.targets = Self::targets(session);
        }
        let message = &mut self.message;
        self.files.retain_mut(|file| match file.reading.result() {
            None => true,
            Some(Ok(found)) => {
                file.found = Some(found);
                true
            }
            Some(Err(trouble)) => {
                *message = Some((format!("{}: {trouble}.", file.name), true));
                false
            }
        });
        if let Some(run) = &mut self.run {
            while let Some(step) = run.ticket.part() {
                self.residuals.push(step.residual);
                run.waiting = Some(step);
            }
            match run.ticket.result() {
                None => {}
                Some(Ok(step)) => {
                    run.waiting = Some(step);
                    run.done = true;
                }
                Some(Err(trouble)) => {
                    self.message = Some((format!("{trouble}."), true));
                    self.finish(session);
                    return false;
                }
            }
        }
        self.write(session, now, false)
    }

    /// Writes the last step into the text, if it is time. Returns whether the text has changed.
    fn write(&mut self, session: &mut Session, now: f64, at_once: bool) -> bool {
        let Some(run) = &mut self.run else {
            return false;
        };
        let due = at_once || run.done || now - run.written >= run.interval;
        let Some(step) = run.waiting.take_if(|_| due) else {
            return false;
        };
        let text = run.format(&step.text);
        let failure = step.failure.clone();
        self.last = Some(step);
        let Some(range) = run.place(session) else {
            self.message = Some((
                String::from("The text was changed where the fit writes, so it has stopped."),
                true,
            ));
            self.finish(session);
            return false;
        };
        if !run.is_held {
            session.end_step();
            session.hold();
            run.is_held = true;
        }
        run.start = range.start;
        let done = run.done;
        let replaced = session.edit(&[TextEdit::new(run.file, range, text.clone())], now);
        run.text = text;
        run.written = now;
        if let Err(refused) = replaced {
            self.message = Some((refused.to_string(), true));
            self.finish(session);
        } else if done {
            let is_bad = failure.is_some();
            let words = failure.map_or(String::from("Done."), |why| {
                format!("The fit failed: {why}. The best that was found stays in the text.")
            });
            self.message = Some((words, is_bad));
            self.finish(session);
        }
        true
    }

    /// Ends the fit and its undo step.
    fn finish(&mut self, session: &mut Session) {
        if let Some(run) = self.run.take()
            && run.is_held
        {
            session.release();
            session.end_step();
        }
    }

    /// Returns the state for scripts while the panel is open.
    #[must_use]
    pub fn report(&self) -> Option<Report> {
        let found = self.files.iter().filter_map(|file| file.found.as_ref());
        self.open.then(|| Report {
            running: self.is_running(),
            iteration: self.last.as_ref().map_or(0, |last| last.iteration),
            residual: self.last.as_ref().map_or(0.0, |last| last.residual),
            points: found.map(|found| found.points.len()).sum(),
            said: self.message.as_ref().map(|(text, _)| text.clone()),
        })
    }

    /// Returns the seconds until the last step may be written; `None` if no step waits.
    #[must_use]
    pub fn wait(&self, now: f64) -> Option<f64> {
        let run = self.run.as_ref()?;
        run.waiting.as_ref()?;
        Some((run.written + run.interval - now).max(0.0))
    }
}

impl Run {
    /// Returns the lines of a step as they stand in the text: indented, and for the named object.
    fn format(&self, lines: &str) -> String {
        let mut text = String::from(self.lead);
        for (i, line) in lines.trim_end().lines().enumerate() {
            if i > 0 {
                text.push('\n');
            }
            if i > 0 || !self.lead.is_empty() {
                text += &self.indent;
            }
            let mut words = line.splitn(2, ' ');
            match (words.next(), words.next()) {
                (Some("deform"), Some(rest)) => text += &format!("deform{} {rest}", self.name),
                (Some("rotate" | "translate"), _) => text += &format!("{line}{}", self.name),
                _ => text += line,
            }
        }
        text
    }

    /// Returns the bytes of its text now; `None` if the text is gone, or is there more than once.
    fn place(&self, session: &Session) -> Option<Range<usize>> {
        let text = (self.file < session.project().files.len()).then(|| session.text(self.file))?;
        let here = self.start..self.start + self.text.len();
        if text.get(here.clone()) == Some(&self.text) {
            return Some(here);
        }
        let mut found = text.match_indices(&self.text);
        match (self.text.is_empty(), found.next(), found.next()) {
            (false, Some((start, _)), None) => Some(start..start + self.text.len()),
            _ => None,
        }
    }
}

/// The place in a text where a fit writes.
struct Place {
    file: usize,
    start: usize,
    /// The text there; empty if a command is to be added.
    old: String,
    indent: String,
    name: String,
}

/// Returns the blanks at the start of the line that a byte is in.
fn indent(text: &str, at: usize) -> String {
    let start = text[..at].rfind('\n').map_or(0, |end| end + 1);
    let line = &text[start..at];
    line[..line.len() - line.trim_start().len()].to_owned()
}

impl Place {
    /// Returns the place of a `deform`.
    fn of(session: &Session, origin: Origin) -> Result<Self, String> {
        let file = origin.file as usize;
        let text = session.text(file);
        let range = origin.start as usize..origin.end as usize;
        let old = text.get(range.clone()).ok_or("The text has changed.")?;
        let head = old.split('{').next().unwrap_or_default();
        let name = head.split_whitespace().nth(1);
        Ok(Self {
            file,
            start: range.start,
            old: old.to_owned(),
            indent: indent(text, range.start),
            name: name.map(|name| format!(" {name}")).unwrap_or_default(),
        })
    }

    /// Returns the place after a `mesh`, and the deformation that a `deform` there would be.
    fn after(session: &Session, origin: Origin) -> Result<(Self, Deform), String> {
        let file = origin.file as usize;
        let text = session.text(file);
        let mut start = origin.end as usize;
        let rest = text.get(start..).ok_or("The text has changed.")?;
        let line = rest.split('\n').next().unwrap_or_default();
        let tail = line.trim();
        if tail.is_empty() || tail.starts_with('#') {
            start += line.trim_end().len();
        }
        let indent = indent(text, origin.start as usize);
        let mut project = session.project().clone();
        let trial = format!("\n{indent}deform {{ control <0 0 0> }}");
        project.files[file].text.insert_str(start, &trial);
        let at = (start + 1 + indent.len()) as u32;
        let frame = f64::from(session.film_frame());
        let compiled = rats::compile_at(&project, session.assets(), frame);
        let mut found = compiled.deforms.into_iter();
        let deform = found
            .rfind(|d| d.origin.file as usize == file && d.origin.start == at)
            .ok_or("This mesh cannot be deformed where it stands in the text.")?;
        if deform.repeated {
            return Err(String::from(
                "This mesh stands in a loop or a defined command, \
                    where one cage would move all copies.",
            ));
        }
        let place = Self {
            file,
            start,
            old: String::new(),
            indent,
            name: String::new(),
        };
        Ok((place, deform))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::asset::Asset;
    use crate::session::Kept;
    use rats::{File, Project};
    use std::time::{Duration, Instant};

    const TEXT: &str = "surface s, diffuse Red\nobject A\n  mesh s head.obj  # the head\nclose\n";

    fn session(text: &str) -> Session {
        let head = fit::trial::head(300);
        let mut obj = String::new();
        for p in &head.positions {
            obj += &format!("v {} {} {}\n", p.x, p.y, p.z);
        }
        for [a, b, c] in &head.triangles {
            obj += &format!("f {} {} {}\n", a + 1, b + 1, c + 1);
        }
        let kept = Kept {
            project: Project {
                files: vec![File {
                    name: String::from("main.rat"),
                    text: text.to_owned(),
                }],
            },
            assets: vec![Asset::new("head.obj", obj.into_bytes())],
            ..Kept::default()
        };
        let mut session = Session::new(kept, true);
        session.compile();
        assert_eq!(session.errors(), 0, "{:?}", session.diagnostics());
        session
    }

    /// Returns the head sheared by a tenth of its height, as an XYZ file.
    fn cloud() -> Vec<u8> {
        let head = fit::trial::head(300);
        let mut text = String::new();
        for p in fit::trial::sample(&head.positions, &head.triangles, 500, 3) {
            text += &format!("{} {} {}\n", p.x + 0.1 * p.z, p.y, p.z);
        }
        text.into_bytes()
    }

    fn until(fitting: &mut Fitting, session: &mut Session, done: impl Fn(&Fitting) -> bool) {
        let start = Instant::now();
        while !done(fitting) {
            assert!(start.elapsed() < Duration::from_secs(60));
            fitting.tick(session, start.elapsed().as_secs_f64());
            std::thread::sleep(Duration::from_millis(2));
        }
    }

    #[test]
    fn meshes_of_loops_are_refused_in_words() {
        for (text, words) in [
            (
                "surface s, diffuse Red\nfor i = 0 to 1 {\n  mesh s head.obj\n}\n",
                "one cage would move all copies",
            ),
            (
                "surface s, diffuse Red\nfor i = 0 to 1 {\n  mesh s head.obj\n  \
                    deform { control <0 0 0> move <i 0 0> control <9 9 9> control <9 0 0> \
                    control <0 9 0> control <-9 -9 -9> }\n}\n",
                "deformed in a loop",
            ),
        ] {
            let mut session = session(text);
            let mut fitting = Fitting::new(Tools::new(|| {}));
            fitting.add(String::from("cloud.xyz"), cloud());
            until(&mut fitting, &mut session, Fitting::has_data);
            fitting.start(&session, 0.0);
            let (said, bad) = fitting.message.clone().unwrap();
            assert!(bad && said.contains(words), "{said}");
            assert!(!fitting.is_running());
            assert_eq!(session.text(0), text);
        }
    }

    #[test]
    fn mesh_of_a_file_is_chosen() {
        let text = "surface s, diffuse Red\nmesh s gem.obj\nmesh s, head.obj\n";
        let session = session(text);
        let mut fitting = Fitting::new(Tools::new(|| {}));
        fitting.choose(&session, "head.obj");
        let Some(Target::Mesh(origin)) = fitting.target else {
            panic!("{:?}", fitting.target);
        };
        assert_eq!(origin.start as usize, text.find("mesh s, head").unwrap());
    }

    #[test]
    fn fit_writes_a_deform_as_one_step_and_goes_on_from_it() {
        let mut session = session(TEXT);
        let mut fitting = Fitting::new(Tools::new(|| {}));
        fitting.settings.count = 16;
        fitting.settings.surface = Surface::Explicit;
        fitting.start(&session, 0.0);
        assert!(
            fitting.message.take().is_some_and(|(_, bad)| bad),
            "no data"
        );
        fitting.add(String::from("cloud.xyz"), cloud());
        until(&mut fitting, &mut session, Fitting::has_data);
        assert_eq!(fitting.files[0].words(), "500 points");
        let targets = Fitting::targets(&session);
        assert_eq!(targets.len(), 1);
        assert_eq!(targets[0].1, "mesh head.obj in line 3, a new cage");
        fitting.start(&session, 0.0);
        until(&mut fitting, &mut session, |fitting| !fitting.is_running());
        assert_eq!(fitting.message, Some((String::from("Done."), false)));
        let first = fitting.last.clone().expect("a step").residual;
        assert!(first < 0.02, "{first}");
        let text = session.text(0).to_owned();
        assert!(
            text.contains("  mesh s head.obj  # the head\n  deform {\n    control <"),
            "{text}"
        );
        session.compile();
        assert_eq!(session.errors(), 0);
        assert_eq!(session.compilation().deforms[0].controls.len(), 16);
        // Fitted again it begins where it was, in the same place.
        let targets = Fitting::targets(&session);
        assert_eq!(targets[0].1, "deform in line 4, 16 control points");
        fitting.start(&session, 0.0);
        until(&mut fitting, &mut session, |fitting| !fitting.is_running());
        assert!(
            fitting.residuals[0] < 1.5 * first,
            "{:?}",
            fitting.residuals
        );
        assert_eq!(session.text(0).matches("deform").count(), 1);
        // Two steps back is the text of before.
        session.undo();
        assert_eq!(session.text(0), text);
        session.undo();
        assert_eq!(session.text(0), TEXT);
    }

    #[test]
    fn edits_stop_the_fit_and_bad_files_are_refused() {
        let mut session = session(TEXT);
        let mut fitting = Fitting::new(Tools::new(|| {}));
        fitting.add(String::from("bad.xyz"), b"1 2\n".to_vec());
        until(&mut fitting, &mut session, |fitting| {
            fitting.message.is_some()
        });
        let said = fitting
            .message
            .take()
            .map(|(text, _)| text)
            .unwrap_or_default();
        assert!(said.contains("bad.xyz: line 1"), "{said}");
        assert!(fitting.files.is_empty());
        fitting.add(String::from("cloud.xyz"), cloud());
        until(&mut fitting, &mut session, Fitting::has_data);
        fitting.start(&session, 0.0);
        until(&mut fitting, &mut session, |fitting| fitting.last.is_some());
        if fitting.is_running() {
            session
                .edit(&[TextEdit::whole(0, TEXT)], 0.0)
                .expect("taken");
            until(&mut fitting, &mut session, |fitting| !fitting.is_running());
            let said = fitting
                .message
                .take()
                .map(|(text, _)| text)
                .unwrap_or_default();
            assert!(said.contains("was changed") || said == "Done.", "{said}");
        }
        fitting.start(&session, 0.0);
        fitting.stop(&mut session, 0.0);
        assert!(!fitting.is_running());
    }
}
