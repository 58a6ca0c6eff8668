//! Shadow determination for a host renderer: meshes in, a frame's volumes on the device out.

use crate::arena::Arena;
use crate::cost::CostModel;
use crate::error::Error;
use crate::frame::Frame;
use crate::frame_buffers::{DrawRecord, FrameBuffers};
use crate::mesh::{MeshDescriptor, MeshId};
use crate::pipelines::{Pipelines, Target};
use crate::prepared::Prepared;
use crate::silhouettes::Silhouettes;
use crate::tiled::{Staged, Tiled, TiledLight};
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor, BindGroupLayoutEntry,
    BindingType, BufferBindingType, Device, Queue, ShaderModule, ShaderStages,
};
use zfail_plan::plan::{self, Draw, Planner, Tiles};
use zfail_plan::scissor::{self, Rectangle};
use zfail_plan::topology::Topology;

/// Registered meshes and the current frame's volumes, on one device.
///
/// The page of the [crate] has a program that uses it from begin to end.
#[derive(Debug)]
pub struct Shadows {
    pub(crate) device: Device,
    queue: Queue,
    pub(crate) arena: Arena,
    pub(crate) planner: Planner,
    pub(crate) buffers: FrameBuffers,
    pub(crate) layout: BindGroupLayout,
    pub(crate) bindings: BindGroup,
    pub(crate) module: ShaderModule,
    /// Where each draw's positions begin, parallel to the plan's draws.
    pub(crate) first_positions: Vec<u32>,
    /// Whether the view has a far plane.
    pub(crate) far_plane: bool,
    pub(crate) image: Rectangle,
    staged: Option<Staged>,
    pub(crate) tiled: Option<Tiled>,
    /// Whether `tiled` belongs to the prepared frame, and has something to count.
    tiles_chosen: bool,
    /// By caster of the frame: whether the device can find its silhouettes, and is to if its light moves.
    extractable: Vec<bool>,
    pub(crate) silhouettes: Option<Silhouettes>,
    costs: CostModel,
}

impl Shadows {
    /// Shadow determination on `device`, without any mesh yet. Device and queue are kept; both are handles.
    #[must_use]
    pub fn new(device: &Device, queue: &Queue) -> Self {
        let layout = volume_layout(device);
        let arena = Arena::new(device);
        let buffers = FrameBuffers::new(device);
        let bindings = bind(device, &layout, &arena, &buffers);
        let module = device.create_shader_module(wgpu::include_wgsl!("volume.wgsl"));
        Self {
            device: device.clone(),
            queue: queue.clone(),
            arena,
            planner: Planner::new(),
            buffers,
            layout,
            bindings,
            module,
            first_positions: Vec::new(),
            far_plane: false,
            image: [0; 4],
            staged: None,
            tiled: None,
            tiles_chosen: false,
            extractable: Vec::new(),
            silhouettes: None,
            costs: CostModel::RASTERISE,
        }
    }

    /// Registers a mesh: once, however often it is placed and however it moves.
    ///
    /// # Errors
    /// Indices out of range, coordinates that are not finite, lists of the wrong length, or more vertices than the device's
    /// buffers hold.
    pub fn add_mesh(&mut self, mesh: &MeshDescriptor<'_>) -> Result<MeshId, Error> {
        self.add_topology(mesh.topology()?)
    }

    /// Registers a mesh whose topology has been made already, elsewhere or on another thread.
    ///
    /// # Errors
    /// More vertices than the device's buffers hold.
    pub fn add_topology(&mut self, topology: Topology) -> Result<MeshId, Error> {
        let (slot, serial, moved) = self.arena.add(&self.device, &self.queue, topology)?;
        if moved {
            self.bindings = bind(&self.device, &self.layout, &self.arena, &self.buffers);
        }
        Ok(MeshId { slot, serial })
    }

    /// Moves the vertices of a mesh that bends ([`MeshDescriptor::alike`]): the very positions that the depth pass will draw,
    /// in the order in which they were registered. Silhouettes and bounds follow at the next [`Self::prepare`].
    ///
    /// # Errors
    /// A mesh that is not registered or rigid, another number of positions, or coordinates that are not finite. Nothing
    /// has moved then.
    pub fn move_vertices(&mut self, mesh: MeshId, positions: &[[f32; 3]]) -> Result<(), Error> {
        self.arena.move_vertices(&self.queue, mesh.slot, mesh.serial, positions)
    }

    /// Forgets a mesh and gives back its topology; `None` if it is not registered here.
    pub fn remove_mesh(&mut self, mesh: MeshId) -> Option<Topology> {
        if let Some(silhouettes) = &mut self.silhouettes {
            silhouettes.forget(mesh.serial);
        }
        self.arena.remove(mesh.slot, mesh.serial)
    }

    /// Pipelines for passes with the formats of `target`; make them once.
    #[must_use]
    pub fn pipelines(&self, target: &Target<'_>) -> Pipelines {
        Pipelines::new(&self.device, &self.layout, &self.module, target)
    }

