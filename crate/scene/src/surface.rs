//! The implicit function of each body: what every reader of surfaces asks for.

use crate::{Element, Function, Scene, Shape, SoftSurface};
use field::{Blend, Implicit};
use std::collections::BTreeMap;
use std::sync::Arc;

/// The function of a body. Its surface is where the function equals [`field::THRESHOLD`].
#[derive(Clone, Debug)]
pub enum Surface {
    /// Plain sum of primitives.
    Sum(SoftSurface),
    /// Function of any other kind.
    Composed(ComposedSurface),
}

/// The function of a body that is not a plain sum, and which elements its parts came from.
#[derive(Clone, Debug)]
pub struct ComposedSurface {
    /// Index of the body in [`Scene::bodies`].
    pub body: u32,
    /// The function.
    pub function: Arc<dyn Implicit>,
    /// Index in [`Scene::elements`] of each element of the function.
    pub element: Vec<u32>,
}

impl Surface {
    /// Index of the body in [`Scene::bodies`].
    #[must_use]
    pub fn body(&self) -> u32 {
        match self {
            Self::Sum(surface) => surface.body,
            Self::Composed(surface) => surface.body,
        }
    }

    /// The body's whole function.
    #[must_use]
    pub fn function(&self) -> &dyn Implicit {
        match self {
            Self::Sum(surface) => &surface.sum,
            Self::Composed(surface) => &*surface.function,
        }
    }

    /// The surface with its function as one of any kind.
    #[must_use]
    pub fn composed(self) -> ComposedSurface {
        match self {
            Self::Sum(surface) => ComposedSurface {
                body: surface.body,
                function: Arc::new(surface.sum),
                element: surface.element,
            },
            Self::Composed(surface) => surface,
        }
    }

    /// Index in [`Scene::elements`] of each element of the function.
    #[must_use]
    pub fn element(&self) -> &[u32] {
        match self {
            Self::Sum(surface) => &surface.element,
            Self::Composed(surface) => &surface.element,
        }
    }
}

/// The element that has the largest share of a function's value at a point; `None` if none has one.
/// Elements of the function that came from one element of the scene count together; `element` tells
/// from which.
#[must_use]
pub fn strongest(function: &dyn Implicit, element: &[u32], point: glam::DVec3) -> Option<u32> {
    let mut shares = Vec::new();
    function.shares(point, &mut shares);
    let mut sums = BTreeMap::new();
    for (number, share) in shares {
        *sums.entry(element.get(number as usize)?).or_insert(0.0) += share;
    }
    let most = sums.into_iter().max_by(|a, b| a.1.total_cmp(&b.1));
    most.map(|(element, _)| *element)
}

impl Scene {
    /// The functions of all bodies that have soft elements, in the order of [`Scene::bodies`], as
    /// their contacts deform them.
    #[must_use]
    pub fn surfaces(&self) -> Vec<Surface> {
        self.in_contact(self.surfaces_apart())
    }

    /// Returns [`Self::surfaces`] without contacts of two bodies; folds of a skeleton do press each
    /// other.
    #[must_use]
    pub fn surfaces_apart(&self) -> Vec<Surface> {
        let mut functions: BTreeMap<u32, Vec<_>> = BTreeMap::new();
        for (index, element) in (0..).zip(&self.elements) {
            if self.is_soft(element) && (element.body as usize) < self.bodies.len() {
                let own = match &element.shape {
                    Shape::Function(function) => self.functions_of(element, function),
                    _ => self.slice_bone(element),
                };
                if !own.is_empty() {
                    let body = functions.entry(element.body).or_default();
                    body.extend(own.into_iter().map(|function| (index, function)));
                }
            }
        }
        let mut surfaces = Vec::new();
        for surface in self.soft_surfaces() {
            match functions.remove(&surface.body) {
                None => surfaces.push(Surface::Sum(surface)),
                Some(parts) => surfaces.push(Surface::Composed(blend(surface, parts))),
            }
        }
        for (body, parts) in functions {
            let surface = SoftSurface {
                body,
                ..SoftSurface::default()
            };
            surfaces.push(Surface::Composed(blend(surface, parts)));
        }
        field::heap_sort(&mut surfaces, |a, b| a.body() < b.body());
        surfaces
    }
}

impl Scene {
    /// The functions of an element that is no mere sum of primitives; none if its numbers are not
    /// usable.
    fn functions_of(&self, element: &Element, function: &Function) -> Vec<Arc<dyn Implicit>> {
        if function.curves().is_none() {
            return function.implicit().into_iter().collect();
        }
        let Some(local) = self.local(element, function) else {
            return self.slice(element, function);
        };
        let Ok(local) = local else { return Vec::new() };
        vec![match self.fold(element.body) {
            Some(bulge) => Arc::new(contact::Folded::new(local, bulge)),
            None => Arc::new(local),
        }]
    }
}

/// The sum of a body's primitives and of functions, each of one element.
fn blend(surface: SoftSurface, functions: Vec<(u32, Arc<dyn Implicit>)>) -> ComposedSurface {
    let mut element = surface.element;
    element.extend(functions.iter().map(|(index, _)| index));
    let functions = functions.into_iter().map(|(_, function)| (function, 1));
    ComposedSurface {
        body: surface.body,
        function: Arc::new(Blend::new(surface.sum, functions.collect())),
        element,
    }
}
