//! Structures shared with the shaders: one Rust twin per WGSL struct, of the same layout (tested).

use crate::scene::draw_list::SLOTS;
use bytemuck::{Pod, Zeroable};

/// How many lights shaders know without a loop: `UNROLLED` in `frame.wgsl`.
pub const UNROLLED: usize = 4;

/// `Frame` in `frame.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct FrameUniform {
    pub view_per_ndc: [f32; 2],
    pub size: [f32; 2],
    pub ambient: [f32; 3],
    pub orthographic: f32,
    pub up: [f32; 3],
    pub pre_exposure: f32,
    pub background: [f32; 3],
    pub exposure: f32,
    pub zenith: [f32; 3],
    pub light_count: u32,
    pub horizon: [f32; 3],
    pub all_lights: u32,
    pub nadir: [f32; 3],
    pub per_ground_radius: f32,
    pub ground: [f32; 3],
    pub pad: u32,
    pub window_offset: [f32; 2],
    pub pad_to_lights: [u32; 2],
    pub lights: [LightRecord; UNROLLED],
}

/// The attributes that step by instance, in the `Vertex` of every vertex stage.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct InstanceRecord {
    /// By columns.
    pub clip_from_object: [[f32; 4]; 4],
    /// By rows.
    pub view_from_object: [[f32; 4]; 3],
    /// By columns: the inverse transpose, up to a positive factor.
    pub normal: [[f32; 3]; 3],
    /// Range of the lists of lights.
    pub lights: [u32; 2],
    /// 1 where no shadow falls on it, 0 elsewhere.
    pub exempt: u32,
}

/// `Slot` in `material.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct SlotUniform {
    pub u: [f32; 4],
    pub v: [f32; 4],
}

/// `Material` in `material.wgsl`.
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
    /// Reflectance at normal incidence.
    pub specular: [f32; 3],
    pub specular_strength: f32,
    pub sheen: [f32; 3],
    pub sheen_roughness: f32,
    pub tint: [f32; 3],
    pub transmission: f32,
    pub clearcoat: f32,
    pub clearcoat_roughness: f32,
    pub pad: [f32; 2],
    /// Of `material_slots`.
    pub slots: [SlotUniform; SLOTS],
}

/// `Light` in `frame.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct LightRecord {
    pub position: [f32; 3],
    pub placed: f32,
    pub axis: [f32; 3],
    pub per_range: f32,
    pub color: [f32; 3],
    pub sin_outer: f32,
    pub cos_outer: f32,
    pub angle_scale: f32,
    pub angle_offset: f32,
    /// Into the buffer of [`crate::scene::shapes::Shapes`]; 0 for a plain light.
    pub shape: u32,
    pub right: [f32; 3],
    pub cot_outer: f32,
    pub up: [f32; 3],
    pub pad: u32,
}
