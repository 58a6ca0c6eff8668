//! The stencil buffer as an image: the verdict within a light's reach, or the count itself.

use crate::passes::frame::FrameData;
use crate::passes::own_shadow::OwnShadow;
use crate::passes::pipeline::{ADD, Recipe, cleared, read_only};
use crate::passes::targets::{Attributes, view};
use crate::scene::SceneOnGpu;
use crate::scene::layouts::Layouts;
use crate::{Gpu, RenderError, device::read_back, passes::shader};

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R8Unorm;

/// Pipelines that turn the stencil buffer into grey.
#[derive(Debug)]
pub struct MaskPass {
    reached: wgpu::RenderPipeline,
    /// One per bit. Not every backend copies stencil buffers, but all test them.
    bits: [wgpu::RenderPipeline; 8],
    own_shadow: OwnShadow,
}

/// What the image shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mask {
    /// 255 where the stencil is 0 and the light reaches the surface, else 0.
    Reached,
    /// The stencil's value, 0 where there is no surface.
    Count,
}

impl MaskPass {
    pub fn new(gpu: &Gpu, layouts: &Layouts) -> Self {
        let create = |entry, constants: &[(&str, f64)], depth_stencil, blend| {
            Recipe {
                program: shader::MASK,
                entry,
                constants,
                groups: &[&layouts.frame, &layouts.attributes],
                targets: &[Some(wgpu::ColorTargetState { format: FORMAT, blend, write_mask: wgpu::ColorWrites::ALL })],
                depth_stencil: Some(depth_stencil),
                samples: 1,
            }
            .screen(&gpu.device)
        };
        let bits = std::array::from_fn(|bit| {
            let face =
                wgpu::StencilFaceState { compare: wgpu::CompareFunction::NotEqual, ..wgpu::StencilFaceState::IGNORE };
            let stencil = wgpu::StencilState { front: face, back: face, read_mask: 1 << bit, write_mask: 0 };
            let state = wgpu::DepthStencilState { stencil, ..lit(gpu) };
            create("counted", &[("BIT", f64::from(1 << bit))], state, Some(ADD))
        });
        let own_shadow = OwnShadow::new(gpu, layouts, FORMAT);
        Self { reached: create("reached", &[], lit(gpu), None), bits, own_shadow }
    }

    /// Renders and reads the image of light `light` of the frame, one byte per pixel. `casting` is the scene, and which of its
    /// lights that is, if it has shadows.
    #[expect(clippy::too_many_arguments, reason = "the state of a pass")]
    pub fn read(
        &self,
        gpu: &Gpu,
        mut encoder: wgpu::CommandEncoder,
        targets: &Attributes,
        frame: &FrameData,
        light: u32,
        mask: Mask,
        casting: Option<(&SceneOnGpu, usize)>,
    ) -> Result<Vec<u8>, RenderError> {
        let image = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("mask"),
            size: targets.depth.size(),
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let target = view(&image);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("mask"),
            color_attachments: &[cleared(&target, [0.0; 4])],
            depth_stencil_attachment: Some(read_only(&targets.depth_stencil)),
            ..Default::default()
        });
        pass.set_bind_group(0, &frame.bind_group, &[]);
        pass.set_bind_group(1, &targets.bind_group, &[]);
        pass.set_stencil_reference(0);
        let pipelines = match mask {
            Mask::Reached => std::slice::from_ref(&self.reached),
            Mask::Count => &self.bits,
        };
        for pipeline in pipelines {
            pass.set_pipeline(pipeline);
            pass.draw(0..3, light..light + 1);
        }
        if let Some((scene, of_scene)) = casting.filter(|_| mask == Mask::Reached) {
            self.own_shadow.draw(gpu, &mut pass, frame, scene, light, of_scene);
        }
        drop(pass);
        gpu.queue.submit([encoder.finish()]);
        read_back::texture(gpu, &image)
    }
}

/// Depth-stencil state of a screen pass that goes through where the stencil says lit.
fn lit(gpu: &Gpu) -> wgpu::DepthStencilState {
    wgpu::DepthStencilState {
        format: gpu.depth_stencil,
        depth_write_enabled: Some(false),
        depth_compare: Some(wgpu::CompareFunction::Always),
        stencil: zfail::lit_stencil(),
        bias: wgpu::DepthBiasState::default(),
    }
}
