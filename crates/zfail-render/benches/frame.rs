//! A whole frame of built-in scenes, with shadows and without: their difference is what shadows cost.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use zfail_render::{Gpu, GpuOptions, Renderer, Settings};

const SIZE: [u32; 2] = [640, 360];

fn frame(c: &mut Criterion) {
    let Some(gpu) = zfail_testing::gpu(Gpu::new(&GpuOptions::default())) else { return };
    let mut group = c.benchmark_group("frame");
    group.sample_size(10);
    for name in ["container", "room", "cathedral"] {
        let scene = zfail_builtin::scene(name).expect("a built-in scene");
        let view = scene.cameras[0].view(SIZE, &scene.bounds());
        let mut renderer = Renderer::new(&gpu, &scene).expect("renderer");
        for shadows in [false, true] {
            let settings = Settings { shadows, ..Settings::default() };
            let id = BenchmarkId::new(name, if shadows { "with shadows" } else { "without" });
            group.bench_function(id, |b| b.iter(|| renderer.picture(&view, &settings).expect("picture")));
        }
    }
}

criterion_group!(benches, frame);
criterion_main!(benches);
