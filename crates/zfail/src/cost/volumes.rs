//! What counting costs by rasterisation and by tiles.
//!
//! In: a device. Out: times of volumes like those whose choice is in doubt: many long, thin sides. On a software rasteriser the
//! cost of a side follows its outline, block by block, and so does that of the tile pass; they differ in the time for a block,
//! and the tile pass costs something for every pixel that it looks at.

use super::CostModel;
use crate::{
    Blocking, Caster, Frame, LightKind, MeshBlocking, MeshDescriptor, ShadowLight, Shadows, Steps, Target, low_level,
};
use glam::{DAffine3, DVec3};
use std::time::Instant;
use wgpu::{
    Device, Extent3d, LoadOp, Operations, PollType, Queue, RenderPassDepthStencilAttachment, RenderPassDescriptor,
    StoreOp, TextureAspect, TextureDescriptor, TextureDimension, TextureUsages, TextureView, TextureViewDescriptor,
};
use zfail_plan::bounds::Bounds;
use zfail_plan::plan::{Technique, Tiles};
use zfail_plan::view::{Projection, View};

/// Pixels on a side of the image.
const SIZE: u32 = 512;
/// Sides of the larger volume and of the smaller one.
const SPOKES: [u32; 2] = [1500, 8];

/// The times of rasterising and of tiles, if they can be measured.
pub(super) fn measure(device: &Device, queue: &Queue) -> Option<CostModel> {
    let [(raster, tiled, pairs), (few_rasterised, few_tiled, few_pairs)] =
        [measure_disc(device, queue, SPOKES[0])?, measure_disc(device, queue, SPOKES[1])?];
    let more = pairs.checked_sub(few_pairs).filter(|&more| more > 0)? as f64;
    Some(CostModel {
        raster_pair_ns: (raster - few_rasterised).max(0.0) / more,
        tile_pair_ns: (tiled - few_tiled).max(0.0) / more,
        tile_pixel_ns: (few_tiled - few_rasterised).max(0.0) / f64::from(SIZE * SIZE),
        ..CostModel::RASTERISE
    })
}

/// Nanoseconds of a frame whose one volume has so many sides, rasterised and by tiles, and the pairs in the latter case.
fn measure_disc(device: &Device, queue: &Queue, spokes: u32) -> Option<(f64, f64, usize)> {
    let mut shadows = Shadows::new(device, queue);
    // A jagged disc before a light behind it: its sides fan out over the whole image, which shows nothing but them.
    let rim = |i: u32| {
        let turn = std::f64::consts::TAU * f64::from(i) / f64::from(spokes);
        let radius = if i.is_multiple_of(2) { 0.05 } else { 0.06 };
        DVec3::new(radius * turn.cos(), radius * turn.sin(), 0.0).as_vec3().to_array()
    };
    let positions: Vec<[f32; 3]> = (0..spokes).map(rim).chain([[0.0; 3]]).collect();
    let triangles: Vec<[u32; 3]> = (0..spokes).map(|i| [spokes, i, (i + 1) % spokes]).collect();
    let blocking = MeshBlocking::Uniform(Blocking::BothSides);
    let disc = MeshDescriptor { positions: &positions, triangles: &triangles, blocking, alike: None };
    let casters = [Caster::new(shadows.add_mesh(&disc).ok()?, DAffine3::from_translation(DVec3::NEG_Z))];
    let position = DVec3::new(0.0, 0.0, -1.05);
    let lights = [ShadowLight::new(LightKind::Point { position, range: f64::INFINITY })];
    let projection = Projection::Perspective { yfov: 1.2, near: 0.01, far: None };
    let view = View::new(DAffine3::from_translation(DVec3::Y * 0.2), projection, [SIZE; 2]);
    let receivers = [Bounds { min: DVec3::splat(-9.0), max: DVec3::splat(9.0) }];

    let texture = device.create_texture(&TextureDescriptor {
        label: Some("calibration"),
        size: Extent3d { width: SIZE, height: SIZE, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: TextureDimension::D2,
        format: crate::depth_stencil_format(device.features()),
        usage: TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    let attachment = texture.create_view(&TextureViewDescriptor::default());
    let aspect = TextureAspect::DepthOnly;
    let depth = texture.create_view(&TextureViewDescriptor { aspect, ..TextureViewDescriptor::default() });
    let target = Target { colors: &[], depth_stencil: texture.format(), samples: 1 };
    let pipelines = shadows.pipelines(&target);

    let mut frame = |tiles: Tiles| -> Option<(f64, usize)> {
        let steps = Steps { tiles, ..Technique::Auto.steps() };
        let frame = Frame::new(&view, &casters, &lights).receivers(&receivers).steps(steps).tile_pass(true);
        let mut least = f64::INFINITY;
        let mut pairs = 0;
        // The first time, pipelines are compiled. The least of several is what the device needs when nobody disturbs it.
        for _ in 0..10 {
            let start = Instant::now();
            let prepared = shadows.prepare(&frame).ok()?;
            let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            clear(&mut encoder, &attachment, |_| {});
            let prepared = prepared.count_tiles(&mut encoder, &depth);
            clear(&mut encoder, &attachment, |pass| prepared.draw(pass, &pipelines, 0));
            queue.submit([encoder.finish()]);
            device.poll(PollType::wait_indefinitely()).ok()?;
            least = least.min(start.elapsed().as_secs_f64() * 1e9);
            pairs = low_level::tile_stats(&prepared, 0).map_or(0, |stats| stats.pairs);
        }
        Some((least, pairs))
    };
    let (rasterised, _) = frame(Tiles::Never)?;
    let (tiled, pairs) = frame(Tiles::Always)?;
    Some((rasterised, tiled, pairs))
}

/// A pass that clears depth and stencil, for `draw`.
fn clear(encoder: &mut wgpu::CommandEncoder, attachment: &TextureView, draw: impl FnOnce(&mut wgpu::RenderPass<'_>)) {
    let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
        label: Some("calibration"),
        depth_stencil_attachment: Some(RenderPassDepthStencilAttachment {
            view: attachment,
            depth_ops: Some(Operations { load: LoadOp::Clear(0.0), store: StoreOp::Store }),
            stencil_ops: Some(Operations { load: LoadOp::Clear(0), store: StoreOp::Store }),
        }),
        ..RenderPassDescriptor::default()
    });
    draw(&mut pass);
}
