//! A depth map seen from the light: Williams, "Casting Curved Shadows on Curved Surfaces", 1978; McG section 3.
//!
//! The scene is drawn from the light, and a surface is in shadow if the map has something nearer in its direction. "Not
//! much in the way of coding subtleties required. The performance is more level ... Unfortunately, the quality just isn't
//! good enough unless you use extremely high resolution shadow maps ..., and you need to tweak the biases and ranges in
//! many scenes" (C). A texel stands for all that it covers: edges have stairs, and a sloping surface lies partly behind
//! its own texel and shadows itself (acne). A bias against that lifts shadows off their casters (peter-panning).
//!
//! Point lights have the six faces of a cube, spot lights a single frustum around their cone, directional lights a box
//! around the scene. What lies outside of all maps is lit, "which works for movie sets but not for architectural
//! walkthroughs" (C); here only what a spot light does not reach does.

use crate::geometry::Geometry;
use crate::stage::{self, Stage, Surfaces};
use crate::{Error, Figures, ShadowMapOptions};
use bytemuck::{Pod, Zeroable};
use std::f64::consts::FRAC_PI_2;
use std::time::Instant;
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::{Device, Operations, TextureFormat, TextureUsages, TextureView, TextureViewDescriptor};
use zfail_plan::bounds::Bounds;
use zfail_plan::glam::{DAffine3, DMat3, DMat4, DVec3};
use zfail_plan::light::LightKind;
use zfail_plan::view::{Projection, View};
use zfail_render::Gpu;
use zfail_scene::Light;

const DEPTH: TextureFormat = TextureFormat::Depth32Float;
/// Where maps of lights that are somewhere begin, as a share of where they end.
const NEAR: f64 = 1e-3;
/// The widest half angle of a cone that one frustum serves; a cube does for wider ones.
const WIDEST: f64 = 1.2;

/// `Map` of `shadow_map.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct MapUniform {
    faces: [[[f32; 4]; 4]; 6],
    light: [f32; 4],
    face_count: u32,
    resolution: u32,
    pcf: u32,
    near: f32,
    range: f32,
    bias: f32,
    slope_bias: f32,
    texel: f32,
}

/// The maps' cameras, and the depth range that they share.
struct Maps {
    faces: Vec<View>,
    near: f64,
    range: f64,
    /// Size of a texel, at distance 1 unless rays are parallel.
    texel: f64,
}

/// What `light` reaches, looked up in maps.
pub fn shadow(
    gpu: &Gpu,
    stage: &mut Stage,
    geometry: &Geometry,
    view: &View,
    light: &Light,
    options: &ShadowMapOptions,
) -> Result<(Vec<u8>, Figures), Error> {
    check(gpu, options)?;
    let device = &gpu.device;
    let start = Instant::now();
    let maps = Maps::new(light, &geometry.bounds, options.resolution);
    let uniform = maps.uniform(view, light, options);
    let planning_ms = start.elapsed().as_secs_f64() * 1e3;

    let layers = layers(device, options.resolution, maps.faces.len() as u32);
    let surfaces = lookup(gpu, &uniform, &layers.all);
    let map_pipeline = stage.map_pipeline(device, DEPTH);
    let placed: Vec<wgpu::Buffer> =
        maps.faces.iter().map(|face| stage::placements(device, &geometry.placements(face))).collect();
    let draw_maps = |encoder: &mut wgpu::CommandEncoder, bind: &dyn Fn(&mut wgpu::RenderPass<'_>)| {
        for (target, placements) in layers.each.iter().zip(&placed) {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("shadow map"),
                depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                    view: target,
                    depth_ops: Some(Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
                    stencil_ops: None,
                }),
                ..Default::default()
            });
            pass.set_vertex_buffer(1, placements.slice(..));
            bind(&mut pass);
            for (number, _, mesh) in geometry.casters(light) {
                pass.set_vertex_buffer(0, mesh.positions.slice(..));
                pass.set_index_buffer(mesh.casting.slice(..), wgpu::IndexFormat::Uint32);
                pass.draw_indexed(0..mesh.casting_len, 0, number as u32..number as u32 + 1);
            }
        }
    };

    let (mask, render_ms) = stage.forward(gpu, geometry, view, &surfaces, |encoder| {
        draw_maps(encoder, &|pass| pass.set_pipeline(&map_pipeline));
    })?;
    let (counters, counting) = stage.counting_surfaces(device, DEPTH);
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    draw_maps(&mut encoder, &|pass| {
        pass.set_pipeline(&counting);
        pass.set_bind_group(0, &counters.bind_group, &[]);
    });
    let fragments = counters.read(gpu, encoder)?;
    let once: u64 = geometry.casters(light).map(|(.., mesh)| u64::from(mesh.casting_len / 3)).sum();
    let triangles = once * maps.faces.len() as u64;
    let passes = maps.faces.len() as u32 + 2;
    Ok((mask, Figures { triangles, vertices: 3 * triangles, fragments, passes, planning_ms, render_ms }))
}

