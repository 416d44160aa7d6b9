//! Draws a mesh that is worked on into an image on the processor, so that it looks the same with
//! and without a graphics card, and finds what is under the pointer. Knows triangles, no windows.
//!
//! - [`View`]: a camera that turns about a movable centre, by a virtual trackball.
//! - [`Surface`]: triangles with normals and colours.
//! - [`Frame`]: the image, with the depth of each pixel; [`Frame::pick`] finds the surface there.
//!
//! ```
//! use glam::{DVec3, Vec3};
//! use viewport::{Frame, Look, Surface, View};
//!
//! let surface = Surface {
//!     positions: [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]].map(Vec3::from).to_vec(),
//!     normals: vec![Vec3::Z; 3],
//!     colors: vec![[0.7, 0.5, 0.4]; 3],
//!     triangles: vec![[0, 1, 2]],
//!     ..Surface::default()
//! };
//! let mut view = View::around([DVec3::splat(-1.0), DVec3::ONE]);
//! view.look_from(DVec3::Z, DVec3::Y);
//! let mut frame = Frame::new([64, 48]);
//! frame.draw(&view, &surface, &Look::default());
//! let found = frame.pick(&view, &surface, [32.0, 24.0]).unwrap();
//! assert!(found.point.length() < 1e-3 && found.triangle == 0);
//! assert!(frame.pick(&view, &surface, [2.0, 2.0]).is_none());
//! ```

mod frame;
mod shadow;
mod surface;
mod view;

pub use frame::{Found, Frame, Look};
pub use surface::Surface;
pub use view::View;
