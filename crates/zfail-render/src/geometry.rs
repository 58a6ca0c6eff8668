//! Vertex and index buffers of the scene's meshes.

use crate::gpu_data::VertexAttributes;
use crate::{Gpu, RenderError};
use zfail_plan::scene::Mesh;

/// A mesh on the device.
#[derive(Debug)]
pub struct MeshBuffers {
    /// Object space, `[f32; 3]` each: the bits that shadow volumes start from.
    pub positions: wgpu::Buffer,
    /// [`VertexAttributes`] each.
    pub attributes: wgpu::Buffer,
    /// `u32` each, three per triangle.
    pub indices: wgpu::Buffer,
}

/// The vertex buffers in the order that [`MeshBuffers::bind`] binds them.
pub const VERTEX_BUFFERS: [Option<wgpu::VertexBufferLayout<'static>>; 2] = [
    Some(wgpu::VertexBufferLayout {
        array_stride: size_of::<[f32; 3]>() as u64,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &wgpu::vertex_attr_array![0 => Float32x3],
    }),
    Some(wgpu::VertexBufferLayout {
        array_stride: size_of::<VertexAttributes>() as u64,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &wgpu::vertex_attr_array![1 => Float32x3, 2 => Float32x4, 3 => Float32x4, 4 => Float32x4],
    }),
];

impl MeshBuffers {
    /// Uploads `mesh`; attributes that it lacks become neutral.
    pub fn new(gpu: &Gpu, mesh: &Mesh) -> Result<Self, RenderError> {
        let attributes: Vec<VertexAttributes> = (0..mesh.positions.len())
            .map(|v| {
                let [u0, v0] = mesh.uv0.get(v).copied().unwrap_or_default();
                let [u1, v1] = mesh.uv1.get(v).copied().unwrap_or_default();
                VertexAttributes {
                    normal: mesh.normals.get(v).copied().unwrap_or_default(),
                    tangent: mesh.tangents.get(v).copied().unwrap_or_default(),
                    uv: [u0, v0, u1, v1],
                    color: mesh.colors.get(v).copied().unwrap_or([1.0; 4]),
                }
            })
            .collect();
        Ok(Self {
            positions: upload(gpu, &mesh.name, wgpu::BufferUsages::VERTEX, bytemuck::cast_slice(&mesh.positions))?,
            attributes: upload(gpu, &mesh.name, wgpu::BufferUsages::VERTEX, bytemuck::cast_slice(&attributes))?,
            indices: upload(gpu, &mesh.name, wgpu::BufferUsages::INDEX, bytemuck::cast_slice(&mesh.triangles))?,
        })
    }

    pub fn bind(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_vertex_buffer(0, self.positions.slice(..));
        pass.set_vertex_buffer(1, self.attributes.slice(..));
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
