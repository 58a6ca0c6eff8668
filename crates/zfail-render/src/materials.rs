//! Materials on the device: a uniform and five textures each.

use crate::Gpu;
use crate::draw_list::material_slots;
use crate::gpu_data::{MaterialUniform, SlotUniform};
use crate::layouts::{Layouts, bind};
use crate::textures::Textures;
use zfail_plan::scene::{AlphaMode, Material, Scene, TextureRef};

/// The bind groups of the scene's materials and, after them, of the default material.
pub fn upload(gpu: &Gpu, layouts: &Layouts, scene: &Scene) -> Vec<wgpu::BindGroup> {
    let mut textures = Textures::new(gpu, scene);
    let default = Material::default();
    scene.materials.iter().chain([&default]).map(|m| bind_group(gpu, layouts, &mut textures, m)).collect()
}

fn bind_group(gpu: &Gpu, layouts: &Layouts, textures: &mut Textures<'_>, material: &Material) -> wgpu::BindGroup {
    let slots = material_slots(material);
    let uniform = MaterialUniform {
        base_color: material.base_color,
        emissive: material.emissive,
        alpha_cutoff: if let AlphaMode::Mask(cutoff) = material.alpha { cutoff } else { 0.0 },
        metallic: material.metallic,
        roughness: material.roughness,
        normal_scale: material.normal_scale,
        occlusion_strength: material.occlusion_strength,
        slots: slots.map(slot_uniform),
    };
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(&material.name),
        size: size_of::<MaterialUniform>() as u64,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    gpu.queue.write_buffer(&buffer, 0, bytemuck::bytes_of(&uniform));
    // Base colour and emission are colours.
    let srgb = [true, false, false, false, true];
    let bindings: Vec<_> = slots.into_iter().zip(srgb).map(|(slot, srgb)| textures.get(slot, srgb)).collect();
    let mut resources = vec![buffer.as_entire_binding()];
    for (view, sampler) in &bindings {
        resources.push(wgpu::BindingResource::TextureView(view));
        resources.push(wgpu::BindingResource::Sampler(sampler));
    }
    bind(&gpu.device, &material.name, &layouts.material, &resources)
}

fn slot_uniform(slot: Option<TextureRef>) -> SlotUniform {
    let slot = slot.unwrap_or(TextureRef::new(0));
    let [[ux, uy, uz], [vx, vy, vz]] = slot.uv_from_mesh;
    SlotUniform { u: [ux, uy, uz, f32::from(slot.uv_set)], v: [vx, vy, vz, 0.0] }
}
