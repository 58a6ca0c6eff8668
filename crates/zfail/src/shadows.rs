//! Shadow determination for a host renderer: meshes in, stencil verdict out.

use crate::arena::Arena;
use crate::cost::CostModel;
use crate::error::Error;
use crate::frame_buffers::{DrawRecord, FrameBuffers};
use crate::pipelines::{Pipelines, STICKY, Target, Variant};
use crate::silhouettes::{List, Place, Silhouettes};
use crate::tiled::{Prepared, Tiled, TiledLight, can_tile};
use crate::tiles::TileStats;
use glam::DAffine3;
use std::ops::Range;
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor, BindGroupLayoutEntry,
    BindingType, BufferBindingType, CommandEncoder, Device, IndexFormat, Queue, RenderPass, RenderPipeline,
    ShaderModule, ShaderStages, TextureView,
};
use zfail_plan::bounds::Bounds;
use zfail_plan::plan::{
    self, Counting, DarkCap, Draw, Extraction, FramePlan, LightCap, LightStats, Planner, ShadowLight, Steps, Tiles,
};
use zfail_plan::scissor::Rectangle;
use zfail_plan::topology::{Blocking, Topology};
use zfail_plan::view::View;

/// A mesh registered with one [`Shadows`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct MeshId {
    pub(crate) slot: usize,
    pub(crate) serial: u64,
}

/// A mesh placed in the world that blocks light.
#[derive(Clone, Copy, Debug)]
pub struct Caster {
    /// Which mesh.
    pub mesh: MeshId,
    /// Object to world; invertible, may mirror, shear and scale.
    pub world_from_object: DAffine3,
}

/// Everything that one frame's shadows depend on.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// The camera.
    pub view: &'a View,
    /// What blocks light.
    pub casters: &'a [Caster],
    /// What shines, in the order in which [`Shadows::draw`] counts.
    pub lights: &'a [ShadowLight<'a>],
    /// Boxes in world space that together hold every surface in the depth buffer; empty if you do not know. They
    /// save drawing volumes where there is nothing to shadow.
    pub receivers: &'a [Bounds],
    /// Which steps to take; those of [`Technique::Auto`](plan::Technique::Auto) unless you compare.
    pub steps: Steps,
    /// What the stencil is to hold; [`Counting::Verdict`] unless you look at counts.
    pub counting: Counting,
}

/// Registered meshes and the current frame's volumes.
#[derive(Debug)]
pub struct Shadows {
    arena: Arena,
    planner: Planner,
    buffers: FrameBuffers,
    layout: BindGroupLayout,
    bindings: BindGroup,
    module: ShaderModule,
    /// Where each draw's positions begin, parallel to the plan's draws.
    first_positions: Vec<u32>,
    finite: bool,
    image: Rectangle,
    prepared: Option<Prepared>,
    tiled: Option<Tiled>,
    /// By caster of the frame: whether the device can find its silhouettes, and is to if its light moves.
    extractable: Vec<bool>,
    silhouettes: Option<Silhouettes>,
    /// Whether `tiled` belongs to the prepared frame.
    counted: bool,
    costs: CostModel,
}

impl Shadows {
    /// Shadow determination on `device`, without any mesh yet.
    #[must_use]
    pub fn new(device: &Device) -> Self {
        let layout = volume_layout(device);
        let arena = Arena::new(device);
        let buffers = FrameBuffers::new(device);
        let bindings = bind(device, &layout, &arena, &buffers);
        let module = device.create_shader_module(wgpu::include_wgsl!("volume.wgsl"));
        Self {
            arena,
            planner: Planner::new(),
            buffers,
            layout,
            bindings,
            module,
            first_positions: Vec::new(),
            finite: false,
            image: [0; 4],
            prepared: None,
            tiled: None,
            extractable: Vec::new(),
            silhouettes: None,
            counted: false,
            costs: CostModel::RASTERISE,
        }
    }

    /// Registers a mesh: the very triangles that the depth pass draws, with their vertices in the same order.
    /// `positions` are in object space, best kept near its origin; they may repeat (the mesh is welded by exact
    /// position). `surface` tells of each triangle whether it blocks light (a `bool`), or also whether the depth pass draws
    /// it from both sides or not everywhere (a [`Blocking`]).
    ///
    /// # Errors
    /// Indices out of range, coordinates that are not finite, or more vertices than the device's buffers hold.
    pub fn add_mesh<S: Into<Blocking>>(
        &mut self,
        device: &Device,
        queue: &Queue,
        positions: &[[f32; 3]],
        triangles: &[[u32; 3]],
        surface: impl Fn(usize) -> S,
    ) -> Result<MeshId, Error> {
        self.add_topology(device, queue, Topology::new(positions, triangles, surface)?)
    }

