//! Memory changes nothing: a planner that has seen a thousand frames plans as one that has seen none.
//!
//! Cameras, lights and casters move, stand still and come back, receivers come and go. Draws, what they draw, and the figures
//! are compared with those of a new planner, element by element.

use crate::shapes;
use zfail_plan::bounds::{Bounds, OrientedBox};
use zfail_plan::glam::{DAffine3, DVec3};
use zfail_plan::light::LightKind;
use zfail_plan::plan::{Caster, Counting, Draw, FramePlan, Input, LightStats, Planner, ShadowLight, Steps, Technique};
use zfail_plan::topology::Topology;
use zfail_plan::view::{Projection, View};
use zfail_testing::Random;

/// A world that goes for a walk.
struct World {
    random: Random,
    eye: DVec3,
    target: DVec3,
    orthographic: bool,
    casters: Vec<(usize, DAffine3)>,
    lights: Vec<(LightKind, Option<OrientedBox>)>,
    excluded: Vec<usize>,
    technique: Technique,
}

impl World {
    fn new(seed: u64) -> Self {
        let place = |x: f64| DAffine3::from_translation(DVec3::new(x, 1.0, 0.0));
        let lamp = LightKind::Point { position: DVec3::new(1.0, 6.0, 2.0), range: 30.0 };
        let sun = LightKind::Directional { direction: DVec3::new(0.3, -0.9, 0.1).normalize() };
        Self {
            random: Random(seed),
            eye: DVec3::new(0.0, 3.0, 9.0),
            target: DVec3::ZERO,
            orthographic: false,
            casters: vec![(0, place(-2.0)), (1, place(0.0)), (2, place(2.0)), (0, place(4.0))],
            lights: vec![(lamp, None), (sun, None)],
            excluded: Vec::new(),
            technique: Technique::Auto,
        }
    }

    fn some(&mut self, size: f64) -> DVec3 {
        DVec3::new(self.random.signed(), self.random.signed(), self.random.signed()) * size
    }

    /// Goes on by one frame: often not at all, mostly a little, now and then far.
    fn step(&mut self) {
        let size = if self.random.signed() > 0.8 { 3.0 } else { 0.05 };
        let by = self.some(size);
        match (self.random.signed().abs() * 12.0) as u32 {
            0..=2 => {}
            3 => self.eye += by,
            4 => self.target += by,
            5 => {
                if let Some((LightKind::Point { position, .. } | LightKind::Spot { position, .. }, _)) =
                    self.lights.first_mut()
                {
                    *position += by;
                }
            }
            6 => self.casters[1].1.translation += by,
            7 => self.casters[0].1 *= DAffine3::from_rotation_y(by.x),
            8 => match self.casters.len() {
                4 => self.casters.push((1, DAffine3::from_translation(by))),
                _ => self.casters.truncate(4),
            },
            9 => {
                let half_axes = [DVec3::X * 3.0, DVec3::Y * (2.0 + by.y.abs()), DVec3::Z * 3.0];
                let center = self.lights[0].0.homogeneous().truncate();
                let bounds = &mut self.lights[0].1;
                *bounds = if bounds.is_some() { None } else { Some(OrientedBox { center, half_axes }) };
            }
            10 => match self.excluded.len() {
                0 => self.excluded.push(2),
                _ => self.excluded.clear(),
            },
            _ => match self.random.signed() > 0.0 {
                true => self.orthographic = !self.orthographic,
                false => {
                    self.technique =
                        if self.technique == Technique::Auto { Technique::Mcguire } else { Technique::Auto }
                }
            },
        }
    }

