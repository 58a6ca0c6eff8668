//! Whether shadow maps cost the same wherever one looks, and less than volumes (C, of "depth buffer based shadows").
//!
//! The first camera of a scene turns on the spot. Nothing moves but the view; so whatever changes in what a method costs is the
//! view's doing.

use super::builtin;
use serde::{Deserialize, Serialize};
use std::error::Error;
use std::f64::consts::TAU;
use zfail_methods::{Method, Methods, Options};
use zfail_plan::glam::DMat3;
use zfail_plan::view::View;
use zfail_render::{Gpu, GpuOptions};

/// One method under one light of one scene.
#[derive(Debug, Deserialize, Serialize)]
pub struct Level {
    pub scene: String,
    pub method: String,
    /// For each direction.
    pub fragments: Vec<f64>,
    /// For each direction, planning and rendering.
    pub milliseconds: Vec<f64>,
}

const SCENES: [&str; 4] = ["container", "room", "cathedral", "jail"];

/// In so many directions.
///
/// # Errors
/// If the device fails.
pub fn measure(size: [u32; 2], directions: u32) -> Result<Vec<Level>, Box<dyn Error>> {
    let gpu = Gpu::new(&GpuOptions::default())?;
    let mut lines = Vec::new();
    for name in SCENES {
        let scene = builtin(name)?;
        let ahead = scene.cameras[0].view(size, &scene.bounds());
        let mut methods = Methods::new(&gpu, &scene)?;
        for method in [Method::ShadowMap, Method::EverittKilgard, Method::Zfail] {
            let [scene, method_name] = [name, method.name()].map(str::to_owned);
            let mut line = Level { scene, method: method_name, fragments: Vec::new(), milliseconds: Vec::new() };
            for k in 0..directions {
                let mut view: View = ahead;
                let turn = DMat3::from_rotation_y(TAU * f64::from(k) / f64::from(directions));
                view.world_from_view.matrix3 = turn * view.world_from_view.matrix3;
                let figures = methods.shadow(method, &view, 0, &Options::default())?.figures;
                line.fragments.push(figures.fragments as f64);
                line.milliseconds.push(figures.planning_ms + figures.render_ms);
            }
            lines.push(line);
        }
    }
    Ok(lines)
}