    /// Registers a mesh whose topology is known already: one made elsewhere, or one that bends ([`Topology::bending`]).
    ///
    /// # Errors
    /// More vertices than the device's buffers hold.
    pub fn add_topology(&mut self, device: &Device, queue: &Queue, topology: Topology) -> Result<MeshId, Error> {
        let (slot, serial, moved) = self.arena.add(device, queue, topology)?;
        if moved {
            self.bindings = bind(device, &self.layout, &self.arena, &self.buffers);
        }
        Ok(MeshId { slot, serial })
    }

    /// Moves the vertices of a mesh that bends ([`Topology::bending`]): the very positions that the depth pass will draw, in
    /// the order in which its topology was made. Silhouettes and bounds follow at the next [`Self::prepare`].
    ///
    /// # Errors
    /// A mesh that is not registered or rigid, another number of positions, or coordinates that are not finite. Nothing
    /// has moved then.
    pub fn move_vertices(&mut self, queue: &Queue, mesh: MeshId, positions: &[[f32; 3]]) -> Result<(), Error> {
        self.arena.move_vertices(queue, mesh.slot, mesh.serial, positions)
    }

    /// Forgets a mesh and gives back its topology; `None` if it is not registered here.
    pub fn remove_mesh(&mut self, mesh: MeshId) -> Option<Topology> {
        if let Some(silhouettes) = &mut self.silhouettes {
            silhouettes.forget(mesh.serial);
        }
        self.arena.remove(mesh.slot, mesh.serial)
    }

    /// The topology of a registered mesh.
    #[must_use]
    pub fn topology(&self, mesh: MeshId) -> Option<&Topology> {
        self.arena.get(mesh.slot, mesh.serial).map(|m| &m.topology)
    }

    /// Pipelines for passes with the formats of `target`; make them once.
    #[must_use]
    pub fn pipelines(&self, device: &Device, target: &Target<'_>) -> Pipelines {
        Pipelines::new(device, &self.layout, &self.module, target)
    }

    /// Pipelines for [`Self::draw`] that leave the stencil as it is and add 1 to the first colour attachment, of a format that
    /// can be blended, for every fragment of a volume, whether it passes the depth test or not: what the volumes cost in fill.
    /// What the tile pass would count is rasterised too.
    #[must_use]
    pub fn fragment_counters(&self, device: &Device, target: &Target<'_>) -> Pipelines {
        Pipelines::counting_fragments(device, &self.layout, &self.module, target)
    }

    /// Plans every light of a frame and uploads its volumes, or submits compute work that finds them. Call it before
    /// encoding the frame's passes, and submit those before preparing the next frame. [`Self::plan`] then tells what will
    /// be drawn.
    ///
    /// # Errors
    /// A caster without a registered mesh or with a singular transform, or volumes too large for the device's buffers.
    /// Nothing is drawn then.
    pub fn prepare(&mut self, device: &Device, queue: &Queue, frame: &Frame<'_>) -> Result<(), Error> {
        self.counted = false;
        let outcome = self.plan_and_upload(device, queue, frame);
        if outcome.is_err() {
            self.planner = Planner::new();
            self.prepared = None;
        }
        outcome
    }

    /// What the device's times are: [`Steps::tiles`] and [`Steps::silhouettes`] are decided by them. Without it every
    /// volume is rasterised, and every silhouette found on the CPU.
    pub fn set_cost_model(&mut self, costs: CostModel) {
        self.costs = costs;
    }

    /// Chooses the lights whose sides a compute pass is to count, where that costs less than rasterising them. Optional,
    /// and exact either way. Call it after [`Self::prepare`]; if it returns `true`, [`Self::count_tiles`] has to be
    /// encoded before the frame's [`Self::draw`]s, and these have to go to targets with one sample.
    ///
    /// # Errors
    /// Lists that are too large for the device's buffers. All volumes are rasterised then.
    pub fn prepare_tiles(&mut self, device: &Device, queue: &Queue) -> Result<bool, Error> {
        self.counted = false;
        let Some(prepared) = self.prepared.as_ref().filter(|p| p.steps.tiles != Tiles::Never) else {
            return Ok(false);
        };
        let tiled = self.tiled.get_or_insert_with(|| Tiled::new(device));
        self.counted = tiled.choose(device, queue, prepared, self.planner.last(), &self.arena, self.costs)?;
        Ok(self.counted)
    }

