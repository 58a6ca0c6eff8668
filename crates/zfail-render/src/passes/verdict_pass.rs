//! Depth, and which lights reach what is visible: every light's volumes are counted in the stencil, and its verdict is
//! kept as a bit of a colour target before the next light needs the stencil. One render pass for all of them.

use crate::device::timing::Timer;
use crate::passes::frame::FrameData;
use crate::passes::pipeline::{Recipe, cleared, cleared_depth, continued, continued_depth, depth_test};
use crate::passes::targets::VERDICTS;
use crate::scene::SceneOnGpu;
use crate::scene::draw_list::{Alpha, Draw, Look};
use crate::scene::geometry::Vertices;
use crate::scene::layouts::Layouts;
use crate::scene::surroundings::VisibleGround;
use crate::{Gpu, passes::shader};
use std::collections::HashMap;

/// Lights whose verdicts fit a texel.
pub const LIGHTS: usize = zfail::VerdictBits::LIGHTS;

/// What a depth pipeline depends on: winding, two sides, and for surfaces with alpha whether they have a texture.
type Key = (bool, bool, Option<bool>);

/// Of the ground.
const GROUND: Key = (false, false, None);

/// Pipelines of the pass for one sample count.
#[derive(Debug)]
pub struct VerdictPass {
    samples: u32,
    depth: HashMap<Key, wgpu::RenderPipeline>,
    volumes: Volumes,
}

/// Where verdicts are kept.
#[derive(Debug)]
enum Volumes {
    /// As bits of a colour target.
    Bits(zfail::VerdictBits),
    /// That of the one light stays in the stencil.
    Stencil(zfail::Pipelines),
}

/// What the pass draws to.
pub struct VerdictTargets<'a> {
    /// For bits.
    pub verdicts: Option<&'a wgpu::TextureView>,
    pub depth_stencil: &'a wgpu::TextureView,
    /// The depth for reading, if lights are counted by tiles.
    pub depth: Option<&'a wgpu::TextureView>,
    /// Verdicts are on what is nearest, blended surfaces included; otherwise on what is behind them, and on the ground.
    pub layered: bool,
    pub ground: Option<VisibleGround<'a>>,
}

/// One light of the pass.
#[derive(Clone, Copy, Debug)]
pub struct Verdict {
    /// Its number in the frame that the shadows were prepared for.
    pub light: usize,
    /// Where its time goes.
    pub span: Option<usize>,
}

impl VerdictPass {
    pub fn new(gpu: &Gpu, shadows: &zfail::Shadows, samples: u32, bits: bool) -> Self {
        let volumes = match bits {
            true => Volumes::Bits(zfail::VerdictBits::new(shadows, gpu.depth_stencil, samples)),
            false => {
                let target = zfail::Target { colors: &[], depth_stencil: gpu.depth_stencil, samples };
                Volumes::Stencil(shadows.pipelines(&target))
            }
        };
        Self { samples, depth: HashMap::new(), volumes }
    }

    /// Makes the pipelines that the scene's draws and its ground lack, those of blended surfaces if `layered`.
    pub fn prepare(&mut self, gpu: &Gpu, layouts: &Layouts, scene: &SceneOnGpu, layered: bool) {
        let (samples, bits) = (self.samples, matches!(self.volumes, Volumes::Bits(_)));
        for draw in draws(scene, layered) {
            let key = key(scene.draws.parts[draw.part].look, draw);
            self.depth.entry(key).or_insert_with(|| create(gpu, layouts, samples, bits, key));
        }
        self.depth.entry(GROUND).or_insert_with(|| create(gpu, layouts, samples, bits, GROUND));
    }

