//! Renderer against oracle.

mod backends;
mod controls;
mod ground;
mod history;
mod known_issues;
mod many_lights;
mod masks;
mod off_centre;
mod random_scenes;
mod real_files;
mod regressions;
mod silhouettes;

use zfail_render::{Gpu, GpuOptions};

fn gpu() -> Option<Gpu> {
    zfail_testing::gpu(Gpu::new(&GpuOptions::default()))
}
