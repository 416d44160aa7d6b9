//! Equality of scenes, wherever in the text they are written.

use crate::{Element, Scene};

impl Scene {
    /// Whether another scene is the same but for the places in the text where its elements are
    /// written. It gives the same picture and the same mesh: a remark above an element changes
    /// neither.
    #[must_use]
    pub fn is_same_but_written(&self, other: &Self) -> bool {
        // Taken apart, so that a new field is not forgotten here.
        let Self {
            elements,
            bodies,
            contacts,
            flesh,
            finishes,
            frames,
            lights,
            background,
            sky,
            ground,
            fog,
            clouds,
            up,
            images,
            camera,
            lens,
            moments,
            settings,
        } = self;
        elements.len() == other.elements.len()
            && elements
                .iter()
                .zip(&other.elements)
                .all(|(a, b)| a.is_same_but_written(b))
            && (bodies, contacts) == (&other.bodies, &other.contacts)
            && (flesh, finishes) == (&other.flesh, &other.finishes)
            && (frames, lights) == (&other.frames, &other.lights)
            && (background, clouds) == (&other.background, &other.clouds)
            && (sky, ground, fog, up) == (&other.sky, &other.ground, &other.fog, &other.up)
            && (images, camera, lens) == (&other.images, &other.camera, &other.lens)
            && moments.len() == other.moments.len()
            && moments
                .iter()
                .zip(&other.moments)
                .all(|(a, b)| a.is_same_but_written(b))
            && settings == &other.settings
    }
}

impl Element {
    /// Whether another element is the same, wherever it is written.
    fn is_same_but_written(&self, other: &Self) -> bool {
        let Self {
            shape,
            flesh,
            finish,
            body,
            frame,
            kernel,
            origin: _,
            paint,
        } = self;
        (shape, paint) == (&other.shape, &other.paint)
            && (flesh, finish) == (&other.flesh, &other.finish)
            && (body, frame, kernel) == (&other.body, &other.frame, &other.kernel)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Body, Contact, Origin, Paint, Shape};
    use contact::Bulge;
    use glam::DVec3;

    fn ball(radius: f64) -> Element {
        let center = DVec3::ZERO;
        Element::new(Shape::sphere(center, radius))
    }

    #[test]
    fn place_in_the_text_is_all_that_may_differ() {
        let scene = Scene {
            elements: vec![ball(1.0), ball(2.0)],
            moments: vec![Scene::default()],
            ..Scene::default()
        };
        let mut moved = scene.clone();
        moved.elements[1].origin = Origin {
            file: 1,
            start: 7,
            end: 9,
        };
        moved.moments[0].elements.push(ball(1.0));
        assert!(!moved.is_same_but_written(&scene), "a moment");
        moved.moments = scene.moments.clone();
        assert!(moved.is_same_but_written(&scene) && moved != scene);
        let changes: [fn(&mut Scene); 6] = [
            |scene| {
                let corners = [[1.0; 3]; 3];
                let paint = Paint { finish: 0, corners };
                scene.elements[0].paint = Some(Box::new(paint));
            },
            |scene| scene.elements[0].frame = 1,
            |scene| scene.elements.truncate(1),
            |scene| scene.camera.fov += 1.0,
            |scene| scene.bodies.push(Body::default()),
            |scene| {
                scene.contacts.push(Contact {
                    bodies: [0, 1],
                    bulge: Bulge::default(),
                });
            },
        ];
        for (index, change) in changes.into_iter().enumerate() {
            let mut other = scene.clone();
            change(&mut other);
            assert!(!other.is_same_but_written(&scene), "change {index}");
        }
    }
}
