//! Exact, bias-free stencil shadows for [`wgpu`] renderers.
//!
//! A surface is lit exactly where a ray from the visible point reaches the light: for any triangle mesh, any camera, and
//! point, spot and directional lights. There is no bias, no resolution and no filter to tune. The algorithms are those of
//! Everitt & Kilgard 2002 and McGuire et al. 2003, made to work on any mesh (see [`zfail_plan`]).
//!
//! Register meshes once with [`Shadows`]. Every frame, say what casts and what shines ([`Frame`]), and
//! [`prepare`](Shadows::prepare) it. Then, for each light, on a stencil of 0 and the finished depth,
//! [`Prepared::draw`] encodes the shadow volumes into a pass of yours, and the stencil is 0 where the light arrives. Here is
//! all of it, without a window:
//!
//! ```
//! use wgpu::util::DeviceExt;
//! use zfail::glam::{DAffine3, DVec3};
//! use zfail::{Caster, Frame, LightKind, MeshDescriptor, Projection, ShadowLight, Shadows, Target, View, wgpu};
//!
//! // One matrix per object, an invariant position: volumes start at the very depths of the triangles.
//! const DEPTH: &str = "@group(0) @binding(0) var<uniform> clip_from_object: mat4x4<f32>;
//!     @vertex fn main(@location(0) position: vec3<f32>) -> @invariant @builtin(position) vec4<f32> {
//!         return clip_from_object * vec4<f32>(position, 1.0);
//!     }";
//!
//! // A floor of 8 x 8 m, and a sheet of 1 x 1 m that floats 1 m above its middle.
//! let (positions, triangles) = ([[-4.0, 0.0, -4.0], [-4.0, 0.0, 4.0], [4.0, 0.0, 4.0], [4.0, 0.0, -4.0],
//!     [-0.5, 1.0, -0.5], [-0.5, 1.0, 0.5], [0.5, 1.0, 0.5], [0.5, 1.0, -0.5]],
//!     [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7_u32]]);
//! let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
//! let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))?;
//! let required_features = zfail::wanted_features(adapter.features());
//! let descriptor = wgpu::DeviceDescriptor { required_features, ..Default::default() };
//! let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))?;
//! let format = zfail::depth_stencil_format(device.features());
//!
//! // Once: meshes, and pipelines for the formats of the pass that shadows are drawn in.
//! let mut shadows = Shadows::new(&device, &queue);
//! let mesh = shadows.add_mesh(&MeshDescriptor { positions: &positions, triangles: &triangles, ..Default::default() })?;
//! let volumes = shadows.pipelines(&Target { colors: &[], depth_stencil: format, samples: 1 });
//!
//! // Every frame: a camera 6 m above the floor that sees 6 x 6 m of it, a lamp 2 m above the sheet's middle.
//! let projection = Projection::Perspective { yfov: 2.0 * 0.5_f64.atan(), near: 0.1, far: None };
//! let view = View::looking_at(DVec3::Y * 6.0, DVec3::ZERO, DVec3::NEG_Z, projection, [256, 256]);
//! let casters = [Caster::new(mesh, DAffine3::IDENTITY)];
//! let lights = [ShadowLight::new(LightKind::Point { position: DVec3::Y * 3.0, range: f64::INFINITY })];
//! let prepared = shadows.prepare(&Frame::new(&view, &casters, &lights))?;
//!
//! // The depth pass of the host, with reversed depth, cleared to 0.
//! let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
//! let size = wgpu::Extent3d { width: 256, height: 256, depth_or_array_layers: 1 };
//! let target = device.create_texture(&wgpu::TextureDescriptor { label: None, size, mip_level_count: 1, sample_count: 1,
//!     dimension: wgpu::TextureDimension::D2, format, usage, view_formats: &[] });
//! let source = wgpu::ShaderSource::Wgsl(DEPTH.into());
//! let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
//! let buffers = [Some(wgpu::VertexBufferLayout { array_stride: 12, step_mode: wgpu::VertexStepMode::Vertex,
//!     attributes: &wgpu::vertex_attr_array![0 => Float32x3] })];
//! let depth = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor { label: None, layout: None,
//!     vertex: wgpu::VertexState { module: &module, entry_point: None, compilation_options: Default::default(),
//!         buffers: &buffers },
//!     primitive: wgpu::PrimitiveState { cull_mode: Some(wgpu::Face::Back), ..Default::default() },
//!     depth_stencil: Some(wgpu::DepthStencilState { format, depth_write_enabled: Some(true),
//!         depth_compare: Some(wgpu::CompareFunction::Greater), stencil: Default::default(), bias: Default::default() }),
//!     multisample: Default::default(), fragment: None, multiview_mask: None, cache: None });
//! let buffer = |contents: &[u8], usage| device.create_buffer_init(
//!     &wgpu::util::BufferInitDescriptor { label: None, contents, usage });
//! let matrix = view.clip_from_object(&casters[0].world_from_object).to_cols_array();
//! let matrix = buffer(bytemuck::cast_slice(&matrix), wgpu::BufferUsages::UNIFORM);
//! let object = device.create_bind_group(&wgpu::BindGroupDescriptor { label: None,
//!     layout: &depth.get_bind_group_layout(0),
//!     entries: &[wgpu::BindGroupEntry { binding: 0, resource: matrix.as_entire_binding() }] });
//! let mut encoder = device.create_command_encoder(&Default::default());
//! let attachment = target.create_view(&Default::default());
//! let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
//!     depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment { view: &attachment,
//!         depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
//!         stencil_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0), store: wgpu::StoreOp::Store }) }),
//!     ..Default::default() });
//! pass.set_pipeline(&depth);
//! pass.set_bind_group(0, &object, &[]);
//! pass.set_vertex_buffer(0, buffer(bytemuck::cast_slice(&positions), wgpu::BufferUsages::VERTEX).slice(..));
//! pass.set_index_buffer(buffer(bytemuck::cast_slice(&triangles), wgpu::BufferUsages::INDEX).slice(..),
//!     wgpu::IndexFormat::Uint32);
//! pass.draw_indexed(0..12, 0, 0..1);
//! // The volumes of light 0. A renderer would light the surfaces now, with `zfail::lit_stencil()` and reference 0.
//! prepared.draw(&mut pass, &volumes, 0);
//! drop(pass);
//!
//! // Here the stencil is read instead: the sheet's shadow on the floor is 1.5 x 1.5 m, less what the sheet itself hides.
//! let read = device.create_buffer(&wgpu::BufferDescriptor { label: None, size: 256 * 256, mapped_at_creation: false,
//!     usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ });
//! let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(256), rows_per_image: None };
//! encoder.copy_texture_to_buffer(wgpu::TexelCopyTextureInfo { aspect: wgpu::TextureAspect::StencilOnly,
//!     ..target.as_image_copy() }, wgpu::TexelCopyBufferInfo { buffer: &read, layout }, size);
//! queue.submit([encoder.finish()]);
//! read.slice(..).map_async(wgpu::MapMode::Read, |_| ());
//! device.poll(wgpu::PollType::wait_indefinitely())?;
//! let lit = read.slice(..).get_mapped_range()?.iter().filter(|&&count| count == 0).count();
//! let in_shadow = (256 * 256 - lit) as f64 / f64::from(256 * 256) * 36.0;
//! assert!((in_shadow - (1.5 * 1.5 - 1.2 * 1.2)).abs() < 0.1, "{in_shadow} of 36 square metres of the picture");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Two ways to take the verdict
//! - **In a pass of yours, by the stencil**: clear it, [`Prepared::draw`], and light surfaces with [`lit_stencil`] and stencil
//!   reference 0, light by light.
//! - **As a texture of bits**, 32 lights a texel: [`VerdictBits`] draws it after the depth pass, and any material shader, in
//!   whatever pass it runs, looks its lights up.
//!
//! # What a host has to respect
//! - Depth is reversed, cleared to 0, and comes from [`View::clip_from_object`], one `f32` matrix per object, applied in the
//!   vertex shader as `clip_from_object * vec4<f32>(position, 1.0)` to an `@invariant @builtin(position)`. Volumes start at
//!   the rendered triangles, so their depths have to agree to the last bit. A host that has clip matrices of its own makes its
//!   [`View::from_matrices`] and says [`Caster::drawn_with`], where it is told what that takes.
//! - The depth pass draws the very triangles given to [`Shadows::add_mesh`], each with its three vertices in the same order.
//!   Where it culls backs or draws from both sides, [`Blocking`] says so.
//! - The depth-stencil format has 8 stencil bits: [`depth_stencil_format`].
//! - Illumination ends at the light's range and cone: casters and pixels beyond them are not looked at.
//! - Surfaces that turn away from a light take nothing from it (their cosine is negative): at their very edges a stencil
//!   cannot tell which side of rounding it is on.
//! - A camera with a far plane (orthographic, or a finite perspective) works everywhere; it is faster where the device has
//!   `DEPTH_CLIP_CONTROL`: [`wanted_features`].
//!
//! # Features
//! - `wgpu-default` (on): the default features of [`wgpu`], so its backends. Without it, the host chooses them.
//! - `rayon` (on): planning on several threads.

mod arena;
mod cost;
mod error;
mod features;
mod frame;
mod frame_buffers;
pub mod low_level;
mod mesh;
mod pipelines;
mod prepared;
mod shadows;
mod silhouettes;
mod tiled;
mod tiles;
mod verdict_bits;

pub use cost::CostModel;
pub use error::Error;
pub use features::{depth_stencil_format, wanted_features};
pub use frame::{Caster, Frame};
pub use mesh::{MeshBlocking, MeshDescriptor, MeshId};
pub use pipelines::{Pipelines, Target, lit_stencil};
pub use prepared::Prepared;
pub use shadows::Shadows;
pub use verdict_bits::VerdictBits;
pub use wgpu;
pub use zfail_plan::bounds::{Bounds, OrientedBox};
pub use zfail_plan::light::LightKind;
pub use zfail_plan::plan::{
    Counting, Culled, LightStats, PlanError, Sections, ShadowLight, Silhouettes, Steps, Technique, Tiles, Triangles,
    UnknownTechnique, ZPass,
};
pub use zfail_plan::topology::{Blocking, Topology, TopologyError};
pub use zfail_plan::view::{Projection, View, ViewError, Window};
pub use zfail_plan::{self, glam};
