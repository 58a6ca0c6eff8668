//! The rendered picture onto the window's surface.
//!
//! In: [`zfail_render::Renderer::shown`], sRGB-encoded by hand. Out: the same colours on any surface format.

use zfail_render::Gpu;

/// A pipeline for one surface format.
#[derive(Debug)]
pub struct Present {
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::RenderPipeline,
    sampler: wgpu::Sampler,
    /// For the texture that was shown last.
    bound: Option<(wgpu::Texture, wgpu::BindGroup)>,
}

impl Present {
    /// For surfaces of `format`.
    pub fn new(gpu: &Gpu, format: wgpu::TextureFormat) -> Self {
        let device = &gpu.device;
        let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty,
            count: None,
        };
        let texture = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: true },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("present"),
            entries: &[entry(0, texture), entry(1, sampler)],
        });
        let module = device.create_shader_module(wgpu::include_wgsl!("present.wgsl"));
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("present"),
            layout: Some(&device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some("present"),
                bind_group_layouts: &[Some(&layout)],
                immediate_size: 0,
            })),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("corner"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: None,
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some(if format.is_srgb() { "linear" } else { "encoded" }),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &[Some(format.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        Self { layout, pipeline, sampler, bound: None }
    }

    /// Draws `picture` into a rectangle of the pass's target: x, y, width and height in pixels, none of them outside.
    pub fn draw(&mut self, gpu: &Gpu, pass: &mut wgpu::RenderPass<'_>, picture: &wgpu::Texture, area: [u32; 4]) {
        if area[2] == 0 || area[3] == 0 {
            return;
        }
        if self.bound.as_ref().is_none_or(|(texture, _)| texture != picture) {
            let view = picture.create_view(&wgpu::TextureViewDescriptor::default());
            let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
            let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("present"),
                layout: &self.layout,
                entries: &[
                    entry(0, wgpu::BindingResource::TextureView(&view)),
                    entry(1, wgpu::BindingResource::Sampler(&self.sampler)),
                ],
            });
            self.bound = Some((picture.clone(), group));
        }
        let Some((_, group)) = &self.bound else { return };
        let [x, y, width, height] = area.map(|pixels| pixels as f32);
        pass.set_viewport(x, y, width, height, 0.0, 1.0);
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, group, &[]);
        pass.draw(0..3, 0..1);
    }
}
