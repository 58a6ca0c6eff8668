//! Experiments too small, or too artificial, for the program: each a module with one function.
//!
//! In: how much is to be measured. Out: [`Measured`], as JSON.

mod cost;
mod depth;
mod fan;
mod growth;
mod level;
mod lights;
mod placements;
mod sunset;
mod two_sided;

pub use cost::Cost;
pub use depth::{Buffer, Depth};
pub use fan::Fan;
pub use growth::{Growth, Size};
pub use level::Level;
pub use lights::Bands;
pub use placements::Placement;
pub use sunset::Sun;
pub use two_sided::TwoSided;

use serde::{Deserialize, Serialize};
use std::error::Error;
use zfail_plan::glam::{DAffine3, DVec3};
use zfail_plan::light::LightKind;
use zfail_plan::plan::{Caster, Counting, FramePlan, Input, Planner, ShadowLight, Steps};
use zfail_plan::topology::Topology;
use zfail_plan::view::{Projection, View};
use zfail_scene::{Mesh, Scene};

/// How much is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// For the page.
    Whole,
    /// To see whether all of it works.
    Small,
}

impl Extent {
    fn pick<T>(self, whole: T, small: T) -> T {
        if self == Self::Whole { whole } else { small }
    }
}

/// What the experiments have found.
#[derive(Debug, Deserialize, Serialize)]
pub struct Measured {
    pub depth: Vec<Depth>,
    pub growth: Vec<Growth>,
    pub placements: Vec<Placement>,
    pub sunset: Vec<Sun>,
    pub fan: Vec<Fan>,
    pub bands: Vec<Bands>,
    pub cost: Vec<Cost>,
    pub two_sided: Vec<TwoSided>,
    pub level: Vec<Level>,
}

/// Runs all of them.
///
/// # Errors
/// If a body cannot cast, which would be a fault of ours, or the device fails.
pub fn run(extent: Extent) -> Result<Measured, Box<dyn Error>> {
    Ok(Measured {
        depth: depth::measure(extent.pick(33, 9)),
        growth: growth::measure(extent.pick(&[1_000, 10_000, 100_000], &[1_000, 4_000]))?,
        placements: placements::measure(extent.pick(20_000, 500))?,
        sunset: sunset::measure(extent.pick(200, 20))?,
        fan: fan::measure(extent.pick(10_000, 1_000), extent.pick([160, 90], [32, 18]))?,
        bands: lights::measure(extent.pick(2_000, 200)),
        cost: cost::measure(extent.pick([1280, 720], [160, 90]))?,
        two_sided: two_sided::measure(extent.pick([1280, 720], [160, 90]), extent.pick(41, 5))?,
        level: level::measure(extent.pick([640, 360], [96, 54]), extent.pick(8, 3))?,
    })
}

fn topology(mesh: &Mesh) -> Result<Topology, Box<dyn Error>> {
    Ok(Topology::new(&mesh.positions, &mesh.triangles, |_| true)?)
}

fn caster(topology: &Topology, mesh: u64, at: DVec3) -> Caster<'_> {
    Caster { topology, mesh, world_from_object: DAffine3::from_translation(at) }
}

fn look(eye: DVec3, target: DVec3, size: [u32; 2]) -> View {
    View::looking_at(eye, target, DVec3::Y, Projection::Perspective { yfov: 1.0, near: 0.05, far: None }, size)
}

fn point(position: DVec3) -> LightKind {
    LightKind::Point { position, range: f64::INFINITY }
}

/// One frame of casters under one light.
fn plan<'a>(
    planner: &'a mut Planner,
    view: &View,
    casters: &[Caster<'_>],
    light: LightKind,
    steps: Steps,
) -> Result<&'a FramePlan, Box<dyn Error>> {
    let lights = [ShadowLight::new(light)];
    Ok(planner.plan(&Input { view, casters, lights: &lights, receivers: &[], steps, counting: Counting::Verdict })?)
}

/// A built-in scene as the program has it.
fn builtin(name: &str) -> Result<Scene, Box<dyn Error>> {
    let mut scene = zfail_builtin::scene(name).ok_or_else(|| format!("there is no scene {name}"))?;
    zfail_scene::complete(&mut scene);
    Ok(scene)
}

/// What of a scene casts.
fn casters<'a>(scene: &Scene, topologies: &'a [Option<Topology>]) -> Vec<Caster<'a>> {
    let instances = scene.instances.iter().filter(|instance| instance.casts_shadow);
    let casters = instances.filter_map(|instance| {
        let topology = topologies[instance.mesh].as_ref()?;
        Some(Caster { topology, mesh: instance.mesh as u64, world_from_object: instance.world_from_object })
    });
    casters.collect()
}
