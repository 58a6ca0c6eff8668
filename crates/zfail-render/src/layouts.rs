//! Bind group layouts: group 0 the frame, group 1 an instance or the G-buffer, group 2 a material.

use crate::gpu_data::{FrameUniform, InstanceUniform, LightRecord, MaterialUniform};
use std::num::NonZeroU64;

/// The layouts that every pass agrees on.
#[derive(Debug)]
pub struct Layouts {
    pub frame: wgpu::BindGroupLayout,
    pub instance: wgpu::BindGroupLayout,
    pub material: wgpu::BindGroupLayout,
    gbuffer: [wgpu::BindGroupLayout; 2],
}

impl Layouts {
    pub fn new(device: &wgpu::Device) -> Self {
        let create = |label, entries: &[wgpu::BindGroupLayoutEntry]| {
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries })
        };
        let mut material = vec![entry(0, wgpu::ShaderStages::FRAGMENT, uniform::<MaterialUniform>(false))];
        for slot in 0..5 {
            material.push(entry(1 + 2 * slot, wgpu::ShaderStages::FRAGMENT, texture(FILTERED, false)));
            let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
            material.push(entry(2 + 2 * slot, wgpu::ShaderStages::FRAGMENT, sampler));
        }
        let lights = wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only: true },
            has_dynamic_offset: false,
            min_binding_size: NonZeroU64::new(size_of::<LightRecord>() as u64),
        };
        Self {
            frame: create(
                "frame",
                &[
                    entry(0, wgpu::ShaderStages::VERTEX_FRAGMENT, uniform::<FrameUniform>(false)),
                    entry(1, wgpu::ShaderStages::FRAGMENT, lights),
                ],
            ),
            instance: create("instance", &[entry(0, wgpu::ShaderStages::VERTEX, uniform::<InstanceUniform>(true))]),
            material: create("material", &material),
            gbuffer: [false, true].map(|multisampled| {
                let load = |binding, sample_type| {
                    entry(binding, wgpu::ShaderStages::FRAGMENT, texture(sample_type, multisampled))
                };
                create("G-buffer", &[load(0, FLOATS), load(1, FLOATS), load(2, FLOATS), load(3, BYTES)])
            }),
        }
    }

    pub fn gbuffer(&self, samples: u32) -> &wgpu::BindGroupLayout {
        &self.gbuffer[usize::from(samples > 1)]
    }
}

pub fn entry(binding: u32, visibility: wgpu::ShaderStages, ty: wgpu::BindingType) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None }
}

pub fn uniform<T>(has_dynamic_offset: bool) -> wgpu::BindingType {
    wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset,
        min_binding_size: NonZeroU64::new(size_of::<T>() as u64),
    }
}

/// Sampled textures.
pub const FILTERED: wgpu::TextureSampleType = wgpu::TextureSampleType::Float { filterable: true };
/// Targets whose texels are loaded.
pub const FLOATS: wgpu::TextureSampleType = wgpu::TextureSampleType::Float { filterable: false };
/// The depth target.
pub const BYTES: wgpu::TextureSampleType = wgpu::TextureSampleType::Uint;

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
