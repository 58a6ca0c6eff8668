//! The bound on stacked layers and the division into batches.

use crate::shapes;
use crate::shapes::Soup;
use glam::{DAffine3, DMat3, DVec3};
use zfail_plan::bounds::Bounds;
use zfail_plan::casting::{self, Casting};
use zfail_plan::light::LightKind;
use zfail_plan::plan::{Caster, Counting, FramePlan, Input, Planner, ShadowLight, Steps, Technique};
use zfail_plan::stack::{self, Body, Outline, Work};
use zfail_plan::topology::Topology;
use zfail_plan::view::{Projection, View};

fn sheets(count: u32) -> Soup {
    let mut soup: Soup = (Vec::new(), Vec::new());
    for i in 0..count {
        let y = i as f32 / count as f32;
        let base = soup.0.len() as u32;
        soup.0.extend([[-1.0, y, -1.0], [1.0, y, -1.0], [1.0, y, 1.0], [-1.0, y, 1.0]]);
        soup.1.extend([[base, base + 2, base + 1], [base, base + 3, base + 2]]);
    }
    soup
}

/// The silhouettes of a mesh of which every triangle casts.
fn outline(soup: &Soup, light: LightKind) -> (Topology, Vec<i8>, Outline) {
    let topology = Topology::new(&soup.0, &soup.1, |_| true).unwrap();
    let from = casting::object_light(&light, &DMat3::IDENTITY, DVec3::ZERO).unwrap();
    let mut weights = Vec::new();
    casting::weights(&topology, &vec![Casting::Double; topology.parts().len()], from, &mut weights);
    let mut outline = Outline::new(stack::Chart::new(light.homogeneous(), &topology.bounds()));
    let mut edges = Vec::new();
    topology.boundary(&weights, |[lo, hi], times| {
        let edge = if times > 0 { [lo, hi] } else { [hi, lo] };
        edges.extend(std::iter::repeat_n(edge, times.unsigned_abs() as usize));
    });
    let world_from_object = &DAffine3::IDENTITY;
    let caster = stack::Caster { topology: &topology, weights: &weights, world_from_object, light: from };
    outline.add(&caster, edges.into_iter(), 0..weights.len());
    (topology, weights, outline)
}

fn within(soup: &Soup, light: LightKind, limit: usize) -> bool {
    outline(soup, light).2.is_within(limit, &mut Work::of(1 << 24))
}

fn lamp() -> LightKind {
    LightKind::Point { position: DVec3::new(0.2, 5.0, 0.1), range: f64::INFINITY }
}

fn sun() -> LightKind {
    LightKind::Directional { direction: DVec3::new(0.01, -1.0, 0.02).normalize() }
}

#[test]
fn a_stack_of_sheets_is_as_deep_as_it_has_sheets() {
    for light in [lamp(), sun()] {
        assert!(within(&sheets(100), light, 100));
        assert!(!within(&sheets(100), light, 99));
    }
}

#[test]
fn a_finely_divided_surface_is_shallow() {
    let torus = shapes::torus(200, 100, 0.4);
    for light in [lamp(), sun(), LightKind::Point { position: DVec3::ZERO, range: f64::INFINITY }] {
        // Where two outlines cross, the bound is too high.
        assert!(within(&torus, light, 2 + 2));
        assert!(!within(&torus, light, 1));
    }
}

#[test]
fn triangles_around_and_behind_the_light_are_found() {
    // A room: every direction meets a wall, so no bound of zero may hold in any of the cube's faces.
    let room = shapes::inverted(shapes::cube());
    let light = LightKind::Point { position: DVec3::new(0.1, 0.2, 0.3), range: f64::INFINITY };
    assert!(!within(&room, light, 0));
    assert!(within(&room, light, 1));
}