    /// Encodes the compute pass that [`Self::prepare_tiles`] has prepared, if any: after the pass that finishes the depth of
    /// the view. `depth` is a view of the depth aspect alone, of a texture with one sample and the usage
    /// `TEXTURE_BINDING`.
    pub fn count_tiles(&self, device: &Device, encoder: &mut CommandEncoder, depth: &TextureView) {
        if let Some(tiled) = self.tiled.as_ref().filter(|_| self.counted) {
            tiled.pass.encode(device, encoder, depth);
        }
    }

    /// Whether [`Self::count_tiles`] has something to encode for the prepared frame.
    #[must_use]
    pub fn counts_tiles(&self) -> bool {
        self.counted
    }

    /// Figures of the tile pass for one light of the prepared frame, if it takes part.
    #[must_use]
    pub fn tile_stats(&self, light: usize) -> Option<TileStats> {
        self.tiled_light(light).map(|tiled| tiled.stats)
    }

    fn tiled_light(&self, light: usize) -> Option<TiledLight> {
        let tiled = self.tiled.as_ref().filter(|_| self.counted)?;
        tiled.lights.get(light).copied().flatten()
    }

    fn plan_and_upload(&mut self, device: &Device, queue: &Queue, frame: &Frame<'_>) -> Result<(), Error> {
        let mut casters = Vec::with_capacity(frame.casters.len());
        for (c, caster) in frame.casters.iter().enumerate() {
            let mesh = self.arena.get(caster.mesh.slot, caster.mesh.serial).ok_or(Error::UnknownMesh { caster: c })?;
            let world_from_object = caster.world_from_object;
            casters.push(plan::Caster { topology: &mesh.topology, mesh: mesh.version, world_from_object });
        }
        find_extractable(&mut self.extractable, device, frame, &self.arena, self.costs);
        let planned = plan::Frame {
            view: frame.view,
            casters: &casters,
            lights: frame.lights,
            receivers: frame.receivers,
            steps: frame.steps,
            counting: frame.counting,
        };
        let plan = self.planner.plan_extracting(&planned, &self.extractable)?;
        self.first_positions.clear();
        let first = |d: &Draw| {
            let mesh = frame.casters[d.caster as usize].mesh;
            self.arena.get(mesh.slot, mesh.serial).map_or(0, |mesh| mesh.first)
        };
        self.first_positions.extend(plan.draws.iter().map(first));
        let place = |caster: u32| frame.casters[caster as usize].world_from_object;
        let moved = self.buffers.upload(device, queue, plan, frame.view, place)?;
        if moved {
            self.bindings = bind(device, &self.layout, &self.arena, &self.buffers);
        }
        if self.silhouettes.is_some() || plan.lights.iter().any(|light| light.stats.extracted > 0) {
            let silhouettes = self.silhouettes.get_or_insert_with(|| Silhouettes::new(device));
            let caster = |draw: &Draw| {
                let caster = frame.casters.get(draw.caster as usize)?;
                let record = DrawRecord::new(draw, frame.view, &caster.world_from_object);
                Some((self.arena.get(caster.mesh.slot, caster.mesh.serial)?, record))
            };
            silhouettes.extract(device, queue, &self.layout, &self.arena, plan, caster);
        }
        let mut visible = Bounds::EMPTY;
        for receivers in frame.receivers.iter().filter(|bounds| !bounds.is_empty()) {
            visible.add(receivers.min);
            visible.add(receivers.max);
        }
        let mut kept = self.prepared.take().map(|prepared| prepared.casters).unwrap_or_default();
        kept.clear();
        kept.extend_from_slice(frame.casters);
        let (steps, counting) = (frame.steps, frame.counting);
        self.prepared = Some(Prepared { view: *frame.view, casters: kept, steps, counting, visible });
        self.finite = frame.view.has_far_plane();
        self.image = zfail_plan::scissor::full(frame.view);
        Ok(())
    }

    /// What the prepared frame draws.
    #[must_use]
    pub fn plan(&self) -> &FramePlan {
        self.planner.last()
    }

    /// Changes what the prepared frame draws: for figures of what goes wrong without a step, and for tests that see
    /// whether anyone would notice. Ranges of indices, scissors, z-pass and clear values may be changed, and draws
    /// emptied; indices, lights and transforms are on the device already.
    pub fn edit_plan(&mut self, edit: impl FnOnce(&mut FramePlan)) {
        edit(self.planner.last_mut());
    }

