//! The render pipelines of figures.

use super::targets::{COUNT, DEPTH, GLASS, INK, PICTURE};
use crate::drawing::{Line, Vertex};
use wgpu::{BlendComponent, BlendFactor, BlendOperation, BlendState, ColorTargetState, ColorWrites, CompareFunction};
use zfail_render::wgpu;

/// Everything that a canvas draws with.
#[derive(Debug)]
pub struct Pipelines {
    pub depth: wgpu::RenderPipeline,
    pub opaque: wgpu::RenderPipeline,
    pub tint: wgpu::RenderPipeline,
    pub glass: wgpu::RenderPipeline,
    pub ink: wgpu::RenderPipeline,
    pub hidden_ink: wgpu::RenderPipeline,
    pub mark: wgpu::RenderPipeline,
    /// Counting, without and with depth clamped by hand.
    pub count: [wgpu::RenderPipeline; 2],
    pub lay: wgpu::RenderPipeline,
    pub map: wgpu::RenderPipeline,
    pub letters: wgpu::RenderPipeline,
    /// Bindings of the frame, of the layers, of the counts and of the sheets.
    pub frame: wgpu::BindGroupLayout,
    pub layers: wgpu::BindGroupLayout,
    pub counts: wgpu::BindGroupLayout,
    pub sheets: wgpu::BindGroupLayout,
}

const VERTICES: wgpu::VertexBufferLayout<'_> = wgpu::VertexBufferLayout {
    array_stride: size_of::<Vertex>() as u64,
    step_mode: wgpu::VertexStepMode::Vertex,
    attributes: &wgpu::vertex_attr_array![0 => Float32x4, 1 => Unorm8x4, 2 => Float32],
};

const LINES: wgpu::VertexBufferLayout<'_> = wgpu::VertexBufferLayout {
    array_stride: size_of::<Line>() as u64,
    step_mode: wgpu::VertexStepMode::Instance,
    attributes: &wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x4, 2 => Unorm8x4, 3 => Float32x4],
};

/// Place, size and image size of a sticker.
pub const STICKER_BYTES: u64 = 32;
const STICKERS: wgpu::VertexBufferLayout<'_> = wgpu::VertexBufferLayout {
    array_stride: STICKER_BYTES,
    step_mode: wgpu::VertexStepMode::Instance,
    attributes: &wgpu::vertex_attr_array![0 => Float32x4, 1 => Sint32x2, 2 => Float32x2],
};

const fn component(src_factor: BlendFactor, dst_factor: BlendFactor) -> BlendComponent {
    BlendComponent { src_factor, dst_factor, operation: BlendOperation::Add }
}

const fn blend(component: BlendComponent) -> Option<BlendState> {
    Some(BlendState { color: component, alpha: component })
}

const SUM: Option<BlendState> = blend(component(BlendFactor::One, BlendFactor::One));
const OVER: Option<BlendState> = blend(component(BlendFactor::One, BlendFactor::OneMinusSrcAlpha));
const MIX: Option<BlendState> = Some(BlendState {
    color: component(BlendFactor::SrcAlpha, BlendFactor::OneMinusSrcAlpha),
    alpha: component(BlendFactor::Zero, BlendFactor::One),
});

const fn target(format: wgpu::TextureFormat, blend: Option<BlendState>) -> Option<ColorTargetState> {
    Some(ColorTargetState { format, blend, write_mask: ColorWrites::ALL })
}

impl Pipelines {
    pub fn new(device: &wgpu::Device, samples: u32) -> Self {
        let uniform = || wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let sampled = || wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: false },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let frame = layout(device, &[(0, uniform())]);
        let layers = layout(device, &[(0, sampled()), (1, sampled())]);
        let counts = layout(device, &[(2, sampled()), (3, uniform())]);
        let sheets = layout(device, &[(4, sampled())]);
        let figure = device.create_shader_module(wgpu::include_wgsl!("figure.wgsl"));
        let composite = device.create_shader_module(wgpu::include_wgsl!("composite.wgsl"));

