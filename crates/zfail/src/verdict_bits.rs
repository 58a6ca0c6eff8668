//! Verdicts as a texture: one bit per light, for material shaders to look up, whatever pass they run in.
//!
//! In: a prepared frame and the finished depth. Out: a colour target whose texels hold the verdicts of 32 lights. The stencil
//! serves one light after the other in between, so renderers whose lighting is one pass, or many, need not give that up.

use crate::pipelines::{Pipelines, Target};
use crate::prepared::Prepared;
use crate::shadows::Shadows;
use wgpu::{
    BlendComponent, BlendFactor, BlendOperation, BlendState, ColorTargetState, ColorWrites, CommandEncoder,
    CompareFunction, DepthBiasState, DepthStencilState, Device, FragmentState, LoadOp, MultisampleState, Operations,
    PipelineCompilationOptions, PipelineLayoutDescriptor, PrimitiveState, RenderPass, RenderPassColorAttachment,
    RenderPassDepthStencilAttachment, RenderPassDescriptor, RenderPipeline, RenderPipelineDescriptor, ShaderModule,
    StencilFaceState, StencilOperation, StencilState, StoreOp, TextureFormat, TextureView, VertexState,
};

/// Lights that share a channel.
const PER_CHANNEL: u32 = 8;

/// Pipelines that count volumes and keep what they find, for one sample count.
///
/// A texel is `Rgba8Unorm`, which every device renders to, blends and multisamples; bit `b` of it is set where the light does
/// *not* arrive. A shader asks with [`VerdictBits::LOOKUP`]:
///
/// ```wgsl
/// let texel = textureLoad(verdicts, vec2<u32>(fragment.position.xy), 0);
/// if zfail_is_lit(texel, light) { radiance += contribution_of(light); }
/// ```
///
/// Of a texture with several samples it takes its own, by `@builtin(sample_index)`.
///
/// ```
/// use zfail::{Prepared, Shadows, VerdictBits, wgpu};
///
/// /// Once, beside the device.
/// fn pipelines(shadows: &Shadows, depth_stencil: wgpu::TextureFormat) -> VerdictBits {
///     VerdictBits::new(shadows, depth_stencil, 1)
/// }
///
/// /// Every frame, between the depth pass and whatever passes light surfaces.
/// fn verdicts(
///     bits: &VerdictBits,
///     encoder: &mut wgpu::CommandEncoder,
///     prepared: &Prepared<'_>,
///     texture: &wgpu::TextureView,
///     depth_stencil: &wgpu::TextureView,
/// ) {
///     bits.encode(encoder, prepared, 0, texture, depth_stencil);
/// }
/// ```
#[derive(Debug)]
pub struct VerdictBits {
    volumes: Pipelines,
    /// One per channel.
    keep: [RenderPipeline; 4],
}

impl VerdictBits {
    /// The format of the texture; its usages are `RENDER_ATTACHMENT` and `TEXTURE_BINDING`, its size and samples are those of
    /// the depth-stencil target.
    pub const FORMAT: TextureFormat = TextureFormat::Rgba8Unorm;
    /// Lights whose verdicts fit a texel. For more, there are more textures.
    pub const LIGHTS: usize = 32;
    /// WGSL source of `fn zfail_is_lit(texel: vec4<f32>, bit: u32) -> bool`, to be put before a shader's own.
    pub const LOOKUP: &'static str = include_str!("verdict_bits_lookup.wgsl");

    /// Pipelines for targets of this depth-stencil format and so many samples per pixel.
    #[must_use]
    pub fn new(shadows: &Shadows, depth_stencil: TextureFormat, samples: u32) -> Self {
        let device = &shadows.device;
        let module = device.create_shader_module(wgpu::include_wgsl!("verdict_bits.wgsl"));
        let keep = [ColorWrites::RED, ColorWrites::GREEN, ColorWrites::BLUE, ColorWrites::ALPHA]
            .map(|channel| keep(device, &module, depth_stencil, samples, channel));
        let target = Target { colors: &[Some(Self::FORMAT)], depth_stencil, samples };
        Self { volumes: shadows.pipelines(&target), keep }
    }

