//! Backend that draws the window and the draft.

/// The browser's interface for drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Backend {
    /// WebGPU: window and draft.
    WebGpu,
    /// WebGL2: window and draft.
    WebGl2,
    /// Neither, or an emulation: the processor draws the window, and there is no draft.
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

/// Whether an adapter or renderer of this name is no graphics card but a program on the processor.
#[must_use]
pub fn is_processor(name: &str) -> bool {
    let name = name.to_lowercase();
    ["swiftshader", "llvmpipe", "softpipe", "basic render"]
        .iter()
        .any(|program| name.contains(program))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn processors_are_known_by_their_programs_names() {
        let emulations = [
            "ANGLE (Google, Vulkan 1.3.0 (SwiftShader Device (Subzero) (0x0000C0DE)), \
                SwiftShader driver)",
            "llvmpipe (LLVM 15.0.6, 256 bits)",
            "ANGLE (Microsoft, Microsoft Basic Render Driver Direct3D11 vs_5_0 ps_5_0)",
        ];
        assert!(emulations.iter().all(|name| is_processor(name)));
        let cards = [
            "ANGLE (Intel, Mesa Intel(R) UHD Graphics 620 (KBL GT2), OpenGL 4.6)",
            "Apple GPU",
            "Adreno (TM) 640",
            "",
        ];
        assert!(!cards.iter().any(|name| is_processor(name)));
    }
}