    /// What the device's times are: [`Steps::tiles`](crate::Steps::tiles) and
    /// [`Steps::silhouettes`](crate::Steps::silhouettes) are decided by them. Without it every volume is rasterised, and every
    /// silhouette found on the CPU.
    pub fn set_cost_model(&mut self, costs: CostModel) {
        self.costs = costs;
    }

    /// Plans every light of a frame and uploads its volumes, or submits compute work that finds them. Call it before the
    /// frame's passes are submitted, and submit those before preparing the next frame.
    ///
    /// # Errors
    /// A caster without a registered mesh, with a singular transform or a matrix that shows something else than the view, or
    /// volumes too large for the device's buffers. There is no prepared frame then, so nothing to draw with.
    pub fn prepare(&mut self, frame: &Frame<'_>) -> Result<Prepared<'_>, Error> {
        if let Err(error) = self.plan_and_upload(frame) {
            self.planner = Planner::new();
            (self.staged, self.tiles_chosen) = (None, false);
            return Err(error);
        }
        Ok(Prepared::new(self))
    }

    /// The frame that was prepared last, for hosts that prepare in one place and draw in another; `None` before the first one
    /// and after one that failed.
    #[must_use]
    pub fn prepared(&self) -> Option<Prepared<'_>> {
        self.staged.as_ref().map(|_| Prepared::new(self))
    }

    pub(crate) fn tiles_chosen(&self) -> bool {
        self.tiles_chosen
    }

    pub(crate) fn tiled_light(&self, light: usize) -> Option<TiledLight> {
        let tiled = self.tiled.as_ref().filter(|_| self.tiles_chosen)?;
        tiled.lights.get(light).copied().flatten()
    }

    fn plan_and_upload(&mut self, frame: &Frame<'_>) -> Result<(), Error> {
        let (device, queue) = (&self.device, &self.queue);
        let mut casters = Vec::with_capacity(frame.casters.len());
        for (c, caster) in frame.casters.iter().enumerate() {
            let mesh = self.arena.get(caster.mesh.slot, caster.mesh.serial).ok_or(Error::UnknownMesh { caster: c })?;
            caster.check(c, frame.view, &mesh.topology.bounds())?;
            let world_from_object = caster.world_from_object;
            casters.push(plan::Caster { topology: &mesh.topology, mesh: mesh.version, world_from_object });
        }
        find_extractable(&mut self.extractable, device, frame, &self.arena, self.costs);
        let input = plan::Input {
            view: frame.view,
            casters: &casters,
            lights: frame.lights,
            receivers: frame.receivers,
            steps: frame.steps,
            counting: frame.counting,
        };
        let plan = self.planner.plan_extracting(&input, &self.extractable)?;
        // Also of the tile pass, whose choice the same plan leaves as it was.
        let same =
            |staged: &Staged| staged.is(frame) && staged.arena == self.arena.layout() && staged.costs == self.costs;
        if plan.unchanged && self.staged.as_ref().is_some_and(same) {
            self.buffers.uploaded = 0;
            return Ok(());
        }
        self.first_positions.clear();
        let first = |d: &Draw| {
            let mesh = frame.casters[d.caster as usize].mesh;
            self.arena.get(mesh.slot, mesh.serial).map_or(0, |mesh| mesh.first)
        };
        self.first_positions.extend(plan.draws.iter().map(first));
        let place = |caster: u32| frame.casters[caster as usize].clip_from_object(frame.view);
        if self.buffers.upload(device, queue, plan, place)? {
            self.bindings = bind(device, &self.layout, &self.arena, &self.buffers);
        }
        if self.silhouettes.is_some() || plan.lights.iter().any(|light| light.stats.extracted > 0) {
            let silhouettes = self.silhouettes.get_or_insert_with(|| Silhouettes::new(device));
            let caster = |draw: &Draw| {
                let caster = frame.casters.get(draw.caster as usize)?;
                let record = DrawRecord::new(draw, caster.clip_from_object(frame.view));
                Some((self.arena.get(caster.mesh.slot, caster.mesh.serial)?, record))
            };
            silhouettes.extract(device, queue, &self.layout, &self.arena, plan, caster);
        }
        let mut kept = self.staged.take().map(|staged| staged.casters).unwrap_or_default();
        kept.clear();
        kept.extend_from_slice(frame.casters);
        let staged = Staged::new(frame, kept, self.arena.layout(), self.costs);
        self.far_plane = frame.view.has_far_plane();
        self.image = scissor::full(frame.view);
        self.tiles_chosen = frame.tile_pass && frame.steps.tiles != Tiles::Never && {
            let tiled = self.tiled.get_or_insert_with(|| Tiled::new(device));
            tiled.choose(device, queue, &staged, self.planner.last(), &self.arena, self.costs)?
        };
        self.staged = Some(staged);
        Ok(())
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
        let worth = choice == plan::Silhouettes::Gpu || costs.may_extract(mesh.topology.by_part().len());
        let bytes = Silhouettes::bytes(&limits, mesh).filter(|_| worth).map(|bytes| bytes * frame.lights.len() as u64);
        let rest = bytes.and_then(|bytes| left.checked_sub(bytes));
        left = rest.unwrap_or(left);
        rest.is_some()
    }));
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