fn plan(meshes: &[Topology], light: LightKind, counting: Counting) -> FramePlan {
    let casters: Vec<Caster<'_>> = meshes
        .iter()
        .enumerate()
        .map(|(i, topology)| {
            let at = DVec3::Y * i as f64 * 0.01;
            Caster { topology, mesh: i as u64, world_from_object: DAffine3::from_translation(at) }
        })
        .collect();
    let projection = Projection::Perspective { yfov: 1.0, near: 0.1, far: None };
    let view = View::new(DAffine3::IDENTITY, projection, [64, 64]);
    let lights = [ShadowLight::new(light)];
    let frame = Input {
        view: &view,
        casters: &casters,
        lights: &lights,
        receivers: &[],
        // Sections would leave out caps of some sheets.
        steps: Steps { by_section: false, ..Technique::Auto.steps() },
        counting,
    };
    let mut planner = Planner::new();
    planner.plan(&frame).unwrap();
    // Planning the same frame again changes nothing.
    let first = planner.last().clone();
    let again = planner.plan(&frame).unwrap();
    assert_eq!(first.indices, again.indices);
    assert_eq!(first.lights[0].batches, again.lights[0].batches);
    first
}

fn topologies(soups: &[Soup]) -> Vec<Topology> {
    soups.iter().map(|s| Topology::new(&s.0, &s.1, |_| true).unwrap()).collect()
}

#[test]
fn shallow_scenes_need_one_batch_and_deep_ones_are_divided() {
    for light in [lamp(), sun()] {
        let shallow = topologies(&[shapes::torus(100, 50, 0.4), sheets(20)]);
        assert_eq!(plan(&shallow, light, Counting::Verdict).lights[0].batches.len(), 1);
        let deep = topologies(&[sheets(1000)]);
        let divided = plan(&deep, light, Counting::Verdict);
        assert!(divided.lights[0].batches.len() >= 1000 / 120, "{}", divided.lights[0].batches.len());
        // Nothing is lost: every triangle is in one light cap.
        assert_eq!(divided.lights[0].stats.triangles.light_cap, 2000);
        assert_eq!(plan(&deep, light, Counting::Raw).lights[0].batches.len(), 1);
    }
}

#[test]
fn a_deep_stack_of_casters_is_divided_between_casters() {
    let soups: Vec<Soup> = (0..40).map(|_| sheets(10)).collect();
    let divided = plan(&topologies(&soups), lamp(), Counting::Verdict);
    assert!(divided.lights[0].batches.len() >= 4);
    // No caster had to be cut: each is drawn once.
    assert_eq!(divided.draws.len(), 40);
}

#[test]
fn a_change_of_projection_keeps_deep_stacks_divided() {
    let topology = topologies(&[sheets(1000)]).remove(0);
    let casters = [Caster { topology: &topology, mesh: 1, world_from_object: DAffine3::IDENTITY }];
    let lights = [ShadowLight::new(lamp())];
    let mut planner = Planner::new();
    for projection in [
        Projection::Perspective { yfov: 1.0, near: 0.1, far: None },
        Projection::Orthographic { ymag: 1.0, near: 0.1, far: 9.0 },
        Projection::Perspective { yfov: 1.0, near: 0.1, far: None },
    ] {
        let view = View::new(DAffine3::IDENTITY, projection, [64, 64]);
        let (steps, counting) = (Technique::Auto.into(), Counting::Verdict);
        let frame = Input { view: &view, casters: &casters, lights: &lights, receivers: &[], steps, counting };
        let batches = planner.plan(&frame).unwrap().lights[0].batches.len();
        assert!(batches >= 1000 / 120, "{projection:?}: {batches}");
    }
}

#[test]
fn bounds_without_extent_do_no_harm() {
    let frame = stack::Chart::new(sun().homogeneous(), &Bounds { min: DVec3::ZERO, max: DVec3::ZERO });
    let bodies = vec![Body::new([DVec3::ZERO; 8], 1, sun().homogeneous(), &frame); 5];
    assert!(!stack::are_within(&bodies, &frame, 4, &mut Work::of(1 << 20)));
    assert!(stack::are_within(&bodies, &frame, 5, &mut Work::of(0)), "what needs no search needs no work");
}

