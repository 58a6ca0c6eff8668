//! What finding silhouettes costs on the CPU and on the device.
//!
//! In: a body, an eye and a light that moves. Out: the time of a frame until its index lists are in the device's memory,
//! found either way. Nothing is drawn.

use crate::error::Error;
use cpu_time::ProcessTime;
use serde::Serialize;
use std::time::{Duration, Instant};
use zfail_plan::glam::{DAffine3, DVec3};
use zfail_plan::light::LightKind;
use zfail_plan::plan::{ShadowLight, Silhouettes, Steps, Technique};
use zfail_plan::view::View;
use zfail_render::zfail::{Caster, Frame, MeshDescriptor, MeshId, Shadows};
use zfail_render::{Gpu, wgpu};
use zfail_scene::Mesh;

/// Frames before the clock counts: pipelines are compiled, buffers have grown.
const WARM_UP: usize = 2;
const FRAMES: usize = 10;

/// Means over frames in each of which the light has moved by a thousandth of its distance.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Extraction {
    /// Milliseconds with silhouettes from the CPU, upload included.
    pub cpu_ms: f64,
    /// Milliseconds with silhouettes from the device as far as it goes, proofs and frames that went to the CPU included.
    pub device_ms: f64,
    /// Share of those frames in which it was the device.
    pub on_device: f64,
}

/// Times both ways in turn. On software devices the time is that of the process, user and system, elsewhere the clock's.
///
/// # Errors
/// If the device fails.
pub fn measure(gpu: &Gpu, mesh: &Mesh, view: &View, light: DVec3) -> Result<Extraction, Error> {
    let mut players = [Player::new(gpu, mesh, Silhouettes::Cpu)?, Player::new(gpu, mesh, Silhouettes::Gpu)?];
    let mut sums = [Duration::ZERO; 2];
    let mut extracted = 0;
    for frame in 0..WARM_UP + FRAMES {
        for (player, sum) in players.iter_mut().zip(&mut sums) {
            let spent = player.play(gpu, view, light * (1.0 + 1e-3 * frame as f64))?;
            if frame >= WARM_UP {
                *sum += spent;
                extracted += player.shadows.prepared().map_or(0, |prepared| prepared.stats(0).extracted);
            }
        }
    }
    let [cpu_ms, device_ms] = sums.map(|sum| sum.as_secs_f64() * 1e3 / FRAMES as f64);
    Ok(Extraction { cpu_ms, device_ms, on_device: f64::from(extracted) / FRAMES as f64 })
}

struct Player {
    shadows: Shadows,
    mesh: MeshId,
    steps: Steps,
}

impl Player {
    fn new(gpu: &Gpu, mesh: &Mesh, silhouettes: Silhouettes) -> Result<Self, Error> {
        let mut shadows = Shadows::new(&gpu.device, &gpu.queue);
        let Mesh { positions, triangles, .. } = mesh;
        let mesh = shadows.add_mesh(&MeshDescriptor { positions, triangles, ..MeshDescriptor::default() })?;
        // As in the lines beside: no near count.
        let steps = Steps { silhouettes, near_count: false, ..Technique::default().steps() };
        Ok(Self { shadows, mesh, steps })
    }

    fn play(&mut self, gpu: &Gpu, view: &View, light: DVec3) -> Result<Duration, Error> {
        let casters = [Caster::new(self.mesh, DAffine3::IDENTITY)];
        let lights = [ShadowLight::new(LightKind::Point { position: light, range: f64::INFINITY })];
        let frame = Frame::new(view, &casters, &lights).steps(self.steps);
        let (wall, cpu) = (Instant::now(), ProcessTime::now());
        self.shadows.prepare(&frame)?;
        // What is only written goes to the device with the next submission.
        gpu.queue.submit([]);
        gpu.device.poll(wgpu::PollType::wait_indefinitely())?;
        let software = gpu.info.device_type == wgpu::DeviceType::Cpu;
        Ok(if software { cpu.elapsed() } else { wall.elapsed() })
    }
}
