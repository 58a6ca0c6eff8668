//! Bind group layouts: group 0 the frame, group 1 a material or the measured attributes, group 2 the verdicts.

use crate::scene::draw_list::SLOTS;
use crate::scene::gpu_data::{FrameUniform, LightRecord, MaterialUniform};
use std::num::NonZeroU64;

/// The layouts that every pass agrees on.
#[derive(Debug)]
pub struct Layouts {
    pub frame: wgpu::BindGroupLayout,
    pub material: wgpu::BindGroupLayout,
    pub attributes: wgpu::BindGroupLayout,
    /// The number of a light.
    pub chosen: wgpu::BindGroupLayout,
    verdicts: [wgpu::BindGroupLayout; 2],
}

impl Layouts {
    pub fn new(device: &wgpu::Device) -> Self {
        let create = |label, entries: &[wgpu::BindGroupLayoutEntry]| {
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries })
        };
        let fragment = wgpu::ShaderStages::FRAGMENT;
        let mut material = vec![entry(0, fragment, uniform::<MaterialUniform>())];
        for slot in 0..SLOTS as u32 {
            material.push(entry(1 + 2 * slot, fragment, texture(FILTERED, false)));
            let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
            material.push(entry(2 + 2 * slot, fragment, sampler));
        }
        Self {
            frame: create(
                "frame",
                &[
                    entry(0, fragment, uniform::<FrameUniform>()),
                    entry(1, fragment, storage::<LightRecord>()),
                    entry(2, fragment, storage::<u32>()),
                    entry(3, fragment, storage::<u32>()),
                ],
            ),
            material: create("material", &material),
            attributes: create("attributes", &[entry(0, fragment, texture(BYTES, false))]),
            chosen: create("chosen light", &[entry(0, fragment, uniform::<u32>())]),
            verdicts: [false, true].map(|multi| create("verdicts", &[entry(0, fragment, texture(FLOATS, multi))])),
        }
    }

    pub fn verdicts(&self, samples: u32) -> &wgpu::BindGroupLayout {
        &self.verdicts[usize::from(samples > 1)]
    }
}

pub fn entry(binding: u32, visibility: wgpu::ShaderStages, ty: wgpu::BindingType) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None }
}

pub fn uniform<T>() -> wgpu::BindingType {
    buffer::<T>(wgpu::BufferBindingType::Uniform)
}

fn storage<T>() -> wgpu::BindingType {
    buffer::<T>(wgpu::BufferBindingType::Storage { read_only: true })
}

fn buffer<T>(ty: wgpu::BufferBindingType) -> wgpu::BindingType {
    let min_binding_size = NonZeroU64::new(size_of::<T>() as u64);
    wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size }
}

/// Sampled textures.
const FILTERED: wgpu::TextureSampleType = wgpu::TextureSampleType::Float { filterable: true };
/// Targets whose texels are loaded.
pub const FLOATS: wgpu::TextureSampleType = wgpu::TextureSampleType::Float { filterable: false };
/// The distances of the attribute pass.
const BYTES: wgpu::TextureSampleType = wgpu::TextureSampleType::Uint;

pub fn texture(sample_type: wgpu::TextureSampleType, multisampled: bool) -> wgpu::BindingType {
    wgpu::BindingType::Texture { sample_type, view_dimension: wgpu::TextureViewDimension::D2, multisampled }
}

/// Binds resources to 0, 1, 2...
pub fn bind(
    device: &wgpu::Device,
    label: &str,
    layout: &wgpu::BindGroupLayout,
    resources: &[wgpu::BindingResource<'_>],
) -> wgpu::BindGroup {
    let entries: Vec<_> = (0..)
        .zip(resources)
        .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource: resource.clone() })
        .collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some(label), layout, entries: &entries })
}