    /// Figures of one light of the prepared frame.
    #[must_use]
    pub fn stats(&self, light: usize) -> LightStats {
        self.plan().lights.get(light).map(|light| light.stats).unwrap_or_default()
    }

    /// Encodes the volumes of one light of the prepared frame. The pass holds the finished depth of the view and a
    /// stencil of 0; afterwards the stencil is 0 exactly where the light arrives (with [`Counting::Verdict`]).
    ///
    /// Sets pipeline, bind group 0, index buffer, stencil reference and scissor; the scissor is left at the whole image.
    ///
    /// Does nothing if the prepared frame has no such light, or the last [`Self::prepare`] failed.
    pub fn draw(&self, pass: &mut RenderPass<'_>, pipelines: &Pipelines, light: usize) {
        let plan = self.plan();
        // Samples of multisampled targets are not told apart by tiles.
        let tiled = self.tiled_light(light).and_then(|tiled| Some((tiled, pipelines.tiles.as_ref()?)));
        let Some(light) = plan.lights.get(light) else { return };
        let Some(scissor) = light.scissor.filter(|_| light.stats.has_shadow()) else { return };
        self.bind_planned(pass);
        let last = light.batches.len().saturating_sub(1);
        let mut state = PassState { scissor: None, pipeline: None, extracted: None };
        let draws = || light.batches.iter().flat_map(|batch| &plan.draws[batch.start as usize..batch.end as usize]);
        let rasterised = |draw: &Draw| tiled.is_none() || !can_tile(draw);
        // Modulo 256, as all counting is. What the tile pass counts it starts itself.
        let near_count = match tiled {
            Some(_) => draws().filter(|draw| rasterised(draw)).map(|draw| draw.near_layers).sum(),
            None => light.stats.near_count,
        } % 256;
        if near_count > 0 {
            state.set_scissor(pass, scissor);
            state.set_pipeline(pass, &pipelines.start);
            pass.set_stencil_reference(near_count);
            pass.draw(0..3, 0..1);
        }
        for (i, batch) in light.batches.iter().enumerate() {
            for d in batch.clone().filter(|&d| rasterised(&plan.draws[d as usize])) {
                self.draw_volume(pass, &mut state, pipelines, d, &plan.draws[d as usize], last > 0);
            }
            if i < last {
                state.set_scissor(pass, scissor);
                state.set_pipeline(pass, &pipelines.fold);
                pass.set_stencil_reference(STICKY);
                pass.draw(0..3, 0..1);
            }
        }
        if let Some((light, pipeline)) = tiled
            && let Some(tiled) = &self.tiled
        {
            tiled.pass.draw(pass, pipeline, light.index, scissor);
        }
        let [x, y, width, height] = self.image;
        pass.set_scissor_rect(x, y, width, height);
    }

    fn draw_volume<'p>(
        &self,
        pass: &mut RenderPass<'_>,
        state: &mut PassState<'p>,
        pipelines: &'p Pipelines,
        d: u32,
        draw: &Draw,
        batched: bool,
    ) {
        // Indices are doubled to make room for the extruded bit, and so is the base.
        let base = (self.first_positions[d as usize] * 2).cast_signed();
        let volume = &draw.volume;
        let variant = Variant { z_pass: draw.z_pass, finite: self.finite, batched, clockwise: draw.mirrored };
        let reversed = Variant { clockwise: !variant.clockwise, ..variant };
        state.set_scissor(pass, draw.scissor);
        if let Some(extraction) = &draw.extraction {
            let caps = [pipelines.light_cap(variant), pipelines.light_cap(reversed)];
            self.draw_extracted(pass, state, extraction, draw.caster, pipelines.extruded(variant), caps);
            return;
        }
        if state.extracted.take().is_some() {
            self.bind_planned(pass);
        }
        // Neighbouring ranges under one pipeline are one draw.
        let mut pending: Option<(&RenderPipeline, Range<u32>)> = None;
        for (pipeline, range) in [
            (pipelines.extruded(variant), &volume.sides),
            (pipelines.extruded(variant), &volume.dark_cap),
            (pipelines.light_cap(variant), &volume.light_cap),
            (pipelines.light_cap(reversed), &volume.light_cap_reversed),
        ] {
            if range.is_empty() {
                continue;
            }
            pending = Some(match pending {
                Some((same, before)) if same == pipeline && before.end == range.start => {
                    (same, before.start..range.end)
                }
                Some((other, before)) => {
                    state.set_pipeline(pass, other);
                    pass.draw_indexed(before, base, d..d + 1);
                    (pipeline, range.clone())
                }
                None => (pipeline, range.clone()),
            });
        }
        if let Some((pipeline, range)) = pending {
            state.set_pipeline(pass, pipeline);
            pass.draw_indexed(range, base, d..d + 1);
        }
    }

    /// Draws from the index lists of the plan.
    fn bind_planned(&self, pass: &mut RenderPass<'_>) {
        pass.set_bind_group(0, &self.bindings, &[]);
        pass.set_index_buffer(self.buffers.indices.slice(..), IndexFormat::Uint32);
    }

    /// Draws the lists that the device has made for one caster, whose lengths only it knows.
    fn draw_extracted<'p>(
        &self,
        pass: &mut RenderPass<'_>,
        state: &mut PassState<'p>,
        extraction: &Extraction,
        caster: u32,
        extruded: &'p RenderPipeline,
        [light_cap, reversed]: [&'p RenderPipeline; 2],
    ) {
        let Some(silhouettes) = &self.silhouettes else { return };
        let place = (extraction.light, caster);
        if state.extracted.replace(place) != Some(place) {
            silhouettes.bind(pass, place);
        }
        if extraction.sides || extraction.dark_cap != DarkCap::None {
            state.set_pipeline(pass, extruded);
            silhouettes.draw(pass, place, List::Extruded);
        }
        if extraction.light_cap != LightCap::None {
            state.set_pipeline(pass, light_cap);
            silhouettes.draw(pass, place, List::LightCap);
            state.set_pipeline(pass, reversed);
            silhouettes.draw(pass, place, List::LightCapReversed);
        }
    }
}

