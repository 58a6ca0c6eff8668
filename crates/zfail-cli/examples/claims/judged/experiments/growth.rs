//! How what each technique draws grows with the mesh, in each of the three cases (McG section 7).

use super::{caster, look, plan, point, topology};
use serde::{Deserialize, Serialize};
use std::error::Error;
use zfail_builtin::shapes;
use zfail_plan::glam::DVec3;
use zfail_plan::plan::{Planner, Silhouettes, Steps, Technique};

/// A body under one technique, seen from one place, in several sizes.
#[derive(Debug, Deserialize, Serialize)]
pub struct Growth {
    pub technique: String,
    pub body: String,
    pub eye: String,
    pub sizes: Vec<Size>,
}

/// One size of a body.
#[derive(Debug, Deserialize, Serialize)]
pub struct Size {
    /// 1 is z-pass, 2 z-fail without light cap, 3 z-fail.
    pub case: usize,
    /// Of the mesh.
    pub triangles: usize,
    pub sides: u32,
    pub dark_cap: u32,
    pub light_cap: u32,
}

impl Growth {
    /// The exponent from the least to the greatest size: 0.5 is as the silhouette, 1 as the mesh.
    pub fn power(&self) -> Option<f64> {
        let [first, .., last] = &self.sizes[..] else { return None };
        let drawn = |size: &Size| f64::from(size.sides + size.dark_cap + size.light_cap);
        Some((drawn(last) / drawn(first)).ln() / (last.triangles as f64 / first.triangles as f64).ln())
    }
}

const LIGHT: DVec3 = DVec3::new(3.0, 5.0, 2.0);

/// Of bodies with a radius of about 1 around the origin.
const EYES: [(&str, DVec3, DVec3); 3] = [
    ("beside", DVec3::new(-4.0, 1.0, 5.0), DVec3::ZERO),
    ("in shadow, looking away", DVec3::new(-1.2, -2.0, -0.8), DVec3::new(-2.4, -4.0, -1.6)),
    ("in shadow, looking at it", DVec3::new(-1.2, -2.0, -0.8), DVec3::ZERO),
];

/// Every technique on every body from every place.
///
/// # Errors
/// If a body cannot cast.
pub fn measure(sizes: &[usize]) -> Result<Vec<Growth>, Box<dyn Error>> {
    let mut lines = Vec::new();
    for body in ["sphere", "torus knot"] {
        let topologies = sizes.iter().map(|&size| topology(&mesh(body, size))).collect::<Result<Vec<_>, _>>()?;
        for technique in Technique::ALL {
            // The near count would leave nothing in cases 2 and 3; and the device is not asked.
            let steps = Steps { near_count: false, silhouettes: Silhouettes::Cpu, ..technique.steps() };
            for (name, eye, target) in EYES {
                let view = look(eye, target, [1280, 720]);
                let mut sizes = Vec::new();
                for topology in &topologies {
                    let mut planner = Planner::new();
                    let casters = [caster(topology, 0, DVec3::ZERO)];
                    let stats = plan(&mut planner, &view, &casters, point(LIGHT), steps)?.lights[0].stats;
                    sizes.push(Size {
                        case: stats.cases.iter().position(|&count| count > 0).map_or(0, |case| case + 1),
                        triangles: topology.triangles().len(),
                        sides: stats.triangles.sides,
                        dark_cap: stats.triangles.dark_cap,
                        light_cap: stats.triangles.light_cap,
                    });
                }
                let [technique, body, eye] = [technique.name(), body, name].map(str::to_owned);
                lines.push(Growth { technique, body, eye, sizes });
            }
        }
    }
    Ok(lines)
}

fn mesh(body: &str, triangles: usize) -> zfail_scene::Mesh {
    let root = |each: f64| (triangles as f64 / each).sqrt().round() as usize;
    match body {
        "sphere" => shapes::uv_sphere(1.0, 2 * root(4.0), root(4.0)),
        _ => shapes::torus_knot([2, 3], 0.6, 0.25, 0.12, 12 * root(24.0), root(24.0)),
    }
}
