//! A work without an editor.

use document::intake::{self, Incoming};
use document::reading::MeshReading;
use document::session::{Kept, Session, check_assets, check_size};
use glam::DVec3;
use pool::Tools;
use rats::{Diagnostic, Project};
use scene::{Scene, Surface};
use std::sync::Arc;

/// A model that a text makes, with the files beside it.
///
/// ```
/// use document::intake::Incoming;
/// let text = "surface s diffuse Gold blobbiness -1\nsphere s 1, <0 0 0>";
/// let file = Incoming { name: "ball.rat".into(), bytes: Ok(text.into()) };
/// let mut model = embed::Model::new(vec![file], pool::Tools::new(|| {})).unwrap();
/// while !model.tick() {}
/// assert!(model.diagnostics().is_empty());
/// let [inside, outside] = [[0.0, 0.0, 0.9], [0.0, 0.0, 1.1]].map(|p| model.values(&p)[0]);
/// assert!(outside < field::THRESHOLD && field::THRESHOLD < inside);
/// ```
pub struct Model {
    session: Session,
    reading: MeshReading,
    /// The functions of the bodies of a scene, with [`Session::shape`] of it.
    surfaces: Option<(u64, Vec<Surface>)>,
}

impl Model {
    /// Makes a model of files. The text that no other reads is run; skeleton files without a text
    /// get one.
    ///
    /// # Errors
    /// A sentence, if a file is none that Sinew takes, or there are too many.
    pub fn new(files: Vec<Incoming>, tools: Tools) -> Result<Self, String> {
        let sorted = intake::sort_archive(files);
        if let Some(reason) = sorted.refused.into_iter().next() {
            return Err(reason);
        }
        if let Some((name, _)) = sorted.measured.first() {
            return Err(format!("{name}: it is no model, but points to fit one to."));
        }
        let mut texts = sorted.texts;
        if texts.is_empty() {
            texts.extend(intake::write_text(&sorted.assets));
        }
        if texts.is_empty() {
            return Err(String::from("There is no text that makes a model."));
        }
        let project = Project { files: texts };
        check_size(&project).map_err(|refused| refused.to_string())?;
        check_assets(&sorted.assets).map_err(|refused| refused.to_string())?;
        let kept = Kept {
            project,
            assets: sorted.assets,
            ..Kept::default()
        };
        Ok(Self {
            session: Session::new(kept, true),
            reading: MeshReading::new(tools),
            surfaces: None,
        })
    }

    /// Compiles the text as soon as the files that it names are read. Returns whether it is done.
    pub fn tick(&mut self) -> bool {
        self.session.compile();
        self.reading.tick(&self.session);
        self.session.compile();
        self.session.is_compiled()
    }

    /// Shows another frame of a film, from the next [`Model::tick`] on.
    pub fn set_frame(&mut self, frame: u32) {
        self.session.set_film_frame(frame);
    }

    /// Returns what is said of the text.
    #[must_use]
    pub fn diagnostics(&self) -> &[Diagnostic] {
        self.session.diagnostics()
    }

    /// Returns the number of errors in the text.
    #[must_use]
    pub fn errors(&self) -> usize {
        self.session.errors()
    }

    /// Whether the text changes from frame to frame.
    #[must_use]
    pub fn is_animated(&self) -> bool {
        self.session.is_animated()
    }

    /// Returns the scene, as far as the text was understood; `None` before [`Model::tick`] is done.
    #[must_use]
    pub fn scene(&self) -> Option<&Arc<Scene>> {
        self.session.scene()
    }

    /// Computes the field at points, given as x, y, z, x …: the largest of all bodies. A place is
    /// inside where it is above [`field::THRESHOLD`]. Hard shapes have no field.
    pub fn values(&mut self, points: &[f64]) -> Vec<f64> {
        let shape = self.session.shape();
        let kept = self.surfaces.take().filter(|(of, _)| *of == shape);
        let (_, surfaces) = self.surfaces.insert(kept.unwrap_or_else(|| {
            let scene = self.session.scene();
            (shape, scene.map_or_else(Vec::new, |scene| scene.surfaces()))
        }));
        let (points, _) = points.as_chunks::<3>();
        let values = points.iter().map(|point| {
            let point = DVec3::from_array(*point);
            let bodies = surfaces.iter();
            let each = bodies.map(|surface| surface.function().jet(point).value);
            each.fold(0.0, f64::max)
        });
        values.collect()
    }
}
