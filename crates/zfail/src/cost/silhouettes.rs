//! What silhouettes cost on the CPU and on the device.
//!
//! In: a device. Out: times of a large caster and a small one under a moving light, found either way until the device is
//! idle. Nothing is drawn: both ways draw much the same.

use super::CostModel;
use crate::{
    Caster, Counting, Frame, LightKind, MeshDescriptor, MeshId, ShadowLight, Shadows, Silhouettes, Steps, Technique,
};
use glam::{DAffine3, DVec3};
use std::f64::consts::TAU;
use std::time::Instant;
use wgpu::{Device, PollType, Queue};
use zfail_plan::view::{Projection, View};

/// Quads along and around the rings.
const SIZES: [[u32; 2]; 2] = [[96, 64], [24, 12]];
/// The first time, pipelines are compiled. The least of several is what it takes when nobody disturbs it.
const FRAMES: u32 = 5;

/// Completes `model` with the times of silhouettes, if they can be measured.
pub(super) fn measure(device: &Device, queue: &Queue, model: CostModel) -> Option<CostModel> {
    let [large, small] = SIZES.map(|[along, around]| f64::from(2 * along * around));
    // The pipelines are the same for both.
    let mut shadows = Shadows::new(device, queue);
    let [large_ring, small_ring] = SIZES.map(|size| ring(&mut shadows, size));
    let (large_ring, small_ring) = (large_ring?, small_ring?);
    let mut times = |silhouettes| {
        let mut time = |mesh| measure_mesh(&mut shadows, device, queue, mesh, silhouettes);
        Some((time(large_ring)?, time(small_ring)?))
    };
    let (cpu, gpu) = (times(Silhouettes::Cpu)?, times(Silhouettes::Gpu)?);
    let each = |(of_large, of_small): (f64, f64)| (of_large - of_small).max(0.0) / (large - small);
    let (cpu_triangle_ns, gpu_triangle_ns) = (each(cpu), each(gpu));
    let rest = |of_small: f64, each: f64| of_small - each * small;
    let gpu_caster_ns = (rest(gpu.1, gpu_triangle_ns) - rest(cpu.1, cpu_triangle_ns)).max(0.0);
    Some(CostModel { cpu_triangle_ns, gpu_triangle_ns, gpu_caster_ns, ..model })
}

fn ring(shadows: &mut Shadows, [along, around]: [u32; 2]) -> Option<MeshId> {
    let id = |i: u32, j: u32| i % along * around + j % around;
    let grid = || (0..along).flat_map(|i| (0..around).map(move |j| (i, j)));
    let vertex = |(i, j): (u32, u32)| {
        let (u, v) = (TAU * f64::from(i) / f64::from(along), TAU * f64::from(j) / f64::from(around));
        let r = 1.0 + 0.4 * v.cos();
        DVec3::new(r * u.cos(), 0.4 * v.sin(), r * u.sin()).as_vec3().to_array()
    };
    let quad = |(i, j)| [[id(i, j), id(i, j + 1), id(i + 1, j + 1)], [id(i, j), id(i + 1, j + 1), id(i + 1, j)]];
    let positions: Vec<[f32; 3]> = grid().map(vertex).collect();
    let triangles: Vec<[u32; 3]> = grid().flat_map(quad).collect();
    shadows.add_mesh(&MeshDescriptor { positions: &positions, triangles: &triangles, ..MeshDescriptor::default() }).ok()
}

/// Nanoseconds of a frame in which the light of one mesh has moved.
fn measure_mesh(
    shadows: &mut Shadows,
    device: &Device,
    queue: &Queue,
    mesh: MeshId,
    silhouettes: Silhouettes,
) -> Option<f64> {
    let casters = [Caster::new(mesh, DAffine3::IDENTITY)];
    let view = View::new(
        DAffine3::from_translation(5.0 * DVec3::Z),
        Projection::Perspective { yfov: 1.0, near: 0.1, far: None },
        [64; 2],
    );
    let steps = Steps { silhouettes, fan: true, ..Technique::EverittKilgard.steps() };
    let mut least = f64::INFINITY;
    for frame in 0..FRAMES {
        let position = DVec3::new(2.0 + 1e-3 * f64::from(frame), 5.0, 3.0);
        let lights = [ShadowLight::new(LightKind::Point { position, range: f64::INFINITY })];
        // Counts, not verdicts: no proof that they do not wrap, which either way may need or may have.
        let frame = Frame::new(&view, &casters, &lights).steps(steps).counting(Counting::Raw);
        let start = Instant::now();
        shadows.prepare(&frame).ok()?;
        // What is only written goes to the device with the next submission.
        queue.submit([]);
        device.poll(PollType::wait_indefinitely()).ok()?;
        least = least.min(start.elapsed().as_secs_f64() * 1e9);
    }
    Some(least)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_ways_are_measured() {
        let found = zfail_testing::device(|_| wgpu::DeviceDescriptor::default());
        let Some(raw) = zfail_testing::gpu(found) else { return };
        let (device, queue) = (raw.device, raw.queue);
        let start = Instant::now();
        let model = measure(&device, &queue, CostModel::RASTERISE).expect("times");
        println!("{model:?}, found in {:?}", start.elapsed());
        assert!(model.cpu_triangle_ns > 0.0 && model.gpu_triangle_ns > 0.0);
        // Where nothing was measured, nothing is asked of the device.
        assert!(!CostModel::RASTERISE.may_extract(1 << 30));
        // The larger the caster, the more the cheaper triangle matters.
        let quick = CostModel { gpu_triangle_ns: 0.5 * model.cpu_triangle_ns, gpu_caster_ns: 1e6, ..model };
        let least = (2e6 / model.cpu_triangle_ns) as usize;
        assert!(!quick.may_extract(least / 2) && quick.may_extract(2 * least));
    }
}
