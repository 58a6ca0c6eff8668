//! Materials on the device: a uniform and its textures each.

use crate::Gpu;
use crate::scene::draw_list::material_slots;
use crate::scene::gpu_data::{MaterialUniform, SlotUniform};
use crate::scene::layouts::{Layouts, bind};
use crate::scene::textures::Textures;
use zfail_scene::{AlphaMode, Material, Scene, TextureRef};

/// How much a blended surface must cover to be the nearest layer, on which shadows fall: what is hardly there must not keep
/// them from the layer behind.
const LAYER: f32 = 0.125;

/// The bind groups of the scene's materials and, after them, of the default material.
pub fn upload(gpu: &Gpu, layouts: &Layouts, scene: &Scene) -> Vec<wgpu::BindGroup> {
    let mut textures = Textures::new(gpu, scene);
    let default = Material::default();
    scene.materials.iter().chain([&default]).map(|m| bind_group(gpu, layouts, &mut textures, m)).collect()
}

fn bind_group(gpu: &Gpu, layouts: &Layouts, textures: &mut Textures<'_>, material: &Material) -> wgpu::BindGroup {
    let slots = material_slots(material);
    let (glossy, clearcoat) = (material.specular_glossiness, material.clearcoat);
    let (sheen, transmission) = (material.sheen, material.transmission);
    let uniform = MaterialUniform {
        base_color: material.base_color,
        emissive: material.emissive,
        alpha_cutoff: match material.alpha {
            // Whatever its alpha, a transmissive surface is there.
            AlphaMode::Opaque if transmission.is_some() => -1.0,
            AlphaMode::Mask(cutoff) => cutoff,
            AlphaMode::Blend => LAYER,
            AlphaMode::Opaque => 0.0,
        },
        metallic: material.metallic,
        roughness: glossy.map_or(material.roughness, |glossy| 1.0 - glossy.glossiness),
        normal_scale: material.normal_scale,
        occlusion_strength: material.occlusion_strength,
        specular: glossy.map_or(material.specular.normal_reflectance(), |glossy| glossy.color),
        specular_strength: material.specular.strength,
        sheen: sheen.map_or([0.0; 3], |sheen| sheen.color),
        sheen_roughness: sheen.map_or(0.0, |sheen| sheen.roughness),
        tint: transmission.map_or([1.0; 3], |transmission| transmission.tint),
        transmission: transmission.map_or(0.0, |transmission| transmission.share),
        clearcoat: clearcoat.map_or(0.0, |coat| coat.strength),
        clearcoat_roughness: clearcoat.map_or(0.0, |coat| coat.roughness),
        pad: [0.0; 2],
        slots: slots.map(slot_uniform),
    };
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(&material.name),
        size: size_of::<MaterialUniform>() as u64,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    gpu.queue.write_buffer(&buffer, 0, bytemuck::bytes_of(&uniform));
    // Base colour, emission, specular and sheen are colours.
    let srgb = [true, glossy.is_some(), false, false, true, true, false, true, false];
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
