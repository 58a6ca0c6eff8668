//! Temporary.
use zfail_render::*;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let mut scene = match a[1].strip_prefix("builtin:") {
        Some(n) => zfail_scene::builtin::scene(n).unwrap(),
        None => zfail_scene::load(a[1].as_ref()).unwrap(),
    };
    zfail_scene::complete(&mut scene);
    let gpu = Gpu::new(&GpuOptions::default()).unwrap();
    let mut r = Renderer::new(&gpu, &scene).unwrap();
    let cam: usize = a.get(3).map_or(0, |s| s.parse().unwrap());
    let view = scene.cameras[cam].view([960, 540], &scene.bounds());
    let t = std::time::Instant::now();
    let (p, s) = r.picture(&view, &Settings { samples: 4, ..Settings::default() }).unwrap();
    eprintln!("{:?} {}", t.elapsed(), scene.notices.join("\n"));
    let mut out = format!("P6\n{} {}\n255\n", 960, 540).into_bytes();
    out.extend(p.rgba8.chunks(4).flat_map(|c| [c[0], c[1], c[2]]));
    std::fs::write(&a[2], out).unwrap();
    eprintln!("planning {} {:?}", s.planning_ms, s.lights);
}
