//! The tile pass: shadow counts from a compute shader, where rasterising long thin sides would cost more.
//!
//! In: the sides of the casters that z-pass may count, the count at the near plane, and the finished depth. Out: the
//! verdict in the stencil, as if the sides had been drawn there (decision record 0012).
//!
//! It follows hierarchical shadow volumes (Aila & Akenine-Moller 2004) in that whole tiles are decided before pixels: the
//! CPU lists each side quad in the tiles where it may lie before something visible, and only there do pixels look at it.

mod bins;
mod buffers;
mod quad;
mod verdict;

pub use quad::Sides;
pub use verdict::VerdictPipeline;

use crate::error::Error;
use bins::{Bins, TILE};
use buffers::{Buffers, GroupRecord};
use bytemuck::Zeroable;
use glam::DVec2;
use quad::{Quad, Sight};
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor, BindGroupLayoutEntry,
    BindingResource, BindingType, BufferBindingType, CommandEncoder, ComputePassDescriptor, ComputePipeline,
    ComputePipelineDescriptor, Device, PipelineCompilationOptions, PipelineLayoutDescriptor, Queue, RenderPass,
    ShaderStages, StorageTextureAccess, TextureFormat, TextureSampleType, TextureView, TextureViewDimension,
};
use zfail_plan::bounds::Bounds;
use zfail_plan::scissor::{self, Rectangle};
use zfail_plan::view::{Projection, View};

/// Sides of a frame's lights as the tile pass counts them. Memory is kept between frames.
#[derive(Debug)]
pub struct TilePass {
    count: ComputePipeline,
    count_layout: BindGroupLayout,
    verdict_layout: BindGroupLayout,
    verdicts: Option<BindGroup>,
    /// The eye and all that it sees; `None` if the view has no eye.
    sight: Option<Sight>,
    size: [u32; 2],
    bins: Bins,
    found: Vec<bins::Group>,
    quads: Vec<Quad>,
    entries: Vec<u32>,
    groups: Vec<GroupRecord>,
    places: Vec<u32>,
    lights: Vec<Light>,
    buffers: Buffers,
}

/// One light of the frame.
#[derive(Debug)]
struct Light {
    base: i32,
    /// Where it begins among all lights' rows of tiles.
    row: u32,
    /// Pixels that can be in shadow.
    scissor: Rectangle,
}

/// Figures of one light in the tile pass, for reports and cost models.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TileStats {
    /// Side quads in sight.
    pub quads: usize,
    /// Pairs of a quad and a tile in which it is tested.
    pub pairs: usize,
    /// Tiles with at least one quad.
    pub tiles: usize,
}

impl TilePass {
    /// A tile pass on `device`.
    #[must_use]
    pub fn new(device: &Device) -> Self {
        let count_layout = count_layout(device);
        let module = device.create_shader_module(wgpu::include_wgsl!("count.wgsl"));
        let layout = device.create_pipeline_layout(&PipelineLayoutDescriptor {
            label: Some("tile counts"),
            bind_group_layouts: &[Some(&count_layout)],
            immediate_size: 0,
        });
        let count = device.create_compute_pipeline(&ComputePipelineDescriptor {
            label: Some("tile counts"),
            layout: Some(&layout),
            module: &module,
            entry_point: None,
            compilation_options: PipelineCompilationOptions {
                constants: &[("LANES", bins::LANES as f64)],
                ..PipelineCompilationOptions::default()
            },
            cache: None,
        });
        Self {
            count,
            count_layout,
            verdict_layout: verdict::layout(device),
            verdicts: None,
            sight: None,
            size: [0; 2],
            bins: Bins::default(),
            found: Vec::new(),
            quads: Vec::new(),
            entries: Vec::new(),
            groups: Vec::new(),
            places: Vec::new(),
            lights: Vec::new(),
            buffers: Buffers::new(device),
        }
    }