    /// Encodes a pass that fills `verdicts` with the lights from number `first` on, the first of them in bit 0, as many as fit.
    /// `depth_stencil` holds the finished depth of the view; its stencil is cleared and left undefined.
    pub fn encode(
        &self,
        encoder: &mut CommandEncoder,
        prepared: &Prepared<'_>,
        first: usize,
        verdicts: &TextureView,
        depth_stencil: &TextureView,
    ) {
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("verdicts"),
            color_attachments: &[Some(RenderPassColorAttachment {
                view: verdicts,
                depth_slice: None,
                resolve_target: None,
                ops: Operations { load: LoadOp::Clear(wgpu::Color::TRANSPARENT), store: StoreOp::Store },
            })],
            depth_stencil_attachment: Some(RenderPassDepthStencilAttachment {
                view: depth_stencil,
                depth_ops: Some(Operations { load: LoadOp::Load, store: StoreOp::Store }),
                stencil_ops: Some(Operations { load: LoadOp::Clear(0), store: StoreOp::Discard }),
            }),
            ..RenderPassDescriptor::default()
        });
        for (bit, light) in (first..prepared.lights()).take(Self::LIGHTS).enumerate() {
            self.draw(&mut pass, prepared, light, bit);
        }
    }

    /// Encodes one light into a pass of the host's own, whose only colour attachment is the texture, cleared to 0, and whose
    /// stencil is 0, as it is again afterwards. Does nothing for a `bit` from [`Self::LIGHTS`] on.
    ///
    /// Sets what [`Prepared::draw`] sets.
    pub fn draw(&self, pass: &mut RenderPass<'_>, prepared: &Prepared<'_>, light: usize, bit: usize) {
        let (Some([x, y, width, height]), Some(keep)) =
            (prepared.shadowed(light), self.keep.get(bit / PER_CHANNEL as usize))
        else {
            return;
        };
        prepared.draw(pass, &self.volumes, light);
        let bit = bit as u32 % PER_CHANNEL;
        pass.set_scissor_rect(x, y, width, height);
        pass.set_stencil_reference(0);
        pass.set_pipeline(keep);
        pass.draw(0..3, bit..bit + 1);
        let [x, y, width, height] = prepared.shadows.image;
        pass.set_scissor_rect(x, y, width, height);
    }
}

/// The pipeline that adds a bit to one channel where the stencil is not 0, and makes it 0.
fn keep(
    device: &Device,
    module: &ShaderModule,
    depth_stencil: TextureFormat,
    samples: u32,
    channel: ColorWrites,
) -> RenderPipeline {
    let face = StencilFaceState {
        compare: CompareFunction::NotEqual,
        fail_op: StencilOperation::Keep,
        depth_fail_op: StencilOperation::Zero,
        pass_op: StencilOperation::Zero,
    };
    let add =
        BlendComponent { src_factor: BlendFactor::One, dst_factor: BlendFactor::One, operation: BlendOperation::Add };
    let layout = PipelineLayoutDescriptor { label: Some("keep verdict"), bind_group_layouts: &[], immediate_size: 0 };
    device.create_render_pipeline(&RenderPipelineDescriptor {
        label: Some("keep verdict"),
        layout: Some(&device.create_pipeline_layout(&layout)),
        vertex: VertexState {
            module,
            entry_point: None,
            compilation_options: PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: PrimitiveState::default(),
        depth_stencil: Some(DepthStencilState {
            format: depth_stencil,
            depth_write_enabled: Some(false),
            depth_compare: Some(CompareFunction::Always),
            stencil: StencilState { front: face, back: face, read_mask: 0xff, write_mask: 0xff },
            bias: DepthBiasState::default(),
        }),
        multisample: MultisampleState { count: samples, ..MultisampleState::default() },
        fragment: Some(FragmentState {
            module,
            entry_point: None,
            compilation_options: PipelineCompilationOptions::default(),
            targets: &[Some(ColorTargetState {
                format: VerdictBits::FORMAT,
                blend: Some(BlendState { color: add, alpha: add }),
                write_mask: channel,
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}
