//! Silhouettes on the device: from the positions of a mesh to indirect draws, with nothing read back.
//!
//! In: a plan whose draws ask for it ([`Extraction`]), and the meshes' one position buffer. Out: index lists as
//! [`zfail_plan::volume`] defines them, in buffers of the device, and indirect draws of them (decision record 0016).
//!
//! One invocation a triangle decides its facing, stores its weight and lists its caps; then one invocation an edge lists
//! its sides from the stored weights, by integer arithmetic, so that a facing that rounding decides can never open a volume.
//! What stays as it was is neither computed nor listed again.

mod incidence;
mod lists;

use crate::arena::{Arena, Mesh};
use crate::frame_buffers::DrawRecord;
use glam::DVec3;
use incidence::{Incidence, Room};
use lists::{Key, Lists, Params};
use std::collections::HashMap;
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::{
    BindGroupLayout, BindGroupLayoutDescriptor, BindGroupLayoutEntry, BindingType, Buffer, BufferBindingType,
    BufferUsages, CommandEncoderDescriptor, ComputePassDescriptor, ComputePipeline, ComputePipelineDescriptor, Device,
    IndexFormat, Limits, PipelineCompilationOptions, PipelineLayoutDescriptor, Queue, RenderPass, ShaderStages,
};
use zfail_plan::casting::Casting;
use zfail_plan::plan::{DarkCap, Draw, Extraction, FramePlan, LightCap};

/// Bytes that the lists of all casters under all lights may take.
const BUDGET: u64 = 512 << 20;
/// Invocations in a workgroup.
const WORKGROUP: u64 = 256;
/// Storage buffers that a shader binds.
const STORAGE_BUFFERS: u32 = 8;

/// The lists of an extracted volume that are drawn on their own.
#[derive(Clone, Copy, Debug)]
pub(crate) enum List {
    /// Sides and dark cap.
    Extruded,
    LightCap,
    /// Light cap of what casts from its back.
    LightCapReversed,
}

/// Which lists: by light and caster of the frame.
pub(crate) type Place = (u32, u32);

/// What finds silhouettes, what it knows of meshes, and the lists that it has made.
#[derive(Debug)]
pub(crate) struct Silhouettes {
    fill: BindGroupLayout,
    face: ComputePipeline,
    extrude: ComputePipeline,
    /// By serial number.
    meshes: HashMap<u64, MeshBuffers>,
    lists: HashMap<Place, Lists>,
    /// Lists to be filled.
    stale: Vec<Place>,
}

/// The layouts of a caster's two bind groups.
struct Layouts<'a> {
    fill: &'a BindGroupLayout,
    volume: &'a BindGroupLayout,
}

/// Incidence of a mesh on the device.
#[derive(Debug)]
struct MeshBuffers {
    incidence: Incidence,
    triangle_count: u64,
    triangles: Buffer,
    edges: Buffer,
    fan_triangles: Buffer,
}

