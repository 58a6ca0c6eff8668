//! Throw-away: CPU ms per frame of scenes, per technique.
#![allow(missing_docs, clippy::pedantic)]
use zfail_render::*;
fn cpu() -> f64 {
    let s = std::fs::read_to_string("/proc/self/stat").unwrap();
    let f: Vec<&str> = s[s.rfind(')').unwrap() + 2..].split(' ').collect();
    (f[11].parse::<f64>().unwrap() + f[12].parse::<f64>().unwrap()) * 10.0
}
fn main() {
    let gpu = Gpu::new(&GpuOptions::default()).unwrap();
    let frames: usize = std::env::var("FRAMES").ok().and_then(|f| f.parse().ok()).unwrap_or(20);
    for path in std::env::args().skip(1) {
        let scene = zfail_scene::load(std::path::Path::new(&path)).unwrap();
        let view = scene.cameras[0].view([1280, 720], &scene.bounds());
        let mut r = Renderer::new(&gpu, &scene).unwrap();
        let variants: Vec<(String, Settings)> = std::iter::once((
            "off".to_string(),
            Settings { shadows: false, exposure: Exposure::Ev(0.0), ..Settings::default() },
        ))
        .chain(Technique::ALL.map(|t| {
            (t.name().to_string(), Settings { technique: t, exposure: Exposure::Ev(0.0), ..Settings::default() })
        }))
        .collect();
        let mut best = vec![f64::INFINITY; variants.len()];
        let mut stats = vec![None; variants.len()];
        for round in 0..4 {
            for (v, (_, s)) in variants.iter().enumerate() {
                let st = r.render(&view, s).unwrap();
                let t = cpu();
                for _ in 0..frames {
                    r.render(&view, s).unwrap();
                }
                if round > 0 {
                    best[v] = best[v].min((cpu() - t) / frames as f64);
                }
                stats[v] = Some(st);
            }
        }
        print!("{:22}", std::path::Path::new(&path).file_stem().unwrap().to_string_lossy());
        for (v, (n, _)) in variants.iter().enumerate() {
            let st = stats[v].as_ref().unwrap();
            let (mut c, mut t) = ([0; 3], 0);
            for l in &st.lights {
                for i in 0..3 {
                    c[i] += l.cases[i];
                }
                t += l.triangles.sides + l.triangles.dark_cap + l.triangles.light_cap;
            }
            print!(" | {n} {:.1} {c:?} {t}t p{:.2}", best[v] - if v > 0 { best[0] } else { 0.0 }, st.planning_ms);
        }
        println!();
    }
}
