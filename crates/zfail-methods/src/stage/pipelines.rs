//! The pipelines of the stage.
//!
//! In: what a pass does to the stencil. Out: pipelines that do that to volumes of either winding; and those of the depth
//! pass, of the verdict and of the instrumented run.

use crate::geometry::Placement;
use crate::procedure::Pass;
use std::collections::HashMap;
use wgpu::{
    BindGroupLayout, BindGroupLayoutDescriptor, BindGroupLayoutEntry, BindingType, BufferBindingType, ColorTargetState,
    CompareFunction, DepthStencilState, Device, Face, FrontFace, PipelineLayoutDescriptor, PrimitiveState,
    RenderPipeline, RenderPipelineDescriptor, ShaderModule, ShaderStages, StencilFaceState, StencilState,
    TextureFormat, VertexBufferLayout, VertexFormat, VertexState, VertexStepMode,
};
use zfail_render::Gpu;

/// The format of masks on the device.
pub const MASK: TextureFormat = TextureFormat::R8Unorm;

/// Pipelines of one device, made when they are first asked for.
#[derive(Debug)]
pub struct Pipelines {
    module: ShaderModule,
    depth_stencil: TextureFormat,
    /// Of the instrumented run: its counters.
    pub counters: BindGroupLayout,
    /// Depth of surfaces, by whether they mirror and are seen from both sides.
    pub surfaces: [[RenderPipeline; 2]; 2],
    pub verdict: RenderPipeline,
    volumes: HashMap<(Pass, bool), RenderPipeline>,
    counting: HashMap<(Option<Face>, bool), RenderPipeline>,
}

impl Pipelines {
    pub fn new(device: &Device, depth_stencil: TextureFormat) -> Self {
        let module = device.create_shader_module(wgpu::include_wgsl!("stage.wgsl"));
        let counters = device.create_bind_group_layout(&BindGroupLayoutDescriptor {
            label: Some("counters"),
            entries: &[BindGroupLayoutEntry {
                binding: 0,
                visibility: ShaderStages::FRAGMENT,
                ty: BindingType::Buffer {
                    ty: BufferBindingType::Storage { read_only: false },
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                count: None,
            }],
        });
        let depth = state(depth_stencil, true, CompareFunction::GreaterEqual, StencilState::default());
        let surfaces = surfaces(|primitive| {
            let recipe = Recipe { module: &module, layouts: &[], fragment: None, target: None, depth: &depth };
            recipe.pipeline(device, "place", SURFACE, primitive)
        });
        let equal = StencilFaceState { compare: CompareFunction::Equal, ..StencilFaceState::IGNORE };
        let unlit = StencilState { front: equal, back: equal, read_mask: 0xff, write_mask: 0 };
        let verdict = Recipe {
            module: &module,
            layouts: &[],
            fragment: Some("lit"),
            target: Some(MASK),
            depth: &state(depth_stencil, false, CompareFunction::Always, unlit),
        }
        .pipeline(device, "cover", &[], PrimitiveState::default());
        let (volumes, counting) = (HashMap::new(), HashMap::new());
        Self { module, depth_stencil, counters, surfaces, verdict, volumes, counting }
    }

    /// For volumes whose outside is `clockwise`, as `pass` counts them.
    pub fn volume(&mut self, device: &Device, pass: &Pass, clockwise: bool) -> &RenderPipeline {
        let (module, format) = (&self.module, self.depth_stencil);
        self.volumes.entry((*pass, clockwise)).or_insert_with(|| {
            let stencil = StencilState { front: pass.front, back: pass.back, read_mask: 0xff, write_mask: 0xff };
            let depth = &state(format, false, pass.depth, stencil);
            let recipe = Recipe { module, layouts: &[], fragment: None, target: None, depth };
            recipe.pipeline(device, "place", VOLUME, primitive(pass.cull, clockwise))
        })
    }

    /// For surfaces, from both sides, drawn to a depth of `format`.
    pub fn map(&self, device: &Device, format: TextureFormat) -> RenderPipeline {
        let depth = &state(format, true, CompareFunction::GreaterEqual, StencilState::default());
        let recipe = Recipe { module: &self.module, layouts: &[], fragment: None, target: None, depth };
        recipe.pipeline(device, "place", SURFACE, PrimitiveState::default())
    }

    /// For surfaces, from both sides, in an instrumented run that draws to a depth of `format`.
    pub fn counting_surfaces(&self, device: &Device, format: TextureFormat) -> RenderPipeline {
        let depth = &state(format, false, CompareFunction::Always, StencilState::default());
        let (module, layouts) = (&self.module, &[Some(&self.counters)]);
        let recipe = Recipe { module, layouts, fragment: Some("count"), target: None, depth };
        recipe.pipeline(device, "place", SURFACE, PrimitiveState::default())
    }

    /// For volumes in the instrumented run, which counts every fragment.
    pub fn counting(&mut self, device: &Device, cull: Option<Face>, clockwise: bool) -> &RenderPipeline {
        let (module, format, counters) = (&self.module, self.depth_stencil, &self.counters);
        self.counting.entry((cull, clockwise)).or_insert_with(|| {
            let depth = &state(format, false, CompareFunction::Always, StencilState::default());
            let recipe = Recipe { module, layouts: &[Some(counters)], fragment: Some("count"), target: None, depth };
            recipe.pipeline(device, "place", VOLUME, primitive(cull, clockwise))
        })
    }
}

/// What draws every visible surface and writes its verdict.
#[derive(Debug)]
pub struct Surfaces {
    pub pipelines: [[RenderPipeline; 2]; 2],
    pub bind_group: wgpu::BindGroup,
}

impl Surfaces {
    /// With a fragment program that has the entry point `lit` and the resources of `layout`; `extensions` are those that it
    /// enables.
    pub fn new(
        gpu: &Gpu,
        [extensions, program]: [&str; 2],
        layout: &BindGroupLayout,
        entries: &[wgpu::BindGroupEntry<'_>],
    ) -> Self {
        let source = [extensions, include_str!("surface.wgsl"), program].concat();
        let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("surfaces"),
            source: wgpu::ShaderSource::Wgsl(source.into()),
        });
        let depth = state(gpu.depth_stencil, false, CompareFunction::GreaterEqual, StencilState::default());
        let layouts = &[Some(layout)];
        let pipelines = surfaces(|primitive| {
            let recipe = Recipe { module: &module, layouts, fragment: Some("lit"), target: Some(MASK), depth: &depth };
            recipe.pipeline(&gpu.device, "place", SURFACE, primitive)
        });
        let label = Some("surfaces");
        let bind_group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label, layout, entries });
        Self { pipelines, bind_group }
    }
}