impl Silhouettes {
    pub fn new(device: &Device) -> Self {
        let entry = |(binding, ty): (usize, BufferBindingType)| BindGroupLayoutEntry {
            binding: binding as u32,
            visibility: ShaderStages::COMPUTE,
            ty: BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None },
            count: None,
        };
        let (read, write) =
            (BufferBindingType::Storage { read_only: true }, BufferBindingType::Storage { read_only: false });
        let types = [BufferBindingType::Uniform, read, read, read, read, read, write, write, write];
        let fill = device.create_bind_group_layout(&BindGroupLayoutDescriptor {
            label: Some("extraction"),
            entries: &types.into_iter().enumerate().map(entry).collect::<Vec<_>>(),
        });
        let module = device.create_shader_module(wgpu::include_wgsl!("extract.wgsl"));
        let layout = device.create_pipeline_layout(&PipelineLayoutDescriptor {
            label: Some("extraction"),
            bind_group_layouts: &[Some(&fill)],
            immediate_size: 0,
        });
        let pipeline = |entry_point| {
            device.create_compute_pipeline(&ComputePipelineDescriptor {
                label: Some(entry_point),
                layout: Some(&layout),
                module: &module,
                entry_point: Some(entry_point),
                compilation_options: PipelineCompilationOptions::default(),
                cache: None,
            })
        };
        let (face, extrude) = (pipeline("face"), pipeline("extrude"));
        Self { fill, face, extrude, meshes: HashMap::new(), lists: HashMap::new(), stale: Vec::new() }
    }

    /// Whether this device can do it at all.
    pub fn are_supported(limits: &Limits) -> bool {
        limits.max_storage_buffers_per_shader_stage >= STORAGE_BUFFERS
            && u64::from(limits.max_compute_invocations_per_workgroup) >= WORKGROUP
            && u64::from(limits.max_compute_workgroup_size_x) >= WORKGROUP
    }

    /// The bytes of lists with room for any volume of `mesh`; `None` if the device has no such buffers.
    pub fn bytes(limits: &Limits, mesh: &Mesh) -> Option<u64> {
        let triangles = mesh.topology.by_part().len() as u64;
        let limit = limits.max_buffer_size.min(limits.max_storage_buffer_binding_size).min(u64::from(u32::MAX));
        // Edges are no more than three times the triangles, and take 16 bytes as these do.
        let static_bytes = 3 * 16 * mesh.topology.triangles().len() as u64;
        let bytes = 4 * Room::most(triangles).total();
        (bytes.max(static_bytes) <= limit).then_some(bytes)
    }

    /// The bytes that may be taken by lists.
    pub const fn budget() -> u64 {
        BUDGET
    }

    /// Forgets a mesh.
    pub fn forget(&mut self, serial: u64) {
        self.meshes.remove(&serial);
    }

    /// Fills the lists that a plan's draws ask for, where they are not as they were. `caster` tells of a draw where its mesh
    /// is and where it is placed.
    pub fn extract<'a>(
        &mut self,
        device: &Device,
        queue: &Queue,
        volume: &BindGroupLayout,
        arena: &'a Arena,
        plan: &FramePlan,
        caster: impl Fn(&Draw) -> Option<(&'a Mesh, DrawRecord)>,
    ) {
        self.lists.values_mut().for_each(|lists| lists.used = false);
        self.stale.clear();
        for draw in &plan.draws {
            let Some(extraction) = &draw.extraction else { continue };
            let Some((mesh, record)) = caster(draw) else { continue };
            let castings = &plan.castings[extraction.castings.start as usize..extraction.castings.end as usize];
            let buffers = self.meshes.entry(mesh.serial).or_insert_with(|| MeshBuffers::new(device, mesh));
            let layouts = Layouts { fill: &self.fill, volume };
            let place = (extraction.light, draw.caster);
            let room = buffers.incidence.room(castings);
            let make = || Lists::new(device, &layouts, buffers, arena.buffer(), room, castings.len());
            let lists = self.lists.entry(place).or_insert_with(make);
            if !lists.fit(buffers, arena.buffer(), room, castings.len()) {
                *lists = make();
            }
            lists.used = true;
            lists.place(queue, &record);
            let key = key(extraction, draw);
            if lists.key.replace(key) != Some(key) {
                let codes: Vec<u32> = castings.iter().map(|casting| code(*casting)).collect();
                lists.begin(queue, buffers.params(mesh, extraction, draw), &codes);
                self.stale.push(place);
            }
        }
        self.lists.retain(|_, lists| lists.used);
        if !self.stale.is_empty() {
            self.fill(device, queue, plan, &caster);
        }
    }

    fn fill<'a>(
        &self,
        device: &Device,
        queue: &Queue,
        plan: &FramePlan,
        caster: &impl Fn(&Draw) -> Option<(&'a Mesh, DrawRecord)>,
    ) {
        let mut encoder = device.create_command_encoder(&CommandEncoderDescriptor { label: Some("extraction") });
        let limit = u64::from(device.limits().max_compute_workgroups_per_dimension).max(1);
        let mut pass =
            encoder.begin_compute_pass(&ComputePassDescriptor { label: Some("extraction"), ..Default::default() });
        // All weights first: casters do not wait for each other then.
        for (pipeline, edges) in [(&self.face, false), (&self.extrude, true)] {
            pass.set_pipeline(pipeline);
            let stale =
                |draw: &&Draw| draw.extraction.as_ref().is_some_and(|e| self.stale.contains(&(e.light, draw.caster)));
            for draw in plan.draws.iter().filter(stale) {
                let Some((extraction, (mesh, _))) = draw.extraction.as_ref().zip(caster(draw)) else { continue };
                let Some((lists, mesh)) =
                    self.lists.get(&(extraction.light, draw.caster)).zip(self.meshes.get(&mesh.serial))
                else {
                    continue;
                };
                let threads = if edges { mesh.incidence.edges.len() as u64 } else { mesh.triangle_count };
                let groups = threads.div_ceil(WORKGROUP);
                let rows = groups.div_ceil(limit).max(1);
                pass.set_bind_group(0, &lists.fill, &[]);
                pass.dispatch_workgroups(groups.div_ceil(rows) as u32, rows as u32, 1);
            }
        }
        drop(pass);
        queue.submit([encoder.finish()]);
    }

    /// Makes a caster's lists those that are drawn from: sets bind group 0 and the index buffer.
    pub fn bind(&self, pass: &mut RenderPass<'_>, place: Place) {
        if let Some(lists) = self.lists.get(&place) {
            pass.set_bind_group(0, &lists.volume, &[]);
            pass.set_index_buffer(lists.indices.slice(..), IndexFormat::Uint32);
        }
    }

    /// Draws one list of the caster that is bound.
    pub fn draw(&self, pass: &mut RenderPass<'_>, place: Place, list: List) {
        if let Some(lists) = self.lists.get(&place) {
            pass.draw_indexed_indirect(&lists.draws, Lists::offset(list as usize));
        }
    }
}

