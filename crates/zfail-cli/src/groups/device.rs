//! Which graphics adapter is used.

use crate::error::Error;
use clap::{Args, ValueEnum};
use zfail_render::wgpu::Backends;
use zfail_render::{Gpu, GpuOptions};

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

impl Device {
    /// Opens the GPU that is asked for.
    ///
    /// # Errors
    /// If there is none.
    pub fn open(&self) -> Result<Gpu, Error> {
        Ok(Gpu::new(&self.options())?)
    }

    /// Which adapters are allowed.
    pub fn options(&self) -> GpuOptions {
        let mut options = GpuOptions { adapter: self.adapter.clone(), ..GpuOptions::default() };
        if let Some(backend) = self.backend {
            options.backends = backend.backends();
        }
        options
    }

    /// The flags that choose this device.
    #[cfg(feature = "view")]
    pub fn flags(&self) -> Vec<String> {
        let backend = self.backend.as_ref().and_then(ValueEnum::to_possible_value);
        let backend = backend.into_iter().flat_map(|name| ["--backend".to_owned(), name.get_name().to_owned()]);
        backend.chain(self.adapter.iter().flat_map(|name| ["--adapter".to_owned(), name.clone()])).collect()
    }
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
    fn backends(self) -> Backends {
        match self {
            Self::Vulkan => Backends::VULKAN,
            Self::Metal => Backends::METAL,
            Self::Dx12 => Backends::DX12,
            Self::Gl => Backends::GL,
        }
    }
}
