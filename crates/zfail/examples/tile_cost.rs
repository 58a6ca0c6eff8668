//! Cost of the tile pass against rasterising the same sides.
use wgpu::util::DeviceExt;
use zfail::glam::{DAffine3, DVec3};
use zfail::tiles::{Sides, TilePass};
use zfail::zfail_plan::plan::{self, Planner};
use zfail::zfail_plan::scene::Bounds;
use zfail::zfail_plan::{self};
use zfail::{Counting, LightKind, ShadowLight, Technique, Topology, View};

fn cpu_ms() -> f64 {
    let s = std::fs::read_to_string("/proc/self/stat").unwrap();
    let f: Vec<&str> = s.rsplit(')').next().unwrap().split_whitespace().collect();
    (f[11].parse::<f64>().unwrap() + f[12].parse::<f64>().unwrap()) * 10.0
}

struct Gpu {
    device: wgpu::Device,
    queue: wgpu::Queue,
}
const SIZE: [u32; 2] = [1280, 720];
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32FloatStencil8;

/// N(Q): signed crossings of the segment light -> q by weighted triangles, object space.
fn near_count(t: &Topology, weights: &[i8], light: zfail::glam::Vec4, q: DVec3) -> i32 {
    let l = light.as_dvec4();
    let dir = if l.w == 0.0 { -l.truncate() } else { q - l.truncate() };
    let origin = q;
    // ray from q towards the light: q - s*dir, s in (0, 1 or inf)
    let mut n = 0;
    for i in 0..t.triangles.len() {
        if weights[i] == 0 {
            continue;
        }
        let [a, b, c] = t.corners(i);
        let (e1, e2) = (b - a, c - a);
        let d = -dir;
        let p = d.cross(e2);
        let det = e1.dot(p);
        if det == 0.0 {
            continue;
        }
        let s = origin - a;
        let u = s.dot(p) / det;
        let qv = s.cross(e1);
        let v = d.dot(qv) / det;
        let tt = e2.dot(qv) / det;
        if u >= 0.0 && v >= 0.0 && u + v <= 1.0 && tt > 0.0 && (l.w == 0.0 || tt < 1.0) {
            let sigma = zfail_plan::casting::facing(t.corners(i), l);
            n += i32::from(weights[i]) * i32::from(sigma);
        }
    }
    n
}

fn main() {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = wgpu::Backends::from_env().unwrap_or(wgpu::Backends::PRIMARY);
    let instance = wgpu::Instance::new(descriptor);
    let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default())).unwrap();
    let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
        required_features: zfail::wanted_features(adapter.features()),
        required_limits: adapter.limits(),
        ..Default::default()
    }))
    .unwrap();
    let g = Gpu { device, queue };
    for path in std::env::args().skip(1) {
        scene(&g, &path);
    }
}

