//! The render pipelines of shadow determination: stencil operations and nothing else.
//!
//! In: the formats of the host's pass. Out: pipelines for volumes (z-pass and z-fail, both windings, plain and batched
//! counting, with and without depth clamping) and for folding a batch's counts into the sticky bit.
//!
//! z-fail (Bilodeau & Songy 1999; Carmack 2000): where a face of the volume lies at or behind the visible surface, a
//! front face decrements and a back face increments, wrapping, so that their order does not matter. Front and back are
//! told apart in one draw (E&K 2002, section 4.3, "Two-Sided Stencil Testing"). z-pass (Heidmann 1991) does the opposite
//! where a face lies in front of the visible surface. Both test depth strictly: what coincides with the surface is behind.
//! Only clamped depths are in front where they are equal: what lies before the near plane is clamped to 1, and a surface that
//! the near plane cuts can have that very depth.

use crate::tiles::VerdictPipeline;
use wgpu::{
    BindGroupLayout, BlendComponent, BlendFactor, BlendOperation, BlendState, ColorTargetState, ColorWrites,
    CompareFunction, DepthStencilState, Device, Features, FragmentState, FrontFace, MultisampleState,
    PipelineCompilationOptions, PipelineLayoutDescriptor, PrimitiveState, RenderPipeline, RenderPipelineDescriptor,
    ShaderModule, StencilFaceState, StencilOperation, StencilState, TextureFormat, VertexState,
};

/// The formats of the pass into which shadows are encoded.
#[derive(Clone, Copy, Debug)]
pub struct Target<'a> {
    /// Formats of the colour attachments; they are left untouched. Empty for a pass of its own.
    pub colors: &'a [Option<TextureFormat>],
    /// Format of the depth-stencil attachment.
    pub depth_stencil: TextureFormat,
    /// Samples per pixel.
    pub samples: u32,
}

/// Stencil state for the host's illumination: passes where the light arrives. Use it with stencil reference 0.
#[must_use]
pub fn lit_stencil() -> StencilState {
    let face = StencilFaceState { compare: CompareFunction::Equal, ..StencilFaceState::IGNORE };
    StencilState { front: face, back: face, read_mask: 0xff, write_mask: 0 }
}

/// Marks samples as shadowed for good, whatever further batches count.
pub(crate) const STICKY: u32 = 0x80;
/// The bits in which a batch counts when there are several.
const BATCH_MASK: u32 = 0x7f;

/// Pipelines for one [`Target`].
#[derive(Debug)]
pub struct Pipelines {
    /// Counting in front of the visible surface: nothing there is near the far plane.
    z_pass: Set,
    /// For everything that lies before the far plane, be it at infinity.
    plain: Set,
    /// For what a finite far plane would clip: depth is clamped.
    clamped: Set,
    /// Sets every count to the reference.
    pub(crate) start: RenderPipeline,
    pub(crate) fold: RenderPipeline,
    /// Brings the tile pass's verdicts in; none for multisampled targets.
    pub(crate) tiles: Option<VerdictPipeline>,
}

/// Pipelines that differ in winding and counting, by `[batched][clockwise]`.
type Set = [[RenderPipeline; 2]; 2];

/// What a draw needs of its pipeline.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Variant {
    /// Counts fragments in front of the visible surface.
    pub z_pass: bool,
    /// The view has a far plane, before infinity.
    pub far_plane: bool,
    /// Counts go to seven bits only.
    pub batched: bool,
    /// The outside of the geometry is wound clockwise.
    pub clockwise: bool,
}

impl Pipelines {
    pub(crate) fn new(device: &Device, layout: &BindGroupLayout, module: &ShaderModule, target: &Target<'_>) -> Self {
        Self::made_by(&Maker { device, layout, module, target, counter: false })
    }

    /// Pipelines that leave the stencil as it is, and add 1 to the first colour attachment for every fragment of a volume.
    pub(crate) fn counting_fragments(
        device: &Device,
        layout: &BindGroupLayout,
        module: &ShaderModule,
        target: &Target<'_>,
    ) -> Self {
        Self { tiles: None, ..Self::made_by(&Maker { device, layout, module, target, counter: true }) }
    }

    fn made_by(maker: &Maker<'_>) -> Self {
        let Maker { device, target, .. } = maker;
        Self {
            z_pass: maker.set("volume", None, false, true, CompareFunction::Greater),
            plain: maker.set("volume", None, false, false, CompareFunction::Greater),
            clamped: maker.clamped(),
            start: maker.start(),
            fold: maker.fold(),
            tiles: VerdictPipeline::new(device, target),
        }
    }

    /// The pipeline for sides and dark caps.
    pub(crate) fn extruded(&self, v: Variant) -> &RenderPipeline {
        let set = match (v.z_pass, v.far_plane) {
            // Clamped, volumes in front of the near plane would count; clipped at the far plane, nothing is missed.
            (true, _) => &self.z_pass,
            (false, true) => &self.clamped,
            (false, false) => &self.plain,
        };
        &set[usize::from(v.batched)][usize::from(v.clockwise)]
    }

    /// The pipeline for light caps. They need the depth of the depth pass to the last bit, so they are clipped as it is,
    /// and no fragment shader may compute it; like the surfaces they belong to, none lies beyond the far plane.
    pub(crate) fn light_cap(&self, v: Variant) -> &RenderPipeline {
        let set = if v.z_pass { &self.z_pass } else { &self.plain };
        &set[usize::from(v.batched)][usize::from(v.clockwise)]
    }
}

