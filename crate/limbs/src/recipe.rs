//! Skeletons as the language of scenes asks for them.

use crate::error::{Error, fail};
use crate::graph::Graph;
use crate::read::{Reading, read};
use serde::{Deserialize, Serialize};

/// Steps that make a skeleton of a file and take long. What a text says besides, such as a scale,
/// is done to the result. Whoever reads the same bytes by the same recipe gets the same graph.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Recipe {
    /// Name of the array or column of radii; `None` for the usual ones.
    pub radii: Option<String>,
    /// Whether atoms that are near enough are joined by limbs.
    pub bonds: bool,
    /// Distance within which lines become one, in the file's unit ([`Graph::merge`]).
    pub merge: Option<f64>,
    /// Tolerance of fewer limbs, in the file's unit ([`Graph::simplify`]).
    pub simplify: Option<f64>,
}

impl Recipe {
    /// Makes the graph of a file. Where neither the file nor a neighbour gives a radius it is 1,
    /// and [`Node::is_guessed`](crate::Node::is_guessed) says so; [`Graph::give_radius`] changes
    /// that.
    ///
    /// # Errors
    /// As [`read`] and [`Graph::merge`], or if there is a mesh or a cloud of points in the file.
    pub fn make(&self, name: &str, bytes: &[u8]) -> Result<Graph, Error> {
        let reading = Reading {
            radius: Some(1.0),
            radii: self.radii.as_deref(),
            bonds: self.bonds,
        };
        let Some(mut graph) = read(name, bytes, &reading)? else {
            return fail("there are no limbs in this file: it holds a mesh, or points");
        };
        if let Some(within) = self.merge {
            graph.merge(within)?;
        }
        if let Some(within) = self.simplify {
            graph.simplify(within);
        }
        Ok(graph)
    }
}
