//! What the simplified dark cap saves in vertices and costs in fill (McG section 6, DrawDarkCap, and the abstract).
//!
//! Fill is counted without a device: a triangle at infinity covers the pixels whose rays lie between its three directions.

use super::{caster, look, plan, point, topology};
use serde::{Deserialize, Serialize};
use std::error::Error;
use zfail_builtin::shapes;
use zfail_plan::glam::{DVec2, DVec3, DVec4};
use zfail_plan::plan::{FramePlan, Planner, Steps, Technique};
use zfail_plan::view::View;

/// The dark cap of one body, both ways.
#[derive(Debug, Deserialize, Serialize)]
pub struct Fan {
    pub body: String,
    pub fan: Cap,
    pub extruded: Cap,
}

/// One way to close a volume at infinity.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub struct Cap {
    pub triangles: u32,
    pub fragments: u32,
}

/// Bodies of about so many triangles, from within their shadow, looking where it falls.
///
/// # Errors
/// If a body cannot cast.
pub fn measure(triangles: usize, size: [u32; 2]) -> Result<Vec<Fan>, Box<dyn Error>> {
    let root = |each: f64| (triangles as f64 / each).sqrt().round() as usize;
    let bodies = [
        ("sphere", shapes::uv_sphere(1.0, 2 * root(4.0), root(4.0))),
        ("torus knot", shapes::torus_knot([2, 3], 0.6, 0.25, 0.12, 12 * root(24.0), root(24.0))),
    ];
    let view = look(DVec3::new(-1.2, -2.0, -0.8), DVec3::new(-2.4, -4.0, -1.6), size);
    let mut lines = Vec::new();
    for (name, mesh) in bodies {
        let topology = topology(&mesh)?;
        let cap = |fan| {
            let steps = Steps { fan, ..Technique::Mcguire.steps() };
            let mut planner = Planner::new();
            let light = point(DVec3::new(3.0, 5.0, 2.0));
            let plan = plan(&mut planner, &view, &[caster(&topology, 0, DVec3::ZERO)], light, steps)?;
            let triangles = plan.lights[0].stats.triangles.dark_cap;
            let fragments = dark_caps(plan, &topology).map(|directions| covered(&view, directions)).sum();
            Ok::<Cap, Box<dyn Error>>(Cap { triangles, fragments })
        };
        lines.push(Fan { body: name.to_owned(), fan: cap(true)?, extruded: cap(false)? });
    }
    Ok(lines)
}

/// The corners of all dark caps: directions.
fn dark_caps<'a>(
    plan: &'a FramePlan,
    topology: &'a zfail_plan::topology::Topology,
) -> impl Iterator<Item = [DVec3; 3]> + 'a {
    plan.draws.iter().flat_map(move |draw| {
        let range = draw.volume.dark_cap.start as usize..draw.volume.dark_cap.end as usize;
        plan.indices[range].chunks_exact(3).map(move |corners| {
            [corners[0], corners[1], corners[2]]
                .map(|index| draw.extruded(topology.position(index / 2)))
                .map(DVec4::truncate)
        })
    })
}

/// Pixels whose rays pass between three directions, which span less than half of the sky.
fn covered(view: &View, [a, b, c]: [DVec3; 3]) -> u32 {
    let sides = [a.cross(b), b.cross(c), c.cross(a)];
    let [columns, rows] = view.size;
    let ray = |x: u32, y: u32| {
        let ndc = DVec2::new(
            2.0 * (f64::from(x) + 0.5) / f64::from(columns) - 1.0,
            1.0 - 2.0 * (f64::from(y) + 0.5) / f64::from(rows),
        );
        view.world_from_view.transform_vector3(view.on_image_plane(ndc).extend(-1.0))
    };
    let between = |&(x, y): &(u32, u32)| {
        let ray = ray(x, y);
        let signs = sides.map(|side| side.dot(ray));
        let turned = a.dot(b.cross(c));
        signs.iter().all(|&sign| sign * turned > 0.0)
    };
    (0..rows).flat_map(|y| (0..columns).map(move |x| (x, y))).filter(between).count() as u32
}