    /// Forgets the last frame's lights and begins with a new view. `visible` are world-space bounds of all surfaces in it
    /// that a light of this pass can reach: shadows beyond them are not looked for, and pixels without a surface get any
    /// verdict.
    pub fn begin(&mut self, view: &View, visible: &Bounds) {
        self.size = view.size;
        self.quads.clear();
        // What fills up the shorter lists: depth is 0, never before anything.
        self.quads.push(Quad::zeroed());
        self.entries.clear();
        self.groups.clear();
        self.places.clear();
        self.lights.clear();
        self.sight = matches!(view.projection, Projection::Perspective { .. }).then(|| {
            // A ray from the eye to a visible point stays within the bounds of both.
            let mut bounds = *visible;
            bounds.add(view.eye());
            let margin = 1e-4 * bounds.half().length();
            bounds.min -= margin;
            bounds.max += margin;
            Sight { bounds, size: DVec2::new(view.size[0].into(), view.size[1].into()) }
        });
    }

    /// Adds a light with the `sides` of its volumes. `base` is the sum of the counts at the near plane of the casters
    /// they belong to, the same on all of the near rectangle, which none of the sides may cross.
    ///
    /// `worth` is asked whether so many pairs of a quad and a tile are worth it.
    ///
    /// Returns figures of the light, which [`Self::draw`] knows by the number of lights added before it, or `None` if it
    /// has to be rasterised: the view is orthographic, the pairs are not worth it, or the lists outgrow the device's
    /// textures.
    ///
    /// # Panics
    /// If `sides` refer to positions that there are not.
    pub fn add<'a>(
        &mut self,
        device: &Device,
        base: i32,
        sides: impl IntoIterator<Item = Sides<'a>>,
        worth: impl FnOnce(usize) -> bool,
    ) -> Option<TileStats> {
        let sight = self.sight?;
        let before = (self.quads.len(), self.entries.len(), self.places.len());
        self.bins.clear(self.size);
        for volume in sides {
            sight.quads(&volume, |quad, footprint| {
                self.bins.add(self.quads.len() as u32, footprint, volume.scissor);
                self.quads.push(quad);
            });
        }
        let pairs = self.bins.pairs();
        if !worth(pairs) {
            self.quads.truncate(before.0);
            return None;
        }
        let rows = self.size[1].div_ceil(TILE);
        let row = self.lights.len() as u32 * rows;
        let limits = device.limits();
        let fits = |quads, entries| buffers::fit(&limits, quads, entries, (row + rows) as usize);
        self.found.clear();
        // Groups add entries, so ask before and after.
        let may_fit = fits(self.quads.len(), before.1 + pairs);
        if may_fit {
            self.bins.append(&mut self.entries, &mut self.found, &mut self.places);
        }
        if !may_fit || !fits(self.quads.len(), self.entries.len()) {
            self.quads.truncate(before.0);
            self.entries.truncate(before.1);
            self.places.truncate(before.2);
            return None;
        }
        self.groups.extend(self.found.iter().map(|&bins::Group { first, length }| GroupRecord {
            first,
            length,
            row,
            base,
        }));
        let places = &self.places[before.2..];
        let scissor = if base == 0 { around(places, self.size) } else { [0, 0, self.size[0], self.size[1]] };
        self.lights.push(Light { base, row, scissor });
        let tiles = places.iter().filter(|&&place| place != bins::NO_TILE).count();
        Some(TileStats { quads: self.quads.len() - before.0, pairs, tiles })
    }

    /// Uploads the lights added since [`Self::begin`].
    ///
    /// # Errors
    /// Lists that are too large for the device's buffers.
    pub fn upload(&mut self, device: &Device, queue: &Queue) -> Result<(), Error> {
        let bases = self.lights.iter().map(|light| light.base);
        self.buffers.upload(device, queue, self.size, &self.groups, &self.places, &self.entries, &self.quads, bases)?;
        self.verdicts = Some(device.create_bind_group(&BindGroupDescriptor {
            label: Some("tile verdict"),
            layout: &self.verdict_layout,
            entries: &[BindGroupEntry { binding: 0, resource: BindingResource::TextureView(self.buffers.shadowed()) }],
        }));
        Ok(())
    }

    /// Encodes the counting of all lights. `depth` is the finished depth of the view, a view of the depth aspect alone of a
    /// texture with one sample.
    pub fn encode(&self, device: &Device, encoder: &mut CommandEncoder, depth: &TextureView) {
        if self.groups.is_empty() {
            return;
        }
        let bindings = device.create_bind_group(&BindGroupDescriptor {
            label: Some("tile counts"),
            layout: &self.count_layout,
            entries: &self.buffers.entries(depth),
        });
        let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor {
            label: Some("tile counts"),
            ..ComputePassDescriptor::default()
        });
        pass.set_pipeline(&self.count);
        pass.set_bind_group(0, &bindings, &[]);
        let [x, y] = buffers::workgroups(self.groups.len());
        pass.dispatch_workgroups(x, y, 1);
    }

    /// Encodes the verdict on the `light`th light added: the stencil of pixels in its shadow is set, that of others is left
    /// as it is, and so are those not `within`. Volumes that are rasterised for the same light come before.
    ///
    /// Sets pipeline, bind group 0, stencil reference and scissor.
    pub fn draw(&self, pass: &mut RenderPass<'_>, pipeline: &VerdictPipeline, light: usize, within: Rectangle) {
        let (Some(&Light { row, scissor, .. }), Some(bindings)) = (self.lights.get(light), &self.verdicts) else {
            return;
        };
        if let Some([x, y, width, height]) = scissor::intersection(scissor, within) {
            pass.set_scissor_rect(x, y, width, height);
            pipeline.draw(pass, bindings, row);
        }
    }
}

