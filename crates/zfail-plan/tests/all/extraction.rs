//! Which casters the device is asked to extract, and that their counts cannot wrap.

use crate::shapes;
use crate::shapes::Soup;
use glam::{DAffine3, DVec3};
use zfail_plan::light::LightKind;
use zfail_plan::plan::{Caster, Counting, FramePlan, Input, Planner, ShadowLight, Silhouettes, Steps, Technique};
use zfail_plan::topology::Topology;
use zfail_plan::view::{Projection, View};

fn eye() -> View {
    View::new(
        DAffine3::from_translation(DVec3::new(0.0, 0.5, 4.0)),
        Projection::Perspective { yfov: 1.0, near: 0.1, far: None },
        [64, 64],
    )
}

fn topology(soup: &Soup) -> Topology {
    Topology::new(&soup.0, &soup.1, |_| true).unwrap()
}

fn sheets(count: u32) -> Topology {
    let mut soup: Soup = (Vec::new(), Vec::new());
    for i in 0..count {
        let (y, base) = (i as f32 / count as f32, 4 * i);
        soup.0.extend([[-1.0, y, -1.0], [1.0, y, -1.0], [1.0, y, 1.0], [-1.0, y, 1.0]]);
        soup.1.extend([[base, base + 2, base + 1], [base, base + 3, base + 2]]);
    }
    topology(&soup)
}

fn plan<'p>(
    planner: &'p mut Planner,
    topologies: &[Topology],
    light: DVec3,
    silhouettes: Silhouettes,
    view: &View,
) -> &'p FramePlan {
    let place = |(i, topology)| {
        let world_from_object = DAffine3::from_translation(DVec3::X * 3.0 * i as f64);
        Caster { topology, mesh: i as u64, world_from_object }
    };
    let casters: Vec<Caster<'_>> = topologies.iter().enumerate().map(place).collect();
    let lights = [ShadowLight::new(LightKind::Point { position: light, range: f64::INFINITY })];
    let steps = Steps { silhouettes, off_screen: false, ..Technique::Mcguire.steps() };
    let frame = Input { view, casters: &casters, lights: &lights, receivers: &[], steps, counting: Counting::Verdict };
    planner.plan_extracting(&frame, &vec![true; casters.len()]).unwrap()
}

fn extracted(plan: &FramePlan) -> usize {
    assert_eq!(
        plan.draws.iter().filter(|draw| draw.extraction.is_some()).count() as u32,
        plan.lights[0].stats.extracted
    );
    plan.lights[0].stats.extracted as usize
}

#[test]
fn a_stack_that_would_wrap_stays_with_the_planner() {
    // What does not wrap goes to the device: the negative control.
    for (count, on_device) in [(300, false), (120, true)] {
        let (stack, mut planner) = ([sheets(count)], Planner::new());
        for frame in 0..4 {
            // From high above, where a ray crosses all sheets.
            let light = DVec3::new(0.02 * f64::from(frame), 40.0, 0.3);
            let plan = plan(&mut planner, &stack, light, Silhouettes::Gpu, &eye());
            assert_eq!(extracted(plan) == 1, on_device, "{count} sheets, frame {frame}");
            assert_eq!(plan.lights[0].batches.len() > 1, !on_device, "{count} sheets, frame {frame}");
        }
    }
}

#[test]
fn layers_of_all_casters_are_added_up() {
    let light = DVec3::new(0.2, 40.0, 0.3);
    // Each alone might go there, but nobody looks whether one lies behind the other.
    let stacks = [120, 120].map(sheets);
    assert_eq!(extracted(plan(&mut Planner::new(), &stacks[..1], light, Silhouettes::Gpu, &eye())), 1);
    assert_eq!(extracted(plan(&mut Planner::new(), &stacks, light, Silhouettes::Gpu, &eye())), 0);
    let shallow = [shapes::torus(60, 30, 0.4), shapes::torus(60, 30, 0.4)].map(|soup| topology(&soup));
    assert_eq!(extracted(plan(&mut Planner::new(), &shallow, light, Silhouettes::Gpu, &eye())), 2);
}

#[test]
fn only_what_moves_is_worth_the_device() {
    let torus = [topology(&shapes::torus(60, 30, 0.4))];
    let mut planner = Planner::new();
    let mut asked = |frame: u32| {
        let light = DVec3::new(0.2 + 0.002 * f64::from(frame), 6.0, 0.3);
        extracted(plan(&mut planner, &torus, light, Silhouettes::WhereCheaper, &eye()))
    };
    // Nothing is known to move in the first frame; what stands still costs nothing.
    let on_device: Vec<usize> = [0, 1, 2, 3, 3, 3, 4, 5].into_iter().map(&mut asked).collect();
    assert_eq!(on_device, [0, 1, 1, 1, 0, 0, 0, 1]);
    // Proofs that would not last are not looked for.
    let mut planner = Planner::new();
    let jumps = (0..20).map(|i| {
        let turn = f64::from(i) * 0.7;
        let light = DVec3::new(6.0 * turn.cos(), 3.0, 6.0 * turn.sin());
        extracted(plan(&mut planner, &torus, light, Silhouettes::WhereCheaper, &eye()))
    });
    assert_eq!(jumps.sum::<usize>(), 0);
}

/// From which side parts cast is found once a proof; it has to be right for all lights of the ball.
#[test]
fn a_light_that_wanders_stays_within_its_proofs() {
    let torus = [topology(&shapes::torus(60, 30, 0.4))];
    let (mut planner, mut on_device) = (Planner::new(), 0);
    for i in 0..300 {
        let t = f64::from(i) * 0.01;
        // Around the torus, through its hole and through the tube.
        let light = DVec3::new(2.0 * (2.0 * t).cos(), 1.2 * (3.0 * t).sin(), 0.3 * t);
        let plan = plan(&mut planner, &torus, light, Silhouettes::Gpu, &eye());
        let Some(extraction) = plan.draws.iter().find_map(|draw| draw.extraction.clone()) else { continue };
        on_device += 1;
        let mut castings = Vec::new();
        zfail_plan::casting::castings(&torus[0], plan.draws[0].light, &mut castings);
        let range = extraction.castings.start as usize..extraction.castings.end as usize;
        assert_eq!(plan.castings[range], castings[..], "frame {i}");
    }
    assert!(on_device > 100, "{on_device}");
}

#[test]
fn what_the_device_cannot_do_stays() {
    let light = DVec3::new(0.2, 6.0, 0.3);
    let gpu = Silhouettes::Gpu;
    let torus = [topology(&shapes::torus(60, 30, 0.4))];
    let orthographic = View { projection: Projection::Orthographic { ymag: 2.0, near: 0.1, far: 50.0 }, ..eye() };
    assert_eq!(extracted(plan(&mut Planner::new(), &torus, light, gpu, &eye())), 1);
    assert_eq!(extracted(plan(&mut Planner::new(), &torus, light, gpu, &orthographic)), 0);
    assert_eq!(extracted(plan(&mut Planner::new(), &torus, light, Silhouettes::Cpu, &eye())), 0);
    // Coincident triangles.
    let mut doubled = shapes::torus(60, 30, 0.4);
    doubled.1.push([doubled.1[0][0], doubled.1[0][2], doubled.1[0][1]]);
    assert_eq!(extracted(plan(&mut Planner::new(), &[topology(&doubled)], light, gpu, &eye())), 0);
}