fn scene(g: &Gpu, path: &str) {
    let mut scene = zfail_scene::load(path.as_ref()).unwrap();
    zfail_scene::complete(&mut scene);
    let bounds = scene.bounds();
    let view = scene.cameras[0].view(SIZE, &bounds);
    let topologies: Vec<Topology> = scene
        .meshes
        .iter()
        .enumerate()
        .map(|(m, mesh)| Topology::new(&mesh.positions, &mesh.triangles, |t| scene.triangle_casts(m, t)).unwrap())
        .collect();
    let casters: Vec<plan::Caster<'_>> = scene
        .instances
        .iter()
        .filter(|i| i.casts_shadow)
        .map(|i| plan::Caster {
            topology: &topologies[i.mesh],
            mesh: i.mesh as u64 + 1,
            world_from_object: i.world_from_object,
        })
        .collect();
    let lights: Vec<ShadowLight<'_>> = scene
        .lights
        .iter()
        .map(|l| {
            let kind = match l.kind {
                LightKind::Point { position, .. } => LightKind::Point { position, range: f64::INFINITY },
                k => k,
            };
            ShadowLight { kind, excluded: &[] }
        })
        .collect();
    let mut planner = Planner::new();
    let plan = planner
        .plan(&plan::Frame {
            view: &view,
            casters: &casters,
            lights: &lights,
            technique: Technique::EverittKilgard,
            counting: Counting::Raw,
        })
        .unwrap()
        .clone();
    println!("== {path}: {} casters, {} lights, draws {}", casters.len(), lights.len(), plan.draws.len());

    let depth = depth_target(g, &view, &scene);
    let attach = depth.create_view(&Default::default());
    let depth_only = depth
        .create_view(&wgpu::TextureViewDescriptor { aspect: wgpu::TextureAspect::DepthOnly, ..Default::default() });

    // near rectangle's centre
    let q_world = view.world_from_view.transform_point3(DVec3::new(0.0, 0.0, -view.near()));
    let raster = Raster::new(g, &view, &casters, &plan);
    let mut pass = TilePass::new(&g.device);
    let pipeline = pass.pipeline(&g.device, &zfail::Target { colors: &[], depth_stencil: FORMAT, samples: 1 }).unwrap();
    let n_: usize = std::env::var("N").ok().and_then(|n| n.parse().ok()).unwrap_or(20);
    for l in 0..lights.len() {
        let batch = plan.lights[l].batches[0].clone();
        let mut base = 0;
        for d in batch.clone() {
            let draw = &plan.draws[d as usize];
            let c = &casters[draw.caster as usize];
            let mut castings = Vec::new();
            let mut weights = Vec::new();
            zfail_plan::casting::castings(c.topology, draw.light, &mut castings);
            zfail_plan::casting::weights(c.topology, &castings, draw.light, &mut weights);
            base +=
                near_count(c.topology, &weights, draw.light, c.world_from_object.inverse().transform_point3(q_world));
        }
        let sides = |d: u32| {
            let draw = &plan.draws[d as usize];
            let c = &casters[draw.caster as usize];
            Sides {
                positions: &c.topology.positions,
                clip_from_object: view.clip_from_object(&c.world_from_object),
                world_from_object: c.world_from_object,
                light: draw.light,
                scissor: [0, 0, SIZE[0], SIZE[1]],
                converging: draw.light.w == 0.0,
                indices: &plan.indices[draw.volume.sides.start as usize..draw.volume.sides.end as usize],
                mirrored: draw.mirrored,
            }
        };
        let tris: u32 = batch.clone().map(|d| plan.draws[d as usize].volume.triangles()[0]).sum();

        let mut best = [f64::INFINITY; 8];
        let mut figures = zfail::tiles::TileStats::default();
        for _round in 0..3 {
            let mut measure = |k: usize, f: &mut dyn FnMut()| {
                let t = cpu_ms();
                for _ in 0..n_ {
                    f();
                }
                let ms = (cpu_ms() - t) / n_ as f64;
                best[k] = best[k].min(ms);
            };
            let submit = |f: &mut dyn FnMut(&mut wgpu::CommandEncoder)| {
                let mut e = g.device.create_command_encoder(&Default::default());
                f(&mut e);
                g.queue.submit([e.finish()]);
                g.device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
            };
            measure(0, &mut || {
                submit(&mut |e| {
                    stencil_pass(e, &attach, base, |_| {});
                })
            });
            measure(1, &mut || {
                submit(&mut |e| {
                    stencil_pass(e, &attach, base, |p| raster.sides(p, &plan, batch.clone(), true));
                })
            });
            measure(2, &mut || {
                submit(&mut |e| {
                    stencil_pass(e, &attach, 0, |p| raster.sides(p, &plan, batch.clone(), false));
                })
            });
            measure(3, &mut || {
                pass.begin(&view, &bounds);
                figures = pass.add(&g.device, base, batch.clone().map(sides)).unwrap();
            });
            measure(4, &mut || {
                pass.upload(&g.device, &g.queue).unwrap();
                submit(&mut |_| {});
            });
            measure(5, &mut || submit(&mut |e| pass.encode(&g.device, e, &depth_only)));
            measure(6, &mut || submit(&mut |e| stencil_pass(e, &attach, 0, |p| pass.draw(&g.device, p, &pipeline, 0))));
            measure(7, &mut || {
                pass.begin(&view, &bounds);
                pass.add(&g.device, base, batch.clone().map(sides));
                pass.upload(&g.device, &g.queue).unwrap();
                submit(&mut |e| {
                    pass.encode(&g.device, e, &depth_only);
                    stencil_pass(e, &attach, 0, |p| pass.draw(&g.device, p, &pipeline, 0));
                });
            });
        }
        let [clear, zpass, zfail, bin, upload, count, verdict, total] = best;
        println!(
            "light {l}: base {base}, side triangles {tris}, quads {} pairs {} tiles {} ",
            figures.quads, figures.pairs, figures.tiles
        );
        println!(
            "  clear {clear:.1}  raster z-pass sides {:.1}  z-fail whole {:.1} | tile total {:.1}: bin {bin:.1} upload {upload:.1} count {count:.1} verdict {:.1}; ns/pair {:.1} (count), {:.1} (bin)",
            zpass - clear,
            zfail - clear,
            total - clear,
            verdict - clear,
            count * 1e6 / figures.pairs as f64,
            bin * 1e6 / figures.pairs as f64
        );
        // compare
        let mut e = g.device.create_command_encoder(&Default::default());
        stencil_pass(&mut e, &attach, base, |p| raster.sides(p, &plan, batch.clone(), true));
        let a = read_stencil(g, e, &depth);
        let mut e = g.device.create_command_encoder(&Default::default());
        stencil_pass(&mut e, &attach, 0, |p| raster.sides(p, &plan, batch.clone(), false));
        let f = read_stencil(g, e, &depth);
        let mut e = g.device.create_command_encoder(&Default::default());
        stencil_pass(&mut e, &attach, 0, |p| pass.draw(&g.device, p, &pipeline, 0));
        let v = read_stencil(g, e, &depth);
        let counts = a.clone();
        let dz = read_depth(g, &depth);
        let mut diff = [0; 4];
        let mut where_ = Vec::new();
        for i in 0..a.len() {
            if dz[i] == 0.0 {
                continue;
            }
            diff[0] += usize::from(a[i] != counts[i]);
            if a[i] != counts[i] {
                where_.push((i % 1280, i / 1280, a[i], counts[i], f[i]));
            }
            if (a[i] != 0) != (v[i] != 0) {
                where_.push((i % 1280, i / 1280, a[i], v[i], f[i]));
            }
            diff[1] += usize::from((a[i] != 0) != (v[i] != 0));
            diff[2] += usize::from((f[i] != 0) != (v[i] != 0));
            diff[3] += usize::from(f[i] != a[i]);
        }
        println!(
            "  count differs from raster z-pass on {} px, verdict on {} px; verdict from z-fail {}; z-fail from z-pass {} px; {:?}",
            diff[0],
            diff[1],
            diff[2],
            diff[3],
            where_.iter().step_by(1 + where_.len() / 8).collect::<Vec<_>>()
        );
    }
}

