//! Shadow determination for a host renderer: meshes in, stencil verdict out.

use crate::arena::Arena;
use crate::error::Error;
use crate::frame_buffers::FrameBuffers;
use crate::pipelines::{Pipelines, STICKY, Target, Variant};
use glam::DAffine3;
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor, BindGroupLayoutEntry,
    BindingType, BufferBindingType, Device, IndexFormat, Queue, RenderPass, ShaderModule, ShaderStages,
};
use zfail_plan::plan::{self, Counting, Draw, LightStats, Planner, ShadowLight, Technique};
use zfail_plan::scissor::Rectangle;
use zfail_plan::topology::Topology;
use zfail_plan::view::View;

/// A mesh registered with one [`Shadows`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct MeshId {
    slot: usize,
    serial: u64,
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
    /// Which algorithm; [`Technique::Auto`] unless you compare.
    pub technique: Technique,
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
}

impl Shadows {
    /// Shadow determination on `device`, without any mesh yet.
    #[must_use]
    pub fn new(device: &Device) -> Self {
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
        let layout = device.create_bind_group_layout(&BindGroupLayoutDescriptor {
            label: Some("shadow volumes"),
            entries: &[entry(0), entry(1)],
        });
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
        }
    }

    /// Registers a mesh: the very triangles that the depth pass draws, with their vertices in the same order.
    /// `positions` are in object space, best kept near its origin; they may repeat (the mesh is welded by exact
    /// position). Triangles for which `casts` is false block no light.
    ///
    /// # Errors
    /// Indices out of range, coordinates that are not finite, or more vertices than the device's buffers hold.
    pub fn add_mesh(
        &mut self,
        device: &Device,
        queue: &Queue,
        positions: &[[f32; 3]],
        triangles: &[[u32; 3]],
        casts: impl Fn(usize) -> bool,
    ) -> Result<MeshId, Error> {
        let topology = Topology::new(positions, triangles, casts)?;
        let (slot, serial, moved) = self.arena.add(device, queue, topology)?;
        if moved {
            self.bindings = bind(device, &self.layout, &self.arena, &self.buffers);
        }
        Ok(MeshId { slot, serial })
    }

    /// Forgets a mesh and gives back its topology; `None` if it is not registered here.
    pub fn remove_mesh(&mut self, mesh: MeshId) -> Option<Topology> {
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

    /// Plans every light of a frame and uploads its volumes. Call it before encoding the frame's passes, and submit
    /// those before preparing the next frame. Returns one entry of figures per light.
    ///
    /// # Errors
    /// A caster without a registered mesh or with a singular transform, or volumes too large for the device's buffers.
    pub fn prepare(&mut self, device: &Device, queue: &Queue, frame: &Frame<'_>) -> Result<Vec<LightStats>, Error> {
        let meshes = frame
            .casters
            .iter()
            .enumerate()
            .map(|(caster, c)| self.arena.get(c.mesh.slot, c.mesh.serial).ok_or(Error::UnknownMesh { caster }));
        let meshes = meshes.collect::<Result<Vec<_>, _>>()?;
        let casters: Vec<plan::Caster<'_>> = frame
            .casters
            .iter()
            .zip(&meshes)
            .map(|(c, m)| plan::Caster {
                topology: &m.topology,
                mesh: m.serial,
                world_from_object: c.world_from_object,
            })
            .collect();
        let plan = self.planner.plan(&plan::Frame {
            view: frame.view,
            casters: &casters,
            lights: frame.lights,
            technique: frame.technique,
            counting: frame.counting,
        })?;
        self.first_positions.clear();
        self.first_positions.extend(plan.draws.iter().map(|d| meshes[d.caster as usize].first));
        let place = |caster: u32| frame.casters[caster as usize].world_from_object;
        if self.buffers.upload(device, queue, plan, frame.view, place)? {
            self.bindings = bind(device, &self.layout, &self.arena, &self.buffers);
        }
        self.finite = frame.view.is_finite();
        self.image = zfail_plan::scissor::full(frame.view);
        Ok(plan.lights.iter().map(|light| light.stats.clone()).collect())
    }

    /// Encodes the volumes of one light of the prepared frame. The pass holds the finished depth of the view and a
    /// stencil of 0; afterwards the stencil is 0 exactly where the light arrives (with [`Counting::Verdict`]).
    ///
    /// Sets pipeline, bind group 0, index buffer, stencil reference and scissor; the scissor is left at the whole image.
    ///
    /// Does nothing if the prepared frame has no such light, or the last [`Self::prepare`] failed.
    pub fn draw(&self, pass: &mut RenderPass<'_>, pipelines: &Pipelines, light: usize) {
        let plan = self.planner.last();
        let Some(light) = plan.lights.get(light) else { return };
        let Some([x, y, width, height]) = light.scissor else { return };
        if light.batches.is_empty() {
            return;
        }
        pass.set_scissor_rect(x, y, width, height);
        pass.set_bind_group(0, &self.bindings, &[]);
        pass.set_index_buffer(self.buffers.indices.slice(..), IndexFormat::Uint32);
        let last = light.batches.len() - 1;
        for (i, batch) in light.batches.iter().enumerate() {
            for d in batch.clone() {
                self.draw_volume(pass, pipelines, d, &plan.draws[d as usize], last > 0);
            }
            if i < last {
                pass.set_pipeline(&pipelines.fold);
                pass.set_stencil_reference(STICKY);
                pass.draw(0..3, 0..1);
            }
        }
        let [x, y, width, height] = self.image;
        pass.set_scissor_rect(x, y, width, height);
    }

    fn draw_volume(&self, pass: &mut RenderPass<'_>, pipelines: &Pipelines, d: u32, draw: &Draw, batched: bool) {
        // Indices are doubled to make room for the extruded bit, and so is the base.
        let base = (self.first_positions[d as usize] * 2).cast_signed();
        let volume = &draw.volume;
        let variant = Variant { finite: self.finite, batched, clockwise: draw.mirrored };
        pass.set_pipeline(pipelines.extruded(variant));
        if self.finite {
            pass.draw_indexed(volume.sides.start..volume.dark_cap.end, base, d..d + 1);
            pass.set_pipeline(pipelines.light_cap(variant));
            pass.draw_indexed(volume.light_cap.clone(), base, d..d + 1);
        } else {
            pass.draw_indexed(volume.outward(), base, d..d + 1);
        }
        if !volume.light_cap_reversed.is_empty() {
            pass.set_pipeline(pipelines.light_cap(Variant { clockwise: !variant.clockwise, ..variant }));
            pass.draw_indexed(volume.light_cap_reversed.clone(), base, d..d + 1);
        }
    }
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
