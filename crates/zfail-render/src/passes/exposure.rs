//! Exposure: one number that scales radiance, given by the caller or measured on the device.

use crate::scene::layouts::{FLOATS, bind, entry, texture};
use crate::settings::Exposure;
use crate::{Gpu, passes::shader};

/// As in `meter.wgsl`.
const BINS: u64 = 1024;
/// Pixels along a side of a workgroup, as in `meter.wgsl`.
const TILE: u32 = 16;

/// Steps the picture and holds the exposure.
#[derive(Debug)]
pub struct ExposureMeter {
    layout: wgpu::BindGroupLayout,
    count: wgpu::ComputePipeline,
    expose: wgpu::ComputePipeline,
    histogram: wgpu::Buffer,
    /// An `f32`: what radiance in the target is multiplied with.
    pub exposure: wgpu::Buffer,
}

impl ExposureMeter {
    pub fn new(gpu: &Gpu, samples: u32) -> Self {
        let storage = wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only: false },
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let compute = wgpu::ShaderStages::COMPUTE;
        let layout = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("meter"),
            entries: &[
                entry(0, compute, texture(FLOATS, samples > 1)),
                entry(1, compute, storage),
                entry(2, compute, storage),
            ],
        });
        let pipeline_layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("meter"),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let module = shader::meter(samples).module(&gpu.device);
        let pipeline = |entry| {
            gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(entry),
                layout: Some(&pipeline_layout),
                module: &module,
                entry_point: Some(entry),
                compilation_options: Default::default(),
                cache: None,
            })
        };
        let buffer = |label, size, usage| {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST | usage,
                mapped_at_creation: false,
            })
        };
        Self {
            count: pipeline("count"),
            expose: pipeline("expose"),
            histogram: buffer("histogram", BINS * 4, wgpu::BufferUsages::empty()),
            exposure: buffer("exposure", 4, wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_SRC),
            layout,
        }
    }

    /// Sets the exposure of this frame.
    pub fn encode(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        radiance: &wgpu::TextureView,
        size: [u32; 2],
        exposure: Exposure,
        pre_exposure: f32,
    ) {
        if let Exposure::Ev(stops) = exposure {
            let scale = (stops.exp2() / pre_exposure).clamp(0.0, f32::MAX);
            gpu.queue.write_buffer(&self.exposure, 0, bytemuck::bytes_of(&scale));
            return;
        }
        let group = bind(
            &gpu.device,
            "meter",
            &self.layout,
            &[
                wgpu::BindingResource::TextureView(radiance),
                self.histogram.as_entire_binding(),
                self.exposure.as_entire_binding(),
            ],
        );
        encoder.clear_buffer(&self.histogram, 0, None);
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_bind_group(0, &group, &[]);
        pass.set_pipeline(&self.count);
        pass.dispatch_workgroups(size[0].div_ceil(TILE), size[1].div_ceil(TILE), 1);
        pass.set_pipeline(&self.expose);
        pass.dispatch_workgroups(1, 1, 1);
    }
}
