//! A picture on its way back from the card.

use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

/// States of a copy.
const WAITING: u8 = 0;
const THERE: u8 = 1;
const FAILED: u8 = 2;

/// A picture on its way back from the card.
#[derive(Debug)]
pub struct Copy {
    buffer: wgpu::Buffer,
    size: [u32; 2],
    /// Bytes of a row, which are a multiple of 256.
    row: u32,
    state: Arc<AtomicU8>,
}

impl Copy {
    /// Begins to copy a picture that was drawn by some commands, and submits these.
    #[must_use]
    pub fn begin(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        mut commands: wgpu::CommandEncoder,
        picture: &wgpu::Texture,
    ) -> Self {
        let size = [picture.width(), picture.height()];
        let row = (4 * size[0]).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("copy of a picture"),
            size: u64::from(row) * u64::from(size[1]),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        commands.copy_texture_to_buffer(
            picture.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &buffer,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(row),
                    rows_per_image: None,
                },
            },
            picture.size(),
        );
        queue.submit([commands.finish()]);
        let state = Arc::new(AtomicU8::new(WAITING));
        let told = state.clone();
        buffer
            .slice(..)
            .map_async(wgpu::MapMode::Read, move |mapped| {
                let state = if mapped.is_ok() { THERE } else { FAILED };
                told.store(state, Ordering::Relaxed);
            });
        Self {
            buffer,
            size,
            row,
            state,
        }
    }

    /// Returns the pixels, RGBA, row by row from the top; `None` as long as they are on their way.
    /// The device must be polled meanwhile.
    ///
    /// # Errors
    /// If the device gives none.
    pub fn pixels(&self) -> Option<Result<Vec<u8>, String>> {
        const REFUSED: &str = "The card gives no picture back.";
        match self.state.load(Ordering::Relaxed) {
            WAITING => return None,
            THERE => {}
            _ => return Some(Err(REFUSED.into())),
        }
        let Ok(bytes) = self.buffer.slice(..).get_mapped_range() else {
            return Some(Err(REFUSED.into()));
        };
        let width = 4 * self.size[0] as usize;
        let rows = bytes.chunks(self.row as usize);
        Some(Ok(rows.flat_map(|row| &row[..width]).copied().collect()))
    }
}
