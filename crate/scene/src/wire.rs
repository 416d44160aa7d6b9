//! A scene as bytes, for sending it to a worker.

use crate::Scene;

/// Packs a scene. Both ends must be the same build: this is a message, not a file format.
///
/// # Errors
/// Only if memory runs out while writing.
pub fn pack(scene: &Scene) -> Result<Vec<u8>, postcard::Error> {
    postcard::to_allocvec(scene)
}

/// Unpacks what [`pack`] made.
///
/// # Errors
/// If the bytes are not a scene.
pub fn unpack(bytes: &[u8]) -> Result<Scene, postcard::Error> {
    postcard::from_bytes(bytes)
}
