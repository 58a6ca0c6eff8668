//! The host's renderer: pipelines, buffers and passes of its own.

use super::Error;
use super::scene::{self, Light, Scene};
use bytemuck::{Pod, Zeroable};
use wgpu::BufferUsages;
use wgpu::util::DeviceExt;
use zfail::glam::DMat4;
use zfail::{Caster, Frame, LightKind, MeshDescriptor, MeshId, Pipelines, ShadowLight, Shadows, Target, View, wgpu};

const COLOR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
const SAMPLES: u32 = 4;

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct ObjectUniform {
    clip_from_object: [f32; 16],
    world_from_object: [f32; 16],
    color: [f32; 4],
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct LightUniform {
    position: [f32; 4],
    color: [f32; 4],
}

/// A device and everything that lives as long as it: made once, whatever moves.
pub struct Host {
    device: wgpu::Device,
    queue: wgpu::Queue,
    ambient: wgpu::RenderPipeline,
    lit: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
    meshes: Vec<Mesh>,
    targets: Targets,
    shadows: Shadows,
    volumes: Pipelines,
}

/// A mesh on the device, and as zfail knows it.
struct Mesh {
    vertices: wgpu::Buffer,
    indices: wgpu::Buffer,
    count: u32,
    caster: MeshId,
}

struct Targets {
    color: wgpu::Texture,
    depth: wgpu::Texture,
    image: wgpu::Texture,
}

impl Host {
    /// A host on any adapter there is, for images of `size`.
    ///
    /// # Errors
    /// No adapter, or no device.
    pub fn new(scene: &Scene, size: [u32; 2]) -> Result<Self, Error> {
        let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
        descriptor.backends = wgpu::Backends::PRIMARY;
        let instance = wgpu::Instance::new(descriptor);
        let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))?;
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            required_features: zfail::wanted_features(adapter.features()),
            ..wgpu::DeviceDescriptor::default()
        }))?;
        let depth_stencil = zfail::depth_stencil_format(device.features());

        // Shadows, part one: register the meshes.
        let mut shadows = Shadows::new(&device, &queue);
        let volumes = shadows.pipelines(&Target { colors: &[Some(COLOR)], depth_stencil, samples: SAMPLES });
        let mut meshes = Vec::new();
        for scene::Mesh { positions, triangles } in &scene.meshes {
            let caster = shadows.add_mesh(&MeshDescriptor { positions, triangles, ..MeshDescriptor::default() })?;
            meshes.push(Mesh {
                vertices: buffer(&device, bytemuck::cast_slice(positions), BufferUsages::VERTEX),
                indices: buffer(&device, bytemuck::cast_slice(triangles), BufferUsages::INDEX),
                count: triangles.len() as u32 * 3,
                caster,
            });
        }

        let entry = |binding| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        };
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("object and light"),
            entries: &[entry(0), entry(1)],
        });
        let targets = Targets {
            color: texture(&device, size, COLOR, SAMPLES, wgpu::TextureUsages::empty()),
            depth: texture(&device, size, depth_stencil, SAMPLES, wgpu::TextureUsages::empty()),
            image: texture(&device, size, COLOR, 1, wgpu::TextureUsages::COPY_SRC),
        };
        let [ambient, lit] = [false, true].map(|lit| pipeline(&device, &layout, depth_stencil, lit));
        Ok(Self { device, queue, ambient, lit, layout, meshes, targets, shadows, volumes })
    }

    /// Renders a moment of the scene whose meshes were uploaded; RGBA, 8 bits, sRGB, rows from the top.
    ///
    /// # Errors
    /// Whatever zfail or the device reports.
    pub fn render(&mut self, scene: &Scene, view: &View, with_shadows: bool) -> Result<Vec<u8>, Error> {
        // Shadows, part two: say what casts and what shines in this frame.
        let caster = |o: &scene::Object| Caster::new(self.meshes[o.mesh].caster, o.world_from_object);
        let casters: Vec<_> = scene.objects.iter().map(caster).collect();
        let lights: Vec<_> = scene.lights.iter().map(|l| ShadowLight::new(l.kind)).collect();
        let prepared = self.shadows.prepare(&Frame::new(view, &casters, &lights))?;

        let Targets { color, depth, image } = &self.targets;
        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        // One pass for ambient light and depth, then one per light: volumes into the stencil, lit surfaces on top.
        for pass_index in 0..=scene.lights.len() {
            let light = pass_index.checked_sub(1);
            let bindings = bindings(&self.device, &self.layout, scene, view, light.map(|l| &scene.lights[l]));
            let mut pass = begin(&mut encoder, color, depth, image, light.is_none(), pass_index == scene.lights.len());
            match light {
                None => pass.set_pipeline(&self.ambient),
                Some(l) => {
                    // Shadows, part three.
                    if with_shadows {
                        prepared.draw(&mut pass, &self.volumes, l);
                    }
                    pass.set_pipeline(&self.lit);
                    pass.set_stencil_reference(0);
                }
            }
            for (object, bindings) in scene.objects.iter().zip(&bindings) {
                let mesh = &self.meshes[object.mesh];
                pass.set_bind_group(0, bindings, &[]);
                pass.set_vertex_buffer(0, mesh.vertices.slice(..));
                pass.set_index_buffer(mesh.indices.slice(..), wgpu::IndexFormat::Uint32);
                pass.draw_indexed(0..mesh.count, 0, 0..1);
            }
        }
        self.read_back(encoder)
    }

    fn read_back(&self, mut encoder: wgpu::CommandEncoder) -> Result<Vec<u8>, Error> {
        let image = &self.targets.image;
        let (width, height) = (image.width(), image.height());
        let row = (width * 4).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: u64::from(row) * u64::from(height),
            usage: BufferUsages::MAP_READ | BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        encoder.copy_texture_to_buffer(
            image.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &buffer,
                layout: wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None },
            },
            image.size(),
        );
        self.queue.submit([encoder.finish()]);
        buffer.slice(..).map_async(wgpu::MapMode::Read, |_| ());
        self.device.poll(wgpu::PollType::wait_indefinitely())?;
        let mapped = buffer.slice(..).get_mapped_range()?;
        Ok(mapped.chunks(row as usize).flat_map(|r| &r[..width as usize * 4]).copied().collect())
    }
}

