//! The graphics device: in, what kind of adapter is wanted; out, a device and queue with the features that shadows use.

use crate::RenderError;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use zfail::CostModel;

/// Which adapter to use.
#[derive(Clone, Debug)]
pub struct GpuOptions {
    /// Graphics interfaces to consider.
    pub backends: wgpu::Backends,
    /// Only adapters whose name or driver contains this text, ignoring case.
    pub adapter: Option<String>,
    /// Only software adapters.
    pub force_fallback: bool,
}

impl Default for GpuOptions {
    /// Any adapter: Vulkan, Metal and Direct3D before GL, and among these hardware before software.
    fn default() -> Self {
        Self { backends: wgpu::Backends::all(), adapter: None, force_fallback: false }
    }
}

/// An opened graphics device.
#[derive(Debug)]
pub struct Gpu {
    /// The device, with every feature that [`zfail::wanted_features`] names and the adapter has.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    /// Name, backend and driver of the adapter.
    pub info: wgpu::AdapterInfo,
    /// The format of every depth-stencil target.
    pub(crate) depth_stencil: wgpu::TextureFormat,
    /// Whether GPU times can be trusted.
    pub(crate) timestamps: bool,
    /// Whether draws within a pass can be timed.
    pub(crate) timestamps_inside: bool,
    /// What counting costs here, once it has been measured.
    costs: OnceLock<CostModel>,
    /// The first error that the device reported since it was last asked.
    failure: Arc<Mutex<Option<String>>>,
}

impl Gpu {
    /// What rasterising, tiles and silhouettes cost on this device; measured at the first call, a tenth of a second or two on
    /// software devices.
    pub(crate) fn costs(&self) -> CostModel {
        *self.costs.get_or_init(|| CostModel::calibrate(&self.device, &self.queue))
    }

    /// Opens the best adapter that `options` allows.
    ///
    /// # Errors
    /// If there is no such adapter, or none gives a device.
    pub fn new(options: &GpuOptions) -> Result<Self, RenderError> {
        pollster::block_on(Self::open(options))
    }

    async fn open(options: &GpuOptions) -> Result<Self, RenderError> {
        // GL is a last resort, and looking for it makes some drivers write to the terminal.
        let stages = [options.backends & wgpu::Backends::PRIMARY, options.backends - wgpu::Backends::PRIMARY];
        let mut names = Vec::new();
        let mut failure = None;
        for backends in stages.into_iter().filter(|stage| !stage.is_empty()) {
            let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
                backends,
                ..wgpu::InstanceDescriptor::new_without_display_handle()
            });
            let found = instance.enumerate_adapters(backends).await;
            names.extend(found.iter().map(|a| describe(&a.get_info())));
            let mut adapters: Vec<_> = found.into_iter().filter(|a| options.allows(&a.get_info())).collect();
            adapters.sort_by_key(|a| rank(&a.get_info()));
            for adapter in adapters {
                match Self::from_adapter(&adapter).await {
                    Ok(gpu) => return Ok(gpu),
                    Err(message) => failure = Some(RenderError::NoDevice { adapter: adapter.get_info().name, message }),
                }
            }
        }
        Err(failure.unwrap_or_else(|| RenderError::NoAdapter { detail: options.missing(&names) }))
    }

    async fn from_adapter(adapter: &wgpu::Adapter) -> Result<Self, String> {
        let info = adapter.get_info();
        // GL drivers report timer values that are not times (Mesa's software GL).
        let timing = if info.backend == wgpu::Backend::Gl {
            wgpu::Features::empty()
        } else {
            wgpu::Features::TIMESTAMP_QUERY | wgpu::Features::TIMESTAMP_QUERY_INSIDE_PASSES
        };
        let features = zfail::wanted_features(adapter.features()) | (adapter.features() & timing);
        let (device, queue) = adapter
            .request_device(&wgpu::DeviceDescriptor {
                label: Some("zfail"),
                required_features: features,
                required_limits: adapter.limits(),
                ..Default::default()
            })
            .await
            .map_err(|e| e.to_string())?;
        let failure = Arc::new(Mutex::new(None));
        let slot = Arc::clone(&failure);
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            slot.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert_with(|| error.to_string());
        }));
        Ok(Self {
            depth_stencil: zfail::depth_stencil_format(device.features()),
            timestamps: device.features().contains(wgpu::Features::TIMESTAMP_QUERY),
            // A software rasteriser works on many draws at once.
            timestamps_inside: device.features().contains(timing)
                && !timing.is_empty()
                && info.device_type != wgpu::DeviceType::Cpu,
            device,
            queue,
            info,
            costs: OnceLock::new(),
            failure,
        })
    }

    /// Waits until the device has done everything that was submitted.
    pub(crate) fn wait(&self) -> Result<(), RenderError> {
        self.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|e| RenderError::Device(e.to_string()))?;
        self.check()
    }

    /// Reports the first error that the device has had since the last call.
    pub(crate) fn check(&self) -> Result<(), RenderError> {
        match self.failure.lock().unwrap_or_else(PoisonError::into_inner).take() {
            None => Ok(()),
            Some(message) => Err(RenderError::Device(message)),
        }
    }
}

impl GpuOptions {
    fn allows(&self, info: &wgpu::AdapterInfo) -> bool {
        let named =
            self.adapter.as_ref().is_none_or(|wanted| describe(info).to_lowercase().contains(&wanted.to_lowercase()));
        named && (!self.force_fallback || info.device_type == wgpu::DeviceType::Cpu)
    }

    /// The part of an error message that says what was asked for and what there is.
    fn missing(&self, found: &[String]) -> String {
        let wanted = match (&self.adapter, self.force_fallback) {
            (Some(name), _) => format!(" whose name contains \"{name}\""),
            (None, true) => " that renders in software".to_owned(),
            (None, false) => String::new(),
        };
        if found.is_empty() { wanted } else { format!("{wanted} (there are: {})", found.join(", ")) }
    }
}

fn describe(info: &wgpu::AdapterInfo) -> String {
    format!("{} [{} {}]", info.name, info.backend, info.driver)
}

/// Smaller is better.
fn rank(info: &wgpu::AdapterInfo) -> u8 {
    match info.device_type {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Other => 3,
        wgpu::DeviceType::Cpu => 4,
    }
}
