//! A device with ray queries, which wgpu calls experimental.
//!
//! In: the adapter in use. Out: a second device on it. See decision record 0019 for why it is a device of its own and why
//! this is the one place with unsafe code.

use wgpu::{
    Adapter, AdapterInfo, Backends, DeviceDescriptor, ExperimentalFeatures, Features, Instance, InstanceDescriptor,
};
use zfail_render::{Gpu, zfail};

/// Opens the adapter that `info` describes once more, with ray queries; says what is missing if that cannot be.
pub fn open(info: &AdapterInfo) -> Result<Gpu, String> {
    let backends = Backends::from(info.backend);
    let descriptor = InstanceDescriptor { backends, ..InstanceDescriptor::new_without_display_handle() };
    let adapters = pollster::block_on(Instance::new(descriptor).enumerate_adapters(backends));
    let same = |other: &AdapterInfo| {
        (other.vendor, other.device, &other.name, &other.driver_info)
            == (info.vendor, info.device, &info.name, &info.driver_info)
    };
    let adapter = adapters.into_iter().find(|adapter| same(&adapter.get_info()));
    let adapter = adapter.ok_or_else(|| format!("the adapter {} cannot be found a second time", info.name))?;
    if !adapter.features().contains(Features::EXPERIMENTAL_RAY_QUERY) {
        return Err(format!("the adapter {} ({}) has no ray queries", info.name, info.backend));
    }
    pollster::block_on(request(&adapter))
}

async fn request(adapter: &Adapter) -> Result<Gpu, String> {
    #[expect(unsafe_code, reason = "the only way to say that experimental features are wanted")]
    // SAFETY: this acknowledges that wgpu's implementation of ray queries may have bugs that are undefined behaviour. Only
    // this device has them; it gets buffers with checked indices and finite positions.
    let experimental_features = unsafe { ExperimentalFeatures::enabled() };
    let descriptor = DeviceDescriptor {
        label: Some("ray queries"),
        required_features: zfail::wanted_features(adapter.features()) | Features::EXPERIMENTAL_RAY_QUERY,
        required_limits: adapter.limits(),
        experimental_features,
        ..Default::default()
    };
    let (device, queue) = adapter.request_device(&descriptor).await.map_err(|e| e.to_string())?;
    Ok(Gpu::from_device(device, queue, adapter.get_info()))
}