/// The pixels of the tiles at `places`, within an image of `size` pixels.
fn around(places: &[u32], size: [u32; 2]) -> Rectangle {
    let tiles = places.iter().filter(|&&place| place != bins::NO_TILE).map(|place| [place & 0xffff, place >> 16]);
    let (lo, hi) = tiles.fold(([u32::MAX; 2], [0; 2]), |(lo, hi), tile| {
        (std::array::from_fn(|i| tile[i].min(lo[i])), std::array::from_fn(|i| (tile[i] + 1).max(hi[i])))
    });
    if lo[0] == u32::MAX {
        return [0; 4];
    }
    let [x, y] = lo.map(|tile| tile * TILE);
    [x, y, (hi[0] * TILE).min(size[0]) - x, (hi[1] * TILE).min(size[1]) - y]
}

fn sampled(binding: u32, visibility: ShaderStages, sample_type: TextureSampleType) -> BindGroupLayoutEntry {
    let view_dimension = TextureViewDimension::D2;
    let ty = BindingType::Texture { sample_type, view_dimension, multisampled: false };
    BindGroupLayoutEntry { binding, visibility, ty, count: None }
}

fn count_layout(device: &Device) -> BindGroupLayout {
    let buffer = |binding, ty| BindGroupLayoutEntry {
        binding,
        visibility: ShaderStages::COMPUTE,
        ty: BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None },
        count: None,
    };
    let list = BufferBindingType::Storage { read_only: true };
    let texture = |binding, sample_type| sampled(binding, ShaderStages::COMPUTE, sample_type);
    device.create_bind_group_layout(&BindGroupLayoutDescriptor {
        label: Some("tile counts"),
        entries: &[
            buffer(0, BufferBindingType::Uniform),
            buffer(1, list),
            buffer(2, list),
            texture(3, TextureSampleType::Uint),
            texture(4, TextureSampleType::Float { filterable: false }),
            // Depth textures may be bound so, and every backend can fetch from them then.
            texture(5, TextureSampleType::Float { filterable: false }),
            BindGroupLayoutEntry {
                binding: 6,
                visibility: ShaderStages::COMPUTE,
                ty: BindingType::StorageTexture {
                    access: StorageTextureAccess::WriteOnly,
                    format: TextureFormat::R32Uint,
                    view_dimension: TextureViewDimension::D2,
                },
                count: None,
            },
        ],
    })
}
