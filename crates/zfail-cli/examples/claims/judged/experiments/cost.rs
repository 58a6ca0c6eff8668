//! Triangles of volumes, by those of the scene that casts them (C: "3x the triangle count of the source model").

use super::{builtin, casters, plan};
use serde::{Deserialize, Serialize};
use std::error::Error;
use zfail_builtin::SCENES;
use zfail_plan::plan::{Planner, Silhouettes, Steps, Technique, Tiles};
use zfail_scene::Scene;

/// One light of a scene, from one camera.
#[derive(Debug, Deserialize, Serialize)]
pub struct Cost {
    pub scene: String,
    pub camera: usize,
    pub light: usize,
    /// Triangles of the volumes by those of all casters, everything drawn.
    pub everything: f64,
    /// The same with every step that the CPU takes.
    pub optimised: f64,
}

/// Every light of every built-in scene from every camera.
///
/// # Errors
/// If a scene cannot cast.
pub fn measure(size: [u32; 2]) -> Result<Vec<Cost>, Box<dyn Error>> {
    let mut lines = Vec::new();
    for entry in SCENES {
        of_scene(entry.name, &builtin(entry.name)?, size, &mut lines)?;
    }
    Ok(lines)
}

fn of_scene(name: &str, scene: &Scene, size: [u32; 2], lines: &mut Vec<Cost>) -> Result<(), Box<dyn Error>> {
    let topologies = scene.topologies()?;
    let casters = casters(scene, &topologies);
    let source: usize = casters.iter().map(|caster| caster.topology.triangles().len()).sum();
    let steps = Steps { tiles: Tiles::Never, silhouettes: Silhouettes::Cpu, ..Technique::Auto.steps() };
    for (camera, from) in scene.cameras.iter().enumerate() {
        let view = from.view(size, &scene.bounds());
        for (light, shining) in scene.lights.iter().enumerate() {
            let ratio = |steps: Steps| {
                let mut planner = Planner::new();
                let stats = plan(&mut planner, &view, &casters, shining.kind, steps)?.lights[0].stats;
                let drawn = stats.triangles.sides + stats.triangles.dark_cap + stats.triangles.light_cap;
                Ok::<f64, Box<dyn Error>>(f64::from(drawn) / source.max(1) as f64)
            };
            let [everything, optimised] = [ratio(Technique::EverittKilgard.steps())?, ratio(steps)?];
            lines.push(Cost { scene: name.to_owned(), camera, light, everything, optimised });
        }
    }
    Ok(())
}