fn check(gpu: &Gpu, options: &ShadowMapOptions) -> Result<(), Error> {
    let most = gpu.device.limits().max_texture_dimension_2d;
    if !(1..=most).contains(&options.resolution) {
        let remedy = "it has to be at least 1, and at most what the device's textures may have";
        return Err(Error::BadOption { option: "shadow_map.resolution", value: options.resolution.into(), remedy });
    }
    for (option, value) in [("shadow_map.bias", options.bias), ("shadow_map.slope_bias", options.slope_bias)] {
        if !value.is_finite() {
            return Err(Error::BadOption { option, value: value.into(), remedy: "it has to be finite" });
        }
    }
    Ok(())
}

impl Maps {
    fn new(light: &Light, bounds: &Bounds, resolution: u32) -> Self {
        let size = [resolution; 2];
        let texels = f64::from(resolution);
        let (position, range, cone) = match light.kind {
            LightKind::Point { position, range } => (position, range, None),
            LightKind::Spot { position, direction, range, outer, .. } => {
                (position, range, (outer <= WIDEST).then_some((direction, outer)))
            }
            LightKind::Directional { direction } => {
                let axes = facing(direction);
                let around = if bounds.is_empty() { Bounds::of([DVec3::ZERO]) } else { *bounds };
                let center = around.center();
                // A little more than the scene, so that nothing lies on the border.
                let half = around.corners().map(|corner| (axes.transpose() * (corner - center)).abs());
                let half = half.into_iter().fold(DVec3::ZERO, DVec3::max) * 1.01 + 1e-6;
                let ymag = half.x.max(half.y);
                let projection = Projection::Orthographic { ymag, near: -half.z, far: half.z };
                let world_from_view = DAffine3 { matrix3: axes, translation: center };
                let faces = vec![View::new(world_from_view, projection, size)];
                return Self { faces, near: 0.0, range: 2.0 * half.z, texel: 2.0 * ymag / texels };
            }
        };
        let farthest = bounds.corners().map(|corner| corner.distance(position)).into_iter().fold(0.0, f64::max);
        let end = if bounds.is_empty() { range } else { range.min(farthest) };
        let end = if end.is_finite() && end > 0.0 { end } else { 1.0 };
        let near = NEAR * end;
        let face = |direction: DVec3, half_angle: f64| {
            View::new(
                DAffine3 { matrix3: facing(direction), translation: position },
                Projection::Perspective { yfov: 2.0 * half_angle, near, far: None },
                size,
            )
        };
        let axes = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
        let (faces, half_angle) = match cone {
            // As wide as the cone and a texel more.
            Some((direction, outer)) => (vec![face(direction, outer + 1.0 / texels)], outer),
            None => (axes.map(|axis| face(axis, 0.5 * FRAC_PI_2)).to_vec(), 0.5 * FRAC_PI_2),
        };
        Self { faces, near, range: end - near, texel: 2.0 * half_angle.tan() / texels }
    }

