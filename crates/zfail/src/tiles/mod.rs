//! Shadow counts per tile, in a compute shader, instead of rasterising long thin side quads.
//!
//! In: sides of volumes that z-pass may count, the finished depth. Out: counts, and from them the stencil.
//! Hierarchical shadow volumes (Aila & Akenine-Moller 2004) decide whole tiles likewise.

mod bins;
mod sides;

pub use sides::Sides;

use bins::Bins;
use sides::{Quad, Setup};
use wgpu::*;
use zfail_plan::scene::Bounds;

#[derive(Debug)]
pub struct TilePass {
    count: ComputePipeline,
    verdict: RenderPipeline,
    bins: Bins,
    quads: Vec<Quad>,
    buffers: Vec<Buffer>,
    textures: Vec<Texture>,
}

impl TilePass {
    pub fn new(device: &Device, depth_stencil: TextureFormat) -> Self {
        let mut source = include_str!("count.wgsl").to_owned();
        let (mut depths, mut counts, mut columns) = (String::new(), String::new(), String::new());
        for c in 0..8 {
            depths += &format!("let dl{c} = stored(min(x + {c}u, image.size.x - 1u), y); let dh{c} = stored(min(x + {c}u, image.size.x - 1u), y + 4u);\n");
            counts += &format!("var nl{c} = vec4(image.base); var nh{c} = vec4(image.base);\n");
            columns += &format!("nl{c} += column(e, dy, weight, dl{c}); nh{c} += column(e + dy4, dy, weight, dh{c}); e += dx;\n");
        }
        let word = |base: u32| (0..4).map(|c| format!("(bits(nl{}) << {}u) | (bits(nh{}) << {}u)", base + c, c * 8, base + c, c * 8 + 4)).collect::<Vec<_>>().join(" | ");
        for (name, value) in [("DEPTHS", depths), ("COUNTS", counts), ("COLUMNS", columns), ("LO", word(0)), ("HI", word(4))] {
            source = source.replace(name, &value);
        }
        let module = device.create_shader_module(ShaderModuleDescriptor { label: None, source: ShaderSource::Wgsl(source.into()) });
        let count = device.create_compute_pipeline(&ComputePipelineDescriptor {
            label: Some("tile counts"),
            layout: None,
            module: &module,
            entry_point: None,
            compilation_options: PipelineCompilationOptions::default(),
            cache: None,
        });
        let module = device.create_shader_module(include_wgsl!("verdict.wgsl"));
        let face = StencilFaceState { pass_op: StencilOperation::Replace, ..StencilFaceState::IGNORE };
        let verdict = device.create_render_pipeline(&RenderPipelineDescriptor {
            label: Some("tile verdict"),
            layout: None,
            vertex: VertexState {
                module: &module,
                entry_point: None,
                compilation_options: PipelineCompilationOptions::default(),
                buffers: &[],
            },
            primitive: PrimitiveState::default(),
            depth_stencil: Some(DepthStencilState {
                format: depth_stencil,
                depth_write_enabled: Some(false),
                depth_compare: Some(CompareFunction::Always),
                stencil: StencilState { front: face, back: face, read_mask: 0, write_mask: 0xff },
                bias: DepthBiasState::default(),
            }),
            multisample: MultisampleState::default(),
            fragment: Some(FragmentState {
                module: &module,
                entry_point: None,
                compilation_options: PipelineCompilationOptions::default(),
                targets: &[],
            }),
            multiview_mask: None,
            cache: None,
        });
        Self { count, verdict, bins: Bins::default(), quads: Vec::new(), buffers: Vec::new(), textures: Vec::new() }
    }