/// One pipeline for surfaces that mirror or not, and are seen from both sides or not.
fn surfaces(mut make: impl FnMut(PrimitiveState) -> RenderPipeline) -> [[RenderPipeline; 2]; 2] {
    [false, true].map(|mirrored| {
        [false, true].map(|double_sided| make(primitive((!double_sided).then_some(Face::Back), mirrored)))
    })
}

fn primitive(cull_mode: Option<Face>, clockwise: bool) -> PrimitiveState {
    let front_face = if clockwise { FrontFace::Cw } else { FrontFace::Ccw };
    PrimitiveState { front_face, cull_mode, ..PrimitiveState::default() }
}

/// A depth and stencil test without bias.
fn state(format: TextureFormat, write: bool, compare: CompareFunction, stencil: StencilState) -> DepthStencilState {
    let (depth_write_enabled, depth_compare) = (Some(write), Some(compare));
    DepthStencilState { format, depth_write_enabled, depth_compare, stencil, bias: wgpu::DepthBiasState::default() }
}

/// What pipelines of this crate differ in.
struct Recipe<'a> {
    pub module: &'a ShaderModule,
    pub layouts: &'a [Option<&'a BindGroupLayout>],
    pub fragment: Option<&'a str>,
    pub target: Option<TextureFormat>,
    pub depth: &'a DepthStencilState,
}

impl Recipe<'_> {
    fn pipeline(
        &self,
        device: &Device,
        vertex: &str,
        buffers: &[Option<VertexBufferLayout<'_>>],
        primitive: PrimitiveState,
    ) -> RenderPipeline {
        let layout = device.create_pipeline_layout(&PipelineLayoutDescriptor {
            label: Some("stage"),
            bind_group_layouts: self.layouts,
            immediate_size: 0,
        });
        let targets: Vec<Option<ColorTargetState>> =
            self.target.map(|format| Some(format.into())).into_iter().collect();
        device.create_render_pipeline(&RenderPipelineDescriptor {
            label: Some("stage"),
            layout: Some(&layout),
            vertex: VertexState {
                module: self.module,
                entry_point: Some(vertex),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers,
            },
            primitive,
            depth_stencil: Some(self.depth.clone()),
            multisample: wgpu::MultisampleState::default(),
            fragment: self.fragment.map(|entry| wgpu::FragmentState {
                module: self.module,
                entry_point: Some(entry),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

/// A [`Placement`] per instance.
const PLACEMENT: VertexBufferLayout<'static> = VertexBufferLayout {
    array_stride: size_of::<Placement>() as u64,
    step_mode: VertexStepMode::Instance,
    attributes: &wgpu::vertex_attr_array![
        1 => Float32x4, 2 => Float32x4, 3 => Float32x4, 4 => Float32x4, 5 => Float32x4, 6 => Float32x4, 7 => Float32x4
    ],
};

/// Three floats: the device adds a w of 1.
const SURFACE: &[Option<VertexBufferLayout<'static>>] = &[
    Some(VertexBufferLayout {
        array_stride: 12,
        step_mode: VertexStepMode::Vertex,
        attributes: &[wgpu::VertexAttribute { format: VertexFormat::Float32x3, offset: 0, shader_location: 0 }],
    }),
    Some(PLACEMENT),
];

/// Homogeneous.
const VOLUME: &[Option<VertexBufferLayout<'static>>] = &[
    Some(VertexBufferLayout {
        array_stride: 16,
        step_mode: VertexStepMode::Vertex,
        attributes: &[wgpu::VertexAttribute { format: VertexFormat::Float32x4, offset: 0, shader_location: 0 }],
    }),
    Some(PLACEMENT),
];
