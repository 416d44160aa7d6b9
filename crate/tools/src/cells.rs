//! The job of packing a scene for the card, apart from the page's thread.

use crate::job::{Job, Pace, Progress};
use cells::{Cubics, Detail, Packed};
use scene::Scene;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Packs a scene for the card, with no formulas beside cubics.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PackScene {
    /// The scene.
    pub scene: Arc<Scene>,
    /// The care to be taken.
    pub detail: Detail,
}

impl Job for PackScene {
    type Output = Packed;
    const PACE: Pace = Pace::Quick;

    fn run(self, progress: &mut Progress<'_, Packed>) -> Result<Packed, String> {
        let packed = Packed::new(&self.scene, self.detail, &Cubics, &mut |share| {
            progress.report(share).is_continue()
        });
        packed.ok_or_else(|| "not wanted any more".into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::News;
    use core::ops::ControlFlow;
    use glam::DVec3;
    use scene::{Element, Finish, Flesh, Shape};

    fn scene() -> Scene {
        let mut scene = Scene {
            finishes: vec![Finish::default()],
            ..Scene::default()
        };
        scene.flesh.push(Flesh {
            blobbiness: Some(2.0),
            ..Flesh::default()
        });
        scene.elements = [0.0, 1.6]
            .map(|x| Element {
                flesh: Some(0),
                ..Element::new(Shape::sphere(DVec3::new(x, 0.0, 0.0), 1.0))
            })
            .to_vec();
        scene
    }

    #[test]
    fn scenes_travel_as_they_are() {
        for detail in [Detail::Quick, Detail::Fine] {
            let scene = Arc::new(scene());
            let packed = PackScene { scene, detail }
                .run(&mut Progress::silent())
                .unwrap();
            assert!(packed.leaves > 50 && packed.meshed.is_empty(), "{detail:?}");
            let bytes = postcard::to_allocvec(&packed).unwrap();
            assert!(bytes.len() < packed.data.len() + 100);
            assert_eq!(postcard::from_bytes::<Packed>(&bytes), Ok(packed));
        }
    }

    #[test]
    fn nobody_waits_for_it() {
        let job = PackScene {
            scene: Arc::new(scene()),
            detail: Detail::Fine,
        };
        let result = job.run(&mut Progress::new(&mut |_: News<Packed>| {
            ControlFlow::Break(())
        }));
        assert!(result.is_err());
    }
}