fn buffer(device: &wgpu::Device, contents: &[u8], usage: BufferUsages) -> wgpu::Buffer {
    device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: None, contents, usage })
}

fn bindings(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    scene: &Scene,
    view: &View,
    light: Option<&Light>,
) -> Vec<wgpu::BindGroup> {
    let uniform = light.map_or(LightUniform { position: [0.0; 4], color: [0.0; 4] }, light_uniform);
    let light = buffer(device, bytemuck::bytes_of(&uniform), BufferUsages::UNIFORM);
    let bind = |object: &scene::Object| {
        let [r, g, b] = object.color;
        let world_from_object = DMat4::from(object.world_from_object).as_mat4();
        let uniform = ObjectUniform {
            clip_from_object: view.clip_from_object(&object.world_from_object).to_cols_array(),
            world_from_object: world_from_object.to_cols_array(),
            color: [r, g, b, 1.0],
        };
        let object = buffer(device, bytemuck::bytes_of(&uniform), BufferUsages::UNIFORM);
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: object.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: light.as_entire_binding() },
            ],
        })
    };
    scene.objects.iter().map(bind).collect()
}

fn texture(
    device: &wgpu::Device,
    [width, height]: [u32; 2],
    format: wgpu::TextureFormat,
    sample_count: u32,
    more: wgpu::TextureUsages,
) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | more,
        view_formats: &[],
    })
}

/// Begins the ambient pass (which clears) or a light's pass (which adds, on a cleared stencil).
fn begin<'e>(
    encoder: &'e mut wgpu::CommandEncoder,
    color: &wgpu::Texture,
    depth: &wgpu::Texture,
    image: &wgpu::Texture,
    first: bool,
    last: bool,
) -> wgpu::RenderPass<'e> {
    let view = |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
    let (color, depth, image) = (view(color), view(depth), view(image));
    let store = wgpu::StoreOp::Store;
    encoder
        .begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(if first { "ambient" } else { "light" }),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &color,
                depth_slice: None,
                resolve_target: last.then_some(&image),
                ops: wgpu::Operations {
                    load: if first { wgpu::LoadOp::Clear(wgpu::Color::BLACK) } else { wgpu::LoadOp::Load },
                    store,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &depth,
                depth_ops: Some(wgpu::Operations {
                    load: if first { wgpu::LoadOp::Clear(0.0) } else { wgpu::LoadOp::Load },
                    store,
                }),
                stencil_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0), store }),
            }),
            ..wgpu::RenderPassDescriptor::default()
        })
        .forget_lifetime()
}

fn light_uniform(light: &Light) -> LightUniform {
    let position = match light.kind {
        LightKind::Directional { direction } => (-direction).extend(0.0),
        LightKind::Point { position, .. } | LightKind::Spot { position, .. } => position.extend(1.0),
    };
    let [r, g, b] = light.color;
    LightUniform { position: position.as_vec4().to_array(), color: [r, g, b, 0.0] }
}

fn pipeline(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    depth_stencil: wgpu::TextureFormat,
    lit: bool,
) -> wgpu::RenderPipeline {
    let module = device.create_shader_module(wgpu::include_wgsl!("shader.wgsl"));
    let add = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor: wgpu::BlendFactor::One,
        operation: wgpu::BlendOperation::Add,
    };
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(if lit { "lit" } else { "ambient" }),
        layout: Some(&device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &[Some(layout)],
            immediate_size: 0,
        })),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vertex"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: 12,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &wgpu::vertex_attr_array![0 => Float32x3],
            })],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: depth_stencil,
            depth_write_enabled: Some(!lit),
            // Reversed depth; light passes meet the very depths of the ambient pass again.
            depth_compare: Some(if lit { wgpu::CompareFunction::Equal } else { wgpu::CompareFunction::Greater }),
            stencil: if lit { zfail::lit_stencil() } else { wgpu::StencilState::default() },
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState { count: SAMPLES, ..wgpu::MultisampleState::default() },
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(if lit { "lit" } else { "ambient" }),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(wgpu::ColorTargetState {
                format: COLOR,
                blend: lit.then_some(wgpu::BlendState { color: add, alpha: add }),
                write_mask: wgpu::ColorWrites::ALL,
            })],
        }),
        multiview_mask: None,
        cache: None,
    })
}