struct Maker<'a> {
    device: &'a Device,
    layout: &'a BindGroupLayout,
    module: &'a ShaderModule,
    target: &'a Target<'a>,
    /// Whether volumes add to the first colour attachment instead of counting in the stencil.
    counter: bool,
}

impl Maker<'_> {
    fn clamped(&self) -> Set {
        let compare = CompareFunction::GreaterEqual;
        if self.device.features().contains(Features::DEPTH_CLIP_CONTROL) {
            self.set("volume", None, true, false, compare)
        } else {
            self.set("clamped_volume", Some("clamped_depth"), false, false, compare)
        }
    }

    fn set(
        &self,
        vertex: &str,
        fragment: Option<&str>,
        unclipped_depth: bool,
        z_pass: bool,
        compare: CompareFunction,
    ) -> Set {
        let (up, down) = (StencilOperation::IncrementWrap, StencilOperation::DecrementWrap);
        let (front, back) = if z_pass { (in_front(up), in_front(down)) } else { (behind(down), behind(up)) };
        [false, true].map(|batched| {
            [FrontFace::Ccw, FrontFace::Cw].map(|front_face| {
                let stencil =
                    StencilState { front, back, read_mask: 0, write_mask: if batched { BATCH_MASK } else { 0xff } };
                let primitive = PrimitiveState { front_face, unclipped_depth, ..PrimitiveState::default() };
                if self.counter {
                    let (all, none) = (CompareFunction::Always, StencilState::default());
                    return self.pipeline(vertex, Some("one"), primitive, all, none);
                }
                self.pipeline(vertex, fragment, primitive, compare, stencil)
            })
        })
    }

    fn start(&self) -> RenderPipeline {
        let face = StencilFaceState { pass_op: StencilOperation::Replace, ..KEEP };
        let stencil = StencilState { front: face, back: face, read_mask: 0, write_mask: 0xff };
        self.pipeline("image", None, PrimitiveState::default(), CompareFunction::Always, stencil)
    }

    /// Where a batch left a count, sets the sticky bit and clears the count.
    fn fold(&self) -> RenderPipeline {
        let face = StencilFaceState {
            compare: CompareFunction::NotEqual,
            pass_op: StencilOperation::Replace,
            ..StencilFaceState::IGNORE
        };
        let stencil = StencilState { front: face, back: face, read_mask: BATCH_MASK, write_mask: 0xff };
        self.pipeline("image", None, PrimitiveState::default(), CompareFunction::Always, stencil)
    }

    fn pipeline(
        &self,
        vertex: &str,
        fragment: Option<&str>,
        primitive: PrimitiveState,
        depth_compare: CompareFunction,
        stencil: StencilState,
    ) -> RenderPipeline {
        let layout = self.device.create_pipeline_layout(&PipelineLayoutDescriptor {
            label: Some("shadow volume"),
            bind_group_layouts: &[Some(self.layout)],
            immediate_size: 0,
        });
        let adds = fragment == Some("one");
        let write_mask = if adds { ColorWrites::ALL } else { ColorWrites::empty() };
        let blend = adds.then_some(ADD);
        let colors = self.target.colors.iter();
        let targets: Vec<Option<ColorTargetState>> =
            colors.map(|format| format.map(|format| ColorTargetState { format, blend, write_mask })).collect();
        // A pass with colour attachments wants a fragment stage that names them.
        let fragment = fragment.or((!targets.is_empty()).then_some("nothing"));
        self.device.create_render_pipeline(&RenderPipelineDescriptor {
            label: Some("shadow volume"),
            layout: Some(&layout),
            vertex: VertexState {
                module: self.module,
                entry_point: Some(vertex),
                compilation_options: PipelineCompilationOptions::default(),
                buffers: &[],
            },
            primitive,
            depth_stencil: Some(DepthStencilState {
                format: self.target.depth_stencil,
                depth_write_enabled: Some(false),
                depth_compare: Some(depth_compare),
                stencil,
                bias: wgpu::DepthBiasState::default(),
            }),
            multisample: MultisampleState { count: self.target.samples, ..MultisampleState::default() },
            fragment: fragment.map(|entry| FragmentState {
                module: self.module,
                entry_point: Some(entry),
                compilation_options: PipelineCompilationOptions::default(),
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

const ADD: BlendState = BlendState {
    color: BlendComponent {
        src_factor: BlendFactor::One,
        dst_factor: BlendFactor::One,
        operation: BlendOperation::Add,
    },
    alpha: BlendComponent::REPLACE,
};

/// Counts fragments that fail the depth test: those at or behind the visible surface, for the test is strict.
const fn behind(operation: StencilOperation) -> StencilFaceState {
    StencilFaceState { depth_fail_op: operation, ..KEEP }
}

/// Counts fragments that pass the depth test: those in front of the visible surface.
const fn in_front(operation: StencilOperation) -> StencilFaceState {
    StencilFaceState { pass_op: operation, ..KEEP }
}

const KEEP: StencilFaceState = StencilFaceState {
    compare: CompareFunction::Always,
    fail_op: StencilOperation::Keep,
    depth_fail_op: StencilOperation::Keep,
    pass_op: StencilOperation::Keep,
};
