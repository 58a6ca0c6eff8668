//! What the measured outputs say about visible surfaces: distance, normal, base colour. Only when they are asked for.

use crate::passes::frame::FrameData;
use crate::passes::pipeline::{Recipe, cleared, cleared_depth, depth_test};
use crate::passes::targets::{self, Attributes, view};
use crate::scene::SceneOnGpu;
use crate::scene::draw_list::{Alpha, Draw, Look};
use crate::scene::geometry::Vertices;
use crate::scene::layouts::Layouts;
use crate::{Gpu, passes::shader};
use std::collections::HashMap;

/// What a pipeline depends on: the look as far as it matters here, winding.
type Key = (Look, bool);

/// Pipelines of the pass, made when they are first needed.
#[derive(Debug, Default)]
pub struct AttributePass {
    pipelines: HashMap<Key, wgpu::RenderPipeline>,
}

impl AttributePass {
    /// Draws solid surfaces. Leaves the stencil at 0: lit.
    pub fn encode(
        &mut self,
        gpu: &Gpu,
        layouts: &Layouts,
        encoder: &mut wgpu::CommandEncoder,
        targets: &Attributes,
        frame: &FrameData,
        scene: &SceneOnGpu,
    ) {
        let [depth, normal, albedo] = [&targets.depth, &targets.normal, &targets.albedo].map(view);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("attributes"),
            color_attachments: &[
                cleared(&depth, targets::NO_SURFACE.to_le_bytes().map(f64::from)),
                cleared(&normal, [0.0; 4]),
                cleared(&albedo, [0.0; 4]),
            ],
            depth_stencil_attachment: Some(cleared_depth(&targets.depth_stencil)),
            ..Default::default()
        });
        pass.set_bind_group(0, &frame.bind_group, &[]);
        for draw in &scene.draws.solid {
            let part = &scene.draws.parts[draw.part];
            let Some(mesh) = &scene.meshes[part.mesh] else { continue };
            let key = key(part.look, draw);
            pass.set_pipeline(self.pipelines.entry(key).or_insert_with(|| create(gpu, layouts, key)));
            mesh.bind(&mut pass, Vertices::Mapped, &frame.instances);
            pass.set_bind_group(1, &scene.materials[part.material], &[]);
            pass.draw_indexed(part.indices.clone(), 0, draw.slots.clone());
        }
    }
}

fn key(look: Look, draw: &Draw) -> Key {
    // Light does not matter.
    (Look { unlit: false, rough: false, coarse: false, ..look }, draw.mirrored)
}

fn create(gpu: &Gpu, layouts: &Layouts, (look, mirrored): Key) -> wgpu::RenderPipeline {
    let mask = f64::from(u8::from(look.alpha == Alpha::Mask));
    let constants: Vec<_> = look.constants().chain([("ALPHA_MASK", mask)]).collect();
    let recipe = Recipe {
        program: shader::DESCRIBE,
        entry: "describe",
        constants: &constants,
        groups: &[&layouts.frame, &layouts.material],
        targets: &[targets::DEPTH, targets::NORMAL, targets::ALBEDO].map(|format| Some(format.into())),
        depth_stencil: Some(depth_test(gpu.depth_stencil, wgpu::CompareFunction::GreaterEqual, true)),
        samples: 1,
    };
    let cull = if look.double_sided { None } else { Some(wgpu::Face::Back) };
    recipe.scene(&gpu.device, Vertices::Mapped, mirrored, cull)
}
