//! Sinew for other pages: models of texts and files, their pictures, meshes and fields.
//!
//! [`Model`] is a work without an editor; `entry` hands it to JavaScript. The npm package around it
//! is in `package/`: `sinew.js` (promises, typed arrays; types in `sinew.d.ts`), and
//! `sinew-view.js`, an element for pages. `cargo xtask package` puts them together with the
//! workers that trace and mesh.

mod model;

#[cfg(target_arch = "wasm32")]
mod entry;

pub use model::Model;
