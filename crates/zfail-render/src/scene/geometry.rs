//! Vertex and index buffers of the scene's meshes, and how vertex stages read them.

use crate::scene::gpu_data::InstanceRecord;
use crate::{Gpu, RenderError, scene::terminator};
use zfail_scene::{BentMesh, Mesh};

/// A mesh on the device.
#[derive(Debug)]
pub struct MeshBuffers {
    /// Object space, `[f32; 3]` each: the bits that shadow volumes start from.
    positions: wgpu::Buffer,
    /// With the tilt (`terminator.rs`) in w, `[f32; 4]` each.
    normals: wgpu::Buffer,
    /// Both texture coordinates, then the colour: `[f32; 8]` each.
    paint: wgpu::Buffer,
    /// `[f32; 4]` each.
    tangents: wgpu::Buffer,
    /// `u32` each, three per triangle.
    indices: wgpu::Buffer,
    /// Of the rest pose; `None` where the mesh is fine or flat.
    pub tilts: Option<Vec<f32>>,
}

/// Which attributes a vertex stage reads; each kind reads those of the kinds before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Vertices {
    /// Positions.
    Depth,
    /// And normals with their tilts.
    Plain,
    /// And texture coordinates and colours.
    Textured,
    /// And tangents.
    Mapped,
}

const fn per_vertex<const N: usize>(
    floats: u64,
    attributes: &'static [wgpu::VertexAttribute; N],
) -> Option<wgpu::VertexBufferLayout<'static>> {
    Some(wgpu::VertexBufferLayout { array_stride: floats * 4, step_mode: wgpu::VertexStepMode::Vertex, attributes })
}

const fn per_instance<const N: usize>(
    attributes: &'static [wgpu::VertexAttribute; N],
) -> Option<wgpu::VertexBufferLayout<'static>> {
    let array_stride = size_of::<InstanceRecord>() as u64;
    Some(wgpu::VertexBufferLayout { array_stride, step_mode: wgpu::VertexStepMode::Instance, attributes })
}

const POSITIONS: Option<wgpu::VertexBufferLayout<'static>> = per_vertex(3, &wgpu::vertex_attr_array![0 => Float32x3]);

const ALL: [Option<wgpu::VertexBufferLayout<'static>>; 5] = [
    POSITIONS,
    per_instance(&wgpu::vertex_attr_array![
        5 => Float32x4, 6 => Float32x4, 7 => Float32x4, 8 => Float32x4,
        9 => Float32x4, 10 => Float32x4, 11 => Float32x4,
        12 => Float32x3, 13 => Float32x3, 14 => Float32x3,
        15 => Uint32x3
    ]),
    per_vertex(4, &wgpu::vertex_attr_array![1 => Float32x4]),
    per_vertex(8, &wgpu::vertex_attr_array![3 => Float32x4, 4 => Float32x4]),
    per_vertex(4, &wgpu::vertex_attr_array![2 => Float32x4]),
];

const DEPTH: [Option<wgpu::VertexBufferLayout<'static>>; 2] = [
    POSITIONS,
    per_instance(&wgpu::vertex_attr_array![5 => Float32x4, 6 => Float32x4, 7 => Float32x4, 8 => Float32x4]),
];

impl Vertices {
    /// The vertex buffers in the order that [`MeshBuffers::bind`] binds them.
    pub fn buffers(self) -> &'static [Option<wgpu::VertexBufferLayout<'static>>] {
        match self {
            Self::Depth => &DEPTH,
            Self::Plain => &ALL[..3],
            Self::Textured => &ALL[..4],
            Self::Mapped => &ALL,
        }
    }
}

impl MeshBuffers {
    /// Uploads `mesh`; attributes that it lacks become neutral.
    pub fn new(gpu: &Gpu, mesh: &Mesh) -> Result<Self, RenderError> {
        let count = mesh.positions.len();
        let tilts = terminator::tilts(mesh);
        let normals = terminator::with_tilts(&mesh.normals, tilts.as_deref(), count);
        let mut tangents = mesh.tangents.clone();
        tangents.resize(count, [0.0; 4]);
        let paint: Vec<[f32; 8]> = (0..count)
            .map(|v| {
                let [u0, v0] = mesh.uv0.get(v).copied().unwrap_or_default();
                let [u1, v1] = mesh.uv1.get(v).copied().unwrap_or_default();
                let [r, g, b, a] = mesh.colors.get(v).copied().unwrap_or([1.0; 4]);
                [u0, v0, u1, v1, r, g, b, a]
            })
            .collect();
        let vertices = |bytes| upload(gpu, &mesh.name, wgpu::BufferUsages::VERTEX, bytes);
        Ok(Self {
            positions: vertices(bytemuck::cast_slice(&mesh.positions))?,
            normals: vertices(bytemuck::cast_slice(&normals))?,
            paint: vertices(bytemuck::cast_slice(&paint))?,
            tangents: vertices(bytemuck::cast_slice(&tangents))?,
            indices: upload(gpu, &mesh.name, wgpu::BufferUsages::INDEX, bytemuck::cast_slice(&mesh.triangles))?,
            tilts,
        })
    }

    /// Replaces what bends.
    pub fn bend(&self, gpu: &Gpu, bent: &BentMesh) {
        gpu.queue.write_buffer(&self.positions, 0, bytemuck::cast_slice(&bent.positions));
        let normals = terminator::with_tilts(&bent.normals, self.tilts.as_deref(), bent.positions.len());
        gpu.queue.write_buffer(&self.normals, 0, bytemuck::cast_slice(&normals));
        gpu.queue.write_buffer(&self.tangents, 0, bytemuck::cast_slice(&bent.tangents));
    }

    /// Of all triangles.
    pub fn index_count(&self) -> u32 {
        (self.indices.size() / size_of::<u32>() as u64) as u32
    }

    /// Binds what `vertices` reads, placed by `instances`.
    pub fn bind(&self, pass: &mut wgpu::RenderPass<'_>, vertices: Vertices, instances: &wgpu::Buffer) {
        let buffers = [&self.positions, instances, &self.normals, &self.paint, &self.tangents];
        for (slot, buffer) in (0..).zip(&buffers[..vertices.buffers().len()]) {
            pass.set_vertex_buffer(slot, buffer.slice(..));
        }
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
    }
}

fn upload(gpu: &Gpu, name: &str, usage: wgpu::BufferUsages, bytes: &[u8]) -> Result<wgpu::Buffer, RenderError> {
    let limit = gpu.device.limits().max_buffer_size;
    if bytes.len() as u64 > limit {
        let needed = bytes.len();
        return Err(RenderError::Scene(format!(
            "mesh \"{name}\" needs a buffer of {needed} bytes, and this device allows {limit}"
        )));
    }
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(name),
        size: bytes.len() as u64,
        usage: usage | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    gpu.queue.write_buffer(&buffer, 0, bytes);
    Ok(buffer)
}