    fn uniform(&self, view: &View, light: &Light, options: &ShadowMapOptions) -> MapUniform {
        let mut faces = [[[0.0; 4]; 4]; 6];
        for (matrix, face) in faces.iter_mut().zip(&self.faces) {
            let to_face = DMat4::from_translation(view.eye() - face.eye());
            *matrix = (face.clip_from_relative() * to_face).as_mat4().to_cols_array_2d();
        }
        let at = light.kind.homogeneous();
        MapUniform {
            faces,
            light: (at - (view.eye() * at.w).extend(0.0)).as_vec4().to_array(),
            face_count: self.faces.len() as u32,
            resolution: options.resolution,
            pcf: options.pcf.into(),
            near: self.near as f32,
            range: self.range as f32,
            bias: (f64::from(options.bias) * self.range) as f32,
            slope_bias: options.slope_bias,
            texel: self.texel as f32,
        }
    }
}

/// World from a space that looks along `direction`.
fn facing(direction: DVec3) -> DMat3 {
    let back = -direction;
    let right = back.any_orthonormal_vector();
    DMat3::from_cols(right, back.cross(right), back)
}

/// The maps' texture: for reading, and each layer for drawing.
struct Layers {
    all: TextureView,
    each: Vec<TextureView>,
}

fn layers(device: &Device, resolution: u32, count: u32) -> Layers {
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("shadow map"),
        size: wgpu::Extent3d { width: resolution, height: resolution, depth_or_array_layers: count },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: DEPTH,
        usage: TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    let view = |dimension, base_array_layer, count| {
        texture.create_view(&TextureViewDescriptor {
            dimension: Some(dimension),
            base_array_layer,
            array_layer_count: Some(count),
            ..TextureViewDescriptor::default()
        })
    };
    let each = (0..count).map(|layer| view(wgpu::TextureViewDimension::D2, layer, 1)).collect();
    Layers { all: view(wgpu::TextureViewDimension::D2Array, 0, count), each }
}

/// Surfaces that are looked up in the maps.
fn lookup(gpu: &Gpu, uniform: &MapUniform, maps: &TextureView) -> Surfaces {
    let device = &gpu.device;
    let entry =
        |binding, ty| wgpu::BindGroupLayoutEntry { binding, visibility: wgpu::ShaderStages::FRAGMENT, ty, count: None };
    let buffer = wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    let texture = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: false },
        view_dimension: wgpu::TextureViewDimension::D2Array,
        multisampled: false,
    };
    let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("shadow map"),
        entries: &[entry(0, buffer), entry(1, texture)],
    });
    let uniform = device.create_buffer_init(&BufferInitDescriptor {
        label: Some("shadow map"),
        contents: bytemuck::bytes_of(uniform),
        usage: wgpu::BufferUsages::UNIFORM,
    });
    let entries = [
        wgpu::BindGroupEntry { binding: 0, resource: uniform.as_entire_binding() },
        wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(maps) },
    ];
    Surfaces::new(gpu, ["", include_str!("shadow_map.wgsl")], &layout, &entries)
}

#[cfg(test)]
mod tests {
    use super::MapUniform;
    use zfail_testing::{layout, naga::valid::Capabilities, wgsl::validate};

    #[test]
    fn a_map_lies_as_its_shader_reads_it() {
        let source = [include_str!("stage/surface.wgsl"), include_str!("shadow_map.wgsl")].concat();
        let module = validate(&source, Capabilities::empty()).expect("WGSL");
        layout!(
            &module,
            "Map",
            MapUniform,
            [faces, light, face_count, resolution, pcf, near, range, bias, slope_bias, texel]
        )
        .expect("agreement");
    }
}
