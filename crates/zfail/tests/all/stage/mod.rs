//! The least host there is: a depth pass of its own, shadows from zfail, and the stencil read back.

use std::sync::OnceLock;
use wgpu::RequestAdapterError;
use wgpu::util::DeviceExt;
use zfail::glam::DAffine3;
use zfail::low_level::{self, FramePlan};
use zfail::{Bounds, Caster, Counting, Frame, LightKind, MeshDescriptor, ShadowLight, Shadows, Steps, Target};
use zfail::{Technique, View};
pub use zfail_testing::Random;
use zfail_testing::Raw;

/// A mesh as tests write it.
pub type Soup = (Vec<[f32; 3]>, Vec<[u32; 3]>);

/// What one test varies.
#[derive(Clone, Copy)]
pub struct Setup {
    pub samples: u32,
    pub depth_stencil: wgpu::TextureFormat,
    /// Whether the device may clamp depth by itself.
    pub clip_control: bool,
    pub steps: Steps,
    pub counting: Counting,
    /// What depth is cleared to: 0 is nothing in sight, 1 is a surface right at the near plane.
    pub depth_clear: f32,
    /// Whether the meshes are drawn into the depth buffer.
    pub draw_depth: bool,
}

impl Default for Setup {
    fn default() -> Self {
        Self {
            samples: 1,
            depth_stencil: wgpu::TextureFormat::Depth32FloatStencil8,
            clip_control: true,
            steps: Technique::EverittKilgard.steps(),
            counting: Counting::Raw,
            depth_clear: 0.0,
            draw_depth: true,
        }
    }
}

/// The device of all tests, which may or may not clamp depth by itself.
fn found(clip_control: bool) -> &'static Result<Raw, RequestAdapterError> {
    static FOUND: [OnceLock<Result<Raw, RequestAdapterError>>; 2] = [OnceLock::new(), OnceLock::new()];
    let describe = |adapter: &wgpu::Adapter| {
        let mut features = zfail::wanted_features(adapter.features());
        if !clip_control {
            features.remove(wgpu::Features::DEPTH_CLIP_CONTROL);
        }
        wgpu::DeviceDescriptor {
            required_features: features,
            required_limits: adapter.limits(),
            ..wgpu::DeviceDescriptor::default()
        }
    };
    FOUND[usize::from(clip_control)].get_or_init(|| zfail_testing::device(describe))
}

/// Whether there is a device; if not, the test is to be skipped.
#[track_caller]
pub fn has_device() -> bool {
    zfail_testing::gpu(found(true).as_ref()).is_some()
}

/// A device with what the set-up asks for.
pub fn device(setup: &Setup) -> (wgpu::Device, wgpu::Queue) {
    let raw = found(setup.clip_control).as_ref().expect("a test that has asked whether there is one");
    (raw.device.clone(), raw.queue.clone())
}

const DEPTH: &str = "
@group(0) @binding(0) var<uniform> clip_from_object: mat4x4<f32>;
struct Out { @invariant @builtin(position) clip: vec4<f32> }
@vertex fn main(@location(0) position: vec3<f32>) -> Out {
    return Out(clip_from_object * vec4<f32>(position, 1.0));
}";

/// The stencil of sample 0 of every pixel after the volumes of the one light, row by row.
pub fn stencil(setup: &Setup, view: &View, meshes: &[(Soup, DAffine3)], light: LightKind) -> Vec<u8> {
    let (device, queue) = device(setup);
    draw(&device, &queue, setup, view, meshes, light, |_| {}).0
}

/// The same on a device that is there, with a plan that `edit` may change; also returns the plan.
pub fn draw(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    setup: &Setup,
    view: &View,
    meshes: &[(Soup, DAffine3)],
    light: LightKind,
    edit: impl FnOnce(&mut FramePlan),
) -> (Vec<u8>, FramePlan) {
    let mut shadows = Shadows::new(device, queue);
    let target = Target { colors: &[], depth_stencil: setup.depth_stencil, samples: setup.samples };
    let pipelines = shadows.pipelines(&target);
    let casters: Vec<Caster> = meshes
        .iter()
        .map(|((positions, triangles), world_from_object)| {
            let mesh = MeshDescriptor { positions, triangles, ..MeshDescriptor::default() };
            Caster::new(shadows.add_mesh(&mesh).expect("mesh"), *world_from_object)
        })
        .collect();
    let lights = [ShadowLight::new(light)];
    let placed = |(soup, place): &(Soup, DAffine3)| {
        let corners = soup.0.iter().map(|p| place.transform_point3(glam::Vec3::from_array(*p).as_dvec3()));
        Bounds::of(corners)
    };
    let receivers: Vec<Bounds> = meshes.iter().map(placed).collect();
    let frame = Frame::new(view, &casters, &lights).receivers(&receivers).steps(setup.steps).counting(setup.counting);
    shadows.prepare(&frame.tile_pass(setup.samples == 1)).expect("plan");
    low_level::edit_plan(&mut shadows, edit);
    let prepared = shadows.prepared().expect("a frame");

    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: view.size[0], height: view.size[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: setup.samples,
        dimension: wgpu::TextureDimension::D2,
        format: setup.depth_stencil,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT
            | wgpu::TextureUsages::COPY_SRC
            | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    let attachment = texture.create_view(&wgpu::TextureViewDescriptor::default());
    let depth = texture.create_view(&wgpu::TextureViewDescriptor {
        aspect: wgpu::TextureAspect::DepthOnly,
        ..wgpu::TextureViewDescriptor::default()
    });
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    {
        let mut pass = begin(&mut encoder, &attachment, wgpu::LoadOp::Clear(setup.depth_clear));
        if setup.draw_depth {
            draw_depth(device, &mut pass, setup, view, meshes);
        }
    }
    let prepared = prepared.count_tiles(&mut encoder, &depth);
    prepared.draw(&mut begin(&mut encoder, &attachment, wgpu::LoadOp::Load), &pipelines, 0);
    (read_stencil(device, queue, encoder, &texture), low_level::plan(&prepared).clone())
}

pub fn begin<'e>(
    encoder: &'e mut wgpu::CommandEncoder,
    attachment: &wgpu::TextureView,
    depth: wgpu::LoadOp<f32>,
) -> wgpu::RenderPass<'e> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: attachment,
            depth_ops: Some(wgpu::Operations { load: depth, store: wgpu::StoreOp::Store }),
            stencil_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0), store: wgpu::StoreOp::Store }),
        }),
        ..wgpu::RenderPassDescriptor::default()
    })
}

