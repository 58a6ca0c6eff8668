//! All meshes' welded positions in one GPU buffer, so that one bind group serves every volume.

use crate::error::Error;
use wgpu::{Buffer, BufferDescriptor, BufferUsages, Device, Queue};
use zfail_plan::topology::Topology;

/// A registered mesh.
#[derive(Debug)]
pub(crate) struct Mesh {
    pub topology: Topology,
    /// Index of its first position in the buffer.
    pub first: u32,
    /// Never used for another mesh.
    pub serial: u64,
    /// Never used for another mesh, nor for this one once its vertices have moved.
    pub version: u64,
}

/// Meshes by slot, and their positions on the GPU.
#[derive(Debug)]
pub(crate) struct Arena {
    slots: Vec<Option<Mesh>>,
    buffer: Buffer,
    /// Positions in use, holes of removed meshes included.
    used: u64,
    next_serial: u64,
    /// Another number whenever anything in the buffer is elsewhere.
    layout: u64,
}

const POSITION: u64 = size_of::<[f32; 3]>() as u64;

impl Arena {
    pub fn new(device: &Device) -> Self {
        Self { slots: Vec::new(), buffer: buffer(device, 1024), used: 0, next_serial: 1, layout: 0 }
    }

    pub fn buffer(&self) -> &Buffer {
        &self.buffer
    }

    /// Another number whenever a mesh may have moved within the buffer.
    pub fn layout(&self) -> u64 {
        self.layout
    }

    pub fn get(&self, slot: usize, serial: u64) -> Option<&Mesh> {
        self.slots.get(slot)?.as_ref().filter(|mesh| mesh.serial == serial)
    }

    /// Stores a mesh; returns its slot, its serial number and whether the buffer is a new one.
    pub fn add(&mut self, device: &Device, queue: &Queue, topology: Topology) -> Result<(usize, u64, bool), Error> {
        let count = topology.positions().len() as u64;
        let capacity = self.buffer.size() / POSITION;
        let grow = self.used + count > capacity;
        if grow {
            let live: u64 = self.slots.iter().flatten().map(|m| m.topology.positions().len() as u64).sum();
            self.regrow(device, queue, live + count)?;
        }
        let serial = self.next_serial;
        self.next_serial += 1;
        let mesh = Mesh { topology, first: self.used as u32, serial, version: serial };
        upload(queue, &self.buffer, &mesh);
        self.used += count;
        let slot = self.slots.iter().position(Option::is_none).unwrap_or(self.slots.len());
        if slot == self.slots.len() {
            self.slots.push(None);
        }
        self.slots[slot] = Some(mesh);
        Ok((slot, serial, grow))
    }

    /// Moves the vertices of a mesh that bends.
    pub fn move_vertices(&mut self, queue: &Queue, slot: usize, serial: u64, to: &[[f32; 3]]) -> Result<(), Error> {
        let mesh = self.slots.get_mut(slot).and_then(Option::as_mut).filter(|mesh| mesh.serial == serial);
        let mesh = mesh.ok_or(Error::NoMesh)?;
        if mesh.topology.move_vertices(to)? {
            mesh.version = self.next_serial;
            self.next_serial += 1;
            upload(queue, &self.buffer, mesh);
        }
        Ok(())
    }

    /// Forgets a mesh; its place in the buffer is reclaimed at the next growth.
    pub fn remove(&mut self, slot: usize, serial: u64) -> Option<Topology> {
        let entry = self.slots.get_mut(slot)?;
        entry.take_if(|mesh| mesh.serial == serial).map(|mesh| mesh.topology)
    }

    /// Moves the live meshes into a buffer with room for twice `wanted` positions, or as much as the device allows.
    fn regrow(&mut self, device: &Device, queue: &Queue, wanted: u64) -> Result<(), Error> {
        let limits = device.limits();
        let limit = limits.max_buffer_size.min(limits.max_storage_buffer_binding_size);
        if wanted * POSITION > limit {
            return Err(Error::TooLarge { what: "vertex positions", bytes: wanted * POSITION, limit });
        }
        self.buffer = buffer(device, (wanted * 2).min(limit / POSITION));
        self.used = 0;
        self.layout += 1;
        for mesh in self.slots.iter_mut().flatten() {
            mesh.first = self.used as u32;
            upload(queue, &self.buffer, mesh);
            self.used += mesh.topology.positions().len() as u64;
        }
        Ok(())
    }
}

fn upload(queue: &Queue, buffer: &Buffer, mesh: &Mesh) {
    queue.write_buffer(buffer, u64::from(mesh.first) * POSITION, bytemuck::cast_slice(mesh.topology.positions()));
}

fn buffer(device: &Device, positions: u64) -> Buffer {
    device.create_buffer(&BufferDescriptor {
        label: Some("caster positions"),
        size: positions * POSITION,
        usage: BufferUsages::STORAGE | BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}
