//! Structures shared with the shaders: one Rust twin per WGSL struct, of the same layout (tested).

use bytemuck::{Pod, Zeroable};

/// `Frame` in `frame.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct FrameUniform {
    pub view_per_ndc: [f32; 2],
    pub size: [f32; 2],
    pub ambient: [f32; 3],
    pub orthographic: f32,
    pub pre_exposure: f32,
    pub light_count: u32,
    pub pad: [u32; 2],
}

/// `Instance` in `surface.wgsl`; matrices by columns.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct InstanceUniform {
    pub clip_from_object: [[f32; 4]; 4],
    pub view_from_object: [[f32; 4]; 4],
    pub view_from_object_normal: [[f32; 4]; 4],
}

/// `Slot` in `surface.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct SlotUniform {
    pub u: [f32; 4],
    pub v: [f32; 4],
}

/// `Material` in `surface.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct MaterialUniform {
    pub base_color: [f32; 4],
    pub emissive: [f32; 3],
    pub alpha_cutoff: f32,
    pub metallic: f32,
    pub roughness: f32,
    pub normal_scale: f32,
    pub occlusion_strength: f32,
    pub textured: u32,
    pub unlit: u32,
    pub pad: [u32; 2],
    /// Base colour, metallic-roughness, normal, occlusion, emissive.
    pub slots: [SlotUniform; 5],
}

/// `Light` in `light.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct LightRecord {
    pub position: [f32; 3],
    pub kind: u32,
    pub axis: [f32; 3],
    pub per_range: f32,
    pub color: [f32; 3],
    pub sin_outer: f32,
    pub cos_outer: f32,
    pub angle_scale: f32,
    pub angle_offset: f32,
    pub pad: u32,
}

/// The vertex attributes beside the position, in `surface.wgsl`'s `Vertex`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct VertexAttributes {
    pub normal: [f32; 3],
    pub tangent: [f32; 4],
    pub uv: [f32; 4],
    pub color: [f32; 4],
}
