//! Masks of surfaces that turn away from a light: such a surface, if it casts, lies in its own shadow whatever else there is.
//!
//! Its own volume says so too, but a stencil holds a sum: where the edge of another volume meets the surface within the
//! rounding of a pixel's centre, one of the two sides at that edge can count and the other not, and -1 cancels the +1
//! (docs/decisions/0021). Pictures need no such care, for a surface that turns away takes no light from there in any case.

use crate::passes::frame::FrameData;
use crate::passes::pipeline::{Recipe, depth_test};
use crate::scene::SceneOnGpu;
use crate::scene::geometry::Vertices;
use crate::scene::layouts::{Layouts, bind};
use crate::{Gpu, passes::shader, scene::draw_list::Alpha};

/// Draws 0 into a mask where a visible surface that casts turns away from the light.
#[derive(Debug)]
pub struct OwnShadow {
    pipeline: wgpu::RenderPipeline,
    chosen: wgpu::Buffer,
    bind_group: wgpu::BindGroup,
}

impl OwnShadow {
    pub fn new(gpu: &Gpu, layouts: &Layouts, format: wgpu::TextureFormat) -> Self {
        let recipe = Recipe {
            program: shader::OWN_SHADOW,
            entry: "turned_away",
            constants: &[],
            groups: &[&layouts.frame, &layouts.chosen],
            targets: &[Some(format.into())],
            // The very surfaces that the depth buffer holds.
            depth_stencil: Some(depth_test(gpu.depth_stencil, wgpu::CompareFunction::Equal, false)),
            samples: 1,
        };
        let chosen = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("chosen light"),
            size: size_of::<u32>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let bind_group = bind(&gpu.device, "chosen light", &layouts.chosen, &[chosen.as_entire_binding()]);
        Self { pipeline: recipe.scene(&gpu.device, Vertices::Plain, false, None), chosen, bind_group }
    }

    /// Encodes the draws for light `light` of the frame, number `of_scene` of the scene. The pass has the mask as its target,
    /// the finished depth, and the frame as its group 0; the write to the light's number precedes what is submitted next.
    pub fn draw(
        &self,
        gpu: &Gpu,
        pass: &mut wgpu::RenderPass<'_>,
        frame: &FrameData,
        scene: &SceneOnGpu,
        light: u32,
        of_scene: usize,
    ) {
        gpu.queue.write_buffer(&self.chosen, 0, bytemuck::bytes_of(&light));
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(1, &self.bind_group, &[]);
        for draw in &scene.draws.solid {
            let part = &scene.draws.parts[draw.part];
            let Some(mesh) = scene.meshes[part.mesh].as_ref().filter(|_| part.look.alpha == Alpha::Opaque) else {
                continue;
            };
            mesh.bind(pass, Vertices::Plain, &frame.instances);
            for slot in draw.slots.clone() {
                let instance = scene.draws.order[slot as usize];
                if scene.casts(instance, of_scene) && scene.instances[instance].receives_shadow {
                    pass.draw_indexed(part.indices.clone(), 0, slot..slot + 1);
                }
            }
        }
    }
}
