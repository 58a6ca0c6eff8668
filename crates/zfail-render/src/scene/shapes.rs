//! Falloff curves, cookies and boxes of the scene's lights in one buffer: `shapes` in `shape.wgsl`.

use crate::scene::mip_maps::Level;
use crate::{Gpu, RenderError, srgb};
use std::collections::HashMap;
use zfail_plan::glam::DVec3;
use zfail_scene::{Filter, Light, LightShape, Scene};

/// Cookies are kept at no more texels a side: a projected picture is seen enlarged.
const COOKIE_SIDE: u32 = 1024;

/// What stays from frame to frame.
#[derive(Debug)]
pub struct Shapes {
    pub buffer: wgpu::Buffer,
    /// Where each light's shape begins, in words; 0 for plain lights.
    pub of_light: Vec<u32>,
    /// The shapes in the buffer that are not plain.
    packed: Vec<(LightShape, u32)>,
}

impl Shapes {
    pub fn new(gpu: &Gpu, scene: &Scene) -> Result<Self, RenderError> {
        let (words, of_light) = pack(scene);
        let size = words.len() as u64 * 4;
        let limits = gpu.device.limits();
        if size > limits.max_buffer_size.min(limits.max_storage_buffer_binding_size) {
            return Err(RenderError::Scene("too many falloff curves and cookies for this device".to_owned()));
        }
        let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("shapes of lights"),
            size,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        gpu.queue.write_buffer(&buffer, 0, bytemuck::cast_slice(&words));
        let packed = scene.lights.iter().map(|light| light.shape.clone()).zip(of_light.iter().copied());
        let packed = packed.filter(|(shape, _)| !shape.is_plain()).collect();
        Ok(Self { buffer, of_light, packed })
    }

    /// Takes other lights if the buffer holds all their shapes already; returns whether it does.
    pub fn hold(&mut self, lights: &[Light]) -> bool {
        let same = |a: &LightShape, b: &LightShape| {
            (&a.falloff, a.cookie, a.half_extents) == (&b.falloff, b.cookie, b.half_extents)
        };
        let place = |light: &Light| match light.shape.is_plain() {
            true => Some(0),
            false => self.packed.iter().find(|(shape, _)| same(shape, &light.shape)).map(|(_, first)| *first),
        };
        let places: Option<Vec<u32>> = lights.iter().map(place).collect();
        let held = places.is_some();
        self.of_light = places.unwrap_or(std::mem::take(&mut self.of_light));
        held
    }
}

/// The buffer's words, and where each light's shape begins.
fn pack(scene: &Scene) -> (Vec<u32>, Vec<u32>) {
    let mut words = vec![0];
    let mut cookies = HashMap::new();
    let mut of_light = Vec::with_capacity(scene.lights.len());
    for light in &scene.lights {
        let shape = &light.shape;
        of_light.push(if shape.is_plain() {
            0
        } else {
            let cookie = shape.cookie.map_or(0, |texture| {
                *cookies.entry(texture).or_insert_with(|| {
                    let first = words.len() as u32;
                    pack_cookie(scene, texture, &mut words);
                    first
                })
            });
            pack_shape(shape, cookie, &mut words)
        });
    }
    (words, of_light)
}

fn pack_shape(shape: &LightShape, cookie: u32, words: &mut Vec<u32>) -> u32 {
    let first = words.len() as u32;
    let half = shape.half_extents.unwrap_or(DVec3::INFINITY).min(DVec3::splat(f32::MAX.into()));
    words.extend(half.as_vec3().to_array().map(f32::to_bits));
    words.extend([first + 6, shape.falloff.len().saturating_sub(1) as u32, cookie]);
    words.extend(shape.falloff.iter().map(|x| x.to_bits()));
    first
}

fn pack_cookie(scene: &Scene, texture: usize, words: &mut Vec<u32>) {
    let texture = scene.textures[texture];
    let image = &scene.images[texture.image];
    let mut level = Level { width: image.width, height: image.height, rgba: image.rgba.clone() };
    while level.width.max(level.height) > COOKIE_SIDE {
        level = level.half(true);
    }
    let levels = if texture.mipmaps { level.width.max(level.height).ilog2() + 1 } else { 1 };
    words.extend([level.width, level.height, levels, u32::from(texture.mag == Filter::Linear)]);
    let fractions: [u32; 256] =
        std::array::from_fn(|code| (srgb::linear(code as f32 / 255.0) * 65535.0).round() as u32);
    for remaining in (0..levels).rev() {
        words.extend(level.rgba.chunks_exact(4).flat_map(|texel| {
            let [r, g, b] = [0, 1, 2].map(|channel| fractions[usize::from(texel[channel])]);
            [r | g << 16, b]
        }));
        if remaining > 0 {
            level = level.half(true);
        }
    }
}
