//! Reading the meshes and skeletons of a work apart from the page's thread.
//!
//! A mesh file goes to a tools worker, as the page's program has no readers; its mesh, or the
//! reader's error message, is kept by the asset ([`Asset::keep_mesh`]). Until then the session does
//! not compile texts that name it and the last good picture stays. So it is with skeletons, of
//! which the compiler says how they are wanted.

use crate::asset::Asset;
use crate::session::Session;
use limbs::{Graph, Recipe};
use mesh::TriangleMesh;
use pool::{Ticket, Tools};
use std::sync::Arc;
use tools::{ReadMesh, ReadSkeleton};

/// A file that is being read.
struct Reading {
    asset: Asset,
    ticket: Ticket<(TriangleMesh, Vec<String>)>,
}

impl Reading {
    fn is_of(&self, asset: &Asset) -> bool {
        self.asset.name == asset.name && Arc::ptr_eq(&self.asset.bytes, &asset.bytes)
    }
}

/// A skeleton that is being made of a file.
struct SkeletonReading {
    asset: Asset,
    recipe: Recipe,
    ticket: Ticket<Graph>,
}

impl SkeletonReading {
    fn is_of(&self, (asset, recipe): (&Asset, &Recipe)) -> bool {
        let is_same = Arc::ptr_eq(&self.asset.bytes, &asset.bytes);
        is_same && self.asset.name == asset.name && self.recipe == *recipe
    }
}

/// The files that are being read.
pub struct MeshReading {
    tools: Tools,
    files: Vec<Reading>,
    skeletons: Vec<SkeletonReading>,
}

impl MeshReading {
    /// Reads no file until [`MeshReading::tick`].
    #[must_use]
    pub fn new(tools: Tools) -> Self {
        Self {
            tools,
            files: Vec::new(),
            skeletons: Vec::new(),
        }
    }

    /// Starts reading the meshes that the session waits for, gives up those that it does not need
    /// any more, and keeps those that are read. Returns whether one is, so that the session may
    /// compile.
    pub fn tick(&mut self, session: &Session) -> bool {
        let mut any_read = false;
        self.files.retain_mut(|file| match file.ticket.result() {
            Some(read) => {
                file.asset.keep_mesh(read);
                any_read = true;
                false
            }
            None => true,
        });
        let wanted: Vec<Asset> = if session.is_enabled() {
            session.unread_meshes().cloned().collect()
        } else {
            Vec::new()
        };
        self.files
            .retain(|file| wanted.iter().any(|asset| file.is_of(asset)));
        for asset in wanted {
            if !self.files.iter().any(|file| file.is_of(&asset)) {
                let ticket = self.tools.submit(ReadMesh {
                    name: asset.name.clone(),
                    bytes: asset.bytes.to_vec(),
                });
                self.files.push(Reading { asset, ticket });
            }
        }
        any_read | self.tick_skeletons(session)
    }

    /// Does the same for skeletons.
    fn tick_skeletons(&mut self, session: &Session) -> bool {
        let mut any_read = false;
        self.skeletons
            .retain_mut(|file| match file.ticket.result() {
                Some(graph) => {
                    file.asset.keep_skeleton(file.recipe.clone(), graph);
                    any_read = true;
                    false
                }
                None => true,
            });
        self.skeletons
            .retain(|file| session.unread_skeletons().any(|wanted| file.is_of(wanted)));
        for wanted in session.unread_skeletons() {
            if !self.skeletons.iter().any(|file| file.is_of(wanted)) {
                let (asset, recipe) = (wanted.0.clone(), wanted.1.clone());
                let ticket = self.tools.submit(ReadSkeleton {
                    name: asset.name.clone(),
                    bytes: asset.bytes.to_vec(),
                    recipe: recipe.clone(),
                });
                self.skeletons.push(SkeletonReading {
                    asset,
                    recipe,
                    ticket,
                });
            }
        }
        any_read
    }