fn key(extraction: &Extraction, draw: &Draw) -> Key {
    let &Extraction { mesh, sides, dark_cap, light_cap, .. } = extraction;
    Key { mesh, light: draw.light, sides, dark_cap, light_cap }
}

/// A casting as `extract.wgsl` numbers it.
const fn code(casting: Casting) -> u32 {
    match casting {
        Casting::Front => 0,
        Casting::Back => 1,
        Casting::Double => 2,
    }
}

impl MeshBuffers {
    fn new(device: &Device, mesh: &Mesh) -> Self {
        Self::of(device, Incidence::new(&mesh.topology))
    }

    fn of(device: &Device, incidence: Incidence) -> Self {
        let buffer = |label, contents: &[u8]| {
            // Bindings may not be empty.
            let contents = if contents.is_empty() { &[0; 16] } else { contents };
            device.create_buffer_init(&BufferInitDescriptor {
                label: Some(label),
                contents,
                usage: BufferUsages::STORAGE,
            })
        };
        Self {
            triangle_count: incidence.triangles.len() as u64,
            triangles: buffer("incidence: triangles", bytemuck::cast_slice(&incidence.triangles)),
            edges: buffer("incidence: edges", bytemuck::cast_slice(&incidence.edges)),
            fan_triangles: buffer("incidence: fans", bytemuck::cast_slice(&incidence.fan_triangles)),
            incidence,
        }
    }

    fn params(&self, mesh: &Mesh, extraction: &Extraction, draw: &Draw) -> Params {
        const SIDES: u32 = 1;
        const CONVERGING: u32 = 2;
        const FAN: u32 = 4;
        const DARK_TRIANGLES: u32 = 8;
        const LIGHT_CAP: u32 = 16;
        const EXPOSED: u32 = 32;
        let when = |step: u32, taken: bool| if taken { step } else { 0 };
        let (bounds, light) = (mesh.topology.bounds(), draw.light);
        let way = light.truncate().as_dvec3().abs() + f64::from(light.w) * bounds.min.abs().max(bounds.max.abs());
        Params {
            light: light.to_array(),
            edge_scale: unit_scale(bounds.half()),
            light_scale: unit_scale(way),
            first: mesh.first,
            triangles: self.triangle_count as u32,
            edges: self.incidence.pairs as u32,
            fans: (self.incidence.edges.len() - self.incidence.pairs) as u32,
            apex: self.incidence.apex,
            steps: when(SIDES, extraction.sides)
                | when(CONVERGING, light.w == 0.0)
                | when(FAN, extraction.dark_cap == DarkCap::Fan)
                | when(DARK_TRIANGLES, extraction.dark_cap == DarkCap::Triangles)
                | when(LIGHT_CAP, extraction.light_cap != LightCap::None)
                | when(EXPOSED, extraction.light_cap == LightCap::Exposed),
            starts: [0; 4],
        }
    }
}

/// The power of two that brings the longest component of `extent` to between 1/2 and 1, as far as f32 has it.
fn unit_scale(extent: DVec3) -> f32 {
    let longest = extent.max_element().clamp(f64::from(f32::MIN_POSITIVE), f64::from(f32::MAX));
    // Beyond these, the power itself would be no ordinary number.
    (-longest.log2().ceil()).clamp(-126.0, 126.0).exp2() as f32
}

#[cfg(test)]
mod tests;