    /// (quads, pairs, tiles)
    pub fn bin<'a>(&mut self, sides: impl Iterator<Item = Sides<'a>>, bounds: Bounds, size: [u32; 2]) -> [usize; 4] {
        self.quads.clear();
        self.quads.push(bytemuck::Zeroable::zeroed());
        self.bins.clear(size);
        for sides in sides {
            Setup::new(sides, bounds, size).quads(|quad, footprint| {
                let item = self.quads.len() as u32;
                self.quads.push(quad);
                if footprint.is_empty() {
                    self.bins.add_everywhere(item);
                } else {
                    self.bins.add(footprint, item);
                }
            });
        }
        self.bins.finish();
        [self.quads.len() - 1, self.bins.pairs as usize, self.bins.groups.len() * 8, self.bins.entries.len()]
    }

    pub fn upload(&mut self, device: &Device, queue: &Queue, base: i32, size: [u32; 2]) {
        if self.buffers.is_empty() {
            let make = |usage, size| {
                device.create_buffer(&BufferDescriptor {
                    label: None,
                    size,
                    usage: usage | BufferUsages::COPY_DST | BufferUsages::COPY_SRC,
                    mapped_at_creation: false,
                })
            };
            let s = BufferUsages::STORAGE;
            self.buffers = vec![make(BufferUsages::UNIFORM, 16), make(s, 1 << 20), make(s, 1 << 20)];
            let make = |w, h, format, usage| device.create_texture(&TextureDescriptor { label: None, size: Extent3d { width: w, height: h, depth_or_array_layers: 1 }, mip_level_count: 1, sample_count: 1, dimension: TextureDimension::D2, format, usage: TextureUsages::TEXTURE_BINDING | usage, view_formats: &[] });
            let c = TextureUsages::COPY_DST;
            self.textures = vec![make(2048, 256, TextureFormat::Rgba32Float, c), make(2048, 4096, TextureFormat::R32Uint, c), make(4096, 1024, TextureFormat::R32Uint, c | TextureUsages::STORAGE_BINDING)];
        }
        let b = &self.buffers;
        let write = |t: &Texture, data: &[u8], texel: u32| {
            let h = (data.len() as u32).div_ceil(2048 * texel);
            queue.write_texture(TexelCopyTextureInfo { texture: t, mip_level: 0, origin: Origin3d::ZERO, aspect: TextureAspect::All }, &data,
                TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(2048 * texel), rows_per_image: None }, Extent3d { width: 2048, height: h, depth_or_array_layers: 1 });
        };
        self.quads.resize(self.quads.len().next_multiple_of(512), bytemuck::Zeroable::zeroed());
        write(&self.textures[0], bytemuck::cast_slice(&self.quads), 16);
        write(&self.textures[1], bytemuck::cast_slice(&self.bins.entries), 4);
        queue.write_buffer(&b[0], 0, bytemuck::cast_slice(&[size[0], size[1], base.cast_unsigned(), 0]));
        queue.write_buffer(&b[1], 0, bytemuck::cast_slice(&self.bins.groups));
        queue.write_buffer(&b[2], 0, bytemuck::cast_slice(&self.bins.occupied));
        let fill = vec![if base == 0 { 0_u32 } else { !0 }; 256 * 128];
        for x in [0, 2048] {
            queue.write_texture(TexelCopyTextureInfo { texture: &self.textures[2], mip_level: 0, origin: Origin3d { x, y: 0, z: 0 }, aspect: TextureAspect::All }, bytemuck::cast_slice(&fill),
                TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(256 * 4), rows_per_image: None }, Extent3d { width: self.bins.tiles[0], height: self.bins.tiles[1], depth_or_array_layers: 1 });
        }
    }

    pub fn encode(&self, device: &Device, encoder: &mut CommandEncoder, depth: &TextureView) {
        let views: Vec<_> = self.textures.iter().map(|t| t.create_view(&TextureViewDescriptor::default())).collect();
        let texture = |binding, i: usize| BindGroupEntry { binding, resource: BindingResource::TextureView(&views[i]) };
        let buffer = |binding, i: usize| BindGroupEntry { binding, resource: self.buffers[i].as_entire_binding() };
        let bindings = device.create_bind_group(&BindGroupDescriptor {
            label: None,
            layout: &self.count.get_bind_group_layout(0),
            entries: &[buffer(0, 0), texture(1, 0), texture(2, 1), buffer(3, 1), buffer(4, 2), BindGroupEntry { binding: 5, resource: BindingResource::TextureView(depth) }, texture(6, 2)],
        });
        let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor::default());
        pass.set_pipeline(&self.count);
        pass.set_bind_group(0, &bindings, &[]);
        pass.dispatch_workgroups(self.bins.groups.len() as u32, 1, 1);
    }

    pub fn draw(&self, device: &Device, pass: &mut RenderPass<'_>) {
        let view = self.textures[2].create_view(&TextureViewDescriptor::default());
        let bindings = device.create_bind_group(&BindGroupDescriptor {
            label: None,
            layout: &self.verdict.get_bind_group_layout(0),
            entries: &[BindGroupEntry { binding: 0, resource: BindingResource::TextureView(&view) }],
        });
        pass.set_pipeline(&self.verdict);
        pass.set_bind_group(0, &bindings, &[]);
        pass.set_stencil_reference(0x80);
        pass.draw(0..3, 0..1);
    }
}
impl TilePass {
    pub fn debug(&self, x: u32, y: u32, size: [u32; 2]) {
        let (u, v) = (x as f32 + 0.5 - 0.5 * size[0] as f32, y as f32 + 0.5 - 0.5 * size[1] as f32);
        let mut n = 0;
        for (i, q) in self.quads.iter().enumerate() {
            let e = q.eval(u, v);
            if e[0].is_sign_positive() && e[1].is_sign_positive() && e[2].is_sign_negative() && e[3] > 0.0 {
                n += 1;
                let listed = self.bins.debug(x / 8, y / 8, i as u32);
                println!("  quad {i} {e:?} listed {listed} {q:?}");
            }
        }
        println!("{n} cover {x} {y}");
    }
}