        let space = Recipe {
            device,
            module: &figure,
            layout: &frame,
            vertex: "place",
            buffers: &[Some(VERTICES)],
            strip: false,
            samples,
            depth: None,
        };
        let (nearer, behind) = (CompareFunction::GreaterEqual, CompareFunction::LessEqual);
        let (solid, seen) = (Some((nearer, true)), Some((nearer, false)));
        let hidden = Some((CompareFunction::Less, false));
        // Each draws to one of the two layers of the pass.
        let to_ink = [target(GLASS, SUM), target(INK, OVER)];
        let strokes = Recipe { vertex: "stroke", buffers: &[Some(LINES)], strip: true, ..space };
        let single = Recipe { samples: 1, ..space };
        let screen =
            |layout| Recipe { module: &composite, layout, vertex: "cover", buffers: &[], strip: false, ..single };
        let stickers = Recipe { vertex: "stick", buffers: &[Some(STICKERS)], strip: true, ..screen(&sheets) };
        let counted = [target(COUNT, SUM)];
        let clamped = Recipe { vertex: "place_clamped", depth: Some((behind, false)), ..single };
        Self {
            depth: Recipe { depth: solid, ..space }.pipeline("depth", &[]),
            opaque: Recipe { depth: solid, ..space }.pipeline("opaque", &[target(PICTURE, None)]),
            tint: Recipe { depth: seen, ..space }.pipeline("tint", &to_ink),
            glass: Recipe { depth: seen, ..space }.pipeline("glass", &to_ink),
            ink: Recipe { depth: seen, ..strokes }.pipeline("ink", &to_ink),
            hidden_ink: Recipe { depth: hidden, ..strokes }.pipeline("hidden_ink", &to_ink),
            mark: Recipe { depth: solid, ..single }.pipeline("mark", &[target(COUNT, None)]),
            count: [
                Recipe { depth: Some((behind, false)), ..single }.pipeline("count", &counted),
                clamped.pipeline("count_clamped", &counted),
            ],
            lay: screen(&layers).pipeline("lay", &[target(PICTURE, OVER)]),
            map: screen(&counts).pipeline("map", &[target(PICTURE, MIX)]),
            letters: stickers.pipeline("letters", &[target(PICTURE, OVER)]),
            frame,
            layers,
            counts,
            sheets,
        }
    }
}

fn layout(device: &wgpu::Device, bindings: &[(u32, wgpu::BindingType)]) -> wgpu::BindGroupLayout {
    let entry = |&(binding, ty): &(u32, wgpu::BindingType)| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
        ty,
        count: None,
    };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("figure"),
        entries: &bindings.iter().map(entry).collect::<Vec<_>>(),
    })
}

/// What differs between pipelines, fragment stage aside.
#[derive(Clone, Copy)]
struct Recipe<'a> {
    device: &'a wgpu::Device,
    module: &'a wgpu::ShaderModule,
    layout: &'a wgpu::BindGroupLayout,
    vertex: &'a str,
    buffers: &'a [Option<wgpu::VertexBufferLayout<'a>>],
    /// Quads instead of triangles.
    strip: bool,
    samples: u32,
    /// How depth is tested, and whether it is written; `None` without depth.
    depth: Option<(CompareFunction, bool)>,
}

impl Recipe<'_> {
    fn pipeline(&self, fragment: &str, targets: &[Option<ColorTargetState>]) -> wgpu::RenderPipeline {
        let layout = self.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(fragment),
            bind_group_layouts: &[Some(self.layout)],
            immediate_size: 0,
        });
        let topology =
            if self.strip { wgpu::PrimitiveTopology::TriangleStrip } else { wgpu::PrimitiveTopology::TriangleList };
        self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(fragment),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: self.module,
                entry_point: Some(self.vertex),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: self.buffers,
            },
            primitive: wgpu::PrimitiveState { topology, ..wgpu::PrimitiveState::default() },
            depth_stencil: self.depth.map(|(compare, write)| wgpu::DepthStencilState {
                format: DEPTH,
                depth_write_enabled: Some(write),
                depth_compare: Some(compare),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
            multisample: wgpu::MultisampleState { count: self.samples, ..wgpu::MultisampleState::default() },
            fragment: Some(wgpu::FragmentState {
                module: self.module,
                entry_point: Some(fragment),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}
