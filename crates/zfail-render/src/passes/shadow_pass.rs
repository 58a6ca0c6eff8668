//! The stencil verdict of one light: 0 where it shines, by way of the crate `zfail`, and on everything on which no shadow falls.

use crate::Gpu;
use crate::passes::frame::FrameData;
use crate::passes::pipeline::{Recipe, depth_test};
use crate::passes::shader;
use crate::passes::targets::Attributes;
use crate::scene::SceneOnGpu;
use crate::scene::geometry::Vertices;
use crate::scene::layouts::Layouts;

/// Pipelines of the pass.
#[derive(Debug)]
pub struct ShadowPass {
    pipelines: zfail::Pipelines,
    /// Sets the stencil to 0 where a surface is the visible one.
    exempt: wgpu::RenderPipeline,
}

impl ShadowPass {
    pub fn new(gpu: &Gpu, layouts: &Layouts, shadows: &zfail::Shadows) -> Self {
        let target = zfail::Target { colors: &[], depth_stencil: gpu.depth_stencil, samples: 1 };
        let clear = wgpu::StencilFaceState {
            compare: wgpu::CompareFunction::Always,
            fail_op: wgpu::StencilOperation::Keep,
            depth_fail_op: wgpu::StencilOperation::Keep,
            pass_op: wgpu::StencilOperation::Zero,
        };
        let stencil = wgpu::StencilState { front: clear, back: clear, read_mask: 0xff, write_mask: 0xff };
        let recipe = Recipe {
            program: shader::DEPTH,
            entry: "depth",
            constants: &[],
            groups: &[&layouts.frame],
            targets: &[],
            depth_stencil: Some(wgpu::DepthStencilState {
                stencil,
                ..depth_test(gpu.depth_stencil, wgpu::CompareFunction::Equal, false)
            }),
            samples: 1,
        };
        let exempt = recipe.scene(&gpu.device, Vertices::Depth, false, None);
        Self { pipelines: shadows.pipelines(&target), exempt }
    }

    /// Clears the stencil and counts the volumes of light `light` of a prepared frame; not on what is `exempt` in a scene.
    pub fn encode(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        targets: &Attributes,
        prepared: &zfail::Prepared<'_>,
        light: usize,
        exempt: Option<(&FrameData, &SceneOnGpu)>,
    ) {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("shadow"),
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &targets.depth_stencil,
                depth_ops: None,
                stencil_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0), store: wgpu::StoreOp::Store }),
            }),
            ..Default::default()
        });
        prepared.draw(&mut pass, &self.pipelines, light);
        let Some((frame, scene)) = exempt.filter(|(_, scene)| scene.has_exempt()) else { return };
        pass.set_pipeline(&self.exempt);
        pass.set_bind_group(0, &frame.bind_group, &[]);
        pass.set_stencil_reference(0);
        for draw in &scene.draws.solid {
            let part = &scene.draws.parts[draw.part];
            let Some(mesh) = &scene.meshes[part.mesh] else { continue };
            mesh.bind(&mut pass, Vertices::Depth, &frame.instances);
            for slot in draw.slots.clone() {
                if !scene.instances[scene.draws.order[slot as usize]].receives_shadow {
                    pass.draw_indexed(part.indices.clone(), 0, slot..slot + 1);
                }
            }
        }
    }
}