fn stencil_pass(
    e: &mut wgpu::CommandEncoder,
    view: &wgpu::TextureView,
    clear: i32,
    f: impl FnOnce(&mut wgpu::RenderPass<'_>),
) {
    let mut pass = e.begin_render_pass(&wgpu::RenderPassDescriptor {
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view,
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store }),
            stencil_ops: Some(wgpu::Operations {
                load: wgpu::LoadOp::Clear((clear & 255) as u32),
                store: wgpu::StoreOp::Store,
            }),
        }),
        ..Default::default()
    });
    f(&mut pass);
}

fn depth_target(g: &Gpu, view: &View, scene: &zfail_plan::scene::Scene) -> wgpu::Texture {
    let texture = g.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: SIZE[0], height: SIZE[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT
            | wgpu::TextureUsages::COPY_SRC
            | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    let module = g.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(
            "
@group(0) @binding(0) var<uniform> clip_from_object: mat4x4<f32>;
struct Out { @invariant @builtin(position) clip: vec4<f32> }
@vertex fn main(@location(0) position: vec3<f32>) -> Out { return Out(clip_from_object * vec4<f32>(position, 1.0)); }"
                .into(),
        ),
    });
    let pipeline = g.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: None,
            compilation_options: Default::default(),
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: 12,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &wgpu::vertex_attr_array![0 => Float32x3],
            })],
        },
        primitive: Default::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: FORMAT,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Greater),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: None,
        multiview_mask: None,
        cache: None,
    });
    let mut e = g.device.create_command_encoder(&Default::default());
    {
        let attach = texture.create_view(&Default::default());
        let mut pass = e.begin_render_pass(&wgpu::RenderPassDescriptor {
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &attach,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
                stencil_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0), store: wgpu::StoreOp::Store }),
            }),
            ..Default::default()
        });
        pass.set_pipeline(&pipeline);
        for i in &scene.instances {
            let mesh = &scene.meshes[i.mesh];
            let buffer = |contents: &[u8], usage| {
                g.device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: None, contents, usage })
            };
            let m = buffer(
                bytemuck::cast_slice(&view.clip_from_object(&i.world_from_object).to_cols_array()),
                wgpu::BufferUsages::UNIFORM,
            );
            let b = g.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: None,
                layout: &pipeline.get_bind_group_layout(0),
                entries: &[wgpu::BindGroupEntry { binding: 0, resource: m.as_entire_binding() }],
            });
            pass.set_bind_group(0, &b, &[]);
            pass.set_vertex_buffer(
                0,
                buffer(bytemuck::cast_slice(&mesh.positions), wgpu::BufferUsages::VERTEX).slice(..),
            );
            pass.set_index_buffer(
                buffer(bytemuck::cast_slice(&mesh.triangles), wgpu::BufferUsages::INDEX).slice(..),
                wgpu::IndexFormat::Uint32,
            );
            pass.draw_indexed(0..mesh.triangles.len() as u32 * 3, 0, 0..1);
        }
    }
    g.queue.submit([e.finish()]);
    g.device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
    texture
}

