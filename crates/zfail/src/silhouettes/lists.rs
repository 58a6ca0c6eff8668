//! The index lists of one caster under one light, in buffers that only the device reads and writes.
//!
//! In: a mesh on the device, and how much room its lists may need. Out: buffers and the bind groups to fill and to draw
//! them. There is room for the longest lists that there can be, so that nothing is ever dropped.

use super::incidence::Room;
use super::{Layouts, MeshBuffers};
use crate::frame_buffers::DrawRecord;
use bytemuck::{Pod, Zeroable};
use glam::Vec4;
use wgpu::{BindGroup, BindGroupDescriptor, BindGroupEntry, Buffer, BufferDescriptor, BufferUsages, Device, Queue};
use zfail_plan::plan::{DarkCap, LightCap};

/// `Params` of `extract.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(super) struct Params {
    pub light: [f32; 4],
    pub edge_scale: f32,
    pub light_scale: f32,
    pub first: u32,
    pub triangles: u32,
    pub edges: u32,
    pub fans: u32,
    pub apex: u32,
    pub steps: u32,
    pub starts: [u32; 4],
}

/// What lists are made for: while it stays, so do they.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Key {
    pub mesh: u64,
    pub light: Vec4,
    pub sides: bool,
    pub dark_cap: DarkCap,
    pub light_cap: LightCap,
}

/// Lists and all that belongs to them.
#[derive(Debug)]
pub(super) struct Lists {
    /// What they hold.
    pub key: Option<Key>,
    /// Whether this frame draws them.
    pub used: bool,
    pub indices: Buffer,
    /// Three indirect draws.
    pub draws: Buffer,
    pub fill: BindGroup,
    pub volume: BindGroup,
    room: Room,
    parts: usize,
    record: Buffer,
    params: Buffer,
    castings: Buffer,
    /// Which buffers the bind groups refer to.
    positions: Buffer,
    mesh: Buffer,
}

/// Words of an indirect draw: index count, instance count, first index, base vertex, first instance.
const DRAW: usize = 5;

impl Lists {
    /// Lists with `room`, for a mesh with so many parts at `positions`.
    pub fn new(
        device: &Device,
        layouts: &Layouts<'_>,
        mesh: &MeshBuffers,
        positions: &Buffer,
        room: Room,
        parts: usize,
    ) -> Self {
        let buffer = |label, size: u64, usage| {
            let size = size.max(4);
            device.create_buffer(&BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false })
        };
        let (storage, written) = (BufferUsages::STORAGE, BufferUsages::COPY_DST);
        // Tests look at what no one else reads.
        let read = if cfg!(test) { BufferUsages::COPY_SRC } else { BufferUsages::empty() };
        let indices = buffer("extracted indices", 4 * room.total(), storage | read | BufferUsages::INDEX);
        let draws = buffer("extracted draws", 3 * 4 * DRAW as u64, storage | written | read | BufferUsages::INDIRECT);
        let weights = buffer("weights", 4 * mesh.triangle_count, storage);
        let castings = buffer("castings", 4 * parts as u64, storage | written);
        let params = buffer("extraction", size_of::<Params>() as u64, BufferUsages::UNIFORM | written);
        let record = buffer("extracted volume", size_of::<DrawRecord>() as u64, storage | written);
        let buffers = [
            &params,
            positions,
            &mesh.triangles,
            &mesh.edges,
            &mesh.fan_triangles,
            &castings,
            &weights,
            &indices,
            &draws,
        ];
        let bind = |label, layout, buffers: &[&Buffer]| {
            let bindings = (0..).zip(buffers.iter().map(|buffer| buffer.as_entire_binding()));
            let entries: Vec<_> = bindings.map(|(binding, resource)| BindGroupEntry { binding, resource }).collect();
            device.create_bind_group(&BindGroupDescriptor { label: Some(label), layout, entries: &entries })
        };
        Self {
            key: None,
            used: true,
            fill: bind("extraction", layouts.fill, &buffers),
            volume: bind("extracted volume", layouts.volume, &[positions, &record]),
            indices,
            draws,
            room,
            parts,
            record,
            params,
            castings,
            positions: positions.clone(),
            mesh: mesh.triangles.clone(),
        }
    }

    /// Whether they do for other castings, another mesh or after positions have moved to another buffer.
    pub fn fit(&self, mesh: &MeshBuffers, positions: &Buffer, room: Room, parts: usize) -> bool {
        let large_enough = self.room.0.iter().zip(room.0).all(|(have, need)| *have >= need);
        large_enough && self.parts == parts && self.mesh == mesh.triangles && self.positions == *positions
    }

    /// Where the lists begin.
    fn starts(&self) -> [u32; 4] {
        let [extruded, lit, _] = self.room.0.map(|room| room as u32);
        [0, extruded, extruded + lit, 0]
    }

    /// Empties the lists and tells what they are to be filled with.
    pub fn begin(&self, queue: &Queue, params: Params, castings: &[u32]) {
        let starts = self.starts();
        let params = Params { starts, ..params };
        queue.write_buffer(&self.params, 0, bytemuck::bytes_of(&params));
        if !castings.is_empty() {
            queue.write_buffer(&self.castings, 0, bytemuck::cast_slice(castings));
        }
        // Indices are doubled to make room for the extruded bit, and so is the base.
        let draw = |list: usize| [0, 1, starts[list], 2 * params.first, 0];
        queue.write_buffer(&self.draws, 0, bytemuck::cast_slice(&[draw(0), draw(1), draw(2)]));
    }

    /// Places the volume in this frame's view.
    pub fn place(&self, queue: &Queue, record: &DrawRecord) {
        queue.write_buffer(&self.record, 0, bytemuck::bytes_of(record));
    }

    /// Where the indirect draw of a list lies.
    pub const fn offset(list: usize) -> u64 {
        (list * DRAW * size_of::<u32>()) as u64
    }
}