/// Finds the casters of which the device has room for all lists that there may be, and is worth asking.
fn find_extractable(extractable: &mut Vec<bool>, device: &Device, frame: &Frame<'_>, arena: &Arena, costs: CostModel) {
    extractable.clear();
    let limits = device.limits();
    let choice = frame.steps.silhouettes;
    if choice == plan::Silhouettes::Cpu || !Silhouettes::are_supported(&limits) {
        return;
    }
    let mut left = Silhouettes::budget();
    extractable.extend(frame.casters.iter().map(|caster| {
        let Some(mesh) = arena.get(caster.mesh.slot, caster.mesh.serial) else { return false };
        let worth = choice == plan::Silhouettes::Gpu || costs.may_extract(mesh.topology.by_part.len());
        let bytes = Silhouettes::bytes(&limits, mesh).filter(|_| worth).map(|bytes| bytes * frame.lights.len() as u64);
        let rest = bytes.and_then(|bytes| left.checked_sub(bytes));
        left = rest.unwrap_or(left);
        rest.is_some()
    }));
}

/// What a pass has been told, so that it is told only once.
struct PassState<'p> {
    scissor: Option<Rectangle>,
    pipeline: Option<&'p RenderPipeline>,
    /// Whose extracted lists are bound; none for those of the plan.
    extracted: Option<Place>,
}

impl<'p> PassState<'p> {
    fn set_scissor(&mut self, pass: &mut RenderPass<'_>, scissor: Rectangle) {
        if self.scissor != Some(scissor) {
            self.scissor = Some(scissor);
            let [x, y, width, height] = scissor;
            pass.set_scissor_rect(x, y, width, height);
        }
    }

    fn set_pipeline(&mut self, pass: &mut RenderPass<'_>, pipeline: &'p RenderPipeline) {
        if self.pipeline != Some(pipeline) {
            self.pipeline = Some(pipeline);
            pass.set_pipeline(pipeline);
        }
    }
}

/// What volumes are drawn with: positions, and the records of draws.
pub(crate) fn volume_layout(device: &Device) -> BindGroupLayout {
    let entry = |binding| BindGroupLayoutEntry {
        binding,
        visibility: ShaderStages::VERTEX,
        ty: BindingType::Buffer {
            ty: BufferBindingType::Storage { read_only: true },
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    };
    device.create_bind_group_layout(&BindGroupLayoutDescriptor {
        label: Some("shadow volumes"),
        entries: &[entry(0), entry(1)],
    })
}

fn bind(device: &Device, layout: &BindGroupLayout, arena: &Arena, buffers: &FrameBuffers) -> BindGroup {
    device.create_bind_group(&BindGroupDescriptor {
        label: Some("shadow volumes"),
        layout,
        entries: &[
            BindGroupEntry { binding: 0, resource: arena.buffer().as_entire_binding() },
            BindGroupEntry { binding: 1, resource: buffers.draws.as_entire_binding() },
        ],
    })
}