/// Sides alone in z-pass, one draw per volume, or the whole volume in z-fail.
struct Raster {
    pipelines: [[wgpu::RenderPipeline; 2]; 2],
    bindings: wgpu::BindGroup,
    indices: wgpu::Buffer,
    first: Vec<u32>,
}
impl Raster {
    fn new(g: &Gpu, view: &View, casters: &[plan::Caster<'_>], plan: &plan::FramePlan) -> Self {
        let mut positions: Vec<[f32; 3]> = Vec::new();
        let mut first_of = std::collections::BTreeMap::new();
        for c in casters {
            first_of.entry(c.mesh).or_insert_with(|| {
                let f = positions.len() as u32;
                positions.extend(&c.topology.positions);
                f
            });
        }
        let mut records: Vec<f32> = Vec::new();
        for d in &plan.draws {
            records.extend(view.clip_from_object(&casters[d.caster as usize].world_from_object).to_cols_array());
            records.extend(d.light.to_array());
            records.extend(d.cap.to_array());
        }
        let first = plan.draws.iter().map(|d| first_of[&casters[d.caster as usize].mesh]).collect();
        let buffer = |contents: &[u8], usage| {
            g.device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: None, contents, usage })
        };
        let p = buffer(bytemuck::cast_slice(&positions), wgpu::BufferUsages::STORAGE);
        let r = buffer(bytemuck::cast_slice(&records), wgpu::BufferUsages::STORAGE);
        let indices = buffer(bytemuck::cast_slice(&plan.indices), wgpu::BufferUsages::INDEX);
        let module = g.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl(include_str!("../src/volume.wgsl").into()),
        });
        let entry = |binding| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::VERTEX,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Storage { read_only: true },
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        };
        let layout = g
            .device
            .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &[entry(0), entry(1)] });
        let pl = g.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let make = |zpass: bool, mirrored: bool| {
            let (inc, dec) = (wgpu::StencilOperation::IncrementWrap, wgpu::StencilOperation::DecrementWrap);
            let face = |pass_op, depth_fail_op| wgpu::StencilFaceState {
                compare: wgpu::CompareFunction::Always,
                fail_op: wgpu::StencilOperation::Keep,
                depth_fail_op,
                pass_op,
            };
            let k = wgpu::StencilOperation::Keep;
            let (front, back) = if zpass { (face(inc, k), face(dec, k)) } else { (face(k, dec), face(k, inc)) };
            g.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: None,
                layout: Some(&pl),
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: Some("volume"),
                    compilation_options: Default::default(),
                    buffers: &[],
                },
                primitive: wgpu::PrimitiveState {
                    front_face: if mirrored { wgpu::FrontFace::Cw } else { wgpu::FrontFace::Ccw },
                    ..Default::default()
                },
                depth_stencil: Some(wgpu::DepthStencilState {
                    format: FORMAT,
                    depth_write_enabled: Some(false),
                    depth_compare: Some(wgpu::CompareFunction::Greater),
                    stencil: wgpu::StencilState { front, back, read_mask: 0, write_mask: 0xff },
                    bias: Default::default(),
                }),
                multisample: Default::default(),
                fragment: None,
                multiview_mask: None,
                cache: None,
            })
        };
        let pipelines = [true, false].map(|z| [false, true].map(|m| make(z, m)));
        let bindings = g.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: p.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: r.as_entire_binding() },
            ],
        });
        Self { pipelines, bindings, indices, first }
    }
    fn sides(&self, pass: &mut wgpu::RenderPass<'_>, plan: &plan::FramePlan, batch: std::ops::Range<u32>, zpass: bool) {
        pass.set_bind_group(0, &self.bindings, &[]);
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
        for d in batch {
            let draw = &plan.draws[d as usize];
            pass.set_pipeline(&self.pipelines[usize::from(!zpass)][usize::from(draw.mirrored)]);
            let r = if zpass { draw.volume.sides.clone() } else { draw.volume.outward() };
            pass.draw_indexed(r, (self.first[d as usize] * 2) as i32, d..d + 1);
        }
    }
}

