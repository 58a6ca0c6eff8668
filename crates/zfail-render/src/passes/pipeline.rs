//! Pipeline creation: what all of this crate's render pipelines have in common.

use crate::passes::shader::Program;
use crate::scene::geometry::Vertices;

/// What differs between render pipelines.
pub struct Recipe<'a> {
    pub program: Program,
    /// Fragment entry point.
    pub entry: &'a str,
    /// Override constants.
    pub constants: &'a [(&'a str, f64)],
    pub groups: &'a [&'a wgpu::BindGroupLayout],
    pub targets: &'a [Option<wgpu::ColorTargetState>],
    pub depth_stencil: Option<wgpu::DepthStencilState>,
    pub samples: u32,
}

impl Recipe<'_> {
    /// A pipeline over the whole screen, with `cover` as its vertex stage.
    pub fn screen(&self, device: &wgpu::Device) -> wgpu::RenderPipeline {
        self.create(device, "cover", &[], wgpu::PrimitiveState::default())
    }

    /// A pipeline over the scene's triangles, with `place` as its vertex stage; culls `cull` as seen after a mirroring
    /// is undone.
    pub fn scene(
        &self,
        device: &wgpu::Device,
        vertices: Vertices,
        mirrored: bool,
        cull: Option<wgpu::Face>,
    ) -> wgpu::RenderPipeline {
        let front_face = if mirrored { wgpu::FrontFace::Cw } else { wgpu::FrontFace::Ccw };
        let primitive = wgpu::PrimitiveState { front_face, cull_mode: cull, ..Default::default() };
        self.create(device, "place", vertices.buffers(), primitive)
    }

    fn create(
        &self,
        device: &wgpu::Device,
        vertex: &str,
        buffers: &[Option<wgpu::VertexBufferLayout<'_>>],
        primitive: wgpu::PrimitiveState,
    ) -> wgpu::RenderPipeline {
        let module = self.program.module(device);
        let groups: Vec<_> = self.groups.iter().copied().map(Some).collect();
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(self.program.name),
            bind_group_layouts: &groups,
            immediate_size: 0,
        });
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(self.program.name),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some(vertex),
                compilation_options: Default::default(),
                buffers,
            },
            primitive,
            depth_stencil: self.depth_stencil.clone(),
            multisample: wgpu::MultisampleState { count: self.samples, ..Default::default() },
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some(self.entry),
                compilation_options: wgpu::PipelineCompilationOptions {
                    constants: self.constants,
                    ..Default::default()
                },
                targets: self.targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

/// Depth-stencil state of surfaces that are drawn where `compare` holds.
pub fn depth_test(format: wgpu::TextureFormat, compare: wgpu::CompareFunction, write: bool) -> wgpu::DepthStencilState {
    wgpu::DepthStencilState {
        format,
        depth_write_enabled: Some(write),
        depth_compare: Some(compare),
        stencil: wgpu::StencilState::default(),
        bias: wgpu::DepthBiasState::default(),
    }
}

/// Adds to what the target holds.
pub const ADD: wgpu::BlendState = {
    let add = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor: wgpu::BlendFactor::One,
        operation: wgpu::BlendOperation::Add,
    };
    wgpu::BlendState { color: add, alpha: add }
};

/// A depth-stencil attachment that starts empty: infinitely far, and lit.
pub fn cleared_depth(view: &wgpu::TextureView) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
        stencil_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0), store: wgpu::StoreOp::Store }),
    }
}

/// The attachment of a pass that keeps the depth that is there, with a stencil of 0.
pub fn continued_depth(view: &wgpu::TextureView) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment {
        depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store }),
        ..cleared_depth(view)
    }
}

/// A colour attachment that continues what `view` holds.
pub fn continued(view: &wgpu::TextureView) -> Option<wgpu::RenderPassColorAttachment<'_>> {
    attachment(view, wgpu::LoadOp::Load)
}

/// A colour attachment that starts from `color`.
pub fn cleared(view: &wgpu::TextureView, color: [f64; 4]) -> Option<wgpu::RenderPassColorAttachment<'_>> {
    let [r, g, b, a] = color;
    attachment(view, wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a }))
}

fn attachment(
    view: &wgpu::TextureView,
    load: wgpu::LoadOp<wgpu::Color>,
) -> Option<wgpu::RenderPassColorAttachment<'_>> {
    let ops = wgpu::Operations { load, store: wgpu::StoreOp::Store };
    Some(wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops })
}

/// A depth-stencil attachment that is only tested against.
pub fn read_only(view: &wgpu::TextureView) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment { view, depth_ops: None, stencil_ops: None }
}