pub fn draw_depth(
    device: &wgpu::Device,
    pass: &mut wgpu::RenderPass<'_>,
    setup: &Setup,
    view: &View,
    meshes: &[(Soup, DAffine3)],
) {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(DEPTH.into()),
    });
    let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: None,
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: 12,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &wgpu::vertex_attr_array![0 => Float32x3],
            })],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: setup.depth_stencil,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Greater),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState { count: setup.samples, ..wgpu::MultisampleState::default() },
        fragment: None,
        multiview_mask: None,
        cache: None,
    });
    pass.set_pipeline(&pipeline);
    for ((positions, triangles), world_from_object) in meshes {
        let buffer = |contents: &[u8], usage| {
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: None, contents, usage })
        };
        let matrix = view.clip_from_object(world_from_object).to_cols_array();
        let matrix = buffer(bytemuck::cast_slice(&matrix), wgpu::BufferUsages::UNIFORM);
        let bindings = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: matrix.as_entire_binding() }],
        });
        let vertices = buffer(bytemuck::cast_slice(positions), wgpu::BufferUsages::VERTEX);
        let indices = buffer(bytemuck::cast_slice(triangles), wgpu::BufferUsages::INDEX);
        pass.set_bind_group(0, &bindings, &[]);
        pass.set_vertex_buffer(0, vertices.slice(..));
        pass.set_index_buffer(indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..triangles.len() as u32 * 3, 0, 0..1);
    }
}

/// Reads the stencil aspect; a multisampled one goes through a shader that fetches sample 0.
pub fn read_stencil(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    encoder: wgpu::CommandEncoder,
    texture: &wgpu::Texture,
) -> Vec<u8> {
    let multi = if texture.sample_count() > 1 { "multisampled_" } else { "" };
    let declared = format!("texture_{multi}2d<u32>");
    let aspect = wgpu::TextureAspect::StencilOnly;
    let words = read(device, queue, encoder, (texture, aspect), &declared, "", "textureLoad(image, id.xy, 0).r");
    words.into_iter().map(|word| word as u8).collect()
}

/// What a shader makes of every pixel of an aspect of a texture, row by row: `value` is a `u32` made of `image`, of the type
/// that is `declared`, and `id.xy`, perhaps by functions of a `prelude`.
pub fn read(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    mut encoder: wgpu::CommandEncoder,
    (texture, aspect): (&wgpu::Texture, wgpu::TextureAspect),
    declared: &str,
    prelude: &str,
    value: &str,
) -> Vec<u32> {
    let (width, height) = (texture.width(), texture.height());
    let source = format!(
        "{prelude}
        @group(0) @binding(0) var image: {declared};
        @group(0) @binding(1) var<storage, read_write> out: array<u32>;
        @compute @workgroup_size(8, 8) fn main(@builtin(global_invocation_id) id: vec3<u32>) {{
            if id.x < {width}u && id.y < {height}u {{
                out[id.y * {width}u + id.x] = {value};
            }}
        }}"
    );
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: None,
        module: &module,
        entry_point: None,
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: None,
    });
    let size = u64::from(width) * u64::from(height) * 4;
    let buffer =
        |usage| device.create_buffer(&wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false });
    let out = buffer(wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC);
    let read = buffer(wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST);
    let view = texture.create_view(&wgpu::TextureViewDescriptor { aspect, ..Default::default() });
    let bindings = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&view) },
            wgpu::BindGroupEntry { binding: 1, resource: out.as_entire_binding() },
        ],
    });
    {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &bindings, &[]);
        pass.dispatch_workgroups(width.div_ceil(8), height.div_ceil(8), 1);
    }
    encoder.copy_buffer_to_buffer(&out, 0, &read, 0, size);
    queue.submit([encoder.finish()]);
    read.slice(..).map_async(wgpu::MapMode::Read, |result| result.expect("map"));
    device.poll(wgpu::PollType::wait_indefinitely()).expect("poll");
    let mapped = read.slice(..).get_mapped_range().expect("mapped");
    bytemuck::pod_collect_to_vec(&mapped)
}