fn read_buffer(g: &Gpu, mut e: wgpu::CommandEncoder, from: &wgpu::Buffer, size: u64) -> Vec<u8> {
    let read = g.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size,
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    e.copy_buffer_to_buffer(from, 0, &read, 0, size);
    g.queue.submit([e.finish()]);
    read.slice(..).map_async(wgpu::MapMode::Read, |r| r.unwrap());
    g.device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
    read.slice(..).get_mapped_range().unwrap().to_vec()
}

fn read_aspect(
    g: &Gpu,
    mut e: wgpu::CommandEncoder,
    t: &wgpu::Texture,
    aspect: wgpu::TextureAspect,
    bytes: u32,
) -> Vec<u8> {
    let size = u64::from(SIZE[0] * SIZE[1] * bytes);
    let out = g.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size,
        usage: wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    e.copy_texture_to_buffer(
        wgpu::TexelCopyTextureInfo { texture: t, mip_level: 0, origin: Default::default(), aspect },
        wgpu::TexelCopyBufferInfo {
            buffer: &out,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(SIZE[0] * bytes),
                rows_per_image: None,
            },
        },
        wgpu::Extent3d { width: SIZE[0], height: SIZE[1], depth_or_array_layers: 1 },
    );
    read_buffer(g, e, &out, size)
}
fn read_stencil(g: &Gpu, e: wgpu::CommandEncoder, t: &wgpu::Texture) -> Vec<u8> {
    read_aspect(g, e, t, wgpu::TextureAspect::StencilOnly, 1)
}
fn read_depth(g: &Gpu, t: &wgpu::Texture) -> Vec<f32> {
    let e = g.device.create_command_encoder(&Default::default());
    bytemuck::pod_collect_to_vec(&read_aspect(g, e, t, wgpu::TextureAspect::DepthOnly, 4))
}
#[allow(unused)]
fn unused(_: DAffine3) {}