    fn plan<'p>(&self, planner: &'p mut Planner, topologies: &[Topology]) -> &'p FramePlan {
        let back = (self.eye - self.target).normalize();
        let projection = match self.orthographic {
            true => Projection::Orthographic { ymag: 4.0, near: 0.1, far: 40.0 },
            false => Projection::Perspective { yfov: 0.9, near: 0.1, far: None },
        };
        let view = View::looking_at(self.eye, self.eye - back, DVec3::Y, projection, [320, 200]);
        let caster = |&(mesh, world_from_object): &(usize, DAffine3)| Caster {
            topology: &topologies[mesh],
            mesh: mesh as u64,
            world_from_object,
        };
        let casters: Vec<Caster<'_>> = self.casters.iter().map(caster).collect();
        let light = |&(kind, bounds): &(LightKind, Option<OrientedBox>)| {
            ShadowLight::new(kind).within(bounds).excluding(&self.excluded)
        };
        let lights: Vec<ShadowLight<'_>> = self.lights.iter().map(light).collect();
        let around =
            |&(_, place): &(usize, DAffine3)| Bounds { min: place.translation - 1.5, max: place.translation + 1.5 };
        let mut receivers: Vec<Bounds> = self.casters.iter().map(around).collect();
        receivers.push(Bounds { min: DVec3::new(-20.0, -1.0, -20.0), max: DVec3::new(20.0, -0.9, 20.0) });
        let steps: Steps = self.technique.into();
        let input = Input {
            view: &view,
            casters: &casters,
            lights: &lights,
            receivers: &receivers,
            steps,
            counting: Counting::Verdict,
        };
        planner.plan(&input).expect("a plan")
    }
}

/// A draw, and its parts' index lists.
type Drawn = (Draw, [Vec<u32>; 4]);

/// Everything that is drawn, wherever it lies.
fn drawn(plan: &FramePlan) -> Vec<(LightStats, Vec<Vec<Drawn>>)> {
    let list = |range: &std::ops::Range<u32>| plan.indices[range.start as usize..range.end as usize].to_vec();
    let draw = |draw: &Draw| {
        let volume = &draw.volume;
        let lists = [&volume.sides, &volume.dark_cap, &volume.light_cap, &volume.light_cap_reversed].map(list);
        (Draw { volume: Default::default(), ..draw.clone() }, lists)
    };
    let batches =
        |batch: &std::ops::Range<u32>| plan.draws[batch.start as usize..batch.end as usize].iter().map(draw).collect();
    let light = |light: &zfail_plan::plan::LightPlan| {
        (LightStats { searched: 0, ..light.stats }, light.batches.iter().map(batches).collect())
    };
    plan.lights.iter().map(light).collect()
}

fn topologies() -> Vec<Topology> {
    // One of many sections, one that is large and smooth, and a deep one.
    let mut district = shapes::Soup::default();
    for i in 0..60_u32 {
        let (points, triangles) = shapes::torus(8, 6, 0.4);
        let first = district.0.len() as u32;
        let at = [i % 8, i / 8].map(|k| f64::from(k) as f32 * 0.4 - 1.4);
        district.0.extend(points.iter().map(|p| [0.15 * p[0] + at[0], 0.15 * p[1], 0.15 * p[2] + at[1]]));
        district.1.extend(triangles.iter().map(|t| t.map(|v| v + first)));
    }
    let soups = [district, shapes::torus(60, 40, 0.4), shapes::torus(10, 8, 0.3)];
    let topologies: Vec<_> =
        soups.iter().map(|soup| Topology::new(&soup.0, &soup.1, |_| true).expect("a mesh")).collect();
    assert!(topologies[0].sections().len() > 4 && topologies[1].sections().is_empty());
    topologies
}

#[test]
fn a_planner_that_has_seen_much_plans_as_one_that_has_seen_nothing() {
    let topologies = topologies();
    let (mut unchanged, mut different) = (0, 0);
    for seed in 0..5 {
        let mut world = World::new(seed);
        let mut planner = Planner::new();
        let mut before = Vec::new();
        for frame in 0..200 {
            world.step();
            let plan = world.plan(&mut planner, &topologies);
            unchanged += usize::from(plan.unchanged);
            let found = drawn(plan);
            let expected = drawn(world.plan(&mut Planner::new(), &topologies));
            assert_eq!(found, expected, "seed {seed}, frame {frame}");
            // The comparison sees what moves.
            different += usize::from(before != found);
            before = found;
        }
    }
    assert!(unchanged > 100 && different > 400, "{unchanged} frames unchanged, {different} other than those before");
}
