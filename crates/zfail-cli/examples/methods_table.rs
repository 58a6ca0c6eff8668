//! Prints how many pixels every method gets wrong: `[WIDTHxHEIGHT] [SCENE...]`, where a scene is the name of a built-in one or a
//! file; all built-in ones if there is none.

use std::process::ExitCode;
use zfail_builtin::SCENES;
use zfail_methods::{Error, Method, Methods, Options};
use zfail_oracle::{CastTable, Oracle};
use zfail_render::{Gpu, GpuOptions};
use zfail_scene::Scene;
use zfail_scene::cut::{Limits, cut_masked};

fn main() -> ExitCode {
    let mut names: Vec<String> = std::env::args().skip(1).collect();
    let size = names.first().and_then(|first| {
        let (width, height) = first.split_once('x')?;
        Some([width.parse().ok()?, height.parse().ok()?])
    });
    if size.is_some() {
        names.remove(0);
    }
    if names.is_empty() {
        names = SCENES.iter().map(|entry| entry.name.to_owned()).collect();
    }
    match table(&names, size.unwrap_or([320, 180])) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn table(names: &[String], size: [u32; 2]) -> Result<(), Box<dyn std::error::Error>> {
    let gpu = Gpu::new(&GpuOptions::default())?;
    println!("| scene | pixels |{}", Method::ALL.map(|method| format!(" {method} |")).concat());
    println!("|{}", "---|".repeat(Method::ALL.len() + 2));
    for name in names {
        let mut scene = match zfail_builtin::scene(name) {
            Some(scene) => scene,
            None => zfail_files::load(name.as_ref())?,
        };
        zfail_scene::complete(&mut scene);
        cut_masked(&mut scene, 1.0, Limits::default());
        println!("{}", row(&gpu, name, &scene, size)?);
    }
    Ok(())
}

/// Wrong pixels of all lights under the first camera.
fn row(gpu: &Gpu, name: &str, scene: &Scene, size: [u32; 2]) -> Result<String, Box<dyn std::error::Error>> {
    let camera = scene.cameras.first().ok_or("a scene without a camera")?;
    let view = camera.view(size, &scene.bounds());
    let oracle = Oracle::new(scene);
    let truths: Vec<_> =
        scene.lights.iter().map(|light| oracle.judge(&view, light, &CastTable::double(scene))).collect();
    let mut methods = Methods::new(gpu, scene)?;
    let mut row = format!("| {name} | {} |", size[0] as usize * size[1] as usize * truths.len());
    for method in Method::ALL {
        let mut wrong = Ok(0);
        for (light, truth) in truths.iter().enumerate() {
            match methods.shadow(method, &view, light, &Options::default()) {
                Ok(shadow) => {
                    let report = truth.compare_mask(&shadow.mask)?;
                    wrong = wrong.map(|sum| sum + report.wrong.len());
                }
                Err(Error::Unavailable(_)) => wrong = Err(()),
                Err(error) => return Err(error.into()),
            }
        }
        row += &wrong.map_or_else(|()| " - |".to_owned(), |wrong| format!(" {wrong} |"));
    }
    Ok(row)
}
