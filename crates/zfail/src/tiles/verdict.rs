//! The way of tile verdicts into the stencil.
//!
//! In: one bit a pixel and light, from the compute pass. Out: a mark in the stencil of pixels in shadow.

use crate::pipelines::Target;
use wgpu::{
    BindGroup, BindGroupLayout, BindGroupLayoutDescriptor, ColorTargetState, ColorWrites, CompareFunction,
    DepthBiasState, DepthStencilState, Device, FragmentState, MultisampleState, PipelineCompilationOptions,
    PipelineLayoutDescriptor, PrimitiveState, RenderPass, RenderPipeline, RenderPipelineDescriptor, ShaderStages,
    StencilFaceState, StencilOperation, StencilState, TextureSampleType, TextureViewDimension, VertexState,
};

/// What the stencil holds where the tile pass finds shadow.
const SHADOWED: u32 = 0x80;

/// Marks pixels in shadow, for one [`Target`].
#[derive(Debug)]
pub struct VerdictPipeline(RenderPipeline);

/// What `verdict.wgsl` binds.
pub(super) fn layout(device: &Device) -> BindGroupLayout {
    let bits = (TextureSampleType::Uint, TextureViewDimension::D2Array);
    device.create_bind_group_layout(&BindGroupLayoutDescriptor {
        label: Some("tile verdict"),
        entries: &[super::sampled(0, ShaderStages::FRAGMENT, bits.0, bits.1)],
    })
}

impl VerdictPipeline {
    /// The pipeline for passes with the formats of `target`; `None` for multisampled targets, whose samples the tile pass
    /// does not see.
    #[must_use]
    pub fn new(device: &Device, target: &Target<'_>) -> Option<Self> {
        if target.samples != 1 {
            return None;
        }
        let module = device.create_shader_module(wgpu::include_wgsl!("verdict.wgsl"));
        let layout = device.create_pipeline_layout(&PipelineLayoutDescriptor {
            label: Some("tile verdict"),
            bind_group_layouts: &[Some(&layout(device))],
            immediate_size: 0,
        });
        let face = StencilFaceState { pass_op: StencilOperation::Replace, ..StencilFaceState::IGNORE };
        let untouched = |format| ColorTargetState { format, blend: None, write_mask: ColorWrites::empty() };
        let colors: Vec<_> = target.colors.iter().map(|format| format.map(untouched)).collect();
        Some(Self(device.create_render_pipeline(&RenderPipelineDescriptor {
            label: Some("tile verdict"),
            layout: Some(&layout),
            vertex: VertexState {
                module: &module,
                entry_point: None,
                compilation_options: PipelineCompilationOptions::default(),
                buffers: &[],
            },
            primitive: PrimitiveState::default(),
            depth_stencil: Some(DepthStencilState {
                format: target.depth_stencil,
                depth_write_enabled: Some(false),
                depth_compare: Some(CompareFunction::Always),
                stencil: StencilState { front: face, back: face, read_mask: 0, write_mask: 0xff },
                bias: DepthBiasState::default(),
            }),
            multisample: MultisampleState::default(),
            fragment: Some(FragmentState {
                module: &module,
                entry_point: None,
                compilation_options: PipelineCompilationOptions::default(),
                targets: &colors,
            }),
            multiview_mask: None,
            cache: None,
        })))
    }

    /// Marks the pixels in the shadow of the tile pass's `light`.
    pub(super) fn draw(&self, pass: &mut RenderPass<'_>, bindings: &BindGroup, light: u32) {
        pass.set_pipeline(&self.0);
        pass.set_bind_group(0, bindings, &[]);
        pass.set_stencil_reference(SHADOWED);
        pass.draw(0..3, light..light + 1);
    }
}
