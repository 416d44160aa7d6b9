//! What draws the window and the draft.

/// What the browser offers for drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Backend {
    /// WebGPU: window and draft.
    WebGpu,
    /// WebGL2: window and draft.
    WebGl2,
    /// Neither: the window is drawn on the processor and there is no draft.
    None,
}

impl Backend {
    /// The name shown in the status line.
    #[must_use]
    pub fn label(self) -> &'static str {
        match self {
            Self::WebGpu => "WebGPU",
            Self::WebGl2 => "WebGL2",
            Self::None => "no GPU",
        }
    }

    /// The name in the page handle's status.
    #[must_use]
    pub fn id(self) -> &'static str {
        match self {
            Self::WebGpu => "webgpu",
            Self::WebGl2 => "webgl2",
            Self::None => "none",
        }
    }
}
