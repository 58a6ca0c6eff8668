//! The graphics device: in, what kind of adapter is wanted; out, a device and queue with the features that shadows use.

use crate::{RenderError, device::read_back};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use zfail::CostModel;

/// What measuring GPU time takes, around passes and within.
const TIMING: wgpu::Features = wgpu::Features::TIMESTAMP_QUERY.union(wgpu::Features::TIMESTAMP_QUERY_INSIDE_PASSES);

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

/// An adapter that could be opened.
#[derive(Clone, Debug)]
pub struct Adapter {
    /// Name, backend and driver.
    pub info: wgpu::AdapterInfo,
    /// What it can do.
    pub features: wgpu::Features,
}

impl Adapter {
    /// Options that allow this adapter, and others only if nothing tells them from it.
    #[must_use]
    pub fn options(&self) -> GpuOptions {
        GpuOptions {
            backends: wgpu::Backends::from(self.info.backend),
            adapter: Some(describe(&self.info)),
            force_fallback: false,
        }
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
    pub depth_stencil: wgpu::TextureFormat,
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
        let mut search = Search { options, surface: None, names: Vec::new(), failure: None };
        let found = options.stages().find_map(|backends| search.among(&instance(backends), backends));
        found.map(|(gpu, _)| gpu).ok_or_else(|| search.failure())
    }

    /// Opens the best adapter that `options` allows and that can present to `surface`; says how it presents.
    ///
    /// # Errors
    /// As for [`Gpu::new`].
    pub fn for_surface(
        instance: &wgpu::Instance,
        surface: &wgpu::Surface<'_>,
        options: &GpuOptions,
    ) -> Result<(Self, wgpu::SurfaceCapabilities), RenderError> {
        let mut search = Search { options, surface: Some(surface), names: Vec::new(), failure: None };
        let found = search.among(instance, options.backends);
        found.map(|(gpu, adapter)| (gpu, surface.get_capabilities(&adapter))).ok_or_else(|| search.failure())
    }

    /// Every adapter that `options` allows, in the order in which [`Gpu::new`] tries them.
    #[must_use]
    pub fn adapters(options: &GpuOptions) -> Vec<Adapter> {
        let of_stage = |backends| {
            let found = pollster::block_on(instance(backends).enumerate_adapters(backends));
            let described = found.iter().map(|a| Adapter { info: a.get_info(), features: a.features() });
            let mut adapters: Vec<_> = described.filter(|a| options.allows(&a.info)).collect();
            adapters.sort_by_key(|a| rank(&a.info));
            adapters
        };
        options.stages().flat_map(of_stage).collect()
    }

    async fn from_adapter(adapter: &wgpu::Adapter) -> Result<Self, String> {
        let info = adapter.get_info();
        let timing = if info.backend == wgpu::Backend::Gl { wgpu::Features::empty() } else { TIMING };
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
        Ok(Self::from_device(device, queue, info))
    }

    /// Takes over a device that somebody else has opened, on the adapter that `info` describes. It should have the features
    /// that [`zfail::wanted_features`] names.
    #[must_use]
    pub fn from_device(device: wgpu::Device, queue: wgpu::Queue, info: wgpu::AdapterInfo) -> Self {
        let failure = Arc::new(Mutex::new(None));
        let slot = Arc::clone(&failure);
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            slot.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert_with(|| error.to_string());
        }));
        // GL drivers report timer values that are not times (Mesa's software GL).
        let times = |features| info.backend != wgpu::Backend::Gl && device.features().contains(features);
        Self {
            depth_stencil: zfail::depth_stencil_format(device.features()),
            timestamps: times(wgpu::Features::TIMESTAMP_QUERY),
            // A software rasteriser works on many draws at once.
            timestamps_inside: times(TIMING) && info.device_type != wgpu::DeviceType::Cpu,
            device,
            queue,
            info,
            costs: OnceLock::new(),
            failure,
        }
    }

    /// Waits until the device has done everything that was submitted.
    ///
    /// # Errors
    /// If the device has failed.
    pub fn wait(&self) -> Result<(), RenderError> {
        self.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|e| RenderError::Device(e.to_string()))?;
        self.check()
    }

    /// The texels of a single-sampled texture of a colour format, rows from top to bottom, without padding.
    ///
    /// # Errors
    /// If the device fails.
    pub fn read_texture(&self, texture: &wgpu::Texture) -> Result<Vec<u8>, RenderError> {
        read_back::texture(self, texture)
    }

    /// Reports the first error that the device has had since the last call.
    ///
    /// # Errors
    /// If there was one.
    pub fn check(&self) -> Result<(), RenderError> {
        match self.failure.lock().unwrap_or_else(PoisonError::into_inner).take() {
            None => Ok(()),
            Some(message) => Err(RenderError::Device(message)),
        }
    }
}

/// Tries adapters until one gives a device.
struct Search<'s> {
    options: &'s GpuOptions,
    /// Where the adapter has to be able to present.
    surface: Option<&'s wgpu::Surface<'s>>,
    /// All adapters there are.
    names: Vec<String>,
    failure: Option<RenderError>,
}

impl Search<'_> {
    fn among(&mut self, instance: &wgpu::Instance, backends: wgpu::Backends) -> Option<(Gpu, wgpu::Adapter)> {
        let found = pollster::block_on(instance.enumerate_adapters(backends));
        self.names.extend(found.iter().map(|a| describe(&a.get_info())));
        let presents = |adapter: &wgpu::Adapter| self.surface.is_none_or(|s| adapter.is_surface_supported(s));
        let allowed = |adapter: &wgpu::Adapter| self.options.allows(&adapter.get_info()) && presents(adapter);
        let mut adapters: Vec<_> = found.into_iter().filter(allowed).collect();
        adapters.sort_by_key(|a| rank(&a.get_info()));
        adapters.into_iter().find_map(|adapter| match pollster::block_on(Gpu::from_adapter(&adapter)) {
            Ok(gpu) => Some((gpu, adapter)),
            Err(message) => {
                self.failure = Some(RenderError::NoDevice { adapter: adapter.get_info().name, message });
                None
            }
        })
    }

    /// Why nothing was found.
    fn failure(self) -> RenderError {
        self.failure.unwrap_or_else(|| RenderError::NoAdapter { detail: self.options.missing(&self.names) })
    }
}

fn instance(backends: wgpu::Backends) -> wgpu::Instance {
    wgpu::Instance::new(wgpu::InstanceDescriptor { backends, ..wgpu::InstanceDescriptor::new_without_display_handle() })
}

impl GpuOptions {
    /// GL is a last resort, and looking for it makes some drivers write to the terminal.
    fn stages(&self) -> impl Iterator<Item = wgpu::Backends> + use<> {
        let stages = [self.backends & wgpu::Backends::PRIMARY, self.backends - wgpu::Backends::PRIMARY];
        stages.into_iter().filter(|stage| !stage.is_empty())
    }

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