    /// Returns the name of the file that is being read, with the fraction done, 0 … 1.
    #[must_use]
    pub fn current(&self) -> Option<(&str, f32)> {
        let mesh = self
            .files
            .first()
            .map(|file| (&file.asset, file.ticket.fraction()));
        let skeleton = self.skeletons.first();
        let skeleton = skeleton.map(|file| (&file.asset, file.ticket.fraction()));
        let (asset, fraction) = mesh.or(skeleton)?;
        Some((&asset.name, fraction.unwrap_or(0.0)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::Kept;
    use rats::{File, Project};
    use std::time::{Duration, Instant};

    /// A mesh file with a triangle.
    fn file(name: &str, face: &str) -> Asset {
        let text = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n{face}");
        Asset::await_mesh(name, text.into_bytes())
    }

    fn session(text: &str, assets: Vec<Asset>) -> Session {
        let file = File {
            name: String::from("main.rat"),
            text: text.to_owned(),
        };
        let kept = Kept {
            project: Project { files: vec![file] },
            assets,
            ..Kept::default()
        };
        Session::new(kept, true)
    }

    fn read_all(reading: &mut MeshReading, session: &Session) {
        let deadline = Instant::now() + Duration::from_secs(60);
        while !reading.tick(session) || reading.current().is_some() {
            assert!(Instant::now() < deadline);
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    const TEXT: &str = "surface a, diffuse Red\nmesh a tri.obj\n";

    #[test]
    fn session_compiles_once_its_mesh_is_read() {
        let mut session = session(TEXT, vec![file("tri.obj", "f 1 2 3\n")]);
        session.compile();
        assert!(!session.is_compiled() && session.scene().is_none());
        let mut reading = MeshReading::new(Tools::new(|| {}));
        assert!(!reading.tick(&session));
        assert_eq!(reading.current(), Some(("tri.obj", 0.0)));
        read_all(&mut reading, &session);
        session.compile();
        assert!(session.is_compiled());
        assert_eq!(session.diagnostics(), []);
        assert_eq!(session.compilation().scene.elements.len(), 1);
    }

    #[test]
    fn last_good_picture_stays_while_a_mesh_is_read_and_an_error_is_a_diagnostic() {
        let mut session = session("surface a, diffuse Red\nsphere a 1, 0 0 0\n", Vec::new());
        session.compile();
        let generation = session.generation();
        session
            .put_assets(vec![file("tri.obj", "f 1 2 9\n")])
            .unwrap();
        session.compile();
        assert!(session.is_compiled(), "the text does not name it");
        session
            .edit(&[rats::TextEdit::whole(0, TEXT)], 0.0)
            .unwrap();
        session.compile();
        assert!(!session.is_compiled());
        assert_eq!((session.errors(), session.generation()), (0, generation));
        let mut reading = MeshReading::new(Tools::new(|| {}));
        read_all(&mut reading, &session);
        session.compile();
        assert!(session.is_compiled());
        assert_eq!(session.errors(), 1);
        let message = &session.diagnostics()[0].message;
        assert!(message.contains("`9` is none of the 3"), "{message}");
        assert_eq!(session.generation(), generation);
    }

    #[test]
    fn mesh_that_is_removed_is_not_read() {
        let mut session = session(TEXT, vec![file("tri.obj", "f 1 2 3\n")]);
        let mut reading = MeshReading::new(Tools::new(|| {}));
        reading.tick(&session);
        session.remove_asset("tri.obj");
        assert!(!reading.tick(&session));
        assert_eq!(reading.current(), None);
        session.compile();
        assert!(session.is_compiled());
        assert_eq!(session.errors(), 1, "there is no such file");
    }

    #[test]
    fn session_compiles_once_its_skeleton_is_read() {
        let limb = b"1 3 0 0 0 1 -1\n2 3 20 0 0 1 1\n";
        let asset = Asset::await_mesh("n.swc", *limb);
        let text = "eyep 0 0 90\nsurface a, diffuse Red\nskeleton a, N n.swc\n";
        let mut session = session(text, vec![asset]);
        session.compile();
        let mut reading = MeshReading::new(Tools::new(|| {}));
        assert!(!session.is_compiled() && !reading.tick(&session));
        assert_eq!(reading.current(), Some(("n.swc", 0.0)));
        read_all(&mut reading, &session);
        session.compile();
        assert!(session.is_compiled());
        assert_eq!(session.diagnostics(), []);
        assert_eq!(session.compilation().scene.elements.len(), 1);
        assert_eq!(reading.current(), None);
    }
}