#[test]
fn a_change_in_the_number_of_lights_keeps_deep_stacks_divided() {
    let topology = topologies(&[sheets(1000)]).remove(0);
    let casters = [Caster { topology: &topology, mesh: 1, world_from_object: DAffine3::IDENTITY }];
    let lights = [ShadowLight::new(lamp()), ShadowLight::new(sun())];
    let projection = Projection::Perspective { yfov: 1.0, near: 0.1, far: None };
    let view = View::new(DAffine3::IDENTITY, projection, [64, 64]);
    let mut planner = Planner::new();
    for count in [1, 2, 1] {
        let (lights, counting) = (&lights[..count], Counting::Verdict);
        let steps = Technique::EverittKilgard.into();
        let frame = Input { view: &view, casters: &casters, lights, receivers: &[], steps, counting };
        let batches = planner.plan(&frame).unwrap().lights[0].batches.len();
        assert!(batches >= 1000 / 120, "{count} lights: {batches}");
    }
}

/// The corners of an upright box.
fn corners(center: DVec3, half: f64) -> [DVec3; 8] {
    Bounds { min: center - half, max: center + half }.corners()
}

#[test]
fn the_layers_of_bodies_add_up_where_they_hide_one_another() {
    for light in [lamp(), sun()].map(|light| light.homogeneous()) {
        // Beside each other as the light sees them, and one behind the other.
        let grid: Vec<DVec3> = (0..400).map(|i| DVec3::new(f64::from(i % 20), -3.0, f64::from(i / 20))).collect();
        let tower: Vec<DVec3> = (0..20).map(|i| DVec3::new(0.0, -f64::from(i), 0.0)).collect();
        let within = |centers: &[DVec3], limit| {
            let bounds = Bounds::of(centers.iter().flat_map(|&center| corners(center, 0.2)));
            let frame = stack::Chart::new(light, &bounds);
            let body = |&center: &DVec3| Body::new(corners(center, 0.2), 10, light, &frame);
            stack::are_within(&centers.iter().map(body).collect::<Vec<_>>(), &frame, limit, &mut Work::of(1 << 20))
        };
        assert!(within(&grid, 60), "{light}");
        assert!(!within(&grid, 9), "{light}: one alone has ten");
        assert!(!within(&tower, 190), "{light}");
        assert!(within(&tower, 200), "{light}");
    }
}

/// How many batches `count` by `count` rings need, each a step from the one before.
fn batches_of_rings(count: u32, step: DVec3, light: LightKind) -> usize {
    let topology = topologies(&[shapes::torus(16, 8, 0.4)]).remove(0);
    let casters: Vec<Caster<'_>> = (0..count * count)
        .map(|i| {
            let at = step * DVec3::new(f64::from(i % count), f64::from(i), f64::from(i / count)) - DVec3::Y * 9.0;
            Caster { topology: &topology, mesh: 1, world_from_object: DAffine3::from_translation(at) }
        })
        .collect();
    let world_from_view = DAffine3::from_translation(DVec3::new(0.0, 40.0, 90.0));
    let projection = Projection::Perspective { yfov: 1.5, near: 0.1, far: None };
    let view = View::new(world_from_view, projection, [64, 64]);
    let lights = [ShadowLight::new(light)];
    let (steps, counting) = (Technique::EverittKilgard.into(), Counting::Verdict);
    let frame = Input { view: &view, casters: &casters, lights: &lights, receivers: &[], steps, counting };
    Planner::new().plan(&frame).unwrap().lights[0].batches.len()
}

#[test]
fn a_crowd_needs_one_batch_and_a_tower_does_not() {
    for light in [lamp(), sun()] {
        assert_eq!(batches_of_rings(24, DVec3::new(4.0, 0.0, 4.0), light), 1);
        assert!(batches_of_rings(24, DVec3::new(0.0, -0.1, 0.0), light) > 1);
    }
}