    /// Fills depth and verdicts, the first light's in the lowest bit of red, or the only one's in the stencil; `timer` comes
    /// with the span of the pass.
    #[expect(clippy::too_many_arguments, reason = "the state of a pass")]
    pub fn encode(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        targets: &VerdictTargets<'_>,
        frame: &FrameData,
        scene: &SceneOnGpu,
        mut prepared: zfail::Prepared<'_>,
        lights: impl Iterator<Item = Verdict>,
        timer: (&Timer, Option<usize>),
    ) {
        let &VerdictTargets { verdicts, depth_stencil, depth, layered, ground } = targets;
        let timestamps = timer.1.and_then(|span| timer.0.pass(span));
        let (begin, end) = (timestamps.clone(), timestamps.clone());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("verdicts"),
            color_attachments: verdicts.map(|view| cleared(view, [0.0; 4])).as_slice(),
            depth_stencil_attachment: Some(cleared_depth(depth_stencil)),
            timestamp_writes: match depth {
                None => timestamps,
                Some(_) => begin.map(|t| wgpu::RenderPassTimestampWrites { end_of_pass_write_index: None, ..t }),
            },
            ..Default::default()
        });
        pass.set_bind_group(0, &frame.bind_group, &[]);
        for draw in draws(scene, layered) {
            let part = &scene.draws.parts[draw.part];
            let (Some(mesh), Some(pipeline)) = (&scene.meshes[part.mesh], self.depth.get(&key(part.look, draw))) else {
                continue;
            };
            pass.set_pipeline(pipeline);
            mesh.bind(&mut pass, vertices(part.look.alpha), &frame.instances);
            if part.look.alpha != Alpha::Opaque {
                pass.set_bind_group(1, &scene.materials[part.material], &[]);
            }
            pass.draw_indexed(part.indices.clone(), 0, draw.slots.clone());
        }
        if let (Some(ground), Some(pipeline), false) = (ground, self.depth.get(&GROUND), layered) {
            pass.set_pipeline(pipeline);
            ground.draw(&mut pass, Vertices::Depth, &frame.instances, scene.draws.order.len() as u32);
        }
        if let Some(depth) = depth {
            // The tile pass reads depth, so the render pass is interrupted for it.
            drop(pass);
            prepared = prepared.count_tiles(encoder, depth);
            pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("verdicts"),
                color_attachments: verdicts.map(continued).as_slice(),
                depth_stencil_attachment: Some(continued_depth(depth_stencil)),
                timestamp_writes: end
                    .map(|t| wgpu::RenderPassTimestampWrites { beginning_of_pass_write_index: None, ..t }),
                ..Default::default()
            });
            pass.set_bind_group(0, &frame.bind_group, &[]);
        }
        for (bit, light) in lights.take(LIGHTS).enumerate() {
            if let Some(span) = light.span {
                timer.0.stamp(&mut pass, span, false);
            }
            match &self.volumes {
                Volumes::Bits(bits) => bits.draw(&mut pass, &prepared, light.light, bit),
                Volumes::Stencil(pipelines) => prepared.draw(&mut pass, pipelines, light.light),
            }
            if let Some(span) = light.span {
                timer.0.stamp(&mut pass, span, true);
            }
        }
    }
}

fn draws(scene: &SceneOnGpu, layered: bool) -> impl Iterator<Item = &Draw> {
    scene.draws.solid.iter().chain(scene.draws.blended.iter().filter(move |_| layered))
}

fn vertices(alpha: Alpha) -> Vertices {
    if alpha == Alpha::Opaque { Vertices::Depth } else { Vertices::Textured }
}

fn key(look: Look, draw: &Draw) -> Key {
    (draw.mirrored, look.double_sided, (look.alpha != Alpha::Opaque).then_some(look.textured[0]))
}

fn create(
    gpu: &Gpu,
    layouts: &Layouts,
    samples: u32,
    bits: bool,
    (mirrored, double_sided, mask): Key,
) -> wgpu::RenderPipeline {
    let constants = [("BASE_COLOR", f64::from(u8::from(mask == Some(true))))];
    let both = [&layouts.frame, &layouts.material];
    let write_mask = wgpu::ColorWrites::empty();
    let untouched = [Some(wgpu::ColorTargetState { format: VERDICTS, blend: None, write_mask })];
    let recipe = Recipe {
        program: if mask.is_some() { shader::CUTOUT } else { shader::DEPTH },
        entry: "depth",
        constants: if mask.is_some() { &constants } else { &[] },
        groups: if mask.is_some() { &both } else { &[] },
        targets: if bits { &untouched } else { &[] },
        depth_stencil: Some(depth_test(gpu.depth_stencil, wgpu::CompareFunction::GreaterEqual, true)),
        samples,
    };
    let cull = if double_sided { None } else { Some(wgpu::Face::Back) };
    let alpha = if mask.is_some() { Alpha::Mask } else { Alpha::Opaque };
    recipe.scene(&gpu.device, vertices(alpha), mirrored, cull)
}
