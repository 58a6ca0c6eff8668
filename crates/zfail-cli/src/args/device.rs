//! Which graphics adapter is used.

use clap::{Args, ValueEnum};
use zfail_render::wgpu::Backends;

/// Which GPU does the work.
#[derive(Args, Clone, Debug)]
pub struct Device {
    /// Graphics interface.
    #[arg(long, value_name = "NAME")]
    pub backend: Option<Backend>,
    /// Use the first adapter whose name contains NAME.
    #[arg(long, value_name = "NAME")]
    pub adapter: Option<String>,
}

/// Graphics interfaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Backend {
    /// Vulkan.
    Vulkan,
    /// Metal.
    Metal,
    /// Direct3D 12.
    Dx12,
    /// OpenGL and OpenGL ES.
    Gl,
}

impl Backend {
    /// As wgpu's set.
    pub fn backends(self) -> Backends {
        match self {
            Self::Vulkan => Backends::VULKAN,
            Self::Metal => Backends::METAL,
            Self::Dx12 => Backends::DX12,
            Self::Gl => Backends::GL,
        }
    }
}
