//! Planning a frame like one before allocates nothing.

#[path = "all/shapes/mod.rs"]
mod shapes;

use glam::{DAffine3, DVec3};
use zfail_plan::bounds::Bounds;
use zfail_plan::light::LightKind;
use zfail_plan::plan::{Caster, Counting, Input, Planner, ShadowLight, Technique};
use zfail_plan::topology::Topology;
use zfail_plan::view::{Projection, View};

/// Plans frame `k` of a scene whose camera circles and whose light moves if `moving`.
fn plan(planner: &mut Planner, casters: &[Caster<'_>], k: u32, moving: bool) {
    let turn = f64::from(k) * 0.05;
    let projection = Projection::Perspective { yfov: 1.0, near: 0.1, far: None };
    let place = DAffine3::from_rotation_y(turn) * DAffine3::from_translation(DVec3::new(0.0, 1.0, 12.0));
    let view = View::new(place, projection, [640, 360]);
    let position = DVec3::new(if moving { turn.sin() } else { 0.0 }, 7.0, 0.3);
    let lights = [
        ShadowLight::new(LightKind::Point { position, range: 40.0 }).excluding(&[0]),
        ShadowLight::new(LightKind::Directional { direction: DVec3::NEG_Y }),
    ];
    let receivers = [Bounds { min: DVec3::new(-30.0, -2.0, -30.0), max: DVec3::new(30.0, 2.0, 30.0) }];
    let frame = Input {
        view: &view,
        casters,
        lights: &lights,
        receivers: &receivers,
        steps: Technique::Auto.into(),
        counting: Counting::Verdict,
    };
    assert!(!planner.plan(&frame).expect("plan").draws.is_empty());
}

fn allocations(moving: bool) -> u64 {
    let meshes = [shapes::torus(32, 16, 0.4), shapes::cube()];
    let topologies: Vec<Topology> =
        meshes.iter().map(|m| Topology::new(&m.0, &m.1, |_| true).expect("valid")).collect();
    let casters: Vec<Caster<'_>> = (0..20)
        .map(|i| {
            let at = DVec3::new(f64::from(i % 5) * 3.0 - 6.0, 0.0, f64::from(i / 5) * 3.0 - 5.0);
            let mesh = i as usize % 2;
            Caster { topology: &topologies[mesh], mesh: mesh as u64, world_from_object: DAffine3::from_translation(at) }
        })
        .collect();
    let mut planner = Planner::new();
    for k in 0..252 {
        plan(&mut planner, &casters, k, moving);
    }
    allocation_counter::measure(|| {
        for k in 0..126 {
            plan(&mut planner, &casters, k, moving);
        }
    })
    .count_total
}

#[test]
fn a_frame_allocates_nothing_once_warm() {
    // On a worker thread, and the only one: everything is counted, and the scheduler has no queue to fill.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    assert_eq!(pool.install(|| allocations(false)), 0, "with a camera that moves");
    assert_eq!(pool.install(|| allocations(true)), 0, "with a light that moves too");
    let control = allocation_counter::measure(|| drop(Box::new(Planner::new())));
    assert!(control.count_total > 0, "negative control");
}
